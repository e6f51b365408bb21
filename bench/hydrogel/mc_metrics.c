/* SPDX-License-Identifier: BSD-2-Clause */
/* mc_metrics.c - how near runs come to a reference, as in Table I of Brodu, Dijksman and Behringer (2015). */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "metrics.h"

enum { EXIT_USAGE = 2 };

static const char usage[] =
    "usage: mc_metrics [options] RUN... REFERENCE\n"
    "\n"
    "Compares runs with a reference, a run or a measurement, by the four numbers of [MC] IV:\n"
    "  R_top   top force at the largest compression over that of the reference\n"
    "  err_f   root mean square difference of the top forces at all levels [N]\n"
    "  err_Z   the same of the contacts per grain; forces of the run up to a threshold tau do not count\n"
    "  bhat    D = -log <B>, B = sum over bins of sqrt(p q), p and q the shares of the forces in a bin, < > the mean\n"
    "          over all levels\n"
    "Rows of the same phase and strain are averaged first.  Levels are the reference's; the run is interpolated\n"
    "between its own.  Bins are the reference's.\n"
    "\n"
    "  --from N          leave out the cycles before this one, in both (default: 1)\n"
    "  --threshold T     tau [N] (default: what makes err_Z least)\n"
    "  --resolution T    forces of the reference up to T do not count in err_Z either [N] (default: 0)\n"
    "  --csv             print comma-separated values\n"
    "\n"
    "A file has lines of text:\n"
    "  # grains: 514                    their number; other lines with # are comments\n"
    "  cycle,phase,strain,top,0.001,0.002,0.005\n"
    "  1,load,0.01,0.35,210,340,57      names of columns, then a line for each measurement, all in SI units\n"
    "phase is load or unload, top the force on the plate.  A column whose name is a number counts the contacts between\n"
    "grains with a force up to that number and above that of the column before (none: 0); an empty field is 0.  cycle may\n"
    "be missing; other columns are ignored.\n"
    "\n"
    "Exit status: 0 success, 1 failure, 2 wrong usage.\n";

static int complain(const char *text, const char *culprit)
{
    fprintf(stderr, "mc_metrics: %s: %s (mc_metrics --help explains)\n", culprit, text);
    return EXIT_USAGE;
}

typedef struct settings {
    metrics_settings set;
    bool csv;
    int files;
    char **file;
} settings;

/* Files are moved to the front of argv. */
static int parse_arguments(settings *s, char **argv)
{
    char *end;
    s->file = argv;
    for (int k = 1; argv[k]; k++) {
        double *number = strcmp(argv[k], "--threshold") == 0 ? &s->set.threshold : &s->set.resolution;
        if (argv[k][0] != '-') {
            s->file[s->files++] = argv[k];
        } else if (strcmp(argv[k], "--help") == 0) {
            fputs(usage, stdout);
            return -1;
        } else if (strcmp(argv[k], "--csv") == 0) {
            s->csv = true;
        } else if (strcmp(argv[k], "--from") != 0 && strcmp(argv[k], "--threshold") != 0 &&
                   strcmp(argv[k], "--resolution") != 0) {
            return complain("no such option", argv[k]);
        } else if (!argv[k + 1]) {
            return complain("a value is missing", argv[k]);
        } else if (strcmp(argv[k], "--from") == 0) {
            const long n = strtol(argv[++k], &end, 10);
            if (end == argv[k] || *end || n < 1 || n > 1000000) return complain("not a number of a cycle", argv[k]);
            s->set.first = (int)n;
        } else {
            *number = strtod(argv[++k], &end);
            if (end == argv[k] || *end || !(*number >= 0 && isfinite(*number))) return complain("not a force", argv[k]);
        }
    }
    if (s->files >= 2) return 0;
    fputs(usage, stderr);
    return EXIT_USAGE;
}

static void print(const char *name, const metrics *m, bool csv)
{
    if (csv) {
        printf("%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%d,%d\n", name, m->top, m->R_top, m->err_f, m->err_Z, m->threshold, m->bhat,
               m->levels, m->left_out);
        return;
    }
    printf("%-40s %8.3f %7.3f %8.3f %7.3f %9.2f %9.2f %7d\n", name, m->top, m->R_top, m->err_f, m->err_Z, 1e3 * m->threshold,
           1e2 * m->bhat, m->levels);
    if (m->left_out) fprintf(stderr, "mc_metrics: %s: %d levels of the reference are beyond its own\n", name, m->left_out);
}

int main(int argc, char **argv)
{
    char error[RUN_ERROR_SIZE];
    settings s = {.set = {.first = 1, .threshold = NAN}};
    run reference, r;
    (void)argc;
    int status = parse_arguments(&s, argv);
    if (status) return status < 0 ? EXIT_SUCCESS : status;
    if (run_read(&reference, s.file[s.files - 1], error, sizeof error))
        status = 1;
    else if (s.csv)
        puts("run,top,R_top,err_f,err_Z,threshold,bhat,levels,left_out");
    else
        printf("%-40s %8s %7s %8s %7s %9s %9s %7s\n", "", "top [N]", "R_top", "err_f", "err_Z", "tau [mN]", "100 bhat",
               "levels");
    for (int k = 0; k + 1 < s.files && !status; k++) {
        metrics m;
        const char *wrong = NULL;
        status = run_read(&r, s.file[k], error, sizeof error) ? 1 : 0;
        if (!status) wrong = metrics_compare(&m, &r, &reference, &s.set);
        if (wrong) status = 1, snprintf(error, sizeof error, "%s: %s", s.file[k], wrong);
        if (!status) print(s.file[k], &m, s.csv);
        run_free(&r);
    }
    run_free(&reference);
    if (status) fprintf(stderr, "mc_metrics: %s\n", error);
    if (fflush(stdout) != 0 || ferror(stdout)) return complain("cannot be written", "standard output"), EXIT_FAILURE;
    return status;
}
