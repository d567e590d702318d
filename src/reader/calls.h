/* A seccomp filter that allows only the system calls that reading a file needs. */
#ifndef HOODOO_READER_CALLS_H
#define HOODOO_READER_CALLS_H

#include <stdbool.h>

#include "base/status.h"

/* Installs the filter for the rest of this process: all other system calls fail with EPERM. `executes`: the process will execute
 * another program, which needs a few more calls. E_INPUT: the kernel does not support filters. */
MUST_USE status calls_limit(bool executes);

#endif
