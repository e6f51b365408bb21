/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * love_block.c - Case II of [GC] over the contacts of one particle: what the pressure on the circle of d, of radius shape times
 * R, does at c.  Not the same as what c does at d, unless their circles are of the same size.
 */
#include <float.h>

#include "love.h"
#include "rows.h"

void nlc_love_prepare(nlc_kernel *kernel, double poisson, double prefactor)
{
    (void)prefactor;
    nlc_half_space_prepare(kernel, poisson, 1); /* Case I, for what has to be symmetric */
    kernel->poisson = poisson;
}

static bool row(nlc_block *a, int c, const nlc_block *b, const nlc_kernel *kernel)
{
    const double x = a->x[c], y = a->y[c], z = a->z[c], poisson = kernel->poisson;
    double part[NLC_BLOCK];
    for (int d = 0; d < b->count; d++) {
        const double dx = x - b->x[d], dy = y - b->y[d], dz = z - b->z[d], t = dx * dx + dy * dy + dz * dz;
        const double apart = t + (a == b && d == c ? 1 : DBL_MIN); /* its own place is not looked at: 1 */
        part[d] = nlc_love_kernel(0.5 * sqrt(apart), b->shape[d], poisson) * b->force[d];
    }
    return nlc_add_row(a, c, b, part);
}

bool nlc_love_within(nlc_block *a, const nlc_kernel *kernel)
{
    return nlc_rows_within(a, kernel, row);
}

bool nlc_love_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    return nlc_rows_between(a, b, kernel, row);
}
