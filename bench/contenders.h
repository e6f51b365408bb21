/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * contenders.h - ways to find the forces of a time step: what each costs, and how wrong it is.
 *
 * Each makes some steps of a slow compression (compression.h), of which the last ones are timed and compared with the converged
 * solution.  What needs a history begins with that of the first two steps, with random errors as large as its tolerance, and has
 * some steps to forget it: errors that extrapolation lets grow do so for tens of steps before they count.
 */
#ifndef NLC_BENCH_CONTENDERS_H
#define NLC_BENCH_CONTENDERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "compression.h"
#include "nlcontact.h"
#include "runs.h"

typedef enum contender_kind {
    KIND_HERTZ,      /* no coupling */
    KIND_LAGGED,     /* forces from the displacements of the last step, so many sweeps of nlc_sweep for the next one */
    KIND_ALGORITHM1, /* algorithm1.h, from zeros until no displacement changes by more than tolerance times the largest one */
    KIND_SOLVE       /* nlc_solve */
} contender_kind;

typedef enum contender_start { START_ZEROS, START_LAST_STEP, START_PREDICTED } contender_start;

typedef struct contender {
    const char *key, *label;
    contender_kind kind;
    contender_start start; /* of nlc_solve */
    nlc_options options;   /* of nlc_solve; the tolerance is the point's */
    bool keeps;            /* coefficients, in options.cache */
} contender;

/* One point of the figure. */
typedef struct point {
    const contender *contender;
    double setting; /* tolerance, or number of sweeps; 0: there is nothing to set */
    int samples;    /* 0: it never got there */
    double sample[RUNS_MAX]; /* ns per contact and step: mean of a run's steps, of which some may need more sweeps than others */
    double seconds;          /* of the steps of the run going on */
    int steps;
    double largest, mean_square; /* errors of the forces, over all steps timed; see compression_error */
    double sweeps;               /* a step, on average */
    nlc_status status;           /* warnings of all steps; < 0: no forces */
} point;

enum { POINTS_MAX = 100 };

/* What a model's forces are compared with: displacements of the first two steps, forces of those timed. */
typedef struct converged {
    double *g[2], **force;
} converged;

typedef struct contest {
    compression path;
    int first_timed, points, runs; /* runs made */
    int first_from_zeros;          /* what needs no history is timed in fewer steps */
    point point[POINTS_MAX];
    double *force, *g, *previous, *w; /* [contacts]; w [contacts][2] */
    converged exact[2]; /* of NLC_MODEL_GONZALEZ_CUITINO, of NLC_MODEL_SPHERE */
    void *cache;
} contest;

/*
 * contest_run - time all contenders on a packing.
 *
 * name      see packing_open
 * quick     one step, few tolerances
 * error     [error_size] out, on failure
 * Large packings get fewer tolerances and steps, and the sphere little or none.
 * Returns 0, or -1 on failure.  To be freed in any case.
 */
int contest_run(contest *c, const char *name, bool quick, char *error, size_t error_size);
void contest_free(contest *c);

#endif
