/* SPDX-License-Identifier: BSD-2-Clause */
/* cell.h - the periodic cell of a host: the nearest image. */
#ifndef NLC_CELL_H
#define NLC_CELL_H

#include "number.h"

typedef struct nlc_cell {
    bool periodic[3], any;
    double vector[3][3];     /* the caller's */
    double largest;          /* of their components */
    double reciprocal[3][3]; /* its dot product with a vector, over the length, counts cells */
    nlc_scaled length[3];
    double width; /* the least one between opposite faces; infinity if beyond double */
} nlc_cell;

/* vectors: [3][3], or NULL.  False: not finite, or nearly in one plane. */
bool nlc_prepare_cell(nlc_cell *cell, const double *vectors);

/*
 * to - from = d 2^e less whole cells, to and from being multiplied by 2^-e: far from the ends of double's range.  False: it is
 * too many cells long to tell where it ends.
 */
bool nlc_wrap(double d[3], const double *to, const double *from, int e, const nlc_cell *cell);

#endif
