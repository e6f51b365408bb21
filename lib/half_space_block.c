/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * half_space_block.c - Eq. 1 of [MC] over the contacts of one particle, at contact points that are not on its undeformed surface:
 * point d is (1 + shape) N_d, in units of R.  With outward normals N, r from d to c, h = |r| and u = r/h the displacement at c is
 *     -2 U G / h { (N_d.u)(N_c.u) + (3-4nu) N_d.N_c - (1-2nu) (N_d.N_c - u.N_c) / (1 - N_d.u) }
 * ([MC]'s normals are the inward ones).  On the undeformed sphere N_d.u = -h/2, and it is Case I times G.
 */
#include <float.h>

#include "rows.h"

#define STEEPEST 1e-3 /* 1 - N_d.u is taken for no less: c straight above d has no place on a half-space */

static bool row(nlc_block *a, int c, const nlc_block *b, const nlc_kernel *kernel)
{
    const double x = a->x[c], y = a->y[c], z = a->z[c], nu = kernel->poisson;
    double part[NLC_BLOCK];
    for (int d = 0; d < b->count; d++) {
        /* r = N_c - N_d + what the points are off: no digits are lost where they are close */
        const double dx = x - b->x[d], dy = y - b->y[d], dz = z - b->z[d], q = a->shape[c], p = b->shape[d];
        const double rx = dx + (q * x - p * b->x[d]), ry = dy + (q * y - p * b->y[d]), rz = dz + (q * z - p * b->z[d]);
        const double h2 = rx * rx + ry * ry + rz * rz, i = 1 / sqrt(h2 + (a == b && d == c ? 1 : DBL_MIN)); /* not looked at: 1 */
        const double cosine = 1 - 0.5 * (dx * dx + dy * dy + dz * dz);
        const double from = i * (rx * b->x[d] + ry * b->y[d] + rz * b->z[d]), to = i * (rx * x + ry * y + rz * z);
        const double least = 1 - from, below = 0.5 * (least + STEEPEST + fabs(least - STEEPEST)); /* the larger of the two */
        const double sum = from * to + (3 - 4 * nu) * cosine - (1 - 2 * nu) * (cosine - to) / below;
        part[d] = -2 * kernel->prefactor * i * sum * b->force[d];
    }
    return nlc_add_row(a, c, b, part);
}

bool nlc_half_space_within(nlc_block *a, const nlc_kernel *kernel)
{
    return nlc_rows_within(a, kernel, row);
}

bool nlc_half_space_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    return nlc_rows_between(a, b, kernel, row);
}
