/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * lanes.h - sweeps of Case I (boussinesq_block.c) with a particle in each lane of a vector.  A template, included by one file per
 * instruction set.
 *
 * LANES particles are done at once: a pair of places in their lists is one piece of straight code, each pair of contacts is looked
 * at once, nothing is summed across lanes, and what a lane computes does not depend on the particles beside it.  To have about as
 * many contacts in all lanes, the particles of a window are sorted by their number of contacts.  Shorter lists are filled up with
 * contacts without force, outside the sphere and far from all others, so that no arithmetic needs a mask.
 *
 * 1/sqrt(t) is an estimate y of the instruction set and one step of the series y (1-e)^(-1/2), e = 1 - t y^2: the largest
 * relative error found is 1.49 2^-53 (AVX2, t = 0x1.ffe70676fcff4p+1).  A particle with two directions closer than 2^-23 is done
 * again by the portable code, which knows what is too close: here t needs neither a test nor care for its range.  One with more
 * contacts than a block holds is left to it, too.
 *
 * Directions are read one by one and turned from rows to columns in registers (set_directions): what goes through memory as columns
 * takes three times as many instructions, and instructions that gather are not faster.
 *
 * Measured against long double: displacements are wrong by at most Z 2^-53 times the sum of the absolute terms, Z contacts.
 *
 * The including file defines
 *     LANES     particles in a vector
 *     TARGET    attributes of functions that may use the instructions
 *     VARIANT   the row of the table, see variant.h
 *     TERMS     of the series
 * the type vec: LANES doubles; and
 *     set, load, store, loadu, storeu, add, sub, mul, div, root, min, max; muladd: ab + c; nmuladd: c - ab, both rounded once
 *     estimate: 1/sqrt(t) for 2^-101 < t < 2^15
 *     store_pairs: p[0] = a[0], p[1] = b[0], p[2] = a[1] and so on
 *     add_pairs: p[0] + p[1], p[2] + p[3] and so on
 *     set_directions: x, y, z [LANES] from the rows v [LANES], those reversed that have a bit in reversed
 * The memory of load and store is aligned to whole vectors, that of loadu and storeu to doubles.
 */
#include "crowd.h"
#include "warm.h"

#define NEAR 0x1p-46  /* squared distance that is left to the portable code */
#define TINY 0x1p-100 /* keeps t from 0; too small to change a t from NEAR on */
#define FAR 20000     /* of so few contacts everything is in the second cache: to fetch it ahead would cost more than it saves */

#include "lanes_group.h"

/* What a group does about its coefficients. */
typedef struct keeping {
    double *at; /* [pairs of places][LANES], or NULL: they are computed and forgotten */
    bool known; /* they are there */
} keeping;

static int64_t room_for(int64_t places)
{
    return LANES * places * (places - 1) / 2;
}

TARGET static inline vec reciprocal_root(vec t)
{
    const vec y = estimate(t), e = nmuladd(mul(t, y), y, set(1));
    vec s = set(5. / 16);
    if (TERMS > 3) s = muladd(set(35. / 128), e, s);
    s = muladd(muladd(s, e, set(3. / 8)), e, set(0.5));
    return muladd(mul(s, e), y, y);
}

/* [GC] 5 divided by the force and by U, of two contacts at the squared distance t. */
TARGET static inline vec coefficient(vec t, vec c0, vec c1, vec c2)
{
    return muladd(reciprocal_root(t), muladd(c2, t, c0), c1);
}

TARGET static inline vec squared_distance(vec x, vec y, vec z, const place *b)
{
    const vec dx = sub(x, load(b->x)), dy = sub(y, load(b->y)), dz = sub(z, load(b->z));
    return muladd(dz, dz, muladd(dy, dy, muladd(dx, dx, set(TINY))));
}

/* All pairs.  next: the particles of the next group, or NULL. */
__attribute__((always_inline)) TARGET static inline void couple(group *g, const nlc_network *n, content what, const double *from,
                                                                const double *normal, const int32_t *next, double *kept, bool known)
{
    const vec c0 = load(g->c0), c1 = load(g->c1), c2 = load(g->c2), scale = load(g->scale);
    vec closest = set(4), squares = set(0), largest = set(0);
    for (int64_t c = 0; c < g->places; c++) {
        place *a = &g->at[c];
        const vec x = load(a->x), y = load(a->y), z = load(a->z), given = load(a->force), force = mul(given, scale);
        vec sum = set(0), weight = set(0);
        largest = max(largest, max(given, sub(set(0), given)));
        store(a->force, force);
        if (next) fetch(n, what, from, normal, next, c);
        for (place *b = g->at; b < a; b++) {
            vec k;
            if (known) {
                k = loadu(kept);
            } else {
                const vec t = squared_distance(x, y, z, b);
                k = coefficient(t, c0, c1, c2);
                closest = min(closest, t);
                if (kept) storeu(kept, k);
            }
            if (kept) kept += LANES;
            sum = muladd(k, load(b->force), sum);
            store(b->displacement, muladd(k, force, load(b->displacement)));
            if (what == WEIGHED) weight = muladd(mul(k, k), load(b->weight), weight);
        }
        store(a->displacement, sum);
        if (what == WEIGHED) squares = muladd(weight, load(a->weight), squares);
    }
    if (!known) store(g->closest, closest);
    store(g->squares, squares);
    store(g->largest, largest);
}

/* To the portable code; false: two directions are the same. */
static bool leave(nlc_network *n, const double *force, const double *normal, int64_t k)
{
    n->norm[k] = n->scale[k] == 0 || n->start[k + 1] - n->start[k] < 2 ? 0 : INFINITY;
    return nlc_displace_particle(n, NLC_OF_FORCES, force, normal, k);
}

/* Forces alone or with weights; known coefficients, and others. */
TARGET static void couple_forces(group *g, const nlc_network *n, const double *force, const double *normal, const int32_t *next, double *kept)
{
    couple(g, n, FORCES, force, normal, next, kept, false);
}

TARGET static void couple_weighed(group *g, const nlc_network *n, const double *weighed, const double *normal, const int32_t *next,
                                  double *kept)
{
    couple(g, n, WEIGHED, weighed, normal, next, kept, false);
}

TARGET static void couple_known(group *g, const nlc_network *n, const double *force, const double *normal, const int32_t *next, double *kept)
{
    couple(g, n, FORCES, force, normal, next, kept, true);
}

/* Hands the results out; returns the first particle with two contacts in the same direction, or -1. */
static int64_t empty(const group *g, nlc_network *n, const double *force, const double *normal, bool known)
{
    int64_t bad = -1;
    for (int l = 0; l < LANES; l++) {
        const int64_t k = g->particle[l];
        hand_out(g, n, normal, l);
        n->norm[k] = g->squares[l]; /* before largest, in whose memory it may be: layout.c */
        n->largest[k] = g->largest[l];
        if (!known) n->closest[k] = g->closest[l];
        if (n->closest[k] < NEAR && !leave(n, force, normal, k) && (bad < 0 || k < bad)) bad = k;
    }
    return bad;
}

/* A particle's number of contacts, or 0 if it is left to the portable code. */
static int length_of(const nlc_network *n, int64_t k)
{
    const int64_t begin = n->start[k], end = n->start[k + 1];
    return end - begin > NLC_BLOCK || n->scale[k] == 0 ? 0 : (int)(end - begin);
}

/* The particles from first to end: those done here come first, by falling number of contacts.  Returns how many they are. */
static int sort(int32_t *sorted, const nlc_network *n, int64_t first, int64_t end)
{
    int at[NLC_BLOCK + 1] = {0}, total = 0;
    unsigned char length[NLC_WINDOW];
    for (int64_t k = first; k < end; k++) at[length[k - first] = (unsigned char)length_of(n, k)]++;
    for (int z = NLC_BLOCK; z >= 0; z--) {
        const int count = at[z];
        at[z] = total;
        total += count;
    }
    const int done_here = at[0];
    for (int64_t k = first; k < end; k++) sorted[at[length[k - first]]++] = (int32_t)k;
    return done_here;
}

/* The cache's next room for a group, or none. */
static keeping keep(const nlc_network *n, int64_t *at, int64_t places, bool weighed)
{
    const int64_t room = n->settings.cache ? (int64_t)(n->settings.cache_size / sizeof(double)) : 0, begin = *at;
    *at += room_for(places);
    if (!n->settings.cache || *at > room) return (keeping){NULL, false};
    return (keeping){n->settings.cache + begin, n->cached && !weighed};
}

static int64_t displace_window(nlc_network *n, const double *force, const double *weighed, const double *normal, int64_t first,
                               int64_t end)
{
    group g;
    int32_t sorted[NLC_WINDOW];
    const int count = sort(sorted, n, first, end), all = (int)(end - first);
    int64_t bad = -1, at = n->kept_at[first / NLC_WINDOW];
    for (int q = 0; q < count; q += LANES) {
        const int32_t *next = n->contact_count > FAR && q + 2 * LANES <= all ? sorted + q + LANES : NULL;
        choose(&g, n, sorted + q, count - q);
        const keeping kept = keep(n, &at, g.places, weighed);
        if (weighed) fill(&g, n, WEIGHED, weighed, normal, false);
        else if (kept.known) fill(&g, n, FORCES, force, normal, true);
        else fill(&g, n, FORCES, force, normal, false);
        if (weighed)
            couple_weighed(&g, n, weighed, normal, next, kept.at);
        else if (kept.known)
            couple_known(&g, n, force, normal, next, kept.at);
        else
            couple_forces(&g, n, force, normal, next, kept.at);
        const int64_t k = empty(&g, n, force, normal, kept.known);
        if (k >= 0 && (bad < 0 || k < bad)) bad = k;
    }
    for (int q = count; q < all; q++) {
        const int64_t k = sorted[q];
        if (!nlc_is_crowd(n, k) && !leave(n, force, normal, k) && (bad < 0 || k < bad)) bad = k;
    }
    return bad;
}

/* Room in the cache, in doubles, for the particles from first to end. */
static int64_t kept_in(const nlc_network *n, int64_t first, int64_t end)
{
    int32_t sorted[NLC_WINDOW];
    const int count = sort(sorted, n, first, end);
    int64_t sum = 0;
    for (int q = 0; q < count; q += LANES) sum += room_for(n->start[sorted[q] + 1] - n->start[sorted[q]]);
    return sum;
}

#include "lanes_blocks.h"
#include "lanes_bound.h"
#include "lanes_residuals.h"
#include "lanes_warm.h"

const nlc_variant VARIANT = {displace_window, kept_in, mark_above, residuals, start, look, between};
