/* SPDX-License-Identifier: BSD-2-Clause */
/* vtk.c - writes the legacy format, version 3.0: header of five lines, points, lines, cell data, point data. */
#include "vtk.h"

#include <math.h>
#include <stdbool.h>

static bool is_shown(const picture_input *in, int64_t c)
{
    return in->n->overlap[c] > 0 || in->hertz->force[c] > 0 || (in->nonlocal && in->nonlocal->force[c] > 0);
}

/* Where the line of contact c ends.  Returns whether that is a point of its own and not the centre of j. */
static bool find_end(const picture_input *in, int64_t c, double end[3])
{
    const packing *p = in->p;
    int32_t i = in->n->i[c], j = in->n->j[c];
    double b[3], other[3], distance = 0;
    packing_position(p, i, end);
    neighbours_branch(in->n, p, c, b);
    for (int d = 0; d < 3; d++) end[d] += b[d];
    if (j >= p->count) return true;
    packing_position(p, j, other);
    for (int d = 0; d < 3; d++) distance = fmax(distance, fabs(end[d] - other[d]));
    return distance > 1e-3 * p->radius[j];
}

static void write_point(FILE *out, const double x[3])
{
    fprintf(out, "%.10g %.10g %.10g\n", x[0], x[1], x[2]);
}

static void count(const picture_input *in, int64_t *lines, int64_t *ends)
{
    double end[3];
    *lines = *ends = 0;
    for (int64_t c = 0; c < in->n->count; c++) {
        if (!is_shown(in, c)) continue;
        ++*lines;
        *ends += find_end(in, c, end);
    }
}

static void write_points(FILE *out, const picture_input *in, int64_t ends)
{
    double x[3];
    fprintf(out, "POINTS %lld double\n", (long long)(in->p->count + ends));
    for (int64_t k = 0; k < in->p->count; k++) {
        packing_position(in->p, k, x);
        write_point(out, x);
    }
    for (int64_t c = 0; c < in->n->count; c++)
        if (is_shown(in, c) && find_end(in, c, x)) write_point(out, x);
}

static void write_lines(FILE *out, const picture_input *in, int64_t lines)
{
    double end[3];
    int64_t next = in->p->count;
    fprintf(out, "LINES %lld %lld\n", (long long)lines, (long long)(3 * lines));
    for (int64_t c = 0; c < in->n->count; c++) {
        if (!is_shown(in, c)) continue;
        int64_t to = find_end(in, c, end) ? next++ : in->n->j[c];
        fprintf(out, "2 %d %lld\n", (int)in->n->i[c], (long long)to);
    }
}

/* One number for each line. */
static void write_cell_data(FILE *out, const picture_input *in, const char *name, const double *value)
{
    fprintf(out, "SCALARS %s double 1\nLOOKUP_TABLE default\n", name);
    for (int64_t c = 0; c < in->n->count; c++)
        if (is_shown(in, c)) fprintf(out, "%.9g\n", value[c]);
}

static void write_radius(FILE *out, const picture_input *in, int64_t ends)
{
    fprintf(out, "POINT_DATA %lld\nSCALARS radius double 1\nLOOKUP_TABLE default\n", (long long)(in->p->count + ends));
    for (int64_t k = 0; k < in->p->count; k++) fprintf(out, "%.10g\n", in->p->radius[k]);
    for (int64_t k = 0; k < ends; k++) fputs("0\n", out);
}

void vtk_write(FILE *out, const picture_input *in)
{
    int64_t lines, ends;
    count(in, &lines, &ends);
    /* the format allows 256 characters for the title */
    fprintf(out, "# vtk DataFile Version 3.0\n%.200s: contact forces\nASCII\nDATASET POLYDATA\n", in->p->name);
    write_points(out, in, ends);
    if (lines > 0) {
        write_lines(out, in, lines);
        fprintf(out, "CELL_DATA %lld\n", (long long)lines);
        write_cell_data(out, in, "force_hertz", in->hertz->force);
        if (in->nonlocal) write_cell_data(out, in, "force_nonlocal", in->nonlocal->force);
        write_cell_data(out, in, "overlap", in->n->overlap);
        if (in->nonlocal) write_cell_data(out, in, "nonlocal_displacement", in->nonlocal->nonlocal);
    }
    write_radius(out, in, ends);
}
