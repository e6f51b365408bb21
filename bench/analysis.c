/* SPDX-License-Identifier: BSD-2-Clause */
/* analysis.c - solves a packing and sums up. */
#include "analysis.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "timing.h"

enum { REPETITIONS_MIN = 3, REPETITIONS_MAX = 25 };
#define REPETITIONS_TIME 0.25 /* seconds after which the minimum is enough */

/* Everything that one run needs and that is gone after it. */
typedef struct run {
    analysis *a;
    const packing *p;
    const neighbours *n;
    nlc_options options;
    nlc_particles particles;
    void *memory;
    size_t memory_size;
    nlc_network *network;
    double *resultant;      /* [particles][3] */
    double *wall_resultant; /* [walls][3] */
    double *displacement;   /* [contacts][2] */
    char *error;
    size_t error_size;
} run;

/* ---- words for a status */

/* What the library says that info.culprit counts. */
static const char *culprit_kind(nlc_status status)
{
    switch (status) {
#define KIND(name, value, text, culprit)                                                                                       \
    case name:                                                                                                                 \
        return culprit;
        NLC_STATUS_LIST(KIND)
#undef KIND
    default:
        return "-1";
    }
}

static void describe_body(const packing *p, int64_t k, char *text, size_t size)
{
    if (k < p->count)
        snprintf(text, size, "particle %lld", (long long)p->id[k]);
    else
        snprintf(text, size, "wall %lld", (long long)(k - p->count + 1));
}

static void describe_contact(const packing *p, const neighbours *n, int64_t c, char *text, size_t size)
{
    char i[40], j[40];
    describe_body(p, n->i[c], i, sizeof i);
    describe_body(p, n->j[c], j, sizeof j);
    snprintf(text, size, "contact %lld, %s with %s", (long long)c, i, j);
}

static void describe_culprit(const run *r, nlc_status status, int64_t culprit, char *text, size_t size)
{
    const char *kind = culprit_kind(status);
    if (strncmp(kind, "contact", 7) == 0 && culprit >= 0 && culprit < r->n->count)
        describe_contact(r->p, r->n, culprit, text, size);
    else if (strncmp(kind, "particle", 8) == 0 && culprit >= 0)
        describe_body(r->p, culprit, text, size);
    else if (strcmp(kind, "material") == 0)
        snprintf(text, size, "type %lld", (long long)culprit + 1);
    else
        snprintf(text, size, "%s: %lld", kind, (long long)culprit);
}

static int fail_status(run *r, const char *function, nlc_status status, const nlc_info *info)
{
    char culprit[160] = "";
    if (strcmp(culprit_kind(status), "-1") != 0) describe_culprit(r, status, info->culprit, culprit, sizeof culprit);
    snprintf(r->error, r->error_size, "%s, %s: %s%s%s%s", r->a->model, function, nlc_strerror(status),
             *culprit ? " (" : "", culprit, *culprit ? ")" : "");
    return -1;
}

static int fail_memory(run *r)
{
    snprintf(r->error, r->error_size, "%s: out of memory", r->a->model);
    return -1;
}

void analysis_describe_warning(const analysis *a, const packing *p, const neighbours *n, char *text, size_t size)
{
    char where[160] = "no contact";
    if (a->info.worst_contact >= 0) describe_contact(p, n, a->info.worst_contact, where, sizeof where);
    snprintf(text, size, "%s: %s (%lld sweeps, residual %.1e at %s)", a->model, nlc_strerror(a->status),
             (long long)a->info.sweeps, a->info.residual, where);
}

/* ---- solution */

static int allocate(run *r)
{
    analysis *a = r->a;
    size_t contacts = (size_t)r->n->count, walls = (size_t)r->p->wall_count;
    a->force = calloc(contacts + 1, sizeof(double));
    a->nonlocal = calloc(contacts + 1, sizeof(double));
    a->wall_force = calloc(walls + 1, sizeof(double));
    r->resultant = calloc((size_t)r->p->count * 3, sizeof(double));
    r->wall_resultant = calloc(walls * 3 + 1, sizeof(double));
    r->displacement = calloc(contacts + 1, 2 * sizeof(double));
    r->memory_size = nlc_network_size(&r->particles, r->n->count, &r->options);
    r->memory = malloc(r->memory_size + 1);
    bool bad = !a->force || !a->nonlocal || !a->wall_force || !r->resultant || !r->wall_resultant;
    return bad || !r->displacement || !r->memory ? fail_memory(r) : 0;
}

/* Builds, solves and sweeps once. */
static int solve(run *r, double *build_time, double *solve_time, double *sweep_time)
{
    analysis *a = r->a;
    const neighbours *n = r->n;
    nlc_info info = {.struct_size = sizeof info};
    memset(a->nonlocal, 0, (size_t)n->count * sizeof(double));
    double start = timing_seconds();
    nlc_status status =
        nlc_network_init(&r->network, r->memory, r->memory_size, &r->particles, n->i, n->j, n->count, &r->options, &info);
    if (status < 0) return fail_status(r, "nlc_network_init", status, &info);
    double built = timing_seconds();
    a->info.struct_size = sizeof a->info;
    a->status = nlc_solve(r->network, a->force, a->nonlocal, n->overlap, (const double *)n->normal, &a->info);
    *build_time = built - start;
    double solved = timing_seconds();
    *solve_time = solved - built;
    if (a->status < 0) return fail_status(r, "nlc_solve", a->status, &a->info);
    status = nlc_sweep(r->network, r->displacement, a->force, n->overlap, (const double *)n->normal, &info);
    *sweep_time = timing_seconds() - solved;
    return status < 0 ? fail_status(r, "nlc_sweep", status, &info) : 0;
}

static int solve_repeatedly(run *r)
{
    double build[REPETITIONS_MAX], solution[REPETITIONS_MAX], sweep[REPETITIONS_MAX];
    double start = timing_seconds();
    int k = 0;
    while (k < REPETITIONS_MIN || (k < REPETITIONS_MAX && timing_seconds() - start < REPETITIONS_TIME)) {
        if (solve(r, &build[k], &solution[k], &sweep[k])) return -1;
        k++;
    }
    r->a->repetitions = k;
    r->a->build_time = timing_spread_of(build, k).median;
    r->a->solve_time = timing_spread_of(solution, k).median;
    r->a->sweep_time = timing_spread_of(sweep, k).median;
    return 0;
}

/* ---- evaluation */

static void count_contacts(run *r)
{
    analysis *a = r->a;
    const neighbours *n = r->n;
    for (int64_t c = 0; c < n->count; c++) {
        double force = a->force[c];
        a->total += force;
        a->largest = fmax(a->largest, force);
        a->created += n->overlap[c] <= 0 && force > 0;
        a->lost += n->overlap[c] > 0 && !(force > 0);
        if (!(force > 0)) continue;
        if (c < n->pair_count)
            a->pairs++;
        else
            a->walls++;
    }
    if (a->pairs + a->walls > 0) a->mean = a->total / (double)(a->pairs + a->walls);
}

static void sum_stress(run *r)
{
    analysis *a = r->a;
    double volume = packing_volume(r->p);
    for (int64_t c = 0; c < r->n->count; c++) {
        double b[3];
        neighbours_branch(r->n, r->p, c, b);
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 3; l++) a->stress[k][l] += b[k] * (a->force[c] * r->n->normal[c][l]) / volume;
    }
}

static double length(const double *v)
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static int sum_resultants(run *r)
{
    analysis *a = r->a;
    const packing *p = r->p;
    nlc_info info = {.struct_size = sizeof info};
    nlc_status status =
        nlc_assemble(r->network, r->resultant, 0, r->wall_resultant, a->force, (const double *)r->n->normal, &info);
    if (status < 0) return fail_status(r, "nlc_assemble", status, &info);
    for (int64_t k = 0; k < p->count; k++) a->imbalance += length(r->resultant + 3 * k) / (double)p->count;
    for (int64_t w = 0; w < p->wall_count; w++)
        for (int d = 0; d < 3; d++) a->wall_force[w] -= r->wall_resultant[3 * w + d] * p->walls[w].normal[d];
    return 0;
}

int analysis_run(analysis *a, int32_t model, const nlc_options *options, const packing *p, const neighbours *n,
                 char *error, size_t error_size)
{
    memset(a, 0, sizeof *a);
    nlc_model_record record = {.struct_size = sizeof record};
    int status = nlc_model_info(model, &record, NULL);
    if (status < 0) {
        snprintf(error, error_size, "%s: %d", nlc_strerror(status), (int)model);
        return -1;
    }
    a->model = record.name;
    run r = {.a = a, .p = p, .n = n, .options = *options, .error = error, .error_size = error_size};
    r.options.model = model;
    r.particles = packing_particles(p);
    status = allocate(&r);
    if (!status) status = solve_repeatedly(&r);
    if (!status) status = sum_resultants(&r);
    if (!status) {
        count_contacts(&r);
        sum_stress(&r);
    }
    free(r.resultant);
    free(r.wall_resultant);
    free(r.displacement);
    free(r.memory);
    return status;
}

void analysis_free(analysis *a)
{
    free(a->force);
    free(a->nonlocal);
    free(a->wall_force);
    memset(a, 0, sizeof *a);
}
