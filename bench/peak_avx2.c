/* SPDX-License-Identifier: BSD-2-Clause */
/* peak_avx2.c - see peak.h; the operations are the library's own. */
#define VARIANT peak_unused_avx2
#include "../lib/x86/avx2.c"
#include "peak.h"

#ifdef NLC_HAVE_X86
#define CHANGE(v) __asm__ volatile("" : "+x"(v))
#define PEAK peak_avx2
#include "peak_kernel.h"
#else
int64_t peak_avx2(int64_t pairs)
{
    (void)pairs;
    return 0;
}
#endif
