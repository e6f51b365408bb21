/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * reach.c - how far outward a surface may be displaced where no force acts on it.
 *
 * The displacement is U sum P K(s), s the half sine of the angle to each force P >= 0: at most U times the sum of the forces
 * times the largest K.  In [GC] 5, K = -2(1-nu)/s - 2(1-2nu) + (7-8nu) s has the derivative 2(1-nu)/s^2 + 7-8nu > 0, so the
 * largest is that at s = 1, 3-2nu ([GC] 11).  In [MC] 1, in which u is the unit vector from one contact point to the other at
 * the distance d, it is that of opposite contacts, too, (3-2nu) 2R/d; contact points are at least R/2 from the centre.
 */
#include "network.h"
#include "structs.h"

/* The largest displacement / (U P) of a point without force. */
static double largest_response(const nlc_settings *settings, const nlc_kernel *kernel)
{
    const double nu = kernel->poisson;
    if (!settings->model->within) return 0;
    switch (settings->model->shape) {
    case NLC_SHAPE_POINT:
    case NLC_SHAPE_MOMENTS:
        return 0.76 + nu * (1.4 - 0.9 * nu);
    case NLC_SHAPE_PLACE:
        return 2 * kernel->prefactor * (3 - 2 * nu);
    case NLC_SHAPE_NONE:
        return kernel->prefactor * (3 - 2 * nu);
    default:
        return 3 - 2 * nu;
    }
}

/* b_k; unit, a power of two, keeps the sum of forces in range. */
static double displacement_of(const nlc_network *n, int64_t k, const double *force, double unit, int exponent)
{
    double sum = 0;
    if (!(n->scale[k] > 0) || k >= n->owned) return 0;
    for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) sum += unit * force[n->entry[p] >> 1];
    const nlc_scaled f = nlc_split(sum), u = nlc_split(n->scale[k]);
    const nlc_scaled response = nlc_split(largest_response(&n->settings, nlc_kernel_of(n, k)));
    return nlc_join(f.m * u.m * response.m, f.e + u.e + response.e + exponent);
}

nlc_status nlc_reach(const nlc_network *network, double *NLC_RESTRICT reach, double *NLC_RESTRICT displacement,
                     const double *NLC_RESTRICT force, nlc_info *info)
{
    int64_t culprit;
    nlc_info record = nlc_new_info();
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    const int64_t count = network->contact_count, particles = network->particle_count;
    if (!reach) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (count > 0 && !force) return nlc_error(info, NLC_ERROR_NULL, 3);
    if ((culprit = nlc_first_not_force(force, count)) >= 0) return nlc_error(info, NLC_ERROR_FORCE, culprit);
    const double top = nlc_largest_magnitude(force, count);
    const int exponent = nlc_exponent_above(top) > 900 ? 100 : 0; /* there are fewer than 2^64 of them */
    double largest = 0;
    for (int64_t k = 0; k < particles; k++) {
        const double b = displacement_of(network, k, force, nlc_pow2(-exponent), exponent);
        if (b <= largest) continue;
        largest = b;
        record.critical_particle = k;
    }
    if (nlc_exponent_above(nlc_is_finite(largest) ? largest : 0x1p1023) > 1023) return nlc_error(info, NLC_ERROR_RANGE, -1);
    for (int64_t k = 0; displacement && k < particles; k++)
        displacement[k] = displacement_of(network, k, force, nlc_pow2(-exponent), exponent);
    *reach = 2 * largest;
    return nlc_report(info, &record, NLC_OK);
}
