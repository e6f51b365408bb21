/* SPDX-License-Identifier: BSD-2-Clause */
/* stress.c - see stress.h */
#include "stress.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool full(void)
{
    return getenv("NLC_TEST_FULL") != NULL;
}

/* ------------------------------------------------------------------------------------------------------------- groups -- */

static int64_t unknown; /* misses in this process, which runs one test */

void tally_heading(void)
{
    if (!full()) return;
    printf("%-34s %6s  %6s %5s %6s  %9s  %6s %5s %5s %5s %5s  %8s %8s %8s %5s %5s %6s\n", "group", "solves", "sweeps", "",
           "target", "blocks", "OK", "close", "round", "weak", "n.c.", "compared", "error/", "tol", "other", "alone", "misses");
    printf("%-34s %6s  %6s %5s %6s  %9s  %6s %5s %5s %5s %5s  %8s %8s %8s %5s %5s %6s\n", "", "", "median", "worst", "", "", "",
           "", "", "", "", "", "median", "worst", "", "", "");
    fflush(stdout);
}

void tally_begin(tally *t, int target, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    memset(t, 0, sizeof *t);
    t->target = target;
    vsnprintf(t->name, sizeof t->name, format, arguments);
    va_end(arguments);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void tally_end(tally *t, int64_t known)
{
    if (t->trials) qsort(t->sweeps, (size_t)t->trials, sizeof *t->sweeps, by_size);
    if (t->compared) qsort(t->error, (size_t)t->compared, sizeof *t->error, by_size);
    if (full() && t->trials) {
        printf("%-34s %6jd  %6.0f %5.0f ", t->name, (intmax_t)t->trials, t->sweeps[t->trials / 2], t->sweeps[t->trials - 1]);
        if (t->target)
            printf("%6d ", t->target);
        else
            printf("%6s ", "");
        printf(" %9jd  %6jd %5jd %5jd %5jd %5jd  %8jd ", (intmax_t)t->blocks, (intmax_t)t->status[COUNT_OK],
               (intmax_t)t->status[COUNT_CLOSE], (intmax_t)t->status[COUNT_ROUNDING], (intmax_t)t->status[COUNT_WEAKENED],
               (intmax_t)t->status[COUNT_NOT_CONVERGED], (intmax_t)t->compared);
        if (t->compared)
            printf("%8.1e %8.1e ", t->error[t->compared / 2], t->error[t->compared - 1]);
        else
            printf("%8s %8s ", "", "");
        printf("%5jd %5jd %6jd\n", (intmax_t)t->other, (intmax_t)t->alone, (intmax_t)t->misses);
    }
    fflush(stdout);
    free(t->sweeps);
    free(t->error);
    if (t->misses > known) unknown += t->misses - known;
}

void no_misses(void)
{
    ck_assert_msg(unknown == 0, "%jd misses", (intmax_t)unknown);
}

void tally_miss(tally *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (t->misses++ < 5) {
        printf("%s: ", t->name);
        vprintf(format, arguments);
        printf("\n");
    }
    va_end(arguments);
}

void tally_count(tally *t, const trial *r)
{
    const nlc_status s = r->status;
    t->sweeps = realloc(t->sweeps, (size_t)(t->trials + 1) * sizeof *t->sweeps);
    t->sweeps[t->trials++] = (double)r->info.sweeps;
    t->blocks = r->info.blocks > t->blocks ? r->info.blocks : t->blocks;
    t->status[COUNT_OK] += s == NLC_OK;
    t->status[COUNT_CLOSE] += (s & NLC_WARNING_CLOSE) != 0;
    t->status[COUNT_ROUNDING] += (s & NLC_WARNING_ROUNDING) != 0;
    t->status[COUNT_WEAKENED] += (s & NLC_WARNING_WEAKENED) != 0;
    t->status[COUNT_NOT_CONVERGED] += (s & NLC_WARNING_NOT_CONVERGED) != 0;
}

static void count_error(tally *t, double error)
{
    t->error = realloc(t->error, (size_t)(t->compared + 1) * sizeof *t->error);
    t->error[t->compared++] = error;
}

/* ------------------------------------------------------------------------------------------------------------- trials -- */

void cold(scene *s)
{
    if (s->nonlocal) memset(s->nonlocal, 0, (size_t)s->contacts * sizeof *s->nonlocal);
}

trial solve_load(scene *s, double load, double tolerance)
{
    trial r = {.info = {.struct_size = sizeof r.info}, .error = INFINITY};
    const size_t size = (size_t)(s->contacts > 0 ? s->contacts : 1) * sizeof(double);
    double *overlap = malloc(size);
    s->options.tolerance = tolerance;
    if (!s->network)
        ck_assert_int_eq(scene_build(s), NLC_OK);
    else
        ck_assert_int_eq(nlc_set_options(s->network, &s->options, 0), NLC_OK);
    for (int64_t c = 0; c < s->contacts; c++) overlap[c] = load * s->overlap[c];
    fp_trap();
    r.status = nlc_solve(s->network, s->force, s->nonlocal, overlap, s->normal, &r.info);
    fp_untrap();
    ck_assert_msg(r.status >= 0, "%s (%jd)", nlc_strerror(r.status), (intmax_t)r.info.culprit);
    ck_assert_int_le(r.info.sweeps, s->options.max_sweeps > 0 ? s->options.max_sweeps : 1000);
    for (int64_t c = 0; c < s->contacts; c++) {
        ck_assert(isfinite(s->force[c]) && s->force[c] >= 0 && isfinite(s->nonlocal[c]));
        const double k = s->options.stiffness ? s->options.stiffness[c] : (double)scene_stiffness(s, c);
        nlc_assert_abs(s->force[c], nlc_hertz_force(k, overlap[c] + s->nonlocal[c]), 4e-15 * s->force[c] + 1e-320);
    }
    free(overlap);
    return r;
}

double recomputed_residual(const scene *s, double load)
{
    const size_t n = (size_t)(s->contacts > 0 ? s->contacts : 1);
    double *overlap = malloc(n * sizeof *overlap), *w = malloc(2 * n * sizeof *w);
    long double *force = malloc(n * sizeof *force);
    for (int64_t c = 0; c < s->contacts; c++) overlap[c] = load * s->overlap[c], force[c] = s->force[c];
    /* where contact points move with the displacements, these are found by repetition */
    const bool moving = s->options.model == NLC_MODEL_HALF_SPACE && s->options.points == NLC_POINTS_DEFORMED;
    for (size_t k = 0; k < 2 * n; k++) w[k] = 0;
    double *before = calloc(2 * n, sizeof *before);
    for (int k = 0; k < (moving ? 200 : 1); k++) {
        for (size_t e = 0; e < 2 * n; e++) before[e] = w[e] = k < 2 ? w[e] : 0.5 * (w[e] + before[e]); /* damped: they may overshoot */
        fp_trap();
        const nlc_status status = nlc_sweep(s->network, w, s->force, overlap, s->normal, 0);
        fp_untrap();
        ck_assert_int_eq(status, NLC_OK);
    }
    free(before);
    for (int64_t c = 0; c < s->contacts; c++) {
        const double k = s->options.stiffness ? s->options.stiffness[c] : (double)scene_stiffness(s, c);
        w[c] = nlc_hertz_force(k, overlap[c] + (w[2 * c] + w[2 * c + 1])); /* in place: 2 c >= c */
    }
    const double residual = scene_error(s, w, force);
    free(overlap), free(w), free(force);
    return residual;
}

/* Of a stable solution that is within its tolerance: what info says of it. */
static void check_info(tally *t, const trial *r, const exact *e, double load, double tolerance)
{
    const nlc_info *i = &r->info;
    if (i->residual > tolerance && !(r->status & NLC_WARNING_ROUNDING))
        tally_miss(t, "load %g: residual %g", load, i->residual);
    if (i->coupling != 1 || i->weakened != 0 || i->weakest_particle >= 0)
        tally_miss(t, "load %g: coupling %g", load, i->coupling);
    if (!e) return;
    /* lambda_upper is that of the forces found; Ritz values on the way may be of steeper states */
    if (i->lambda_upper < (double)e->lambda - 1e-6 - tolerance || i->lambda_lower > (double)e->lambda + 0.02)
        tally_miss(t, "load %g: lambda %.6f not in [%.6f, %.6f]", load, (double)e->lambda, i->lambda_lower, i->lambda_upper);
}

trial solve_stable(tally *t, scene *s, const exact *e, double load, double tolerance)
{
    cold(s);
    trial r = solve_load(s, load, tolerance);
    const bool close = r.status & NLC_WARNING_CLOSE, stable = r.info.coupling == 1 && !(r.status & NLC_WARNING_NOT_CONVERGED);
    tally_count(t, &r);
    if (verbose())
        printf("%s, load %g, tolerance %g: status %d, %jd sweeps, %jd blocks, lambda %.4f in [%.4f, %.4f]\n", t->name, load,
               tolerance, r.status, (intmax_t)r.info.sweeps, (intmax_t)r.info.blocks, e ? (double)e->lambda : 0.,
               r.info.lambda_lower, r.info.lambda_upper);
    if (!stable) {
        t->alone += !e;
        if (e)
            tally_miss(t, "load %g tolerance %g: %s, lambda %.4f", load, tolerance, nlc_strerror(r.status), (double)e->lambda);
        return r;
    }
    r.error = e ? scene_error(s, s->force, e->force) : recomputed_residual(s, load) / (1 - r.info.lambda_upper);
    if (close && e && r.error > 1e-3) { /* another solution: none but the stated exception */
        t->other++;
        return r;
    }
    count_error(t, r.error / tolerance);
    if (r.error > tolerance && !(r.status & NLC_WARNING_ROUNDING))
        tally_miss(t, "load %g tolerance %g: error %g", load, tolerance, r.error);
    if (t->target && tolerance < 1e-9 && r.info.sweeps > t->target)
        tally_miss(t, "load %g: %jd sweeps", load, (intmax_t)r.info.sweeps);
    check_info(t, &r, e, load, tolerance);
    return r;
}

trial solve_beyond(tally *t, scene *s, double load, double tolerance)
{
    const double h = 1e-5;
    cold(s);
    trial r = solve_load(s, load, tolerance);
    long double *kept = malloc((size_t)s->contacts * sizeof *kept);
    for (int64_t c = 0; c < s->contacts; c++) kept[c] = s->force[c];
    const trial moved = solve_load(s, load * (1 + h), tolerance);
    const double step = scene_error(s, s->force, kept);
    tally_count(t, &r);
    t->alone++;
    if (verbose())
        printf("%s, load %g, tolerance %g: status %d, %jd sweeps, %jd blocks, coupling %.4f, moves %.1f h\n", t->name, load,
               tolerance, r.status, (intmax_t)r.info.sweeps, (intmax_t)r.info.blocks, r.info.coupling, step / h);
    if (!(r.status & moved.status & NLC_WARNING_WEAKENED) || !(r.info.coupling < 1) || r.info.weakest_particle < 0)
        tally_miss(t, "load %g: not weakened", load);
    else if (!((r.status | moved.status) & NLC_WARNING_NOT_CONVERGED)) {
        if (r.info.residual > tolerance) tally_miss(t, "load %g: residual %g", load, r.info.residual);
        if (!(step <= 50 * h + 2 * tolerance))
            tally_miss(t, "load %g tolerance %g: forces move by %g h", load, tolerance, step / h);
    } else if (!(r.info.residual <= 1))
        tally_miss(t, "load %g: residual %g", load, r.info.residual);
    free(kept);
    return r;
}

double end_of_branch(const scene *s, bool *capped)
{
    double strain = 0;
    for (int64_t c = 0; c < s->contacts; c++) {
        const double R = s->radius[s->i[c] < s->particles ? s->i[c] : s->j[c]];
        const double both = s->i[c] < s->particles && s->j[c] < s->particles ? s->radius[s->i[c]] + s->radius[s->j[c]] : R;
        strain = fmax(strain, s->overlap[c] / both);
    }
    const long double end = exact_end(s, 0.2L / strain, 1e-7L);
    *capped = isinf(end);
    return *capped ? 0.2 / strain : (double)end;
}
