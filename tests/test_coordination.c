/* SPDX-License-Identifier: BSD-2-Clause */
/* test_coordination.c - particles with very many contacts: the sums over all pairs, without looking at all of them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/crowd.h"
#include "../lib/tree.h"
#include "scene.h"

static const long double pi = 3.141592653589793238462643383279502884L;

/* ---- scenes: one large sphere with small ones on it, each of which has no other contact */

typedef enum kind {
    EVEN,   /* everywhere, at equal distances but for some noise */
    POLE,   /* denser and denser towards a pole */
    CAP,    /* all in one place */
    RING,   /* on the equator, exactly */
    CASCADE /* at distances from a pole that halve and halve again, to 2^-45 */
} kind;
static const char *const kinds[] = {"even", "pole", "cap", "ring", "cascade"};
enum { KINDS = 5 };

static void direction(double v[3], kind type, int c, int count, rng *g)
{
    const double z = 1 - 2 * (c + 0.5) / count, turn = c * 3.14159265358979 * (3 - sqrt(5)), r = sqrt(1 - z * z);
    double t = 0;
    if (type == EVEN) {
        v[0] = r * cos(turn), v[1] = r * sin(turn), v[2] = z;
        for (int x = 0; x < 3; x++) v[x] += rng_uniform(g, -0.8, 0.8) / sqrt(count);
        return;
    }
    if (type == RING) {
        const double at = 6.28318530717959 * (c + rng_uniform(g, -0.4, 0.4)) / count;
        v[0] = 0, v[1] = cos(at), v[2] = sin(at); /* in one plane to the last bit */
        return;
    }
    if (type == POLE) t = 3.1 * pow(rng_uniform(g, 0, 1), 2);
    if (type == CAP) t = 0.3 * sqrt(rng_uniform(g, 0, 1));
    if (type == CASCADE) t = pow(2, -45 * rng_uniform(g, 0, 1));
    const double at = rng_uniform(g, 0, 6.28318530717959);
    v[0] = sin(t) * cos(at), v[1] = sin(t) * sin(at), v[2] = cos(t);
}

static void planet(scene *s, kind type, int count, double tolerance, rng *g)
{
    scene_init(s);
    const int32_t soft = scene_material(s, 1e9, 0.3), hard = scene_material(s, 4e9, 0.45);
    const double radius = 1.2 / sqrt(count); /* of the small ones */
    double v[3];
    const int32_t centre = scene_particle(s, 1, soft);
    for (int c = 0; c < count; c++) {
        const int32_t other = scene_particle(s, radius, c % 3 ? hard : soft);
        const double sign = rng_sign(g);
        direction(v, type, c, count, g);
        scene_contact(s, sign > 0 ? centre : other, sign > 0 ? other : centre, radius * rng_uniform(g, -1e-3, 1e-2), //
                      sign * v[0], sign * v[1], sign * v[2]);
    }
    s->options.tolerance = tolerance;
}

/* Outward on the large one. */
static long double outward(const scene *s, int64_t c, int x)
{
    return (s->i[c] == 0 ? 1 : -1) * (long double)s->normal[3 * c + x];
}

static int64_t side_of(const scene *s, int64_t c)
{
    return 2 * c + (s->i[c] == 0 ? 0 : 1);
}

static double *random_forces(const scene *s, rng *g)
{
    double *force = malloc((size_t)s->contacts * sizeof *force);
    ck_assert_ptr_nonnull(force);
    for (int64_t c = 0; c < s->contacts; c++) force[c] = rng_below(g, 8) ? rng_uniform(g, -0.3, 1) * 1e4 : 0;
    return force;
}

/* All displacements, as nlc_sweep gives them; to be freed. */
static double *swept(scene *s, const double *force)
{
    double *w = malloc(2 * (size_t)s->contacts * sizeof *w);
    if (!s->network) ck_assert_int_eq(scene_build(s), NLC_OK);
    nlc_assert_quiet(ck_assert_int_eq(nlc_sweep(s->network, w, force, s->overlap, s->normal, 0), NLC_OK));
    return w;
}

/* Without grids, whatever the tolerance is. */
static double *all_pairs(scene *s, const double *force)
{
    nlc_options o = s->options;
    o.tolerance = 1e-15;
    ck_assert_int_eq(nlc_set_options(s->network, &o, 0), NLC_OK);
    double *w = swept(s, force);
    ck_assert_int_eq(nlc_set_options(s->network, &s->options, 0), NLC_OK);
    return w;
}

/* [GC] 5 at contact c of the large sphere by all forces on it, in long double, and the sum of its absolute terms. */
static long double exact_at(const scene *s, const double *force, int64_t c, long double *size)
{
    const long double nu = s->rows[0].poisson, U = (1 + nu) / (4 * pi * s->rows[0].young);
    const long double c0 = -4 * (1 - nu), c1 = -2 * (1 - 2 * nu), c2 = (7 - 8 * nu) / 2;
    long double sum = 0;
    *size = 0;
    for (int64_t d = 0; d < s->contacts; d++) {
        long double t = 0;
        if (d == c) continue;
        for (int x = 0; x < 3; x++) {
            const long double v = outward(s, c, x) - outward(s, d, x);
            t += v * v;
        }
        const long double r = 1 / sqrtl(t), f = U * force[d];
        sum += (c0 * r + c1 + c2 * t * r) * f;
        *size += (fabsl(c0) * r + fabsl(c1) + c2 * t * r) * fabsl(f);
    }
    return sum;
}

/* What some of the contacts should have: every step-th. */
typedef struct sample {
    int64_t step;
    long double *exact, *size;
} sample;

static sample take_sample(const scene *s, const double *force)
{
    const int64_t step = s->contacts / 50 > 0 ? s->contacts / 50 : 1;
    sample a = {step, malloc((size_t)s->contacts * sizeof(long double)), malloc((size_t)s->contacts * sizeof(long double))};
    ck_assert(a.exact && a.size);
    for (int64_t c = 0; c < s->contacts; c += step) a.exact[c] = exact_at(s, force, c, &a.size[c]);
    return a;
}

static void free_sample(sample a)
{
    free(a.exact);
    free(a.size);
}

/* Largest error there, relative to the absolute terms. */
static double error_of(const scene *s, sample a, const double *w)
{
    double worst = 0;
    for (int64_t c = 0; c < s->contacts; c += a.step)
        worst = fmax(worst, (double)(fabsl(w[side_of(s, c)] - a.exact[c]) / a.size[c]));
    return worst;
}

/* What the header promises, and rounding. */
static double allowed(const scene *s)
{
    return 0.5 * s->options.tolerance + (double)s->contacts * 0x1p-53;
}

/* ---- displacements */

static const double tolerances[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12};
enum { TOLERANCES = sizeof tolerances / sizeof *tolerances };

START_TEST(displacements)
{
    static const int counts[] = {65, 200, 1000, 5000, 12000};
    double most = 0;
    rng g = {41};
    for (int k = 0; k < 5; k++) {
        scene s;
        planet(&s, (kind)_i, counts[k], 0, &g);
        double *force = random_forces(&s, &g);
        const sample a = take_sample(&s, force);
        for (int t = 0; t < TOLERANCES; t++) {
            s.options.tolerance = tolerances[t];
            if (s.network) ck_assert_int_eq(nlc_set_options(s.network, &s.options, 0), NLC_OK);
            double *w = swept(&s, force);
            const double error = error_of(&s, a, w);
            if (verbose() && k > 2)
                printf("%-7s Z %5d, tolerance %.0e: error %.1e of the terms, %.4f of what is allowed\n", kinds[_i],
                       counts[k], tolerances[t], error, error / allowed(&s));
            most = fmax(most, error / allowed(&s));
            free(w);
        }
        free(force), free_sample(a);
        scene_free(&s);
    }
    ck_assert(most <= 1);
    ck_assert(most > 1e-3); /* there was something to be wrong */
}
END_TEST

/* Called directly the grids serve where they would not pay, too: with few boxes, and few contacts in them. */
START_TEST(few_contacts)
{
    rng g = {42};
    double most = 0;
    for (int count = 128; count <= 2048; count *= 2) {
        scene s;
        bool distinct = false;
        planet(&s, (kind)_i, count, 0, &g);
        double *force = random_forces(&s, &g);
        const sample a = take_sample(&s, force);
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        for (int t = 0; t < TOLERANCES; t++) {
            s.options.tolerance = tolerances[t];
            ck_assert_int_eq(nlc_set_options(s.network, &s.options, 0), NLC_OK);
            nlc_set_units(s.network, 0, 0);
            nlc_assert_quiet(ck_assert(nlc_displace_crowd(s.network, NLC_OF_FORCES, force, s.normal, 0, &distinct)));
            ck_assert(distinct);
            most = fmax(most, error_of(&s, a, s.network->side) / allowed(&s));
        }
        free(force), free_sample(a);
        scene_free(&s);
    }
    if (verbose()) printf("%-7s few contacts: %.4f of what is allowed\n", kinds[_i], most);
    ck_assert(most <= 1 && most > 1e-3);
}
END_TEST

/* x C y = y C x to rounding, however coarse the grids are: the solver relies on it. */
START_TEST(symmetry)
{
    rng g = {43};
    for (int model = 0; model < 2; model++)
        for (int t = 0; t < TOLERANCES; t += 2) {
            scene s;
            planet(&s, (kind)_i, 6000, tolerances[t], &g);
            s.options.model = model == 0 ? NLC_MODEL_GONZALEZ_CUITINO : NLC_MODEL_POINT_FORCE;
            double *x = random_forces(&s, &g), *y = random_forces(&s, &g), *u = swept(&s, x), *v = swept(&s, y), size = 0;
            long double difference = 0;
            for (int64_t c = 0; c < s.contacts; c++) {
                const int64_t e = side_of(&s, c);
                difference += (long double)x[c] * v[e] - (long double)y[c] * u[e];
                size += fabs(x[c] * v[e]) + fabs(y[c] * u[e]);
            }
            if (verbose())
                printf("%-7s tolerance %.0e: unsymmetric by %.1e\n", kinds[_i], tolerances[t], (double)fabsl(difference) / size);
            ck_assert(fabsl(difference) <= 1e-13 * size); /* found: 6e-16 */
            free(x), free(y), free(u), free(v);
            scene_free(&s);
        }
}
END_TEST

/* The other models that are summed so, against their sums over all pairs, which test_models.c and test_sphere.c look at. */
START_TEST(models)
{
    static const struct {
        int32_t model, points;
        double prefactor;
    } row[] = {{NLC_MODEL_HALF_SPACE, NLC_POINTS_UNDEFORMED, 2.5}, {NLC_MODEL_POINT_FORCE, 0, 0}, {NLC_MODEL_SPHERE, 0, 0}};
    rng g = {44};
    for (int m = 0; m < 3; m++)
        for (int type = EVEN; type <= CAP; type++)
            for (int t = 0; t < 8; t += 3) {
                scene s;
                planet(&s, (kind)type, 2000, tolerances[t], &g);
                s.options.model = row[m].model, s.options.points = row[m].points, s.options.prefactor = row[m].prefactor;
                double *force = random_forces(&s, &g), *a = swept(&s, force), *b = all_pairs(&s, force), worst = 0;
                bool distinct = false;
                if (m < 2) ck_assert(nlc_displace_crowd(s.network, NLC_OF_FORCES, force, s.normal, 0, &distinct));
                for (int64_t c = 0; c < s.contacts && m < 2; c++) a[side_of(&s, c)] = s.network->side[side_of(&s, c)];
                for (int64_t c = 0; c < s.contacts; c += 50) {
                    const int64_t e = side_of(&s, c);
                    long double size;
                    exact_at(&s, force, c, &size);
                    worst = fmax(worst, fabs(a[e] - b[e]) / ((double)size * fmax(row[m].prefactor, 1)));
                }
                if (verbose())
                    printf("model %d %-7s tolerance %.0e: error %.1e\n", row[m].model, kinds[type], tolerances[t], worst);
                ck_assert(worst <= 0.5 * tolerances[t] + 3e-12); /* the sphere's own rounding, next to another contact */
                free(force), free(a), free(b);
                scene_free(&s);
            }
}
END_TEST

/* Directions that are not quite of unit length are used as given. */
START_TEST(lengths)
{
    rng g = {45};
    scene s;
    planet(&s, EVEN, 6000, 1e-8, &g);
    for (int64_t k = 0; k < 3 * s.contacts; k++) s.normal[k] *= 1 + 4e-7 * sin((double)(k / 3));
    double *force = random_forces(&s, &g), *w = swept(&s, force);
    const sample a = take_sample(&s, force);
    ck_assert(error_of(&s, a, w) <= 1e-12);
    free(force), free(w), free_sample(a);
    scene_free(&s);
}
END_TEST

/* A particle that touches its own images has two sides of each contact. */
START_TEST(own_images)
{
    rng g = {46};
    scene s;
    double v[3];
    scene_init(&s);
    const int32_t k = scene_particle(&s, 1, scene_material(&s, 1e9, 0.3));
    for (int c = 0; c < 3000; c++) {
        direction(v, EVEN, c, 3000, &g);
        scene_contact(&s, k, k, 0, v[0], v[1], v[2]);
    }
    s.options.tolerance = 1e-2;
    double *force = random_forces(&s, &g), *w = swept(&s, force);
    for (int64_t e = 0; e < 2 * s.contacts; e += 97) {
        const long double nu = 0.3L, U = (1 + nu) / (4 * pi * 1e9L);
        long double sum = 0, size = 0;
        for (int64_t f = 0; f < 2 * s.contacts; f++) {
            long double t = 0;
            for (int x = 0; x < 3; x++) {
                const long double d = (e & 1 ? -1 : 1) * (long double)s.normal[3 * (e >> 1) + x] -
                                      (f & 1 ? -1 : 1) * (long double)s.normal[3 * (f >> 1) + x];
                t += d * d;
            }
            if (e == f) continue;
            const long double h = sqrtl(t), factor = -4 * (1 - nu) / h - 2 * (1 - 2 * nu) + (7 - 8 * nu) / 2 * h, term = U * factor * force[f >> 1];
            sum += term;
            size += fabsl(term);
        }
        ck_assert(fabsl(w[e] - sum) <= 0.005L * size);
    }
    free(force), free(w);
    scene_free(&s);
}
END_TEST

/* ---- bits */

static scene copy_of(const scene *s)
{
    scene t;
    scene_init(&t);
    for (int64_t m = 0; m < s->materials; m++) scene_material(&t, s->rows[m].young, s->rows[m].poisson);
    for (int64_t k = 0; k < s->particles; k++) scene_particle(&t, s->radius[k], s->material[k]);
    for (int64_t c = 0; c < s->contacts; c++) {
        scene_contact(&t, s->i[c], s->j[c], s->overlap[c], 1, 0, 0);
        memcpy(t.normal + 3 * c, s->normal + 3 * c, 3 * sizeof(double));
    }
    t.options = s->options;
    return t;
}

/* In other units, by powers of two: overlaps by 2^-300, forces by 2^-600 2^55. */
START_TEST(units)
{
    rng g = {47};
    scene s;
    planet(&s, (kind)_i, 6000, 1e-6, &g);
    scene t = copy_of(&s);
    for (int64_t k = 0; k < t.particles; k++) t.radius[k] *= 0x1p-300;
    for (int64_t c = 0; c < t.contacts; c++) t.overlap[c] *= 0x1p-300;
    for (int64_t m = 0; m < t.materials; m++) t.rows[m].young *= 0x1p55;
    double *force = random_forces(&s, &g), *v = swept(&s, force);
    for (int64_t c = 0; c < s.contacts; c++) force[c] *= 0x1p-545;
    double *w = swept(&t, force);
    for (int64_t e = 0; e < 2 * s.contacts; e++) nlc_assert_same(w[e], v[e] * 0x1p-300);
    free(force), free(v), free(w);
    if (_i == EVEN) {
        nlc_assert_quiet(ck_assert_int_ge(scene_solve(&s, 0), NLC_OK));
        nlc_assert_quiet(ck_assert_int_ge(scene_solve(&t, 0), NLC_OK));
    }
    for (int64_t c = 0; c < s.contacts; c++) {
        nlc_assert_same(t.force[c], s.force[c] * 0x1p-545);
        nlc_assert_same(t.nonlocal[c], s.nonlocal[c] * 0x1p-300);
    }
    scene_free(&s);
    scene_free(&t);
}
END_TEST

/* Forces at which it takes a look at how close contacts come to tell that nothing overflows: the same bits. */
START_TEST(huge_forces)
{
    rng g = {55};
    scene s;
    planet(&s, (kind)_i, 300, 1e-6, &g);
    double *force = random_forces(&s, &g), *v = swept(&s, force);
    for (int64_t c = 0; c < s.contacts; c++) force[c] *= 0x1p700;
    double *w = swept(&s, force);
    for (int64_t e = 0; e < 2 * s.contacts; e++) nlc_assert_same(w[e], v[e] * 0x1p700);
    free(force), free(v), free(w);
    scene_free(&s);
}
END_TEST

/* A rigid sphere yields nowhere, however many contacts it has: on each soft one there is one force, and all are those of Hertz. */
START_TEST(rigid_centre)
{
    rng g = {56};
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    planet(&s, EVEN, 400, 1e-6, &g);
    s.rows[0].young = INFINITY;
    for (int64_t k = 1; k < s.particles; k++) s.material[k] = 1;
    s.options.model = _i;
    double *force = random_forces(&s, &g), *w = swept(&s, force);
    for (int64_t c = 0; c < s.contacts; c++) ck_assert(w[side_of(&s, c)] == 0);
    nlc_assert_quiet(ck_assert_int_ge(scene_solve(&s, &info), 0));
    if (s.options.model != NLC_MODEL_SPHERE) /* whose contacts act on themselves */
        for (int64_t c = 0; c < s.contacts; c++)
            nlc_assert_rel(s.force[c], nlc_hertz_force((double)scene_stiffness(&s, c), s.overlap[c]), 1e-14);
    free(force), free(w);
    scene_free(&s);
}
END_TEST

START_TEST(exchange_of_sides)
{
    rng g = {48};
    scene s;
    planet(&s, (kind)_i, 6000, 1e-6, &g);
    scene t = copy_of(&s);
    for (int64_t c = 0; c < t.contacts; c++) {
        if (rng_below(&g, 2)) continue;
        t.i[c] = s.j[c], t.j[c] = s.i[c];
        for (int x = 0; x < 3; x++) t.normal[3 * c + x] = -t.normal[3 * c + x];
    }
    double *force = random_forces(&s, &g), *v = swept(&s, force), *w = swept(&t, force);
    for (int64_t c = 0; c < s.contacts; c++) nlc_assert_same(w[side_of(&t, c)], v[side_of(&s, c)]);
    free(force), free(v), free(w);
    if (_i == EVEN) {
        ck_assert_int_ge(scene_solve(&s, 0), NLC_OK);
        ck_assert_int_ge(scene_solve(&t, 0), NLC_OK);
    }
    for (int64_t c = 0; c < s.contacts; c++) nlc_assert_same(t.force[c], s.force[c]);
    scene_free(&s);
    scene_free(&t);
}
END_TEST

static void backwards(void *context, void (*task)(void *work, int64_t k), void *work, int64_t count)
{
    for (int64_t k = count - 1; k >= 0; k--) task(work, k);
    *(int64_t *)context += count;
}

/* There is memory for one tree: threads may not need two.  Several such particles, in whatever order the host's loops go. */
START_TEST(loops_of_the_host)
{
    rng g = {53};
    scene s, t;
    double v[3];
    int64_t tasks = 0;
    scene_init(&s);
    const int32_t m = scene_material(&s, 1e9, 0.3);
    for (int k = 0; k < 4; k++) {
        const int32_t centre = scene_particle(&s, 1, m);
        for (int c = 0; c < 2000; c++) {
            direction(v, k % 2 ? EVEN : POLE, c, 2000, &g);
            scene_contact(&s, centre, scene_particle(&s, 0.02, m), 1e-5, v[0], v[1], v[2]);
        }
    }
    s.options.tolerance = 1e-2;
    t = copy_of(&s);
    t.options.parallel_for = backwards;
    t.options.parallel_context = &tasks;
    double *force = random_forces(&s, &g), *a = swept(&s, force), *b = swept(&t, force);
    ck_assert_int_gt(tasks, 0);
    ck_assert_int_gt(s.network->evaluations, 0);
    for (int64_t e = 0; e < 2 * s.contacts; e++) nlc_assert_same(a[e], b[e]);
    free(force), free(a), free(b);
    scene_free(&s);
    scene_free(&t);
}
END_TEST

/* ---- solutions */

/* Forces, and displacements also of contacts that stay open, as by all pairs to the tolerance and a tenth of it. */
static void compare_results(const scene *s, const scene *t, const char *when)
{
    double top = 0, farthest = 0, error = 0, off = 0;
    for (int64_t c = 0; c < s->contacts; c++) {
        top = fmax(top, t->force[c]);
        farthest = fmax(farthest, fabs(t->nonlocal[c]));
        error = fmax(error, fabs(s->force[c] - t->force[c]));
        off = fmax(off, fabs(s->nonlocal[c] - t->nonlocal[c]));
    }
    if (verbose())
        printf("model %d, Z %d, tolerance %.0e, %s: forces to %.1e, displacements to %.1e\n", s->options.model, (int)s->contacts,
               s->options.tolerance, when, error / top, off / farthest);
    ck_assert(error <= s->options.tolerance * top);
    ck_assert(off <= 2 * s->options.tolerance * farthest);
}

/* From zeros, and again when all is pressed deeper: then contacts that stayed open are left out, and looked at in the end. */
static void compare_solutions(int32_t model, int count, double tolerance, double candidates)
{
    rng g = {49};
    scene s;
    planet(&s, EVEN, count, tolerance, &g);
    s.options.model = model;
    for (int64_t c = 0; c < s.contacts; c++)
        if (rng_uniform(&g, 0, 1) < candidates) s.overlap[c] = -0.3 * s.radius[1];
    scene t = copy_of(&s);
    t.options.tolerance = 1e-13;
    nlc_info a = {.struct_size = sizeof a}, b = a;
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    ck_assert_int_eq(scene_build(&t), NLC_OK);
    t.network->room_size = t.network->part->room_size = 0; /* no trees */
    for (int step = 0; step < 2; step++) {
        nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, &a), NLC_OK));
        ck_assert_int_eq(scene_solve(&t, &b), NLC_OK);
        compare_results(&s, &t, step ? "pressed deeper" : "from zeros");
        ck_assert(step == 0 || candidates < 0.3 || a.left_out > 0);
        for (int64_t c = 0; c < s.contacts; c++) {
            if (s.overlap[c] > 0) s.overlap[c] *= 1.2;
            t.overlap[c] = s.overlap[c];
        }
    }
    ck_assert_int_gt(s.network->evaluations + s.network->part->evaluations, 0);
    ck_assert_int_eq(t.network->evaluations + t.network->part->evaluations, 0);
    scene_free(&s);
    scene_free(&t);
}

START_TEST(solutions)
{
    static const struct {
        int32_t model;
        int count;
        double tolerance, candidates;
    } row[] = {{NLC_MODEL_GONZALEZ_CUITINO, 5500, 1e-8, 0}, {NLC_MODEL_GONZALEZ_CUITINO, 5500, 1e-8, 0.6},
               {NLC_MODEL_GONZALEZ_CUITINO, 4000, 1e-4, 0}, {NLC_MODEL_GONZALEZ_CUITINO, 4000, 1e-3, 0.6},
               {NLC_MODEL_POINT_FORCE, 3000, 1e-4, 0.2},    {NLC_MODEL_SPHERE, 300, 1e-8, 0.6},
               {NLC_MODEL_SPHERE, 700, 1e-3, 0},            {NLC_MODEL_SPHERE, 700, 1e-3, 0.6}};
    compare_solutions(row[_i].model, row[_i].count, row[_i].tolerance, row[_i].candidates);
}
END_TEST

/* ---- contacts close to each other */

START_TEST(coincidences)
{
    rng g = {50};
    for (int round = 0; round < 12; round++) {
        const int count = round % 2 ? 2500 : 400;
        scene s;
        planet(&s, round % 3 ? EVEN : POLE, count, 1e-2, &g);
        s.options.model = round < 6 ? NLC_MODEL_GONZALEZ_CUITINO : NLC_MODEL_SPHERE;
        int64_t first = s.contacts;
        const bool many = round % 4 == 3; /* in one place, more than a leaf of the tree holds */
        for (int copies = 0; copies < (many ? 60 : 3); copies++) { /* the culprit is the first that has an earlier one */
            const int64_t c = 1 + (int64_t)rng_below(&g, (uint64_t)s.contacts - 1), d = many ? 0 : (int64_t)rng_below(&g, (uint64_t)c);
            const double sign = (s.i[c] == 0) == (s.i[d] == 0) ? 1 : -1;
            for (int x = 0; x < 3; x++) s.normal[3 * c + x] = sign * s.normal[3 * d + x];
        }
        for (int64_t c = s.contacts - 1; c > 0; c--)
            for (int64_t d = 0; d < c; d++) {
                bool same = true;
                for (int x = 0; x < 3; x++) same &= outward(&s, c, x) == outward(&s, d, x);
                if (same) first = c;
            }
        double *force = random_forces(&s, &g), *w = calloc(2 * (size_t)s.contacts, sizeof *w);
        nlc_info info = {.struct_size = sizeof info};
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        nlc_assert_quiet(ck_assert_int_eq(nlc_sweep(s.network, w, force, 0, s.normal, &info), NLC_ERROR_COINCIDENT));
        ck_assert_int_eq(info.culprit, first);
        nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, &info), NLC_ERROR_COINCIDENT));
        free(force), free(w);
        scene_free(&s);
    }
}
END_TEST

/* Directions at 2^-c from a pole: from c = 91 on closer to the one before than 2^-90, where two count as one, and too many to tell apart. */
START_TEST(ever_closer)
{
    enum { COUNT = 3000 }; /* so many that there is room for a box on each level */
    static double w[2 * COUNT], force[COUNT];
    rng g = {57};
    scene s;
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    const int32_t m = scene_material(&s, 1e9, 0.3);
    scene_particle(&s, 1, m);
    for (int c = 0; c < COUNT; c++) {
        double v[3] = {ldexp(1, -c), 0, 1};
        if (c >= 200) direction(v, EVEN, c, COUNT, &g);
        scene_contact(&s, 0, scene_particle(&s, 0.1, m), 1e-6, v[0], v[1], v[2]);
        force[c] = 1;
    }
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    nlc_assert_quiet(ck_assert_int_eq(nlc_sweep(s.network, w, force, 0, s.normal, &info), NLC_ERROR_COINCIDENT));
    ck_assert_int_eq(info.culprit, 91);
    scene_free(&s);
}
END_TEST

static double size_of(const nlc_network *n, int64_t contact, int64_t particle, const double *overlap)
{
    (void)n, (void)particle;
    return overlap[contact];
}

/* The closest pair, and whether circles overlap, against all pairs. */
START_TEST(closest)
{
    rng g = {51};
    int overlapping = 0, apart = 0;
    for (int round = 0; round < 30; round++) {
        const int count = 128 + (int)rng_below(&g, 700);
        scene s;
        planet(&s, (kind)_i, count, 0, &g);
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        const double largest = pow(10, rng_uniform(&g, -3, -0.5));
        for (int c = 0; c < count; c++) s.overlap[c] = round % 2 ? 0 : largest * rng_uniform(&g, 0, 1);
        double least = 4, found;
        for (int64_t c = 0; c < count; c++)
            for (int64_t d = 0; d < c; d++) {
                const double r = s.overlap[c] + s.overlap[d];
                double t = 0;
                for (int x = 0; x < 3; x++) {
                    const double v = (double)outward(&s, c, x) - (double)outward(&s, d, x);
                    t += v * v;
                }
                least = fmin(least, t - r * r);
            }
        nlc_assert_quiet(ck_assert(nlc_least_apart(&found, s.network, s.normal, 0, size_of, s.overlap, 4)));
        if (least >= 0) nlc_assert_same(found, least);
        else ck_assert(found < 0);
        for (int c = 0; c < count; c++) s.overlap[c] = 0;
        int64_t place;
        nlc_assert_quiet(ck_assert(nlc_least_apart(&found, s.network, s.normal, 0, size_of, s.overlap, 4)));
        nlc_assert_quiet(ck_assert(nlc_later_below(&place, s.network, s.normal, 0, found)));
        ck_assert_int_eq(place, -1); /* none is closer than the closest, */
        nlc_assert_quiet(ck_assert(nlc_later_below(&place, s.network, s.normal, 0, found * 1.0001)));
        ck_assert(place > 0 && place < count); /* which is there */
        *(least < 0 ? &overlapping : &apart) += 1;
        scene_free(&s);
    }
    ck_assert_int_ge(apart, 10);
    if (_i == EVEN || _i == POLE) ck_assert_int_ge(overlapping, 3);
}
END_TEST

/* Two wide circles away from a crowd of points, each alone on its face of the tree's cube: all depends on their reach. */
START_TEST(wide_circles)
{
    rng g = {54};
    scene s;
    planet(&s, CAP, 200, 0, &g);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    for (int64_t c = 0; c < s.contacts; c++) s.overlap[c] = 0;
    for (int round = 0; round < 50; round++) {
        const double turn = rng_uniform(&g, 0.9, 1.5); /* from x, the first one, towards y; the crowd is around z */
        for (int x = 0; x < 3; x++) {
            s.normal[x] = (s.i[0] == 0 ? 1 : -1) * (x == 0);
            s.normal[3 + x] = (s.i[1] == 0 ? 1 : -1) * (x == 0 ? cos(turn) : x == 1 ? sin(turn) : 0);
        }
        for (int touch = 0; touch < 2; touch++) {
            double least = NAN;
            s.overlap[0] = rng_uniform(&g, 0.3, 0.7) * 2 * sin(turn / 2) * (touch ? 1.001 : 0.999);
            s.overlap[1] = 2 * sin(turn / 2) * (touch ? 1.001 : 0.999) - s.overlap[0];
            nlc_assert_quiet(ck_assert(nlc_least_apart(&least, s.network, s.normal, 0, size_of, s.overlap, 0)));
            ck_assert(touch ? least < 0 : least >= 0);
        }
    }
    scene_free(&s);
}
END_TEST

/* ---- work */

/* Pairs looked at in a sweep, a contact. */
static double work(kind type, int32_t model, int count, double tolerance)
{
    rng g = {52};
    scene s;
    planet(&s, type, count, tolerance, &g);
    s.options.model = model;
    double *force = random_forces(&s, &g), *w = swept(&s, force);
    const double pairs = (double)s.network->evaluations / count;
    if (verbose())
        printf("%-7s model %d, tolerance %.0e, Z %6d: %6.0f pairs a contact\n", kinds[type], model, tolerance, count, pairs);
    free(force), free(w);
    scene_free(&s);
    return pairs;
}

/* No faster than Z log Z, about: where Z is 8 times as large, all pairs would be 8 times as many a contact. */
START_TEST(work_grows_like_the_contacts)
{
    static const struct {
        int32_t model;
        int count;
        double tolerance;
    } row[] = {{NLC_MODEL_GONZALEZ_CUITINO, 10000, 1e-8}, {NLC_MODEL_GONZALEZ_CUITINO, 10000, 1e-4}, {NLC_MODEL_SPHERE, 6000, 1e-2}};
    for (int k = 0; k < 3; k++) {
        const double a = work((kind)_i, row[k].model, row[k].count, row[k].tolerance);
        const double b = work((kind)_i, row[k].model, 8 * row[k].count, row[k].tolerance);
        ck_assert(a > 0 && a < 0.32 * row[k].count);
        ck_assert(b <= 1.6 * a); /* found: 1.42 */
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("coordination");
    TCase *t = tcase_create("coordination");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    tcase_add_loop_test(t, displacements, 0, KINDS);
    tcase_add_loop_test(t, few_contacts, 0, KINDS);
    tcase_add_loop_test(t, symmetry, 0, KINDS);
    tcase_add_test(t, models);
    tcase_add_test(t, lengths);
    tcase_add_test(t, own_images);
    tcase_add_loop_test(t, units, 0, KINDS);
    tcase_add_loop_test(t, huge_forces, 0, CASCADE);
    tcase_add_loop_test(t, rigid_centre, 0, 6);
    tcase_add_loop_test(t, exchange_of_sides, 0, KINDS);
    tcase_add_test(t, loops_of_the_host);
    tcase_add_loop_test(t, solutions, 0, 8);
    tcase_add_test(t, coincidences);
    tcase_add_test(t, ever_closer);
    tcase_add_loop_test(t, closest, 0, KINDS);
    tcase_add_test(t, wide_circles);
    tcase_add_loop_test(t, work_grows_like_the_contacts, 0, 3);
    time_limit(t, 120);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
