/* Whether this process may have threads enough. Drivers and OpenMP's library end the process, or wait for ever, where the system refuses them
 * a thread (ulimit -u, the pids limit of a cgroup), so that is found out before. */
#ifndef HOODOO_THREADS_H
#define HOODOO_THREADS_H

#include "base/status.h"

/* E_MEMORY: the system does not allow n more threads. They are started and ended again. */
MUST_USE status threads_check(int n);

#endif
