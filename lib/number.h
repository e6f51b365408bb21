/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * number.h - doubles looked at as bits: tests and scalings that raise no floating-point exception, whatever the input.
 *
 * A comparison with < raises invalid for a quiet NaN, and ldexp raises overflow and sets errno; hosts run with traps on.
 */
#ifndef NLC_NUMBER_H
#define NLC_NUMBER_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define NLC_SIGN_BIT UINT64_C(0x8000000000000000)
#define NLC_INFINITY_BITS UINT64_C(0x7ff0000000000000)
#define NLC_MANTISSA_MASK UINT64_C(0x000fffffffffffff)
#define NLC_ONE_BITS UINT64_C(0x3ff0000000000000)

static inline uint64_t nlc_bits(double x)
{
    uint64_t b;
    memcpy(&b, &x, sizeof b);
    return b;
}

static inline double nlc_from_bits(uint64_t b)
{
    double x;
    memcpy(&x, &b, sizeof x);
    return x;
}

/* Bits of |x|: they are ordered like |x| itself, with infinity and then NaN at the upper end. */
static inline uint64_t nlc_abs_bits(double x)
{
    return nlc_bits(x) & ~NLC_SIGN_BIT;
}

static inline bool nlc_is_nan(double x)
{
    return nlc_abs_bits(x) > NLC_INFINITY_BITS;
}

static inline bool nlc_is_finite(double x)
{
    return nlc_abs_bits(x) < NLC_INFINITY_BITS;
}

/* 0 < x < infinity */
static inline bool nlc_is_positive(double x)
{
    return nlc_bits(x) - 1 < NLC_INFINITY_BITS - 1;
}

/* 0 < x <= infinity */
static inline bool nlc_is_positive_or_infinite(double x)
{
    return nlc_bits(x) - 1 < NLC_INFINITY_BITS;
}

/*
 * size / scale, at most 1e10, for size >= 0; a scale near 0 counts as 1e-290, a size above 1e17 as that.  Without a condition on the
 * division: compilers take divisions out of their conditions, and then they divide by zero.
 */
static inline double nlc_ratio(double size, double scale)
{
    const double r = (size < 1e17 ? size : 1e17) / (scale + 1e-290);
    return r < 1e10 ? r : 1e10;
}

/* 2^-200 <= x < 2^200: products and quotients of a few such numbers are in range */
static inline bool nlc_is_moderate(double x)
{
    return nlc_bits(x) - ((uint64_t)(1023 - 200) << 52) < (uint64_t)400 << 52;
}

/* 2^e for a normal result, -1022 <= e <= 1023 */
static inline double nlc_pow2(int e)
{
    return nlc_from_bits((uint64_t)(e + 1023) << 52);
}

/* A number of any size: m 2^e.  m = 0 or 1/8 < |m| < 64 or so, never subnormal. */
typedef struct nlc_scaled {
    double m;
    int e;
} nlc_scaled;

/* x finite = m 2^e with 1 <= |m| < 2, or m = 0.  Done in integers: a host may flush subnormal numbers to zero. */
static inline nlc_scaled nlc_split(double x)
{
    uint64_t sign = nlc_bits(x) & NLC_SIGN_BIT, b = nlc_abs_bits(x);
    nlc_scaled r = {x, 0};
    if (b == 0) return r;
    int e = (int)(b >> 52);
    if (e == 0)
        for (e = 1; b < UINT64_C(1) << 52; e--) b <<= 1;
    r.m = nlc_from_bits(sign | NLC_ONE_BITS | (b & NLC_MANTISSA_MASK));
    r.e = e - 1023;
    return r;
}

/* Smallest e with |x| < 2^e; x finite */
static inline int nlc_exponent_above(double x)
{
    return nlc_abs_bits(x) == 0 ? -1100 : nlc_split(x).e + 1;
}

/* m 2^e as a double, rounded once; infinity beyond its range, without an exception.  m finite and not subnormal. */
static inline double nlc_join(double m, int e)
{
    nlc_scaled s = nlc_split(m);
    if (nlc_abs_bits(m) == 0) return m;
    e += s.e;
    if (e > 1023) return nlc_from_bits((nlc_bits(m) & NLC_SIGN_BIT) | NLC_INFINITY_BITS);
    if (e >= -1022) return s.m * nlc_pow2(e);
    if (e < -1080) return 0 * s.m;
    return s.m * nlc_pow2(-1022) * nlc_pow2(e + 1022);
}

/* a + b.  Where signs differ m may be as small as 2^-55. */
static inline nlc_scaled nlc_sum(nlc_scaled a, nlc_scaled b)
{
    if (nlc_abs_bits(a.m) == 0) return b;
    if (nlc_abs_bits(b.m) == 0) return a;
    int e = a.e > b.e ? a.e : b.e;
    nlc_scaled r = {0, e};
    if (e - a.e <= 200) r.m += a.m * nlc_pow2(a.e - e);
    if (e - b.e <= 200) r.m += b.m * nlc_pow2(b.e - e);
    return r;
}

static inline nlc_scaled nlc_times(nlc_scaled a, nlc_scaled b)
{
    return (nlc_scaled){a.m * b.m, a.e + b.e};
}

/* a / b, where 0 / 0 is 0; b may be 0 only if a is */
static inline nlc_scaled nlc_over(nlc_scaled a, nlc_scaled b)
{
    return (nlc_scaled){a.m / (b.m + 1e-290), a.e - b.e};
}

/* Square root, a >= 0 */
static inline nlc_scaled nlc_root(nlc_scaled a)
{
    const int odd = a.e & 1;
    return (nlc_scaled){sqrt(odd ? 2 * a.m : a.m), (a.e - odd) / 2};
}

#endif
