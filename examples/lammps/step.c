/* SPDX-License-Identifier: BSD-2-Clause */
/* step.c - a time step: between LAMMPS' forces and its integrator the nonlocal part of the contact forces is added. */
#include <math.h>
#include <string.h>
#include <time.h>

#include "host.h"

/* P = k (gamma + g)^(3/2) with the displacements g of the last solve, extrapolated from the last two. */
static void extrapolate(const contacts *c, double ratio, double *force)
{
    for (int64_t k = 0; k < c->count; k++)
        force[k] = host_law(c->stiffness[k], c->overlap[k] + c->nonlocal[k] + ratio * (c->nonlocal[k] - c->previous[k]));
}

/* By how much would extrapolated forces have been wrong now? */
static void compare_extrapolated(host *h)
{
    for (int64_t k = 0; k < h->c.count; k++) {
        h->time.missed += fabs(h->c.guess[k] - h->c.force[k]);
        h->time.forces_sum += h->c.force[k];
    }
}

static void solve(host *h, int64_t step, nlc_info *info)
{
    contacts *c = &h->c;
    nlc_status status;
    const double ratio = h->set.predict && step > h->solved && h->span > 0 ? (double)(step - h->solved) / (double)h->span : 0;
    const bool compare = ratio > 0 && h->set.interval > 1;
    if (compare) extrapolate(c, ratio, c->guess);
    if (ratio > 0) {
        status = nlc_predict(c->nonlocal, c->previous, c->count, ratio, info);
        host_check(status, info, "nlc_predict");
    } else if (c->count > 0) {
        memcpy(c->previous, c->nonlocal, (size_t)c->count * sizeof *c->previous);
    }
    if (step != h->solved)
        h->span = h->solved >= 0 ? step - h->solved : 0; /* a run begins with the last step of the one before */
    h->solved = step;
    status = nlc_solve(c->network, c->force, c->nonlocal, c->overlap, c->normal, info);
    host_check(status, info, "nlc_solve");
    if (compare) compare_extrapolated(h);
    h->status = status;
    h->residual = info->residual;
    h->time.solves++;
}

/* Between two solves. */
static void do_not_solve(host *h, int64_t step, nlc_info *info)
{
    info->residual = h->residual;
    extrapolate(&h->c, h->set.predict && h->span > 0 ? (double)(step - h->solved) / (double)h->span : 0, h->c.force);
}

/* Of what is added between two particles; walls have no part in LAMMPS' pressure. */
static void add_virial(totals *t, double moment, const double n[3])
{
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int e = 0; e < 6; e++) t->virial[e] += moment * n[row[e]] * n[column[e]];
}

/*
 * P - P_Hertz along the normals, and their sums, in one pass: nlc_assemble checks its arguments in others.  Open pairs add nothing.
 * On ghosts nothing is added either: their owners have the contact, too.
 */
static void add_differences(host *h, double *F)
{
    const contacts *c = &h->c;
    totals t = {0};
    for (int64_t k = 0; k < c->count; k++) {
        const double force = c->force[k], overlap = c->overlap[k], hertz = host_hertz(c, k), *n = c->normal + 3 * k;
        if (!(force > 0 || overlap > 0)) continue;
        const int32_t i = c->i[k], j = c->j[k];
        const double share = host_share(h, k), more = force - hertz;
        t.active += share * (force > 0);
        t.touching += share * (overlap > 0);
        t.force += share * force;
        t.hertz += share * hertz;
        for (int x = 0; x < 3; x++) F[3 * (size_t)i + (size_t)x] -= more * n[x];
        if (j >= h->bodies) {
            t.wall[j - h->bodies] += force;
            continue;
        }
        t.pairs += share * (force > 0);
        add_virial(&t, share * more * (h->radius[i] + h->radius[j] - overlap), n);
        if (j < h->seen.owned)
            for (int x = 0; x < 3; x++) F[3 * (size_t)j + (size_t)x] += more * n[x];
    }
    h->sum = t;
}

/* Forces across the contacts, with which the energy is kept.  F is zero. */
static void add_turning(host *h, double *F)
{
    nlc_info info = {.struct_size = sizeof info};
    const nlc_status status = nlc_assemble_turning(h->c.network, F, 0, h->c.force, h->c.overlap, h->c.normal, &info);
    host_check(status, &info, "nlc_assemble_turning");
    if (h->ranks.count > 1) ranks_return(&h->ranks, F, h->ghost_tag, h->ghost_owner, h->ghosts);
}

static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void step_callback(void *pointer, int64_t step, int owned, int *tag, double **x, double **f)
{
    host *h = pointer;
    nlc_info info = {.struct_size = sizeof info};
    double at[6]; /* processor time: other work on the machine does not count */
    at[0] = processor_time();
    settings_walls(h);
    const bool stale = search_is_stale(h, tag, x, owned);
    if (stale) {
        contacts_find(h, tag, x, owned);
        h->time.rebuilds++;
    }
    at[1] = processor_time();
    contacts_update(h, x);
    at[2] = processor_time();
    if (stale || step <= h->solved || step - h->solved >= h->set.interval)
        solve(h, step, &info);
    else
        do_not_solve(h, step, &info);
    at[3] = processor_time();
    double none[3], *F = h->bodies > 0 ? f[0] : none; /* LAMMPS has rows for its ghosts, too */
    if (h->bodies > 0) memset(F, 0, 3 * (size_t)h->bodies * sizeof *F);
    if (h->set.turning) add_turning(h, F);
    add_differences(h, F);
    at[4] = processor_time();
    output_step(h, step, &info);
    at[5] = processor_time();
    double *const spent[] = {&h->time.rebuild, &h->time.geometry, &h->time.solve, &h->time.forces, &h->time.output};
    for (int k = 0; k < 5; k++) *spent[k] += at[k + 1] - at[k];
    h->time.steps++;
    h->time.sweeps += info.sweeps;
    h->time.most_sweeps = info.sweeps > h->time.most_sweeps ? info.sweeps : h->time.most_sweeps;
    h->time.contacts += h->c.count;
}
