/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * bed_picture.c - Figs. 18 and 19, the beds that bed/compact makes: parallel projections on one scale.
 *
 * Powders are told apart by shades of grey.  Spheres are drawn from the back to the front: where they overlap the nearer one is
 * whole.
 */
#include <math.h>
#include <stdlib.h>

#include "figures.h"
#include "packing_io.h"

enum { PICTURES = 3, PATH = 4096, WIDTH = 300, HEAD = 40, MARGIN = 16, FOOT = 34, CORNERS = 8 };
static const double azimuth = .5, elevation = .32; /* of the eye [rad] */

typedef struct view {
    packing p;
    const char *caption;
} view;

typedef struct spot {
    double x, y, depth; /* to the right, up, away from the eye */
} spot;

typedef struct ball {
    spot at;
    double radius;
    int32_t material;
} ball;

static spot seen(double x, double y, double z)
{
    const double right = x * cos(azimuth) + y * sin(azimuth), away = y * cos(azimuth) - x * sin(azimuth);
    return (spot){right, z * cos(elevation) + away * sin(elevation), away * cos(elevation) - z * sin(elevation)};
}

static int by_depth(const void *a, const void *b)
{
    const double x = ((const ball *)a)->at.depth, y = ((const ball *)b)->at.depth;
    return x < y ? 1 : x > y ? -1 : 0;
}

static void line(FILE *out, double scale, spot a, spot b, const char *class)
{
    fprintf(out, "<path class=\"%s\" d=\"M%.1f %.1fL%.1f %.1f\"/>\n", class, scale * a.x, -scale * a.y, scale * b.x,
            -scale * b.y);
}

/* Edges of a box that start in its corner which is farthest from the eye, or the others. */
static void draw_box(FILE *out, double scale, const packing *p, double height, bool back, const char *class)
{
    const double side[3] = {p->high[0] - p->low[0], p->high[1] - p->low[1], height};
    for (int corner = 0; corner < CORNERS; corner++)
        for (int axis = 0; axis < 3; axis++) {
            if (corner >> axis & 1) continue; /* each edge from its lower end */
            const int end = corner | 1 << axis;
            /* the farthest corner is that of the left wall, the back wall and the floor: 2 */
            if ((corner == 2 || end == 2) != back) continue;
            line(out, scale, seen(corner & 1 ? side[0] : 0, corner & 2 ? side[1] : 0, corner & 4 ? side[2] : 0),
                 seen(end & 1 ? side[0] : 0, end & 2 ? side[1] : 0, end & 4 ? side[2] : 0), class);
        }
}

static void draw_punch(FILE *out, double scale, const packing *p)
{
    const double x = p->high[0] - p->low[0], y = p->high[1] - p->low[1], z = p->high[2] - p->low[2];
    const spot corner[4] = {seen(0, 0, z), seen(x, 0, z), seen(x, y, z), seen(0, y, z)};
    fputs("<path class=\"punch\" d=\"", out);
    for (int k = 0; k < 4; k++) fprintf(out, "%c%.1f %.1f", k ? 'L' : 'M', scale * corner[k].x, -scale * corner[k].y);
    fputs("z\"/>\n", out);
}

/* false: no memory */
static bool draw_balls(FILE *out, double scale, const packing *p)
{
    ball *balls = malloc((size_t)p->count * sizeof *balls);
    if (!balls) return false;
    for (int64_t k = 0; k < p->count; k++) {
        const spot at = seen(p->x[k][0] - p->low[0], p->x[k][1] - p->low[1], p->x[k][2] - p->low[2]);
        balls[k] = (ball){at, p->radius[k], p->material[k]};
    }
    qsort(balls, (size_t)p->count, sizeof *balls, by_depth);
    for (int64_t k = 0; k < p->count; k++)
        fprintf(out, "<circle fill=\"url(#powder%d)\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n", (int)balls[k].material + 1,
                scale * balls[k].at.x, -scale * balls[k].at.y, scale * balls[k].radius);
    free(balls);
    return true;
}

static double relative_density(const packing *p)
{
    double sum = 0;
    for (int64_t k = 0; k < p->count; k++) sum += 4 * PI / 3 * p->radius[k] * p->radius[k] * p->radius[k];
    return sum / packing_volume(p);
}

static void draw_head(FILE *out, const char *title, int width, int height)
{
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\""
            " viewBox=\"0 0 %d %d\">\n"
            "<style>text{font:12px Helvetica,Arial,'DejaVu Sans',sans-serif;fill:#222}circle{stroke:#222;stroke-width:.4}"
            ".die,.bed{fill:none;stroke:#888;stroke-width:.8}.die{stroke-dasharray:2 3}"
            ".punch{fill:#9ab;fill-opacity:.3;stroke:#567;stroke-width:.8}</style>\n<defs>\n",
            width, height, width, height);
    static const char *const shade[2][3] = {{"#9a9a9a", "#6b6b6b", "#3f3f3f"}, {"#ffffff", "#e2e2e2", "#a5a5a5"}};
    for (int k = 0; k < 2; k++)
        fprintf(out,
                "<radialGradient id=\"powder%d\" fx=\".35\" fy=\".3\"><stop offset=\"0\" stop-color=\"%s\"/>"
                "<stop offset=\".55\" stop-color=\"%s\"/><stop offset=\"1\" stop-color=\"%s\"/></radialGradient>\n",
                k + 1, shade[k][0], shade[k][1], shade[k][2]);
    fprintf(out, "</defs>\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n"
            "<text x=\"%d\" y=\"24\" style=\"font-size:14px\">%s</text>\n", MARGIN, title);
}

static bool write_picture(FILE *out, const char *title, const view *views, int count)
{
    double high = 0;
    bool good = true;
    for (int k = 0; k < count; k++) high = fmax(high, views[k].p.high[2] - views[k].p.low[2]);
    const double side = views[0].p.high[0] - views[0].p.low[0];
    const double across = side * (cos(azimuth) + sin(azimuth));
    const double scale = WIDTH / across, top = seen(0, side, high).y, bottom = seen(side, 0, 0).y;
    const int height = (int)(scale * (top - bottom));
    draw_head(out, title, MARGIN + count * (WIDTH + MARGIN), HEAD + height + FOOT);
    for (int k = 0; k < count; k++) {
        const packing *p = &views[k].p;
        fprintf(out, "<g transform=\"translate(%d %.1f)\">\n", MARGIN + k * (WIDTH + MARGIN), HEAD + scale * top);
        draw_box(out, scale, p, high, true, "die");
        draw_box(out, scale, p, p->high[2] - p->low[2], true, "bed");
        good = draw_balls(out, scale, p) && good;
        draw_punch(out, scale, p);
        draw_box(out, scale, p, p->high[2] - p->low[2], false, "bed");
        draw_box(out, scale, p, high, false, "die");
        fprintf(out, "<text text-anchor=\"middle\" x=\"%d\" y=\"%.1f\">%s, relative density %.2f</text>\n</g>\n", WIDTH / 2,
                -scale * bottom + 22, views[k].caption, relative_density(p));
    }
    fputs("</svg>\n", out);
    return good;
}

bool bed_pictures(figure *f)
{
    static const char *const files[PICTURES] = {"bed_poured", "bed_gonzalez-cuitino_0.56", "bed_gonzalez-cuitino_0.80"};
    static const char *const captions[PICTURES] = {"poured", "Case I", "Case I"};
    char path[PATH], error[PACKING_ERROR_SIZE];
    view views[PICTURES];
    bool good = true;
    int count = 0;
    for (; count < PICTURES && good; count++) {
        snprintf(path, sizeof path, "%s/%s.csv", f->beds, files[count]);
        views[count].caption = captions[count];
        good = packing_read(&views[count].p, path, false, error, sizeof error) == 0 || fail_figure(f, error);
    }
    FILE *out = good ? figure_open(f, "svg") : NULL;
    if (out && !write_picture(out, "[GC] Figs. 18 and 19: bed of two powders in a die", views, PICTURES))
        good = fail_figure(f, "out of memory");
    good = out && figure_close(f, out) && good;
    for (int k = 0; k < count; k++) packing_free(&views[k].p);
    return good;
}
