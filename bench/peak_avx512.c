/* SPDX-License-Identifier: BSD-2-Clause */
/* peak_avx512.c - see peak.h; the operations are the library's own. */
#define VARIANT peak_unused_avx512
#include "../lib/x86/avx512.c"
#include "peak.h"

#ifdef NLC_HAVE_X86
#define CHANGE(v) __asm__ volatile("" : "+v"(v))
#define PEAK peak_avx512
#include "peak_kernel.h"
#else
int64_t peak_avx512(int64_t pairs)
{
    (void)pairs;
    return 0;
}
#endif
