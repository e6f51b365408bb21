/* SPDX-License-Identifier: BSD-2-Clause */
/* warm.h - what warm.c, look.c and norm_bound.c know of a start that may be the solution. */
#ifndef NLC_WARM_H
#define NLC_WARM_H

#include "iteration.h"

/* Displacements to start from, which are the caller's, in the caller's units, or those of the last sweep, in n->current. */
struct nlc_guess {
    const double *nonlocal;
    double unit;
};

static inline double nlc_guessed_overlap(const nlc_iteration *q, const nlc_guess *from, int64_t c)
{
    return q->overlap[c] * q->load + from->nonlocal[c] * from->unit;
}

#define NLC_CHUNK 64 /* contacts that are looked at together */

/* A look at the residuals. */
struct nlc_view {
    double ratio; /* largest |z| over the largest force nearby, or what the energy says (scales.c) */
    int64_t where;
    int64_t moving; /* contacts whose forces still change */
    bool grown;     /* an overlap is larger than its weight knows of */
    bool lost;      /* displacements beyond anything */
    double circle;  /* nlc_larger_circle of all, in the units at hand */
};

/* look.c: of the contacts of this rank, after a sweep of the forces of a start. */
nlc_view nlc_look(nlc_iteration *q, const nlc_guess *from);
/* The same of all ranks, and the bound of lambda. */
void nlc_look_over_ranks(nlc_network *network, nlc_view *r, nlc_info *info);

/* norm_bound.c: upper bound of lambda, at most beta, of this rank's particles; 1: it is not shown to be that small. */
double nlc_bound_by_norms(const nlc_iteration *q, double beta, nlc_info *info);

#endif
