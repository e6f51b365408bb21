/* SPDX-License-Identifier: BSD-2-Clause */
/* sliding.c - from contact forces to forces and torques on the particles where contacts slide, [MC] III and IV. */
#include "assemble.h"
#include "contact.h"
#include "structs.h"
#include "vector.h"

/* What is known of the contacts beside force and normal. */
typedef struct contacts {
    const double *sliding, *displacement, *overlap;
    double friction;
} contacts;

static bool is_sliding(const double *t)
{
    return (nlc_abs_bits(t[0]) | nlc_abs_bits(t[1]) | nlc_abs_bits(t[2])) != 0;
}

/* The first one that has a direction which is not of unit length or not along the surfaces; -1: none. */
static int64_t first_not_tangent(const double *sliding, const double *normal, int64_t count)
{
    for (int64_t c = 0; c < count; c++) {
        const double *t = sliding + 3 * c;
        if (!is_sliding(t)) continue;
        if (!nlc_is_unit(t) || fabs(nlc_dot(t, normal + 3 * c)) > NLC_UNIT_TOLERANCE) return c;
    }
    return -1;
}

static nlc_status check_contacts(const nlc_network *n, const contacts *a, const double *normal, int64_t *culprit)
{
    if ((*culprit = first_not_tangent(a->sliding, normal, n->contact_count)) >= 0) return NLC_ERROR_SLIDING;
    if (a->displacement && (*culprit = nlc_first_not_finite(a->displacement, 2 * n->contact_count)) >= 0) {
        *culprit /= 2;
        return NLC_ERROR_NONLOCAL;
    }
    return (*culprit = nlc_first_not_finite(a->overlap, n->contact_count)) >= 0 ? NLC_ERROR_OVERLAP : NLC_OK;
}

/* Whether no lever and no sum can overflow.  A lever and what it is made from are sums of at most six of the caller's lengths. */
static bool in_range(const nlc_network *n, const contacts *a, const double *force, double largest, double largest_torque)
{
    const int64_t sides = a->displacement ? 2 * n->contact_count : 0;
    const int r = nlc_exponent_above(nlc_largest_magnitude(n->radius, n->particle_count));
    const int x = nlc_exponent_above(nlc_largest_magnitude(a->overlap, n->contact_count));
    const int w = nlc_exponent_above(nlc_largest_magnitude(a->displacement, sides));
    const int top = nlc_exponent_above(nlc_largest_magnitude(force, n->contact_count));
    const int length = 3 + (r > x ? r > w ? r : w : x > w ? x : w);
    return length <= 1023 && nlc_sums_in_range(n, largest, top + nlc_exponent_above(1 + a->friction)) &&
           nlc_sums_in_range(n, largest_torque, top + nlc_exponent_above(a->friction) + length);
}

/* Distance of the contact point from the centre of the particle on that side; a wall has no centre. */
static double lever(const nlc_network *n, const contacts *a, int64_t side)
{
    const int64_t c = side >> 1, body = side & 1 ? n->j[c] : n->i[c];
    const double own = a->displacement ? a->displacement[side] : 0, other = a->displacement ? a->displacement[side ^ 1] : 0;
    return body < n->particle_count ? n->radius[body] + nlc_place(own, other, a->overlap[c]) : 0;
}

/* A product of three numbers, each of which may be of any size. */
static void add_torque(nlc_vectors torque, int64_t body, double arm, nlc_scaled pull, const double *turn)
{
    const nlc_scaled moment = nlc_times(nlc_split(arm), pull);
    if (body < torque.count) nlc_add_vector(torque, body, nlc_join(moment.m, moment.e), turn);
}

/* The torques have the same sign: where the force is the opposite, so is the lever. */
static void add_friction(const nlc_network *n, const contacts *a, const nlc_body_forces *F, nlc_vectors torque, int64_t c,
                         double force, const double *normal)
{
    const double *t = a->sliding + 3 * c;
    const nlc_scaled pull = nlc_times(nlc_split(a->friction), nlc_split(force));
    const double turn[3] = {normal[1] * t[2] - normal[2] * t[1], normal[2] * t[0] - normal[0] * t[2],
                            normal[0] * t[1] - normal[1] * t[0]};
    const double arm_i = lever(n, a, 2 * c), arm_j = lever(n, a, 2 * c + 1);
    nlc_add_pair(n, F, c, -nlc_join(pull.m, pull.e), t);
    if (n->i[c] == n->j[c]) { /* in one piece, or the order of the sides would matter */
        add_torque(torque, n->i[c], arm_i + arm_j, pull, turn);
    } else {
        add_torque(torque, n->i[c], arm_i, pull, turn);
        add_torque(torque, n->j[c], arm_j, pull, turn);
    }
}

nlc_status nlc_assemble_sliding(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride,
                                double *NLC_RESTRICT torque, ptrdiff_t torque_stride, double *NLC_RESTRICT F_wall,
                                const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal,
                                const double *NLC_RESTRICT sliding, const double *NLC_RESTRICT displacement,
                                const double *NLC_RESTRICT overlap, double friction, nlc_info *info)
{
    int64_t culprit;
    double largest, largest_torque = 0;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    const int64_t count = network->contact_count, particles = network->particle_count;
    if (count == 0) return nlc_error(info, NLC_OK, -1);
    if (!F) return nlc_error(info, NLC_ERROR_NULL, 1);
    if (!torque) return nlc_error(info, NLC_ERROR_NULL, 3);
    if (!force) return nlc_error(info, NLC_ERROR_NULL, 6);
    if (!normal) return nlc_error(info, NLC_ERROR_NULL, 7);
    if (!sliding) return nlc_error(info, NLC_ERROR_NULL, 8);
    if (!overlap) return nlc_error(info, NLC_ERROR_NULL, 10);
    if (!nlc_read_stride(&F_stride, particles)) return nlc_error(info, NLC_ERROR_STRIDE, 2);
    if (!nlc_read_stride(&torque_stride, particles)) return nlc_error(info, NLC_ERROR_STRIDE, 4);
    if (!nlc_is_finite(friction) || friction < 0) return nlc_error(info, NLC_ERROR_OPTION, 11);
    const contacts a = {sliding, displacement, overlap, friction};
    const nlc_body_forces on = nlc_forces_on(network, F, F_stride, F_wall);
    const nlc_vectors torques = {(char *)torque, torque_stride, particles};
    nlc_status status = nlc_check_assembly(network, &on, force, normal, &largest, &culprit);
    if (status == NLC_OK) status = check_contacts(network, &a, normal, &culprit);
    if (status == NLC_OK && (culprit = nlc_first_vector_not_finite(torques, &largest_torque)) >= 0)
        status = NLC_ERROR_TOTAL_FORCE;
    if (status != NLC_OK) return nlc_error(info, status, culprit);
    if (!in_range(network, &a, force, largest, largest_torque)) return nlc_error(info, NLC_ERROR_RANGE, -1);

    nlc_info record = nlc_new_info();
    for (int64_t c = 0; c < count; c++) {
        record.active += force[c] > 0;
        nlc_add_pair(network, &on, c, force[c], normal + 3 * c);
        if (force[c] > 0 && is_sliding(sliding + 3 * c)) add_friction(network, &a, &on, torques, c, force[c], normal + 3 * c);
    }
    return nlc_report(info, &record, NLC_OK);
}
