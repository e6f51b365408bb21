/* SPDX-License-Identifier: BSD-2-Clause */
/* tree.c - grows the tree. */
#include "tree.h"

#include "vector.h"

#define PER_CONTACT 8          /* doubles of room */
#define MOST_ROOM (1 << 20)    /* 8 MB; beyond, boxes grow with the number of directions */
#define FEWEST 16              /* boxes; where there is room for less, one has to do */
#define DEEPEST 100            /* cuts, so that the stack is bounded: directions closer than about 2^-50 stay in one box */

int64_t nlc_tree_room(int64_t contact_count)
{
    if (contact_count < NLC_TREE_FROM) return 0;
    const int64_t room = PER_CONTACT * (contact_count < MOST_ROOM ? contact_count : MOST_ROOM);
    return room < MOST_ROOM ? room : MOST_ROOM;
}

static int face_of(const double *d)
{
    const double x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return d[axis] < 0 ? axis + 3 : axis;
}

static double apart(const double *a, const double *b)
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(nlc_dot(d, d));
}

/* Rectangle and ball of a box whose directions are known. */
static void measure(const nlc_tree *t, nlc_box *box)
{
    double low[2] = {2, 2}, high[2] = {-2, -2}, d[3], e[3], uv[2];
    for (int64_t p = box->begin; p < box->end; p++) {
        nlc_direction_of(d, t->normal, nlc_ordered_side(t, p));
        nlc_picture_of(uv, d, box->face);
        for (int x = 0; x < 2; x++) {
            low[x] = uv[x] < low[x] ? uv[x] : low[x];
            high[x] = uv[x] > high[x] ? uv[x] : high[x];
        }
    }
    box->half_u = 0.5 * (high[0] - low[0]);
    box->half_v = 0.5 * (high[1] - low[1]);
    box->u = low[0] + box->half_u;
    box->v = low[1] + box->half_v;
    nlc_point_at(box->centre, box->face, box->u, box->v);
    nlc_point_at(d, box->face, high[0], box->v);
    nlc_point_at(e, box->face, box->u, high[1]);
    box->half = apart(d, box->centre) > apart(e, box->centre) ? apart(d, box->centre) : apart(e, box->centre);
    box->radius = 0;
    for (int corner = 0; corner < 4; corner++) {
        nlc_point_at(d, box->face, corner & 1 ? low[0] : high[0], corner & 2 ? low[1] : high[1]);
        const double r = apart(d, box->centre);
        box->radius = r > box->radius ? r : box->radius;
    }
}

static void swap(int32_t *order, int64_t p, int64_t q)
{
    const int32_t kept = order[p];
    order[p] = order[q];
    order[q] = kept;
}

/* Directions on one side of the cut to the front; returns where the others begin. */
static int64_t part(const nlc_tree *t, const nlc_box *box)
{
    const int x = box->half_u >= box->half_v ? 0 : 1;
    const double cut = x == 0 ? box->u : box->v;
    int64_t first = box->begin, end = box->end;
    double d[3], uv[2];
    while (first < end) {
        nlc_direction_of(d, t->normal, nlc_ordered_side(t, first));
        nlc_picture_of(uv, d, box->face);
        if (uv[x] <= cut) first++;
        else swap(t->n->order, first, --end);
    }
    return first;
}

static void add(nlc_tree *t, int64_t begin, int64_t end, int face, int depth)
{
    if (begin == end) return;
    nlc_box *box = &t->box[t->count++];
    *box = (nlc_box){.begin = begin, .end = end, .face = face, .depth = depth};
    measure(t, box);
}

static void look_at_lengths(nlc_tree *t, int64_t count)
{
    double d[3];
    for (int64_t p = 0; p < count; p++) {
        nlc_direction_of(d, t->normal, nlc_ordered_side(t, p));
        const double off = fabs(nlc_dot(d, d) - 1);
        t->longest = off > t->longest ? off : t->longest;
    }
}

/* The boxes of whole faces; one for all of them where that is enough. */
static void add_faces(nlc_tree *t, int64_t count, int64_t leaf)
{
    double d[3];
    int64_t begin = 0;
    for (int64_t p = 0; p < count; p++) t->n->order[p] = (int32_t)p;
    look_at_lengths(t, count);
    if (count <= leaf) {
        t->box[t->count++] = (nlc_box){.end = count, .radius = 2};
        return;
    }
    for (int face = 0; face < 6; face++) {
        int64_t end = begin;
        for (int64_t p = begin; p < count; p++) {
            nlc_direction_of(d, t->normal, nlc_ordered_side(t, p));
            if (face_of(d) == face) swap(t->n->order, p, end++);
        }
        add(t, begin, end, face, 0);
        begin = end;
    }
}

/* Cuts boxes, those that hold more of the directions first.  False: there is no room for all that are to be cut. */
static bool cut(nlc_tree *t, int64_t leaf, int64_t most)
{
    for (int64_t b = 0; b < t->count; b++) {
        nlc_box *box = &t->box[b];
        if (nlc_box_size(box) <= leaf || box->depth == DEEPEST) continue;
        if (t->count + 2 > most) return false;
        const int64_t middle = part(t, box);
        if (middle == box->end) continue; /* all in one place */
        box->child = t->count;
        add(t, box->begin, middle, box->face, box->depth + 1);
        add(t, middle, box->end, box->face, box->depth + 1);
    }
    return true;
}

bool nlc_grow_tree(nlc_tree *t, const nlc_network *n, const double *normal, int64_t particle, int64_t leaf, int64_t data,
                   int64_t values)
{
    const int64_t count = n->start[particle + 1] - n->start[particle], own = (int64_t)(sizeof(nlc_box) / sizeof(double));
    const int64_t most = (n->room_size - values * count) / (data + own);
    if (count > n->contact_count || values * count + own > n->room_size) return false;
    *t = (nlc_tree){.n = n, .normal = normal, .particle = particle, .values = n->room};
    t->box = (nlc_box *)(void *)(n->room + values * count);
    leaf = most < FEWEST ? count : leaf;
    do {
        t->count = 0;
        add_faces(t, count, leaf);
        leaf *= 2; /* fewer boxes, if there is no room for these */
    } while (!cut(t, leaf / 2, most));
    return true;
}
