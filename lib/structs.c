/* SPDX-License-Identifier: BSD-2-Clause */
/* structs.c - the rule by which public structs of other versions are read and written. */
#include "structs.h"

#include <math.h>
#include <string.h>

#define END(type, field) (offsetof(type, field) + sizeof(((type *)0)->field))

/* Where the fields end.  A new field is appended, never inserted. */
static const size_t particles_ends[] = {
    END(nlc_particles, struct_size),    END(nlc_particles, count),         END(nlc_particles, radius),
    END(nlc_particles, radius_stride),  END(nlc_particles, material),      END(nlc_particles, material_stride),
    END(nlc_particles, materials),      END(nlc_particles, material_count), END(nlc_particles, material_size),
    END(nlc_particles, wall_material),  END(nlc_particles, wall_count),
};
static const size_t options_ends[] = {
    END(nlc_options, struct_size), END(nlc_options, model),      END(nlc_options, method),
    END(nlc_options, tolerance),   END(nlc_options, max_sweeps), END(nlc_options, prefactor),
    END(nlc_options, simd),        END(nlc_options, points),   END(nlc_options, stiffness),
    END(nlc_options, cache),       END(nlc_options, cache_size),
    END(nlc_options, parallel_for), END(nlc_options, parallel_context),
    END(nlc_options, owned_particles), END(nlc_options, exchange), END(nlc_options, reduce), END(nlc_options, context),
    END(nlc_options, reserved),
};
static const size_t positions_ends[] = {
    END(nlc_positions, struct_size), END(nlc_positions, x),          END(nlc_positions, y),
    END(nlc_positions, z),           END(nlc_positions, stride),     END(nlc_positions, wall_point),
    END(nlc_positions, wall_normal), END(nlc_positions, cell),
};
static const size_t lists_ends[] = {
    END(nlc_lists, struct_size), END(nlc_lists, count),     END(nlc_lists, particle), END(nlc_lists, particle_count),
    END(nlc_lists, length),      END(nlc_lists, neighbour), END(nlc_lists, mask),     END(nlc_lists, reserved),
};

static nlc_status read_struct(void *to, size_t own, const void *from, const size_t *ends, size_t count)
{
    size_t size, whole = 0;
    memcpy(&size, from, sizeof size);
    if (size < sizeof size || size > NLC_STRUCT_MAX) return NLC_ERROR_STRUCT_SIZE;
    for (size_t b = own; b < size; b++)
        if (((const unsigned char *)from)[b] != 0) return NLC_ERROR_RESERVED;
    for (size_t f = 0; f < count && ends[f] <= size; f++) whole = ends[f];
    memset(to, 0, own);
    memcpy(to, from, whole);
    return NLC_OK;
}

nlc_status nlc_read_particles(nlc_particles *to, const nlc_particles *from)
{
    return read_struct(to, sizeof *to, from, particles_ends, sizeof particles_ends / sizeof *particles_ends);
}

nlc_status nlc_read_options(nlc_options *to, const nlc_options *from)
{
    if (from) return read_struct(to, sizeof *to, from, options_ends, sizeof options_ends / sizeof *options_ends);
    memset(to, 0, sizeof *to);
    return NLC_OK;
}

nlc_status nlc_read_positions(nlc_positions *to, const nlc_positions *from)
{
    return read_struct(to, sizeof *to, from, positions_ends, sizeof positions_ends / sizeof *positions_ends);
}

nlc_status nlc_read_lists(nlc_lists *to, const nlc_lists *from)
{
    return read_struct(to, sizeof *to, from, lists_ends, sizeof lists_ends / sizeof *lists_ends);
}

int nlc_struct_size_is_valid(size_t size)
{
    return size >= sizeof size && size <= NLC_STRUCT_MAX;
}

void nlc_write_struct(void *to, const void *record, size_t own)
{
    size_t size;
    memcpy(&size, to, sizeof size);
    memcpy(to, record, size < own ? size : own);
    memcpy(to, &size, sizeof size);
    if (size > own) memset((unsigned char *)to + own, 0, size - own);
}

int nlc_info_is_valid(const nlc_info *info)
{
    return !info || nlc_struct_size_is_valid(info->struct_size);
}

nlc_info nlc_new_info(void)
{
    nlc_info record;
    memset(&record, 0, sizeof record);
    record.culprit = -1;
    record.worst_contact = record.critical_particle = record.weakest_particle = -1;
    record.lambda_lower = -INFINITY;
    record.lambda_upper = INFINITY;
    record.coupling = 1;
    return record;
}

nlc_status nlc_report(nlc_info *info, const nlc_info *record, nlc_status status)
{
    if (info) nlc_write_struct(info, record, sizeof *record);
    return status;
}

nlc_status nlc_error(nlc_info *info, nlc_status status, int64_t culprit)
{
    nlc_info record = nlc_new_info();
    record.culprit = culprit;
    return nlc_report(info, &record, status);
}
