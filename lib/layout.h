/* SPDX-License-Identifier: BSD-2-Clause */
/* layout.h - the arrays of a network in the caller's memory, by who needs them. */
#ifndef NLC_LAYOUT_H
#define NLC_LAYOUT_H

#include "network.h"

enum {
    NLC_ALWAYS = 1,       /* sweeps, [GC] Algorithm 1, nlc_energy, nlc_tangent_inverse, nlc_order */
    NLC_FOR_TREES = 2,    /* crowds, where there is a coupling */
    NLC_FOR_CIRCLES = 4,  /* models that look at their size */
    NLC_FOR_PLACES = 8,   /* contact points; what a contact does to itself */
    NLC_FOR_RANKS = 16,   /* networks shared out */
    NLC_FOR_SOLVER = 32,  /* the default method, nlc_tangent, nlc_tangent_bound */
    NLC_ALL_ARRAYS = 63
};

/* Sets the pointers of a network whose counts are set, at memory, or just measures where that is NULL.  The size, 0 if it overflows. */
size_t nlc_lay_out(nlc_network *network, char *memory, int arrays);

/* What options need; those that are wrong as little as any. */
int nlc_arrays_for(const nlc_options *options);

/* What a network with these options gets in network->memory_size bytes: all if there is room.  Else culprit: the size for what they need. */
nlc_status nlc_choose_arrays(const nlc_network *network, const nlc_options *options, int *arrays, int64_t *culprit);

/* NLC_ERROR_MEMORY_SIZE, and the size that is needed, where there are no arrays for the solver. */
nlc_status nlc_check_solver(const nlc_network *network, int64_t *culprit);

#endif
