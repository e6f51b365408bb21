/* SPDX-License-Identifier: BSD-2-Clause */
/* contacts.c - from pairs to a network, on one rank or many, with what was known of its contacts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"

/* Who owns the ghosts, and which contacts are shared with whom; contacts that were known elsewhere join the old ones. */
static void share(host *h, const uint64_t *key, ranks_state **state, int64_t *states)
{
    const contacts *c = &h->c;
    const size_t ghosts = (size_t)h->ghosts, count = (size_t)c->count;
    h->ghost_tag = host_room(h->ghost_tag, ghosts * sizeof *h->ghost_tag);
    h->ghost_owner = host_room(h->ghost_owner, ghosts * sizeof *h->ghost_owner);
    int32_t *const tag = h->ghost_tag, *const owner = h->ghost_owner;
    int64_t arrivals, shared = 0, *contact = host_room(NULL, count * sizeof *contact);
    uint64_t *shared_key = host_room(NULL, count * sizeof *shared_key);
    int32_t *shared_owner = host_room(NULL, count * sizeof *shared_owner);
    for (int32_t k = 0; k < h->ghosts; k++) tag[k] = h->seen.tag[h->ghost_atom[k]];
    ranks_state *arrived = ranks_find(&h->ranks, h->seen.tag, h->seen.owned, tag, owner, h->ghosts, *state, *states, &arrivals);
    *state = host_room(*state, (size_t)(*states + arrivals) * sizeof **state);
    memcpy(*state + *states, arrived, (size_t)arrivals * sizeof *arrived);
    *states += arrivals;
    for (int64_t k = 0; k < c->count; k++) {
        const int32_t ghost = c->j[k] - h->seen.owned;
        if (ghost < 0 || ghost >= h->ghosts) continue;
        if (owner[ghost] < 0) host_fail("particle %d has no owner", (int)tag[ghost]);
        contact[shared] = k;
        shared_key[shared] = key[k];
        shared_owner[shared++] = owner[ghost];
    }
    if (!ranks_plan(&h->ranks, contact, shared_key, shared_owner, shared))
        host_fail("two images of a contact: the box is too narrow");
    free(contact);
    free(shared_key);
    free(shared_owner);
    free(arrived);
}

/* ------------------------------------------------------------------------------------------------------------ network -- */

static ranks_state *old_states(const contacts *c)
{
    ranks_state *state = host_room(NULL, (size_t)c->count * sizeof *state);
    for (int64_t k = 0; k < c->count; k++) state[k] = (ranks_state){c->key[k], c->nonlocal[k], c->previous[k]};
    return state;
}

/* The last step's values go to the contacts of the same key. */
static double *carry(const contacts *c, const double *old, const uint64_t *old_key, int64_t old_count)
{
    const size_t size = nlc_carry_size(c->count, old_count);
    void *memory = host_room(NULL, size);
    double *carried = host_room(NULL, (size_t)c->room * sizeof *carried);
    nlc_info info = {.struct_size = sizeof info};
    host_check(nlc_carry(carried, c->key, c->count, old, old_key, old_count, memory, size, &info), &info, "nlc_carry");
    free(memory);
    return carried;
}

static void carry_states(contacts *c, const ranks_state *state, int64_t states)
{
    uint64_t *key = host_room(NULL, (size_t)states * sizeof *key);
    double *old = host_room(NULL, (size_t)states * sizeof *old);
    for (int64_t k = 0; k < states; k++) key[k] = state[k].key;
    for (int64_t k = 0; k < states; k++) old[k] = state[k].nonlocal;
    free(c->nonlocal);
    c->nonlocal = carry(c, old, key, states);
    for (int64_t k = 0; k < states; k++) old[k] = state[k].previous;
    free(c->previous);
    c->previous = carry(c, old, key, states);
    free(key);
    free(old);
}

/* Radii and types of the bodies, one after the other. */
static void gather_bodies(host *h)
{
    const double *radius = lammps_extract_atom(h->lammps, "radius");
    const int32_t *type = lammps_extract_atom(h->lammps, "type");
    h->radius = host_room(h->radius, (size_t)h->bodies * sizeof *h->radius);
    h->type = host_room(h->type, (size_t)h->bodies * sizeof *h->type);
    for (int32_t k = 0; k < h->bodies; k++) {
        const int32_t atom = k < h->seen.owned ? k : h->ghost_atom[k - h->seen.owned];
        h->radius[k] = radius[atom];
        h->type[k] = type[atom];
    }
}

static void build_network(host *h)
{
    contacts *c = &h->c;
    settings *s = &h->set;
    const nlc_particles particles = {.struct_size = sizeof particles,
                                     .count = h->bodies,
                                     .radius = h->radius,
                                     .material = h->type,
                                     .materials = s->material,
                                     .material_count = s->types + 2,
                                     .material_size = sizeof *s->material,
                                     .wall_material = s->wall_material,
                                     .wall_count = s->walls};
    if (h->ranks.count > 1) {
        s->options.owned_particles = h->seen.owned;
        s->options.exchange = ranks_exchange;
        s->options.reduce = ranks_reduce;
        s->options.context = &h->ranks;
    }
    const size_t size = nlc_network_size(&particles, c->count, &s->options);
    nlc_info info = {.struct_size = sizeof info};
    if (size > c->memory_room) {
        free(c->memory);
        c->memory = host_room(NULL, c->memory_room = size + size / 8);
    }
    const nlc_status status =
        nlc_network_init(&c->network, c->memory, c->memory_room, &particles, c->i, c->j, c->count, &s->options, &info);
    host_check(status, &info, "nlc_network_init");
    for (int64_t k = 0; k < c->count; k++) {
        const int32_t a = c->i[k], b = c->j[k];
        const bool wall = b >= h->bodies;
        const nlc_material m = s->material[h->type[a]], n = s->material[wall ? s->types + 1 : h->type[b]];
        c->stiffness[k] =
            nlc_hertz_stiffness(m.young, m.poisson, h->radius[a], n.young, n.poisson, wall ? INFINITY : h->radius[b]);
    }
}

void contacts_find(host *h, const int32_t *tag, double **x, int32_t owned)
{
    contacts *c = &h->c;
    int64_t states = c->count;
    ranks_state *state = old_states(c);
    search_pairs(h, tag, x, owned);
    if (h->ranks.count > 1) share(h, c->key, &state, &states);
    carry_states(c, state, states);
    free(state);
    gather_bodies(h);
    build_network(h);
}

void contacts_update(host *h, double **x)
{
    const nlc_particles atoms = search_atoms(h);
    const nlc_positions positions = search_positions(h, x);
    contacts *c = &h->c;
    nlc_info info = {.struct_size = sizeof info};
    const nlc_status status =
        nlc_contacts_from_pairs(c->overlap, c->normal, &atoms, &positions, c->atom_i, c->atom_j, c->count, &info);
    host_check(status, &info, "overlaps");
}
