/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_turning.c - forces as the derivative of the energy by positions: what nlc_assemble and nlc_assemble_turning add up to against
 * differences of nlc_energy, the network being solved anew for each position.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

enum { SPHERES = 7 };
static const int32_t models[] = {NLC_MODEL_GONZALEZ_CUITINO, NLC_MODEL_SPHERE, NLC_MODEL_POINT_FORCE, NLC_MODEL_HALF_SPACE};

/* Some spheres of several sizes and materials in a heap, squeezed together, on a floor. */
typedef struct heap {
    double x[SPHERES][3], radius[SPHERES], unit;
    int32_t model;
} heap;

static heap make(uint64_t seed, int32_t model)
{
    rng g = {seed};
    heap h = {.unit = 1, .model = model};
    for (int k = 0; k < SPHERES; k++) h.radius[k] = rng_uniform(&g, 0.8, 1.2);
    for (int k = 1; k < SPHERES; k++) { /* around the first one, which stands on the floor; some of them touch */
        const double turn = 1.0472 * k, up = k % 2 ? 0.5 : -0.1, apart = 0.97 * (h.radius[0] + h.radius[k]), across = sqrt(1 - up * up);
        const double v[3] = {across * cos(turn), across * sin(turn), up};
        for (int d = 0; d < 3; d++) h.x[k][d] = apart * v[d] + rng_uniform(&g, -0.01, 0.01);
    }
    return h;
}

/* The scene at these positions; to be freed. */
static void place(scene *s, const heap *h)
{
    scene_init(s);
    s->options.model = h->model;
    s->options.points = NLC_POINTS_UNDEFORMED;
    s->options.prefactor = h->model == NLC_MODEL_HALF_SPACE ? 0.7 : 0;
    s->options.tolerance = 1e-13;
    const int32_t soft = scene_material(s, 1, 0.3), hard = scene_material(s, 3, 0.1), rigid = scene_material(s, INFINITY, 0);
    for (int k = 0; k < SPHERES; k++) scene_particle(s, h->radius[k], k == 3 ? rigid : k % 2 ? soft : hard);
    const int32_t floor = SPHERES + scene_wall(s, hard);
    for (int i = 0; i < SPHERES; i++)
        for (int j = i + 1; j < SPHERES; j++) {
            const double *a = h->x[i], *b = h->x[j], v[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
            const double distance = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            if (distance < 1.1 * (h->radius[i] + h->radius[j])) scene_contact(s, i, j, h->radius[i] + h->radius[j] - distance, v[0], v[1], v[2]);
        }
    scene_contact(s, 0, floor, h->radius[0] - (h->x[0][2] + 0.97 * h->radius[0]), 0, 0, -1);
    ck_assert_int_eq(scene_solve(s, NULL), NLC_OK);
}

static double energy(const heap *h)
{
    scene s;
    double e;
    place(&s, h);
    ck_assert_int_eq(nlc_energy(s.network, &e, s.force, s.overlap, s.normal, NULL), NLC_OK);
    scene_free(&s);
    return e;
}

/*
 * Differences over 4 steps err by step^4 times the energy's fifth derivative, which is some k y^(-5/2) at an overlap y: 1e-9 of the
 * largest force at the overlaps here; and by 1e-15 or so of the energy over the step.  Asked for is 1e-8 of the largest force, of
 * which what turns is 1e-4 or more.
 */
START_TEST(derivative_of_the_energy)
{
    const double step = 5e-5;
    heap h = make((uint64_t)_i + 1, models[_i % 4]);
    scene s;
    double F[SPHERES][3] = {{0}}, turned[SPHERES][3] = {{0}}, largest = 0, most = 0, sum[3] = {0};
    place(&s, &h);
    nlc_assert_quiet(ck_assert_int_eq(nlc_assemble(s.network, F[0], 0, NULL, s.force, s.normal, NULL), NLC_OK));
    nlc_assert_quiet(ck_assert_int_eq(nlc_assemble_turning(s.network, turned[0], 0, s.force, s.overlap, s.normal, NULL), NLC_OK));
    for (int64_t c = 0; c < s.contacts; c++) largest = fmax(largest, s.force[c]);
    for (int k = 0; k < SPHERES; k++)
        for (int d = 0; d < 3; d++) {
            const double at = h.x[k][d];
            double e[5];
            for (int m = -2; m <= 2; m++) {
                h.x[k][d] = at + m * step;
                e[m + 2] = m ? energy(&h) : 0;
            }
            h.x[k][d] = at;
            const double slope = (8 * (e[3] - e[1]) - (e[4] - e[0])) / (12 * step);
            ck_assert_msg(fabs(F[k][d] + turned[k][d] + slope) <= 1e-8 * largest, "%d %d: %.10g %.10g %.10g, largest %g", k, d, F[k][d], turned[k][d], slope, largest);
            most = fmax(most, fabs(turned[k][d]));
            sum[d] += turned[k][d];
        }
    ck_assert(most > 1e-4 * largest && most < 0.2 * largest);
    for (int d = 0; d < 3; d++) ck_assert(fabs(sum[d]) <= 1e-15 * largest);
    scene_free(&s);
}
END_TEST

/* Exchanging i and j changes no bit; another unit of length and force changes the unit of the result. */
START_TEST(sides_and_units)
{
    const heap h = make((uint64_t)_i + 20, models[_i]);
    scene s;
    double F[SPHERES][3] = {{0}}, other[SPHERES][3] = {{0}};
    place(&s, &h);
    ck_assert_int_eq(nlc_assemble_turning(s.network, F[0], 0, s.force, s.overlap, s.normal, NULL), NLC_OK);
    for (int64_t c = 0; c < s.contacts; c++) {
        if (c % 2) continue;
        const int32_t i = s.i[c];
        s.i[c] = s.j[c];
        s.j[c] = i;
        for (int d = 0; d < 3; d++) s.normal[3 * c + d] *= -1;
    }
    double *force = malloc((size_t)s.contacts * sizeof *force);
    memcpy(force, s.force, (size_t)s.contacts * sizeof *force);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    ck_assert_int_eq(nlc_assemble_turning(s.network, other[0], 0, force, s.overlap, s.normal, NULL), NLC_OK);
    ck_assert_int_eq(memcmp(F, other, sizeof F), 0);
    /* lengths times 2^40 at the same moduli: forces times 2^80 */
    for (int k = 0; k < SPHERES; k++) s.radius[k] *= 0x1p40;
    for (int64_t c = 0; c < s.contacts; c++) {
        s.overlap[c] *= 0x1p40;
        force[c] *= 0x1p80;
    }
    memset(other, 0, sizeof other);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    ck_assert_int_eq(nlc_assemble_turning(s.network, other[0], 0, force, s.overlap, s.normal, NULL), NLC_OK);
    for (int k = 0; k < SPHERES; k++)
        for (int d = 0; d < 3; d++) nlc_assert_same(other[k][d], 0x1p80 * F[k][d]);
    free(force);
    scene_free(&s);
}
END_TEST

/*
 * Circles are no larger than the smaller sphere: with forces beyond that, what turns is proportional to the products of two.  Also where
 * the approach would be beyond double, of forces of 1e200 and a stiffness of the caller's.
 */
START_TEST(largest_circles)
{
    const heap h = make(40, NLC_MODEL_SPHERE);
    scene s;
    double F[SPHERES][3] = {{0}}, other[SPHERES][3] = {{0}}, *stiffness;
    place(&s, &h);
    stiffness = malloc((size_t)s.contacts * sizeof *stiffness);
    for (int64_t c = 0; c < s.contacts; c++) {
        stiffness[c] = 1e-300;
        s.force[c] *= _i ? 1e200 : 1e9;
    }
    if (_i) {
        for (int64_t m = 0; m < s.materials; m++) s.rows[m].young *= 1e250;
        s.options.stiffness = stiffness;
    }
    double *force = malloc((size_t)s.contacts * sizeof *force);
    memcpy(force, s.force, (size_t)s.contacts * sizeof *force);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    nlc_assert_quiet(ck_assert_int_eq(nlc_assemble_turning(s.network, F[0], 0, force, s.overlap, s.normal, NULL), NLC_OK));
    for (int64_t c = 0; c < s.contacts; c++) force[c] *= 4;
    nlc_assert_quiet(ck_assert_int_eq(nlc_assemble_turning(s.network, other[0], 0, force, s.overlap, s.normal, NULL), NLC_OK));
    for (int k = 0; k < SPHERES; k++)
        for (int d = 0; d < 3; d++) nlc_assert_same(other[k][d], 16 * F[k][d]);
    ck_assert(fabs(F[1][2]) > 0);
    free(force), free(stiffness);
    scene_free(&s);
}
END_TEST

/* Each wrong argument has its error, and nothing is added. */
START_TEST(what_is_refused)
{
    const heap h = make(30, NLC_MODEL_GONZALEZ_CUITINO);
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    double F[SPHERES][3] = {{0}};
    place(&s, &h);
    nlc_network *n = s.network;
#define REFUSED(call, error, what) \
    nlc_assert_quiet(ck_assert_int_eq(call, error)); \
    ck_assert_int_eq(info.culprit, what); \
    for (int k = 0; k < SPHERES; k++) ck_assert(F[k][0] == 0 && F[k][1] == 0 && F[k][2] == 0)
    REFUSED(nlc_assemble_turning(NULL, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_NULL, 0);
    uint64_t not_a_network[40] = {0};
    REFUSED(nlc_assemble_turning((nlc_network *)not_a_network, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_NETWORK, -1);
    REFUSED(nlc_assemble_turning(n, NULL, 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_NULL, 1);
    REFUSED(nlc_assemble_turning(n, F[0], 0, NULL, s.overlap, s.normal, &info), NLC_ERROR_NULL, 3);
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, NULL, s.normal, &info), NLC_ERROR_NULL, 4);
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, NULL, &info), NLC_ERROR_NULL, 5);
    REFUSED(nlc_assemble_turning(n, F[0], 8, s.force, s.overlap, s.normal, &info), NLC_ERROR_STRIDE, 2);
    const double overlap = s.overlap[0], force = s.force[0];
    s.overlap[0] = 5;
    s.force[0] = 1;
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_OVERLAP, 0);
    s.overlap[0] = NAN;
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_OVERLAP, 0);
    s.overlap[0] = -1.7e308;
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_RANGE, -1);
    s.overlap[0] = overlap;
    s.force[0] = INFINITY;
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_FORCE, 0);
    s.force[0] = 1e300;
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_RANGE, -1);
    s.force[0] = s.force[1] = 1;
    memcpy(s.normal + 3, s.normal, 3 * sizeof *s.normal); /* both are on sphere 0, as i */
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_COINCIDENT, 1);
    s.force[0] = force;
    s.options.model = NLC_MODEL_LOVE;
    ck_assert_int_eq(nlc_set_options(n, &s.options, NULL), NLC_OK);
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_NO_POTENTIAL, NLC_MODEL_LOVE);
    s.options.model = NLC_MODEL_HERTZ;
    ck_assert_int_eq(nlc_set_options(n, &s.options, NULL), NLC_OK);
    REFUSED(nlc_assemble_turning(n, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_OK, -1); /* nothing is coupled */
    scene_free(&s);
    scene_init(&s); /* distances of centres are beyond double */
    const int32_t m = scene_material(&s, 1e-5, 0.3);
    for (int k = 0; k < 3; k++) scene_particle(&s, 1.7e308, m);
    for (int k = 0; k < 2; k++) scene_contact(&s, k, k + 1, 1, 1, k, 0);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    s.force[0] = s.force[1] = 1;
    REFUSED(nlc_assemble_turning(s.network, F[0], 0, s.force, s.overlap, s.normal, &info), NLC_ERROR_RANGE, -1);
    scene_free(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("turning");
    TCase *t = tcase_create("turning");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    tcase_add_loop_test(t, derivative_of_the_energy, 0, 12);
    tcase_add_loop_test(t, sides_and_units, 0, 4);
    tcase_add_loop_test(t, largest_circles, 0, 2);
    tcase_add_test(t, what_is_refused);
    time_limit(t, 60);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
