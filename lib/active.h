/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * active.h - the part of a network that a solution has to be found for.
 *
 * A contact without force moves nothing.  So the equations are solved for the contacts that may have one, and for each cluster of
 * them that is connected as a network of its own: what happens in one cluster changes no bit in another.  Then the other contacts
 * are looked at once: if none of them has come to touch, the solution is that of the whole.  If some have, they join, and it is
 * solved again.  Nothing is assumed, and nothing is kept between calls.
 */
#ifndef NLC_ACTIVE_H
#define NLC_ACTIVE_H

#include "network.h"

enum {
    NLC_OUT = 0,
    NLC_IN = 1,
    NLC_ALONE = 2, /* no other marked contact moves it: a Hertz contact */
    NLC_NEW = 3    /* in, since the last solution */
};

static inline bool nlc_is_in(const nlc_network *n, int64_t c)
{
    return n->mark[c] == NLC_IN || n->mark[c] == NLC_NEW;
}

/*
 * Marks the contacts that overlap with the displacements in n->current or are not far from it (see there), and returns how
 * many of them are not pairs on their own.
 * n->largest holds the largest overlap on each particle.
 */
int64_t nlc_mark_active(nlc_network *n, const double *overlap);

/* clusters.c: sets network->connected, if it has arrays for clusters. */
void nlc_set_connected(nlc_network *n);

/* n->origin becomes the contacts that are in, cluster by cluster; returns how many. */
int64_t nlc_sort_clusters(nlc_network *n);

/* Where in that list of count contacts the cluster that begins there ends. */
int64_t nlc_cluster_end(nlc_network *n, int64_t begin, int64_t count);

/*
 * region.c: a better start where the forces change in a small part of the network only.  Displacements, in and out, are in
 * n->current.
 */
void nlc_settle_region(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *outcome);

/* Contacts that are not in: their forces, of Hertz for pairs on their own, and no displacement. */
void nlc_set_rest(nlc_network *n, const double *overlap);

/* Builds n->part from a piece of the list, with overlaps, normals and displacements. */
void nlc_build_part(nlc_network *n, const int64_t *origin, int64_t count, const double *overlap, const double *normal);

/* Forces and displacements of the part into n->force and n->current, its weakening into n->weakening. */
void nlc_collect_part(nlc_network *n, const int64_t *origin);

/*
 * Displacements of the contacts without force into n->current; if some touch now, they and the candidates beside them that are near
 * an overlap are marked as new.
 * Returns how many touch; -1 if two contacts lie in the same direction, *culprit one of them.
 */
int64_t nlc_check_rest(nlc_network *n, const double *overlap, const double *normal, int64_t *culprit);

#endif
