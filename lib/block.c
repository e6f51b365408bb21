/* SPDX-License-Identifier: BSD-2-Clause */
/* block.c - one particle's block: bounds and the largest eigenvalue. */
#include "block.h"

#include "bound.h"
#include "contact.h"

#include <string.h>

#include "small.h"

#define LANCZOS_MIN 16 /* steps until a Ritz value has grown out of the start */
#define LANCZOS_MAX 64
#define LANCZOS_GOOD 0.02 /* residual over distance from 1 at which an estimate is good enough */

static bool is_self(const nlc_network *n, int64_t e)
{
    return n->i[e >> 1] == n->j[e >> 1];
}

/* D / share of a side. */
static double weight_of(const nlc_network *n, int64_t e)
{
    const double share = n->share[e];
    return (share > 0) * n->slope[e >> 1] / (share + (share <= 0));
}

static double capped(double v)
{
    return v > NLC_LARGEST_ELEMENT ? NLC_LARGEST_ELEMENT : v < -NLC_LARGEST_ELEMENT ? -NLC_LARGEST_ELEMENT : v;
}

/* What contacts do to themselves. */
static double own_of(const nlc_network *n, int64_t e)
{
    return n->settings.model->self && n->settings.model->potential ? n->own[e] : 0;
}

/* The sides of a particle whose contacts have D > 0; false if they do not fit.  force is the weight. */
static bool gather_active(nlc_block *b, int64_t *entry, const nlc_network *n, const double *normal, int64_t particle)
{
    const bool circles = n->settings.model->shape == NLC_SHAPE_MOMENTS;
    b->tilted = false;
    b->count = 0;
    for (int64_t p = n->start[particle]; p < n->start[particle + 1]; p++) {
        const int64_t e = nlc_side_at(n, normal, p);
        if (n->slope[e >> 1] <= 0) continue;
        if (b->count == NLC_BLOCK) return false;
        nlc_set_direction(b, b->count, normal, e);
        b->force[b->count] = weight_of(n, e);
        b->shape[b->count] = circles ? nlc_circle2(n, e, particle) * nlc_circle_change(n, e >> 1) : 0; /* as the tangent has it */
        b->tilt[b->count] = circles ? nlc_tilt(n, e, particle) : 0;
        b->tilted |= circles && fabs(b->tilt[b->count]) > NLC_NO_TILT;
        entry[b->count++] = e;
    }
    return true;
}

double nlc_block_norm(const nlc_network *n, const double *normal, int64_t particle)
{
    nlc_block b;
    int64_t entry[NLC_BLOCK];
    if (!gather_active(&b, entry, n, normal, particle)) return INFINITY;
    if (b.count == 0) return 0;
    const double U = nlc_scale_of(n, particle), m = b.count;
    double squares = 2 * U * U * n->settings.model->squares(&b, nlc_kernel_of(n, particle)), trace = 0;
    for (int c = 0; c < b.count; c++) {
        const double v = capped(b.force[c] * own_of(n, entry[c]));
        trace += v;
        squares += v * v;
    }
    const double rest = squares - trace * trace / m;
    return trace / m + sqrt(0.5 * (rest + fabs(rest)) * (m - 1) / m);
}

int nlc_block_matrix(double *B, int64_t *side, const nlc_network *n, const double *normal, int64_t particle)
{
    nlc_block b;
    int64_t entry[NLC_BLOCK];
    double root[NLC_BLOCK], coefficient[NLC_BLOCK];
    int row[NLC_BLOCK], rows = 0;
    if (!gather_active(&b, entry, n, normal, particle)) return -1;
    for (int a = 0; a < b.count; a++) {
        const bool self = is_self(n, entry[a]);
        row[a] = self && a > 0 && entry[a] >> 1 == entry[a - 1] >> 1 ? rows - 1 : rows;
        rows = row[a] + 1;
        side[row[a]] = entry[a];
        root[a] = sqrt(self ? n->slope[entry[a] >> 1] : b.force[a]);
    }
    const double U = nlc_scale_of(n, particle);
    memset(B, 0, (size_t)(rows * rows) * sizeof *B);
    for (int a = 0; a < b.count; a++) {
        B[row[a] * rows + row[a]] += capped(root[a] * root[a] * own_of(n, entry[a]));
        n->settings.model->coefficients(coefficient, &b, a, nlc_kernel_of(n, particle));
        for (int d = 0; d < a; d++) {
            const double v = capped(U * coefficient[d] * root[a] * root[d]);
            B[row[a] * rows + row[d]] += v;
            B[row[d] * rows + row[a]] += v;
        }
    }
    return rows;
}

/* The contacts of a particle with D > 0, each once. */
static int64_t next(const nlc_network *n, int64_t particle, int64_t *place)
{
    while (*place < n->start[particle + 1]) {
        const int64_t e = n->entry[(*place)++];
        if (n->slope[e >> 1] > 0 && !(is_self(n, e) && e & 1)) return e;
    }
    return -1;
}

static double root_weight(const nlc_network *n, int64_t e)
{
    return sqrt(is_self(n, e) ? n->slope[e >> 1] : weight_of(n, e));
}

#define EACH_CONTACT(e) for (int64_t place = n->start[k], e = next(n, k, &place); e >= 0; e = next(n, k, &place))

/* w = B v; in is overwritten */
static void apply(nlc_network *n, const double *normal, int64_t k, double *w, const double *v, double *in)
{
    for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) in[n->entry[p] >> 1] = 0;
    EACH_CONTACT(e) in[e >> 1] = root_weight(n, e) * v[e >> 1];
    nlc_displace_particle(n, NLC_OF_CHANGES, in, normal, k);
    EACH_CONTACT(e)
    {
        const double u = n->side[e] + (is_self(n, e) ? n->side[e ^ 1] : 0);
        w[e >> 1] = capped(root_weight(n, e) * u);
    }
}

/* Last component of the tridiagonal matrix' eigenvector of norm 1, from the recurrence upwards. */
static double last_component(const double *a, const double *b, int n, double theta)
{
    double y = 1, before = 0, norm = 1;
    for (int l = n - 1; l > 0 && norm < 1e100; l--) {
        const double z = capped(((theta - a[l]) * y - (l < n - 1 ? b[l] * before : 0)) / b[l - 1]);
        before = y;
        y = z;
        norm += z * z;
    }
    return 1 / sqrt(norm);
}

/*
 * A number in [-1, 1) that looks random, from a direction: a start that is orthogonal to no mode, however symmetric the
 * contacts are, and the same whatever they are called.
 */
static double scattered(const double *v, double out)
{
    uint64_t h = 0;
    for (int x = 0; x < 3; x++) { /* + 0 makes -0 a 0; the mixing is that of splitmix64 */
        h += nlc_bits(out * v[x] + 0.0) + UINT64_C(0x9e3779b97f4a7c15);
        h = (h ^ (h >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
        h = (h ^ (h >> 27)) * UINT64_C(0x94d049bb133111eb);
        h ^= h >> 31;
    }
    return (double)(h >> 11) * 0x1p-52 - 1;
}

/* How far below low or above high it is nobody wants to know. */
static double lanczos(nlc_network *n, const double *normal, int64_t k, double low, double high)
{
    double a[LANCZOS_MAX], b[LANCZOS_MAX], *v = n->lanczos[0], *w = n->lanczos[1], *in = n->lanczos[2], norm = 0, upper = 0;
    EACH_CONTACT(e)
    {
        v[e >> 1] = scattered(normal + 3 * (e >> 1), is_self(n, e) ? 1 : nlc_outward(e));
        norm += v[e >> 1] * v[e >> 1];
        w[e >> 1] = 0;
    }
    EACH_CONTACT(e) v[e >> 1] /= sqrt(norm);
    for (int m = 0; m < LANCZOS_MAX; m++) { /* v is the present vector, w the one before */
        double *out = in, along = 0, rest = 0;
        apply(n, normal, k, n->lanczos[3], v, in);
        EACH_CONTACT(e)
        {
            out[e >> 1] = n->lanczos[3][e >> 1] - (m > 0 ? b[m - 1] : 0) * w[e >> 1];
            along += out[e >> 1] * v[e >> 1];
        }
        EACH_CONTACT(e)
        {
            out[e >> 1] -= along * v[e >> 1];
            rest += out[e >> 1] * out[e >> 1];
        }
        a[m] = along;
        b[m] = sqrt(rest);
        const double theta = nlc_largest_tridiagonal(a, b, m + 1), residual = b[m] * last_component(a, b, m + 1, theta);
        upper = theta + residual;
        if (theta > high || (m >= LANCZOS_MIN && upper <= low)) break; /* a Ritz value is a lower bound */
        if ((m >= LANCZOS_MIN && residual < LANCZOS_GOOD * fabs(1 - theta)) || b[m] <= 1e-12 * fabs(theta)) break;
        EACH_CONTACT(e)
        {
            w[e >> 1] = v[e >> 1];
            v[e >> 1] = out[e >> 1] / b[m];
        }
    }
    return upper;
}

/* In a model without a potential the coefficients of Case I decide, here too: its own are not symmetric. */
static double estimate(nlc_network *n, const double *normal, int64_t k, double low, double high)
{
    const nlc_model *model = n->settings.model;
    if (!model->potential) n->settings.model = &nlc_half_space_undeformed;
    const double upper = lanczos(n, normal, k, low, high);
    n->settings.model = model;
    return upper;
}

bool nlc_block_is_below(nlc_network *n, const double *normal, int64_t particle, double beta)
{
    double B[NLC_BLOCK * NLC_BLOCK];
    int64_t side[NLC_BLOCK];
    const int rows = nlc_block_matrix(B, side, n, normal, particle);
    return rows < 0 ? estimate(n, normal, particle, beta, beta) <= beta : nlc_is_below(B, rows, beta);
}

double nlc_block_eigenvalue(nlc_network *n, const double *normal, int64_t particle)
{
    double B[NLC_BLOCK * NLC_BLOCK], work[4 * NLC_BLOCK];
    int64_t side[NLC_BLOCK];
    const int rows = nlc_block_matrix(B, side, n, normal, particle);
    if (rows < 0) return estimate(n, normal, particle, NLC_BOUND_FLOOR, INFINITY);
    return rows > 0 ? nlc_largest_eigenvalue(B, rows, work) : 0;
}
