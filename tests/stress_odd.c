/* SPDX-License-Identifier: BSD-2-Clause */
/* stress_odd.c - contacts next to and upon each other, numbers from one end of double to the other, hardly any contacts. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stress.h"

TCase *stress_odd(void);

/* A cluster with two more contacts on its centre, apart from each other by an angle [rad]; the last one may be a gap. */
static void pair_on_cluster(scene *s, int seed, double apart, double second)
{
    static const double x[] = {0.36, 0.48, 0.8}, y[] = {0.8, -0.6, 0}; /* at a right angle */
    rng g = {(uint64_t)seed};
    scene_init(s);
    scene_cluster(s, &g, 6, 0.6);
    const int32_t rigid = scene_material(s, INFINITY, 0), wall = (int32_t)(s->particles + scene_wall(s, rigid));
    const double side = seed % 2 ? 1 : -1; /* the particle as i and as j */
    for (int k = 0; k < 2; k++) {
        const double v[3] = {x[0] + k * apart * y[0], x[1] + k * apart * y[1], x[2] + k * apart * y[2]};
        const double overlap = k == 0 ? 2e-5 : second;
        scene_contact(s, side > 0 ? 0 : wall, side > 0 ? wall : 0, overlap, side * v[0], side * v[1], side * v[2]);
    }
}

/*
 * Forces are finite and, where they are said to have converged, satisfy the equations; which of the solutions it is, no one can
 * say.  From 1e-4 rad down most solves do not converge, and take all the sweeps allowed, however simple the scene.
 */
START_TEST(close_contacts)
{
    tally t;
    tally_begin(&t, 0, "1e-3 to 1e-12 rad apart");
    for (double apart = 1e-3; apart > 5e-13; apart /= 10)
        for (int seed = 0; seed < (full() ? 20 : 4); seed++)
            for (int second = 0; second < 4; second++) {
                scene s;
                pair_on_cluster(&s, seed, apart, (const double[]){2e-5, 1.9e-5, 1e-6, -1e-6}[second]);
                for (double tolerance = 1e-10; tolerance < 1e-5; tolerance *= 1e4) solve_stable(&t, &s, 0, 1, tolerance);
                scene_free(&s);
            }
    tally_end(&t, 0);
}
END_TEST

static void demand_coincident(scene *s, int64_t last)
{
    const size_t size = (size_t)s->contacts * sizeof(double);
    double *force = malloc(size), *nonlocal = malloc(size);
    nlc_info info = {.struct_size = sizeof info};
    ck_assert_int_eq(scene_build(s), NLC_OK);
    rng g = {5};
    for (int64_t c = 0; c < s->contacts; c++)
        s->force[c] = rng_uniform(&g, -1, 1), s->nonlocal[c] = rng_uniform(&g, -1e-5, 1e-5);
    memcpy(force, s->force, size);
    memcpy(nonlocal, s->nonlocal, size);
    fp_trap();
    const nlc_status status = nlc_solve(s->network, s->force, s->nonlocal, s->overlap, s->normal, &info);
    fp_untrap();
    ck_assert_int_eq(status, NLC_ERROR_COINCIDENT);
    ck_assert_msg(info.culprit == last || info.culprit == last - 1, "culprit %jd", (intmax_t)info.culprit);
    ck_assert(memcmp(force, s->force, size) == 0 && memcmp(nonlocal, s->nonlocal, size) == 0);
    free(force), free(nonlocal);
}

/* In the very same place: an error that names one of the two, and not a bit of the results has changed. */
START_TEST(coincident_contacts)
{
    for (int seed = 0; seed < 20; seed++)
        for (int second = 0; second < 4; second++) { /* the last one is far from touching, and not iterated on */
            scene s;
            pair_on_cluster(&s, seed, 0, (const double[]){2e-5, 1e-9, -1e-6, -1e-3}[second]);
            demand_coincident(&s, s.contacts - 1);
            for (int64_t c = 0; c < s.contacts - 2; c++) s.overlap[c] = -1; /* the only ones that are solved for, or none is */
            demand_coincident(&s, s.contacts - 1);
            scene_free(&s);
        }
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------ numbers -- */

/* A cluster, and a packing beyond its end; lengths by 4^a, moduli by 2^b. */
static void scene_in_units(scene *s, int which, int a, int b)
{
    rng g = {3};
    scene_init(s);
    if (which == 0)
        scene_cluster(s, &g, 10, 0.5);
    else
        scene_packing(s, "b_die125_rd0.80.csv", 0.3);
    for (int64_t k = 0; k < s->particles; k++) s->radius[k] = ldexp(s->radius[k], 2 * a);
    for (int64_t m = 0; m < s->materials; m++) {
        s->rows[m].young = ldexp(s->rows[m].young, b);
        if (which == 1) s->rows[m].poisson = 0.45;
    }
    for (int64_t c = 0; c < s->contacts; c++) s->overlap[c] = ldexp(s->overlap[c], 2 * a);
}

/*
 * The same answer to the bit in every system of units, for radii and overlaps from 1e-300 m to 1e+100 m, wherever the forces
 * are within the range of normal numbers; weakened ones, too.
 */
START_TEST(units)
{
    static const int a[] = {-496, -300, -120, -21, -1, 1, 7, 40, 120, 170};
    scene s;
    scene_in_units(&s, _i, 0, 0);
    const double load = _i ? 1.8 : 1; /* the packing's branch ends at 1.51 */
    const trial r = solve_load(&s, load, 1e-10);
    ck_assert_int_eq(r.status & NLC_WARNING_WEAKENED, _i ? NLC_WARNING_WEAKENED : 0);
    int same = 0;
    for (int k = 0; k < 10; k += full() || _i == 0 ? 1 : 3)
        for (int odd = -1; odd < 2; odd += full() || _i == 0 ? 1 : 2) {
            const int b = (a[k] < -200 ? 900 : a[k] > 200 ? -900 : -4 * a[k]) + 13 * odd;
            scene t;
            scene_in_units(&t, _i, a[k], b);
            const trial q = solve_load(&t, load, 1e-10);
            ck_assert_int_eq(r.status, q.status);
            ck_assert_int_eq(r.info.sweeps, q.info.sweeps);
            for (int64_t c = 0; c < s.contacts; c++) {
                const double force = ldexp(s.force[c], 4 * a[k] + b), nonlocal = ldexp(s.nonlocal[c], 2 * a[k]);
                if (fabs(nonlocal) < DBL_MIN || (force < DBL_MIN && s.force[c] != 0)) continue;
                nlc_assert_same(t.force[c], force);
                same++;
                nlc_assert_same(t.nonlocal[c], nonlocal);
            }
            scene_free(&t);
        }
    ck_assert_int_gt(same, (_i ? 3 : 10) * (int)s.contacts);
    scene_free(&s);
}
END_TEST

/* CGS instead of SI, which is no power of two: to rounding, stable or to twice the tolerance where weakened. */
START_TEST(centimetres_and_grams)
{
    scene s, t;
    scene_in_units(&s, 1, 0, 0);
    scene_in_units(&t, 1, 0, 0);
    for (int64_t k = 0; k < t.particles; k++) t.radius[k] *= 100;
    for (int64_t m = 0; m < t.materials; m++) t.rows[m].young *= 10;
    for (int64_t c = 0; c < t.contacts; c++) t.overlap[c] *= 100;
    for (int l = 0; l < 4; l++) {
        const double load = (const double[]){0.01, 1, 1.45, 1.7}[l];
        const trial r = solve_load(&s, load, 1e-10), q = solve_load(&t, load, 1e-10);
        long double *force = malloc((size_t)s.contacts * sizeof *force);
        ck_assert_int_eq(r.status, q.status);
        for (int64_t c = 0; c < s.contacts; c++) force[c] = 1e5L * s.force[c];
        ck_assert_msg(scene_error(&s, t.force, force) <= 2e-10, "%g", scene_error(&s, t.force, force));
        free(force);
    }
    scene_free(&s);
    scene_free(&t);
}
END_TEST

/* Overlaps from subnormal ones to 1e+100 of grains that stay as they are; small ones do not feel each other. */
START_TEST(extreme_overlaps)
{
    for (int x = -325; x <= 100; x += 5) {
        rng g = {3};
        scene s;
        scene_init(&s);
        scene_cluster(&s, &g, 10, 0.5);
        for (int64_t c = 0; c < s.contacts; c++) s.overlap[c] = s.overlap[c] * 1e5 * pow(10, x); /* about 1 at 0 */
        const trial r = solve_load(&s, 1, 1e-8);
        if (x <= -30) ck_assert_int_eq(r.status, NLC_OK);
        for (int64_t c = 0; c < s.contacts && x <= -30; c++) {
            const double alone = nlc_hertz_force((double)scene_stiffness(&s, c), s.overlap[c]);
            nlc_assert_abs(s.force[c], alone, 1e-8 * alone + 1e-320);
        }
        scene_free(&s);
    }
}
END_TEST

/* ------------------------------------------------------------------------------------------------------- few contacts -- */

START_TEST(few_contacts)
{
    rng g = {3};
    scene s;
    scene_init(&s); /* none */
    scene_particle(&s, 1, scene_material(&s, 1, 0.3));
    const trial none = solve_load(&s, 1, 1e-10);
    ck_assert(none.status == NLC_OK && none.info.sweeps == 0 && none.info.active == 0);
    scene_free(&s);

    scene_init(&s);
    scene_cluster(&s, &g, 12, 0.5); /* nothing touches */
    for (int64_t c = 0; c < s.contacts; c++) s.overlap[c] = -rng_uniform(&g, 0, 1e-5);
    const trial gaps = solve_load(&s, 1, 1e-10);
    ck_assert(gaps.status == NLC_OK && gaps.info.active == 0);
    for (int64_t c = 0; c < s.contacts; c++) ck_assert(s.force[c] == 0 && s.nonlocal[c] == 0);
    for (int64_t only = 0; only < s.contacts; only++) { /* one does */
        const double gap = s.overlap[only];
        s.overlap[only] = 1e-7;
        cold(&s);
        const trial one = solve_load(&s, 1, 1e-10);
        ck_assert(one.status == NLC_OK && one.info.active == 1);
        nlc_assert_rel(s.force[only], nlc_hertz_force((double)scene_stiffness(&s, only), 1e-7), 1e-14);
        s.overlap[only] = gap;
    }
    scene_free(&s);
}
END_TEST

/* In a packing, all contacts of one grain open but one, one after the other; and from there back to what it was. */
START_TEST(all_open_but_one)
{
    tally t;
    scene s;
    tally_begin(&t, 0, "all open but one");
    scene_init(&s);
    scene_packing(&s, "b_die125_rd0.70.csv", 0.3);
    double *overlap = malloc((size_t)s.contacts * sizeof *overlap);
    memcpy(overlap, s.overlap, (size_t)s.contacts * sizeof *overlap);
    for (int64_t k = 0; k < s.particles; k += full() ? 3 : 25) {
        bool kept = false;
        for (int64_t c = 0; c < s.contacts; c++) {
            const bool here = s.i[c] == k || s.j[c] == k;
            s.overlap[c] = here && (kept || overlap[c] <= 0) ? -fabs(overlap[c]) : overlap[c];
            kept |= here && overlap[c] > 0;
        }
        exact e;
        exact_init(&e, &s);
        ck_assert(exact_move(&e, 1));
        solve_stable(&t, &s, &e, 1, 1e-10);
        exact_free(&e);
    }
    free(overlap);
    scene_free(&s);
    tally_end(&t, 0);
}
END_TEST

TCase *stress_odd(void)
{
    TCase *t = tcase_create("odd");
    tcase_set_timeout(t, full() ? 0 : 300);
    tcase_add_checked_fixture(t, 0, no_misses);
    tcase_add_test(t, close_contacts);
    tcase_add_test(t, coincident_contacts);
    tcase_add_loop_test(t, units, 0, 2);
    tcase_add_test(t, centimetres_and_grams);
    tcase_add_test(t, extreme_overlaps);
    tcase_add_test(t, few_contacts);
    tcase_add_test(t, all_open_but_one);
    return t;
}
