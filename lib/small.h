/* SPDX-License-Identifier: BSD-2-Clause */
/* small.h - the small symmetric problems of the solver: a few directions, one particle's block. */
#ifndef NLC_SMALL_H
#define NLC_SMALL_H

#include <stdbool.h>

/* Directions that the solver keeps: the residual, the last two steps, two Ritz vectors. */
#define NLC_DIRECTIONS 5
typedef double nlc_small[NLC_DIRECTIONS][NLC_DIRECTIONS];

/*
 * Ritz pairs K Y = M Y theta of the two n x n symmetric matrices, M positive semidefinite; directions that M hardly sees are
 * dropped.  Y[][r] belongs to theta[r].  Returns how many.
 */
int nlc_ritz(int n, nlc_small M, nlc_small K, nlc_small Y, double theta[NLC_DIRECTIONS]);

/* Whether beta 1 - B is positive definite; B symmetric n x n, its lower triangle is looked at and destroyed. */
bool nlc_is_below(double *B, int n, double beta);

/* Largest eigenvalue of the symmetric n x n matrix B, from above; B is destroyed, work has room for 4 n numbers. */
double nlc_largest_eigenvalue(double *B, int n, double *work);

/* The same of a tridiagonal matrix: diagonal a, beside it b. */
double nlc_largest_tridiagonal(const double *a, const double *b, int n);

#endif
