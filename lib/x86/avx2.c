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

#include "../lanes.h"
#endif
