/* A lock file that admits one writer at a time, also across machines on NFS, and that recovers from crashes.
 *
 * The file identifies its holder (host, boot, process, start time of the process) and contains a counter, the heartbeat, that
 * the holder increments every few seconds. It is created under another name and linked into place, which is atomic on NFS
 * too. On a disk without hard links (exFAT, SMB, object stores) it is created under its own name by O_EXCL; until its content is there,
 * others take it for the lock of an unknown holder and watch it.
 *
 * Stale locks   The lock of a holder on this machine is stale when its process has ended. The lock of a holder elsewhere, or of
 *               one that this machine hides (/proc with hidepid), is stale when its heartbeat stops while it is watched. Clocks
 *               of machines are never compared. A stale lock is taken over, with a warning in the log.
 * Lost locks    A holder that was suspended for a long time may find that its lock was taken over; lock_check() then fails. After
 *               the time of two heartbeats it reads the file first; time counts while the machine sleeps, too.
 */
#ifndef HOODOO_LOCK_H
#define HOODOO_LOCK_H
#include <stdbool.h>

#include "base/status.h"

struct lock;

struct lock_patience {
    double heartbeat_s; /* interval of the heartbeat; 0: 5 s */
    double watch_s;     /* how long a lock from elsewhere is watched; 0: 30 s */
};

/* Takes the lock `path`. `what` describes the holder in messages of others, such as "simulates frames 1001-1050". E_OUTPUT: another
 * process holds it; the message names it. STOPPED: `stop` (or NULL) returned true while waiting. */
MUST_USE status lock_take(const char *path, const char *what, struct lock_patience patience,
                          bool (*stop)(void), struct lock **out);

/* E_OUTPUT if another process took the lock over, or if that cannot be told. Call it before each write that matters, from any thread; it
 * is cheap. */
MUST_USE status lock_check(struct lock *lock);

/* Removes the lock if it was left behind by a process of this machine. */
void lock_sweep(const char *path);

/* Removes the lock if this process still holds it, and sets *lock to NULL. No effect if *lock is NULL. */
void lock_release(struct lock **lock);

#endif
