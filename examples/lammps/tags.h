/* SPDX-License-Identifier: BSD-2-Clause */
/* tags.h - a table from particles' tags to numbers of any kind that are not negative. */
#ifndef NLC_LAMMPS_TAGS_H
#define NLC_LAMMPS_TAGS_H

#include <stdint.h>

typedef struct tags {
    int32_t *entry; /* [mask + 1][2] tag, value; open addressing, value -1 is empty */
    uint32_t mask;
} tags;

tags tags_new(int64_t most); /* room for so many */
void tags_put(tags *t, int32_t tag, int32_t value);
int32_t tags_get(const tags *t, int32_t tag); /* -1: not there */
void tags_free(tags *t);

#endif
