/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * collective.h - networks shared out among ranks: what is decided together, and how a failure becomes known.
 *
 * Every decision that changes which callback comes next is made from reduced numbers, so that all ranks make the same.  A rank
 * that fails (nlc_fail) goes on as if it had not until the next reduction, which tells all: from then on the network is over, and
 * these functions return false.  A rank whose reduction fails knows nothing but what comes next, since the callbacks come in turn,
 * always with the same counts; so it takes part in the next one to tell the others, who take part in one more for the sake of such
 * ranks when they hear of a failure.  What a phase of the solver has no use for is called all the same.
 *
 * All ranks end in the same call but where a reduction in which others hear of a failure, and the next one, too, fail on a rank: it
 * cannot know that they have left.  Any rule for leaving has a case of this kind, since who tells last is not told whether it was
 * heard; in this one two reductions have to fail in a row on one rank.
 *
 * In a network that is not shared all this does nothing, and says true.
 */
#ifndef NLC_COLLECTIVE_H
#define NLC_COLLECTIVE_H

#include "network.h"

#define NLC_SUMS 80  /* values in a reduction of either kind, the first of which says that a rank has failed */
#define NLC_MAXIMA 12

#define NLC_MOST 0x1p1020 /* what a sweep may come to (displace.c): two of them can be added */

static inline bool nlc_is_shared(const nlc_network *n)
{
    return n->settings.exchange != 0;
}

/* Whether a contact is on two ranks. */
static inline bool nlc_is_straddling(const nlc_network *n, int64_t c)
{
    return (n->i[c] >= n->owned && n->i[c] < n->particle_count) || (n->j[c] >= n->owned && n->j[c] < n->particle_count);
}

/* The side of a straddling contact that is owned elsewhere. */
static inline int64_t nlc_ghost_side(const nlc_network *n, int64_t c)
{
    return 2 * c + !(n->i[c] >= n->owned && n->i[c] < n->particle_count);
}

/* The contacts that are on two ranks: the first straddling elements of this list.  Sums over all contacts take half of each. */
static inline const int64_t *nlc_straddling(const nlc_network *n)
{
    return n->origin; /* networks that are shared are solved in one piece */
}

void nlc_list_straddling(nlc_network *network);

/* Whether the numbers of owned particles, ghosts and contacts go together. */
nlc_status nlc_check_ghosts(const nlc_settings *settings, int64_t particles, const int32_t *i, const int32_t *j, int64_t contacts,
                            int64_t *culprit);

/* The largest overlap on every body, of all its contacts. */
static inline double *nlc_shared_overlaps(const nlc_network *n)
{
    return n->part->largest;
}

/* Notes an error of this rank; the first one counts. */
void nlc_fail(nlc_network *network, nlc_status status, int64_t culprit);

/*
 * The beginning of a collective function, with what is wrong with this rank's arguments: false if there is an error anywhere or
 * the ranks differ in their options or in what they have called.  bodies (or NULL) as in nlc_exchange_particles, maxima as in
 * nlc_max_over_ranks.
 */
typedef enum nlc_function { NLC_SOLVE, NLC_SWEEP, NLC_ENERGY, NLC_TANGENT, NLC_TANGENT_INVERSE, NLC_TANGENT_BOUND } nlc_function;
bool nlc_meet(nlc_network *network, nlc_function function, nlc_status status, int64_t culprit, double *bodies, double *maxima,
              int count);

/* An error that all ranks have found: the end, too.  (One whose last reduction failed has to be waited for.) */
void nlc_give_up(nlc_network *network, nlc_status status);

/*
 * The end: adds up what outcome says of the contacts and particles of this rank, and counts the contacts with a force (or NULL).  False
 * if there was an error anywhere, which is then in *outcome; one that is there already all ranks have found.
 */
bool nlc_take_leave(nlc_network *network, const double *force, nlc_outcome *outcome);

/* Whether it is over; if so outcome says why. */
bool nlc_is_over(const nlc_network *network, nlc_outcome *outcome);

/* From the owners: values of the sides on ghosts; values [bodies] of ghosts. */
void nlc_exchange_sides(nlc_network *network, double *side);
void nlc_exchange_particles(nlc_network *network, double *value);

/* Values of ghosts, whatever others have sent, to where the owners' are known to be. */
void nlc_clamp_ghosts(const nlc_network *network, double *value, double least, double most);

/* a . b over the contacts of all ranks, from that over those of this one. */
double nlc_dot_over_ranks(nlc_network *network, double here, const double *a, const double *b);

/* Sums and maxima over all ranks, in place. */
bool nlc_sum_over_ranks(nlc_network *network, double *values, int count);
bool nlc_max_over_ranks(nlc_network *network, double *values, int count);

/* Whether it is so on any rank. */
bool nlc_on_any_rank(nlc_network *network, bool here);

/* The largest over all ranks, and where that is: -1 if it is not here. */
double nlc_largest_over_ranks(nlc_network *network, double here, int64_t *where);

#endif
