/* SPDX-License-Identifier: BSD-2-Clause */
/* exact.c - the solution that is continuously connected to zero load, in long double, and where it ends. */
#include "exact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LANCZOS 60

static long double *vector(int64_t n)
{
    long double *v = calloc((size_t)(n > 0 ? n : 1), sizeof *v);
    if (!v) abort();
    return v;
}

static long double dot(const long double *a, const long double *b, int64_t n)
{
    long double s = 0;
    for (int64_t c = 0; c < n; c++) s += a[c] * b[c];
    return s;
}

void exact_init(exact *e, const scene *s)
{
    memset(e, 0, sizeof *e);
    e->contacts = s->contacts;
    e->random.state = 1;
    scene_terms(s, &e->terms, &e->c, &e->d, &e->w);
    e->k = vector(s->contacts);
    e->overlap = vector(s->contacts);
    e->force = vector(s->contacts);
    e->slope = vector(s->contacts);
    for (int64_t c = 0; c < s->contacts; c++) {
        e->k[c] = scene_stiffness(s, c);
        e->overlap[c] = s->overlap[c];
    }
}

void exact_free(exact *e)
{
    free(e->c);
    free(e->d);
    free(e->w);
    free(e->k);
    free(e->overlap);
    free(e->force);
    free(e->slope);
}

static void couple(const exact *e, long double *out, const long double *in)
{
    for (int64_t c = 0; c < e->contacts; c++) out[c] = 0;
    for (int64_t t = 0; t < e->terms; t++) out[e->c[t]] += e->w[t] * in[e->d[t]];
}

/* Residual law(f gamma + C P) - P, relative to the largest force, and D. */
static long double residual(exact *e, long double f, long double *z)
{
    long double largest = 0, worst = 0;
    couple(e, z, e->force);
    for (int64_t c = 0; c < e->contacts; c++) {
        const long double x = f * e->overlap[c] + z[c], p = x > 0 ? e->k[c] * x * sqrtl(x) : 0;
        e->slope[c] = x > 0 ? 1.5L * e->k[c] * sqrtl(x) : 0;
        z[c] = p - e->force[c];
        largest = fmaxl(largest, p);
        worst = fmaxl(worst, fabsl(z[c]));
    }
    return largest > 0 ? worst / largest : 0;
}

/* (1 - D C) step = z, as (D^-1 - C) q = D^-1 z by conjugate gradients in q = D^-1/2 y.  False: not positive definite. */
static bool newton_step(exact *e, long double *step, const long double *z)
{
    const int64_t n = e->contacts;
    long double *r = vector(n), *p = vector(n), *a = vector(n), *t = vector(n), *root = vector(n);
    bool definite = true;
    /* contacts without slope just take their residual, which the others feel */
    for (int64_t c = 0; c < n; c++) root[c] = sqrtl(e->slope[c]), t[c] = e->slope[c] > 0 ? 0 : z[c];
    couple(e, a, t);
    for (int64_t c = 0; c < n; c++) {
        step[c] = 0;
        p[c] = r[c] = root[c] > 0 ? z[c] / root[c] + root[c] * a[c] : 0;
    }
    long double rr = dot(r, r, n);
    const long double first = rr;
    for (int k = 0; k < 3000 && definite && rr > 1e-36L * first; k++) {
        for (int64_t c = 0; c < n; c++) t[c] = root[c] * p[c];
        couple(e, a, t);
        for (int64_t c = 0; c < n; c++) a[c] = p[c] - root[c] * a[c];
        const long double curvature = dot(p, a, n), length = rr / curvature, before = rr;
        definite = curvature > 0;
        for (int64_t c = 0; c < n; c++) step[c] += length * p[c], r[c] -= length * a[c];
        rr = dot(r, r, n);
        for (int64_t c = 0; c < n; c++) p[c] = r[c] + rr / before * p[c];
    }
    for (int64_t c = 0; c < n; c++) step[c] = root[c] > 0 ? root[c] * step[c] : z[c];
    free(r), free(p), free(a), free(t), free(root);
    return definite;
}

/* Largest eigenvalue of the tridiagonal matrix, by bisection on the number of eigenvalues above. */
static long double largest_of(const long double *diagonal, const long double *beside, int n)
{
    long double low = -1e3L, high = 1e3L;
    while (high - low > 1e-12L) {
        const long double x = (low + high) / 2;
        long double d = diagonal[0] - x;
        bool above = d > 0;
        for (int i = 1; i < n && !above; i++) {
            d = diagonal[i] - x - beside[i - 1] * beside[i - 1] / (d != 0 ? d : 1e-30L);
            above = d > 0;
        }
        *(above ? &low : &high) = x;
    }
    return low;
}

static long double largest_eigenvalue(exact *e)
{
    const int64_t n = e->contacts;
    long double *v = vector(n), *before = vector(n), *a = vector(n), *t = vector(n), diagonal[LANCZOS], beside[LANCZOS];
    int k = 0;
    for (int64_t c = 0; c < n; c++) v[c] = e->slope[c] > 0 ? rng_uniform(&e->random, 0.1, 1) : 0;
    long double norm = sqrtl(dot(v, v, n)), last = 0;
    for (int64_t c = 0; c < n && norm > 0; c++) v[c] /= norm;
    while (k < LANCZOS && norm > 0) {
        for (int64_t c = 0; c < n; c++) t[c] = sqrtl(e->slope[c]) * v[c];
        couple(e, a, t);
        for (int64_t c = 0; c < n; c++) a[c] = sqrtl(e->slope[c]) * a[c] - last * before[c];
        diagonal[k] = dot(a, v, n);
        for (int64_t c = 0; c < n; c++) a[c] -= diagonal[k] * v[c];
        beside[k] = last = sqrtl(dot(a, a, n));
        k++;
        if (last < 1e-15L) break;
        for (int64_t c = 0; c < n; c++) before[c] = v[c], v[c] = a[c] / last;
    }
    free(v), free(before), free(a), free(t);
    return k > 0 ? largest_of(diagonal, beside, k) : 0;
}

/* Newton at one load from the present forces. */
static bool solve_at(exact *e, long double f)
{
    long double *z = vector(e->contacts), *step = vector(e->contacts), now = 0, before = INFINITY;
    bool good = false;
    for (int n = 0; n < 40 && !good; n++) {
        now = residual(e, f, z);
        if (now < 1e-17L || (now < 1e-15L && now >= before)) good = true;
        else if (now > 10 || !newton_step(e, step, z)) break;
        else for (int64_t c = 0; c < e->contacts; c++) e->force[c] += step[c];
        before = now;
    }
    free(z), free(step);
    return good;
}

bool exact_move(exact *e, long double f)
{
    const int64_t n = e->contacts;
    long double *kept = vector(n), step = f - e->load;
    int tries = 0;
    if (e->load <= 0 && f > 0) step = f / 16; /* from nothing, in small steps: Newton must not jump over the end */
    while (e->load < f && tries < 60) {
        const long double next = e->load + step < f ? e->load + step : f;
        memcpy(kept, e->force, (size_t)n * sizeof *kept);
        if (solve_at(e, next) && (e->lambda = largest_eigenvalue(e)) < 1) {
            e->load = next;
        } else {
            memcpy(e->force, kept, (size_t)n * sizeof *kept);
            step /= 2;
            tries++;
            if (step < 1e-7L * f) break;
        }
    }
    free(kept);
    return e->load >= f;
}

long double exact_end(const scene *s, long double limit, long double precision)
{
    exact e;
    exact_init(&e, s);
    long double low = 0, high = limit;
    if (exact_move(&e, limit)) low = INFINITY;
    else low = e.load, high = fminl(limit, low + 4e-7L * limit); /* it stops there: see its shortest step */
    while (low < high && high - low > precision * high) {
        low = e.load;
        const long double middle = (low + high) / 2;
        if (exact_move(&e, middle)) low = middle;
        else high = middle;
    }
    exact_free(&e);
    return low;
}
