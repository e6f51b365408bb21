/* SPDX-License-Identifier: BSD-2-Clause */
/* avx2.c - lanes.h with 4 particles at once. */
#include "../variant.h"

#ifdef NLC_HAVE_X86
#include <immintrin.h>

#define LANES 4
#define TARGET __attribute__((target("avx2,fma")))
#ifndef VARIANT
#define VARIANT nlc_variant_avx2
#endif
#define TERMS 4 /* the estimate is good to 1.5 2^-12: e is below 3 2^-12, and the next term, 63/256 e^5, below 2^-54 */

typedef __m256d vec;

#define set(x) _mm256_set1_pd(x)
#define load(p) _mm256_load_pd(p)
#define store(p, a) _mm256_store_pd(p, a)
#define loadu(p) _mm256_loadu_pd(p)
#define storeu(p, a) _mm256_storeu_pd(p, a)
#define add(a, b) _mm256_add_pd(a, b)
#define sub(a, b) _mm256_sub_pd(a, b)
#define mul(a, b) _mm256_mul_pd(a, b)
#define div(a, b) _mm256_div_pd(a, b)
#define root(a) _mm256_sqrt_pd(a)
#define min(a, b) _mm256_min_pd(a, b)
#define max(a, b) _mm256_max_pd(a, b)
#define muladd(a, b, c) _mm256_fmadd_pd(a, b, c)
#define nmuladd(a, b, c) _mm256_fnmadd_pd(a, b, c)
#define estimate(t) _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(t)))

TARGET static inline void store_pairs(double *p, vec a, vec b)
{
    const vec even = _mm256_unpacklo_pd(a, b), odd = _mm256_unpackhi_pd(a, b);
    storeu(p, _mm256_permute2f128_pd(even, odd, 0x20));
    storeu(p + LANES, _mm256_permute2f128_pd(even, odd, 0x31));
}

TARGET static inline vec add_pairs(const double *p)
{
    return _mm256_permute4x64_pd(_mm256_hadd_pd(loadu(p), loadu(p + LANES)), 0xd8);
}

/* Two rows at a time become pairs, [x0 x1 z0 z1] and [y0 y1 0 0], and pairs columns. */
TARGET static inline void set_directions(double *x, double *y, double *z, const double *const *v, unsigned reversed)
{
    const __m256i three = _mm256_set_epi64x(0, -1, -1, -1), bits = _mm256_set_epi64x(8, 4, 2, 1);
    const __m256i is_reversed = _mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(reversed), bits), bits);
    const vec sign = _mm256_and_pd(_mm256_castsi256_pd(is_reversed), set(-0.0));
    const vec a = _mm256_maskload_pd(v[0], three), b = _mm256_maskload_pd(v[1], three);
    const vec c = _mm256_maskload_pd(v[2], three), d = _mm256_maskload_pd(v[3], three);
    const vec xz = _mm256_unpacklo_pd(a, b), yw = _mm256_unpackhi_pd(a, b), xz2 = _mm256_unpacklo_pd(c, d), yw2 = _mm256_unpackhi_pd(c, d);
    store(x, _mm256_xor_pd(_mm256_permute2f128_pd(xz, xz2, 0x20), sign));
    store(y, _mm256_xor_pd(_mm256_permute2f128_pd(yw, yw2, 0x20), sign));
    store(z, _mm256_xor_pd(_mm256_permute2f128_pd(xz, xz2, 0x31), sign));
}

#include "../lanes.h"
#endif
