/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * bound.h - an upper bound of lambda, the largest eigenvalue of D^1/2 C D^1/2.
 *
 * C is a sum over particles, C = sum C_k.  Give each contact's two sides shares that add to 1, and let b_k be the largest
 * eigenvalue of particle k's own block with D divided by its shares.  Then C_k <= b_k diag(share) D^-1 for each k, and the sum
 * of these is C <= max b_k D^-1: lambda <= max b_k, for any shares.  Good shares make the b_k equal.
 */
#ifndef NLC_BOUND_H
#define NLC_BOUND_H

#include "network.h"

typedef struct nlc_bound {
    double upper;   /* largest b_k, or what was to be proved */
    int64_t where;  /* its particle */
    int64_t blocks; /* blocks whose coefficients were computed, each about as dear as a particle's part of a sweep */
} nlc_bound;

/*
 * Both look at network->slope (D, in the units of network->unit) and set network->share.
 * nlc_bound_below: whether all b_k <= beta, each by the cheapest test that decides.
 * nlc_bound_balance: moves the shares for at most so many passes, or until all b_k <= enough; leaves b_k, exact where above
 * NLC_BOUND_FLOOR, in network->bound.  What happens on a particle depends on those within passes + 1 neighbours of it.
 */
/* All b_k at the first shares, exact above NLC_BOUND_FLOOR and a bound, not below 0, else; balanced if one exceeds 1. */
void nlc_bound_particles(nlc_network *network, const double *normal, nlc_bound *result);

#define NLC_BOUND_FLOOR 0.7
bool nlc_bound_below(nlc_network *network, const double *normal, double beta, nlc_bound *result);
void nlc_bound_balance(nlc_network *network, const double *normal, int passes, double enough, nlc_bound *result);

#endif
