/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * warm.c - a start that is nearly the solution already, found out at the price of a sweep.
 *
 * In a scene that moves slowly the displacements of the last steps are often good enough: forces P of the start, a sweep,
 * residual z = law(gamma + C P) - P.  What galerkin.c asks for at its end is asked for here at once, in as few passes as there can
 * be.  If little is missing, P + z is the next start, [GC] Algorithm 1: better steps cost more than the sweeps they save.  The bound
 * of lambda comes with the sweep: with the shares U_i / (U_i + U_j) a particle's block (bound.h) has the elements
 *     k_cd (w_c w_d)^1/2,   w = D (U_i + U_j),
 * and no diagonal, so that its largest eigenvalue is at most ((m-1)/m sum of k^2 w w)^1/2 for m contacts (block.h).
 */
#include "collective.h"
#include "iteration.h"
#include "slabs.h"
#include "structs.h"

#define LARGEST 8    /* displacement of a start, in units of the largest overlap */
#define FEW 16       /* a particle in so many may have its block looked at, each element of it */
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

/* Displacements to start from, which are the caller's, in the caller's units, or those of the last sweep, in n->current. */
typedef struct guess {
    const double *nonlocal;
    double unit;
} guess;

static double overlap_of(const nlc_iteration *q, const guess *from, int64_t c)
{
    return q->overlap[c] * q->load + from->nonlocal[c] * from->unit;
}

/* What passes over contacts and particles have in common. */
typedef struct job {
    nlc_iteration *q;
    const guess *from;
    double unit;
} job;

static void start_task(void *work, int64_t s)
{
    const job *w = work;
    const nlc_iteration *q = w->q;
    const nlc_network *n = q->n;
    int64_t active = 0;
    for (int64_t c = s * NLC_SLAB; c < nlc_end_of(s, NLC_SLAB, n->contact_count); c++) {
        const double y = overlap_of(q, w->from, c), k = nlc_scaled_stiffness(q, c);
        const double U = n->unit * nlc_yield_of(n, n->i[c]) + n->unit * nlc_yield_of(n, n->j[c]);
        n->force[c] = n->share[2 * c] = nlc_law(k, y);
        n->share[2 * c + 1] = 1.5 * k * U * sqrt(nlc_weighed_overlap(y));
        active += y > 0;
    }
    n->piece[s].count = active;
}

/* Forces into n->force, and beside their weights into n->share; returns how many there are. */
static int64_t start(nlc_iteration *q, const guess *from)
{
    job all = {q, from, 1};
    int64_t active = 0;
    nlc_for(q->n, start_task, &all, nlc_slabs(q->n));
    for (int64_t s = 0; s < nlc_slabs(q->n); s++) active += q->n->piece[s].count;
    return active;
}

static void take_task(void *work, int64_t s)
{
    const job *w = work;
    const nlc_network *n = w->q->n;
    for (int64_t c = s * NLC_SLAB; c < nlc_end_of(s, NLC_SLAB, n->contact_count); c++)
        n->current[c] = (n->side[2 * c] + n->side[2 * c + 1]) / w->unit;
}

/* What a sweep has left of n->side as displacements of contacts. */
static guess take_sweep(nlc_iteration *q, double unit)
{
    job all = {q, NULL, unit};
    nlc_for(q->n, take_task, &all, nlc_slabs(q->n));
    return (guess){q->n->current, 1};
}

/* The particle's contacts with their weights; false: they do not fit. */
static bool gather(nlc_block *b, const nlc_iteration *q, int64_t particle)
{
    const nlc_network *n = q->n;
    const int64_t begin = n->start[particle], count = n->start[particle + 1] - begin;
    *b = (nlc_block){.count = (int)count};
    if (count > NLC_BLOCK) return false;
    for (int d = 0; d < b->count; d++) {
        const int64_t e = nlc_side_at(n, q->normal, begin + d);
        nlc_set_direction(b, d, q->normal, e);
        b->force[d] = n->share[2 * (e >> 1) + 1];
        b->shape[d] = b->tilt[d] = 0;
    }
    return true;
}

/* Sum of k^2 w w over the pairs of a particle. */
static double squares(const nlc_iteration *q, int64_t particle)
{
    const nlc_network *n = q->n;
    nlc_block b;
    if (n->scale[particle] <= 0 || n->start[particle + 1] - n->start[particle] < 2) return 0;
    return gather(&b, q, particle) ? n->settings.model->squares(&b, nlc_kernel_of(n, particle)) : INFINITY;
}

/* Whether the particle's block has no eigenvalue above beta: by its elements, for blocks whose squares say too little. */
static bool is_below(const nlc_iteration *q, int64_t particle, double beta)
{
    nlc_block b;
    double B[NLC_BLOCK * NLC_BLOCK], k[NLC_BLOCK];
    if (!gather(&b, q, particle)) return false;
    for (int c = 0; c < b.count; c++) {
        q->n->settings.model->coefficients(k, &b, c, nlc_kernel_of(q->n, particle));
        for (int d = 0; d < c; d++) B[c * b.count + d] = k[d] * sqrt(b.force[c]) * sqrt(b.force[d]);
        B[c * b.count + c] = 0;
    }
    return nlc_is_below(B, b.count, beta);
}

/* Upper bound of lambda, at most beta, of this rank's particles; 1: it is not shown to be that small. */
static double bound(const nlc_iteration *q, double beta, nlc_info *info)
{
    const nlc_network *n = q->n;
    const bool known = nlc_variant_of(n);
    double largest = 0;
    int64_t looks = n->owned / FEW + 1;
    info->critical_particle = -1;
    for (int64_t k = 0; k < n->owned; k++) {
        const double m = (double)(n->start[k + 1] - n->start[k]), sum = known ? n->norm[k] : squares(q, k);
        double b = 2 * sum * (m - 1) / (m + (m < 1));
        if (!(b <= beta * beta)) {
            info->blocks++;
            if (looks-- == 0 || !is_below(q, k, beta)) return 1;
            b = beta * beta;
        }
        if (b <= largest) continue;
        largest = b;
        info->critical_particle = k;
    }
    return sqrt(largest);
}

/* A look at the residuals. */
typedef struct result {
    double ratio; /* largest |z| over the largest force nearby, or what the energy says (scales.c) */
    int64_t where;
    int64_t moving; /* contacts whose forces still change */
    bool grown;     /* an overlap is larger than its weight knows of */
    bool lost;      /* displacements beyond anything */
} result;

/* Of one contact; *energy and *slope: what scales.c wants to know of its particles. */
static inline void look_at(const nlc_iteration *q, const guess *from, int64_t c, result *r, double *energy, double *slope)
{
    const nlc_network *n = q->n;
    const double x = q->overlap[c] * q->load, g = n->side[2 * c] + n->side[2 * c + 1], k = nlc_scaled_stiffness(q, c);
    const double before = overlap_of(q, from, c), y = x + g, a = n->largest[n->i[c]], b = n->largest[n->j[c]];
    r->lost |= fabs(g) > 0.5 * NLC_FARTHEST;
    r->grown |= y > 0 && y > nlc_weighed_overlap(before);
    const double positive = 0.5 * (y + fabs(y)), rise = k * sqrt(positive < NLC_FARTHEST ? positive : NLC_FARTHEST);
    const double size = fabs(rise * positive - n->force[c]), scale = a > b ? a : b;
    *energy = size * fabs(y - before);
    *slope = 1.5 * rise;
    r->moving += size > n->settings.tolerance * scale;
    if (size <= r->ratio * scale) return;
    const double ratio = nlc_ratio(size, scale); /* of next to nothing over nothing it may be less all the same */
    if (ratio <= r->ratio) return;
    r->ratio = ratio;
    r->where = c;
}

static inline void add_to(const nlc_network *n, int64_t body, double energy, double slope)
{
    if (body >= n->particle_count) return;
    n->bound[body] += energy;
    n->growth[body] = slope > n->growth[body] ? slope : n->growth[body];
}

/* Threads leave with each contact what is added up afterwards, particle by particle: in the same order. */
static void look_task(void *work, int64_t s)
{
    const job *w = work;
    const nlc_network *n = w->q->n;
    const bool alone = !n->settings.parallel_for;
    result r = {.where = -1};
    for (int64_t c = s * NLC_SLAB; c < nlc_end_of(s, NLC_SLAB, n->contact_count); c++) {
        double energy, slope;
        look_at(w->q, w->from, c, &r, &energy, &slope);
        if (alone) {
            add_to(n, n->i[c], energy, slope);
            add_to(n, n->j[c], energy, slope);
        } else {
            n->own[2 * c] = energy;
            n->own[2 * c + 1] = slope;
        }
    }
    n->piece[s] = (nlc_piece){.residual = r.ratio, .bad = r.where, .count = r.moving, .flag = {r.grown, r.lost}};
}

static void add_task(void *work, int64_t v)
{
    const nlc_network *n = ((const job *)work)->q->n;
    for (int64_t k = v * NLC_WINDOW; k < nlc_end_of(v, NLC_WINDOW, n->owned); k++) {
        n->bound[k] = n->growth[k] = 0;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) add_to(n, k, n->own[n->entry[p] & ~1], n->own[n->entry[p] | 1]);
    }
}

static result look(nlc_iteration *q, const guess *from)
{
    nlc_network *n = q->n;
    job all = {q, from, 1};
    result r = {.where = -1};
    for (int64_t k = 0; k < n->particle_count; k++) n->bound[k] = n->growth[k] = 0;
    nlc_for(n, look_task, &all, nlc_slabs(n));
    for (int64_t s = 0; s < nlc_slabs(n); s++) {
        const nlc_piece *piece = &n->piece[s];
        r.grown |= piece->flag[0];
        r.lost |= piece->flag[1];
        r.moving += piece->count;
        if (piece->residual > r.ratio) r.where = piece->bad;
        r.ratio = piece->residual > r.ratio ? piece->residual : r.ratio;
    }
    if (n->settings.parallel_for) nlc_for(n, add_task, &all, nlc_windows(n));
    const double energy = nlc_energy_ratio(n, n->bound, n->growth);
    r.ratio = energy > r.ratio ? energy : r.ratio;
    return r;
}

/* The same of all ranks, and the bound of lambda. */
static void look_over_ranks(nlc_network *n, result *r, nlc_info *info)
{
    double values[4] = {r->ratio, r->grown, r->lost, info->lambda_upper};
    nlc_max_over_ranks(n, values, 4);
    if (values[0] > r->ratio) r->where = -1;
    if (values[3] > info->lambda_upper) info->critical_particle = -1;
    r->ratio = values[0];
    r->grown = values[1] > 0;
    r->lost = values[2] > 0;
    info->lambda_upper = values[3];
}

/* The last start and its sweep serve as those of an iteration, in the caller's units. */
static void hand_over(nlc_iteration *q, const guess *from, nlc_info *info, nlc_outcome *out)
{
    q->n->known_bound = nlc_largest_over_ranks(q->n, bound(q, KNOWN, info), &info->critical_particle);
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
static verdict judge(nlc_iteration *q, const guess *from, double before, nlc_info *info, nlc_outcome *out)
{
    nlc_network *n = q->n;
    const double tolerance = n->settings.tolerance;
    result r = look(q, from);
    double limit = limit_for(r.ratio, tolerance);
    info->lambda_upper = r.grown || limit <= 0 ? 1 : bound(q, limit, info);
    look_over_ranks(n, &r, info);
    if (nlc_is_over(n, out)) return OVER;
    if (r.lost) return GIVE_UP;
    limit = limit_for(r.ratio, tolerance);
    info->residual = r.ratio;
    info->worst_contact = r.where;
    if (!r.grown && info->lambda_upper <= limit) return SOLVED;
    const double rest = nlc_ratio(r.ratio, tolerance);
    if (!nlc_is_shared(n) && r.moving < n->contact_count / 10 && rest > LOCAL) return HAND_OVER; /* region.c does less */
    return limit < STEEP && rest < FAR && rest < SLOW * before ? AGAIN : HAND_OVER;
}

/* One sweep of the forces in n->force. */
static verdict sweep(nlc_iteration *q, const guess *from, double before, nlc_info *info, nlc_outcome *out)
{
    out->info.sweeps++;
    if (nlc_displace_weighed(q->n, q->normal, &out->info.culprit) != NLC_OK) {
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
    guess from = {nonlocal, q.per_overlap};
    const int64_t active = start(&q, &from);
    const bool shared = nlc_is_shared(n);
    if (!shared && active <= n->contact_count / 2) return false; /* contacts are left out, which is better; ranks leave none */
    verdict v = sweep(&q, &from, INFINITY, &info, out);
    while (v == AGAIN && out->info.sweeps < n->settings.max_sweeps - 1) { /* the last one may be needed elsewhere */
        from = take_sweep(&q, 1);
        start(&q, &from);
        v = sweep(&q, &from, nlc_ratio(info.residual, n->settings.tolerance), &info, out);
    }
    if (v == OVER) return true;
    if ((v == AGAIN || v == HAND_OVER) && (shared || active > n->contact_count / 4 * 3)) hand_over(&q, &from, &info, out);
    if (v != SOLVED) return false;
    take_sweep(&q, q.per_overlap);
    info.sweeps = out->info.sweeps;
    info.residual *= NLC_SAFETY / (1 - info.lambda_upper);
    if (info.residual > n->settings.tolerance) info.residual = n->settings.tolerance; /* by rounding */
    info.clusters = 1;
    out->info = info;
    return true;
}
