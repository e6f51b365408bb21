/* SPDX-License-Identifier: BSD-2-Clause */
/* cpu.c - what this processor has. */
#include "variant.h"

#ifdef NLC_HAVE_X86
#include <cpuid.h>

#define AVX_STATE 0x06     /* XCR0: the operating system keeps xmm and ymm registers */
#define AVX512_STATE 0xe6  /* and zmm and mask registers */

static unsigned int kept_state(void)
{
    unsigned int low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

/* The highest NLC_SIMD_... */
static int32_t best_of_processor(void)
{
    unsigned int a, b, c, d, state;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_OSXSAVE)) return NLC_SIMD_GENERIC;
    const bool fma = c & bit_FMA;
    state = kept_state();
    if (!fma || (state & AVX_STATE) != AVX_STATE || !__get_cpuid_count(7, 0, &a, &b, &c, &d) || !(b & bit_AVX2)) return NLC_SIMD_GENERIC;
    return (state & AVX512_STATE) == AVX512_STATE && b & bit_AVX512F ? NLC_SIMD_AVX512 : NLC_SIMD_AVX2;
}

const nlc_variant *nlc_choose_variant(int32_t simd)
{
    if (simd == NLC_SIMD_GENERIC || simd == NLC_SIMD_NEON) return 0;
    const int32_t best = best_of_processor(), chosen = simd == NLC_SIMD_BEST || simd > best ? best : simd;
    return chosen == NLC_SIMD_AVX512 ? &nlc_variant_avx512 : chosen == NLC_SIMD_AVX2 ? &nlc_variant_avx2 : 0;
}
#elif defined(NLC_HAVE_NEON)
const nlc_variant *nlc_choose_variant(int32_t simd)
{
    return simd == NLC_SIMD_BEST || simd == NLC_SIMD_NEON ? &nlc_variant_neon : 0;
}
#else
const nlc_variant *nlc_choose_variant(int32_t simd)
{
    (void)simd;
    return 0;
}
#endif
