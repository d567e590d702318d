/* The log: one line per event, on stderr and in the run's log file.
 *
 * Control characters in a line are replaced by spaces. Nothing is written to stdout, because farm managers interpret
 * lines there as commands.
 * Threads   All functions except log_set_guard() may be called from any thread; lines are not interleaved.
 */
#ifndef HOODOO_LOG_H
#define HOODOO_LOG_H

#include <stdbool.h>

#include "base/status.h"

/* Appends every further line, with date and time, to the file `path` as well; NULL closes the file. E_OUTPUT if it cannot be
 * opened. */
MUST_USE status log_open(const char *path);

/* `guard` is called with true just before and with false just after a line is written to stderr, so that a progress bar can
 * be erased and redrawn. */
void log_set_guard(void (*guard)(bool before));

void log_info(const char *format, ...) PRINTF_LIKE(1, 2);

/* Writes to the log file only: details for later reference. */
void log_note(const char *format, ...) PRINTF_LIKE(1, 2);
void log_warn(const char *format, ...) PRINTF_LIKE(1, 2);

/* Discards this thread's lines while `silent` is true, for code that repeats work whose messages were logged already. Returns
 * the previous setting. */
bool log_silence(bool silent);

/* Logs the message of a failure. */
void log_error(const char *message);

#endif
