/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * stress.h - solves in great number: one trial with all that must hold for any of them, and what came out, group by group.
 *
 * A trial that breaks the contract outright (NaN, an exception, more sweeps than allowed) ends the test there.  One that is not
 * as good as promised is a miss: it is said on stdout, counted, and fails the test when the group ends, unless it is known.
 */
#ifndef NLC_TESTS_STRESS_H
#define NLC_TESTS_STRESS_H

#include "exact.h"

/* full - whether NLC_TEST_FULL is set: the whole grid, and a table of it. */
bool full(void);

enum { COUNT_OK, COUNT_CLOSE, COUNT_ROUNDING, COUNT_WEAKENED, COUNT_NOT_CONVERGED, COUNTS };

/* A group of trials. */
typedef struct tally {
    char name[64];
    int64_t trials, blocks, misses, alone, other, status[COUNTS];
    double *sweeps, *error; /* [trials], [compared]; the error in units of the tolerance */
    int64_t compared;
    int target; /* sweeps, 0: none */
} tally;

/* The heading of the table, if it is asked for. */
void tally_heading(void);

/* An empty group, with the number of sweeps that it should not need more of (0: any). */
void tally_begin(tally *t, int target, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Prints its row and frees it.  More misses than known fail the test when it ends, where no_misses is its teardown. */
void tally_end(tally *t, int64_t known);
void no_misses(void);

/* A miss, said on stdout. */
void tally_miss(tally *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

typedef struct trial {
    nlc_status status;
    nlc_info info;
    double error; /* of the forces, relative to the largest nearby: against e, or from the recomputed residual; INFINITY:
                     neither */
} trial;

/*
 * Solves with the overlaps times load, to this tolerance, from the nonlocal displacements there are: finite forces that belong
 * to the displacements handed over, no floating-point exception, sweeps within the limit.
 */
trial solve_load(scene *s, double load, double tolerance);

/* Forgets the displacements. */
void cold(scene *s);

/*
 * One of the grid: solve_load from nothing, counted in t.  Against e at that load or, if e is NULL, by the residual recomputed
 * with nlc_sweep over 1 - lambda_upper.  A stable solution is expected: e's lambda must not be above the margin.
 */
trial solve_stable(tally *t, scene *s, const exact *e, double load, double tolerance);

/* Where there is no stable solution: weakened, and the forces move by at most 50 h of the largest nearby as the load does by h.
 */
trial solve_beyond(tally *t, scene *s, double load, double tolerance);

/* Counts a trial, without looking at it. */
void tally_count(tally *t, const trial *r);

/* Residual of P = k (gamma + g)_+^(3/2) with g from nlc_sweep, relative to the largest force nearby. */
double recomputed_residual(const scene *s, double load);

/* Load factor at which the stable branch ends; *capped: it does not up to a strain of 20 % (overlap / (R_i + R_j)). */
double end_of_branch(const scene *s, bool *capped);

#endif
