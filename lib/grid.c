/* SPDX-License-Identifier: BSD-2-Clause */
/* grid.c - Chebyshev's points and polynomials. */
#include "grid.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

void nlc_prepare_grid(nlc_grid *g, int p)
{
    g->p = p;
    for (int i = 0; i < p; i++) {
        const double x = sin((p - 1 - 2 * i) * pi / (2 * p)); /* cos((2i+1) pi / 2p), opposite ones by the same bits */
        double before = 1, now = x;
        g->x[i] = x;
        g->T[0][i] = 1. / p;
        for (int k = 1; k < p; k++) {
            const double next = 2 * x * now - before;
            g->T[k][i] = 2. / p * now;
            before = now;
            now = next;
        }
    }
}

void nlc_interpolate(double *restrict L, const nlc_grid *restrict g, double x)
{
    double before = 1, now = x;
    for (int i = 0; i < g->p; i++) L[i] = g->T[0][i];
    for (int k = 1; k < g->p; k++) {
        const double next = 2 * x * now - before;
        for (int i = 0; i < g->p; i++) L[i] += g->T[k][i] * now;
        before = now;
        now = next;
    }
}
