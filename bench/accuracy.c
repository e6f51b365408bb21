/* SPDX-License-Identifier: BSD-2-Clause */
/* accuracy.c - forces of the library's models beside those of exact elasticity and of finite elements. */
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy_chart.h"
#include "analysis.h"
#include "nlcontact.h"
#include "reference_table.h"
#include "surface_error.h"

enum { EXIT_USAGE = 2, ERROR_SIZE = 400, MODELS = 16 };

static const char usage[] =
    "usage: accuracy [options] FILE...\n"
    "\n"
    "Computes the forces on a sphere, mostly between rigid plates, by the library's models and prints how far\n"
    "they are from those in the tables.\n"
    "\n"
    "  --models LIST   names of models, with commas (default: all)\n"
    "  --csv FILE      write all forces\n"
    "  --svg FILE      write a chart of the errors\n"
    "  --packing FILE  print how long the models take there\n"
    "  --cost FILE     write a chart of the errors against these times\n"
    "  --surface FILE  print errors of the displacement beside one contact; hertz_pressure.csv\n"
    "\n"
    "Exit status: 0 success; 1 failure; 2 wrong usage.\n";

static const double eps_limits[] = {.001, .005, .01, .02, .05, .1};
static const double poissons[] = {0, .1, .2, .3, .4, .46, .5};
static const double deformations[] = {.01, .05, .1};
enum { DEFORMATIONS = sizeof deformations / sizeof deformations[0] };
enum { EPS_LIMITS = sizeof eps_limits / sizeof eps_limits[0], POISSONS = sizeof poissons / sizeof poissons[0] };

typedef struct job {
    accuracy_model model[MODELS];
    int models;
    reference_table *table; /* [tables] */
    int tables;
    accuracy_results results;
    int warnings[MODELS]; /* rows */
    const char *csv_path, *svg_path, *cost_path, *packing_path, *surface_path;
    packing p;
    neighbours n;
    FILE *csv;
} job;

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "accuracy: %s%s%s\n", where, *where ? ": " : "", text);
    return EXIT_FAILURE;
}

/* ---- one row by one model */

/* R = E = 1 for the first sphere, the plates are rigid walls.  force [contacts] out. */
static nlc_status solve(const reference_table *t, const reference_row *row, int32_t model, double *force)
{
    const double radius[2] = {1, row->radius_ratio};
    const int32_t material[2] = {0, 2};
    const nlc_material materials[3] = {{1, row->nu}, {INFINITY, 0}, {row->young_ratio, row->other_nu}};
    const int32_t count = t->with_sphere ? 2 : 1;
    int32_t i[REFERENCE_CONTACTS], j[REFERENCE_CONTACTS], rigid[REFERENCE_CONTACTS];
    double overlap[REFERENCE_CONTACTS], nonlocal[REFERENCE_CONTACTS] = {0};
    for (int c = 0; c < t->contacts; c++) {
        i[c] = 0;
        j[c] = t->with_sphere && c == t->sphere ? 1 : count + c;
        rigid[c] = 1;
        overlap[c] = row->eps[t->group[c]];
    }
    nlc_particles particles = {.struct_size = sizeof particles,
                               .count = count,
                               .radius = radius,
                               .material = material,
                               .materials = materials,
                               .material_count = 3,
                               .material_size = sizeof(nlc_material),
                               .wall_material = rigid,
                               .wall_count = t->contacts};
    nlc_options options = {.struct_size = sizeof options, .model = model, .tolerance = 1e-10};
    size_t size = nlc_network_size(&particles, t->contacts, &options);
    void *memory = malloc(size);
    if (!memory) return NLC_ERROR_MEMORY_SIZE;
    nlc_network *network;
    nlc_status status = nlc_network_init(&network, memory, size, &particles, i, j, t->contacts, &options, NULL);
    if (status >= 0) status = nlc_solve(network, force, nonlocal, overlap, &t->normal[0][0], NULL);
    free(memory);
    return status;
}

/* The force of a group is that of its contacts' mean. */
static double mean_force(const reference_table *t, int group, const double *force)
{
    double sum = 0;
    int count = 0;
    for (int c = 0; c < t->contacts; c++) {
        if (t->group[c] != group) continue;
        sum += force[c];
        count++;
    }
    return sum / count;
}

static void write_line(FILE *csv, const accuracy_model *m, const reference_table *t, const reference_row *row, int group,
                       double force, nlc_status status)
{
    fprintf(csv, "%s,%s,%g,%.10g,", m->name, t->name, row->nu, row->eps[0]);
    if (t->groups > 1) fprintf(csv, "%.10g", row->eps[1]);
    fprintf(csv, ",%d,%.8g,%.8g,%.6f,%d\n", group + 1, row->force[group], force, force / row->force[group] - 1, (int)status);
}

static int run_row(job *j, int model, int table, const reference_row *row)
{
    const reference_table *t = &j->table[table];
    double force[REFERENCE_CONTACTS];
    nlc_status status = solve(t, row, j->model[model].number, force);
    if (status < 0) return fail(t->name, nlc_strerror(status));
    if (status > 0) j->warnings[model]++;
    for (int g = 0; g < t->groups; g++) {
        double f = mean_force(t, g, force);
        j->results.point[j->results.count++] = (accuracy_point){model, table, g, row->nu, row->eps[0], f / row->force[g] - 1};
        if (j->csv) write_line(j->csv, &j->model[model], t, row, g, f, status);
    }
    return 0;
}

/* ---- statistics */

typedef struct spread {
    int count;
    double worst, squares;
} spread;

/* Which points: an index or a value, or ANY. */
typedef struct filter {
    int model, table, group;
    double eps_above, eps_to, nu;
} filter;
enum { ANY = -1 };

/* Has the table an error, or a choice of conventions, that is not small beside those of a good model? */
static bool approximate(const reference_table *t)
{
    return t->finite_elements || t->with_sphere;
}

static bool passes(const job *j, const filter *f, const accuracy_point *p)
{
    if (p->model != f->model || p->group != f->group) return false;
    if (f->table != ANY && p->table != f->table) return false;
    if (f->table == ANY && (approximate(&j->table[p->table]) || j->table[p->table].finite_strain)) return false;
    return p->eps > f->eps_above && p->eps <= f->eps_to && (f->nu < 0 || fabs(p->nu - f->nu) < .001);
}

static spread spread_of(const job *j, const filter *f)
{
    spread s = {0};
    for (int k = 0; k < j->results.count; k++) {
        const accuracy_point *p = &j->results.point[k];
        if (!passes(j, f, p)) continue;
        s.count++;
        s.squares += p->error * p->error;
        if (fabs(p->error) > fabs(s.worst)) s.worst = p->error;
    }
    return s;
}

static void print_row(const job *j, const char *label, filter f)
{
    printf("  %-26s", label);
    for (f.model = 0; f.model < j->models; f.model++) {
        spread s = spread_of(j, &f);
        if (s.count)
            printf(" %+9.2f%8.2f", 100 * s.worst, 100 * sqrt(s.squares / s.count));
        else
            printf(" %9s%8s", "-", "-");
    }
    putchar('\n');
}

static void print_group(const job *j, int group)
{
    char label[40];
    printf("\n%-28s", group ? "SECOND CONTACTS" : "FIRST CONTACTS");
    for (int m = 0; m < j->models; m++) printf(" %17s", j->model[m].name);
    printf("\n%-28s", "error of the force in %");
    for (int m = 0; m < j->models; m++) printf(" %9s%8s", "worst", "rms");
    putchar('\n');
    for (int t = 0; t < j->tables; t++)
        if (j->table[t].groups > group) {
            const reference_table *table = &j->table[t];
            snprintf(label, sizeof label, "%.22s%s", table->name,
                     table->finite_strain ? " **"
                     : approximate(table) ? " *"
                                          : "");
            print_row(j, label, (filter){.table = t, .group = group, .eps_above = -1, .eps_to = INFINITY, .nu = ANY});
        }
    filter all = {.table = ANY, .group = group, .eps_above = -1, .eps_to = INFINITY, .nu = ANY};
    print_row(j, "all without *", all);
    for (int k = 0; k < EPS_LIMITS; k++) {
        filter f = all;
        f.eps_above = k ? eps_limits[k - 1] * 1.0001 : -1;
        f.eps_to = eps_limits[k] * 1.0001;
        snprintf(label, sizeof label, "  eps %s %g", k ? "to" : "at most", eps_limits[k]);
        print_row(j, label, f);
    }
    for (int k = 0; k < POISSONS; k++) {
        filter f = all;
        f.nu = poissons[k];
        snprintf(label, sizeof label, "  nu %g", poissons[k]);
        print_row(j, label, f);
    }
}

/* The same tables with the limit of the overlap in the columns. */
static void print_deformations(const job *j)
{
    char label[40];
    printf("\n%-28s", "WORST ERROR in %");
    for (int m = 0; m < j->models; m++) printf(" %17s", j->model[m].name);
    printf("\n%-28s", "up to an overlap / R of");
    for (int m = 0; m < j->models; m++)
        for (int k = 0; k < DEFORMATIONS; k++) printf("%6g", deformations[k]);
    putchar('\n');
    for (int row = 0; row < REFERENCE_GROUPS * j->tables; row++) {
        filter f = {.table = row % j->tables, .group = row / j->tables, .eps_above = -1, .nu = ANY};
        if (f.group >= j->table[f.table].groups) continue;
        snprintf(label, sizeof label, "%.22s%s", j->table[f.table].name, f.group ? ", 2nd" : "");
        printf("  %-26s", label);
        for (f.model = 0; f.model < j->models; f.model++)
            for (int k = 0; k < DEFORMATIONS; k++) {
                f.eps_to = deformations[k] * 1.0001;
                spread s = spread_of(j, &f);
                if (s.count)
                    printf("%6.1f", 100 * fabs(s.worst));
                else
                    printf("%6s", "-");
            }
        putchar('\n');
    }
}

static void print_times(const job *j)
{
    printf("\nPRICE: %s, %lld spheres, %lld contacts and candidates\n%-28s", j->p.name, (long long)j->p.count,
           (long long)j->n.count, "");
    for (int m = 0; m < j->models; m++) printf(" %17s", j->model[m].name);
    printf("\n  %-26s", "nlc_sweep, ns a contact");
    for (int m = 0; m < j->models; m++) printf(" %17.0f", j->model[m].sweep_time);
    printf("\n  %-26s", "nlc_solve to 1e-8");
    for (int m = 0; m < j->models; m++) printf(" %17.0f", j->model[m].solve_time);
    printf("\n  %-26s", "  sweeps");
    for (int m = 0; m < j->models; m++) printf(" %17lld", (long long)j->model[m].sweeps);
    putchar('\n');
}

static void print_all(const job *j)
{
    printf("Forces of one sphere beside references; eps: overlap / R of the first contacts.\n");
    for (int g = 0; g < REFERENCE_GROUPS; g++) print_group(j, g);
    print_deformations(j);
    if (j->packing_path) print_times(j);
    puts("\n*  finite elements, with an error of their own, or a second sphere, where linear elasticity leaves a choice\n"
         "** finite strain, which is not these models' theory");
    for (int m = 0; m < j->models; m++)
        if (j->warnings[m]) printf("%s: %d rows with a warning\n", j->model[m].name, j->warnings[m]);
}

/* ---- command line */

static int complain(const char *text, const char *culprit)
{
    fprintf(stderr, "accuracy: %s: %s (accuracy --help explains)\n", culprit, text);
    return EXIT_USAGE;
}

static void add_model(job *j, int32_t number)
{
    nlc_model_record m = {.struct_size = sizeof m};
    if (j->models < MODELS && nlc_model_info(number, &m, NULL) == NLC_OK)
        j->model[j->models++] = (accuracy_model){.number = number, .name = m.name};
}

static int choose_models(job *j, const char *list)
{
    j->models = 0;
    for (const char *s = list; s; s = strchr(s, ',') ? strchr(s, ',') + 1 : NULL) {
        char name[32];
        const int length = (int)strcspn(s, ",");
        snprintf(name, sizeof name, "%.*s", length, s);
        if (nlc_model_find(name) < 0) return complain("not a list of models", list);
        add_model(j, nlc_model_find(name));
    }
    return 0;
}

/* Hertz first, with which one compares. */
static void choose_all_models(job *j)
{
    add_model(j, NLC_MODEL_HERTZ);
    for (int32_t k = 0; k < nlc_model_count(); k++)
        if (k != NLC_MODEL_HERTZ) add_model(j, k);
}

/* Returns the index of the first file, or 0 and the exit status in *status. */
static int parse_arguments(job *j, int argc, char **argv, int *status)
{
    int k = 1;
    *status = 0;
    choose_all_models(j);
    for (; k < argc && argv[k][0] == '-'; k += 2) {
        if (strcmp(argv[k], "--help") == 0) {
            fputs(usage, stdout);
            return 0;
        }
        const char *value = k + 1 < argc ? argv[k + 1] : NULL;
        *status = !value ? complain("an option without a value", argv[k]) : 0;
        if (*status) return 0;
        if (strcmp(argv[k], "--csv") == 0)
            j->csv_path = value;
        else if (strcmp(argv[k], "--svg") == 0)
            j->svg_path = value;
        else if (strcmp(argv[k], "--packing") == 0)
            j->packing_path = value;
        else if (strcmp(argv[k], "--cost") == 0)
            j->cost_path = value;
        else if (strcmp(argv[k], "--surface") == 0)
            j->surface_path = value;
        else
            *status = strcmp(argv[k], "--models") == 0 ? choose_models(j, value) : complain("no such option", argv[k]);
        if (*status) return 0;
    }
    if (j->cost_path && !j->packing_path) *status = complain("times need a --packing", "--cost");
    if (*status) return 0;
    if (k < argc) return k;
    fputs(usage, stderr);
    *status = EXIT_USAGE;
    return 0;
}

/* ---- work */

static int read_tables(job *j, char **path, int count)
{
    char error[ERROR_SIZE];
    int points = 0;
    j->table = calloc((size_t)count, sizeof *j->table);
    if (!j->table) return fail("", "out of memory");
    for (; j->tables < count; j->tables++) {
        reference_table *t = &j->table[j->tables];
        if (reference_table_read(t, path[j->tables], error, sizeof error)) {
            reference_table_free(t);
            return fail("", error);
        }
        points += t->count * t->groups;
    }
    j->results.point = calloc((size_t)points * (size_t)j->models + 1, sizeof *j->results.point);
    return j->results.point ? 0 : fail("", "out of memory");
}

static int run_rows(job *j)
{
    for (int m = 0; m < j->models; m++)
        for (int t = 0; t < j->tables; t++)
            for (int r = 0; r < j->table[t].count; r++)
                if (run_row(j, m, t, &j->table[t].row[r])) return EXIT_FAILURE;
    return 0;
}

/* The mean of all errors at exact tables. */
static void find_means(job *j)
{
    for (int m = 0; m < j->models; m++) {
        double squares = 0;
        int count = 0;
        for (int g = 0; g < REFERENCE_GROUPS; g++) {
            filter f = {.model = m, .table = ANY, .group = g, .eps_above = -1, .eps_to = INFINITY, .nu = ANY};
            spread s = spread_of(j, &f);
            squares += s.squares;
            count += s.count;
        }
        j->model[m].rms = count ? sqrt(squares / count) : 0;
    }
}

static int find_times(job *j)
{
    char error[PACKING_ERROR_SIZE];
    if (!j->packing_path) return 0;
    if (packing_read(&j->p, j->packing_path, true, error, sizeof error)) return fail("", error);
    if (neighbours_find(&j->n, &j->p, NEIGHBOURS_REACH, error, sizeof error)) return fail(j->packing_path, error);
    const double contacts = fmax(1, (double)j->n.count);
    for (int m = 0; m < j->models; m++) {
        const nlc_options options = {.struct_size = sizeof options};
        analysis a;
        const int status = analysis_run(&a, j->model[m].number, &options, &j->p, &j->n, error, sizeof error);
        j->model[m].sweep_time = 1e9 * a.sweep_time / contacts;
        j->model[m].solve_time = 1e9 * a.solve_time / contacts;
        j->model[m].sweeps = a.info.sweeps;
        analysis_free(&a);
        if (status) return fail(j->packing_path, error);
    }
    return 0;
}

static int close_file(FILE *f, const char *path)
{
    bool bad = ferror(f) != 0;
    if (fclose(f) != 0 || bad) return fail(path, "cannot be written");
    printf("%s written\n", path);
    return 0;
}

static int write_charts(job *j)
{
    find_means(j);
    j->results.model = j->model;
    j->results.models = j->models;
    j->results.table = j->table;
    j->results.tables = j->tables;
    for (int k = 0; k < 2; k++) {
        const char *path = k ? j->cost_path : j->svg_path;
        FILE *svg = path ? fopen(path, "w") : NULL;
        if (path && !svg) return fail(path, strerror(errno));
        if (!svg) continue;
        if (k)
            accuracy_chart_write_cost(svg, &j->results, j->p.name);
        else
            accuracy_chart_write_svg(svg, &j->results);
        if (close_file(svg, path)) return EXIT_FAILURE;
    }
    return 0;
}

static int run(job *j)
{
    if (j->csv_path) {
        j->csv = fopen(j->csv_path, "w");
        if (!j->csv) return fail(j->csv_path, strerror(errno));
        fputs("model,table,nu,eps_1,eps_2,group,reference,force,error,status\n", j->csv);
    }
    int status = run_rows(j);
    if (!status) status = find_times(j);
    if (!status) print_all(j);
    if (!status && j->surface_path && surface_error_print(j->surface_path)) status = EXIT_FAILURE;
    if (j->csv && close_file(j->csv, j->csv_path)) status = EXIT_FAILURE;
    if (!status) status = write_charts(j);
    return status;
}

int main(int argc, char **argv)
{
    job j = {.models = 0};
    int status, first = parse_arguments(&j, argc, argv, &status);
    if (first == 0) return status;
    status = read_tables(&j, argv + first, argc - first);
    if (!status) status = run(&j);
    for (int t = 0; t < j.tables; t++) reference_table_free(&j.table[t]);
    free(j.table);
    free(j.results.point);
    neighbours_free(&j.n);
    packing_free(&j.p);
    if (fflush(stdout) != 0 || ferror(stdout)) return fail("standard output", "cannot be written");
    return status;
}
