/* SPDX-License-Identifier: BSD-2-Clause */
/* model.c - the table of models, in the order of NLC_MODEL_... */
#include "model.h"

#include "nlcontact.h"

#define GC_DOI "10.1016/j.jmps.2011.10.004"
#define MC_DOI "10.1103/PhysRevE.91.032201"

#define CASE_ONE                                                                                                            \
    .within = nlc_case_one_within, .between = nlc_case_one_between, .coefficients = nlc_case_one_coefficients,              \
    .squares = nlc_case_one_squares, .most = nlc_case_one_most

const nlc_model nlc_models[] = {
    [NLC_MODEL_GONZALEZ_CUITINO] = {.name = "gonzalez-cuitino",
                                    .reference = "Gonzalez and Cuitino 2012, Eq. 5 (Case I)",
                                    .doi = GC_DOI,
                                    .validity = "contacts further apart than a contact radius; best at nu near 0.5",
                                    .potential = true,
                                    .prepare = nlc_case_one_prepare,
                                    CASE_ONE},
    [NLC_MODEL_HERTZ] = {.name = "hertz",
                         .reference = "Hertz 1881; Gonzalez and Cuitino 2012, Eq. 10 without nonlocal terms",
                         .doi = GC_DOI,
                         .validity = "small strain, loose packings",
                         .potential = true},
    [NLC_MODEL_HALF_SPACE] = {.name = "half-space",
                              .reference = "Brodu, Dijksman and Behringer 2015, Eq. 1 (MC-DEM)",
                              .doi = MC_DOI,
                              .validity = "as gonzalez-cuitino, times a prefactor fitted to a packing",
                              .shape = NLC_SHAPE_PLACE,
                              .prepare = nlc_half_space_prepare,
                              .within = nlc_half_space_within,
                              .between = nlc_half_space_between,
                              .coefficients = nlc_case_one_coefficients,
                              .squares = nlc_case_one_squares},
    [NLC_MODEL_LOVE] = {.name = "love",
                        .reference = "Gonzalez and Cuitino 2012, Eqs. 26-29 (Case II)",
                        .doi = GC_DOI,
                        .validity = "as gonzalez-cuitino, and contacts close together",
                        .shape = NLC_SHAPE_RADIUS,
                        .prepare = nlc_love_prepare,
                        .within = nlc_love_within,
                        .between = nlc_love_between,
                        .coefficients = nlc_case_one_coefficients,
                        .squares = nlc_case_one_squares},
    [NLC_MODEL_SPHERE] = {.name = "sphere",
                          .reference = "the exact elastic sphere to second order in contact radius / radius",
                          .doi = "",
                          .validity = "contacts further apart than their diameters, overlaps to 10 % of the radius",
                          .potential = true,
                          .shape = NLC_SHAPE_MOMENTS,
                          .self = nlc_sphere_model_self,
                          .prepare = nlc_sphere_model_prepare,
                          .within = nlc_sphere_within,
                          .between = nlc_sphere_between,
                          .coefficients = nlc_sphere_coefficients,
                          .squares = nlc_sphere_squares},
    [NLC_MODEL_POINT_FORCE] = {.name = "point-force",
                               .reference = "a point force on the exact elastic sphere, as Brodu, Dijksman and Behringer 2015, Table I",
                               .doi = MC_DOI,
                               .validity = "for comparison: what a force does to its own contact is missing, and it is as large",
                               .potential = true,
                               .shape = NLC_SHAPE_POINT,
                               .prepare = nlc_sphere_model_prepare,
                               .within = nlc_sphere_within,
                               .between = nlc_sphere_between,
                               .coefficients = nlc_sphere_coefficients,
                               .squares = nlc_sphere_squares},
};

const nlc_model nlc_half_space_undeformed = {.name = "half-space",
                                             .reference = "Brodu, Dijksman and Behringer 2015, Eq. 1, at undeformed contact points",
                                             .doi = MC_DOI,
                                             .validity = "as gonzalez-cuitino, times a prefactor fitted to a packing",
                                             .potential = true,
                                             .prepare = nlc_half_space_prepare,
                                             CASE_ONE};

const int32_t nlc_models_count = (int32_t)(sizeof nlc_models / sizeof *nlc_models);
