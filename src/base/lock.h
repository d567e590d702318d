/* One writer at a time: a lock file that outlives crashes, machines and NFS.
 *
 * The file says who holds it (host, boot, process, when that process began) and holds a count that moves
 * every few seconds while its holder lives. It is made under another name and linked into place, which is
 * atomic on NFS too.
 *
 * Left behind   A holder on this machine is gone when its process is. One elsewhere, or one that this machine
 *               hides from us (/proc under hidepid), is gone when its count has not moved while we watched: no
 *               clocks are compared, and one that is set does not matter. A lock left behind is taken over,
 *               and the log says so.
 * Taken away    A holder that was frozen for long (a suspended machine) may find its lock taken over when it
 *               wakes: lock_check() then fails.
 */
#ifndef HOODOO_LOCK_H
#define HOODOO_LOCK_H
#include <stdbool.h>

#include "base/status.h"

struct lock;

struct lock_patience {
    double beat_s;  /* how often the count moves; 0: 5 s */
    double watch_s; /* how long a lock from elsewhere is watched; 0: 30 s */
};

/* Takes the lock `path` for `what` ("simulates frames 1001-1050"), a sentence others are shown. E_OUTPUT
 * names the holder: it lives. `stop`, or NULL: gives up waiting when it returns true (STOPPED). */
MUST_USE status lock_take(const char *path, const char *what, struct lock_patience patience,
                          bool (*stop)(void), struct lock **out);

/* E_OUTPUT: another process took it over. */
MUST_USE status lock_check(const struct lock *lock);

/* Removes a lock that a process of this machine left behind; any other stays. */
void lock_sweep(const char *path);

/* Removes it, if it is still ours. NULL is fine. */
void lock_release(struct lock **lock);

#endif
