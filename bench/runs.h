/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * runs.h - times of calls: many runs in which every call is timed once, one after the other, so that all meet the same
 * conditions; and the CSV that bench/compare reads.
 */
#ifndef NLC_BENCH_RUNS_H
#define NLC_BENCH_RUNS_H

#include <stdint.h>
#include <stdio.h>

#include "nlcontact.h"

enum { RUNS_MAX = 101, RUNS_KEY = 64 };

typedef struct timed_call {
    char key[RUNS_KEY]; /* what is measured, without commas */
    const char *per;    /* of what, in the singular: "contact", "call" */
    double count;       /* how many of them a call does */
    nlc_status (*call)(void *context);
    void *context;
    int64_t repeat;          /* calls in a run */
    nlc_status status;       /* of the first call; < 0: not measured */
    double sample[RUNS_MAX]; /* ns per one of them */
} timed_call;

typedef struct runs_plan {
    int runs;        /* 1 ... RUNS_MAX */
    double run_time; /* seconds that a run of one call lasts at least, so that the clock's grain does not matter */
} runs_plan;

/* What a call costs.  Calls that fail are left out, with a message on stderr. */
void runs_measure(timed_call *calls, int count, const runs_plan *plan);

/* Rows of a table; csv may be NULL.  Samples are sorted.  name ... contacts: of the packing; "-", 0 and 0 without one. */
void runs_print_head(FILE *out);
void runs_print(FILE *out, FILE *csv, const char *name, int64_t particles, int64_t contacts, timed_call *calls, int count,
                const runs_plan *plan);

/* The columns of the CSV, and a row of times in ns without the end of its line.  unit: "ns" per contact, "ns/call", ... */
#define RUNS_COLUMNS "packing,particles,contacts,measurement,unit,runs,minimum,lower_quartile,median,upper_quartile"
void runs_write_row(FILE *csv, const char *name, int64_t particles, int64_t contacts, const char *key, const char *unit,
                    double *sample, int count);

#endif
