/* SPDX-License-Identifier: BSD-2-Clause */
/* run.c - reads and writes runs, takes means of them. */
#include "run.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 8192, COLUMNS = RUN_BINS + 32, DECADE = 10, DECADES = 5 };
#define LOWEST 1e-4     /* N */
#define SAME_LEVEL 1e-9 /* strains nearer than this are one */

const char *const run_value_name[RUN_VALUES] = {"top", "f", "b", "phi", "saturated", "unbalanced"};
const char *const run_phase_name[RUN_PHASES] = {"load", "unload"};

void run_init(run *r, double grains)
{
    memset(r, 0, sizeof *r);
    r->grains = grains;
    for (r->bins = 0; r->bins <= DECADE * DECADES; r->bins++) r->edge[r->bins + 1] = LOWEST * pow(10, (double)r->bins / DECADE);
}

bool run_add(run *r, const run_row *row)
{
    if ((r->rows & (r->rows - 1)) == 0) { /* room for powers of two */
        run_row *more = realloc(r->row, (size_t)(r->rows ? 2 * r->rows : 1) * sizeof *more);
        if (!more) return false;
        r->row = more;
    }
    r->row[r->rows++] = *row;
    return true;
}

void run_free(run *r)
{
    free(r->row);
    r->row = NULL;
    r->rows = 0;
}

int run_bin(const run *r, double force)
{
    for (int k = 0; k < r->bins; k++)
        if (force <= r->edge[k + 1]) return k;
    return -1;
}

/* ---- writing */

void run_write(FILE *out, const run *r, const char *comment)
{
    if (comment) fprintf(out, "# %s\n", comment);
    fprintf(out, "# grains: %g\ncycle,phase,strain", r->grains);
    for (int v = 0; v < RUN_VALUES; v++) fprintf(out, ",%s", run_value_name[v]);
    for (int k = 0; k < r->bins; k++) fprintf(out, ",%.6g", r->edge[k + 1]);
    fputc('\n', out);
    for (int n = 0; n < r->rows; n++) {
        const run_row *row = &r->row[n];
        fprintf(out, "%d,%s,%.6g", row->cycle, run_phase_name[row->phase], row->strain);
        for (int v = 0; v < RUN_VALUES; v++) fprintf(out, ",%.5g", row->value[v]);
        for (int k = 0; k < r->bins; k++) {
            fputc(',', out); /* an empty field is 0 */
            if (row->count[k] > 0) fprintf(out, "%.6g", row->count[k]);
        }
        fputc('\n', out);
    }
}

/* ---- reading: every function returns NULL or what is wrong */

enum { IGNORED = -1, CYCLE = -2, PHASE = -3, STRAIN = -4, VALUE = -100 }; /* VALUE - v: value v; >= 0: bin */

typedef struct reader {
    run *r;
    int columns, kind[COLUMNS];
    bool named;
} reader;

/* Splits a line at commas, in place. */
static int split(char *line, char **field)
{
    int count = 0;
    line[strcspn(line, "\r\n")] = '\0';
    for (char *s = line; s; count++) {
        char *comma = strchr(s, ',');
        if (comma) *comma = '\0';
        if (count < COLUMNS) field[count] = s;
        s = comma ? comma + 1 : NULL;
    }
    return count;
}

static bool to_number(const char *text, double *x)
{
    char *end;
    *x = strtod(text, &end);
    return end != text && end[strspn(end, " \t")] == '\0' && isfinite(*x);
}

static int kind_of(const char *name)
{
    if (strcmp(name, "cycle") == 0) return CYCLE;
    if (strcmp(name, "phase") == 0) return PHASE;
    if (strcmp(name, "strain") == 0) return STRAIN;
    for (int v = 0; v < RUN_VALUES; v++)
        if (strcmp(name, run_value_name[v]) == 0) return VALUE - v;
    return IGNORED;
}

static bool has(const reader *d, int kind)
{
    for (int k = 0; k < d->columns; k++)
        if (d->kind[k] == kind) return true;
    return false;
}

static const char *read_names(reader *d, char *line)
{
    char *name[COLUMNS];
    run *r = d->r;
    const int columns = split(line, name);
    if (columns > COLUMNS) return "too many columns";
    for (int k = 0; k < columns; k++, d->columns++) {
        double edge;
        d->kind[k] = kind_of(name[k]);
        if (d->kind[k] != IGNORED && has(d, d->kind[k])) return "a column is there twice";
        if (!to_number(name[k], &edge)) continue;
        if (edge <= r->edge[r->bins]) return "the bins' upper edges are not positive and increasing";
        if (r->bins == RUN_BINS) return "too many bins";
        d->kind[k] = r->bins++;
        r->edge[r->bins] = edge;
    }
    if (!has(d, PHASE)) return "no column 'phase'";
    if (!has(d, STRAIN)) return "no column 'strain'";
    if (!has(d, VALUE - RUN_TOP)) return "no column 'top'";
    if (r->bins == 0) return "no column with a number for its name: no bins of forces";
    d->named = true;
    return NULL;
}

static const char *read_field(run_row *row, int kind, const char *text)
{
    double x = 0;
    if (kind == IGNORED) return NULL;
    if (kind == PHASE) {
        for (row->phase = 0; row->phase < RUN_PHASES; row->phase++)
            if (strcmp(text, run_phase_name[row->phase]) == 0) return NULL;
        return "a phase that is neither load nor unload";
    }
    if (kind <= VALUE + 0 && kind != VALUE - RUN_TOP && (strcmp(text, "nan") == 0 || *text == '\0')) return NULL;
    if (!(kind >= 0 && *text == '\0') && !to_number(text, &x)) return "not a number";
    if (kind >= 0 && x < 0) return "a negative number of contacts";
    if (kind >= 0)
        row->count[kind] = x;
    else if (kind == STRAIN)
        row->strain = x;
    else if (kind != CYCLE)
        row->value[VALUE - kind] = x;
    else if (x < 0 || x > 1e6 || x != floor(x))
        return "not a number of a cycle";
    else
        row->cycle = (int)x;
    return NULL;
}

static const char *read_row(reader *d, char *line)
{
    char *field[COLUMNS];
    run_row row = {0};
    if (split(line, field) != d->columns) return "not as many fields as columns";
    for (int v = 0; v < RUN_VALUES; v++) row.value[v] = NAN;
    for (int k = 0; k < d->columns; k++) {
        const char *wrong = read_field(&row, d->kind[k], field[k]);
        if (wrong) return wrong;
    }
    return run_add(d->r, &row) ? NULL : "out of memory";
}

static const char *read_lines(reader *d, FILE *file, int *number)
{
    char line[LINE];
    while (fgets(line, sizeof line, file)) {
        const char *wrong = NULL;
        ++*number;
        if (!strchr(line, '\n') && !feof(file)) return "the line is too long";
        if (strncmp(line, "# grains:", 9) == 0) {
            if (sscanf(line, "# grains: %lf", &d->r->grains) != 1 || !(d->r->grains > 0 && d->r->grains < 1e12))
                return "not a number of grains";
        } else if (line[0] != '#' && line[strspn(line, " \t\r\n")] != '\0') {
            wrong = d->named ? read_row(d, line) : read_names(d, line);
        }
        if (wrong) return wrong;
    }
    if (ferror(file)) return "cannot be read";
    if (d->r->grains == 0) return "no line '# grains: COUNT'";
    return d->r->rows > 0 ? NULL : "no rows";
}

int run_read(run *r, const char *path, char *error, size_t error_size)
{
    reader d = {.r = r};
    int number = 0;
    memset(r, 0, sizeof *r);
    FILE *file = fopen(path, "r");
    if (!file) {
        snprintf(error, error_size, "%s: %s", path, strerror(errno));
        return -1;
    }
    const char *wrong = read_lines(&d, file, &number);
    fclose(file);
    if (wrong) snprintf(error, error_size, "%s:%d: %s", path, number, wrong);
    return wrong ? -1 : 0;
}

/* ---- means */

/* a takes a share of b. */
static void blend(const run *r, run_row *a, const run_row *b, double share)
{
    for (int v = 0; v < RUN_VALUES; v++) a->value[v] += share * (b->value[v] - a->value[v]);
    for (int k = 0; k < r->bins; k++) a->count[k] += share * (b->count[k] - a->count[k]);
}

static int by_phase_and_strain(const void *a, const void *b)
{
    const run_row *p = a, *q = b;
    return p->phase != q->phase ? (int)p->phase - (int)q->phase : (p->strain > q->strain) - (p->strain < q->strain);
}

bool run_mean(run *mean, const run *r, int first)
{
    *mean = *r;
    mean->rows = 0;
    mean->row = NULL;
    for (int n = 0; n < r->rows; n++) {
        run_row row = r->row[n];
        int m = 0;
        if (row.cycle > 0 && row.cycle < first) continue;
        row.cycle = 1; /* here: of how many it is the mean */
        while (m < mean->rows && (mean->row[m].phase != row.phase || fabs(mean->row[m].strain - row.strain) > SAME_LEVEL)) m++;
        if (m < mean->rows)
            blend(r, &mean->row[m], &row, 1. / ++mean->row[m].cycle);
        else if (!run_add(mean, &row))
            return false;
    }
    if (mean->rows > 0) qsort(mean->row, (size_t)mean->rows, sizeof *mean->row, by_phase_and_strain);
    return mean->rows > 0;
}

bool run_at(run_row *row, const run *mean, run_phase phase, double strain)
{
    for (int n = 0; n < mean->rows; n++) {
        const run_row *a = &mean->row[n];
        if (a->phase != phase || a->strain > strain + SAME_LEVEL) continue;
        *row = *a;
        row->strain = strain;
        if (strain - a->strain <= SAME_LEVEL) return true;
        if (n + 1 == mean->rows || a[1].phase != phase || a[1].strain < strain - SAME_LEVEL) continue;
        blend(mean, row, a + 1, (strain - a->strain) / (a[1].strain - a->strain));
        return true;
    }
    return false;
}

double run_coordination(const run *r, const run_row *row, double threshold)
{
    double contacts = 0;
    for (int k = 0; k < r->bins; k++) {
        const double low = r->edge[k], high = r->edge[k + 1];
        contacts += row->count[k] * fmin(fmax((high - threshold) / (high - low), 0), 1);
    }
    return 2 * contacts / r->grains;
}
