/* Graceful stop: SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2 and SIGXCPU request a stop at the next safe point; further signals have
 * no additional effect. A SIGHUP that is ignored, as under nohup, stays ignored. SIGPIPE is ignored, so that a closed pipe is
 * an error of write().
 *
 * For verbs that save work before they end. The others end at once, with the same exit code (signals_end()).
 */
#ifndef HOODOO_SIGNALS_H
#define HOODOO_SIGNALS_H

#include <stdbool.h>

void signals_install(void);

/* Until signals_install(), the same signals end the process at once, with a sentence and exit code 85: there is nothing to save, and the same
 * command starts over. */
void signals_end(void);

bool stop_requested(void);

/* The name of the first signal, such as "SIGTERM"; NULL if no stop was requested. */
const char *stop_reason(void);

/* Restores the default handlers, in a child between fork and exec. */
void signals_reset(void);

#endif
