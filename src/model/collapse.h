/* Falling rock, between the model and its material points: which particles move, for how long, and what they are
 * afterwards. */
#ifndef HOODOO_COLLAPSE_H
#define HOODOO_COLLAPSE_H

#include "base/idset.h"
#include "blocks/blocks.h"
#include "checkpoint/checkpoint.h"
#include "job/job.h"
#include "mpm/mpm.h"
#include "particles/frame.h"

struct collapse {
    bool shot;  /* everything moves, in real time; else blocks fall within a frame */
    bool falls; /* blocks fall instead of vanishing */
    struct mpm mpm;
    struct gpu_buffer *table; /* uint [ids]: scratch */
    double longest;           /* s */
    double rubble;            /* m: the smallest block that stays one */
    size_t least;             /* particles: smaller blocks crumble instead of falling */
};

/* Is it a shot in real time? */
bool collapse_shot(const struct job *job);

/* Whether the job needs any of this. */
bool collapse_wanted(const struct job *job);

/* What a shot adds to a checkpoint. */
uint64_t collapse_checkpoint_bytes(const struct job *job, size_t n);

uint64_t collapse_bytes(const struct job *job, size_t n, const int voxels[3]);
MUST_USE status collapse_create(struct gpu *gpu, const struct job *job, struct particles *p,
                                struct collapse *out);
void collapse_destroy(struct gpu *gpu, struct collapse *c);

/* A shot's start: all of p, at rest. */
MUST_USE status collapse_load(struct gpu *gpu, struct collapse *c, struct particles *p);

/* A shot's frame. p is indexed after it; the ledger's `fallen` grows and shrinks with what is in the air. Waits.
 */
MUST_USE status collapse_frame(struct gpu *gpu, struct gpu_work *work, struct collapse *c, double seconds,
                               struct particles *p, struct ledger *ledger);

/* Rock, deposit and, as fallen, falling blocks and rubble by phase; with what has been taken out before. Waits. */
MUST_USE status collapse_count(struct gpu *gpu, const struct particles *p, struct ledger *ledger);

/* Of what nothing holds, blocks smaller than rubble is, or than material points can show, crumble: their viability is
 * taken and their particles are counted, to be moved or taken out with what eroded. *n_loose are those of larger blocks,
 * which collapse_blocks() lets fall once p is indexed. Waits. */
MUST_USE status collapse_crumble(struct gpu *gpu, struct gpu_work *work, const struct collapse *c,
                                 struct blocks *b, struct particles *p, uint32_t *n_crumbs, size_t *n_loose);

/* Blocks that nothing holds fall until they rest on ground and rock: p is indexed after it. Large fragments are
 * rubble then, small ones and grains deposit; what left the domain, what crumbles, and crumbs that rest without
 * touching what stands, leave. Waits. */
MUST_USE status collapse_blocks(struct gpu *gpu, struct gpu_work *work, struct collapse *c, struct blocks *b,
                                struct particles *p, struct ledger *ledger);

/* The shot's state, as sections of a checkpoint. `ids` are those of p's particles, and are taken out of the set. */
MUST_USE status collapse_save(struct gpu *gpu, const struct collapse *c, struct checkpoint *out);
MUST_USE status collapse_restore(struct gpu *gpu, struct collapse *c, struct particles *p,
                                 const struct checkpoint *from, struct idset *ids);

#endif
