/* SPDX-License-Identifier: BSD-2-Clause */
/* slabs.h - what is asked of all contacts, by as many threads as there are; network->piece is overwritten. */
#ifndef NLC_SLABS_H
#define NLC_SLABS_H

#include "parallel.h"

/* Largest |value| of one per contact; infinity or a NaN if there is one. */
double nlc_top(const nlc_network *network, const double *values);

/* The first contact without a unit normal, or -1. */
int64_t nlc_first_bad_normal(const nlc_network *network, const double *normal);

#endif
