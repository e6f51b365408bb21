/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * boussinesq_block.c - Case I of [GC] over the contacts of one particle.
 *
 * With t = |N_c - N_d|^2 = 4 s^2 and r = 1/sqrt(t), [GC] 5 divided by the force is
 *     U [ -4(1-nu) r - 2(1-2nu) + (7-8nu)/2 t r ] = U [ c0 r + c1 + c2 t r ]:
 * one square root and one division a pair, no trigonometry, and all digits for neighbouring contacts.  The coefficient is
 * the same for (c, d) and (d, c), so each pair is looked at once.
 *
 * Two equal directions are an error, noticed when a block is done: DBL_MIN keeps it from dividing by zero before, and is too
 * small to change any other result.  A comparison inside the loops would keep compilers from making vectors of them, so the
 * sum of r is looked at: beyond 2^100 a direction has another one within 1e-28 of it.
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
    kernel->poisson = poisson;
    kernel->prefactor = prefactor;
    kernel->c[0] = -4 * (1 - poisson) * prefactor;
    kernel->c[1] = -2 * (1 - 2 * poisson) * prefactor;
    kernel->c[2] = (7 - 8 * poisson) / 2 * prefactor;
}

/*
 * All pairs of a block at a distance of shift in its list, the list taken as a ring.  Shifts 1 ... count/2 meet every pair
 * once, and each of them is one long loop without a sum over it, which a compiler turns into vectors.
 */
static void ring(nlc_block *restrict a, double *restrict theirs, double *restrict nearness, int shift, int n,
                 const nlc_kernel *kernel)
{
    const double c0 = kernel->c[0], c1 = kernel->c[1], c2 = kernel->c[2];
    for (int c = 0; c < n; c++) {
        const int d = c + shift;
        double dx = a->x[c] - a->x[d], dy = a->y[c] - a->y[d], dz = a->z[c] - a->z[d];
        double t = dx * dx + dy * dy + dz * dz;
        double r = 1 / sqrt(t + DBL_MIN), k = c1 + r * (c0 + c2 * t);
        nearness[c] += r;
        a->displacement[c] += k * a->force[d];
        theirs[d] += k * a->force[c];
    }
}

static bool distinct(const double *nearness, int n)
{
    for (int c = 0; c < n; c++)
        if (nearness[c] >= nlc_pow2(100)) return false;
    return true;
}

static void copy_ring(double *x, int n)
{
    for (int c = 0; c < n; c++) x[n + c] = x[c];
}

bool nlc_case_one_within(nlc_block *a, const nlc_kernel *kernel)
{
    const int n = a->count;
    double theirs[2 * NLC_BLOCK], nearness[NLC_BLOCK];
    copy_ring(a->x, n);
    copy_ring(a->y, n);
    copy_ring(a->z, n);
    copy_ring(a->force, n);
    for (int c = 0; c < 2 * n; c++) theirs[c] = 0;
    for (int c = 0; c < n; c++) nearness[c] = 0;
    for (int shift = 1; 2 * shift < n; shift++) ring(a, theirs, nearness, shift, n, kernel);
    if (n % 2 == 0) ring(a, theirs, nearness, n / 2, n / 2, kernel);
    for (int c = 0; c < n; c++) a->displacement[c] += theirs[c] + theirs[n + c];
    return distinct(nearness, n);
}

/* Between contact c of a and all of b. */
static void row(nlc_block *restrict a, int c, nlc_block *restrict b, double *restrict nearness, const nlc_kernel *kernel)
{
    const double x = a->x[c], y = a->y[c], z = a->z[c], force = a->force[c];
    const double c0 = kernel->c[0], c1 = kernel->c[1], c2 = kernel->c[2];
    double mine[NLC_BLOCK], sum = 0;
    for (int d = 0; d < b->count; d++) {
        double dx = x - b->x[d], dy = y - b->y[d], dz = z - b->z[d];
        double t = dx * dx + dy * dy + dz * dz;
        double r = 1 / sqrt(t + DBL_MIN), k = c1 + r * (c0 + c2 * t);
        nearness[d] += r;
        b->displacement[d] += k * force;
        mine[d] = k * b->force[d];
    }
    for (int d = 0; d < b->count; d++) sum += mine[d];
    a->displacement[c] += sum;
}

bool nlc_case_one_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    double nearness[NLC_BLOCK] = {0};
    for (int c = 0; c < a->count; c++) row(a, c, b, nearness, kernel);
    return distinct(nearness, b->count);
}

void nlc_case_one_coefficients(double *coefficient, const nlc_block *a, int c, const nlc_kernel *kernel)
{
    for (int d = 0; d < c; d++) {
        double dx = a->x[c] - a->x[d], dy = a->y[c] - a->y[d], dz = a->z[c] - a->z[d];
        double t = dx * dx + dy * dy + dz * dz, r = 1 / sqrt(t + DBL_MIN);
        coefficient[d] = kernel->c[1] + r * (kernel->c[0] + kernel->c[2] * t);
    }
}

/* Of two equal directions, in squares: much less than distances that are told apart, and none overflows. */
#define NO_DISTANCE 0x1p-260
static void ring_of_squares(const nlc_block *restrict a, double *restrict sum, int shift, int n, const nlc_kernel *kernel)
{
    const double c0 = kernel->c[0], c1 = kernel->c[1], c2 = kernel->c[2];
    for (int c = 0; c < n; c++) {
        const int d = c + shift;
        double dx = a->x[c] - a->x[d], dy = a->y[c] - a->y[d], dz = a->z[c] - a->z[d];
        double t = dx * dx + dy * dy + dz * dz, r = 1 / sqrt(t + NO_DISTANCE), k = c1 + r * (c0 + c2 * t);
        sum[c] += k * k * a->force[d];
    }
}

double nlc_case_one_squares(nlc_block *a, const nlc_kernel *kernel)
{
    const int n = a->count;
    double sum[NLC_BLOCK] = {0}, total = 0;
    copy_ring(a->x, n);
    copy_ring(a->y, n);
    copy_ring(a->z, n);
    copy_ring(a->force, n);
    for (int shift = 1; 2 * shift < n; shift++) ring_of_squares(a, sum, shift, n, kernel);
    if (n % 2 == 0) ring_of_squares(a, sum, n / 2, n / 2, kernel);
    for (int c = 0; c < n; c++) total += sum[c] * a->force[c];
    return total;
}

double nlc_case_one_most(const nlc_kernel *kernel, double distance)
{
    return fabs(kernel->c[0]) / distance + fabs(kernel->c[1]) + 2 * fabs(kernel->c[2]); /* |N_c - N_d| is at most 2 */
}

/* c = c0 t^(-1/2) + c1 + c2 t^(1/2) */
double nlc_case_one_turning(const nlc_kernel *kernel, double t, double moment, double tilted)
{
    const double r = 1 / sqrt(t + DBL_MIN);
    (void)moment, (void)tilted;
    return 0.5 * r * (kernel->c[2] - kernel->c[0] * r * r);
}
