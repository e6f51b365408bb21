/* SPDX-License-Identifier: BSD-2-Clause */
/* small.c - the small symmetric problems of the solver.  Plain methods, in plain arithmetic, that end for every finite input. */
#include "small.h"

#include <math.h>

/* Ritz values beyond this say no more than that ghosts have brought numbers that are those of no coupling. */
#define LARGEST 1e120

/* Turns coordinates i and j of A so that A[i][j] vanishes; V collects the turns. */
static void rotate(int n, nlc_small A, nlc_small V, int i, int j)
{
    const double ratio = (A[i][i] - A[j][j]) / (2 * A[i][j]), size = fabs(ratio);
    const double t = (ratio >= 0 ? 1 : -1) / (size + sqrt(1 + (size < 1e100 ? ratio * ratio : 1e200)));
    const double c = 1 / sqrt(1 + t * t), s = t * c;
    for (int l = 0; l < n; l++) {
        const double x = A[l][i], y = A[l][j];
        A[l][i] = c * x + s * y;
        A[l][j] = c * y - s * x;
    }
    for (int l = 0; l < n; l++) {
        const double x = A[i][l], y = A[j][l];
        A[i][l] = c * x + s * y;
        A[j][l] = c * y - s * x;
    }
    for (int l = 0; l < n; l++) {
        const double x = V[l][i], y = V[l][j];
        V[l][i] = c * x + s * y;
        V[l][j] = c * y - s * x;
    }
}

/* Jacobi's method: A becomes diagonal, the columns of V its eigenvectors. */
static void diagonalise(int n, nlc_small A, nlc_small V)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) V[i][j] = i == j;
    for (int round = 0; round < 12; round++) {
        double beside = 0, diagonal = 0;
        for (int i = 0; i < n; i++) {
            diagonal += A[i][i] * A[i][i];
            for (int j = 0; j < i; j++) beside += A[i][j] * A[i][j];
        }
        if (beside <= 1e-30 * diagonal) return;
        for (int i = 1; i < n; i++)
            for (int j = 0; j < i; j++)
                if (fabs(A[i][j]) > 1e-18 * (fabs(A[i][i]) + fabs(A[j][j]))) rotate(n, A, V, i, j);
    }
}

int nlc_ritz(int n, nlc_small M, nlc_small K, nlc_small Y, double theta[NLC_DIRECTIONS])
{
    nlc_small A, V, T, H, U;
    double unit[NLC_DIRECTIONS];
    int rank = 0;
    for (int i = 0; i < n; i++) { /* no choice: of one clang 16 makes a vector that divides by the root of both sides */
        const double some = M[i][i] > 1e-290;
        unit[i] = some / sqrt(M[i][i] + (1 - some));
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) A[i][j] = M[i][j] * unit[i] * unit[j];
    diagonalise(n, A, V);
    for (int j = 0; j < n; j++) {
        if (A[j][j] <= 1e-10) continue;
        const double f = 1 / sqrt(A[j][j]);
        for (int i = 0; i < n; i++) T[i][rank] = V[i][j] * f * unit[i];
        rank++;
    }
    for (int i = 0; i < rank; i++)
        for (int j = 0; j < rank; j++) {
            H[i][j] = 0;
            for (int x = 0; x < n; x++)
                for (int y = 0; y < n; y++) H[i][j] += T[x][i] * K[x][y] * T[y][j];
            H[i][j] = H[i][j] > LARGEST ? LARGEST : H[i][j] < -LARGEST ? -LARGEST : H[i][j];
        }
    diagonalise(rank, H, U);
    for (int r = 0; r < rank; r++) {
        theta[r] = H[r][r];
        for (int i = 0; i < n; i++) {
            Y[i][r] = 0;
            for (int j = 0; j < rank; j++) Y[i][r] += T[i][j] * U[j][r];
        }
    }
    return rank;
}

bool nlc_is_below(double *B, int n, double beta)
{
    const double least = 1e-13 * beta + 1e-60;
    for (int a = 0; a < n; a++) { /* Cholesky; the diagonal keeps the inverse of the root of its pivot */
        double *row = B + a * n, pivot = beta - row[a];
        for (int d = 0; d < a; d++) {
            const double *above = B + d * n;
            double s = -row[d];
            for (int l = 0; l < d; l++) s -= row[l] * above[l];
            row[d] = s * above[d];
            pivot -= row[d] * row[d];
            if (pivot <= least) return false; /* at once: of what is far above beta the rows would grow without end */
        }
        if (pivot <= least) return false;
        row[a] = 1 / sqrt(pivot);
    }
    return true;
}

/* Householder's reduction to a tridiagonal matrix; v, p: [n] */
static void reduce(double *B, int n, double *a, double *b, double *v, double *p)
{
    for (int k = 0; k + 2 < n; k++) {
        double s = 0, projection = 0;
        for (int i = k + 1; i < n; i++) s += B[i * n + k] * B[i * n + k];
        const double first = B[(k + 1) * n + k], rest = s - first * first;
        a[k] = B[k * n + k];
        b[k] = first;
        if (rest <= 1e-32 * s + 1e-200) continue; /* what is so small in a matrix of about 1 moves no eigenvalue */
        b[k] = first > 0 ? -sqrt(s) : sqrt(s);
        v[k + 1] = first - b[k];
        const double per_length = 1 / sqrt(v[k + 1] * v[k + 1] + rest); /* of a small v beside large elements, too */
        v[k + 1] *= per_length;
        for (int i = k + 2; i < n; i++) v[i] = B[i * n + k] * per_length;
        for (int i = k + 1; i < n; i++) {
            p[i] = 0;
            for (int j = k + 1; j < n; j++) p[i] += B[i * n + j] * v[j];
            p[i] *= 2;
            projection += v[i] * p[i];
        }
        for (int i = k + 1; i < n; i++) p[i] -= projection * v[i];
        for (int i = k + 1; i < n; i++)
            for (int j = k + 1; j < n; j++) B[i * n + j] -= v[i] * p[j] + p[i] * v[j];
    }
    if (n > 1) {
        a[n - 2] = B[(n - 2) * n + n - 2];
        b[n - 2] = B[(n - 1) * n + n - 2];
    }
    a[n - 1] = B[n * n - 1];
}

/* Sums over the pivots of T - x: of e'/e and of (e'/e)^2 - e''/e, for Laguerre's step.  False: x is not above all roots. */
static bool pivots(const double *a, const double *b, int n, double x, double smallest, double *s1, double *s2)
{
    double e = 0, e1 = 0, e2 = 0;
    *s1 = *s2 = 0;
    for (int i = 0; i < n; i++) {
        double f = a[i] - x, f1 = -1, f2 = 0;
        if (i > 0) {
            const double r = b[i - 1] * b[i - 1] / e, u = e1 / e;
            f -= r;
            f1 += r * u;
            f2 = r * (e2 / e - 2 * u * u);
        }
        if (f >= -smallest) return false;
        *s1 += f1 / f;
        *s2 += f1 / f * (f1 / f) - f2 / f;
        e = f, e1 = f1, e2 = f2;
    }
    return true;
}

/* Laguerre's method from Gershgorin's bound: it comes down to the largest root and never passes it. */
double nlc_largest_tridiagonal(const double *a, const double *b, int n)
{
    double high = a[0], size = 0, s1, s2;
    for (int i = 0; i < n; i++) {
        const double g = a[i] + (i > 0 ? fabs(b[i - 1]) : 0) + (i + 1 < n ? fabs(b[i]) : 0);
        high = g > high ? g : high;
        size = fabs(g) > size ? fabs(g) : size;
    }
    if (n == 1 || size <= 0) return high;
    high += 1e-12 * size;
    for (int k = 0; k < 60 && pivots(a, b, n, high, 1e-14 * size, &s1, &s2); k++) {
        const double d = (n - 1) * (n * s2 - s1 * s1), step = n / (s1 + sqrt(d > 0 ? d : 0));
        if (step <= 2e-15 * size) break;
        high -= step;
    }
    return high;
}

double nlc_largest_eigenvalue(double *B, int n, double *work)
{
    double *a = work, *b = a + n, *v = b + n, *p = v + n;
    reduce(B, n, a, b, v, p);
    return nlc_largest_tridiagonal(a, b, n);
}
