/* SPDX-License-Identifier: BSD-2-Clause */
/* slabs.h - what is done with all contacts or particles, by as many threads as there are. */
#ifndef NLC_SLABS_H
#define NLC_SLABS_H

#include "parallel.h"

/* task(work, from, end) for all contacts, slab by slab; for all particles owned, window by window. */
typedef void (*nlc_range)(void *work, int64_t from, int64_t end);
void nlc_for_contacts(const nlc_network *network, nlc_range task, void *work);
void nlc_for_particles(const nlc_network *network, nlc_range task, void *work);

/* Displacements of contacts from those of their sides. */
void nlc_add_sides(const nlc_network *network, double *displacement);

/* These overwrite network->piece. */

/* Largest |value| of one per contact; infinity or a NaN if there is one. */
double nlc_top(const nlc_network *network, const double *values);

/* The first contact without a unit normal, or -1. */
int64_t nlc_first_bad_normal(const nlc_network *network, const double *normal);

#endif
