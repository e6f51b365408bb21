/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * schwarz.c - weakened equations, particle by particle.
 *
 * Where x is off by z, the residual r of x = gamma + sum of t_k C_k P(x) is about z - sum of t_k C_k D z, D the slopes dP/dx.  Each
 * particle can be asked alone: (1 - t_k C_k D) z = r over its contacts.  A contact has two answers, and takes their mean, with
 * weights by how the two particles yield: the additive Schwarz method.  It halves the sweeps of an iteration, for the price of one
 * block of each particle, of which the bound needs many more.  That t_k changes with x, too, is left out: no sweep would be saved.
 *
 * With S = D^1/2 C_k D^1/2 and y = D^1/2 z the system is symmetric, (1/t_k - S) y = D^1/2 r / t_k, and positive: t_k b_k < 1 (bound.h).
 */
#include "block.h"
#include "collective.h"
#include "iteration.h"

/* L L^T y = y in place, with L from nlc_is_below: the inverse of its diagonal stands there. */
static void solve_triangles(const double *L, int rows, double *y)
{
    for (int a = 0; a < rows; a++) {
        for (int d = 0; d < a; d++) y[a] -= L[a * rows + d] * y[d];
        y[a] *= L[a * rows + a];
    }
    for (int a = rows - 1; a >= 0; a--) {
        for (int d = a + 1; d < rows; d++) y[a] -= L[d * rows + a] * y[d];
        y[a] *= L[a * rows + a];
    }
}

/*
 * L L^T = beta 1 - S in the place of S.  A particle that has its contacts to itself, as between walls, is critical all alone: t S
 * then has an eigenvalue of t b, but t falls as its forces grow, so that this mode's own feedback is 2/3 of that: P ~ x^(3/2), t ~ x^(-1/2).
 * Otherwise it is about half of that or less.  Returns beta, 0 if there is none.
 */
static double factorise(double *S, int rows, double t)
{
    double diagonal[NLC_BLOCK];
    for (int a = 0; a < rows; a++) diagonal[a] = S[a * rows + a];
    const double beta = t < 1 && !nlc_is_below(S, rows, 2 / (3 * t)) ? 3 / (2 * t) : 1 / t;
    for (int a = 0; a < rows; a++) { /* it was destroyed below the diagonal */
        S[a * rows + a] = diagonal[a];
        for (int d = 0; d < a; d++) S[a * rows + d] = S[d * rows + a];
    }
    return nlc_is_below(S, rows, beta) ? beta : 0;
}

/* A particle's answer, into its sides: where it has none, r as it is. */
static void ask(nlc_network *n, const double *normal, int64_t k, const double *r)
{
    double S[NLC_BLOCK * NLC_BLOCK], y[NLC_BLOCK];
    int64_t side[NLC_BLOCK];
    const double t = n->weakening[k];
    const int rows = t > 1e-100 ? nlc_block_matrix(S, side, n, normal, k) : -1;
    const double beta = rows > 0 ? factorise(S, rows, t) : 0;
    for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) n->side[n->entry[p]] = r[n->entry[p] >> 1];
    if (beta <= 0) return;
    for (int a = 0; a < rows; a++) y[a] = sqrt(n->slope[side[a] >> 1]) * r[side[a] >> 1] * beta;
    solve_triangles(S, rows, y);
    for (int a = 0; a < rows; a++) {
        const int64_t c = side[a] >> 1;
        n->side[side[a]] = y[a] / sqrt(n->slope[c]);
        if (n->i[c] == n->j[c]) n->side[side[a] ^ 1] = n->side[side[a]];
    }
}

void nlc_ask_particles(nlc_iteration *q, const double *x, double *r, nlc_outcome *out)
{
    nlc_network *n = q->n;
    for (int64_t c = 0; c < n->contact_count; c++) {
        n->slope[c] = 1.5 * nlc_scaled_stiffness(q, c) * sqrt(0.5 * (x[c] + fabs(x[c])));
        n->share[2 * c] = nlc_yield_of(n, n->i[c]) > 0; /* undivided: of a contact each particle sees the whole slope */
        n->share[2 * c + 1] = nlc_yield_of(n, n->j[c]) > 0;
    }
    for (int64_t k = 0; k < n->owned; k++) {
        if (!(n->scale[k] > 0) || n->start[k] == n->start[k + 1]) continue;
        ask(n, q->normal, k, r);
        out->info.blocks++;
    }
    nlc_exchange_sides(n, n->side);
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double a = n->unit * nlc_yield_of(n, n->i[c]), b = n->unit * nlc_yield_of(n, n->j[c]);
        const double first = nlc_ratio(a, a + b), second = nlc_ratio(b, a + b); /* rigid on both sides: r as it is */
        r[c] = (1 - (first + second)) * r[c] + (first * n->side[2 * c] + second * n->side[2 * c + 1]);
    }
}
