/* Steady groundwater on an impermeable bed: thickness of the saturated layer, and outflow.
 *
 * Dupuit's assumption (Bear 1972, ch. 8): the velocity does not depend on height and follows the slope of the water table,
 *
 *   div (K b grad (base + b)) + recharge = 0,        0 <= b <= room
 *
 * with b = 0 where the rock ends and the water leaves. Where the table would rise above the rock's top the water comes out there.
 * Cells are columns of width dx. The flow from a cell u to a neighbour l whose base is `drop` metres lower is
 *
 *   K (b_u + b_l) / 2 (drop + b_u - b_l)             where the lower water is as high as the upper bed, b_l > drop
 *   K b_u (drop + (b_u - b_l) / 2)                   else
 *
 * the mean thickness times the slope of the table; on level beds it is Dupuit's formula exactly, in b^2. It grows with b_u and falls
 * with b_l (an M-function), so b is never negative and the solution is unique. An end of the rock half a cell away drains
 * K (b - sill)^2.
 */
#ifndef HOODOO_AQUIFER_H
#define HOODOO_AQUIFER_H

#include <stdint.h>

#include "groundwater/fivepoint.h"

enum aquifer_face {
    FACE_CLOSED, /* no flow: a wall of the domain, or the bed itself */
    FACE_JOINED, /* to the neighbouring cell, whose face is FACE_JOINED, too */
    FACE_OPEN,   /* to air */
    FACE_SIDE,   /* to an open side of the domain; flows as FACE_OPEN */
    FACE_DEEP,   /* to rock beyond the end of the bed, where water goes down */
    FACE_KINDS
};

struct aquifer {
    int n[2];
    double dx;
    /* Input, by cell: */
    double *conductivity; /* m/yr; 0: no bed with rock on it here */
    double *base, *room;  /* m: top of the bed, and thickness of the rock on it */
    double *recharge;     /* m3/yr, >= 0 */
    uint8_t *face[NEIGHBOURS];
    double
        *sill[NEIGHBOURS]; /* m: height that water must exceed to flow there; for faces that are not closed */
    /* Output: */
    double *thick; /* m: b, thickness of the water */
    double *over;  /* m3/yr: outflow at the rock's top */
    double left;   /* sum of the balances' residuals over the sum of the recharge */
    int rounds;
    double *step, *scale; /* scratch of a round */
    uint8_t *full;        /* 1: the water reaches the rock's top */
};

/* Creates arrays for n[0] * n[1] cells, zeroed. */
MUST_USE status aquifer_create(const int n[2], double dx, struct aquifer *out);
void aquifer_destroy(struct aquifer *a);

/* Solves for thick and over, by Newton's method in b^2 / 2 (one step on a level bed) with an active set of full cells, until `left` is
 * at most AQUIFER_LEFT, or for `most` rounds. */
#define AQUIFER_LEFT 1e-7
void aquifer_solve(struct aquifer *a, struct fivepoint_solver *solver, int most);

/* Flow out of cell c towards neighbour d in the solution, m3/yr. */
double aquifer_flow(const struct aquifer *a, size_t c, int d);

#endif
