/* SPDX-License-Identifier: BSD-2-Clause */
/* test_hosts.c - from positions and neighbour lists to contacts, and from one list to the next. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

enum { MANY = 400 };

/* ------------------------------------------------------------------------------------------------------------- pairs -- */

/* A particle as a host may have it: position, radius and mask among other things. */
typedef struct grain {
    double v[3], x[3], radius;
    int64_t tag;
} grain;

typedef struct places {
    grain grains[MANY];
    double x[MANY], y[MANY], z[MANY], radius[MANY];
    nlc_particles particles;
    nlc_positions positions;
} places;

static places p;
static int32_t pair_i[MANY], pair_j[MANY];
static double overlap[MANY], normal[MANY][3];

static void look_at_structs(void)
{
    p.particles = (nlc_particles){
        .struct_size = sizeof p.particles, .count = MANY, .radius = &p.grains[0].radius, .radius_stride = sizeof(grain)};
    p.positions = (nlc_positions){.struct_size = sizeof p.positions,
                                  .x = &p.grains[0].x[0],
                                  .y = &p.grains[0].x[1],
                                  .z = &p.grains[0].x[2],
                                  .stride = sizeof(grain)};
}

static void look_at_arrays(void)
{
    for (int k = 0; k < MANY; k++) {
        p.x[k] = p.grains[k].x[0];
        p.y[k] = p.grains[k].x[1];
        p.z[k] = p.grains[k].x[2];
        p.radius[k] = p.grains[k].radius;
    }
    p.particles = (nlc_particles){.struct_size = sizeof p.particles, .count = MANY, .radius = p.radius};
    p.positions = (nlc_positions){.struct_size = sizeof p.positions, .x = p.x, .y = p.y, .z = p.z};
}

static nlc_status find(int64_t count)
{
    nlc_status status;
    nlc_assert_quiet(status =
                         nlc_contacts_from_pairs(overlap, normal[0], &p.particles, &p.positions, pair_i, pair_j, count, 0));
    return status;
}

/* Pairs 2k, 2k+1 a little more or less than their radii apart, in units of 2^exponent, far away from the origin or near it. */
static void scatter(rng *g, int exponent)
{
    for (int k = 0; k < MANY; k += 2) {
        double direction[3];
        rng_unit(g, direction);
        const double R = rng_uniform(g, 0.5, 2), r = rng_uniform(g, 0.01, 2),
                     away = rng_below(g, 2) ? 0 : rng_uniform(g, -100, 100);
        const double d = (R + r) * rng_uniform(g, 0.6, 1.3);
        p.grains[k].radius = ldexp(R, exponent);
        p.grains[k + 1].radius = ldexp(r, exponent);
        for (int x = 0; x < 3; x++) {
            const double at = away * rng_uniform(g, -1, 1);
            p.grains[k].x[x] = ldexp(at, exponent);
            p.grains[k + 1].x[x] = ldexp(at + d * direction[x], exponent);
        }
        pair_i[k / 2] = k;
        pair_j[k / 2] = k + 1;
    }
}

/* Largest errors, in ulp as the header counts them, of all pairs against long double. */
static void measure(int64_t count, double *worst_overlap, double *worst_normal)
{
    for (int64_t c = 0; c < count; c++) {
        const grain *a = &p.grains[pair_i[c]], *b = &p.grains[pair_j[c]];
        long double d[3], square = 0;
        for (int x = 0; x < 3; x++) d[x] = (long double)b->x[x] - a->x[x];
        for (int x = 0; x < 3; x++) square += d[x] * d[x];
        const long double length = sqrtl(square), radii = (long double)a->radius + b->radius;
        *worst_overlap = fmax(*worst_overlap, ulp_error(overlap[c], radii - length, fmaxl(radii, length)));
        for (int x = 0; x < 3; x++) *worst_normal = fmax(*worst_normal, ulp_error(normal[c][x], d[x] / length, 1));
    }
}

/*
 * Rounding: differences 0.5, squares and root about 1.5, quotient 0.5, sum and difference 1 ulp; a normal's component is at
 * most 1.  The scales go where squares would over- or underflow.
 */
START_TEST(pairs_at_any_scale)
{
    const int exponents[] = {0, -30, -997, 990, 1015, -500, 511, 799, 800};
    double worst_overlap = 0, worst_normal = 0, first[MANY], first_normal[MANY][3];
    const uint64_t rounds = 1 + points(50 * 9 * MANY / 2) / (9 * MANY / 2);
    rng g = {11};
    if (!long_double_is_wider()) return;
    for (int e = 0; e < 9; e++)
        for (uint64_t round = 0; round < rounds; round++) {
            scatter(&g, exponents[e]);
            look_at_structs();
            ck_assert_int_eq(find(MANY / 2), NLC_OK);
            measure(MANY / 2, &worst_overlap, &worst_normal);
            memcpy(first, overlap, sizeof first);
            memcpy(first_normal, normal, sizeof normal);
            look_at_arrays();
            ck_assert_int_eq(find(MANY / 2), NLC_OK); /* the same particles, otherwise in memory */
            for (int c = 0; c < MANY / 2; c++) nlc_assert_same(overlap[c], first[c]);
            for (int c = 0; c < MANY / 2; c++) pair_j[c] = 2 * c, pair_i[c] = 2 * c + 1;
            ck_assert_int_eq(find(MANY / 2), NLC_OK); /* exchanged */
            for (int c = 0; c < MANY / 2; c++) {
                nlc_assert_same(overlap[c], first[c]);
                for (int x = 0; x < 3; x++) nlc_assert_same(normal[c][x] + 0.0, -first_normal[c][x] + 0.0);
            }
        }
    if (verbose()) printf("pairs: overlap %.2f ulp, normal %.2f ulp\n", worst_overlap, worst_normal);
    ck_assert_double_le(worst_overlap, 2.5);
    ck_assert_double_le(worst_normal, 1.5);
}
END_TEST

/* Units are powers of two: every bit of the mantissas stays. */
START_TEST(pairs_in_other_units)
{
    double first[MANY], first_normal[MANY][3];
    for (int e = -960; e <= 1000; e += 245) {
        rng g = {5};
        scatter(&g, 0);
        look_at_structs();
        ck_assert_int_eq(find(MANY / 2), NLC_OK);
        memcpy(first, overlap, sizeof first);
        memcpy(first_normal, normal, sizeof normal);
        g.state = 5;
        scatter(&g, e);
        ck_assert_int_eq(find(MANY / 2), NLC_OK);
        for (int c = 0; c < MANY / 2; c++) {
            nlc_assert_same(overlap[c], ldexp(first[c], e));
            for (int x = 0; x < 3; x++) nlc_assert_same(normal[c][x], first_normal[c][x]);
        }
    }
}
END_TEST

/* Against the nearest of all images, by long double.  Where the pair is too far apart for that to be promised: only gaps. */
static void compare_images(const double cell[3][3], long double width, double tolerance)
{
    for (int c = 0; c < MANY / 2; c++) {
        const grain *a = &p.grains[2 * c], *b = &p.grains[2 * c + 1];
        long double nearest = INFINITY, best[3] = {0};
        for (int64_t image = 0; image < 9261; image++) {
            const long double m[3] = {(long double)(image % 21) - 10, (long double)(image / 21 % 21) - 10,
                                      (long double)(image / 441) - 10};
            long double d[3], square = 0;
            for (int x = 0; x < 3; x++) {
                d[x] = (long double)b->x[x] - a->x[x];
                for (int k = 0; k < 3; k++) d[x] += m[k] * cell[k][x];
                square += d[x] * d[x];
            }
            if (square >= nearest) continue;
            nearest = square;
            memcpy(best, d, sizeof d);
        }
        const long double length = sqrtl(nearest), radii = (long double)a->radius + b->radius;
        if (length >= width / 2) {
            ck_assert_double_lt(overlap[c], 0);
            continue;
        }
        nlc_assert_abs(overlap[c], (double)(radii - length), tolerance);
        for (int x = 0; x < 3; x++) nlc_assert_abs(normal[c][x], (double)(best[x] / length), 4e-16);
    }
}

/* Least width between opposite faces, by areas. */
static long double least_width(const double cell[3][3])
{
    long double least = INFINITY, volume = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = cell[(k + 1) % 3], *b = cell[(k + 2) % 3];
        long double n[3], square = 0;
        for (int x = 0; x < 3; x++)
            n[x] = (long double)a[(x + 1) % 3] * b[(x + 2) % 3] - (long double)a[(x + 2) % 3] * b[(x + 1) % 3];
        for (int x = 0; x < 3; x++) square += n[x] * n[x];
        volume = fabsl(n[0] * cell[k][0] + n[1] * cell[k][1] + n[2] * cell[k][2]);
        if (square > 0 && volume > 0) least = fminl(least, volume / sqrtl(square));
    }
    return least;
}

/*
 * Positions in the cell or up to two cells outside; half of the pairs made to touch.  What is compared is the image nearest for
 * the positions as rounded, so errors are those of a few operations on numbers of the size of a diameter: 8 and 4e-16.
 */
START_TEST(pairs_in_periodic_cells)
{
    static const double cells[][3][3] = {{{10, 0, 0}, {0, 12, 0}, {0, 0, 9}},
                                         {{10, 0, 0}, {5, 12, 0}, {-3, 4, 9}},
                                         {{10, 1, -2}, {3, 11, 0.5}, {-8, 9, 14}},
                                         {{0, 0, -11}, {9, 0, 1}, {-4, -12, 2}}};
    for (int k = 0; k < 4; k++) {
        rng g = {(uint64_t)k + 1};
        scatter(&g, 0);
        for (int c = 0; c < MANY; c += 2) {
            double place[3] = {0, 0, 0}, direction[3];
            rng_unit(&g, direction);
            for (int v = 0; v < 3; v++)
                for (int x = 0; x < 3; x++) place[x] += rng_uniform(&g, -0.2, 1.2) * cells[k][v][x];
            for (int e = 0; e < 2; e++) p.grains[c + e].radius = rng_uniform(&g, 0.3, 1.4);
            const double d = (p.grains[c].radius + p.grains[c + 1].radius) * rng_uniform(&g, 0.7, c % 4 ? 1.2 : 6);
            const int image[3] = {(int)rng_below(&g, 5) - 2, (int)rng_below(&g, 5) - 2, (int)rng_below(&g, 5) - 2};
            for (int x = 0; x < 3; x++) {
                p.grains[c].x[x] = place[x];
                p.grains[c + 1].x[x] = place[x] + d * direction[x];
                for (int v = 0; v < 3; v++) p.grains[c + 1].x[x] += image[v] * cells[k][v][x];
            }
        }
        look_at_structs();
        p.positions.cell = cells[k][0];
        ck_assert_int_eq(find(MANY / 2), NLC_OK);
        compare_images(cells[k], least_width(cells[k]), 8e-16 * 3);
    }
}
END_TEST

/* Periodic along two vectors or one: nothing is wrapped across them, and the others need not be square to it. */
START_TEST(pairs_in_slabs_and_tubes)
{
    const double slab[3][3] = {{10, 0, 0}, {4, 9, 0}, {0, 0, 0}}, tube[3][3] = {{0}, {3, 4, 12}, {0}};
    rng g = {3};
    scatter(&g, 0);
    p.grains[0] = (grain){.x = {1, 1, 500}, .radius = 1};
    p.grains[1] = (grain){.x = {1 + 10 - 4 + 1.2, 1 - 9, 500.9}, .radius = 1}; /* a - b and (1.2, 0, 0.9) */
    p.grains[2] = (grain){.x = {0, 0, 0}, .radius = 1};
    p.grains[3] = (grain){.x = {-6, -8, -24 + 1.5}, .radius = 1}; /* -2 c and (0, 0, 1.5) */
    look_at_structs();
    p.positions.cell = slab[0];
    ck_assert_int_eq(find(1), NLC_OK);
    nlc_assert_abs(overlap[0], 0.5, 1e-12);
    nlc_assert_abs(normal[0][0], 0.8, 1e-12);
    nlc_assert_abs(normal[0][2], 0.6, 1e-12);
    p.grains[1].x[2] = 700;
    ck_assert_int_eq(find(1), NLC_OK);
    ck_assert_double_lt(overlap[0], -197);
    p.positions.cell = tube[0];
    pair_i[0] = 2;
    pair_j[0] = 3;
    ck_assert_int_eq(find(1), NLC_OK);
    nlc_assert_abs(overlap[0], 0.5, 1e-12);
    nlc_assert_abs(normal[0][2], 1, 1e-12);
}
END_TEST

/* Exact by construction: a plane through far-away points, a particle in front of it, on it, behind it. */
START_TEST(pairs_with_walls)
{
    const double point[2][3] = {{100, -50, 1}, {3, 0, 0}}, unit[2][3] = {{0, 0, 1}, {-0.6, 0.8, 0}};
    const double height[4] = {1.75, 1, 0.5, 1}, expected[4] = {0.25, 1, 1.5, 1};
    for (int e = -1000; e <= 1000; e += 250) {
        double points[2][3];
        for (int w = 0; w < 2; w++)
            for (int x = 0; x < 3; x++) points[w][x] = ldexp(point[w][x], e);
        look_at_structs();
        p.positions.wall_point = points[0];
        p.positions.wall_normal = unit[0];
        p.particles.wall_count = 2;
        for (int k = 0; k < 4; k++) {
            p.grains[k] = (grain){.x = {0, 0, ldexp(height[k], e)}, .radius = ldexp(1, e)};
            pair_i[k] = k % 2 ? k : MANY;
            pair_j[k] = k % 2 ? MANY : k;
        }
        pair_i[4] = 3;
        pair_j[4] = MANY + 1; /* (x - p).m = 1.8 */
        ck_assert_int_eq(find(5), NLC_OK);
        for (int k = 0; k < 4; k++) {
            nlc_assert_same(overlap[k], ldexp(expected[k], e));
            nlc_assert_same(normal[k][2], k % 2 ? -1 : 1);
        }
        nlc_assert_rel(overlap[4], ldexp(-0.8, e), 4e-16);
        nlc_assert_rel(normal[4][0], 0.6, 2e-16);
        nlc_assert_rel(normal[4][1], -0.8, 2e-16);
    }
}
END_TEST

/* Slanted walls whose normals are as far from unit length as they may be, against long double. */
START_TEST(pairs_with_slanted_walls)
{
    double worst_overlap = 0, worst_normal = 0;
    rng g = {23};
    if (!long_double_is_wider()) return;
    for (int round = 0; round < 20000; round++) {
        const int e = (int)rng_below(&g, 1900) - 950;
        double point[3], unit[3], x[3];
        long double dot = 0, square = 0, away = 0;
        rng_unit(&g, unit);
        for (int k = 0; k < 3; k++) {
            unit[k] *= 1 + 4e-7 * (round % 3 - 1);
            x[k] = ldexp(rng_uniform(&g, -3, 3), e);
            point[k] = ldexp(rng_uniform(&g, -3, 3), e);
            const long double d = (long double)x[k] - point[k];
            dot += d * unit[k];
            square += (long double)unit[k] * unit[k];
            away += d * d;
        }
        p.grains[0] = (grain){.x = {x[0], x[1], x[2]}, .radius = ldexp(rng_uniform(&g, 0.1, 3), e)};
        look_at_structs();
        p.particles.wall_count = 1;
        p.positions.wall_point = point;
        p.positions.wall_normal = unit;
        pair_i[0] = 0;
        pair_j[0] = MANY;
        ck_assert_int_eq(find(1), NLC_OK);
        const long double R = p.grains[0].radius;
        worst_overlap = fmax(worst_overlap, ulp_error(overlap[0], R - dot / sqrtl(square), fmaxl(R, sqrtl(away))));
        for (int k = 0; k < 3; k++) worst_normal = fmax(worst_normal, ulp_error(normal[0][k], -unit[k] / sqrtl(square), 1));
    }
    if (verbose()) printf("walls: overlap %.2f ulp, normal %.2f ulp\n", worst_overlap, worst_normal);
    ck_assert_double_le(worst_overlap, 3.5); /* a dot product of three terms, and a root */
    ck_assert_double_le(worst_normal, 1.5);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------- lists -- */

/* Half lists of all pairs with bits set that are no index, in another order; the pairs found are those of a plain search. */
START_TEST(pairs_from_lists)
{
    enum { N = 60, REAL = 40 };
    static int32_t row[N][N], *first[N], length[N], order[REAL];
    const double wall_point[3] = {0, 0, -3}, wall_normal[3] = {0, 0, 1}, reach = 0.25;
    rng g = {8};
    int64_t count = -7, expected = 0;
    for (int k = 0; k < N; k++) {
        p.grains[k].radius = rng_uniform(&g, 0.4, 0.8);
        for (int x = 0; x < 3; x++) p.grains[k].x[x] = rng_uniform(&g, -2.5, 2.5);
    }
    look_at_structs();
    p.particles.count = N;
    p.particles.wall_count = 1;
    p.positions.wall_point = wall_point;
    p.positions.wall_normal = wall_normal;
    for (int k = 0; k < REAL; k++) {
        order[k] = (k * 7 + 3) % REAL;
        first[k] = row[k];
        length[k] = 0;
        for (int j = N - 1; j > k; j--)
            row[k][length[k]++] = (int32_t)((uint32_t)j | (j % 3 ? 0 : 0x40000000u) | (j % 2 ? 0 : 0x80000000u));
    }
    nlc_lists lists = {.struct_size = sizeof lists,
                       .count = REAL,
                       .particle = order,
                       .particle_count = REAL,
                       .length = length,
                       .neighbour = first,
                       .mask = 0x1FFFFFFF};
    static int32_t i[N * N], j[N * N], plain_i[N * N], plain_j[N * N];
    for (int m = 0; m < REAL; m++) {
        const grain *a = &p.grains[order[m]];
        for (int b = N - 1; b >= order[m]; b--) {
            double gap = a->x[2] - wall_point[2] - a->radius; /* b = the particle itself: the wall */
            if (b > order[m]) {
                const double *x = p.grains[b].x;
                gap = sqrt((x[0] - a->x[0]) * (x[0] - a->x[0]) + (x[1] - a->x[1]) * (x[1] - a->x[1]) +
                           (x[2] - a->x[2]) * (x[2] - a->x[2])) -
                      a->radius - p.grains[b].radius;
            }
            if (gap >= reach) continue;
            plain_i[expected] = order[m];
            plain_j[expected++] = b > order[m] ? b : N;
        }
    }
    ck_assert_int_gt(expected, 50);
    ck_assert_int_eq(nlc_contacts_from_lists(&count, 0, 0, 0, &p.particles, &p.positions, &lists, reach, 0), NLC_OK);
    ck_assert_int_eq(count, expected);
    i[count] = j[count] = 12345;
    nlc_assert_quiet(
        ck_assert_int_eq(nlc_contacts_from_lists(&count, i, j, count, &p.particles, &p.positions, &lists, reach, 0), NLC_OK));
    ck_assert_int_eq(count, expected);
    ck_assert_mem_eq(i, plain_i, (size_t)count * sizeof *i);
    ck_assert_mem_eq(j, plain_j, (size_t)count * sizeof *j);
    ck_assert_int_eq(i[count], 12345);
    ck_assert_int_eq(j[count], 12345);
    for (int64_t c = 0; c < count; c++) pair_i[c] = i[c], pair_j[c] = j[c];
    ck_assert_int_eq(find(count), NLC_OK);
    for (int64_t c = 0; c < count; c++) ck_assert_double_gt(overlap[c], -reach);
    lists.mask = 0; /* now the other bits count */
    ck_assert_int_eq(nlc_contacts_from_lists(&count, 0, 0, 0, &p.particles, &p.positions, &lists, reach, 0), NLC_ERROR_INDEX);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------- reach -- */

/* A ball between two plates: only the opposite force moves a contact, so the bound of Case I is met exactly ([GC] 11). */
START_TEST(reach_is_met_by_opposite_contacts)
{
    for (int m = 0; m <= 10; m++) {
        const double nu = 0.05 * m, E = 3e6, R = 0.02;
        scene s;
        double reach, b = 0;
        scene_init(&s);
        const int32_t soft = scene_material(&s, E, nu), rigid = scene_material(&s, INFINITY, 0);
        scene_particle(&s, R, soft);
        scene_wall(&s, rigid);
        scene_wall(&s, rigid);
        scene_contact(&s, 0, 1, 1e-4, 0, 0, 1);
        scene_contact(&s, 0, 2, -1e-3, 0, 0, -1); /* open */
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        s.force[0] = 5;
        double w[4];
        ck_assert_int_eq(nlc_sweep(s.network, w, s.force, s.overlap, s.normal, 0), NLC_OK);
        nlc_assert_quiet(ck_assert_int_eq(nlc_reach(s.network, &reach, &b, s.force, 0), NLC_OK));
        nlc_assert_rel(b, (1 + nu) * (3 - 2 * nu) * 5 / (4 * 3.14159265358979323846 * R * E), 1e-15);
        nlc_assert_rel(b, w[2], 4e-15); /* 3 - 2 nu is the small difference of larger numbers in the sweep: 4 of them */
        nlc_assert_same(reach, 2 * b);
        s.force[0] = s.force[1] = 1.7e308; /* the sum is beyond double, the displacement is not */
        nlc_assert_quiet(ck_assert_int_eq(nlc_reach(s.network, &reach, &b, s.force, 0), NLC_OK));
        nlc_assert_rel(b, 2 * (1.7e308 * ((1 + nu) * (3 - 2 * nu) / (4 * 3.14159265358979323846 * R * E))), 2e-15);
        scene_free(&s);
    }
}
END_TEST

static const int32_t all_models[] = {NLC_MODEL_GONZALEZ_CUITINO, NLC_MODEL_HERTZ,      NLC_MODEL_HALF_SPACE, NLC_MODEL_LOVE,
                                     NLC_MODEL_SPHERE,           NLC_MODEL_POINT_FORCE};

/* Random clusters with many open contacts all around: no displacement of an open contact exceeds the sum of its bounds. */
START_TEST(reach_bounds_open_contacts)
{
    double tightest = 0;
    for (int seed = 0; seed < 12; seed++)
        for (int open = 1; open <= 3; open++) {
            scene s;
            rng g = {(uint64_t)(seed + 1)};
            scene_init(&s);
            s.options.model = all_models[_i];
            s.options.tolerance = 1e-12;
            s.options.points = seed % 2 ? NLC_POINTS_UNDEFORMED : NLC_POINTS_DEFORMED;
            s.options.prefactor = 1 + 0.1 * seed;
            scene_cluster(&s, &g, 14, 0.4);
            for (int64_t c = 0; c < s.contacts; c++) /* as gaps, half of them: far too wide to close */
                if (c % (open + 1)) s.overlap[c] = -1e3;
            ck_assert_int_ge(scene_solve(&s, 0), 0);
            double reach, *b = calloc((size_t)s.particles, sizeof *b);
            ck_assert_int_eq(nlc_reach(s.network, &reach, b, s.force, 0), NLC_OK);
            for (int64_t c = 0; c < s.contacts; c++) {
                const double most = (s.i[c] < s.particles ? b[s.i[c]] : 0) + (s.j[c] < s.particles ? b[s.j[c]] : 0);
                ck_assert_double_le(most, reach);
                if (s.force[c] > 0) continue;
                ck_assert_double_le(s.nonlocal[c], most * (1 + 1e-10) + 1e-18); /* tolerance; rounding, of 1e-3 m */
                if (most > 0) tightest = fmax(tightest, s.nonlocal[c] / most);
            }
            free(b);
            scene_free(&s);
        }
    if (verbose()) printf("reach, model %d: an open contact moved %.2f of the bound\n", (int)all_models[_i], tightest);
    if (all_models[_i] != NLC_MODEL_HERTZ) ck_assert_double_gt(tightest, 0.02); /* the test sees something */
}
END_TEST

/* The exact sphere, all circles and tilts that can be: the constants of the bound against S and D. */
START_TEST(reach_of_the_sphere)
{
    double closest = 0;
    for (int m = 0; m <= 20; m++) {
        const double nu = 0.025 * m, most = 0.76 + 1.4 * nu - 0.9 * nu * nu;
        for (int k = 1; k <= 360; k++) {
            const double theta = 3.14159265358979 * k / 360, S = nlc_sphere_green(theta, nu);
            const double D = nlc_sphere_finite_size(theta, nu, 1), T = D - nlc_sphere_finite_size(theta, nu, 0);
            closest = fmax(closest, -S / most);
            for (int r = -30; r <= 30; r++) { /* ratio of radii: no circle is larger than the smaller particle */
                const double ratio = pow(10, 0.1 * r), t2 = fmin(1, 1 / (ratio * ratio));
                for (int chi = 0; chi <= 4; chi++) {
                    const double tilt = (1 + ratio) * chi / 4 - 1;
                    for (int size = 0; size <= 4; size++) ck_assert_double_le(-S - t2 * size / 40 * (D + tilt * T), most);
                }
            }
        }
    }
    ck_assert_double_gt(closest, 0.985);
}
END_TEST

/* What the promise says: a list without the pairs that cannot close gives the same forces as one with all of them. */
START_TEST(reach_is_enough)
{
    scene all, less;
    scene_init(&all);
    all.options.model = all_models[_i];
    all.options.tolerance = 1e-12;
    scene_packing(&all, "b_die125_rd0.70.csv", 1.0);
    ck_assert_int_eq(scene_solve(&all, 0) & ~NLC_WARNING_CLOSE, NLC_OK); /* some candidates stand side by side */
    double reach, *b = calloc((size_t)all.particles, sizeof *b);
    ck_assert_int_eq(nlc_reach(all.network, &reach, b, all.force, 0), NLC_OK);
    scene_init(&less);
    less.options = all.options;
    scene_packing(&less, "b_die125_rd0.70.csv", 0);
    less.contacts = 0;
    int64_t *from = calloc((size_t)all.contacts, sizeof *from), open = 0;
    for (int64_t c = 0; c < all.contacts; c++) {
        const double most = (all.i[c] < all.particles ? b[all.i[c]] : 0) + (all.j[c] < all.particles ? b[all.j[c]] : 0);
        if (-all.overlap[c] >= most && -all.overlap[c] >= 0) {
            ck_assert_double_eq(all.force[c], 0);
            continue;
        }
        open += all.overlap[c] < 0;
        from[less.contacts] = c;
        scene_contact(&less, all.i[c], all.j[c], all.overlap[c], all.normal[3 * c], all.normal[3 * c + 1],
                      all.normal[3 * c + 2]);
    }
    if (verbose())
        printf("reach, model %d: %.3g, %d of %d pairs needed, %d of them gaps\n", (int)all_models[_i], reach,
               (int)less.contacts, (int)all.contacts, (int)open);
    ck_assert_int_lt(less.contacts, all.contacts);
    ck_assert_int_eq(scene_solve(&less, 0) & ~NLC_WARNING_CLOSE, NLC_OK);
    for (int64_t c = 0; c < less.contacts; c++)
        nlc_assert_abs(less.force[c], all.force[from[c]], 1e-10 * (1 + all.force[from[c]]));
    free(from);
    free(b);
    scene_free(&less);
    scene_free(&all);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------- carry -- */

/* Against the plain way: for every new contact in order the first old one of its key that is not taken yet. */
static void compare_carried(int64_t n, int64_t m, uint64_t keys, uint64_t seed)
{
    static double now[MANY], before[MANY], expected[MANY];
    static uint64_t key[MANY], old_key[MANY], memory[4 * MANY * 2];
    bool taken[MANY] = {false};
    rng g = {seed};
    int64_t missing = 0;
    for (int64_t c = 0; c < m; c++) {
        old_key[c] = rng_below(&g, keys) * UINT64_C(0x9e3779b97f4a7c15) + (seed % 2 ? UINT64_MAX : 0);
        before[c] = rng_uniform(&g, -1, 1);
    }
    for (int64_t c = 0; c < n; c++) {
        key[c] = rng_below(&g, keys) * UINT64_C(0x9e3779b97f4a7c15) + (seed % 2 ? UINT64_MAX : 0);
        int64_t b = 0;
        while (b < m && (taken[b] || old_key[b] != key[c])) b++;
        expected[c] = b < m ? before[b] : 0;
        missing += b == m;
        if (b < m) taken[b] = true;
        now[c] = 77;
    }
    nlc_info info = {.struct_size = sizeof info};
    const size_t size = nlc_carry_size(n, m);
    ck_assert_uint_le(size, sizeof memory - 8);
    memset(memory, 0xa5, sizeof memory);
    nlc_assert_quiet(ck_assert_int_eq(nlc_carry(now, key, n, before, old_key, m, memory, size, &info), NLC_OK));
    for (int64_t c = 0; c < n; c++) nlc_assert_same(now[c], expected[c]);
    ck_assert_int_eq(info.left_out, missing);
    for (size_t k = size / 8; k < sizeof memory / 8; k++) ck_assert(memory[k] == UINT64_C(0xa5a5a5a5a5a5a5a5));
}

/* Centres closer than 1e-9 of the radii are rounding, at any scale. */
START_TEST(same_place_at_any_scale)
{
    static const nlc_material material = {1e9, 0.3};
    const int32_t i = 0, j = 1;
    const double scale[] = {1e-300, 1e-200, 1, 1e200, 1e300};
    for (int k = 0; k < 5; k++) {
        const double radius[2] = {scale[k], scale[k]}, zero[2] = {0};
        double x[2] = {0, 1e-9 * scale[k]}, depth = 77, n[3] = {77};
        const nlc_particles two = {.struct_size = sizeof two, .count = 2, .radius = radius, .materials = &material, .material_count = 1};
        const nlc_positions at = {.struct_size = sizeof at, .x = x, .y = zero, .z = zero};
        nlc_info info = {.struct_size = sizeof info};
        nlc_assert_quiet(ck_assert_int_eq(nlc_contacts_from_pairs(&depth, n, &two, &at, &i, &j, 1, &info), NLC_ERROR_SAME_PLACE));
        ck_assert(info.culprit == 0 && depth == 77 && n[0] == 77);
        x[1] = 1e-8 * scale[k];
        nlc_assert_quiet(ck_assert_int_eq(nlc_contacts_from_pairs(&depth, n, &two, &at, &i, &j, 1, &info), NLC_OK));
        nlc_assert_rel(depth, 2 * scale[k], 1e-7);
        ck_assert(n[0] == 1);
    }
}
END_TEST

START_TEST(predicted_from_two_steps)
{
    double nonlocal[3] = {1, 2, -4}, previous[3] = {0.5, 2, -3};
    nlc_assert_quiet(ck_assert_int_eq(nlc_predict(nonlocal, previous, 3, 0.5, 0), NLC_OK));
    ck_assert(nonlocal[0] == 1.25 && nonlocal[1] == 2 && nonlocal[2] == -4.5);
    ck_assert(previous[0] == 1 && previous[1] == 2 && previous[2] == -4);
}
END_TEST

START_TEST(carried_by_key)
{
    for (uint64_t seed = 1; seed <= 400; seed++) {
        rng g = {seed};
        compare_carried((int64_t)rng_below(&g, MANY), (int64_t)rng_below(&g, MANY), 1 + rng_below(&g, seed % 3 ? 1000 : 20),
                        seed);
    }
    compare_carried(0, 0, 1, 1);
    compare_carried(0, 9, 5, 1);
    compare_carried(9, 0, 5, 1);
    compare_carried(MANY, MANY, 1, 2);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------ update -- */

/* Builds t anew, and solves both from zeros: the same bits. */
static void compare_as_new(scene *s, scene *t)
{
    nlc_info a = {.struct_size = sizeof a}, b = a;
    free(t->memory);
    t->memory = 0;
    ck_assert_int_eq(scene_build(t), NLC_OK);
    memset(s->nonlocal, 0, (size_t)s->contacts * sizeof *s->nonlocal);
    ck_assert_int_eq(scene_solve(s, &a), scene_solve(t, &b));
    for (int64_t c = 0; c < s->contacts; c++) nlc_assert_same(s->force[c], t->force[c]);
    for (int64_t c = 0; c < s->contacts; c++) nlc_assert_same(s->nonlocal[c], t->nonlocal[c]);
    ck_assert_mem_eq(&a, &b, sizeof a);
}

static nlc_status update(scene *s, const double *stiffness)
{
    const nlc_particles view = scene_view(s);
    nlc_status status;
    nlc_assert_quiet(status = nlc_network_update(s->network, &view, stiffness, 0));
    return status;
}

/* Swollen, softened grains: as from a network that is new.  In the last round with stiffnesses of the host. */
START_TEST(updated_network_is_as_new)
{
    scene s, t;
    scene_init(&s);
    scene_init(&t);
    s.options.model = t.options.model = all_models[_i];
    scene_packing(&s, "b_die125_rd0.80.csv", 0.3);
    scene_packing(&t, "b_die125_rd0.80.csv", 0.3);
    ck_assert_int_ge(scene_solve(&s, 0), 0);
    double *stiffness = calloc((size_t)s.contacts, sizeof *stiffness);
    for (int64_t c = 0; c < s.contacts; c++) stiffness[c] = 1e8 * (1 + 0.1 * (double)(c % 11));
    for (int round = 0; round < 3; round++) {
        for (int64_t k = 0; k < s.particles; k++) s.radius[k] = t.radius[k] *= 1 + 0.01 * (double)(k % 7);
        s.rows[0].young = t.rows[0].young *= 0.9;
        s.rows[1].poisson = t.rows[1].poisson = 0.1 * round;
        t.options.stiffness = round == 2 ? stiffness : 0;
        ck_assert_int_eq(update(&s, t.options.stiffness), NLC_OK);
        compare_as_new(&s, &t);
    }
    free(stiffness);
    scene_free(&s);
    scene_free(&t);
}
END_TEST

/* A row of grains falls into two parts when the one in the middle becomes rigid, and becomes one again. */
START_TEST(update_finds_clusters_anew)
{
    scene s, t;
    scene *both[2] = {&s, &t};
    for (int k = 0; k < 2; k++) {
        scene *q = both[k];
        scene_init(q);
        const int32_t soft = scene_material(q, 1e6, 0.4), other = scene_material(q, 1e6, 0.4);
        for (int m = 0; m < 5; m++) scene_particle(q, 0.01, m == 2 ? other : soft);
        for (int m = 0; m < 4; m++) scene_contact(q, m, m + 1, 2e-4 + 1e-5 * m, 1, 0.1 * m, 0);
    }
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    for (int round = 0; round < 3; round++) {
        s.rows[1].young = t.rows[1].young = round == 1 ? INFINITY : 1e6;
        ck_assert_int_eq(update(&s, 0), NLC_OK);
        compare_as_new(&s, &t);
        nlc_info info;
        ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
        ck_assert_int_eq(info.clusters, round == 1 ? 2 : 1);
    }
    scene_free(&s);
    scene_free(&t);
}
END_TEST

/*
 * Two grains beside each other become large, so that their circles on a third one come to overlap, which those of the overlaps alone do
 * not show: a larger one is between equal grains, where it makes a smaller circle.
 */
START_TEST(update_finds_circles_anew)
{
    scene s;
    nlc_info info;
    scene_init(&s);
    s.options.model = NLC_MODEL_HALF_SPACE;
    s.options.points = NLC_POINTS_UNDEFORMED;
    s.options.prefactor = 1e-9; /* overlaps are as they are given */
    const int32_t m = scene_material(&s, 1e6, 0.4);
    for (int k = 0; k < 4; k++) scene_particle(&s, 1, m);
    scene_contact(&s, 0, 3, 0.01, -1, 0, 0);
    scene_contact(&s, 0, 1, 0.009, 1, 0.08, 0);
    scene_contact(&s, 0, 2, 0.009, 1, -0.08, 0);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
    s.radius[1] = s.radius[2] = 10;
    ck_assert_int_eq(update(&s, 0), NLC_OK);
    ck_assert_int_eq(scene_solve(&s, &info), NLC_WARNING_CLOSE);
    scene_free(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("hosts");
    TCase *t = tcase_create("hosts");
    time_limit(t, 120);
    tcase_add_test(t, pairs_at_any_scale);
    tcase_add_test(t, pairs_in_other_units);
    tcase_add_test(t, pairs_in_periodic_cells);
    tcase_add_test(t, pairs_in_slabs_and_tubes);
    tcase_add_test(t, pairs_with_walls);
    tcase_add_test(t, pairs_with_slanted_walls);
    tcase_add_test(t, pairs_from_lists);
    tcase_add_test(t, reach_is_met_by_opposite_contacts);
    tcase_add_loop_test(t, reach_bounds_open_contacts, 0, 6);
    tcase_add_test(t, reach_of_the_sphere);
    tcase_add_loop_test(t, reach_is_enough, 0, 6);
    tcase_add_test(t, same_place_at_any_scale);
    tcase_add_test(t, predicted_from_two_steps);
    tcase_add_test(t, carried_by_key);
    tcase_add_loop_test(t, updated_network_is_as_new, 0, 6);
    tcase_add_test(t, update_finds_clusters_anew);
    tcase_add_test(t, update_finds_circles_anew);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
