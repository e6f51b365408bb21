/* SPDX-License-Identifier: BSD-2-Clause */
/* network.c - building the network in the caller's memory. */
#include "network.h"

#include "active.h"
#include "bodies.h"
#include "collective.h"
#include "parallel.h"
#include "particles.h"
#include "structs.h"
#include "tree.h"

/* Takes count elements from the memory of which *used bytes are gone; *used becomes SIZE_MAX if that overflows. */
static void *take(char *memory, size_t *used, int64_t count, size_t size)
{
    size_t at = *used;
    if (at == SIZE_MAX || (uint64_t)count > (SIZE_MAX - 16 - at) / size) {
        *used = SIZE_MAX;
        return 0;
    }
    *used = at + (((size_t)count * size + 7) & ~(size_t)7);
    return memory ? memory + at : 0;
}

/* The part: arrays of its own for what it is, those of the whole for work. */
static void lay_out_part(nlc_network *n, char *memory, size_t *used)
{
    nlc_network p = *n;
    n->part = take(memory, used, 1, sizeof *n->part);
    n->mark = take(memory, used, n->contact_count, sizeof *n->mark);
    n->degree = take(memory, used, n->particle_count, sizeof *n->degree);
    n->cluster = take(memory, used, n->particle_count, sizeof *n->cluster);
    n->place = take(memory, used, n->body_count, sizeof *n->place);
    n->body = take(memory, used, n->body_count, sizeof *n->body);
    n->origin = take(memory, used, n->contact_count, sizeof *n->origin);
    n->part_overlap = take(memory, used, n->contact_count, sizeof *n->part_overlap);
    n->part_normal = take(memory, used, n->contact_count, 3 * sizeof *n->part_normal);
    p.kept_at = take(memory, used, nlc_windows(n), sizeof *p.kept_at);
    p.start = take(memory, used, n->particle_count + 1, sizeof *p.start);
    p.radius = take(memory, used, n->particle_count, sizeof *p.radius);
    p.scale = take(memory, used, n->particle_count, sizeof *p.scale);
    p.largest = take(memory, used, n->body_count, sizeof *p.largest);
    p.weakening = take(memory, used, n->particle_count, sizeof *p.weakening);
    p.material = take(memory, used, n->body_count, sizeof *p.material);
    p.i = take(memory, used, n->contact_count, sizeof *p.i);
    p.j = take(memory, used, n->contact_count, sizeof *p.j);
    p.stiffness = take(memory, used, n->contact_count, sizeof *p.stiffness);
    p.force = take(memory, used, n->contact_count, sizeof *p.force);
    p.current = take(memory, used, n->contact_count, sizeof *p.current);
    p.entry = take(memory, used, 2 * n->contact_count, sizeof *p.entry);
    p.side = take(memory, used, 2 * n->contact_count, sizeof *p.side);
    p.part = 0;
    if (memory) *n->part = p;
}

/* The arrays of a network at memory, or just their total size where memory is NULL; 0 if that overflows. */
static size_t lay_out(nlc_network *n, char *memory)
{
    size_t used = (sizeof *n + 7) & ~(size_t)7;
    if (n->contact_count > INT64_MAX / 2) return 0;
    n->start = take(memory, &used, n->particle_count + 1, sizeof *n->start);
    n->radius = take(memory, &used, n->particle_count, sizeof *n->radius);
    n->scale = take(memory, &used, n->particle_count, sizeof *n->scale);
    n->largest = take(memory, &used, n->body_count, sizeof *n->largest);
    n->kept_at = take(memory, &used, nlc_windows(n), sizeof *n->kept_at);
    n->piece = take(memory, &used, nlc_windows(n) > nlc_slabs(n) ? nlc_windows(n) : nlc_slabs(n), sizeof *n->piece);
    n->material = take(memory, &used, n->body_count, sizeof *n->material);
    n->materials = take(memory, &used, n->material_count, sizeof *n->materials);
    n->kernel = take(memory, &used, n->material_count, sizeof *n->kernel);
    n->i = take(memory, &used, n->contact_count, sizeof *n->i);
    n->j = take(memory, &used, n->contact_count, sizeof *n->j);
    n->stiffness = take(memory, &used, n->contact_count, sizeof *n->stiffness);
    n->force = take(memory, &used, n->contact_count, sizeof *n->force);
    n->current = take(memory, &used, n->contact_count, sizeof *n->current);
    n->floor = take(memory, &used, n->contact_count, sizeof *n->floor);
    n->slope = take(memory, &used, n->contact_count, sizeof *n->slope);
    n->approach = take(memory, &used, n->contact_count, sizeof *n->approach);
    n->own = take(memory, &used, 2 * n->contact_count, sizeof *n->own);
    for (int k = 0; k < 5; k++) n->spare[k] = take(memory, &used, n->contact_count, sizeof *n->spare[k]);
    for (int k = 0; k < 4; k++) n->lanczos[k] = take(memory, &used, n->contact_count, sizeof *n->lanczos[k]);
    for (int k = 0; k < NLC_DIRECTIONS; k++) n->direction[k] = take(memory, &used, n->contact_count, sizeof *n->direction[k]);
    for (int k = 0; k < NLC_DIRECTIONS; k++) n->image[k] = take(memory, &used, n->contact_count, sizeof *n->image[k]);
    n->share = take(memory, &used, 2 * n->contact_count, sizeof *n->share);
    n->bound = take(memory, &used, n->particle_count, sizeof *n->bound);
    n->norm = take(memory, &used, n->particle_count, sizeof *n->norm);
    n->growth = take(memory, &used, n->particle_count, sizeof *n->growth);
    n->weakening = take(memory, &used, n->particle_count, sizeof *n->weakening);
    n->closest = take(memory, &used, n->particle_count, sizeof *n->closest);
    n->changed = take(memory, &used, n->particle_count, sizeof *n->changed);
    n->room_size = nlc_tree_room(n->contact_count);
    n->order = take(memory, &used, n->room_size > 0 ? n->contact_count : 0, sizeof *n->order);
    n->room = take(memory, &used, n->room_size, sizeof *n->room);
    lay_out_part(n, memory, &used);
    n->entry = take(memory, &used, 2 * n->contact_count, sizeof *n->entry);
    n->side = take(memory, &used, 2 * n->contact_count, sizeof *n->side);
    return used > PTRDIFF_MAX ? 0 : used; /* no object is larger */
}

/* Counts and the size they lead to.  NLC_ERROR_COUNT where that overflows. */
static nlc_status measure(nlc_network *n, const nlc_particles *p, int64_t contact_count, size_t *size)
{
    memset(n, 0, sizeof *n);
    n->particle_count = n->owned = p->count;
    n->body_count = p->count + p->wall_count;
    n->contact_count = contact_count;
    n->material_count = p->material_count;
    if (contact_count < 0) return NLC_ERROR_COUNT;
    *size = lay_out(n, 0);
    return *size == 0 ? NLC_ERROR_COUNT : NLC_OK;
}

size_t nlc_network_size(const nlc_particles *particles, int64_t contact_count, const nlc_options *options)
{
    nlc_particles p;
    nlc_options o;
    nlc_network n;
    size_t size;
    if (!particles || nlc_read_counts(&p, particles) != NLC_OK || nlc_read_options(&o, options) != NLC_OK) return 0;
    return measure(&n, &p, contact_count, &size) == NLC_OK ? size : 0;
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

static double least_ratio(const nlc_network *n)
{
    double least = INFINITY, largest = 0;
    for (int64_t k = 0; k < n->particle_count; k++) {
        least = n->radius[k] < least ? n->radius[k] : least;
        largest = n->radius[k] > largest ? n->radius[k] : largest;
    }
    return !nlc_is_finite(largest) || !(largest > 0) ? 0 : least / largest;
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
    for (int64_t k = 0; k < n->body_count; k++) n->place[k] = -1;
    n->connected = nlc_is_connected(n);
    n->least_ratio = least_ratio(n);
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
    int64_t culprit;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!memory) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!particles) return nlc_error(info, NLC_ERROR_NULL, 3);
    if (contact_count > 0 && (!i || !j)) return nlc_error(info, NLC_ERROR_NULL, i ? 5 : 4);
    if ((status = nlc_read_counts(&p, particles)) != NLC_OK) return nlc_error(info, status, 3);
    if ((status = nlc_read_options(&o, options)) != NLC_OK) return nlc_error(info, status, 7);
    if ((status = measure(&n, &p, contact_count, &size)) != NLC_OK) return nlc_error(info, status, 6);
    if ((uintptr_t)memory % 8 != 0) return nlc_error(info, NLC_ERROR_ALIGNMENT, (int64_t)((uintptr_t)memory % 8));
    if (memory_size < size) return nlc_error(info, NLC_ERROR_MEMORY_SIZE, (int64_t)size);
    if ((status = check_all(&n, &settings, &p, i, j, &o, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);

    lay_out(&n, memory);
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
