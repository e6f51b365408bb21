/* SPDX-License-Identifier: BSD-2-Clause */
/* solve_clusters.c - clusters of contacts one by one, until no other contact touches. */
#include "active.h"
#include "start.h"
#include "structs.h"

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
    for (int64_t m = 0; m < count && !joined; m++) n->current[origin[m]] = nlc_start_of(n, origin[m], overlap, nonlocal);
    nlc_build_part(n, origin, count, overlap, normal);
    n->part->settings.max_sweeps -= sweeps_before;
    n->settings.model->potential ? nlc_galerkin(n->part, n->part_overlap, n->part_normal, &part)
                                 : nlc_mixed(n->part, n->part_overlap, n->part_normal, &part);
    nlc_warn_if_close(n->part, n->part_overlap, n->part_normal, &part);
    if (part.status < 0) {
        out->status = part.status;
        out->info.culprit = named(part.info.culprit, origin);
        return;
    }
    merge(out, n, &part, origin);
    nlc_collect_part(n, origin);
}

/* Each cluster of contacts that may have a force, until it turns out that no other contact has. */
void nlc_solve_clusters(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
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
