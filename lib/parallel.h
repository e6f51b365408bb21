/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * parallel.h - loops that the host's threads may share.
 *
 * A loop is cut into tasks in the same way whether there are threads or not, each task writes to places of its own, and what they
 * found is put together in the order of their numbers: results do not depend on who does what.
 */
#ifndef NLC_PARALLEL_H
#define NLC_PARALLEL_H

#include "network.h"

/* task(work, k) for k = 0 ... count-1 */
static inline void nlc_for(const nlc_network *n, void (*task)(void *work, int64_t k), void *work, int64_t count)
{
    if (n->settings.parallel_for && count > 1) {
        n->settings.parallel_for(n->settings.parallel_context, task, work, count);
        return;
    }
    for (int64_t k = 0; k < count; k++) task(work, k);
}

/* Particles (no ghosts) go in windows, contacts in slabs. */
#define NLC_SLAB 8192

static inline int64_t nlc_windows(const nlc_network *n)
{
    return (n->owned + NLC_WINDOW - 1) / NLC_WINDOW;
}

static inline int64_t nlc_slabs(const nlc_network *n)
{
    return (n->contact_count + NLC_SLAB - 1) / NLC_SLAB;
}

/* Where piece k of so many, of this size each, ends. */
static inline int64_t nlc_end_of(int64_t k, int64_t size, int64_t count)
{
    return count - k * size > size ? (k + 1) * size : count;
}

#endif
