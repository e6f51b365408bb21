/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * warm.c - a start that is the solution already, found out at the price of one sweep.
 *
 * In a scene that moves slowly the displacements of the last steps are often good enough: forces P of the start, a sweep,
 * residual z = law(gamma + C P) - P.  What galerkin.c asks for at its end is asked for here at once, in as few passes as there can
 * be.  The bound of lambda comes with the sweep: with the shares U_i / (U_i + U_j) a particle's block (bound.h) has the elements
 *     k_cd (w_c w_d)^1/2,   w = D (U_i + U_j),
 * and no diagonal, so that its largest eigenvalue is at most ((m-1)/m sum of k^2 w w)^1/2 for m contacts (block.h).
 */
#include "collective.h"
#include "iteration.h"
#include "structs.h"

#define LARGEST 8    /* displacement of a start, in units of the largest overlap */
#define GROWTH 1.01  /* weights are those of overlaps larger by this factor ... */
#define MORE 1e-4    /* ... and this, in units of about the largest overlap: none may grow beyond */

/* What a start has to be worth looking at: displacements of about the right size, half of the contacts with a force, one cluster. */
static bool may_do(const nlc_network *n, const double *overlap, const double *nonlocal, int64_t *active)
{
    const bool shared = nlc_is_shared(n);
    const double largest = shared ? n->ranks.nonlocal : nlc_largest_magnitude(nonlocal, n->contact_count);
    *active = n->contact_count;
    if (!n->settings.model->potential || !nlc_is_linear(n->settings.model->shape) || largest <= 0) return false;
    if (n->settings.max_sweeps < 2 && !shared) return false; /* that one is needed elsewhere */
    if (largest > LARGEST * (shared ? n->ranks.overlap : nlc_largest_magnitude(overlap, n->contact_count))) return false;
    if (shared || !n->connected) return shared; /* ranks leave nothing out */
    *active = 0;
    for (int64_t c = 0; c < n->contact_count; c++) *active += overlap[c] + nonlocal[c] > 0;
    return *active > n->contact_count / 2;
}

static double weighed_overlap(double y)
{
    const double more = GROWTH * y + MORE;
    return 0.5 * (more + fabs(more));
}

/* Forces of the start into n->force, and beside their weights into n->share. */
static void start(nlc_iteration *q, const double *nonlocal)
{
    nlc_network *n = q->n;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double y = q->overlap[c] * q->load + nonlocal[c] * q->per_overlap, k = nlc_scaled_stiffness(q, c);
        const double U = n->unit * nlc_yield_of(n, n->i[c]) + n->unit * nlc_yield_of(n, n->j[c]);
        n->force[c] = n->share[2 * c] = nlc_law(k, y);
        n->share[2 * c + 1] = 1.5 * k * U * sqrt(weighed_overlap(y));
    }
}

/* Sum of k^2 w w over the pairs of a particle. */
static double squares(const nlc_iteration *q, int64_t particle)
{
    const nlc_network *n = q->n;
    const int64_t begin = n->start[particle], count = n->start[particle + 1] - begin;
    nlc_block b = {.count = (int)count};
    if (n->scale[particle] <= 0 || count < 2) return 0;
    if (count > NLC_BLOCK) return INFINITY;
    for (int d = 0; d < b.count; d++) {
        const int64_t e = nlc_side_at(n, q->normal, begin + d);
        nlc_set_direction(&b, d, q->normal, e);
        b.force[d] = n->share[2 * (e >> 1) + 1];
        b.shape[d] = b.tilt[d] = 0;
    }
    return n->settings.model->squares(&b, nlc_kernel_of(n, particle));
}

/* Upper bound of lambda; 1 or more: it is not known. */
static double bound(const nlc_iteration *q, int64_t *where)
{
    const nlc_network *n = q->n;
    const bool known = nlc_variant_of(n);
    double largest = 0;
    *where = -1;
    for (int64_t k = 0; k < n->owned; k++) {
        const double m = (double)(n->start[k + 1] - n->start[k]), sum = known ? n->norm[k] : squares(q, k);
        if (!(sum < 1)) return 1; /* m > 1 then */
        const double b = 2 * sum * (m - 1) / (m + (m < 1));
        if (b <= largest) continue;
        largest = b;
        *where = k;
    }
    return sqrt(largest);
}

/* A look at the residuals. */
typedef struct result {
    double ratio; /* largest |z| over the largest force nearby, or what the energy says (scales.c) */
    int64_t where;
    bool grown; /* an overlap is larger than its weight knows of */
    bool lost;  /* displacements beyond anything */
} result;

static result look(nlc_iteration *q, const double *nonlocal)
{
    nlc_network *n = q->n;
    result r = {.where = -1};
    double *sum = n->bound, *top = n->growth, worst = 0;
    for (int64_t k = 0; k < n->particle_count; k++) sum[k] = top[k] = 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const int64_t i = n->i[c], j = n->j[c];
        const double x = q->overlap[c] * q->load, g = n->side[2 * c] + n->side[2 * c + 1], k = nlc_scaled_stiffness(q, c);
        const double before = x + nonlocal[c] * q->per_overlap, y = x + g, a = n->largest[i], b = n->largest[j];
        r.lost |= fabs(g) > NLC_FARTHEST;
        r.grown |= y > 0 && y > weighed_overlap(before);
        const double positive = 0.5 * (y + fabs(y)), rise = k * sqrt(positive < NLC_FARTHEST ? positive : NLC_FARTHEST), slope = 1.5 * rise;
        const double z = rise * positive - n->force[c], size = fabs(z), scale = a > b ? a : b;
        const double energy = size * fabs(y - before);
        if (i < n->particle_count) {
            sum[i] += energy;
            top[i] = slope > top[i] ? slope : top[i];
        }
        if (j < n->particle_count) {
            sum[j] += energy;
            top[j] = slope > top[j] ? slope : top[j];
        }
        n->current[c] = g;
        if (size <= worst * scale) continue;
        worst = nlc_ratio(size, scale);
        r.where = c;
    }
    r.ratio = nlc_energy_ratio(n, sum, top);
    r.ratio = worst > r.ratio ? worst : r.ratio;
    return r;
}

/* The same of all ranks, and the bound. */
static void look_over_ranks(nlc_network *n, result *r, double *upper, int64_t *where)
{
    double values[4] = {r->ratio, *upper, r->grown, r->lost};
    nlc_max_over_ranks(n, values, 4);
    if (values[0] > r->ratio) r->where = -1;
    if (values[1] > *upper) *where = -1;
    r->ratio = values[0];
    *upper = values[1];
    r->grown = values[2] > 0;
    r->lost = values[3] > 0;
}

/* What was found serves as the first sweep of an iteration, in the caller's units. */
static void hand_over(nlc_iteration *q)
{
    for (int64_t e = 0; e < 2 * q->n->contact_count; e++) q->n->side[e] /= q->per_overlap;
    q->n->swept = true;
}

bool nlc_is_solved(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    nlc_iteration q;
    nlc_info info = out->info;
    const double tolerance = n->settings.tolerance;
    int64_t active;
    if (!may_do(n, overlap, nonlocal, &active)) return false;
    nlc_iteration_units(&q, n, overlap, normal, 1);
    start(&q, nonlocal);
    out->info.sweeps++;
    const nlc_status status = nlc_displace_weighed(n, normal, &out->info.culprit);
    if (status != NLC_OK && !nlc_is_shared(n)) { /* it may be where nothing has to be looked at */
        out->info.culprit = -1;
        return false;
    }
    out->status = status;
    if (status != NLC_OK) return true;
    nlc_exchange_particles(n, n->largest);
    result r = look(&q, nonlocal);
    if (r.lost && !nlc_is_shared(n)) return false;
    double upper = bound(&q, &info.critical_particle);
    look_over_ranks(n, &r, &upper, &info.critical_particle);
    if (nlc_is_over(n, out)) return true;
    if (r.lost) return false;
    const double limit = 1 - NLC_SAFETY * r.ratio / tolerance;
    if (r.grown || upper > (limit < 1 - NLC_MARGIN ? limit : 1 - NLC_MARGIN)) {
        if (nlc_is_shared(n) || active > n->contact_count / 4 * 3) hand_over(&q); /* else contacts are left out */
        return false;
    }
    info.sweeps = out->info.sweeps;
    info.lambda_upper = upper;
    info.residual = NLC_SAFETY * r.ratio / (1 - upper);
    info.worst_contact = r.where;
    info.clusters = 1;
    out->info = info;
    nlc_iteration_end(&q);
    return true;
}
