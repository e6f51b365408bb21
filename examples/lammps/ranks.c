/* SPDX-License-Identifier: BSD-2-Clause */
#include "ranks.h"

#include <stdlib.h>
#include <string.h>

#include "host.h"
#include "mail.h"
#include "tags.h"

void ranks_init(ranks *r, MPI_Comm world)
{
    memset(r, 0, sizeof *r);
    r->world = world;
    MPI_Comm_rank(world, &r->rank);
    MPI_Comm_size(world, &r->count);
}

void ranks_free(ranks *r)
{
    void *memory[] = {r->tag, r->peer, r->contact, r->out, r->in, r->request};
    for (size_t k = 0; k < sizeof memory / sizeof *memory; k++) free(memory[k]);
    tags_free(&r->here);
}

/* ------------------------------------------------------------------------------------------------------------- owners -- */

typedef struct question {
    int32_t tag, from, number; /* an owner's report has no number */
} question;

static tags take_reports(const ranks *r, const int32_t *tag, int32_t owned)
{
    mail reports = {.size = sizeof(question)};
    int64_t count;
    for (int32_t k = 0; k < owned; k++) mail_post(&reports, &(question){tag[k], r->rank, 0}, tag[k] % r->count);
    question *report = mail_deliver(&reports, r->world, &count);
    tags homes = tags_new(count);
    for (int64_t k = 0; k < count; k++) tags_put(&homes, report[k].tag, report[k].from);
    free(report);
    return homes;
}

/* owner[k] of wanted[k] */
static void ask_homes(const ranks *r, const tags *homes, const int32_t *wanted, int32_t *owner, int32_t count)
{
    mail questions = {.size = sizeof(question)}, answers = {.size = sizeof(question)};
    int64_t received;
    for (int32_t k = 0; k < count; k++) mail_post(&questions, &(question){wanted[k], r->rank, k}, wanted[k] % r->count);
    question *asked = mail_deliver(&questions, r->world, &received);
    for (int64_t k = 0; k < received; k++)
        mail_post(&answers, &(question){asked[k].tag, tags_get(homes, asked[k].tag), asked[k].number}, asked[k].from);
    free(asked);
    asked = mail_deliver(&answers, r->world, &received);
    for (int64_t k = 0; k < received; k++) owner[asked[k].number] = asked[k].from;
    free(asked);
}

/* Particles that were owned here and no longer are. */
static int32_t find_lost(const ranks *r, int32_t *lost)
{
    int32_t count = 0;
    for (int32_t k = 0; k < r->owned; k++)
        if (tags_get(&r->here, r->tag[k]) < 0) lost[count++] = r->tag[k];
    return count;
}

/* To the new owners of particles that have left. */
static ranks_state *send_states(const ranks *r, const tags *left, const ranks_state *state, int64_t states, int64_t *arrivals)
{
    mail states_out = {.size = sizeof *state};
    for (int64_t k = 0; k < states; k++) {
        const uint64_t body[2] = {state[k].key >> 32, state[k].key & UINT32_MAX};
        for (int b = 0; b < 2; b++) {
            const int32_t to = body[b] < WALL_KEY ? tags_get(left, (int32_t)body[b]) : -1;
            if (to >= 0) mail_post(&states_out, &state[k], to);
        }
    }
    return mail_deliver(&states_out, r->world, arrivals);
}

ranks_state *ranks_find(ranks *r, const int32_t *tag, int32_t owned, const int32_t *ghost_tag, int32_t *ghost_owner,
                        int32_t ghosts, const ranks_state *state, int64_t states, int64_t *arrivals)
{
    tags homes = take_reports(r, tag, owned), left = tags_new(r->owned);
    int32_t *lost = host_room(NULL, (size_t)r->owned * sizeof *lost),
            *owner = host_room(NULL, (size_t)r->owned * sizeof *owner);
    tags_free(&r->here);
    r->here = tags_new(owned);
    for (int32_t k = 0; k < owned; k++) tags_put(&r->here, tag[k], k);
    const int32_t count = find_lost(r, lost);
    ask_homes(r, &homes, ghost_tag, ghost_owner, ghosts);
    ask_homes(r, &homes, lost, owner, count);
    for (int32_t k = 0; k < count; k++)
        if (owner[k] >= 0) tags_put(&left, lost[k], owner[k]);
    ranks_state *arrived = send_states(r, &left, state, states, arrivals);
    r->tag = host_room(r->tag, (size_t)owned * sizeof *r->tag);
    if (owned > 0) memcpy(r->tag, tag, (size_t)owned * sizeof *tag);
    r->owned = owned;
    tags_free(&homes);
    tags_free(&left);
    free(lost);
    free(owner);
    return arrived;
}

/* --------------------------------------------------------------------------------------------------------------- plan -- */

typedef struct straddler {
    int64_t contact;
    uint64_t key;
    int32_t owner;
} straddler;

static int by_owner_and_key(const void *a, const void *b)
{
    const straddler *s = a, *t = b;
    if (s->owner != t->owner) return s->owner < t->owner ? -1 : 1;
    return s->key < t->key ? -1 : s->key > t->key;
}

static void find_peers(ranks *r, const straddler *s, int64_t count)
{
    r->peers = 0;
    for (int64_t k = 0; k < count; k++) {
        if (k == 0 || s[k].owner != s[k - 1].owner) r->peer[r->peers++] = (ranks_peer){s[k].owner, k, 0};
        r->peer[r->peers - 1].count++;
        r->contact[k] = s[k].contact;
    }
}

bool ranks_plan(ranks *r, const int64_t *contact, const uint64_t *key, const int32_t *owner, int64_t count)
{
    straddler *s = host_room(NULL, (size_t)count * sizeof *s);
    bool unique = true;
    for (int64_t k = 0; k < count; k++) s[k] = (straddler){contact[k], key[k], owner[k]};
    qsort(s, (size_t)count, sizeof *s, by_owner_and_key);
    for (int64_t k = 1; k < count; k++) unique = unique && by_owner_and_key(&s[k - 1], &s[k]) != 0;
    r->straddling = count;
    r->peer = host_room(r->peer, (size_t)r->count * sizeof *r->peer);
    r->request = host_room(r->request, 2 * (size_t)r->count * sizeof *r->request);
    r->contact = host_room(r->contact, (size_t)count * sizeof *r->contact);
    r->out = host_room(r->out, (size_t)count * sizeof *r->out);
    r->in = host_room(r->in, (size_t)count * sizeof *r->in);
    find_peers(r, s, count);
    free(s);
    return unique;
}

/* ------------------------------------------------------------------------------------------------------------- forces -- */

typedef struct force_on {
    double F[3];
    int32_t tag;
} force_on;

void ranks_return(ranks *r, double *F, const int32_t *ghost_tag, const int32_t *ghost_owner, int32_t ghosts)
{
    mail forces = {.size = sizeof(force_on)};
    int64_t received;
    for (int32_t k = 0; k < ghosts; k++) {
        const double *f = F + 3 * ((size_t)r->owned + (size_t)k);
        mail_post(&forces, &(force_on){{f[0], f[1], f[2]}, ghost_tag[k]}, ghost_owner[k]);
    }
    force_on *got = mail_deliver(&forces, r->world, &received);
    for (int64_t k = 0; k < received; k++)
        for (int x = 0; x < 3; x++) F[3 * (size_t)tags_get(&r->here, got[k].tag) + (size_t)x] += got[k].F[x];
    free(got);
}

/* ---------------------------------------------------------------------------------------------------------- callbacks -- */

int ranks_exchange(void *context, double *side)
{
    ranks *r = context;
    for (int64_t k = 0; k < r->straddling; k++) r->out[k] = side[2 * r->contact[k]];
    for (int p = 0; p < r->peers; p++) {
        const ranks_peer *peer = &r->peer[p];
        MPI_Irecv(r->in + peer->first, (int)peer->count, MPI_DOUBLE, peer->rank, 0, r->world, &r->request[2 * p]);
        MPI_Isend(r->out + peer->first, (int)peer->count, MPI_DOUBLE, peer->rank, 0, r->world, &r->request[2 * p + 1]);
    }
    MPI_Waitall(2 * r->peers, r->request, MPI_STATUSES_IGNORE);
    for (int64_t k = 0; k < r->straddling; k++) side[2 * r->contact[k] + 1] = r->in[k];
    r->exchanges++;
    r->messages += r->peers;
    r->sides += r->straddling;
    return 0;
}

int ranks_reduce(void *context, double *values, int32_t count, int32_t operation)
{
    ranks *r = context;
    r->reductions++;
    r->reduced += count;
    return MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, operation == 0 ? MPI_SUM : MPI_MAX, r->world);
}
