/* SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2 and SIGXCPU ask for a stop at the next safe point; any number of them, at any
 * time, means the same. A SIGHUP that is ignored, as nohup has it, stays so. SIGPIPE is ignored from then on: a closed pipe is
 * an error of the write.
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
