/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * grid.h - interpolation between Chebyshev's points.
 *
 * x_i = cos((2i+1) pi / 2p), i < p, and the polynomials L_i that are 1 at one of them and 0 at the others,
 *     L_i(x) = (1/p) [ 1 + 2 sum_{0<k<p} T_k(x_i) T_k(x) ]
 */
#ifndef NLC_GRID_H
#define NLC_GRID_H

#define NLC_GRID_FEWEST 4 /* points along a side */
#define NLC_GRID_MOST 18

typedef struct nlc_grid {
    int p;
    double x[NLC_GRID_MOST];
    double T[NLC_GRID_MOST][NLC_GRID_MOST]; /* [k][i] 2 T_k(x_i) / p, half of that for k = 0 */
} nlc_grid;

/* p points along a side */
void nlc_prepare_grid(nlc_grid *grid, int p);

/* L[p] at x, |x| <= 1 or slightly more. */
void nlc_interpolate(double *L, const nlc_grid *grid, double x);

#endif
