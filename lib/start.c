/* SPDX-License-Identifier: BSD-2-Clause */
/* start.c - where a solve begins. */
#include <string.h>

#include "collective.h"
#include "slabs.h"
#include "start.h"

/* What passes over contacts and particles have in common. */
typedef struct job {
    nlc_network *n;
    const double *overlap;
} job;

static void largest_on(void *work, int64_t from, int64_t end)
{
    const job *w = work;
    const nlc_network *n = w->n;
    for (int64_t k = from; k < end; k++) {
        double largest = 0;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
            const double x = w->overlap[n->entry[p] >> 1];
            largest = x > largest ? x : largest;
        }
        n->largest[k] = largest;
    }
}

/* Contact by contact memory is read in the order that it has, but threads would meet on particles. */
void nlc_largest_overlaps(nlc_network *n, const double *overlap)
{
    job all = {n, overlap};
    for (int64_t k = 0; k < n->body_count; k++) n->largest[k] = 0;
    if (n->settings.parallel_for) nlc_for_particles(n, largest_on, &all);
    for (int64_t c = 0; c < n->contact_count && !n->settings.parallel_for; c++) {
        const double x = overlap[c];
        if (x <= 0) continue;
        const int64_t i = n->i[c], j = n->j[c];
        if (i < n->particle_count && x > n->largest[i]) n->largest[i] = x;
        if (j < n->particle_count && x > n->largest[j]) n->largest[j] = x;
    }
}

/*
 * The caller's displacement as a start, capped where overlap + displacement would exceed 3 times the largest overlap on the
 * two particles: that is where the stable branch ends for equal forces, and beyond it lies the unstable one.
 */
double nlc_start_of(const nlc_network *n, int64_t c, const double *overlap, const double *nonlocal)
{
    const double g = nonlocal ? nonlocal[c] : 0;
    if (nlc_abs_bits(g) == 0) return 0;
    const double a = n->largest[n->i[c]], b = n->largest[n->j[c]];
    double cap = 3 * (a > b ? a : b) - overlap[c];
    cap = cap > 0 ? cap : 0;
    return g > cap ? cap : g < -cap ? -cap : g;
}

/* nonlocal may be n->current. */
void nlc_start_from(nlc_network *n, const double *overlap, const double *nonlocal)
{
    bool capped = false;
    if (nlc_is_shared(n)) memcpy(n->largest, nlc_shared_overlaps(n), (size_t)n->body_count * sizeof *n->largest);
    else nlc_largest_overlaps(n, overlap);
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double g = nlc_start_of(n, c, overlap, nonlocal);
        capped |= nonlocal && nlc_bits(g) != nlc_bits(nonlocal[c]);
        n->current[c] = g;
    }
    if (n->swept) n->swept = !nlc_on_any_rank(n, capped);
    if (!n->swept) n->known_bound = 1;
}
