/* SPDX-License-Identifier: BSD-2-Clause */
/* assemble.c - from contact forces to forces on the particles. */
#include <string.h>

#include "network.h"
#include "structs.h"
#include "vector.h"

/* A caller's array of vectors, at any address. */
typedef struct vectors {
    char *at;
    ptrdiff_t stride;
    int64_t count;
} vectors;

static void add(vectors v, int64_t k, double factor, const double *n)
{
    double f[3];
    memcpy(f, v.at + k * v.stride, sizeof f);
    for (int x = 0; x < 3; x++) f[x] += factor * n[x];
    memcpy(v.at + k * v.stride, f, sizeof f);
}

/* Walls come behind the particles, and may not be wanted. */
static void add_to_body(vectors particles, vectors walls, int64_t body, double factor, const double *n)
{
    if (body < particles.count)
        add(particles, body, factor, n);
    else if (walls.count > 0)
        add(walls, body - particles.count, factor, n);
}

/* Index of the first vector that is not finite, or -1; *largest is raised to the largest magnitude of a component. */
static int64_t first_not_finite(vectors v, double *largest)
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

static bool is_stride(ptrdiff_t stride, int64_t count)
{
    const ptrdiff_t size = 3 * sizeof(double);
    if (stride > -size && stride < size) return false;
    ptrdiff_t magnitude = stride < 0 ? -(stride + 1) : stride;
    return count <= 1 || magnitude <= PTRDIFF_MAX / count - 1;
}

/* Whether no sum can overflow. */
static bool in_range(const nlc_network *n, double largest, const double *force)
{
    int sum = nlc_exponent_above(nlc_largest_magnitude(force, n->contact_count)) + 1 +
              nlc_exponent_above(2 * (double)n->contact_count);
    return sum <= 1022 && nlc_exponent_above(largest) <= 1023;
}

nlc_status nlc_assemble(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride, double *NLC_RESTRICT F_wall,
                        const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info)
{
    int64_t culprit;
    double largest = 0;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    const int64_t count = network->contact_count, particles = network->particle_count;
    if (count == 0) return nlc_error(info, NLC_OK, -1);
    if (particles > 0 && !F) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!force) return nlc_error(info, NLC_ERROR_NULL, 4);
    if (!normal) return nlc_error(info, NLC_ERROR_NULL, 5);
    if (F_stride == 0) F_stride = 3 * sizeof(double);
    if (!is_stride(F_stride, particles)) return nlc_error(info, NLC_ERROR_STRIDE, 2);
    if ((culprit = nlc_first_not_finite(force, count)) >= 0) return nlc_error(info, NLC_ERROR_FORCE, culprit);
    if ((culprit = nlc_first_not_unit(normal, count)) >= 0) return nlc_error(info, NLC_ERROR_NORMAL, culprit);
    const vectors on_particles = {(char *)F, F_stride, particles};
    const vectors on_walls = {(char *)F_wall, 3 * sizeof(double), F_wall ? network->body_count - particles : 0};
    if ((culprit = first_not_finite(on_particles, &largest)) >= 0) return nlc_error(info, NLC_ERROR_TOTAL_FORCE, culprit);
    if ((culprit = first_not_finite(on_walls, &largest)) >= 0)
        return nlc_error(info, NLC_ERROR_TOTAL_FORCE, particles + culprit);
    if (!in_range(network, largest, force)) return nlc_error(info, NLC_ERROR_RANGE, -1);

    nlc_info record = nlc_new_info();
    for (int64_t c = 0; c < count; c++) {
        const int64_t i = network->i[c], j = network->j[c];
        record.active += force[c] > 0;
        if (i == j) continue; /* equal and opposite forces on one particle */
        add_to_body(on_particles, on_walls, i, -force[c], normal + 3 * c);
        add_to_body(on_particles, on_walls, j, force[c], normal + 3 * c);
    }
    return nlc_report(info, &record, NLC_OK);
}
