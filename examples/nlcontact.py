# SPDX-License-Identifier: BSD-2-Clause
"""libnlcontact from Python by ctypes: a network of contacts over numpy arrays, which the library reads and writes where they are.

The library is found as NLCONTACT_LIBRARY says, or where the system looks for libnlcontact.so.0.
"""
import ctypes
import os
from ctypes import POINTER, Structure, byref, c_double, c_int32, c_int64, c_size_t, c_ssize_t, c_void_p

import numpy

GONZALEZ_CUITINO, HERTZ, HALF_SPACE, LOVE, SPHERE, POINT_FORCE = range(6)

_library = ctypes.CDLL(os.environ.get('NLCONTACT_LIBRARY', 'libnlcontact.so.0'))
_library.nlc_strerror.restype = ctypes.c_char_p
_library.nlc_network_size.restype = c_size_t


class _Struct(Structure):
    def __init__(self, **fields):
        super().__init__(struct_size=ctypes.sizeof(self), **fields)


class Particles(_Struct):
    _fields_ = [('struct_size', c_size_t), ('count', c_int64), ('radius', c_void_p), ('radius_stride', c_ssize_t),
                ('material', c_void_p), ('material_stride', c_ssize_t), ('materials', c_void_p), ('material_count', c_int64),
                ('material_size', c_size_t), ('wall_material', c_void_p), ('wall_count', c_int64)]


class Positions(_Struct):
    _fields_ = [('struct_size', c_size_t), ('x', c_void_p), ('y', c_void_p), ('z', c_void_p), ('stride', c_ssize_t),
                ('wall_point', c_void_p), ('wall_normal', c_void_p), ('cell', c_void_p)]


class Options(_Struct):
    _fields_ = [('struct_size', c_size_t), ('model', c_int32), ('method', c_int32), ('tolerance', c_double),
                ('max_sweeps', c_int64), ('prefactor', c_double), ('simd', c_int32), ('points', c_int32), ('stiffness', c_void_p),
                ('cache', c_void_p), ('cache_size', c_size_t),
                ('parallel_for', c_void_p), ('parallel_context', c_void_p),
                ('owned_particles', c_int64), ('exchange', c_void_p), ('reduce', c_void_p), ('context', c_void_p), ('reserved', c_void_p)]


class Info(_Struct):
    _fields_ = [('struct_size', c_size_t), ('culprit', c_int64), ('sweeps', c_int64), ('residual', c_double),
                ('worst_contact', c_int64), ('active', c_int64), ('lambda_lower', c_double), ('lambda_upper', c_double),
                ('critical_particle', c_int64), ('coupling', c_double), ('weakest_particle', c_int64), ('weakened', c_int64),
                ('blocks', c_int64), ('left_out', c_int64), ('clusters', c_int64), ('settled', c_int64)]


def address(array, dtype=numpy.float64):
    """Of an array that the library can use as it is; the caller keeps the array."""
    if array.dtype != dtype or not array.flags.c_contiguous:
        raise TypeError(f'a contiguous array of {numpy.dtype(dtype)} is needed')
    return c_void_p(array.ctypes.data)


def call(function, *arguments):
    """Calls the function with an info.  Returns status and info; an error is raised."""
    info = Info()
    status = getattr(_library, function)(*arguments, byref(info))
    if status < 0:
        raise RuntimeError(f'{function}: {_library.nlc_strerror(status).decode()}: {info.culprit}')
    return status, info


def contacts(particles, positions, i, j):
    """Overlaps and normals of pairs."""
    overlap, normal = numpy.empty(len(i)), numpy.empty((len(i), 3))
    call('nlc_contacts_from_pairs', address(overlap), address(normal), byref(particles), byref(positions),
         address(i, numpy.int32), address(j, numpy.int32), c_int64(len(i)))
    return overlap, normal


class Network:
    def __init__(self, particles, i, j, options=None):
        count, options = c_int64(len(i)), options or Options()
        size = _library.nlc_network_size(byref(particles), count, byref(options))
        self._memory = numpy.empty(size // 8 + 1, numpy.uint64)
        self._network, self.count = c_void_p(), len(i)
        call('nlc_network_init', byref(self._network), c_void_p(self._memory.ctypes.data), c_size_t(self._memory.nbytes),
             byref(particles), address(i, numpy.int32), address(j, numpy.int32), count, byref(options))

    def solve(self, force, nonlocal_, overlap, normal):
        """Writes force and nonlocal_, which are not copied.  Returns status and info."""
        if not len(force) == len(nonlocal_) == len(overlap) == len(normal) == self.count or normal.shape[1:] != (3,):
            raise ValueError('an array does not have the length of the list of contacts')
        return call('nlc_solve', self._network, address(force), address(nonlocal_), address(overlap), address(normal))
