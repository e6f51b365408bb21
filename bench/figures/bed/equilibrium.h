/* SPDX-License-Identifier: BSD-2-Clause */
/* equilibrium.h - moves the spheres until the forces on each balance. */
#ifndef NLC_FIGURES_EQUILIBRIUM_H
#define NLC_FIGURES_EQUILIBRIUM_H

#include <stdbool.h>

#include "contacts.h"

typedef struct equilibrium {
    int64_t steps;
    int64_t active;   /* contacts with a force */
    double mean;      /* of these forces */
    double imbalance; /* largest net force on a sphere over their mean; 0: no force at all */
    bool loaded;      /* false: the mean force is next to nothing, the bed does not resist */
    bool found;
} equilibrium;

/* An error of the library is returned; that no equilibrium was found is not one. */
nlc_status equilibrium_find(equilibrium *e, contacts *c, bed *b);

#endif
