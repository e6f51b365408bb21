/* SPDX-License-Identifier: BSD-2-Clause */
/* accuracy_chart.c - the errors of models as small pictures. */
#include "accuracy_chart.h"

#include <math.h>
#include <stdbool.h>

enum { COLUMNS = 4, PANEL_WIDTH = 200, PANEL_HEIGHT = 150, LEFT = 46, HEAD = 66, GAP_X = 26, GAP_Y = 44 };
/* what is drawn of eps, and of the error in percent */
#define EPS_LOW 1e-3
#define EPS_HIGH .1
#define ERROR_LOW 1e-2
#define ERROR_HIGH 100.

static const char *colour_of(const accuracy_model *m)
{
    static const char *const colours[] = {"#e58a0c", "#888888", "#b9a13a", "#3a8a5f", "#35133d", "#c23a4b"};
    return colours[m->number % (int32_t)(sizeof colours / sizeof colours[0])];
}

static double to_column(double eps)
{
    return PANEL_WIDTH * log(eps / EPS_LOW) / log(EPS_HIGH / EPS_LOW);
}

static double to_row(double percent)
{
    double p = fmin(fmax(percent, ERROR_LOW), ERROR_HIGH);
    return PANEL_HEIGHT * log(ERROR_HIGH / p) / log(ERROR_HIGH / ERROR_LOW);
}

/* The smallest eps above the one given with a point of this kind, and the worst error there.  false: there is none. */
static bool next_point(const accuracy_results *a, accuracy_point like, double *eps, double *worst)
{
    bool found = false;
    double above = *eps * 1.0001;
    for (int k = 0; k < a->count; k++) {
        const accuracy_point *p = &a->point[k];
        if (p->model != like.model || p->table != like.table || p->group != like.group) continue;
        if (p->eps <= above || p->eps > EPS_HIGH * 1.0001 || (found && p->eps > *eps * 1.0001)) continue;
        *worst = found && p->eps > *eps * 0.9999 ? fmax(*worst, fabs(p->error)) : fabs(p->error);
        *eps = p->eps;
        found = true;
    }
    return found;
}

static void draw_line(FILE *out, const accuracy_results *a, int table, int model, int group)
{
    accuracy_point like = {.model = model, .table = table, .group = group};
    double eps = EPS_LOW * .9998, worst = 0;
    char command = 'M';
    while (next_point(a, like, &eps, &worst)) {
        if (command == 'M')
            fprintf(out, "<path class=\"line\" stroke=\"%s\"%s d=\"", colour_of(&a->model[model]),
                    group ? " stroke-dasharray=\"4 3\"" : "");
        fprintf(out, "%c%.1f %.1f", command, to_column(eps), to_row(100 * worst));
        command = 'L';
    }
    if (command == 'L') fputs("\"/>\n", out);
}

static void draw_grid(FILE *out, bool left)
{
    for (double p = ERROR_LOW; p < ERROR_HIGH * 1.01; p *= 10) {
        fprintf(out, "<path class=\"grid\" d=\"M0 %.1fh%d\"/>", to_row(p), PANEL_WIDTH);
        if (left) fprintf(out, "<text text-anchor=\"end\" x=\"-5\" y=\"%.1f\">%g %%</text>", to_row(p) + 4, p);
    }
    for (double e = EPS_LOW; e < EPS_HIGH * 1.01; e *= 10) {
        double x = to_column(e);
        const char *anchor = x < 1 ? "start" : x > PANEL_WIDTH - 1 ? "end" : "middle";
        fprintf(out, "<path class=\"grid\" d=\"M%.1f 0v%d\"/><text text-anchor=\"%s\" x=\"%.1f\" y=\"%d\">%g</text>", x,
                PANEL_HEIGHT, anchor, x, PANEL_HEIGHT + 14, e);
    }
    fputc('\n', out);
}

static void write_text(FILE *out, const char *s)
{
    for (; *s; s++) fputc(*s == '<' || *s == '&' || *s < ' ' || *s > '~' ? '?' : *s, out);
}

static void draw_panel(FILE *out, const accuracy_results *a, int table)
{
    int x = LEFT + table % COLUMNS * (PANEL_WIDTH + GAP_X), y = HEAD + table / COLUMNS * (PANEL_HEIGHT + GAP_Y);
    fprintf(out, "<g transform=\"translate(%d %d)\">\n<text class=\"name\" y=\"-6\">", x, y);
    write_text(out, a->table[table].name);
    fprintf(out, "%s</text>\n", a->table[table].finite_strain ? ", finite strain" : "");
    draw_grid(out, table % COLUMNS == 0);
    for (int m = 0; m < a->models; m++)
        for (int g = 0; g < a->table[table].groups; g++) draw_line(out, a, table, m, g);
    fputs("</g>\n", out);
}

static void draw_legend(FILE *out, const accuracy_results *a)
{
    fprintf(out, "<g transform=\"translate(%d 34)\">\n", LEFT);
    for (int m = 0; m < a->models; m++)
        fprintf(out, "<path class=\"line\" stroke=\"%s\" d=\"M%d 0h24\"/><text x=\"%d\" y=\"4\">%s</text>\n",
                colour_of(&a->model[m]), 150 * m, 150 * m + 30, a->model[m].name);
    fputs("</g>\n", out);
}

static void draw_head(FILE *out, int width, int height, const char *title)
{
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\""
            " viewBox=\"0 0 %d %d\">\n"
            "<style>text{font:11px Helvetica,Arial,'DejaVu Sans',sans-serif;fill:#222}.name{font-weight:bold}"
            ".grid{stroke:#ddd;stroke-width:.8}.line{fill:none;stroke-width:1.8}</style>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n"
            "<text x=\"%d\" y=\"18\" style=\"font-size:14px\">%s</text>\n",
            width, height, width, height, LEFT, title);
}

void accuracy_chart_write_svg(FILE *out, const accuracy_results *a)
{
    int rows = (a->tables + COLUMNS - 1) / COLUMNS;
    int width = LEFT + COLUMNS * (PANEL_WIDTH + GAP_X), height = HEAD + rows * (PANEL_HEIGHT + GAP_Y);
    draw_head(out, width, height,
              "worst error of the force over all nu against overlap / R of the first contacts; dashed: the second");
    draw_legend(out, a);
    for (int t = 0; t < a->tables; t++) draw_panel(out, a, t);
    fputs("</svg>\n", out);
}

/* ---- accuracy against cost */

enum { COST_WIDTH = 560, COST_HEIGHT = 330 };
#define TIME_LOW 1.
#define TIME_HIGH 1e5
#define RMS_LOW .1

static double cost_column(double time)
{
    return COST_WIDTH * log(fmin(fmax(time, TIME_LOW), TIME_HIGH) / TIME_LOW) / log(TIME_HIGH / TIME_LOW);
}

static double cost_row(double percent)
{
    return COST_HEIGHT * log(ERROR_HIGH / fmin(fmax(percent, RMS_LOW), ERROR_HIGH)) / log(ERROR_HIGH / RMS_LOW);
}

static void draw_cost_grid(FILE *out)
{
    for (double p = RMS_LOW; p < ERROR_HIGH * 1.01; p *= 10)
        fprintf(out,
                "<path class=\"grid\" d=\"M0 %.1fh%d\"/><text text-anchor=\"end\" x=\"-5\" y=\"%.1f\">%g %%</text>\n",
                cost_row(p), COST_WIDTH, cost_row(p) + 4, p);
    for (double t = TIME_LOW; t < TIME_HIGH * 1.01; t *= 10)
        fprintf(out,
                "<path class=\"grid\" d=\"M%.1f 0v%d\"/><text text-anchor=\"middle\" x=\"%.1f\" y=\"%d\">%g</text>\n",
                cost_column(t), COST_HEIGHT, cost_column(t), COST_HEIGHT + 14, t);
}

/* Where a label has room: behind its point, or slanted above where another point follows, or below where one is above. */
static void draw_label(FILE *out, const accuracy_results *a, int model, double x, double y)
{
    bool followed = false, covered = false;
    for (int k = 0; k < a->models; k++) {
        const double ahead = cost_column(a->model[k].solve_time) - x, below = cost_row(100 * a->model[k].rms) - y;
        followed = followed || (k != model && ahead > -20 && ahead < 110 && fabs(below) < 12);
        covered = covered || (k != model && ahead > -110 && ahead < 110 && below < -3 && below > -12);
    }
    const char *anchor = covered ? "middle" : "start", *slant = followed && !covered ? " rotate(-30)" : "";
    fprintf(out, "<text class=\"name\" text-anchor=\"%s\" transform=\"translate(%.1f %.1f)%s\">%s</text>\n", anchor,
            x + (covered ? 0 : *slant ? 4 : 9), y + (covered ? 17 : *slant ? -8 : 4), slant, a->model[model].name);
}

static void draw_cost(FILE *out, const accuracy_results *a, int model)
{
    const accuracy_model *m = &a->model[model];
    const double x = cost_column(m->solve_time), y = cost_row(100 * m->rms);
    fprintf(out, "<path class=\"line\" stroke=\"%s\" stroke-opacity=\".5\" d=\"M%.1f %.1fv-8v4H%.1f\"/>", colour_of(m),
            cost_column(m->sweep_time), y + 4, x);
    fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"%s\"/>\n", x, y, colour_of(m));
    draw_label(out, a, model, x, y);
}

void accuracy_chart_write_cost(FILE *out, const accuracy_results *a, const char *packing)
{
    draw_head(out, LEFT + COST_WIDTH + 110, HEAD + COST_HEIGHT + 34, "root mean square error of the force, all exact tables");
    fprintf(out, "<text x=\"%d\" y=\"36\">against ns per contact (", LEFT);
    write_text(out, packing);
    fprintf(out,
            "): a dot is nlc_solve to 1e-8, the other end of its line one nlc_sweep</text>\n"
            "<g transform=\"translate(%d %d)\">\n",
            LEFT, HEAD);
    draw_cost_grid(out);
    for (int m = 0; m < a->models; m++) draw_cost(out, a, m);
    fputs("</g>\n</svg>\n", out);
}
