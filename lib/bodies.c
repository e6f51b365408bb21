/* SPDX-License-Identifier: BSD-2-Clause */
/* bodies.c - what a network takes from the particles, and other particles for the same contacts. */
#include "bodies.h"

#include "active.h"
#include "hertz.h"
#include "particles.h"
#include "structs.h"

/* U = (1+nu) / (4 pi R E) */
static double coupling_scale(double R, nlc_material m)
{
    if (!nlc_is_finite(m.young)) return 0;
    nlc_scaled r = nlc_split(R), e = nlc_split(m.young);
    return nlc_join((1 + m.poisson) / (4 * 3.14159265358979323846 * r.m * e.m), -r.e - e.e);
}

/* Whether all radii and finite moduli are so moderate that every n_H can be held. */
static bool are_moderate(const nlc_particles *p)
{
    int32_t last = -1;
    for (int64_t k = 0; k < p->count + p->wall_count; k++) {
        if (k < p->count && !nlc_is_moderate(nlc_radius_of(p, k))) return false;
        int32_t m = nlc_material_of(p, k);
        if (m == last) continue;
        last = m;
        double young = nlc_material_row(p, m).young;
        if (nlc_is_finite(young) && !nlc_is_moderate(young)) return false;
    }
    return true;
}

/* Whether every n_H can be held; found out before there is a network. */
static bool stiffnesses_in_range(const nlc_particles *p, const int32_t *i, const int32_t *j, int64_t count, int64_t *culprit)
{
    const bool moderate = are_moderate(p);
    for (int64_t c = 0; c < count && !moderate; c++) {
        nlc_material a = nlc_material_row(p, nlc_material_of(p, i[c])), b = nlc_material_row(p, nlc_material_of(p, j[c]));
        *culprit = c;
        if (!nlc_is_positive(nlc_hertz_stiffness(a.young, a.poisson, i[c] < p->count ? nlc_radius_of(p, i[c]) : INFINITY,
                                                 b.young, b.poisson, j[c] < p->count ? nlc_radius_of(p, j[c]) : INFINITY)))
            return false;
    }
    *culprit = -1;
    return true;
}

/* Largest U; subnormal ones have lost their digits. */
static bool scales_in_range(const nlc_particles *p, int *exponent)
{
    double largest = 0;
    for (int64_t k = 0; k < p->count; k++) {
        nlc_material m = nlc_material_row(p, nlc_material_of(p, k));
        double u = coupling_scale(nlc_radius_of(p, k), m);
        if (nlc_is_finite(m.young) && !(nlc_is_finite(u) && u >= nlc_pow2(-1022))) return false;
        largest = u > largest ? u : largest;
    }
    *exponent = nlc_exponent_above(largest);
    return true;
}

nlc_status nlc_check_bodies(nlc_network *n, const nlc_settings *settings, const nlc_particles *p, const int32_t *i,
                            const int32_t *j, const double *stiffness, int64_t *culprit)
{
    nlc_status status;
    if ((status = nlc_check_particles(p, culprit)) != NLC_OK) return status;
    if ((status = nlc_check_contacts(p, i, j, n->contact_count, culprit)) != NLC_OK) return status;
    if (stiffness) {
        *culprit = nlc_first_not_positive(stiffness, n->contact_count);
        if (*culprit >= 0) return NLC_ERROR_STIFFNESS;
    } else if (!stiffnesses_in_range(p, i, j, n->contact_count, culprit)) {
        return NLC_ERROR_RANGE;
    }
    *culprit = -1;
    if (!scales_in_range(p, &n->scale_exponent)) return NLC_ERROR_RANGE;
    return nlc_prefactor_in_range(n, settings) ? NLC_OK : NLC_ERROR_RANGE;
}

static double least_ratio(const nlc_network *n)
{
    double least = INFINITY, largest = 0;
    for (int64_t k = 0; k < n->particle_count; k++) {
        least = n->radius[k] < least ? n->radius[k] : least;
        largest = n->radius[k] > largest ? n->radius[k] : largest;
    }
    return largest > 0 ? least / largest : 0; /* all are finite; there may be none */
}

void nlc_set_bodies(nlc_network *n, const nlc_particles *p)
{
    for (int64_t k = 0; k < n->body_count; k++) n->material[k] = nlc_material_of(p, k);
    for (int64_t m = 0; m < n->material_count; m++) n->materials[m] = nlc_material_row(p, m);
    for (int64_t k = 0; k < n->particle_count; k++) {
        n->radius[k] = nlc_radius_of(p, k);
        n->scale[k] = coupling_scale(n->radius[k], n->materials[n->material[k]]);
    }
    n->least_ratio = least_ratio(n);
}

nlc_status nlc_network_update(nlc_network *network, const nlc_particles *particles, const double *stiffness, nlc_info *info)
{
    nlc_particles p;
    nlc_status status;
    int64_t culprit;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!particles) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    if ((status = nlc_read_counts(&p, particles)) != NLC_OK) return nlc_error(info, status, 1);
    if (p.count != network->particle_count || p.count + p.wall_count != network->body_count ||
        p.material_count != network->material_count)
        return nlc_error(info, NLC_ERROR_COUNT, 1);
    nlc_network n = *network; /* the network is written to only when all is checked */
    const nlc_settings settings = n.settings;
    status = nlc_check_bodies(&n, &settings, &p, n.i, n.j, stiffness, &culprit);
    if (status != NLC_OK) return nlc_error(info, status, culprit);
    network->scale_exponent = n.scale_exponent;
    nlc_set_bodies(network, &p);
    nlc_set_connected(network);
    nlc_apply_settings(network, &settings, stiffness);
    return nlc_error(info, NLC_OK, -1);
}
