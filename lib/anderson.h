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
    nlc_network *n;
    int per_contact;        /* numbers in the vectors */
    bool met;               /* products of all ranks are at hand: */
    double A[NLC_COLUMNS][NLC_COLUMNS], s[NLC_COLUMNS], squares[NLC_COLUMNS]; /* of df, of df with r, of dx */
} nlc_anderson;

/* The columns lie in the memory of the network's directions: 10 of vectors with one number a contact, or 5 with two. */
void nlc_anderson_start(nlc_anderson *h, nlc_network *network, int per_contact, double *old_x, double *old_r, double most);

/*
 * Where the network is shared: all products of the next step, and norm, the sum of the squares of r here, of all ranks; to be called
 * in each step, before the others.
 */
void nlc_anderson_meet(nlc_anderson *h, const double *x, const double *r, double *norm);

/* Forgets what was. */
void nlc_anderson_reset(nlc_anderson *h, double step);

/*
 * A step from x, whose residual is r = F(x) - x, in two halves: x and r become those of the best combination of the last steps, and x
 * moves along r.  What is done to r in between makes the method better if it takes r closer to the error of x.
 */
void nlc_anderson_combine(nlc_anderson *h, double *x, double *r);
void nlc_anderson_move(nlc_anderson *h, double *x, const double *r);

/* Largest ratio of the lengths of a step and of the change of the residual by it: by how much a residual may be amplified. */
double nlc_anderson_amplification(const nlc_anderson *h);

#endif
