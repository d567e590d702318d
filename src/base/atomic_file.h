/* Files that are either whole or absent.
 *
 * The bytes go to a unique temporary name beside `path`, are flushed and fsynced, renamed over `path`, and
 * the folder is fsynced. On any error the temporary file is removed and what stood at `path` before is
 * untouched.
 */
#ifndef HOODOO_ATOMIC_FILE_H
#define HOODOO_ATOMIC_FILE_H

#include <stddef.h>

#include "base/path.h"
#include "base/status.h"

/* E_OUTPUT names the path, the bytes and the system's reason (disk full, permission). */
MUST_USE status atomic_file_write(const char *path, const void *bytes, size_t n);

/* Makes `path` and its parents. E_OUTPUT if that fails or something else stands there. */
MUST_USE status folder_make(const char *path);

/* A temporary name beside `path`, of this machine and process, for files that other programs write: move it
 * over `path` when it is whole. It ends in `ending` (".png"), for programs go by that; or in nothing in
 * particular (""). E_OUTPUT if it is too long. */
MUST_USE status atomic_file_temporary(const char *path, const char *ending, struct path *out);

/* Moves what stands at that temporary name over `path`, fsynced; it is removed if that fails, as on a disk that was
 * full all along. */
MUST_USE status atomic_file_adopt(const char *temporary, const char *path);

/* Removes temporary files that killed processes left in `folder`; those of living ones, here, in other containers
 * or on other machines that share the disk, stay. Never fails: what cannot be removed stays too. */
void atomic_file_sweep(const char *folder);

/* Removes those of this process, for when programs that it ran have failed and will not be asked again. */
void atomic_file_sweep_own(const char *folder);

/* The whole file in *bytes (freed with free(); a NUL follows the content). E_INPUT if missing, not a regular
 * file, or larger than `limit` bytes. */
MUST_USE status file_read(const char *path, size_t limit, void *bytes, size_t *n);

#endif
