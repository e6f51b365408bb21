/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * norm_bound.c - an upper bound of lambda that comes with a sweep.
 *
 * With the shares U_i / (U_i + U_j) a particle's block (bound.h) has the elements
 *     k_cd (w_c w_d)^1/2,   w = D (U_i + U_j),
 * and no diagonal, so that its largest eigenvalue is at most ((m-1)/m sum of k^2 w w)^1/2 for m contacts (block.h).
 */
#include "bound.h"
#include "structs.h"
#include "warm.h"

#define FEW 8        /* a particle in so many may have its block looked at, each element of it */

/* The particle's contacts with their weights; false: they do not fit. */
static bool gather(nlc_block *b, const nlc_iteration *q, int64_t particle)
{
    const nlc_network *n = q->n;
    const int64_t begin = n->start[particle], count = n->start[particle + 1] - begin;
    *b = (nlc_block){.count = (int)count};
    if (count > NLC_BLOCK) return false;
    for (int d = 0; d < b->count; d++) {
        const int64_t e = nlc_side_at(n, q->normal, begin + d);
        nlc_set_direction(b, d, q->normal, e);
        b->force[d] = n->share[2 * (e >> 1) + 1];
        b->shape[d] = b->tilt[d] = 0;
    }
    return true;
}

/* Sum of k^2 w w over the pairs of a particle. */
static double squares(const nlc_iteration *q, int64_t particle)
{
    const nlc_network *n = q->n;
    nlc_block b;
    if (n->scale[particle] <= 0 || n->start[particle + 1] - n->start[particle] < 2) return 0;
    return gather(&b, q, particle) ? n->settings.model->squares(&b, nlc_kernel_of(n, particle)) : INFINITY;
}

/* Whether the particle's block has no eigenvalue above beta: by its elements, for blocks whose squares say too little. */
static bool is_below(const nlc_iteration *q, int64_t particle, double beta)
{
    nlc_block b;
    double B[NLC_BLOCK * NLC_BLOCK], k[NLC_BLOCK];
    if (!gather(&b, q, particle)) return false;
    for (int c = 0; c < b.count; c++) {
        q->n->settings.model->coefficients(k, &b, c, nlc_kernel_of(q->n, particle));
        for (int d = 0; d < c; d++) B[c * b.count + d] = k[d] * sqrt(b.force[c]) * sqrt(b.force[d]);
        B[c * b.count + c] = 0;
    }
    return nlc_is_below(B, b.count, beta);
}

double nlc_bound_by_norms(const nlc_iteration *q, double beta, nlc_info *info)
{
    const nlc_network *n = q->n;
    const bool known = nlc_variant_of(n);
    double largest = 0;
    int64_t looks = n->owned / FEW + 1;
    info->critical_particle = -1;
    for (int64_t k = 0; k < n->owned; k++) {
        const double m = (double)(n->start[k + 1] - n->start[k]), sum = known ? n->norm[k] : squares(q, k);
        double b = 2 * sum * (m - 1) / (m + (m < 1));
        if (!(b <= beta * beta)) {
            if (looks-- == 0) return 1;
            info->blocks++;
            if (!is_below(q, k, beta)) return 1;
            b = beta * beta;
        }
        if (b <= largest) continue;
        largest = b;
        info->critical_particle = k;
    }
    return sqrt(largest);
}
