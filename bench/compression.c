/* SPDX-License-Identifier: BSD-2-Clause */
/* compression.c - a slow compression of a packing. */
#include "compression.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lattice.h"

static void set_stiffness(compression *s)
{
    neighbours_stiffness(&s->n, &s->p, s->stiffness);
    for (int64_t c = 0; c < s->n.count; c++) s->largest = fmax(s->largest, s->n.overlap[c]);
}

int compression_open(compression *s, const char *name, char *error, size_t error_size)
{
    memset(s, 0, sizeof *s);
    if (packing_open(&s->p, &s->n, name, NEIGHBOURS_REACH, error, error_size)) return -1;
    const size_t contacts = (size_t)s->n.count + 1, bodies = (size_t)(s->p.count + s->p.wall_count) + 1;
    s->particles = packing_particles(&s->p);
    s->memory_size = nlc_network_size(&s->particles, s->n.count, NULL);
    s->memory = malloc(s->memory_size + 1);
    s->stiffness = calloc(contacts, sizeof(double));
    s->overlap = calloc(contacts, sizeof(double));
    s->scale = calloc(bodies, sizeof(double));
    const char *reason = s->n.count == 0 ? "no contacts" : NULL;
    if (!s->memory || !s->stiffness || !s->overlap || !s->scale) reason = "out of memory";
    if (!reason) {
        const nlc_status status = nlc_network_init(&s->network, s->memory, s->memory_size, &s->particles, s->n.i, s->n.j,
                                                   s->n.count, NULL, NULL);
        if (status < 0) reason = nlc_strerror(status);
    }
    if (reason) snprintf(error, error_size, "%s: %s", name, reason);
    else set_stiffness(s);
    return reason ? -1 : 0;
}

void compression_free(compression *s)
{
    free(s->stiffness);
    free(s->overlap);
    free(s->scale);
    free(s->memory);
    neighbours_free(&s->n);
    packing_free(&s->p);
    memset(s, 0, sizeof *s);
}

void compression_set_step(compression *s, int step)
{
    for (int64_t c = 0; c < s->n.count; c++)
        s->overlap[c] = s->n.overlap[c] - COMPRESSION_STEP * s->largest * (s->steps - step) * (0.5 + (double)(c % 3) / 6);
}

void compression_forces(const compression *s, double *force, const double *g)
{
    for (int64_t c = 0; c < s->n.count; c++) force[c] = nlc_hertz_force(s->stiffness[c], s->overlap[c] + g[c]);
}

force_error compression_error(compression *s, const double *force, const double *exact)
{
    double largest = 0, sum = 0;
    int64_t count = 0;
    memset(s->scale, 0, (size_t)(s->p.count + s->p.wall_count) * sizeof *s->scale);
    for (int64_t c = 0; c < s->n.count; c++) {
        const int32_t i = s->n.i[c], j = s->n.j[c];
        s->scale[i] = fmax(s->scale[i], exact[c]);
        if (j < s->p.count) s->scale[j] = fmax(s->scale[j], exact[c]);
    }
    for (int64_t c = 0; c < s->n.count; c++) {
        const double scale = fmax(s->scale[s->n.i[c]], s->scale[s->n.j[c]]);
        const double error = scale > 0 ? fabs(force[c] - exact[c]) / scale : 0;
        largest = error <= largest ? largest : error; /* NaN stays */
        if (!(exact[c] > 0)) continue;
        sum += error * error;
        count++;
    }
    return (force_error){.largest = largest, .mean_square = count > 0 ? sqrt(sum / (double)count) : 0};
}
