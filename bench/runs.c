/* SPDX-License-Identifier: BSD-2-Clause */
/* runs.c - times of calls. */
#include "runs.h"

#include <string.h>

#include "timing.h"

/* ns of one call, from repeat of them. */
static double time_calls(const timed_call *c)
{
    const double start = timing_processor_seconds();
    for (int64_t k = 0; k < c->repeat; k++) c->call(c->context);
    return 1e9 * (timing_processor_seconds() - start) / (double)c->repeat;
}

/* Doubled until a run lasts long enough; warms the caches, too. */
static void choose_repeat(timed_call *c, double run_time)
{
    const double start = timing_processor_seconds();
    c->repeat = 1;
    c->status = c->call(c->context);
    if (c->status < 0) fprintf(stderr, "%s is not measured: %s\n", c->key, nlc_strerror(c->status));
    if (c->status < 0 || timing_processor_seconds() - start > 10 * run_time) return;
    while (time_calls(c) * (double)c->repeat < 1e9 * run_time && c->repeat < INT32_MAX) c->repeat *= 2;
}

void runs_measure(timed_call *calls, int count, const runs_plan *plan)
{
    timing_progress progress;
    timing_progress_begin(&progress, "runs done");
    for (int k = 0; k < count; k++) choose_repeat(&calls[k], plan->run_time);
    for (int r = 0; r < plan->runs; r++) {
        timing_progress_update(&progress, r, plan->runs);
        for (int k = 0; k < count; k++)
            if (calls[k].status >= 0) calls[k].sample[r] = time_calls(&calls[k]) / calls[k].count;
    }
    timing_progress_end(&progress);
}

void runs_write_row(FILE *csv, const char *name, int64_t particles, int64_t contacts, const char *key, const char *unit,
                    double *sample, int count)
{
    const timing_spread s = timing_spread_of(sample, count);
    fprintf(csv, "%s,%lld,%lld,%s,%s,%d,%.6g,%.6g,%.6g,%.6g", name, (long long)particles, (long long)contacts, key, unit,
            s.count, s.minimum, s.lower_quartile, s.median, s.upper_quartile);
}

void runs_print_head(FILE *out)
{
    fprintf(out, "  %-42s%10s%11s%11s%11s%11s\n", "ns", "per", "median", "minimum", "quartile 1", "quartile 3");
}

void runs_print(FILE *out, FILE *csv, const char *name, int64_t particles, int64_t contacts, timed_call *calls, int count,
                const runs_plan *plan)
{
    for (int k = 0; k < count; k++) {
        timed_call *c = &calls[k];
        if (c->status < 0) continue;
        const timing_spread s = timing_spread_of(c->sample, plan->runs);
        fprintf(out, "  %-42s%10s%11.2f%11.2f%11.2f%11.2f\n", c->key, c->per, s.median, s.minimum, s.lower_quartile,
                s.upper_quartile);
        if (!csv) continue;
        char unit[RUNS_KEY];
        snprintf(unit, sizeof unit, strcmp(c->per, "contact") == 0 ? "ns" : "ns/%s", c->per);
        runs_write_row(csv, name, particles, contacts, c->key, unit, c->sample, plan->runs);
        fputc('\n', csv);
    }
}
