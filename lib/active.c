/* SPDX-License-Identifier: BSD-2-Clause */
/* active.c - the part of a network that a solution has to be found for. */
#include "active.h"

#include "contact.h"
#include "crowd.h"
#include "iteration.h"

#include <string.h>

static double largest_nearby(const nlc_network *n, int64_t c)
{
    const double a = n->largest[n->i[c]], b = n->largest[n->j[c]];
    return a > b ? a : b;
}

/* Whether a contact may be reached by the forces of what overlaps: there is an overlap on a body of it, or one contact away. */
static bool is_within_reach(const nlc_network *n, int64_t c)
{
    const int64_t i = n->i[c], j = n->j[c];
    return (i < n->particle_count && n->degree[i] > 0) || (j < n->particle_count && n->degree[j] > 0);
}

static void find_reach(nlc_network *n)
{
    for (int64_t k = 0; k < n->particle_count; k++) n->degree[k] = 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        if (!(largest_nearby(n, c) > 0)) continue;
        if (n->i[c] < n->particle_count) n->degree[n->i[c]] = 1;
        if (n->j[c] < n->particle_count) n->degree[n->j[c]] = 1;
    }
}

/* A marked contact is alone if neither of its sides is moved by another marked one or by itself.  Returns how many are not. */
static int64_t count_marks(nlc_network *n)
{
    int64_t count = 0;
    for (int64_t k = 0; k < n->particle_count; k++) n->degree[k] = 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        if (n->mark[c] == NLC_OUT) continue;
        if (nlc_yield_of(n, n->i[c]) > 0) n->degree[n->i[c]]++;
        if (nlc_yield_of(n, n->j[c]) > 0) n->degree[n->j[c]]++;
    }
    for (int64_t c = 0; c < n->contact_count; c++) {
        if (n->mark[c] == NLC_OUT) continue;
        const int32_t least = n->settings.model->self ? 0 : 1;
        const bool moved = (nlc_yield_of(n, n->i[c]) > 0 && n->degree[n->i[c]] > least) ||
                           (nlc_yield_of(n, n->j[c]) > 0 && n->degree[n->j[c]] > least);
        n->mark[c] = !moved ? NLC_ALONE : n->mark[c] == NLC_NEW ? NLC_NEW : NLC_IN;
        count += moved;
    }
    return count;
}

/*
 * A candidate whose displacement is known from the step before takes part if what is left of its gap is less than the largest
 * overlap nearby, or than the displacement.  One of which nothing is known (0) does in any case if there is an overlap on its
 * bodies, at a start from nothing also one contact away.  A matter of speed only: to be wrong costs another solution.
 */
int64_t nlc_mark_active(nlc_network *n, const double *overlap)
{
    const bool cold = nlc_largest_magnitude(n->current, n->contact_count) <= 0;
    if (cold) find_reach(n);
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double g = n->current[c], x = overlap[c] + g, top = largest_nearby(n, c), scale = top > g ? top : g;
        const bool unknown = nlc_abs_bits(g) == 0;
        /* one that touched without an overlap anywhere near comes with a start cut down to x = 0 (start.c) */
        const bool near = cold ? is_within_reach(n, c) : unknown ? top > 0 : x >= -scale;
        n->mark[c] = x > 0 || overlap[c] > 0 || near ? NLC_IN : NLC_OUT;
    }
    return count_marks(n);
}

/* The number of a wall in the part, -1 and downwards until that of the particles is known: n->body from its end. */
static int32_t place_of_wall(nlc_network *n, int64_t body)
{
    nlc_network *p = n->part;
    const int64_t walls = p->body_count, last = n->body_count - 1;
    const int32_t place = n->place[body];
    if (place >= 0 && place < walls && n->body[last - place] == body) return -1 - place;
    n->body[last - walls] = (int32_t)body;
    n->place[body] = (int32_t)walls;
    p->body_count++;
    return (int32_t)(-1 - walls);
}

/* The number of a body in the part, given out in the order of the contacts. */
static int32_t place_of(nlc_network *n, int64_t body)
{
    nlc_network *p = n->part;
    if (body >= n->particle_count) return place_of_wall(n, body);
    const int32_t place = n->place[body];
    if (place >= 0 && place < p->particle_count && n->body[place] == body) return place;
    const int64_t k = p->particle_count++;
    p->radius[k] = n->radius[body];
    p->material[k] = n->material[body];
    p->scale[k] = n->scale[body];
    n->body[k] = (int32_t)body;
    return n->place[body] = (int32_t)k;
}

static void add_contact(nlc_network *n, int64_t c, double overlap, const double *normal)
{
    nlc_network *p = n->part;
    const int64_t m = p->contact_count++;
    const int64_t first = n->i[c] < n->j[c] ? n->i[c] : n->j[c]; /* numbers do not depend on which one is called i */
    place_of(n, first);
    p->i[m] = place_of(n, n->i[c]);
    p->j[m] = place_of(n, n->j[c]);
    p->self_contacts |= p->i[m] == p->j[m];
    p->stiffness[m] = n->stiffness[c];
    p->current[m] = n->current[c];
    p->side[2 * m] = p->side[2 * m + 1] = 0;
    n->part_overlap[m] = overlap;
    memcpy(n->part_normal + 3 * m, normal, 3 * sizeof *normal);
}

void nlc_set_rest(nlc_network *n, const double *overlap)
{
    count_marks(n);
    for (int64_t k = 0; k < n->particle_count; k++) n->weakening[k] = 1;
    for (int64_t c = 0; c < n->contact_count; c++) {
        if (nlc_is_in(n, c)) continue;
        n->force[c] = n->mark[c] == NLC_ALONE ? nlc_law(n->stiffness[c], overlap[c]) : 0;
        n->current[c] = 0;
    }
}

void nlc_build_part(nlc_network *n, const int64_t *origin, int64_t count, const double *overlap, const double *normal)
{
    nlc_network *p = n->part;
    p->settings = n->settings;
    p->top = (nlc_tops){-1, -1, -1, -1};
    p->cached = n->cached = false; /* it is the same cache */
    p->stiffness_exponent = n->stiffness_exponent;
    p->least_ratio = n->least_ratio;
    p->coupling_exponent = n->coupling_exponent;
    p->particle_count = p->contact_count = p->body_count = 0;
    p->self_contacts = false;
    for (int64_t m = 0; m < count; m++) add_contact(n, origin[m], overlap[origin[m]], normal + 3 * origin[m]);
    for (int64_t m = 0; m < count; m++) { /* walls come behind the particles, whose number is known now */
        if (p->i[m] < 0) p->i[m] = (int32_t)p->particle_count - 1 - p->i[m];
        if (p->j[m] < 0) p->j[m] = (int32_t)p->particle_count - 1 - p->j[m];
    }
    for (int64_t w = 0; w < p->body_count; w++) {
        p->material[p->particle_count + w] = n->material[n->body[n->body_count - 1 - w]];
        p->largest[p->particle_count + w] = 0;
    }
    p->body_count += p->particle_count;
    p->owned = p->particle_count;
    nlc_build_adjacency(p);
}

void nlc_collect_part(nlc_network *n, const int64_t *origin)
{
    const nlc_network *p = n->part;
    for (int64_t m = 0; m < p->contact_count; m++) {
        const int64_t c = origin[m];
        n->current[c] = p->current[m];
        n->force[c] = nlc_law(n->stiffness[c], n->part_overlap[m] + p->current[m]);
        n->mark[c] = NLC_IN;
    }
    for (int64_t k = 0; k < p->particle_count; k++) n->weakening[n->body[k]] = p->weakening[k];
}

static void put(nlc_block *b, const nlc_network *n, const double *normal, int64_t e, int64_t particle)
{
    const nlc_shape shape = n->settings.model->shape;
    const bool circles = shape == NLC_SHAPE_MOMENTS || shape == NLC_SHAPE_RADIUS;
    const double t2 = circles ? nlc_circle2(n, e, particle) : 0;
    nlc_set_direction(b, b->count, normal, e);
    b->force[b->count] = nlc_scale_of(n, particle) * n->force[e >> 1];
    b->shape[b->count] = shape == NLC_SHAPE_RADIUS ? sqrt(t2) : b->force[b->count] * t2 / 10;
    b->tilt[b->count] = shape == NLC_SHAPE_MOMENTS ? nlc_tilt(n, e, particle) : 0;
    b->tilted |= fabs(b->tilt[b->count]) > NLC_NO_TILT;
    b->second[b->count] = b->third[b->count] = 0;
    b->displacement[b->count++] = 0;
}

/* The next sides of a particle, from *place on, that do (or do not) carry a force. */
static void take(nlc_block *b, int64_t *entry, const nlc_network *n, const double *normal, int64_t k, int64_t *place, bool force)
{
    const int64_t end = n->start[k + 1];
    b->tilted = false;
    b->count = 0;
    for (; *place < end && b->count < NLC_BLOCK; ++*place) {
        const int64_t e = nlc_side_at(n, normal, *place);
        if ((n->force[e >> 1] > 0) != force) continue;
        entry[b->count] = e;
        put(b, n, normal, e, k);
    }
}

/* Adds to the displacement of one particle's contacts without force. */
static bool move_rest(nlc_network *n, const double *normal, int64_t k)
{
    int64_t target[NLC_BLOCK], source[NLC_BLOCK], p = n->start[k];
    nlc_block a, b;
    bool distinct = true;
    if (nlc_is_crowd(n, k) && nlc_displace_crowd(n, NLC_OF_FORCES, n->force, normal, k, &distinct)) {
        for (; p < n->start[k + 1]; p++) {
            const int64_t e = n->entry[p];
            if (!(n->force[e >> 1] > 0)) n->current[e >> 1] += n->weakening[k] * n->side[e];
        }
        return distinct;
    }
    for (take(&b, target, n, normal, k, &p, false); b.count > 0; take(&b, target, n, normal, k, &p, false)) {
        int64_t q = n->start[k];
        for (take(&a, source, n, normal, k, &q, true); a.count > 0; take(&a, source, n, normal, k, &q, true))
            distinct &= n->settings.model->between(&a, &b, nlc_kernel_of(n, k));
        for (int d = 0; d < b.count; d++) n->current[target[d] >> 1] += n->weakening[k] * b.displacement[d];
    }
    return distinct;
}

static bool is_loaded(const nlc_network *n, int64_t k)
{
    bool loaded = false, idle = false;
    for (int64_t p = n->start[k]; p < n->start[k + 1] && !(loaded && idle); p++) {
        loaded |= n->force[n->entry[p] >> 1] > 0;
        idle |= !(n->force[n->entry[p] >> 1] > 0);
    }
    return loaded && idle;
}

/* The least force of a contact that has one: so that it is seen to, however much others are squeezed. */
#define LEAST 1e-300

static double force_in_unit(const nlc_iteration *q, int64_t c)
{
    const nlc_network *n = q->n;
    const double y = q->overlap[c] * q->load + n->current[c] * q->per_overlap;
    const double force = nlc_law(nlc_scaled_stiffness(q, c), y < NLC_FARTHEST ? y : NLC_FARTHEST);
    return force > LEAST ? force : LEAST;
}

/* In units of an iteration: in the caller's, what forces do may be out of range where sweeps have run out or coupling is weakened. */
int64_t nlc_check_rest(nlc_network *n, const double *overlap, const double *normal, int64_t *culprit)
{
    nlc_iteration q;
    int64_t touching = 0;
    nlc_iteration_units(&q, n, overlap, normal, 1);
    for (int64_t c = 0; c < n->contact_count; c++) {
        if (n->force[c] > 0) n->force[c] = force_in_unit(&q, c);
        else n->current[c] = 0;
    }
    if (!nlc_is_linear(n->settings.model->shape)) nlc_set_approach(n, n->force);
    for (int64_t k = 0; k < n->particle_count; k++) {
        if (n->degree[k] == 0 || !is_loaded(n, k) || move_rest(n, normal, k)) continue;
        *culprit = nlc_find_coincident(n, normal, k);
        return -1;
    }
    for (int64_t k = 0; k < n->particle_count; k++) n->changed[k] = 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        if (!(n->force[c] > 0)) n->current[c] = nlc_in_callers_unit(&q, c);
        if (n->mark[c] != NLC_OUT || overlap[c] + n->current[c] <= 0) continue;
        touching++;
        if (n->i[c] < n->particle_count) n->changed[n->i[c]] = 1;
        if (n->j[c] < n->particle_count) n->changed[n->j[c]] = 1;
    }
    for (int64_t c = 0; c < n->contact_count && touching > 0; c++) {
        const int64_t i = n->i[c], j = n->j[c];
        const bool beside = (i < n->particle_count && n->changed[i]) || (j < n->particle_count && n->changed[j]);
        if (n->mark[c] == NLC_OUT && beside && (overlap[c] + n->current[c] > 0 || largest_nearby(n, c) > 0)) n->mark[c] = NLC_NEW;
    }
    return touching;
}
