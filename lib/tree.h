/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * tree.h - a tree over the contact directions of a particle that has very many.
 *
 * Directions are sorted by the face of a cube that they pass through; there they have two coordinates, u and v: tan(angle/2) of
 * the two angles from the middle of the face.  A box is the smallest rectangle in u and v that holds its directions; if there are
 * too many it is cut in two across its longer side.  The tree depends on the directions only.  It lives in the network's memory, in
 * which there is room for one, and is grown anew for each use.
 */
#ifndef NLC_TREE_H
#define NLC_TREE_H

#include "network.h"

typedef struct nlc_box {
    int64_t begin, end;       /* its directions are network->order[begin] ... [end-1] */
    int64_t child;            /* the first of two boxes one behind the other; 0: none */
    int32_t face, depth;      /* face: axis that it is across, + 3 if on its negative side */
    double u, v, half_u, half_v; /* the middle, and half of the sides */
    double centre[3], radius; /* of a ball that holds the part of the unit sphere that the box is a picture of */
    double half;              /* of the longer side of that part */
    double most;              /* of whoever searches */
} nlc_box;

typedef struct nlc_tree {
    const nlc_network *n;
    const double *normal;
    int64_t particle, count; /* boxes; children come after their parent */
    nlc_box *box;
    double *values; /* as many as were asked for */
    double longest; /* largest | |n|^2 - 1 | */
} nlc_tree;

/* Contacts from which a network has memory for trees: on fewer of them all pairs are faster, at any tolerance. */
#define NLC_TREE_FROM 128

/* Doubles of network->room that a network of so many contacts has. */
int64_t nlc_tree_room(int64_t contact_count);

/*
 * Grows the tree: boxes with more than leaf directions are cut, as long as there is room for data doubles for each box, and for as
 * many values for each direction.  False: there is no room even for those.
 */
bool nlc_grow_tree(nlc_tree *tree, const nlc_network *network, const double *normal, int64_t particle, int64_t leaf, int64_t data,
                   int64_t values);

/*
 * apart.c: the least of |N_c - N_d|^2 - (r_c + r_d)^2 over all pairs of contacts of a particle, if it is below limit, else limit;
 * r is what reach says of a contact, NULL: 0.  A negative one may be any that is found first.  False: there is no room for a tree,
 * or too few contacts.
 */
typedef double nlc_reach_of(const nlc_network *network, int64_t contact, int64_t particle, const double *overlap);
bool nlc_least_apart(double *least, const nlc_network *network, const double *normal, int64_t particle, nlc_reach_of *reach,
                     const double *overlap, double limit);

/* Likewise: the first place in the adjacency whose side has an earlier one at a squared distance below limit; -1: none. */
bool nlc_later_below(int64_t *place, const nlc_network *network, const double *normal, int64_t particle, double limit);

/* The data of a box. */
static inline double *nlc_data_of(const nlc_tree *t, const nlc_box *box, int64_t data)
{
    return t->n->room + t->n->room_size - (box - t->box + 1) * data;
}

static inline int64_t nlc_box_size(const nlc_box *box)
{
    return box->end - box->begin;
}

/* A side by its place in network->order. */
static inline int64_t nlc_ordered_side(const nlc_tree *t, int64_t place)
{
    return nlc_side_at(t->n, t->normal, t->n->start[t->particle] + t->n->order[place]);
}

/* The outward direction of a side. */
static inline void nlc_direction_of(double d[3], const double *normal, int64_t e)
{
    for (int x = 0; x < 3; x++) d[x] = nlc_outward(e) * normal[3 * (e >> 1) + x];
}

/* The point of the unit sphere whose picture is (u, v). */
static inline void nlc_point_at(double d[3], int face, double u, double v)
{
    const int axis = face % 3;
    const double p = 1 - u * u, q = 1 - v * v, x = p * q, y = 2 * u * q, z = 2 * v * p, r = 1 / sqrt(x * x + y * y + z * z);
    const double from_axis[3] = {face < 3 ? r * x : -r * x, r * y, r * z};
    for (int k = 0; k < 3; k++) d[k] = from_axis[(k + 3 - axis) % 3];
}

/* The picture of a direction on a face. */
static inline void nlc_picture_of(double uv[2], const double *d, int face)
{
    const int axis = face % 3;
    const double x = fabs(d[axis]), y = d[(axis + 1) % 3], z = d[(axis + 2) % 3];
    uv[0] = y / (x + sqrt(x * x + y * y));
    uv[1] = z / (x + sqrt(x * x + z * z));
}

#endif
