/* SPDX-License-Identifier: BSD-2-Clause */
/* lists.c - pairs from a host's neighbour lists. */
#include "particles.h"
#include "separation.h"
#include "structs.h"

typedef struct walk {
    const nlc_geometry *g;
    const nlc_lists *lists;
    double reach;
    int32_t *i, *j; /* NULL: only counted */
    int64_t count;
} walk;

/* The pair, if it is near enough. */
static nlc_status look_at(walk *w, int64_t i, int64_t j, int64_t *culprit)
{
    nlc_separation s;
    const nlc_status status = nlc_separate(&s, w->g, (int32_t)i, (int32_t)j, culprit);
    if (status != NLC_OK || -s.overlap >= w->reach) return status;
    if (w->i) {
        w->i[w->count] = (int32_t)i;
        w->j[w->count] = (int32_t)j;
    }
    w->count++;
    return NLC_OK;
}

static nlc_status walk_list(walk *w, int64_t list, int64_t *culprit)
{
    const nlc_lists *l = w->lists;
    const nlc_particles *p = &w->g->particles;
    const int64_t k = l->particle ? l->particle[list] : list;
    nlc_status status = NLC_OK;
    *culprit = list;
    if (k < 0 || k >= l->particle_count || k >= p->count) return NLC_ERROR_INDEX;
    if (l->length[k] < 0) return NLC_ERROR_COUNT;
    if (l->length[k] > 0 && !l->neighbour[k]) {
        *culprit = offsetof(nlc_lists, neighbour);
        return NLC_ERROR_NULL_FIELD;
    }
    for (int32_t q = 0; q < l->length[k] && status == NLC_OK; q++) {
        const int32_t j = l->mask ? l->neighbour[k][q] & l->mask : l->neighbour[k][q];
        if (j < 0 || j >= p->count) return NLC_ERROR_INDEX;
        status = look_at(w, k, j, culprit);
    }
    for (int64_t wall = 0; wall < p->wall_count && status == NLC_OK; wall++) status = look_at(w, k, p->count + wall, culprit);
    return status;
}

static nlc_status walk_all(walk *w, int64_t *culprit)
{
    nlc_status status = NLC_OK;
    w->count = 0;
    for (int64_t list = 0; list < w->lists->count && status == NLC_OK; list++) status = walk_list(w, list, culprit);
    return status;
}

static nlc_status check_lists(nlc_lists *to, const nlc_lists *from, int64_t *culprit)
{
    *culprit = 6;
    const nlc_status status = nlc_read_lists(to, from);
    if (status != NLC_OK) return status;
    if (to->reserved != 0) return NLC_ERROR_RESERVED;
    if (to->count < 0 || to->particle_count < 0) return NLC_ERROR_COUNT;
    *culprit = to->length ? offsetof(nlc_lists, neighbour) : offsetof(nlc_lists, length);
    return to->count > 0 && (!to->length || !to->neighbour) ? NLC_ERROR_NULL_FIELD : NLC_OK;
}

nlc_status nlc_contacts_from_lists(int64_t *NLC_RESTRICT count, int32_t *NLC_RESTRICT i, int32_t *NLC_RESTRICT j,
                                   int64_t capacity, const nlc_particles *particles, const nlc_positions *positions,
                                   const nlc_lists *lists, double reach, nlc_info *info)
{
    nlc_geometry g;
    nlc_lists l;
    int64_t culprit;
    nlc_status status;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (!count) return nlc_error(info, NLC_ERROR_NULL, 0);
    if (!i != !j) return nlc_error(info, NLC_ERROR_NULL, i ? 2 : 1);
    if (!particles || !positions || !lists) return nlc_error(info, NLC_ERROR_NULL, particles ? positions ? 6 : 5 : 4);
    if (capacity < 0) return nlc_error(info, NLC_ERROR_COUNT, 3);
    if (!nlc_is_finite(reach) || reach < 0) return nlc_error(info, NLC_ERROR_OPTION, 7);
    if ((status = nlc_read_geometry(&g, particles, positions, 4, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
    if ((status = check_lists(&l, lists, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
    walk w = {.g = &g, .lists = &l, .reach = reach};
    if ((status = walk_all(&w, &culprit)) != NLC_OK) return nlc_error(info, status, culprit);
    if (i && w.count > capacity) return nlc_error(info, NLC_ERROR_CAPACITY, w.count);
    if (i) {
        w.i = i;
        w.j = j;
        walk_all(&w, &culprit);
    }
    *count = w.count;
    return nlc_error(info, NLC_OK, -1);
}
