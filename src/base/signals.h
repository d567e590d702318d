/* SIGTERM, SIGINT and SIGUSR1 ask for a stop at the next safe point; any number of them, at any time, means
 * the same. SIGPIPE is ignored from then on: a closed pipe is an error of the write.
 *
 * For verbs that save work before they end. Others keep the default: at once.
 */
#ifndef HOODOO_SIGNALS_H
#define HOODOO_SIGNALS_H

#include <stdbool.h>

void signals_install(void);
bool stop_requested(void);

/* "SIGTERM", or NULL while no stop was requested. */
const char *stop_reason(void);

/* In a child between fork and exec: the defaults back, for a program that knows nothing of ours. */
void signals_reset(void);

#endif
