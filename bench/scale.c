/* SPDX-License-Identifier: BSD-2-Clause */
/* scale.c - time and memory per contact from a thousand to ten million contacts. */
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "algorithm1.h"
#include "compression.h"
#include "runs.h"
#include "timing.h"

static const char usage[] =
    "usage: scale [--csv FILE] [LARGEST]\n"
    "\n"
    "ns per contact of what a time step needs, on packings made for it, in random order (lattice:N, see bench/README), as\n"
    "numbered by nlc_order (ordered:lattice:N) and in the order of space (sorted:N), from a thousand contacts to LARGEST\n"
    "(default: 1.1e6; 1.1e7 takes some minutes and 6 GB).\n";

/* Cells along an edge: half decades of contacts. */
static const int cells[] = {4, 5, 7, 11, 16, 24, 35, 51, 75};
enum { SIZES = sizeof cells / sizeof cells[0], SETTLE = 20, MOST_RUNS = 21, EXIT_USAGE = 2 };
#define RUN_TIME 5e-4 /* seconds that the calls of a run take at least */
#define WORK 1e6      /* contacts times runs */
#define TOLERANCE 1e-6

enum { INIT, ORDER, SWEEP, ALGORITHM1, ASSEMBLE, ZEROS, STEP, CALLS };
static const char *const orders[] = {"lattice", "ordered:lattice", "sorted"};

typedef struct scene {
    compression path;
    algorithm1 a;
    double *force, *g, *previous, *w, *F;
    int32_t *particle;
    int64_t *contact;
    timed_call calls[CALLS];
} scene;

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "scale: %s%s%s\n", where, *where ? ": " : "", text);
    return EXIT_FAILURE;
}

static const double *normals(const scene *s)
{
    return (const double *)s->path.n.normal;
}

/* ---- what is timed */

static nlc_status run_init(void *context)
{
    compression *c = &((scene *)context)->path;
    const nlc_options o = {.struct_size = sizeof o, .tolerance = TOLERANCE};
    return nlc_network_init(&c->network, c->memory, c->memory_size, &c->particles, c->n.i, c->n.j, c->n.count, &o, NULL);
}

static nlc_status run_order(void *context)
{
    scene *s = context;
    return nlc_order(s->path.network, s->particle, s->contact, NULL);
}

static nlc_status run_sweep(void *context)
{
    scene *s = context;
    return nlc_sweep(s->path.network, s->w, s->force, NULL, normals(s), NULL);
}

static nlc_status run_algorithm1(void *context)
{
    scene *s = context;
    algorithm1_sweep(&s->a, s->g, s->force);
    return NLC_OK;
}

static nlc_status run_assemble(void *context)
{
    scene *s = context;
    return nlc_assemble(s->path.network, s->F, 0, NULL, s->force, normals(s), NULL);
}

static nlc_status run_zeros(void *context)
{
    scene *s = context;
    memset(s->g, 0, (size_t)s->path.n.count * sizeof *s->g);
    return nlc_solve(s->path.network, s->force, s->g, s->path.n.overlap, normals(s), NULL);
}

/* Everything from overlaps and normals to the forces on particles. */
static nlc_status make_step(scene *s)
{
    nlc_status status = nlc_predict(s->g, s->previous, s->path.n.count, 1, NULL);
    if (status >= 0) status = nlc_solve(s->path.network, s->force, s->g, s->path.overlap, normals(s), NULL);
    return status < 0 ? status : run_assemble(s);
}

/* Steps follow each other, so that they are timed one by one. */
static void measure_steps(scene *s, int runs)
{
    timed_call *c = &s->calls[STEP];
    s->path.steps = SETTLE + runs - 1;
    for (int step = 0; step <= s->path.steps && c->status >= 0; step++) {
        compression_set_step(&s->path, step);
        if (step < 2) memcpy(s->previous, s->g, (size_t)s->path.n.count * sizeof *s->g);
        const double start = timing_processor_seconds();
        c->status = make_step(s);
        if (step >= SETTLE) c->sample[step - SETTLE] = 1e9 * (timing_processor_seconds() - start) / (double)s->path.n.count;
    }
}

static void measure(scene *s)
{
    static const struct {
        const char *key;
        nlc_status (*call)(void *);
    } calls[CALLS] = {{"nlc_network_init", run_init},       {"nlc_order", run_order},       {"nlc_sweep", run_sweep},
                      {"algorithm1_sweep", run_algorithm1}, {"nlc_assemble", run_assemble}, {"nlc_solve from zeros", run_zeros},
                      {"step predicted", NULL}};
    const double count = (double)s->path.n.count;
    const int runs = count * MOST_RUNS < WORK ? MOST_RUNS : count < WORK ? (int)(WORK / count) : 1;
    for (int k = 0; k < CALLS; k++) {
        s->calls[k] = (timed_call){.per = "contact", .count = count, .call = calls[k].call, .context = s};
        snprintf(s->calls[k].key, sizeof s->calls[k].key, "%s", calls[k].key);
    }
    runs_measure(s->calls, STEP, &(runs_plan){.runs = runs, .run_time = RUN_TIME});
    measure_steps(s, runs);
    for (int k = 0; k < CALLS; k++) s->calls[k].repeat = runs;
}

/* ---- a packing */

static int prepare(scene *s, const char *name)
{
    char error[PACKING_ERROR_SIZE];
    if (compression_open(&s->path, name, error, sizeof error)) return fail("", error);
    const size_t contacts = (size_t)s->path.n.count;
    s->force = calloc(contacts, sizeof(double));
    s->g = calloc(contacts, sizeof(double));
    s->previous = calloc(contacts, sizeof(double));
    s->w = calloc(contacts, 2 * sizeof(double));
    s->F = calloc((size_t)s->path.p.count, 3 * sizeof(double));
    s->particle = calloc((size_t)s->path.p.count, sizeof *s->particle);
    s->contact = calloc(contacts, sizeof *s->contact);
    const bool there = s->force && s->g && s->previous && s->w && s->F && s->particle && s->contact;
    if (algorithm1_init(&s->a, &s->path.p, &s->path.n) || !there)
        return fail(name, "out of memory");
    memcpy(s->path.overlap, s->path.n.overlap, contacts * sizeof(double));
    compression_forces(&s->path, s->force, s->g);
    return 0;
}

static void release(scene *s)
{
    void *array[] = {s->force, s->g, s->previous, s->w, s->F, s->particle, s->contact};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) free(array[k]);
    algorithm1_free(&s->a);
    compression_free(&s->path);
    memset(s, 0, sizeof *s);
}

/* Bytes per contact of a network. */
static void write_memory(const compression *c, FILE *csv, const char *what, double bytes)
{
    fprintf(csv, "%s,%lld,%lld,%s,bytes,1,%.4g,%.4g,%.4g,%.4g\n", c->p.name, (long long)c->p.count, (long long)c->n.count, what, bytes,
            bytes, bytes, bytes);
}

static void print(scene *s, FILE *csv, double seconds)
{
    static const nlc_options fixed_point = {.struct_size = sizeof fixed_point, .method = NLC_METHOD_FIXED_POINT};
    const compression *c = &s->path;
    const double contacts = (double)c->n.count;
    printf("%-20s%10lld", c->p.name, (long long)c->n.count);
    for (int k = 0; k < CALLS; k++) {
        timed_call *t = &s->calls[k];
        if (t->status < 0) {
            printf("%10s", "-");
            continue;
        }
        printf("%10.4g", timing_spread_of(t->sample, (int)t->repeat).median);
        if (!csv) continue;
        runs_write_row(csv, c->p.name, c->p.count, c->n.count, t->key, "ns", t->sample, (int)t->repeat);
        fputc('\n', csv);
    }
    const double memory = (double)c->memory_size / contacts;
    const double lean = (double)nlc_network_size(&c->particles, c->n.count, &fixed_point) / contacts;
    printf("%10.0f%10.0f%10.2f\n", memory, lean, seconds);
    if (csv) {
        write_memory(c, csv, "network memory", memory);
        write_memory(c, csv, "network memory fixed point", lean);
    }
    fflush(stdout);
}

static int run(double largest, FILE *csv)
{
    static scene s;
    printf("ns per contact; making a packing and all measurements in s\n\n%-20s%10s%10s%10s%10s%10s%10s%10s%10s%10s%10s%10s\n", "packing",
           "contacts", "init", "order", "sweep", "alg. 1", "assemble", "solve", "step", "bytes", "lean", "seconds");
    for (int k = 0; k < SIZES && 24.0 * cells[k] * cells[k] * cells[k] <= largest; k++)
        for (size_t order = 0; order < sizeof orders / sizeof *orders; order++) {
            char name[32];
            const double start = timing_seconds();
            snprintf(name, sizeof name, "%s:%d", orders[order], cells[k]);
            const int status = prepare(&s, name);
            if (!status) measure(&s);
            if (!status) print(&s, csv, timing_seconds() - start);
            release(&s);
            if (status) return status;
        }
    printf("\ninit: nlc_network_init; order: nlc_order; sweep: nlc_sweep; alg. 1: one sweep of Algorithm 1 as printed; solve:\n"
           "nlc_solve from zeros to %g; step: nlc_predict, nlc_solve to %g, nlc_assemble; bytes: of a network, per contact;\n"
           "lean: of one for NLC_METHOD_FIXED_POINT\n\n",
           TOLERANCE, TOLERANCE);
    return EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    const char *csv_path = NULL;
    double largest = 1.1e6;
    int k = 1;
    char *end = "";
    if (k + 1 < argc && strcmp(argv[k], "--csv") == 0) {
        csv_path = argv[k + 1];
        k += 2;
    }
    if (k < argc) largest = strtod(argv[k++], &end);
    if (k < argc || *end || !(largest > 0)) {
        const int help = argc == 2 && strcmp(argv[1], "--help") == 0;
        fputs(usage, help ? stdout : stderr);
        return help ? EXIT_SUCCESS : EXIT_USAGE;
    }
    FILE *csv = csv_path ? fopen(csv_path, "w") : NULL;
    if (csv_path && !csv) return fail(csv_path, strerror(errno));
    if (csv) fputs(RUNS_COLUMNS "\n", csv);
    int status = run(largest, csv);
    if (csv && (ferror(csv) | fclose(csv))) status = fail(csv_path, "cannot be written");
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output", "cannot be written");
    return status;
}
