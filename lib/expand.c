/* SPDX-License-Identifier: BSD-2-Clause */
/* expand.c - from contacts to the grids of boxes, up and down the tree. */
#include "expand.h"

#include "contact.h"

/* Where something is between the sides of a box, -1 ... 1; in a box without extent it is in the middle. */
static double place_in(double at, double middle, double half)
{
    return (at - middle) / (half + 1e-300);
}

/* The polynomials in u and v of a box at a contact of it. */
static void weigh_contact(double *U, double *V, const nlc_crowd *w, const nlc_box *box, int64_t e)
{
    double d[3], uv[2];
    nlc_direction_of(d, w->tree.normal, e);
    nlc_picture_of(uv, d, box->face);
    nlc_interpolate(U, &w->grid, place_in(uv[0], box->u, box->half_u));
    nlc_interpolate(V, &w->grid, place_in(uv[1], box->v, box->half_v));
}

/* The sources of contacts, which are those of the box or of one of its children, to its grid. */
static void up_from_contacts(const nlc_crowd *w, const nlc_box *box, const nlc_box *from)
{
    double U[NLC_GRID_MOST], V[NLC_GRID_MOST];
    const int p = w->grid.p;
    nlc_block b;
    for (int64_t q = 0; q < nlc_box_size(from); q += NLC_BLOCK) {
        nlc_take_contacts(&b, w, from, q);
        for (int d = 0; d < b.count; d++) {
            const double source[NLC_CHANNELS] = {b.force[d], w->channels > 1 ? b.shape[d] : 0,
                                                 w->channels > 1 ? b.shape[d] * b.tilt[d] : 0};
            double *grid = nlc_sources_of(w, box);
            weigh_contact(U, V, w, box, nlc_ordered_side(&w->tree, from->begin + q + d));
            for (int channel = 0; channel < w->channels; channel++, grid += w->points)
                for (int i = 0; i < p; i++)
                    for (int j = 0; j < p; j++) grid[i * p + j] += source[channel] * U[i] * V[j];
        }
    }
}

static void down_to_contacts(const nlc_crowd *w, const nlc_box *box, const nlc_box *to)
{
    double U[NLC_GRID_MOST], V[NLC_GRID_MOST];
    const int p = w->grid.p;
    for (int64_t q = to->begin; q < to->end; q++) {
        const double *grid = nlc_sums_of(w, box);
        weigh_contact(U, V, w, box, nlc_ordered_side(&w->tree, q));
        for (int channel = 0; channel < w->channels; channel++, grid += w->points)
            for (int i = 0; i < p; i++) {
                double row = 0;
                for (int j = 0; j < p; j++) row += grid[i * p + j] * V[j];
                nlc_sums_at(w, q)[channel] += U[i] * row;
            }
    }
}

typedef double square[NLC_GRID_MOST][NLC_GRID_MOST];

/* [i][k]: polynomial k of the box at point i of its child. */
static void weigh_child(square U, square V, const nlc_crowd *w, const nlc_box *box, const nlc_box *child)
{
    for (int i = 0; i < w->grid.p; i++) {
        const double u = child->u + child->half_u * w->grid.x[i], v = child->v + child->half_v * w->grid.x[i];
        nlc_interpolate(U[i], &w->grid, place_in(u, box->u, box->half_u));
        nlc_interpolate(V[i], &w->grid, place_in(v, box->v, box->half_v));
    }
}

/* to += U^T from V */
static void up_from_grid(double *to, const double *from, square U, square V, int p)
{
    for (int i = 0; i < p; i++) {
        double row[NLC_GRID_MOST] = {0};
        for (int j = 0; j < p; j++)
            for (int l = 0; l < p; l++) row[l] += from[i * p + j] * V[j][l];
        for (int k = 0; k < p; k++)
            for (int l = 0; l < p; l++) to[k * p + l] += U[i][k] * row[l];
    }
}

/* to += U from V^T */
static void down_to_grid(double *to, const double *from, square U, square V, int p)
{
    for (int k = 0; k < p; k++) {
        double row[NLC_GRID_MOST] = {0};
        for (int j = 0; j < p; j++)
            for (int l = 0; l < p; l++) row[j] += from[k * p + l] * V[j][l];
        for (int i = 0; i < p; i++)
            for (int j = 0; j < p; j++) to[i * p + j] += U[i][k] * row[j];
    }
}

/* Between a box and a child of it, or its own contacts. */
static void go_up(const nlc_crowd *w, const nlc_box *box, const nlc_box *child)
{
    square U, V;
    if (child == box || !nlc_has_grid(w, child)) {
        up_from_contacts(w, box, child);
        return;
    }
    weigh_child(U, V, w, box, child);
    for (int c = 0; c < w->channels; c++)
        up_from_grid(nlc_sources_of(w, box) + c * w->points, nlc_sources_of(w, child) + c * w->points, U, V, w->grid.p);
}

static void go_down(const nlc_crowd *w, const nlc_box *box, const nlc_box *child)
{
    square U, V;
    if (child == box || !nlc_has_grid(w, child)) {
        down_to_contacts(w, box, child);
        return;
    }
    weigh_child(U, V, w, box, child);
    for (int c = 0; c < w->channels; c++)
        down_to_grid(nlc_sums_of(w, child) + c * w->points, nlc_sums_of(w, box) + c * w->points, U, V, w->grid.p);
}

void nlc_begin_crowd(nlc_crowd *w)
{
    const nlc_box *first = w->tree.box;
    const int64_t count = w->n->start[w->tree.particle + 1] - w->n->start[w->tree.particle];
    nlc_block b;
    for (int64_t k = 0; k < count * w->channels; k++) w->tree.values[k] = 0;
    for (const nlc_box *box = first + w->tree.count - 1; box >= first; box--) {
        if (!nlc_has_grid(w, box)) continue;
        for (int k = 0; k < 2 * w->channels * w->points; k++) nlc_sources_of(w, box)[k] = 0;
        go_up(w, box, box->child == 0 ? box : first + box->child);
        if (box->child != 0) go_up(w, box, first + box->child + 1);
    }
    for (const nlc_box *box = first; box < first + w->tree.count && w->channels > 1; box++)
        for (int64_t q = 0; q < nlc_box_size(box) && box->child == 0; q += NLC_BLOCK) {
            nlc_take_contacts(&b, w, box, q);
            w->tilted |= b.tilted;
        }
}

void nlc_end_crowd(nlc_crowd *w)
{
    const nlc_tree *t = &w->tree;
    const double length = nlc_length_of(w->n, t->particle);
    const int64_t count = w->n->start[t->particle + 1] - w->n->start[t->particle];
    for (const nlc_box *box = t->box; box < t->box + t->count; box++) {
        if (!nlc_has_grid(w, box)) continue;
        go_down(w, box, box->child == 0 ? box : t->box + box->child);
        if (box->child != 0) go_down(w, box, t->box + box->child + 1);
    }
    for (int64_t q = 0; q < count; q++) {
        const int64_t e = nlc_ordered_side(t, q);
        const double *sum = nlc_sums_at(w, q);
        w->n->side[e] = sum[0];
        if (w->channels > 1)
            nlc_add_self(w->n, w->response, w->force, e, t->particle, length, nlc_tilt(w->n, e, t->particle), sum[1], sum[2]);
    }
}
