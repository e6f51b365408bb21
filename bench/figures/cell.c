/* SPDX-License-Identifier: BSD-2-Clause */
/* cell.c - one sphere and what it touches. */
#include "cell.h"

#include <math.h>
#include <stdlib.h>

enum { NEWTON_STEPS = 60 };
static const double tolerance = 1e-10; /* of the forces, relative */

void cell_init(cell *c, double radius, double young, double poisson)
{
    *c = (cell){.radius = radius, .material = {{young, poisson}, {INFINITY, 0}}};
}

static void add(cell *c, double x, double y, double z, int32_t j, double overlap)
{
    const int k = c->contacts++;
    const double v[3] = {x, y, z};
    c->distance[k] = sqrt(x * x + y * y + z * z);
    for (int d = 0; d < 3; d++) c->normal[k][d] = v[d] / c->distance[k];
    c->j[k] = j;
    c->overlap[k] = overlap;
}

void cell_image(cell *c, double x, double y, double z)
{
    add(c, x, y, z, 0, 2 * c->radius - sqrt(x * x + y * y + z * z));
}

void cell_plate(cell *c, double x, double y, double z, double overlap)
{
    add(c, x, y, z, ++c->plates, overlap);
}

/* The network in memory of its own, to be freed; NULL if there is none. */
static void *build(const cell *c, int32_t model, nlc_network **network)
{
    int32_t rigid[CELL_CONTACTS];
    for (int k = 0; k < CELL_CONTACTS; k++) rigid[k] = 1;
    const nlc_particles particles = {.struct_size = sizeof particles,
                                     .count = 1,
                                     .radius = &c->radius,
                                     .materials = c->material,
                                     .material_count = 2,
                                     .material_size = sizeof(nlc_material),
                                     .wall_material = rigid,
                                     .wall_count = c->plates};
    const nlc_options options = {.struct_size = sizeof options, .model = model, .tolerance = tolerance};
    const size_t size = nlc_network_size(&particles, c->contacts, &options);
    void *memory = malloc(size ? size : 1);
    if (!memory || nlc_network_init(network, memory, size, &particles, c->i, c->j, c->contacts, &options, NULL) == NLC_OK)
        return memory;
    free(memory);
    return NULL;
}

nlc_status cell_solve(cell *c, int32_t model)
{
    nlc_network *network;
    void *memory = build(c, model, &network);
    if (!memory) return NLC_ERROR_NETWORK;
    const nlc_status status = nlc_solve(network, c->force, c->nonlocal, c->overlap, &c->normal[0][0], NULL);
    free(memory);
    return status;
}

static double stiffness(const cell *c, int k)
{
    const nlc_material *m = c->material;
    return c->j[k] ? nlc_hertz_stiffness(m->young, m->poisson, c->radius, INFINITY, 0, INFINITY)
                   : nlc_hertz_stiffness(m->young, m->poisson, c->radius, m->young, m->poisson, c->radius);
}

/* Nonlocal displacements of the forces, and by how much the overlaps miss [GC] 7; contacts open and close here. */
static bool residual(cell *c, nlc_network *network, double *miss)
{
    double displacement[CELL_CONTACTS][2] = {{0}};
    if (nlc_sweep(network, &displacement[0][0], c->force, c->overlap, &c->normal[0][0], NULL) != NLC_OK) return false;
    for (int k = 0; k < c->contacts; k++) {
        const double n = stiffness(c, k);
        c->nonlocal[k] = displacement[k][0] + displacement[k][1];
        const double x = c->overlap[k] + c->nonlocal[k];
        if (c->force[k] <= 0) c->force[k] = nlc_hertz_force(n, x);
        miss[k] = c->force[k] > 0 ? x - nlc_hertz_overlap(n, c->force[k]) : 0;
    }
    return true;
}

static bool stable(const cell *c, nlc_network *network)
{
    /* no symmetry: every mode has a part in it */
    static const double push[CELL_CONTACTS] = {1, -.37, .61, .23, -.83, .47, -.19, .71};
    double answer[CELL_CONTACTS];
    const nlc_status status = nlc_tangent(network, answer, push, c->force, &c->normal[0][0], NULL);
    return status >= 0;
}

/* A step of Newton's method; its largest change relative to the largest force, INFINITY if there is none. */
static double newton_step(cell *c, nlc_network *network)
{
    double miss[CELL_CONTACTS], change[CELL_CONTACTS], most = 0, largest = 0;
    if (!residual(c, network, miss)) return INFINITY;
    if (nlc_tangent(network, change, miss, c->force, &c->normal[0][0], NULL) < 0) return INFINITY;
    for (int k = 0; k < c->contacts; k++) {
        const double force = fmax(c->force[k] + change[k], 0);
        most = fmax(most, fabs(force - c->force[k]));
        largest = fmax(largest, force);
        c->force[k] = force;
    }
    return largest > 0 ? most / largest : 0;
}

bool cell_follow(cell *c, int32_t model)
{
    nlc_network *network;
    void *memory = build(c, model, &network);
    bool found = false;
    for (int step = 0; memory && step < NEWTON_STEPS && !found; step++) {
        const double change = newton_step(c, network);
        if (!(change < 1e3)) break;
        found = change < 1e-9;
    }
    double miss[CELL_CONTACTS];
    found = found && residual(c, network, miss) && stable(c, network);
    free(memory);
    return found;
}
