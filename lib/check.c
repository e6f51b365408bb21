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

/* Of GROUP normals at a time.  A component of 2 or more shows in one bit, and without such no square can overflow. */
#define GROUP 8
static bool are_unit(const double *normals)
{
    uint64_t bits = 0;
    double worst = 0;
    for (int x = 0; x < 3 * GROUP; x++) bits |= nlc_bits(normals[x]);
    if (bits & NLC_TWO_BITS) return false;
    for (int c = 0; c < GROUP; c++) {
        const double off = fabs(nlc_dot(normals + 3 * c, normals + 3 * c) - 1);
        worst = off > worst ? off : worst;
    }
    return worst <= NLC_UNIT_TOLERANCE;
}

int64_t nlc_first_not_unit(const double *normals, int64_t count)
{
    for (int64_t c = 0; c < count; c++) {
        while (c + GROUP <= count && are_unit(normals + 3 * c)) c += GROUP;
        if (c < count && !nlc_is_unit(normals + 3 * c)) return c;
    }
    return -1;
}

static uint64_t larger(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* Four at a time: in one row each comparison would wait for the one before it. */
double nlc_largest_magnitude(const double *v, int64_t count)
{
    uint64_t a = 0, b = 0, d = 0, e = 0;
    int64_t c = 0;
    for (; c < count - 3; c += 4) {
        a = larger(a, nlc_abs_bits(v[c]));
        b = larger(b, nlc_abs_bits(v[c + 1]));
        d = larger(d, nlc_abs_bits(v[c + 2]));
        e = larger(e, nlc_abs_bits(v[c + 3]));
    }
    for (; c < count; c++) a = larger(a, nlc_abs_bits(v[c]));
    return nlc_from_bits(larger(larger(a, b), larger(d, e)));
}
