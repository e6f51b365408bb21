/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * compact.c - pours beds and compacts them: a punch comes down in steps, and at each the spheres move until their forces balance.
 *
 * Each bed is compacted with Hertz' forces and with those of Case I, on paths of their own, as in [GC].  The paths part where
 * spheres rearrange.  To compare the forces without that, at some densities two nonlocal models also start from the bed compacted
 * with Hertz' forces.
 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "equilibrium.h"
#include "packing_out.h"

enum { PATH = 4096, EXIT_USAGE = 2, PICTURED = 6 }; /* that seed's bed is poured 1.004 mm high, the paper's 1 mm */

static const char usage[] =
    "usage: compact FOLDER [FIRST-SEED LAST-SEED [STEP LAST-DENSITY]]\n"
    "\n"
    "Compacts powder beds in a die from their relative density when poured to LAST-DENSITY (0.8) in steps of STEP (0.01).\n"
    "Writes to FOLDER: bed.csv, a line for each state; of seed 6 packings (see bench/README) for the pictures.\n";

typedef struct run {
    const char *folder;
    uint64_t seed, first, last;
    double step, densest;
    FILE *table;
} run;

static int fail(const char *where, const char *text)
{
    fprintf(stderr, "compact: %s: %s\n", where, text);
    return -1;
}

static const char *name_of(int32_t model)
{
    nlc_model_record record = {.struct_size = sizeof record};
    return nlc_model_info(model, &record, NULL) == NLC_OK ? record.name : "?";
}

/* Those at which models are compared from the same bed: .6, .65, ..., .8 */
static bool is_compared(double density)
{
    return density > .59 && fabs(20 * density - round(20 * density)) < 1e-6;
}

/* .56, as in [GC], and the last */
static bool is_pictured(const run *r, double density)
{
    return fabs(density - .56) < 1e-6 || fabs(density - r->densest) < 1e-6;
}

static void write_state(const run *r, const contacts *c, const bed *b, const char *from, const equilibrium *e)
{
    fprintf(r->table, "%d,%s,%s,%.6g,%d,%.6g,%.6g,%.6g,%lld,%.4g,%.1e,%d,%lld,%lld\n", (int)r->seed, name_of(c->model), from,
            bed_density(b), e->loaded, c->wall[BED_PUNCH][2], (c->wall[1][0] - c->wall[0][0]) / 2,
            (c->wall[3][1] - c->wall[2][1]) / 2, (long long)e->active, e->mean, e->imbalance, (int)c->status,
            (long long)c->warned, (long long)e->steps);
}

static int write_picture(const run *r, const bed *b, const char *name)
{
    char path[PATH], title[80];
    if (r->seed != PICTURED) return 0;
    snprintf(title, sizeof title, "%s, seed %d, relative density %.4g", name, (int)r->seed, bed_density(b));
    if (snprintf(path, sizeof path, "%s/%s.csv", r->folder, name) >= PATH) return fail(r->folder, "the path is too long");
    FILE *out = fopen(path, "w");
    if (!out) return fail(path, strerror(errno));
    packing_write(out, b, title);
    const bool bad = ferror(out) != 0;
    return fclose(out) == 0 && !bad ? 0 : fail(path, "cannot be written");
}

/* The bed at its density with the forces of a model, in equilibrium; a line of the table. */
static int settle(const run *r, contacts *c, bed *b, const char *from)
{
    equilibrium e;
    c->warned = 0;
    const nlc_status status = equilibrium_find(&e, c, b);
    if (status < 0) return fail("forces", nlc_strerror(status));
    write_state(r, c, b, from, &e);
    return 0;
}

/* A nonlocal model at the density of a bed compacted with Hertz' forces. */
static int settle_from_hertz(const run *r, const bed *b, int32_t model)
{
    bed other = *b;
    contacts c;
    if (!contacts_init(&c, b, model)) return fail("contacts", "no memory");
    const int status = settle(r, &c, &other, "hertz");
    contacts_free(&c);
    return status;
}

static int compact(const run *r, const bed *poured, int32_t model)
{
    const double begin = (double)clock();
    bed b = *poured;
    contacts c;
    char name[80];
    int status = 0;
    if (!contacts_init(&c, &b, model)) return fail("contacts", "no memory");
    for (int n = (int)ceil(bed_density(&b) / r->step); n * r->step < r->densest + 1e-9 && status == 0; n++) {
        const double density = n * r->step;
        b.height = bed_solid(&b) / (die_side * die_side * density);
        status = settle(r, &c, &b, "itself");
        if (model == NLC_MODEL_HERTZ && is_compared(density) && status == 0)
            status = settle_from_hertz(r, &b, NLC_MODEL_GONZALEZ_CUITINO) || settle_from_hertz(r, &b, NLC_MODEL_SPHERE);
        snprintf(name, sizeof name, "bed_%s_%.2f", name_of(model), density);
        if (status == 0 && is_pictured(r, density)) status = write_picture(r, &b, name);
    }
    printf("  seed %d, %s: load %.4g N at relative density %.3f, %.1f s\n", (int)r->seed, name_of(model), c.wall[BED_PUNCH][2],
           bed_density(&b), ((double)clock() - begin) / CLOCKS_PER_SEC);
    contacts_free(&c);
    return fflush(stdout) == 0 ? status : fail("standard output", strerror(errno));
}

static int all(run *r)
{
    int status = 0;
    fputs("# beds of 125 spheres in a die; made by bench/figures/bed/compact.c\n"
          "# from: the state before is that at the step before (itself), or Hertz' at this density (hertz)\n"
          "# loaded: is there a force?; lateral: mean of two opposite walls\n"
          "# imbalance: largest net force on a sphere / mean_force\n"
          "# status: of nlc_solve there; warned: solves on the way with a status that was not 0; steps: of FIRE\n"
          "seed,model,from,density,loaded,load_N,lateral_x_N,lateral_y_N,contacts,mean_force_N,imbalance,status,warned,steps\n",
          r->table);
    for (r->seed = r->first; r->seed <= r->last && status == 0; r->seed++) {
        uint64_t state = r->seed;
        bed b;
        bed_mix(&b, &state);
        bed_pour(&b, &state);
        printf("  seed %d: poured to %.4g mm, relative density %.4f\n", (int)r->seed, 1e3 * b.height, bed_density(&b));
        fprintf(r->table, "# seed %d: poured to height %.6g m, relative density %.6g\n", (int)r->seed, b.height, bed_density(&b));
        status = write_picture(r, &b, "bed_poured") || compact(r, &b, NLC_MODEL_HERTZ) ||
                 compact(r, &b, NLC_MODEL_GONZALEZ_CUITINO);
    }
    return status;
}

int main(int argc, char **argv)
{
    char path[PATH];
    run r = {.first = 1, .last = 20, .step = .01, .densest = .8};
    if ((argc != 2 && argc != 4 && argc != 6) || argv[1][0] == '-') {
        fputs(usage, stderr);
        return EXIT_USAGE;
    }
    if (argc > 3) {
        r.first = strtoull(argv[2], NULL, 10);
        r.last = strtoull(argv[3], NULL, 10);
    }
    if (argc > 5) {
        r.step = strtod(argv[4], NULL);
        r.densest = strtod(argv[5], NULL);
    }
    if (!(r.step >= 1e-4 && r.densest <= 1)) {
        fputs(usage, stderr);
        return EXIT_USAGE;
    }
    r.folder = argv[1];
    snprintf(path, sizeof path, "%s/bed.csv", r.folder);
    r.table = fopen(path, "w");
    if (!r.table) {
        fail(path, strerror(errno));
        return EXIT_FAILURE;
    }
    int status = all(&r);
    if (ferror(r.table)) status = fail(path, "cannot be written");
    if (fclose(r.table) != 0) status = fail(path, "cannot be written");
    return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
