#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
# The coefficients in lib/love.h: e(y) = 1/5 - y/7 + y^2/9 - ... = (1/3 - (1 - arctan(w)/w)/y)/y, w = sqrt(y), by a quotient of
# two polynomials of degree 6 that agrees with it at 13 Chebyshev points of [0, 1].
import mpmath as mp

mp.mp.dps = 60
DEGREE = 6


def e(y):
    w = mp.sqrt(y)
    return (mp.mpf(1) / 3 - (1 - mp.atan(w) / w) / y) / y


n = 2 * DEGREE + 1
A, b = mp.matrix(n, n), mp.matrix(n, 1)
for i in range(n):
    y = (1 - mp.cos(mp.pi * (2 * i + 1) / (2 * n))) / 2
    for j in range(DEGREE + 1):
        A[i, j] = y**j
    for j in range(1, DEGREE + 1):
        A[i, DEGREE + j] = -e(y) * y**j
    b[i] = e(y)
x = [float(c) for c in mp.lu_solve(A, b)]
p, q = x[:DEGREE + 1], [1.0] + x[DEGREE + 1:]
worst = max(abs(mp.polyval(p[::-1], y) / mp.polyval(q[::-1], y) / e(y) - 1) for y in mp.linspace(mp.mpf("1e-6"), 1, 2000))
print("p:", *(c.hex() for c in p))
print("q:", *(c.hex() for c in q))
print("relative error with these coefficients:", mp.nstr(worst, 3))
