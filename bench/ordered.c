/* SPDX-License-Identifier: BSD-2-Clause */
/* ordered.c - what a host does with nlc_order. */
#include "ordered.h"

#include <stdlib.h>
#include <string.h>

/* Row m becomes what row from[m] was; false: no memory. */
static bool permute(void *rows, size_t size, const int64_t *from, int64_t count)
{
    char *old = malloc((size_t)count * size + 1), *row = rows;
    if (!old) return false;
    memcpy(old, rows, (size_t)count * size);
    for (int64_t m = 0; m < count; m++) memcpy(row + (size_t)m * size, old + (size_t)from[m] * size, size);
    free(old);
    return true;
}

static nlc_status find(const packing *p, const neighbours *n, int32_t *particle, int64_t *contact)
{
    const nlc_particles particles = packing_particles(p);
    const size_t size = nlc_network_size(&particles, n->count, NULL);
    void *memory = malloc(size + 1);
    nlc_network *network;
    nlc_status status = memory ? NLC_OK : NLC_ERROR_MEMORY_SIZE;
    if (!status) status = nlc_network_init(&network, memory, size, &particles, n->i, n->j, n->count, NULL, NULL);
    if (!status) status = nlc_order(network, particle, contact, NULL);
    free(memory);
    return status;
}

/* Pairs first, then contacts with walls. */
static bool order_contacts(neighbours *n, const int64_t *contact, int64_t *from)
{
    int64_t pairs = 0, walls = n->pair_count;
    for (int64_t m = 0; m < n->count; m++) from[contact[m] < n->pair_count ? pairs++ : walls++] = contact[m];
    return permute(n->i, sizeof *n->i, from, n->count) && permute(n->j, sizeof *n->j, from, n->count) &&
           permute(n->overlap, sizeof *n->overlap, from, n->count) && permute(n->normal, sizeof *n->normal, from, n->count);
}

static bool order_particles(packing *p, neighbours *n, const int32_t *particle, int32_t *place, int64_t *from)
{
    for (int64_t m = 0; m < p->count; m++) {
        from[m] = particle[m];
        place[particle[m]] = (int32_t)m;
    }
    for (int64_t c = 0; c < n->count; c++) { /* in pairs the lower number comes first, as neighbours.h says */
        const int32_t i = place[n->i[c]], j = n->j[c] < p->count ? place[n->j[c]] : n->j[c];
        n->i[c] = i < j ? i : j;
        n->j[c] = i < j ? j : i;
        for (int d = 0; d < 3 && i > j; d++) n->normal[c][d] = -n->normal[c][d];
    }
    return permute(p->x, sizeof *p->x, from, p->count) && permute(p->radius, sizeof *p->radius, from, p->count) &&
           permute(p->material, sizeof *p->material, from, p->count) && permute(p->id, sizeof *p->id, from, p->count);
}

static bool rename_packing(packing *p)
{
    static const char prefix[] = "ordered:";
    char *name = malloc(sizeof prefix + strlen(p->name));
    if (!name) return false;
    strcpy(name, prefix);
    strcat(name, p->name);
    free(p->name);
    p->name = name;
    return true;
}

const char *ordered_renumber(packing *p, neighbours *n)
{
    const size_t most = (size_t)(p->count > n->count ? p->count : n->count) + 1;
    int32_t *particle = malloc(2 * most * sizeof *particle), *place = particle ? particle + most : NULL;
    int64_t *contact = malloc(2 * most * sizeof *contact), *from = contact ? contact + most : NULL;
    const char *reason = particle && contact ? NULL : "out of memory";
    if (!reason) {
        const nlc_status status = find(p, n, particle, contact);
        if (status) reason = nlc_strerror(status);
    }
    if (!reason && !(order_contacts(n, contact, from) && order_particles(p, n, particle, place, from) && rename_packing(p)))
        reason = "out of memory";
    free(contact);
    free(particle);
    return reason;
}
