/* SPDX-License-Identifier: BSD-2-Clause */
/* separation.c - overlap and normal of two bodies from where they are. */
#include "separation.h"

#include "check.h"
#include "particles.h"
#include "structs.h"
#include "vector.h"

#define SAME_PLACE 1e-9 /* distance of two centres over the sum of the radii: rounding, of positions in a large cell say */
#define FAR 500         /* coordinates from 2^FAR on are multiplied by 2^-DOWN: squares of differences do not overflow */
#define DOWN 600

static nlc_status check_counts(nlc_particles *p)
{
    if (p->radius_stride == 0) p->radius_stride = sizeof(double);
    if (p->count < 0 || p->wall_count < 0) return NLC_ERROR_COUNT;
    return p->count > INT32_MAX || p->wall_count > INT32_MAX - p->count ? NLC_ERROR_COUNT : NLC_OK;
}

static nlc_status check_pointers(const nlc_particles *p, const nlc_positions *x, int64_t *culprit)
{
    *culprit = offsetof(nlc_particles, radius);
    if (p->count > 0 && !p->radius) return NLC_ERROR_NULL_FIELD;
    *culprit = x->x ? x->y ? offsetof(nlc_positions, z) : offsetof(nlc_positions, y) : offsetof(nlc_positions, x);
    if (p->count > 0 && (!x->x || !x->y || !x->z)) return NLC_ERROR_NULL_FIELD;
    *culprit = x->wall_point ? offsetof(nlc_positions, wall_normal) : offsetof(nlc_positions, wall_point);
    if (p->wall_count > 0 && (!x->wall_point || !x->wall_normal)) return NLC_ERROR_NULL_FIELD;
    *culprit = offsetof(nlc_particles, radius_stride);
    if (!nlc_is_stride(p->radius_stride, sizeof(double), p->count)) return NLC_ERROR_STRIDE;
    *culprit = offsetof(nlc_positions, stride);
    return nlc_is_stride(x->stride, sizeof(double), p->count) ? NLC_OK : NLC_ERROR_STRIDE;
}

static nlc_status check_walls(const nlc_particles *p, const nlc_positions *x, int64_t *culprit)
{
    for (int64_t w = 0; w < p->wall_count; w++) {
        *culprit = p->count + w;
        if (!nlc_is_finite(nlc_largest_magnitude(x->wall_point + 3 * w, 3))) return NLC_ERROR_POSITION;
        if (!nlc_is_unit(x->wall_normal + 3 * w)) return NLC_ERROR_NORMAL;
    }
    return NLC_OK;
}

nlc_status nlc_read_geometry(nlc_geometry *g, const nlc_particles *particles, const nlc_positions *positions, int64_t argument,
                             int64_t *culprit)
{
    nlc_status status;
    *culprit = argument;
    if ((status = nlc_read_particles(&g->particles, particles)) != NLC_OK) return status;
    if ((status = check_counts(&g->particles)) != NLC_OK) return status;
    *culprit = argument + 1;
    if ((status = nlc_read_positions(&g->positions, positions)) != NLC_OK) return status;
    if (g->positions.stride == 0) g->positions.stride = sizeof(double);
    if ((status = check_pointers(&g->particles, &g->positions, culprit)) != NLC_OK) return status;
    if ((status = check_walls(&g->particles, &g->positions, culprit)) != NLC_OK) return status;
    *culprit = -1;
    return nlc_prepare_cell(&g->cell, g->positions.cell) ? NLC_OK : NLC_ERROR_CELL;
}

static double component(const double *x, ptrdiff_t stride, int64_t particle)
{
    double value;
    memcpy(&value, (const char *)x + particle * stride, sizeof value);
    return value;
}

/* Largest |component|; infinity or a NaN if there is one. */
static inline double largest(const double x[3])
{
    const uint64_t a = nlc_abs_bits(x[0]), b = nlc_abs_bits(x[1]), c = nlc_abs_bits(x[2]), ab = a > b ? a : b;
    return nlc_from_bits(ab > c ? ab : c);
}

static inline nlc_status read_particle(const nlc_geometry *g, int32_t k, double x[3], double *R, int64_t *culprit)
{
    const nlc_positions *p = &g->positions;
    *R = nlc_radius_of(&g->particles, k);
    x[0] = component(p->x, p->stride, k);
    x[1] = component(p->y, p->stride, k);
    x[2] = component(p->z, p->stride, k);
    if (nlc_is_positive(*R) && nlc_is_finite(largest(x))) return NLC_OK;
    *culprit = k;
    return nlc_is_positive(*R) ? NLC_ERROR_POSITION : NLC_ERROR_RADIUS;
}

/* Multiplies both by 2^-e where one of them, or the cell, is far; returns e. */
static int bring_near(double to[3], double from[3], const nlc_cell *cell)
{
    const double limit = nlc_pow2(FAR);
    if (largest(to) < limit && largest(from) < limit && cell->largest < limit) return 0;
    for (int x = 0; x < 3; x++) {
        to[x] *= nlc_pow2(-DOWN);
        from[x] *= nlc_pow2(-DOWN);
    }
    return DOWN;
}

/* radii - distance */
static double overlap_of(nlc_scaled radii, nlc_scaled distance)
{
    distance.m = -distance.m;
    const nlc_scaled sum = nlc_sum(radii, distance);
    return nlc_join(sum.m, sum.e);
}

static double quotient(nlc_scaled a, nlc_scaled b)
{
    return nlc_join(a.m / b.m, a.e - b.e);
}

/* d 2^e between the centres; any size. */
static nlc_status separate_scaled(nlc_separation *s, double d[3], int e, double R, double r)
{
    const nlc_scaled radii = nlc_sum(nlc_split(R), nlc_split(r));
    nlc_scaled distance = nlc_length(d);
    distance.e += e;
    if (nlc_abs_bits(distance.m) == 0 || quotient(distance, radii) < SAME_PLACE) return NLC_ERROR_SAME_PLACE;
    for (int x = 0; x < 3; x++) s->normal[x] = d[x] / distance.m;
    s->overlap = overlap_of(radii, distance);
    return NLC_OK;
}

static nlc_status separate_particles(nlc_separation *s, const nlc_geometry *g, int32_t i, int32_t j, int64_t *culprit)
{
    double from[3], to[3], d[3], R, r;
    nlc_status status = read_particle(g, i, from, &R, culprit);
    if (status == NLC_OK) status = read_particle(g, j, to, &r, culprit);
    if (status != NLC_OK) return status;
    const int e = bring_near(to, from, &g->cell);
    if (!g->cell.any) {
        for (int x = 0; x < 3; x++) d[x] = to[x] - from[x];
    } else {
        if (!nlc_wrap(d, to, from, e, &g->cell)) return NLC_ERROR_RANGE;
        if (0.5 * R + 0.5 * r > 0.25 * g->cell.width) return NLC_ERROR_CELL;
    }
    const double square = nlc_dot(d, d);
    if (e != 0 || !nlc_is_moderate(square) || !nlc_is_moderate(R) || !nlc_is_moderate(r)) return separate_scaled(s, d, e, R, r);
    const double distance = sqrt(square); /* the same roundings without the scaling, in less time */
    if (distance < SAME_PLACE * (R + r)) return NLC_ERROR_SAME_PLACE;
    for (int x = 0; x < 3; x++) s->normal[x] = d[x] / distance;
    s->overlap = (R + r) - distance;
    return NLC_OK;
}

/* sense: 1 with the particle as i, when the normal points into the wall; -1 with the wall as i */
static nlc_status separate_wall(nlc_separation *s, const nlc_geometry *g, int32_t particle, int64_t wall, double sense,
                                int64_t *culprit)
{
    static const nlc_cell none;
    const double *n = g->positions.wall_normal + 3 * wall, length = sqrt(nlc_dot(n, n));
    double x[3], d[3], R;
    const nlc_status status = read_particle(g, particle, x, &R, culprit);
    if (status != NLC_OK) return status;
    memcpy(d, g->positions.wall_point + 3 * wall, sizeof d);
    const int e = bring_near(x, d, &none);
    for (int k = 0; k < 3; k++) d[k] = x[k] - d[k];
    const int scale = nlc_length(d).e; /* of d now */
    nlc_scaled distance = nlc_split(nlc_dot(d, n) / length);
    distance.e += e + scale;
    for (int k = 0; k < 3; k++) s->normal[k] = -sense * (n[k] / length);
    s->overlap = overlap_of(nlc_split(R), distance);
    return NLC_OK;
}

nlc_status nlc_separate(nlc_separation *s, const nlc_geometry *g, int32_t i, int32_t j, int64_t *culprit)
{
    const int64_t count = g->particles.count, bodies = count + g->particles.wall_count;
    if (i < 0 || j < 0 || i >= bodies || j >= bodies) return NLC_ERROR_INDEX;
    if (i >= count && j >= count) return NLC_ERROR_WALL_WALL;
    if (j >= count) return separate_wall(s, g, i, j - count, 1, culprit);
    if (i >= count) return separate_wall(s, g, j, i - count, -1, culprit);
    return separate_particles(s, g, i, j, culprit);
}
