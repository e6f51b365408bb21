/* SPDX-License-Identifier: BSD-2-Clause */
/* assemble.h - what contacts do to bodies, added to the caller's arrays. */
#ifndef NLC_ASSEMBLE_H
#define NLC_ASSEMBLE_H

#include <stddef.h>
#include <string.h>

#include "network.h"

/* A caller's array of vectors, at any address. */
typedef struct nlc_vectors {
    char *at;
    ptrdiff_t stride;
    int64_t count;
} nlc_vectors;

/* The forces on all bodies.  Walls come behind the particles, and may not be wanted: then there are none. */
typedef struct nlc_body_forces {
    nlc_vectors particles, walls;
} nlc_body_forces;

/* A stride of 0 stands for a packed array.  False: shorter than an element, or beyond what can be addressed. */
bool nlc_read_stride(ptrdiff_t *stride, int64_t count);

nlc_body_forces nlc_forces_on(const nlc_network *network, double *F, ptrdiff_t F_stride, double *F_wall);

/* Index of the first vector that is not finite, or -1; *largest is raised to the largest magnitude of a component. */
int64_t nlc_first_vector_not_finite(nlc_vectors v, double *largest);

/* Checks of values, in order: force, normal, F; *largest is that of F. */
nlc_status nlc_check_assembly(const nlc_network *network, const nlc_body_forces *F, const double *force, const double *normal,
                              double *largest, int64_t *culprit);

/* Whether no sum can overflow: of numbers up to largest and for each side one below 2^exponent, times a vector of unit length. */
bool nlc_sums_in_range(const nlc_network *network, double largest, int exponent);

static inline void nlc_add_vector(nlc_vectors v, int64_t k, double factor, const double *n)
{
    double f[3];
    memcpy(f, v.at + k * v.stride, sizeof f);
    for (int x = 0; x < 3; x++) f[x] += factor * n[x];
    memcpy(v.at + k * v.stride, f, sizeof f);
}

static inline void nlc_add_to_body(const nlc_body_forces *F, int64_t body, double factor, const double *n)
{
    if (body < F->particles.count)
        nlc_add_vector(F->particles, body, factor, n);
    else if (F->walls.count > 0)
        nlc_add_vector(F->walls, body - F->particles.count, factor, n);
}

/* The force -factor n on a contact's i, and the opposite on its j; on one particle they cancel. */
static inline void nlc_add_pair(const nlc_network *network, const nlc_body_forces *F, int64_t c, double factor, const double *n)
{
    const int64_t i = network->i[c], j = network->j[c];
    if (i == j) return;
    nlc_add_to_body(F, i, -factor, n);
    nlc_add_to_body(F, j, factor, n);
}

#endif
