/* SPDX-License-Identifier: BSD-2-Clause */
/* places.c - contact points on displaced surfaces, [MC] III. */
#include "contact.h"

#define FARTHEST 0.5 /* from the undeformed surface, in units of R */
#define LARGEST 1e300 /* beyond what counts as a radius; sums of a few do not overflow */

static double bounded(double x)
{
    return x > LARGEST ? LARGEST : x < -LARGEST ? -LARGEST : x;
}

void nlc_set_places(nlc_network *n, const double *side, const double *overlap, double per_overlap)
{
    for (int64_t e = 0; e < 2 * n->contact_count; e++) {
        const int64_t c = e >> 1, body = e & 1 ? n->j[c] : n->i[c];
        n->own[e] = 0;
        if (!(nlc_yield_of(n, body) > 0)) continue;
        const double length = nlc_length_of(n, body), most = FARTHEST * length;
        const double place = nlc_place(bounded(side[e]), bounded(side[e ^ 1]), bounded(overlap[c] * per_overlap));
        n->own[e] = (place > most ? most : place < -most ? -most : place) / length;
    }
}

void nlc_split_sides(const nlc_network *n, double *side)
{
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double a = nlc_yield_of(n, n->i[c]), b = nlc_yield_of(n, n->j[c]), larger = a > b ? a : b;
        const double r = a / (larger + 1e-300), s = b / (larger + 1e-300), sum = r + s + 1e-300;
        side[2 * c] = r / sum * n->current[c] + 0; /* on walls 0 and not -0: no sweep writes there */
        side[2 * c + 1] = s / sum * n->current[c] + 0;
    }
}
