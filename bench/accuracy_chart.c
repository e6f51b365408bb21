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
            fprintf(out, "<path class=\"line\" stroke=\"%s\"%s d=\"", a->model[model]->colour,
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
                a->model[m]->colour, 150 * m, 150 * m + 30, a->model[m]->name);
    fputs("</g>\n", out);
}

void accuracy_chart_write_svg(FILE *out, const accuracy_results *a)
{
    int rows = (a->tables + COLUMNS - 1) / COLUMNS;
    int width = LEFT + COLUMNS * (PANEL_WIDTH + GAP_X), height = HEAD + rows * (PANEL_HEIGHT + GAP_Y);
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\""
            " viewBox=\"0 0 %d %d\">\n"
            "<style>text{font:11px Helvetica,Arial,'DejaVu Sans',sans-serif;fill:#222}.name{font-weight:bold}"
            ".grid{stroke:#ddd;stroke-width:.8}.line{fill:none;stroke-width:1.8}</style>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n"
            "<text x=\"%d\" y=\"18\" style=\"font-size:14px\">worst error of the force over all nu against overlap / R of the"
            " first contacts; dashed: the second</text>\n",
            width, height, width, height, LEFT);
    draw_legend(out, a);
    for (int t = 0; t < a->tables; t++) draw_panel(out, a, t);
    fputs("</svg>\n", out);
}
