/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_info.c - where a solve says that it is worst: the particle that is closest to the end of the stable branch, the one that is
 * weakened most, and the contact with the largest residual.
 *
 * A row of spheres between walls, of which one is squeezed by four walls a good deal more than the others: wherever it stands, and
 * whatever the others do, it is the one.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "exact.h"

enum { ROW = 5 };

/* worst: the one that is squeezed. */
static void make_row(scene *s, int worst)
{
    scene_init(s);
    const int32_t m = scene_material(s, 1e6, 0.46), rigid = scene_material(s, INFINITY, 0);
    for (int k = 0; k < ROW; k++) scene_particle(s, 1, m);
    scene_wall(s, rigid);
    for (int k = 0; k <= ROW; k++) scene_contact(s, k == 0 ? 0 : k - 1, k == 0 || k == ROW ? ROW : k, 0.01, k == 0 ? -1 : 1, 0, 0);
    for (int k = 0; k < ROW; k++)
        for (int side = 0; side < 4; side++) {
            const double y = (side < 2) * (1 - 2 * (side & 1)), z = (side >= 2) * (1 - 2 * (side & 1));
            scene_contact(s, k, ROW, k == worst ? 0.05 : 0.01, 0, y, z);
        }
}

/* It, and its network; returns the load at which its stable branch ends. */
static double build_row(scene *s, int worst)
{
    make_row(s, worst);
    const double end = (double)exact_end(s, 200, 1e-6L);
    ck_assert_int_eq(scene_build(s), NLC_OK);
    return end;
}

static nlc_status solve(scene *s, double load, double tolerance, int64_t most, nlc_info *info)
{
    double overlap[6 * ROW];
    *info = (nlc_info){.struct_size = sizeof *info};
    s->options.tolerance = tolerance;
    s->options.max_sweeps = most;
    ck_assert_int_eq(nlc_set_options(s->network, &s->options, 0), NLC_OK);
    for (int64_t c = 0; c < s->contacts; c++) overlap[c] = load * s->overlap[c];
    return nlc_solve(s->network, s->force, s->nonlocal, overlap, s->normal, info);
}

/* The state at .9999 of this load. */
static void come_close(scene *s, double load)
{
    nlc_info info;
    ck_assert_int_ge(solve(s, 0.9999 * load, 1e-10, 0, &info), 0);
}

/* Which particle decides the bound: told near the end, and where it came with a sweep of the state before. */
START_TEST(closest_to_the_end)
{
    static const double load[] = {0.1, 0.5, 0.9, 0.98, 0.99, 0.995};
    scene s;
    nlc_info info;
    const double end = build_row(&s, _i);
    for (int warm = 0; warm < 2; warm++)
        for (int l = 0; l < 6; l++) {
            double stiffness[ROW], reach[ROW], displacement[ROW];
            memset(s.nonlocal, 0, (size_t)s.contacts * sizeof *s.nonlocal);
            if (warm) come_close(&s, load[l] * end);
            const nlc_status status = solve(&s, load[l] * end, 1e-8, 0, &info);
            ck_assert_int_eq(status & ~NLC_WARNING_CLOSE, NLC_OK);
            if (l > 3 || (warm && l < 2)) ck_assert_int_eq(info.critical_particle, _i);
            else ck_assert(info.critical_particle == -1 || info.critical_particle == _i); /* it may be known of all at once */
            ck_assert_int_eq(info.weakest_particle, -1);
            ck_assert_int_eq(nlc_tangent_bound(s.network, stiffness, s.force, s.normal, &info), NLC_OK);
            ck_assert_int_eq(info.critical_particle, _i);
            ck_assert_int_eq(nlc_reach(s.network, reach, displacement, s.force, &info), NLC_OK);
            ck_assert_int_eq(info.critical_particle, _i);
        }
    scene_free(&s);
}
END_TEST

START_TEST(weakened_most)
{
    static const double load[] = {1.001, 1.01, 1.1, 2, 10};
    scene s;
    nlc_info info;
    const double end = build_row(&s, _i);
    for (int warm = 0; warm < 2; warm++)
        for (int l = 0; l < 5; l++) {
            memset(s.nonlocal, 0, (size_t)s.contacts * sizeof *s.nonlocal);
            if (warm) come_close(&s, load[l] * end);
            ck_assert_int_eq(solve(&s, load[l] * end, 1e-8, 0, &info) & ~NLC_WARNING_CLOSE, NLC_WARNING_WEAKENED);
            ck_assert_int_eq(info.weakest_particle, _i);
            ck_assert_int_eq(info.critical_particle, _i);
        }
    scene_free(&s);
}
END_TEST

/* One sweep from Hertz's forces misses most where these are largest. */
START_TEST(largest_residual)
{
    scene s;
    nlc_info info;
    make_row(&s, _i);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    for (double load = 0.01; load < 6; load *= 3) {
        memset(s.nonlocal, 0, (size_t)s.contacts * sizeof *s.nonlocal);
        ck_assert_int_eq(solve(&s, load, 1e-12, 1, &info) & ~NLC_WARNING_CLOSE, NLC_WARNING_NOT_CONVERGED);
        const int64_t c = info.worst_contact;
        ck_assert(c >= 0 && c < s.contacts && (s.i[c] == _i || s.j[c] == _i));
    }
    scene_free(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("info");
    TCase *t = tcase_create("info");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    time_limit(t, 60);
    tcase_add_loop_test(t, closest_to_the_end, 0, ROW);
    tcase_add_loop_test(t, weakened_most, 0, ROW);
    tcase_add_loop_test(t, largest_residual, 0, ROW);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
