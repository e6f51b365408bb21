/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * tangent.c - how the forces answer to small changes of the overlaps: T = dP/dgamma = (D^-1 - C)^-1 over contacts with P > 0.
 *
 * With D^1/2 taken out, T = D^1/2 A^-1 D^1/2 and A = 1 - D^1/2 C D^1/2, whose eigenvalues are 1 - lambda: conjugate gradients.
 * Units as in an iteration, from the stiffnesses and forces; the vector to be multiplied has a unit of its own.
 */
#include "block.h"
#include "bound.h"
#include "structs.h"

#define PART 0.1 /* of the tolerance, for the residual of the linear equations */

typedef struct units {
    int stiffness, force, slope; /* exponents of 2: k, P and D = dP/dx */
} units;

/* Sets network->unit, and network->slope to D.  False: beyond the range of double, or of what can be coupled. */
static bool set_slopes(nlc_network *n, const double *force, units *result)
{
    units u = {nlc_exponent_above(nlc_largest_magnitude(n->stiffness, n->contact_count)),
               nlc_exponent_above(nlc_largest_magnitude(force, n->contact_count)), 0};
    u.force += (3 - (u.force - u.stiffness) % 3) % 3; /* the unit of overlap, (P/k)^(2/3), is to be a power of 2, too */
    u.slope = u.stiffness + (u.force - u.stiffness) / 3;
    *result = u;
    if (u.slope > 1000 || u.slope < -1000 || n->coupling_exponent + u.slope > 200) return false;
    n->cached = false;
    nlc_set_units(n, -2 * ((u.force - u.stiffness) / 3), -u.stiffness);
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double k = nlc_join(n->stiffness[c], -u.stiffness), p = nlc_join(force[c], -u.force);
        n->slope[c] = p > 0 && k > 1e-150 ? 1.5 * k * cbrt(p / k) : 0;
    }
    return true;
}

/* Sets what a model with coefficients that depend on the forces has to know of them. */
static nlc_status set_state(nlc_network *n, const double *force, const double *normal, units u, nlc_info *info)
{
    if (nlc_is_linear(n->settings.model->shape)) return NLC_OK;
    for (int64_t c = 0; c < n->contact_count; c++) {
        n->spare[0][c] = nlc_join(force[c], -u.force);
        n->floor[c] = 0; /* contacts without force have no part in the tangent */
    }
    info->sweeps++;
    return nlc_displace(n, NLC_OF_STATE, n->spare[0], normal, &info->culprit);
}

/* out = D^1/2 C D^1/2 in; false if the sweep failed */
static bool couple(nlc_network *n, double *out, const double *in, const double *normal, nlc_outcome *o)
{
    double *t = n->spare[3];
    for (int64_t c = 0; c < n->contact_count; c++) t[c] = sqrt(n->slope[c]) * in[c];
    o->info.sweeps++;
    o->status = nlc_displace(n, NLC_OF_CHANGES, t, normal, &o->info.culprit);
    for (int64_t c = 0; c < n->contact_count && o->status == NLC_OK; c++)
        out[c] = sqrt(n->slope[c]) * (n->side[2 * c] + n->side[2 * c + 1]);
    return o->status == NLC_OK;
}

static double dot(const double *a, const double *b, int64_t count)
{
    double s = 0;
    for (int64_t c = 0; c < count; c++) s += a[c] * b[c];
    return s;
}

/* A x = b by conjugate gradients; b becomes the residual. */
static void solve_linear(nlc_network *n, double *x, double *b, const double *normal, nlc_outcome *o)
{
    double *p = n->spare[1], *a = n->spare[2];
    const int64_t count = n->contact_count;
    double rr = dot(b, b, count);
    const double enough = PART * PART * n->settings.tolerance * n->settings.tolerance * rr, first = rr;
    for (int64_t c = 0; c < count; c++) x[c] = 0, p[c] = b[c];
    while (rr > enough && rr > 1e-290) {
        if (o->info.sweeps >= n->settings.max_sweeps) o->status = NLC_WARNING_NOT_CONVERGED;
        if (o->status != NLC_OK || !couple(n, a, p, normal, o)) break;
        for (int64_t c = 0; c < count; c++) a[c] = p[c] - a[c];
        const double curvature = dot(p, a, count), before = rr;
        if (curvature <= 1e-14 * dot(p, p, count)) {
            o->status = NLC_ERROR_UNSTABLE;
            break;
        }
        for (int64_t c = 0; c < count; c++) {
            x[c] += before / curvature * p[c];
            b[c] -= before / curvature * a[c];
        }
        rr = dot(b, b, count);
        for (int64_t c = 0; c < count; c++) p[c] = b[c] + rr / before * p[c];
    }
    o->info.residual = first > 0 ? sqrt(rr / first) : 0;
}

/* What the four functions check; the vector may be NULL where there is none. */
static nlc_status check(nlc_network *n, const double *in, const double *force, const double *normal, nlc_status bad_in,
                        int64_t *culprit)
{
    if (in && (*culprit = nlc_first_not_finite(in, n->contact_count)) >= 0) return bad_in;
    if ((*culprit = nlc_first_not_force(force, n->contact_count)) >= 0) return NLC_ERROR_FORCE;
    if ((*culprit = nlc_first_not_unit(normal, n->contact_count)) >= 0) return NLC_ERROR_NORMAL;
    return NLC_OK;
}

/* Scaled copy; returns its unit's exponent. */
static int scale_down(double *to, const double *from, int64_t count)
{
    const int e = nlc_exponent_above(nlc_largest_magnitude(from, count));
    for (int64_t c = 0; c < count; c++) to[c] = nlc_join(from[c], -e);
    return e;
}

/* to = from 2^e; false, with nothing written, if that is beyond the range of double */
static bool scale_up(double *to, const double *from, int64_t count, int e)
{
    if (nlc_exponent_above(nlc_largest_magnitude(from, count)) + e > 1023) return false;
    for (int64_t c = 0; c < count; c++) to[c] = nlc_join(from[c], e);
    return true;
}

typedef struct call {
    nlc_outcome o;
    units u;
    int in; /* exponent of the unit of the vector, whose scaled copy is in spare[0] */
} call;

/* What nlc_tangent and its inverse begin with.  False: there is nothing to compute, call.o.status is to be returned. */
static bool begin(call *k, nlc_network *n, const double *out, const double *in, const double *force, const double *normal,
                  nlc_status bad_in, nlc_info *info)
{
    k->o = (nlc_outcome){NLC_ERROR_STRUCT_SIZE, nlc_new_info()};
    if (!nlc_info_is_valid(info)) return false;
    k->o.status = NLC_OK;
    if (!n) {
        k->o.status = NLC_ERROR_NULL;
        k->o.info.culprit = 0;
    } else if (!nlc_network_is_valid(n)) {
        k->o.status = NLC_ERROR_NETWORK;
    } else if (!n->settings.model->potential) {
        k->o.status = NLC_ERROR_NO_POTENTIAL;
        k->o.info.culprit = n->settings.number;
    } else if (n->contact_count > 0) {
        const double *const argument[4] = {out, in, force, normal};
        for (int a = 4; a > 0; a--) {
            if (argument[a - 1]) continue;
            k->o.status = NLC_ERROR_NULL;
            k->o.info.culprit = a;
        }
        if (k->o.status == NLC_OK) k->o.status = check(n, in, force, normal, bad_in, &k->o.info.culprit);
        if (k->o.status == NLC_OK && !set_slopes(n, force, &k->u)) k->o.status = NLC_ERROR_RANGE;
        if (k->o.status == NLC_OK) k->o.status = set_state(n, force, normal, k->u, &k->o.info);
    }
    if (k->o.status == NLC_OK && n->contact_count > 0) {
        k->in = scale_down(n->spare[0], in, n->contact_count);
        return true;
    }
    nlc_report(info, &k->o.info, k->o.status);
    return false;
}

nlc_status nlc_tangent(nlc_network *network, double *NLC_RESTRICT dforce, const double *NLC_RESTRICT doverlap,
                       const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info)
{
    call k;
    if (!begin(&k, network, dforce, doverlap, force, normal, NLC_ERROR_OVERLAP, info)) return k.o.status;
    const int64_t count = network->contact_count;
    double *b = network->spare[0], *x = network->current;
    for (int64_t c = 0; c < count; c++) b[c] *= sqrt(network->slope[c]);
    solve_linear(network, x, b, normal, &k.o);
    for (int64_t c = 0; c < count; c++) x[c] *= sqrt(network->slope[c]);
    if (k.o.status >= 0 && !scale_up(dforce, x, count, k.in + k.u.slope)) k.o.status = NLC_ERROR_RANGE;
    return nlc_report(info, &k.o.info, k.o.status);
}

nlc_status nlc_tangent_inverse(nlc_network *network, double *NLC_RESTRICT doverlap, const double *NLC_RESTRICT dforce,
                               const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info)
{
    call k;
    if (!begin(&k, network, doverlap, dforce, force, normal, NLC_ERROR_FORCE, info)) return k.o.status;
    const int64_t count = network->contact_count;
    double *p = network->spare[0], *x = network->current;
    for (int64_t c = 0; c < count; c++) p[c] = network->slope[c] > 0 ? p[c] : 0;
    k.o.info.sweeps = 1;
    k.o.status = nlc_displace(network, NLC_OF_CHANGES, p, normal, &k.o.info.culprit);
    for (int64_t c = 0; c < count && k.o.status == NLC_OK; c++) {
        const double slope = network->slope[c], own = p[c] / (slope > 1e-290 ? slope : 1e-290);
        x[c] = slope > 1e-290 ? own - (network->side[2 * c] + network->side[2 * c + 1]) : 0;
    }
    if (k.o.status == NLC_OK && !scale_up(doverlap, x, count, k.in - k.u.slope)) k.o.status = NLC_ERROR_RANGE;
    return nlc_report(info, &k.o.info, k.o.status);
}

/*
 * Sum over a particle's contacts of D / (1 - share_i b_i - share_j b_j).  That is more than the tangent of the contact: by the
 * argument of bound.h D^-1 - C >= diag(1 - share_i b_i - share_j b_j) D^-1.
 */
static double stiffness_on(const nlc_network *n, int64_t particle)
{
    double sum = 0;
    for (int64_t p = n->start[particle]; p < n->start[particle + 1]; p++) {
        const int64_t c = n->entry[p] >> 1, i = n->i[c], j = n->j[c];
        double left = 1;
        if (i < n->particle_count) left -= n->share[2 * c] * n->bound[i];
        if (j < n->particle_count) left -= n->share[2 * c + 1] * n->bound[j];
        sum += n->slope[c] / left;
    }
    return sum;
}

nlc_status nlc_tangent_bound(nlc_network *network, double *NLC_RESTRICT stiffness, const double *NLC_RESTRICT force,
                             const double *NLC_RESTRICT normal, nlc_info *info)
{
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    if (!network->settings.model->potential) return nlc_error(info, NLC_ERROR_NO_POTENTIAL, network->settings.number);
    const int64_t particles = network->particle_count;
    if (particles == 0) return nlc_error(info, NLC_OK, -1);
    if (!stiffness) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (network->contact_count > 0 && !force) return nlc_error(info, NLC_ERROR_NULL, 2);
    if (network->contact_count > 0 && !normal) return nlc_error(info, NLC_ERROR_NULL, 3);
    nlc_outcome o = {NLC_OK, nlc_new_info()};
    o.status = check(network, 0, force, normal, NLC_OK, &o.info.culprit);
    if (o.status != NLC_OK) return nlc_report(info, &o.info, o.status);

    units u;
    if (!set_slopes(network, force, &u)) return nlc_report(info, &o.info, NLC_ERROR_RANGE);
    o.status = set_state(network, force, normal, u, &o.info);
    if (o.status != NLC_OK) return nlc_report(info, &o.info, o.status);
    nlc_bound bound = {0, -1, 0};
    if (network->settings.model->within) {
        nlc_bound_particles(network, normal, &bound);
        o.info.lambda_upper = bound.upper;
        o.info.critical_particle = bound.where;
        o.info.blocks = bound.blocks;
    } else {
        for (int64_t k = 0; k < particles; k++) network->bound[k] = 0;
        for (int64_t e = 0; e < 2 * network->contact_count; e++) network->share[e] = 0;
        o.info.lambda_lower = o.info.lambda_upper = 0;
    }
    if (bound.upper >= 1) return nlc_report(info, &o.info, NLC_ERROR_UNSTABLE);
    double *sum = network->growth;
    for (int64_t k = 0; k < particles; k++) sum[k] = stiffness_on(network, k);
    if (!scale_up(stiffness, sum, particles, u.slope)) return nlc_report(info, &o.info, NLC_ERROR_RANGE);
    return nlc_report(info, &o.info, NLC_OK);
}
