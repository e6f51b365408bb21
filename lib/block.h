/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * block.h - one particle's block of W^1/2 C W^1/2, W = D / share, over its contacts with D > 0.
 *
 * The two sides of a contact of a particle with itself are one row, with W = D: their shares add to 1.
 */
#ifndef NLC_BLOCK_H
#define NLC_BLOCK_H

#include "network.h"

/* No element counts as larger, as those of directions that nobody has found to be equal are: squares and ratios of it are in range. */
#define NLC_LARGEST_ELEMENT 1e100

/* A bound of its largest eigenvalue by the Frobenius norm: trace/m + [(m-1)/m (|B|^2 - trace^2/m)]^(1/2), Wolkowicz and Styan. */
double nlc_block_norm(const nlc_network *network, const double *normal, int64_t particle);

/* Whether its largest eigenvalue is at most beta. */
bool nlc_block_is_below(nlc_network *network, const double *normal, int64_t particle, double beta);

/*
 * Its largest eigenvalue, to rounding from above.  With more than NLC_BLOCK contacts it is estimated by Lanczos' method as
 * Ritz value plus residual, from a start that looks random: no proof, but it takes a conspiracy for it to be too small.  Uses
 * network->side there.
 */
double nlc_block_eigenvalue(nlc_network *network, const double *normal, int64_t particle);

/*
 * The block itself, both triangles, [rows][rows]; side [rows] is a side of each row's contact.  Returns how many rows there are: at
 * most NLC_BLOCK, -1 if that is too few.
 */
int nlc_block_matrix(double *B, int64_t *side, const nlc_network *network, const double *normal, int64_t particle);

#endif
