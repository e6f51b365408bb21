/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * accuracy_chart.h - errors of models, all of them in a list; statistics and a chart of it.
 */
#ifndef NLC_BENCH_ACCURACY_CHART_H
#define NLC_BENCH_ACCURACY_CHART_H

#include <stdint.h>
#include <stdio.h>

#include "reference_table.h"

/* One force of one row by one model. */
typedef struct accuracy_point {
    int model, table, group; /* indices */
    double nu, eps;          /* eps of the first group, whatever the group */
    double error;            /* force / reference - 1 */
} accuracy_point;

typedef struct accuracy_model {
    int32_t number; /* NLC_MODEL_... */
    const char *name;
    double rms;                     /* of all errors at exact tables */
    double sweep_time, solve_time;  /* on a packing [ns a contact]; 0: not measured */
    int64_t sweeps;                 /* in that solve */
} accuracy_model;

typedef struct accuracy_results {
    const accuracy_model *model; /* [models] */
    int models;
    const reference_table *table; /* [tables] */
    int tables;
    accuracy_point *point; /* [count] */
    int count;
} accuracy_results;

/* A panel per table: the worst error over all nu against eps, both logarithmic; second group dashed.  See ferror(out); nothing is
 * written for want of memory. */
void accuracy_chart_write_svg(FILE *out, const accuracy_results *a);

/* rms against the time of a solve and, at the other end of a line, of a sweep, all logarithmic; packing: its name. */
void accuracy_chart_write_cost(FILE *out, const accuracy_results *a, const char *packing);

#endif
