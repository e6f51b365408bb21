/* SPDX-License-Identifier: BSD-2-Clause */
/* pairs.c - overlaps and normals of a host's pairs. */
#include "particles.h"
#include "separation.h"
#include "structs.h"
#include "vector.h"

/* Two particles and what nlc_separate does with them where there is no cell and sizes are far from the ends of the range. */
typedef struct plain {
    double d[3], square, radii; /* d from i to j */
} plain;

static inline double component(const double *x, ptrdiff_t stride, int64_t particle)
{
    double value;
    memcpy(&value, (const char *)x + particle * stride, sizeof value);
    return value;
}

/* Whether that can be said of all particles, looked at once instead of once a contact. */
static bool are_plain(const nlc_geometry *g, int64_t contact_count)
{
    const nlc_positions *x = &g->positions;
    bool moderate = !g->cell.any && g->particles.count <= 4 * contact_count;
    for (int64_t k = 0; k < g->particles.count && moderate; k++) {
        const uint64_t a = nlc_abs_bits(component(x->x, x->stride, k)), b = nlc_abs_bits(component(x->y, x->stride, k)),
                       c = nlc_abs_bits(component(x->z, x->stride, k)), limit = nlc_bits(0x1p90);
        moderate = a < limit && b < limit && c < limit && nlc_is_moderate(nlc_radius_of(&g->particles, k));
    }
    return moderate;
}

/* False: a wall, a wrong index or a distance that has to be looked at more closely. */
static inline bool is_plain(plain *p, const nlc_geometry *g, int32_t i, int32_t j)
{
    const nlc_positions *x = &g->positions;
    if (i < 0 || j < 0 || i >= g->particles.count || j >= g->particles.count) return false;
    p->d[0] = component(x->x, x->stride, j) - component(x->x, x->stride, i);
    p->d[1] = component(x->y, x->stride, j) - component(x->y, x->stride, i);
    p->d[2] = component(x->z, x->stride, j) - component(x->z, x->stride, i);
    p->square = nlc_dot(p->d, p->d);
    p->radii = nlc_radius_of(&g->particles, i) + nlc_radius_of(&g->particles, j);
    return nlc_is_moderate(p->square) && p->square > 1e-12 * p->radii * p->radii;
}

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
    const bool quick = are_plain(&g, contact_count);
    plain p;
    for (int64_t c = 0; c < contact_count; c++) { /* all of them before the first is written */
        culprit = c;
        if (quick && is_plain(&p, &g, i[c], j[c])) continue;
        if ((status = nlc_separate(&s, &g, i[c], j[c], &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
        if (!nlc_is_finite(s.overlap)) return nlc_error(info, NLC_ERROR_RANGE, c);
    }
    for (int64_t c = 0; c < contact_count; c++) {
        if (quick && is_plain(&p, &g, i[c], j[c])) {
            const double distance = sqrt(p.square);
            for (int x = 0; x < 3; x++) normal[3 * c + x] = p.d[x] / distance;
            overlap[c] = p.radii - distance;
            continue;
        }
        nlc_separate(&s, &g, i[c], j[c], &culprit);
        overlap[c] = s.overlap;
        memcpy(normal + 3 * c, s.normal, sizeof s.normal);
    }
    return nlc_error(info, NLC_OK, -1);
}
