/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * lanes_group.h - the contacts of as many particles as there are lanes, read from the network and handed back to it: a part of lanes.h.
 */

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

/* What is read of each contact: its force; that and the weight behind it, [contacts][2]; of each side a weight, [contacts][2]. */
typedef enum content { FORCES, WEIGHED, ROOTS } content;

/* One place; plain: each lane has a contact there, and no contact is one of a particle with itself. */
__attribute__((always_inline)) TARGET static inline void fill_place(group *g, const nlc_network *n, content what, const double *from,
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
        if (what != ROOTS) at->force[l] = from[what == FORCES ? c : 2 * c];
        if (what != FORCES) at->weight[l] = from[what == ROOTS ? e : 2 * c + 1];
    }
    if (!known) set_directions(at->x, at->y, at->z, v, reversed);
}

/* The contacts, place by place; forces are not yet times U.  known: directions are not wanted. */
TARGET static void fill(group *g, const nlc_network *n, content what, const double *from, const double *normal, bool known)
{
    const int64_t plain = n->self_contacts ? 0 : g->all;
    for (int64_t d = 0; d < plain; d++) fill_place(g, n, what, from, normal, known, d, true);
    for (int64_t d = plain; d < g->places; d++) fill_place(g, n, what, from, normal, known, d, false);
}

/*
 * What the next group will want at one place of its lists, while this one is computed: without it the processor waits for memory
 * first and computes then.  Always inlined, for gcc takes a function that does no more than this for one without effect.
 */
__attribute__((always_inline)) TARGET static inline void fetch(const nlc_network *n, content what, const double *from,
                                                               const double *normal, const int32_t *particle, int64_t d)
{
    for (int l = 0; l < LANES; l++) {
        const int64_t p = n->start[particle[l]] + d;
        if (p >= n->start[particle[l] + 1]) continue;
        const int64_t e = n->entry[p], c = e >> 1;
        __builtin_prefetch(normal + 3 * c + 1);
        __builtin_prefetch(from + (what == FORCES ? c : 2 * c));
        __builtin_prefetch(n->side + e, 1);
    }
}

static inline void hand_out(const group *g, nlc_network *n, const double *normal, int l)
{
    const int64_t *list = g->list[l], plain = n->self_contacts ? 0 : g->count[l];
    double *side = n->side;
#pragma GCC unroll 4
    for (int64_t d = 0; d < plain; d++) side[list[d]] = g->at[d].displacement[l];
    for (int64_t d = plain; d < g->count[l]; d++) side[nlc_side_at(n, normal, g->begin[l] + d)] = g->at[d].displacement[l];
}
