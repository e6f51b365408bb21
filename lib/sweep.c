/* SPDX-License-Identifier: BSD-2-Clause */
/* sweep.c - nlc_sweep: forces given, displacements wanted. */
#include <string.h>

#include "collective.h"
#include "contact.h"
#include "structs.h"
#include "vector.h"

static nlc_status check(const nlc_network *n, const double *displacement, const double *force, const double *overlap,
                        const double *normal, int64_t *culprit)
{
    const int64_t count = n->contact_count;
    const bool places = n->settings.model->shape == NLC_SHAPE_PLACE;
    if (count == 0) return NLC_OK;
    *culprit = !displacement ? 1 : !force ? 2 : 4;
    if (!displacement || !force || !normal) return NLC_ERROR_NULL;
    if (overlap && (*culprit = nlc_first_not_finite(overlap, count)) >= 0) return NLC_ERROR_OVERLAP;
    *culprit = 3;
    if (places && !overlap) return NLC_ERROR_NULL;
    if ((*culprit = nlc_first_not_unit(normal, count)) >= 0) return NLC_ERROR_NORMAL;
    if (places && (*culprit = nlc_first_not_finite(displacement, 2 * count)) >= 0) {
        *culprit /= 2;
        return NLC_ERROR_NONLOCAL;
    }
    return (*culprit = nlc_first_not_finite(force, count)) >= 0 ? NLC_ERROR_FORCE : NLC_OK;
}

nlc_status nlc_sweep(nlc_network *network, double *NLC_RESTRICT displacement, const double *NLC_RESTRICT force,
                     const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info)
{
    const bool valid = nlc_info_is_valid(info), shared = network && nlc_network_is_valid(network) && nlc_is_shared(network);
    if (!valid && !shared) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    const int64_t count = network->contact_count;
    if (count == 0 && !shared) return nlc_error(info, NLC_OK, -1);
    nlc_outcome out = {NLC_OK, nlc_new_info()};
    out.status = valid ? check(network, displacement, force, overlap, normal, &out.info.culprit) : NLC_ERROR_STRUCT_SIZE;
    if (shared) nlc_meet(network, NLC_SWEEP, out.status, out.info.culprit, 0, 0, 0);
    if (nlc_is_over(network, &out) || out.status != NLC_OK) return valid ? nlc_report(info, &out.info, out.status) : out.status;

    network->cached = false;
    nlc_set_units(network, 0, 0);
    if (network->settings.model->shape == NLC_SHAPE_PLACE) nlc_set_places(network, displacement, overlap, 1);
    out.status = nlc_displace(network, NLC_OF_FORCES, force, normal, &out.info.culprit);
    nlc_take_leave(network, force, &out);
    if (out.status != NLC_OK) return nlc_report(info, &out.info, out.status);
    if (count > 0) memcpy(displacement, network->side, 2 * (size_t)count * sizeof *displacement);
    out.info.sweeps = 1;
    for (int64_t c = 0; c < count && !shared; c++) out.info.active += force[c] > 0;
    return nlc_report(info, &out.info, NLC_OK);
}
