/* SPDX-License-Identifier: BSD-2-Clause */
/* contacts.c - from LAMMPS' neighbour list to contacts and their network, and when to do that anew. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"

#define NEIGHMASK 0x1FFFFFFF
#define WALL_KEY UINT64_C(0xFFFFFF00) /* no particle's number: LAMMPS' tags are below 2^31 */

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
    MPI_Allreduce(MPI_IN_PLACE, &stale, 1, MPI_INT, MPI_LOR, h->world);
    return stale;
}

static void take_snapshot(host *h, const int32_t *tag, double **x, int32_t owned)
{
    snapshot *s = &h->seen;
    s->owned = owned;
    s->atoms = owned + (int32_t)lammps_extract_setting(h->lammps, "nghost");
    if ((size_t)s->atoms > s->room) {
        s->room = (size_t)s->atoms + (size_t)s->atoms / 4;
        s->tag = host_room(h, s->tag, s->room * sizeof *s->tag);
        s->x = host_room(h, s->x, 3 * s->room * sizeof *s->x);
    }
    if (s->atoms > 0) {
        memcpy(s->tag, tag, (size_t)s->atoms * sizeof *tag);
        memcpy(s->x, x[0], 3 * (size_t)s->atoms * sizeof *s->x);
    }
    memcpy(s->wall, h->wall_point, sizeof s->wall);
}

/* ------------------------------------------------------------------------------------------------------------- search -- */

static void make_room(const host *h, contacts *c, int64_t count)
{
    int32_t **const indices[] = {&c->i, &c->j, &c->atom_i, &c->atom_j};
    double **const values[] = {&c->stiffness, &c->overlap, &c->force, &c->hertz};
    if (count <= c->room) return;
    c->room = count + count / 8;
    for (int k = 0; k < 4; k++) *indices[k] = host_room(h, *indices[k], (size_t)c->room * sizeof(int32_t));
    for (int k = 0; k < 4; k++) *values[k] = host_room(h, *values[k], (size_t)c->room * sizeof(double));
    c->normal = host_room(h, c->normal, 3 * (size_t)c->room * sizeof(double));
}

/* The pairs in LAMMPS' list of the pair style zero that are near enough. */
static void read_list(host *h, double **x)
{
    const int list = lammps_find_pair_neighlist(h->lammps, "zero", 1, 0, 0);
    if (list < 0) host_fail(h, "no neighbour list of pair style zero: use pair_style hybrid/overlay ... zero CUTOFF");
    const int rows = lammps_neighlist_num_elements(h->lammps, list);
    const size_t room = (size_t)h->seen.owned + 1;
    int32_t *whose = host_room(h, NULL, room * sizeof *whose), *length = host_room(h, NULL, room * sizeof *length);
    int32_t **neighbour = host_room(h, NULL, room * sizeof *neighbour);
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
    host_check(h, status, &info, "neighbour list");
    make_room(h, &h->c, h->c.count);
    status = nlc_contacts_from_lists(&h->c.count, h->c.atom_i, h->c.atom_j, h->c.room, &atoms, &positions, &lists, reach, &info);
    host_check(h, status, &info, "neighbour list");
    free(whose);
    free(length);
    free(neighbour);
}

/* Where each tag's owner is among the owned atoms: open addressing, -1 is empty. */
typedef struct directory {
    int32_t *slot;
    uint32_t mask;
} directory;

static uint32_t hash(int32_t tag)
{
    return (uint32_t)tag * UINT32_C(2654435769) >> 3;
}

static directory directory_of(const host *h)
{
    directory d = {NULL, 15};
    while (d.mask / 2 < (uint32_t)h->seen.owned) d.mask = 2 * d.mask + 1;
    d.slot = host_room(h, NULL, ((size_t)d.mask + 1) * sizeof *d.slot);
    memset(d.slot, -1, ((size_t)d.mask + 1) * sizeof *d.slot);
    for (int32_t k = 0; k < h->seen.owned; k++) {
        uint32_t at = hash(h->seen.tag[k]) & d.mask;
        while (d.slot[at] >= 0) at = (at + 1) & d.mask;
        d.slot[at] = k;
    }
    return d;
}

static int32_t owner_of(const directory *d, const snapshot *s, int32_t atom)
{
    uint32_t at = hash(s->tag[atom]) & d->mask;
    if (atom < s->owned) return atom;
    while (d->slot[at] >= 0 && s->tag[d->slot[at]] != s->tag[atom]) at = (at + 1) & d->mask;
    return d->slot[at];
}

/*
 * Bodies from atoms.  With newton off, LAMMPS lists a pair across a periodic boundary twice if both of its particles are owned
 * here, once from each side: only one of them stays.
 */
static void name_bodies(host *h)
{
    contacts *c = &h->c;
    const snapshot *s = &h->seen;
    const directory d = directory_of(h);
    int64_t kept = 0;
    for (int64_t k = 0; k < c->count; k++) {
        const int32_t a = c->atom_i[k], b = c->atom_j[k];
        const bool wall = b >= s->atoms;
        const int32_t body = wall ? s->owned + (b - s->atoms) : owner_of(&d, s, b);
        if (body < 0) host_fail(h, "particle %d is not on this rank", (int)s->tag[b]);
        if (!wall && b >= s->owned && s->tag[a] >= s->tag[b]) continue;
        c->atom_i[kept] = c->i[kept] = a;
        c->atom_j[kept] = b;
        c->j[kept++] = body;
    }
    c->count = kept;
    free(d.slot);
}

static void name_contacts(const host *h, uint64_t *key)
{
    const contacts *c = &h->c;
    const int32_t *tag = h->seen.tag;
    for (int64_t k = 0; k < c->count; k++) {
        const uint64_t a = (uint64_t)tag[c->atom_i[k]];
        const uint64_t b = c->atom_j[k] < h->seen.atoms ? (uint64_t)tag[c->atom_j[k]] : WALL_KEY + (uint64_t)(c->atom_j[k] - h->seen.atoms);
        key[k] = a < b ? a << 32 | b : b << 32 | a;
    }
}

/* ------------------------------------------------------------------------------------------------------------ network -- */

static void carry(const host *h, double **values, const uint64_t *key, const contacts *c, int64_t old_count)
{
    const size_t size = nlc_carry_size(c->count, old_count);
    void *memory = host_room(h, NULL, size);
    double *carried = host_room(h, NULL, (size_t)c->room * sizeof *carried);
    nlc_info info = {.struct_size = sizeof info};
    host_check(h, nlc_carry(carried, key, c->count, *values, c->key, old_count, memory, size, &info), &info, "nlc_carry");
    free(memory);
    free(*values);
    *values = carried;
}

static void build_network(host *h)
{
    contacts *c = &h->c;
    const settings *s = &h->set;
    const double *radius = lammps_extract_atom(h->lammps, "radius");
    const int32_t *type = lammps_extract_atom(h->lammps, "type");
    const nlc_particles particles = {.struct_size = sizeof particles,
                                     .count = h->seen.owned,
                                     .radius = radius,
                                     .material = type,
                                     .materials = s->material,
                                     .material_count = s->types + 2,
                                     .material_size = sizeof *s->material,
                                     .wall_material = s->wall_material,
                                     .wall_count = s->walls};
    const size_t size = nlc_network_size(&particles, c->count, &s->options);
    nlc_info info = {.struct_size = sizeof info};
    if (size > c->memory_room) {
        free(c->memory);
        c->memory = host_room(h, NULL, c->memory_room = size + size / 8);
    }
    const nlc_status status = nlc_network_init(&c->network, c->memory, c->memory_room, &particles, c->i, c->j, c->count, &s->options, &info);
    host_check(h, status, &info, "nlc_network_init");
    for (int64_t k = 0; k < c->count; k++) {
        const int32_t a = c->atom_i[k], b = c->atom_j[k];
        const bool wall = b >= h->seen.atoms;
        const nlc_material m = s->material[type[a]], n = s->material[wall ? s->types + 1 : type[b]];
        c->stiffness[k] = nlc_hertz_stiffness(m.young, m.poisson, radius[a], n.young, n.poisson, wall ? INFINITY : radius[b]);
    }
}

void contacts_find(host *h, const int32_t *tag, double **x, int32_t owned)
{
    contacts *c = &h->c;
    const int64_t old_count = c->count;
    take_snapshot(h, tag, x, owned);
    read_list(h, x);
    name_bodies(h);
    uint64_t *key = host_room(h, NULL, (size_t)c->room * sizeof *key);
    name_contacts(h, key);
    carry(h, &c->nonlocal, key, c, old_count);
    carry(h, &c->previous, key, c, old_count);
    free(c->key);
    c->key = key;
    build_network(h);
}

void contacts_update(host *h, double **x)
{
    const nlc_particles atoms = atoms_of(h);
    const nlc_positions positions = positions_of(h, x);
    contacts *c = &h->c;
    nlc_info info = {.struct_size = sizeof info};
    const nlc_status status = nlc_contacts_from_pairs(c->overlap, c->normal, &atoms, &positions, c->atom_i, c->atom_j, c->count, &info);
    host_check(h, status, &info, "overlaps");
}
