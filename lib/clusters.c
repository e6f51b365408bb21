/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * clusters.c - contacts that depend on each other: joined by particles that yield.  A wall or a rigid particle passes nothing on.
 *
 * A forest over the particles: cluster[k] leads to the first particle of k's cluster, the one of the lowest number.
 */
#include "active.h"
#include "layout.h"

static int32_t first_of(int32_t *cluster, int32_t k)
{
    while (cluster[k] != k) k = cluster[k] = cluster[cluster[k]];
    return k;
}

static void join(nlc_network *n, int64_t c)
{
    if (!(nlc_yield_of(n, n->i[c]) > 0) || !(nlc_yield_of(n, n->j[c]) > 0)) return;
    const int32_t a = first_of(n->cluster, n->i[c]), b = first_of(n->cluster, n->j[c]);
    if (a < b) n->cluster[b] = a;
    else n->cluster[a] = b;
}

/* -1: both bodies are rigid or walls, which network_init refuses, or nothing is moved by the contact. */
static int32_t cluster_of(nlc_network *n, int64_t c)
{
    if (nlc_yield_of(n, n->i[c]) > 0) return first_of(n->cluster, n->i[c]);
    return nlc_yield_of(n, n->j[c]) > 0 ? first_of(n->cluster, n->j[c]) : -1;
}

static bool is_connected(nlc_network *n)
{
    int32_t only = -1;
    for (int64_t k = 0; k < n->particle_count; k++) n->cluster[k] = (int32_t)k;
    for (int64_t c = 0; c < n->contact_count; c++) join(n, c);
    for (int64_t c = 0; c < n->contact_count; c++) {
        const int32_t k = cluster_of(n, c);
        if (k < 0 || k == only) continue;
        if (only >= 0) return false;
        only = k;
    }
    return true;
}

void nlc_set_connected(nlc_network *n)
{
    n->connected = n->arrays & NLC_FOR_SOLVER && is_connected(n);
}

int64_t nlc_sort_clusters(nlc_network *n)
{
    int64_t *at = n->part->start, sum = 0; /* not in use before the part is built */
    for (int64_t k = 0; k < n->particle_count; k++) n->cluster[k] = (int32_t)k;
    for (int64_t k = 0; k <= n->particle_count; k++) at[k] = 0;
    for (int64_t c = 0; c < n->contact_count; c++)
        if (nlc_is_in(n, c)) join(n, c);
    for (int64_t c = 0; c < n->contact_count; c++)
        if (nlc_is_in(n, c)) at[cluster_of(n, c) + 1]++;
    for (int64_t k = 0; k <= n->particle_count; k++) at[k] = sum += at[k];
    for (int64_t c = 0; c < n->contact_count; c++)
        if (nlc_is_in(n, c)) n->origin[at[cluster_of(n, c)]++] = c;
    return sum;
}

int64_t nlc_cluster_end(nlc_network *n, int64_t begin, int64_t count)
{
    const int32_t cluster = cluster_of(n, n->origin[begin]);
    int64_t end = begin + 1;
    while (end < count && cluster_of(n, n->origin[end]) == cluster) end++;
    return end;
}
