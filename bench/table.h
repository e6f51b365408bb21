/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * table.h - the results of several models side by side, for people or for programs.
 */
#ifndef NLC_BENCH_TABLE_H
#define NLC_BENCH_TABLE_H

#include <stdbool.h>
#include <stdio.h>

#include "analysis.h"

typedef struct table_input {
    const packing *p;
    const neighbours *n;
    double reach;
    const analysis *results; /* [count] the first is Hertz */
    int count;               /* >= 1 */
} table_input;

/* csv: one line per quantity, SI units, all digits.  Otherwise 100 columns wide for three models, units chosen to be read. */
void table_print(FILE *out, const table_input *in, bool csv);

/* The prefix (0.001 as "m") with which a value reads best. */
double table_prefix(double value, const char **prefix);

#endif
