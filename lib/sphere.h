/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * sphere.h - the elastic sphere: surface displacement by a point force, S, and by the finite size of a contact, D, as short
 * expressions in the distance of two unit vectors, h = |N_c - N_d| = 2 sin(theta/2).
 *
 * Both are   odd powers of 1/h  +  ln h r(h^2)  +  p(h-1)   with polynomials r and p: the shape that the exact functions have
 * at h -> 0.  tools/sphere_table.py says how they are found, sphere.c what S and D are.  Evaluation has no branch and no call,
 * so that loops over it become vectors.
 */
#ifndef NLC_SPHERE_H
#define NLC_SPHERE_H

#include "number.h"

#define NLC_SPHERE_LOG 5     /* coefficients of r */
#define NLC_SPHERE_SMOOTH 13 /* of p */

typedef struct nlc_sphere_series {
    double pole, pole3; /* of 1/h and 1/h^3 */
    double log[NLC_SPHERE_LOG], smooth[NLC_SPHERE_SMOOTH];
} nlc_sphere_series;

/*
 * What depends on Poisson's ratio and chi alone.  The self displacement of a contact of radius a, t = a/R, is
 * S1(t) = self[0] + self_log[0] ln t + self[1] t + (self[2] + self_log[1] ln t) t^2; energy and energy_log are those of Sbar.
 */
typedef struct nlc_sphere_constants {
    nlc_sphere_series s, d;
    double self[3], self_log[2], energy[3], energy_log[2];
} nlc_sphere_constants;

/* The ten coefficients of the self terms are quadratic in chi: c[0] + c[1] (chi-1) + c[2] (chi-1)^2 of each. */
typedef struct nlc_sphere_quadratic {
    double self[3][3], self_log[2][3], energy[3][3], energy_log[2][3];
} nlc_sphere_quadratic;

/* 0 <= poisson <= 0.5, 0 <= chi <= 1e60; about a microsecond */
void nlc_sphere_prepare(nlc_sphere_constants *constants, double poisson, double chi);

/* ln(x) / 2 for a normal x > 0, to 5e-15 + 1e-16 |ln x| */
static inline double nlc_half_log(double x)
{
    const uint64_t root_half = UINT64_C(0x3fe6a09e667f3bcd), b = nlc_bits(x) - root_half + (UINT64_C(1024) << 52);
    const double e = nlc_from_bits(b >> 52 | UINT64_C(0x4330000000000000)) - 0x1.00000000004p52; /* x = m 2^e */
    const double m = nlc_from_bits((b & NLC_MANTISSA_MASK) + root_half), z = (m - 1) / (m + 1), w = z * z;
    /* atanh(z) / z for |z| <= (sqrt(2) - 1)^2, to 3e-14 */
    const double low = 0x1.fffffffffff12p-1 + w * (0x1.555555567148cp-2 + w * 0x1.9999962c06032p-3);
    const double high = 0x1.2494381ee5869p-3 + w * (0x1.c620ee6e2b4a3p-4 + w * 0x1.9192e478c4308p-4);
    return e * 0x1.62e42fefa39efp-2 + z * (low + w * w * w * high);
}

typedef struct nlc_sphere_pair {
    double s, d;
} nlc_sphere_pair;

static inline double nlc_sphere_smooth(const double *p, double y, double y2)
{
    const double even = p[0] + y2 * (p[2] + y2 * (p[4] + y2 * (p[6] + y2 * (p[8] + y2 * (p[10] + y2 * p[12])))));
    const double odd = p[1] + y2 * (p[3] + y2 * (p[5] + y2 * (p[7] + y2 * (p[9] + y2 * p[11]))));
    return even + y * odd;
}

static inline double nlc_sphere_log(const double *p, double t)
{
    return p[0] + t * (p[1] + t * (p[2] + t * (p[3] + t * p[4])));
}

/*
 * From 0 <= t = h^2 <= 4 (1 + 1e-6).  The floor is too small to change a result where h > 2^-100, keeps t = 0 from dividing by
 * zero, and 1/h^3 far from overflow.
 */
static inline nlc_sphere_pair nlc_sphere_at(double h2, const nlc_sphere_constants *restrict k)
{
    const double t = h2 + 0x1p-300, h = sqrt(t), r = 1 / h, y = h - 1, y2 = y * y, log_h = nlc_half_log(t);
    nlc_sphere_pair pair;
    pair.s = r * k->s.pole + (log_h * nlc_sphere_log(k->s.log, t) + nlc_sphere_smooth(k->s.smooth, y, y2));
    pair.d =
        r * (k->d.pole + r * r * k->d.pole3) + (log_h * nlc_sphere_log(k->d.log, t) + nlc_sphere_smooth(k->d.smooth, y, y2));
    return pair;
}

/* D(1) - D(0): what chi - 1 is multiplied by. */
static inline double nlc_sphere_tilt_at(double h2, const nlc_sphere_series *restrict e)
{
    const double t = h2 + 0x1p-300, h = sqrt(t), r = 1 / h, y = h - 1;
    return r * (e->pole + r * r * e->pole3) +
           (nlc_half_log(t) * nlc_sphere_log(e->log, t) + nlc_sphere_smooth(e->smooth, y, y * y));
}

/* S and D for t[n]; false: some t is 0 or below 2^-200, for which S and D mean nothing. */
bool nlc_sphere_evaluate(double *restrict s, double *restrict d, const double *restrict t, int n,
                         const nlc_sphere_constants *restrict constants);

#endif
