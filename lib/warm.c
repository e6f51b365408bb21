/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * warm.c - a start that is nearly the solution already, found out at the price of a sweep.
 *
 * In a scene that moves slowly the displacements of the last steps are often good enough: forces P of the start, a sweep,
 * residual z = law(gamma + C P) - P.  What galerkin.c asks for at its end is asked for here at once, in as few passes as there can
 * be.  If little is missing, P + z is the next start, [GC] Algorithm 1: better steps cost more than the sweeps they save.  The bound
 * of lambda comes with the sweep (norm_bound.c).
 */
#include "collective.h"
#include "slabs.h"
#include "structs.h"
#include "warm.h"

#define LARGEST 8    /* displacement of a start, in units of the largest overlap */
#define STEEP 0.9    /* a residual that leaves so much room for lambda is small enough: it is lambda that is too large */
#define SLOW 0.6     /* a residual that shrinks by less in a sweep wants a better method, ... */
#define FAR 100      /* ... and so does one of so many tolerances */
#define KNOWN 0.8    /* the bound of lambda that the better method is told of if it holds */
#define LOCAL 4      /* likewise, where most forces are right already */

/* What a start has to be worth looking at: displacements of about the right size, one cluster (of which ranks know nothing). */
static bool may_do(const nlc_network *n)
{
    if (!n->settings.model->potential || !nlc_is_linear(n->settings.model->shape)) return false;
    if (n->top.nonlocal <= 0 || n->top.nonlocal > LARGEST * n->top.overlap) return false;
    return nlc_is_shared(n) || (n->connected && n->settings.max_sweeps > 1); /* the only one is needed elsewhere */
}

/* What passes over contacts and particles have in common. */
typedef struct job {
    nlc_iteration *q;
    const nlc_guess *from;
} job;

/* Forces and weights of a few contacts, but for those that the inner loops of the processor have done. */
static void set_forces(const job *w, int64_t from, int count, double *y)
{
    const nlc_iteration *q = w->q;
    const nlc_network *n = q->n;
    const nlc_variant *v = n->settings.variant;
    const double unit = n->unit;
    double U[NLC_CHUNK];
    for (int d = 0; d < count; d++) U[d] = unit * nlc_yield_of(n, n->i[from + d]) + unit * nlc_yield_of(n, n->j[from + d]);
    for (int d = v ? v->start(q, w->from, from, count, U, y) : 0; d < count; d++) {
        const int64_t c = from + d;
        y[d] = nlc_guessed_overlap(q, w->from, c);
        const double x = 0.5 * (y[d] + fabs(y[d])), k = nlc_scaled_stiffness(q, c), root = sqrt(x);
        n->force[c] = n->share[2 * c] = k * root * x; /* nlc_law */
        n->share[2 * c + 1] = 1.5 * k * U[d] * nlc_weighed_root(root);
    }
}

static void start_task(void *work, int64_t s)
{
    const job *w = work;
    const nlc_network *n = w->q->n;
    const int64_t end = nlc_end_of(s, NLC_SLAB, n->contact_count);
    nlc_piece found = {0};
    for (int64_t from = s * NLC_SLAB; from < end; from += NLC_CHUNK) {
        const int count = end - from < NLC_CHUNK ? (int)(end - from) : NLC_CHUNK;
        double y[NLC_CHUNK];
        set_forces(w, from, count, y);
        for (int d = 0; d < count; d++) found.count += y[d] > 0;
        const double top = nlc_largest_magnitude(n->force + from, count);
        found.force = top > found.force ? top : found.force;
    }
    n->piece[s] = found;
}

/* Forces into n->force, and beside their weights into n->share; returns how many there are, *top the largest. */
static int64_t start(nlc_iteration *q, const nlc_guess *from, double *top)
{
    job all = {q, from};
    int64_t active = 0;
    *top = 0;
    nlc_for(q->n, start_task, &all, nlc_slabs(q->n));
    for (int64_t s = 0; s < nlc_slabs(q->n); s++) {
        const nlc_piece *piece = &q->n->piece[s];
        active += piece->count;
        *top = piece->force > *top ? piece->force : *top;
    }
    return active;
}

/* What a sweep has left of n->side as displacements of contacts. */
static nlc_guess take_sweep(nlc_iteration *q)
{
    nlc_add_sides(q->n, q->n->current);
    return (nlc_guess){q->n->current, 1};
}

/* The last start and its sweep serve as those of an iteration, in the caller's units. */
static void hand_over(nlc_iteration *q, const nlc_guess *from, nlc_info *info, nlc_outcome *out)
{
    q->n->known_bound = nlc_largest_over_ranks(q->n, nlc_bound_by_norms(q, KNOWN, info), &info->critical_particle);
    q->n->known_where = info->critical_particle;
    out->info.blocks = info->blocks;
    for (int64_t c = 0; c < q->n->contact_count; c++) q->n->current[c] = from->nonlocal[c] * from->unit / q->per_overlap;
    for (int64_t e = 0; e < 2 * q->n->contact_count; e++) q->n->side[e] /= q->per_overlap;
    q->n->swept = true;
}

/* What lambda may be for a residual of this size to mean an error within the tolerance. */
static double limit_for(double ratio, double tolerance)
{
    const double limit = 1 - nlc_ratio(NLC_SAFETY * ratio, tolerance);
    return limit < 1 - NLC_MARGIN ? limit : 1 - NLC_MARGIN;
}

typedef enum verdict { OVER, SOLVED, AGAIN, HAND_OVER, GIVE_UP } verdict;

/* After a sweep of forces whose residual was as large as before, relative to the tolerance. */
static verdict judge(nlc_iteration *q, const nlc_guess *from, double before, nlc_info *info, nlc_outcome *out)
{
    nlc_network *n = q->n;
    const double tolerance = n->settings.tolerance;
    nlc_view r = nlc_look(q, from);
    double limit = limit_for(r.ratio, tolerance);
    info->lambda_upper = r.grown || limit <= 0 ? 1 : nlc_bound_by_norms(q, limit, info);
    nlc_look_over_ranks(n, &r, info);
    if (nlc_is_over(n, out)) return OVER;
    if (r.lost) return GIVE_UP;
    n->top.circle = r.circle / q->per_overlap;
    limit = limit_for(r.ratio, tolerance);
    info->residual = r.ratio;
    info->worst_contact = r.where;
    if (!r.grown && info->lambda_upper <= limit) return SOLVED;
    const double rest = nlc_ratio(r.ratio, tolerance);
    if (!nlc_is_shared(n) && r.moving < n->contact_count / 10 && rest > LOCAL) return HAND_OVER; /* region.c does less */
    return limit < STEEP && rest < FAR && rest < SLOW * before ? AGAIN : HAND_OVER;
}

/* One sweep of the forces in n->force, of which top is the largest. */
static verdict sweep(nlc_iteration *q, const nlc_guess *from, double top, double before, nlc_info *info, nlc_outcome *out)
{
    out->info.sweeps++;
    if (nlc_displace_weighed(q->n, top, q->normal, &out->info.culprit) != NLC_OK) {
        out->info.culprit = -1; /* it may be where nothing has to be looked at */
        return GIVE_UP;
    }
    nlc_exchange_particles(q->n, q->n->largest);
    return judge(q, from, before, info, out);
}

bool nlc_is_solved(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    nlc_iteration q;
    nlc_info info = out->info;
    if (!may_do(n)) return false;
    nlc_iteration_units(&q, n, overlap, normal, 1);
    nlc_guess from = {nonlocal, q.per_overlap};
    double top;
    const int64_t active = start(&q, &from, &top);
    const bool shared = nlc_is_shared(n);
    if (!shared && active <= n->contact_count / 2) return false; /* contacts are left out, which is better; ranks leave none */
    verdict v = sweep(&q, &from, top, INFINITY, &info, out);
    while (v == AGAIN && out->info.sweeps < n->settings.max_sweeps - 1) { /* the last one may be needed elsewhere */
        from = take_sweep(&q);
        start(&q, &from, &top);
        v = sweep(&q, &from, top, nlc_ratio(info.residual, n->settings.tolerance), &info, out);
    }
    if (v == OVER) return true;
    if ((v == AGAIN || v == HAND_OVER) && (shared || active > n->contact_count / 4 * 3)) hand_over(&q, &from, &info, out);
    if (v != SOLVED) return false;
    n->answered = true;
    info.sweeps = out->info.sweeps;
    info.residual *= NLC_SAFETY / (1 - info.lambda_upper);
    if (info.residual > n->settings.tolerance) info.residual = n->settings.tolerance; /* by rounding */
    info.clusters = 1;
    out->info = info;
    return true;
}
