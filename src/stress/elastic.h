/* Stress of rock at rest: linear elasticity on the grid's hexahedra, by conjugate gradients with
 * a cycle of multigrid (multigrid.h) or, for comparison, Jacobi's diagonal as preconditioner.
 *
 * Cells are 2 h wide and trilinear; one element matrix serves all, scaled by how much of the cell is rock, as
 * is its weight. Deposits are softer than rock, and their weight presses on the rock or the ground below them: a heap does
 * not hang on the wall beside it. Nodes on the ground (z = 0) are held, those at the domain's walls slide along them, all
 * other faces are free. The solver starts from the
 * last frame's displacement.
 *
 * Sums are fixed trees, so that equal input gives equal bits. It stops on the error of the stress, not on the
 * residual: what a step takes out of the error is known in the energy norm, which is the stress's L2 norm weighted
 * by the compliance (Hestenes and Stiefel 1952, theorem 6:1), and with a cycle of multigrid steps take about the same
 * share each, so that what they will take yet is known as well. With Jacobi's diagonal they do not: there the stop
 * sees what the last CG_CHECK steps took, and is blind to slow modes.
 *
 * source  Arenite section 4 (static limit of eq. 4)     twin  tests/ref/elastic_ref.c
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
    double tolerance;  /* of T: its error's 95th percentile by its own */
    int max_iterations;
    bool multigrid; /* preconditioned by a cycle of multigrid, else by Jacobi's diagonal */
    struct gpu_buffer *
        stiff; /* float, by cell of the domain: its share of the stiffness (geology/maps.h), the caller's; NULL: 1 */
    unsigned walls; /* of the domain, WALL_* of shared/params.h: nodes at them slide along them */
};

struct elastic {
    struct stress_lattice lattice; /* of the cells and nodes; values are kept as it says */
    double dx;                     /* m */
    struct elastic_options options;
    struct gpu_buffer
        *u; /* vec4 [items]: displacement, m; the state that frames hand on. 0 at nodes that do not move */
    struct gpu_buffer *p, *q, *r; /* vec4 [items] */
    struct gpu_buffer *scalars, *marks;
    struct gpu_buffer *weight; /* float [items], the cells': in full cells of rock */
    /* vec4 [items], the cells': xx yy zz T, xy yz xz von Mises; Pa, tension positive. While it is solved, the nodes': the
     * finest level's corrections. */
    struct gpu_buffer *normal_stress, *shear_stress;
    struct multigrid levels;
    int iterations; /* of the last solve */
    double error;   /* its estimate when it stopped */
};

/* The job's rock, and how exactly its stress is wanted; `stiff` may be NULL. */
struct elastic_options elastic_options(const struct job *job, struct gpu_buffer *stiff);

/* Bytes on the device for about n particles, so many of them bare, whose rows along x have so many ends, in a domain of that
 * many voxels. */
uint64_t elastic_bytes(const int voxels[3], uint64_t n, uint64_t bare, uint64_t ends);

/* What gpu_work_create() has to be for. */
size_t elastic_work_items(const int voxels[3]);

MUST_USE status elastic_create(struct gpu *gpu, const int voxels[3], double h,
                               const struct elastic_options *options, struct elastic *out);
void elastic_destroy(struct gpu *gpu, struct elastic *e);

/* Takes the particles' shape into the grid. Nodes that move now and did so before keep their displacement, others start
 * from 0. Waits. */
MUST_USE status elastic_assemble(struct gpu *gpu, struct gpu_work *work, struct elastic *e,
                                 const struct particles *p);

/* There is no shape any more, and no displacement. */
MUST_USE status elastic_forget(struct gpu *gpu, struct elastic *e);

/* The displacement of the nodes that move, as vec4 [lattice.n_active] in their order on the grid. */
MUST_USE status elastic_download(struct gpu *gpu, struct elastic *e, void *out);
MUST_USE status elastic_upload(struct gpu *gpu, struct elastic *e, const void *u);

/* Solves for u. Waits. E_NUMERIC if the solution is not finite. */
MUST_USE status elastic_solve(struct gpu *gpu, struct gpu_work *work, struct elastic *e);

/* From u to the cells' stress, and to the particles' `stress` and `von_mises`. Records only. */
void elastic_recover(struct gpu *gpu, struct elastic *e, struct particles *p);

/* The last step of it again, for others whose P lies in the rock, before anything else is done with *e. Records only. */
void elastic_sample(struct gpu *gpu, struct elastic *e, struct particles *p);

#endif
