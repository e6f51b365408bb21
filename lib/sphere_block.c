/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * sphere_block.c - the elastic sphere to second order in contact radius / radius, over the contacts of one particle.
 *
 * From displacement is subtracted, and to second added, over the other contacts d of the block,
 *     v_c = sum [ P_d S(c,d) + P_d (a_d/R)^2 D(c,d) / 10 ]   and   w_c = sum P_d D(c,d),
 * P being the force and P (a_d/R)^2 / 10 the shape: the surface moves inward at c by U [ v_c + (a_c/R)^2 w_c / 6 ] on account of
 * them.  Their small changes are the same sums with another shape, the tangent's coefficients S + [(a_c/R)^2 + (a_d/R)^2] D / 6.
 * That is for chi = 1; for others see add_tilted.
 *
 * S and D are the same for (c, d) and (d, c), so each pair is looked at once, and as they are all that takes time, they are
 * computed for many pairs in one loop, which a compiler turns into vectors.  They do not depend on the forces.
 */
#include "model.h"
#include "sphere.h"

#define PAIRS 256 /* at a time */

/* Directions at a distance below 2^-100 count as equal: the difference of such bits of h^2 is negative. */
#define EQUAL_BITS ((uint64_t)(1023 - 200) << 52)

bool nlc_sphere_evaluate(double *restrict s, double *restrict d, const double *restrict t, int n,
                         const nlc_sphere_constants *restrict constants)
{
    uint64_t equal = 0;
    for (int k = 0; k < n; k++) {
        const nlc_sphere_pair p = nlc_sphere_at(t[k], constants);
        equal |= nlc_bits(t[k]) - EQUAL_BITS;
        s[k] = p.s;
        d[k] = p.d;
    }
    return equal < NLC_SIGN_BIT;
}

/* Pairs at a distance of shift in the block's list, the list taken as a ring: n, or the half of it that meets each once. */
static int length(int shift, int n)
{
    return 2 * shift == n ? shift : n;
}

static void ring_distances(double *restrict t, const nlc_block *restrict a, int shift, int n)
{
    for (int c = 0; c < n; c++) {
        const int d = c + shift;
        const double dx = a->x[c] - a->x[d], dy = a->y[c] - a->y[d], dz = a->z[c] - a->z[d];
        t[c] = dx * dx + dy * dy + dz * dz;
    }
}

/* What the pairs give to the contact at their near end and at their far end. */
typedef struct sums {
    double v[2 * NLC_BLOCK], w[2 * NLC_BLOCK];
} sums;

static void ring_sums(sums *restrict mine, sums *restrict theirs, const double *restrict s, const double *restrict d,
                      const nlc_block *restrict a, int shift, int n)
{
    for (int c = 0; c < n; c++) {
        mine->v[c] += s[c] * a->force[c + shift] + d[c] * a->shape[c + shift];
        mine->w[c] += d[c] * a->force[c + shift];
        theirs->v[c + shift] += s[c] * a->force[c] + d[c] * a->shape[c];
        theirs->w[c + shift] += d[c] * a->force[c];
    }
}

static void copy_ring(double *x, int n)
{
    for (int c = 0; c < n; c++) x[n + c] = x[c];
}

static double squared(const nlc_block *a, int c, const nlc_block *b, int d)
{
    const double x = a->x[c] - b->x[d], y = a->y[c] - b->y[d], z = a->z[c] - b->z[d];
    return x * x + y * y + z * z;
}

/*
 * What is added where tractions are tilted: D is D(1) + (chi - 1) E, E = D(1) - D(0), with the source's chi in v and the receiver's
 * in w, which is therefore left in two parts, sum P_d D(1) in second and sum P_d E in third.  moment: shape times tilt, of c and of
 * all of b.
 */
static void add_tilted_moments(nlc_block *a, int c, nlc_block *b, int count, double own, const double *restrict moment,
                               const nlc_kernel *kernel)
{
    double e[NLC_BLOCK], v = 0, w = 0;
    for (int d = 0; d < count; d++) e[d] = nlc_sphere_tilt_at(squared(a, c, b, d), &kernel->tilted);
    for (int d = 0; d < count; d++) {
        b->displacement[d] -= e[d] * own;
        b->third[d] += e[d] * a->force[c];
        v += e[d] * moment[d];
        w += e[d] * b->force[d];
    }
    a->displacement[c] -= v;
    a->third[c] += w;
}

static void add_tilted(nlc_block *a, int c, nlc_block *b, int count, const nlc_kernel *kernel)
{
    double moment[NLC_BLOCK];
    for (int d = 0; d < count; d++) moment[d] = b->shape[d] * b->tilt[d];
    add_tilted_moments(a, c, b, count, a->shape[c] * a->tilt[c], moment, kernel);
}

void nlc_sphere_tilt_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    for (int c = 0; c < a->count; c++) add_tilted_moments(a, c, b, b->count, a->tilt[c], b->tilt, kernel);
}

bool nlc_sphere_within(nlc_block *a, const nlc_kernel *kernel)
{
    const nlc_sphere_constants *constants = &kernel->sphere;
    const int n = a->count, end = n / 2 + 1;
    double t[PAIRS], room[2][PAIRS], *s = room[0], *d = room[1], *kept = a->kept;
    sums mine, theirs;
    bool distinct = true;
    copy_ring(a->x, n);
    copy_ring(a->y, n);
    copy_ring(a->z, n);
    copy_ring(a->force, n);
    copy_ring(a->shape, n);
    for (int c = 0; c < 2 * n; c++) mine.v[c] = mine.w[c] = theirs.v[c] = theirs.w[c] = 0;
    for (int shift = 1, first = 1, pairs; shift < end; first = shift) {
        pairs = 0;
        do {
            if (!a->known) ring_distances(t + pairs, a, shift, length(shift, n));
            pairs += length(shift++, n);
        } while (shift < end && pairs + n <= PAIRS);
        if (kept) {
            s = kept;
            d = kept += pairs;
            kept += pairs;
        }
        if (!a->known) distinct &= nlc_sphere_evaluate(s, d, t, pairs, constants);
        for (pairs = 0; first < shift; pairs += length(first++, n))
            ring_sums(&mine, &theirs, s + pairs, d + pairs, a, first, length(first, n));
    }
    for (int c = 0; c < n; c++) {
        a->displacement[c] -= mine.v[c] + (theirs.v[c] + theirs.v[n + c]);
        a->second[c] += mine.w[c] + (theirs.w[c] + theirs.w[n + c]);
    }
    for (int c = 1; c < n && a->tilted; c++) add_tilted(a, c, a, c, kernel);
    return distinct;
}

/* Between contact c of a and all of b. */
static bool row(nlc_block *restrict a, int c, nlc_block *restrict b, const nlc_sphere_constants *constants)
{
    const double x = a->x[c], y = a->y[c], z = a->z[c], force = a->force[c], moment = a->shape[c];
    double t[NLC_BLOCK] = {0}, s[NLC_BLOCK], d[NLC_BLOCK], v = 0, w = 0;
    for (int k = 0; k < b->count; k++) {
        const double dx = x - b->x[k], dy = y - b->y[k], dz = z - b->z[k];
        t[k] = dx * dx + dy * dy + dz * dz;
    }
    const bool distinct = nlc_sphere_evaluate(s, d, t, b->count, constants);
    for (int k = 0; k < b->count; k++) {
        b->displacement[k] -= s[k] * force + d[k] * moment;
        b->second[k] += d[k] * force;
        v += s[k] * b->force[k] + d[k] * b->shape[k];
        w += d[k] * b->force[k];
    }
    a->displacement[c] -= v;
    a->second[c] += w;
    return distinct;
}

bool nlc_sphere_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    bool distinct = true;
    for (int c = 0; c < a->count; c++) {
        distinct &= row(a, c, b, &kernel->sphere);
        if (a->tilted || b->tilted) add_tilted(a, c, b, b->count, kernel);
    }
    return distinct;
}

static void distances(double *restrict t, const nlc_block *restrict a, int c)
{
    for (int k = 0; k < c; k++) {
        const double dx = a->x[c] - a->x[k], dy = a->y[c] - a->y[k], dz = a->z[c] - a->z[k];
        t[k] = dx * dx + dy * dy + dz * dz;
    }
}

/* False: two directions are equal, or nearly. */
static bool coefficients(double *coefficient, const nlc_block *a, int c, const nlc_kernel *kernel)
{
    double t[NLC_BLOCK] = {0}, s[NLC_BLOCK], d[NLC_BLOCK];
    distances(t, a, c);
    const bool distinct = nlc_sphere_evaluate(s, d, t, c, &kernel->sphere);
    for (int k = 0; k < c; k++) coefficient[k] = -(s[k] + (a->shape[c] + a->shape[k]) * d[k]);
    for (int k = 0; k < c && a->tilted; k++)
        coefficient[k] -= (a->shape[c] * a->tilt[c] + a->shape[k] * a->tilt[k]) * nlc_sphere_tilt_at(t[k], &kernel->tilted);
    return distinct;
}

void nlc_sphere_coefficients(double *coefficient, const nlc_block *a, int c, const nlc_kernel *kernel)
{
    coefficients(coefficient, a, c, kernel);
}

/* Of equal directions, which on ranks may not have been told of yet, no squares: they would overflow. */
double nlc_sphere_squares(nlc_block *a, const nlc_kernel *kernel)
{
    double coefficient[NLC_BLOCK], total = 0;
    for (int c = 1; c < a->count; c++) {
        double sum = 0;
        if (!coefficients(coefficient, a, c, kernel)) return INFINITY;
        for (int k = 0; k < c; k++) sum += coefficient[k] * coefficient[k] * a->force[k];
        total += sum * a->force[c];
    }
    return total;
}
