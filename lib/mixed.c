/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * mixed.c - models whose displacements depend on the forces without being the derivative of an energy (LOVE, the half-space at
 * deformed contact points): no symmetry, so neither Galerkin's directions nor bounds from their own coefficients.
 *
 * Anderson's method, on overlaps plus displacements or, where contact points move, on the displacements of both sides.  The end
 * is an estimate: the change of the forces by one more sweep, times the largest amplification of a change of x that was met,
 * times SAFETY.  The state found counts as stable if Case I's coefficients, whose limit at small circles these models' are, are
 * proved to be at its slopes; else it is solved for with the coupling weakened by as much as those need.
 */
#include <string.h>

#include "anderson.h"
#include "bound.h"
#include "collective.h"
#include "contact.h"
#include "iteration.h"

#define SAFETY 3.0
#define FIRST_STEP 1.0
#define RESTART_STEP 0.3
#define GROWTH 4.0 /* of the residual: then back to the best, with shorter steps */
#define STEPS 150
#define PATIENCE 40 /* steps without the residual falling tenfold after which nothing is expected */
#define HOPELESS 1e3 /* residual relative to the overlaps */
#define ROUNDING 1e-15

typedef struct vectors {
    int64_t length;
    bool sides; /* the unknowns are displacements of sides, not overlaps */
    double *x, *y, *best;
} vectors;

static double plus(double x)
{
    return 0.5 * (x + fabs(x));
}

/* Overlap plus displacement of x. */
static double overlap_at(const nlc_iteration *q, const vectors *v, int64_t c)
{
    const double y = v->sides ? q->overlap[c] * q->load + (v->x[2 * c] + v->x[2 * c + 1]) : v->x[c];
    return y < NLC_FARTHEST ? y : NLC_FARTHEST;
}

static void start(const nlc_iteration *q, vectors *v)
{
    if (v->sides) {
        nlc_split_sides(q->n, v->x);
        return;
    }
    for (int64_t c = 0; c < v->length; c++) {
        const double x = nlc_scaled_overlap(q, c);
        v->x[c] = x > -NLC_FARTHEST ? x : -NLC_FARTHEST; /* where anderson.c would put it: its differences must not be as wide */
    }
}

/*
 * The largest change of a force (in n->slope), relative to the largest force nearby.  On ranks, which would have to tell each other
 * these forces, relative to the largest of all, while that is too much.
 */
static double largest_change(nlc_iteration *q, nlc_outcome *out)
{
    nlc_network *n = q->n;
    if (nlc_is_shared(n) && out->info.sweeps < n->settings.max_sweeps) {
        double top[2] = {nlc_largest_magnitude(n->slope, n->contact_count), nlc_largest_magnitude(n->force, n->contact_count)};
        top[1] += top[0];
        nlc_max_over_ranks(n, top, 2);
        const double overall = nlc_ratio(top[0], top[1]);
        out->info.worst_contact = -1;
        if (overall > n->settings.tolerance && overall > ROUNDING) return overall;
    }
    nlc_force_scales(q, true);
    return nlc_relative_size(q, n->slope, &out->info.worst_contact);
}

/* One sweep at x: y becomes the residual; the sum of its squares.  The largest change of a force into *change. */
static double evaluate(nlc_iteration *q, vectors *v, nlc_anderson *h, double *change, nlc_outcome *out)
{
    nlc_network *n = q->n;
    double norm = 0;
    for (int64_t c = 0; c < n->contact_count; c++) n->force[c] = nlc_law(nlc_scaled_stiffness(q, c), overlap_at(q, v, c));
    if (v->sides) nlc_set_places(n, v->x, q->overlap, q->load);
    out->info.sweeps++;
    out->status = nlc_displace(n, NLC_OF_FORCES, n->force, q->normal, &out->info.culprit);
    if (out->status != NLC_OK) return 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        n->current[c] = n->side[2 * c] + n->side[2 * c + 1];
        n->slope[c] = nlc_scaled_force(q, c) - n->force[c];
    }
    for (int64_t k = 0; k < v->length; k++) {
        v->y[k] = (v->sides ? n->side[k] : nlc_scaled_overlap(q, k)) - v->x[k];
        if (!v->sides && v->x[k] <= 0 && v->x[k] + v->y[k] <= 0) v->y[k] = 0; /* how far it is open makes no difference */
    }
    for (int64_t k = 0; k + 1 < v->length; k += 2) norm += v->y[k] * v->y[k] + v->y[k + 1] * v->y[k + 1]; /* as in anderson.c */
    if (v->length % 2) norm += v->y[v->length - 1] * v->y[v->length - 1];
    nlc_anderson_meet(h, v->x, v->y, &norm);
    *change = largest_change(q, out);
    nlc_is_over(n, out);
    return norm;
}

/* Whether the state is proved to be stable, by Case I. */
static bool is_stable(nlc_iteration *q, nlc_outcome *out)
{
    nlc_bound bound = {INFINITY, -1, 0};
    for (int64_t c = 0; c < q->n->contact_count; c++)
        q->n->slope[c] = 1.5 * nlc_scaled_stiffness(q, c) * sqrt(plus(nlc_scaled_overlap(q, c)));
    const bool good = nlc_bound_below(q->n, q->normal, 1 - NLC_MARGIN, &bound);
    if (!good) nlc_bound_balance(q->n, q->normal, NLC_BALANCE_PASSES, 1 - NLC_MARGIN, &bound);
    out->info.blocks += bound.blocks;
    out->info.critical_particle = bound.where;
    if (nlc_is_over(q->n, out)) return true;
    return good || bound.upper <= 1 - NLC_MARGIN;
}

/* True where it has come to an end, with the status to be returned; false where the coupling has to be weakened. */
static bool iterate(nlc_iteration *q, vectors *v, nlc_outcome *out)
{
    nlc_network *n = q->n;
    double applied = 0, mark = INFINITY; /* sum of the squares of the overlaps; a residual to be improved on */
    int waited = 0;
    nlc_anderson h;
    nlc_anderson_start(&h, n, v->sides ? 2 : 1, n->lanczos[0], n->lanczos[2], NLC_FARTHEST);
    nlc_anderson_reset(&h, FIRST_STEP);
    for (int64_t c = 0; c < n->contact_count; c++) applied += plus(q->overlap[c] * q->load) * plus(q->overlap[c] * q->load);
    for (int64_t s = 0; s < n->straddling; s++) {
        const double x = plus(q->overlap[nlc_straddling(n)[s]] * q->load);
        applied -= 0.5 * x * x;
    }
    nlc_sum_over_ranks(n, &applied, 1);
    for (int k = 0; k < STEPS; k++) {
        double change = 0;
        const double norm = evaluate(q, v, &h, &change, out);
        if (out->status < 0) return true;
        if (k == 0 && v->sides && out->info.sweeps < n->settings.max_sweeps && nlc_on_any_rank(n, nlc_is_repelled(q))) {
            nlc_relax(q); /* by point forces on the undeformed sphere */
            start(q, v);
            continue;
        }
        out->info.residual = SAFETY * change * nlc_anderson_amplification(&h);
        if (out->info.residual <= n->settings.tolerance && (k > 0 || change <= 0)) return is_stable(q, out);
        if (change <= ROUNDING && k > 3) {
            out->status = NLC_WARNING_ROUNDING;
            return is_stable(q, out);
        }
        if (out->info.sweeps >= n->settings.max_sweeps) {
            out->status = NLC_WARNING_NOT_CONVERGED;
            return true;
        }
        waited = norm < 0.01 * mark ? 0 : waited + 1;
        mark = waited == 0 ? norm : mark;
        if (norm > HOPELESS * HOPELESS * applied || waited > PATIENCE) return false;
        if (norm > GROWTH * GROWTH * h.smallest) {
            memcpy(v->x, v->best, (size_t)v->length * sizeof *v->x);
            nlc_anderson_reset(&h, RESTART_STEP);
            continue;
        }
        if (norm < h.smallest) {
            h.smallest = norm;
            memcpy(v->best, v->x, (size_t)v->length * sizeof *v->x);
        }
        nlc_anderson_combine(&h, v->x, v->y);
        nlc_anderson_move(&h, v->x, v->y);
    }
    return false;
}

void nlc_mixed(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    nlc_iteration q;
    vectors v = {.sides = n->settings.model->shape == NLC_SHAPE_PLACE};
    nlc_iteration_start(&q, n, overlap, normal, 1);
    memcpy(n->spare[4], n->spare[2], (size_t)n->contact_count * sizeof *overlap); /* the start, for nlc_weaken */
    v.length = (v.sides ? 2 : 1) * n->contact_count;
    v.x = n->spare[0];    /* and [1] behind it */
    v.best = n->spare[2]; /* and [3] */
    v.y = n->share;
    start(&q, &v);
    if (!iterate(&q, &v, out)) {
        memcpy(n->spare[2], n->spare[4], (size_t)n->contact_count * sizeof *overlap);
        /* the equations with weakened coupling are those of undeformed points */
        for (int64_t e = 0; e < 2 * n->contact_count; e++) n->own[e] = 0;
        out->status = NLC_OK;
        nlc_weaken(&q, out);
        if (out->status < 0) return;
        if (v.sides && out->status == NLC_OK) { /* nothing to be weakened, and so the solution of other equations */
            out->status = NLC_WARNING_NOT_CONVERGED;
            out->info.residual = INFINITY;
        }
    }
    nlc_iteration_end(&q);
}
