/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * weaken.c - beyond the end of the stable branch: a finite force by weakening the coupling where it is too strong.
 *
 *     x = gamma + sum over particles of t_k C_k P(x),   t_k = min(1, (1 - m) / b_k(x))
 *
 * with the balanced b_k of bound.c at x: a particle is weakened just so far that its block stays stable.  Always the same
 * number of passes is taken: a bound that stops when it is good enough would make t jump.  Solved by Anderson's method, with
 * residuals that have been through schwarz.c.
 */
#include <string.h>

#include "anderson.h"
#include "bound.h"
#include "collective.h"
#include "iteration.h"

#define FIRST_STEP 0.7 /* of the plain iteration, before there are differences */
#define RESTART_STEP 0.3
#define GROWTH 4.0     /* of the residual: then back to the best, with shorter steps */
#define STEPS 240
#define PATIENCE 40 /* steps without the residual falling tenfold after which it begins again from Hertz */
/*
 * Steps in which the residual has not halved, after which so many plain ones follow, while it is more than this part of the overlaps;
 * and where coefficients depend on the forces, so that slopes are others than those of the steps.
 */
#define STALLED 3
#define CURVED 1e-6
#define STALLED_MIXED 5
#define CURVED_MIXED 1e-4
#define LONG_STEP 4.0 /* a plain step after one that has changed the residual by little */

static bool sweep(nlc_iteration *q, nlc_outcome *out)
{
    const nlc_response response = q->n->settings.model->self ? NLC_OF_STATE : NLC_OF_FORCES;
    out->info.sweeps++;
    out->status = nlc_displace(q->n, response, q->n->force, q->normal, &out->info.culprit);
    return out->status == NLC_OK;
}

/*
 * y = the right side of the equation at x, coupling weakened; returns the largest change of a force, relative.  twice: the bound
 * leaves nothing of a sweep before it.
 */
static double weakened_map(nlc_iteration *q, const double *x, double *y, bool twice, nlc_outcome *out)
{
    nlc_network *n = q->n;
    nlc_bound bound = {INFINITY, -1, 0};
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double k = nlc_scaled_stiffness(q, c), root = sqrt(0.5 * (x[c] + fabs(x[c])));
        n->force[c] = k * root * root * root;
        n->slope[c] = 1.5 * k * root;
    }
    if (n->settings.model->self && !sweep(q, out)) return 0; /* the bound wants to know what contacts do to themselves */
    nlc_bound_balance(n, q->normal, NLC_BALANCE_PASSES, 0, &bound);
    out->info.blocks += bound.blocks;
    out->info.lambda_upper = bound.upper;
    out->info.critical_particle = bound.where;
    out->info.weakened = 0;
    out->info.coupling = 1;
    out->info.weakest_particle = -1;
    for (int64_t k = 0; k < n->particle_count; k++) {
        n->weakening[k] = n->bound[k] > 1 - NLC_MARGIN ? (1 - NLC_MARGIN) / (n->bound[k] + 1e-290) : 1;
        if (k >= n->owned) continue;
        out->info.weakened += n->weakening[k] < 1;
        if (n->weakening[k] >= out->info.coupling) continue;
        out->info.coupling = n->weakening[k];
        out->info.weakest_particle = k;
    }
    if ((!n->settings.model->self || twice) && !sweep(q, out)) return 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const int64_t i = n->i[c], j = n->j[c];
        const double a = i < n->particle_count ? n->weakening[i] : 1, b = j < n->particle_count ? n->weakening[j] : 1;
        n->current[c] = a * n->side[2 * c] + b * n->side[2 * c + 1];
        y[c] = nlc_scaled_overlap(q, c);
        n->slope[c] = nlc_scaled_force(q, c) - n->force[c];
    }
    nlc_force_scales(q, true);
    const double change = nlc_relative_size(q, n->slope, &out->info.worst_contact);
    nlc_is_over(n, out);
    return change;
}

/* Hertz's overlaps. */
static void start_from_overlaps(const nlc_iteration *q, double *x)
{
    for (int64_t c = 0; c < q->n->contact_count; c++) x[c] = q->overlap[c] * q->load;
}

/* The sum of the squares of those overlaps; *cold: the start given is no other. */
static double applied_overlaps(const nlc_iteration *q, const double *x, const double *given, bool *cold)
{
    double sums[2] = {0, 0}; /* the second one is a count */
    for (int64_t c = 0; c < q->n->contact_count; c++) {
        sums[0] += x[c] > 0 ? x[c] * x[c] : 0;
        sums[1] += nlc_bits(x[c]) != nlc_bits(given[c]);
    }
    for (int64_t s = 0; s < q->n->straddling; s++) {
        const double v = x[nlc_straddling(q->n)[s]];
        sums[0] -= v > 0 ? 0.5 * v * v : 0;
    }
    nlc_sum_over_ranks(q->n, sums, 2);
    *cold = sums[1] <= 0;
    return sums[0];
}

/* What is told of particles, of all ranks. */
static void tell_weakened(nlc_network *n, nlc_outcome *out)
{
    double weakened = (double)out->info.weakened;
    nlc_sum_over_ranks(n, &weakened, 1);
    out->info.weakened = (int64_t)weakened;
    out->info.coupling = -nlc_largest_over_ranks(n, -out->info.coupling, &out->info.weakest_particle);
    nlc_is_over(n, out);
}

/*
 * y becomes the residual; returns the sum of its squares.  How far a contact is open makes no difference to any force: one that
 * opens or closes moves as far beyond 0 as it was before it, so that no gap, however wide, looks like a residual.
 */
static double residual(double *x, double *y, int64_t count)
{
    double norm = 0;
    for (int64_t c = 0; c < count; c++) {
        if (x[c] < -NLC_FARTHEST) x[c] = -NLC_FARTHEST; /* as in mixed.c */
        if (y[c] > 0 && x[c] < -y[c]) x[c] = -y[c];
        if (x[c] > 0 && y[c] < -x[c]) y[c] = -x[c];
        y[c] = x[c] <= 0 && y[c] <= 0 ? 0 : y[c] - x[c];
        norm += y[c] * y[c];
    }
    return norm;
}

/*
 * It begins where the caller said, unless the residual there shows that this is nothing to go on from; then at the last state on the
 * way here that was kept; then with Hertz's overlaps, at the latest when another start has led nowhere.
 */
enum { GIVEN, KEPT, HERTZ };

static bool is_good_start(int start, double norm, double applied)
{
    return start == HERTZ || norm <= (start == GIVEN ? 0.01 : 1) * applied;
}

/* How it goes on: sums of squares of residuals. */
typedef struct pace {
    int waited;        /* steps since the residual fell tenfold */
    int steps, plain;  /* so far; those to come that are plain */
    double mark, then, last; /* the residual when it fell tenfold, some steps ago, and in the step before */
    int idle;      /* STALLED */
    double least;  /* CURVED, as a sum of squares */
} pace;

static pace new_pace(const nlc_network *n, double applied)
{
    const bool linear = nlc_is_linear(n->settings.model->shape);
    const double curved = linear ? CURVED : CURVED_MIXED;
    return (pace){.mark = INFINITY, .then = INFINITY, .last = INFINITY, .idle = linear ? STALLED : STALLED_MIXED,
                  .least = curved * curved * applied};
}

/*
 * Length of a plain step, 0: it is not yet time for one.  Where two solutions would meet if the load were a little different the
 * residual has a minimum that is none, and combinations of steps stay there.  Plain steps get away, slowly, all along the same
 * direction: there they may be long, until the others come up.
 */
static double plain_step(pace *p, double norm)
{
    const bool steady = norm > 0.6 * p->last && norm < 1.6 * p->last;
    p->last = norm;
    if (++p->steps % p->idle == 0) {
        if (norm > 0.25 * p->then && norm > p->least) p->plain = p->idle;
        p->then = norm;
    }
    if (p->plain == 0) return 0;
    p->plain--;
    return steady ? LONG_STEP : FIRST_STEP;
}

void nlc_weaken(nlc_iteration *q, nlc_outcome *out)
{
    nlc_network *n = q->n;
    const int64_t count = n->contact_count;
    double *x = n->spare[0], *y = n->spare[1], *best = n->spare[2], *kept = n->spare[3];
    bool cold, beyond = false, stepped = false; /* stepped: kept is Anderson's from then on */
    const bool twice = n->settings.model->self && nlc_on_any_rank(n, n->most_contacts > NLC_BLOCK);
    nlc_anderson h;
    start_from_overlaps(q, x);
    const double applied = applied_overlaps(q, x, best, &cold); /* best is the start given */
    pace p = new_pace(n, applied);
    int start = !cold && !(q->kept && q->nearer) ? GIVEN : q->kept ? KEPT : HERTZ;
    nlc_anderson_start(&h, n, 1, kept, n->spare[4], NLC_FARTHEST); /* what is kept is looked at before the first step only */
    nlc_anderson_reset(&h, FIRST_STEP);
    if (start < HERTZ) memcpy(x, start == GIVEN ? best : kept, (size_t)count * sizeof *x);
    out->status = NLC_WARNING_NOT_CONVERGED;
    const int64_t most = n->settings.max_sweeps - twice;
    for (int k = 0; k < STEPS && out->info.sweeps < most; k++) {
        const double change = weakened_map(q, x, y, twice, out);
        if (out->status < 0) return;
        out->status = NLC_WARNING_NOT_CONVERGED;
        out->info.residual = change / NLC_MARGIN;
        if (out->info.residual <= n->settings.tolerance) {
            out->status = NLC_OK;
            break;
        }
        double norm = residual(x, y, count);
        nlc_anderson_meet(&h, x, y, &norm);
        p.waited = norm < 0.01 * p.mark ? 0 : p.waited + 1;
        p.mark = p.waited == 0 ? norm : p.mark;
        if ((!stepped && !is_good_start(start, norm, applied)) || (p.waited > PATIENCE && start < HERTZ)) {
            start = start == GIVEN && !stepped && q->kept ? KEPT : HERTZ;
            if (start == KEPT) memcpy(x, kept, (size_t)count * sizeof *x);
            else start_from_overlaps(q, x);
            nlc_anderson_reset(&h, FIRST_STEP);
            p = new_pace(n, applied);
            continue;
        }
        if (!beyond && out->info.lambda_upper > 1 - NLC_MARGIN) { /* small residuals below the end lead nowhere: it begins here */
            nlc_anderson_reset(&h, FIRST_STEP);
            beyond = true;
        }
        if (norm > GROWTH * GROWTH * h.smallest) {
            memcpy(x, best, (size_t)count * sizeof *x);
            nlc_anderson_reset(&h, RESTART_STEP);
            continue;
        }
        if (norm < h.smallest) {
            h.smallest = norm;
            memcpy(best, x, (size_t)count * sizeof *best);
        }
        const double length = plain_step(&p, norm);
        if (length > 0) nlc_anderson_reset(&h, length);
        stepped = true;
        nlc_anderson_combine(&h, x, y);
        nlc_ask_particles(q, h.old_x, y, out);
        nlc_anderson_move(&h, x, y);
    }
    tell_weakened(n, out);
    if (out->status >= 0 && out->info.weakened > 0) out->status |= NLC_WARNING_WEAKENED;
}
