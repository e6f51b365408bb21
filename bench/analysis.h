/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * analysis.h - the forces of a packing by one model, and what an author of a DEM wants to know about them.
 */
#ifndef NLC_BENCH_ANALYSIS_H
#define NLC_BENCH_ANALYSIS_H

#include <stddef.h>
#include <stdint.h>

#include "neighbours.h"
#include "nlcontact.h"
#include "packing_io.h"

typedef struct analysis {
    const char *model;        /* its name */
    double *force, *nonlocal; /* [contacts] as from nlc_solve */
    double *wall_force;       /* [walls] normal force on each wall, > 0 when pushed away from the particles [N] */
    nlc_status status;        /* of nlc_solve: NLC_OK or a warning */
    nlc_info info;            /* of nlc_solve */
    int64_t pairs, walls;     /* contacts with a force */
    int64_t created, lost;    /* overlap <= 0 but a force; overlap > 0 but none */
    double mean, largest;     /* of the contacts with a force [N] */
    double total;             /* sum of P over all contacts, walls included [N] */
    double imbalance;         /* mean magnitude of the resultant on a particle [N] */
    double stress[3][3];      /* (1/V) sum of b (x) P n, compression > 0, b as in neighbours_branch [Pa] */
    double build_time;        /* median of nlc_network_init [s] */
    double solve_time;        /* median of nlc_solve from zeros [s] */
    double sweep_time;        /* median of nlc_sweep [s] */
    int repetitions;
} analysis;

/*
 * analysis_run - solve and evaluate.
 *
 * a         out; to be freed with analysis_free, also after an error
 * options   model is replaced by that of the argument
 * error     [error_size] out, on failure
 * Returns 0; -1 if there is no memory or the library reports an error.
 */
int analysis_run(analysis *a, int32_t model, const nlc_options *options, const packing *p, const neighbours *n,
                 char *error, size_t error_size);

void analysis_free(analysis *a);

/* Puts a warning, with the contact that misses the tolerance most, into text [size]. */
void analysis_describe_warning(const analysis *a, const packing *p, const neighbours *n, char *text, size_t size);

#endif
