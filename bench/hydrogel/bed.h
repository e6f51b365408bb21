/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * bed.h - a bed of spheres between walls, the last of which is a plate that moves: its particles follow Newton's law with the
 * library's forces, friction and drag.  README says what was chosen and why.
 */
#ifndef NLC_HYDROGEL_BED_H
#define NLC_HYDROGEL_BED_H

#include <stdbool.h>
#include <stdint.h>

#include "neighbours.h"
#include "nlcontact.h"
#include "packing_io.h"

enum { BED_WALLS = 6 };

typedef struct bed_settings {
    int32_t model;
    double prefactor;   /* of NLC_MODEL_HALF_SPACE */
    double tolerance;   /* of the forces, as in nlc_options */
    double friction;    /* mu */
    double slip_length; /* by which a contact has slid when its friction is saturated [m] */
    double density;     /* of the grains [kg/m^3] */
    double weight;      /* of a volume, in the fluid [N/m^3] */
    double drag;        /* rate at which velocities other than those of the mean deformation decay [1/s] */
    double step;        /* [s] */
} bed_settings;

typedef struct bed {
    bed_settings set;
    packing p;
    neighbours n; /* contacts and candidates: who; overlaps and normals are those below */
    nlc_network *network;
    void *memory;
    size_t memory_size, room;                                         /* of memory in bytes, of the arrays below in contacts */
    double (*v)[3], (*omega)[3], (*F)[3], (*torque)[3], (*listed)[3]; /* [particles]; where they were when n was made */
    double *mass, mean_radius, listed_height;
    double wall_point[BED_WALLS][3], wall_normal[BED_WALLS][3], wall_force[BED_WALLS][3];
    double *overlap, (*normal)[3], *force;        /* [contacts] */
    double *g, *previous, *side;                  /* nonlocal displacements: now, before; [contacts][2] */
    double (*slip)[3], (*sliding)[3], *saturated; /* friction / (mu P) */
    double *work, *carried;
    uint64_t *key, *old_key;
    double plate_speed;              /* > 0: up */
    bool fresh;                      /* the list is new: nothing to extrapolate from */
    int64_t steps, sweeps, warnings; /* of nlc_solve */
    char error[PACKING_ERROR_SIZE];
} bed;

/* A bed from a packing file, at rest.  Returns 0, or -1 and b->error; to be freed in both cases. */
int bed_open(bed *b, const char *path, const bed_settings *set);
void bed_free(bed *b);

/* Where the plate is [m]. */
double bed_height(const bed *b);

/* One step of time.  Returns 0, or -1 and b->error. */
int bed_step(bed *b);

#endif
