/* SPDX-License-Identifier: BSD-2-Clause */
/* assemble.c - from contact forces to forces on the particles. */
#include "assemble.h"

#include "structs.h"
#include "vector.h"

bool nlc_read_stride(ptrdiff_t *stride, int64_t count)
{
    const ptrdiff_t size = 3 * sizeof(double);
    if (*stride == 0) *stride = size;
    if (*stride > -size && *stride < size) return false;
    ptrdiff_t magnitude = *stride < 0 ? -(*stride + 1) : *stride;
    return count <= 1 || magnitude <= PTRDIFF_MAX / count - 1;
}

nlc_body_forces nlc_forces_on(const nlc_network *n, double *F, ptrdiff_t F_stride, double *F_wall)
{
    const int64_t particles = n->particle_count, walls = F_wall ? n->body_count - particles : 0;
    return (nlc_body_forces){{(char *)F, F_stride, particles}, {(char *)F_wall, 3 * sizeof(double), walls}};
}

int64_t nlc_first_vector_not_finite(nlc_vectors v, double *largest)
{
    for (int64_t k = 0; k < v.count; k++) {
        double f[3];
        memcpy(f, v.at + k * v.stride, sizeof f);
        double m = nlc_largest_magnitude(f, 3);
        if (!nlc_is_finite(m)) return k;
        *largest = m > *largest ? m : *largest;
    }
    return -1;
}

nlc_status nlc_check_assembly(const nlc_network *n, const nlc_body_forces *F, const double *force, const double *normal,
                              double *largest, int64_t *culprit)
{
    *largest = 0;
    if ((*culprit = nlc_first_not_finite(force, n->contact_count)) >= 0) return NLC_ERROR_FORCE;
    if ((*culprit = nlc_first_not_unit(normal, n->contact_count)) >= 0) return NLC_ERROR_NORMAL;
    if ((*culprit = nlc_first_vector_not_finite(F->particles, largest)) >= 0) return NLC_ERROR_TOTAL_FORCE;
    if ((*culprit = nlc_first_vector_not_finite(F->walls, largest)) < 0) return NLC_OK;
    *culprit += n->particle_count;
    return NLC_ERROR_TOTAL_FORCE;
}

bool nlc_sums_in_range(const nlc_network *n, double largest, int exponent)
{
    const int sum = exponent + 1 + nlc_exponent_above(2 * (double)n->contact_count);
    return sum <= 1022 && nlc_exponent_above(largest) <= 1023;
}

nlc_status nlc_assemble(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride, double *NLC_RESTRICT F_wall,
                        const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info)
{
    int64_t culprit;
    double largest;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    const int64_t count = network->contact_count, particles = network->particle_count;
    if (count == 0) return nlc_error(info, NLC_OK, -1);
    if (!F) return nlc_error(info, NLC_ERROR_NULL, 1); /* a contact has a particle */
    if (!force) return nlc_error(info, NLC_ERROR_NULL, 4);
    if (!normal) return nlc_error(info, NLC_ERROR_NULL, 5);
    if (!nlc_read_stride(&F_stride, particles)) return nlc_error(info, NLC_ERROR_STRIDE, 2);
    const nlc_body_forces on = nlc_forces_on(network, F, F_stride, F_wall);
    const nlc_status status = nlc_check_assembly(network, &on, force, normal, &largest, &culprit);
    if (status != NLC_OK) return nlc_error(info, status, culprit);
    if (!nlc_sums_in_range(network, largest, nlc_exponent_above(nlc_largest_magnitude(force, count))))
        return nlc_error(info, NLC_ERROR_RANGE, -1);

    nlc_info record = nlc_new_info();
    for (int64_t c = 0; c < count; c++) {
        record.active += force[c] > 0;
        nlc_add_pair(network, &on, c, force[c], normal + 3 * c);
    }
    return nlc_report(info, &record, NLC_OK);
}
