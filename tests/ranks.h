/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * ranks.h - a scene shared out among ranks, which are threads of this process.
 *
 * Their callbacks meet at a barrier and copy from each other.  They watch over the contract: all ranks call the same, in turn, with
 * the same counts.  Who breaks it ends the program.
 */
#ifndef NLC_TESTS_RANKS_H
#define NLC_TESTS_RANKS_H

#include <pthread.h>

#include "scene.h"

typedef struct ranks ranks;

typedef struct rank {
    ranks *all;
    int number;
    scene s;            /* its own particles, ghosts, walls; contacts in an order and with an i of its own */
    int64_t owned;
    int32_t *particle;  /* [s.particles] number in the whole */
    int64_t *contact;   /* [s.contacts] number in the whole */
    int *swapped;       /* [s.contacts] i and j are exchanged */
    int *peer;          /* [s.contacts] the other rank, -1: none */
    int64_t *there;     /* [s.contacts] the contact's number on the peer */
    double *values;     /* what it hands to a callback */
    int kind;           /* of callback: 0 exchange, 1 sums, 2 maxima */
    int32_t count, fixed[3]; /* of values in this call, in all of its kind */
    nlc_status status;
    nlc_info info;
    int64_t exchanges, sums, maxima; /* calls */
    int64_t fail_at, fail_too[2]; /* numbers of the calls that fail here, from 1; 0: none */
    int64_t odd_at;  /* number of the call that brings this number here, from all ghosts or as all values */
    double odd;
    double *displacement, *change, *stiffness, energy; /* other results: [2 contacts], [contacts], [particles] */
    double *turning; /* [particles][3], ghosts' too */
    void (*task)(struct rank *);
    pthread_t thread;
} rank;

struct ranks {
    int count;
    rank *rank;
    const scene *whole;
    pthread_barrier_t barrier;
};

/* owner [particles]: the rank of each. */
void ranks_init(ranks *w, const scene *whole, const int *owner, int count, rng *g);
void ranks_free(ranks *w);

/* On all ranks at the same time. */
void ranks_run(ranks *w, void (*task)(rank *));

/* Tasks: build the network; the collective functions.  The tangent is that of the overlaps. */
void rank_build(rank *r);
void rank_solve(rank *r);
void rank_sweep(rank *r);
void rank_energy(rank *r);
void rank_tangent(rank *r);
void rank_tangent_inverse(rank *r);
void rank_tangent_bound(rank *r);
void rank_turning(rank *r);

/* Calls of the callbacks in the last task. */
int64_t rank_calls(const rank *r);

#endif
