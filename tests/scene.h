/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * scene.h - small scenes to test the network functions on, and an independent solution of them.
 *
 * A scene owns growing arrays; whatever fails for want of memory ends the test program.
 */
#ifndef NLC_TESTS_SCENE_H
#define NLC_TESTS_SCENE_H

#include <stddef.h>

#include "nlcontact.h"
#include "packing_io.h"
#include "support.h"

typedef struct scene {
    int64_t particles, walls, contacts, materials;
    double *radius;
    int32_t *material, *wall_material;
    nlc_material *rows;
    int32_t *i, *j;
    double *overlap, *normal;
    double *force, *nonlocal;
    nlc_options options;
    nlc_network *network;
    void *memory;
} scene;

void scene_init(scene *s); /* empty, default options */
void scene_free(scene *s);

int32_t scene_material(scene *s, double young, double poisson);
int32_t scene_particle(scene *s, double radius, int32_t material);
int32_t scene_wall(scene *s, int32_t material); /* index among the walls; add its contacts when all particles are there */
void scene_contact(scene *s, int32_t i, int32_t j, double overlap, double x, double y, double z); /* direction of any length */

nlc_particles scene_view(const scene *s);

/* Allocates force (zeros), nonlocal (zeros) and memory and builds the network; the status of nlc_network_init. */
nlc_status scene_build(scene *s);
nlc_status scene_solve(scene *s, nlc_info *info); /* builds if need be */

double scene_total(const scene *s); /* sum of all forces */

/* One sphere of radius R in a periodic cell: every contact is with itself. */
typedef enum lattice { SIMPLE_CUBIC, BODY_CENTRED, FACE_CENTRED } lattice;
/* Spacings along x, y, z relative to those at which first neighbours touch; second neighbours of BODY_CENTRED included. */
void scene_cell(scene *s, lattice type, double R, double young, double poisson, const double stretch[3]);
/* The same crystal of n x n x n cells with all its spheres (n >= 3); SIMPLE_CUBIC only. */
void scene_crystal(scene *s, int n, double R, double young, double poisson, const double stretch[3]);

/*
 * A crystal of n x n x n cubic cells with all its spheres, compressed by eps in every direction, with second neighbours of
 * BODY_CENTRED as candidates; every overlap is changed by up to noise R.  n >= 3.
 */
void scene_lattice(scene *s, lattice type, int n, double young, double poisson, double eps, double noise, rng *g);

/* A central sphere with count others at random directions at least apart from each other [rad], and walls where asked. */
void scene_cluster(scene *s, rng *g, int count, double apart);

/* A file of bench/data, with candidates up to a gap of reach (R_i + R_j) / 2 and reach R at walls: all pairs looked at. */
void scene_packing(scene *s, const char *name, double reach);

/*
 * Forces by long double: every coefficient from [GC] 5 with theta = atan2(|a x b|, a . b), no use of symmetry, plain
 * iteration until nothing changes.  factor multiplies the coefficients.  Returns the largest residual of [GC] 10, relative to
 * the largest force.
 */
long double scene_oracle(const scene *s, double factor, long double *force);

/* The parts of it: displacement w force[d] at contact c, count of them in arrays to be freed; and [GC] 9. */
void scene_terms(const scene *s, int64_t *count, int64_t **c, int64_t **d, long double **w);
long double scene_stiffness(const scene *s, int64_t c);

/* Largest |a - b| / largest force on either particle of the contact. */
double scene_error(const scene *s, const double *force, const long double *exact);

#endif
