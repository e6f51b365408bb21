/* SPDX-License-Identifier: BSD-2-Clause */
/* model.c - the table of models, in the order of NLC_MODEL_... */
#include "model.h"

#include "nlcontact.h"

#define GC_DOI "10.1016/j.jmps.2011.10.004"
#define MC_DOI "10.1103/PhysRevE.91.032201"

const nlc_model nlc_models[] = {
    [NLC_MODEL_GONZALEZ_CUITINO] = {"gonzalez-cuitino", "Gonzalez and Cuitino 2012, Eq. 5 (Case I)", GC_DOI,
                                    "contacts further apart than a contact radius; best at nu near 0.5", true,
                                    nlc_case_one_prepare, nlc_case_one_within, nlc_case_one_between,
                                    nlc_case_one_coefficients, nlc_case_one_squares, nlc_case_one_most},
    [NLC_MODEL_HERTZ] = {"hertz", "Hertz 1881; Gonzalez and Cuitino 2012, Eq. 10 without nonlocal terms", GC_DOI,
                         "small strain, loose packings", true, 0, 0, 0, 0, 0, 0},
    [NLC_MODEL_HALF_SPACE] = {"half-space", "Brodu, Dijksman and Behringer 2015, Eq. 1, at undeformed contact points", MC_DOI,
                              "as gonzalez-cuitino, times a prefactor fitted to a packing", true, nlc_half_space_prepare,
                              nlc_case_one_within, nlc_case_one_between, nlc_case_one_coefficients, nlc_case_one_squares, nlc_case_one_most},
    [NLC_MODEL_LOVE] = {"love", "Gonzalez and Cuitino 2012, Eqs. 26-29 (Case II)", GC_DOI, "", false, 0, 0, 0, 0, 0, 0},
    [NLC_MODEL_SPHERE] = {"sphere", "elastic sphere to second order in contact radius / radius", "", "", false, 0, 0, 0, 0, 0, 0},
    [NLC_MODEL_POINT_FORCE] = {"point-force", "point force on the elastic sphere", "", "", false, 0, 0, 0, 0, 0, 0},
};

const int32_t nlc_models_count = (int32_t)(sizeof nlc_models / sizeof *nlc_models);
