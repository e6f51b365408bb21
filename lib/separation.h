/* SPDX-License-Identifier: BSD-2-Clause */
/* separation.h - how far two bodies are apart, and in which direction. */
#ifndef NLC_SEPARATION_H
#define NLC_SEPARATION_H

#include "cell.h"
#include "nlcontact.h"

/* The caller's structs, read and checked but for the particles themselves. */
typedef struct nlc_geometry {
    nlc_particles particles;
    nlc_positions positions;
    nlc_cell cell;
} nlc_geometry;

typedef struct nlc_separation {
    double overlap; /* infinite where a double cannot hold it */
    double normal[3];
} nlc_separation;

/* argument: the number of particles in the prototype; positions follow it. */
nlc_status nlc_read_geometry(nlc_geometry *geometry, const nlc_particles *particles, const nlc_positions *positions,
                             int64_t argument, int64_t *culprit);

/* Bodies i and j.  *culprit: a particle or wall; untouched where it is the pair. */
nlc_status nlc_separate(nlc_separation *separation, const nlc_geometry *geometry, int32_t i, int32_t j, int64_t *culprit);

#endif
