/* SPDX-License-Identifier: BSD-2-Clause */
/* powder.c - the two powders of [GC] 4.2, mixed. */
#include "bed.h"

#include <math.h>

#define PI 3.14159265358979323846

/*
 * The paper says neither how many spheres are of which powder nor what is log-normal within the cut-offs.  125 of them have the
 * volume of relative density 0.42 at 1 mm, both the paper's, with these numbers; then both powders have about the same volume.
 */
const powder powders[POWDERS] = {{109, 75e-6, 80e-6, {19e9, .30}}, {16, 125e-6, 167e-6, {7e9, .20}}};
const double die_side = 1e-3;

double bed_solid(const bed *b)
{
    double sum = 0;
    for (int k = 0; k < BED_SPHERES; k++) sum += b->radius[k] * b->radius[k] * b->radius[k];
    return 4 * PI / 3 * sum;
}

double bed_density(const bed *b)
{
    return bed_solid(b) / (die_side * die_side * b->height);
}

/* SplitMix64, Steele, Lea and Flood (2014) */
static uint64_t next(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

double bed_random(uint64_t *state)
{
    return ((double)(next(state) >> 12) + .5) * 0x1p-52;
}

/* Box and Muller */
static double normal(uint64_t *state)
{
    const double size = sqrt(-2 * log(bed_random(state)));
    return size * cos(2 * PI * bed_random(state));
}

/* Log-normal, the cut-offs two standard deviations from the median. */
static double radius_of(const powder *p, uint64_t *state)
{
    double z;
    do z = normal(state);
    while (fabs(z) > 2);
    return sqrt(p->smallest * p->largest) * pow(p->largest / p->smallest, z / 4);
}

void bed_mix(bed *b, uint64_t *state)
{
    int k = 0;
    for (int p = 0; p < POWDERS; p++)
        for (int n = 0; n < powders[p].spheres; n++) b->material[k++] = p;
    for (k = BED_SPHERES - 1; k > 0; k--) {
        const int other = (int)(bed_random(state) * (k + 1));
        const int32_t material = b->material[k];
        b->material[k] = b->material[other];
        b->material[other] = material;
    }
    for (k = 0; k < BED_SPHERES; k++) b->radius[k] = radius_of(&powders[b->material[k]], state);
}
