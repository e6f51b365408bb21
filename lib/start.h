/* SPDX-License-Identifier: BSD-2-Clause */
/* start.h - the parts of a solve that several files share. */
#ifndef NLC_START_H
#define NLC_START_H

#include "network.h"

/* start.c: the largest overlap on each particle, 0 at least, into network->largest; of ghosts it may be less. */
void nlc_largest_overlaps(nlc_network *network, const double *overlap);

/* Where contact c begins; network->largest are the largest overlaps. */
double nlc_start_of(const nlc_network *network, int64_t c, const double *overlap, const double *nonlocal);

/* The same of all into network->current, which nonlocal may be. */
void nlc_start_from(nlc_network *network, const double *overlap, const double *nonlocal);

/* solve_clusters.c: each cluster of contacts that may have a force by itself. */
void nlc_solve_clusters(nlc_network *network, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *outcome);

/* solve.c */
void nlc_warn_if_close(const nlc_network *network, const double *overlap, const double *normal, nlc_outcome *outcome);

#endif
