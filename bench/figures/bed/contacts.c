/* SPDX-License-Identifier: BSD-2-Clause */
/* contacts.c - the library at work on the bed. */
#include "contacts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double margin = 15e-6;    /* of a list beyond what the displacements close now [m] */
static const double tolerance = 1e-10; /* of the forces */

static const int32_t rigid[BED_WALLS] = {BED_RIGID, BED_RIGID, BED_RIGID, BED_RIGID, BED_RIGID, BED_RIGID};
static const double inward[BED_WALLS][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
static const nlc_material rigid_material = {INFINITY, 0};

typedef struct scene {
    nlc_material materials[POWDERS + 1];
    double point[BED_WALLS][3];
    nlc_particles particles;
    nlc_positions positions;
} scene;

/* The bed as the library wants it: points into b and s. */
static void describe(scene *s, const bed *b)
{
    *s = (scene){.point = {[1] = {die_side, 0, 0}, [3] = {0, die_side, 0}, [BED_PUNCH] = {0, 0, b->height}}};
    for (int p = 0; p < POWDERS; p++) s->materials[p] = powders[p].material;
    s->materials[BED_RIGID] = rigid_material;
    s->particles = (nlc_particles){.struct_size = sizeof s->particles,
                                   .count = BED_SPHERES,
                                   .radius = b->radius,
                                   .material = b->material,
                                   .materials = s->materials,
                                   .material_count = POWDERS + 1,
                                   .material_size = sizeof(nlc_material),
                                   .wall_material = rigid,
                                   .wall_count = BED_WALLS};
    s->positions = (nlc_positions){.struct_size = sizeof s->positions,
                                   .x = &b->x[0][0],
                                   .y = &b->x[0][1],
                                   .z = &b->x[0][2],
                                   .stride = sizeof b->x[0],
                                   .wall_point = &s->point[0][0],
                                   .wall_normal = &inward[0][0]};
}

bool contacts_init(contacts *c, const bed *b, int32_t model)
{
    scene s;
    *c = (contacts){.model = model, .reach = -1};
    describe(&s, b);
    c->size = nlc_network_size(&s.particles, BED_CONTACTS, NULL);
    c->memory = malloc(c->size);
    for (int k = 0; k < BED_SPHERES; k++) {
        c->row[k] = c->other[k];
        for (int32_t n = k + 1; n < BED_SPHERES; n++) c->other[k][c->length[k]++] = n;
    }
    return c->memory != NULL;
}

void contacts_free(contacts *c)
{
    free(c->memory);
}

static void name_contacts(uint64_t *key, const contacts *c)
{
    for (int64_t k = 0; k < c->count; k++) key[k] = (uint64_t)c->i[k] * (BED_SPHERES + BED_WALLS) + (uint64_t)c->j[k];
}

/* All pairs within reach; nonlocal displacements are carried over to where a contact is in the new list. */
static nlc_status list_contacts(contacts *c, const scene *s, const bed *b)
{
    uint64_t old_key[BED_CONTACTS], key[BED_CONTACTS];
    double old[BED_CONTACTS];
    const nlc_lists lists = {.struct_size = sizeof lists, .count = BED_SPHERES, .particle_count = BED_SPHERES,
                             .length = c->length, .neighbour = c->row};
    const nlc_options options = {.struct_size = sizeof options, .model = c->model, .tolerance = tolerance};
    const int64_t old_count = c->count;
    name_contacts(old_key, c);
    memcpy(old, c->nonlocal, (size_t)old_count * sizeof *old);
    nlc_status status = nlc_contacts_from_lists(&c->count, c->i, c->j, BED_CONTACTS, &s->particles, &s->positions, &lists,
                                                c->reach, NULL);
    if (status < 0) return status;
    name_contacts(key, c);
    status = nlc_carry(c->nonlocal, key, c->count, old, old_key, old_count, c->memory, c->size, NULL);
    if (status < 0) return status;
    c->listed = *b;
    return nlc_network_init(&c->network, c->memory, c->size, &s->particles, c->i, c->j, c->count, &options, NULL);
}

/* By how much two bodies may have come closer to each other since the list was made. */
static double approach(const contacts *c, const bed *b)
{
    double most = 0;
    for (int k = 0; k < BED_SPHERES; k++) {
        double square = 0;
        for (int d = 0; d < 3; d++) square += pow(b->x[k][d] - c->listed.x[k][d], 2);
        most = fmax(most, sqrt(square));
    }
    return most + fmax(most, fabs(b->height - c->listed.height));
}

static nlc_status solve_listed(contacts *c, const scene *s)
{
    nlc_status status = nlc_contacts_from_pairs(c->overlap, &c->normal[0][0], &s->particles, &s->positions, c->i, c->j, c->count,
                                                NULL);
    if (status < 0) return status;
    c->status = nlc_solve(c->network, c->force, c->nonlocal, c->overlap, &c->normal[0][0], NULL);
    c->warned += c->status > 0;
    return c->status;
}

nlc_status contacts_solve(contacts *c, const bed *b)
{
    scene s;
    double needed;
    describe(&s, b);
    nlc_status status = NLC_OK;
    if (c->reach < 0) {
        c->reach = margin;
        status = list_contacts(c, &s, b);
    }
    for (;;) {
        if (status >= 0) status = solve_listed(c, &s);
        if (status >= 0) status = nlc_reach(c->network, &needed, NULL, c->force, NULL);
        if (status < 0) return status;
        if (needed + approach(c, b) <= c->reach) break;
        c->reach = needed + margin;
        status = list_contacts(c, &s, b);
    }
    memset(c->F, 0, sizeof c->F);
    memset(c->wall, 0, sizeof c->wall);
    return nlc_assemble(c->network, &c->F[0][0], 0, &c->wall[0][0], c->force, &c->normal[0][0], NULL);
}
