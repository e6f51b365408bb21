/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * boussinesq_block.c - Case I of [GC] over the contacts of one particle.
 *
 * With t = |N_c - N_d|^2 = 4 s^2 and r = 1/sqrt(t), [GC] 5 divided by the force is
 *     U [ -4(1-nu) r - 2(1-2nu) + (7-8nu)/2 t r ] = U [ c0 r + c1 + c2 t r ]:
 * one square root and one division a pair, no trigonometry, and all digits for neighbouring contacts.  The coefficient is
 * the same for (c, d) and (d, c), so each pair is looked at once.
 */
#include <float.h>

#include "model.h"
#include "number.h"

void nlc_case_one_prepare(nlc_kernel *kernel, double poisson, double prefactor)
{
    (void)prefactor;
    nlc_half_space_prepare(kernel, poisson, 1);
}

void nlc_half_space_prepare(nlc_kernel *kernel, double poisson, double prefactor)
{
    kernel->c[0] = -4 * (1 - poisson) * prefactor;
    kernel->c[1] = -2 * (1 - 2 * poisson) * prefactor;
    kernel->c[2] = (7 - 8 * poisson) / 2 * prefactor;
}

/* Between contact c of a and the first n of b. */
static inline int row(nlc_block *a, int c, nlc_block *b, int n, const nlc_kernel *kernel)
{
    const double x = a->x[c], y = a->y[c], z = a->z[c], force = a->force[c];
    const double c0 = kernel->c[0], c1 = kernel->c[1], c2 = kernel->c[2];
    double mine[NLC_BLOCK];
    int same = 0;
    for (int d = 0; d < n; d++) {
        double dx = x - b->x[d], dy = y - b->y[d], dz = z - b->z[d];
        double t = dx * dx + dy * dy + dz * dz;
        same |= t < DBL_MIN;
        t = t < DBL_MIN ? DBL_MIN : t; /* nothing is divided by zero before the error is noticed */
        double r = 1 / sqrt(t), k = c1 + r * (c0 + c2 * t);
        b->displacement[d] += k * force;
        mine[d] = k * b->force[d];
    }
    double sum = 0;
    for (int d = 0; d < n; d++) sum += mine[d];
    a->displacement[c] += sum;
    return same;
}

bool nlc_case_one_within(nlc_block *a, const nlc_kernel *kernel)
{
    int same = 0;
    for (int c = 1; c < a->count; c++) same |= row(a, c, a, c, kernel);
    return !same;
}

bool nlc_case_one_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    int same = 0;
    for (int c = 0; c < a->count; c++) same |= row(a, c, b, b->count, kernel);
    return !same;
}
