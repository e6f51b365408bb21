/* SPDX-License-Identifier: BSD-2-Clause */
/* functions.c - times of every public function. */
#include "functions.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "packing_io.h"

static const char usage[] =
    "usage: functions [--quick] [--csv FILE] PACKING\n"
    "\n"
    "Times every public function: those of numbers alone by throughput and latency, the others on a packing (a file, or\n"
    "lattice:N, see bench/README).  Minimum, median and quartiles of 21 runs; --quick: 3 very short ones.\n";

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "functions: %s%s%s\n", where, *where ? ": " : "", text);
    return EXIT_FAILURE;
}

static int run(const char *packing_name, FILE *csv, const runs_plan *plan)
{
    static function_list numbers, network;
    char error[PACKING_ERROR_SIZE];
    const char *name;
    int64_t particles, contacts;
    functions_add_scalar(&numbers);
    function_scene *scene = functions_scene(&network, packing_name, NLC_SIMD_BEST, error, sizeof error);
    if (!scene) return fail("", error);
    functions_scene_size(scene, &name, &particles, &contacts);
    runs_measure(numbers.calls, numbers.count, plan);
    runs_measure(network.calls, network.count, plan);
    runs_print_head(stdout);
    runs_print(stdout, csv, "-", 0, 0, numbers.calls, numbers.count, plan);
    printf("\n  %s: %lld spheres, %lld contacts and candidates\n", name, (long long)particles, (long long)contacts);
    runs_print(stdout, csv, name, particles, contacts, network.calls, network.count, plan);
    functions_scene_free(scene);
    return EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    static const runs_plan full = {.runs = 21, .run_time = 2e-3}, quick = {.runs = 3, .run_time = 1e-6};
    const runs_plan *plan = &full;
    const char *csv_path = NULL;
    int k = 1;
    for (; k < argc && argv[k][0] == '-'; k++) {
        if (strcmp(argv[k], "--quick") == 0) plan = &quick;
        else if (strcmp(argv[k], "--csv") == 0 && k + 1 < argc) csv_path = argv[++k];
        else break;
    }
    if (k + 1 != argc || argv[k][0] == '-') {
        const bool help = k < argc && strcmp(argv[k], "--help") == 0;
        fputs(usage, help ? stdout : stderr);
        return help ? EXIT_SUCCESS : 2;
    }
    FILE *csv = csv_path ? fopen(csv_path, "w") : NULL;
    if (csv_path && !csv) return fail(csv_path, strerror(errno));
    if (csv) fputs(RUNS_COLUMNS "\n", csv);
    int status = run(argv[k], csv, plan);
    if (csv && (ferror(csv) | fclose(csv))) status = fail(csv_path, "cannot be written");
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output", "cannot be written");
    return status;
}
