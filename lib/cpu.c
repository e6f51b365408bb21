/* SPDX-License-Identifier: BSD-2-Clause */
/* cpu.c - what this processor has. */
#include "variant.h"

#ifdef NLC_HAVE_X86
/*
 * What the compiler's run-time library has found when the program was loaded, registers that the operating system keeps included:
 * to ask the processor itself takes 30 us in a virtual machine.
 */
const nlc_variant *nlc_choose_variant(int32_t simd)
{
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"), avx512 = avx2 && __builtin_cpu_supports("avx512f");
    if (avx512 && (simd == NLC_SIMD_BEST || simd == NLC_SIMD_AVX512)) return &nlc_variant_avx512;
    return avx2 && simd != NLC_SIMD_GENERIC && simd != NLC_SIMD_NEON ? &nlc_variant_avx2 : 0;
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
