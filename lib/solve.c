/* SPDX-License-Identifier: BSD-2-Clause */
/* solve.c - the driver: checks, where to start, which method, what to hand over. */
#include <string.h>

#include "active.h"
#include "collective.h"
#include "slabs.h"
#include "structs.h"
#include "vector.h"

/* Largest overlap + displacement that an iteration may try, as a power of two of the largest overlap given. */
#define HEADROOM 14
/* Largest stiffness times coupling times root of overlap, as a power of 2; about 1 in anything physical. */
#define COUPLING 200

/* Whether numbers of this size can be calculated with; culprit: they cannot. */
static nlc_status check_range(double overlap, int stiffness_exponent, int coupling_exponent)
{
    const int e = nlc_exponent_above(overlap) + HEADROOM;
    if (e > 1000 || stiffness_exponent + e + (e > 0 ? e / 2 + 1 : 0) > 1000) return NLC_ERROR_RANGE;
    return coupling_exponent + stiffness_exponent + (e - HEADROOM) / 2 > COUPLING ? NLC_ERROR_RANGE : NLC_OK;
}

static nlc_status check(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, int64_t *culprit)
{
    n->top.overlap = nlc_top(n, overlap);
    n->top.nonlocal = nlc_top(n, nonlocal);
    if ((*culprit = nlc_first_not_finite(overlap, nlc_is_finite(n->top.overlap) ? 0 : n->contact_count)) >= 0) return NLC_ERROR_OVERLAP;
    if ((*culprit = nlc_first_bad_normal(n, normal)) >= 0) return NLC_ERROR_NORMAL;
    if ((*culprit = nlc_first_not_finite(nonlocal, nlc_is_finite(n->top.nonlocal) ? 0 : n->contact_count)) >= 0) return NLC_ERROR_NONLOCAL;
    return check_range(n->top.overlap, n->stiffness_exponent, n->coupling_exponent);
}

/* Largest overlap on each particle, 0 at least. */
static void largest_overlaps(nlc_network *n, const double *overlap)
{
    for (int64_t k = 0; k < n->particle_count; k++) n->largest[k] = 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double x = overlap[c];
        if (x <= 0) continue;
        const int64_t i = n->i[c], j = n->j[c];
        if (i < n->particle_count && x > n->largest[i]) n->largest[i] = x;
        if (j < n->particle_count && x > n->largest[j]) n->largest[j] = x;
    }
}

/*
 * The caller's displacement as a start, capped where overlap + displacement would exceed 3 times the largest overlap on the
 * two particles: that is where the stable branch ends for equal forces, and beyond it lies the unstable one.
 */
static double start_of(const nlc_network *n, int64_t c, const double *overlap, const double *nonlocal)
{
    const double g = nonlocal ? nonlocal[c] : 0;
    if (nlc_abs_bits(g) == 0) return 0;
    const double a = n->largest[n->i[c]], b = n->largest[n->j[c]];
    double cap = 3 * (a > b ? a : b) - overlap[c];
    cap = cap > 0 ? cap : 0;
    return g > cap ? cap : g < -cap ? -cap : g;
}

/* nonlocal may be n->current. */
static void start_from(nlc_network *n, const double *overlap, const double *nonlocal)
{
    bool capped = false;
    if (nlc_is_shared(n)) memcpy(n->largest, nlc_shared_overlaps(n), (size_t)n->body_count * sizeof *n->largest);
    else largest_overlaps(n, overlap);
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double g = start_of(n, c, overlap, nonlocal);
        capped |= nonlocal && nlc_bits(g) != nlc_bits(nonlocal[c]);
        n->current[c] = g;
    }
    if (n->swept) n->swept = !nlc_on_any_rank(n, capped);
    if (!n->swept) n->known_bound = 1;
}

void nlc_start_over(nlc_outcome *out)
{
    const int64_t sweeps = out->info.sweeps, blocks = out->info.blocks;
    *out = (nlc_outcome){NLC_OK, nlc_new_info()};
    out->info.sweeps = sweeps;
    out->info.blocks = blocks;
}

static void warn_if_close(const nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    if (out->status >= 0 && nlc_circles_overlap(n, overlap, normal)) out->status |= NLC_WARNING_CLOSE;
}

static int64_t named(int64_t in_part, const int64_t *contact)
{
    return in_part < 0 ? -1 : contact[in_part];
}

static int64_t named_particle(const nlc_network *n, int64_t in_part)
{
    return in_part < 0 ? -1 : n->body[in_part];
}

/* Adds what a cluster came to: the worst counts; of sweeps the most, since clusters are solved side by side. */
static void merge(nlc_outcome *out, const nlc_network *n, const nlc_outcome *part, const int64_t *origin)
{
    nlc_info *a = &out->info;
    const nlc_info *b = &part->info;
    out->status |= part->status;
    a->clusters++;
    a->blocks += b->blocks;
    a->weakened += b->weakened;
    if (b->sweeps > a->sweeps) a->sweeps = b->sweeps;
    if (b->lambda_lower > a->lambda_lower) a->lambda_lower = b->lambda_lower;
    if (a->worst_contact < 0 || b->residual > a->residual) {
        a->residual = b->residual;
        a->worst_contact = named(b->worst_contact, origin);
    }
    if (a->clusters == 1 || b->lambda_upper > a->lambda_upper) {
        a->lambda_upper = b->lambda_upper;
        a->critical_particle = named_particle(n, b->critical_particle);
    }
    if (b->coupling < a->coupling) {
        a->coupling = b->coupling;
        a->weakest_particle = named_particle(n, b->weakest_particle);
    }
}

/*
 * One cluster.  After others have been found to touch it goes on from where it is if some of them have joined it, and else starts
 * anew from where it did: a cluster does not learn what happens in others.
 */
static void solve_cluster(nlc_network *n, const int64_t *origin, int64_t count, const double *overlap, const double *normal,
                          const double *nonlocal, int64_t sweeps_before, nlc_outcome *out)
{
    nlc_outcome part = {NLC_OK, nlc_new_info()};
    bool joined = false;
    for (int64_t m = 0; m < count; m++) joined |= n->mark[origin[m]] == NLC_NEW;
    for (int64_t m = 0; m < count && !joined; m++) n->current[origin[m]] = start_of(n, origin[m], overlap, nonlocal);
    nlc_build_part(n, origin, count, overlap, normal);
    n->part->settings.max_sweeps -= sweeps_before;
    n->settings.model->potential ? nlc_galerkin(n->part, n->part_overlap, n->part_normal, &part)
                                 : nlc_mixed(n->part, n->part_overlap, n->part_normal, &part);
    warn_if_close(n->part, n->part_overlap, n->part_normal, &part);
    if (part.status < 0) {
        out->status = part.status;
        out->info.culprit = named(part.info.culprit, origin);
        return;
    }
    merge(out, n, &part, origin);
    nlc_collect_part(n, origin);
}

/* Each cluster of contacts that may have a force, until it turns out that no other contact has. */
static void by_clusters(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    int64_t before = out->info.sweeps;
    for (int64_t more = 1; more > 0;) {
        const int64_t blocks = out->info.blocks;
        *out = (nlc_outcome){NLC_OK, nlc_new_info()};
        out->info.blocks = blocks;
        nlc_set_rest(n, overlap);
        const int64_t count = nlc_sort_clusters(n);
        out->info.left_out = n->contact_count - count;
        if (count == 0) out->info.lambda_lower = out->info.lambda_upper = 0; /* nothing is coupled */
        for (int64_t m = 0, end; m < count && out->status >= 0; m = end) {
            end = nlc_cluster_end(n, m, count);
            solve_cluster(n, n->origin + m, end - m, overlap, normal, nonlocal, before, out);
        }
        out->info.sweeps += before;
        before = out->info.sweeps;
        if (out->status < 0) return;
        more = nlc_check_rest(n, overlap, normal, &out->info.culprit);
        if (more < 0) out->status = NLC_ERROR_COINCIDENT;
        if (more > 0 && before >= n->settings.max_sweeps) {
            out->status |= NLC_WARNING_NOT_CONVERGED;
            return;
        }
    }
}

static void accelerated(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    /* where contact points move, displacements of sides are wanted, which are known of whole networks only */
    const bool whole = n->settings.model->shape == NLC_SHAPE_PLACE || nlc_is_shared(n);
    /* a sweep that has been done (warm.c) was one of a whole network with few contacts to leave out */
    if (!whole && !n->swept && (nlc_mark_active(n, overlap) <= n->contact_count / 4 * 3 || !n->connected)) {
        by_clusters(n, overlap, normal, nonlocal, out);
        return;
    }
    if (!nlc_is_shared(n)) nlc_settle_region(n, overlap, normal, out);
    n->settings.model->potential ? nlc_galerkin(n, overlap, normal, out) : nlc_mixed(n, overlap, normal, out);
    warn_if_close(n, overlap, normal, out);
    out->info.clusters = 1;
}

static void iterate(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    n->swept = false;
    n->known_bound = 1;
    if (n->settings.method == NLC_METHOD_AUTOMATIC && nlc_is_solved(n, overlap, normal, nonlocal, out)) {
        warn_if_close(n, overlap, normal, out);
        return;
    }
    start_from(n, overlap, n->swept ? n->current : nonlocal); /* further on, if that is known */
    if (n->settings.method != NLC_METHOD_FIXED_POINT) {
        accelerated(n, overlap, normal, nonlocal, out);
        return;
    }
    nlc_fixed_point(n, overlap, normal, out);
    if (out->status == NLC_WARNING_NOT_CONVERGED && out->info.sweeps < n->settings.max_sweeps &&
        n->top.nonlocal > 0) {
        start_from(n, overlap, 0); /* it may have been a bad start */
        nlc_fixed_point(n, overlap, normal, out);
    }
    warn_if_close(n, overlap, normal, out);
}

static void all_hertz(nlc_network *n, nlc_outcome *out)
{
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
    double top[5] = {0, 0, 0, n->stiffness_exponent, n->coupling_exponent};
    if (status == NLC_OK) {
        largest_overlaps(n, overlap);
        top[0] = n->top.overlap;
        top[1] = nlc_largest_magnitude(n->stiffness, n->contact_count);
        top[2] = n->top.nonlocal;
    }
    nlc_meet(n, NLC_SOLVE, status, out->info.culprit, n->largest, top, 5);
    memcpy(nlc_shared_overlaps(n), n->largest, (size_t)n->body_count * sizeof *n->largest);
    n->top = (nlc_tops){top[0], top[1], top[2]};
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
    int64_t active = 0;
    for (int64_t c = s * NLC_SLAB; c < nlc_end_of(s, NLC_SLAB, n->contact_count); c++) {
        r->nonlocal[c] = n->current[c];
        r->force[c] = nlc_law(n->stiffness[c], r->overlap[c] + r->nonlocal[c]);
        active += r->force[c] > 0;
    }
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
        for (int64_t c = 0; c < count; c++) network->force[c] = nlc_law(network->stiffness[c], overlap[c] + network->current[c]);
        nlc_take_leave(network, network->force, &out);
    }
    if (out.status < 0) return valid ? nlc_error(info, out.status, out.info.culprit) : out.status;

    const int64_t active = hand_out(network, force, nonlocal, overlap);
    if (!shared) out.info.active = active;
    return nlc_report(info, &out.info, out.status);
}
