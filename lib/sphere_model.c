/* SPDX-License-Identifier: BSD-2-Clause */
/* sphere_model.c - the exact sphere as rows of the table of models: to second order, and point forces alone. */
#include "model.h"

void nlc_sphere_model_prepare(nlc_kernel *kernel, double poisson, double prefactor)
{
    (void)prefactor;
    kernel->poisson = poisson;
    nlc_sphere_prepare(&kernel->sphere, poisson, 1);
}

/* ln t, t2 = t^2; of t = 0 a number that is large enough */
static double log_of(double t2)
{
    return nlc_half_log(t2 > 1e-290 ? t2 : 1e-290);
}

/* The constants are those of chi = 1: what of them depends on chi is the one without t, and al (sphere_prepare.c). */
nlc_self nlc_sphere_model_self(const nlc_kernel *kernel, double t2, double chi)
{
    const nlc_sphere_constants *k = &kernel->sphere;
    const double nu = kernel->poisson, more = chi - 1, t = sqrt(t2), L = log_of(t2), pi = 3.14159265358979323846;
    const double z = -2 * (1 - 2 * nu) * more;
    const double al = pi * more * ((1 - nu) * (12 / 35. * (chi + 1) - 12 / 7.) + 9 / 35. * (2 + nu * (6 - 8 * nu)));
    const double *c = k->self, *l = k->self_log, *e = k->energy, *m = k->energy_log;
    const double c0 = c[0] + z, c1 = c[1] + 7 / 6. * al;
    return (nlc_self){
        c0 + l[0] * L + t * (c1 + t * (c[2] + l[1] * L)),
        c0 + l[0] * (L + 1 / 3.) + t * (4 / 3. * c1 + t * (5 / 3. * (c[2] + l[1] * L) + l[1] / 3)),
        e[0] + z + m[0] * L + t * (e[1] + al + t * (e[2] + m[1] * L)),
    };
}
