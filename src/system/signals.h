/* Graceful stop: SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2 and SIGXCPU request a stop at the next safe point; further signals have
 * no additional effect. A SIGHUP that is ignored, as under nohup, stays ignored. SIGPIPE is ignored, so that a closed pipe is
 * an error of write().
 *
 * For verbs that save work before they end. All others keep the default of ending immediately.
 */
#ifndef HOODOO_SIGNALS_H
#define HOODOO_SIGNALS_H

#include <stdbool.h>

void signals_install(void);
bool stop_requested(void);

/* The name of the first signal, such as "SIGTERM"; NULL if no stop was requested. */
const char *stop_reason(void);

/* Restores the default handlers, in a child between fork and exec. */
void signals_reset(void);

#endif
