/* SPDX-License-Identifier: BSD-2-Clause */
/* test_models.c - the table of models says what the models do. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "scene.h"

static nlc_model_record record_of(int32_t model)
{
    nlc_model_record record = {.struct_size = sizeof record};
    nlc_info info = {.struct_size = sizeof info};
    nlc_assert_quiet(ck_assert_int_eq(nlc_model_info(model, &record, &info), NLC_OK));
    ck_assert_int_eq(info.culprit, -1);
    ck_assert_uint_eq(record.struct_size, sizeof record);
    return record;
}

START_TEST(numbers_and_names_are_for_good)
{
    static const struct {
        int32_t number;
        const char *name;
    } known[] = {
        {NLC_MODEL_GONZALEZ_CUITINO, "gonzalez-cuitino"}, {NLC_MODEL_HERTZ, "hertz"},   {NLC_MODEL_HALF_SPACE, "half-space"},
        {NLC_MODEL_LOVE, "love"},                         {NLC_MODEL_SPHERE, "sphere"}, {NLC_MODEL_POINT_FORCE, "point-force"},
    };
    enum { KNOWN = sizeof known / sizeof known[0] };
    ck_assert_int_eq(nlc_model_count(), KNOWN);
    for (int k = 0; k < KNOWN; k++) {
        ck_assert_str_eq(record_of(known[k].number).name, known[k].name);
        ck_assert_int_eq(nlc_model_find(known[k].name), known[k].number);
    }
}
END_TEST

START_TEST(every_row_is_filled_in)
{
    for (int32_t model = 0; model < nlc_model_count(); model++) {
        const nlc_model_record r = record_of(model);
        ck_assert(strlen(r.name) > 0 && strlen(r.name) <= 16); /* bench prints columns of that width */
        ck_assert_uint_eq(strspn(r.name, "abcdefghijklmnopqrstuvwxyz-"), strlen(r.name));
        ck_assert_uint_gt(strlen(r.reference), 0);
        ck_assert(r.doi[0] == 0 || strncmp(r.doi, "10.", 3) == 0);
        ck_assert_uint_gt(strlen(r.validity), 0);
        ck_assert(r.cost >= 0 && r.cost < 100);
    }
    ck_assert(record_of(NLC_MODEL_GONZALEZ_CUITINO).cost == 1);
}
END_TEST

/*
 * A sphere on two rigid plates 70 degrees apart: displacement of plate 0, which has the force own.  Where the model reads
 * displacements they are not the same at both.
 */
static double displacement_of(int32_t model, double own, double other, bool swapped)
{
    scene s;
    scene_init(&s);
    const int32_t soft = scene_material(&s, 1, 0.2), rigid = scene_material(&s, INFINITY, 0);
    scene_particle(&s, 1, soft);
    for (int w = 0; w < 2; w++) scene_wall(&s, rigid);
    scene_contact(&s, 0, 1, 0.02, 0, 0, 1);
    scene_contact(&s, 0, 2, 0.02, sin(70 * M_PI / 180), 0, cos(70 * M_PI / 180));
    s.options.model = model;
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    double displacement[4] = {swapped ? 0.03 : 0.01, 0, swapped ? 0.01 : 0.03, 0};
    const double force[2] = {own, other};
    ck_assert_int_eq(nlc_sweep(s.network, displacement, force, s.overlap, s.normal, NULL), NLC_OK);
    scene_free(&s);
    return displacement[0];
}

static bool differ(double a, double b, double tolerance)
{
    return fabs(a - b) > tolerance * fmax(fabs(a), fabs(b));
}

/* Its change with the other force, by a central difference: off by 1e-8 of the terms with circles. */
static double coefficient(int32_t model, double own, double other, bool swapped)
{
    const double step = 1e-4 * other;
    return (displacement_of(model, own, other + step, swapped) - displacement_of(model, own, other - step, swapped)) / (2 * step);
}

START_TEST(rows_say_what_models_do)
{
    for (int32_t model = 0; model < nlc_model_count(); model++) {
        const nlc_model_record r = record_of(model);
        const double there = coefficient(model, 1e-3, 3e-3, false), back = coefficient(model, 3e-3, 1e-3, true);
        ck_assert_int_eq(r.symmetric, !differ(there, back, 1e-7)); /* the others differ by 1e-3 */
        ck_assert_int_eq(r.self_term, differ(displacement_of(model, 1e-3, 0, false), 0, 0));
        const double once = displacement_of(model, 0, 1e-3, false), twice = displacement_of(model, 0, 2e-3, false);
        ck_assert_int_eq(r.circles, differ(2 * once, twice, 1e-12));
    }
}
END_TEST

START_TEST(energy_where_the_row_says_so)
{
    for (int32_t model = 0; model < nlc_model_count(); model++) {
        scene s;
        const double stretch[3] = {0.98, 0.98, 0.98};
        scene_init(&s);
        scene_cell(&s, SIMPLE_CUBIC, 1, 1, 0.3, stretch);
        s.options.model = model;
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        ck_assert_int_eq(scene_solve(&s, NULL), NLC_OK);
        double energy;
        const nlc_status status = nlc_energy(s.network, &energy, s.force, s.overlap, s.normal, NULL);
        ck_assert_int_eq(status, record_of(model).potential ? NLC_OK : NLC_ERROR_NO_POTENTIAL);
        scene_free(&s);
    }
}
END_TEST

START_TEST(environment_is_left_alone)
{
    nlc_assert_quiet(nlc_model_count());
    nlc_assert_quiet(nlc_model_find(NULL));
    nlc_assert_quiet(nlc_model_find("sphere"));
}
END_TEST

int main(void)
{
    Suite *s = suite_create("models");
    TCase *t = tcase_create("models");
    tcase_add_test(t, numbers_and_names_are_for_good);
    tcase_add_test(t, every_row_is_filled_in);
    tcase_add_test(t, rows_say_what_models_do);
    tcase_add_test(t, energy_where_the_row_says_so);
    tcase_add_test(t, environment_is_left_alone);
    suite_add_tcase(s, t);
    return run_suite(s);
}
