/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * energy.c - elastic energy of a solution.
 *
 * E(gamma) = gamma.P + P.C.P / 2 - sum (3/5) P (P/k)^(2/3), minus the functional of which [GC] 7 is the stationary point: an
 * error of the forces enters by its square.
 */
#include "network.h"
#include "structs.h"

/* Beyond this many tolerances the forces are no solution of the equations: weakened, lagged, another scene's. */
#define SOLUTION 10
#define ROUNDING 1e-13 /* what no solution can be asked to be better than */

typedef struct sum {
    double energy, residual;
    int64_t worst;
} sum;

/* Above the overlaps, the displacements after a sweep, and what the forces would need as overlaps. */
static int largest_exponent(const nlc_network *n, const double *force, const double *overlap)
{
    int e = nlc_exponent_above(nlc_largest_magnitude(overlap, n->contact_count));
    const int g = nlc_exponent_above(nlc_largest_magnitude(n->side, 2 * n->contact_count)) + 1;
    e = g > e ? g : e;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const int own = (nlc_exponent_above(force[c]) - nlc_exponent_above(n->stiffness[c])) * 2 / 3 + 2;
        if (force[c] > 0 && own > e) e = own;
    }
    return e;
}

/* After a sweep of the forces: by how much they miss the law. */
static void find_residual(nlc_network *n, const double *force, const double *overlap, double per_force, double per_overlap, sum *s)
{
    const double most = nlc_join(1, nlc_exponent_above(nlc_largest_magnitude(force, n->contact_count)) + 40);
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double p = force[c] * per_force, gamma = overlap[c] * per_overlap;
        const double g = (n->side[2 * c] + n->side[2 * c + 1]) * per_overlap;
        const double a = n->largest[n->i[c]], b = n->largest[n->j[c]], scale = (a > b ? a : b) * per_force;
        const double law = nlc_hertz_force(n->stiffness[c], (gamma + g) / per_overlap);
        const double size = fabs((law < most ? law : most) * per_force - p);
        const double ratio = nlc_is_finite(size) ? nlc_ratio(size, scale) : 1e10;
        if (ratio <= s->residual) continue;
        s->residual = ratio;
        s->worst = c;
    }
}

/* After a sweep for the energy; everything relative to the largest force and overlap. */
static void add_up(const nlc_network *n, const double *force, const double *overlap, double per_force, double per_overlap, sum *s)
{
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double own = nlc_hertz_overlap(n->stiffness[c], force[c]) * per_overlap;
        const double g = (n->side[2 * c] + n->side[2 * c + 1]) * per_overlap;
        s->energy += force[c] * per_force * (overlap[c] * per_overlap + 0.5 * g - 0.6 * own);
    }
}

nlc_status nlc_energy(nlc_network *network, double *NLC_RESTRICT energy, const double *NLC_RESTRICT force,
                      const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info)
{
    nlc_info record = nlc_new_info();
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    if (!energy) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!network->settings.model->potential) return nlc_error(info, NLC_ERROR_NO_POTENTIAL, network->settings.number);
    const int64_t count = network->contact_count;
    if (count > 0 && !force) return nlc_error(info, NLC_ERROR_NULL, 2);
    if (count > 0 && !overlap) return nlc_error(info, NLC_ERROR_NULL, 3);
    if (count > 0 && !normal) return nlc_error(info, NLC_ERROR_NULL, 4);
    if ((record.culprit = nlc_first_not_force(force, count)) >= 0) return nlc_report(info, &record, NLC_ERROR_FORCE);
    if ((record.culprit = nlc_first_not_finite(overlap, count)) >= 0) return nlc_report(info, &record, NLC_ERROR_OVERLAP);
    if ((record.culprit = nlc_first_not_unit(normal, count)) >= 0) return nlc_report(info, &record, NLC_ERROR_NORMAL);
    const int p = nlc_exponent_above(nlc_largest_magnitude(force, count));
    nlc_set_units(network, 0, 0);
    network->cached = false;
    record.sweeps = 1;
    nlc_status status = nlc_displace(network, NLC_OF_FORCES, force, normal, &record.culprit);
    if (status != NLC_OK) return nlc_report(info, &record, status);
    const int x = largest_exponent(network, force, overlap);
    if (p + x + nlc_exponent_above((double)count) > 1000 || p > 1000 || x > 1000) return nlc_report(info, &record, NLC_ERROR_RANGE);
    const double per_force = nlc_pow2(p < -1000 ? 1000 : -p), per_overlap = nlc_pow2(x < -1000 ? 1000 : -x);
    sum s = {0, 0, -1};
    find_residual(network, force, overlap, per_force, per_overlap, &s);
    if (network->settings.model->self) {
        record.sweeps++;
        status = nlc_displace(network, NLC_OF_ENERGY, force, normal, &record.culprit);
        if (status != NLC_OK) return nlc_report(info, &record, status);
    }
    add_up(network, force, overlap, per_force, per_overlap, &s);
    *energy = nlc_join(s.energy, (p < -1000 ? -1000 : p) + (x < -1000 ? -1000 : x));
    record.residual = s.residual;
    record.worst_contact = s.worst;
    for (int64_t c = 0; c < count; c++) record.active += force[c] > 0;
    const double allowed = SOLUTION * network->settings.tolerance;
    status = s.residual > (allowed > ROUNDING ? allowed : ROUNDING) ? NLC_WARNING_NOT_CONVERGED : NLC_OK;
    return nlc_report(info, &record, status);
}
