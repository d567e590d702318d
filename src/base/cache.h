/* Where hoodoo keeps what it can make anew: HOODOO_CACHE, or hoodoo in XDG_CACHE_HOME, or ~/.cache/hoodoo. */
#ifndef HOODOO_CACHE_H
#define HOODOO_CACHE_H

#include <stdbool.h>

#include "base/path.h"

/* False: no variable says where. The folder need not be there. */
bool cache_folder(struct path *out);

#endif
