/* SPDX-License-Identifier: BSD-2-Clause */
#include "mail.h"

#include <stdlib.h>
#include <string.h>

#include "host.h"

void mail_post(mail *m, const void *record, int to)
{
    if (m->count == m->room) {
        m->room = 2 * m->room + 64;
        m->record = host_room(m->record, (size_t)m->room * m->size);
        m->to = host_room(m->to, (size_t)m->room * sizeof *m->to);
    }
    memcpy(m->record + (size_t)m->count * m->size, record, m->size);
    m->to[m->count++] = to;
}

/* Sums of the counts before each rank; returns that of all. */
static int offsets(int *offset, const int *count, int most)
{
    int sum = 0;
    for (int k = 0; k < most; k++) {
        offset[k] = sum;
        sum += count[k];
    }
    return sum;
}

void *mail_deliver(mail *m, MPI_Comm world, int64_t *received)
{
    int peers;
    MPI_Comm_size(world, &peers);
    const size_t all = (size_t)peers;
    int *count = host_room(NULL, 5 * all * sizeof *count), *offset = count + all, *next = offset + all;
    int *in_count = next + all, *in_offset = in_count + all;
    char *out = host_room(NULL, (size_t)m->count * m->size);
    memset(count, 0, all * sizeof *count);
    for (int64_t k = 0; k < m->count; k++) count[m->to[k]] += (int)m->size; /* in bytes */
    offsets(offset, count, peers);
    memcpy(next, offset, all * sizeof *next);
    for (int64_t k = 0; k < m->count; k++) {
        memcpy(out + next[m->to[k]], m->record + (size_t)k * m->size, m->size);
        next[m->to[k]] += (int)m->size;
    }
    MPI_Alltoall(count, 1, MPI_INT, in_count, 1, MPI_INT, world);
    const int bytes = offsets(in_offset, in_count, peers);
    char *in = host_room(NULL, (size_t)bytes);
    MPI_Alltoallv(out, count, offset, MPI_BYTE, in, in_count, in_offset, MPI_BYTE, world);
    *received = bytes / (int64_t)m->size;
    free(count);
    free(out);
    free(m->record);
    free(m->to);
    *m = (mail){.size = m->size};
    return in;
}
