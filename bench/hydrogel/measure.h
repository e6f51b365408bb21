/* SPDX-License-Identifier: BSD-2-Clause */
/* measure.h - what is recorded of a bed at a level of compression. */
#ifndef NLC_HYDROGEL_MEASURE_H
#define NLC_HYDROGEL_MEASURE_H

#include "bed.h"
#include "run.h"

/* All values and counts of a row, from the forces of the last step.  Bins are those of r. */
void measure(run_row *row, const bed *b, const run *r);

#endif
