/* SPDX-License-Identifier: BSD-2-Clause */
/* contenders.c - ways to find the forces of a time step. */
#include "contenders.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "algorithm1.h"
#include "timing.h"

/* A new way to use nlc_solve, such as an option to come, is a row here. */
static const contender contenders[] = {
    {.key = "hertz", .label = "Hertz, no coupling", .kind = KIND_HERTZ, .options = {.model = NLC_MODEL_HERTZ}},
    {.key = "lagged", .label = "1, 2, 3 lagged sweeps", .kind = KIND_LAGGED},
    {.key = "algorithm1", .label = "Algorithm 1 as printed", .kind = KIND_ALGORITHM1},
    {.key = "fixed_zeros", .label = "fixed point, from zeros", .kind = KIND_SOLVE, .options = {.method = NLC_METHOD_FIXED_POINT}},
    {.key = "fixed_last", .label = "fixed point, from last step", .kind = KIND_SOLVE, .start = START_LAST_STEP,
     .options = {.method = NLC_METHOD_FIXED_POINT}},
    {.key = "fixed_predicted", .label = "fixed point, predicted", .kind = KIND_SOLVE, .start = START_PREDICTED,
     .options = {.method = NLC_METHOD_FIXED_POINT}},
    {.key = "solve_zeros", .label = "default, from zeros", .kind = KIND_SOLVE},
    {.key = "solve_last", .label = "default, from last step", .kind = KIND_SOLVE, .start = START_LAST_STEP},
    {.key = "solve_predicted", .label = "default, predicted", .kind = KIND_SOLVE, .start = START_PREDICTED},
    {.key = "solve_zeros_kept", .label = "default, zeros, kept", .kind = KIND_SOLVE, .keeps = true},
    {.key = "solve_last_kept", .label = "default, last step, kept", .kind = KIND_SOLVE, .start = START_LAST_STEP, .keeps = true},
    {.key = "sphere_zeros", .label = "sphere, from zeros", .kind = KIND_SOLVE, .options = {.model = NLC_MODEL_SPHERE}},
    {.key = "sphere_zeros_kept", .label = "sphere, zeros, kept", .kind = KIND_SOLVE, .keeps = true,
     .options = {.model = NLC_MODEL_SPHERE}},
    {.key = "sphere_last", .label = "sphere, from last step", .kind = KIND_SOLVE, .start = START_LAST_STEP,
     .options = {.model = NLC_MODEL_SPHERE}},
    {.key = "sphere_last_kept", .label = "sphere, last step, kept", .kind = KIND_SOLVE, .start = START_LAST_STEP, .keeps = true,
     .options = {.model = NLC_MODEL_SPHERE}},
};
enum { CONTENDERS = sizeof contenders / sizeof contenders[0] };

#define CONVERGED 1e-15 /* what the others are compared with; rounding stops it somewhat above */
#define TIME_IN_ALL 4.0 /* seconds of the processor after which no further run begins */
enum { RUNS = 10, HISTORY = 2, LAGGED_SWEEPS = 3, SWEEPS_MAX = 300 };

/* What is done with a packing of so many contacts at most. */
typedef struct effort {
    double contacts;
    int settle, timed, from_zeros; /* steps: before those timed, timed, timed of what begins from zeros */
    int every, last, algorithm1;   /* digits from one tolerance to the next, in the last one, in that of Algorithm 1 */
    int sphere;                    /* its starts: 0 none, 1 zeros, 2 the last step, too */
} effort;

static const effort efforts[] = {
    {30000, 20, 12, 2, 2, 14, 14, 2}, {1e6, 10, 8, 1, 2, 14, 14, 1}, {INFINITY, 3, 1, 1, 4, 10, 6, 0}};
static const effort least = {0, 3, 2, 1, 4, 14, 14, 2};

static const double *normals(const contest *c)
{
    return (const double *)c->path.n.normal;
}

static size_t bytes(const contest *c)
{
    return (size_t)c->path.n.count * sizeof(double);
}

/* ---- what is to be run */

static void add_point(contest *c, const contender *who, double setting)
{
    if (c->points == POINTS_MAX) abort();
    c->point[c->points++] = (point){.contender = who, .setting = setting};
}

static void list_points(contest *c, const effort *e)
{
    for (int k = 0; k < CONTENDERS; k++) {
        const contender *who = &contenders[k];
        const bool sphere = who->options.model == NLC_MODEL_SPHERE;
        if (sphere && (int)who->start >= e->sphere) continue;
        if (who->kind == KIND_HERTZ) add_point(c, who, 0);
        for (int s = 1; s <= LAGGED_SWEEPS && who->kind == KIND_LAGGED; s++) add_point(c, who, s);
        if (who->kind == KIND_HERTZ || who->kind == KIND_LAGGED) continue;
        const int last = who->kind == KIND_ALGORITHM1 ? e->algorithm1 : e->last;
        for (int digits = 2; digits <= last; digits += sphere ? 4 : e->every) add_point(c, who, pow(10, -digits));
    }
}

/* The cache is as large as it has to be, whatever used it before. */
static nlc_status use(contest *c, const contender *who, double tolerance)
{
    nlc_options o = who->options;
    o.struct_size = sizeof o;
    o.tolerance = tolerance;
    nlc_status status = nlc_set_options(c->path.network, &o, NULL);
    if (status < 0 || !who->keeps) return status;
    free(c->cache);
    o.cache_size = nlc_cache_size(c->path.network);
    if (o.cache_size == 0) return NLC_OK; /* nothing is worth keeping */
    o.cache = c->cache = malloc(o.cache_size + 1);
    return c->cache ? nlc_set_options(c->path.network, &o, NULL) : NLC_ERROR_MEMORY_SIZE;
}

static const converged *exact_of(const contest *c, const contender *who)
{
    return &c->exact[who->options.model == NLC_MODEL_SPHERE];
}

/* ---- a step */

static void note(contest *c, point *p, int step, double seconds, double sweeps)
{
    if (step < c->first_timed) return;
    if (c->runs == 0) {
        const force_error e = compression_error(&c->path, c->force, exact_of(c, p->contender)->force[step - c->first_timed]);
        p->largest = e.largest <= p->largest ? p->largest : e.largest;
        p->mean_square = e.mean_square <= p->mean_square ? p->mean_square : e.mean_square;
        p->sweeps += sweeps;
    }
    p->seconds += seconds;
    p->steps++;
}

static void end_run(const contest *c, point *p)
{
    if (p->steps == 0) return;
    if (c->runs == 0) p->sweeps /= p->steps;
    p->sample[p->samples++] = 1e9 * p->seconds / p->steps / (double)c->path.n.count;
    p->seconds = p->steps = 0;
}

static nlc_status lagged(contest *c, int sweeps)
{
    nlc_status status = NLC_OK;
    for (int sweep = 0; sweep < sweeps && status >= 0; sweep++) { /* the last sweep is for the forces of the next step */
        compression_forces(&c->path, c->force, c->g);
        status = nlc_sweep(c->path.network, c->w, c->force, NULL, normals(c), NULL);
        for (int64_t k = 0; k < c->path.n.count; k++) c->g[k] = c->w[2 * k] + c->w[2 * k + 1];
    }
    return status;
}

static void make_step(contest *c, point *p, int step)
{
    const contender *who = p->contender;
    nlc_info info = {.struct_size = sizeof info};
    nlc_status status = NLC_OK;
    if (who->start == START_ZEROS && who->kind != KIND_LAGGED) memset(c->g, 0, bytes(c));
    const double start = timing_processor_seconds();
    if (who->kind == KIND_LAGGED) {
        status = lagged(c, (int)p->setting);
    } else {
        if (who->start == START_PREDICTED) status = nlc_predict(c->g, c->previous, c->path.n.count, 1, NULL);
        if (status >= 0) status = nlc_solve(c->path.network, c->force, c->g, c->path.overlap, normals(c), &info);
    }
    const double seconds = timing_processor_seconds() - start;
    p->status = status < 0 ? status : p->status | status;
    if (status >= 0) note(c, p, step, seconds, who->kind == KIND_LAGGED ? p->setting : (double)info.sweeps);
}

/* The displacements of the first two steps with errors up to the size given, relative, which differ from contact to contact. */
static void begin_history(contest *c, const converged *exact, double size)
{
    for (int64_t k = 0; k < c->path.n.count; k++) {
        const uint64_t random = (uint64_t)k * UINT64_C(0x9e3779b97f4a7c15);
        c->previous[k] = exact->g[0][k] * (1 + size * ((double)(random >> 54) / 512 - 1));
        c->g[k] = exact->g[1][k] * (1 + size * ((double)(random >> 44 & 1023) / 512 - 1));
    }
}

static void run_point(contest *c, point *p)
{
    const contender *who = p->contender;
    const bool history = who->kind == KIND_LAGGED || who->start != START_ZEROS;
    const nlc_status status = use(c, who, who->kind == KIND_SOLVE ? p->setting : 0);
    if (status < 0) p->status = status;
    begin_history(c, exact_of(c, who), who->kind == KIND_SOLVE ? p->setting : 0);
    for (int step = history ? HISTORY : c->first_from_zeros; step <= c->path.steps && p->status >= 0; step++) {
        compression_set_step(&c->path, step);
        make_step(c, p, step);
    }
    end_run(c, p);
}

/* Largest change of the displacements over the largest one. */
static double change_of(const contest *c, const double *g, const double *next)
{
    double change = 0, largest = 0;
    for (int64_t k = 0; k < c->path.n.count; k++) {
        change = fmax(change, fabs(next[k] - g[k]));
        largest = fmax(largest, fabs(next[k]));
    }
    return largest > 0 ? change / largest : 0;
}

/* All of its tolerances, p[0] to p[count - 1], are met one after the other in one iteration. */
static void run_algorithm1(contest *c, const algorithm1 *a, point *p, int count)
{
    for (int step = c->first_from_zeros; step <= c->path.steps; step++) {
        double elapsed = 0;
        int met = 0;
        compression_set_step(&c->path, step);
        memset(c->g, 0, bytes(c));
        for (int sweep = 1; met < count && sweep <= SWEEPS_MAX; sweep++) {
            double start = timing_processor_seconds();
            compression_forces(&c->path, c->force, c->g);
            memcpy(c->previous, c->g, bytes(c));
            algorithm1_sweep(a, c->g, c->force);
            const double change = change_of(c, c->previous, c->g);
            elapsed += timing_processor_seconds() - start;
            if (!(change <= p[met].setting)) continue;
            start = timing_processor_seconds();
            compression_forces(&c->path, c->force, c->g);
            const double last = timing_processor_seconds() - start;
            for (; met < count && change <= p[met].setting; met++) note(c, &p[met], step, elapsed + last, sweep);
        }
        for (; met < count; met++) p[met].status = NLC_WARNING_NOT_CONVERGED;
    }
    for (int k = 0; k < count; k++) end_run(c, &p[k]);
}

/* ---- preparation */

static int allocate(contest *c, int timed)
{
    const size_t contacts = (size_t)c->path.n.count;
    double **array[] = {&c->force,         &c->g,             &c->previous,      &c->exact[0].g[0],
                        &c->exact[0].g[1], &c->exact[1].g[0], &c->exact[1].g[1]};
    bool there = (c->w = calloc(contacts, 2 * sizeof(double))) != NULL;
    for (size_t k = 0; k < sizeof array / sizeof *array; k++)
        there = (*array[k] = calloc(contacts, sizeof(double))) && there;
    for (int m = 0; m < 2; m++) {
        double **force = c->exact[m].force = calloc((size_t)timed + 1, sizeof *force);
        for (int k = 0; k < timed && force; k++) there = (force[k] = malloc(contacts * sizeof(double))) && there;
        there = there && force;
    }
    return there ? 0 : -1;
}

/* A warning that says that there is no such solution is returned, too. */
static nlc_status solve_exactly(contest *c, int32_t model)
{
    const contender who = {.options = {.model = model}, .keeps = true};
    const converged *exact = exact_of(c, &who);
    nlc_status status = use(c, &who, CONVERGED);
    memset(c->g, 0, bytes(c));
    for (int step = 0; step <= c->path.steps && status >= 0; step++) {
        if (step >= HISTORY && step < c->first_timed) continue;
        compression_set_step(&c->path, step);
        double *force = step < c->first_timed ? c->force : exact->force[step - c->first_timed];
        const nlc_status warning = nlc_solve(c->path.network, force, c->g, c->path.overlap, normals(c), NULL);
        status = warning < 0 ? warning : status | warning;
        if (step < HISTORY) memcpy(exact->g[step], c->g, bytes(c));
    }
    return status & (NLC_WARNING_NOT_CONVERGED | NLC_WARNING_WEAKENED) || status < 0 ? status : NLC_OK;
}

static void run_all(contest *c, const algorithm1 *a, int runs)
{
    const double start = timing_processor_seconds();
    timing_progress progress;
    timing_progress_begin(&progress, "points done");
    for (; c->runs < runs && (c->runs == 0 || timing_processor_seconds() - start < TIME_IN_ALL); c->runs++) {
        for (int k = 0; k < c->points; k++) {
            timing_progress_update(&progress, c->runs * c->points + k, runs * c->points);
            point *p = &c->point[k];
            int count = 1;
            if (p->contender->kind != KIND_ALGORITHM1) {
                run_point(c, p);
                continue;
            }
            while (k + count < c->points && c->point[k + count].contender == p->contender) count++;
            run_algorithm1(c, a, p, count);
            k += count - 1;
        }
    }
    timing_progress_end(&progress);
}

int contest_run(contest *c, const char *name, bool quick, char *error, size_t error_size)
{
    memset(c, 0, sizeof *c);
    if (compression_open(&c->path, name, error, error_size)) return -1;
    const effort *e = &efforts[0];
    while ((double)c->path.n.count > e->contacts) e++;
    if (quick) e = &least;
    c->first_timed = HISTORY + e->settle;
    c->path.steps = c->first_timed + e->timed - 1;
    c->first_from_zeros = c->path.steps + 1 - e->from_zeros;
    list_points(c, e);
    algorithm1 a;
    const char *reason = NULL;
    if (algorithm1_init(&a, &c->path.p, &c->path.n) || allocate(c, e->timed)) reason = "out of memory";
    if (!reason) {
        nlc_status status = solve_exactly(c, NLC_MODEL_GONZALEZ_CUITINO);
        if (!status && e->sphere > 0) status = solve_exactly(c, NLC_MODEL_SPHERE);
        if (status) reason = nlc_strerror(status);
    }
    if (reason) snprintf(error, error_size, "%s: %s", name, reason);
    else run_all(c, &a, quick ? 1 : RUNS);
    algorithm1_free(&a);
    return reason ? -1 : 0;
}

void contest_free(contest *c)
{
    double *array[] = {c->force, c->g, c->previous, c->w, c->exact[0].g[0], c->exact[0].g[1], c->exact[1].g[0], c->exact[1].g[1]};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) free(array[k]);
    for (int m = 0; m < 2; m++) {
        for (int k = 0; c->exact[m].force && k <= c->path.steps - c->first_timed; k++) free(c->exact[m].force[k]);
        free(c->exact[m].force);
    }
    free(c->cache);
    compression_free(&c->path);
}
