/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fuzz.h - what the fuzzing programs share: numbers from bytes, memory whose ends cannot be crossed, a watch on the
 * floating-point environment.
 *
 * Each program is one function, LLVMFuzzerTestOneInput: linked with -fsanitize=fuzzer (libFuzzer, AFL++'s driver) it is a
 * fuzzer, with main.c a program that replays files or makes inputs of its own.  What is demanded and does not hold aborts.
 */
#ifndef NLC_TESTS_FUZZ_H
#define NLC_TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "nlcontact.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Prints where and what, and aborts, if the condition does not hold. */
#define demand(condition, ...) ((condition) ? (void)0 : fuzz_fail(__FILE__, __LINE__, #condition, __VA_ARGS__))
_Noreturn void fuzz_fail(const char *file, int line, const char *condition, const char *what);

/* ---- numbers from bytes; behind the end there are zeros */

typedef struct bytes {
    const uint8_t *at;
    size_t left;
} bytes;

uint64_t take(bytes *b, int count); /* count bytes, 0 ... 8, little-endian */
bool take_bit(bytes *b, uint64_t flags, int bit); /* whether a flag is set and, if so, a byte of its own is odd: now and then */

/* Any double but a signalling NaN: one of the edges, such as NaN with a payload or the smallest number, or eight bytes. */
double take_any(bytes *b);
int64_t take_integer(bytes *b); /* likewise: counts, strides, sizes */

void take_unit(bytes *b, uint64_t salt, double n[3]); /* a unit vector; by two bytes, and by what is given */

/* Whether much work may be made of an input: of one in 64, by all of its bytes, so that what is derived from it is small again. */
bool is_large(const uint8_t *data, size_t size);

/* ---- memory whose ends cannot be crossed */

enum { ROOMS = 48, ROOM = 1 << 20 };

/*
 * room - size bytes between two pages without access: flush with the one behind, or the one before, and then shift bytes towards
 * the middle.  Each number is one room; what was in it before is gone.  Filled with a pattern; NULL if size + shift > ROOM.
 * What lies around is watched, too: by the address sanitizer where there is one, else room_intact tells.
 */
void *room(int number, size_t size, bool behind, size_t shift);
bool room_intact(int number);

bool is_filled(const void *memory, size_t size); /* whether all of it is still that pattern */

/* ---- a watch on the environment */

/* Between the two traps are on for invalid, division by zero and overflow; flags, errno and the mode are compared. */
void watch(void);
void unwatch(const char *what);

/* The call and its status, watched; aborts unless that is 0, among the errors given (0 ends them), or warnings allowed. */
nlc_status watched(nlc_status status, const char *what, nlc_status warnings, const nlc_status *errors);
#define CALL(call, warnings, ...) (watch(), watched(call, #call, warnings, (const nlc_status[]){__VA_ARGS__, 0}))

/* ---- arrays */

bool all_finite(const double *x, size_t count);
bool same_bytes(const void *a, const void *b, size_t size); /* 0 bytes at NULL are the same */
void copy_bytes(void *to, const void *from, size_t size);

#endif
