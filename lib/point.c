/* SPDX-License-Identifier: BSD-2-Clause */
/* point.c - Case I of [GC]: Boussinesq's fields on the sphere through his point force, [GC] 2 and 21-23. */
#include "nlcontact.h"

#include "hertz.h"

static const double pi = 3.14159265358979323846;

static bool in_domain(double force, double theta, double R)
{
    return nlc_is_finite(force) && nlc_is_positive(theta) && theta <= pi && nlc_is_positive_or_infinite(R);
}

void nlc_point_displacement(double displacement[2], double force, double theta, double R, double E, double nu)
{
    displacement[0] = displacement[1] = NAN;
    if (!in_domain(force, theta, R) || !nlc_is_material(E, nu)) return;
    displacement[0] = displacement[1] = 0;
    if (!nlc_is_finite(R) || !nlc_is_finite(E)) return;
    const nlc_scaled p = nlc_split(force), l = nlc_split(R), e = nlc_split(E), half_sine = nlc_half_sine(theta);
    const double s = nlc_join(half_sine.m, half_sine.e), k = cos(theta / 2), unit = (1 + nu) * p.m / (4 * pi * (l.m * e.m));
    const int exponent = p.e - l.e - e.e - half_sine.e;
    displacement[0] = nlc_join(unit * (2 * (1 - nu) + s * s) / half_sine.m, exponent);
    displacement[1] = nlc_join(unit * k * (s - (1 - 2 * nu) / (1 + s)) / half_sine.m, exponent);
}

/* P / (8 pi R^2) */
static nlc_scaled pressure(double force, double R)
{
    const nlc_scaled l = nlc_split(R);
    return nlc_over(nlc_times(nlc_split(force), (nlc_scaled){1 / pi, -3}), nlc_times(l, l));
}

void nlc_point_stress(double stress[4], double force, double theta, double R, double nu)
{
    stress[0] = stress[1] = stress[2] = stress[3] = NAN;
    if (!in_domain(force, theta, R) || !nlc_is_poisson(nu)) return;
    stress[0] = stress[1] = stress[2] = stress[3] = 0;
    if (!nlc_is_finite(R)) return;
    const nlc_scaled q = pressure(force, R), sine = nlc_half_sine(theta);
    const double s = nlc_join(sine.m, sine.e), k = cos(theta / 2), mild = 1 - 2 * nu, far = 1 / (1 + s);
    const nlc_scaled radial = nlc_sum((nlc_scaled){mild * far, 0}, nlc_times(sine, (nlc_scaled){-3 * k * k, 0}));
    stress[0] = nlc_join(-3 * q.m * sine.m, q.e + sine.e);
    stress[1] = nlc_join(q.m * radial.m / (sine.m * sine.m), q.e + radial.e - 2 * sine.e);
    stress[2] = nlc_join(q.m * mild * (s - far) / (sine.m * sine.m), q.e - 2 * sine.e);
    stress[3] = nlc_join(-3 * q.m * k, q.e);
}

void nlc_point_traction(double traction[2], double force, double theta, double R, double nu)
{
    traction[0] = traction[1] = NAN;
    if (!in_domain(force, theta, R) || !nlc_is_poisson(nu)) return;
    traction[0] = traction[1] = 0;
    if (!nlc_is_finite(R)) return;
    const nlc_scaled q = pressure(force, R), sine = nlc_half_sine(theta);
    const double s = nlc_join(sine.m, sine.e), k = cos(theta / 2);
    const nlc_scaled radial = nlc_sum((nlc_scaled){2 * (1 - 2 * nu) / (1 + s), 0}, nlc_times(sine, (nlc_scaled){-3, 0}));
    traction[0] = nlc_join(-3 * q.m * sine.m, q.e + sine.e);
    traction[1] = nlc_join(q.m * k * radial.m / sine.m, q.e + radial.e - sine.e);
}
