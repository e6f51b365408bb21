/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * host.h - LAMMPS as the host of the library: what the files of nlc-lammps share.
 *
 *     nlc-lammps.c   the program: LAMMPS with a callback between its own forces and its integrator
 *     settings.c     LAMMPS variables -> options, materials, walls
 *     search.c       LAMMPS' neighbour list -> pairs, whenever that is needed
 *     contacts.c     pairs -> network; overlaps and normals
 *     ranks.c        who owns the others' particles, and what the ranks tell each other in a sweep
 *     mail.c, tags.c messages from any rank to any other; a table of particles' tags
 *     step.c         the callback: overlaps -> forces, and what is left for LAMMPS to show
 *     output.c       thermo, per-atom values and a file of contacts
 */
#ifndef NLC_LAMMPS_HOST_H
#define NLC_LAMMPS_HOST_H

#include <math.h>
#include <mpi.h>
#define LAMMPS_LIB_MPI
#include <lammps/library.h>
#include <nlcontact.h>
#include <stdbool.h>

#include "ranks.h"

#define FIX "nlc" /* the fix external that this program drives, and what its variables' names begin with */

enum { WALLS = 6, NAME = 64 };

/* From the script.  A wall is missing where its variable is. */
typedef struct settings {
    nlc_options options;
    double reach, slack; /* gaps that may close; how far a particle may go before they are looked for anew [m] */
    int64_t interval;    /* steps from one solve to the next */
    int64_t every;       /* steps between outputs that cost something; 0: never */
    bool predict, turning;
    char file[256];         /* of contacts, without step and ending; empty: none */
    nlc_material *material; /* [types + 2] by LAMMPS' type, the walls' behind them */
    int32_t types;
    int32_t walls, wall_material[WALLS];
    char wall_name[WALLS][NAME]; /* of the variable that says where it is */
    double wall_normal[3 * WALLS];
} settings;

/* Contacts and candidates of this step.  Bodies are numbered as the library wants them, atoms as LAMMPS does: ghosts too. */
typedef struct contacts {
    int64_t count, room;
    int32_t *i, *j;           /* bodies */
    int32_t *atom_i, *atom_j; /* atoms; walls come after all of them */
    uint64_t *key;            /* both tags, or tag and wall: lasting names */
    double *stiffness, *overlap, *normal, *force, *guess, *nonlocal, *previous;
    nlc_network *network;
    void *memory;
    size_t memory_room;
} contacts;

/* What the contacts were found for: they are good while nothing has moved far or changed its number. */
typedef struct snapshot {
    int32_t owned, atoms, *tag;
    size_t room;
    double *x, wall[3 * WALLS];
} snapshot;

typedef struct totals { /* summed over all ranks */
    double active, touching, force, hertz, pairs, virial[6], wall[WALLS];
} totals;

typedef struct clock_times {
    double geometry, solve, forces, rebuild, output;
    double missed, forces_sum; /* sum of |extrapolated - solved| and of the forces, where there is something to compare */
    int64_t steps, solves, rebuilds, sweeps, contacts, most_sweeps;
} clock_times;

typedef struct host {
    void *lammps;
    ranks ranks;
    settings set;
    snapshot seen;
    int32_t ghosts, bodies;     /* particles owned elsewhere, and all: owned ones, ghosts; walls follow */
    int32_t *ghost_atom, *ghost_tag, *ghost_owner; /* [ghosts] one of LAMMPS' ghosts of it; its rank */
    int32_t *type;              /* [bodies] */
    double *radius;             /* [bodies] */
    contacts c;
    totals sum;
    clock_times time;
    int64_t solved, span; /* step of the last solve, and how many after the one before */
    nlc_status status;    /* of the last solve */
    int warned;           /* warning bits that have been printed */
    double residual, needed_reach, wall_point[3 * WALLS];
} host;

/* Ends the program on all ranks. */
#if defined(__GNUC__)
__attribute__((noreturn, format(printf, 1, 2)))
#endif
void host_fail(const char *format, ...);
void host_check(nlc_status status, const nlc_info *info, const char *what); /* errors end the program */
void *host_room(void *old, size_t bytes);

/* Of a contact with a ghost each of the two ranks counts one half. */
static inline double host_share(const host *h, int64_t contact)
{
    return h->c.j[contact] >= h->seen.owned && h->c.j[contact] < h->bodies ? 0.5 : 1;
}

/* k x^(3/2), without the checks of nlc_hertz_force: where a step does nothing else for a contact these are most of it. */
static inline double host_law(double k, double x)
{
    x = x > 0 ? x : 0;
    return k * x * sqrt(x);
}

/* What LAMMPS' pair style and walls add. */
static inline double host_hertz(const contacts *c, int64_t k)
{
    return host_law(c->stiffness[k], c->overlap[k]);
}

void settings_read(host *h);
void settings_walls(host *h); /* where they are now */

nlc_particles search_atoms(const host *h); /* all that LAMMPS has here, ghosts too */
nlc_positions search_positions(const host *h, double **x);
bool search_is_stale(host *h, const int32_t *tag, double **x, int32_t owned);
void search_pairs(host *h, const int32_t *tag, double **x, int32_t owned);
void contacts_find(host *h, const int32_t *tag, double **x, int32_t owned);
void contacts_update(host *h, double **x); /* overlaps and normals */

void step_callback(void *host, int64_t step, int owned, int *tag, double **x, double **f);

enum { OUTPUT_LENGTH = 9 + WALLS };
void output_prepare(host *h);
void output_step(host *h, int64_t step, const nlc_info *info);
void output_times(const host *h);

#endif
