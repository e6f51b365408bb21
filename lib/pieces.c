/* SPDX-License-Identifier: BSD-2-Clause */
/* pieces.c - the contacts of boxes, and the points of their grids, in blocks. */
#include "contact.h"
#include "expand.h"

static int least(int64_t left)
{
    return left < NLC_BLOCK ? (int)left : NLC_BLOCK;
}

void nlc_take_contacts(nlc_block *b, const nlc_crowd *w, const nlc_box *box, int64_t from)
{
    const double length = nlc_length_of(w->n, w->tree.particle);
    b->count = least(nlc_box_size(box) - from);
    b->tilted = false;
    for (int d = 0; d < b->count; d++) {
        const int64_t e = nlc_ordered_side(&w->tree, box->begin + from + d);
        nlc_put_side(b, d, w->n, w->response, w->force, w->tree.normal, e, w->tree.particle, length);
    }
}

void nlc_take_points(nlc_block *b, const nlc_crowd *w, const nlc_box *box, int64_t from)
{
    const double *source = nlc_sources_of(w, box) + from;
    const int p = w->grid.p;
    double at[3];
    b->count = least(w->points - from);
    b->tilted = false;
    for (int d = 0; d < b->count; d++) {
        const int i = ((int)from + d) / p, j = ((int)from + d) % p;
        nlc_point_at(at, box->face, box->u + box->half_u * w->grid.x[i], box->v + box->half_v * w->grid.x[j]);
        b->x[d] = at[0];
        b->y[d] = at[1];
        b->z[d] = at[2];
        b->force[d] = source[d];
        b->shape[d] = w->channels > 1 ? source[w->points + d] : 0;
        b->tilt[d] = w->channels > 1 ? source[2 * w->points + d] : 0;
        b->displacement[d] = b->second[d] = b->third[d] = 0;
    }
}

void nlc_give_contacts(const nlc_block *b, const nlc_crowd *w, const nlc_box *box, int64_t from)
{
    double *sum = nlc_sums_at(w, box->begin + from);
    for (int d = 0; d < b->count; d++, sum += w->channels) {
        sum[0] += b->displacement[d];
        if (w->channels == 1) continue;
        sum[1] += b->second[d];
        sum[2] += b->third[d];
    }
}

void nlc_give_points(const nlc_block *b, const nlc_crowd *w, const nlc_box *box, int64_t from)
{
    double *sum = nlc_sums_of(w, box) + from;
    for (int d = 0; d < b->count; d++) {
        sum[d] += b->displacement[d];
        if (w->channels == 1) continue;
        sum[w->points + d] += b->second[d];
        sum[2 * w->points + d] += b->third[d];
    }
}
