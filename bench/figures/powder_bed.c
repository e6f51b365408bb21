/* SPDX-License-Identifier: BSD-2-Clause */
/* powder_bed.c - Fig. 19: forces on a die with a bed of two powders, from the table that bed/compact makes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bed_table.h"
#include "figures.h"

static const double first_density = .35, last_density = .8, shown = .82, step = .01;

static void draw_forces(figure *f, const bed_table *t, bed_quantity q)
{
    static const bed_series *const both[] = {&bed_hertz, &bed_case_i};
    line_chart_panel(&f->chart, q == BED_LOAD ? "load" : "lateral", (line_axis){"relative density", first_density, shown, false},
                     q == BED_LOAD ? (line_axis){"load in N", 0, 310, false}
                                   : (line_axis){"lateral reaction in N", 0, 160, false});
    for (int m = 0; m < 2; m++)
        for (int n = 0; n < t->beds; n++) {
            line_chart_curve(&f->chart, both[m]->pale, LINE_SOLID, "%s bed %d", both[m]->name, t->row[0].seed + n);
            for (double d = first_density; d < last_density + step / 2; d += step)
                line_chart_point(&f->chart, d, bed_force(t, both[m], n, d, q));
        }
    for (int m = 0; m < 2; m++) {
        line_chart_curve(&f->chart, both[m]->colour, m ? LINE_SOLID : LINE_DASHED, "%s mean", both[m]->name);
        for (double d = first_density; d < last_density + step / 2; d += step)
            line_chart_point(&f->chart, d, bed_mean_force(t, both[m], d, q));
    }
}

static void draw_discrepancies(figure *f, const bed_table *t, bed_quantity q)
{
    static const bed_series *const there[] = {&bed_case_i_there, &bed_sphere_there};
    line_chart_panel(&f->chart, q == BED_LOAD ? "D of the load" : "D of the lateral reaction",
                     (line_axis){"relative density", .55, shown, false}, (line_axis){"D", -.2, 1, false});
    for (int n = 0; n < t->beds; n++) {
        line_chart_curve(&f->chart, bed_case_i.pale, LINE_SOLID, "%s bed %d", bed_case_i.name, t->row[0].seed + n);
        for (double d = .55; d < last_density + step / 2; d += step)
            line_chart_point(&f->chart, d, bed_discrepancy(t, &bed_case_i, n, d, q));
    }
    line_chart_curve(&f->chart, bed_case_i.colour, LINE_SOLID, "%s mean", bed_case_i.name);
    for (double d = .55; d < last_density + step / 2; d += step)
        line_chart_point(&f->chart, d, bed_mean_discrepancy(t, &bed_case_i, d, q));
    for (int m = 0; m < 2; m++)
        for (int n = 0; n < t->beds; n++) {
            line_chart_curve(&f->chart, there[m]->colour, LINE_MARKS, "%s bed %d", there[m]->name, t->row[0].seed + n);
            for (double d = .6; d < last_density + step / 2; d += .05)
                line_chart_point(&f->chart, d, bed_discrepancy(t, there[m], n, d, q));
        }
}

/* Mean, least and largest of D over the beds. */
static void tell_spread(const figure *f, const bed_table *t, const bed_series *s, double density, bed_quantity q, double paper)
{
    char what[LINE_NAME];
    const char *of = q == BED_LOAD ? "load" : "lateral";
    double least = INFINITY, largest = -INFINITY;
    for (int n = 0; n < t->beds; n++) {
        const double d = bed_discrepancy(t, s, n, density, q);
        least = fmin(least, d);
        largest = fmax(largest, d);
    }
    snprintf(what, sizeof what, "%s: D of the %s at %g", s->name, of, density);
    const size_t end = strlen(what);
    tell(f, what, bed_mean_discrepancy(t, s, density, q), paper);
    snprintf(what + end, sizeof what - end, " least");
    tell(f, what, least, NAN);
    snprintf(what + end, sizeof what - end, " largest");
    tell(f, what, largest, NAN);
}

/* The density from which on a bed resists, in the mean. */
static double resists_from(const bed_table *t, const bed_series *s)
{
    double sum = 0;
    for (int n = 0; n < t->beds; n++) {
        double from = NAN;
        for (double d = last_density; d > first_density; d -= step) {
            const bed_row *r = bed_find(t, s, n, d);
            if (!r || !r->loaded) break;
            from = d;
        }
        sum += from;
    }
    return sum / t->beds;
}

/* The largest D of the load that a bed shows on the way, once every bed resists: mean, least and largest over the beds. */
static void tell_largest(const figure *f, const bed_table *t)
{
    double sum = 0, least = INFINITY, largest = -INFINITY;
    for (int n = 0; n < t->beds; n++) {
        double most = -INFINITY;
        for (double d = .6; d < last_density + step / 2; d += step)
            most = fmax(most, bed_discrepancy(t, &bed_case_i, n, d, BED_LOAD));
        sum += most;
        least = fmin(least, most);
        largest = fmax(largest, most);
    }
    tell(f, "Case I: largest D of a bed from 0.6", sum / t->beds, .5);
    tell(f, "Case I: largest D of a bed from 0.6 least", least, NAN);
    tell(f, "Case I: largest D of a bed from 0.6 largest", largest, NAN);
}

static void tell_numbers(const figure *f, const bed_table *t)
{
    static const bed_series *const four[] = {&bed_hertz, &bed_case_i, &bed_case_i_there, &bed_sphere_there};
    char what[LINE_NAME];
    double poured = 0, imbalance = 0;
    long warned = 0;
    for (int n = 0; n < t->beds; n++) poured += t->poured[n] / t->beds;
    for (int k = 0; k < t->rows; k++) {
        if (t->row[k].loaded) imbalance = fmax(imbalance, t->row[k].imbalance);
        warned += t->row[k].status != 0;
    }
    tell(f, "beds", t->beds, NAN);
    tell(f, "relative density when poured", poured, .42);
    tell(f, "largest imbalance over mean force", imbalance, NAN);
    tell(f, "states with a warning", (double)warned, NAN);
    for (int m = 0; m < 2; m++) {
        snprintf(what, sizeof what, "%s: resists from relative density", four[m]->name);
        tell(f, what, resists_from(t, four[m]), NAN);
        snprintf(what, sizeof what, "%s: load at 0.8 [N]", four[m]->name);
        tell(f, what, bed_mean_force(t, four[m], .8, BED_LOAD), NAN);
        snprintf(what, sizeof what, "%s: lateral at 0.8 [N]", four[m]->name);
        tell(f, what, bed_mean_force(t, four[m], .8, BED_LATERAL), NAN);
    }
    tell_largest(f, t);
    for (int m = 1; m < 4; m++)
        for (int k = 0; k < 5; k++)
            for (int q = 0; q < 2; q++) tell_spread(f, t, four[m], .6 + .05 * k, (bed_quantity)q, m == 1 && k == 4 && q == BED_LOAD ? .5 : NAN);
}

bool bed_loads(figure *f)
{
    bed_table *t = calloc(1, sizeof *t);
    if (!t || !bed_table_read(t, f->beds)) {
        free(t);
        return fail_figure(f, "no table of beds");
    }
    f->chart.title = "[GC] Fig. 19: consolidation and compaction of beds of 125 spheres of two powders";
    line_chart_legend(&f->chart, "Hertz, mean of the beds", bed_hertz.colour, LINE_DASHED);
    line_chart_legend(&f->chart, "Case I, mean", bed_case_i.colour, LINE_SOLID);
    line_chart_legend(&f->chart, "Hertz, each bed", bed_hertz.pale, LINE_SOLID);
    line_chart_legend(&f->chart, "Case I, each bed", bed_case_i.pale, LINE_SOLID);
    line_chart_legend(&f->chart, bed_case_i_there.name, bed_case_i_there.colour, LINE_MARKS);
    line_chart_legend(&f->chart, bed_sphere_there.name, bed_sphere_there.colour, LINE_MARKS);
    draw_forces(f, t, BED_LOAD);
    draw_forces(f, t, BED_LATERAL);
    draw_discrepancies(f, t, BED_LOAD);
    draw_discrepancies(f, t, BED_LATERAL);
    tell_numbers(f, t);
    free(t);
    return true;
}

