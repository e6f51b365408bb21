/* SPDX-License-Identifier: BSD-2-Clause */
/* test_simd.c - the variants for processors: the same displacements as long double and the portable code, whatever the lists. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>
#endif

#include "../lib/block.h"
#include "../lib/bound.h"
#include "../lib/iteration.h"
#include "../lib/network.h"
#include "../lib/warm.h"
#include "scene.h"

/* As the loop tests number them; what the processor lacks is some other one of them, and passes as that. */
enum { FIRST = NLC_SIMD_BEST, LAST = NLC_SIMD_NEON + 1, MOST = 70 };
static const char *const names[] = {"best", "generic", "avx2", "avx512", "neon"};

/* Whether an option stands for code of its own here. */
static bool is_here(int simd)
{
    const nlc_variant *v = nlc_choose_variant(simd);
    return simd == NLC_SIMD_GENERIC || (v && simd != NLC_SIMD_BEST && v != nlc_choose_variant(simd == NLC_SIMD_NEON ? NLC_SIMD_GENERIC : simd - 1));
}

/* The displacements of all sides, computed between guard pages; to be freed.  Looks at the largest forces, too. */
static double *sweep(const scene *s, int simd, const double *force, bool behind)
{
    const size_t count = (size_t)s->contacts;
    nlc_options o = s->options;
    o.simd = simd;
    const nlc_particles p = scene_view(s);
    const size_t size = nlc_network_size(&p, s->contacts, &o);
    guarded memory = guard(NULL, size, behind), f = guard(force, count * sizeof *force, behind),
            v = guard(s->normal, 3 * count * sizeof(double), behind), w = guard(NULL, 2 * count * sizeof(double), behind);
    nlc_network *n;
    ck_assert_int_eq(nlc_network_init(&n, memory.at, size, &p, s->i, s->j, s->contacts, &o, 0), NLC_OK);
    nlc_assert_quiet(ck_assert_int_eq(nlc_sweep(n, w.at, f.at, 0, v.at, 0), NLC_OK));
    double *largest = calloc((size_t)(s->particles + 1), sizeof *largest);
    for (int64_t e = 0; e < 2 * s->contacts; e++) {
        const int32_t k = e & 1 ? s->j[e >> 1] : s->i[e >> 1];
        largest[k] = fmax(largest[k], fabs(force[e >> 1]));
    }
    for (int64_t k = 0; k < s->particles; k++) nlc_assert_same(n->largest[k], largest[k]);
    free(largest);
    double *out = malloc(2 * count * sizeof *out);
    ck_assert_ptr_nonnull(out);
    memcpy(out, w.at, 2 * count * sizeof *out);
    unguard(memory), unguard(f), unguard(v), unguard(w);
    return out;
}

/* ---- scenes */

/* Spheres of several materials with so many contacts each, all of them with small spheres that have no other contact. */
static void stars(scene *s, rng *g, int spheres, int least, int most)
{
    scene_init(s);
    const int32_t a = scene_material(s, 1e9, 0.45), b = scene_material(s, 3e8, 0.1), rigid = scene_material(s, INFINITY, 0.3);
    for (int k = 0; k < spheres; k++) {
        const int32_t centre = scene_particle(s, rng_uniform(g, 0.5, 2), k % 3 ? a : b);
        const int count = least + (int)rng_below(g, (uint64_t)(most - least + 1));
        for (int c = 0; c < count; c++) {
            const int32_t other = scene_particle(s, 0.1, c % 5 ? a : rigid);
            double n[3];
            rng_unit(g, n);
            const bool reverse = rng_below(g, 2);
            scene_contact(s, reverse ? other : centre, reverse ? centre : other, 0.01, n[0], n[1], n[2]);
        }
    }
}

static double *random_forces(const scene *s, rng *g)
{
    double *force = malloc(((size_t)s->contacts + 1) * sizeof *force);
    ck_assert_ptr_nonnull(force);
    for (int64_t c = 0; c < s->contacts; c++) force[c] = rng_below(g, 8) ? rng_uniform(g, -0.3, 1) * 1e4 : 0;
    return force;
}

/* ---- what is right */

/* Where a side's displacement comes from, in long double: [GC] 5 as in boussinesq_block.c, and the sum of the absolute terms. */
static long double exact_side(const scene *s, const double *force, int64_t e, int *count, long double *size)
{
    const int64_t c = e >> 1;
    const int32_t k = e & 1 ? s->j[c] : s->i[c];
    const nlc_material m = s->rows[s->material[k]];
    const long double U = isinf(m.young) ? 0 : (1 + (long double)m.poisson) / (4 * acosl(-1) * s->radius[k] * m.young);
    const long double c0 = -4 * (1 - (long double)m.poisson), c1 = -2 * (1 - 2 * (long double)m.poisson), c2 = (7 - 8 * (long double)m.poisson) / 2;
    long double sum = 0;
    *count = 0;
    *size = 0;
    for (int64_t d = 0; d < s->contacts; d++)
        for (int side = 0; side < 2; side++) {
            if ((side ? s->j[d] : s->i[d]) != k) continue;
            ++*count;
            if (2 * d + side == e) continue;
            long double t = 0;
            for (int x = 0; x < 3; x++) {
                const long double v = (e & 1 ? -1 : 1) * (long double)s->normal[3 * c + x] - (side ? -1 : 1) * (long double)s->normal[3 * d + x];
                t += v * v;
            }
            const long double r = 1 / sqrtl(t), f = U * force[d];
            sum += (c0 * r + c1 + c2 * t * r) * f;
            *size += (fabsl(c0) * r + fabsl(c1) + c2 * t * r) * fabsl(f);
        }
    return sum;
}

/* Largest error of a side in units of 2^-53 times its absolute terms, less one unit for each contact. */
static double excess(const scene *s, const double *force, const double *w)
{
    double most = -INFINITY;
    for (int64_t e = 0; e < 2 * s->contacts; e++) {
        int count;
        long double size;
        const long double exact = exact_side(s, force, e, &count, &size), error = fabsl(w[e] - exact);
        ck_assert(isfinite(w[e]));
        if (size <= 0) ck_assert(w[e] == 0);
        else most = fmax(most, (double)(error / (size * 0x1p-53L)) - count);
    }
    return most;
}

/* Every number of contacts, from none to beyond a block, in vectors that are full, nearly full and nearly empty. */
START_TEST(every_number_of_contacts)
{
    const int spheres[] = {1, 2, 7, 8, 9};
    rng g = {31};
    double worst = -INFINITY;
    for (int z = 0; z <= MOST; z++) {
        scene s;
        const int some = spheres[z % 5];
        stars(&s, &g, z < 20 ? some : some % 4 + 1, z, z);
        if (z == 0) scene_particle(&s, 1, 0);
        double *force = random_forces(&s, &g);
        for (int behind = 0; behind < 2 && s.contacts > 0; behind++) {
            double *w = sweep(&s, _i, force, behind);
            worst = fmax(worst, excess(&s, force, w));
            free(w);
        }
        free(force);
        scene_free(&s);
    }
    if (verbose()) printf("%-8s error <= (Z + %.1f) 2^-53 of the terms\n", names[_i], worst);
    ck_assert(worst <= 1); /* found: -0.8, with few contacts; roundings of long sums cancel in part */
}
END_TEST

/* Lists of all lengths in one network of more than a window; a lane's result does not depend on its neighbours. */
START_TEST(lists_of_all_lengths)
{
    rng g = {32};
    scene s;
    stars(&s, &g, 60, 0, MOST);
    double *force = random_forces(&s, &g), *w = sweep(&s, _i, force, true), *v = sweep(&s, NLC_SIMD_GENERIC, force, false);
    ck_assert_int_gt(s.particles, 1500);
    ck_assert(excess(&s, force, w) <= 1);
    int64_t other = 0;
    for (int64_t e = 0; e < 2 * s.contacts; e++) other += w[e] != v[e];
    ck_assert(is_here(_i) && _i != NLC_SIMD_GENERIC ? other > s.contacts / 2 : _i == NLC_SIMD_BEST || other == 0 || !is_here(_i));
    const nlc_variant *same = nlc_choose_variant(_i);
    for (int simd = FIRST; simd < LAST; simd++) { /* features masked: the bits of the variant that is left */
        double *x = sweep(&s, simd, force, true);
        if (nlc_choose_variant(simd) == same) ck_assert_int_eq(memcmp(x, w, 2 * (size_t)s.contacts * sizeof *x), 0);
        free(x);
    }
    /* particles in another order: not a bit */
    int32_t *at = malloc((size_t)s.particles * sizeof *at);
    for (int32_t k = 0; k < s.particles; k++) at[k] = k;
    for (int64_t k = s.particles - 1; k > 0; k--) {
        const int64_t d = (int64_t)rng_below(&g, (uint64_t)k + 1);
        const int32_t t = at[k], m = s.material[k];
        const double r = s.radius[k];
        at[k] = at[d], at[d] = t;
        s.material[k] = s.material[d], s.material[d] = m;
        s.radius[k] = s.radius[d], s.radius[d] = r;
    }
    int32_t *where = malloc((size_t)s.particles * sizeof *where);
    for (int32_t k = 0; k < s.particles; k++) where[at[k]] = k;
    for (int64_t c = 0; c < s.contacts; c++) s.i[c] = where[s.i[c]], s.j[c] = where[s.j[c]];
    double *x = sweep(&s, _i, force, true);
    for (int64_t e = 0; e < 2 * s.contacts; e++) nlc_assert_same(x[e], w[e]);
    free(x), free(w), free(v), free(force), free(at), free(where);
    scene_free(&s);
}
END_TEST

/* Exchange i and j of random contacts, of a particle with itself too, with the normal reversed: the same bits on the other side. */
START_TEST(exchange_of_sides)
{
    rng g = {33};
    scene s;
    scene_init(&s);
    const int32_t m = scene_material(&s, 1e9, 0.4);
    for (int k = 0; k < 30; k++) scene_particle(&s, rng_uniform(&g, 0.5, 2), m);
    for (int c = 0; c < 250; c++) {
        double n[3];
        rng_unit(&g, n);
        const int32_t i = (int32_t)rng_below(&g, 30);
        scene_contact(&s, i, i < 5 && c % 4 == 0 ? i : (int32_t)rng_below(&g, 30), 0.01, n[0], n[1], n[2]);
    }
    double *force = random_forces(&s, &g), *w = sweep(&s, _i, force, true);
    ck_assert(excess(&s, force, w) <= 1);
    for (int turn = 0; turn < 4; turn++) {
        unsigned char swapped[250];
        for (int64_t c = 0; c < 250; c++) {
            if (!(swapped[c] = (unsigned char)rng_below(&g, 2))) continue;
            const int32_t t = s.i[c];
            s.i[c] = s.j[c];
            s.j[c] = t;
            for (int x = 0; x < 3; x++) s.normal[3 * c + x] *= -1;
        }
        double *v = sweep(&s, _i, force, turn % 2);
        for (int64_t e = 0; e < 500; e++) nlc_assert_same(v[swapped[e >> 1] ? e ^ 1 : e], w[e]);
        free(w);
        w = v;
    }
    free(w), free(force);
    scene_free(&s);
}
END_TEST

/* The same direction twice: the contact that the portable code names, wherever in a vector or a window it is. */
START_TEST(coincidences)
{
    rng g = {34};
    for (int turn = 0; turn < 60; turn++) {
        scene s;
        const bool long_ones = turn % 4 == 3; /* some of which no lane takes */
        stars(&s, &g, long_ones ? 12 : 40, long_ones ? 50 : 2, long_ones ? MOST : 20);
        double *force = random_forces(&s, &g), *w = malloc(2 * (size_t)s.contacts * sizeof *w);
        for (int times = 0; times < (long_ones ? 12 : 1 + turn % 3); times++) {
            const int64_t c = (int64_t)rng_below(&g, (uint64_t)s.contacts - 1), d = c + 1;
            const int32_t k = s.radius[s.i[c]] > 0.1 ? s.i[c] : s.j[c];
            const double sign = (s.i[c] == k) == (s.i[d] == k) ? 1 : -1;
            for (int x = 0; x < 3; x++) s.normal[3 * d + x] = sign * s.normal[3 * c + x];
        }
        nlc_info info[2] = {{.struct_size = sizeof *info}, {.struct_size = sizeof *info}};
        nlc_status status[2];
        for (int k = 0; k < 2; k++) {
            s.options.simd = k ? _i : NLC_SIMD_GENERIC;
            s.network = 0;
            ck_assert_int_eq(scene_build(&s), NLC_OK);
            nlc_assert_quiet(status[k] = nlc_sweep(s.network, w, force, 0, s.normal, &info[k]));
        }
        ck_assert_int_eq(status[1], status[0]);
        ck_assert_int_eq(info[1].culprit, info[0].culprit);
        free(force), free(w);
        scene_free(&s);
    }
}
END_TEST

/* Directions closer and closer together, down to the last bit: the portable code takes over without a step. */
START_TEST(near_coincidences)
{
    rng g = {35};
    for (int b = 1; b <= 52; b++) {
        scene s;
        stars(&s, &g, 9, 5, 9);
        double *force = random_forces(&s, &g);
        for (int64_t c = 0; c < 3; c++) { /* near (0, 0, 1), outward from the first sphere */
            const double out = s.radius[s.i[c]] > 0.1 ? 1 : -1;
            s.normal[3 * c] = out * (double)c * ldexp(1, -b) / 4, s.normal[3 * c + 1] = 0, s.normal[3 * c + 2] = out;
            const double length = sqrt(1 + s.normal[3 * c] * s.normal[3 * c]);
            for (int x = 0; x < 3; x++) s.normal[3 * c + x] /= length;
        }
        double *w = sweep(&s, _i, force, true);
        ck_assert(excess(&s, force, w) <= 1);
        free(w), free(force);
        scene_free(&s);
    }
}
END_TEST

/* nlc_solve: each variant reaches the forces of long double. */
START_TEST(solutions)
{
    scene s;
    scene_init(&s);
    scene_packing(&s, "b_die125_rd0.70.csv", 0.3);
    s.options.simd = _i;
    s.options.tolerance = 1e-12;
    long double *exact = calloc((size_t)s.contacts, sizeof *exact);
    ck_assert(scene_oracle(&s, 1, exact) < 1e-15L);
    nlc_assert_quiet(ck_assert_int_eq(scene_solve(&s, 0), NLC_OK));
    const double error = scene_error(&s, s.force, exact);
    if (verbose()) printf("%-8s forces to %.1e\n", names[_i], error);
    ck_assert(error <= 1e-12);
    free(exact);
    scene_free(&s);
}
END_TEST

/* The half-space at undeformed points has the same kernel, times the prefactor. */
START_TEST(prefactor)
{
    rng g = {36};
    scene s;
    stars(&s, &g, 20, 1, 30);
    double *force = random_forces(&s, &g), *w = sweep(&s, _i, force, true);
    s.options.model = NLC_MODEL_HALF_SPACE;
    s.options.points = NLC_POINTS_UNDEFORMED;
    s.options.prefactor = 4;
    double *v = sweep(&s, _i, force, true);
    for (int64_t e = 0; e < 2 * s.contacts; e++) nlc_assert_same(v[e], 4 * w[e]);
    free(force), free(w), free(v);
    scene_free(&s);
}
END_TEST

/* ---- bounds of eigenvalues */

static int64_t list_length(const nlc_network *n, int64_t k)
{
    return n->start[k + 1] - n->start[k];
}

static void mark_above(nlc_network *n, const double *root, const double *normal, double limit)
{
    for (int64_t k = 0; k < n->particle_count; k += NLC_WINDOW)
        n->settings.variant->mark_above(n, root, normal, limit, k, k + NLC_WINDOW < n->particle_count ? k + NLC_WINDOW : n->particle_count);
}

/*
 * Blocks with random slopes and shares: their largest eigenvalue, as the portable code finds it, is below a limit 1e-9 above it and
 * not below one 1e-9 below it.  Both decompositions are backward stable: some 24 2^-53 times the block's norm, which is at most
 * sqrt(24) times its largest eigenvalue in size here (positive and negative ones are about alike).
 */
START_TEST(blocks)
{
    rng g = {37};
    scene s;
    stars(&s, &g, 60, 1, 30);
    s.options.simd = _i;
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    nlc_network *n = s.network;
    const nlc_variant *v = n->settings.variant;
    double *root = malloc(2 * (size_t)s.contacts * sizeof *root);
    ck_assert_ptr_nonnull(root);
    nlc_set_units(n, 0, 0);
    for (int64_t c = 0; c < s.contacts; c++) {
        n->slope[c] = rng_below(&g, 6) ? rng_uniform(&g, 0, 1) * 1e9 : 0;
        n->share[2 * c] = rng_uniform(&g, 0.1, 0.9);
        n->share[2 * c + 1] = 1 - n->share[2 * c];
        for (int side = 0; side < 2; side++)
            root[2 * c + side] = sqrt(nlc_yield_of(n, side ? n->j[c] : n->i[c]) * n->slope[c] / n->share[2 * c + side]);
    }
    int shown = 0;
    for (int64_t k = 0; v && k < n->particle_count; k++) {
        const double b = nlc_block_eigenvalue(n, s.normal, k);
        if (list_length(n, k) < 2 || b <= 0) continue;
        nlc_assert_quiet(mark_above(n, root, s.normal, b * (1 - 1e-9)));
        ck_assert_int_eq(n->changed[k], 1);
        nlc_assert_quiet(mark_above(n, root, s.normal, b * (1 + 1e-9)));
        ck_assert(!n->changed[k] || list_length(n, k) > 24 - 8); /* it may be left open, but only a long one, or one beside it */
        shown += !n->changed[k];
    }
    ck_assert(!v || shown > 30);
    nlc_bound none = {INFINITY, -1, 0};
    nlc_assert_quiet(ck_assert(!nlc_bound_below(n, s.normal, 0, &none))); /* nothing that is coupled is below 0 */
    free(root);
    scene_free(&s);
}
END_TEST

/* What a sweep finds beside the displacements: the distance of the closest two directions, and the sum of squares. */
START_TEST(beside_the_sweep)
{
    rng g = {38};
    scene s;
    stars(&s, &g, 60, 1, 70);
    s.options.simd = _i;
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    nlc_network *n = s.network;
    int64_t culprit;
    nlc_set_units(n, 0, 0);
    for (int64_t c = 0; c < s.contacts; c++) {
        n->force[c] = n->share[2 * c] = rng_uniform(&g, 0, 1) * 1e4;
        n->share[2 * c + 1] = rng_uniform(&g, 0, 1);
    }
    nlc_assert_quiet(ck_assert_int_eq(nlc_displace_weighed(n, 1e4, s.normal, &culprit), NLC_OK));
    for (int64_t k = 0; k < n->particle_count; k++) {
        long double squares = 0, closest = 4;
        const nlc_material m = s.rows[s.material[k]];
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++)
            for (int64_t q = n->start[k]; q < p; q++) {
                const int64_t e = n->entry[p], f = n->entry[q];
                long double t = 0;
                for (int x = 0; x < 3; x++) {
                    const long double d = nlc_outward(e) * (long double)s.normal[3 * (e >> 1) + x] - nlc_outward(f) * (long double)s.normal[3 * (f >> 1) + x];
                    t += d * d;
                }
                const long double r = 1 / sqrtl(t), w = (long double)n->share[e | 1] * n->share[f | 1];
                const long double c = -4 * (1 - (long double)m.poisson) * r - 2 * (1 - 2 * (long double)m.poisson) + (7 - 8 * (long double)m.poisson) / 2 * t * r;
                squares += c * c * w;
                closest = t < closest ? t : closest;
            }
        if (n->closest[k] > 0) nlc_assert_rel(n->closest[k], (double)closest, 1e-14); /* a few roundings */
        if (!nlc_variant_of(n) || isinf(m.young) || n->norm[k] >= INFINITY) continue;
        nlc_assert_rel(n->norm[k], (double)squares, 1e-13); /* coefficients to some 1e-15, which cancel by a factor of a few */
        ck_assert(n->closest[k] > 0);
    }
    scene_free(&s);
}
END_TEST

/* One sphere with so many contacts, and an iteration in units that change no stiffness; half of the overlaps is applied. */
static nlc_iteration one_star(scene *s, rng *g, int contacts, int simd)
{
    stars(s, g, 1, contacts, contacts);
    s->options.simd = simd;
    ck_assert_int_eq(scene_build(s), NLC_OK);
    return (nlc_iteration){.n = s->network, .overlap = s->overlap, .normal = s->normal, .per_stiffness = 1, .load = 0.5};
}

/*
 * Residuals [GC] 10 and forces of the law in long double, to rounding: the root of an overlap that is off by 2^-53, and three products;
 * slopes of the chord to what one step of Halley's method is off, 2e-4 where forces differ by a quarter.  And the largest of them,
 * wherever in a vector each is.
 */
START_TEST(residuals)
{
    enum { COUNT = 21 };
    rng g = {39};
    scene s;
    const nlc_iteration q = one_star(&s, &g, COUNT, _i);
    nlc_network *n = s.network;
    const nlc_variant *v = n->settings.variant;
    for (int round = 0; round < 4 * COUNT && v; round++) {
        double z[COUNT], inverse[COUNT], force[COUNT], top = 0, most = 0;
        nlc_extremes found = {0, 0, false};
        bool far = false;
        for (int c = 0; c < COUNT; c++) {
            const bool open = rng_below(&g, 4) == 0;
            n->stiffness[c] = rng_uniform(&g, 1, 2);
            s.overlap[c] = open ? -1 : rng_uniform(&g, 0.5, 1) * (c == round % COUNT ? 8 : 1);
            n->current[c] = rng_uniform(&g, -0.1, 0.1);
            n->floor[c] = 0.01;
            n->force[c] = rng_uniform(&g, 0.1, 2); /* where it is open, far from its force */
            if (round >= COUNT && (round < 2 * COUNT || !open)) n->force[c] = open ? 0 : 0.4;
            if (round >= 3 * COUNT && c == round % COUNT) n->force[c] = -1;
        }
        int count = 0;
        nlc_assert_quiet(count = v->residuals(&q, 0, COUNT, z, inverse, force, &found));
        ck_assert(count > COUNT - 8 && count <= COUNT);
        for (int c = 0; c < count; c++) {
            const long double y = 0.5L * s.overlap[c] + n->current[c], law = y > 0 ? n->stiffness[c] * y * sqrtl(y) : 0;
            nlc_assert_abs(force[c], (double)law, 1e-15 * (double)law);
            nlc_assert_abs(z[c], (double)(law - n->force[c]), 1e-15 * (double)(law + fabsl(n->force[c])));
            const long double f = n->force[c];
            if (f > 0.8L * law && f < 1.25L * law && fabsl(f - law) > 1e-3L * law)
                nlc_assert_rel(inverse[c], (double)((y - powl(f / n->stiffness[c], 2 / 3.L)) / (law - f)), 2e-4);
            top = fmax(top, force[c]);
            most = fmax(most, fabs(z[c]));
            far |= n->force[c] < 0 || n->force[c] > NLC_FAR * force[c];
        }
        nlc_assert_same(found.force, top);
        nlc_assert_same(found.residual, most);
        ck_assert_int_eq(found.far, far);
    }
    scene_free(&s);
}
END_TEST

/*
 * The same of a start that may be the solution: forces [GC] 3 and slopes to rounding, by how much overlaps may grow exactly.  A
 * displacement that is too large, or an overlap that has grown, is seen wherever in a vector it is.
 */
START_TEST(starts)
{
    enum { COUNT = 21 };
    rng g = {40};
    scene s;
    const nlc_iteration q = one_star(&s, &g, COUNT, _i);
    nlc_network *n = s.network;
    const nlc_variant *v = n->settings.variant;
    double nonlocal[COUNT], U[COUNT], y[COUNT], size[COUNT], alone[COUNT], energy[COUNT], slope[COUNT];
    const nlc_guess guess = {nonlocal, 0.25};
    for (int round = 0; round < 3 * COUNT && v; round++) {
        nlc_view view = {0};
        int count = 0;
        for (int c = 0; c < COUNT; c++) {
            n->stiffness[c] = rng_uniform(&g, 1, 2);
            s.overlap[c] = rng_below(&g, 4) == 0 ? -1 : rng_uniform(&g, 0.5, 1);
            nonlocal[c] = rng_uniform(&g, -0.1, 0.1);
            U[c] = rng_uniform(&g, 0, 1);
            const double grown = 0.0025 * s.overlap[c] + 1e-4 + 0.25 * nonlocal[c]; /* half of what it may */
            n->side[2 * c] = rng_uniform(&g, 0, 1);
            n->side[2 * c + 1] = -n->side[2 * c] + (c != round % COUNT || round < COUNT || s.overlap[c] < 0 ? fmin(grown, 0.25 * nonlocal[c]) : 0.1);
            if (round >= 2 * COUNT && c == round % COUNT) n->side[2 * c] += round % 2 ? NLC_FARTHEST : -NLC_FARTHEST;
        }
        const int at = round % COUNT;
        nlc_assert_quiet(count = v->start(&q, &guess, 0, COUNT, U, y));
        ck_assert(count > COUNT - 8 && count <= COUNT);
        for (int c = 0; c < count; c++) {
            const long double x = 0.5L * s.overlap[c] + 0.25L * nonlocal[c], root = x > 0 ? sqrtl(x) : 0, k = n->stiffness[c];
            nlc_assert_abs(y[c], (double)x, 2e-16);
            nlc_assert_abs(n->force[c], (double)(k * root * root * root), 1e-15 * (double)(k * root));
            nlc_assert_same(n->share[2 * c], n->force[c]);
            nlc_assert_abs(n->share[2 * c + 1], (double)(1.5L * k * U[c] * (1.005L * root + 0.01L)), 1e-14 * (double)k);
        }
        nlc_assert_quiet(count = v->look(&q, &guess, 0, COUNT, size, alone, energy, slope, &view));
        ck_assert(count > COUNT - 8 && count <= COUNT);
        for (int c = 0; c < count; c++) {
            const long double moved = (long double)(n->side[2 * c] + n->side[2 * c + 1]), x = 0.5L * s.overlap[c];
            const long double positive = fmaxl(x + moved, 0), root = sqrtl(fminl(positive, NLC_FARTHEST)), k = n->stiffness[c], law = k * root * positive;
            const long double z = fabsl(law - n->force[c]);
            nlc_assert_abs(size[c], (double)z, 1e-15 * (double)(k + law));
            nlc_assert_abs(alone[c], (double)(moved > 0 ? x + moved : x), 2e-16 * (double)(1 + fabsl(moved)));
            nlc_assert_abs(energy[c], (double)(z * fabsl(moved - 0.25L * nonlocal[c])), 1e-15 * (double)((k + law) * (1 + fabsl(moved))));
            nlc_assert_abs(slope[c], (double)(1.5L * k * root), 1e-15 * (double)(k * (1 + root)));
        }
        ck_assert_int_eq(view.grown, at < count && round >= COUNT && (round < 2 * COUNT ? s.overlap[at] > 0 : round % 2));
        ck_assert_int_eq(view.lost, at < count && round >= 2 * COUNT);
    }
    scene_free(&s);
}
END_TEST

/*
 * What a look adds up of each particle, beside sums in long double: contacts in runs of one particle and in any order, of a particle with
 * itself, of walls.  Terms are positive, so that the sums are as good as their terms, and these as what has been rounded in them.
 */
START_TEST(sums_of_looks)
{
    enum { BALLS = 9, COUNT = 150 };
    rng g = {41};
    scene s;
    scene_init(&s);
    s.options.simd = _i;
    const int32_t m = scene_material(&s, 1e9, 0.3);
    for (int k = 0; k < BALLS; k++) scene_particle(&s, 1, m);
    const int32_t wall = BALLS + scene_wall(&s, m);
    for (int c = 0, i = 0; c < COUNT; c++) {
        if (rng_below(&g, 3) == 0) i = (int)rng_below(&g, BALLS);
        const int32_t other = rng_below(&g, 6) == 0 ? wall : rng_below(&g, 3) == 0 ? i : (int32_t)rng_below(&g, BALLS);
        double v[3];
        rng_unit(&g, v);
        scene_contact(&s, c % 5 ? i : other, c % 5 ? other : i, rng_uniform(&g, 0.5, 1), v[0], v[1], v[2]);
    }
    ck_assert_int_eq(scene_build(&s), NLC_OK);
    nlc_network *n = s.network;
    nlc_iteration q = {.n = n, .overlap = s.overlap, .normal = s.normal, .per_stiffness = 1, .load = 1};
    double nonlocal[COUNT];
    long double energy[BALLS] = {0}, slope[BALLS] = {0};
    for (int c = 0; c < COUNT; c++) {
        n->stiffness[c] = rng_uniform(&g, 1, 2);
        n->force[c] = nonlocal[c] = 0;
        n->side[2 * c] = n->side[2 * c + 1] = rng_uniform(&g, 0, 0.5);
        const long double moved = 2 * (long double)n->side[2 * c], root = sqrtl(s.overlap[c] + moved);
        const int32_t end[2] = {s.i[c], s.j[c]};
        for (int side = 0; side < 2; side++) {
            if (end[side] == wall) continue;
            energy[end[side]] += n->stiffness[c] * root * root * root * moved;
            slope[end[side]] = fmaxl(slope[end[side]], 1.5L * n->stiffness[c] * root);
        }
    }
    for (int k = 0; k < BALLS + 1; k++) n->largest[k] = 1;
    nlc_assert_quiet(nlc_look(&q, &(nlc_guess){nonlocal, 1}));
    for (int k = 0; k < BALLS; k++) {
        nlc_assert_rel(n->bound[k], (double)energy[k], 1e-14);
        nlc_assert_rel(n->growth[k], (double)slope[k], 1e-15);
    }
    scene_free(&s);
}
END_TEST

#if defined(__x86_64__) && defined(__GNUC__)
/* From its own words and the operating system's: XCR0 says which registers are kept when threads change. */
static void ask_processor(bool *avx2, bool *avx512)
{
    unsigned int a, b, c, d, kept, high;
    *avx2 = *avx512 = false;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_OSXSAVE) || !(c & bit_FMA)) return;
    __asm__ volatile("xgetbv" : "=a"(kept), "=d"(high) : "c"(0));
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return;
    *avx2 = (kept & 0x06) == 0x06 && (b & bit_AVX2);
    *avx512 = *avx2 && (kept & 0xe6) == 0xe6 && (b & bit_AVX512F);
}
#endif

START_TEST(choice)
{
    ck_assert_ptr_null(nlc_choose_variant(NLC_SIMD_GENERIC));
    const nlc_variant *best = nlc_choose_variant(NLC_SIMD_BEST);
    ck_assert(best == nlc_choose_variant(NLC_SIMD_AVX512) || best == nlc_choose_variant(NLC_SIMD_NEON));
#if defined(__x86_64__) && defined(__GNUC__)
    bool avx2, avx512;
    ask_processor(&avx2, &avx512);
    ck_assert(nlc_choose_variant(NLC_SIMD_AVX2) == (avx2 ? &nlc_variant_avx2 : NULL));
    ck_assert(nlc_choose_variant(NLC_SIMD_AVX512) == (avx512 ? &nlc_variant_avx512 : nlc_choose_variant(NLC_SIMD_AVX2)));
    ck_assert_ptr_null(nlc_choose_variant(NLC_SIMD_NEON));
#endif
    if (verbose())
        for (int simd = FIRST; simd < LAST; simd++) printf("%-8s %s\n", names[simd], is_here(simd) ? "here" : "-");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("simd");
    TCase *t = tcase_create("simd");
    tcase_add_checked_fixture(t, fp_trap, fp_untrap);
    tcase_add_test(t, choice);
    tcase_add_loop_test(t, every_number_of_contacts, FIRST, LAST);
    tcase_add_loop_test(t, lists_of_all_lengths, FIRST, LAST);
    tcase_add_loop_test(t, exchange_of_sides, FIRST, LAST);
    tcase_add_loop_test(t, coincidences, FIRST, LAST);
    tcase_add_loop_test(t, near_coincidences, FIRST, LAST);
    tcase_add_loop_test(t, solutions, FIRST, LAST);
    tcase_add_loop_test(t, prefactor, FIRST, LAST);
    tcase_add_loop_test(t, blocks, FIRST, LAST);
    tcase_add_loop_test(t, beside_the_sweep, FIRST, LAST);
    tcase_add_loop_test(t, residuals, FIRST, LAST);
    tcase_add_loop_test(t, starts, FIRST, LAST);
    tcase_add_loop_test(t, sums_of_looks, FIRST, LAST);
    time_limit(t, 60);
    suite_add_tcase(suite, t);
    return run_suite(suite);
}
