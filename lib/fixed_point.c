/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fixed_point.c - [GC] Algorithm 1: forces from the last displacements, displacements from these forces, and again.
 *
 * As printed the algorithm adds a sweep's displacements to those of the sweep before; its Eq. 9 does not, nor does this.
 *
 * The change of the forces from one sweep to the next is r, its ratio to the change before is the rate; what is still to
 * come is r (rate + rate^2 + ...) = r rate / (1 - rate).  A rate measured in the largest norm is not the same everywhere: on
 * packings that made the error up to 1.2 times this; the largest of three rates and twice the sum are taken.  Where a contact is
 * pushed in by some and out by others, changes may grow in every other sweep and fall all the same: then the rate is that of two
 * sweeps at a time.
 */
#include <float.h>
#include <string.h>

#include "collective.h"
#include "contact.h"

#define FIRST_RATE 0.9            /* before a rate has been seen */
#define SLOWEST_RATE 0.99999      /* a rate above is no convergence */
#define RUNAWAY 100               /* no solution has overlaps this much larger than the largest one given */
#define SAFETY 2.0
#define ROUNDING (64 * DBL_EPSILON) /* changes below are noise and say nothing of the rate */

typedef struct state {
    double change, last_change, earlier_change; /* r of this sweep and the two before */
    double rate[3], rate_of_two[2]; /* the last ones, of one sweep and of two */
    double smallest; /* smallest r so far; network->spare[0] is where it was met */
    double highest;  /* largest overlap plus displacement */
    int64_t worst;
} state;

/* Overlap plus displacement, held where no solution is: the iteration ends there, with finite forces. */
static double bounded(double overlap, double displacement, double cap)
{
    double x = overlap + displacement;
    return x < cap ? x : cap;
}

/* Forces from network->current. */
static void start(nlc_network *n, const double *overlap)
{
    for (int64_t c = 0; c < n->contact_count; c++) n->force[c] = nlc_law(n->stiffness[c], overlap[c] + n->current[c]);
}

/* Forces from the displacements just computed; the change per contact, relative to the largest force on its two bodies. */
static void update_forces(nlc_network *n, const double *overlap, double cap, state *s)
{
    s->change = 0;
    s->highest = 0;
    s->worst = -1;
    for (int64_t c = 0; c < n->contact_count; c++) {
        double x = bounded(overlap[c], n->side[2 * c] + n->side[2 * c + 1], cap);
        double p = nlc_law(n->stiffness[c], x), old = n->force[c], change = fabs(p - old), larger = p > old ? p : old;
        double a = n->largest[n->i[c]], b = n->largest[n->j[c]], scale = a > b ? a : b;
        scale = larger > scale ? larger : scale; /* the old one is there already, unless another rank knows nothing of it */
        n->force[c] = p;
        s->highest = x > s->highest ? x : s->highest;
        if (change > s->change * scale) { /* no scale is 0 where something changes */
            s->change = change / (scale + DBL_MIN); /* at most 1; no condition on the division, see nlc_ratio */
            s->worst = c;
        }
    }
    double top[2] = {s->change, s->highest};
    nlc_max_over_ranks(n, top, 2);
    if (top[0] > s->change) s->worst = -1;
    s->change = top[0];
    s->highest = top[1];
}

static void keep_displacements(nlc_network *n, const double *overlap, double cap)
{
    for (int64_t c = 0; c < n->contact_count; c++) {
        double g = n->side[2 * c] + n->side[2 * c + 1];
        n->current[c] = overlap[c] + g < cap ? g : cap - overlap[c];
    }
}

/* Copied: the part works in the same memory, and knows spare[0] by its address. */
static void copy_displacements(const nlc_network *n, double *to, const double *from)
{
    memcpy(to, from, (size_t)n->contact_count * sizeof *to);
}

/* Sum of what is to come, if it falls by such a rate after the change. */
static double sum_of(double change, double rate)
{
    const double sum = SAFETY * change * rate / (fabs(1 - rate) + 1e-30); /* 1 - rate is 0 or above 1e-16 */
    return rate < SLOWEST_RATE ? sum : INFINITY;
}

/* Estimated error of the forces after this sweep. */
static double remaining(state *s, int64_t sweeps)
{
    if (sweeps >= 2 && s->change > ROUNDING) {
        s->rate[2] = s->rate[1];
        s->rate[1] = s->rate[0];
        s->rate[0] = nlc_ratio(s->change, s->last_change);
        s->rate_of_two[1] = s->rate_of_two[0];
        s->rate_of_two[0] = sweeps >= 3 ? nlc_ratio(s->change, s->earlier_change) : 1;
    }
    double rate = s->rate[0] > s->rate[1] ? s->rate[0] : s->rate[1];
    rate = rate > s->rate[2] ? rate : s->rate[2];
    const double two = s->rate_of_two[0] > s->rate_of_two[1] ? s->rate_of_two[0] : s->rate_of_two[1];
    if (s->change <= 0) return 0;
    return rate < SLOWEST_RATE ? sum_of(s->change, rate) : sum_of(s->change + s->last_change, two);
}

static void finish(nlc_outcome *out, nlc_status status, double residual, int64_t worst)
{
    out->status = status;
    out->info.residual = residual;
    out->info.worst_contact = worst;
}

void nlc_fixed_point(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    const double runaway = RUNAWAY * n->top.overlap;
    state s = {.rate = {FIRST_RATE, FIRST_RATE, FIRST_RATE}, .rate_of_two = {1, 1}, .smallest = INFINITY};
    const bool places = n->settings.model->shape == NLC_SHAPE_PLACE;
    nlc_set_units(n, 0, 0);
    start(n, overlap);
    if (places) nlc_split_sides(n, n->side);
    for (int64_t sweeps = 1; out->info.sweeps < n->settings.max_sweeps; sweeps++) {
        out->info.sweeps++;
        if (places) nlc_set_places(n, n->side, overlap, 1);
        nlc_status status = nlc_displace(n, NLC_OF_FORCES, n->force, normal, &out->info.culprit);
        if (status != NLC_OK) return finish(out, status, 0, -1);
        s.earlier_change = s.last_change;
        s.last_change = s.change;
        nlc_exchange_particles(n, n->largest);
        update_forces(n, overlap, runaway, &s);
        if (nlc_is_over(n, out)) return;
        double error = remaining(&s, sweeps);
        if (s.change < s.smallest) {
            s.smallest = s.change;
        } else if (s.last_change <= s.smallest) {
            copy_displacements(n, n->spare[0], n->current); /* the displacements that this sweep started from were the best */
        }
        keep_displacements(n, overlap, runaway);
        if (error <= n->settings.tolerance) return finish(out, NLC_OK, error, s.worst);
        if (s.change <= ROUNDING) return finish(out, NLC_WARNING_ROUNDING, error, s.worst);
        if (s.highest >= runaway) break;
    }
    if (s.change > s.smallest) copy_displacements(n, n->current, n->spare[0]);
    finish(out, NLC_WARNING_NOT_CONVERGED, s.smallest, s.worst);
}
