/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * support.h - what the test programs share: assertions on floating-point numbers, a random generator that gives the same
 * numbers everywhere, a watch on the floating-point environment, and main.
 *
 * The assertions are macros around Check's, to be used inside START_TEST.  Each argument is evaluated once.  A success costs
 * next to nothing (no mark_point), so they may stand in loops of millions; a failure prints every value as %a and %.17g.
 */
#ifndef NLC_TESTS_SUPPORT_H
#define NLC_TESTS_SUPPORT_H

#include <check.h>
#include <stdbool.h>
#include <stdint.h>

/* ---------------------------------------------------------------------------------------------------------- numbers -- */

/*
 * ulp_distance - how many doubles lie from a to b, b included: 0 for equal numbers (+0 and -0 are), 1 for neighbours.
 * INFINITY is the neighbour of DBL_MAX.  Returns UINT64_MAX if one of them is NaN.
 */
uint64_t ulp_distance(double a, double b);

/* ulp_size - spacing of the doubles at x: 2^(e-52) for 2^e <= |x| < 2^(e+1), at least 2^-1074, with no upper limit. */
long double ulp_size(long double x);

/*
 * ulp_error - |found - exact| in units of ulp_size(scale); scale = exact is the error in ulp of the result.
 *
 * Where the unit is the smallest subnormal number that is an absolute bound.  INFINITY found counts as 2^1024, the number
 * that it stands for in rounding, and is right for every exact value from there on.  Returns INFINITY if either is NaN.
 */
double ulp_error(double found, long double exact, long double scale);

/* relative_error - |a - b| / |b|: 0 if they are equal (infinite ones too), INFINITY if one is NaN or b is the only 0. */
double relative_error(double a, double b);

/* absolute_error - |a - b|: 0 if they are equal (infinite ones too), INFINITY if one is NaN. */
double absolute_error(double a, double b);

/* same_bits - whether a and b are the same to the last bit, the sign of zero included; any NaN equals any other. */
bool same_bits(double a, double b);

/*
 * long_double_is_wider - whether long double can serve as the exact value: at least 64 bits of mantissa and 15 of exponent.
 * Asked when running, since an emulator may calculate with less than the type has room for.
 */
bool long_double_is_wider(void);

/* ------------------------------------------------------------------------------------------------------- assertions -- */

/* number_message - the text of a failure, in a static buffer. */
const char *number_message(const char *what_a, double a, const char *what_b, double b, const char *demand);

/* |a - b| <= tol |b|.  The second one is the expected value. */
#define nlc_assert_rel(a, b, tol)                                                                                              \
    do {                                                                                                                       \
        const double assert_a_ = (a), assert_b_ = (b), assert_tol_ = (tol);                                                    \
        if (!(relative_error(assert_a_, assert_b_) <= assert_tol_))                                                            \
            ck_abort_msg("%s, tolerance %s = %.3g", number_message(#a, assert_a_, #b, assert_b_, "are not as close as asked"), \
                         #tol, assert_tol_);                                                                                   \
    } while (0)

/* a and b are at most n doubles apart. */
#define nlc_assert_ulp(a, b, n)                                                                                                \
    do {                                                                                                                       \
        const double assert_a_ = (a), assert_b_ = (b);                                                                         \
        const uint64_t assert_n_ = (n);                                                                                        \
        if (ulp_distance(assert_a_, assert_b_) > assert_n_)                                                                    \
            ck_abort_msg("%s, at most %ju ulp allowed",                                                                        \
                         number_message(#a, assert_a_, #b, assert_b_, "are not as close as asked"), (uintmax_t)assert_n_);     \
    } while (0)

/* a and b have the same bits. */
#define nlc_assert_same(a, b)                                                                                                  \
    do {                                                                                                                       \
        const double assert_a_ = (a), assert_b_ = (b);                                                                         \
        if (!same_bits(assert_a_, assert_b_))                                                                                  \
            ck_abort_msg("%s", number_message(#a, assert_a_, #b, assert_b_, "are not the same bits"));                         \
    } while (0)

/* |a - b| <= tol, an absolute bound.  (Check's own takes < and prints fewer digits.) */
#define nlc_assert_abs(a, b, tol)                                                                                              \
    do {                                                                                                                       \
        const double assert_a_ = (a), assert_b_ = (b), assert_tol_ = (tol);                                                    \
        const double assert_difference_ = absolute_error(assert_a_, assert_b_);                                                \
        if (!(assert_difference_ <= assert_tol_))                                                                              \
            ck_abort_msg("%s, absolute difference %.3g, tolerance %s = %.3g",                                                  \
                         number_message(#a, assert_a_, #b, assert_b_, "are not as close as asked"), assert_difference_, #tol,  \
                         assert_tol_);                                                                                         \
    } while (0)

/* ------------------------------------------------------------------------------------------------------------ random -- */

/* A stream of random numbers (splitmix64).  Initialise with any seed: { 1 }.  Same seed, same numbers, everywhere. */
typedef struct rng {
    uint64_t state;
} rng;

uint64_t rng_next(rng *g);                           /* 64 random bits */
uint64_t rng_below(rng *g, uint64_t n);              /* 0 ... n-1, n >= 1 */
double rng_uniform(rng *g, double low, double high); /* low <= x <= high */
double rng_sign(rng *g);                             /* 1 or -1 */
void rng_unit(rng *g, double n[3]);                  /* a unit vector, every direction equally likely, to rounding */

/*
 * rng_log - log-uniform: a random exponent, then a random mantissa.  2^low <= x <= 2^high, -1074 <= low < high <= 1024;
 * never INFINITY.  One in eight has a mantissa from the edge: all zeros, all ones, one bit, next to a power of two.
 */
double rng_log(rng *g, int low, int high);

/* ------------------------------------------------------------------------------------- floating-point environment -- */

/*
 * fp_begin, fp_end - watch over what runs between them.
 *
 * fp_begin clears all exception flags, remembers the floating-point mode and sets errno to 77.
 * fp_end returns what has been done since that the contract forbids, as words: "" is nothing, "FE_INVALID errno" two things.
 * Looked for: FE_INVALID, FE_DIVBYZERO, FE_OVERFLOW raised, errno touched, rounding or masks ("mode") changed.
 */
void fp_begin(void);
const char *fp_end(void);

/* nlc_assert_quiet(statement) - run the statement under the watch. */
#define nlc_assert_quiet(...)                                                                                                  \
    do {                                                                                                                       \
        fp_begin();                                                                                                            \
        __VA_ARGS__;                                                                                                           \
        const char *assert_raised_ = fp_end();                                                                                 \
        if (*assert_raised_) ck_abort_msg("%s: %s", #__VA_ARGS__, assert_raised_);                                             \
    } while (0)

/*
 * fp_trap, fp_untrap - turn invalid, divide by zero and overflow into SIGFPE, where the system can (glibc on x86-64), so that
 * code which raises a flag and clears it again is found out.  Both fit tcase_add_checked_fixture.  fp_untrap clears the flags.
 */
void fp_trap(void);
void fp_untrap(void);

/* ------------------------------------------------------------------------------- memory whose ends cannot be crossed -- */

typedef struct guarded {
    char *pages;
    size_t size; /* of these */
    void *at;
} guarded;

/* A copy between two pages without access: flush with the one behind it or the one before it.  data NULL: all bytes 0xff, NaN. */
guarded guard(const void *data, size_t size, bool behind);
void unguard(guarded g);

/* -------------------------------------------------------------------------------------------------------------- main -- */

/* run_suite - run it, print Check's summary.  Returns the exit status of the program: 0, or 1 after a failure. */
int run_suite(Suite *suite);

/* verbose - whether NLC_TEST_VERBOSE is set: print what was measured, not just whether it is good enough. */
bool verbose(void);

/* points - how many random points to take: NLC_TEST_POINTS (1e8 is understood) or, if that is not set or less, usual. */
uint64_t points(uint64_t usual);

/* time_limit - set a test case's time limit [s]; none if NLC_TEST_POINTS is set. */
void time_limit(TCase *test_case, double seconds);

#endif /* NLC_TESTS_SUPPORT_H */
