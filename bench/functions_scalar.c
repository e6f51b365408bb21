/* SPDX-License-Identifier: BSD-2-Clause */
/* functions_scalar.c - the functions of numbers alone. */
#include "functions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ARGUMENTS = 256 };

/* In the middle of the domains, spread enough for every branch of the evaluations to be met. */
typedef struct arguments {
    double force, overlap, theta, t, radius, r, z; /* t: contact radius / R */
    double n[3], m[3], between[3];                 /* inward unit normals, and from one point to the other */
} arguments;

static struct {
    arguments a[ARGUMENTS];
    double out[ARGUMENTS];
    double zero; /* the compiler does not know that it is */
} scalars;

static const double R = 1e-3, E = 1e8, E2 = 2e8, nu = 0.3;

static void set_arguments(void)
{
    for (int k = 0; k < ARGUMENTS; k++) {
        arguments *a = &scalars.a[k];
        const double x = (k * 97 % ARGUMENTS + 0.5) / ARGUMENTS, y = (k * 61 % ARGUMENTS + 0.5) / ARGUMENTS, phi = 6.28 * y;
        a->force = 0.1 + y;
        a->overlap = 1e-4 * (0.1 + y);
        a->theta = 0.3 + 2.8 * x;
        a->t = 0.05 + 0.4 * x;
        a->radius = a->t * R;
        a->r = 3 * y * R;
        a->z = 2 * x * R;
        const double n[3] = {0, 0, 1}, m[3] = {sin(a->theta) * cos(phi), sin(a->theta) * sin(phi), cos(a->theta)};
        memcpy(a->n, n, sizeof n);
        memcpy(a->m, m, sizeof m);
        for (int d = 0; d < 3; d++) a->between[d] = R * (n[d] - m[d]);
    }
}

/* Two loops over an expression of the arguments a and of the number that is carried on, v = that of the arguments named. */
#define CALLS(name, member, expression)                                                                                     \
    static nlc_status name##_throughput(void *context)                                                                      \
    {                                                                                                                       \
        (void)context;                                                                                                      \
        for (int k = 0; k < ARGUMENTS; k++) {                                                                               \
            const arguments *a = &scalars.a[k];                                                                             \
            const double v = a->member;                                                                                     \
            scalars.out[k] = (expression);                                                                                  \
        }                                                                                                                   \
        return NLC_OK;                                                                                                      \
    }                                                                                                                       \
    static nlc_status name##_latency(void *context)                                                                         \
    {                                                                                                                       \
        (void)context;                                                                                                      \
        double last = 0;                                                                                                    \
        for (int k = 0; k < ARGUMENTS; k++) {                                                                               \
            const arguments *a = &scalars.a[k];                                                                             \
            const double v = a->member + scalars.zero * last;                                                               \
            last = (expression);                                                                                            \
        }                                                                                                                   \
        scalars.out[0] = last;                                                                                              \
        return NLC_OK;                                                                                                      \
    }

/* Functions of several results, by their sum. */
static double sum2(const double u[2])
{
    return u[0] + u[1];
}

static double sum4(const double s[4])
{
    return s[0] + s[1] + s[2] + s[3];
}

static double point_displacement(double force, double theta)
{
    double u[2];
    nlc_point_displacement(u, force, theta, R, E, nu);
    return sum2(u);
}

static double point_stress(double force, double theta)
{
    double s[4];
    nlc_point_stress(s, force, theta, R, nu);
    return sum4(s);
}

static double point_traction(double force, double theta)
{
    double t[2];
    nlc_point_traction(t, force, theta, R, nu);
    return sum2(t);
}

static double love_displacement(double force, const arguments *a)
{
    double u[2];
    nlc_love_displacement(u, force, a->radius, a->r, a->z, E, nu);
    return sum2(u);
}

static double love_stress(double force, const arguments *a)
{
    double s[4];
    nlc_love_stress(s, force, a->radius, a->r, a->z, nu);
    return sum4(s);
}

#define SCALAR_LIST(X)                                                                                                      \
    X(nlc_hertz_stiffness, theta, nlc_hertz_stiffness(E * v, nu, R, E2, nu, R))                                             \
    X(nlc_hertz_force, overlap, nlc_hertz_force(1e9, v))                                                                    \
    X(nlc_hertz_overlap, force, nlc_hertz_overlap(1e9, v))                                                                  \
    X(nlc_contact_radius, force, nlc_contact_radius(v, E, nu, R, E2, nu, R))                                                \
    X(nlc_contact_displacement, force, nlc_contact_displacement(v, a->radius, 0.5 * a->radius, E, nu))                      \
    X(nlc_nonlocal_displacement, theta, nlc_nonlocal_displacement(a->force, v, R, E, nu))                                   \
    X(nlc_nonlocal_displacement_between, force, nlc_nonlocal_displacement_between(v, a->n, a->m, R, E, nu))                 \
    X(nlc_half_space_displacement, force, nlc_half_space_displacement(v, a->n, a->m, a->between, E, nu, 1))                 \
    X(nlc_point_displacement, theta, point_displacement(a->force, v))                                                       \
    X(nlc_point_stress, theta, point_stress(a->force, v))                                                                   \
    X(nlc_point_traction, theta, point_traction(a->force, v))                                                               \
    X(nlc_love_displacement, force, love_displacement(v, a))                                                                \
    X(nlc_love_stress, force, love_stress(v, a))                                                                            \
    X(nlc_love_nonlocal_displacement, theta, nlc_love_nonlocal_displacement(a->force, a->radius, v, R, E, nu))              \
    X(nlc_sphere_green, theta, nlc_sphere_green(v, nu))                                                                     \
    X(nlc_sphere_finite_size, theta, nlc_sphere_finite_size(v, nu, 1))                                                      \
    X(nlc_sphere_self, t, nlc_sphere_self(v, nu, 1))                                                                        \
    X(nlc_sphere_self_energy, t, nlc_sphere_self_energy(v, nu, 1))                                                          \
    X(nlc_sphere_displacement, theta, nlc_sphere_displacement(a->force, v, R, E, nu))

SCALAR_LIST(CALLS)

/* What gives no number: throughput only. */
#define CALL(name, expression)                                                                                              \
    static nlc_status name##_throughput(void *context)                                                                      \
    {                                                                                                                       \
        (void)context;                                                                                                      \
        for (int k = 0; k < ARGUMENTS; k++) scalars.out[k] = (double)(expression);                                          \
        return NLC_OK;                                                                                                      \
    }

static double model_info(int32_t model)
{
    nlc_model_record record = {.struct_size = sizeof record};
    return nlc_model_info(model, &record, NULL) == NLC_OK ? record.cost : 0;
}

static double network_size(int64_t count)
{
    const nlc_particles particles = {.struct_size = sizeof particles, .count = count, .material_count = 1};
    return (double)nlc_network_size(&particles, 6 * count, NULL);
}

#define OTHER_LIST(X)                                                                                                       \
    X(nlc_strerror, nlc_strerror(-(k & 31))[0])                                                                             \
    X(nlc_version, nlc_version()[0])                                                                                        \
    X(nlc_model_count, nlc_model_count())                                                                                   \
    X(nlc_model_info, model_info(k % 6))                                                                                    \
    X(nlc_model_find, nlc_model_find("point-force"))                                                                        \
    X(nlc_network_size, network_size(k))                                                                                    \
    X(nlc_carry_size, nlc_carry_size(k, k))

OTHER_LIST(CALL)

void functions_add(function_list *list, const char *key, const char *per, double count, nlc_status (*call)(void *),
                   void *context)
{
    if (list->count == FUNCTIONS_MAX) abort();
    timed_call *c = &list->calls[list->count++];
    *c = (timed_call){.per = per, .count = count, .call = call, .context = context};
    snprintf(c->key, sizeof c->key, "%s", key);
}

void functions_add_scalar(function_list *list)
{
    set_arguments();
#define ADD_BOTH(name, member, expression)                                                                                  \
    functions_add(list, #name " throughput", "call", ARGUMENTS, name##_throughput, NULL);                                   \
    functions_add(list, #name " latency", "call", ARGUMENTS, name##_latency, NULL);
    SCALAR_LIST(ADD_BOTH)
#define ADD(name, expression) functions_add(list, #name " throughput", "call", ARGUMENTS, name##_throughput, NULL);
    OTHER_LIST(ADD)
}
