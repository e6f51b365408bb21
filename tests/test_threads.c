/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_threads.c - the host's threads: the same bits whoever does what; and many threads at once, on networks of their own or
 * reading one.  Meant to be run under ThreadSanitizer, too.
 */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

enum { MOST = 7 };

/* ---- a host's loop over threads; each takes the next task, from the front or from behind */

typedef struct pool {
    int threads;
    bool backwards;
    int64_t calls, tasks; /* what was asked for */
} pool;

typedef struct loop {
    void (*task)(void *, int64_t);
    void *work;
    int64_t count;
    bool backwards;
    atomic_int_least64_t next;
} loop;

static void *take_tasks(void *argument)
{
    loop *l = argument;
    for (int64_t k; (k = atomic_fetch_add(&l->next, 1)) < l->count;) l->task(l->work, l->backwards ? l->count - 1 - k : k);
    return NULL;
}

static void parallel_for(void *context, void (*task)(void *, int64_t), void *work, int64_t count)
{
    pool *p = context;
    pthread_t thread[MOST];
    loop l = {.task = task, .work = work, .count = count, .backwards = p->backwards};
    p->calls++;
    p->tasks += count;
    for (int t = 1; t < p->threads; t++) ck_assert_int_eq(pthread_create(&thread[t], NULL, take_tasks, &l), 0);
    take_tasks(&l);
    for (int t = 1; t < p->threads; t++) ck_assert_int_eq(pthread_join(thread[t], NULL), 0);
}

/* ---- the same bits */

typedef struct results {
    double *force, *nonlocal, *again, *displacement;
    nlc_status status[3];
    nlc_info info[2];
} results;

static double *room(const scene *s, int per_contact)
{
    double *p = calloc((size_t)(per_contact * s->contacts) + 1, sizeof *p);
    ck_assert_ptr_nonnull(p);
    return p;
}

/* From zeros; from a start that is nearly right; a sweep. */
static results compute(const scene *s)
{
    results r = {.force = room(s, 1), .nonlocal = room(s, 1), .again = room(s, 1), .displacement = room(s, 2)};
    r.info[0].struct_size = r.info[1].struct_size = sizeof r.info[0];
    r.status[0] = nlc_solve(s->network, r.force, r.nonlocal, s->overlap, s->normal, &r.info[0]);
    for (int64_t c = 0; c < s->contacts; c++) r.again[c] = r.nonlocal[c] * (1 + 1e-5 * (double)(c % 7));
    r.status[1] = nlc_solve(s->network, r.force, r.again, s->overlap, s->normal, &r.info[1]);
    r.status[2] = nlc_sweep(s->network, r.displacement, r.force, s->overlap, s->normal, NULL);
    return r;
}

static void release(results r)
{
    free(r.force), free(r.nonlocal), free(r.again), free(r.displacement);
}

static void compare(const scene *s, const results *a, const results *b)
{
    const size_t size = (size_t)s->contacts * sizeof(double);
    ck_assert_int_eq(memcmp(a->status, b->status, sizeof a->status), 0);
    ck_assert_int_eq(memcmp(a->info, b->info, sizeof a->info), 0);
    ck_assert_int_eq(memcmp(a->force, b->force, size), 0);
    ck_assert_int_eq(memcmp(a->nonlocal, b->nonlocal, size), 0);
    ck_assert_int_eq(memcmp(a->again, b->again, size), 0);
    ck_assert_int_eq(memcmp(a->displacement, b->displacement, 2 * size), 0);
}

/* With so many threads, whose tasks are more than one in some of the loops. */
static void try_pools(scene *s)
{
    ck_assert_int_eq(scene_build(s), NLC_OK);
    const results alone = compute(s);
    ck_assert_int_ge(alone.status[0], 0);
    for (int threads = 1; threads <= MOST; threads += threads == 1 ? 2 : 4) {
        pool p = {.threads = threads, .backwards = threads % 2};
        s->options.parallel_for = parallel_for;
        s->options.parallel_context = &p;
        ck_assert_int_eq(nlc_set_options(s->network, &s->options, NULL), NLC_OK);
        const results shared = compute(s);
        compare(s, &alone, &shared);
        release(shared);
        ck_assert_int_gt(p.calls, 0);
        ck_assert_int_gt(p.tasks, 2 * p.calls - 1);
    }
    s->options.parallel_for = NULL;
    release(alone);
}

static const int32_t models[] = {NLC_MODEL_GONZALEZ_CUITINO, NLC_MODEL_SPHERE, NLC_MODEL_POINT_FORCE, NLC_MODEL_HALF_SPACE, NLC_MODEL_LOVE};

/* A crystal of 1728 spheres, 10368 contacts: four windows and two slabs. */
START_TEST(whoever_does_it)
{
    rng g = {3};
    for (int simd = NLC_SIMD_BEST; simd <= NLC_SIMD_GENERIC; simd++) {
        scene s;
        scene_init(&s);
        s.options.model = models[_i / 2];
        s.options.simd = simd;
        s.options.points = NLC_POINTS_UNDEFORMED;
        s.options.tolerance = 1e-6;
        scene_lattice(&s, FACE_CENTRED, 7 + _i % 2, 1, 0.3, _i % 2 ? 0.02 : 0.005, 1e-3, &g);
        void *cache = malloc(1 << 22);
        s.options.cache = _i % 2 ? cache : NULL;
        s.options.cache_size = _i % 2 ? 1 << 22 : 0;
        try_pools(&s);
        free(cache);
        scene_free(&s);
    }
}
END_TEST

/* A start far beyond what can be is cut by the largest overlap on a contact's particles. */
START_TEST(far_starts_by_many)
{
    rng g = {5};
    pool p = {.threads = 3};
    scene s;
    scene_init(&s);
    s.options.tolerance = 1e-6;
    scene_lattice(&s, FACE_CENTRED, 6, 1, 0.3, 0.02, 1e-2, &g);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    double *force[2], *g_found[2];
    for (int shared = 0; shared < 2; shared++) {
        force[shared] = room(&s, 1);
        g_found[shared] = room(&s, 1);
        s.options.parallel_for = shared ? parallel_for : NULL;
        s.options.parallel_context = &p;
        ck_assert_int_eq(nlc_set_options(s.network, &s.options, NULL), NLC_OK);
        for (int64_t c = 0; c < s.contacts; c++) g_found[shared][c] = 100 * s.overlap[c];
        ck_assert_int_eq(nlc_solve(s.network, force[shared], g_found[shared], s.overlap, s.normal, NULL), NLC_OK);
    }
    ck_assert_int_eq(memcmp(force[0], force[1], (size_t)s.contacts * sizeof **force), 0);
    ck_assert_int_eq(memcmp(g_found[0], g_found[1], (size_t)s.contacts * sizeof **force), 0);
    for (int shared = 0; shared < 2; shared++) free(force[shared]), free(g_found[shared]);
    scene_free(&s);
}
END_TEST

/* Past the end of the stable branch, where the coupling is weakened. */
START_TEST(weakened_by_many)
{
    rng g = {4};
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    scene_lattice(&s, FACE_CENTRED, 7, 1, 0.45, 0.1, 1e-3, &g);
    s.options.tolerance = 1e-4;
    ck_assert_int_eq(scene_solve(&s, &info) & NLC_WARNING_WEAKENED, NLC_WARNING_WEAKENED);
    try_pools(&s);
    scene_free(&s);
}
END_TEST

/* Spheres with so many contacts that looks at them grow trees, for which there is room once. */
START_TEST(crowds_by_many)
{
    enum { CROWDS = 4, CONTACTS = 600 };
    scene s;
    scene_init(&s);
    s.options.tolerance = 1e-8;
    const int32_t m = scene_material(&s, 1e9, 0.3);
    int32_t centre[CROWDS];
    for (int q = 0; q < CROWDS; q++) {
        centre[q] = scene_particle(&s, 1, m);
        for (int k = 0; k < CONTACTS; k++) scene_particle(&s, 0.01, m); /* a window of particles and more lies between two */
    }
    for (int q = 0; q < CROWDS; q++)
        for (int k = 0; k < CONTACTS; k++) {
            const double z = 1 - (2 * k + 1.0) / CONTACTS, r = sqrt(1 - z * z), angle = 2.399963229728653 * k;
            scene_contact(&s, centre[q], centre[q] + 1 + k, 1e-4, r * cos(angle), r * sin(angle), z);
        }
    for (int q = 1; q < CROWDS; q++) scene_contact(&s, centre[q - 1], centre[q] + CONTACTS / 2 + q, 1e-4, 0.5, 0.5, 0.7 + 1e-3 * q);
    try_pools(&s);
    scene_free(&s);
}
END_TEST

/* Two contacts in the same direction, on particles of later windows: the same culprit. */
START_TEST(same_error)
{
    rng g = {5};
    scene s;
    scene_init(&s);
    scene_lattice(&s, FACE_CENTRED, 8, 1, 0.3, 0.01, 0, &g);
    for (int64_t c = 0; c < s.contacts; c++)
        if (c == 7801) memcpy(s.normal + 3 * c, s.normal + 3 * (c - 1), 3 * sizeof *s.normal);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    const results alone = compute(&s);
    ck_assert_int_eq(alone.status[0], NLC_ERROR_COINCIDENT);
    pool p = {.threads = 3, .backwards = true};
    s.options.parallel_for = parallel_for;
    s.options.parallel_context = &p;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, NULL), NLC_OK);
    const results shared = compute(&s);
    compare(&s, &alone, &shared);
    release(alone), release(shared);
    scene_free(&s);
}
END_TEST

/* ---- many threads at once */

typedef struct one {
    int number;
    double total;
} one;

static double solve_own(int number)
{
    rng g = {(uint64_t)number % 3 + 1};
    scene s;
    scene_init(&s);
    s.options.model = models[number % 2];
    scene_lattice(&s, BODY_CENTRED, 3, 1, 0.3, 0.02, 1e-3, &g);
    const nlc_status status = scene_solve(&s, NULL);
    const double total = status == NLC_OK ? scene_total(&s) : 0;
    scene_free(&s);
    return total;
}

static void *solve_one(void *argument)
{
    one *o = argument;
    o->total = solve_own(o->number);
    return NULL;
}

START_TEST(networks_of_their_own)
{
    pthread_t thread[6];
    one o[6];
    for (int t = 0; t < 6; t++) {
        o[t] = (one){.number = t};
        ck_assert_int_eq(pthread_create(&thread[t], NULL, solve_one, &o[t]), 0);
    }
    for (int t = 0; t < 6; t++) ck_assert_int_eq(pthread_join(thread[t], NULL), 0);
    for (int t = 0; t < 6; t++) {
        ck_assert(o[t].total > 0);
        nlc_assert_same(o[t].total, solve_own(t));
    }
}
END_TEST

/* What the functions that take a const nlc_network make of one. */
typedef struct reading {
    const scene *s;
    double *sliding;                     /* [contacts][3], read by all */
    double *F, *turned, *torque, *moved; /* [particles][3]; moved: [particles] */
    double reach;
    size_t cache_size;
    nlc_status status[4];
} reading;

static reading new_reading(const scene *s, double *sliding)
{
    reading r = {.s = s, .sliding = sliding};
    const size_t n = (size_t)s->particles;
    double **arrays[] = {&r.F, &r.turned, &r.torque, &r.moved};
    for (int k = 0; k < 4; k++) ck_assert_ptr_nonnull(*arrays[k] = malloc(3 * n * sizeof(double)));
    return r;
}

static void free_reading(reading r)
{
    free(r.F), free(r.turned), free(r.torque), free(r.moved);
}

static void *read_it(void *argument)
{
    reading *r = argument;
    const scene *s = r->s;
    const nlc_network *n = s->network;
    const size_t size = 3 * (size_t)s->particles * sizeof *r->F;
    for (int k = 0; k < 20; k++) {
        memset(r->F, 0, size), memset(r->turned, 0, size), memset(r->torque, 0, size), memset(r->moved, 0, size);
        r->status[0] = nlc_assemble(n, r->F, 0, NULL, s->force, s->normal, NULL);
        r->status[1] = nlc_assemble_turning(n, r->turned, 0, s->force, s->overlap, s->normal, NULL);
        r->status[2] = nlc_assemble_sliding(n, r->F, 0, r->torque, 0, NULL, s->force, s->normal, r->sliding, NULL, s->overlap, 0.3,
                                            NULL);
        r->status[3] = nlc_reach(n, &r->reach, r->moved, s->force, NULL);
        r->cache_size = nlc_cache_size(n);
    }
    return NULL;
}

static void compare_readings(const reading *a, const reading *b)
{
    const size_t size = 3 * (size_t)a->s->particles * sizeof *a->F;
    for (int k = 0; k < 4; k++) ck_assert_int_eq(b->status[k], NLC_OK);
    ck_assert_int_eq(memcmp(a->F, b->F, size), 0);
    ck_assert_int_eq(memcmp(a->turned, b->turned, size), 0);
    ck_assert_int_eq(memcmp(a->torque, b->torque, size), 0);
    ck_assert_int_eq(memcmp(a->moved, b->moved, size), 0);
    nlc_assert_same(a->reach, b->reach);
    ck_assert_uint_eq(a->cache_size, b->cache_size);
}

START_TEST(one_network_read_by_many)
{
    rng g = {6};
    scene s;
    pthread_t thread[4];
    reading r[5]; /* the last one by nobody else */
    scene_init(&s);
    s.options.model = models[_i];
    scene_lattice(&s, BODY_CENTRED, 4, 1, 0.3, 0.02, 1e-3, &g);
    ck_assert_int_eq(scene_solve(&s, NULL), NLC_OK);
    double *sliding = room(&s, 3);
    for (int64_t c = 0; c < s.contacts; c++) { /* across the normal */
        const double *v = s.normal + 3 * c, across = sqrt(v[0] * v[0] + v[1] * v[1]);
        if (across > 0.1) sliding[3 * c] = -v[1] / across, sliding[3 * c + 1] = v[0] / across;
    }
    for (int t = 0; t < 5; t++) r[t] = new_reading(&s, sliding);
    read_it(&r[4]);
    for (int t = 0; t < 4; t++) ck_assert_int_eq(pthread_create(&thread[t], NULL, read_it, &r[t]), 0);
    for (int t = 0; t < 4; t++) ck_assert_int_eq(pthread_join(thread[t], NULL), 0);
    for (int t = 0; t < 4; t++) compare_readings(&r[4], &r[t]);
    ck_assert(r[4].reach > 0);
    for (int t = 0; t < 5; t++) free_reading(r[t]);
    free(sliding);
    scene_free(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("threads");
    TCase *t = tcase_create("threads");
    tcase_add_loop_test(t, whoever_does_it, 0, 10);
    tcase_add_test(t, far_starts_by_many);
    tcase_add_test(t, weakened_by_many);
    tcase_add_test(t, crowds_by_many);
    tcase_add_test(t, same_error);
    tcase_add_test(t, networks_of_their_own);
    tcase_add_loop_test(t, one_network_read_by_many, 0, 2);
    time_limit(t, 120);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
