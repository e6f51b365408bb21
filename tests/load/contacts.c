/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * contacts.c - one network with as many contacts as there is memory for.
 *
 *     contacts [COUNT [lean]]     at least so many; default 1e5; some 450 bytes each, 14 GB for 3e7; by the default method
 *                                 lean: by NLC_METHOD_FIXED_POINT, in a network for that; some 145 bytes, 14 GB for 1e8
 *
 * A periodic face-centred crystal of equal spheres, whose overlaps repeat themselves every PERIOD cells.  So do its forces, by
 * symmetry: those of a crystal of one period's cells, which is small, to the tolerances of both.  Forces on particles sum up to
 * 0 to rounding.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "nlcontact.h"

enum { PERIOD = 3, SPHERES = 4, EACH = 6 }; /* spheres of a cell; contacts that a sphere has with those that come later */
static const double tolerance = 1e-6;

typedef struct crystal {
    int64_t cells, particles, contacts; /* cells: along an edge */
    double *radius, *overlap, *normal, *force, *nonlocal;
    int32_t *i, *j;
    nlc_network *network;
    void *memory;
    size_t size;
    int32_t method;
} crystal;

/* Where the spheres of a cell are, in halves of its edge; the six neighbours in later directions. */
static const int place[SPHERES][3] = {{0, 0, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};
static const int step[EACH][3] = {{0, 1, 1}, {0, 1, -1}, {1, 0, 1}, {1, 0, -1}, {1, 1, 0}, {1, -1, 0}};

static void fail(const char *what, double a, double b)
{
    fprintf(stderr, "contacts: %s: %.17g, %.17g\n", what, a, b);
    exit(1);
}

static void *room(int64_t count, size_t size)
{
    void *p = malloc((size_t)count * size);
    if (!p) fail("out of memory", (double)count, (double)size);
    return p;
}

static int64_t wrap(int64_t x, int64_t n)
{
    return (x + n) % n;
}

/* The number of the sphere at a place in halves of edges. */
static int64_t sphere_at(const crystal *w, int64_t x, int64_t y, int64_t z)
{
    const int64_t n = w->cells, cell = (wrap(x, 2 * n) / 2 * n + wrap(y, 2 * n) / 2) * n + wrap(z, 2 * n) / 2;
    const int odd[3] = {(int)wrap(x, 2), (int)wrap(y, 2), (int)wrap(z, 2)};
    for (int k = 0; k < SPHERES; k++)
        if (memcmp(odd, place[k], sizeof odd) == 0) return SPHERES * cell + k;
    fail("no sphere there", (double)x, (double)y);
    return -1;
}

/* The contact's number in the crystal of one period. */
static int64_t alike(int64_t n, int64_t c)
{
    const int64_t cell = c / (SPHERES * EACH), x = cell / (n * n), y = cell / n % n, z = cell % n;
    return ((x % PERIOD * PERIOD + y % PERIOD) * PERIOD + z % PERIOD) * SPHERES * EACH + c % (SPHERES * EACH);
}

/* What is like a random number and depends on k alone. */
static double scatter(int64_t k)
{
    uint64_t z = ((uint64_t)k + 1) * UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    return 0x1p-53 * (double)((z ^ (z >> 27)) >> 11);
}

static void make(crystal *w, int64_t cells)
{
    w->cells = cells;
    w->particles = SPHERES * cells * cells * cells;
    w->contacts = EACH * w->particles;
    w->radius = room(w->particles, sizeof *w->radius);
    w->overlap = room(w->contacts, sizeof *w->overlap);
    w->normal = room(w->contacts, 3 * sizeof *w->normal);
    w->force = room(w->contacts, sizeof *w->force);
    w->nonlocal = room(w->contacts, sizeof *w->nonlocal);
    w->i = room(w->contacts, sizeof *w->i);
    w->j = room(w->contacts, sizeof *w->j);
    for (int64_t k = 0; k < w->particles; k++) {
        const int64_t cell = k / SPHERES, x = cell / (cells * cells), y = cell / cells % cells, z = cell % cells;
        const int *p = place[k % SPHERES];
        w->radius[k] = 1;
        for (int e = 0; e < EACH; e++) {
            const int64_t c = EACH * k + e;
            w->i[c] = (int32_t)k;
            w->j[c] = (int32_t)sphere_at(w, 2 * x + p[0] + step[e][0], 2 * y + p[1] + step[e][1], 2 * z + p[2] + step[e][2]);
            for (int d = 0; d < 3; d++) w->normal[3 * c + d] = sqrt(0.5) * step[e][d];
            w->overlap[c] = 0.01 + 0.01 * (scatter(alike(cells, c)) - 0.5);
            w->nonlocal[c] = 0;
        }
    }
}

static void say(const char *what, double *since)
{
    const double now = (double)time(NULL);
    if (*since > 0) fprintf(stderr, "contacts: %s: %.0f s\n", what, now - *since);
    *since = now;
}

static nlc_info solve(crystal *w, double *since)
{
    static const nlc_material material = {1e9, 0.3};
    const nlc_particles p = {
        .struct_size = sizeof p, .count = w->particles, .radius = w->radius, .materials = &material, .material_count = 1};
    const nlc_options o = {.struct_size = sizeof o, .method = w->method, .tolerance = tolerance};
    nlc_info info = {.struct_size = sizeof info};
    say("made", since);
    w->size = nlc_network_size(&p, w->contacts, &o);
    w->memory = malloc(w->size);
    if (w->size == 0 || !w->memory) fail("memory for the network", (double)w->size, (double)w->contacts);
    nlc_status status = nlc_network_init(&w->network, w->memory, w->size, &p, w->i, w->j, w->contacts, &o, &info);
    if (status != NLC_OK) fail(nlc_strerror(status), status, (double)info.culprit);
    say("nlc_network_init", since);
    status = nlc_solve(w->network, w->force, w->nonlocal, w->overlap, w->normal, &info);
    if (status != NLC_OK) fail(nlc_strerror(status), status, (double)info.culprit);
    if (info.active != w->contacts) fail("contacts with a force", (double)info.active, (double)w->contacts);
    say("nlc_solve", since);
    return info;
}

/* What a fault in the last contact of all is called: the largest index that there is. */
static void find_last_fault(crystal *w)
{
    const double kept = w->overlap[w->contacts - 1];
    nlc_info info = {.struct_size = sizeof info};
    w->overlap[w->contacts - 1] = NAN;
    const nlc_status status = nlc_solve(w->network, w->force, w->nonlocal, w->overlap, w->normal, &info);
    if (status != NLC_ERROR_OVERLAP || info.culprit != w->contacts - 1)
        fail("the last contact's fault", status, (double)info.culprit);
    w->overlap[w->contacts - 1] = kept;
}

/* With what rounding loses: rows of cells are not in balance one by one, and the same is lost on each of a row's periods. */
static void add(double *sum, double *lost, double x)
{
    const double before = *sum;
    *sum += x;
    *lost += fabs(before) >= fabs(x) ? (before - *sum) + x : (x - *sum) + before;
}

static double find_largest_sum(const crystal *w, double largest)
{
    double sum[3] = {0}, lost[3] = {0}, most = 0, *F = calloc((size_t)w->particles, 3 * sizeof *F);
    if (!F) fail("out of memory", (double)w->particles, 0);
    const nlc_status status = nlc_assemble(w->network, F, 0, NULL, w->force, w->normal, NULL);
    if (status != NLC_OK) fail(nlc_strerror(status), status, 0);
    for (int64_t k = 0; k < w->particles; k++)
        for (int d = 0; d < 3; d++) add(&sum[d], &lost[d], F[3 * k + d]);
    free(F);
    for (int d = 0; d < 3; d++) most = fmax(most, fabs(sum[d] + lost[d]));
    return most / largest;
}

static void release(crystal *w)
{
    free(w->radius), free(w->overlap), free(w->normal), free(w->force), free(w->nonlocal), free(w->i), free(w->j),
        free(w->memory);
}

int main(int argc, char **argv)
{
    if (argc > 3 || (argc > 2 && strcmp(argv[2], "lean") != 0)) fail("usage: contacts [COUNT [lean]]", argc, 0);
    const double wanted = argc > 1 ? strtod(argv[1], NULL) : 1e5;
    double since = 0, largest = 0, worst = 0;
    crystal small = {.method = NLC_METHOD_AUTOMATIC}, large = {.method = argc > 2 ? NLC_METHOD_FIXED_POINT : NLC_METHOD_AUTOMATIC};
    int64_t cells = PERIOD;
    while ((double)(SPHERES * EACH * cells * cells * cells) < wanted) cells += PERIOD;
    make(&small, PERIOD);
    solve(&small, &since);
    make(&large, cells);
    const nlc_info info = solve(&large, &since);
    for (int64_t c = 0; c < small.contacts; c++) largest = small.force[c] > largest ? small.force[c] : largest;
    for (int64_t c = 0; c < large.contacts; c++) {
        const double d = fabs(large.force[c] - small.force[alike(cells, c)]) / largest;
        if (!(d <= 2 * tolerance)) fail("forces of alike contacts", large.force[c], small.force[alike(cells, c)]);
        worst = d > worst ? d : worst;
    }
    const double sum = find_largest_sum(&large, largest);
    if (!(sum <= 1e-16 * (double)large.contacts)) fail("the sum of all forces", sum, largest);
    find_last_fault(&large);
    say("compared", &since);
    printf("contacts: %lld in one network of %.3g GB, %.0f bytes each: %lld sweeps, forces within %.2g of those of %lld "
           "contacts\n",
           (long long)large.contacts, 1e-9 * (double)large.size, (double)large.size / (double)large.contacts,
           (long long)info.sweeps, worst, (long long)small.contacts);
    release(&small), release(&large);
    return 0;
}
