/* SPDX-License-Identifier: BSD-2-Clause */
/* certify.c - bounds of lambda for the end of an iteration. */
#include "certify.h"

#include "bound.h"
#include "collective.h"
#include "slabs.h"

#define BALANCE_FROM 0.9  /* another sweep is cheaper than balanced shares until |z| is a tenth of the tolerance */

static void set_slopes(void *iteration, int64_t from, int64_t end)
{
    const nlc_iteration *q = iteration;
    for (int64_t c = from; c < end; c++) {
        const double y = nlc_scaled_overlap(q, c);
        q->n->slope[c] = 1.5 * nlc_scaled_stiffness(q, c) * sqrt(0.5 * (y + fabs(y)));
    }
}

/* Whether an overlap exceeds what the slopes of the known bound are for. */
static bool has_grown(const nlc_iteration *q)
{
    const double *start = q->n->spare[2];
    int64_t grown = 0;
    for (int64_t c = 0; c < q->n->contact_count; c++) {
        const double y = nlc_scaled_overlap(q, c);
        grown += y > 0 && y > nlc_weighed_overlap(start[c]);
    }
    return nlc_on_any_rank(q->n, grown > 0);
}

nlc_verdict nlc_certify(nlc_iteration *q, double beta, nlc_outcome *out)
{
    const double limit = 1 - NLC_MARGIN;
    nlc_bound bound = {INFINITY, -1, 0};
    if (beta > limit) beta = limit;
    if (q->theta > beta && q->theta < limit) return NLC_GO_ON; /* a Ritz value is a lower bound */
    if (q->n->known_bound <= beta && !has_grown(q)) {
        out->info.lambda_upper = q->n->known_bound;
        out->info.critical_particle = q->n->known_where;
        return NLC_DONE;
    }
    nlc_for_contacts(q->n, set_slopes, q);
    bool good = nlc_bound_below(q->n, q->normal, beta, &bound), beyond = false;
    if (!good && beta >= BALANCE_FROM) {
        nlc_bound_balance(q->n, q->normal, NLC_BALANCE_PASSES, beta, &bound);
        good = bound.upper <= beta;
        beyond = bound.upper > limit;
    }
    out->info.blocks += bound.blocks;
    out->info.lambda_upper = bound.upper;
    out->info.critical_particle = bound.where;
    if (nlc_is_over(q->n, out)) return NLC_DONE;
    return good ? NLC_DONE : beyond ? NLC_BEYOND : NLC_GO_ON;
}

bool nlc_is_too_near(nlc_iteration *q, bool closer, nlc_outcome *out)
{
    const double limit = 1 - NLC_MARGIN + (closer ? 0 : 0.001);
    nlc_bound bound = {INFINITY, -1, 0};
    nlc_for_contacts(q->n, set_slopes, q);
    nlc_bound_balance(q->n, q->normal, NLC_BALANCE_PASSES, 1 - NLC_MARGIN, &bound);
    out->info.blocks += bound.blocks;
    return !nlc_is_over(q->n, out) && bound.upper > limit;
}
