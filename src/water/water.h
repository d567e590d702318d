/* Water over rock in three dimensions: where it runs, how much, and what it cuts (Arenite section 6, eqs. 13,
 * 14; the routing follows FastFlow, Jain et al. 2024).
 *
 * Cells      Voxels, or for crumbs cubes of 2 x 2 x 2 of them; numbered (k ny + j) nx + i. The latter are on a grid that a
 *            hash of (seed, frame, step) shifts by 0 or 1 voxel on each axis, so that beds and deposits do not show it. The
 *            cells at the domain's sides may be half outside it.
 * Kinds      A cell with particles is SURF if the cell above it has none (or is outside), else SOLID; SOLID
 *            with an empty cell below or beside it, or with a face on the domain's side, is a WALL. The others
 *            are EMPTY.
 * Outlets    Water and sediment leave the domain through the cells at its four sides and through empty cells
 *            on the bare ground (k = 0).
 * Receivers  EMPTY drains onto the SURF cell at the bottom of its run of empty cells (or out, on the ground).
 *            SURF drains to one of the lower floors beside it, of the SURF cell there or at the bottom of the empty cells there
 *            (as often as it is lower, in turns, or for crumbs by a hash), else it is a pit. With `leak`, first of all into
 *            an empty cell below it. WALLs drain below or beside them; they carry no water, only what breaks
 *            off them. Receivers name the SURF cell (or outlet) at the end of a fall, which need not touch.
 * Pits       overflow across the lowest pass: the passes taken are the minimum spanning tree of the basins,
 *            in the total order (higher altitude of its two ends, edge number), and the receivers from each
 *            basin's pass down to its pit are turned round. So the highest altitude on the way out of every
 *            cell is the lowest possible, and the result does not depend on the order of any thread.
 * Cavities   Cells with no way out are DEAD. Their receivers stay within the cavity and end in a pit.
 * Discharge  Springs run along receivers. Rain is split between all floors beside it where water stands lower, in proportion, as a
 *            sheet that runs along the gradient: its discharge per metre of contour does not depend on the cells. In
 *            pits, up to their pass, it follows the receivers too.
 * Streams    What runs over a floor is spread over the width of a stream of that discharge, W = width_m Q^width_power and at
 *            least least_width_m, as far as the ground beside it is no steeper than a bank; several streams add up. Where a
 *            spring's stream, which is about the line that its steps follow, is narrower than cells, it pulls as hard as it is narrow, on its share of the cells. Its slope is
 *            from the water abreast down to the water below, within half of slope_m.
 */
#ifndef HOODOO_WATER_H
#define HOODOO_WATER_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "particles/particles.h"

enum water_node_array {
    WATER_CELL,      /* the span's lowest cell */
    WATER_Z,         /* its altitude */
    WATER_LEVEL,     /* of its water: the same, or in a pit that of the pass on its way out */
    WATER_INITIAL,   /* receiver: a node, before pits overflow */
    WATER_FINAL,     /* and after */
    WATER_BASIN,     /* the number of the pit it first drains to */
    WATER_COMPONENT, /* by basin: n_basins if it has a way out */
    WATER_RAIN,      /* discharge, in rain_unit */
    WATER_SPRING,    /* and in spring_unit */
    WATER_DROP,      /* float, m: how far down it is to the floors below by which its slope is */
    WATER_FROM,      /* by basin: the pass it overflows, from node */
    WATER_TO,        /* to node */
    WATER_LOWEST,    /* by component, while they join */
    WATER_PICK,
    WATER_NEXT,
    WATER_SCRATCH,
    WATER_NODE_ARRAYS = WATER_SCRATCH + 4
};

struct water {
    int size; /* voxels along a cell's side: 1, or 2 for crumbs */

    /* Of the last routing: voxels / size, one more on shifted axes. Voxel v lies in cell (v + shift) / size. */
    int cells[3], shift[3];

    /* On request of the routing, and made with the first such, for every cell:
     *   tag       uint: WATER_EMPTY, _SURF, _WALL or _SOLID (tag & WATER_KIND), and the flags WATER_OUT (what
     *             gets here leaves the domain), WATER_DEAD and, after water_sweep(), WATER_SWEPT (params.h)
     *   z         uint, 2^16 per cell's height, from cell 0's floor ((2 k - shift) h is cell k's): a SURF
     *             cell's altitude, k + its share of rock, roughened by up to 1/64 so that no two are level.
     *             Any other cell's floor
     *   receiver  uint, a cell: where it drains to in the end, passes included. OUT and SOLID cells, and pits
     *             of DEAD cavities, have themselves. From every other cell that is not DEAD the receivers lead
     *             to an OUT cell without a cycle */
    struct gpu_buffer *tag, *z, *receiver;

    /* The rest is for water's own files and kernels: columns as bits, spans of empty cells with the SURF cell
     * or ground below them (nodes), basins. Node n_nodes and basin n_basins stand for outside. */
    int voxels[3];
    unsigned walls; /* of the domain, WALL_* of shared/params.h: no water passes there */
    size_t columns, words, n_nodes, n_basins, nodes_max;
    uint32_t random, leak;
    struct gpu_buffer *rows;                      /* uint: a bit a cell, in words along x; NULL: voxels */
    struct gpu_buffer *occupied, *floors, *first; /* uint [columns * words + 1] */
    struct gpu_buffer *node[WATER_NODE_ARRAYS];   /* uint [nodes_max + 1] */
    struct gpu_buffer *pass;                      /* uint [4 nodes_max] */
    struct gpu_buffer *source, *entry;            /* uint [4 n_sources], [2 n_sources] */
    size_t n_sources;
    uint32_t rain_units;           /* that fall on a voxel's column */
    double rain_unit, spring_unit; /* m3/yr: of node[WATER_RAIN] and node[WATER_SPRING] */
    /* Of streams, where size is 1:
     *   shares   uint [2 nodes_max]: how a span's rain is split between four, whose numbers are in `pass` after the discharge
     *   heading  uint [2 nodes_max]: the way of its rain and of its springs
     *   stream   vec4 [nodes_max]: radius in cells, 1 / weights of what it is spread over, m3/yr of rain, of springs
     *   pull     vec4 [nodes_max]: Pa in the stream, and beside it; the stream's share of the floor; m3/yr within its width */
    struct gpu_buffer *shares, *heading, *stream, *pull;
    bool entered; /* sources that enter elsewhere have been told of */
};

/* The ways of crumbs: routed, but without discharge. */
struct crumbs {
    struct water ways;
};

/* Bytes on the device, for a surface as large as is usual; of cells of two voxels with what is kept of every cell. */
uint64_t water_bytes(const int voxels[3], int size);

/* E_USAGE: a source's first point is outside the domain. */
MUST_USE status water_create(struct gpu *gpu, const struct job *job, const int voxels[3], double h, int size,
                             struct water *out);
void water_destroy(struct gpu *gpu, struct water *w);

MUST_USE status crumbs_create(struct gpu *gpu, const struct job *job, const int voxels[3], double h,
                              struct crumbs *out);
void crumbs_destroy(struct gpu *gpu, struct crumbs *c);

/* Is there rain or a source in this frame? In any? */
bool water_flows(const struct job *job, int frame);
bool water_ever_flows(const struct job *job);

struct water_routing {
    uint32_t seed;
    int frame, step; /* of erosion within the frame */
    bool leak;       /* rain.leak */
    bool unshifted;  /* shift 0, for comparisons */
    bool cells;      /* fill tag, z and receiver, too */
};

/* Receivers for the particles as they are indexed now. Waits. E_MEMORY: the surface outgrew the device. */
MUST_USE status water_route(struct gpu *gpu, struct gpu_work *work, struct water *w,
                            const struct water_routing *how, struct particles *p);

/* The grid's shift and the hash from which a routing takes its random numbers. */
uint32_t water_random(const struct water_routing *how, int shift[3]);

/* The discharge of rain and sources by the last routing, and how it pulls on the floors (size 1). Rain is counted in parts of
 * what falls on a voxel's column and sources in integer shares of their sum, each in its own unit, so that sums are exact: what
 * falls and springs leaves. Sources are rounded to 2^-31 of their sum but not to 0. Waits. */
MUST_USE status water_discharge(struct gpu *gpu, struct gpu_work *work, struct water *w,
                                const struct job *job, int frame, const struct particles *p);

/* The field `discharge` (m3/yr): what runs within the water's width; 0 inside the rock and on ceilings. For the surface of the
 * shape that was routed. Records only. */
void water_show(struct gpu *gpu, struct water *w, struct particles *p);

/* Marks the crumbs' cells (WATER_SWEPT, in tag) in which water pulls harder than deposition.carry_Pa. For the surface of the shape
 * that was routed, both times. Records only. */
void water_sweep(struct gpu *gpu, struct water *w, const struct job *job, struct particles *p,
                 struct crumbs *crumbs);

/* intensity[i] += F of the surface's particle i (float, in the order of p->surface; eq. 14), and water's share goes
 * into parts[i] as erosion.h has it, and `layers`. Each column's floor falls by F times its erodibility, whatever the area of its
 * bare faces. slopes[i], 0 before, becomes the 1/kyr at which its fall would change for each part of it that its height does. For
 * the surface, normals and erodibility of the shape that was routed. Records only. */
void water_erode(struct gpu *gpu, struct water *w, const struct job *job, int frame, struct particles *p,
                 struct gpu_buffer *layers, struct gpu_buffer *intensity, struct gpu_buffer *parts,
                 struct gpu_buffer *slopes);

#endif
