/* SPDX-License-Identifier: BSD-2-Clause */
/* test_status.c - the list of statuses, nlc_strerror and nlc_version */
#include "nlcontact.h"
#include "support.h"

#include <stdio.h>
#include <string.h>

typedef struct entry {
    const char *name, *text, *culprit;
    int64_t value;
} entry;

static const entry entries[] = {
#define ENTRY(name, value, text, culprit) {#name, text, culprit, value},
    NLC_STATUS_LIST(ENTRY)
#undef ENTRY
};

enum { ENTRIES = sizeof entries / sizeof *entries };

static const char unknown[] = "unknown status";

/* What nlc_strerror should say: of the list, of warning bits the highest. */
static const char *expected(int64_t status)
{
    if (status > 0)
        while (status & (status - 1)) status &= status - 1; /* clear the lowest bit */
    for (int k = 0; k < ENTRIES; k++)
        if (entries[k].value == status) return entries[k].text;
    return unknown;
}

static int64_t all_warnings(void)
{
    int64_t bits = 0;
    for (int k = 0; k < ENTRIES; k++)
        if (entries[k].value > 0) bits |= entries[k].value;
    return bits;
}

#define assert_text(status)                                                                                                    \
    do {                                                                                                                       \
        const nlc_status assert_status_ = (nlc_status)(status);                                                                \
        const char *assert_text_ = nlc_strerror(assert_status_);                                                               \
        if (!assert_text_ || strcmp(assert_text_, expected(assert_status_)))                                                   \
            ck_abort_msg("status %d: \"%s\", expected \"%s\"", (int)assert_status_, assert_text_ ? assert_text_ : "(null)",    \
                         expected(assert_status_));                                                                            \
    } while (0)

/* Names, values and texts are distinct, and no text is that of unknown ones. */
START_TEST(entries_are_distinct)
{
    ck_assert_int_gt(ENTRIES, 2);
    for (int k = 0; k < ENTRIES; k++) {
        ck_assert_uint_gt(strlen(entries[k].text), 0);
        ck_assert_uint_gt(strlen(entries[k].culprit), 0);
        ck_assert_str_ne(entries[k].text, unknown);
        for (int other = 0; other < k; other++) {
            ck_assert_str_ne(entries[k].name, entries[other].name);
            ck_assert_str_ne(entries[k].text, entries[other].text);
            ck_assert_msg(entries[k].value != entries[other].value, "%s and %s have the same value", entries[k].name,
                          entries[other].name);
        }
    }
}
END_TEST

/* 0 is success, errors are negative and warnings single bits, told apart by their names. */
START_TEST(values_follow_their_names)
{
    for (int k = 0; k < ENTRIES; k++) {
        const entry *e = &entries[k];
        const bool error = strncmp(e->name, "NLC_ERROR_", 10) == 0, warning = strncmp(e->name, "NLC_WARNING_", 12) == 0;
        ck_assert_msg(error || warning || strcmp(e->name, "NLC_OK") == 0, "%s", e->name);
        ck_assert_msg(e->value >= INT32_MIN && e->value <= INT32_MAX, "%s does not fit nlc_status", e->name);
        ck_assert_msg(e->value != NLC_STATUS_MAX, "%s", e->name);
        ck_assert_msg(error     ? e->value < 0
                      : warning ? e->value > 0 && !(e->value & (e->value - 1))
                                : e->value == 0,
                      "%s = %d", e->name, (int)e->value);
    }
    ck_assert_int_eq(NLC_OK, 0);
    /* The list is in the order of severity, so the highest of several bits is the last of their entries. */
    for (int k = 1; k < ENTRIES; k++)
        if (entries[k].value > 0 && entries[k - 1].value > 0) ck_assert_int_gt(entries[k].value, entries[k - 1].value);
    ck_assert_int_gt(NLC_WARNING_NOT_CONVERGED, NLC_WARNING_ROUNDING);
}
END_TEST

/*
 * Published numbers stay: programs have them compiled in.  New errors go to the end, and this table grows with them.  The
 * warnings' bits follow their severity instead: values_follow_their_names.
 */
START_TEST(values_are_for_good)
{
    ck_assert_int_eq(sizeof(nlc_status), 4);
    ck_assert_int_eq(NLC_ERROR_NULL, -1);
    ck_assert_int_eq(NLC_ERROR_NULL_FIELD, -2);
    ck_assert_int_eq(NLC_ERROR_STRUCT_SIZE, -3);
    ck_assert_int_eq(NLC_ERROR_RESERVED, -4);
    ck_assert_int_eq(NLC_ERROR_COUNT, -5);
    ck_assert_int_eq(NLC_ERROR_STRIDE, -6);
    ck_assert_int_eq(NLC_ERROR_MEMORY_SIZE, -7);
    ck_assert_int_eq(NLC_ERROR_ALIGNMENT, -8);
    ck_assert_int_eq(NLC_ERROR_NETWORK, -9);
    ck_assert_int_eq(NLC_ERROR_MODEL, -10);
    ck_assert_int_eq(NLC_ERROR_NO_POTENTIAL, -11);
    ck_assert_int_eq(NLC_ERROR_METHOD, -12);
    ck_assert_int_eq(NLC_ERROR_OPTION, -13);
    ck_assert_int_eq(NLC_ERROR_RADIUS, -14);
    ck_assert_int_eq(NLC_ERROR_MATERIAL, -15);
    ck_assert_int_eq(NLC_ERROR_YOUNG, -16);
    ck_assert_int_eq(NLC_ERROR_POISSON, -17);
    ck_assert_int_eq(NLC_ERROR_INDEX, -18);
    ck_assert_int_eq(NLC_ERROR_WALL_WALL, -19);
    ck_assert_int_eq(NLC_ERROR_RIGID_RIGID, -20);
    ck_assert_int_eq(NLC_ERROR_STIFFNESS, -21);
    ck_assert_int_eq(NLC_ERROR_OVERLAP, -22);
    ck_assert_int_eq(NLC_ERROR_NORMAL, -23);
    ck_assert_int_eq(NLC_ERROR_NONLOCAL, -24);
    ck_assert_int_eq(NLC_ERROR_FORCE, -25);
    ck_assert_int_eq(NLC_ERROR_TOTAL_FORCE, -26);
    ck_assert_int_eq(NLC_ERROR_COINCIDENT, -27);
    ck_assert_int_eq(NLC_ERROR_RANGE, -28);
    ck_assert_int_eq(NLC_ERROR_UNSTABLE, -29);
    ck_assert_int_eq(NLC_ERROR_SLIDING, -30);
    ck_assert_int_eq(NLC_ERROR_POSITION, -31);
    ck_assert_int_eq(NLC_ERROR_SAME_PLACE, -32);
    ck_assert_int_eq(NLC_ERROR_CELL, -33);
    ck_assert_int_eq(NLC_ERROR_CAPACITY, -34);
    ck_assert_int_eq(NLC_ERROR_GHOST, -35);
    ck_assert_int_eq(NLC_ERROR_REMOTE, -36);
    ck_assert_int_eq(NLC_ERROR_CALLBACK, -37);
}
END_TEST

START_TEST(every_status_has_its_text)
{
    for (int k = 0; k < ENTRIES; k++) {
        ck_assert_str_eq(nlc_strerror((nlc_status)entries[k].value), entries[k].text);
        ck_assert_ptr_eq(nlc_strerror((nlc_status)entries[k].value), nlc_strerror((nlc_status)entries[k].value));
    }
    ck_assert_str_eq(nlc_strerror(NLC_OK), "success");
}
END_TEST

/* Every combination of the warnings there are names the highest. */
START_TEST(combined_warnings)
{
    const int64_t all = all_warnings();
    for (int64_t bits = 1; bits <= all; bits++) assert_text(bits);
    ck_assert_str_eq(nlc_strerror(NLC_WARNING_NOT_CONVERGED | NLC_WARNING_ROUNDING), nlc_strerror(NLC_WARNING_NOT_CONVERGED));
}
END_TEST

/* Whatever else the 32 bits hold is unknown, also if warnings that exist stand below a bit that does not. */
START_TEST(unknown_statuses)
{
    const int64_t all = all_warnings();
    for (int64_t status = -70000; status <= 70000; status++) assert_text(status);
    for (int bit = 0; bit < 31; bit++)
        for (int64_t below = 0; below <= all; below++) {
            assert_text(INT64_C(1) << bit | below);
            assert_text(-(INT64_C(1) << bit) + below);
        }
    for (int k = 0; k < 16; k++) {
        assert_text(INT32_MIN + k);
        assert_text(INT32_MAX - k);
    }
    rng g = {1};
    for (int k = 0; k < 100000; k++) assert_text((int32_t)(rng_next(&g) >> 32));
    ck_assert_str_eq(nlc_strerror(INT32_MIN), unknown);
    ck_assert_str_eq(nlc_strerror(INT32_MAX), unknown);
    int64_t lowest = 0;
    for (int k = 0; k < ENTRIES; k++)
        if (entries[k].value < lowest) lowest = entries[k].value;
    ck_assert_str_eq(nlc_strerror((nlc_status)(lowest - 1)), unknown);
    ck_assert_str_eq(nlc_strerror((nlc_status)(all + 1)), unknown); /* the bits have no holes */
    ck_assert_str_eq(nlc_strerror((nlc_status)(all + 2)), unknown);
}
END_TEST

/* The library was built from the header that this program was built from. */
START_TEST(version)
{
    char text[64];
    snprintf(text, sizeof text, "%d.%d.%d", NLC_VERSION_MAJOR, NLC_VERSION_MINOR, NLC_VERSION_PATCH);
    ck_assert_str_eq(nlc_version(), text);
    ck_assert_ptr_eq(nlc_version(), nlc_version());
}
END_TEST

START_TEST(environment_is_left_alone)
{
    nlc_assert_quiet(nlc_version());
    nlc_assert_quiet(for (int status = -40; status < 10; status++) nlc_strerror(status));
}
END_TEST

static Suite *suite(void)
{
    Suite *s = suite_create("status");
    TCase *t = tcase_create("status");
    tcase_add_test(t, entries_are_distinct);
    tcase_add_test(t, values_follow_their_names);
    tcase_add_test(t, values_are_for_good);
    tcase_add_test(t, every_status_has_its_text);
    tcase_add_test(t, combined_warnings);
    tcase_add_test(t, unknown_statuses);
    tcase_add_test(t, version);
    tcase_add_test(t, environment_is_left_alone);
    suite_add_tcase(s, t);
    return s;
}

int main(void)
{
    return run_suite(suite());
}
