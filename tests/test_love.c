/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_love.c - the fields of Case I and Case II, [GC] 2, 20-23 and 26-29
 *
 * Exact values come from four sides that know nothing of the form in which the library evaluates them: the printed equations
 * with 2000 digits (love_table.h, everywhere, small circles and the axis included); the printed equations in long double where
 * they do not cancel; Boussinesq's point force integrated over the Hertz pressure; and the closed forms of Johnson, Contact
 * Mechanics, section 3.4, on the surface and on the axis.  Then what any elastic field must satisfy.
 */
#include "../lib/love.h"
#include "love_table.h"
#include "nlcontact.h"
#include "support.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846
#define PI_LD 3.14159265358979323846264338327950288L
#define EPS 0x1p-52
#define COUNT(a) (sizeof(a) / sizeof *(a))

/* The worst errors that the header states [ulp]. */
enum { POINT_DISPLACEMENT = 10, POINT_STRESS = 12, POINT_TRACTION = 11, DISPLACEMENT = 27, STRESS = 28, NORMAL = 21 };

/* u_z, u_r, s_zz, s_rr, s_tt, s_rz, and what an error is counted in ulp of */
typedef struct fields {
    long double value[6], scale[6];
} fields;

static const char *const names[6] = {"u_z", "u_r", "s_zz", "s_rr", "s_tt", "s_rz"};

static void love(double f[6], double P, double a, double r, double z, double E, double nu)
{
    nlc_assert_quiet(nlc_love_displacement(f, P, a, r, z, E, nu); nlc_love_stress(f + 2, P, a, r, z, nu));
}

/* Worst error in units of the header's bounds: <= 1 is good. */
static double judge(const fields *exact, const double f[6], const char *where)
{
    double worst = 0;
    for (int k = 0; k < 6; k++) {
        const double bound = k < 2 ? DISPLACEMENT : STRESS, error = ulp_error(f[k], exact->value[k], exact->scale[k]) / bound;
        if (!(error <= 1))
            ck_abort_msg("%s: %s = %a, exact %La, scale %La: %g times the bound", where, names[k], f[k], exact->value[k],
                         exact->scale[k], error);
        if (error > worst) worst = error;
    }
    return worst;
}

static const char *where_is(double a, double r, double z, double nu)
{
    static char text[256];
    snprintf(text, sizeof text, "a = %a, r = %a, z = %a, nu = %a", a, r, z, nu);
    return text;
}

/* ------------------------------------------------------------------------------------------------------ exact values -- */

/* Tolerance: the header's bound, plus half an ulp for the constant. */
START_TEST(table)
{
    for (size_t i = 0; i < COUNT(love_table); i++) {
        const double a = love_table[i].in[0], r = love_table[i].in[1], z = love_table[i].in[2], nu = love_table[i].in[3];
        const fields exact = {
            {love_table[i].u_z, love_table[i].u_r, love_table[i].zz, love_table[i].rr, love_table[i].tt, love_table[i].rz},
            {love_table[i].u_z, love_table[i].scale_u_r, love_table[i].zz, love_table[i].scale_rr, love_table[i].scale_tt,
             love_table[i].rz}};
        double f[6];
        love(f, 1, a, r, z, 1, nu);
        for (int k = 0; k < 6; k++)
            if (fabsl(exact.scale[k]) < 1e-290L) f[k] = fabs(f[k]) < 1e-280 ? 0 : f[k]; /* too small for the table */
        judge(&exact, f, where_is(a, r, z, nu));
    }
}
END_TEST

START_TEST(normal_displacement_table)
{
    for (size_t i = 0; i < COUNT(normal_table); i++) {
        const double *x = normal_table[i], w = nlc_love_nonlocal_displacement(1, x[0], x[1], 1, 1, x[2]);
        const double error = ulp_error(w, x[3], x[4]);
        if (!(error <= NORMAL + 0.5))
            ck_abort_msg("radius %a theta %a nu %a: %a, exact %a: %g ulp", x[0], x[1], x[2], w, x[3], error);
    }
}
END_TEST

/* [GC] 26-29 as printed, with Love's hoop stress; P = E = 1. */
static fields printed(long double a, long double r, long double z, long double nu)
{
    const long double f = (r - a) * (r + a) + z * z, d = sqrtl(f * f + 4 * a * a * z * z);
    const long double kappa = f >= 0 ? (d + f) / 2 : 2 * a * a * z * z / (d - f), root = sqrtl(kappa), arc = atanl(a / root);
    const long double n = kappa * kappa + a * a * z * z, a3 = a * a * a, b2 = a * a + kappa;
    const long double V = 3 / (4 * a * a) * ((2 * a - r * r / a + 2 * z * z / a) * arc + r * r * root / b2 - 2 * z * z / root);
    const long double Vr = -3 * r / (2 * a3) * (arc - a * root / b2), Vz = -3 * z / a3 * (a / root - arc);
    const long double Vzz = -3 / a3 * (a / root - arc) + 3 * z * z / (n * root);
    const long double Vrr = -3 / (2 * a3) * (arc - a * root / b2) + 3 * (kappa - z * z) * root / (n * b2);
    const long double Vrz = 3 * r * z * root / (n * b2);
    const long double common = 3 * z / (2 * a3) * (a / root - arc),
                      other = z / (r * r * root) * (3 * kappa - z * z) / (2 * kappa);
    const long double chi_r = 1 / (r * r) + common - other, chi_rr = -1 / (r * r) + common + other;
    const long double mild = 1 - 2 * nu, u = (1 + nu) / (2 * PI_LD), t = 1 / (2 * PI_LD);
    fields o = {{u * (2 * (1 - nu) * V - z * Vz), -u * (mild * r * chi_r + z * Vr), t * (Vz - z * Vzz),
                 t * (2 * nu * Vz - mild * chi_rr - z * Vrr), t * (2 * nu * Vz - mild * chi_r - z * Vr / r), -t * z * Vrz},
                {0}};
    memcpy(o.scale, o.value, sizeof o.scale);
    o.scale[1] = u * (mild * r * chi_r - z * Vr);
    o.scale[2] = fmaxl(fabsl(o.value[2]), -t * Vz / 64); /* all that the printed form can tell */
    o.scale[3] = t * (fabsl(Vz - z * Vrr) + mild * chi_r);
    o.scale[4] = t * (fabsl(Vz - z * Vr / r) + mild * chi_r);
    return o;
}

static double draw_poisson(rng *g)
{
    const double nu = rng_uniform(g, 0, 0.5), edge[] = {0, 0.5, 0.5 - 0x1p-40, nu, nu, nu};
    return edge[rng_below(g, COUNT(edge))];
}

/*
 * Where the printed equations lose less than two of long double's three spare digits: not near the axis, not far from the
 * circle; but close to its rim and to the surface.  Tolerance: the header's bound and 1/2 ulp for the oracle.
 */
START_TEST(printed_equations)
{
    if (!long_double_is_wider()) return;
    rng g = {1929};
    double worst = 0;
    for (uint64_t n = points(300000); n > 0; n--) {
        const double a = rng_log(&g, -2, 2), nu = draw_poisson(&g);
        const double beside = rng_log(&g, -30, -1), side = rng_sign(&g), deep = rng_log(&g, -30, 1),
                     wide = rng_uniform(&g, 0.5, 2);
        const double r = a * (rng_below(&g, 3) ? wide : 1 + side * beside), z = a * deep;
        double f[6];
        love(f, 1, a, r, z, 1, nu);
        const fields exact = printed(a, r, z, nu);
        worst = fmax(worst, judge(&exact, f, where_is(a, r, z, nu)));
    }
    if (verbose()) printf("printed equations: worst %.3f of the bounds\n", worst);
}
END_TEST

/* Nodes and weights of Gauss and Legendre on [0, 1], by Newton's method. */
enum { NODES = 40 };
static void gauss(long double x[NODES], long double w[NODES])
{
    for (int i = 0; i < NODES; i++) {
        long double t = cosl(PI_LD * (i + 0.75L) / (NODES + 0.5L)), slope = 1;
        for (int step = 0; step < 20; step++) {
            long double p = 1, q = 0;
            for (int k = 1; k <= NODES; k++) {
                const long double next = ((2 * k - 1) * t * p - (k - 1) * q) / k;
                q = p;
                p = next;
            }
            slope = NODES * (t * p - q) / (t * t - 1);
            t -= p / slope;
        }
        x[i] = (1 + t) / 2;
        w[i] = 1 / ((1 - t * t) * slope * slope);
    }
}

/*
 * Boussinesq's point force over the Hertz pressure, P = E = 1.  At the distance rho = a sqrt(1 - mu^2) from the centre the
 * force on a ring is 3 mu^2 dmu.  Terms with and without 1-2nu are added up apart.
 */
static fields quadrature(long double a, long double r, long double z, long double nu)
{
    static long double x[NODES], w[NODES];
    long double uz = 0, V = 0, ur[2] = {0}, rr[2] = {0}, tt[2] = {0}, zz = 0, rz = 0;
    if (w[0] == 0) gauss(x, w);
    for (int i = 0; i < NODES; i++)
        for (int j = 0; j < 2 * NODES; j++) {
            const long double weight = 3 * x[i] * x[i] * w[i] / (2 * NODES), phi = PI_LD * (j + 0.5L) / (2 * NODES);
            const long double rho = a * sqrtl(1 - x[i] * x[i]), dx = r - rho * cosl(phi), dy = rho * sinl(phi);
            const long double s2 = dx * dx + dy * dy, R = sqrtl(s2 + z * z), cos2 = s2 > 0 ? dx * dx / s2 : 0.5L,
                              sin2 = 1 - cos2;
            const long double R3 = R * R * R, R5 = R3 * R * R, m = 1 / (R * (R + z)), hoop = z / R3 - m;
            V += weight / R;
            uz += weight * z * z / R3;
            ur[0] += weight * z * dx / R3;
            ur[1] -= weight * dx * m;
            zz -= weight * 3 * z * z * z / R5;
            rz -= weight * 3 * z * z * dx / R5;
            rr[0] -= weight * 3 * z * dx * dx / R5;
            tt[0] -= weight * 3 * z * dy * dy / R5;
            rr[1] += weight * (cos2 * m + sin2 * hoop);
            tt[1] += weight * (sin2 * m + cos2 * hoop);
        }
    const long double mild = 1 - 2 * nu, u = (1 + nu) / (2 * PI_LD), t = 1 / (2 * PI_LD);
    fields o = {{u * (2 * (1 - nu) * V + uz), u * (ur[0] + mild * ur[1]), t * zz, t * (rr[0] + mild * rr[1]),
                 t * (tt[0] + mild * tt[1]), t * rz},
                {0}};
    memcpy(o.scale, o.value, sizeof o.scale);
    const long double chi = fabsl(r > 0 ? ur[1] / r : rr[1]);
    o.scale[1] = u * (fabsl(ur[0]) + mild * fabsl(ur[1]));
    o.scale[3] = t * (fabsl(rr[0]) + mild * chi);
    o.scale[4] = t * (fabsl(tt[0]) + mild * chi);
    return o;
}

/*
 * At a distance of a or more, where 40 nodes are enough, down to the smallest circles.  Tolerance: the header's bound; what is
 * small against the quadrature's terms only, as s_tt of a small circle at nu = 1/2 or s_rz by the axis, may have an error of
 * 1e-16 of those terms.
 */
START_TEST(boussinesq_over_hertz)
{
    if (!long_double_is_wider()) return;
    rng g = {1885};
    double worst = 0;
    for (uint64_t n = points(1000); n > 0; n--) {
        const double r = rng_below(&g, 8) ? rng_log(&g, -20, 1) : 0, z = r < 0.1 ? rng_log(&g, 0, 1) : rng_log(&g, -20, 1);
        const double nu = draw_poisson(&g), distance = sqrt(r * r + z * z), large = rng_log(&g, -2, -1),
                     small = rng_log(&g, -900, 0);
        const double a = distance * (rng_below(&g, 2) ? large : small / 2);
        fields exact = quadrature(a, r, z, nu);
        const long double size = 1 / ((long double)distance * distance);
        for (int k = 0; k < 6; k++) {
            const long double term = k < 2 ? size * distance : size;
            if (fabsl(exact.scale[k]) < 0.03L * term) exact.scale[k] = 0.03L * term;
        }
        double f[6];
        love(f, 1, a, r, z, 1, nu);
        worst = fmax(worst, judge(&exact, f, where_is(a, r, z, nu)));
    }
    if (verbose()) printf("quadrature: worst %.3f of the bounds\n", worst);
}
END_TEST

/* Surface and axis: Johnson 3.41-3.45.  Tolerance: the header's bound, and as much for the formulas in double. */
START_TEST(surface_and_axis)
{
    rng g = {1882};
    for (int n = 0; n < 20000; n++) {
        const double a = rng_log(&g, -3, 3), P = rng_log(&g, -3, 3), E = rng_log(&g, -3, 3), nu = draw_poisson(&g);
        const double p0 = 3 * P / (2 * PI * a * a), x = rng_uniform(&g, 0.1, 1), r = x * a, c = sqrt((1 - x) * (1 + x));
        const double part = (1 - 2 * nu) / (3 * x * x) * (1 - c * c * c), tolerance = 2 * STRESS * EPS * p0 / (x * x);
        double f[6];
        love(f, P, a, r, 0, E, nu);
        nlc_assert_rel(f[0], nlc_contact_displacement(P, a, r, E, nu), 2 * DISPLACEMENT * EPS);
        nlc_assert_abs(f[1], -(1 + nu) / E * p0 * r * part, tolerance * a / E);
        nlc_assert_abs(f[2], -p0 * c, tolerance);
        nlc_assert_abs(f[3], p0 * (part - c), tolerance);
        nlc_assert_abs(f[4], -p0 * (part + 2 * nu * c), tolerance);
        nlc_assert_abs(f[5], 0, 0);

        const double R = a / x, far = a / R; /* outside */
        love(f, P, a, R, 0, E, nu);
        const double outer =
            (1 - nu * nu) * p0 / (2 * a * E) * ((2 * a * a - R * R) * asin(far) + R * a * sqrt((1 - far) * (1 + far)));
        nlc_assert_abs(f[0], outer, 8 * DISPLACEMENT * EPS * (1 - nu * nu) * p0 / (2 * a * E) * R * a);
        nlc_assert_rel(f[1], -(1 - 2 * nu) * (1 + nu) * P / (2 * PI * R * E), 2 * DISPLACEMENT * EPS);
        nlc_assert_rel(f[3], (1 - 2 * nu) * P / (2 * PI * R * R), 2 * STRESS * EPS);
        nlc_assert_rel(f[4], -(1 - 2 * nu) * P / (2 * PI * R * R), 2 * STRESS * EPS);
        nlc_assert_abs(fabs(f[2]) + fabs(f[5]), 0, 0);

        const double z = rng_uniform(&g, 0, 3) * a, q = z / a, arc = z > 0 ? q * atan(1 / q) : 0;
        love(f, P, a, 0, z, E, nu);
        nlc_assert_rel(f[2], -p0 / (1 + q * q), 2 * STRESS * EPS);
        nlc_assert_abs(f[3], p0 * (0.5 / (1 + q * q) - (1 + nu) * (1 - arc)), 2 * STRESS * EPS * p0);
        nlc_assert_same(f[3], f[4]);
        nlc_assert_abs(fabs(f[1]) + fabs(f[5]), 0, 0);
    }
}
END_TEST

/* --------------------------------------------------------------------------------------------------- what must hold -- */

/*
 * Hooke's law and equilibrium, by differences of fourth order over a step of 2^-10 of the distance to the rim or the axis.
 * Their own error is about 1e-11 of the terms, rounding 1e-12 times the bound: 1e-9.
 */
START_TEST(hooke_and_equilibrium)
{
    rng g = {1660};
    for (int n = 0; n < 20000; n++) {
        const double a = rng_below(&g, 8) ? rng_log(&g, -2, 1) : 0, nu = rng_uniform(&g, 0, 0.49), E = 2.5;
        const double r = rng_uniform(&g, 0.1, 3), z = rng_uniform(&g, 0.1, 3);
        const double rim = sqrt((r - a) * (r - a) + z * z), h = fmin(fmin(rim, r), z) / 1024, shift[4] = {-2, -1, 1, 2};
        const double weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
        double f[6], dr[6] = {0}, dz[6] = {0}, y[6];
        love(f, 1, a, r, z, E, nu);
        for (int i = 0; i < 4; i++) {
            love(y, 1, a, r + shift[i] * h, z, E, nu);
            for (int k = 0; k < 6; k++) dr[k] += weight[i] * y[k] / h;
            love(y, 1, a, r, z + shift[i] * h, E, nu);
            for (int k = 0; k < 6; k++) dz[k] += weight[i] * y[k] / h;
        }
        const double zz = dz[0], rr = dr[1], tt = f[1] / r, volume = zz + rr + tt, mu = E / (2 * (1 + nu));
        const double lambda = 2 * mu * nu / (1 - 2 * nu), size = E * (fabs(zz) + fabs(rr) + fabs(tt)) / (1 - 2 * nu);
        nlc_assert_abs(f[2], lambda * volume + 2 * mu * zz, 1e-9 * size);
        nlc_assert_abs(f[3], lambda * volume + 2 * mu * rr, 1e-9 * size);
        nlc_assert_abs(f[4], lambda * volume + 2 * mu * tt, 1e-9 * size);
        nlc_assert_abs(f[5], mu * (dz[1] + dr[0]), 1e-9 * size);
        const double force = (fabs(f[2]) + fabs(f[3]) + fabs(f[4])) / (fmin(rim, fmin(r, z)));
        nlc_assert_abs(dr[3] + dz[5] + (f[3] - f[4]) / r, 0, 1e-9 * force);
        nlc_assert_abs(dr[5] + dz[2] + f[5] / r, 0, 1e-9 * force);
    }
}
END_TEST

/* Case I as printed, [GC] 21 and 22, in long double; Boussinesq's hoop stress.  Tolerance: the header's bounds. */
START_TEST(case_one)
{
    if (!long_double_is_wider()) return;
    rng g = {2012};
    double worst[3] = {0};
    for (uint64_t n = points(200000); n > 0; n--) {
        const double small = rng_log(&g, -60, 1), wide = rng_uniform(&g, 0.1, PI), theta = rng_below(&g, 3) ? wide : small;
        const double P = rng_log(&g, -9, 9), R = rng_log(&g, -9, 9), E = rng_log(&g, -9, 9), nu = draw_poisson(&g);
        const long double s = sinl(theta / 2.0L), k = cosl(theta / 2.0L), sine = sinl(theta), mild = 1 - 2 * (long double)nu;
        const long double u = P * (1 + (long double)nu) / (2 * PI_LD * R * E), q = P / (8 * PI_LD * R * R);
        const long double u_z = u * (s / 2 + (1 - nu) / s), u_r = u / sine * (sine * sine / (4 * s) - mild * k * k / (1 + s));
        const long double s_zz = -3 * q * s, s_rz = -3 * q * k, pull = q * mild / (s * s * (1 + s)), push = 3 * q * k * k / s;
        const long double t_r = q * (2 * mild * k / (s * (1 + s)) - 3 * k), ring = q * mild / s;
        double d[2], o[4], t[2];
        nlc_assert_quiet(nlc_point_displacement(d, P, theta, R, E, nu); nlc_point_stress(o, P, theta, R, nu);
                         nlc_point_traction(t, P, theta, R, nu));
        const double errors[3] = {
            fmax(ulp_error(d[0], u_z, u_z), ulp_error(d[1], u_r, u / sine * (sine * sine / (4 * s) + mild * k * k / (1 + s)))),
            fmax(fmax(ulp_error(o[0], s_zz, s_zz), ulp_error(o[1], pull - push, pull + push)),
                 fmax(ulp_error(o[2], ring - pull, ring + pull), ulp_error(o[3], s_rz, s_rz))),
            fmax(ulp_error(t[0], s_zz, s_zz), ulp_error(t[1], t_r, q * (2 * mild * k / (s * (1 + s)) + 3 * k)))};
        const double bounds[3] = {POINT_DISPLACEMENT, POINT_STRESS, POINT_TRACTION};
        for (int i = 0; i < 3; i++) {
            worst[i] = fmax(worst[i], errors[i]);
            if (!(errors[i] <= bounds[i]))
                ck_abort_msg("function %d: %g ulp at force %a theta %a R %a E %a nu %a", i, errors[i], P, theta, R, E, nu);
        }
    }
    if (verbose()) printf("Case I: worst %.2f %.2f %.2f ulp\n", worst[0], worst[1], worst[2]);
}
END_TEST

/*
 * The traction is n.stress; n.displacement is nlc_nonlocal_displacement; Love's fields of a circle of radius 0 and, up to
 * (a/d)^2, of a small one are those of the point force.  Tolerance: the bounds of both sides, of the terms.
 */
START_TEST(case_one_hangs_together)
{
    rng g = {1822};
    for (int n = 0; n < 50000; n++) {
        const double theta = rng_uniform(&g, 0.01, PI), nu = draw_poisson(&g), R = 0.75, E = 2.5, P = 3;
        const double s = sin(theta / 2), k = cos(theta / 2), n_z = -cos(theta), n_r = sin(theta);
        double d[2], o[4], t[2], f[6];
        nlc_point_displacement(d, P, theta, R, E, nu);
        nlc_point_stress(o, P, theta, R, nu);
        nlc_point_traction(t, P, theta, R, nu);
        const double size = P / (8 * PI * R * R * s * s), length = P / (PI * R * E * s);
        nlc_assert_abs(t[0], n_z * o[0] + n_r * o[3], 16 * EPS * size);
        nlc_assert_abs(t[1], n_z * o[3] + n_r * o[1], 16 * EPS * size);
        nlc_assert_abs(nlc_nonlocal_displacement(P, theta, R, E, nu), n_z * d[0] + n_r * d[1], 16 * EPS * length);
        for (int small = 0; small < 2; small++) {
            love(f, P, small ? 1e-9 * s : 0, 2 * R * s * k, 2 * R * s * s, E, nu);
            for (int i = 0; i < 6; i++) nlc_assert_abs(f[i], i < 2 ? d[i] : o[i - 2], 64 * EPS * (i < 2 ? length : size));
        }
    }
}
END_TEST

/* The tractions on the whole sphere and the force add up to nothing: Gauss in s, where the integrand is a polynomial. */
START_TEST(resultant)
{
    long double x[NODES], w[NODES], sum = 0;
    gauss(x, w);
    for (int i = 0; i < NODES; i++) {
        double t[2];
        nlc_point_traction(t, 7, (double)(2 * asinl(x[i])), 0.3, 0.2);
        sum += w[i] * t[0] * 8 * PI_LD * 0.3L * 0.3L * x[i]; /* R^2 2 pi sin(theta) dtheta = 8 pi R^2 s ds */
    }
    nlc_assert_rel((double)sum, -7, 1e-14);
}
END_TEST

/* Along the normal of the sphere, from the fields; the kernel the same in the model's units; Case I for small circles. */
START_TEST(normal_displacement)
{
    rng g = {31};
    for (int n = 0; n < 50000; n++) {
        const double theta = rng_uniform(&g, 0, PI), a = rng_log(&g, -20, 0), nu = draw_poisson(&g), s = sin(theta / 2);
        double d[2];
        nlc_love_displacement(d, 1, a, sin(theta), 2 * s * s, 1, nu);
        const double w = nlc_love_nonlocal_displacement(1, a, theta, 1, 1, nu), size = fabs(d[0]) + 1 / (2 * s + a) / PI;
        nlc_assert_abs(w, -cos(theta) * d[0] + sin(theta) * d[1], 2 * (NORMAL + DISPLACEMENT) * EPS * size);
        nlc_assert_abs((1 + nu) / (4 * PI) * nlc_love_kernel(s, a, nu), w, 2 * NORMAL * EPS * size);
        const double point = nlc_nonlocal_displacement(1, theta, 1, 1, nu);
        nlc_assert_same(nlc_love_nonlocal_displacement(1, 0, theta, 1, 1, nu), point);
        nlc_assert_abs(nlc_love_nonlocal_displacement(1, 1e-9 * s, theta, 1, 1, nu), point, 2 * NORMAL * EPS / s);
        const double terms = (1 + nu) / (4 * PI) * (2 * (1 - nu) + 2 * (1 - 2 * nu) * s + (7 - 8 * nu) * s * s) / s,
                     part = a / (2 * s);
        if (a < s) nlc_assert_abs(w, point, (0.5 * part * part + 2 * NORMAL * EPS) * terms); /* as the header says */
    }
    nlc_assert_rel(nlc_love_nonlocal_displacement(1, 0.1, 0, 1, 1, 0.3), -nlc_contact_displacement(1, 0.1, 0, 1, 0.3),
                   (NORMAL + 8) * EPS); /* the middle of the circle */
}
END_TEST

/* Whatever the solver may hand over: two contacts in one place, a circle larger than the sphere, normals off by 1e-6. */
START_TEST(kernel_is_finite)
{
    const double s[] = {0, 1e-300, 1e-30, 1e-16, 1e-8, 0.05, 0.5, 1, 1 + 5e-7},
                 t[] = {0, 1e-300, 1e-30, 1e-16, 0.1, 1, 1.1, 100, 1e10};
    for (size_t i = 0; i < COUNT(s); i++)
        for (size_t j = 0; j < COUNT(t); j++)
            for (double nu = 0; nu <= 0.5; nu += 0.25) {
                double w = NAN;
                nlc_assert_quiet(w = nlc_love_kernel(s[i], t[j], nu));
                if (!isfinite(w)) ck_abort_msg("s = %a, t = %a, nu = %g: %a", s[i], t[j], nu, w);
            }
}
END_TEST

/* ------------------------------------------------------------------------------------------- domain, range, scaling -- */

/* Force, lengths and modulus times powers of two, far enough to leave the range of every intermediate: the same bits. */
START_TEST(scaling)
{
    rng g = {64};
    for (int n = 0; n < 20000; n++) {
        const double a = rng_log(&g, -60, 4), r = rng_log(&g, -60, 4), z = rng_log(&g, -60, 4), P = rng_log(&g, -2, 2);
        const double E = rng_log(&g, -2, 2), nu = draw_poisson(&g), theta = rng_uniform(&g, 0.001, PI);
        const int p = (int)rng_below(&g, 400) - 200, l = (int)rng_below(&g, 800) - 400, e = (int)rng_below(&g, 400) - 200;
        const double P2 = ldexp(P, p), E2 = ldexp(E, e), a2 = ldexp(a, l), r2 = ldexp(r, l);
        double x[12], y[12];
        love(x, P, a, r, z, E, nu);
        love(y, P2, a2, r2, ldexp(z, l), E2, nu);
        nlc_point_displacement(x + 6, P, theta, r, E, nu);
        nlc_point_displacement(y + 6, P2, theta, r2, E2, nu);
        nlc_point_stress(x + 8, P, theta, r, nu);
        nlc_point_stress(y + 8, P2, theta, r2, nu);
        for (int k = 0; k < 12; k++) {
            const int power = k < 2 || k == 6 || k == 7 ? p - l - e : p - 2 * l;
            /* where it stays normal: scaling a subnormal number rounds */
            if (fabs(y[k]) < DBL_MIN * 4 || fabs(x[k]) < DBL_MIN * 4 || isinf(y[k])) continue;
            nlc_assert_same(y[k], ldexp(x[k], power));
        }
        const double w = nlc_love_nonlocal_displacement(P, a, theta, r, E, nu);
        nlc_assert_same(nlc_love_nonlocal_displacement(P2, a2, theta, r2, E2, nu), ldexp(w, p - l - e));
    }
}
END_TEST

/* At nu = 1/2 nothing of the order of 1 hides what is left, however small or large the numbers. */
START_TEST(far_out)
{
    double f[6];
    love(f, 1e300, 1e-300, 1, 1e-320, 1, 0.5); /* Boussinesq: s_rr = -3 P z r^2 / (2 pi rho^5), u_r = 3 P z / (4 pi E r^2) */
    nlc_assert_rel(f[3], -3e300 / (2 * PI) * 1e-320, STRESS * EPS);
    nlc_assert_rel(f[1], 3e300 / (4 * PI) * 1e-320, DISPLACEMENT * EPS);
    love(f, 1, 1e-250, 0, 1e-80, 1, 0.5); /* Johnson 3.45a for small a/z at nu = 1/2: s_tt = -3 P a^2 / (10 pi z^4) */
    nlc_assert_rel(f[4], -0.3 / PI * 1e-180, (STRESS + 4) * EPS);
    nlc_assert_same(f[3], f[4]);
    love(f, 1e308, 1e-308, 1e-308, 1e-308, 1, 0.3);
    for (int k = 0; k < 6; k++) ck_assert_msg(isinf(f[k]), "%s = %a", names[k], f[k]);
    nlc_point_stress(f, 1, 1e-200, 1, 0.3);
    ck_assert_msg(f[1] == INFINITY && f[2] == -INFINITY && isfinite(f[0]) && isfinite(f[3]), "%a %a", f[1], f[2]);
    love(f, 1, 1, 0, 1e300, 1, 0.3);
    nlc_assert_rel(f[0], (1 + 0.3) * (2 * 0.7 + 1) / (2 * PI) / 1e300, DISPLACEMENT * EPS);
}
END_TEST

/* In order force, radius, r (theta), z (R), E, nu. */
static void call(double y[16], const double x[6])
{
    nlc_love_displacement(y, x[0], x[1], x[2], x[3], x[4], x[5]);
    nlc_love_stress(y + 2, x[0], x[1], x[2], x[3], x[5]);
    y[6] = nlc_love_nonlocal_displacement(x[0], x[1], x[2], x[3], x[4], x[5]);
    nlc_point_displacement(y + 7, x[0], x[2], x[3], x[4], x[5]);
    nlc_point_stress(y + 9, x[0], x[2], x[3], x[5]);
    nlc_point_traction(y + 13, x[0], x[2], x[3], x[5]);
}

/* Whether result k looks at argument j. */
static bool looks_at(int k, int j)
{
    if (j == 1) return k < 7;
    if (j == 4) return k < 2 || k == 6 || k == 7 || k == 8;
    return true;
}

static const double special[] = {0,  -0.0, 4.9e-324, DBL_MIN / 2, 1e-160, 0x1p-30,  0.5,       1 - EPS / 2, 1,
                                 PI, 4,    1e160,    DBL_MAX,     -1,     INFINITY, -INFINITY, NAN};

/* Every combination of special values: NaN where an argument is outside the domain, never elsewhere; no exception. */
START_TEST(special_values)
{
    for (int i = 0; i < 17 * 17 * 17 * 17 * 3 * 3; i++) {
        const double E[3] = {1, INFINITY, 1e-300}, nu[3] = {0.5, 0, 0.3};
        double x[6], y[16];
        int n = i;
        for (int j = 0; j < 4; j++, n /= 17) x[j] = special[n % 17];
        x[4] = E[n % 3];
        x[5] = nu[n / 3];
        fp_begin();
        call(y, x);
        const char *raised = fp_end();
        if (*raised) ck_abort_msg("%s: %a %a %a %a %a %a", raised, x[0], x[1], x[2], x[3], x[4], x[5]);
        const bool lengths = x[1] >= 0 && x[2] >= 0 && x[3] >= 0 && isfinite(x[1]) && isfinite(x[2]) && isfinite(x[3]);
        const bool fields_ok = isfinite(x[0]) && lengths && x[1] + x[2] + x[3] > 0;
        const bool sphere_ok = isfinite(x[0]) && x[2] > 0 && x[2] <= PI && x[3] > 0;
        const bool normal_ok =
            isfinite(x[0]) && x[1] >= 0 && isfinite(x[1]) && x[2] >= 0 && x[2] <= PI && x[3] > 0 && x[1] + x[2] > 0;
        for (int k = 0; k < 15; k++) {
            const bool ok = k < 6 ? fields_ok : k == 6 ? normal_ok : sphere_ok;
            if (isnan(y[k]) == ok)
                ck_abort_msg("result %d is %a: %a %a %a %a %a %a", k, y[k], x[0], x[1], x[2], x[3], x[4], x[5]);
        }
    }
}
END_TEST

/* With traps on, special values in all places: a flag that is raised and cleared again ends the test with SIGFPE. */
START_TEST(special_values_trapped)
{
    rng g = {17};
    double y[16];
    for (int n = 0; n < 500000; n++) {
        double x[6];
        for (int j = 0; j < 6; j++) x[j] = special[rng_below(&g, rng_below(&g, 4) ? 9 : COUNT(special))];
        call(y, x);
    }
}
END_TEST

/* E, nu outside their domain, and NaN in each place. */
START_TEST(domain)
{
    const double good[6] = {1, 0.1, 1, 0.7, 2, 0.3}, bad_young[] = {0, -0.0, -1, -INFINITY, NAN},
                 bad_poisson[] = {-1e-300, 0.5 + EPS, 1, NAN};
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < 5; i++) {
            double x[6], y[16];
            memcpy(x, good, sizeof x);
            if (i > 0 && j < 4) continue;
            if (i > 3 && j == 5) continue;
            x[j] = j < 4 ? NAN : j == 4 ? bad_young[i] : bad_poisson[i];
            nlc_assert_quiet(call(y, x));
            for (int k = 0; k < 15; k++) {
                const bool ok = !looks_at(k, j);
                if (isnan(y[k]) == ok) ck_abort_msg("result %d is %a with argument %d = %a", k, y[k], j, x[j]);
            }
        }
    double y[16], rigid[6] = {1, 0.1, 1, 0.7, INFINITY, 7}, flat[6] = {1, 0.1, 1, INFINITY, 1, 0.3};
    call(y, rigid); /* a rigid body may have any Poisson's ratio, and does not move */
    nlc_assert_abs(fabs(y[0]) + fabs(y[1]) + fabs(y[6]) + fabs(y[7]) + fabs(y[8]), 0, 0);
    call(y, flat);
    for (int k = 6; k < 15; k++) nlc_assert_abs(y[k], 0, 0);
}
END_TEST

/* The figures in the header and those asserted here are the same. */
START_TEST(bounds_of_the_header)
{
    static const struct {
        const char *declaration;
        int bound;
    } said[] = {{"void nlc_point_displacement(", POINT_DISPLACEMENT},
                {"void nlc_point_stress(", POINT_STRESS},
                {"void nlc_point_traction(", POINT_TRACTION},
                {"void nlc_love_displacement(", DISPLACEMENT},
                {"void nlc_love_stress(", STRESS},
                {"double nlc_love_nonlocal_displacement(", NORMAL}};
    static char text[1 << 18];
    FILE *file = fopen(NLC_SOURCE_DIR "/include/nlcontact.h", "r");
    if (!file) return;
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    for (size_t i = 0; i < COUNT(said); i++) {
        int found = -1;
        const char *end = strstr(text, said[i].declaration);
        ck_assert_ptr_nonnull(end);
        for (const char *p = text; (p = strstr(p, "orst error ")) && p < end; p++) sscanf(p, "orst error %d", &found);
        ck_assert_msg(found == said[i].bound, "%s: the header says %d, here it is %d", said[i].declaration, found,
                      said[i].bound);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("love");
    TCase *exact = tcase_create("exact values"), *laws = tcase_create("what must hold"),
          *range = tcase_create("domain and range");
    TCase *trapped = tcase_create("with traps");
    tcase_add_test(exact, table);
    tcase_add_test(exact, normal_displacement_table);
    tcase_add_test(exact, printed_equations);
    tcase_add_test(exact, boussinesq_over_hertz);
    tcase_add_test(exact, surface_and_axis);
    tcase_add_test(laws, hooke_and_equilibrium);
    tcase_add_test(laws, case_one);
    tcase_add_test(laws, case_one_hangs_together);
    tcase_add_test(laws, resultant);
    tcase_add_test(laws, normal_displacement);
    tcase_add_test(laws, kernel_is_finite);
    tcase_add_test(range, scaling);
    tcase_add_test(range, far_out);
    tcase_add_test(range, special_values);
    tcase_add_test(range, domain);
    tcase_add_test(range, bounds_of_the_header);
    tcase_add_checked_fixture(trapped, fp_trap, fp_untrap);
    tcase_add_test(trapped, special_values_trapped);
    TCase *all[] = {exact, laws, range, trapped};
    for (size_t i = 0; i < COUNT(all); i++) {
        time_limit(all[i], 60);
        suite_add_tcase(suite, all[i]);
    }
    return run_suite(suite);
}
