/* SPDX-License-Identifier: BSD-2-Clause */
/* steps.c - a slow compression: the error of the forces against what each step costs, for several ways to make the steps. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "neighbours.h"
#include "nlcontact.h"
#include "packing_io.h"
#include "timing.h"

#define STEP 1e-4 /* change of an overlap in a step at most, in units of the largest one */
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
    packing p;
    neighbours n;
    int steps;
    double largest, *stiffness;
    double *overlap, *g, *previous, *force, *w, *exact, *exact_g, *scale;
    nlc_network *network;
    void *memory;
} scene;

/* Overlaps of a step: the packing's in the last one; a third of the contacts each moves at 1/2, 2/3 and 5/6 of the speed. */
static void overlaps_of(scene *s, int step)
{
    for (int64_t c = 0; c < s->n.count; c++)
        s->overlap[c] = s->n.overlap[c] - STEP * s->largest * (s->steps - step) * (0.5 + (double)(c % 3) / 6);
}

static void forces_of(const scene *s, double *force, const double *g)
{
    for (int64_t c = 0; c < s->n.count; c++) force[c] = nlc_hertz_force(s->stiffness[c], s->overlap[c] + g[c]);
}

static nlc_status lagged(scene *s, int sweeps)
{
    forces_of(s, s->force, s->g);
    for (int k = 0; k < sweeps; k++) { /* the last sweep is for the forces of the next step */
        if (k > 0) forces_of(s, s->force, s->g);
        const nlc_status status = nlc_sweep(s->network, s->w, s->force, NULL, (const double *)s->n.normal, NULL);
        if (status < 0) return status;
        for (int64_t c = 0; c < s->n.count; c++) s->g[c] = s->w[2 * c] + s->w[2 * c + 1];
    }
    return NLC_OK;
}

/* One step; the guess is predicted from the last two, and what was solved for is kept for the next one. */
static nlc_status make_step(scene *s, const method *m, int step, int64_t *sweeps)
{
    nlc_info info = {.struct_size = sizeof info};
    nlc_status status = NLC_OK;
    if (m->predict && step > 1) status = nlc_predict(s->g, s->previous, s->n.count, 1, NULL);
    else memcpy(s->previous, s->g, (size_t)s->n.count * sizeof *s->g);
    if (status < 0) return status;
    if (m->tolerance > 0) {
        status = nlc_solve(s->network, s->force, s->g, s->overlap, (const double *)s->n.normal, &info);
        *sweeps += info.sweeps;
        return status;
    }
    *sweeps += m->sweeps;
    return lagged(s, m->sweeps);
}

static nlc_status use(scene *s, double tolerance, int sweeps)
{
    const nlc_options options = {.struct_size = sizeof options, .tolerance = tolerance, .max_sweeps = sweeps};
    return nlc_set_options(s->network, &options, NULL);
}

/* Largest error of a force relative to the largest one on either of its two bodies. */
static double error_of(scene *s, nlc_status *status)
{
    double worst = 0;
    *status = use(s, 1e-12, 0);
    if (*status >= 0)
        *status = nlc_solve(s->network, s->exact, s->exact_g, s->overlap, (const double *)s->n.normal, NULL);
    memset(s->scale, 0, (size_t)(s->p.count + s->p.wall_count) * sizeof *s->scale);
    for (int64_t c = 0; c < s->n.count; c++) {
        if (s->n.i[c] < s->p.count) s->scale[s->n.i[c]] = fmax(s->scale[s->n.i[c]], s->exact[c]);
        if (s->n.j[c] < s->p.count) s->scale[s->n.j[c]] = fmax(s->scale[s->n.j[c]], s->exact[c]);
    }
    for (int64_t c = 0; c < s->n.count; c++) {
        const double scale = fmax(s->scale[s->n.i[c]], s->scale[s->n.j[c]]);
        if (scale > 0) worst = fmax(worst, fabs(s->force[c] - s->exact[c]) / scale);
    }
    return worst;
}

/* All steps by one method, from the exact state. */
static nlc_status run(scene *s, const method *m)
{
    double seconds = 0, most = 0, sum = 0;
    int64_t sweeps = 0;
    nlc_status status = NLC_OK;
    for (int step = 0; step < s->steps; step++) {
        overlaps_of(s, step);
        if (step == 0) {
            memset(s->exact_g, 0, (size_t)s->n.count * sizeof *s->exact_g);
            error_of(s, &status);
            memcpy(s->g, s->exact_g, (size_t)s->n.count * sizeof *s->g);
        }
        if (status >= 0 && m->tolerance > 0) status = use(s, m->tolerance, m->sweeps);
        if (m->sweeps == 0 && m->tolerance <= 0) memset(s->g, 0, (size_t)s->n.count * sizeof *s->g);
        const double begin = timing_seconds();
        int64_t here = 0;
        if (status >= 0) status = make_step(s, m, step, &here);
        if (status < 0) break;
        const double took = timing_seconds() - begin;
        if (step < SETTLE) continue;
        const double error = error_of(s, &status);
        sweeps += here;
        seconds += took;
        sum += error;
        most = fmax(most, error);
    }
    const int counted = s->steps - SETTLE;
    if (status == NLC_ERROR_NONLOCAL || status == NLC_ERROR_RANGE || status == NLC_ERROR_FORCE || !(most < 10)) {
        printf("  %-40s%52s\n", m->label, "diverges");
        return NLC_OK;
    }
    if (status < 0) return status;
    printf("  %-40s%10.2f%14.1f%14.1e%12.1e\n", m->label, (double)sweeps / counted,
           seconds / counted * 1e9 / (double)s->n.count, sum / counted, most);
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
    if (packing_read(&s->p, path, true, error, sizeof error)) return fail(error);
    if (neighbours_find(&s->n, &s->p, 0.3, error, sizeof error)) return fail(error);
    s->steps = WORK > (double)STEPS * (double)s->n.count ? STEPS : (int)fmax(FEWEST, WORK / (double)s->n.count);
    const size_t contacts = (size_t)s->n.count + 1, bodies = (size_t)(s->p.count + s->p.wall_count) + 1;
    const nlc_particles particles = packing_particles(&s->p);
    const size_t size = nlc_network_size(&particles, s->n.count, NULL);
    double **array[] = {&s->stiffness, &s->overlap, &s->g, &s->previous, &s->force, &s->exact, &s->exact_g};
    bool there = (s->memory = malloc(size)) && (s->w = calloc(2 * contacts, sizeof(double)));
    there = there && (s->scale = calloc(bodies, sizeof(double)));
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) there = (*array[k] = calloc(contacts, sizeof(double))) && there;
    if (!there) return fail("no memory");
    const nlc_status status = nlc_network_init(&s->network, s->memory, size, &particles, s->n.i, s->n.j, s->n.count, NULL, NULL);
    if (status < 0) return fail(nlc_strerror(status));
    for (int64_t c = 0; c < s->n.count; c++) {
        const nlc_material a = s->p.materials[s->p.material[s->n.i[c]]];
        const bool wall = s->n.j[c] >= s->p.count;
        const nlc_material b = s->p.materials[wall ? s->p.wall_material[s->n.j[c] - s->p.count] : s->p.material[s->n.j[c]]];
        s->stiffness[c] = nlc_hertz_stiffness(a.young, a.poisson, s->p.radius[s->n.i[c]], b.young, b.poisson,
                                              wall ? INFINITY : s->p.radius[s->n.j[c]]);
        s->largest = fmax(s->largest, s->n.overlap[c]);
    }
    return 0;
}

static void release(scene *s)
{
    double *array[] = {s->stiffness, s->overlap, s->g, s->previous, s->force, s->exact, s->exact_g, s->w, s->scale};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) free(array[k]);
    free(s->memory);
    neighbours_free(&s->n);
    packing_free(&s->p);
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
               s.p.name, (long long)s.n.count, s.steps, STEP, "", "sweeps", "ns/contact", "mean error", "largest");
    for (int m = 0; m < METHODS && !status; m++)
        if (run(&s, &methods[m]) < 0) status = fail("a step failed");
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output cannot be written");
    release(&s);
    return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
