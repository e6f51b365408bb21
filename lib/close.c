/* SPDX-License-Identifier: BSD-2-Clause */
/* close.c - circles of contact that overlap each other: point forces are no model of these. */
#include "close.h"

#include "parallel.h"
#include "tree.h"

#define NO_CIRCLE -4.0 /* radii are at most 2 */

static double alone(const nlc_network *n, const double *overlap, int64_t c)
{
    return nlc_alone(overlap[c], nlc_answer(n, c));
}

/*
 * Radius of a contact's circle, a^2 = R_eff x with 1/R_eff = 1/R_i + 1/R_j ([GC] 7 and 8), in units of the particle's R.  One
 * that its neighbour has pushed open counts with the circle that it would have alone: there might be another solution, in
 * which it is the neighbour that is open.  An open one that would be open alone, too, has no circle: so far below 0 that its sum with
 * any other radius is, whether it is looked at or left out of the iteration makes no difference.
 */
static double radius_of(const nlc_network *n, int64_t c, int64_t particle, const double *overlap)
{
    const int64_t other = n->i[c] == particle ? n->j[c] : n->i[c];
    const bool wall = other >= n->particle_count;
    const double x = alone(n, overlap, c), R = n->radius[particle];
    const double r = wall ? 0 : R, s = wall ? 1 : n->radius[other], larger = r > s ? r : s;
    if (x <= 0) return NO_CIRCLE;
    const double quarter = 0.125 * (x + fabs(x)), capped = quarter < R ? quarter : R; /* a beyond 2 R is as good as 2 R */
    /* R_eff / R = s / (r + s), by ratios that are at most 1; of a choice between quotients clang 16 computes both */
    return 2 * sqrt(capped / R * (s / larger / (r / larger + s / larger)));
}

/* By how much the square of a + b exceeds that of the distance, summed over the pairs where it does.  v + |v| is no choice. */
static double excess(const nlc_block *a, const nlc_block *b, int c, int count)
{
    double sum[NLC_BLOCK], total = 0;
    for (int d = 0; d < count; d++) {
        const double x = a->x[c] - b->x[d], y = a->y[c] - b->y[d], z = a->z[c] - b->z[d], r = a->force[c] + b->force[d];
        const double v = r * fabs(r) - (x * x + y * y + z * z);
        sum[d] = v + fabs(v);
    }
    for (int d = 0; d < count; d++) total += sum[d];
    return total;
}

/* The force of this block is the radius. */
static void gather_circles(nlc_block *b, const nlc_network *n, const double *overlap, const double *normal, int64_t particle,
                           int64_t begin, int64_t end)
{
    b->count = (int)(end - begin);
    for (int d = 0; d < b->count; d++) {
        const int64_t e = n->entry[begin + d];
        nlc_set_direction(b, d, normal, e);
        b->force[d] = radius_of(n, e >> 1, particle, overlap);
    }
}

static bool overlap_on(const nlc_network *n, int64_t k, const double *overlap, const double *normal)
{
    const int64_t end = n->start[k + 1];
    nlc_block a, b;
    double least;
    if (nlc_least_apart(&least, n, normal, k, radius_of, overlap, 0)) return least < 0;
    for (int64_t p = n->start[k]; p < end; p += NLC_BLOCK) {
        const int64_t p_end = end - p > NLC_BLOCK ? p + NLC_BLOCK : end;
        gather_circles(&a, n, overlap, normal, k, p, p_end);
        for (int c = 1; c < a.count; c++)
            if (excess(&a, &a, c, c) > 0) return true;
        for (int64_t q = p_end; q < end; q += NLC_BLOCK) {
            gather_circles(&b, n, overlap, normal, k, q, end - q > NLC_BLOCK ? q + NLC_BLOCK : end);
            for (int c = 0; c < a.count; c++)
                if (excess(&a, &b, c, b.count) > 0) return true;
        }
    }
    return false;
}

typedef struct job {
    const nlc_network *n;
    const double *overlap, *normal;
    double largest; /* reduced overlap */
} job;

/* Whether circles of radii up to (R reduced)^1/2 may overlap on a particle. */
static bool may_overlap(const nlc_network *n, int64_t particle, double reduced)
{
    return reduced >= 0.249 * n->closest[particle] * n->radius[particle];
}

static void reduce_task(void *work, int64_t s)
{
    const job *w = work;
    double largest = 0;
    for (int64_t c = s * NLC_SLAB; c < nlc_end_of(s, NLC_SLAB, w->n->contact_count); c++)
        largest = nlc_larger_circle(w->n, c, alone(w->n, w->overlap, c), largest);
    w->n->piece[s].force = largest;
}

static bool is_close(const job *w, int64_t k)
{
    const nlc_network *n = w->n;
    double here = 0;
    if (n->scale[k] <= 0 || !may_overlap(n, k, w->largest)) return false;
    for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
        const int64_t c = n->entry[p] >> 1;
        here = nlc_larger_circle(n, c, alone(n, w->overlap, c), here);
    }
    return may_overlap(n, k, here) && overlap_on(n, k, w->overlap, w->normal);
}

/* Whether a look at its pairs grows a tree, for which there is room once. */
static bool wants_tree(const nlc_network *n, int64_t k)
{
    return n->start[k + 1] - n->start[k] >= NLC_TREE_FROM;
}

static void close_task(void *work, int64_t v)
{
    const job *w = work;
    bool close = false;
    for (int64_t k = v * NLC_WINDOW; k < nlc_end_of(v, NLC_WINDOW, w->n->owned) && !close; k++)
        close = !wants_tree(w->n, k) && is_close(w, k);
    w->n->piece[v].flag[0] = close;
}

/* The largest reduced overlap of all contacts. */
static double largest_circle(job *all)
{
    const nlc_network *n = all->n;
    double largest = 0;
    if (n->answered) return n->top.circle;
    nlc_for(n, reduce_task, all, nlc_slabs(n));
    for (int64_t s = 0; s < nlc_slabs(n); s++) largest = n->piece[s].force > largest ? n->piece[s].force : largest;
    return largest;
}

/* Most particles need no look at pairs: their circles are too small for the distance of the closest two directions. */
bool nlc_circles_overlap(const nlc_network *n, const double *overlap, const double *normal)
{
    job all = {n, overlap, normal, 0};
    bool close = false;
    all.largest = largest_circle(&all);
    nlc_for(n, close_task, &all, nlc_windows(n));
    for (int64_t v = 0; v < nlc_windows(n); v++) close |= n->piece[v].flag[0];
    for (int64_t k = 0; k < n->owned && n->most_contacts >= NLC_TREE_FROM && !close; k++)
        close = wants_tree(n, k) && is_close(&all, k);
    return close;
}
