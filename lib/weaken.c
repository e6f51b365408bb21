/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * weaken.c - beyond the end of the stable branch: a finite force by weakening the coupling where it is too strong.
 *
 *     x = gamma + sum over particles of t_k C_k P(x),   t_k = min(1, (1 - m) / b_k(x))
 *
 * with the balanced b_k of bound.c at x: a particle is weakened just so far that its block stays stable.  Always the same
 * number of passes is taken: a bound that stops when it is good enough would make t jump.  Solved by Anderson's method, whose
 * differences are kept in single precision: they choose the step, the residual is computed anew.
 */
#include <string.h>

#include "bound.h"
#include "iteration.h"

#define COLUMNS 10
#define FIRST_STEP 0.7 /* of the plain iteration, before there are differences */
#define RESTART_STEP 0.3
#define GROWTH 4.0     /* of the residual: then back to the best, with shorter steps */
#define STEPS 240
#define PATIENCE 25 /* steps without the residual falling tenfold after which it begins again from Hertz */
#define START_CAP 5.0 /* of the start, in units of the largest overlap nearby, which counts as no less than SMALLEST */
#define SMALLEST 0.05

typedef struct anderson {
    int count, head;
    bool pending; /* x and r of the step before are at hand */
    double *old_x, *old_r;
    float *dx[COLUMNS], *df[COLUMNS];
    double smallest, step;
} anderson;

/* y = the right side of the equation at x, coupling weakened; returns the largest change of a force, relative. */
static double weakened_map(nlc_iteration *q, const double *x, double *y, nlc_outcome *out)
{
    nlc_network *n = q->n;
    nlc_bound bound = {INFINITY, -1, 0};
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double k = nlc_scaled_stiffness(q, c), root = sqrt(0.5 * (x[c] + fabs(x[c])));
        n->force[c] = k * root * root * root;
        n->slope[c] = 1.5 * k * root;
    }
    nlc_bound_balance(n, q->normal, NLC_BALANCE_PASSES, 0, &bound);
    out->info.blocks += bound.blocks;
    out->info.lambda_upper = bound.upper;
    out->info.critical_particle = bound.where;
    out->info.weakened = 0;
    out->info.coupling = 1;
    out->info.weakest_particle = -1;
    for (int64_t k = 0; k < n->particle_count; k++) {
        n->weakening[k] = n->bound[k] > 1 - NLC_MARGIN ? (1 - NLC_MARGIN) / n->bound[k] : 1;
        out->info.weakened += n->weakening[k] < 1;
        if (n->weakening[k] >= out->info.coupling) continue;
        out->info.coupling = n->weakening[k];
        out->info.weakest_particle = k;
    }
    out->info.sweeps++;
    out->status = nlc_displace(n, n->force, q->normal, &out->info.culprit);
    if (out->status != NLC_OK) return 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const int64_t i = n->i[c], j = n->j[c];
        const double a = i < n->particle_count ? n->weakening[i] : 1, b = j < n->particle_count ? n->weakening[j] : 1;
        n->current[c] = a * n->side[2 * c] + b * n->side[2 * c + 1];
        y[c] = nlc_scaled_overlap(q, c);
        n->slope[c] = nlc_scaled_force(q, c) - n->force[c];
    }
    nlc_force_scales(q, true);
    return nlc_relative_size(q, n->slope, &out->info.worst_contact);
}

/* Single precision ends at 3e38. */
static float narrowed(double v)
{
    return (float)(v > 1e30 ? 1e30 : v < -1e30 ? -1e30 : v);
}

/* Least squares r ~ sum s_l df_l by normal equations, columns of unit length, with a small diagonal against dependence. */
static void least_squares(const anderson *h, const double *r, int64_t count, double s[COLUMNS])
{
    double A[COLUMNS][COLUMNS], L[COLUMNS][COLUMNS] = {{0}}, unit[COLUMNS];
    for (int i = 0; i < h->count; i++) {
        s[i] = 0;
        for (int64_t c = 0; c < count; c++) s[i] += (double)h->df[i][c] * r[c];
        for (int j = 0; j <= i; j++) {
            A[i][j] = 0;
            for (int64_t c = 0; c < count; c++) A[i][j] += (double)h->df[i][c] * (double)h->df[j][c];
        }
        unit[i] = A[i][i] > 1e-280 ? 1 / sqrt(A[i][i]) : 0;
    }
    for (int i = 0; i < h->count; i++) {
        s[i] *= unit[i];
        for (int j = 0; j <= i; j++) {
            double v = A[i][j] * unit[i] * unit[j] + (i == j ? 1e-13 : 0);
            for (int l = 0; l < j; l++) v -= L[i][l] * L[j][l];
            L[i][j] = i > j ? v / L[j][j] : v > 1e-13 ? sqrt(v) : 1e100;
        }
        for (int l = 0; l < i; l++) s[i] -= L[i][l] * s[l];
        s[i] /= L[i][i];
    }
    for (int i = h->count - 1; i >= 0; i--) {
        for (int l = i + 1; l < h->count; l++) s[i] -= L[l][i] * s[l];
        s[i] /= L[i][i];
    }
    for (int i = 0; i < h->count; i++) s[i] *= unit[i];
}

/* A column of the differences since the last step. */
static void append(anderson *h, const double *x, const double *r, int64_t count)
{
    if (!h->pending) return;
    float *dx = h->dx[h->head], *df = h->df[h->head];
    for (int64_t c = 0; c < count; c++) {
        dx[c] = narrowed(x[c] - h->old_x[c]);
        df[c] = narrowed(r[c] - h->old_r[c]);
    }
    h->head = (h->head + 1) % COLUMNS;
    if (h->count < COLUMNS) h->count++;
}

static void next_x(anderson *h, double *x, const double *r, int64_t count)
{
    double s[COLUMNS];
    const double step = h->count > 0 ? 1 : h->step;
    least_squares(h, r, count, s);
    for (int64_t c = 0; c < count; c++) {
        double v = x[c] + step * r[c];
        for (int l = 0; l < h->count; l++) v -= s[l] * ((double)h->dx[l][c] + step * (double)h->df[l][c]);
        h->old_x[c] = x[c];
        h->old_r[c] = r[c];
        x[c] = v > NLC_FARTHEST ? NLC_FARTHEST : v < -NLC_FARTHEST ? -NLC_FARTHEST : v;
    }
    h->pending = true;
}

static void reset(anderson *h, double step)
{
    h->count = h->head = 0;
    h->pending = false;
    h->smallest = INFINITY;
    h->step = step;
}

/* The directions are no longer needed: their memory holds twice as many columns in single precision. */
static void take_columns(anderson *h, nlc_network *n)
{
    for (int d = 0; d < NLC_DIRECTIONS; d++)
        for (int half = 0; half < 2; half++) {
            h->dx[2 * d + half] = (float *)(void *)n->direction[d] + half * n->contact_count;
            h->df[2 * d + half] = (float *)(void *)n->image[d] + half * n->contact_count;
        }
}

/* The iterate, capped. */
static void start_from_iterate(const nlc_iteration *q, double *x)
{
    for (int64_t c = 0; c < q->n->contact_count; c++) {
        const double v = nlc_scaled_overlap(q, c), nearby = nlc_overlap_nearby(q, c);
        const double cap = START_CAP * (nearby > SMALLEST ? nearby : SMALLEST);
        x[c] = v > cap ? cap : v < -NLC_FARTHEST ? -NLC_FARTHEST : v;
    }
}

/* Hertz's overlaps; returns the sum of their squares. */
static double start_from_overlaps(const nlc_iteration *q, double *x)
{
    double sum = 0;
    for (int64_t c = 0; c < q->n->contact_count; c++) {
        x[c] = q->overlap[c] * q->load;
        sum += x[c] > 0 ? x[c] * x[c] : 0;
    }
    return sum;
}

/*
 * y becomes the residual; returns the sum of its squares.  How far a contact is open makes no difference to any force: one that
 * opens or closes moves as far beyond 0 as it was before it, so that no gap, however wide, looks like a residual.
 */
static double residual(double *x, double *y, int64_t count)
{
    double norm = 0;
    for (int64_t c = 0; c < count; c++) {
        if (y[c] > 0 && x[c] < -y[c]) x[c] = -y[c];
        if (x[c] > 0 && y[c] < -x[c]) y[c] = -x[c];
        y[c] = x[c] <= 0 && y[c] <= 0 ? 0 : y[c] - x[c];
        norm += y[c] * y[c];
    }
    return norm;
}

/*
 * It begins where the caller said, unless the residual there shows that this is nothing to go on from; then at the iterate,
 * unless that has run away; then with Hertz's overlaps, at the latest when another start has led nowhere.
 */
enum { GIVEN, ITERATE, HERTZ };

static bool is_good_start(int start, double norm, double applied)
{
    return start == HERTZ || norm <= (start == GIVEN ? 0.01 : 1) * applied;
}

void nlc_weaken(nlc_iteration *q, nlc_outcome *out)
{
    nlc_network *n = q->n;
    const int64_t count = n->contact_count;
    double *x = n->spare[0], *y = n->spare[1], *best = n->spare[2], *iterate = n->spare[3], mark = INFINITY;
    const double applied = start_from_overlaps(q, x);
    int start = GIVEN, waited = 0;
    anderson h;
    start_from_iterate(q, iterate);
    take_columns(&h, n);
    h.old_x = iterate; /* until then: there are no differences before the first step */
    h.old_r = n->floor;
    reset(&h, FIRST_STEP);
    memcpy(x, best, (size_t)count * sizeof *x); /* that is the start given */
    out->status = NLC_WARNING_NOT_CONVERGED;
    for (int k = 0; k < STEPS && out->info.sweeps < n->settings.max_sweeps; k++) {
        const double change = weakened_map(q, x, y, out);
        if (out->status < 0) return;
        out->status = NLC_WARNING_NOT_CONVERGED;
        out->info.residual = change / NLC_MARGIN;
        if (out->info.residual <= n->settings.tolerance) {
            out->status = NLC_OK;
            break;
        }
        const double norm = residual(x, y, count);
        waited = norm < 0.01 * mark ? 0 : waited + 1;
        mark = waited == 0 ? norm : mark;
        if ((!h.pending && !is_good_start(start, norm, applied)) || (waited > PATIENCE && start < HERTZ)) {
            start = start == GIVEN && !h.pending ? ITERATE : HERTZ;
            if (start == ITERATE) memcpy(x, iterate, (size_t)count * sizeof *x);
            else start_from_overlaps(q, x);
            reset(&h, FIRST_STEP);
            waited = 0;
            mark = INFINITY;
            continue;
        }
        if (norm > GROWTH * GROWTH * h.smallest) {
            memcpy(x, best, (size_t)count * sizeof *x);
            reset(&h, RESTART_STEP);
            continue;
        }
        append(&h, x, y, count);
        if (norm < h.smallest) {
            h.smallest = norm;
            memcpy(best, x, (size_t)count * sizeof *best);
        }
        next_x(&h, x, y, count);
    }
    if (out->info.weakened > 0) out->status |= NLC_WARNING_WEAKENED;
}
