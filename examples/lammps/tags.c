/* SPDX-License-Identifier: BSD-2-Clause */
#include "tags.h"

#include <stdlib.h>
#include <string.h>

#include "host.h"

tags tags_new(int64_t most)
{
    tags t = {NULL, 15};
    while (t.mask / 2 < most) t.mask = 2 * t.mask + 1;
    t.entry = host_room(NULL, 2 * ((size_t)t.mask + 1) * sizeof *t.entry);
    memset(t.entry, -1, 2 * ((size_t)t.mask + 1) * sizeof *t.entry);
    return t;
}

/* Where the tag is, or would be. */
static int32_t *find(const tags *t, int32_t tag)
{
    uint32_t at = (uint32_t)tag * UINT32_C(2654435769) >> 3 & t->mask;
    while (t->entry[2 * (size_t)at + 1] >= 0 && t->entry[2 * (size_t)at] != tag) at = (at + 1) & t->mask;
    return t->entry + 2 * (size_t)at;
}

void tags_put(tags *t, int32_t tag, int32_t value)
{
    int32_t *entry = find(t, tag);
    entry[0] = tag;
    entry[1] = value;
}

int32_t tags_get(const tags *t, int32_t tag)
{
    return find(t, tag)[1];
}

void tags_free(tags *t)
{
    free(t->entry);
}
