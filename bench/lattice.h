/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * lattice.h - dense packings of any size, made instead of read.
 *
 * A periodic face-centred cubic crystal of 4 N^3 spheres out of order: radii differ by up to 3 %, centres are off their places
 * by up to 3 % of the mean radius along each axis.  The neighbours are exactly the crystal's twelve: 24 N^3 contacts and
 * candidates, about three in four of them overlapping, by 2 % of the mean diameter on average.  The same every time.
 */
#ifndef NLC_BENCH_LATTICE_H
#define NLC_BENCH_LATTICE_H

#include <stdbool.h>
#include <stddef.h>

#include "neighbours.h"
#include "packing_io.h"

/*
 * packing_open - a packing and its neighbours, from a file or made.
 *
 * p, n    out; to be freed with packing_free and neighbours_free, also after an error
 * name    of a file, see packing_read; or lattice:N, 3 <= N <= 500, with spheres and contacts in random order; or sorted:N, the
 *         same in the order of the places; with ordered: in front of any of them, in the numbers that nlc_order gives
 * reach   as for neighbours_find; lattices are the same from 0.15 to 0.6
 * error   [error_size] out, on failure
 * Returns 0, or -1 on failure.
 */
int packing_open(packing *p, neighbours *n, const char *name, double reach, char *error, size_t error_size);

#endif
