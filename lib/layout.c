/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * layout.c - the arrays of a network in the caller's memory: which of them, and where.
 *
 * What the network was built from and what every sweep needs comes first, at the same places in every layout.  All else is work space
 * that nothing is kept in from call to call: options may replace it.
 */
#include "layout.h"
#include "parallel.h"
#include "tree.h"

typedef struct room {
    char *memory; /* NULL: just measured */
    size_t used;  /* SIZE_MAX: it overflows */
    int arrays;   /* those that are wanted */
} room;

/* The next count elements, for these; NULL for others. */
static void *take(room *r, int arrays, int64_t count, size_t size)
{
    const size_t at = r->used;
    if (!(r->arrays & arrays) || at == SIZE_MAX) return 0;
    if ((uint64_t)count > (SIZE_MAX - 16 - at) / size) {
        r->used = SIZE_MAX;
        return 0;
    }
    r->used = at + (((size_t)count * size + 7) & ~(size_t)7);
    return r->memory ? r->memory + at : 0;
}

/* What the network was built from. */
static void lay_out_scene(nlc_network *n, room *r)
{
    n->start = take(r, NLC_ALWAYS, n->particle_count + 1, sizeof *n->start);
    n->radius = take(r, NLC_ALWAYS, n->particle_count, sizeof *n->radius);
    n->scale = take(r, NLC_ALWAYS, n->particle_count, sizeof *n->scale);
    n->material = take(r, NLC_ALWAYS, n->body_count, sizeof *n->material);
    n->materials = take(r, NLC_ALWAYS, n->material_count, sizeof *n->materials);
    n->kernel = take(r, NLC_ALWAYS, n->material_count, sizeof *n->kernel);
    n->i = take(r, NLC_ALWAYS, n->contact_count, sizeof *n->i);
    n->j = take(r, NLC_ALWAYS, n->contact_count, sizeof *n->j);
    n->stiffness = take(r, NLC_ALWAYS, n->contact_count, sizeof *n->stiffness);
    n->entry = take(r, NLC_ALWAYS, 2 * n->contact_count, sizeof *n->entry);
}

/* What a sweep and [GC] Algorithm 1 work with. */
static void lay_out_sweep(nlc_network *n, room *r)
{
    const int64_t windows = nlc_windows(n), slabs = nlc_slabs(n);
    n->part = take(r, NLC_ALWAYS, 1, sizeof *n->part);
    n->kept_at = take(r, NLC_ALWAYS, windows, sizeof *n->kept_at);
    n->piece = take(r, NLC_ALWAYS, windows > slabs ? windows : slabs, sizeof *n->piece);
    n->largest = take(r, NLC_ALWAYS, n->body_count, sizeof *n->largest);
    n->closest = take(r, NLC_ALWAYS, n->particle_count, sizeof *n->closest);
    n->side = take(r, NLC_ALWAYS, 2 * n->contact_count, sizeof *n->side);
    n->force = take(r, NLC_ALWAYS, n->contact_count, sizeof *n->force);
    n->current = take(r, NLC_ALWAYS, n->contact_count, sizeof *n->current); /* right behind force, see share_memory */
    n->spare[0] = take(r, NLC_ALWAYS, n->contact_count, sizeof *n->spare[0]);
    n->approach = take(r, NLC_FOR_CIRCLES, n->contact_count, sizeof *n->approach);
    n->own = take(r, NLC_FOR_PLACES, 2 * n->contact_count, sizeof *n->own);
    n->origin = take(r, NLC_FOR_RANKS, n->contact_count, sizeof *n->origin);
    n->room_size = r->arrays & NLC_FOR_TREES ? nlc_tree_room(n->contact_count) : 0;
    n->order = take(r, NLC_FOR_TREES, n->contact_count < n->room_size ? n->contact_count : n->room_size, sizeof *n->order);
    n->room = take(r, NLC_FOR_TREES, n->room_size, sizeof *n->room);
}

static void lay_out_solver(nlc_network *n, room *r)
{
    for (int k = 1; k < 5; k++) n->spare[k] = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *n->spare[k]);
    n->floor = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *n->floor);
    n->slope = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *n->slope);
    for (int k = 0; k < 4; k++) n->lanczos[k] = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *n->lanczos[k]);
    for (int k = 0; k < NLC_DIRECTIONS; k++) n->direction[k] = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *n->direction[k]);
    for (int k = 0; k < NLC_DIRECTIONS; k++) n->image[k] = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *n->image[k]);
    n->share = take(r, NLC_FOR_SOLVER, 2 * n->contact_count, sizeof *n->share);
    n->bound = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *n->bound);
    n->norm = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *n->norm);
    n->growth = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *n->growth);
    n->weakening = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *n->weakening);
    n->changed = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *n->changed);
    n->mark = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *n->mark);
    n->degree = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *n->degree);
    n->cluster = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *n->cluster);
    n->place = take(r, NLC_FOR_SOLVER, n->body_count, sizeof *n->place);
    n->body = take(r, NLC_FOR_SOLVER, n->body_count, sizeof *n->body);
    n->part_overlap = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *n->part_overlap);
    n->part_normal = take(r, NLC_FOR_SOLVER, n->contact_count, 3 * sizeof *n->part_normal);
}

/* The part: arrays of its own for what it is, those of the whole for work. */
static void lay_out_part(nlc_network *p, const nlc_network *n, room *r)
{
    p->kept_at = take(r, NLC_FOR_SOLVER, nlc_windows(n), sizeof *p->kept_at);
    p->start = take(r, NLC_FOR_SOLVER, n->particle_count + 1, sizeof *p->start);
    p->radius = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *p->radius);
    p->scale = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *p->scale);
    p->largest = take(r, NLC_FOR_RANKS, n->body_count, sizeof *p->largest);
    p->weakening = take(r, NLC_FOR_SOLVER, n->particle_count, sizeof *p->weakening);
    p->material = take(r, NLC_FOR_SOLVER, n->body_count, sizeof *p->material);
    p->i = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *p->i);
    p->j = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *p->j);
    p->stiffness = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *p->stiffness);
    p->force = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *p->force);
    p->current = take(r, NLC_FOR_SOLVER, n->contact_count, sizeof *p->current);
    p->entry = take(r, NLC_FOR_SOLVER, 2 * n->contact_count, sizeof *p->entry);
    p->side = take(r, NLC_FOR_RANKS, 2 * n->contact_count, sizeof *p->side);
    p->part = 0;
}

/*
 * Without the solver's arrays: what others use of these, in memory that they do not use at the same time.  Sweeps write norm before
 * largest.  Tangents use neither force nor, as long as they need floor, current; nor, for their sums over particles, closest.
 * nlc_order uses none of these, and does not come to the walls' largest.
 */
static void share_memory(nlc_network *n, nlc_network *p)
{
    n->norm = n->largest;
    n->slope = n->force;
    n->floor = n->current;
    n->growth = n->closest;
    n->place = (int32_t *)(void *)n->largest;
    p->start = (int64_t *)(void *)n->closest;
    p->entry = (int64_t *)(void *)n->force;
}

size_t nlc_lay_out(nlc_network *n, char *memory, int arrays)
{
    room r = {memory, (sizeof *n + 7) & ~(size_t)7, arrays};
    if (n->contact_count > INT64_MAX / 2) return 0;
    n->owned = n->particle_count; /* until options say which are; there is room for all */
    lay_out_scene(n, &r);
    lay_out_sweep(n, &r);
    lay_out_solver(n, &r);
    nlc_network p = *n;
    lay_out_part(&p, n, &r);
    n->arrays = arrays;
    if (r.used > PTRDIFF_MAX) return 0; /* no object is larger */
    if (!memory) return r.used;
    if (!(arrays & NLC_FOR_SOLVER)) share_memory(n, &p);
    *n->part = p;
    return r.used;
}

int nlc_arrays_for(const nlc_options *o)
{
    if (o->model < 0 || o->model >= nlc_models_count) return NLC_ALWAYS; /* that is what is wrong, not the memory */
    const nlc_model *model = nlc_model_of(o);
    const nlc_shape shape = model->shape;
    if (model->within && o->method == NLC_METHOD_AUTOMATIC) return NLC_ALL_ARRAYS;
    return NLC_ALWAYS | (model->within ? NLC_FOR_TREES : 0) | (o->exchange ? NLC_FOR_RANKS : 0) |
           (shape == NLC_SHAPE_RADIUS || shape == NLC_SHAPE_MOMENTS ? NLC_FOR_CIRCLES : 0) |
           (shape == NLC_SHAPE_PLACE || shape == NLC_SHAPE_MOMENTS ? NLC_FOR_PLACES : 0);
}

static size_t size_of(const nlc_network *n, int arrays)
{
    nlc_network copy = *n;
    return nlc_lay_out(&copy, 0, arrays);
}

nlc_status nlc_choose_arrays(const nlc_network *n, const nlc_options *o, int *arrays, int64_t *culprit)
{
    const size_t all = size_of(n, NLC_ALL_ARRAYS);
    *arrays = all > 0 && n->memory_size >= all ? NLC_ALL_ARRAYS : nlc_arrays_for(o);
    const size_t size = *arrays == NLC_ALL_ARRAYS ? all : size_of(n, *arrays);
    *culprit = size > 0 ? (int64_t)size : INT64_MAX;
    return size > 0 && n->memory_size >= size ? NLC_OK : NLC_ERROR_MEMORY_SIZE;
}

nlc_status nlc_check_solver(const nlc_network *n, int64_t *culprit)
{
    int arrays;
    const nlc_options defaults = {.struct_size = sizeof defaults};
    return n->arrays & NLC_FOR_SOLVER ? NLC_OK : nlc_choose_arrays(n, &defaults, &arrays, culprit);
}
