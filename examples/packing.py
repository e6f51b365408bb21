#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Total contact force of a packing (bench/README has the format), by Hertz and with the coupling: packing.py FILE.csv"""
import re
import sys

import numpy

import nlcontact

REACH = 0.3  # gaps below this part of the mean radius make a candidate


def read(path):
    with open(path, encoding='utf-8') as file:
        lines = file.read().splitlines()
    if any(re.match('# periodic:.*1', line) or re.match('# wall (?!.* rigid )', line) for line in lines):
        sys.exit('this example has no periodic boxes and no walls that yield')
    number = r'([-+.\w]+)'
    walls = [re.findall(number, line.split('point')[1].replace('inward_normal', '')) for line in lines if line.startswith('# wall ')]
    materials = [re.search(f' E {number} nu {number}', line).groups() for line in lines if line.startswith('# material type ')]
    rows = numpy.array([line.split(',') for line in lines if line[:1].isdigit()], numpy.float64)
    return rows, numpy.array(walls, numpy.float64), numpy.array(materials + [(numpy.inf, 0)], numpy.float64)


def pairs(x, radius, walls):
    """All pairs with a gap below the reach, and all walls: quadratic, where a program has its neighbour lists."""
    distance = numpy.linalg.norm(x[:, None] - x[None, :], axis=2)
    near = numpy.triu(distance < (1 + REACH / 2) * (radius[:, None] + radius[None, :]), 1)
    height = numpy.einsum('pwk,wk->pw', x[:, None] - walls[None, :, :3], walls[:, 3:])
    i, j = numpy.nonzero(near)
    k, w = numpy.nonzero(height < (1 + REACH) * radius[:, None])
    return numpy.concatenate((i, k)).astype(numpy.int32), numpy.concatenate((j, len(x) + w)).astype(numpy.int32)


def main():
    rows, walls, materials = read(sys.argv[1])
    radius, material = rows[:, 4].copy(), rows[:, 5].astype(numpy.int32) - 1
    x, y, z = (rows[:, k].copy() for k in (1, 2, 3))
    wall_point, wall_normal = walls[:, :3].copy(), walls[:, 3:].copy()
    wall_material = numpy.full(len(walls), len(materials) - 1, numpy.int32)
    particles = nlcontact.Particles(
        count=len(radius), radius=nlcontact.address(radius), material=nlcontact.address(material, numpy.int32),
        materials=nlcontact.address(materials), material_count=len(materials), material_size=16,
        wall_material=nlcontact.address(wall_material, numpy.int32), wall_count=len(walls))
    positions = nlcontact.Positions(x=nlcontact.address(x), y=nlcontact.address(y), z=nlcontact.address(z),
                                    wall_point=nlcontact.address(wall_point), wall_normal=nlcontact.address(wall_normal))
    i, j = pairs(numpy.column_stack((x, y, z)), radius, walls)
    overlap, normal = nlcontact.contacts(particles, positions, i, j)
    total = []
    for model in nlcontact.HERTZ, nlcontact.GONZALEZ_CUITINO:
        force, nonlocal_ = numpy.empty(len(i)), numpy.zeros(len(i))
        nlcontact.Network(particles, i, j, nlcontact.Options(model=model)).solve(force, nonlocal_, overlap, normal)
        total.append(force.sum())
    print(f'total force: Hertz {total[0]:.6f} N, Gonzalez-Cuitino {total[1]:.6f} N, ratio {total[1] / total[0]:.3f}')


main()
