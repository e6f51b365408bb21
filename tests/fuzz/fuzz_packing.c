/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fuzz_packing.c - the reader of packings on arbitrary files.
 *
 * The first byte says how: a text file; a header and the data beside it, which begin behind the first zero byte.  What is
 * demanded: a message on failure; else a packing that holds what packing_io.h says, and that the library accepts.
 */
#include "fuzz.h"
#include "packing_io.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[256];

static void remove_folder(void)
{
    if (folder[0] && chdir("/") == 0) rmdir(folder);
}

/* A folder for this process, in memory where that can be. */
static void make_folder(void)
{
    const char *const places[] = {"/dev/shm", getenv("TMPDIR"), "/tmp"};
    for (int k = 0; k < 3; k++) {
        if (!places[k]) continue;
        snprintf(folder, sizeof folder, "%s/fuzz_packing.XXXXXX", places[k]);
        if (mkdtemp(folder)) {
            atexit(remove_folder);
            return;
        }
    }
    demand(false, "mkdtemp");
}

static void write_file(const char *path, const uint8_t *data, size_t size)
{
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    demand(file >= 0, path);
    demand(write(file, data, size) == (ssize_t)size, path);
    close(file);
}

static void look_at(const packing *p)
{
    demand(p->name != NULL, "name");
    demand(p->count >= 1 && p->count <= INT32_MAX && p->wall_count >= 0 && p->material_count >= 1, "counts");
    for (int64_t k = 0; k < p->count; k++) {
        double x[3];
        packing_position(p, k, x);
        demand(all_finite(x, 3) && all_finite(p->x[k], 3), "a position");
        demand(p->radius[k] > 0 && isfinite(p->radius[k]), "a radius");
        demand(p->material[k] >= 0 && p->material[k] < p->material_count, "a material");
        demand(p->materials[p->material[k]].young > 0, "a modulus");
        for (int d = 0; d < 3; d++)
            demand(!p->periodic[d] || (x[d] >= p->low[d] - 1e-9 * fabs(p->low[d]) && x[d] <= p->high[d] + 1e-9 * fabs(p->high[d])),
                   "a position in the box");
    }
    for (int64_t w = 0; w < p->wall_count; w++) {
        demand(p->wall_material[w] >= 0 && p->wall_material[w] < p->material_count, "a wall's material");
        demand(all_finite(p->walls[w].point, 3) && all_finite(p->walls[w].normal, 3), "a wall");
    }
    demand(packing_volume(p) >= 0, "volume");
    const nlc_particles particles = packing_particles(p);
    const size_t size = nlc_network_size(&particles, 0, NULL);
    demand(size > 0, "packing_particles");
    void *memory = malloc(size);
    nlc_network *network;
    if (memory) demand(nlc_network_init(&network, memory, size, &particles, NULL, NULL, 0, NULL, NULL) == NLC_OK, "packing_particles");
    free(memory);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!folder[0]) make_folder();
    bytes in = {data, size};
    const uint64_t how = take(&in, 1);
    const bool binary = how & 1;
    char text[300], header[300], beside[300], error[PACKING_ERROR_SIZE] = "";
    snprintf(text, sizeof text, "%s/p.csv", folder);
    snprintf(header, sizeof header, "%s/p.header.txt", folder);
    snprintf(beside, sizeof beside, "%s/p.f64le", folder);
    const uint8_t *zero = binary && in.left > 0 ? memchr(in.at, 0, in.left) : NULL;
    const size_t first = zero ? (size_t)(zero - in.at) : in.left, skip = first + (zero != NULL);
    write_file(binary ? header : text, in.at, first);
    if (binary) write_file(beside, in.at + skip, in.left - skip);
    packing p;
    const size_t room_for_error = how & 4 ? sizeof error : 1 + (size_t)(how >> 3);
    const int status = packing_read(&p, !binary ? text : how & 2 ? beside : header, false, error, room_for_error);
    demand(status == 0 || status == -1, "packing_read");
    demand(memchr(error, 0, room_for_error) != NULL, "the message's end");
    if (status == 0) look_at(&p);
    else demand(error[0] != '\0' || room_for_error == 1, "a message");
    packing_free(&p);
    unlink(text), unlink(header), unlink(beside);
    return 0;
}
