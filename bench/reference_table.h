/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * reference_table.h - forces on a sphere between rigid plates and other spheres that were computed without this library.
 *
 * A text file.  Lines that begin with '#' are comments, but for
 *
 *     # contact: X Y Z group G     a plate in the direction X Y Z, of any length; G = 1 or 2
 *     # contact: X Y Z group G sphere    not a plate but a second sphere, at most one
 *     # unit: F                    forces are divided by F; 1 if there is no such line
 *     # finite elements, ...       has an error worth mentioning
 *     # finite strain: ...         the solid is not that of linear elasticity
 *
 * Then a line with the names of the columns, and comma-separated numbers.  nu, eps_1, force_1 are needed, with a second group
 * eps_2 and force_2, with a second sphere radius_ratio, young_ratio (inf: rigid) and other_nu; other columns are not looked at.
 * eps is the overlap of a contact over the radius, the force that of one contact of the group over E R^2.
 */
#ifndef NLC_BENCH_REFERENCE_TABLE_H
#define NLC_BENCH_REFERENCE_TABLE_H

#include <stdbool.h>
#include <stddef.h>

enum { REFERENCE_CONTACTS = 16, REFERENCE_GROUPS = 2, REFERENCE_NAME = 48 };

typedef struct reference_row {
    double nu;
    double eps[REFERENCE_GROUPS], force[REFERENCE_GROUPS];
    double radius_ratio, young_ratio, other_nu; /* second sphere over first */
} reference_row;

typedef struct reference_table {
    char name[REFERENCE_NAME]; /* the last folder and the file without its suffix: fe/uniaxial */
    int contacts, groups;
    double normal[REFERENCE_CONTACTS][3]; /* unit vectors */
    int group[REFERENCE_CONTACTS];        /* from 0 */
    bool with_sphere;
    int sphere; /* the contact with the second sphere, if there is one */
    bool finite_elements, finite_strain;
    int count;
    reference_row *row;
} reference_table;

/* Returns 0; -1 with file, line and reason in error [error_size].  To be freed in any case. */
int reference_table_read(reference_table *t, const char *path, char *error, size_t error_size);
void reference_table_free(reference_table *t);

#endif
