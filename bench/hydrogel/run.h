/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * run.h - a compression test level by level, simulated or measured: the top force and the distribution of the contact forces.
 * README describes the file.
 */
#ifndef NLC_HYDROGEL_RUN_H
#define NLC_HYDROGEL_RUN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { RUN_BINS = 200, RUN_ERROR_SIZE = 1024 };

typedef enum run_phase { RUN_LOAD, RUN_UNLOAD, RUN_PHASES } run_phase;

/* What is measured beside strain and counts, in the order of the file; NaN where a file does not have it. */
typedef enum run_value {
    RUN_TOP,        /* force on the plate [N] */
    RUN_MEAN_FORCE, /* of the contacts between grains [N] */
    RUN_BRANCH,     /* mean distance of the centres of grains that touch [m] */
    RUN_FRACTION,   /* volume fraction of the grains, one diameter away from walls */
    RUN_SATURATED,  /* friction / (mu times the normal force), mean weighted with the normal force */
    RUN_UNBALANCED, /* mean resultant on a grain / mean force */
    RUN_VALUES
} run_value;
extern const char *const run_value_name[RUN_VALUES];
extern const char *const run_phase_name[RUN_PHASES];

typedef struct run_row {
    int cycle; /* from 1; 0: not said */
    run_phase phase;
    double strain, value[RUN_VALUES];
    double count[RUN_BINS]; /* contacts between grains with a force in each bin */
} run_row;

typedef struct run {
    double grains;
    int bins;
    double edge[RUN_BINS + 1]; /* bin k holds edge[k] < force <= edge[k + 1]; edge[0] is 0 [N] */
    int rows;
    run_row *row;
} run;

/* Ten bins a decade from 0.1 mN to 10 N, one for what is below. */
void run_init(run *r, double grains);
bool run_add(run *r, const run_row *row); /* false: out of memory */
void run_free(run *r);

/* See ferror(out).  comment: a line for the head, or NULL. */
void run_write(FILE *out, const run *r, const char *comment);

/* Returns 0, or -1 and error, "file:line: reason".  To be freed in both cases. */
int run_read(run *r, const char *path, char *error, size_t error_size);

/* Bin of a force, -1 if it is beyond all. */
int run_bin(const run *r, double force);

/*
 * run_mean - rows of the same phase and strain become one, their mean; loading first, then by strain.
 *
 * first   cycles before this one are left out; rows without a cycle stay
 * Returns false if there is no memory or nothing is left.
 */
bool run_mean(run *mean, const run *r, int first);

/*
 * run_at - a row of a mean run between two levels, linear in strain.
 * Returns false where the phase has none on one of the sides.
 */
bool run_at(run_row *row, const run *mean, run_phase phase, double strain);

/* Contacts between grains per grain, with a force above the threshold; linear within a bin. */
double run_coordination(const run *r, const run_row *row, double threshold);

#endif
