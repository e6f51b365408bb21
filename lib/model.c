/* SPDX-License-Identifier: BSD-2-Clause */
/* model.c - the table of models, in the order of NLC_MODEL_... */
#include "model.h"

#include "nlcontact.h"

#define GC_DOI "10.1016/j.jmps.2011.10.004"
#define MC_DOI "10.1103/PhysRevE.91.032201"

#define CASE_ONE                                                                                                            \
    .within = nlc_case_one_within, .between = nlc_case_one_between, .coefficients = nlc_case_one_coefficients,              \
    .squares = nlc_case_one_squares, .turning = nlc_case_one_turning, .most = nlc_case_one_most

const nlc_model nlc_models[] = {
    [NLC_MODEL_GONZALEZ_CUITINO] = {.name = "gonzalez-cuitino",
                                    .reference = "Gonzalez and Cuitino 2012, Eqs. 5, 9, 10 (Case I)",
                                    .doi = GC_DOI,
                                    .validity = "up to overlaps of 1, 5, 10 % of R: 3, 9, 17 % off at right angles,"
                                                " 7, 17, 62 % with 8 or 12 contacts; lateral reaction 25 % (nu 0.5)"
                                                " to 90 % (nu 0) low; worse where contact forces do not balance",
                                    .cost = 1,
                                    .symmetric = true,
                                    .potential = true,
                                    .prepare = nlc_case_one_prepare,
                                    CASE_ONE},
    [NLC_MODEL_HERTZ] = {.name = "hertz",
                         .reference = "Hertz 1881; Gonzalez and Cuitino 2012, Eq. 10 without nonlocal terms",
                         .doi = GC_DOI,
                         .validity = "loose packings; up to overlaps of 1, 5, 10 % of R: 15, 34, 50 % low at"
                                     " right angles, 23, 55, 72 % with 8 or 12 contacts; no lateral reaction",
                         .cost = 0,
                         .symmetric = true,
                         .potential = true},
    [NLC_MODEL_HALF_SPACE] = {.name = "half-space",
                              .reference = "Brodu, Dijksman and Behringer 2015, Eq. 1 (MC-DEM)",
                              .doi = MC_DOI,
                              .validity = "with prefactor 1, up to overlaps of 1, 5, 10 % of R: 3, 9, 19 % off at"
                                          " right angles, 7, 17, 42 % with 8 or 12 contacts, lateral reaction 25 to"
                                          " 91 % low; other prefactors are fitted to a packing",
                              .cost = 4.5,
                              .shape = NLC_SHAPE_PLACE,
                              .prepare = nlc_half_space_prepare,
                              .within = nlc_half_space_within,
                              .between = nlc_half_space_between,
                              .coefficients = nlc_case_one_coefficients,
                              .squares = nlc_case_one_squares},
    [NLC_MODEL_LOVE] = {.name = "love",
                        .reference = "Gonzalez and Cuitino 2012, Eqs. 26-29 (Case II)",
                        .doi = GC_DOI,
                        .validity = "up to overlaps of 1, 5, 10 % of R: 3, 9, 15 % off at right angles,"
                                    " 7, 18, 25 % with 8 or 12 contacts; lateral reaction 25 to 90 % low",
                        .cost = 29,
                        .shape = NLC_SHAPE_RADIUS,
                        .prepare = nlc_love_prepare,
                        .within = nlc_love_within,
                        .between = nlc_love_between,
                        .coefficients = nlc_case_one_coefficients,
                        .squares = nlc_case_one_squares},
    [NLC_MODEL_SPHERE] = {.name = "sphere",
                          .reference = "linear elasticity of the sphere to second order in contact radius / R",
                          .doi = "",
                          .validity = "up to overlaps of 1, 5, 10 % of R (contact radius 0.44 R): 0.1, 0.1,"
                                      " 0.3 % off at right angles, 0.1, 0.2, 1.8 % at 60 degrees, 0.1, 0.8,"
                                      " 3.4 % at 40; unequal spheres 0.1, 0.3, 1.1 %",
                          .cost = 7.5,
                          .symmetric = true,
                          .potential = true,
                          .shape = NLC_SHAPE_MOMENTS,
                          .self = nlc_sphere_model_self,
                          .prepare = nlc_sphere_model_prepare,
                          .kept = 2,
                          .within = nlc_sphere_within,
                          .between = nlc_sphere_between,
                          .tilt_between = nlc_sphere_tilt_between,
                          .coefficients = nlc_sphere_coefficients,
                          .squares = nlc_sphere_squares,
                          .turning = nlc_sphere_turning},
    [NLC_MODEL_POINT_FORCE] = {.name = "point-force",
                               .reference = "point force on the elastic sphere, Brodu, Dijksman and Behringer 2015, Table I",
                               .doi = MC_DOI,
                               .validity = "for comparison, lacks what a force does to its own contact: up to"
                                           " overlaps of 1, 5, 10 % of R 11, 32, 51 % off",
                               .cost = 3.5,
                               .symmetric = true,
                               .potential = true,
                               .shape = NLC_SHAPE_POINT,
                               .prepare = nlc_sphere_model_prepare,
                               .kept = 2,
                               .within = nlc_sphere_within,
                               .between = nlc_sphere_between,
                               .coefficients = nlc_sphere_coefficients,
                               .squares = nlc_sphere_squares,
                               .turning = nlc_sphere_turning},
};

const nlc_model nlc_half_space_undeformed = {.name = "half-space",
                                             .reference = "Brodu, Dijksman and Behringer 2015, Eq. 1, at undeformed contact points",
                                             .doi = MC_DOI,
                                             .validity = "gonzalez-cuitino times the prefactor",
                                             .cost = 1,
                                             .symmetric = true,
                                             .potential = true,
                                             .prepare = nlc_half_space_prepare,
                                             CASE_ONE};

const int32_t nlc_models_count = (int32_t)(sizeof nlc_models / sizeof *nlc_models);
