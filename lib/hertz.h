/* SPDX-License-Identifier: BSD-2-Clause */
/* hertz.h - the arguments that the scalar functions share. */
#ifndef NLC_HERTZ_H
#define NLC_HERTZ_H

#include "number.h"

/* A Poisson's ratio that an elastic side may have; a rigid side may have any but NaN. */
static inline bool nlc_is_poisson(double nu)
{
    return !nlc_is_nan(nu) && nu >= 0 && nu <= 0.5;
}

static inline bool nlc_is_material(double E, double nu)
{
    if (nlc_is_nan(nu) || !nlc_is_positive_or_infinite(E)) return false;
    return !nlc_is_finite(E) || nlc_is_poisson(nu);
}

/* (1 - nu^2) / E; 0 if rigid */
static inline nlc_scaled nlc_compliance(double E, double nu)
{
    nlc_scaled q = {0, 0};
    if (!nlc_is_finite(E)) return q;
    nlc_scaled s = nlc_split(E);
    q.m = (1 - nu * nu) / s.m;
    q.e = -s.e;
    return q;
}

/* 1 / R; 0 if flat */
static inline nlc_scaled nlc_curvature(double R)
{
    nlc_scaled q = {0, 0};
    if (!nlc_is_finite(R)) return q;
    nlc_scaled s = nlc_split(R);
    q.m = 1 / s.m;
    q.e = -s.e;
    return q;
}

/* sin(theta/2), 0 < theta <= pi */
static inline nlc_scaled nlc_half_sine(double theta)
{
    nlc_scaled s = nlc_split(theta);
    /* below 2^-30 the sine is its argument to the last bit, and theta/2 might be subnormal */
    if (s.e > -30) s = nlc_split(2 * sin(theta / 2));
    s.e -= 1;
    return s;
}

#endif
