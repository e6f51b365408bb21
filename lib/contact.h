/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * contact.h - the circles of contact, for models that look at their size.
 *
 * A contact's circle has the radius a, a^2 = R_eff x with 1/R_eff = 1/R_i + 1/R_j and the overlap x = (P/k)^(2/3) that its force
 * would need alone ([GC] 7 and 8).  No circle is taken for larger than the smaller of the two particles.
 */
#ifndef NLC_CONTACT_H
#define NLC_CONTACT_H

#include "network.h"

/*
 * Sets network->approach, the overlaps x, in units of 1 / network->per_length; forces and stiffnesses have theirs.  -x where the circle
 * would be larger than it is taken for.
 */
void nlc_set_approach(nlc_network *network, const double *force);

/* The other body of a side; a wall's radius is infinite. */
static inline int64_t nlc_other_body(const nlc_network *n, int64_t e)
{
    return e & 1 ? n->i[e >> 1] : n->j[e >> 1];
}

/* R_eff / R of a side on a particle of radius R */
static inline double nlc_effective(const nlc_network *n, int64_t e, double R)
{
    const int64_t other = nlc_other_body(n, e);
    if (other >= n->particle_count) return 1;
    const double S = n->radius[other], part = R > 1e300 || S > 1e300 ? 0.5 : 1; /* the sum is in range, and not 0 */
    return part * S / (part * R + part * S);
}

/* (a/R)^2 of a side, R being the particle's radius. */
double nlc_circle2(const nlc_network *network, int64_t side, int64_t particle);

/*
 * What (a/R)^2 of a contact is to be multiplied by in a coefficient of the tangent: 1/6; 2/15, the mean of what targets and sources have, of
 * the largest circles, which grow no more.
 */
double nlc_circle_change(const nlc_network *network, int64_t contact);

/* A particle's radius in the unit of overlaps, not 0 and not infinite. */
static inline double nlc_length_of(const nlc_network *n, int64_t particle)
{
    const double r = nlc_join(n->radius[particle], n->length_unit);
    return r > 1e-290 ? r < 1e290 ? r : 1e290 : 1e-290;
}

/*
 * How the traction under a contact is tilted: chi = (q_k / sum of q) (R_k / R_eff), q = (1-nu^2)/E.  1 between equal spheres and on
 * a rigid plate: along the axis of the contact; 0 would be normal to the sphere.  Returns chi - 1.
 */
#define NLC_NO_TILT 1e-12 /* rounding */
double nlc_tilt(const nlc_network *network, int64_t side, int64_t particle);

/*
 * Where the contact point of a side is ([MC] III), outward from its undeformed surface: on the displaced one or, where that
 * overlaps the other side's, midway between them.
 */
static inline double nlc_place(double own, double other, double overlap)
{
    const double x = overlap + (own + other);
    return own - 0.25 * (x + fabs(x));
}

/*
 * places.c: such places from the displacements of the sides.  Into network->own, see NLC_SHAPE_PLACE; no farther than R/2 from the
 * undeformed surface.
 */
void nlc_set_places(nlc_network *network, const double *side, const double *overlap, double per_overlap);

/* Parts of the displacements in network->current that the two sides have, to begin with: as they yield. */
void nlc_split_sides(const nlc_network *network, double *side);

/* The shape and the tilt of a side that is number d of a block; its force is there.  length: nlc_length_of the particle. */
void nlc_set_shape(nlc_block *block, int d, const nlc_network *network, nlc_response response, int64_t side, int64_t particle,
                   double length);

/* A side as number d of a block, with all that the model looks at.  block->tilted is only set. */
static inline void nlc_put_side(nlc_block *b, int d, const nlc_network *n, nlc_response response, const double *force,
                                const double *normal, int64_t e, int64_t particle, double length)
{
    nlc_set_direction(b, d, normal, e);
    b->force[d] = nlc_scale_of(n, particle) * force[e >> 1];
    b->displacement[d] = b->second[d] = b->third[d] = 0;
    if (n->settings.model->shape != NLC_SHAPE_NONE) nlc_set_shape(b, d, n, response, e, particle, length);
}

/* Adds to network->side what the second and third sum of a side and its contact's own force make. */
void nlc_add_self(nlc_network *network, nlc_response response, const double *force, int64_t side, int64_t particle, double length,
                  double tilt, double second, double third);

#endif
