/* SPDX-License-Identifier: BSD-2-Clause */
/* packing_io.c - reads packings; every complaint names the file and the line. */
#include "packing_io.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "timing.h"

#define COLUMNS "id,x,y,z,radius,type"
#define DATA_SUFFIX ".f64le"
#define HEADER_SUFFIX ".header.txt"
#define DATA_LAYOUT "little-endian float64"

enum { FIELDS = 6, ROW_DOUBLES = 5, CHUNK_ROWS = 1024 };

typedef struct reader {
    packing *p;
    const char *path; /* of the file that is being read */
    FILE *file;
    int64_t line; /* of a text file, or row of a binary one */
    bool binary;
    char text[PACKING_LINE_MAX + 1];
    bool cut;           /* the line was longer than text */
    unsigned seen;      /* a bit for each entry of header_lines */
    int64_t expected;   /* N */
    int64_t types;      /* materials before that of rigid walls was appended; known after the header */
    int64_t capacity;   /* particles that there is room for */
    char *data_name;    /* from the data line, or NULL */
    int64_t *wall_type; /* [wall_count] 0: rigid */
    timing_progress progress;
    bool show_progress;
    char *error;
    size_t error_size;
} reader;

__attribute__((format(printf, 2, 3))) static int fail(reader *r, const char *format, ...)
{
    int n = snprintf(r->error, r->error_size, r->binary ? "%s:row %lld: " : "%s:%lld: ", r->path, (long long)r->line);
    if (n < 0 || (size_t)n >= r->error_size) return -1;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(r->error + n, r->error_size - (size_t)n, format, arguments);
    va_end(arguments);
    return -1;
}

static int fail_memory(reader *r)
{
    return fail(r, "out of memory");
}

/* ---- words and numbers of a line; each function moves *s behind what it took */

static void skip_space(const char **s)
{
    while (**s == ' ' || **s == '\t') ++*s;
}

static bool at_end(const char *s)
{
    skip_space(&s);
    return *s == '\0';
}

static bool is_boundary(char c)
{
    return c == '\0' || c == ' ' || c == '\t' || c == ',' || c == ':';
}

static bool take_word(const char **s, const char *word)
{
    size_t n = strlen(word);
    skip_space(s);
    if (strncmp(*s, word, n) != 0 || !is_boundary((*s)[n])) return false;
    *s += n;
    return true;
}

static bool take_number(const char **s, double *x)
{
    char *end;
    skip_space(s);
    *x = strtod(*s, &end);
    if (end == *s || !is_boundary(*end)) return false;
    *s = end;
    return true;
}

static bool take_integer(const char **s, int64_t *k)
{
    char *end;
    skip_space(s);
    errno = 0;
    *k = strtoll(*s, &end, 10);
    if (end == *s || errno != 0 || !is_boundary(*end)) return false;
    *s = end;
    return true;
}

/* Small enough that no square over- or underflows; not NaN. */
static bool is_moderate(double x)
{
    return fabs(x) <= 1e100;
}

static bool take_vector(const char **s, double x[3])
{
    for (int d = 0; d < 3; d++)
        if (!take_number(s, &x[d]) || !is_moderate(x[d])) return false;
    return true;
}

/* A copy of the text from s up to stop or its end, without space around it; NULL: out of memory. */
static char *copy_text(const char *s, char stop)
{
    skip_space(&s);
    size_t n = 0;
    while (s[n] != '\0' && s[n] != stop) n++;
    while (n > 0 && isspace((unsigned char)s[n - 1])) n--;
    return strndup(s, n);
}

/* ---- header lines; s is what follows the key */

static int parse_name(reader *r, const char *s, int unused)
{
    (void)unused;
    r->p->name = copy_text(s, '\0');
    return r->p->name ? 0 : fail_memory(r);
}

static int parse_data(reader *r, const char *s, int unused)
{
    (void)unused;
    if (!strstr(s, DATA_LAYOUT)) return fail(r, "data that is not '" DATA_LAYOUT "' cannot be read");
    r->data_name = copy_text(s, ',');
    if (!r->data_name) return fail_memory(r);
    if (r->data_name[0] == '\0' || strchr(r->data_name, '/')) return fail(r, "data must name a file in the same folder");
    return 0;
}

static int parse_count(reader *r, const char *s, int unused)
{
    (void)unused;
    if (!take_integer(&s, &r->expected) || !at_end(s)) return fail(r, "N is not an integer");
    if (r->expected < 1 || r->expected > INT32_MAX) return fail(r, "N is not between 1 and 2^31 - 1");
    return 0;
}

static int parse_box(reader *r, const char *s, int axis)
{
    double *low = &r->p->low[axis], *high = &r->p->high[axis];
    if (!take_number(&s, low) || !take_number(&s, high) || !at_end(s)) return fail(r, "expected two numbers, low and high");
    if (!is_moderate(*low) || !is_moderate(*high) || !(*high - *low > 1e-100)) return fail(r, "the box is empty or not finite");
    return 0;
}

static int parse_periodic(reader *r, const char *s, int unused)
{
    (void)unused;
    for (int d = 0; d < 3; d++) {
        int64_t k;
        if (!take_integer(&s, &k) || k < 0 || k > 1) return fail(r, "expected three times 0 or 1");
        r->p->periodic[d] = k == 1;
    }
    return at_end(s) ? 0 : fail(r, "expected three times 0 or 1");
}

/* Makes room for material k, with zeros up to it. */
static int grow_materials(reader *r, int64_t k)
{
    packing *p = r->p;
    if (k < p->material_count) return 0;
    nlc_material *m = realloc(p->materials, (size_t)(k + 1) * sizeof *m);
    if (!m) return fail_memory(r);
    memset(m + p->material_count, 0, (size_t)(k + 1 - p->material_count) * sizeof *m);
    p->materials = m;
    p->material_count = k + 1;
    return 0;
}

static int parse_material(reader *r, const char *s, int unused)
{
    (void)unused;
    int64_t type;
    nlc_material m;
    if (!take_integer(&s, &type) || *s++ != ':' || !take_word(&s, "E") || !take_number(&s, &m.young) || !take_word(&s, "nu") ||
        !take_number(&s, &m.poisson) || !at_end(s))
        return fail(r, "expected 'material type K: E YOUNG nu POISSON'");
    if (type < 1 || type > PACKING_TYPE_MAX) return fail(r, "a type is a number from 1 to %d", PACKING_TYPE_MAX);
    if (!(m.young > 0)) return fail(r, "E is not positive");
    if (!(m.poisson >= 0 && m.poisson <= 0.5)) return fail(r, "nu is not between 0 and 0.5");
    if (grow_materials(r, type - 1)) return -1;
    if (r->p->materials[type - 1].young > 0) return fail(r, "type %lld has a material line already", (long long)type);
    r->p->materials[type - 1] = m;
    return 0;
}

static int add_wall(reader *r, const packing_wall *wall, int64_t type)
{
    packing *p = r->p;
    size_t n = (size_t)p->wall_count + 1;
    packing_wall *walls = realloc(p->walls, n * sizeof *walls);
    if (walls) p->walls = walls;
    int64_t *types = realloc(r->wall_type, n * sizeof *types);
    if (types) r->wall_type = types;
    if (!walls || !types) return fail_memory(r);
    walls[n - 1] = *wall;
    types[n - 1] = type;
    p->wall_count++;
    return 0;
}

static int parse_wall(reader *r, const char *s, int unused)
{
    (void)unused;
    int64_t number, type = 0;
    packing_wall w;
    if (!take_integer(&s, &number) || *s++ != ':' || !take_word(&s, "plane") ||
        !(take_word(&s, "rigid") || (take_word(&s, "type") && take_integer(&s, &type) && type > 0)) ||
        !take_word(&s, "point") || !take_vector(&s, w.point) || !take_word(&s, "inward_normal") || !take_vector(&s, w.normal) ||
        !at_end(s))
        return fail(r, "expected 'wall K: plane rigid|type K point X Y Z inward_normal X Y Z'");
    if (number != r->p->wall_count + 1) return fail(r, "walls are not numbered 1, 2, 3, ...");
    double square = w.normal[0] * w.normal[0] + w.normal[1] * w.normal[1] + w.normal[2] * w.normal[2];
    if (!(fabs(square - 1) <= 1e-6)) return fail(r, "the normal is not of unit length");
    return add_wall(r, &w, type);
}

static const struct {
    const char *key;
    bool required, repeated;
    int (*parse)(reader *r, const char *s, int which);
    int which;
} header_lines[] = {
    {"packing:", false, false, parse_name, 0},     {"data:", false, false, parse_data, 0},
    {"N:", true, false, parse_count, 0},           {"box_x:", true, false, parse_box, 0},
    {"box_y:", true, false, parse_box, 1},         {"box_z:", true, false, parse_box, 2},
    {"periodic:", true, false, parse_periodic, 0}, {"material type ", true, true, parse_material, 0},
    {"wall ", false, true, parse_wall, 0},
};
enum { HEADER_LINES = sizeof header_lines / sizeof header_lines[0] };

/* A line that begins with '#': one that is known, or a comment. */
static int parse_header_line(reader *r)
{
    const char *s = r->text + 1;
    skip_space(&s);
    for (int k = 0; k < HEADER_LINES; k++) {
        size_t n = strlen(header_lines[k].key);
        if (strncmp(s, header_lines[k].key, n) != 0) continue;
        if (r->cut) return fail(r, "longer than %d bytes", PACKING_LINE_MAX);
        if ((r->seen & 1u << k) && !header_lines[k].repeated) return fail(r, "'%s' is given twice", header_lines[k].key);
        r->seen |= 1u << k;
        return header_lines[k].parse(r, s + n, header_lines[k].which);
    }
    return 0;
}

/* Is there a material line for it? */
static bool is_type(const reader *r, int64_t type)
{
    return type >= 1 && type <= r->types && r->p->materials[type - 1].young > 0;
}

/* Material of every wall.  Rigid ones share an entry that is appended to the materials. */
static int finish_walls(reader *r)
{
    packing *p = r->p;
    r->types = p->material_count;
    p->wall_material = calloc((size_t)p->wall_count + 1, sizeof p->wall_material[0]);
    if (!p->wall_material) return fail_memory(r);
    for (int64_t w = 0; w < p->wall_count; w++) {
        int64_t type = r->wall_type[w];
        if (type > 0 && !is_type(r, type))
            return fail(r, "wall %lld is of type %lld, which has no material line", (long long)w + 1, (long long)type);
        for (int d = 0; d < 3; d++)
            if (p->periodic[d] && fabs(p->walls[w].normal[d]) > 1e-6)
                return fail(r, "wall %lld does not run along the periodic axis %c", (long long)w + 1, "xyz"[d]);
        if (type == 0 && grow_materials(r, r->types)) return -1;
        if (type == 0) p->materials[r->types].young = HUGE_VAL;
        p->wall_material[w] = (int32_t)(type == 0 ? r->types : type - 1);
    }
    return 0;
}

/* What can only be checked once the header is complete. */
static int finish_header(reader *r)
{
    for (int k = 0; k < HEADER_LINES; k++)
        if (header_lines[k].required && !(r->seen & 1u << k))
            return fail(r, "the header has no line that begins with '# %s'", header_lines[k].key);
    return finish_walls(r);
}

/* ---- particles */

static int grow_particles(reader *r)
{
    packing *p = r->p;
    if (p->count < r->capacity) return 0;
    /* not N at once: the file may be shorter than it claims */
    size_t n = r->capacity ? (size_t)r->capacity * 2 : CHUNK_ROWS;
    void *x = realloc(p->x, n * sizeof p->x[0]);
    if (x) p->x = x;
    void *radius = realloc(p->radius, n * sizeof p->radius[0]);
    if (radius) p->radius = radius;
    void *material = realloc(p->material, n * sizeof p->material[0]);
    if (material) p->material = material;
    void *id = realloc(p->id, n * sizeof p->id[0]);
    if (id) p->id = id;
    if (!x || !radius || !material || !id) return fail_memory(r);
    r->capacity = (int64_t)n;
    return 0;
}

/* Moving it into the box would leave no digits of where it is. */
static bool is_far_outside(const packing *p, const double x[3])
{
    for (int d = 0; d < 3; d++)
        if (p->periodic[d] && fabs(x[d] - p->low[d]) > 1e6 * (p->high[d] - p->low[d])) return true;
    return false;
}

/* A particle from its six fields, in the order of COLUMNS. */
static int add_particle(reader *r, const double field[FIELDS])
{
    static const char *const name[FIELDS] = {"id", "x", "y", "z", "radius", "type"};
    packing *p = r->p;
    for (int f = 0; f < FIELDS; f++)
        if (!is_moderate(field[f])) return fail(r, "%s is not finite or beyond 1e100", name[f]);
    if (!(fabs(field[0]) < 0x1p53) || field[0] != floor(field[0])) return fail(r, "id is not an integer");
    if (!(field[4] > 1e-100)) return fail(r, "radius is not positive");
    if (!(field[5] >= 1 && field[5] <= PACKING_TYPE_MAX) || field[5] != floor(field[5]))
        return fail(r, "type is not an integer from 1 to %d", PACKING_TYPE_MAX);
    int64_t type = (int64_t)field[5];
    if (!is_type(r, type)) return fail(r, "type %lld has no material line", (long long)type);
    if (is_far_outside(p, field + 1)) return fail(r, "more than a million periods outside the box");
    if (p->count == r->expected) return fail(r, "more particles than N = %lld", (long long)r->expected);
    if (grow_particles(r)) return -1;
    memcpy(p->x[p->count], field + 1, sizeof p->x[0]);
    p->id[p->count] = (int64_t)field[0];
    p->radius[p->count] = field[4];
    p->material[p->count] = (int32_t)(type - 1);
    p->count++;
    return 0;
}

static int parse_row(reader *r)
{
    static const char *const ordinal[FIELDS] = {"first", "second", "third", "fourth", "fifth", "sixth"};
    double field[FIELDS];
    int fields = 1;
    for (const char *c = r->text; *c; c++) fields += *c == ',';
    if (fields != FIELDS) return fail(r, "%d fields instead of the %d of " COLUMNS, fields, FIELDS);
    const char *s = r->text;
    for (int f = 0; f < FIELDS; f++) {
        bool number = take_number(&s, &field[f]);
        skip_space(&s);
        if (!number || *s != (f + 1 < FIELDS ? ',' : '\0')) return fail(r, "the %s field is not a number", ordinal[f]);
        s++;
    }
    return add_particle(r, field);
}

/* ---- files */

/* The next line, without its end.  1: there is one; 0: end of file; -1: failure. */
static int next_line(reader *r)
{
    size_t n = 0;
    int c;
    r->cut = false;
    r->line++;
    while ((c = getc_unlocked(r->file)) != EOF && c != '\n') {
        if (n < PACKING_LINE_MAX)
            r->text[n++] = (char)c;
        else
            r->cut = true;
    }
    if (ferror(r->file)) return fail(r, "cannot be read: %s", strerror(errno));
    if (c == EOF && n == 0) return 0;
    if (n > 0 && r->text[n - 1] == '\r') n--;
    r->text[n] = '\0';
    if (memchr(r->text, '\0', n)) return fail(r, "a zero byte: this is not a text file");
    if (r->cut && r->text[0] != '#') return fail(r, "longer than %d bytes", PACKING_LINE_MAX);
    return 1;
}

/* The line that ends the header of a text file. */
static int parse_columns(reader *r)
{
    const char *s = r->text;
    if (r->data_name) return fail(r, "particles here, although a data file is named");
    skip_space(&s);
    if (strncmp(s, COLUMNS, strlen(COLUMNS)) != 0 || !at_end(s + strlen(COLUMNS)))
        return fail(r, "expected the line '" COLUMNS "' before the particles");
    return finish_header(r);
}

/* One line of a text file.  header: are we before the line of column names? */
static int parse_line(reader *r, bool *header)
{
    if (r->text[0] == '#') return *header ? parse_header_line(r) : 0;
    if (at_end(r->text)) return 0;
    if (!*header) return parse_row(r);
    *header = false;
    return parse_columns(r);
}

static void show_progress(reader *r)
{
    if (r->show_progress && r->p->count % CHUNK_ROWS == 0) timing_progress_update(&r->progress, r->p->count, r->expected);
}

static int check_count(reader *r)
{
    if (r->p->count == r->expected) return 0;
    return fail(r, "the file ends after %lld of N = %lld particles", (long long)r->p->count, (long long)r->expected);
}

/* A file of lines: all of a packing, or the header of a binary one. */
static int read_text(reader *r, bool has_data)
{
    bool header = true;
    int got;
    while ((got = next_line(r)) == 1) {
        if (parse_line(r, &header)) return -1;
        show_progress(r);
    }
    if (got < 0) return -1;
    if (!header) return check_count(r);
    if (r->line == 1) return fail(r, "the file is empty");
    if (!has_data && !r->data_name) return fail(r, "neither the line '" COLUMNS "' nor a line '# data: ...'");
    return finish_header(r);
}

static double double_from_little_endian(const unsigned char *bytes)
{
    uint64_t b = 0;
    double x;
    for (int k = 7; k >= 0; k--) b = b << 8 | bytes[k];
    memcpy(&x, &b, sizeof x);
    return x;
}

static int parse_binary_row(reader *r, const unsigned char *bytes)
{
    double field[FIELDS];
    field[0] = (double)++r->line;
    for (int f = 0; f < ROW_DOUBLES; f++) field[f + 1] = double_from_little_endian(bytes + 8 * f);
    return add_particle(r, field);
}

static int read_binary(reader *r)
{
    enum { ROW = 8 * ROW_DOUBLES };
    unsigned char bytes[CHUNK_ROWS * ROW];
    size_t got;
    while ((got = fread(bytes, 1, sizeof bytes, r->file)) > 0) {
        for (size_t at = 0; at + ROW <= got; at += ROW)
            if (parse_binary_row(r, bytes + at)) return -1;
        if (got % ROW != 0) {
            r->line++;
            return fail(r, "the file ends within this row");
        }
        show_progress(r);
    }
    if (ferror(r->file)) return fail(r, "cannot be read: %s", strerror(errno));
    return check_count(r);
}

static int open_file(reader *r, const char *path, const char *mode)
{
    r->path = path;
    r->line = 0;
    r->file = fopen(path, mode);
    if (r->file) return 0;
    snprintf(r->error, r->error_size, "%s: cannot be opened: %s", path, strerror(errno));
    return -1;
}

/* Reads one file with one of the two functions above. */
static int read_header_file(reader *r, const char *path, bool has_data)
{
    if (open_file(r, path, "r")) return -1;
    int status = read_text(r, has_data);
    fclose(r->file);
    return status;
}

static int read_data_file(reader *r, const char *path)
{
    if (open_file(r, path, "rb")) return -1;
    r->binary = true;
    int status = read_binary(r);
    fclose(r->file);
    return status;
}

/* The first n bytes of a path with something behind them; NULL: out of memory. */
static char *join_path(const char *path, size_t n, const char *tail)
{
    char *joined = malloc(n + strlen(tail) + 1);
    if (!joined) return NULL;
    memcpy(joined, path, n);
    memcpy(joined + n, tail, strlen(tail) + 1);
    return joined;
}

static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

static bool has_suffix(const char *path, const char *suffix)
{
    size_t n = strlen(path), m = strlen(suffix);
    return n > m && strcmp(path + n - m, suffix) == 0;
}

/* The user named the data file: its header is beside it. */
static int read_beside(reader *r, const char *path)
{
    char *header = join_path(path, strlen(path) - strlen(DATA_SUFFIX), HEADER_SUFFIX);
    if (!header) return fail_memory(r);
    int status = read_header_file(r, header, true);
    free(header);
    return status ? status : read_data_file(r, path);
}

/* The user named a text file: it holds all, or names the data file. */
static int read_named(reader *r, const char *path)
{
    int status = read_header_file(r, path, false);
    if (status || !r->data_name) return status;
    char *data = join_path(path, folder_length(path), r->data_name);
    if (!data) return fail_memory(r);
    status = read_data_file(r, data);
    free(data);
    return status;
}

/* A packing without a name is called like its file. */
static int default_name(reader *r, const char *path)
{
    r->path = path;
    if (r->p->name) return 0;
    r->p->name = copy_text(path + folder_length(path), '.');
    return r->p->name ? 0 : fail_memory(r);
}

int packing_read(packing *p, const char *path, bool progress, char *error, size_t error_size)
{
    reader r = {.p = p, .path = path, .show_progress = progress, .error = error, .error_size = error_size};
    memset(p, 0, sizeof *p);
    if (error_size > 0) error[0] = '\0';
    timing_progress_begin(&r.progress, "particles read");
    int status = has_suffix(path, DATA_SUFFIX) ? read_beside(&r, path) : read_named(&r, path);
    if (!status) status = default_name(&r, path);
    timing_progress_end(&r.progress);
    free(r.data_name);
    free(r.wall_type);
    return status;
}

void packing_free(packing *p)
{
    free(p->name);
    free(p->x);
    free(p->radius);
    free(p->material);
    free(p->id);
    free(p->materials);
    free(p->walls);
    free(p->wall_material);
    memset(p, 0, sizeof *p);
}

void packing_position(const packing *p, int64_t k, double x[3])
{
    for (int d = 0; d < 3; d++) {
        double edge = p->high[d] - p->low[d];
        x[d] = p->x[k][d];
        if (p->periodic[d]) x[d] -= floor((x[d] - p->low[d]) / edge) * edge;
    }
}

nlc_particles packing_particles(const packing *p)
{
    nlc_particles q = {
        .struct_size = sizeof q,
        .count = p->count,
        .radius = p->radius,
        .material = p->material,
        .materials = p->materials,
        .material_count = p->material_count,
        .material_size = sizeof p->materials[0],
        .wall_material = p->wall_material,
        .wall_count = p->wall_count,
    };
    return q;
}

double packing_volume(const packing *p)
{
    return (p->high[0] - p->low[0]) * (p->high[1] - p->low[1]) * (p->high[2] - p->low[2]);
}
