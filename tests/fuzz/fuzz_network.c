/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fuzz_network.c - a network from arbitrary bytes, and a few of the functions that take one, in arbitrary order.
 *
 * With a first byte of 0 most inputs are scenes that can be solved; its bits let arbitrary numbers in.  What is demanded: nothing
 * outside of the arrays is touched, no exception is raised, nothing but *info changes on an error, a status is one of those in the
 * header, results are finite (forces not negative), and have the same bits a second time, in another network, elsewhere in
 * memory, with other callbacks and cache.  A rank's callbacks may fail at any call, and bring any numbers from ghosts.
 */
#include "fuzz.h"

#include <math.h>
#include <string.h>

enum { PARTICLES = 12, WALLS = 3, MATERIALS = 4, CONTACTS = 20, MANY = 50, COUNTS = 96, STEPS = 6, WORK = 1000 };

/* What may be arbitrary. */
enum { ODD_COUNTS, ODD_INDICES, ODD_BODIES, ODD_NORMALS, ODD_OVERLAPS, ODD_OPTIONS, ODD_LAYOUT, ODD_STATE };

/* The rooms.  Those of particles are there twice: while a network is updated the old ones have to survive. */
enum {
    RADIUS, MATERIAL, ROWS, WALL_MATERIAL, SIZES, UPDATED, FIRST_BODY = 2 * UPDATED, SECOND_BODY, OVERLAP, NORMAL, SLIDING, STIFFNESS,
    OPTIONS, INFO, OTHER_INFO, MEMORY, OTHER_MEMORY, CACHE, FORCE, NONLOCAL, DISPLACEMENT, CHANGE, RESULT, SECOND_RESULT, OTHER_RESULT, TOTAL, TORQUE, WALL_FORCE,
    SECOND_TOTAL, SECOND_TORQUE, SECOND_WALL_FORCE, USED
};
_Static_assert((int)USED <= (int)ROOMS, "too few rooms");

typedef struct scene {
    bytes in;
    uint64_t odd;
    bool behind;
    bool large; /* no bounds on the work of one input */
    int rooms; /* of the particles: 0 or UPDATED */
    nlc_particles *particles;
    nlc_options *options; /* NULL: none */
    const double *stiffness; /* what the network was given last: NULL or a copy */
    int64_t fail_at;         /* the callback that fails in each collective function; 0: none */
    nlc_status rehearsal;    /* what that came to */
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

/*
 * A rank that is alone: its own sums, and ghosts, if there are any, whose owners are not here, so that any numbers are brought.
 * From one collective function to the next everything begins anew.
 */
static struct {
    int64_t calls, fail_at; /* in this function; the number of the one that fails, 0: none */
    int answer;             /* of that one */
    int32_t count[2];       /* of what is reduced */
    int64_t contacts, ghosts[2]; /* the first ghost and the body behind the last one */
    const int32_t *i, *j;
    uint64_t kind;          /* of the numbers that are brought from ghosts */
    double odd;             /* one of them */
} host;

static int answer(int64_t turn)
{
    demand(host.calls++ % 3 == turn, "a callback out of turn");
    demand(host.fail_at == 0 || host.calls <= host.fail_at + 3, "calls after one that has failed");
    return host.calls == host.fail_at ? host.answer : 0;
}

static int exchange(void *context, double *side)
{
    const int failed = answer(0);
    demand(context == &host, "a callback's context");
    demand(all_finite(side, 2 * (size_t)host.contacts), "what is handed to an exchange");
    for (int64_t e = 0; e < 2 * host.contacts; e++) {
        const int32_t body = e % 2 ? host.j[e / 2] : host.i[e / 2];
        if (body < host.ghosts[0] || body >= host.ghosts[1]) continue;
        const uint64_t k = (uint64_t)(host.calls + e) + host.kind;
        const double numbers[4] = {side[e ^ 1], -side[e ^ 1], 0, 1e-3 * (double)(k * k % 31)};
        side[e] = failed ? NAN : host.kind >> 8 != 0 && k % 16 == 0 ? host.odd : numbers[host.kind % 4];
    }
    return failed;
}

static int reduce(void *context, double *values, int32_t count, int32_t operation)
{
    const bool is_max = operation == NLC_REDUCE_MAX;
    demand(context == &host, "a callback's context");
    demand(is_max || operation == NLC_REDUCE_SUM, "what is to be done");
    demand(count > 0 && count < 1000 && (host.count[is_max] == 0 || host.count[is_max] == count), "how much is to be reduced");
    host.count[is_max] = count;
    const int failed = answer(1 + is_max);
    for (int32_t k = 0; k < count; k++) {
        demand(!isnan(values[k]), "what is to be reduced");
        if (failed) values[k] = NAN;
    }
    return failed;
}

/* kind: of what comes from ghosts, 0 without any. */
static void set_host(scene *s, nlc_options *o, uint64_t kind)
{
    o->exchange = exchange, o->reduce = reduce, o->context = &host;
    host.kind = kind;
    if (kind == 0) return;
    o->owned_particles = s->particles->count > 0 ? 1 + (int64_t)(take(&s->in, 1) % (uint64_t)s->particles->count) : 0;
    if (kind >> 8 != 0) host.odd = take_any(&s->in);
}

/*
 * A bound for max_sweeps.  Nine tenths of the time went into a tenth of the inputs: solves that do not converge, between many
 * contacts of few particles, whose sweeps take a step for each two contacts that share a particle.
 */
static int64_t most_sweeps(const scene *s)
{
    int64_t contacts[COUNTS] = {0}, pairs = 1;
    if (s->large) return INT64_MAX;
    for (int64_t e = 0; e < 2 * s->count; e++) {
        const int32_t body = (e % 2 ? s->j : s->i)[e / 2];
        if (body >= 0 && body < COUNTS && body < s->particles->count) pairs += 2 * contacts[body]++ + 1;
    }
    return 2 + WORK / pairs;
}

static void bound_sweeps(nlc_options *o, int64_t most)
{
    if (most < INT64_MAX && (o->max_sweeps == 0 || o->max_sweeps > most)) o->max_sweeps = most;
}

static void make_options(scene *s)
{
    bytes *in = &s->in;
    const int64_t most = most_sweeps(s);
    const uint64_t kind = take(in, 1);
    s->options = NULL;
    if (kind == 255 && most > 50) return;
    nlc_options *o = s->options = ARRAY(s, OPTIONS, 1, nlc_options);
    *o = (nlc_options){.struct_size = sizeof *o, .model = (int32_t)(kind % 6), .method = kind / 6 % 8 == 1};
    if (kind == 255) { /* as without options, but for that */
        *o = (nlc_options){.struct_size = sizeof *o, .max_sweeps = most};
        return;
    }
    if (take(in, 1) & 1) o->tolerance = ldexp(1, -(int)(take(in, 1) % 64));
    const uint64_t sweeps = take(in, 1);
    o->max_sweeps = sweeps == 255 ? 0 : 1 + (int64_t)sweeps / 4;
    bound_sweeps(o, most);
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
    if (kind >= 246) set_host(s, o, 0);
    if (take_bit(in, s->odd, ODD_OPTIONS)) {
        const uint64_t which = take(in, 1);
        switch (which < 250 ? which % 10 : which) { /* owned particles less than all need an exchange with others */
        case 0: o->model = (int32_t)take_integer(in); break;
        case 1: o->method = (int32_t)take_integer(in); break;
        case 2: o->tolerance = take_any(in); break;
        case 3: o->max_sweeps = take_integer(in); break;
        case 4: o->prefactor = take_any(in); break;
        case 5: o->simd = (int32_t)take_integer(in); break;
        case 6: o->points = (int32_t)take_integer(in); break;
        case 7: o->owned_particles = take_integer(in), o->exchange = NULL, o->reduce = NULL; break;
        case 8: o->reduce = reduce; break;
        case 9: o->cache = (void *)((uintptr_t)o->cache + (uintptr_t)take(in, 1) % 8); break;
        default: set_host(s, o, take(in, 2));
        }
        if (o->max_sweeps > 4096) o->max_sweeps &= 4095; /* what does not converge would go on for ever */
        bound_sweeps(o, most);
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
    char *p = room(s->rooms + number, rows == 0 ? 0 : (rows - 1) * apart + size, s->behind, 0);
    return step < 0 && rows > 0 ? p + (rows - 1) * apart : p;
}

static void make_materials(scene *s)
{
    nlc_particles *p = s->particles;
    const size_t extra = take_bit(&s->in, s->odd, ODD_LAYOUT) ? (size_t)take(&s->in, 1) % 40 : 0;
    const size_t row = sizeof(nlc_material) + extra, rows = p->material_count > 0 && p->material_count < COUNTS ? (size_t)p->material_count : 0;
    char *at = room(s->rooms + ROWS, rows * row, s->behind, 0);
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

/* Of new counts, or of those of others. */
static void make_particles(scene *s, const nlc_particles *like)
{
    nlc_particles *p = s->particles = ARRAY(s, s->rooms + SIZES, 1, nlc_particles);
    *p = (nlc_particles){.struct_size = sizeof *p};
    p->count = like ? like->count : make_count(s, PARTICLES + 1);
    p->wall_count = like ? like->wall_count : make_count(s, WALLS + 1);
    p->material_count = like ? like->material_count : make_count(s, MATERIALS);
    if (p->material_count == 0 && !like && !(s->odd & 1u << ODD_COUNTS)) p->material_count = 1;
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
        int32_t *w = ARRAY(s, s->rooms + WALL_MATERIAL, p->wall_count, int32_t);
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

/* info.culprit, or something else where it has no room. */
static int64_t culprit_of(const nlc_info *info, int64_t otherwise)
{
    size_t size = 0;
    if (info) memcpy(&size, info, sizeof size);
    if (size < offsetof(nlc_info, culprit) + sizeof otherwise || size > 4096) return otherwise;
    memcpy(&otherwise, (const char *)info + offsetof(nlc_info, culprit), sizeof otherwise);
    return otherwise;
}

/* What every call leaves in it. */
static void look_at_info(const nlc_info *info, nlc_status status)
{
    if (!info) return;
    size_t size;
    memcpy(&size, info, sizeof size);
    const char *at = (const char *)info;
    if (size < sizeof size || size > 4096) return;
    demand(status < 0 || culprit_of(info, -1) == -1, "info.culprit");
    for (size_t k = sizeof(nlc_info); k < size; k++) demand(at[k] == 0, "surplus bytes of info");
}

/* ---- what is called */

#define NETWORK_ERRORS NLC_ERROR_NULL, NLC_ERROR_STRUCT_SIZE, NLC_ERROR_NETWORK
#define INIT_ERRORS                                                                                                            \
    NLC_ERROR_NULL, NLC_ERROR_NULL_FIELD, NLC_ERROR_STRUCT_SIZE, NLC_ERROR_RESERVED, NLC_ERROR_COUNT, NLC_ERROR_STRIDE,        \
        NLC_ERROR_MEMORY_SIZE, NLC_ERROR_ALIGNMENT, NLC_ERROR_MODEL, NLC_ERROR_METHOD, NLC_ERROR_OPTION, NLC_ERROR_RADIUS,     \
        NLC_ERROR_MATERIAL, NLC_ERROR_YOUNG, NLC_ERROR_POISSON, NLC_ERROR_INDEX, NLC_ERROR_WALL_WALL, NLC_ERROR_RIGID_RIGID,   \
        NLC_ERROR_STIFFNESS, NLC_ERROR_RANGE, NLC_ERROR_GHOST

/* What it is to be built from again. */
static void keep_stiffness(scene *s, const double *stiffness)
{
    static double kept[COUNTS];
    if (stiffness) copy_bytes(kept, stiffness, s->contacts * sizeof *kept);
    s->stiffness = stiffness ? kept : NULL;
}

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
    keep_stiffness(s, s->options ? s->options->stiffness : NULL);
    s->walls = (size_t)s->particles->wall_count;
    s->bodies = (size_t)s->particles->count + s->walls;
    return s->bodies <= ROOM / (3 * sizeof(double)); /* of walls there may be any number, and for more there is no room here */
}

/* The status of a call that has been made: the arrays as they were, or finite. */
static void look(nlc_status status, const double *now, const double *before, size_t count)
{
    if (status < 0) demand(same_bytes(now, before, count * sizeof *now), "results after an error");
    else demand(all_finite(now, count), "results");
}

/*
 * A collective function, with count results each in x and perhaps in y, and how these were before.  On ranks whose callbacks fail it
 * is called once more, before, with callbacks of which one does: that has to be what it returns, unless it would return another
 * error, and nothing may be left of it.
 */
typedef struct results {
    double *x;
    const double *x_before;
    size_t count;
    double *y;
    const double *y_before;
} results;

static bool fails(const scene *s)
{
    return s->fail_at > 0 && s->options && s->options->exchange;
}

static void begin(scene *s, int64_t fail_at)
{
    const int64_t particles = (int64_t)(s->bodies - s->walls), owned = s->options ? s->options->owned_particles : 0;
    host.calls = 0, host.fail_at = fail_at, host.count[0] = host.count[1] = 0;
    host.contacts = (int64_t)s->contacts, host.i = s->i, host.j = s->j;
    host.ghosts[0] = owned > 0 ? owned : particles, host.ghosts[1] = particles;
}

/* Whether a failure may be told without one: for what ghosts have brought, which is too much for any owner. */
static bool is_odd(void)
{
    return host.ghosts[0] < host.ghosts[1] && host.kind >> 8 != 0 && !(fabs(host.odd) < 0x1p450);
}

static void rehearsed(scene *s, const nlc_info *info, const results *r, nlc_status status)
{
    const int64_t culprit = culprit_of(info, host.answer);
    s->rehearsal = NLC_OK;
    if (host.calls < host.fail_at && status >= 0) { /* too few calls */
        copy_bytes(r->x, r->x_before, r->count * sizeof(double));
        if (r->y) copy_bytes(r->y, r->y_before, r->count * sizeof(double));
        return;
    }
    s->rehearsal = status;
    demand(status < 0, "the status of a callback that fails");
    demand(status != NLC_ERROR_CALLBACK || culprit == host.answer || is_odd(), "info.culprit of a callback that fails");
    demand(same_bytes(r->x, r->x_before, r->count * sizeof(double)), "results after a callback that fails");
    demand(!r->y || same_bytes(r->y, r->y_before, r->count * sizeof(double)), "results after a callback that fails");
}

static nlc_status performed(const scene *s, nlc_status status)
{
    demand(!fails(s) || s->rehearsal == NLC_OK || s->rehearsal == NLC_ERROR_CALLBACK || s->rehearsal == status, "the other error");
    demand(status != NLC_ERROR_CALLBACK || is_odd(), "a callback that does not fail");
    return status;
}

#define COLLECTIVE(s, info, r, call, warnings, ...)                                                                            \
    ((void)(fails(s) && (begin(s, (s)->fail_at), rehearsed(s, info, r, CALL(call, 15, __VA_ARGS__, NLC_ERROR_CALLBACK)), 0)),   \
     begin(s, 0), performed(s, CALL(call, warnings, __VA_ARGS__, NLC_ERROR_CALLBACK)))

/* A network of its own for the same, elsewhere and without callbacks, cache or history. */
static nlc_status init_again(scene *s, nlc_network **other)
{
    nlc_options o = {.struct_size = sizeof o};
    if (s->options) o = *s->options;
    o.cache = NULL, o.cache_size = 0, o.parallel_for = NULL, o.parallel_context = NULL, o.stiffness = s->stiffness;
    const size_t size = nlc_network_size(s->particles, s->count, &o);
    void *memory = room(OTHER_MEMORY, size, !s->behind, 0);
    watch();
    const nlc_status status = nlc_network_init(other, memory, size, s->particles, s->i, s->j, s->count, &o, NULL);
    unwatch("nlc_network_init");
    return status;
}

static nlc_network *rebuild(scene *s)
{
    nlc_network *other = NULL;
    demand(init_again(s, &other) == NLC_OK, "a network that was built before");
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
    const results r = {force, old, n, s->nonlocal, start};
    const nlc_status status =
        COLLECTIVE(s, info, &r, nlc_solve(s->network, force, s->nonlocal, s->overlap, s->normal, info), 15, NETWORK_ERRORS,
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
        begin(s, 0);
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
    const results r = {s->displacement, old, n, NULL, NULL};
    const nlc_status status = COLLECTIVE(s, info, &r, nlc_sweep(s->network, s->displacement, s->force, overlap, s->normal, info), 0,
                                         NETWORK_ERRORS, NLC_ERROR_OVERLAP, NLC_ERROR_NORMAL, NLC_ERROR_NONLOCAL, NLC_ERROR_FORCE,
                                         NLC_ERROR_COINCIDENT, NLC_ERROR_RANGE);
    look_at_info(info, status);
    look(status, s->displacement, old, n);
    if (bad) return;
    nlc_network *const other = rebuild(s);
    begin(s, 0);
    CALL(nlc_sweep(other, second, s->force, overlap, s->normal, NULL) == status ? NLC_OK : NLC_ERROR_NETWORK, 0, 0);
    demand(same_bytes(second, s->displacement, size), "displacements of another network");
}

static void energy(scene *s)
{
    double *e = ARRAY(s, RESULT, 1, double), old, second;
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    memcpy(&old, e, sizeof old);
    const results r = {e, &old, 1, NULL, NULL};
    const nlc_status status = COLLECTIVE(s, info, &r, nlc_energy(s->network, e, s->force, s->overlap, s->normal, info),
                                         NLC_WARNING_NOT_CONVERGED, NETWORK_ERRORS, NLC_ERROR_NO_POTENTIAL, NLC_ERROR_FORCE,
                                         NLC_ERROR_OVERLAP, NLC_ERROR_NORMAL, NLC_ERROR_COINCIDENT, NLC_ERROR_RANGE);
    look_at_info(info, status);
    look(status, e, &old, 1);
    if (bad || status < 0) return;
    nlc_network *const other = rebuild(s);
    begin(s, 0);
    CALL(nlc_energy(other, &second, s->force, s->overlap, s->normal, NULL), NLC_WARNING_NOT_CONVERGED, 0);
    demand(same_bytes(&second, e, sizeof second), "the energy of another network");
}

#define TANGENT_ERRORS NETWORK_ERRORS, NLC_ERROR_NO_POTENTIAL, NLC_ERROR_MEMORY_SIZE, NLC_ERROR_FORCE, NLC_ERROR_NORMAL, NLC_ERROR_RANGE

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
        const results r = {k ? second : x, old, n, NULL, NULL};
        nlc_info *const its = k ? NULL : info;
        const nlc_status found =
            which == 0   ? COLLECTIVE(s, its, &r, nlc_tangent(network, r.x, s->change, s->force, s->normal, its), NLC_WARNING_NOT_CONVERGED,
                                      TANGENT_ERRORS, NLC_ERROR_OVERLAP, NLC_ERROR_COINCIDENT, NLC_ERROR_UNSTABLE)
            : which == 1 ? COLLECTIVE(s, its, &r, nlc_tangent_inverse(network, r.x, s->change, s->force, s->normal, its), 0,
                                      TANGENT_ERRORS, NLC_ERROR_COINCIDENT)
                         : COLLECTIVE(s, its, &r, nlc_tangent_bound(network, r.x, s->force, s->normal, its), 0, TANGENT_ERRORS,
                                      NLC_ERROR_COINCIDENT, NLC_ERROR_UNSTABLE);
        if (bad) return;
        if (k == 0) status = found;
        else if (found == NLC_ERROR_MEMORY_SIZE) copy_bytes(second, x, size); /* it has memory for its options only */
        else demand(found == status, "the status of another network");
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

enum { PUSH, SLIDE, TURN };

static void assemble(scene *s, int how)
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
    for (size_t c = 0; how == SLIDE && c < s->contacts; c++) {
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
        nlc_info *const its = k ? NULL : info;
        status[k] = how == SLIDE
            ? CALL(nlc_assemble_sliding(network, F[k], stride, torque[k], 0, on_walls, s->force, s->normal, t, w, s->overlap, friction, its),
                   0, NETWORK_ERRORS, NLC_ERROR_STRIDE, NLC_ERROR_OPTION, NLC_ERROR_FORCE, NLC_ERROR_NORMAL, NLC_ERROR_TOTAL_FORCE,
                   NLC_ERROR_SLIDING, NLC_ERROR_NONLOCAL, NLC_ERROR_OVERLAP, NLC_ERROR_RANGE)
            : how == TURN ? CALL(nlc_assemble_turning(network, F[k], stride, s->force, s->overlap, s->normal, its), 0, NETWORK_ERRORS,
                                 NLC_ERROR_NO_POTENTIAL, NLC_ERROR_STRIDE, NLC_ERROR_FORCE, NLC_ERROR_NORMAL, NLC_ERROR_TOTAL_FORCE,
                                 NLC_ERROR_OVERLAP, NLC_ERROR_COINCIDENT, NLC_ERROR_RANGE)
                          : CALL(nlc_assemble(network, F[k], stride, on_walls, s->force, s->normal, its), 0, NETWORK_ERRORS,
                                 NLC_ERROR_STRIDE, NLC_ERROR_FORCE, NLC_ERROR_NORMAL, NLC_ERROR_TOTAL_FORCE, NLC_ERROR_RANGE);
        if (k == 0) look_at_info(info, status[0]);
    }
    demand(bad || status[0] == status[1], "the status of another network");
    demand(status[0] < 0 || s->contacts == 0 || (all_finite(F[0], 3 * n) && (!has_walls || how == TURN || all_finite(wall[0], 3 * s->walls))), "totals");
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

/* Every particle and every contact once; what comes later finds whether the network has been changed. */
static void order(scene *s)
{
    const size_t n = s->bodies - s->walls;
    int32_t *particle = ARRAY(s, RESULT, n, int32_t);
    int64_t *contact = ARRAY(s, OTHER_RESULT, s->contacts, int64_t);
    const nlc_status status = CALL(nlc_order(s->network, particle, contact, NULL), 0, 0);
    demand(status == NLC_OK, "nlc_order");
    for (size_t k = 0, found; k < n; k++) {
        for (found = 0; found < n && particle[found] != (int32_t)k;) found++;
        demand(found < n, "a particle");
    }
    for (size_t c = 0, found; c < s->contacts; c++) {
        for (found = 0; found < s->contacts && contact[found] != (int64_t)c;) found++;
        demand(found < s->contacts, "a contact");
    }
}

static void set_options(scene *s)
{
    /* the old ones must survive: they are what the network is built from again */
    const nlc_options *old = s->options;
    nlc_options kept = {0};
    if (old) kept = *old;
    make_options(s);
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    const nlc_status status =
        CALL(nlc_set_options(s->network, s->options, info), 0, NETWORK_ERRORS, NLC_ERROR_RESERVED, NLC_ERROR_MODEL, NLC_ERROR_METHOD,
             NLC_ERROR_OPTION, NLC_ERROR_ALIGNMENT, NLC_ERROR_STIFFNESS, NLC_ERROR_RANGE, NLC_ERROR_NULL_FIELD, NLC_ERROR_GHOST,
             NLC_ERROR_MEMORY_SIZE);
    look_at_info(info, status);
    if (status == NLC_OK) {
        keep_stiffness(s, s->options ? s->options->stiffness : NULL);
        return;
    }
    s->options = NULL;
    if (!old) return;
    s->options = ARRAY(s, OPTIONS, 1, nlc_options);
    *s->options = kept;
    if (kept.cache) /* it may have moved, but its size has not: give it back */
        s->options->cache = room(CACHE, kept.cache_size, s->behind, (8 - kept.cache_size % 8) % 8 * s->behind);
}

/* Other radii and materials for the same contacts: accepted where a new network would be, then the same as that. */
static void update(scene *s)
{
    nlc_particles *const old = s->particles;
    nlc_particles like = *old;
    const bool others = take_bit(&s->in, s->odd, ODD_COUNTS);
    if (others) *(int64_t *[]){&like.count, &like.wall_count, &like.material_count}[take(&s->in, 1) % 3] = make_count(s, PARTICLES);
    const bool same = like.count == old->count && like.wall_count == old->wall_count && like.material_count == old->material_count;
    double *k = take(&s->in, 1) & 1 ? ARRAY(s, STIFFNESS, s->contacts, double) : NULL;
    for (size_t c = 0; k && c < s->contacts; c++) k[c] = take_bit(&s->in, s->odd, ODD_OPTIONS) ? take_any(&s->in) : byte_number(&s->in, 1e8, 1e10);
    s->rooms = UPDATED - s->rooms;
    make_particles(s, &like);
    bool bad;
    nlc_info *info = make_info(s, INFO, &bad);
    const nlc_status status =
        CALL(nlc_network_update(s->network, s->particles, k, info), 0, NLC_ERROR_NULL, NLC_ERROR_NULL_FIELD, NLC_ERROR_STRUCT_SIZE,
             NLC_ERROR_RESERVED, NLC_ERROR_NETWORK, NLC_ERROR_COUNT, NLC_ERROR_STRIDE, NLC_ERROR_RADIUS, NLC_ERROR_MATERIAL,
             NLC_ERROR_YOUNG, NLC_ERROR_POISSON, NLC_ERROR_RIGID_RIGID, NLC_ERROR_STIFFNESS, NLC_ERROR_RANGE);
    look_at_info(info, status);
    demand(status != NLC_OK || (same && !bad), "what was accepted");
    if (same && !bad) {
        const double *const given = s->stiffness;
        nlc_network *other = NULL;
        s->stiffness = k;
        demand(init_again(s, &other) == status, "the status of a new network");
        s->stiffness = given;
    }
    if (status == NLC_OK) {
        keep_stiffness(s, k);
        return;
    }
    s->particles = old;
    s->rooms = UPDATED - s->rooms;
}

/* Room for all that can be kept; none for what is no network. */
static void cache_size(scene *s)
{
    static char none[64];
    const nlc_network *const other = rebuild(s);
    watch();
    const size_t size = nlc_cache_size(s->network), again = nlc_cache_size(other);
    const size_t nothing = nlc_cache_size(NULL) + nlc_cache_size((const nlc_network *)(const void *)none);
    unwatch("nlc_cache_size");
    demand(size == again && size % 8 == 0 && nothing == 0, "nlc_cache_size");
    if (!s->options || size > ROOM) return;
    s->options->cache = room(CACHE, size, s->behind, 0);
    s->options->cache_size = size;
    s->options->stiffness = s->stiffness;
    CALL(nlc_set_options(s->network, s->options, NULL), 0, 0);
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

/* From now on a callback of each collective function fails. */
static void set_failure(scene *s)
{
    s->fail_at = 1 + (int64_t)take(&s->in, 1);
    host.answer = (int)take_integer(&s->in);
    if (host.answer == 0) host.answer = 1;
}

static void step(scene *s)
{
    const uint64_t which = take(&s->in, 1);
    switch (which < 240 ? which % 16 : which % 4 + 16) {
    case 0: case 1: case 2: solve(s); break;
    case 3: sweep(s); break;
    case 4: energy(s); break;
    case 5: tangent(s, 0); break;
    case 6: tangent(s, 1); break;
    case 7: tangent(s, 2); break;
    case 8: assemble(s, PUSH); break;
    case 9: assemble(s, SLIDE); break;
    case 10: reach(s); break;
    case 11: case 12: set_options(s); break;
    case 16: update(s); break;
    case 17: assemble(s, TURN); break;
    case 18: cache_size(s); break;
    case 19: set_failure(s); break;
    default: change_state(s);
    }
    for (int k = 0; k < USED; k++) demand(room_intact(k), "what lies around an array");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    scene s = {.in = {data, size}, .large = is_large(data, size)};
    s.odd = take(&s.in, 1);
    s.behind = !(take(&s.in, 1) & 1);
    make_particles(&s, NULL);
    s.count = make_count(&s, 256);
    if (s.count > CONTACTS && s.count < (s.large ? 240 : 256)) s.count %= CONTACTS + 1;
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
    order(&s);
    for (int k = 0; k < STEPS && s.in.left > 0; k++) step(&s);
    return 0;
}
