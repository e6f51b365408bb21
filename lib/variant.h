/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * variant.h - the inner loops for processors of one kind: a row of a table.
 *
 * The portable code needs none and is NULL.  The row is chosen when options are read and kept in the network's settings.
 */
#ifndef NLC_VARIANT_H
#define NLC_VARIANT_H

#include <stdbool.h>
#include <stdint.h>

#include "model.h"
#include "nlcontact.h"

/*
 * Compilers that can be told to use what not every processor has, function by function, and whose run-time library asks whether the
 * system keeps the registers: gcc's did not before 6.5, 7.4 and 8.1 (its bug 85100).
 */
#if defined(__x86_64__) && (defined(__clang__) || (defined(__GNUC__) && 100 * __GNUC__ + __GNUC_MINOR__ >= 704))
#define NLC_HAVE_X86 1
#elif defined(__GNUC__) && defined(__aarch64__) && defined(__ARM_NEON)
#define NLC_HAVE_NEON 1
#endif

#define NLC_WINDOW 512 /* particles that are looked at together */

typedef struct nlc_iteration nlc_iteration;
typedef struct nlc_extremes nlc_extremes;
typedef struct nlc_guess nlc_guess;
typedef struct nlc_view nlc_view;

typedef struct nlc_variant {
    /*
     * nlc_displace of Case I for the particles from first to end, a window at most, from the range check on.  Returns the first one
     * with two contacts in the same direction, or -1.
     * Sets network->closest; and, from weighed [contacts][2], the forces again with a weight w beside each, or NULL, network->norm:
     * the sum of k^2 w w over the pairs of a particle, k their coefficient without U; INFINITY where it is not known.
     */
    int64_t (*displace)(nlc_network *network, const double *force, const double *weighed, const double *normal, int64_t first,
                        int64_t end);
    /* Numbers that displace keeps in the cache for the particles from first to end, a window at most. */
    int64_t (*kept_in)(const nlc_network *network, int64_t first, int64_t end);
    /*
     * Whether the blocks (bound.h) of the particles from first to end, a window at most, have eigenvalues below a limit only: network->changed is 0
     * where that is so, 1 where it is not or is left open.  root [contacts][2]: (U D / share)^1/2 of each side.
     */
    void (*mark_above)(nlc_network *network, const double *root, const double *normal, double limit, int64_t first, int64_t end);
    /* directions.c: of count contacts from one on: residuals, 1/D and forces of the law; returns how many of them are done. */
    int (*residuals)(const nlc_iteration *q, int64_t from, int count, double *z, double *inverse, double *force, nlc_extremes *e);
    /* warm.c: forces of count contacts from one on and their weights, the overlaps with displacements in y; returns how many are done. */
    int (*start)(const nlc_iteration *q, const nlc_guess *guess, int64_t from, int count, const double *U, double *y);
    /* look.c: of count contacts from one on, after a sweep; grown and lost of the view; returns how many of them are done. */
    int (*look)(const nlc_iteration *q, const nlc_guess *guess, int64_t from, int count, double *size, double *alone, double *energy,
                double *slope, nlc_view *view);
    /* nlc_case_one_between */
    bool (*between)(nlc_block *a, nlc_block *b, const nlc_kernel *kernel);
} nlc_variant;

#ifdef NLC_HAVE_X86
extern const nlc_variant nlc_variant_avx2, nlc_variant_avx512;
#endif
#ifdef NLC_HAVE_NEON
extern const nlc_variant nlc_variant_neon;
#endif

/* cpu.c: the best one that this processor has, at most the one asked for (NLC_SIMD_...); NULL: the portable code. */
const nlc_variant *nlc_choose_variant(int32_t simd);

#endif
