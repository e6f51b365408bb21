/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * energy.c - elastic energy of a solution.
 *
 * E(gamma) = gamma.P + P.C.P / 2 - sum (3/5) P (P/k)^(2/3), minus the functional of which [GC] 7 is the stationary point: an
 * error of the forces enters by its square.
 */
#include "collective.h"
#include "structs.h"

/* Beyond this many tolerances the forces are no solution of the equations: weakened, lagged, another scene's. */
#define SOLUTION 10
#define FARTHEST 0x1p20 /* displacement, in units of the largest */
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

/* After a sweep of the forces: by how much they miss the law, whose forces count as no more than most. */
static void find_residual(nlc_network *n, const double *force, const double *overlap, double most, double per_force,
                          double per_overlap, sum *s)
{
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double p = force[c] * per_force, gamma = overlap[c] * per_overlap;
        const double g = (n->side[2 * c] + n->side[2 * c + 1]) * per_overlap;
        const double a = n->largest[n->i[c]], b = n->largest[n->j[c]], scale = (a > b ? a : b) * per_force;
        const double law = nlc_hertz_force(n->stiffness[c], (gamma + g) / per_overlap);
        const double size = fabs((law < most ? law : most) * per_force - p);
        const double ratio = nlc_ratio(size, scale);
        if (ratio <= s->residual) continue;
        s->residual = ratio;
        s->worst = c;
    }
}

/*
 * After a sweep for the energy; everything relative to the largest force and overlap, and no displacement that much larger, as that of
 * a ghost might be, of which the first sweep knew nothing.
 */
static void add_up(const nlc_network *n, const double *force, const double *overlap, double per_force, double per_overlap, sum *s)
{
    const double most = FARTHEST / per_overlap;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double own = nlc_hertz_overlap(n->stiffness[c], force[c]) * per_overlap;
        const double moved = n->side[2 * c] + n->side[2 * c + 1], g = (fabs(moved) < most ? moved : 0) * per_overlap;
        const double energy = force[c] * per_force * (overlap[c] * per_overlap + 0.5 * g - 0.6 * own);
        s->energy += nlc_is_straddling(n, c) ? 0.5 * energy : energy;
    }
}

static nlc_status check(const nlc_network *n, const double *energy, const double *force, const double *overlap,
                        const double *normal, int64_t *culprit)
{
    const double *const argument[4] = {energy, force, overlap, normal};
    const int64_t count = n->contact_count;
    *culprit = 1;
    if (!energy) return NLC_ERROR_NULL;
    *culprit = n->settings.number;
    if (!n->settings.model->potential) return NLC_ERROR_NO_POTENTIAL;
    for (int a = 1; a < 4 && count > 0; a++) {
        *culprit = a + 1;
        if (!argument[a]) return NLC_ERROR_NULL;
    }
    if ((*culprit = nlc_first_not_force(force, count)) >= 0) return NLC_ERROR_FORCE;
    if ((*culprit = nlc_first_not_finite(overlap, count)) >= 0) return NLC_ERROR_OVERLAP;
    return (*culprit = nlc_first_not_unit(normal, count)) >= 0 ? NLC_ERROR_NORMAL : NLC_OK;
}

/* top: the largest force, and the most contacts of a rank. */
static double energy_of(nlc_network *n, const double *force, const double *overlap, const double *normal, const double *top,
                        nlc_outcome *out)
{
    nlc_info *record = &out->info;
    const int p = nlc_exponent_above(top[0]);
    sum s = {0, 0, -1};
    nlc_set_units(n, 0, 0);
    n->cached = false;
    record->sweeps = 1;
    out->status = nlc_displace(n, NLC_OF_FORCES, force, normal, &record->culprit);
    if (out->status != NLC_OK) return 0;
    double exponent = largest_exponent(n, force, overlap);
    nlc_max_over_ranks(n, &exponent, 1);
    const int x = (int)exponent;
    out->status = p + x + nlc_exponent_above(top[1]) > 1000 || p > 1000 || x > 1000 ? NLC_ERROR_RANGE : NLC_OK;
    if (nlc_is_over(n, out) || out->status != NLC_OK) return 0;
    const double per_force = nlc_pow2(p < -1000 ? 1000 : -p), per_overlap = nlc_pow2(x < -1000 ? 1000 : -x);
    nlc_exchange_particles(n, n->largest);
    nlc_clamp_ghosts(n, n->largest, 0, top[0]);
    find_residual(n, force, overlap, nlc_join(1, p + 40), per_force, per_overlap, &s);
    record->residual = nlc_largest_over_ranks(n, s.residual, &s.worst);
    record->worst_contact = s.worst;
    if (n->settings.model->self) {
        record->sweeps++;
        out->status = nlc_displace(n, NLC_OF_ENERGY, force, normal, &record->culprit);
        if (out->status != NLC_OK) return 0;
    }
    add_up(n, force, overlap, per_force, per_overlap, &s);
    nlc_sum_over_ranks(n, &s.energy, 1);
    const double allowed = SOLUTION * n->settings.tolerance;
    out->status = record->residual > (allowed > ROUNDING ? allowed : ROUNDING) ? NLC_WARNING_NOT_CONVERGED : NLC_OK;
    return nlc_join(s.energy, (p < -1000 ? -1000 : p) + (x < -1000 ? -1000 : x));
}

nlc_status nlc_energy(nlc_network *network, double *NLC_RESTRICT energy, const double *NLC_RESTRICT force,
                      const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info)
{
    const bool valid = nlc_info_is_valid(info), shared = network && nlc_network_is_valid(network) && nlc_is_shared(network);
    if (!valid && !shared) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    nlc_outcome out = {NLC_OK, nlc_new_info()};
    out.status = valid ? check(network, energy, force, overlap, normal, &out.info.culprit) : NLC_ERROR_STRUCT_SIZE;
    double top[2] = {0, (double)network->contact_count}, result = 0;
    if (out.status == NLC_OK) top[0] = nlc_largest_magnitude(force, network->contact_count);
    if (shared) nlc_meet(network, NLC_ENERGY, out.status, out.info.culprit, 0, top, 2);
    if (!nlc_is_over(network, &out) && out.status == NLC_OK) {
        result = energy_of(network, force, overlap, normal, top, &out);
        if (!nlc_is_over(network, &out)) nlc_take_leave(network, force, &out);
    }
    if (out.status < 0) return valid ? nlc_report(info, &out.info, out.status) : out.status;
    for (int64_t c = 0; c < network->contact_count && !shared; c++) out.info.active += force[c] > 0;
    *energy = result;
    return nlc_report(info, &out.info, out.status);
}
