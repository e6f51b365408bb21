/* SPDX-License-Identifier: BSD-2-Clause */
/* hydrogel.c - Figs. 3 to 6 of Brodu, Dijksman and Behringer (2015), [MC], from the runs in bench/hydrogel. */
#include <math.h>
#include <string.h>

#include "figures.h"
#include "hydrogel/metrics.h"
#include "hydrogel/run.h"

enum { PATH = 4096, MODELS_MC = 7, MEASURED = 5 };
static const int first = 2; /* cycles before it are left out */
static const double resolution = .004;
#define LARGEST .1339 /* a bit less than the largest strain */
#define HALF_FORCE                                                                                                             \
    .1072 /* the level at which Hertz' and the other models' top forces in unloading are about half the largest */

/* In the order of Table I, whose numbers stand beside the names; the run that stands for the experiment last. */
typedef struct model {
    const char *file, *name, *colour;
    line_style style;
    double R_top, err_f, err_Z, bhat, threshold; /* in the paper; 1, N, 1, 1, N */
} model;
static const model all[MODELS_MC] = {
    {"hertz", "Hertz", COLOUR_HERTZ, LINE_SOLID, .43, 3.39, .51, .0721, .00289},
    {"point-force", "point force on sphere", COLOUR_ELEMENTS, LINE_SOLID, .44, 3.23, .53, .0651, .00293},
    {"gonzalez-cuitino", "Case I", COLOUR_CASE_I, LINE_SOLID, .70, 1.82, .34, .0257, .00335},
    {"half-space", "half-space", COLOUR_CASE_II, LINE_SOLID, .80, 1.26, .40, .0190, .00345},
    {"mc-paper", "MC-DEM, paper's R_top", COLOUR_TERMS, LINE_SOLID, 1, .41, .26, .0098, .00400},
    {"mc-sphere", "MC-DEM, exact sphere's", COLOUR_TERMS, LINE_DASHED, NAN, NAN, NAN, NAN, NAN},
    {"sphere", "exact sphere", COLOUR_SPHERE, LINE_MARKS, NAN, NAN, NAN, NAN, NAN},
};
enum { HERTZ = 0, MC_PAPER = 4, MC_SPHERE = 5, SPHERE = 6 };

typedef struct runs {
    run whole[MODELS_MC], mean[MODELS_MC];
} runs;

static void release(runs *r)
{
    for (int m = 0; m < MODELS_MC; m++) run_free(&r->whole[m]), run_free(&r->mean[m]);
}

static bool read_runs(runs *r, const figure *f)
{
    char path[PATH], error[RUN_ERROR_SIZE];
    memset(r, 0, sizeof *r);
    for (int m = 0; m < MODELS_MC; m++) {
        snprintf(path, sizeof path, "%s/hydrogel/%s.csv", f->bench, all[m].file);
        if (run_read(&r->whole[m], path, error, sizeof error) == 0 && run_mean(&r->mean[m], &r->whole[m], first)) continue;
        fprintf(stderr, "figures: %s: %s\n", f->name, *error ? error : "out of memory");
        release(r);
        return false;
    }
    return true;
}

static void legend(figure *f)
{
    for (int m = 0; m < MODELS_MC; m++) line_chart_legend(&f->chart, all[m].name, all[m].colour, all[m].style);
}

static void start_curve(figure *f, int m, const char *what)
{
    line_chart_curve(&f->chart, all[m].colour, all[m].style, "%s%s%s", all[m].name, *what ? " " : "", what);
}

/* ---- Fig. 3, and what Table I says of it */

static bool tell_metrics(const figure *f, const runs *r, int m, int reference)
{
    char what[LINE_NAME];
    metrics k;
    const bool to_paper = reference == MC_PAPER;
    const metrics_settings set = {.first = first, .threshold = NAN, .resolution = resolution};
    const char *wrong = metrics_compare(&k, &r->whole[m], &r->whole[reference], &set);
    if (wrong) return fprintf(stderr, "figures: %s: %s\n", all[m].file, wrong), false;
    const struct {
        const char *name;
        double here, paper;
    } row[MEASURED] = {{"R_top", k.R_top, all[m].R_top},
                       {"err_f [N]", k.err_f, all[m].err_f},
                       {"err_Z", k.err_Z, all[m].err_Z},
                       {"bhat", k.bhat, all[m].bhat},
                       {"tau [N]", k.threshold, all[m].threshold}};
    for (int n = 0; n < MEASURED; n++) {
        snprintf(what, sizeof what, "%s against %s: %s", all[m].file, all[reference].file, row[n].name);
        tell(f, what, row[n].here, to_paper ? row[n].paper : NAN);
    }
    return true;
}

/* Top force at the largest strain over that of Hertz; the paper's is a ratio of two of its R_top. */
static void tell_top(const figure *f, const runs *r, int m)
{
    char what[LINE_NAME];
    metrics k;
    const metrics_settings set = {.first = first, .threshold = 0};
    if (metrics_compare(&k, &r->whole[m], &r->whole[HERTZ], &set)) return;
    snprintf(what, sizeof what, "%s: top force [N]", all[m].file);
    tell(f, what, k.top, NAN);
    snprintf(what, sizeof what, "%s: top force over Hertz", all[m].file);
    tell(f, what, k.R_top, round(1e3 * all[m].R_top / all[HERTZ].R_top) / 1e3);
}

bool top_force(figure *f)
{
    runs r;
    run_row row;
    bool good = read_runs(&r, f);
    if (!good) return false;
    f->chart.title = "[MC] Fig. 3: force on the plate, cycles 2 to 5; MC-DEM with the prefactor fitted to two top forces";
    legend(f);
    line_chart_panel(&f->chart, "top force", (line_axis){"strain", 0, .14, false}, (line_axis){"N", 0, 9, false});
    for (int m = 0; m < MODELS_MC; m++)
        for (int p = 0; p < RUN_PHASES; p++) {
            start_curve(f, m, run_phase_name[p]);
            for (int n = 0; n < r.mean[m].rows; n++)
                if (r.mean[m].row[n].phase == (run_phase)p)
                    line_chart_point(&f->chart, r.mean[m].row[n].strain, r.mean[m].row[n].value[RUN_TOP]);
            if (p == RUN_UNLOAD && run_at(&row, &r.mean[m], RUN_LOAD, .134)) /* where it begins */
                line_chart_point(&f->chart, row.strain, row.value[RUN_TOP]);
        }
    line_chart_panel(&f->chart, "at the largest strain", (line_axis){"cycle", .5, 5.5, false}, (line_axis){"N", 0, 9, false});
    for (int m = 0; m < MODELS_MC; m++) {
        start_curve(f, m, "");
        for (int n = 0; n < r.whole[m].rows; n++)
            if (r.whole[m].row[n].strain > LARGEST)
                line_chart_point(&f->chart, r.whole[m].row[n].cycle, r.whole[m].row[n].value[RUN_TOP]);
        tell_top(f, &r, m);
    }
    for (int m = 0; m < MODELS_MC && good; m++)
        good = (m >= MC_PAPER || tell_metrics(f, &r, m, MC_PAPER)) && (m == SPHERE || tell_metrics(f, &r, m, SPHERE));
    release(&r);
    return good;
}

/* ---- Fig. 4 */

static void draw_distribution(figure *f, const runs *r, int m, double least)
{
    run_row row;
    double all_contacts = 0;
    const run *k = &r->mean[m];
    if (!run_at(&row, k, RUN_UNLOAD, HALF_FORCE)) return;
    for (int n = 0; n < k->bins; n++) all_contacts += row.count[n];
    start_curve(f, m, "");
    for (int n = 0; n < k->bins; n++) {
        const double p = row.count[n] / all_contacts / (k->edge[n + 1] - k->edge[n]), at = sqrt(k->edge[n] * k->edge[n + 1]);
        if (p > 0 && at > least) line_chart_point(&f->chart, at, p);
    }
}

bool force_distribution(figure *f)
{
    runs r;
    char what[LINE_NAME];
    if (!read_runs(&r, f)) return false;
    f->chart.title = "[MC] Fig. 4: contact forces at 18.4 mm in unloading, cycles 2 to 5";
    legend(f);
    const line_axis share = {"probability density in 1/N", 0, 40, false};
    line_chart_panel(&f->chart, "forces", (line_axis){"force in N", 0, .12, false}, share);
    for (int m = 0; m < MODELS_MC; m++) draw_distribution(f, &r, m, 5e-3);
    line_chart_panel(&f->chart, "forces, logarithmic", (line_axis){"force in N", 1e-3, 1, true},
                     (line_axis){"probability density in 1/N", 1e-2, 1e2, true});
    for (int m = 0; m < MODELS_MC; m++) draw_distribution(f, &r, m, 1e-3);
    for (int m = 0; m < MODELS_MC; m++) {
        run_row half, full;
        if (!run_at(&half, &r.mean[m], RUN_UNLOAD, HALF_FORCE) || !run_at(&full, &r.mean[m], RUN_LOAD, .134)) continue;
        snprintf(what, sizeof what, "%s: top force over the largest", all[m].file);
        tell(f, what, half.value[RUN_TOP] / full.value[RUN_TOP], .5);
        snprintf(what, sizeof what, "%s: mean force [N]", all[m].file);
        tell(f, what, half.value[RUN_MEAN_FORCE], NAN);
    }
    release(&r);
    return true;
}

/* ---- Fig. 5 */

static void draw_coordination(figure *f, const runs *r, int m, double threshold)
{
    for (int p = 0; p < RUN_PHASES; p++) {
        start_curve(f, m, run_phase_name[p]);
        for (int n = 0; n < r->mean[m].rows; n++)
            if (r->mean[m].row[n].phase == (run_phase)p)
                line_chart_point(&f->chart, r->mean[m].row[n].strain,
                                 run_coordination(&r->mean[m], &r->mean[m].row[n], threshold));
    }
}

bool coordination(figure *f)
{
    runs r;
    char what[LINE_NAME];
    const metrics_settings set = {.first = first, .threshold = NAN, .resolution = resolution};
    if (!read_runs(&r, f)) return false;
    f->chart.title = "[MC] Fig. 5: contacts per grain with other grains, cycles 2 to 5";
    legend(f);
    const line_axis strain = {"strain", 0, .14, false}, contacts = {"contacts per grain", 0, 8, false};
    line_chart_panel(&f->chart, "above a threshold", strain, contacts);
    for (int m = 0; m < MODELS_MC; m++) {
        metrics k;
        if (metrics_compare(&k, &r.whole[m], &r.whole[SPHERE], &set) != NULL) continue;
        draw_coordination(f, &r, m, m == SPHERE ? resolution : k.threshold);
    }
    line_chart_panel(&f->chart, "all", strain, contacts);
    for (int m = 0; m < MODELS_MC; m++) {
        run_row least, most;
        draw_coordination(f, &r, m, 0);
        if (!run_at(&least, &r.mean[m], RUN_LOAD, .00536) || !run_at(&most, &r.mean[m], RUN_LOAD, .134)) continue;
        snprintf(what, sizeof what, "%s: contacts per grain at a strain of 0.005", all[m].file);
        tell(f, what, run_coordination(&r.mean[m], &least, 0), NAN);
        snprintf(what, sizeof what, "%s: contacts per grain at a strain of 0.134", all[m].file);
        tell(f, what, run_coordination(&r.mean[m], &most, 0), NAN);
    }
    release(&r);
    return true;
}

/* ---- Fig. 6 */

/* Z phi b f of a row [N m]. */
static double microscopic(const run *r, const run_row *row)
{
    return run_coordination(r, row, 0) * row->value[RUN_FRACTION] * row->value[RUN_BRANCH] * row->value[RUN_MEAN_FORCE];
}

/* Slope of F through the origin, and the farthest that it is off it in units of the largest F. */
static void tell_law(const figure *f, const run *r, const char *name)
{
    char what[LINE_NAME];
    double product = 0, square = 0, off = 0, most = 0;
    for (int n = 0; n < r->rows; n++) {
        const double x = microscopic(r, &r->row[n]), F = r->row[n].value[RUN_TOP];
        product += x * F;
        square += x * x;
        most = fmax(most, F);
    }
    for (int n = 0; n < r->rows; n++)
        off = fmax(off, fabs(r->row[n].value[RUN_TOP] - product / square * microscopic(r, &r->row[n])));
    snprintf(what, sizeof what, "%s: F / (Z phi b f) [1/m]", name);
    tell(f, what, product / square, NAN);
    snprintf(what, sizeof what, "%s: farthest from that / largest F", name);
    tell(f, what, off / most, NAN);
    for (int p = 0; p < RUN_PHASES; p++) {
        run_row row;
        if (!run_at(&row, r, (run_phase)p, HALF_FORCE)) continue;
        snprintf(what, sizeof what, "%s: the same in %sing at a strain of 0.107", name, run_phase_name[p]);
        tell(f, what, row.value[RUN_TOP] / microscopic(r, &row), NAN);
    }
}

bool scaling_law(figure *f)
{
    runs r;
    static const int shown[] = {SPHERE, MC_PAPER, HERTZ};
    if (!read_runs(&r, f)) return false;
    f->chart.title = "[MC] Fig. 6: force on the plate against Z phi b f, cycles 2 to 5";
    f->chart.columns = 3;
    line_chart_legend(&f->chart, "loading", COLOUR_SPHERE, LINE_MARKS);
    line_chart_legend(&f->chart, "unloading", COLOUR_CASE_I, LINE_MARKS);
    for (int s = 0; s < 3; s++) {
        const run *k = &r.mean[shown[s]];
        line_chart_panel(&f->chart, all[shown[s]].name, (line_axis){"Z phi b f in mN m", 0, 8, false},
                         (line_axis){"top force in N", 0, 9, false});
        for (int p = 0; p < RUN_PHASES; p++) {
            line_chart_curve(&f->chart, p == RUN_LOAD ? COLOUR_SPHERE : COLOUR_CASE_I, LINE_MARKS, "%s", run_phase_name[p]);
            for (int n = 0; n < k->rows; n++)
                if (k->row[n].phase == (run_phase)p)
                    line_chart_point(&f->chart, 1e3 * microscopic(k, &k->row[n]), k->row[n].value[RUN_TOP]);
        }
        tell_law(f, k, all[shown[s]].file);
    }
    release(&r);
    return true;
}
