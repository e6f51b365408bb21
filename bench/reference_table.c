/* SPDX-License-Identifier: BSD-2-Clause */
/* reference_table.c - reads them. */
#include "reference_table.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 4096, COLUMNS = 8, SPHERE = 5, ABSENT = -1 };

static const char *const column_names[COLUMNS] = {"nu",      "eps_1",        "force_1",     "eps_2",
                                                  "force_2", "radius_ratio", "young_ratio", "other_nu"};

typedef struct reader {
    reference_table *t;
    int place[COLUMNS]; /* of each column in a line, or ABSENT */
    bool named;         /* the line of names has been read */
    double unit;
} reader;

/* ---- the line of names, and rows; each returns NULL or what is wrong */

static bool needed(const reference_table *t, int column)
{
    return column < SPHERE ? column < 1 + 2 * t->groups : t->with_sphere;
}

static const char *read_names(reader *r, char *line)
{
    for (int k = 0; k < COLUMNS; k++) r->place[k] = ABSENT;
    int place = 0;
    for (char *name = strtok(line, ",\r\n"); name; name = strtok(NULL, ",\r\n"), place++)
        for (int k = 0; k < COLUMNS; k++)
            if (strcmp(name, column_names[k]) == 0) r->place[k] = place;
    for (int k = 0; k < COLUMNS; k++)
        if (needed(r->t, k) && r->place[k] == ABSENT) return "a column is missing";
    if (r->t->contacts == 0) return "no contact lines before the columns' names";
    r->named = true;
    return NULL;
}

static bool field(const char *line, int place, double *x)
{
    for (; place > 0; place--) {
        line = strchr(line, ',');
        if (!line) return false;
        line++;
    }
    char *end;
    *x = strtod(line, &end);
    return end != line && strchr(",\r\n", *end) && !isnan(*x);
}

static const char *read_row(reader *r, const char *line)
{
    reference_table *t = r->t;
    double x[COLUMNS] = {0};
    for (int k = 0; k < COLUMNS; k++)
        if (needed(t, k) && !field(line, r->place[k], &x[k])) return "not a number";
    /* room for powers of two */
    if ((t->count & (t->count - 1)) == 0) {
        reference_row *more = realloc(t->row, (size_t)(t->count ? 2 * t->count : 1) * sizeof *more);
        if (!more) return "out of memory";
        t->row = more;
    }
    t->row[t->count++] = (reference_row){x[0], {x[1], x[3]}, {x[2] / r->unit, x[4] / r->unit}, x[5], x[6], x[7]};
    return NULL;
}

/* ---- comments */

static const char *read_comment(reader *r, const char *line)
{
    reference_table *t = r->t;
    double n[3];
    int group;
    if (sscanf(line, "# unit: %lf", &r->unit) == 1) return r->unit > 0 ? NULL : "the unit is not positive";
    if (strncmp(line, "# finite elements,", 18) == 0) t->finite_elements = true;
    if (strncmp(line, "# finite strain:", 16) == 0) t->finite_strain = true;
    if (strncmp(line, "# contact:", 10) != 0) return NULL;
    if (sscanf(line, "# contact: %lf %lf %lf group %d", &n[0], &n[1], &n[2], &group) != 4) return "not a contact";
    if (group < 1 || group > REFERENCE_GROUPS) return "no such group";
    if (t->contacts == REFERENCE_CONTACTS) return "too many contacts";
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0)) return "a contact without direction";
    if (strstr(line, " sphere")) {
        if (t->with_sphere) return "a second sphere twice";
        t->with_sphere = true;
        t->sphere = t->contacts;
    }
    for (int d = 0; d < 3; d++) t->normal[t->contacts][d] = n[d] / length;
    t->group[t->contacts++] = group - 1;
    if (t->groups < group) t->groups = group;
    return NULL;
}

static const char *read_lines(reader *r, FILE *file, int *number)
{
    char line[LINE];
    while (fgets(line, sizeof line, file)) {
        ++*number;
        if (!strchr(line, '\n') && !feof(file)) return "the line is too long";
        const char *wrong = line[0] == '#' ? read_comment(r, line) : r->named ? read_row(r, line) : read_names(r, line);
        if (wrong) return wrong;
    }
    if (ferror(file)) return "cannot be read";
    return r->t->count > 0 ? NULL : "no rows";
}

/* The last two parts of the path without a suffix. */
static void make_name(const char *path, char name[REFERENCE_NAME])
{
    const char *start = path, *last = path;
    for (const char *s = path; *s; s++) {
        if (*s != '/') continue;
        start = last;
        last = s + 1;
    }
    snprintf(name, REFERENCE_NAME, "%s", start);
    char *dot = strrchr(name, '.');
    if (dot) *dot = '\0';
}

int reference_table_read(reference_table *t, const char *path, char *error, size_t error_size)
{
    *t = (reference_table){0};
    make_name(path, t->name);
    FILE *file = fopen(path, "r");
    if (!file) {
        snprintf(error, error_size, "%s: %s", path, strerror(errno));
        return -1;
    }
    reader r = {.t = t, .unit = 1};
    int number = 0;
    const char *wrong = read_lines(&r, file, &number);
    if (wrong) snprintf(error, error_size, "%s:%d: %s", path, number, wrong);
    fclose(file);
    return wrong ? -1 : 0;
}

void reference_table_free(reference_table *t)
{
    free(t->row);
    *t = (reference_table){0};
}
