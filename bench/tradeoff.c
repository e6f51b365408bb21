/* SPDX-License-Identifier: BSD-2-Clause */
/* tradeoff.c - run time against error. */
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contenders.h"
#include "timing.h"

static const char usage[] =
    "usage: tradeoff [--quick] [--csv FILE] PACKING...\n"
    "\n"
    "What a step of a slow compression costs and how wrong its forces are, for several ways to find them and tolerances\n"
    "from 1e-2 to 1e-14.  PACKING: a file, or lattice:N (see bench/README).  --quick: one step each, to see that it works.\n";

enum { COLUMNS = 7 };

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "tradeoff: %s%s%s\n", where, *where ? ": " : "", text);
    return EXIT_FAILURE;
}

static void write_csv(FILE *csv, const contest *c, point *p)
{
    char key[RUNS_KEY];
    const char *series = p->contender->key;
    if (p->samples == 0) return;
    snprintf(key, sizeof key, p->setting > 0 ? "%s %g" : "%s", series, p->setting);
    runs_write_row(csv, c->path.p.name, c->path.p.count, c->path.n.count, key, "ns", p->sample, p->samples);
    fprintf(csv, ",%s,%g,%.3g,%.3g,%.4g,%d\n", series, p->setting, p->largest, p->mean_square, p->sweeps, (int)p->status);
}

/* Columns are tolerances; numbers of sweeps begin on the left. */
static bool is_in_column(const point *p, int column)
{
    return p->setting < 1 ? column == (p->setting > 0 ? (int)lround(-log10(p->setting)) / 2 : 1) : column == (int)p->setting;
}

/* The points of one contender: a line of times, a line of errors. */
static void print_contender(point *p, int count)
{
    for (int line = 0; line < 2; line++) {
        printf("  %-30s%6s", line ? "" : p->contender->label, line ? "error" : "ns");
        for (int column = 1, k = 0; k < count; column++) {
            if (!is_in_column(&p[k], column)) printf("%11s", "");
            else if (p[k].samples == 0) printf("%11s", line ? "" : "-");
            else if (line) printf("%11.1e", p[k].largest);
            else printf("%11.4g", timing_spread_of(p[k].sample, p[k].samples).median);
            k += is_in_column(&p[k], column);
        }
        putchar('\n');
    }
}

static void print(contest *c)
{
    printf("%s: %lld contacts and candidates; ns per contact and step, largest error of a force\n\n  %-36s", c->path.p.name,
           (long long)c->path.n.count, "tolerance");
    for (int digits = 2; digits <= 14; digits += 2) printf("%11.0e", pow(10, -digits));
    putchar('\n');
    for (int k = 0, count; k < c->points; k += count) {
        for (count = 1; k + count < c->points && c->point[k + count].contender == c->point[k].contender;) count++;
        print_contender(&c->point[k], count);
    }
    putchar('\n');
}

static int run(const char *name, bool quick, FILE *csv)
{
    static contest c;
    char error[PACKING_ERROR_SIZE];
    int status = EXIT_SUCCESS;
    if (contest_run(&c, name, quick, error, sizeof error)) {
        status = fail("", error);
    } else {
        print(&c);
        for (int k = 0; k < c.points && csv; k++) write_csv(csv, &c, &c.point[k]);
    }
    contest_free(&c);
    return status;
}

int main(int argc, char **argv)
{
    const char *csv_path = NULL;
    bool quick = false;
    int k = 1, status = EXIT_SUCCESS;
    for (; k < argc && argv[k][0] == '-'; k++) {
        if (strcmp(argv[k], "--quick") == 0) quick = true;
        else if (strcmp(argv[k], "--csv") == 0 && k + 1 < argc) csv_path = argv[++k];
        else break;
    }
    if (k == argc || argv[k][0] == '-') {
        const bool help = k < argc && strcmp(argv[k], "--help") == 0;
        fputs(usage, help ? stdout : stderr);
        return help ? EXIT_SUCCESS : 2;
    }
    FILE *csv = csv_path ? fopen(csv_path, "w") : NULL;
    if (csv_path && !csv) return fail(csv_path, strerror(errno));
    if (csv) fputs(RUNS_COLUMNS ",series,setting,error,rms_error,sweeps,status\n", csv);
    for (; k < argc; k++) status |= run(argv[k], quick, csv);
    if (csv && (ferror(csv) | fclose(csv))) status = fail(csv_path, "cannot be written");
    if (fflush(stdout) != 0 || ferror(stdout)) status = fail("standard output", "cannot be written");
    return status;
}
