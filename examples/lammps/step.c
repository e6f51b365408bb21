/* SPDX-License-Identifier: BSD-2-Clause */
/* step.c - a time step: between LAMMPS' forces and its integrator the nonlocal part of the contact forces is added. */
#include <math.h>
#include <string.h>
#include <time.h>

#include "host.h"

/* P = k (gamma + g)^(3/2) with the displacements g of the last solve, extrapolated from the last two. */
static double extrapolated(const contacts *c, int64_t k, double ratio)
{
    return nlc_hertz_force(c->stiffness[k], c->overlap[k] + c->nonlocal[k] + ratio * (c->nonlocal[k] - c->previous[k]));
}

/* Extrapolated, by how much would the forces be wrong now?  Before c->nonlocal and c->previous change. */
static void keep_extrapolated(host *h, double ratio)
{
    for (int64_t k = 0; k < h->c.count; k++) h->c.hertz[k] = extrapolated(&h->c, k, ratio);
}

static void compare_extrapolated(host *h)
{
    for (int64_t k = 0; k < h->c.count; k++) {
        h->time.missed += fabs(h->c.hertz[k] - h->c.force[k]);
        h->time.forces_sum += h->c.force[k];
    }
}

static void solve(host *h, int64_t step, nlc_info *info)
{
    contacts *c = &h->c;
    nlc_status status;
    const double ratio = h->set.predict && step > h->solved && h->span > 0 ? (double)(step - h->solved) / (double)h->span : 0;
    const bool compare = ratio > 0 && h->set.interval > 1;
    if (compare) keep_extrapolated(h, ratio);
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
static void extrapolate(host *h, int64_t step, nlc_info *info)
{
    info->residual = h->residual;
    const double ratio = h->span > 0 ? (double)(step - h->solved) / (double)h->span : 0;
    for (int64_t k = 0; k < h->c.count; k++) h->c.force[k] = extrapolated(&h->c, k, ratio);
}

/* Of what is added between two particles; walls have no part in LAMMPS' pressure. */
static void add_virial(totals *t, double moment, const double n[3])
{
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int e = 0; e < 6; e++) t->virial[e] += moment * n[row[e]] * n[column[e]];
}

/* What is added: P - P_Hertz along the normal, in c->hertz, as LAMMPS' pair style and walls add P_Hertz. */
static void differences(host *h)
{
    const contacts *c = &h->c;
    totals t = {0};
    for (int64_t k = 0; k < c->count; k++) {
        const double share = host_share(h, k);
        const double hertz = c->overlap[k] > 0 ? c->stiffness[k] * c->overlap[k] * sqrt(c->overlap[k]) : 0;
        c->hertz[k] = c->force[k] - hertz;
        t.active += share * (c->force[k] > 0);
        t.touching += share * (c->overlap[k] > 0);
        t.force += share * c->force[k];
        t.hertz += share * hertz;
        if (c->j[k] < h->bodies) {
            t.pairs += share * (c->force[k] > 0);
            add_virial(&t, share * c->hertz[k] * (h->radius[c->i[k]] + h->radius[c->j[k]] - c->overlap[k]), c->normal + 3 * k);
        } else {
            t.wall[c->j[k] - h->bodies] += c->force[k];
        }
    }
    h->sum = t;
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
        extrapolate(h, step, &info);
    at[3] = processor_time();
    differences(h);
    if (h->bodies > 0) memset(f[0], 0, 3 * (size_t)h->bodies * sizeof(double)); /* LAMMPS has rows for its ghosts, too */
    nlc_status added = nlc_assemble(h->c.network, h->bodies > 0 ? f[0] : at, 0, NULL, h->c.hertz, h->c.normal, NULL);
    host_check(added, NULL, "nlc_assemble");
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
