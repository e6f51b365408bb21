/* SPDX-License-Identifier: BSD-2-Clause */
/* neon.c - lanes.h with 2 particles at once. */
#include "../variant.h"

#ifdef NLC_HAVE_NEON
#include <arm_neon.h>

#define LANES 2
#define TARGET
#define VARIANT nlc_variant_neon
#define TERMS 3 /* the estimate is good to 2^-8 and the step after it to 2^-15: e is below 2^-14 */

typedef float64x2_t vec;

#define set(x) vdupq_n_f64(x)
#define load(p) vld1q_f64(p)
#define store(p, a) vst1q_f64(p, a)
#define loadu(p) vld1q_f64(p)
#define storeu(p, a) vst1q_f64(p, a)
#define add(a, b) vaddq_f64(a, b)
#define sub(a, b) vsubq_f64(a, b)
#define mul(a, b) vmulq_f64(a, b)
#define div(a, b) vdivq_f64(a, b)
#define root(a) vsqrtq_f64(a)
#define min(a, b) vminq_f64(a, b)
#define max(a, b) vmaxq_f64(a, b)
#define muladd(a, b, c) vfmaq_f64(c, a, b)
#define nmuladd(a, b, c) vfmsq_f64(c, a, b)

static inline vec estimate(vec t)
{
    const vec y = vrsqrteq_f64(t);
    return vmulq_f64(y, vrsqrtsq_f64(vmulq_f64(t, y), y));
}

static inline void store_pairs(double *p, vec a, vec b)
{
    storeu(p, vzip1q_f64(a, b));
    storeu(p + LANES, vzip2q_f64(a, b));
}

static inline vec add_pairs(const double *p)
{
    return vpaddq_f64(vld1q_f64(p), vld1q_f64(p + LANES));
}

static inline void set_directions(double *x, double *y, double *z, const double *const *v, unsigned reversed)
{
    const uint64x2_t sign = {(uint64_t)(reversed & 1) << 63, (uint64_t)(reversed >> 1) << 63};
    const uint64x2_t a = vreinterpretq_u64_f64(vld1q_f64(v[0])), b = vreinterpretq_u64_f64(vld1q_f64(v[1])); /* x and y */
    const uint64x2_t c = {nlc_bits(v[0][2]), nlc_bits(v[1][2])};
    store(x, vreinterpretq_f64_u64(veorq_u64(vzip1q_u64(a, b), sign)));
    store(y, vreinterpretq_f64_u64(veorq_u64(vzip2q_u64(a, b), sign)));
    store(z, vreinterpretq_f64_u64(veorq_u64(c, sign)));
}

#include "../lanes.h"
#endif
