/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * exact.h - the solution that is continuously connected to zero load, in long double, and where it ends.
 *
 * Newton's method along a growing load factor f (overlaps f gamma), every linear system by conjugate gradients on the
 * symmetric D^-1 - C; the largest eigenvalue of D^1/2 C D^1/2 by Lanczos.  Shares nothing with the library.
 */
#ifndef NLC_TESTS_EXACT_H
#define NLC_TESTS_EXACT_H

#include "scene.h"

typedef struct exact {
    int64_t contacts, terms;
    int64_t *c, *d;       /* [terms] displacement at c by the force of d */
    long double *w;       /* [terms] per unit force */
    long double *k;       /* [contacts] stiffness */
    long double *overlap; /* [contacts] at load factor 1 */
    long double *force;   /* [contacts] the solution at load */
    long double *slope;   /* [contacts] D there */
    long double load, lambda;
    rng random;
} exact;

void exact_init(exact *e, const scene *s);
void exact_free(exact *e);

/* Moves the solution to load factor f (from the present one, in steps).  False: none, the branch ends before. */
bool exact_move(exact *e, long double f);

/* Load factor at which the branch ends, to the relative precision asked for; INFINITY if it does not before f = limit. */
long double exact_end(const scene *s, long double limit, long double precision);

#endif
