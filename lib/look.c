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

/* Of one contact; *energy and *slope: what scales.c wants to know of its particles. */
static inline void look_at(const nlc_iteration *q, const nlc_guess *from, int64_t c, nlc_view *r, double *energy, double *slope)
{
    const nlc_network *n = q->n;
    const double x = q->overlap[c] * q->load, g = n->side[2 * c] + n->side[2 * c + 1], k = nlc_scaled_stiffness(q, c);
    const double before = nlc_guessed_overlap(q, from, c), y = x + g, a = n->largest[n->i[c]], b = n->largest[n->j[c]];
    r->lost |= fabs(g) > 0.5 * NLC_FARTHEST;
    r->circle = nlc_larger_circle(n, c, nlc_alone(x, g), r->circle);
    r->grown |= y > 0 && y > nlc_weighed_overlap(before);
    const double positive = 0.5 * (y + fabs(y)), rise = k * sqrt(positive < NLC_FARTHEST ? positive : NLC_FARTHEST);
    const double size = fabs(rise * positive - n->force[c]), scale = a > b ? a : b;
    *energy = size * fabs(y - before);
    *slope = 1.5 * rise;
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

/* Threads leave with each contact what is added up afterwards, particle by particle: in the same order. */
static void look_task(void *work, int64_t s)
{
    const job *w = work;
    const nlc_network *n = w->q->n;
    const bool alone = !n->settings.parallel_for;
    nlc_view r = {.where = -1};
    for (int64_t c = s * NLC_SLAB; c < nlc_end_of(s, NLC_SLAB, n->contact_count); c++) {
        double energy, slope;
        look_at(w->q, w->from, c, &r, &energy, &slope);
        if (alone) {
            add_to(n, n->i[c], energy, slope);
            add_to(n, n->j[c], energy, slope);
        } else {
            n->own[2 * c] = energy;
            n->own[2 * c + 1] = slope;
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
