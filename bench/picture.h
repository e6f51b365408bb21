/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * picture.h - force chains as SVG.
 */
#ifndef NLC_BENCH_PICTURE_H
#define NLC_BENCH_PICTURE_H

#include <stdio.h>

#include "analysis.h"

typedef struct picture_input {
    const packing *p;
    const neighbours *n;
    const analysis *hertz;
    const analysis *nonlocal; /* NULL: Hertz alone */
} picture_input;

/*
 * picture_write_svg - projection on the x-z plane, Hertz on the left, the other model on the right.
 *
 * A line from centre to centre (to the foot on a wall) for every contact with a force, width and colour by force on one
 * scale for both sides.  A contact across a periodic boundary is drawn from both of its ends, clipped at the box.  A packing
 * of many spheres is shown as a slab around the middle of y, as thick as a few spheres; the picture says so.
 * The caller looks at ferror(out).
 */
void picture_write_svg(FILE *out, const picture_input *in);

#endif
