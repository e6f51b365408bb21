/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * cell.c - the nearest image in a periodic cell, with any angles.
 *
 * Along cell vector A_k a difference d counts f_k = d.r_k cells, r_k being the reciprocal vectors.  As |f_k| <= |d| / h_k, h_k
 * the width between the two faces that A_k joins, a difference shorter than half of all widths has |f_k| < 1/2: rounding the
 * f_k of any of its images to whole numbers and subtracting so many cells leads to it.
 */
#include "cell.h"

#include "check.h"
#include "vector.h"

#define FLATTEST 1e-6 /* volume of unit vectors along the cell's */

static void cross(double c[3], const double *a, const double *b)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* False: too short to have a direction. */
static bool normalise(double v[3])
{
    const double length = sqrt(nlc_dot(v, v));
    if (length < FLATTEST) return false;
    for (int x = 0; x < 3; x++) v[x] /= length;
    return true;
}

/* A unit vector across a: from the axis that is least along it. */
static void choose_across(double v[3], const double *a)
{
    double axis[3] = {0, 0, 0};
    int least = 0;
    for (int x = 1; x < 3; x++)
        if (fabs(a[x]) < fabs(a[least])) least = x;
    axis[least] = 1;
    cross(v, a, axis);
    normalise(v);
}

/* Where the cell is not periodic its unit vector is one across the others. */
static bool complete(double u[3][3], const nlc_cell *c)
{
    for (int k = 0; k < 3; k++) {
        double *v = u[k];
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const bool has_a = c->periodic[a] || a < k, has_b = c->periodic[b] || b < k;
        if (c->periodic[k]) continue;
        if (has_a && has_b) {
            cross(v, u[a], u[b]);
            if (!normalise(v)) return false;
        } else {
            choose_across(v, u[has_a ? a : b]);
        }
    }
    return true;
}

static bool set_reciprocals(nlc_cell *c, double u[3][3])
{
    double normal[3][3];
    for (int k = 0; k < 3; k++) cross(normal[k], u[(k + 1) % 3], u[(k + 2) % 3]);
    const double volume = nlc_dot(u[0], normal[0]);
    if (fabs(volume) < FLATTEST) return false;
    c->width = INFINITY;
    for (int k = 0; k < 3; k++) {
        for (int x = 0; x < 3; x++) c->reciprocal[k][x] = normal[k][x] / volume;
        if (!c->periodic[k]) continue;
        const double width = nlc_join(c->length[k].m / sqrt(nlc_dot(c->reciprocal[k], c->reciprocal[k])), c->length[k].e);
        c->width = width < c->width ? width : c->width;
    }
    return true;
}

bool nlc_prepare_cell(nlc_cell *c, const double *vectors)
{
    double u[3][3];
    memset(c, 0, sizeof *c);
    if (!vectors) return true;
    c->largest = nlc_largest_magnitude(vectors, 9);
    if (!nlc_is_finite(c->largest)) return false;
    memcpy(c->vector, vectors, sizeof c->vector);
    memcpy(u, vectors, sizeof u);
    for (int k = 0; k < 3; k++) {
        c->length[k] = nlc_length(u[k]); /* u is scaled to about 1 */
        c->periodic[k] = normalise(u[k]);
        c->any |= c->periodic[k];
    }
    return !c->any || (complete(u, c) && set_reciprocals(c, u));
}

/* The nearest whole number of |x| < 2^51; halves away from 0, so that the sign of x only changes that of the result. */
static double nearest(double x)
{
    return (double)(int64_t)(x + (x < 0 ? -0.5 : 0.5));
}

/* *sum += b; what is lost goes to *lost (Knuth's two-sum). */
static void add(double *sum, double *lost, double b)
{
    const double a = *sum, rounded = a + b, part = rounded - a;
    *lost += (a - (rounded - part)) + (b - part);
    *sum = rounded;
}

bool nlc_wrap(double d[3], const double *to, const double *from, int e, const nlc_cell *c)
{
    double cells[3] = {0, 0, 0};
    const double unit = nlc_pow2(-e);
    for (int x = 0; x < 3; x++) d[x] = to[x] - from[x];
    for (int k = 0; k < 3; k++) {
        if (!c->periodic[k]) continue;
        const double f = nlc_join(nlc_dot(c->reciprocal[k], d) / c->length[k].m, e - c->length[k].e);
        if (nlc_abs_bits(f) >= nlc_bits(0x1p51)) return false;
        cells[k] = nearest(f);
    }
    if (nlc_abs_bits(cells[0]) == 0 && nlc_abs_bits(cells[1]) == 0 && nlc_abs_bits(cells[2]) == 0) return true;
    for (int x = 0; x < 3; x++) { /* of a difference of nearly a whole cell little is left: no digit is to be lost before */
        double lost = 0;
        d[x] = to[x];
        add(&d[x], &lost, -from[x]);
        for (int k = 0; k < 3; k++) add(&d[x], &lost, -cells[k] * (c->vector[k][x] * unit));
        d[x] += lost;
    }
    return true;
}
