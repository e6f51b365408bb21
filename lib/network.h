/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * network.h - the network in the caller's memory.
 *
 * Bodies are the particles 0 ... particle_count-1 and then the walls.  Each contact has two sides, side 0 on i and side 1 on
 * j; side number e = 2 contact + side.  The adjacency is compressed by particle: entry[start[k]] ... entry[start[k+1]-1] are
 * the sides that lie on particle k, ascending.  Sides on walls are in no particle's list.
 */
#ifndef NLC_NETWORK_H
#define NLC_NETWORK_H

#include "check.h"
#include "model.h"
#include "nlcontact.h"
#include "number.h"
#include "small.h"
#include "variant.h"

#define NLC_NETWORK_MAGIC UINT64_C(0x4e4c434f4e544331) /* NLCONTC1 */

/* Options, checked and with the defaults filled in. */
typedef struct nlc_settings {
    const nlc_model *model;
    const nlc_variant *variant; /* NULL: the portable code */
    int32_t number, method; /* number: of the model */
    double tolerance, prefactor;
    int64_t max_sweeps;
    double *cache; /* the caller's, for coefficients; NULL: none */
    size_t cache_size;
    nlc_parallel_callback parallel_for; /* NULL: none */
    void *parallel_context;
    int64_t owned_particles;
    nlc_exchange_callback exchange; /* NULL: not shared */
    nlc_reduce_callback reduce;
    void *context;
} nlc_settings;

/* What is found of one slab or window of a loop, see parallel.h. */
typedef struct nlc_piece {
    nlc_small sum;
    double residual, force;
    int64_t bad;   /* particle or contact */
    int64_t count; /* contacts */
    bool flag[2];
} nlc_piece;

/* What a network that is shared out among ranks has to know of them, see collective.h. */
typedef struct nlc_ranks {
    int turn;          /* the callback that comes next */
    bool over;         /* all ranks know of an error */
    nlc_status status; /* of this rank */
    int64_t culprit;
    double most;       /* magnitude that a ghost may bring */
} nlc_ranks;

/* Largest magnitudes of what is being solved for, on any rank; negative: not known.  circle: nlc_larger_circle, of this rank. */
typedef struct nlc_tops {
    double overlap, stiffness, nonlocal, circle;
} nlc_tops;

struct nlc_network {
    uint64_t magic;
    int64_t particle_count, body_count, contact_count, material_count;
    int64_t owned;      /* particles that are computed here; ghosts follow */
    int64_t straddling; /* contacts with a ghost */
    size_t memory_size; /* that it was given */
    int arrays;         /* those that it has, see layout.h; the pointers to others are NULL */
    nlc_settings settings;
    nlc_ranks ranks;
    nlc_tops top;
    bool self_contacts;     /* some contact has i = j */
    int64_t most_contacts;  /* of a particle */
    double least_ratio;     /* of the radii of two particles */
    bool connected;         /* all contacts are one cluster, see clusters.c */
    int scale_exponent;     /* no U reaches 2^ this */
    int coupling_exponent;  /* nor does any particle's kernel constant 2^ this */
    int stiffness_exponent; /* nor any stiffness */
    /* Set by nlc_network_init */
    int32_t *i, *j;          /* [contacts] */
    int64_t *start;          /* [particles+1] */
    int64_t *entry;          /* [2 contacts] */
    double *radius;          /* [particles] */
    int32_t *material;       /* [bodies] */
    nlc_material *materials; /* [materials] */
    double *scale;           /* [particles] U = (1+nu)/(4 pi R E), 0 if rigid */
    /* Set by nlc_set_options too */
    double *stiffness;  /* [contacts] */
    nlc_kernel *kernel; /* [materials] */
    /* Units of what is being computed, see nlc_set_units */
    int length_unit, stiffness_unit;
    double unit; /* coefficients are multiplied by it */
    bool cached; /* the cache holds the coefficients at the normals of this call */
    double known_bound; /* of lambda, if swept, until an overlap exceeds nlc_weighed_overlap of what it is at the start; 1: none is known */
    int64_t known_where; /* its particle; -1: on another rank */
    bool swept; /* side holds the displacements by the forces of current: the next iteration need not begin with a sweep */
    bool answered; /* side holds the result, in the units at hand; else current does, in the caller's */
    /* Work space; sides on walls stay 0 in side, walls in largest */
    double *side;     /* [2 contacts] displacement of each side */
    double *force;    /* [contacts] */
    double *current;  /* [contacts] nonlocal displacement */
    nlc_piece *piece; /* [slabs or windows] */
    int64_t *kept_at; /* [windows] where their coefficients begin in the cache */
    double *largest;  /* [bodies] */
    double *spare[5]; /* [contacts] */
    double *lanczos[4]; /* [contacts] for blocks that do not fit on the stack */
    double *direction[NLC_DIRECTIONS], *image[NLC_DIRECTIONS]; /* [contacts] directions kept, and C times them */
    double *approach; /* [contacts] see contact.h */
    double *own;      /* [2 contacts] change of a side's displacement by the contact's own force; NLC_SHAPE_PLACE: the place */
    double *floor;    /* [contacts] smallest slope that a step may assume */
    double *slope;    /* [contacts] D = dP/dx in the same units */
    double *share;    /* [2 contacts] of the bound, see bound.h */
    double *bound, *norm, *growth, *weakening; /* [particles] */
    double *closest; /* [particles] squared distance of the two closest directions in the last sweep; 0: not known */
    unsigned char *changed;                    /* [particles] */
    /* The part that is solved for, see active.h; it has no part of its own, and shares the work space of solvers */
    nlc_network *part;
    unsigned char *mark;  /* [contacts] */
    int32_t *degree;      /* [particles] marked contacts */
    int32_t *cluster;     /* [particles] another one of the same cluster, itself if it is the first */
    int64_t *origin;      /* [marked contacts] cluster by cluster */
    int32_t *place;       /* [bodies] number in the part, if body[place] is the particle; of walls, if it is from the end */
    int32_t *body;        /* [bodies] numbers of the part's particles; from the end backwards, of its walls */
    double *part_overlap; /* [contacts of the part] */
    double *part_normal;  /* [contacts of the part][3] */
    /* For trees over the directions on a particle with very many contacts, see tree.h */
    int32_t *order; /* [contacts, at most room_size] */
    double *room;   /* [room_size] */
    int64_t room_size;
    int64_t evaluations; /* of the kernel on such particles, ever: for tests */
};

/* Whether this is a network made by nlc_network_init. */
bool nlc_network_is_valid(const nlc_network *network);

/* Outward direction of a side: the contact normal, reversed on j's side. */
static inline double nlc_outward(int64_t entry)
{
    return entry & 1 ? -1.0 : 1.0;
}

/* By how much a body's surface yields, its U; 0: it is rigid, or a wall. */
static inline double nlc_yield_of(const nlc_network *n, int64_t body)
{
    return body < n->particle_count ? n->scale[body] : 0;
}

/* The outward direction of a side as number d of a block. */
static inline void nlc_set_direction(nlc_block *b, int d, const double *normal, int64_t e)
{
    const double out = nlc_outward(e), *v = normal + 3 * (e >> 1);
    b->x[d] = out * v[0];
    b->y[d] = out * v[1];
    b->z[d] = out * v[2];
}

/*
 * The side at a place of the adjacency.  The two sides of a contact of a particle with itself stand one behind the other;
 * their order is made to depend on the normal alone, so that exchanging i and j with the normal reversed changes no bit.
 */
static inline int64_t nlc_side_at(const nlc_network *n, const double *normal, int64_t place)
{
    int64_t e = n->entry[place];
    if (!n->self_contacts || n->i[e >> 1] != n->j[e >> 1]) return e;
    const double *v = normal + 3 * (e >> 1);
    double first = v[0] != 0 ? v[0] : v[1] != 0 ? v[1] : v[2];
    return first < 0 ? e ^ 1 : e;
}

/* settings.c */
const nlc_model *nlc_model_of(const nlc_options *options); /* whose model is one */
nlc_status nlc_read_settings(nlc_settings *settings, const nlc_options *options, int64_t *culprit);
bool nlc_prefactor_in_range(const nlc_network *network, const nlc_settings *settings);
void nlc_apply_settings(nlc_network *network, const nlc_settings *settings, const double *stiffness);

/* What a sweep is asked for: in a model whose displacements are proportional to the forces all the same. */
typedef enum nlc_response {
    NLC_OF_FORCES,  /* displacements */
    NLC_OF_STATE,   /* displacements; sets what NLC_OF_CHANGES needs to know of the state, for which network->floor has to be set */
    NLC_OF_CHANGES, /* change of the displacements by small changes of the forces, at the forces of the last NLC_OF_STATE */
    NLC_OF_ENERGY   /* minus half the product with the forces is the energy that the coupling adds */
} nlc_response;

/* From now on overlaps count 2^length times, stiffnesses 2^stiffness times; length is even. */
static inline void nlc_set_units(nlc_network *n, int length, int stiffness)
{
    n->length_unit = length;
    n->stiffness_unit = stiffness;
    n->unit = nlc_join(1, -length / 2 - stiffness);
}

/*
 * displace.c: displacement of every side under the given forces into network->side, and the largest |force| on every
 * body into network->largest.  NLC_ERROR_COINCIDENT (culprit: a contact) or NLC_ERROR_RANGE; then both are undefined.
 */
nlc_status nlc_displace(nlc_network *network, nlc_response response, const double *force, const double *normal, int64_t *culprit);

/*
 * nlc_displace of network->force, top the largest; their weights are beside them in network->share, and a variant looks at them, see
 * there.
 */
nlc_status nlc_displace_weighed(nlc_network *network, double top, const double *normal, int64_t *culprit);

/* The variant of the sweep's inner loop; NULL: the portable code. */
const nlc_variant *nlc_variant_of(const nlc_network *network);

/* Numbers that the cache is to hold. */
int64_t nlc_count_kept(const nlc_network *network);

/* nlc_displace for the sides of one particle.  False: two directions are the same. */
bool nlc_displace_particle(nlc_network *network, nlc_response response, const double *force, const double *normal,
                           int64_t particle);

/* kept: room for the particle's coefficients, or NULL; known: they are there. */
bool nlc_displace_kept(nlc_network *network, nlc_response response, const double *force, const double *normal, int64_t particle,
                       double *kept, bool known);

/* The later one of two contacts of a particle that lie in the same direction; -1: none do. */
int64_t nlc_find_coincident(const nlc_network *network, const double *normal, int64_t particle);

/* network.c: start and entry from i and j. */
void nlc_build_adjacency(nlc_network *network);

/* A particle's kernel, and its U in units of network->unit. */
static inline const nlc_kernel *nlc_kernel_of(const nlc_network *n, int64_t particle)
{
    return &n->kernel[n->material[particle]];
}

static inline double nlc_scale_of(const nlc_network *n, int64_t particle)
{
    return n->scale[particle] * n->unit;
}

/* The model's displacements between two blocks, by the variant that there is. */
static inline bool nlc_between(const nlc_network *n, nlc_block *a, nlc_block *b, const nlc_kernel *kernel)
{
    const nlc_model *model = n->settings.model;
    return model->between == nlc_case_one_between && n->settings.variant ? n->settings.variant->between(a, b, kernel)
                                                                         : model->between(a, b, kernel);
}

/* What an iteration leaves behind: the nonlocal displacement is in network->current. */
typedef struct nlc_outcome {
    nlc_status status;
    nlc_info info;
} nlc_outcome;

/* solve.c: forgets all but the work done. */
void nlc_start_over(nlc_outcome *outcome);

/* fixed_point.c: [GC] Algorithm 1 from network->current. */
void nlc_fixed_point(nlc_network *network, const double *overlap, const double *normal, nlc_outcome *outcome);

/* mixed.c: the default of models without an energy. */
void nlc_mixed(nlc_network *network, const double *overlap, const double *normal, nlc_outcome *outcome);

/* galerkin.c: the default of models with one. */
void nlc_galerkin(nlc_network *network, const double *overlap, const double *normal, nlc_outcome *outcome);

/* loose.c: whether all forces are those of Hertz to the tolerance.  If so, sets residual, worst_contact and bounds of lambda. */
bool nlc_is_loose(nlc_network *network, const double *overlap, const double *normal, nlc_outcome *outcome);

/*
 * warm.c: whether the displacements given solve the equations to the tolerance, after one sweep; if so they, anew, are in
 * network->side, or there is an error.  If not, and network->swept, the sweep need not be done again.
 */
bool nlc_is_solved(nlc_network *network, const double *overlap, const double *normal, const double *nonlocal, nlc_outcome *outcome);

/*
 * The force law.  No intermediate result exceeds the larger of stiffness and force.
 * The positive part is an expression, not a choice: of a choice gcc makes a vector that takes the root of both sides, and the
 * root of a negative number raises invalid.
 */
static inline double nlc_law(double stiffness, double overlap)
{
    double x = 0.5 * (overlap + fabs(overlap));
    return stiffness * sqrt(x) * x;
}

#endif
