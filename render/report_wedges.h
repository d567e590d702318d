/* The report on a folder of wedges: their values and results side by side. */
#ifndef HOODOO_REPORT_WEDGES_H
#define HOODOO_REPORT_WEDGES_H

#include <stdbool.h>

#include "text/text.h"

/* *page: for each wedge its values, frames, share of rock left and ledger, a link to its report, and the still of its last frame (copied
 * into root/report); and the volumes of all wedges over time in one chart. Wedges that have not begun are listed as such. *sound: at least
 * one wedge has a sound frame. E_INPUT, E_USAGE: farm/job.yaml cannot be read. E_OUTPUT. E_MEMORY. */
MUST_USE status report_wedges(const char *root, struct text *page, bool *sound);

#endif
