/* SPDX-License-Identifier: BSD-2-Clause */
/* check.c - checks of the caller's arrays over contacts. */
#include "check.h"

#include "vector.h"

int64_t nlc_first_not_finite(const double *values, int64_t count)
{
    for (int64_t c = 0; c < count; c++)
        if (!nlc_is_finite(values[c])) return c;
    return -1;
}

int64_t nlc_first_not_positive(const double *values, int64_t count)
{
    for (int64_t c = 0; c < count; c++)
        if (!nlc_is_positive(values[c])) return c;
    return -1;
}

int64_t nlc_first_not_force(const double *values, int64_t count)
{
    for (int64_t c = 0; c < count; c++)
        if (!nlc_is_finite(values[c]) || values[c] < 0) return c;
    return -1;
}

int64_t nlc_first_not_unit(const double *normals, int64_t count)
{
    for (int64_t c = 0; c < count; c++)
        if (!nlc_is_unit(normals + 3 * c)) return c;
    return -1;
}

double nlc_largest_magnitude(const double *values, int64_t count)
{
    uint64_t largest = 0;
    for (int64_t c = 0; c < count; c++) {
        uint64_t b = nlc_abs_bits(values[c]);
        largest = b > largest ? b : largest;
    }
    return nlc_from_bits(largest);
}
