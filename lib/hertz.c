/* SPDX-License-Identifier: BSD-2-Clause */
/* hertz.c - the local law of one contact, [GC] 7-10. */
#include "nlcontact.h"

#include "hertz.h"

/* The two sums of [GC] 8 and 9: q = sum (1-nu^2)/E, r = sum 1/R.  False: outside the domain. */
static bool pair_of_sides(double E1, double nu1, double R1, double E2, double nu2, double R2, nlc_scaled *q, nlc_scaled *r)
{
    if (!nlc_is_material(E1, nu1) || !nlc_is_material(E2, nu2)) return false;
    if (!nlc_is_positive_or_infinite(R1) || !nlc_is_positive_or_infinite(R2)) return false;
    if (!nlc_is_finite(E1) && !nlc_is_finite(E2)) return false;
    if (!nlc_is_finite(R1) && !nlc_is_finite(R2)) return false;
    *q = nlc_sum(nlc_compliance(E1, nu1), nlc_compliance(E2, nu2));
    *r = nlc_sum(nlc_curvature(R1), nlc_curvature(R2));
    return true;
}

/* Makes the exponent a multiple of n; m grows by less than 2^n. */
static void round_exponent(nlc_scaled *s, int n)
{
    int rest = s->e % n;
    if (rest < 0) rest += n;
    s->m *= nlc_pow2(rest);
    s->e -= rest;
}

/*
 * The residual r - y^3 of a cube root y, to twice the precision: libm's cbrt may be off by a few ulp, one Newton step with
 * this residual brings the result to the rounding of the last operation.
 */
static double cube_residual(double r, double y)
{
    double h = y * y, h_low = fma(y, y, -h);
    double c = h * y, c_low = fma(h, y, -c);
    return ((r - c) - c_low) - h_low * y;
}

double nlc_hertz_stiffness(double E1, double nu1, double R1, double E2, double nu2, double R2)
{
    nlc_scaled q, r;
    if (nlc_is_moderate(E1) && nlc_is_moderate(E2) && nlc_is_moderate(R1) && nlc_is_moderate(R2) && nlc_is_poisson(nu1) &&
        nlc_is_poisson(nu2)) /* the same roundings without the scaling, in less time */
        return 4 / (3 * ((1 - nu1 * nu1) / E1 + (1 - nu2 * nu2) / E2) * sqrt(1 / R1 + 1 / R2));
    if (!pair_of_sides(E1, nu1, R1, E2, nu2, R2, &q, &r)) return NAN;
    round_exponent(&r, 2);
    return nlc_join(4 / (3 * q.m * sqrt(r.m)), -q.e - r.e / 2);
}

double nlc_hertz_force(double stiffness, double overlap)
{
    if (!nlc_is_positive(stiffness) || !nlc_is_finite(overlap)) return NAN;
    if (overlap <= 0) return 0;
    nlc_scaled k = nlc_split(stiffness), x = nlc_split(overlap);
    round_exponent(&x, 2);
    return nlc_join(k.m * sqrt(x.m) * x.m, k.e + x.e + x.e / 2);
}

double nlc_hertz_overlap(double stiffness, double force)
{
    if (!nlc_is_positive(stiffness) || !nlc_is_finite(force) || force < 0) return NAN;
    if (nlc_abs_bits(force) == 0) return 0;
    nlc_scaled k = nlc_split(stiffness), r = nlc_split(force);
    r.m /= k.m;
    r.e -= k.e;
    round_exponent(&r, 3);
    double y = cbrt(r.m), h = y * y, h_low = fma(y, y, -h);
    return nlc_join(h + (h_low + cube_residual(r.m, y) * 2 / (3 * y)), r.e / 3 * 2);
}

double nlc_contact_radius(double force, double E1, double nu1, double R1, double E2, double nu2, double R2)
{
    nlc_scaled q, r;
    if (!pair_of_sides(E1, nu1, R1, E2, nu2, R2, &q, &r)) return NAN;
    if (!nlc_is_finite(force) || force < 0) return NAN;
    if (nlc_abs_bits(force) == 0) return 0;
    nlc_scaled p = nlc_split(force);
    nlc_scaled cube = {0.75 * p.m * q.m / r.m, p.e + q.e - r.e};
    round_exponent(&cube, 3);
    double y = cbrt(cube.m);
    return nlc_join(y + cube_residual(cube.m, y) / (3 * y * y), cube.e / 3);
}
