/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * neighbours.h - who touches whom in a packing, and who nearly does.
 */
#ifndef NLC_BENCH_NEIGHBOURS_H
#define NLC_BENCH_NEIGHBOURS_H

#include <stddef.h>
#include <stdint.h>

#include "packing_io.h"

#define NEIGHBOURS_REACH 0.3 /* a gap that the displacements of a packing rarely close */
#define NEIGHBOURS_REACH_MAX 2.0

/* Contacts and candidates in the form that the library takes.  Pairs of particles come first, contacts with walls last. */
typedef struct neighbours {
    int64_t count;       /* all */
    int64_t pair_count;  /* of particles */
    int32_t *i, *j;      /* [count] j >= i is a particle, or count of particles + wall; i = j: the particle's own image */
    double *overlap;     /* [count] R_i + R_j - distance, or R - distance from the wall; < 0: a gap [m] */
    double (*normal)[3]; /* [count] unit, from i to j, into the wall */
} neighbours;

/*
 * neighbours_find - every pair with a gap below reach (R_i + R_j) / 2, every wall with a gap below reach R.
 *
 * In a periodic box every image within reach is a contact of its own; of the two mirror images of a particle's contact with
 * itself, one.  The time is linear in the number of particles (radii may differ by any factor); the order is by i, and the
 * same every time.
 *
 * list     out; to be freed with neighbours_free, also after an error
 * p        the packing
 * reach    from 0 to NEIGHBOURS_REACH_MAX
 * error    [error_size] out, on failure
 * Returns 0; -1 if there is no memory, if two centres coincide or nearly, if a centre is behind a wall, or if a periodic box
 * is much smaller than a particle.
 */
int neighbours_find(neighbours *list, const packing *p, double reach, char *error, size_t error_size);

void neighbours_free(neighbours *list);

/* neighbours_stiffness - Hertz' stiffness of each of them [N/m^1.5]. */
void neighbours_stiffness(const neighbours *list, const packing *p, double *stiffness);

/* The vector from i's centre to that of j's image, or to the foot on the wall [m]. */
void neighbours_branch(const neighbours *list, const packing *p, int64_t contact, double b[3]);

#endif
