#ifndef NLCONTACT_H
#define NLCONTACT_H

#include <stddef.h>
#include <stdint.h>

#define NLC_VERSION_MAJOR 0
#define NLC_VERSION_MINOR 1
#define NLC_VERSION_PATCH 0

#if defined(__cplusplus)
#  if defined(__GNUC__) || defined(_MSC_VER)
#    define NLC_RESTRICT __restrict
#  else
#    define NLC_RESTRICT
#  endif
#else
#  define NLC_RESTRICT restrict
#endif

#if defined(__GNUC__)
#  define NLC_API __attribute__((visibility("default")))
#else
#  define NLC_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define NLC_STATUS_LIST(X)                                                                                                  \
    X(NLC_OK,                     0, "success",                                                          "-1")              \
    X(NLC_ERROR_NULL,            -1, "a required argument is NULL",                                      "argument, from 0")\
    X(NLC_ERROR_NULL_FIELD,      -2, "a required pointer in a struct is NULL",                            "field's offset")  \
    X(NLC_ERROR_STRUCT_SIZE,     -3, "struct_size is not that of any version's struct",                  "argument, from 0")\
    X(NLC_ERROR_RESERVED,        -4, "bytes beyond the fields that this version knows are not zero",     "argument, from 0")\
    X(NLC_ERROR_COUNT,           -5, "a count is negative or too large",                                 "argument, from 0")\
    X(NLC_ERROR_STRIDE,          -6, "a stride is shorter than an element or overflows",                 "offset, argument")\
    X(NLC_ERROR_MEMORY_SIZE,     -7, "the memory given is smaller than nlc_network_size says",           "bytes needed")    \
    X(NLC_ERROR_ALIGNMENT,       -8, "the memory given is not aligned to 8 bytes",                       "address modulo 8")\
    X(NLC_ERROR_NETWORK,         -9, "not a network made by nlc_network_init",                           "-1")              \
    X(NLC_ERROR_MODEL,          -10, "no such model",                                                    "the number given")\
    X(NLC_ERROR_NO_POTENTIAL,   -11, "the model has no energy",                                          "the model")       \
    X(NLC_ERROR_METHOD,         -12, "no such method",                                                   "the number given")\
    X(NLC_ERROR_OPTION,         -13, "an option is NaN, infinite, negative or unknown",                  "offset, argument")  \
    X(NLC_ERROR_RADIUS,         -14, "a radius is not positive and finite",                              "particle")        \
    X(NLC_ERROR_MATERIAL,       -15, "a material index is out of range",                                 "particle or wall")\
    X(NLC_ERROR_YOUNG,          -16, "a Young's modulus is not positive",                                "material")        \
    X(NLC_ERROR_POISSON,        -17, "a Poisson's ratio is outside [0, 0.5]",                            "material")        \
    X(NLC_ERROR_INDEX,          -18, "a particle or wall index is out of range",                         "contact")         \
    X(NLC_ERROR_WALL_WALL,      -19, "a contact joins two walls",                                        "contact")         \
    X(NLC_ERROR_RIGID_RIGID,    -20, "a contact joins two rigid bodies",                                 "contact")         \
    X(NLC_ERROR_STIFFNESS,      -21, "a contact stiffness is not positive and finite",                   "contact")         \
    X(NLC_ERROR_OVERLAP,        -22, "an overlap is not finite",                                         "contact")         \
    X(NLC_ERROR_NORMAL,         -23, "a contact normal is not finite or not of unit length",             "contact")         \
    X(NLC_ERROR_NONLOCAL,       -24, "a nonlocal displacement is not finite",                            "contact")         \
    X(NLC_ERROR_FORCE,          -25, "a contact force is not finite",                                    "contact")         \
    X(NLC_ERROR_TOTAL_FORCE,    -26, "a force or torque to be added to is not finite",                   "particle or wall")\
    X(NLC_ERROR_COINCIDENT,     -27, "two contacts of one particle lie in the same direction",           "contact")         \
    X(NLC_ERROR_RANGE,          -28, "a result is or might be beyond the range of double",               "contact or -1")   \
    X(NLC_ERROR_UNSTABLE,       -29, "the state is beyond the end of the stable branch",                 "-1")              \
    X(NLC_ERROR_SLIDING,        -30, "a direction of sliding is not a unit vector along the surfaces",   "contact")         \
    X(NLC_ERROR_POSITION,       -31, "a position is not finite",                                         "particle or wall")\
    X(NLC_ERROR_SAME_PLACE,     -32, "two centres are in the same place",                                "contact")         \
    X(NLC_ERROR_CELL,           -33, "a periodic cell is no cell, or narrower than two diameters",       "contact or -1")   \
    X(NLC_ERROR_CAPACITY,       -34, "the room given is too small for the result",                       "room needed")     \
    X(NLC_ERROR_GHOST,          -35, "a contact has no particle that is owned here",                     "contact")         \
    X(NLC_ERROR_REMOTE,         -36, "another rank has failed",                                          "-1")              \
    X(NLC_ERROR_CALLBACK,       -37, "a callback has failed",                                            "what it returned")\
    X(NLC_WARNING_CLOSE,          1, "circles of contact overlap: the model does not hold there",        "-1")              \
    X(NLC_WARNING_ROUNDING,       2, "rounding keeps the forces from reaching the tolerance",            "-1")              \
    X(NLC_WARNING_WEAKENED,       4, "beyond the stable branch: the coupling was weakened",              "-1")              \
    X(NLC_WARNING_NOT_CONVERGED,  8, "not converged: forces are finite but miss the tolerance",          "-1")

typedef int32_t nlc_status;

enum {
#define NLC_STATUS_ENUM(name, value, text, culprit) name = value,
    NLC_STATUS_LIST(NLC_STATUS_ENUM)
#undef NLC_STATUS_ENUM
    NLC_STATUS_MAX = 0x7fffffff
};

NLC_API const char *nlc_strerror(nlc_status status);

NLC_API const char *nlc_version(void);

NLC_API double nlc_hertz_stiffness(double E1, double nu1, double R1, double E2, double nu2, double R2);

NLC_API double nlc_hertz_force(double stiffness, double overlap);

NLC_API double nlc_hertz_overlap(double stiffness, double force);

NLC_API double nlc_contact_radius(double force, double E1, double nu1, double R1, double E2, double nu2, double R2);

NLC_API double nlc_contact_displacement(double force, double radius, double r, double E, double nu);

NLC_API double nlc_nonlocal_displacement(double force, double theta, double R, double E, double nu);

NLC_API double nlc_nonlocal_displacement_between(double force, const double n_c[3], const double n_d[3], double R, double E,
                                                 double nu);

NLC_API double nlc_half_space_displacement(double force, const double n_k[3], const double n_c[3], const double r_kc[3],
                                           double E, double nu, double prefactor);

NLC_API void nlc_point_displacement(double displacement[2], double force, double theta, double R, double E, double nu);

NLC_API void nlc_point_stress(double stress[4], double force, double theta, double R, double nu);

NLC_API void nlc_point_traction(double traction[2], double force, double theta, double R, double nu);

NLC_API void nlc_love_displacement(double displacement[2], double force, double radius, double r, double z, double E, double nu);

NLC_API void nlc_love_stress(double stress[4], double force, double radius, double r, double z, double nu);

NLC_API double nlc_love_nonlocal_displacement(double force, double radius, double theta, double R, double E, double nu);

NLC_API double nlc_sphere_green(double theta, double nu);

NLC_API double nlc_sphere_finite_size(double theta, double nu, double chi);

NLC_API double nlc_sphere_self(double t, double nu, double chi);

NLC_API double nlc_sphere_self_energy(double t, double nu, double chi);

NLC_API double nlc_sphere_displacement(double force, double theta, double R, double E, double nu);

typedef struct nlc_material {
    double young;
    double poisson;
} nlc_material;

typedef struct nlc_particles {
    size_t struct_size;
    int64_t count;
    const double *radius;
    ptrdiff_t radius_stride;
    const int32_t *material;
    ptrdiff_t material_stride;
    const nlc_material *materials;
    int64_t material_count;
    size_t material_size;
    const int32_t *wall_material;
    int64_t wall_count;
} nlc_particles;

enum {
    NLC_MODEL_GONZALEZ_CUITINO = 0,
    NLC_MODEL_HERTZ = 1,
    NLC_MODEL_HALF_SPACE = 2,
    NLC_MODEL_LOVE = 3,
    NLC_MODEL_SPHERE = 4,
    NLC_MODEL_POINT_FORCE = 5
};

enum {
    NLC_POINTS_DEFORMED = 0,
    NLC_POINTS_UNDEFORMED = 1
};

enum {
    NLC_METHOD_AUTOMATIC = 0,
    NLC_METHOD_FIXED_POINT = 1
};

enum {
    NLC_SIMD_BEST = 0,
    NLC_SIMD_GENERIC = 1,
    NLC_SIMD_AVX2 = 2,
    NLC_SIMD_AVX512 = 3,
    NLC_SIMD_NEON = 4
};

typedef void (*nlc_parallel_callback)(void *context, void (*task)(void *work, int64_t k), void *work, int64_t count);

typedef int (*nlc_exchange_callback)(void *context, double *side);

typedef int (*nlc_reduce_callback)(void *context, double *values, int32_t count, int32_t operation);

enum {
    NLC_REDUCE_SUM = 0,
    NLC_REDUCE_MAX = 1
};

typedef struct nlc_options {
    size_t struct_size;
    int32_t model;
    int32_t method;
    double tolerance;
    int64_t max_sweeps;
    double prefactor;
    int32_t simd;
    int32_t points;
    const double *stiffness;
    void *cache;
    size_t cache_size;
    nlc_parallel_callback parallel_for;
    void *parallel_context;
    int64_t owned_particles;
    nlc_exchange_callback exchange;
    nlc_reduce_callback reduce;
    void *context;
    const void *reserved;
} nlc_options;

typedef struct nlc_info {
    size_t struct_size;
    int64_t culprit;
    int64_t sweeps;
    double residual;
    int64_t worst_contact;
    int64_t active;
    double lambda_lower;
    double lambda_upper;
    int64_t critical_particle;
    double coupling;
    int64_t weakest_particle;
    int64_t weakened;
    int64_t blocks;
    int64_t left_out;
    int64_t clusters;
    int64_t settled;

} nlc_info;

typedef struct nlc_model_record {
    size_t struct_size;
    const char *name;
    const char *reference;
    const char *doi;
    const char *validity;
    int32_t symmetric;
    int32_t potential;
    int32_t self_term;
    int32_t circles;
    double cost;
} nlc_model_record;

NLC_API int32_t nlc_model_count(void);

NLC_API nlc_status nlc_model_info(int32_t model, nlc_model_record *record, nlc_info *info);

NLC_API int32_t nlc_model_find(const char *name);

typedef struct nlc_network nlc_network;

NLC_API size_t nlc_network_size(const nlc_particles *particles, int64_t contact_count, const nlc_options *options);

NLC_API nlc_status nlc_network_init(nlc_network **network, void *memory, size_t memory_size, const nlc_particles *particles,
                                    const int32_t *NLC_RESTRICT i, const int32_t *NLC_RESTRICT j, int64_t contact_count,
                                    const nlc_options *options, nlc_info *info);

NLC_API nlc_status nlc_set_options(nlc_network *network, const nlc_options *options, nlc_info *info);

NLC_API size_t nlc_cache_size(const nlc_network *network);

NLC_API nlc_status nlc_solve(nlc_network *network, double *NLC_RESTRICT force, double *NLC_RESTRICT nonlocal,
                             const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info);

NLC_API nlc_status nlc_predict(double *NLC_RESTRICT nonlocal, double *NLC_RESTRICT previous, int64_t count, double ratio,
                               nlc_info *info);

NLC_API nlc_status nlc_sweep(nlc_network *network, double *NLC_RESTRICT displacement, const double *NLC_RESTRICT force,
                             const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info);

NLC_API nlc_status nlc_energy(nlc_network *network, double *NLC_RESTRICT energy, const double *NLC_RESTRICT force,
                              const double *NLC_RESTRICT overlap, const double *NLC_RESTRICT normal, nlc_info *info);

NLC_API nlc_status nlc_tangent(nlc_network *network, double *NLC_RESTRICT dforce, const double *NLC_RESTRICT doverlap,
                               const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info);

NLC_API nlc_status nlc_tangent_inverse(nlc_network *network, double *NLC_RESTRICT doverlap, const double *NLC_RESTRICT dforce,
                                       const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal, nlc_info *info);

NLC_API nlc_status nlc_tangent_bound(nlc_network *network, double *NLC_RESTRICT stiffness, const double *NLC_RESTRICT force,
                                     const double *NLC_RESTRICT normal, nlc_info *info);

NLC_API nlc_status nlc_assemble(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride,
                                double *NLC_RESTRICT F_wall, const double *NLC_RESTRICT force,
                                const double *NLC_RESTRICT normal, nlc_info *info);

NLC_API nlc_status nlc_assemble_turning(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride,
                                        const double *NLC_RESTRICT force, const double *NLC_RESTRICT overlap,
                                        const double *NLC_RESTRICT normal, nlc_info *info);

NLC_API nlc_status nlc_assemble_sliding(const nlc_network *network, double *NLC_RESTRICT F, ptrdiff_t F_stride,
                                        double *NLC_RESTRICT torque, ptrdiff_t torque_stride, double *NLC_RESTRICT F_wall,
                                        const double *NLC_RESTRICT force, const double *NLC_RESTRICT normal,
                                        const double *NLC_RESTRICT sliding, const double *NLC_RESTRICT displacement,
                                        const double *NLC_RESTRICT overlap, double friction, nlc_info *info);

typedef struct nlc_positions {
    size_t struct_size;
    const double *x, *y, *z;
    ptrdiff_t stride;
    const double *wall_point;
    const double *wall_normal;
    const double *cell;
} nlc_positions;

typedef struct nlc_lists {
    size_t struct_size;
    int64_t count;
    const int32_t *particle;
    int64_t particle_count;
    const int32_t *length;
    int32_t *const *neighbour;
    int32_t mask;
    int32_t reserved;
} nlc_lists;

NLC_API nlc_status nlc_contacts_from_pairs(double *NLC_RESTRICT overlap, double *NLC_RESTRICT normal,
                                           const nlc_particles *particles, const nlc_positions *positions,
                                           const int32_t *NLC_RESTRICT i, const int32_t *NLC_RESTRICT j,
                                           int64_t contact_count, nlc_info *info);

NLC_API nlc_status nlc_contacts_from_lists(int64_t *NLC_RESTRICT count, int32_t *NLC_RESTRICT i, int32_t *NLC_RESTRICT j,
                                           int64_t capacity, const nlc_particles *particles, const nlc_positions *positions,
                                           const nlc_lists *lists, double reach, nlc_info *info);

NLC_API nlc_status nlc_reach(const nlc_network *network, double *NLC_RESTRICT reach, double *NLC_RESTRICT displacement,
                             const double *NLC_RESTRICT force, nlc_info *info);

NLC_API size_t nlc_carry_size(int64_t contact_count, int64_t old_count);

NLC_API nlc_status nlc_carry(double *NLC_RESTRICT nonlocal, const uint64_t *NLC_RESTRICT key, int64_t contact_count,
                             const double *NLC_RESTRICT old_nonlocal, const uint64_t *NLC_RESTRICT old_key, int64_t old_count,
                             void *memory, size_t memory_size, nlc_info *info);

NLC_API nlc_status nlc_order(nlc_network *network, int32_t *NLC_RESTRICT particle, int64_t *NLC_RESTRICT contact, nlc_info *info);

NLC_API nlc_status nlc_network_update(nlc_network *network, const nlc_particles *particles, const double *stiffness,
                                      nlc_info *info);

#ifdef __cplusplus
}
#endif

#endif
