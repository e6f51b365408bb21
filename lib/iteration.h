/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * iteration.h - the coupled equations as an iteration sees them: in units in which overlaps, forces and the product of
 * stiffness and coupling are about 1.  The units are powers of 2, so that they change no bit.
 */
#ifndef NLC_ITERATION_H
#define NLC_ITERATION_H

#include "network.h"

struct nlc_iteration {
    nlc_network *n;
    const double *overlap, *normal;
    double per_overlap, per_stiffness; /* 1 / unit */
    double load;                       /* per_overlap times the part of the overlaps that is applied */
    double largest_residual;           /* |z|, over all contacts */
    double largest_force;
    int directions; /* how many are in use; direction[0] is the residual */
    nlc_small M, K; /* W^T D^-1 W and W^T C W of the directions W */
    double step[NLC_DIRECTIONS], ritz[2][NLC_DIRECTIONS];
    double theta; /* largest Ritz value of the last step: at most lambda */
    bool kept;    /* spare[3] is the last state of an iteration towards the end of the stable branch that was not seen to be beyond */
    bool nearer;  /* ... and solves the equations much better than the start did */
};

#define NLC_SOFTEST 1e-150 /* softer contacts carry nothing, and this may be divided by */

static inline double nlc_scaled_stiffness(const nlc_iteration *q, int64_t c)
{
    const double k = q->n->stiffness[c] * q->per_stiffness;
    return k > NLC_SOFTEST ? k : NLC_SOFTEST;
}

/* No step assumes a slope below this part of k x^(1/2) at the largest overlap x nearby. */
#define NLC_SLOPE_FLOOR 0.01

/* No solution has overlap plus displacement beyond this. */
#define NLC_FARTHEST 8192.0

/* Overlap plus displacement, and the force of it. */
static inline double nlc_scaled_overlap(const nlc_iteration *q, int64_t c)
{
    const double y = q->overlap[c] * q->load + q->n->current[c];
    return y < NLC_FARTHEST ? y : NLC_FARTHEST;
}

static inline double nlc_scaled_force(const nlc_iteration *q, int64_t c)
{
    return nlc_law(nlc_scaled_stiffness(q, c), nlc_scaled_overlap(q, c));
}

/*
 * The overlap whose slope stands for that of y when a bound of lambda is looked for with a sweep (warm.c): the bound holds until an
 * overlap exceeds it, so it is a little larger.
 */
static inline double nlc_weighed_overlap(double y)
{
    const double more = 1.01 * y + 1e-4;
    return 0.5 * (more + fabs(more));
}

/* At least its root, from that of the positive part of y. */
static inline double nlc_weighed_root(double root)
{
    return 1.005 * root + 0.01;
}

/* units.c: what overlaps are next to, of which largest is the largest magnitude. */
double nlc_unit_of_overlaps(const double *overlap, int64_t count, double largest);

/* Sets the units. */
void nlc_iteration_units(nlc_iteration *q, nlc_network *network, const double *overlap, const double *normal, double part);
/* Sets the units, the start (network->force from network->current, which it scales) and the floor of the slopes. */
void nlc_iteration_start(nlc_iteration *q, nlc_network *network, const double *overlap, const double *normal, double part);
/* Largest overlap on the two bodies of a contact: the floor of the slopes tells. */
double nlc_overlap_nearby(const nlc_iteration *q, int64_t c);
/* A displacement back in the caller's unit, where contacts are not beyond the farthest; all of them. */
double nlc_in_callers_unit(const nlc_iteration *q, int64_t c);
void nlc_iteration_end(nlc_iteration *q);

/* What is seen of many residuals: the largest, the largest force, whether an iterate is below 0 or this many times the force. */
struct nlc_extremes {
    double residual, force;
    bool far;
};
#define NLC_FAR 8
#define NLC_LINE 1e-130 /* times the least slope there may be, some 1e-158, is far from the end of double */

/* directions.c: residual z of [GC] 10 into direction[0], its largest, and M: here, on this rank. */
void nlc_evaluate(nlc_iteration *q);
/* K from the images, C times the directions. */
void nlc_stiffness_products(nlc_iteration *q);
/* M and K of all ranks, from those of this one. */
bool nlc_products_over_ranks(nlc_iteration *q);
/* The step that makes the residual vanish in the space of the directions. */
void nlc_choose_step(nlc_iteration *q);
/* Takes it; keeps the last step, or (all) the last two and two Ritz vectors, as directions. */
void nlc_take_step(nlc_iteration *q, bool all);

/* relax.c: whether contacts push each other away by this many times the largest overlap nearby; a better start for such scenes. */
#define NLC_REPELLED 1.5
bool nlc_is_repelled(const nlc_iteration *q);
void nlc_relax(nlc_iteration *q);

/* scales.c: largest force on every body into network->largest: of the law, or the larger of it and the iterate. */
void nlc_force_scales(nlc_iteration *q, bool iterate_too);
/* Largest |value| over the scale of its contact; *where it is. */
double nlc_relative_size(const nlc_iteration *q, const double *values, int64_t *where);
/* The residual in the local energy norm, relative to the scales; it sees what the largest component does not, see there. */
double nlc_energy_residual(nlc_iteration *q);
/* The same from the sum of z^2 / D and the largest slope D of every particle, whose largest forces are in n->largest. */
double nlc_energy_ratio(const nlc_network *n, const double *sum, const double *top);

/*
 * schwarz.c: r, the residual of weakened equations at overlaps plus displacements x, becomes about what x is off by.
 * network->weakening is that at x.
 */
void nlc_ask_particles(nlc_iteration *q, const double *x, double *r, nlc_outcome *outcome);

/* weaken.c: the solution with weakened coupling; it begins at the start given, or where the iteration came to. */
void nlc_weaken(nlc_iteration *q, nlc_outcome *outcome);

/* The error is taken for no less than this times residual / (1 - lambda), see galerkin.c. */
#define NLC_SAFETY 1.5

/* The bound of lambda up to which a state counts as stable is 1 - this. */
#define NLC_MARGIN 0.015
#define NLC_BALANCE_PASSES 16

#endif
