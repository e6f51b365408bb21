/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * surface.c - Figs. 2 and A2: the surface of an incompressible sphere under Hertz pressure on a circle of radius .233 R.
 *
 * Displacements are outward, in P / (E R).  The exact ones are relative to the centre of mass, those of Cases I and II to points
 * at infinity in the half-space.  Displacing the sphere along the axis adds a multiple of cos(theta): that multiple is chosen
 * for which exact ones and Case I agree best outside the circle.
 */
#include <errno.h>
#include <math.h>
#include <string.h>

#include "figures.h"

enum { LINE = 256, ANGLES = 91 };
static const double nu = .5, radius = .233;

typedef struct exact {
    int count;
    double theta[ANGLES], displacement[ANGLES]; /* rad */
} exact;

static bool read_exact(const figure *f, exact *e)
{
    char path[4096], line[LINE];
    snprintf(path, sizeof path, "%s/data/reference/hertz_pressure.csv", f->bench);
    FILE *file = fopen(path, "r");
    if (!file) {
        fprintf(stderr, "figures: %s: %s\n", path, strerror(errno));
        return false;
    }
    while (fgets(line, sizeof line, file)) {
        double poisson, degrees, u;
        if (sscanf(line, "%lf,%lf,%lf", &poisson, &degrees, &u) != 3 || fabs(poisson - nu) > 1e-9 || e->count == ANGLES) continue;
        e->theta[e->count] = degrees * PI / 180;
        e->displacement[e->count++] = u;
    }
    fclose(file);
    if (e->count == ANGLES) return true;
    fprintf(stderr, "figures: %s: not the rows expected\n", path);
    return false;
}

/* ---- the curves; P = E = R = 1 */

/* [GC] 1 under the circle, for all approximations; its u_z is along the axis. */
static bool inside(double theta)
{
    return sin(theta) <= radius && theta < 1;
}

static double under_circle(double theta)
{
    return -nlc_contact_displacement(1, radius, sin(theta), 1, nu);
}

static double case_1(double theta)
{
    return nlc_nonlocal_displacement(1, theta, 1, 1, nu);
}

static double case_2(double theta)
{
    return nlc_love_nonlocal_displacement(1, radius, theta, 1, 1, nu);
}

/* What is left of the half-space at this distance from the circle's centre, 2 R sin(theta/2). */
static double half_space(double theta)
{
    double u[2];
    nlc_love_displacement(u, 1, radius, 2 * sin(theta / 2), 0, 1, nu);
    return -u[0];
}

/* The exact sphere to second order in a/R, as NLC_MODEL_SPHERE has it, relative to the centre of mass. */
static double sphere(double theta)
{
    return nlc_sphere_displacement(1, theta, 1, 1, nu) -
           (1 + nu) / (4 * PI) * radius * radius / 10 * nlc_sphere_finite_size(theta, nu, 1);
}

/* The multiple of cos(theta): least squares per area. */
static double best_shift(const exact *e)
{
    double above = 0, below = 0;
    for (int k = 0; k < e->count - 1; k++) {
        const double c = cos(e->theta[k]), area = sin(e->theta[k]);
        if (inside(e->theta[k])) continue;
        above += area * c * (case_1(e->theta[k]) - e->displacement[k]);
        below += area * c * c;
    }
    return above / below;
}

typedef struct curve {
    const char *name, *colour;
    double (*value)(double theta);
    line_style style;
    bool shifted;
} curve;
static const curve curves[] = {{"half-space", COLOUR_HERTZ, half_space, LINE_DASHED, false},
                               {"Case I", COLOUR_CASE_I, case_1, LINE_SOLID, false},
                               {"Case II", COLOUR_CASE_II, case_2, LINE_DASHED, false},
                               {"exact sphere to second order", COLOUR_SPHERE, sphere, LINE_DOTTED, true}};
enum { CURVES = sizeof curves / sizeof curves[0] };

static void draw_displacements(figure *f, const exact *e, double shift)
{
    line_chart_panel(&f->chart, "displacement", (line_axis){"theta in degrees", 0, 180, false},
                     (line_axis){"outward displacement, P / (E R)", -3, .5, false});
    for (int n = 0; n < CURVES; n++) {
        const curve *v = &curves[n];
        line_chart_curve(&f->chart, v->colour, v->style, "%s", v->name);
        for (int k = 0; k <= 180; k++) {
            const double theta = k * PI / 180;
            const double u = inside(theta) ? under_circle(theta) : v->value(theta) + (v->shifted ? shift * cos(theta) : 0);
            line_chart_point(&f->chart, k, u);
        }
    }
    line_chart_curve(&f->chart, COLOUR_EXACT, LINE_MARKS, "exact");
    for (int k = 0; k < e->count; k += 2)
        line_chart_point(&f->chart, e->theta[k] * 180 / PI, e->displacement[k] + shift * cos(e->theta[k]));
}

static void draw_differences(figure *f, const exact *e, double shift)
{
    static const char *const names[CURVES] = {"half-space", "Case I", "Case II", "exact sphere"};
    line_chart_panel(&f->chart, "difference", (line_axis){"theta in degrees", 0, 180, false},
                     (line_axis){"displacement - exact", -.1, .1, false});
    for (int n = 0; n < CURVES; n++) {
        double worst = 0;
        const curve *v = &curves[n];
        line_chart_curve(&f->chart, v->colour, v->style, "%s", v->name);
        for (int k = 0; k < e->count; k++) {
            const double theta = e->theta[k], move = shift * cos(theta);
            if (inside(theta)) continue;
            const double d = v->value(theta) + (v->shifted ? move : 0) - e->displacement[k] - move;
            line_chart_point(&f->chart, theta * 180 / PI, d);
            if (theta > PI / 6) worst = fmax(worst, fabs(d));
        }
        char what[LINE];
        snprintf(what, sizeof what, "%s: worst difference from 30 degrees on", names[n]);
        tell(f, what, worst, NAN);
    }
}

bool surface(figure *f)
{
    exact e = {.count = 0};
    if (!read_exact(f, &e)) return false;
    const double shift = best_shift(&e);
    f->chart.title = "[GC] Figs. 2, A2: surface of the loaded sphere, a/R = 0.233, nu = 0.5";
    for (int n = 0; n < CURVES; n++) line_chart_legend(&f->chart, curves[n].name, curves[n].colour, curves[n].style);
    line_chart_legend(&f->chart, "exact", COLOUR_EXACT, LINE_MARKS);
    draw_displacements(f, &e, shift);
    draw_differences(f, &e, shift);
    tell(f, "multiple of cos(theta)", shift, NAN);
    tell(f, "Case I at 180 degrees", case_1(PI), NAN);
    tell(f, "exact at 180 degrees", e.displacement[ANGLES - 1] - shift, NAN);
    return true;
}
