/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * order.c - in which order to number particles and contacts, so that what is used together lies together.
 *
 * Particles are taken in blobs, as many in each as a sweep looks at together: a blob grows breadth first from a neighbour of those
 * before.  Without blobs breadth first is shells, which are too wide for the caches.
 */
#include "network.h"
#include "parallel.h"
#include "structs.h"

typedef struct order {
    const nlc_network *n;
    int32_t *place;        /* [particles] numbers to be; -1: none yet */
    int64_t *other;        /* [2 contacts] the other body of each side, as entry */
    int64_t *at;           /* [particles] */
    int32_t *particle;     /* out */
    int64_t *contact;      /* out */
    int64_t count;         /* of particles that have their numbers, */
    int64_t closed, sides; /* of which these have no neighbour without one, nor has the next one on its first sides */
    int64_t first;         /* all below have one */
} order;

static bool is_without(const order *o, int64_t body)
{
    return body < o->n->owned && o->place[body] < 0;
}

static void give_number(order *o, int64_t k)
{
    o->place[k] = (int32_t)o->count;
    o->particle[o->count++] = (int32_t)k;
}

/* Where the next blob begins: at the first neighbour without a number of the particles in their order, or the first particle left. */
static int64_t seed(order *o)
{
    for (; o->closed < o->count; o->closed++, o->sides = 0) {
        const int64_t k = o->particle[o->closed];
        for (int64_t p = o->n->start[k] + o->sides; p < o->n->start[k + 1]; p++, o->sides++)
            if (is_without(o, o->other[p])) return o->other[p];
    }
    while (!is_without(o, o->first)) o->first++;
    return o->first;
}

/* From its first particle on, until it is full or nothing is left beside it. */
static void grow(order *o)
{
    const int64_t end = o->count - o->count % NLC_WINDOW + NLC_WINDOW;
    int64_t next = o->count;
    for (give_number(o, seed(o)); next < o->count; next++) {
        const int64_t k = o->particle[next];
        for (int64_t p = o->n->start[k]; p < o->n->start[k + 1]; p++) {
            if (!is_without(o, o->other[p])) continue;
            if (o->count == end) return;
            give_number(o, o->other[p]);
        }
    }
}

/* More contacts than a block holds are left to the end by a sweep. */
static int contacts_of(const order *o, int64_t k)
{
    const int64_t count = o->n->start[k + 1] - o->n->start[k];
    return count > NLC_BLOCK ? 0 : (int)count;
}

/* By falling number of contacts: that is how a sweep goes through them, see lanes.h. */
static void sort_blob(order *o, int64_t first, int64_t end)
{
    int at[NLC_BLOCK + 1] = {0}, sum = 0;
    int32_t sorted[NLC_WINDOW];
    for (int64_t m = first; m < end; m++) at[contacts_of(o, o->particle[m])]++;
    for (int z = NLC_BLOCK; z >= 0; z--) {
        const int count = at[z];
        at[z] = sum;
        sum += count;
    }
    for (int64_t m = first; m < end; m++) sorted[at[contacts_of(o, o->particle[m])]++] = o->particle[m];
    for (int64_t m = first; m < end; m++) {
        o->particle[m] = sorted[m - first];
        o->place[o->particle[m]] = (int32_t)m;
    }
}

static void order_particles(order *o)
{
    const nlc_network *n = o->n;
    for (int64_t k = 0; k < n->particle_count; k++) {
        o->place[k] = -1;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
            const int64_t e = n->entry[p];
            o->other[p] = e & 1 ? n->i[e >> 1] : n->j[e >> 1];
        }
    }
    while (o->count < n->owned) grow(o);
    for (int64_t w = 0; w < nlc_windows(n); w++) sort_blob(o, w * NLC_WINDOW, nlc_end_of(w, NLC_WINDOW, n->owned));
    for (int64_t m = 0; m < n->owned && n->owned < n->particle_count; m++) {
        const int64_t k = o->particle[m];
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++)
            if (o->other[p] < n->particle_count && o->place[o->other[p]] < 0) give_number(o, o->other[p]);
    }
    for (int64_t k = n->owned; k < n->particle_count; k++)
        if (o->place[k] < 0) give_number(o, k);
}

/* Walls keep theirs. */
static int64_t number_of(const order *o, int64_t body)
{
    return body < o->n->particle_count ? o->place[body] : body;
}

/*
 * Each contact goes to its particle with the lower number.  Those of one particle are in the order of the other's number, since that
 * is the order in which they are found.
 */
static void order_contacts(order *o)
{
    const nlc_network *n = o->n;
    int64_t sum = 0;
    for (int64_t m = 0; m < n->particle_count; m++) {
        const int64_t k = o->particle[m];
        o->at[m] = sum;
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
            const int64_t other = number_of(o, o->other[p]);
            sum += other > m || (other == m && !(n->entry[p] & 1));
        }
    }
    for (int64_t m = 0; m < n->particle_count; m++) {
        const int64_t k = o->particle[m];
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++) {
            const int64_t other = number_of(o, o->other[p]);
            if (other < m || (other == m && !(n->entry[p] & 1))) o->contact[o->at[other]++] = n->entry[p] >> 1;
        }
    }
    for (int64_t m = 0; m < n->particle_count && n->body_count > n->particle_count; m++) {
        const int64_t k = o->particle[m];
        for (int64_t p = n->start[k]; p < n->start[k + 1]; p++)
            if (o->other[p] >= n->particle_count) o->contact[o->at[m]++] = n->entry[p] >> 1;
    }
}

nlc_status nlc_order(nlc_network *network, int32_t *NLC_RESTRICT particle, int64_t *NLC_RESTRICT contact, nlc_info *info)
{
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    if (network->particle_count > 0 && !particle) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (network->contact_count > 0 && !contact) return nlc_error(info, NLC_ERROR_NULL, 2);
    /* the part is not in use between calls; where there is none this is other work space, see layout.c */
    order o = {.n = network, .place = network->place, .other = network->part->entry, .at = network->part->start,
               .particle = particle, .contact = contact};
    order_particles(&o);
    order_contacts(&o);
    return nlc_error(info, NLC_OK, -1);
}
