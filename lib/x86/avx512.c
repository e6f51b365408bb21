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

#include "../lanes.h"
#endif
