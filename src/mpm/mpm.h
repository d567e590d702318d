/* Rock in motion and at rest by the material point method: moving least squares transfers (MLS-MPM), affine velocities (APIC),
 * quadratic kernel, explicit time steps. README.md has the equations.
 *
 * Cells are 2 h wide, for eight particles each. Particles are sorted by base cell, within a cell by piece and id; the particles of
 * one piece in one cell are a part. One invocation per part sums its particles over their 27 nodes, then each node sums the
 * parts of its 27 cells: no atomics, the same bits in every run. A sort is valid until particles may have moved a seventh of a
 * cell; until then the kernel's polynomials remain exact (shaders/mpm/grid.glsl).
 *
 * Joints divide the rock into pieces, the Voronoi cells of hashed points. A joint breaks as a whole once a share of its particles
 * has cracked. Pieces connected by joints that hold are one body. Each body has its own velocities at the nodes; where bodies
 * meet they do not enter each other and rub (Bardenhagen, Brackbill and Sulsky, The material-point method for granular materials,
 * 2000). All loose grains together are one body. Without joints there is one body.
 *
 * The deformation is stored as H = F - I, since increments of F would fall below its last bit (measured: an error of 38 % at a CFL
 * number of 0.1). Between frames a particle's state is position, velocity, affine velocity, H, viability (share), how far it has
 * come apart, strength, piece and joint. Steps need nothing else and do not depend on the particles' order.
 *
 * Sources: Arenite section 4.2; Hu et al., A Moving Least Squares Material Point Method, 2018; Stomakhin et al., Energetically
 * Consistent Invertible Elasticity, 2012; Klar et al., Drucker-Prager Elastoplasticity for Sand Animation, 2016.
 * Reference implementation: tests/ref/mpm_ref.c.
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
    double viscosity;  /* in density * wave speed * cell size; damps vibration, not rigid motion; 0 or more */
    double rebound;    /* factor of the stress during unloading after an impact; 1: elastic */
    double friction;   /* Coulomb coefficient on ground, resting rock and between bodies */
    double repose_deg; /* friction angle of broken rock */
    double strength;   /* Pa: tension at which rock breaks */
    double block;      /* m: size of the pieces between joints, at least two cells; 0: no joints */
    double joint;      /* strength at joints, as a share of `strength` */
    uint32_t seed;     /* of the joints */
    double
        lift; /* cells that the ground's nodes are below the ground: 0 for equilibrium, 0.75 for motion (params.h) */
    double played;  /* factor for velocities given to particles: playback speed in the film; 0: 1 */
    unsigned walls; /* WALL_* of shared/params.h: sides of the domain that are frictionless walls */
};

/* Lowers the elastic moduli, by the same factor, so that pressure waves run at `speed` m/s. Never raises them. */
void mpm_soften(struct mpm_options *o, double speed);

/* State vectors and words, in the order of the checkpoint's sections. */
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
    MPM_ORIGIN, /* the rock's particle; not part of the state, found by id */
    MPM_WORDS
};
/* place = (x, H22), velocity = (v, C22), affine_x = (column x of C, C02), affine_y = (column y of C, C12); stretch_x and
 * stretch_y hold H in the same way. */
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
    struct gpu_buffer *partial, *reach; /* [27, 28][parts allocated]: by node and part */
    struct gpu_buffer *entry_node, *entry_body, *entry_group, *mass, *velocity, *product;
    struct gpu_buffer *scalars;
    const struct particles *resting; /* rock at rest, an obstacle; borrowed, or NULL */
    struct gpu_buffer *full; /* uint [words of voxels]: bits of voxels that it fills by more than half */
    struct mpm_pieces {
        int n[3];                          /* seeds; 0: no joints */
        struct gpu_buffer *counts, *holds; /* uint: two per joint, then one per piece; one per joint */
        uint32_t *host_counts, *host_holds;
        uint32_t *body; /* by piece: its body, the same for pieces that joints connect */
    } pieces;
    size_t n_parts, n_nodes, n_entries, n_mixed;
    size_t parts_allocated, entries_allocated; /* allocated */
    size_t n_left;                             /* particles that have left the domain since mpm_load() */
    double fastest, mean_speed;                /* m/s, after the last batch of steps */
    long steps;                                /* in the last mpm_run() */
};

/* Number of nodes; the caller's gpu_work must be created for at least as many items. */
size_t mpm_nodes(const int voxels[3]);
/* Bytes on the device, with joints `block` m apart (0: none). */
uint64_t mpm_bytes(size_t n_max, const int voxels[3], double h, double block);
MUST_USE status mpm_create(struct gpu *gpu, const int voxels[3], double h, size_t n_max,
                           const struct mpm_options *options, struct mpm *out);
void mpm_destroy(struct gpu *gpu, struct mpm *m);

/* Makes the n particles of p that `list` numbers material points at rest and unstrained. Their viability in p is 0 from here until
 * mpm_store(). Records only. */
void mpm_load(struct gpu *gpu, struct mpm *m, struct particles *p, struct gpu_buffer *list, size_t n);

/* Makes the rock that is left in p an obstacle, valid until p is indexed again; NULL: none. p is borrowed. Records only. */
void mpm_obstacle(struct gpu *gpu, struct mpm *m, struct particles *p);

/* Simulates `seconds` in equal steps no longer than the CFL number allows. Waits for the device. E_NUMERIC if speeds are not
 * finite. */
MUST_USE status mpm_run(struct gpu *gpu, struct gpu_work *work, struct mpm *m, double seconds);

/* Writes position, velocity, viability (0 outside the domain), stress and phase back to the particles of p that the points came
 * from: broken rock becomes deposit; with `moving`, points faster than 0.3 m/s become falling rock. p must not have been indexed
 * since mpm_load() or mpm_follow(). Particles whose point is gone keep viability 0. Records only. */
void mpm_store(struct gpu *gpu, struct mpm *m, struct particles *p, bool moving);

/* After mpm_store(), at the end of a fall: classifies fragments, which are whole rock of one body connected across voxel faces.
 * Those with at least the volume of a cube of `rubble` m become rubble (PHASE_FALLING), smaller ones and loose grains become
 * deposits. Waits for the device. */
MUST_USE status mpm_classify(struct gpu *gpu, struct mpm *m, struct particles *p, double rubble);

/* After p was indexed: finds each point's particle again, by id. `table` is scratch with an item for every id. Records only. */
void mpm_follow(struct gpu *gpu, struct mpm *m, struct particles *p, struct gpu_buffer *table);

/* Validation of checkpoints: whether these options have such a piece (MPM_PIECE), and whether a point of that piece can be at
 * that joint (MPM_JOINT). */
bool mpm_piece_fits(const struct mpm *m, uint32_t piece);
bool mpm_joint_fits(const struct mpm *m, uint32_t piece, uint32_t joint);

/* Static equilibrium of p by kinetic damping: all velocities are set to 0 whenever the kinetic energy has passed a peak, until the
 * peak is below tolerance^2 of the elastic energy or after max_steps. Fills p's stress (T) and von_mises, Pa. *steps: steps
 * taken; *error: sqrt(peak / elastic energy) at the end. Waits for the device. E_NUMERIC if energies are not finite. */
MUST_USE status mpm_rest(struct gpu *gpu, struct gpu_work *work, struct mpm *m, struct particles *p,
                         double tolerance, int max_steps, int *steps, double *error);

#endif
