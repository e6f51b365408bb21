#!/usr/bin/python3
# SPDX-License-Identifier: BSD-2-Clause
"""Derives be and ga of a contact's own displacement on an elastic sphere (lib/sphere_prepare.c), and checks Z, al, be, ga.

Unit sphere, unit force, contact rho <= t, rho = sin psi.  Per area seen along the axis the force is Hertz' p(rho); normal part g,
tangential part chi g tan psi, g cos psi + chi g sin^2 psi / cos psi = p, so g = p (1 + (1/2 - chi) rho^2 + ...).  With
d = div(g rho) in the plane and tau = chi g tan psi, int tau f' = -chi int d f for every f, and the energy is, in units of U/2,
    double integral of  g g' S(h) + 2 chi g d' B(h) + chi^2 d d' K(h),   h^2 = r^2 + (rho^2 - rho'^2)^2 / 4 + ...,
with r the distance in the plane, B the tangential displacement by a normal force, K that by a tangential one, n(n+1) taken out.
S, B, K at small s = h/2: odd powers of s, which give odd powers of t, and
    S = L0 ln s + c0 + L2 s^2 ln s + c2 s^2,   B = Lb0 ln s + Lb2 s^2 ln s + b2 s^2,   K = Lk2 s^2 ln s   (int d = 0).
If the mode is m1/n + m2/n^2 + m3/n^3, then L0 = -m1 and L2 = m3 + m2, from sum P_n/(n+k+1) = -P_k ln s + ... .
The constants appear as C_D, that of D = (lap+2) S - chi (4 S + 2 lap B), alone: lap s^2 = 1 + ..., lap s^2 ln s = ln s + 1 + ...,
lap ln s = -1/2.  In the plane, for rings x > x':  ln r -> ln x,  (x^2-x'^2)^2/r^2 -> x^2 - x'^2,
r^2 ln r -> (x^2 + x'^2) ln x + x'^2.  All are integrals of polynomials in v = (1-x^2)^(1/2) and ln x.

The check sums the modes of the true traction up to n = 2000/t: what Z, al, be and ga leave goes to 0 like t^3.

Usage: sphere_self.py                                needs sympy, mpmath and numpy, takes a minute
"""
import functools

import sympy as sp

nu, n, chi, v = sp.symbols('nu n chi v', positive=True)
R = sp.Rational


def answer(rr, rt):
    """u_r, u_theta of a mode with sigma_rr = rr P_n and sigma_r,theta = rt dP_n/dtheta (sphere_values.py), times 2(2n+1)"""
    A, B = sp.symbols('A B')
    c = sp.solve([-4 * nu * (n + 1) * (2 * n + 3) * A + 2 * (A * (n + 1)**2 * (n - 2 + 4 * nu) + B * n * (n - 1)) - rr,
                  ((n + 5 - 4 * nu) * n + (n + 1) * (n - 2 + 4 * nu)) * A + 2 * (n - 1) * B - rt], [A, B])
    u = A * (n + 1) * (n - 2 + 4 * nu) + B * n, A * (n + 5 - 4 * nu) + B
    return [sp.factor(2 * (2 * n + 1) * f.subs(c)) for f in u]


def logarithms(f):
    """of a mode: coefficients of ln s and of s^2 ln s"""
    e = sp.symbols('e', positive=True)
    m = sp.series(sp.together(f.subs(n, 1 / e)), e, 0, 4).removeO()
    return -m.coeff(e, 1), sp.expand(m.coeff(e, 3) + m.coeff(e, 2))


def cumulated(a):
    """of a density in v, from the centre v = 1"""
    return sp.expand(sp.integrate(sp.expand(a), (v, v, 1)))


def plain(a):
    return sp.integrate(sp.expand(a), (v, 0, 1))


@functools.lru_cache(None)
def log_moment(k):
    """int_0^1 v^k ln(1-v^2)/2 dv"""
    return sp.expand(sp.expand_func((sp.digamma(1) - sp.digamma(R(k + 3, 2))) / (k + 1)) / 2)


def with_log(a):
    return sum(c * log_moment(k[0]) for k, c in sp.Poly(sp.expand(a), v).terms())


X2 = 1 - v**2
P = 3 * v**2                              # densities in v: of the pressure,
D0, D2 = (sp.expand(-sp.diff(3 * w * v, v)) for w in (X2, X2**2))  # of div(p x) and div(x^2 p x)


def ln_r(a, b):
    return sp.expand(with_log(a * cumulated(b) + b * cumulated(a)))


def quotient(a, b):
    f = lambda a, b: plain(a * (X2 * cumulated(b) - cumulated(X2 * b)))
    return f(a, b) + f(b, a)


def r2_ln_r(a, b):
    f = lambda a, b: with_log(a * (X2 * cumulated(b) + cumulated(X2 * b))) + plain(a * cumulated(X2 * b))
    return sp.expand(f(a, b) + f(b, a))


def derive():
    s, b = answer(1, 0)
    back, k = answer(0, 1)
    assert sp.simplify(back - n * (n + 1) * b) == 0  # reciprocity
    (L0, L2), (Lb0, Lb2), (Lk0, Lk2) = logarithms(s), logarithms(b), logarithms(k / (n * (n + 1)))
    assert Lk0 == 0 and ln_r(P, P) == 2 * sp.log(2) - R(7, 4) and ln_r(P, D0) == -R(1, 2)  # those of Z
    ln_t, c0, b2, CD = sp.symbols('ln_t c0 b2 CD')
    c2 = CD - (L2 - L0 / 2 + 2 * c0 - chi * (4 * c0 + 2 * (b2 + Lb2 - Lb0 / 2)))
    L, e, x2, dx2 = ln_t - sp.log(2), R(1, 2) - chi, plain(P * X2), plain(D0 * X2)  # ln s = L + ln r
    total = 2 * e * (L0 * (x2 * L + ln_r(X2 * P, P)) + c0 * x2) + L0 / 8 * quotient(P, P)
    total += (L2 * (2 * x2 * L + r2_ln_r(P, P)) + c2 * 2 * x2) / 4
    total += 2 * chi * Lb0 * (e * ln_r(X2 * P, D0) + e * ln_r(P, D2) + quotient(P, D0) / 8)
    total += 2 * chi * (Lb2 * (dx2 * L + r2_ln_r(P, D0)) + b2 * dx2) / 4
    total += chi**2 * Lk2 * r2_ln_r(D0, D0) / 4
    total = sp.expand(total)
    be, ga = total.coeff(ln_t, 1), total.coeff(ln_t, 0)
    rest = sp.expand(ga - CD / 5 - be * (sp.log(2) - R(93, 40)))
    return sp.factor(be), sp.collect(rest, chi, sp.factor)


def check(be, rest):
    import mpmath as mp
    import numpy as np
    import sphere_values

    def energy(t, nu, chi, reach=2000):
        last = int(reach / t)
        x, w = np.polynomial.legendre.leggauss(int(0.45 * reach) + 200)
        v = (x + 1) / 2
        sine = t * np.sqrt(1 - v * v)
        cosine = np.sqrt(1 - sine**2)
        g = w / 2 * 3 * v * v * cosine / (1 + (chi - 1) * sine**2)
        tau = chi * g * sine / cosine
        k = np.arange(last + 1.0)
        modes = [f(np.where(k < 2, 2, k), nu) for f in (s, b, kk)]
        # n = 0 has no tangential displacement; n = 1 as in sphere_values.py, and the like for shear
        c3 = (1 - 2 * nu) / (4 * (1 + nu))
        for f, zero, one in zip(modes, ((1 - 2 * nu) / (1 + nu), 0, 0), (7.2 * c3, -4.8 * c3, 3 * (3 - 4 * nu / (1 + nu)) / 5)):
            f[0], f[1] = zero, one
        p, q, total, tail = np.ones_like(v), cosine.copy(), modes[0][0] * g.sum()**2, 0
        for j in range(1, last + 1):
            G, D = g @ q, -(tau * j * (cosine * q - p) / sine).sum()
            term = modes[0][j] * G * G + 2 * modes[1][j] * G * D + modes[2][j] * D * D
            total += term
            if j > last // 2:
                tail += term * float(j)**4
            p, q = q, ((2 * j + 1) * cosine * q - j * p) / (j + 1)
        return total + tail / (last - last // 2) / (3 * (last + 0.5)**3)

    s, b = (sp.lambdify((n, nu), f) for f in answer(1, 0))
    kk = sp.lambdify((n, nu), answer(0, 1)[1] / (n * (n + 1)))
    print('\nwhat is left of Sbar, divided by t^3')
    for x in (0.0, 0.3, 0.5):
        for y in (1.0, 0.0, 2.0):
            left = []
            for t in (0.05, 0.1, 0.2):
                expansion = sphere_values.self_values(mp.mpf(t), mp.mpf(x), mp.mpf(y))[1]
                left.append((energy(t, x, y) - 12 * np.pi * (1 - x) / (5 * t) - float(expansion)) / t**3)
            print('nu %.1f  chi %.0f ' % (x, y), ' '.join('%9.5f' % v for v in left))


def main():
    be, rest = derive()
    print('be =', be)
    print('ga = C_D/5 + be (ln 2 - 93/40) +', rest)
    check(be, rest)


if __name__ == '__main__':
    main()
