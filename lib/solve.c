/* SPDX-License-Identifier: BSD-2-Clause */
/* solve.c - the driver: checks, where to start, which method, what to hand over. */
#include <string.h>

#include "active.h"
#include "close.h"
#include "collective.h"
#include "iteration.h"
#include "slabs.h"
#include "start.h"
#include "structs.h"
#include "vector.h"

/* Largest overlap + displacement that an iteration may try, as a power of two of the largest overlap given. */
#define HEADROOM 14
/* Largest stiffness times coupling times root of overlap, as a power of 2; about 1 in anything physical. */
#define COUPLING 200

/* Whether overlaps and gaps of this size can be calculated with, in whatever unit. */
static nlc_status check_range(double overlap, int stiffness_exponent, int coupling_exponent)
{
    const int e = nlc_exponent_above(overlap) + HEADROOM;
    if (e > 1000 || stiffness_exponent + e + (e > 0 ? e / 2 + 1 : 0) > 1000) return NLC_ERROR_RANGE;
    return coupling_exponent + stiffness_exponent + (e - HEADROOM) / 2 > COUPLING ? NLC_ERROR_RANGE : NLC_OK;
}

static nlc_status check(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, int64_t *culprit)
{
    const double largest = n->top.overlap = nlc_top(n, overlap);
    n->top.nonlocal = nlc_top(n, nonlocal);
    if ((*culprit = nlc_first_not_finite(overlap, nlc_is_finite(largest) ? 0 : n->contact_count)) >= 0) return NLC_ERROR_OVERLAP;
    if ((*culprit = nlc_first_bad_normal(n, normal)) >= 0) return NLC_ERROR_NORMAL;
    if ((*culprit = nlc_first_not_finite(nonlocal, nlc_is_finite(n->top.nonlocal) ? 0 : n->contact_count)) >= 0) return NLC_ERROR_NONLOCAL;
    if (!nlc_is_shared(n)) n->top.overlap = nlc_unit_of_overlaps(overlap, n->contact_count, largest); /* else all ranks find it together */
    return check_range(largest, n->stiffness_exponent, n->coupling_exponent);
}

void nlc_start_over(nlc_outcome *out)
{
    const int64_t sweeps = out->info.sweeps, blocks = out->info.blocks;
    *out = (nlc_outcome){NLC_OK, nlc_new_info()};
    out->info.sweeps = sweeps;
    out->info.blocks = blocks;
}

void nlc_warn_if_close(const nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    if (out->status >= 0 && nlc_circles_overlap(n, overlap, normal)) out->status |= NLC_WARNING_CLOSE;
}

static void accelerated(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    /* where contact points move, displacements of sides are wanted, which are known of whole networks only */
    const bool whole = n->settings.model->shape == NLC_SHAPE_PLACE || nlc_is_shared(n);
    /* a sweep that has been done (warm.c) was one of a whole network with few contacts to leave out */
    if (!whole && !n->swept && (nlc_mark_active(n, overlap) <= n->contact_count / 4 * 3 || !n->connected)) {
        nlc_solve_clusters(n, overlap, normal, nonlocal, out);
        return;
    }
    if (!nlc_is_shared(n)) nlc_settle_region(n, overlap, normal, out);
    n->settings.model->potential ? nlc_galerkin(n, overlap, normal, out) : nlc_mixed(n, overlap, normal, out);
    nlc_warn_if_close(n, overlap, normal, out);
    out->info.clusters = 1;
}

static void iterate(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    n->swept = n->answered = false;
    n->known_bound = 1;
    if (n->settings.method == NLC_METHOD_AUTOMATIC && nlc_is_solved(n, overlap, normal, nonlocal, out)) {
        nlc_warn_if_close(n, overlap, normal, out);
        return;
    }
    nlc_start_from(n, overlap, n->swept ? n->current : nonlocal); /* further on, if that is known */
    if (n->settings.method != NLC_METHOD_FIXED_POINT) {
        accelerated(n, overlap, normal, nonlocal, out);
        return;
    }
    nlc_fixed_point(n, overlap, normal, out);
    if (out->status == NLC_WARNING_NOT_CONVERGED && out->info.sweeps < n->settings.max_sweeps &&
        n->top.nonlocal > 0) {
        nlc_start_from(n, overlap, 0); /* it may have been a bad start */
        nlc_fixed_point(n, overlap, normal, out);
    }
    nlc_warn_if_close(n, overlap, normal, out);
}

static void all_hertz(nlc_network *n, nlc_outcome *out)
{
    n->answered = false;
    memset(n->current, 0, (size_t)n->contact_count * sizeof *n->current);
    out->info.left_out = n->contact_count;
}

static void uncoupled(nlc_network *n, nlc_outcome *out)
{
    all_hertz(n, out);
    out->info.lambda_lower = out->info.lambda_upper = 0;
}

/* All that can be wrong with the arguments of a network that is one. */
static nlc_status check_arguments(nlc_network *n, const double *force, const double *nonlocal, const double *overlap,
                                  const double *normal, int64_t *culprit)
{
    const double *const argument[4] = {force, nonlocal, overlap, normal};
    *culprit = -1;
    n->top.overlap = n->top.nonlocal = 0;
    if (n->contact_count == 0) return NLC_OK;
    for (int a = 0; a < 4; a++) {
        *culprit = a + 1;
        if (!argument[a]) return NLC_ERROR_NULL;
    }
    return check(n, overlap, normal, nonlocal, culprit);
}

/* The ranks of a shared network come together; false if there is an error anywhere. */
static bool meet(nlc_network *n, nlc_status status, const double *overlap, nlc_outcome *out)
{
    double top[6] = {0, 0, 0, n->stiffness_exponent, n->coupling_exponent, 0};
    if (status == NLC_OK) {
        nlc_largest_overlaps(n, overlap);
        top[0] = n->top.overlap;
        top[1] = nlc_largest_magnitude(n->stiffness, n->contact_count);
        top[2] = n->top.nonlocal;
        top[5] = nlc_largest_magnitude(n->largest, n->body_count);
    }
    nlc_meet(n, NLC_SOLVE, status, out->info.culprit, n->largest, top, 6);
    nlc_clamp_ghosts(n, n->largest, 0, top[0]);
    memcpy(nlc_shared_overlaps(n), n->largest, (size_t)n->body_count * sizeof *n->largest);
    n->top = (nlc_tops){nlc_unit_of_overlaps(top + 5, 1, top[0]), top[1], top[2], -1};
    if (nlc_is_over(n, out)) return false;
    out->info.culprit = -1;
    out->status = check_range(top[0], (int)top[3], (int)top[4]);
    if (out->status != NLC_OK) nlc_take_leave(n, 0, out);
    return out->status == NLC_OK;
}

static void solve(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    if (!n->settings.model->within)
        uncoupled(n, out);
    else if (n->settings.method == NLC_METHOD_AUTOMATIC && !nlc_is_shared(n) && nlc_is_loose(n, overlap, normal, out))
        all_hertz(n, out);
    else
        iterate(n, overlap, normal, nonlocal, out);
}

/* The caller's results. */
typedef struct results {
    const nlc_network *n;
    const double *overlap;
    double *force, *nonlocal;
} results;

static void result_task(void *work, int64_t s)
{
    const results *r = work;
    const nlc_network *n = r->n;
    const int64_t from = s * NLC_SLAB, end = nlc_end_of(s, NLC_SLAB, n->contact_count);
    int64_t active = 0;
    nlc_answers(n, from, end, r->nonlocal);
    for (int64_t c = from; c < end; c++) r->force[c] = nlc_law(n->stiffness[c], r->overlap[c] + r->nonlocal[c]);
    for (int64_t c = from; c < end; c++) active += r->force[c] > 0;
    n->piece[s].count = active;
}

/* Returns how many forces there are. */
static int64_t hand_out(const nlc_network *n, double *force, double *nonlocal, const double *overlap)
{
    results all = {n, overlap, force, nonlocal};
    int64_t active = 0;
    nlc_for(n, result_task, &all, nlc_slabs(n));
    for (int64_t s = 0; s < nlc_slabs(n); s++) active += n->piece[s].count;
    return active;
}

nlc_status nlc_solve(nlc_network *network, double *NLC_RESTRICT force, double *NLC_RESTRICT nonlocal,
                     const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info)
{
    const bool valid = nlc_info_is_valid(info), shared = network && nlc_network_is_valid(network) && nlc_is_shared(network);
    if (!valid && !shared) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    const int64_t count = network->contact_count;
    if (count == 0 && !shared) return nlc_error(info, NLC_OK, -1);
    nlc_outcome out = {NLC_OK, nlc_new_info()};
    out.status = valid ? check_arguments(network, force, nonlocal, overlap, normal, &out.info.culprit) : NLC_ERROR_STRUCT_SIZE;
    if (shared) meet(network, out.status, overlap, &out);
    network->cached = false;
    if (out.status == NLC_OK) solve(network, overlap, normal, nonlocal, &out);
    if (shared && out.status >= 0) {
        for (int64_t c = 0; c < count; c++) network->force[c] = nlc_law(network->stiffness[c], overlap[c] + nlc_answer(network, c));
        nlc_take_leave(network, network->force, &out);
    }
    if (out.status < 0) return valid ? nlc_error(info, out.status, out.info.culprit) : out.status;

    const int64_t active = hand_out(network, force, nonlocal, overlap);
    if (!shared) out.info.active = active;
    return nlc_report(info, &out.info, out.status);
}
