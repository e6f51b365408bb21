/* SPDX-License-Identifier: BSD-2-Clause */
/* collective.c - networks shared out among ranks. */
#include "collective.h"

#include <float.h>

enum { EXCHANGE, SUMS, MAXIMA };
enum { BETWEEN, LAST_BUT_ONE, LAST }; /* where a reduction is in a function */

#define FAILED 1       /* the first value of a reduction, of a rank that has */
#define LEAVING 0x1p40 /* of one that has heard of it: more than all ranks together can have failed */

/*
 * No owner has a larger number.  In the units of an iteration coupling is below 2^200 (solve.c, tangent.c), directions are 2^-90
 * apart, and the rest is for forces and how many there are: squares and their sums are in range.
 */
#define MOST 0x1p450

/* What is called where nothing is to be told. */
static double *nothing(nlc_network *n)
{
    return n->part->side;
}

void nlc_list_straddling(nlc_network *n)
{
    n->owned = n->settings.owned_particles > 0 ? n->settings.owned_particles : n->particle_count;
    n->straddling = 0;
    for (int64_t c = 0; nlc_is_shared(n) && c < n->contact_count; c++)
        if (nlc_is_straddling(n, c)) n->origin[n->straddling++] = c;
}

nlc_status nlc_check_ghosts(const nlc_settings *settings, int64_t particles, const int32_t *i, const int32_t *j, int64_t contacts,
                            int64_t *culprit)
{
    const int64_t owned = settings->owned_particles;
    *culprit = offsetof(nlc_options, owned_particles);
    if (owned > particles) return NLC_ERROR_OPTION;
    *culprit = offsetof(nlc_options, exchange);
    if (owned > 0 && owned < particles && !settings->exchange) return NLC_ERROR_NULL_FIELD;
    for (*culprit = 0; owned > 0 && *culprit < contacts; ++*culprit)
        if (i[*culprit] >= owned && j[*culprit] >= owned) return NLC_ERROR_GHOST;
    *culprit = -1;
    return NLC_OK;
}

void nlc_fail(nlc_network *n, nlc_status status, int64_t culprit)
{
    if (n->ranks.status != NLC_OK) return;
    n->ranks.status = status;
    n->ranks.culprit = culprit;
}

static void exchange(nlc_network *n, double *side)
{
    n->ranks.turn = SUMS;
    const int answer = n->settings.exchange(n->settings.context, side);
    if (answer != 0) nlc_fail(n, NLC_ERROR_CALLBACK, answer);
    for (int64_t s = 0; s < n->straddling; s++) {
        const int64_t c = nlc_straddling(n)[s], e = nlc_ghost_side(n, c);
        if (answer == 0 && nlc_abs_bits(side[e]) <= nlc_bits(n->ranks.most)) continue;
        side[e] = 0;
        nlc_fail(n, NLC_ERROR_CALLBACK, 0);
    }
}

/* The reduction whose turn it is; values has room for all.  Whether it has not failed.  Maxima may be infinite, sums are not. */
static bool reduce(nlc_network *n, double *values, double first)
{
    const bool sums = n->ranks.turn == SUMS;
    const int32_t count = sums ? NLC_SUMS : NLC_MAXIMA;
    n->ranks.turn = sums ? MAXIMA : EXCHANGE;
    values[0] = first;
    const int answer = n->settings.reduce(n->settings.context, values, count, sums ? NLC_REDUCE_SUM : NLC_REDUCE_MAX);
    bool good = answer == 0;
    for (int32_t k = 0; k < count; k++) good &= sums ? nlc_is_finite(values[k]) : !nlc_is_nan(values[k]);
    if (!good) nlc_fail(n, NLC_ERROR_CALLBACK, answer);
    return good;
}

/* One reduction more, in which nothing else is told.  What the others told, 0 if that is not known. */
static double tell(nlc_network *n, double first)
{
    double values[NLC_SUMS] = {0};
    if (n->ranks.turn == EXCHANGE) exchange(n, nothing(n));
    return reduce(n, values, first) ? values[0] : 0;
}

/*
 * After a reduction in which this rank has heard of a failure, or which failed here.  In the first case the next one is the last:
 * there may be ranks on which this one failed, and they are in it.  In the other case the rest may have heard of another failure,
 * and be leaving in the next one; else they hear of this one there, and leave in the one behind it.
 */
static void leave(nlc_network *n, bool heard, int place)
{
    if (heard || (tell(n, FAILED) < LEAVING && place != LAST_BUT_ONE)) tell(n, LEAVING);
}

/* The next reduction, of count values behind the first one. */
static bool next(nlc_network *n, double *values, int count, int place)
{
    double all[NLC_SUMS] = {0};
    if (count > 0) memcpy(all + 1, values, (size_t)count * sizeof *all);
    const bool told = n->ranks.status != NLC_OK;
    const bool heard = reduce(n, all, told ? FAILED : 0);
    n->ranks.over = !heard || all[0] > 0;
    if (n->ranks.over && place != LAST) leave(n, heard || told, place);
    if (!n->ranks.over && count > 0) memcpy(values, all + 1, (size_t)count * sizeof *all);
    return !n->ranks.over;
}

/* Until it is this callback's turn. */
static bool wait_for(nlc_network *n, int turn)
{
    while (!n->ranks.over && n->ranks.turn != turn)
        if (n->ranks.turn == EXCHANGE) exchange(n, nothing(n));
        else next(n, 0, 0, BETWEEN);
    return !n->ranks.over;
}

/* What has to be the same on all ranks, as a number: what is called, and the options that decide what comes next. */
static double fingerprint(const nlc_network *n, nlc_function function)
{
    const nlc_settings *s = &n->settings;
    const uint64_t part[6] = {(uint64_t)function, (uint64_t)s->number, (uint64_t)s->method + (s->model->potential ? 2 : 0),
                              nlc_bits(s->tolerance), (uint64_t)s->max_sweeps, nlc_bits(s->prefactor)};
    uint64_t h = 0;
    for (int k = 0; k < 6; k++) { /* the mixing is that of splitmix64 */
        h += part[k] + UINT64_C(0x9e3779b97f4a7c15);
        h = (h ^ (h >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
        h = (h ^ (h >> 27)) * UINT64_C(0x94d049bb133111eb);
        h ^= h >> 31;
    }
    return (double)(h >> 11);
}

/* Whether numbers that are exchanged are in units in which they are moderate. */
static bool has_units(const nlc_network *n, nlc_function function)
{
    if (function == NLC_SWEEP || function == NLC_ENERGY) return false;
    return function != NLC_SOLVE || n->settings.method == NLC_METHOD_AUTOMATIC;
}

bool nlc_meet(nlc_network *n, nlc_function function, nlc_status status, int64_t culprit, double *bodies, double *maxima, int count)
{
    const double here = fingerprint(n, function);
    double values[NLC_MAXIMA - 1] = {here, -here};
    n->ranks = (nlc_ranks){.turn = EXCHANGE, .culprit = -1, .most = DBL_MAX};
    for (int64_t e = 0; e < 2 * n->contact_count; e++) nothing(n)[e] = 0;
    if (status != NLC_OK) nlc_fail(n, status, culprit);
    else if (bodies) nlc_exchange_particles(n, bodies);
    for (int k = 0; k < count; k++) values[2 + k] = maxima[k];
    if (!nlc_max_over_ranks(n, values, count + 2)) return false;
    for (int k = 0; k < count; k++) maxima[k] = values[2 + k];
    n->ranks.most = has_units(n, function) ? MOST : NLC_MOST;
    if (values[0] + values[1] > 0) nlc_give_up(n, NLC_ERROR_OPTION);
    return !n->ranks.over;
}

void nlc_give_up(nlc_network *n, nlc_status status)
{
    nlc_fail(n, status, -1);
    nlc_sum_over_ranks(n, 0, 0);
}

bool nlc_take_leave(nlc_network *n, const double *force, nlc_outcome *out)
{
    double sums[3] = {0, (double)out->info.blocks, out->status & NLC_WARNING_CLOSE};
    if (!nlc_is_shared(n)) return true;
    for (int64_t c = 0; force && c < n->contact_count; c++) sums[0] += force[c] > 0 ? 1 : 0;
    for (int64_t s = 0; force && s < n->straddling; s++) sums[0] -= force[nlc_straddling(n)[s]] > 0 ? 0.5 : 0;
    if (out->status < 0) nlc_give_up(n, out->status);
    if (wait_for(n, SUMS) && next(n, sums, 3, LAST_BUT_ONE)) next(n, 0, 0, LAST);
    if (nlc_is_over(n, out)) return false;
    out->info.active = (int64_t)(sums[0] + 0.5);
    out->info.blocks = (int64_t)sums[1];
    out->status |= sums[2] > 0 ? NLC_WARNING_CLOSE : 0;
    return true;
}

bool nlc_is_over(const nlc_network *n, nlc_outcome *out)
{
    if (!nlc_is_shared(n) || !n->ranks.over) return false;
    out->status = n->ranks.status != NLC_OK ? n->ranks.status : NLC_ERROR_REMOTE;
    out->info.culprit = n->ranks.culprit;
    return true;
}

bool nlc_sum_over_ranks(nlc_network *n, double *values, int count)
{
    return !nlc_is_shared(n) || (wait_for(n, SUMS) && next(n, values, count, BETWEEN));
}

bool nlc_max_over_ranks(nlc_network *n, double *values, int count)
{
    return !nlc_is_shared(n) || (wait_for(n, MAXIMA) && next(n, values, count, BETWEEN));
}

double nlc_dot_over_ranks(nlc_network *n, double here, const double *a, const double *b)
{
    for (int64_t s = 0; s < n->straddling; s++) here -= 0.5 * a[nlc_straddling(n)[s]] * b[nlc_straddling(n)[s]];
    nlc_sum_over_ranks(n, &here, 1);
    return here;
}

bool nlc_on_any_rank(nlc_network *n, bool here)
{
    double value = here;
    nlc_max_over_ranks(n, &value, 1);
    return value > 0;
}

double nlc_largest_over_ranks(nlc_network *n, double here, int64_t *where)
{
    double value = here;
    nlc_max_over_ranks(n, &value, 1);
    if (value > here) *where = -1;
    return value;
}

void nlc_exchange_sides(nlc_network *n, double *side)
{
    if (!nlc_is_shared(n)) return;
    if (wait_for(n, EXCHANGE)) {
        exchange(n, side);
        return;
    }
    /* all is over: what a ghost was told before may be in other units */
    for (int64_t s = 0; s < n->straddling; s++) side[nlc_ghost_side(n, nlc_straddling(n)[s])] = 0;
}

void nlc_exchange_particles(nlc_network *n, double *value)
{
    if (!nlc_is_shared(n)) return;
    double *side = nothing(n);
    for (int64_t s = 0; s < n->straddling; s++) {
        const int64_t c = nlc_straddling(n)[s], ghost = nlc_ghost_side(n, c);
        side[ghost ^ 1] = value[ghost & 1 ? n->i[c] : n->j[c]];
        side[ghost] = 0;
    }
    nlc_exchange_sides(n, side);
    for (int64_t s = 0; s < n->straddling; s++) {
        const int64_t c = nlc_straddling(n)[s], ghost = nlc_ghost_side(n, c);
        value[ghost & 1 ? n->j[c] : n->i[c]] = side[ghost];
        side[ghost] = side[ghost ^ 1] = 0; /* what is called where nothing is to be told brings no numbers in other units */
    }
}

void nlc_clamp_ghosts(const nlc_network *n, double *value, double least, double most)
{
    for (int64_t k = n->owned; k < n->particle_count; k++)
        value[k] = value[k] < least ? least : value[k] < most ? value[k] : most;
}
