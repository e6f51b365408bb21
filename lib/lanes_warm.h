/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * lanes_warm.h - what warm.c and look.c compute of contacts, for a vector of them at a time: a part of lanes.h, behind lanes_residuals.h.
 *
 * The same operations in the same order, so that the results are the same bits as the portable code's.
 */

/* Both return how many contacts are done; the rest is left over. */
TARGET static int start(const nlc_iteration *q, const nlc_guess *guess, int64_t from, int count, const double *U, double *overlap)
{
    const double *stiffness = q->n->stiffness + from, *given = q->overlap + from, *nonlocal = guess->nonlocal + from;
    double *force = q->n->force + from, *share = q->n->share + 2 * from;
    int c = 0;
    for (; c + LANES <= count; c += LANES) {
        const vec y = add(mul(loadu(given + c), set(q->load)), mul(loadu(nonlocal + c), set(guess->unit)));
        const vec x = positive(y), k = max(mul(loadu(stiffness + c), set(q->per_stiffness)), set(NLC_SOFTEST)), s = root(x);
        const vec P = mul(mul(k, s), x), wider = add(mul(set(1.005), s), set(0.01)); /* nlc_weighed_root */
        storeu(overlap + c, y);
        storeu(force + c, P);
        store_pairs(share + 2 * c, P, mul(mul(mul(set(1.5), k), loadu(U + c)), wider));
    }
    return c;
}

TARGET static int look(const nlc_iteration *q, const nlc_guess *guess, int64_t from, int count, double *size, double *alone,
                       double *energy, double *slope, nlc_view *view)
{
    const double *stiffness = q->n->stiffness + from, *overlap = q->overlap + from, *nonlocal = guess->nonlocal + from;
    const double *force = q->n->force + from, *side = q->n->side + 2 * from;
    _Alignas(8 * LANES) double lane[2][LANES];
    vec far = set(0), more = set(-1);
    int c = 0;
    for (; c + LANES <= count; c += LANES) {
        const vec x = mul(loadu(overlap + c), set(q->load)), g = add_pairs(side + 2 * c), y = add(x, g);
        const vec before = add(x, mul(loadu(nonlocal + c), set(guess->unit))), p = positive(y);
        const vec k = max(mul(loadu(stiffness + c), set(q->per_stiffness)), set(NLC_SOFTEST));
        const vec rise = mul(k, root(min(p, set(NLC_FARTHEST)))), z = magnitude(sub(mul(rise, p), loadu(force + c)));
        far = max(far, magnitude(g));
        more = max(more, sub(y, positive(add(mul(set(1.01), before), set(1e-4))))); /* nlc_weighed_overlap */
        storeu(size + c, z);
        storeu(alone + c, add(x, positive(g)));
        storeu(energy + c, mul(z, magnitude(sub(y, before))));
        storeu(slope + c, mul(set(1.5), rise));
    }
    store(lane[0], far);
    store(lane[1], more);
    for (int l = 0; l < LANES; l++) {
        view->lost |= lane[0][l] > 0.5 * NLC_FARTHEST;
        view->grown |= lane[1][l] > 0;
    }
    return c;
}
