/* SPDX-License-Identifier: BSD-2-Clause */
/* metrics.c - R_top, err_f, err_Z and bhat. */
#include "metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { THRESHOLDS = 2000 };

/* The levels of the reference that the run reaches, both at the same strain, in the reference's bins. */
typedef struct pairs {
    int count;
    const run *bins;
    run_row *a, *b;
} pairs;

/* Contacts of a row between two forces; within a bin they are evenly spread.  The last bin asked for has no upper end. */
static double contacts_between(const run *r, const run_row *row, double low, double high, bool last)
{
    double sum = 0;
    for (int k = 0; k < r->bins; k++) {
        const double from = fmax(low, r->edge[k]), to = last ? r->edge[k + 1] : fmin(high, r->edge[k + 1]);
        if (to > from) sum += row->count[k] * (to - from) / (r->edge[k + 1] - r->edge[k]);
    }
    return sum;
}

static void rebin(run_row *row, const run *from, const run *to)
{
    const run_row old = *row;
    const double per_grain = to->grains / from->grains;
    for (int k = 0; k < to->bins; k++)
        row->count[k] = per_grain * contacts_between(from, &old, to->edge[k], to->edge[k + 1], k + 1 == to->bins);
}

static void pair_up(pairs *p, const run *a, const run *b, metrics *m)
{
    for (int n = 0; n < b->rows; n++) {
        if (!run_at(&p->a[p->count], a, b->row[n].phase, b->row[n].strain)) {
            m->left_out++;
            continue;
        }
        rebin(&p->a[p->count], a, b);
        p->b[p->count++] = b->row[n];
    }
    m->levels = p->count;
}

static void compare_top(metrics *m, const pairs *p)
{
    double sum = 0, most = p->b[0].strain, top = 0, reference = 0;
    for (int n = 0; n < p->count; n++) {
        const double difference = p->a[n].value[RUN_TOP] - p->b[n].value[RUN_TOP];
        sum += difference * difference;
        most = fmax(most, p->b[n].strain);
    }
    int count = 0; /* the last level may be there twice, as the end of loading and the beginning of unloading */
    for (int n = 0; n < p->count; n++)
        if (p->b[n].strain >= most - 1e-9) top += p->a[n].value[RUN_TOP], reference += p->b[n].value[RUN_TOP], count++;
    m->strain = most;
    m->top = top / count;
    m->top_reference = reference / count;
    m->R_top = top / reference;
    m->err_f = sqrt(sum / p->count);
}

static double coordination_error(const pairs *p, double threshold, double resolution)
{
    double sum = 0;
    for (int n = 0; n < p->count; n++) {
        const double d = run_coordination(p->bins, &p->a[n], threshold) - run_coordination(p->bins, &p->b[n], resolution);
        sum += d * d;
    }
    return sqrt(sum / p->count);
}

/* Thresholds from 0 to the upper edge of the last bin, dense where bins are narrow: so many in each of them. */
static void compare_coordination(metrics *m, const pairs *p, const metrics_settings *set)
{
    const int in_bin = THRESHOLDS / p->bins->bins + 1;
    m->threshold = isnan(set->threshold) ? 0 : set->threshold;
    m->err_Z = coordination_error(p, m->threshold, set->resolution);
    for (int k = 0; k < p->bins->bins && isnan(set->threshold); k++)
        for (int s = 1; s <= in_bin; s++) {
            const double t = p->bins->edge[k] + (p->bins->edge[k + 1] - p->bins->edge[k]) * s / in_bin;
            const double error = coordination_error(p, t, set->resolution);
            if (error < m->err_Z) m->err_Z = error, m->threshold = t;
        }
}

/* B of one level: 1 if the distributions are the same, 0 if they have nothing in common, -1 if there is no force in one of
 * them. */
static double overlap_of(const pairs *p, int n)
{
    double sum = 0, a = 0, b = 0;
    for (int k = 0; k < p->bins->bins; k++) {
        a += p->a[n].count[k];
        b += p->b[n].count[k];
        sum += sqrt(p->a[n].count[k] * p->b[n].count[k]);
    }
    return a > 0 && b > 0 ? sum / sqrt(a * b) : -1;
}

static const char *compare_distributions(metrics *m, const pairs *p)
{
    double sum = 0;
    int count = 0;
    for (int n = 0; n < p->count; n++) {
        const double B = overlap_of(p, n);
        if (B >= 0) sum += B, count++;
    }
    if (count == 0) return "no level at which both have contacts";
    m->bhat = fmax(-log(sum / count), 0); /* rounding makes it -1e-16 */
    return NULL;
}

static const char *compare_means(metrics *m, const run *a, const run *b, const metrics_settings *set)
{
    const size_t rows = (size_t)b->rows;
    pairs p = {.bins = b, .a = calloc(rows, sizeof *p.a), .b = calloc(rows, sizeof *p.b)};
    const char *wrong = p.a && p.b ? NULL : "out of memory";
    if (!wrong) pair_up(&p, a, b, m);
    if (!wrong && p.count == 0) wrong = "the run reaches no level of the reference";
    if (!wrong) {
        compare_top(m, &p);
        compare_coordination(m, &p, set);
        wrong = m->top_reference > 0 ? compare_distributions(m, &p)
                                     : "no force on the reference's plate at the largest compression";
    }
    free(p.a);
    free(p.b);
    return wrong;
}

const char *metrics_compare(metrics *m, const run *a, const run *reference, const metrics_settings *set)
{
    run mean_a = {0}, mean_b = {0};
    memset(m, 0, sizeof *m);
    const bool good = run_mean(&mean_a, a, set->first) && run_mean(&mean_b, reference, set->first);
    const char *wrong = good ? compare_means(m, &mean_a, &mean_b, set) : "no rows from that cycle on";
    run_free(&mean_a);
    run_free(&mean_b);
    return wrong;
}
