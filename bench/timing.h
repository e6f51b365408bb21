/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * timing.h - a clock, the spread of repeated measurements, and word to a user who waits.
 */
#ifndef NLC_BENCH_TIMING_H
#define NLC_BENCH_TIMING_H

#include <stdbool.h>
#include <stdint.h>

/* Seconds of a clock that never goes back.  Only differences mean something. */
double timing_seconds(void);

/* Seconds that the processor has worked for this thread: other programs lengthen them only by what they take of caches. */
double timing_processor_seconds(void);

/* Order statistics of a sample. */
typedef struct timing_spread {
    int count;
    double minimum, lower_quartile, median, upper_quartile;
} timing_spread;

/*
 * timing_spread_of - minimum, quartiles and median, by linear interpolation between neighbours.
 *
 * sample   [count] is sorted in place;  count > 0
 */
timing_spread timing_spread_of(double *sample, int count);

/* A line on stderr that says how far a long piece of work has come. */
typedef struct timing_progress {
    const char *what;
    double start, shown; /* seconds; shown: when it was last written, 0: never */
    bool terminal;
} timing_progress;

/*
 * Nothing is written in the first second.  After that a terminal gets one line, rewritten four times a second and wiped at
 * the end; a log file gets a line every ten seconds.
 *
 * what    kept, not copied
 * total   0: not known
 */
void timing_progress_begin(timing_progress *p, const char *what);
void timing_progress_update(timing_progress *p, int64_t done, int64_t total);
void timing_progress_end(timing_progress *p);

#endif
