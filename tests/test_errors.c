/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_errors.c - every kind of bad input gets its own status and the index of the culprit, and changes nothing.
 *
 * Floating-point traps are on throughout: a check that compares a NaN would end the program.
 */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

#define STATUSES 64
static bool met[STATUSES]; /* errors that the tests have caused, by -status */

/* A scene of 4 particles and a wall, 5 contacts, with everything that a call reads and writes. */
typedef struct fixture {
    scene s;
    nlc_particles view;
    nlc_options options;
    nlc_info info;
    size_t size;
    double force[5], nonlocal[5], displacement[10], sliding[15], F[12], torque[12], F_wall[3], friction;
} fixture;

static fixture f;
static fixture before;
static void *memory_before;

static void setup(void)
{
    memset(&f, 0, sizeof f);
    scene_init(&f.s);
    const int32_t m = scene_material(&f.s, 1e6, 0.3), rigid = scene_material(&f.s, INFINITY, 0.2);
    scene_material(&f.s, -1, 7); /* not in use, so it may be anything */
    for (int k = 0; k < 4; k++) scene_particle(&f.s, 1 + 0.1 * k, k == 3 ? rigid : m);
    scene_wall(&f.s, rigid);
    scene_contact(&f.s, 0, 1, 0.01, 1, 0, 0);
    scene_contact(&f.s, 1, 2, 0.02, 0, 1, 0);
    scene_contact(&f.s, 2, 0, 0.01, -1, -1, 0);
    scene_contact(&f.s, 3, 0, -0.01, 0, 0, 1);
    scene_contact(&f.s, 4, 1, 0.01, 0, 0, 1);
    ck_assert_int_eq(scene_build(&f.s), NLC_OK);
    f.view = scene_view(&f.s);
    f.options.struct_size = sizeof f.options;
    f.info.struct_size = sizeof f.info;
    f.size = nlc_network_size(&f.view, f.s.contacts, &f.options);
    ck_assert_uint_gt(f.size, 0);
    for (int c = 0; c < 5; c++) f.force[c] = 1 + c;
    f.sliding[2] = f.sliding[5] = f.sliding[13] = 1; /* across the normals of 0, 1 and 4 */
    f.friction = 0.3;
    memory_before = malloc(f.size);
    ck_assert_ptr_nonnull(memory_before);
    fp_trap();
}

static void teardown(void)
{
    fp_untrap();
    scene_free(&f.s);
    free(memory_before);
}

/* A call must give this status and culprit, and change nothing but the info. */
static void keep(void)
{
    f.info = (nlc_info){.struct_size = sizeof f.info, .culprit = 12345};
    before = f;
    memcpy(memory_before, f.s.memory, f.size);
}

static void demand(nlc_status found, nlc_status status, int64_t culprit)
{
    ck_assert_msg(found == status, "status %d \"%s\", expected %d \"%s\"", found, nlc_strerror(found), status, nlc_strerror(status));
    ck_assert_int_eq(f.info.culprit, culprit);
    f.info = before.info;
    ck_assert_msg(memcmp(&f, &before, sizeof f) == 0, "%s: something was changed", nlc_strerror(status));
    if (status < 0 && status > -STATUSES) met[-status] = true;
}

static nlc_status init(void)
{
    return nlc_network_init(&f.s.network, f.s.memory, f.size, &f.view, f.s.i, f.s.j, f.s.contacts, &f.options, &f.info);
}

static nlc_status solve(void)
{
    return nlc_solve(f.s.network, f.force, f.nonlocal, f.s.overlap, f.s.normal, &f.info);
}

static nlc_status sweep(void)
{
    return nlc_sweep(f.s.network, f.displacement, f.force, f.s.overlap, f.s.normal, &f.info);
}

static nlc_status assemble(void)
{
    return nlc_assemble(f.s.network, f.F, 0, f.F_wall, f.force, f.s.normal, &f.info);
}

static nlc_status slide(void)
{
    return nlc_assemble_sliding(f.s.network, f.F, 0, f.torque, 0, f.F_wall, f.force, f.s.normal, f.sliding, f.displacement,
                                f.s.overlap, f.friction, &f.info);
}

/* Do something to the input, call, expect, undo.  The memory of the network must be as before. */
#define WITH(lvalue, bad, call, status, culprit)                                                                            \
    do {                                                                                                                    \
        __typeof__(lvalue) good_ = (lvalue);                                                                                \
        (lvalue) = (bad);                                                                                                   \
        keep();                                                                                                             \
        demand(call, status, culprit);                                                                                      \
        ck_assert(memcmp(memory_before, f.s.memory, f.size) == 0);                                                          \
        (lvalue) = good_;                                                                                                   \
    } while (0)

/* The same for calls that may use the network's work space. */
#define WITH_WORK(lvalue, bad, call, status, culprit)                                                                       \
    do {                                                                                                                    \
        __typeof__(lvalue) good_ = (lvalue);                                                                                \
        (lvalue) = (bad);                                                                                                   \
        keep();                                                                                                             \
        demand(call, status, culprit);                                                                                      \
        (lvalue) = good_;                                                                                                   \
    } while (0)

static const double not_finite[] = {NAN, -NAN, INFINITY, -INFINITY};

START_TEST(particles_and_contacts)
{
    const double bad_radius[] = {0, -1, NAN, INFINITY, -INFINITY, -0.0}, bad_nu[] = {-1e-9, 0.5000001, NAN, INFINITY, -INFINITY};
    const double bad_young[] = {0, -1e6, NAN, -INFINITY, -0.0};
    for (int b = 0; b < 6; b++) WITH(f.s.radius[2], bad_radius[b], init(), NLC_ERROR_RADIUS, 2);
    for (int b = 0; b < 5; b++) WITH(f.s.rows[0].young, bad_young[b], init(), NLC_ERROR_YOUNG, 0);
    for (int b = 0; b < 5; b++) WITH(f.s.rows[0].poisson, bad_nu[b], init(), NLC_ERROR_POISSON, 0);
    WITH(f.s.rows[1].poisson, NAN, init(), NLC_OK, -1); /* rigid: not looked at */
    teardown();
    setup();
    WITH(f.s.material[1], 3, init(), NLC_ERROR_MATERIAL, 1);
    WITH(f.s.material[1], -1, init(), NLC_ERROR_MATERIAL, 1);
    WITH(f.s.wall_material[0], INT32_MIN, init(), NLC_ERROR_MATERIAL, 4);
    WITH(f.s.material[1], 2, init(), NLC_ERROR_YOUNG, 2); /* in use now */
    const int32_t bad_index[] = {-1, 5, INT32_MAX, INT32_MIN};
    for (int b = 0; b < 4; b++) WITH(f.s.i[3], bad_index[b], init(), NLC_ERROR_INDEX, 3);
    for (int b = 0; b < 4; b++) WITH(f.s.j[1], bad_index[b], init(), NLC_ERROR_INDEX, 1);
    WITH(f.s.j[4], 4, init(), NLC_ERROR_WALL_WALL, 4);
    WITH(f.s.j[3], 4, init(), NLC_ERROR_RIGID_RIGID, 3);
    WITH(f.s.j[3], 3, init(), NLC_ERROR_RIGID_RIGID, 3);
    WITH(f.s.radius[0], 1e305, init(), NLC_ERROR_RANGE, -1); /* U = 1/(R E) is subnormal */
}
END_TEST

/* The stiffness of a contact that double cannot hold, where the particle's compliance can be held. */
START_TEST(stiffness_out_of_range)
{
    static const double radius = 1e30;
    static const nlc_material materials[2] = {{1e300, 0.3}, {INFINITY, 0}};
    const int32_t i = 0, j = 1, rigid = 1;
    const nlc_particles p = {.struct_size = sizeof p, .count = 1, .radius = &radius, .materials = materials, .material_count = 2,
                             .wall_material = &rigid, .wall_count = 1};
    double memory[1000];
    nlc_network *n = NULL;
    nlc_info info = {.struct_size = sizeof info};
    nlc_assert_quiet(ck_assert_int_eq(nlc_network_init(&n, memory, sizeof memory, &p, &i, &j, 1, NULL, &info), NLC_ERROR_RANGE));
    ck_assert_int_eq(info.culprit, 0);
    ck_assert_ptr_null(n);
}
END_TEST

/* An open contact in the same direction as one with a force, left out of the iteration since last time it was far from closing. */
START_TEST(same_direction_left_out)
{
    enum { Z = 12 };
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    const int32_t m = scene_material(&s, 1e9, 0.3);
    scene_particle(&s, 1, m);
    for (int c = 0; c < Z; c++) {
        const double turn = 6.283185307179586 * c / Z;
        scene_particle(&s, 0.2, m);
        scene_contact(&s, 0, c + 1, c % 3 ? -0.1 : 1e-3, cos(turn), sin(turn), 0);
    }
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    for (int64_t c = 0; c < Z; c++) s.overlap[c] *= s.overlap[c] > 0 ? 1.5 : 1;
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    ck_assert_int_gt(info.left_out, 0);
    for (int64_t c = 0; c < Z; c++) s.overlap[c] *= s.overlap[c] > 0 ? 1.5 : 1;
    memcpy(s.normal + 3 * 4, s.normal + 3 * 3, 3 * sizeof *s.normal); /* 3 has a force, 4 has none */
    nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, &info), NLC_ERROR_COINCIDENT));
    ck_assert_int_eq(info.culprit, 4);
    scene_free(&s);
}
END_TEST

START_TEST(counts_strides_and_memory)
{
    ck_assert_uint_eq(nlc_network_size(0, 5, &f.options), 0);
    WITH(f.s.contacts, -1, init(), NLC_ERROR_COUNT, 6);
    WITH(f.s.contacts, INT64_MAX, init(), NLC_ERROR_COUNT, 6);
    WITH(f.s.contacts, INT64_MAX / 16, init(), NLC_ERROR_COUNT, 6);
    WITH(f.view.count, -1, init(), NLC_ERROR_COUNT, 3);
    WITH(f.view.count, INT64_MIN, init(), NLC_ERROR_COUNT, 3);
    WITH(f.view.count, (int64_t)INT32_MAX, init(), NLC_ERROR_COUNT, 3); /* and a wall: one too many */
    WITH(f.view.wall_count, -1, init(), NLC_ERROR_COUNT, 3);
    WITH(f.view.wall_count, INT64_MAX, init(), NLC_ERROR_COUNT, 3);
    WITH(f.view.material_count, -1, init(), NLC_ERROR_COUNT, 3);
    WITH(f.view.material_count, 0, init(), NLC_ERROR_COUNT, 3);
    WITH(f.view.material_count, INT64_MAX, init(), NLC_ERROR_COUNT, 3);
    WITH(f.view.radius_stride, 4, init(), NLC_ERROR_STRIDE, offsetof(nlc_particles, radius_stride));
    WITH(f.view.radius_stride, -7, init(), NLC_ERROR_STRIDE, offsetof(nlc_particles, radius_stride));
    WITH(f.view.radius_stride, PTRDIFF_MAX / 2, init(), NLC_ERROR_STRIDE, offsetof(nlc_particles, radius_stride));
    WITH(f.view.radius_stride, PTRDIFF_MIN, init(), NLC_ERROR_STRIDE, offsetof(nlc_particles, radius_stride));
    WITH(f.view.material_stride, 2, init(), NLC_ERROR_STRIDE, offsetof(nlc_particles, material_stride));
    WITH(f.view.material_size, 8, init(), NLC_ERROR_STRIDE, offsetof(nlc_particles, material_size));
    WITH(f.view.material_size, SIZE_MAX, init(), NLC_ERROR_STRIDE, offsetof(nlc_particles, material_size));
    const int64_t full = (int64_t)f.size;
    WITH(f.size, f.size - 1, init(), NLC_ERROR_MEMORY_SIZE, full);
    WITH(f.size, 0, init(), NLC_ERROR_MEMORY_SIZE, full);
    keep();
    demand(nlc_network_init(&f.s.network, (char *)f.s.memory + 4, f.size, &f.view, f.s.i, f.s.j, 5, 0, &f.info),
           NLC_ERROR_ALIGNMENT, 4);
    ck_assert_uint_eq(nlc_network_size(&f.view, -1, 0), 0);
    ck_assert_uint_eq(nlc_network_size(&f.view, INT64_MAX, 0), 0);
    ck_assert_uint_eq(nlc_network_size(&f.view, INT64_MAX / 8, 0), 0);
    ck_assert_uint_eq(nlc_network_size(0, 1, 0), 0);
}
END_TEST

START_TEST(null_pointers)
{
    keep();
    demand(nlc_network_init(0, f.s.memory, f.size, &f.view, f.s.i, f.s.j, 5, 0, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_network_init(&f.s.network, 0, f.size, &f.view, f.s.i, f.s.j, 5, 0, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_network_init(&f.s.network, f.s.memory, f.size, 0, f.s.i, f.s.j, 5, 0, &f.info), NLC_ERROR_NULL, 3);
    demand(nlc_network_init(&f.s.network, f.s.memory, f.size, &f.view, 0, f.s.j, 5, 0, &f.info), NLC_ERROR_NULL, 4);
    demand(nlc_network_init(&f.s.network, f.s.memory, f.size, &f.view, f.s.i, 0, 5, 0, &f.info), NLC_ERROR_NULL, 5);
    WITH(f.view.radius, 0, init(), NLC_ERROR_NULL_FIELD, offsetof(nlc_particles, radius));
    WITH(f.view.materials, 0, init(), NLC_ERROR_NULL_FIELD, offsetof(nlc_particles, materials));
    keep();
    demand(nlc_set_options(0, 0, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_solve(0, f.force, f.nonlocal, f.s.overlap, f.s.normal, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_solve(f.s.network, 0, f.nonlocal, f.s.overlap, f.s.normal, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_solve(f.s.network, f.force, 0, f.s.overlap, f.s.normal, &f.info), NLC_ERROR_NULL, 2);
    demand(nlc_solve(f.s.network, f.force, f.nonlocal, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 3);
    demand(nlc_solve(f.s.network, f.force, f.nonlocal, f.s.overlap, 0, &f.info), NLC_ERROR_NULL, 4);
    demand(nlc_sweep(0, f.displacement, f.force, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_sweep(f.s.network, 0, f.force, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_sweep(f.s.network, f.displacement, 0, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 2);
    demand(nlc_sweep(f.s.network, f.displacement, f.force, 0, 0, &f.info), NLC_ERROR_NULL, 4);
    demand(nlc_assemble(0, f.F, 0, 0, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_assemble(f.s.network, 0, 0, 0, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_assemble(f.s.network, f.F, 0, 0, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 4);
    demand(nlc_assemble(f.s.network, f.F, 0, 0, f.force, 0, &f.info), NLC_ERROR_NULL, 5);
    ck_assert_int_eq(nlc_solve(f.s.network, f.force, f.nonlocal, 0, f.s.normal, 0), NLC_ERROR_NULL); /* no info either */
}
END_TEST

START_TEST(options)
{
    WITH(f.options.model, nlc_model_count(), init(), NLC_ERROR_MODEL, nlc_model_count());
    WITH(f.options.model, -1, init(), NLC_ERROR_MODEL, -1);
    WITH(f.options.method, -1, init(), NLC_ERROR_METHOD, -1);
    WITH(f.options.method, 99, init(), NLC_ERROR_METHOD, 99);
    const double bad[] = {NAN, INFINITY, -INFINITY, -1e-300};
    for (int b = 0; b < 4; b++) {
        WITH(f.options.tolerance, bad[b], init(), NLC_ERROR_OPTION, offsetof(nlc_options, tolerance));
        WITH(f.options.prefactor, bad[b], init(), NLC_ERROR_OPTION, offsetof(nlc_options, prefactor));
    }
    WITH(f.options.max_sweeps, -1, init(), NLC_ERROR_OPTION, offsetof(nlc_options, max_sweeps));
    const int32_t bad_simd[] = {-1, NLC_SIMD_NEON + 1, 77, INT32_MIN};
    for (int b = 0; b < 4; b++) WITH(f.options.simd, bad_simd[b], init(), NLC_ERROR_OPTION, offsetof(nlc_options, simd));
    WITH(f.options.points, 2, init(), NLC_ERROR_OPTION, offsetof(nlc_options, points));
    f.options.model = NLC_MODEL_HALF_SPACE;
    WITH(f.options.prefactor, 0x1p100, init(), NLC_ERROR_RANGE, -1);
    WITH(f.options.prefactor, 0x0.8p-100, init(), NLC_ERROR_RANGE, -1);
    WITH(f.options.prefactor, 1e305, nlc_set_options(f.s.network, &f.options, &f.info), NLC_ERROR_RANGE, -1);
    f.options.model = NLC_MODEL_GONZALEZ_CUITINO;
    WITH(f.options.method, 99, nlc_set_options(f.s.network, &f.options, &f.info), NLC_ERROR_METHOD, 99);
    double stiffness[5] = {1, 2, 3, 4, 5};
    f.options.stiffness = stiffness;
    const double bad_stiffness[] = {0, -1, NAN, INFINITY};
    for (int b = 0; b < 4; b++) {
        WITH(stiffness[3], bad_stiffness[b], init(), NLC_ERROR_STIFFNESS, 3);
        WITH(stiffness[3], bad_stiffness[b], nlc_set_options(f.s.network, &f.options, &f.info), NLC_ERROR_STIFFNESS, 3);
    }
    uint64_t not_a_network[40] = {0};
    keep();
    demand(nlc_set_options((nlc_network *)not_a_network, 0, &f.info), NLC_ERROR_NETWORK, -1);
    demand(nlc_solve((nlc_network *)not_a_network, f.force, f.nonlocal, f.s.overlap, f.s.normal, &f.info), NLC_ERROR_NETWORK, -1);
    demand(nlc_sweep((nlc_network *)not_a_network, f.displacement, f.force, 0, f.s.normal, &f.info), NLC_ERROR_NETWORK, -1);
    demand(nlc_assemble((nlc_network *)not_a_network, f.F, 0, 0, f.force, f.s.normal, &f.info), NLC_ERROR_NETWORK, -1);
    demand(nlc_energy((nlc_network *)not_a_network, f.F, f.force, f.s.overlap, f.s.normal, &f.info), NLC_ERROR_NETWORK, -1);
    demand(nlc_tangent((nlc_network *)not_a_network, f.F, f.s.overlap, f.force, f.s.normal, &f.info), NLC_ERROR_NETWORK, -1);
    demand(nlc_tangent_inverse((nlc_network *)not_a_network, f.F, f.force, f.force, f.s.normal, &f.info), NLC_ERROR_NETWORK, -1);
    demand(nlc_tangent_bound((nlc_network *)not_a_network, f.F, f.force, f.s.normal, &f.info), NLC_ERROR_NETWORK, -1);
}
END_TEST

/* A program built against another header: shorter structs count as followed by zeros, longer ones must be. */
START_TEST(struct_sizes)
{
    WITH(f.view.struct_size, 0, init(), NLC_ERROR_STRUCT_SIZE, 3);
    WITH(f.view.struct_size, 1u << 20, init(), NLC_ERROR_STRUCT_SIZE, 3);
    WITH(f.options.struct_size, sizeof(size_t) - 1, init(), NLC_ERROR_STRUCT_SIZE, 7);
    WITH(f.options.struct_size, SIZE_MAX, nlc_set_options(f.s.network, &f.options, &f.info), NLC_ERROR_STRUCT_SIZE, 1);
    struct {
        nlc_options o;
        unsigned char more[40];
    } longer = {.o = f.options};
    longer.o.struct_size = sizeof longer;
    ck_assert_int_eq(nlc_set_options(f.s.network, &longer.o, &f.info), NLC_OK);
    longer.more[39] = 1;
    keep();
    demand(nlc_set_options(f.s.network, &longer.o, &f.info), NLC_ERROR_RESERVED, 1);
    for (size_t size = sizeof(size_t); size <= sizeof f.options; size++) {
        nlc_options o = f.options;
        o.struct_size = size;
        o.tolerance = size >= offsetof(nlc_options, tolerance) + sizeof o.tolerance ? 1e-3 : NAN; /* cut off: not seen */
        ck_assert_int_eq(nlc_set_options(f.s.network, &o, 0), NLC_OK);
    }
    for (size_t size = sizeof(size_t); size < sizeof f.view; size++) { /* without walls, contact 4 has no second body */
        f.view.struct_size = size;
        ck_assert_int_lt(init(), 0);
    }
    unsigned char room[sizeof(nlc_info) + 64]; /* info: exactly struct_size bytes are written */
    for (size_t size = sizeof(size_t); size <= sizeof room - 8; size++) {
        memset(room, 0xa5, sizeof room);
        memcpy(room, &size, sizeof size);
        ck_assert_int_eq(nlc_solve(f.s.network, f.force, f.nonlocal, f.s.overlap, f.s.normal, (nlc_info *)(void *)room), NLC_OK);
        ck_assert_int_eq(room[size], 0xa5);
        if (size > sizeof(nlc_info)) ck_assert_int_eq(room[size - 1], 0);
    }
    memset(room, 0, sizeof room);
    ck_assert_int_eq(nlc_solve(f.s.network, f.force, f.nonlocal, f.s.overlap, f.s.normal, (nlc_info *)(void *)room),
                     NLC_ERROR_STRUCT_SIZE);
}
END_TEST

START_TEST(arrays_over_contacts)
{
    for (int b = 0; b < 4; b++) {
        const double bad = not_finite[b];
        WITH_WORK(f.s.overlap[2], bad, solve(), NLC_ERROR_OVERLAP, 2);
        WITH_WORK(f.s.overlap[2], bad, sweep(), NLC_ERROR_OVERLAP, 2);
        WITH_WORK(f.nonlocal[4], bad, solve(), NLC_ERROR_NONLOCAL, 4);
        WITH_WORK(f.force[0], bad, sweep(), NLC_ERROR_FORCE, 0);
        WITH_WORK(f.force[0], bad, assemble(), NLC_ERROR_FORCE, 0);
        WITH_WORK(f.F[7], bad, assemble(), NLC_ERROR_TOTAL_FORCE, 2);
        WITH_WORK(f.F_wall[1], bad, assemble(), NLC_ERROR_TOTAL_FORCE, 4);
    }
    const double bad_normal[] = {NAN, INFINITY, -INFINITY, 0, 1 + 1e-6, 1 - 1e-6, 1e200, 3};
    for (int b = 0; b < 8; b++) { /* contact 1 has (0, 1, 0) */
        WITH_WORK(f.s.normal[4], bad_normal[b], solve(), NLC_ERROR_NORMAL, 1);
        WITH_WORK(f.s.normal[4], bad_normal[b], sweep(), NLC_ERROR_NORMAL, 1);
        WITH_WORK(f.s.normal[4], bad_normal[b], assemble(), NLC_ERROR_NORMAL, 1);
    }
    f.s.normal[4] = 1 + 4e-7; /* within the tolerance */
    ck_assert_int_eq(solve(), NLC_OK);
    keep();
    demand(nlc_assemble(f.s.network, f.F, 8, 0, f.force, f.s.normal, &f.info), NLC_ERROR_STRIDE, 2);
    demand(nlc_assemble(f.s.network, f.F, PTRDIFF_MAX, 0, f.force, f.s.normal, &f.info), NLC_ERROR_STRIDE, 2);
    demand(nlc_assemble(f.s.network, f.F, PTRDIFF_MAX / 2, 0, f.force, f.s.normal, &f.info), NLC_ERROR_STRIDE, 2); /* the third one's */
    demand(nlc_assemble(f.s.network, f.F, PTRDIFF_MIN / 2, 0, f.force, f.s.normal, &f.info), NLC_ERROR_STRIDE, 2);
}
END_TEST

/* Of many contacts the first bad one is named, and the largest number counts, whatever part of the list they are in. */
START_TEST(long_lists)
{
    enum { COUNT = 21000 };
    static const int64_t places[] = {0, 5, 8191, 8192, 12000, 16384, COUNT - 1};
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    const int32_t m = scene_material(&s, 1e9, 0.3);
    for (int k = 0; k <= COUNT; k++) scene_particle(&s, 1, m);
    for (int k = 0; k < COUNT; k++) scene_contact(&s, k, k + 1, 1e-3, 1, 0, 0);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    for (int p = 0; p < 7; p++)
        for (int later = p; later < 7; later++) {
            const int64_t c = places[p], d = places[later];
            s.normal[3 * c] = s.normal[3 * d] = 2;
            nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, &info), NLC_ERROR_NORMAL));
            ck_assert_int_eq(info.culprit, c);
            s.normal[3 * c] = s.normal[3 * d] = 1;
            s.overlap[c] = NAN, s.overlap[d] = INFINITY;
            nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, &info), NLC_ERROR_OVERLAP));
            ck_assert_int_eq(info.culprit, c);
            s.overlap[c] = -1e300, s.overlap[d] = 1e-3;
            if (c != d) nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, &info), NLC_ERROR_RANGE));
            s.overlap[c] = 1e-3;
        }
    nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, &info), NLC_OK)); /* all is as it was: [GC] 11, but near the ends */
    const double k = nlc_hertz_stiffness(1e9, 0.3, 1, 1e9, 0.3, 1), C = 1.3 * 2.4 / (2 * acos(-1) * 1e9);
    for (int c = 50; c < COUNT - 50; c++) nlc_assert_rel(nlc_hertz_overlap(k, s.force[c]) - C * s.force[c], 1e-3, 1e-7);
    scene_free(&s);
}
END_TEST

/* A state from the last step, and then two contacts of one particle come to lie in one direction: in a scene of any size. */
START_TEST(same_direction_in_the_next_step)
{
    for (int count = 10; count < 1000; count *= 3) {
        scene s;
        nlc_info info = {.struct_size = sizeof info};
        scene_init(&s);
        const int32_t m = scene_material(&s, 1e9, 0.3);
        for (int k = 0; k <= count; k++) scene_particle(&s, 1, m);
        for (int k = 0; k < count; k++) scene_contact(&s, k, k + 1, 1e-2, 1, 0, 0);
        ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
        s.normal[3 * (count / 2)] = -1; /* the particle's neighbours are both on its left */
        nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, &info), NLC_ERROR_COINCIDENT));
        ck_assert(info.culprit == count / 2 || info.culprit == count / 2 + 1);
        double change[1000];
        nlc_assert_quiet(ck_assert_int_eq(nlc_tangent(s.network, change, s.overlap, s.force, s.normal, &info), NLC_ERROR_COINCIDENT));
        nlc_assert_quiet(ck_assert_int_eq(nlc_tangent_inverse(s.network, change, s.force, s.force, s.normal, &info), NLC_ERROR_COINCIDENT));
        scene_free(&s);
    }
}
END_TEST

/* Forces and stiffnesses at the end of double, on bodies that hardly yield: what cannot be calculated with is refused. */
START_TEST(stiffest_and_softest)
{
    double stiffness[2] = {1.7e308, 1.7e308}, force[2] = {1.7e308, 1.7e308}, overlap[2] = {1e-3, 1e-3}, out[2] = {7, 7}, energy = 7;
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    s.options.stiffness = stiffness;
    const int32_t m = scene_material(&s, 1e300, 0.3);
    for (int k = 0; k < 4; k++) scene_particle(&s, 1, m);
    scene_contact(&s, 0, 1, 1e-3, 1, 0, 0);
    scene_contact(&s, 2, 3, 1e-3, 1, 0, 0);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    nlc_assert_quiet(ck_assert_int_eq(nlc_tangent(s.network, out, overlap, force, s.normal, &info), NLC_ERROR_RANGE));
    nlc_assert_quiet(ck_assert_int_eq(nlc_energy(s.network, &energy, force, overlap, s.normal, &info), NLC_ERROR_RANGE));
    for (int c = 0; c < 2; c++) force[c] = 0x1p1002, overlap[c] = 1e-10; /* energies would do, a sum of forces may not */
    nlc_assert_quiet(ck_assert_int_eq(nlc_energy(s.network, &energy, force, overlap, s.normal, &info), NLC_ERROR_RANGE));
    for (int c = 0; c < 2; c++) overlap[c] = 1e-3;
    ck_assert(out[0] == 7 && out[1] == 7 && energy == 7);

    /* two pairs, one of them too soft beside the other to be seen: dP = 3/2 k (P/k)^(1/3) dx, and nothing */
    stiffness[0] = 1e9, stiffness[1] = 1e-200;
    force[0] = 3e4, force[1] = 3e-209;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, &info), NLC_OK);
    nlc_assert_quiet(ck_assert_int_eq(nlc_tangent(s.network, out, overlap, force, s.normal, &info), NLC_OK));
    nlc_assert_rel(out[0], 1.5e9 * cbrt(3e4 / 1e9) * 1e-3, 1e-14);
    ck_assert(out[1] >= 0 && out[1] < 1e-190);

    /* all that moves is open, but for next to nothing */
    stiffness[1] = 1e9;
    force[0] = 0, force[1] = 3e4;
    overlap[0] = 1, overlap[1] = 1e-150;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, &info), NLC_OK);
    nlc_assert_quiet(ck_assert_int_eq(nlc_tangent(s.network, out, overlap, force, s.normal, &info), NLC_OK));
    ck_assert(out[0] == 0 && out[1] >= 0 && out[1] <= 1.1 * 1.5e9 * cbrt(3e4 / 1e9) * 1e-150);

    /* Hertz's stiffness is beyond double, which does not matter as long as others are given */
    scene_free(&s);
    scene_init(&s);
    stiffness[0] = stiffness[1] = 1;
    s.options.stiffness = stiffness;
    const int32_t hard = scene_material(&s, 1e300, 0.3), rigid = scene_material(&s, INFINITY, 0.3);
    scene_particle(&s, 1, hard);
    scene_particle(&s, 1e20, rigid);
    const int32_t wall = 2 + scene_wall(&s, hard);
    scene_contact(&s, 0, wall, 1e-3, 1, 0, 0);
    scene_contact(&s, 1, wall, 1e-3, 1, 0, 0);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    s.options.stiffness = NULL;
    nlc_assert_quiet(ck_assert_int_eq(nlc_set_options(s.network, &s.options, &info), NLC_ERROR_RANGE));
    ck_assert_int_eq(info.culprit, 1);
    scene_free(&s);
}
END_TEST

START_TEST(same_direction_and_range)
{
    memcpy(f.s.normal + 3, (const double[]){-1, 0, 0}, 3 * sizeof(double)); /* on particle 1: contacts 0 and 1 */
    keep();
    demand(solve(), NLC_ERROR_COINCIDENT, 1);
    keep();
    demand(sweep(), NLC_ERROR_COINCIDENT, 1);
    memcpy(f.s.normal + 3, (const double[]){0, 1, 0}, 3 * sizeof(double));
    WITH_WORK(f.s.overlap[1], 1e300, solve(), NLC_ERROR_RANGE, -1);
    WITH_WORK(f.s.overlap[1], -1e308, solve(), NLC_ERROR_RANGE, -1);
    WITH_WORK(f.force[1], 1.7e308, assemble(), NLC_ERROR_RANGE, -1);
    WITH_WORK(f.F[1], 1.7e308, assemble(), NLC_ERROR_RANGE, -1);
    f.force[1] = 1e300; /* displacements are a millionth of it */
    ck_assert_int_eq(sweep(), NLC_OK);
    f.s.rows[0].young = 1e-30;
    ck_assert_int_eq(init(), NLC_OK);
    keep();
    demand(sweep(), NLC_ERROR_RANGE, -1);
}
END_TEST

static nlc_status energy(void)
{
    return nlc_energy(f.s.network, f.F, f.force, f.s.overlap, f.s.normal, &f.info);
}

static nlc_status tangent(void)
{
    return nlc_tangent(f.s.network, f.displacement, f.nonlocal, f.force, f.s.normal, &f.info);
}

static nlc_status inverse(void)
{
    return nlc_tangent_inverse(f.s.network, f.displacement, f.nonlocal, f.force, f.s.normal, &f.info);
}

static nlc_status bound(void)
{
    return nlc_tangent_bound(f.s.network, f.F, f.force, f.s.normal, &f.info);
}

START_TEST(energy_and_tangent)
{
    keep();
    nlc_options other = f.options;
    other.model = NLC_MODEL_LOVE;
    ck_assert_int_eq(nlc_set_options(f.s.network, &other, 0), NLC_OK);
    keep();
    demand(energy(), NLC_ERROR_NO_POTENTIAL, NLC_MODEL_LOVE);
    demand(tangent(), NLC_ERROR_NO_POTENTIAL, NLC_MODEL_LOVE);
    demand(inverse(), NLC_ERROR_NO_POTENTIAL, NLC_MODEL_LOVE);
    demand(bound(), NLC_ERROR_NO_POTENTIAL, NLC_MODEL_LOVE);
    other.model = NLC_MODEL_HALF_SPACE;
    ck_assert_int_eq(nlc_set_options(f.s.network, &other, 0), NLC_OK);
    keep();
    demand(nlc_sweep(f.s.network, f.displacement, f.force, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 3);
    ck_assert_int_eq(nlc_set_options(f.s.network, &f.options, 0), NLC_OK);
    keep();
    demand(nlc_energy(0, f.F, f.force, f.s.overlap, f.s.normal, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_energy(f.s.network, 0, f.force, f.s.overlap, f.s.normal, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_energy(f.s.network, f.F, 0, f.s.overlap, f.s.normal, &f.info), NLC_ERROR_NULL, 2);
    demand(nlc_energy(f.s.network, f.F, f.force, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 3);
    demand(nlc_energy(f.s.network, f.F, f.force, f.s.overlap, 0, &f.info), NLC_ERROR_NULL, 4);
    demand(nlc_tangent(0, f.displacement, f.nonlocal, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_tangent(f.s.network, 0, f.nonlocal, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_tangent(f.s.network, f.displacement, 0, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 2);
    demand(nlc_tangent(f.s.network, f.displacement, f.nonlocal, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 3);
    demand(nlc_tangent(f.s.network, f.displacement, f.nonlocal, f.force, 0, &f.info), NLC_ERROR_NULL, 4);
    demand(nlc_tangent_inverse(0, f.displacement, f.nonlocal, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_tangent_inverse(f.s.network, 0, f.nonlocal, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_tangent_inverse(f.s.network, f.displacement, 0, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 2);
    demand(nlc_tangent_inverse(f.s.network, f.displacement, f.nonlocal, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 3);
    demand(nlc_tangent_inverse(f.s.network, f.displacement, f.nonlocal, f.force, 0, &f.info), NLC_ERROR_NULL, 4);
    demand(nlc_tangent_bound(0, f.F, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_tangent_bound(f.s.network, 0, f.force, f.s.normal, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_tangent_bound(f.s.network, f.F, 0, f.s.normal, &f.info), NLC_ERROR_NULL, 2);
    demand(nlc_tangent_bound(f.s.network, f.F, f.force, 0, &f.info), NLC_ERROR_NULL, 3);
    const double bad[] = {NAN, INFINITY, -1};
    for (int b = 0; b < 3; b++) {
        WITH_WORK(f.force[3], bad[b], energy(), NLC_ERROR_FORCE, 3);
        WITH_WORK(f.force[3], bad[b], tangent(), NLC_ERROR_FORCE, 3);
        WITH_WORK(f.force[3], bad[b], inverse(), NLC_ERROR_FORCE, 3);
        WITH_WORK(f.force[3], bad[b], bound(), NLC_ERROR_FORCE, 3);
        WITH_WORK(f.s.normal[9], 3 + bad[b], energy(), NLC_ERROR_NORMAL, 3);
        WITH_WORK(f.s.normal[9], 3 + bad[b], tangent(), NLC_ERROR_NORMAL, 3);
        WITH_WORK(f.s.normal[9], 3 + bad[b], inverse(), NLC_ERROR_NORMAL, 3);
        WITH_WORK(f.s.normal[9], 3 + bad[b], bound(), NLC_ERROR_NORMAL, 3);
    }
    WITH_WORK(f.s.overlap[1], NAN, energy(), NLC_ERROR_OVERLAP, 1);
    WITH_WORK(f.nonlocal[1], NAN, tangent(), NLC_ERROR_OVERLAP, 1);
    WITH_WORK(f.nonlocal[1], NAN, inverse(), NLC_ERROR_FORCE, 1);
    WITH_WORK(f.force[1], 1.7e308, energy(), NLC_ERROR_RANGE, -1);
    f.nonlocal[1] = 1e306;
    keep();
    demand(tangent(), NLC_ERROR_RANGE, -1);
    /* forces far beyond the fold: 1e6 Pa and 1 m cannot be stable at 1e12 N */
    f.nonlocal[1] = 1;
    for (int c = 0; c < 5; c++) f.force[c] = 1e12;
    keep();
    demand(tangent(), NLC_ERROR_UNSTABLE, -1);
    demand(bound(), NLC_ERROR_UNSTABLE, -1);
}
END_TEST

START_TEST(models)
{
    unsigned char room[sizeof(nlc_model_record) + 64], kept[sizeof room]; /* exactly struct_size bytes are written */
    nlc_model_record full = {.struct_size = sizeof full};
    ck_assert_int_eq(nlc_model_info(NLC_MODEL_SPHERE, &full, 0), NLC_OK);
    for (size_t size = sizeof(size_t); size <= sizeof room - 8; size++) {
        memset(room, 0xa5, sizeof room);
        memcpy(room, &size, sizeof size);
        ck_assert_int_eq(nlc_model_info(NLC_MODEL_SPHERE, (nlc_model_record *)(void *)room, 0), NLC_OK);
        const size_t common = size < sizeof full ? size : sizeof full, head = sizeof(size_t);
        ck_assert(memcmp(room, &size, head) == 0 && memcmp(room + head, (char *)&full + head, common - head) == 0);
        for (size_t b = common; b < size; b++) ck_assert_int_eq(room[b], 0);
        for (size_t b = size; b < sizeof room; b++) ck_assert_int_eq(room[b], 0xa5);
    }
    nlc_model_record *record = (nlc_model_record *)(void *)room;
    memset(room, 0xa5, sizeof room);
    memcpy(kept, room, sizeof room);
    keep();
    demand(nlc_model_info(0, 0, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_model_info(0, record, &f.info), NLC_ERROR_STRUCT_SIZE, 1); /* 0xa5... */
    ck_assert(memcmp(room, kept, sizeof room) == 0);
    for (size_t size = 0; size < sizeof size; size++) {
        memcpy(room, &size, sizeof size);
        demand(nlc_model_info(0, record, &f.info), NLC_ERROR_STRUCT_SIZE, 1);
    }
    record->struct_size = sizeof *record;
    memcpy(kept, room, sizeof room);
    demand(nlc_model_info(-1, record, &f.info), NLC_ERROR_MODEL, -1);
    demand(nlc_model_info(nlc_model_count(), record, &f.info), NLC_ERROR_MODEL, nlc_model_count());
    demand(nlc_model_info(INT32_MIN, record, &f.info), NLC_ERROR_MODEL, INT32_MIN);
    demand(nlc_model_info(INT32_MAX, record, &f.info), NLC_ERROR_MODEL, INT32_MAX);
    f.info.struct_size = 3;
    ck_assert_int_eq(nlc_model_info(0, record, &f.info), NLC_ERROR_STRUCT_SIZE);
    ck_assert(memcmp(room, kept, sizeof room) == 0);
    const char *none[] = {0, "", "hert", "hertz ", "Hertz", "hertzian", "sphere\n"};
    for (int k = 0; k < 7; k++) ck_assert_int_eq(nlc_model_find(none[k]), -1);
}
END_TEST

/* The same with one of the pointers NULL, or with these strides. */
static nlc_status slide_without(int k)
{
    return nlc_assemble_sliding(k == 0 ? 0 : f.s.network, k == 1 ? 0 : f.F, 0, k == 3 ? 0 : f.torque, 0, 0, k == 6 ? 0 : f.force,
                                k == 7 ? 0 : f.s.normal, k == 8 ? 0 : f.sliding, 0, k == 10 ? 0 : f.s.overlap, 0.3, &f.info);
}

static nlc_status slide_with(ptrdiff_t F_stride, ptrdiff_t torque_stride)
{
    return nlc_assemble_sliding(f.s.network, f.F, F_stride, f.torque, torque_stride, 0, f.force, f.s.normal, f.sliding, 0,
                                f.s.overlap, 0.3, &f.info);
}

START_TEST(sliding)
{
    const int pointers[] = {0, 1, 3, 6, 7, 8, 10};
    const ptrdiff_t bad_stride[] = {8, -23, PTRDIFF_MAX, PTRDIFF_MIN};
    uint64_t not_a_network[40] = {0};
    keep();
    for (int k = 0; k < 7; k++) demand(slide_without(pointers[k]), NLC_ERROR_NULL, pointers[k]);
    for (int b = 0; b < 4; b++) {
        demand(slide_with(bad_stride[b], 0), NLC_ERROR_STRIDE, 2);
        demand(slide_with(0, bad_stride[b]), NLC_ERROR_STRIDE, 4);
    }
    demand(nlc_assemble_sliding((nlc_network *)not_a_network, f.F, 0, f.torque, 0, 0, f.force, f.s.normal, f.sliding, 0, f.s.overlap,
                                0.3, &f.info), NLC_ERROR_NETWORK, -1);
    for (int b = 0; b < 4; b++) {
        const double bad = not_finite[b];
        WITH(f.friction, bad, slide(), NLC_ERROR_OPTION, 11);
        WITH(f.force[1], bad, slide(), NLC_ERROR_FORCE, 1);
        WITH(f.s.normal[10], bad, slide(), NLC_ERROR_NORMAL, 3);
        WITH(f.F[7], bad, slide(), NLC_ERROR_TOTAL_FORCE, 2);
        WITH(f.F_wall[1], bad, slide(), NLC_ERROR_TOTAL_FORCE, 4);
        WITH(f.torque[11], bad, slide(), NLC_ERROR_TOTAL_FORCE, 3);
        WITH(f.sliding[14], bad, slide(), NLC_ERROR_SLIDING, 4);
        WITH(f.sliding[6], bad, slide(), NLC_ERROR_SLIDING, 2); /* the others of its components are 0 */
        WITH(f.displacement[7], bad, slide(), NLC_ERROR_NONLOCAL, 3);
        WITH(f.s.overlap[2], bad, slide(), NLC_ERROR_OVERLAP, 2);
    }
    WITH(f.friction, -1e-300, slide(), NLC_ERROR_OPTION, 11);
    const double bad_sliding[] = {1 + 1e-6, 1 - 1e-6, 0.5, 5e-324, 1e200, -1e308, 3};
    for (int b = 0; b < 7; b++) WITH(f.sliding[2], bad_sliding[b], slide(), NLC_ERROR_SLIDING, 0);
    WITH(f.sliding[0], 1.1e-6, slide(), NLC_ERROR_SLIDING, 0); /* along the normal of contact 0 */
    WITH(f.sliding[0], -1.1e-6, slide(), NLC_ERROR_SLIDING, 0);
    WITH(f.friction, 1.7e308, slide(), NLC_ERROR_RANGE, -1);
    WITH(f.force[1], 1.7e308, slide(), NLC_ERROR_RANGE, -1);
    WITH(f.F[1], 1.7e308, slide(), NLC_ERROR_RANGE, -1);
    WITH(f.torque[1], -1.7e308, slide(), NLC_ERROR_RANGE, -1);
    WITH(f.s.overlap[1], 1.7e308, slide(), NLC_ERROR_RANGE, -1);
    WITH(f.s.overlap[3], -1.7e308, slide(), NLC_ERROR_RANGE, -1);
    WITH(f.displacement[1], 1e308, slide(), NLC_ERROR_RANGE, -1);
    f.friction = 1e-300; /* it is the lever that would overflow, then */
    WITH(f.s.overlap[1], 1.7e308, slide(), NLC_ERROR_RANGE, -1);
    WITH(f.displacement[9], -1.7e308, slide(), NLC_ERROR_RANGE, -1);
    f.friction = 0.3;
    f.s.overlap[1] = -1e303; /* large, but in range */
    f.displacement[0] = 1e-320;
    f.sliding[0] = 0.9e-6;
    f.s.normal[4] = 1 + 4e-7;
    ck_assert_int_eq(slide(), NLC_OK);
    f.friction = 0;
    ck_assert_int_eq(slide(), NLC_OK);
}
END_TEST

START_TEST(prediction)
{
    double previous[5] = {0};
    keep();
    demand(nlc_predict(0, previous, 5, 1, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_predict(f.nonlocal, 0, 5, 1, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_predict(f.nonlocal, previous, -1, 1, &f.info), NLC_ERROR_COUNT, 2);
    demand(nlc_predict(f.nonlocal, previous, 5, NAN, &f.info), NLC_ERROR_OPTION, 3);
    WITH(f.nonlocal[3], 1, nlc_predict(f.nonlocal, previous, 5, 1e308, &f.info), NLC_ERROR_RANGE, -1);
    WITH(f.nonlocal[3], NAN, nlc_predict(f.nonlocal, previous, 5, 1, &f.info), NLC_ERROR_NONLOCAL, 3);
    WITH(f.nonlocal[3], 1e308, nlc_predict(f.nonlocal, previous, 5, 1, &f.info), NLC_ERROR_RANGE, -1);
    previous[2] = 1e308;
    keep();
    demand(nlc_predict(f.nonlocal, previous, 5, 1, &f.info), NLC_ERROR_RANGE, -1);
    previous[2] = INFINITY;
    keep();
    demand(nlc_predict(f.nonlocal, previous, 5, 1, &f.info), NLC_ERROR_NONLOCAL, 2);
    ck_assert_int_eq(nlc_predict(0, 0, 0, 1, 0), NLC_OK);
}
END_TEST

/* A scene for hosts: four particles in a row, one of them behind a wall, and their half lists. */
static struct {
    double x[4], y[4], z[4], point[3], normal[3], cell[9], overlap[3], out[9], reach, b[4];
    int32_t i[3], j[3], found_i[9], found_j[9], length[4], row[4][3], *neighbour[4];
    int64_t count;
    nlc_particles particles;
    nlc_positions positions;
    nlc_lists lists;
} h, h_before;

static void set_up_host(void)
{
    const int32_t i[3] = {0, 1, 4}, j[3] = {1, 2, 3};
    memset(&h, 0, sizeof h);
    for (int k = 0; k < 4; k++) h.x[k] = 2 * k;
    memcpy(h.i, i, sizeof i);
    memcpy(h.j, j, sizeof j);
    h.normal[1] = 1;
    for (int k = 0; k < 4; k++) h.neighbour[k] = h.row[k];
    for (int k = 0; k < 3; k++) h.length[k] = 1, h.row[k][0] = k + 1;
    h.particles = (nlc_particles){.struct_size = sizeof h.particles, .count = 4, .radius = f.s.radius, .wall_count = 1};
    h.positions = (nlc_positions){.struct_size = sizeof h.positions, .x = h.x, .y = h.y, .z = h.z, .wall_point = h.point,
                                  .wall_normal = h.normal};
    h.lists = (nlc_lists){.struct_size = sizeof h.lists, .count = 4, .particle_count = 4, .length = h.length,
                          .neighbour = h.neighbour};
}

static nlc_status pairs(void)
{
    return nlc_contacts_from_pairs(h.overlap, h.out, &h.particles, &h.positions, h.i, h.j, 3, &f.info);
}

static nlc_status lists(void)
{
    return nlc_contacts_from_lists(&h.count, h.found_i, h.found_j, 9, &h.particles, &h.positions, &h.lists, 0.5, &f.info);
}

#define WITH_HOST(lvalue, bad, call, status, culprit)                                                                       \
    do {                                                                                                                    \
        __typeof__(lvalue) good_ = (lvalue);                                                                                \
        (lvalue) = (bad);                                                                                                   \
        h_before = h;                                                                                                       \
        keep();                                                                                                             \
        demand(call, status, culprit);                                                                                      \
        ck_assert_msg(memcmp(&h, &h_before, sizeof h) == 0, "%s: something was changed", nlc_strerror(status));             \
        (lvalue) = good_;                                                                                                   \
    } while (0)
#define WITH_BOTH(lvalue, bad, status, in_pairs, in_lists)                                                                  \
    do {                                                                                                                    \
        WITH_HOST(lvalue, bad, pairs(), status, in_pairs);                                                                  \
        WITH_HOST(lvalue, bad, lists(), status, in_lists);                                                                  \
    } while (0)
#define WITH_FIELD(lvalue, bad, status, type, field) WITH_BOTH(lvalue, bad, status, offsetof(type, field), offsetof(type, field))

START_TEST(hosts)
{
    set_up_host();
    WITH_BOTH(h.particles.struct_size, 3, NLC_ERROR_STRUCT_SIZE, 2, 4);
    WITH_BOTH(h.positions.struct_size, 1u << 20, NLC_ERROR_STRUCT_SIZE, 3, 5);
    WITH_BOTH(h.particles.count, -1, NLC_ERROR_COUNT, 2, 4);
    WITH_BOTH(h.particles.count, (int64_t)INT32_MAX, NLC_ERROR_COUNT, 2, 4);
    WITH_BOTH(h.particles.count, (int64_t)INT32_MAX + 1, NLC_ERROR_COUNT, 2, 4);
    WITH_BOTH(h.particles.wall_count, -1, NLC_ERROR_COUNT, 2, 4);
    WITH_FIELD(h.particles.radius, 0, NLC_ERROR_NULL_FIELD, nlc_particles, radius);
    WITH_FIELD(h.positions.x, 0, NLC_ERROR_NULL_FIELD, nlc_positions, x);
    WITH_FIELD(h.positions.y, 0, NLC_ERROR_NULL_FIELD, nlc_positions, y);
    WITH_FIELD(h.positions.z, 0, NLC_ERROR_NULL_FIELD, nlc_positions, z);
    WITH_FIELD(h.positions.wall_point, 0, NLC_ERROR_NULL_FIELD, nlc_positions, wall_point);
    WITH_FIELD(h.positions.wall_normal, 0, NLC_ERROR_NULL_FIELD, nlc_positions, wall_normal);
    WITH_FIELD(h.particles.radius_stride, 4, NLC_ERROR_STRIDE, nlc_particles, radius_stride);
    WITH_FIELD(h.positions.stride, -7, NLC_ERROR_STRIDE, nlc_positions, stride);
    WITH_FIELD(h.positions.stride, PTRDIFF_MIN, NLC_ERROR_STRIDE, nlc_positions, stride);
    for (int b = 0; b < 4; b++) {
        const double bad = not_finite[b];
        WITH_BOTH(h.y[2], bad, NLC_ERROR_POSITION, 2, 2);
        WITH_BOTH(h.point[1], bad, NLC_ERROR_POSITION, 4, 4);
        WITH_BOTH(h.normal[1], bad, NLC_ERROR_NORMAL, 4, 4);
        WITH_BOTH(f.s.radius[3], bad, NLC_ERROR_RADIUS, 3, 3);
        WITH_BOTH(h.positions.cell, (double[9]){bad}, NLC_ERROR_CELL, -1, -1);
        WITH_HOST(h.count, 0, nlc_contacts_from_lists(&h.count, 0, 0, 0, &h.particles, &h.positions, &h.lists, bad, &f.info),
                  NLC_ERROR_OPTION, 7);
    }
    WITH_BOTH(f.s.radius[2], 0, NLC_ERROR_RADIUS, 2, 2);
    WITH_BOTH(h.normal[1], 0.99, NLC_ERROR_NORMAL, 4, 4);
    WITH_BOTH(h.x[2], h.x[1] + 1e-9, NLC_ERROR_SAME_PLACE, 1, 1);
    WITH_BOTH(h.positions.cell, ((double[9]){9, 0, 0, 0, 9, 0, 9, 9, 1e-7}), NLC_ERROR_CELL, -1, -1);
    WITH_BOTH(h.positions.cell, ((double[9]){9, 0, 0, 9, 0, 0}), NLC_ERROR_CELL, -1, -1);
    WITH_BOTH(h.positions.cell, ((double[9]){9, 0, 0, 0, 9, 0, 5, 0, 4.25}), NLC_ERROR_CELL, 1, 1); /* 0 and 1: 4.2 */
    WITH_BOTH(h.positions.cell, ((double[9]){1e-300}), NLC_ERROR_RANGE, 0, 0);
    for (int32_t bad = -1; bad < 12; bad += 6) WITH_HOST(h.i[1], bad, pairs(), NLC_ERROR_INDEX, 1);
    for (int32_t bad = -1; bad < 12; bad += 6) WITH_HOST(h.j[1], bad, pairs(), NLC_ERROR_INDEX, 1);
    WITH_HOST(h.j[2], 4, pairs(), NLC_ERROR_WALL_WALL, 2);
    h.x[0] = -1.7e308;
    WITH_HOST(h.x[1], 1.7e308, pairs(), NLC_ERROR_RANGE, 0);
    h.x[1] = 1.7e308; /* in lists it is just too far away; 1 and 2 are, too */
    ck_assert_int_eq(lists(), NLC_OK);
    ck_assert_int_eq(h.count, 5);
}
END_TEST

START_TEST(hosts_arguments)
{
    double *const none = 0;
    set_up_host();
    h_before = h;
    keep();
    for (int k = 0; k < 6; k++)
        demand(nlc_contacts_from_pairs(k == 0 ? none : h.overlap, k == 1 ? none : h.out, k == 2 ? 0 : &h.particles,
                                       k == 3 ? 0 : &h.positions, k == 4 ? 0 : h.i, k == 5 ? 0 : h.j, 3, &f.info), NLC_ERROR_NULL, k);
    demand(nlc_contacts_from_pairs(h.overlap, h.out, &h.particles, &h.positions, h.i, h.j, -1, &f.info), NLC_ERROR_COUNT, 6);
    demand(nlc_contacts_from_pairs(0, 0, 0, &h.positions, 0, 0, 0, &f.info), NLC_ERROR_NULL, 2);
    demand(nlc_contacts_from_pairs(0, 0, &h.particles, 0, 0, 0, 0, &f.info), NLC_ERROR_NULL, 3);
    ck_assert_int_eq(nlc_contacts_from_pairs(0, 0, &h.particles, &h.positions, 0, 0, 0, &f.info), NLC_OK); /* nothing is asked */
    for (int k = 0; k < 7; k++)
        if (k != 3)
            demand(nlc_contacts_from_lists(k == 0 ? 0 : &h.count, k == 1 ? 0 : h.found_i, k == 2 ? 0 : h.found_j, 9,
                                           k == 4 ? 0 : &h.particles, k == 5 ? 0 : &h.positions, k == 6 ? 0 : &h.lists, 0.5, &f.info),
                   NLC_ERROR_NULL, k);
    demand(nlc_contacts_from_lists(&h.count, 0, 0, -1, &h.particles, &h.positions, &h.lists, 0.5, &f.info), NLC_ERROR_COUNT, 3);
    demand(nlc_contacts_from_lists(&h.count, h.found_i, h.found_j, 6, &h.particles, &h.positions, &h.lists, 0.5, &f.info),
           NLC_ERROR_CAPACITY, 7); /* three pairs, four at the wall */
    ck_assert(memcmp(&h, &h_before, sizeof h) == 0);
    WITH_HOST(h.lists.struct_size, 1, lists(), NLC_ERROR_STRUCT_SIZE, 6);
    WITH_HOST(h.lists.reserved, 1, lists(), NLC_ERROR_RESERVED, 6);
    WITH_HOST(h.lists.count, -1, lists(), NLC_ERROR_COUNT, 6);
    WITH_HOST(h.lists.count, 5, lists(), NLC_ERROR_INDEX, 4);
    WITH_HOST(h.lists.particle_count, 3, lists(), NLC_ERROR_INDEX, 3);
    WITH_HOST(h.lists.particle_count, -1, lists(), NLC_ERROR_COUNT, 6);
    WITH_HOST(h.lists.length, 0, lists(), NLC_ERROR_NULL_FIELD, offsetof(nlc_lists, length));
    WITH_HOST(h.lists.neighbour, 0, lists(), NLC_ERROR_NULL_FIELD, offsetof(nlc_lists, neighbour));
    WITH_HOST(h.neighbour[1], 0, lists(), NLC_ERROR_NULL_FIELD, offsetof(nlc_lists, neighbour));
    WITH_HOST(h.length[2], -1, lists(), NLC_ERROR_COUNT, 2);
    WITH_HOST(h.row[1][0], -2, lists(), NLC_ERROR_INDEX, 1);
    WITH_HOST(h.row[1][0], 4, lists(), NLC_ERROR_INDEX, 1); /* a wall is in no list */
    WITH_HOST(h.row[1][0], 1, lists(), NLC_ERROR_SAME_PLACE, 1);
    uint64_t not_a_network[40] = {0};
    keep();
    demand(nlc_reach(0, &h.reach, h.b, f.force, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_reach(f.s.network, 0, h.b, f.force, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_reach(f.s.network, &h.reach, h.b, 0, &f.info), NLC_ERROR_NULL, 3);
    demand(nlc_reach((nlc_network *)not_a_network, &h.reach, h.b, f.force, &f.info), NLC_ERROR_NETWORK, -1);
    void *const askew = (char *)not_a_network + 4;
    demand(nlc_reach(askew, &h.reach, h.b, f.force, &f.info), NLC_ERROR_NETWORK, -1);
    const double bad[] = {NAN, INFINITY, -1};
    for (int b = 0; b < 3; b++) WITH_HOST(f.force[2], bad[b], nlc_reach(f.s.network, &h.reach, h.b, f.force, &f.info), NLC_ERROR_FORCE, 2);
    f.s.rows[0].young = 1e-10;
    ck_assert_int_eq(init(), NLC_OK);
    WITH_HOST(f.force[2], 1e305, nlc_reach(f.s.network, &h.reach, h.b, f.force, &f.info), NLC_ERROR_RANGE, -1);
}
END_TEST

START_TEST(carrying)
{
    const uint64_t key[5] = {3, 1, 2, 3, 9};
    static uint64_t memory[64];
    const size_t size = nlc_carry_size(5, 5);
    keep();
    demand(nlc_carry(0, key, 5, f.force, key, 5, memory, size, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_carry(f.nonlocal, 0, 5, f.force, key, 5, memory, size, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_carry(f.nonlocal, key, 5, 0, key, 5, memory, size, &f.info), NLC_ERROR_NULL, 3);
    demand(nlc_carry(f.nonlocal, key, 5, f.force, 0, 5, memory, size, &f.info), NLC_ERROR_NULL, 4);
    demand(nlc_carry(f.nonlocal, key, 5, f.force, key, 5, 0, size, &f.info), NLC_ERROR_NULL, 6);
    demand(nlc_carry(f.nonlocal, key, -1, f.force, key, 5, memory, size, &f.info), NLC_ERROR_COUNT, 2);
    demand(nlc_carry(f.nonlocal, key, 5, f.force, key, -1, memory, size, &f.info), NLC_ERROR_COUNT, 5);
    demand(nlc_carry(f.nonlocal, key, INT64_MAX, f.force, key, 5, memory, size, &f.info), NLC_ERROR_COUNT, 2);
    demand(nlc_carry(f.nonlocal, key, 5, f.force, key, 5, (char *)memory + 4, size, &f.info), NLC_ERROR_ALIGNMENT, 4);
    demand(nlc_carry(f.nonlocal, key, 5, f.force, key, 5, memory, size - 1, &f.info), NLC_ERROR_CAPACITY, (int64_t)size);
    for (int b = 0; b < 4; b++)
        WITH(f.force[3], not_finite[b], nlc_carry(f.nonlocal, key, 5, f.force, key, 5, memory, size, &f.info), NLC_ERROR_NONLOCAL, 3);
    for (int k = 0; k < 64; k++) ck_assert(memory[k] == 0);
    ck_assert_uint_eq(nlc_carry_size(-1, 0), 0);
    ck_assert_uint_eq(nlc_carry_size(0, INT64_MAX), 0);
    ck_assert_int_eq(nlc_carry(0, 0, 0, 0, 0, 0, memory, sizeof memory, 0), NLC_OK);
}
END_TEST

static double new_stiffness[5] = {1, 2, 3, 4, 5}, *stiffness_given;

static nlc_status update(void)
{
    return nlc_network_update(f.s.network, &f.view, stiffness_given, &f.info);
}

START_TEST(updates)
{
    uint64_t not_a_network[40] = {0};
    keep();
    demand(nlc_network_update(0, &f.view, 0, &f.info), NLC_ERROR_NULL, 0);
    demand(nlc_network_update(f.s.network, 0, 0, &f.info), NLC_ERROR_NULL, 1);
    demand(nlc_network_update((nlc_network *)not_a_network, &f.view, 0, &f.info), NLC_ERROR_NETWORK, -1);
    WITH(f.view.struct_size, 1u << 20, update(), NLC_ERROR_STRUCT_SIZE, 1);
    WITH(f.view.count, 3, update(), NLC_ERROR_COUNT, 1);
    WITH(f.view.wall_count, 2, update(), NLC_ERROR_COUNT, 1);
    WITH(f.view.material_count, 2, update(), NLC_ERROR_COUNT, 1);
    WITH(f.view.radius, 0, update(), NLC_ERROR_NULL_FIELD, offsetof(nlc_particles, radius));
    WITH(f.view.radius_stride, 4, update(), NLC_ERROR_STRIDE, offsetof(nlc_particles, radius_stride));
    WITH(f.s.radius[2], NAN, update(), NLC_ERROR_RADIUS, 2);
    WITH(f.s.rows[0].young, -1, update(), NLC_ERROR_YOUNG, 0);
    WITH(f.s.rows[0].poisson, 0.6, update(), NLC_ERROR_POISSON, 0);
    WITH(f.s.material[1], 3, update(), NLC_ERROR_MATERIAL, 1);
    WITH(f.s.material[0], 1, update(), NLC_ERROR_RIGID_RIGID, 3);
    WITH(f.s.radius[0], 1e305, update(), NLC_ERROR_RANGE, -1);
    stiffness_given = new_stiffness;
    WITH(new_stiffness[3], 0, update(), NLC_ERROR_STIFFNESS, 3);
    stiffness_given = 0;
    f.s.radius[2] = 2;
    ck_assert_int_eq(update(), NLC_OK);
    ck_assert_int_eq(solve(), NLC_OK);
    f.s.rows[0].young = 1e-30; /* the new coefficients are looked at */
    ck_assert_int_eq(update(), NLC_OK);
    f.force[1] = 1e300;
    keep();
    demand(sweep(), NLC_ERROR_RANGE, -1);
}
END_TEST

/* of callbacks: the number so far, of the one that fails, of that where another rank has, of that where it has heard of it, and leaves */
static int64_t calls, fails, fails_elsewhere, leaves;

static int exchange(void *context, double *side)
{
    (void)context, (void)side;
    return ++calls == fails ? 42 : 0;
}

static int reduce(void *context, double *values, int32_t count, int32_t operation)
{
    (void)context, (void)count, (void)operation;
    if (++calls == fails_elsewhere) values[0] = 1;
    if (calls == leaves) values[0] = 0x1p40;
    return calls == fails ? 42 : 0;
}

/* A network shared out among ranks, of which this is the only one. */
START_TEST(ranks)
{
    f.options.exchange = exchange;
    WITH(f.options.owned_particles, 3, nlc_set_options(f.s.network, &f.options, &f.info), NLC_ERROR_NULL_FIELD,
         offsetof(nlc_options, reduce));
    f.options.exchange = 0, f.options.reduce = reduce;
    WITH(f.options.owned_particles, 3, nlc_set_options(f.s.network, &f.options, &f.info), NLC_ERROR_NULL_FIELD,
         offsetof(nlc_options, exchange));
    f.options.reduce = 0;
    WITH(f.options.owned_particles, 3, init(), NLC_ERROR_NULL_FIELD, offsetof(nlc_options, exchange));
    f.options.exchange = exchange, f.options.reduce = reduce;
    WITH(f.options.owned_particles, 5, init(), NLC_ERROR_OPTION, offsetof(nlc_options, owned_particles));
    WITH(f.options.owned_particles, -1, init(), NLC_ERROR_OPTION, offsetof(nlc_options, owned_particles));
    WITH(f.options.owned_particles, 1, init(), NLC_ERROR_GHOST, 1);
    WITH(f.options.owned_particles, 1, nlc_set_options(f.s.network, &f.options, &f.info), NLC_ERROR_GHOST, 1);
    WITH(f.options.owned_particles, 5, nlc_set_options(f.s.network, &f.options, &f.info), NLC_ERROR_OPTION,
         offsetof(nlc_options, owned_particles));
    ck_assert_int_eq(nlc_set_options(f.s.network, &f.options, &f.info), NLC_OK);
    keep();
    for (fails = 1; fails < 4; fails++) {
        calls = 0;
        demand(solve(), NLC_ERROR_CALLBACK, 42);
        ck_assert_int_eq(calls, fails == 3 ? 6 : fails == 2 ? 5 : 3); /* two reductions more, an exchange if it is due */
    }
    for (fails = 2, leaves = 3; fails < 4; fails++, leaves = 5) { /* nobody needs to be told */
        calls = 0;
        demand(solve(), NLC_ERROR_CALLBACK, 42);
        ck_assert_int_eq(calls, leaves);
    }
    fails = leaves = 0;
    for (fails_elsewhere = 2; fails_elsewhere < 4; fails_elsewhere++) {
        calls = 0;
        demand(solve(), NLC_ERROR_REMOTE, -1);
        ck_assert_int_eq(calls, fails_elsewhere == 2 ? 3 : 5);
    }
}
END_TEST

/* Must be the last test: every error of the list has been caused by one before. */
START_TEST(every_error_was_met)
{
#define MET(name, value, text, culprit)                                                                                     \
    if ((value) < 0) ck_assert_msg(met[(value) < 0 ? -(value) : 0], "%s is never tested", #name);
    NLC_STATUS_LIST(MET)
#undef MET
}
END_TEST

/* Nothing to do is no error, and needs no arrays. */
START_TEST(empty_networks)
{
    nlc_particles none = {.struct_size = sizeof none};
    const size_t size = nlc_network_size(&none, 0, 0);
    ck_assert_uint_gt(size, 0);
    void *memory = malloc(size);
    nlc_network *network = 0;
    ck_assert_int_eq(nlc_network_init(&network, memory, size, &none, 0, 0, 0, 0, 0), NLC_OK);
    ck_assert_int_eq(nlc_solve(network, 0, 0, 0, 0, 0), NLC_OK);
    ck_assert_int_eq(nlc_sweep(network, 0, 0, 0, 0, 0), NLC_OK);
    ck_assert_int_eq(nlc_assemble(network, 0, 0, 0, 0, 0, 0), NLC_OK);
    ck_assert_int_eq(nlc_assemble_sliding(network, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0), NLC_OK);
    ck_assert_int_eq(nlc_set_options(network, 0, 0), NLC_OK);
    double e = 77;
    ck_assert_int_eq(nlc_energy(network, &e, 0, 0, 0, 0), NLC_OK);
    nlc_assert_same(e, 0);
    ck_assert_int_eq(nlc_tangent(network, 0, 0, 0, 0, 0), NLC_OK);
    ck_assert_int_eq(nlc_tangent_inverse(network, 0, 0, 0, 0, 0), NLC_OK);
    ck_assert_int_eq(nlc_tangent_bound(network, 0, 0, 0, 0), NLC_OK);
    free(memory);
}
END_TEST

/* Particles that do not touch: nothing holds them, in every model and whatever the units. */
START_TEST(particles_without_contacts)
{
    for (int model = 0; model < 6; model++)
        for (int e = -800; e <= 800; e += 400) {
            scene s;
            scene_init(&s);
            s.options.model = model;
            const int32_t m = scene_material(&s, ldexp(1, e), 0.3);
            for (int k = 0; k < 3; k++) scene_particle(&s, 1 + k, m);
            ck_assert_int_eq(scene_build(&s), NLC_OK);
            double bound[3] = {7, 7, 7}, energy = 7;
            const bool potential = model != NLC_MODEL_HALF_SPACE && model != NLC_MODEL_LOVE;
            nlc_assert_quiet(ck_assert_int_eq(nlc_tangent_bound(s.network, bound, 0, 0, 0), potential ? NLC_OK : NLC_ERROR_NO_POTENTIAL));
            for (int k = 0; k < 3; k++) nlc_assert_same(bound[k], potential ? 0 : 7);
            ck_assert_int_eq(nlc_energy(s.network, &energy, 0, 0, 0, 0), potential ? NLC_OK : NLC_ERROR_NO_POTENTIAL);
            nlc_assert_same(energy, potential ? 0 : 7);
            scene_free(&s);
        }
}
END_TEST

/* An info without its size: nothing can be said there, and nothing is done. */
START_TEST(info_without_a_size)
{
    static const size_t bad[] = {0, sizeof(size_t) - 1, 4097, SIZE_MAX};
    uint64_t key[5] = {0}, work[40];
    set_up_host();
    nlc_model_record record = {.struct_size = sizeof record};
    nlc_network *n = f.s.network;
    for (int b = 0; b < 4; b++) {
        nlc_info info, info_before;
        memset(&info, 0xa5, sizeof info);
        info.struct_size = bad[b];
        info_before = info;
        keep();
        h_before = h;
        const nlc_status status[] = {
            nlc_model_info(0, &record, &info),
            nlc_network_init(&n, f.s.memory, f.size, &f.view, f.s.i, f.s.j, 5, &f.options, &info),
            nlc_network_update(n, &f.view, NULL, &info),
            nlc_set_options(n, &f.options, &info),
            nlc_solve(n, f.force, f.nonlocal, f.s.overlap, f.s.normal, &info),
            nlc_sweep(n, f.displacement, f.force, f.s.overlap, f.s.normal, &info),
            nlc_energy(n, f.F, f.force, f.s.overlap, f.s.normal, &info),
            nlc_tangent(n, f.F, f.s.overlap, f.force, f.s.normal, &info),
            nlc_tangent_inverse(n, f.F, f.force, f.force, f.s.normal, &info),
            nlc_tangent_bound(n, f.F, f.force, f.s.normal, &info),
            nlc_assemble(n, f.F, 0, f.F_wall, f.force, f.s.normal, &info),
            nlc_assemble_turning(n, f.F, 0, f.force, f.s.overlap, f.s.normal, &info),
            nlc_assemble_sliding(n, f.F, 0, f.torque, 0, f.F_wall, f.force, f.s.normal, f.sliding, f.displacement, f.s.overlap, 0.5, &info),
            nlc_predict(f.nonlocal, f.force, 5, 1, &info),
            nlc_reach(n, &h.reach, h.b, f.force, &info),
            nlc_carry(f.nonlocal, key, 5, f.force, key, 5, work, sizeof work, &info),
            nlc_contacts_from_pairs(h.overlap, h.out, &h.particles, &h.positions, h.i, h.j, 3, &info),
            nlc_contacts_from_lists(&h.count, h.found_i, h.found_j, 9, &h.particles, &h.positions, &h.lists, 0.5, &info),
            nlc_order(n, h.found_i, (int64_t *)key, &info),
        };
        for (size_t k = 0; k < sizeof status / sizeof *status; k++)
            ck_assert_msg(status[k] == NLC_ERROR_STRUCT_SIZE, "function %zu, size %zu: %s", k, bad[b], nlc_strerror(status[k]));
        ck_assert(memcmp(&info, &info_before, sizeof info) == 0);
        ck_assert(memcmp(&h, &h_before, sizeof h) == 0 && memcmp(memory_before, f.s.memory, f.size) == 0 && f.s.network == n);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("errors");
    TCase *t = tcase_create("errors");
    tcase_add_checked_fixture(t, setup, teardown);
    tcase_add_test(t, particles_and_contacts);
    tcase_add_test(t, stiffness_out_of_range);
    tcase_add_test(t, same_direction_left_out);
    tcase_add_test(t, counts_strides_and_memory);
    tcase_add_test(t, null_pointers);
    tcase_add_test(t, options);
    tcase_add_test(t, struct_sizes);
    tcase_add_test(t, arrays_over_contacts);
    tcase_add_test(t, long_lists);
    tcase_add_test(t, same_direction_in_the_next_step);
    tcase_add_test(t, stiffest_and_softest);
    tcase_add_test(t, same_direction_and_range);
    tcase_add_test(t, energy_and_tangent);
    tcase_add_test(t, models);
    tcase_add_test(t, sliding);
    tcase_add_test(t, prediction);
    tcase_add_test(t, hosts);
    tcase_add_test(t, hosts_arguments);
    tcase_add_test(t, carrying);
    tcase_add_test(t, updates);
    tcase_add_test(t, empty_networks);
    tcase_add_test(t, particles_without_contacts);
    tcase_add_test(t, ranks);
    tcase_add_test(t, every_error_was_met);
    tcase_add_test(t, info_without_a_size);
    suite_add_tcase(suite, t);
    setenv("CK_FORK", "no", 1); /* every_error_was_met looks at what the others did */
    return run_suite(suite);
}
