/* SPDX-License-Identifier: BSD-2-Clause */
/* mail.h - records from any rank to any other. */
#ifndef NLC_LAMMPS_MAIL_H
#define NLC_LAMMPS_MAIL_H

#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

/* What a rank has to send; set size, the rest is 0. */
typedef struct mail {
    size_t size; /* of a record */
    int64_t count, room;
    char *record;
    int *to;
} mail;

void mail_post(mail *m, const void *record, int to);

/* All ranks together.  Returns the records for this one, in the order of the ranks that sent them; to be freed.  Empties m. */
void *mail_deliver(mail *m, MPI_Comm world, int64_t *received);

#endif
