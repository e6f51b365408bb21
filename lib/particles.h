/* SPDX-License-Identifier: BSD-2-Clause */
/* particles.h - the caller's particle arrays: access and checks.  Bodies are the particles, then the walls. */
#ifndef NLC_PARTICLES_H
#define NLC_PARTICLES_H

#include <string.h>

#include "nlcontact.h"
#include "number.h"

static inline double nlc_radius_of(const nlc_particles *p, int64_t particle)
{
    double r;
    memcpy(&r, (const char *)p->radius + particle * p->radius_stride, sizeof r);
    return r;
}

static inline int32_t nlc_material_of(const nlc_particles *p, int64_t body)
{
    int32_t m = 0;
    if (body >= p->count) {
        if (p->wall_material) m = p->wall_material[body - p->count];
    } else if (p->material) {
        memcpy(&m, (const char *)p->material + body * p->material_stride, sizeof m);
    }
    return m;
}

/* A rigid material's Poisson's ratio may be anything: 0 is as good. */
static inline nlc_material nlc_material_row(const nlc_particles *p, int64_t material)
{
    nlc_material m;
    memcpy(&m, (const char *)p->materials + (size_t)material * p->material_size, sizeof m);
    if (!nlc_is_finite(m.young)) m.poisson = 0;
    return m;
}

/* Whether elements of this size can be this many bytes apart: not overlapping, and the last one's offset can be held. */
bool nlc_is_stride(ptrdiff_t stride, size_t size, int64_t count);

/* Reads the struct, replaces strides of 0 by packed ones and checks counts only. */
nlc_status nlc_read_counts(nlc_particles *to, const nlc_particles *from);

/* Checks everything else: pointers, strides, radii, materials in use. */
nlc_status nlc_check_particles(const nlc_particles *p, int64_t *culprit);

/* Checks indices and forbidden pairs. */
nlc_status nlc_check_contacts(const nlc_particles *p, const int32_t *i, const int32_t *j, int64_t count, int64_t *culprit);

#endif
