/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * turning.c - the forces that come with the turning of contacts.
 *
 * The energy of a network depends on positions x through the overlaps, dE/dgamma = P, and through the angles between contacts on a
 * particle, on which the coupling depends: -dE/dx = -P dgamma/dx - P.(dC/dx).P / 2.  The first term is what nlc_assemble adds, the
 * second what is added here.  On a particle k it is, over pairs of sides with outward directions n, t = |n_e - n_f|^2,
 *     E_k = U_k sum P_e P_f c(t),   dE_k/dn_e = -2 U_k P_e sum P_f c'(t) n_f,
 * and n_e turns as the centre at its other end moves across it: dn_e = (1 - n_e n_e) (dx_other - dx_k) / distance.  The direction of
 * a contact with a wall, or with the particle's own image, does not turn.
 */
#include "assemble.h"
#include "contact.h"
#include "structs.h"
#include "vector.h"

#define CLOSEST -100 /* exponent of the smallest t: directions closer than 2^-50 are equal */

/* What all the sides have in common. */
typedef struct turning {
    const nlc_network *n;
    const double *force, *overlap, *normal;
    int exponent; /* of a power of 2 above the largest force */
} turning;

/* A side as a pair sees it. */
typedef struct side {
    double out[3], force, moment, tilted; /* (a/R)^2 / 10, and times chi - 1 */
} side;

static double approach(const turning *s, int64_t c)
{
    const nlc_network *n = s->n;
    const int64_t i = n->i[c], j = n->j[c];
    const double a = i < n->particle_count ? n->radius[i] : INFINITY, b = j < n->particle_count ? n->radius[j] : INFINITY;
    const double cap = a < b ? a : b, x = s->force[c] > 0 ? nlc_hertz_overlap(n->stiffness[c], s->force[c]) : 0;
    return nlc_is_finite(x) && x < cap ? x : cap;
}

static side side_of(const turning *s, int64_t e, int64_t particle)
{
    const double *v = s->normal + 3 * (e >> 1), out = nlc_outward(e), R = s->n->radius[particle];
    side a = {{out * v[0], out * v[1], out * v[2]}, nlc_join(s->force[e >> 1], -s->exponent), 0, 0};
    if (s->n->settings.model->shape != NLC_SHAPE_MOMENTS) return a;
    a.moment = 0.1 * nlc_effective(s->n, e, R) * (approach(s, e >> 1) / R);
    a.tilted = a.moment * nlc_tilt(s->n, e, particle);
    return a;
}

static double squared_distance(const side *a, const side *b)
{
    const double x = a->out[0] - b->out[0], y = a->out[1] - b->out[1], z = a->out[2] - b->out[2];
    return x * x + y * y + z * z;
}

/* Whether a contact can turn; the distance of its centres. */
static bool turns(const nlc_network *n, int64_t c)
{
    return n->i[c] != n->j[c] && n->i[c] < n->particle_count && n->j[c] < n->particle_count;
}

static double distance(const turning *s, int64_t c)
{
    return s->n->radius[s->n->i[c]] + (s->n->radius[s->n->j[c]] - s->overlap[c]);
}

static bool is_loaded(const turning *s, int64_t e)
{
    return nlc_abs_bits(s->force[e >> 1]) != 0;
}

#define EACH_LOADED(e, k) \
    for (int64_t p_##e = s->n->start[k], e = 0; p_##e < s->n->start[(k) + 1]; p_##e++) \
        if (is_loaded(s, e = s->n->entry[p_##e]))

/* The later one of two contacts in the same direction, of all particles that are owned here, or -1. */
static int64_t find_coincident(const turning *s)
{
    for (int64_t k = 0; k < s->n->owned; k++) {
        if (s->n->scale[k] <= 0) continue;
        EACH_LOADED(e, k)
        {
            const side a = side_of(s, e, k);
            EACH_LOADED(f, k)
            {
                const side b = side_of(s, f, k);
                if (p_f >= p_e) break;
                if (squared_distance(&a, &b) < nlc_pow2(CLOSEST)) return e >> 1;
            }
        }
    }
    return -1;
}

/* P sum P_f c'(t) n_f of a side, across it; the forces in units of their power of 2. */
static void pull_on(const turning *s, int64_t e, int64_t k, double pull[3])
{
    const side a = side_of(s, e, k);
    double sum[3] = {0, 0, 0};
    EACH_LOADED(f, k)
    {
        if (f == e) continue;
        const side b = side_of(s, f, k);
        const double c = b.force * s->n->settings.model->turning(nlc_kernel_of(s->n, k), squared_distance(&a, &b), a.moment + b.moment,
                                                                a.tilted + b.tilted);
        for (int x = 0; x < 3; x++) sum[x] += c * b.out[x];
    }
    const double along = nlc_dot(sum, a.out);
    for (int x = 0; x < 3; x++) pull[x] = a.force * (sum[x] - along * a.out[x]);
}

/* -dE/dx: on the other end 2 U P (...) / distance, and the opposite on the particle itself.  Ghosts' energies are other ranks'. */
static void add_forces(const turning *s, const nlc_body_forces *F)
{
    for (int64_t k = 0; k < s->n->owned; k++) {
        const nlc_scaled U = nlc_split(s->n->scale[k]);
        if (s->n->scale[k] <= 0) continue;
        EACH_LOADED(e, k)
        {
            double pull[3];
            if (!turns(s->n, e >> 1)) continue;
            const nlc_scaled r = nlc_split(distance(s, e >> 1));
            pull_on(s, e, k, pull);
            for (int x = 0; x < 3; x++) pull[x] = nlc_join(2 * U.m / r.m * pull[x], U.e - r.e + 2 * s->exponent);
            nlc_add_to_body(F, nlc_other_body(s->n, e), 1, pull);
            nlc_add_to_body(F, k, -1, pull);
        }
    }
}

static int64_t first_too_deep(const turning *s)
{
    for (int64_t c = 0; c < s->n->contact_count; c++)
        if (is_loaded(s, 2 * c) && turns(s->n, c) && !(distance(s, c) > 0)) return c;
    return -1;
}

/* Whether no sum can overflow: c' is at most some 100 t^(-5/2). */
static bool in_range(const turning *s, double largest)
{
    const nlc_network *n = s->n;
    double least = INFINITY;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const double r = is_loaded(s, 2 * c) && turns(n, c) ? distance(s, c) : INFINITY;
        least = r < least ? r : least;
    }
    if (!(least < INFINITY)) return true; /* nothing turns */
    const int steepest = n->coupling_exponent + 10 - 5 * CLOSEST / 2 - nlc_split(least).e;
    return nlc_sums_in_range(n, largest, 2 * s->exponent + steepest + nlc_exponent_above((double)n->contact_count));
}

nlc_status nlc_assemble_turning(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride, const double *NLC_RESTRICT force,
                                const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info)
{
    int64_t culprit;
    double largest;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    const nlc_model *model = network->settings.model;
    if (!model->potential) return nlc_error(info, NLC_ERROR_NO_POTENTIAL, network->settings.number);
    const int64_t count = network->contact_count, particles = network->particle_count;
    if (count == 0) return nlc_error(info, NLC_OK, -1);
    if (!F) return nlc_error(info, NLC_ERROR_NULL, 1); /* a contact has a particle */
    if (!force) return nlc_error(info, NLC_ERROR_NULL, 3);
    if (!overlap) return nlc_error(info, NLC_ERROR_NULL, 4);
    if (!normal) return nlc_error(info, NLC_ERROR_NULL, 5);
    if (!nlc_read_stride(&F_stride, particles)) return nlc_error(info, NLC_ERROR_STRIDE, 2);
    const nlc_body_forces on = nlc_forces_on(network, F, F_stride, NULL);
    const nlc_status status = nlc_check_assembly(network, &on, force, normal, &largest, &culprit);
    if (status != NLC_OK) return nlc_error(info, status, culprit);
    if ((culprit = nlc_first_not_finite(overlap, count)) >= 0) return nlc_error(info, NLC_ERROR_OVERLAP, culprit);
    const double top = nlc_largest_magnitude(force, count);
    const turning s = {network, force, overlap, normal, nlc_exponent_above(top)};
    if (!model->turning || nlc_abs_bits(top) == 0) return nlc_error(info, NLC_OK, -1);
    if (nlc_exponent_above(nlc_largest_magnitude(network->radius, particles)) > 1020 ||
        nlc_exponent_above(nlc_largest_magnitude(overlap, count)) > 1020)
        return nlc_error(info, NLC_ERROR_RANGE, -1);
    if ((culprit = first_too_deep(&s)) >= 0) return nlc_error(info, NLC_ERROR_OVERLAP, culprit);
    if (!in_range(&s, largest)) return nlc_error(info, NLC_ERROR_RANGE, -1);
    if ((culprit = find_coincident(&s)) >= 0) return nlc_error(info, NLC_ERROR_COINCIDENT, culprit);

    nlc_info record = nlc_new_info();
    for (int64_t c = 0; c < count; c++) record.active += force[c] > 0;
    add_forces(&s, &on);
    return nlc_report(info, &record, NLC_OK);
}
