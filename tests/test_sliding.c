/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_sliding.c - saturated friction and its torques: closed forms, a sum over contacts in long double, balances of momentum and
 * angular momentum, names of the sides, and the caller's rows.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

static const double mu = 0.3;

/* A scene with what a call needs beside it. */
typedef struct slide {
    scene s;
    double *sliding, *displacement, *F, *torque;
    double wall[18];
} slide;

static void across(rng *g, const double *n, double *t)
{
    double length = 0;
    rng_unit(g, t);
    const double along = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
    for (int x = 0; x < 3; x++) t[x] -= along * n[x];
    for (int x = 0; x < 3; x++) length += t[x] * t[x];
    for (int x = 0; x < 3; x++) t[x] /= sqrt(length);
}

/* Random directions (every seventh contact does not slide) and displacements; forces are those of Hertz, some are pulls. */
static void build(slide *k, rng *g)
{
    const int64_t n = k->s.contacts;
    ck_assert_int_eq(scene_build(&k->s), NLC_OK);
    k->sliding = calloc(3 * (size_t)n, sizeof(double));
    k->displacement = calloc(2 * (size_t)n, sizeof(double));
    k->F = calloc(3 * (size_t)k->s.particles, sizeof(double));
    k->torque = calloc(3 * (size_t)k->s.particles, sizeof(double));
    memset(k->wall, 0, sizeof k->wall);
    for (int64_t c = 0; c < n; c++) {
        if (c % 7 != 6) across(g, k->s.normal + 3 * c, k->sliding + 3 * c);
        for (int e = 0; e < 2; e++) k->displacement[2 * c + e] = rng_uniform(g, -0.3, 0.3) * fabs(k->s.overlap[c]);
        k->s.force[c] = nlc_hertz_force((double)scene_stiffness(&k->s, c), k->s.overlap[c]) * (c % 5 == 4 ? -0.5 : 1);
    }
}

static void end(slide *k)
{
    free(k->sliding), free(k->displacement), free(k->F), free(k->torque);
    scene_free(&k->s);
}

/* A die packing between walls, and below it a sphere that touches itself. */
static void die(slide *k, uint64_t seed)
{
    rng g = {seed};
    scene_init(&k->s);
    scene_packing(&k->s, "b_die125_rd0.70.csv", 0.3);
    const int32_t first = (int32_t)k->s.particles;
    scene_particle(&k->s, 1e-4, scene_material(&k->s, 5e9, 0.1));
    for (int64_t c = 0; c < k->s.contacts; c++) { /* the walls move up by one */
        k->s.i[c] += k->s.i[c] >= first;
        k->s.j[c] += k->s.j[c] >= first;
    }
    for (int c = 0; c < 12; c++) {
        double n[3];
        rng_unit(&g, n);
        scene_contact(&k->s, first, first, rng_uniform(&g, 1e-6, 4e-6), n[0], n[1], n[2]);
    }
    build(k, &g);
}

static nlc_status call(slide *k)
{
    return nlc_assemble_sliding(k->s.network, k->F, 0, k->torque, 0, k->wall, k->s.force, k->s.normal, k->sliding, k->displacement,
                                k->s.overlap, mu, 0);
}

static void cross(const double *a, const double *b, double *product)
{
    for (int x = 0; x < 3; x++) product[x] = a[(x + 1) % 3] * b[(x + 2) % 3] - a[(x + 2) % 3] * b[(x + 1) % 3];
}

/*
 * A ball on a floor whose underside slides along x is braked, and rolls faster: about z x x = +y.  Numbers are chosen so that all
 * is exact.  With a gap, the lever ends on the displaced surface; where surfaces overlap, midway between them.
 */
START_TEST(ball_on_a_floor)
{
    const double P = 8, R = 2, friction = 0.25, w[2] = {0.125, 0.0625};
    const double overlap[] = {0.5, 0, -0.125, -0.1875, -0.25, -1};
    const double lever[] = {R + 0.125 - 0.34375, R + 0.03125, R + 0.09375, R + 0.125, R + 0.125, R + 0.125};
    for (int a = 0; a < 6; a++)
        for (int swapped = 0; swapped < 2; swapped++) {
            scene s;
            scene_init(&s);
            const int32_t m = scene_material(&s, 1e6, 0.25);
            scene_particle(&s, R, m);
            const int32_t floor = 1 + scene_wall(&s, m);
            const double sign = swapped ? -1 : 1, t[3] = {-sign, 0, 0}, side[2] = {w[swapped], w[!swapped]};
            double F[3] = {0}, wall[3] = {0}, torque[3] = {0}, bare[3] = {0};
            scene_contact(&s, swapped ? floor : 0, swapped ? 0 : floor, overlap[a], 0, 0, -sign);
            ck_assert_int_eq(scene_build(&s), NLC_OK);
            ck_assert_int_eq(nlc_assemble_sliding(s.network, F, 0, torque, 0, wall, &P, s.normal, t, side, s.overlap, friction, 0),
                             NLC_OK);
            const double expected[3][3] = {{-2, 0, 8}, {2, 0, -8}, {0, 2 * lever[a], 0}};
            for (int x = 0; x < 3; x++) {
                ck_assert(F[x] == expected[0][x]);
                ck_assert(wall[x] == expected[1][x]);
                ck_assert(torque[x] == expected[2][x]);
            }
            /* without displacements and without a wall's force */
            ck_assert_int_eq(nlc_assemble_sliding(s.network, F, 0, bare, 0, 0, &P, s.normal, t, 0, s.overlap, friction, 0),
                             NLC_OK);
            ck_assert(bare[1] == 2 * (R - (a == 0 ? 0.25 : 0)) && bare[0] == 0 && bare[2] == 0);
            scene_free(&s);
        }
}
END_TEST

/* Two spheres anywhere: with the torques, nothing turns about the origin, since both levers end in one point. */
START_TEST(angular_momentum)
{
    rng g = {17};
    for (int round = 0; round < 300; round++) {
        slide k;
        double n[3], a[3], moment[3], arm[3], sum[3] = {0};
        scene_init(&k.s);
        rng_unit(&g, n);
        scene_particle(&k.s, rng_uniform(&g, 0.5, 2), scene_material(&k.s, 1, 0.3));
        scene_particle(&k.s, rng_uniform(&g, 0.5, 2), scene_material(&k.s, round % 3 ? INFINITY : 2, 0.2));
        scene_contact(&k.s, 0, 1, rng_uniform(&g, 0.01, 0.4), n[0], n[1], n[2]);
        build(&k, &g);
        k.s.force[0] = 3;
        ck_assert_int_eq(call(&k), NLC_OK);
        const double distance = k.s.radius[0] + k.s.radius[1] - k.s.overlap[0];
        for (int x = 0; x < 3; x++) {
            a[x] = rng_uniform(&g, -1, 1); /* centre of the first one */
            sum[x] += k.torque[x] + k.torque[3 + x];
        }
        cross(a, k.F, moment);
        for (int x = 0; x < 3; x++) sum[x] += moment[x];
        for (int x = 0; x < 3; x++) arm[x] = a[x] + distance * k.s.normal[x];
        cross(arm, k.F + 3, moment);
        for (int x = 0; x < 3; x++) {
            nlc_assert_abs(sum[x] + moment[x], 0, 1e-14); /* 30 roundings of terms up to 10 */
            nlc_assert_same(k.F[x], -k.F[3 + x]);
        }
        double size = 0;
        for (int x = 0; x < 3; x++) size += k.torque[x] * k.torque[x];
        ck_assert(size > 0.04); /* there is something to balance: 0.9 N at 0.3 m or more */
        end(&k);
    }
}
END_TEST

/* Contact by contact in long double, from points in space: r x f about the centre, r to the point midway between the surfaces. */
static void add_exact(const slide *k, long double *F, long double *torque, long double *size)
{
    const scene *s = &k->s;
    for (int64_t c = 0; c < s->contacts; c++)
        for (int e = 0; e < 2; e++) {
            const int64_t body = e ? s->j[c] : s->i[c];
            if (body >= s->particles) continue;
            const long double R = s->radius[body], own = k->displacement[2 * c + e], other = k->displacement[2 * c + 1 - e];
            const long double surface = R + own, facing = R - s->overlap[c] - other; /* from the centre, along the outward normal */
            const long double rho = facing < surface ? (surface + facing) / 2 : surface;
            const long double sign = e ? -1 : 1, P = s->force[c];
            long double r[3], f[3];
            for (int x = 0; x < 3; x++) {
                r[x] = sign * rho * s->normal[3 * c + x];
                f[x] = sign * (P > 0 ? mu * P * k->sliding[3 * c + x] : 0);
            }
            for (int x = 0; x < 3; x++) {
                const int y = (x + 1) % 3, z = (x + 2) % 3;
                torque[3 * body + x] += r[y] * f[z] - r[z] * f[y];
                if (s->i[c] != s->j[c]) F[3 * body + x] += f[x] - sign * P * s->normal[3 * c + x];
                *size = fmaxl(*size, fabsl(P));
            }
        }
}

START_TEST(packing_with_walls)
{
    slide k;
    die(&k, 3);
    const int64_t particles = k.s.particles;
    long double *F = calloc(3 * (size_t)particles, sizeof *F), *torque = calloc(3 * (size_t)particles, sizeof *torque), size = 0;
    double sum[3] = {0}, turned = 0;
    for (int64_t x = 0; x < 3 * particles; x++) {
        F[x] = k.F[x] = 1e-3 * (double)(x % 11);
        torque[x] = k.torque[x] = -1e-6 * (double)(x % 5);
    }
    nlc_info info = {.struct_size = sizeof info};
    int64_t active = 0;
    for (int64_t c = 0; c < k.s.contacts; c++) active += k.s.force[c] > 0;
    add_exact(&k, F, torque, &size);
    for (int64_t x = 0; x < 3 * particles; x++) sum[x % 3] -= k.F[x];
    ck_assert_int_eq(nlc_assemble_sliding(k.s.network, k.F, 0, k.torque, 0, k.wall, k.s.force, k.s.normal, k.sliding,
                                          k.displacement, k.s.overlap, mu, &info), NLC_OK);
    ck_assert_int_eq(info.active, active);
    const double tolerance = 1e-14 * ((double)size + 1e-2); /* some twenty terms on a particle */
    for (int64_t x = 0; x < 3 * particles; x++) {
        nlc_assert_abs(k.F[x], (double)F[x], tolerance);
        nlc_assert_abs(k.torque[x], (double)torque[x], tolerance * k.s.radius[x / 3] + 1e-20);
        turned = fmax(turned, fabs((double)torque[x]));
        sum[x % 3] += k.F[x];
    }
    ck_assert(turned > 100 * 5e-6);
    for (int w = 0; w < 6; w++)
        for (int x = 0; x < 3; x++) sum[x] += k.wall[3 * w + x];
    for (int x = 0; x < 3; x++) nlc_assert_abs(sum[x], 0, 1e3 * tolerance); /* momentum: of all bodies */
    free(F), free(torque);
    end(&k);
}
END_TEST

/* A sphere that touches its own periodic image gets both torques, and no force. */
START_TEST(own_image)
{
    scene s;
    scene_init(&s);
    scene_particle(&s, 2, scene_material(&s, 1e6, 0.3));
    scene_contact(&s, 0, 0, 0.5, 0, 0, 1);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    const double P = 4, t[3] = {1, 0, 0}, w[2] = {0.25, -0.125};
    double F[3] = {0}, torque[3] = {0};
    ck_assert_int_eq(nlc_assemble_sliding(s.network, F, 0, torque, 0, 0, &P, s.normal, t, w, s.overlap, 0.5, 0), NLC_OK);
    ck_assert(F[0] == 0 && F[1] == 0 && F[2] == 0);
    ck_assert(torque[0] == 0 && torque[1] == 2 * (4 - 0.5) && torque[2] == 0); /* both levers are the distance */
    scene_free(&s);
}
END_TEST

/* Without friction, and where nothing slides, it is nlc_assemble. */
START_TEST(without_friction)
{
    slide k;
    die(&k, 5);
    double *F = calloc(3 * (size_t)k.s.particles, sizeof *F), wall[18] = {0};
    nlc_info info = {.struct_size = sizeof info};
    int64_t active = 0;
    k.s.force[0] = 0;
    for (int64_t c = 0; c < k.s.contacts; c++) active += k.s.force[c] > 0;
    ck_assert_int_eq(nlc_assemble(k.s.network, F, 0, wall, k.s.force, k.s.normal, &info), NLC_OK);
    ck_assert_int_eq(info.active, active);
    for (int a = 0; a < 2; a++) {
        if (a) memset(k.sliding, 0, 3 * (size_t)k.s.contacts * sizeof(double));
        memset(k.F, 0, 3 * (size_t)k.s.particles * sizeof(double));
        memset(k.wall, 0, sizeof k.wall);
        ck_assert_int_eq(nlc_assemble_sliding(k.s.network, k.F, 0, k.torque, 0, k.wall, k.s.force, k.s.normal, k.sliding,
                                              k.displacement, k.s.overlap, a * mu, 0), NLC_OK);
        for (int64_t x = 0; x < 3 * k.s.particles; x++) ck_assert(k.F[x] == F[x] && k.torque[x] == 0);
        for (int x = 0; x < 18; x++) ck_assert(k.wall[x] == wall[x]);
    }
    free(F);
    end(&k);
}
END_TEST

/* Exchange i and j of every contact or of a random half, with all that is theirs: not a bit changes. */
START_TEST(exchange_of_sides_changes_no_bit)
{
    slide k, other;
    rng g = {(uint64_t)_i};
    die(&k, 9);
    die(&other, 9);
    for (int64_t c = 0; c < k.s.contacts; c++) { /* so large that their last bits can be seen in the levers */
        other.s.overlap[c] = k.s.overlap[c] = rng_uniform(&g, -1e-3, 1e-3);
        for (int e = 0; e < 2; e++) other.displacement[2 * c + e] = k.displacement[2 * c + e] = rng_uniform(&g, -1e-3, 1e-3);
    }
    for (int64_t c = 0; c < k.s.contacts; c++) {
        if (_i && rng_below(&g, 2)) continue;
        const int32_t i = other.s.i[c];
        const double w = other.displacement[2 * c];
        other.s.i[c] = other.s.j[c];
        other.s.j[c] = i;
        other.displacement[2 * c] = other.displacement[2 * c + 1];
        other.displacement[2 * c + 1] = w;
        for (int x = 0; x < 3; x++) other.s.normal[3 * c + x] *= -1, other.sliding[3 * c + x] *= -1;
    }
    const nlc_particles view = scene_view(&other.s);
    ck_assert_int_eq(nlc_network_init(&other.s.network, other.s.memory, nlc_network_size(&view, other.s.contacts, 0), &view,
                                      other.s.i, other.s.j, other.s.contacts, 0, 0), NLC_OK);
    ck_assert_int_eq(call(&k), NLC_OK);
    ck_assert_int_eq(call(&other), NLC_OK);
    for (int64_t x = 0; x < 3 * k.s.particles; x++) {
        nlc_assert_same(k.F[x], other.F[x]);
        nlc_assert_same(k.torque[x], other.torque[x]);
    }
    for (int x = 0; x < 18; x++) nlc_assert_same(k.wall[x], other.wall[x]);
    end(&k);
    end(&other);
}
END_TEST

/* Forces and torques in structs of the host, at odd addresses; the last one first, and another stride for each. */
START_TEST(strides)
{
    typedef struct grain {
        char odd, f[3 * sizeof(double)], tail[6];
    } grain;
    slide k;
    die(&k, 4);
    const size_t n = (size_t)k.s.particles, row = 5 * sizeof(double) + 1;
    grain *grains = malloc(n * sizeof *grains);
    char *torques = malloc(n * row);
    memset(grains, 0x5a, n * sizeof *grains);
    memset(torques, 0x5a, n * row);
    for (size_t p = 0; p < n; p++) memset(grains[p].f, 0, sizeof grains[p].f), memset(torques + p * row, 0, 3 * sizeof(double));
    ck_assert_int_eq(call(&k), NLC_OK);
    ck_assert_int_eq(nlc_assemble_sliding(k.s.network, (double *)(void *)grains[n - 1].f, -(ptrdiff_t)sizeof *grains,
                                          (double *)(void *)torques, (ptrdiff_t)row, 0, k.s.force, k.s.normal, k.sliding,
                                          k.displacement, k.s.overlap, mu, 0), NLC_OK);
    for (size_t p = 0; p < n; p++) {
        const grain *at = grains + n - 1 - p;
        ck_assert(memcmp(at->f, k.F + 3 * p, sizeof at->f) == 0);
        ck_assert(memcmp(torques + p * row, k.torque + 3 * p, 3 * sizeof(double)) == 0);
        ck_assert(at->odd == 0x5a && at->tail[0] == 0x5a && at->tail[5] == 0x5a);
        for (size_t b = 3 * sizeof(double); b < row; b++) ck_assert(torques[p * row + b] == 0x5a);
    }
    free(grains), free(torques);
    end(&k);
}
END_TEST

/*
 * Lengths, forces and friction of any size: the torque is right to rounding where it can be written down, whatever two of the
 * three make, and nothing is raised.
 */
START_TEST(any_size)
{
    rng g = {8};
    int met = 0;
    if (!long_double_is_wider()) return;
    for (int round = 0; round < 20000; round++) {
        scene s;
        const double n[3] = {0, 0, 1}, t[3] = {0, -1, 0}, R = rng_log(&g, -300, 300), P = rng_log(&g, -1074, 1000);
        const double friction = rng_log(&g, -1000, 1000), overlap = R * rng_uniform(&g, -1, 1.9);
        double F[6] = {0}, torque[6] = {0};
        nlc_status status = NLC_OK;
        scene_init(&s);
        const int32_t m = scene_material(&s, 1 / R, 0.3);
        scene_particle(&s, R, m);
        scene_particle(&s, R, m);
        scene_contact(&s, 0, 1, overlap, n[0], n[1], n[2]);
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        nlc_assert_quiet(status = nlc_assemble_sliding(s.network, F, 0, torque, 0, 0, &P, n, t, 0, &overlap, friction, 0));
        const long double exact = (R - fmaxl(overlap, 0) / 2) * P * friction;
        if (status == NLC_OK) {
            met++;
            for (int e = 0; e < 2; e++) {
                /* a difference and two products, each rounded once, and perhaps once more into a subnormal number */
                ck_assert(ulp_error(torque[3 * e], exact, exact) <= 4);
                ck_assert(ulp_error(fabs(F[3 * e + 1]), (long double)friction * P, (long double)friction * P) <= 1);
                ck_assert((F[3 * e + 1] > 0) == (e == 1) || F[3 * e + 1] == 0);
            }
        } else {
            ck_assert_int_eq(status, NLC_ERROR_RANGE);
            ck_assert(R * 0x1p9L * P * friction > 0x1p1023L || (1 + (long double)friction) * P > 0x1p1015L);
            ck_assert(F[1] == 0 && torque[0] == 0);
        }
        scene_free(&s);
    }
    ck_assert_int_gt(met, 5000);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("sliding");
    TCase *t = tcase_create("sliding");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    tcase_add_test(t, ball_on_a_floor);
    tcase_add_test(t, angular_momentum);
    tcase_add_test(t, packing_with_walls);
    tcase_add_test(t, own_image);
    tcase_add_test(t, without_friction);
    tcase_add_loop_test(t, exchange_of_sides_changes_no_bit, 0, 4);
    tcase_add_test(t, strides);
    suite_add_tcase(suite, t);
    TCase *quiet = tcase_create("any size"); /* looks at the flags itself */
    tcase_add_test(quiet, any_size);
    suite_add_tcase(suite, quiet);
    return run_suite(suite);
}
