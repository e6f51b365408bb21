/* SPDX-License-Identifier: BSD-2-Clause */
/* packing_out.h - a bed as a packing, in the format of bench/README. */
#ifndef NLC_FIGURES_PACKING_OUT_H
#define NLC_FIGURES_PACKING_OUT_H

#include <stdio.h>

#include "bed.h"

/* See ferror(out).  All digits: read again, it is the same bed. */
void packing_write(FILE *out, const bed *b, const char *name);

#endif
