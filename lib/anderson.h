/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * anderson.h - Anderson's method for x = F(x): the next x is the best combination of the last ones.
 *
 * Its differences are formed in double and kept in single precision: they choose the step, the residual is computed anew.
 */
#ifndef NLC_ANDERSON_H
#define NLC_ANDERSON_H

#include "network.h"

#define NLC_COLUMNS 10

typedef struct nlc_anderson {
    int64_t length;         /* of the vectors */
    int columns, count, head;
    bool pending;           /* x and r of the step before are at hand */
    double *old_x, *old_r;  /* [length] */
    float *dx[NLC_COLUMNS], *df[NLC_COLUMNS];
    double smallest;        /* sum of squares of the smallest residual so far; for the caller */
    double step;            /* of the plain iteration, before there are differences */
    double most;            /* no component of x grows beyond */
} nlc_anderson;

/* The columns lie in the memory of the network's directions: 10 of vectors as long as there are contacts, or 5 twice as long. */
void nlc_anderson_start(nlc_anderson *h, nlc_network *network, int64_t length, double *old_x, double *old_r, double most);

/* Forgets what was. */
void nlc_anderson_reset(nlc_anderson *h, double step);

/* x from x and its residual r = F(x) - x. */
void nlc_anderson_step(nlc_anderson *h, double *x, const double *r);

/* Largest ratio of the lengths of a step and of the change of the residual by it: by how much a residual may be amplified. */
double nlc_anderson_amplification(const nlc_anderson *h);

#endif
