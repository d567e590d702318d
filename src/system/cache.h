/* The folders for cached data (HOODOO_CACHE, or hoodoo in XDG_CACHE_HOME, or ~/.cache/hoodoo) and for temporary files (HOODOO_TMP, or
 * TMPDIR, or /tmp). */
#ifndef HOODOO_CACHE_H
#define HOODOO_CACHE_H

#include <stdbool.h>

#include "base/path.h"
#include "base/status.h"

/* Returns false if none of the environment variables is set. The folder may not exist yet. */
bool cache_folder(struct path *out);

/* E_OUTPUT: the path is too long. */
MUST_USE status temporary_folder(struct path *out);

#endif
