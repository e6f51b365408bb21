/* SPDX-License-Identifier: BSD-2-Clause */
/* expand.h - what crowd.c works with: forces and displacements at contacts and at the grid points of boxes. */
#ifndef NLC_EXPAND_H
#define NLC_EXPAND_H

#include "crowd.h"
#include "grid.h"
#include "tree.h"

/*
 * Of each contact and grid point there are as many sources as sums, channels: the force and the displacement, and with
 * NLC_SHAPE_MOMENTS the shape with the second sum, and tilt times shape with the third one.
 */
#define NLC_CHANNELS 3

typedef struct nlc_crowd {
    nlc_tree tree; /* values: the sums of contacts; data: sources and sums of grids, channel by channel */
    nlc_network *n;
    const nlc_kernel *kernel;
    const double *force;
    nlc_response response;
    nlc_grid grid;
    int channels, points; /* points: of a grid */
    bool distinct, tilted;
} nlc_crowd;

/* A box with fewer contacts needs no grid, nor does the only one. */
static inline bool nlc_has_grid(const nlc_crowd *w, const nlc_box *box)
{
    return w->tree.count > 1 && nlc_box_size(box) > w->points;
}

/* Of the points of a box's grid, and of the contact at a place of network->order. */
static inline double *nlc_sources_of(const nlc_crowd *w, const nlc_box *box)
{
    return nlc_data_of(&w->tree, box, 2 * w->channels * w->points);
}

static inline double *nlc_sums_of(const nlc_crowd *w, const nlc_box *box)
{
    return nlc_sources_of(w, box) + w->channels * w->points;
}

static inline double *nlc_sums_at(const nlc_crowd *w, int64_t place)
{
    return w->tree.values + place * w->channels;
}

/* Sources of the grids; all sums are 0. */
void nlc_begin_crowd(nlc_crowd *crowd);

/* From the sums of contacts and grids to network->side. */
void nlc_end_crowd(nlc_crowd *crowd);

/*
 * pieces.c: contacts of a box, or points of its grid, from one of them on, as many as a block holds.  The tilt of points is that
 * times the shape.
 */
void nlc_take_contacts(nlc_block *block, const nlc_crowd *crowd, const nlc_box *box, int64_t from);
void nlc_take_points(nlc_block *block, const nlc_crowd *crowd, const nlc_box *box, int64_t from);

/* Adds the block's sums to theirs. */
void nlc_give_contacts(const nlc_block *block, const nlc_crowd *crowd, const nlc_box *box, int64_t from);
void nlc_give_points(const nlc_block *block, const nlc_crowd *crowd, const nlc_box *box, int64_t from);

#endif
