/* SPDX-License-Identifier: BSD-2-Clause */
/* preloaded.c - Fig. 14: forces of a square crystal of rubber spheres, preloaded by 4 % in both directions, pressed in one. */
#include <math.h>

#include "figures.h"

enum { STEPS = 50 };
static const double most = .1, before = .04;

/* contact 0: axial, 1: lateral */
static bool solve(cell *c, double eps, int32_t model)
{
    cell_init(c, RUBBER_RADIUS, RUBBER_YOUNG, RUBBER_POISSON);
    cell_image(c, 0, 0, 2 * RUBBER_RADIUS * (1 - before - eps));
    cell_image(c, 2 * RUBBER_RADIUS * (1 - before), 0, 0);
    return cell_solve(c, model) == NLC_OK;
}

static void draw_curve(figure *f, int contact, int32_t model, const char *name, const char *colour, line_style style)
{
    cell c;
    line_chart_curve(&f->chart, colour, style, "%s", name);
    for (int k = 0; k <= STEPS; k++)
        if (solve(&c, most * k / STEPS, model)) line_chart_point(&f->chart, most * k / STEPS, c.force[contact]);
}

bool preloaded_forces(figure *f)
{
    cell c;
    char what[LINE_NAME];
    f->chart.title = "[GC] Fig. 14: square crystal of rubber spheres preloaded by 4 %";
    legend_of_models(f);
    line_chart_legend(&f->chart, "exact linear elasticity", COLOUR_EXACT, LINE_MARKS);
    for (int contact = 0; contact < 2; contact++) {
        const char *name = contact ? "lateral" : "axial";
        line_chart_panel(&f->chart, name, (line_axis){"further approach / 2R", 0, most, false},
                         contact ? (line_axis){"lateral reaction in N", 2, 6, false} : (line_axis){"load in N", 0, 25, false});
        draw_curve(f, contact, NLC_MODEL_HERTZ, "Hertz", COLOUR_HERTZ, LINE_DASHED);
        for (int m = 0; m < MODELS; m++) draw_curve(f, contact, models[m].number, models[m].name, models[m].colour, LINE_SOLID);
        const marks exact = {"figures/preloaded", "exact linear elasticity", COLOUR_EXACT, contact, false, before, RUBBER_YOUNG};
        if (!add_marks(f, &exact)) return false;
        for (int m = 0; m < MODELS; m++)
            for (double eps = 0; eps < .2; eps += most) {
                snprintf(what, sizeof what, "%s: %s at %g [N]", models[m].name, name, eps);
                tell(f, what, solve(&c, eps, models[m].number) ? c.force[contact] : NAN, NAN);
            }
    }
    return true;
}
