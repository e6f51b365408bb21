/* SPDX-License-Identifier: BSD-2-Clause */
/* contacts.c - from LAMMPS' neighbour list to contacts and their network, and when to do that anew. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"
#include "tags.h"

#define NEIGHMASK 0x1FFFFFFF

/* All atoms, ghosts too, where LAMMPS keeps them. */
static nlc_particles atoms_of(const host *h)
{
    return (nlc_particles){.struct_size = sizeof(nlc_particles),
                           .count = h->seen.atoms,
                           .radius = lammps_extract_atom(h->lammps, "radius"),
                           .wall_count = h->set.walls};
}

static nlc_positions positions_of(const host *h, double **x)
{
    static double none[3];
    double *first = h->seen.atoms > 0 ? x[0] : none;
    return (nlc_positions){.struct_size = sizeof(nlc_positions),
                           .x = first,
                           .y = first + 1,
                           .z = first + 2,
                           .stride = 3 * sizeof(double),
                           .wall_point = h->wall_point,
                           .wall_normal = h->set.wall_normal};
}

/* ------------------------------------------------------------------------------------------------------ when to search -- */

static double distance2(const double *a, const double *b)
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

static bool stale_here(const host *h, const int32_t *tag, double **x, int32_t owned)
{
    const snapshot *s = &h->seen;
    const double far2 = h->set.slack * h->set.slack;
    if (!h->c.network || owned != s->owned || s->owned + lammps_extract_setting(h->lammps, "nghost") != s->atoms) return true;
    if (memcmp(tag, s->tag, (size_t)s->atoms * sizeof *tag) != 0) return true;
    /* Through a periodic boundary is far, too: then a ghost may be another image. */
    for (int32_t k = 0; k < s->atoms; k++)
        if (!(distance2(x[k], s->x + 3 * k) <= far2)) return true;
    for (int w = 0; w < h->set.walls; w++)
        if (!(distance2(h->wall_point + 3 * w, s->wall + 3 * w) <= far2)) return true;
    return false;
}

bool contacts_stale(host *h, const int32_t *tag, double **x, int32_t owned)
{
    int stale = stale_here(h, tag, x, owned);
    MPI_Allreduce(MPI_IN_PLACE, &stale, 1, MPI_INT, MPI_LOR, h->ranks.world);
    return stale;
}

static void take_snapshot(host *h, const int32_t *tag, double **x, int32_t owned)
{
    snapshot *s = &h->seen;
    s->owned = owned;
    s->atoms = owned + (int32_t)lammps_extract_setting(h->lammps, "nghost");
    if ((size_t)s->atoms > s->room) {
        s->room = (size_t)s->atoms + (size_t)s->atoms / 4;
        s->tag = host_room(s->tag, s->room * sizeof *s->tag);
        s->x = host_room(s->x, 3 * s->room * sizeof *s->x);
    }
    if (s->atoms > 0) {
        memcpy(s->tag, tag, (size_t)s->atoms * sizeof *tag);
        memcpy(s->x, x[0], 3 * (size_t)s->atoms * sizeof *s->x);
    }
    memcpy(s->wall, h->wall_point, sizeof s->wall);
}

/* ------------------------------------------------------------------------------------------------------------- search -- */

static void make_room(contacts *c, int64_t count)
{
    int32_t **const indices[] = {&c->i, &c->j, &c->atom_i, &c->atom_j};
    double **const values[] = {&c->stiffness, &c->overlap, &c->force, &c->hertz};
    if (count <= c->room) return;
    c->room = count + count / 8;
    for (int k = 0; k < 4; k++) *indices[k] = host_room(*indices[k], (size_t)c->room * sizeof(int32_t));
    for (int k = 0; k < 4; k++) *values[k] = host_room(*values[k], (size_t)c->room * sizeof(double));
    c->normal = host_room(c->normal, 3 * (size_t)c->room * sizeof(double));
}

/* The pairs in LAMMPS' list of the pair style zero that are near enough. */
static void read_list(host *h, double **x)
{
    const int list = lammps_find_pair_neighlist(h->lammps, "zero", 1, 0, 0);
    if (list < 0) host_fail("no neighbour list of pair style zero: use pair_style hybrid/overlay ... zero CUTOFF");
    const int rows = lammps_neighlist_num_elements(h->lammps, list);
    const size_t room = (size_t)h->seen.owned + 1;
    int32_t *whose = host_room(NULL, room * sizeof *whose), *length = host_room(NULL, room * sizeof *length);
    int32_t **neighbour = host_room(NULL, room * sizeof *neighbour);
    for (int k = 0; k < rows; k++) {
        int owner, count, *row;
        lammps_neighlist_element_neighbors(h->lammps, list, k, &owner, &count, &row);
        whose[k] = owner;
        length[owner] = count;
        neighbour[owner] = row;
    }
    const nlc_particles atoms = atoms_of(h);
    const nlc_positions positions = positions_of(h, x);
    const nlc_lists lists = {.struct_size = sizeof lists,
                             .count = rows,
                             .particle = whose,
                             .particle_count = h->seen.owned,
                             .length = length,
                             .neighbour = neighbour,
                             .mask = NEIGHMASK};
    nlc_info info = {.struct_size = sizeof info};
    const double reach = h->set.reach + 2 * h->set.slack;
    nlc_status status = nlc_contacts_from_lists(&h->c.count, NULL, NULL, 0, &atoms, &positions, &lists, reach, &info);
    host_check(status, &info, "neighbour list");
    make_room(&h->c, h->c.count);
    status =
        nlc_contacts_from_lists(&h->c.count, h->c.atom_i, h->c.atom_j, h->c.room, &atoms, &positions, &lists, reach, &info);
    host_check(status, &info, "neighbour list");
    free(whose);
    free(length);
    free(neighbour);
}

/*
 * Bodies from atoms: owned ones, ghosts of particles owned elsewhere once each, walls.  With newton off LAMMPS lists a pair
 * across a boundary from both sides: where both particles are owned here only one of them stays.
 */
static void name_bodies(host *h)
{
    contacts *c = &h->c;
    const snapshot *s = &h->seen;
    tags body = tags_new(s->atoms);
    int64_t kept = 0;
    h->ghosts = 0;
    h->ghost_atom = host_room(h->ghost_atom, (size_t)(s->atoms - s->owned) * sizeof *h->ghost_atom);
    for (int32_t k = 0; k < s->owned; k++) tags_put(&body, s->tag[k], k);
    for (int64_t k = 0; k < c->count; k++) {
        const int32_t a = c->atom_i[k], b = c->atom_j[k];
        if (b < s->atoms && tags_get(&body, s->tag[b]) < 0) {
            tags_put(&body, s->tag[b], s->owned + h->ghosts);
            h->ghost_atom[h->ghosts++] = b;
        }
        if (b < s->atoms && s->tag[a] == s->tag[b])
            host_fail("particle %d meets its own image: the box is too narrow", (int)s->tag[a]);
        if (b >= s->owned && b < s->atoms && s->tag[a] > s->tag[b] && tags_get(&body, s->tag[b]) < s->owned) continue;
        c->atom_i[kept] = c->i[kept] = a;
        c->atom_j[kept] = b;
        c->j[kept++] = b < s->atoms ? tags_get(&body, s->tag[b]) : -1;
    }
    c->count = kept;
    h->bodies = s->owned + h->ghosts;
    for (int64_t k = 0; k < kept; k++)
        if (c->j[k] < 0) c->j[k] = h->bodies + (c->atom_j[k] - s->atoms);
    tags_free(&body);
}

static uint64_t *name_contacts(const host *h)
{
    const contacts *c = &h->c;
    const snapshot *s = &h->seen;
    uint64_t *key = host_room(NULL, (size_t)c->room * sizeof *key);
    for (int64_t k = 0; k < c->count; k++) {
        const int32_t j = c->atom_j[k];
        const uint64_t a = (uint64_t)s->tag[c->atom_i[k]],
                       b = j < s->atoms ? (uint64_t)s->tag[j] : WALL_KEY + (uint64_t)(j - s->atoms);
        key[k] = a < b ? a << 32 | b : b << 32 | a;
    }
    return key;
}

/* -------------------------------------------------------------------------------------------------------------- ranks -- */

/* Who owns the ghosts, and which contacts are shared with whom; contacts that were known elsewhere join the old ones. */
static void share(host *h, const uint64_t *key, ranks_state **state, int64_t *states)
{
    const contacts *c = &h->c;
    const size_t ghosts = (size_t)h->ghosts, count = (size_t)c->count;
    int32_t *tag = host_room(NULL, ghosts * sizeof *tag), *owner = host_room(NULL, ghosts * sizeof *owner);
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
    free(tag);
    free(owner);
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
    take_snapshot(h, tag, x, owned);
    read_list(h, x);
    name_bodies(h);
    free(c->key);
    c->key = name_contacts(h);
    if (h->ranks.count > 1) share(h, c->key, &state, &states);
    carry_states(c, state, states);
    free(state);
    gather_bodies(h);
    build_network(h);
}

void contacts_update(host *h, double **x)
{
    const nlc_particles atoms = atoms_of(h);
    const nlc_positions positions = positions_of(h, x);
    contacts *c = &h->c;
    nlc_info info = {.struct_size = sizeof info};
    const nlc_status status =
        nlc_contacts_from_pairs(c->overlap, c->normal, &atoms, &positions, c->atom_i, c->atom_j, c->count, &info);
    host_check(status, &info, "overlaps");
}
