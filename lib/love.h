/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * love.h - Love's potentials without cancellation: Hertz pressure on a circle of a half-space, [GC] 26-29.
 *
 * In place of kappa, the coordinates of the ellipsoid through the point that has the circle's rim as its focus.  The
 * distances to the rim's two points in the plane of the axis are d1 <= d2; the half-axes are b = (d1 + d2)/2 in r and
 * m = sqrt(kappa) in z, b^2 - m^2 = a^2.  Further
 *     c = z/m, sigma = r/b (c^2 + sigma^2 = 1),   h = (b + m)/2,   y = a^2/(2h)^2 (1 - y = m/h, 1 + y = b/h).
 * w = sqrt(y) is the tangent of half the angle arctan(a/m), so one smooth function of y in [0, 1] is all that is left of the
 * arcus tangens.  With
 *     e = 1/5 - y/7 + y^2/9 - ...,   g = 1/3 - y e = (1 - arctan(w)/w)/y,
 *     q = 1 + (1-y) g,   k = 3 + y - (1+y)^2 g,   v = 5 - y + (1-6y+y^2) g
 * (all positive, and without cancellation) [GC] 28 becomes
 *     V = 3P/(16h) [ 2 c^2 k + sigma^2 v ],   dV/dz = -3P/(4h^2) c q,   dV/dr = -3P/(8h^2) sigma k / (1+y)
 * and [GC] 29 with 2 - 3c + c^3 = sigma^4 (2+c)/(1+c)^2
 *     (1/r) dchi/dr, -d2chi/dr2 = P [ sigma^2 (2+c)/(2 (1+c)^2 b^2) +- 3 c q / (8h^2) ].
 * a -> 0 is y -> 0 (Boussinesq's point force), z = 0 is m = 0 inside the circle and c = 0 outside, the axis is sigma = 0.
 */
#ifndef NLC_LOVE_H
#define NLC_LOVE_H

#include "number.h"

/* e of y, 0 <= y <= 1, to 1e-16 and rounding: interpolated by tests/love_coefficients.py */
static inline double nlc_love_e(double y)
{
    const double p = 0x1.9999999999999p-3 +
                     y * (0x1.018740eacb3afp-1 +
                          y * (0x1.d850777635bbcp-2 +
                               y * (0x1.808c1b58f2ca7p-3 +
                                    y * (0x1.0b808f72ce42ap-5 + y * (0x1.dfd411ee3e058p-10 + y * 0x1.9fc5b10bee7b7p-23)))));
    const double q = 1 + y * (0x1.9d56c800ebbf8p+1 +
                              y * (0x1.03a9eabadb754p+2 +
                                   y * (0x1.3fab13e3c6c60p+1 +
                                        y * (0x1.8d79417bb5fbcp-1 + y * (0x1.c9b627a169015p-4 + y * 0x1.6a1d1e927468ep-8)))));
    return p / q;
}

/* A point in these coordinates, and what the fields are made of there. */
typedef struct nlc_love_point {
    double c, sigma2, y, less, more; /* c, sigma^2, y, 1-y, 1+y */
    double e, q, k, v;
} nlc_love_point;

static inline nlc_love_point nlc_love_point_at(double c, double sigma2, double y, double less, double more)
{
    const double e = nlc_love_e(y), g = 1.0 / 3 - y * e;
    return (nlc_love_point){c, sigma2, y, less, more, e, 1 + less * g, 3 + y - more * more * g, 5 - y + (1 + y * (y - 6)) * g};
}

/* u_z = (1+nu) P / (2 pi E h) times this */
static inline double nlc_love_axial(const nlc_love_point *p, double poisson)
{
    const double c2 = p->c * p->c;
    return 0.375 * ((1 - poisson) * (2 * c2 * p->k + p->sigma2 * p->v) + 2 * c2 * p->less * p->q);
}

/* u_r = (1+nu) P / (2 pi E h) sigma times [ c (1-y) of the second - (1-2nu) of the first ] */
static inline double nlc_love_radial_chi(const nlc_love_point *p)
{
    return p->sigma2 * (2 + p->c) / (2 * (1 + p->c) * (1 + p->c) * p->more) + 0.375 * p->more * p->c * p->q;
}

static inline double nlc_love_radial_v(const nlc_love_point *p)
{
    return 0.375 * p->k / p->more;
}

/* a where x >= 0, else b: by bits, since a condition would keep compilers from making vectors of a loop */
static inline double nlc_love_choose(double x, double a, double b)
{
    const uint64_t below = 0 - (nlc_bits(x) >> 63);
    return nlc_from_bits((nlc_bits(a) & ~below) | (nlc_bits(b) & below));
}

/*
 * Outward displacement of a sphere's surface (radius 1) in units of (1+nu) P / (4 pi E (2s+t)): for a force at a distance of
 * 2s on a circle of radius t.  near = 2s/(2s+t), circle = t/(2s+t), gap = (2s-t)/(2s+t): in units of 2s + t nothing is large,
 * and the circle may have any size, also zero, or reach the point.  The small numbers keep 0/0 away at the rim and for
 * the kernel's s = t = 0; they are too small to change any other result.
 */
static inline double nlc_love_outward(double near, double circle, double gap, double s, double poisson)
{
    const double z = near * s, zt = z * circle, d = sqrt(gap * gap + 4 * zt * zt), root = sqrt((fabs(gap) + d) / 2 + 1e-60);
    const double m = nlc_love_choose(gap, root, zt / root);
    const double c = nlc_love_choose(gap, z, root) / nlc_love_choose(gap, root, circle + 1e-30);
    const double b = sqrt(circle * circle + m * m + 1e-60), i = 2 / (b + m), share = near * (1 - s * s) / b;
    const nlc_love_point p = nlc_love_point_at(c, near * share / b, circle * circle * i * i / 4, m * i, b * i);
    const double radial = (1 - 2 * poisson) * nlc_love_radial_chi(&p) - c * p.less * nlc_love_radial_v(&p);
    return -2 * i * ((1 - 2 * s * s) * nlc_love_axial(&p, poisson) + 2 * s * share * radial);
}

/*
 * The kernel of Case II: outward displacement in units of (1+nu) P / (4 pi R E), at s = sin(theta/2), by a force on a circle
 * of radius t R.  t -> 0 is Case I: [ -2(1-nu) - 2(1-2nu) s + (7-8nu) s^2 ] / s.  Right for 2s + t > 1e-80, finite
 * also for s = t = 0 and for an s of 1 + 1e-6.
 */
static inline double nlc_love_kernel(double s, double t, double poisson)
{
    const double i = 1 / (2 * s + t + 1e-100);
    return i * nlc_love_outward(2 * s * i, t * i, (2 * s - t) * i, s, poisson);
}

#endif
