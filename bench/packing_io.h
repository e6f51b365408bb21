/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * packing_io.h - packings of spheres from files.  bench/README describes the format.
 */
#ifndef NLC_BENCH_PACKING_IO_H
#define NLC_BENCH_PACKING_IO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "nlcontact.h"

enum {
    PACKING_LINE_MAX = 4095,  /* bytes in a line; a comment may be longer, its rest is not looked at */
    PACKING_TYPE_MAX = 65535, /* largest number of a type */
    PACKING_ERROR_SIZE = 1024 /* a buffer that holds every message, unless the path is very long */
};

/* A flat wall. */
typedef struct packing_wall {
    double point[3];  /* on the plane [m] */
    double normal[3]; /* unit, towards the particles */
} packing_wall;

typedef struct packing {
    char *name;
    int64_t count;           /* particles */
    double (*x)[3];          /* [count] centres as in the file: along a periodic axis they may lie outside the box [m] */
    double *radius;          /* [count] [m] */
    int32_t *material;       /* [count] type - 1 */
    int64_t *id;             /* [count] what the file calls them */
    nlc_material *materials; /* [material_count] of type 1, 2, ...; zeros for a type without a line; rigid walls' comes last */
    int64_t material_count;
    double low[3], high[3]; /* the box [m] */
    bool periodic[3];
    packing_wall *walls;    /* [wall_count] wall 1, 2, ... */
    int32_t *wall_material; /* [wall_count] index into materials */
    int64_t wall_count;
} packing;

/*
 * packing_read - a packing from a text file, or from a binary file and the header beside it (either may be named).
 *
 * p            out; to be freed with packing_free, also after an error
 * path         NAME.csv, NAME.header.txt or NAME.f64le
 * progress     shows a progress line on stderr when reading takes longer than a second
 * error        [error_size] out, on failure: "file:line: reason"
 * Returns 0, or -1 on failure.
 */
int packing_read(packing *p, const char *path, bool progress, char *error, size_t error_size);

void packing_free(packing *p);

/* The centre of particle k, moved into the box along periodic axes. */
void packing_position(const packing *p, int64_t k, double x[3]);

/* The packing as the library wants it.  Points into p. */
nlc_particles packing_particles(const packing *p);

double packing_volume(const packing *p);

#endif
