/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * sphere.c - the elastic sphere: displacement of its surface by a point force, to second order in contact radius / radius by a
 * contact, and of a contact by its own force.
 *
 * Exact linear elasticity of the whole sphere, from its modes (sphere_prepare.c).  A contact is a Hertz pressure
 * p = (3P/2 pi a^2) (1 - rho^2/a^2)^(1/2) over a circle of radius a = t R, rho = R sin psi, and a tangential traction
 * chi p psi away from its centre: with chi = 1 the traction acts along the axis of the contact, as between equal spheres
 * and on a rigid plate.  To order t^2, seen from elsewhere,
 *     S + (t^2/10) D,   D = (lap + 2) S - chi (4 S + 2 lap B):
 * <psi^2> = (2/5) t^2 over the pressure gives (t^2/10) lap S, balance with P along the axis the terms 2 and -4 chi, and the
 * tangential traction, by reciprocity with the tangential displacement U grad B of a point force, -2 chi lap B.
 */
#include "nlcontact.h"

#include "hertz.h"
#include "sphere.h"

static const double pi = 3.14159265358979323846;

/* h = 2 sin(theta/2); below 2^-30 the sine is its argument to the last bit, and theta/2 might be subnormal */
static nlc_scaled chord(double theta)
{
    const nlc_scaled h = nlc_split(theta);
    return h.e > -30 ? nlc_split(2 * sin(theta / 2)) : h;
}

static bool is_angle(double theta)
{
    return nlc_is_positive(theta) && theta <= pi;
}

static bool is_tilt(double chi)
{
    return !nlc_is_nan(chi) && chi >= 0 && chi <= 1e60;
}

/* Below 2^-100 only the poles count: what comes after 1/h is smaller by h ln h. */
static nlc_scaled green(nlc_scaled h, double nu)
{
    nlc_sphere_constants k;
    if (h.e < -100) return (nlc_scaled){4 * (1 - nu) / h.m, -h.e};
    nlc_sphere_prepare(&k, nu, 1);
    const double length = nlc_join(h.m, h.e);
    return (nlc_scaled){nlc_sphere_at(length * length, &k).s, 0};
}

double nlc_sphere_green(double theta, double nu)
{
    if (!is_angle(theta) || !nlc_is_poisson(nu)) return NAN;
    const nlc_scaled s = green(chord(theta), nu);
    return nlc_join(s.m, s.e);
}

double nlc_sphere_finite_size(double theta, double nu, double chi)
{
    if (!is_angle(theta) || !nlc_is_poisson(nu) || !is_tilt(chi)) return NAN;
    nlc_sphere_constants k;
    nlc_sphere_prepare(&k, nu, chi);
    const nlc_scaled h = chord(theta);
    const double length = nlc_join(h.m, h.e), t = length * length;
    if (h.e < -100) return nlc_join((k.d.pole3 + t * k.d.pole) / (h.m * h.m * h.m), -3 * h.e);
    return nlc_sphere_at(t, &k).d;
}

/* c[0] + c_log[0] ln t + c[1] t + (c[2] + c_log[1] ln t) t^2 */
static double expansion(double t, const double c[3], const double c_log[2])
{
    const nlc_scaled s = nlc_split(t);
    const double log_t = 2 * nlc_half_log(s.m) + s.e * 0x1.62e42fefa39efp-1;
    return c[0] + c_log[0] * log_t + t * (c[1] + t * (c[2] + c_log[1] * log_t));
}

static bool prepare_self(nlc_sphere_constants *k, double t, double nu, double chi)
{
    if (!nlc_is_positive(t) || t > 1 || !nlc_is_poisson(nu) || !is_tilt(chi)) return false;
    nlc_sphere_prepare(k, nu, chi);
    return true;
}

double nlc_sphere_self(double t, double nu, double chi)
{
    nlc_sphere_constants k;
    return prepare_self(&k, t, nu, chi) ? expansion(t, k.self, k.self_log) : NAN;
}

double nlc_sphere_self_energy(double t, double nu, double chi)
{
    nlc_sphere_constants k;
    return prepare_self(&k, t, nu, chi) ? expansion(t, k.energy, k.energy_log) : NAN;
}

double nlc_sphere_displacement(double force, double theta, double R, double E, double nu)
{
    if (!nlc_is_finite(force) || !nlc_is_positive_or_infinite(R) || !nlc_is_material(E, nu) || !is_angle(theta)) return NAN;
    if (!nlc_is_finite(R) || !nlc_is_finite(E)) return 0;
    const nlc_scaled p = nlc_split(force), r = nlc_split(R), e = nlc_split(E), s = green(chord(theta), nu);
    return nlc_join(-(1 + nu) * p.m * s.m / (4 * pi * (r.m * e.m)), p.e - r.e - e.e + s.e);
}
