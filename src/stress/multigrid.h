/* Geometric multigrid preconditioner for the stress grid: the number of iterations does not grow with the grid.
 *
 * Levels     Each level's cells are twice as wide as those of the level below. Coarsening ends where the rock spans no more
 *            than four cells from the domain's corner. Every level is stored sparsely (lattice.h). A coarse cell has the mean
 *            stiffness of its eight children and the same element matrix: where the children are equally stiff this is the
 *            Galerkin product, and a cell needs no storage but its stiffness share. Nodes on the ground are fixed on all
 *            levels. Coarse nodes coincide with fine ones: interpolation is trilinear, restriction its transpose.
 * Smoother   On the finest level one damped Jacobi step before and one after; on the others two steps of the
 *            Chebyshev polynomial of the fourth kind (Lottes 2022); on the coarsest level eight. Both are symmetric and
 *            only gather. The bound on the largest eigenvalue is that of one element, which bounds the assembled matrix
 *            whatever the shape.
 * Cycle      W: a level is visited twice for each visit of the level below. Coarse cells are too stiff where a member is
 *            thinner than they are; the second visit makes up for most of that at little cost.
 *
 * The cycle is a fixed symmetric linear operator, as conjugate gradients require. It keeps no state between calls.
 *
 * Sources: Lottes 2022, Optimal polynomial smoothers for multigrid V-cycles; McAdams et al. 2010.
 * Reference implementation: tests/ref/multigrid_ref.c.
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
    struct gpu_buffer *r;        /* vec4 [n_active]: residual (xyz), inverse diagonal (w) */
    struct gpu_buffer *z;        /* vec4 [items]: correction */
    struct gpu_buffer *other;    /* vec4 [items]: previous correction, or defect */
};

struct multigrid {
    int n, n_used; /* levels of the whole grid, and levels used for the current shape */
    struct stress_level level[STRESS_LEVELS]; /* level[0] borrows the solver's buffers */
};

/* Estimated bytes on the device of all levels but the finest, for rock given in cells of the finest. */
uint64_t multigrid_bytes(const int cells[3], const struct rock_size *rock);

/* Creates the levels above a finest one of that many cells. */
MUST_USE status multigrid_create(struct gpu *gpu, const int cells[3], struct multigrid *out);
void multigrid_destroy(struct gpu *gpu, struct multigrid *m);

/* Builds the coarser levels from the lattice and params of the finest, which the caller has set. `marks` (uint, one more
 * than the finest level's runs) is scratch. Waits for the device. */
MUST_USE status multigrid_assemble(struct gpu *gpu, struct gpu_work *work, struct multigrid *m,
                                   struct gpu_buffer *marks);

/* One cycle: level[0].z approximates the solution for the right-hand side level[0].r. Records only, timed as the stages
 * "stress" and, for the coarser levels, "stress level 1" and so on; "stress" is current afterwards. */
void multigrid_cycle(struct gpu *gpu, struct multigrid *m);

#endif
