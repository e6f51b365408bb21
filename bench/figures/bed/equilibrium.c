/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * equilibrium.c - FIRE: Bitzek, Koskinen, Gaehler, Moseler, Gumbsch, Phys. Rev. Lett. 97 (2006) 170201.
 *
 * Newton's motion whose velocity is turned towards the forces, and which stops where it would go uphill.  It needs no energy: the
 * contact forces on a sphere are not quite the gradient of one, because the coupling changes with the normals.
 */
#include "equilibrium.h"

#include <math.h>
#include <string.h>

enum { MOST_STEPS = 50000, DELAY = 5, WEIGH = 20 };
static const double wanted = 1e-8;     /* imbalance */
static const double nothing = 1e-9;    /* mean force below which the bed is not loaded, in E R^2 of the larger spheres */
static const double first_step = .1, longest_step = .5; /* in units of 1 / frequency of the spheres */
static const double first_turn = .1, longer = 1.1, shorter = .5, less_turn = .99; /* as in the paper */

static double square(const double v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

static void judge(equilibrium *e, const contacts *c)
{
    const powder *p = &powders[POWDERS - 1];
    double largest = 0, sum = 0;
    e->active = 0;
    for (int64_t k = 0; k < c->count; k++) {
        sum += c->force[k];
        e->active += c->force[k] > 0;
    }
    for (int k = 0; k < BED_SPHERES; k++) largest = fmax(largest, sqrt(square(c->F[k])));
    e->mean = e->active ? sum / (double)e->active : 0;
    e->imbalance = e->active ? largest / e->mean : 0;
    e->loaded = e->mean > nothing * p->material.young * p->smallest * p->smallest;
    e->found = e->imbalance <= wanted || !e->loaded;
}

/* A sphere's mass is the stiffness of its contacts, so that all move at the same pace; loose ones get a little, too. */
static void weigh(double *mass, const contacts *c)
{
    double most = 0;
    memset(mass, 0, BED_SPHERES * sizeof *mass);
    for (int64_t k = 0; k < c->count; k++) {
        if (!(c->force[k] > 0)) continue;
        const double stiffness = 1.5 * c->force[k] / (c->overlap[k] + c->nonlocal[k]);
        mass[c->i[k]] += stiffness;
        if (c->j[k] < BED_SPHERES) mass[c->j[k]] += stiffness;
    }
    for (int k = 0; k < BED_SPHERES; k++) most = fmax(most, mass[k]);
    for (int k = 0; k < BED_SPHERES; k++) mass[k] = fmax(mass[k], .02 * most);
}

typedef struct motion {
    double v[BED_SPHERES][3], mass[BED_SPHERES], step, turn;
    int downhill;
} motion;

static void move(motion *m, bed *b, double (*F)[3])
{
    double power = 0, speed = 0, pull = 0; /* the latter two squared, in the metric of the masses */
    for (int k = 0; k < BED_SPHERES; k++) {
        for (int d = 0; d < 3; d++) power += F[k][d] * m->v[k][d];
        speed += m->mass[k] * square(m->v[k]);
        pull += square(F[k]) / m->mass[k];
    }
    if (power > 0) {
        if (++m->downhill > DELAY) {
            m->step = fmin(longer * m->step, longest_step);
            m->turn *= less_turn;
        }
    } else {
        memset(m->v, 0, sizeof m->v);
        m->step *= shorter;
        m->turn = first_turn;
        m->downhill = 0;
        speed = 0;
    }
    const double along = m->turn * sqrt(speed / pull) + m->step;
    for (int k = 0; k < BED_SPHERES; k++)
        for (int d = 0; d < 3; d++) {
            m->v[k][d] = (1 - m->turn) * m->v[k][d] + along * F[k][d] / m->mass[k];
            b->x[k][d] += m->step * m->v[k][d];
        }
}

nlc_status equilibrium_find(equilibrium *e, contacts *c, bed *b)
{
    motion m = {.step = first_step, .turn = first_turn};
    for (e->steps = 0;; e->steps++) {
        const nlc_status status = contacts_solve(c, b);
        if (status < 0) return status;
        judge(e, c);
        if (e->found || e->steps == MOST_STEPS) return NLC_OK;
        if (e->steps % WEIGH == 0) weigh(m.mass, c);
        move(&m, b, c->F);
    }
}
