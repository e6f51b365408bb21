/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * nlc-lammps.c - LAMMPS with nonlocal contact forces: used like lmp, mpirun -np N nlc-lammps -in script.
 *
 * The script is LAMMPS' own.  After its line 'fix nlc all external pf/callback 1 1' the program reads its variables and becomes
 * that fix's callback; without such a line it is lmp.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host.h"

/* The script in two files: up to the line of the fix, and what follows.  Rank 0 alone reads scripts. */
typedef struct script {
    char path[2][64];
    int found;
} script;

static script made;

static void remove_script(void)
{
    for (int k = 0; k < 2; k++)
        if (made.path[k][0]) unlink(made.path[k]);
}

void host_fail(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    fprintf(stderr, "nlc-lammps: ");
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
    remove_script();
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
    exit(EXIT_FAILURE);
}

void host_check(nlc_status status, const nlc_info *info, const char *what)
{
    if (status < 0) host_fail("%s: %s (%lld)", what, nlc_strerror(status), info ? (long long)info->culprit : -1);
}

void *host_room(void *old, size_t bytes)
{
    void *memory = realloc(old, bytes + 1);
    if (!memory) host_fail("no memory");
    return memory;
}

/* ------------------------------------------------------------------------------------------------------------- script -- */

static bool is_fix(const char *line)
{
    char id[NAME], style[NAME], mode[NAME];
    return sscanf(line, " fix %63s %*s %63s %63s", id, style, mode) == 3 && strcmp(id, FIX) == 0 &&
           strcmp(style, "external") == 0 && strcmp(mode, "pf/callback") == 0;
}

static FILE *temporary(char path[64])
{
    const char *folder = getenv("TMPDIR");
    snprintf(path, 64, "%s/nlc-lammps.XXXXXX", folder && strlen(folder) < 40 ? folder : "/tmp");
    const int descriptor = mkstemp(path);
    FILE *file = descriptor < 0 ? NULL : fdopen(descriptor, "w");
    if (!file) host_fail("%s cannot be made", path);
    return file;
}

static void split(const char *path, script *s)
{
    FILE *in = path ? fopen(path, "r") : stdin, *out = temporary(s->path[0]);
    char *line = NULL;
    size_t room = 0;
    if (!in) host_fail("%s cannot be read", path);
    while (getline(&line, &room, in) >= 0) {
        if (fputs(line, out) < 0) host_fail("%s cannot be written", s->path[s->found]);
        if (s->found || !is_fix(line)) continue;
        if (fclose(out) != 0) host_fail("%s cannot be written", s->path[0]);
        s->found = 1;
        out = temporary(s->path[1]);
    }
    if (fclose(out) != 0) host_fail("%s cannot be written", s->path[s->found]);
    if (path) fclose(in);
    free(line);
}

static const char *script_path(int argc, char **argv)
{
    for (int k = 1; k + 1 < argc; k++)
        if (strcmp(argv[k], "-in") == 0 || strcmp(argv[k], "-i") == 0) return argv[k + 1];
    return NULL;
}

/* Where LAMMPS is built with exceptions it returns from errors, elsewhere it ends the program. */
static void run(const host *h, const char *path)
{
    char message[1024];
    lammps_file(h->lammps, path);
    if (!lammps_config_has_exceptions() || !lammps_has_error(h->lammps)) return;
    lammps_get_last_error_message(h->lammps, message, sizeof message);
    host_fail("%s", message);
}

/* --------------------------------------------------------------------------------------------------------------- main -- */

static void release(host *h)
{
    void *memory[] = {h->c.i,      h->c.j,     h->c.atom_i,   h->c.atom_j, h->c.key,      h->c.stiffness, h->c.overlap,
                      h->c.normal, h->c.force, h->c.guess,    h->c.memory, h->c.nonlocal, h->c.previous,  h->set.material,
                      h->seen.tag, h->seen.x,  h->ghost_atom, h->type,     h->radius,   h->ghost_tag, h->ghost_owner};
    for (size_t k = 0; k < sizeof memory / sizeof *memory; k++) free(memory[k]);
    ranks_free(&h->ranks);
}

int main(int argc, char **argv)
{
    static host h;
    MPI_Init(&argc, &argv);
    ranks_init(&h.ranks, MPI_COMM_WORLD);
    h.solved = -1;
    atexit(remove_script); /* LAMMPS may end the program */
    if (h.ranks.rank == 0) split(script_path(argc, argv), &made);
    MPI_Bcast(&made, sizeof made, MPI_BYTE, 0, h.ranks.world);
    h.lammps = lammps_open(argc, argv, h.ranks.world, NULL);
    if (!h.lammps) host_fail("LAMMPS does not start");
    run(&h, made.path[0]);
    if (made.found) {
        settings_read(&h);
        output_prepare(&h);
        lammps_set_fix_external_callback(h.lammps, FIX, step_callback, &h);
        run(&h, made.path[1]);
    }
    output_times(&h);
    lammps_close(h.lammps);
    release(&h);
    MPI_Finalize();
    return EXIT_SUCCESS;
}
