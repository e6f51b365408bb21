/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * ranks.h - one network shared out among the ranks of an MPI program, the particles as LAMMPS distributes them.
 *
 * Particles are known by their tags.  Whenever contacts are looked for anew, the ranks find out who owns the ghosts among
 * their bodies: each tag has a home, rank tag % ranks, to which its owner reports and of which others ask.  After that only
 * pairs of ranks with contacts in common talk to each other, once a sweep.
 */
#ifndef NLC_LAMMPS_RANKS_H
#define NLC_LAMMPS_RANKS_H

#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>

#include "tags.h"

#define WALL_KEY UINT64_C(0xFFFFFF00) /* a wall in a contact's key: no particle's tag, which are below 2^31 */

/* A contact's key, the smaller number in the upper half, and what it carries along where its particle moves to another rank. */
typedef struct ranks_state {
    uint64_t key;
    double nonlocal, previous;
} ranks_state;

/* Sides to be sent to one rank, which are as many as it sends here, in the order of the contacts' keys. */
typedef struct ranks_peer {
    int rank;
    int64_t first, count;
} ranks_peer;

typedef struct ranks {
    MPI_Comm world;
    int rank, count;
    int32_t owned, *tag; /* [owned] as found last */
    tags here;           /* their numbers */
    int peers;
    ranks_peer *peer;
    int64_t straddling; /* contacts with a ghost */
    int64_t *contact;   /* [straddling] peer by peer */
    double *out, *in;   /* [straddling] */
    MPI_Request *request;
    int64_t exchanges, messages, sides, reductions, reduced; /* of this rank since the beginning; the last two in numbers */
} ranks;

void ranks_init(ranks *r, MPI_Comm world);
void ranks_free(ranks *r);

/*
 * Who owns what now.
 *
 * tag           [owned] of the bodies owned here
 * ghost_tag     [ghosts] of those that are not
 * ghost_owner   [ghosts] out: a rank; -1 where none has it
 * state         [states] of all contacts that were known here
 * arrivals      out: how many states of particles have come along with them
 * Returns these, to be freed.
 */
ranks_state *ranks_find(ranks *r, const int32_t *tag, int32_t owned, const int32_t *ghost_tag, int32_t *ghost_owner,
                        int32_t ghosts, const ranks_state *state, int64_t states, int64_t *arrivals);

/* Contact contact[k] of key[k] has a ghost of rank owner[k] as j.  Returns false if a key is there twice. */
bool ranks_plan(ranks *r, const int64_t *contact, const uint64_t *key, const int32_t *owner, int64_t count);

/* Forces on ghosts go to their owners and are added there.  F: [owned, then ghosts][3] in-out; those on ghosts stay as they are. */
void ranks_return(ranks *r, double *F, const int32_t *ghost_tag, const int32_t *ghost_owner, int32_t ghosts);

/* The callbacks of nlc_options; context is the ranks. */
int ranks_exchange(void *context, double *side);
int ranks_reduce(void *context, double *values, int32_t count, int32_t operation);

#endif
