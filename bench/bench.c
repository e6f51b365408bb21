/* SPDX-License-Identifier: BSD-2-Clause */
/* bench.c - times the library on a packing, and Algorithm 1 as printed beside it. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "algorithm1.h"
#include "lattice.h"
#include "neighbours.h"
#include "nlcontact.h"
#include "packing_io.h"
#include "timing.h"

enum { RUNS = 21, EXIT_USAGE = 2, LABEL_WIDTH = 44 };
#define RUN_TIME 2e-3 /* seconds that a run lasts at least, so that the clock's grain does not matter */

static const char usage[] =
    "usage: bench [--csv] FILE...\n"
    "\n"
    "Times the library's functions on packings, and one sweep of Algorithm 1 as printed beside nlc_sweep.\n"
    "In every run each function is timed once, one after the other, so that they meet the same conditions.\n"
    "FILE may be lattice:N or, as numbered by nlc_order, ordered:FILE, see bench/README.\n";

enum { COUPLED, HERTZ, FIXED_POINT, COARSE, NETWORKS };
#define COARSE_TOLERANCE 1e-3

/* A packing with all that the functions need. */
typedef struct bench {
    packing p;
    neighbours n;
    nlc_particles particles;
    void *memory[NETWORKS];
    size_t memory_size;
    nlc_network *coupled, *hertz, *fixed_point, *coarse;
    algorithm1 reference;
    double *force, *nonlocal; /* [contacts] the solution */
    double *work, *start;     /* [contacts] */
    double *loose, *known;    /* [contacts] overlaps with a small part compressed, and displacements that solve them */
    double *moved;            /* [contacts] overlaps that differ from the packing's in that part only, by 1e-3 */
    double *stiff;            /* [contacts] overlaps of grains 1e10 times as stiff */
    double *scattered;        /* [contacts] overlaps of which every hundredth is left: small clusters */
    double *scattered_known;  /* [contacts] displacements that solve them */
    double *displacement;     /* [contacts][2] */
    double *resultant;        /* [particles][3] */
    double *wall_resultant;   /* [walls][3] */
    nlc_info info;            /* of the solution */
} bench;

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "bench: %s%s%s\n", where, *where ? ": " : "", text);
    return -1;
}

/* ---- what is timed; each returns the library's status */

static const double *normals(const bench *b)
{
    return (const double *)b->n.normal;
}

static nlc_status run_algorithm1(bench *b)
{
    algorithm1_sweep(&b->reference, b->work, b->force);
    return NLC_OK;
}

static nlc_status run_sweep(bench *b)
{
    return nlc_sweep(b->coupled, b->displacement, b->force, NULL, normals(b), NULL);
}

static nlc_status run_hertz(bench *b)
{
    return nlc_solve(b->hertz, b->work, b->start, b->n.overlap, normals(b), NULL);
}

static nlc_status build(bench *b, int which, nlc_network **network)
{
    nlc_options options = {.struct_size = sizeof options};
    if (which == HERTZ) options.model = NLC_MODEL_HERTZ;
    if (which == FIXED_POINT) options.method = NLC_METHOD_FIXED_POINT;
    if (which == COARSE) options.tolerance = COARSE_TOLERANCE;
    return nlc_network_init(network, b->memory[which], b->memory_size, &b->particles, b->n.i, b->n.j, b->n.count, &options,
                            NULL);
}

static nlc_status run_init(bench *b)
{
    return build(b, COUPLED, &b->coupled);
}

/* From zeros, or from the displacements given. */
static nlc_status solve(bench *b, nlc_network *network, const double *overlap, const double *from)
{
    for (int64_t c = 0; c < b->n.count; c++) b->start[c] = from ? from[c] : 0;
    return nlc_solve(network, b->work, b->start, overlap, normals(b), NULL);
}

static nlc_status run_solve(bench *b)
{
    return solve(b, b->coupled, b->n.overlap, NULL);
}

static nlc_status run_solve_again(bench *b)
{
    return solve(b, b->coupled, b->n.overlap, b->nonlocal);
}

static nlc_status run_fixed_point(bench *b)
{
    return solve(b, b->fixed_point, b->n.overlap, NULL);
}

static nlc_status run_loose(bench *b)
{
    return solve(b, b->coupled, b->loose, NULL);
}

static nlc_status run_loose_again(bench *b)
{
    return solve(b, b->coupled, b->loose, b->known);
}

static nlc_status run_moved(bench *b)
{
    return solve(b, b->coupled, b->moved, b->nonlocal);
}

static nlc_status run_scattered(bench *b)
{
    return solve(b, b->coupled, b->scattered, b->scattered_known);
}

static nlc_status run_stiff(bench *b)
{
    return solve(b, b->coarse, b->stiff, NULL);
}

static nlc_status run_assemble(bench *b)
{
    return nlc_assemble(b->coupled, b->resultant, 0, b->wall_resultant, b->force, normals(b), NULL);
}

enum { ALGORITHM1, SWEEP }; /* places in the list: their ratio is printed */

static const struct {
    const char *key, *label;
    nlc_status (*run)(bench *b);
} functions[] = {
    {"algorithm1_sweep", "Algorithm 1 as printed, one sweep", run_algorithm1},
    {"nlc_sweep", "nlc_sweep", run_sweep},
    {"nlc_solve_hertz", "nlc_solve, Hertz forces only", run_hertz},
    {"nlc_network_init", "nlc_network_init", run_init},
    {"nlc_solve", "nlc_solve from zeros to 1e-8", run_solve},
    {"nlc_solve_again", "nlc_solve from its result", run_solve_again},
    {"nlc_solve_fixed_point", "nlc_solve from zeros, fixed point", run_fixed_point},
    {"nlc_solve_moved", "nlc_solve when 1 % has moved by 1e-3", run_moved},
    {"nlc_solve_loose", "nlc_solve from zeros, 1 % compressed", run_loose},
    {"nlc_solve_loose_again", "nlc_solve from its result, 1 % compressed", run_loose_again},
    {"nlc_solve_scattered", "nlc_solve from its result, 1 % in clusters", run_scattered},
    {"nlc_solve_stiff", "nlc_solve to 1e-3, where Hertz will do", run_stiff},
    {"nlc_assemble", "nlc_assemble", run_assemble},
};
enum { FUNCTIONS = sizeof functions / sizeof functions[0] };

/* ---- preparation */

static int allocate(bench *b)
{
    size_t contacts = (size_t)b->n.count + 1;
    b->memory_size = nlc_network_size(&b->particles, b->n.count, NULL);
    for (int k = 0; k < NETWORKS; k++) b->memory[k] = malloc(b->memory_size + 1);
    b->force = calloc(contacts, sizeof(double));
    b->nonlocal = calloc(contacts, sizeof(double));
    b->work = calloc(contacts, sizeof(double));
    b->start = calloc(contacts, sizeof(double));
    b->loose = calloc(contacts, sizeof(double));
    b->known = calloc(contacts, sizeof(double));
    b->moved = calloc(contacts, sizeof(double));
    b->stiff = calloc(contacts, sizeof(double));
    b->scattered = calloc(contacts, sizeof(double));
    b->scattered_known = calloc(contacts, sizeof(double));
    b->displacement = calloc(contacts, 2 * sizeof(double));
    b->resultant = calloc((size_t)b->p.count, 3 * sizeof(double));
    b->wall_resultant = calloc((size_t)b->p.wall_count + 1, 3 * sizeof(double));
    bool bad = algorithm1_init(&b->reference, &b->p, &b->n) != 0;
    for (int k = 0; k < NETWORKS; k++) bad = bad || !b->memory[k];
    bad = bad || !b->loose || !b->known || !b->moved || !b->stiff || !b->scattered || !b->scattered_known || !b->force || !b->nonlocal || !b->work || !b->start || !b->displacement ||
          !b->resultant || !b->wall_resultant;
    return bad ? fail("", "out of memory") : 0;
}

/* Everything opened but what lies in a corner of the box with 1 % of its volume, and the solution of that. */
static nlc_status loosen(bench *b)
{
    for (int64_t c = 0; c < b->n.count; c++) {
        bool inside = true;
        for (int x = 0; x < 3; x++) {
            const double edge = b->p.high[x] - b->p.low[x], at = (b->p.x[b->n.i[c]][x] - b->p.low[x]) / edge;
            inside = inside && at * at * at < 0.01;
        }
        b->loose[c] = inside ? b->n.overlap[c] : -fabs(b->n.overlap[c]);
        b->stiff[c] = b->n.overlap[c] > 0 ? 1e-10 * b->n.overlap[c] : b->n.overlap[c];
        b->scattered[c] = c % 100 == 0 ? b->n.overlap[c] : -fabs(b->n.overlap[c]);
        b->moved[c] = inside ? 1.001 * b->n.overlap[c] : b->n.overlap[c];
    }
    const nlc_status status = nlc_solve(b->coupled, b->work, b->known, b->loose, normals(b), NULL);
    if (status < 0) return status;
    return nlc_solve(b->coupled, b->work, b->scattered_known, b->scattered, normals(b), NULL);
}

static int prepare(bench *b, const char *path)
{
    char error[PACKING_ERROR_SIZE];
    memset(b, 0, sizeof *b);
    if (packing_open(&b->p, &b->n, path, NEIGHBOURS_REACH, error, sizeof error)) return fail("", error);
    if (b->n.count == 0) return fail(path, "no contacts");
    b->particles = packing_particles(&b->p);
    if (allocate(b)) return -1;
    nlc_status status = build(b, COUPLED, &b->coupled);
    if (!status) status = build(b, HERTZ, &b->hertz);
    if (!status) status = build(b, FIXED_POINT, &b->fixed_point);
    if (!status) status = build(b, COARSE, &b->coarse);
    if (!status) status = loosen(b);
    b->info.struct_size = sizeof b->info;
    if (!status) status = nlc_solve(b->coupled, b->force, b->nonlocal, b->n.overlap, normals(b), &b->info);
    if (status > 0) fprintf(stderr, "bench: warning: %s: %s\n", path, nlc_strerror(status));
    return status < 0 ? fail(path, nlc_strerror(status)) : 0;
}

static void release(bench *b)
{
    algorithm1_free(&b->reference);
    for (int k = 0; k < NETWORKS; k++) free(b->memory[k]);
    free(b->loose);
    free(b->known);
    free(b->moved);
    free(b->stiff);
    free(b->scattered);
    free(b->scattered_known);
    free(b->force);
    free(b->nonlocal);
    free(b->work);
    free(b->start);
    free(b->displacement);
    free(b->resultant);
    free(b->wall_resultant);
    neighbours_free(&b->n);
    packing_free(&b->p);
}

/* ---- measurement */

/* Seconds of one call, from repeat of them.  status: of the last. */
static double time_calls(bench *b, int f, int64_t repeat, nlc_status *status)
{
    double start = timing_processor_seconds();
    for (int64_t k = 0; k < repeat; k++) *status = functions[f].run(b);
    return (timing_processor_seconds() - start) / (double)repeat;
}

/* How many calls make a run.  Doubled until they last long enough; warms the caches, too. */
static int choose_repeat(bench *b, int f, int64_t *repeat)
{
    nlc_status status = NLC_OK;
    for (*repeat = 1; *repeat < INT32_MAX; *repeat *= 2) {
        double seconds = time_calls(b, f, *repeat, &status);
        if (status < 0) return fail(functions[f].label, nlc_strerror(status));
        if (seconds * (double)*repeat >= RUN_TIME) break;
    }
    return 0;
}

static int measure(bench *b, double sample[FUNCTIONS][RUNS])
{
    int64_t repeat[FUNCTIONS];
    nlc_status status;
    timing_progress progress;
    timing_progress_begin(&progress, "runs done");
    for (int f = 0; f < FUNCTIONS; f++)
        if (choose_repeat(b, f, &repeat[f])) return -1;
    for (int r = 0; r < RUNS; r++) {
        timing_progress_update(&progress, r, RUNS);
        for (int f = 0; f < FUNCTIONS; f++) sample[f][r] = time_calls(b, f, repeat[f], &status);
    }
    timing_progress_end(&progress);
    return 0;
}

/* Largest difference of the two displacements over the largest displacement. */
static double compare(bench *b)
{
    double difference = 0, largest = 0;
    run_algorithm1(b);
    run_sweep(b);
    for (int64_t c = 0; c < b->n.count; c++) {
        double g = b->displacement[2 * c] + b->displacement[2 * c + 1];
        difference = fmax(difference, fabs(g - b->work[c]));
        largest = fmax(largest, fabs(g));
    }
    return largest > 0 ? difference / largest : 0;
}

/* ---- output */

static void print_row(const bench *b, bool csv, const char *key, const char *label, const char *unit, double *sample)
{
    timing_spread s = timing_spread_of(sample, RUNS);
    if (csv)
        printf("%s,%lld,%lld,%s,%s,%d,%.6g,%.6g,%.6g,%.6g\n", b->p.name, (long long)b->p.count, (long long)b->n.count, key,
               unit, s.count, s.minimum, s.lower_quartile, s.median, s.upper_quartile);
    else
        printf("  %-*s%12.2f%12.2f%12.2f%12.2f\n", LABEL_WIDTH - 2, label, s.median, s.minimum, s.lower_quartile,
               s.upper_quartile);
}

static void print_head(const bench *b)
{
    printf("%s: %lld spheres, %lld contacts and candidates, %lld with a force, %lld sweeps in a solve\n\n", b->p.name,
           (long long)b->p.count, (long long)b->n.count, (long long)b->info.active, (long long)b->info.sweeps);
    printf("%-*s%12s%12s%12s%12s\n", LABEL_WIDTH, "ns per contact or candidate", "median", "minimum", "quartile 1",
           "quartile 3");
}

static void print_results(const bench *b, bool csv, double sample[FUNCTIONS][RUNS], double difference)
{
    double ratio[RUNS];
    for (int r = 0; r < RUNS; r++) ratio[r] = sample[ALGORITHM1][r] / sample[SWEEP][r];
    if (!csv) print_head(b);
    for (int f = 0; f < FUNCTIONS; f++) {
        for (int r = 0; r < RUNS; r++) sample[f][r] *= 1e9 / (double)b->n.count;
        print_row(b, csv, functions[f].key, functions[f].label, "ns", sample[f]);
    }
    if (!csv) putchar('\n');
    print_row(b, csv, "ratio", "Algorithm 1 / nlc_sweep, run by run", "1", ratio);
    if (csv)
        printf("%s,%lld,%lld,difference,1,1,%.3g,%.3g,%.3g,%.3g\n", b->p.name, (long long)b->p.count, (long long)b->n.count,
               difference, difference, difference, difference);
    else
        printf("  %d runs; displacements of the two differ by at most %.1e of the largest\n\n", RUNS, difference);
}

static int run_file(const char *path, bool csv)
{
    bench b;
    double sample[FUNCTIONS][RUNS];
    int status = prepare(&b, path);
    if (!status) status = measure(&b, sample);
    if (!status) print_results(&b, csv, sample, compare(&b));
    release(&b);
    return status;
}

int main(int argc, char **argv)
{
    bool csv = false;
    int k = 1, status = 0;
    for (; k < argc && argv[k][0] == '-'; k++) {
        bool help = strcmp(argv[k], "--help") == 0;
        csv = csv || strcmp(argv[k], "--csv") == 0;
        if (!help && strcmp(argv[k], "--csv") == 0) continue;
        fputs(usage, help ? stdout : stderr);
        return help ? EXIT_SUCCESS : EXIT_USAGE;
    }
    if (k == argc) {
        fputs(usage, stderr);
        return EXIT_USAGE;
    }
    if (csv) puts("packing,particles,contacts,measurement,unit,runs,minimum,lower_quartile,median,upper_quartile");
    for (; k < argc; k++) status |= run_file(argv[k], csv);
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output", "cannot be written");
    return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
