/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * program.c - a program of the days of 0.1.  It is compiled with the header recorded beside it and linked with today's library:
 * it must run, see the structs that it knows, and find what it found.
 *
 * Two rubber grains between two rigid plates, as in the README.  Each struct that the library writes to stands in a guarded room.
 */
#include "nlcontact.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CONTACTS = 5, GUARD = 256 };

#define DEMAND(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "a program of 0.1, line %d: %s\n", __LINE__, #condition); \
            exit(1); \
        } \
    } while (0)

static const double R = 0.01, step = 1e-3;
static const int32_t i[CONTACTS] = {0, 0, 1, 1, 0}, j[CONTACTS] = {2, 3, 2, 3, 1};
static double overlap[CONTACTS], normal[3 * CONTACTS], force[CONTACTS], nonlocal[CONTACTS];

static struct {
    nlc_info info;
    unsigned char guard[GUARD];
} room;

/* Whether a call came to this end and wrote to the info that 0.1 knows, and no further. */
static int ends(nlc_status found, nlc_status status)
{
    for (int k = 0; k < GUARD; k++)
        if (room.guard[k] != 0xa5) return 0;
    return found == status && room.info.struct_size == sizeof(nlc_info) && (status < 0 || room.info.culprit == -1);
}

static nlc_info *new_info(void)
{
    memset(&room, 0xa5, sizeof room);
    room.info.struct_size = sizeof(nlc_info);
    return &room.info;
}

static int near(double a, double b)
{
    return fabs(a - b) <= 1e-6 * fabs(b);
}

int main(void)
{
    const nlc_material materials[2] = {{1.85e6, 0.46}, {INFINITY, 0}};
    const double radius[2] = {R, R}, x[2] = {0, 2 * R}, y[2] = {0, 0}, z[2] = {0, 0};
    const double wall_point[6] = {0, 0, step - R, 0, 0, R - step}, wall_normal[6] = {0, 0, 1, 0, 0, -1};
    const int32_t rigid[2] = {1, 1};
    nlc_particles particles;
    nlc_positions positions;
    nlc_lists lists;
    nlc_options options;
    nlc_model_record record;
    memset(&particles, 0, sizeof particles);
    memset(&positions, 0, sizeof positions);
    memset(&lists, 0, sizeof lists);
    memset(&options, 0, sizeof options);
    memset(&record, 0, sizeof record);
    particles.struct_size = sizeof particles;
    particles.count = 2;
    particles.radius = radius;
    particles.materials = materials;
    particles.material_count = 2;
    particles.material_size = sizeof *materials;
    particles.wall_material = rigid;
    particles.wall_count = 2;
    positions.struct_size = sizeof positions;
    positions.x = x;
    positions.y = y;
    positions.z = z;
    positions.wall_point = wall_point;
    positions.wall_normal = wall_normal;

    /* scalar functions and names */
    DEMAND(nlc_hertz_force(3, 4) == 24);
    DEMAND(near(nlc_hertz_stiffness(1.85e6, 0.46, R, INFINITY, 0, INFINITY), 4. / 3 * 1.85e6 / (1 - 0.46 * 0.46) * sqrt(R)));
    DEMAND(strcmp(nlc_strerror(NLC_ERROR_NORMAL), "a contact normal is not finite or not of unit length") == 0);
    DEMAND(nlc_model_count() >= 6 && nlc_model_find("hertz") == NLC_MODEL_HERTZ);
    record.struct_size = sizeof record;
    DEMAND(ends(nlc_model_info(NLC_MODEL_GONZALEZ_CUITINO, &record, new_info()), NLC_OK));
    DEMAND(record.potential == 1 && record.circles == 0 && record.cost == 1 && strlen(record.doi) > 0);

    /* from positions to contacts, from lists as well */
    int32_t neighbour = 1, *const neighbours[2] = {&neighbour, NULL}, found_i[CONTACTS], found_j[CONTACTS];
    const int32_t length[2] = {1, 0};
    int64_t count = 0;
    lists.struct_size = sizeof lists;
    lists.count = lists.particle_count = 2;
    lists.length = length;
    lists.neighbour = neighbours;
    DEMAND(ends(nlc_contacts_from_lists(&count, found_i, found_j, CONTACTS, &particles, &positions, &lists, R, new_info()), NLC_OK));
    DEMAND(count == CONTACTS);
    DEMAND(ends(nlc_contacts_from_pairs(overlap, normal, &particles, &positions, i, j, CONTACTS, new_info()), NLC_OK));
    DEMAND(near(overlap[0], step) && normal[2] == -1 && overlap[4] == 0 && normal[12] == 1);

    /* a network, its forces and what is asked of them */
    options.struct_size = sizeof options;
    options.tolerance = 1e-10;
    const size_t size = nlc_network_size(&particles, CONTACTS, &options);
    void *memory = malloc(size);
    nlc_network *network = NULL;
    DEMAND(size && memory);
    DEMAND(ends(nlc_network_init(&network, memory, size, &particles, i, j, CONTACTS, &options, new_info()), NLC_OK));
    DEMAND(ends(nlc_solve(network, force, nonlocal, overlap, normal, new_info()), NLC_OK));
    DEMAND(room.info.active == CONTACTS && room.info.sweeps > 0 && room.info.coupling == 1 && room.info.residual <= 1e-10);
    DEMAND(room.info.lambda_lower <= room.info.lambda_upper && room.info.lambda_upper < 1);
    DEMAND(fabs(2 * force[0] - 24.836) < 1e-3 && fabs(force[4] - 0.327) < 1e-3); /* as the README has them */

    double displacement[2 * CONTACTS], F[6] = {0}, plates[6] = {0}, energy, reach, stiffness[2], dforce[CONTACTS], back[CONTACTS];
    DEMAND(ends(nlc_sweep(network, displacement, force, overlap, normal, new_info()), NLC_OK));
    DEMAND(near(displacement[8] + displacement[9], nonlocal[4]));
    DEMAND(ends(nlc_assemble(network, F, 0, plates, force, normal, new_info()), NLC_OK));
    DEMAND(near(plates[5], 2 * force[1]) && near(-F[0], force[4]));
    DEMAND(ends(nlc_energy(network, &energy, force, overlap, normal, new_info()), NLC_OK) && energy > 0);
    DEMAND(ends(nlc_reach(network, &reach, NULL, force, new_info()), NLC_OK) && reach > 2 * nonlocal[4]);
    DEMAND(ends(nlc_tangent_bound(network, stiffness, force, normal, new_info()), NLC_OK) && stiffness[0] > 0);
    const double doverlap[CONTACTS] = {1e-6, 1e-6, 1e-6, 1e-6, 0};
    DEMAND(ends(nlc_tangent(network, dforce, doverlap, force, normal, new_info()), NLC_OK));
    DEMAND(ends(nlc_tangent_inverse(network, back, dforce, force, normal, new_info()), NLC_OK) && near(back[0], doverlap[0]));

    /* what it gets wrong is called what it was called */
    normal[0] = 2;
    DEMAND(ends(nlc_solve(network, force, nonlocal, overlap, normal, new_info()), NLC_ERROR_NORMAL) && room.info.culprit == 0);
    options.model = 12345;
    DEMAND(ends(nlc_set_options(network, &options, new_info()), NLC_ERROR_MODEL) && room.info.culprit == 12345);
    free(memory);
    return 0;
}
