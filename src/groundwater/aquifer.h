/* Steady groundwater on a bed that lets none through: how thick it is, and where it comes out.
 *
 * Dupuit's assumption (Bear 1972, ch. 8): water flows along the bed as fast at any height above it, by the slope of the water table,
 *
 *   div (K b grad (base + b)) + recharge = 0,        0 <= b <= room
 *
 * with b = 0 where the rock ends: the water leaves on the bed. Where the table would stand above the rock's top, it comes out there. Cells are columns. What flows from a
 * cell u into one on a lower base, drop metres below, over the edge between them, of the width dx and dx long, is
 *
 *   K (b_u + b_l) / 2 (drop + b_u - b_l)             where the lower water is as high as the upper bed, b_l > drop
 *   K b_u (drop + (b_u - b_l) / 2)                   else
 *
 * which is the mean thickness times the slope of the table; on level beds it is Dupuit's exactly, in b^2. It grows with b_u and falls with b_l, so that b is
 * never negative and the solution is one (an M-function). A rock's end half a cell away takes K (b - sill)^2.
 */
#ifndef HOODOO_AQUIFER_H
#define HOODOO_AQUIFER_H

#include <stdint.h>

#include "groundwater/fivepoint.h"

enum aquifer_face {
    FACE_CLOSED, /* nothing passes: a wall of the domain, or the bed itself */
    FACE_JOINED, /* to a cell whose face is joined to this one */
    FACE_OPEN,   /* to the air, */
    FACE_SIDE,   /* beyond an open side of the domain, which is the same, */
    FACE_DEEP,   /* or to rock where the bed has ended, down which it goes */
    FACE_KINDS
};

struct aquifer {
    int n[2];
    double dx;
    /* What is given, by cell: */
    double *conductivity; /* m/yr; 0: there is no such bed with rock on it here */
    double *base, *room;  /* m: the bed's top, and the rock's thickness on it */
    double *recharge;     /* m3/yr, 0 or more */
    uint8_t *face[NEIGHBOURS];
    double *sill[NEIGHBOURS]; /* m: the height over which water goes there, of faces that are not closed */
    /* What is found: */
    double *thick; /* m: of the water, b */
    double *over;  /* m3/yr: what comes out at the rock's top */
    double left;   /* sum of what no balance accounts for over the sum of the recharge */
    int rounds;
    double *step, *scale; /* of a round; and which cells the water fills: */
    uint8_t *full;
};

/* Zeroed, for nx * ny cells. */
MUST_USE status aquifer_create(const int n[2], double dx, struct aquifer *out);
void aquifer_destroy(struct aquifer *a);

/* Finds thick and over: by Newton's method in b^2 / 2, which on a level bed is one step, with an active set of cells that are full. It ends when `left` is
 * at most AQUIFER_LEFT, or after `most` rounds. */
#define AQUIFER_LEFT 1e-7
void aquifer_solve(struct aquifer *a, struct fivepoint_solver *solver, int most);

/* What flows out of a cell towards d, m3/yr, as found. */
double aquifer_flow(const struct aquifer *a, size_t c, int d);

#endif
