/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_cache.c - kept coefficients: whatever the room and whatever was in it, the bits of the results are those without.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

static const int32_t models[] = {NLC_MODEL_SPHERE, NLC_MODEL_POINT_FORCE, NLC_MODEL_GONZALEZ_CUITINO, NLC_MODEL_LOVE};

/* Everything that functions return of a scene. */
typedef struct results {
    double *force, *nonlocal, *again, *displacement, *change, energy;
    nlc_status status[5];
    nlc_info info;
} results;

static double *room(const scene *s, int per_contact)
{
    double *p = calloc((size_t)(per_contact * s->contacts) + 1, sizeof *p);
    ck_assert_ptr_nonnull(p);
    return p;
}

static results compute(scene *s)
{
    results r = {.force = room(s, 1), .nonlocal = room(s, 1), .again = room(s, 1), .displacement = room(s, 2), .change = room(s, 1)};
    const size_t size = (size_t)s->contacts * sizeof(double);
    r.info.struct_size = sizeof r.info;
    r.status[0] = nlc_solve(s->network, r.force, r.nonlocal, s->overlap, s->normal, &r.info);
    memcpy(r.again, r.nonlocal, size);
    r.status[1] = nlc_solve(s->network, r.force, r.again, s->overlap, s->normal, NULL);
    r.status[2] = nlc_sweep(s->network, r.displacement, r.force, NULL, s->normal, NULL);
    r.status[3] = nlc_energy(s->network, &r.energy, r.force, s->overlap, s->normal, NULL);
    r.status[4] = nlc_tangent(s->network, r.change, s->overlap, r.force, s->normal, NULL);
    return r;
}

static void release(results r)
{
    free(r.force), free(r.nonlocal), free(r.again), free(r.displacement), free(r.change);
}

static void compare(const scene *s, const results *a, const results *b)
{
    const size_t size = (size_t)s->contacts * sizeof(double);
    ck_assert_int_eq(memcmp(a->status, b->status, sizeof a->status), 0);
    ck_assert_int_eq(memcmp(&a->info, &b->info, sizeof a->info), 0);
    ck_assert_int_eq(memcmp(a->force, b->force, size), 0);
    ck_assert_int_eq(memcmp(a->nonlocal, b->nonlocal, size), 0);
    ck_assert_int_eq(memcmp(a->again, b->again, size), 0);
    ck_assert_int_eq(memcmp(a->displacement, b->displacement, 2 * size), 0);
    ck_assert_int_eq(memcmp(a->change, b->change, size), 0);
    nlc_assert_same(a->energy, b->energy);
}

#define MARK 0x5aa5

/* With a cache of so many bytes, full of NaN at first, and a mark behind it that stays. */
static results compute_with(scene *s, size_t size)
{
    unsigned char *cache = malloc(size + sizeof(uint64_t) + 8);
    const uint64_t mark = MARK;
    ck_assert_ptr_nonnull(cache);
    memset(cache, 0xff, size);
    memcpy(cache + size, &mark, sizeof mark);
    s->options.cache = cache;
    s->options.cache_size = size;
    ck_assert_int_eq(nlc_set_options(s->network, &s->options, NULL), NLC_OK);
    release(compute(s)); /* what it leaves in the cache must not matter in the next */
    double *turned = room(s, 3);
    for (int64_t c = 0; c < s->contacts; c++) turned[3 * c + c % 3] = 1; /* other normals, many of them the same: refused or not */
    nlc_solve(s->network, turned, turned + s->contacts, s->overlap, s->normal, NULL);
    free(turned);
    const results r = compute(s);
    ck_assert_int_eq(memcmp(cache + size, &mark, sizeof mark), 0);
    s->options.cache = NULL;
    s->options.cache_size = 0;
    ck_assert_int_eq(nlc_set_options(s->network, &s->options, NULL), NLC_OK);
    free(cache);
    return r;
}

static void all_sizes(scene *s)
{
    ck_assert_int_eq(scene_build(s), NLC_OK);
    const results plain = compute(s);
    const size_t whole = nlc_cache_size(s->network), size[] = {whole, whole + 8, whole / 2 / 8 * 8 + 3, 8, 0};
    for (int k = 0; k < 5; k++) {
        const results kept = compute_with(s, size[k]);
        compare(s, &plain, &kept);
        release(kept);
    }
    release(plain);
}

/* A dense packing, solved as a whole; a loose one, in clusters; and one of which only a part moves. */
START_TEST(packings)
{
    static const char *const name[] = {"b_die125_rd0.80.csv", "b_die125_rd0.56.csv", "b_die125_rd0.70.csv"};
    scene s;
    scene_init(&s);
    s.options.model = models[_i / 3];
    scene_packing(&s, name[_i % 3], 0.3);
    all_sizes(&s);
    scene_free(&s);
}
END_TEST

/* More contacts than a block holds, which are never kept, beside others that are. */
START_TEST(crowd)
{
    rng g = {5};
    scene s;
    scene_init(&s);
    s.options.model = models[_i];
    const int32_t m = scene_material(&s, 1, 0.3), centre = scene_particle(&s, 1, m);
    for (int k = 0; k < 90; k++) {
        double v[3];
        rng_unit(&g, v);
        scene_contact(&s, centre, scene_particle(&s, 0.1, m), 1e-4, v[0], v[1], v[2]);
        scene_contact(&s, k + 1, scene_particle(&s, 0.1, m), 1e-4, v[1], v[2], v[0]);
    }
    all_sizes(&s);
    scene_free(&s);
}
END_TEST

/* Two numbers for each pair of contacts of a particle, or one in each lane of a vector. */
START_TEST(size)
{
    const double stretch[3] = {0.98, 0.98, 0.98};
    scene s;
    scene_init(&s);
    scene_cell(&s, SIMPLE_CUBIC, 1, 1, 0.3, stretch); /* one sphere, six sides */
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    ck_assert_uint_eq(nlc_cache_size(s.network) % (15 * 2 * sizeof(double)), 0);
    ck_assert_uint_le(nlc_cache_size(s.network), 15 * 8 * sizeof(double));
    s.options.simd = NLC_SIMD_GENERIC;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, NULL), NLC_OK);
    ck_assert_uint_eq(nlc_cache_size(s.network), 0);
    s.options.model = NLC_MODEL_SPHERE;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, NULL), NLC_OK);
    ck_assert_uint_eq(nlc_cache_size(s.network), 15 * 2 * sizeof(double));
    ck_assert_uint_eq(nlc_cache_size(NULL), 0);
    ck_assert_uint_eq(nlc_cache_size((const nlc_network *)stretch), 0);
    scene_free(&s);
}
END_TEST

START_TEST(what_is_refused)
{
    double cache[4];
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    const int32_t m = scene_material(&s, 1, 0.3);
    scene_contact(&s, scene_particle(&s, 1, m), scene_particle(&s, 1, m), 0.1, 0, 0, 1);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    s.options.cache_size = 8;
    nlc_assert_quiet(ck_assert_int_eq(nlc_set_options(s.network, &s.options, &info), NLC_ERROR_OPTION));
    ck_assert_int_eq(info.culprit, offsetof(nlc_options, cache_size));
    s.options.cache = (char *)cache + 3;
    nlc_assert_quiet(ck_assert_int_eq(nlc_set_options(s.network, &s.options, &info), NLC_ERROR_ALIGNMENT));
    ck_assert_int_eq(info.culprit, 3);
    s.options.cache = cache;
    s.options.reserved = cache;
    nlc_assert_quiet(ck_assert_int_eq(nlc_set_options(s.network, &s.options, &info), NLC_ERROR_OPTION));
    ck_assert_int_eq(info.culprit, offsetof(nlc_options, reserved));
    s.options.reserved = NULL;
    s.options.cache = cache;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, &info), NLC_OK);
    scene_free(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cache");
    TCase *t = tcase_create("cache");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    tcase_add_loop_test(t, packings, 0, 12);
    tcase_add_loop_test(t, crowd, 0, 4);
    tcase_add_test(t, size);
    tcase_add_test(t, what_is_refused);
    time_limit(t, 60);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
