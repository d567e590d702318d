/* The identity of a process, and whether it is still alive. Process numbers are reused, and have no meaning on other machines or in
 * other containers, so a process is identified by its machine, boot, PID namespace and start time as well. */
#ifndef HOODOO_PROCESS_H
#define HOODOO_PROCESS_H

#include <stdint.h>

struct process_id {
    char host[128], boot[64], space[64]; /* host name, boot id, PID namespace; "" if unknown */
    long pid;
    unsigned long long began; /* start time, in ticks since boot; 0: unknown */
};

void process_self(struct process_id *out);

enum process_fate {
    PROCESS_LIVES,
    PROCESS_GONE,
    PROCESS_UNKNOWN, /* on another machine or in another container, or /proc hides other users' processes (hidepid) */
};
enum process_fate process_fate(const struct process_id *p);

/* A hash of machine, boot and PID namespace, within which process numbers are unique. */
uint32_t process_place(void);

#endif
