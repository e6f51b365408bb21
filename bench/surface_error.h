/* SPDX-License-Identifier: BSD-2-Clause */
/* surface_error.h - displacement of a sphere's surface beside one contact: the models beside the exact one. */
#ifndef NLC_BENCH_SURFACE_ERROR_H
#define NLC_BENCH_SURFACE_ERROR_H

/*
 * surface_error_print - reads bench/data/reference/hertz_pressure.csv and prints, for each Poisson's ratio, by how much the models'
 * displacement from 30 degrees on differs from it, in % of the largest there.
 *
 * Models differ in what the displacement is relative to: that is a multiple of cos(theta), which is fitted.
 * Returns 0, or -1 and a message if the file cannot be read.
 */
int surface_error_print(const char *path);

#endif
