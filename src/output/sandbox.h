/* Readers of files that may be hostile, run in a child process.
 *
 * The child has limits on memory and time, no core dump, and neither stdout nor stderr. What it writes into
 * its text comes back; whatever else happens to it stays there.
 */
#ifndef HOODOO_SANDBOX_H
#define HOODOO_SANDBOX_H

#include "base/status.h"
#include "base/text.h"

/* Reads `path` and adds what it learned to `out`. It may use OpenVDB, whose threads have ended when the child
 * begins; it must not rely on any other threads of the process. */
typedef status sandbox_reader(const char *path, struct text *out);

/* Not while another thread uses OpenVDB. `out` may be NULL. E_INPUT if the reader says so, crashes, or runs into a limit; E_MEMORY if there is no
 * child to be had. */
MUST_USE status sandbox_read(const char *path, sandbox_reader *reader, struct text *out);

#endif
