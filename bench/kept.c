/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * kept.c - a sweep with coefficients that are kept, in 64 and in 32 bits, beside one that computes them.
 *
 * The library keeps 64 bits (options.cache): with the 24 bits of a float's mantissa no force is better than some 1e-7.  What 32 bits
 * would save is shown by a loop of this program's own, over the same coefficients as double and as float: a particle in each lane, each
 * coefficient used for both of its contacts.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/network.h"
#include "lattice.h"
#include "neighbours.h"
#include "packing_io.h"
#include "timing.h"

static const char usage[] = "usage: kept PACKING...\n"
                            "\n"
                            "ns per contact of a sweep that computes its coefficients, one that keeps them, too, one from what is kept, and a loop\n"
                            "over as many in 64 and in 32 bits.  PACKING: a file, or lattice:N (see bench/README).\n";

enum { RUNS = 100, LANES = 8, PLACES = 24, EXIT_USAGE = 2 };
#define TIME_IN_ALL 3.0
#define RUN_TIME 3e-4

#if defined(__x86_64__) && defined(__GNUC__) && defined(__gnu_linux__)
#define FOR_EACH_PROCESSOR __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define FOR_EACH_PROCESSOR
#endif

/* Particles in groups of LANES with as many contacts each, and one coefficient a pair of places and lane. */
typedef struct lists {
    int64_t groups, coefficients, contacts;
    int32_t *particle; /* [groups][LANES] */
    int *places;       /* [groups] */
    double *wide;      /* [coefficients][LANES] */
    float *narrow;
    const nlc_network *network;
    double *side; /* [2 contacts] */
} lists;

/* With the loop's text written once for both types. */
#define SWEEP(NAME, TYPE, ARRAY)                                                                                                            \
    FOR_EACH_PROCESSOR static void NAME(const lists *s, const double *restrict force)                                                      \
    {                                                                                                                                      \
        const TYPE *k = s->ARRAY;                                                                                                          \
        double f[PLACES][LANES], sum[PLACES][LANES];                                                                                       \
        for (int64_t g = 0; g < s->groups; g++) {                                                                                          \
            const int places = s->places[g];                                                                                               \
            const int32_t *particle = s->particle + LANES * g;                                                                             \
            for (int d = 0; d < places; d++)                                                                                               \
                for (int l = 0; l < LANES; l++) {                                                                                          \
                    f[d][l] = force[s->network->entry[s->network->start[particle[l]] + d] >> 1];                                           \
                    sum[d][l] = 0;                                                                                                         \
                }                                                                                                                          \
            for (int c = 1; c < places; c++)                                                                                               \
                for (int d = 0; d < c; d++, k += LANES)                                                                                    \
                    for (int l = 0; l < LANES; l++) {                                                                                      \
                        sum[c][l] += (double)k[l] * f[d][l];                                                                               \
                        sum[d][l] += (double)k[l] * f[c][l];                                                                               \
                    }                                                                                                                      \
            for (int d = 0; d < places; d++)                                                                                               \
                for (int l = 0; l < LANES; l++) s->side[s->network->entry[s->network->start[particle[l]] + d]] = sum[d][l];                \
        }                                                                                                                                  \
    }
SWEEP(sweep_wide, double, wide)
SWEEP(sweep_narrow, float, narrow)

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "kept: %s%s%s\n", where, *where ? ": " : "", text);
    return -1;
}

/* Particles with fewer than two contacts, or with more than there are places, are left out, and up to LANES-1 of each number of contacts. */
static int make_lists(lists *s, const nlc_network *n)
{
    const int64_t particles = n->particle_count;
    *s = (lists){.network = n};
    s->particle = malloc((size_t)(particles + 1) * sizeof *s->particle);
    s->places = malloc((size_t)(particles / LANES + 1) * sizeof *s->places);
    s->side = calloc((size_t)(2 * n->contact_count + 1), sizeof *s->side);
    if (!s->particle || !s->places || !s->side) return fail("", "out of memory");
    for (int z = 2; z <= PLACES; z++) {
        int64_t at = LANES * s->groups;
        for (int64_t k = 0; k < particles; k++)
            if (n->start[k + 1] - n->start[k] == z) s->particle[at++] = (int32_t)k;
        for (; at / LANES > s->groups; s->groups++) {
            s->places[s->groups] = z;
            s->coefficients += z * (z - 1) / 2;
            s->contacts += (int64_t)LANES * z; /* sides, so far */
        }
    }
    s->wide = malloc((size_t)(s->coefficients * LANES + 1) * sizeof *s->wide);
    s->narrow = malloc((size_t)(s->coefficients * LANES + 1) * sizeof *s->narrow);
    if (!s->wide || !s->narrow) return fail("", "out of memory");
    for (int64_t k = 0; k < s->coefficients * LANES; k++) {
        s->wide[k] = 0.1 + 1e-3 * (double)(k % 97);
        s->narrow[k] = (float)s->wide[k];
    }
    return 0;
}

static void free_lists(lists *s)
{
    free(s->particle);
    free(s->places);
    free(s->side);
    free(s->wide);
    free(s->narrow);
}

enum { COMPUTED, FILLING, KEPT, WIDE, NARROW, ROWS };

static void run_row(int row, nlc_network *n, const lists *s, const double *force, const double *normal)
{
    int64_t culprit;
    switch (row) {
    case WIDE: sweep_wide(s, force); return;
    case NARROW: sweep_narrow(s, force); return;
    }
    double *const cache = n->settings.cache;
    if (row == COMPUTED) n->settings.cache = NULL;
    n->cached = n->cached && row == KEPT;
    nlc_displace(n, NLC_OF_FORCES, force, normal, &culprit);
    n->settings.cache = cache;
    n->cached = n->cached && row != COMPUTED;
}

static void print(const char *name, const nlc_network *n, const lists *s, double (*sample)[RUNS], int runs)
{
    static const char *const label[ROWS] = {"library, computed", "library, computed and kept", "library, from what is kept", "loop, kept in 64 bits", "loop, kept in 32 bits"};
    const double contacts = (double)n->contact_count, bytes = 8. * (double)(s->coefficients * LANES) / contacts;
    printf("%s: %lld contacts; coefficients of %.0f and %.0f bytes a contact\n\n%-28s%10s%10s\n", name, (long long)n->contact_count, bytes,
           0.5 * bytes, "a sweep, ns per contact", "minimum", "median");
    for (int r = 0; r < ROWS; r++) {
        const timing_spread t = timing_spread_of(sample[r], runs);
        const double per = r < WIDE ? contacts : 0.5 * (double)s->contacts; /* the loop's own: both sides of so many */
        printf("%-28s%10.2f%10.2f\n", label[r], 1e9 * t.minimum / per, 1e9 * t.median / per);
    }
    putchar('\n');
}

static void measure(const char *name, nlc_network *n, const lists *s, const double *force, const double *normal)
{
    static double sample[ROWS][RUNS];
    const int64_t repeat = 1 + (int64_t)(RUN_TIME / (3e-8 * (double)(n->contact_count + 1)));
    const double begun = timing_processor_seconds();
    int runs = 0;
    for (; runs < RUNS && (runs < 3 || timing_processor_seconds() - begun < TIME_IN_ALL); runs++)
        for (int row = 0; row < ROWS; row++) {
            if (row == KEPT) run_row(FILLING, n, s, force, normal); /* of the rows before some may have left nothing */
            const double start = timing_processor_seconds();
            for (int64_t q = 0; q < repeat; q++) run_row(row, n, s, force, normal);
            sample[row][runs] = (timing_processor_seconds() - start) / (double)repeat;
        }
    print(name, n, s, sample, runs);
}

static int run(const char *path)
{
    char error[PACKING_ERROR_SIZE];
    packing p;
    neighbours n = {0};
    int status = packing_open(&p, &n, path, NEIGHBOURS_REACH, error, sizeof error);
    if (status) fail("", error);
    else if (n.count == 0) status = fail(path, "no contacts");
    const nlc_particles particles = packing_particles(&p);
    nlc_options o = {.struct_size = sizeof o};
    const size_t size = status ? 0 : nlc_network_size(&particles, n.count, &o);
    void *memory = malloc(size + 1);
    double *force = malloc((size_t)(n.count + 1) * sizeof *force);
    nlc_network *network;
    lists s = {0};
    if (!status && (!memory || !force)) status = fail(path, "out of memory");
    if (!status && nlc_network_init(&network, memory, size, &particles, n.i, n.j, n.count, &o, NULL)) status = fail(path, "no network");
    if (!status) {
        o.cache_size = nlc_cache_size(network);
        o.cache = malloc(o.cache_size + 1);
        if (!o.cache || nlc_set_options(network, &o, NULL)) status = fail(path, "no cache");
    }
    for (int64_t c = 0; c < n.count && !status; c++) force[c] = n.overlap[c] > 0 ? n.overlap[c] : 0;
    if (!status) status = make_lists(&s, network);
    if (!status) measure(p.name, network, &s, force, (const double *)n.normal);
    free_lists(&s);
    free(o.cache);
    free(force);
    free(memory);
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
        return help ? EXIT_SUCCESS : EXIT_USAGE;
    }
    for (int k = 1; k < argc; k++) status |= run(argv[k]);
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output", "cannot be written");
    return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
