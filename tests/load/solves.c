/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * solves.c - very many small networks of every kind, one after the other.
 *
 *     solves [COUNT [SEED]]     so many networks; default 1e4, 1
 *
 * Each is solved from zeros, again a little further from where that has ended, and there from zeros by [GC] Algorithm 1.
 * Demanded: the status is one that the header names for such an input, and no input that is right gives an error; where two of
 * them converge they find the same forces, to their tolerances: relative to the largest force on either particle; one network
 * in eight has something wrong with it, which is named, and its culprit, with nothing else changed; no byte beyond the
 * network's memory changes, and the process does not grow. Not compared are states with contacts that are too close or a
 * coupling that was weakened, and those of contacts stiffer than Hertz': they may have several solutions.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "nlcontact.h"
#include "random.h"

enum { PARTICLES = 7, WALLS = 2, CONTACTS = 24, MATERIALS = 3, GUARD = 64 };

typedef struct random_network {
    double radius[PARTICLES], stiffness[CONTACTS], overlap[CONTACTS], later[CONTACTS], normal[3 * CONTACTS];
    int32_t material[PARTICLES], wall_material[WALLS], i[CONTACTS], j[CONTACTS];
    nlc_material materials[MATERIALS];
    nlc_particles particles;
    nlc_options options;
    int64_t contacts;
    unsigned char *memory;
    size_t size;
} random_network;

typedef struct result {
    double force[CONTACTS], nonlocal[CONTACTS];
    nlc_status status;
} result;

static uint64_t seed;
static int64_t number; /* of the network */
static int64_t solves, weakened, close_by, unconverged, compared, by_fixed_point, wrong;

static void fail(const char *what, double a, double b)
{
    fprintf(stderr, "solves: network %lld of seed %llu: %s: %.17g, %.17g\n", (long long)number, (unsigned long long)seed, what,
            a, b);
    exit(1);
}

static void set_direction(double n[3])
{
    double square;
    do {
        for (int x = 0; x < 3; x++) n[x] = uniform(-1, 1);
        square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    } while (square > 1 || square < 0.01);
    for (int x = 0; x < 3; x++) n[x] /= sqrt(square);
}

/* Whether two contacts, or the two sides of one, touch the same particle less than some 35 degrees from each other. */
static int crowded(const random_network *w, int64_t c)
{
    for (int64_t d = 0; d <= c; d++)
        for (int side = 0; side < 4; side++) {
            const int s = side & 1, t = side >> 1;
            const int32_t on = s ? w->j[c] : w->i[c], at = t ? w->j[d] : w->i[d];
            if (on != at || (c == d && s == t)) continue;
            double cosine = 0;
            for (int x = 0; x < 3; x++) cosine += w->normal[3 * c + x] * w->normal[3 * d + x];
            if ((s == t ? cosine : -cosine) > 0.82) return 1;
        }
    return 0;
}

static const nlc_material *material_of(const random_network *w, int32_t body)
{
    return &w->materials[body < w->particles.count ? w->material[body] : w->wall_material[body - w->particles.count]];
}

static double radius_of(const random_network *w, int32_t body)
{
    return body < w->particles.count ? w->radius[body] : INFINITY;
}

static double stiffness_of(const random_network *w, int64_t c)
{
    const nlc_material *a = material_of(w, w->i[c]), *b = material_of(w, w->j[c]);
    return nlc_hertz_stiffness(a->young, a->poisson, radius_of(w, w->i[c]), b->young, b->poisson, radius_of(w, w->j[c]));
}

static void make_contacts(random_network *w, double length)
{
    const int64_t bodies = w->particles.count + w->particles.wall_count, wanted = below(CONTACTS + 1);
    const double deep =
        pow(2, uniform(-10, next() % 4 ? -4 : -2)) * length; /* one in four beyond what elasticity is good for */
    w->contacts = 0;
    for (int tries = 0; tries < 200 && w->contacts < wanted; tries++) {
        const int64_t c = w->contacts;
        w->i[c] = (int32_t)below(w->particles.count);
        w->j[c] = (int32_t)below(bodies);
        if (w->j[c] < w->particles.count && next() % 4 == 0) { /* a wall comes second, a particle anywhere */
            const int32_t kept = w->i[c];
            w->i[c] = w->j[c];
            w->j[c] = kept;
        }
        set_direction(w->normal + 3 * c);
        if (crowded(w, c) || !(stiffness_of(w, c) > 0)) continue; /* not between two rigid bodies */
        w->stiffness[c] = uniform(1, 8) * stiffness_of(w, c);
        w->overlap[c] = uniform(-0.3, 1) * deep;
        w->later[c] = w->overlap[c] + uniform(-0.1, 0.1) * deep;
        w->contacts++;
    }
}

static void make(random_network *w)
{
    const double length = ldexp(1, 2 * (int)below(41) - 40), modulus = ldexp(1, 2 * (int)below(41) - 40);
    w->particles = (nlc_particles){.struct_size = sizeof w->particles,
                                   .count = 1 + below(1 + below(PARTICLES)),
                                   .radius = w->radius,
                                   .material = w->material,
                                   .materials = w->materials,
                                   .material_count = MATERIALS,
                                   .wall_material = w->wall_material,
                                   .wall_count = below(WALLS + 1)};
    for (int m = 0; m < MATERIALS; m++) w->materials[m] = (nlc_material){modulus * uniform(1, 100), uniform(0, 0.5)};
    if (next() % 4 == 0) w->materials[0].young = INFINITY;
    for (int k = 0; k < PARTICLES; k++) {
        w->radius[k] = length * uniform(1, 1.6);
        w->material[k] = (int32_t)below(MATERIALS);
    }
    for (int k = 0; k < WALLS; k++) w->wall_material[k] = (int32_t)below(MATERIALS);
    w->options = (nlc_options){.struct_size = sizeof w->options,
                               .model = (int32_t)below(nlc_model_count()),
                               .simd = (int32_t)below(5),
                               .points = (int32_t)below(2),
                               .prefactor = uniform(0.3, 1),
                               .tolerance = pow(10, uniform(-12, -3))};
    make_contacts(w, length);
    if (next() % 8 == 0) w->options.stiffness = w->stiffness;
}

/* Builds the network at the end of memory of just its size. */
static nlc_network *build(random_network *w, nlc_status expected, int64_t culprit)
{
    nlc_network *n = NULL;
    nlc_info info = {.struct_size = sizeof info};
    const nlc_status status =
        nlc_network_init(&n, w->memory, w->size, &w->particles, w->i, w->j, w->contacts, &w->options, &info);
    if (status != expected) fail(nlc_strerror(status), expected, status);
    if (info.culprit != culprit) fail("the culprit of nlc_network_init", (double)culprit, (double)info.culprit);
    return n;
}

static void check_guard(const random_network *w)
{
    for (int b = 0; b < GUARD; b++)
        if (w->memory[w->size + (size_t)b] != 0xa5) fail("a byte behind the network's memory", b, 0);
}

static void solve(const random_network *w, nlc_network *n, result *r, const double *overlap)
{
    nlc_info info = {.struct_size = sizeof info};
    r->status = nlc_solve(n, r->force, r->nonlocal, overlap, w->normal, &info);
    solves++;
    if (r->status < 0) fail(nlc_strerror(r->status), r->status, (double)info.culprit);
    int64_t active = 0;
    for (int64_t c = 0; c < w->contacts; c++) {
        if (!(r->force[c] >= 0 && r->force[c] <= 1e300) || !(fabs(r->nonlocal[c]) <= 1e300))
            fail("a force", r->force[c], r->nonlocal[c]);
        active += r->force[c] > 0;
    }
    if (info.active != active) fail("info.active", (double)active, (double)info.active);
    if (((r->status & NLC_WARNING_WEAKENED) != 0) != (info.coupling < 1)) fail("a coupling", info.coupling, r->status);
    const double most = r->status & NLC_WARNING_NOT_CONVERGED ? INFINITY
                        : r->status & NLC_WARNING_ROUNDING    ? 1e-9
                                                              : w->options.tolerance;
    if (!(info.residual <= most)) fail("a residual", info.residual, r->status);
}

/* Forces of two solutions: each is off by the tolerance, times factor; and so is the largest force that this is relative to. */
static void compare(const random_network *w, const result *a, const result *b, double factor, const char *what)
{
    if (w->options.stiffness || (a->status | b->status) & ~NLC_WARNING_ROUNDING) return;
    double largest[PARTICLES + WALLS] = {0};
    for (int64_t c = 0; c < w->contacts; c++) {
        const double p = a->force[c] > b->force[c] ? a->force[c] : b->force[c];
        if (p > largest[w->i[c]]) largest[w->i[c]] = p;
        if (p > largest[w->j[c]]) largest[w->j[c]] = p;
    }
    for (int64_t c = 0; c < w->contacts; c++) {
        const int32_t i = w->i[c], j = w->j[c];
        const double most = j < w->particles.count && largest[j] > largest[i] ? largest[j] : largest[i];
        const double tolerance = w->options.tolerance > 1e-13 ? w->options.tolerance : 1e-13;
        if (!(fabs(a->force[c] - b->force[c]) <= factor * tolerance * most)) fail(what, a->force[c] / most, b->force[c] / most);
    }
    compared++;
}

static void solve_all(random_network *w, nlc_network *n)
{
    result from_zeros = {.status = 0}, warm, cold = {.status = 0}, fixed = {.status = 0};
    solve(w, n, &from_zeros, w->overlap);
    warm = from_zeros;
    solve(w, n, &warm, w->later);
    solve(w, n, &cold, w->later);
    compare(w, &warm, &cold, 2, "forces from two starts");
    weakened += (cold.status & NLC_WARNING_WEAKENED) != 0;
    close_by += (cold.status & NLC_WARNING_CLOSE) != 0;
    unconverged += (cold.status & NLC_WARNING_NOT_CONVERGED) != 0;
    if (cold.status & NLC_WARNING_NOT_CONVERGED && !w->options.stiffness) fail("not converged", cold.status, w->options.model);
    w->options.method = NLC_METHOD_FIXED_POINT;
    w->options.max_sweeps = 10000;
    if (nlc_set_options(n, &w->options, NULL) != NLC_OK) fail("nlc_set_options", 0, 0);
    solve(w, n, &fixed, w->later);
    by_fixed_point += (fixed.status & NLC_WARNING_NOT_CONVERGED) == 0;
    compare(w, &cold, &fixed, 4, "forces by two methods");
}

/* What is wrong is found, and nothing changes but info. */
static void solve_wrong(random_network *w, nlc_network *n)
{
    static const double odd[] = {NAN, -NAN, INFINITY, -INFINITY};
    const double value = odd[below(4)];
    const int64_t c = below(w->contacts);
    result r = {.status = 0}, before;
    nlc_info info = {.struct_size = sizeof info};
    nlc_status expected = NLC_ERROR_OVERLAP;
    for (int64_t k = 0; k < w->contacts; k++) r.nonlocal[k] = 1e-3 * w->overlap[k];
    const int64_t what = below(4);
    if (what == 0) {
        w->overlap[c] = value;
    } else if (what == 1) {
        w->normal[3 * c + below(3)] = value;
        expected = NLC_ERROR_NORMAL;
    } else if (what == 2) {
        for (int x = 0; x < 3; x++) w->normal[3 * c + x] *= 1.00001; /* not a unit vector */
        expected = NLC_ERROR_NORMAL;
    } else {
        r.nonlocal[c] = value;
        expected = NLC_ERROR_NONLOCAL;
    }
    before = r;
    const nlc_status status = nlc_solve(n, r.force, r.nonlocal, w->overlap, w->normal, &info);
    if (status != expected) fail(nlc_strerror(status), expected, status);
    if (info.culprit != c) fail("the culprit of nlc_solve", (double)c, (double)info.culprit);
    if (memcmp(&r, &before, offsetof(result, status)) != 0) fail("an error changes results", status, 0);
    wrong++;
}

static void build_wrong(random_network *w)
{
    const int64_t c = below(w->contacts), k = below(w->particles.count), what = below(4);
    nlc_status expected = NLC_ERROR_INDEX;
    if (what == 0) {
        w->i[c] = (int32_t)(next() % 2 ? -1 - below(1000) : w->particles.count + w->particles.wall_count + below(1000));
    } else if (what == 1) {
        w->radius[k] = next() % 2 ? -w->radius[k] : NAN;
        expected = NLC_ERROR_RADIUS;
    } else if (what == 2) {
        w->material[k] = (int32_t)(next() % 2 ? -1 : MATERIALS);
        expected = NLC_ERROR_MATERIAL;
    } else {
        w->options.model = nlc_model_count();
        expected = NLC_ERROR_MODEL;
    }
    build(w, expected, what == 0 ? c : what == 3 ? w->options.model : k);
    wrong++;
}

static void try_one(random_network *w)
{
    make(w);
    w->size = nlc_network_size(&w->particles, w->contacts, &w->options);
    w->memory = malloc(w->size + GUARD);
    if (w->size == 0 || !w->memory) fail("memory", (double)w->size, 0);
    memset(w->memory, 0xa5, w->size + GUARD);
    const int64_t what = w->contacts > 0 ? below(16) : 2;
    if (what == 1) {
        build_wrong(w);
    } else {
        nlc_network *n = build(w, NLC_OK, -1);
        if (what == 0)
            solve_wrong(w, n);
        else
            solve_all(w, n);
    }
    check_guard(w);
    free(w->memory);
}

static double megabytes(void)
{
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return (double)u.ru_maxrss / 1024;
}

int main(int argc, char **argv)
{
    static random_network w;
    const int64_t count = argc > 1 ? (int64_t)strtod(argv[1], NULL) : 10000;
    double before = 0;
    seed = argc > 2 ? strtoull(argv[2], NULL, 0) : 1;
    for (number = 0; number < count; number++) {
        state = seed * UINT64_C(0x2545f4914f6cdd1d) + (uint64_t)number * UINT64_C(0xd1342543de82ef95);
        try_one(&w);
        if (number == count / 10) before = megabytes();
    }
    const double grown = megabytes() - before;
    printf("solves: %lld networks, %lld solves, %lld wrong inputs: %lld comparisons, %lld times the fixed point converged; "
           "%lld weakened, "
           "%lld close, %lld not converged; grown by %.1f MB\n",
           (long long)count, (long long)solves, (long long)wrong, (long long)compared, (long long)by_fixed_point,
           (long long)weakened, (long long)close_by, (long long)unconverged, grown);
    if (grown > 1) fail("the process has grown", grown, 0);
    return 0;
}
