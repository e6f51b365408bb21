#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""
make_tables.py - the tables in bench/data/reference, from sphere_contact.py and two_spheres.py.  Needs numpy.

    make_tables.py FOLDER [NAME...]     write FOLDER/NAME.csv, all if no name is given; some minutes
    make_tables.py --check FOLDER       compare the solver with what else is known; FOLDER holds finite elements' tables
"""
import csv
import sys
from itertools import product

import numpy as np

sys.dont_write_bytecode = True
import two_spheres  # noqa: E402
from sphere_contact import Scene, modes, surface_displacement  # noqa: E402

NU = (0, .1, .2, .3, .4, .46, .5)
EPS = (.001, .005, .01, .02, .05, .1)
FINE, COARSE, SHAPE = (8, 120.), (5, 60.), (6, 60.)  # unknowns of a patch and m, highest degree times alpha
M = 4

X, Y, Z = ([(1, 0, 0), (-1, 0, 0)], [(0, 1, 0), (0, -1, 0)], [(0, 0, 1), (0, 0, -1)])


def two(degrees):
    h = np.radians(degrees) / 2
    return [(np.cos(h), np.sin(h), 0.), (np.cos(h), -np.sin(h), 0.)]


FREE = 'free'  # eps of the second group such that the forces balance
# name: title, contacts of group 1, contacts of group 2, eps of group 2
TABLES = {
    'one_plate': ('one plate, held by the body force', [Z[1]], None, None),
    'uniaxial': ('two plates', Z, None, None),
    'one_lateral': ('two plates, two others at right angles just touching', Z, X, 0.),
    'two_lateral': ('two plates, four others at right angles just touching', Z, X + Y, 0.),
    'confined_02': ('two plates, four others pressed by .02', Z, X + Y, .02),
    'confined_05': ('two plates, four others pressed by .05', Z, X + Y, .05),
    'hydrostatic': ('six plates, a simple cubic crystal', X + Y + Z, None, None),
    'bcc': ('eight plates, a body-centred cubic crystal without second neighbours', list(product((1, -1), repeat=3)), None, None),
    'fcc': ('twelve plates, a face-centred cubic crystal',
            [v for v in product((0, 1, -1), repeat=3) if np.dot(v, v) == 2], None, None),
    'two_at_60': ('two plates 60 degrees apart, held by the body force', two(60), None, None),
    'three_40': ('two plates 40 degrees apart, balanced by a third', two(40), [X[1]], FREE),
    'three_50': ('two plates 50 degrees apart, balanced by a third', two(50), [X[1]], FREE),
    'three_60': ('two plates 60 degrees apart, balanced by a third', two(60), [X[1]], FREE),
    'three_90': ('two plates 90 degrees apart, balanced by a third', two(90), [X[1]], FREE),
}


def contacts(table, eps):
    """The list for Scene; eps of both groups."""
    _, one, other, _ = TABLES[table]
    return [(n, eps[0], 0) for n in one] + [(n, eps[1], 1) for n in other or []]


def resolve(table, nu, eps, resolution, guess):
    scene = Scene(nu, contacts(table, eps), *resolution)
    return scene, scene.solve_round(guess)


def balance(table, nu, eps, guess):
    """eps of the second group for which the forces of round patches add up to zero."""
    def excess(other):
        scene, force = resolve(table, nu, (eps, other), SHAPE, guess)
        return sum(force[g] * scene.normals[c][0] for c, g in enumerate(scene.group)) / force[-1]
    x0, x1 = 1.3 * eps, 1.5 * eps
    y0, y1 = excess(x0), excess(x1)
    while abs(y1) > 1e-9:
        x0, y0, x1 = x1, y1, x1 - y1 * (x1 - x0) / (y1 - y0)
        y1 = excess(x1)
    return x1


def shape_forces(table, nu, eps, alpha):
    """What patches and pressures that are not round add to the force of a contact, for each group."""
    groups, out = len(alpha), []

    def energy(g, change):
        moved = [e + change * (k == g) if e is not None else None for k, e in enumerate(eps)]
        scene, _ = resolve(table, nu, moved, SHAPE, alpha)
        return scene.energy(M) - scene.energy(0), scene.group.count(g)
    for g in range(groups):
        h = .02 * alpha[g]**2
        (high, contacts), (low, _) = energy(g, h), energy(g, -h)
        out.append((high - low) / (2 * h) / contacts)
    return np.array(out)


def row(table, nu, eps):
    """A line of a table: eps, force, error, shape, radius for each group."""
    other = TABLES[table][3]
    guess = [np.sqrt(eps)]
    if other is not None:
        guess.append(np.sqrt(eps) if other == FREE else np.sqrt(max(other, .05 * eps)))
    if other == FREE:
        other = balance(table, nu, eps, guess)
    both = (eps, other)
    scene, coarse = resolve(table, nu, both, COARSE, guess)
    scene, fine = resolve(table, nu, both, FINE, scene.alpha)
    shape = shape_forces(table, nu, both, scene.alpha)
    return both, fine + shape, np.abs(coarse / fine - 1), shape / fine, np.sin(scene.alpha)


def write_table(folder, table):
    title, one, other, second = TABLES[table]
    groups = 1 if other is None else 2
    out = [f'# an elastic sphere between rigid frictionless plates: {title}',
           '# exact linear elasticity, exact gap of the sphere; made by bench/reference/make_tables.py']
    out += ['# contact: %.17g %.17g %.17g group %d' % (*n, g + 1) for n, _, g in contacts(table, (0, 0))]
    out += ['# eps: overlap / R, displacement of the plates of a group towards the centre of mass; force: in E R^2',
            '# error: of the force, relative, the difference from a solution with half the resolution',
            '# shape: what patches and pressures that are not round add to the force, relative; found to its leading order',
            '# radius: of the contact in units of R, of the round patch']
    if second == FREE:
        out.append('# eps_2 is chosen such that the forces of round patches balance')
    names = [f'{name}_{g + 1}' for name in ('eps', 'force', 'error', 'shape', 'radius') for g in range(groups)]
    out.append(','.join(['nu'] + names))
    for nu in NU:
        for eps in EPS:
            try:
                both, force, error, shape, radius = row(table, nu, eps)
            except ValueError as reason:
                print(f'{table}: nu {nu} eps {eps}: {reason}', file=sys.stderr)
                continue
            values = ['%.10g' % e for e in both[:groups]]
            values += ['%.8g' % v for v in force] + ['%.1e' % v for v in error]
            values += ['%.1e' % (v if abs(v) > 1e-7 else 0) for v in shape] + ['%.5g' % v for v in radius]
            out.append(','.join(['%g' % nu] + values))
    with open(f'{folder}/{table}.csv', 'w') as file:
        file.write('\n'.join(out) + '\n')


# the second sphere: radius, modulus over that of the first, nu; None: that of the first
SECOND = ((1, 1, None), (.5, 1, None), (2, 1, None), (4, 1, None), (1, 5, .3), (1, np.inf, 0), (2, np.inf, 0))


def write_two_spheres(folder, table):
    """The same overlap everywhere, eps R of the first sphere."""
    groups = 2 if table == 'sphere_plate' else 1
    out = ['# an elastic sphere and another one' + (', a rigid plate opposite' if groups == 2 else ''),
           '# linear elasticity; made by bench/reference/make_tables.py',
           '# contact: 0 0 1 group 1 sphere'] + ['# contact: 0 0 -1 group 2'] * (groups - 1)
    out += ['# the spheres are held by uniform body forces; nu: of the first sphere; radius_ratio, young_ratio: second over first;',
            '# other_nu: of the second; eps: overlap over R of the first; force: in E R^2 of the first',
            '# error: of the force, relative, the difference from a solution with half the resolution',
            '# choice: about how much linear elasticity leaves open where the surface of contact, of curvature kappa, is not flat:',
            '# (kappa a)^2 / 2',
            '# radius: of the contact in units of R of the first']
    names = [f'{name}_{g + 1}' for name in ('eps', 'force', 'error', 'radius') for g in range(groups)]
    out.append(','.join(['nu', 'radius_ratio', 'young_ratio', 'other_nu'] + names + ['choice']))
    for nu in (0, .3, .5):
        for ratio, young, other in SECOND:
            other = nu if other is None else other
            first, second = (1., 1., nu), (ratio, min(young, 1e300), other)
            q = [(1 - s[2]**2) / s[1] for s in (first, second)]
            kappa = 1 - q[0] / sum(q) * (1 + 1 / ratio)
            for eps in EPS:
                plate = eps if groups == 2 else None
                force, radius = two_spheres.forces(first, second, eps, plate, *FINE)
                coarse, _ = two_spheres.forces(first, second, eps, plate, *COARSE)
                values = ['%g' % v for v in (nu, ratio, young, other)] + ['%g' % eps] * groups
                values += ['%.8g' % f for f in force] + ['%.1e' % e for e in np.abs(coarse / force - 1)]
                values += ['%.5g' % a for a in radius] + ['%.1e' % ((kappa * radius[0])**2 / 2)]
                out.append(','.join(values))
    with open(f'{folder}/{table}.csv', 'w') as file:
        file.write('\n'.join(out) + '\n')


def hertz_pressure(nu, radius, theta, degree, radial):
    """Normal displacement at theta by the pressure (1 - r^2/a^2)^(1/2) 3P/(2 pi a^2), r = sin(theta), P = E = R = 1."""
    x, w = np.polynomial.legendre.leggauss(400)
    psi = (x + 1) * np.pi / 4
    r = radius * np.sin(psi)
    z = np.sqrt(1 - r * r)
    force = 3 * np.cos(psi)**2 * np.sin(psi) * w * np.pi / 4  # of a ring, on the area that a plate sees: its sum is P = 1
    n = np.arange(degree + 1.)
    P = np.zeros((degree + 2, len(z)))
    P[0], P[1] = 1, z
    for k in range(1, degree + 1):
        P[k + 1] = ((2 * k + 1) * z * P[k] - k * P[k - 1]) / (k + 1)
    slope = np.zeros((degree + 1, len(z)))  # dP/dtheta
    slope[1:] = n[1:, None] * (z * P[1:-1] - P[:-2]) / r
    norm = np.sqrt((2 * n + 1) / (4 * np.pi))
    if radial:  # the force across the sphere's own area is larger by 1/z
        R, S = -norm * (P[:-1] @ (force / z)), 0 * n
    else:
        R, S = -norm * (P[:-1] @ (force * z)), norm * (slope @ (force * r)) / np.maximum(n * (n + 1), 1)
    return np.array([surface_displacement(modes(nu, degree), R, S, t)[0] for t in theta])


def write_hertz_pressure(folder):
    radius = .233
    theta = np.radians(np.arange(0, 181, 2.))
    out = ['# normal displacement of the surface of an elastic sphere under the Hertz pressure on one circle, exact linear elasticity',
           '# p = 3P/(2 pi a^2) (1 - r^2/a^2)^(1/2), r = R sin(theta) <= a = 0.233 R; made by bench/reference/make_tables.py',
           '# relative to the centre of mass, P balanced by a uniform body force; held in any other way by the same force at the',
           '# centre, the displacement differs by a multiple of cos(theta)',
           '# theta: degrees; displacement: outward, in P/(E R), for a pressure along the axis and along the radius, both per',
           '# area of the circle; error: the larger difference from half as many degrees',
           'nu,theta,displacement,displacement_radial,error']
    for nu in (0, .3, .46, .5):
        u, v = (hertz_pressure(nu, radius, theta, 2000, radial) for radial in (False, True))
        e = np.maximum(*(np.abs(hertz_pressure(nu, radius, theta, 1000, r) - w) for r, w in ((False, u), (True, v))))
        out += ['%g,%g,%.8f,%.8f,%.0e' % (nu, *line) for line in zip(np.degrees(theta).round(6), u, v, e)]
    with open(f'{folder}/hertz_pressure.csv', 'w') as file:
        file.write('\n'.join(out) + '\n')


def read(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if line[0] != '#'))


def check(folder):
    worst = [0, 0, 0]
    for r in read(f'{folder}/uniaxial_linear.csv'):
        if float(r['eps_1']) >= .001:
            force = row('uniaxial', float(r['nu']), float(r['eps_1']))[1]
            worst[0] = max(worst[0], abs(force[0] / float(r['force_1']) - 1))
    for r in read(f'{folder}/two_lateral_linear.csv'):
        force = row('two_lateral', float(r['nu']), float(r['eps_1']))[1]
        for k, name in enumerate(('force_1', 'force_2')):
            worst[k + 1] = max(worst[k + 1], abs(force[k] / float(r[name]) - 1))
    print('finite elements: uniaxial within %.3f %%, two lateral pairs %.2f %% axial, %.2f %% lateral' %
          tuple(100 * w for w in worst))

    ratio = [row('one_plate', nu, 1e-5)[1][0] / (4 / 3 * 1e-5**1.5 / (1 - nu * nu)) for nu in NU]
    print('force of one plate over Hertz at eps = 1e-5: %.4f to %.4f' % (min(ratio), max(ratio)))

    scene, force = resolve('three_60', .3, (.05, .08), FINE, [.2, .3])
    def energy(eps, other):
        s, _ = resolve('three_60', .3, (eps, other), FINE, [.2, .3])
        return sum(.5 * s.coefficients[s.group[c]] @ (s.patches[s.group[c]].force * s.eps[c] -
                   s.patches[s.group[c]].gap) for c in range(3))
    h = 1e-4
    slope = [(energy(.05 + h, .08) - energy(.05 - h, .08)) / (2 * h) / 2, (energy(.05, .08 + h) - energy(.05, .08 - h)) / (2 * h)]
    print('two plates at 60 degrees and a third: forces over slopes of the energy - 1: %.1e %.1e' % tuple(force / slope - 1))
    scene, _ = resolve('confined_02', .3, (.05, .02), FINE, [.2, .1])
    for c in (0, 2):
        a = scene.alpha[scene.group[c]]
        gap = lambda t: (1 - np.cos(t) - scene.eps[c] - scene.displacement(c, t)) / scene.eps[c]
        print('confined: gap / eps under plate %d: %.1e, beside it: %.1e or more' % (
            c, np.abs(gap(np.linspace(0, .97 * a, 20))).max(), gap(np.linspace(1.05 * a, np.pi, 60)).min()))


if __name__ == '__main__':
    arguments = sys.argv[1:]
    if arguments[:1] == ['--check'] and len(arguments) == 2:
        check(arguments[1])
    elif arguments and arguments[0][0] != '-':
        for name in arguments[1:] or [*TABLES, 'two_spheres', 'sphere_plate', 'hertz_pressure']:
            if name == 'hertz_pressure':
                write_hertz_pressure(arguments[0])
            elif name in ('two_spheres', 'sphere_plate'):
                write_two_spheres(arguments[0], name)
            else:
                write_table(arguments[0], name)
    else:
        sys.exit(__doc__)
