/* SPDX-License-Identifier: BSD-2-Clause */
/* figures.c - writes the figures of [GC] and [MC]: a picture and its data for each, and numbers.csv; prints what the paper has, too. */
#include "figures.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <time.h>

#include "reference_table.h"

enum { PATH = 4096, EXIT_USAGE = 2 };

const char *const poisson_colour[POISSONS] = {"#e3b23c", "#ee8a11", "#d03831", "#b0186f", "#5e2a9a", "#14133d"};
const figure_model models[MODELS] = {{NLC_MODEL_GONZALEZ_CUITINO, "Case I", COLOUR_CASE_I, LINE_SOLID},
                                     {NLC_MODEL_SPHERE, "exact sphere", COLOUR_SPHERE, LINE_DASHED}};

static figure all[] = {
    {.name = "fig02_surface", .draw = surface},
    {.name = "fig07_rubber_sphere", .draw = rubber_sphere},
    {.name = "fig08_lateral_plates", .draw = lateral_plates},
    {.name = "fig10_cubic_crystals", .draw = cubic_crystals},
    {.name = "fig11_rotated_square", .draw = rotated_square},
    {.name = "fig12_close_packed", .draw = close_packed},
    {.name = "fig13_preloaded_square", .draw = preloaded_square},
    {.name = "fig14_preloaded_forces", .draw = preloaded_forces},
    {.name = "fig16_bcc_hydrostatic", .draw = hydrostatic},
    {.name = "fig17_bcc_die", .draw = die},
    {.name = "fig18_bed", .draw = bed_pictures},
    {.name = "fig19_bed_loads", .draw = bed_loads},
    {.name = "mc_03_top_force", .draw = top_force},
    {.name = "mc_04_force_distribution", .draw = force_distribution},
    {.name = "mc_05_coordination", .draw = coordination},
    {.name = "mc_06_scaling_law", .draw = scaling_law},
};
enum { FIGURES = sizeof all / sizeof all[0] };

static bool fail(const char *where, const char *text)
{
    fprintf(stderr, "figures: %s: %s\n", where, text);
    return false;
}

void tell(const figure *f, const char *what, double value, double paper)
{
    fprintf(f->numbers, "%.5s,%s,", f->name, what);
    if (isfinite(value))
        fprintf(f->numbers, "%.7g,", value);
    else
        fputs("none,", f->numbers);
    if (isfinite(paper)) {
        fprintf(f->numbers, "%g", paper);
        printf("  %-44s ", what);
        printf(isfinite(value) ? "%7.4f" : "   none", value);
        printf("  [%s] %g\n", f->name[0] == 'm' ? "MC" : "GC", paper);
    }
    fputc('\n', f->numbers);
}

bool add_marks(figure *f, const marks *m)
{
    char path[PATH], error[PATH];
    reference_table t;
    snprintf(path, sizeof path, "%s/%s.csv", f->bench, m->table);
    if (reference_table_read(&t, path, error, sizeof error) != 0) {
        reference_table_free(&t);
        return fail(f->name, error);
    }
    line_chart_curve(&f->chart, m->colour, LINE_MARKS, "%s", m->name);
    const double n = nlc_hertz_stiffness(RUBBER_YOUNG, RUBBER_POISSON, RUBBER_RADIUS, INFINITY, 0, INFINITY);
    for (int k = 0; k < t.count; k++) {
        const reference_row *r = &t.row[k];
        if (fabs(r->nu - RUBBER_POISSON) > .003) continue;
        const double force = r->force[m->group] * m->young * RUBBER_RADIUS * RUBBER_RADIUS;
        line_chart_point(&f->chart, r->eps[0] - m->from,
                         m->relative ? force / nlc_hertz_force(n, r->eps[m->group] * RUBBER_RADIUS) : force);
    }
    reference_table_free(&t);
    return true;
}

void legend_of_models(figure *f)
{
    line_chart_legend(&f->chart, "Hertz", COLOUR_HERTZ, LINE_DASHED);
    for (int m = 0; m < MODELS; m++) line_chart_legend(&f->chart, models[m].name, models[m].colour, LINE_SOLID);
}

void legend_of_poissons(figure *f, const double *poisson)
{
    for (int m = 0; m < MODELS; m++) line_chart_legend(&f->chart, models[m].name, "#444444", models[m].style);
    for (int k = 0; k < POISSONS; k++) {
        char text[LINE_NAME];
        snprintf(text, sizeof text, "nu = %g", poisson[k]);
        line_chart_legend(&f->chart, text, poisson_colour[k], LINE_SOLID);
    }
}

bool fail_figure(const figure *f, const char *text)
{
    return fail(f->name, text);
}

FILE *figure_open(const figure *f, const char *suffix)
{
    char path[PATH];
    const bool fits = snprintf(path, sizeof path, "%s/%s.%s", f->output, f->name, suffix) < PATH;
    FILE *out = fits ? fopen(path, "w") : NULL;
    if (!out) fail(f->output, fits ? strerror(errno) : "the path is too long");
    return out;
}

bool figure_close(const figure *f, FILE *out)
{
    const bool bad = ferror(out) != 0;
    return fclose(out) == 0 && !bad ? true : fail(f->name, "cannot be written");
}

static bool write_file(const figure *f, const char *suffix, void (*write)(FILE *, const line_chart *))
{
    FILE *out = figure_open(f, suffix);
    if (out) write(out, &f->chart);
    return out && figure_close(f, out);
}

static bool make(figure *f)
{
    const clock_t start = clock();
    f->chart = (line_chart){.columns = 2, .width = 340, .height = 240};
    bool good = f->draw(f);
    if (good && f->chart.failed) good = fail(f->name, "out of memory");
    if (f->chart.panels > 0)
        good = good && write_file(f, "svg", line_chart_write_svg) && write_file(f, "csv", line_chart_write_csv);
    line_chart_free(&f->chart);
    if (good) printf("%s: %.2f s\n", f->name, (double)(clock() - start) / CLOCKS_PER_SEC);
    return good;
}

int main(int argc, char **argv)
{
    char path[PATH], beds[PATH];
    if (argc != 3 && argc != 4) {
        fputs("usage: figures BENCH-FOLDER OUTPUT-FOLDER [FOLDER-OF-BEDS]\n", stderr);
        return EXIT_USAGE;
    }
    snprintf(beds, sizeof beds, "%s/data/bed", argv[1]); /* those that were made before */
    snprintf(path, sizeof path, "%s/numbers.csv", argv[2]);
    FILE *numbers = fopen(path, "w");
    if (!numbers) return !fail(path, strerror(errno));
    fputs("figure,what,here,paper\n", numbers);
    bool good = true;
    for (int k = 0; k < FIGURES && good; k++) {
        all[k].numbers = numbers;
        all[k].bench = argv[1];
        all[k].output = argv[2];
        all[k].beds = argc == 4 ? argv[3] : beds;
        good = make(&all[k]);
    }
    if (ferror(numbers)) good = fail(path, "cannot be written");
    if (fclose(numbers) != 0) good = fail(path, "cannot be written");
    return good ? 0 : 1;
}
