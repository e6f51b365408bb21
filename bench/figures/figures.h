/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * figures.h - the figures of Gonzalez and Cuitino (2012), [GC], and of [MC].  README says what each of them shows.
 */
#ifndef NLC_FIGURES_FIGURES_H
#define NLC_FIGURES_FIGURES_H

#include <stdbool.h>
#include <stdio.h>

#include "cell.h"
#include "line_chart.h"

#define PI 3.14159265358979323846

typedef struct figure {
    const char *name; /* of its files, without a suffix */
    bool (*draw)(struct figure *f);
    line_chart chart;
    FILE *numbers;
    const char *bench; /* the folder of the tables */
    const char *beds;  /* the folder of what bed/compact writes */
    const char *output;
} figure;

/* Each fills the chart and tells its numbers; false: something failed, and a message says what. */
bool surface(figure *f);          /* Figs. 2 and A2 */
bool rubber_sphere(figure *f);    /* Fig. 7 */
bool lateral_plates(figure *f);   /* Fig. 8 */
bool cubic_crystals(figure *f);   /* Fig. 10 */
bool rotated_square(figure *f);   /* Fig. 11 */
bool close_packed(figure *f);     /* Fig. 12 */
bool preloaded_square(figure *f); /* Fig. 13 */
bool preloaded_forces(figure *f); /* Fig. 14 */
bool hydrostatic(figure *f);      /* Fig. 16 */
bool die(figure *f);              /* Fig. 17 */
bool bed_pictures(figure *f);     /* Figs. 18 and 19, the beds; writes its picture itself */
bool bed_loads(figure *f);        /* Fig. 19 */

/* A message; false.  A file of the figure to be written: NULL or false, and a message, if that fails. */
bool fail_figure(const figure *f, const char *text);
FILE *figure_open(const figure *f, const char *suffix);
bool figure_close(const figure *f, FILE *out);

/* Those of Brodu, Dijksman and Behringer (2015), [MC], from the runs in bench/hydrogel. */
bool top_force(figure *f);          /* Fig. 3, and Table I */
bool force_distribution(figure *f); /* Fig. 4 */
bool coordination(figure *f);       /* Fig. 5 */
bool scaling_law(figure *f);        /* Fig. 6 */

/* A line of numbers.csv: a result, NaN if there is none, and the paper's number, NaN where it has none. */
void tell(const figure *f, const char *what, double value, double paper);

/* Tatara's rubber sphere: m, Pa. */
#define RUBBER_RADIUS .01
#define RUBBER_YOUNG 1.85e6
#define RUBBER_POISSON .46

/*
 * Marks from a table (reference_table.h) at rubber's nu as the next curve of the last panel: the force of a group [N], or over
 * Hertz' force of that overlap if relative.  x is eps - from.  young: the modulus that goes with the table [Pa].
 */
typedef struct marks {
    const char *table, *name, *colour;
    int group;
    bool relative;
    double from, young;
} marks;
bool add_marks(figure *f, const marks *m);

/* Colours: of what, and of nu. */
#define COLOUR_HERTZ "#888888"
#define COLOUR_CASE_I "#e58a0c"
#define COLOUR_CASE_II "#3a8a5f"
#define COLOUR_TERMS "#c23a4b"
#define COLOUR_SPHERE "#35133d"
#define COLOUR_ELEMENTS "#1c6fb5"
#define COLOUR_EXACT "#111111"
enum { POISSONS = 6 };
extern const char *const poisson_colour[POISSONS];

/* The two nonlocal models, and how they are drawn where the colour is that of nu. */
typedef struct figure_model {
    int32_t number;
    const char *name, *colour;
    line_style style;
} figure_model;
enum { MODELS = 2 };
extern const figure_model models[MODELS];
void legend_of_models(figure *f);                          /* by colour, with Hertz */
void legend_of_poissons(figure *f, const double *poisson); /* by colour, models by style */

#endif
