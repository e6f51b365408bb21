/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * galerkin.c - the default method: Newton's equation solved in a space of a few directions that are kept from step to step.
 *
 *     C    coupling, symmetric            P    iterate of the forces, with its image C P
 *     z    residual law(gamma + C P) - P: exact, without a sweep
 *     D    slope of the chord of the law from P to P + z, so that z / D is the residual in terms of overlap
 *     W    directions: z, the last one or two steps, two Ritz vectors;  C W is kept by linearity, but for C z: one sweep a step
 *
 * The step W a makes (D^-1 - C) W a = z / D hold on W: with K Y = M Y theta, M = W^T D^-1 W, K = W^T C W,
 * a = Y (Y^T W^T z / D) / (1 - theta).  Few directions serve easy scenes at the least cost; all of them are kept once a Ritz
 * value says that the scene is not easy.
 *
 * The end: |P - exact| <= NLC_SAFETY |z| / (1 - lambda), and lambda <= beta is proved particle by particle (bound.c) for the beta
 * that the tolerance needs.  NLC_SAFETY is for the norm: the factor holds in the energy norm, in the largest component it was
 * exceeded by up to 1.4 on crystals, packings and clusters.
 */
#include "certify.h"
#include "collective.h"
#include "iteration.h"
#include "slabs.h"

#define ALL_FROM 0.35     /* Ritz value from which all directions are kept */
#define LONGEST_STEP 8    /* first steps, in units of the largest force nearby ... */
#define SHORTEST 64       /* ... but no step is cut to less than one part in this */
#define GIVE_UP 100       /* sweeps in a solve after which a stable solution is no longer expected */
#define LOST 40           /* sweeps after which a residual that is still larger than any force says that the start was nonsense */
#define HOPELESS 0.9      /* ... if a Ritz value is above this; many strong repulsions take as long, but converge */
#define LOAD_STEPS 16     /* when all else has failed */
#define LOAD_SWEEPS 60    /* in each of them but the last */
#define NEAR 0.01         /* residual below which Ritz values say something of lambda */
#define NEARER 1e-5       /* ... and bounds, to a sixth of the margin or so */
#define KEPT_FROM 0.8     /* Ritz value from which states are kept in case that the next one is beyond the end */
#define EARLY_FROM 0.9    /* Ritz value from which a start that was given is looked at */
#define MUCH_NEARER 0.1   /* than the start, in terms of residuals: nlc_weaken begins there then */
#define RUNAWAY 1e6
#define LINEAR 0.1        /* of the 3/2-th power of the residual: that is what linear steps may make of it */
#define LINEAR_ENOUGH 0.1 /* of the tolerance: no less is asked of them */
#define LINEAR_STEPS 6    /* nor more steps */
#define ROUNDING 1e-13    /* residuals below may be rounding */
#define SETTLED 1e-15     /* and below this one, relative to the largest force, nothing else */
#define PLAIN_FROM 4      /* after more than so many looks at a residual above half of the least before ... */
#define PLAIN_STEPS 8     /* ... there are so many plain steps, and again ... */
#define PLAIN_EVERY 32    /* ... after so many looks */

enum { NONE = -1, EARLY, ROUGH, CLOSER }; /* looks */

typedef struct progress {
    double ratio, best; /* residual relative to the force nearby, and the smallest so far */
    int64_t where;
    int stalled;        /* sweeps since it last fell, when it is near rounding */
    int slow;           /* looks in a row that have found it above half of the least before */
    int critical;       /* sweeps in a row with a Ritz value near 1 */
    int looks;          /* those there have been */
    bool warm;          /* a start was given */
    double at_start;    /* its residual */
    bool all;
    int64_t begun;   /* sweeps before this solve */
    bool settled;    /* images are those of a state near the solution, so that Ritz values say something of lambda */
    bool exact;      /* the displacements are those of the iterate, not of the last state and what changed since then */
    double refresh;  /* residual, relative to the largest force, at which they are computed anew */
    int since;       /* steps since they were */
    bool first, repelled; /* when they were: the start, and whether it is one to be mended */
} progress;

static bool sweep(nlc_iteration *q, nlc_response response, const double *force, double *displacement, nlc_outcome *out)
{
    nlc_network *n = q->n;
    out->info.sweeps++;
    out->status = nlc_displace(n, response, force, q->normal, &out->info.culprit);
    if (out->status != NLC_OK) return false;
    nlc_add_sides(n, displacement);
    return true;
}

/* The residual, and its largest of all ranks; false: an error. */
static bool evaluate(nlc_iteration *q, progress *s, nlc_outcome *out)
{
    nlc_evaluate(q);
    double largest[3] = {q->largest_residual, q->largest_force, s->repelled};
    nlc_max_over_ranks(q->n, largest, 3);
    if (nlc_is_over(q->n, out)) return false;
    q->largest_residual = largest[0];
    q->largest_force = largest[1];
    s->repelled = largest[2] > 0;
    return true;
}

/* How far the iterate is from the end. */
static nlc_verdict judge(nlc_iteration *q, progress *s, nlc_outcome *out)
{
    const double tolerance = q->n->settings.tolerance, overall = q->largest_force;
    if (q->largest_residual > RUNAWAY || overall > RUNAWAY) return NLC_BEYOND;
    s->ratio = 0;
    if (q->largest_residual <= 0) return nlc_certify(q, 1 - NLC_MARGIN, out);
    s->ratio = nlc_ratio(q->largest_residual, overall);
    if (s->ratio > tolerance && s->ratio > ROUNDING) return NLC_GO_ON;
    nlc_force_scales(q, false);
    s->ratio = nlc_relative_size(q, q->n->direction[0], &s->where);
    if (s->ratio <= tolerance) {
        const double energy = nlc_energy_residual(q);
        s->ratio = energy > s->ratio ? energy : s->ratio;
    }
    if (nlc_is_over(q->n, out)) return NLC_DONE;
    s->slow = s->ratio < 0.5 * s->best ? 0 : s->slow + 1;
    s->stalled = s->slow == 0 ? 0 : s->stalled + (s->ratio < ROUNDING);
    s->best = s->ratio < s->best ? s->ratio : s->best;
    if (NLC_SAFETY * s->ratio <= tolerance) {
        const nlc_verdict v = nlc_certify(q, 1 - NLC_SAFETY * s->ratio / tolerance, out);
        if (v != NLC_GO_ON) return v;
    }
    if (s->stalled < 3) return NLC_GO_ON;
    return nlc_certify(q, 1 - NLC_MARGIN, out) == NLC_DONE ? NLC_ROUNDED : NLC_BEYOND;
}

/* Whether no step exceeds the force that its contact would have with the largest overlap nearby. */
static bool is_short(const nlc_iteration *q, const double *step)
{
    int64_t longer = 0;
    for (int64_t c = 0; c < q->n->contact_count; c++) {
        const double k = nlc_scaled_stiffness(q, c), slope = q->n->floor[c] / NLC_SLOPE_FLOOR; /* k x^1/2 */
        longer += fabs(step[c]) * k * k > slope * slope * slope;
    }
    return longer == 0;
}

/* Cuts a first step that is longer than the forces are large. */
static void shorten(nlc_iteration *q)
{
    double *step = q->n->spare[0];
    int64_t where;
    for (int64_t c = 0; c < q->n->contact_count; c++) {
        step[c] = 0;
        for (int d = 0; d < q->directions; d++) step[c] += q->step[d] * q->n->direction[d][c];
    }
    if (!nlc_on_any_rank(q->n, !is_short(q, step))) return;
    nlc_force_scales(q, true);
    double longest = nlc_relative_size(q, step, &where);
    if (longest > LONGEST_STEP * SHORTEST) longest = LONGEST_STEP * SHORTEST;
    for (int d = 0; d < q->directions && longest > LONGEST_STEP; d++) q->step[d] *= LONGEST_STEP / longest;
}

/*
 * A step of Algorithm 1, for forces smaller by orders than others, as at the end of a row of balls that just touch.  Where residuals of
 * the largest forces are rounding, combinations of directions follow these, and may get nowhere with the small ones, which a plain
 * sweep settles.  Not many of them in a row: it settles nothing where forces of soft particles beside hard ones repel each other.
 */
static void go_plainly(nlc_iteration *q, const progress *s)
{
    const int idle = s->slow % PLAIN_EVERY;
    if (idle <= PLAIN_FROM || idle > PLAIN_FROM + PLAIN_STEPS || s->ratio <= ROUNDING) return;
    if (q->largest_residual > SETTLED * q->largest_force) return;
    for (int d = 0; d < q->directions; d++) q->step[d] = d == 0;
}

/* Where nlc_weaken may begin. */
static void keep(nlc_iteration *q, const progress *s)
{
    for (int64_t c = 0; c < q->n->contact_count; c++) q->n->spare[3][c] = nlc_scaled_overlap(q, c);
    q->kept = true;
    q->nearer = q->largest_residual < MUCH_NEARER * s->at_start;
}

/* One step; false if the sweep failed. */
static bool advance(nlc_iteration *q, progress *s, nlc_outcome *out)
{
    const double before = q->largest_residual;
    if (!sweep(q, NLC_OF_CHANGES, q->n->direction[0], q->n->image[0], out)) return false;
    nlc_stiffness_products(q);
    nlc_products_over_ranks(q);
    if (nlc_is_over(q->n, out)) return false;
    nlc_choose_step(q);
    if (before > 0.05 * q->largest_force) shorten(q);
    go_plainly(q, s);
    const bool near = s->settled && before < NEAR * q->largest_force;
    if (near && q->theta > out->info.lambda_lower) out->info.lambda_lower = q->theta;
    const bool critical = q->theta >= 1 || (near && q->theta > 1 - NLC_MARGIN + 0.001);
    s->critical = out->info.sweeps - s->begun > 4 && critical ? s->critical + 1 : 0;
    s->all = s->all || q->theta > ALL_FROM || out->info.sweeps - s->begun > 12;
    if (q->theta > KEPT_FROM && q->theta < 1) keep(q, s);
    nlc_take_step(q, s->all);
    s->exact = nlc_is_linear(q->n->settings.model->shape);
    s->since++;
    return true;
}

/*
 * Where the coefficients depend on the forces, steps are made with those of the last state, and the displacements are
 * computed anew when the residual has fallen by as much as a step of Newton's method can make it.
 */
static bool refresh(nlc_iteration *q, progress *s, nlc_outcome *out)
{
    if (q->n->swept) q->n->swept = false; /* this once */
    else if (!sweep(q, NLC_OF_STATE, q->n->force, q->n->current, out)) return false;
    s->exact = true;
    s->since = 0;
    s->repelled = s->first && nlc_is_repelled(q);
    if (!evaluate(q, s, out)) return false;
    const double r = nlc_ratio(q->largest_residual, q->largest_force), enough = LINEAR_ENOUGH * q->n->settings.tolerance;
    s->refresh = LINEAR * (r < 1 ? r * sqrt(r) : 1);
    if (s->refresh < enough) s->refresh = enough;
    s->settled = r < NEAR || nlc_is_linear(q->n->settings.model->shape);
    q->directions = 1; /* the images of the others are those of the state before */
    return true;
}

/*
 * Whether it is time to see if the end is near: a bound costs much, so each of these looks is taken once.  From a start that is past the
 * end Ritz values come near 1 slowly, if it is a good one: the first look is for these.
 */
static int next_look(const nlc_iteration *q, const progress *s)
{
    if (q->largest_residual >= NEAR * q->largest_force) return NONE;
    /* bounds may be above lambda by some margins */
    if (q->largest_residual < NEARER * q->largest_force && q->theta > 1 - 4 * NLC_MARGIN) return CLOSER;
    return q->theta > 1 - 2 * NLC_MARGIN ? ROUGH : s->warm && q->theta > EARLY_FROM ? EARLY : NONE;
}

static nlc_verdict iterate(nlc_iteration *q, progress *s, nlc_outcome *out)
{
    /* sweeps that a step needs after its own, to be judged */
    const int64_t more = nlc_is_linear(q->n->settings.model->shape) ? 0 : 1, most = q->n->settings.max_sweeps;
    if (!refresh(q, s, out)) return NLC_DONE;
    s->first = false;
    s->at_start = q->largest_residual;
    if (s->repelled && out->info.sweeps < most) {
        nlc_relax(q);
        if (!refresh(q, s, out)) return NLC_DONE;
    }
    for (bool first = true;; first = false) {
        if (!first && !evaluate(q, s, out)) return NLC_DONE;
        const bool due = q->largest_residual <= s->refresh * q->largest_force || s->since >= LINEAR_STEPS;
        if (!s->exact && (due || out->info.sweeps + more >= most) && !refresh(q, s, out)) return NLC_DONE;
        const nlc_verdict v = s->exact ? judge(q, s, out) : NLC_GO_ON;
        if (v != NLC_GO_ON || out->info.sweeps + more >= most) return v;
        if ((out->info.sweeps - s->begun > GIVE_UP && q->theta > HOPELESS) || s->critical >= 6) return NLC_BEYOND;
        if (out->info.sweeps - s->begun > LOST && q->largest_residual >= q->largest_force) return NLC_GO_ON;
        if (!advance(q, s, out)) return NLC_DONE;
        const int look = next_look(q, s);
        if (look < s->looks) continue;
        s->looks = look + 1;
        if (nlc_is_too_near(q, look == CLOSER, out)) return NLC_BEYOND;
    }
}

/* With a part of the overlaps applied. */
static void solve(nlc_network *n, const double *overlap, const double *normal, double part, bool warm, nlc_outcome *out)
{
    nlc_iteration q;
    progress s = {.ratio = 1e10, .best = INFINITY, .where = -1, .warm = warm, .begun = out->info.sweeps, .first = true};
    if (!n->swept) n->known_bound = 1; /* it was for another start */
    nlc_iteration_start(&q, n, overlap, normal, part);
    const nlc_verdict v = iterate(&q, &s, out);
    if (out->status < 0) return;
    out->info.residual = NLC_SAFETY * s.ratio / (out->info.lambda_upper < 1 ? 1 - out->info.lambda_upper : NLC_MARGIN);
    if (v == NLC_DONE && out->info.residual > n->settings.tolerance) out->info.residual = n->settings.tolerance; /* by rounding */
    out->info.worst_contact = s.where;
    if (v == NLC_GO_ON) {
        nlc_force_scales(&q, false);
        out->info.residual = nlc_relative_size(&q, n->direction[0], &out->info.worst_contact);
        out->status = NLC_WARNING_NOT_CONVERGED;
        if (nlc_is_over(n, out)) return;
    }
    if (v == NLC_ROUNDED) out->status = NLC_WARNING_ROUNDING;
    if (v == NLC_BEYOND) nlc_weaken(&q, out);
    nlc_iteration_end(&q);
}

/*
 * Where that neither converges nor finds anything to weaken, the start was nonsense: once more from nothing.  If that does not
 * help, the iterate has lost its way between several solutions: with the load applied in steps.
 */
void nlc_galerkin(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    const int64_t most = n->settings.max_sweeps;
    const bool cold = nlc_is_shared(n) ? n->top.nonlocal <= 0 : nlc_largest_magnitude(n->current, n->contact_count) <= 0;
    for (int attempt = cold; attempt < 2; attempt++) {
        solve(n, overlap, normal, 1, attempt == 0, out);
        if (out->status != NLC_WARNING_NOT_CONVERGED || out->info.sweeps >= most) return;
        for (int64_t c = 0; c < n->contact_count; c++) n->current[c] = 0;
        if (attempt == 0) nlc_start_over(out);
    }
    for (int step = 1; step <= LOAD_STEPS && out->status >= 0; step++) {
        nlc_start_over(out);
        if (out->info.sweeps >= most - 1) step = LOAD_STEPS; /* the last one is for all of the load */
        const int64_t enough = out->info.sweeps + LOAD_SWEEPS < most - 1 ? out->info.sweeps + LOAD_SWEEPS : most - 1;
        n->settings.max_sweeps = step < LOAD_STEPS ? enough : most;
        solve(n, overlap, normal, (double)step / LOAD_STEPS, false, out);
    }
    n->settings.max_sweeps = most;
}
