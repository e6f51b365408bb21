/* SPDX-License-Identifier: BSD-2-Clause */
/* sphere_model.c - the exact sphere as rows of the table of models: what is prepared for a material, and self terms. */
#include "model.h"

/* The quadratic through the values at chi - 1 = -1, 0 and 1. */
static void quadratic(double c[3], double below, double at, double above)
{
    c[0] = at;
    c[1] = 0.5 * (above - below);
    c[2] = 0.5 * (above + below) - at;
}

void nlc_sphere_model_prepare(nlc_kernel *kernel, double poisson, double prefactor)
{
    nlc_sphere_constants k[3];
    nlc_sphere_quadratic *q = &kernel->self;
    (void)prefactor;
    kernel->poisson = poisson;
    for (int chi = 0; chi < 3; chi++) nlc_sphere_prepare(&k[chi], poisson, chi);
    kernel->sphere = k[1];
    kernel->tilted.pole = k[1].d.pole - k[0].d.pole;
    kernel->tilted.pole3 = k[1].d.pole3 - k[0].d.pole3;
    for (int i = 0; i < NLC_SPHERE_LOG; i++) kernel->tilted.log[i] = k[1].d.log[i] - k[0].d.log[i];
    for (int i = 0; i < NLC_SPHERE_SMOOTH; i++) kernel->tilted.smooth[i] = k[1].d.smooth[i] - k[0].d.smooth[i];
    for (int i = 0; i < 3; i++) {
        quadratic(q->self[i], k[0].self[i], k[1].self[i], k[2].self[i]);
        quadratic(q->energy[i], k[0].energy[i], k[1].energy[i], k[2].energy[i]);
    }
    for (int i = 0; i < 2; i++) {
        quadratic(q->self_log[i], k[0].self_log[i], k[1].self_log[i], k[2].self_log[i]);
        quadratic(q->energy_log[i], k[0].energy_log[i], k[1].energy_log[i], k[2].energy_log[i]);
    }
}

static double at(const double c[3], double tilt)
{
    return c[0] + tilt * (c[1] + tilt * c[2]);
}

/* With L = ln t: c0 + l0 L + c1 t + (c2 + l1 L) t^2; its derivative times t/3 is added for the slope. */
nlc_self nlc_sphere_model_self(const nlc_kernel *kernel, double t2, double tilt)
{
    const nlc_sphere_quadratic *q = &kernel->self;
    const double t = sqrt(t2), L = nlc_half_log(t2 > 1e-290 ? t2 : 1e-290);
    const double l0 = at(q->self_log[0], tilt), l1 = at(q->self_log[1], tilt);
    const double c0 = at(q->self[0], tilt), c1 = at(q->self[1], tilt), c2 = at(q->self[2], tilt) + l1 * L;
    return (nlc_self){
        c0 + l0 * L + t * (c1 + t * c2),
        c0 + l0 * (L + 1 / 3.) + t * (4 / 3. * c1 + t * (5 / 3. * c2 + l1 / 3)),
        at(q->energy[0], tilt) + at(q->energy_log[0], tilt) * L +
            t * (at(q->energy[1], tilt) + t * (at(q->energy[2], tilt) + at(q->energy_log[1], tilt) * L)),
    };
}

/* Derivative by t of one of the series of sphere.h, h = t^(1/2). */
static double slope_of(const nlc_sphere_series *k, bool cubic, double t)
{
    const double h = sqrt(t), r = 1 / h, y = h - 1;
    double log = 0, log_slope = 0, slope = 0;
    for (int i = NLC_SPHERE_LOG - 1; i >= 0; i--) {
        log_slope = log_slope * t + log;
        log = log * t + k->log[i];
    }
    for (int i = NLC_SPHERE_SMOOTH - 1; i > 0; i--) slope = slope * y + i * k->smooth[i];
    const double poles = -0.5 * r * r * r * (k->pole + (cubic ? 3 * r * r * k->pole3 : 0));
    return poles + 0.5 * r * r * log + nlc_half_log(t) * log_slope + 0.5 * r * slope;
}

/* The coefficient in the energy is -(S + moment D + tilted E), see sphere_block.c. */
double nlc_sphere_turning(const nlc_kernel *kernel, double t, double moment, double tilted)
{
    return -(slope_of(&kernel->sphere.s, false, t) + moment * slope_of(&kernel->sphere.d, true, t) + tilted * slope_of(&kernel->tilted, true, t));
}
