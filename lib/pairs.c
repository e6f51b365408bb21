/* SPDX-License-Identifier: BSD-2-Clause */
/* pairs.c - overlaps and normals of a host's pairs. */
#include "separation.h"
#include "structs.h"

nlc_status nlc_contacts_from_pairs(double *NLC_RESTRICT overlap, double *NLC_RESTRICT normal, const nlc_particles *particles,
                                   const nlc_positions *positions, const int32_t *NLC_RESTRICT i, const int32_t *NLC_RESTRICT j,
                                   int64_t contact_count, nlc_info *info)
{
    const void *required[] = {overlap, normal, particles, positions, i, j};
    nlc_geometry g;
    nlc_separation s;
    int64_t culprit;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    for (int k = 0; k < 6; k++)
        if (!required[k] && (contact_count > 0 || k == 2 || k == 3)) return nlc_error(info, NLC_ERROR_NULL, k);
    if (contact_count < 0) return nlc_error(info, NLC_ERROR_COUNT, 6);
    nlc_status status = nlc_read_geometry(&g, particles, positions, 2, &culprit);
    if (status != NLC_OK) return nlc_error(info, status, culprit);
    for (int64_t c = 0; c < contact_count; c++) { /* all of them before the first is written */
        culprit = c;
        if ((status = nlc_separate(&s, &g, i[c], j[c], &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
        if (!nlc_is_finite(s.overlap)) return nlc_error(info, NLC_ERROR_RANGE, c);
    }
    for (int64_t c = 0; c < contact_count; c++) {
        nlc_separate(&s, &g, i[c], j[c], &culprit);
        overlap[c] = s.overlap;
        memcpy(normal + 3 * c, s.normal, sizeof s.normal);
    }
    return nlc_error(info, NLC_OK, -1);
}
