/* SPDX-License-Identifier: BSD-2-Clause */
/* check.h - checks of the caller's arrays over contacts: the index of the first bad element, or -1. */
#ifndef NLC_CHECK_H
#define NLC_CHECK_H

#include <stdint.h>

int64_t nlc_first_not_finite(const double *values, int64_t count);
int64_t nlc_first_not_positive(const double *values, int64_t count);
int64_t nlc_first_not_force(const double *values, int64_t count); /* finite and not negative */
int64_t nlc_first_not_unit(const double *normals, int64_t count);

/* Largest |value|; infinity or a NaN if there is one. */
double nlc_largest_magnitude(const double *values, int64_t count);

#endif
