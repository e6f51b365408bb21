/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * vibration.h - a packing whose spheres move under their contact forces and nothing else: velocity Verlet, no damping, no gravity.
 *
 * Candidates are looked for anew whenever a sphere has moved so far that a pair which is not listed could have come nearer than
 * NEIGHBOURS_REACH, so that what is listed changes no force.
 */
#ifndef NLC_BENCH_VIBRATION_H
#define NLC_BENCH_VIBRATION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "neighbours.h"
#include "nlcontact.h"
#include "packing_io.h"

#define VIBRATION_DENSITY 2000.0 /* kg/m^3; another one changes nothing but the unit of time */

/* The forces of a step. */
typedef enum vibration_forces {
    VIBRATION_TURNING,   /* solved to the tolerance, with nlc_assemble_turning: all of -dE/dx */
    VIBRATION_CONVERGED, /* the same without it: along the normals, as [GC] and [MC] have them */
    VIBRATION_LAGGED,    /* displacements by the forces of the step before: one sweep a step */
    VIBRATION_HERTZ
} vibration_forces;

typedef struct vibration {
    packing p;
    neighbours n;
    nlc_options options;
    vibration_forces kind;
    double (*v)[3], (*F)[3], *mass, (*listed)[3]; /* velocities, forces, where the spheres were when listed */
    double *wall;                                 /* [walls][3] points, then [walls][3] normals */
    double *overlap, *normal, *force, *nonlocal, *previous, *stiffness, *w; /* of contacts */
    uint64_t *key;
    nlc_network *network;
    void *memory;
    bool started;           /* there are forces of a step before */
    int64_t steps, sweeps;  /* so far */
    int64_t lists, changes; /* lists made; contacts that have opened or closed */
    nlc_status status;      /* of the call that failed, or warnings met */
} vibration;

/*
 * vibration_open - the packing at rest.
 *
 * name    see packing_open
 * error   [error_size] out, on failure
 * Returns 0, or -1 on failure.  To be freed in any case.
 */
int vibration_open(vibration *s, const char *name, char *error, size_t error_size);
void vibration_free(vibration *s);

/* Other forces from here on; the first ones are found from nothing. */
int vibration_use(vibration *s, vibration_forces kind, int32_t model, double tolerance);

/* A step; -1 where the library reports an error: s->status. */
int vibration_step(vibration *s, double dt);

/* The energy now; the elastic one is that of converged forces, whatever forces move the spheres. */
int vibration_energy(vibration *s, double *kinetic, double *elastic);

/* The time step above which the fastest vibration would be unstable, from a bound of its frequency. */
int vibration_limit(vibration *s, double *dt);

/*
 * vibration_relax - lets the packing come to rest: all spheres stop whenever the kinetic energy has passed a maximum.
 *
 * balance   the mean resultant force on a sphere over the mean contact force at which it ends
 * Returns 0; -1 if a step fails, or after most steps.
 */
int vibration_relax(vibration *s, double dt, double balance, int64_t most);

/* Random velocities without a mean, the same every time. */
void vibration_kick(vibration *s, double kinetic);

/* Positions and velocities, [6 count]. */
void vibration_save(const vibration *s, double *state);
void vibration_restore(vibration *s, const double *state);

#endif
