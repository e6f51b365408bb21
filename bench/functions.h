/* SPDX-License-Identifier: BSD-2-Clause */
/* functions.h - calls of every public function, to be timed. */
#ifndef NLC_BENCH_FUNCTIONS_H
#define NLC_BENCH_FUNCTIONS_H

#include "runs.h"

enum { FUNCTIONS_MAX = 100 };

typedef struct function_list {
    int count;
    timed_call calls[FUNCTIONS_MAX];
} function_list;

/* The next row; context and count as in timed_call. */
void functions_add(function_list *list, const char *key, const char *per, double count, nlc_status (*call)(void *),
                   void *context);

/* Those of numbers alone: throughput is the time of one of many independent calls, latency that of one that waits for another. */
void functions_add_scalar(function_list *list);

/*
 * Those on a packing.
 *
 * name    see packing_open
 * simd    NLC_SIMD_..., used by all networks; NLC_SIMD_BEST adds sweeps by the others
 * error   [error_size] out, on failure
 * Returns what the calls need, to be freed when they are done; NULL on failure.
 */
typedef struct function_scene function_scene;
function_scene *functions_scene(function_list *list, const char *name, int32_t simd, char *error, size_t error_size);
void functions_scene_size(const function_scene *s, const char **name, int64_t *particles, int64_t *contacts);
void functions_scene_free(function_scene *s);

#endif
