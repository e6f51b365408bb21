/* SPDX-License-Identifier: BSD-2-Clause */
/* rows.h - sums over a particle's contacts in models whose coefficients are not the same both ways: contact by contact. */
#ifndef NLC_ROWS_H
#define NLC_ROWS_H

#include "model.h"

/* Adds to the displacement of c what the contacts of b do, part[] each, but not c itself; false: one lies in its direction. */
static inline bool nlc_add_row(nlc_block *a, int c, const nlc_block *b, const double *part)
{
    double sum = 0, nearest = 4;
    for (int d = 0; d < b->count; d++) {
        if (a == b && d == c) continue;
        const double x = a->x[c] - b->x[d], y = a->y[c] - b->y[d], z = a->z[c] - b->z[d], t = x * x + y * y + z * z;
        nearest = t < nearest ? t : nearest;
        sum += part[d];
    }
    a->displacement[c] += sum;
    return nearest > 0x1p-200;
}

/* A row of a model: contact c of a by all of b. */
typedef bool nlc_row(nlc_block *a, int c, const nlc_block *b, const nlc_kernel *kernel);

static inline bool nlc_rows_within(nlc_block *a, const nlc_kernel *kernel, nlc_row *row)
{
    bool distinct = true;
    for (int c = 0; c < a->count; c++) distinct &= row(a, c, a, kernel);
    return distinct;
}

static inline bool nlc_rows_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel, nlc_row *row)
{
    bool distinct = true;
    for (int c = 0; c < a->count; c++) distinct &= row(a, c, b, kernel);
    for (int d = 0; d < b->count; d++) distinct &= row(b, d, a, kernel);
    return distinct;
}

#endif
