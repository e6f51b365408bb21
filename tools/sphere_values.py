#!/usr/bin/python3
# SPDX-License-Identifier: BSD-2-Clause
"""Makes tests/sphere_values.h: the elastic sphere's functions to the last digit, from their definitions.

S and D are summed mode by mode.  Each mode comes from the solution of the equations of elasticity in the sphere,
    u_r = [A (n+1)(n-2+4nu) r^(n+1) + B n r^(n-1)] P_n,   u_theta = [A (n+5-4nu) r^(n+1) + B r^(n-1)] dP_n/dtheta,
with A and B from sigma_rr = P_n, sigma_r,theta = 0 at r = 1, two equations that are solved for each n; n = 1 from the problem
with uniform body force.  The sums diverge or converge slowly: every multiplication by 1 - cos theta, by the recurrence of
Legendre's polynomials, makes their terms smaller by n^2.

Usage: sphere_values.py > tests/sphere_values.h       needs mpmath, takes a minute
"""
import mpmath as mp

mp.mp.dps = 100
STEPS = 14  # multiplications by 1 - cos theta


def mode(n, nu):
    """u_r and u_theta at the surface, times 2n+1, in the units of S: r = mu = 1, factor 2"""
    if n == 0:
        return (1 - 2 * nu) / (1 + nu), mp.mpf(0)
    if n == 1:  # u_r = c1 + c3 r^2, u_theta = c1 - c3 r^2, no shear; sigma_rr = 1; no displacement of the centre of mass
        c3 = (1 - 2 * nu) / (4 * (1 + nu))
        c1 = c3 / 5
        return 6 * (c1 + c3), 6 * (c1 - c3)
    rrA, rrB = -4 * nu * (n + 1) * (2 * n + 3) + 2 * (n + 1)**2 * (n - 2 + 4 * nu), 2 * n * (n - 1)
    rtA, rtB = (n + 5 - 4 * nu) * n + (n + 1) * (n - 2 + 4 * nu), 2 * n - 2
    A = 1 / (rrA - rrB * rtA / rtB)
    B = -A * rtA / rtB
    factor = 2 * (2 * n + 1)
    return factor * (A * (n + 1) * (n - 2 + 4 * nu) + B * n), factor * (A * (n + 5 - 4 * nu) + B)


def multiply(c):
    """coefficients of (1 - cos theta) sum c_n P_n; the last is lost"""
    n = range(len(c) - 1)
    return [c[k] - (c[k - 1] * k / mp.mpf(2 * k - 1) if k else 0) - c[k + 1] * (k + 1) / mp.mpf(2 * k + 3) for k in n]


def legendre_sum(c, x):
    """sum c_n P_n(x), c multiplied STEPS times"""
    total, p, q = mp.mpf(0), mp.mpf(1), x
    for n, v in enumerate(c):
        total += v * p
        p, q = q, ((2 * n + 3) * x * q - (n + 1) * p) / (n + 2)
    return total / (1 - x)**STEPS


def constants(nu, chi):
    """C0 of S and C_D of D by the digamma function: sum (b n + g)/N_n P_n = -b ln s + constant"""
    r = mp.mpc(-mp.mpf(1) / 2 - nu, mp.sqrt(mp.mpf(3) / 4 - nu * nu))
    constant = lambda b, g: -2 * ((b * r + g) / (r - mp.conj(r)) * mp.digamma(-r)).real + b * mp.digamma(1)
    b, g = 1 - 8 * nu + 8 * nu**2, -(2 + nu - 4 * nu**2)
    C0 = -4 * (1 - nu) - 1 + constant(b, g) - (b + g) / (3 * (1 + nu)) + mode(1, nu)[0]
    # D without n = 1 is A n^2 + B n + C + (b n + g)/N_n, found from five of its modes
    D = lambda n: (2 - n * (n + 1)) * mode(n, nu)[0] - chi * (4 * mode(n, nu)[0] - 2 * n * (n + 1) * mode(n, nu)[1])
    N = lambda n: n**2 + (1 + 2 * nu) * n + 1 + nu
    some = [2, 3, 5, 8, 13]
    A, B, C, b, g = mp.lu_solve(mp.matrix([[n * n, n, 1, n / N(n), 1 / N(n)] for n in some]), mp.matrix([D(n) for n in some]))
    return C0, constant(b, g) + D(1) - (A + B + C + (b + g) / N(1)), -b


def self_values(t, nu, chi):
    C0, CD, log_D = constants(nu, chi)
    L = mp.log(t)
    Z = C0 - 2 * (1 - 2 * nu)**2 * (L + mp.log(2) - mp.mpf(19) / 12) - 2 * (1 - 2 * nu) * chi
    q = lambda a, b: mp.mpf(a) / b
    al = mp.pi * ((1 - nu) * (-q(6, 7) * (2 * chi - 1) - q(9, 70) + q(12, 35) * chi**2) +
                  q(9, 35) * ((1 - nu) * (1 - 16 * nu**2) + chi * (2 + 6 * nu - 8 * nu**2)))
    be = log_D / 5
    ga = (CD / 5 + be * (mp.log(2) - q(93, 40)) - q(33, 40) * (1 - 2 * nu)**2 -
          chi * (64 * nu**3 - 136 * nu**2 + 14 * nu + 25) / 20 + chi**2 * (1 - 2 * nu) * (16 - 5 * nu) / 10)
    return (Z + q(7, 6) * al * t + (q(4, 3) * be * L + be / 6 + q(4, 3) * ga) * t**2,
            Z + (1 - 2 * nu)**2 / 3 + al * t + (be * L + ga) * t**2)


def row(*values):
    print('    {' + ', '.join(float(v).hex() for v in values) + '},')


def main():
    print('/* SPDX-License-Identifier: BSD-2-Clause */')
    print('/* sphere_values.h - made by tools/sphere_values.py, which says how. */')
    print('/* nu, theta, S, D at chi = 0, D at chi = 1 */\nstatic const double exact_pairs[][5] = {')
    poissons = [0.0, 0.1, 0.25, 0.3, 0.37, 0.46, 0.5]
    for nu in poissons:
        n = mp.mpf(nu)
        modes = [mode(k, n) for k in range(6000 + STEPS)]
        D = lambda k, chi: (2 - k * (k + 1)) * modes[k][0] - chi * (4 * modes[k][0] - 2 * k * (k + 1) * modes[k][1])
        series = [[m[0] for m in modes], [D(k, 0) for k in range(len(modes))], [D(k, 1) for k in range(len(modes))]]
        for _ in range(STEPS):
            series = [multiply(c) for c in series]
        for theta in [0.02, 0.11, 0.3, 0.625, float(mp.pi / 3), 1.3, float(mp.pi / 2), 1.9, 2.4, 3.0, float(mp.pi)]:
            terms = int(min(6000, 120 / theta + 300))
            x = mp.cos(mp.mpf(theta))
            row(nu, theta, *[legendre_sum(c[:terms], x) for c in series])
    print('};\n\n/* nu, chi, t, S1, Sbar */\nstatic const double exact_self[][5] = {')
    for nu in poissons:
        for chi in [0.0, 0.7, 1.0, 2.5]:
            for t in [1e-300, 1e-5, 0.1, 0.3]:
                row(nu, chi, t, *self_values(mp.mpf(t), mp.mpf(nu), mp.mpf(chi)))
    print('};')


if __name__ == '__main__':
    main()
