/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * algorithm1.h - Algorithm 1 as it is printed, to compare the library with.
 *
 * M. Gonzalez, A. M. Cuitino, J. Mech. Phys. Solids 60 (2012) 333-350, section 2.3: a loop over the contacts, within it one
 * over the contacts incident to it, each adding the displacement of Eq. 5 with an angle from an arc cosine and its half's
 * sine.  One thing differs from the print: a sweep starts from zero displacements instead of those of the sweep before.
 * What depends on the particle alone is computed once, as anybody would.
 */
#ifndef NLC_BENCH_ALGORITHM1_H
#define NLC_BENCH_ALGORITHM1_H

#include <stdint.h>

#include "neighbours.h"
#include "packing_io.h"

/* Eq. 5 for one particle: w = constant P [ a + b s + c s^2 ] / s */
typedef struct algorithm1_particle {
    double constant; /* (1+nu) / (4 pi R E), 0 for a rigid particle */
    double a, b, c;
} algorithm1_particle;

typedef struct algorithm1 {
    int64_t particles;
    const neighbours *n;
    algorithm1_particle *particle; /* [particles] */
    int64_t *first;                /* [particles + 1] of incident */
    int64_t *incident;             /* contact * 2, + 1 if the particle is j of that contact */
} algorithm1;

/* Returns 0, or -1 if there is no memory.  To be freed in any case.  n is kept. */
int algorithm1_init(algorithm1 *a, const packing *p, const neighbours *n);
void algorithm1_free(algorithm1 *a);

/*
 * algorithm1_sweep - lines 7 to 17, with forces (line 10) given.
 *
 * nonlocal   [contacts] out [m];  force   [contacts] >= 0 [N]
 */
void algorithm1_sweep(const algorithm1 *a, double *nonlocal, const double *force);

#endif
