/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_energy.c - a dense packing let go: what its energy does under velocity Verlet, by how the forces are found.
 *
 * A packing at rest gets random velocities with a thousandth of its elastic energy; changes of the energy are in units of that.  The
 * integrator keeps a Hamiltonian that differs from the energy in the square of the time step, as long as the forces are -dE/dx: then
 * the energy has waves that shrink to a quarter with half the step, and no drift.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"
#include "vibration.h"

#define KICK 1e-3

static const int32_t models[] = {NLC_MODEL_GONZALEZ_CUITINO, NLC_MODEL_SPHERE, NLC_MODEL_POINT_FORCE};

typedef struct packing_at_rest {
    vibration s;
    double *state, limit;
    int32_t model;
} packing_at_rest;

static void come_to_rest(packing_at_rest *a, const char *name, vibration_forces kind, int32_t model)
{
    char path[1024], error[PACKING_ERROR_SIZE];
    snprintf(path, sizeof path, "%s/bench/data/%s", NLC_SOURCE_DIR, name);
    a->model = model;
    ck_assert_msg(vibration_open(&a->s, path, error, sizeof error) == 0, "%s", error);
    ck_assert(vibration_use(&a->s, kind, model, 1e-8) == 0 && vibration_limit(&a->s, &a->limit) == 0);
    ck_assert_int_eq(vibration_relax(&a->s, 0.4 * a->limit, 1e-2, 1000), 0);
    a->state = malloc(6 * (size_t)a->s.p.count * sizeof *a->state);
    vibration_save(&a->s, a->state);
}

static void leave(packing_at_rest *a)
{
    free(a->state);
    vibration_free(&a->s);
}

/* Largest change of the energy in so many steps of a part of the largest stable one. */
static double change(packing_at_rest *a, vibration_forces kind, double step, int steps, double kick)
{
    double kinetic, elastic, start, unit, most = 0;
    vibration_restore(&a->s, a->state);
    ck_assert_int_eq(vibration_use(&a->s, kind, a->model, 1e-10), 0);
    ck_assert_int_eq(vibration_energy(&a->s, &kinetic, &elastic), 0);
    vibration_kick(&a->s, unit = kick * elastic);
    start = elastic + unit;
    for (int k = 0; k < steps; k++) {
        ck_assert_int_eq(vibration_step(&a->s, step * a->limit), 0);
        ck_assert_int_eq(vibration_energy(&a->s, &kinetic, &elastic), 0);
        most = fmax(most, fabs(kinetic + elastic - start));
    }
    return most / unit;
}

/* Waves of 3e-5 in steps of 0.05, a quarter of it in half the step; the reader of a ratio sees contacts open and close, too. */
START_TEST(second_order)
{
    packing_at_rest a;
    come_to_rest(&a, "b_die125_rd0.70.csv", VIBRATION_TURNING, models[_i]);
    const double coarse = change(&a, VIBRATION_TURNING, 0.05, 150, KICK), fine = change(&a, VIBRATION_TURNING, 0.025, 300, KICK);
    if (verbose()) printf("model %d: %.2e, %.2e with half the step: %.2f\n", models[_i], coarse, fine, coarse / fine);
    ck_assert(coarse < 1e-4 && coarse > 3.6 * fine && coarse < 4.4 * fine);
    leave(&a);
}
END_TEST

/* Along the normals alone, or by displacements of the step before, a hundred times as much and more. */
START_TEST(what_does_not_keep_it)
{
    packing_at_rest a;
    come_to_rest(&a, "b_die125_rd0.70.csv", VIBRATION_TURNING, models[_i]);
    const double all = change(&a, VIBRATION_TURNING, 0.05, 150, KICK), along = change(&a, VIBRATION_CONVERGED, 0.05, 150, KICK),
                 lagged = change(&a, VIBRATION_LAGGED, 0.05, 150, KICK);
    if (verbose()) printf("model %d: %.2e, along normals %.2e, lagged %.2e\n", models[_i], all, along, lagged);
    ck_assert(along > 100 * all && lagged > 100 * all);
    leave(&a);
}
END_TEST

/* A periodic box; Hertz' law; and vibrations in which spheres leave their neighbours, so that these are looked for anew. */
START_TEST(boxes_and_lists)
{
    packing_at_rest a;
    if (_i == 0) come_to_rest(&a, "a_mono1000_periodic.csv", VIBRATION_TURNING, NLC_MODEL_GONZALEZ_CUITINO);
    if (_i == 1) come_to_rest(&a, "b_die125_rd0.70.csv", VIBRATION_HERTZ, NLC_MODEL_HERTZ);
    if (_i == 2) come_to_rest(&a, "b_die125_rd0.70.csv", VIBRATION_TURNING, NLC_MODEL_GONZALEZ_CUITINO);
    const double d = change(&a, _i == 1 ? VIBRATION_HERTZ : VIBRATION_TURNING, 0.05, _i == 2 ? 200 : 50, _i == 2 ? 1 : KICK);
    if (verbose()) printf("%d: %.2e, %d lists, %d changes of contacts\n", _i, d, (int)a.s.lists, (int)a.s.changes);
    ck_assert(d < (_i == 2 ? 1e-3 : 2e-4));
    ck_assert(_i < 2 || (a.s.lists > 1 && a.s.changes > 100));
    leave(&a);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("energy");
    TCase *t = tcase_create("energy");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    time_limit(t, 120);
    tcase_add_loop_test(t, second_order, 0, 3);
    tcase_add_loop_test(t, what_does_not_keep_it, 0, 3);
    tcase_add_loop_test(t, boxes_and_lists, 0, 3);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
