/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * directions.c - the vectors of the solver.
 *
 * All passes go over chunks that stay in the cache, and sums are taken in four lanes, chunk by chunk and slab by slab: always in the
 * same order, in one that compilers make vectors of and that threads may share.
 */
#include "collective.h"
#include "iteration.h"
#include "parallel.h"

#define CHUNK 256
#define CLAMP 0.005 /* 1 - theta is taken for no less: a step along a nearly critical direction stays finite */

static double dot(const double *a, const double *b, int count)
{
    double s[4] = {0, 0, 0, 0};
    int c = 0;
    for (; c + 3 < count; c += 4)
        for (int l = 0; l < 4; l++) s[l] += a[c + l] * b[c + l];
    for (; c < count; c++) s[0] += a[c] * b[c];
    return (s[0] + s[1]) + (s[2] + s[3]);
}

/*
 * Residuals z, and 1/D of the chord from the iterate to the force of the law, D = (Ph - P) / (y - (P/k)^(2/3)).  With s = y^(1/2) and
 * r = (P/k)^(1/3) that is k (s^2 + s r + r^2) / (s + r), without cancellation.  One Halley step from s finds
 * r = s (Ph + 2 P) / (2 Ph + P) where the two are close; elsewhere a cube root is taken.  All fractions, and the least D there may be,
 * are put on one line: a division costs most here.  Of what is open, and where stiffnesses are 1e150
 * apart, nothing is left but the least D: NLC_LINE keeps both lines from 0, in hosts that flush subnormal numbers to 0, too.
 */
static void residual(const nlc_iteration *q, int64_t c, double *z, double *inverse, double *force, nlc_extremes *extremes)
{
    const double k = nlc_scaled_stiffness(q, c), y = nlc_scaled_overlap(q, c), iterate = q->n->force[c];
    const double s = sqrt(0.5 * (y + fabs(y))), h = k * s * s * s, p = 0.5 * (iterate + fabs(iterate));
    const double a = s * (h + 2 * p), b = 2 * h + p, sb = s * b;
    const double below = (sb + a) * b + NLC_LINE, above = k * (sb * sb + sb * a + a * a), least = q->n->floor[c] * below;
    *force = h;
    *z = h - iterate;
    *inverse = below / (above > least ? above : least);
    extremes->residual = fabs(*z) > extremes->residual ? fabs(*z) : extremes->residual;
    extremes->force = h > extremes->force ? h : extremes->force;
    extremes->far |= iterate < 0 || iterate > NLC_FAR * h;
}

/* 1/D where the iterate is far from the force. */
static double far_inverse(const nlc_iteration *q, int64_t c)
{
    const double k = nlc_scaled_stiffness(q, c), y = nlc_scaled_overlap(q, c), iterate = q->n->force[c], floor = q->n->floor[c];
    const double s = sqrt(0.5 * (y + fabs(y))), r = iterate < 0 ? 0 : cbrt(iterate / k);
    const double slope = iterate < 0 ? 0 : k * (s * s + s * r + r * r) / (s + r + 1e-300);
    return 1 / (slope > floor ? slope : floor);
}

static void residuals(const nlc_iteration *q, int64_t from, int count, double *inverse, nlc_piece *piece)
{
    const nlc_variant *variant = q->n->settings.variant;
    double force[CHUNK], *z = q->n->direction[0] + from;
    nlc_extremes e = {piece->residual, piece->force, false};
    for (int c = variant ? variant->residuals(q, from, count, z, inverse, force, &e) : 0; c < count; c++)
        residual(q, from + c, z + c, inverse + c, force + c, &e);
    for (int c = 0; c < count && e.far; c++) {
        const double iterate = q->n->force[from + c];
        if (iterate < 0 || iterate > NLC_FAR * force[c]) inverse[c] = far_inverse(q, from + c);
    }
    piece->residual = e.residual;
    piece->force = e.force;
}

static void evaluate_chunk(const nlc_iteration *q, int64_t from, int count, nlc_piece *piece)
{
    const nlc_network *n = q->n;
    double inverse[CHUNK], scaled[CHUNK];
    residuals(q, from, count, inverse, piece);
    for (int a = 0; a < q->directions; a++) {
        for (int c = 0; c < count; c++) scaled[c] = n->direction[a][from + c] * inverse[c];
        for (int b = 0; b <= a; b++) piece->sum[a][b] += dot(scaled, n->direction[b] + from, count);
    }
}

#define EACH_CHUNK(q, slab, from, count) \
    for (int64_t from = (slab)*NLC_SLAB, end = nlc_end_of(slab, NLC_SLAB, (q)->n->contact_count), count = chunk(from, end); from < end; \
         from += CHUNK, count = chunk(from, end))

static int64_t chunk(int64_t from, int64_t end)
{
    return end - from < CHUNK ? end - from : CHUNK;
}

/* A symmetric matrix from the slabs' sums, which are below its diagonal. */
static void add_up(const nlc_iteration *q, nlc_small A)
{
    for (int a = 0; a < NLC_DIRECTIONS; a++)
        for (int b = 0; b <= a; b++) {
            double sum = 0;
            for (int64_t s = 0; s < nlc_slabs(q->n) && a < q->directions; s++) sum += q->n->piece[s].sum[a][b];
            A[a][b] = A[b][a] = sum;
        }
}

static nlc_piece *new_piece(const nlc_iteration *q, int64_t slab)
{
    nlc_piece *piece = &q->n->piece[slab];
    *piece = (nlc_piece){.bad = -1};
    return piece;
}

static void evaluate_task(void *work, int64_t slab)
{
    const nlc_iteration *q = work;
    nlc_piece *piece = new_piece(q, slab);
    EACH_CHUNK(q, slab, from, count) evaluate_chunk(q, from, (int)count, piece);
}

/* Contacts that are on two ranks count half on each: of M or K. */
static void halve_straddling(const nlc_iteration *q, nlc_small A, bool images)
{
    const nlc_network *n = q->n;
    for (int64_t s = 0; s < n->straddling; s++) {
        const int64_t at = nlc_straddling(n)[s];
        double z, inverse, force;
        nlc_extremes e = {0, 0, false};
        residual(q, at, &z, &inverse, &force, &e);
        if (e.far) inverse = far_inverse(q, at);
        for (int a = 0; a < q->directions; a++)
            for (int b = 0; b <= a; b++) {
                const double by = images ? n->image[b > 0 ? a : 0][at] : inverse * n->direction[a][at];
                A[a][b] -= 0.5 * by * n->direction[images && b == 0 ? a : b][at];
                A[b][a] = A[a][b];
            }
    }
}

void nlc_evaluate(nlc_iteration *q)
{
    q->largest_residual = q->largest_force = 0;
    nlc_for(q->n, evaluate_task, q, nlc_slabs(q->n));
    for (int64_t s = 0; s < nlc_slabs(q->n); s++) {
        const nlc_piece *piece = &q->n->piece[s];
        q->largest_residual = piece->residual > q->largest_residual ? piece->residual : q->largest_residual;
        q->largest_force = piece->force > q->largest_force ? piece->force : q->largest_force;
    }
    add_up(q, q->M);
    halve_straddling(q, q->M, false);
}

static void products_task(void *work, int64_t slab)
{
    const nlc_iteration *q = work;
    nlc_piece *piece = new_piece(q, slab);
    double **w = q->n->direction, **cw = q->n->image;
    EACH_CHUNK(q, slab, from, count)
    for (int a = 0; a < q->directions; a++)
        for (int b = 0; b <= a; b++) /* the image of the residual is fresh: it serves its whole row */
            piece->sum[a][b] += dot(cw[b > 0 ? a : 0] + from, w[b > 0 ? b : a] + from, (int)count);
}

void nlc_stiffness_products(nlc_iteration *q)
{
    nlc_for(q->n, products_task, q, nlc_slabs(q->n));
    add_up(q, q->K);
    halve_straddling(q, q->K, true);
}

bool nlc_products_over_ranks(nlc_iteration *q)
{
    double sums[NLC_DIRECTIONS * (NLC_DIRECTIONS + 1)];
    int count = 0;
    for (int a = 0; a < q->directions; a++)
        for (int b = 0; b <= a; b++) {
            sums[count++] = q->M[a][b];
            sums[count++] = q->K[a][b];
        }
    if (!nlc_sum_over_ranks(q->n, sums, count)) return false;
    count = 0;
    for (int a = 0; a < q->directions; a++)
        for (int b = 0; b <= a; b++) {
            q->M[a][b] = q->M[b][a] = sums[count++];
            q->K[a][b] = q->K[b][a] = sums[count++];
        }
    return true;
}

void nlc_choose_step(nlc_iteration *q)
{
    nlc_small Y;
    double theta[NLC_DIRECTIONS];
    const int n = q->directions, pairs = nlc_ritz(n, q->M, q->K, Y, theta);
    int first = -1, second = -1;
    for (int i = 0; i < n; i++) q->step[i] = q->ritz[0][i] = q->ritz[1][i] = 0;
    for (int r = 0; r < pairs; r++) {
        double along = 0, left = 1 - theta[r];
        for (int i = 0; i < n; i++) along += Y[i][r] * q->M[i][0];
        along /= left > CLAMP ? left : CLAMP;
        for (int i = 0; i < n; i++) q->step[i] += along * Y[i][r];
        if (first < 0 || theta[r] > theta[first]) {
            second = first;
            first = r;
        } else if (second < 0 || theta[r] > theta[second]) {
            second = r;
        }
    }
    q->theta = first < 0 ? 0 : theta[first];
    for (int i = 0; i < n; i++) {
        if (first >= 0) q->ritz[0][i] = Y[i][first];
        if (second >= 0) q->ritz[1][i] = Y[i][second];
    }
}

/* out = sum over the directions of a factor times it */
static void combine(double *out, double *const *direction, const double *factor, int directions, int64_t from, int count)
{
    for (int c = 0; c < count; c++) out[c] = factor[0] * direction[0][from + c];
    for (int d = 1; d < directions; d++)
        for (int c = 0; c < count; c++) out[c] += factor[d] * direction[d][from + c];
}

/* The step into total, and into the place of the directions that it was made of. */
static void step_chunk(const nlc_iteration *q, double *const *w, double *total, bool all, int64_t from, int count)
{
    double step[CHUNK], ritz[2][CHUNK];
    combine(step, w, q->step, q->directions, from, count);
    for (int r = 0; r < 2 && all; r++) combine(ritz[r], w, q->ritz[r], q->directions, from, count);
    for (int c = 0; c < count; c++) {
        total[from + c] += step[c];
        if (all) {
            w[2][from + c] = q->directions > 1 ? w[1][from + c] : 0;
            w[3][from + c] = ritz[0][c];
            w[4][from + c] = ritz[1][c];
        }
        w[1][from + c] = step[c];
    }
}

typedef struct job {
    const nlc_iteration *q;
    bool all;
} job;

static void step_task(void *work, int64_t slab)
{
    const job *s = work;
    const nlc_network *n = s->q->n;
    EACH_CHUNK(s->q, slab, from, count)
    {
        step_chunk(s->q, n->direction, n->force, s->all, from, (int)count);
        step_chunk(s->q, n->image, n->current, s->all, from, (int)count);
    }
}

void nlc_take_step(nlc_iteration *q, bool all)
{
    job step = {q, all};
    nlc_for(q->n, step_task, &step, nlc_slabs(q->n));
    q->directions = all ? NLC_DIRECTIONS : 2;
}
