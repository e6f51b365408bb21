/* SPDX-License-Identifier: BSD-2-Clause */
/* test_tangent.c - energy and tangent of a solution, against differences and against each other. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/small.h"
#include "scene.h"

#define TOLERANCE 1e-13

/* Scenes to look at: a die packing, a cluster of mixed materials, a one-sphere cell, a host's own stiffnesses, Hertz. */
#define SCENES 5
static double stiffness[4000];

static void make(scene *s, int which)
{
    rng g = {5};
    scene_init(s);
    s->options.tolerance = TOLERANCE;
    if (which == 0) scene_packing(s, "b_die125_rd0.80.csv", 0.3);
    if (which == 1) scene_cluster(s, &g, 11, 0.6);
    if (which == 2) scene_cell(s, BODY_CENTRED, 1, 1e6, 0.4, (const double[]){0.94, 0.95, 0.87});
    if (which == 3) scene_packing(s, "b_die125_rd0.56.csv", 0.3);
    if (which == 4) scene_cluster(s, &g, 9, 0.6);
    if (which == 3) {
        for (int64_t c = 0; c < s->contacts; c++) stiffness[c] = 3e7 * (1 + 0.1 * (double)(c % 7));
        s->options.stiffness = stiffness;
    }
    if (which == 4) s->options.model = NLC_MODEL_HERTZ;
    ck_assert_int_eq(scene_solve(s, 0), NLC_OK);
}

static double energy_at(scene *s, double *residual)
{
    nlc_info info = {.struct_size = sizeof info};
    double e;
    ck_assert_int_eq(nlc_energy(s->network, &e, s->force, s->overlap, s->normal, &info), NLC_OK);
    if (residual) *residual = info.residual;
    return e;
}

static double largest(const double *a, int64_t n)
{
    double m = 0;
    for (int64_t c = 0; c < n; c++) m = fmax(m, fabs(a[c]));
    return m;
}

/*
 * dE/dgamma_c = P_c.  Central differences over all contacts at once along a random direction: their own error is (h/gamma)^2
 * relative, with kinks where a contact opens; 1e-7 is asked for.
 */
START_TEST(energy_derives_to_the_force)
{
    scene s;
    make(&s, _i);
    const int64_t n = s.contacts;
    double *v = malloc((size_t)n * sizeof *v), *overlap = malloc((size_t)n * sizeof *overlap), work = 0, residual, e[4];
    double *force = malloc((size_t)n * sizeof *force);
    rng g = {3};
    const double top = largest(s.overlap, n), h = 1e-4;
    memcpy(overlap, s.overlap, (size_t)n * sizeof *overlap);
    memcpy(force, s.force, (size_t)n * sizeof *force);
    /* contacts near opening have no second derivative: they stay as they are */
    for (int64_t c = 0; c < n; c++) v[c] = fabs(overlap[c] + s.nonlocal[c]) > 0.02 * top ? top * rng_uniform(&g, 0, 1) : 0;
    for (int64_t c = 0; c < n; c++) work += v[c] * force[c];
    energy_at(&s, &residual);
    ck_assert(residual <= 1e-12);
    for (int k = 0; k < 4; k++) { /* Richardson's: h and h/2 */
        const double step = (k % 2 ? 1 : -1) * (k < 2 ? h : h / 2);
        for (int64_t c = 0; c < n; c++) s.overlap[c] = overlap[c] + step * v[c];
        ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
        e[k] = energy_at(&s, 0);
    }
    const double coarse = (e[1] - e[0]) / (2 * h), fine = (e[3] - e[2]) / h;
    nlc_assert_rel((4 * fine - coarse) / 3, work, 1e-7);
    free(v), free(overlap), free(force);
    scene_free(&s);
}
END_TEST

/* The energy of a pair is that of Hertz, (2/5) P gamma. */
START_TEST(energy_of_a_pair)
{
    scene s;
    scene_init(&s);
    const int32_t m = scene_material(&s, 1e9, 0.2);
    scene_particle(&s, 1, m), scene_particle(&s, 2, m);
    scene_contact(&s, 0, 1, 1e-3, 1, 1, 0);
    ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
    nlc_assert_rel(energy_at(&s, 0), 0.4 * s.force[0] * 1e-3, 1e-14);
    scene_free(&s);
}
END_TEST

/* Forces that are no solution have no energy, and that is said. */
START_TEST(no_energy_without_a_solution)
{
    scene s;
    make(&s, 1);
    double e = 77;
    nlc_info info = {.struct_size = sizeof info};
    s.force[0] *= 1 + 1e-6;
    ck_assert_int_eq(nlc_energy(s.network, &e, s.force, s.overlap, s.normal, &info), NLC_WARNING_NOT_CONVERGED);
    ck_assert_int_eq(info.worst_contact, 0); /* the force itself; others miss what it moves */
    ck_assert(info.residual > 1e-7 && info.residual < 1e-5);
    scene_free(&s);
    scene_init(&s); /* weakened */
    scene_cell(&s, SIMPLE_CUBIC, 1, 1, 0.5, (const double[]){0.8, 0.8, 0.8});
    ck_assert(scene_solve(&s, 0) & NLC_WARNING_WEAKENED);
    ck_assert_int_eq(nlc_energy(s.network, &e, s.force, s.overlap, s.normal, 0), NLC_WARNING_NOT_CONVERGED);
    scene_free(&s);
}
END_TEST

static void tangent(const scene *s, double *out, const double *in)
{
    nlc_info info = {.struct_size = sizeof info};
    ck_assert_int_eq(nlc_tangent(s->network, out, in, s->force, s->normal, &info), NLC_OK);
    ck_assert(info.residual <= TOLERANCE);
}

/* T against differences of solutions, symmetry u.T v = v.T u, the inverse undoes it, and T is positive definite. */
START_TEST(tangent_is_the_derivative)
{
    scene s;
    make(&s, _i);
    const int64_t n = s.contacts;
    double *u = calloc((size_t)n, 8), *v = calloc((size_t)n, 8), *Tu = calloc((size_t)n, 8), *Tv = calloc((size_t)n, 8);
    double *back = calloc((size_t)n, 8), *overlap = calloc((size_t)n, 8), *f = calloc((size_t)n, 8), *force = calloc((size_t)n, 8);
    rng g = {8};
    const double top = largest(s.overlap, n), h = 1e-5;
    for (int64_t c = 0; c < n; c++) {
        const bool smooth = s.overlap[c] + s.nonlocal[c] > 0.02 * top;
        u[c] = smooth ? top * rng_uniform(&g, -1, 1) : 0;
        v[c] = smooth ? top * rng_uniform(&g, -1, 1) : 0;
    }
    tangent(&s, Tu, u);
    tangent(&s, Tv, v);
    double uTv = 0, vTu = 0, uTu = 0;
    for (int64_t c = 0; c < n; c++) uTv += u[c] * Tv[c], vTu += v[c] * Tu[c], uTu += u[c] * Tu[c];
    nlc_assert_abs(uTv, vTu, 1e-11 * uTu);
    ck_assert(uTu > 0);
    ck_assert_int_eq(nlc_tangent_inverse(s.network, back, Tu, s.force, s.normal, 0), NLC_OK);
    for (int64_t c = 0; c < n; c++) nlc_assert_abs(back[c], s.force[c] > 0 ? u[c] : 0, 1e-9 * top); /* small P: D^-1 is large */
    memcpy(overlap, s.overlap, (size_t)n * 8);
    memcpy(force, s.force, (size_t)n * 8);
    for (int k = -1; k <= 1; k += 2) {
        for (int64_t c = 0; c < n; c++) s.overlap[c] = overlap[c] + k * h * u[c];
        ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
        for (int64_t c = 0; c < n; c++) f[c] += k * s.force[c] / (2 * h);
    }
    for (int64_t c = 0; c < n; c++) nlc_assert_abs(f[c], Tu[c], 2e-6 * largest(Tu, n)); /* h^2 / 0.02^2, and 1e-13 / h */
    free(u), free(v), free(Tu), free(Tv), free(back), free(overlap), free(f), free(force);
    scene_free(&s);
}
END_TEST

/* K_k is no less than the diagonal of the particle's stiffness that differences show, and for lone pairs exactly D. */
START_TEST(bound_of_the_stiffness)
{
    scene s;
    make(&s, _i);
    const int64_t n = s.contacts;
    double *K = calloc((size_t)s.particles, 8), *in = calloc((size_t)n, 8), *out = calloc((size_t)n, 8);
    nlc_info info = {.struct_size = sizeof info};
    ck_assert_int_eq(nlc_tangent_bound(s.network, K, s.force, s.normal, &info), NLC_OK);
    ck_assert(info.lambda_upper < 1);
    for (int64_t k = 0; k < s.particles && k < 40; k++)
        for (int x = 0; x < 3; x++) { /* move the particle along x: its contacts' overlaps change, and the force on it */
            double answer = 0;
            for (int64_t c = 0; c < n; c++) {
                const double sign = (s.i[c] == k ? -1 : 0) + (s.j[c] == k ? 1 : 0);
                in[c] = -sign * s.normal[3 * c + x];
            }
            tangent(&s, out, in);
            for (int64_t c = 0; c < n; c++) answer += in[c] * out[c];
            ck_assert_msg(answer <= K[k] * (1 + 1e-12), "particle %d: %g > %g", (int)k, answer, K[k]);
        }
    free(K), free(in), free(out);
    scene_free(&s);
}
END_TEST

/*
 * More contacts on a particle than a block holds, in the most symmetric arrangement there is: equally spaced round its equator.
 * The mode to which they answer most alternates in sign from one to the next; the bound has to see it.
 */
START_TEST(symmetric_crowd)
{
    const int z = 80;
    scene s;
    scene_init(&s);
    s.options.tolerance = 1e-10;
    const int32_t soft = scene_material(&s, 1, 0.25), rigid = scene_material(&s, INFINITY, 0);
    scene_particle(&s, 1, soft);
    for (int k = 0; k < z; k++) scene_particle(&s, 0.02, rigid);
    for (int k = 0; k < z; k++) scene_contact(&s, 0, k + 1, 1e-3, cos(2 * 3.14159265358979324 * k / z), sin(2 * 3.14159265358979324 * k / z), 0);
    ck_assert_int_ge(scene_solve(&s, 0), NLC_OK);
    double in[80], out[80], K[81], answer = 0, largest_answer = 0;
    ck_assert_int_eq(nlc_tangent_bound(s.network, K, s.force, s.normal, 0), NLC_OK);
    for (int k = 0; k < z; k++) in[k] = k % 2 ? 1 : -1;
    tangent(&s, out, in);
    for (int k = 0; k < z; k++) answer += in[k] * out[k], largest_answer = fmax(largest_answer, fabs(out[k]));
    ck_assert(answer <= K[0] && largest_answer <= K[1]);
    if (verbose()) printf("ratio %g\n", answer * (1e-3 + s.nonlocal[0]) / (80 * 1.5 * s.force[0]));
    ck_assert(answer > 1.02 * 80 * 1.5 * s.force[0] / (1e-3 + s.nonlocal[0])); /* more than without coupling: it matters */
    scene_free(&s);
}
END_TEST

/*
 * As many contacts, all but two opposite ones of which carry next to nothing: lambda is that of the two, D = 3/2 k (P/k)^(1/3) times what a
 * unit force displaces on the other side.  (Lanczos' method comes to an end after two steps.)
 */
START_TEST(crowd_of_two)
{
    const int z = 80;
    const double E = 1e6, nu = 0.3, force = 3;
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    scene_particle(&s, 1, scene_material(&s, E, nu));
    const int32_t wall = 1 + scene_wall(&s, scene_material(&s, INFINITY, 0));
    scene_contact(&s, 0, wall, 0, 0, 0, 1);
    scene_contact(&s, 0, wall, 0, 0, 0, -1);
    for (int k = 2; k < z; k++) { /* a spiral of evenly spread directions */
        const double h = 1 - 2 * (k - 0.5) / z, r = sqrt(1 - h * h), phi = 3.14159265358979324 * (1 + sqrt(5)) * k;
        scene_contact(&s, 0, wall, 0, r * cos(phi), r * sin(phi), h);
    }
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    const double D = 1.5 * (double)scene_stiffness(&s, 0) * cbrt(force / (double)scene_stiffness(&s, 0));
    const double lambda = D * fabs(nlc_nonlocal_displacement(1, acos(-1), 1, E, nu));
    for (int p = 40; p < 300; p += 20) {
        double K[1];
        for (int k = 0; k < z; k++) s.force[k] = k < 2 ? force : pow(10, -p);
        nlc_assert_quiet(ck_assert_int_eq(nlc_tangent_bound(s.network, K, s.force, s.normal, &info), NLC_OK));
        ck_assert(info.lambda_upper >= lambda * (1 - 1e-12) && info.lambda_upper <= lambda * (1 + 1e-6));
    }
    scene_free(&s);
}
END_TEST

/* The largest eigenvalue of tridiagonal matrices: 2 cos(pi / (n + 1)) of ones beside nothing; of a multiple of 1; of nothing. */
START_TEST(tridiagonal)
{
    double a[64], b[64];
    for (int n = 1; n <= 64; n++) {
        for (int k = 0; k < n; k++) a[k] = 0, b[k] = 1;
        nlc_assert_abs(nlc_largest_tridiagonal(a, b, n), 2 * cos(acos(-1) / (n + 1)), 1e-14); /* of a norm of 2 */
        for (int k = 0; k < n; k++) a[k] = -3, b[k] = 0;
        nlc_assert_quiet(nlc_assert_rel(nlc_largest_tridiagonal(a, b, n), -3, 1e-12));
        for (int k = 0; k < n; k++) a[k] = 0;
        nlc_assert_quiet(nlc_assert_same(nlc_largest_tridiagonal(a, b, n), 0));
    }
}
END_TEST

/* A row of e beside elements of 1: their largest eigenvalue is n - 1 and moves by less than the square of e; in units of any size. */
START_TEST(small_beside_large)
{
    double B[64], work[32];
    for (int n = 3; n <= 8; n++)
        for (int p = 7; p < 250; p += 3)
            for (int q = -40; q <= 140; q += 20) {
                const double unit = pow(10, q), e = unit * pow(10, -p);
                for (int i = 0; i < n * n; i++) B[i] = i == 0 ? 0 : i < n || i % n == 0 ? e * (1 + (i + i / n) % 3) : unit;
                nlc_assert_quiet(nlc_assert_rel(nlc_largest_eigenvalue(B, n, work), unit * (n - 1), 1e-11));
            }
}
END_TEST

/* What the memory held before is of no importance. */
START_TEST(memory_need_not_be_clean)
{
    for (int model = 0; model < 6; model++) {
        double K[2][64] = {{0}}, total[2];
        for (int fill = 0; fill < 2; fill++) {
            rng g = {5};
            scene s;
            scene_init(&s);
            s.options.model = model;
            scene_cluster(&s, &g, 9, 0.6);
            ck_assert_int_eq(scene_build(&s), NLC_OK);
            const nlc_particles view = scene_view(&s);
            const size_t size = nlc_network_size(&view, s.contacts, &s.options);
            memset(s.memory, fill ? 0xff : 0, size);
            ck_assert_int_eq(nlc_network_init(&s.network, s.memory, size, &view, s.i, s.j, s.contacts, &s.options, 0), NLC_OK);
            ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
            const bool potential = model != NLC_MODEL_HALF_SPACE && model != NLC_MODEL_LOVE;
            ck_assert_int_eq(nlc_tangent_bound(s.network, K[fill], s.force, s.normal, 0), potential ? NLC_OK : NLC_ERROR_NO_POTENTIAL);
            total[fill] = scene_total(&s);
            scene_free(&s);
        }
        nlc_assert_same(total[0], total[1]);
        for (int k = 0; k < 64; k++) nlc_assert_same(K[0][k], K[1][k]);
    }
}
END_TEST

/* Extremely different units: the same numbers times powers of two. */
START_TEST(units_do_not_matter)
{
    scene s, t;
    make(&s, 1);
    rng g = {5};
    scene_init(&t);
    t.options.tolerance = TOLERANCE;
    scene_cluster(&t, &g, 11, 0.6);
    const int a = 150, b = -200; /* lengths 4^a, moduli 2^b */
    for (int64_t k = 0; k < t.particles; k++) t.radius[k] = ldexp(t.radius[k], 2 * a);
    for (int64_t m = 0; m < t.materials; m++) t.rows[m].young = ldexp(t.rows[m].young, b);
    for (int64_t c = 0; c < t.contacts; c++) t.overlap[c] = ldexp(t.overlap[c], 2 * a);
    ck_assert_int_eq(scene_solve(&t, 0), NLC_OK);
    nlc_assert_rel(energy_at(&t, 0), ldexp(energy_at(&s, 0), 6 * a + b), 1e-13);
    double u[64], v[64];
    tangent(&s, u, s.overlap);
    tangent(&t, v, t.overlap);
    for (int64_t c = 0; c < s.contacts; c++) nlc_assert_abs(v[c], ldexp(u[c], 4 * a + b), 1e-11 * fabs(ldexp(u[c], 4 * a + b)) + 1e-300);
    scene_free(&s);
    scene_free(&t);
}
END_TEST

/* Slopes that no double can hold, above and below. */
START_TEST(slopes_out_of_range)
{
    static const double size[] = {5e-324, 1.7e308};
    for (int k = 0; k < 2; k++) {
        scene s;
        scene_init(&s);
        const int32_t m = scene_material(&s, 1, 0.3), a = scene_particle(&s, 1, m);
        scene_contact(&s, a, scene_particle(&s, 1, m), 1, 1, 0, 0);
        s.options.model = NLC_MODEL_HERTZ;
        s.options.stiffness = size + k;
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        double out[2] = {7, 7}, in = 1;
        nlc_assert_quiet(ck_assert_int_eq(nlc_tangent(s.network, out, &in, size + k, s.normal, 0), NLC_ERROR_RANGE));
        nlc_assert_quiet(ck_assert_int_eq(nlc_tangent_bound(s.network, out, size + k, s.normal, 0), NLC_ERROR_RANGE));
        for (int c = 0; c < 2; c++) nlc_assert_same(out[c], 7);
        scene_free(&s);
    }
}
END_TEST

/* What is said of contacts without force has no part in it, however large. */
START_TEST(open_contacts_do_not_matter)
{
    for (int model = 0; model < 2; model++) {
        scene s;
        make(&s, 1);
        s.options.model = model ? NLC_MODEL_HERTZ : NLC_MODEL_GONZALEZ_CUITINO;
        scene_contact(&s, 0, scene_particle(&s, 1, s.material[0]), -1, 0.36, 0.48, 0.8);
        free(s.force), free(s.nonlocal), free(s.memory);
        s.force = s.nonlocal = 0, s.memory = 0, s.network = 0;
        ck_assert_int_eq(scene_solve(&s, 0), NLC_OK);
        const int64_t open = s.contacts - 1;
        nlc_assert_same(s.force[open], 0);
        double in[64], out[2][64];
        for (int64_t c = 0; c < s.contacts; c++) in[c] = s.overlap[c];
        for (int inverse = 0; inverse < 2; inverse++)
            for (int large = 0; large < 12; large++) {
                in[open] = large ? ldexp(-1, 93 * large) : 0;
                nlc_assert_quiet(ck_assert_int_eq((inverse ? nlc_tangent_inverse : nlc_tangent)(s.network, out[large > 0], in, s.force, s.normal, 0), NLC_OK));
                for (int64_t c = 0; c < s.contacts; c++) nlc_assert_same(out[large > 0][c], out[0][c]);
                nlc_assert_same(out[0][open], 0);
                ck_assert(fabs(out[0][0]) > 0);
            }
        scene_free(&s);
    }
}
END_TEST

/*
 * Two contacts in the same direction, on particles whose block is looked at in one piece and on one with more contacts: without a
 * bound, however stiff they are, and without an exception.
 */
START_TEST(equal_directions)
{
    static const int counts[] = {2, 3, 9, 63, 70, 200};
    for (int k = 0; k < 6; k++)
        for (double scale = 1; scale < 1e50; scale *= 1e12) {
            scene s;
            scene_init(&s);
            const int count = counts[k];
            const int32_t soft = scene_material(&s, 1e9, 0.3), middle = scene_particle(&s, 1, soft);
            for (int c = 0; c < count; c++) { /* a spiral; the last one is where the first one is */
                const int at = c == count - 1 ? 0 : c;
                const double z = 1 - (2 * at + 1.0) / count, r = sqrt(1 - z * z);
                scene_contact(&s, middle, scene_particle(&s, 1, soft), 1e-3, r * cos(2.4 * at), r * sin(2.4 * at), z);
                stiffness[c] = 1e9 * scale;
            }
            s.options.stiffness = stiffness;
            ck_assert_int_eq(scene_build(&s), NLC_OK);
            for (int c = 0; c < count; c++) s.force[c] = 1e9 * scale * (1 + c % 3);
            double *bound = calloc((size_t)s.particles, sizeof *bound);
            ck_assert_int_eq(nlc_tangent_bound(s.network, bound, s.force, s.normal, 0), NLC_ERROR_UNSTABLE);
            free(bound);
            scene_free(&s);
        }
}
END_TEST

/* Close directions and large forces, in every model: finite results or an error, and no exception. */
START_TEST(close_and_large)
{
    for (int32_t model = 0; model < nlc_model_count(); model++)
        for (int apart = 2; apart < 120; apart += 7)
            for (int large = 0; large < 1023; large += 33) {
                scene s;
                double w[4] = {0}, energy = 0;
                scene_init(&s);
                s.options.model = model;
                const int32_t soft = scene_material(&s, 1e9, 0.3), middle = scene_particle(&s, 1, soft);
                for (int c = 0; c < 2; c++) scene_contact(&s, middle, scene_particle(&s, 2, soft), 1e-3, 1, ldexp(c, -apart), 0);
                ck_assert_int_eq(scene_build(&s), NLC_OK);
                s.force[0] = ldexp(1.5, large), s.force[1] = ldexp(1, large / 2);
                const nlc_status swept = nlc_sweep(s.network, w, s.force, s.overlap, s.normal, 0);
                if (swept != NLC_OK) ck_assert(swept == NLC_ERROR_RANGE || swept == NLC_ERROR_COINCIDENT);
                for (int e = 0; e < 4; e++) ck_assert(isfinite(w[e]));
                const nlc_status status = nlc_energy(s.network, &energy, s.force, s.overlap, s.normal, 0);
                if (status < 0) ck_assert(status == NLC_ERROR_RANGE || status == NLC_ERROR_COINCIDENT || status == NLC_ERROR_NO_POTENTIAL);
                ck_assert(isfinite(energy));
                scene_free(&s);
            }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("tangent");
    TCase *t = tcase_create("tangent");
    tcase_set_timeout(t, 60);
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    tcase_add_loop_test(t, energy_derives_to_the_force, 0, SCENES);
    tcase_add_test(t, energy_of_a_pair);
    tcase_add_test(t, no_energy_without_a_solution);
    tcase_add_loop_test(t, tangent_is_the_derivative, 0, SCENES);
    tcase_add_loop_test(t, bound_of_the_stiffness, 0, SCENES);
    tcase_add_test(t, symmetric_crowd);
    tcase_add_test(t, crowd_of_two);
    tcase_add_test(t, tridiagonal);
    tcase_add_test(t, small_beside_large);
    tcase_add_test(t, memory_need_not_be_clean);
    tcase_add_test(t, units_do_not_matter);
    tcase_add_test(t, slopes_out_of_range);
    tcase_add_test(t, open_contacts_do_not_matter);
    tcase_add_test(t, equal_directions);
    tcase_add_test(t, close_and_large);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
