/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * main.c - a fuzzing program without a fuzzer.
 *
 *     PROGRAM [FILE | FOLDER]...            replays files; without one what comes from stdin, or all that AFL++ hands over
 *     PROGRAM --random COUNT SEED [...]     that many inputs: the files, altered at random, and random bytes
 */
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz.h"

enum { LONGEST = 1 << 16, MOST = 4096 };

static struct input {
    uint8_t *data;
    size_t size;
} inputs[MOST];
static size_t input_count;
static struct input current; /* the one that is being tried */

static void add_stream(FILE *f)
{
    uint8_t *data = malloc(LONGEST);
    if (!data || input_count == MOST) exit(2);
    inputs[input_count++] = (struct input){data, fread(data, 1, LONGEST, f)};
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

/* A file, or all those of a folder. */
static void add(const char *path)
{
    struct dirent **entries;
    const int count = scandir(path, &entries, NULL, by_name);
    for (int k = 0; k < count; k++) {
        char name[4096];
        if (entries[k]->d_name[0] != '.' && snprintf(name, sizeof name, "%s/%s", path, entries[k]->d_name) < (int)sizeof name) add(name);
        free(entries[k]);
    }
    if (count >= 0) {
        free(entries);
        return;
    }
    FILE *f = fopen(path, "rb");
    if (!f) {
        perror(path);
        exit(2);
    }
    add_stream(f);
    fclose(f);
}

/* splitmix64 */
static uint64_t next(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* A few bytes changed, put in or taken out; parts of two inputs; or nothing but random bytes.  Returns the size. */
static size_t alter(uint8_t *to, uint64_t *g)
{
    size_t size = 0;
    if (input_count > 0 && next(g) % 16 != 0) {
        const struct input a = inputs[next(g) % input_count], b = inputs[next(g) % input_count];
        const bool cross = next(g) % 4 == 0 && a.size > 0;
        size = cross ? next(g) % a.size : a.size;
        memcpy(to, a.data, size);
        if (cross && b.size > size) {
            memcpy(to + size, b.data + size, b.size - size);
            size = b.size;
        }
    } else {
        size = next(g) % 400;
        for (size_t k = 0; k < size; k++) to[k] = (uint8_t)next(g);
    }
    for (uint64_t changes = next(g) % 6; changes > 0 && size > 0; changes--) {
        const size_t at = next(g) % size;
        switch (next(g) % 4) {
        case 0: to[at] = (uint8_t)next(g); break;
        case 1: to[at] ^= (uint8_t)(1u << next(g) % 8); break;
        case 2: memmove(to + at, to + at + 1, --size - at); break;
        default:
            if (size == LONGEST) break;
            memmove(to + at + 1, to + at, size++ - at);
            to[at] = (uint8_t)next(g);
        }
    }
    return size;
}

/* An input in memory of just its size, so that reading behind it is seen. */
static void try(const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size + (size == 0));
    if (!copy) exit(2);
    memcpy(copy, data, size);
    current = (struct input){copy, size};
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
}

/* The input that did it is kept, in the working directory. */
static void keep(int number)
{
    static volatile sig_atomic_t others; /* threads */
    while (others++ > 0) pause();
    const int file = open("fuzz-failed-input", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file >= 0 && write(file, current.data, current.size) == (ssize_t)current.size) close(file);
    signal(number, SIG_DFL);
    raise(number);
}

/* With AFL++'s compiler: one input after the other in the same process, from memory. */
#if defined(__AFL_FUZZ_TESTCASE_LEN)
__AFL_FUZZ_INIT();
static void take_turns(void)
{
    const uint8_t *data = __AFL_FUZZ_TESTCASE_BUF;
    while (__AFL_LOOP(100000)) try(data, (size_t)__AFL_FUZZ_TESTCASE_LEN);
}
#else
static void take_turns(void)
{
    add_stream(stdin);
}
#endif

int main(int argc, char **argv)
{
    uint64_t count = 0, state = 0;
    int first = 1;
    if (argc > 3 && strcmp(argv[1], "--random") == 0) {
        count = (uint64_t)strtod(argv[2], NULL);
        state = strtoull(argv[3], NULL, 0);
        first = 4;
    }
    for (int k = first; k < argc; k++) add(argv[k]);
    for (const int *s = (const int[]){SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, 0}; *s != 0; s++) signal(*s, keep);
    if (argc == 1) take_turns();
    for (size_t k = 0; k < input_count; k++) try(inputs[k].data, inputs[k].size);
    static uint8_t altered[LONGEST];
    for (uint64_t k = 0; k < count; k++) {
        const size_t size = alter(altered, &state);
        try(altered, size);
    }
    const char *slash = strrchr(argv[0], '/');
    printf("%s: %zu inputs, %llu altered ones: ok\n", slash ? slash + 1 : argv[0], input_count, (unsigned long long)count);
    for (size_t k = 0; k < input_count; k++) free(inputs[k].data);
    return 0;
}
