/* SPDX-License-Identifier: BSD-2-Clause */
/* test_order.c - nlc_order: every particle and contact once, neighbours together, and the same forces in the new numbers. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

enum { BLOB = 512, BLOCK = 64 }; /* as the manual says; more contacts than BLOCK count as none */

typedef struct order {
    int32_t *particle, *place;
    int64_t *contact;
} order;

static void order_free(order *o)
{
    free(o->particle);
    free(o->place);
    free(o->contact);
}

/* Each once, those owned first; in a blob by falling number of contacts, of which a self contact is two. */
static void look_at_bodies(const scene *s, const order *o, int64_t owned)
{
    int *degree = calloc((size_t)(s->particles + s->walls) + 1, sizeof *degree);
    for (int64_t c = 0; c < s->contacts; c++) {
        degree[s->i[c]]++;
        degree[s->j[c]]++;
    }
    for (int64_t m = 1; m < owned; m++) {
        const int before = degree[o->particle[m - 1]], now = degree[o->particle[m]];
        if (m % BLOB != 0 && before <= BLOCK) ck_assert_int_ge(before, now > BLOCK ? 0 : now);
        if (m % BLOB != 0 && before > BLOCK) ck_assert(now > BLOCK || now == 0);
    }
    free(degree);
    for (int64_t k = 0; k < s->particles; k++) o->place[k] = -1;
    for (int64_t m = 0; m < s->particles; m++) {
        const int32_t k = o->particle[m];
        ck_assert(k >= 0 && k < s->particles && (m < owned) == (k < owned));
        ck_assert_int_eq(o->place[k], -1);
        o->place[k] = (int32_t)m;
    }
}

static int64_t place_of(const scene *s, const order *o, int64_t body)
{
    return body < s->particles ? o->place[body] : body;
}

/* Each once; by the lower number, then by the other with walls last, then as they were: each is behind the one before. */
static void look_at_contacts(const scene *s, const order *o)
{
    char *seen = calloc((size_t)s->contacts + 1, 1);
    int64_t before[3] = {-1, -1, -1};
    for (int64_t m = 0; m < s->contacts; m++) {
        const int64_t c = o->contact[m];
        ck_assert(c >= 0 && c < s->contacts && !seen[c]);
        seen[c] = 1;
        const int64_t i = place_of(s, o, s->i[c]), j = place_of(s, o, s->j[c]), high = i > j ? i : j;
        const int64_t now[3] = {i < j ? i : j, high < s->particles ? high : s->particles, c};
        const int first = now[0] != before[0] ? 0 : now[1] != before[1] ? 1 : 2;
        ck_assert_int_gt(now[first], before[first]);
        memcpy(before, now, sizeof before);
    }
    free(seen);
}

/* Orders a scene that has been built, and looks at what comes out. */
static order order_of(scene *s)
{
    const int64_t owned = s->options.owned_particles > 0 ? s->options.owned_particles : s->particles;
    order o = {.particle = malloc(((size_t)s->particles + 1) * sizeof *o.particle),
               .place = malloc(((size_t)s->particles + 1) * sizeof *o.place),
               .contact = malloc(((size_t)s->contacts + 1) * sizeof *o.contact)};
    nlc_info info = {.struct_size = sizeof info};
    ck_assert(o.particle && o.place && o.contact);
    o.particle[s->particles] = -77;
    o.contact[s->contacts] = -77;
    nlc_assert_quiet(ck_assert_int_eq(nlc_order(s->network, o.particle, o.contact, &info), NLC_OK));
    ck_assert_int_eq(info.culprit, -1);
    ck_assert(o.particle[s->particles] == -77 && o.contact[s->contacts] == -77);
    look_at_bodies(s, &o, owned);
    look_at_contacts(s, &o);
    return o;
}

/* The same scene in other numbers: particle m is particle[m] of it, contact m is contact[m]. */
static void renumber(scene *t, const scene *s, const order *o)
{
    scene_init(t);
    t->options = s->options;
    for (int64_t m = 0; m < s->materials; m++) scene_material(t, s->rows[m].young, s->rows[m].poisson);
    for (int64_t m = 0; m < s->particles; m++) scene_particle(t, s->radius[o->particle[m]], s->material[o->particle[m]]);
    for (int64_t w = 0; w < s->walls; w++) scene_wall(t, s->wall_material[w]);
    for (int64_t m = 0; m < s->contacts; m++) {
        const int64_t c = o->contact[m];
        const double *n = s->normal + 3 * c;
        scene_contact(t, (int32_t)place_of(s, o, s->i[c]), (int32_t)place_of(s, o, s->j[c]), s->overlap[c], n[0], n[1], n[2]);
    }
}

static void shuffle(order *o, const scene *s, rng *g)
{
    *o = (order){.particle = malloc((size_t)s->particles * sizeof *o->particle),
                 .place = malloc((size_t)s->particles * sizeof *o->place),
                 .contact = malloc((size_t)s->contacts * sizeof *o->contact)};
    ck_assert(o->particle && o->place && o->contact);
    for (int64_t k = 0; k < s->particles; k++) {
        const int64_t other = (int64_t)rng_below(g, (uint64_t)k + 1);
        o->particle[k] = k == other ? (int32_t)k : o->particle[other];
        o->particle[other] = (int32_t)k;
    }
    for (int64_t k = 0; k < s->particles; k++) o->place[o->particle[k]] = (int32_t)k;
    for (int64_t c = 0; c < s->contacts; c++) {
        const int64_t other = (int64_t)rng_below(g, (uint64_t)c + 1);
        o->contact[c] = c == other ? c : o->contact[other];
        o->contact[other] = c;
    }
}

static int fail_to_exchange(void *context, double *side)
{
    (void)context;
    (void)side;
    return 1;
}

static int fail_to_reduce(void *context, double *values, int32_t count, int32_t operation)
{
    (void)context;
    (void)values;
    (void)count;
    (void)operation;
    return 1;
}

/* Anything that a network may be: particles alone, twice in contact, in contact with themselves, ghosts, walls only. */
static void make_any(scene *s, rng *g)
{
    const int64_t owned = 1 + (int64_t)rng_below(g, rng_below(g, 8) ? 12 : 2000), walls = (int64_t)rng_below(g, 4);
    const int64_t ghosts = rng_below(g, 3) ? 0 : 1 + (int64_t)rng_below(g, 9), all = owned + ghosts;
    const uint64_t contacts = rng_below(g, rng_below(g, 2) ? 30 : (uint64_t)(4 * owned)), kind = rng_below(g, 4);
    scene_init(s);
    scene_material(s, 1e7, 0.3);
    for (int64_t k = 0; k < all; k++) scene_particle(s, 1, 0);
    for (int64_t w = 0; w < walls; w++) scene_wall(s, 0);
    s->options.owned_particles = ghosts ? owned : 0;
    if (ghosts) {
        s->options.exchange = fail_to_exchange; /* it must not be called */
        s->options.reduce = fail_to_reduce;
    }
    for (uint64_t c = 0; c < contacts; c++) {
        int32_t i = (int32_t)rng_below(g, (uint64_t)owned), j = (int32_t)rng_below(g, (uint64_t)(all + walls));
        double n[3];
        rng_unit(g, n);
        if (kind == 0 && walls > 0) j = (int32_t)(all + (int64_t)rng_below(g, (uint64_t)walls));
        if (kind == 1 && i > 0) i = (int32_t)(i % (1 + i / 8));
        if (kind == 2) j = rng_below(g, 3) ? j : i;
        if (rng_below(g, 2)) scene_contact(s, i, j, 1e-3, n[0], n[1], n[2]);
        else scene_contact(s, j, i, 1e-3, n[0], n[1], n[2]);
    }
    ck_assert_int_eq(scene_build(s), NLC_OK);
}

START_TEST(every_one_once)
{
    for (uint64_t seed = 1; seed <= points(600); seed++) {
        rng g = {seed};
        scene s;
        make_any(&s, &g);
        order o = order_of(&s), again = order_of(&s);
        ck_assert(memcmp(o.particle, again.particle, (size_t)s.particles * sizeof *o.particle) == 0);
        ck_assert(memcmp(o.contact, again.contact, (size_t)s.contacts * sizeof *o.contact) == 0);
        order_free(&again);
        for (int64_t c = 0; c < s.contacts; c++) { /* which one is called i does not matter */
            const int32_t i = s.i[c];
            s.i[c] = s.j[c];
            s.j[c] = i;
        }
        ck_assert_int_eq(scene_build(&s), NLC_OK);
        again = order_of(&s);
        ck_assert(memcmp(o.particle, again.particle, (size_t)s.particles * sizeof *o.particle) == 0);
        ck_assert(memcmp(o.contact, again.contact, (size_t)s.contacts * sizeof *o.contact) == 0);
        order_free(&again);
        order_free(&o);
        scene_free(&s);
    }
}
END_TEST

/* No particles at all, particles without contacts: nothing is wanted that has no elements. */
START_TEST(nothing_to_order)
{
    scene s;
    scene_init(&s);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    ck_assert_int_eq(nlc_order(s.network, 0, 0, 0), NLC_OK);
    scene_free(&s);
    scene_init(&s);
    scene_material(&s, 1e7, 0.3);
    for (int k = 0; k < 600; k++) scene_particle(&s, 1, 0);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    order o = order_of(&s);
    for (int k = 0; k < 600; k++) ck_assert_int_eq(o.particle[k], k);
    ck_assert_int_eq(nlc_order(s.network, o.particle, 0, 0), NLC_OK);
    order_free(&o);
    scene_free(&s);
}
END_TEST

/* Contacts whose two particles are in different blobs, of all. */
static double apart(const scene *s, const order *o)
{
    int64_t count = 0;
    for (int64_t c = 0; c < s->contacts; c++) count += place_of(s, o, s->i[c]) / BLOB != place_of(s, o, s->j[c]) / BLOB;
    return (double)count / (double)s->contacts;
}

/* Each blob but the first lies beside one before it. */
static void look_at_blobs(const scene *s, const order *o)
{
    char *beside = calloc((size_t)s->particles / BLOB + 1, 1);
    for (int64_t c = 0; c < s->contacts; c++) {
        const int64_t a = place_of(s, o, s->i[c]) / BLOB, b = place_of(s, o, s->j[c]) / BLOB;
        if (a != b) beside[a > b ? a : b] = 1;
    }
    for (int64_t b = 1; b < (s->particles + BLOB - 1) / BLOB; b++) ck_assert(beside[b]);
    free(beside);
}

/*
 * A simple cubic crystal of 24^3 spheres numbered at random.  Of cubes of 8^3 spheres an eighth of the contacts leaves each one; breadth
 * first makes octahedra, and what is left between them is ragged: found .25.  Plain breadth first is .87, random numbers are .96.
 */
START_TEST(neighbours_lie_together)
{
    rng g = {5};
    scene crystal, s;
    order mixed;
    scene_init(&crystal);
    scene_crystal(&crystal, 24, 1, 1e7, 0.3, (double[]){0.99, 0.99, 0.99});
    shuffle(&mixed, &crystal, &g);
    renumber(&s, &crystal, &mixed);
    ck_assert_double_gt(apart(&crystal, &mixed), 0.9);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    order o = order_of(&s);
    if (verbose()) printf("order: %.3f of the contacts join two blobs\n", apart(&s, &o));
    ck_assert_double_lt(apart(&s, &o), 0.3);
    look_at_blobs(&s, &o);
    order_free(&o);
    order_free(&mixed);
    scene_free(&s);
    scene_free(&crystal);
}
END_TEST

/* Largest difference over the largest force on any particle. */
static double difference(const double *a, const double *b, int64_t count, double scale)
{
    double most = 0;
    for (int64_t k = 0; k < count; k++) most = fmax(most, fabs(a[k] - b[k]));
    return most / scale;
}

/*
 * Real packings mixed up: the forces in the order's numbers are those in the mixed ones, on contacts and on particles.  Each is within
 * 1e-13 of the solution; a particle's forces are sums of at most a dozen, in another order.  Asked for is 1e-12.
 */
START_TEST(forces_stay_the_same)
{
    static const char *const names[] = {"b_die125_rd0.80.csv", "c_hydrogel514_rest.csv", "a_mono1000_periodic.csv"};
    rng g = {(uint64_t)_i + 1};
    scene given, s, t;
    order mixed;
    double largest = 0;
    scene_init(&given);
    given.options.tolerance = 1e-13;
    scene_packing(&given, names[_i], 0.2);
    shuffle(&mixed, &given, &g);
    renumber(&s, &given, &mixed);
    ck_assert_int_ge(scene_solve(&s, 0), 0);
    order o = order_of(&s);
    renumber(&t, &s, &o);
    ck_assert_int_ge(scene_solve(&t, 0), 0);
    for (int64_t c = 0; c < s.contacts; c++) largest = fmax(largest, s.force[c]);
    double *force = calloc((size_t)s.contacts, sizeof *force), *F[3];
    for (int k = 0; k < 3; k++) F[k] = calloc((size_t)s.particles, 3 * sizeof *F[k]);
    ck_assert(force && F[0] && F[1] && F[2] && largest > 0);
    for (int64_t m = 0; m < s.contacts; m++) force[o.contact[m]] = t.force[m];
    ck_assert_double_le(difference(force, s.force, s.contacts, largest), 1e-12);
    ck_assert_int_eq(nlc_assemble(s.network, F[0], 0, 0, s.force, s.normal, 0), NLC_OK);
    ck_assert_int_eq(nlc_assemble(t.network, F[1], 0, 0, t.force, t.normal, 0), NLC_OK);
    for (int64_t m = 0; m < s.particles; m++) memcpy(F[2] + 3 * o.particle[m], F[1] + 3 * m, 3 * sizeof(double));
    ck_assert_double_le(difference(F[0], F[2], 3 * s.particles, largest), 1e-12);
    for (int k = 0; k < 3; k++) free(F[k]);
    free(force);
    order_free(&o);
    order_free(&mixed);
    scene_free(&t);
    scene_free(&s);
    scene_free(&given);
}
END_TEST

/* Between two solves, one of which settles a region first, it changes no bit. */
START_TEST(network_is_left_as_it_was)
{
    scene s, t;
    nlc_info info = {.struct_size = sizeof info}, same = info;
    scene_init(&s);
    scene_init(&t);
    scene_packing(&s, "a_mono1000_periodic.csv", 0.2);
    scene_packing(&t, "a_mono1000_periodic.csv", 0.2);
    for (int round = 0; round < 3; round++) {
        if (round > 0) {
            order o = order_of(&s);
            order_free(&o);
        }
        for (int64_t c = 0; c < 10 * round; c++) s.overlap[c] = t.overlap[c] *= 1.01;
        ck_assert_int_eq(scene_solve(&s, &info), NLC_OK);
        ck_assert_int_eq(scene_solve(&t, &same), NLC_OK);
        ck_assert(memcmp(s.force, t.force, (size_t)s.contacts * sizeof *s.force) == 0);
        ck_assert(memcmp(&info, &same, sizeof info) == 0);
    }
    scene_free(&s);
    scene_free(&t);
}
END_TEST

START_TEST(errors_change_nothing)
{
    rng g = {3};
    scene s;
    static double not_a_network[64];
    nlc_info info = {.struct_size = sizeof info};
    scene_init(&s);
    scene_cluster(&s, &g, 6, 0.5);
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    int32_t particle[16];
    int64_t contact[64];
    memset(particle, 7, sizeof particle);
    memset(contact, 7, sizeof contact);
    ck_assert_int_eq(nlc_order(0, particle, contact, &info), NLC_ERROR_NULL);
    ck_assert_int_eq(info.culprit, 0);
    ck_assert_int_eq(nlc_order(s.network, 0, contact, &info), NLC_ERROR_NULL);
    ck_assert_int_eq(info.culprit, 1);
    ck_assert_int_eq(nlc_order(s.network, particle, 0, &info), NLC_ERROR_NULL);
    ck_assert_int_eq(info.culprit, 2);
    ck_assert_int_eq(nlc_order((nlc_network *)(void *)not_a_network, particle, contact, &info), NLC_ERROR_NETWORK);
    ck_assert_int_eq(info.culprit, -1);
    info.struct_size = 3;
    ck_assert_int_eq(nlc_order(s.network, particle, contact, &info), NLC_ERROR_STRUCT_SIZE);
    for (size_t k = 0; k < sizeof particle; k++) ck_assert_int_eq(((char *)particle)[k], 7);
    for (size_t k = 0; k < sizeof contact; k++) ck_assert_int_eq(((char *)contact)[k], 7);
    scene_free(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("order");
    TCase *t = tcase_create("order");
    time_limit(t, 60);
    tcase_add_test(t, every_one_once);
    tcase_add_test(t, nothing_to_order);
    tcase_add_test(t, neighbours_lie_together);
    tcase_add_loop_test(t, forces_stay_the_same, 0, 3);
    tcase_add_test(t, network_is_left_as_it_was);
    tcase_add_test(t, errors_change_nothing);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
