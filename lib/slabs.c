/* SPDX-License-Identifier: BSD-2-Clause */
/* slabs.c - loops over contacts and particles, slab by slab and window by window. */
#include "slabs.h"

typedef struct ranges {
    nlc_range task;
    void *work;
    int64_t size, count;
} ranges;

static void range_task(void *work, int64_t k)
{
    const ranges *r = work;
    r->task(r->work, k * r->size, nlc_end_of(k, r->size, r->count));
}

void nlc_for_contacts(const nlc_network *n, nlc_range task, void *work)
{
    ranges all = {task, work, NLC_SLAB, n->contact_count};
    nlc_for(n, range_task, &all, nlc_slabs(n));
}

void nlc_for_particles(const nlc_network *n, nlc_range task, void *work)
{
    ranges all = {task, work, NLC_WINDOW, n->owned};
    nlc_for(n, range_task, &all, nlc_windows(n));
}

typedef struct sums {
    const double *side;
    double *displacement;
} sums;

static void add_sides(void *work, int64_t from, int64_t end)
{
    const sums *w = work;
    for (int64_t c = from; c < end; c++) w->displacement[c] = w->side[2 * c] + w->side[2 * c + 1];
}

void nlc_add_sides(const nlc_network *n, double *displacement)
{
    sums all = {n->side, displacement};
    nlc_for_contacts(n, add_sides, &all);
}

typedef struct question {
    const nlc_network *n;
    const double *values;
} question;

static void top_task(void *work, int64_t s)
{
    const question *w = work;
    const int64_t from = s * NLC_SLAB;
    w->n->piece[s].force = nlc_largest_magnitude(w->values + from, nlc_end_of(s, NLC_SLAB, w->n->contact_count) - from);
}

double nlc_top(const nlc_network *n, const double *values)
{
    question all = {n, values};
    uint64_t top = 0;
    nlc_for(n, top_task, &all, nlc_slabs(n));
    for (int64_t s = 0; s < nlc_slabs(n); s++) {
        const uint64_t bits = nlc_bits(n->piece[s].force);
        top = bits > top ? bits : top;
    }
    return nlc_from_bits(top);
}

static void unit_task(void *work, int64_t s)
{
    const question *w = work;
    const int64_t from = s * NLC_SLAB;
    const int64_t bad = nlc_first_not_unit(w->values + 3 * from, nlc_end_of(s, NLC_SLAB, w->n->contact_count) - from);
    w->n->piece[s].bad = bad < 0 ? -1 : from + bad;
}

int64_t nlc_first_bad_normal(const nlc_network *n, const double *normal)
{
    question all = {n, normal};
    int64_t bad = -1;
    nlc_for(n, unit_task, &all, nlc_slabs(n));
    for (int64_t s = 0; s < nlc_slabs(n) && bad < 0; s++) bad = n->piece[s].bad;
    return bad;
}
