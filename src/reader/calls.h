/* The system calls that reading a file takes. */
#ifndef HOODOO_READER_CALLS_H
#define HOODOO_READER_CALLS_H

#include <stdbool.h>

#include "base/status.h"

/* From now on every other one fails with EPERM, in this process for ever. `becomes`: it will be another program, which takes a few
 * more. E_INPUT: the kernel has no filters. */
MUST_USE status calls_limit(bool becomes);

#endif
