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

struct nlc_sphere_constants;

/* Contacts of one particle, or a part of them where there are more than fit. */
#define NLC_BLOCK 64
typedef struct nlc_block {
    int count;
    /* [count], with room for a copy behind it */
    double x[2 * NLC_BLOCK], y[2 * NLC_BLOCK], z[2 * NLC_BLOCK]; /* outward unit normals */
    double force[2 * NLC_BLOCK]; /* times U */
    double displacement[NLC_BLOCK]; /* added to, > 0 outward */
    /* NLC_MODEL_SPHERE only: (contact radius / R)^2, with room for a copy; the second sum, see sphere_block.c */
    double radius2[2 * NLC_BLOCK], second[NLC_BLOCK];
} nlc_block;

/* Constants of a kernel, prepared once per material. */
#define NLC_KERNEL_SIZE 3
typedef struct nlc_kernel {
    double c[NLC_KERNEL_SIZE];
} nlc_kernel;

typedef struct nlc_model {
    const char *name;      /* as on a command line */
    const char *reference; /* authors, year, equations */
    const char *doi;
    const char *validity;
    bool available; /* in this version */
    /* NULL in a model without coupling: */
    void (*prepare)(nlc_kernel *kernel, double poisson, double prefactor);
    /* Displacements in a block by its own forces, or in two blocks by each other's.  False: two directions are the same. */
    bool (*within)(nlc_block *a, const nlc_kernel *kernel);
    bool (*between)(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);
    /* Coefficients of contact c with those before it; sum of their squares over all pairs, times both forces. */
    void (*coefficients)(double *coefficient, const nlc_block *a, int c, const nlc_kernel *kernel);
    double (*squares)(nlc_block *a, const nlc_kernel *kernel);
    /* No coefficient of directions that are at least so far apart is larger. */
    double (*most)(const nlc_kernel *kernel, double distance);
} nlc_model;

extern const nlc_model nlc_models[];
extern const int32_t nlc_models_count;

/* Case I of [GC], which is also the half-space kernel of [MC] at undeformed contact points: boussinesq_block.c */
void nlc_case_one_prepare(nlc_kernel *kernel, double poisson, double prefactor);
void nlc_half_space_prepare(nlc_kernel *kernel, double poisson, double prefactor);
bool nlc_case_one_within(nlc_block *a, const nlc_kernel *kernel);
bool nlc_case_one_between(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);
void nlc_case_one_coefficients(double *coefficient, const nlc_block *a, int c, const nlc_kernel *kernel);
double nlc_case_one_squares(nlc_block *a, const nlc_kernel *kernel);
double nlc_case_one_most(const nlc_kernel *kernel, double distance);

/* The elastic sphere to second order: sphere_block.c */
bool nlc_sphere_within(nlc_block *a, const struct nlc_sphere_constants *constants);
bool nlc_sphere_between(nlc_block *a, nlc_block *b, const struct nlc_sphere_constants *constants);

#endif
