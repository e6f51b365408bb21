/* SPDX-License-Identifier: BSD-2-Clause */
/* displace.c - from forces to surface displacements: particle by particle, window by window. */
#include "collective.h"
#include "contact.h"
#include "crowd.h"
#include "slabs.h"
#include "tree.h"

static double squared_distance(const double *normal, int64_t e, int64_t f)
{
    double s = 0;
    for (int x = 0; x < 3; x++) {
        double d = nlc_outward(e) * normal[3 * (e >> 1) + x] - nlc_outward(f) * normal[3 * (f >> 1) + x];
        s += d * d;
    }
    return s;
}

int64_t nlc_find_coincident(const nlc_network *n, const double *normal, int64_t particle)
{
    int64_t place;
    if (nlc_later_below(&place, n, normal, particle, nlc_pow2(-180))) return place < 0 ? -1 : n->entry[place] >> 1;
    for (int64_t p = n->start[particle]; p < n->start[particle + 1]; p++)
        for (int64_t q = n->start[particle]; q < p; q++)
            if (squared_distance(normal, n->entry[p], n->entry[q]) < nlc_pow2(-180)) return n->entry[p] >> 1;
    return -1;
}

/* The smaller of that and the squared distance of the two closest directions of a particle. */
static double closest(const nlc_network *n, const double *normal, int64_t k, double smallest)
{
    double least;
    if (nlc_least_apart(&least, n, normal, k, 0, 0, smallest)) return least;
    for (int64_t p = n->start[k]; p < n->start[k + 1]; p++)
        for (int64_t q = n->start[k]; q < p; q++) {
            const double s = squared_distance(normal, n->entry[p], n->entry[q]);
            smallest = s < smallest ? s : smallest;
        }
    return smallest;
}

/* Exponent above 1 / the distance between the two closest directions on any particle. */
static int closeness(const nlc_network *n, const double *normal)
{
    double smallest = 4;
    for (int64_t k = 0; k < n->owned; k++) smallest = closest(n, normal, k, smallest);
    return nlc_exponent_above(smallest) < -1022 ? 512 : 1 - nlc_exponent_above(smallest) / 2;
}

/* Whether no intermediate of a sweep of forces of up to top can overflow.  Exact closeness is looked at only where the bound from above fails. */
static bool in_range(const nlc_network *n, double top, const double *normal)
{
    const nlc_shape shape = n->settings.model->shape;
    const bool sphere = shape == NLC_SHAPE_MOMENTS || shape == NLC_SHAPE_POINT; /* 1/h^3, up to 2^450: sphere.h */
    int e = nlc_exponent_above(top) + n->coupling_exponent +
            nlc_exponent_above(n->unit) + nlc_exponent_above((double)n->contact_count) + 4;
    if (shape == NLC_SHAPE_PLACE) e += 10; /* a point that is nearly straight above another */
    if (shape == NLC_SHAPE_MOMENTS) e += 60; /* tilts and circles that are much too large */
    if (sphere) return e + 460 <= 1020 || e + 10 + 3 * closeness(n, normal) <= 1020;
    return e + 512 <= 1020 || e + closeness(n, normal) <= 1020;
}

/* Pairs of contacts on a particle; 0 if there are more than a block holds. */
static int64_t pairs_on(const nlc_network *n, int64_t particle)
{
    const int64_t count = n->start[particle + 1] - n->start[particle];
    return count > NLC_BLOCK ? 0 : count * (count - 1) / 2;
}

/* Numbers in the cache for a window. */
static int64_t kept_in(const nlc_network *n, int64_t window)
{
    const int64_t first = window * NLC_WINDOW, end = nlc_end_of(window, NLC_WINDOW, n->owned);
    const nlc_variant *variant = nlc_variant_of(n);
    int64_t sum = 0;
    if (variant) return variant->kept_in(n, first, end);
    for (int64_t k = first; k < end && n->settings.model->kept > 0; k++) sum += n->settings.model->kept * pairs_on(n, k);
    return sum;
}

int64_t nlc_count_kept(const nlc_network *n)
{
    int64_t sum = 0;
    for (int64_t w = 0; w < nlc_windows(n); w++) sum += kept_in(n, w);
    return sum;
}

static void lay_out_cache(nlc_network *n)
{
    int64_t sum = 0;
    for (int64_t w = 0; w < nlc_windows(n); w++) {
        n->kept_at[w] = sum;
        sum += n->settings.cache ? kept_in(n, w) : 0;
    }
}

/* What the windows of a sweep have in common. */
typedef struct job {
    nlc_network *n;
    nlc_response response;
    const double *force, *weighed, *normal;
} job;

/* The first particle with two contacts in the same direction, or -1.  The cache is filled by the particles in turn, as far as it goes. */
static int64_t displace_window(const job *s, int64_t first, int64_t end)
{
    nlc_network *n = s->n;
    const int per_pair = n->settings.model->kept;
    const int64_t room = n->settings.cache ? (int64_t)(n->settings.cache_size / sizeof(double)) : 0;
    int64_t at = n->kept_at[first / NLC_WINDOW];
    for (int64_t k = first; k < end; k++) {
        const int64_t wanted = per_pair * pairs_on(n, k);
        const bool fits = wanted > 0 && at + wanted <= room;
        if (nlc_is_crowd(n, k)) continue;
        if (!nlc_displace_kept(n, s->response, s->force, s->normal, k, fits ? n->settings.cache + at : NULL, fits && n->cached)) return k;
        at += wanted;
    }
    return -1;
}

const nlc_variant *nlc_variant_of(const nlc_network *n)
{
    return n->settings.model->within == nlc_case_one_within ? n->settings.variant : NULL;
}

static void displace_task(void *work, int64_t w)
{
    const job *s = work;
    const nlc_variant *variant = nlc_variant_of(s->n);
    const int64_t first = w * NLC_WINDOW, end = nlc_end_of(w, NLC_WINDOW, s->n->owned);
    s->n->piece[w].bad = variant ? variant->displace(s->n, s->force, s->weighed, s->normal, first, end) : displace_window(s, first, end);
}

/* The particles that windows leave out, one by one: there is room for one tree.  The first with two equal directions, or -1. */
static int64_t displace_crowds(nlc_network *n, nlc_response response, const double *force, const double *normal, bool weighed)
{
    for (int64_t k = 0; k < n->owned && n->most_contacts >= NLC_TREE_FROM; k++) {
        if (!nlc_is_crowd(n, k)) continue;
        if (weighed) n->norm[k] = INFINITY;
        if (!nlc_displace_kept(n, response, force, normal, k, NULL, false)) return k;
    }
    return -1;
}

static nlc_status displace(nlc_network *n, nlc_response response, const double *force, const double *weighed, const double *normal,
                           double top, int64_t *culprit)
{
    job all = {n, response, force, weighed, normal};
    int64_t bad = -1;
    *culprit = -1;
    if (n->settings.model->within && !in_range(n, top, normal)) return NLC_ERROR_RANGE;
    if (!n->cached) lay_out_cache(n);
    nlc_for(n, displace_task, &all, nlc_windows(n));
    for (int64_t w = 0; w < nlc_windows(n) && bad < 0; w++) bad = n->piece[w].bad;
    if (bad < 0) bad = displace_crowds(n, response, force, normal, weighed != NULL);
    n->cached = bad < 0;
    if (bad >= 0) *culprit = nlc_find_coincident(n, normal, bad);
    return bad >= 0 ? NLC_ERROR_COINCIDENT : NLC_OK;
}

/*
 * On ranks an error is that of the network when all of them know of it.  What a circle does to its own contact may be as large as its
 * particle in any units: an iteration looks at its sign and takes no square of it.
 */
static nlc_status exchange(nlc_network *n, nlc_response response, nlc_status status, int64_t culprit)
{
    const double most = n->ranks.most;
    if (!nlc_is_shared(n)) return status;
    if (status != NLC_OK) {
        nlc_fail(n, status, culprit);
        for (int64_t e = 0; e < 2 * n->contact_count; e++) n->side[e] = 0;
    }
    if (n->settings.model->self && response != NLC_OF_CHANGES) n->ranks.most = NLC_MOST;
    nlc_exchange_sides(n, n->side);
    n->ranks.most = most;
    return NLC_OK;
}

nlc_status nlc_displace(nlc_network *network, nlc_response response, const double *force, const double *normal, int64_t *culprit)
{
    const nlc_shape shape = network->settings.model->shape;
    if (response <= NLC_OF_STATE && (shape == NLC_SHAPE_MOMENTS || shape == NLC_SHAPE_RADIUS)) nlc_set_approach(network, force);
    const double top = network->settings.model->within ? nlc_top(network, force) : 0;
    const nlc_status status = displace(network, response, force, NULL, normal, top, culprit);
    return exchange(network, response, status, *culprit);
}

nlc_status nlc_displace_weighed(nlc_network *network, double top, const double *normal, int64_t *culprit)
{
    const nlc_status status = displace(network, NLC_OF_FORCES, network->force, network->share, normal, top, culprit);
    return exchange(network, NLC_OF_FORCES, status, *culprit);
}
