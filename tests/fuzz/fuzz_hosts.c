/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fuzz_hosts.c - from arbitrary positions and lists to contacts, from one list to the next; and the scalar functions.
 *
 * What is demanded: nothing outside of the arrays is touched, no exception is raised, results are untouched on an error, finite and
 * the same twice otherwise; of scalar functions, that NaN gives NaN.
 */
#include "fuzz.h"

#include <math.h>
#include <string.h>

enum { PARTICLES = 10, WALLS = 3, CONTACTS = 16, COUNTS = 64 };
enum { ODD_COUNTS, ODD_INDICES, ODD_RADII, ODD_POSITIONS, ODD_CELL, ODD_LAYOUT, ODD_LISTS, ODD_VALUES };
enum {
    RADIUS, X, Y, Z, POINT, WALL_NORMAL, CELL, PARTICLE, LENGTH, NEIGHBOUR, LISTS, I, J, OVERLAP, NORMAL, SECOND_OVERLAP, SECOND_NORMAL,
    COUNT, FOUND_I, FOUND_J, INFO, KEY, OLD_KEY, VALUE, OLD_VALUE, MEMORY, FIRST_LIST, USED = FIRST_LIST + PARTICLES
};
_Static_assert((int)USED <= (int)ROOMS, "too few rooms");

typedef struct scene {
    bytes in;
    uint64_t odd;
    bool behind;
    nlc_particles particles;
    nlc_positions positions;
    nlc_lists lists;
    int64_t count;
    int32_t *i, *j;
} scene;

#define ARRAY(s, number, count, type) ((type *)room(number, (size_t)(count) * sizeof(type), (s)->behind, 0))

static double make_number(scene *s, int bit, double low, double high)
{
    return take_bit(&s->in, s->odd, bit) ? take_any(&s->in) : low + (high - low) * (double)take(&s->in, 1) / 255;
}

static int64_t make_count(scene *s, int64_t limit)
{
    return take_bit(&s->in, s->odd, ODD_COUNTS) ? take_integer(&s->in) : (int64_t)take(&s->in, 1) % limit;
}

/* Rows that there are for a count: a negative one has to be refused.  Nothing bounds large ones, so there are none. */
static int64_t rows_of(int64_t *count)
{
    if (*count >= COUNTS) *count %= COUNTS;
    return *count < 0 ? 0 : *count;
}

static double *make_numbers(scene *s, int number, int64_t rows, int bit, double low, double high)
{
    double *x = ARRAY(s, number, rows, double);
    for (int64_t k = 0; k < rows; k++) x[k] = make_number(s, bit, low, high);
    return x;
}

static int32_t make_index(scene *s, int bit, int64_t bodies)
{
    if (take_bit(&s->in, s->odd, bit)) return (int32_t)take_integer(&s->in);
    return bodies > 0 ? (int32_t)((int64_t)take(&s->in, 1) % bodies) : 0;
}

/* The components one by one, or in structs of three or more numbers. */
static void make_positions(scene *s, int64_t n, int64_t walls)
{
    nlc_positions *p = &s->positions;
    *p = (nlc_positions){.struct_size = sizeof *p};
    if (take(&s->in, 1) & 1) {
        p->x = make_numbers(s, X, n, ODD_POSITIONS, 0, 10);
        p->y = make_numbers(s, Y, n, ODD_POSITIONS, 0, 10);
        p->z = make_numbers(s, Z, n, ODD_POSITIONS, 0, 10);
    } else {
        const int64_t each = 3 + (int64_t)(take(&s->in, 1) % 3);
        const double *x = make_numbers(s, X, n > 0 ? n * each - (each - 3) : 0, ODD_POSITIONS, 0, 10);
        p->x = x, p->y = n > 0 ? x + 1 : x, p->z = n > 0 ? x + 2 : x;
        p->stride = 8 * (ptrdiff_t)each;
    }
    static const ptrdiff_t wrong[] = {1, -1, 7, -7, PTRDIFF_MIN, PTRDIFF_MAX};
    if (take_bit(&s->in, s->odd, ODD_LAYOUT)) p->stride = wrong[take(&s->in, 1) % 6];
    p->wall_point = make_numbers(s, POINT, 3 * walls, ODD_POSITIONS, 0, 10);
    double *m = ARRAY(s, WALL_NORMAL, 3 * walls, double);
    for (int64_t w = 0; w < walls; w++) {
        take_unit(&s->in, (uint64_t)w, m + 3 * w);
        if (take_bit(&s->in, s->odd, ODD_POSITIONS)) m[3 * w + (int64_t)take(&s->in, 1) % 3] = take_any(&s->in);
    }
    p->wall_normal = m;
    const uint64_t kind = take(&s->in, 1);
    if (kind & 1) {
        double *cell = ARRAY(s, CELL, 9, double);
        for (int k = 0; k < 9; k++) cell[k] = k % 4 == 0 ? make_number(s, ODD_CELL, 4, 20) : make_number(s, ODD_CELL, -1, 1);
        for (int a = 0; a < 3; a++)
            if (kind >> (a + 1) & 1) cell[3 * a] = cell[3 * a + 1] = cell[3 * a + 2] = 0;
        p->cell = cell;
    }
    if (take_bit(&s->in, s->odd, ODD_LAYOUT)) *(take(&s->in, 1) & 1 ? &p->x : &p->wall_point) = NULL;
}

static void make_scene(scene *s)
{
    nlc_particles *p = &s->particles;
    *p = (nlc_particles){.struct_size = sizeof *p};
    p->count = make_count(s, PARTICLES + 1);
    p->wall_count = make_count(s, WALLS + 1);
    const int64_t n = rows_of(&p->count), walls = rows_of(&p->wall_count);
    p->radius = make_numbers(s, RADIUS, n, ODD_RADII, 0.5, 1.5);
    make_positions(s, n, walls);
    s->count = make_count(s, CONTACTS + 1);
    const int64_t contacts = rows_of(&s->count);
    s->i = ARRAY(s, I, contacts, int32_t);
    s->j = ARRAY(s, J, contacts, int32_t);
    for (int64_t c = 0; c < contacts; c++) s->i[c] = make_index(s, ODD_INDICES, n), s->j[c] = make_index(s, ODD_INDICES, n + walls);
}

/* Of any size, or none. */
static nlc_info *make_info(scene *s)
{
    const uint64_t kind = take(&s->in, 1);
    if (kind < 8) return NULL;
    const size_t size = kind < 128 ? sizeof(nlc_info) : (size_t)kind - 128, given = size < sizeof size ? sizeof size : size;
    char *p = room(INFO, given, true, (8 - given % 8) % 8);
    memcpy(p, &size, sizeof size);
    return (nlc_info *)(void *)p;
}

#define ERRORS                                                                                                                 \
    NLC_ERROR_NULL, NLC_ERROR_NULL_FIELD, NLC_ERROR_STRUCT_SIZE, NLC_ERROR_RESERVED, NLC_ERROR_COUNT, NLC_ERROR_STRIDE,        \
        NLC_ERROR_RADIUS, NLC_ERROR_INDEX, NLC_ERROR_NORMAL, NLC_ERROR_POSITION, NLC_ERROR_SAME_PLACE, NLC_ERROR_CELL, NLC_ERROR_RANGE

static void try_pairs(scene *s)
{
    const size_t n = s->count > 0 ? (size_t)s->count : 0;
    double *overlap[2] = {ARRAY(s, OVERLAP, n, double), ARRAY(s, SECOND_OVERLAP, n, double)},
           *normal[2] = {ARRAY(s, NORMAL, 3 * n, double), ARRAY(s, SECOND_NORMAL, 3 * n, double)};
    nlc_info *info = make_info(s);
    const nlc_status status = CALL(nlc_contacts_from_pairs(overlap[0], normal[0], &s->particles, &s->positions, s->i, s->j, s->count, info),
                                   0, ERRORS, NLC_ERROR_WALL_WALL);
    if (status < 0) {
        demand(is_filled(overlap[0], 8 * n) && is_filled(normal[0], 24 * n), "results after an error");
        return;
    }
    demand(all_finite(overlap[0], n) && all_finite(normal[0], 3 * n), "results");
    for (size_t c = 0; c < n; c++) {
        const double *v = normal[0] + 3 * c;
        demand(fabs(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - 1) <= 1e-6, "a unit normal");
    }
    CALL(nlc_contacts_from_pairs(overlap[1], normal[1], &s->particles, &s->positions, s->i, s->j, s->count, NULL), 0, 0);
    demand(same_bytes(overlap[0], overlap[1], 8 * n) && same_bytes(normal[0], normal[1], 24 * n), "results, a second time");
}

static void make_lists(scene *s)
{
    nlc_lists *l = &s->lists;
    const int64_t n = s->particles.count > 0 ? s->particles.count : 0;
    *l = (nlc_lists){.struct_size = sizeof *l, .particle_count = n < PARTICLES ? n : PARTICLES, .mask = take(&s->in, 1) & 1 ? 0x1FFFFFFF : 0};
    int32_t *length = ARRAY(s, LENGTH, l->particle_count, int32_t), **neighbour = ARRAY(s, NEIGHBOUR, l->particle_count, int32_t *);
    for (int64_t k = 0; k < l->particle_count; k++) {
        length[k] = (int32_t)(take(&s->in, 1) % 6);
        neighbour[k] = ARRAY(s, FIRST_LIST + (int)k, length[k], int32_t);
        for (int32_t a = 0; a < length[k]; a++) neighbour[k][a] = make_index(s, ODD_LISTS, n) | (int32_t)(l->mask ? take(&s->in, 1) << 29 & 0x40000000 : 0);
        if (take_bit(&s->in, s->odd, ODD_LISTS)) length[k] = INT32_MIN + (int32_t)take(&s->in, 1);
    }
    l->length = length;
    l->neighbour = neighbour;
    l->count = l->particle_count;
    if (take(&s->in, 1) & 1) {
        l->count = (int64_t)(take(&s->in, 1) % (PARTICLES + 1));
        int32_t *particle = ARRAY(s, PARTICLE, l->count, int32_t);
        for (int64_t k = 0; k < l->count; k++) particle[k] = make_index(s, ODD_LISTS, l->particle_count);
        l->particle = particle;
    }
    if (take_bit(&s->in, s->odd, ODD_COUNTS)) *(take(&s->in, 1) & 1 ? &l->count : &l->particle_count) = -(int64_t)take(&s->in, 4);
    if (take_bit(&s->in, s->odd, ODD_COUNTS)) l->reserved = (int32_t)take(&s->in, 1);
}

static void try_lists(scene *s)
{
    make_lists(s);
    const double reach = make_number(s, ODD_VALUES, 0, 5);
    int64_t *count = ARRAY(s, COUNT, 1, int64_t), room_needed = 0;
    const nlc_status counted =
        CALL(nlc_contacts_from_lists(count, NULL, NULL, 0, &s->particles, &s->positions, &s->lists, reach, NULL), 0, ERRORS, NLC_ERROR_OPTION);
    demand(counted == NLC_OK || is_filled(count, sizeof *count), "the count after an error");
    if (counted != NLC_OK) return;
    room_needed = *count;
    demand(room_needed >= 0 && room_needed < PARTICLES * (5 + COUNTS), "the count");
    const int64_t capacity = take_bit(&s->in, s->odd, ODD_COUNTS) ? (int64_t)take(&s->in, 1) - 5 : room_needed;
    const int64_t rows = capacity > 0 ? capacity : 0;
    int32_t *i = ARRAY(s, FOUND_I, rows, int32_t), *j = ARRAY(s, FOUND_J, rows, int32_t);
    count = ARRAY(s, COUNT, 1, int64_t);
    nlc_info *info = make_info(s);
    const nlc_status status = CALL(nlc_contacts_from_lists(count, i, j, capacity, &s->particles, &s->positions, &s->lists, reach, info), 0,
                                   NLC_ERROR_STRUCT_SIZE, NLC_ERROR_COUNT, NLC_ERROR_CAPACITY);
    demand(status != NLC_OK || *count == room_needed, "the count, a second time");
    demand((status == NLC_ERROR_CAPACITY) <= (capacity < room_needed), "a capacity refused");
    demand(status != NLC_OK || capacity >= room_needed, "a capacity accepted");
    for (int64_t c = 0; status == NLC_OK && c < room_needed; c++) {
        demand(i[c] >= 0 && i[c] < s->particles.count, "an index");
        demand(j[c] >= 0 && j[c] < s->particles.count + s->particles.wall_count, "an index");
    }
}

static void try_carry(scene *s)
{
    int64_t count = make_count(s, 24), old_count = make_count(s, 24);
    const int64_t n = rows_of(&count), m = rows_of(&old_count);
    uint64_t *key = ARRAY(s, KEY, n, uint64_t), *old_key = ARRAY(s, OLD_KEY, m, uint64_t);
    for (int64_t k = 0; k < n; k++) key[k] = take(&s->in, 1) % 32;
    for (int64_t k = 0; k < m; k++) old_key[k] = take(&s->in, 1) % 32;
    double *value = ARRAY(s, VALUE, n, double), *old_value = make_numbers(s, OLD_VALUE, m, ODD_VALUES, -1, 1);
    watch();
    const size_t size = nlc_carry_size(count, old_count);
    unwatch("nlc_carry_size");
    size_t given = size;
    if (take_bit(&s->in, s->odd, ODD_LAYOUT)) given -= given > 0 ? 1 + (size_t)take(&s->in, 1) % given : 0;
    const size_t shift = take_bit(&s->in, s->odd, ODD_LAYOUT) ? take(&s->in, 1) % 8 : 0;
    void *memory = room(MEMORY, given, s->behind, shift);
    nlc_info *info = make_info(s);
    const nlc_status status =
        CALL(nlc_carry(value, key, count, old_value, old_key, old_count, memory, given, info), 0, NLC_ERROR_NULL, NLC_ERROR_STRUCT_SIZE,
             NLC_ERROR_COUNT, NLC_ERROR_CAPACITY, NLC_ERROR_ALIGNMENT, NLC_ERROR_NONLOCAL);
    if (status < 0) {
        demand(is_filled(value, 8 * (size_t)n), "results after an error");
        return;
    }
    /* each new one takes the first old one of its key that is left: looked for one by one */
    bool used[COUNTS] = {false};
    for (int64_t c = 0; c < n; c++) {
        double expected = 0;
        for (int64_t d = 0; d < m; d++)
            if (!used[d] && old_key[d] == key[c]) {
                used[d] = true, expected = old_value[d];
                break;
            }
        demand(same_bytes(&expected, value + c, 8), "a value carried over");
    }
    double *previous = ARRAY(s, OLD_VALUE, n, double), before[COUNTS];
    for (int64_t k = 0; k < n; k++) previous[k] = make_number(s, ODD_VALUES, -1, 1);
    copy_bytes(before, value, 8 * (size_t)n);
    const double ratio = make_number(s, ODD_VALUES, 0, 2);
    const nlc_status predicted =
        CALL(nlc_predict(value, previous, n, ratio, NULL), 0, NLC_ERROR_NULL, NLC_ERROR_NONLOCAL, NLC_ERROR_OPTION, NLC_ERROR_RANGE);
    if (predicted == NLC_OK) demand(all_finite(value, (size_t)n) && same_bytes(previous, before, 8 * (size_t)n), "a prediction");
    else demand(same_bytes(value, before, 8 * (size_t)n), "results after an error");
}

/* ---- scalar functions */

static void try_scalar(scene *s)
{
    enum { FUNCTIONS = 14, FIELDS = 5 };
    double x[7], n[9], field[FIELDS][4] = {{0}}, r[FUNCTIONS];
    for (int k = 0; k < 7; k++) x[k] = make_number(s, ODD_VALUES, 0, 1);
    for (int k = 0; k < 3; k++) take_unit(&s->in, (uint64_t)k, n + 3 * k);
    if (take_bit(&s->in, s->odd, ODD_VALUES)) n[take(&s->in, 1) % 9] = take_any(&s->in);
    watch();
    r[0] = nlc_hertz_stiffness(x[0], x[1], x[2], x[3], x[4], x[5]);
    r[1] = nlc_contact_radius(x[6], x[0], x[1], x[2], x[3], x[4], x[5]);
    r[2] = nlc_hertz_force(x[0], x[1]);
    r[3] = nlc_hertz_overlap(x[0], x[1]);
    r[4] = nlc_contact_displacement(x[0], x[1], x[2], x[3], x[4]);
    r[5] = nlc_nonlocal_displacement(x[0], x[1], x[2], x[3], x[4]);
    r[6] = nlc_sphere_displacement(x[0], x[1], x[2], x[3], x[4]);
    r[7] = nlc_love_nonlocal_displacement(x[0], x[5], x[1], x[2], x[3], x[4]);
    r[8] = nlc_sphere_green(x[0], x[1]);
    r[9] = nlc_sphere_finite_size(x[0], x[1], x[2]);
    r[10] = nlc_sphere_self(x[0], x[1], x[2]);
    r[11] = nlc_sphere_self_energy(x[0], x[1], x[2]);
    nlc_point_displacement(field[0], x[0], x[1], x[2], x[3], x[4]);
    nlc_love_displacement(field[1], x[0], x[1], x[2], x[3], x[4], x[5]);
    nlc_point_traction(field[2], x[0], x[1], x[2], x[3]);
    nlc_point_stress(field[3], x[0], x[1], x[2], x[3]);
    nlc_love_stress(field[4], x[0], x[1], x[2], x[3], x[4]);
    r[12] = nlc_nonlocal_displacement_between(x[0], n, n + 3, x[1], x[2], x[3]);
    r[13] = nlc_half_space_displacement(x[0], n, n + 3, n + 6, x[1], x[2], x[3]);
    unwatch("a scalar function");
    static const int arguments[FUNCTIONS] = {6, 7, 2, 2, 5, 5, 5, 6, 2, 3, 3, 3, 4, 4};
    for (int f = 0; f < FUNCTIONS; f++) {
        bool nan = false;
        for (int k = 0; k < arguments[f]; k++) nan = nan || isnan(x[k]);
        demand(!nan || isnan(r[f]), "NaN of NaN");
    }
    static const int field_arguments[FIELDS] = {5, 6, 4, 4, 5}, components[FIELDS] = {2, 2, 2, 4, 4};
    for (int f = 0; f < FIELDS; f++) {
        int nan = 0, found = 0;
        for (int k = 0; k < field_arguments[f]; k++) nan += isnan(x[k]) != 0;
        for (int k = 0; k < components[f]; k++) found += isnan(field[f][k]) != 0;
        demand(nan == 0 || found == components[f], "NaN of NaN");
        demand(found == 0 || found == components[f], "all or none");
    }
    const char *text = nlc_strerror((nlc_status)take_integer(&s->in));
    demand(text && text[0] != '\0', "nlc_strerror");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    scene s = {.in = {data, size}};
    s.odd = take(&s.in, 1);
    const uint64_t kind = take(&s.in, 1);
    s.behind = !(kind & 1);
    switch (kind >> 1 & 3) {
    case 0: make_scene(&s), try_pairs(&s); break;
    case 1: make_scene(&s), try_lists(&s); break;
    case 2: try_carry(&s); break;
    default: try_scalar(&s);
    }
    for (int k = 0; k < USED; k++) demand(room_intact(k), "what lies around an array");
    return 0;
}
