/* SPDX-License-Identifier: BSD-2-Clause */
/* steps.c - a slow compression: the error of the forces against what each step costs, for several ways to make the steps. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compression.h"
#include "nlcontact.h"
#include "timing.h"

enum { STEPS = 1000, FEWEST = 20, SETTLE = 3, EXIT_USAGE = 2 };
#define WORK 1e6 /* contacts times steps: fewer steps of large packings */

static const char usage[] =
    "usage: steps FILE\n"
    "\n"
    "1000 steps of compression (fewer of a large packing), in which overlaps change by up to 1e-4 of the largest\n"
    "one.  What a step costs and how wrong its forces are, for solves from the step before, with and without\n"
    "nlc_predict, and for what codes without a solver do: displacements by the forces of the step before.\n";

typedef struct method {
    const char *label;
    double tolerance; /* 0: no solve, but lagged sweeps */
    int sweeps;       /* so many, or in a solve at most; 0: no limit */
    bool predict;
} method;

static const method methods[] = {
    {"Hertz, no sweep", 0, 0, false},
    {"one lagged sweep", 0, 1, false},
    {"two lagged sweeps", 0, 2, false},
    {"one lagged sweep, predicted", 0, 1, true},
    {"nlc_solve, at most 2 sweeps", 1e-12, 2, false},
    {"nlc_solve, at most 2 sweeps, predicted", 1e-12, 2, true},
    {"nlc_solve to 1e-3", 1e-3, 0, false},
    {"nlc_solve to 1e-3, predicted", 1e-3, 0, true},
    {"nlc_solve to 1e-4", 1e-4, 0, false},
    {"nlc_solve to 1e-4, predicted", 1e-4, 0, true},
    {"nlc_solve to 1e-6", 1e-6, 0, false},
    {"nlc_solve to 1e-6, predicted", 1e-6, 0, true},
    {"nlc_solve to 1e-8", 1e-8, 0, false},
    {"nlc_solve to 1e-8, predicted", 1e-8, 0, true},
};
enum { METHODS = sizeof methods / sizeof methods[0] };

typedef struct scene {
    compression path;
    double *g, *previous, *force, *w, *exact, *exact_g;
} scene;

static const double *normals(const scene *s)
{
    return (const double *)s->path.n.normal;
}

static nlc_status lagged(scene *s, int sweeps)
{
    compression_forces(&s->path, s->force, s->g);
    for (int k = 0; k < sweeps; k++) { /* the last sweep is for the forces of the next step */
        if (k > 0) compression_forces(&s->path, s->force, s->g);
        const nlc_status status = nlc_sweep(s->path.network, s->w, s->force, NULL, normals(s), NULL);
        if (status < 0) return status;
        for (int64_t c = 0; c < s->path.n.count; c++) s->g[c] = s->w[2 * c] + s->w[2 * c + 1];
    }
    return NLC_OK;
}

/* One step; the guess is predicted from the last two, and what was solved for is kept for the next one. */
static nlc_status make_step(scene *s, const method *m, int step, int64_t *sweeps)
{
    nlc_info info = {.struct_size = sizeof info};
    nlc_status status = NLC_OK;
    if (m->predict && step > 1) status = nlc_predict(s->g, s->previous, s->path.n.count, 1, NULL);
    else memcpy(s->previous, s->g, (size_t)s->path.n.count * sizeof *s->g);
    if (status < 0) return status;
    if (m->tolerance > 0) {
        status = nlc_solve(s->path.network, s->force, s->g, s->path.overlap, normals(s), &info);
        *sweeps += info.sweeps;
        return status;
    }
    *sweeps += m->sweeps;
    return lagged(s, m->sweeps);
}

static nlc_status use(scene *s, double tolerance, int sweeps)
{
    const nlc_options options = {.struct_size = sizeof options, .tolerance = tolerance, .max_sweeps = sweeps};
    return nlc_set_options(s->path.network, &options, NULL);
}

static double error_of(scene *s, nlc_status *status)
{
    *status = use(s, 1e-12, 0);
    if (*status >= 0) *status = nlc_solve(s->path.network, s->exact, s->exact_g, s->path.overlap, normals(s), NULL);
    return compression_error(&s->path, s->force, s->exact).largest;
}

/* All steps by one method, from the exact state. */
static nlc_status run(scene *s, const method *m)
{
    double seconds = 0, most = 0, sum = 0;
    int64_t sweeps = 0;
    nlc_status status = NLC_OK;
    for (int step = 0; step < s->path.steps; step++) {
        compression_set_step(&s->path, step);
        if (step == 0) {
            memset(s->exact_g, 0, (size_t)s->path.n.count * sizeof *s->exact_g);
            error_of(s, &status);
            memcpy(s->g, s->exact_g, (size_t)s->path.n.count * sizeof *s->g);
        }
        if (status >= 0 && m->tolerance > 0) status = use(s, m->tolerance, m->sweeps);
        if (m->sweeps == 0 && m->tolerance <= 0) memset(s->g, 0, (size_t)s->path.n.count * sizeof *s->g);
        const double begin = timing_processor_seconds();
        int64_t here = 0;
        if (status >= 0) status = make_step(s, m, step, &here);
        if (status < 0) break;
        const double took = timing_processor_seconds() - begin;
        if (step < SETTLE) continue;
        const double error = error_of(s, &status);
        sweeps += here;
        seconds += took;
        sum += error;
        most = fmax(most, error);
    }
    const int counted = s->path.steps - SETTLE;
    if (status == NLC_ERROR_NONLOCAL || status == NLC_ERROR_RANGE || status == NLC_ERROR_FORCE || !(most < 10)) {
        printf("  %-40s%52s\n", m->label, "diverges");
        return NLC_OK;
    }
    if (status < 0) return status;
    printf("  %-40s%10.2f%14.1f%14.1e%12.1e\n", m->label, (double)sweeps / counted,
           seconds / counted * 1e9 / (double)s->path.n.count, sum / counted, most);
    return NLC_OK;
}

static int fail(const char *text)
{
    fprintf(stderr, "steps: %s\n", text);
    return -1;
}

static int prepare(scene *s, const char *path)
{
    char error[PACKING_ERROR_SIZE];
    if (compression_open(&s->path, path, error, sizeof error)) return fail(error);
    const double count = (double)s->path.n.count;
    s->path.steps = WORK > STEPS * count ? STEPS : (int)fmax(FEWEST, WORK / count);
    double **array[] = {&s->g, &s->previous, &s->force, &s->exact, &s->exact_g};
    bool there = (s->w = calloc(2 * (size_t)s->path.n.count, sizeof(double)));
    for (size_t k = 0; k < sizeof array / sizeof *array; k++)
        there = (*array[k] = calloc((size_t)s->path.n.count, sizeof(double))) && there;
    return there ? 0 : fail("no memory");
}

static void release(scene *s)
{
    double *array[] = {s->g, s->previous, s->force, s->exact, s->exact_g, s->w};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) free(array[k]);
    compression_free(&s->path);
}

int main(int argc, char **argv)
{
    static scene s;
    if (argc != 2 || argv[1][0] == '-') {
        fputs(usage, argc == 2 && strcmp(argv[1], "--help") == 0 ? stdout : stderr);
        return argc == 2 && strcmp(argv[1], "--help") == 0 ? EXIT_SUCCESS : EXIT_USAGE;
    }
    int status = prepare(&s, argv[1]);
    if (!status)
        printf("%s: %lld contacts and candidates, %d steps in which overlaps change by up to %g of the largest\n\n"
               "  %-40s%10s%14s%14s%12s\n",
               s.path.p.name, (long long)s.path.n.count, s.path.steps, COMPRESSION_STEP, "", "sweeps", "ns/contact", "mean error",
               "largest");
    for (int m = 0; m < METHODS && !status; m++)
        if (run(&s, &methods[m]) < 0) status = fail("a step failed");
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output cannot be written");
    release(&s);
    return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
