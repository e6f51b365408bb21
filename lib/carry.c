/* SPDX-License-Identifier: BSD-2-Clause */
/* carry.c - values of contacts from one neighbour list to the next: both lists sorted by key, and walked side by side. */
#include <string.h>

#include "check.h"
#include "number.h"
#include "structs.h"

typedef struct item {
    uint64_t key;
    int64_t contact;
} item;

/* Two sorted runs, from[0 ... half-1] and from[half ... n-1], into to.  Of equal keys the first run's come first. */
static void merge(item *to, const item *from, int64_t half, int64_t n)
{
    int64_t a = 0, b = half;
    for (int64_t k = 0; k < n; k++) to[k] = a < half && (b == n || from[a].key <= from[b].key) ? from[a++] : from[b++];
}

static bool is_sorted(const item *items, int64_t n)
{
    for (int64_t k = 1; k < n; k++)
        if (items[k - 1].key > items[k].key) return false;
    return true;
}

/* By key; equal ones stay in order.  scratch: [n] */
static void sort(item *items, item *scratch, int64_t n)
{
    item *from = items, *to = scratch;
    if (is_sorted(items, n)) return;
    for (int64_t run = 1; run < n; run *= 2) {
        for (int64_t k = 0; k < n; k += 2 * run) {
            const int64_t left = n - k, length = left < 2 * run ? left : 2 * run;
            merge(to + k, from + k, run < length ? run : length, length);
        }
        item *const t = from;
        from = to;
        to = t;
    }
    if (from != items) memcpy(items, from, (size_t)n * sizeof *items);
}

static void fill(item *items, const uint64_t *key, int64_t n)
{
    for (int64_t c = 0; c < n; c++) items[c] = (item){key[c], c};
}

size_t nlc_carry_size(int64_t contact_count, int64_t old_count)
{
    const int64_t most = PTRDIFF_MAX / (4 * (int64_t)sizeof(item));
    if (contact_count < 0 || old_count < 0 || contact_count > most || old_count > most) return 0;
    const int64_t scratch = contact_count > old_count ? contact_count : old_count;
    return (size_t)(contact_count + old_count + scratch + 1) * sizeof(item);
}

nlc_status nlc_carry(double *NLC_RESTRICT nonlocal, const uint64_t *NLC_RESTRICT key, int64_t contact_count,
                     const double *NLC_RESTRICT old_nonlocal, const uint64_t *NLC_RESTRICT old_key, int64_t old_count,
                     void *memory, size_t memory_size, nlc_info *info)
{
    const size_t size = nlc_carry_size(contact_count, old_count);
    nlc_info record = nlc_new_info();
    int64_t culprit;
    if (!nlc_info_is_valid(info)) return NLC_ERROR_STRUCT_SIZE;
    if (size == 0) return nlc_error(info, NLC_ERROR_COUNT, nlc_carry_size(contact_count, 0) == 0 ? 2 : 5);
    if (contact_count > 0 && (!nonlocal || !key)) return nlc_error(info, NLC_ERROR_NULL, nonlocal ? 1 : 0);
    if (old_count > 0 && (!old_nonlocal || !old_key)) return nlc_error(info, NLC_ERROR_NULL, old_nonlocal ? 4 : 3);
    if (!memory) return nlc_error(info, NLC_ERROR_NULL, 6);
    if ((uintptr_t)memory % 8 != 0) return nlc_error(info, NLC_ERROR_ALIGNMENT, (int64_t)((uintptr_t)memory % 8));
    if (memory_size < size) return nlc_error(info, NLC_ERROR_CAPACITY, (int64_t)size);
    if ((culprit = nlc_first_not_finite(old_nonlocal, old_count)) >= 0) return nlc_error(info, NLC_ERROR_NONLOCAL, culprit);

    item *const now = memory, *const before = now + contact_count, *const scratch = before + old_count;
    fill(now, key, contact_count);
    fill(before, old_key, old_count);
    sort(now, scratch, contact_count);
    sort(before, scratch, old_count);
    int64_t b = 0;
    for (int64_t c = 0; c < contact_count; c++) {
        while (b < old_count && before[b].key < now[c].key) b++;
        const bool met = b < old_count && before[b].key == now[c].key;
        nonlocal[now[c].contact] = met ? old_nonlocal[before[b].contact] : 0;
        if (met)
            b++;
        else
            record.left_out++;
    }
    return nlc_report(info, &record, NLC_OK);
}
