/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * counts.c - more contacts than 2^31, with hardly any memory: arrays whose pages are all the same few, but for the last ones.
 *
 *     counts [COUNT]     contacts; default 2^31 + 5
 *
 * What functions do with so many is done to the last one: a fault in it is found, and what is written arrives there.  Sizes of
 * networks of up to 2^62 contacts are a line with one slope up to where they overflow, which is an error.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "nlcontact.h"

static const size_t window = 3 << 21; /* bytes, of whole elements of any kind, normals too */

static void fail(const char *what, double a, double b)
{
    fprintf(stderr, "counts: %s: %.17g, %.17g\n", what, a, b);
    exit(1);
}

static void expect(nlc_status status, nlc_status expected, const nlc_info *info, int64_t culprit, const char *what)
{
    if (status != expected || info->culprit != culprit) fail(what, status, (double)info->culprit);
}

/* An array of count elements, all of which are as the one given, in one and the same piece of memory as far as the last pages.
 */
static void *repeat(int64_t count, size_t size, const void *element)
{
    const size_t bytes = ((size_t)count * size + 2 * window) / window * window;
    const int file = memfd_create("counts", 0);
    char *at = mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (file < 0 || at == MAP_FAILED || ftruncate(file, 3 * (off_t)window) != 0) fail("no memory to map", (double)bytes, 0);
    for (size_t w = 0; w < bytes; w += window) { /* the end may lie in either of the last two windows */
        const off_t from = w + 2 * window < bytes ? 0 : (off_t)(w + 3 * window - bytes);
        if (mmap(at + w, window, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, file, from) == MAP_FAILED)
            fail("mmap", (double)w, 0);
    }
    close(file);
    for (size_t w = 0; w < bytes; w += window) {
        if (w > 0 && w + 2 * window < bytes) continue;
        for (size_t k = 0; k < window / size; k++) memcpy(at + w + k * size, element, size);
    }
    return at;
}

/* ---- sizes */

static nlc_particles particles_of(int64_t count, const double *radius, const nlc_material *materials)
{
    return (nlc_particles){
        .struct_size = sizeof(nlc_particles), .count = count, .radius = radius, .materials = materials, .material_count = 1};
}

static void try_sizes(void)
{
    static const double radius = 1;
    static const nlc_material material = {1e9, 0.3};
    const nlc_particles p = particles_of(2, &radius, &material);
    const int64_t from = INT64_C(1) << 24;
    const size_t begin = nlc_network_size(&p, from, NULL);
    const double each =
        (double)(nlc_network_size(&p, 2 * from, NULL) - begin) / (double)from; /* exact: pieces of 2^24 are whole */
    if (!(each > 300 && each < 600)) fail("bytes of a contact", each, 0);
    for (int e = 24; e < 54; e++) {
        const int64_t count = (INT64_C(1) << e) + e;
        const double size = (double)nlc_network_size(&p, count, NULL), line = (double)begin + each * (double)(count - from);
        if (!(fabs(size - line) <= 4096 + 1e-15 * line)) fail("the size of a network", size, line);
    }
    int64_t possible = from, impossible = INT64_MAX;
    while (impossible - possible > 1) {
        const int64_t middle = possible + (impossible - possible) / 2;
        if (nlc_network_size(&p, middle, NULL) > 0)
            possible = middle;
        else
            impossible = middle;
    }
    const size_t largest = nlc_network_size(&p, possible, NULL);
    if (largest > PTRDIFF_MAX || (size_t)PTRDIFF_MAX - largest > 1024)
        fail("the largest network", (double)largest, (double)possible);
    double memory[64];
    const int32_t zero = 0;
    nlc_network *n = NULL;
    nlc_info info = {.struct_size = sizeof info};
    expect(nlc_network_init(&n, memory, sizeof memory, &p, &zero, &zero, impossible, NULL, &info), NLC_ERROR_COUNT, &info, 6,
           "one too many");
    expect(nlc_network_init(&n, memory, sizeof memory, &p, &zero, &zero, possible, NULL, &info), NLC_ERROR_MEMORY_SIZE, &info,
           (int64_t)largest, "the most there can be");
    printf("counts: %.2f bytes a contact, up to %lld contacts\n", each, (long long)possible);
}

/* ---- arrays */

static void try_init(int64_t count, int32_t *i, const int32_t *j)
{
    static const double radius[2] = {1, 1};
    static const nlc_material material = {1e9, 0.3};
    const nlc_particles p = particles_of(2, radius, &material);
    const size_t size = nlc_network_size(&p, count, NULL);
    void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    nlc_network *n = NULL;
    nlc_info info = {.struct_size = sizeof info};
    if (memory == MAP_FAILED) fail("no memory to map", (double)size, 0);
    expect(nlc_network_init(&n, memory, size - 1, &p, i, j, count, NULL, &info), NLC_ERROR_MEMORY_SIZE, &info, (int64_t)size,
           "too small");
    i[count - 1] = 2;
    expect(nlc_network_init(&n, memory, size, &p, i, j, count, NULL, &info), NLC_ERROR_INDEX, &info, count - 1,
           "nlc_network_init");
    i[count - 1] = 0;
    munmap(memory, size);
}

static void try_pairs(int64_t count, int32_t *i, const int32_t *j)
{
    static const double radius[3] = {1, 1, 1}, x[3] = {0, 1.5, 1.75}, zero[3] = {0};
    static const nlc_material material = {1e9, 0.3};
    const nlc_particles p = particles_of(3, radius, &material);
    const nlc_positions at = {.struct_size = sizeof at, .x = x, .y = zero, .z = zero};
    const double nothing = -1;
    double *overlap = repeat(count, sizeof *overlap, &nothing), *normal = repeat(3 * count, sizeof *normal, &nothing);
    nlc_info info = {.struct_size = sizeof info};
    i[count - 1] = 3;
    expect(nlc_contacts_from_pairs(overlap, normal, &p, &at, i, j, count, &info), NLC_ERROR_INDEX, &info, count - 1,
           "a wrong pair");
    if (overlap[0] != -1 || overlap[count - 1] != -1) fail("an error changes overlaps", overlap[0], overlap[count - 1]);
    i[count - 1] = 2;
    expect(nlc_contacts_from_pairs(overlap, normal, &p, &at, i, j, count, &info), NLC_OK, &info, -1, "nlc_contacts_from_pairs");
    if (overlap[0] != 0.5 || overlap[count - 2] != 0.5 || overlap[count - 1] != 1.75)
        fail("overlaps", overlap[0], overlap[count - 1]);
    if (normal[0] != 1 || normal[3 * count - 6] != 1 || normal[3 * count - 3] != -1)
        fail("normals", normal[0], normal[3 * count - 3]);
    i[count - 1] = 0;
}

static void try_predict(int64_t count)
{
    const double three = 3;
    double *nonlocal = repeat(count, sizeof *nonlocal, &three), *previous = repeat(count, sizeof *previous, &three);
    nlc_info info = {.struct_size = sizeof info};
    previous[count - 1] = NAN;
    expect(nlc_predict(nonlocal, previous, count, 1, &info), NLC_ERROR_NONLOCAL, &info, count - 1, "a wrong displacement");
    previous[count - 1] = 1;
    expect(nlc_predict(nonlocal, previous, count, 1, &info), NLC_OK, &info, -1, "nlc_predict");
    if (nonlocal[0] != 3 || nonlocal[count - 1] != 5 || previous[count - 1] != 3)
        fail("what is predicted", nonlocal[count - 1], previous[count - 1]);
}

/* Lists that are all the same one. */
static void try_lists(int64_t count)
{
    enum { LENGTH = 1 << 20 };
    static const double radius[2] = {1, 1}, x[2] = {0, 1.5}, zero[2] = {0};
    static const nlc_material material = {1e9, 0.3};
    static int32_t neighbour[LENGTH], *const row[1] = {neighbour}, room[1];
    static const int32_t length[1] = {LENGTH};
    const int32_t first = 0;
    const nlc_particles p = particles_of(2, radius, &material);
    const nlc_positions at = {.struct_size = sizeof at, .x = x, .y = zero, .z = zero};
    nlc_lists lists = {
        .struct_size = sizeof lists, .count = count / LENGTH + 1, .particle_count = 1, .length = length, .neighbour = row};
    nlc_info info = {.struct_size = sizeof info};
    int64_t found = -1;
    for (int64_t k = 0; k < LENGTH; k++) neighbour[k] = 1;
    lists.particle = repeat(lists.count, sizeof first, &first);
    expect(nlc_contacts_from_lists(&found, room, room + 1, 1, &p, &at, &lists, 0.1, &info), NLC_ERROR_CAPACITY, &info,
           lists.count * LENGTH, "nlc_contacts_from_lists");
}

int main(int argc, char **argv)
{
    const int64_t count = argc > 1 ? (int64_t)strtod(argv[1], NULL) : (INT64_C(1) << 31) + 5;
    const int32_t first = 0, second = 1;
    if (sizeof(void *) < 8) return puts("counts: pointers of 32 bits: no arrays of so many are possible"), 0;
    try_sizes();
    int32_t *i = repeat(count, sizeof *i, &first), *j = repeat(count, sizeof *j, &second);
    try_init(count, i, j);
    try_pairs(count, i, j);
    try_predict(count);
    try_lists(count);
    printf("counts: nlc_network_init, _contacts_from_pairs, _contacts_from_lists, _predict with %lld contacts: ok\n",
           (long long)count);
    return 0;
}
