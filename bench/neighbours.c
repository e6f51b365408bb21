/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * neighbours.c - cell grids.
 *
 * Particles are sorted into levels, the radii of one level being within a factor of two, and every level has a grid of its
 * own with cells as wide as its particles' reach.  A particle looks into the cells around it on every level, so that a few
 * large particles do not make cells with thousands of small ones.
 */
#include "neighbours.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEVELS = 1000, /* more than the factors of two in the radii that can be read, 1e-100 to 1e100 */
    CELLS_PER_PARTICLE = 2,
    CELLS_PER_AXIS = 1 << 20,
    LAYERS_MAX = 32 /* cells to look at on either side; more only in a box that is much smaller than a particle */
};

/* A particle where the search reads it: beside the others of its cell. */
typedef struct item {
    double x[3], radius;
    int32_t index;
} item;

typedef struct grid {
    double radius;    /* of the largest particle */
    int64_t count;    /* particles */
    int64_t cells[3]; /* along each axis */
    double width[3];  /* of a cell */
    item *items;      /* [count] sorted by cell */
    int64_t *start;   /* [cells + 1] first item of each cell */
} grid;

typedef struct search {
    const packing *p;
    neighbours *list;
    int64_t capacity;
    double reach;
    double low[3], edge[3]; /* of the box; along an axis that is not periodic, of all centres */
    double (*x)[3];         /* centres, in the box */
    int *level;             /* [particles] the grid of each */
    grid *grids;
    int grid_count;
    char *error;
    size_t error_size;
} search;

/* Which cells of a grid a particle looks at along each axis. */
typedef struct window {
    int64_t first[3], last[3]; /* not wrapped: outside 0 ... cells-1 they belong to periodic images */
} window;

__attribute__((format(printf, 2, 3))) static int fail(search *s, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(s->error, s->error_size, format, arguments);
    va_end(arguments);
    return -1;
}

static int fail_memory(search *s)
{
    return fail(s, "out of memory");
}

static long long id(const search *s, int64_t k)
{
    return (long long)s->p->id[k];
}

/* ---- the list */

static int grow(search *s)
{
    neighbours *l = s->list;
    if (l->count < s->capacity) return 0;
    size_t n = s->capacity ? 2 * (size_t)s->capacity : 16 * (size_t)s->p->count + 64;
    void *i = realloc(l->i, n * sizeof l->i[0]);
    if (i) l->i = i;
    void *j = realloc(l->j, n * sizeof l->j[0]);
    if (j) l->j = j;
    void *overlap = realloc(l->overlap, n * sizeof l->overlap[0]);
    if (overlap) l->overlap = overlap;
    void *normal = realloc(l->normal, n * sizeof l->normal[0]);
    if (normal) l->normal = normal;
    if (!i || !j || !overlap || !normal) return fail_memory(s);
    s->capacity = (int64_t)n;
    return 0;
}

/* d: from i to j, not normalized */
static int append(search *s, int64_t i, int64_t j, double overlap, const double d[3], double length)
{
    neighbours *l = s->list;
    if (grow(s)) return -1;
    l->i[l->count] = (int32_t)i;
    l->j[l->count] = (int32_t)j;
    l->overlap[l->count] = overlap;
    for (int k = 0; k < 3; k++) l->normal[l->count][k] = d[k] / length;
    l->count++;
    return 0;
}

/* ---- building the grids */

static int place_particles(search *s)
{
    const packing *p = s->p;
    s->x = malloc((size_t)p->count * sizeof s->x[0]);
    s->level = malloc((size_t)p->count * sizeof s->level[0]);
    if (!s->x || !s->level) return fail_memory(s);
    for (int64_t k = 0; k < p->count; k++) packing_position(p, k, s->x[k]);
    for (int d = 0; d < 3; d++) {
        double low = s->x[0][d], high = low;
        for (int64_t k = 1; k < p->count; k++) {
            low = fmin(low, s->x[k][d]);
            high = fmax(high, s->x[k][d]);
        }
        s->low[d] = p->periodic[d] ? p->low[d] : low;
        s->edge[d] = p->periodic[d] ? p->high[d] - p->low[d] : high - low;
        if (!isfinite(s->edge[d])) return fail(s, "the particles are too far from each other");
    }
    return 0;
}

/* Gives every particle a level, and every level that has particles a grid. */
static int choose_levels(search *s)
{
    const packing *p = s->p;
    int number[LEVELS], smallest = 0;
    memset(number, -1, sizeof number);
    double least = p->radius[0];
    for (int64_t k = 1; k < p->count; k++) least = fmin(least, p->radius[k]);
    frexp(least, &smallest);
    double unit = ldexp(least, -smallest); /* so that radii a little above the smallest share its level */
    for (int64_t k = 0; k < p->count; k++) {
        int exponent;
        frexp(p->radius[k] / unit, &exponent);
        int l = exponent - smallest;
        if (number[l] < 0) number[l] = s->grid_count++;
        s->level[k] = number[l];
    }
    s->grids = calloc((size_t)s->grid_count, sizeof s->grids[0]);
    if (!s->grids) return fail_memory(s);
    for (int64_t k = 0; k < p->count; k++) {
        grid *g = &s->grids[s->level[k]];
        g->radius = fmax(g->radius, p->radius[k]);
        g->count++;
    }
    return 0;
}

/* Distance between centres below which two particles are on the list, rounded up a little for the sake of cell borders. */
static double range(const search *s, double radius1, double radius2)
{
    return (radius1 + radius2) * (1 + 0.5 * s->reach) * (1 + 1e-9);
}

/* Cells as wide as the reach, wider where a sparse packing would leave most of them empty. */
static void choose_cells(const search *s, grid *g)
{
    double wanted = range(s, g->radius, g->radius);
    double limit = (double)CELLS_PER_PARTICLE * (double)g->count + 1;
    for (int d = 0; d < 3; d++) g->cells[d] = (int64_t)fmax(1, fmin(CELLS_PER_AXIS, s->edge[d] / wanted));
    while ((double)g->cells[0] * (double)g->cells[1] * (double)g->cells[2] > limit) {
        int longest = g->cells[0] >= g->cells[1] ? 0 : 1;
        if (g->cells[2] > g->cells[longest]) longest = 2;
        g->cells[longest] -= g->cells[longest] / 8 + 1;
    }
    for (int d = 0; d < 3; d++) g->width[d] = s->edge[d] > 0 ? s->edge[d] / (double)g->cells[d] : wanted;
}

/* The cell along an axis; rounding may put a centre a little outside. */
static int64_t cell_along(const search *s, const grid *g, int axis, double x)
{
    double c = floor((x - s->low[axis]) / g->width[axis]);
    return (int64_t)fmax(0, fmin((double)(g->cells[axis] - 1), c));
}

static int64_t cell_at(const grid *g, const int64_t c[3])
{
    return (c[0] * g->cells[1] + c[1]) * g->cells[2] + c[2];
}

static int64_t cell_of(const search *s, const grid *g, const double x[3])
{
    int64_t c[3];
    for (int d = 0; d < 3; d++) c[d] = cell_along(s, g, d, x[d]);
    return cell_at(g, c);
}

static int allocate_grids(search *s)
{
    for (int k = 0; k < s->grid_count; k++) {
        grid *g = &s->grids[k];
        choose_cells(s, g);
        size_t cells = (size_t)(g->cells[0] * g->cells[1] * g->cells[2]);
        g->items = malloc((size_t)g->count * sizeof g->items[0]);
        g->start = calloc(cells + 2, sizeof g->start[0]);
        if (!g->items || !g->start) return fail_memory(s);
    }
    return 0;
}

/* Counting sort: start[c + 2] counts, then start[c + 1] is where cell c is filled next, and ends as its end. */
static void fill_grids(search *s)
{
    const packing *p = s->p;
    for (int64_t k = 0; k < p->count; k++) {
        grid *g = &s->grids[s->level[k]];
        g->start[cell_of(s, g, s->x[k]) + 2]++;
    }
    for (int l = 0; l < s->grid_count; l++) {
        grid *g = &s->grids[l];
        int64_t cells = g->cells[0] * g->cells[1] * g->cells[2];
        for (int64_t c = 2; c < cells + 2; c++) g->start[c] += g->start[c - 1];
    }
    for (int64_t k = 0; k < p->count; k++) {
        grid *g = &s->grids[s->level[k]];
        item *it = &g->items[g->start[cell_of(s, g, s->x[k]) + 1]++];
        memcpy(it->x, s->x[k], sizeof it->x);
        it->radius = p->radius[k];
        it->index = (int32_t)k;
    }
}

/* ---- searching them */

/* Of the images of a particle itself, the half with the first nonzero component positive. */
static bool is_positive(const double shift[3])
{
    for (int d = 0; d < 3; d++)
        if (shift[d] < 0 || shift[d] > 0) return shift[d] > 0;
    return false;
}

/* Particle i against the particles of one cell, shifted. */
static int search_cell(search *s, int64_t i, const grid *g, int64_t cell, const double shift[3])
{
    double x[3], radius = s->p->radius[i];
    for (int d = 0; d < 3; d++) x[d] = s->x[i][d] - shift[d];
    for (int64_t k = g->start[cell]; k < g->start[cell + 1]; k++) {
        const item *it = &g->items[k];
        if (it->index < i || (it->index == i && !is_positive(shift))) continue;
        double d[3] = {it->x[0] - x[0], it->x[1] - x[1], it->x[2] - x[2]};
        double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        double sum = radius + it->radius, most = range(s, radius, it->radius);
        if (square > most * most) continue;
        double distance = sqrt(square);
        if (!(distance - sum < 0.5 * s->reach * sum)) continue;
        if (!(distance > 1e-6 * sum))
            return fail(s, "particles %lld and %lld are in the same place", id(s, i), id(s, it->index));
        if (append(s, i, it->index, sum - distance, d, distance)) return -1;
    }
    return 0;
}

static int choose_window(search *s, int64_t i, const grid *g, window *w)
{
    double most = range(s, s->p->radius[i], g->radius);
    for (int d = 0; d < 3; d++) {
        int64_t c = cell_along(s, g, d, s->x[i][d]);
        double layers = ceil(most / g->width[d]);
        bool periodic = s->p->periodic[d];
        if (periodic && layers > LAYERS_MAX * fmax(1, (double)g->cells[d]))
            return fail(s, "the periodic box is much smaller than particle %lld", id(s, i));
        layers = fmin(layers, 2.0 * CELLS_PER_AXIS);
        w->first[d] = c - (int64_t)layers;
        w->last[d] = c + (int64_t)layers;
        if (periodic) continue;
        if (w->first[d] < 0) w->first[d] = 0;
        if (w->last[d] >= g->cells[d]) w->last[d] = g->cells[d] - 1;
    }
    return 0;
}

/* The cell c of an image wrapped into the grid, and how far the image is shifted. */
static int64_t wrap(int64_t c, int64_t cells, double edge, double *shift)
{
    int64_t image = c >= 0 ? c / cells : -((cells - 1 - c) / cells);
    *shift = (double)image * edge;
    return c - image * cells;
}

static int search_grid(search *s, int64_t i, const grid *g)
{
    window w;
    int64_t c[3], k[3];
    double shift[3];
    if (choose_window(s, i, g, &w)) return -1;
    for (c[0] = w.first[0]; c[0] <= w.last[0]; c[0]++) {
        k[0] = wrap(c[0], g->cells[0], s->edge[0], &shift[0]);
        for (c[1] = w.first[1]; c[1] <= w.last[1]; c[1]++) {
            k[1] = wrap(c[1], g->cells[1], s->edge[1], &shift[1]);
            for (c[2] = w.first[2]; c[2] <= w.last[2]; c[2]++) {
                k[2] = wrap(c[2], g->cells[2], s->edge[2], &shift[2]);
                if (search_cell(s, i, g, cell_at(g, k), shift)) return -1;
            }
        }
    }
    return 0;
}

static int search_pairs(search *s)
{
    for (int64_t i = 0; i < s->p->count; i++)
        for (int l = 0; l < s->grid_count; l++)
            if (search_grid(s, i, &s->grids[l])) return -1;
    s->list->pair_count = s->list->count;
    return 0;
}

static int search_walls(search *s)
{
    const packing *p = s->p;
    for (int64_t i = 0; i < p->count; i++) {
        for (int64_t w = 0; w < p->wall_count; w++) {
            const double *n = p->walls[w].normal, *at = p->walls[w].point, *x = p->x[i];
            double distance = (x[0] - at[0]) * n[0] + (x[1] - at[1]) * n[1] + (x[2] - at[2]) * n[2];
            if (!(distance - p->radius[i] < s->reach * p->radius[i])) continue;
            if (!(distance > 0)) return fail(s, "the centre of particle %lld is behind wall %lld", id(s, i), (long long)w + 1);
            /* the length of -1 turns the inward normal into that of the contact */
            if (append(s, i, p->count + w, p->radius[i] - distance, n, -1)) return -1;
        }
    }
    return 0;
}

static int run(search *s)
{
    if (!(s->reach >= 0 && s->reach <= NEIGHBOURS_REACH_MAX))
        return fail(s, "the reach is not between 0 and %g", NEIGHBOURS_REACH_MAX);
    if (s->p->count + s->p->wall_count > INT32_MAX) return fail(s, "more than 2^31 - 1 particles and walls");
    if (place_particles(s) || choose_levels(s) || allocate_grids(s)) return -1;
    fill_grids(s);
    if (grow(s) || search_pairs(s)) return -1;
    return search_walls(s);
}

int neighbours_find(neighbours *list, const packing *p, double reach, char *error, size_t error_size)
{
    search s = {.p = p, .list = list, .reach = reach, .error = error, .error_size = error_size};
    memset(list, 0, sizeof *list);
    int status = run(&s);
    for (int l = 0; l < s.grid_count && s.grids; l++) {
        free(s.grids[l].items);
        free(s.grids[l].start);
    }
    free(s.grids);
    free(s.level);
    free(s.x);
    return status;
}

void neighbours_free(neighbours *list)
{
    free(list->i);
    free(list->j);
    free(list->overlap);
    free(list->normal);
    memset(list, 0, sizeof *list);
}

void neighbours_branch(const neighbours *list, const packing *p, int64_t contact, double b[3])
{
    int32_t i = list->i[contact], j = list->j[contact];
    double length = p->radius[i] + (j < p->count ? p->radius[j] : 0) - list->overlap[contact];
    for (int d = 0; d < 3; d++) b[d] = length * list->normal[contact][d];
}

void neighbours_stiffness(const neighbours *list, const packing *p, double *stiffness)
{
    for (int64_t c = 0; c < list->count; c++) {
        const int32_t i = list->i[c], j = list->j[c];
        const bool wall = j >= p->count;
        const nlc_material a = p->materials[p->material[i]];
        const nlc_material b = p->materials[wall ? p->wall_material[j - p->count] : p->material[j]];
        stiffness[c] = nlc_hertz_stiffness(a.young, a.poisson, p->radius[i], b.young, b.poisson, wall ? INFINITY : p->radius[j]);
    }
}
