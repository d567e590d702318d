/* Deposition: where eroded rock comes to rest (Arenite section 7). README.md has the steps and what differs from the paper.
 *
 * Fragments  Particles whose viability is used up; deposits with nothing below them; and deposits on ground that has become too
 *            steep, which slide, at most one per routing cell and landing. The model repeats the landing on a new routing until
 *            hardly any slide. Wind does not erode deposits, so that they stay until water takes them up (erosion/weather, above
 *            deposition.carry_Pa) or something near them changes.
 * Dust       A share of the fragments of rock, given by deposition.fines and bulking and chosen by a hash of their ids, leaves
 *            with the wind: a particle stands for a full voxel, of rock or of the looser deposits.
 * Path       From where it broke off from cell to cell, to one of the lower cells beside, chosen by a hash of its id with
 *            probability proportional to the drop, to the first cell that accepts it; after 64 cells, along the routing's
 *            receivers (pointer jumping). A fragment that reaches an outlet has left the domain.
 * Room       A cell accepts fragments while its ground, by the gradient of the column heights around it, is not steeper than
 *            deposition.repose_deg and has no spike (deposit/slope.glsl). So heaps become round cones at that angle.
 * Rounds     Where more fragments reach a cell than it accepts, the rest try again in the next round, over the risen ground: a
 *            heap does not depend on how many arrive at once, hence not on the time step. After the last round those that slid
 *            stay where they were, and the rest waits for the next landing.
 * Landing    In a free voxel on top of a column, one particle per voxel, jittered. A deposit has phase 1, keeps its id and layer
 *            and fills its voxel (viability 1). deposition.viability, the paper's lower initial b, tells how well it withstands
 *            water: its rate_factor is divided by it when it first lands. Deposits never interlock (erosion/interlock). Plants
 *            that it buries grow through it by a share that falls with its thickness.
 * Surface    The surface of a heap is drawn smooth and no steeper than repose (field/field.h).
 * Determinism  Fragments of a cell are ordered by id; everything else is gathers and integer sums.
 */
#ifndef HOODOO_DEPOSIT_H
#define HOODOO_DEPOSIT_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "particles/particles.h"

/* Routing of fragments: cells of 2^3 voxels, voxel v in cell (v + shift) / 2, numbered (k ny + j) nx + i. Borrowed buffers. */
struct deposit_routing {
    int cells[3], shift[3];
    struct gpu_buffer *tag; /* uint: kind and flags WATER_* of params.h; WATER_SWEPT: nothing lands here */
    struct gpu_buffer
        *receiver; /* uint, a cell; without cycles, ending in an OUT cell or one that is its own receiver */
};

struct deposit {
    struct gpu_buffer *bits; /* uint [nx ny words]: solid voxels, 32 of a column to a word */
    struct gpu_buffer *room,
        *ground; /* uint [cells]: how many fragments a cell accepts; list of the ground cells */
    struct gpu_buffer *pointer, *other; /* uint [cells]: deposition pointers, and scratch */
    struct gpu_buffer *start, *taken;   /* uint [cells + 2]: sort of fragments by cell */
    size_t n_cells, n_ground, n_fragments_max;
    struct gpu_buffer *id, *cell, *place, *key; /* uint [n_fragments_max], by fragment */
    struct gpu_buffer *order, *unordered;
};

/* Result of a landing: fragments in all (eroded, unsupported or sliding); those that slid; those that landed, left the domain,
 * or wait; and rounds. */
struct deposit_counts {
    uint32_t fragments, slid, landed, left, waiting, rounds;
};

/* Whether the job ever deposits anything. If not, deposit_create() need not be called. */
bool deposit_wanted(const struct job *job);

/* Share of eroded rock that comes to rest, by volume: (1 - fines) bulking, at most 1 (job/check.c). */
double deposit_bulk(const struct job *job);

uint64_t deposit_bytes(const int voxels[3]);
MUST_USE status deposit_create(struct gpu *gpu, const int voxels[3], struct deposit *out);
void deposit_destroy(struct gpu *gpu, struct deposit *d);

/* One landing, after erosion and before the particles are indexed again: moves fragments to where they come to rest. Those that
 * leave have viability 0 afterwards, those that wait a negative one. `p` is indexed as before the step and the routing is of the
 * same shape. If out->fragments > 0, particles_index() must follow, or particles_index_waiting() if any wait. `last`: none may
 * wait; all land where they can or leave. `step`: of the frame, for random numbers. Waits for the device. E_MEMORY. */
MUST_USE status deposit_land(struct gpu *gpu, struct gpu_work *work, struct deposit *d, const struct job *job,
                             int frame, int step, const struct deposit_routing *routing, struct particles *p,
                             bool last, struct deposit_counts *out);

/* Counts the particles that are deposits. Waits for the device. */
MUST_USE status deposit_count(struct gpu *gpu, struct gpu_work *work, const struct particles *p,
                              uint32_t *n_deposits);

#endif
