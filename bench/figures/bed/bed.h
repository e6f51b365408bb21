/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * bed.h - a bed of two powders in a die with a punch on it, [GC] 4.2.
 *
 * The die is a square well with smooth rigid walls from (0, 0, 0) to (side, side, height); the punch is its lid.  m, N, Pa.
 */
#ifndef NLC_FIGURES_BED_H
#define NLC_FIGURES_BED_H

#include <stdint.h>

#include "nlcontact.h"

enum { BED_SPHERES = 125, BED_WALLS = 6, BED_FLOOR = 4, BED_PUNCH = 5, BED_CONTACTS = 4000, POWDERS = 2, BED_RIGID = POWDERS };

typedef struct powder {
    int spheres;
    double smallest, largest; /* radii */
    nlc_material material;
} powder;
extern const powder powders[POWDERS];
extern const double die_side;

typedef struct bed {
    double x[BED_SPHERES][3], radius[BED_SPHERES];
    int32_t material[BED_SPHERES]; /* number of the powder */
    double height;                 /* of the punch */
} bed;

double bed_solid(const bed *b); /* volume of the spheres */
double bed_density(const bed *b);

/* The spheres of a seed, in the order in which they are poured, and nowhere yet. */
void bed_mix(bed *b, uint64_t *state);

/* The next number of a generator, above 0 and below 1. */
double bed_random(uint64_t *state);

/*
 * Pours the spheres one by one: each falls from above on a random place, rolls down what it meets as steeply as it can and stays
 * where it is held from three sides.  The punch then touches the highest sphere.
 */
void bed_pour(bed *b, uint64_t *state);

#endif
