/* SPDX-License-Identifier: BSD-2-Clause */
/* packing.c - the forces of a packing with and without the coupling of its contacts. */
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis.h"
#include "neighbours.h"
#include "nlcontact.h"
#include "packing_io.h"
#include "picture.h"
#include "table.h"
#include "timing.h"
#include "vtk.h"

enum { EXIT_USAGE = 2, MODELS_MAX = 16 };

typedef struct settings {
    const char *file, *svg, *vtk;
    int32_t models[MODELS_MAX]; /* behind Hertz, with which all are compared */
    int model_count;
    bool models_given;
    double reach;
    nlc_options options;
    bool csv;
} settings;

static const char usage[] = "usage: packing [options] FILE\n"
                            "\n"
                            "Computes the contact forces of a packing of elastic spheres by the Hertz law alone and with\n"
                            "the coupling of the contacts of each sphere, and prints what differs.\n"
                            "\n"
                            "FILE is NAME.csv, NAME.header.txt or NAME.f64le; bench/README describes the format.\n"
                            "\n"
                            "  --model NAME     this beside Hertz, or all; may be repeated\n"
                            "                   (default: gonzalez-cuitino and sphere)\n"
                            "  --tolerance T    error of a force over the largest force on either sphere (default: 1e-8)\n"
                            "  --max-sweeps N   give up after N multiplications by the coupling matrix (default: 1000)\n"
                            "  --prefactor G    of the half-space displacements (default: 1)\n"
                            "  --reach X        a gap below X (R_i + R_j) / 2 makes a pair a candidate (default: 0.3)\n"
                            "  --csv            print comma-separated values in SI units\n"
                            "  --svg FILE       write a picture of the force chains, Hertz beside the first other model\n"
                            "  --vtk FILE       write contacts and forces for ParaView\n"
                            "  --version        print the version of the library\n"
                            "  --help           print this\n"
                            "\n"
                            "Exit status: 0 success, also with a warning that forces miss the tolerance; 1 failure;\n"
                            "2 wrong usage.\n"
                            "\n"
                            "Models:";

static void print_usage(FILE *out)
{
    nlc_model_record m = {.struct_size = sizeof m};
    fputs(usage, out);
    for (int32_t k = 0; nlc_model_info(k, &m, NULL) == NLC_OK; k++) fprintf(out, " %s", m.name);
    fputc('\n', out);
}

/* ---- command line */

static int complain(const char *text, const char *culprit)
{
    fprintf(stderr, "packing: %s: %s (packing --help explains)\n", culprit, text);
    return EXIT_USAGE;
}

static bool to_number(const char *text, double *x)
{
    char *end;
    *x = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*x);
}

static void add_model(settings *s, int32_t model)
{
    for (int k = 0; k < s->model_count; k++)
        if (s->models[k] == model) return;
    if (model != NLC_MODEL_HERTZ && s->model_count < MODELS_MAX) s->models[s->model_count++] = model;
}

static int set_model(settings *s, const char *value)
{
    const bool all = strcmp(value, "all") == 0;
    const int32_t model = nlc_model_find(value);
    s->models_given = true;
    if (!all && model < 0) return complain("no such model", value);
    if (!all) add_model(s, model);
    for (int32_t k = 0; all && k < nlc_model_count(); k++) add_model(s, k);
    return 0;
}

static int set_tolerance(settings *s, const char *value)
{
    if (!to_number(value, &s->options.tolerance) || s->options.tolerance <= 0)
        return complain("the tolerance is not a positive number", value);
    return 0;
}

static int set_max_sweeps(settings *s, const char *value)
{
    char *end;
    errno = 0;
    long long n = strtoll(value, &end, 10);
    if (errno != 0 || end == value || *end != '\0' || n < 1) return complain("not a positive number of sweeps", value);
    s->options.max_sweeps = n;
    return 0;
}

static int set_prefactor(settings *s, const char *value)
{
    /* 0 would stand for the default */
    if (!to_number(value, &s->options.prefactor) || s->options.prefactor <= 0)
        return complain("the prefactor is not a positive number", value);
    return 0;
}

static int set_reach(settings *s, const char *value)
{
    if (!to_number(value, &s->reach) || s->reach < 0 || s->reach > NEIGHBOURS_REACH_MAX)
        return complain("the reach is not a number from 0 to 2", value);
    return 0;
}

static int set_svg(settings *s, const char *value)
{
    s->svg = value;
    return 0;
}

static int set_vtk(settings *s, const char *value)
{
    s->vtk = value;
    return 0;
}

static const struct {
    const char *name;
    int (*set)(settings *s, const char *value);
} options[] = {
    {"--model", set_model},
    {"--tolerance", set_tolerance},
    {"--max-sweeps", set_max_sweeps},
    {"--prefactor", set_prefactor},
    {"--reach", set_reach},
    {"--svg", set_svg},
    {"--vtk", set_vtk},
};

/* An option with a value: "--name value" or "--name=value".  *k moves to the last argument used. */
static int parse_option(settings *s, char **argv, int *k)
{
    const char *argument = argv[*k];
    for (size_t o = 0; o < sizeof options / sizeof options[0]; o++) {
        size_t n = strlen(options[o].name);
        if (strncmp(argument, options[o].name, n) != 0) continue;
        if (argument[n] == '=') return options[o].set(s, argument + n + 1);
        if (argument[n] != '\0') continue;
        if (!argv[*k + 1]) return complain("a value is missing", argument);
        return options[o].set(s, argv[++*k]);
    }
    return complain("no such option", argument);
}

/* Returns 0, EXIT_USAGE, or -1 when everything asked for has been printed. */
static int parse_arguments(settings *s, char **argv)
{
    bool only_files = false;
    for (int k = 1; argv[k]; k++) {
        int status = 0;
        if (only_files || argv[k][0] != '-') {
            if (s->file) return complain("only one packing at a time", argv[k]);
            s->file = argv[k];
        } else if (strcmp(argv[k], "--") == 0) {
            only_files = true;
        } else if (strcmp(argv[k], "--csv") == 0) {
            s->csv = true;
        } else if (strcmp(argv[k], "--help") == 0) {
            print_usage(stdout);
            return -1;
        } else if (strcmp(argv[k], "--version") == 0) {
            printf("%s\n", nlc_version());
            return -1;
        } else {
            status = parse_option(s, argv, &k);
        }
        if (status) return status;
    }
    if (!s->models_given) {
        add_model(s, NLC_MODEL_GONZALEZ_CUITINO);
        add_model(s, NLC_MODEL_SPHERE);
    }
    if (s->file) return 0;
    print_usage(stderr);
    return EXIT_USAGE;
}

/* ---- work */

typedef struct job {
    settings set;
    packing p;
    neighbours n;
    analysis results[1 + MODELS_MAX];
    int count;
} job;

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "packing: %s%s%s\n", where, *where ? ": " : "", text);
    return EXIT_FAILURE;
}

static int read_input(job *j)
{
    char error[PACKING_ERROR_SIZE];
    if (packing_read(&j->p, j->set.file, true, error, sizeof error)) return fail("", error);
    if (neighbours_find(&j->n, &j->p, j->set.reach, error, sizeof error)) return fail(j->set.file, error);
    return 0;
}

static int solve_models(job *j)
{
    char text[PACKING_ERROR_SIZE];
    timing_progress progress;
    timing_progress_begin(&progress, "models solved");
    while (j->count <= j->set.model_count) {
        const int32_t model = j->count > 0 ? j->set.models[j->count - 1] : NLC_MODEL_HERTZ;
        timing_progress_update(&progress, j->count, 1 + j->set.model_count);
        analysis *a = &j->results[j->count++];
        int status = analysis_run(a, model, &j->set.options, &j->p, &j->n, text, sizeof text);
        timing_progress_end(&progress);
        if (status) return fail(j->set.file, text);
        if (a->status == NLC_OK) continue;
        analysis_describe_warning(a, &j->p, &j->n, text, sizeof text);
        fprintf(stderr, "packing: warning: %s\n", text);
    }
    return 0;
}

static int close_file(FILE *f, const char *path)
{
    bool bad = ferror(f) != 0;
    if (fclose(f) != 0 || bad) return fail(path, "cannot be written");
    return 0;
}

/* Hertz, and beside it the first other model if there is one. */
static int write_picture(const job *j, const char *path, void write(FILE *, const picture_input *))
{
    if (!path) return 0;
    picture_input in = {&j->p, &j->n, &j->results[0], j->count > 1 ? &j->results[1] : NULL};
    FILE *f = fopen(path, "w");
    if (!f) return fail(path, strerror(errno));
    write(f, &in);
    if (close_file(f, path)) return EXIT_FAILURE;
    if (!j->set.csv) printf("%s written\n", path);
    return 0;
}

static int run(job *j)
{
    if (read_input(j) || solve_models(j)) return EXIT_FAILURE;
    table_input in = {&j->p, &j->n, j->set.reach, j->results, j->count};
    table_print(stdout, &in, j->set.csv);
    if (!j->set.csv && (j->set.svg || j->set.vtk)) putchar('\n');
    if (write_picture(j, j->set.svg, picture_write_svg)) return EXIT_FAILURE;
    if (write_picture(j, j->set.vtk, vtk_write)) return EXIT_FAILURE;
    return 0;
}

int main(int argc, char **argv)
{
    (void)argc;
    job j = {.set = {.reach = NEIGHBOURS_REACH, .options = {.struct_size = sizeof(nlc_options)}}};
    int status = parse_arguments(&j.set, argv);
    if (status > 0) return status;
    if (status == 0) status = run(&j);
    for (int k = 0; k < j.count; k++) analysis_free(&j.results[k]);
    neighbours_free(&j.n);
    packing_free(&j.p);
    if (fflush(stdout) != 0 || ferror(stdout)) return fail("standard output", "cannot be written");
    return status < 0 ? EXIT_SUCCESS : status;
}
