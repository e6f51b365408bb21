/* SPDX-License-Identifier: BSD-2-Clause */
/* units.c - the units of an iteration, its start and its end. */
#include "collective.h"
#include "iteration.h"
#include "slabs.h"
#include "start.h"

/* Minus the exponent of the power of 2^n that is next to x > 0 from below; 0 for 0. */
static int per_unit_of(double x, int n)
{
    if (x <= 0) return 0;
    int e = nlc_split(x).e;
    e -= ((e % n) + n) % n;
    return -(e < -1020 ? -1020 : e);
}

/* Largest scaled overlap on every particle, 0 at least. */
static void largest_overlaps(nlc_iteration *q)
{
    nlc_network *n = q->n;
    const bool shared = nlc_is_shared(n);
    if (!shared) nlc_largest_overlaps(n, q->overlap);
    for (int64_t k = 0; k < n->body_count; k++) n->largest[k] = (shared ? nlc_shared_overlaps(n) : n->largest)[k] * q->load;
}

/* Gaps wider than this many of the deepest overlap are never closed and have no say in the unit, ... */
#define WIDE 0x1p64
/* ... unless they are wider than this many: then they cannot be calculated with in a unit of overlaps. */
#define WIDEST 0x1p400

double nlc_unit_of_overlaps(const double *overlap, int64_t count, double largest)
{
    double deepest = 0;
    for (int64_t c = 0; c < count && deepest < largest / WIDE; c++) deepest = overlap[c] > deepest ? overlap[c] : deepest;
    return deepest < largest / WIDE && deepest > largest / WIDEST ? deepest : largest;
}

void nlc_iteration_units(nlc_iteration *q, nlc_network *n, const double *overlap, const double *normal, double part)
{
    *q = (nlc_iteration){.n = n, .overlap = overlap, .normal = normal, .directions = 1};
    const bool known = n->top.overlap >= 0;
    const double top = known ? n->top.overlap : nlc_unit_of_overlaps(overlap, n->contact_count, nlc_largest_magnitude(overlap, n->contact_count));
    const double stiffest = n->top.stiffness >= 0 ? n->top.stiffness : nlc_largest_magnitude(n->stiffness, n->contact_count);
    const int length = per_unit_of(top, 2); /* its root is a power of 2, too */
    const int stiffness = per_unit_of(stiffest, 1);
    q->per_overlap = nlc_pow2(length);
    q->per_stiffness = nlc_pow2(stiffness);
    q->load = q->per_overlap * part;
    nlc_set_units(n, length, stiffness);
}

static void begin(void *work, int64_t from, int64_t end)
{
    const nlc_iteration *q = work;
    const nlc_network *n = q->n;
    for (int64_t c = from; c < end; c++) {
        const double a = n->largest[n->i[c]], b = n->largest[n->j[c]], top = a > b ? a : b;
        n->current[c] *= q->per_overlap;
        n->force[c] = nlc_scaled_force(q, c);
        n->spare[2][c] = nlc_scaled_overlap(q, c); /* nlc_weaken comes back to it */
        if (n->swept) n->current[c] = (n->side[2 * c] + n->side[2 * c + 1]) * q->per_overlap;
        n->floor[c] = NLC_SLOPE_FLOOR * nlc_scaled_stiffness(q, c) * sqrt(top > 1e-12 ? top : 1e-12);
    }
}

void nlc_iteration_start(nlc_iteration *q, nlc_network *n, const double *overlap, const double *normal, double part)
{
    nlc_iteration_units(q, n, overlap, normal, part);
    largest_overlaps(q);
    for (int64_t k = 0; k < n->particle_count; k++) n->weakening[k] = 1;
    nlc_for_contacts(n, begin, q);
}

double nlc_overlap_nearby(const nlc_iteration *q, int64_t c)
{
    const double root = q->n->floor[c] / (NLC_SLOPE_FLOOR * nlc_scaled_stiffness(q, c));
    return root * root;
}

double nlc_in_callers_unit(const nlc_iteration *q, int64_t c)
{
    const int unit = q->n->length_unit;
    const double lowest = -nlc_pow2(unit < 0 ? 1020 + unit : 1020); /* how far it is open makes no difference */
    const double highest = NLC_FARTHEST - q->overlap[c] * q->load, g = q->n->current[c] < highest ? q->n->current[c] : highest;
    return (g > lowest ? g : lowest) / q->per_overlap;
}

static void finish(void *work, int64_t from, int64_t end)
{
    const nlc_iteration *q = work;
    for (int64_t c = from; c < end; c++) q->n->current[c] = nlc_in_callers_unit(q, c);
}

void nlc_iteration_end(nlc_iteration *q)
{
    nlc_for_contacts(q->n, finish, q);
}
