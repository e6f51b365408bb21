# SPDX-License-Identifier: BSD-2-Clause
"""
sphere_contact.py - a linearly elastic sphere pressed by frictionless rigid plates, solved without contact mechanics' usual
approximations: no half-space, no parabolic gap, no point forces.  Needs numpy.  Units: R = E = 1.

The problem.  Small strain, linear elasticity; a point of the surface at angle theta from a plate's normal e may not pass the
plate, u.e <= (1 - cos theta) - eps (the exact gap of the sphere), the plate pushes it along -e only (no friction), with a
pressure p >= 0 per area of the undeformed sphere.  Displacements are relative to the centre of mass of a sphere under a
uniform body force that balances the plates.

The Green's function.  Tractions and displacements of the surface in vector spherical harmonics,
    tau = sum R Y e_r + S grad Y + T e_r x grad Y,    u = sum U Y e_r + V grad Y + W e_r x grad Y;
degree by degree U and V follow from R and S, W from T, see modes().  Two axially symmetric fields about axes an angle beta
apart meet in P_n(cos beta), others in Wigner's d^n_m,m'(beta).

The pressure.  On each patch, theta <= alpha about e, with rho = sin(theta/2) / sin(alpha/2),
    p = sum over m, k of c_mk rho^|m| (1 - rho^2)^(-1/2) J_k(1 - 2 rho^2) e^(i m phi),
Galerkin's method for the c_mk.  A pressure that is singular at the edge says that the patch has the wrong size: alpha is
changed until the coefficient of (1 - rho^2)^(-1/2) vanishes for m = 0.  For m > 0 the singular functions stay: they are the
first order of a change of the patch's shape, and the energy is right to the second order of it (its derivative by the shape
is the square of the singular part).  Forces are the energy's derivatives.  M = 0: round patches.

Sums over the degrees are cut off by smooth windows, those of a patch with itself extrapolated, see extrapolated().
"""
import numpy as np


def modes(nu, degree):
    """Compliances of degree n = 0 ... degree, E = R = 1: U = uu R + uv S, V = (uv R / n(n+1)) + vv S, W = ww T."""
    n = np.arange(degree + 1.)
    mu = 1 / (2 * (1 + nu))
    with np.errstate(divide='ignore', invalid='ignore'):
        q = 2 * mu * (n - 1) * (n * n + (1 + 2 * nu) * n + 1 + nu)
        uu = (2 * (1 - nu) * n * n + nu * n - (1 - 2 * nu)) / q
        uv = -n * (n + 1) * ((1 - 2 * nu) * n - 2 + nu) / q
        vv = (2 * (1 - nu) * n * n - (1 - 3 * nu) * n + 1 + nu) / q
        ww = 1 / (mu * (n - 1))
    uv[0] = vv[0] = ww[0] = 0
    # n = 1: with a uniform body force, relative to the centre of mass; no rigid rotation
    c = (1 - 2 * nu) / (4 * mu * (1 + nu))
    uu[1] = 6 * c / 5
    uv[1] = -8 * c / 5
    d = nu / (mu * (1 + nu))  # U = c0 + d r^2, V = c0 + (1/mu - d) r^2 for S = 1
    vv[1] = (d - 2 / mu) / 5 + 1 / mu - d
    ww[1] = 0
    return uu, uv, vv, ww


def jacobi(k, m, t):
    """k-th Jacobi polynomial (-1/2, m), up to a factor, and scaled to about 1."""
    a, b = -.5, float(m)
    p0, p1 = np.ones_like(t), (a + 1) + (a + b + 2) * (t - 1) / 2
    if k == 0:
        return p0
    for j in range(2, k + 1):
        c = 2 * j + a + b
        p0, p1 = p1, ((c - 1) * (c * (c - 2) * t + a * a - b * b) * p1 - 2 * (j + a - 1) * (j + b - 1) * c * p0) / (
            2 * j * (j + a + b) * (c - 2))
    return p1


class Patch:
    """The basis functions on theta <= alpha: force, gap, and their harmonics."""

    def __init__(self, alpha, functions, M, reach, degree=None):
        self.alpha, self.M = alpha, M
        self.degree = degree or int(reach / alpha) + 10
        sigma = np.sin(alpha / 2)
        x, w = np.polynomial.legendre.leggauss(int(reach / 2) + 40)
        psi = (x + 1) * np.pi / 4
        rho = np.sin(psi)
        weight = w * np.pi / 4 * 4 * sigma**2 * rho  # dA = 4 sigma^2 rho drho dphi, without (1 - rho^2)^(1/2)
        theta = 2 * np.arcsin(sigma * rho)
        self.radial, self.along, self.around = [], [], []
        n = np.arange(self.degree + 2.)
        for m in range(M + 1):
            count = functions if m == 0 else functions - 1
            f = np.array([rho**m * jacobi(k, m, np.cos(2 * psi)) for k in range(count)])
            if m == 0:  # all but the last without a singularity at the edge
                edge = np.array([jacobi(k, 0, np.array([-1.]))[0] for k in range(count)])
                f = np.vstack([(f[k] - f[0] * edge[k]) for k in range(1, count)] + [f[0]])
                self.force = 2 * np.pi * f @ weight
                self.gap = 2 * np.pi * f @ (weight * 2 * sigma**2 * rho**2)
                # (1 - rho^2)^(-1/2) (f_k - f_k(edge)) = slope_k (1 - rho^2)^(1/2) at the edge
                h = 1e-4
                self.slope = np.array([(jacobi(k, 0, np.array([2 * h - 1]))[0] - edge[k]) / h for k in range(1, count)] + [0])
            # integrals of f with Y_n^m, then with cos Y and sin dY/dtheta by recurrence
            i0 = self.transform(theta, m, f * weight * 2 * np.pi)
            a = np.sqrt(np.maximum(n * n - m * m, 0) / np.maximum(4 * n * n - 1, 1))
            up, down = np.zeros_like(i0), np.zeros_like(i0)
            up[:, :-1] = a[1:] * i0[:, 1:]
            down[:, 1:] = a[1:] * i0[:, :-1]
            nn = np.maximum(n * (n + 1), 1)
            self.radial.append(-(up + down)[:, :-1])
            self.along.append(((n * up - (n + 1) * down) / nn)[:, :-1])
            self.around.append((m * i0 / nn)[:, :-1])  # times i sign(m)

    def transform(self, theta, m, f):
        """[functions][degree + 2] sums over the points of f Y_n^m; in blocks of degrees, to spare memory."""
        degree = self.degree + 1
        out = np.zeros((len(f), degree + 1))
        n = np.arange(degree + 1.)
        a = np.sqrt(np.maximum(n * n - m * m, 0) / np.maximum(4 * n * n - 1, 1))
        x = np.cos(theta)
        start = np.full_like(x, np.sqrt(1 / (4 * np.pi)))  # Y_m^m, without a factor (-1)^m
        for j in range(1, m + 1):
            start = start * np.sqrt((2 * j + 1) / (2 * j)) * np.sin(theta)
        block, first = np.empty((512, len(theta))), m
        y0, y1 = np.zeros_like(x), start
        k = m
        while k <= degree:
            size = min(512, degree + 1 - k)
            for j in range(size):
                block[j] = y1
                if k + 1 <= degree:
                    y0, y1 = y1, (x * y1 - a[k] * y0) / a[k + 1]
                k += 1
            out[:, first:first + size] = f @ block[:size].T
            first += size
        return out


def window(x):
    """1 below 1/2, 0 above 1, smooth."""
    x = np.clip(2 * x - 1, .002, .998)
    return 1 / (1 + np.exp(1 / (1 - x) - 1 / x))


def extrapolated(degree):
    """Weights of the degrees: smooth windows cut off oscillations; their sum is free of tails N^-1, N^-2, N^-3."""
    n = np.arange(degree + 1.) + .5
    scales = np.array([1, .8, .64, .512])
    v = np.vander(1 / scales, 4, increasing=True).T
    c = np.linalg.solve(v, np.array([1., 0, 0, 0]))
    return sum(c[k] * window(n / ((degree + .5) * scales[k])) for k in range(4))


def work(p, q, m, mp, rotation, compliance, weights):
    """[functions of p][functions of q] inward displacement by q averaged with p; rotation[n] = D^n_m,mp."""
    degree = len(weights) - 1
    uu, uv, vv, ww = (c[:degree + 1] for c in compliance)
    n = np.arange(degree + 1.)
    w = weights * rotation
    a, b = abs(m), abs(mp)
    pr, ps, pt = p.radial[a][:, :degree + 1], p.along[a][:, :degree + 1], p.around[a][:, :degree + 1] * np.sign(m)
    qr, qs, qt = q.radial[b][:, :degree + 1], q.along[b][:, :degree + 1], q.around[b][:, :degree + 1] * np.sign(mp)
    out = (pr * (w * uu)) @ qr.T + (pr * (w * uv)) @ qs.T + (ps * (w * uv)) @ qr.T + (ps * (w * n * (n + 1) * vv)) @ qs.T
    if m and mp:
        out = out + (pt * (w * n * (n + 1) * ww)) @ qt.T
    return out


def wigner(m, mp, beta, degree):
    """d^n_m,mp(beta) for n = 0 ... degree; with the harmonics' phases as here, not those of Condon and Shortley."""
    d = np.zeros(degree + 1)
    J = max(abs(m), abs(mp))
    c, s = np.cos(beta / 2), np.sin(beta / 2)

    def top(j, k):  # d^j_j,k
        binomial = 1.
        for i in range(j - k):
            binomial *= (2 * j - i) / (i + 1.)
        return (-1)**(j - k) * np.sqrt(binomial) * c**(j + k) * s**(j - k)

    if m == J:
        d[J] = top(J, mp)
    elif mp == J:
        d[J] = (-1)**(m - mp) * top(J, m)
    elif m == -J:
        d[J] = (-1)**(m - mp) * top(J, -mp)
    else:
        d[J] = top(J, -m)
    x = np.cos(beta)
    for n in range(J, degree):
        r = np.sqrt(((n + 1.)**2 - m * m) * ((n + 1.)**2 - mp * mp))
        if n == 0:
            d[1] = x * d[0]
        else:
            d[n + 1] = (n + 1) * (2 * n + 1) / r * (x - m * mp / (n * (n + 1.))) * d[n]
            if n > J:
                d[n + 1] -= (n + 1) * np.sqrt((n * n - m * m) * (n * n - mp * mp)) / (n * r) * d[n - 1]
    return d * (-1)**(max(m, 0) + max(mp, 0))


def frame(e):
    """Orthogonal matrix whose last column is e."""
    a = np.eye(3)[np.argmin(np.abs(e))]
    x = np.cross(a, e)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(e, x), e])


def euler(q):
    """A, beta, G of q = Rz(A) Ry(beta) Rz(G)."""
    beta = np.arctan2(np.hypot(q[0, 2], q[1, 2]), q[2, 2])
    if np.hypot(q[0, 2], q[1, 2]) < 1e-12:
        return np.arctan2(q[1, 0], q[1, 1]), beta, 0.
    return np.arctan2(q[1, 2], q[0, 2]), beta, np.arctan2(q[2, 1], -q[2, 0])


class Scene:
    """
    contacts: (normal, eps, group); by symmetry, contacts of a group have the same force and patch.
    functions: unknowns of a patch and m; reach: highest degree times alpha.
    """

    def __init__(self, nu, contacts, functions=7, reach=100.):
        self.nu, self.functions, self.reach = nu, functions, reach
        self.normals = np.array([c[0] for c in contacts], float)
        self.normals /= np.linalg.norm(self.normals, axis=1)[:, None]
        self.eps = [c[1] for c in contacts]
        self.group = [c[2] for c in contacts]
        self.groups = max(self.group) + 1
        self.table = modes(nu, 1000)
        self.fixed = None  # numbers of degrees, to be kept: the last steps must not see them jump

    def compliance(self, degree):
        if len(self.table[0]) < degree + 1:
            self.table = modes(self.nu, 2 * degree)
        return self.table

    def self_work(self, p, m):
        return work(p, p, m, m, 1., self.compliance(p.degree), extrapolated(p.degree))

    def pair_degree(self, p, q, beta):
        """Enough for the slowest oscillation, that of the two points of the patches that are closest to each other."""
        gap = beta - p.alpha - q.alpha
        if gap < .01:
            raise ValueError('patches touch each other')
        degree = int(min(p.degree, q.degree, self.reach * max(4, 3 / gap)))
        if self.fixed is not None:
            return self.fixed.setdefault((p.degree, q.degree, round(beta, 9)), degree)
        return degree

    def pair_work(self, p, q, m, mp, beta):
        N = self.pair_degree(p, q, beta)
        return work(p, q, m, mp, wigner(m, mp, beta, N), self.compliance(N), window((np.arange(N + 1.) + .5) / (N + .5)))

    def angle(self, c, d):
        return 2 * np.arcsin(min(np.linalg.norm(self.normals[c] - self.normals[d]) / 2, 1.))

    def solve_round(self, alpha):
        """Forces of the groups with M = 0.  alpha: first guess for each group; self.alpha, self.coefficients are set."""
        K, G = self.functions, self.groups
        first = [self.group.index(g) for g in range(G)]
        alpha = np.array(alpha, float)
        patches, self.fixed = [None] * G, None
        for step in range(40):
            if step == 5:
                self.fixed = {}
            patches = [Patch(a, K, 0, self.reach, p.degree if self.fixed is not None else None) for a, p in zip(alpha, patches)]
            A, b = np.zeros((G * K, G * K)), np.zeros(G * K)
            for g, p in enumerate(patches):
                rows = slice(g * K, g * K + K)
                b[rows] = p.force * self.eps[first[g]] - p.gap
                A[rows, rows] += self.self_work(p, 0)
                for d, h in enumerate(self.group):
                    if d != first[g]:
                        A[rows, h * K:h * K + K] += self.pair_work(p, patches[h], 0, 0, self.angle(first[g], d))
            x = np.linalg.solve(A, b).reshape(G, K)
            change = np.array([x[g, -1] / (p.slope @ x[g]) for g, p in enumerate(patches)])
            if np.max(np.abs(change)) < 1e-5:  # its square is the force's error
                break
            alpha *= 1 + np.clip(change, -.4, .4)
        else:
            raise ValueError('no round patch found')
        self.patches, self.alpha, self.coefficients = patches, alpha, x
        return np.array([p.force @ x[g] for g, p in enumerate(patches)])

    def energy(self, M):
        """Elastic energy, m up to M, on the patches that solve_round found."""
        K, places, size = self.functions, {}, 0
        contacts = range(len(self.normals))
        for c in contacts:
            for m in range(-M, M + 1):
                count = K if m == 0 else K - 1
                places[c, m] = slice(size, size + count)
                size += count
        patches = [Patch(a, K, M, self.reach) for a in self.alpha]
        own = {(g, m): self.self_work(p, m) for g, p in enumerate(patches) for m in range(-M, M + 1)}
        kept = {}
        A, b = np.zeros((size, size), complex), np.zeros(size, complex)
        for c in contacts:
            p = patches[self.group[c]]
            b[places[c, 0]] = p.force * self.eps[c] - p.gap
            for m in range(-M, M + 1):
                A[places[c, m], places[c, m]] = own[self.group[c], m]
            for d in range(c):
                q = patches[self.group[d]]
                A1, beta, G1 = euler(frame(self.normals[c]).T @ frame(self.normals[d]))
                for m in range(-M, M + 1):
                    for mp in range(-M, M + 1):
                        key = self.group[c], self.group[d], m, mp, round(beta, 9)
                        if key not in kept:
                            kept[key] = self.pair_work(p, q, m, mp, beta)
                        w = kept[key] * np.exp(-1j * (m * A1 + mp * G1))
                        A[places[c, m], places[d, mp]] = w
                        A[places[d, mp], places[c, m]] = w.conj().T
        return np.vdot(b, np.linalg.solve(A, b)).real / 2

    def displacement(self, c, theta):
        """u.e of round patches at the angles theta from contact c, seen along one meridian: e is c's normal."""
        e = self.normals[c]
        x = frame(e)[:, 0]
        out = np.zeros(len(theta))
        for k, t in enumerate(theta):
            at = np.cos(t) * e + np.sin(t) * x
            for d, n in enumerate(self.normals):
                g = self.group[d]
                p = self.patches[g]
                along = min(max(at @ n, -1.), 1.)
                side = at - along * n
                s = np.linalg.norm(side)
                R, S = self.coefficients[g] @ p.radial[0], self.coefficients[g] @ p.along[0]
                u, v = surface_displacement(self.compliance(p.degree), R, S, np.arctan2(s, along))
                tangent = along * side / s - s * n if s > 0 else 0 * n
                out[k] += u * (at @ e) + v * (tangent @ e)
        return out


def surface_displacement(compliance, R, S, theta):
    """u_r and u_theta of axially symmetric tractions at one angle."""
    degree = len(R) - 1
    uu, uv, vv, _ = (c[:degree + 1] for c in compliance)
    n = np.arange(degree + 1.)
    w = window((n + .5) / (degree + .5))  # there is hardly a tail: what it leaves is small where it does not oscillate
    P = np.zeros(degree + 2)
    P[0], P[1] = 1, np.cos(theta)
    for k in range(1, degree + 1):
        P[k + 1] = ((2 * k + 1) * P[1] * P[k] - k * P[k - 1]) / (k + 1)
    norm = np.sqrt((2 * n + 1) / (4 * np.pi))
    slope = np.zeros(degree + 1)
    if np.sin(theta) > 1e-12:
        slope[1:] = n[1:] * (P[1] * P[1:-1] - P[:-2]) / np.sin(theta)
    return w * norm * (uu * R + uv * S) @ P[:-1], w * norm * (uv * R / np.maximum(n * (n + 1), 1) + vv * S) @ slope
