/* SPDX-License-Identifier: BSD-2-Clause */
/* timing.c - clock, spread of measurements, progress line. */
#include "timing.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

double timing_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double timing_processor_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The value below which the fraction q of a sorted sample lies. */
static double quantile(const double *sample, int count, double q)
{
    double place = q * (count - 1);
    int k = (int)place;
    if (k + 1 >= count) return sample[count - 1];
    return sample[k] + (place - k) * (sample[k + 1] - sample[k]);
}

timing_spread timing_spread_of(double *sample, int count)
{
    qsort(sample, (size_t)count, sizeof sample[0], by_size);
    timing_spread s = {
        .count = count,
        .minimum = sample[0],
        .lower_quartile = quantile(sample, count, 0.25),
        .median = quantile(sample, count, 0.5),
        .upper_quartile = quantile(sample, count, 0.75),
    };
    return s;
}

void timing_progress_begin(timing_progress *p, const char *what)
{
    p->what = what;
    p->start = timing_seconds();
    p->shown = 0;
    p->terminal = isatty(STDERR_FILENO) != 0;
}

void timing_progress_update(timing_progress *p, int64_t done, int64_t total)
{
    double now = timing_seconds();
    double wait = p->terminal ? 0.25 : 10;
    if (now - p->start < 1 || (p->shown > 0 && now - p->shown < wait)) return;
    p->shown = now;
    if (p->terminal) fputs("\r\033[K", stderr);
    fprintf(stderr, "%s: %lld", p->what, (long long)done);
    if (total > 0) fprintf(stderr, " of %lld (%d %%)", (long long)total, (int)(100 * done / total));
    if (!p->terminal) fputc('\n', stderr);
    fflush(stderr);
}

void timing_progress_end(timing_progress *p)
{
    if (p->terminal && p->shown > 0) fputs("\r\033[K", stderr);
}
