/* Stress of rock at rest: linear elasticity on hexahedra, solved by conjugate gradients with a multigrid cycle
 * (multigrid.h) or, for comparison, with the diagonal (Jacobi) as preconditioner. README.md has the equations.
 *
 * Cells are trilinear and 2 h wide. One element matrix serves all; it and the cell's weight are scaled by the cell's fill.
 * Deposits are softer than rock, and their weight presses on the rock below them, so that a heap does not hang on the wall
 * beside it. Nodes on the ground (z = 0) are fixed, nodes at the domain's walls slide along them, all other faces are
 * traction-free. The solver starts from the displacement of the last frame.
 *
 * Reductions are fixed trees: equal input gives equal bits. The solver stops on the estimated error of the stress and not on
 * the residual. Each step of conjugate gradients tells how much energy it removed from the error (Hestenes and Stiefel 1952,
 * theorem 6:1), and the energy norm is the L2 norm of the stress weighted by the compliance. With the multigrid cycle the
 * steps converge at a nearly constant rate, so the energy that is left is extrapolated. With Jacobi they do not: there the
 * stop looks at the last CG_CHECK steps and does not see slow modes.
 *
 * Source: Arenite section 4, the static limit of eq. 4. Reference implementation: tests/ref/elastic_ref.c.
 */
#ifndef HOODOO_ELASTIC_H
#define HOODOO_ELASTIC_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "particles/particles.h"
#include "stress/lattice.h"
#include "stress/multigrid.h"

struct elastic_options {
    double lambda, mu; /* Pa */
    double density;    /* kg/m3 */
    double gravity;    /* m/s2 */
    double loose;      /* Young's modulus of deposits, as a share of the rock's */
    double tolerance;  /* 95th percentile of the error of T, as a share of the 95th percentile of T */
    int max_iterations;
    bool multigrid; /* precondition by a multigrid cycle; else by the diagonal */
    struct gpu_buffer
        *stiff;     /* float [cells of the domain], not owned: stiffness share (geology/maps.h); NULL: 1 */
    unsigned walls; /* WALL_* of shared/params.h: sides of the domain along which nodes slide */
};

struct elastic {
    struct stress_lattice lattice; /* storage of cells and nodes; [items] below are lattice_items() */
    double dx;                     /* m: cell size, 2 h */
    struct elastic_options options;
    struct gpu_buffer
        *u; /* vec4 [items]: displacement, m; 0 at nodes that do not move. The only state between frames */
    struct gpu_buffer *p, *q, *r; /* vec4 [items]: search direction, K p, residual */
    struct gpu_buffer *scalars, *marks;
    struct gpu_buffer *weight; /* float [items], by cell: in full cells of rock */
    /* vec4 [items], by cell: xx yy zz T, and xy yz xz von Mises; Pa, tension positive (T: compression positive). During a
     * solve they hold, by node, the finest level's corrections. */
    struct gpu_buffer *normal_stress, *shear_stress;
    struct multigrid levels;
    int iterations; /* of the last solve */
    double error;   /* estimated error when the last solve stopped */
};

/* Material, tolerance and solver of a job. `stiff` may be NULL. */
struct elastic_options elastic_options(const struct job *job, struct gpu_buffer *stiff);

/* Estimated bytes on the device for n particles in a domain of `voxels`, of which `bare` are at the surface and `ends` end a
 * row along x. */
uint64_t elastic_bytes(const int voxels[3], uint64_t n, uint64_t bare, uint64_t ends);

/* The number of items that the caller's gpu_work must be created for. */
size_t elastic_work_items(const int voxels[3]);

MUST_USE status elastic_create(struct gpu *gpu, const int voxels[3], double h,
                               const struct elastic_options *options, struct elastic *out);
void elastic_destroy(struct gpu *gpu, struct elastic *e);

/* Builds the grid for the particles' current shape. Nodes that moved before keep their displacement, new ones start from 0.
 * Waits for the device. */
MUST_USE status elastic_assemble(struct gpu *gpu, struct gpu_work *work, struct elastic *e,
                                 const struct particles *p);

/* Empties the grid and frees its memory: no shape, no displacement. */
MUST_USE status elastic_clear(struct gpu *gpu, struct elastic *e);

/* Displacement of the moving nodes, vec4 [lattice.n_active], m, in the order of the grid: the checkpoint's section. */
MUST_USE status elastic_download(struct gpu *gpu, struct elastic *e, void *out);
MUST_USE status elastic_upload(struct gpu *gpu, struct elastic *e, const void *u);

/* Solves K u = f from the current u, until the estimated error is within the tolerance or max_iterations are done. Sets
 * iterations and error. Waits for the device. E_NUMERIC if the solution is not finite. */
MUST_USE status elastic_solve(struct gpu *gpu, struct gpu_work *work, struct elastic *e);

/* Computes the cells' stress from u, and from it the particles' `stress` (T) and `von_mises`, Pa. Records only. */
void elastic_recover(struct gpu *gpu, struct elastic *e, struct particles *p);

/* Only the last step of elastic_recover(), for further positions P in the rock. Must follow elastic_recover() without any
 * other call on *e in between. Records only. */
void elastic_sample(struct gpu *gpu, struct elastic *e, struct particles *p);

#endif
