/* SPDX-License-Identifier: BSD-2-Clause */
/* scene.c - small scenes to test the network functions on, and an independent solution of them. */
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const long double pi = 3.141592653589793238462643383279502884L;

static void *resized(void *p, int64_t count, size_t size)
{
    p = realloc(p, (size_t)(count > 0 ? count : 1) * size);
    if (!p) abort();
    return p;
}

/* Room for one more element; the arrays are small, or grow by doubling at powers of two. */
static void *grown(void *p, int64_t count, size_t size)
{
    if ((count & (count - 1)) != 0) return p;
    return resized(p, 2 * count + 1, size);
}

void scene_init(scene *s)
{
    memset(s, 0, sizeof *s);
    s->options.struct_size = sizeof s->options;
}

void scene_free(scene *s)
{
    free(s->radius);
    free(s->material);
    free(s->wall_material);
    free(s->rows);
    free(s->i);
    free(s->j);
    free(s->overlap);
    free(s->normal);
    free(s->force);
    free(s->nonlocal);
    free(s->memory);
    scene_init(s);
}

int32_t scene_material(scene *s, double young, double poisson)
{
    s->rows = grown(s->rows, s->materials, sizeof *s->rows);
    s->rows[s->materials] = (nlc_material){young, poisson};
    return (int32_t)s->materials++;
}

int32_t scene_particle(scene *s, double radius, int32_t material)
{
    s->radius = grown(s->radius, s->particles, sizeof *s->radius);
    s->material = grown(s->material, s->particles, sizeof *s->material);
    s->radius[s->particles] = radius;
    s->material[s->particles] = material;
    return (int32_t)s->particles++;
}

int32_t scene_wall(scene *s, int32_t material)
{
    s->wall_material = grown(s->wall_material, s->walls, sizeof *s->wall_material);
    s->wall_material[s->walls] = material;
    return (int32_t)s->walls++;
}

void scene_contact(scene *s, int32_t i, int32_t j, double overlap, double x, double y, double z)
{
    const int64_t c = s->contacts++;
    const double length = sqrt(x * x + y * y + z * z);
    s->i = grown(s->i, c, sizeof *s->i);
    s->j = grown(s->j, c, sizeof *s->j);
    s->overlap = grown(s->overlap, c, sizeof *s->overlap);
    s->normal = grown(s->normal, c, 3 * sizeof *s->normal);
    s->i[c] = i;
    s->j[c] = j;
    s->overlap[c] = overlap;
    s->normal[3 * c] = x / length;
    s->normal[3 * c + 1] = y / length;
    s->normal[3 * c + 2] = z / length;
}

nlc_particles scene_view(const scene *s)
{
    return (nlc_particles){.struct_size = sizeof(nlc_particles),
                           .count = s->particles,
                           .radius = s->radius,
                           .material = s->material,
                           .materials = s->rows,
                           .material_count = s->materials,
                           .material_size = sizeof(nlc_material),
                           .wall_material = s->wall_material,
                           .wall_count = s->walls};
}

nlc_status scene_build(scene *s)
{
    const nlc_particles view = scene_view(s);
    const size_t size = nlc_network_size(&view, s->contacts, &s->options);
    s->memory = resized(s->memory, (int64_t)size, 1);
    s->force = resized(s->force, s->contacts, sizeof *s->force);
    s->nonlocal = resized(s->nonlocal, s->contacts, sizeof *s->nonlocal);
    for (int64_t c = 0; c < s->contacts; c++) s->force[c] = s->nonlocal[c] = 0;
    return nlc_network_init(&s->network, s->memory, size, &view, s->i, s->j, s->contacts, &s->options, 0);
}

nlc_status scene_solve(scene *s, nlc_info *info)
{
    if (!s->network) {
        nlc_status status = scene_build(s);
        if (status != NLC_OK) return status;
    }
    if (info) info->struct_size = sizeof *info;
    return nlc_solve(s->network, s->force, s->nonlocal, s->overlap, s->normal, info);
}

double scene_total(const scene *s)
{
    double sum = 0;
    for (int64_t c = 0; c < s->contacts; c++) sum += s->force[c];
    return sum;
}

/* Neighbours in half of all directions, in units in which the cell's edge is 2. */
static const int sc[][3] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
static const int bcc[][3] = {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
static const int fcc[][3] = {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}};

void scene_cell(scene *s, lattice type, double R, double young, double poisson, const double stretch[3])
{
    const int(*direction)[3] = type == SIMPLE_CUBIC ? sc : type == BODY_CENTRED ? bcc : fcc;
    const int count = type == SIMPLE_CUBIC ? 3 : type == BODY_CENTRED ? 7 : 6;
    const double edge = R * (type == SIMPLE_CUBIC ? 2 : type == BODY_CENTRED ? 4 / sqrt(3) : 4 / sqrt(2));
    const int32_t p = scene_particle(s, R, scene_material(s, young, poisson));
    for (int d = 0; d < count; d++) {
        double v[3];
        for (int x = 0; x < 3; x++) v[x] = edge / 2 * stretch[x] * direction[d][x];
        scene_contact(s, p, p, 2 * R - sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), v[0], v[1], v[2]);
    }
}

void scene_crystal(scene *s, int n, double R, double young, double poisson, const double stretch[3])
{
    const int32_t m = scene_material(s, young, poisson);
    for (int k = 0; k < n * n * n; k++) scene_particle(s, R, m);
    for (int z = 0; z < n; z++)
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++) {
                const int k = (z * n + y) * n + x;
                scene_contact(s, k, (z * n + y) * n + (x + 1) % n, 2 * R * (1 - stretch[0]), 1, 0, 0);
                scene_contact(s, k, (z * n + (y + 1) % n) * n + x, 2 * R * (1 - stretch[1]), 0, 1, 0);
                scene_contact(s, k, ((z + 1) % n * n + y) * n + x, 2 * R * (1 - stretch[2]), 0, 0, 1);
            }
}

/* Number of the sphere at a lattice point, in half edges; -1 where there is none. */
static int32_t lattice_point(lattice type, int n, int x, int y, int z)
{
    const int m = 2 * n, u = (x + m) % m, v = (y + m) % m, w = (z + m) % m, odd = u % 2 + v % 2 + w % 2;
    const int32_t cell = (w / 2 * n + v / 2) * n + u / 2, cells = n * n * n;
    if (type == SIMPLE_CUBIC) return odd == 0 ? cell : -1;
    if (type == BODY_CENTRED) return odd == 0 ? cell : odd == 3 ? cell + cells : -1;
    return odd == 0 ? cell : odd == 2 ? cell + cells * (u % 2 == 0 ? 1 : v % 2 == 0 ? 2 : 3) : -1;
}

void scene_lattice(scene *s, lattice type, int n, double young, double poisson, double eps, double noise, rng *g)
{
    const int(*direction)[3] = type == SIMPLE_CUBIC ? sc : type == BODY_CENTRED ? bcc : fcc;
    const int count = type == SIMPLE_CUBIC ? 3 : type == BODY_CENTRED ? 7 : 6, basis = type == FACE_CENTRED ? 4 : type == BODY_CENTRED ? 2 : 1;
    const double half = (type == SIMPLE_CUBIC ? 1 : type == BODY_CENTRED ? 2 / sqrt(3) : 2 / sqrt(2)) * (1 - eps);
    const int32_t m = scene_material(s, young, poisson);
    for (int k = 0; k < basis * n * n * n; k++) scene_particle(s, 1, m);
    for (int z = 0; z < 2 * n; z++)
        for (int y = 0; y < 2 * n; y++)
            for (int x = 0; x < 2 * n; x++) {
                const int32_t i = lattice_point(type, n, x, y, z);
                for (int d = 0; i >= 0 && d < count; d++) {
                    const int *v = direction[d];
                    const double distance = half * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
                    scene_contact(s, i, lattice_point(type, n, x + v[0], y + v[1], z + v[2]),
                                  2 - distance + rng_uniform(g, -noise, noise), v[0], v[1], v[2]);
                }
            }
}

void scene_cluster(scene *s, rng *g, int count, double apart)
{
    const int32_t soft = scene_material(s, 1e6, 0.3), hard = scene_material(s, 3e6, 0.45);
    const int32_t rigid = scene_material(s, INFINITY, 0);
    const int32_t centre = scene_particle(s, 1e-3, soft);
    double *n = resized(0, count, 3 * sizeof *n);
    for (int k = 0; k < count; k++) {
        bool good = false;
        while (!good) {
            rng_unit(g, n + 3 * k);
            good = true;
            for (int d = 0; d < k; d++) {
                const double *a = n + 3 * k, *b = n + 3 * d;
                good &= a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < cos(apart);
            }
        }
        scene_particle(s, rng_uniform(g, 0.5e-3, 2e-3), k % 5 == 4 ? rigid : k % 2 ? soft : hard);
    }
    const int32_t wall = (int32_t)s->particles + scene_wall(s, rigid);
    for (int k = 0; k < count; k++) {
        const double *v = n + 3 * k, sign = k % 3 ? 1 : -1;
        scene_contact(s, sign > 0 ? centre : k + 1, sign > 0 ? k + 1 : centre, rng_uniform(g, -5e-6, 2e-5), sign * v[0],
                      sign * v[1], sign * v[2]);
        if (k % 5 != 4) scene_contact(s, k + 1, wall, rng_uniform(g, 0, 2e-5), v[0], v[1], v[2]);
    }
    free(n);
}

/* Shortest vector from particle a to an image of b; right for boxes of more than two diameters. */
static void shortest(const packing *p, int64_t a, int64_t b, double v[3])
{
    for (int x = 0; x < 3; x++) {
        const double edge = p->high[x] - p->low[x];
        v[x] = p->x[b][x] - p->x[a][x];
        if (p->periodic[x]) v[x] -= edge * round(v[x] / edge);
    }
}

void scene_packing(scene *s, const char *name, double reach)
{
    char path[4096], error[PACKING_ERROR_SIZE];
    packing p;
    snprintf(path, sizeof path, "%s/bench/data/%s", NLC_SOURCE_DIR, name);
    if (packing_read(&p, path, false, error, sizeof error) != 0) {
        fprintf(stderr, "%s\n", error);
        abort();
    }
    for (int64_t m = 0; m < p.material_count; m++) scene_material(s, p.materials[m].young, p.materials[m].poisson);
    for (int64_t k = 0; k < p.count; k++) scene_particle(s, p.radius[k], p.material[k]);
    for (int64_t w = 0; w < p.wall_count; w++) scene_wall(s, p.wall_material[w]);
    for (int64_t a = 0; a < p.count; a++) {
        double v[3];
        for (int64_t b = a + 1; b < p.count; b++) {
            shortest(&p, a, b, v);
            const double sum = p.radius[a] + p.radius[b];
            const double overlap = sum - sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            if (overlap > -reach * sum / 2) scene_contact(s, (int32_t)a, (int32_t)b, overlap, v[0], v[1], v[2]);
        }
        for (int64_t w = 0; w < p.wall_count; w++) {
            const double *n = p.walls[w].normal;
            double height = 0;
            for (int x = 0; x < 3; x++) height += n[x] * (p.x[a][x] - p.walls[w].point[x]);
            if (p.radius[a] - height > -reach * p.radius[a])
                scene_contact(s, (int32_t)a, (int32_t)(p.count + w), p.radius[a] - height, -n[0], -n[1], -n[2]);
        }
    }
    packing_free(&p);
}

/* ------------------------------------------------------------------------------------------------------------ oracle -- */

typedef struct term {
    int64_t c, d; /* displacement at c by the force of d */
    long double coefficient;
} term;

typedef struct side {
    int64_t contact;
    long double n[3];
} side;

static long double angle(const long double *a, const long double *b)
{
    const long double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return atan2l(sqrtl(x * x + y * y + z * z), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

static long double coefficient(const scene *s, int32_t particle, long double theta)
{
    const nlc_material m = s->rows[s->material[particle]];
    const long double sine = sinl(theta / 2), nu = m.poisson;
    return (1 + nu) / (4 * pi * s->radius[particle] * m.young) *
           (-2 * (1 - nu) - 2 * (1 - 2 * nu) * sine + (7 - 8 * nu) * sine * sine) / sine;
}

static int64_t terms_of(const scene *s, const side *sides, int64_t count, int32_t particle, term *terms)
{
    int64_t n = 0;
    if (isinf(s->rows[s->material[particle]].young)) return 0;
    for (int64_t a = 0; a < count; a++)
        for (int64_t b = 0; b < count; b++)
            if (a != b)
                terms[n++] = (term){sides[a].contact, sides[b].contact,
                                    coefficient(s, particle, angle(sides[a].n, sides[b].n))};
    return n;
}

static term *all_terms(const scene *s, double factor, int64_t *count)
{
    side **sides = resized(0, s->particles, sizeof *sides);
    int64_t *z = resized(0, s->particles, sizeof *z);
    term *terms = 0;
    *count = 0;
    for (int64_t k = 0; k < s->particles; k++) sides[k] = 0, z[k] = 0;
    for (int64_t c = 0; c < s->contacts; c++)
        for (int end = 0; end < 2; end++) {
            const int32_t k = end ? s->j[c] : s->i[c];
            if (k >= s->particles) continue;
            sides[k] = grown(sides[k], z[k], sizeof *sides[k]);
            for (int x = 0; x < 3; x++) sides[k][z[k]].n[x] = (end ? -1 : 1) * (long double)s->normal[3 * c + x];
            sides[k][z[k]++].contact = c;
        }
    for (int64_t k = 0; k < s->particles; k++) {
        terms = resized(terms, *count + z[k] * z[k], sizeof *terms);
        const int64_t added = terms_of(s, sides[k], z[k], (int32_t)k, terms + *count);
        for (int64_t t = 0; t < added; t++) terms[*count + t].coefficient *= factor;
        *count += added;
        free(sides[k]);
    }
    free(sides);
    free(z);
    return terms;
}

long double scene_stiffness(const scene *s, int64_t c)
{
    long double compliance = 0, curvature = 0;
    for (int end = 0; end < 2; end++) {
        const int64_t k = end ? s->j[c] : s->i[c];
        const nlc_material m = s->rows[k < s->particles ? s->material[k] : s->wall_material[k - s->particles]];
        if (!isinf(m.young)) compliance += (1 - (long double)m.poisson * m.poisson) / m.young;
        if (k < s->particles) curvature += 1 / (long double)s->radius[k];
    }
    return 4 / (3 * compliance * sqrtl(curvature));
}

void scene_terms(const scene *s, int64_t *count, int64_t **c, int64_t **d, long double **w)
{
    term *terms = all_terms(s, 1, count);
    *c = resized(0, *count, sizeof **c);
    *d = resized(0, *count, sizeof **d);
    *w = resized(0, *count, sizeof **w);
    for (int64_t t = 0; t < *count; t++) {
        (*c)[t] = terms[t].c;
        (*d)[t] = terms[t].d;
        (*w)[t] = terms[t].coefficient;
    }
    free(terms);
}

static long double law(long double k, long double x)
{
    return x > 0 ? k * x * sqrtl(x) : 0;
}

long double scene_oracle(const scene *s, double factor, long double *force)
{
    int64_t count;
    term *terms = all_terms(s, factor, &count);
    long double *g = resized(0, s->contacts, sizeof *g), *k = resized(0, s->contacts, sizeof *k);
    long double change = 1, largest = 0;
    for (int64_t c = 0; c < s->contacts; c++) {
        k[c] = scene_stiffness(s, c);
        force[c] = law(k[c], s->overlap[c]);
    }
    for (int sweep = 0; sweep < 5000 && change > 1e-18L; sweep++) {
        change = largest = 0;
        for (int64_t c = 0; c < s->contacts; c++) g[c] = 0;
        for (int64_t t = 0; t < count; t++) g[terms[t].c] += terms[t].coefficient * force[terms[t].d];
        for (int64_t c = 0; c < s->contacts; c++) {
            const long double p = law(k[c], s->overlap[c] + g[c]);
            change = fmaxl(change, fabsl(p - force[c]));
            largest = fmaxl(largest, p);
            force[c] = p;
        }
        if (largest > 0) change /= largest;
    }
    free(terms);
    free(g);
    free(k);
    return change;
}

double scene_error(const scene *s, const double *force, const long double *exact)
{
    long double worst = 0, *largest = resized(0, s->particles + s->walls, sizeof *largest);
    for (int64_t k = 0; k < s->particles + s->walls; k++) largest[k] = 0;
    for (int64_t c = 0; c < s->contacts; c++) {
        largest[s->i[c]] = fmaxl(largest[s->i[c]], exact[c]);
        largest[s->j[c]] = fmaxl(largest[s->j[c]], exact[c]);
    }
    for (int64_t k = s->particles; k < s->particles + s->walls; k++) largest[k] = 0;
    for (int64_t c = 0; c < s->contacts; c++) {
        const long double scale = fmaxl(largest[s->i[c]], largest[s->j[c]]), error = fabsl(force[c] - exact[c]);
        worst = fmaxl(worst, error > 0 ? error / scale : 0);
    }
    free(largest);
    return (double)worst;
}
