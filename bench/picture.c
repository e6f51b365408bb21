/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * picture.c - draws force chains.
 *
 * Forces are sorted into a few dozen classes; a class is one path with one colour and one width, which keeps the file small
 * and puts the strong chains on top.  Coordinates are in pixels from the upper left corner of a panel.
 */
#include "picture.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "table.h"

enum {
    MARGIN = 36,
    PANEL_WIDTH = 450,
    PANEL_HEIGHT = 680, /* at most */
    GAP = 36,
    HEAD = 72,    /* above the panels */
    FOOT = 114,   /* below */
    LEGEND = 260, /* length of the force scale */
    CLASSES = 32,
    NAME_MAX_SHOWN = 50, /* characters */
    SLAB_SPHERES = 220   /* so many can be told apart */
};

typedef struct canvas {
    FILE *out;
    const picture_input *in;
    double low[2], high[2];     /* what is seen of x and z [m] */
    double scale;               /* pixels per metre */
    double width, height;       /* of a panel */
    double slab_low, slab_high; /* in y [m] */
    bool slab;                  /* is anything left out? */
    double mean_radius;
    double most_force, most_width;
} canvas;

/* Light to dark in even steps of lightness: it survives grey printing, and the weak contacts stay in the background. */
static const unsigned char ramp[][3] = {
    {233, 216, 151}, {237, 179, 79}, {238, 138, 17}, {229, 95, 12}, {208, 56, 49},
    {176, 24, 71},   {136, 10, 82},  {94, 14, 80},   {53, 19, 61},
};
enum { RAMP = sizeof ramp / sizeof ramp[0] };

/* "#rrggbb" for t from 0 to 1 */
static void colour(double t, char text[8])
{
    double place = t * (RAMP - 1);
    int k = place >= RAMP - 1 ? RAMP - 2 : (int)place;
    unsigned c[3];
    for (int d = 0; d < 3; d++) c[d] = (unsigned)lround(ramp[k][d] + (place - k) * (ramp[k + 1][d] - ramp[k][d])) & 255u;
    snprintf(text, 8, "#%02x%02x%02x", c[0], c[1], c[2]);
}

static double to_column(const canvas *v, double x)
{
    return (x - v->low[0]) * v->scale;
}

static double to_row(const canvas *v, double z)
{
    return (v->high[1] - z) * v->scale;
}

/* The prefix of a unit, with the sign for micro that SVG allows. */
static const char *unit_prefix(double value, double *unit)
{
    const char *prefix;
    *unit = table_prefix(value, &prefix);
    return strcmp(prefix, "u") == 0 ? "\xc2\xb5" : prefix;
}

/* ---- choosing what is seen */

static void choose_view(canvas *v)
{
    const packing *p = v->in->p;
    for (int d = 0; d < 2; d++) {
        int axis = 2 * d;
        v->low[d] = p->low[axis];
        v->high[d] = p->high[axis];
        /* nothing holds particles in the box along an axis that is not periodic */
        for (int64_t k = 0; k < p->count && !p->periodic[axis]; k++) {
            double x = p->x[k][axis], r = p->radius[k];
            if (x < v->low[d]) v->low[d] = x - r;
            if (x > v->high[d]) v->high[d] = x + r;
        }
    }
    v->scale = fmin(PANEL_WIDTH / (v->high[0] - v->low[0]), PANEL_HEIGHT / (v->high[1] - v->low[1]));
    v->width = (v->high[0] - v->low[0]) * v->scale;
    v->height = (v->high[1] - v->low[1]) * v->scale;
}

static void choose_slab(canvas *v)
{
    const packing *p = v->in->p;
    double low = p->low[1], high = p->high[1], sum = 0;
    for (int64_t k = 0; k < p->count; k++) {
        sum += p->radius[k];
        if (p->periodic[1]) continue;
        low = fmin(low, p->x[k][1]);
        high = fmax(high, p->x[k][1]);
    }
    v->mean_radius = sum / (double)p->count;
    double thickness = fmax((high - low) * SLAB_SPHERES / (double)p->count, 3 * v->mean_radius);
    v->slab = thickness < 0.8 * (high - low);
    if (!v->slab) thickness = HUGE_VAL;
    v->slab_low = (low + high - thickness) / 2;
    v->slab_high = (low + high + thickness) / 2;
}

static bool in_slab(const canvas *v, double y)
{
    return y >= v->slab_low && y <= v->slab_high;
}

/* Both ends of a contact's line.  false: it is not in the slab. */
static bool find_line(const canvas *v, int64_t c, double from[3], double to[3])
{
    packing_position(v->in->p, v->in->n->i[c], from);
    neighbours_branch(v->in->n, v->in->p, c, to);
    for (int d = 0; d < 3; d++) to[d] += from[d];
    return in_slab(v, from[1]) && in_slab(v, to[1]);
}

static void choose_force(canvas *v)
{
    double from[3], to[3];
    for (int64_t c = 0; c < v->in->n->count; c++) {
        if (!find_line(v, c, from, to)) continue;
        v->most_force = fmax(v->most_force, v->in->hertz->force[c]);
        if (v->in->nonlocal) v->most_force = fmax(v->most_force, v->in->nonlocal->force[c]);
    }
    v->most_width = fmax(2.5, fmin(12, 0.45 * v->mean_radius * v->scale));
}

/* ---- spheres and lines */

/* A circle and, across periodic boundaries, the images that reach into the panel. */
static void draw_sphere(const canvas *v, int64_t k)
{
    const packing *p = v->in->p;
    double x[3], r = p->radius[k];
    packing_position(p, k, x);
    if (!in_slab(v, x[1])) return;
    for (int image = 0; image < 9; image++) {
        int shift[2] = {(image + 1) % 3 - 1, (image / 3 + 1) % 3 - 1};
        double at[2];
        bool seen = true;
        for (int d = 0; d < 2; d++) {
            int axis = 2 * d;
            at[d] = x[axis] + shift[d] * (p->high[axis] - p->low[axis]);
            seen = seen && (shift[d] == 0 || (p->periodic[axis] && at[d] + r > v->low[d] && at[d] - r < v->high[d]));
        }
        if (seen)
            fprintf(v->out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/>\n", to_column(v, at[0]), to_row(v, at[1]),
                    r * v->scale);
    }
}

static void draw_spheres(const canvas *v)
{
    fprintf(v->out,
            "<g id=\"spheres\" fill=\"#5b6b85\" fill-opacity=\".04\" stroke=\"#5b6b85\" stroke-opacity=\".22\""
            " stroke-width=\"%.2f\">\n",
            fmin(0.6, v->mean_radius * v->scale / 15));
    for (int64_t k = 0; k < v->in->p->count; k++) draw_sphere(v, k);
    fputs("</g>\n", v->out);
}

static void draw_line(const canvas *v, const double from[3], const double to[3], double x, double z)
{
    fprintf(v->out, "M%.1f %.1fL%.1f %.1f", to_column(v, from[0] + x), to_row(v, from[2] + z), to_column(v, to[0] + x),
            to_row(v, to[2] + z));
}

static void draw_contact(const canvas *v, int64_t c)
{
    const packing *p = v->in->p;
    double from[3], to[3], other[3];
    if (!find_line(v, c, from, to)) return;
    draw_line(v, from, to, 0, 0);
    if (v->in->n->j[c] >= p->count) return;
    /* where the line leaves the box, its other end comes in on the opposite side */
    packing_position(p, v->in->n->j[c], other);
    double x = other[0] - to[0], z = other[2] - to[2];
    if (fmax(fabs(x), fabs(z)) > 1e-3 * p->radius[v->in->n->j[c]]) draw_line(v, from, to, x, z);
}

/* 0: no force; 1 ... CLASSES */
static int class_of(const canvas *v, double force)
{
    return force > 0 ? (int)fmax(1, fmin(CLASSES, ceil(CLASSES * force / v->most_force))) : 0;
}

static void draw_chains(const canvas *v, const double *force)
{
    char text[8];
    for (int k = 1; k <= CLASSES; k++) {
        double t = (k - 0.5) / CLASSES;
        bool open = false;
        for (int64_t c = 0; c < v->in->n->count; c++) {
            if (class_of(v, force[c]) != k) continue;
            colour(t, text);
            if (!open) fprintf(v->out, "<path stroke=\"%s\" stroke-width=\"%.2f\" d=\"", text, t * v->most_width);
            open = true;
            draw_contact(v, c);
        }
        if (open) fputs("\"/>\n", v->out);
    }
}

/* ---- words */

/* The name comes from a file: what means something to XML, or nothing to people, is replaced. */
static void write_name(FILE *out, const char *s)
{
    for (int k = 0; *s && k < NAME_MAX_SHOWN; s++, k++) {
        if (*s == '<')
            fputs("&lt;", out);
        else if (*s == '&')
            fputs("&amp;", out);
        else
            fputc(*s >= ' ' && *s <= '~' ? *s : '?', out);
    }
}

static void draw_panel(const canvas *v, const analysis *a, double x)
{
    double unit;
    const char *prefix = unit_prefix(fmax(v->in->hertz->total, a->total), &unit);
    fprintf(v->out, "<g transform=\"translate(%.1f %d)\">\n", x, HEAD);
    fprintf(v->out, "<text class=\"title\" y=\"-30\">%s</text>\n<text y=\"-11\">total force %.4g %sN", a->model,
            a->total / unit, prefix);
    if (a != v->in->hertz && v->in->hertz->total > 0)
        fprintf(v->out, " = <tspan font-weight=\"bold\">%.3f \xc3\x97 Hertz</tspan>", a->total / v->in->hertz->total);
    fputs("</text>\n<g clip-path=\"url(#box)\">\n<use xlink:href=\"#spheres\"/>\n"
          "<g fill=\"none\" stroke-linecap=\"round\">\n",
          v->out);
    draw_chains(v, a->force);
    fprintf(v->out,
            "</g>\n</g>\n<rect width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"#444\" stroke-width=\".8\"/>\n</g>\n",
            v->width, v->height);
}

/* The largest of 1, 2, 5 times a power of ten that is not above x. */
static double round_down(double x)
{
    double power = pow(10, floor(log10(x)));
    double m = x / power;
    return (m >= 5 ? 5 : m >= 2 ? 2 : 1) * power;
}

/* A wedge that shows both width and colour; the chains' largest width may be too thin for a wedge. */
static void draw_force_scale(const canvas *v)
{
    char text[8];
    double unit, step = round_down(v->most_force / 2.5), half = fmax(v->most_width, 6) / 2;
    const char *prefix = unit_prefix(v->most_force, &unit);
    fputs("<defs><linearGradient id=\"ramp\">", v->out);
    for (int k = 0; k < RAMP; k++) {
        colour(k / (RAMP - 1.0), text);
        fprintf(v->out, "<stop offset=\"%.3f\" stop-color=\"%s\"/>", k / (RAMP - 1.0), text);
    }
    fprintf(v->out, "</linearGradient></defs>\n<path fill=\"url(#ramp)\" d=\"M0 0L%d %.1fV%.1fZ\"/>\n", LEGEND, -half, half);
    for (int k = 0; k * step <= v->most_force * 1.0001; k++) {
        double x = LEGEND * k * step / v->most_force;
        fprintf(v->out,
                "<path stroke=\"#444\" stroke-width=\".8\" d=\"M%.1f %.1fv4\"/><text text-anchor=\"middle\""
                " x=\"%.1f\" y=\"%.1f\">%.4g</text>\n",
                x, half + 2, x, half + 19, k * step / unit);
    }
    fprintf(v->out, "<text x=\"%d\" y=\"4\">contact force [%sN]</text>\n", LEGEND + 10, prefix);
}

static void draw_length_scale(const canvas *v, double right)
{
    double unit, metres = round_down(70 / v->scale), pixels = metres * v->scale;
    const char *prefix = unit_prefix(metres, &unit);
    fprintf(v->out,
            "<path stroke=\"#222\" stroke-width=\"2\" d=\"M%.1f 0h%.1f\"/>\n<text text-anchor=\"middle\" x=\"%.1f\""
            " y=\"18\">%.4g %sm</text>\n",
            right - pixels, pixels, right - pixels / 2, metres / unit, prefix);
}

static void draw_foot(const canvas *v, double right)
{
    const packing *p = v->in->p;
    fprintf(v->out, "<g transform=\"translate(%d %.1f)\">\n", MARGIN, HEAD + v->height + 30);
    if (v->most_force > 0) draw_force_scale(v);
    draw_length_scale(v, right - MARGIN);
    fputs("<text class=\"note\" y=\"56\">", v->out);
    write_name(v->out, p->name);
    fprintf(v->out, ", %lld spheres; x to the right, z up", (long long)p->count);
    if (v->slab) {
        double unit;
        const char *prefix = unit_prefix(fmax(fabs(v->slab_low), fabs(v->slab_high)), &unit);
        fprintf(v->out,
                "</text>\n<text class=\"note\" y=\"71\">only %.3g \xe2\x89\xa4 y \xe2\x89\xa4 %.3g %sm is shown, the totals "
                "are of all spheres",
                v->slab_low / unit, v->slab_high / unit, prefix);
    }
    fputs("</text>\n</g>\n", v->out);
}

static void draw_head(const canvas *v, double width, double height)
{
    fprintf(v->out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\""
            " xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\">\n",
            width, height, width, height);
    fputs("<style>text{font:13px Helvetica,Arial,'DejaVu Sans',sans-serif;fill:#222}"
          ".title{font-size:18px;font-weight:bold}.note{font-size:11px;fill:#666}</style>\n"
          "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<defs>\n<clipPath id=\"box\">",
          v->out);
    fprintf(v->out, "<rect width=\"%.1f\" height=\"%.1f\"/></clipPath>\n", v->width, v->height);
    draw_spheres(v);
    fputs("</defs>\n", v->out);
}

void picture_write_svg(FILE *out, const picture_input *in)
{
    canvas v = {.out = out, .in = in};
    choose_view(&v);
    choose_slab(&v);
    choose_force(&v);
    double right = MARGIN + v.width;
    if (in->nonlocal) right += GAP + v.width;
    /* the force scale and its words want some room even under a narrow panel */
    double width = fmax(right, MARGIN + LEGEND + 260) + MARGIN;
    draw_head(&v, width, HEAD + v.height + FOOT);
    draw_panel(&v, in->hertz, MARGIN);
    if (in->nonlocal) draw_panel(&v, in->nonlocal, MARGIN + v.width + GAP);
    draw_foot(&v, width - MARGIN);
    fputs("</svg>\n", out);
}
