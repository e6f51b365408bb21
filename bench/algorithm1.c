/* SPDX-License-Identifier: BSD-2-Clause */
/* algorithm1.c - Algorithm 1 of Gonzalez and Cuitino (2012), contact by contact. */
#include "algorithm1.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static void set_particles(algorithm1 *a, const packing *p)
{
    for (int64_t k = 0; k < p->count; k++) {
        double E = p->materials[p->material[k]].young, nu = p->materials[p->material[k]].poisson;
        algorithm1_particle *q = &a->particle[k];
        q->constant = isfinite(E) ? (1 + nu) / (4 * pi * p->radius[k] * E) : 0;
        q->a = -2 * (1 - nu);
        q->b = -2 * (1 - 2 * nu);
        q->c = 7 - 8 * nu;
    }
}

static int32_t body(const neighbours *n, int64_t contact, int side)
{
    return side ? n->j[contact] : n->i[contact];
}

/* Walls get no list: their surfaces are not displaced. */
static void set_incident(algorithm1 *a)
{
    const neighbours *n = a->n;
    for (int64_t c = 0; c < n->count; c++)
        for (int side = 0; side < 2; side++)
            if (body(n, c, side) < a->particles) a->first[body(n, c, side) + 1]++;
    for (int64_t k = 0; k < a->particles; k++) a->first[k + 1] += a->first[k];
    for (int64_t c = n->count - 1; c >= 0; c--)
        for (int side = 1; side >= 0; side--)
            if (body(n, c, side) < a->particles) a->incident[--a->first[body(n, c, side) + 1]] = 2 * c + side;
    /* filling from behind has turned first[k + 1], the end of k's list, into its beginning */
    memmove(a->first, a->first + 1, (size_t)a->particles * sizeof a->first[0]);
}

int algorithm1_init(algorithm1 *a, const packing *p, const neighbours *n)
{
    memset(a, 0, sizeof *a);
    a->particles = p->count;
    a->n = n;
    a->particle = malloc((size_t)p->count * sizeof a->particle[0]);
    a->first = calloc((size_t)p->count + 1, sizeof a->first[0]);
    a->incident = malloc((size_t)(2 * n->count + 1) * sizeof a->incident[0]);
    if (!a->particle || !a->first || !a->incident) return -1;
    set_particles(a, p);
    set_incident(a);
    a->first[p->count] = n->count + n->pair_count;
    return 0;
}

void algorithm1_free(algorithm1 *a)
{
    free(a->particle);
    free(a->first);
    free(a->incident);
    memset(a, 0, sizeof *a);
}

/* Line 14 for all contacts incident to one end of contact c. */
static void add_displacements(const algorithm1 *a, double *nonlocal, int64_t c, int side, double force)
{
    const neighbours *n = a->n;
    int32_t k = body(n, c, side);
    if (k >= a->particles) return;
    const algorithm1_particle q = a->particle[k];
    const double *nc = n->normal[c];
    for (int64_t e = a->first[k]; e < a->first[k + 1]; e++) {
        int64_t d = a->incident[e] / 2;
        int other = (int)(a->incident[e] & 1);
        if (d == c && other == side) continue;
        const double *nd = n->normal[d];
        double cosine = nc[0] * nd[0] + nc[1] * nd[1] + nc[2] * nd[2];
        if (other != side) cosine = -cosine; /* the normals point out of the particle on one side and into it on the other */
        double theta = acos(fmax(-1, fmin(1, cosine)));
        double s = sin(theta / 2);
        nonlocal[d] += q.constant * force * (q.a + (q.b + q.c * s) * s) / s;
    }
}

void algorithm1_sweep(const algorithm1 *a, double *nonlocal, const double *force)
{
    memset(nonlocal, 0, (size_t)a->n->count * sizeof nonlocal[0]);
    for (int64_t c = 0; c < a->n->count; c++) {
        if (!(force[c] > 0)) continue;
        add_displacements(a, nonlocal, c, 0, force[c]);
        add_displacements(a, nonlocal, c, 1, force[c]);
    }
}
