/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_memory.c - the memory of a network: how much for which options, and that it is enough.
 *
 * A lean network, in just the memory that NLC_METHOD_FIXED_POINT or NLC_MODEL_HERTZ asks for and between guard pages, gives the bits
 * of one in the memory of the default options, or refuses and changes nothing.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ranks.h"

/* All models, and the half-space at undeformed points behind them. */
enum { MODELS = 7, RANKS = 3 };

static nlc_options options_of(int v, int32_t method)
{
    return (nlc_options){.struct_size = sizeof(nlc_options), .model = v < 6 ? v : NLC_MODEL_HALF_SPACE, .method = method,
                         .points = v == 6 ? NLC_POINTS_UNDEFORMED : NLC_POINTS_DEFORMED};
}

static size_t size_for(const scene *s, const nlc_options *o)
{
    const nlc_particles view = scene_view(s);
    return nlc_network_size(&view, s->contacts, o);
}

/* ---- how much */

static double per_contact(int64_t particles, int64_t contacts, const nlc_options *o)
{
    const nlc_particles p = {.struct_size = sizeof p, .count = particles, .material_count = 1};
    return (double)nlc_network_size(&p, contacts, o) / (double)contacts;
}

/* What the manual says of large packings with 6 to 9 contacts on a particle. */
START_TEST(bytes_of_a_contact)
{
    static const double most[MODELS] = {100, 90, 116, 108, 124, 100, 100}; /* by model */
    for (int64_t contacts = 1100000; contacts < 1000000000; contacts *= 3) {
        for (int z = 6; z <= 9; z++) {
            const int64_t particles = 2 * contacts / z;
            for (int v = 0; v < MODELS; v++) {
                nlc_options o = options_of(v, NLC_METHOD_FIXED_POINT);
                const double lean = per_contact(particles, contacts, &o);
                ck_assert(lean > 72 && lean < most[v]);
                o.method = NLC_METHOD_AUTOMATIC;
                const double usual = per_contact(particles, contacts, &o);
                if (v == NLC_MODEL_HERTZ) ck_assert(usual == lean);
                else ck_assert(usual > 380 && usual < 450);
                nlc_assert_rel(usual, per_contact(particles, contacts, v == NLC_MODEL_HERTZ ? &o : NULL), 0);
            }
        }
    }
    const nlc_options hertz = options_of(NLC_MODEL_HERTZ, 0), lean = options_of(0, NLC_METHOD_FIXED_POINT);
    ck_assert(per_contact(3334, 10000, &hertz) < 90); /* no trees: small ones, too */
    ck_assert(per_contact(3334, 10000, &lean) < 160);
}
END_TEST

START_TEST(largest_counts)
{
    static const double radius[2] = {1, 1};
    static const nlc_material material = {1e9, 0.3};
    const nlc_particles p = {.struct_size = sizeof p, .count = 2, .radius = radius, .materials = &material, .material_count = 1};
    nlc_options o = options_of(0, NLC_METHOD_FIXED_POINT);
    const int32_t i = 0, j = 1;
    const int64_t between = PTRDIFF_MAX / 200; /* fits in one layout only */
    double memory[16];
    nlc_network *n = NULL;
    nlc_info info = {.struct_size = sizeof info};
    ck_assert_uint_eq(nlc_network_size(&p, between, NULL), 0);
    const size_t size = nlc_network_size(&p, between, &o);
    ck_assert(size > 72 * (size_t)between && size < 73 * (size_t)between);
    ck_assert_uint_eq(nlc_network_size(&p, PTRDIFF_MAX / 72, &o), 0);
    ck_assert_uint_eq(nlc_network_size(&p, INT64_MAX / 2 + 1, &o), 0);
    ck_assert_uint_eq(nlc_network_size(&p, -1, &o), 0);
    ck_assert_int_eq(nlc_network_init(&n, memory, sizeof memory, &p, &i, &j, between, &o, &info), NLC_ERROR_MEMORY_SIZE);
    ck_assert_int_eq(info.culprit, (int64_t)size);
    ck_assert_int_eq(nlc_network_init(&n, memory, sizeof memory, &p, &i, &j, between, NULL, &info), NLC_ERROR_COUNT);
    for (int wrong = 0; wrong < 2; wrong++) { /* what is wrong is not the memory */
        const size_t least = nlc_network_size(&p, 1, &(nlc_options){.struct_size = sizeof o, .model = NLC_MODEL_HERTZ});
        guarded g = guard(NULL, least, true);
        o = options_of(0, NLC_METHOD_FIXED_POINT);
        *(wrong ? &o.method : &o.model) = 99;
        ck_assert_uint_eq(nlc_network_size(&p, 1, &o), least);
        ck_assert_int_eq(nlc_network_init(&n, g.at, least, &p, &i, &j, 1, &o, &info), wrong ? NLC_ERROR_METHOD : NLC_ERROR_MODEL);
        unguard(g);
    }
}
END_TEST

/* ---- what is computed */

enum { SOLVE, AGAIN, SWEEP, ENERGY, INVERSE, TANGENT, BOUND, ASSEMBLE, TURNING, SLIDING, REACH, ORDER, CACHE, UPDATE, AFTER, FUNCTIONS };

typedef struct result {
    nlc_status status;
    nlc_info info;
    size_t size;
    void *out; /* of size bytes, 7 where nothing is written */
} result;

static void *begin(result *r, int64_t count, size_t size)
{
    r->info = (nlc_info){.struct_size = sizeof r->info};
    r->size = (size_t)count * size + 1;
    r->out = malloc(r->size);
    ck_assert_ptr_nonnull(r->out);
    return memset(r->out, 7, r->size);
}

static double *doubles(result *r, int64_t count, double value)
{
    double *x = begin(r, count, sizeof *x);
    for (int64_t k = 0; k < count; k++) x[k] = value;
    return x;
}

/* Everything there is to a scene; the starts of the two solves are 0 and what the first one found. */
static void compute(const scene *s, nlc_network *n, result r[FUNCTIONS])
{
    const int64_t contacts = s->contacts, particles = s->particles;
    const nlc_particles view = scene_view(s);
    double *x = doubles(&r[SOLVE], 2 * contacts, 0);
    r[SOLVE].status = nlc_solve(n, x, x + contacts, s->overlap, s->normal, &r[SOLVE].info);
    const double *force = x;
    double *zero = calloc((size_t)(3 * contacts) + 1, sizeof *zero);
    x = doubles(&r[AGAIN], 2 * contacts, 0);
    memcpy(x + contacts, force + contacts, (size_t)contacts * sizeof *x);
    r[AGAIN].status = nlc_solve(n, x, x + contacts, s->overlap, s->normal, &r[AGAIN].info);
    x = doubles(&r[SWEEP], 2 * contacts, 0);
    r[SWEEP].status = nlc_sweep(n, x, force, s->overlap, s->normal, &r[SWEEP].info);
    r[ENERGY].status = nlc_energy(n, doubles(&r[ENERGY], 1, 0), force, s->overlap, s->normal, &r[ENERGY].info);
    r[INVERSE].status = nlc_tangent_inverse(n, doubles(&r[INVERSE], contacts, 0), force, force, s->normal, &r[INVERSE].info);
    r[TANGENT].status = nlc_tangent(n, begin(&r[TANGENT], contacts, sizeof *x), s->overlap, force, s->normal, &r[TANGENT].info);
    r[BOUND].status = nlc_tangent_bound(n, begin(&r[BOUND], particles, sizeof *x), force, s->normal, &r[BOUND].info);
    x = doubles(&r[ASSEMBLE], 3 * (particles + s->walls), 0);
    r[ASSEMBLE].status = nlc_assemble(n, x, 0, x + 3 * particles, force, s->normal, &r[ASSEMBLE].info);
    x = doubles(&r[TURNING], 3 * particles, 0);
    r[TURNING].status = nlc_assemble_turning(n, x, 0, force, s->overlap, s->normal, &r[TURNING].info);
    x = doubles(&r[SLIDING], 6 * particles, 0);
    r[SLIDING].status = nlc_assemble_sliding(n, x, 0, x + 3 * particles, 0, NULL, force, s->normal, zero, r[SWEEP].out, s->overlap, 0.3,
                                             &r[SLIDING].info);
    x = doubles(&r[REACH], particles + 1, 0);
    r[REACH].status = nlc_reach(n, x, x + 1, force, &r[REACH].info);
    int64_t *contact = begin(&r[ORDER], contacts + particles, sizeof *contact);
    r[ORDER].status = nlc_order(n, (int32_t *)(void *)(contact + contacts), contact, &r[ORDER].info);
    *(size_t *)begin(&r[CACHE], 1, sizeof(size_t)) = nlc_cache_size(n);
    r[CACHE].status = NLC_OK;
    begin(&r[UPDATE], 0, 1);
    r[UPDATE].status = nlc_network_update(n, &view, s->options.stiffness, &r[UPDATE].info);
    x = doubles(&r[AFTER], 2 * contacts, 0);
    r[AFTER].status = nlc_solve(n, x, x + contacts, s->overlap, s->normal, &r[AFTER].info);
    free(zero);
}

static void release(result r[FUNCTIONS])
{
    for (int f = 0; f < FUNCTIONS; f++) free(r[f].out);
}

static bool is_refused(const nlc_options *o, int f)
{
    return o->model != NLC_MODEL_HERTZ && (f == TANGENT || f == BOUND);
}

static bool has_energy(const nlc_options *o)
{
    return o->model != NLC_MODEL_LOVE && !(o->model == NLC_MODEL_HALF_SPACE && o->points == NLC_POINTS_DEFORMED);
}

static void compare(const result *a, const result *b, int f)
{
    ck_assert_msg(a->status == b->status && a->size == b->size && memcmp(a->out, b->out, a->size) == 0 &&
                      memcmp(&a->info, &b->info, sizeof a->info) == 0,
                  "function %d: %d, %d, sweeps %d, %d", f, a->status, b->status, (int)a->info.sweeps, (int)b->info.sweeps);
}

/* A refused function leaves every byte of the network, and of its results. */
static void refuse(const scene *s, nlc_network *n, size_t size, const double *force)
{
    unsigned char *kept = malloc(size);
    result r;
    ck_assert_ptr_nonnull(kept);
    memcpy(kept, n, size);
    const nlc_status expected = has_energy(&s->options) ? NLC_ERROR_MEMORY_SIZE : NLC_ERROR_NO_POTENTIAL;
    const int64_t culprit = has_energy(&s->options) ? (int64_t)size_for(s, NULL) : s->options.model;
    for (int f = TANGENT; f <= BOUND; f++) {
        double *x = begin(&r, s->contacts + s->particles, sizeof *x);
        r.status = f == TANGENT ? nlc_tangent(n, x, s->overlap, force, s->normal, &r.info)
                                : nlc_tangent_bound(n, x, force, s->normal, &r.info);
        ck_assert_int_eq(r.status, expected);
        ck_assert_int_eq(r.info.culprit, culprit);
        for (size_t b = 0; b < r.size; b++) ck_assert_int_eq(((unsigned char *)r.out)[b], 7);
        free(r.out);
    }
    ck_assert_int_eq(memcmp(kept, n, size), 0);
    free(kept);
}

static void backwards(void *context, void (*task)(void *, int64_t), void *work, int64_t count)
{
    ++*(int64_t *)context;
    while (count-- > 0) task(work, count);
}

/* The scene's options in the memory that they ask for, and in that of the default ones. */
static void look_at(scene *s)
{
    const nlc_particles view = scene_view(s);
    const size_t lean = size_for(s, &s->options), whole = size_for(s, NULL);
    nlc_network *n, *m;
    result a[FUNCTIONS], b[FUNCTIONS];
    guarded full = guard(NULL, whole, true);
    ck_assert(lean < whole);
    ck_assert_int_eq(nlc_network_init(&m, full.at, whole, &view, s->i, s->j, s->contacts, &s->options, NULL), NLC_OK);
    compute(s, m, b);
    for (int behind = 0; behind < 2; behind++) {
        nlc_info info = {.struct_size = sizeof info};
        guarded g = guard(NULL, lean, behind);
        ck_assert_int_eq(nlc_network_init(&n, g.at, lean - 1, &view, s->i, s->j, s->contacts, &s->options, &info), NLC_ERROR_MEMORY_SIZE);
        ck_assert_int_eq(info.culprit, (int64_t)lean);
        ck_assert_int_eq(nlc_network_init(&n, g.at, lean, &view, s->i, s->j, s->contacts, &s->options, NULL), NLC_OK);
        nlc_assert_quiet(compute(s, n, a));
        for (int f = 0; f < FUNCTIONS; f++)
            if (!is_refused(&s->options, f)) compare(&a[f], &b[f], f);
        if (s->options.model != NLC_MODEL_HERTZ) refuse(s, n, lean, a[SOLVE].out);
        release(a);
        unguard(g);
    }
    release(b);
    unguard(full);
}

/* As they are; with threads; with a cache, which need not be large enough; with both, in portable code. */
static void look_at_all(scene *s, int32_t max_sweeps)
{
    double *cache = malloc(1 << 16);
    int64_t loops = 0;
    ck_assert_ptr_nonnull(cache);
    for (int how = 0; how < 4; how++) {
        for (int v = 0; v < MODELS; v++) {
            const double tolerance = s->options.tolerance;
            s->options = options_of(v, how % 2 && v == NLC_MODEL_HERTZ ? NLC_METHOD_AUTOMATIC : NLC_METHOD_FIXED_POINT);
            s->options.tolerance = tolerance;
            s->options.max_sweeps = max_sweeps;
            if (how & 1) s->options.parallel_for = backwards, s->options.parallel_context = &loops;
            if (how & 2) s->options.cache = cache, s->options.cache_size = 1 << 16;
            if (how == 3) s->options.simd = NLC_SIMD_GENERIC;
            look_at(s);
        }
    }
    free(cache);
}

START_TEST(packings)
{
    static const double stretch[3] = {0.97, 0.98, 0.985};
    rng g = {1};
    scene s;
    scene_init(&s);
    if (_i == 0) scene_packing(&s, "b_die125_rd0.70.csv", 0.05);
    if (_i == 1) scene_lattice(&s, BODY_CENTRED, 3, 1e9, 0.3, 0.02, 1e-2, &g);
    if (_i == 2) scene_cell(&s, FACE_CENTRED, 1, 1e9, 0.3, stretch); /* contacts with itself */
    if (_i == 3) scene_lattice(&s, SIMPLE_CUBIC, 9, 1e9, 0.3, 0.01, 1e-3, &g); /* more windows than one */
    if (_i == 4) scene_lattice(&s, BODY_CENTRED, 3, 1, 0.46, 0.2, 1e-3, &g); /* beyond the end: not converged */
    look_at_all(&s, 30);
    scene_free(&s);
}
END_TEST

/* More contacts than a block holds; than a tree is grown for; for which coefficients are interpolated. */
START_TEST(crowds)
{
    rng g = {2};
    scene s;
    scene_init(&s);
    scene_cluster(&s, &g, _i == 0 ? 80 : _i == 1 ? 300 : 2000, _i == 2 ? 0.02 : 0.05);
    s.options.tolerance = 1e-2;
    if (_i < 2) {
        look_at_all(&s, 6);
    } else {
        s.options = options_of(NLC_MODEL_GONZALEZ_CUITINO, NLC_METHOD_FIXED_POINT);
        s.options.tolerance = 1e-2;
        s.options.max_sweeps = 4;
        look_at(&s);
    }
    scene_free(&s);
}
END_TEST

/* ---- other options */

/* In the memory for the first options all others that need no more are taken, and do what they do in a network of their own. */
START_TEST(options_that_fit)
{
    rng g = {3};
    scene s;
    scene_init(&s);
    scene_lattice(&s, BODY_CENTRED, 3, 1e9, 0.3, 0.02, 1e-2, &g);
    const nlc_particles view = scene_view(&s);
    const nlc_options first = options_of(_i / 2, _i % 2);
    for (int w = 0; w < 2 * MODELS; w++) {
        const nlc_options o = options_of(w / 2, w % 2);
        const size_t given = size_for(&s, &first), wanted = size_for(&s, &o);
        guarded one = guard(NULL, given, true), other = guard(NULL, wanted, true);
        unsigned char *kept = malloc(given);
        nlc_network *n, *m;
        nlc_info info = {.struct_size = sizeof info};
        result a[FUNCTIONS], b[FUNCTIONS];
        ck_assert_ptr_nonnull(kept);
        ck_assert_int_eq(nlc_network_init(&n, one.at, given, &view, s.i, s.j, s.contacts, &first, NULL), NLC_OK);
        s.options = first;
        compute(&s, n, a); /* leaves something everywhere */
        release(a);
        memcpy(kept, one.at, given);
        const nlc_status status = nlc_set_options(n, &o, &info);
        ck_assert_int_eq(status, given >= wanted ? NLC_OK : NLC_ERROR_MEMORY_SIZE);
        ck_assert_int_eq(info.culprit, given >= wanted ? -1 : (int64_t)wanted);
        if (status != NLC_OK) ck_assert_int_eq(memcmp(kept, one.at, given), 0);
        if (status == NLC_OK) {
            ck_assert_int_eq(nlc_network_init(&m, other.at, wanted, &view, s.i, s.j, s.contacts, &o, NULL), NLC_OK);
            s.options = o;
            compute(&s, n, a);
            compute(&s, m, b);
            for (int f = 0; f < FUNCTIONS; f++)
                if (given < size_for(&s, NULL) || wanted == given || !is_refused(&o, f)) compare(&a[f], &b[f], f);
            release(a);
            release(b);
            ck_assert_int_eq(nlc_set_options(n, &first, NULL), NLC_OK); /* and back */
        }
        free(kept);
        unguard(one), unguard(other);
    }
    scene_free(&s);
}
END_TEST

/* ---- ranks */

/* In memory for the default options, on all ranks or on the first one. */
static void build_whole(rank *r)
{
    scene *s = &r->s;
    rank_build(r);
    if (r->status != NLC_OK) return;
    const nlc_particles view = scene_view(s);
    const size_t size = size_for(s, NULL);
    free(s->memory);
    s->memory = malloc(size);
    r->status = s->memory ? nlc_network_init(&s->network, s->memory, size, &view, s->i, s->j, s->contacts, &s->options, NULL) : NLC_ERROR_NULL;
}

static void build_first_whole(rank *r)
{
    if (r->number == 0) build_whole(r);
    else rank_build(r);
}

static void compare_ranks(const ranks *a, const ranks *b, const char *what)
{
    for (int q = 0; q < RANKS; q++) {
        const rank *x = &a->rank[q], *y = &b->rank[q];
        const size_t size = (size_t)x->s.contacts * sizeof(double);
        ck_assert_msg(x->status == y->status && memcmp(&x->info, &y->info, sizeof x->info) == 0, "%s: %d, %d", what, x->status, y->status);
        if (size == 0) continue;
        ck_assert_int_eq(memcmp(x->s.force, y->s.force, size), 0);
        ck_assert_int_eq(memcmp(x->s.nonlocal, y->s.nonlocal, size), 0);
        ck_assert_int_eq(memcmp(x->displacement, y->displacement, 2 * size), 0);
        ck_assert_int_eq(memcmp(x->change, y->change, size), 0);
        nlc_assert_same(x->energy, y->energy);
    }
}

START_TEST(shared_out)
{
    static void (*const task[])(rank *) = {rank_solve, rank_solve, rank_sweep, rank_energy, rank_tangent_inverse};
    static void (*const how[2])(rank *) = {rank_build, build_first_whole};
    static const char *const names[] = {"solve", "again", "sweep", "energy", "tangent_inverse"};
    rng g = {4};
    scene s;
    ranks whole, lean;
    scene_init(&s);
    s.options = options_of(_i / 2, NLC_METHOD_FIXED_POINT);
    scene_lattice(&s, BODY_CENTRED, 3, 1e9, 0.3, 0.02, 1e-2, &g);
    int *owner = calloc((size_t)s.particles, sizeof *owner);
    for (int64_t k = 0; k < s.particles; k++) owner[k] = (int)rng_below(&g, RANKS);
    rng same = g;
    ranks_init(&whole, &s, owner, RANKS, &g);
    ranks_init(&lean, &s, owner, RANKS, &same);
    ranks_run(&whole, build_whole);
    ranks_run(&lean, how[_i % 2]);
    for (int q = 0; q < RANKS; q++) ck_assert(whole.rank[q].status == NLC_OK && lean.rank[q].status == NLC_OK);
    for (int f = 0; f < 5; f++) {
        ranks_run(&whole, task[f]);
        ranks_run(&lean, task[f]);
        compare_ranks(&lean, &whole, names[f]);
    }
    const bool refused = s.options.model != NLC_MODEL_HERTZ && has_energy(&s.options);
    for (int f = 0; f < 2 && refused; f++) { /* one that can hears of it */
        ranks_run(&lean, f == 0 ? rank_tangent : rank_tangent_bound);
        for (int q = 0; q < RANKS; q++) {
            const rank *r = &lean.rank[q];
            const bool can = _i % 2 && q == 0;
            ck_assert_int_eq(r->status, can ? NLC_ERROR_REMOTE : NLC_ERROR_MEMORY_SIZE);
            ck_assert_int_eq(r->info.culprit, can ? -1 : (int64_t)size_for(&r->s, NULL));
        }
    }
    ranks_run(&whole, rank_solve);
    ranks_run(&lean, rank_solve);
    compare_ranks(&lean, &whole, "at last");
    ranks_free(&whole), ranks_free(&lean);
    free(owner);
    scene_free(&s);
}
END_TEST

static void become_point_forces(rank *r)
{
    r->s.options.model = NLC_MODEL_GONZALEZ_CUITINO;
    r->status = nlc_set_options(r->s.network, &r->s.options, NULL);
}

/* Ranks with many more particles than they own get other options: what the network was built from stays where it was. */
START_TEST(shared_out_and_changed)
{
    rng g = {5};
    scene s;
    ranks made, changed;
    scene_init(&s);
    s.options = options_of(NLC_MODEL_LOVE, NLC_METHOD_FIXED_POINT);
    scene_lattice(&s, SIMPLE_CUBIC, 9, 1e9, 0.3, 0.01, 1e-3, &g);
    int *owner = calloc((size_t)s.particles, sizeof *owner);
    for (int64_t k = 0; k < s.particles; k++) owner[k] = (int)rng_below(&g, RANKS);
    rng same = g;
    ranks_init(&changed, &s, owner, RANKS, &g);
    ranks_run(&changed, rank_build);
    ranks_run(&changed, become_point_forces);
    s.options.model = NLC_MODEL_GONZALEZ_CUITINO;
    ranks_init(&made, &s, owner, RANKS, &same);
    ranks_run(&made, rank_build);
    for (int q = 0; q < RANKS; q++) {
        ck_assert(made.rank[q].status == NLC_OK && changed.rank[q].status == NLC_OK);
        ck_assert(changed.rank[q].owned <= 512 && changed.rank[q].s.particles > 512);
    }
    ranks_run(&made, rank_solve);
    ranks_run(&changed, rank_solve);
    ck_assert_int_ge(made.rank[0].status, NLC_OK);
    compare_ranks(&changed, &made, "solve");
    ranks_free(&made), ranks_free(&changed);
    free(owner);
    scene_free(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("memory");
    TCase *t = tcase_create("memory");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    time_limit(t, 60);
    tcase_add_test(t, bytes_of_a_contact);
    tcase_add_test(t, largest_counts);
    tcase_add_loop_test(t, packings, 0, 5);
    tcase_add_loop_test(t, crowds, 0, 3);
    tcase_add_loop_test(t, options_that_fit, 0, 2 * MODELS);
    tcase_add_loop_test(t, shared_out, 0, 2 * MODELS);
    tcase_add_test(t, shared_out_and_changed);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
