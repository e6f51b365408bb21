/* SPDX-License-Identifier: BSD-2-Clause */
/* vector.h - three components. */
#ifndef NLC_VECTOR_H
#define NLC_VECTOR_H

#include "number.h"

#define NLC_UNIT_TOLERANCE 1e-6
#define NLC_TWO_BITS (UINT64_C(1) << 62) /* set in what is 2 or more or no number, and in nothing else */

static inline double nlc_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* | |n|^2 - 1 | <= 1e-6.  Components are looked at first: a square could overflow. */
static inline bool nlc_is_unit(const double *n)
{
    if ((nlc_bits(n[0]) | nlc_bits(n[1]) | nlc_bits(n[2])) & NLC_TWO_BITS) return false;
    return fabs(nlc_dot(n, n) - 1) <= NLC_UNIT_TOLERANCE;
}

/* Length of a finite vector.  d is scaled in place by 2^-e of the result, so that nothing over- or underflows. */
static inline nlc_scaled nlc_length(double d[3])
{
    uint64_t x = nlc_abs_bits(d[0]), y = nlc_abs_bits(d[1]), z = nlc_abs_bits(d[2]);
    uint64_t largest = x > y ? x : y;
    nlc_scaled s = nlc_split(nlc_from_bits(largest > z ? largest : z));
    if (nlc_abs_bits(s.m) == 0) return s;
    for (int k = 0; k < 3; k++) {
        nlc_scaled c = nlc_split(d[k]);
        d[k] = nlc_join(c.m, c.e - s.e);
    }
    s.m = sqrt(nlc_dot(d, d));
    return s;
}

#endif
