/* SPDX-License-Identifier: BSD-2-Clause */
/* output.c - what LAMMPS and files get to see. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"

/* Per-atom values live in a fix property/atom, where dumps and computes find them. */
static const char *const columns[] = {"nlc_count", "nlc_sum", "nlc_hertz"};

void output_prepare(host *h)
{
    lammps_command(h->lammps, "fix nlc_atom all property/atom d_nlc_count d_nlc_sum d_nlc_hertz");
    lammps_fix_external_set_vector_length(h->lammps, FIX, OUTPUT_LENGTH);
    if (h->ranks.rank > 0) return;
    nlc_model_record model = {.struct_size = sizeof model};
    nlc_model_info(h->set.options.model, &model, NULL);
    printf("nlc: %s, tolerance %g, gaps below %g may close, %d walls\n", model.name, h->set.options.tolerance, h->set.reach,
           (int)h->set.walls);
    for (int32_t type = 1; type <= h->set.types; type++) {
        const nlc_material m = h->set.material[type];
        const double K = 2 * m.young / (3 * (1 - m.poisson * m.poisson));
        printf("nlc: type %d: E %g, nu %g; the pair style's Kn has to be %.16g, that of rigid walls %.16g\n", (int)type,
               m.young, m.poisson, K, 2 * K);
    }
    fflush(stdout);
}

static void add_up(host *h)
{
    MPI_Allreduce(MPI_IN_PLACE, &h->sum, sizeof h->sum / sizeof(double), MPI_DOUBLE, MPI_SUM, h->ranks.world);
}

/* f_nlc[1] ...: the README lists them. */
static void show_thermo(host *h, const nlc_info *info)
{
    const double particles = lammps_get_natoms(h->lammps);
    double value[OUTPUT_LENGTH] = {
        (double)info->sweeps, info->residual, h->sum.active, h->sum.touching, 2 * h->sum.pairs / particles,
        h->sum.force,         h->sum.hertz,   h->status,     h->needed_reach};
    for (int w = 0; w < h->set.walls; w++) value[OUTPUT_LENGTH - WALLS + w] = h->sum.wall[w];
    for (int k = 0; k < OUTPUT_LENGTH; k++) lammps_fix_external_set_vector(h->lammps, FIX, k + 1, value[k]);
    lammps_fix_external_set_virial_global(h->lammps, FIX, h->sum.virial);
}

/* Contacts with a force, sum of their forces, and of those by Hertz: of every particle. */
static void show_atoms(host *h)
{
    const contacts *c = &h->c;
    double *value[3];
    for (int k = 0; k < 3; k++) {
        char name[NAME];
        snprintf(name, sizeof name, "d_%s", columns[k]);
        value[k] = lammps_extract_atom(h->lammps, name);
        if (!value[k]) host_fail("fix nlc_atom is gone");
        memset(value[k], 0, (size_t)h->seen.owned * sizeof(double));
    }
    for (int64_t k = 0; k < c->count; k++) {
        const int32_t body[2] = {c->i[k], c->j[k]};
        for (int side = 0; side < 2; side++) {
            if (body[side] >= h->seen.owned) continue;
            value[0][body[side]] += c->force[k] > 0;
            value[1][body[side]] += c->force[k];
            value[2][body[side]] += host_hertz(c, k);
        }
    }
}

static void show_energy(host *h)
{
    nlc_info info = {.struct_size = sizeof info};
    double energy = 0;
    const nlc_status status = nlc_energy(h->c.network, &energy, h->c.force, h->c.overlap, h->c.normal, &info);
    if (status == NLC_ERROR_NO_POTENTIAL) return;
    host_check(status, &info, "nlc_energy");
    lammps_fix_external_set_energy_global(h->lammps, FIX, energy);
}

static void find_needed_reach(host *h)
{
    nlc_info info = {.struct_size = sizeof info};
    host_check(nlc_reach(h->c.network, &h->needed_reach, NULL, h->c.force, &info), &info, "nlc_reach");
    MPI_Allreduce(MPI_IN_PLACE, &h->needed_reach, 1, MPI_DOUBLE, MPI_MAX, h->ranks.world);
}

/* Rank after rank adds its contacts: particles' tags, -1 for the first wall. */
static void write_contacts(const host *h, int64_t step)
{
    const contacts *c = &h->c;
    char path[sizeof h->set.file + 32];
    snprintf(path, sizeof path, "%s.%lld.csv", h->set.file, (long long)step);
    for (int turn = 0; turn < h->ranks.count; turn++) {
        MPI_Barrier(h->ranks.world);
        if (turn != h->ranks.rank) continue;
        FILE *file = fopen(path, turn ? "a" : "w");
        if (!file) host_fail("%s cannot be written", path);
        if (turn == 0) fprintf(file, "i,j,overlap,force,hertz,nx,ny,nz\n");
        for (int64_t k = 0; k < c->count; k++) {
            const bool wall = c->atom_j[k] >= h->seen.atoms;
            const int j = wall ? -1 - (c->atom_j[k] - h->seen.atoms) : h->seen.tag[c->atom_j[k]];
            const double *n = c->normal + 3 * k;
            if (host_share(h, k) < 1 && j < h->seen.tag[c->atom_i[k]]) continue; /* the other rank writes it */
            if (c->force[k] > 0 || c->overlap[k] > 0)
                fprintf(file, "%d,%d,%.16g,%.16g,%.16g,%.16g,%.16g,%.16g\n", (int)h->seen.tag[c->atom_i[k]], j, c->overlap[k],
                        c->force[k], host_hertz(c, k), n[0], n[1], n[2]);
        }
        if (fclose(file) != 0) host_fail("%s cannot be written", path);
    }
}

static void warn(host *h, int64_t step)
{
    const bool short_reach = h->needed_reach > h->set.reach;
    const int news = (h->status | (short_reach ? 1 << 30 : 0)) & ~h->warned;
    if (news && h->ranks.rank == 0) {
        if (news & ~(1 << 30)) printf("nlc: warning, step %lld: %s\n", (long long)step, nlc_strerror(news & ~(1 << 30)));
        if (news >> 30)
            printf("nlc: warning, step %lld: gaps up to %g might close, nlc_reach is %g\n", (long long)step, h->needed_reach,
                   h->set.reach);
        fflush(stdout);
    }
    h->warned |= news;
}

void output_step(host *h, int64_t step, const nlc_info *info)
{
    add_up(h);
    if (h->set.every > 0 && step % h->set.every == 0) {
        find_needed_reach(h);
        show_energy(h);
        show_atoms(h);
        if (h->set.file[0]) write_contacts(h, step);
    }
    show_thermo(h, info);
    warn(h, step);
}

/* What the ranks have told each other, per step: sides are numbers that cross from one rank to another. */
static void print_traffic(const host *h)
{
    const ranks *r = &h->ranks;
    double own[5] = {(double)r->sides, (double)r->messages, (double)h->seen.owned, (double)h->ghosts, (double)r->straddling};
    double sum[5], most[5];
    MPI_Reduce(own, sum, 5, MPI_DOUBLE, MPI_SUM, 0, r->world);
    MPI_Reduce(own, most, 5, MPI_DOUBLE, MPI_MAX, 0, r->world);
    if (r->rank > 0) return;
    const double steps = (double)h->time.steps;
    printf("nlc: %d ranks, the largest with %.0f particles, %.0f ghosts, %.0f contacts with these; in all %.0f of them, on "
           "both sides\n",
           r->count, most[2], most[3], most[4], sum[4]);
    printf("nlc: a step: %.2f exchanges of %.1f kB and %.1f messages in all, %.1f reductions of %.1f numbers\n",
           (double)r->exchanges / steps, 8e-3 * sum[0] / (double)r->exchanges, sum[1] / (double)r->exchanges,
           (double)r->reductions / steps, (double)r->reduced / (double)r->reductions);
}

void output_times(const host *h)
{
    const clock_times *t = &h->time;
    if (t->steps > 0 && h->ranks.exchanges > 0) print_traffic(h);
    if (h->ranks.rank > 0 || t->steps == 0) return;
    const double n = (double)t->steps, count = (double)t->contacts / n, ms = 1e3 / n, ns = 1e9 / n / (count > 0 ? count : 1);
    printf("nlc: %lld steps, %.0f contacts and candidates, %.2f sweeps a step (at most %lld), %lld lists read\n",
           (long long)t->steps, count, (double)t->sweeps / n, (long long)t->most_sweeps, (long long)t->rebuilds);
    if (t->forces_sum > 0)
        printf("nlc: %lld solves; forces extrapolated over an interval are off by %.2g of their mean\n", (long long)t->solves,
               t->missed / t->forces_sum);
    printf("nlc: %-10s%12s%14s\n", "", "ms a step", "ns a contact");
    const struct {
        const char *name;
        double seconds;
    } rows[] = {
        {"lists", t->rebuild}, {"overlaps", t->geometry}, {"solve", t->solve}, {"forces", t->forces}, {"output", t->output}};
    for (int k = 0; k < 5; k++) printf("nlc: %-10s%12.4f%14.1f\n", rows[k].name, rows[k].seconds * ms, rows[k].seconds * ns);
}
