/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * compaction.c - Figs. 16 and 17: a body-centred cubic crystal compressed in all directions, or in a die along z.
 *
 * The load is the force on a face of the cubic cell.  First contacts are those along the cell's diagonals, second ones those
 * with the centres of neighbouring cells, in a die only along z; there [GC] calls those across third.
 */
#include <math.h>

#include "figures.h"

enum { STEPS = 160, AXIAL = 4, LATERAL = 5 };
static const double poissons[POISSONS] = {0, .1, .2, .3, .4, .44};
static const double loose = PI * 1.7320508075688772 / 8; /* relative density at which first contacts touch, [GC] 19 */

typedef struct crystal {
    bool die;
    double radius, young, poisson;
    int32_t model;
} crystal;

static void build(cell *c, const crystal *k, double density)
{
    const double x = k->die ? 1 : cbrt(loose / density), z = k->die ? loose / density : x;
    const double a = 2 / sqrt(3) * k->radius * x, b = 2 / sqrt(3) * k->radius * z; /* half edges of the cell */
    cell_init(c, k->radius, k->young, k->poisson);
    cell_image(c, a, a, b);
    cell_image(c, a, -a, b);
    cell_image(c, a, a, -b);
    cell_image(c, a, -a, -b);
    cell_image(c, 0, 0, 2 * b);
    cell_image(c, 2 * a, 0, 0);
    cell_image(c, 0, 2 * a, 0);
}

/*
 * The state at a density, from one nearby; false, and c as it was: there is no stable one.  nlc_solve's answer is taken where it
 * comes without a warning.  Where circles of contact overlap there may be other solutions: there, too, the branch is followed.
 */
static bool solve(cell *c, const crystal *k, double density)
{
    cell next;
    build(&next, k, density);
    const nlc_status status = cell_solve(&next, k->model);
    if (status < 0) return false;
    if (status != NLC_OK) {
        for (int n = 0; n < c->contacts; n++) next.force[n] = c->force[n];
        if (!cell_follow(&next, k->model)) return false;
    }
    *c = next;
    return true;
}

static double load(const cell *c, bool axial)
{
    const int axis = axial ? 2 : 0;
    return 4 * c->force[0] * fabs(c->normal[0][axis]) + 2 * c->force[axial ? AXIAL : LATERAL];
}

static double load_by_hertz(const crystal *k, double density)
{
    crystal h = *k;
    cell c;
    h.model = NLC_MODEL_HERTZ;
    build(&c, k, density);
    return solve(&c, &h, density) ? load(&c, true) : NAN;
}

/* By how much surfaces of second neighbours overlap, displaced as they are. */
static double second_overlap(const cell *c, int contact)
{
    return c->overlap[contact] + c->nonlocal[contact];
}

/* The next state; steps are halved where there is none.  false: the end of the stable branch has been reached. */
static bool advance(cell *c, const crystal *k, double *density, double step)
{
    for (double d = step; d > 1e-9; d /= 2)
        if (solve(c, k, *density + d)) {
            *density += d;
            return true;
        }
    return false;
}

typedef enum quantity { AXIAL_LOAD, LATERAL_LOAD, DISCREPANCY } quantity;

static double value(const cell *c, const crystal *k, double density, quantity q)
{
    if (q != DISCREPANCY) return load(c, q == AXIAL_LOAD);
    return load(c, true) / load_by_hertz(k, density) - 1;
}

/* From the loose crystal to a density; false: the stable branch ends before, there.  If a figure is given, a curve of it. */
static bool walk(figure *f, const crystal *k, quantity q, double to, double *density, cell *c)
{
    *density = loose + 1e-5;
    build(c, k, *density);
    for (int n = 1; n <= STEPS; n++) {
        const double next = loose + (to - loose) * n / STEPS;
        while (*density < next - 1e-12) {
            if (!advance(c, k, density, next - *density)) return false;
            if (f) line_chart_point(&f->chart, *density, value(c, k, *density, q));
        }
    }
    return true;
}

static void draw_loads(figure *f, bool compact_in_die, quantity q)
{
    const char *axis = compact_in_die ? q == AXIAL_LOAD ? "axial" : "lateral" : "load";
    double density;
    cell c;
    crystal k = {compact_in_die, RUBBER_RADIUS, RUBBER_YOUNG, RUBBER_POISSON, NLC_MODEL_HERTZ};
    line_chart_panel(&f->chart, axis, (line_axis){"relative density", .65, 1, false},
                     (line_axis){"force on a face of the cell in N", 0, q == LATERAL_LOAD || !compact_in_die ? 150 : 300, false});
    line_chart_curve(&f->chart, COLOUR_HERTZ, LINE_DASHED, "Hertz");
    walk(f, &k, q, 1, &density, &c);
    for (int m = 0; m < MODELS; m++) {
        line_chart_curve(&f->chart, models[m].colour, LINE_SOLID, "%s", models[m].name);
        k.model = models[m].number;
        walk(f, &k, q, 1, &density, &c);
    }
}

static void draw_discrepancies(figure *f, bool compact_in_die)
{
    char what[LINE_NAME];
    double end;
    cell c;
    line_chart_panel(&f->chart, "D", (line_axis){"relative density", .65, 1, false},
                     (line_axis){"D of the load", 0, 2.5, false});
    for (int n = 0; n < POISSONS; n++)
        for (int m = 0; m < MODELS; m++) {
            const crystal k = {compact_in_die, 1, 1, poissons[n], models[m].number};
            line_chart_curve(&f->chart, poisson_colour[n], models[m].style, "%s nu %g", models[m].name, poissons[n]);
            const bool full = walk(f, &k, DISCREPANCY, 1, &end, &c);
            snprintf(what, sizeof what, "%s: D at full density nu %g", models[m].name, poissons[n]);
            const bool known = !compact_in_die && m == 0 && n == POISSONS - 1;
            tell(f, what, full ? value(&c, &k, end, DISCREPANCY) : NAN, known ? 2 : NAN);
        }
}

/* The density at which second contacts appear, by bisection below the one given. */
static double second_contacts(crystal k, double below)
{
    double low = loose + 1e-5, high = below;
    cell c;
    build(&c, &k, low);
    while (high - low > 1e-7) {
        const double middle = (low + high) / 2;
        *(solve(&c, &k, middle) && second_overlap(&c, AXIAL) > 0 ? &high : &low) = middle;
    }
    return high;
}

static void tell_second_contacts(figure *f, bool compact_in_die)
{
    static const figure_model three[] = {
        {NLC_MODEL_HERTZ, "Hertz", 0, 0}, {NLC_MODEL_GONZALEZ_CUITINO, "Case I", 0, 0}, {NLC_MODEL_SPHERE, "exact sphere", 0, 0}};
    static const double paper[2][2] = {{1.04, .95}, {.786, .780}};
    for (int m = 0; m < 3; m++) {
        char what[LINE_NAME];
        const crystal k = {compact_in_die, 1, 1, .45, three[m].number};
        snprintf(what, sizeof what, "%s: second contacts nu 0.45", three[m].name);
        tell(f, what, second_contacts(k, m == 0 ? 1.1 : 1), m < 2 ? paper[compact_in_die][m] : NAN);
    }
}

/* The density from which circles of contact overlap. */
static double circles_touch(const crystal *k)
{
    double low = loose + 1e-5, high = 1;
    cell c;
    while (high - low > 1e-6) {
        const double middle = (low + high) / 2;
        build(&c, k, middle);
        *(cell_solve(&c, k->model) & NLC_WARNING_CLOSE ? &high : &low) = middle;
    }
    return high < 1 ? high : NAN;
}

/* Of rubber: where the branch ends, where third contacts form, and how far they are from it at .96, where [GC] has them. */
static void tell_end(figure *f, bool compact_in_die)
{
    char what[LINE_NAME];
    for (int m = 0; m < MODELS; m++) {
        const crystal k = {compact_in_die, 1, 1, RUBBER_POISSON, models[m].number};
        double density;
        cell c;
        const bool full = walk(NULL, &k, AXIAL_LOAD, 1, &density, &c);
        snprintf(what, sizeof what, "%s: end of the stable branch nu 0.46", models[m].name);
        tell(f, what, full ? NAN : density, NAN);
        snprintf(what, sizeof what, "%s: circles of contact overlap from nu 0.46", models[m].name);
        tell(f, what, circles_touch(&k), NAN);
        if (!compact_in_die) continue;
        snprintf(what, sizeof what, "%s: third contacts nu 0.46", models[m].name);
        tell(f, what, c.force[LATERAL] > 0 ? density : NAN, m == 0 ? .96 : NAN);
        snprintf(what, sizeof what, "%s: gap / R of third contacts at the end or 1 nu 0.46", models[m].name);
        tell(f, what, -second_overlap(&c, LATERAL), NAN);
        snprintf(what, sizeof what, "%s: gap / R of third contacts at 0.96 nu 0.46", models[m].name);
        tell(f, what, walk(NULL, &k, AXIAL_LOAD, .96, &density, &c) ? -second_overlap(&c, LATERAL) : NAN, NAN);
    }
}

static bool draw(figure *f, bool compact_in_die)
{
    line_chart_legend(&f->chart, "Hertz, nu = 0.46", COLOUR_HERTZ, LINE_DASHED);
    line_chart_legend(&f->chart, "Case I, nu = 0.46", COLOUR_CASE_I, LINE_SOLID);
    line_chart_legend(&f->chart, "exact sphere, nu = 0.46", COLOUR_SPHERE, LINE_SOLID);
    legend_of_poissons(f, poissons);
    f->chart.columns = compact_in_die ? 3 : 2;
    draw_loads(f, compact_in_die, AXIAL_LOAD);
    if (compact_in_die) draw_loads(f, compact_in_die, LATERAL_LOAD);
    draw_discrepancies(f, compact_in_die);
    tell_second_contacts(f, compact_in_die);
    tell_end(f, compact_in_die);
    return true;
}

bool hydrostatic(figure *f)
{
    f->chart.title = "[GC] Fig. 16: body-centred cubic crystal under hydrostatic compaction";
    return draw(f, false);
}

bool die(figure *f)
{
    f->chart.title = "[GC] Fig. 17: body-centred cubic crystal under die compaction";
    return draw(f, true);
}
