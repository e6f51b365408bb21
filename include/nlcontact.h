/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * nlcontact.h - nonlocal normal contact forces between elastic spheres
 *
 * Classical contact laws treat the contacts of a grain as independent of each other.  In a dense packing they are not:
 * every force on a grain moves the whole surface of that grain, and with it the overlap at all of its other contacts.
 * This library computes the forces with that coupling, for any code that has its own particles, neighbours and integrator:
 *
 *     overlap, normal of every contact  -->  nlc_solve  -->  force of every contact  -->  nlc_assemble  -->  F of every particle
 *
 * References, by which equations are cited below:
 *   [GC]  M. Gonzalez, A. M. Cuitino, "A nonlocal contact formulation for confined granular systems",
 *         J. Mech. Phys. Solids 60 (2012) 333-350, doi:10.1016/j.jmps.2011.10.004
 *   [MC]  N. Brodu, J. A. Dijksman, R. P. Behringer, "Multiple-contact discrete-element model for simulating dense
 *         granular media", Phys. Rev. E 91 (2015) 032201, doi:10.1103/PhysRevE.91.032201
 *
 * Notation.  Contact c joins particles i and j.  Its contact normal n_c is the unit vector from i to j, its overlap is
 * gamma_c = R_i + R_j - distance (> 0: overlap, < 0: gap), its force P_c >= 0 is compressive.  With a flat wall in the place
 * of j, n_c points into the wall and gamma_c = R_i - distance.  The nonlocal displacement g_c is the sum of the two
 * surfaces' displacement at the contact, caused by the other forces on i and on j, positive outward: it adds to the overlap,
 *     P_c = n_H (gamma_c + g_c)_+^(3/2)                                                                    [GC] 10
 *
 * Units: SI or any other consistent system.  There is no absolute constant in the library.
 *
 * What holds for every function
 *   - It never allocates, prints, exits, reads the environment, starts a thread or keeps state outside the caller's memory.
 *     Different networks may be used by different threads at the same time; one network by one thread at a time, except
 *     that functions taking a const nlc_network may run side by side.
 *   - It does not touch errno or change a floating-point mode, and raises no invalid, divide-by-zero or overflow exception,
 *     whatever the input, quiet NaN included.  (Inexact and underflow may be raised.)
 *   - Arrays must not overlap each other.
 *   - On error nothing but *info is changed: not one byte of the results.
 *   - The same binary with the same input on the same kind of processor gives the same bits.
 *
 * Not promised: that results agree to the last bit between versions, compilers or kinds of processor (they agree to
 * rounding, amplified by 1/(1 - lambda) close to the end of the stable branch, see nlc_solve).
 */
#ifndef NLCONTACT_H
#define NLCONTACT_H

#include <stddef.h>
#include <stdint.h>

#define NLC_VERSION_MAJOR 0
#define NLC_VERSION_MINOR 1
#define NLC_VERSION_PATCH 0

#if defined(__cplusplus)
#  if defined(__GNUC__) || defined(_MSC_VER)
#    define NLC_RESTRICT __restrict
#  else
#    define NLC_RESTRICT
#  endif
#else
#  define NLC_RESTRICT restrict
#endif

#if defined(__GNUC__)
#  define NLC_API __attribute__((visibility("default")))
#else
#  define NLC_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------------- status -- */

/*
 * nlc_status - what a function returns: 0 is success; negative an error, nothing changed; positive one or more warning
 * bits, the results are usable.
 *
 * X(name, value, text, what info.culprit holds).  The one list that the codes, nlc_strerror and the tests are made from.
 */
#define NLC_STATUS_LIST(X)                                                                                                  \
    X(NLC_OK,                     0, "success",                                                          "-1")              \
    X(NLC_ERROR_NULL,            -1, "a required argument is NULL",                                      "argument, from 0")\
    X(NLC_ERROR_NULL_FIELD,      -2, "a required pointer in a struct is NULL",                            "field's offset")  \
    X(NLC_ERROR_STRUCT_SIZE,     -3, "struct_size is not that of any version's struct",                  "argument, from 0")\
    X(NLC_ERROR_RESERVED,        -4, "bytes beyond the fields that this version knows are not zero",     "argument, from 0")\
    X(NLC_ERROR_COUNT,           -5, "a count is negative or too large",                                 "argument, from 0")\
    X(NLC_ERROR_STRIDE,          -6, "a stride is shorter than an element or overflows",                 "offset, argument")\
    X(NLC_ERROR_MEMORY_SIZE,     -7, "the memory given is smaller than nlc_network_size says",           "bytes needed")    \
    X(NLC_ERROR_ALIGNMENT,       -8, "the memory given is not aligned to 8 bytes",                       "address modulo 8")\
    X(NLC_ERROR_NETWORK,         -9, "not a network made by nlc_network_init",                           "-1")              \
    X(NLC_ERROR_MODEL,          -10, "no such model",                                                    "the number given")\
    X(NLC_ERROR_NO_POTENTIAL,   -11, "the model has no energy",                                          "the model")       \
    X(NLC_ERROR_METHOD,         -12, "no such method",                                                   "the number given")\
    X(NLC_ERROR_OPTION,         -13, "an option is NaN, infinite, negative or unknown",                  "offset, argument")  \
    X(NLC_ERROR_RADIUS,         -14, "a radius is not positive and finite",                              "particle")        \
    X(NLC_ERROR_MATERIAL,       -15, "a material index is out of range",                                 "particle or wall")\
    X(NLC_ERROR_YOUNG,          -16, "a Young's modulus is not positive",                                "material")        \
    X(NLC_ERROR_POISSON,        -17, "a Poisson's ratio is outside [0, 0.5]",                            "material")        \
    X(NLC_ERROR_INDEX,          -18, "a particle or wall index is out of range",                         "contact")         \
    X(NLC_ERROR_WALL_WALL,      -19, "a contact joins two walls",                                        "contact")         \
    X(NLC_ERROR_RIGID_RIGID,    -20, "a contact joins two rigid bodies",                                 "contact")         \
    X(NLC_ERROR_STIFFNESS,      -21, "a contact stiffness is not positive and finite",                   "contact")         \
    X(NLC_ERROR_OVERLAP,        -22, "an overlap is not finite",                                         "contact")         \
    X(NLC_ERROR_NORMAL,         -23, "a contact normal is not finite or not of unit length",             "contact")         \
    X(NLC_ERROR_NONLOCAL,       -24, "a nonlocal displacement is not finite",                            "contact")         \
    X(NLC_ERROR_FORCE,          -25, "a contact force is not finite",                                    "contact")         \
    X(NLC_ERROR_TOTAL_FORCE,    -26, "a force or torque to be added to is not finite",                   "particle or wall")\
    X(NLC_ERROR_COINCIDENT,     -27, "two contacts of one particle lie in the same direction",           "contact")         \
    X(NLC_ERROR_RANGE,          -28, "a result is or might be beyond the range of double",               "contact or -1")   \
    X(NLC_ERROR_UNSTABLE,       -29, "the state is beyond the end of the stable branch",                 "-1")              \
    X(NLC_ERROR_SLIDING,        -30, "a direction of sliding is not a unit vector along the surfaces",   "contact")         \
    X(NLC_ERROR_POSITION,       -31, "a position is not finite",                                         "particle or wall")\
    X(NLC_ERROR_SAME_PLACE,     -32, "two centres are in the same place",                                "contact")         \
    X(NLC_ERROR_CELL,           -33, "a periodic cell is no cell, or narrower than two diameters",       "contact or -1")   \
    X(NLC_ERROR_CAPACITY,       -34, "the room given is too small for the result",                       "room needed")     \
    X(NLC_ERROR_GHOST,          -35, "a contact has no particle that is owned here",                     "contact")         \
    X(NLC_ERROR_REMOTE,         -36, "another rank has failed",                                          "-1")              \
    X(NLC_ERROR_CALLBACK,       -37, "a callback has failed",                                            "what it returned")\
    X(NLC_WARNING_CLOSE,          1, "circles of contact overlap: the model does not hold there",        "-1")              \
    X(NLC_WARNING_ROUNDING,       2, "rounding keeps the forces from reaching the tolerance",            "-1")              \
    X(NLC_WARNING_WEAKENED,       4, "beyond the stable branch: the coupling was weakened",              "-1")              \
    X(NLC_WARNING_NOT_CONVERGED,  8, "not converged: forces are finite but miss the tolerance",          "-1")

typedef int32_t nlc_status;

enum {
#define NLC_STATUS_ENUM(name, value, text, culprit) name = value,
    NLC_STATUS_LIST(NLC_STATUS_ENUM)
#undef NLC_STATUS_ENUM
    NLC_STATUS_MAX = 0x7fffffff /* makes the values of the list int on every compiler; never returned */
};

/*
 * nlc_strerror - the text of a status.
 *
 * status   any value; of several warning bits the most severe (highest) one is named.
 * Returns a constant string, "unknown status" for a value that is not in the list; never NULL.
 */
NLC_API const char *nlc_strerror(nlc_status status);

/*
 * nlc_version - the version of the library that is running, "major.minor.patch".  Compare with NLC_VERSION_*, the version
 * of the header.
 */
NLC_API const char *nlc_version(void);

/* --------------------------------------------------------------------------------------------------- scalar functions --
 *
 * Pure functions of their arguments.  A NaN among them, or a value outside the stated domain, gives NaN; a result too large
 * for double gives INFINITY (no exception is raised in either case).  No intermediate result overflows or underflows where
 * the result itself is representable.  R = INFINITY is a flat side, E = INFINITY a rigid one; every other infinite argument is
 * outside the domain.  Poisson's ratio: 0 <= nu <= 0.5, on a rigid side any number.
 *
 * Accuracy: worst error found in units in the last place (ulp) of the exact result, over wide random and systematic sweeps
 * of every argument including subnormal numbers and by climbing towards worse arguments (tests/test_scalar.c, test_love.c).
 */

/*
 * nlc_hertz_stiffness - n_H of the Hertz law P = n_H overlap^(3/2).                                             [GC] 9
 *
 *     1/n_H = (3/4) [ (1-nu1^2)/E1 + (1-nu2^2)/E2 ] (1/R1 + 1/R2)^(1/2)
 *
 * E1, E2     Young's moduli > 0, at most one INFINITY [Pa]
 * nu1, nu2   Poisson's ratios in [0, 0.5]; not looked at on a rigid side, except that NaN gives NaN
 * R1, R2     radii > 0, at most one INFINITY [m]
 * Returns n_H [N m^(-3/2)]; NaN for two rigid or two flat sides.  Worst error 7 ulp.  Exchanging the sides changes no bit.
 */
NLC_API double nlc_hertz_stiffness(double E1, double nu1, double R1, double E2, double nu2, double R2);

/*
 * nlc_hertz_force - the Hertz law, P = n_H overlap_+^(3/2).                                                    [GC] 10
 *
 * stiffness   n_H > 0 [N m^(-3/2)], finite
 * overlap     overlap, or overlap plus nonlocal displacement [m], finite; <= 0 (a gap) gives 0
 * Returns the force [N].  Worst error 2.2 ulp.
 */
NLC_API double nlc_hertz_force(double stiffness, double overlap);

/*
 * nlc_hertz_overlap - the inverse, overlap = (P / n_H)^(2/3).                                                  [GC] 7
 *
 * stiffness   n_H > 0 [N m^(-3/2)], finite
 * force       P >= 0 [N]
 * Returns the overlap [m]; NaN for a negative force.  Worst error 1.1 ulp.
 */
NLC_API double nlc_hertz_overlap(double stiffness, double force);

/*
 * nlc_contact_radius - radius a of the contact circle.                                                         [GC] 8
 *
 *     a^3 = (3 P / 4) [ (1-nu1^2)/E1 + (1-nu2^2)/E2 ] / (1/R1 + 1/R2)
 *
 * force   P >= 0 [N];  E1 ... R2   as for nlc_hertz_stiffness
 * Returns a [m]; NaN for a negative force, two rigid or two flat sides.  Worst error 3 ulp.  Exchanging the sides changes
 * no bit.
 */
NLC_API double nlc_contact_radius(double force, double E1, double nu1, double R1, double E2, double nu2, double R2);

/*
 * nlc_contact_displacement - displacement of one surface inside its contact circle, into the body.             [GC] 1
 *
 *     u_z = 3 P (1-nu^2) (2 a^2 - r^2) / (8 a^3 E),   0 <= r <= a
 *
 * force    P, any sign [N];  radius   a > 0, finite [m];  r   distance from the centre of the circle [m]
 * E, nu    Young's modulus [Pa] (INFINITY gives 0), Poisson's ratio
 * Returns u_z [m], > 0 into the body for a compressive force; NaN for r outside [0, a].  Worst error 7.5 ulp.
 */
NLC_API double nlc_contact_displacement(double force, double radius, double r, double E, double nu);

/*
 * nlc_nonlocal_displacement - normal displacement of a sphere's surface caused by a force elsewhere on it.     [GC] 5
 *
 *     w = (1+nu) P / (4 pi R E) [ -2(1-nu) - 2(1-2nu) s + (7-8nu) s^2 ] / s,   s = sin(theta/2)
 *
 * force    P, compressive > 0, any sign [N]
 * theta    angle, seen from the centre, between the force and the point looked at, 0 < theta <= pi [rad]
 * R, E     radius and Young's modulus [m, Pa]; INFINITY gives 0: a flat or rigid side has no nonlocal displacement (for a
 *          flat elastic one that is a convention, since its displacement would need positions)
 * nu       Poisson's ratio
 * Returns w [m], > 0 outward: towards the neighbour, so it adds to the overlap.  The expression has a zero (s = 0.645 at
 * nu = 0.3), so accuracy is relative to the sum of the absolute terms: worst error 8.5 ulp of it.
 */
NLC_API double nlc_nonlocal_displacement(double force, double theta, double R, double E, double nu);

/*
 * nlc_nonlocal_displacement_between - the same from two outward unit normals instead of the angle.             [GC] 5
 *
 * s = |n_c - n_d| / 2 keeps all digits for neighbouring contacts, where an angle from a dot product has lost half of them.
 *
 * n_c, n_d   [3] unit vectors from the particle's centre to the point looked at and to the force: | |n|^2 - 1 | <= 1e-6
 * Returns w [m]; NaN if a normal is not a unit vector or both are the same.  Exchanging n_c and n_d changes no bit.
 * Worst error 9.5 ulp of the sum of the absolute terms.
 */
NLC_API double nlc_nonlocal_displacement_between(double force, const double n_c[3], const double n_d[3], double R, double E,
                                                 double nu);

/*
 * nlc_half_space_displacement - displacement at contact c caused by the force of contact k, by the point force on a
 * half-space.                                                                                                  [MC] 1
 *
 *     w = -G (1+nu) F / (2 pi E d) { (n_k.u)(n_c.u) + (3-4nu) n_k.n_c - (1-2nu) (n_k+u).n_c / (1 + n_k.u) }
 *
 * force       F, compressive > 0, any sign [N]
 * n_k, n_c    [3] INWARD unit normals: the directions in which the two forces push the grain.  (With outward normals the
 *             last denominator would vanish for opposite contacts.)
 * r_kc        [3] vector from contact point k to contact point c [m]; d is its length, u = r_kc / d
 * E, nu       Young's modulus [Pa] (INFINITY gives 0), Poisson's ratio
 * prefactor   G, [MC]'s adjustable gamma, >= 0; 1 is the elastic half-space
 * Returns w [m], > 0 outward; NaN if a normal is not a unit vector, if r_kc = 0, or where 1 + n_k.u is not positive.
 * On the undeformed sphere (r_kc = R times the difference of the outward normals) it equals nlc_nonlocal_displacement times
 * G, for every nu ([MC] says for nu = 1/2 only).  Worst error 17 ulp of the sum of the absolute terms, every product of
 * components in a dot product counted as a term, divided by 1 + n_k.u where that is below 1.
 */
NLC_API double nlc_half_space_displacement(double force, const double n_k[3], const double n_c[3], const double r_kc[3],
                                           double E, double nu, double prefactor);

/*
 * nlc_point_displacement, nlc_point_stress, nlc_point_traction - Case I: the fields that go with nlc_nonlocal_displacement on
 * the whole surface of the sphere.                                                                       [GC] 2, 20-23
 *
 * The sphere is cut out of a half-space under Boussinesq's point force and touches its surface there.  Origin at the force,
 * axis z into the body (the direction of a compressive force), radius r from the axis: the point at the angle theta is
 * (z, r) = (2 R s^2, R sin(theta)), s = sin(theta/2), and the outward normal there is n = (-cos(theta), sin(theta)).
 * Displacements are relative to points at infinity; stresses are positive in tension.
 *
 * nlc_point_displacement - the displacement.                                                                 [GC] 21
 *
 *     u_z = (1+nu) P / (4 pi R E) [ 2(1-nu)/s + s ]
 *     u_r = (1+nu) P / (4 pi R E) cos(theta/2) [ 1 - (1-2nu) / (s (1+s)) ]
 *
 * (cos(theta/2) / (s (1+s)) is [GC]'s 2 (1-s) / sin(theta) without its 0/0 at theta = pi.)  n.u is nlc_nonlocal_displacement.
 *
 * displacement   [2] out: u_z, u_r [m]; both NaN if an argument is outside its domain
 * force          P, compressive > 0, any sign [N];  theta   0 < theta <= pi [rad]
 * R, E           radius and Young's modulus [m, Pa]; INFINITY gives 0;  nu   Poisson's ratio
 * Worst error 10 ulp: of u_z, and of u_r's sum of the absolute terms.
 */
NLC_API void nlc_point_displacement(double displacement[2], double force, double theta, double R, double E, double nu);

/*
 * nlc_point_stress - Case I: the stress at the sphere's surface, Boussinesq's.                               [GC] 22
 *
 *     s_zz = -3 P s / (8 pi R^2)
 *     s_rr =    P   / (8 pi R^2) [ (1-2nu) / (s^2 (1+s)) - 3 cos^2(theta/2) / s ]
 *     s_tt =    P   / (8 pi R^2) (1-2nu) [ 1/s - 1 / (s^2 (1+s)) ]         (hoop stress: not in [GC]; Boussinesq's, too)
 *     s_rz = -3 P cos(theta/2) / (8 pi R^2)
 *
 * stress         [4] out: s_zz, s_rr, s_tt, s_rz [Pa], coordinates as above; all NaN if an argument is outside its domain
 * force, theta   as above;  R   radius [m]; INFINITY gives 0;  nu   Poisson's ratio in [0, 0.5]
 * Worst error 12 ulp of the sum of the absolute terms.
 */
NLC_API void nlc_point_stress(double stress[4], double force, double theta, double R, double nu);

/*
 * nlc_point_traction - Case I: the traction that holds the sphere against the force.                      [GC] 2, 23
 *
 *     t_z = -3 P s / (8 pi R^2)
 *     t_r =    P   / (8 pi R^2) [ 2 (1-2nu) / (tan(theta/2) (1+s)) - 3 cos(theta/2) ]
 *
 * This is t = n.sigma, by which the removed rest of the half-space acts on the sphere: its resultant over the sphere is -P
 * along z.  It departs from [GC] twice.  Their Eq. 20 says q = -n.sigma, but the z component of their 2 and 23 is that of
 * +n.sigma, which is also what can hold the sphere.  Their radial component is misprinted, P/(8 pi R^2) [ (1-2nu) / (2
 * tan(theta/2) (1+s)) - (3/2) cos(theta/2) ]: a quarter of the first term and half of the second one.  Their stresses (22,
 * which are right) give the one above; the resultant does not show it.
 *
 * traction       [2] out: t_z, t_r [Pa], coordinates as above; both NaN if an argument is outside its domain
 * force, theta, R, nu   as for nlc_point_stress
 * Worst error 11 ulp: of t_z, and of t_r's sum of the absolute terms.
 */
NLC_API void nlc_point_traction(double traction[2], double force, double theta, double R, double nu);

/*
 * nlc_love_displacement - Case II: Love's displacement in a half-space under Hertz pressure on a circle.     [GC] 26, 28-29
 *
 *     u_z =  (1+nu) / (2 pi E) [ 2(1-nu) V - z dV/dz ]
 *     u_r = -(1+nu) / (2 pi E) [ (1-2nu) dchi/dr + z dV/dr ]
 *
 * with the potentials V and chi of the pressure (3P / 2 pi a^2) sqrt(1 - r^2/a^2).  They are evaluated in another form than
 * printed one, which loses all digits for small circles and near the axis.  Origin at the centre of the circle, z into the
 * body, r from the axis.
 *
 * displacement   [2] out: u_z, u_r [m]; both NaN if an argument is outside its domain
 * force          P, compressive > 0, any sign [N]
 * radius         a >= 0, finite [m]; 0 is Boussinesq's point force
 * r, z           the point, >= 0, finite [m]; not both 0 if the radius is
 * E, nu          Young's modulus [Pa] (INFINITY gives 0), Poisson's ratio
 * On the surface inside the circle u_z is nlc_contact_displacement.  Worst error 27 ulp: of u_z, and of u_r's sum of the two
 * absolute terms.
 */
NLC_API void nlc_love_displacement(double displacement[2], double force, double radius, double r, double z, double E, double nu);

/*
 * nlc_love_stress - Case II: Love's stress in a half-space under Hertz pressure on a circle.                 [GC] 27-29
 *
 *     s_zz = 1/(2 pi) [ dV/dz - z d2V/dz2 ]                      s_rz = -z/(2 pi) d2V/drdz
 *     s_rr = 1/(2 pi) [ 2 nu dV/dz - (1-2nu) d2chi/dr2   - z d2V/dr2   ]
 *     s_tt = 1/(2 pi) [ 2 nu dV/dz - (1-2nu) (dchi/dr)/r - z (dV/dr)/r ]                (hoop stress: not in [GC])
 *
 * stress   [4] out: s_zz, s_rr, s_tt, s_rz [Pa], tension > 0; all NaN if an argument is outside its domain
 * force, radius, r, z   as for nlc_love_displacement;  nu   Poisson's ratio in [0, 0.5]
 * Worst error 28 ulp: of s_zz and s_rz; of s_rr and s_tt in units of the sum of their value at nu = 1/2 and of
 * (1-2nu)/(2 pi) (dchi/dr)/r, which is by how much (1-2nu) moves them at most.
 */
NLC_API void nlc_love_stress(double stress[4], double force, double radius, double r, double z, double nu);

/*
 * nlc_love_nonlocal_displacement - Case II: normal displacement of a sphere's surface caused by Hertz pressure elsewhere on
 * it.                                                                                                     [GC] 26, 28-29
 *
 * The counterpart of nlc_nonlocal_displacement for a circle of radius a: w = n.u, Love's displacement at (z, r) = (2 R s^2,
 * R sin(theta)), s = sin(theta/2), along the sphere's normal n = (-cos(theta), sin(theta)).  It tends to Case I as a -> 0:
 * for a < R s they differ by less than (a/2Rs)^2/2 of the sum of Case I's absolute terms.
 *
 * force    P, compressive > 0, any sign [N]
 * radius   a >= 0, finite [m]; 0 is nlc_nonlocal_displacement
 * theta    0 <= theta <= pi [rad], 0 only if a > 0.  Where the circle reaches the point, about theta < a/R, this is still
 *          Love's value there (finite, and no longer the displacement of a sphere)
 * R, E     radius and Young's modulus [m, Pa]; INFINITY gives 0, as for nlc_nonlocal_displacement;  nu   Poisson's ratio
 * Returns w [m], > 0 outward.  Worst error 21 ulp of |u_z| + sin(theta) times the sum of u_r's two absolute terms.
 */
NLC_API double nlc_love_nonlocal_displacement(double force, double radius, double theta, double R, double E, double nu);

/*
 * nlc_sphere_green - normal displacement of an elastic sphere's surface caused by a point force on it, exactly.
 *
 *     S = sum over n of s_n P_n(cos theta),   s_n = (2n+1) [2(1-nu) n^2 + nu n - (1-2nu)] / { (n-1) [n^2 + (1+2nu) n + 1+nu] }
 *     for n != 1,   s_1 = 9(1-2nu) / (5(1+nu))
 *
 * The modes of linear elasticity, no approximation.  s_1 makes it the displacement relative to the centre of mass, whether the
 * forces on the sphere balance, accelerate it or are balanced by a uniform body force such as its weight.  At small angles
 * S = 2(1-nu)/s - 2(1-2nu)^2 ln s + ..., s = sin(theta/2).
 *
 * theta   angle, seen from the centre, between the force and the point looked at, 0 < theta <= pi [rad]
 * nu      Poisson's ratio, 0 <= nu <= 0.5
 * Returns S, > 0 inward, in units of U = P / (8 pi mu R) = (1+nu) P / (4 pi R E).  It changes sign, so accuracy is that of its
 * largest term: worst error 2e-13 / s.
 */
NLC_API double nlc_sphere_green(double theta, double nu);

/*
 * nlc_sphere_finite_size - what the size of a contact changes in that, to second order in its radius a.
 *
 *     D = (lap + 2) S - chi (4 S + 2 lap B)
 *
 * lap is the Laplacian on the unit sphere, U grad B the tangential displacement by a point force.  The force P spread as Hertz'
 * pressure over a contact of radius a moves the surface elsewhere by U [S + (a/R)^2 D/10], and its mean over another contact
 * of radius a', as it counts for that one's force, by U [S + (a^2 + a'^2)/(10 R^2) D].
 *
 * theta, nu   as for nlc_sphere_green
 * chi         tilt of the traction, 0 <= chi <= 1e60: 1 where it acts along the axis of the contact, as between equal spheres and
 *             on a rigid plate, 0 where it is normal to the sphere.  Of side k of a contact of unequal ones,
 *             chi = (q_k / sum q) (R_k / R_eff), q = (1-nu^2)/E, 1/R_eff = sum of 1/R.  D is linear in it.
 * Returns D.  Worst error 3e-13 (1 + chi) / s^3, s = sin(theta/2).
 */
NLC_API double nlc_sphere_finite_size(double theta, double nu, double chi);

/*
 * nlc_sphere_self - displacement of a contact by its own force, beyond that on a half-space.
 *
 *     S1 = Z + (7/6) al t + [ (4/3) be ln t + be/6 + (4/3) ga ] t^2
 *
 * To second order in t = a/R: the approach of the sphere's centre of mass and a rigid plate is a^2/R + a^4/(15 R^3) + U S1, a
 * being the radius by Hertz' law.  Z, al, be and ga depend on nu and chi (lib/sphere_prepare.c); Z = -2(1-2nu)^2 ln t + ....  For
 * chi = 1 the traction is that of a rigid plate or an equal sphere to this order; for other chi the tilt is taken as chi at every
 * distance from the contact's centre, which is its leading order.
 *
 * t         contact radius / radius of the sphere, 0 < t <= 1
 * nu, chi   as for nlc_sphere_finite_size
 * Returns S1, > 0 into the body, in units of U.  Worst error 6e-15 (1 + chi^2) (1 + |ln t|).
 */
NLC_API double nlc_sphere_self(double t, double nu, double chi);

/*
 * nlc_sphere_self_energy - the energy that goes with it, Sbar: U P Sbar / 2, so that S1 = Sbar + (t/6) dSbar/dt.
 *
 *     Sbar = Z + (1-2nu)^2 / 3 + al t + (be ln t + ga) t^2
 *
 * t, nu, chi   as for nlc_sphere_self
 * Returns Sbar.  Worst error 6e-15 (1 + chi^2) (1 + |ln t|).
 */
NLC_API double nlc_sphere_self_energy(double t, double nu, double chi);

/*
 * nlc_sphere_displacement - the counterpart of nlc_nonlocal_displacement on the exact sphere.
 *
 *     w = -(1+nu) P / (4 pi R E) S(theta, nu)
 *
 * force, theta, R, E, nu   as for nlc_nonlocal_displacement
 * Returns w [m], > 0 outward, relative to the centre of mass.  Worst error 2e-13 / s times the factor before S, s = sin(theta/2).
 */
NLC_API double nlc_sphere_displacement(double force, double theta, double R, double E, double nu);

/* ------------------------------------------------------------------------------------------------------------ objects --
 *
 * Structs begin with their size, so that a program built against an older header runs with a newer library and the other
 * way round: set struct_size = sizeof the struct and zero the rest.  A shorter struct is taken as if zeros followed (a field
 * that is cut in two counts as absent); in a longer one the bytes beyond this version's fields must be zero.
 */

/* Elastic constants of one material. */
typedef struct nlc_material {
    double young;   /* Young's modulus > 0 [Pa]; INFINITY: rigid */
    double poisson; /* Poisson's ratio, 0 <= nu <= 0.5; not looked at where rigid */
} nlc_material;

/*
 * The caller's particles.  Read by nlc_network_init only, and not kept.
 *
 * Flat walls are particles of infinite radius at the end of the list: index count + w is wall w.  They have no rows in the
 * particle arrays.
 */
typedef struct nlc_particles {
    size_t struct_size;             /* sizeof(nlc_particles) */
    int64_t count;                  /* particles; count + wall_count <= 2^31 - 1 */
    const double *radius;           /* [count] > 0, finite [m] */
    ptrdiff_t radius_stride;        /* bytes from one radius to the next; 0: packed */
    const int32_t *material;        /* [count] index into materials; NULL: all 0 */
    ptrdiff_t material_stride;      /* bytes from one index to the next; 0: packed */
    const nlc_material *materials;  /* [material_count]; only those in use are looked at */
    int64_t material_count;         /* >= 1 if there is a particle or a wall */
    size_t material_size;           /* sizeof(nlc_material) in the caller's header; 0: that of 0.1, 16 */
    const int32_t *wall_material;   /* [wall_count] index into materials; NULL: all 0 */
    int64_t wall_count;             /* flat walls */
} nlc_particles;

/* How the surface of a grain answers to a force.  0 is the default, for good. */
enum {
    NLC_MODEL_GONZALEZ_CUITINO = 0, /* point force on a sphere cut from a half-space ([GC] 5, Case I) */
    NLC_MODEL_HERTZ = 1,            /* no coupling: the classical law */
    NLC_MODEL_HALF_SPACE = 2,       /* MC-DEM: [MC] 1 times the prefactor, at the contact points of options.points */
    NLC_MODEL_LOVE = 3,             /* Hertz pressure on a half-space ([GC] 26-29, Case II) */
    NLC_MODEL_SPHERE = 4,           /* the exact elastic sphere to second order in contact radius / radius */
    NLC_MODEL_POINT_FORCE = 5       /* point force on the exact elastic sphere, without what it does to its own contact */
};

/* Where the contact points of NLC_MODEL_HALF_SPACE are. */
enum {
    NLC_POINTS_DEFORMED = 0,  /* on the displaced surfaces, midway between them where they overlap ([MC] III) */
    NLC_POINTS_UNDEFORMED = 1 /* on the undeformed spheres: NLC_MODEL_GONZALEZ_CUITINO times the prefactor */
};

/* How the coupled equations are solved. */
enum {
    NLC_METHOD_AUTOMATIC = 0,  /* the library's choice: accelerated, with a proved bound of the error's amplification */
    NLC_METHOD_FIXED_POINT = 1 /* [GC] Algorithm 1 with its erratum mended */
};

/*
 * Which variant of the inner loops is used.  Only NLC_MODEL_GONZALEZ_CUITINO and NLC_MODEL_HALF_SPACE at NLC_POINTS_UNDEFORMED have
 * others than portable C.  Results differ by rounding only: displacements on a particle with Z contacts by at most 2 Z 2^-53 of the
 * sum of their absolute terms.  Where the processor, its operating system or the compiler of the library lacks the one asked for,
 * the next lower one is used, portable C in the end.
 */
enum {
    NLC_SIMD_BEST = 0,    /* the best that this processor has */
    NLC_SIMD_GENERIC = 1, /* portable C */
    NLC_SIMD_AVX2 = 2,    /* x86-64 with AVX2 and FMA */
    NLC_SIMD_AVX512 = 3,  /* x86-64 with AVX-512F */
    NLC_SIMD_NEON = 4     /* AArch64 */
};

/*
 * The host's threads: calls task(work, k) once for each k = 0 ... count-1, in any order and by any of its threads, and returns when
 * all have returned.  What a task writes before has to be seen after, as it is by any pool's join or barrier.  Threads with
 * floating-point traps or another rounding than the caller's give what those give.
 */
typedef void (*nlc_parallel_callback)(void *context, void (*task)(void *work, int64_t k), void *work, int64_t count);

/*
 * Networks shared out among ranks, such as the processes of an MPI program.
 *
 * Each particle is owned by one rank.  A rank's network has the particles that it owns, numbers 0 ... owned_particles - 1, then
 * ghosts: those owned elsewhere that touch one of its own, with their radii and materials; then walls.  It has all contacts of the
 * particles that it owns and no others, so that one between particles of two ranks is on both: each rank computes the
 * displacements of the sides on its own particles, the callback exchange brings those on ghosts, and both find the same force.
 * Overlaps, normals and options.stiffness of such a contact have to be the same on both, to rounding; which particle is called i
 * may differ.  A rank may be without contacts or particles, and takes part in all calls nonetheless.
 *
 * With callbacks nlc_solve, nlc_sweep, nlc_energy, nlc_tangent, nlc_tangent_inverse and nlc_tangent_bound are collective: all ranks
 * call them together, with the same model, points, method, tolerance, max_sweeps and prefactor, on the same kind of
 * processor, and all return together.  Where the arguments of one are wrong it returns its error and the others return
 * NLC_ERROR_REMOTE; only without a valid network it cannot tell them.  No other function calls a callback: what
 * nlc_network_init says to one rank the host has to tell the others.
 *
 * The callbacks are called in turn by all ranks alike: exchange, reduce with sums, reduce with maxima, exchange ..., each always with
 * the same count.  They return 0, or any other number where they fail.  Then that rank returns NLC_ERROR_CALLBACK and the others
 * NLC_ERROR_REMOTE after at most two more reductions, and an exchange between them if it is due; only a failure of the very last
 * call comes too late for the others, which return what they have found.  A callback that brings a number that is not finite (but
 * for a largest value, which may be infinite) has failed, too, with 0 for what it returned; so has an exchange that brings a larger
 * one than any owner can have (in an iteration's own units 2^450, else 2^1020).  Other wrong numbers give wrong results, which are
 * finite.
 *
 * All ranks make the same calls, however many of these fail and where, but for one case: where two reductions in a row fail on one
 * rank, and an error elsewhere has become known in the first of them, that rank calls reduce, and exchange if it is due, once
 * more than the others, which have returned.  So a callback that fails twice in a row is not to wait for others any more.  (Nobody
 * who hears nothing can know whether the others have heard: no protocol that ends is without such a case.)
 */

/*
 * side   [contacts][2] in-out: on i's side, on j's side, as nlc_sweep's displacement.  The values of sides on ghosts are to be
 *        replaced by those that the ghost's owner has for the same side of the same contact.  They are
 *        displacements, but also other numbers that belong to the side's particle.
 */
typedef int (*nlc_exchange_callback)(void *context, double *side);

/*
 * values   [count] in-out: to be replaced by their sums or maxima over all ranks, by the same bits on all of them: what
 *          MPI_Allreduce in place does.  A few dozen.
 */
typedef int (*nlc_reduce_callback)(void *context, double *values, int32_t count, int32_t operation);

/* What reduce is asked for. */
enum {
    NLC_REDUCE_SUM = 0, /* the sum over all ranks */
    NLC_REDUCE_MAX = 1  /* the largest of all ranks */
};

/* Options of a network.  0 is the default of every field; a NULL pointer to options means all defaults. */
typedef struct nlc_options {
    size_t struct_size;      /* sizeof(nlc_options) */
    int32_t model;           /* NLC_MODEL_..., see nlc_model_info */
    int32_t method;          /* NLC_METHOD_...: how much memory a network takes, too, see nlc_network_size */
    double tolerance;        /* of the forces, see nlc_solve; 0: 1e-8; more than 1 counts as 1 */
    int64_t max_sweeps;      /* of a solve, which never does more (on ranks 2, where this is 1); 0: 1000 */
    double prefactor;        /* G of NLC_MODEL_HALF_SPACE, from 2^-100 to below 2^100; other models do not look at it; 0: 1 */
    int32_t simd;            /* NLC_SIMD_... */
    int32_t points;          /* NLC_POINTS_... of NLC_MODEL_HALF_SPACE, other models do not look at it */
    const double *stiffness; /* [contacts] k of P = k x^(3/2) for hosts with a law of their own; NULL: n_H.  Copied. */
    void *cache;             /* [cache_size] bytes for coefficients, aligned to 8; NULL: they are computed in each sweep.  Kept */
    size_t cache_size;       /*     as long as the network, its contents from call to call are not.  See nlc_cache_size */
    nlc_parallel_callback parallel_for; /* for sweeps and solves; NULL: the calling thread does everything.  The results are the same */
    void *parallel_context;  /*     bits whatever it does; below some 10,000 contacts threads have nothing to share */
    int64_t owned_particles; /* the particles that are no ghosts, the first ones; 0: all */
    nlc_exchange_callback exchange; /* both or none */
    nlc_reduce_callback reduce;
    void *context;           /* for the callbacks */
    const void *reserved;    /* NULL */
} nlc_options;

/*
 * What happened.  Never a result: it is written whatever the status, up to the smaller of struct_size and this version's
 * size; bytes beyond are zeroed.  A NULL pointer to info is allowed everywhere.  Set struct_size before the call: without it
 * nothing can be written, and NLC_ERROR_STRUCT_SIZE is returned.
 */
typedef struct nlc_info {
    size_t struct_size;     /* in: sizeof(nlc_info) */
    int64_t culprit;        /* on error, what is wrong: see NLC_STATUS_LIST; else -1 */
    int64_t sweeps;         /* multiplications by the coupling matrix done */
    double residual;        /* estimated error: largest |P_c - exact_c| / largest force on either of c's two particles */
    int64_t worst_contact;  /* where that is; -1: nowhere */
    int64_t active;         /* contacts with a force > 0 */
    double lambda_lower;    /* the largest eigenvalue of the tangent coupling lies between these two, see nlc_solve; where */
    double lambda_upper;    /* nothing asked for them they are -INFINITY and INFINITY */
    int64_t critical_particle; /* the particle that decides the upper one; -1: none */
    double coupling;        /* smallest factor t of a particle's coupling: 1 unless weakened */
    int64_t weakest_particle; /* where that is; -1: nowhere */
    int64_t weakened;       /* particles with t < 1 */
    int64_t blocks;         /* particles whose coefficients were computed for the upper bound: work beside the sweeps */
    int64_t left_out;       /* contacts left out of the iteration: without force, or not moved by any other force */
    int64_t clusters;       /* unconnected parts that were solved apart, each with its own number of sweeps: the most counts */
    int64_t settled;        /* contacts in the region that was solved for first since forces changed only there, in sweeps of its own */
                            /*     that are not counted; 0: everywhere */
} nlc_info;

/* What there is to know of a model.  Set struct_size before the call. */
typedef struct nlc_model_record {
    size_t struct_size;    /* in: sizeof(nlc_model_record) */
    const char *name;      /* short, as on a command line; the strings are constant, never NULL and end with the program */
    const char *reference; /* authors, year, equations: please cite it */
    const char *doi;       /* of it; empty: none */
    const char *validity;  /* how far off the forces are, and where */
    int32_t symmetric;     /* 1: a change of one force moves another contact as that one's would move the first; 0: not so */
    int32_t potential;     /* 1: the forces have an energy: nlc_energy, nlc_tangent and its companions; 0: NLC_ERROR_NO_POTENTIAL */
    int32_t self_term;     /* 1: a contact's own force moves it beyond Hertz' law */
    int32_t circles;       /* 1: the size of the contact circles counts */
    double cost;           /* time of a sweep in units of NLC_MODEL_GONZALEZ_CUITINO's, about: measured */
} nlc_model_record;

/*
 * nlc_model_count - how many models there are: their numbers are 0 ... count-1.
 *
 * Returns the number, that of the library that is running; a newer one may have more.
 */
NLC_API int32_t nlc_model_count(void);

/*
 * nlc_model_info - a row of the table of models.
 *
 * model     NLC_MODEL_..., or any number below nlc_model_count
 * record    out, up to the smaller of record->struct_size and this version's size; bytes beyond are zeroed
 * info      or NULL
 * NLC_MODEL_HALF_SPACE is described at deformed contact points; at undeformed ones it is symmetric and has an energy.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _MODEL.
 */
NLC_API nlc_status nlc_model_info(int32_t model, nlc_model_record *record, nlc_info *info);

/*
 * nlc_model_find - the number of a model from its name.
 *
 * name    as in nlc_model_record, letter by letter; or NULL
 * Returns the number, NLC_MODEL_...; -1: there is no such model.
 */
NLC_API int32_t nlc_model_find(const char *name);

/* Who touches whom, in the caller's memory.  Opaque. */
typedef struct nlc_network nlc_network;

/*
 * nlc_network_size - bytes of memory that nlc_network_init needs.
 *
 * particles       only struct_size, count, material_count and wall_count are read
 * contact_count   contacts, candidates included, >= 0
 * options         or NULL; only struct_size, model, method, points and exchange are read
 *
 * With the default options a contact takes 377 bytes and a particle 137.  NLC_METHOD_FIXED_POINT and NLC_MODEL_HERTZ work with fewer
 * arrays: 72 and 44, which in large packings with 6 to 9 contacts on a particle is 87 to 82 bytes a contact.  Add to these
 *     8 bytes a contact with NLC_MODEL_LOVE, 16 with NLC_MODEL_HALF_SPACE at deformed contact points, 24 with NLC_MODEL_SPHERE
 *     24 a contact and 8 a particle with callbacks for ranks
 * and to all but NLC_MODEL_HERTZ's 68 bytes a contact for particles with very many of them, 12 MB at most.
 *
 * Refused for want of memory: nlc_set_options to options that need more than nlc_network_init was given;
 * nlc_tangent and nlc_tangent_bound of a coupled model without memory for the default options, with which everything is possible.
 * Returns a size that does not depend on anything else; 0 if an argument is invalid or the size overflows.  (Options that name no
 * model, method or points take as little as any: nlc_network_init says what is wrong with them.)
 */
NLC_API size_t nlc_network_size(const nlc_particles *particles, int64_t contact_count, const nlc_options *options);

/*
 * nlc_network_init - build the network: check everything, contact stiffnesses, adjacency.  To be done when the neighbour list
 * changes.
 *
 * network         out: the network, at the start of memory.  It is never freed; it must not be moved or copied.
 * memory          at least nlc_network_size bytes for these options, aligned to 8; owned by the caller, to be kept while the
 *                 network is used
 * memory_size     bytes; with as many as other options need the network can be given those later, see nlc_set_options
 * particles       see nlc_particles
 * i, j            [contact_count] the two bodies of each contact, in any order: a particle 0 ... count-1 or a wall count ...
 *                 count+wall_count-1.  i = j is a particle that touches its own periodic image.  A pair may occur any
 *                 number of times (periodic images, with different normals).  A periodic image has its owner's index.
 *                 Candidates, pairs that do not touch but may once their surfaces are displaced, belong in the list.
 * contact_count   >= 0
 * options         or NULL; copied
 * info            or NULL
 *
 * Returns NLC_OK; NLC_ERROR_NULL, _NULL_FIELD, _STRUCT_SIZE, _RESERVED, _COUNT, _STRIDE, _MEMORY_SIZE, _ALIGNMENT, _MODEL,
 * _METHOD, _OPTION, _RADIUS, _MATERIAL, _YOUNG, _POISSON, _INDEX, _WALL_WALL, _RIGID_RIGID, _STIFFNESS, _GHOST, or
 * _RANGE where a stiffness or a coupling coefficient is beyond the range of double.
 * On error memory and *network are untouched, so that a network already living there stays valid.
 */
NLC_API nlc_status nlc_network_init(nlc_network **network, void *memory, size_t memory_size, const nlc_particles *particles,
                                    const int32_t *NLC_RESTRICT i, const int32_t *NLC_RESTRICT j, int64_t contact_count,
                                    const nlc_options *options, nlc_info *info);

/*
 * nlc_set_options - replace all options of a network, as if it had been built with them.
 *
 * The memory that nlc_network_init was given has to be as much as nlc_network_size says for them; else NLC_ERROR_MEMORY_SIZE.
 * With as much as the default options need all are possible.
 *
 * network    from nlc_network_init
 * options    or NULL for the defaults; options->stiffness is [contacts]
 * info       or NULL
 * Returns NLC_OK; NLC_ERROR_NULL, _NULL_FIELD, _STRUCT_SIZE, _RESERVED, _NETWORK, _MODEL, _METHOD, _OPTION, _MEMORY_SIZE,
 * _ALIGNMENT, _STIFFNESS, _GHOST, _RANGE.
 */
NLC_API nlc_status nlc_set_options(nlc_network *network, const nlc_options *options, nlc_info *info);

/*
 * nlc_cache_size - bytes of the caller's memory in which all coefficients find place that it is quicker to keep than to compute.
 *
 * Where a solve needs several sweeps the normals are the same in all of them.  Some models then keep what depends on nothing else, if
 * they are given room by options.cache: NLC_MODEL_SPHERE and NLC_MODEL_POINT_FORCE two numbers for each two contacts of a
 * particle, about 170 bytes a contact in a dense packing, for solves in two thirds of the time, or nine tenths where it does not
 * stay in the processor's caches; NLC_MODEL_GONZALEZ_CUITINO and NLC_MODEL_HALF_SPACE at undeformed points one number, but not in
 * portable C, for solves in some six sevenths of the time as long as it does; else, and in solves of one or a few sweeps, computing is
 * quicker.  The results are the same, bit for bit.  With less room as much is kept as it holds.
 *
 * network   from nlc_network_init
 * Ask when the network has been made, and hand the memory over by nlc_set_options.  It must not be used by another network, or by
 * anything else, while a function works on this one; between calls it may be.
 * Returns the size; 0 for a model that keeps nothing, and if network is NULL or no network.
 */
NLC_API size_t nlc_cache_size(const nlc_network *network);

/*
 * nlc_solve - the coupled forces of all contacts.                                               [GC] 9, 10, Algorithm 1
 *
 *     P_c = k_c (gamma_c + g_c)_+^(3/2),   g_c = sum of the displacements that the other forces on i and on j cause at c
 *
 * network    from nlc_network_init
 * force      [contacts] out: P >= 0 [N]
 * nonlocal   [contacts] in-out: g [m], with NLC_MODEL_SPHERE what the own force adds included.  In: where to start, the values of
 *            the last step or zeros; any finite values will do.  Out: g of the forces returned,
 *            P_c = k_c (gamma_c + g_c)_+^(3/2).
 * overlap    [contacts] gamma [m], negative for candidates, whose gaps may be up to 1e100 times the largest overlap
 * normal     [contacts][3] unit vectors from i to j (into the wall), | |n|^2 - 1 | <= 1e-6, used as given
 * info       or NULL: all fields
 *
 * Tolerance: |P_c - exact_c| <= options.tolerance times the largest force on either of c's two particles, exact being the
 * solution that is continuously connected to zero load.  Such a solution exists up to a load at which lambda, the largest
 * eigenvalue of D^1/2 C D^1/2 (C the coupling, D the slopes dP/dx of the contacts), reaches 1; errors are amplified by
 * 1/(1 - lambda) on the way there.  The default method stops when a residual over 1 - info.lambda_upper says that the tolerance
 * is met, lambda_upper being a proved bound (on particles with more than 64 contacts with a force, an estimate by Lanczos'
 * method); info.residual is that estimate of the error.  On particles whose forces are all below 1e-15 of the largest of all,
 * forces may be off by that much: what is left of them is rounding.
 *
 * Particles with very many contacts.  What one contact does to another is not computed pair by pair where a particle has more
 * than about 450 p contacts, p from 4 (tolerance 1e-2) through 11 (1e-8) to 18 (4e-14), or more than 127 in NLC_MODEL_SPHERE:
 * there groups of contacts that are far from each other are interpolated, and the work grows like the number of contacts.
 * Displacements are then off by at most half the tolerance times the sum of their absolute terms (found: 0.4 of it on contacts
 * heaped up to 2^-45, 0.08 on others, 0.003 where contacts are spread evenly), the coupling stays symmetric to rounding, and forces
 * are well within the tolerance.  All pairs are looked at in NLC_MODEL_LOVE and NLC_MODEL_HALF_SPACE at deformed contact points,
 * which know no such groups, at lower tolerances, and where | |n|^2 - 1 | exceeds a third of the tolerance.
 *
 * Beyond the end of the stable branch (lambda_upper > 0.985) the coupling of the particles that need it is weakened,
 * C = sum of t_k C_k with t_k = min(1, 0.985 / b_k), b_k a bound that looks at the particle and at most 17 neighbours in any
 * direction: NLC_WARNING_WEAKENED, info.coupling, .weakest_particle and .weakened.  The forces are finite and continuous in the
 * overlaps; there is no energy.
 *
 * Work is done only where there is something to solve for: not on contacts without force, on pairs that no other force moves, or
 * on rigid and flat sides (info.left_out); where forces change in a small part of the scene only, that is solved for first
 * (info.settled) and the whole with little to do from there; clusters of contacts that no yielding particle joins are solved
 * apart (info.clusters), and what overlaps in one changes no bit in another; and a scene so loose that Hertz's forces can be
 * proved to be within the tolerance is not solved for at all: then sweeps = 0, residual is the proved error, and nonlocal 0.
 * (That is decided for the scene as a whole, as is which candidates are looked at when all of nonlocal[] is 0: another cluster that
 * makes the difference there may move forces, within the tolerance.)  Displacements of the last steps that are good enough already
 * cost one sweep and no more: a step of a slowly moving scene is about twice as dear as its sweep.
 *
 * Models.  In NLC_MODEL_SPHERE the coefficients depend on the forces, but there is an energy, and all of the above holds with the
 * coupling of its tangent in the place of C, what a contact's force does to the contact itself included, as long as no
 * overlap plus displacement exceeds the radius of the smaller particle.  Circles are taken for no larger than they are then: beyond, forces
 * have no energy, and a solve, weakened or not, may end with NLC_WARNING_NOT_CONVERGED and _CLOSE (found at overlaps of 20 % of
 * R_i + R_j and more).  NLC_MODEL_LOVE and
 * NLC_MODEL_HALF_SPACE at deformed contact points have neither an energy nor a symmetric tangent: they are solved by
 * Anderson's method, residual is an estimate from the steps taken (3 times the last change of the forces, times the largest
 * amplification met), lambda_lower and lambda_upper stay infinite unless it was weakened, and whether the state counts as
 * stable, and how far the coupling is weakened, is decided by the coefficients of NLC_MODEL_GONZALEZ_CUITINO (times the
 * prefactor), whose limit for small circles and displacements they are.  Weakened, the half-space is taken at undeformed points; where it finds no
 * solution at deformed ones although those are stable, it returns theirs with NLC_WARNING_NOT_CONVERGED.  It is also solved in
 * one piece, not cluster by cluster, and the displacements of the two sides are found anew in each solve, in as many sweeps.
 *
 * NLC_METHOD_FIXED_POINT is [GC] Algorithm 1, for reference.  Erratum mended: as printed it adds each sweep's displacements to
 * those of the sweep before; here each sweep starts from zero, as [GC] 9 has it.  It estimates its error from the rate at
 * which it converges (found: true errors of 1.2 times the tolerance, once in a thousand solves), gives no bounds of lambda, and
 * where it does not converge returns the best forces met.
 *
 * Contacts of one particle so close together that their circles of contact overlap (R |N_c - N_d| < a_c + a_d, one that is
 * pushed open counting with the circle that it would have alone) are outside the validity of the model, and can have several
 * solutions; which one is found may depend on nonlocal[]: NLC_WARNING_CLOSE.
 * So can contacts further apart where the host makes the coupling stronger than elasticity has it, by options.stiffness well
 * above n_H or a prefactor above 1: there, too, the solution is stable and within the tolerance of an exact one, but it need not
 * be the one connected to zero load.
 * Exchanging i and j of a contact with its normal reversed changes no bit of the results; reordering the contacts changes
 * the last bits.
 *
 * Networks shared out among ranks are solved in one piece: nothing is left out of the iteration, no region is solved for first, and
 * starts of contacts that push each other open may find another one of several solutions.  Status, sweeps,
 * residual, the bounds of lambda and the counts in info are those of the whole; an index in info is told by the rank
 * that has it, and is -1 on the others.  The callback exchange is called once a sweep, and besides to begin, to judge and to end:
 *     4 times in all for a start that is the solution already, else up to 12 times more than there are sweeps;
 *     up to 17 times more each time that lambda has to be bounded closely: near 1, and on particles with more than 64 contacts;
 *     21 times a sweep where the coupling is weakened; twice a sweep by NLC_METHOD_FIXED_POINT.
 *
 * Returns NLC_OK; NLC_WARNING_NOT_CONVERGED, _WEAKENED, _ROUNDING, _CLOSE, or several of them added;
 * NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _OVERLAP, _NORMAL, _NONLOCAL, _COINCIDENT, _RANGE; on ranks _OPTION (theirs differ),
 * _REMOTE, _CALLBACK.
 */
NLC_API nlc_status nlc_solve(nlc_network *network, double *NLC_RESTRICT force, double *NLC_RESTRICT nonlocal,
                             const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info);

/*
 * nlc_predict - a better start for the next nlc_solve of a scene that moves steadily: extrapolates the nonlocal displacements.
 *
 *     nonlocal + ratio (nonlocal - previous),  and previous becomes what nonlocal was
 *
 * nonlocal   [count] in-out: those of the last step, out: the start for the next one [m]
 * previous   [count] in-out: those of the step before the last [m].  In the first step, and when the contacts have been
 *            renumbered, copy nonlocal into it: then nothing is extrapolated.
 * count      contacts
 * ratio      of the coming step's length in time to the last one's; 1 for equal steps
 * info       or NULL
 * The start decides how many sweeps are needed, not which forces are found.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _COUNT, _NONLOCAL (a value of either array that is not finite), _OPTION (ratio
 * is not finite), _RANGE.
 */
NLC_API nlc_status nlc_predict(double *NLC_RESTRICT nonlocal, double *NLC_RESTRICT previous, int64_t count, double ratio,
                               nlc_info *info);

/*
 * nlc_sweep - displacements of the surfaces under given forces: one multiplication by the coupling matrix.      [GC] 5, 9
 *
 * For codes that want one lagged sweep a step, their own solver, or communication between sweeps.
 *
 * network        from nlc_network_init
 * displacement   [contacts][2] out: on i's side, on j's side [m], > 0 outward; their sum is g.  0 on walls and rigid bodies.
 *                NLC_MODEL_HALF_SPACE at deformed contact points: in-out, these are the displacements by which they are deformed
 *                (those of the last sweep; zeros are undeformed surfaces)
 * force          [contacts] any finite values [N], negative for adhesion: where circles of contact count, a pull acts on a point
 * overlap        [contacts]; NULL is allowed unless the model is NLC_MODEL_HALF_SPACE at deformed contact points
 * normal         [contacts][3] as for nlc_solve
 * info           or NULL
 * In models in which the circles of contact count their radii are those of the forces, at most that of the smaller particle.
 * On particles with very many contacts displacements are exact to half the tolerance only, see nlc_solve.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _OVERLAP, _NORMAL, _NONLOCAL (displacement), _FORCE, _COINCIDENT,
 * _RANGE; on ranks, where sides on ghosts get what their owners find, _OPTION, _REMOTE, _CALLBACK.
 */
NLC_API nlc_status nlc_sweep(nlc_network *network, double *NLC_RESTRICT displacement, const double *NLC_RESTRICT force,
                             const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info);

/*
 * nlc_energy - elastic energy of a solution: its derivative by an overlap is the force there.
 *
 *     E = gamma.P + P.C.P / 2 - sum (3/5) P (P/k)^(2/3)
 *
 * (NLC_MODEL_SPHERE: what takes the place of P.C.P / 2 has the terms of a finite contact, too.)
 *
 * network    from nlc_network_init
 * energy     out [J]
 * force      [contacts] P >= 0 of nlc_solve [N].  Their error enters by its square.
 * overlap    [contacts] those that nlc_solve was given [m]
 * normal     [contacts][3] likewise
 * info       or NULL: residual, worst_contact: by how much the forces miss [GC] 10
 * Only a converged solution with its full coupling has an energy: forces from a lagged sweep or a weakened state give
 * NLC_WARNING_NOT_CONVERGED.
 * NLC_MODEL_LOVE and NLC_MODEL_HALF_SPACE at deformed contact points have no energy: NLC_ERROR_NO_POTENTIAL.
 * Returns NLC_OK; NLC_WARNING_NOT_CONVERGED; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _NO_POTENTIAL, _FORCE, _OVERLAP, _NORMAL,
 * _COINCIDENT, _RANGE; on ranks, where it is the energy of them all, _OPTION, _REMOTE, _CALLBACK.
 */
NLC_API nlc_status nlc_energy(nlc_network *network, double *NLC_RESTRICT energy, const double *NLC_RESTRICT force,
                              const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info);

/*
 * nlc_tangent - change of the forces for a small change of the overlaps at fixed normals, dP = (D^-1 - C)^-1 dgamma over the
 * contacts with P > 0, D = dP/dx of each contact's own law.  Symmetric, positive definite on the stable branch.
 *
 * network     from nlc_network_init
 * dforce      [contacts] out [N]; 0 where P = 0
 * doverlap    [contacts] any finite values [m]
 * force       [contacts] P >= 0 of nlc_solve [N]: the state
 * normal      [contacts][3] as for nlc_solve
 * info        or NULL: sweeps, residual (of the linear equations, relative)
 * Solved by conjugate gradients to a residual of a tenth of the tolerance; without a coupling at once.  NLC_ERROR_UNSTABLE: the
 * state is beyond the end of the stable branch, noticed only if doverlap excites the unstable mode; nlc_tangent_bound notices it
 * always.
 * NLC_ERROR_MEMORY_SIZE: the network is coupled and has less memory than the default options need, see nlc_network_size.
 * Returns NLC_OK; NLC_WARNING_NOT_CONVERGED; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _NO_POTENTIAL, _MEMORY_SIZE, _OVERLAP
 * (doverlap), _FORCE, _NORMAL, _COINCIDENT, _RANGE, _UNSTABLE; on ranks _OPTION, _REMOTE, _CALLBACK.
 */
NLC_API nlc_status nlc_tangent(nlc_network *network, double *NLC_RESTRICT dforce, const double *NLC_RESTRICT doverlap,
                               const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info);

/*
 * nlc_tangent_inverse - the inverse, dgamma = (D^-1 - C) dP: one sweep.
 *
 * doverlap    [contacts] out [m]; 0 where P = 0
 * dforce      [contacts] any finite values [N]; taken as 0 where P = 0
 * network, force, normal, info   as for nlc_tangent
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _NO_POTENTIAL, _FORCE (force or dforce), _NORMAL, _COINCIDENT, _RANGE;
 * on ranks _OPTION, _REMOTE, _CALLBACK.
 */
NLC_API nlc_status nlc_tangent_inverse(nlc_network *network, double *NLC_RESTRICT doverlap, const double *NLC_RESTRICT dforce,
                                       const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info);

/*
 * nlc_tangent_bound - an upper bound of the tangent stiffness on each particle, for the time step of an explicit integrator.
 *
 * network      from nlc_network_init
 * stiffness    [particles] out: K_k, the sum over k's contacts of a bound of the contact's tangent stiffness [N/m].  With
 *              masses m the highest frequency satisfies omega^2 <= max over particles of 2 K_k / m_k.
 * force        [contacts] P >= 0 of nlc_solve [N]: the state
 * normal       [contacts][3] as for nlc_solve
 * info         or NULL: lambda_upper, critical_particle, blocks
 * NLC_ERROR_MEMORY_SIZE: as for nlc_tangent.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _NO_POTENTIAL, _MEMORY_SIZE, _FORCE, _NORMAL, _RANGE, _UNSTABLE (not
 * proved to be stable; so are equal directions), _COINCIDENT (instead of that in NLC_MODEL_SPHERE, whose state takes a sweep); on ranks, where that
 * of ghosts is 0, _OPTION, _REMOTE, _CALLBACK.
 */
NLC_API nlc_status nlc_tangent_bound(nlc_network *network, double *NLC_RESTRICT stiffness, const double *NLC_RESTRICT force,
                                     const double *NLC_RESTRICT normal, nlc_info *info);

/*
 * nlc_assemble - add the contact forces to the forces on the particles: F[i] -= P n, F[j] += P n.
 *
 * network    from nlc_network_init
 * F          [particles][3] in-out [N]
 * F_stride   bytes from one particle's force to the next; 0: packed, 24
 * F_wall     [walls][3] in-out [N], or NULL
 * force      [contacts] any finite values [N]
 * normal     [contacts][3] as for nlc_solve
 * info       or NULL
 * A particle's contact with itself (i = j) adds nothing.  Exchanging i and j of a contact with its normal reversed changes
 * no bit.  On ranks ghosts get what the contacts here add: their owners have all of it.  NLC_ERROR_RANGE: the sum of all magnitudes
 * might exceed the range of double.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _STRIDE, _FORCE, _NORMAL, _TOTAL_FORCE, _RANGE.
 */
NLC_API nlc_status nlc_assemble(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride,
                                double *NLC_RESTRICT F_wall, const double *NLC_RESTRICT force,
                                const double *NLC_RESTRICT normal, nlc_info *info);

/*
 * nlc_assemble_turning - adds what the energy of nlc_energy does to particles beyond nlc_assemble: forces across the contacts, since
 * the coupling depends on the angles between them, and these change as contacts turn.
 *
 *     F -= P.(dC/dx).P / 2
 *
 * Added to the forces of nlc_assemble it makes them the derivative of nlc_energy by the positions, so that a host without damping
 * keeps its energy.  In three dense packings it is 0.4 to 1.3 % of the mean contact force on average, up to 6 % on single particles.
 * [GC] and [MC] leave it out.
 *
 * network    from nlc_network_init, with a model that has an energy
 * F          [particles][3] in-out [N]
 * F_stride   bytes from one particle's force to the next; 0: packed, 24
 * force      [contacts] P of nlc_solve [N], converged and not weakened: others have no energy
 * overlap    [contacts] those of the forces [m]; the centres of two particles are R_i + R_j - gamma apart
 * normal     [contacts][3] as for nlc_solve
 * info       or NULL
 * Contacts with walls and of a particle with itself (i = j) do not turn.  The sum of what is added is 0.
 * On ranks each adds what the energies of the particles that it owns do, to ghosts as well: what those have got is to be sent to
 * their owners and added there.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _NO_POTENTIAL, _STRIDE, _FORCE, _NORMAL, _TOTAL_FORCE, _OVERLAP (or one of
 * R_i + R_j and more), _COINCIDENT (directions within 2^-50), _RANGE.
 */
NLC_API nlc_status nlc_assemble_turning(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride,
                                        const double *NLC_RESTRICT force, const double *NLC_RESTRICT overlap,
                                        const double *NLC_RESTRICT normal, nlc_info *info);

/*
 * nlc_assemble_sliding - the same with saturated friction where contacts slide, and its torques at the contact points of deformed
 * particles.                                                                                               [MC] III, IV
 *
 *     F[i] += -P n + mu P t        torque[i] += rho_i n x (mu P t)           rho_i = R_i + w_i - x_+ / 2
 *     F[j] -= -P n + mu P t        torque[j] += rho_j n x (mu P t)           x = gamma + w_i + w_j,  x_+ = max(x, 0)
 *
 * t is the direction in which i's surface is pulled: opposite to the velocity by which it slides past j's, t = -v / |v|, v the
 * tangential part of (v_i + rho_i omega_i x n) - (v_j - rho_j omega_j x n).  [MC] says that friction has the magnitude mu P and a
 * direction that opposes sliding, and prints no sign.  Its torque "f_t x r" is r x f here, r from the centre of the particle to
 * the contact point: +rho_i n, or -rho_j n.  Forces along n make no torque.
 *
 * w_i and w_j are the displacements of the two sides: contact points are on the displaced surfaces or, where these overlap,
 * midway between them.  There the levers add up to the distance of the centres, and the angular momentum is kept.  [MC] argues
 * for the middle with equal moduli; it is taken for all, at rigid bodies and walls, too, as nlc_solve does in
 * NLC_MODEL_HALF_SPACE at deformed contact points (no farther than R/2 from the undeformed surface; levers have no such limit).
 *
 * network          from nlc_network_init
 * F                [particles][3] in-out [N]
 * F_stride         bytes from one particle's force to the next; 0: packed, 24
 * torque           [particles][3] in-out, about the centres [N m]
 * torque_stride    likewise
 * F_wall           [walls][3] in-out [N], or NULL.  Walls have no centre, and no torque.
 * force            [contacts] any finite values [N]; a pull, P < 0, has no friction
 * normal           [contacts][3] as for nlc_solve
 * sliding          [contacts][3] t: unit vectors, | |t|^2 - 1 | <= 1e-6, with |t.n| <= 1e-6, used as given; or zeros, where there
 *                  is no friction
 * displacement     [contacts][2] w on i's side, on j's side [m], > 0 outward, as nlc_sweep gives them for these forces; or NULL:
 *                  no displacements
 * overlap          [contacts] gamma [m]
 * friction         mu >= 0, finite
 * info             or NULL
 * A particle's contact with itself (i = j) adds no force, and the torques of both sides.  Exchanging i and j of a contact, with
 * its normal and t reversed and its displacements exchanged, changes no bit.  NLC_ERROR_RANGE: a lever or the sum of all
 * magnitudes might exceed the range of double.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _STRIDE, _OPTION (friction), _FORCE, _NORMAL, _TOTAL_FORCE (F, F_wall
 * or torque), _SLIDING, _NONLOCAL (displacement), _OVERLAP, _RANGE.
 */
NLC_API nlc_status nlc_assemble_sliding(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride,
                                        double *NLC_RESTRICT torque, ptrdiff_t torque_stride, double *NLC_RESTRICT F_wall,
                                        const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal,
                                        const double *NLC_RESTRICT sliding, const double *NLC_RESTRICT displacement,
                                        const double *NLC_RESTRICT overlap, double friction, nlc_info *info);

/* -------------------------------------------------------------------------------------------------------------- hosts --
 *
 * For codes that have positions and neighbour lists: from these to contacts, from one neighbour list to the next.
 */

/*
 * Where particles and walls are.  The components may be three arrays (stride 0), or every particle's in its struct: then x, y
 * and z point into the first one, and the stride is the size of the struct.
 */
typedef struct nlc_positions {
    size_t struct_size;        /* sizeof(nlc_positions) */
    const double *x, *y, *z;   /* [particles] components of the centres [m] */
    ptrdiff_t stride;          /* bytes from one particle to the next, in each of the three; 0: packed, 8 */
    const double *wall_point;  /* [walls][3] a point of each wall [m] */
    const double *wall_normal; /* [walls][3] unit vectors towards the particles, | |n|^2 - 1 | <= 1e-6 */
    const double *cell;        /* [3][3] vectors of a periodic cell [m], zeros where it is not periodic; NULL: not at all */
} nlc_positions;

/* Neighbour lists of a host: one for each particle, as LAMMPS has them (its names in brackets). */
typedef struct nlc_lists {
    size_t struct_size;        /* sizeof(nlc_lists) */
    int64_t count;             /* lists (inum) */
    const int32_t *particle;   /* [count] whose they are (ilist); NULL: 0 ... count-1 */
    int64_t particle_count;    /* rows of the next two (nlocal) */
    const int32_t *length;     /* [particle_count] neighbours of each (numneigh) */
    int32_t *const *neighbour; /* [particle_count][length] particles, also ghosts (firstneigh) */
    int32_t mask;              /* their bits that are an index (NEIGHMASK, 0x1FFFFFFF); 0: all */
    int32_t reserved;          /* 0 */
} nlc_lists;

/*
 * nlc_contacts_from_pairs - overlaps and normals of pairs.
 *
 *     gamma = R_i + R_j - |x_j - x_i|,   n = (x_j - x_i) / |x_j - x_i|;      wall:  gamma = R_i - (x_i - p).m,   n = -m
 *
 * overlap         [contacts] out: gamma [m], negative for gaps.  A centre behind a wall gives more than R.
 * normal          [contacts][3] out: from i to j, of unit length to rounding
 * particles       count, radius, radius_stride and wall_count; the rest is not looked at
 * positions       see nlc_positions; ghosts are particles like others here
 * i, j            [contact_count] as for nlc_network_init
 * contact_count   >= 0
 * info            or NULL
 *
 * In a periodic cell the nearest image is taken.  It is found wherever it is nearer than half of the cell's least width (between
 * opposite faces), so that any overlap is right if that width is at least 2 (R_i + R_j): two diameters of equal particles.  A
 * narrower cell is an error.  A particle's contact with its own image, and images in narrow cells, need ghosts.  Positions may
 * be any number of cells (below 2^51) outside; then their own rounding counts.
 *
 * Any units: nothing over- or underflows where the result can be held.  Centres nearer than 1e-9 (R_i + R_j) count as in the
 * same place.  Exchanging i and j reverses the normal and changes no other bit.  Worst error found: of the overlap 2.3 ulp of the
 * larger of R_i + R_j and the distance, at a wall 3 ulp of the larger of R and |x_i - p|; of a normal's component 1.3 ulp of 1.
 * Returns NLC_OK; NLC_ERROR_NULL, _NULL_FIELD, _STRUCT_SIZE, _RESERVED, _COUNT, _STRIDE, _RADIUS, _INDEX, _WALL_WALL, _NORMAL (of
 * a wall: that wall's index), _POSITION, _SAME_PLACE, _CELL, _RANGE.
 */
NLC_API nlc_status nlc_contacts_from_pairs(double *NLC_RESTRICT overlap, double *NLC_RESTRICT normal,
                                           const nlc_particles *particles, const nlc_positions *positions,
                                           const int32_t *NLC_RESTRICT i, const int32_t *NLC_RESTRICT j,
                                           int64_t contact_count, nlc_info *info);

/*
 * nlc_contacts_from_lists - the pairs of neighbour lists that are near enough to be contacts or candidates.
 *
 * count       out: how many pairs have a gap below reach
 * i, j        [capacity] out: the pairs in the order of the lists, after each list its particle's walls; both NULL: count only
 * capacity    room in i and j
 * particles   as for nlc_contacts_from_pairs; count is that of all particles with ghosts (LAMMPS: nlocal + nghost)
 * positions   likewise
 * lists       every pair once: half lists, in LAMMPS with newton on; among ranks a pair of two ranks on both of them, in LAMMPS
 *             with newton off.  A pair that is listed twice becomes two contacts in the same direction, which nlc_solve refuses.
 * reach       >= 0 [m]: see nlc_reach
 * info        or NULL
 *
 * Take the indices found here for nlc_contacts_from_pairs; for nlc_network_init replace ghosts by the particles that they are
 * images of, and wall numbers by those that follow the particles without ghosts.
 * Every particle that has a list is looked at with every wall.
 * On error the culprit of a wrong index or length, of centres in the same place, of a cell and of a range is the list's number.
 * Returns NLC_OK; NLC_ERROR_NULL, _NULL_FIELD, _STRUCT_SIZE, _RESERVED, _COUNT, _STRIDE, _OPTION (reach), _RADIUS, _INDEX,
 * _NORMAL, _POSITION, _SAME_PLACE, _CELL, _CAPACITY, _RANGE.
 */
NLC_API nlc_status nlc_contacts_from_lists(int64_t *NLC_RESTRICT count, int32_t *NLC_RESTRICT i, int32_t *NLC_RESTRICT j,
                                           int64_t capacity, const nlc_particles *particles, const nlc_positions *positions,
                                           const nlc_lists *lists, double reach, nlc_info *info);

/*
 * nlc_reach - how wide a gap the displacements may close: which pairs a neighbour list has to hold.
 *
 *     b_k = U_k K F_k,   F_k = sum of the forces on particle k,   U = (1+nu) / (4 pi R E)
 *
 * No point of k's surface where no force acts is displaced outward by more than b_k.  K is the largest value of the model's
 * displacement / (U P) over all directions:
 *     NLC_MODEL_GONZALEZ_CUITINO   3 - 2 nu: [GC] 5 grows with s, so that the point opposite to the force moves most ([GC] 11)
 *     NLC_MODEL_HALF_SPACE         the same times the prefactor; at deformed contact points twice that, since none is taken for
 *                                  farther than R/2 from the undeformed surface, two of them for nearer than R
 *     NLC_MODEL_LOVE               3 - 2 nu: found in a search over all circles up to a = R
 *     NLC_MODEL_SPHERE, NLC_MODEL_POINT_FORCE   0.76 + 1.4 nu - 0.9 nu^2, 0.1 to 1.3 % above the largest value found, between 66 and
 *                                  75 degrees; the size of the circles does not add to it (a search over all sizes and tilts)
 *     NLC_MODEL_HERTZ              0
 *
 * network        from nlc_network_init
 * reach          out: 2 max b_k [m], the widest gap between any two particles that can close
 * displacement   [particles] out: b_k [m]; or NULL
 * force          [contacts] P >= 0 of nlc_solve [N]
 * info           or NULL: critical_particle, where b_k is largest
 *
 * On ranks ghosts have 0, and what counts is the largest reach of all.
 *
 * Promised: the forces of nlc_solve solve the equations of a longer list as well, which has any other pairs with
 * gaps of at least b_i + b_j, or b_i at walls: those stay open.  Not promised: anything about forces yet to come.  As they grow
 * the reach does; add what it may grow, and how far particles may move towards each other, until the next list.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK, _FORCE, _RANGE.
 */
NLC_API nlc_status nlc_reach(const nlc_network *network, double *NLC_RESTRICT reach, double *NLC_RESTRICT displacement,
                             const double *NLC_RESTRICT force, nlc_info *info);

/*
 * nlc_carry_size - bytes that nlc_carry needs to work in; 0 if a count is negative or the size overflows.
 */
NLC_API size_t nlc_carry_size(int64_t contact_count, int64_t old_count);

/*
 * nlc_carry - carry the nonlocal displacements over to the contacts of a new neighbour list.
 *
 * nonlocal        [contact_count] out: that of the old contact with the same key, 0 where there is none [m]
 * key             [contact_count] the caller's names of the contacts, such as both particles' lasting numbers in one integer, the
 *                 smaller one first.  A key may be there several times (periodic images): the first of the new
 *                 contacts gets the first of the old ones, and so on.
 * contact_count   of the new list
 * old_nonlocal    [old_count] [m]; any other values per contact will do
 * old_key         [old_count]
 * old_count       of the old list
 * memory          at least nlc_carry_size bytes, aligned to 8, to work in: that of the network about to be built will do
 * memory_size     bytes
 * info            or NULL: left_out, contacts of the new list that are in no old one
 * Time is that of sorting both lists, less where they are sorted.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _COUNT, _CAPACITY, _ALIGNMENT, _NONLOCAL (old_nonlocal).
 */
NLC_API nlc_status nlc_carry(double *NLC_RESTRICT nonlocal, const uint64_t *NLC_RESTRICT key, int64_t contact_count,
                             const double *NLC_RESTRICT old_nonlocal, const uint64_t *NLC_RESTRICT old_key, int64_t old_count,
                             void *memory, size_t memory_size, nlc_info *info);

/*
 * nlc_order - in which order to number particles and contacts, so that what is used together lies together in memory.
 *
 * Where large packings are numbered at random the processor waits for memory: a sweep of 500,000 contacts then takes twice as long as
 * in this order, of ten million several times.  A host gains from it by renumbering when it makes a neighbour list: its own
 * particles, or just what it hands to the library, with place[particle[m]] = m:
 *     radius, material of m   those of its particle[m]; walls keep their numbers
 *     i, j of contact m       place of the two particles of its contact[m]; overlap, normal, nonlocal ... likewise
 * Forces on particles then come in this order as well.
 *
 * network    from nlc_network_init, as the host has numbered it.  Its work space is used, nothing of it changes.
 * particle   [particles] out: which one is to be the m-th, each once: those owned here first, then ghosts
 * contact    [contacts] out: which one is to be the m-th, each once
 * info       or NULL
 *
 * Particles come in blobs of 512, each grown breadth first from a neighbour of those before, and in each of them by falling number
 * of contacts (more than 64 count as none); ghosts in the order in which they are met there, those without contacts by number.
 * Contacts follow the lower one of their two particles, then the other one, with walls last; contacts of the same two bodies stay in
 * their order.  The same network gives the same order, whichever body of a contact is called i.  The time is about twice that of
 * nlc_network_init.
 * Returns NLC_OK; NLC_ERROR_NULL, _STRUCT_SIZE, _NETWORK.
 */
NLC_API nlc_status nlc_order(nlc_network *network, int32_t *NLC_RESTRICT particle, int64_t *NLC_RESTRICT contact, nlc_info *info);

/*
 * nlc_network_update - other radii and materials for the same contacts: grains that swell, soften or wear.
 *
 * The network is then, bit for bit in what it computes, as if it had been built anew with its options.
 *
 * network     from nlc_network_init
 * particles   see nlc_particles; count, wall_count and material_count as the network was built with
 * stiffness   [contacts] as options.stiffness: k of a law of the host's own, NULL: n_H.  What the network had is not kept.
 * info        or NULL
 * Returns NLC_OK; NLC_ERROR_NULL, _NULL_FIELD, _STRUCT_SIZE, _RESERVED, _NETWORK, _COUNT, _STRIDE, _RADIUS, _MATERIAL, _YOUNG,
 * _POISSON, _RIGID_RIGID, _STIFFNESS, _RANGE.
 */
NLC_API nlc_status nlc_network_update(nlc_network *network, const nlc_particles *particles, const double *stiffness,
                                      nlc_info *info);

#ifdef __cplusplus
}
#endif

#endif /* NLCONTACT_H */
