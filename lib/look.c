/* SPDX-License-Identifier: BSD-2-Clause */
/* look.c - what a sweep says of the start whose forces it was of: residuals, energy, overlaps. */
#include "close.h"
#include "collective.h"
#include "slabs.h"
#include "warm.h"

typedef struct job {
    nlc_iteration *q;
    const nlc_guess *from;
} job;

/* What there is to know of them: |residual|, overlap alone (close.h); energy and slope, which scales.c wants of their particles. */
typedef struct chunk {
    double size[NLC_CHUNK], alone[NLC_CHUNK], energy[NLC_CHUNK], slope[NLC_CHUNK];
} chunk;

/* A chunk, but for those that the inner loops of the processor have done. */
static void look_at(const job *w, int64_t from, int count, chunk *seen, nlc_view *r)
{
    const nlc_iteration *q = w->q;
    const nlc_network *n = q->n;
    const nlc_variant *v = n->settings.variant;
    int d = v ? v->look(q, w->from, from, count, seen->size, seen->alone, seen->energy, seen->slope, r) : 0;
    for (; d < count; d++) {
        const int64_t c = from + d;
        const double x = q->overlap[c] * q->load, g = n->side[2 * c] + n->side[2 * c + 1], k = nlc_scaled_stiffness(q, c);
        const double before = nlc_guessed_overlap(q, w->from, c), y = x + g;
        const double positive = 0.5 * (y + fabs(y)), rise = k * sqrt(positive < NLC_FARTHEST ? positive : NLC_FARTHEST);
        r->lost |= fabs(g) > 0.5 * NLC_FARTHEST;
        r->grown |= y > nlc_weighed_overlap(before);
        seen->size[d] = fabs(rise * positive - n->force[c]);
        seen->alone[d] = nlc_alone(x, g);
        seen->energy[d] = seen->size[d] * fabs(y - before);
        seen->slope[d] = 1.5 * rise;
    }
}

static inline void judge(const nlc_network *n, int64_t c, double size, nlc_view *r)
{
    const double a = n->largest[n->i[c]], b = n->largest[n->j[c]], scale = a > b ? a : b;
    r->moving += size > n->settings.tolerance * scale;
    if (size <= r->ratio * scale) return;
    const double ratio = nlc_ratio(size, scale); /* of next to nothing over nothing it may be less all the same */
    if (ratio <= r->ratio) return;
    r->ratio = ratio;
    r->where = c;
}

static inline void add_to(const nlc_network *n, int64_t body, double energy, double slope)
{
    if (body >= n->particle_count) return;
    n->bound[body] += energy;
    n->growth[body] = slope > n->growth[body] ? slope : n->growth[body];
}

/*
 * Contacts of one particle often follow each other.  Its sums are carried along then, for to read what has just been written takes
 * longer than to add to it.
 */
static void add_up(const nlc_network *n, int64_t from, int count, const chunk *seen)
{
    int64_t last = -1;
    double sum = 0, top = 0;
    for (int d = 0; d < count; d++) {
        const int64_t i = n->i[from + d], j = n->j[from + d];
        if (i < n->particle_count) {
            const double sum_there = n->bound[i], top_there = n->growth[i];
            sum = (i == last ? sum : sum_there) + seen->energy[d];
            top = i == last ? top : top_there;
            top = seen->slope[d] > top ? seen->slope[d] : top;
            n->bound[i] = sum;
            n->growth[i] = top;
        }
        add_to(n, j, seen->energy[d], seen->slope[d]);
        last = i == j ? -1 : i;
    }
}

/* Threads leave with each contact what is added up afterwards, particle by particle: in the same order. */
static void look_task(void *work, int64_t s)
{
    const job *w = work;
    const nlc_network *n = w->q->n;
    const int64_t end = nlc_end_of(s, NLC_SLAB, n->contact_count);
    nlc_view r = {.where = -1};
    for (int64_t from = s * NLC_SLAB; from < end; from += NLC_CHUNK) {
        const int count = end - from < NLC_CHUNK ? (int)(end - from) : NLC_CHUNK;
        chunk seen;
        look_at(w, from, count, &seen, &r);
        for (int d = 0; d < count; d++) {
            judge(n, from + d, seen.size[d], &r);
            r.circle = nlc_larger_circle(n, from + d, seen.alone[d], r.circle);
        }
        if (!n->settings.parallel_for) add_up(n, from, count, &seen);
        for (int d = 0; d < count && n->settings.parallel_for; d++) {
            n->own[2 * (from + d)] = seen.energy[d];
            n->own[2 * (from + d) + 1] = seen.slope[d];
        }
    }
    n->piece[s] = (nlc_piece){.residual = r.ratio, .bad = r.where, .count = r.moving, .force = r.circle, .flag = {r.grown, r.lost}};
}

static void add_task(void *work, int64_t v)
{
    const nlc_network *n = ((const job *)work)->q->n;
    for (int64_t k = v * NLC_WINDOW; k < nlc_end_of(v, NLC_WINDOW, n->owned); k++) {
        n->bound[k] = n->growth[k] = 0;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) add_to(n, k, n->own[n->entry[p] & ~1], n->own[n->entry[p] | 1]);
    }
}

nlc_view nlc_look(nlc_iteration *q, const nlc_guess *from)
{
    nlc_network *n = q->n;
    job all = {q, from};
    nlc_view r = {.where = -1};
    for (int64_t k = 0; k < n->particle_count; k++) n->bound[k] = n->growth[k] = 0;
    nlc_for(n, look_task, &all, nlc_slabs(n));
    for (int64_t s = 0; s < nlc_slabs(n); s++) {
        const nlc_piece *piece = &n->piece[s];
        r.grown |= piece->flag[0];
        r.lost |= piece->flag[1];
        r.moving += piece->count;
        r.circle = piece->force > r.circle ? piece->force : r.circle;
        if (piece->residual > r.ratio) r.where = piece->bad;
        r.ratio = piece->residual > r.ratio ? piece->residual : r.ratio;
    }
    if (n->settings.parallel_for) nlc_for(n, add_task, &all, nlc_windows(n));
    const double energy = nlc_energy_ratio(n, n->bound, n->growth);
    r.ratio = energy > r.ratio ? energy : r.ratio;
    return r;
}

void nlc_look_over_ranks(nlc_network *n, nlc_view *r, nlc_info *info)
{
    double values[4] = {r->ratio, r->grown, r->lost, info->lambda_upper};
    nlc_max_over_ranks(n, values, 4);
    if (values[0] > r->ratio) r->where = -1;
    if (values[3] > info->lambda_upper) info->critical_particle = -1;
    r->ratio = values[0];
    r->grown = values[1] > 0;
    r->lost = values[2] > 0;
    info->lambda_upper = values[3];
}
