#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""preloaded_table.py - prints preloaded.csv: exact linear elasticity for Fig. 14, by ../reference/sphere_contact.py.  Seconds."""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../reference'))
import make_tables as tables  # noqa: E402

tables.TABLES['preloaded'] = ('two plates, two others pressed by .04', tables.Z, tables.X, .04)
print('# an elastic sphere between rigid frictionless plates: two plates, two others pressed by .04')
print('# exact linear elasticity, exact gap of the sphere; made by bench/figures/preloaded_table.py')
for n, _, g in tables.contacts('preloaded', (0, 0)):
    print('# contact: %g %g %g group %d' % (*n, g + 1))
print('# columns as in bench/data/reference')
print('nu,eps_1,eps_2,force_1,force_2,error_1,error_2,shape_1,shape_2')
for eps in (.04, .05, .06, .08, .1, .12, .14):
    both, force, error, shape, _ = tables.row('preloaded', .46, eps)
    print(','.join(['0.46'] + ['%.10g' % e for e in both] + ['%.8g' % f for f in force] +
                   ['%.1e' % e for e in (*error, *(s if abs(s) > 1e-7 else 0 for s in shape))]))
