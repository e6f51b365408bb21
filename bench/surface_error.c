/* SPDX-License-Identifier: BSD-2-Clause */
/* surface_error.c - displacement of a sphere's surface beside one contact, a/R = 0.233 as in [GC] Fig. A2. */
#include "surface_error.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "nlcontact.h"

#define CIRCLE 0.233 /* a/R */
#define FROM 30.0    /* degrees */
enum { POINTS = 181, LINE = 200 };

static const double pi = 3.14159265358979323846;

typedef struct curve {
    double nu;
    int count;
    double theta[POINTS], exact[POINTS];
} curve;

/* Outward displacements by P = 1 on a sphere with R = E = 1. */
static double case_one(double theta, double nu)
{
    return nlc_nonlocal_displacement(1, theta, 1, 1, nu);
}

static double case_two(double theta, double nu)
{
    return nlc_love_nonlocal_displacement(1, CIRCLE, theta, 1, 1, nu);
}

static double point_force(double theta, double nu)
{
    return nlc_sphere_displacement(1, theta, 1, 1, nu);
}

static double second_order(double theta, double nu)
{
    const double U = (1 + nu) / (4 * pi);
    return point_force(theta, nu) - U * CIRCLE * CIRCLE / 10 * nlc_sphere_finite_size(theta, nu, 1);
}

static const struct {
    const char *name;
    double (*displacement)(double theta, double nu);
} models[] = {{"gonzalez-cuitino", case_one}, {"love", case_two}, {"point-force", point_force}, {"sphere", second_order}};
enum { MODELS = sizeof models / sizeof models[0] };

/* Worst difference relative to the largest displacement, after the fit of k cos(theta) by least squares. */
static double error_of(const curve *c, int m)
{
    double up = 0, down = 0, worst = 0, largest = 0;
    for (int k = 0; k < c->count; k++) {
        const double x = cos(c->theta[k]);
        up += x * (c->exact[k] - models[m].displacement(c->theta[k], c->nu));
        down += x * x;
    }
    for (int k = 0; k < c->count; k++) {
        const double fitted = models[m].displacement(c->theta[k], c->nu) + up / down * cos(c->theta[k]);
        worst = fmax(worst, fabs(fitted - c->exact[k]));
        largest = fmax(largest, fabs(c->exact[k]));
    }
    return worst / largest;
}

static void print_curve(const curve *c)
{
    if (c->count == 0) return;
    printf("  nu %-22g", c->nu);
    for (int m = 0; m < MODELS; m++) printf(" %17.2f", 100 * error_of(c, m));
    putchar('\n');
}

int surface_error_print(const char *path)
{
    char line[LINE];
    curve c = {.nu = -1};
    FILE *in = fopen(path, "r");
    if (!in) {
        fprintf(stderr, "accuracy: %s: cannot be opened\n", path);
        return -1;
    }
    printf("\n%-27s", "SURFACE beside one contact");
    for (int m = 0; m < MODELS; m++) printf(" %17s", models[m].name);
    printf("\n  a/R = %g, from %g degrees: worst error in %% of the largest displacement there\n", CIRCLE, FROM);
    while (fgets(line, sizeof line, in)) {
        double nu, theta, displacement;
        if (sscanf(line, "%lf,%lf,%lf", &nu, &theta, &displacement) != 3 || theta < FROM) continue;
        if (fabs(nu - c.nu) > 1e-9) {
            print_curve(&c);
            c.nu = nu;
            c.count = 0;
        }
        if (c.count == POINTS) break;
        c.theta[c.count] = fmin(theta * pi / 180, pi);
        c.exact[c.count++] = displacement;
    }
    print_curve(&c);
    fclose(in);
    return 0;
}
