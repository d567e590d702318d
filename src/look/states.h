/* States of jobs in some of their frames, kept from look to look: a look at a job of which something has changed begins with the last
 * frame before the change.
 *
 * Named    By job_frame_hashes(), so that a state is found whatever the job is called, and only where all that it depends on is the
 *          same: the build of hoodoo and the device are in the name too.
 * Kept     As checkpoints in the folder `look` of the cache (base/cache.h), those least recently used going first when there
 *          are more than STATES_BYTES.
 * Errors   None: what cannot be read is not there, and what cannot be written is simulated again. It is said once.
 */
#ifndef HOODOO_LOOK_STATES_H
#define HOODOO_LOOK_STATES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/path.h"
#include "checkpoint/checkpoint.h"
#include "gpu/gpu.h"

enum { STATES_BYTES = 1 << 30 };

struct states {
    struct path folder; /* "": there is none */
    uint64_t salt;      /* of build and device */
    bool complained;
};

void states_open(const struct gpu_info *device, struct states *out);

/* The state of the latest of n frames that is kept: its place in `hash`, and it in *out (checkpoint_free()). n: none is. */
size_t states_find(const struct states *s, const uint64_t *hash, size_t n, struct checkpoint *out);

/* It was no good: it is removed. */
void states_drop(const struct states *s, uint64_t hash);

/* Is it kept? Then it counts as used. */
bool states_has(const struct states *s, uint64_t hash);

/* Keeps it under the hash of its frame. */
void states_keep(struct states *s, uint64_t hash, const struct checkpoint *state);

/* Removes those least recently used, until the rest is small enough. */
void states_trim(const struct states *s);

#endif
