/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * model.h - what the driver sees of a force model: a row of a table.
 *
 * A model's displacement on a particle of radius R and modulus E is U times a function of the directions and Poisson's ratio,
 * U = (1+nu) / (4 pi R E).  The functions here are given forces times U.
 */
#ifndef NLC_MODEL_H
#define NLC_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "sphere.h"

/* Contacts of one particle, or a part of them where there are more than fit. */
#define NLC_BLOCK 64
typedef struct nlc_block {
    int count;
    /* [count], with room for a copy behind it */
    double x[2 * NLC_BLOCK], y[2 * NLC_BLOCK], z[2 * NLC_BLOCK]; /* outward unit normals */
    double force[2 * NLC_BLOCK]; /* times U */
    double shape[2 * NLC_BLOCK];    /* what the model's nlc_shape says */
    double tilt[2 * NLC_BLOCK];     /* NLC_SHAPE_MOMENTS: chi - 1, see contact.h */
    bool tilted;                    /* some tilt is not 0 */
    double displacement[NLC_BLOCK]; /* added to, > 0 outward */
    double second[NLC_BLOCK];       /* NLC_SHAPE_MOMENTS: the second sum, likewise */
    double third[NLC_BLOCK];        /* the third one, if tilted */
    double *kept; /* coefficients of a model that has such, all pairs of the block; NULL: none are kept */
    bool known;   /* they are there already */
} nlc_block;

/* What a model has to know of a contact beside its direction and force. */
typedef enum nlc_shape {
    NLC_SHAPE_NONE,    /* nothing */
    NLC_SHAPE_POINT,   /* 0: moments of a point */
    NLC_SHAPE_MOMENTS, /* of its pressure: U P (a/R)^2 / 10, or in a coefficient (a/R)^2 / 6 */
    NLC_SHAPE_RADIUS,  /* a/R */
    NLC_SHAPE_PLACE    /* distance from the particle's centre / R - 1 */
} nlc_shape;

/* Whether displacements are proportional to the forces. */
static inline bool nlc_is_linear(nlc_shape shape)
{
    return shape == NLC_SHAPE_NONE || shape == NLC_SHAPE_POINT;
}

/* Constants of a kernel, prepared once per material. */
typedef struct nlc_kernel {
    double poisson, prefactor;
    double compliance; /* (1-nu^2)/E, in units of the largest of all materials */
    double c[3];       /* of Case I */
    nlc_sphere_constants sphere;
    nlc_sphere_series tilted;       /* change of D with chi */
    nlc_sphere_quadratic self;      /* of the sphere's self terms */
} nlc_kernel;

/* What a contact's own force does to it, in units of U: displacement inward / P, its derivative, and twice the energy / P^2. */
typedef struct nlc_self {
    double displacement, slope, energy;
} nlc_self;

typedef struct nlc_model {
    const char *name;      /* as on a command line */
    const char *reference; /* authors, year, equations */
    const char *doi;
    const char *validity;
    int kept;       /* numbers of a pair that do not depend on the forces and are worth keeping; 0: it is quicker to compute them */
    double cost;    /* of a sweep, in units of Case I's: make accuracy */
    bool symmetric; /* the tangent's coefficients of a pair are the same both ways */
    bool potential; /* the forces are the derivative of an energy */
    nlc_shape shape;
    /* NULL in a model whose own force does nothing beyond Hertz; (a/R)^2, tilt chi - 1, see contact.h */
    nlc_self (*self)(const nlc_kernel *kernel, double circle2, double tilt);
    /* NULL in a model without coupling: */
    void (*prepare)(nlc_kernel *kernel, double poisson, double prefactor);
    /* Displacements in a block by its own forces, or in two blocks by each other's.  False: two directions are the same. */
    bool (*within)(nlc_block *a, const nlc_kernel *kernel);
    bool (*between)(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);
    /* What tilts add between blocks of which tilted is false and tilt is the tilt times the shape; NLC_SHAPE_MOMENTS. */
    void (*tilt_between)(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);
    /*
     * The tangent's coefficients of contact c with those before it; sum of their squares over all pairs, times both forces: of equal
     * directions much, or INFINITY, but nothing overflows.
     * In a model without potential those of Case I, which decide how far to weaken it.
     */
    void (*coefficients)(double *coefficient, const nlc_block *a, int c, const nlc_kernel *kernel);
    double (*squares)(nlc_block *a, const nlc_kernel *kernel);
    /*
     * dc/dt of the coefficient c in the energy of two contacts at the squared distance t, whose (a/R)^2 / 10 add to moment and, times
     * their tilts, to tilted: see turning.c.  NULL in a model without potential, or without coupling.
     */
    double (*turning)(const nlc_kernel *kernel, double t, double moment, double tilted);
    /* No coefficient of directions that are at least so far apart is larger. */
    double (*most)(const nlc_kernel *kernel, double distance);
} nlc_model;

extern const nlc_model nlc_models[];
extern const int32_t nlc_models_count;
extern const nlc_model nlc_half_space_undeformed; /* NLC_POINTS_UNDEFORMED */

/* Case I of [GC], which is also the half-space kernel of [MC] at undeformed contact points: boussinesq_block.c */
void nlc_case_one_prepare(nlc_kernel *kernel, double poisson, double prefactor);
void nlc_half_space_prepare(nlc_kernel *kernel, double poisson, double prefactor);
bool nlc_case_one_within(nlc_block *a, const nlc_kernel *kernel);
bool nlc_case_one_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);
void nlc_case_one_coefficients(double *coefficient, const nlc_block *a, int c, const nlc_kernel *kernel);
double nlc_case_one_squares(nlc_block *a, const nlc_kernel *kernel);
double nlc_case_one_turning(const nlc_kernel *kernel, double t, double moment, double tilted);
double nlc_case_one_most(const nlc_kernel *kernel, double distance);

/* Case II of [GC]: love_block.c */
void nlc_love_prepare(nlc_kernel *kernel, double poisson, double prefactor);
bool nlc_love_within(nlc_block *a, const nlc_kernel *kernel);
bool nlc_love_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);

/* Eq. 1 of [MC] at deformed contact points: half_space_block.c */
bool nlc_half_space_within(nlc_block *a, const nlc_kernel *kernel);
bool nlc_half_space_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);

/* The elastic sphere: sphere_model.c, sphere_block.c */
void nlc_sphere_model_prepare(nlc_kernel *kernel, double poisson, double prefactor);
nlc_self nlc_sphere_model_self(const nlc_kernel *kernel, double circle2, double tilt);
bool nlc_sphere_within(nlc_block *a, const nlc_kernel *kernel);
bool nlc_sphere_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);
void nlc_sphere_tilt_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);
void nlc_sphere_coefficients(double *coefficient, const nlc_block *a, int c, const nlc_kernel *kernel);
double nlc_sphere_squares(nlc_block *a, const nlc_kernel *kernel);
double nlc_sphere_turning(const nlc_kernel *kernel, double t, double moment, double tilted);

#endif
