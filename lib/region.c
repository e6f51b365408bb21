/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * region.c - work only where something moves.
 *
 * One sweep from the displacements given shows where the forces change.  If that is a small part of the network, it is solved
 * for first, with a seam of neighbours and all other forces held.  That makes a start: the whole is solved for from there, and
 * has little to do.  A change fades by a factor of some 5 to 10 from one neighbour to the next, which decides on the seam.
 */
#include "active.h"
#include "iteration.h"
#include "structs.h"

#define FEWEST 256   /* contacts for which it is worth while */
#define QUIET 0.1    /* a force that changes by less than this part of the tolerance does not */
#define AS_GOOD 0.5  /* of the tolerance: the iteration may accept that at once, or needs no more than a step */
#define MOVING 0.1   /* of all contacts, at most */
#define REGION 0.4   /* likewise, the seam included */
#define FADING 6.0   /* from neighbour to neighbour */
#define LAYERS 12

/* Displacement at a contact after a sweep. */
static double swept(const nlc_network *n, int64_t c)
{
    return n->side[2 * c] + n->side[2 * c + 1];
}

/* What a sweep leaves of the forces. */
static void set_largest(nlc_network *n)
{
    for (int64_t k = 0; k < n->particle_count; k++) n->largest[k] = 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const int64_t i = n->i[c], j = n->j[c];
        const double p = n->force[c];
        if (i < n->particle_count && p > n->largest[i]) n->largest[i] = p;
        if (j < n->particle_count && p > n->largest[j]) n->largest[j] = p;
    }
}

/* Forces, and displacements by them. */
static bool sweep(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    int64_t culprit;
    nlc_set_units(n, 0, 0);
    for (int64_t c = 0; c < n->contact_count; c++) n->force[c] = nlc_law(n->stiffness[c], overlap[c] + n->current[c]);
    if (n->swept) {
        set_largest(n);
        return true;
    }
    out->info.sweeps++;
    n->swept = nlc_displace(n, NLC_OF_FORCES, n->force, normal, &culprit) == NLC_OK;
    return n->swept;
}

/* Marks those that change; the largest relative change.  A displacement beyond all solutions, which might overflow, is cut. */
static double find_changes(nlc_network *n, const double *overlap, int64_t *moving)
{
    const double farthest = NLC_FARTHEST * n->top.overlap;
    double most = 0;
    *moving = 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double a = n->largest[n->i[c]], b = n->largest[n->j[c]], scale = a > b ? a : b;
        const double y = overlap[c] + swept(n, c), change = fabs(nlc_law(n->stiffness[c], y < farthest ? y : farthest) - n->force[c]);
        const bool moves = change > QUIET * n->settings.tolerance * scale;
        n->mark[c] = moves ? NLC_NEW : NLC_OUT;
        *moving += moves;
        if (change > most * scale) most = scale > 0 ? nlc_ratio(change < scale ? change : scale, scale) : 1;
    }
    return most;
}

static bool is_beside(const nlc_network *n, int64_t c)
{
    return (n->i[c] < n->particle_count && n->changed[n->i[c]]) || (n->j[c] < n->particle_count && n->changed[n->j[c]]);
}

/* Marks so many layers of neighbours, lists all that are marked, and returns how many these are. */
static int64_t add_seam(nlc_network *n, int layers)
{
    int64_t count = 0;
    for (int64_t k = 0; k < n->particle_count; k++) n->changed[k] = 0;
    for (int layer = 0; layer < layers; layer++) {
        for (int64_t c = 0; c < n->contact_count; c++) {
            if (n->mark[c] == NLC_OUT) continue;
            if (n->i[c] < n->particle_count) n->changed[n->i[c]] = 1;
            if (n->j[c] < n->particle_count) n->changed[n->j[c]] = 1;
        }
        for (int64_t c = 0; c < n->contact_count; c++)
            if (is_beside(n, c)) n->mark[c] = NLC_IN;
    }
    for (int64_t c = 0; c < n->contact_count; c++)
        if (n->mark[c] != NLC_OUT) n->origin[count++] = c;
    return count;
}

/* The displacements that the region's own forces make; the rest of what there is counts as overlap. */
static bool hold_the_rest(nlc_network *n)
{
    nlc_network *p = n->part;
    int64_t culprit;
    for (int64_t m = 0; m < p->contact_count; m++) p->force[m] = n->force[n->origin[m]];
    nlc_set_units(p, 0, 0);
    if (nlc_displace(p, NLC_OF_FORCES, p->force, n->part_normal, &culprit) != NLC_OK) return false;
    for (int64_t m = 0; m < p->contact_count; m++) {
        p->current[m] = swept(p, m);
        n->part_overlap[m] += swept(n, n->origin[m]) - p->current[m];
    }
    return true;
}

/* Neighbours until a change has faded by this factor. */
static int layers_for(double factor)
{
    int layers = 1;
    for (double faded = FADING; faded < factor && layers < LAYERS; faded *= FADING) layers++;
    return layers;
}

void nlc_settle_region(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    int64_t moving, count;
    nlc_outcome part = {NLC_OK, nlc_new_info()};
    if (n->contact_count < FEWEST || !nlc_is_linear(n->settings.model->shape)) return;
    if (nlc_largest_magnitude(n->current, n->contact_count) <= 0) return; /* nothing is known yet */
    if (!sweep(n, overlap, normal, out)) return;
    const double change = find_changes(n, overlap, &moving);
    if (change <= AS_GOOD * n->settings.tolerance || (double)moving > MOVING * (double)n->contact_count) return;
    count = add_seam(n, layers_for(nlc_ratio(change, QUIET * n->settings.tolerance)));
    if ((double)count > REGION * (double)n->contact_count) return;
    nlc_build_part(n, n->origin, count, overlap, normal);
    n->part->settings.max_sweeps -= out->info.sweeps;
    if (n->part->settings.max_sweeps <= 0) return;
    n->swept = false; /* what the part finds is written where the sweep was */
    if (!hold_the_rest(n)) return;
    nlc_galerkin(n->part, n->part_overlap, n->part_normal, &part);
    out->info.blocks += part.info.blocks;
    if (part.status < 0) return;
    out->info.settled = count;
    for (int64_t c = 0; c < n->contact_count; c++) n->current[c] = swept(n, c);
    for (int64_t m = 0; m < count; m++) {
        const int64_t c = n->origin[m];
        n->current[c] = n->part_overlap[m] - overlap[c] + n->part->current[m];
    }
}
