/* SPDX-License-Identifier: BSD-2-Clause */
/* bed.c - a bed of spheres under a plate: one step after the other. */
#include "bed.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
/* In mean radii: gaps up to about REACH are listed, and the list is made anew before any two particles have come nearer by
 * SKIN. */
#define REACH .26
#define SKIN .12

enum { LEVERS = 10 }; /* the displacements of the two sides, which make levers, are found anew in every so many steps */

static int fail(bed *b, const char *text)
{
    snprintf(b->error, sizeof b->error, "%s", text);
    return -1;
}

double bed_height(const bed *b)
{
    return b->wall_point[BED_WALLS - 1][2];
}

/* ---- who touches whom */

static bool grow(bed *b, size_t contacts)
{
    if (contacts <= b->room) return true;
    const size_t room = contacts + contacts / 4;
    const struct {
        void *array; /* where its address is kept */
        size_t size;
    } all[] = {{&b->overlap, sizeof(double)},    {&b->normal, sizeof *b->normal},   {&b->force, sizeof(double)},
               {&b->g, sizeof(double)},          {&b->previous, sizeof(double)},    {&b->side, 2 * sizeof(double)},
               {&b->work, sizeof(double)},       {&b->carried, sizeof(double)},     {&b->saturated, sizeof(double)},
               {&b->slip, sizeof *b->slip},      {&b->sliding, sizeof *b->sliding}, {&b->key, sizeof *b->key},
               {&b->old_key, sizeof *b->old_key}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        char *array;
        memcpy(&array, all[k].array, sizeof array);
        array = realloc(array, room * all[k].size);
        if (!array) return false;
        memset(array + b->room * all[k].size, 0, (room - b->room) * all[k].size);
        memcpy(all[k].array, &array, sizeof array);
    }
    b->room = room;
    return true;
}

/* A row of numbers, one every stride doubles, goes to the contacts of the new list. */
static nlc_status carry(bed *b, double *row, int stride, int64_t old_count)
{
    for (int64_t c = 0; c < old_count; c++) b->work[c] = row[c * stride];
    const nlc_status status =
        nlc_carry(b->carried, b->key, b->n.count, b->work, b->old_key, old_count, b->memory, b->memory_size, NULL);
    for (int64_t c = 0; c < b->n.count && status >= 0; c++) row[c * stride] = b->carried[c];
    return status;
}

static nlc_status carry_all(bed *b, int64_t old_count)
{
    nlc_status status = carry(b, b->g, 1, old_count);
    for (int x = 0; x < 3 && status >= 0; x++) status = carry(b, &b->slip[0][x], 3, old_count);
    for (int s = 0; s < 2 && status >= 0; s++) status = carry(b, b->side + s, 2, old_count);
    return status;
}

static int make_list(bed *b)
{
    const int64_t old_count = b->n.count;
    uint64_t *swap = b->old_key;
    b->old_key = b->key;
    b->key = swap;
    neighbours_free(&b->n);
    memcpy(b->p.walls[BED_WALLS - 1].point, b->wall_point[BED_WALLS - 1], sizeof b->p.walls->point);
    if (neighbours_find(&b->n, &b->p, REACH, b->error, sizeof b->error)) return -1;
    const size_t room = b->room;
    if (!grow(b, (size_t)b->n.count)) return fail(b, "out of memory");
    for (int64_t c = 0; c < b->n.count; c++) b->key[c] = (uint64_t)b->n.i[c] << 32 | (uint64_t)b->n.j[c];
    const nlc_particles particles = packing_particles(&b->p);
    const nlc_options options = {
        .struct_size = sizeof options, .model = b->set.model, .tolerance = b->set.tolerance, .prefactor = b->set.prefactor};
    if (room < b->room) { /* enough for any list that needs no more room */
        free(b->memory);
        b->memory_size = nlc_network_size(&particles, (int64_t)b->room, &options);
        b->memory = malloc(b->memory_size);
        if (!b->memory) return fail(b, "out of memory");
    }
    nlc_status status = carry_all(b, old_count);
    if (status >= 0)
        status =
            nlc_network_init(&b->network, b->memory, b->memory_size, &particles, b->n.i, b->n.j, b->n.count, &options, NULL);
    if (status < 0) return fail(b, nlc_strerror(status));
    memcpy(b->listed, b->p.x, (size_t)b->p.count * sizeof *b->listed);
    b->listed_height = bed_height(b);
    b->fresh = true;
    return 0;
}

static bool list_is_old(const bed *b)
{
    double most = 0;
    for (int64_t k = 0; k < b->p.count; k++) {
        double square = 0;
        for (int x = 0; x < 3; x++) square += (b->p.x[k][x] - b->listed[k][x]) * (b->p.x[k][x] - b->listed[k][x]);
        most = fmax(most, square);
    }
    const double moved = sqrt(most) + fmax(sqrt(most), fabs(bed_height(b) - b->listed_height));
    return moved > SKIN * b->mean_radius;
}

/* ---- forces */

static nlc_status contact_forces(bed *b)
{
    const nlc_particles particles = packing_particles(&b->p);
    const nlc_positions positions = {.struct_size = sizeof positions,
                                     .x = &b->p.x[0][0],
                                     .y = &b->p.x[0][1],
                                     .z = &b->p.x[0][2],
                                     .stride = sizeof *b->p.x,
                                     .wall_point = &b->wall_point[0][0],
                                     .wall_normal = &b->wall_normal[0][0]};
    nlc_info info = {.struct_size = sizeof info};
    nlc_status status =
        nlc_contacts_from_pairs(b->overlap, &b->normal[0][0], &particles, &positions, b->n.i, b->n.j, b->n.count, NULL);
    if (status < 0) return status;
    if (b->fresh) memcpy(b->previous, b->g, (size_t)b->n.count * sizeof *b->g);
    b->fresh = false;
    status = nlc_predict(b->g, b->previous, b->n.count, 1, NULL);
    if (status < 0) return status;
    status = nlc_solve(b->network, b->force, b->g, b->overlap, &b->normal[0][0], &info);
    b->sweeps += info.sweeps;
    b->warnings += status > 0;
    if (status < 0 || b->set.model == NLC_MODEL_HERTZ || b->steps % LEVERS != 0) return status;
    const nlc_status swept = nlc_sweep(b->network, b->side, b->force, b->overlap, &b->normal[0][0], NULL);
    return swept < 0 ? swept : status;
}

static void cross(const double *a, const double *b, double *c)
{
    for (int x = 0; x < 3; x++) c[x] = a[(x + 1) % 3] * b[(x + 2) % 3] - a[(x + 2) % 3] * b[(x + 1) % 3];
}

/* Velocity by which i's surface slides past j's, times the step, is added to the slip; that is turned into the plane of contact
 * and shortened to the slip length. */
static void slide(bed *b, int64_t c)
{
    const int32_t i = b->n.i[c], j = b->n.j[c];
    const bool wall = j >= b->p.count;
    const double *n = b->normal[c], *w = b->side + 2 * c;
    const double half = fmax(b->overlap[c] + w[0] + w[1], 0) / 2;
    double spin[2][3] = {{0}}, v[3], *s = b->slip[c], along = 0, length = 0;
    cross(b->omega[i], n, spin[0]);
    if (!wall) cross(b->omega[j], n, spin[1]);
    for (int x = 0; x < 3; x++) {
        v[x] = b->v[i][x] + (b->p.radius[i] + w[0] - half) * spin[0][x];
        if (!wall)
            v[x] -= b->v[j][x] - (b->p.radius[j] + w[1] - half) * spin[1][x];
        else if (j == b->p.count + BED_WALLS - 1 && x == 2)
            v[x] -= b->plate_speed;
        s[x] += v[x] * b->set.step;
        along += s[x] * n[x];
    }
    for (int x = 0; x < 3; x++) s[x] -= along * n[x], length += s[x] * s[x];
    length = sqrt(length);
    for (int x = 0; x < 3; x++) {
        b->sliding[c][x] = length > 0 ? -s[x] / length : 0;
        if (length > b->set.slip_length) s[x] *= b->set.slip_length / length;
    }
    b->saturated[c] = fmin(length / b->set.slip_length, 1);
}

/* Friction of mu P where a contact has slid by the slip length, less of it before: that of a part of P, and the rest without.
 */
static nlc_status add_forces(bed *b)
{
    for (int64_t c = 0; c < b->n.count; c++) {
        if (b->force[c] > 0)
            slide(b, c);
        else
            memset(b->slip[c], 0, sizeof *b->slip), memset(b->sliding[c], 0, sizeof *b->sliding), b->saturated[c] = 0;
        b->work[c] = b->saturated[c] * b->force[c];
    }
    memset(b->wall_force, 0, sizeof b->wall_force);
    memset(b->torque, 0, (size_t)b->p.count * sizeof *b->torque);
    for (int64_t k = 0; k < b->p.count; k++) {
        b->F[k][0] = b->F[k][1] = 0;
        b->F[k][2] = -b->set.weight / b->set.density * b->mass[k];
    }
    const nlc_status status =
        nlc_assemble_sliding(b->network, &b->F[0][0], 0, &b->torque[0][0], 0, &b->wall_force[0][0], b->work, &b->normal[0][0],
                             &b->sliding[0][0], b->side, b->overlap, b->set.friction, NULL);
    if (status < 0) return status;
    for (int64_t c = 0; c < b->n.count; c++) b->work[c] = b->force[c] - b->work[c];
    return nlc_assemble(b->network, &b->F[0][0], 0, &b->wall_force[0][0], b->work, &b->normal[0][0], NULL);
}

/* ---- motion */

/* The mean deformation takes the grains along with the plate; drag acts on what differs from it. */
static void move(bed *b)
{
    const double dt = b->set.step, kept = exp(-b->set.drag * dt), rate = b->plate_speed / bed_height(b);
    for (int64_t k = 0; k < b->p.count; k++) {
        const double inertia = .4 * b->mass[k] * b->p.radius[k] * b->p.radius[k];
        for (int x = 0; x < 3; x++) {
            const double mean = x == 2 ? rate * b->p.x[k][2] : 0;
            b->v[k][x] = mean + kept * (b->v[k][x] - mean) + dt * b->F[k][x] / b->mass[k];
            b->omega[k][x] = kept * b->omega[k][x] + dt * b->torque[k][x] / inertia;
            b->p.x[k][x] += dt * b->v[k][x];
        }
    }
    b->wall_point[BED_WALLS - 1][2] += dt * b->plate_speed;
}

int bed_step(bed *b)
{
    if (list_is_old(b) && make_list(b)) return -1;
    nlc_status status = contact_forces(b);
    if (status >= 0) status = add_forces(b);
    if (status < 0) return fail(b, nlc_strerror(status));
    move(b);
    b->steps++;
    return 0;
}

/* ---- begin and end */

int bed_open(bed *b, const char *path, const bed_settings *set)
{
    memset(b, 0, sizeof *b);
    b->set = *set;
    if (packing_read(&b->p, path, false, b->error, sizeof b->error)) return -1;
    if (b->p.wall_count != BED_WALLS) return fail(b, "not six walls");
    const size_t count = (size_t)b->p.count;
    double(**rows[])[3] = {&b->v, &b->omega, &b->F, &b->torque, &b->listed};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        if (!(*rows[k] = calloc(count, sizeof **rows[k]))) return fail(b, "out of memory");
    if (!(b->mass = calloc(count, sizeof *b->mass))) return fail(b, "out of memory");
    for (size_t k = 0; k < count; k++) {
        b->mass[k] = set->density * 4 / 3 * PI * pow(b->p.radius[k], 3);
        b->mean_radius += b->p.radius[k] / (double)count;
    }
    for (int w = 0; w < BED_WALLS; w++) {
        memcpy(b->wall_point[w], b->p.walls[w].point, sizeof b->wall_point[w]);
        memcpy(b->wall_normal[w], b->p.walls[w].normal, sizeof b->wall_normal[w]);
    }
    return make_list(b);
}

void bed_free(bed *b)
{
    void *all[] = {b->memory,  b->v,      b->omega,     b->F,       b->torque,   b->listed, b->mass,
                   b->overlap, b->normal, b->force,     b->g,       b->previous, b->side,   b->slip,
                   b->sliding, b->work,   b->saturated, b->carried, b->key,      b->old_key};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
    neighbours_free(&b->n);
    packing_free(&b->p);
}
