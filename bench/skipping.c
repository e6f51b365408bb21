/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * skipping.c - what each thing that a solve may skip saves: run time and error with it, and with it switched off.
 *
 * The library has no such switches.  This program is linked with its own versions of the functions that decide (the linker's --wrap, see
 * the Makefile), which do what the library's do, or refuse.
 */
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/network.h"
#include "../lib/start.h"
#include "compression.h"
#include "runs.h"
#include "timing.h"

static const char usage[] =
    "usage: skipping [--csv FILE] PACKING...\n"
    "\n"
    "Scenes in which a solve can skip something, each solved with that and without: ns per contact, sweeps, and the largest error of a\n"
    "force.  PACKING: a file, or lattice:N (see bench/README).\n";

enum { RUNS = 21, EXIT_USAGE = 2, COLUMNS = 2 };
#define TOLERANCE 1e-6
#define TIME_IN_ALL 2.0 /* seconds of a row, after which no further run begins */

/* ---- the switches */

typedef enum skip { SKIP_HERTZ, SKIP_SWEEPS, SKIP_REST, SKIP_REGION, SKIPS } skip;

static bool off[SKIPS];

bool __real_nlc_is_loose(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out);
bool __wrap_nlc_is_loose(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out);
bool __wrap_nlc_is_loose(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    return !off[SKIP_HERTZ] && __real_nlc_is_loose(n, overlap, normal, out);
}

bool __real_nlc_is_solved(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out);
bool __wrap_nlc_is_solved(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out);
bool __wrap_nlc_is_solved(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    return !off[SKIP_SWEEPS] && __real_nlc_is_solved(n, overlap, normal, nonlocal, out);
}

void __real_nlc_settle_region(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out);
void __wrap_nlc_settle_region(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out);
void __wrap_nlc_settle_region(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    if (!off[SKIP_REGION]) __real_nlc_settle_region(n, overlap, normal, out);
}

void __real_nlc_solve_clusters(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out);
void __wrap_nlc_solve_clusters(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out);
void __wrap_nlc_solve_clusters(nlc_network *n, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *out)
{
    if (off[SKIP_REST]) nlc_galerkin(n, overlap, normal, out);
    else __real_nlc_solve_clusters(n, overlap, normal, nonlocal, out);
}

/* ---- scenes */

typedef struct scene {
    compression path;
    double *overlap, *start, *exact, *force, *g; /* [contacts] */
} scene;

typedef struct kind {
    const char *label, *key;
    skip skipped;
    bool warm;
    double (*overlap)(const scene *s, int64_t c, double before); /* before: of the state that the start is a solution of */
} kind;

/* Whether a contact is in a hundredth of the packing. */
static bool is_in_part(const scene *s, int64_t c)
{
    const packing *p = &s->path.p;
    double part = 1;
    for (int d = 0; d < 3; d++) {
        const double edge = p->high[d] - p->low[d], at = edge > 0 ? (p->x[s->path.n.i[c]][d] - p->low[d]) / edge : 0;
        part = part > 0 && at >= 0 && at * at * at < 0.01 ? part : 0;
    }
    return part > 0;
}

static double stiff(const scene *s, int64_t c, double before)
{
    (void)s;
    (void)c;
    return 1e-16 * before;
}

static double moved_a_little(const scene *s, int64_t c, double before)
{
    return before + 1e-8 * s->path.largest * (double)(c % 3);
}

static double pressed_in_part(const scene *s, int64_t c, double before)
{
    return is_in_part(s, c) ? before : -fabs(before);
}

static double moved_in_part(const scene *s, int64_t c, double before)
{
    return is_in_part(s, c) ? before * (1 + 1e-3) : before;
}

static const kind kinds[] = {
    {"grains 1e16 times as stiff: Hertz is proved to do", "Hertz", SKIP_HERTZ, false, stiff},
    {"a start that is good: one sweep proves it", "good start", SKIP_SWEEPS, true, moved_a_little},
    {"a hundredth pressed: gaps that stay open, clusters", "open gaps", SKIP_REST, false, pressed_in_part},
    {"a hundredth moved: only that is solved", "region", SKIP_REGION, true, moved_in_part},
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "skipping: %s%s%s\n", where, *where ? ": " : "", text);
    return -1;
}

static nlc_status set_tolerance(scene *s, double tolerance)
{
    const nlc_options o = {.struct_size = sizeof o, .tolerance = tolerance};
    return nlc_set_options(s->path.network, &o, NULL);
}

static nlc_status solve(scene *s, double *force, const double *start, const double *overlap, nlc_info *info)
{
    *info = (nlc_info){.struct_size = sizeof *info};
    memcpy(s->g, start, (size_t)s->path.n.count * sizeof *s->g);
    return nlc_solve(s->path.network, force, s->g, overlap, (const double *)s->path.n.normal, info);
}

/* Overlaps, the start and the exact forces; all is switched on. */
static nlc_status prepare(scene *s, const kind *k)
{
    nlc_info info;
    memset(off, 0, sizeof off);
    memset(s->start, 0, (size_t)s->path.n.count * sizeof *s->start);
    nlc_status status = set_tolerance(s, 1e-14);
    if (status >= 0 && k->warm) {
        status = solve(s, s->force, s->start, s->path.n.overlap, &info);
        memcpy(s->start, s->g, (size_t)s->path.n.count * sizeof *s->start);
    }
    for (int64_t c = 0; c < s->path.n.count; c++) s->overlap[c] = k->overlap(s, c, s->path.n.overlap[c]);
    if (status >= 0) status = solve(s, s->exact, s->start, s->overlap, &info);
    return status < 0 ? status : set_tolerance(s, TOLERANCE);
}

/* ---- measurements */

typedef struct column {
    double sample[RUNS], error;
    nlc_info info;
    nlc_status status;
    int runs;
} column;

static void measure(scene *s, const kind *k, column *with_and_without)
{
    const double begun = timing_processor_seconds();
    for (int r = 0; r < RUNS && (r < 3 || timing_processor_seconds() - begun < TIME_IN_ALL); r++)
        for (int side = 0; side < COLUMNS; side++) {
            column *c = &with_and_without[side];
            off[k->skipped] = side > 0;
            const double start = timing_processor_seconds();
            c->status = solve(s, s->force, s->start, s->overlap, &c->info);
            c->sample[c->runs++] = 1e9 * (timing_processor_seconds() - start) / (double)s->path.n.count;
            if (r == 0) c->error = compression_error(&s->path, s->force, s->exact).largest;
        }
    off[k->skipped] = false;
}

static void print(const scene *s, const kind *k, column *columns, FILE *csv)
{
    printf("%-52s", k->label);
    for (int side = 0; side < COLUMNS; side++) {
        column *c = &columns[side];
        printf("%10.4g%8lld%10.1e", timing_spread_of(c->sample, c->runs).median, (long long)c->info.sweeps, c->error);
        if (!csv) continue;
        char key[RUNS_KEY];
        snprintf(key, sizeof key, "%s %s", k->key, side ? "off" : "on");
        runs_write_row(csv, s->path.p.name, s->path.p.count, s->path.n.count, key, "ns", c->sample, c->runs);
        fprintf(csv, ",%lld,%.3g,%d\n", (long long)c->info.sweeps, c->error, (int)c->status);
    }
    putchar('\n');
}

static int open_scene(scene *s, const char *name)
{
    char error[PACKING_ERROR_SIZE];
    if (compression_open(&s->path, name, error, sizeof error)) return fail("", error);
    double **array[] = {&s->overlap, &s->start, &s->exact, &s->force, &s->g};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++)
        if (!(*array[k] = calloc((size_t)s->path.n.count + 1, sizeof **array))) return fail(name, "out of memory");
    return 0;
}

static int run(const char *name, FILE *csv)
{
    scene s;
    memset(&s, 0, sizeof s);
    int status = open_scene(&s, name);
    if (!status) {
        printf("%s: %lld contacts and candidates, tolerance %g\n\n%-52s%28s%28s\n%-52s", s.path.p.name, (long long)s.path.n.count, TOLERANCE,
               "", "skipped", "all done", "");
        for (int side = 0; side < COLUMNS; side++) printf("%10s%8s%10s", "ns", "sweeps", "error");
        putchar('\n');
    }
    for (int k = 0; k < KINDS && !status; k++) {
        column columns[COLUMNS];
        memset(columns, 0, sizeof columns);
        const nlc_status prepared = prepare(&s, &kinds[k]);
        if (prepared < 0) {
            status = fail(kinds[k].label, nlc_strerror(prepared));
            break;
        }
        measure(&s, &kinds[k], columns);
        print(&s, &kinds[k], columns, csv);
    }
    putchar('\n');
    double *array[] = {s.overlap, s.start, s.exact, s.force, s.g};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) free(array[k]);
    compression_free(&s.path);
    return status;
}

int main(int argc, char **argv)
{
    const char *csv_path = NULL;
    int k = 1, status = 0;
    if (k + 1 < argc && strcmp(argv[k], "--csv") == 0) {
        csv_path = argv[k + 1];
        k += 2;
    }
    if (k >= argc || argv[k][0] == '-') {
        const bool help = k < argc && strcmp(argv[k], "--help") == 0;
        fputs(usage, help ? stdout : stderr);
        return help ? EXIT_SUCCESS : EXIT_USAGE;
    }
    FILE *csv = csv_path ? fopen(csv_path, "w") : NULL;
    if (csv_path && !csv) {
        fail(csv_path, strerror(errno));
        return EXIT_FAILURE;
    }
    if (csv) fputs(RUNS_COLUMNS ",sweeps,error,status\n", csv);
    for (; k < argc; k++) status |= run(argv[k], csv);
    if (csv && (ferror(csv) | fclose(csv))) status = fail(csv_path, "cannot be written");
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output", "cannot be written");
    return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
