/* SPDX-License-Identifier: BSD-2-Clause */
/* contacts.h - who touches whom in the bed, and with what force: positions to forces by the library. */
#ifndef NLC_FIGURES_CONTACTS_H
#define NLC_FIGURES_CONTACTS_H

#include <stdbool.h>

#include "bed.h"

typedef struct contacts {
    int64_t count;
    int32_t i[BED_CONTACTS], j[BED_CONTACTS];
    double overlap[BED_CONTACTS], normal[BED_CONTACTS][3], force[BED_CONTACTS], nonlocal[BED_CONTACTS];
    double F[BED_SPHERES][3], wall[BED_WALLS][3]; /* sums of forces */
    nlc_status status;                            /* of nlc_solve, NLC_OK or a warning */
    int64_t warned;                               /* solves with a warning */
    int32_t model;
    bed listed;   /* where the list was made */
    double reach; /* of the list [m] */
    int32_t length[BED_SPHERES], other[BED_SPHERES][BED_SPHERES], *row[BED_SPHERES]; /* all pairs, each once */
    nlc_network *network;
    void *memory;
    size_t size;
} contacts;

/* False: no memory.  To be freed. */
bool contacts_init(contacts *c, const bed *b, int32_t model);
void contacts_free(contacts *c);

/*
 * Forces of the bed as it lies, and their sums.  The list is renewed whenever a pair that is not in it might have a force:
 * nlc_reach says how wide a gap the displacements can close.  Only errors are returned, a warning is in c->status.
 */
nlc_status contacts_solve(contacts *c, const bed *b);

#endif
