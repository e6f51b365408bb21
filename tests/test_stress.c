/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_stress.c - the grid of stable scenes and what lies beyond their end: crystals, packings, clusters, every model.
 *
 * `make check` runs a part of it in silence, `make stress` all of it with a table.  Every solve starts from nothing, with
 * floating-point traps on.  "Load" is relative to the end of the stable branch or, where that lies beyond, to a strain of 20 %.
 * Odd scenes are in stress_odd.c, scenes that change in stress_change.c,
 * packings past their end in stress_past.c.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "stress.h"

TCase *stress_odd(void);
TCase *stress_change(void);
TCase *stress_past(void);

static const double poisson[] = {0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49, 0.5};
static const double tolerances[] = {1e-10, 1e-6};

/* ----------------------------------------------------------------------------------------------------------- crystals -- */

static const struct {
    double load;
    int row;
} loads[] = {{1e-12, 0}, {1e-6, 0},  {1e-3, 0},  {0.1, 0}, {0.5, 1}, {0.9, 2},
             {0.99, 3},  {0.999, 4}, {1.001, 5}, {1.1, 5}, {10, 5}};
#define ROWS 6
static const char *const row_name[ROWS] = {"load to .1", "load .5", "load .9", "load .99", "load .999", "beyond"};

typedef struct table {
    tally row[2][ROWS];
} table;

static void table_begin(table *t, const char *name, const int targets[4])
{
    for (int a = 0; a < 2; a++)
        for (int l = 0; l < ROWS; l++) {
            const int target = a > 0 || l == ROWS - 1 ? 0 : targets[l == 0 ? 0 : l - 1];
            tally_begin(&t->row[a][l], target, "%s, %s, %g", name, row_name[l], tolerances[a]);
        }
}

/* No solution but the one connected to zero load, though circles of contact overlap in some. */
static void end_without_others(tally *t)
{
    if (t->other > 0) tally_miss(t, "%jd other solutions", (intmax_t)t->other);
    tally_end(t, 0);
}

static void table_end(table *t)
{
    for (int a = 0; a < 2; a++)
        for (int l = 0; l < ROWS; l++) end_without_others(&t->row[a][l]);
}

/* Past a strain of 20 % there may be a solution or not: only what holds for any solve. */
static void all_loads(table *t, scene *s, int most)
{
    exact e;
    bool capped;
    const double end = end_of_branch(s, &capped);
    exact_init(&e, s);
    for (int l = 0; l < most; l++) {
        const double load = loads[l].load * end;
        if (loads[l].load < 1) ck_assert_msg(exact_move(&e, load), "no solution at %g", loads[l].load);
        for (int a = 0; a < 2; a++) {
            tally *row = &t->row[a][loads[l].row];
            if (loads[l].load < 1)
                solve_stable(row, s, &e, load, tolerances[a]);
            else if (!capped)
                solve_beyond(row, s, load, tolerances[a]);
            else
                cold(s), solve_load(s, load, tolerances[a]);
        }
    }
    exact_free(&e);
}

START_TEST(cells)
{
    table t;
    table_begin(&t, "cells", (const int[]){6, 8, 10, 12});
    for (int type = 0; type < 3; type++)
        for (int a = 0; a < 8; a++) {
            scene s;
            scene_init(&s);
            scene_cell(&s, (lattice)type, 1, 1, poisson[a], (const double[]){0.99, 0.99, 0.99});
            all_loads(&t, &s, 11);
            scene_free(&s);
        }
    table_end(&t);
}
END_TEST

/* With all their spheres and random overlaps: 54 to 108 spheres, in full also 216 to 256, which take up to two sweeps more. */
START_TEST(crystals)
{
    static const int edge[2][3] = {{4, 3, 3}, {6, 5, 4}};
    table t;
    table_begin(&t, _i ? "large crystals" : "crystals", _i ? (const int[]){15, 22, 29, 32} : (const int[]){15, 20, 28, 30});
    for (int type = 0; type < 3; type++)
        for (int a = 0; a < 8 && (_i == 0 || full()); a++) {
            rng g = {(uint64_t)a + 1};
            scene s;
            scene_init(&s);
            scene_lattice(&s, (lattice)type, edge[_i][type], 1, poisson[a], 0.05, 1e-3, &g);
            all_loads(&t, &s, full() ? 11 : 8);
            scene_free(&s);
        }
    table_end(&t);
}
END_TEST

/* ----------------------------------------------------------------------------------------------------------- packings -- */

static const char *const packings[] = {"b_die125_rd0.56.csv",    "b_die125_rd0.70.csv",        "b_die125_rd0.80.csv",
                                       "c_hydrogel514_rest.csv", "c_hydrogel514_strain13.csv", "a_mono1000_periodic.csv"};

/* The end at nu = 0.3 is 20 % strain; at 0.45 and 0.49 it is that of the stable branch, at up to 40 % strain. */
static double end_of_packing(const scene *s, double nu)
{
    bool capped;
    if (nu <= 0.3) return end_of_branch(s, &capped);
    const double end = (double)exact_end(s, 200, 1e-7L);
    ck_assert(isfinite(end));
    return end;
}

static void packing_of(scene *s, const char *file, double nu)
{
    scene_init(s);
    scene_packing(s, file, 0.3);
    for (int64_t m = 0; m < s->materials; m++) s->rows[m].poisson = nu;
}

START_TEST(random_packings)
{
    static const double nu[] = {0.3, 0.45, 0.49}, part[] = {0.5, 0.9, 0.99};
    static const int targets[] = {20, 36, 60};
    tally t[3][2];
    for (int l = 0; l < 3; l++)
        for (int a = 0; a < 2; a++)
            tally_begin(&t[l][a], a ? 0 : targets[l], "packings nu %g, load %g, %g", nu[_i], part[l], tolerances[a]);
    for (int p = 0; p < (full() ? 6 : 3); p++) {
        scene s;
        exact e;
        packing_of(&s, packings[p], nu[_i]);
        const double end = end_of_packing(&s, nu[_i]);
        exact_init(&e, &s);
        for (int l = 0; l < 3; l++) {
            ck_assert(exact_move(&e, part[l] * end));
            for (int a = 0; a < 2; a++) solve_stable(&t[l][a], &s, &e, part[l] * end, tolerances[a]);
        }
        exact_free(&e);
        scene_free(&s);
    }
    for (int l = 0; l < 3; l++)
        for (int a = 0; a < 2; a++) end_without_others(&t[l][a]);
}
END_TEST

/* ----------------------------------------------------------------------------------------------------------- clusters -- */

/*
 * A sphere of radius 1 with smaller ones on it: a row round the equator, each also pressed against its neighbours, and some
 * further up and down, pressed by walls.  Strains are up to 1 % of the small ones; none of them overlap but those in the row.
 */
static void crowd(scene *s, rng *g, double ratio, const int32_t *material, int materials, double strain)
{
    const double r = 1 / ratio, beside = 2 * asin(r / (1 + r)); /* angle between two that touch */
    const int around = (int)(6.28318530717958648 / beside), row = around < 24 ? around : 24, caps = 6;
    const int32_t centre = scene_particle(s, 1, material[0]);
    for (int k = 0; k < row + 2 * caps; k++) scene_particle(s, r, material[rng_below(g, (uint64_t)materials)]);
    const int32_t wall = (int32_t)s->particles + scene_wall(s, material[0]);
    for (int k = 0; k < row; k++) {
        const double phi = k * beside, x = cos(phi), y = sin(phi);
        scene_contact(s, centre, k + 1, r * rng_uniform(g, -0.2 * strain, strain), x, y, 0);
        if (k > 0) scene_contact(s, k, k + 1, r * rng_uniform(g, 0, strain), x - cos(phi - beside), y - sin(phi - beside), 0);
    }
    for (int k = 0; k < 2 * caps; k++) {
        const double phi = 1.04719755119659775 * k, z = k < caps ? 0.85 : -0.85, x = sqrt(1 - z * z) * cos(phi),
                     y = sqrt(1 - z * z) * sin(phi);
        if (ratio < 5 && k % caps) continue; /* no room for more than one */
        scene_contact(s, row + 1 + k, centre, r * rng_uniform(g, -0.2 * strain, strain), -x, -y, -z);
        scene_contact(s, row + 1 + k, wall, r * rng_uniform(g, 0, strain), x, y, z);
    }
}

/* As it is, and close to the end of its stable branch. */
static void compare(tally *t, scene *s)
{
    exact e;
    bool capped;
    const double end = end_of_branch(s, &capped), load[] = {1e-3, 1, 0.5 * end, 0.99 * end};
    exact_init(&e, s);
    for (int l = 0; l < 4; l++) {
        if (load[l] > end) continue;
        e.load = 0; /* they are in no order */
        for (int64_t c = 0; c < s->contacts; c++) e.force[c] = 0;
        ck_assert(exact_move(&e, load[l]));
        for (int a = 0; a < 2; a++) solve_stable(t, s, &e, load[l], tolerances[a]);
    }
    exact_free(&e);
}

START_TEST(size_ratios)
{
    static const double ratio[] = {1, 2, 5, 10, 20, 50, 100};
    for (int a = 0; a < 7; a++) {
        tally t;
        tally_begin(&t, 0, "sizes 1:%g", ratio[a]);
        for (int seed = 0; seed < (full() ? 24 : 6); seed++) {
            rng g = {(uint64_t)(100 * a + seed)};
            scene s;
            scene_init(&s);
            const int32_t m = scene_material(&s, 1e6, poisson[seed % 8]);
            crowd(&s, &g, ratio[a], &m, 1, seed % 3 ? 0.01 : 0.1);
            compare(&t, &s);
            scene_free(&s);
        }
        tally_end(&t, 0);
    }
}
END_TEST

/* The large one, the small ones and the wall of materials as different as that; ratio 0: some small ones are rigid. */
START_TEST(stiffness_ratios)
{
    static const double ratio[] = {1, 10, 1e2, 1e3, 1e4, 1e5, 1e6, 0};
    for (int a = 0; a < 8; a++) {
        tally t;
        if (ratio[a] > 0)
            tally_begin(&t, 0, "stiffness 1:%g", ratio[a]);
        else
            tally_begin(&t, 0, "stiffness 1:rigid");
        for (int seed = 0; seed < (full() ? 24 : 6); seed++) {
            rng g = {(uint64_t)(100 * a + seed)};
            scene s;
            scene_init(&s);
            const double soft = 1e5, hard = ratio[a] > 0 ? soft * ratio[a] : INFINITY;
            const int32_t m[3] = {scene_material(&s, seed % 2 && ratio[a] > 0 ? hard : soft, poisson[seed % 8]),
                                  scene_material(&s, hard, 0.3), scene_material(&s, soft, 0.45)};
            crowd(&s, &g, 4, m, ratio[a] > 0 ? 3 : 1, 0.01);
            for (int64_t k = 1; ratio[a] <= 0 && k < s.particles; k += 2) s.material[k] = m[1]; /* no two neighbours */
            compare(&t, &s);
            scene_free(&s);
        }
        tally_end(&t, 0);
    }
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------- models -- */

/*
 * What is to be known of a model here: its prefactor, and the number times which the coupling of exact.c is its own (NAN: the
 * reference does not know it, so that the residual is recomputed instead).  A new model needs a row only if it has a factor.
 */
static const struct {
    int32_t model, points;
    double prefactor, factor;
} rows[] = {{NLC_MODEL_GONZALEZ_CUITINO, 0, 0, 1},
            {NLC_MODEL_HERTZ, 0, 0, 0},
            {NLC_MODEL_HALF_SPACE, NLC_POINTS_UNDEFORMED, 0, 1},
            {NLC_MODEL_HALF_SPACE, NLC_POINTS_UNDEFORMED, 0.5, 0.5}};

static void scene_for_models(scene *s, int which)
{
    rng g = {7};
    scene_init(s);
    if (which == 0)
        scene_cell(s, FACE_CENTRED, 1, 1, 0.3, (const double[]){0.99, 0.98, 0.97});
    else if (which == 1)
        scene_lattice(s, BODY_CENTRED, 3, 1, 0.4, 0.02, 1e-3, &g);
    else if (which == 2)
        packing_of(s, "b_die125_rd0.70.csv", 0.45);
    else
        scene_cluster(s, &g, 12, 0.6);
}

static void with_model(tally *t, int32_t model, int32_t points, double prefactor, double factor)
{
    for (int which = 0; which < 4; which++) {
        scene s;
        exact e;
        bool capped;
        scene_for_models(&s, which);
        exact_init(&e, &s);
        for (int64_t w = 0; w < e.terms && !isnan(factor); w++) e.w[w] *= factor;
        const double end = end_of_branch(&s, &capped);
        s.options.model = model;
        s.options.points = points;
        s.options.prefactor = prefactor;
        for (int l = 0; l < 8; l++) {
            const double load = loads[l].load * end;
            const bool known = !isnan(factor) && exact_move(&e, load);
            for (int a = 0; a < 2; a++) solve_stable(t, &s, known ? &e : 0, load, tolerances[a]);
        }
        exact_free(&e);
        scene_free(&s);
    }
}

/* Every model that the library has, by its number. */
START_TEST(models)
{
    int met = 0;
    for (int32_t model = 0; model < 100; model++) {
        scene s;
        scene_for_models(&s, 0);
        s.options.model = model;
        const nlc_status status = scene_build(&s);
        scene_free(&s);
        if (status == NLC_ERROR_MODEL) break;
        ck_assert_int_eq(status, NLC_OK);
        met++;
        tally t;
        tally_begin(&t, 0, "model %d, recomputed residual", model);
        with_model(&t, model, 0, 0, NAN);
        tally_end(&t, 0);
        for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
            if (rows[r].model != model) continue;
            tally_begin(&t, 0, "model %d, prefactor %g", model, rows[r].prefactor);
            with_model(&t, model, rows[r].points, rows[r].prefactor, rows[r].factor);
            tally_end(&t, 0);
        }
    }
    ck_assert_int_ge(met, 6);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("stress");
    TCase *t = tcase_create("grid");
    tcase_set_timeout(t, full() ? 0 : 300);
    tcase_add_checked_fixture(t, 0, no_misses);
    tcase_add_test(t, cells);
    tcase_add_loop_test(t, crystals, 0, 2);
    tcase_add_loop_test(t, random_packings, 0, 3);
    tcase_add_test(t, size_ratios);
    tcase_add_test(t, stiffness_ratios);
    tcase_add_test(t, models);
    suite_add_tcase(suite, t);
    suite_add_tcase(suite, stress_odd());
    suite_add_tcase(suite, stress_change());
    suite_add_tcase(suite, stress_past());
    tally_heading();
    return run_suite(suite);
}
