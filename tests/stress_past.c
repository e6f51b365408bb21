/* SPDX-License-Identifier: BSD-2-Clause */
/* stress_past.c - packings about the end of their stable branch and far beyond, from nothing and from other loads. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "stress.h"

TCase *stress_past(void);

#define SWEEPS 80 /* at 1e-10 */

static const char *const packings[] = {"b_die125_rd0.56.csv",    "b_die125_rd0.80.csv",    "b_die125_rd0.70.csv",
                                       "c_hydrogel514_rest.csv", "c_hydrogel514_strain13.csv", "a_mono1000_periodic.csv"};
static const double poisson[] = {0.3, 0.45, 0.49, 0};

static void count(tally *t, const trial *r, double load, double from)
{
    tally_count(t, r);
    if (verbose())
        printf("%s, load %g from %g: status %d, %jd sweeps, %jd blocks, coupling %.4f\n", t->name, load, from, r->status,
               (intmax_t)r->info.sweeps, (intmax_t)r->info.blocks, r->info.coupling);
    if (r->status & NLC_WARNING_NOT_CONVERGED) tally_miss(t, "load %g from %g: not converged", load, from);
    if (r->info.sweeps > t->target) tally_miss(t, "load %g from %g: %jd sweeps", load, from, (intmax_t)r->info.sweeps);
}

/*
 * From nothing, and from the state at so much of the load: the same forces to both tolerances.  Where circles overlap there may be a
 * stable state and a weakened one below the end, and several weakened ones beyond it, of which some were seen with nu = 0.
 */
static void compare_starts(tally *t, scene *s, double load, double end, bool one)
{
    static const double from[] = {0.9, 0.5, 0.9999, 1.1};
    long double *force = malloc((size_t)s->contacts * sizeof *force);
    cold(s);
    const trial first = solve_load(s, load * end, 1e-10);
    count(t, &first, load, 0);
    if (load > 1 && !(first.status & NLC_WARNING_WEAKENED)) tally_miss(t, "load %g from nothing: not weakened", load);
    for (int64_t c = 0; c < s->contacts; c++) force[c] = s->force[c];
    for (int k = 0; k < (full() ? 4 : 2); k++) {
        cold(s);
        solve_load(s, from[k] * load * end, 1e-10);
        const trial r = solve_load(s, load * end, 1e-10);
        const double error = scene_error(s, s->force, force);
        count(t, &r, load, from[k]);
        if (load > 1 && !(r.status & NLC_WARNING_WEAKENED)) tally_miss(t, "load %g from %g: not weakened", load, from[k]);
        if (error > 2e-10 && (one || !(r.status & NLC_WARNING_CLOSE))) tally_miss(t, "load %g from %g: differs by %g", load, from[k], error);
    }
    free(force);
}

START_TEST(packings_past_the_end)
{
    static const double load[] = {1.0003, 1.1, 4, 0.999, 1.01, 1.05, 2, 3.6, 10};
    tally t;
    tally_begin(&t, SWEEPS, "packings past the end, nu %g", poisson[_i]);
    for (int p = 0; p < (full() ? 6 : 2); p++) {
        scene s;
        scene_init(&s);
        scene_packing(&s, packings[p], 0.3);
        for (int64_t m = 0; m < s.materials; m++) s.rows[m].poisson = poisson[_i];
        const double end = (double)exact_end(&s, 200, 1e-6L);
        ck_assert(isfinite(end));
        for (int l = 0; l < (full() ? 9 : 3); l++) compare_starts(&t, &s, load[l], end, load[l] > 1 && poisson[_i] > 0);
        scene_free(&s);
    }
    tally_end(&t, 0);
}
END_TEST

TCase *stress_past(void)
{
    TCase *t = tcase_create("past");
    tcase_set_timeout(t, full() ? 0 : 300);
    tcase_add_checked_fixture(t, 0, no_misses);
    tcase_add_loop_test(t, packings_past_the_end, 0, 4);
    return t;
}
