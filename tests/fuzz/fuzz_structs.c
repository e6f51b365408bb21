/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fuzz_structs.c - public structs of any size, as other versions of the header would have them.
 *
 * Each stands in front of a page without access.  What is demanded: the same as from a struct of this version's size in which the
 * fields that are cut off are zero; an error if bytes beyond this version's fields are not zero.
 */
#include "fuzz.h"

#include <string.h>

enum { PARTICLES, OPTIONS, INFO, SECOND_INFO, RECORD, NAME, MEMORY, SECOND_MEMORY, FORCE, NONLOCAL, SECOND_FORCE, SECOND_NONLOCAL, LARGEST = 5000 };

static const double radius[4] = {1, 1.5, 2, 1}, normal[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.6, 0.8}, overlap[4] = {0.02, 0.01, -0.001, 0.03},
                    stiffness[4] = {1e9, 2e9, 1e9, 3e9};
static const int32_t i[4] = {0, 1, 2, 3}, j[4] = {1, 2, 3, 4}, material[4] = {0, 1, 0, 1}, wall_material[2] = {1, 0};
static const nlc_material materials[2] = {{1e9, 0.3}, {3e9, 0.2}};
static double cache[64];

static void backwards(void *context, void (*task)(void *, int64_t), void *work, int64_t count)
{
    (void)context;
    while (count-- > 0) task(work, count);
}

static int exchange(void *context, double *side)
{
    (void)context, (void)side;
    return 0;
}

static int reduce(void *context, double *values, int32_t count, int32_t operation)
{
    (void)context, (void)values, (void)count, (void)operation;
    return 0;
}

#define END(type, field) (offsetof(type, field) + sizeof(((type *)0)->field))
static const size_t particles_ends[] = {
    END(nlc_particles, struct_size), END(nlc_particles, count), END(nlc_particles, radius), END(nlc_particles, radius_stride),
    END(nlc_particles, material), END(nlc_particles, material_stride), END(nlc_particles, materials), END(nlc_particles, material_count),
    END(nlc_particles, material_size), END(nlc_particles, wall_material), END(nlc_particles, wall_count), 0};
static const size_t options_ends[] = {
    END(nlc_options, struct_size), END(nlc_options, model), END(nlc_options, method), END(nlc_options, tolerance),
    END(nlc_options, max_sweeps), END(nlc_options, prefactor), END(nlc_options, simd), END(nlc_options, points),
    END(nlc_options, stiffness), END(nlc_options, cache), END(nlc_options, cache_size), END(nlc_options, parallel_for),
    END(nlc_options, parallel_context), END(nlc_options, owned_particles), END(nlc_options, exchange), END(nlc_options, reduce),
    END(nlc_options, context), END(nlc_options, reserved), 0};
_Static_assert(END(nlc_particles, wall_count) == sizeof(nlc_particles) && END(nlc_options, reserved) == sizeof(nlc_options),
               "fields that these lists do not have");

static nlc_particles make_particles(bytes *in)
{
    nlc_particles p = {.count = 4, .radius = radius, .materials = materials, .material_count = 2, .wall_count = (int64_t)(take(in, 1) % 3)};
    const uint64_t flags = take(in, 2);
    if (flags & 1) p.material = material;
    if (flags & 2) p.wall_material = wall_material;
    if (flags & 4) p.radius_stride = sizeof(double);
    if (flags & 8) p.material_stride = sizeof(int32_t);
    if (flags & 16) p.material_size = sizeof(nlc_material);
    if (flags & 32) p.radius = NULL;
    if (flags & 64) p.materials = NULL;
    if (flags & 128) p.count = take_integer(in); /* those that the arrays are too short for, the memory is too small for */
    if (flags & 256) p.material_count = take_integer(in);
    if (flags & 512) p.radius_stride = PTRDIFF_MIN;
    if (p.count > 4 && p.count < 65536) p.count = 4;
    if (p.material_count > 2 && p.material_count < 65536) p.material_count = 2;
    return p;
}

static nlc_options make_options(bytes *in)
{
    nlc_options o = {.model = (int32_t)(take(in, 1) % 8), .method = (int32_t)(take(in, 1) % 3 == 1)};
    const uint64_t flags = take(in, 2);
    if (flags & 1) o.tolerance = 1e-6;
    if (flags & 2) o.max_sweeps = 50;
    if (flags & 4) o.prefactor = 0.5;
    o.simd = (int32_t)(flags >> 3 & 7);
    o.points = (int32_t)(flags >> 6 & 1);
    if (flags & 128) o.stiffness = stiffness;
    if (flags & 256) o.cache = cache, o.cache_size = sizeof cache;
    if (flags & 512) o.parallel_for = backwards, o.parallel_context = cache;
    if (flags & 1024) o.tolerance = take_any(in);
    if (flags & 2048) o.prefactor = take_any(in);
    if (flags & 4096) o.cache_size = 1;
    if (flags & 8192) o.owned_particles = (int64_t)(flags >> 14) + 2; /* 4 is all, 5 too many, fewer need callbacks */
    if (flags >> 13 == 6) o.exchange = exchange, o.reduce = reduce, o.context = cache;
    return o;
}

/* A copy of size bytes before the guard page, zeros behind our fields but for one byte now and then; *surplus: there is one. */
static void *cut(bytes *in, int number, const void *whole, size_t own, size_t size, bool *surplus)
{
    const bool valid = size >= sizeof size && size <= 4096;
    const size_t given = valid ? size : sizeof size; /* of one whose size is nonsense no more may be read */
    char *p = room(number, given, true, (8 - given % 8) % 8);
    memset(p, 0, given);
    memcpy(p, whole, given < own ? given : own);
    memcpy(p, &size, sizeof size);
    *surplus = false;
    if (valid && size > own && take(in, 1) % 4 == 0) {
        p[own + take(in, 2) % (size - own)] = (char)(1 + take(in, 1) % 255);
        *surplus = true;
    }
    return p;
}

/* What a struct of that size means: fields that are cut off, or in two, are zero. */
static void zero_rest(void *whole, size_t own, const size_t *ends, size_t size)
{
    size_t end = 0;
    for (; *ends != 0 && *ends <= size; ends++) end = *ends;
    memset((char *)whole + end, 0, own - end);
    memcpy(whole, &own, sizeof own);
}

static size_t take_size(bytes *in, size_t own)
{
    const uint64_t kind = take(in, 1);
    return kind < 64 ? own : kind < 192 ? (size_t)take(in, 1) : (size_t)take(in, kind < 224 ? 2 : 8);
}

static bool is_size(size_t size)
{
    return size >= sizeof size && size <= 4096;
}

/* An info of that size in front of a guard page. */
static nlc_info *info_of(int number, size_t size)
{
    const size_t given = is_size(size) ? size : sizeof size;
    char *p = room(number, given, true, (8 - given % 8) % 8);
    memcpy(p, &size, sizeof size);
    return (nlc_info *)(void *)p;
}

/* It has the size that it had, then the beginning of the whole one, then zeros. */
static void compare_info(const nlc_info *found, const nlc_info *whole, size_t size)
{
    const char *p = (const char *)found;
    demand(memcmp(p, &size, sizeof size) == 0, "info.struct_size");
    if (!is_size(size)) return;
    const size_t common = size < sizeof *whole ? size : sizeof *whole;
    demand(same_bytes(p + 8, (const char *)whole + 8, common - 8), "info");
    for (size_t k = common; k < size; k++) demand(p[k] == 0, "surplus bytes of info");
}

static void try_record(bytes *in)
{
    const size_t size = take_size(in, sizeof(nlc_model_record)), given = is_size(size) ? size : sizeof size;
    char *p = room(RECORD, given, true, (8 - given % 8) % 8);
    memcpy(p, &size, sizeof size);
    const int32_t model = take(in, 1) % 4 ? (int32_t)(take(in, 1) % 8) : (int32_t)take_integer(in);
    nlc_model_record whole = {.struct_size = sizeof whole};
    const nlc_status expected = nlc_model_info(model, &whole, NULL);
    const nlc_status status = CALL(nlc_model_info(model, (nlc_model_record *)(void *)p, NULL), 0, NLC_ERROR_STRUCT_SIZE, NLC_ERROR_MODEL);
    demand((status == NLC_ERROR_STRUCT_SIZE) == !is_size(size) || expected != NLC_OK, "a record's size");
    demand(memcmp(p, &size, sizeof size) == 0, "struct_size");
    if (status != NLC_OK) {
        demand(is_filled(p + sizeof size, given - sizeof size), "a record after an error");
        return;
    }
    demand(expected == NLC_OK, "a model");
    const size_t common = size < sizeof whole ? size : sizeof whole;
    demand(memcmp(p + 8, (char *)&whole + 8, common - 8) == 0, "a record");
    for (size_t k = common; k < size; k++) demand(p[k] == 0, "surplus bytes of a record");
}

/* Any word, at the end of memory: a model's name if it is that of a record, letter by letter. */
static void try_name(bytes *in)
{
    const int32_t count = nlc_model_count(), like = (int32_t)(take(in, 1) % 16);
    nlc_model_record record = {.struct_size = sizeof record};
    const char *from = like < count && nlc_model_info(like, &record, NULL) == NLC_OK ? record.name : "";
    const size_t length = from[0] ? strlen(from) : (size_t)(take(in, 1) % 32);
    char *name = room(NAME, length + 1, true, 0);
    for (size_t k = 0; k < length; k++) name[k] = from[0] ? from[k] : (char)take(in, 1);
    name[length] = '\0';
    if (from[0] && take(in, 1) & 1) name[take(in, 1) % length] = (char)take(in, 1);
    watch();
    const int32_t model = nlc_model_find(name), none = nlc_model_find(NULL);
    const char *version = nlc_version();
    unwatch("nlc_model_find");
    demand(none == -1 && model >= -1 && model < count && version && version[0] != '\0', "nlc_model_find");
    for (int32_t m = 0; m < count; m++)
        demand(nlc_model_info(m, &record, NULL) == NLC_OK && (m == model) == (strcmp(record.name, name) == 0), "nlc_model_find");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes in = {data, size};
    nlc_particles p = make_particles(&in);
    nlc_options o = make_options(&in);
    const size_t particles_size = take_size(&in, sizeof p), options_size = take_size(&in, sizeof o), info_size = take_size(&in, sizeof(nlc_info));
    bool surplus, more;
    const nlc_particles *cut_p = cut(&in, PARTICLES, &p, sizeof p, particles_size, &surplus);
    const nlc_options *cut_o = cut(&in, OPTIONS, &o, sizeof o, options_size, &more);
    nlc_info *info = info_of(INFO, info_size), whole = {.struct_size = sizeof whole};
    zero_rest(&p, sizeof p, particles_ends, particles_size);
    zero_rest(&o, sizeof o, options_ends, options_size);
    const bool is_wrong = !is_size(particles_size) || !is_size(options_size), is_surplus = surplus || more;

    const size_t expected_size = nlc_network_size(&p, 4, &o);
    watch();
    const size_t found_size = nlc_network_size(cut_p, 4, cut_o);
    unwatch("nlc_network_size");
    demand(found_size == (is_wrong || is_surplus ? 0 : expected_size), "nlc_network_size");
    const size_t given = expected_size < ROOM ? expected_size : 1024;
    void *memory = room(MEMORY, given, true, 0), *second = room(SECOND_MEMORY, given, true, 0);
    nlc_network *network = NULL, *expected_network = NULL;
    const nlc_status expected = nlc_network_init(&expected_network, second, given, &p, i, j, 4, &o, &whole);
    watch();
    const nlc_status status = nlc_network_init(&network, memory, given, cut_p, i, j, 4, cut_o, info);
    unwatch("nlc_network_init");
    if (!is_size(info_size)) demand(status == NLC_ERROR_STRUCT_SIZE, "the size of info");
    else if (is_wrong || is_surplus) demand(status == NLC_ERROR_STRUCT_SIZE || status == NLC_ERROR_RESERVED || status == NLC_ERROR_COUNT, "a size");
    else demand(status == expected, "the status"), compare_info(info, &whole, info_size);
    if (status != NLC_OK) demand(is_filled(memory, given) && !network, "memory after an error");
    if (status == NLC_OK) {
        double *force[2] = {room(FORCE, 32, true, 0), room(SECOND_FORCE, 32, true, 0)},
               *nonlocal[2] = {room(NONLOCAL, 32, true, 0), room(SECOND_NONLOCAL, 32, true, 0)};
        memset(nonlocal[0], 0, 32), memset(nonlocal[1], 0, 32);
        nlc_info *other = info_of(SECOND_INFO, info_size);
        const nlc_status a = CALL(nlc_solve(network, force[0], nonlocal[0], overlap, normal, other), 15, NLC_ERROR_RANGE, NLC_ERROR_COINCIDENT);
        const nlc_status b = nlc_solve(expected_network, force[1], nonlocal[1], overlap, normal, &whole);
        demand(a == b && same_bytes(force[0], force[1], 32) && same_bytes(nonlocal[0], nonlocal[1], 32), "forces");
        compare_info(other, &whole, info_size);
    }
    /* other options of any size for a network of this version */
    if (expected == NLC_OK) {
        const nlc_status found = CALL(nlc_set_options(expected_network, cut_o, NULL), 0, NLC_ERROR_STRUCT_SIZE, NLC_ERROR_RESERVED);
        demand(is_size(options_size) || found == NLC_ERROR_STRUCT_SIZE, "the size of options");
        demand(!is_size(options_size) || (more ? found == NLC_ERROR_RESERVED : found == NLC_OK), "surplus bytes of options");
    }
    try_record(&in);
    try_name(&in);
    for (int k = 0; k <= SECOND_NONLOCAL; k++) demand(room_intact(k), "what lies around a struct");
    return 0;
}
