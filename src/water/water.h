/* Water over rock in three dimensions: flow routing, discharge and fluvial erosion (Arenite section 6, eqs. 13 and 14; the
 * routing follows FastFlow, Jain et al. 2024). README.md has the equations and the order of the steps.
 *
 * Cells      Voxels; or, for the paths of fragments, cubes of 2 x 2 x 2 voxels. Numbered (k ny + j) nx + i. The cubes are on a
 *            grid that a hash of (seed, frame, step) shifts by 0 or 1 voxel on each axis, so that beds and deposits do not
 *            show it. Cells at the sides of the domain may be half outside.
 * Kinds      A cell with particles is SURF if the cell above it has none or is outside, else SOLID; a SOLID cell with an empty
 *            cell below or beside it, or with a face on an open side of the domain, is a WALL. Cells without particles are
 *            EMPTY.
 * Outlets    Water and sediment leave the domain through the cells at its four sides and through empty cells
 *            on the bare ground (k = 0). Sides that are walls pass nothing.
 * Receivers  EMPTY drains onto the SURF cell at the bottom of its run of empty cells (or out, on the ground).
 *            SURF drains to one of the four lower floors beside it (the SURF cell there, or that below the empty cells there),
 *            chosen in proportion to the drop: by turns for water, by a hash for fragments. If there is none it is a pit. With
 *            `leak` it drains first of all into an empty cell below it. A WALL drains to an empty cell below or beside it; it
 *            carries no water, only fragments. A receiver is the SURF cell or outlet at the end of a fall, which may be far.
 * Pits       overflow across the lowest pass: the passes taken are the minimum spanning tree of the basins,
 *            in the total order (higher altitude of its two ends, edge number), and the receivers from each
 *            basin's pass down to its pit are reversed. So the highest altitude on each cell's path out is the lowest
 *            possible, and the result does not depend on the order of threads.
 * Cavities   Cells without a path out are DEAD. Their receivers stay within the cavity and end in a pit.
 * Discharge  The water of springs follows the receivers. Rain is split between all floors beside it with a lower water level, in
 *            proportion to the drop, as a sheet that runs along the gradient: its discharge per metre of contour does not
 *            depend on the cells. In pits, up to the pass, it follows the receivers too.
 * Streams    Discharge is spread over the width of a stream, W = width_m Q^width_power and at least least_width_m, as far as the
 *            ground beside it is no steeper than a bank; several streams add up. Where a spring's stream is narrower than the
 *            cells, its shear stress is that of the narrow stream, on its share of the floor. Its slope is measured from the
 *            water level abreast to the level downstream, within half of slope_m.
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
    WATER_Z,         /* altitude of its floor */
    WATER_LEVEL,     /* of its water: the floor's, or in a pit that of the highest pass on its path out */
    WATER_INITIAL,   /* receiver, a node, before depressions are routed */
    WATER_FINAL,     /* and after */
    WATER_BASIN,     /* number of the pit that it drains to by initial receivers */
    WATER_COMPONENT, /* by basin: n_basins if it drains out of the domain */
    WATER_RAIN,      /* discharge of rain, in rain_unit */
    WATER_SPRING,    /* discharge of springs, in spring_unit */
    WATER_DROP,      /* float, m: drop to the floors downstream from which the slope is measured */
    WATER_FROM,      /* by basin: the pass it overflows, from node */
    WATER_TO,        /* to node */
    WATER_LOWEST,    /* by component, scratch of the joining */
    WATER_PICK,
    WATER_NEXT,
    WATER_SCRATCH,
    WATER_NODE_ARRAYS = WATER_SCRATCH + 4
};

struct water {
    int size; /* voxels along a cell's side: 1, or 2 for fragments */

    /* Of the last routing: voxels / size, one more on shifted axes. Voxel v is in cell (v + shift) / size. */
    int cells[3], shift[3];

    /* By cell; created by the first routing with `cells` set, and filled by each such routing:
     *   tag       uint: WATER_EMPTY, _SURF, _WALL or _SOLID (tag & WATER_KIND), and the flags WATER_OUT (an outlet of the
     *             domain), WATER_DEAD and, after water_sweep(), WATER_SWEPT (params.h)
     *   z         uint, 2^16 per cell height from the floor of cell 0, where cell k's floor is at (2 k - shift) h: of a SURF
     *             cell its altitude, k + its share of rock + a roughness of up to 1/64; of others the cell's floor
     *   receiver  uint, a cell: the final receiver, across passes. OUT and SOLID cells, and pits of DEAD cavities, are their
     *             own receivers. From every other cell that is not DEAD the receivers lead to an OUT cell without a cycle */
    struct gpu_buffer *tag, *z, *receiver;

    /* Internal to this folder and its kernels: columns as bits; nodes, each a span of empty cells with the SURF cell or ground
     * below it; basins. Node n_nodes and basin n_basins stand for the outside. */
    int voxels[3];
    unsigned walls; /* WALL_* of shared/params.h: sides of the domain that no water passes */
    size_t columns, words, n_nodes, n_basins, nodes_max;
    uint32_t random, leak;
    struct gpu_buffer *rows; /* uint: a bit per cell, in words along x; NULL if size is 1 */
    struct gpu_buffer *occupied, *floors, *first; /* uint [columns * words + 1] */
    struct gpu_buffer *node[WATER_NODE_ARRAYS];   /* uint [nodes_max + 1] */
    struct gpu_buffer *pass;                      /* uint [4 nodes_max] */
    struct gpu_buffer *source, *entry;            /* uint [4 n_sources], [2 n_sources] */
    size_t n_sources;
    uint32_t rain_units;           /* of rain on one column of voxels */
    double rain_unit, spring_unit; /* m3/yr: units of node[WATER_RAIN] and node[WATER_SPRING] */
    /* Streams, only if size is 1:
     *   shares   uint [2 nodes_max]: how a span's rain is split between four nodes, which `pass` lists after the discharge
     *   heading  uint [2 nodes_max]: directions of its rain and of its springs
     *   stream   vec4 [nodes_max]: radius in cells, 1 / sum of weights over it, m3/yr of rain, m3/yr of springs
     *   pull     vec4 [nodes_max]: shear stress in Pa in the stream and beside it; the stream's share of the floor; m3/yr
     *            within its width */
    struct gpu_buffer *shares, *heading, *stream, *pull;
    bool entered; /* the user has been warned of sources that enter elsewhere */
};

/* Routing for fragments: a type of its own, since it has no discharge. */
struct fragments {
    struct water routing;
};

/* Bytes on the device for a surface of usual size; with size 2 they include tag, z and receiver. */
uint64_t water_bytes(const int voxels[3], int size);

/* E_USAGE: the first point of a source is outside the domain, or it has no points. */
MUST_USE status water_create(struct gpu *gpu, const struct job *job, const int voxels[3], double h, int size,
                             struct water *out);
void water_destroy(struct gpu *gpu, struct water *w);

MUST_USE status fragments_create(struct gpu *gpu, const struct job *job, const int voxels[3], double h,
                                 struct fragments *out);
void fragments_destroy(struct gpu *gpu, struct fragments *c);

/* Whether there is rain or a source in this frame, or in any frame. */
bool water_flows(const struct job *job, int frame);
bool water_ever_flows(const struct job *job);

struct water_routing {
    uint32_t seed;
    int frame, step; /* step: of erosion within the frame */
    bool leak;       /* rain.leak */
    bool unshifted;  /* shift 0, for tests */
    bool cells;      /* also fill tag, z and receiver */
};

/* Computes receivers for the particles as currently indexed. Waits for the device. E_MEMORY: no memory for this surface. */
MUST_USE status water_route(struct gpu *gpu, struct gpu_work *work, struct water *w,
                            const struct water_routing *how, struct particles *p);

/* Returns the hash that seeds a routing's random numbers, and sets the grid's shift. */
uint32_t water_random(const struct water_routing *how, int shift[3]);

/* Discharge of rain and sources along the last routing, and its shear stress on the floors (size 1 only). Rain is counted in
 * fractions of what falls on a column of voxels and sources in fractions of their sum, each as integers in its own unit, so that
 * sums are exact: as much leaves as enters. Sources are rounded to 2^-31 of their sum but not to 0. Waits for the device. */
MUST_USE status water_discharge(struct gpu *gpu, struct gpu_work *work, struct water *w,
                                const struct job *job, int frame, const struct particles *p);

/* Fills the field `discharge` (m3/yr): discharge within the stream's width; 0 inside the rock and on ceilings. The surface must
 * be that of the routed shape. Records only. */
void water_show(struct gpu *gpu, struct water *w, struct particles *p);

/* Sets WATER_SWEPT in the tag of the fragments' cells in which the shear stress exceeds deposition.carry_Pa. Both routings and
 * the surface must be of the same shape. Records only. */
void water_sweep(struct gpu *gpu, struct water *w, const struct job *job, struct particles *p,
                 struct fragments *fragments);

/* Adds F of eq. 14 to intensity[i] of surface particle i (float [n_surface], in the order of p->surface) and its share to
 * parts[i]; both and `layers` as in erosion.h. Each column's floor sinks by F times its erodibility, whatever the area of its
 * bare faces. slopes[i], 0 before the call, becomes the rate, 1/kyr, at which its drop to the floors downstream changes relative
 * to itself (erosion_pace()). Needs surface, normals and erodibility of the routed shape. Records only. */
void water_erode(struct gpu *gpu, struct water *w, const struct job *job, int frame, struct particles *p,
                 struct gpu_buffer *layers, struct gpu_buffer *intensity, struct gpu_buffer *parts,
                 struct gpu_buffer *slopes);

#endif
