/* log/timing.jsonl: where a run's time went, and log/frames.jsonl: how long each frame took.
 *
 * timing.jsonl   Each run that simulates appends one line of JSON: version, commit, device, driver, the
 * time it ended (UTC), the first and last frame simulated, elapsed seconds, and device seconds and dispatches by stage.
 *
 * frames.jsonl   A line for each frame when it is complete: {"frame": 1001, "seconds": 1.25}, by a clock that nobody sets.
 *
 * Times are kept out of the manifests, which are identical for identical jobs.
 */
#ifndef HOODOO_TIMING_H
#define HOODOO_TIMING_H

#include "gpu/gpu.h"

/* Logs the device times and appends the line. `started` is from clock_seconds(). Errors are only logged, since the frames are
 * already written. */
void timing_write(const char *root, const struct gpu *gpu, int first, int last, double started);

/* Appends a line to frames.jsonl. Errors are only logged. */
void timing_add_frame(const char *root, int frame, double seconds);

/* *seconds: the median of the last frames, so that a pause among them has no effect; 0 if fewer than three are known. E_MEMORY. */
MUST_USE status timing_frame_seconds(const char *root, double *seconds);

#endif
