/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * discrepancy.c - Figs. 10 to 13: by how much coupling changes the loading force of crystals, D = P / P_Hertz - 1, [GC] 16.
 *
 * Crystals are pressed along z; their extent in the other directions is fixed.  R = E = 1.
 */
#include <math.h>

#include "figures.h"

enum { STEPS = 50 };
static const double most = .1;
static const double poissons[POISSONS] = {0, .1, .2, .3, .4, .5};

/* A crystal strained by eps, [GC]'s: its contact number 0 is one that bears the load. */
typedef void crystal(cell *c, double eps);

static void chain(cell *c, double eps)
{
    cell_image(c, 0, 0, 2 * (1 - eps));
}

static void square(cell *c, double eps)
{
    chain(c, eps);
    cell_image(c, 2, 0, 0);
}

static void cubic(cell *c, double eps)
{
    square(c, eps);
    cell_image(c, 0, 2, 0);
}

static void rotated(cell *c, double eps)
{
    cell_image(c, sqrt(2), 0, sqrt(2) * (1 - eps));
    cell_image(c, -sqrt(2), 0, sqrt(2) * (1 - eps));
}

static void hexagonal(cell *c, double eps)
{
    cell_image(c, 1, 0, sqrt(3) * (1 - eps));
    cell_image(c, -1, 0, sqrt(3) * (1 - eps));
    cell_image(c, 2, 0, 0);
}

static void preloaded(cell *c, double eps)
{
    cell_image(c, 0, 0, 2 * (1 - .04 - eps));
    cell_image(c, 2 * (1 - .04), 0, 0);
}

static bool solve(cell *c, crystal *build, double eps, double nu, int32_t model)
{
    cell_init(c, 1, 1, nu);
    build(c, eps);
    return cell_solve(c, model) == NLC_OK;
}

static double discrepancy(crystal *build, double eps, double nu, int32_t model)
{
    cell c;
    if (!solve(&c, build, eps, nu, model)) return NAN;
    return c.force[0] / nlc_hertz_force(nlc_hertz_stiffness(1, nu, 1, 1, nu, 1), c.overlap[0]) - 1;
}

/* [GC] 17 and 18, without the terms that are not given. */
static double series(double eps, double nu)
{
    const double b = (3 - 2 * nu) / (1 - nu);
    return b * sqrt(eps) / (2 * PI) + 7 * b * b * eps / (24 * PI * PI);
}

static void draw_discrepancy(figure *f, const char *name, crystal *build, double highest, bool with_series)
{
    char what[LINE_NAME];
    line_chart_panel(&f->chart, name, (line_axis){"eps", 0, most, false}, (line_axis){"D", 0, highest, false});
    for (int n = 0; n < POISSONS; n++) {
        for (int m = 0; m < MODELS; m++) {
            line_chart_curve(&f->chart, poisson_colour[n], models[m].style, "%s nu %g", models[m].name, poissons[n]);
            for (int k = 0; k <= STEPS; k++)
                line_chart_point(&f->chart, most * k / STEPS,
                                 discrepancy(build, most * fmax(k, .02) / STEPS, poissons[n], models[m].number));
            snprintf(what, sizeof what, "%s: %s D at 0.1 nu %g", models[m].name, name, poissons[n]);
            const bool known = build == hexagonal && m == 0 && n == POISSONS - 1; /* "discrepancies of 40 %", in the summary */
            tell(f, what, discrepancy(build, most, poissons[n], models[m].number), known ? .4 : NAN);
        }
        if (!with_series) continue;
        line_chart_curve(&f->chart, poisson_colour[n], LINE_DOTTED, "series nu %g", poissons[n]);
        for (int k = 0; k <= STEPS; k++) line_chart_point(&f->chart, most * k / STEPS, series(most * k / STEPS, poissons[n]));
    }
}

bool cubic_crystals(figure *f)
{
    f->chart.title = "[GC] Fig. 10: discrepancy D between the nonlocal and Hertz' force";
    f->chart.columns = 3;
    legend_of_poissons(f, poissons);
    line_chart_legend(&f->chart, "series, [GC] 17, 18", "#444444", LINE_DOTTED);
    draw_discrepancy(f, "1-D", chain, .3, true);
    draw_discrepancy(f, "square", square, .3, true);
    draw_discrepancy(f, "3-D", cubic, .3, true);
    return true;
}

bool rotated_square(figure *f)
{
    f->chart.title = "[GC] Fig. 11: square crystal rotated by 45 degrees";
    legend_of_poissons(f, poissons);
    draw_discrepancy(f, "rotated square", rotated, .4, false);
    return true;
}

bool preloaded_square(figure *f)
{
    f->chart.title = "[GC] Fig. 13: square crystal preloaded by 4 % in both directions";
    legend_of_poissons(f, poissons);
    draw_discrepancy(f, "preloaded square", preloaded, .5, false);
    return true;
}

/* The gap between horizontal neighbours over R, < 0 where they press on each other. */
static double gap(double eps, double nu, int32_t model)
{
    cell c;
    return solve(&c, hexagonal, eps, nu, model) ? -(c.overlap[2] + c.nonlocal[2]) : NAN;
}

/* nu above which there is no gap at this eps, by bisection; NaN: there never is one. */
static double last_gap(double eps, int32_t model)
{
    double low = 0, high = .5;
    if (!(gap(eps, low, model) > 0)) return NAN;
    while (high - low > 1e-6) *(gap(eps, (low + high) / 2, model) > 0 ? &low : &high) = (low + high) / 2;
    return low;
}

bool close_packed(figure *f)
{
    char what[LINE_NAME];
    f->chart.title = "[GC] Fig. 12: close-packed crystal, and the gap that opens between horizontal neighbours";
    legend_of_poissons(f, poissons);
    draw_discrepancy(f, "close-packed", hexagonal, .5, false);
    line_chart_panel(&f->chart, "gap", (line_axis){"eps", 0, most, false},
                     (line_axis){"gap / R; negative: contact", -.02, .03, false});
    for (int n = 0; n < POISSONS; n++)
        for (int m = 0; m < MODELS; m++) {
            line_chart_curve(&f->chart, poisson_colour[n], models[m].style, "%s nu %g", models[m].name, poissons[n]);
            for (int k = 0; k <= STEPS; k++)
                line_chart_point(&f->chart, most * k / STEPS, gap(most * k / STEPS, poissons[n], models[m].number));
        }
    for (int m = 0; m < MODELS; m++) {
        snprintf(what, sizeof what, "%s: gap / R at 0.1 nu 0", models[m].name);
        tell(f, what, gap(most, 0, models[m].number), NAN);
        snprintf(what, sizeof what, "%s: gap up to nu at 0.01", models[m].name);
        tell(f, what, last_gap(.01, models[m].number), NAN);
        snprintf(what, sizeof what, "%s: gap up to nu at 0.1", models[m].name);
        tell(f, what, last_gap(most, models[m].number), NAN);
    }
    return true;
}
