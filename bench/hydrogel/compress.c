/* SPDX-License-Identifier: BSD-2-Clause */
/* compress.c - a packing is pressed and released a few times; what it does goes to a run file. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"
#include "metrics.h"
#include "timing.h"

#define PI 3.14159265358979323846
enum { EXIT_USAGE = 2, SETTLE = 500, FITS = 8 };

typedef struct settings {
    const char *packing, *output, *fit;
    bed_settings bed;
    double strain, ratio, within;
    int cycles, levels, moving, resting, first;
} settings;

static const char usage[] =
    "usage: compress [options] PACKING\n"
    "\n"
    "Presses a packing between six walls by its last one, level by level, releases it likewise, and again; writes\n"
    "a run file (bench/hydrogel/README).  Saturated friction; damped dynamics that come to rest at each level.\n"
    "\n"
    "  --model NAME      as in the library (default: gonzalez-cuitino)\n"
    "  --prefactor G     of half-space (default: 1)\n"
    "  --fit RUN         finds the prefactor of half-space with which R_top against this run is as said, and runs with it\n"
    "  --ratio R         that R_top (default: 1)\n"
    "  --within X        how near to it, relative (default: 0.02, about what a prefactor close by changes at random)\n"
    "  --from N          cycles that R_top is taken from (default: 2)\n"
    "  --cycles N        (default: 5); 0: one loading\n"
    "  --strain E        largest (default: 0.134)\n"
    "  --levels N        from none to that (default: 25)\n"
    "  --moving N, --resting N   steps of 2 ms in which the plate moves to the next level, and rests there before\n"
    "                    things are measured (default: 120, 80)\n"
    "  --friction MU     (default: 0.03)\n"
    "  --slip LENGTH     by which a contact slides until its friction is saturated [m] (default: 5e-5)\n"
    "  --drag RATE       [1/s] (default: 20)\n"
    "  --tolerance T     of the forces (default: 1e-4)\n"
    "  --output FILE     (default: standard output)\n"
    "\n"
    "Exit status: 0 success, 1 failure, 2 wrong usage.\n";

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "compress: %s%s%s\n", where, *where ? ": " : "", text);
    return EXIT_FAILURE;
}

/* ---- command line */

static int complain(const char *text, const char *culprit)
{
    fprintf(stderr, "compress: %s: %s (compress --help explains)\n", culprit, text);
    return EXIT_USAGE;
}

typedef struct option {
    const char *name;
    double *number;
    int *count;
    const char **text;
    double low, high;
} option;

static int set_option(const option *o, settings *s, const char *value)
{
    char *end;
    if (strcmp(o->name, "--model") == 0) {
        s->bed.model = nlc_model_find(value);
        return s->bed.model >= 0 ? 0 : complain("no such model", value);
    }
    if (o->text) {
        *o->text = value;
        return 0;
    }
    const double x = strtod(value, &end);
    if (end == value || *end || !(x >= o->low && x <= o->high) || (o->count && x != floor(x)))
        return complain("not a number that is possible here", value);
    if (o->count)
        *o->count = (int)x;
    else
        *o->number = x;
    return 0;
}

static int parse_arguments(settings *s, char **argv)
{
    const option options[] = {{"--model", NULL, NULL, NULL, 0, 0},
                              {"--prefactor", &s->bed.prefactor, NULL, NULL, 1e-6, 1e6},
                              {"--fit", NULL, NULL, &s->fit, 0, 0},
                              {"--ratio", &s->ratio, NULL, NULL, 1e-6, 1e6},
                              {"--within", &s->within, NULL, NULL, 1e-9, 1},
                              {"--from", NULL, &s->first, NULL, 1, 1e6},
                              {"--cycles", NULL, &s->cycles, NULL, 0, 1e6},
                              {"--strain", &s->strain, NULL, NULL, 1e-6, .5},
                              {"--levels", NULL, &s->levels, NULL, 1, 1e6},
                              {"--moving", NULL, &s->moving, NULL, 1, 1e9},
                              {"--resting", NULL, &s->resting, NULL, 1, 1e9},
                              {"--friction", &s->bed.friction, NULL, NULL, 0, 10},
                              {"--slip", &s->bed.slip_length, NULL, NULL, 1e-12, 1e3},
                              {"--drag", &s->bed.drag, NULL, NULL, 0, 1e6},
                              {"--tolerance", &s->bed.tolerance, NULL, NULL, 1e-14, 1},
                              {"--output", NULL, NULL, &s->output, 0, 0}};
    enum { OPTIONS = sizeof options / sizeof *options };
    for (int k = 1; argv[k]; k++) {
        if (strcmp(argv[k], "--help") == 0) {
            fputs(usage, stdout);
            return -1;
        }
        if (argv[k][0] != '-') {
            if (s->packing) return complain("only one packing at a time", argv[k]);
            s->packing = argv[k];
            continue;
        }
        int o = 0;
        while (o < OPTIONS && strcmp(argv[k], options[o].name) != 0) o++;
        if (o == OPTIONS) return complain("no such option", argv[k]);
        if (!argv[k + 1]) return complain("a value is missing", argv[k]);
        const int status = set_option(&options[o], s, argv[++k]);
        if (status) return status;
    }
    if (s->packing) return 0;
    fputs(usage, stderr);
    return EXIT_USAGE;
}

/* ---- the test */

/* The plate goes to a height, from rest to rest, and stays there. */
static int go_to(bed *b, double height, int moving, int resting)
{
    const double way = height - bed_height(b);
    for (int k = 0; k < moving + resting; k++) {
        const double s = sin(PI * (k + .5) / moving);
        b->plate_speed = k < moving ? 2 * s * s * way / (moving * b->set.step) : 0;
        if (bed_step(b)) return -1;
    }
    return 0;
}

static int press(run *r, bed *b, const settings *s)
{
    const double height = bed_height(b);
    const int half = s->levels, all = 2 * half * s->cycles + (s->cycles == 0 ? half : 0);
    timing_progress progress;
    timing_progress_begin(&progress, "levels");
    if (go_to(b, height, 1, SETTLE)) return -1;
    for (int k = 1; k <= all; k++) {
        const int level = k % (2 * half), from_rest = level <= half ? level : 2 * half - level;
        run_row row = {.cycle = 1 + (k - 1) / (2 * half), .phase = level > 0 && level <= half ? RUN_LOAD : RUN_UNLOAD};
        row.strain = s->strain * from_rest / half;
        if (go_to(b, height * (1 - row.strain), s->moving, s->resting)) return -1;
        measure(&row, b, r);
        if (!run_add(r, &row)) return snprintf(b->error, sizeof b->error, "out of memory"), -1;
        timing_progress_update(&progress, k, all);
    }
    timing_progress_end(&progress);
    return 0;
}

static int compress(run *r, const settings *s, char *comment, size_t size)
{
    bed b;
    nlc_model_record m = {.struct_size = sizeof m};
    nlc_model_info(s->bed.model, &m, NULL);
    int status = bed_open(&b, s->packing, &s->bed);
    if (status == 0) {
        run_init(r, (double)b.p.count);
        status = press(r, &b, s);
    }
    if (status) fail(s->packing, b.error);
    int n = snprintf(comment, size, "%s", m.name);
    if (s->bed.model == NLC_MODEL_HALF_SPACE) n += snprintf(comment + n, size - (size_t)n, " prefactor %.4f", s->bed.prefactor);
    snprintf(comment + n, size - (size_t)n, ", friction %g, %lld steps, %lld with a warning", s->bed.friction,
             (long long)b.steps, (long long)b.warnings);
    fprintf(stderr, "compress: %s, %.2f sweeps a step\n", comment, (double)b.sweeps / (double)(b.steps ? b.steps : 1));
    bed_free(&b);
    return status;
}

/* R_top of a run with this prefactor against the reference; 0 is Hertz. */
static int top_ratio(double *ratio, run *r, const settings *s, double prefactor, const run *reference, char *comment,
                     size_t size)
{
    settings here = *s;
    metrics m;
    const metrics_settings set = {.first = s->first, .threshold = 0};
    here.bed.model = prefactor > 0 ? NLC_MODEL_HALF_SPACE : NLC_MODEL_HERTZ;
    here.bed.prefactor = prefactor;
    run_free(r);
    if (compress(r, &here, comment, size)) return EXIT_FAILURE;
    const char *wrong = metrics_compare(&m, r, reference, &set);
    if (wrong) return fail(s->fit, wrong);
    *ratio = m.R_top;
    fprintf(stderr, "compress: prefactor %.4f: R_top %.4f\n", prefactor, m.R_top);
    return 0;
}

/* 1 / R_top falls nearly in proportion to the prefactor from what it is with Hertz' law, where that is 0: the slope that fits
 * all runs so far best leads to the next. */
static int fit(run *r, const settings *s, char *comment, size_t size)
{
    char error[RUN_ERROR_SIZE];
    run reference;
    double hertz, ratio = 0, prefactor = s->bed.prefactor, product = 0, square = 0;
    int status = run_read(&reference, s->fit, error, sizeof error) ? fail("", error) : 0;
    if (!status) status = top_ratio(&hertz, r, s, 0, &reference, comment, size);
    for (int k = 0; k < FITS && !status; k++) {
        status = top_ratio(&ratio, r, s, prefactor, &reference, comment, size);
        if (status || fabs(ratio / s->ratio - 1) <= s->within) break;
        product += prefactor * (1 / hertz - 1 / ratio);
        square += prefactor * prefactor;
        prefactor = (1 / hertz - 1 / s->ratio) * square / product;
        if (!(prefactor > 0)) status = fail(s->fit, "no prefactor above 0 does that");
    }
    if (!status && !(fabs(ratio / s->ratio - 1) <= s->within))
        status = fail(s->fit, "the prefactor is not found in eight runs");
    run_free(&reference);
    return status;
}

static int write(const settings *s, const run *r, const char *comment)
{
    FILE *out = s->output ? fopen(s->output, "w") : stdout;
    if (!out) return fail(s->output, strerror(errno));
    run_write(out, r, comment);
    const bool bad = ferror(out) != 0;
    if ((s->output ? fclose(out) : fflush(out)) != 0 || bad)
        return fail(s->output ? s->output : "standard output", "cannot be written");
    return 0;
}

int main(int argc, char **argv)
{
    (void)argc;
    char comment[256];
    run r = {0};
    settings s = {.bed = {.model = NLC_MODEL_GONZALEZ_CUITINO,
                          .prefactor = 1,
                          .tolerance = 1e-4,
                          .friction = .03,
                          .slip_length = 5e-5,
                          .density = 1000,
                          .weight = 11.5 * 9.81,
                          .drag = 20,
                          .step = 2e-3},
                  .strain = .134,
                  .ratio = 1,
                  .within = .02,
                  .cycles = 5,
                  .levels = 25,
                  .moving = 120,
                  .resting = 80,
                  .first = 2};
    int status = parse_arguments(&s, argv);
    if (status) return status < 0 ? EXIT_SUCCESS : status;
    status = s.fit ? fit(&r, &s, comment, sizeof comment) : compress(&r, &s, comment, sizeof comment) ? EXIT_FAILURE : 0;
    if (!status) status = write(&s, &r, comment);
    run_free(&r);
    return status;
}
