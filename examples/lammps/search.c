/* SPDX-License-Identifier: BSD-2-Clause */
/* search.c - from LAMMPS' neighbour list to pairs, named as bodies and by lasting keys, and when to do that anew. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"
#include "tags.h"

#define NEIGHMASK 0x1FFFFFFF

/* All atoms, ghosts too, where LAMMPS keeps them. */
nlc_particles search_atoms(const host *h)
{
    return (nlc_particles){.struct_size = sizeof(nlc_particles),
                           .count = h->seen.atoms,
                           .radius = lammps_extract_atom(h->lammps, "radius"),
                           .wall_count = h->set.walls};
}

nlc_positions search_positions(const host *h, double **x)
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

static void make_room(contacts *c, int64_t count)
{
    int32_t **const indices[] = {&c->i, &c->j, &c->atom_i, &c->atom_j};
    double **const values[] = {&c->stiffness, &c->overlap, &c->force, &c->guess};
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
    const nlc_particles atoms = search_atoms(h);
    const nlc_positions positions = search_positions(h, x);
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

void search_pairs(host *h, const int32_t *tag, double **x, int32_t owned)
{
    take_snapshot(h, tag, x, owned);
    read_list(h, x);
    name_bodies(h);
    free(h->c.key);
    h->c.key = name_contacts(h);
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

bool search_is_stale(host *h, const int32_t *tag, double **x, int32_t owned)
{
    int stale = stale_here(h, tag, x, owned);
    MPI_Allreduce(MPI_IN_PLACE, &stale, 1, MPI_INT, MPI_LOR, h->ranks.world);
    return stale;
}
