/* Linear systems on a level grid whose rows couple a cell with its four neighbours, solved by BiCGSTAB (van der Vorst 1992) preconditioned
 * with cycles of a multigrid that joins two by two cells and adds their equations (aggregation, Notay 2010). Double precision, on one
 * thread, in a fixed order: the same bits every time.
 */
#ifndef HOODOO_FIVEPOINT_H
#define HOODOO_FIVEPOINT_H

#include <stddef.h>

#include "base/status.h"

/* Neighbours of a cell, in this order everywhere. */
enum { WEST, EAST, SOUTH, NORTH, NEIGHBOURS };

/* A x = b of nx * ny cells, numbered j nx + i. Cells whose diagonal is 0 are left out: x is 0 there, and nothing may couple with them. Each
 * other one's column sums to 0 or more, with nothing positive off the diagonal (an M-matrix), which is what balances of water are like. */
struct fivepoint {
    int n[2];
    double *diagonal, *coupling[NEIGHBOURS]; /* coupling[d][c]: what row c has of its neighbour d */
};

struct fivepoint_solver;
MUST_USE status fivepoint_create(const int n[2], struct fivepoint_solver **out);
void fivepoint_destroy(struct fivepoint_solver **solver);

/* Its own matrix, of the grid it was made for, to be filled before each solve. */
struct fivepoint *fivepoint_matrix(struct fivepoint_solver *solver);

/* Until sum |b - A x| <= tolerance * sum |b|, or after so many iterations, from x = 0. Returns the iterations. */
int fivepoint_solve(struct fivepoint_solver *solver, const double *b, double *x, double tolerance, int most);

/* The cell beside c towards d, or -1 beyond the grid. */
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
