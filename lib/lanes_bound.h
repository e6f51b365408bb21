/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * lanes_bound.h - whether the eigenvalues of particles' blocks (bound.h) are below a limit, with a particle in each lane of a
 * vector: a part of lanes.h.
 *
 * limit - B is decomposed into L diag(pivots) L^T; a pivot that is not positive shows an eigenvalue above the limit.
 */

#define ROWS_MAX 24   /* so that the triangles of all lanes stay in the first cache */
#define ROUNDED 1e-13 /* a pivot that is no more than this part of the limit may be rounding */

/* Where row c begins in a triangle without its diagonal. */
#define ROW(c) ((c) * ((c) - 1) / 2)

typedef struct triangle {
    _Alignas(8 * LANES) double at[ROW(ROWS_MAX)][LANES];
} triangle;

/* -B below the diagonal; on it there is nothing. */
TARGET static void set_blocks(triangle *A, group *g)
{
    const vec c0 = load(g->c0), c1 = load(g->c1), c2 = load(g->c2);
    vec closest = set(4);
    for (int64_t c = 0; c < g->places; c++) {
        const place *a = &g->at[c];
        const vec x = load(a->x), y = load(a->y), z = load(a->z), root = load(a->weight);
        for (int64_t d = 0; d < c; d++) {
            const vec t = squared_distance(x, y, z, &g->at[d]);
            closest = min(closest, t);
            store(A->at[ROW(c) + d], nmuladd(mul(coefficient(t, c0, c1, c2), root), load(g->at[d].weight), set(0)));
        }
    }
    store(g->closest, closest);
}

/* 1 / pivot; of one that is not positive 0: nothing is to be relied on from there, but nothing grows beyond bounds. */
TARGET static inline vec inverse_of(vec pivot, double limit)
{
    const vec least = set(ROUNDED * limit), positive = min(set(1), max(set(0), mul(sub(pivot, least), set(0x1p200))));
    return mul(positive, div(set(1), max(pivot, least)));
}

/* The least pivot of each lane. */
TARGET static void find_pivots(triangle *A, group *g, double limit)
{
    _Alignas(8 * LANES) double inverse[ROWS_MAX][LANES]; /* of the pivots */
    vec least = set(limit);
    for (int64_t a = 0; a < g->places; a++) {
        double(*row)[LANES] = A->at + ROW(a);
        vec pivot = set(limit);
        for (int64_t d = 0; d < a; d++) { /* L times the pivots */
            double(*above)[LANES] = A->at + ROW(d);
            vec s = load(row[d]);
            for (int64_t m = 0; m < d; m++) s = nmuladd(load(row[m]), load(above[m]), s);
            store(row[d], s);
        }
        for (int64_t d = 0; d < a; d++) {
            const vec s = load(row[d]), of_L = mul(s, load(inverse[d]));
            pivot = nmuladd(s, of_L, pivot);
            store(row[d], of_L);
        }
        least = min(least, pivot);
        store(inverse[a], inverse_of(pivot, limit));
    }
    store(g->squares, least);
}

/* Sets n->changed of the particles from first to end: 0 if its block is shown to be below the limit. */
static void mark_above(nlc_network *n, const double *root, const double *normal, double limit, int64_t first, int64_t end)
{
    group g;
    triangle A;
    int32_t sorted[NLC_WINDOW];
    const int count = sort(sorted, n, first, end);
    for (int64_t k = first; k < end; k++) n->changed[k] = n->scale[k] != 0;
    for (int q = 0; q < count; q += LANES) {
        choose(&g, n, sorted + q, count - q);
        if (g.places > ROWS_MAX) continue;
        fill(&g, n, ROOTS, root, normal, false);
        set_blocks(&A, &g);
        find_pivots(&A, &g, limit);
        for (int l = 0; l < LANES; l++) n->changed[g.particle[l]] = !(g.squares[l] > ROUNDED * limit && g.closest[l] >= NEAR);
    }
}
