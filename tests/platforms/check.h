/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * check.h - as much of Check as the tests use, for platforms that have none: no forks and no time limits, the first failure ends
 * the program.
 */
#ifndef NLC_TESTS_PLATFORMS_CHECK_H
#define NLC_TESTS_PLATFORMS_CHECK_H

#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*TFun)(int);
typedef void (*SFun)(void);
typedef struct TTest {
    const char *name;
    TFun fn;
} TTest;
typedef struct TCase {
    SFun setup, teardown;
    struct {
        const TTest *test;
        int from, to;
    } test[200];
    int count;
} TCase;
typedef struct Suite {
    const char *name;
    TCase *test_case[50];
    int count;
} Suite;
typedef struct SRunner {
    Suite *suite;
    int tests;
} SRunner;
enum print_output { CK_SILENT, CK_MINIMAL, CK_NORMAL, CK_VERBOSE, CK_ENV };

#define START_TEST(name)                                                                                                       \
    static void name##_fn(int);                                                                                                \
    static const TTest name##_test = {#name, name##_fn};                                                                       \
    static const TTest *const name = &name##_test;                                                                             \
    static void name##_fn(int _i)                                                                                              \
    {                                                                                                                          \
        (void)_i;
#define END_TEST }

static inline void *check_room(size_t size)
{
    void *p = calloc(1, size);
    if (!p) abort();
    return p;
}

static inline Suite *suite_create(const char *name)
{
    Suite *s = (Suite *)check_room(sizeof *s);
    s->name = name;
    return s;
}

static inline TCase *tcase_create(const char *name)
{
    (void)name;
    return (TCase *)check_room(sizeof(TCase));
}

static inline void suite_add_tcase(Suite *s, TCase *t)
{
    if (s->count == 50) abort();
    s->test_case[s->count++] = t;
}

static inline void tcase_add_loop_test(TCase *t, const TTest *test, int from, int to)
{
    if (t->count == 200) abort();
    t->test[t->count].test = test;
    t->test[t->count].from = from;
    t->test[t->count++].to = to;
}

#define tcase_add_test(t, test) tcase_add_loop_test(t, test, 0, 1)

static inline void tcase_add_checked_fixture(TCase *t, SFun setup, SFun teardown)
{
    t->setup = setup;
    t->teardown = teardown;
}

static inline void tcase_set_timeout(TCase *t, double seconds)
{
    (void)t, (void)seconds;
}

static inline SRunner *srunner_create(Suite *s)
{
    SRunner *r = (SRunner *)check_room(sizeof *r);
    r->suite = s;
    return r;
}

static inline void srunner_run_all(SRunner *r, enum print_output how)
{
    (void)how;
    for (int c = 0; c < r->suite->count; c++) {
        const TCase *t = r->suite->test_case[c];
        for (int k = 0; k < t->count; k++)
            for (int i = t->test[k].from; i < t->test[k].to; i++, r->tests++) {
                if (getenv("NLC_TEST_VERBOSE")) fprintf(stderr, "%s: %s %d\n", r->suite->name, t->test[k].test->name, i);
                if (t->setup) t->setup();
                t->test[k].test->fn(i);
                if (t->teardown) t->teardown();
            }
    }
    printf("%s: %d tests: ok\n", r->suite->name, r->tests);
}

static inline int srunner_ntests_failed(const SRunner *r)
{
    (void)r;
    return 0;
}

static inline void srunner_free(SRunner *r)
{
    for (int c = 0; c < r->suite->count; c++) free(r->suite->test_case[c]);
    free(r->suite);
    free(r);
}

#define ck_abort_msg(...) (fprintf(stderr, "%s:%d: ", __FILE__, __LINE__), fprintf(stderr, __VA_ARGS__), fputc('\n', stderr), exit(1))
#define ck_assert_msg(condition, ...) ((condition) ? (void)0 : ck_abort_msg(__VA_ARGS__))
#define ck_assert(condition) ck_assert_msg(condition, "%s", #condition)
#define CHECK_COMPARE(type, format, a, op, b)                                                                                  \
    do {                                                                                                                       \
        const type check_a_ = (a), check_b_ = (b);                                                                             \
        if (!(check_a_ op check_b_)) ck_abort_msg("%s %s %s: " format " and " format, #a, #op, #b, check_a_, check_b_);         \
    } while (0)
#define ck_assert_int_eq(a, b) CHECK_COMPARE(intmax_t, "%jd", a, ==, b)
#define ck_assert_int_ge(a, b) CHECK_COMPARE(intmax_t, "%jd", a, >=, b)
#define ck_assert_int_gt(a, b) CHECK_COMPARE(intmax_t, "%jd", a, >, b)
#define ck_assert_int_le(a, b) CHECK_COMPARE(intmax_t, "%jd", a, <=, b)
#define ck_assert_int_lt(a, b) CHECK_COMPARE(intmax_t, "%jd", a, <, b)
#define ck_assert_int_ne(a, b) CHECK_COMPARE(intmax_t, "%jd", a, !=, b)
#define ck_assert_uint_eq(a, b) CHECK_COMPARE(uintmax_t, "%ju", a, ==, b)
#define ck_assert_uint_gt(a, b) CHECK_COMPARE(uintmax_t, "%ju", a, >, b)
#define ck_assert_uint_ge(a, b) CHECK_COMPARE(uintmax_t, "%ju", a, >=, b)
#define ck_assert_uint_le(a, b) CHECK_COMPARE(uintmax_t, "%ju", a, <=, b)
#define ck_assert_uint_lt(a, b) CHECK_COMPARE(uintmax_t, "%ju", a, <, b)
#define ck_assert_uint_ne(a, b) CHECK_COMPARE(uintmax_t, "%ju", a, !=, b)
#define ck_assert_double_eq(a, b) CHECK_COMPARE(double, "%.17g", a, ==, b)
#define ck_assert_double_ne(a, b) CHECK_COMPARE(double, "%.17g", a, !=, b)
#define ck_assert_double_gt(a, b) CHECK_COMPARE(double, "%.17g", a, >, b)
#define ck_assert_double_ge(a, b) CHECK_COMPARE(double, "%.17g", a, >=, b)
#define ck_assert_double_lt(a, b) CHECK_COMPARE(double, "%.17g", a, <, b)
#define ck_assert_double_le(a, b) CHECK_COMPARE(double, "%.17g", a, <=, b)
#define ck_assert_double_finite(a) ck_assert_msg(isfinite(a), "%s = %.17g", #a, (double)(a))
#define ck_assert_ptr_eq(a, b) CHECK_COMPARE(uintptr_t, "0x%" PRIxPTR, (uintptr_t)(a), ==, (uintptr_t)(b))
#define ck_assert_ptr_ne(a, b) CHECK_COMPARE(uintptr_t, "0x%" PRIxPTR, (uintptr_t)(a), !=, (uintptr_t)(b))
#define ck_assert_ptr_null(a) ck_assert_msg((a) == NULL, "%s is not NULL", #a)
#define ck_assert_ptr_nonnull(a) ck_assert_msg((a) != NULL, "%s is NULL", #a)
#define ck_assert_mem_eq(a, b, n) ck_assert_msg(memcmp(a, b, n) == 0, "%s and %s differ", #a, #b)
#define CHECK_STRINGS(a, op, b)                                                                                                \
    do {                                                                                                                       \
        const char *const check_a_ = (a), *const check_b_ = (b);                                                               \
        if (!(strcmp(check_a_, check_b_) op 0)) ck_abort_msg("%s %s %s: '%s' and '%s'", #a, #op, #b, check_a_, check_b_);        \
    } while (0)
#define ck_assert_str_eq(a, b) CHECK_STRINGS(a, ==, b)
#define ck_assert_str_ne(a, b) CHECK_STRINGS(a, !=, b)

#endif
