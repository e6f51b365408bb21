/* SPDX-License-Identifier: BSD-2-Clause */
/* test_forces.c - coupled forces against closed forms, the papers' numbers and an independent solution. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/network.h"
#include "scene.h"

static const double pi = 3.14159265358979323846;

/* A one-sphere cell compressed by eps along the axes given, solved to the last digits. */
static void solved_cell(scene *s, lattice type, double nu, double ex, double ey, double ez)
{
    scene_init(s);
    s->options.tolerance = 1e-13;
    scene_cell(s, type, 0.01, 1.85e6, nu, (const double[]){1 - ex, 1 - ey, 1 - ez});
    ck_assert_int_eq(scene_solve(s, 0), NLC_OK);
}

/* A pair that shares its particles with nobody has nothing to be displaced by: Hertz to the last bit. */
START_TEST(isolated_pairs_are_hertz)
{
    scene s;
    scene_init(&s);
    const int32_t m = scene_material(&s, 2e9, 0.25), n = scene_material(&s, 7e10, 0.4);
    for (int k = 0; k < 10; k++) scene_particle(&s, 1e-3 * (1 + k), k % 3 ? m : n);
    for (int k = 0; k < 10; k += 2) scene_contact(&s, k, k + 1, 1e-6 * (k + 1), 1, k, -2);
    nlc_info info;
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    for (int c = 0; c < 5; c++) {
        const nlc_material a = s.rows[s.material[s.i[c]]], b = s.rows[s.material[s.j[c]]];
        const double k = nlc_hertz_stiffness(a.young, a.poisson, s.radius[s.i[c]], b.young, b.poisson, s.radius[s.j[c]]);
        nlc_assert_ulp(s.force[c], nlc_hertz_force(k, s.overlap[c]), 2); /* two orders of the same three operations */
        nlc_assert_same(s.nonlocal[c], 0);
    }
    ck_assert_int_eq(info.active, 5);
    ck_assert_int_eq(info.sweeps, 0);
    ck_assert_int_eq(info.left_out, 5);
    scene_free(&s);
}
END_TEST

/* [GC] 8 of each contact as nlc_hertz_stiffness has it, to the last bit: materials alike and apart, rigid ones, walls, any units. */
START_TEST(stiffnesses_are_hertz)
{
    static const double units[] = {1, 1e-30, 1e40, 1e100}; /* the last one is beyond what is moderate */
    rng g = {17};
    for (int u = 0; u < 4; u++) {
        scene s;
        scene_init(&s);
        const int32_t material[4] = {scene_material(&s, 1.85e6 * units[u], 0.46), scene_material(&s, 2e11 * units[u], 0.3),
                                     scene_material(&s, INFINITY, 0), scene_material(&s, 1 / units[u], 0)};
        for (int k = 0; k < 40; k++) scene_particle(&s, rng_uniform(&g, 1e-3, 1) * units[u], material[k % 4]);
        const int32_t soft = 40 + scene_wall(&s, material[0]), rigid = 40 + scene_wall(&s, material[2]);
        for (int c = 0; c < 300; c++) {
            const int32_t i = (int32_t)rng_below(&g, 40), other = c % 7 == 0 ? soft : c % 7 == 1 ? rigid : (int32_t)rng_below(&g, 40);
            const int32_t j = i % 4 == 2 && (other == rigid || other % 4 == 2) ? soft : other; /* not two rigid ones */
            scene_contact(&s, c % 2 ? j : i, c % 2 ? i : j, units[u], 1, 0, 0);
        }
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        for (int again = 0; again < 2; again++) {
            for (int64_t c = 0; c < s.contacts; c++) {
                nlc_material m[2];
                double R[2];
                for (int side = 0; side < 2; side++) {
                    const int32_t k = side ? s.j[c] : s.i[c];
                    m[side] = s.rows[k < 40 ? s.material[k] : s.wall_material[k - 40]];
                    R[side] = k < 40 ? s.radius[k] : INFINITY;
                }
                nlc_assert_same(s.network->stiffness[c], nlc_hertz_stiffness(m[0].young, m[0].poisson, R[0], m[1].young, m[1].poisson, R[1]));
                s.network->stiffness[c] = 0;
            }
            ck_assert_int_eq(nlc_set_options(s.network, &s.options, NULL), NLC_OK);
        }
        for (int k = 40; k < 42; k++) nlc_assert_same(s.network->largest[k], 0);
        scene_free(&s);
    }
    scene none; /* and where there is nothing that yields */
    scene_init(&none);
    for (int k = 0; k < 2; k++) scene_particle(&none, 1, k == 0 ? scene_material(&none, INFINITY, 0) : 0);
    ck_assert_int_eq(scene_build(&none), NLC_OK);
    ck_assert_int_eq(nlc_set_options(none.network, &none.options, NULL), NLC_OK);
    scene_free(&none);
}
END_TEST

/* [GC] 11: with x the overlap plus displacement, gamma = x - C k x^(3/2), C = (1+nu)(3-2nu) / (2 pi R E) for both sides. */
START_TEST(chain_has_its_closed_form)
{
    const double nu[] = {0, 0.1, 0.2, 0.3, 0.4, 0.46, 0.5}, eps[] = {1e-12, 1e-6, 1e-3, 0.01, 0.05, 0.1, 0.15};
    for (int a = 0; a < 7; a++)
        for (int b = 0; b < 7; b++) {
            scene s;
            scene_init(&s);
            s.options.tolerance = 1e-13;
            const double R = 0.01, E = 1.85e6, gamma = 2 * R * eps[b];
            const int32_t p = scene_particle(&s, R, scene_material(&s, E, nu[a]));
            scene_contact(&s, p, p, gamma, 0, 0, 1);
            ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
            const double C = (1 + nu[a]) * (3 - 2 * nu[a]) / (2 * pi * R * E);
            const double k = nlc_hertz_stiffness(E, nu[a], R, E, nu[a], R), x = nlc_hertz_overlap(k, s.force[0]);
            /* the tolerance times dgamma/dP of a stable state, which is below that of Hertz, and rounding */
            nlc_assert_rel(x - C * s.force[0], gamma, 1e-12);
            scene_free(&s);
        }
}
END_TEST

/* [GC] 12: the first three terms; the fourth is of relative order gamma^(3/2). */
START_TEST(chain_follows_its_series)
{
    for (double eps = 1e-6; eps < 1e-2; eps *= 10) {
        scene s;
        scene_init(&s);
        s.options.tolerance = 1e-13;
        const double R = 0.01, E = 1.85e6, nu = 0.46, gamma = 2 * R * eps;
        const int32_t p = scene_particle(&s, R, scene_material(&s, E, nu));
        scene_contact(&s, p, p, gamma, 0, 1, 0);
        ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
        const double k = nlc_hertz_stiffness(E, nu, R, E, nu, R), C = (1 + nu) * (3 - 2 * nu) / (2 * pi * R * E);
        const double y = C * k * sqrt(gamma), series = k * gamma * sqrt(gamma) * (1 + 1.5 * y + 2.625 * y * y);
        nlc_assert_rel(s.force[0], series, 6 * y * y * y + 1e-14); /* the next coefficient is 5 */
        scene_free(&s);
    }
}
END_TEST

/* [GC] 13 and 14: transverse forces F on both spheres of a pair; one sweep, since 13 leaves out the reaction's feedback. */
START_TEST(transverse_forces_close_a_contact)
{
    const double R = 0.01, E = 1.85e6, nu = 0.3, F = 2.5;
    scene s;
    scene_init(&s);
    const int32_t m = scene_material(&s, E, nu), rigid = scene_material(&s, INFINITY, 0);
    scene_particle(&s, R, m);
    scene_particle(&s, R, m);
    const int32_t wall = 2 + scene_wall(&s, rigid);
    scene_contact(&s, 0, 1, 0, 1, 0, 0);
    for (int k = 0; k < 4; k++) scene_contact(&s, k / 2, wall, 0, 0, 0, k % 2 ? 1 : -1);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    const double force[5] = {0, F, F, F, F};
    double w[10];
    ck_assert_int_eq(nlc_sweep(s.network, w, force, 0, s.normal, 0), NLC_OK);
    const double inverse = 2 * (1 + nu) * (3 * sqrt(2) - 4 - 4 * sqrt(2) * nu + 8 * nu) / (4 * pi * R * E); /* 1 / n_NL */
    nlc_assert_rel(w[0] + w[1], F * inverse, 1e-14);
    const double k = nlc_hertz_stiffness(E, nu, R, E, nu, R);
    nlc_assert_rel(nlc_hertz_force(k, w[0] + w[1]), k * pow(inverse, 1.5) * pow(F, 1.5), 1e-14); /* 13 */
    scene_free(&s);
}
END_TEST

static double discrepancy(const scene *s, int64_t c)
{
    const nlc_material m = s->rows[0];
    const double k = nlc_hertz_stiffness(m.young, m.poisson, s->radius[0], m.young, m.poisson, s->radius[0]);
    return s->force[c] / nlc_hertz_force(k, s->overlap[c]) - 1;
}

/* [GC] 17 and 18: what the series leave out is of order eps^(3/2) in one dimension, eps^(5/4) in two and three. */
START_TEST(crystals_follow_the_series)
{
    const double nus[] = {0, 0.2, 0.3, 0.46, 0.5};
    for (int a = 0; a < 5; a++)
        for (double eps = 1e-8; eps < 2e-3; eps *= 10) {
            const double nu = nus[a], y = (3 - 2 * nu) / (1 - nu) / (2 * pi), series = y * sqrt(eps) + 7. / 6 * y * y * eps;
            scene s;
            solved_cell(&s, SIMPLE_CUBIC, nu, 0, 0, eps);
            nlc_assert_abs(discrepancy(&s, 2), series, 5 * pow(eps, 1.25) + 1e-12);
            scene_free(&s);
            scene_init(&s);
            s.options.tolerance = 1e-13;
            const int32_t p = scene_particle(&s, 1, scene_material(&s, 1, nu));
            scene_contact(&s, p, p, 2 * eps, 1, 0, 0);
            ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
            nlc_assert_abs(discrepancy(&s, 0), series, 5 * pow(eps, 1.5) + 1e-12);
            scene_free(&s);
        }
}
END_TEST

/* The rubber sphere between plates of [GC] Fig. 7; forces from an independent solution, given to 5 digits. */
START_TEST(rubber_sphere_between_plates)
{
    const double eps[] = {0.1, 0.4}, force[] = {12.391, 138.55};
    for (int a = 0; a < 2; a++) {
        scene s;
        scene_init(&s);
        const int32_t p = scene_particle(&s, 0.01, scene_material(&s, 1.85e6, 0.46));
        const int32_t wall = 1 + scene_wall(&s, scene_material(&s, INFINITY, NAN));
        scene_contact(&s, p, wall, eps[a] * 0.01, 0, 0, 1);
        scene_contact(&s, wall, p, eps[a] * 0.01, 0, 0, 1);
        ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
        nlc_assert_rel(s.force[0], force[a], 5e-5);
        nlc_assert_rel(s.force[1], s.force[0], 1e-15);
        scene_free(&s);
    }
}
END_TEST

/* Overlap plus displacement of the contacts between second neighbours along z of a body-centred crystal. */
static double second_neighbours(double nu, double ex, double ez)
{
    scene s;
    solved_cell(&s, BODY_CENTRED, nu, ex, ex, ez);
    const double x = s.overlap[6] + s.nonlocal[6];
    scene_free(&s);
    return x;
}

/* Relative density ([GC] 19) at which second neighbours come into contact. */
static double onset(double nu, bool hydrostatic)
{
    double low = 0, high = hydrostatic ? 0.11 : 0.2; /* below the end of the stable branch */
    while (high - low > 1e-6) {
        const double e = (low + high) / 2;
        *(second_neighbours(nu, hydrostatic ? e : 0, e) > 0 ? &high : &low) = e;
    }
    return pi * sqrt(3) / 8 / pow(1 - low, hydrostatic ? 3 : 1);
}

/* [GC] 4.1 gives 0.95 and 0.780; Hertz has 1.047 and 0.785 = pi sqrt(3) / 8 (2 / sqrt 3)^(3 or 1). */
START_TEST(second_contacts_of_body_centred_crystals)
{
    nlc_assert_abs(onset(0.45, true), 0.945, 5e-4);
    nlc_assert_abs(onset(0.45, false), 0.780, 5e-4);
}
END_TEST

/* A one-sphere cell, every contact with itself, against the crystal with all its spheres. */
START_TEST(cell_equals_crystal)
{
    const double stretch[] = {0.97, 0.99, 0.93};
    for (int n = 3; n <= 4; n++) {
        scene cell, crystal;
        scene_init(&cell);
        scene_init(&crystal);
        cell.options.tolerance = crystal.options.tolerance = 1e-13;
        scene_cell(&cell, SIMPLE_CUBIC, 1, 1e5, 0.4, stretch);
        scene_crystal(&crystal, n, 1, 1e5, 0.4, stretch);
        ck_assert_int_eq(scene_solve(&cell, 0), NLC_OK);
        ck_assert_int_eq(scene_solve(&crystal, 0), NLC_OK);
        /* twice the tolerance of the solutions, and a few roundings amplified by 1/(1 - lambda) < 4 */
        for (int64_t c = 0; c < crystal.contacts; c++) nlc_assert_rel(crystal.force[c], cell.force[c % 3], 1e-12);
        scene_free(&cell);
        scene_free(&crystal);
    }
}
END_TEST

static void compare(scene *s, double factor, double tolerance)
{
    long double *exact = malloc((size_t)s->contacts * sizeof *exact);
    ck_assert_ptr_nonnull(exact);
    ck_assert(scene_oracle(s, factor, exact) < 1e-17L);
    ck_assert_int_eq(scene_solve(s, 0), NLC_OK);
    const double error = scene_error(s, s->force, exact);
    if (verbose()) printf("%jd contacts: error %.2e\n", (intmax_t)s->contacts, error);
    ck_assert_msg(error <= tolerance, "error %.3g, allowed %.3g", error, tolerance);
    free(exact);
}

static const struct {
    const char *name;
    double total; /* over Hertz, independent solver, 4 digits */
} packings[] = {{"b_die125_rd0.56.csv", 1.089},       {"b_die125_rd0.70.csv", 1.232},        {"b_die125_rd0.80.csv", 1.302},
                {"c_hydrogel514_rest.csv", 1.152}, {"c_hydrogel514_strain13.csv", 1.467}, {"a_mono1000_periodic.csv", 1.316}};

/* Packings that other programs made: 1e-12 of the largest force against the solution in long double. */
START_TEST(packings_agree_with_long_double)
{
    scene s;
    scene_init(&s);
    s.options.tolerance = 1e-13;
    scene_packing(&s, packings[_i].name, 0.3);
    s.options.method = NLC_METHOD_FIXED_POINT; /* Algorithm 1 ... */
    compare(&s, 1, 1e-12);
    s.options.method = NLC_METHOD_AUTOMATIC; /* ... and the default */
    s.network = 0;
    compare(&s, 1, 1e-12);
    const double total = scene_total(&s);
    s.options.model = NLC_MODEL_HERTZ;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, 0), NLC_OK);
    ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
    nlc_assert_abs(total / scene_total(&s), packings[_i].total, 5.5e-4);
    scene_free(&s);
}
END_TEST

/* The tolerance is met at every value of it. */
START_TEST(tolerance_is_kept)
{
    scene s;
    scene_init(&s);
    s.options.method = _i;
    scene_packing(&s, "b_die125_rd0.80.csv", 0.3);
    for (double tolerance = 1e-2; tolerance > 1e-13; tolerance /= 10) {
        s.options.tolerance = tolerance;
        s.network = 0;
        compare(&s, 1, tolerance);
    }
    scene_free(&s);
}
END_TEST

/* Close to the end of the stable branch a sweep changes little and much is still to come: lambda is 0.82 and 0.94 here. */
START_TEST(tolerance_is_kept_near_the_fold)
{
    const double eps = _i % 2 ? 0.170 : 0.155; /* the fold of the simple cubic crystal of nu = 0.46 is at 0.172 */
    scene s;
    scene_init(&s);
    s.options.method = _i / 4 ? NLC_METHOD_FIXED_POINT : NLC_METHOD_AUTOMATIC;
    s.options.tolerance = _i % 4 < 2 ? 1e-4 : 1e-9;
    scene_cell(&s, SIMPLE_CUBIC, 1, 1e6, 0.46, (const double[]){1 - eps, 1 - eps, 1 - eps});
    compare(&s, 1, s.options.tolerance);
    scene_free(&s);
}
END_TEST

/* Mixed materials, radii, walls, rigid grains and candidates round one grain. */
START_TEST(clusters_agree_with_long_double)
{
    rng g = {(uint64_t)_i + 1};
    scene s;
    scene_init(&s);
    s.options.tolerance = 1e-13;
    scene_cluster(&s, &g, 2 + _i, 0.6);
    compare(&s, 1, 1e-12);
    scene_free(&s);
}
END_TEST

/*
 * Loose scenes: most contacts of a packing opened, so that only a part of it has to be solved for; then step by step closed
 * again and opened elsewhere, from the displacements of the step before.
 */
START_TEST(loose_scenes_agree_with_long_double)
{
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    int64_t least = INT64_MAX, most = 0;
    scene_init(&s);
    s.options.tolerance = 1e-12;
    scene_packing(&s, _i ? "c_hydrogel514_strain13.csv" : "b_die125_rd0.80.csv", 0.3);
    double *overlap = malloc((size_t)s.contacts * sizeof *overlap);
    long double *exact = malloc((size_t)s.contacts * sizeof *exact);
    ck_assert(overlap && exact);
    memcpy(overlap, s.overlap, (size_t)s.contacts * sizeof *overlap);
    for (int step = 0; step < 12; step++) {
        for (int64_t c = 0; c < s.contacts; c++) { /* a band of particles that moves and widens is compressed */
            const int64_t k = s.i[c] < s.j[c] ? s.i[c] : s.j[c], from = 7 * step, to = from + 2 + 5 * step * step / 4;
            s.overlap[c] = k >= from && k < to ? overlap[c] : -0.02 * fabs(overlap[c]);
        }
        ck_assert(scene_oracle(&s, 1, exact) < 1e-17L);
        ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
        ck_assert(scene_error(&s, s.force, exact) <= 1e-12);
        for (int64_t c = 0; c < s.contacts; c++) /* all displacements belong to the forces, those of candidates, too */
            nlc_assert_abs(nlc_hertz_force((double)scene_stiffness(&s, c), s.overlap[c] + s.nonlocal[c]), s.force[c],
                           1e-14 * s.force[c] + 1e-300);
        least = info.left_out < least ? info.left_out : least;
        most = info.left_out > most ? info.left_out : most;
    }
    ck_assert_int_gt(most, s.contacts / 2);
    ck_assert_int_lt(least, s.contacts);
    double *w = malloc(2 * (size_t)s.contacts * sizeof *w), largest = 0;
    ck_assert_int_eq(nlc_sweep(s.network, w, s.force, 0, s.normal, 0), NLC_OK);
    for (int64_t c = 0; c < s.contacts; c++) largest = fmax(largest, fabs(s.nonlocal[c]));
    for (int64_t c = 0; c < s.contacts; c++) nlc_assert_abs(s.nonlocal[c], w[2 * c] + w[2 * c + 1], 1e-11 * largest);
    free(overlap), free(exact), free(w);
    scene_free(&s);
}
END_TEST

/*
 * One contact of a crystal moves: what is around it is solved for first, and two sweeps of the whole do.  The forces are
 * within the tolerance of exact ones, and so they are where nothing moves.
 */
START_TEST(only_what_moves)
{
    scene s;
    scene_init(&s);
    s.options.tolerance = 1e-3;
    rng g = {7};
    scene_lattice(&s, SIMPLE_CUBIC, 16, 1e6, 0.3, 0.02, 1e-3, &g);
    long double *exact = malloc((size_t)s.contacts * sizeof *exact);
    nlc_info info = {.struct_size = sizeof info};
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    ck_assert_int_eq(info.settled, 0);
    s.options.tolerance = 1e-9;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, 0), NLC_OK);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    s.options.tolerance = 1e-3;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, 0), NLC_OK);
    for (int step = 0; step < 5; step++) {
        const int64_t c = 2000 * step;
        s.overlap[c] *= 1.1;
        ck_assert(scene_oracle(&s, 1, exact) < 1e-15L);
        ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
        ck_assert(scene_error(&s, s.force, exact) <= 1e-3);
        ck_assert_msg(info.settled > 10 && info.settled < s.contacts / 2, "step %d: %jd settled, %jd sweeps", step, (intmax_t)info.settled, (intmax_t)info.sweeps);
        ck_assert_int_le(info.sweeps, 2);
        double *w = malloc(2 * (size_t)s.contacts * sizeof *w);
        for (int64_t k = 0; k < s.contacts; k++) s.force[k] = (double)exact[k]; /* the next step starts from exact displacements */
        ck_assert_int_eq(nlc_sweep(s.network, w, s.force, 0, s.normal, 0), NLC_OK);
        for (int64_t k = 0; k < s.contacts; k++) s.nonlocal[k] = w[2 * k] + w[2 * k + 1];
        free(w);
    }
    free(exact);
    scene_free(&s);
}
END_TEST

/* Rows of materials that nothing is made of, and a prefactor that the model does not have, change no bit. */
START_TEST(what_is_not_in_use)
{
    for (int model = 0; model < 6; model++) {
        scene plain, other;
        scene *both[2] = {&plain, &other};
        for (int k = 0; k < 2; k++) {
            rng g = {23};
            scene_init(both[k]);
            both[k]->options.model = model;
            if (k == 1) both[k]->options.prefactor = model == NLC_MODEL_HALF_SPACE ? 1 : 1e200;
            scene_cluster(both[k], &g, 9, 0.6);
            if (k == 1) scene_material(both[k], 1e-300, 0.2);
            if (k == 1) scene_material(both[k], 1e300, 0.2);
            ck_assert_int_ge(scene_solve(both[k], 0), 0);
        }
        for (int64_t c = 0; c < plain.contacts; c++) nlc_assert_same(plain.force[c], other.force[c]);
        scene_free(&plain), scene_free(&other);
    }
}
END_TEST

/*
 * The same in a long chain to a close tolerance, in the middle and at the walls where it begins and ends: without what was solved for
 * in the region the whole would take more sweeps.  To 1e-12 a contact that doubles is felt a dozen neighbours away; and one sweep is none too many.
 */
START_TEST(only_what_moves_in_a_chain)
{
    static const struct {
        int at;
        double factor, tolerance;
    } row[] = {{200, 1.01, 1e-8}, {0, 1.01, 1e-8}, {401, 1.01, 1e-8}, {200, 2, 1e-12}};
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    s.options.tolerance = row[_i].tolerance;
    const int32_t m = scene_material(&s, 1, 0.45);
    for (int k = 0; k <= 400; k++) scene_particle(&s, 1, m);
    scene_contact(&s, (int32_t)s.particles + scene_wall(&s, m), 0, 0.04, 1, 0, 0);
    for (int k = 0; k < 400; k++) scene_contact(&s, k, k + 1, 0.04 + 1e-4 * (k % 7), 1, 0, 0);
    scene_contact(&s, 400, (int32_t)s.particles + scene_wall(&s, m), 0.04, 1, 0, 0);
    long double *exact = malloc((size_t)s.contacts * sizeof *exact);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    s.overlap[row[_i].at] *= row[_i].factor;
    ck_assert(scene_oracle(&s, 1, exact) < 1e-15L);
    double *start = malloc((size_t)s.contacts * sizeof *start);
    memcpy(start, s.nonlocal, (size_t)s.contacts * sizeof *start);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    ck_assert(scene_error(&s, s.force, exact) <= row[_i].tolerance);
    ck_assert_msg(info.settled > 5 && info.settled < 60 && info.sweeps <= 3, "%jd settled, %jd sweeps", (intmax_t)info.settled,
                  (intmax_t)info.sweeps);
    s.options.max_sweeps = 1;
    ck_assert_int_eq(nlc_set_options(s.network, &s.options, 0), NLC_OK);
    memcpy(s.nonlocal, start, (size_t)s.contacts * sizeof *start);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_WARNING_NOT_CONVERGED);
    ck_assert(info.sweeps == 1 && info.settled == 0);
    free(start);
    free(exact);
    scene_free(&s);
}
END_TEST

/* Of one ball, where more contacts are open than not: from its own solution they are known to be, and left out at once. */
START_TEST(what_is_open_is_left_out)
{
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    const int32_t p = scene_particle(&s, 1, scene_material(&s, 1e9, 0.3)), rigid = scene_material(&s, INFINITY, 0);
    for (int k = 0; k < 4; k++) scene_contact(&s, p, 1 + scene_wall(&s, rigid), 0.01, (k == 0) - (k == 1), (k == 2) - (k == 3), 0);
    for (int k = 0; k < 8; k++) scene_contact(&s, p, 1 + scene_wall(&s, rigid), -0.3, k % 2 ? 1 : -1, k / 2 % 2 ? 1 : -1, k / 4 ? 1 : -1);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    for (int again = 0; again < 2; again++) {
        ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
        ck_assert_int_eq(info.left_out, 8);
        ck_assert_int_eq(info.active, 4);
    }
    scene_free(&s);
}
END_TEST

/* A centre that is 1e50 to 1e320 times as hard as what is around it is as good as rigid: the same forces, to the last bits. */
START_TEST(hardest_is_rigid)
{
    for (int model = 0; model < 6; model++)
        for (int ratio = 50; ratio <= 320; ratio += 45) {
            double force[12] = {0};
            for (int rigid = 1; rigid >= 0; rigid--) {
                scene s;
                nlc_info info = {.struct_size = sizeof info};
                scene_init(&s);
                s.options.model = model;
                s.options.tolerance = 1e-12;
                const int32_t soft = scene_material(&s, 1e-150, 0.3);
                const int32_t hard = scene_material(&s, rigid ? INFINITY : pow(10, ratio - 150), 0.3);
                const int32_t wall_too = scene_material(&s, INFINITY, 0);
                scene_particle(&s, 1, hard);
                for (int k = 0; k < 6; k++) scene_particle(&s, 1, soft);
                const int32_t wall = (int32_t)s.particles + scene_wall(&s, wall_too);
                for (int k = 0; k < 6; k++) {
                    const double n[3] = {(k == 0) - (k == 1), (k == 2) - (k == 3), (k == 4) - (k == 5)};
                    scene_contact(&s, 0, k + 1, 0.01 + 1e-3 * k, n[0], n[1], n[2]);
                    scene_contact(&s, k + 1, wall, 0.01, n[0], n[1], n[2]);
                }
                const nlc_status status = scene_solve(&s, &info);
                ck_assert_int_eq(status & ~NLC_WARNING_CLOSE, NLC_OK);
                for (int c = 0; c < 12; c++)
                    if (rigid) force[c] = s.force[c];
                    else nlc_assert_rel(s.force[c], force[c], 3e-12);
                scene_free(&s);
            }
        }
}
END_TEST

/* One compressed pair among a thousand grains that nearly touch: nothing else is looked at. */
START_TEST(what_cannot_move_is_left_out)
{
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    scene_packing(&s, "a_mono1000_periodic.csv", 0.3);
    for (int64_t c = 0; c < s.contacts; c++) s.overlap[c] = c == 1234 ? 1e-5 : -1e-6 - fabs(s.overlap[c]);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    ck_assert_int_eq(info.active, 1);
    ck_assert_int_ge(info.left_out, s.contacts - 200); /* two contacts around the pair, where candidates may be reached */
    nlc_assert_rel(s.force[1234], nlc_hertz_force((double)scene_stiffness(&s, 1234), 1e-5), 1e-15);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK); /* now it is known that they are not */
    ck_assert_int_eq(info.left_out, s.contacts);
    ck_assert_int_eq(info.sweeps, 0);
    scene_free(&s);
}
END_TEST

/* The half-space at undeformed points is Case I times the prefactor. */
START_TEST(half_space_is_case_one_times_prefactor)
{
    rng g = {7};
    scene s;
    scene_init(&s);
    s.options.tolerance = 1e-13;
    s.options.model = NLC_MODEL_HALF_SPACE;
    s.options.points = NLC_POINTS_UNDEFORMED;
    s.options.prefactor = 0.7;
    scene_cluster(&s, &g, 9, 0.6);
    compare(&s, 0.7, 1e-12);
    scene_free(&s);
}
END_TEST

/* A particle with thousands of contacts, more than any block holds: the sweep against sums of the scalar function. */
START_TEST(thousands_of_contacts_on_one_particle)
{
    const int count[] = {63, 64, 65, 127, 128, 129, 3000}, z = count[_i];
    scene s;
    scene_init(&s);
    const int32_t soft = scene_material(&s, 1e6, 0.3), rigid = scene_material(&s, INFINITY, 0);
    scene_particle(&s, 1, soft);
    for (int k = 0; k < z; k++) scene_particle(&s, 0.01, rigid);
    for (int k = 0; k < z; k++) { /* a spiral of evenly spread directions */
        const double h = 1 - (2 * k + 1.) / z, r = sqrt(1 - h * h), phi = pi * (1 + sqrt(5)) * k;
        scene_contact(&s, 0, k + 1, 1e-3, r * cos(phi), r * sin(phi), h);
    }
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    rng g = {3};
    double *force = malloc((size_t)z * sizeof *force), *w = malloc(2 * (size_t)z * sizeof *w);
    ck_assert(force && w);
    for (int k = 0; k < z; k++) force[k] = k == 5 ? -1 : rng_uniform(&g, 0.1, 1);
    nlc_info info = {.struct_size = sizeof info};
    ck_assert_int_eq(nlc_sweep(s.network, w, force, 0, s.normal, &info), NLC_OK);
    ck_assert_int_eq(info.active, z - 1);
    for (int c = 0; c < z; c += z > 200 ? 37 : 1) {
        double sum = 0, size = 0;
        for (int d = 0; d < z; d++) {
            if (d == c) continue;
            const double term = nlc_nonlocal_displacement_between(force[d], s.normal + 3 * c, s.normal + 3 * d, 1, 1e6, 0.3);
            sum += term;
            size += fabs(term);
        }
        nlc_assert_abs(w[2 * c], sum, 1e-15 * z / 8 * size); /* rounding of z additions in another order */
        nlc_assert_same(w[2 * c + 1], 0);
    }
    for (int first = 0; first < z; first += z > 200 ? 997 : 61) { /* the same direction twice, in one block or in two */
        double kept[3], *last = s.normal + 3 * (z - 1);
        if (first == z - 1) continue;
        memcpy(kept, last, sizeof kept);
        memcpy(last, s.normal + 3 * first, sizeof kept);
        ck_assert_int_eq(nlc_sweep(s.network, w, force, 0, s.normal, &info), NLC_ERROR_COINCIDENT);
        ck_assert_int_eq(info.culprit, z - 1);
        memcpy(last, kept, sizeof kept);
    }
    free(force);
    free(w);
    scene_free(&s);
}
END_TEST

/* A contact across a gap opens up once its neighbours push it: [GC] 4's transverse loading, solved. */
START_TEST(candidates_become_contacts)
{
    scene s;
    scene_init(&s);
    const int32_t p = scene_particle(&s, 0.01, scene_material(&s, 1.85e6, 0.46));
    const int32_t wall = 1 + scene_wall(&s, scene_material(&s, INFINITY, 0));
    for (int k = 0; k < 4; k++) scene_contact(&s, p, wall, k < 2 ? 1e-3 : -1e-6, k < 2 ? k * 2 - 1 : 0, k >= 2 ? k * 2 - 5 : 0, 0);
    nlc_info info;
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    ck_assert_int_eq(info.active, 4);
    ck_assert(s.force[2] > 0 && s.nonlocal[2] > 1e-6);
    scene_free(&s);
}
END_TEST

/* k of a host's own law enters the forces and nothing else. */
START_TEST(stiffness_of_the_host)
{
    scene s;
    scene_init(&s);
    double stiffness[3] = {1e5, 2e5, 4e5};
    s.options.stiffness = stiffness;
    s.options.tolerance = 1e-13;
    const int32_t p = scene_particle(&s, 1, scene_material(&s, 1e6, 0.3));
    const int32_t wall = 1 + scene_wall(&s, scene_material(&s, INFINITY, 0));
    for (int k = 0; k < 3; k++) scene_contact(&s, p, wall, 0.01, k == 0, k == 1, k == 2);
    ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
    for (int c = 0; c < 3; c++) {
        double g = 0;
        for (int d = 0; d < 3; d++)
            if (d != c) g += nlc_nonlocal_displacement(s.force[d], pi / 2, 1, 1e6, 0.3);
        nlc_assert_rel(s.force[c], stiffness[c] * pow(0.01 + g, 1.5), 1e-12);
    }
    scene_free(&s);
}
END_TEST

static Suite *forces(void)
{
    Suite *suite = suite_create("forces");
    TCase *t = tcase_create("closed forms");
    tcase_set_timeout(t, 60);
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    tcase_add_test(t, isolated_pairs_are_hertz);
    tcase_add_test(t, stiffnesses_are_hertz);
    tcase_add_test(t, chain_has_its_closed_form);
    tcase_add_test(t, chain_follows_its_series);
    tcase_add_test(t, transverse_forces_close_a_contact);
    tcase_add_test(t, crystals_follow_the_series);
    tcase_add_test(t, rubber_sphere_between_plates);
    tcase_add_test(t, second_contacts_of_body_centred_crystals);
    tcase_add_test(t, cell_equals_crystal);
    tcase_add_test(t, candidates_become_contacts);
    tcase_add_test(t, stiffness_of_the_host);
    tcase_add_loop_test(t, thousands_of_contacts_on_one_particle, 0, 7);
    suite_add_tcase(suite, t);
    t = tcase_create("independent solution");
    tcase_set_timeout(t, 60);
    tcase_add_loop_test(t, packings_agree_with_long_double, 0, (int)(sizeof packings / sizeof *packings));
    tcase_add_loop_test(t, tolerance_is_kept, NLC_METHOD_AUTOMATIC, NLC_METHOD_FIXED_POINT + 1);
    tcase_add_loop_test(t, tolerance_is_kept_near_the_fold, 0, 8);
    tcase_add_loop_test(t, clusters_agree_with_long_double, 0, 12);
    tcase_add_loop_test(t, loose_scenes_agree_with_long_double, 0, 2);
    tcase_add_test(t, what_cannot_move_is_left_out);
    tcase_add_test(t, what_is_open_is_left_out);
    tcase_add_test(t, hardest_is_rigid);
    tcase_add_test(t, only_what_moves);
    tcase_add_loop_test(t, only_what_moves_in_a_chain, 0, 4);
    tcase_add_test(t, what_is_not_in_use);
    tcase_add_test(t, half_space_is_case_one_times_prefactor);
    suite_add_tcase(suite, t);
    return suite;
}

int main(void)
{
    return run_suite(forces());
}
