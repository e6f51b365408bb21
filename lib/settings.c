/* SPDX-License-Identifier: BSD-2-Clause */
/* settings.c - a network's options: checks, defaults, and what follows from them. */
#include <string.h>

#include "collective.h"
#include "hertz.h"
#include "layout.h"
#include "structs.h"

#define DEFAULT_TOLERANCE 1e-8
#define DEFAULT_MAX_SWEEPS 1000

static bool is_finite_nonnegative(double x)
{
    return nlc_is_finite(x) && x >= 0;
}

const nlc_model *nlc_model_of(const nlc_options *o)
{
    const bool undeformed = o->model == NLC_MODEL_HALF_SPACE && o->points == NLC_POINTS_UNDEFORMED;
    return undeformed ? &nlc_half_space_undeformed : &nlc_models[o->model];
}

nlc_status nlc_read_settings(nlc_settings *settings, const nlc_options *o, int64_t *culprit)
{
    *culprit = o->model;
    if (o->model < 0 || o->model >= nlc_models_count) return NLC_ERROR_MODEL;
    *culprit = o->method;
    if (o->method != NLC_METHOD_AUTOMATIC && o->method != NLC_METHOD_FIXED_POINT) return NLC_ERROR_METHOD;
    *culprit = offsetof(nlc_options, tolerance);
    if (!is_finite_nonnegative(o->tolerance)) return NLC_ERROR_OPTION;
    *culprit = offsetof(nlc_options, max_sweeps);
    if (o->max_sweeps < 0) return NLC_ERROR_OPTION;
    *culprit = offsetof(nlc_options, prefactor);
    if (!is_finite_nonnegative(o->prefactor)) return NLC_ERROR_OPTION;
    *culprit = offsetof(nlc_options, simd);
    if (o->simd < NLC_SIMD_BEST || o->simd > NLC_SIMD_NEON) return NLC_ERROR_OPTION;
    *culprit = offsetof(nlc_options, points);
    if (o->points != NLC_POINTS_DEFORMED && o->points != NLC_POINTS_UNDEFORMED) return NLC_ERROR_OPTION;
    *culprit = offsetof(nlc_options, cache_size);
    if (!o->cache && o->cache_size > 0) return NLC_ERROR_OPTION;
    *culprit = (int64_t)((uintptr_t)o->cache % sizeof(double));
    if (*culprit != 0) return NLC_ERROR_ALIGNMENT;
    *culprit = offsetof(nlc_options, owned_particles);
    if (o->owned_particles < 0) return NLC_ERROR_OPTION;
    *culprit = o->exchange ? offsetof(nlc_options, reduce) : offsetof(nlc_options, exchange);
    if (!o->exchange != !o->reduce) return NLC_ERROR_NULL_FIELD;
    *culprit = offsetof(nlc_options, reserved);
    if (o->reserved) return NLC_ERROR_OPTION;
    *culprit = -1;
    settings->model = nlc_model_of(o);
    settings->variant = nlc_choose_variant(o->simd);
    settings->number = o->model;
    settings->method = o->method;
    settings->tolerance = o->tolerance <= 0 ? DEFAULT_TOLERANCE : o->tolerance < 1 ? o->tolerance : 1;
    settings->max_sweeps = o->max_sweeps > 0 ? o->max_sweeps : DEFAULT_MAX_SWEEPS;
    settings->parallel_for = o->parallel_for;
    settings->parallel_context = o->parallel_context;
    settings->cache = o->cache;
    settings->cache_size = o->cache_size;
    settings->owned_particles = o->owned_particles;
    settings->exchange = o->exchange;
    settings->reduce = o->reduce;
    settings->context = o->context;
    settings->prefactor = o->model == NLC_MODEL_HALF_SPACE && o->prefactor > 0 ? o->prefactor : 1;
    return NLC_OK;
}

/*
 * Kernel constants are at most 8 prefactors times U: far enough from the end of double's range for a sweep's intermediates.  What a
 * prefactor has too much, stiffnesses can have too little: within 2^100 the squares of either are in range (block.c).
 */
bool nlc_prefactor_in_range(const nlc_network *n, const nlc_settings *settings)
{
    const int e = nlc_exponent_above(settings->prefactor);
    return e > -100 && e <= 100 && n->scale_exponent + e + 3 < 1000;
}

static double hertz_stiffness_of(const nlc_network *n, int64_t c)
{
    const int32_t i = n->i[c], j = n->j[c];
    const nlc_material a = n->materials[n->material[i]], b = n->materials[n->material[j]];
    return nlc_hertz_stiffness(a.young, a.poisson, i < n->particle_count ? n->radius[i] : INFINITY, //
                               b.young, b.poisson, j < n->particle_count ? n->radius[j] : INFINITY);
}

/* (1-nu^2)/E, 2^ what is returned times; the largest is about 1.  0 where rigid or not in use. */
static int set_compliances(nlc_network *n)
{
    int softest = INT32_MAX; /* exponent of its modulus */
    for (int64_t m = 0; m < n->material_count; m++) n->kernel[m].compliance = 0;
    for (int64_t k = 0; k < n->body_count; k++) {
        const nlc_material row = n->materials[n->material[k]];
        if (!nlc_is_finite(row.young)) continue;
        n->kernel[n->material[k]].compliance = 1; /* in use */
        const int e = nlc_split(row.young).e;
        softest = e < softest ? e : softest;
    }
    for (int64_t m = 0; m < n->material_count; m++) {
        if (!(n->kernel[m].compliance > 0)) continue;
        const nlc_material row = n->materials[m];
        const nlc_scaled young = nlc_split(row.young);
        n->kernel[m].compliance = nlc_join((1 - row.poisson * row.poisson) / young.m, softest - young.e);
    }
    return softest < INT32_MAX ? softest : 0; /* where nothing yields there are no contacts */
}

/* Whether all radii and finite moduli are so moderate that every n_H can be held. */
static bool is_moderate(const nlc_network *n)
{
    for (int64_t k = 0; k < n->particle_count; k++)
        if (!nlc_is_moderate(n->radius[k])) return false;
    for (int64_t m = 0; m < n->material_count; m++)
        if (nlc_is_finite(n->materials[m].young) && !nlc_is_moderate(n->materials[m].young)) return false;
    return true;
}

/* [GC] 8, exponent: of the compliances.  As nlc_hertz_stiffness has it to the last bit, with what belongs to bodies computed once. */
static void set_stiffnesses(nlc_network *n, int exponent)
{
    if (!is_moderate(n)) {
        for (int64_t c = 0; c < n->contact_count; c++) n->stiffness[c] = hertz_stiffness_of(n, c);
        return;
    }
    double *curvature = n->largest; /* where walls have 0 at other times, too */
    const double unit = 4 * nlc_pow2(exponent);
    for (int64_t k = 0; k < n->body_count; k++) curvature[k] = k < n->particle_count ? 1 / n->radius[k] : 0;
    for (int64_t c = 0; c < n->contact_count; c++) {
        const int32_t i = n->i[c], j = n->j[c];
        const double compliance = n->kernel[n->material[i]].compliance + n->kernel[n->material[j]].compliance;
        n->stiffness[c] = unit / (3 * compliance * sqrt(curvature[i] + curvature[j]));
    }
}

void nlc_apply_settings(nlc_network *n, const nlc_settings *settings, const double *stiffness)
{
    n->settings = *settings;
    n->ranks = (nlc_ranks){.culprit = -1}; /* a failure is that of the callbacks there were */
    nlc_list_straddling(n);
    n->coupling_exponent = n->scale_exponent + nlc_exponent_above(settings->prefactor) + 3;
    const int exponent = set_compliances(n);
    for (int64_t m = 0; m < n->material_count; m++)
        if (settings->model->prepare && nlc_is_material(n->materials[m].young, n->materials[m].poisson))
            settings->model->prepare(&n->kernel[m], n->materials[m].poisson, settings->prefactor);
    if (!stiffness) set_stiffnesses(n, exponent);
    else if (n->contact_count > 0) memmove(n->stiffness, stiffness, (size_t)n->contact_count * sizeof *stiffness);
    n->top.stiffness = nlc_largest_magnitude(n->stiffness, n->contact_count);
    n->stiffness_exponent = nlc_exponent_above(n->top.stiffness);
}

static nlc_status check_stiffnesses(const nlc_network *n, const double *stiffness, int64_t *culprit)
{
    if (stiffness) {
        *culprit = nlc_first_not_positive(stiffness, n->contact_count);
        return *culprit >= 0 ? NLC_ERROR_STIFFNESS : NLC_OK;
    }
    const int64_t count = is_moderate(n) ? 0 : n->contact_count;
    for (*culprit = 0; *culprit < count; ++*culprit)
        if (!nlc_is_positive(hertz_stiffness_of(n, *culprit))) return NLC_ERROR_RANGE;
    return NLC_OK;
}

nlc_status nlc_set_options(nlc_network *network, const nlc_options *options, nlc_info *info)
{
    nlc_options o;
    nlc_settings settings;
    int arrays;
    int64_t culprit;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!network) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!nlc_network_is_valid(network)) return nlc_error(info, NLC_ERROR_NETWORK, -1);
    nlc_status status = nlc_read_options(&o, options);
    if (status != NLC_OK) return nlc_error(info, status, 1);
    if ((status = nlc_read_settings(&settings, &o, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
    status = nlc_check_ghosts(&settings, network->particle_count, network->i, network->j, network->contact_count, &culprit);
    if (status != NLC_OK) return nlc_error(info, status, culprit);
    if (!nlc_prefactor_in_range(network, &settings)) return nlc_error(info, NLC_ERROR_RANGE, -1);
    if ((status = check_stiffnesses(network, o.stiffness, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
    if ((status = nlc_choose_arrays(network, &o, &arrays, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
    if (arrays != network->arrays) nlc_lay_out(network, (char *)network, arrays);
    nlc_apply_settings(network, &settings, o.stiffness);
    return nlc_error(info, NLC_OK, -1);
}

size_t nlc_cache_size(const nlc_network *network)
{
    if (!network || !nlc_network_is_valid(network)) return 0;
    const int64_t kept = nlc_count_kept(network), most = PTRDIFF_MAX / (int64_t)sizeof(double);
    return (size_t)(kept < most ? kept : most) * sizeof(double);
}
