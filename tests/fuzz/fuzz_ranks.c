/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fuzz_ranks.c - a network shared out between two ranks, which take turns in this process, and what they call together.
 *
 * What is demanded: both make the same calls, in turn, with the same counts, and none waits for ever; both succeed with the same
 * warnings or both fail; both find the same forces; nothing changes on an error.  Everything is done three times: the second time a
 * call fails on one rank, or two do, which both have to say, the third time nothing may be left of that.
 */
#include "fuzz.h"

#include <math.h>
#include <string.h>

#if defined(__x86_64__) && defined(__LP64__) && defined(__ELF__) && !defined(__CET__)
#define OWN_SWITCH
#elif defined(__GLIBC__)
#include <ucontext.h> /* ten times as fast as threads, and not everywhere */
#else
#include <pthread.h>
#endif

enum { RANKS = 2, PARTICLES = 9, CONTACTS = 16, BODIES = PARTICLES + 1, STEPS = 4, WORK = 250, MOST_VALUES = 1000 };
enum { ODD_OVERLAPS, ODD_NORMALS, ODD_STARTS, ODD_OPTIONS, ODD_FORCES }; /* what may be arbitrary */
enum { RADIUS, MATERIAL, FIRST_BODY, SECOND_BODY, OVERLAP, NORMAL, STIFFNESS, MEMORY, FORCE, NONLOCAL, SIDES, RESULT, CHANGE, USED };
_Static_assert((int)RANKS * (int)USED <= (int)ROOMS, "too few rooms");

static const nlc_material materials[4] = {{1e9, 0.3}, {4e9, 0}, {1e7, 0.5}, {INFINITY, 0.2}};

/* All of it; a wall is the last body. */
static struct {
    int64_t particles, contacts;
    int owner[BODIES]; /* of a wall: -1 */
    double radius[PARTICLES], overlap[CONTACTS], normal[CONTACTS][3], stiffness[CONTACTS], start[CONTACTS], change[CONTACTS];
    int32_t material[BODIES], end[CONTACTS][2];
    nlc_options options;
} whole;

typedef struct rank {
    int64_t particles, owned, contacts;
    int64_t contact[CONTACTS]; /* number in the whole */
    int64_t here[CONTACTS];    /* of the whole's: number here, -1: none */
    int64_t reversed;          /* whether i and j are exchanged here */
    int32_t *i, *j;
    double *overlap, *normal, *force, *nonlocal, *sides, *result, *change;
    nlc_network *network;
    nlc_info info;
    nlc_status status;
    size_t results;            /* in result */
    double *values;            /* in a callback: what, of what kind, how many */
    int kind;
    int32_t count, fixed[3];
    int64_t calls, done, fail_at[2];
    bool finished;
} rank;

static rank ranks[RANKS];
static int task; /* what both do */

/* ---- turns: one rank works, until it has to wait for the other one */

static void begin(rank *r);

#if defined(OWN_SWITCH)

/* swapcontext asks the system twice and has the address sanitizer forget what it knows of a stack; this takes a few instructions. */
static void *stopped[RANKS]; /* where a rank waits: its stack, with what a function has to keep on top */
static _Alignas(16) char stack[1 << 22]; /* of the second rank; the first one has that of the program */

void fuzz_switch(void **from, void *to);
__asm__(".text\n"
        ".globl fuzz_switch\n"
        "fuzz_switch:\n"
        "    pushq %rbp\n    pushq %rbx\n    pushq %r12\n    pushq %r13\n    pushq %r14\n    pushq %r15\n    subq $8, %rsp\n"
        "    stmxcsr (%rsp)\n    fnstcw 4(%rsp)\n" /* which exceptions trap is a matter of each rank */
        "    movq %rsp, (%rdi)\n    movq %rsi, %rsp\n"
        "    ldmxcsr (%rsp)\n    fldcw 4(%rsp)\n"
        "    addq $8, %rsp\n    popq %r15\n    popq %r14\n    popq %r13\n    popq %r12\n    popq %rbx\n    popq %rbp\n    ret\n");

static void pass_on(int from)
{
    fuzz_switch(&stopped[from], stopped[1 - from]);
}

static void begin_second(void)
{
    begin(&ranks[1]);
    for (;;) pass_on(1); /* once: to a rank that waits or has finished */
}

static void begin_both(void)
{
    struct { /* as fuzz_switch leaves it, at the beginning of a program */
        uint32_t csr;
        uint16_t control, unused;
        uint64_t registers[6];
        void (*behind)(void);
        uint64_t aligned;
    } top = {.csr = 0x1f80, .control = 0x37f, .behind = begin_second};
    stopped[1] = memcpy(stack + sizeof stack - sizeof top, &top, sizeof top);
    begin(&ranks[0]);
    while (!ranks[1].finished) pass_on(0);
}

#elif defined(__GLIBC__)

static ucontext_t contexts[RANKS];
static char stack[1 << 22]; /* of the second rank; the first one has that of the program */

static void begin_second(void)
{
    begin(&ranks[1]);
}

static void pass_on(int from)
{
    demand(swapcontext(&contexts[from], &contexts[1 - from]) == 0, "swapcontext");
}

static void begin_both(void)
{
    demand(getcontext(&contexts[1]) == 0, "getcontext");
    contexts[1].uc_stack.ss_sp = stack, contexts[1].uc_stack.ss_size = sizeof stack;
    contexts[1].uc_link = &contexts[0]; /* the first one is in pass_on by then, or below */
    makecontext(&contexts[1], begin_second, 0);
    begin(&ranks[0]);
    while (!ranks[1].finished) pass_on(0);
}

#else

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static int turn; /* whose it is */

static void pass_on(int from)
{
    pthread_mutex_lock(&mutex);
    turn = 1 - from;
    pthread_cond_broadcast(&changed);
    while (turn != from && !ranks[1 - from].finished) pthread_cond_wait(&changed, &mutex);
    pthread_mutex_unlock(&mutex);
}

static void *begin_second(void *unused)
{
    pthread_mutex_lock(&mutex);
    while (turn != 1) pthread_cond_wait(&changed, &mutex);
    pthread_mutex_unlock(&mutex);
    begin(&ranks[1]);
    pthread_mutex_lock(&mutex);
    ranks[1].finished = true;
    pthread_cond_broadcast(&changed);
    pthread_mutex_unlock(&mutex);
    return unused;
}

static void begin_both(void)
{
    pthread_t second;
    turn = 0;
    demand(pthread_create(&second, NULL, begin_second, NULL) == 0, "pthread_create");
    begin(&ranks[0]);
    if (!ranks[1].finished) pass_on(0);
    pthread_join(second, NULL);
}

#endif

/* ---- callbacks */

enum { EXCHANGE, SUMS, MAXIMA };

static void combine_sides(void)
{
    for (int64_t c = 0; c < whole.contacts; c++) {
        const int64_t a = ranks[0].here[c], b = ranks[1].here[c];
        if (a < 0 || b < 0) continue;
        for (int64_t e = 0; e < 2; e++) { /* from the owner of that end to the other rank */
            double *const side[RANKS] = {ranks[0].values + 2 * a + (e ^ ranks[0].reversed), ranks[1].values + 2 * b + (e ^ ranks[1].reversed)};
            const int from = whole.owner[whole.end[c][e]];
            demand(isfinite(*side[from]), "a number for another rank");
            *side[1 - from] = *side[from];
        }
    }
}

/* Not watched, for speed: what is handed over is copied where sanitizers see it, and these are arrays of our own. */
#if defined(__clang__)
#define UNWATCHED __attribute__((no_sanitize("address", "undefined")))
#else
#define UNWATCHED
#endif

static double reduced[RANKS][MOST_VALUES];

UNWATCHED static bool are_numbers(int32_t count)
{
    bool good = true;
    for (int32_t k = 0; k < count; k++) good &= !isnan(reduced[0][k]) & !isnan(reduced[1][k]);
    return good;
}

UNWATCHED static void add(int32_t count)
{
    for (int32_t k = 0; k < count; k++) reduced[0][k] += reduced[1][k];
}

UNWATCHED static void take_larger(int32_t count)
{
    for (int32_t k = 0; k < count; k++) reduced[0][k] = reduced[0][k] > reduced[1][k] ? reduced[0][k] : reduced[1][k];
}

/* Two loops: of a choice in one, compilers make both, and the sum of what has just to be compared may overflow. */
static void combine(int kind, int32_t count)
{
    const size_t size = (size_t)count * sizeof(double);
    if (kind == EXCHANGE) {
        combine_sides();
        return;
    }
    demand(count > 0 && count <= MOST_VALUES, "how much is to be reduced");
    for (int q = 0; q < RANKS; q++) memcpy(reduced[q], ranks[q].values, size);
    demand(are_numbers(count), "a number to be reduced");
    if (kind == SUMS) add(count);
    else take_larger(count);
    for (int q = 0; q < RANKS; q++) memcpy(ranks[q].values, reduced[0], size);
}

static int meet(rank *r, double *values, int32_t count, int kind)
{
    rank *other = &ranks[r == ranks];
    demand(r->calls % 3 == kind && (r->fixed[kind] == 0 || r->fixed[kind] == count), "a call out of turn");
    r->fixed[kind] = count;
    r->values = values, r->count = count, r->kind = kind;
    if (++r->calls == other->calls) {
        demand(other->kind == kind && (kind == EXCHANGE || other->count == count), "what the other rank calls");
        combine(kind, count);
        r->done = other->done = r->calls;
    }
    if (r->done < r->calls && !other->finished) pass_on((int)(r - ranks));
    demand(r->done == r->calls, "the other rank is no longer there");
    if (r->calls != r->fail_at[0] && r->calls != r->fail_at[1]) return 0;
    for (int64_t e = 0; kind == EXCHANGE && e < 2 * r->contacts; e++) /* a ghost's side; all of a reduction */
        if ((e % 2 ? r->j : r->i)[e / 2] >= r->owned && (e % 2 ? r->j : r->i)[e / 2] < r->particles) values[e] = NAN;
    for (int32_t k = 0; kind != EXCHANGE && k < count; k++) values[k] = NAN;
    return 1000 + (int)(r - ranks);
}

static int exchange(void *context, double *side)
{
    return meet(context, side, 0, EXCHANGE);
}

static int reduce(void *context, double *values, int32_t count, int32_t operation)
{
    return meet(context, values, count, operation == NLC_REDUCE_SUM ? SUMS : MAXIMA);
}

/* ---- making */

/* A bound for max_sweeps: nine tenths of the time went into a fifth of the inputs, solves that do not converge. */
static int64_t most_sweeps(bool large)
{
    int64_t contacts[BODIES] = {0}, pairs = 1; /* of contacts that share a particle */
    for (int64_t e = 0; e < 2 * whole.contacts; e++) pairs += 2 * contacts[whole.end[e / 2][e % 2]]++ + 1;
    return large ? INT64_MAX : 2 + WORK / pairs;
}

static void make_whole(bytes *in, uint64_t odd, bool large)
{
    memset(&whole, 0, sizeof whole);
    whole.particles = 1 + (int64_t)(take(in, 1) % PARTICLES);
    whole.contacts = (int64_t)(take(in, 1) % (CONTACTS + 1));
    for (int64_t k = 0; k <= whole.particles; k++) {
        const uint64_t kind = take(in, 1);
        whole.owner[k] = k < whole.particles ? (int)(kind & 1) : -1;
        whole.material[k] = (int32_t)(kind >> 1 & 1) + 2 * (kind >> 2 > 60);
        if (k < whole.particles) whole.radius[k] = 1 + (double)(kind >> 3) / 31;
    }
    for (int64_t c = 0; c < whole.contacts; c++) {
        double *n = whole.normal[c];
        whole.end[c][0] = (int32_t)((int64_t)take(in, 1) % whole.particles);
        whole.end[c][1] = (int32_t)((int64_t)take(in, 1) % (whole.particles + 1));
        whole.overlap[c] = take_bit(in, odd, ODD_OVERLAPS) ? take_any(in) : (double)((int64_t)take(in, 2) - 20000) / 65536 * 0.15;
        take_unit(in, (uint64_t)c, n);
        if (take_bit(in, odd, ODD_NORMALS)) n[take(in, 1) % 3] = take_any(in);
        whole.stiffness[c] = 1e9 * (1 + (double)(c % 3));
        whole.change[c] = 1e-4 * (double)(c % 5 - 2);
    }
    nlc_options *o = &whole.options;
    const uint64_t kind = take(in, 1), sweeps = take(in, 1);
    *o = (nlc_options){.struct_size = sizeof *o, .model = (int32_t)(kind % 6), .method = kind / 6 % 8 == 1, .points = (int32_t)(kind >> 7)};
    o->tolerance = ldexp(1, -(int)(take(in, 1) % 50));
    const int64_t wanted = 1 + (int64_t)(sweeps / 2), most = most_sweeps(large);
    o->max_sweeps = wanted < most ? wanted : most;
    if (take_bit(in, odd, ODD_OPTIONS)) o->prefactor = (double)take(in, 1) / 64;
    if (take_bit(in, odd, ODD_OPTIONS)) o->stiffness = whole.stiffness;
}

#define ARRAY(r, number, count, type) ((type *)room((int)((r) - ranks) * USED + (number), (size_t)(count) * sizeof(type), true, 0))

/* Numbers of the bodies of a rank: its own particles, ghosts, the wall; -1: not there. */
static void number(rank *r, int32_t *place)
{
    const int own = (int)(r - ranks);
    bool wanted[BODIES] = {false};
    for (int64_t c = 0; c < whole.contacts; c++) {
        const int32_t *e = whole.end[c];
        if (whole.owner[e[0]] == own || whole.owner[e[1]] == own) wanted[e[0]] = wanted[e[1]] = true;
    }
    r->particles = 0;
    for (int64_t k = 0; k < whole.particles; k++) place[k] = -1;
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t k = 0; k < whole.particles; k++)
            if (pass == 0 ? whole.owner[k] == own : wanted[k] && whole.owner[k] != own) place[k] = (int32_t)r->particles++;
        if (pass == 0) r->owned = r->particles;
    }
    place[whole.particles] = (int32_t)r->particles;
}

/* The network of a rank; whether there is one. */
static bool make_rank(rank *r, bytes *in, uint64_t odd)
{
    int32_t place[BODIES];
    *r = (rank){.reversed = (int64_t)(take(in, 1) & 1)};
    number(r, place);
    for (int64_t c = 0; c < whole.contacts; c++) {
        const bool here = whole.owner[whole.end[c][0]] == r - ranks || whole.owner[whole.end[c][1]] == r - ranks;
        r->here[c] = here ? r->contacts : -1;
        if (here) r->contact[r->contacts++] = c;
    }
    const int64_t n = r->contacts;
    double *radius = ARRAY(r, RADIUS, r->particles, double), *k = ARRAY(r, STIFFNESS, n, double);
    int32_t *material = ARRAY(r, MATERIAL, r->particles, int32_t);
    for (int64_t b = 0; b < whole.particles; b++)
        if (place[b] >= 0) radius[place[b]] = whole.radius[b], material[place[b]] = whole.material[b];
    r->i = ARRAY(r, FIRST_BODY, n, int32_t), r->j = ARRAY(r, SECOND_BODY, n, int32_t);
    r->overlap = ARRAY(r, OVERLAP, n, double), r->normal = ARRAY(r, NORMAL, 3 * n, double);
    r->force = ARRAY(r, FORCE, n, double), r->nonlocal = ARRAY(r, NONLOCAL, n, double);
    r->sides = ARRAY(r, SIDES, 2 * n, double), r->change = ARRAY(r, CHANGE, n, double);
    r->results = (size_t)(n > r->particles ? n : r->particles > 0 ? r->particles : 1);
    r->result = ARRAY(r, RESULT, r->results, double);
    for (int64_t c = 0; c < n; c++) {
        const int64_t w = r->contact[c];
        r->i[c] = place[whole.end[w][r->reversed]], r->j[c] = place[whole.end[w][!r->reversed]];
        for (int x = 0; x < 3; x++) r->normal[3 * c + x] = r->reversed ? -whole.normal[w][x] : whole.normal[w][x];
        r->overlap[c] = whole.overlap[w], r->change[c] = whole.change[w], k[c] = whole.stiffness[w];
        r->force[c] = r->sides[2 * c] = r->sides[2 * c + 1] = 0;
        r->nonlocal[c] = take_bit(in, odd, ODD_STARTS) ? take_any(in) : 0;
    }
    nlc_options o = whole.options;
    o.owned_particles = r->owned, o.exchange = exchange, o.reduce = reduce, o.context = r;
    if (o.stiffness) o.stiffness = k;
    if (take_bit(in, odd, ODD_OPTIONS)) o.tolerance *= 1 + (double)(take(in, 1) % 4);
    const nlc_particles p = {.struct_size = sizeof p, .count = r->particles, .radius = radius, .material = material, .materials = materials,
                             .material_count = 4, .wall_material = &whole.material[whole.particles], .wall_count = 1};
    const size_t size = nlc_network_size(&p, n, &o);
    return CALL(nlc_network_init(&r->network, ARRAY(r, MEMORY, size, char), size, &p, r->i, r->j, n, &o, NULL), 0, NLC_ERROR_RIGID_RIGID,
                NLC_ERROR_RANGE) == NLC_OK;
}

/* ---- what is called */

enum { SOLVE, SWEEP, ENERGY, TANGENT, INVERSE, BOUND, TASKS };

static nlc_status perform(rank *r)
{
    switch (task) {
    case SOLVE: return nlc_solve(r->network, r->force, r->nonlocal, r->overlap, r->normal, &r->info);
    case SWEEP: return nlc_sweep(r->network, r->sides, r->force, r->overlap, r->normal, &r->info);
    case ENERGY: return nlc_energy(r->network, r->result, r->force, r->overlap, r->normal, &r->info);
    case TANGENT: return nlc_tangent(r->network, r->result, r->change, r->force, r->normal, &r->info);
    case INVERSE: return nlc_tangent_inverse(r->network, r->result, r->change, r->force, r->normal, &r->info);
    default: return nlc_tangent_bound(r->network, r->result, r->force, r->normal, &r->info);
    }
}

static void begin(rank *r)
{
    watch();
    r->status = perform(r);
    unwatch("a collective function");
#if defined(OWN_SWITCH) || defined(__GLIBC__)
    r->finished = true; /* of threads it is told by begin_second */
#else
    if (r == ranks) r->finished = true;
#endif
}

/* Two calls that fail, each on a rank; 0: none. */
typedef struct failure {
    int where[2];
    int64_t at[2];
} failure;

/* Both at the same time. */
static void run(failure f)
{
    for (int q = 0; q < RANKS; q++) {
        rank *r = &ranks[q];
        r->info = (nlc_info){.struct_size = sizeof r->info};
        r->calls = r->done = 0, r->finished = false;
        for (int k = 0; k < 2; k++) r->fail_at[k] = q == f.where[k] ? f.at[k] : 0;
        memset(r->fixed, 0, sizeof r->fixed);
    }
    begin_both();
    demand(ranks[0].calls == ranks[1].calls, "calls of the ranks");
}

/* ---- what came of it */

typedef struct kept {
    double force[CONTACTS], nonlocal[CONTACTS], sides[2 * CONTACTS], result[CONTACTS];
    nlc_status status;
    nlc_info info;
    int64_t calls;
} kept;

static void keep(const rank *r, kept *k)
{
    const size_t n = (size_t)r->contacts * sizeof(double);
    memset(k, 0, sizeof *k);
    copy_bytes(k->force, r->force, n), copy_bytes(k->nonlocal, r->nonlocal, n), copy_bytes(k->sides, r->sides, 2 * n);
    copy_bytes(k->result, r->result, r->results * sizeof(double));
    k->status = r->status, k->info = r->info, k->calls = r->calls;
}

static void put_back(const rank *r, const kept *k)
{
    const size_t n = (size_t)r->contacts * sizeof(double);
    copy_bytes(r->force, k->force, n), copy_bytes(r->nonlocal, k->nonlocal, n), copy_bytes(r->sides, k->sides, 2 * n);
    copy_bytes(r->result, k->result, r->results * sizeof(double));
}

static bool is_same(const rank *r, const kept *k)
{
    kept now;
    keep(r, &now);
    return memcmp(&now, k, offsetof(kept, status)) == 0;
}

/* One without callbacks that fail. */
static void look(const kept *before)
{
    const rank *a = &ranks[0], *b = &ranks[1];
    demand((a->status < 0) == (b->status < 0), "an error on one rank alone");
    demand(a->status != NLC_ERROR_REMOTE || b->status != NLC_ERROR_REMOTE, "an error of nobody");
    for (int q = 0; q < RANKS; q++) {
        static const nlc_status errors[] = {NLC_ERROR_NO_POTENTIAL, NLC_ERROR_MEMORY_SIZE, NLC_ERROR_OPTION, NLC_ERROR_OVERLAP, NLC_ERROR_NORMAL, NLC_ERROR_NONLOCAL,
                                            NLC_ERROR_FORCE, NLC_ERROR_COINCIDENT, NLC_ERROR_RANGE, NLC_ERROR_UNSTABLE, NLC_ERROR_REMOTE, 0};
        const rank *r = &ranks[q];
        bool known = r->status >= 0 && r->status < 16;
        for (const nlc_status *e = errors; *e != 0; e++) known = known || r->status == *e;
        demand(known, "the status");
        if (r->status < 0) demand(is_same(r, &before[q]), "results after an error");
        else if (task == SOLVE) demand(all_finite(r->force, (size_t)r->contacts) && all_finite(r->nonlocal, (size_t)r->contacts), "results");
        else if (task == SWEEP) demand(all_finite(r->sides, 2 * (size_t)r->contacts), "results");
        else demand(all_finite(r->result, task == ENERGY ? 1 : (size_t)(task == BOUND ? r->particles : r->contacts)), "results");
    }
    if (a->status < 0) return;
    demand(a->status == b->status && a->info.sweeps == b->info.sweeps && a->info.active == b->info.active &&
               a->info.weakened == b->info.weakened && same_bytes(&a->info.residual, &b->info.residual, sizeof(double)) &&
               same_bytes(&a->info.lambda_upper, &b->info.lambda_upper, sizeof(double)),
           "what both say of the whole");
    for (int64_t c = 0; task == SOLVE && c < whole.contacts; c++) {
        const int64_t k = a->here[c], m = b->here[c];
        if (k >= 0 && m >= 0) demand(fabs(a->force[k] - b->force[m]) <= 1e-9 * fabs(a->force[k]), "the forces on both ranks");
    }
}

/* One with calls that failed, and what came of it without. */
static void look_at_failure(failure f, const kept *before, const kept *without)
{
    const int64_t at = f.at[1] > 0 && f.at[1] < f.at[0] ? f.at[1] : f.at[0], more = f.at[1] > 0 ? 6 : 3;
    const bool last = at == without[0].calls;
    for (int q = 0; q < RANKS; q++) {
        const rank *r = &ranks[q];
        bool here = false;
        for (int k = 0; k < 2; k++) here |= f.at[k] > 0 && f.where[k] == q && f.at[k] <= r->calls;
        if (at > without[q].calls || (last && !here && r->status == without[q].status)) {
            demand(r->status == without[q].status && is_same(r, &without[q]), "what no failure concerns");
            continue;
        }
        demand(r->status == (here ? NLC_ERROR_CALLBACK : NLC_ERROR_REMOTE) || (r->status < 0 && r->status == without[q].status) ||
                   r->status == NLC_ERROR_OPTION, "the status of a failure");
        demand(r->status != NLC_ERROR_CALLBACK || r->info.culprit == 1000 + q, "what the callback returned");
        demand(r->calls <= at + more && is_same(r, &before[q]), "results after a failure");
    }
}

static void step(bytes *in, uint64_t odd)
{
    const uint64_t kind = take(in, 1);
    failure f = {{(int)(kind & 1), (int)(kind >> 2 & 1)}, {1 + (int64_t)take(in, 1), 0}};
    const int64_t next = f.at[0] % 3 == 0 ? f.at[0] + 2 : f.at[0] + 1; /* reduction; two in a row on one rank are not to be stood */
    if (kind & 2) f.at[1] = f.at[0] + (int64_t)(kind >> 3 & 7);
    if (f.at[0] % 3 != 1 && f.at[1] == next && f.where[0] == f.where[1]) f.at[1] = 0;
    kept before[RANKS], without[RANKS];
    for (int q = 0; q < RANKS; q++) keep(&ranks[q], &before[q]);
    run((failure){0});
    look(before);
    for (int q = 0; q < RANKS; q++) keep(&ranks[q], &without[q]), put_back(&ranks[q], &before[q]);
    run(f);
    look_at_failure(f, before, without);
    for (int q = 0; q < RANKS; q++) put_back(&ranks[q], &before[q]);
    run((failure){0});
    for (int q = 0; q < RANKS; q++)
        demand(is_same(&ranks[q], &without[q]) && ranks[q].status == without[q].status && ranks[q].calls == without[q].calls &&
                   same_bytes(&ranks[q].info, &without[q].info, sizeof(nlc_info)),
               "what a failure leaves");
    for (int q = 0; q < RANKS; q++)
        for (int64_t c = 0; c < ranks[q].contacts; c++) { /* the next step's state */
            if (take_bit(in, odd, ODD_FORCES)) ranks[q].force[c] = take_any(in);
            ranks[q].overlap[c] *= 1 + 1e-3 * (double)(ranks[q].contact[c] % 3);
        }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes in = {data, size};
    const uint64_t odd = take(&in, 1);
    make_whole(&in, odd, is_large(data, size));
    bool both = true;
    for (int q = 0; q < RANKS; q++) both = make_rank(&ranks[q], &in, odd) && both;
    task = SOLVE;
    for (int k = 0; both && k < STEPS && (k == 0 || in.left > 0); k++) {
        if (k > 0) task = (int)(take(&in, 1) % TASKS);
        step(&in, odd);
    }
    for (int k = 0; k < RANKS * USED; k++) demand(room_intact(k), "what lies around an array");
    return 0;
}
