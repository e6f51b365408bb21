/* SPDX-License-Identifier: BSD-2-Clause */
/* anderson.c - Anderson's method. */
#include "anderson.h"

#include "collective.h"

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

/* The products of the columns. */
static void multiply(const nlc_anderson *h, const double *r, double A[NLC_COLUMNS][NLC_COLUMNS], double s[NLC_COLUMNS])
{
    for (int i = 0; i < h->count; i++) {
        s[i] = dot_mixed(h->df[i], r, h->length);
        for (int j = 0; j <= i; j++) A[i][j] = dot_narrow(h->df[i], h->df[j], h->length);
    }
}

/* Least squares r ~ sum s_l df_l by normal equations, columns of unit length, with a small diagonal against dependence. */
static void least_squares(const nlc_anderson *h, const double *r, double s[NLC_COLUMNS])
{
    double A[NLC_COLUMNS][NLC_COLUMNS], L[NLC_COLUMNS][NLC_COLUMNS] = {{0}}, unit[NLC_COLUMNS];
    if (h->met) {
        memcpy(A, h->A, sizeof A);
        memcpy(s, h->s, sizeof h->s);
    } else {
        multiply(h, r, A, s);
    }
    for (int i = 0; i < h->count; i++) { /* no choice between quotients, see small.c */
        const double some = A[i][i] > 1e-280;
        unit[i] = some / sqrt(A[i][i] + (1 - some));
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

void nlc_anderson_reset(nlc_anderson *h, double step)
{
    h->count = h->head = 0;
    h->pending = h->met = false;
    h->smallest = INFINITY;
    h->step = step;
}

void nlc_anderson_start(nlc_anderson *h, nlc_network *n, int per_contact, double *old_x, double *old_r, double most)
{
    const int64_t length = per_contact * n->contact_count;
    *h = (nlc_anderson){.length = length, .old_x = old_x, .old_r = old_r, .most = most, .n = n, .per_contact = per_contact};
    h->columns = 2 * NLC_DIRECTIONS / per_contact; /* there is room for two floats in a double; directions are in one piece, images too */
    for (int l = 0; l < h->columns; l++) {
        h->dx[l] = (float *)(void *)n->direction[0] + l * length;
        h->df[l] = (float *)(void *)n->image[0] + l * length;
    }
}

/* Contacts that are on two ranks count half on each. */
static void halve_straddling(nlc_anderson *h, const double *r, double *norm)
{
    for (int64_t p = 0; p < h->n->straddling * h->per_contact; p++) {
        const int64_t c = nlc_straddling(h->n)[p / h->per_contact] * h->per_contact + p % h->per_contact;
        *norm -= 0.5 * r[c] * r[c];
        for (int i = 0; i < h->count; i++) {
            h->s[i] -= 0.5 * (double)h->df[i][c] * r[c];
            h->squares[i] -= 0.5 * (double)h->dx[i][c] * (double)h->dx[i][c];
            for (int j = 0; j <= i; j++) h->A[i][j] -= 0.5 * (double)h->df[i][c] * (double)h->df[j][c];
        }
    }
}

void nlc_anderson_meet(nlc_anderson *h, const double *x, const double *r, double *norm)
{
    double sums[1 + NLC_COLUMNS * (NLC_COLUMNS + 5) / 2];
    int count = 0;
    if (!nlc_is_shared(h->n)) return;
    append(h, x, r);
    multiply(h, r, h->A, h->s);
    for (int i = 0; i < h->count; i++) h->squares[i] = dot_narrow(h->dx[i], h->dx[i], h->length);
    halve_straddling(h, r, norm);
    sums[count++] = *norm;
    for (int i = 0; i < h->count; i++) {
        sums[count++] = h->s[i];
        sums[count++] = h->squares[i];
        for (int j = 0; j <= i; j++) sums[count++] = h->A[i][j];
    }
    nlc_sum_over_ranks(h->n, sums, count);
    count = 0;
    *norm = sums[count++];
    for (int i = 0; i < h->count; i++) {
        h->s[i] = sums[count++];
        h->squares[i] = sums[count++];
        for (int j = 0; j <= i; j++) h->A[i][j] = sums[count++];
    }
    h->met = true;
}

void nlc_anderson_combine(nlc_anderson *h, double *x, double *r)
{
    double s[NLC_COLUMNS];
    if (!h->met) append(h, x, r);
    least_squares(h, r, s);
    for (int64_t c = 0; c < h->length; c++) {
        h->old_x[c] = x[c];
        h->old_r[c] = r[c];
        for (int l = 0; l < h->count; l++) {
            x[c] -= s[l] * (double)h->dx[l][c];
            r[c] -= s[l] * (double)h->df[l][c];
        }
    }
    h->pending = true;
    h->met = false;
}

void nlc_anderson_move(nlc_anderson *h, double *x, const double *r)
{
    const double step = h->count > 0 ? 1 : h->step;
    for (int64_t c = 0; c < h->length; c++) {
        const double v = x[c] + step * r[c];
        x[c] = v > h->most ? h->most : v < -h->most ? -h->most : v;
    }
}

double nlc_anderson_amplification(const nlc_anderson *h)
{
    double most = 1;
    for (int l = 0; l < h->count; l++) {
        const double x = h->met ? h->squares[l] : dot_narrow(h->dx[l], h->dx[l], h->length);
        const double f = h->met ? h->A[l][l] : dot_narrow(h->df[l], h->df[l], h->length);
        const double ratio = sqrt(nlc_ratio(x, f));
        most = ratio > most ? ratio : most;
    }
    return most;
}
