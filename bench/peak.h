/* SPDX-License-Identifier: BSD-2-Clause */
/* peak.h - what the processor can do: the arithmetic of lib/lanes.h without memory. */
#ifndef NLC_BENCH_PEAK_H
#define NLC_BENCH_PEAK_H

#include <stdint.h>

/* Pairs of contacts, all in registers, at least so many; returns how many.  0: not built for this processor. */
int64_t peak_avx2(int64_t pairs);
int64_t peak_avx512(int64_t pairs);

#endif
