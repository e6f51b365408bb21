/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * active.h - the part of a network that a solution has to be found for.
 *
 * A contact without force moves nothing.  So the equations are solved for the contacts that may have one, as a network of their
 * own; then the others are looked at once: if none of them has come to touch, the solution is that of the whole.  If some
 * have, they join, and the solution goes on from where it is.  Nothing is assumed, and nothing is kept between calls.
 */
#ifndef NLC_ACTIVE_H
#define NLC_ACTIVE_H

#include "network.h"

/*
 * Marks the contacts that overlap with the displacements in n->current or are not far from it (see there), and returns how many of them are
 * not pairs on their own.
 * n->largest holds the largest overlap on each particle.
 */
int64_t nlc_mark_active(nlc_network *n, const double *overlap);

/*
 * Builds n->part from the marked contacts, with their overlaps, normals and displacements.  Pairs whose particles have no other
 * marked contact are left out, too: they are Hertz contacts, and get their force in n->force.
 */
void nlc_build_part(nlc_network *n, const double *overlap, const double *normal);

/* Forces and displacements of the part into n->force and n->current, 0 for the others. */
void nlc_collect_part(nlc_network *n);

/*
 * Displacements of the contacts without force into n->current; if some touch now, they and all candidates near an overlap are
 * marked.
 * Returns how many were; -1 if two contacts lie in the same direction, *culprit one of them.
 */
int64_t nlc_check_rest(nlc_network *n, const double *overlap, const double *normal, int64_t *culprit);

#endif
