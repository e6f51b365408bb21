/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * metrics.h - how near a run comes to a reference, by the four numbers of Brodu, Dijksman and Behringer (2015), [MC] IV.
 */
#ifndef NLC_HYDROGEL_METRICS_H
#define NLC_HYDROGEL_METRICS_H

#include <stdbool.h>

#include "run.h"

typedef struct metrics_settings {
    int first;         /* cycles before this one are left out */
    double threshold;  /* tau: the run's forces up to it do not count as contacts in err_Z [N]; NaN: what fits best */
    double resolution; /* those of the reference up to it do not count there either [N] */
} metrics_settings;

typedef struct metrics {
    double strain, top, top_reference; /* at the largest compression; [N] */
    double R_top;                      /* top / top_reference */
    double err_f;                      /* root mean square difference of the top forces [N] */
    double err_Z, threshold;           /* likewise of the contacts per grain, and the threshold used [N] */
    double bhat;          /* -log of the mean over the levels of sum sqrt(p q), p and q the shares of the forces in the bins */
    int levels, left_out; /* of the reference: compared; beyond the levels of the run */
} metrics;

/* Returns NULL, or what is wrong. */
const char *metrics_compare(metrics *m, const run *a, const run *reference, const metrics_settings *set);

#endif
