#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
# Writes tests/love_table.h: [GC] 26-29 as printed, with as many digits as their cancellation takes, rounded to double.
import random
import mpmath as mp

mp.mp.dps = 2000


def fields(a, r, z, nu):
    """P = E = 1.  u_z, u_r, s_zz, s_rr, s_tt, s_rz, and what errors of u_r, s_rr, s_tt are relative to."""
    a, r, z, nu = map(mp.mpf, (a, r, z, nu))
    if r == 0:
        r = mp.mpf(2)**-3000  # the printed equations have 0/0 on the axis
    if z == 0:
        z = mp.mpf(2)**-3000
    if a == 0:
        a = mp.mpf(2)**-2000
    f = r * r + z * z - a * a
    kappa = (f + mp.sqrt(f * f + 4 * a * a * z * z)) / 2
    root = mp.sqrt(kappa)
    arc = mp.atan(a / root)
    n = kappa * kappa + a * a * z * z
    V = 3 / (4 * a**2) * ((2 * a - r * r / a + 2 * z * z / a) * arc + r * r * root / (a * a + kappa) - 2 * z * z / root)
    Vr = -3 * r / (2 * a**3) * (arc - a * root / (a * a + kappa))
    Vz = -3 * z / a**3 * (a / root - arc)
    Vzz = -3 / a**3 * (a / root - arc) + 3 * z * z / (n * root)
    Vrr = -3 / (2 * a**3) * (arc - a * root / (a * a + kappa)) + 3 * (kappa - z * z) * root / (n * (a * a + kappa))
    Vrz = 3 * r * z * root / (n * (a * a + kappa))
    common, other = 3 * z / (2 * a**3) * (a / root - arc), z / (r * r * root) * (3 * kappa - z * z) / (2 * kappa)
    chi_r, chi_rr = 1 / r**2 + common - other, -1 / r**2 + common + other  # (1/r) dchi/dr, d2chi/dr2
    mild, u, t = 1 - 2 * nu, (1 + nu) / (2 * mp.pi), 1 / (2 * mp.pi)
    return (u * (2 * (1 - nu) * V - z * Vz), -u * r * (mild * chi_r + z * Vr / r), t * (Vz - z * Vzz),
            t * (2 * nu * Vz - mild * chi_rr - z * Vrr), t * (2 * nu * Vz - mild * chi_r - z * Vr / r), -t * z * Vrz,
            u * r * (mild * chi_r - z * Vr / r), t * (abs(Vz - z * Vrr) + mild * chi_r),
            t * (abs(Vz - z * Vr / r) + mild * chi_r))


def show(numbers):
    # what would be too small for double is 0
    return "{" + ", ".join(float(x).hex().replace("0x0.0p+0", "0").replace("0000000000000p", "p").replace(".p", "p")
                           if abs(x) > 1e-290 else "0" for x in numbers) + "}"



random.seed(1929)
points = []
for a in (1.0, 1e-3, 1e-9, 1e-80, 0.0):  # near the point force to wide circles; the axis and beside it; the surface and below
    for r, z in ((0.0, 1.5), (1e-9, 1.0), (1e-4, 0.7), (0.75, 0.5), (1.5, 0.0), (2.0, 1e-9), (1.0, 1e-3), (3.0, 4.0)):
        points.append((a, r, z))
for r, z in ((0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.0, 1e-9), (1e-9, 1e-12), (0.5, 1e-15), (0.999, 1e-3), (1.0, 1e-9),
             (1.0, 1e-30), (1 - 2.0**-53, 0.0), (1 + 2.0**-52, 0.0), (1 + 1e-6, 1e-9), (1 - 1e-6, 1e-6), (0.8, 0.6)):
    points.append((1.0, r, z))
for _ in range(20):
    points.append(tuple(10**random.uniform(-4, 1) for _ in range(3)))

print("/* SPDX-License-Identifier: BSD-2-Clause */")
print("/* love_table.h - [GC] 26-29 with 2000 digits, P = E = 1; written by love_table.py */")
print("static const struct {\n    double in[4]; /* a, r, z, nu */\n    double u_z, u_r, zz, rr, tt;\n"
      "    double rz, scale_u_r, scale_rr, scale_tt;\n} love_table[] = {")
for a, r, z in points:
    nu = random.choice((0.0, 0.25, 0.3, 0.46, 0.5, random.uniform(0, 0.5)))
    f = fields(a, r, z, nu)
    out = "    {" + show((a, r, z, nu)) + ",\n     " + show(f[:5])[1:-1] + ",\n     " + show(f[5:])[1:-1] + "},"
    print(out)
print("};\n")
print("/* R = E = P = 1: a, theta, nu; n.u and what its error is relative to */")
print("static const double normal_table[][5] = {")
for a in (1e-300, 1e-20, 1e-3, 0.1, 0.5, 2.0):
    for theta in (1e-250, 1e-20, 1e-3, 0.1, 0.5235987755982988, 1.0, 1.5707963267948966, 2.5, 3.141592653589793):
        nu = random.choice((0.0, 0.25, 0.3, 0.46, 0.5, random.uniform(0, 0.5)))
        x = mp.mpf(theta)
        f = fields(a, mp.sin(x), 2 * mp.sin(x / 2)**2, nu)
        w, scale = -mp.cos(x) * f[0] + mp.sin(x) * f[1], f[0] + mp.sin(x) * f[6]
        print("    " + show((a, theta, nu, w, scale)) + ",")
print("};")
