/* SPDX-License-Identifier: BSD-2-Clause */
/* crowd.h - displacements on a particle with very many contacts. */
#ifndef NLC_CROWD_H
#define NLC_CROWD_H

#include "network.h"

/* Whether it pays on a particle. */
bool nlc_is_crowd(const nlc_network *network, int64_t particle);

/*
 * nlc_displace_particle, but for network->largest.  *distinct: no two directions are the same.  False, with nothing done: not
 * on this particle.
 */
bool nlc_displace_crowd(nlc_network *network, nlc_response response, const double *force, const double *normal, int64_t particle,
                        bool *distinct);

#endif
