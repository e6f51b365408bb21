/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * test_structs.c - structs of other versions: one of any smaller size does what the whole one does with zeros where it ends, of a
 * larger one every byte is looked at, and what is written ends where it is told to.
 *
 * Where fields end is read from tests/abi, as recorded of this release.
 */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "nlcontact.h"
#include "support.h"

enum { CONTACTS = 3, LARGEST = 4096, GUARD = 64 }; /* no struct_size of more than LARGEST will ever be right */

typedef struct outcome {
    nlc_status status;
    int64_t culprit, count, sweeps;
    double network; /* a sum over its memory, as it was built */
    double a[3 * CONTACTS], b[3 * CONTACTS];
} outcome;

static const double radius[6] = {1, NAN, 1.1, NAN, 1.2, NAN}, stiffness[CONTACTS] = {1e6, 2e6, 3e6};
static const int32_t material[6] = {1, -1, 0, -1, 1, -1}, wall_material[1] = {2};
static const nlc_material materials[3] = {{1e6, 0.3}, {2e6, 0.4}, {INFINITY, 0}};
static const double x[6] = {0, NAN, 2, NAN, 4, NAN}, y[6] = {0}, wall_point[3] = {0, -0.99, 0}, wall_normal[3] = {0, 1, 0};
static const double cell[9] = {20, 0, 0, 0, 20, 0, 0, 0, 20};
static const int32_t i[CONTACTS] = {0, 1, 0}, j[CONTACTS] = {1, 2, 3}, inner[CONTACTS] = {1, 2, 2};
static int32_t row[3][2] = {{1, 2}, {2, 0}, {0, 0}}, *const rows[3] = {row[0], row[1], row[2]};
static const int32_t lengths[3] = {2, 1, 0}, owners[3] = {0, 1, 2};

static const nlc_particles particles = {sizeof particles, 3, radius, 16, material, 8,
                                        materials, 3, sizeof *materials, wall_material, 1};
static const nlc_positions positions = {sizeof positions, x, y, y, 16, wall_point, wall_normal, cell};
static const nlc_lists lists = {sizeof lists, 2, owners, 3, lengths, rows, 3, 0};
static const nlc_options options = {.struct_size = sizeof options,
                                    .model = NLC_MODEL_HALF_SPACE,
                                    .method = NLC_METHOD_FIXED_POINT,
                                    .tolerance = 1e-3,
                                    .max_sweeps = 7,
                                    .prefactor = 0.9,
                                    .simd = NLC_SIMD_GENERIC,
                                    .points = NLC_POINTS_UNDEFORMED,
                                    .stiffness = stiffness};
static double memory[4096]; /* bytes for a network: enough, and aligned */

/* ---- what a function makes of a struct */

static outcome solve(nlc_network *network, outcome o, const nlc_info *from)
{
    const double overlap[CONTACTS] = {0.1, 0.3, 0.01}, normal[3 * CONTACTS] = {1, 0, 0, 1, 0, 0, 0, -1, 0};
    nlc_info info = {.struct_size = sizeof info};
    o.culprit = from->culprit;
    if (o.status < 0) return o;
    for (size_t b = 0; b < sizeof memory; b++) o.network += (double)(b + 1) * ((unsigned char *)memory)[b]; /* exact */
    memset(o.b, 0, sizeof o.b);
    o.status = nlc_solve(network, o.a, o.b, overlap, normal, &info);
    o.culprit = info.culprit;
    o.sweeps = info.sweeps;
    return o;
}

/* The third contact is with the wall, or, for particles without walls, with the third particle. */
static outcome init(const nlc_particles *p, const nlc_options *opt)
{
    outcome o = {0};
    nlc_info info = {.struct_size = sizeof info};
    nlc_network *network = NULL;
    memset(memory, 0, sizeof memory);
    int32_t last[CONTACTS] = {1, 2, nlc_network_size(p, CONTACTS, opt) == nlc_network_size(&particles, CONTACTS, opt) ? 3 : 2};
    o.status = nlc_network_init(&network, memory, sizeof memory, p, i, last, CONTACTS, opt, &info);
    return solve(network, o, &info);
}

static outcome init_particles(const void *given)
{
    return init(given, NULL);
}
static outcome init_options(const void *given)
{
    return init(&particles, given);
}
static outcome set_options(const void *given)
{
    outcome o = {0};
    nlc_info info = {.struct_size = sizeof info};
    nlc_network *network = NULL;
    memset(memory, 0, sizeof memory);
    ck_assert_int_eq(nlc_network_init(&network, memory, sizeof memory, &particles, i, j, CONTACTS, NULL, NULL), NLC_OK);
    o.status = nlc_set_options(network, given, &info);
    return solve(network, o, &info);
}
static outcome update_particles(const void *given)
{
    outcome o = {0};
    nlc_info info = {.struct_size = sizeof info};
    nlc_network *network = NULL;
    memset(memory, 0, sizeof memory);
    ck_assert_int_eq(nlc_network_init(&network, memory, sizeof memory, &particles, i, j, CONTACTS, NULL, NULL), NLC_OK);
    o.status = nlc_network_update(network, given, NULL, &info);
    return solve(network, o, &info);
}
static outcome find_pairs(const nlc_particles *p, const nlc_positions *pos)
{
    outcome o = {0};
    nlc_info info = {.struct_size = sizeof info};
    o.status = nlc_contacts_from_pairs(o.a, o.b, p, pos, i, inner, CONTACTS, &info);
    o.culprit = info.culprit;
    return o;
}
static outcome pairs_particles(const void *given)
{
    return find_pairs(given, &positions);
}
static outcome pairs_positions(const void *given)
{
    return find_pairs(&particles, given);
}
static outcome find_in_lists(const nlc_particles *p, const nlc_positions *pos, const nlc_lists *l)
{
    outcome o = {0};
    nlc_info info = {.struct_size = sizeof info};
    int32_t found_i[9] = {0}, found_j[9] = {0};
    o.status = nlc_contacts_from_lists(&o.count, found_i, found_j, 9, p, pos, l, 5, &info);
    o.culprit = info.culprit;
    for (int c = 0; c < 9; c++) o.a[c] = found_i[c], o.b[c] = found_j[c];
    return o;
}
static outcome lists_particles(const void *given)
{
    return find_in_lists(given, &positions, &lists);
}
static outcome lists_positions(const void *given)
{
    return find_in_lists(&particles, given, &lists);
}
static outcome lists_lists(const void *given)
{
    return find_in_lists(&particles, &positions, given);
}

static const struct {
    const char *name;
    const void *whole;
    size_t size;
    outcome (*call)(const void *given);
    int argument; /* its number there */
} kinds[] = {
    {"nlc_particles", &particles, sizeof particles, init_particles, 3},
    {"nlc_particles", &particles, sizeof particles, update_particles, 1},
    {"nlc_particles", &particles, sizeof particles, pairs_particles, 2},
    {"nlc_particles", &particles, sizeof particles, lists_particles, 4},
    {"nlc_options", &options, sizeof options, init_options, 7},
    {"nlc_options", &options, sizeof options, set_options, 1},
    {"nlc_positions", &positions, sizeof positions, pairs_positions, 3},
    {"nlc_positions", &positions, sizeof positions, lists_positions, 5},
    {"nlc_lists", &lists, sizeof lists, lists_lists, 6},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static union {
    size_t size;
    unsigned char bytes[LARGEST + GUARD];
} given, zeroed;

/* The end of the last field of a struct that has come to its end before size. */
static size_t last_end(const char *name, size_t size)
{
    char path[512], line[256];
    const struct {
        char c;
        int64_t x;
    } probe = {0};
    const int column = sizeof(void *) == 8 ? 0 : (char *)&probe.x - (char *)&probe == 8 ? 1 : 2;
    size_t whole = 0;
    snprintf(path, sizeof path, NLC_SOURCE_DIR "/tests/abi/%d.%d/layout", NLC_VERSION_MAJOR, NLC_VERSION_MINOR);
    FILE *file = fopen(path, "r");
    ck_assert_msg(file != NULL, "%s: nothing recorded: make abi-baseline", path);
    while (fgets(line, sizeof line, file)) {
        char type[64];
        size_t at[3], bytes[3];
        const int found = sscanf(line, "field %63[^.].%*s %zu+%zu %zu+%zu %zu+%zu", type, &at[0], &bytes[0], &at[1], &bytes[1],
                                 &at[2], &bytes[2]);
        if (found != 7) continue;
        const size_t end = at[column] + bytes[column];
        if (strcmp(type, name) == 0 && end <= size && end > whole) whole = end;
    }
    fclose(file);
    return whole;
}

START_TEST(whole_structs_are_right)
{
    const outcome o = kinds[_i].call(kinds[_i].whole);
    ck_assert_msg(o.status >= 0, "%s, kind %d: %s, culprit %d", kinds[_i].name, _i, nlc_strerror(o.status), (int)o.culprit);
    ck_assert(o.a[0] != 0 || o.b[0] != 0);
}
END_TEST

START_TEST(shorter_structs_are_followed_by_zeros)
{
    const size_t size = kinds[_i].size, head = sizeof(size_t);
    if (sizeof(void *) == 8) ck_assert_uint_eq(last_end(kinds[_i].name, size), size);
    for (size_t shorter = head; shorter < size; shorter++) {
        memset(&given, 0xa5, sizeof given);
        memcpy(&given, kinds[_i].whole, shorter);
        given.size = shorter;
        memset(&zeroed, 0, sizeof zeroed);
        memcpy(&zeroed, kinds[_i].whole, last_end(kinds[_i].name, shorter));
        zeroed.size = size;
        const outcome found = kinds[_i].call(&given), expected = kinds[_i].call(&zeroed);
        ck_assert_msg(memcmp(&found, &expected, sizeof found) == 0,
                      "%s, kind %d, %zu bytes of %zu: %s, culprit %d; with zeros: %s, %d", kinds[_i].name, _i, shorter, size,
                      nlc_strerror(found.status), (int)found.culprit, nlc_strerror(expected.status), (int)expected.culprit);
    }
}
END_TEST

START_TEST(surplus_bytes_are_zero)
{
    const size_t size = kinds[_i].size;
    const outcome expected = kinds[_i].call(kinds[_i].whole);
    memset(&given, 0xa5, sizeof given);
    memcpy(&given, kinds[_i].whole, size);
    memset(given.bytes + size, 0, LARGEST - size);
    for (size_t longer = size; longer <= LARGEST; longer = longer < size + GUARD ? longer + 1 : 2 * longer) {
        given.size = longer;
        const outcome found = kinds[_i].call(&given);
        ck_assert_msg(memcmp(&found, &expected, sizeof found) == 0, "kind %d, %zu zeros too many: %s", _i, longer - size,
                      nlc_strerror(found.status));
        for (size_t b = size; b < longer; b += b < size + GUARD ? 1 : 97) {
            given.bytes[b] = b % 2 ? 1 : 0x80;
            const outcome wrong = kinds[_i].call(&given);
            ck_assert_msg(wrong.status == NLC_ERROR_RESERVED && wrong.culprit == kinds[_i].argument,
                          "kind %d, byte %zu of %zu: %s, culprit %d", _i, b, longer, nlc_strerror(wrong.status), (int)wrong.culprit);
            given.bytes[b] = 0;
        }
    }
}
END_TEST

START_TEST(no_struct_is_of_these_sizes)
{
    static const size_t never[] = {0, 1, sizeof(size_t) - 1, LARGEST + 1, 1u << 20, SIZE_MAX / 2 + 1, SIZE_MAX};
    memset(&given, 0, sizeof given);
    memcpy(&given, kinds[_i].whole, kinds[_i].size);
    for (size_t k = 0; k < sizeof never / sizeof *never; k++) {
        given.size = never[k];
        const outcome found = kinds[_i].call(&given);
        ck_assert_int_eq(found.status, NLC_ERROR_STRUCT_SIZE);
        ck_assert_int_eq(found.culprit, kinds[_i].argument);
    }
}
END_TEST

/* Of an info as much is written as there is room for, be it after a success or after an error. */
START_TEST(infos_of_any_size_are_filled)
{
    double value[2] = {1, 2}, previous[2] = {1, _i ? NAN : 2};
    for (size_t size = sizeof size; size <= LARGEST; size = size < sizeof(nlc_info) + GUARD ? size + 1 : 2 * size) {
        nlc_info full = {.struct_size = sizeof full};
        memset(&given, 0xa5, sizeof given);
        given.size = size;
        const nlc_status expected = nlc_predict(value, previous, 2, 1, &full);
        ck_assert_int_eq(expected, _i ? NLC_ERROR_NONLOCAL : NLC_OK);
        ck_assert_int_eq(nlc_predict(value, previous, 2, 1, (nlc_info *)(void *)&given), expected);
        const size_t common = size < sizeof full ? size : sizeof full;
        ck_assert_uint_eq(given.size, size);
        ck_assert(memcmp(given.bytes + sizeof size, (unsigned char *)&full + sizeof size, common - sizeof size) == 0);
        for (size_t b = common; b < size; b++) ck_assert_int_eq(given.bytes[b], 0);
        for (size_t b = size; b < size + GUARD && b < sizeof given; b++) ck_assert_int_eq(given.bytes[b], 0xa5);
    }
}
END_TEST

/* Materials are rows of the caller's size: what a later version has added to them has to be zero in those that are in use. */
START_TEST(larger_materials)
{
    enum { ROWS = 3, MOST = 40 };
    static unsigned char bytes[ROWS * MOST];
    const outcome expected = init(&particles, NULL);
    for (size_t size = sizeof(nlc_material); size <= MOST; size += 8) {
        nlc_particles p = particles;
        p.materials = (const nlc_material *)(void *)bytes;
        p.material_size = size;
        memset(bytes, 0, sizeof bytes);
        for (int m = 0; m < ROWS; m++) memcpy(bytes + (size_t)m * size, &materials[m], sizeof(nlc_material));
        const outcome found = init(&p, NULL);
        ck_assert_msg(memcmp(&found, &expected, sizeof found) == 0, "rows of %zu bytes: %s", size, nlc_strerror(found.status));
        for (int m = 0; m < ROWS; m++)
            for (size_t b = sizeof(nlc_material); b < size; b++) {
                bytes[(size_t)m * size + b] = b % 2 ? 1 : 0x80;
                const outcome wrong = init(&p, NULL);
                ck_assert_msg(wrong.status == NLC_ERROR_RESERVED && wrong.culprit == m, "byte %zu of row %d: %s, culprit %d", b, m,
                              nlc_strerror(wrong.status), (int)wrong.culprit);
                bytes[(size_t)m * size + b] = 0;
            }
    }
}
END_TEST

int main(void)
{
    Suite *s = suite_create("structs");
    TCase *t = tcase_create("structs");
    tcase_add_loop_test(t, whole_structs_are_right, 0, KINDS);
    tcase_add_loop_test(t, shorter_structs_are_followed_by_zeros, 0, KINDS);
    tcase_add_loop_test(t, surplus_bytes_are_zero, 0, KINDS);
    tcase_add_loop_test(t, no_struct_is_of_these_sizes, 0, KINDS);
    tcase_add_loop_test(t, infos_of_any_size_are_filled, 0, 2);
    tcase_add_test(t, larger_materials);
    suite_add_tcase(s, t);
    return run_suite(s);
}
