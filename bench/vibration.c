/* SPDX-License-Identifier: BSD-2-Clause */
/* vibration.c - see vibration.h */
#include "vibration.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lattice.h"

#define SLACK 0.05 /* of the smallest radius: how far a sphere moves before candidates are looked for anew */

static int fail(vibration *s, nlc_status status)
{
    s->status = status;
    return -1;
}

/* ----------------------------------------------------------------------------------------------------------- contacts -- */

static void set_stiffness(vibration *s)
{
    neighbours_stiffness(&s->n, &s->p, s->stiffness);
    for (int64_t c = 0; c < s->n.count; c++) s->key[c] = (uint64_t)s->n.i[c] << 32 | (uint64_t)s->n.j[c];
}

/* Arrays of contacts for the new list, zeros. */
static int make_room(vibration *s)
{
    const size_t n = (size_t)s->n.count + 1;
    double **const array[] = {&s->overlap, &s->force, &s->nonlocal, &s->previous, &s->stiffness, &s->normal, &s->w};
    bool there = true;
    for (int k = 0; k < 7; k++) {
        free(*array[k]);
        there = (*array[k] = calloc(k < 5 ? n : 3 * n, sizeof(double))) && there;
    }
    free(s->key);
    free(s->memory);
    const nlc_particles particles = packing_particles(&s->p);
    const size_t size = nlc_network_size(&particles, s->n.count, &s->options);
    there = (s->key = calloc(n, sizeof *s->key)) && (s->memory = calloc(size, 1)) && there;
    if (!there) return fail(s, NLC_ERROR_MEMORY_SIZE);
    s->status = nlc_network_init(&s->network, s->memory, size, &particles, s->n.i, s->n.j, s->n.count, &s->options, NULL);
    return s->status < 0 ? -1 : 0;
}

/* What the last list's contacts had. */
typedef struct carried {
    int64_t count;
    uint64_t *key;
    double *value[2]; /* nonlocal, previous */
} carried;

static int carry(vibration *s, carried *old)
{
    double *const to[] = {s->nonlocal, s->previous};
    const size_t size = nlc_carry_size(s->n.count, old->count);
    void *memory = calloc(size + 1, 1);
    s->status = memory ? NLC_OK : NLC_ERROR_MEMORY_SIZE;
    for (int k = 0; k < 2 && s->status >= 0; k++)
        s->status = nlc_carry(to[k], s->key, s->n.count, old->value[k], old->key, old->count, memory, size, NULL);
    free(memory);
    return s->status < 0 ? -1 : 0;
}

static int list(vibration *s)
{
    char error[PACKING_ERROR_SIZE];
    carried old = {s->n.count, s->key, {s->nonlocal, s->previous}};
    s->key = NULL;
    s->nonlocal = s->previous = NULL;
    neighbours_free(&s->n);
    int result = neighbours_find(&s->n, &s->p, NEIGHBOURS_REACH + 2 * SLACK, error, sizeof error);
    if (result) s->status = NLC_ERROR_SAME_PLACE;
    else result = make_room(s);
    if (!result) {
        set_stiffness(s);
        if (old.count > 0) result = carry(s, &old);
        memcpy(s->listed, s->p.x, (size_t)s->p.count * sizeof *s->listed);
        s->lists++;
    }
    free(old.key);
    for (int k = 0; k < 2; k++) free(old.value[k]);
    return result;
}

static bool is_stale(const vibration *s)
{
    double least = INFINITY, most = 0;
    for (int64_t k = 0; k < s->p.count; k++) {
        const double *a = s->p.x[k], *b = s->listed[k], x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
        least = fmin(least, s->p.radius[k]);
        most = fmax(most, x * x + y * y + z * z);
    }
    return !(most <= SLACK * SLACK * least * least);
}

static int set_overlaps(vibration *s)
{
    const packing *p = &s->p;
    const nlc_particles particles = packing_particles(p);
    double cell[9] = {0};
    bool periodic = false;
    for (int a = 0; a < 3; a++)
        if (p->periodic[a]) cell[4 * a] = p->high[a] - p->low[a], periodic = true;
    const nlc_positions at = {.struct_size = sizeof at,
                              .x = &p->x[0][0],
                              .y = &p->x[0][1],
                              .z = &p->x[0][2],
                              .stride = 3 * sizeof(double),
                              .wall_point = s->wall,
                              .wall_normal = s->wall + 3 * p->wall_count,
                              .cell = periodic ? cell : NULL};
    s->status = nlc_contacts_from_pairs(s->overlap, s->normal, &particles, &at, s->n.i, s->n.j, s->n.count, NULL);
    return s->status < 0 ? -1 : 0;
}

/* ------------------------------------------------------------------------------------------------------------- forces -- */

static int solve(vibration *s)
{
    nlc_info info = {.struct_size = sizeof info};
    nlc_status status = NLC_OK;
    if (s->started) status = nlc_predict(s->nonlocal, s->previous, s->n.count, 1, NULL);
    if (status >= 0) status = nlc_solve(s->network, s->force, s->nonlocal, s->overlap, s->normal, &info);
    if (!s->started) memcpy(s->previous, s->nonlocal, (size_t)s->n.count * sizeof *s->previous);
    s->sweeps += info.sweeps;
    if (status < 0 || status & (NLC_WARNING_WEAKENED | NLC_WARNING_NOT_CONVERGED)) return fail(s, status);
    return 0;
}

/* Displacements of the step before, after the first one; then those by the forces of this one. */
static int lag(vibration *s)
{
    if (!s->started) return solve(s);
    for (int64_t c = 0; c < s->n.count; c++) s->force[c] = nlc_hertz_force(s->stiffness[c], s->overlap[c] + s->nonlocal[c]);
    const nlc_status status = nlc_sweep(s->network, s->w, s->force, s->overlap, s->normal, NULL);
    for (int64_t c = 0; c < s->n.count; c++) s->nonlocal[c] = s->w[2 * c] + s->w[2 * c + 1];
    s->sweeps++;
    return status < 0 ? fail(s, status) : 0;
}

/* Contacts that this step has opened or closed; who was which is in the third part of s->w. */
static void count_changes(vibration *s)
{
    double *const was = s->w + 2 * s->n.count;
    for (int64_t c = 0; c < s->n.count; c++) {
        const double is = s->force[c] > 0 ? 1 : -1;
        s->changes += was[c] * is < 0;
        was[c] = is;
    }
}

static int find_forces(vibration *s)
{
    if ((s->n.count == 0 || is_stale(s)) && list(s)) return -1;
    if (set_overlaps(s)) return -1;
    if (s->kind == VIBRATION_LAGGED ? lag(s) : solve(s)) return -1;
    memset(s->F, 0, (size_t)s->p.count * sizeof *s->F);
    s->status = nlc_assemble(s->network, s->F[0], 0, NULL, s->force, s->normal, NULL);
    if (s->status >= 0 && s->kind == VIBRATION_TURNING)
        s->status = nlc_assemble_turning(s->network, s->F[0], 0, s->force, s->overlap, s->normal, NULL);
    count_changes(s);
    s->started = true;
    return s->status < 0 ? -1 : 0;
}

int vibration_use(vibration *s, vibration_forces kind, int32_t model, double tolerance)
{
    s->kind = kind;
    s->options = (nlc_options){.struct_size = sizeof s->options, .tolerance = tolerance};
    s->options.model = kind == VIBRATION_HERTZ ? NLC_MODEL_HERTZ : model;
    s->started = false;
    s->steps = s->sweeps = s->lists = s->changes = 0;
    neighbours_free(&s->n); /* listed anew */
    return find_forces(s);
}

/* -------------------------------------------------------------------------------------------------------------- steps -- */

static void push(vibration *s, double dt)
{
    for (int64_t k = 0; k < s->p.count; k++)
        for (int a = 0; a < 3; a++) s->v[k][a] += dt / s->mass[k] * s->F[k][a];
}

int vibration_step(vibration *s, double dt)
{
    push(s, 0.5 * dt);
    for (int64_t k = 0; k < s->p.count; k++)
        for (int a = 0; a < 3; a++) s->p.x[k][a] += dt * s->v[k][a];
    if (find_forces(s)) return -1;
    push(s, 0.5 * dt);
    s->steps++;
    return 0;
}

static double kinetic_energy(const vibration *s)
{
    double sum = 0;
    for (int64_t k = 0; k < s->p.count; k++)
        for (int a = 0; a < 3; a++) sum += 0.5 * s->mass[k] * s->v[k][a] * s->v[k][a];
    return sum;
}

int vibration_energy(vibration *s, double *kinetic, double *elastic)
{
    double *force = s->force, *converged = NULL;
    *kinetic = kinetic_energy(s);
    if (s->kind == VIBRATION_LAGGED) {
        if (!(converged = calloc(2 * (size_t)s->n.count + 1, sizeof *converged))) return fail(s, NLC_ERROR_MEMORY_SIZE);
        memcpy(converged + s->n.count, s->nonlocal, (size_t)s->n.count * sizeof *converged);
        s->status = nlc_solve(s->network, force = converged, converged + s->n.count, s->overlap, s->normal, NULL);
    }
    if (s->status >= 0) s->status = nlc_energy(s->network, elastic, force, s->overlap, s->normal, NULL);
    free(converged);
    return s->status < 0 || s->status & NLC_WARNING_NOT_CONVERGED ? -1 : 0;
}

int vibration_limit(vibration *s, double *dt)
{
    double *stiffness = calloc((size_t)s->p.count, sizeof *stiffness), most = 0;
    s->status = stiffness ? nlc_tangent_bound(s->network, stiffness, s->force, s->normal, NULL) : NLC_ERROR_MEMORY_SIZE;
    for (int64_t k = 0; k < s->p.count && s->status >= 0; k++) most = fmax(most, 2 * stiffness[k] / s->mass[k]);
    free(stiffness);
    *dt = 2 / sqrt(most);
    return s->status < 0 ? -1 : 0;
}

static double imbalance(const vibration *s)
{
    double resultant = 0, force = 0;
    int64_t active = 0;
    for (int64_t k = 0; k < s->p.count; k++) {
        const double *F = s->F[k];
        resultant += sqrt(F[0] * F[0] + F[1] * F[1] + F[2] * F[2]);
    }
    for (int64_t c = 0; c < s->n.count; c++) active += s->force[c] > 0, force += s->force[c];
    return force > 0 ? resultant / (double)s->p.count / (force / (double)active) : 0;
}

int vibration_relax(vibration *s, double dt, double balance, int64_t most)
{
    double before = 0;
    for (int64_t k = 0; k < most && imbalance(s) > balance; k++) {
        if (vibration_step(s, dt)) return -1;
        const double now = kinetic_energy(s);
        if (now < before) memset(s->v, 0, (size_t)s->p.count * sizeof *s->v);
        before = now < before ? 0 : now;
    }
    memset(s->v, 0, (size_t)s->p.count * sizeof *s->v);
    return imbalance(s) > balance ? -1 : 0;
}

/* -------------------------------------------------------------------------------------------------------------- state -- */

static double noise(uint64_t *state) /* -1 ... 1; splitmix64 */
{
    uint64_t h = *state += UINT64_C(0x9e3779b97f4a7c15);
    h = (h ^ (h >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    h = (h ^ (h >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((h ^ (h >> 31)) >> 11) * 0x1p-52 - 1;
}

void vibration_kick(vibration *s, double kinetic)
{
    double momentum[3] = {0, 0, 0}, mass = 0;
    uint64_t random = 1;
    for (int64_t k = 0; k < s->p.count; k++) {
        mass += s->mass[k];
        for (int a = 0; a < 3; a++) momentum[a] += s->mass[k] * (s->v[k][a] = noise(&random));
    }
    for (int64_t k = 0; k < s->p.count; k++)
        for (int a = 0; a < 3; a++) s->v[k][a] -= momentum[a] / mass;
    const double factor = sqrt(kinetic / kinetic_energy(s));
    for (int64_t k = 0; k < s->p.count; k++)
        for (int a = 0; a < 3; a++) s->v[k][a] *= factor;
}

void vibration_save(const vibration *s, double *state)
{
    memcpy(state, s->p.x, 3 * (size_t)s->p.count * sizeof *state);
    memcpy(state + 3 * s->p.count, s->v, 3 * (size_t)s->p.count * sizeof *state);
}

void vibration_restore(vibration *s, const double *state)
{
    memcpy(s->p.x, state, 3 * (size_t)s->p.count * sizeof *state);
    memcpy(s->v, state + 3 * s->p.count, 3 * (size_t)s->p.count * sizeof *state);
}

int vibration_open(vibration *s, const char *name, char *error, size_t error_size)
{
    memset(s, 0, sizeof *s);
    if (packing_open(&s->p, &s->n, name, NEIGHBOURS_REACH, error, error_size)) return -1;
    neighbours_free(&s->n);
    const size_t n = (size_t)s->p.count;
    bool there = (s->v = calloc(n, sizeof *s->v)) && (s->F = calloc(n, sizeof *s->F)) && (s->mass = calloc(n, sizeof(double)));
    there = there && (s->listed = calloc(n, sizeof *s->listed)) && (s->wall = calloc(6 * (size_t)s->p.wall_count + 1, sizeof(double)));
    if (!there) {
        snprintf(error, error_size, "%s: out of memory", name);
        return -1;
    }
    const double per_volume = 4.18879020478639098 * VIBRATION_DENSITY;
    for (int64_t k = 0; k < s->p.count; k++) s->mass[k] = per_volume * pow(s->p.radius[k], 3);
    for (int64_t w = 0; w < s->p.wall_count; w++) {
        memcpy(s->wall + 3 * w, s->p.walls[w].point, 3 * sizeof(double));
        memcpy(s->wall + 3 * (s->p.wall_count + w), s->p.walls[w].normal, 3 * sizeof(double));
    }
    return 0;
}

void vibration_free(vibration *s)
{
    void *const array[] = {s->v,     s->F,        s->mass,     s->listed,    s->wall, s->overlap, s->normal,
                           s->force, s->nonlocal, s->previous, s->stiffness, s->w,    s->key,     s->memory};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) free(array[k]);
    neighbours_free(&s->n);
    packing_free(&s->p);
    memset(s, 0, sizeof *s);
}
