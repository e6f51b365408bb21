/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * compression.h - a slow compression of a packing, step by step, and how wrong forces are.
 *
 * In step 0 ... steps the overlaps grow to those of the packing, which are reached in the last one.  A third of the contacts each
 * moves at 1/2, 2/3 and 5/6 of COMPRESSION_STEP times the largest overlap a step.
 */
#ifndef NLC_BENCH_COMPRESSION_H
#define NLC_BENCH_COMPRESSION_H

#include <stddef.h>
#include <stdint.h>

#include "neighbours.h"
#include "nlcontact.h"
#include "packing_io.h"

#define COMPRESSION_STEP 1e-4

typedef struct compression {
    packing p;
    neighbours n;
    nlc_particles particles;
    int steps;         /* to be set before the first step is asked for */
    double largest;    /* overlap of the packing [m] */
    double *stiffness; /* [contacts] n_H */
    double *overlap;   /* [contacts] of the step */
    double *scale;     /* [bodies] work space */
    nlc_network *network;
    void *memory;
    size_t memory_size;
} compression;

/*
 * compression_open - the packing, its neighbours up to NEIGHBOURS_REACH, and a network with the default options.
 *
 * name    see packing_open
 * error   [error_size] out, on failure
 * Returns 0, or -1 on failure.  To be freed in any case.
 */
int compression_open(compression *s, const char *name, char *error, size_t error_size);
void compression_free(compression *s);

/* Sets the overlaps. */
void compression_set_step(compression *s, int step);

/* [GC] 10: forces from nonlocal displacements g. */
void compression_forces(const compression *s, double *force, const double *g);

/* |force - exact| relative to the largest force on either of the contact's two particles; walls have none of their own. */
typedef struct force_error {
    double largest, mean_square; /* over all contacts; over those with an exact force */
} force_error;

force_error compression_error(compression *s, const double *force, const double *exact);

#endif
