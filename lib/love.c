/* SPDX-License-Identifier: BSD-2-Clause */
/* love.c - Case II of [GC]: the fields of Hertz pressure on a circle of a half-space, [GC] 26-29; formulas in love.h. */
#include "love.h"

#include "hertz.h"
#include "nlcontact.h"

static const double pi = 3.14159265358979323846;

/* A point in the coordinates of love.h.  Numbers of any size: the results may be in range where c or y is not. */
typedef struct place {
    nlc_scaled c, sigma, y, less, more, h, d; /* ..., 1-y, 1+y, h, d1 d2 / h^2 */
    nlc_love_point point;
} place;

static nlc_scaled half(nlc_scaled a)
{
    a.e--;
    return a;
}

static nlc_scaled negative(nlc_scaled a)
{
    a.m = -a.m;
    return a;
}

static nlc_scaled square(nlc_scaled a)
{
    return nlc_times(a, a);
}

static nlc_scaled scaled(double x)
{
    return (nlc_scaled){x, 0};
}

static double plain(nlc_scaled a)
{
    return nlc_join(a.m, a.e);
}

/*
 * With r^2 + z^2 - a^2 = f, kappa is (d1 d2 + f)/2 and a^2 c^2 is (d1 d2 - f)/2: the one without cancellation is taken, the
 * other follows from m c = z.  At the rim both are 0, and all that is divided by them is, too.
 */
static place place_at(double radius, double r_, double z_)
{
    const nlc_scaled a = nlc_split(radius), r = nlc_split(fabs(r_)), z = nlc_split(fabs(z_));
    const nlc_scaled less = nlc_sum(r, negative(a)), more = nlc_sum(r, a);
    const nlc_scaled d1 = nlc_root(nlc_sum(square(less), square(z))), d2 = nlc_root(nlc_sum(square(more), square(z)));
    nlc_scaled f = nlc_sum(nlc_times(less, more), square(z));
    const bool outside = f.m >= 0;
    f.m = fabs(f.m);
    const nlc_scaled root = nlc_root(half(nlc_sum(nlc_times(d1, d2), f)));
    const nlc_scaled m = outside ? root : nlc_over(nlc_times(z, a), root), b = half(nlc_sum(d1, d2));
    place p = {.h = half(nlc_sum(b, m)), .sigma = nlc_over(r, b)};
    p.c = nlc_over(outside ? z : root, outside ? root : a);
    p.y = square(half(nlc_over(a, p.h)));
    p.less = nlc_over(m, p.h);
    p.more = nlc_over(b, p.h);
    p.d = nlc_over(nlc_times(d1, d2), square(p.h));
    p.point = nlc_love_point_at(plain(p.c), plain(square(p.sigma)), plain(p.y), plain(p.less), plain(p.more));
    return p;
}

/* A circle of any radius, but not the point of a point force */
static bool in_domain(double force, double radius, double r, double z)
{
    if (!nlc_is_finite(force) || !nlc_is_finite(radius) || !nlc_is_finite(r) || !nlc_is_finite(z)) return false;
    if (radius < 0 || r < 0 || z < 0) return false;
    return nlc_is_positive(radius) || nlc_is_positive(r) || nlc_is_positive(z);
}

void nlc_love_displacement(double displacement[2], double force, double radius, double r, double z, double E, double nu)
{
    displacement[0] = displacement[1] = NAN;
    if (!in_domain(force, radius, r, z) || !nlc_is_material(E, nu)) return;
    displacement[0] = displacement[1] = 0;
    if (!nlc_is_finite(E)) return;
    const place p = place_at(radius, r, z);
    const nlc_scaled c = nlc_times(p.c, p.less), chi = scaled((1 - 2 * nu) * nlc_love_radial_chi(&p.point));
    const nlc_scaled radial = nlc_sum(nlc_times(c, scaled(nlc_love_radial_v(&p.point))), negative(chi));
    const nlc_scaled unit = nlc_over(nlc_times(nlc_split(force), scaled((1 + nu) / (2 * pi))), nlc_times(nlc_split(E), p.h));
    displacement[0] = plain(nlc_times(unit, scaled(nlc_love_axial(&p.point, nu))));
    displacement[1] = plain(nlc_times(unit, nlc_times(p.sigma, radial)));
}

/*
 * [GC] 27 with nu = 1/2 - (1-2nu)/2.  Love's hoop stress is that of [GC] 27 with (1/r) d/dr in the place of d^2/dr^2:
 *     sigma_rr = P/(2 pi h^2) { (1-2nu) [ s + 3cq/8 ] - 3 c [ y l/8 + sigma^2 ((1-y)/(1+y))^2 h^2/(d1 d2) ] }
 *     sigma_tt = P/(2 pi h^2) { (1-2nu) [ 3cq/8 - s ] - 3 c y l/8 },     s = sigma^2 (2+c) / (2 (1+c)^2 (1+y)^2),
 *     y l = 2q - (1-y) k/(1+y)^2,     l = (7+2y-y^2)/(1+y)^2 - 3 (1-y) e > 0
 * and of V's second derivatives only the rational part is left in sigma_zz = -3P/(2 pi) c^3/(d1 d2) and
 * sigma_rz = -3P/(2 pi) c^2 sigma (m/b)/(d1 d2).
 */
void nlc_love_stress(double stress[4], double force, double radius, double r, double z, double nu)
{
    stress[0] = stress[1] = stress[2] = stress[3] = NAN;
    if (!in_domain(force, radius, r, z) || !nlc_is_poisson(nu)) return;
    const place p = place_at(radius, r, z);
    const nlc_love_point *o = &p.point;
    const double c = o->c, y = o->y, n = o->more * o->more, l = (7 + y * (2 - y)) / n - 3 * o->less * o->e;
    const double s = o->sigma2 * (2 + c) / (2 * (1 + c) * (1 + c) * n), t = 0.375 * c * o->q, mild = 1 - 2 * nu;
    const nlc_scaled slope = nlc_over(nlc_times(p.sigma, p.less), p.more), ring = nlc_times(p.y, scaled(0.125 * l));
    const nlc_scaled unit = nlc_over(nlc_times(nlc_split(force), scaled(1 / (2 * pi))), square(p.h));
    const nlc_scaled c3 = nlc_times(p.c, scaled(-3)), pole = nlc_over(nlc_times(nlc_times(unit, c3), p.c), p.d);
    const nlc_scaled across = nlc_sum(ring, nlc_over(square(slope), p.d));
    stress[0] = plain(nlc_times(pole, p.c));
    stress[1] = plain(nlc_times(unit, nlc_sum(scaled(mild * (t + s)), nlc_times(c3, across))));
    stress[2] = plain(nlc_times(unit, nlc_sum(scaled(mild * (t - s)), nlc_times(c3, ring))));
    stress[3] = plain(nlc_times(pole, slope));
}

double nlc_love_nonlocal_displacement(double force, double radius, double theta, double R, double E, double nu)
{
    if (!nlc_is_finite(radius) || radius < 0 || nlc_is_nan(theta)) return NAN;
    if (!nlc_is_positive(radius)) return nlc_nonlocal_displacement(force, theta, R, E, nu);
    if (!nlc_is_finite(force) || !nlc_is_positive_or_infinite(R) || !nlc_is_material(E, nu)) return NAN;
    if (theta < 0 || theta > pi) return NAN;
    if (!nlc_is_finite(R) || !nlc_is_finite(E)) return 0;
    const nlc_scaled s = nlc_half_sine(theta), near = {s.m, s.e + 1}, t = nlc_over(nlc_split(radius), nlc_split(R));
    const nlc_scaled sum = nlc_sum(near, t), gap = nlc_sum(near, negative(t));
    const nlc_scaled n = nlc_over(near, sum), c = nlc_over(t, sum), g = nlc_over(gap, sum);
    const nlc_scaled f = scaled((1 + nu) / (4 * pi) * nlc_love_outward(plain(n), plain(c), plain(g), plain(s), nu));
    return plain(nlc_over(nlc_times(nlc_split(force), f), nlc_times(nlc_times(nlc_split(E), nlc_split(R)), sum)));
}
