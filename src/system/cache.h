/* The folder for cached data: HOODOO_CACHE, or hoodoo in XDG_CACHE_HOME, or ~/.cache/hoodoo. */
#ifndef HOODOO_CACHE_H
#define HOODOO_CACHE_H

#include <stdbool.h>

#include "base/path.h"

/* Returns false if none of the environment variables is set. The folder may not exist yet. */
bool cache_folder(struct path *out);

#endif
