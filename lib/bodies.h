/* SPDX-License-Identifier: BSD-2-Clause */
/* bodies.h - what a network takes from the particles. */
#ifndef NLC_BODIES_H
#define NLC_BODIES_H

#include "network.h"

/*
 * All that can be wrong with particles, contacts and stiffnesses ([contacts], NULL: n_H) of a network with these settings and
 * counts.  Sets n->scale_exponent and *culprit and nothing else.
 */
nlc_status nlc_check_bodies(nlc_network *n, const nlc_settings *settings, const nlc_particles *p, const int32_t *i,
                            const int32_t *j, const double *stiffness, int64_t *culprit);

/* Radii, materials, U. */
void nlc_set_bodies(nlc_network *n, const nlc_particles *p);

#endif
