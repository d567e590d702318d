/* The numbers of the frames that looks have simulated, for curves. They are identified by the hashes of job_frame_hashes(), as cached states
 * are, and each state carries those of all frames before it (a section of its checkpoint). */
#ifndef HOODOO_LOOK_HISTORY_H
#define HOODOO_LOOK_HISTORY_H

#include "checkpoint/checkpoint.h"
#include "particles/frame.h"
#include "text/text.h"

struct history_item {
    uint64_t hash;
    double years, volume_m3, start_volume_m3, max_stress_Pa, change_m3[PROCESSES];
    struct ledger ledger;
};

struct history {
    struct history_item *item;
    size_t n, capacity, last; /* `last`: the one that was found last; searches begin there */
};

bool history_has(struct history *h, uint64_t hash);

/* Notes the numbers of a frame (model_measure()). E_MEMORY. */
MUST_USE status history_note(struct history *h, uint64_t hash, const struct frame *frame);

/* Adds what is known of n frames to a state, and takes over what a state carries. E_MEMORY. */
MUST_USE status history_give(struct history *h, const uint64_t *hash, size_t n, struct checkpoint *state);
MUST_USE status history_take(struct history *h, const struct checkpoint *state);

/* Adds the report's curves (page_curves()) as members to a JSON object, over those of the job's frames that are known; none if fewer than two
 * are. `hash`: of all its frames. `mark`: a frame that they mark. E_MEMORY. */
MUST_USE status history_curves(struct history *h, struct job *job, const uint64_t *hash, int mark,
                               struct text *json);

void history_free(struct history *h);

#endif
