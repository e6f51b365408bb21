/* SPDX-License-Identifier: BSD-2-Clause */
/* bound.c - an upper bound of the largest eigenvalue, particle by particle. */
#include "bound.h"

#include "block.h"
#include "collective.h"
#include "slabs.h"

/* No side gets less: a share near zero would make its particle's block huge. */
#define SHARE_MIN 0.05

/* Shares in the ratio of a to b, by the same roundings whichever side is called i. */
static void set_shares(nlc_network *n, int64_t c, double a, double b)
{
    const double sum = a + b, some = sum + (sum <= 0); /* neither yields between a rigid body and a wall */
    double s = a / some, t = b / some;
    if (a > 0 && b > 0 && (s < SHARE_MIN || t < SHARE_MIN)) {
        s = s < t ? SHARE_MIN : 1 - SHARE_MIN;
        t = t < SHARE_MIN ? SHARE_MIN : 1 - SHARE_MIN;
    }
    n->share[2 * c] = s;
    n->share[2 * c + 1] = t;
}

/* Shares by what the sides yield to a unit force; the whole of it where the other side does not yield at all. */
static void share_out(void *network, int64_t from, int64_t end)
{
    nlc_network *n = network;
    for (int64_t c = from; c < end; c++) set_shares(n, c, nlc_yield_of(n, n->i[c]), nlc_yield_of(n, n->j[c]));
}

static void first_shares(nlc_network *n)
{
    nlc_for_contacts(n, share_out, n);
}

static bool couples(const nlc_network *n, int64_t particle)
{
    return n->scale[particle] > 0 && n->start[particle + 1] > n->start[particle];
}

/* Sets network->changed of the particles from first to end; 0: it is known that b_k <= beta. */
static void mark_above(nlc_network *n, const double *normal, double beta, int64_t first, int64_t end)
{
    if (nlc_variant_of(n) && beta > 0)
        n->settings.variant->mark_above(n, n->side, normal, beta, first, end);
    else
        for (int64_t k = first; k < end; k++) n->changed[k] = 1;
}

/* The cheapest test that decides. */
static bool is_below(nlc_network *n, const double *normal, int64_t k, double beta, nlc_bound *result)
{
    if (!couples(n, k)) return true;
    result->blocks++;
    if (!n->changed[k] || nlc_block_norm(n, normal, k) <= beta) return true;
    result->blocks++;
    return nlc_block_is_below(n, normal, k, beta);
}

/* (U D / share)^1/2 of each side, into network->side; no share, no U. */
static void set_roots(void *network, int64_t from, int64_t end)
{
    nlc_network *n = network;
    for (int64_t c = from; c < end; c++)
        for (int side = 0; side < 2; side++) {
            const int64_t body = side == 0 ? n->i[c] : n->j[c];
            const double share = n->share[2 * c + side];
            n->side[2 * c + side] = sqrt(n->unit * nlc_yield_of(n, body) * n->slope[c] / (share + (share <= 0)));
        }
}

typedef struct job {
    nlc_network *n;
    const double *normal;
    double beta;
} job;

static void mark_task(void *work, int64_t w)
{
    const job *m = work;
    mark_above(m->n, m->normal, m->beta, w * NLC_WINDOW, nlc_end_of(w, NLC_WINDOW, m->n->owned));
}

/* Of the particles here; where is one of which it is not so. */
static bool all_below(nlc_network *n, const double *normal, double beta, nlc_bound *result)
{
    job all = {n, normal, beta};
    if (n->settings.parallel_for) nlc_for(n, mark_task, &all, nlc_windows(n));
    for (int64_t w = 0; w < nlc_windows(n); w++) {
        if (!n->settings.parallel_for) mark_task(&all, w); /* the first one above ends it */
        for (int64_t k = w * NLC_WINDOW; k < nlc_end_of(w, NLC_WINDOW, n->owned); k++) {
            if (is_below(n, normal, k, beta, result)) continue;
            result->where = k;
            return false;
        }
    }
    return true;
}

bool nlc_bound_below(nlc_network *n, const double *normal, double beta, nlc_bound *result)
{
    first_shares(n);
    nlc_for_contacts(n, set_roots, n);
    if (nlc_on_any_rank(n, !all_below(n, normal, beta, result))) return false;
    result->upper = beta;
    return true;
}

/* Moves the shares of all contacts towards equal b_k; marks the particles whose block has changed and by how much it grew. */
static void move_shares(nlc_network *n)
{
    for (int64_t c = 0; c < n->contact_count; c++) {
        const int64_t i = n->i[c], j = n->j[c];
        const double old = n->share[2 * c];
        if (i == j || n->slope[c] <= 0 || old <= 0 || old >= 1) continue;
        const double other = n->share[2 * c + 1];
        set_shares(n, c, old * n->bound[i] * n->bound[i], other * n->bound[j] * n->bound[j]);
        const double s = n->share[2 * c], t = n->share[2 * c + 1];
        if (fabs(s - old) <= 1e-15 && fabs(t - other) <= 1e-15) continue;
        const double grow_i = old / s, grow_j = other / t;
        n->growth[i] = grow_i > n->growth[i] ? grow_i : n->growth[i];
        n->growth[j] = grow_j > n->growth[j] ? grow_j : n->growth[j];
        n->changed[i] = n->changed[j] = 1;
    }
}

/* b of one particle: exact where a cheap bound, the norm of the block, exceeds the floor. */
static double bound_of(nlc_network *n, const double *normal, int64_t k, nlc_bound *result)
{
    if (!couples(n, k)) return NLC_BOUND_FLOOR;
    if (n->norm[k] < 0) {
        n->norm[k] = nlc_block_norm(n, normal, k);
        result->blocks++;
    } else {
        n->norm[k] *= n->growth[k]; /* D / share grew by no more */
    }
    if (n->norm[k] <= NLC_BOUND_FLOOR) return NLC_BOUND_FLOOR;
    result->blocks++;
    const double b = nlc_block_eigenvalue(n, normal, k);
    return b > NLC_BOUND_FLOOR ? b : NLC_BOUND_FLOOR;
}

void nlc_bound_balance(nlc_network *n, const double *normal, int passes, double enough, nlc_bound *result)
{
    first_shares(n);
    for (int64_t k = 0; k < n->particle_count; k++) {
        n->changed[k] = 1;
        n->norm[k] = -1;
        n->growth[k] = 1;
    }
    for (int pass = 0;; pass++) {
        result->upper = 0;
        for (int64_t k = 0; k < n->owned; k++) {
            if (n->changed[k]) n->bound[k] = bound_of(n, normal, k, result);
            n->changed[k] = 0;
            n->growth[k] = 1;
            if (n->bound[k] <= result->upper) continue;
            result->upper = n->bound[k];
            result->where = k;
        }
        nlc_exchange_particles(n, n->bound);
        nlc_clamp_ghosts(n, n->bound, NLC_BOUND_FLOOR, NLC_LARGEST_ELEMENT);
        result->upper = nlc_largest_over_ranks(n, result->upper, &result->where);
        if (result->upper <= enough || pass == passes || n->ranks.over) return;
        move_shares(n);
    }
}

void nlc_bound_particles(nlc_network *n, const double *normal, nlc_bound *result)
{
    first_shares(n);
    result->upper = 0;
    for (int64_t k = 0; k < n->owned; k++) {
        n->bound[k] = 0;
        if (!couples(n, k)) continue;
        result->blocks++;
        const double norm = nlc_block_norm(n, normal, k);
        n->bound[k] = norm > NLC_BOUND_FLOOR ? nlc_block_eigenvalue(n, normal, k) : norm;
        result->blocks += norm > NLC_BOUND_FLOOR;
        if (n->bound[k] < 0) n->bound[k] = 0;
        if (n->bound[k] <= result->upper) continue;
        result->upper = n->bound[k];
        result->where = k;
    }
    nlc_exchange_particles(n, n->bound);
    result->upper = nlc_largest_over_ranks(n, result->upper, &result->where);
    if (result->upper >= 1) nlc_bound_balance(n, normal, 16, 1 - 1e-6, result);
}
