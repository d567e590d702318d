/* What a wrangler reads: one line an event, on stderr and in the run's log file.
 *
 * Control characters in arguments become spaces, and stdout is never used: there, farm managers obey what a
 * line says.
 * Threads   safe; lines do not mix.
 */
#ifndef HOODOO_LOG_H
#define HOODOO_LOG_H

#include <stdbool.h>

#include "base/status.h"

/* Also append every line (with the time of day) to `path`; NULL closes. E_OUTPUT if it cannot be opened. */
MUST_USE status log_open(const char *path);

/* Called with true just before and false just after a line goes to stderr, so that a progress bar can step
 * aside. */
void log_set_guard(void (*guard)(bool before));

void log_info(const char *format, ...) PRINTF_LIKE(1, 2);

/* For the file alone: what one looks up later. */
void log_note(const char *format, ...) PRINTF_LIKE(1, 2);
void log_warn(const char *format, ...) PRINTF_LIKE(1, 2);

/* Whether this thread's lines are dropped: for who reads again what is read, and said, elsewhere. Returns what was so before. */
bool log_hush(bool hushed);

/* The line of a failure: "hoodoo: MESSAGE". */
void log_error(const char *message);

#endif
