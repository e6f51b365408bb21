/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * host.c - a host that does not keep to the rules of floating point: built with -ffast-math (whose start file flushes subnormal
 * numbers to zero), in every direction of rounding, and with floating-point traps on in all of them.
 *
 * What is demanded: NaN and infinity among the arguments are still found; the mode is as it was after every call; forces agree with
 * those of the usual mode to the tolerance asked for; and results of the usual mode have the same bits afterwards.
 * Numbers are looked at as bits only: this file's own comparisons with NaN may be optimised away.
 */
#define _GNU_SOURCE
#include <fenv.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "nlcontact.h"

enum { CONTACTS = 12, PARTICLES = 5, MODELS = 6 };
static const int32_t i[CONTACTS] = {0, 0, 0, 0, 1, 2, 1, 2, 3, 4, 0, 4}, j[CONTACTS] = {1, 2, 3, 4, 2, 3, 5, 5, 5, 5, 6, 6};
static const double tolerance = 1e-10;

static double from_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static uint64_t bits_of(double x)
{
    uint64_t b;
    memcpy(&b, &x, sizeof b);
    return b;
}

static int is_finite(double x)
{
    return (bits_of(x) >> 52 & 0x7ff) != 0x7ff;
}

static void demand(int condition, const char *what, const char *mode)
{
    if (condition) return;
    fprintf(stderr, "host: %s: %s\n", mode, what);
    exit(1);
}

static unsigned mode_now(void)
{
    unsigned bits = (unsigned)fegetround();
#if defined(__SSE2__)
    bits ^= (_mm_getcsr() & 0xffc0u) << 16;
#elif defined(__aarch64__)
    uint64_t control;
    __asm__ volatile("mrs %0, fpcr" : "=r"(control));
    bits ^= (unsigned)control;
#endif
    return bits;
}

/* Flush results to zero, take small arguments for zero: as far as the processor has such a mode.  False: it has none. */
static int flush(unsigned flags)
{
#if defined(__SSE2__)
    _mm_setcsr((_mm_getcsr() & ~0x8040u) | (flags & 1 ? 0x8000u : 0) | (flags & 2 ? 0x40u : 0));
    return 1;
#elif defined(__aarch64__)
    uint64_t control;
    __asm__ volatile("mrs %0, fpcr" : "=r"(control));
    control = (control & ~(UINT64_C(1) << 24)) | (uint64_t)(flags & 1) << 24;
    __asm__ volatile("msr fpcr, %0" : : "r"(control));
    return 1;
#else
    return flags == 0;
#endif
}

/* What flush() would have to be given for what is now. */
static unsigned flushed(void)
{
#if defined(__SSE2__)
    const unsigned now = _mm_getcsr();
    return (now & 0x8000u ? 1 : 0) | (now & 0x40u ? 2 : 0);
#elif defined(__aarch64__)
    return mode_now() >> 24 & 1;
#else
    return 0;
#endif
}

/* Invalid, overflow and division by zero end the program.  False: not here. */
static int trap(void)
{
#if defined(__GLIBC__) && defined(__x86_64__)
    feclearexcept(FE_ALL_EXCEPT);
    return feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) != -1;
#else
    return 0;
#endif
}

typedef struct results {
    double force[MODELS][CONTACTS];
    nlc_status status[MODELS];
} results;

static void make(double overlap[CONTACTS], double normal[3 * CONTACTS])
{
    for (int c = 0; c < CONTACTS; c++) {
        const double z = 0.9 - 0.15 * c, a[3] = {z, c % 2 ? 0.5 : -0.5, c % 3 - 1.0};
        double square = 0, r = 1;
        for (int x = 0; x < 3; x++) square += a[x] * a[x];
        for (int step = 0; step < 60; step++) r = 0.5 * (r + square / r); /* no library function of the host's */
        for (int x = 0; x < 3; x++) normal[3 * c + x] = a[x] / r;
        overlap[c] = 0.01 + 0.001 * (c % 4) - (c == 7 ? 0.012 : 0);
    }
}

static results compute(const char *mode)
{
    static const double radius[PARTICLES] = {1, 1.1, 0.9, 1.2, 1};
    static const nlc_material materials[2] = {{1e9, 0.3}, {5e9, 0.2}};
    static const int32_t material[PARTICLES] = {0, 1, 0, 1, 0}, walls[2] = {1, 1};
    double overlap[CONTACTS], normal[3 * CONTACTS];
    results r;
    make(overlap, normal);
    const unsigned before = mode_now();
    for (int m = 0; m < MODELS; m++) {
        nlc_particles p = {.struct_size = sizeof p, .count = PARTICLES, .radius = radius, .material = material, .materials = materials,
                           .material_count = 2, .wall_material = walls, .wall_count = 2};
        nlc_options o = {.struct_size = sizeof o, .model = m, .tolerance = tolerance};
        const size_t size = nlc_network_size(&p, CONTACTS, &o);
        void *memory = malloc(size);
        nlc_network *n = NULL;
        demand(size > 0 && memory, "memory", mode);
        demand(nlc_network_init(&n, memory, size, &p, i, j, CONTACTS, &o, NULL) == NLC_OK, "nlc_network_init", mode);
        double nonlocal[CONTACTS] = {0}, displacement[2 * CONTACTS] = {0}, F[3 * PARTICLES] = {0};
        r.status[m] = nlc_solve(n, r.force[m], nonlocal, overlap, normal, NULL);
        demand(r.status[m] >= 0, nlc_strerror(r.status[m]), mode);
        demand(nlc_sweep(n, displacement, r.force[m], overlap, normal, NULL) == NLC_OK, "nlc_sweep", mode);
        demand(nlc_assemble(n, F, 0, NULL, r.force[m], normal, NULL) == NLC_OK, "nlc_assemble", mode);
        demand(mode_now() == before, "the mode has changed", mode);
        for (int c = 0; c < CONTACTS; c++) demand(is_finite(r.force[m][c]), "a force", mode);

        /* what no number may be */
        static const uint64_t wrong[] = {UINT64_C(0x7ff8000000000000), UINT64_C(0xfff8000000001234), UINT64_C(0x7ff0000000000000)};
        for (int k = 0; k < 3; k++) {
            double odd[3 * CONTACTS], other[PARTICLES];
            memcpy(odd, overlap, sizeof overlap);
            odd[3] = from_bits(wrong[k]);
            demand(nlc_solve(n, r.force[m], nonlocal, odd, normal, NULL) == NLC_ERROR_OVERLAP, "NaN overlap", mode);
            memcpy(odd, normal, sizeof odd);
            odd[7] = from_bits(wrong[k]);
            demand(nlc_solve(n, r.force[m], nonlocal, overlap, odd, NULL) == NLC_ERROR_NORMAL, "NaN normal", mode);
            memcpy(odd, nonlocal, sizeof nonlocal);
            odd[2] = from_bits(wrong[k]);
            demand(nlc_solve(n, r.force[m], odd, overlap, normal, NULL) == NLC_ERROR_NONLOCAL, "NaN displacement", mode);
            memcpy(other, radius, sizeof other);
            other[2] = from_bits(wrong[k]);
            p.radius = other;
            demand(nlc_network_init(&n, memory, size, &p, i, j, CONTACTS, &o, NULL) == NLC_ERROR_RADIUS, "NaN radius", mode);
            p.radius = radius;
            /* by value, hidden from a compiler that takes neither for possible, as clang 19 does */
            const volatile double argument = from_bits(wrong[k]), x = nlc_hertz_force(1, argument);
            demand((bits_of(x) & UINT64_C(0x7ff0000000000000)) == UINT64_C(0x7ff0000000000000), "nlc_hertz_force", mode);
        }
        free(memory);
    }
    return r;
}

/* Forces to the tolerance, relative to the largest one: a bound on the tolerance promised, which is relative to the particles'. */
static void compare(const results *a, const results *b, const char *mode)
{
    for (int m = 0; m < MODELS; m++) {
        double largest = 0;
        for (int c = 0; c < CONTACTS; c++) largest = a->force[m][c] > largest ? a->force[m][c] : largest;
        for (int c = 0; c < CONTACTS; c++) {
            const double d = a->force[m][c] - b->force[m][c];
            demand((d < 0 ? -d : d) <= 2 * tolerance * largest, "forces differ", mode);
        }
        demand(a->status[m] == b->status[m], "the status differs", mode);
    }
}

int main(void)
{
    const results usual = compute("as the host starts");
    const unsigned at_start = flushed();
    static const struct {
        int mode;
        const char *name;
    } modes[] = {
#if defined(FE_UPWARD)
        {FE_UPWARD, "rounding upward"},
#endif
#if defined(FE_DOWNWARD)
        {FE_DOWNWARD, "rounding downward"},
#endif
#if defined(FE_TOWARDZERO)
        {FE_TOWARDZERO, "rounding towards zero"},
#endif
        {FE_TONEAREST, "rounding to nearest"},
    };
    const int count = (int)(sizeof modes / sizeof *modes), traps = trap();
    int directions = 0, flushing = 0;
    for (int k = 0; k < count; k++)
        for (unsigned flags = 0; flags < 4; flags++) {
            if (fesetround(modes[k].mode) != 0 || !flush(flags)) continue;
            const results r = compute(modes[k].name);
            fesetround(FE_TONEAREST);
            flush(at_start);
            compare(&usual, &r, modes[k].name);
            directions += flags == 0;
            flushing += flags > 0;
        }
    const results again = compute("at the end");
    demand(memcmp(&usual.force, &again.force, sizeof usual.force) == 0, "other bits", "at the end");
    printf("host: %d directions of rounding%s%s: ok\n", directions, flushing ? ", each flushing to zero, too" : "", traps ? ", traps on" : "");
    return 0;
}
