/* SPDX-License-Identifier: BSD-2-Clause */
/* anderson.c - Anderson's method. */
#include "anderson.h"

/* Single precision ends at 3e38. */
static float narrowed(double v)
{
    return (float)(v > 1e30 ? 1e30 : v < -1e30 ? -1e30 : v);
}

/*
 * Sums over the two sides of a contact first: which one is called i changes no bit.  (Where there is one number a contact, over
 * two contacts.)
 */
static double dot_narrow(const float *a, const float *b, int64_t length)
{
    double s = 0;
    for (int64_t c = 0; c + 1 < length; c += 2) s += (double)a[c] * (double)b[c] + (double)a[c + 1] * (double)b[c + 1];
    return length % 2 ? s + (double)a[length - 1] * (double)b[length - 1] : s;
}

static double dot_mixed(const float *a, const double *b, int64_t length)
{
    double s = 0;
    for (int64_t c = 0; c + 1 < length; c += 2) s += (double)a[c] * b[c] + (double)a[c + 1] * b[c + 1];
    return length % 2 ? s + (double)a[length - 1] * b[length - 1] : s;
}

/* Least squares r ~ sum s_l df_l by normal equations, columns of unit length, with a small diagonal against dependence. */
static void least_squares(const nlc_anderson *h, const double *r, double s[NLC_COLUMNS])
{
    double A[NLC_COLUMNS][NLC_COLUMNS], L[NLC_COLUMNS][NLC_COLUMNS] = {{0}}, unit[NLC_COLUMNS];
    for (int i = 0; i < h->count; i++) {
        s[i] = dot_mixed(h->df[i], r, h->length);
        for (int j = 0; j <= i; j++) A[i][j] = dot_narrow(h->df[i], h->df[j], h->length);
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
static void append(nlc_anderson *h, const double *x, const double *r)
{
    if (!h->pending) return;
    float *dx = h->dx[h->head], *df = h->df[h->head];
    for (int64_t c = 0; c < h->length; c++) {
        dx[c] = narrowed(x[c] - h->old_x[c]);
        df[c] = narrowed(r[c] - h->old_r[c]);
    }
    h->head = (h->head + 1) % h->columns;
    if (h->count < h->columns) h->count++;
}

static void next_x(nlc_anderson *h, double *x, const double *r)
{
    double s[NLC_COLUMNS];
    const double step = h->count > 0 ? 1 : h->step;
    least_squares(h, r, s);
    for (int64_t c = 0; c < h->length; c++) {
        double v = x[c] + step * r[c];
        for (int l = 0; l < h->count; l++) v -= s[l] * ((double)h->dx[l][c] + step * (double)h->df[l][c]);
        h->old_x[c] = x[c];
        h->old_r[c] = r[c];
        x[c] = v > h->most ? h->most : v < -h->most ? -h->most : v;
    }
    h->pending = true;
}

void nlc_anderson_reset(nlc_anderson *h, double step)
{
    h->count = h->head = 0;
    h->pending = false;
    h->smallest = INFINITY;
    h->step = step;
}

void nlc_anderson_start(nlc_anderson *h, nlc_network *n, int64_t length, double *old_x, double *old_r, double most)
{
    const int64_t room = n->contact_count * 2 * NLC_DIRECTIONS; /* floats in direction, which are in one piece, and in image */
    *h = (nlc_anderson){.length = length, .old_x = old_x, .old_r = old_r, .most = most};
    h->columns = length > 0 ? (int)(room / length) : 0;
    for (int l = 0; l < h->columns; l++) {
        h->dx[l] = (float *)(void *)n->direction[0] + l * length;
        h->df[l] = (float *)(void *)n->image[0] + l * length;
    }
}

void nlc_anderson_step(nlc_anderson *h, double *x, const double *r)
{
    append(h, x, r);
    next_x(h, x, r);
}

double nlc_anderson_amplification(const nlc_anderson *h)
{
    double most = 1;
    for (int l = 0; l < h->count; l++) {
        const double x = dot_narrow(h->dx[l], h->dx[l], h->length), f = dot_narrow(h->df[l], h->df[l], h->length);
        const double ratio = sqrt(nlc_ratio(x, f));
        most = ratio > most ? ratio : most;
    }
    return most;
}
