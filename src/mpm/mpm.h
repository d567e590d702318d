/* Rock in motion and at rest by the material point method: moving least squares transfers (MLS-MPM), affine
 * velocities (APIC), quadratic kernel, explicit steps.
 *
 * Cells are 2 h wide, eight particles each. Particles are sorted by base cell, those of one cell by piece and id:
 * these are its parts. One invocation per part sums its particles over their 27 nodes, then each node near them
 * sums the parts of 27 cells: no atomics, the same bits in every run. A sort holds until particles may have moved
 * a seventh of a cell; the kernel's polynomials go on to be exact until then (shaders/mpm/grid.glsl).
 *
 * Joints part the rock into pieces, Voronoi cells of hashed points. A joint breaks as a whole once a share of its
 * particles has; pieces that unbroken joints connect are one body; each body has velocities of its own at the
 * nodes, and where bodies meet they do not enter each other and rub (Bardenhagen, Brackbill and Sulsky, The
 * material-point method for granular materials, 2000). Loose grains are a body together. Without joints all is one.
 *
 * Deformation is kept as H = F - I: steps of F would fall below its last bit (research: an error of 38 % at a
 * CFL number of 0.1). Between frames a particle's state is place, velocity, affine velocity, H, how much is left
 * of it, how far it has come apart, its strength, piece and joint; steps need no more, whatever order they are in.
 *
 * source  Arenite section 4.2; Hu et al., A Moving Least Squares Material Point Method, 2018; Stomakhin et al.,
 *         Energetically Consistent Invertible Elasticity, 2012; Klar et al., Drucker-Prager Elastoplasticity for
 *         Sand Animation, 2016
 * twin    tests/ref/mpm_ref.c
 */
#ifndef HOODOO_MPM_H
#define HOODOO_MPM_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "particles/particles.h"

struct mpm_options {
    double lambda, mu; /* Pa */
    double density;    /* kg/m3 */
    double gravity;    /* m/s2 */
    double cfl;        /* cells that the fastest wave may cross in a step; 0.3 to 0.5 */
    double viscosity;  /* share of a crossing of one cell: damps vibration, not motion; 0 or more */
    double rebound;    /* share of elastic energy that comes back from an impact; 1: all */
    double friction;   /* on ground and resting rock */
    double repose_deg; /* friction angle of broken rock */
    double strength;   /* Pa: tension at which rock breaks */
    double block;      /* m: size of the pieces between joints, two cells or more; 0: no joints */
    double joint;      /* at joints, as a share of strength */
    uint32_t seed;     /* of the joints */
    double lift;       /* cells: 0 for equilibrium, whose ground is held; 0.75 for motion, see params.h */
    double played;     /* what particles get for a metre per second: how fast that is in the film; 0: 1 */
    unsigned walls;    /* of the domain, WALL_* of shared/params.h: smooth, and nothing leaves there */
};

/* Elastic moduli lowered so that waves run at `speed` m/s; their ratio stays. Never raised. */
void mpm_soften(struct mpm_options *o, double speed);

/* The state's vectors and words, in the order of sections in checkpoints. */
enum mpm_vector {
    MPM_PLACE,
    MPM_VELOCITY,
    MPM_AFFINE_X,
    MPM_AFFINE_Y,
    MPM_STRETCH_X,
    MPM_STRETCH_Y,
    MPM_VECTORS
};
enum mpm_word {
    MPM_SHARE,
    MPM_APART,
    MPM_STRENGTH,
    MPM_ID,
    MPM_PIECE,
    MPM_JOINT,
    MPM_ORIGIN, /* not of the state: found by id */
    MPM_WORDS
};
/* place = (x, H22), velocity = (v, C22), affine_x = (C's x column, C02), affine_y = (its y column, C12), stretch
 * likewise of H. */
extern const char *const mpm_vector_names[MPM_VECTORS], *const mpm_word_names[MPM_WORDS];

struct mpm {
    int cells[3]; /* of the domain */
    double dx;    /* m */
    struct mpm_options options;
    size_t n, n_max;
    struct gpu_buffer *vector[MPM_VECTORS]; /* vec4 [n_max] */
    struct gpu_buffer *word[MPM_WORDS];     /* float or uint [n_max] */
    struct gpu_buffer *home;                /* uint [n_max]: base cell */
    struct gpu_buffer *part, *group;        /* uint [n_max] */
    struct gpu_buffer *speed;               /* float [n_max] */
    struct gpu_buffer *spare_vector, *spare_word, *order, *unordered;
    struct gpu_buffer *part_first, *part_cell, *part_body;        /* uint [n_max + 1] */
    struct gpu_buffer *start, *flags, *place, *node_list, *mixed; /* uint [nodes] */
    struct gpu_buffer *slot, *many;                               /* uint [nodes]: a cell's parts */
    struct gpu_buffer *first, *meeting;                           /* uint [nodes]: a node's entries */
    struct gpu_buffer *wall;                                      /* vec4 [nodes] */
    struct gpu_buffer *partial, *reach;                           /* for each part, by node; see room */
    struct gpu_buffer *entry_node, *entry_body, *entry_group, *mass, *velocity, *product;
    struct gpu_buffer *scalars;
    const struct particles *resting; /* an obstacle; borrowed, NULL: none */
    struct gpu_buffer *full; /* uint [words of voxels]: bits of those that it fills by more than a half */
    struct mpm_pieces {
        int n[3];                          /* seeds; 0: no joints */
        struct gpu_buffer *counts, *holds; /* uint: by joint, two each, and by piece; by joint */
        uint32_t *host_counts, *host_holds;
        uint32_t *body; /* by piece: a number that pieces which joints connect share */
    } pieces;
    size_t n_parts, n_nodes, n_entries, n_mixed;
    size_t room_parts, room_entries; /* in what is made as it is needed */
    size_t n_left;                   /* particles that have left the domain since they were loaded */
    double fastest, mean_speed;      /* m/s, as of the last look */
    long steps;                      /* taken since the start of the last call */
};

/* Nodes of the lattice: gpu_work needs room for as many. */
size_t mpm_nodes(const int voxels[3]);
/* With joints `block` m apart, 0: none. */
uint64_t mpm_bytes(size_t n_max, const int voxels[3], double h, double block);
MUST_USE status mpm_create(struct gpu *gpu, const int voxels[3], double h, size_t n_max,
                           const struct mpm_options *options, struct mpm *out);
void mpm_destroy(struct gpu *gpu, struct mpm *m);

/* The particles of p whose number is in `list` become material points at rest. Their viability in p is 0 from
 * here until mpm_store(). */
void mpm_load(struct gpu *gpu, struct mpm *m, struct particles *p, struct gpu_buffer *list, size_t n);

/* What is left in p is an obstacle from now on, until p is indexed; NULL: nothing is. p stays the caller's. Records only. */
void mpm_obstacle(struct gpu *gpu, struct mpm *m, struct particles *p);

/* Simulates `seconds` in equal steps no longer than the CFL number allows. Waits. E_NUMERIC if speeds are not
 * finite. */
MUST_USE status mpm_run(struct gpu *gpu, struct gpu_work *work, struct mpm *m, double seconds);

/* The particles of p they came from get place, velocity, viability (0 outside the domain), stress and phase:
 * broken rock is deposit; what still moves is falling, unless it is said to have come to rest. p must not have
 * been indexed since mpm_load() or mpm_follow(); those whose point is gone keep viability 0. */
void mpm_store(struct gpu *gpu, struct mpm *m, struct particles *p, bool moving);

/* After mpm_store(), of a fall that is over: fragments, whole rock of one body that faces of voxels connect, are
 * rubble (PHASE_FALLING) if they have the volume of a cube of `rubble` m, deposits if they are smaller, as loose
 * grains are. Waits. */
MUST_USE status mpm_settle(struct gpu *gpu, struct mpm *m, struct particles *p, double rubble);

/* After p was indexed: where each point's particle is now, by id. All ids are below n_ids; `table` is scratch of
 * n_ids words. */
void mpm_follow(struct gpu *gpu, struct mpm *m, struct particles *p, struct gpu_buffer *table);

/* Can a point be of that piece (MPM_PIECE), as these options part the rock; and can one of that piece be on that joint
 * (MPM_JOINT)? */
bool mpm_piece_fits(const struct mpm *m, uint32_t piece);
bool mpm_joint_fits(const struct mpm *m, uint32_t piece, uint32_t joint);

/* Static equilibrium of p by kinetic damping: motion stops whenever its energy has passed a peak, until the
 * energy of a peak is below tolerance^2 of the elastic energy. Fills p's stress and von_mises. *steps and *error
 * say when it stopped. Waits. E_NUMERIC as above. */
MUST_USE status mpm_rest(struct gpu *gpu, struct gpu_work *work, struct mpm *m, struct particles *p,
                         double tolerance, int max_steps, int *steps, double *error);

#endif
