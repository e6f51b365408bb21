/* SPDX-License-Identifier: BSD-2-Clause */
/* support.c - see support.h */
#include "support.h"

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
#if defined(__GLIBC__) && defined(__x86_64__)
#define HAVE_TRAPS 1
#endif

/* ---------------------------------------------------------------------------------------------------------- numbers -- */

/* The doubles in order as integers: 0 for both zeros, 1 for the smallest subnormal, -1 for its negative. */
static int64_t rank(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits < 0 ? INT64_MIN - bits : bits;
}

uint64_t ulp_distance(double a, double b)
{
    if (isnan(a) || isnan(b)) return UINT64_MAX;
    const int64_t p = rank(a), q = rank(b);
    return p > q ? (uint64_t)p - (uint64_t)q : (uint64_t)q - (uint64_t)p;
}

long double ulp_size(long double x)
{
    int exponent = -1074;
    if (x != 0 && isfinite(x)) {
        frexpl(x, &exponent); /* 0.5 <= mantissa < 1 */
        exponent -= 53;
    }
    return ldexpl(1, exponent > -1074 ? exponent : -1074);
}

double ulp_error(double found, long double exact, long double scale)
{
    if (isnan(found) || isnan(exact)) return INFINITY;
    long double value = found;
    if (isinf(found)) {
        value = copysignl(ldexpl(1, 1023) * 2, value);
        if (signbit(value) == signbit(exact) && fabsl(exact) >= fabsl(value)) return 0;
    }
    const long double error = fabsl(value - exact) / ulp_size(scale);
    return error < 1e300L ? (double)error : INFINITY;
}

double relative_error(double a, double b)
{
    if (isnan(a) || isnan(b)) return INFINITY;
    if (a == b) return 0;
    if (b == 0 || isinf(a) || isinf(b)) return INFINITY;
    return (double)fminl(fabsl((long double)a - b) / fabsl((long double)b), DBL_MAX);
}

double absolute_error(double a, double b)
{
    if (isnan(a) || isnan(b)) return INFINITY;
    return a == b ? 0 : fabs(a - b);
}

bool same_bits(double a, double b)
{
    return (isnan(a) && isnan(b)) || memcmp(&a, &b, sizeof a) == 0;
}

bool long_double_is_wider(void)
{
    volatile long double one = 1, small = ldexpl(1, -63), large = DBL_MAX;
    const long double sum = one + small, product = large * large;
    return LDBL_MANT_DIG >= 64 && LDBL_MAX_EXP >= 16384 && sum != 1 && !isinf(product);
}

const char *number_message(const char *what_a, double a, const char *what_b, double b, const char *demand)
{
    static char text[1024];
    const uint64_t distance = ulp_distance(a, b);
    char ulp[32] = "NaN";
    if (distance != UINT64_MAX) snprintf(ulp, sizeof ulp, "%ju ulp", (uintmax_t)distance);
    snprintf(text, sizeof text, "%s\n    %s = %a (%.17g)\n    %s = %a (%.17g)\n    distance %s, relative %.3g", demand, what_a,
             a, a, what_b, b, b, ulp, relative_error(a, b));
    return text;
}

/* ------------------------------------------------------------------------------------------------------------ random -- */

uint64_t rng_next(rng *g)
{
    uint64_t z = g->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

uint64_t rng_below(rng *g, uint64_t n)
{
    return rng_next(g) % n; /* the bias, n / 2^64, does not matter here */
}

double rng_uniform(rng *g, double low, double high)
{
    const double x = (double)(rng_next(g) >> 11) * 0x1p-53;
    return fmin(fmax(low * (1 - x) + high * x, low), high);
}

double rng_sign(rng *g)
{
    return rng_next(g) >> 63 ? 1 : -1;
}

double rng_log(rng *g, int low, int high)
{
    const int exponent = low + (int)rng_below(g, (uint64_t)(high - low));
    const uint64_t bits = rng_next(g);
    uint64_t mantissa = bits >> 12;
    if ((bits & 7) == 0) {
        const uint64_t all = (UINT64_C(1) << 52) - 1, small = bits >> 3 & 3;
        const uint64_t edges[] = {0, all, small, all - small, UINT64_C(1) << (bits >> 12) % 52};
        mantissa = edges[(bits >> 5) % 5];
    }
    return ldexp((double)(UINT64_C(1) << 52 | mantissa), exponent - 52);
}

void rng_unit(rng *g, double n[3])
{
    double square; /* a point of the ball, projected: no trigonometry, so the same bits everywhere */
    do {
        square = 0;
        for (int k = 0; k < 3; k++) {
            n[k] = rng_uniform(g, -1, 1);
            square += n[k] * n[k];
        }
    } while (square > 1 || square < 0x1p-20);
    const double length = sqrt(square);
    for (int k = 0; k < 3; k++) n[k] /= length;
}

/* ------------------------------------------------------------------------------------- floating-point environment -- */

static unsigned mode_before;

/* Everything in the environment but the exception flags. */
static unsigned mode(void)
{
    unsigned bits = (unsigned)fegetround();
#if defined(__SSE2__)
    bits ^= (_mm_getcsr() & 0xffc0u) << 16; /* masks, rounding, flush to zero, denormals are zero */
#endif
    return bits;
}

void fp_begin(void)
{
    mode_before = mode();
    feclearexcept(FE_ALL_EXCEPT);
    errno = 77;
}

const char *fp_end(void)
{
    static char text[80];
    const int error = errno, raised = fetestexcept(FE_ALL_EXCEPT);
    snprintf(text, sizeof text, "%s%s%s%s%s", raised & FE_INVALID ? " FE_INVALID" : "",
             raised & FE_DIVBYZERO ? " FE_DIVBYZERO" : "", raised & FE_OVERFLOW ? " FE_OVERFLOW" : "",
             error != 77 ? " errno" : "", mode() != mode_before ? " mode" : "");
    return text[0] ? text + 1 : text;
}

void fp_trap(void)
{
#if defined(HAVE_TRAPS)
    feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
#endif
}

void fp_untrap(void)
{
#if defined(HAVE_TRAPS)
    fedisableexcept(FE_ALL_EXCEPT);
    feclearexcept(FE_ALL_EXCEPT);
#endif
}

/* ------------------------------------------------------------------------------- memory whose ends cannot be crossed -- */

guarded guard(const void *data, size_t size, bool behind)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), inner = (size + page - 1) / page * page;
    guarded g = {.size = inner + 2 * page};
    g.pages = mmap(NULL, g.size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ck_assert(g.pages != MAP_FAILED);
    ck_assert_int_eq(mprotect(g.pages, page, PROT_NONE), 0);
    ck_assert_int_eq(mprotect(g.pages + page + inner, page, PROT_NONE), 0);
    g.at = g.pages + page + (behind ? inner - size : 0);
    if (data) memcpy(g.at, data, size);
    else memset(g.at, 0xff, size);
    return g;
}

void unguard(guarded g)
{
    ck_assert_int_eq(munmap(g.pages, g.size), 0);
}

/* -------------------------------------------------------------------------------------------------------------- main -- */

int run_suite(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV); /* CK_NORMAL unless CK_VERBOSITY says otherwise */
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}

bool verbose(void)
{
    return getenv("NLC_TEST_VERBOSE") != NULL;
}

uint64_t points(uint64_t usual)
{
    const char *text = getenv("NLC_TEST_POINTS");
    const double wanted = text ? strtod(text, NULL) : 0;
    return wanted > (double)usual && wanted < 1e18 ? (uint64_t)wanted : usual;
}

void time_limit(TCase *test_case, double seconds)
{
    tcase_set_timeout(test_case, getenv("NLC_TEST_POINTS") ? 0 : seconds);
}
