/* SPDX-License-Identifier: BSD-2-Clause */
/* measure.c - mean forces and distances, the distribution of forces, the volume fraction. */
#include "measure.h"

#include <math.h>

enum { CELLS = 12 }; /* of a grid over half a diameter, in each direction */

static bool inside(const double *x, const double *low, const double *high, double margin)
{
    for (int d = 0; d < 3; d++)
        if (!(x[d] >= low[d] + margin && x[d] <= high[d] - margin)) return false;
    return true;
}

/* Share of a sphere that is in a box: the points of a grid in it. */
static double share_inside(const double *x, double radius, const double *low, const double *high)
{
    int in = 0, all = 0;
    if (inside(x, low, high, radius)) return 1;
    if (!inside(x, low, high, -radius)) return 0;
    for (int k = 0; k < 8 * CELLS * CELLS * CELLS; k++) {
        const int cell[3] = {k % (2 * CELLS), k / (2 * CELLS) % (2 * CELLS), k / (4 * CELLS * CELLS)};
        double point[3], square = 0;
        for (int d = 0; d < 3; d++) {
            const double e = (cell[d] + .5) / CELLS - 1;
            square += e * e;
            point[d] = x[d] + radius * e;
        }
        if (square > 1) continue;
        all++;
        in += inside(point, low, high, 0);
    }
    return (double)in / all;
}

/* Volume of the grains over that of the box one mean diameter away from all walls.  Grains keep their volume where they are
 * flattened (nu = 1/2), so overlaps count twice. */
static double volume_fraction(const bed *b)
{
    const double margin = 2 * b->mean_radius, height = bed_height(b);
    double low[3], high[3], grains = 0, box = 1;
    for (int d = 0; d < 3; d++) {
        low[d] = b->p.low[d] + margin;
        high[d] = (d < 2 ? b->p.high[d] : height) - margin;
        box *= high[d] - low[d];
    }
    for (int64_t k = 0; k < b->p.count; k++)
        grains += b->mass[k] / b->set.density * share_inside(b->p.x[k], b->p.radius[k], low, high);
    return grains / box;
}

void measure(run_row *row, const bed *b, const run *r)
{
    double sum = 0, branch = 0, part = 0, all = 0, resultant = 0;
    int64_t contacts = 0;
    for (int64_t c = 0; c < b->n.count; c++) {
        const double force = b->force[c];
        if (!(force > 0)) continue;
        part += b->saturated[c] * force;
        all += force;
        if (c >= b->n.pair_count) continue;
        const int bin = run_bin(r, force);
        if (bin >= 0) row->count[bin]++;
        sum += force;
        branch += b->p.radius[b->n.i[c]] + b->p.radius[b->n.j[c]] - b->overlap[c];
        contacts++;
    }
    for (int64_t k = 0; k < b->p.count; k++)
        resultant += sqrt(b->F[k][0] * b->F[k][0] + b->F[k][1] * b->F[k][1] + b->F[k][2] * b->F[k][2]);
    row->value[RUN_TOP] = b->wall_force[BED_WALLS - 1][2];
    row->value[RUN_MEAN_FORCE] = contacts ? sum / (double)contacts : 0;
    row->value[RUN_BRANCH] = contacts ? branch / (double)contacts : NAN;
    row->value[RUN_FRACTION] = volume_fraction(b);
    row->value[RUN_SATURATED] = all > 0 ? part / all : 0;
    row->value[RUN_UNBALANCED] = contacts ? resultant / (double)b->p.count / row->value[RUN_MEAN_FORCE] : NAN;
}
