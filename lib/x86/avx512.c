/* SPDX-License-Identifier: BSD-2-Clause */
/* avx512.c - lanes.h with 8 particles at once. */
#include "../variant.h"

#ifdef NLC_HAVE_X86
#include <immintrin.h>

#define LANES 8
#define TARGET __attribute__((target("avx512f")))
#ifndef VARIANT
#define VARIANT nlc_variant_avx512
#endif
#define TERMS 3 /* the estimate is good to 2^-14: e is below 2^-13, and the next term, 35/128 e^4, below 2^-53.8 */

typedef __m512d vec;

#define set(x) _mm512_set1_pd(x)
#define load(p) _mm512_load_pd(p)
#define store(p, a) _mm512_store_pd(p, a)
#define loadu(p) _mm512_loadu_pd(p)
#define storeu(p, a) _mm512_storeu_pd(p, a)
#define add(a, b) _mm512_add_pd(a, b)
#define sub(a, b) _mm512_sub_pd(a, b)
#define mul(a, b) _mm512_mul_pd(a, b)
#define div(a, b) _mm512_div_pd(a, b)
#define root(a) _mm512_sqrt_pd(a)
#define min(a, b) _mm512_min_pd(a, b)
#define max(a, b) _mm512_max_pd(a, b)
#define muladd(a, b, c) _mm512_fmadd_pd(a, b, c)
#define nmuladd(a, b, c) _mm512_fnmadd_pd(a, b, c)
#define estimate(t) _mm512_rsqrt14_pd(t)

TARGET static inline void store_pairs(double *p, vec a, vec b)
{
    const __m512i low = _mm512_set_epi64(11, 3, 10, 2, 9, 1, 8, 0), high = _mm512_set_epi64(15, 7, 14, 6, 13, 5, 12, 4);
    storeu(p, _mm512_permutex2var_pd(a, low, b));
    storeu(p + LANES, _mm512_permutex2var_pd(a, high, b));
}

TARGET static inline vec add_pairs(const double *p)
{
    const __m512i even = _mm512_set_epi64(14, 12, 10, 8, 6, 4, 2, 0), odd = _mm512_set_epi64(15, 13, 11, 9, 7, 5, 3, 1);
    const vec a = loadu(p), b = loadu(p + LANES);
    return add(_mm512_permutex2var_pd(a, even, b), _mm512_permutex2var_pd(a, odd, b));
}

/* Rows l and l + 4 share a register; two of these become pairs, [x0 x1 z0 z1 x4 x5 z4 z5] and likewise of y, and pairs columns. */
TARGET static inline void set_directions(double *x, double *y, double *z, const double *const *v, unsigned reversed)
{
    const __m256i three = _mm256_set_epi64x(0, -1, -1, -1);
    const __m512i first = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0), second = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
    const __m512i sign = _mm512_maskz_set1_epi64((__mmask8)reversed, INT64_MIN);
    vec row[4];
    for (int l = 0; l < 4; l++)
        row[l] = _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_maskload_pd(v[l], three)), _mm256_maskload_pd(v[l + 4], three), 1);
    const vec xz = _mm512_unpacklo_pd(row[0], row[1]), xz2 = _mm512_unpacklo_pd(row[2], row[3]);
    const vec yw = _mm512_unpackhi_pd(row[0], row[1]), yw2 = _mm512_unpackhi_pd(row[2], row[3]);
    const __m512i a = _mm512_castpd_si512(_mm512_permutex2var_pd(xz, first, xz2));
    const __m512i b = _mm512_castpd_si512(_mm512_permutex2var_pd(yw, first, yw2));
    const __m512i c = _mm512_castpd_si512(_mm512_permutex2var_pd(xz, second, xz2));
    store(x, _mm512_castsi512_pd(_mm512_xor_si512(a, sign)));
    store(y, _mm512_castsi512_pd(_mm512_xor_si512(b, sign)));
    store(z, _mm512_castsi512_pd(_mm512_xor_si512(c, sign)));
}

#include "../lanes.h"
#endif
