/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * table.c - one list of rows, printed in one of two forms.
 *
 * A section chooses a unit by the largest value that its rows will have, so that they can be compared at a glance.
 */
#include "table.h"

#include <math.h>
#include <string.h>

enum { LABEL_WIDTH = 45, COLUMN_WIDTH = 17 };

/* How a person reads a number. */
typedef enum form { FORM_COUNT, FORM_TWO_DECIMALS, FORM_THREE_DECIMALS, FORM_POWER, FORM_UNIT, FORM_STATUS } form;

typedef struct table {
    FILE *out;
    const table_input *in;
    bool csv;
    double scale; /* of FORM_UNIT in this section */
    int decimals;
} table;

/* What a quantity is in the results of one model. */
typedef double value_of(const table_input *in, const analysis *a, int which);

double table_prefix(double value, const char **prefix)
{
    static const struct {
        double scale;
        const char *prefix;
    } prefixes[] = {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}, {1e-12, "p"}};
    int k = 0, last = sizeof prefixes / sizeof prefixes[0] - 1;
    while (k < last && !(fabs(value) >= 0.9999 * prefixes[k].scale)) k++;
    if (!(fabs(value) > 0)) k = 3;
    *prefix = prefixes[k].prefix;
    return prefixes[k].scale;
}

/* A section whose rows are of the size of largest; unit NULL: its rows have units of their own or none. */
static void section(table *t, const char *title, const char *unit, double largest)
{
    const char *prefix;
    if (unit) {
        t->scale = table_prefix(largest, &prefix);
        double digits = largest > 0 ? floor(log10(largest / t->scale)) : 0;
        t->decimals = digits < 0 ? 4 : digits > 3 ? 0 : 3 - (int)digits;
    }
    if (t->csv) return;
    fprintf(t->out, "\n%s", title);
    if (unit) fprintf(t->out, " [%s%s]", prefix, unit);
    fputc('\n', t->out);
}

static void print_status(FILE *out, nlc_status status)
{
    const char *text = "NO";
    if (status == NLC_OK) text = "yes";
    if (status == NLC_WARNING_ROUNDING) text = "to rounding";
    fprintf(out, "%*s", COLUMN_WIDTH, text);
}

static void print_value(const table *t, form f, double value)
{
    static const int decimals[] = {[FORM_TWO_DECIMALS] = 2, [FORM_THREE_DECIMALS] = 3};
    switch (f) {
    case FORM_COUNT:
        fprintf(t->out, "%*.0f", COLUMN_WIDTH, value);
        break;
    case FORM_TWO_DECIMALS:
    case FORM_THREE_DECIMALS:
        fprintf(t->out, "%*.*f", COLUMN_WIDTH, decimals[f], value);
        break;
    case FORM_POWER:
        fprintf(t->out, "%*.1e", COLUMN_WIDTH, value);
        break;
    case FORM_UNIT:
        value /= t->scale;
        if (fabs(value) < 0.5 * pow(10, -t->decimals)) value = 0; /* not -0.0 */
        fprintf(t->out, "%*.*f", COLUMN_WIDTH, t->decimals, value);
        break;
    case FORM_STATUS:
        print_status(t->out, (nlc_status)value);
        break;
    }
}

static void row(const table *t, const char *key, const char *unit, const char *label, form f, value_of *value, int which)
{
    if (t->csv)
        fprintf(t->out, "%s,%s", key, unit);
    else
        fprintf(t->out, "  %-*s", LABEL_WIDTH - 2, label);
    for (int m = 0; m < t->in->count; m++) {
        double v = value(t->in, &t->in->results[m], which);
        if (t->csv)
            fprintf(t->out, ",%.17g", v);
        else
            print_value(t, f, v);
    }
    fputc('\n', t->out);
}

/* ---- what the rows show */

enum { PARTICLES, WALLS, TOUCHING_PAIRS, TOUCHING_WALLS, CANDIDATES, VOLUME, REACH };

static double value_input(const table_input *in, const analysis *a, int which)
{
    (void)a;
    int64_t pairs = 0, walls = 0;
    for (int64_t c = 0; c < in->n->count; c++) {
        pairs += c < in->n->pair_count && in->n->overlap[c] > 0;
        walls += c >= in->n->pair_count && in->n->overlap[c] > 0;
    }
    switch (which) {
    case PARTICLES:
        return (double)in->p->count;
    case WALLS:
        return (double)in->p->wall_count;
    case TOUCHING_PAIRS:
        return (double)pairs;
    case TOUCHING_WALLS:
        return (double)walls;
    case CANDIDATES:
        return (double)(in->n->count - pairs - walls);
    case VOLUME:
        return packing_volume(in->p);
    default:
        return in->reach;
    }
}

enum { PAIRS_WITH_FORCE, WALLS_WITH_FORCE, CREATED, LOST, COORDINATION, COORDINATION_WALLS };

static double value_contacts(const table_input *in, const analysis *a, int which)
{
    double n = (double)in->p->count;
    switch (which) {
    case PAIRS_WITH_FORCE:
        return (double)a->pairs;
    case WALLS_WITH_FORCE:
        return (double)a->walls;
    case CREATED:
        return (double)a->created;
    case LOST:
        return (double)a->lost;
    case COORDINATION:
        return 2 * (double)a->pairs / n;
    default:
        return (2 * (double)a->pairs + (double)a->walls) / n;
    }
}

enum { MEAN, LARGEST, TOTAL, TOTAL_OVER_HERTZ, IMBALANCE };

static double value_forces(const table_input *in, const analysis *a, int which)
{
    switch (which) {
    case MEAN:
        return a->mean;
    case LARGEST:
        return a->largest;
    case TOTAL:
        return a->total;
    case TOTAL_OVER_HERTZ:
        return in->results[0].total > 0 ? a->total / in->results[0].total : 1;
    default:
        return a->imbalance;
    }
}

static double value_wall(const table_input *in, const analysis *a, int which)
{
    (void)in;
    return a->wall_force[which];
}

static double value_stress(const table_input *in, const analysis *a, int which)
{
    (void)in;
    if (which == 9) return (a->stress[0][0] + a->stress[1][1] + a->stress[2][2]) / 3;
    return a->stress[which / 3][which % 3];
}

enum { STATUS, SWEEPS, RESIDUAL, SOLVE_TIME, SWEEP_TIME, BUILD_TIME, REPETITIONS };

static double value_solution(const table_input *in, const analysis *a, int which)
{
    double contacts = fmax(1, (double)in->n->count);
    switch (which) {
    case STATUS:
        return a->status;
    case SWEEPS:
        return (double)a->info.sweeps;
    case RESIDUAL:
        return a->info.residual;
    case SOLVE_TIME:
        return 1e9 * a->solve_time / contacts;
    case SWEEP_TIME:
        return 1e9 * a->sweep_time / contacts;
    case BUILD_TIME:
        return 1e3 * a->build_time;
    default:
        return a->repetitions;
    }
}

/* ---- the sections */

static double largest_of(const table_input *in, value_of *value, int first, int last)
{
    double largest = 0;
    for (int m = 0; m < in->count; m++)
        for (int k = first; k <= last; k++) largest = fmax(largest, fabs(value(in, &in->results[m], k)));
    return largest;
}

static void print_head(const table_input *in, FILE *out)
{
    const packing *p = in->p;
    const char *prefix;
    double edge[3], scale;
    for (int d = 0; d < 3; d++) edge[d] = p->high[d] - p->low[d];
    scale = table_prefix(fmax(edge[0], fmax(edge[1], edge[2])), &prefix);
    int periodic = p->periodic[0] + p->periodic[1] + p->periodic[2];
    fprintf(out, "%s: %lld spheres in a box of %.4g x %.4g x %.4g %sm, ", p->name, (long long)p->count, edge[0] / scale,
            edge[1] / scale, edge[2] / scale, prefix);
    if (periodic > 0)
        fprintf(out, "periodic along %s%s%s", p->periodic[0] ? "x" : "", p->periodic[1] ? "y" : "", p->periodic[2] ? "z" : "");
    if (periodic > 0 && p->wall_count > 0) fputs(", ", out);
    if (periodic == 0 || p->wall_count > 0) fprintf(out, "%lld walls", (long long)p->wall_count);
    fprintf(out, "\nundeformed: %.0f pairs and %.0f wall contacts touch, %.0f candidates with gaps below %g R\n\n",
            value_input(in, NULL, TOUCHING_PAIRS), value_input(in, NULL, TOUCHING_WALLS), value_input(in, NULL, CANDIDATES),
            in->reach);
    fprintf(out, "%-*s", LABEL_WIDTH, "");
    for (int m = 0; m < in->count; m++) fprintf(out, "%*s", COLUMN_WIDTH, in->results[m].model);
    fputc('\n', out);
}

static void print_csv_head(const table *t)
{
    fputs("quantity,unit", t->out);
    for (int m = 0; m < t->in->count; m++) fprintf(t->out, ",%s", t->in->results[m].model);
    fputc('\n', t->out);
    row(t, "particles", "1", "", FORM_COUNT, value_input, PARTICLES);
    row(t, "walls", "1", "", FORM_COUNT, value_input, WALLS);
    row(t, "touching_pairs", "1", "", FORM_COUNT, value_input, TOUCHING_PAIRS);
    row(t, "touching_wall_contacts", "1", "", FORM_COUNT, value_input, TOUCHING_WALLS);
    row(t, "candidates", "1", "", FORM_COUNT, value_input, CANDIDATES);
    row(t, "box_volume", "m^3", "", FORM_POWER, value_input, VOLUME);
    row(t, "reach", "1", "", FORM_TWO_DECIMALS, value_input, REACH);
}

static void print_contacts(table *t)
{
    section(t, "contacts with a force", NULL, 0);
    row(t, "pairs", "1", "between spheres", FORM_COUNT, value_contacts, PAIRS_WITH_FORCE);
    row(t, "wall_contacts", "1", "at walls", FORM_COUNT, value_contacts, WALLS_WITH_FORCE);
    row(t, "created", "1", "created by deformation (gap, yet a force)", FORM_COUNT, value_contacts, CREATED);
    row(t, "lost", "1", "lost by deformation (overlap, yet none)", FORM_COUNT, value_contacts, LOST);
    row(t, "coordination", "1", "coordination, 2 pairs / N", FORM_TWO_DECIMALS, value_contacts, COORDINATION);
    if (t->csv || t->in->p->wall_count > 0)
        row(t, "coordination_with_walls", "1", "coordination, (2 pairs + at walls) / N", FORM_TWO_DECIMALS, value_contacts,
            COORDINATION_WALLS);
}

static void print_forces(table *t)
{
    section(t, "contact force", "N", largest_of(t->in, value_forces, LARGEST, LARGEST));
    row(t, "mean_force", "N", "mean of the contacts with a force", FORM_UNIT, value_forces, MEAN);
    row(t, "largest_force", "N", "largest", FORM_UNIT, value_forces, LARGEST);
    row(t, "mean_resultant", "N", "mean resultant on a sphere (0: equilibrium)", FORM_UNIT, value_forces, IMBALANCE);
    section(t, "total force, sum over all contacts, walls too", "N", largest_of(t->in, value_forces, TOTAL, TOTAL));
    row(t, "total_force", "N", "total", FORM_UNIT, value_forces, TOTAL);
    row(t, "total_over_hertz", "1", "total / Hertz", FORM_THREE_DECIMALS, value_forces, TOTAL_OVER_HERTZ);
}

static void print_walls(table *t)
{
    int walls = (int)t->in->p->wall_count;
    if (walls == 0) return;
    section(t, "force on each wall, along its outward normal", "N", largest_of(t->in, value_wall, 0, walls - 1));
    for (int w = 0; w < walls; w++) {
        const double *n = t->in->p->walls[w].normal;
        char key[40], label[120];
        snprintf(key, sizeof key, "wall_%d_force", w + 1);
        snprintf(label, sizeof label, "wall %d, outward (%.3g, %.3g, %.3g)", w + 1, 0 - n[0], 0 - n[1], 0 - n[2]);
        row(t, key, "N", label, FORM_UNIT, value_wall, w);
    }
}

static void print_stress(table *t)
{
    static const int order[] = {0, 4, 8, 1, 2, 5};
    section(t, "stress (1/V) sum b f, compression > 0", "Pa", largest_of(t->in, value_stress, 0, 9));
    for (int k = 0; k < 6; k++) {
        const char label[] = {"xyz"[order[k] / 3], "xyz"[order[k] % 3], '\0'};
        char key[16];
        snprintf(key, sizeof key, "stress_%s", label);
        row(t, key, "Pa", label, FORM_UNIT, value_stress, order[k]);
    }
    row(t, "pressure", "Pa", "pressure, (xx + yy + zz) / 3", FORM_UNIT, value_stress, 9);
}

static void print_solution(table *t)
{
    section(t, "solution", NULL, 0);
    row(t, "status", "1", "converged", FORM_STATUS, value_solution, STATUS);
    row(t, "sweeps", "1", "sweeps from zero displacement", FORM_COUNT, value_solution, SWEEPS);
    row(t, "residual", "1", "residual", FORM_POWER, value_solution, RESIDUAL);
    row(t, "solve_time_per_contact", "ns", "median time per contact and solve [ns]", FORM_COUNT, value_solution, SOLVE_TIME);
    row(t, "sweep_time_per_contact", "ns", "the same of one sweep [ns]", FORM_COUNT, value_solution, SWEEP_TIME);
    row(t, "build_time", "ms", "median time to build the network [ms]", FORM_THREE_DECIMALS, value_solution, BUILD_TIME);
    row(t, "repetitions", "1", "repetitions", FORM_COUNT, value_solution, REPETITIONS);
}

void table_print(FILE *out, const table_input *in, bool csv)
{
    table t = {.out = out, .in = in, .csv = csv, .scale = 1};
    if (csv)
        print_csv_head(&t);
    else
        print_head(in, out);
    print_contacts(&t);
    print_forces(&t);
    print_walls(&t);
    print_stress(&t);
    print_solution(&t);
}
