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
typedef int64x2_t ints;
typedef uint64x2_t mask;

#define set(x) vdupq_n_f64(x)
#define load(p) vld1q_f64(p)
#define store(p, a) vst1q_f64(p, a)
#define sub(a, b) vsubq_f64(a, b)
#define mul(a, b) vmulq_f64(a, b)
#define min(a, b) vminq_f64(a, b)
#define max(a, b) vmaxq_f64(a, b)
#define muladd(a, b, c) vfmaq_f64(c, a, b)
#define nmuladd(a, b, c) vfmsq_f64(c, a, b)
#define magnitude(a) vabsq_f64(a)
#define iset(x) vdupq_n_s64(x)
#define iload(p) vld1q_s64(p)
#define iadd(a, b) vaddq_s64(a, b)
#define half(e) vshrq_n_s64(e, 1)
#define above(a, b) vcgtq_s64(a, b)
#define turn(v, e) vreinterpretq_f64_s64(veorq_s64(vreinterpretq_s64_f64(v), vshlq_n_s64(e, 63)))

static inline vec estimate(vec t)
{
    const vec y = vrsqrteq_f64(t);
    return vmulq_f64(y, vrsqrtsq_f64(vmulq_f64(t, y), y));
}

static inline vec gather(vec v, mask m, const double *array, ints at)
{
    if (vgetq_lane_u64(m, 0)) v = vld1q_lane_f64(array + vgetq_lane_s64(at, 0), v, 0);
    if (vgetq_lane_u64(m, 1)) v = vld1q_lane_f64(array + vgetq_lane_s64(at, 1), v, 1);
    return v;
}

static inline ints igather(mask m, const int64_t *array, ints at)
{
    ints v = vdupq_n_s64(0);
    if (vgetq_lane_u64(m, 0)) v = vld1q_lane_s64(array + vgetq_lane_s64(at, 0), v, 0);
    if (vgetq_lane_u64(m, 1)) v = vld1q_lane_s64(array + vgetq_lane_s64(at, 1), v, 1);
    return v;
}

#include "../lanes.h"
#endif
