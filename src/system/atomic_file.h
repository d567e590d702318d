/* Files that are either complete or absent.
 *
 * The bytes are written to a temporary file with a unique name beside `path`, which is synced and renamed over `path`; then the
 * folder is synced. On any error the temporary file is removed, and a file that existed at `path` is unchanged.
 */
#ifndef HOODOO_ATOMIC_FILE_H
#define HOODOO_ATOMIC_FILE_H

#include <stddef.h>

#include "base/path.h"
#include "base/status.h"
#include "system/draft.h"

/* Writes n bytes to `path`. E_OUTPUT: the message has the path, the bytes written and the system's reason. */
MUST_USE status atomic_file_write(const char *path, const void *bytes, size_t n);

/* Begins a file that is written bit by bit. End it with atomic_file_finish(), or give it up with draft_drop(), which is harmless after
 * both. E_OUTPUT. */
MUST_USE status atomic_file_begin(const char *path, struct draft *out);

/* Syncs the file and moves it into place. Drops the draft, also on an error. */
MUST_USE status atomic_file_finish(struct draft *draft);

/* From now on `check` is called before each rename of this process; if it fails, the file is not replaced and its status is returned. NULL:
 * no longer. For a run that must not write after another process took over its folder (lock.h). Not while other threads write files. */
void atomic_file_guard(status (*check)(void *user), void *user);

/* Creates the folder `path` and its parents. E_OUTPUT if that fails or the path is not a folder. */
MUST_USE status folder_make(const char *path);

/* Composes the name of a temporary file beside `path`, unique to this machine and process, for a file that another program writes;
 * atomic_file_adopt() moves it into place. The name ends in `ending` (".png" or ""), by which some programs choose the
 * format. E_OUTPUT if it is too long. */
MUST_USE status atomic_file_temporary(const char *path, const char *ending, struct path *out);

/* Syncs the temporary file and moves it over `path`. On an error, such as a full disk, the temporary file is removed. */
MUST_USE status atomic_file_adopt(const char *temporary, const char *path);

/* Removes temporary files that killed processes left in `folder`, but not those of running processes, which may be in other
 * containers or on other machines that share the disk: their files are removed only when they are a day older than a file that the
 * disk's own clock dates now. Never fails: files that cannot be removed stay. */
void atomic_file_sweep(const char *folder);

/* Removes the temporary files of this process, after programs that it ran have failed. */
void atomic_file_sweep_own(const char *folder);

/* Reads a whole file into *bytes, which is released with free(); a NUL follows the n bytes. E_INPUT if it is missing, not a
 * regular file, or larger than `limit` bytes. */
MUST_USE status file_read(const char *path, size_t limit, void *bytes, size_t *n);

#endif
