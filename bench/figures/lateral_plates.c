/* SPDX-License-Identifier: BSD-2-Clause */
/* lateral_plates.c - Fig. 8: a rubber sphere between two plates and two, or four, more that just touch it at its sides. */
#include <math.h>

#include "figures.h"

enum { STEPS = 50 };
static const double most = .1;

typedef struct layout {
    const char *name, *elements, *exact;
    int lateral; /* plates */
} layout;
static const layout layouts[] = {{"one pair", "data/fe/one_lateral", "data/reference/one_lateral", 2},
                                 {"two pairs", "data/fe/two_lateral", "data/reference/two_lateral", 4}};

static bool solve(cell *c, const layout *l, double eps, int32_t model)
{
    cell_init(c, RUBBER_RADIUS, RUBBER_YOUNG, RUBBER_POISSON);
    cell_plate(c, 0, 0, 1, eps * RUBBER_RADIUS);
    cell_plate(c, 0, 0, -1, eps * RUBBER_RADIUS);
    for (int k = 0; k < l->lateral; k++) cell_plate(c, k < 2 ? 1 - 2 * k : 0, k < 2 ? 0 : 5 - 2 * k, 0, 0);
    return cell_solve(c, model) == NLC_OK;
}

static bool draw_panel(figure *f, const layout *l, int group)
{
    cell c;
    char name[LINE_NAME];
    snprintf(name, sizeof name, "%s %s", l->name, group ? "lateral" : "axial");
    line_chart_panel(&f->chart, name, (line_axis){"approach / 2R", 0, most, false},
                     group ? (line_axis){"lateral reaction in N", 0, .5, false} : (line_axis){"load in N", 0, 14, false});
    line_chart_curve(&f->chart, COLOUR_HERTZ, LINE_DASHED, "Hertz");
    for (int k = 0; k <= STEPS; k++)
        if (solve(&c, l, most * k / STEPS, NLC_MODEL_HERTZ)) line_chart_point(&f->chart, most * k / STEPS, c.force[2 * group]);
    for (int m = 0; m < MODELS; m++) {
        line_chart_curve(&f->chart, models[m].colour, LINE_SOLID, "%s", models[m].name);
        for (int k = 0; k <= STEPS; k++) {
            const double eps = most * k / STEPS;
            if (solve(&c, l, eps, models[m].number)) line_chart_point(&f->chart, eps, c.force[2 * group]);
        }
        snprintf(name, sizeof name, "%s: %s %s at 0.1 [N]", models[m].name, l->name, group ? "lateral" : "axial");
        tell(f, name, solve(&c, l, most, models[m].number) ? c.force[2 * group] : NAN, NAN);
    }
    const marks elements = {l->elements, "finite elements", COLOUR_ELEMENTS, group, false, 0, .998456 * RUBBER_YOUNG};
    const marks exact = {l->exact, "exact linear elasticity", COLOUR_EXACT, group, false, 0, RUBBER_YOUNG};
    return add_marks(f, &elements) && add_marks(f, &exact);
}

bool lateral_plates(figure *f)
{
    f->chart.title = "[GC] Fig. 8: a rubber sphere pressed in one direction, held in one or two others";
    legend_of_models(f);
    line_chart_legend(&f->chart, "finite elements", COLOUR_ELEMENTS, LINE_MARKS);
    line_chart_legend(&f->chart, "exact linear elasticity", COLOUR_EXACT, LINE_MARKS);
    for (int k = 0; k < 4; k++)
        if (!draw_panel(f, &layouts[k / 2], k % 2)) return false;
    return true;
}
