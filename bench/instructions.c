/* SPDX-License-Identifier: BSD-2-Clause */
/* instructions.c - every public function once, for valgrind to count the instructions of: see bench/count_instructions. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/variant.h"
#include "functions.h"
#include "packing_io.h"

static const char packing_name[] = "lattice:5"; /* the same everywhere; its 2 MB network is large enough for every loop to count */

/* The instructions between its beginning and its end are counted. */
__attribute__((noinline)) nlc_status counted_call(timed_call *c);
nlc_status counted_call(timed_call *c)
{
    c->status = c->call(c->context);
    return c->status;
}

static int count(function_list *list, const char *variant)
{
    for (int k = 0; k < list->count; k++) {
        timed_call *c = &list->calls[k];
        const char *kind = strchr(c->key, ' ');
        if (kind && strcmp(kind, " latency") == 0) continue; /* the same instructions */
        if (counted_call(c) < 0) {
            fprintf(stderr, "instructions: %s: %s\n", c->key, nlc_strerror(c->status));
            return -1;
        }
        const int length = kind && strcmp(kind, " throughput") == 0 ? (int)(kind - c->key) : RUNS_KEY;
        printf("%.*s,%s,%s,%g\n", length, c->key, variant, c->per, c->count);
    }
    return 0;
}

int main(void)
{
    /* What is best depends on the machine, and valgrind does not know AVX-512. */
    static const struct {
        const char *name;
        int32_t simd;
    } variants[] = {{"portable C", NLC_SIMD_GENERIC}, {"AVX2", NLC_SIMD_AVX2}};
    static function_list numbers;
    char error[PACKING_ERROR_SIZE];
    functions_add_scalar(&numbers);
    if (count(&numbers, "-")) return EXIT_FAILURE;
    for (size_t k = 0; k < sizeof variants / sizeof *variants; k++) {
        static function_list list;
        if (k > 0 && nlc_choose_variant(variants[k].simd) == nlc_choose_variant(NLC_SIMD_GENERIC)) continue;
        list.count = 0;
        function_scene *scene = functions_scene(&list, packing_name, variants[k].simd, error, sizeof error);
        if (!scene) {
            fprintf(stderr, "instructions: %s\n", error);
            return EXIT_FAILURE;
        }
        const int status = count(&list, variants[k].name);
        functions_scene_free(scene);
        if (status) return EXIT_FAILURE;
    }
    return fflush(stdout) == 0 && !ferror(stdout) ? EXIT_SUCCESS : EXIT_FAILURE;
}
