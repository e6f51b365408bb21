/* SPDX-License-Identifier: BSD-2-Clause */
#include "bed_table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "figures.h"

enum { LINE = 4096 };

const bed_series bed_hertz = {"hertz", "itself", "Hertz", COLOUR_HERTZ, "#dddddd"};
const bed_series bed_case_i = {"gonzalez-cuitino", "itself", "Case I", COLOUR_CASE_I, "#f7dcb4"};
const bed_series bed_case_i_there = {"gonzalez-cuitino", "hertz", "Case I from Hertz's bed", COLOUR_CASE_I, NULL};
const bed_series bed_sphere_there = {"sphere", "hertz", "exact sphere from Hertz's bed", COLOUR_SPHERE, NULL};

bool bed_table_read(bed_table *t, const char *folder)
{
    char text[LINE];
    if (snprintf(text, sizeof text, "%s/bed.csv", folder) >= LINE) return false;
    FILE *in = fopen(text, "r");
    if (!in) return false;
    while (t->rows < BED_ROWS && t->beds < BED_SEEDS && fgets(text, sizeof text, in)) {
        bed_row *r = &t->row[t->rows];
        t->beds += sscanf(text, "# seed %*d: poured to height %*f m, relative density %lf", &t->poured[t->beds]) == 1;
        t->rows += sscanf(text, "%d,%31[^,],%15[^,],%lf,%d,%lf,%lf,%lf,%ld,%*f,%lf,%ld,%ld", &r->seed, r->model, r->from,
                          &r->density, &r->loaded, &r->load, &r->x, &r->y, &r->contacts, &r->imbalance, &r->status,
                          &r->warned) == 12;
    }
    const bool good = feof(in) && t->beds > 0;
    fclose(in);
    return good;
}

const bed_row *bed_find(const bed_table *t, const bed_series *s, int n, double density)
{
    for (int k = 0; k < t->rows; k++) {
        const bed_row *r = &t->row[k];
        if (r->seed == t->row[0].seed + n && fabs(r->density - density) < 1e-6 && strcmp(r->model, s->model) == 0 &&
            strcmp(r->from, s->from) == 0)
            return r;
    }
    return NULL;
}

double bed_force(const bed_table *t, const bed_series *s, int n, double density, bed_quantity q)
{
    const bed_row *r = bed_find(t, s, n, density);
    if (!r) return NAN;
    if (!r->loaded) return 0;
    return q == BED_LOAD ? r->load : (r->x + r->y) / 2;
}

double bed_mean_force(const bed_table *t, const bed_series *s, double density, bed_quantity q)
{
    double sum = 0;
    for (int n = 0; n < t->beds; n++) sum += bed_force(t, s, n, density, q);
    return sum / t->beds;
}

double bed_discrepancy(const bed_table *t, const bed_series *s, int n, double density, bed_quantity q)
{
    const double before = bed_force(t, &bed_hertz, n, density, q);
    return before > 0 ? bed_force(t, s, n, density, q) / before - 1 : NAN;
}

double bed_mean_discrepancy(const bed_table *t, const bed_series *s, double density, bed_quantity q)
{
    const double before = bed_mean_force(t, &bed_hertz, density, q);
    return before > 0 ? bed_mean_force(t, s, density, q) / before - 1 : NAN;
}
