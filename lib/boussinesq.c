/* SPDX-License-Identifier: BSD-2-Clause */
/* boussinesq.c - surface displacements from Boussinesq's point force: Case I of [GC] and the half-space kernel of [MC]. */
#include "nlcontact.h"

#include "hertz.h"
#include "vector.h"

static const double pi = 3.14159265358979323846;

double nlc_contact_displacement(double force, double radius, double r, double E, double nu)
{
    if (!nlc_is_finite(force) || !nlc_is_positive(radius) || !nlc_is_finite(r) || !nlc_is_material(E, nu)) return NAN;
    if (r < 0 || r > radius) return NAN;
    nlc_scaled q = nlc_compliance(E, nu), p = nlc_split(force), a = nlc_split(radius);
    double t = r / radius;
    return nlc_join(3 * p.m * q.m * (2 - t * t) / a.m, p.e + q.e - a.e - 3);
}

/* [GC] 5 with s = sin(theta/2) > 0 given as a scaled number. */
static double case_one(double force, nlc_scaled s, double R, double E, double nu)
{
    if (!nlc_is_finite(R) || !nlc_is_finite(E)) return 0;
    nlc_scaled p = nlc_split(force), r = nlc_split(R), e = nlc_split(E);
    double sine = nlc_join(s.m, s.e);
    double bracket = -2 * (1 - nu) + sine * (-2 * (1 - 2 * nu) + (7 - 8 * nu) * sine);
    return nlc_join((1 + nu) * p.m * bracket / (4 * pi * (r.m * e.m) * s.m), p.e - r.e - e.e - s.e);
}

double nlc_nonlocal_displacement(double force, double theta, double R, double E, double nu)
{
    if (!nlc_is_finite(force) || !nlc_is_positive_or_infinite(R) || !nlc_is_material(E, nu)) return NAN;
    if (!nlc_is_positive(theta) || theta > pi) return NAN;
    return case_one(force, nlc_half_sine(theta), R, E, nu);
}

double nlc_nonlocal_displacement_between(double force, const double n_c[3], const double n_d[3], double R, double E, double nu)
{
    if (!nlc_is_finite(force) || !nlc_is_positive_or_infinite(R) || !nlc_is_material(E, nu)) return NAN;
    if (!nlc_is_unit(n_c) || !nlc_is_unit(n_d)) return NAN;
    double d[3] = {n_c[0] - n_d[0], n_c[1] - n_d[1], n_c[2] - n_d[2]};
    nlc_scaled s = nlc_length(d);
    if (nlc_abs_bits(s.m) == 0) return NAN;
    s.e -= 1;
    return case_one(force, s, R, E, nu);
}

double nlc_half_space_displacement(double force, const double n_k[3], const double n_c[3], const double r_kc[3], double E,
                                   double nu, double prefactor)
{
    if (!nlc_is_finite(force) || !nlc_is_material(E, nu) || !nlc_is_finite(prefactor) || prefactor < 0) return NAN;
    if (!nlc_is_unit(n_k) || !nlc_is_unit(n_c)) return NAN;
    if (!nlc_is_finite(r_kc[0]) || !nlc_is_finite(r_kc[1]) || !nlc_is_finite(r_kc[2])) return NAN;
    double u[3] = {r_kc[0], r_kc[1], r_kc[2]};
    nlc_scaled d = nlc_length(u);
    if (nlc_abs_bits(d.m) == 0) return NAN;
    for (int x = 0; x < 3; x++) u[x] /= d.m; /* nlc_length has scaled u by 2^-d.e */
    double ku = nlc_dot(n_k, u), cu = nlc_dot(n_c, u), kc = nlc_dot(n_k, n_c);
    if (!(1 + ku > 0)) return NAN;
    if (!nlc_is_finite(E)) return 0;
    double bracket = ku * cu + (3 - 4 * nu) * kc - (1 - 2 * nu) * (kc + cu) / (1 + ku);
    nlc_scaled p = nlc_split(force), e = nlc_split(E), g = nlc_split(prefactor);
    return nlc_join(-g.m * (1 + nu) * p.m * bracket / (2 * pi * e.m * d.m), g.e + p.e - e.e - d.e);
}
