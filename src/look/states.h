/* A cache of states of jobs, so that a look at a changed job starts at the last frame before the change.
 *
 * Names     Hashes of everything that a state depends on: job_frame_hashes(), the build of hoodoo and the device. The name of the job is not
 *           part of them.
 * Storage   Checkpoints in the folder `look` of the cache (system/cache.h). When they exceed STATES_BYTES, the least recently used ones
 *           are removed.
 * Errors    None: a state that cannot be read counts as missing, and one that cannot be written will be simulated again. The first
 *           failure is logged.
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
    struct path folder; /* "": there is no cache */
    uint64_t salt;      /* hash of build and device */
    bool complained;
};

void states_open(const struct gpu_info *device, struct states *out);

/* Finds the last of n hashes whose state is cached. Returns its index, with the state in *out (checkpoint_free()); n: none is cached. */
size_t states_find(const struct states *s, const uint64_t *hash, size_t n, struct checkpoint *out);

/* Removes a state that turned out to be unusable. */
void states_drop(const struct states *s, uint64_t hash);

/* Is the state cached? If so, it is marked as used. */
bool states_has(const struct states *s, uint64_t hash);

/* Stores a state under the hash of its frame. */
void states_keep(struct states *s, uint64_t hash, const struct checkpoint *state);

/* Removes the least recently used states until the others take at most STATES_BYTES. */
void states_trim(const struct states *s);

#endif
