/* Where a run's time went: log/timing.jsonl, one line of JSON for each time a run was at work.
 *
 * Kept out of manifests, which are the same for the same job. A line: version, device, driver, when it ended
 * (UTC), the first and last frame it simulated, wall seconds, and device seconds and dispatches by stage.
 */
#ifndef HOODOO_TIMING_H
#define HOODOO_TIMING_H

#include "gpu/gpu.h"

/* Notes the device times in the log and adds the line. `started` is from clock_seconds(). Never fails: a run
 * whose frames are written is done, whatever becomes of this; what goes wrong is noted in the log. */
void timing_write(const char *root, const struct gpu *gpu, int first, int last, double started);

#endif
