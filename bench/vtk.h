/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * vtk.h - contacts as lines for ParaView and other readers of the legacy VTK format.
 */
#ifndef NLC_BENCH_VTK_H
#define NLC_BENCH_VTK_H

#include "picture.h"

/*
 * vtk_write - polygonal data, ASCII.
 *
 * Points: the centres, in the box and in the order of the file; then for every line whose end is not a centre that end: the
 * foot on a wall, or the centre of a periodic image.  Point data: radius (0 at feet and images, so that a glyph of that size
 * shows each sphere once).  Lines: the contacts that overlap or have a force.  Cell data: force_hertz, force_nonlocal,
 * overlap, nonlocal_displacement (not without a nonlocal model: force_nonlocal and nonlocal_displacement).
 * The caller looks at ferror(out).
 */
void vtk_write(FILE *out, const picture_input *in);

#endif
