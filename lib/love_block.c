/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * love_block.c - Case II of [GC] over the contacts of one particle: what the pressure on the circle of d, of radius shape times
 * R, does at c.  Not the same as what c does at d, unless their circles are of the same size.
 */
#include <float.h>

#include "love.h"
#include "model.h"

void nlc_love_prepare(nlc_kernel *kernel, double poisson, double prefactor)
{
    (void)prefactor;
    nlc_half_space_prepare(kernel, poisson, 1); /* Case I, for what has to be symmetric */
    kernel->poisson = poisson;
}

/* Contact c of a by all of b; returns whether one lies in the same direction. */
static bool row(nlc_block *a, int c, const nlc_block *b, double poisson, bool same)
{
    const double x = a->x[c], y = a->y[c], z = a->z[c];
    double part[NLC_BLOCK], sum = 0, nearest = 4;
    for (int d = 0; d < b->count; d++) {
        const double dx = x - b->x[d], dy = y - b->y[d], dz = z - b->z[d], t = dx * dx + dy * dy + dz * dz;
        const double apart = t + (same && d == c ? 1 : DBL_MIN); /* its own place is not looked at: 1 */
        part[d] = nlc_love_kernel(0.5 * sqrt(apart), b->shape[d], poisson) * b->force[d];
    }
    for (int d = 0; d < b->count; d++) {
        if (same && d == c) continue;
        const double dx = x - b->x[d], dy = y - b->y[d], dz = z - b->z[d], t = dx * dx + dy * dy + dz * dz;
        nearest = t < nearest ? t : nearest;
        sum += part[d];
    }
    a->displacement[c] += sum;
    return nearest <= 0x1p-200;
}

bool nlc_love_within(nlc_block *a, const nlc_kernel *kernel)
{
    bool same = false;
    for (int c = 0; c < a->count; c++) same |= row(a, c, a, kernel->poisson, true);
    return !same;
}

bool nlc_love_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    bool same = false;
    for (int c = 0; c < a->count; c++) same |= row(a, c, b, kernel->poisson, false);
    for (int d = 0; d < b->count; d++) same |= row(b, d, a, kernel->poisson, false);
    return !same;
}
