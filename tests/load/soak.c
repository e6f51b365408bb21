/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * soak.c - one host that goes on for very many time steps.
 *
 *     soak [STEPS [SEED]]     default 4000, 1
 *
 * 108 spheres in a box of six walls, some 600 contacts and candidates: a crystal out of order whose spheres all vibrate, each
 * at rates of its own.  In every 500 steps the walls, apart at first, press it together and part again: lightly, or one time in
 * sixteen beyond the end of the stable branch.  The host does what hosts do: it lists neighbours anew as soon as nlc_reach and
 * the motion ask for it, in the same memory, carries displacements over, predicts, solves, assembles; with every 500 steps it
 * changes all options, in their turn every model.  Then
 *     no status is one that the header does not name for such a state, no exception is raised, errno and all bytes beyond what
 *     each call may write stay as they are, nothing is left beyond the end of the stable branch once the load is less, and the
 *     process does not grow;
 *     every 61 steps a network built in other memory finds, from the same start, the same bits, and from zeros the same
 *     forces to the tolerances of both and the same energy to their square;
 *     forces on spheres and walls sum up to 0 to rounding, and what they do along the way is what the elastic energy has lost.
 *
 * How long is long.  A host with a million contacts that takes 0.15 s for a step makes 6e5 steps in a day; the 1e6 of `make
 * load`, ten minutes or so, are more than a day and a half of it, and what `make check` runs is ten minutes.  A host with as
 * few contacts as this one makes 3e8 steps in a day, in 0.3 ms each: those are 1/300.  What grows with time alone counts steps,
 * not contacts, and nothing here is made anew but what a host makes anew.
 */
#include <errno.h>
#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "nlcontact.h"
#include "random.h"

enum { CELLS = 3, SPHERES = 4 * CELLS * CELLS * CELLS, WALLS = 6, CONTACTS = 32 * SPHERES, MATERIALS = 3 };
enum { GUARD = 64, GUARDED = 32, CYCLE = 500, COMPARED = 61 };
/* In mean radii, which are 1; APART is a strain.  Beyond the stable branch forces, and what they could close, have no bound. */
static const double VIBRATION = 0.01, APART = 0.01, SLACK = 0.04, MOST_REACH = 0.8;

/* What belongs to the contacts of one list. */
typedef struct contacts {
    int64_t count;
    int32_t *i, *j;
    uint64_t *key;
    double *overlap, *normal, *force, *nonlocal, *previous, *start;
} contacts;

static double radius[SPHERES], place[SPHERES][3], rate[SPHERES][3], phase[SPHERES][3];
static int32_t material[SPHERES], wall_material[WALLS], later[SPHERES], length[SPHERES], *neighbour[SPHERES];
static double wall_place[WALLS][3], wall_normal[WALLS][3];
static nlc_material materials[MATERIALS] = {{1, 0.46}, {2, 0.4}, {INFINITY, 0}};

static double x[SPHERES + WALLS][3], listed[SPHERES + WALLS][3];      /* where all are, and were when listed; walls: a point */
static double last_x[SPHERES + WALLS][3], last_F[SPHERES + WALLS][3]; /* the step before: places, forces */
static double *F, *F_wall;
static contacts now, old;
static nlc_options options;
static nlc_network *network;
static void *memory, *other_memory, *cache, *working;
static size_t memory_size, cache_size;

static int64_t number, cycle, lists, compared, bits, weakened, close_by, unconverged, energies, sweeps;
static uint64_t seed, checksum;
static double depth, reach, listed_reach, energy, work, most_energy, worst_work, worst_force;
static int started, stable; /* there is a step before, in this cycle; all of the cycle so far has an energy */

static void fail(const char *what, double a, double b)
{
    fprintf(stderr, "soak: step %lld of seed %llu, model %d, points %d, tolerance %g, load %g: %s: %.17g, %.17g\n",
            (long long)number, (unsigned long long)seed, (int)options.model, (int)options.points, options.tolerance, depth,
            what, a, b);
    exit(1);
}

/* ----------------------------------------------------------------------------------------- memory that nobody may leave -- */

static struct guarded {
    unsigned char *block;
    size_t room, used;
} guarded[GUARDED];
static int guarded_count;

/* From here on only the first so many bytes may be written to. */
static void use(void *p, size_t used)
{
    for (int k = 0; k < guarded_count; k++) {
        struct guarded *g = &guarded[k];
        if (g->block + GUARD != p) continue;
        if (used > g->room) fail("room", (double)used, (double)g->room);
        g->used = used;
        memset(g->block, 0xa5, GUARD);
        memset(g->block + GUARD + used, 0xa5, GUARD);
    }
}

static void *room(size_t size)
{
    struct guarded *g = &guarded[guarded_count++];
    *g = (struct guarded){malloc(size + 2 * GUARD), size, 0};
    if (!g->block) fail("no memory", (double)size, 0);
    memset(g->block, 0, size + 2 * GUARD); /* all of it is there from the start, as the process' size should be */
    use(g->block + GUARD, size);
    return g->block + GUARD;
}

static void check_guards(void)
{
    for (int k = 0; k < guarded_count; k++)
        for (int b = 0; b < GUARD; b++)
            if (guarded[k].block[b] != 0xa5 || guarded[k].block[GUARD + guarded[k].used + (size_t)b] != 0xa5)
                fail("a byte before or behind an array", k, b);
}

/* After each call: its status, and what it may not touch. */
static nlc_status check(nlc_status status, nlc_status allowed, const char *function)
{
    if (status < 0 || status & ~allowed) fail(function, status, allowed);
    if (fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW)) fail("an exception", status, 0);
    if (errno) fail("errno", errno, 0);
    return status;
}

/* --------------------------------------------------------------------------------------------------------------- scene -- */

static nlc_particles particles(void)
{
    return (nlc_particles){.struct_size = sizeof(nlc_particles),
                           .count = SPHERES,
                           .radius = radius,
                           .material = material,
                           .materials = materials,
                           .material_count = MATERIALS,
                           .wall_material = wall_material,
                           .wall_count = WALLS};
}

static nlc_positions positions(void)
{
    return (nlc_positions){.struct_size = sizeof(nlc_positions),
                           .x = x[0],
                           .y = x[0] + 1,
                           .z = x[0] + 2,
                           .stride = sizeof x[0],
                           .wall_point = x[SPHERES],
                           .wall_normal = wall_normal[0]};
}

static void make_room(contacts *w)
{
    double **const array[] = {&w->overlap, &w->normal, &w->force, &w->nonlocal, &w->previous, &w->start};
    for (int k = 0; k < 6; k++) *array[k] = room((k == 1 ? 3u : 1u) * CONTACTS * sizeof(double));
    w->i = room(CONTACTS * sizeof *w->i);
    w->j = room(CONTACTS * sizeof *w->j);
    w->key = room(CONTACTS * sizeof *w->key);
}

/* A face-centred crystal around 0 whose neighbours just touch; every sphere's list are all that come later. */
static void make_scene(void)
{
    static const double site[4][3] = {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
    const double edge = 2 * sqrt(2);
    int k = 0;
    for (int cell = 0; cell < CELLS * CELLS * CELLS; cell++)
        for (int s = 0; s < 4; s++, k++) {
            const int at[3] = {cell % CELLS, cell / CELLS % CELLS, cell / CELLS / CELLS};
            radius[k] = 1 + uniform(-0.02, 0.02);
            material[k] = (int32_t)below(2);
            for (int a = 0; a < 3; a++) {
                place[k][a] = edge * (at[a] + site[s][a] - 0.5 * (CELLS - 0.5));
                rate[k][a] = uniform(2, 12) / CYCLE;
                phase[k][a] = uniform(0, 6);
            }
            later[k] = k;
            length[k] = SPHERES - 1 - k;
            neighbour[k] = later + k + 1;
        }
    for (int w = 0; w < WALLS; w++) {
        const double side = w % 2 ? 1 : -1;
        wall_place[w][w / 2] = side * (0.5 * edge * (CELLS - 0.5) + 1);
        wall_normal[w][w / 2] = -side;
        wall_material[w] = w % 3;
    }
}

static void move(void)
{
    const double turn = 2 * 3.14159265358979 * (double)(number % CYCLE) / CYCLE;
    const double strain = (depth + APART) * 0.5 * (1 - cos(turn)) - APART;
    for (int k = 0; k < SPHERES; k++)
        for (int a = 0; a < 3; a++)
            x[k][a] = (1 - strain) * place[k][a] + VIBRATION * sin(rate[k][a] * (double)number + phase[k][a]);
    for (int w = 0; w < WALLS; w++)
        for (int a = 0; a < 3; a++) x[SPHERES + w][a] = (1 - strain) * wall_place[w][a];
    feclearexcept(FE_ALL_EXCEPT);
    errno = 0;
}

/* ---------------------------------------------------------------------------------------------------------------- lists -- */

/* Whether two that are not listed could have come as near as displacements may close. */
static int is_stale(void)
{
    double most = 0;
    for (int k = 0; k < SPHERES + WALLS; k++)
        for (int a = 0; a < 3; a++) most = fmax(most, fabs(x[k][a] - listed[k][a]));
    return !(reach + 2 * sqrt(3) * most <= listed_reach + SLACK);
}

static nlc_network *build(void *at)
{
    const nlc_particles p = particles();
    nlc_options plain = options;
    nlc_network *n = NULL;
    plain.cache = NULL, plain.cache_size = 0; /* how large it has to be is known of a network */
    check(nlc_network_init(&n, at, memory_size, &p, now.i, now.j, now.count, &plain, NULL), 0, "nlc_network_init");
    return n;
}

static void set_options(nlc_network *n)
{
    const size_t size = nlc_cache_size(n);
    nlc_options o = options;
    if (!o.cache)
        use(cache, 0);
    else
        use(cache, o.cache_size = size < cache_size ? size : cache_size);
    check(nlc_set_options(n, &o, NULL), 0, "nlc_set_options");
}

static void carry(double *to, const double *from)
{
    const size_t size = nlc_carry_size(now.count, old.count);
    use(working, size);
    check(nlc_carry(to, now.key, now.count, from, old.key, old.count, working, size, NULL), 0, "nlc_carry");
}

static void list(void)
{
    const nlc_particles p = particles();
    const nlc_positions at = positions();
    const nlc_lists all = {
        .struct_size = sizeof all, .count = SPHERES, .particle_count = SPHERES, .length = length, .neighbour = neighbour};
    const contacts kept = old;
    old = now, now = kept;
    use(now.i, CONTACTS * sizeof *now.i), use(now.j, CONTACTS * sizeof *now.j);
    check(nlc_contacts_from_lists(&now.count, now.i, now.j, CONTACTS, &p, &at, &all, reach + SLACK, NULL), 0,
          "nlc_contacts_from_lists");
    const size_t n = (size_t)now.count;
    double *const array[] = {now.overlap, now.normal, now.force, now.nonlocal, now.previous, now.start};
    for (int k = 0; k < 6; k++) use(array[k], (k == 1 ? 3u : 1u) * n * sizeof(double));
    use(now.i, n * sizeof *now.i), use(now.j, n * sizeof *now.j), use(now.key, n * sizeof *now.key);
    for (int64_t c = 0; c < now.count; c++) now.key[c] = (uint64_t)now.i[c] << 32 | (uint64_t)now.j[c];
    carry(now.nonlocal, old.nonlocal);
    carry(now.previous, old.previous);
    memory_size = nlc_network_size(&p, now.count, &options);
    use(memory, memory_size);
    network = build(memory);
    set_options(network);
    memcpy(listed, x, sizeof x);
    listed_reach = reach;
    lists++;
}

/* --------------------------------------------------------------------------------------------------------------- solves -- */

static int has_energy(void)
{
    nlc_model_record record = {.struct_size = sizeof record};
    check(nlc_model_info(options.model, &record, NULL), 0, "nlc_model_info");
    return record.potential && !(options.model == NLC_MODEL_HALF_SPACE && options.points == NLC_POINTS_DEFORMED);
}

static nlc_status solve(nlc_network *n, double *force, double *nonlocal)
{
    const nlc_status warnings = NLC_WARNING_CLOSE | NLC_WARNING_WEAKENED | NLC_WARNING_NOT_CONVERGED;
    nlc_info info = {.struct_size = sizeof info};
    const nlc_status status = check(nlc_solve(n, force, nonlocal, now.overlap, now.normal, &info), warnings, "nlc_solve");
    int64_t active = 0;
    for (int64_t c = 0; c < now.count; c++) {
        if (!(force[c] >= 0 && force[c] <= 1e300) || !(fabs(nonlocal[c]) <= 1e300)) fail("a force", force[c], nonlocal[c]);
        active += force[c] > 0;
    }
    if (info.active != active) fail("info.active", (double)active, (double)info.active);
    if (((status & NLC_WARNING_WEAKENED) != 0) != (info.coupling < 1)) fail("a coupling", info.coupling, status);
    if (!(info.residual <= options.tolerance) && !(status & NLC_WARNING_NOT_CONVERGED))
        fail("a residual", info.residual, status);
    sweeps += info.sweeps;
    return status;
}

static double energy_of(nlc_network *n, const double *force)
{
    double e = NAN;
    check(nlc_energy(n, &e, force, now.overlap, now.normal, NULL), 0, "nlc_energy");
    return e;
}

/* A network without a past, from the same start and from zeros. */
static void compare(nlc_status status)
{
    static double force[CONTACTS], nonlocal[CONTACTS], largest[SPHERES + WALLS];
    const size_t size = (size_t)now.count * sizeof(double);
    use(other_memory, memory_size);
    nlc_network *const n = build(other_memory);
    set_options(n);
    memcpy(nonlocal, now.start, size);
    const nlc_status again = solve(n, force, nonlocal);
    if (again != status || memcmp(force, now.force, size) != 0 || memcmp(nonlocal, now.nonlocal, size) != 0)
        fail("a network without a past finds other bits", status, again);
    bits++;
    memset(nonlocal, 0, size);
    const nlc_status cold = solve(n, force, nonlocal);
    if (cold | status) return; /* only a state without a warning has one solution */
    memset(largest, 0, sizeof largest);
    for (int64_t c = 0; c < now.count; c++) {
        largest[now.i[c]] = fmax(largest[now.i[c]], force[c]);
        largest[now.j[c]] = fmax(largest[now.j[c]], force[c]);
    }
    for (int64_t c = 0; c < now.count; c++) {
        const double most = fmax(largest[now.i[c]], now.j[c] < SPHERES ? largest[now.j[c]] : 0);
        const double off = fabs(now.force[c] - force[c]) / (options.tolerance * most);
        if (now.force[c] == force[c]) continue;
        if (!(off <= 2.0001)) fail("forces of a host that goes on and of one that begins", now.force[c], force[c]);
        worst_force = fmax(worst_force, off);
    }
    compared++;
    if (!has_energy()) return;
    const double a = energy_of(network, now.force), b = energy_of(n, force);
    if (!(fabs(a - b) <= (1e-12 + 100 * options.tolerance * options.tolerance) * most_energy)) fail("an energy", a, b);
    energies++;
}

/* --------------------------------------------------------------------------------------------------------------- steps -- */

/* What the forces have done to spheres and walls since the step before, by the mean of both steps' forces. */
static void add_work(void)
{
    double sum[3] = {0, 0, 0}, largest = 0;
    for (int k = 0; k < SPHERES + WALLS; k++)
        for (int a = 0; a < 3; a++) {
            const double f = k < SPHERES ? F[3 * k + a] : F_wall[3 * (k - SPHERES) + a];
            if (started) work += 0.5 * (f + last_F[k][a]) * (x[k][a] - last_x[k][a]);
            last_x[k][a] = x[k][a], last_F[k][a] = f;
            sum[a] += f, largest = fmax(largest, fabs(f));
        }
    for (int a = 0; a < 3; a++)
        if (!(fabs(sum[a]) <= 1e-13 * SPHERES * largest)) fail("the sum of all forces", sum[a], largest);
}

static void assemble(nlc_status status)
{
    memset(F, 0, 3 * SPHERES * sizeof *F), memset(F_wall, 0, 3 * WALLS * sizeof *F_wall);
    check(nlc_assemble(network, F, 0, F_wall, now.force, now.normal, NULL), 0, "nlc_assemble");
    stable = stable && status == NLC_OK && has_energy();
    if (stable) check(nlc_assemble_turning(network, F, 0, now.force, now.overlap, now.normal, NULL), 0, "nlc_assemble_turning");
    add_work();
    if (!stable) return;
    const double e = energy_of(network, now.force);
    most_energy = fmax(most_energy, e);
    if (!started) energy = e;
    if ((number + 1) % CYCLE) return;
    const double off = fabs(e - energy + work) / most_energy;
    worst_work = fmax(worst_work, off);
    if (!(off <= 1e-5)) fail("the work of a cycle", e - energy, work);
}

static void begin_cycle(void)
{
    const nlc_particles p = particles();
    static const double light[] = {0.01, 0.03, 0.06}, hard[] = {0.132, 0.14}; /* of [GC] Case I the branch ends at 0.13 */
    const int32_t kinds = nlc_model_count() + 1; /* one more for the other points of the half-space */
    const int32_t kind = (int32_t)(cycle % kinds);
    depth = cycle++ % 16 ? light[below(3)] : hard[below(2)]; /* each of those costs more than all others together */
    options = (nlc_options){.struct_size = sizeof options,
                            .model = kind < nlc_model_count() ? kind : NLC_MODEL_HALF_SPACE,
                            .points = kind < nlc_model_count() ? NLC_POINTS_DEFORMED : NLC_POINTS_UNDEFORMED,
                            .prefactor = uniform(0.3, 1),
                            .tolerance = pow(10, (double)(-4 - 2 * below(4))),
                            .simd = (int32_t)below(5),
                            .cache = below(2) ? cache : NULL};
    if (depth < 0.02 && below(4) == 0) options.method = NLC_METHOD_FIXED_POINT;
    feclearexcept(FE_ALL_EXCEPT);
    errno = 0;
    if (network && nlc_network_size(&p, now.count, &options) > memory_size) { /* it has to be built anew */
        const nlc_status status = nlc_set_options(network, &options, NULL);
        if (status != NLC_ERROR_MEMORY_SIZE) fail("nlc_set_options in too little memory", status, 0);
        network = NULL;
    }
    if (network) set_options(network);
    started = 0, stable = 1;
    most_energy = work = 0;
}

static void make_step(void)
{
    const nlc_particles p = particles();
    if (number % CYCLE == 0) begin_cycle();
    move();
    if (!network || is_stale()) list();
    const nlc_positions at = positions();
    check(nlc_contacts_from_pairs(now.overlap, now.normal, &p, &at, now.i, now.j, now.count, NULL), 0,
          "nlc_contacts_from_pairs");
    if (started)
        check(nlc_predict(now.nonlocal, now.previous, now.count, 1, NULL), 0, "nlc_predict");
    else
        memcpy(now.previous, now.nonlocal, (size_t)now.count * sizeof(double));
    memcpy(now.start, now.nonlocal, (size_t)now.count * sizeof(double));
    const nlc_status status = solve(network, now.force, now.nonlocal);
    weakened += (status & NLC_WARNING_WEAKENED) != 0;
    close_by += (status & NLC_WARNING_CLOSE) != 0;
    unconverged += (status & NLC_WARNING_NOT_CONVERGED) != 0;
    if (status && (number + 1) % CYCLE == 0) fail("a warning that stays", status, 0);
    assemble(status);
    check(nlc_reach(network, &reach, NULL, now.force, NULL), 0, "nlc_reach");
    reach = fmin(reach, MOST_REACH);
    if (number % COMPARED == 0) compare(status);
    for (int64_t c = 0; c < now.count; c++) {
        uint64_t word;
        memcpy(&word, &now.force[c], sizeof word);
        checksum = (checksum ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    }
    check_guards();
    started = 1;
}

static double megabytes(void)
{
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return (double)u.ru_maxrss / 1024;
}

int main(int argc, char **argv)
{
    const int64_t count = argc > 1 ? (int64_t)strtod(argv[1], NULL) : 4000;
    const int64_t settled = (nlc_model_count() + 1) * CYCLE; /* by then everything has been used once */
    double before = 0;
    state = seed = argc > 2 ? strtoull(argv[2], NULL, 0) : 1;
    make_scene();
    const nlc_particles p = particles();
    memory_size = nlc_network_size(&p, CONTACTS, NULL);
    memory = room(memory_size), other_memory = room(memory_size);
    cache = room(cache_size = CONTACTS * 400);
    working = room(nlc_carry_size(CONTACTS, CONTACTS));
    F = room(3 * SPHERES * sizeof *F), F_wall = room(3 * WALLS * sizeof *F_wall);
    make_room(&now), make_room(&old);
    for (number = 0; number < count; number++) {
        make_step();
        if (number == (count > 10 * settled ? count / 10 : settled)) before = megabytes();
    }
    /* seen: 1 state in 20 not compared, 1 step in 60 weakened, none not converged */
    if (count >= 4000 && (compared * 3 < bits * 2 || energies == 0 || weakened * 10 > count || unconverged * 1000 > count))
        fail("little compared", (double)compared, (double)(weakened + unconverged));
    const double grown = count > settled ? megabytes() - before : 0;
    printf("soak: %lld steps, %lld sweeps, %lld lists: %lld times the same bits, %lld comparisons, off by %.2f tolerances at "
           "most, "
           "%lld energies, work off by %.1e; %lld weakened, %lld close, %lld not converged; grown by %.1f MB; %016llx\n",
           (long long)count, (long long)sweeps, (long long)lists, (long long)bits, (long long)compared, worst_force,
           (long long)energies, worst_work, (long long)weakened, (long long)close_by, (long long)unconverged, grown,
           (unsigned long long)checksum);
    if (grown > 1) fail("the process has grown", grown, 0);
    return 0;
}
