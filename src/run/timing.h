/* log/timing.jsonl: where a run's time went. Each run that simulates appends one line of JSON: version, commit, device, driver, the
 * time it ended (UTC), the first and last frame simulated, elapsed seconds, and device seconds and dispatches by stage.
 *
 * Times are kept out of the manifests, which are identical for identical jobs.
 */
#ifndef HOODOO_TIMING_H
#define HOODOO_TIMING_H

#include "gpu/gpu.h"

/* Logs the device times and appends the line. `started` is from clock_seconds(). Errors are only logged, since the frames are
 * already written. */
void timing_write(const char *root, const struct gpu *gpu, int first, int last, double started);

#endif
