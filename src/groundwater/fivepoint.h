/* Five-point linear systems on a 2-D grid, solved by BiCGSTAB (van der Vorst 1992) preconditioned by aggregation multigrid (Notay
 * 2010): 2 x 2 cells form a coarse cell and their equations are added. Double precision, on one thread, in a fixed order: the same
 * bits in every run.
 */
#ifndef HOODOO_FIVEPOINT_H
#define HOODOO_FIVEPOINT_H

#include <stddef.h>

#include "base/status.h"

/* Neighbours of a cell, in the order of all arrays. */
enum { WEST, EAST, SOUTH, NORTH, NEIGHBOURS };

/* A x = b on nx * ny cells, numbered j nx + i. A cell whose diagonal is 0 is left out: x is 0 there, and no other cell may couple with
 * it. A must be an M-matrix, as balances of water are: off-diagonal entries <= 0 and column sums >= 0. */
struct fivepoint {
    int n[2];
    double *diagonal,
        *coupling[NEIGHBOURS]; /* coupling[d][c]: entry of row c in the column of its neighbour d */
};

struct fivepoint_solver;
MUST_USE status fivepoint_create(const int n[2], struct fivepoint_solver **out);
void fivepoint_destroy(struct fivepoint_solver **solver);

/* The solver's matrix, owned by it; fill it before each solve. */
struct fivepoint *fivepoint_matrix(struct fivepoint_solver *solver);

/* Solves from x = 0 until sum |b - A x| <= tolerance * sum |b|, or for `most` iterations. Returns the number of iterations. */
int fivepoint_solve(struct fivepoint_solver *solver, const double *b, double *x, double tolerance, int most);

/* Number of the neighbour d of cell c, or -1 beyond the grid. */
static inline ptrdiff_t fivepoint_beside(const int n[2], size_t c, int d)
{
    const size_t nx = (size_t)n[0], i = c % nx, j = c / nx;
    switch (d) {
    case WEST:
        return i > 0 ? (ptrdiff_t)c - 1 : -1;
    case EAST:
        return i + 1 < nx ? (ptrdiff_t)c + 1 : -1;
    case SOUTH:
        return j > 0 ? (ptrdiff_t)(c - nx) : -1;
    default:
        return j + 1 < (size_t)n[1] ? (ptrdiff_t)(c + nx) : -1;
    }
}

#endif
