/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * crowd.c - displacements on a particle with very many contacts, without looking at all pairs.
 *
 * Contacts that are near each other count pair by pair.  For two boxes of the tree that are further apart than they are large the
 * kernel is a smooth function of either end, and interpolated between the p x p points of Chebyshev's grids in both:
 *     K(x, y) = sum L_a(x) K(a, b) L_b(y)
 * A box's forces are thus replaced by forces at its grid points, made from those of its children, and the displacements there are
 * handed down to its children in the end (expand.c): the work on a pair of boxes does not grow with the number of their
 * contacts, and that on Z contacts like Z.  The same K(a, b) serves both directions, so that the coupling is symmetric to
 * rounding.  Boxes with fewer contacts than grid points take part contact by contact.
 *
 * The error is that of the interpolation and falls like ERROR^p.  Found at the p that tolerances from 1e-2 to 1e-12 ask for, in
 * units of the tolerance and relative to the sum of the absolute terms at the contact: at most 0.003 on contacts that are spread
 * evenly, 0.08 on others, 0.4 where they are heaped up towards a point to 2^-45 of the radius.  Grid points lie on the unit sphere,
 * so directions have to as well.
 */
#include "contact.h"
#include "expand.h"
#include "vector.h"

#define ERROR (1 / 6.) /* its p-th power is about the largest error */
#define PART 0.3       /* of the tolerance, that it may be */
#define FAR 2.7        /* distance of what a box is interpolated for from its centre, in units of half of its longer side */
#define LARGEST 0.6    /* radius, likewise: over a whole face directions are no smooth functions of u and v */
#define LEAF 2         /* contacts up to which a box is not cut, in units of grid points */
#define PAYS 450       /* contacts from which it pays, in units of p; within a third of the best on all processors tried */

/* Points along a side of the grids; 0: there are no such grids. */
static int side_of_grid(double tolerance)
{
    double error = 1;
    for (int p = 1; p <= NLC_GRID_MOST; p++) {
        error *= ERROR;
        if (p >= NLC_GRID_FEWEST && error <= PART * tolerance) return p;
    }
    return 0;
}

/* From the pieces of a box, its contacts or grid points, to blocks and back. */
static void take(nlc_block *b, const nlc_crowd *w, const nlc_box *box, bool grid, int64_t from)
{
    grid ? nlc_take_points(b, w, box, from) : nlc_take_contacts(b, w, box, from);
}

static void give(const nlc_block *b, const nlc_crowd *w, const nlc_box *box, bool grid, int64_t from)
{
    grid ? nlc_give_points(b, w, box, from) : nlc_give_contacts(b, w, box, from);
}

/* Where a grid is among them, products of shapes and tilts are what blocks have for tilts. */
static void multiply_tilts(nlc_block *b)
{
    for (int d = 0; d < b->count; d++) b->tilt[d] *= b->shape[d];
    b->tilted = false;
}

static void couple_blocks(nlc_crowd *w, nlc_block *s, nlc_block *t, bool grids)
{
    w->distinct &= nlc_between(w->n, s, t, w->kernel);
    if (grids && w->tilted) w->n->settings.model->tilt_between(s, t, w->kernel);
    w->n->evaluations += s->count * t->count;
}

/* Two boxes, each with its contacts or with its grid. */
static void couple(nlc_crowd *w, const nlc_box *a, bool grid_a, const nlc_box *b, bool grid_b)
{
    const int64_t rows = grid_a ? w->points : nlc_box_size(a), columns = grid_b ? w->points : nlc_box_size(b);
    const bool grids = grid_a || grid_b;
    nlc_block s, t;
    for (int64_t r = 0; r < rows; r += NLC_BLOCK) {
        take(&s, w, a, grid_a, r);
        if (grids && !grid_a && w->tilted) multiply_tilts(&s);
        for (int64_t c = 0; c < columns; c += NLC_BLOCK) {
            take(&t, w, b, grid_b, c);
            if (grids && !grid_b && w->tilted) multiply_tilts(&t);
            couple_blocks(w, &s, &t, grids);
            give(&t, w, b, grid_b, c);
        }
        give(&s, w, a, grid_a, r);
    }
}

/* All pairs of a box's own contacts. */
static void couple_within(nlc_crowd *w, const nlc_box *a)
{
    nlc_block s, t;
    for (int64_t r = 0; r < nlc_box_size(a); r += NLC_BLOCK) {
        nlc_take_contacts(&s, w, a, r);
        s.kept = NULL;
        s.known = false;
        w->distinct &= w->n->settings.model->within(&s, w->kernel);
        w->n->evaluations += s.count * (s.count - 1) / 2;
        for (int64_t c = r + NLC_BLOCK; c < nlc_box_size(a); c += NLC_BLOCK) {
            nlc_take_contacts(&t, w, a, c);
            couple_blocks(w, &s, &t, false);
            nlc_give_contacts(&t, w, a, c);
        }
        nlc_give_contacts(&s, w, a, r);
    }
}

/* Whether a box is far enough from another for its grid. */
static bool is_far(const nlc_crowd *w, const nlc_box *box, const nlc_box *other)
{
    const double *a = box->centre, *b = other->centre, d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    const double far = FAR * box->half + other->radius;
    return nlc_has_grid(w, box) && box->radius <= LARGEST && nlc_dot(d, d) >= far * far;
}

/* A box whose grid will not do gives way to its children or, where it has none, takes part contact by contact. */
static void visit(nlc_crowd *w, const nlc_box *a, const nlc_box *b)
{
    const bool grid_a = is_far(w, a, b), cut_a = !grid_a && a->child != 0;
    const bool grid_b = is_far(w, b, a), cut_b = !grid_b && b->child != 0;
    const nlc_box *child = w->tree.box + (cut_a && (!cut_b || a->radius >= b->radius) ? a->child : b->child);
    if (!cut_a && !cut_b) {
        couple(w, a, grid_a, b, grid_b);
    } else if (child == w->tree.box + b->child) {
        visit(w, a, &child[0]);
        visit(w, a, &child[1]);
    } else {
        visit(w, &child[0], b);
        visit(w, &child[1], b);
    }
}

static void visit_within(nlc_crowd *w, const nlc_box *a)
{
    const nlc_box *child = &w->tree.box[a->child];
    if (a->child == 0) {
        couple_within(w, a);
        return;
    }
    visit_within(w, &child[0]);
    visit_within(w, &child[1]);
    visit(w, &child[0], &child[1]);
}

static void visit_all(nlc_crowd *w)
{
    const nlc_box *box = w->tree.box;
    for (const nlc_box *a = box; a < box + w->tree.count && a->depth == 0; a++) {
        visit_within(w, a);
        for (const nlc_box *b = box; b < a; b++) visit(w, a, b);
    }
}

bool nlc_is_crowd(const nlc_network *n, int64_t particle)
{
    const int64_t count = n->start[particle + 1] - n->start[particle];
    const nlc_shape shape = n->settings.model->shape;
    if (count < NLC_TREE_FROM || n->scale[particle] <= 0 || !n->settings.model->within) return false;
    if (shape == NLC_SHAPE_RADIUS || shape == NLC_SHAPE_PLACE) return false;
    const int p = side_of_grid(n->settings.tolerance);
    return p > 0 && (count > PAYS * p || n->settings.model->self); /* of the latter, blocks would look at all pairs twice */
}

bool nlc_displace_crowd(nlc_network *n, nlc_response response, const double *force, const double *normal, int64_t particle,
                        bool *distinct)
{
    nlc_crowd w = {.n = n, .kernel = nlc_kernel_of(n, particle), .force = force, .response = response, .distinct = true};
    w.channels = n->settings.model->shape == NLC_SHAPE_MOMENTS ? 3 : 1;
    nlc_prepare_grid(&w.grid, side_of_grid(n->settings.tolerance));
    w.points = w.grid.p * w.grid.p;
    const int64_t data = 2 * w.channels * w.points;
    if (!nlc_grow_tree(&w.tree, n, normal, particle, LEAF * w.points, data, w.channels)) return false;
    if (w.tree.count > 1 && w.tree.longest > PART * n->settings.tolerance) return false;
    nlc_begin_crowd(&w);
    visit_all(&w);
    nlc_end_crowd(&w);
    *distinct = w.distinct;
    return true;
}
