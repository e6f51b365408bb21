/* SPDX-License-Identifier: BSD-2-Clause */
/* coordination.c - one large sphere with Z small ones on it: what a sweep and a solve cost as Z grows, all pairs beside it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nlcontact.h"
#include "timing.h"

#define ALL_PAIRS 1e-15 /* a tolerance at which nothing is interpolated */
#define PATIENCE 3.0    /* seconds: what would take longer is not measured */
#define ENOUGH 0.05     /* seconds: what takes less is measured again */

typedef struct scene {
    int64_t count;
    double *radius, *overlap, *normal, *force, *nonlocal, *w, *exact;
    int32_t *i, *j;
    nlc_network *network;
    void *memory;
} scene;

static double noise(uint64_t *state) /* -1 ... 1; splitmix64 */
{
    uint64_t h = *state += UINT64_C(0x9e3779b97f4a7c15);
    h = (h ^ (h >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    h = (h ^ (h >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((h ^ (h >> 31)) >> 11) * 0x1p-52 - 1;
}

/* Directions at about equal distances, a third of the contacts pushed in ten times as far as the others. */
static void set_contact(scene *s, int64_t c, uint64_t *state)
{
    const double z = 1 - (2 * (double)c + 1) / (double)s->count, turn = (double)c * 3.14159265358979323846 * (3 - sqrt(5));
    const double r = sqrt(1 - z * z), spacing = sqrt(12.566 / (double)s->count);
    double *v = s->normal + 3 * c, length = 0;
    v[0] = r * cos(turn), v[1] = r * sin(turn), v[2] = z;
    for (int x = 0; x < 3; x++) v[x] += 0.15 * spacing * noise(state), length += v[x] * v[x];
    for (int x = 0; x < 3; x++) v[x] /= sqrt(length);
    s->i[c] = 0;
    s->j[c] = (int32_t)c + 1;
    s->radius[c + 1] = 0.4 * spacing;
    s->overlap[c] = s->radius[c + 1] * (c % 3 ? 2e-4 : 2e-3) * (1 + 0.5 * noise(state));
    s->force[c] = 1 + 0.5 * noise(state);
}

static int prepare(scene *s, int64_t count)
{
    static const nlc_material material = {1e9, 0.3};
    const size_t n = (size_t)count;
    const nlc_particles p = {.struct_size = sizeof p, .count = count + 1, .materials = &material, .material_count = 1};
    nlc_particles q = p;
    uint64_t state = 1;
    *s = (scene){.count = count};
    const size_t size = nlc_network_size(&p, count, NULL);
    double **array[] = {&s->radius, &s->overlap, &s->normal, &s->force, &s->nonlocal, &s->w, &s->exact};
    bool there = (s->memory = malloc(size)) && (s->i = malloc(n * sizeof *s->i)) && (s->j = malloc(n * sizeof *s->j));
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) there = (*array[k] = calloc(3 * n + 1, sizeof(double))) && there;
    if (!there) return -1;
    s->radius[0] = 1;
    for (int64_t c = 0; c < count; c++) set_contact(s, c, &state);
    q.radius = s->radius;
    return nlc_network_init(&s->network, s->memory, size, &q, s->i, s->j, count, NULL, NULL) < 0 ? -1 : 0;
}

static void release(scene *s)
{
    double *array[] = {s->radius, s->overlap, s->normal, s->force, s->nonlocal, s->w, s->exact};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) free(array[k]);
    free(s->i), free(s->j), free(s->memory);
}

/* Nanoseconds a contact, the least of a few; negative: it failed. */
static double time_sweep(scene *s, int32_t model, double tolerance, double *w)
{
    const nlc_options options = {.struct_size = sizeof options, .model = model, .tolerance = tolerance};
    double least = INFINITY, sum = 0;
    if (nlc_set_options(s->network, &options, NULL) < 0) return -1;
    for (int k = 0; k < 20 && (k < 2 || sum < ENOUGH) && sum < PATIENCE; k++) {
        const double begin = timing_seconds();
        if (nlc_sweep(s->network, w, s->force, s->overlap, s->normal, NULL) < 0) return -1;
        const double took = timing_seconds() - begin;
        least = took < least ? took : least;
        sum += took;
    }
    return least * 1e9 / (double)s->count;
}

static double time_solve(scene *s, int32_t model, int64_t *sweeps)
{
    const nlc_options options = {.struct_size = sizeof options, .model = model};
    nlc_info info = {.struct_size = sizeof info};
    memset(s->nonlocal, 0, (size_t)s->count * sizeof *s->nonlocal);
    if (nlc_set_options(s->network, &options, NULL) < 0) return -1;
    const double begin = timing_seconds();
    if (nlc_solve(s->network, s->exact, s->nonlocal, s->overlap, s->normal, &info) < 0) return -1;
    *sweeps = info.sweeps;
    return (timing_seconds() - begin) * 1e9 / (double)s->count;
}

/* Largest difference of the displacements on the large sphere, relative to the largest. */
static double difference(const scene *s)
{
    double most = 0, top = 0;
    for (int64_t c = 0; c < s->count; c++) {
        most = fmax(most, fabs(s->w[2 * c] - s->exact[2 * c]));
        top = fmax(top, fabs(s->exact[2 * c]));
    }
    return most / top;
}

static void print(double ns, const char *after)
{
    if (ns < INFINITY) printf("%12.0f%s", ns, after);
    else printf("%12s%s", "-", after);
}

static int run(int32_t model, const char *name, double per_pair, int64_t most)
{
    static const int64_t counts[] = {10, 30, 100, 300, 1000, 3000, 10000, 30000, 100000};
    printf("\n%s\n%8s%12s%12s%10s%12s", name, "Z", "all pairs", "1e-8", "error", "1e-4");
    printf("%10s%12s%8s\n", "error", "solve, 1e-8", "sweeps");
    for (size_t k = 0; k < sizeof counts / sizeof *counts && counts[k] <= most; k++) {
        const double Z = (double)counts[k];
        const bool pairs = Z * Z * per_pair < PATIENCE;
        int64_t sweeps = 0;
        scene s;
        if (prepare(&s, counts[k])) return -1;
        printf("%8.0f", Z);
        print(pairs ? time_sweep(&s, model, ALL_PAIRS, s.exact) : INFINITY, "");
        for (int t = 0; t < 2; t++) {
            print(time_sweep(&s, model, t == 0 ? 1e-8 : 1e-4, s.w), "");
            if (pairs) printf("%10.0e", difference(&s));
            else printf("%10s", "-");
        }
        print(time_solve(&s, model, &sweeps), "");
        printf("%8.0f\n", (double)sweeps);
        fflush(stdout);
        release(&s);
    }
    return 0;
}

int main(void)
{
    printf("One sphere with Z others on it: ns a contact of a sweep over all pairs, of sweeps at two tolerances, and of a solve;\n"
           "error: largest difference from all pairs over the largest displacement.\n");
    if (run(NLC_MODEL_GONZALEZ_CUITINO, "gonzalez-cuitino", 1e-9, 100000) || run(NLC_MODEL_SPHERE, "sphere", 3e-8, 10000)) {
        fprintf(stderr, "coordination: failed\n");
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
