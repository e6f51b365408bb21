/* SPDX-License-Identifier: BSD-2-Clause */
/* energy.c - a packing that vibrates without damping: what becomes of its energy, by how its forces are found. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "line_chart.h"
#include "vibration.h"

enum { SAMPLES = 1000, TENTH = SAMPLES / 10, BINS = 100, EXIT_USAGE = 2 };

static const char usage[] =
    "usage: energy [options] FILE\n"
    "\n"
    "  --model NAME     gonzalez-cuitino, sphere, point-force\n"
    "  --steps N        a multiple of 1000 (default: 100000)\n"
    "  --step X         time step over the largest stable one (default: 0.025)\n"
    "  --tolerance T    of the forces (default: 1e-10)\n"
    "  --kick X         energy of the vibration over that of the packing at rest (default: 1e-3)\n"
    "  --study          how the first kind of forces depends on time step and tolerance, in the same time\n"
    "  --csv FILE, --svg FILE\n";

typedef struct arguments {
    const char *file, *csv, *svg;
    int32_t model;
    int64_t steps;
    double step, tolerance, kick;
    bool study;
} arguments;

typedef struct method {
    const char *label, *colour;
    vibration_forces kind;
} method;

static const method methods[] = {{"solved with turning", "#1c6fb5", VIBRATION_TURNING},
                                 {"solved along normals", "#e58a0c", VIBRATION_CONVERGED},
                                 {"one lagged sweep", "#c0392b", VIBRATION_LAGGED},
                                 {"Hertz", "#888888", VIBRATION_HERTZ}};
enum { METHODS = sizeof methods / sizeof methods[0] };

/* Energies of the samples over that of the vibration; the first one is that of the start. */
typedef struct result {
    int samples;
    double kinetic[SAMPLES + 1], change[SAMPLES + 1], time[SAMPLES + 1];
    double seconds, sweeps;
} result;

static double mean(const double *a, int count)
{
    double sum = 0;
    for (int k = 0; k < count; k++) sum += a[k];
    return sum / count;
}

static double largest(const result *r)
{
    double most = 0;
    for (int k = 0; k <= r->samples; k++) most = fmax(most, fabs(r->change[k]));
    return most;
}

/* Mean of the last tenth less that of the first: what the bounded waves of the integrator average out of. */
static double drift(const result *r)
{
    return mean(r->change + r->samples + 1 - TENTH, TENTH) - mean(r->change + 1, TENTH);
}

/* From the state at rest; stops where a step fails or the energy has grown tenfold. */
static int run(result *r, vibration *s, const double *rest, const arguments *a, vibration_forces kind, int64_t steps, double dt)
{
    double kinetic, elastic, start = 0, kick = 0;
    *r = (result){.samples = -1};
    vibration_restore(s, rest);
    if (vibration_use(s, kind, a->model, a->tolerance) || vibration_energy(s, &kinetic, &elastic)) return -1;
    vibration_kick(s, kick = a->kick * elastic);
    start = elastic + kick;
    const clock_t begin = clock();
    for (int64_t k = 0; k <= steps; k++) {
        if (k > 0 && vibration_step(s, dt)) break;
        if (k % (steps / SAMPLES)) continue;
        if (vibration_energy(s, &kinetic, &elastic)) break;
        const int m = ++r->samples;
        r->time[m] = (double)k * dt;
        r->kinetic[m] = kinetic / kick;
        r->change[m] = (kinetic + elastic - start) / kick;
        if (!(fabs(r->change[m]) < 10)) break;
    }
    r->seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    r->sweeps = s->steps > 0 ? (double)s->sweeps / (double)s->steps : 0;
    return 0;
}

static void print_head(const char *first)
{
    printf("  %-24s%10s%10s%12s%14s%14s%12s\n", first, "sweeps", "ms/step", "changes", "drift", "largest", "steps made");
}

static void print_row(const char *label, const result *r, const vibration *s, int64_t steps)
{
    const double ms = s->steps > 0 ? 1e3 * r->seconds / (double)s->steps : 0;
    const char *stopped = s->status ? nlc_strerror(s->status) : "  the energy has grown tenfold";
    printf("  %-24s%10.2f%10.3f%12lld", label, r->sweeps, ms, (long long)s->changes);
    if (r->samples == SAMPLES) printf("%14.1e%14.1e", drift(r), largest(r));
    else printf("%14s%14.1e", "-", largest(r));
    printf("%12lld%s\n", (long long)s->steps, s->steps < steps ? stopped : "");
    fflush(stdout);
}

/* ----------------------------------------------------------------------------------------------------- picture, table -- */

static void add_curves(line_chart *c, const method *m, const result *r, int64_t steps)
{
    line_chart_curve(c, m->colour, LINE_SOLID, "%s", m->label);
    for (int b = 0; b < BINS; b++) { /* the largest change of some samples */
        double most = 0;
        const int first = 1 + b * SAMPLES / BINS, end = 1 + (b + 1) * SAMPLES / BINS;
        for (int k = first; k < end && k <= r->samples; k++) most = fmax(most, fabs(r->change[k]));
        if (most > 0) line_chart_point(c, (double)(b + 1) / BINS * (double)steps, most);
    }
    line_chart_legend(c, m->label, m->colour, LINE_SOLID);
}

static int write_file(const char *path, const line_chart *c, const result *r, const arguments *a)
{
    FILE *out = fopen(path, "w");
    if (!out) return -1;
    if (c) line_chart_write_svg(out, c);
    else fprintf(out, "forces,step,time,kinetic_energy,change_of_energy\n");
    for (int m = 0; m < METHODS && !c; m++)
        for (int k = 0; k <= r[m].samples; k++)
            fprintf(out, "%s,%lld,%.9g,%.9g,%.9g\n", methods[m].label, (long long)(a->steps / SAMPLES * k), r[m].time[k],
                    r[m].kinetic[k], r[m].change[k]);
    const int bad = ferror(out);
    return fclose(out) != 0 || bad ? -1 : 0;
}

/* ---------------------------------------------------------------------------------------------------------------- main -- */

static int compare(vibration *s, const double *const rest[2], const arguments *a, double dt)
{
    static result r[METHODS];
    line_chart c = {.title = "Energy of an undamped packing", .columns = 1, .width = 700, .height = 420};
    line_chart_panel(&c, "change of the energy over the energy of the vibration", (line_axis){"step", 0, (double)a->steps, false},
                     (line_axis){"|change|", 1e-8, 10, true});
    print_head("forces");
    for (int m = 0; m < METHODS; m++) {
        if (run(&r[m], s, rest[methods[m].kind == VIBRATION_HERTZ], a, methods[m].kind, a->steps, dt)) return -1;
        print_row(methods[m].label, &r[m], s, a->steps);
        add_curves(&c, &methods[m], &r[m], a->steps);
    }
    int status = a->svg ? write_file(a->svg, &c, r, a) : 0;
    if (!status && a->csv) status = write_file(a->csv, NULL, r, a);
    if (status) fprintf(stderr, "energy: a file cannot be written\n");
    line_chart_free(&c);
    return status;
}

static int study(vibration *s, const double *rest, const arguments *a, double dt)
{
    static const double tolerances[] = {1e-4, 1e-6, 1e-8};
    static result r;
    char label[64];
    arguments b = *a;
    print_head("time step, tolerance");
    for (int k = 0; k < 6; k++) {
        const int64_t finer = k < 3 ? INT64_C(1) << k : 1;
        if (k >= 3) b.tolerance = tolerances[k - 3];
        if (run(&r, s, rest, &b, VIBRATION_TURNING, finer * a->steps, dt / (double)finer)) return -1;
        snprintf(label, sizeof label, "%g, %g", a->step / (double)finer, b.tolerance);
        print_row(label, &r, s, finer * a->steps);
    }
    return 0;
}

/* The states at rest of coupled forces and of Hertz'; a tolerance that lets them come to rest. */
static int relax(vibration *s, double *const rest[2], const arguments *a)
{
    double dt;
    vibration_save(s, rest[0]);
    vibration_save(s, rest[1]);
    for (int k = 1; k >= 0; k--) {
        vibration_restore(s, rest[k]);
        if (vibration_use(s, k ? VIBRATION_HERTZ : VIBRATION_TURNING, a->model, 1e-10) || vibration_limit(s, &dt)) return -1;
        if (vibration_relax(s, 0.4 * dt, 1e-7, 50000)) return -1;
        vibration_save(s, rest[k]);
    }
    return 0;
}

static bool number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return *text && !*end && *value > 0 && *value < 1e12;
}

static bool parse(arguments *a, int argc, char **argv)
{
    double steps = (double)a->steps;
    struct {
        const char *name;
        double *value;
    } const numbers[] = {{"--steps", &steps}, {"--step", &a->step}, {"--tolerance", &a->tolerance}, {"--kick", &a->kick}};
    for (int k = 1; k < argc; k++) {
        const char *name = argv[k], *value = k + 1 < argc ? argv[k + 1] : "";
        bool known = false;
        for (size_t m = 0; m < sizeof numbers / sizeof numbers[0]; m++)
            if (strcmp(name, numbers[m].name) == 0) known = number(argv[++k] ? value : "", numbers[m].value);
        if (strcmp(name, "--study") == 0) known = a->study = true;
        else if (strcmp(name, "--model") == 0) known = (a->model = nlc_model_find(argv[++k] ? value : "")) >= 0;
        else if (strcmp(name, "--csv") == 0) known = (a->csv = argv[++k]);
        else if (strcmp(name, "--svg") == 0) known = (a->svg = argv[++k]);
        else if (name[0] != '-' && !a->file) known = (a->file = name);
        if (!known) return false;
    }
    a->steps = (int64_t)steps;
    return a->file && a->steps > 0 && a->steps % SAMPLES == 0;
}

static int all(vibration *s, const arguments *a)
{
    const size_t n = 6 * (size_t)s->p.count;
    double dt, kinetic, elastic, *const rest[2] = {calloc(n, sizeof(double)), calloc(n, sizeof(double))};
    int status = rest[0] && rest[1] ? relax(s, rest, a) : -1;
    if (!status) status = vibration_limit(s, &dt) || vibration_energy(s, &kinetic, &elastic) ? -1 : 0;
    if (!status) {
        printf("%s: %lld spheres, %lld contacts and candidates; %lld steps of %g, %g of the largest stable one\n"
               "vibration: %g J, %g of the elastic energy at rest; drift and largest change of the energy in its units\n\n",
               s->p.name, (long long)s->p.count, (long long)s->n.count, (long long)a->steps, a->step * dt, a->step,
               a->kick * elastic, a->kick);
        status = a->study ? study(s, rest[0], a, a->step * dt) : compare(s, (const double *const *)rest, a, a->step * dt);
    }
    if (status) fprintf(stderr, "energy: %s\n", s->status ? nlc_strerror(s->status) : "the packing does not come to rest");
    free(rest[0]);
    free(rest[1]);
    return status;
}

int main(int argc, char **argv)
{
    static vibration s;
    char error[PACKING_ERROR_SIZE];
    arguments a = {.steps = 100000, .step = 0.025, .tolerance = 1e-10, .kick = 1e-3};
    if (!parse(&a, argc, argv)) {
        const bool help = argc == 2 && strcmp(argv[1], "--help") == 0;
        fputs(usage, help ? stdout : stderr);
        return help ? EXIT_SUCCESS : EXIT_USAGE;
    }
    int status = vibration_open(&s, a.file, error, sizeof error);
    if (status) fprintf(stderr, "energy: %s\n", error);
    else status = all(&s, &a);
    vibration_free(&s);
    if (fflush(stdout) != 0 || ferror(stdout)) status = -1;
    return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
