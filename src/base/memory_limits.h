/* What memory.h's memory_available() looks at: the least of what MemAvailable, the limits of the process's control
 * groups (version 1 and 2, and all that they are in) and its own (ulimit -v, -d) leave. What the page cache holds
 * counts as free. */
#ifndef HOODOO_MEMORY_LIMITS_H
#define HOODOO_MEMORY_LIMITS_H

#include <stddef.h>

/* memory_available() of a machine whose files are below `root`, which stands before every path that is read; SIZE_MAX
 * if nothing says a limit. For tests; "" is this machine. */
size_t memory_available_below(const char *root);

/* What this process holds of it now, its libraries included, in bytes; 0 if nothing says so. */
size_t memory_resident(void);

#endif
