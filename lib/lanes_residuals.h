/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * lanes_residuals.h - residuals and slopes of directions.c for a vector of contacts at a time: a part of lanes.h.
 *
 * The same operations in the same order, so that the results are the same bits as the portable code's.
 */

/* |x| and the positive part of 2 x */
TARGET static inline vec magnitude(vec x)
{
    return max(x, sub(set(0), x));
}

TARGET static inline vec positive(vec x)
{
    return mul(set(0.5), add(x, magnitude(x)));
}

/* Returns how many contacts are done; the rest is left over. */
TARGET static int residuals(const nlc_iteration *q, int64_t from, int count, double *z, double *inverse, double *force,
                            nlc_extremes *extremes)
{
    const double *stiffness = q->n->stiffness + from, *overlap = q->overlap + from, *current = q->n->current + from;
    const double *iterate = q->n->force + from, *floor = q->n->floor + from;
    _Alignas(8 * LANES) double lane[3][LANES];
    vec residual = set(0), top = set(0), far = set(-1);
    int c = 0;
    for (; c + LANES <= count; c += LANES) {
        const vec k = max(mul(loadu(stiffness + c), set(q->per_stiffness)), set(NLC_SOFTEST));
        const vec y = min(add(mul(loadu(overlap + c), set(q->load)), loadu(current + c)), set(NLC_FARTHEST));
        const vec s = root(positive(y)), h = mul(mul(mul(k, s), s), s), f = loadu(iterate + c), p = positive(f);
        const vec a = mul(s, add(h, mul(set(2), p))), b = add(mul(set(2), h), p), sb = mul(s, b);
        const vec below = add(mul(add(sb, a), b), set(NLC_LINE));
        const vec above = mul(k, add(add(mul(sb, sb), mul(sb, a)), mul(a, a)));
        storeu(force + c, h);
        storeu(z + c, sub(h, f));
        storeu(inverse + c, div(below, max(above, mul(loadu(floor + c), below))));
        residual = max(residual, magnitude(sub(h, f)));
        top = max(top, h);
        far = max(far, max(sub(set(0), f), sub(f, mul(set(NLC_FAR), h))));
    }
    store(lane[0], residual);
    store(lane[1], top);
    store(lane[2], far);
    for (int l = 0; l < LANES; l++) {
        extremes->residual = lane[0][l] > extremes->residual ? lane[0][l] : extremes->residual;
        extremes->force = lane[1][l] > extremes->force ? lane[1][l] : extremes->force;
        extremes->far |= lane[2][l] > 0;
    }
    return c;
}
