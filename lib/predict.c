/* SPDX-License-Identifier: BSD-2-Clause */
/* predict.c - extrapolation of the displacements from step to step. */
#include "check.h"
#include "number.h"
#include "structs.h"

nlc_status nlc_predict(double *NLC_RESTRICT nonlocal, double *NLC_RESTRICT previous, int64_t count, double ratio, nlc_info *info)
{
    int64_t culprit;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (count < 0) return nlc_error(info, NLC_ERROR_COUNT, 2);
    if (count > 0 && !nonlocal) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (count > 0 && !previous) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!nlc_is_finite(ratio)) return nlc_error(info, NLC_ERROR_OPTION, 3);
    if ((culprit = nlc_first_not_finite(nonlocal, count)) >= 0) return nlc_error(info, NLC_ERROR_NONLOCAL, culprit);
    if ((culprit = nlc_first_not_finite(previous, count)) >= 0) return nlc_error(info, NLC_ERROR_NONLOCAL, culprit);
    const int a = nlc_exponent_above(nlc_largest_magnitude(nonlocal, count));
    const int b = nlc_exponent_above(nlc_largest_magnitude(previous, count)), top = a > b ? a : b;
    if (top > 1021 || top + 1 + nlc_exponent_above(ratio) > 1021) return nlc_error(info, NLC_ERROR_RANGE, -1);
    for (int64_t c = 0; c < count; c++) {
        const double last = nonlocal[c];
        nonlocal[c] = last + ratio * (last - previous[c]);
        previous[c] = last;
    }
    return nlc_error(info, NLC_OK, -1);
}
