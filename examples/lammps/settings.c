/* SPDX-License-Identifier: BSD-2-Clause */
/* settings.c - what the script says, in variables whose names begin with nlc_. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "host.h"

/* A variable of any style that LAMMPS can make a number of; false if there is none of that name. */
static bool number(const host *h, const char *name, double *value)
{
    char formula[2 * NAME];
    double *found;
    if (!lammps_has_id(h->lammps, "variable", name)) return false;
    snprintf(formula, sizeof formula, "variable nlc_number equal v_%s", name);
    lammps_command(h->lammps, formula);
    found = lammps_extract_variable(h->lammps, "nlc_number", NULL);
    if (!found) host_fail("variable %s is no number", name);
    *value = *found;
    lammps_free(found);
    lammps_command(h->lammps, "variable nlc_number delete");
    return true;
}

static double number_or(const host *h, const char *name, double otherwise)
{
    number(h, name, &otherwise);
    return otherwise;
}

/* A string- or index-style variable; LAMMPS keeps it. */
static const char *text_or(const host *h, const char *name, const char *otherwise)
{
    return lammps_has_id(h->lammps, "variable", name) ? lammps_extract_variable(h->lammps, name, NULL) : otherwise;
}

static void read_options(host *h)
{
    const char *model = text_or(h, "nlc_model", "gonzalez-cuitino");
    nlc_options *o = &h->set.options;
    o->struct_size = sizeof *o;
    o->model = nlc_model_find(model);
    if (o->model < 0) host_fail("there is no model '%s'", model);
    o->tolerance = number_or(h, "nlc_tolerance", 1e-6);
    o->prefactor = number_or(h, "nlc_prefactor", 1);
    o->max_sweeps = (int64_t)number_or(h, "nlc_max_sweeps", 0);
    o->points = number_or(h, "nlc_undeformed", 0) > 0 ? NLC_POINTS_UNDEFORMED : NLC_POINTS_DEFORMED;
    h->set.predict = number_or(h, "nlc_predict", 1) > 0;
    h->set.turning = number_or(h, "nlc_turning", 0) > 0;
    h->set.interval = (int64_t)number_or(h, "nlc_interval", 1);
    h->set.every = (int64_t)number_or(h, "nlc_every", 0);
    if (h->set.every < 0 || h->set.interval < 1) host_fail("nlc_every is negative, or nlc_interval not positive");
    snprintf(h->set.file, sizeof h->set.file, "%s", text_or(h, "nlc_contacts", ""));
}

/* nlc_young and nlc_poisson for all types, or nlc_young_2 ... for one; walls are rigid unless nlc_wall_young says otherwise. */
static void read_materials(host *h)
{
    const nlc_material all = {number_or(h, "nlc_young", 0), number_or(h, "nlc_poisson", 0)};
    const nlc_material wall = {number_or(h, "nlc_wall_young", INFINITY), number_or(h, "nlc_wall_poisson", 0)};
    settings *s = &h->set;
    s->types = (int32_t)lammps_extract_setting(h->lammps, "ntypes");
    s->material = host_room(NULL, (size_t)(s->types + 2) * sizeof *s->material);
    s->material[0] = all;
    for (int32_t type = 1; type <= s->types; type++) {
        char young[NAME], poisson[NAME];
        snprintf(young, sizeof young, "nlc_young_%d", (int)type);
        snprintf(poisson, sizeof poisson, "nlc_poisson_%d", (int)type);
        s->material[type] = (nlc_material){number_or(h, young, all.young), number_or(h, poisson, all.poisson)};
        if (!(s->material[type].young > 0)) host_fail("type %d has no modulus: variable nlc_young or %s", (int)type, young);
    }
    s->material[s->types + 1] = wall;
}

static void read_walls(host *h)
{
    static const char *const names[WALLS] = {"nlc_xlo", "nlc_xhi", "nlc_ylo", "nlc_yhi", "nlc_zlo", "nlc_zhi"};
    settings *s = &h->set;
    for (int k = 0; k < WALLS; k++) {
        char formula[2 * NAME];
        if (!lammps_has_id(h->lammps, "variable", names[k])) continue;
        snprintf(s->wall_name[s->walls], NAME, "nlc_at_%d", s->walls); /* equal-style whatever the other one is */
        snprintf(formula, sizeof formula, "variable %s equal v_%s", s->wall_name[s->walls], names[k]);
        lammps_command(h->lammps, formula);
        s->wall_normal[3 * s->walls + k / 2] = k % 2 ? -1 : 1;
        s->wall_material[s->walls++] = s->types + 1;
    }
}

/* LAMMPS computes it anew for this time step. */
void settings_walls(host *h)
{
    for (int w = 0; w < h->set.walls; w++) {
        char *name = h->set.wall_name[w];
        double *at = lammps_extract_variable(h->lammps, name, NULL);
        if (!at) host_fail("variable %s is gone", name);
        for (int k = 0; k < 3; k++) h->wall_point[3 * w + k] = fabs(h->set.wall_normal[3 * w + k]) * *at;
        lammps_free(at);
    }
}

/*
 * Candidates have a gap below reach and 2 slack.  LAMMPS lists what is nearer than the cutoff of its pair style zero, always;
 * its skin says only how often it has to make that list.
 */
static void set_reach(host *h)
{
    const int32_t owned = (int32_t)lammps_extract_setting(h->lammps, "nlocal");
    const double *radius = lammps_extract_atom(h->lammps, "radius");
    double largest = 0;
    char command[NAME];
    if (!radius) host_fail("atoms have no radius: use atom_style sphere");
    for (int32_t k = 0; k < owned; k++) largest = fmax(largest, radius[k]);
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, h->ranks.world);
    h->set.reach = number_or(h, "nlc_reach", 0.3 * largest);
    h->set.slack = number_or(h, "nlc_slack", 0.05 * largest);
    if (!(h->set.reach >= 0 && h->set.slack > 0)) host_fail("nlc_reach is negative, or nlc_slack not positive");
    snprintf(command, sizeof command, "pair_coeff * * zero %.17g", 2 * largest + h->set.reach + 2 * h->set.slack);
    lammps_command(h->lammps, command);
    snprintf(command, sizeof command, "neighbor %.17g bin", number_or(h, "nlc_skin", 4 * h->set.slack));
    lammps_command(h->lammps, command);
}

void settings_read(host *h)
{
    if (lammps_extract_setting(h->lammps, "newton_pair") > 0) host_fail("use newton off");
    read_options(h);
    read_materials(h);
    read_walls(h);
    set_reach(h);
}
