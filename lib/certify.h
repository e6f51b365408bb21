/* SPDX-License-Identifier: BSD-2-Clause */
/* certify.h - whether a residual is small enough, and whether the end of the stable branch is near. */
#ifndef NLC_CERTIFY_H
#define NLC_CERTIFY_H

#include "iteration.h"

typedef enum nlc_verdict { NLC_GO_ON, NLC_DONE, NLC_BEYOND, NLC_ROUNDED } nlc_verdict;

/* Whether lambda is proved to be at most beta, low enough for the residual at hand; NLC_BEYOND if the bound says that it may not be stable. */
nlc_verdict nlc_certify(nlc_iteration *q, double beta, nlc_outcome *outcome);

/*
 * A rough look before convergence, when a Ritz value comes near 1, and a closer one later on: is it hopeless?  Saves sweeps, decides
 * no result.
 */
bool nlc_is_too_near(nlc_iteration *q, bool closer, nlc_outcome *outcome);

#endif
