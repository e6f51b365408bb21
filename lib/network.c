/* SPDX-License-Identifier: BSD-2-Clause */
/* network.c - building the network in the caller's memory. */
#include "network.h"

#include "active.h"
#include "bodies.h"
#include "collective.h"
#include "layout.h"
#include "particles.h"
#include "structs.h"

/* Counts and the size they lead to with these options.  NLC_ERROR_COUNT where that overflows. */
static nlc_status measure(nlc_network *n, const nlc_particles *p, int64_t contact_count, const nlc_options *o, size_t *size)
{
    memset(n, 0, sizeof *n);
    n->particle_count = p->count;
    n->body_count = p->count + p->wall_count;
    n->contact_count = contact_count;
    n->material_count = p->material_count;
    if (contact_count < 0) return NLC_ERROR_COUNT;
    *size = nlc_lay_out(n, 0, nlc_arrays_for(o));
    return *size == 0 ? NLC_ERROR_COUNT : NLC_OK;
}

size_t nlc_network_size(const nlc_particles *particles, int64_t contact_count, const nlc_options *options)
{
    nlc_particles p;
    nlc_options o;
    nlc_network n;
    size_t size;
    if (!particles || nlc_read_counts(&p, particles) != NLC_OK || nlc_read_options(&o, options) != NLC_OK) return 0;
    return measure(&n, &p, contact_count, &o, &size) == NLC_OK ? size : 0;
}

void nlc_build_adjacency(nlc_network *n)
{
    memset(n->start, 0, (size_t)(n->particle_count + 1) * sizeof *n->start);
    for (int64_t c = 0; c < n->contact_count; c++) {
        if (n->i[c] < n->particle_count) n->start[n->i[c]]++;
        if (n->j[c] < n->particle_count) n->start[n->j[c]]++;
        if (n->i[c] == n->j[c]) n->self_contacts = true;
    }
    int64_t sum = 0;
    n->most_contacts = 0;
    for (int64_t k = 0; k < n->particle_count; k++) n->most_contacts = n->start[k] > n->most_contacts ? n->start[k] : n->most_contacts;
    for (int64_t k = 0; k <= n->particle_count; k++) n->start[k] = sum += n->start[k];
    /* start[k] is now the end of k's list: filled from behind it becomes its beginning */
    for (int64_t c = n->contact_count - 1; c >= 0; c--) {
        if (n->j[c] < n->particle_count) n->entry[--n->start[n->j[c]]] = 2 * c + 1;
        if (n->i[c] < n->particle_count) n->entry[--n->start[n->i[c]]] = 2 * c;
    }
}

static void build(nlc_network *n, const nlc_particles *p, const int32_t *i, const int32_t *j)
{
    nlc_set_bodies(n, p);
    if (n->contact_count > 0) {
        memcpy(n->i, i, (size_t)n->contact_count * sizeof *i);
        memcpy(n->j, j, (size_t)n->contact_count * sizeof *j);
        memset(n->side, 0, 2 * (size_t)n->contact_count * sizeof *n->side);
    }
    if (n->body_count > 0) memset(n->largest, 0, (size_t)n->body_count * sizeof *n->largest);
    nlc_build_adjacency(n);
    for (int64_t k = 0; k < n->body_count && n->arrays & NLC_FOR_SOLVER; k++) n->place[k] = -1;
    nlc_set_connected(n);
}

/* All that can be wrong with the arguments of nlc_network_init; nothing is written but *n, *settings and *culprit. */
static nlc_status check_all(nlc_network *n, nlc_settings *settings, const nlc_particles *p, const int32_t *i, const int32_t *j,
                            const nlc_options *o, int64_t *culprit)
{
    nlc_status status = nlc_read_settings(settings, o, culprit);
    if (status != NLC_OK) return status;
    if ((status = nlc_check_bodies(n, settings, p, i, j, o->stiffness, culprit)) != NLC_OK) return status;
    return nlc_check_ghosts(settings, p->count, i, j, n->contact_count, culprit);
}

nlc_status nlc_network_init(nlc_network **network, void *memory, size_t memory_size, const nlc_particles *particles,
                            const int32_t *NLC_RESTRICT i, const int32_t *NLC_RESTRICT j, int64_t contact_count,
                            const nlc_options *options, nlc_info *info)
{
    nlc_particles p;
    nlc_options o;
    nlc_network n;
    nlc_settings settings;
    nlc_status status;
    size_t size;
    int arrays;
    int64_t culprit;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!memory) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!particles) return nlc_error(info, NLC_ERROR_NULL, 3);
    if (contact_count > 0 && (!i || !j)) return nlc_error(info, NLC_ERROR_NULL, i ? 5 : 4);
    if ((status = nlc_read_counts(&p, particles)) != NLC_OK) return nlc_error(info, status, 3);
    if ((status = nlc_read_options(&o, options)) != NLC_OK) return nlc_error(info, status, 7);
    if ((status = measure(&n, &p, contact_count, &o, &size)) != NLC_OK) return nlc_error(info, status, 6);
    if ((uintptr_t)memory % 8 != 0) return nlc_error(info, NLC_ERROR_ALIGNMENT, (int64_t)((uintptr_t)memory % 8));
    n.memory_size = memory_size;
    if ((status = nlc_choose_arrays(&n, &o, &arrays, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
    if ((status = check_all(&n, &settings, &p, i, j, &o, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);

    nlc_lay_out(&n, memory, arrays);
    build(&n, &p, i, j);
    nlc_apply_settings(&n, &settings, o.stiffness);
    n.magic = NLC_NETWORK_MAGIC;
    memcpy(memory, &n, sizeof n);
    *network = memory;
    return nlc_error(info, NLC_OK, -1);
}

bool nlc_network_is_valid(const nlc_network *network)
{
    return (uintptr_t)network % 8 == 0 && network->magic == NLC_NETWORK_MAGIC;
}
