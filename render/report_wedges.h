/* The report of a farm's folder: its wedges side by side. */
#ifndef HOODOO_REPORT_WEDGES_H
#define HOODOO_REPORT_WEDGES_H

#include <stdbool.h>

#include "base/text.h"

/* Is `root` the folder of a job with wedges (farm/job.yaml, no run of its own)? */
bool report_has_wedges(const char *root);

/* Each wedge's values, frames, rock left and ledger, their volumes over time in one chart, the stills of their
 * last frames (copied into root/report) and links to their own reports. Wedges that have not begun are listed as
 * such; *sound: at least one has a frame. E_INPUT, E_USAGE: farm/job.yaml cannot be read. */
MUST_USE status report_wedges(const char *root, struct text *page, bool *sound);

#endif
