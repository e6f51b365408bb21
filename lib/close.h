/* SPDX-License-Identifier: BSD-2-Clause */
/* close.h - circles of contact that overlap each other, and the overlaps that they are of. */
#ifndef NLC_CLOSE_H
#define NLC_CLOSE_H

#include "network.h"

/* The displacement found for a contact, in the caller's units. */
static inline double nlc_answer(const nlc_network *n, int64_t c)
{
    return n->answered ? (n->side[2 * c] + n->side[2 * c + 1]) * nlc_pow2(-n->length_unit) : n->current[c];
}

/* Those of the contacts from first to end. */
static inline void nlc_answers(const nlc_network *n, int64_t first, int64_t end, double *answers)
{
    const double per_unit = nlc_pow2(-n->length_unit);
    if (!n->answered) memcpy(answers + first, n->current + first, (size_t)(end - first) * sizeof *answers);
    else
        for (int64_t c = first; c < end; c++) answers[c] = (n->side[2 * c] + n->side[2 * c + 1]) * per_unit;
}

/* The overlap that a contact at this displacement has, or would have alone if others push it open. */
static inline double nlc_alone(double overlap, double nonlocal)
{
    return overlap + 0.5 * (nonlocal + fabs(nonlocal));
}

/*
 * x / (1 + R_smaller / R_larger) of a contact whose circle at the overlap x is larger than the largest so far: R times that is at least
 * the square of the circle's radius on a particle of radius R.
 */
static inline double nlc_larger_circle(const nlc_network *n, int64_t c, double x, double largest)
{
    const int64_t i = n->i[c], j = n->j[c];
    const bool wall = i >= n->particle_count || j >= n->particle_count;
    if (x <= largest * (wall ? 1 : 1 + n->least_ratio)) return largest; /* what it is reduced to is less */
    const double R = i < n->particle_count ? n->radius[i] : INFINITY, S = j < n->particle_count ? n->radius[j] : INFINITY;
    const double reduced = x / (1 + (R < S ? R : S) / (R < S ? S : R));
    return reduced > largest ? reduced : largest;
}

/* close.c: whether somewhere the circles of two contacts overlap, at the displacements found. */
bool nlc_circles_overlap(const nlc_network *network, const double *overlap, const double *normal);

#endif
