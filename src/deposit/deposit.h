/* Where eroded rock comes to rest (Arenite section 7).
 *
 * Crumbs     are particles of which erosion left nothing; deposits with nothing below them; and deposits on ground
 *            that has become too steep around them: those slide on, one of a routing cell in a landing. The model lands them again,
 *            on a new routing, until none slides. Wind takes nothing of deposits, so that what has come to rest stays until
 *            water takes it up (erosion/weather, above deposition.carry_Pa), or something near it changes.
 * Dust       As many crumbs of rock as deposition.fines and bulking say, by a hash of their ids, leave with the wind: a particle
 *            stands for a voxel, of rock or of the looser deposits.
 * Way        From where it broke off from cell to cell, to one of the lower cells beside it, by a hash of the crumb's id and as
 *            likely as it is lower now, to the first where there is room; if that is far, along the routing's receivers
 *            (pointer doubling). Out of the domain: the crumb has left.
 * Room       A cell takes crumbs while its ground is not steeper than deposition.repose_deg, by the gradient of
 *            the heights of the columns around it, and no spike (deposit/slope.glsl). So cones come out round
 *            and at that angle.
 * Rounds     Where more crumbs come to a cell than it takes, the others set out again in the next round, over the ground as it
 *            has risen: a heap does not depend on how many come at once, and so not on the step. After the last round what slid
 *            stays where it was, and the rest waits for the next landing.
 * Landing    In a free voxel on top of a column, one particle a voxel, jittered in it. A deposit has phase 1,
 *            keeps its id and layer, and fills its voxel (viability 1).
 *            deposition.viability, the paper's lower initial b, says how easily water takes it up: its rate_factor is
 *            divided by that when it first lands. Deposits never interlock (erosion/interlock). Of plants that it buries,
 *            a share comes through, by its thickness.
 * Surface    of a heap: shown smooth, and no steeper than repose (field/field.h).
 * Same bits  Crumbs of a cell are ordered by id; all else is gathers and integer sums.
 */
#ifndef HOODOO_DEPOSIT_H
#define HOODOO_DEPOSIT_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "particles/particles.h"

/* Where things flow to: cells of 2^3 voxels, voxel v in cell (v + shift) / 2, numbered (k ny + j) nx + i. */
struct deposit_routing {
    int cells[3], shift[3];
    struct gpu_buffer
        *tag; /* uint: kind and flags, WATER_* in params.h; none lands where WATER_SWEPT is set */
    struct gpu_buffer *receiver; /* uint: a cell; without cycles. Its end is an OUT cell, or itself */
};

struct deposit {
    struct gpu_buffer *bits;            /* uint [nx ny words]: solid voxels, 32 of a column to a word */
    struct gpu_buffer *room, *ground;   /* uint [cells]: how many may land; the cells of the ground */
    struct gpu_buffer *pointer, *other; /* uint [cells] */
    struct gpu_buffer *start, *taken;   /* uint [cells + 2]: the sort of crumbs by cell */
    size_t n_cells, n_ground, n_crumbs_max;
    struct gpu_buffer *id, *cell, *place, *key; /* uint [n_crumbs_max]: by crumb */
    struct gpu_buffer *order, *unordered;
};

/* What happened to the crumbs of a step: those of rock and of deposits that eroded or slid together. */
struct deposit_counts {
    uint32_t crumbs, slid, landed, left, waiting, rounds;
};

/* Does the job ever deposit anything? If not, deposit_create() need not be called. */
bool deposit_wanted(const struct job *job);

/* The share of eroded rock that comes to rest, by volume: less the fines, which the wind carries off, but looser. At most 1
 * (job/check.c). */
double deposit_bulk(const struct job *job);

uint64_t deposit_bytes(const int voxels[3]);
MUST_USE status deposit_create(struct gpu *gpu, const int voxels[3], struct deposit *out);
void deposit_destroy(struct gpu *gpu, struct deposit *d);

/* After erosion took viability and before the particles are indexed: moves crumbs to where they come to rest.
 * What leaves keeps a viability of 0, what waits a negative one. `p` is as it was indexed before the step, and the routing is
 * of the same shape; if there were any crumbs, particles_index() must follow, or particles_index_waiting() while any wait.
 * `last`: none is to wait, and all come to rest where they can or leave. `step`: of the frame. Waits. E_MEMORY. */
MUST_USE status deposit_land(struct gpu *gpu, struct gpu_work *work, struct deposit *d, const struct job *job,
                             int frame, int step, const struct deposit_routing *routing, struct particles *p,
                             bool last, struct deposit_counts *out);

/* How many of the particles are deposits. Waits. */
MUST_USE status deposit_count(struct gpu *gpu, struct gpu_work *work, const struct particles *p,
                              uint32_t *n_deposits);

#endif
