/* SPDX-License-Identifier: BSD-2-Clause */
/* contact.c - the circles of contact. */
#include "contact.h"

#define LARGEST_TILT 1e6
#define STEEPEST 1e100 /* in units of the iteration, for absurd numbers: its square is in range */
#define FARTHEST 1e300 /* overlap, likewise */

/* No circle is taken for larger than that of this overlap. */
static double largest_approach(const nlc_network *n, int64_t c)
{
    const int64_t i = n->i[c], j = n->j[c];
    const double a = i < n->particle_count ? nlc_length_of(n, i) : INFINITY;
    const double b = j < n->particle_count ? nlc_length_of(n, j) : INFINITY;
    return a < b ? a : b;
}

static double approach_of(const nlc_network *n, int64_t c)
{
    return n->approach[c] < 0 ? largest_approach(n, c) : n->approach[c];
}

/*
 * 1 for a circle that grows with its force.  Beyond the largest one displacements are proportional to forces: 0, but not at once, since
 * how far a coupling is weakened depends on slopes, and must not jump.
 */
static double growth_of(const nlc_network *n, int64_t c)
{
    if (n->approach[c] >= 0) return 1;
    const double part = largest_approach(n, c) / -n->approach[c];
    return part * part * (part * part);
}

void nlc_set_approach(nlc_network *n, const double *force)
{
    for (int64_t c = 0; c < n->contact_count; c++) {
        n->approach[c] = 0;
        if (!(force[c] > 0)) continue;
        const double own = nlc_hertz_overlap(nlc_join(n->stiffness[c], n->stiffness_unit), force[c]);
        const double x = nlc_is_finite(own) ? own : FARTHEST; /* of a stiffness of 0 in these units, too */
        n->approach[c] = x < largest_approach(n, c) ? x : x < FARTHEST ? -x : -FARTHEST;
    }
}

double nlc_tilt(const nlc_network *n, int64_t e, int64_t particle)
{
    const double q = nlc_kernel_of(n, particle)->compliance, p = nlc_kernel_of(n, nlc_other_body(n, e))->compliance;
    const double share = nlc_effective(n, e, n->radius[particle]);
    const double chi = (q / (q + p + 1e-300)) / (share > 1e-100 ? share : 1e-100);
    return (chi < LARGEST_TILT ? chi : LARGEST_TILT) - 1;
}

/* (a/R)^2 of a side */
static double circle2(const nlc_network *n, int64_t e, int64_t particle, double length)
{
    return nlc_effective(n, e, n->radius[particle]) * (approach_of(n, e >> 1) / length);
}

double nlc_circle2(const nlc_network *n, int64_t e, int64_t particle)
{
    return circle2(n, e, particle, nlc_length_of(n, particle));
}

double nlc_circle_change(const nlc_network *n, int64_t c)
{
    const double growth = growth_of(n, c);
    return growth < 1 ? growth / 6 + (1 - growth) * (2 / 15.) : 1 / 6.;
}

void nlc_set_shape(nlc_block *b, int d, const nlc_network *n, nlc_response response, int64_t e, int64_t particle,
                   double length)
{
    const nlc_shape shape = n->settings.model->shape;
    if (shape == NLC_SHAPE_POINT || shape == NLC_SHAPE_PLACE) {
        b->shape[d] = shape == NLC_SHAPE_PLACE ? n->own[e] : 0;
        return;
    }
    const double t2 = circle2(n, e, particle, length);
    if (shape == NLC_SHAPE_RADIUS) {
        b->shape[d] = sqrt(t2);
        return;
    }
    b->shape[d] = b->force[d] * t2 * (response == NLC_OF_CHANGES ? nlc_circle_change(n, e >> 1) : 0.1);
    b->tilt[d] = nlc_tilt(n, e, particle);
    b->tilted |= fabs(b->tilt[d]) > NLC_NO_TILT;
}

/*
 * By how much the gap of spheres is wider at the rim than that of paraboloids, a^4 sum 1/R^3, in units of the particle's R: its
 * own part, and that of a rigid other one, which has no side of its own.
 */
static double quartic(const nlc_network *n, int64_t e, int64_t particle, double t2)
{
    const int64_t other = nlc_other_body(n, e);
    if (other >= n->particle_count || n->scale[other] > 0) return t2 * t2;
    const double r = n->radius[particle], s = n->radius[other], larger = r > s ? r : s;
    const double ratio = (r / larger) / (s / larger + 1e-100);
    return t2 * t2 * (1 + ratio * ratio * ratio);
}

/*
 * Change of a side's displacement by its own force; moment and wide are parts of the displacement.  As a slope may be no lower than
 * its floor, no contact counts as smaller than the floor says.
 */
static double own_slope(const nlc_network *n, int64_t e, int64_t particle, double force, nlc_self self, double tilt, double moment,
                        double wide)
{
    const int64_t c = e >> 1;
    const double k = nlc_join(n->stiffness[c], n->stiffness_unit) + 1e-150, least = n->floor[c] / k, root = sqrt(approach_of(n, c));
    const double x = root > least ? root : least, alone = k * x * x * x + 1e-200;
    const double p = alone > force ? alone : force; /* a circle of the largest size has less than its force */
    if (root < least) {
        const double t2 = nlc_effective(n, e, n->radius[particle]) * (x * x / nlc_length_of(n, particle));
        self = n->settings.model->self(nlc_kernel_of(n, particle), t2 < 1 ? t2 : 1, tilt);
    }
    const double growth = growth_of(n, c), own = growth * self.slope + (1 - growth) * self.displacement;
    /* moments are of any size between equal directions, which are told of later: there is to be a quotient all the same */
    const double others = growth * (moment * (2. / 3) + wide * (4. / 3)), enough = fabs(others) * (1 / STEEPEST);
    const double slope = nlc_scale_of(n, particle) * own + others / (p > enough ? p : enough);
    return slope > STEEPEST ? -STEEPEST : slope < -STEEPEST ? STEEPEST : -slope;
}

void nlc_add_self(nlc_network *n, nlc_response response, const double *force, int64_t e, int64_t particle, double length,
                  double tilt, double second, double third)
{
    const double U = nlc_scale_of(n, particle);
    const double t2 = circle2(n, e, particle, length), moment = t2 * (second + tilt * third);
    if (response == NLC_OF_CHANGES) {
        n->side[e] += -moment * nlc_circle_change(n, e >> 1) + n->own[e] * force[e >> 1];
        return;
    }
    const nlc_self self = n->settings.model->self(nlc_kernel_of(n, particle), t2, tilt);
    const double p = 0.5 * force[e >> 1] + 0.5 * fabs(force[e >> 1]); /* a pull acts as a point force */
    const double wide = quartic(n, e, particle, t2) * length;
    if (response == NLC_OF_ENERGY) {
        n->side[e] -= moment / 10 + U * p * self.energy + wide * (2. / 35);
        return;
    }
    n->side[e] -= moment / 6 + U * p * self.displacement + wide / 15;
    if (response == NLC_OF_STATE) n->own[e] = own_slope(n, e, particle, p, self, tilt, moment / 6, wide / 15);
}
