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
typedef __m256i ints, mask;

#define set(x) _mm256_set1_pd(x)
#define load(p) _mm256_load_pd(p)
#define store(p, a) _mm256_store_pd(p, a)
#define sub(a, b) _mm256_sub_pd(a, b)
#define mul(a, b) _mm256_mul_pd(a, b)
#define min(a, b) _mm256_min_pd(a, b)
#define max(a, b) _mm256_max_pd(a, b)
#define muladd(a, b, c) _mm256_fmadd_pd(a, b, c)
#define nmuladd(a, b, c) _mm256_fnmadd_pd(a, b, c)
#define magnitude(a) _mm256_andnot_pd(_mm256_set1_pd(-0.0), a)
#define estimate(t) _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(t)))
#define iset(x) _mm256_set1_epi64x(x)
#define iload(p) _mm256_load_si256((const __m256i *)(const void *)(p))
#define iadd(a, b) _mm256_add_epi64(a, b)
#define half(e) _mm256_srli_epi64(e, 1)
#define above(a, b) _mm256_cmpgt_epi64(a, b)
#define turn(v, e) _mm256_xor_pd(v, _mm256_castsi256_pd(_mm256_slli_epi64(e, 63)))
#define gather(otherwise, m, array, at) _mm256_mask_i64gather_pd(otherwise, array, at, _mm256_castsi256_pd(m), 8)
#define igather(m, array, at) \
    _mm256_castpd_si256(_mm256_mask_i64gather_pd(_mm256_setzero_pd(), (const double *)(const void *)(array), at, _mm256_castsi256_pd(m), 8))

#include "../lanes.h"
#endif
