# SPDX-License-Identifier: BSD-2-Clause
"""
two_spheres.py - two elastic spheres of different size or material pressed together, and one of them against a rigid plate
opposite, by the method of sphere_contact.py.  Needs numpy.  Units: radius and modulus of the first sphere.

Both spheres are deformed; between different ones the surface of contact is not flat.  Its curvature is taken from the leading
order, Hertz: kappa = 1/R_1 - (q_1/(q_1 + q_2)) (1/R_1 + 1/R_2), q = (1 - nu^2)/E.  The pressure acts along that surface's
normal, at the angle kappa r from the axis, and the displacements along it close the gap between points at the same distance r
from the axis.  That is where linear elasticity leaves a choice; others would change forces by some (kappa a)^2.
Each sphere is held by a uniform body force.
"""
import numpy as np

from sphere_contact import extrapolated, jacobi, modes, window


class Side:
    """The harmonics of a patch's basis functions on one sphere."""

    def __init__(self, sphere, rho, weight, radius, kappa, reach, degree=None):
        self.sphere = sphere
        theta = np.arcsin(radius * rho / sphere[0])
        tilt = theta - kappa * radius * rho
        self.degree = degree or int(reach * sphere[0] / radius) + 10
        n = np.arange(self.degree + 1.)
        Y = np.ones((self.degree + 2, len(theta)))
        x, s = np.cos(theta), np.sin(theta)
        Y[1] = x
        for k in range(1, self.degree + 1):
            Y[k + 1] = ((2 * k + 1) * x * Y[k] - k * Y[k - 1]) / (k + 1)
        slope = np.zeros((self.degree + 1, len(theta)))
        slope[1:] = n[1:, None] * (x * Y[1:-1] - Y[:-2]) / s
        norm = np.sqrt((2 * n + 1) / (4 * np.pi))
        self.radial = -(weight * np.cos(tilt)) @ Y[:-1].T * norm
        self.along = (weight * np.sin(tilt)) @ slope.T * norm / np.maximum(n * (n + 1), 1)

    def work(self, other, opposite):
        """opposite: the other patch is at the other pole."""
        degree = min(self.degree, other.degree)
        n = np.arange(degree + 1.)
        radius, young, nu = self.sphere
        uu, uv, vv, _ = modes(nu, degree)
        w = window((n + .5) / (degree + .5)) * (-1.)**n if opposite else extrapolated(degree)
        pr, ps, qr, qs = (v[:, :degree + 1] for v in (self.radial, self.along, other.radial, other.along))
        return ((pr * (w * uu)) @ qr.T + (pr * (w * uv)) @ qs.T + (ps * (w * uv)) @ qr.T +
                (ps * (w * n * (n + 1) * vv)) @ qs.T) / (young * radius)


class Contact:
    """The patch of radius a between spheres (radius, young, nu), or of one with a rigid plate."""

    def __init__(self, spheres, radius, functions, reach, before=None):
        self.radius = radius
        x, w = np.polynomial.legendre.leggauss(int(reach / 2) + 40)
        psi = (x + 1) * np.pi / 4
        rho = np.sin(psi)
        kappa = 0.
        if len(spheres) == 2:
            q = [(1 - nu * nu) / young for _, young, nu in spheres]
            kappa = 1 / spheres[0][0] - q[0] / sum(q) * sum(1 / s[0] for s in spheres)
        f = np.array([jacobi(k, 0, np.cos(2 * psi)) for k in range(functions)])
        edge = np.array([jacobi(k, 0, np.array([-1.]))[0] for k in range(functions)])
        near = np.array([jacobi(k, 0, np.array([2e-4 - 1]))[0] for k in range(functions)])
        self.slope = np.append((near - edge)[1:] * 1e4, 0)
        f = np.vstack([f[1:] - np.outer(edge[1:], f[0]), f[:1]])
        along_axis = 2 * np.pi * radius**2 * rho * w * np.pi / 4 * f  # pressure times the area seen along the axis
        weight = along_axis / np.cos(kappa * radius * rho)
        self.force = along_axis.sum(axis=1)
        depth = sum(R - np.sqrt(R * R - (radius * rho)**2) for R, _, _ in spheres)
        self.gap = along_axis @ depth
        self.sides = [Side(s, rho, weight, radius, sign * kappa, reach, before.sides[k].degree if before else None)
                      for k, (s, sign) in enumerate(zip(spheres, (1, -1)))]


def forces(first, second, overlap, plate=None, functions=7, reach=100.):
    """
    first, second: (radius, young, nu); overlap of the two and, if there is a plate, of that with the first sphere.
    Returns forces and radii, of one contact or of both.
    """
    spheres = [(first, second)] + ([(first, )] if plate is not None else [])
    given = [overlap] + ([plate] if plate is not None else [])
    curvature = [sum(1 / s[0] for s in both) for both in spheres]
    radius = [np.sqrt(g / c) for g, c in zip(given, curvature)]
    contacts = [None] * len(given)
    for step in range(40):
        contacts = [Contact(s, a, functions, reach, c if step > 5 else None) for s, a, c in zip(spheres, radius, contacts)]
        K = functions
        A, b = np.zeros((K * len(given), K * len(given))), np.zeros(K * len(given))
        for c, (one, g) in enumerate(zip(contacts, given)):
            rows = slice(c * K, c * K + K)
            b[rows] = one.force * g - one.gap
            A[rows, rows] = sum(side.work(side, False) for side in one.sides)
        if len(given) == 2:
            A[:K, K:] = contacts[0].sides[0].work(contacts[1].sides[0], True)
            A[K:, :K] = A[:K, K:].T
        x = np.linalg.solve(A, b).reshape(-1, K)
        change = np.array([x[c, -1] / (one.slope @ x[c]) for c, one in enumerate(contacts)])
        if np.max(np.abs(change)) < 1e-5:
            return np.array([one.force @ x[c] for c, one in enumerate(contacts)]), np.array(radius)
        radius = radius * (1 + np.clip(change, -.4, .4))
    raise ValueError('no patch found')
