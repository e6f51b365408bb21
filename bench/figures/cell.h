/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * cell.h - one sphere and what it touches: rigid plates, or its own images in a crystal of equal spheres.
 *
 * A crystal with one sphere in its primitive cell needs one sphere: every contact is with an image, i = j, and stands for two
 * contacts of that sphere, in opposite directions.
 */
#ifndef NLC_FIGURES_CELL_H
#define NLC_FIGURES_CELL_H

#include <stdbool.h>

#include "nlcontact.h"

enum { CELL_CONTACTS = 8 };

typedef struct cell {
    double radius;
    nlc_material material[2]; /* the sphere's, the plates' */
    int contacts, plates;
    int32_t i[CELL_CONTACTS], j[CELL_CONTACTS];
    double overlap[CELL_CONTACTS], normal[CELL_CONTACTS][3], distance[CELL_CONTACTS]; /* of the centres */
    double force[CELL_CONTACTS], nonlocal[CELL_CONTACTS];
} cell;

void cell_init(cell *c, double radius, double young, double poisson);

/* Contact with the image at (x, y, z) from the centre; with a plate in the direction (x, y, z), of any length. */
void cell_image(cell *c, double x, double y, double z);
void cell_plate(cell *c, double x, double y, double z, double overlap);

/* Forces and nonlocal displacements; the status of nlc_solve.  NLC_WARNING_WEAKENED: close to the end of the stable branch or
 * beyond it, these are not the forces of the full coupling. */
nlc_status cell_solve(cell *c, int32_t model);

/*
 * The same with the full coupling up to the very end of the stable branch, by Newton's method from the forces there are, those of
 * a state nearby.  false: no solution found from there, or none that is stable.
 */
bool cell_follow(cell *c, int32_t model);

#endif
