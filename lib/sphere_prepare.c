/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * sphere_prepare.c - the constants of the elastic sphere for one Poisson's ratio.
 *
 * Modes.  A normal traction p P_n(cos theta) moves the surface by u_r = a_n P_n inwards; a point force P is the sum of the
 * tractions (2n+1) P_n P/(4 pi R^2).  In units of U = P/(8 pi mu R), with N_n = n^2 + (1+2nu) n + 1+nu,
 *     s_n = (2n+1) [2(1-nu) n^2 + nu n - (1-2nu)] / [(n-1) N_n] = 4(1-nu) + 1/(n-1) + (b n + g) / N_n,   n != 1,
 *     b = 1 - 8nu + 8nu^2,   g = -(2 + nu - 4nu^2);      s_1 = 9(1-2nu) / (5(1+nu)):
 * n = 1 is a rigid translation together with what the sphere's own inertia or weight does to it, if displacements are those
 * relative to the centre of mass.  S = sum s_n P_n.  With s = h/2 and x = cos theta = 1 - h^2/2, over n >= 0:
 *     sum P_n = 1/h,   sum n P_n = -1/(2h),   sum n(n+1) P_n = -(4/h^2 + 1) / (4h),
 *     sum_{n != 1} P_n/(n-1) = -1 + 2s^2 - 2s - x ln(s (1+s)),   Q(b,g) = sum (b n + g)/N_n P_n = b F1 + g F0 (sphere_table.h).
 */
#include "sphere.h"

#include "sphere_table.h"

static const double ln2 = 0x1.62e42fefa39efp-1, pi = 3.14159265358979323846;

static double polynomial(const double *c, int n, double x)
{
    double y = c[n - 1];
    for (int j = n - 2; j >= 0; j--) y = y * x + c[j];
    return y;
}

/* f += c0 + c1 cos theta; x = 1/2 - y - y^2/2 with y = h - 1 */
static void add_cosine(nlc_sphere_series *f, double c0, double c1)
{
    f->smooth[0] += c0 + c1 / 2;
    f->smooth[1] -= c1;
    f->smooth[2] -= c1 / 2;
}

/* f += Q(b, g) */
static void add_sums(nlc_sphere_series *f, double nu, double b, double g)
{
    double q[NLC_SPHERE_LOG + NLC_SPHERE_SMOOTH];
    for (int k = 0; k < NLC_SPHERE_LOG + NLC_SPHERE_SMOOTH; k++)
        q[k] = (b * polynomial(sphere_f1[k], NLC_SPHERE_NU, 4 * nu - 1) +
                g * polynomial(sphere_f0[k], NLC_SPHERE_NU, 4 * nu - 1)) /
               (1 + nu);
    for (int k = 0; k < NLC_SPHERE_LOG; k++) f->log[k] += q[k];
    for (int k = 0; k < NLC_SPHERE_SMOOTH; k++) f->smooth[k] += q[NLC_SPHERE_LOG + k];
}

/* f += sum over n != 1 of [A n(n+1) + B n + C + (b n + g)/N_n] P_n, and first cos theta */
static void add_modes(nlc_sphere_series *f, double nu, const double mode[5], double first)
{
    const double A = mode[0], B = mode[1], C = mode[2], b = mode[3], g = mode[4];
    f->pole3 -= A;
    f->pole += C - B / 2 - A / 4;
    add_sums(f, nu, b, g);
    add_cosine(f, 0, first - (2 * A + B + C + (b + g) / (3 + 3 * nu)));
}

static void prepare_s(nlc_sphere_series *f, double nu)
{
    const double b = 1 + 8 * nu * (nu - 1), g = nu * (4 * nu - 1) - 2;
    const double mode[5] = {0, 0, 4 * (1 - nu), b, g};
    add_modes(f, nu, mode, 9 * (1 - 2 * nu) / (5 * (1 + nu)));
    /* sum P_n/(n-1) = -x - h - x (ln h - ln 2) - x ln(1+s) */
    add_cosine(f, -1, ln2 - 1);
    f->smooth[1] -= 1;
    f->log[0] -= 1;
    f->log[1] += 0.5;
    for (int k = 0; k < NLC_SPHERE_LOG; k++) f->log[k] -= sphere_g[k];
    for (int k = 0; k < NLC_SPHERE_SMOOTH; k++) f->smooth[k] -= sphere_g[NLC_SPHERE_LOG + k];
}

/*
 * D = (lap + 2) S - chi (4 S + 2 lap B), lap: surface Laplacian, B: the series of tangential displacement; linear in chi.
 * At chi = 0 the mode is (2 - n(n+1)) s_n, at chi = 1 it is given by five polynomials in nu and d_1 = -12(1-2nu)/(1+nu).
 */
static void prepare_d(nlc_sphere_series *f, double nu, double chi)
{
    const double m = 1 - nu, b = 1 + 8 * nu * (nu - 1), g = nu * (4 * nu - 1) - 2;
    const double normal[5] = {-4 * m, -(1 + b), 8 * m - 2 - g + 2 * nu * b,
                              2 * nu * g + (1 + nu) * b - 2 * nu * b * (1 + 2 * nu) + 2 * b,
                              (1 + nu) * (g - 2 * nu * b) + 2 * g};
    const double cubic = nu * (nu * (16 * nu - 36) + 27) - 6, square = 16 * nu * nu - 8 * nu - 5;
    const double A = -4 * m, B = -2 * (4 * nu * nu - 10 * nu + 5);
    const double tilted[5] = {A, B - A, cubic, -m * (1 - 2 * nu) * square, m * (nu * (nu * (16 * nu - 4) - 13) + 4)};
    double mode[5];
    for (int k = 0; k < 5; k++) mode[k] = normal[k] + chi * (tilted[k] - normal[k]);
    add_modes(f, nu, mode, -12 * (1 - 2 * nu) / (1 + nu) * chi);
}

/* The function's constant at h = 0 if singular terms are written with ln s. */
static double constant(const nlc_sphere_series *f)
{
    return polynomial(f->smooth, NLC_SPHERE_SMOOTH, -1) + f->log[0] * ln2;
}

/*
 * Energy 2W = U P^2 Sbar of a contact's own force, beyond 12 pi (1-nu)/(5t) of a half-space, to order t^2; S1 = Sbar + (t/6)
 * dSbar/dt.  The pressure is Hertz' per area seen along the axis, its tangential part chi tan(psi) of the normal one.  Terms
 * of even order come from the logarithms and constants of S, B and the tangential answer to tangential traction: be is a fifth
 * of D's logarithm, ga a fifth of D's constant and what the moments of the logarithms add, tools/sphere_self.py.
 */
static void prepare_self(nlc_sphere_constants *k, double nu, double chi)
{
    const double m = 1 - nu, c = 1 - 2 * nu;
    const double z = constant(&k->s) - 2 * c * c * (ln2 - 19 / 12.) - 2 * c * chi;
    const double al = pi * (m * (-6 / 7. * (2 * chi - 1) - 9 / 70. + 12 / 35. * chi * chi) +
                            9 / 35. * (m * (1 - 16 * nu * nu) + chi * (2 + 6 * nu - 8 * nu * nu)));
    const double be = k->d.log[0] / 5;
    const double ga = constant(&k->d) / 5 + be * (ln2 - 93 / 40.) - 33 / 40. * c * c -
                      chi * (25 + nu * (14 + nu * (64 * nu - 136))) / 20 + chi * chi * c * (16 - 5 * nu) / 10;
    k->energy[0] = z + c * c / 3;
    k->energy[1] = al;
    k->energy[2] = ga;
    k->energy_log[0] = -2 * c * c;
    k->energy_log[1] = be;
    k->self[0] = z;
    k->self[1] = 7 * al / 6;
    k->self[2] = (8 * ga + be) / 6;
    k->self_log[0] = -2 * c * c;
    k->self_log[1] = 4 * be / 3;
}

void nlc_sphere_prepare(nlc_sphere_constants *k, double poisson, double chi)
{
    memset(k, 0, sizeof *k);
    prepare_s(&k->s, poisson);
    prepare_d(&k->d, poisson, chi);
    prepare_self(k, poisson, chi);
}
