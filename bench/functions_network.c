/* SPDX-License-Identifier: BSD-2-Clause */
/* functions_network.c - the functions on a packing. */
#include "functions.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "lattice.h"

enum { NETWORKS = 16, BLOCKS = 64 };

/* A network of its own for every set of options, since all calls are timed in turn. */
typedef struct variant {
    function_scene *scene;
    nlc_options options;
    nlc_network *network;
    void *memory;
} variant;

struct function_scene {
    packing p;
    neighbours n;
    nlc_particles particles;
    size_t memory_size;
    int32_t simd;
    int networks;
    variant variants[NETWORKS];  /* the first has the default options */
    double *force, *nonlocal;    /* [contacts] the solution */
    double *work, *start, *copy; /* [contacts] */
    double *change;              /* [contacts] a small one of the overlaps */
    double *pair_normal;         /* [contacts][3] */
    double *displacement;        /* [contacts][2] */
    double *sliding;             /* [contacts][3] */
    double *resultant, *torque;  /* [particles][3] */
    double *wall_resultant;      /* [walls][3] */
    double *of_particle;         /* [particles] */
    uint64_t *key, *old_key;     /* [contacts] */
    int32_t *particle;           /* [particles] order of them */
    int64_t *contact;            /* [contacts] likewise */
    void *carry_memory;
    nlc_positions positions;
    nlc_lists lists;
    double cell[9], *wall_point, *wall_normal;
    int32_t *list_i, *list_j, *length, **neighbour, *neighbours;
    int blocks;
    void *block[BLOCKS]; /* all memory */
    bool failed;
};

static const double *normals(const function_scene *s)
{
    return (const double *)s->n.normal;
}

static nlc_network *first_network(const function_scene *s)
{
    return s->variants[0].network;
}

/* ---- what is timed */

static nlc_status build(variant *v)
{
    const function_scene *s = v->scene;
    return nlc_network_init(&v->network, v->memory, s->memory_size, &s->particles, s->n.i, s->n.j, s->n.count, &v->options, NULL);
}

static nlc_status run_init(void *context)
{
    return build(context);
}

static nlc_status run_set_options(void *context)
{
    variant *v = context;
    return nlc_set_options(v->network, &v->options, NULL);
}

static nlc_status run_update(void *context)
{
    function_scene *s = context;
    return nlc_network_update(first_network(s), &s->particles, NULL, NULL);
}

static nlc_status run_sweep(void *context)
{
    variant *v = context;
    function_scene *s = v->scene;
    if (v->options.model == NLC_MODEL_HALF_SPACE) memset(s->displacement, 0, 2 * (size_t)s->n.count * sizeof(double));
    return nlc_sweep(v->network, s->displacement, s->force, s->n.overlap, normals(s), NULL);
}

static nlc_status run_solve(void *context)
{
    variant *v = context;
    function_scene *s = v->scene;
    memset(s->start, 0, (size_t)s->n.count * sizeof(double));
    return nlc_solve(v->network, s->work, s->start, s->n.overlap, normals(s), NULL);
}

static nlc_status run_solve_again(void *context)
{
    variant *v = context;
    function_scene *s = v->scene;
    memcpy(s->start, s->nonlocal, (size_t)s->n.count * sizeof(double));
    return nlc_solve(v->network, s->work, s->start, s->n.overlap, normals(s), NULL);
}

static nlc_status run_cache_size(void *context)
{
    const variant *v = context;
    return nlc_cache_size(v->network) > 0 ? NLC_OK : NLC_ERROR_MODEL;
}

static nlc_status run_predict(void *context)
{
    function_scene *s = context; /* the same every time: both are equal */
    return nlc_predict(s->nonlocal, s->copy, s->n.count, 1, NULL);
}

static nlc_status run_energy(void *context)
{
    function_scene *s = context;
    double energy;
    return nlc_energy(first_network(s), &energy, s->force, s->n.overlap, normals(s), NULL);
}

static nlc_status run_tangent(void *context)
{
    function_scene *s = context;
    return nlc_tangent(first_network(s), s->work, s->change, s->force, normals(s), NULL);
}

static nlc_status run_tangent_inverse(void *context)
{
    function_scene *s = context;
    return nlc_tangent_inverse(first_network(s), s->work, s->force, s->force, normals(s), NULL);
}

static nlc_status run_tangent_bound(void *context)
{
    function_scene *s = context;
    return nlc_tangent_bound(first_network(s), s->of_particle, s->force, normals(s), NULL);
}

static nlc_status run_assemble(void *context)
{
    function_scene *s = context;
    return nlc_assemble(first_network(s), s->resultant, 0, s->wall_resultant, s->force, normals(s), NULL);
}

static nlc_status run_assemble_sliding(void *context)
{
    function_scene *s = context;
    return nlc_assemble_sliding(first_network(s), s->resultant, 0, s->torque, 0, s->wall_resultant, s->force, normals(s),
                                s->sliding, s->displacement, s->n.overlap, 0.3, NULL);
}

static nlc_status run_assemble_turning(void *context)
{
    function_scene *s = context;
    return nlc_assemble_turning(first_network(s), s->resultant, 0, s->force, s->n.overlap, normals(s), NULL);
}

static nlc_status run_pairs(void *context)
{
    function_scene *s = context;
    return nlc_contacts_from_pairs(s->work, s->pair_normal, &s->particles, &s->positions, s->n.i, s->n.j, s->n.count, NULL);
}

static nlc_status run_lists(void *context)
{
    function_scene *s = context;
    int64_t found;
    return nlc_contacts_from_lists(&found, s->list_i, s->list_j, s->n.count, &s->particles, &s->positions, &s->lists, 0, NULL);
}

static nlc_status run_reach(void *context)
{
    function_scene *s = context;
    double reach;
    return nlc_reach(first_network(s), &reach, s->of_particle, s->force, NULL);
}

static nlc_status run_carry(void *context)
{
    function_scene *s = context;
    return nlc_carry(s->work, s->key, s->n.count, s->nonlocal, s->old_key, s->n.count, s->carry_memory,
                     nlc_carry_size(s->n.count, s->n.count), NULL);
}

static nlc_status run_order(void *context)
{
    function_scene *s = context;
    return nlc_order(first_network(s), s->particle, s->contact, NULL);
}

/* ---- preparation */

/* Zeros, to be freed with the scene. */
static void *get(function_scene *s, int64_t count, size_t size)
{
    if (s->blocks == BLOCKS) abort();
    void *memory = calloc((size_t)count + 1, size);
    s->failed = s->failed || !memory;
    return s->block[s->blocks++] = memory;
}

static void allocate(function_scene *s)
{
    const int64_t contacts = s->n.count, particles = s->p.count, walls = s->p.wall_count;
    double **of_contacts[] = {&s->force, &s->nonlocal, &s->work, &s->start, &s->copy, &s->change};
    for (size_t k = 0; k < sizeof of_contacts / sizeof *of_contacts; k++) *of_contacts[k] = get(s, contacts, sizeof(double));
    s->pair_normal = get(s, contacts, 3 * sizeof(double));
    s->displacement = get(s, contacts, 2 * sizeof(double));
    s->sliding = get(s, contacts, 3 * sizeof(double));
    s->key = get(s, contacts, sizeof(uint64_t));
    s->old_key = get(s, contacts, sizeof(uint64_t));
    s->particle = get(s, particles, sizeof(int32_t));
    s->contact = get(s, contacts, sizeof(int64_t));
    s->list_i = get(s, contacts, sizeof(int32_t));
    s->list_j = get(s, contacts, sizeof(int32_t));
    s->neighbours = get(s, contacts, sizeof(int32_t));
    s->resultant = get(s, particles, 3 * sizeof(double));
    s->torque = get(s, particles, 3 * sizeof(double));
    s->of_particle = get(s, particles, sizeof(double));
    s->length = get(s, particles, sizeof(int32_t));
    s->neighbour = get(s, particles, sizeof(int32_t *));
    s->wall_resultant = get(s, walls, 3 * sizeof(double));
    s->wall_point = get(s, walls, 3 * sizeof(double));
    s->wall_normal = get(s, walls, 3 * sizeof(double));
    s->carry_memory = get(s, (int64_t)nlc_carry_size(contacts, contacts), 1);
}

/* Every pair in the list of its i, walls left out: what a host has. */
static void set_lists(function_scene *s)
{
    int32_t *next = s->neighbours;
    for (int64_t c = 0; c < s->n.pair_count; c++) s->length[s->n.i[c]]++;
    for (int64_t k = 0; k < s->p.count; k++) {
        s->neighbour[k] = next;
        next += s->length[k];
        s->length[k] = 0;
    }
    for (int64_t c = 0; c < s->n.count; c++)
        if (s->n.j[c] < s->p.count) s->neighbour[s->n.i[c]][s->length[s->n.i[c]]++] = s->n.j[c];
    s->lists = (nlc_lists){.struct_size = sizeof s->lists, .count = s->p.count, .particle_count = s->p.count, .length = s->length,
                           .neighbour = s->neighbour};
}

static void set_positions(function_scene *s)
{
    for (int d = 0; d < 3; d++) s->cell[4 * d] = s->p.periodic[d] ? s->p.high[d] - s->p.low[d] : 0;
    for (int64_t w = 0; w < s->p.wall_count; w++) {
        memcpy(s->wall_point + 3 * w, s->p.walls[w].point, 3 * sizeof(double));
        memcpy(s->wall_normal + 3 * w, s->p.walls[w].normal, 3 * sizeof(double));
    }
    s->positions = (nlc_positions){.struct_size = sizeof s->positions, .x = &s->p.x[0][0], .y = &s->p.x[0][1], .z = &s->p.x[0][2],
                                   .stride = sizeof s->p.x[0], .wall_point = s->wall_point, .wall_normal = s->wall_normal,
                                   .cell = s->cell};
}

/* A direction along the surfaces, small changes, and names of the contacts, of which every seventh is new. */
static void set_contacts(function_scene *s)
{
    for (int64_t c = 0; c < s->n.count; c++) {
        const double *n = s->n.normal[c];
        const int least = fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2) : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
        double *t = s->sliding + 3 * c, square = 0;
        for (int d = 0; d < 3; d++) t[d] = (d == least) - n[least] * n[d];
        for (int d = 0; d < 3; d++) square += t[d] * t[d];
        for (int d = 0; d < 3; d++) t[d] /= sqrt(square);
        s->change[c] = 1e-3 * s->n.overlap[c];
        s->key[c] = (uint64_t)s->n.i[c] << 32 | (uint32_t)s->n.j[c];
        s->old_key[s->n.count - 1 - c] = c % 7 == 0 ? ~s->key[c] : s->key[c];
    }
}

static nlc_status add_network(function_scene *s, const nlc_options *options)
{
    if (s->networks == NETWORKS) abort();
    variant *v = &s->variants[s->networks++];
    *v = (variant){.scene = s, .options = *options, .memory = get(s, (int64_t)s->memory_size, 1)};
    v->options.struct_size = sizeof v->options;
    if (v->options.simd == NLC_SIMD_BEST) v->options.simd = s->simd;
    return v->memory ? build(v) : NLC_ERROR_MEMORY_SIZE;
}

static nlc_status add_sweeps(function_scene *s, function_list *list)
{
    static const struct {
        const char *name;
        int32_t simd;
    } variants[] = {
        {"portable C", NLC_SIMD_GENERIC},
#if defined(__aarch64__)
        {"NEON", NLC_SIMD_NEON},
#else
        {"AVX2", NLC_SIMD_AVX2},
        {"AVX-512", NLC_SIMD_AVX512},
#endif
    };
    char key[RUNS_KEY];
    nlc_status status = NLC_OK;
    for (size_t k = 0; k < sizeof variants / sizeof *variants && status >= 0 && s->simd == NLC_SIMD_BEST; k++) {
        snprintf(key, sizeof key, "nlc_sweep up to %s", variants[k].name);
        status = add_network(s, &(nlc_options){.simd = variants[k].simd});
        functions_add(list, key, "contact", (double)s->n.count, run_sweep, &s->variants[s->networks - 1]);
    }
    for (int32_t model = 1; model < nlc_model_count() && status >= 0; model++) {
        nlc_model_record record = {.struct_size = sizeof record};
        nlc_model_info(model, &record, NULL);
        snprintf(key, sizeof key, "nlc_sweep model %s", record.name);
        status = add_network(s, &(nlc_options){.model = model});
        functions_add(list, key, "contact", (double)s->n.count, run_sweep, &s->variants[s->networks - 1]);
    }
    return status;
}

/* Solves with coefficients kept, and recomputed where key is not NULL. */
static nlc_status add_kept(function_scene *s, function_list *list, int32_t model, const char *key, const char *key_kept)
{
    nlc_status status = add_network(s, &(nlc_options){.model = model});
    variant *kept = &s->variants[s->networks - 1], *plain = kept + 1;
    if (status >= 0 && key) status = add_network(s, &(nlc_options){.model = model});
    if (status < 0) return status;
    kept->options.cache_size = nlc_cache_size(kept->network);
    kept->options.cache = get(s, (int64_t)kept->options.cache_size, 1);
    if (key) functions_add(list, "nlc_cache_size", "call", 1, run_cache_size, plain);
    if (key) functions_add(list, key, "contact", (double)s->n.count, run_solve, plain);
    functions_add(list, key_kept, "contact", (double)s->n.count, run_solve, kept);
    return s->failed ? NLC_ERROR_MEMORY_SIZE : nlc_set_options(kept->network, &kept->options, NULL);
}

static void add_calls(function_scene *s, function_list *list)
{
    variant *v = &s->variants[0];
    const struct {
        const char *key;
        nlc_status (*call)(void *);
        void *context;
    } calls[] = {
        {"nlc_network_init", run_init, v},
        {"nlc_set_options", run_set_options, v},
        {"nlc_network_update", run_update, s},
        {"nlc_solve from zeros", run_solve, v},
        {"nlc_solve from its result", run_solve_again, v},
        {"nlc_predict", run_predict, s},
        {"nlc_sweep", run_sweep, v},
        {"nlc_energy", run_energy, s},
        {"nlc_tangent", run_tangent, s},
        {"nlc_tangent_inverse", run_tangent_inverse, s},
        {"nlc_tangent_bound", run_tangent_bound, s},
        {"nlc_assemble", run_assemble, s},
        {"nlc_assemble_sliding", run_assemble_sliding, s},
        {"nlc_assemble_turning", run_assemble_turning, s},
        {"nlc_contacts_from_pairs", run_pairs, s},
        {"nlc_contacts_from_lists", run_lists, s},
        {"nlc_reach", run_reach, s},
        {"nlc_carry", run_carry, s},
        {"nlc_order", run_order, s},
    };
    for (size_t k = 0; k < sizeof calls / sizeof *calls; k++)
        functions_add(list, calls[k].key, "contact", (double)s->n.count, calls[k].call, calls[k].context);
}

static const char *prepare(function_scene *s, function_list *list)
{
    if (s->n.count == 0) return "no contacts";
    s->particles = packing_particles(&s->p);
    s->memory_size = nlc_network_size(&s->particles, s->n.count, NULL);
    allocate(s);
    if (s->failed) return "out of memory";
    set_lists(s);
    set_positions(s);
    set_contacts(s);
    nlc_status status = add_network(s, &(nlc_options){.tolerance = 0});
    if (status >= 0) status = nlc_solve(first_network(s), s->force, s->nonlocal, s->n.overlap, normals(s), NULL);
    if (status >= 0) {
        memcpy(s->copy, s->nonlocal, (size_t)s->n.count * sizeof(double));
        add_calls(s, list);
        status = add_sweeps(s, list);
        if (status >= 0) status = add_kept(s, list, NLC_MODEL_GONZALEZ_CUITINO, NULL, "nlc_solve from zeros kept");
        if (status >= 0) status = add_kept(s, list, NLC_MODEL_SPHERE, "nlc_solve model sphere", "nlc_solve model sphere kept");
    }
    return status < 0 ? nlc_strerror(status) : NULL;
}

function_scene *functions_scene(function_list *list, const char *name, int32_t simd, char *error, size_t error_size)
{
    function_scene *s = calloc(1, sizeof *s);
    if (!s) {
        snprintf(error, error_size, "out of memory");
        return NULL;
    }
    s->simd = simd;
    if (packing_open(&s->p, &s->n, name, NEIGHBOURS_REACH, error, error_size) == 0) {
        const char *reason = prepare(s, list);
        if (!reason) return s;
        snprintf(error, error_size, "%s: %s", name, reason);
    }
    functions_scene_free(s);
    return NULL;
}

void functions_scene_size(const function_scene *s, const char **name, int64_t *particles, int64_t *contacts)
{
    *name = s->p.name;
    *particles = s->p.count;
    *contacts = s->n.count;
}

void functions_scene_free(function_scene *s)
{
    for (int k = 0; k < s->blocks; k++) free(s->block[k]);
    neighbours_free(&s->n);
    packing_free(&s->p);
    free(s);
}
