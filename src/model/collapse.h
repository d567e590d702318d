/* Falling rock: which particles move as material points (src/mpm), for how long, and what becomes of them. */
#ifndef HOODOO_COLLAPSE_H
#define HOODOO_COLLAPSE_H

#include "base/idset.h"
#include "blocks/blocks.h"
#include "checkpoint/checkpoint.h"
#include "job/job.h"
#include "mpm/mpm.h"
#include "particles/frame.h"

struct collapse {
    bool shot;  /* a shot in real time: all rock may move; otherwise blocks fall within a frame of years */
    bool falls; /* unsupported blocks fall; otherwise they are removed */
    struct mpm mpm;
    struct gpu_buffer *table; /* uint [ids]: scratch */
    double longest;           /* s: the longest fall within a frame */
    double rubble;            /* m: size of the smallest block that remains a block */
    size_t least;             /* particles: smaller blocks crumble instead of falling */
};

/* Whether the job is a shot in real time. */
bool collapse_shot(const struct job *job);

/* Whether the job needs any of this. */
bool collapse_wanted(const struct job *job);

/* Bytes that a shot adds to a checkpoint. */
uint64_t collapse_checkpoint_bytes(const struct job *job, size_t n);

uint64_t collapse_bytes(const struct job *job, size_t n, const int voxels[3]);
MUST_USE status collapse_create(struct gpu *gpu, const struct job *job, struct particles *p,
                                struct collapse *out);
void collapse_destroy(struct gpu *gpu, struct collapse *c);

/* Starts a shot with all particles of p at rest. */
MUST_USE status collapse_load(struct gpu *gpu, struct collapse *c, struct particles *p);

/* Simulates one frame of a shot. Leaves p indexed. The ledger's `fallen` counts what is in the air. Waits. */
MUST_USE status collapse_frame(struct gpu *gpu, struct gpu_work *work, struct collapse *c, double seconds,
                               struct particles *p, struct ledger *ledger);

/* Counts particles by phase into the ledger: rock, deposit, and as `fallen` the falling blocks and rubble, in addition to what was removed
 * before. Waits. */
MUST_USE status collapse_count(struct gpu *gpu, const struct particles *p, struct ledger *ledger);

/* Unsupported blocks that are smaller than `rubble`, or too small for material points, crumble: the viability of their particles becomes
 * 0, and *n_fragments counts them, so that the caller deposits or removes them with the eroded particles. *n_loose counts the particles of
 * larger blocks, which collapse_blocks() lets fall once p is indexed. Waits. */
MUST_USE status collapse_crumble(struct gpu *gpu, struct gpu_work *work, const struct collapse *c,
                                 struct blocks *b, struct particles *p, uint32_t *n_fragments,
                                 size_t *n_loose);

/* Unsupported blocks fall until they rest on ground or rock. Leaves p indexed. Large fragments become rubble, small ones and grains
 * deposit. What left the domain, what crumbles, and small fragments at rest that touch nothing supported are removed. Waits. */
MUST_USE status collapse_blocks(struct gpu *gpu, struct gpu_work *work, struct collapse *c, struct blocks *b,
                                struct particles *p, struct ledger *ledger);

/* Save and restore a shot's state as sections of a checkpoint. `ids` holds the ids of p's particles; restoring removes those that have
 * material points. */
MUST_USE status collapse_save(struct gpu *gpu, const struct collapse *c, struct checkpoint *out);
MUST_USE status collapse_restore(struct gpu *gpu, struct collapse *c, struct particles *p,
                                 const struct checkpoint *from, struct idset *ids);

#endif
