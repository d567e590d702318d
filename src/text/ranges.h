/* Frame ranges as written in jobs and after --frames: "1001", "1001-1110", "1001-1110x2", "1001-1110:2". */
#ifndef HOODOO_RANGES_H
#define HOODOO_RANGES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

struct frame_range {
    int first, last; /* inclusive; first <= last, and last is a multiple of step from first */
    int step;        /* >= 1 */
};

/* Parses a range of frames within -999999..9999999. E_USAGE describes what is wrong with `text`; the caller should add its
 * place. */
MUST_USE status range_parse(const char *text, struct frame_range *out);

/* "1001-1110x2" in `out`; returns out. */
const char *range_text(struct frame_range r, char out[48]);

size_t range_count(struct frame_range r);
bool range_holds(struct frame_range r, int frame);

#endif
