/* SPDX-License-Identifier: BSD-2-Clause */
/* fuzz.c - numbers from bytes, guarded memory, the floating-point environment. */
#include "fuzz.h"

#include <errno.h>
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAVE_ASAN
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define HAVE_ASAN
#endif
#if defined(HAVE_ASAN)
#include <sanitizer/asan_interface.h>
#endif

#if defined(__GLIBC__) && defined(__x86_64__)
#define HAVE_TRAPS /* elsewhere the flags have to do */
#endif

enum { PATTERN = 0x5a, AROUND = 256 };

_Noreturn void fuzz_fail(const char *file, int line, const char *condition, const char *what)
{
    fprintf(stderr, "%s:%d: %s: %s does not hold\n", file, line, what, condition);
    abort();
}

/* ---- numbers from bytes */

uint64_t take(bytes *b, int count)
{
    uint64_t x = 0;
    for (int k = 0; k < count && b->left > 0; k++, b->at++, b->left--) x |= (uint64_t)*b->at << 8 * k;
    return x;
}

bool take_bit(bytes *b, uint64_t flags, int bit)
{
    return (flags >> bit & 1) != 0 && (take(b, 1) & 1) != 0;
}

static double from_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static uint64_t without_signalling(uint64_t bits)
{
    const uint64_t infinity = UINT64_C(0x7ff0000000000000), quiet = UINT64_C(0x0008000000000000);
    return (bits & ~(UINT64_C(1) << 63)) > infinity ? bits | quiet : bits;
}

double take_any(bytes *b)
{
    static const uint64_t edges[] = {
        0,                            /* 0 */
        1,                            /* the smallest subnormal number */
        UINT64_C(0x000fffffffffffff), /* the largest one */
        UINT64_C(0x0010000000000000), /* DBL_MIN */
        UINT64_C(0x7fefffffffffffff), /* DBL_MAX */
        UINT64_C(0x7ff0000000000000), /* infinity */
        UINT64_C(0x7ff8000000000000), /* NaN */
        UINT64_C(0x7fffffffffffffff), /* NaN with all of its payload */
        UINT64_C(0x7ff80000deadbeef), /* NaN with some of it */
        UINT64_C(0x3ff0000000000000), /* 1 */
        UINT64_C(0x3ff0000000000001), /* the next one */
        UINT64_C(0x3fefffffffffffff), /* the one before */
        UINT64_C(0x3fe0000000000000), /* 1/2 */
        UINT64_C(0x3ca0000000000000), /* 2^-53 */
        UINT64_C(0x1ff0000000000000), /* about 2^-512, whose square is about DBL_MIN */
        UINT64_C(0x5ff0000000000000), /* about 2^512 */
    };
    const uint64_t kind = take(b, 1);
    if (kind < 32) return from_bits(edges[kind & 15] | (kind >> 4) << 63);
    if (kind < 128) return ldexp((double)(int64_t)(take(b, 2) ^ 0x8000) - 32768, (int)(kind - 80) * 20); /* a few digits, any size */
    return from_bits(without_signalling(take(b, 8)));
}

int64_t take_integer(bytes *b)
{
    static const int64_t edges[] = {0,         -1,        1,        INT32_MAX, INT32_MIN, (int64_t)UINT32_MAX, INT64_MAX, INT64_MIN,
                                    INT64_MAX / 8, INT64_MAX / 16, INT64_MAX / 24, 65536, INT64_MAX - 7, INT64_MIN + 7, 4096, 4097};
    const uint64_t kind = take(b, 1);
    if (kind < 32) return edges[kind & 15];
    uint64_t x = take(b, kind < 128 ? 2 : 8);
    int64_t y;
    memcpy(&y, &x, sizeof y);
    return y;
}

void take_unit(bytes *b, uint64_t salt, double n[3])
{
    /* a spiral around the sphere: neighbouring numbers are neighbouring directions, at most one in 2^16 is met twice */
    const uint64_t k = (take(b, 2) + 7919 * salt) & 0xffff;
    const double z = 1 - ((double)k + 0.5) / 32768, r = sqrt(1 - z * z), a = 2.399963229728653 * (double)k;
    n[0] = r * cos(a);
    n[1] = r * sin(a);
    n[2] = z;
}

bool is_large(const uint8_t *data, size_t size)
{
    uint64_t h = size;
    for (size_t k = 0; k < size; k++) h = (h ^ data[k]) * UINT64_C(0x9e3779b97f4a7c15), h ^= h >> 29;
    return h * UINT64_C(0xbf58476d1ce4e5b9) >> 58 == 0;
}

/* ---- memory whose ends cannot be crossed */

static struct {
    unsigned char *pages, *at; /* pages: the first one with access */
    size_t size;
} rooms[ROOMS];

static void make_room(int number)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    unsigned char *p = mmap(NULL, ROOM + 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    demand(p != MAP_FAILED, "mmap");
    demand(mprotect(p, page, PROT_NONE) == 0 && mprotect(p + page + ROOM, page, PROT_NONE) == 0, "mprotect");
    rooms[number].pages = rooms[number].at = p + page;
#if defined(HAVE_ASAN)
    ASAN_POISON_MEMORY_REGION(rooms[number].pages, ROOM);
#endif
}

#if !defined(HAVE_ASAN)
/* What is watched before and behind what is in the room. */
static void surroundings(int number, size_t *before, size_t *behind)
{
    *before = (size_t)(rooms[number].at - rooms[number].pages);
    *behind = ROOM - *before - rooms[number].size;
    if (*before > AROUND) *before = AROUND;
    if (*behind > AROUND) *behind = AROUND;
}
#endif

void *room(int number, size_t size, bool behind, size_t shift)
{
    demand(number >= 0 && number < ROOMS, "no such room");
    if (size > ROOM || shift > ROOM - size) return NULL;
    if (!rooms[number].pages) make_room(number);
    unsigned char *at = rooms[number].pages + (behind ? ROOM - size - shift : shift);
#if defined(HAVE_ASAN)
    ASAN_POISON_MEMORY_REGION(rooms[number].at, rooms[number].size);
    ASAN_UNPOISON_MEMORY_REGION(at, size);
    memset(at, PATTERN, size);
#endif
    rooms[number].at = at;
    rooms[number].size = size;
#if !defined(HAVE_ASAN)
    size_t before, after;
    surroundings(number, &before, &after);
    memset(at - before, PATTERN, before + size + after);
#endif
    return at;
}

bool is_filled(const void *memory, size_t size)
{
    const unsigned char *p = memory;
    return size == 0 || (p[0] == PATTERN && memcmp(p, p + 1, size - 1) == 0);
}

bool room_intact(int number)
{
#if defined(HAVE_ASAN)
    return number < ROOMS;
#else
    size_t before, after;
    if (!rooms[number].at) return true;
    surroundings(number, &before, &after);
    return is_filled(rooms[number].at - before, before) && is_filled(rooms[number].at + rooms[number].size, after);
#endif
}

/* ---- a watch on the environment */

static _Thread_local unsigned mode_before;

static unsigned mode(void)
{
    unsigned bits = (unsigned)fegetround();
#if defined(__SSE2__)
    bits ^= (_mm_getcsr() & 0xffc0u) << 16; /* masks, rounding, flush to zero, denormals are zero */
#endif
    return bits;
}

void watch(void)
{
    feclearexcept(FE_ALL_EXCEPT);
#if defined(HAVE_TRAPS)
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
#endif
    mode_before = mode();
    errno = 77;
}

void unwatch(const char *what)
{
    const int error = errno;
    const unsigned now = mode();
#if defined(HAVE_TRAPS)
    fedisableexcept(FE_ALL_EXCEPT);
#endif
    demand(fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) == 0, what);
    demand(error == 77, what);
    demand(now == mode_before, what);
}

nlc_status watched(nlc_status status, const char *what, nlc_status warnings, const nlc_status *errors)
{
    unwatch(what);
    for (; status < 0 && *errors != 0; errors++)
        if (status == *errors) return status;
    if (status < 0 || (status & ~warnings) != 0) fprintf(stderr, "status %d: %s\n", status, nlc_strerror(status));
    demand(status >= 0, what);
    demand((status & ~warnings) == 0, what);
    return status;
}

/* ---- arrays */

bool all_finite(const double *x, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (!isfinite(x[k])) return false;
    return true;
}

bool same_bytes(const void *a, const void *b, size_t size)
{
    return size == 0 || memcmp(a, b, size) == 0;
}

void copy_bytes(void *to, const void *from, size_t size)
{
    if (size > 0) memcpy(to, from, size);
}
