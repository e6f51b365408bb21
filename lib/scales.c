/* SPDX-License-Identifier: BSD-2-Clause */
/* scales.c - errors relative to the largest force nearby. */
#include "collective.h"
#include "iteration.h"
#include "slabs.h"

/* Part of the residual's energy norm by which the error is at least estimated: see nlc_energy_residual. */
#define ENERGY 0.33

/* What is left of an iterate where all is open, in units of the largest force: it moves nothing, and has nothing to be compared with. */
#define NOTHING 1e-16

typedef struct job {
    const nlc_iteration *q;
    bool iterate_too;
    double *sum, *top; /* [particles] */
} job;

static double scale_of(const job *w, int64_t c)
{
    const double p = nlc_scaled_force(w->q, c), iterate = w->iterate_too ? w->q->n->force[c] : 0;
    return iterate > p ? iterate : p;
}

/* Threads go particle by particle, see nlc_largest_overlaps. */
static void scales_of_particles(void *work, int64_t from, int64_t end)
{
    const job *w = work;
    const nlc_network *n = w->q->n;
    for (int64_t k = from; k < end; k++) {
        double largest = 0;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
            const double force = scale_of(w, n->entry[p] >> 1);
            largest = force > largest ? force : largest;
        }
        n->largest[k] = largest;
    }
}

void nlc_force_scales(nlc_iteration *q, bool iterate_too)
{
    nlc_network *n = q->n;
    job all = {.q = q, .iterate_too = iterate_too};
    for (int64_t k = 0; k < n->body_count; k++) n->largest[k] = 0;
    if (n->settings.parallel_for) nlc_for_particles(n, scales_of_particles, &all);
    for (int64_t c = 0; c < n->contact_count && !n->settings.parallel_for; c++) {
        const double p = scale_of(&all, c);
        const int64_t i = n->i[c], j = n->j[c];
        if (i < n->particle_count && p > n->largest[i]) n->largest[i] = p;
        if (j < n->particle_count && p > n->largest[j]) n->largest[j] = p;
    }
    nlc_exchange_particles(n, n->largest);
}

double nlc_relative_size(const nlc_iteration *q, const double *values, int64_t *where)
{
    const nlc_network *n = q->n;
    double worst = 0;
    *where = -1;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double a = n->largest[n->i[c]], b = n->largest[n->j[c]], scale = a > b ? a : b, size = fabs(values[c]);
        if (size <= worst * scale || (scale <= 0 && size <= NOTHING * q->largest_force)) continue;
        const double ratio = nlc_ratio(size, scale); /* of next to nothing over nothing it may be less all the same */
        if (ratio <= worst) continue;
        worst = ratio;
        *where = c;
    }
    return nlc_largest_over_ranks(q->n, worst, where);
}

double nlc_energy_ratio(const nlc_network *n, const double *sum, const double *top)
{
    double worst = 0;
    for (int64_t k = 0; k < n->owned; k++) {
        const double v = ENERGY * sqrt(sum[k] * top[k]);
        const double ratio = nlc_ratio(v, n->largest[k]);
        /* a particle without force has no scale of its own; its contacts have that of their other particle */
        if (n->largest[k] > 0 && ratio > worst) worst = ratio;
    }
    return worst;
}

/* What a contact adds to the energy of its particles; its slope. */
static double energy_of(const nlc_iteration *q, int64_t c, double *slope)
{
    const double y = nlc_scaled_overlap(q, c), z = q->n->direction[0][c];
    *slope = 1.5 * nlc_scaled_stiffness(q, c) * sqrt(0.5 * (y + fabs(y)));
    *slope = *slope > q->n->floor[c] ? *slope : q->n->floor[c];
    return z * z / *slope;
}

static void energies_of_particles(void *work, int64_t from, int64_t end)
{
    const job *w = work;
    const nlc_network *n = w->q->n;
    for (int64_t k = from; k < end; k++) {
        double sum = 0, top = 0, slope;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
            sum += energy_of(w->q, n->entry[p] >> 1, &slope);
            top = slope > top ? slope : top;
        }
        w->sum[k] = sum;
        w->top[k] = top;
    }
}

/*
 * Where slopes on a particle differ strongly (two contacts next to each other, one nearly open) the error can be many times
 * the largest residual over 1 - lambda.  (max D sum z^2 / D)^1/2 over the particle sees that.
 */
double nlc_energy_residual(nlc_iteration *q)
{
    nlc_network *n = q->n;
    double *sum = n->norm, *top = n->growth;
    for (int64_t k = 0; k < n->particle_count; k++) sum[k] = top[k] = 0;
    if (n->settings.parallel_for) nlc_for_particles(n, energies_of_particles, &(job){.q = q, .sum = sum, .top = top});
    for (int64_t c = 0; c < n->contact_count && !n->settings.parallel_for; c++) {
        double slope;
        const double energy = energy_of(q, c, &slope);
        const int64_t end[2] = {n->i[c], n->j[c]};
        for (int side = 0; side < 2; side++) {
            if (end[side] >= n->particle_count) continue;
            sum[end[side]] += energy;
            top[end[side]] = slope > top[end[side]] ? slope : top[end[side]];
        }
    }
    double worst = nlc_energy_ratio(n, sum, top);
    nlc_max_over_ranks(n, &worst, 1);
    return worst;
}
