/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * tangent.c - how the forces answer to small changes of the overlaps: T = dP/dgamma = (D^-1 - C)^-1 over contacts with P > 0.
 *
 * With D^1/2 taken out, T = D^1/2 A^-1 D^1/2 and A = 1 - D^1/2 C D^1/2, whose eigenvalues are 1 - lambda: conjugate gradients.
 * Units as in an iteration, from the stiffnesses and forces; the vector to be multiplied has a unit of its own.
 */
#include "block.h"
#include "bound.h"
#include "collective.h"
#include "layout.h"
#include "structs.h"

#define PART 0.1 /* of the tolerance, for the residual of the linear equations */
#define LOST 1e60 /* growth of its square: of a positive matrix it would take one with a condition of that, and rounding has the word */

typedef struct units {
    int stiffness, force, slope; /* exponents of 2: k, P and D = dP/dx */
} units;

/* Largest magnitudes, of all ranks. */
typedef struct largest {
    double stiffness, force, in, coupling_exponent;
} largest;

/* What is given to one of the functions; where there is no vector in, bad_in is NLC_OK. */
typedef struct given {
    const double *out, *in, *force, *normal;
    nlc_status bad_in;
    nlc_function function;
} given;

/* Sets network->unit, and network->slope to D.  False: beyond the range of double, or of what can be coupled. */
static bool set_slopes(nlc_network *n, const double *force, const largest *top, units *result)
{
    const bool none = top->stiffness <= 0; /* no contacts, or none that yields: no slopes */
    units u = {none ? 0 : nlc_exponent_above(top->stiffness), none ? 0 : nlc_exponent_above(top->force), 0};
    u.force += (3 - (u.force - u.stiffness) % 3) % 3; /* the unit of overlap, (P/k)^(2/3), is to be a power of 2, too */
    u.slope = u.stiffness + (u.force - u.stiffness) / 3;
    *result = u;
    if (!none && (u.slope > 1000 || u.slope < -1000 || (int)top->coupling_exponent + u.slope > 200)) return false;
    n->cached = false;
    nlc_set_units(n, -2 * ((u.force - u.stiffness) / 3), -u.stiffness);
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double k = nlc_join(n->stiffness[c], -u.stiffness), p = nlc_join(force[c], -u.force);
        n->slope[c] = p > 0 && k > 1e-150 ? 1.5 * k * cbrt(p / (k + 1e-290)) : 0;
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

static double dot_here(const double *a, const double *b, int64_t count)
{
    double s = 0;
    for (int64_t c = 0; c < count; c++) s += a[c] * b[c];
    return s;
}

static double dot(nlc_network *n, const double *a, const double *b)
{
    return nlc_dot_over_ranks(n, dot_here(a, b, n->contact_count), a, b);
}

/* A x = b by conjugate gradients; b becomes the residual. */
static void solve_linear(nlc_network *n, double *x, double *b, const double *normal, nlc_outcome *o)
{
    double *p = n->spare[1], *a = n->spare[2];
    const int64_t count = n->contact_count;
    if (!n->settings.model->within) { /* A = 1 */
        memcpy(x, b, (size_t)count * sizeof *x);
        return;
    }
    double rr = dot(n, b, b);
    const double enough = PART * PART * n->settings.tolerance * n->settings.tolerance * rr, first = rr;
    for (int64_t c = 0; c < count; c++) x[c] = 0, p[c] = b[c];
    while (rr > enough && rr > 1e-290) {
        if (nlc_is_over(n, o)) break;
        if (o->info.sweeps >= n->settings.max_sweeps || rr > LOST * first) o->status = NLC_WARNING_NOT_CONVERGED;
        if (o->status != NLC_OK || !couple(n, a, p, normal, o)) break;
        for (int64_t c = 0; c < count; c++) a[c] = p[c] - a[c];
        const double curvature = dot(n, p, a), before = rr;
        const bool unstable = curvature <= 1e-14 * dot(n, p, p);
        if (nlc_is_over(n, o)) break;
        if (unstable) {
            o->status = NLC_ERROR_UNSTABLE;
            break;
        }
        for (int64_t c = 0; c < count; c++) {
            x[c] += before / curvature * p[c];
            b[c] -= before / curvature * a[c];
        }
        rr = dot(n, b, b);
        for (int64_t c = 0; c < count; c++) p[c] = b[c] + rr / before * p[c];
    }
    o->info.residual = sqrt(rr / (first + (first <= 0)));
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

/* Largest magnitude on contacts with a force: others have no part in the tangent, whatever is said of them. */
static double largest_of(const given *g, int64_t count)
{
    double top = 0;
    for (int64_t c = 0; c < count; c++)
        if (g->force[c] > 0 && fabs(g->in[c]) > top) top = fabs(g->in[c]);
    return top;
}

/* Scaled copy, 0 on contacts without force, top being the largest; returns its unit's exponent. */
static int scale_down(double *to, const given *g, int64_t count, double top)
{
    const int e = nlc_exponent_above(top);
    for (int64_t c = 0; c < count; c++) to[c] = g->force[c] > 0 ? nlc_join(g->in[c], -e) : 0;
    return e;
}

static void scale_up(double *to, const double *from, int64_t count, int e)
{
    for (int64_t c = 0; c < count; c++) to[c] = nlc_join(from[c], e);
}

/* The end of what each of the functions computes, values 2^e: whether that can be held, and is it so everywhere? */
static bool finish(nlc_network *n, const double *values, int64_t count, int e, nlc_outcome *o)
{
    double top = o->status >= 0 ? nlc_largest_magnitude(values, count) : 0;
    nlc_max_over_ranks(n, &top, 1);
    if (o->status >= 0 && nlc_exponent_above(top) + e > 1023) o->status = NLC_ERROR_RANGE;
    if (!nlc_is_over(n, o)) nlc_take_leave(n, 0, o);
    return o->status >= 0;
}

typedef struct call {
    nlc_outcome o;
    units u;
    int in; /* exponent of the unit of the vector, whose scaled copy is in spare[0] */
} call;

static nlc_status check_arguments(nlc_network *n, const given *g, int64_t *culprit)
{
    const bool vector = g->bad_in != NLC_OK;
    const double *const argument[4] = {g->out, vector ? g->in : g->out, g->force, g->normal};
    *culprit = n->settings.number;
    if (!n->settings.model->potential) return NLC_ERROR_NO_POTENTIAL;
    const bool solver = n->settings.model->within && g->function != NLC_TANGENT_INVERSE;
    const nlc_status status = solver ? nlc_check_solver(n, culprit) : NLC_OK;
    if (status != NLC_OK) return status;
    *culprit = -1;
    if (n->contact_count == 0 && vector) return NLC_OK;
    for (int a = 0; a < 4; a++) { /* the bound needs no contacts to have something to say of particles */
        *culprit = vector || a == 0 ? a + 1 : a;
        if (!argument[a] && (a > 0 ? n->contact_count > 0 : vector || n->particle_count > 0)) return NLC_ERROR_NULL;
    }
    *culprit = -1;
    return check(n, vector ? g->in : 0, g->force, g->normal, g->bad_in, culprit);
}

/* What they begin with.  False: there is nothing to compute, call.o.status is to be returned. */
static bool begin(call *k, nlc_network *n, const given *g, nlc_info *info)
{
    const bool valid = nlc_info_is_valid(info), shared = n && nlc_network_is_valid(n) && nlc_is_shared(n);
    k->o = (nlc_outcome){NLC_ERROR_STRUCT_SIZE, nlc_new_info()};
    if (!valid && !shared) return false;
    if (!n) {
        k->o.status = NLC_ERROR_NULL;
        k->o.info.culprit = 0;
    } else if (!nlc_network_is_valid(n)) {
        k->o.status = NLC_ERROR_NETWORK;
    } else {
        largest top = {0, 0, 0, n->coupling_exponent};
        if (valid) k->o.status = check_arguments(n, g, &k->o.info.culprit);
        if (k->o.status == NLC_OK) {
            top.stiffness = nlc_largest_magnitude(n->stiffness, n->contact_count);
            top.force = nlc_largest_magnitude(g->force, n->contact_count);
            top.in = g->bad_in != NLC_OK ? largest_of(g, n->contact_count) : 0;
        }
        if (shared) {
            double values[4] = {top.stiffness, top.force, top.in, top.coupling_exponent};
            nlc_meet(n, g->function, k->o.status, k->o.info.culprit, 0, values, 4);
            top = (largest){values[0], values[1], values[2], values[3]};
        }
        const bool nothing = !shared && (g->bad_in != NLC_OK ? n->contact_count : n->particle_count) == 0;
        if (!nlc_is_over(n, &k->o) && k->o.status == NLC_OK && !nothing) {
            if (!set_slopes(n, g->force, &top, &k->u)) k->o.status = NLC_ERROR_RANGE;
            if (k->o.status == NLC_OK) k->o.status = set_state(n, g->force, g->normal, k->u, &k->o.info);
            if (k->o.status == NLC_OK) {
                if (g->bad_in != NLC_OK) k->in = scale_down(n->spare[0], g, n->contact_count, top.in);
                return true;
            }
            nlc_take_leave(n, 0, &k->o);
        }
    }
    if (valid) nlc_report(info, &k->o.info, k->o.status);
    return false;
}

nlc_status nlc_tangent(nlc_network *network, double *NLC_RESTRICT dforce, const double *NLC_RESTRICT doverlap,
                       const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info)
{
    call k;
    const given g = {dforce, doverlap, force, normal, NLC_ERROR_OVERLAP, NLC_TANGENT};
    if (!begin(&k, network, &g, info)) return k.o.status;
    const int64_t count = network->contact_count;
    double *b = network->spare[0], *x = network->current;
    for (int64_t c = 0; c < count; c++) b[c] *= sqrt(network->slope[c]);
    solve_linear(network, x, b, normal, &k.o);
    for (int64_t c = 0; c < count; c++) x[c] *= sqrt(network->slope[c]);
    if (finish(network, x, count, k.in + k.u.slope, &k.o)) scale_up(dforce, x, count, k.in + k.u.slope);
    return nlc_report(info, &k.o.info, k.o.status);
}

nlc_status nlc_tangent_inverse(nlc_network *network, double *NLC_RESTRICT doverlap, const double *NLC_RESTRICT dforce,
                               const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info)
{
    call k;
    const given g = {doverlap, dforce, force, normal, NLC_ERROR_FORCE, NLC_TANGENT_INVERSE};
    if (!begin(&k, network, &g, info)) return k.o.status;
    const int64_t count = network->contact_count;
    double *p = network->spare[0], *x = network->current;
    for (int64_t c = 0; c < count; c++) p[c] = network->slope[c] > 0 ? p[c] : 0;
    k.o.info.sweeps = 1;
    k.o.status = nlc_displace(network, NLC_OF_CHANGES, p, normal, &k.o.info.culprit);
    for (int64_t c = 0; c < count && k.o.status == NLC_OK; c++) {
        const double slope = network->slope[c], own = p[c] / (slope > 1e-290 ? slope : 1e-290);
        x[c] = slope > 1e-290 ? own - (network->side[2 * c] + network->side[2 * c + 1]) : 0;
    }
    if (finish(network, x, count, k.in - k.u.slope, &k.o)) scale_up(doverlap, x, count, k.in - k.u.slope);
    return nlc_report(info, &k.o.info, k.o.status);
}

/*
 * Sum over a particle's contacts of D / (1 - share_i b_i - share_j b_j).  That is more than the tangent of the contact: by the
 * argument of bound.h D^-1 - C >= diag(1 - share_i b_i - share_j b_j) D^-1.
 */
static double stiffness_on(const nlc_network *n, int64_t particle)
{
    const bool coupled = n->settings.model->within;
    double sum = 0;
    for (int64_t p = n->start[particle]; p < n->start[particle + 1]; p++) {
        const int64_t c = n->entry[p] >> 1, i = n->i[c], j = n->j[c];
        double left = 1;
        if (coupled && i < n->particle_count) left -= n->share[2 * c] * n->bound[i];
        if (coupled && j < n->particle_count) left -= n->share[2 * c + 1] * n->bound[j];
        sum += n->slope[c] / left;
    }
    return sum;
}

nlc_status nlc_tangent_bound(nlc_network *network, double *NLC_RESTRICT stiffness, const double *NLC_RESTRICT force,
                             const double *NLC_RESTRICT normal, nlc_info *info)
{
    call k;
    const given g = {stiffness, 0, force, normal, NLC_OK, NLC_TANGENT_BOUND};
    if (!begin(&k, network, &g, info)) return k.o.status;
    nlc_bound bound = {0, -1, 0};
    if (network->settings.model->within) {
        nlc_bound_particles(network, normal, &bound);
        k.o.info.lambda_upper = bound.upper;
        k.o.info.critical_particle = bound.where;
        k.o.info.blocks = bound.blocks;
    } else {
        k.o.info.lambda_lower = k.o.info.lambda_upper = 0;
    }
    if (bound.upper >= 1) k.o.status = NLC_ERROR_UNSTABLE;
    double *sum = network->growth;
    for (int64_t p = 0; p < network->particle_count; p++) sum[p] = p < network->owned && bound.upper < 1 ? stiffness_on(network, p) : 0;
    if (finish(network, sum, network->particle_count, k.u.slope, &k.o)) scale_up(stiffness, sum, network->particle_count, k.u.slope);
    return nlc_report(info, &k.o.info, k.o.status);
}
