/* SPDX-License-Identifier: BSD-2-Clause */
/* lattice.c - a crystal out of order. */
#include "lattice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ordered.h"

enum { SITES = 4, SMALLEST = 3, LARGEST = 500 };
/*
 * Lengths in mean radii.  Neighbours are 2 (1 - CLOSER) apart in the perfect crystal; with the disorder, whose standard deviation
 * is 0.035, three in four overlap.  Second neighbours stay 0.6 apart, a gap that no reach in use closes.  Twice the disorder would
 * put the extremes of large scenes close to the end of the stable branch: they would be harder than small ones, not just larger.
 */
static const double RADIUS = 1e-3, CLOSER = 0.0125, DISORDER = 0.03;
static const nlc_material material = {1e8, 0.3};

/* Steele's splitmix64: the same everywhere. */
static uint64_t next(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* From -1 to 1. */
static double either_way(uint64_t *state)
{
    return (double)(next(state) >> 11) * 0x1p-52 - 1;
}

static int64_t below(uint64_t *state, int64_t count)
{
    return (int64_t)(next(state) % (uint64_t)count);
}

/* The number of each place's sphere. */
static void shuffle_numbers(int64_t *number, int64_t count, uint64_t *state)
{
    for (int64_t k = count - 1; k > 0; k--) {
        const int64_t other = below(state, k + 1), kept = number[k];
        number[k] = number[other];
        number[other] = kept;
    }
}

static void place(packing *p, int64_t sphere, const int64_t cell[3], int site, double edge, uint64_t *state)
{
    static const double offset[SITES][3] = {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
    for (int d = 0; d < 3; d++)
        p->x[sphere][d] = edge * ((double)cell[d] + offset[site][d]) + DISORDER * RADIUS * either_way(state);
    p->radius[sphere] = RADIUS * (1 + DISORDER * either_way(state));
    p->id[sphere] = sphere + 1;
}

static void fill(packing *p, const int64_t *number, int64_t cells, uint64_t *state)
{
    const double edge = 2 * RADIUS * (1 - CLOSER) * 1.4142135623730951;
    int64_t k = 0;
    for (int64_t a = 0; a < cells; a++)
        for (int64_t b = 0; b < cells; b++)
            for (int64_t c = 0; c < cells; c++)
                for (int site = 0; site < SITES; site++) place(p, number[k++], (const int64_t[]){a, b, c}, site, edge, state);
    for (int d = 0; d < 3; d++) {
        p->low[d] = 0;
        p->high[d] = edge * (double)cells;
        p->periodic[d] = true;
    }
}

static int make(packing *p, const char *name, int64_t cells, bool shuffled)
{
    const size_t count = SITES * (size_t)(cells * cells * cells);
    uint64_t state = 1;
    memset(p, 0, sizeof *p);
    p->name = malloc(strlen(name) + 1);
    p->x = malloc(count * sizeof *p->x);
    p->radius = malloc(count * sizeof *p->radius);
    p->material = calloc(count, sizeof *p->material);
    p->id = malloc(count * sizeof *p->id);
    p->materials = malloc(sizeof *p->materials);
    int64_t *number = malloc(count * sizeof *number);
    const bool there = p->name && p->x && p->radius && p->material && p->id && p->materials && number;
    if (there) {
        strcpy(p->name, name);
        p->count = (int64_t)count;
        p->materials[0] = material;
        p->material_count = 1;
        for (int64_t k = 0; k < p->count; k++) number[k] = k;
        if (shuffled) shuffle_numbers(number, p->count, &state);
        state = 2; /* the same places either way */
        fill(p, number, cells, &state);
    }
    free(number);
    return there ? 0 : -1;
}

/* In place; as neighbour lists of codes that sort nothing. */
static void shuffle_contacts(neighbours *n)
{
    uint64_t state = 3;
    for (int64_t k = n->count - 1; k > 0; k--) {
        const int64_t c = below(&state, k + 1);
        const int32_t i = n->i[k], j = n->j[k];
        const double overlap = n->overlap[k];
        double normal[3];
        memcpy(normal, n->normal[k], sizeof normal);
        n->i[k] = n->i[c];
        n->j[k] = n->j[c];
        n->overlap[k] = n->overlap[c];
        memcpy(n->normal[k], n->normal[c], sizeof normal);
        n->i[c] = i;
        n->j[c] = j;
        n->overlap[c] = overlap;
        memcpy(n->normal[c], normal, sizeof normal);
    }
}

static int open_numbered(packing *p, neighbours *n, const char *name, double reach, char *error, size_t error_size)
{
    const bool shuffled = strncmp(name, "lattice:", 8) == 0, sorted = strncmp(name, "sorted:", 7) == 0;
    memset(p, 0, sizeof *p);
    memset(n, 0, sizeof *n);
    if (shuffled || sorted) {
        char *end;
        const char *number = strchr(name, ':') + 1;
        const long long cells = strtoll(number, &end, 10);
        if (end == number || *end || cells < SMALLEST || cells > LARGEST) {
            snprintf(error, error_size, "%s: expected a number from %d to %d", name, SMALLEST, LARGEST);
            return -1;
        }
        if (make(p, name, cells, shuffled)) {
            snprintf(error, error_size, "%s: out of memory", name);
            return -1;
        }
    } else if (packing_read(p, name, true, error, error_size)) {
        return -1;
    }
    char reason[PACKING_ERROR_SIZE];
    if (neighbours_find(n, p, reach, reason, sizeof reason)) {
        snprintf(error, error_size, "%s: %.*s", name, (int)(sizeof reason / 2), reason);
        return -1;
    }
    if (shuffled) shuffle_contacts(n);
    return 0;
}

int packing_open(packing *p, neighbours *n, const char *name, double reach, char *error, size_t error_size)
{
    const bool ordered = strncmp(name, "ordered:", 8) == 0;
    if (open_numbered(p, n, ordered ? name + 8 : name, reach, error, error_size)) return -1;
    const char *reason = ordered ? ordered_renumber(p, n) : NULL;
    if (reason) snprintf(error, error_size, "%s: %s", name, reason);
    return reason ? -1 : 0;
}
