#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Writes include/nlcontact.f90, the Fortran module, from include/nlcontact.h:

    python3 tools/fortran.py include/nlcontact.h >include/nlcontact.f90

It understands the header's own style and no other; tests/test_examples.sh says when the module is out of date.
"""
import re
import sys

KINDS = {'double': 'real(c_double)', 'int32_t': 'integer(c_int32_t)', 'nlc_status': 'integer(c_int32_t)',
         'int64_t': 'integer(c_int64_t)', 'uint64_t': 'integer(c_int64_t)', 'size_t': 'integer(c_size_t)',
         'ptrdiff_t': 'integer(c_intptr_t)', 'nlc_parallel_callback': 'type(c_funptr)',
         'nlc_exchange_callback': 'type(c_funptr)', 'nlc_reduce_callback': 'type(c_funptr)'}
BYTES = {'int32_t': 4}                                        # others: 8
SCALARS = {'energy', 'reach', 'count'}                        # outputs that are one number
OPTIONAL = {'info', 'options', 'F_wall', 'stiffness'}         # may be left out, beside what is said here:
OPTIONAL_OF = {('nlc_sweep', 'overlap'), ('nlc_contacts_from_lists', 'i'), ('nlc_contacts_from_lists', 'j'),
               ('nlc_reach', 'displacement'), ('nlc_assemble_sliding', 'displacement')}
RENAMED = {'F': 'total_force', 'F_stride': 'total_force_stride', 'F_wall': 'wall_force'}  # Fortran knows no capitals

HEAD = '''! SPDX-License-Identifier: BSD-2-Clause
!
! nlcontact.f90 - libnlcontact from Fortran.  Made from nlcontact.h by tools/fortran.py.
!
! The header and the man pages say what everything means; names and the order of arguments are theirs, but for F, which is
! total_force here.  Particles, walls, contacts and materials are numbered from 0.  Arrays [contacts][3] are (3, contacts).
! Optional arguments may be left out where C takes NULL.  Pointers in types are set with c_loc, to arrays that are targets, or c_funloc.
! Types hold their size (where pointers have 64 bits) and zeros from the start.
!
module nlcontact
    use, intrinsic :: iso_c_binding
    implicit none
    public
'''
TAIL = '''    end interface

contains

    ! The text of a status: nlc_strerror as a string.
    function nlc_message(status) result(text)
        integer(c_int32_t), intent(in) :: status
        character(len=:), allocatable :: text
        character(kind=c_char), pointer :: letters(:)
        integer :: k
        call c_f_pointer(nlc_strerror(status), letters, [200])
        text = ''
        do k = 1, 200
            if (letters(k) == c_null_char) exit
            text = text // letters(k)
        end do
    end function
end module'''


def constants(header):
    for name, value in re.findall(r'X\((NLC_\w+), *(-?\d+),', header):
        yield name, value
    for name, value in re.findall(r'^    (NLC_\w+) = (\d+),? ', header, re.M):
        yield name, value


def structs(header):
    """Name and lines of each; a line of C is <type> <name>, <name>...;"""
    for name, body in re.findall(r'^typedef struct (nlc_\w+) \{\n(.*?)^\}', header, re.S | re.M):
        size, lines = 0, []
        for kind, names in re.findall(r'^    ((?:const )?\w+) ([^;]*);', body, re.M):
            kind = kind.replace('const ', '')
            for field in names.split(','):
                size += BYTES.get(kind, 8) if '*' not in field else 8
                pointer, field = '*' in field, re.sub(r'\*|const|\s', '', field)
                default = ' = c_null_ptr' if pointer else ' = c_null_funptr' if 'callback' in kind else ' = 0'
                default = ' = 16' if field == 'material_size' else default
                lines.append([('type(c_ptr)' if pointer else KINDS[kind]), field, default])
        for line in lines:
            if line[1] == 'struct_size':
                line[2] = f' = {size}'
        yield name, [f'{kind} :: {field}{default}' for kind, field, default in lines]


def declare(function, argument):
    """One argument: its declaration, its Fortran name."""
    const, kind, stars, name, extent = re.match(r'(const )?(\w+) (\**)(?:const \*)?(\w+)(\[\d+\])?$', argument).groups()
    optional = ', optional' if name in OPTIONAL or (function, name) in OPTIONAL_OF else ''
    intent = f'intent({"in" if const else "inout"}){optional}'
    fortran = RENAMED.get(name, name)
    if kind == 'nlc_network' and stars == '**':
        return 'type(c_ptr), intent(inout)', fortran, fortran
    if kind in ('nlc_network', 'void'):
        return 'type(c_ptr), value', fortran, fortran
    if kind == 'char':
        return f'character(kind=c_char), {intent}', fortran, fortran + '(*)'
    if kind not in KINDS:
        return f'type({kind}), {intent}', fortran, fortran
    if not stars and not extent:
        return f'{KINDS[kind]}, value', fortran, fortran
    shape = '' if name in SCALARS else f'({extent[1:-1] if extent else "*"})'
    return f'{KINDS[kind]}, {intent}', fortran, fortran + shape


def wrap(line, indent):
    lines = []
    while len(line) > 120:
        cut = line.rindex(', ', 0, 118) + 2
        lines.append(line[:cut] + '&')
        line = ' ' * indent + line[cut:]
    return lines + [line]


def interface(prototype):
    prototype = re.sub(r'\s+', ' ', prototype).replace('NLC_RESTRICT ', '')
    result, name, arguments = re.match(r'(.*?)(nlc_\w+)\((.*)\)$', prototype).groups()
    arguments = [declare(name, a) for a in ([] if arguments == 'void' else arguments.split(', '))]
    kind = 'subroutine' if result.strip() == 'void' else 'function'
    lines = wrap(f'        {kind} {name}({", ".join(a[1] for a in arguments)}) bind(c)', 16) + ['            import']
    if kind == 'function':
        lines.append(f'            {"type(c_ptr)" if "*" in result else KINDS[result.strip()]} :: {name}')
    groups = []
    for how, _, what in arguments:
        if groups and groups[-1][0] == how:
            groups[-1][1].append(what)
        else:
            groups.append((how, [what]))
    lines += [f'            {how} :: {", ".join(what)}' for how, what in groups]
    return '\n'.join(lines + [f'        end {kind}'])


def main():
    with open(sys.argv[1], encoding='utf-8') as file:
        header = file.read()
    print(HEAD)
    for name, value in constants(header):
        print(f'    integer(c_int32_t), parameter :: {name} = {value}')
    for name, lines in structs(header):
        print(f'\n    type, bind(c) :: {name}')
        for line in lines:
            print('        ' + line)
        print('    end type')
    print('\n    interface')
    print('\n\n'.join(interface(p) for p in re.findall(r'^NLC_API (.*?);', header, re.S | re.M)))
    print(TAIL)


main()
