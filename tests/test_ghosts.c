/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_ghosts.c - networks shared out among ranks: the results of one network, and no rank left waiting.
 *
 * Ranks are threads, and their callbacks demand that all are in the same call (ranks.h); time limits catch what would wait for ever.
 * Floating-point traps are on, on all threads.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exact.h"
#include "ranks.h"

/* All models, and the half-space at undeformed points behind them. */
#define MODELS 7
static void choose(scene *s, int v)
{
    s->options.model = v < 6 ? v : NLC_MODEL_HALF_SPACE;
    s->options.points = v == 6 ? NLC_POINTS_UNDEFORMED : NLC_POINTS_DEFORMED;
}

static bool has_energy(const scene *s)
{
    return s->options.model != NLC_MODEL_LOVE && !(s->options.model == NLC_MODEL_HALF_SPACE && s->options.points == 0);
}

static const int counts[] = {1, 2, 3, 4, 7};

/* Slabs by number, at random, or at random with the last rank left empty. */
static void share_out(ranks *w, const scene *s, int count, int how, rng *g)
{
    int *owner = calloc((size_t)s->particles, sizeof *owner);
    for (int64_t k = 0; k < s->particles; k++)
        owner[k] = how == 0 ? (int)(k * count / s->particles) : (int)rng_below(g, (uint64_t)(how == 2 && count > 1 ? count - 1 : count));
    ranks_init(w, s, owner, count, g);
    free(owner);
}

/* Largest |a - b| of values over contacts, on any rank, in units of the largest in the whole. */
static double difference(const ranks *w, const double *whole, double *(*values)(rank *))
{
    double top = 0, worst = 0;
    for (int64_t c = 0; c < w->whole->contacts; c++) top = fmax(top, fabs(whole[c]));
    for (int q = 0; q < w->count; q++)
        for (int64_t c = 0; c < w->rank[q].s.contacts; c++)
            worst = fmax(worst, fabs(values(&w->rank[q])[c] - whole[w->rank[q].contact[c]]));
    return top > 0 ? worst / top : worst;
}

static double *forces(rank *r)
{
    return r->s.force;
}

static double *changes(rank *r)
{
    return r->change;
}

/* How often a number is told, and that number. */
static int told(const ranks *w, size_t field, int64_t *number)
{
    int found = 0;
    for (int q = 0; q < w->count; q++) {
        int64_t v;
        memcpy(&v, (const char *)&w->rank[q].info + field, sizeof v);
        if (v >= 0) *number = v;
        found += v >= 0;
    }
    return found;
}

/* What all ranks say must be the same. */
static void agree(const ranks *w)
{
    const nlc_info *a = &w->rank[0].info;
    int64_t number;
    for (int q = 0; q < w->count; q++) {
        const nlc_info *b = &w->rank[q].info;
        ck_assert_int_eq(w->rank[q].status, w->rank[0].status);
        ck_assert(a->sweeps == b->sweeps && a->active == b->active && a->weakened == b->weakened && a->blocks == b->blocks);
        nlc_assert_same(a->residual, b->residual);
        nlc_assert_same(a->lambda_lower, b->lambda_lower);
        nlc_assert_same(a->lambda_upper, b->lambda_upper);
        nlc_assert_same(a->coupling, b->coupling);
        ck_assert_int_eq(b->culprit, a->culprit);
        ck_assert(rank_calls(&w->rank[q]) == rank_calls(&w->rank[0]) && w->rank[q].exchanges == w->rank[q].sums);
    }
    if (a->weakened > 0) ck_assert_int_ge(told(w, offsetof(nlc_info, weakest_particle), &number), 1);
    else ck_assert_int_eq(told(w, offsetof(nlc_info, weakest_particle), &number), 0);
}

/* The whole and its ranks, from zero or from the displacements there are. */
static void solve_both(scene *s, ranks *w, nlc_status *status, nlc_info *info)
{
    *status = scene_solve(s, info);
    ranks_run(w, rank_solve);
    agree(w);
}

static int64_t most_contacts(const scene *s)
{
    int64_t most = 0, *count = calloc((size_t)(s->particles + s->walls), sizeof *count);
    for (int64_t c = 0; c < s->contacts; c++) count[s->i[c]]++, count[s->j[c]]++;
    for (int64_t k = 0; k < s->particles; k++) most = count[k] > most ? count[k] : most;
    free(count);
    return most;
}

/*
 * Tolerance 1e-13 unless said otherwise, which makes both differ by 2e-13 of the forces nearby and by what rounding makes of 1/(1 - lambda).  Whether
 * that counts as NLC_WARNING_ROUNDING may differ.
 */
static void compare(scene *s, int count, int how, double allowed, rng *g, const char *label)
{
    ranks w;
    nlc_info info;
    nlc_status status;
    if (s->options.tolerance <= 0) s->options.tolerance = 1e-13;
    s->network = 0;
    share_out(&w, s, count, how, g);
    ranks_run(&w, rank_build);
    solve_both(s, &w, &status, &info);
    const rank *first = &w.rank[0];
    const double d = difference(&w, s->force, forces);
    if (verbose()) {
        printf("%s, %d ranks: status %d %d, %jd %jd sweeps, %jd exchanges, lambda %.4f %.4f, difference %.1e\n", label, count, status,
               first->status, (intmax_t)info.sweeps, (intmax_t)first->info.sweeps, (intmax_t)first->exchanges,
               first->info.lambda_lower, first->info.lambda_upper, d);
        fflush(stdout);
    }
    ck_assert_int_eq(first->status & ~NLC_WARNING_ROUNDING, status & ~NLC_WARNING_ROUNDING);
    ck_assert_msg(d <= allowed, "%s, %d ranks: forces differ by %g", label, count, d);
    int64_t active = 0;
    for (int64_t c = 0; c < s->contacts; c++) active += s->force[c] > 0;
    ck_assert_int_eq(first->info.active, active);
    ck_assert_int_eq(first->info.weakened, info.weakened);
    const int64_t sweeps = first->info.sweeps, more = first->exchanges - sweeps;
    ck_assert_int_le(sweeps, info.sweeps + 3 + info.sweeps / 5);
    if (s->options.method == NLC_METHOD_FIXED_POINT) ck_assert_int_le(more, sweeps + 2);
    else if (status & NLC_WARNING_WEAKENED) ck_assert_int_le(more, 20 * sweeps);
    else ck_assert_int_le(more, first->info.lambda_lower < 0.7 && most_contacts(s) <= 64 ? 12 : 12 + 2 * 17);
    ranks_free(&w);
}

/* Walls and rigid ones of all sizes; a packing; a crystal; spheres that touch themselves and each other; one that does. */
#define SCENES 5
static void make(scene *s, int v, int which, rng *g)
{
    scene_init(s);
    choose(s, v);
    if (which == 0) scene_cluster(s, g, 11, 0.6);
    if (which == 1) scene_packing(s, "b_die125_rd0.70.csv", 0.3);
    if (which == 2) scene_lattice(s, BODY_CENTRED, 3, 1, 0.46, 0.05, 1e-3, g);
    if (which == 3) {
        const int32_t a = scene_material(s, 5e9, 0.1), b = scene_material(s, 1e9, 0.45);
        const int32_t p = scene_particle(s, 1e-4, a), q = scene_particle(s, 1.7e-4, b);
        scene_contact(s, p, p, 2e-6, 1, 2, 3);
        scene_contact(s, p, q, 3e-6, -3, 0, 1);
        scene_contact(s, q, q, 1e-6, 0, -1, 0);
        scene_contact(s, p, p, 4e-6, -1, 1, -0.3);
        scene_contact(s, q, p, 4e-6, 2, 0.1, 1);
    }
    if (which == 4) scene_cell(s, BODY_CENTRED, 1, 1e6, 0.4, (const double[]){0.96, 0.97, 0.94});
}

START_TEST(same_forces)
{
    rng g = {(uint64_t)_i + 1};
    for (int which = 0; which < SCENES; which++)
        for (int method = 0; method < 2; method++)
            for (int k = 0; k < 5; k++) {
                char label[80];
                scene s;
                make(&s, _i, which, &g);
                s.options.method = method;
                snprintf(label, sizeof label, "model %d, method %d, scene %d", _i, method, which);
                compare(&s, counts[k], (k + which) % 3, 1e-12, &g, label);
                scene_free(&s);
            }
}
END_TEST

/* Up to the end of the stable branch, and beyond it. */
START_TEST(loads)
{
    const double factors[] = {0.5, 0.9, 0.99, 0.999, 1.5};
    rng g = {(uint64_t)_i + 1};
    scene s;
    scene_init(&s);
    if (_i == 0) scene_lattice(&s, BODY_CENTRED, 3, 1, 0.46, 0.05, 1e-3, &g);
    if (_i == 1) scene_lattice(&s, FACE_CENTRED, 3, 1, 0.46, 0.05, 1e-3, &g);
    if (_i == 2) scene_packing(&s, "b_die125_rd0.80.csv", 0.3);
    for (int m = 0; m < 2 && _i == 2; m++) s.rows[m].poisson = 0.45;
    const double end = (double)exact_end(&s, 200, 1e-7L);
    for (int l = 0; l < 5; l++) {
        scene t;
        scene_init(&t);
        t = s;
        t.overlap = malloc((size_t)s.contacts * sizeof *t.overlap);
        t.force = t.nonlocal = 0, t.memory = 0;
        for (int64_t c = 0; c < s.contacts; c++) t.overlap[c] = end * factors[l] * s.overlap[c];
        for (int k = 0; k < 5; k++) {
            char label[80];
            snprintf(label, sizeof label, "scene %d at %.1f %% of the end", _i, 100 * factors[l]);
            compare(&t, counts[k], k % 3, 1e-12, &g, label);
        }
        free(t.overlap), free(t.force), free(t.nonlocal), free(t.memory);
    }
    scene_free(&s);
}
END_TEST

START_TEST(beyond_the_end)
{
    rng g = {(uint64_t)_i + 1};
    for (int k = 0; k < 5; k += 2) {
        char label[80];
        scene s;
        scene_init(&s);
        choose(&s, _i);
        scene_lattice(&s, BODY_CENTRED, 3, 1, 0.46, 0.25, 1e-3, &g);
        snprintf(label, sizeof label, "beyond the end, model %d", _i);
        /* weakened, those of the point force are not solved to 1e-13 each time, nor the sphere's */
        if (_i >= NLC_MODEL_SPHERE) s.options.tolerance = 1e-11;
        compare(&s, counts[k], k % 3, 1e-11, &g, label);
        scene_free(&s);
    }
}
END_TEST

/* A candidate that is far away on one rank is in the units of none. */
START_TEST(far_away)
{
    rng g = {3};
    for (int k = 0; k < 5; k++) {
        scene s;
        scene_init(&s);
        choose(&s, _i);
        scene_lattice(&s, BODY_CENTRED, 3, 1, 0.3, 0.02, 1e-3, &g);
        int64_t far = 0;
        while (s.overlap[far] >= 0) far++;
        s.overlap[far] = -1e90;
        compare(&s, counts[k], k % 3, 1e-11, &g, "far away");
        scene_free(&s);
    }
}
END_TEST

/* Sweep, energy and the three tangents, against those of the whole. */
START_TEST(other_functions)
{
    rng g = {(uint64_t)_i + 9};
    for (int which = 0; which < SCENES; which++)
        for (int k = 0; k < 5; k++) {
            scene s;
            ranks w;
            nlc_info info = {.struct_size = sizeof info};
            nlc_status status;
            make(&s, _i, which, &g);
            s.options.tolerance = 1e-12;
            share_out(&w, &s, counts[k], (k + which) % 3, &g);
            ranks_run(&w, rank_build);
            solve_both(&s, &w, &status, &info);
            for (int q = 0; q < w.count; q++) /* the whole's forces: results are then the same but for rounding */
                for (int64_t c = 0; c < w.rank[q].s.contacts; c++) w.rank[q].s.force[c] = s.force[w.rank[q].contact[c]];
            double *side = calloc(2 * (size_t)s.contacts, sizeof *side), *change = calloc((size_t)s.contacts, sizeof *change);
            double *stiffness = calloc((size_t)s.particles, sizeof *stiffness), energy = 0, top = 0;

            ck_assert_int_eq(nlc_sweep(s.network, side, s.force, s.overlap, s.normal, &info), NLC_OK);
            ranks_run(&w, rank_sweep);
            agree(&w);
            ck_assert_int_eq(w.rank[0].status, NLC_OK);
            ck_assert_int_eq(w.rank[0].exchanges, 2); /* to begin with, and the displacements */
            ck_assert_int_eq(w.rank[0].info.active, info.active);
            for (int64_t e = 0; e < 2 * s.contacts; e++) top = fmax(top, fabs(side[e]));
            for (int q = 0; q < w.count; q++) /* the same sums on the same particles, in another order */
                for (int64_t e = 0; e < 2 * w.rank[q].s.contacts; e++) {
                    const rank *r = &w.rank[q];
                    nlc_assert_abs(r->displacement[e], side[2 * r->contact[e / 2] + (e % 2 ^ r->swapped[e / 2])], 1e-14 * top);
                }

            double *bound = calloc((size_t)s.particles, sizeof *bound), reach, here, most = 0; /* no call of others is needed */
            ck_assert_int_eq(nlc_reach(s.network, &reach, bound, s.force, &info), NLC_OK);
            for (int q = 0; q < w.count; q++) {
                rank *r = &w.rank[q];
                ck_assert_int_eq(nlc_reach(r->s.network, &here, r->stiffness, r->s.force, &info), NLC_OK);
                most = fmax(most, here);
                for (int64_t p = 0; p < r->s.particles; p++)
                    nlc_assert_rel(r->stiffness[p], p < r->owned ? bound[r->particle[p]] : 0, 1e-14);
            }
            nlc_assert_rel(most, reach, 1e-14); /* sums in another order */
            free(bound);

            status = nlc_energy(s.network, &energy, s.force, s.overlap, s.normal, &info);
            ranks_run(&w, rank_energy);
            agree(&w);
            ck_assert_int_eq(w.rank[0].status, status);
            for (int q = 0; q < w.count && status >= 0; q++) nlc_assert_rel(w.rank[q].energy, energy, 1e-13);

            status = nlc_tangent(s.network, change, s.overlap, s.force, s.normal, &info);
            ranks_run(&w, rank_tangent);
            agree(&w);
            ck_assert_int_eq(w.rank[0].status, status);
            ck_assert(status < 0 || difference(&w, change, changes) <= 1e-11); /* residual 1e-13, lambda up to 0.9 */

            status = nlc_tangent_inverse(s.network, change, s.overlap, s.force, s.normal, &info);
            for (int64_t c = 0; c < s.contacts; c++) change[c] = 0;
            status = nlc_tangent_inverse(s.network, change, s.force, s.force, s.normal, &info);
            for (int q = 0; q < w.count; q++)
                for (int64_t c = 0; c < w.rank[q].s.contacts; c++) w.rank[q].s.overlap[c] = w.rank[q].s.force[c];
            ranks_run(&w, rank_tangent_inverse);
            agree(&w);
            ck_assert_int_eq(w.rank[0].status, status);
            ck_assert(status < 0 || difference(&w, change, changes) <= 1e-14);

            status = nlc_tangent_bound(s.network, stiffness, s.force, s.normal, &info);
            ranks_run(&w, rank_tangent_bound);
            agree(&w);
            ck_assert_int_eq(w.rank[0].status, status);
            if (status >= 0) nlc_assert_rel(w.rank[0].info.lambda_upper, info.lambda_upper, 1e-12);
            for (int q = 0; q < w.count && status >= 0; q++)
                for (int64_t p = 0; p < w.rank[q].s.particles; p++)
                    nlc_assert_rel(w.rank[q].stiffness[p], p < w.rank[q].owned ? stiffness[w.rank[q].particle[p]] : 0, 1e-12);
            free(side), free(change), free(stiffness);
            ranks_free(&w);
            scene_free(&s);
        }
}
END_TEST

/* Everything that a function may write, and what a rank must find of it afterwards. */
typedef struct kept {
    double *force, *nonlocal, *displacement, *change, *stiffness, energy;
} kept;

static double *copy(const double *a, int64_t count)
{
    double *b = malloc((size_t)(count > 0 ? count : 1) * sizeof *b);
    if (count > 0) memcpy(b, a, (size_t)count * sizeof *b);
    return b;
}

static kept keep(const rank *r)
{
    const int64_t n = r->s.contacts;
    return (kept){copy(r->s.force, n),    copy(r->s.nonlocal, n), copy(r->displacement, 2 * n),
                  copy(r->change, n), copy(r->stiffness, r->s.particles), r->energy};
}

static bool same(const double *a, const double *b, int64_t count)
{
    return count == 0 || memcmp(a, b, (size_t)count * sizeof *a) == 0;
}

static bool is_kept(const rank *r, const kept *k)
{
    const int64_t n = r->s.contacts;
    return same(r->s.force, k->force, n) && same(r->s.nonlocal, k->nonlocal, n) && same(r->displacement, k->displacement, 2 * n) &&
           same(r->change, k->change, n) && same(r->stiffness, k->stiffness, r->s.particles) && same(&r->energy, &k->energy, 1);
}

/* Puts back what there was, and forgets it. */
static void put_back(rank *r, kept *k)
{
    const size_t n = (size_t)r->s.contacts * sizeof(double);
    if (n > 0) memcpy(r->s.force, k->force, n);
    if (n > 0) memcpy(r->s.nonlocal, k->nonlocal, n);
    free(k->force), free(k->nonlocal), free(k->displacement), free(k->change), free(k->stiffness);
}

#define RANKS 3

/* A task with calls that fail: the ranks where one does, at which call.  culprit: of these, 0 for what the callback returned. */
static void fail_once(ranks *w, void (*task)(rank *), int64_t at, unsigned where, bool last)
{
    kept k[RANKS];
    for (int q = 0; q < RANKS; q++) {
        k[q] = keep(&w->rank[q]);
        w->rank[q].fail_at = where >> q & 1 ? at : 0;
    }
    ranks_run(w, task);
    for (int q = 0; q < RANKS; q++) {
        const rank *r = &w->rank[q];
        const bool here = where >> q & 1;
        ck_assert_int_eq(rank_calls(r), rank_calls(&w->rank[0]));
        ck_assert_int_le(rank_calls(r), at + 3);
        if (!here && last) {
            ck_assert_int_ge(r->status, 0);
        } else {
            ck_assert_int_eq(r->status, here ? NLC_ERROR_CALLBACK : NLC_ERROR_REMOTE);
            ck_assert_int_eq(r->info.culprit, here ? 1000 + q : -1);
            ck_assert(is_kept(r, &k[q]));
        }
        put_back(&w->rank[q], &k[q]);
        w->rank[q].fail_at = 0;
    }
}

static void (*const tasks[])(rank *) = {rank_solve, rank_sweep, rank_energy, rank_tangent, rank_tangent_inverse, rank_tangent_bound};
#define TASKS 6

/* A scene with straddling contacts on all ranks, solved. */
static void begin_failing(scene *s, ranks *w, int v, int which)
{
    rng g = {4};
    make(s, v, which, &g);
    s->options.tolerance = 1e-8;
    share_out(w, s, RANKS, 1, &g);
    ranks_run(w, rank_build);
    ranks_run(w, rank_solve);
    agree(w);
}

/* Each call fails: on one rank, and on any set of them at the same time. */
START_TEST(failing_callbacks)
{
    scene s;
    ranks w;
    begin_failing(&s, &w, _i, 0);
    for (int f = -2; f < TASKS; f++) { /* to begin with from the solution, near it, and from nothing */
        void (*const task)(rank *) = tasks[f < 0 ? 0 : f];
        if (f > 1 && !has_energy(&s)) continue;
        for (int q = 0; q < RANKS && f < 1; q++)
            for (int64_t c = 0; c < w.rank[q].s.contacts; c++) {
                if (f == -1) w.rank[q].s.overlap[c] *= 1.01;
                if (f == 0) w.rank[q].s.nonlocal[c] = 0;
            }
        kept k[RANKS];
        for (int q = 0; q < RANKS; q++) k[q] = keep(&w.rank[q]);
        ranks_run(&w, task);
        agree(&w);
        ck_assert_int_eq(w.rank[0].status & ~NLC_WARNING_CLOSE, NLC_OK);
        const int64_t calls = rank_calls(&w.rank[0]);
        for (int q = 0; q < RANKS; q++) put_back(&w.rank[q], &k[q]);
        for (int64_t at = 1; at <= calls; at++) {
            fail_once(&w, task, at, 1u << at / 3 % RANKS, at == calls);
            fail_once(&w, task, at, 1 + (unsigned)(at / 3 + at) % 7, at == calls);
        }
        if (f != 0) continue;
        ranks_run(&w, rank_solve); /* nothing is left of it */
        agree(&w);
        ck_assert_int_eq(w.rank[0].status & ~NLC_WARNING_CLOSE, NLC_OK);
    }
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

/* Beyond the end of the stable branch there are too many calls for all of them. */
START_TEST(failing_beyond)
{
    rng g = {5};
    scene s;
    ranks w;
    scene_init(&s);
    choose(&s, _i == 0 ? NLC_MODEL_GONZALEZ_CUITINO : NLC_MODEL_LOVE);
    s.options.tolerance = 1e-6;
    scene_lattice(&s, BODY_CENTRED, 3, 1, 0.46, 0.2, 1e-3, &g);
    share_out(&w, &s, RANKS, 1, &g);
    ranks_run(&w, rank_build);
    kept k[RANKS];
    for (int q = 0; q < RANKS; q++) k[q] = keep(&w.rank[q]);
    ranks_run(&w, rank_solve);
    agree(&w);
    ck_assert(w.rank[0].status & NLC_WARNING_WEAKENED);
    const int64_t calls = rank_calls(&w.rank[0]);
    for (int q = 0; q < RANKS; q++) put_back(&w.rank[q], &k[q]);
    for (int64_t at = 1; at < calls; at += 1 + (int64_t)rng_below(&g, 1 + (uint64_t)calls / 30))
        fail_once(&w, rank_solve, at, 1 + (unsigned)rng_below(&g, 6), false);
    for (int64_t at = calls - 12; at < calls; at++) fail_once(&w, rank_solve, at, 1 + (unsigned)rng_below(&g, 6), false);
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

/*
 * A ball with three contacts .01 rad apart, where a solve begins anew several times; beside it a pair of balls on two other ranks.  Calls
 * fail that have nothing to do with it.
 */
START_TEST(failing_beside_a_hard_one)
{
    static const double overlap[] = {0.0231556564156864, 0.0223094445248736, 0.0087343488652229, -0.0077720017073664};
    static const double n[][3] = {{-0.25977382853659, 0.829131630675211, -0.49503363221230},
                                  {-0.552406662383053, -0.632992270874211, 0.542372256267156},
                                  {-0.540418760671444, -0.627446357183499, 0.560587755816605},
                                  {-0.538097802732749, -0.618323049466025, 0.572824022884187}};
    rng g = {6};
    scene s;
    ranks w;
    kept k[RANKS];
    scene_init(&s);
    const int32_t m = scene_material(&s, 1, 0.49239873962948211), rigid = scene_material(&s, INFINITY, 0);
    for (int b = 0; b < 3; b++) scene_particle(&s, 1, m);
    const int32_t wall = 3 + scene_wall(&s, rigid);
    for (int c = 0; c < 4; c++) scene_contact(&s, 0, c == 1 ? 0 : wall, overlap[c], n[c][0], n[c][1], n[c][2]);
    scene_contact(&s, 1, 2, 0.01, 1, 0, 0);
    s.options.simd = NLC_SIMD_GENERIC;
    ranks_init(&w, &s, (const int[]){0, 1, 2}, RANKS, &g);
    ranks_run(&w, rank_build);
    for (int q = 0; q < RANKS; q++) k[q] = keep(&w.rank[q]);
    ranks_run(&w, rank_solve);
    agree(&w);
    const int64_t calls = rank_calls(&w.rank[0]);
    if (verbose()) printf("beside a hard one: status %d, %jd sweeps, %jd calls\n", w.rank[0].status, (intmax_t)w.rank[0].info.sweeps, (intmax_t)calls);
    for (int q = 0; q < RANKS; q++) put_back(&w.rank[q], &k[q]);
    for (int64_t at = 1; at < calls; at += 1 + (int64_t)rng_below(&g, 1 + (uint64_t)calls / 4))
        fail_once(&w, rank_solve, at, 1 + (unsigned)rng_below(&g, 6), false);
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

/* Without the callbacks that have failed a network is like any other. */
START_TEST(alone_after_a_failure)
{
    rng g = {8};
    scene s;
    ranks w;
    scene_init(&s);
    s.options.max_sweeps = 9;
    scene_lattice(&s, BODY_CENTRED, 3, 1, 0.46, 0.2, 1e-3, &g);
    share_out(&w, &s, 1, 0, &g);
    ranks_run(&w, rank_build);
    rank *r = &w.rank[0];
    r->fail_at = 4;
    ranks_run(&w, rank_solve);
    ck_assert_int_eq(r->status, NLC_ERROR_CALLBACK);
    r->s.options = s.options;
    ck_assert_int_eq(nlc_set_options(r->s.network, &r->s.options, 0), NLC_OK);
    rank_solve(r);
    ck_assert(r->status & NLC_WARNING_WEAKENED);
    kept k = keep(r);
    memset(r->s.nonlocal, 0, (size_t)r->s.contacts * sizeof *r->s.nonlocal);
    ck_assert_int_eq(scene_build(&r->s), NLC_OK);
    rank_solve(r);
    ck_assert(same(r->s.force, k.force, r->s.contacts) && same(r->s.nonlocal, k.nonlocal, r->s.contacts));
    put_back(r, &k);
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

/* The next reduction after a call, of which every third one is an exchange. */
static int64_t next_reduction(int64_t at)
{
    return at % 3 == 0 ? at + 2 : at + 1;
}

/* Whether one rank's reductions fail twice in a row. */
static bool fails_in_a_row(const int *of, const int64_t *at, int count)
{
    bool found = false;
    for (int a = 0; a < count; a++)
        for (int b = 0; b < count; b++) found |= of[a] == of[b] && at[a] % 3 != 1 && at[b] == next_reduction(at[a]);
    return found;
}

/* These calls fail, of which there may be fewer.  All ranks return after the same one, with errors if it is not the last. */
static void fail_several(ranks *w, void (*task)(rank *), const int *where, const int64_t *at, int count, int64_t calls)
{
    kept k[RANKS];
    int64_t first = at[0];
    for (int a = 0; a < count; a++) {
        rank *r = &w->rank[where[a]];
        int64_t *const room[3] = {&r->fail_at, &r->fail_too[0], &r->fail_too[1]};
        *room[a] = at[a];
        first = at[a] < first ? at[a] : first;
    }
    for (int q = 0; q < w->count; q++) k[q] = keep(&w->rank[q]);
    ranks_run(w, task);
    for (int q = 0; q < w->count; q++) {
        rank *r = &w->rank[q];
        const int64_t called = rank_calls(r);
        bool here = false;
        for (int a = 0; a < count; a++) here |= where[a] == q && at[a] <= called;
        ck_assert_int_eq(called, rank_calls(&w->rank[0]));
        if (first >= calls && !here) {
            ck_assert_int_ge(r->status, 0);
        } else {
            ck_assert_int_eq(r->status, here ? NLC_ERROR_CALLBACK : NLC_ERROR_REMOTE);
            ck_assert_int_eq(r->info.culprit, here ? 1000 + q : -1);
            ck_assert(is_kept(r, &k[q]));
        }
        put_back(r, &k[q]);
        r->fail_at = r->fail_too[0] = r->fail_too[1] = 0;
    }
}

/* All pairs and triples of calls that fail, those behind a failure too, but for a rank's reductions that fail twice in a row. */
START_TEST(failing_twice)
{
    void (*const task)(rank *) = _i < 2 ? rank_sweep : rank_solve;
    const int count = 2 + _i % 2;
    rng g = {7};
    scene s;
    ranks w;
    make(&s, 0, 0, &g);
    share_out(&w, &s, count, 1, &g);
    ranks_run(&w, rank_build);
    ranks_run(&w, rank_solve);
    ranks_run(&w, task);
    agree(&w);
    const int64_t calls = rank_calls(&w.rank[0]), slots = (calls + 4) * count;
    const uint64_t part = _i < 2 ? 1 : 1 + (uint64_t)(slots * slots * slots) / 20000;
    for (int64_t a = 0; a < slots; a++)
        for (int64_t b = 0; b < a; b++)
            for (int64_t c = -1; c < b; c++) { /* -1: no third one */
                const int64_t slot[3] = {a, b, c};
                const int several = c < 0 ? 2 : 3;
                int where[3];
                int64_t at[3];
                for (int m = 0; m < several; m++) where[m] = (int)(slot[m] % count), at[m] = 1 + slot[m] / count;
                if (fails_in_a_row(where, at, several) || (c >= 0 && rng_below(&g, part) != 0)) continue;
                fail_several(&w, task, where, at, several, calls);
            }
    ranks_run(&w, task); /* nothing is left of it */
    agree(&w);
    ck_assert_int_ge(w.rank[0].status, 0);
    ck_assert_int_eq(rank_calls(&w.rank[0]), calls);
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

static bool is_usable(const rank *r)
{
    bool good = isfinite(r->energy);
    for (int64_t c = 0; c < r->s.contacts; c++)
        good &= isfinite(r->s.force[c]) && r->s.force[c] >= 0 && isfinite(r->s.nonlocal[c]) && isfinite(r->displacement[2 * c]) &&
                isfinite(r->displacement[2 * c + 1]) && isfinite(r->change[c]);
    for (int64_t k = 0; k < r->s.particles; k++) good &= isfinite(r->stiffness[k]);
    return good;
}

/*
 * Ghosts bring numbers that no owner has: in each exchange, on one rank or all; and reductions such as are none.  No exception is raised, all make the same calls, and
 * all fail or none, with results that are finite.  What is not finite fails; so does in an iteration's own units what is much too large.
 */
START_TEST(odd_numbers)
{
    static const double odd[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, DBL_MAX, 1e300, -1e200, 1e160, 1e120, -1e80, 1e30, -1, 5e-324, 0};
    scene s;
    ranks w;
    begin_failing(&s, &w, _i % MODELS, 0);
    if (_i >= MODELS) s.options.method = NLC_METHOD_FIXED_POINT;
    if (_i >= MODELS) ranks_run(&w, rank_build);
    for (int f = -1; f < TASKS; f++) { /* to begin with from the solution, then from nothing */
        void (*const task)(rank *) = tasks[f < 0 ? 0 : f];
        if ((f > 1 && !has_energy(&s)) || (f > 0 && _i >= MODELS)) continue;
        for (int q = 0; q < RANKS && f == 0; q++)
            for (int64_t c = 0; c < w.rank[q].s.contacts; c++) w.rank[q].s.nonlocal[c] = 0;
        kept k[RANKS];
        for (int q = 0; q < RANKS; q++) k[q] = keep(&w.rank[q]);
        ranks_run(&w, task);
        const int64_t calls = rank_calls(&w.rank[0]);
        for (int q = 0; q < RANKS; q++) put_back(&w.rank[q], &k[q]);
        for (int64_t at = 1; at < calls; at++)
            for (size_t v = 0; v < (at % 3 == 1 ? sizeof odd / sizeof *odd : at % 3 == 2 ? 3 : 1); v++) { /* maxima may be infinite */
                const unsigned where = at % 2 ? 7 : 1u << v % RANKS;
                for (int q = 0; q < RANKS; q++) {
                    k[q] = keep(&w.rank[q]);
                    w.rank[q].odd_at = where >> q & 1 ? at : 0;
                    w.rank[q].odd = odd[v];
                }
                ranks_run(&w, task);
                for (int q = 0; q < RANKS; q++) {
                    rank *r = &w.rank[q];
                    ck_assert_int_eq(rank_calls(r), rank_calls(&w.rank[0]));
                    ck_assert((r->status < 0) == (w.rank[0].status < 0));
                    ck_assert(r->status >= 0 ? is_usable(r) : is_kept(r, &k[q]));
                    if (!isfinite(odd[v])) ck_assert_int_eq(r->status, where >> q & 1 ? NLC_ERROR_CALLBACK : NLC_ERROR_REMOTE);
                    if (r->status == NLC_ERROR_CALLBACK) ck_assert_int_eq(r->info.culprit, 0);
                    put_back(r, &k[q]);
                    r->odd_at = 0;
                }
            }
    }
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

/*
 * Contacts of overlaps around 1e190 that ghosts push open by 1e130 times as much in the only sweep there is: their displacements end at
 * the range of double, and nothing overflows.
 */
START_TEST(opened_beyond_the_range)
{
    rng g = {4};
    scene s;
    ranks w;
    make(&s, NLC_MODEL_GONZALEZ_CUITINO, 0, &g);
    for (int64_t k = 0; k < s.particles; k++) s.radius[k] = ldexp(s.radius[k], 630);
    for (int64_t m = 0; m < s.materials; m++) s.rows[m].young = ldexp(s.rows[m].young, -900);
    for (int64_t c = 0; c < s.contacts; c++) s.overlap[c] = ldexp(s.overlap[c], 630);
    s.options.max_sweeps = 1;
    share_out(&w, &s, RANKS, 1, &g);
    ranks_run(&w, rank_build);
    ranks_run(&w, rank_solve);
    const int64_t calls = rank_calls(&w.rank[0]);
    double least = 0;
    for (int64_t at = 4; at < calls; at += 3) { /* exchanges, but for that of the particles' sizes */
        for (int q = 0; q < RANKS; q++) {
            for (int64_t c = 0; c < w.rank[q].s.contacts; c++) w.rank[q].s.nonlocal[c] = 0;
            w.rank[q].odd_at = at;
            w.rank[q].odd = -1e130;
        }
        nlc_assert_quiet(ranks_run(&w, rank_solve));
        for (int q = 0; q < RANKS; q++) {
            ck_assert(w.rank[q].status >= 0 && is_usable(&w.rank[q]));
            for (int64_t c = 0; c < w.rank[q].s.contacts; c++) least = fmin(least, w.rank[q].s.nonlocal[c]);
        }
    }
    ck_assert(least < -1e300);
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

/* After a task in which one rank finds something wrong with what it was given. */
static void demand_error(ranks *w, void (*task)(rank *), int where, nlc_status status, int64_t culprit)
{
    kept k[RANKS];
    for (int q = 0; q < RANKS; q++) k[q] = keep(&w->rank[q]);
    ranks_run(w, task);
    for (int q = 0; q < RANKS; q++) {
        const rank *r = &w->rank[q];
        ck_assert_int_eq(r->status, q == where ? status : NLC_ERROR_REMOTE);
        ck_assert_int_eq(r->info.culprit, q == where ? culprit : -1);
        ck_assert(is_kept(r, &k[q]));
        put_back(&w->rank[q], &k[q]);
    }
}

#define WITH(lvalue, bad, task, status, culprit)                                                                               \
    do {                                                                                                                       \
        __typeof__(lvalue) good_ = (lvalue);                                                                                   \
        (lvalue) = (bad);                                                                                                      \
        demand_error(&w, task, q, status, culprit);                                                                            \
        (lvalue) = good_;                                                                                                      \
    } while (0)

static void no_info(rank *r)
{
    scene *s = &r->s;
    nlc_info info = {.struct_size = r->number == 1 ? 3 : sizeof info};
    r->info.culprit = -1;
    r->status = nlc_solve(s->network, s->force, s->nonlocal, s->overlap, s->normal, &info);
}

static void no_info_energy(rank *r)
{
    scene *s = &r->s;
    nlc_info info = {.struct_size = r->number == 1 ? 3 : sizeof info};
    r->info.culprit = -1;
    r->status = nlc_energy(s->network, &r->energy, s->force, s->overlap, s->normal, &info);
}

static void no_forces(rank *r)
{
    scene *s = &r->s;
    r->status = nlc_solve(s->network, r->number == 1 ? 0 : s->force, s->nonlocal, s->overlap, s->normal, &r->info);
}

START_TEST(wrong_arguments)
{
    scene s;
    ranks w;
    begin_failing(&s, &w, _i, 0);
    const bool places = s.options.model == NLC_MODEL_HALF_SPACE && s.options.points == 0;
    for (int q = 0; q < RANKS; q++) {
        rank *r = &w.rank[q];
        scene *t = &r->s;
        const int64_t c = t->contacts / 2;
        WITH(t->overlap[c], NAN, rank_solve, NLC_ERROR_OVERLAP, c);
        WITH(t->overlap[c], INFINITY, rank_solve, NLC_ERROR_OVERLAP, c);
        WITH(t->overlap[c], 1e300, rank_solve, NLC_ERROR_RANGE, -1);
        WITH(t->normal[3 * c], NAN, rank_solve, NLC_ERROR_NORMAL, c);
        WITH(t->normal[3 * c], 3, rank_solve, NLC_ERROR_NORMAL, c);
        WITH(t->nonlocal[c], -INFINITY, rank_solve, NLC_ERROR_NONLOCAL, c);
        WITH(t->force[c], NAN, rank_sweep, NLC_ERROR_FORCE, c);
        WITH(t->normal[3 * c + 1], NAN, rank_sweep, NLC_ERROR_NORMAL, c);
        WITH(t->overlap[c], NAN, rank_sweep, NLC_ERROR_OVERLAP, c);
        if (places) WITH(r->displacement[2 * c + 1], NAN, rank_sweep, NLC_ERROR_NONLOCAL, c);
        if (!has_energy(&s)) continue;
        WITH(t->force[c], -1, rank_energy, NLC_ERROR_FORCE, c);
        WITH(t->overlap[c], NAN, rank_energy, NLC_ERROR_OVERLAP, c);
        WITH(t->overlap[c], NAN, rank_tangent, NLC_ERROR_OVERLAP, c);
        WITH(t->force[c], NAN, rank_tangent, NLC_ERROR_FORCE, c);
        WITH(t->overlap[c], NAN, rank_tangent_inverse, NLC_ERROR_FORCE, c);
        WITH(t->normal[3 * c + 2], 2, rank_tangent_bound, NLC_ERROR_NORMAL, c);
    }
    const int q = 1;
    demand_error(&w, no_forces, 1, NLC_ERROR_NULL, 1);
    demand_error(&w, no_info, 1, NLC_ERROR_STRUCT_SIZE, -1);
    if (has_energy(&s)) demand_error(&w, no_info_energy, 1, NLC_ERROR_STRUCT_SIZE, -1);
    (void)q;
    ranks_run(&w, rank_solve); /* it was not the network's fault */
    agree(&w);
    ck_assert_int_eq(w.rank[0].status & ~NLC_WARNING_CLOSE, NLC_OK);
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

static void set_tolerance(rank *r)
{
    r->s.options.tolerance = r->number == 1 ? 1e-4 : 1e-8;
    r->status = nlc_set_options(r->s.network, &r->s.options, 0);
}

static void set_stiffness(rank *r)
{
    static const double hard[] = {1e60, 1e60, 1e60}, soft[] = {1e-60, 1e-60, 1e-60};
    r->s.options.stiffness = r->number ? soft : hard;
    r->status = nlc_set_options(r->s.network, &r->s.options, 0);
}

static void solve_or_sweep(rank *r)
{
    r->number == 1 ? rank_solve(r) : rank_sweep(r);
}

/* Errors that only all ranks together can see, and ones that a sweep finds. */
START_TEST(other_errors)
{
    scene s;
    ranks w;
    begin_failing(&s, &w, NLC_MODEL_GONZALEZ_CUITINO, 0);
    ranks_run(&w, solve_or_sweep);
    for (int q = 0; q < RANKS; q++) ck_assert_int_eq(w.rank[q].status, NLC_ERROR_OPTION);
    ranks_run(&w, set_tolerance);
    for (int f = 0; f < TASKS; f++) {
        ranks_run(&w, tasks[f]);
        for (int q = 0; q < RANKS; q++) ck_assert_int_eq(w.rank[q].status, NLC_ERROR_OPTION);
        for (int64_t at = 1; at <= rank_calls(&w.rank[0]); at++) { /* and there, too, nobody waits for one whose call has failed */
            w.rank[1].fail_at = at;
            ranks_run(&w, tasks[f]);
            ck_assert(w.rank[1].status == NLC_ERROR_CALLBACK || w.rank[1].status == NLC_ERROR_OPTION);
            ck_assert(w.rank[0].status == NLC_ERROR_REMOTE || w.rank[0].status == NLC_ERROR_OPTION);
            w.rank[1].fail_at = 0;
        }
    }
    ranks_run(&w, rank_build);
    for (int q = 0; q < RANKS; q++) { /* overlaps on one, stiffnesses on another: too large together */
        for (int64_t c = 0; c < w.rank[q].s.contacts; c++) w.rank[q].s.overlap[c] = q == 1 ? 1e200 : 1e-200;
        for (int64_t c = 0; c < w.rank[q].s.contacts; c++) w.rank[q].s.nonlocal[c] = 0;
    }
    ranks_run(&w, rank_solve);
    for (int q = 0; q < RANKS; q++) ck_assert(w.rank[q].status < 0);
    ranks_free(&w);
    scene_free(&s);

    /* overlaps on one, stiffnesses on the other, each of which would do */
    scene_init(&s);
    const int32_t m = scene_material(&s, 1e9, 0.3);
    for (int k = 0; k < 4; k++) scene_particle(&s, 1, m);
    for (int k = 0; k < 3; k++) scene_contact(&s, k, k + 1, 1, 1, 0, 0);
    rng g = {7};
    ranks_init(&w, &s, (const int[]){0, 0, 1, 1}, 2, &g);
    ranks_run(&w, rank_build);
    ranks_run(&w, set_stiffness);
    for (int q = 0; q < 2; q++)
        for (int64_t c = 0; c < w.rank[q].s.contacts; c++) w.rank[q].s.overlap[c] = q ? 0x1p400 : 0x1p-100;
    ranks_run(&w, rank_solve);
    for (int q = 0; q < 2; q++) ck_assert(w.rank[q].status == NLC_ERROR_RANGE && w.rank[q].info.culprit == -1);
    ranks_free(&w);
    scene_free(&s);

    begin_failing(&s, &w, NLC_MODEL_GONZALEZ_CUITINO, 1); /* two contacts of one particle in the same direction */
    for (int q = 0; q < RANKS; q++) {
        rank *r = &w.rank[q];
        scene *t = &r->s;
        int64_t c = 0, d = -1;
        for (; d < 0; c++)
            for (int64_t e = 0; e < c && d < 0 && t->i[c] < r->owned; e++) d = t->i[e] == t->i[c] ? e : -1;
        double old[3];
        memcpy(old, t->normal + 3 * --c, sizeof old);
        memcpy(t->normal + 3 * c, t->normal + 3 * d, sizeof old);
        for (int f = 0; f < TASKS - 1; f++) {
            ranks_run(&w, tasks[f]);
            for (int p = 0; p < RANKS; p++) ck_assert_int_eq(w.rank[p].status, p == q ? NLC_ERROR_COINCIDENT : NLC_ERROR_REMOTE);
            ck_assert(r->info.culprit == c || r->info.culprit == d);
        }
        memcpy(t->normal + 3 * c, old, sizeof old);
    }
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

/* A scene that moves: from the displacements of the last step, and copies of a contact that differ by rounding. */
START_TEST(steps)
{
    rng g = {6};
    scene s;
    ranks w;
    make(&s, _i, 1, &g);
    s.options.tolerance = 1e-10;
    scene_build(&s);
    share_out(&w, &s, 4, (_i + 2) % 3, &g);
    ranks_run(&w, rank_build);
    for (int step = 0; step < 20; step++) { /* every other one changes but rounding: the start is the solution */
        nlc_status status;
        nlc_info info;
        for (int64_t c = 0; c < s.contacts && step % 2 == 0; c++) s.overlap[c] *= 1 + 1e-4 * rng_uniform(&g, -1, 1);
        for (int q = 0; q < w.count; q++)
            for (int64_t c = 0; c < w.rank[q].s.contacts; c++)
                w.rank[q].s.overlap[c] = s.overlap[w.rank[q].contact[c]] * (1 + 0x1p-52 * (double)rng_below(&g, 2));
        solve_both(&s, &w, &status, &info);
        const double d = difference(&w, s.force, forces);
        if (verbose())
            printf("model %d, step %d: %jd %jd sweeps, %jd exchanges, difference %.1e\n", _i, step, (intmax_t)info.sweeps,
                   (intmax_t)w.rank[0].info.sweeps, (intmax_t)w.rank[0].exchanges, d);
        ck_assert_int_eq(w.rank[0].status, status);
        ck_assert(d <= 2e-10);
        ck_assert_int_le(w.rank[0].info.sweeps, info.sweeps + 3);
        ck_assert_int_le(w.rank[0].exchanges, w.rank[0].info.sweeps + (step == 0 ? 20 : 11));
        if (step % 2 == 1 && (_i == NLC_MODEL_GONZALEZ_CUITINO || _i > NLC_MODEL_SPHERE)) ck_assert_int_eq(w.rank[0].exchanges, 4);
    }
    ranks_free(&w);
    scene_free(&s);
}
END_TEST

/*
 * Contacts of a sphere with two others in nearly one place, one or both of them on two ranks: the larger overlap stays with a force
 * like Hertz's (the other one and a wall at its back push it in by little), the other one is pushed open, on both ranks alike.
 */
START_TEST(pushed_open)
{
    static const int owner[][3] = {{0, 1, 1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 2}};
    rng g = {(uint64_t)_i + 11};
    for (double apart = 1e-3; apart > 1e-9; apart /= 10)
        for (int larger = 1; larger <= 2; larger++) {
            scene s;
            ranks w;
            nlc_info info;
            nlc_status status;
            scene_init(&s);
            s.options.model = _i < 4 ? NLC_MODEL_GONZALEZ_CUITINO : NLC_MODEL_SPHERE;
            const int32_t m = scene_material(&s, 1e6, 0.3);
            for (int k = 0; k < 3; k++) scene_particle(&s, 1e-3, m);
            const int32_t wall = (int32_t)s.particles + scene_wall(&s, scene_material(&s, INFINITY, 0));
            scene_contact(&s, 0, 1, larger == 1 ? 2e-5 : 1.9e-6, 1, 0, 0);
            scene_contact(&s, 2, 0, larger == 2 ? 2e-5 : 1.9e-6, -1, apart, 0);
            scene_contact(&s, 0, wall, 2e-6, -1, 0, 0);
            ranks_init(&w, &s, owner[_i % 4], 3, &g);
            ranks_run(&w, rank_build);
            solve_both(&s, &w, &status, &info);
            ck_assert_int_eq(status, NLC_WARNING_CLOSE);
            ck_assert_int_eq(w.rank[0].status, NLC_WARNING_CLOSE);
            ck_assert_int_le(w.rank[0].info.sweeps, 12);
            ck_assert(difference(&w, s.force, forces) <= 2e-8); /* the tolerance, of each */
            const double hertz = nlc_hertz_force((double)scene_stiffness(&s, 0), 2e-5);
            for (int q = 0; q < w.count; q++)
                for (int64_t c = 0; c < w.rank[q].s.contacts; c++) {
                    const double force = w.rank[q].s.force[c];
                    if (w.rank[q].contact[c] == larger - 1) ck_assert(force > 0.99 * hertz && force < 1.2 * hertz);
                    if (w.rank[q].contact[c] == 2 - larger) ck_assert(force <= 0);
                }
            ranks_free(&w);
            scene_free(&s);
        }
}
END_TEST

/* ---- where several ranks meet */

enum { SIDE = 5, BLOCK = SIDE * SIDE * SIDE }; /* the middle layers are on the boundaries between ranks */

/* A face-centred crystal out of order, and all pairs with a gap below a tenth of a diameter. */
static void scene_block(scene *s, double (*x)[3], rng *g)
{
    const int32_t soft = scene_material(s, 1e9, 0.3), hard = scene_material(s, 3e9, 0.2);
    for (int k = 0; k < BLOCK; k++) {
        const int at[3] = {k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE};
        for (int d = 0; d < 3; d++) x[k][d] = (d < 2 ? 1.4 * (at[d] + 0.5 * (at[2] % 2)) : at[d]) + rng_uniform(g, -0.02, 0.02);
        scene_particle(s, rng_uniform(g, 0.7, 0.73), k % 3 ? soft : hard);
    }
    for (int32_t i = 0; i < BLOCK; i++)
        for (int32_t j = i + 1; j < BLOCK; j++) {
            const double v[3] = {x[j][0] - x[i][0], x[j][1] - x[i][1], x[j][2] - x[i][2]};
            const double overlap = s->radius[i] + s->radius[j] - sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            if (overlap > -0.15) scene_contact(s, i, j, overlap, v[0], v[1], v[2]);
        }
}

/* Domains: slabs; a slab beside two that share the rest, so that three meet along a line; four along a line; eight at a point. */
static int domain(const double *x, int count)
{
    const int a = x[0] > 3, b = x[1] > 3, c = x[2] > 2.5;
    return count == 2 ? a : count == 3 ? (a ? 1 + b : 0) : count == 4 ? 2 * a + b : 4 * a + 2 * b + c;
}

/* Ranks on which particle k is a ghost with a force between it and one of theirs: bits. */
static unsigned ghost_on(const scene *s, const int *owner, int32_t k)
{
    unsigned bits = 0;
    for (int64_t c = 0; c < s->contacts; c++)
        if (s->force[c] > 0 && (s->i[c] == k || s->j[c] == k)) bits |= 1u << owner[s->i[c] == k ? s->j[c] : s->i[c]];
    return bits & ~(1u << owner[k]);
}

static int ones(unsigned bits)
{
    int n = 0;
    for (; bits; bits &= bits - 1) n++;
    return n;
}

/* Particles that are ghosts of n other ranks; contacts of two ranks that a third one sees whole, both its ends being ghosts there. */
static void count_corners(const scene *s, const int *owner, int particles[9], int *seen)
{
    unsigned on[BLOCK];
    for (int n = 0; n < 9; n++) particles[n] = 0;
    *seen = 0;
    for (int32_t k = 0; k < BLOCK; k++) particles[ones(on[k] = ghost_on(s, owner, k))]++;
    for (int64_t c = 0; c < s->contacts; c++)
        *seen += s->force[c] > 0 && owner[s->i[c]] != owner[s->j[c]] && (on[s->i[c]] & on[s->j[c]]);
}

/* What turning adds, of all ranks on each particle. */
static double turning_difference(const ranks *w, const double *whole)
{
    double *sum = calloc(3 * BLOCK, sizeof *sum), worst = 0, top = 0;
    for (int q = 0; q < w->count; q++)
        for (int64_t e = 0; e < 3 * w->rank[q].s.particles; e++) sum[3 * w->rank[q].particle[e / 3] + e % 3] += w->rank[q].turning[e];
    for (int e = 0; e < 3 * BLOCK; e++) {
        worst = fmax(worst, fabs(sum[e] - whole[e]));
        top = fmax(top, fabs(whole[e]));
    }
    ck_assert(top > 0);
    free(sum);
    return worst / top;
}

/* The same forces where particles are ghosts of two, three and seven other ranks. */
START_TEST(corners)
{
    static const int domains[] = {2, 3, 4, 8};
    for (int k = 0; k < 4; k++) {
        rng g = {(uint64_t)_i + 30};
        char label[80];
        scene s;
        ranks w;
        double x[BLOCK][3];
        int owner[BLOCK], particles[9], seen, several = 0;
        scene_init(&s);
        choose(&s, _i);
        s.options.tolerance = 1e-13;
        scene_block(&s, x, &g);
        for (int p = 0; p < BLOCK; p++) owner[p] = domain(x[p], domains[k]);
        ranks_init(&w, &s, owner, domains[k], &g);
        ranks_run(&w, rank_build);
        nlc_info info;
        nlc_status status;
        solve_both(&s, &w, &status, &info);
        count_corners(&s, owner, particles, &seen);
        for (int n = 2; n < 9; n++) several += particles[n];
        const double d = difference(&w, s.force, forces);
        snprintf(label, sizeof label, "model %d, %d domains", _i, domains[k]);
        if (verbose())
            printf("%s: status %d %d, ghosts of 1, 2, 3, more ranks %d %d %d %d, contacts that a third one sees %d, "
                   "difference %.1e\n", label, status, w.rank[0].status, particles[1], particles[2], particles[3],
                   several - particles[2] - particles[3], seen, d);
        ck_assert_int_eq((status | w.rank[0].status) & ~(NLC_WARNING_ROUNDING | NLC_WARNING_CLOSE), NLC_OK);
        ck_assert_int_ge(particles[1], 10);
        ck_assert(k == 0 ? several == 0 && seen == 0 : several >= 3 && seen >= 3);
        ck_assert(k < 2 || particles[3] >= 1);
        ck_assert(k < 3 || several > particles[2] + particles[3]);
        ck_assert_msg(d <= 1e-12, "%s: forces differ by %g", label, d);
        if (has_energy(&s) && s.options.model != NLC_MODEL_HERTZ) {
            double F[3 * BLOCK] = {0};
            ck_assert_int_eq(nlc_assemble_turning(s.network, F, 0, s.force, s.overlap, s.normal, 0), NLC_OK);
            for (int q = 0; q < w.count; q++)
                for (int64_t c = 0; c < w.rank[q].s.contacts; c++) w.rank[q].s.force[c] = s.force[w.rank[q].contact[c]];
            ranks_run(&w, rank_turning);
            for (int q = 0; q < w.count; q++) ck_assert_int_eq(w.rank[q].status, NLC_OK);
            const double t = turning_difference(&w, F);
            ck_assert_msg(t <= 1e-13, "%s: turning differs by %g", label, t); /* the same sums in another order */
        }
        ranks_free(&w);
        scene_free(&s);
    }
}
END_TEST

/* ---- particles with very many contacts */

/* Two large spheres with count small ones on each, pairs of which touch; and the large ones each other. */
static void scene_crowd(scene *s, int count, rng *g)
{
    const int32_t soft = scene_material(s, 1e9, 0.3), hard = scene_material(s, 4e9, 0.45);
    const double spacing = sqrt(12.566 / count);
    const int32_t large[2] = {scene_particle(s, 1, soft), scene_particle(s, 1.1, soft)};
    scene_contact(s, large[0], large[1], 1e-3 * spacing, 0, 0, 1);
    for (int b = 0; b < 2; b++)
        for (int c = 0; c < count; c++) {
            const double z = 1 - (2 * c + 1.0) / count, turn = c * 3.14159265358979 * (3 - sqrt(5)), r = sqrt(1 - z * z);
            const double up = b ? -z : z; /* the nearest one of each is some spacing away from the other large sphere */
            if (c == 0) continue;
            const int32_t small = scene_particle(s, 0.4 * spacing, hard);
            scene_contact(s, large[b], small, 0.4 * spacing * rng_uniform(g, 1e-3, 3e-2), r * cos(turn), r * sin(turn), up);
            if (c % 2 && c > 1) scene_contact(s, small - 1, small, 0.4 * spacing * rng_uniform(g, -1e-3, 1e-2), -sin(turn), cos(turn), 0.3);
        }
}

/*
 * On 1 to 4 ranks, the large ones on different ones.  At a tolerance of 1e-2, and always in SPHERE, groups of contacts are
 * interpolated: by their places, not by their order, so that the ranks' are those of the whole.  Solved to a tolerance forces may
 * differ by twice that; found is 1e-15, since the steps of both are the same.
 */
START_TEST(crowds)
{
    static const struct {
        int32_t model;
        int count;
        double tolerance;
    } row[] = {{NLC_MODEL_GONZALEZ_CUITINO, 200, 1e-13}, {NLC_MODEL_GONZALEZ_CUITINO, 2100, 1e-2},
               {NLC_MODEL_SPHERE, 140, 1e-13},           {NLC_MODEL_SPHERE, 180, 1e-6},
               {NLC_MODEL_POINT_FORCE, 200, 1e-13},      {NLC_MODEL_POINT_FORCE, 2100, 1e-2}};
    rng g = {(uint64_t)_i + 50};
    for (int count = 1; count <= 4; count++) {
        char label[80];
        scene s;
        scene_init(&s);
        s.options.model = row[_i].model;
        s.options.tolerance = row[_i].tolerance;
        scene_crowd(&s, row[_i].count, &g);
        snprintf(label, sizeof label, "crowd, model %d, tolerance %g", row[_i].model, row[_i].tolerance);
        compare(&s, count, count % 2, 1e-12, &g, label);
        scene_free(&s);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("ghosts");
    TCase *t = tcase_create("forces");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    time_limit(t, 120);
    tcase_add_loop_test(t, same_forces, 0, MODELS);
    tcase_add_loop_test(t, loads, 0, 3);
    tcase_add_loop_test(t, beyond_the_end, 0, MODELS);
    tcase_add_loop_test(t, far_away, 0, MODELS);
    tcase_add_loop_test(t, other_functions, 0, MODELS);
    tcase_add_loop_test(t, steps, 0, MODELS);
    tcase_add_loop_test(t, pushed_open, 0, 8);
    suite_add_tcase(suite, t);
    t = tcase_create("places");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    time_limit(t, 120);
    tcase_add_loop_test(t, corners, 0, MODELS);
    tcase_add_loop_test(t, crowds, 0, 6);
    suite_add_tcase(suite, t);
    t = tcase_create("errors");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    time_limit(t, 120);
    tcase_add_loop_test(t, failing_callbacks, 0, MODELS);
    tcase_add_loop_test(t, failing_beyond, 0, 2);
    tcase_add_test(t, alone_after_a_failure);
    tcase_add_loop_test(t, failing_twice, 0, 4);
    tcase_add_loop_test(t, odd_numbers, 0, 2 * MODELS);
    tcase_add_test(t, opened_beyond_the_range);
    tcase_add_test(t, failing_beside_a_hard_one);
    tcase_add_loop_test(t, wrong_arguments, 0, MODELS);
    tcase_add_test(t, other_errors);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
