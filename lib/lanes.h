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
 *     set_directions: x, y, z [LANES] from the rows v [LANES], those reversed that have a bit in reversed
 * The memory of load and store is aligned to whole vectors, that of loadu and storeu to doubles.
 */
#include "crowd.h"
#include "iteration.h"

#define NEAR 0x1p-46  /* squared distance that is left to the portable code */
#define TINY 0x1p-100 /* keeps t from 0; too small to change a t from NEAR on */
#define FAR 20000     /* of so few contacts everything is in the second cache: to fetch it ahead would cost more than it saves */

/* What is known of one contact of each of the particles. */
typedef struct place {
    _Alignas(8 * LANES) double x[LANES], y[LANES], z[LANES]; /* outward unit normal */
    double force[LANES];                                     /* times U, from where it has been met on */
    double weight[LANES];                                    /* where it is asked for */
    double displacement[LANES];
} place;

typedef struct group {
    place at[NLC_BLOCK];
    int64_t particle[LANES], begin[LANES], count[LANES]; /* of the particles' lists */
    const int64_t *list[LANES];
    int64_t places, all; /* the largest count and the least */
    _Alignas(8 * LANES) double scale[LANES], c0[LANES], c1[LANES], c2[LANES];
    double largest[LANES], closest[LANES], squares[LANES]; /* |force|; squared distance; see variant.h */
} group;

/* Where there are not enough particles the last one takes several lanes. */
static void choose(group *g, const nlc_network *n, const int32_t *particle, int count)
{
    g->places = 0;
    g->all = NLC_BLOCK;
    for (int l = 0; l < LANES; l++) {
        const int64_t k = particle[l < count ? l : count - 1];
        const nlc_kernel *kernel = nlc_kernel_of(n, k);
        g->particle[l] = k;
        g->begin[l] = n->start[k];
        g->count[l] = n->start[k + 1] - n->start[k];
        g->list[l] = n->entry + g->begin[l];
        g->places = g->count[l] > g->places ? g->count[l] : g->places;
        g->all = g->count[l] < g->all ? g->count[l] : g->all;
        g->scale[l] = nlc_scale_of(n, k);
        g->c0[l] = kernel->c[0];
        g->c1[l] = kernel->c[1];
        g->c2[l] = kernel->c[2];
    }
}

/* Where the particle of a lane has no further contact there is one without force. */
static const double *nowhere(double row[3], int64_t d)
{
    row[0] = 2 + 2 * (double)d;
    row[1] = row[2] = 0;
    return row;
}

/* What a group does about its coefficients. */
typedef struct keeping {
    double *at; /* [pairs of places][LANES], or NULL: they are computed and forgotten */
    bool known; /* they are there */
} keeping;

static int64_t room_for(int64_t places)
{
    return LANES * places * (places - 1) / 2;
}

/* One place; plain: each lane has a contact there, and no contact is one of a particle with itself. */
__attribute__((always_inline)) TARGET static inline void fill_place(group *g, const nlc_network *n, const double *force, int64_t stride,
                                                                    const double *normal, bool known, int64_t d, bool plain)
{
    place *at = &g->at[d];
    double none[3];
    const double *v[LANES];
    unsigned reversed = 0;
#pragma GCC unroll 8
    for (int l = 0; l < LANES; l++) {
        if (!plain) {
            at->force[l] = at->weight[l] = 0;
            v[l] = nowhere(none, d);
            if (d >= g->count[l]) continue;
        }
        const int64_t e = plain ? g->list[l][d] : nlc_side_at(n, normal, g->begin[l] + d), c = e >> 1;
        v[l] = normal + 3 * c;
        reversed |= (unsigned)(e & 1) << l;
        at->force[l] = force[stride * c];
        if (stride == 2) at->weight[l] = force[2 * c + 1];
    }
    if (!known) set_directions(at->x, at->y, at->z, v, reversed);
}

/* The contacts, place by place; forces are not yet times U.  stride 2: a weight stands behind each of them. */
TARGET static void fill(group *g, const nlc_network *n, const double *force, int64_t stride, const double *normal, bool known)
{
    const int64_t plain = n->self_contacts ? 0 : g->all;
    for (int64_t d = 0; d < plain; d++) fill_place(g, n, force, stride, normal, known, d, true);
    for (int64_t d = plain; d < g->places; d++) fill_place(g, n, force, stride, normal, known, d, false);
}

/*
 * What the next group will want at one place of its lists, while this one is computed: without it the processor waits for memory
 * first and computes then.  Always inlined, for gcc takes a function that does no more than this for one without effect.
 */
__attribute__((always_inline)) TARGET static inline void fetch(const nlc_network *n, const double *force, int64_t stride,
                                                               const double *normal, const int32_t *particle, int64_t d)
{
    for (int l = 0; l < LANES; l++) {
        const int64_t p = n->start[particle[l]] + d;
        if (p >= n->start[particle[l] + 1]) continue;
        const int64_t e = n->entry[p], c = e >> 1;
        __builtin_prefetch(normal + 3 * c + 1);
        __builtin_prefetch(force + stride * c);
        __builtin_prefetch(n->side + e, 1);
    }
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
__attribute__((always_inline)) TARGET static inline void couple(group *g, const nlc_network *n, const double *from, int64_t stride,
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
        if (next) fetch(n, from, stride, normal, next, c);
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
            if (stride == 2) weight = muladd(mul(k, k), load(b->weight), weight);
        }
        store(a->displacement, sum);
        if (stride == 2) squares = muladd(weight, load(a->weight), squares);
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
    couple(g, n, force, 1, normal, next, kept, false);
}

TARGET static void couple_weighed(group *g, const nlc_network *n, const double *weighed, const double *normal, const int32_t *next,
                                  double *kept)
{
    couple(g, n, weighed, 2, normal, next, kept, false);
}

TARGET static void couple_known(group *g, const nlc_network *n, const double *force, const double *normal, const int32_t *next, double *kept)
{
    couple(g, n, force, 1, normal, next, kept, true);
}

static inline void hand_out(const group *g, nlc_network *n, const double *normal, int l)
{
    const int64_t *list = g->list[l], plain = n->self_contacts ? 0 : g->count[l];
    double *side = n->side;
#pragma GCC unroll 4
    for (int64_t d = 0; d < plain; d++) side[list[d]] = g->at[d].displacement[l];
    for (int64_t d = plain; d < g->count[l]; d++) side[nlc_side_at(n, normal, g->begin[l] + d)] = g->at[d].displacement[l];
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
        if (weighed) fill(&g, n, weighed, 2, normal, false);
        else if (kept.known) fill(&g, n, force, 1, normal, true);
        else fill(&g, n, force, 1, normal, false);
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

const nlc_variant VARIANT = {displace_window, kept_in, mark_above, residuals, between};
