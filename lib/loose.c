/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * loose.c - scenes so loose, for the tolerance asked for, that all forces are those of Hertz.
 *
 * Let F_k be the sum of Hertz's forces on particle k, and suppose that no true sum exceeds 2 F_k.  Then no displacement exceeds
 *     G_c = 2 (F_i m_i + F_j m_j),   m_k the largest coefficient on k,
 * and no force k_c (gamma_c + G_c)_+^(3/2).  If these forces add up to 2 F_k at most on every particle, the displacements within
 * G_c are mapped into themselves, so that the solution is among them, at this load and at every lower one; and its forces differ
 * from those of Hertz by what the law makes of G_c.
 */
#include "iteration.h"
#include "tree.h"

#define DOUBT 2.0 /* sums of forces, in units of Hertz's */

/* A scene that is not loose shows it at the first contact with a force: it would move others like itself by too much. */
static bool may_be_loose(const nlc_network *n, const double *overlap)
{
    for (int64_t c = 0; c < n->contact_count; c++) {
        if (!(overlap[c] > 0)) continue;
        const double a = nlc_yield_of(n, n->i[c]), b = nlc_yield_of(n, n->j[c]);
        return (a > b ? a : b) * n->stiffness[c] * sqrt(overlap[c]) <= n->settings.tolerance;
    }
    return false;
}

static double law(const nlc_iteration *q, int64_t c, double more)
{
    return nlc_law(nlc_scaled_stiffness(q, c), q->overlap[c] * q->load + more);
}

/* The smallest squared distance of two directions of a particle. */
static double nearest(const nlc_network *n, const double *normal, int64_t particle)
{
    double least = 4;
    if (nlc_least_apart(&least, n, normal, particle, 0, 0, 4)) return least;
    for (int64_t p = n->start[particle]; p < n->start[particle + 1]; p++)
        for (int64_t r = n->start[particle]; r < p; r++) {
            const int64_t e = n->entry[p], f = n->entry[r];
            const double *v = normal + 3 * (e >> 1), *w = normal + 3 * (f >> 1), turn = nlc_outward(e) * nlc_outward(f);
            const double x = v[0] - turn * w[0], y = v[1] - turn * w[1], z = v[2] - turn * w[2], t = x * x + y * y + z * z;
            least = t < least ? t : least;
        }
    return least;
}

/*
 * Of every particle: the sum of its forces into growth and the largest of them into largest, the largest coefficient into norm,
 * the displacement that its forces may cause into bound.  False: two directions are the same, or nearly.
 */
static bool find_displacements(const nlc_iteration *q)
{
    nlc_network *n = q->n;
    for (int64_t k = 0; k < n->particle_count; k++) {
        double sum = 0, top = 0, deepest = 0;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
            const double f = law(q, n->entry[p] >> 1, 0), x = q->overlap[n->entry[p] >> 1];
            sum += f;
            top = f > top ? f : top;
            deepest = x > deepest ? x : deepest;
        }
        n->growth[k] = sum;
        n->largest[k] = top;
        n->bound[k] = n->norm[k] = 0;
        if (n->scale[k] <= 0 || sum <= 0) continue;
        const double t = nearest(n, q->normal, k);
        if (deepest >= 0.25 * t * n->radius[k]) return false; /* circles of contact, a^2 <= R gamma, might overlap; or t = 0 */
        n->norm[k] = nlc_scale_of(n, k) * n->settings.model->most(nlc_kernel_of(n, k), sqrt(t));
        n->bound[k] = DOUBT * sum * n->norm[k];
    }
    return true;
}

/* Sum over the two bodies of a contact, walls having 0. */
static double both(const nlc_network *n, const double *values, int64_t c)
{
    const int64_t i = n->i[c], j = n->j[c];
    return (i < n->particle_count ? values[i] : 0) + (j < n->particle_count ? values[j] : 0);
}

bool nlc_is_loose(nlc_network *n, const double *overlap, const double *normal, nlc_outcome *out)
{
    nlc_iteration q;
    double lambda = 0, *sum = n->weakening;
    nlc_info info = out->info;
    if (!n->settings.model->most || !may_be_loose(n, overlap)) return false;
    nlc_iteration_units(&q, n, overlap, normal, 1);
    if (!find_displacements(&q)) return false;
    for (int64_t k = 0; k < n->particle_count; k++) {
        sum[k] = 0;
        n->norm[k] *= (double)(n->start[k + 1] - n->start[k]); /* now the largest row of C */
    }
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double G = both(n, n->bound, c), f = law(&q, c, G), change = f - law(&q, c, 0), x = overlap[c] * q.load + G;
        const double a = n->largest[n->i[c]], b = n->largest[n->j[c]], scale = a > b ? a : b;
        if (change > n->settings.tolerance * scale) return false;
        if (n->i[c] < n->particle_count) sum[n->i[c]] += f;
        if (n->j[c] < n->particle_count) sum[n->j[c]] += f;
        const double row = 1.5 * nlc_scaled_stiffness(&q, c) * sqrt(0.5 * (x + fabs(x))) * both(n, n->norm, c); /* of D |C| */
        lambda = row > lambda ? row : lambda;
        if (change <= info.residual * scale) continue;
        info.residual = nlc_ratio(change, scale);
        info.worst_contact = c;
    }
    for (int64_t k = 0; k < n->particle_count; k++)
        if (sum[k] > DOUBT * n->growth[k]) return false;
    if (lambda > 1 - NLC_MARGIN) return false;
    info.lambda_upper = lambda;
    info.lambda_lower = 0;
    out->info = info;
    return true;
}
