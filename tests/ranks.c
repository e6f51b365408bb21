/* SPDX-License-Identifier: BSD-2-Clause */
/* ranks.c - see ranks.h */
#include "ranks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *room(int64_t count, size_t size)
{
    void *p = calloc((size_t)(count > 0 ? count : 1), size);
    if (!p) abort();
    return p;
}

static void demand(bool good, const char *what, const rank *r)
{
    if (good) return;
    fprintf(stderr, "rank %d: %s\n", r->number, what);
    abort();
}

/* ------------------------------------------------------------------------------------------------------- callbacks -- */

/* All ranks are in the same call, the one whose turn it is. */
static void meet(rank *r, double *values, int32_t count, int kind)
{
    demand(rank_calls(r) % 3 == kind, "a call out of turn", r);
    r->values = values;
    r->kind = kind;
    r->count = count;
    demand(r->fixed[kind] == 0 || r->fixed[kind] == count, "another count than before", r);
    r->fixed[kind] = count;
    *(kind == 0 ? &r->exchanges : kind == 1 ? &r->sums : &r->maxima) += 1;
    pthread_barrier_wait(&r->all->barrier);
    for (int q = 0; q < r->all->count; q++) {
        demand(r->all->rank[q].kind == kind, "another rank is in another call", r);
        demand(kind == 0 || r->all->rank[q].count == count, "another rank has another count", r);
    }
}

/* One that fails has done its part, but hands out nothing of use. */
static int answer(const rank *r)
{
    const int64_t at = rank_calls(r);
    return at == r->fail_at || at == r->fail_too[0] || at == r->fail_too[1] ? 1000 + r->number : 0;
}

static int exchange(void *context, double *side)
{
    rank *r = context;
    const int64_t n = r->s.contacts;
    double *ghost = room(n, sizeof *ghost);
    meet(r, side, 0, 0);
    for (int64_t c = 0; c < n; c++) {
        if (r->peer[c] < 0) continue;
        const rank *p = &r->all->rank[r->peer[c]];
        const int64_t at = r->there[c];
        const int here = r->s.i[c] < r->owned ? 1 : 0; /* the ghost's side */
        ghost[c] = p->values[2 * at + (r->swapped[c] == p->swapped[at] ? here : 1 - here)];
        demand(isfinite(ghost[c]), "a value that is not finite", r);
    }
    pthread_barrier_wait(&r->all->barrier);
    for (int64_t c = 0; c < n; c++)
        if (r->peer[c] >= 0) side[2 * c + (r->s.i[c] < r->owned ? 1 : 0)] = answer(r) ? NAN : rank_calls(r) == r->odd_at ? r->odd : ghost[c];
    free(ghost);
    return answer(r);
}

static int reduce(void *context, double *values, int32_t count, int32_t operation)
{
    rank *r = context;
    double *result = room(count, sizeof *result);
    meet(r, values, count, operation == NLC_REDUCE_SUM ? 1 : 2);
    for (int32_t k = 0; k < count; k++) {
        result[k] = r->all->rank[0].values[k];
        for (int q = 1; q < r->all->count; q++) {
            const double v = r->all->rank[q].values[k];
            demand(!isnan(v), "a value that is not a number", r);
            result[k] = operation == NLC_REDUCE_SUM ? result[k] + v : result[k] > v ? result[k] : v;
        }
    }
    pthread_barrier_wait(&r->all->barrier);
    for (int32_t k = 0; k < count; k++) values[k] = answer(r) ? NAN : rank_calls(r) == r->odd_at ? r->odd : result[k];
    free(result);
    return answer(r);
}

/* ----------------------------------------------------------------------------------------------------------- making -- */

static int owner_of(const scene *whole, const int *owner, int32_t body)
{
    return body < whole->particles ? owner[body] : -1;
}

static int32_t add_particle(rank *r, const scene *whole, int32_t *place, int32_t k)
{
    if (place[k] >= 0) return place[k];
    place[k] = scene_particle(&r->s, whole->radius[k], whole->material[k]);
    r->particle[place[k]] = k;
    return place[k];
}

static void make_rank(rank *r, const int *owner, rng *g)
{
    const scene *whole = r->all->whole;
    int32_t *place = room(whole->particles, sizeof *place);
    for (int64_t k = 0; k < whole->particles; k++) place[k] = -1;
    scene_init(&r->s);
    r->particle = room(whole->particles, sizeof *r->particle);
    r->contact = room(whole->contacts, sizeof *r->contact);
    r->swapped = room(whole->contacts, sizeof *r->swapped);
    r->peer = room(whole->contacts, sizeof *r->peer);
    r->there = room(whole->contacts, sizeof *r->there);
    for (int64_t m = 0; m < whole->materials; m++) scene_material(&r->s, whole->rows[m].young, whole->rows[m].poisson);
    for (int32_t k = 0; k < whole->particles; k++)
        if (owner[k] == r->number) add_particle(r, whole, place, k);
    r->owned = r->s.particles;
    for (int64_t c = 0; c < whole->contacts; c++) { /* ghosts */
        const int a = owner_of(whole, owner, whole->i[c]), b = owner_of(whole, owner, whole->j[c]);
        if (a == r->number && b >= 0 && b != a) add_particle(r, whole, place, whole->j[c]);
        if (b == r->number && a >= 0 && a != b) add_particle(r, whole, place, whole->i[c]);
    }
    for (int64_t w = 0; w < whole->walls; w++) scene_wall(&r->s, whole->wall_material[w]);
    const int64_t shift = (int64_t)rng_below(g, (uint64_t)whole->contacts + 1);
    for (int64_t m = 0; m < whole->contacts; m++) { /* in another order on each rank */
        const int64_t c = (m + shift) % whole->contacts;
        const int a = owner_of(whole, owner, whole->i[c]), b = owner_of(whole, owner, whole->j[c]);
        if (a != r->number && b != r->number) continue;
        int32_t end[2] = {whole->i[c], whole->j[c]};
        for (int side = 0; side < 2; side++)
            end[side] = end[side] < whole->particles ? place[end[side]] : end[side] - (int32_t)(whole->particles - r->s.particles);
        const int64_t at = r->s.contacts;
        const double *n = whole->normal + 3 * c, sign = rng_sign(g);
        r->contact[at] = c;
        r->swapped[at] = sign < 0;
        r->peer[at] = a == b || a < 0 || b < 0 ? -1 : a == r->number ? b : a;
        scene_contact(&r->s, end[sign < 0], end[sign > 0], whole->overlap[c], 1, 0, 0);
        for (int x = 0; x < 3; x++) r->s.normal[3 * at + x] = sign * n[x];
    }
    r->displacement = room(2 * r->s.contacts, sizeof *r->displacement);
    r->change = room(r->s.contacts, sizeof *r->change);
    r->stiffness = room(r->s.particles, sizeof *r->stiffness);
    r->turning = room(3 * r->s.particles, sizeof *r->turning);
    free(place);
}

void ranks_init(ranks *w, const scene *whole, const int *owner, int count, rng *g)
{
    *w = (ranks){.count = count, .whole = whole, .rank = room(count, sizeof *w->rank)};
    pthread_barrier_init(&w->barrier, 0, (unsigned)count);
    for (int q = 0; q < count; q++) {
        w->rank[q].all = w;
        w->rank[q].number = q;
        make_rank(&w->rank[q], owner, g);
    }
    for (int q = 0; q < count; q++) {
        rank *r = &w->rank[q];
        for (int64_t c = 0; c < r->s.contacts; c++) {
            if (r->peer[c] < 0) continue;
            const rank *p = &w->rank[r->peer[c]];
            while (p->contact[r->there[c]] != r->contact[c]) r->there[c]++;
        }
    }
}

void ranks_free(ranks *w)
{
    for (int q = 0; q < w->count; q++) {
        rank *r = &w->rank[q];
        scene_free(&r->s);
        free(r->particle), free(r->contact), free(r->swapped), free(r->peer), free(r->there);
        free(r->displacement), free(r->change), free(r->stiffness), free(r->turning);
    }
    free(w->rank);
    pthread_barrier_destroy(&w->barrier);
}

static void *begin(void *argument)
{
    rank *r = argument;
    r->exchanges = r->sums = r->maxima = 0;
    r->task(r);
    return 0;
}

void ranks_run(ranks *w, void (*task)(rank *))
{
    for (int q = 0; q < w->count; q++) {
        w->rank[q].task = task;
        if (pthread_create(&w->rank[q].thread, 0, begin, &w->rank[q]) != 0) abort();
    }
    for (int q = 0; q < w->count; q++) pthread_join(w->rank[q].thread, 0);
}

/* ------------------------------------------------------------------------------------------------------------ tasks -- */

void rank_build(rank *r)
{
    r->s.options = r->all->whole->options;
    r->s.options.owned_particles = r->owned;
    r->s.options.exchange = exchange;
    r->s.options.reduce = reduce;
    r->s.options.context = r;
    r->status = scene_build(&r->s);
}

void rank_solve(rank *r)
{
    r->status = scene_solve(&r->s, &r->info);
}

void rank_sweep(rank *r)
{
    scene *s = &r->s;
    r->info.struct_size = sizeof r->info;
    r->status = nlc_sweep(s->network, r->displacement, s->force, s->overlap, s->normal, &r->info);
}

void rank_energy(rank *r)
{
    scene *s = &r->s;
    r->info.struct_size = sizeof r->info;
    r->status = nlc_energy(s->network, &r->energy, s->force, s->overlap, s->normal, &r->info);
}

void rank_tangent(rank *r)
{
    scene *s = &r->s;
    r->info.struct_size = sizeof r->info;
    r->status = nlc_tangent(s->network, r->change, s->overlap, s->force, s->normal, &r->info);
}

void rank_tangent_inverse(rank *r)
{
    scene *s = &r->s;
    r->info.struct_size = sizeof r->info;
    r->status = nlc_tangent_inverse(s->network, r->change, s->overlap, s->force, s->normal, &r->info);
}

void rank_tangent_bound(rank *r)
{
    scene *s = &r->s;
    r->info.struct_size = sizeof r->info;
    r->status = nlc_tangent_bound(s->network, r->stiffness, s->force, s->normal, &r->info);
}

/* No callback is called. */
void rank_turning(rank *r)
{
    scene *s = &r->s;
    if (s->particles > 0) memset(r->turning, 0, 3 * (size_t)s->particles * sizeof *r->turning);
    r->info.struct_size = sizeof r->info;
    r->status = nlc_assemble_turning(s->network, r->turning, 0, s->force, s->overlap, s->normal, &r->info);
}

int64_t rank_calls(const rank *r)
{
    return r->exchanges + r->sums + r->maxima;
}
