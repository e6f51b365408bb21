#!/usr/bin/python3
# SPDX-License-Identifier: BSD-2-Clause
"""Makes lib/sphere_table.h: the Legendre sums of the elastic sphere as short expressions in h = 2 sin(theta/2) and nu.

    F0 = sum P_n(cos theta) / N_n,   F1 = sum n P_n(cos theta) / N_n,   N_n = n^2 + (1+2nu) n + 1+nu,   n = 0, 1, 2, ...

At h -> 0, F0 is finite and F1 = -ln(h/2) + a constant + ...; both are  (even series) + h (even series) + ln h (even series).
So each is taken as  p(h-1) + ln h r(h^2)  with polynomials p of degree N and r of degree M, and so is G = cos theta ln(1 + h/2).
r(0) and p at h = 0 are those of the function.  The other coefficients come from least squares at Chebyshev points of h, weighted
by h, since what the sums are added to grows like 1/h.  That is a linear map of the function, the same one for every nu, so
that (1+nu) F0 and (1+nu) F1 give coefficients which are analytic in nu up to the pole at -7/5: polynomials of degree J in
4 nu - 1 by interpolation at Chebyshev points.  (The factor takes away the poles at -1, from n = 0 and 1.)

Usage: sphere_table.py > lib/sphere_table.h           needs mpmath, takes ten seconds
"""
import mpmath as mp

M, N, J = 4, 12, 11
POINTS = 64
mp.mp.dps = 36


def gauss(n=70):
    x, w = [], []
    for i in range(n):
        t = mp.cos(mp.pi * (i + mp.mpf(3) / 4) / (n + mp.mpf(1) / 2))
        for _ in range(8):
            p, q = mp.mpf(1), t
            for k in range(2, n + 1):
                p, q = q, ((2 * k - 1) * t * q - (k - 1) * p) / k
            slope = n * (t * q - p) / (t * t - 1)
            t -= q / slope
        x.append(t)
        w.append(2 / ((1 - t * t) * slope * slope))
    return x, w


GAUSS = gauss()


def one_pole(a, s):
    """sum P_n/(n+a) = int_0^1 t^(a-1) / sqrt(1 - 2 t cos theta + t^2) dt: a power series up to 1/2, quadrature beyond"""
    c, half = 1 - 2 * s * s, mp.mpf(1) / 2
    total, power, p, q = mp.mpc(0), half**a, mp.mpf(1), c
    for n in range(int(3.4 * mp.mp.dps)):
        total += power * p / (n + a)
        power, p, q = power / 2, q, ((2 * n + 3) * c * q - (n + 1) * p) / (n + 2)
    if c < -half:
        low, high, parts = half, mp.mpf(1), 1
        f = lambda t: t**(a - 1) / mp.sqrt(1 - 2 * t * c + t * t)
    else:  # t = cos theta + sin theta sinh u takes the near singularity away
        sine = 2 * s * mp.sqrt(1 - s * s)
        low, high = mp.asinh((half - c) / sine), mp.asinh((1 - c) / sine)
        parts = 3 + int(high - low)
        f = lambda u: (c + sine * mp.sinh(u))**(a - 1)
    step = (high - low) / (2 * parts)
    return total + step * sum(w * f(low + step * (2 * k + 1 + x)) for k in range(parts) for x, w in zip(*GAUSS))


def roots(nu):
    """n^2 + (1+2nu) n + 1+nu = (n - r)(n - conj r)"""
    return mp.mpc(-mp.mpf(1) / 2 - nu, mp.sqrt(mp.mpf(3) / 4 - nu * nu))


def sums(nu, s):
    r = roots(nu)
    z = one_pole(-r, s) / (r - mp.conj(r))
    return 2 * z.real, 2 * (r * z).real


def at_zero(nu):
    """F0 and F1 + ln h at h = 0: sum (b n + g)/N_n - b/(n+1) by the digamma function, and sum P_n/(n+1) = ln(1 + 2/h)"""
    r = roots(nu)
    psi = mp.digamma(-r) / (r - mp.conj(r))
    return -2 * psi.real, -2 * (r * psi).real + mp.digamma(1) + mp.log(2)


def powers_of(T, n):
    """Chebyshev coefficients -> coefficients of powers"""
    a, b, out = [mp.mpf(1)], [mp.mpf(0), mp.mpf(1)], [mp.mpf(0)] * (n + 1)
    for j in range(n + 1):
        for k, v in enumerate(a):
            out[k] += T[j] * v
        a, b = b, [2 * (b[k - 1] if k else 0) - (a[k] if k < len(a) else 0) for k in range(len(b) + 1)]
    return out


class Fit:
    def __init__(self):
        self.s = [(1 - mp.cos(mp.pi * (k + mp.mpf(1) / 2) / POINTS)) / 2 for k in range(POINTS)]
        rows = []
        for s in self.s:
            h, phi = 2 * s, mp.acos(2 * s - 1)
            rows.append([s * mp.log(h) * (h * h)**k for k in range(1, M + 1)] +
                        [s * (mp.cos(j * phi) - (-1)**j) for j in range(1, N + 1)])
        self.q, self.r = mp.qr(mp.matrix(rows), mode='skinny')

    def __call__(self, values, r0, p0):
        """values at self.s -> [r_0 ... r_M, p_0 ... p_N] and the largest weighted error"""
        right = mp.matrix([s * (v - r0 * mp.log(2 * s) - p0) for s, v in zip(self.s, values)])
        c = mp.lu_solve(self.r, self.q.T * right)
        error = max(abs(e) for e in self.q * (self.r * c) - right)
        T = [p0 - sum((-1)**j * c[M + j - 1] for j in range(1, N + 1))] + list(c[M:])
        return [r0] + list(c[:M]) + powers_of(T, N), error


def poly_in_nu(rows):
    """rows[i] at the i-th Chebyshev point of nu -> coefficients of powers of 4 nu - 1, for each column"""
    n = J + 1
    out = []
    for column in zip(*rows):
        T = [mp.mpf(2 if j else 1) / n * sum(v * mp.cos(mp.pi * j * (i + mp.mpf(1) / 2) / n) for i, v in enumerate(column))
             for j in range(n)]
        out.append(powers_of(T, J))
    return out


def table(name, rows, comment):
    print('\n/* %s */\nstatic const double %s[NLC_SPHERE_LOG + NLC_SPHERE_SMOOTH][NLC_SPHERE_NU] = {' % (comment, name))
    for row in rows:
        line = '    {'
        for k, v in enumerate(row):
            word = float(v).hex() + ('},' if k == len(row) - 1 else ',')
            if len(line) + len(word) > 118:
                print(line.rstrip())
                line = '     '
            line += word + ' '
        print(line.rstrip())
    print('};')


def main():
    import sys
    fit = Fit()
    rows, worst = ([], []), 0
    for i in range(J + 1):
        nu = (1 + mp.cos(mp.pi * (i + mp.mpf(1) / 2) / (J + 1))) / 4
        values, zero = [sums(nu, s) for s in fit.s], at_zero(nu)
        for k in (0, 1):
            c, error = fit([v[k] * (1 + nu) for v in values], -mp.mpf(k) * (1 + nu), zero[k] * (1 + nu))
            rows[k].append(c)
            worst = max(worst, error)
    G, error = fit([(1 - 2 * s * s) * mp.log(1 + s) for s in fit.s], mp.mpf(0), mp.mpf(0))
    tables = [poly_in_nu(r) for r in rows]
    print('largest error times s: %.2g; of G: %.2g; last coefficients in nu: %.2g' %
          (worst, error, max(abs(c[-1]) for t in tables for c in t)), file=sys.stderr)
    print('/* SPDX-License-Identifier: BSD-2-Clause */')
    print('/* sphere_table.h - made by tools/sphere_table.py, which says what the numbers are. */')
    print('#ifndef NLC_SPHERE_TABLE_H\n#define NLC_SPHERE_TABLE_H\n')
    print('#define NLC_SPHERE_NU %d /* powers of 4 nu - 1 */' % (J + 1))
    table('sphere_f0', tables[0], '(1+nu) F0: rows are the powers of h^2 in the factor of ln h, then those of h-1')
    table('sphere_f1', tables[1], '(1+nu) F1')
    print('\n/* cos theta ln(1 + h/2) */\nstatic const double sphere_g[NLC_SPHERE_LOG + NLC_SPHERE_SMOOTH] = {')
    for k in range(0, len(G), 4):
        print('    ' + ' '.join(float(v).hex() + ',' for v in G[k:k + 4]))
    print('};\n\n#endif')


if __name__ == '__main__':
    main()
