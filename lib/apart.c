/* SPDX-License-Identifier: BSD-2-Clause */
/* apart.c - how close directions, or circles around them, come on a particle with very many contacts: without all pairs. */
#include "tree.h"

#define LEAF 32
#define OFF 1e-6 /* by which two directions together may be off the unit sphere, on which boxes have their balls */

typedef struct search {
    nlc_tree tree; /* values: x, y, z and reach of each direction */
    double least;
    bool all;      /* all pairs below least are looked for, not the least of them ... */
    int32_t later; /* ... and of the later place of each the smallest */
} search;

static void note(search *s, int64_t p, int64_t q)
{
    const int32_t a = s->tree.n->order[p], b = s->tree.n->order[q], later = a > b ? a : b;
    s->later = later < s->later ? later : s->later;
}

/* Between direction p and those of a box up to an end. */
static void look(search *s, int64_t p, int64_t begin, int64_t end)
{
    const double *a = s->tree.values + 4 * p;
    for (int64_t q = begin; q < end; q++) {
        const double *b = s->tree.values + 4 * q, x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2], r = a[3] + b[3];
        const double excess = x * x + y * y + z * z - r * fabs(r); /* r < 0: nothing is there */
        if (excess >= s->least) continue;
        if (s->all) note(s, p, q);
        else s->least = excess;
    }
}

/* Whether two boxes may hold a pair that counts. */
static bool may_be_close(const search *s, const nlc_box *a, const nlc_box *b)
{
    const double x = a->centre[0] - b->centre[0], y = a->centre[1] - b->centre[1], z = a->centre[2] - b->centre[2];
    const double gap = sqrt(x * x + y * y + z * z) - a->radius - b->radius - OFF, r = a->most + b->most;
    return gap <= 0 || gap * gap - r * r < s->least;
}

static void visit(search *s, const nlc_box *a, const nlc_box *b)
{
    const nlc_box *box = s->tree.box;
    if (s->least < 0 || !may_be_close(s, a, b)) return;
    if (a->child == 0 && b->child == 0) {
        for (int64_t p = a->begin; p < a->end; p++) look(s, p, b->begin, b->end);
    } else if (b->child == 0 || (a->child != 0 && a->radius >= b->radius)) {
        visit(s, &box[a->child], b);
        visit(s, &box[a->child + 1], b);
    } else {
        visit(s, a, &box[b->child]);
        visit(s, a, &box[b->child + 1]);
    }
}

static void visit_within(search *s, const nlc_box *a)
{
    const nlc_box *child = &s->tree.box[a->child];
    if (a->child == 0) {
        for (int64_t p = a->begin; p < a->end && s->least >= 0; p++) look(s, p, a->begin, p);
        return;
    }
    visit_within(s, &child[0]);
    visit_within(s, &child[1]);
    visit(s, &child[0], &child[1]);
}

/* The largest reach in each box, children first. */
static void find_reaches(nlc_tree *t)
{
    for (nlc_box *box = t->box + t->count - 1; box >= t->box; box--) {
        if (box->child != 0) {
            const double a = t->box[box->child].most, b = t->box[box->child + 1].most;
            box->most = a > b ? a : b;
            continue;
        }
        for (int64_t p = box->begin; p < box->end; p++) {
            const double r = t->values[4 * p + 3];
            box->most = r > box->most ? r : box->most;
        }
    }
}

static bool begin(search *s, const nlc_network *n, const double *normal, int64_t particle, nlc_reach_of *reach,
                  const double *overlap)
{
    const int64_t count = n->start[particle + 1] - n->start[particle];
    nlc_tree *t = &s->tree;
    if (count < NLC_TREE_FROM || !nlc_grow_tree(t, n, normal, particle, LEAF, 0, 4)) return false;
    for (int64_t p = 0; p < count; p++) {
        const int64_t e = nlc_ordered_side(t, p);
        nlc_direction_of(t->values + 4 * p, normal, e);
        t->values[4 * p + 3] = reach ? reach(n, e >> 1, particle, overlap) : 0;
    }
    find_reaches(t);
    return true;
}

static void visit_all(search *s)
{
    const nlc_tree *t = &s->tree;
    for (const nlc_box *a = t->box; a < t->box + t->count && a->depth == 0; a++) {
        visit_within(s, a);
        for (const nlc_box *b = t->box; b < a; b++) visit(s, a, b);
    }
}

bool nlc_least_apart(double *least, const nlc_network *n, const double *normal, int64_t particle, nlc_reach_of *reach,
                     const double *overlap, double limit)
{
    search s = {.least = limit};
    if (!begin(&s, n, normal, particle, reach, overlap)) return false;
    visit_all(&s);
    *least = s.least;
    return true;
}

bool nlc_later_below(int64_t *place, const nlc_network *n, const double *normal, int64_t particle, double limit)
{
    search s = {.least = limit, .all = true, .later = INT32_MAX};
    if (!begin(&s, n, normal, particle, 0, 0)) return false;
    visit_all(&s);
    *place = s.later < INT32_MAX ? n->start[particle] + s.later : -1;
    return true;
}
