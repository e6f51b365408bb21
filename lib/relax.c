/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * relax.c - a start for scenes with contacts so close together that they push each other away by many times their overlap.
 *
 * Which of two such contacts stays open has to be settled before any method that changes all forces at once can find its way:
 * each contact in turn gets the force that the law has for the displacements at hand, and they follow at once (Gauss and
 * Seidel).  The functional whose stationary point is sought falls with each of these changes where it is convex.
 */
#include "collective.h"
#include "iteration.h"

#define PASSES 30
#define TOP 4.0   /* no overlap is larger, in the units of an iteration */
#define LEVELS 24 /* of overlaps, each half of the one before */
#define MOST 1000 /* contacts of a particle: a pass costs their square, and without it the solver needs a few sweeps more */
#define ENOUGH 0.1 /* largest change of a force in a pass, relative to the largest force there is */

static void put(nlc_block *b, const double *normal, int64_t e, double force)
{
    const int d = b->count++;
    nlc_set_direction(b, d, normal, e);
    b->force[d] = force;
    b->shape[d] = b->tilt[d] = b->displacement[d] = b->second[d] = b->third[d] = 0;
    b->tilted = false;
}

/* What a change of the force on side e does to the other contacts of its particle. */
static void spread(nlc_iteration *q, int64_t e, int64_t particle, double change)
{
    nlc_network *n = q->n;
    nlc_block a = {.count = 0}, b;
    int64_t entry[NLC_BLOCK], p = n->start[particle];
    const int64_t end = n->start[particle + 1];
    if (!(n->scale[particle] > 0)) return;
    put(&a, q->normal, e, nlc_scale_of(n, particle) * change);
    while (p < end) {
        b.count = 0;
        b.tilted = false; /* there may be none but e left */
        for (; p < end && b.count < NLC_BLOCK; p++) {
            if (n->entry[p] == e) continue;
            entry[b.count] = n->entry[p] >> 1;
            put(&b, q->normal, n->entry[p], 0);
        }
        n->settings.model->between(&a, &b, nlc_kernel_of(n, particle));
        for (int d = 0; d < b.count; d++) n->current[entry[d]] += b.displacement[d];
    }
}

static bool is_crowded(const nlc_network *n, int64_t body)
{
    return body < n->particle_count && n->start[body + 1] - n->start[body] > MOST;
}

/* Gives a contact a force; returns by how much it changed.  On crowded particles forces stay what they are. */
static double give(nlc_iteration *q, int64_t c, double force)
{
    nlc_network *n = q->n;
    const double change = force - n->force[c];
    const int first = n->i[c] < n->j[c] ? 0 : 1; /* whichever side is called i */
    if (nlc_abs_bits(change) == 0 || is_crowded(n, n->i[c]) || is_crowded(n, n->j[c])) return 0;
    n->force[c] = force;
    for (int k = 0; k < 2; k++) {
        const int side = k == 0 ? first : 1 - first;
        const int64_t body = side == 0 ? n->i[c] : n->j[c];
        if (body < n->particle_count) spread(q, 2 * c + side, body, change);
    }
    return fabs(change);
}

/* Those that are pushed away most begin anew, the largest overlaps first: these are the ones that should stay. */
static void begin_anew(nlc_iteration *q)
{
    nlc_network *n = q->n;
    double *repelled = n->slope;
    /* what is spread are point forces: where contacts have a size, what is there has other parts, and all begin anew */
    const bool all = !nlc_is_linear(n->settings.model->shape);
    for (int64_t c = 0; c < n->contact_count; c++) repelled[c] = all || n->current[c] < -NLC_REPELLED * nlc_overlap_nearby(q, c);
    for (int64_t c = 0; c < n->contact_count && all; c++)
        if (!is_crowded(n, n->i[c]) && !is_crowded(n, n->j[c])) n->force[c] = n->current[c] = 0;
    for (int64_t c = 0; c < n->contact_count; c++)
        if (repelled[c] > 0) give(q, c, 0);
    for (int level = 0; level < LEVELS; level++)
        for (int64_t c = 0; c < n->contact_count; c++) {
            const double x = q->overlap[c] * q->load, least = level < LEVELS - 1 ? nlc_pow2(-level) * TOP : 0;
            if (repelled[c] <= 0 || x <= least) continue;
            give(q, c, nlc_scaled_force(q, c));
            repelled[c] = 0;
        }
}

bool nlc_is_repelled(const nlc_iteration *q)
{
    for (int64_t c = 0; c < q->n->contact_count; c++)
        if (q->n->current[c] < -NLC_REPELLED * nlc_overlap_nearby(q, c)) return true;
    return false;
}

static void relax(nlc_iteration *q)
{
    nlc_network *n = q->n;
    begin_anew(q);
    for (int pass = 0; pass < PASSES; pass++) {
        double most = 0, largest = 0;
        for (int64_t c = 0; c < n->contact_count; c++) {
            const double change = give(q, c, nlc_scaled_force(q, c));
            most = change > most ? change : most;
            largest = n->force[c] > largest ? n->force[c] : largest;
        }
        if (most <= ENOUGH * largest) return;
    }
}

/*
 * Contacts on two ranks get the smaller one of the forces that both have found for them: a rank that has not the neighbour that pushes
 * a contact open gives it all the force that it would have without, and half of that is as far from the solution.
 */
void nlc_relax(nlc_iteration *q)
{
    nlc_network *n = q->n;
    relax(q);
    for (int64_t s = 0; s < n->straddling; s++) {
        const int64_t c = nlc_straddling(n)[s];
        n->side[2 * c] = n->side[2 * c + 1] = n->force[c];
    }
    nlc_exchange_sides(n, n->side);
    for (int64_t s = 0; s < n->straddling; s++) {
        const int64_t c = nlc_straddling(n)[s];
        const double a = n->side[2 * c], b = n->side[2 * c + 1], less = a < b ? a : b;
        n->force[c] = less > 0 ? less : 0; /* no owner has a negative one, which may be brought all the same */
    }
}
