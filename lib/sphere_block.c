/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * sphere_block.c - the elastic sphere to second order in contact radius / radius, over the contacts of one particle.
 *
 * To displacement and second are added, over the other contacts d of the block,
 *     v_c = sum [ P_d S(c,d) + P_d (a_d/R)^2 D(c,d) / 10 ]   and   w_c = sum P_d D(c,d):
 * the surface moves inward at c by U [ v_c + (a_c/R)^2 w_c / 6 ] on account of them.  Here chi = 1: the source's a_d goes with
 * D at the source's chi, the receiver's a_c with D at the receiver's, so that other chi ask for a third sum.
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

/* What a contact gives to others. */
typedef struct source {
    double force[2 * NLC_BLOCK], moment[2 * NLC_BLOCK]; /* P, P a^2 / (10 R^2) */
} source;

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
                      const source *restrict p, int shift, int n)
{
    for (int c = 0; c < n; c++) {
        mine->v[c] += s[c] * p->force[c + shift] + d[c] * p->moment[c + shift];
        mine->w[c] += d[c] * p->force[c + shift];
        theirs->v[c + shift] += s[c] * p->force[c] + d[c] * p->moment[c];
        theirs->w[c + shift] += d[c] * p->force[c];
    }
}

static void copy_ring(double *x, int n)
{
    for (int c = 0; c < n; c++) x[n + c] = x[c];
}

static void set_source(source *p, const nlc_block *a)
{
    for (int c = 0; c < a->count; c++) {
        p->force[c] = a->force[c];
        p->moment[c] = a->force[c] * a->radius2[c] * 0.1;
    }
}

bool nlc_sphere_within(nlc_block *a, const nlc_sphere_constants *constants)
{
    const int n = a->count, end = n / 2 + 1;
    double t[PAIRS], s[PAIRS], d[PAIRS];
    sums mine, theirs;
    source p;
    bool distinct = true;
    copy_ring(a->x, n);
    copy_ring(a->y, n);
    copy_ring(a->z, n);
    set_source(&p, a);
    copy_ring(p.force, n);
    copy_ring(p.moment, n);
    for (int c = 0; c < 2 * n; c++) mine.v[c] = mine.w[c] = theirs.v[c] = theirs.w[c] = 0;
    for (int shift = 1, first = 1, pairs; shift < end; first = shift) {
        pairs = 0;
        do {
            ring_distances(t + pairs, a, shift, length(shift, n));
            pairs += length(shift++, n);
        } while (shift < end && pairs + n <= PAIRS);
        distinct &= nlc_sphere_evaluate(s, d, t, pairs, constants);
        for (pairs = 0; first < shift; pairs += length(first++, n))
            ring_sums(&mine, &theirs, s + pairs, d + pairs, &p, first, length(first, n));
    }
    for (int c = 0; c < n; c++) {
        a->displacement[c] += mine.v[c] + (theirs.v[c] + theirs.v[n + c]);
        a->second[c] += mine.w[c] + (theirs.w[c] + theirs.w[n + c]);
    }
    return distinct;
}

/* Between contact c of a and all of b, whose source is p. */
static bool row(nlc_block *restrict a, int c, nlc_block *restrict b, const source *restrict p,
                const nlc_sphere_constants *constants)
{
    const double x = a->x[c], y = a->y[c], z = a->z[c], force = a->force[c], moment = force * a->radius2[c] * 0.1;
    double t[NLC_BLOCK], s[NLC_BLOCK], d[NLC_BLOCK], v = 0, w = 0;
    for (int k = 0; k < b->count; k++) {
        const double dx = x - b->x[k], dy = y - b->y[k], dz = z - b->z[k];
        t[k] = dx * dx + dy * dy + dz * dz;
    }
    const bool distinct = nlc_sphere_evaluate(s, d, t, b->count, constants);
    for (int k = 0; k < b->count; k++) {
        b->displacement[k] += s[k] * force + d[k] * moment;
        b->second[k] += d[k] * force;
        v += s[k] * p->force[k] + d[k] * p->moment[k];
        w += d[k] * p->force[k];
    }
    a->displacement[c] += v;
    a->second[c] += w;
    return distinct;
}

bool nlc_sphere_between(nlc_block *a, nlc_block *b, const nlc_sphere_constants *constants)
{
    source p;
    bool distinct = true;
    set_source(&p, b);
    for (int c = 0; c < a->count; c++) distinct &= row(a, c, b, &p, constants);
    return distinct;
}
