/* SPDX-License-Identifier: BSD-2-Clause */
/* displace_particle.c - surface displacements on one particle, from the forces on it. */
#include "contact.h"
#include "crowd.h"

/* Fills a block from a particle's list; returns the largest magnitude among the forces. */
static double gather(nlc_block *b, const nlc_network *n, nlc_response response, const double *force, const double *normal,
                     int64_t particle, int64_t begin, int64_t end)
{
    const double length = nlc_length_of(n, particle);
    double largest = 0;
    b->tilted = false;
    b->count = (int)(end - begin);
    for (int d = 0; d < b->count; d++) {
        const int64_t e = nlc_side_at(n, normal, begin + d);
        nlc_put_side(b, d, n, response, force, normal, e, particle, length);
        const double p = fabs(force[e >> 1]);
        largest = p > largest ? p : largest;
    }
    return largest;
}

/* The sides of a piece of a particle's list, whose block is a and is done. */
static void store(const nlc_block *a, nlc_network *n, nlc_response response, const double *force, const double *normal,
                  int64_t particle, int64_t begin)
{
    const double length = nlc_length_of(n, particle);
    for (int d = 0; d < a->count; d++) {
        const int64_t e = nlc_side_at(n, normal, begin + d);
        n->side[e] = a->displacement[d];
        if (n->settings.model->self) nlc_add_self(n, response, force, e, particle, length, a->tilt[d], a->second[d], a->third[d]);
    }
}

static void add(const nlc_block *b, nlc_network *n, const double *normal, int64_t begin)
{
    for (int d = 0; d < b->count; d++) n->side[nlc_side_at(n, normal, begin + d)] += b->displacement[d];
}

static int64_t block_end(int64_t begin, int64_t end)
{
    return end - begin > NLC_BLOCK ? begin + NLC_BLOCK : end;
}

/*
 * More contacts than a block holds: each block with itself and with those behind it.  Where there are more sums than displacements,
 * which alone have a place between blocks, it meets those before it, too, and all pairs are looked at twice.
 */
static bool displace_in_blocks(nlc_network *n, nlc_response response, const double *force, const double *normal,
                               int64_t particle, double *largest)
{
    const nlc_model *model = n->settings.model;
    const nlc_kernel *kernel = nlc_kernel_of(n, particle);
    const int64_t begin = n->start[particle], end = n->start[particle + 1];
    const bool once = !model->self;
    nlc_block a, b;
    bool distinct = true;
    for (int64_t p = begin; p < end && once; p++) n->side[n->entry[p]] = 0;
    for (int64_t p = begin; p < end; p += NLC_BLOCK) {
        const double f = gather(&a, n, response, force, normal, particle, p, block_end(p, end));
        *largest = f > *largest ? f : *largest;
        a.kept = NULL;
        a.known = false;
        distinct &= model->within(&a, kernel);
        for (int64_t q = once ? p + NLC_BLOCK : begin; q < end; q += NLC_BLOCK) {
            if (q == p) continue;
            gather(&b, n, response, force, normal, particle, q, block_end(q, end));
            distinct &= nlc_between(n, &a, &b, kernel);
            if (once) add(&b, n, normal, q);
        }
        if (once) add(&a, n, normal, p);
        else store(&a, n, response, force, normal, particle, p);
    }
    return distinct;
}

/* A side without displacement has just a largest force. */
static double largest_force(const nlc_network *n, const double *force, int64_t begin, int64_t end)
{
    double largest = 0;
    for (int64_t p = begin; p < end; p++) {
        const double f = fabs(force[n->entry[p] >> 1]);
        largest = f > largest ? f : largest;
    }
    return largest;
}

bool nlc_displace_kept(nlc_network *n, nlc_response response, const double *force, const double *normal, int64_t particle,
                       double *kept, bool known)
{
    const nlc_model *model = n->settings.model;
    const int64_t begin = n->start[particle], end = n->start[particle + 1];
    bool distinct = true;
    double largest = 0;
    if (!model->within || n->scale[particle] == 0) {
        for (int64_t p = begin; p < end; p++) n->side[n->entry[p]] = 0;
        largest = largest_force(n, force, begin, end);
    } else if (nlc_is_crowd(n, particle) && nlc_displace_crowd(n, response, force, normal, particle, &distinct)) {
        largest = largest_force(n, force, begin, end);
    } else if (end - begin > NLC_BLOCK) {
        distinct = displace_in_blocks(n, response, force, normal, particle, &largest);
    } else if (end > begin) {
        nlc_block a;
        largest = gather(&a, n, response, force, normal, particle, begin, end);
        a.kept = kept;
        a.known = known;
        distinct = model->within(&a, nlc_kernel_of(n, particle));
        store(&a, n, response, force, normal, particle, begin);
    }
    n->largest[particle] = largest;
    n->closest[particle] = 0;
    return distinct;
}

bool nlc_displace_particle(nlc_network *n, nlc_response response, const double *force, const double *normal, int64_t particle)
{
    return nlc_displace_kept(n, response, force, normal, particle, NULL, false);
}
