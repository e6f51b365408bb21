/* SPDX-License-Identifier: BSD-2-Clause */
/* slabs.c - what is asked of all contacts, slab by slab. */
#include "slabs.h"

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
