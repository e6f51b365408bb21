/* SPDX-License-Identifier: BSD-2-Clause */
/* particles.c - the caller's particle arrays: checks. */
#include "particles.h"

#include "hertz.h"
#include "structs.h"

bool nlc_is_stride(ptrdiff_t stride, size_t size, int64_t count)
{
    if (stride > -(ptrdiff_t)size && stride < (ptrdiff_t)size) return false;
    ptrdiff_t magnitude = stride < 0 ? -(stride + 1) : stride;
    return count <= 1 || magnitude <= PTRDIFF_MAX / count - 1;
}

nlc_status nlc_read_counts(nlc_particles *to, const nlc_particles *from)
{
    nlc_status status = nlc_read_particles(to, from);
    if (status != NLC_OK) return status;
    if (to->radius_stride == 0) to->radius_stride = sizeof(double);
    if (to->material_stride == 0) to->material_stride = sizeof(int32_t);
    if (to->material_size == 0) to->material_size = sizeof(nlc_material);
    if (to->count < 0 || to->wall_count < 0 || to->material_count < 0) return NLC_ERROR_COUNT;
    if (to->count > INT32_MAX || to->wall_count > INT32_MAX - to->count) return NLC_ERROR_COUNT;
    if (to->material_count > INT32_MAX) return NLC_ERROR_COUNT;
    if (to->count + to->wall_count > 0 && to->material_count == 0) return NLC_ERROR_COUNT;
    return NLC_OK;
}

static nlc_status check_pointers(const nlc_particles *p, int64_t *culprit)
{
    *culprit = offsetof(nlc_particles, radius);
    if (p->count > 0 && !p->radius) return NLC_ERROR_NULL_FIELD;
    *culprit = offsetof(nlc_particles, materials);
    if (p->count + p->wall_count > 0 && !p->materials) return NLC_ERROR_NULL_FIELD;
    *culprit = offsetof(nlc_particles, radius_stride);
    if (!nlc_is_stride(p->radius_stride, sizeof(double), p->count)) return NLC_ERROR_STRIDE;
    *culprit = offsetof(nlc_particles, material_stride);
    if (!nlc_is_stride(p->material_stride, sizeof(int32_t), p->count)) return NLC_ERROR_STRIDE;
    *culprit = offsetof(nlc_particles, material_size);
    if (p->material_size < sizeof(nlc_material) || p->material_size > NLC_STRUCT_MAX) return NLC_ERROR_STRIDE;
    if (p->material_count > PTRDIFF_MAX / (ptrdiff_t)p->material_size) return NLC_ERROR_STRIDE;
    return NLC_OK;
}

static nlc_status check_material(const nlc_particles *p, int32_t material)
{
    nlc_material m = nlc_material_row(p, material);
    const unsigned char *row = (const unsigned char *)p->materials + (size_t)material * p->material_size;
    if (!nlc_is_positive_or_infinite(m.young)) return NLC_ERROR_YOUNG;
    if (nlc_is_finite(m.young) && !nlc_is_poisson(m.poisson)) return NLC_ERROR_POISSON;
    for (size_t b = sizeof m; b < p->material_size; b++)
        if (row[b] != 0) return NLC_ERROR_RESERVED;
    return NLC_OK;
}

nlc_status nlc_check_particles(const nlc_particles *p, int64_t *culprit)
{
    nlc_status status = check_pointers(p, culprit);
    if (status != NLC_OK) return status;
    int32_t last = -1; /* the material checked last */
    for (int64_t k = 0; k < p->count + p->wall_count; k++) {
        *culprit = k;
        if (k < p->count && !nlc_is_positive(nlc_radius_of(p, k))) return NLC_ERROR_RADIUS;
        int32_t m = nlc_material_of(p, k);
        if (m < 0 || m >= p->material_count) return NLC_ERROR_MATERIAL;
        if (m == last) continue;
        *culprit = m;
        status = check_material(p, m);
        if (status != NLC_OK) return status;
        last = m;
    }
    return NLC_OK;
}

nlc_status nlc_check_contacts(const nlc_particles *p, const int32_t *i, const int32_t *j, int64_t count, int64_t *culprit)
{
    const int64_t bodies = p->count + p->wall_count;
    for (int64_t c = 0; c < count; c++) {
        *culprit = c;
        if (i[c] < 0 || j[c] < 0 || i[c] >= bodies || j[c] >= bodies) return NLC_ERROR_INDEX;
        if (i[c] >= p->count && j[c] >= p->count) return NLC_ERROR_WALL_WALL;
        if (!nlc_is_finite(nlc_material_row(p, nlc_material_of(p, i[c])).young) &&
            !nlc_is_finite(nlc_material_row(p, nlc_material_of(p, j[c])).young))
            return NLC_ERROR_RIGID_RIGID;
    }
    return NLC_OK;
}
