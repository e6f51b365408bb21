/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fuzz_network.c - a network from arbitrary bytes, and a few of the functions that take one, in arbitrary order.
 *
 * With a first byte of 0 most inputs are scenes that can be solved; its bits let arbitrary numbers in.  What is demanded: nothing
 * outside of the arrays is touched, no exception is raised, nothing but *info changes on an error, a status is one of those in the
 * header, results are finite (forces not negative), and have the same bits a second time, in another network, elsewhere in
 * memory, with other callbacks and cache.
 */
#include "fuzz.h"

#include <math.h>
#include <string.h>

enum { PARTICLES = 12, WALLS = 3, MATERIALS = 4, CONTACTS = 20, MANY = 50, COUNTS = 96, STEPS = 6 };

/* What may be arbitrary. */
enum { ODD_COUNTS, ODD_INDICES, ODD_BODIES, ODD_NORMALS, ODD_OVERLAPS, ODD_OPTIONS, ODD_LAYOUT, ODD_STATE };

/* The rooms. */
enum {
    RADIUS, MATERIAL, ROWS, WALL_MATERIAL, FIRST_BODY, SECOND_BODY, OVERLAP, NORMAL, SLIDING, STIFFNESS, OPTIONS, SIZES, INFO, OTHER_INFO,
    MEMORY, OTHER_MEMORY, CACHE, FORCE, NONLOCAL, DISPLACEMENT, CHANGE, RESULT, SECOND_RESULT, OTHER_RESULT, TOTAL, TORQUE, WALL_FORCE,
    SECOND_TOTAL, SECOND_TORQUE, SECOND_WALL_FORCE, USED
};
_Static_assert((int)USED <= (int)ROOMS, "too few rooms");

typedef struct scene {
    bytes in;
    uint64_t odd;
    bool behind;
    nlc_particles *particles;
    nlc_options *options; /* NULL: none */
    int32_t *i, *j;
    double *overlap, *normal, *force, *nonlocal, *displacement, *change;
    int64_t count;   /* contacts; those that there are arrays for: below COUNTS */
    size_t contacts; /* the same once there is a network */
    size_t bodies, walls;
    nlc_network *network;
} scene;

#define ARRAY(s, number, count, type) ((type *)room(number, (size_t)(count) * sizeof(type), (s)->behind, 0))

static double byte_number(bytes *in, double low, double high)
{
    return low + (high - low) * (double)take(in, 1) / 255;
}

/* ---- options */

/* A host's loop, in any order. */
static void backwards(void *context, void (*task)(void *, int64_t), void *work, int64_t count)
{
    ++*(int64_t *)context;
    while (count-- > 0) task(work, count);
}

static int64_t calls;

/* A rank that is alone: nothing to exchange, and its own sums. */
static int exchange(void *context, double *side)
{
    (void)side;
    ++*(int64_t *)context;
    return 0;
}

static int reduce(void *context, double *values, int32_t count, int32_t operation)
{
    demand(count > 0 && count < 1000 && (operation == NLC_REDUCE_SUM || operation == NLC_REDUCE_MAX), "what is to be reduced");
    (void)values;
    ++*(int64_t *)context;
    return 0;
}

static void make_options(scene *s)
{
    bytes *in = &s->in;
    const uint64_t kind = take(in, 1);
    s->options = NULL;
    if (kind == 255) return;
    nlc_options *o = s->options = ARRAY(s, OPTIONS, 1, nlc_options);
    *o = (nlc_options){.struct_size = sizeof *o, .model = (int32_t)(kind % 6), .method = kind / 6 % 8 == 1};
    if (take(in, 1) & 1) o->tolerance = ldexp(1, -(int)(take(in, 1) % 64));
    const uint64_t sweeps = take(in, 1);
    o->max_sweeps = sweeps == 255 ? 0 : 1 + (int64_t)sweeps / 4;
    if (take(in, 1) & 1) o->prefactor = byte_number(in, 0, 4);
    const uint64_t choice = take(in, 1);
    o->simd = (int32_t)(choice % 5);
    o->points = (int32_t)(choice >> 4 & 1);
    if (choice >> 5 & 1) {
        double *k = ARRAY(s, STIFFNESS, s->count, double);
        for (int64_t c = 0; c < s->count; c++) k[c] = take_bit(in, s->odd, ODD_OPTIONS) ? take_any(in) : byte_number(in, 1e8, 1e10);
        o->stiffness = k;
    }
    if (choice >> 6 & 1) {
        o->cache_size = (size_t)take(in, 2);
        o->cache = room(CACHE, o->cache_size, s->behind, (8 - o->cache_size % 8) % 8 * s->behind);
    }
    if (choice >> 7 & 1) o->parallel_for = backwards, o->parallel_context = &calls;
    if (kind >= 252) o->exchange = exchange, o->reduce = reduce, o->context = &calls;
    if (take_bit(in, s->odd, ODD_OPTIONS)) {
        switch (take(in, 1) % 10) { /* owned particles less than all need an exchange with others: alone they are all, or an error */
        case 0: o->model = (int32_t)take_integer(in); break;
        case 1: o->method = (int32_t)take_integer(in); break;
        case 2: o->tolerance = take_any(in); break;
        case 3: o->max_sweeps = take_integer(in); break;
        case 4: o->prefactor = take_any(in); break;
        case 5: o->simd = (int32_t)take_integer(in); break;
        case 6: o->points = (int32_t)take_integer(in); break;
        case 7: o->owned_particles = take_integer(in), o->exchange = NULL, o->reduce = NULL; break;
        case 8: o->reduce = reduce; break;
        default: o->cache = (void *)((uintptr_t)o->cache + (uintptr_t)take(in, 1) % 8);
        }
        if (o->max_sweeps > 4096) o->max_sweeps &= 4095; /* what does not converge would go on for ever */
    }
}

/* ---- particles and contacts */

/* A count below the limit or, if that is odd, anything: arrays are there for COUNTS, and more cannot be accepted. */
static int64_t make_count(scene *s, uint64_t limit)
{
    if (!take_bit(&s->in, s->odd, ODD_COUNTS)) return (int64_t)(take(&s->in, 1) % limit);
    const int64_t count = take_integer(&s->in);
    return count < 65536 && count > 0 ? count % COUNTS : count;
}

/* An array of count elements that are stride bytes apart, as far as those make sense; to the first element. */
static char *make_strided(scene *s, int number, int64_t count, size_t size, ptrdiff_t *stride)
{
    static const ptrdiff_t strides[] = {0, 8, 16, 24, -8, -16, 9, 13, -11, 1, -1, 7, -3, PTRDIFF_MAX, PTRDIFF_MIN, PTRDIFF_MIN + 1};
    const size_t rows = count > 0 && count < COUNTS ? (size_t)count : 0;
    *stride = take_bit(&s->in, s->odd, ODD_LAYOUT) ? strides[take(&s->in, 1) % 16] : 0;
    ptrdiff_t step = *stride == 0 ? (ptrdiff_t)size : *stride;
    if (step < -64 || step > 64) step = 0; /* right for one element, and refused for more */
    const size_t apart = (size_t)(step < 0 ? -step : step);
    char *p = room(number, rows == 0 ? 0 : (rows - 1) * apart + size, s->behind, 0);
    return step < 0 && rows > 0 ? p + (rows - 1) * apart : p;
}

static void make_materials(scene *s)
{
    nlc_particles *p = s->particles;
    const size_t extra = take_bit(&s->in, s->odd, ODD_LAYOUT) ? (size_t)take(&s->in, 1) % 40 : 0;
    const size_t row = sizeof(nlc_material) + extra, rows = p->material_count > 0 && p->material_count < COUNTS ? (size_t)p->material_count : 0;
    char *at = room(ROWS, rows * row, s->behind, 0);
    p->materials = (const nlc_material *)(const void *)at;
    p->material_size = extra > 0 ? row : take(&s->in, 1) & 1 ? sizeof(nlc_material) : 0;
    if (take_bit(&s->in, s->odd, ODD_LAYOUT)) p->material_size = (size_t)take(&s->in, 1) % sizeof(nlc_material);
    if (take_bit(&s->in, s->odd, ODD_LAYOUT)) p->material_size = SIZE_MAX - (size_t)take(&s->in, 1);
    for (size_t m = 0; m < rows; m++) {
        const uint64_t kind = take(&s->in, 1);
        nlc_material material = {kind == 255 ? INFINITY : 1e9 * (1 + (double)(kind % 16)), (double)(take(&s->in, 1) % 33) / 64};
        if (take_bit(&s->in, s->odd, ODD_BODIES)) material.young = take_any(&s->in);
        if (take_bit(&s->in, s->odd, ODD_BODIES)) material.poisson = take_any(&s->in);
        memset(at + m * row, 0, row);
        memcpy(at + m * row, &material, sizeof material);
        if (extra > 0 && take_bit(&s->in, s->odd, ODD_LAYOUT)) at[m * row + sizeof material + take(&s->in, 1) % extra] = 1;
    }
}

static int32_t make_material(scene *s)
{
    if (take_bit(&s->in, s->odd, ODD_BODIES)) return (int32_t)take_integer(&s->in);
    const int64_t rows = s->particles->material_count;
    return rows > 0 ? (int32_t)((int64_t)take(&s->in, 1) % rows) : 0;
}

static void make_particles(scene *s)
{
    nlc_particles *p = s->particles = ARRAY(s, SIZES, 1, nlc_particles);
    *p = (nlc_particles){.struct_size = sizeof *p};
    p->count = make_count(s, PARTICLES + 1);
    p->wall_count = make_count(s, WALLS + 1);
    p->material_count = make_count(s, MATERIALS);
    if (p->material_count == 0 && !(s->odd & 1u << ODD_COUNTS)) p->material_count = 1;
    make_materials(s);
    char *radius = make_strided(s, RADIUS, p->count, sizeof(double), &p->radius_stride);
    p->radius = (const double *)(const void *)radius;
    const bool has_materials = take(&s->in, 1) & 1;
    char *material = make_strided(s, MATERIAL, p->count, sizeof(int32_t), &p->material_stride);
    p->material = has_materials ? (const int32_t *)(const void *)material : NULL;
    const int64_t rows = p->count < COUNTS ? p->count : 0;
    const ptrdiff_t radius_step = p->radius_stride ? p->radius_stride : 8, material_step = p->material_stride ? p->material_stride : 4;
    for (int64_t k = 0; k < rows; k++) {
        const double r = take_bit(&s->in, s->odd, ODD_BODIES) ? take_any(&s->in) : byte_number(&s->in, 1, 2);
        const int32_t m = make_material(s);
        if (k == 0 || (radius_step >= -64 && radius_step <= 64)) memcpy(radius + k * radius_step, &r, radius_step >= 8 || radius_step <= -8 ? 8 : 1);
        if (k == 0 || (material_step >= -64 && material_step <= 64))
            memcpy(material + k * material_step, &m, material_step >= 4 || material_step <= -4 ? 4 : 1);
    }
    if (p->wall_count > 0 && p->wall_count < COUNTS && take(&s->in, 1) & 1) {
        int32_t *w = ARRAY(s, WALL_MATERIAL, p->wall_count, int32_t);
        for (int64_t k = 0; k < p->wall_count; k++) w[k] = make_material(s);
        p->wall_material = w;
    }
}

static double make_overlap(scene *s)
{
    return take_bit(&s->in, s->odd, ODD_OVERLAPS) ? take_any(&s->in) : (double)((int64_t)take(&s->in, 2) - 20000) / 65536 * 0.15;
}

static void make_normal(scene *s, uint64_t salt, double n[3])
{
    take_unit(&s->in, salt, n);
    if (take_bit(&s->in, s->odd, ODD_NORMALS)) n[take(&s->in, 1) % 3] = take_any(&s->in);
    if (take_bit(&s->in, s->odd, ODD_NORMALS)) n[0] = take(&s->in, 1) & 1 ? 1 : -1, n[1] = 0, n[2] = byte_number(&s->in, 0, 1e-3);
}

static int32_t make_body(scene *s, int64_t bodies)
{
    if (take_bit(&s->in, s->odd, ODD_INDICES)) return (int32_t)take_integer(&s->in);
    return bodies > 0 ? (int32_t)((int64_t)take(&s->in, 1) % bodies) : 0;
}

static void make_contacts(scene *s)
{
    const nlc_particles *p = s->particles;
    const size_t rows = s->count > 0 && s->count < COUNTS ? (size_t)s->count : 0;
    const bool small = p->count >= 0 && p->count < COUNTS && p->wall_count >= 0 && p->wall_count < COUNTS;
    s->i = ARRAY(s, FIRST_BODY, rows, int32_t);
    s->j = ARRAY(s, SECOND_BODY, rows, int32_t);
    s->overlap = ARRAY(s, OVERLAP, rows, double);
    s->normal = ARRAY(s, NORMAL, 3 * rows, double);
    for (size_t c = 0; c < rows; c++) {
        s->i[c] = make_body(s, small ? p->count : 0);
        s->j[c] = make_body(s, small ? p->count + p->wall_count : 0);
        s->overlap[c] = make_overlap(s);
        make_normal(s, c, s->normal + 3 * c);
    }
}

/* ---- info */

/* One of any size, or none; *bad: one that cannot be written to. */
static nlc_info *make_info(scene *s, int number, bool *bad)
{
    const uint64_t kind = take(&s->in, 1);
    *bad = false;
    if (kind == 255) return NULL;
    size_t size = kind < 128 ? sizeof(nlc_info) : kind < 250 ? (size_t)kind : (size_t)take(&s->in, 2);
    const bool valid = size >= sizeof size && size <= 4096;
    char *at = room(number, valid ? size : sizeof size, s->behind, s->behind && valid ? (8 - size % 8) % 8 : 0);
    memcpy(at, &size, sizeof size);
    *bad = !valid;
    return (nlc_info *)(void *)at;
}

/* What every call leaves in it. */
static void look_at_info(const nlc_info *info, nlc_status status)
{
    if (!info) return;
    size_t size;
    memcpy(&size, info, sizeof size);
    const char *at = (const char *)info;
    int64_t culprit = -1;
    if (size < sizeof size || size > 4096) return;
    if (size >= offsetof(nlc_info, culprit) + sizeof culprit) memcpy(&culprit, at + offsetof(nlc_info, culprit), sizeof culprit);
    demand(status < 0 || culprit == -1, "info.culprit");
    for (size_t k = sizeof(nlc_info); k < size; k++) demand(at[k] == 0, "surplus bytes of info");
}

/* ---- what is called */

#define NETWORK_ERRORS NLC_ERROR_NULL, NLC_ERROR_STRUCT_SIZE, NLC_ERROR_NETWORK
#define INIT_ERRORS                                                                                                            \
    NLC_ERROR_NULL, NLC_ERROR_NULL_FIELD, NLC_ERROR_STRUCT_SIZE, NLC_ERROR_RESERVED, NLC_ERROR_COUNT, NLC_ERROR_STRIDE,        \
        NLC_ERROR_MEMORY_SIZE, NLC_ERROR_ALIGNMENT, NLC_ERROR_MODEL, NLC_ERROR_METHOD, NLC_ERROR_OPTION, NLC_ERROR_RADIUS,     \
        NLC_ERROR_MATERIAL, NLC_ERROR_YOUNG, NLC_ERROR_POISSON, NLC_ERROR_INDEX, NLC_ERROR_WALL_WALL, NLC_ERROR_RIGID_RIGID,   \
        NLC_ERROR_STIFFNESS, NLC_ERROR_RANGE, NLC_ERROR_GHOST

static bool build(scene *s)
{
    bool bad;
    nlc_network *network = (nlc_network *)(void *)s;
    watch();
    const size_t size = nlc_network_size(s->particles, s->count, s->options);
    unwatch("nlc_network_size");
    size_t given = size, shift = 0;
    if (take_bit(&s->in, s->odd, ODD_LAYOUT)) given -= given > 0 ? 1 + (size_t)take(&s->in, 2) % given : 0;
    if (take_bit(&s->in, s->odd, ODD_LAYOUT)) shift = take(&s->in, 1) % 8;
    if (given > ROOM - 8) given = ROOM - 8;
    char *memory = room(MEMORY, given, s->behind, shift);
    nlc_info *info = make_info(s, INFO, &bad);
    const nlc_status status =
        CALL(nlc_network_init(&network, memory, given, s->particles, s->i, s->j, s->count, s->options, info), 0, INIT_ERRORS);
    look_at_info(info, status);
    if (status != NLC_OK) {
        demand(is_filled(memory, given), "memory after an error");
        demand(network == (nlc_network *)(void *)s, "network after an error");
        return false;
    }
    demand(!bad && size > 0 && given == size && shift % 8 == 0, "what was accepted");
    demand((void *)network == memory, "network");
    s->network = network;
    s->contacts = (size_t)s->count;
    s->walls = (size_t)s->particles->wall_count;
    s->bodies = (size_t)s->particles->count + s->walls;
    return true;
}

/* The status of a call that has been made: the arrays as they were, or finite. */
static void look(nlc_status status, const double *now, const double *before, size_t count)
{
    if (status < 0) demand(same_bytes(now, before, count * sizeof *now), "results after an error");
    else demand(all_finite(now, count), "results");
}

/* A network of its own for the same, elsewhere and without callbacks, cache or history. */
static nlc_network *rebuild(scene *s)
{
    nlc_network *other = NULL;
    nlc_options o = {.struct_size = sizeof o};
    if (s->options) o = *s->options;
    o.cache = NULL, o.cache_size = 0, o.parallel_for = NULL, o.parallel_context = NULL;
    const size_t size = nlc_network_size(s->particles, s->count, &o);
    void *memory = room(OTHER_MEMORY, size, !s->behind, 0);
    watch();
    const nlc_status status = nlc_network_init(&other, memory, size, s->particles, s->i, s->j, s->count, &o, NULL);
    unwatch("nlc_network_init");
    demand(status == NLC_OK, "a network that was built before");
    return other;
}

static void solve(scene *s)
{
    const size_t n = s->contacts, size = n * sizeof(double);
    double *force = ARRAY(s, RESULT, n, double), *start = ARRAY(s, OTHER_RESULT, n, double), *old = ARRAY(s, SECOND_RESULT, n, double);
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    copy_bytes(start, s->nonlocal, size);
    copy_bytes(old, force, size);
    const nlc_status status = CALL(nlc_solve(s->network, force, s->nonlocal, s->overlap, s->normal, info), 15, NETWORK_ERRORS,
                                   NLC_ERROR_OVERLAP, NLC_ERROR_NORMAL, NLC_ERROR_NONLOCAL, NLC_ERROR_COINCIDENT, NLC_ERROR_RANGE);
    look_at_info(info, status);
    demand(!bad || status == NLC_ERROR_STRUCT_SIZE, "info of a wrong size");
    look(status, force, old, n);
    look(status, s->nonlocal, start, n);
    for (size_t c = 0; status >= 0 && c < n; c++) {
        demand(force[c] >= 0, "a force");
        demand((force[c] > 0) <= (s->overlap[c] + s->nonlocal[c] > -1e-300), "a force without an overlap");
    }
    if (bad) return;
    nlc_network *const again[] = {s->network, take(&s->in, 1) % 4 == 0 ? rebuild(s) : NULL};
    for (int k = 0; k < 2 && again[k]; k++) {
        nlc_info second = {.struct_size = sizeof second};
        copy_bytes(old, start, size); /* the start and what came of it, once more */
        double *second_force = ARRAY(s, CHANGE, n, double);
        CALL(nlc_solve(again[k], second_force, old, s->overlap, s->normal, &second) == status ? NLC_OK : NLC_ERROR_NETWORK, 0, 0);
        if (status < 0) continue;
        demand(same_bytes(force, second_force, size), k ? "forces of another network" : "forces, a second time");
        demand(same_bytes(s->nonlocal, old, size), k ? "displacements of another network" : "displacements, a second time");
        if (info && info->struct_size == sizeof second) demand(same_bytes(info, &second, sizeof second), "info, a second time");
    }
    if (status >= 0) copy_bytes(s->force, force, size);
}

static void sweep(scene *s)
{
    const size_t n = 2 * s->contacts, size = n * sizeof(double);
    double *second = ARRAY(s, RESULT, n, double), *old = ARRAY(s, OTHER_RESULT, n, double);
    const double *overlap = take(&s->in, 1) & 1 ? s->overlap : NULL;
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    copy_bytes(second, s->displacement, size);
    copy_bytes(old, s->displacement, size);
    const nlc_status status =
        CALL(nlc_sweep(s->network, s->displacement, s->force, overlap, s->normal, info), 0, NETWORK_ERRORS, NLC_ERROR_OVERLAP,
             NLC_ERROR_NORMAL, NLC_ERROR_NONLOCAL, NLC_ERROR_FORCE, NLC_ERROR_COINCIDENT, NLC_ERROR_RANGE);
    look_at_info(info, status);
    look(status, s->displacement, old, n);
    if (bad) return;
    nlc_network *const other = rebuild(s);
    CALL(nlc_sweep(other, second, s->force, overlap, s->normal, NULL) == status ? NLC_OK : NLC_ERROR_NETWORK, 0, 0);
    demand(same_bytes(second, s->displacement, size), "displacements of another network");
}

static void energy(scene *s)
{
    double *e = ARRAY(s, RESULT, 1, double), old, second;
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    memcpy(&old, e, sizeof old);
    const nlc_status status = CALL(nlc_energy(s->network, e, s->force, s->overlap, s->normal, info), NLC_WARNING_NOT_CONVERGED,
                                   NETWORK_ERRORS, NLC_ERROR_NO_POTENTIAL, NLC_ERROR_FORCE, NLC_ERROR_OVERLAP, NLC_ERROR_NORMAL,
                                   NLC_ERROR_COINCIDENT, NLC_ERROR_RANGE);
    look_at_info(info, status);
    look(status, e, &old, 1);
    if (bad || status < 0) return;
    nlc_network *const other = rebuild(s);
    CALL(nlc_energy(other, &second, s->force, s->overlap, s->normal, NULL), NLC_WARNING_NOT_CONVERGED, 0);
    demand(same_bytes(&second, e, sizeof second), "the energy of another network");
}

#define TANGENT_ERRORS NETWORK_ERRORS, NLC_ERROR_NO_POTENTIAL, NLC_ERROR_FORCE, NLC_ERROR_NORMAL, NLC_ERROR_RANGE

/* which: 0 the tangent, 1 its inverse, 2 the bound */
static void tangent(scene *s, int which)
{
    const size_t n = which == 2 ? s->bodies - s->walls : s->contacts, size = n * sizeof(double);
    double *x = ARRAY(s, RESULT, n, double), *old = ARRAY(s, OTHER_RESULT, n, double), *second = ARRAY(s, SECOND_RESULT, n, double);
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    copy_bytes(old, x, size);
    nlc_status status = NLC_OK;
    for (int k = 0; k < 2; k++) {
        nlc_network *const network = k ? rebuild(s) : s->network;
        double *const to = k ? second : x;
        const nlc_status found = which == 0 ? CALL(nlc_tangent(network, to, s->change, s->force, s->normal, k ? NULL : info),
                                                   NLC_WARNING_NOT_CONVERGED, TANGENT_ERRORS, NLC_ERROR_OVERLAP, NLC_ERROR_COINCIDENT,
                                                   NLC_ERROR_UNSTABLE)
            : which == 1 ? CALL(nlc_tangent_inverse(network, to, s->change, s->force, s->normal, k ? NULL : info), 0, TANGENT_ERRORS,
                                NLC_ERROR_COINCIDENT)
                         : CALL(nlc_tangent_bound(network, to, s->force, s->normal, k ? NULL : info), 0, TANGENT_ERRORS, NLC_ERROR_UNSTABLE);
        if (k == 0) status = found;
        else demand(found == status, "the status of another network");
        if (bad) return;
    }
    look_at_info(info, status);
    look(status, x, old, n);
    demand(same_bytes(x, second, size), "what another network gives");
}

/* The bodies' forces or torques before: finite, or anything. */
static double *make_totals(scene *s, int number, size_t count)
{
    double *x = ARRAY(s, number, 3 * count, double);
    for (size_t k = 0; k < 3 * count; k++) x[k] = take_bit(&s->in, s->odd, ODD_STATE) ? take_any(&s->in) : 1;
    return x;
}

static void assemble(scene *s, bool with_sliding)
{
    const size_t n = s->bodies - s->walls;
    double *F[2] = {make_totals(s, TOTAL, n), ARRAY(s, SECOND_TOTAL, 3 * n, double)},
           *torque[2] = {make_totals(s, TORQUE, n), ARRAY(s, SECOND_TORQUE, 3 * n, double)},
           *wall[2] = {make_totals(s, WALL_FORCE, s->walls), ARRAY(s, SECOND_WALL_FORCE, 3 * s->walls, double)};
    const bool has_walls = take(&s->in, 1) & 1, has_displacements = take(&s->in, 1) & 1;
    const double friction = take_bit(&s->in, s->odd, ODD_OPTIONS) ? take_any(&s->in) : 0.5;
    static const ptrdiff_t strides[] = {0, 24, 23, -1, 1, PTRDIFF_MIN, PTRDIFF_MAX, 8};
    const ptrdiff_t stride = take_bit(&s->in, s->odd, ODD_LAYOUT) && n > 1 ? strides[take(&s->in, 1) % 8] : 0;
    double *t = ARRAY(s, SLIDING, 3 * s->contacts, double);
    for (size_t c = 0; with_sliding && c < s->contacts; c++) {
        const double *v = s->normal + 3 * c, r = sqrt(v[0] * v[0] + v[1] * v[1]);
        const bool moves = r > 0.1 && r < 2 && take(&s->in, 1) & 1;
        t[3 * c] = moves ? -v[1] / r : 0, t[3 * c + 1] = moves ? v[0] / r : 0, t[3 * c + 2] = 0;
        if (take_bit(&s->in, s->odd, ODD_STATE)) t[3 * c + take(&s->in, 1) % 3] = take_any(&s->in);
    }
    copy_bytes(F[1], F[0], 24 * n), copy_bytes(torque[1], torque[0], 24 * n), copy_bytes(wall[1], wall[0], 24 * s->walls);
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    nlc_status status[2] = {NLC_OK, NLC_OK};
    for (int k = 0; k < (bad ? 1 : 2); k++) {
        if (k == 1 && status[0] < 0) { /* what was there still is */
            demand(same_bytes(F[0], F[1], 24 * n) && same_bytes(torque[0], torque[1], 24 * n) && same_bytes(wall[0], wall[1], 24 * s->walls),
                   "results after an error");
            return;
        }
        const nlc_network *network = k ? rebuild(s) : s->network;
        double *const on_walls = has_walls ? wall[k] : NULL, *const w = has_displacements ? s->displacement : NULL;
        status[k] = with_sliding
            ? CALL(nlc_assemble_sliding(network, F[k], stride, torque[k], 0, on_walls, s->force, s->normal, t, w, s->overlap, friction,
                                        k ? NULL : info),
                   0, NETWORK_ERRORS, NLC_ERROR_STRIDE, NLC_ERROR_OPTION, NLC_ERROR_FORCE, NLC_ERROR_NORMAL, NLC_ERROR_TOTAL_FORCE,
                   NLC_ERROR_SLIDING, NLC_ERROR_NONLOCAL, NLC_ERROR_OVERLAP, NLC_ERROR_RANGE)
            : CALL(nlc_assemble(network, F[k], stride, on_walls, s->force, s->normal, k ? NULL : info), 0, NETWORK_ERRORS,
                   NLC_ERROR_STRIDE, NLC_ERROR_FORCE, NLC_ERROR_NORMAL, NLC_ERROR_TOTAL_FORCE, NLC_ERROR_RANGE);
        if (k == 0) look_at_info(info, status[0]);
    }
    demand(bad || status[0] == status[1], "the status of another network");
    demand(status[0] < 0 || s->contacts == 0 || (all_finite(F[0], 3 * n) && (!has_walls || all_finite(wall[0], 3 * s->walls))), "totals");
    demand(bad || (same_bytes(F[0], F[1], 24 * n) && same_bytes(torque[0], torque[1], 24 * n) && same_bytes(wall[0], wall[1], 24 * s->walls)),
           "totals of another network");
}

static void reach(scene *s)
{
    const size_t n = s->bodies - s->walls;
    double *x = ARRAY(s, RESULT, 1, double), *each = ARRAY(s, OTHER_RESULT, n, double), *old = ARRAY(s, SECOND_RESULT, n + 1, double);
    const bool wanted = take(&s->in, 1) & 1;
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    copy_bytes(old, x, sizeof *x);
    copy_bytes(old + 1, each, n * sizeof *each);
    const nlc_status status =
        CALL(nlc_reach(s->network, x, wanted ? each : NULL, s->force, info), 0, NETWORK_ERRORS, NLC_ERROR_FORCE, NLC_ERROR_RANGE);
    look_at_info(info, status);
    look(status, x, old, 1);
    if (wanted || status < 0) look(status, each, old + 1, n);
    demand(status < 0 || *x >= 0, "reach");
}

static void set_options(scene *s)
{
    /* the old ones must survive: they are what the network is built from again */
    const nlc_options *old = s->options;
    nlc_options kept = {0};
    static double kept_stiffness[COUNTS];
    if (old) kept = *old;
    if (old && old->stiffness) copy_bytes(kept_stiffness, old->stiffness, s->contacts * sizeof(double));
    make_options(s);
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    const nlc_status status =
        CALL(nlc_set_options(s->network, s->options, info), 0, NETWORK_ERRORS, NLC_ERROR_RESERVED, NLC_ERROR_MODEL, NLC_ERROR_METHOD,
             NLC_ERROR_OPTION, NLC_ERROR_ALIGNMENT, NLC_ERROR_STIFFNESS, NLC_ERROR_RANGE, NLC_ERROR_NULL_FIELD, NLC_ERROR_GHOST);
    look_at_info(info, status);
    if (status == NLC_OK) return;
    s->options = NULL;
    if (!old) return;
    s->options = ARRAY(s, OPTIONS, 1, nlc_options);
    *s->options = kept;
    if (kept.cache) /* it may have moved, but its size has not: give it back */
        s->options->cache = room(CACHE, kept.cache_size, s->behind, (8 - kept.cache_size % 8) % 8 * s->behind);
    if (!kept.stiffness) return;
    double *k = ARRAY(s, STIFFNESS, s->contacts, double);
    copy_bytes(k, kept_stiffness, s->contacts * sizeof *k);
    s->options->stiffness = k;
}

/* Arbitrary numbers in the state, or other overlaps. */
static void change_state(scene *s)
{
    double *const arrays[] = {s->overlap, s->normal, s->force, s->nonlocal, s->displacement, s->change};
    const size_t sizes[] = {1, 3, 1, 1, 2, 1};
    const uint64_t which = take(&s->in, 1) % 8;
    if (s->contacts == 0) return;
    if (which >= 6) {
        for (size_t c = 0; c < s->contacts; c++) s->overlap[c] += byte_number(&s->in, -1e-3, 1e-3) * (s->overlap[c] < 1);
        return;
    }
    const size_t at = (size_t)take(&s->in, 1) % (sizes[which] * s->contacts);
    if (s->odd >> ODD_STATE & 1) arrays[which][at] = take_any(&s->in);
    else if (which >= 2) arrays[which][at] = byte_number(&s->in, 0, which == 2 ? 1e6 : 0.1);
}

static void step(scene *s)
{
    switch (take(&s->in, 1) % 16) {
    case 0: case 1: case 2: solve(s); break;
    case 3: sweep(s); break;
    case 4: energy(s); break;
    case 5: tangent(s, 0); break;
    case 6: tangent(s, 1); break;
    case 7: tangent(s, 2); break;
    case 8: assemble(s, false); break;
    case 9: assemble(s, true); break;
    case 10: reach(s); break;
    case 11: case 12: set_options(s); break;
    default: change_state(s);
    }
    for (int k = 0; k < USED; k++) demand(room_intact(k), "what lies around an array");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    scene s = {.in = {data, size}};
    s.odd = take(&s.in, 1);
    s.behind = !(take(&s.in, 1) & 1);
    make_particles(&s);
    s.count = make_count(&s, 256);
    if (s.count > CONTACTS && s.count < 240) s.count %= CONTACTS + 1;
    else if (s.count >= 240 && s.count < 256) s.count += MANY - 240; /* so many that one particle can have more than a block holds */
    make_contacts(&s);
    if (s.count >= 0 && s.count < COUNTS) make_options(&s);
    if (!build(&s)) return 0;
    s.force = ARRAY(&s, FORCE, s.contacts, double);
    s.nonlocal = ARRAY(&s, NONLOCAL, s.contacts, double);
    s.displacement = ARRAY(&s, DISPLACEMENT, 2 * s.contacts, double);
    static double change[COUNTS];
    s.change = change;
    for (size_t c = 0; c < s.contacts; c++)
        s.force[c] = s.nonlocal[c] = s.displacement[2 * c] = s.displacement[2 * c + 1] = 0, change[c] = 1e-6 * (double)(c % 5);
    solve(&s);
    for (int k = 0; k < STEPS && s.in.left > 0; k++) step(&s);
    return 0;
}
