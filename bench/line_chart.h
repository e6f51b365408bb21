/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * line_chart.h - curves in panels: a picture of them, and their data.
 *
 * A chart is filled from the front to the back: a panel, its curves one after the other, the points of each.  What cannot be
 * stored for want of memory sets failed, and nothing more is stored then.  Names are shortened to LINE_NAME - 1 bytes; texts
 * other than names are not copied.
 */
#ifndef NLC_BENCH_LINE_CHART_H
#define NLC_BENCH_LINE_CHART_H

#include <stdbool.h>
#include <stdio.h>

enum { LINE_NAME = 80, LINE_LEGENDS = 16 };

typedef enum line_style { LINE_SOLID, LINE_DASHED, LINE_DOTTED, LINE_MARKS } line_style;

typedef struct line_curve {
    char name[LINE_NAME];
    const char *colour;
    line_style style;
    int count;
    double (*point)[2]; /* x, y */
} line_curve;

typedef struct line_axis {
    const char *label;
    double low, high; /* what is seen */
    bool logarithmic;
} line_axis;

typedef struct line_panel {
    char name[LINE_NAME];
    line_axis x, y;
    int curves;
    line_curve *curve;
} line_panel;

typedef struct line_chart {
    const char *title;
    int columns, width, height; /* panels side by side; size of a panel [pixels] */
    int panels, legends;
    line_panel *panel;
    line_curve legend[LINE_LEGENDS]; /* without points */
    bool failed;
} line_chart;

void line_chart_panel(line_chart *c, const char *name, line_axis x, line_axis y);
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void line_chart_curve(line_chart *c, const char *colour, line_style style, const char *format, ...);
void line_chart_point(line_chart *c, double x, double y); /* nothing if one of them is not finite */
void line_chart_legend(line_chart *c, const char *text, const char *colour, line_style style);
void line_chart_free(line_chart *c);

/* See ferror(out).  The data: a line 'panel,curve,x,y' for every point. */
void line_chart_write_svg(FILE *out, const line_chart *c);
void line_chart_write_csv(FILE *out, const line_chart *c);

#endif
