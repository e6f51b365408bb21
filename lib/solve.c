/* SPDX-License-Identifier: BSD-2-Clause */
/* solve.c - the driver: checks, where to start, which method, what to hand over. */
#include <string.h>

#include "active.h"
#include "structs.h"
#include "vector.h"

/* Largest overlap + displacement that an iteration may try, as a power of two of the largest overlap given. */
#define HEADROOM 14
/* Largest stiffness times coupling times root of overlap, as a power of 2; about 1 in anything physical. */
#define COUPLING 200

static nlc_status check(const nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, int64_t *culprit)
{
    if ((*culprit = nlc_first_not_finite(overlap, n->contact_count)) >= 0) return NLC_ERROR_OVERLAP;
    if ((*culprit = nlc_first_not_unit(normal, n->contact_count)) >= 0) return NLC_ERROR_NORMAL;
    if ((*culprit = nlc_first_not_finite(nonlocal, n->contact_count)) >= 0) return NLC_ERROR_NONLOCAL;
    int e = nlc_exponent_above(nlc_largest_magnitude(overlap, n->contact_count)) + HEADROOM;
    if (e > 1000 || n->stiffness_exponent + e + (e > 0 ? e / 2 + 1 : 0) > 1000) return NLC_ERROR_RANGE;
    return n->coupling_exponent + n->stiffness_exponent + (e - HEADROOM) / 2 > COUPLING ? NLC_ERROR_RANGE : NLC_OK;
}

/* Largest overlap on each particle, 0 at least. */
static void largest_overlaps(nlc_network *n, const double *overlap)
{
    for (int64_t k = 0; k < n->particle_count; k++) {
        double largest = 0;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
            double x = overlap[n->entry[p] >> 1];
            largest = x > largest ? x : largest;
        }
        n->largest[k] = largest;
    }
}

/*
 * The caller's displacements as a start, capped where overlap + displacement would exceed 3 times the largest overlap on the
 * two particles: that is where the stable branch ends for equal forces, and beyond it lies the unstable one.
 */
static void start_from(nlc_network *n, const double *overlap, const double *nonlocal)
{
    largest_overlaps(n, overlap);
    for (int64_t c = 0; c < n->contact_count; c++) {
        double a = n->largest[n->i[c]], b = n->largest[n->j[c]];
        double cap = 3 * (a > b ? a : b) - overlap[c];
        cap = cap > 0 ? cap : 0;
        double g = nonlocal ? nonlocal[c] : 0;
        n->current[c] = g > cap ? cap : g < -cap ? -cap : g;
    }
}

static bool all_zero(const double *values, int64_t count)
{
    for (int64_t c = 0; c < count; c++)
        if (nlc_abs_bits(values[c]) != 0) return false;
    return true;
}

/* The part's numbers of contacts and particles in those of the whole. */
static void name_in_whole(const nlc_network *n, nlc_outcome *out)
{
    const int64_t critical = out->info.critical_particle, weakest = out->info.weakest_particle;
    if (out->status < 0 && n->part->contact_count > 0 && out->in_part && out->info.culprit >= 0)
        out->info.culprit = n->origin[out->info.culprit];
    if (out->info.worst_contact >= 0) out->info.worst_contact = n->origin[out->info.worst_contact];
    out->info.critical_particle = out->info.weakest_particle = -1;
    for (int64_t k = 0; k < n->particle_count; k++) {
        if (n->place[k] < 0) continue;
        if (n->place[k] == critical) out->info.critical_particle = k;
        if (n->place[k] == weakest) out->info.weakest_particle = k;
    }
    out->info.left_out = n->contact_count - n->part->contact_count;
}

void nlc_start_over(nlc_outcome *out)
{
    const int64_t sweeps = out->info.sweeps, blocks = out->info.blocks;
    *out = (nlc_outcome){NLC_OK, false, nlc_new_info()};
    out->info.sweeps = sweeps;
    out->info.blocks = blocks;
}

static void warn_if_close(const nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    if (out->status >= 0 && nlc_circles_overlap(n, overlap, normal)) out->status |= NLC_WARNING_CLOSE;
}

/* Solves for the contacts that may have a force, until it turns out that no other one has. */
static void by_parts(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    int64_t more = 1;
    if (nlc_mark_active(n, overlap) > n->contact_count / 4 * 3) { /* a copy of them would cost more than it saves */
        nlc_galerkin(n, overlap, normal, out);
        warn_if_close(n, overlap, normal, out);
        return;
    }
    while (more > 0) {
        nlc_build_part(n, overlap, normal);
        nlc_start_over(out);
        if (n->part->contact_count > 0)
            nlc_galerkin(n->part, n->part_overlap, n->part_normal, out);
        else
            out->info.lambda_lower = out->info.lambda_upper = 0; /* nothing is coupled */
        out->in_part = out->status < 0;
        if (out->in_part) break;
        nlc_collect_part(n);
        more = nlc_check_rest(n, overlap, normal, &out->info.culprit);
        if (more < 0) out->status = NLC_ERROR_COINCIDENT;
        if (more > 0 && out->info.sweeps >= n->settings.max_sweeps) {
            out->status |= NLC_WARNING_NOT_CONVERGED;
            break;
        }
    }
    warn_if_close(n->part, n->part_overlap, n->part_normal, out); /* a pair on its own is close to nothing */
    name_in_whole(n, out);
}

static void iterate(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    start_from(n, overlap, nonlocal);
    if (n->settings.method != NLC_METHOD_FIXED_POINT) {
        by_parts(n, overlap, normal, out);
        return;
    }
    nlc_fixed_point(n, overlap, normal, out);
    if (out->status == NLC_WARNING_NOT_CONVERGED && out->info.sweeps < n->settings.max_sweeps &&
        !all_zero(nonlocal, n->contact_count)) {
        start_from(n, overlap, 0); /* it may have been a bad start */
        nlc_fixed_point(n, overlap, normal, out);
    }
    warn_if_close(n, overlap, normal, out);
}

/* Hertz. */
static void uncoupled(nlc_network *n, nlc_outcome *out)
{
    memset(n->current, 0, (size_t)n->contact_count * sizeof *n->current);
    out->info.lambda_lower = out->info.lambda_upper = 0;
    out->info.left_out = n->contact_count;
}

nlc_status nlc_solve(nlc_network *network, double *NLC_RESTRICT force, double *NLC_RESTRICT nonlocal,
                     const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info)
{
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    const int64_t count = network->contact_count;
    if (count == 0) return nlc_error(info, NLC_OK, -1);
    if (!force) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!nonlocal) return nlc_error(info, NLC_ERROR_NULL, 2);
    if (!overlap) return nlc_error(info, NLC_ERROR_NULL, 3);
    if (!normal) return nlc_error(info, NLC_ERROR_NULL, 4);
    nlc_outcome out = {NLC_OK, false, nlc_new_info()};
    out.status = check(network, overlap, normal, nonlocal, &out.info.culprit);
    if (out.status != NLC_OK) return nlc_error(info, out.status, out.info.culprit);

    if (network->settings.model->within)
        iterate(network, overlap, normal, nonlocal, &out);
    else
        uncoupled(network, &out);
    if (out.status < 0) return nlc_error(info, out.status, out.info.culprit);

    for (int64_t c = 0; c < count; c++) {
        nonlocal[c] = network->current[c];
        force[c] = nlc_law(network->stiffness[c], overlap[c] + nonlocal[c]);
        out.info.active += force[c] > 0;
    }
    return nlc_report(info, &out.info, out.status);
}
