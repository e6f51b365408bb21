/* SPDX-License-Identifier: BSD-2-Clause */
/* stress_change.c - how far a change is felt, whether the way there matters, and too few sweeps on the way. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stress.h"

TCase *stress_change(void);

static long double *kept_force(const scene *s)
{
    long double *force = malloc((size_t)(s->contacts > 0 ? s->contacts : 1) * sizeof *force);
    for (int64_t c = 0; c < s->contacts; c++) force[c] = s->force[c];
    return force;
}

/* ----------------------------------------------------------------------------------------------------------- locality -- */

static void hydrogel(scene *s)
{
    scene_init(s);
    scene_packing(s, "c_hydrogel514_strain13.csv", 0.3);
    for (int64_t m = 0; m < s->materials; m++) s->rows[m].poisson = 0.45;
}

/* Contacts from one grain to each, over those with a force; walls do not connect. */
static void distances(const scene *s, int64_t grain, const long double *before, int *distance)
{
    bool more = true;
    for (int64_t k = 0; k < s->particles + s->walls; k++) distance[k] = 999;
    distance[grain] = 0;
    for (int d = 0; more; d++) {
        more = false;
        for (int64_t c = 0; c < s->contacts; c++) {
            const int32_t i = s->i[c], j = s->j[c];
            if (i >= s->particles || j >= s->particles || !(s->force[c] > 0 || before[c] > 0)) continue;
            if (distance[i] == d && distance[j] > d + 1) distance[j] = d + 1, more = true;
            if (distance[j] == d && distance[i] > d + 1) distance[i] = d + 1, more = true;
        }
    }
}

/* The factors t of the particles' couplings: least squares of g = t_i w_i + t_j w_j with w from nlc_sweep. */
static void weakening(const scene *s, double *t)
{
    double *w = malloc(2 * (size_t)s->contacts * sizeof *w), *up = malloc((size_t)(s->particles + s->walls) * sizeof *up);
    double *down = malloc((size_t)(s->particles + s->walls) * sizeof *down);
    ck_assert_int_eq(nlc_sweep(s->network, w, s->force, 0, s->normal, 0), NLC_OK);
    for (int64_t k = 0; k < s->particles + s->walls; k++) t[k] = 1;
    for (int n = 0; n < 4000; n++) { /* gradient steps, scaled by the diagonal: it dominates but for a factor of 2 */
        for (int64_t k = 0; k < s->particles + s->walls; k++) up[k] = down[k] = 0;
        for (int64_t c = 0; c < s->contacts; c++) {
            const double r = s->nonlocal[c] - t[s->i[c]] * w[2 * c] - t[s->j[c]] * w[2 * c + 1];
            up[s->i[c]] += w[2 * c] * r, down[s->i[c]] += w[2 * c] * w[2 * c];
            up[s->j[c]] += w[2 * c + 1] * r, down[s->j[c]] += w[2 * c + 1] * w[2 * c + 1];
        }
        for (int64_t k = 0; k < s->particles; k++)
            if (down[k] > 0) t[k] += 0.9 * up[k] / down[k];
    }
    free(w), free(up), free(down);
}

/*
 * One grain of a stable packing squeezed ten times as much.  Only grains near it are weakened: a bound looks at 17 neighbours
 * in any direction.  Half way to the end it is grains up to 3 away, if any, and forces fall by ten from one grain to the next;
 * just below the end it is most of the packing, and forces 7 away move by up to 0.4 of the largest nearby.  One of 21 such
 * solves does not converge.
 */
START_TEST(squeezed_grain)
{
    const double load = _i ? 4 : 1; /* the branch ends at 4.43; CLOSE from a grain's own contacts is no matter */
    int farthest = 0, lost = 0;
    double moved[40] = {0};
    for (int64_t grain = 7; grain < (full() ? 514 : _i ? 30 : 60); grain += 25) {
        scene s;
        hydrogel(&s);
        ck_assert(!(solve_load(&s, load, 1e-10).status & ~NLC_WARNING_CLOSE));
        long double *before = kept_force(&s);
        int *distance = malloc((size_t)(s.particles + s.walls) * sizeof *distance);
        double *t = malloc((size_t)(s.particles + s.walls) * sizeof *t),
               *largest = calloc((size_t)(s.particles + s.walls), sizeof *largest);
        for (int64_t c = 0; c < s.contacts; c++)
            if (s.overlap[c] > 0 && (s.i[c] == grain || s.j[c] == grain)) s.overlap[c] *= 10;
        cold(&s);
        const trial r = solve_load(&s, load, 1e-10);
        const bool converged = !(r.status & NLC_WARNING_NOT_CONVERGED);
        lost += !converged;
        distances(&s, grain, before, distance);
        weakening(&s, t);
        int here = 0, count = 0;
        double smallest = 1;
        for (int64_t k = 0; k < s.particles; k++) {
            smallest = fmin(smallest, t[k]);
            if (t[k] > 1 - 1e-6) continue;
            count++;
            here = distance[k] > here ? distance[k] : here;
        }
        for (int64_t c = 0; c < s.contacts; c++) {
            largest[s.i[c]] = fmax(largest[s.i[c]], (double)before[c]);
            if (s.j[c] < s.particles) largest[s.j[c]] = fmax(largest[s.j[c]], (double)before[c]);
        }
        for (int64_t c = 0; c < s.contacts; c++) {
            int d = distance[s.i[c]] < distance[s.j[c]] ? distance[s.i[c]] : distance[s.j[c]];
            const double scale = fmax(largest[s.i[c]], s.j[c] < s.particles ? largest[s.j[c]] : 0);
            if (d < 40 && scale > 0) moved[d] = fmax(moved[d], fabs(s.force[c] - (double)before[c]) / scale);
        }
        if (full())
            printf("load %g, grain %jd squeezed: status %d, %jd sweeps, residual %.1e, %jd weakened (%d found, t >= %.4f, "
                   "least %.4f), farthest %d away\n",
                   load, (intmax_t)grain, r.status, (intmax_t)r.info.sweeps, r.info.residual, (intmax_t)r.info.weakened, count,
                   smallest, r.info.coupling, here);
        if (converged) {
            ck_assert_int_eq(count, r.info.weakened);
            nlc_assert_abs(smallest, r.info.coupling, 1e-6);
        }
        farthest = here > farthest ? here : farthest;
        free(before), free(distance), free(t), free(largest);
        scene_free(&s);
    }
    if (full())
        for (int d = 0; d < 40; d++)
            if (moved[d] > 0) printf("  %2d away: forces move by up to %.1e of the largest nearby\n", d, moved[d]);
    ck_assert_int_le(farthest, _i ? 17 : 4);
    ck_assert_int_le(lost, _i && full() ? 1 : 0);
    for (int d = 0; d < 40 && _i == 0; d++) ck_assert(moved[d] <= 500 * pow(0.15, d)); /* 6 away 1.2e-4 */
}
END_TEST

/* ---------------------------------------------------------------------------------------------------- two in a network -- */

/* Adds all of t, unconnected, to s; particles and walls of s keep their order, contacts of t follow those of s. */
static void append(scene *s, const scene *t)
{
    const int32_t particles = (int32_t)s->particles, walls = (int32_t)s->walls, rows = (int32_t)s->materials,
                  added = (int32_t)t->particles;
    for (int64_t m = 0; m < t->materials; m++) scene_material(s, t->rows[m].young, t->rows[m].poisson);
    for (int64_t k = 0; k < t->particles; k++) scene_particle(s, t->radius[k], rows + t->material[k]);
    for (int64_t w = 0; w < t->walls; w++) scene_wall(s, rows + t->wall_material[w]);
    for (int64_t c = 0; c < s->contacts; c++) {
        s->i[c] += s->i[c] >= particles ? added : 0;
        s->j[c] += s->j[c] >= particles ? added : 0;
    }
    for (int64_t c = 0; c < t->contacts; c++) {
        const int32_t shift_i = particles + (t->i[c] >= added ? walls : 0),
                      shift_j = particles + (t->j[c] >= added ? walls : 0);
        const double *n = t->normal + 3 * c;
        scene_contact(s, t->i[c] + shift_i, t->j[c] + shift_j, t->overlap[c], n[0], n[1], n[2]);
        memcpy(s->normal + 3 * (s->contacts - 1), n, 3 * sizeof *n);
    }
}

/*
 * A stable packing and a weakened crystal, each beside a packing one grain of which is squeezed ten times as much: neither
 * moves by a bit, and it is where it is alone to within both solutions' tolerance.
 */
START_TEST(unconnected_scene)
{
    for (int which = 0; which < 2; which++)
        for (double tolerance = 1e-10; tolerance < 1e-5; tolerance *= 1e4) {
            scene a, other;
            rng g = {1};
            hydrogel(&a);
            scene_init(&other);
            if (which == 0)
                scene_packing(&other, "b_die125_rd0.70.csv", 0.3);
            else
                scene_lattice(&other, SIMPLE_CUBIC, 3, 1, 0.46, 0.18, 1e-3, &g); /* 17.2 % is the end */
            const int64_t first = a.contacts;
            append(&a, &other);
            const trial alone = solve_load(&other, 1, tolerance), beside = solve_load(&a, 1, tolerance);
            double *force = malloc((size_t)other.contacts * sizeof *force);
            memcpy(force, a.force + first, (size_t)other.contacts * sizeof *force);
            for (int64_t c = 0; c < first; c++)
                if (a.overlap[c] > 0 && (a.i[c] == 7 || a.j[c] == 7)) a.overlap[c] *= 10;
            cold(&a);
            const trial squeezed = solve_load(&a, 1, tolerance);
            long double *lone = kept_force(&other);
            const double error = scene_error(&other, force, lone), moved = scene_error(&other, a.force + first, lone);
            int64_t same = 0;
            for (int64_t c = 0; c < other.contacts; c++) same += same_bits(force[c], a.force[first + c]);
            if (full())
                printf("beside another, tolerance %g: status %d %d %d, alone or not %.1e, other squeezed or not %.1e, same "
                       "bits %jd of %jd\n",
                       tolerance, alone.status, beside.status, squeezed.status, error, moved, (intmax_t)same,
                       (intmax_t)other.contacts);
            ck_assert(!((alone.status | beside.status | squeezed.status) & NLC_WARNING_NOT_CONVERGED));
            ck_assert(error <= 2 * tolerance && moved <= 2 * tolerance);
            ck_assert_int_eq(same, other.contacts);
            free(force), free(lone);
            scene_free(&a);
            scene_free(&other);
        }
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------ the way -- */

static const double *path(int which, double *end, scene *s)
{
    static const double there_and_back[] = {0.1, 0.5, 0.9, 0.99, 1.001, 1.01, 1.1, 1.01, 1.001, 0.99, 0.9, 0.5, 0.1, 0};
    rng g = {5};
    scene_init(s);
    if (which < 3)
        scene_cell(s, (lattice)which, 1, 1, 0.48, (const double[]){0.99, 0.985, 0.98});
    else if (which < 5)
        scene_lattice(s, which == 3 ? SIMPLE_CUBIC : FACE_CENTRED, 3, 1, 0.46, 0.05, 1e-3, &g);
    else
        scene_packing(s, "b_die125_rd0.80.csv", 0.3);
    for (int64_t m = 0; m < s->materials && which == 5; m++) s->rows[m].poisson = 0.45;
    *end = (double)exact_end(s, 200, 1e-7L);
    ck_assert(isfinite(*end));
    return there_and_back;
}

/* Through the end and back, from the displacements of the step before: the forces are those that a cold start finds. */
START_TEST(there_and_back)
{
    tally t;
    double end;
    scene s;
    const double *load = path(_i, &end, &s);
    double *nonlocal = calloc((size_t)s.contacts, sizeof *nonlocal), worst = 0;
    tally_begin(&t, 0, "there and back %d", _i);
    for (double tolerance = 1e-10; tolerance < 1e-5; tolerance *= 1e4) {
        memset(nonlocal, 0, (size_t)s.contacts * sizeof *nonlocal);
        for (int l = 0; load[l] > 0; l++) {
            cold(&s);
            const trial first = solve_load(&s, load[l] * end, tolerance);
            long double *force = kept_force(&s);
            memcpy(s.nonlocal, nonlocal, (size_t)s.contacts * sizeof *nonlocal);
            const trial r = solve_load(&s, load[l] * end, tolerance);
            memcpy(nonlocal, s.nonlocal, (size_t)s.contacts * sizeof *nonlocal);
            tally_count(&t, &r);
            const double error = scene_error(&s, s.force, force);
            if (verbose())
                printf("%s, load %g, tolerance %g: status %d %d, %jd %jd sweeps, differs by %.1e\n", t.name, load[l], tolerance,
                       first.status, r.status, (intmax_t)first.info.sweeps, (intmax_t)r.info.sweeps, error);
            free(force);
            if ((first.status | r.status) & NLC_WARNING_NOT_CONVERGED) {
                tally_miss(&t, "load %g tolerance %g: not converged", load[l], tolerance);
                continue;
            }
            worst = fmax(worst, error / tolerance);
            if (first.status != r.status)
                tally_miss(&t, "load %g tolerance %g: status %d, %d", load[l], tolerance, first.status, r.status);
            if (error > 2 * tolerance) tally_miss(&t, "load %g tolerance %g: differs by %g", load[l], tolerance, error);
        }
    }
    if (full()) printf("there and back %d: differs by up to %.2g tolerances\n", _i, worst);
    free(nonlocal);
    tally_end(&t, 0);
    scene_free(&s);
}
END_TEST

/* Never more sweeps than allowed, however few, and forces that can be used for a start. */
START_TEST(few_sweeps)
{
    double end;
    scene s;
    path(_i, &end, &s);
    for (int l = 0; l < 3; l++)
        for (int64_t most = 1; most < 400; most = full() && most < 6 ? most + 1 : most * 4) {
            const double load = (const double[]){0.5, 0.999, 2}[l] * end;
            cold(&s);
            s.options.max_sweeps = most;
            const trial r = solve_load(&s, load, 1e-10); /* looks at the number */
            if (r.info.sweeps == most && r.info.residual > 1e-10) ck_assert(r.status & NLC_WARNING_NOT_CONVERGED);
            s.options.max_sweeps = 0;
            const trial more = solve_load(&s, load, 1e-10);
            if (l == 0) ck_assert(!(more.status & ~NLC_WARNING_CLOSE));
        }
    scene_free(&s);
}
END_TEST

/* Small scenes that take every way through the solver: contacts that push each other open, two clusters, far beyond the end. */
static void small_scene(scene *s, int which)
{
    rng g = {11};
    scene other;
    scene_init(s);
    scene_init(&other);
    if (which == 0) scene_cell(s, BODY_CENTRED, 1, 1, 0.46, (const double[]){0.99, 0.985, 0.98});
    else scene_cluster(s, &g, 12, which == 1 ? 0.05 : 0.5);
    if (which == 2) scene_lattice(&other, SIMPLE_CUBIC, 3, 1, 0.46, 0.01, 1e-3, &g);
    if (which == 2) append(s, &other);
    scene_free(&other);
}

/* From nothing, from a neighbouring load and from nonsense, in every model: solve_load looks at the number of sweeps. */
START_TEST(never_more_sweeps)
{
    for (int which = 0; which < 3; which++)
        for (int l = 0; l < 4; l++)
            for (int64_t most = 1; most <= 30; most += full() || most < 8 ? 1 : 5) {
                const double load = (const double[]){1, 8, 30, 1000}[l];
                scene s;
                rng g = {3};
                small_scene(&s, which);
                s.options.model = _i / 2;
                s.options.method = _i % 2 ? NLC_METHOD_FIXED_POINT : NLC_METHOD_AUTOMATIC;
                s.options.max_sweeps = most;
                for (int start = 0; start < 3; start++) {
                    const trial r = solve_load(&s, start == 1 ? 1.01 * load : load, 1e-10);
                    if (!(r.status & (NLC_WARNING_NOT_CONVERGED | NLC_WARNING_ROUNDING))) ck_assert_double_le(r.info.residual, 1e-10);
                    for (int64_t c = 0; c < s.contacts && start == 1; c++)
                        s.nonlocal[c] = fabs(load * s.overlap[c]) * rng_uniform(&g, -5, 5);
                }
                scene_free(&s);
            }
}
END_TEST

TCase *stress_change(void)
{
    TCase *t = tcase_create("change");
    tcase_set_timeout(t, full() ? 0 : 300);
    tcase_add_checked_fixture(t, 0, no_misses);
    tcase_add_loop_test(t, squeezed_grain, 0, 2);
    tcase_add_test(t, unconnected_scene);
    tcase_add_loop_test(t, there_and_back, 0, 6);
    tcase_add_loop_test(t, few_sweeps, 0, 6);
    tcase_add_loop_test(t, never_more_sweeps, 0, 12);
    return t;
}
