/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * deposition.c - ballistic deposition with restructuring (Jullien and Meakin 1989): spheres fall one by one and roll down to a
 * stable place.
 *
 * Rolling is steepest descent: in the direction nearest to gravity's that leads into none of the touched surfaces.  Surfaces
 * nearer than a step count as touched, so that none is overlapped.
 */
#include "bed.h"

#include <math.h>

enum { TOUCHED = 24, STEPS = 200000 };
static const double steps[] = {1e-2, 1e-3, 1e-4}; /* of a radius */

typedef double vector[3];

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The surfaces nearer than gap to sphere k at x, as unit vectors from them to it.  Spheres 0 ... k-1 lie already. */
static int touched(const bed *b, int k, const vector x, double gap, vector *normal)
{
    const double r = b->radius[k];
    int count = 0;
    for (int wall = 0; wall < BED_PUNCH; wall++) {
        const int axis = wall / 2;
        const double d = wall % 2 ? die_side - x[axis] - r : x[axis] - r;
        if (d > gap || count == TOUCHED) continue;
        for (int e = 0; e < 3; e++) normal[count][e] = e != axis ? 0 : wall % 2 ? -1 : 1;
        count++;
    }
    for (int n = 0; n < k; n++) {
        const vector v = {x[0] - b->x[n][0], x[1] - b->x[n][1], x[2] - b->x[n][2]};
        const double length = sqrt(dot(v, v)), d = length - r - b->radius[n];
        if (d > gap || count == TOUCHED) continue;
        for (int e = 0; e < 3; e++) normal[count][e] = v[e] / length;
        count++;
    }
    return count;
}

/* Takes d for the best direction if it is longer and leads into no surface. */
static void consider(vector best, double *longest, const vector d, vector *normal, int count)
{
    const double length = sqrt(dot(d, d));
    if (length <= *longest) return;
    for (int c = 0; c < count; c++)
        if (dot(d, normal[c]) < -1e-9) return;
    *longest = length;
    for (int e = 0; e < 3; e++) best[e] = d[e] / length;
}

/*
 * Gravity projected on the cone of directions that lead into no surface: of the projections on its faces, all of space, a
 * surface, or the edge of two, the longest that lies in the cone.  Returns its length, 0 where the sphere is held.
 */
static double steepest(vector best, vector *normal, int count)
{
    const vector gravity = {0, 0, -1};
    double longest = 0;
    consider(best, &longest, gravity, normal, count);
    for (int a = 0; a < count; a++) {
        const double *n = normal[a], part = dot(gravity, n);
        const vector slide = {gravity[0] - part * n[0], gravity[1] - part * n[1], gravity[2] - part * n[2]};
        consider(best, &longest, slide, normal, count);
        for (int b = 0; b < a; b++) {
            const double *m = normal[b];
            vector edge = {n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]};
            const double square = dot(edge, edge), along = square > 1e-12 ? dot(gravity, edge) / square : 0;
            for (int e = 0; e < 3; e++) edge[e] *= along;
            consider(best, &longest, edge, normal, count);
        }
    }
    return longest;
}

static void roll(const bed *b, int k, vector x, double step)
{
    vector normal[TOUCHED], d;
    for (int n = 0; n < STEPS; n++) {
        const int count = touched(b, k, x, step * b->radius[k], normal);
        if (steepest(d, normal, count) < 1e-3) return;
        for (int e = 0; e < 3; e++) x[e] += step * b->radius[k] * d[e];
    }
}

void bed_pour(bed *b, uint64_t *state)
{
    double top = 0;
    for (int k = 0; k < BED_SPHERES; k++) {
        const double r = b->radius[k];
        for (int e = 0; e < 2; e++) b->x[k][e] = r + bed_random(state) * (die_side - 2 * r);
        b->x[k][2] = top + r;
        for (size_t n = 0; n < sizeof steps / sizeof *steps; n++) roll(b, k, b->x[k], steps[n]);
        top = fmax(top, b->x[k][2] + r);
    }
    b->height = top;
}
