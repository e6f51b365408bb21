/* SPDX-License-Identifier: BSD-2-Clause */
/* roofline.c - how far a sweep is from what the processor and its memory can do. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/network.h"
#include "lattice.h"
#include "neighbours.h"
#include "packing_io.h"
#include "peak.h"
#include "timing.h"

static const char usage[] = "usage: roofline FILE...\n"
                            "\n"
                            "Times a sweep of Case I in each variant that the processor has, one after the other in every run, beside what\n"
                            "its arithmetic takes on registers alone and what its data take to be read and written, in order and in its own order.\n";

/*
 * Counted by hand in lib/lanes.h.  A pair: 3 differences, 3 fused multiply-adds for t; a minimum; the series; 2 for the coefficient,
 * 2 for the sums.  A fused multiply-add is two operations, an estimate one.  A contact, at the least: normal and force read, two
 * places of the adjacency read, two displacements written, which reads them first; a particle: start, U, material, largest force.
 */
enum { RUNS = 300, PAIR_AVX2 = 31, PAIR_AVX512 = 29, CONTACT_BYTES = 24 + 8 + 16 + 2 * 16, PARTICLE_BYTES = 8 + 8 + 4 + 2 * 8 };
#define RUN_TIME 3e-4 /* seconds */
#define TIME_IN_ALL 4.0

typedef struct row {
    const char *label;
    int simd, flops;
    int64_t (*peak)(int64_t pairs);
    nlc_network *network;
    void *memory;
    double seconds, peak_seconds; /* of a sweep; of a pair */
} row;

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "roofline: %s%s%s\n", where, *where ? ": " : "", text);
    return -1;
}

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

/* a = b + 3 c on arrays that are together as large as a sweep's data; bytes per second, with the reading of a before it is written. */
static double triad(double *a, const double *b, const double *c, int64_t count)
{
    double best = INFINITY;
    const int64_t repeat = 1 + 100000 / count;
    for (int r = 0; r < 30; r++) {
        const double start = timing_processor_seconds();
        for (int64_t q = 0; q < repeat; q++) {
            for (int64_t k = 0; k < count; k++) a[k] = b[k] + (double)(q + 3) * c[k];
            __asm__ volatile("" ::: "memory");
        }
        best = smaller(best, (timing_processor_seconds() - start) / (double)repeat);
    }
    return 32 * (double)count / best;
}

static double bandwidth(double bytes)
{
    const int64_t count = (int64_t)(bytes / 24) + 1;
    double *a = calloc((size_t)(3 * count), sizeof *a);
    if (!a) return 0;
    for (int64_t k = 0; k < 3 * count; k++) a[k] = 1;
    const double rate = triad(a, a + count, a + 2 * count, count);
    free(a);
    return rate;
}

/*
 * What a sweep reads and writes in the order in which it does, added up: no arithmetic that is worth the name.  Entries are known ahead,
 * so that memory can be asked for in time.
 */
static double walk(const nlc_network *n, const double *force, const double *normal)
{
    enum { AHEAD = 48, CHAINS = 4 };
    double sum[CHAINS] = {0};
    const int64_t end = n->start[n->particle_count];
    for (int64_t p = 0; p < end; p++) {
        const int64_t e = n->entry[p], c = e >> 1, later = n->entry[p + AHEAD < end ? p + AHEAD : end - 1];
        __builtin_prefetch(normal + 3 * (later >> 1) + 1);
        __builtin_prefetch(force + (later >> 1));
        __builtin_prefetch(n->side + later, 1);
        sum[p % CHAINS] += normal[3 * c] + normal[3 * c + 1] + normal[3 * c + 2] + force[c];
        n->side[e] = sum[p % CHAINS];
    }
    return sum[0] + sum[1] + sum[2] + sum[3];
}

static int prepare(row *r, const neighbours *n, const nlc_particles *p)
{
    const nlc_options o = {.struct_size = sizeof o, .simd = r->simd};
    const size_t size = nlc_network_size(p, n->count, &o);
    r->memory = malloc(size + 1);
    r->seconds = r->peak_seconds = INFINITY;
    if (!r->memory) return fail("", "out of memory");
    const nlc_status status = nlc_network_init(&r->network, r->memory, size, p, n->i, n->j, n->count, &o, NULL);
    return status ? fail("nlc_network_init", nlc_strerror(status)) : 0;
}

static void time_once(row *r, const double *force, const double *normal, int64_t repeat)
{
    int64_t culprit;
    double start = timing_processor_seconds();
    for (int64_t q = 0; q < repeat; q++) nlc_displace(r->network, NLC_OF_FORCES, force, normal, &culprit);
    r->seconds = smaller(r->seconds, (timing_processor_seconds() - start) / (double)repeat);
    if (!r->peak) return;
    start = timing_processor_seconds();
    const int64_t pairs = r->peak(1 << 16);
    r->peak_seconds = smaller(r->peak_seconds, (timing_processor_seconds() - start) / (double)(pairs + 1));
}

/* The least time of a walk in seconds. */
static double time_walk(const nlc_network *n, const double *force, const double *normal, int64_t repeat)
{
    double best = INFINITY;
    volatile double sum = 0;
    for (int r = 0; r < 30; r++) {
        const double start = timing_processor_seconds();
        for (int64_t q = 0; q < repeat; q++) sum += walk(n, force, normal);
        best = smaller(best, (timing_processor_seconds() - start) / (double)repeat);
    }
    return best;
}

static void print(const row *rows, int count, const packing *p, const neighbours *n)
{
    const nlc_network *w = rows[0].network;
    double pairs = 0, contacts = (double)n->count;
    for (int64_t k = 0; k < p->count; k++) pairs += 0.5 * (double)(w->start[k + 1] - w->start[k]) * (double)(w->start[k + 1] - w->start[k] - 1);
    const double bytes = CONTACT_BYTES + PARTICLE_BYTES * (double)p->count / contacts, rate = bandwidth(bytes * contacts);
    printf("%s: %lld contacts and candidates, %.2f pairs and %.0f bytes at least for each; triad on as many bytes %.1f GB/s\n\n", p->name,
           (long long)n->count, pairs / contacts, bytes, 1e-9 * rate);
    printf("%-20s%10s%10s%12s%12s%10s%12s%10s\n", "a sweep, per contact", "ns", "flops", "GFLOP/s", "registers", "share", "memory ns", "share");
    for (int k = 0; k < count; k++) {
        const row *r = &rows[k];
        const double ns = 1e9 * r->seconds / contacts, memory = 1e9 * bytes / rate, flops = r->flops * pairs / contacts;
        if (!r->peak) printf("%-20s%10.2f%10s%12s%12s%10s%12.2f%9.0f%%\n", r->label, ns, "", "", "", "", memory, 100 * memory / ns);
        else
            printf("%-20s%10.2f%10.0f%12.1f%12.1f%9.0f%%%12.2f%9.0f%%\n", r->label, ns, flops, flops / ns, 1e-9 * r->flops / r->peak_seconds,
                   100e9 * r->peak_seconds * pairs / contacts / ns, memory, 100 * memory / ns);
    }
    printf("  least of many runs; registers: GFLOP/s of the same arithmetic without memory; memory: the bytes at triad's rate\n");
}

static int run_file(const char *path)
{
    row all[] = {{.label = "portable C", .simd = NLC_SIMD_GENERIC},
                 {.label = "AVX2", .simd = NLC_SIMD_AVX2, .flops = PAIR_AVX2, .peak = peak_avx2},
                 {.label = "AVX-512", .simd = NLC_SIMD_AVX512, .flops = PAIR_AVX512, .peak = peak_avx512},
                 {.label = "NEON", .simd = NLC_SIMD_NEON}};
    row rows[sizeof all / sizeof *all];
    char error[PACKING_ERROR_SIZE];
    packing p;
    neighbours n = {0};
    int count = 0, status = packing_open(&p, &n, path, NEIGHBOURS_REACH, error, sizeof error);
    if (status) fail("", error);
    else if (n.count == 0) status = fail(path, "no contacts");
    const nlc_particles particles = packing_particles(&p);
    for (size_t k = 0; k < sizeof all / sizeof *all && !status; k++) {
        if (count > 0 && nlc_choose_variant(all[k].simd) == nlc_choose_variant(rows[count - 1].simd)) continue;
        if (k == 3 && !nlc_choose_variant(all[k].simd)) continue;
        rows[count] = all[k];
        status = prepare(&rows[count++], &n, &particles);
    }
    double *force = malloc((size_t)(n.count + 1) * sizeof *force);
    for (int64_t c = 0; c < n.count && force && !status; c++) force[c] = n.overlap[c] > 0 ? n.overlap[c] : 0;
    const int64_t repeat = 1 + (int64_t)(RUN_TIME / (3e-8 * (double)(n.count + 1)));
    const double start = timing_processor_seconds();
    for (int r = 0; r < RUNS && force && !status && (r < 3 || timing_processor_seconds() - start < TIME_IN_ALL); r++)
        for (int k = 0; k < count; k++) time_once(&rows[k], force, (const double *)n.normal, repeat);
    if (force && !status) {
        print(rows, count, &p, &n);
        printf("  the same reads and writes, particle by particle, and no arithmetic: %.2f ns\n\n",
               1e9 * time_walk(rows[0].network, force, (const double *)n.normal, repeat) / (double)n.count);
    }
    for (int k = 0; k < count; k++) free(rows[k].memory);
    free(force);
    neighbours_free(&n);
    packing_free(&p);
    return status;
}

int main(int argc, char **argv)
{
    int status = 0;
    if (argc < 2 || argv[1][0] == '-') {
        const bool help = argc > 1 && strcmp(argv[1], "--help") == 0;
        fputs(usage, help ? stdout : stderr);
        return help ? EXIT_SUCCESS : 2;
    }
    for (int k = 1; k < argc; k++) status |= run_file(argv[k]);
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output", "cannot be written");
    return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
