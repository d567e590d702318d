/* A preconditioner for the stress grid's conjugate gradients whose quality does not depend on the grid's size.
 *
 * Levels     Cells of a level are twice as wide as the level's below, until the rock is within four of the domain's
 *            corner; each keeps what is near rock (lattice.h). A coarse cell has the mean stiffness of its eight
 *            children, and the same element matrix: for whole cells that is the Galerkin product, and nothing but a
 *            share is stored of any cell. Nodes on the ground are held on all levels; nodes coincide, so that
 *            interpolation is trilinear and restriction its transpose.
 * Smoother   On the finest level one damped Jacobi step before and one after; on the others two steps of the
 *            Chebyshev polynomial of the fourth kind. Both are symmetric, gather only, and take as largest
 *            eigenvalue that of an element, which bounds the assembled matrix's whatever the shape.
 * Cycle      W: a level is visited twice for each visit of the level below. Coarse cells are too stiff where
 *            members are thinner than they are; the second visit makes up for most of that at little cost.
 *
 * The cycle is a fixed symmetric linear operator, as conjugate gradients want it, and has no state but its levels'.
 *
 * source  Lottes 2022, Optimal polynomial smoothers for multigrid V-cycles; McAdams et al. 2010
 * twin    tests/ref/multigrid_ref.c
 */
#ifndef HOODOO_MULTIGRID_H
#define HOODOO_MULTIGRID_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "stress/lattice.h"

enum { STRESS_LEVELS = 16 };

struct stress_level {
    struct stress_lattice lattice;
    struct stress_params params; /* n is n_active */
    struct gpu_buffer *r;        /* vec4 [n_active]: residual, and the inverse diagonal */
    struct gpu_buffer *z;        /* vec4 [items]: correction */
    struct gpu_buffer *other;    /* vec4 [items]: the one before, and the defect */
};

struct multigrid {
    int n, n_used;                            /* levels of the whole grid, and those that the shape needs */
    struct stress_level level[STRESS_LEVELS]; /* the finest's buffers are the solver's */
};

/* Bytes on the device for such a rock, in cells of the finest level, whose own buffers are not counted. */
uint64_t multigrid_bytes(const int cells[3], const struct rock_size *rock);

/* Levels above one of that many cells. */
MUST_USE status multigrid_create(struct gpu *gpu, const int cells[3], struct multigrid *out);
void multigrid_destroy(struct gpu *gpu, struct multigrid *m);

/* For a shape: lattice and params of the finest level, which the caller has set, are taken to the coarser ones. `marks` (a
 * word for each of the finest's runs, and one) is scratch. Waits. */
MUST_USE status multigrid_assemble(struct gpu *gpu, struct gpu_work *work, struct multigrid *m,
                                   struct gpu_buffer *marks);

/* level[0].z = the cycle's estimate of the solution for level[0].r. Records only, as the stages "stress" and, for the
 * coarser levels, "stress level 1" and so on; leaves the stage "stress". */
void multigrid_cycle(struct gpu *gpu, struct multigrid *m);

#endif
