/* SPDX-License-Identifier: BSD-2-Clause */
/* rubber_sphere.c - Fig. 7: Tatara's rubber sphere between two plates, to 40 % of its diameter. */
#include <math.h>

#include "figures.h"

enum { STEPS = 80 };
static const double most = .4;

static double hertz(double eps)
{
    const double n = nlc_hertz_stiffness(RUBBER_YOUNG, RUBBER_POISSON, RUBBER_RADIUS, INFINITY, 0, INFINITY);
    return nlc_hertz_force(n, eps * RUBBER_RADIUS);
}

/* [GC] 12 with n_NL from 11: three terms of the series in the overlap, as Tatara has them. */
static double three_terms(double eps)
{
    const double n = nlc_hertz_stiffness(RUBBER_YOUNG, RUBBER_POISSON, RUBBER_RADIUS, INFINITY, 0, INFINITY);
    const double coupling = nlc_nonlocal_displacement(1, PI, RUBBER_RADIUS, RUBBER_YOUNG, RUBBER_POISSON);
    const double y = n * coupling * sqrt(eps * RUBBER_RADIUS);
    return hertz(eps) * (1 + y * (3. / 2 + y * 21 / 8));
}

static double solved(double eps, int32_t model)
{
    cell c;
    cell_init(&c, RUBBER_RADIUS, RUBBER_YOUNG, RUBBER_POISSON);
    cell_plate(&c, 0, 0, 1, eps * RUBBER_RADIUS);
    cell_plate(&c, 0, 0, -1, eps * RUBBER_RADIUS);
    return cell_solve(&c, model) == NLC_OK ? c.force[0] : NAN;
}

static void draw_curves(figure *f, bool relative)
{
    line_chart_curve(&f->chart, COLOUR_HERTZ, LINE_DASHED, "Hertz");
    for (int k = 1; k <= STEPS; k++) line_chart_point(&f->chart, most * k / STEPS, relative ? 1 : hertz(most * k / STEPS));
    line_chart_curve(&f->chart, COLOUR_TERMS, LINE_DASHED, "three terms");
    for (int k = 1; k <= STEPS; k++) {
        const double eps = most * k / STEPS;
        line_chart_point(&f->chart, eps, three_terms(eps) / (relative ? hertz(eps) : 1));
    }
    for (int m = 0; m < MODELS; m++) {
        line_chart_curve(&f->chart, models[m].colour, LINE_SOLID, "%s", models[m].name);
        for (int k = 1; k <= STEPS; k++) {
            const double eps = most * k / STEPS;
            line_chart_point(&f->chart, eps, solved(eps, models[m].number) / (relative ? hertz(eps) : 1));
        }
    }
}

bool rubber_sphere(figure *f)
{
    f->chart.title = "[GC] Fig. 7: a rubber sphere between two plates, R = 10 mm, E = 1.85 MPa, nu = 0.46";
    legend_of_models(f);
    line_chart_legend(&f->chart, "three terms, [GC] 12", COLOUR_TERMS, LINE_DASHED);
    line_chart_legend(&f->chart, "finite elements", COLOUR_ELEMENTS, LINE_MARKS);
    line_chart_legend(&f->chart, "exact linear elasticity", COLOUR_EXACT, LINE_MARKS);
    for (int relative = 0; relative < 2; relative++) {
        const line_axis y = relative ? (line_axis){"load / load by Hertz", .9, 1.8, false} : (line_axis){"load in N", 0, 150, false};
        line_chart_panel(&f->chart, relative ? "load over Hertz" : "load", (line_axis){"approach / 2R", 0, most, false}, y);
        draw_curves(f, relative);
        const marks elements = {"data/fe/uniaxial", "finite elements", COLOUR_ELEMENTS, 0, relative, 0, .998456 * RUBBER_YOUNG};
        const marks exact = {"data/reference/uniaxial", "exact linear elasticity", COLOUR_EXACT, 0, relative, 0, RUBBER_YOUNG};
        if (!add_marks(f, &elements) || !add_marks(f, &exact)) return false;
    }
    for (double eps = .1; eps < .5; eps += .3) {
        char what[LINE_NAME];
        const char *const names[] = {"Hertz", models[0].name, "three terms", models[1].name};
        const double values[] = {hertz(eps), solved(eps, models[0].number), three_terms(eps), solved(eps, models[1].number)};
        for (int k = 0; k < 4; k++) {
            snprintf(what, sizeof what, "%s: load at %g [N]", names[k], eps);
            tell(f, what, values[k], NAN);
        }
    }
    return true;
}
