/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * plot.c - the runs of in.compression in one picture: plot PICTURE.svg DATA.csv STEP NAME...
 *
 * NAME is that of a run's output: NAME.csv, and the contacts at the end in NAME.STEP.csv.  Known names have their colours and,
 * beside them, the top force of [MC] Table I; the rest is grey.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "line_chart.h"

enum { BINS = 60, RUNS = 16, EVERY = 2 /* lines of a table */ };
#define BIN 5e-3 /* N */

/* r_top: top force at the greatest strain over the measured one, [MC] Table I; 0: not there. */
typedef struct known {
    const char *name, *label, *colour;
    double r_top;
} known;

static const known models[] = {{"hertz", "1 Hertz", "#888888", .43},
                               {"point-force", "2 point forces, exact sphere", "#3a8a5f", .44},
                               {"gonzalez-cuitino", "3 Case I", "#e58a0c", .70},
                               {"half-space", "4 half-space", "#1c6fb5", .80},
                               {"half-space-1.6", "5 MC-DEM: half-space times 1.6", "#7fb2dd", 1},
                               {"sphere", "6 exact sphere", "#35133d", 0}};
enum { MODELS = sizeof models / sizeof models[0] };

typedef struct run {
    const known *model;
    double (*row)[3]; /* strain, top force, coordination */
    int rows;
    double last; /* top force averaged over the last percent of strain: grains rearrange */
    double share[BINS], mean;
    long contacts;
} run;

static const known *find(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    for (int k = 0; k < MODELS; k++)
        if (strcmp(models[k].name, name) == 0) return &models[k];
    return NULL;
}

static FILE *open_file(const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file) {
        fprintf(stderr, "plot: %s cannot be read\n", path);
        exit(EXIT_FAILURE);
    }
    return file;
}

static void read_table(run *r, const char *name)
{
    char path[1024], line[512];
    double strain, top, bottom, coordination, from;
    int line_count = 0, averaged = 0;
    snprintf(path, sizeof path, "%s.csv", name);
    FILE *file = open_file(path);
    while (fgets(line, sizeof line, file)) {
        if (sscanf(line, "%*d,%lf,%lf,%lf,%lf", &strain, &top, &bottom, &coordination) != 4 || line_count++ % EVERY) continue;
        r->row = realloc(r->row, ((size_t)r->rows + 1) * sizeof *r->row);
        if (!r->row) exit(EXIT_FAILURE);
        r->row[r->rows][0] = 100 * strain;
        r->row[r->rows][1] = top;
        r->row[r->rows++][2] = coordination;
    }
    fclose(file);
    from = r->rows > 0 ? r->row[r->rows - 1][0] - 1 : 0;
    for (int n = 0; n < r->rows; n++)
        if (r->row[n][0] >= from && r->row[n][0] < from + 1) {
            r->last += r->row[n][1];
            averaged++;
        }
    if (averaged > 0) r->last /= averaged;
}

/* Between particles, as [MC] measured them. */
static void read_contacts(run *r, const char *name, const char *step)
{
    char path[1024], line[512];
    long j;
    double force;
    snprintf(path, sizeof path, "%s.%s.csv", name, step);
    FILE *file = open_file(path);
    while (fgets(line, sizeof line, file)) {
        if (sscanf(line, "%*d,%ld,%*f,%lf", &j, &force) != 2 || j < 0 || force <= 0) continue;
        r->contacts++;
        r->mean += force;
        if (force < BINS * BIN) r->share[(int)(force / BIN)]++;
    }
    fclose(file);
    if (r->contacts > 0) r->mean /= (double)r->contacts;
}

static void draw_tables(line_chart *c, const run *runs, int count, double most_strain)
{
    const line_axis strain = {"strain in %", 0, most_strain, false};
    double top = 0;
    for (int k = 0; k < count; k++)
        for (int n = 0; n < runs[k].rows; n++) top = fmax(top, runs[k].row[n][1]);
    for (int column = 1; column <= 2; column++) {
        line_chart_panel(c, column == 1 ? "force on the top plate" : "coordination", strain,
                         column == 1 ? (line_axis){"N", 0, top * 1.05, false}
                                     : (line_axis){"contacts of a sphere with others", 4, 8, false});
        for (int k = 0; k < count; k++) {
            line_chart_curve(c, runs[k].model->colour, LINE_SOLID, "%s", runs[k].model->label);
            for (int n = 0; n < runs[k].rows; n++) line_chart_point(c, runs[k].row[n][0], runs[k].row[n][column]);
        }
    }
}

static void draw_distribution(line_chart *c, const run *runs, int count)
{
    line_chart_panel(c, "forces between spheres at the end", (line_axis){"force in mN", 0, 1e3 * BINS * BIN / 2, false},
                     (line_axis){"share of contacts per mN", 1e-4, 1e-1, true});
    for (int k = 0; k < count; k++) {
        line_chart_curve(c, runs[k].model->colour, LINE_SOLID, "%s", runs[k].model->label);
        for (int b = 0; b < BINS; b++)
            if (runs[k].share[b] > 0)
                line_chart_point(c, 1e3 * BIN * (b + .5), runs[k].share[b] / (double)runs[k].contacts / (1e3 * BIN));
    }
}

/* Over Hertz: what was measured cancels. */
static void draw_ratios(line_chart *c, const run *runs, int count)
{
    double hertz = NAN;
    for (int k = 0; k < count; k++)
        if (strcmp(runs[k].model->name, "hertz") == 0) hertz = runs[k].last;
    line_chart_panel(c, "top force over Hertz', last 1 %; circles: [MC] Table I", (line_axis){"model", 0, MODELS + 1, false},
                     (line_axis){"ratio", 0, 2.5, false});
    for (int k = 0; k < count; k++) {
        const run *r = &runs[k];
        const double at = (double)(r->model - models) + 1, ratio = r->last / hertz;
        line_chart_curve(c, r->model->colour, LINE_SOLID, "%s", r->model->label);
        line_chart_point(c, at, 0);
        line_chart_point(c, at, ratio);
        printf("%-32s top force %.4g N, over Hertz' %.3f", r->model->label, r->last, ratio);
        if (r->model->r_top > 0) printf(" ([MC] %.3f)", r->model->r_top / models[0].r_top);
        printf(", coordination %.2f, mean force %.1f mN\n", r->row[r->rows - 1][2], 1e3 * r->mean);
        if (!(r->model->r_top > 0)) continue;
        line_chart_curve(c, r->model->colour, LINE_MARKS, "%s, [MC] Table I", r->model->label);
        line_chart_point(c, at, r->model->r_top / models[0].r_top);
    }
}

int main(int argc, char **argv)
{
    static run runs[RUNS];
    static line_chart chart = {
        .title = "Uniaxial compression of hydrogel spheres between rigid plates", .columns = 2, .width = 420, .height = 300};
    int count = 0;
    double strain = 0;
    if (argc < 5) return fputs("usage: plot PICTURE.svg DATA.csv STEP NAME...\n", stderr), 2;
    for (int k = 4; k < argc && count < RUNS; k++) {
        run *r = &runs[count];
        if (!(r->model = find(argv[k]))) return fprintf(stderr, "plot: %s is no model\n", argv[k]), EXIT_FAILURE;
        read_table(r, argv[k]);
        read_contacts(r, argv[k], argv[3]);
        if (r->rows == 0) return fprintf(stderr, "plot: %s is empty\n", argv[k]), EXIT_FAILURE;
        strain = fmax(strain, r->row[r->rows - 1][0]);
        line_chart_legend(&chart, r->model->label, r->model->colour, LINE_SOLID);
        count++;
    }
    if (!(strain > 0)) return fputs("plot: nothing is compressed\n", stderr), EXIT_FAILURE;
    draw_tables(&chart, runs, count, strain);
    draw_distribution(&chart, runs, count);
    draw_ratios(&chart, runs, count);
    FILE *picture = fopen(argv[1], "w"), *data = fopen(argv[2], "w");
    if (!picture || !data || chart.failed) return fputs("plot: cannot write\n", stderr), EXIT_FAILURE;
    line_chart_write_svg(picture, &chart);
    line_chart_write_csv(data, &chart);
    line_chart_free(&chart);
    for (int k = 0; k < count; k++) free(runs[k].row);
    return fclose(picture) | fclose(data) ? EXIT_FAILURE : EXIT_SUCCESS;
}
