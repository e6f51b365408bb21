/* SPDX-License-Identifier: BSD-2-Clause */
/* line_chart.c - curves in panels: a picture of them, and their data. */
#include "line_chart.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { LEFT = 14, TICKS = 52, HEAD = 34, LEGEND_ROW = 18, LEGEND_WIDTH = 170, LETTER = 8, GAP_X = 20, NAME_ROW = 22, FOOT = 44 };

/* ---- filling */

/* Room for one more element; arrays grow by doubling at powers of two. */
static void *grown(line_chart *c, void *p, int count, size_t size)
{
    if (c->failed || (count & (count - 1)) != 0) return p;
    void *more = realloc(p, (size_t)(2 * count + 1) * size);
    if (!more) c->failed = true;
    return more ? more : p;
}

void line_chart_panel(line_chart *c, const char *name, line_axis x, line_axis y)
{
    c->panel = grown(c, c->panel, c->panels, sizeof *c->panel);
    if (c->failed) return;
    line_panel *p = &c->panel[c->panels++];
    *p = (line_panel){.x = x, .y = y};
    snprintf(p->name, sizeof p->name, "%s", name);
}

void line_chart_curve(line_chart *c, const char *colour, line_style style, const char *format, ...)
{
    if (c->failed) return;
    line_panel *p = &c->panel[c->panels - 1];
    p->curve = grown(c, p->curve, p->curves, sizeof *p->curve);
    if (c->failed) return;
    line_curve *curve = &p->curve[p->curves++];
    *curve = (line_curve){.colour = colour, .style = style};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(curve->name, sizeof curve->name, format, arguments);
    va_end(arguments);
}

void line_chart_point(line_chart *c, double x, double y)
{
    if (c->failed || !isfinite(x) || !isfinite(y)) return;
    line_panel *p = &c->panel[c->panels - 1];
    line_curve *curve = &p->curve[p->curves - 1];
    curve->point = grown(c, curve->point, curve->count, sizeof *curve->point);
    if (c->failed) return;
    curve->point[curve->count][0] = x;
    curve->point[curve->count++][1] = y;
}

void line_chart_legend(line_chart *c, const char *text, const char *colour, line_style style)
{
    if (c->legends == LINE_LEGENDS) return;
    line_curve *l = &c->legend[c->legends++];
    *l = (line_curve){.colour = colour, .style = style};
    snprintf(l->name, sizeof l->name, "%s", text);
}

void line_chart_free(line_chart *c)
{
    for (int p = 0; p < c->panels; p++) {
        for (int k = 0; k < c->panel[p].curves; k++) free(c->panel[p].curve[k].point);
        free(c->panel[p].curve);
    }
    free(c->panel);
    c->panel = NULL;
    c->panels = 0;
}

/* ---- data */

void line_chart_write_csv(FILE *out, const line_chart *c)
{
    fprintf(out, "# %s\n", c->title);
    for (int p = 0; p < c->panels; p++)
        fprintf(out, "# %s: x %s; y %s\n", c->panel[p].name, c->panel[p].x.label, c->panel[p].y.label);
    fputs("panel,curve,x,y\n", out);
    for (int p = 0; p < c->panels; p++)
        for (int k = 0; k < c->panel[p].curves; k++) {
            const line_curve *v = &c->panel[p].curve[k];
            for (int n = 0; n < v->count; n++)
                fprintf(out, "%s,%s,%.10g,%.10g\n", c->panel[p].name, v->name, v->point[n][0], v->point[n][1]);
        }
}

/* ---- picture */

/* Names may come from files: what means something to XML, or is no text, is replaced. */
static void write_text(FILE *out, const char *s)
{
    for (; *s; s++) fputc(*s == '<' || *s == '&' || (unsigned char)*s < ' ' ? '?' : *s, out);
}

/* Place of a value on an axis, from 0 to 1; values beyond are kept close, so that the curve leaves where it should. */
static double place(const line_axis *a, double value)
{
    double t = a->logarithmic ? log(fmax(value, 1e-300) / a->low) / log(a->high / a->low) : (value - a->low) / (a->high - a->low);
    return fmin(fmax(t, -10), 11);
}

static double column(const line_chart *c, const line_panel *p, double x)
{
    return c->width * place(&p->x, x);
}

static double row(const line_chart *c, const line_panel *p, double y)
{
    return c->height * (1 - place(&p->y, y));
}

/* The next of the values that are marked on an axis; the first one for NaN. */
static double next_tick(const line_axis *a, double last)
{
    if (a->logarithmic) return isnan(last) ? a->low : 10 * last;
    double step = pow(10, floor(log10((a->high - a->low) / 4)));
    for (int k = 0; k < 2 && (a->high - a->low) / step > 6; k++) step *= k ? 2 : 2.5;
    double tick = isnan(last) ? step * ceil(a->low / step - 1e-9) : last + step;
    return fabs(tick) < 1e-9 * step ? 0 : tick;
}

static void draw_grid(FILE *out, const line_chart *c, const line_panel *p)
{
    for (double y = next_tick(&p->y, NAN); place(&p->y, y) < 1 + 1e-9; y = next_tick(&p->y, y))
        fprintf(out, "<path class=\"grid\" d=\"M0 %.1fh%d\"/><text text-anchor=\"end\" x=\"-5\" y=\"%.1f\">%.6g</text>\n",
                row(c, p, y), c->width, row(c, p, y) + 4, y);
    for (double x = next_tick(&p->x, NAN); place(&p->x, x) < 1 + 1e-9; x = next_tick(&p->x, x))
        fprintf(out, "<path class=\"grid\" d=\"M%.1f 0v%d\"/><text text-anchor=\"middle\" x=\"%.1f\" y=\"%d\">%.6g</text>\n",
                column(c, p, x), c->height, column(c, p, x), c->height + 15, x);
    fprintf(out, "<text text-anchor=\"middle\" x=\"%d\" y=\"%d\">", c->width / 2, c->height + 31);
    write_text(out, p->x.label);
    fprintf(out, "</text>\n<text text-anchor=\"middle\" transform=\"translate(-43 %d) rotate(-90)\">", c->height / 2);
    write_text(out, p->y.label);
    fputs("</text>\n", out);
}

static const char *dashes(line_style style)
{
    return style == LINE_DASHED ? " stroke-dasharray=\"6 3\"" : style == LINE_DOTTED ? " stroke-dasharray=\"1.5 2.5\"" : "";
}

static void draw_curve(FILE *out, const line_chart *c, const line_panel *p, const line_curve *v)
{
    if (v->count == 0) return;
    if (v->style == LINE_MARKS) {
        for (int n = 0; n < v->count; n++)
            fprintf(out, "<circle class=\"mark\" stroke=\"%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"2.6\"/>\n", v->colour,
                    column(c, p, v->point[n][0]), row(c, p, v->point[n][1]));
        return;
    }
    fprintf(out, "<path class=\"line\" stroke=\"%s\"%s d=\"", v->colour, dashes(v->style));
    for (int n = 0; n < v->count; n++)
        fprintf(out, "%c%.1f %.1f", n ? 'L' : 'M', column(c, p, v->point[n][0]), row(c, p, v->point[n][1]));
    fputs("\"/>\n", out);
}

static void draw_panel(FILE *out, const line_chart *c, int k, int top)
{
    const line_panel *p = &c->panel[k];
    int x = LEFT + TICKS + k % c->columns * (c->width + TICKS + GAP_X);
    int y = top + NAME_ROW + k / c->columns * (NAME_ROW + c->height + FOOT);
    fprintf(out, "<g transform=\"translate(%d %d)\">\n<text class=\"name\" y=\"-7\">", x, y);
    write_text(out, p->name);
    fputs("</text>\n", out);
    draw_grid(out, c, p);
    fputs("<g clip-path=\"url(#panel)\">\n", out);
    for (int n = 0; n < p->curves; n++) draw_curve(out, c, p, &p->curve[n]);
    fprintf(out, "</g>\n<rect width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#444\" stroke-width=\".8\"/>\n</g>\n", c->width,
            c->height);
}

static void draw_legend(FILE *out, const line_chart *c, int in_row)
{
    for (int k = 0; k < c->legends; k++) {
        const line_curve *l = &c->legend[k];
        int x = LEFT + k % in_row * LEGEND_WIDTH, y = HEAD + LEGEND_ROW / 2 + k / in_row * LEGEND_ROW;
        if (l->style == LINE_MARKS)
            fprintf(out, "<circle class=\"mark\" stroke=\"%s\" cx=\"%d\" cy=\"%d\" r=\"2.6\"/>", l->colour, x + 12, y);
        else
            fprintf(out, "<path class=\"line\" stroke=\"%s\"%s d=\"M%d %dh24\"/>", l->colour, dashes(l->style), x, y);
        fprintf(out, "<text x=\"%d\" y=\"%d\">", x + 30, y + 4);
        write_text(out, l->name);
        fputs("</text>\n", out);
    }
}

void line_chart_write_svg(FILE *out, const line_chart *c)
{
    int columns = c->panels < c->columns ? c->panels : c->columns, rows = (c->panels + c->columns - 1) / c->columns;
    int panels = columns * (c->width + TICKS + GAP_X), title = (int)strlen(c->title) * LETTER;
    int width = 2 * LEFT + (panels > title ? panels : title), in_row = (width - LEFT) / LEGEND_WIDTH;
    int top = HEAD + (c->legends + in_row - 1) / in_row * LEGEND_ROW, height = top + rows * (NAME_ROW + c->height + FOOT);
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\""
            " viewBox=\"0 0 %d %d\">\n"
            "<style>text{font:11px Helvetica,Arial,'DejaVu Sans',sans-serif;fill:#222}.name{font-weight:bold}"
            ".grid{stroke:#ddd;stroke-width:.8}.line{fill:none;stroke-width:1.6}.mark{fill:#fff;stroke-width:1.2}</style>\n"
            "<clipPath id=\"panel\"><rect width=\"%d\" height=\"%d\"/></clipPath>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n<text x=\"%d\" y=\"20\" style=\"font-size:14px\">",
            width, height, width, height, c->width, c->height, LEFT);
    write_text(out, c->title);
    fputs("</text>\n", out);
    draw_legend(out, c, in_row);
    for (int k = 0; k < c->panels; k++) draw_panel(out, c, k, top);
    fputs("</svg>\n", out);
}
