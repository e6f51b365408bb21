/* SPDX-License-Identifier: BSD-2-Clause */
/* bed_table.h - the table that bed/compact writes, and what is compared in it. */
#ifndef NLC_FIGURES_BED_TABLE_H
#define NLC_FIGURES_BED_TABLE_H

#include <stdbool.h>

enum { BED_ROWS = 4000, BED_SEEDS = 32 };

/* A state; the columns are explained in the file. */
typedef struct bed_row {
    char model[32], from[16];
    int seed, loaded;
    double density, load, x, y, imbalance;
    long contacts, status, warned;
} bed_row;

typedef struct bed_table {
    int rows, beds;
    double poured[BED_SEEDS]; /* relative densities */
    bed_row row[BED_ROWS];
} bed_table;

/* A model, what its beds were before, and how that is drawn. */
typedef struct bed_series {
    const char *model, *from, *name, *colour, *pale;
} bed_series;
extern const bed_series bed_hertz, bed_case_i, bed_case_i_there, bed_sphere_there;

/* On the punch, or on a wall, the mean of all four. */
typedef enum bed_quantity { BED_LOAD, BED_LATERAL } bed_quantity;

/* The table in a folder, *t zero before. */
bool bed_table_read(bed_table *t, const char *folder);

/* The state of the n-th bed, NULL: there is none at that density. */
const bed_row *bed_find(const bed_table *t, const bed_series *s, int n, double density);

/* Force [N] of the n-th bed, or its mean over all; NaN where there is no such state. */
double bed_force(const bed_table *t, const bed_series *s, int n, double density, bed_quantity q);
double bed_mean_force(const bed_table *t, const bed_series *s, double density, bed_quantity q);

/* D = force / Hertz' force - 1 of the n-th bed, or of the mean forces; NaN where there is none. */
double bed_discrepancy(const bed_table *t, const bed_series *s, int n, double density, bed_quantity q);
double bed_mean_discrepancy(const bed_table *t, const bed_series *s, double density, bed_quantity q);

#endif
