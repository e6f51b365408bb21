/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * lanes_blocks.h - Case I between two blocks, with a contact of the second one in each lane of a vector; for particles with more
 * contacts than a block holds.  The rest of the template in lanes.h, which includes it.
 */

/* Fills the block up to whole vectors: contacts without force, inside the sphere. */
static void complete(nlc_block *b, double *displacement)
{
    for (int d = 0; d < NLC_BLOCK; d++) displacement[d] = 0;
    for (int d = b->count; d % LANES != 0; d++) {
        b->x[d] = (double)d / 256;
        b->y[d] = b->z[d] = b->force[d] = 0;
    }
}

/* From anywhere: the arrays of a block are not aligned to vectors. */
TARGET static inline vec pick(const double *p)
{
    vec v;
    memcpy(&v, p, sizeof v);
    return v;
}

static double add_lanes(const double *lane)
{
    double sum = 0;
    for (int l = 0; l < LANES; l++) sum += lane[l];
    return sum;
}

TARGET static bool between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    const vec c0 = set(kernel->c[0]), c1 = set(kernel->c[1]), c2 = set(kernel->c[2]);
    _Alignas(8 * LANES) double mine[NLC_BLOCK], theirs[NLC_BLOCK], lane[LANES];
    vec closest = set(4);
    complete(b, theirs);
    for (int c = 0; c < a->count; c++) {
        const vec x = set(a->x[c]), y = set(a->y[c]), z = set(a->z[c]), force = set(a->force[c]);
        vec sum = set(0);
        for (int d = 0; d < b->count; d += LANES) {
            const vec dx = sub(x, pick(b->x + d)), dy = sub(y, pick(b->y + d)), dz = sub(z, pick(b->z + d));
            const vec t = muladd(dz, dz, muladd(dy, dy, muladd(dx, dx, set(TINY))));
            const vec k = muladd(reciprocal_root(t), muladd(c2, t, c0), c1);
            closest = min(closest, t);
            sum = muladd(k, pick(b->force + d), sum);
            store(theirs + d, muladd(k, force, load(theirs + d)));
        }
        store(lane, sum);
        mine[c] = add_lanes(lane);
    }
    store(lane, closest);
    for (int l = 0; l < LANES; l++)
        if (lane[l] < NEAR) return nlc_case_one_between(a, b, kernel);
    for (int c = 0; c < a->count; c++) a->displacement[c] += mine[c];
    for (int d = 0; d < b->count; d++) b->displacement[d] += theirs[d];
    return true;
}
