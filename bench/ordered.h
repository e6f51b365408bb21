/* SPDX-License-Identifier: BSD-2-Clause */
/* ordered.h - a packing and its contacts in the numbers that nlc_order gives them. */
#ifndef NLC_BENCH_ORDERED_H
#define NLC_BENCH_ORDERED_H

#include "neighbours.h"
#include "packing_io.h"

/*
 * Spheres, pairs of them and contacts with walls are each put into the order; pairs still come first.  p's name gets "ordered:" in
 * front.  Returns NULL, or what is wrong; then p and n may be in any order, and are still to be freed.
 */
const char *ordered_renumber(packing *p, neighbours *n);

#endif
