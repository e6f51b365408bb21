#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""
pressure_grid.py - two plates on a sphere by a grid of pressures, to see what sphere_contact.py makes of patches that are not
round.  It shares the compliances of the degrees with it and nothing else: no basis functions, no shape of a patch, no Wigner
functions; cells are caps of one pressure each, those that would pull are dropped, those that would overlap are added, until
none is left.  Needs numpy.

    pressure_grid.py [ANGLE EPS NU]...    forces over those of sphere_contact.py's round patches, and the latter's correction
"""
import sys

import numpy as np

sys.dont_write_bytecode = True
import make_tables  # noqa: E402
from sphere_contact import frame, modes, window  # noqa: E402


def green(nu, cap):
    """
    Angles, and there the displacement by a unit force on a cap, averaged over a cap: radial by radial; along the meridian by
    radial, which is minus radial by along the meridian; along by along; across by across.
    """
    degree = int(40 / cap)
    uu, uv, vv, ww = modes(nu, degree)
    n = np.arange(degree + 1.)
    P = np.ones(degree + 2)
    P[1] = np.cos(cap)
    for k in range(1, degree + 1):
        P[k + 1] = ((2 * k + 1) * P[1] * P[k] - k * P[k - 1]) / (k + 1)
    mean = np.ones(degree + 1)
    mean[1:] = (P[:-2] - P[2:]) / ((2 * n[1:] + 1) * (1 - P[1]))
    weight = (2 * n + 1) / (4 * np.pi) * mean**2 * window((n + .5) / (degree + .5))
    angle = np.concatenate([np.linspace(1e-6, 12 * cap, 1500, endpoint=False), np.linspace(12 * cap, np.pi - 1e-6, 3000)])
    x, s = np.cos(angle), np.sin(angle)
    out = np.zeros((4, len(angle)))
    out[0] = weight[0] * uu[0]
    before, P = np.ones_like(x), x
    for k in range(1, degree + 1):
        slope = k * (x * P - before) / s
        second = -k * (k + 1) * P - x / s * slope
        out += weight[k] * np.array([uu[k] * P, uv[k] / (k * (k + 1)) * slope,
                                     -(vv[k] * second + ww[k] * slope / s) / (k * (k + 1)),
                                     -(vv[k] * slope / s + ww[k] * second) / (k * (k + 1))])
        before, P = P, ((2 * k + 1) * x * P - k * before) / (k + 1)
    return angle, out


def compliance(nu, x, e, cap):
    """[cells][cells] displacement of cells at x along e by forces along e."""
    angle, table = green(nu, cap)
    out = np.zeros((len(x), len(x)))
    for i, y in enumerate(x):
        beta = 2 * np.arcsin(np.minimum(np.linalg.norm(x - y, axis=1) / 2, 1))
        rr, mr, mm, tt = (np.interp(beta, angle, t) for t in table)
        across = np.cross(x, y)
        length = np.linalg.norm(across, axis=1)[:, None]
        across = np.where(length < 1e-9, frame(y)[:, 0], across / np.maximum(length, 1e-9))
        force = [np.einsum('ij,ij->i', e, v) for v in (x, np.cross(across, x), across)]
        out[i] = ((e[i] @ y) * (rr * force[0] - mr * force[1]) + np.cross(across, y) @ e[i] * (mr * force[0] + mm * force[1]) +
                  across @ e[i] * tt * force[2])
    return out


def force(nu, normals, eps, alpha, cells):
    """Force on the first plate; cells in a patch's radius."""
    size = 2 * np.sin(1.25 * alpha / 2)
    h = 2 * np.sin(alpha / 2) / cells
    i = (np.arange(-2 * cells, 2 * cells) + .5) * h  # on a map of equal areas
    X, Y = (v.ravel() for v in np.meshgrid(i, i))
    X, Y = X[np.hypot(X, Y) < size], Y[np.hypot(X, Y) < size]
    theta, phi = 2 * np.arcsin(np.hypot(X, Y) / 2), np.arctan2(Y, X)
    cap = np.column_stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
    x = np.vstack([cap @ frame(n).T for n in normals])
    e = np.repeat(normals, len(cap), axis=0)
    G = compliance(nu, x, e, 2 * np.arcsin(h / np.sqrt(np.pi) / 2)) * h * h
    wanted = eps - 1 + np.einsum('ij,ij->i', x, e)
    active, changed = wanted > 0, True
    while changed:
        p = np.zeros(len(x))
        p[active] = np.linalg.solve(G[np.ix_(active, active)], wanted[active])
        better = np.where(active, p > 0, wanted - G @ p > 1e-12)
        changed = (better != active).any()
        active = better
    return p[:len(cap)].sum() * h * h


if __name__ == '__main__':
    arguments = sys.argv[1:] or '180 .1 .3 60 .1 .3 50 .1 0 40 .05 .3 40 .09 0'.split()
    for angle, eps, nu in zip(*(map(float, arguments[k::3]) for k in range(3))):
        make_tables.TABLES['two'] = ('', make_tables.two(angle), None, None)
        scene, (round_one, ) = make_tables.resolve('two', nu, (eps, None), make_tables.FINE, [np.sqrt(eps)])
        shape = make_tables.shape_forces('two', nu, (eps, None), scene.alpha)[0] / round_one
        grid = [force(nu, scene.normals, eps, scene.alpha[0], cells) / round_one - 1 for cells in (10, 14)]
        print('%g degrees, eps %g, nu %g: grid over round patches %+.3f %+.3f %%, sphere_contact.py %+.3f %%' %
              (angle, eps, nu, *(100 * g for g in grid), 100 * shape))
