/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_scalar.c - the scalar functions of nlcontact.h against [GC] 1, 5, 7-11, 14 and [MC] 1
 *
 * One table describes the eight functions: how to call them, the exact value, how to draw arguments, what to try as special
 * values, and the error bound of the header.  The exact value is the equation as printed, in long double: 64 bits of mantissa
 * leave an error of less than 0.01 ulp, and with 15 bits of exponent no product of the arguments leaves the range.
 * (Where long double is no wider than double, what needs exact values is left out.)
 *
 * The tests, in this order: accuracy over random arguments; special values in all places; values computed elsewhere to 20
 * digits; the domain as the header words it; and properties, which would hold for a wrong formula's oracle too only by chance.
 *
 * NLC_TEST_VERBOSE prints the worst error of each function with its arguments; NLC_TEST_POINTS=1e8 looks longer for it and
 * NLC_TEST_SEED=7 elsewhere.
 */
#include "nlcontact.h"
#include "support.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define PI_LD 3.14159265358979323846264338327950288L
#define EPS 0x1p-52 /* an ulp is at most this part of a normal number, and at least half of it */

enum { MAX_ARGUMENTS = 13, MAX_SLOTS = 9, BATCH = 256 };

/* ------------------------------------------------------------------------------------------------------ exact values -- */

typedef struct outcome {
    long double value; /* NaN outside the domain */
    long double scale; /* the error counts in ulp of this: value, or the sum of absolute terms divided by the amplification */
    bool open;         /* the header leaves open whether this is in the domain: NaN is right, too */
} outcome;

static const outcome outside = {.value = NAN, .scale = NAN};

static outcome relative(long double value, bool open)
{
    return (outcome){.value = value, .scale = value, .open = open};
}

static bool poisson_ok(double nu)
{
    return nu >= 0 && nu <= 0.5;
}

/* A side of a Hertz contact: nu of a rigid one is looked at for NaN only. */
static bool side_ok(double E, double nu, double R)
{
    return E > 0 && R > 0 && !isnan(nu) && (isinf(E) || poisson_ok(nu));
}

static bool pair_ok(const double *side1, const double *side2)
{
    return side_ok(side1[0], side1[1], side1[2]) && side_ok(side2[0], side2[1], side2[2]) &&
           !(isinf(side1[0]) && isinf(side2[0])) && !(isinf(side1[2]) && isinf(side2[2]));
}

/* (1-nu^2)/E of a side, 0 if it is rigid */
static long double compliance(const double *side)
{
    return isinf(side[0]) ? 0 : (1 - (long double)side[1] * side[1]) / side[0];
}

static long double curvature(const double *side1, const double *side2)
{
    return 1 / (long double)side1[2] + 1 / (long double)side2[2];
}

/* [GC] 9; E1, nu1, R1, E2, nu2, R2 */
static outcome exact_stiffness(const double *x)
{
    if (!pair_ok(x, x + 3)) return outside;
    return relative(1 / (0.75L * (compliance(x) + compliance(x + 3)) * sqrtl(curvature(x, x + 3))), false);
}

/* [GC] 10; stiffness, overlap */
static outcome exact_force(const double *x)
{
    if (!(x[0] > 0 && isfinite(x[0])) || isnan(x[1])) return outside;
    return relative(x[1] > 0 ? (long double)x[0] * x[1] * sqrtl(x[1]) : 0, isinf(x[1]));
}

/* [GC] 7; stiffness, force */
static outcome exact_overlap(const double *x)
{
    if (!(x[0] > 0 && isfinite(x[0]) && x[1] >= 0)) return outside;
    const long double ratio = (long double)x[1] / x[0];
    return relative(cbrtl(ratio * ratio), isinf(x[1]));
}

/* [GC] 8; force, then the two sides */
static outcome exact_radius(const double *x)
{
    if (!(x[0] >= 0) || !pair_ok(x + 1, x + 4)) return outside;
    const long double cube = 0.75L * x[0] * (compliance(x + 1) + compliance(x + 4)) / curvature(x + 1, x + 4);
    return relative(cbrtl(cube), isinf(x[0]));
}

/* Young's modulus and Poisson's ratio of one body; sets *open where it is rigid with a ratio that would not be allowed */
static bool material_ok(double E, double nu, bool *open)
{
    if (isinf(E) && !isnan(nu) && !poisson_ok(nu)) *open = true;
    return E > 0 && !isnan(nu) && (isinf(E) || poisson_ok(nu));
}

/* [GC] 1; force, radius, r, E, nu */
static outcome exact_inside(const double *x)
{
    const long double P = x[0], a = x[1], r = x[2], E = x[3], nu = x[4];
    bool open = isinf(x[0]);
    if (!material_ok(x[3], x[4], &open) || isnan(x[0]) || !(a > 0 && isfinite(x[1]) && r >= 0 && r <= a)) return outside;
    return relative(3 * P * (1 - nu * nu) * (2 * a * a - r * r) / (8 * a * a * a * E), open);
}

/* [GC] 5 as a function of s = sin(theta/2) */
static outcome case_one(double force, long double s, double radius, double young, double poisson)
{
    const long double P = force, R = radius, E = young, nu = poisson;
    bool open = isinf(force);
    if (!material_ok(young, poisson, &open) || isnan(force) || !(R > 0)) return outside;
    if (isinf(young) || isinf(radius)) return (outcome){.value = open && isinf(force) ? NAN : 0, .open = open};
    const long double factor = (1 + nu) * P / (4 * PI_LD * R * E);
    return (outcome){.value = factor * (-2 * (1 - nu) - 2 * (1 - 2 * nu) * s + (7 - 8 * nu) * s * s) / s,
                     .scale = factor * (2 * (1 - nu) + 2 * (1 - 2 * nu) * s + (7 - 8 * nu) * s * s) / s,
                     .open = open};
}

/* force, theta, R, E, nu */
static outcome exact_nonlocal(const double *x)
{
    if (!(x[1] > 0 && x[1] <= PI)) return outside;
    return case_one(x[0], sinl((long double)x[1] / 2), x[2], x[3], x[4]);
}

static long double dot(const long double *a, const long double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static long double dot_absolute(const long double *a, const long double *b)
{
    return fabsl(a[0] * b[0]) + fabsl(a[1] * b[1]) + fabsl(a[2] * b[2]);
}

static void widen(long double to[3], const double from[3])
{
    for (int k = 0; k < 3; k++) to[k] = from[k];
}

/* | |n|^2 - 1 | <= 1e-6, either answer being right within rounding of the limit */
static bool unit_ok(const long double n[3], bool *open)
{
    const long double off = fabsl(dot(n, n) - 1);
    if (fabsl(off - 1e-6L) < 1e-15L) *open = true;
    return off <= 1e-6L + 1e-15L;
}

/* force, n_c, n_d, R, E, nu */
static outcome exact_between(const double *x)
{
    long double c[3], d[3], difference[3];
    bool open = false;
    widen(c, x + 1);
    widen(d, x + 4);
    for (int k = 0; k < 3; k++) difference[k] = c[k] - d[k];
    const long double s = sqrtl(dot(difference, difference)) / 2;
    if (!unit_ok(c, &open) || !unit_ok(d, &open) || !(s > 0)) return outside;
    outcome result = case_one(x[0], s, x[7], x[8], x[9]);
    result.open |= open;
    return result;
}

/*
 * [MC] 1; force, n_k, n_c, r_kc, E, nu, prefactor
 *
 * The terms in braces are dot products of unit vectors, so their absolute terms are those of the dot products, component by
 * component. One that is smaller than 2^-1022 may vanish altogether: FLOOR, which no factor makes visible that is not itself
 * above 2^900.
 */
#define FLOOR 0x1p-960L
static outcome exact_half_space(const double *x)
{
    const long double F = x[0], E = x[10], nu = x[11], G = x[12];
    long double k[3], c[3], u[3], sum[3], absolute[3];
    bool open = isinf(x[0]) || isinf(x[12]);
    widen(k, x + 1);
    widen(c, x + 4);
    widen(u, x + 7);
    const long double d = sqrtl(dot(u, u));
    if (!material_ok(x[10], x[11], &open) || isnan(x[0]) || !(G >= 0) || !unit_ok(k, &open) || !unit_ok(c, &open) || !(d > 0))
        return outside;
    if (isinf(d)) return (outcome){.value = NAN, .open = true};
    for (int i = 0; i < 3; i++) {
        u[i] /= d;
        sum[i] = k[i] + u[i];
        absolute[i] = fabsl(k[i]) + fabsl(u[i]);
    }
    const long double q = 1 + dot(k, u);
    if (fabsl(q) < 1e-15L) open = true;
    if (!(q > 0)) return open ? (outcome){.value = NAN, .open = true} : outside;
    if (isinf(x[10])) return (outcome){.value = open && (isinf(x[0]) || isinf(x[12])) ? NAN : 0, .open = open};
    const long double factor = -G * (1 + nu) * F / (2 * PI_LD * E * d);
    const long double braces = dot(k, u) * dot(c, u) + (3 - 4 * nu) * dot(k, c) - (1 - 2 * nu) * dot(sum, c) / q;
    const long double terms = FLOOR + dot_absolute(k, u) * dot_absolute(c, u) + (3 - 4 * nu) * dot_absolute(k, c) +
                              (1 - 2 * nu) * dot_absolute(absolute, c) / q;
    return (outcome){.value = factor * braces, .scale = factor * terms / fminl(q, 1), .open = open};
}

/* ------------------------------------------------------------------------------------------------ drawing arguments -- */

/* Where magnitudes come from. */
enum range {
    MODERATE, /* 2^-20 ... 2^20 */
    WIDE,     /* every exponent */
    MIXED,    /* each argument from another range */
    CORNER,   /* within 2^40 of an end of the range of double */
    RANGES
};

static double draw_size(rng *g, enum range range)
{
    switch (range) {
    case MODERATE:
        return rng_log(g, -20, 20);
    case WIDE:
        return rng_log(g, -1074, 1024);
    case CORNER:
        return rng_below(g, 2) ? rng_log(g, -1074, -1034) : rng_log(g, 984, 1024);
    default:
        return rng_below(g, 4) ? draw_size(g, (enum range)rng_below(g, RANGES - 1)) : rng_log(g, -1, 1);
    }
}

static double draw_force(rng *g, enum range range)
{
    const double sign = rng_sign(g); /* one draw an expression: C leaves the order of operands open */
    return sign * draw_size(g, range);
}

static double draw_change(rng *g, int low, int high)
{
    const double sign = rng_sign(g);
    return sign * rng_log(g, low, high);
}

static double draw_poisson(rng *g)
{
    switch (rng_below(g, 8)) {
    case 0:
        return 0;
    case 1:
        return 0.5;
    case 2:
        return 0.5 - rng_log(g, -60, -1);
    case 3:
        return rng_log(g, -1074, -1);
    default:
        return rng_uniform(g, 0, 0.5);
    }
}

static void draw_side(rng *g, double *side, enum range range)
{
    side[0] = draw_size(g, range);
    side[1] = draw_poisson(g);
    side[2] = draw_size(g, range);
}

/* Two sides, in one case out of four one of them rigid, in one out of four one of them flat. */
static void draw_pair(rng *g, double *sides, enum range range)
{
    draw_side(g, sides, range);
    draw_side(g, sides + 3, range);
    if (rng_below(g, 4) == 0) sides[rng_below(g, 2) * 3] = INFINITY;
    if (rng_below(g, 4) == 0) sides[rng_below(g, 2) * 3 + 2] = INFINITY;
}

static void draw_stiffness(rng *g, double *x, enum range range)
{
    draw_pair(g, x, range);
}

static void draw_two(rng *g, double *x, enum range range)
{
    x[0] = draw_size(g, range);
    x[1] = draw_size(g, range);
}

static void draw_radius(rng *g, double *x, enum range range)
{
    x[0] = draw_size(g, range);
    draw_pair(g, x + 1, range);
}

static void draw_inside(rng *g, double *x, enum range range)
{
    const double a = draw_size(g, range);
    const double small = rng_log(g, -60, 0), part = rng_uniform(g, 0, 1);
    const double choice[] = {0, a, nextafter(a, 0), a * small, a * part, a * part};
    x[0] = draw_force(g, range);
    x[1] = a;
    x[2] = choice[rng_below(g, sizeof choice / sizeof *choice)];
    x[3] = draw_size(g, range);
    x[4] = draw_poisson(g);
}

/* The angle at which [GC] 5 is zero. */
static double zero_angle(double poisson)
{
    const long double nu = poisson, b = 1 - 2 * nu, a = 7 - 8 * nu;
    return (double)(2 * asinl((b + sqrtl(b * b + 2 * (1 - nu) * a)) / a));
}

static double draw_angle(rng *g, double nu)
{
    switch (rng_below(g, 8)) {
    case 0:
        return PI;
    case 1:
        return PI - rng_log(g, -50, 1);
    case 2:
        return rng_log(g, -1074, 1);
    case 3:
        return rng_log(g, -30, 1);
    case 4:
        return zero_angle(nu) * (1 + draw_change(g, -52, -4));
    default:
        return rng_uniform(g, 0x1p-30, PI);
    }
}

static void draw_nonlocal(rng *g, double *x, enum range range)
{
    x[0] = draw_force(g, range);
    x[2] = draw_size(g, range);
    x[3] = draw_size(g, range);
    x[4] = draw_poisson(g);
    x[1] = draw_angle(g, x[4]);
}

static void normalize(double to[3], const long double from[3])
{
    const long double length = sqrtl(dot(from, from));
    for (int k = 0; k < 3; k++) to[k] = (double)(from[k] / length);
}

static void cross(long double to[3], const long double a[3], const long double b[3])
{
    for (int k = 0; k < 3; k++) to[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* A unit vector, one in four along an axis. */
static void draw_normal(rng *g, double n[3])
{
    rng_unit(g, n);
    if (rng_below(g, 4)) return;
    n[0] = n[1] = n[2] = 0;
    const double sign = rng_sign(g);
    n[rng_below(g, 3)] = sign;
}

/* A unit vector m at the given angle from n, in a random direction from it. */
static void draw_normal_at(rng *g, const double n[3], double angle, double m[3])
{
    long double a[3], b[3], t[3], length;
    widen(a, n);
    do {
        draw_normal(g, m);
        widen(b, m);
        cross(t, a, b);
        length = sqrtl(dot(t, t));
    } while (length < 1e-3L);
    for (int k = 0; k < 3; k++) b[k] = a[k] * cosl(angle) + t[k] / length * sinl(angle);
    normalize(m, b);
}

/* Lengthen or shorten as far as the contract allows, one in four. */
static void draw_length(rng *g, double n[3])
{
    if (rng_below(g, 4)) return;
    const double factor = 1 + rng_uniform(g, -4.99e-7, 4.99e-7);
    for (int k = 0; k < 3; k++) n[k] *= factor;
}

static void draw_between(rng *g, double *x, enum range range)
{
    double *c = x + 1, *d = x + 4;
    x[0] = draw_force(g, range);
    x[7] = draw_size(g, range);
    x[8] = draw_size(g, range);
    x[9] = draw_poisson(g);
    do {
        draw_normal(g, c);
        draw_normal_at(g, c, draw_angle(g, x[9]), d);
        if (rng_below(g, 8) == 0) { /* as close as two vectors can be */
            memcpy(d, c, 3 * sizeof *d);
            const uint64_t k = rng_below(g, 3);
            d[k] = nextafter(d[k], rng_sign(g));
        } else {
            draw_length(g, c);
            draw_length(g, d);
        }
    } while (!memcmp(c, d, 3 * sizeof *d));
}

static void draw_half_space(rng *g, double *x, enum range range)
{
    double *k = x + 1, *c = x + 4, *r = x + 7, u[3];
    x[0] = draw_force(g, range);
    x[10] = draw_size(g, range);
    x[11] = draw_poisson(g);
    x[12] = rng_below(g, 2) ? 1 : draw_size(g, range);
    draw_normal(g, k);
    double size = draw_size(g, range);
    switch (rng_below(g, 4)) {
    case 0: /* two contacts of a sphere */
        draw_normal_at(g, k, draw_angle(g, x[11]), c);
        while (!memcmp(k, c, sizeof u)) /* an angle that got lost in rounding */
            draw_normal(g, c);
        size = fmax(fmin(size, 0x1p1022), 0x1p-1020);
        for (int i = 0; i < 3; i++) r[i] = size * (k[i] - c[i]);
        break;
    case 1: /* anywhere */
        draw_normal(g, c);
        draw_normal(g, u);
        for (int i = 0; i < 3; i++) r[i] = size * u[i];
        break;
    case 2: /* components of very different sizes */
        draw_normal(g, c);
        for (int i = 0; i < 3; i++) r[i] = draw_force(g, range);
        break;
    default: /* u close to -n_k, where the last term grows, or at right angles to it */
        draw_normal_at(g, k, rng_below(g, 2) ? PI - rng_log(g, -20, 1) : PI / 2, u);
        if (rng_below(g, 2)) {
            draw_normal(g, c);
        } else { /* and at right angles to n_c: every term cancels within itself */
            long double a[3], b[3], t[3];
            widen(a, k);
            widen(b, u);
            cross(t, a, b);
            normalize(c, t);
        }
        for (int i = 0; i < 3; i++) r[i] = size * u[i];
    }
    draw_length(g, k);
    draw_length(g, c);
}

/* --------------------------------------------------------------------------------------------------- special values -- */

/* Values to be tried in one place: the first `valid` of them are in the domain of at least some calls. */
typedef struct kind {
    int width; /* 1, or 3 for a vector */
    int valid, count;
    const double *values;
} kind;

#define KIND(name, width_, valid_, ...)                                                                                        \
    static const double name##_values[] = {__VA_ARGS__};                                                                       \
    static const kind name = {width_, valid_, (int)(sizeof name##_values / sizeof *name##_values) / (width_), name##_values}

#define DENORM_MIN 0x1p-1074
#define BAD_NUMBERS INFINITY, -INFINITY, NAN

KIND(of_force, 1, 16, 1, -1, 0, -0.0, DENORM_MIN, -DENORM_MIN, 0x1.8p-1060, DBL_MIN, -DBL_MIN, 0x1.1p-540, 0x1.3p-200,
     -0x1.9p200, 0x1.7p540, 0x1p1023, DBL_MAX, -DBL_MAX, BAD_NUMBERS);
KIND(of_positive, 1, 12, 1, INFINITY, DENORM_MIN, 0x1.8p-1060, 0x0.fffffffffffffp-1022, DBL_MIN, 0x1.1p-540, 0x1.3p-200,
     0x1.9p200, 0x1.7p540, 0x1p1023, DBL_MAX, 0, -0.0, -DENORM_MIN, -1, -DBL_MAX, -INFINITY, NAN);
KIND(of_poisson, 1, 7, 0.3, 0, 0.5, -0.0, DENORM_MIN, 0x1.fffffffffffffp-2, 0x1p-30, 0x1.0000000000001p-1, -DENORM_MIN, 1, -1,
     DBL_MAX, BAD_NUMBERS);
KIND(of_r, 1, 12, 0, -0.0, 1, DENORM_MIN, 0x1.8p-1060, DBL_MIN, 0x1.1p-540, 0x1.3p-200, 0x1.9p200, 0x1.7p540, 0x1p1023, DBL_MAX,
     0x1.0000000000001p0, -DENORM_MIN, -1, -DBL_MAX, BAD_NUMBERS);
KIND(of_angle, 1, 9, PI, PI / 2, 1, 0x1.668p0, 0x1p-27, 0x1p-540, DBL_MIN, 3 * DENORM_MIN, DENORM_MIN, 0x1.921fb54442d19p1, 4,
     DBL_MAX, 0, -0.0, -DENORM_MIN, -1, BAD_NUMBERS);
/* clang-format off */
KIND(of_normal, 3, 12,
     1, 0, 0,   -1, 0, 0,   0, 1, 0,   0, -0.0, -1,   1, DENORM_MIN, 0,   1, 0x1p-600, -DENORM_MIN,
     0x1.fffffffffffffp-1, 0, 0,   0x1.0000000000001p0, 0, 0,   0.6, 0.8, 0,   -0.48, 0.6, 0.64,
     1 + 4.9e-7, 0, 0,   0, 0, -1 + 4.9e-7,
     /* not valid: */
     1 + 5.1e-7, 0, 0,   0, 1 - 5.1e-7, 0,   0, 0, 0,   -0.0, 0, DENORM_MIN,   2, 0, 0,   1, 1, 0,   DBL_MAX, -DBL_MAX, DBL_MAX,
     INFINITY, 0, 0,   -INFINITY, INFINITY, 1,   NAN, 0, 0,   1, NAN, 0,   0, 1, NAN,   NAN, INFINITY, 1);
KIND(of_vector, 3, 12,
     1, 0, 0,   -1, 0, 0,   DENORM_MIN, 0, 0,   0, -DENORM_MIN, DENORM_MIN,   0x1.8p-1060, 0x1p-1060, -0x1p-1050,
     0, DBL_MIN, 0,   0x1p-600, 0x1p600, -0x1p-600,   DBL_MAX, DBL_MAX, -DBL_MAX,   DBL_MAX, -DENORM_MIN, 1,   0.6, 0, -0.8,
     0x1.1p-540, 0x1.3p-541, 0,   0x1.7p540, -0x1.2p540, 0x1p540,
     /* not valid: */
     0, 0, 0,   0, -0.0, 0,   INFINITY, 0, 0,   -INFINITY, INFINITY, 1,   NAN, 0, 0,   1, NAN, 0,   0, 0, NAN);
/* clang-format on */

/* --------------------------------------------------------------------------------------------------- the functions -- */

static double call_stiffness(const double *x)
{
    return nlc_hertz_stiffness(x[0], x[1], x[2], x[3], x[4], x[5]);
}

static double call_force(const double *x)
{
    return nlc_hertz_force(x[0], x[1]);
}

static double call_overlap(const double *x)
{
    return nlc_hertz_overlap(x[0], x[1]);
}

static double call_radius(const double *x)
{
    return nlc_contact_radius(x[0], x[1], x[2], x[3], x[4], x[5], x[6]);
}

static double call_inside(const double *x)
{
    return nlc_contact_displacement(x[0], x[1], x[2], x[3], x[4]);
}

static double call_nonlocal(const double *x)
{
    return nlc_nonlocal_displacement(x[0], x[1], x[2], x[3], x[4]);
}

static double call_between(const double *x)
{
    return nlc_nonlocal_displacement_between(x[0], x + 1, x + 4, x[7], x[8], x[9]);
}

static double call_half_space(const double *x)
{
    return nlc_half_space_displacement(x[0], x + 1, x + 4, x + 7, x[10], x[11], x[12]);
}

typedef struct function {
    const char *name;
    double bound; /* of the header [ulp of outcome.scale] */
    double (*call)(const double *x);
    outcome (*exact)(const double *x);
    void (*draw)(rng *g, double *x, enum range range);
    double power; /* result ~ (arguments aim[0] and aim[1])^(1/power): to hit the ends of the range */
    int aim[2];
    const kind *slots[MAX_SLOTS + 1]; /* NULL at the end */
} function;

enum { STIFFNESS, FORCE, OVERLAP, RADIUS, INSIDE, NONLOCAL, BETWEEN, HALF_SPACE, FUNCTIONS };

static const function functions[FUNCTIONS] = {
    [STIFFNESS] = {"nlc_hertz_stiffness",
                   7,
                   call_stiffness,
                   exact_stiffness,
                   draw_stiffness,
                   1,
                   {0, 3},
                   {&of_positive, &of_poisson, &of_positive, &of_positive, &of_poisson, &of_positive}},
    [FORCE] = {"nlc_hertz_force", 2.2, call_force, exact_force, draw_two, 1, {0, 0}, {&of_positive, &of_force}},
    [OVERLAP] = {"nlc_hertz_overlap", 1.1, call_overlap, exact_overlap, draw_two, 1.5, {1, 1}, {&of_positive, &of_force}},
    [RADIUS] = {"nlc_contact_radius",
                3,
                call_radius,
                exact_radius,
                draw_radius,
                3,
                {0, 0},
                {&of_force, &of_positive, &of_poisson, &of_positive, &of_positive, &of_poisson, &of_positive}},
    [INSIDE] = {"nlc_contact_displacement",
                7.5,
                call_inside,
                exact_inside,
                draw_inside,
                1,
                {0, 0},
                {&of_force, &of_positive, &of_r, &of_positive, &of_poisson}},
    [NONLOCAL] = {"nlc_nonlocal_displacement",
                  8.5,
                  call_nonlocal,
                  exact_nonlocal,
                  draw_nonlocal,
                  1,
                  {0, 0},
                  {&of_force, &of_angle, &of_positive, &of_positive, &of_poisson}},
    [BETWEEN] = {"nlc_nonlocal_displacement_between",
                 9.5,
                 call_between,
                 exact_between,
                 draw_between,
                 1,
                 {0, 0},
                 {&of_force, &of_normal, &of_normal, &of_positive, &of_positive, &of_poisson}},
    [HALF_SPACE] = {"nlc_half_space_displacement",
                    17,
                    call_half_space,
                    exact_half_space,
                    draw_half_space,
                    1,
                    {0, 0},
                    {&of_force, &of_normal, &of_normal, &of_vector, &of_positive, &of_poisson, &of_positive}},
};

/* The error promised, as a part of the result (or of its scale): what the tolerances of the properties are made of. */
static double error_of(int which)
{
    return functions[which].bound * EPS;
}

static int argument_count(const function *f)
{
    int count = 0;
    for (int k = 0; f->slots[k]; k++) count += f->slots[k]->width;
    return count;
}

/* The call as text, in a static buffer. */
static const char *text_of_call(const function *f, const double *x)
{
    static char text[1024];
    int length = snprintf(text, sizeof text, "%s(", f->name);
    for (int k = 0, at = 0; f->slots[k]; k++)
        for (int i = 0; i < f->slots[k]->width; i++) {
            const bool first = i == 0, vector = f->slots[k]->width == 3;
            length += snprintf(text + length, sizeof text - (size_t)length, "%s%s%a%s", k || !first ? ", " : "",
                               vector && first ? "{" : "", x[at++], vector && i == 2 ? "}" : "");
        }
    snprintf(text + length, sizeof text - (size_t)length, ")");
    return text;
}

/* Call it n times; no call may raise a forbidden exception or touch errno. */
static void run(const function *f, double (*x)[MAX_ARGUMENTS], double *y, int n)
{
    fp_begin();
    for (int b = 0; b < n; b++) y[b] = f->call(x[b]);
    if (!*fp_end()) return;
    for (int b = 0; b < n; b++) {
        fp_begin();
        f->call(x[b]);
        const char *raised = fp_end();
        if (*raised) ck_abort_msg("%s raises or changes: %s", text_of_call(f, x[b]), raised);
    }
    ck_abort_msg("%s: what it raises does not come again", f->name);
}

/* The error in ulp, INFINITY if the result is of the wrong class. */
static double judge(const function *f, const double *x, double y)
{
    if (!long_double_is_wider()) return 0;
    const outcome exact = f->exact(x);
    if (isnan(exact.value) && exact.open) return isfinite(y) && y != 0 ? INFINITY : 0;
    if (isnan(exact.value)) return isnan(y) ? 0 : INFINITY;
    if (isnan(y) && exact.open) return 0;
    if (isinf(exact.value)) return isinf(y) && signbit(y) == signbit(exact.value) ? 0 : INFINITY;
    return ulp_error(y, exact.value, exact.scale);
}

static void fail_at(const function *f, const double *x, double y, double error)
{
    const outcome exact = f->exact(x);
    ck_abort_msg("%s\n    = %a (%.17g)\n    exact %La (%.20Lg)%s, scale %.5Lg\n    error %.4g ulp of scale, bound %g",
                 text_of_call(f, x), y, y, exact.value, exact.value, exact.open ? " or NaN" : "", exact.scale, error, f->bound);
}

static uint64_t seed(void)
{
    const char *text = getenv("NLC_TEST_SEED");
    return text ? strtoull(text, NULL, 0) : 20111001;
}

/* ---------------------------------------------------------------------------------------------------------- accuracy -- */

/* Scale the arguments in aim[] so that the result gets a random exponent: half of them at the ends of the range of double. */
static void aim(rng *g, const function *f, double *x)
{
    const outcome exact = f->exact(x);
    const long double value = exact.value != 0 ? exact.value : exact.scale;
    if (!(value != 0) || isinf(value)) return;
    int now;
    frexpl(value, &now);
    const uint64_t where = rng_below(g, 4);
    const int wanted = where == 0   ? -1076 + (int)rng_below(g, 60)
                       : where == 1 ? 1016 + (int)rng_below(g, 10)
                                    : -1076 + (int)rng_below(g, 2102);
    const int shift = (int)lrint(f->power * (wanted - now));
    for (int k = 0; k < 2 && (k == 0 || f->aim[k] != f->aim[0]); k++) {
        double *a = &x[f->aim[k]];
        if (isinf(*a)) continue;
        const double scaled = ldexp(*a, shift);
        *a = isinf(scaled) ? copysign(DBL_MAX, *a) : scaled == 0 ? copysign(DENORM_MIN, *a) : scaled;
    }
}

/*
 * Random arguments, a quarter each from four ranges, in half of the cases scaled so that the result lies anywhere between
 * underflow and overflow.  Tolerance: the header's bound.
 */
START_TEST(accuracy)
{
    const function *f = &functions[_i];
    static double x[BATCH][MAX_ARGUMENTS], y[BATCH];
    double worst = 0, worst_y = 0, worst_x[MAX_ARGUMENTS] = {0};
    rng g = {seed() + (uint64_t)_i};
    const uint64_t wanted = points(200000);
    for (uint64_t done = 0; done < wanted; done += BATCH) {
        for (int b = 0; b < BATCH; b++) {
            f->draw(&g, x[b], (enum range)(b % RANGES));
            if (b / RANGES % 2) aim(&g, f, x[b]);
        }
        run(f, x, y, BATCH);
        for (int b = 0; b < BATCH; b++) {
            const double error = judge(f, x[b], y[b]);
            if (!(error > worst)) continue;
            worst = error;
            worst_y = y[b];
            memcpy(worst_x, x[b], sizeof worst_x);
        }
    }
    if (verbose()) {
        printf("worst %.4f ulp, bound %g: %s = %a\n", worst, f->bound, text_of_call(f, worst_x), worst_y);
        fflush(stdout);
    }
    if (!(worst <= f->bound)) fail_at(f, worst_x, worst_y, worst);
}
END_TEST

/* Change one or two arguments a little, or take one of them from another draw. */
static void disturb(rng *g, const function *f, double *x)
{
    for (uint64_t changes = 1 + rng_below(g, 2); changes > 0; changes--) {
        const uint64_t k = rng_below(g, (uint64_t)argument_count(f));
        if (rng_below(g, 3)) {
            x[k] *= 1 + draw_change(g, -52, -1);
        } else {
            double other[MAX_ARGUMENTS] = {0};
            f->draw(g, other, MODERATE);
            x[k] = other[k];
        }
    }
}

/*
 * Uphill: from the worst of a few random points by small random changes to a worse one, until there has been none for long.
 * Finds in seconds what random points do not show in hours, since the roundings must all go the same way.  Tolerance: the
 * header's bound.
 */
START_TEST(search)
{
    const function *f = &functions[_i];
    double worst = 0, worst_x[MAX_ARGUMENTS] = {0}, x[MAX_ARGUMENTS] = {0}, here = -1;
    rng g = {seed() + 50 + (uint64_t)_i};
    int tried = 0;
    for (uint64_t left = points(100000); left > 0; left--, tried++) {
        if (tried == 2000) {
            here = -1;
            tried = 0;
        }
        double y[MAX_ARGUMENTS];
        memcpy(y, x, sizeof y);
        if (tried < 50)
            f->draw(&g, y, MODERATE);
        else
            disturb(&g, f, y);
        const outcome exact = f->exact(y);
        if (isnan(exact.value) || exact.open) continue;
        const double error = judge(f, y, f->call(y));
        if (!(error >= here)) continue;
        if (error > here && tried >= 50) tried = 50;
        here = error;
        memcpy(x, y, sizeof x);
        if (!(error > worst)) continue;
        worst = error;
        memcpy(worst_x, y, sizeof worst_x);
    }
    if (verbose()) {
        printf("search: %.4f ulp, bound %g: %s = %a\n", worst, f->bound, text_of_call(f, worst_x), f->call(worst_x));
        fflush(stdout);
    }
    if (!(worst <= f->bound)) fail_at(f, worst_x, f->call(worst_x), worst);
}
END_TEST

/* The worst that 1e8 points of accuracy() and 1e9 of search() have found. */
static const struct {
    int function;
    double error; /* [ulp], on x86-64 with glibc 2.36 */
    double x[MAX_ARGUMENTS];
} hardest[] = {
    {STIFFNESS,
     6.62,
     {0x1.363409608f643p+18, 0x1.20c37d2f705bp-2, 0x1.ffffffffff6bdp-17, 0x1.301ebad41278p+8, 0x1.d2dd3159f1159p-2,
      0x1.0aaa76c7756d3p+6}},
    {FORCE, 2.18, {0x1.6a39744d69882p+17, 0x1.ffad8eda025d1p+6}},
    {OVERLAP, 1.02, {0x1.fffffffffff77p-3, 0x1.00000d0334e3p+2}},
    {RADIUS,
     2.74,
     {0x1.56142c4045136p+5, 0x1.7ce023c4feee4p-19, 0x1.fffffffedafb7p-2, 0x1.dfc3f07e19d53p+0, 0x1.de1d7a624b477p+3,
      0x1.f93799a24ad2ep-2, 0x1.baee4d2cc7ee8p+10}},
    {INSIDE,
     7.24,
     {-0x1.596bcdaf7c8d6p-20, 0x1.04be0a7cb85d9p+7, 0x1.04bdecf1fdd96p+7, 0x1.af8dd8654ab9ap+9, 0x1.8f7f1424e569p-2}},
    {NONLOCAL,
     8.03,
     {-0x1.001f0f015432bp-6, 0x1.00000000df8f4p-24, 0x1.a2d8bd06985b7p-17, 0x1.8eae8f5346df5p+8, 0x1.20bd6f5b3d0c1p-37}},
    {BETWEEN,
     9.09,
     {-0x1.01bb87499a3cdp-18, 0, 0x1.fffffdfc78641p-1, 0, -0x1.69d4215f72aaep-51, 0x1.00000000000d3p+0, 0x1.0b69752e55f8ap-37,
      0x1.f9ae8ee3e87d7p-12, 0x1.4d48d9847d8ccp+13, 0x1.cf2a62188218dp-42}},
    {HALF_SPACE,
     15.75,
     {0x1.83b9a79c27464p-9, 0, 0, -0x1.fffffffff2a3bp-1, -0x1.0000011c03b96p+0, 0x1.21babfa22d2ep-14, 0, -0x1.081d92550ccc3p+9,
      0x1.680b721e7d77ep-12, -0x1.47aff321fd505p-7, 0x1.aa57117d3d4d7p+0, 0x1.ffffffffffe02p-2, 0x1.e8559e0f9d926p-2}},
};

/* Tolerance: the header's bound.  (That the error is what it was is not asked: a better library is welcome.) */
START_TEST(hardest_known)
{
    const function *f = &functions[hardest[_i].function];
    const double *x = hardest[_i].x, y = f->call(x), error = judge(f, x, y);
    if (verbose()) {
        printf("hardest: %.4f ulp, was %.2f, bound %g: %s\n", error, hardest[_i].error, f->bound, text_of_call(f, x));
        fflush(stdout);
    }
    if (!(error <= f->bound)) fail_at(f, x, y, error);
    ck_assert_double_le(hardest[_i].error, f->bound);
}
END_TEST

/* The draws of accuracy() are meant to be inside the domain: a generator gone wrong would test nothing. */
START_TEST(draws_are_valid)
{
    const function *f = &functions[_i];
    rng g = {seed() + (uint64_t)_i};
    int inside = 0, finite = 0, total = 4000;
    for (int b = 0; b < total; b++) {
        double x[MAX_ARGUMENTS] = {0};
        f->draw(&g, x, (enum range)(b % RANGES));
        if (b / RANGES % 2) aim(&g, f, x);
        const outcome exact = f->exact(x);
        inside += !isnan(exact.value) && !exact.open;
        finite += fabsl(exact.value) >= DENORM_MIN && fabsl(exact.value) <= DBL_MAX;
    }
    if (verbose()) printf("%s: %d of %d draws are valid, %d with a result in range\n", f->name, inside, total, finite);
    ck_assert_int_ge(inside, total * 9 / 10);
    ck_assert_int_ge(finite, total / 2);
}
END_TEST

/* --------------------------------------------------------------------------------------------------- special values -- */

/*
 * Every combination of special values in all places, or a sample if there are more than a million: half of the sample from
 * valid values only, in the other half each place has one chance in five of an invalid one. Tolerance: the right class (NaN,
 * infinite, finite), and where it is finite the header's bound.
 */
START_TEST(special_values)
{
    const function *f = &functions[_i];
    static double x[BATCH][MAX_ARGUMENTS], y[BATCH];
    double combinations = 1;
    for (int k = 0; f->slots[k]; k++) combinations *= f->slots[k]->count;
    const double limit = (double)points(1000000);
    const bool all = combinations <= limit;
    const uint64_t total = all ? (uint64_t)combinations : points(200000);
    rng g = {seed() + 100 + (uint64_t)_i};
    for (uint64_t done = 0; done < total;) {
        int n = 0;
        for (; n < BATCH && done < total; n++, done++) {
            uint64_t index = done;
            const bool valid_only = rng_below(&g, 2);
            for (int k = 0, at = 0; f->slots[k]; at += f->slots[k]->width, k++) {
                const kind *slot = f->slots[k];
                const bool valid = valid_only || rng_below(&g, 5);
                const uint64_t which =
                    all ? index % (uint64_t)slot->count : rng_below(&g, (uint64_t)(valid ? slot->valid : slot->count));
                index /= (uint64_t)slot->count;
                memcpy(x[n] + at, slot->values + which * (uint64_t)slot->width, (size_t)slot->width * sizeof(double));
            }
        }
        run(f, x, y, n);
        for (int b = 0; b < n; b++) {
            const double error = judge(f, x[b], y[b]);
            if (!(error <= f->bound)) fail_at(f, x[b], y[b], error);
        }
    }
}
END_TEST

/* The same with traps on, nothing but the calls: a flag that is raised and cleared again ends the test with SIGFPE. */
START_TEST(special_values_trapped)
{
    const function *f = &functions[_i];
    rng g = {seed() + 200 + (uint64_t)_i};
    volatile double sink;
    for (int done = 0; done < 50000; done++) {
        double x[MAX_ARGUMENTS];
        for (int k = 0, at = 0; f->slots[k]; at += f->slots[k]->width, k++) {
            const kind *slot = f->slots[k];
            const uint64_t which = rng_below(&g, (uint64_t)(rng_below(&g, 5) ? slot->valid : slot->count));
            memcpy(x + at, slot->values + which * (uint64_t)slot->width, (size_t)slot->width * sizeof(double));
        }
        sink = f->call(x);
    }
    (void)sink;
}
END_TEST

/* NaN in each place, everything else being good, is NaN. */
START_TEST(nan_in_each_place)
{
    const function *f = &functions[_i];
    rng g = {seed()};
    for (int round = 0; round < 200; round++) {
        double x[MAX_ARGUMENTS];
        do f->draw(&g, x, MODERATE);
        while (isnan(f->exact(x).value));
        if (isnan(f->call(x))) ck_abort_msg("%s is NaN", text_of_call(f, x));
        for (int k = 0; k < argument_count(f); k++) {
            const double good = x[k];
            double result = 0;
            x[k] = rng_sign(&g) * NAN;
            nlc_assert_quiet(result = f->call(x));
            if (!isnan(result)) fail_at(f, x, result, INFINITY);
            x[k] = good;
        }
    }
}
END_TEST

/* ------------------------------------------------------------------------------------------- values from elsewhere -- */

/*
 * The equations evaluated with 40 digits by a program of its own (arguments are the doubles nearest to the decimals), here to
 * 20 digits.  Tolerance: the header's bound, plus half an ulp for the constant itself; where terms cancel, the bound times the
 * ratio of the sum of the absolute terms to the result, which is at most 14 here.
 */
START_TEST(known_values)
{
    const double E = 1.85e6, x[3] = {1, 0, 0}, yz[3] = {0, 0.6, 0.8}, down[3] = {0, 0, -1}, r[3] = {0.002, -0.005, -0.014};
    nlc_assert_rel(nlc_hertz_stiffness(E, 0.46, 0.01, INFINITY, 0, INFINITY), 312869.94757314393073,
                   error_of(STIFFNESS) + EPS / 2);
    nlc_assert_rel(nlc_hertz_stiffness(2.1e11, 0.3, 0.003, 7e10, 0.25, 0.0125), 3699756226.0478206178,
                   error_of(STIFFNESS) + EPS / 2);
    nlc_assert_rel(nlc_hertz_force(1e9, 1e-5), 31.6227766016837972, error_of(FORCE) + EPS / 2);
    nlc_assert_rel(nlc_hertz_overlap(1e9, 2.5), 1.8420157493201933029e-6, error_of(OVERLAP) + EPS / 2);
    nlc_assert_rel(nlc_contact_radius(12.5, 2.1e11, 0.3, 0.003, 7e10, 0.25, 0.0125), 7.3806637351669193805e-5,
                   error_of(RADIUS) + EPS / 2);
    nlc_assert_rel(nlc_contact_displacement(12.5, 1e-4, 6e-5, 2.1e11, 0.3), 3.3312499999999998978e-7,
                   error_of(INSIDE) + EPS / 2);
    nlc_assert_rel(nlc_nonlocal_displacement(3, 1, 0.01, E, 0.46), -1.5468114628129827697e-5, 14 * error_of(NONLOCAL));
    nlc_assert_rel(nlc_nonlocal_displacement(-3, 2.5, 0.01, E, 0.1), -3.3882382422042417249e-5, 14 * error_of(NONLOCAL));
    nlc_assert_rel(nlc_nonlocal_displacement_between(3, x, yz, 0.01, E, 0.3), 7.9314633778688418326e-6, 14 * error_of(BETWEEN));
    nlc_assert_rel(nlc_half_space_displacement(3, down, yz, r, E, 0.3, 0.6), 2.6333647345012991819e-5,
                   14 * error_of(HALF_SPACE));
}
END_TEST

/* The figures in the header and those asserted here are the same.  (Where there is no source tree, there is nothing to
 * compare.) */
START_TEST(bounds_of_the_header)
{
    static char text[1 << 18];
    FILE *file = fopen(NLC_SOURCE_DIR "/include/nlcontact.h", "r");
    if (!file) return;
    const size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[length] = 0;
    char wrong[1024] = "";
    for (const function *f = functions; f < functions + FUNCTIONS; f++) {
        char declaration[64];
        snprintf(declaration, sizeof declaration, "double %s(", f->name);
        char *end = strstr(text, declaration), *found = NULL;
        ck_assert_ptr_nonnull(end);
        for (char *p = text; (p = strstr(p, "orst error ")) && p < end; p++) found = p + strlen("orst error ");
        ck_assert_ptr_nonnull(found);
        const double said = strtod(found, NULL);
        if (said == f->bound) continue;
        const size_t used = strlen(wrong);
        snprintf(wrong + used, sizeof wrong - used, "\n    %s: the header says %g, here it is %g", f->name, said, f->bound);
    }
    ck_assert_msg(!*wrong, "%s", wrong);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------ domain -- */

#define assert_nan(...)                                                                                                        \
    do {                                                                                                                       \
        double assert_y_ = 0;                                                                                                  \
        nlc_assert_quiet(assert_y_ = (__VA_ARGS__));                                                                           \
        if (!isnan(assert_y_)) ck_abort_msg("%s = %a, not NaN", #__VA_ARGS__, assert_y_);                                      \
    } while (0)

#define assert_value(value, ...)                                                                                               \
    do {                                                                                                                       \
        double assert_y_ = NAN;                                                                                                \
        nlc_assert_quiet(assert_y_ = (__VA_ARGS__));                                                                           \
        nlc_assert_same(assert_y_ + 0.0, (value)); /* -0 + 0 is 0 */                                                           \
    } while (0)

/* The header's words, one by one; the oracles above are not asked.  Values are exact. */
START_TEST(domain_hertz)
{
    const double inf = INFINITY, below = -DENORM_MIN, above_half = nextafter(0.5, 1);
    assert_nan(nlc_hertz_stiffness(inf, 0.3, 1, inf, 0.3, 1)); /* two rigid sides */
    assert_nan(nlc_hertz_stiffness(1, 0.3, inf, 1, 0.3, inf)); /* two flat sides */
    assert_nan(nlc_contact_radius(1, inf, 0.3, 1, inf, 0.3, 1));
    assert_nan(nlc_contact_radius(1, 1, 0.3, inf, 1, 0.3, inf));
    for (int side = 0; side < 2; side++) {
        const double bad[][3] = {{0, 0.3, 1},   {-0.0, 0.3, 1},     {below, 0.3, 1}, {-inf, 0.3, 1},
                                 {1, below, 1}, {1, above_half, 1}, {1, -0.1, 1},    {1, 0.6, 1},
                                 {1, inf, 1},   {1, 0.3, 0},        {1, 0.3, -0.0},  {1, 0.3, below},
                                 {1, 0.3, -1},  {1, 0.3, -inf},     {inf, NAN, 1},   {inf, 0.3, below}};
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
            const double *b = bad[k];
            assert_nan(side ? nlc_hertz_stiffness(1, 0.3, 1, b[0], b[1], b[2])
                            : nlc_hertz_stiffness(b[0], b[1], b[2], 1, 0.3, 1));
            assert_nan(side ? nlc_contact_radius(1, 1, 0.3, 1, b[0], b[1], b[2])
                            : nlc_contact_radius(1, b[0], b[1], b[2], 1, 0.3, 1));
        }
        for (int k = 0; k < 3; k++) { /* not looked at on a rigid side */
            const double nu = (double[]){-7, 0.7, inf}[k];
            nlc_assert_same(side ? nlc_hertz_stiffness(2, 0.3, 3, inf, nu, 4) : nlc_hertz_stiffness(inf, nu, 4, 2, 0.3, 3),
                            nlc_hertz_stiffness(2, 0.3, 3, inf, 0.3, 4));
            nlc_assert_same(side ? nlc_contact_radius(5, 2, 0.3, 3, inf, nu, 4) : nlc_contact_radius(5, inf, nu, 4, 2, 0.3, 3),
                            nlc_contact_radius(5, 2, 0.3, 3, inf, 0.3, 4));
        }
    }
    assert_value(inf, nlc_hertz_stiffness(DBL_MAX, 0.5, DBL_MAX, DBL_MAX, 0, 1e300));
    assert_value(0, nlc_hertz_stiffness(DENORM_MIN, 0, 0.01, DENORM_MIN, 0, 0.01));

    assert_nan(nlc_hertz_force(0, 1));
    assert_nan(nlc_hertz_force(-1, 1));
    assert_nan(nlc_hertz_force(inf, 1));
    assert_nan(nlc_hertz_force(-1, -1)); /* a gap does not excuse a bad stiffness */
    assert_nan(nlc_hertz_force(NAN, -1));
    assert_value(0, nlc_hertz_force(1, 0));
    assert_value(0, nlc_hertz_force(1, -0.0));
    assert_value(0, nlc_hertz_force(DBL_MAX, -DENORM_MIN));
    assert_value(inf, nlc_hertz_force(1, DBL_MAX));
    assert_value(0, nlc_hertz_force(1, DENORM_MIN));
    assert_value(8, nlc_hertz_force(1, 4));

    assert_nan(nlc_hertz_overlap(0, 1));
    assert_nan(nlc_hertz_overlap(-1, 1));
    assert_nan(nlc_hertz_overlap(inf, 1));
    assert_nan(nlc_hertz_overlap(1, -1));
    assert_nan(nlc_hertz_overlap(1, -DENORM_MIN));
    assert_nan(nlc_hertz_overlap(1, -inf));
    assert_value(0, nlc_hertz_overlap(DENORM_MIN, 0));
    assert_value(0, nlc_hertz_overlap(1, -0.0));
    assert_value(inf, nlc_hertz_overlap(DENORM_MIN, DBL_MAX));
    assert_value(0, nlc_hertz_overlap(DBL_MAX, DENORM_MIN));
    assert_value(4, nlc_hertz_overlap(1, 8));

    assert_nan(nlc_contact_radius(-1, 1, 0.3, 1, 1, 0.3, 1));
    assert_nan(nlc_contact_radius(-DENORM_MIN, 1, 0.3, 1, 1, 0.3, 1));
    assert_nan(nlc_contact_radius(-inf, 1, 0.3, 1, 1, 0.3, 1));
    assert_value(0, nlc_contact_radius(0, 1, 0.3, 1, 1, 0.3, 1));
    assert_value(inf, nlc_contact_radius(DBL_MAX, DENORM_MIN, 0, inf, DENORM_MIN, 0, DBL_MAX));
}
END_TEST

START_TEST(domain_displacement)
{
    const double inf = INFINITY, a = 0.7, above_half = nextafter(0.5, 1);
    assert_nan(nlc_contact_displacement(1, 0, 0, 1, 0.3));
    assert_nan(nlc_contact_displacement(1, -a, 0, 1, 0.3));
    assert_nan(nlc_contact_displacement(1, inf, 0, 1, 0.3));
    assert_nan(nlc_contact_displacement(1, a, -DENORM_MIN, 1, 0.3));
    assert_nan(nlc_contact_displacement(1, a, nextafter(a, 1), 1, 0.3));
    assert_nan(nlc_contact_displacement(1, a, inf, 1, 0.3));
    assert_nan(nlc_contact_displacement(1, a, 2 * a, inf, 0.3));
    assert_nan(nlc_contact_displacement(1, a, 0, 0, 0.3));
    assert_nan(nlc_contact_displacement(1, a, 0, -1, 0.3));
    assert_nan(nlc_contact_displacement(1, a, 0, -inf, 0.3));
    assert_nan(nlc_contact_displacement(1, a, 0, 1, -DENORM_MIN));
    assert_nan(nlc_contact_displacement(1, a, 0, 1, above_half));
    assert_nan(nlc_contact_displacement(0, a, 0, 1, above_half));
    assert_value(0, nlc_contact_displacement(1, a, 0, inf, 0.3));
    assert_value(0, nlc_contact_displacement(-DBL_MAX, a, a, inf, 0.3));
    assert_value(0, nlc_contact_displacement(0, a, 0, 1, 0.3));
    assert_value(inf, nlc_contact_displacement(DBL_MAX, DENORM_MIN, 0, DENORM_MIN, 0.3));
    assert_value(-inf, nlc_contact_displacement(-DBL_MAX, DENORM_MIN, DENORM_MIN, DENORM_MIN, 0.3));
    assert_value(0.75, nlc_contact_displacement(1, 1, 0, 1, 0));
}
END_TEST

START_TEST(domain_nonlocal)
{
    const double inf = INFINITY, above_half = nextafter(0.5, 1), z[3] = {0, 0, 1};
    const double angles[] = {0, -0.0, -1, -DENORM_MIN, nextafter(PI, 4), 4, inf, -inf};
    for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
        assert_nan(nlc_nonlocal_displacement(1, angles[k], 1, 1, 0.3));
        assert_nan(nlc_nonlocal_displacement(1, angles[k], inf, 1, 0.3));
        assert_nan(nlc_nonlocal_displacement(0, angles[k], 1, inf, 0.3));
    }
    const double normals[][3] = {{0, 0, 1},     {0, 0, 0},   {0, 0, 1 + 5.1e-7}, {0, 1 - 5.1e-7, 0},    {1, 1, 0},
                                 {0.5, 0, 0},   {inf, 0, 0}, {inf, 1, 0},        {DBL_MAX, DBL_MAX, 0}, {-inf, inf, -inf},
                                 {1e-200, 0, 0}};
    for (size_t k = 0; k < sizeof normals / sizeof *normals; k++) {
        assert_nan(nlc_nonlocal_displacement_between(1, normals[k], z, 1, 1, 0.3)); /* the first is the same as z */
        assert_nan(nlc_nonlocal_displacement_between(1, z, normals[k], 1, 1, 0.3));
        assert_nan(nlc_nonlocal_displacement_between(0, z, normals[k], inf, inf, 0.3));
    }
    const double material[][3] = {{0, 1, 0.3},    {-0.0, 1, 0.3}, {-1, 1, 0.3},   {-inf, 1, 0.3},      {1, 0, 0.3},
                                  {1, -0.0, 0.3}, {1, -1, 0.3},   {1, -inf, 0.3}, {1, 1, -DENORM_MIN}, {1, 1, above_half},
                                  {1, 1, inf},    {1, 1, -1},     {inf, 0, 0.3},  {inf, -1, 0.3},      {0, inf, 0.3},
                                  {-1, inf, 0.3}, {inf, 1, 0.6}};
    const double x[3] = {1, 0, 0};
    for (size_t k = 0; k < sizeof material / sizeof *material; k++) {
        const double *m = material[k];
        assert_nan(nlc_nonlocal_displacement(1, 1, m[0], m[1], m[2]));
        assert_nan(nlc_nonlocal_displacement(0, 1, m[0], m[1], m[2]));
        assert_nan(nlc_nonlocal_displacement_between(1, x, z, m[0], m[1], m[2]));
    }
    const double nothing[][3] = {{inf, 1, 0.3}, {1, inf, 0.3}, {inf, inf, 0.3}, {inf, DENORM_MIN, 0}, {DENORM_MIN, inf, 0.5}};
    for (size_t k = 0; k < sizeof nothing / sizeof *nothing; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double *n = nothing[k], P = sign * DBL_MAX;
            assert_value(0, nlc_nonlocal_displacement(P, DENORM_MIN, n[0], n[1], n[2]));
            assert_value(0, nlc_nonlocal_displacement_between(P, x, z, n[0], n[1], n[2]));
        }
    assert_value(0, nlc_nonlocal_displacement(0, 1, 1, 1, 0.3));
    assert_value(-inf, nlc_nonlocal_displacement(1, DENORM_MIN, 1, 1, 0.3)); /* a push close by pushes away, for a pull ... */
    assert_value(inf, nlc_nonlocal_displacement(-1, DENORM_MIN, 1, 1, 0.3));
    assert_value(inf, nlc_nonlocal_displacement(DBL_MAX, PI, 0.25, 0.5, 0.3)); /* ... and behind it is the other way round */
    assert_value(-inf, nlc_nonlocal_displacement(-DBL_MAX, PI, 0.25, 0.5, 0.3));
    /* The largest lengths allowed are allowed. */
    const double long_z[3] = {0, 0, 1 + 4.99e-7}, short_x[3] = {1 - 4.99e-7, 0, 0};
    ck_assert_double_finite(nlc_nonlocal_displacement_between(1, long_z, short_x, 1, 1, 0.3));
    ck_assert_double_finite(nlc_half_space_displacement(1, long_z, short_x, x, 1, 0.3, 1));
}
END_TEST

START_TEST(domain_half_space)
{
    const double inf = INFINITY, x[3] = {1, 0, 0}, z[3] = {0, 0, 1}, r[3] = {0.1, 0, 0.2}, none[3] = {0, -0.0, 0};
    const double behind[3] = {0, 0, -2}, far_behind[3] = {0, 0, -DBL_MAX}, long_z[3] = {0, 0, 1 + 4e-7};
    const double almost_behind[3] = {1e-5, 0, -1}, tiny_behind[3] = {0, 0, -DENORM_MIN};
    const double normals[][3] = {{0, 0, 0},   {0, 0, 1 + 5.1e-7}, {0, 1 - 5.1e-7, 0},    {1, 1, 0},         {0.5, 0, 0},
                                 {inf, 0, 0}, {inf, 1, 0},        {DBL_MAX, DBL_MAX, 0}, {-inf, inf, -inf}, {1e-200, 0, 0}};
    for (size_t k = 0; k < sizeof normals / sizeof *normals; k++) {
        assert_nan(nlc_half_space_displacement(1, normals[k], z, r, 1, 0.3, 1));
        assert_nan(nlc_half_space_displacement(1, z, normals[k], r, 1, 0.3, 1));
        assert_nan(nlc_half_space_displacement(0, z, normals[k], r, inf, 0.3, 0));
    }
    assert_nan(nlc_half_space_displacement(1, x, z, none, 1, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, x, z, none, inf, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, z, x, behind, 1, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, z, x, far_behind, 1, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, z, x, tiny_behind, 1, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, z, x, behind, inf, 0.3, 0));
    assert_nan(nlc_half_space_displacement(1, z, x, behind, 1, 0.5, 1)); /* although the term vanishes */
    assert_nan(
        nlc_half_space_displacement(1, long_z, x, almost_behind, 1, 0.3, 1)); /* n_k.u < -1: the normal is used as given */
    ck_assert_double_finite(nlc_half_space_displacement(1, z, x, almost_behind, 1, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, x, z, r, 0, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, x, z, r, -1, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, x, z, r, -inf, 0.3, 1));
    assert_nan(nlc_half_space_displacement(1, x, z, r, 1, -DENORM_MIN, 1));
    assert_nan(nlc_half_space_displacement(1, x, z, r, 1, nextafter(0.5, 1), 1));
    assert_nan(nlc_half_space_displacement(1, x, z, r, 1, 0.3, -DENORM_MIN));
    assert_nan(nlc_half_space_displacement(1, x, z, r, inf, 0.3, -1));
    assert_value(0, nlc_half_space_displacement(DBL_MAX, x, z, r, inf, 0.3, 1));
    assert_value(0, nlc_half_space_displacement(DBL_MAX, x, z, r, 1, 0.3, 0));
    assert_value(0, nlc_half_space_displacement(0, x, z, r, 1, 0.3, 1));
    assert_value(-inf, nlc_half_space_displacement(DBL_MAX, z, z, x, DENORM_MIN, 0.3, 1)); /* pushed along with its neighbour */
    assert_value(inf, nlc_half_space_displacement(-DBL_MAX, z, z, x, DENORM_MIN, 0.3, 1));
}
END_TEST

/* -------------------------------------------------------------------------------------------------------- properties -- */

enum { ROUNDS = 2000 };

/* Exchanging the sides changes no bit. */
START_TEST(exchange)
{
    rng g = {seed() + 1};
    for (int round = 0; round < 5 * ROUNDS; round++) {
        double x[MAX_ARGUMENTS];
        const enum range range = (enum range)(round % RANGES);
        draw_radius(&g, x, range);
        nlc_assert_same(nlc_hertz_stiffness(x[1], x[2], x[3], x[4], x[5], x[6]),
                        nlc_hertz_stiffness(x[4], x[5], x[6], x[1], x[2], x[3]));
        nlc_assert_same(nlc_contact_radius(x[0], x[1], x[2], x[3], x[4], x[5], x[6]),
                        nlc_contact_radius(x[0], x[4], x[5], x[6], x[1], x[2], x[3]));
        draw_between(&g, x, range);
        nlc_assert_same(nlc_nonlocal_displacement_between(x[0], x + 1, x + 4, x[7], x[8], x[9]),
                        nlc_nonlocal_displacement_between(x[0], x + 4, x + 1, x[7], x[8], x[9]));
    }
}
END_TEST

/*
 * P -> overlap -> P.  Tolerance: the error of the overlap is raised to the power 3/2, that of the force comes on top; an ulp is
 * at most EPS.  Back again, overlap -> P -> overlap: 2/3 of the force's, and the overlap's.
 */
START_TEST(round_trip)
{
    rng g = {seed() + 2};
    for (int round = 0; round < ROUNDS; round++) {
        const double k = rng_log(&g, -60, 60), P = rng_log(&g, -300, 300);
        nlc_assert_rel(nlc_hertz_force(k, nlc_hertz_overlap(k, P)), P, 1.5 * error_of(OVERLAP) + error_of(FORCE) + 0.01 * EPS);
        nlc_assert_rel(nlc_hertz_overlap(k, nlc_hertz_force(k, P)), P,
                       error_of(OVERLAP) + 2 / 3. * error_of(FORCE) + 0.01 * EPS);
    }
}
END_TEST

/*
 * More overlap, more force, and the other way round, over steps in which the result grows by at least twice the bound, so that
 * no rounding can hide it: a relative step t changes the force by 3/2 t, the overlap by 2/3 t; an ulp is at least EPS/2 of the
 * number. Over smaller ones nothing is promised.
 */
START_TEST(monotonic)
{
    rng g = {seed() + 3};
    for (int round = 0; round < ROUNDS; round++) {
        const double k = rng_log(&g, -60, 60), x = rng_log(&g, -300, 300);
        const double in_force = 1 + 2 * error_of(FORCE) + EPS, in_overlap = 1 + 3 * error_of(OVERLAP) + EPS;
        ck_assert_double_lt(nlc_hertz_force(k, x), nlc_hertz_force(k, x * (1 + 2 / 3. * (in_force - 1) + EPS)));
        ck_assert_double_lt(nlc_hertz_force(k, x), nlc_hertz_force(k * in_force, x));
        ck_assert_double_lt(nlc_hertz_overlap(k, x), nlc_hertz_overlap(k, x * in_overlap));
        ck_assert_double_gt(nlc_hertz_overlap(k, x), nlc_hertz_overlap(k * in_overlap, x));
    }
}
END_TEST

/*
 * The local law hangs together: a^2 = R_eff overlap; u(0) = 2 u(a); the displacements of the two sides at the centre add up to
 * the overlap, for any two materials and radii.  Tolerances: the sums of the functions' own, in EPS.
 */
START_TEST(local_law)
{
    rng g = {seed() + 4};
    const double overlap_error = 2 / 3. * error_of(STIFFNESS) + error_of(OVERLAP);
    for (int round = 0; round < ROUNDS; round++) {
        double x[MAX_ARGUMENTS];
        draw_radius(&g, x, MODERATE);
        const double P = x[0], *i = x + 1, *j = x + 4;
        const double k = nlc_hertz_stiffness(i[0], i[1], i[2], j[0], j[1], j[2]), overlap = nlc_hertz_overlap(k, P);
        const double a = nlc_contact_radius(P, i[0], i[1], i[2], j[0], j[1], j[2]);
        const double ui = nlc_contact_displacement(P, a, 0, i[0], i[1]), uj = nlc_contact_displacement(P, a, 0, j[0], j[1]);
        nlc_assert_rel(a * a * (1 / i[2] + 1 / j[2]), overlap, 2 * error_of(RADIUS) + overlap_error + 2.5 * EPS);
        nlc_assert_rel(ui + uj, overlap, error_of(INSIDE) + error_of(RADIUS) + overlap_error + EPS);
        nlc_assert_rel(2 * nlc_contact_displacement(P, a, a, i[0], i[1]), ui, 2 * error_of(INSIDE));
        nlc_assert_rel(nlc_contact_displacement(P, a, 0.5 * a, i[0], i[1]), 0.875 * ui, 2 * error_of(INSIDE) + EPS / 2);
    }
}
END_TEST

/* [GC] 11, one side: theta = pi.  Tolerance: the bound, of the sum of the absolute terms, which is (11-14nu)/(3-2nu) <= 11/3
 * times the result; and 2 ulp for the right-hand side. */
START_TEST(opposite_force)
{
    rng g = {seed() + 5};
    for (int round = 0; round < ROUNDS; round++) {
        const double P = draw_force(&g, MODERATE), R = draw_size(&g, MODERATE), E = draw_size(&g, MODERATE),
                     nu = draw_poisson(&g);
        const double expected = (double)((1 + (long double)nu) * (3 - 2 * (long double)nu) * P / (4 * PI_LD * R * E));
        double n[3], m[3];
        draw_normal(&g, n);
        for (int k = 0; k < 3; k++) m[k] = -n[k];
        nlc_assert_rel(nlc_nonlocal_displacement(P, PI, R, E, nu), expected, error_of(NONLOCAL) * 11 / 3 + EPS);
        /* n is a unit vector to 2 EPS; s = |n| takes part in the result with a weight of at most 11/3 */
        nlc_assert_rel(nlc_nonlocal_displacement_between(P, n, m, R, E, nu), expected,
                       (error_of(BETWEEN) + 2 * EPS) * 11 / 3 + EPS);
    }
}
END_TEST

/* [GC] 14: two spheres, on each of them two forces F at right angles to the contact.  Tolerance: the bound, of the absolute
 * terms (and EPS/2 of them, the rounding of pi/2), at most 25 times the sum (nu = 0), which is smallest there. */
START_TEST(lateral_forces)
{
    rng g = {seed() + 6};
    const long double root2 = sqrtl(2);
    for (int round = 0; round < ROUNDS; round++) {
        const double F = rng_log(&g, -20, 20);
        double w = 0, terms = 0;
        long double expected = 0;
        for (int side = 0; side < 2; side++) {
            const double R = draw_size(&g, MODERATE), E = draw_size(&g, MODERATE), nu = draw_poisson(&g);
            const double x[] = {F, PI / 2, R, E, nu};
            for (int force = 0; force < 2; force++) w += nlc_nonlocal_displacement(F, PI / 2, R, E, nu);
            terms += 2 * (double)exact_nonlocal(x).scale;
            expected +=
                (1 + (long double)nu) * (3 * root2 - 4 - 4 * root2 * nu + 8 * (long double)nu) * F / (4 * PI_LD * R * E);
        }
        nlc_assert_abs(w, (double)expected, (error_of(NONLOCAL) + 2 * EPS) * terms); /* 2: three additions and the angle */
    }
}
END_TEST

/* The angle and the two normals say the same.  Tolerance: both bounds, and half an ulp for the rounding of the angle. */
START_TEST(angle_or_normals)
{
    rng g = {seed() + 7};
    for (int round = 0; round < ROUNDS; round++) {
        double x[MAX_ARGUMENTS];
        draw_between(&g, x, MODERATE);
        draw_normal(&g, x + 1);
        draw_normal_at(&g, x + 1, fmax(draw_angle(&g, x[9]), 0x1p-40), x + 4);
        long double c[3], d[3];
        widen(c, x + 1);
        widen(d, x + 4);
        for (int k = 0; k < 3; k++) d[k] -= c[k];
        const long double s = sqrtl(dot(d, d)) / 2;
        if (!(s > 0 && s < 0.999L)) continue; /* closer to 1 the angle magnifies the rounding of the normals */
        const double w = nlc_nonlocal_displacement_between(x[0], x + 1, x + 4, x[7], x[8], x[9]);
        nlc_assert_abs(nlc_nonlocal_displacement(x[0], (double)(2 * asinl(s)), x[7], x[8], x[9]), w,
                       (error_of(NONLOCAL) + error_of(BETWEEN) + EPS / 2) * fabs((double)exact_between(x).scale));
    }
}
END_TEST

/*
 * Linear in the force, and powers of two in every factor are exact: they change only exponents.  A third of a force is not, so
 * three thirds may differ by the bound of either side.
 */
START_TEST(scaling)
{
    rng g = {seed() + 8};
    for (int round = 0; round < ROUNDS; round++) {
        double x[MAX_ARGUMENTS], y[MAX_ARGUMENTS];
        const int n = (int)rng_below(&g, 81) - 40;
        const double two = ldexp(1, n), four = two * two, eight = four * two;

        draw_radius(&g, x, MODERATE);
        const double k = nlc_hertz_stiffness(x[1], x[2], x[3], x[4], x[5], x[6]);
        nlc_assert_same(nlc_hertz_stiffness(two * x[1], x[2], x[3], two * x[4], x[5], x[6]), two * k);
        nlc_assert_same(nlc_hertz_stiffness(x[1], x[2], four * x[3], x[4], x[5], four * x[6]), two * k);
        const int far = 150 + (int)rng_below(&g, 750); /* out to where the library may calculate in another way */
        for (int sign = -1; sign <= 1; sign += 2) {
            const double large = ldexp(1, sign * far);
            nlc_assert_same(nlc_hertz_stiffness(large * x[1], x[2], x[3], large * x[4], x[5], x[6]), large * k);
            nlc_assert_same(nlc_hertz_stiffness(x[1], x[2], large * x[3], x[4], x[5], large * x[6]),
                            nlc_hertz_stiffness(x[1], x[2], x[3] * ldexp(1, far % 2), x[4], x[5], x[6] * ldexp(1, far % 2)) *
                                ldexp(1, (sign * far - far % 2) / 2));
        }
        const double a = call_radius(x);
        nlc_assert_same(nlc_contact_radius(eight * x[0], x[1], x[2], x[3], x[4], x[5], x[6]), two * a);
        nlc_assert_same(nlc_contact_radius(x[0], x[1], x[2], eight * x[3], x[4], x[5], eight * x[6]), two * a);
        nlc_assert_same(nlc_contact_radius(two * x[0], two * x[1], x[2], x[3], two * x[4], x[5], x[6]), a);

        draw_two(&g, x, MODERATE);
        nlc_assert_same(nlc_hertz_force(two * x[0], x[1]), two * call_force(x));
        nlc_assert_same(nlc_hertz_force(x[0], four * x[1]), eight * call_force(x));
        nlc_assert_same(nlc_hertz_overlap(x[0], eight * x[1]), four * call_overlap(x));
        nlc_assert_same(nlc_hertz_overlap(eight * x[0], x[1]), call_overlap(x) / four);

        draw_inside(&g, x, MODERATE);
        nlc_assert_same(nlc_contact_displacement(-two * x[0], x[1], x[2], x[3], x[4]), -two * call_inside(x));
        nlc_assert_same(nlc_contact_displacement(x[0], two * x[1], two * x[2], x[3], x[4]), call_inside(x) / two);
        nlc_assert_same(nlc_contact_displacement(x[0], x[1], x[2], two * x[3], x[4]), call_inside(x) / two);

        draw_nonlocal(&g, x, MODERATE);
        x[1] = fmax(x[1], 0x1p-40); /* so that the result stays where a power of two changes the exponent only */
        const double w = call_nonlocal(x);
        nlc_assert_same(nlc_nonlocal_displacement(-two * x[0], x[1], x[2], x[3], x[4]), -two * w);
        nlc_assert_same(nlc_nonlocal_displacement(x[0], x[1], two * x[2], x[3], x[4]), w / two);
        nlc_assert_same(nlc_nonlocal_displacement(x[0], x[1], x[2], two * x[3], x[4]), w / two);
        nlc_assert_abs(3 * nlc_nonlocal_displacement(x[0] / 3, x[1], x[2], x[3], x[4]), w,
                       (2 * error_of(NONLOCAL) + EPS) * fabs((double)exact_nonlocal(x).scale));

        do draw_between(&g, x, MODERATE);
        while (!(fabs(call_between(x)) < 0x1p200));
        memcpy(y, x, sizeof y);
        y[0] *= -two;
        nlc_assert_same(call_between(y), -two * call_between(x));
        y[7] *= two;
        nlc_assert_same(call_between(y), -call_between(x));
        y[8] *= two;
        nlc_assert_same(call_between(y), -call_between(x) / two);

        do draw_half_space(&g, x, MODERATE);
        while (!(fabs(call_half_space(x)) < 0x1p200));
        memcpy(y, x, sizeof y);
        y[0] *= -two;
        nlc_assert_same(call_half_space(y), -two * call_half_space(x));
        for (int i = 7; i < 10; i++) y[i] *= two;
        nlc_assert_same(call_half_space(y), -call_half_space(x));
        y[10] *= two;
        nlc_assert_same(call_half_space(y), -call_half_space(x) / two);
        y[12] *= two;
        nlc_assert_same(call_half_space(y), -call_half_space(x));
    }
}
END_TEST

/*
 * [GC] 5 changes sign at s = (1-2nu + sqrt((1-2nu)^2 + 2(1-nu)(7-8nu))) / (7-8nu), 0.645 for nu = 0.3.  Tolerance at the
 * zero: the bound, of the sum of the absolute terms, and EPS/2 of it for the rounding of the angle; 1e-12 to either side of it
 * the sign is certain.
 */
START_TEST(zero_of_the_displacement)
{
    nlc_assert_abs(sin(zero_angle(0.3) / 2), 0.645, 5e-4);
    for (int k = 0; k <= 50; k++) {
        const double nu = k / 100., theta = zero_angle(nu), x[] = {1, theta, 1, 1, nu};
        nlc_assert_abs(call_nonlocal(x), 0, (error_of(NONLOCAL) + EPS / 2) * (double)exact_nonlocal(x).scale);
        ck_assert_double_lt(nlc_nonlocal_displacement(1, theta * (1 - 1e-12), 1, 1, nu), 0);
        ck_assert_double_gt(nlc_nonlocal_displacement(1, theta * (1 + 1e-12), 1, 1, nu), 0);
    }
}
END_TEST

/*
 * The half-space kernel with inward normals at the points of the undeformed sphere is [GC] 5 times the prefactor, for every nu
 * and up to the antipode.  Tolerance: both bounds, 2 EPS for the rounding of r_kc, and 2 EPS/s because the normals are unit
 * vectors to EPS only: n_k.u, which is s on a sphere, is off by (1 - |n|^2) / 4s.
 */
START_TEST(half_space_on_sphere)
{
    rng g = {seed() + 9};
    for (int round = 0; round < 5 * ROUNDS; round++) {
        const double R = rng_log(&g, -10, 0), E = rng_log(&g, 0, 40), P = draw_force(&g, MODERATE), G = rng_uniform(&g, 0.5, 2);
        const double nu = round % 3 ? draw_poisson(&g) : round % 51 / 100.;
        double c[3], k[3], inward_c[3], inward_k[3], r[3];
        draw_normal(&g, c);
        draw_normal_at(&g, c, round % 5 ? rng_uniform(&g, 0.05, PI) : PI, k);
        for (int i = 0; i < 3; i++) {
            if (round % 10 == 0) k[i] = -c[i];
            inward_c[i] = -c[i];
            inward_k[i] = -k[i];
            r[i] = R * (c[i] - k[i]);
        }
        const double x[] = {P, c[0], c[1], c[2], k[0], k[1], k[2], R, E, nu};
        const double h[] = {
            P, inward_k[0], inward_k[1], inward_k[2], inward_c[0], inward_c[1], inward_c[2], r[0], r[1], r[2], E, nu, G};
        const long double s = hypotl(hypotl((long double)c[0] - k[0], (long double)c[1] - k[1]), (long double)c[2] - k[2]) / 2;
        nlc_assert_abs(call_half_space(h), G * call_between(x),
                       (double)((error_of(BETWEEN) + EPS / 2) * fabsl(G * exact_between(x).scale) +
                                (error_of(HALF_SPACE) + (2 + 2 / s) * EPS) * fabsl(exact_half_space(h).scale)));
    }
}
END_TEST

/* Where the last term vanishes (nu = 1/2), [MC] 1 is symmetric: exchanging the contacts reverses u, and both numbers are the
 * same. */
START_TEST(half_space_reciprocity)
{
    rng g = {seed() + 10};
    for (int round = 0; round < ROUNDS; round++) {
        double x[MAX_ARGUMENTS], y[MAX_ARGUMENTS];
        draw_half_space(&g, x, MODERATE);
        x[11] = 0.5;
        memcpy(y, x, sizeof y);
        for (int k = 0; k < 3; k++) {
            y[1 + k] = x[4 + k];
            y[4 + k] = x[1 + k];
            y[7 + k] = -x[7 + k];
        }
        const double w = call_half_space(x), v = call_half_space(y);
        if (isnan(w) || isnan(v) || isinf(w)) continue;
        nlc_assert_abs(v, w,
                       error_of(HALF_SPACE) * (double)(fabsl(exact_half_space(x).scale) + fabsl(exact_half_space(y).scale)));
    }
}
END_TEST

/*
 * Nothing depends on the axes.  Tolerance: both bounds, and the rotated vectors' rounding of EPS, which changes the difference
 * of the normals by EPS/s of itself, r_kc by EPS, and 1 + n_k.u by 2 EPS, which the scale counts already.
 */
START_TEST(rotation)
{
    rng g = {seed() + 11};
    for (int round = 0; round < ROUNDS; round++) {
        double x[MAX_ARGUMENTS], y[MAX_ARGUMENTS], e[3][3], first[3], second[3];
        long double a[3], b[3], t[3];
        rng_unit(&g, first); /* a random right-handed frame e */
        draw_normal_at(&g, first, PI / 2, second);
        widen(a, first);
        widen(b, second);
        cross(t, a, b);
        normalize(e[2], t);
        widen(t, e[2]);
        cross(b, t, a);
        normalize(e[0], a);
        normalize(e[1], b);

        draw_between(&g, x, MODERATE);
        draw_normal_at(&g, x + 1, rng_uniform(&g, 0.01, PI), x + 4);
        memcpy(y, x, sizeof y);
        for (int v = 1; v < 7; v += 3)
            for (int i = 0; i < 3; i++)
                y[v + i] =
                    (double)((long double)x[v] * e[0][i] + (long double)x[v + 1] * e[1][i] + (long double)x[v + 2] * e[2][i]);
        const long double s =
            sqrtl(powl((long double)x[1] - x[4], 2) + powl((long double)x[2] - x[5], 2) + powl((long double)x[3] - x[6], 2)) /
            2;
        nlc_assert_abs(call_between(y), call_between(x),
                       (double)((2 * error_of(BETWEEN) + 3 / s * EPS) * fabsl(exact_between(x).scale)));

        draw_half_space(&g, x, MODERATE);
        memcpy(y, x, sizeof y);
        for (int v = 1; v < 10; v += 3)
            for (int i = 0; i < 3; i++)
                y[v + i] =
                    (double)((long double)x[v] * e[0][i] + (long double)x[v + 1] * e[1][i] + (long double)x[v + 2] * e[2][i]);
        const outcome one = exact_half_space(x), other = exact_half_space(y);
        if (one.open || other.open || !(fabsl(one.value) < 1e300L && fabsl(other.value) < 1e300L)) continue;
        /* the absolute terms depend on the axes (1 for u on an axis, up to sqrt(3) beside it): take those of both */
        nlc_assert_abs(call_half_space(y), call_half_space(x),
                       (double)((error_of(HALF_SPACE) + 16 * EPS) * (fabsl(one.scale) + fabsl(other.scale))));
    }
}
END_TEST

static Suite *suite(void)
{
    Suite *s = suite_create("scalar");
    TCase *sweep = tcase_create("accuracy"), *uphill = tcase_create("search"), *special = tcase_create("special values"),
          *trapped = tcase_create("trapped"), *rest = tcase_create("domain and properties");
    time_limit(sweep, 120);
    tcase_add_loop_test(sweep, accuracy, 0, FUNCTIONS);
    suite_add_tcase(s, sweep);

    time_limit(uphill, 120);
    tcase_add_loop_test(uphill, search, 0, FUNCTIONS);
    tcase_add_loop_test(uphill, hardest_known, 0, sizeof hardest / sizeof *hardest);
    suite_add_tcase(s, uphill);

    time_limit(special, 120);
    tcase_add_loop_test(special, special_values, 0, FUNCTIONS);
    suite_add_tcase(s, special);

    time_limit(trapped, 60);
    tcase_add_checked_fixture(trapped, fp_trap, fp_untrap);
    tcase_add_loop_test(trapped, special_values_trapped, 0, FUNCTIONS);
    suite_add_tcase(s, trapped);

    time_limit(rest, 60);
    tcase_add_loop_test(rest, nan_in_each_place, 0, FUNCTIONS);
    tcase_add_test(rest, known_values);
    tcase_add_test(rest, bounds_of_the_header);
    tcase_add_test(rest, domain_hertz);
    tcase_add_test(rest, domain_displacement);
    tcase_add_test(rest, domain_nonlocal);
    tcase_add_test(rest, domain_half_space);
    tcase_add_test(rest, exchange);
    tcase_add_test(rest, round_trip);
    tcase_add_test(rest, monotonic);
    tcase_add_test(rest, local_law);
    tcase_add_test(rest, opposite_force);
    if (long_double_is_wider()) {
        tcase_add_loop_test(rest, draws_are_valid, 0, FUNCTIONS);
        tcase_add_test(rest, lateral_forces);
        tcase_add_test(rest, angle_or_normals);
        tcase_add_test(rest, scaling);
        tcase_add_test(rest, zero_of_the_displacement);
        tcase_add_test(rest, half_space_on_sphere);
        tcase_add_test(rest, half_space_reciprocity);
        tcase_add_test(rest, rotation);
    } else {
        puts("long double is no wider than double: accuracy is not tested");
    }
    suite_add_tcase(s, rest);
    return s;
}

int main(void)
{
    return run_suite(suite());
}
