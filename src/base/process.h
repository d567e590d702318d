/* Who a process is, and whether it still lives. Process numbers come again, on this machine and on others, and mean
 * nothing in another container: a process is named by its machine, boot, process space and beginning too. */
#ifndef HOODOO_PROCESS_H
#define HOODOO_PROCESS_H

#include <stdint.h>

struct process {
    char host[128], boot[64], space[64]; /* "" where the system does not tell */
    long pid;
    unsigned long long began; /* in ticks since boot; 0: not known */
};

void process_self(struct process *out);

enum process_fate {
    PROCESS_LIVES,
    PROCESS_GONE,
    PROCESS_UNKNOWN, /* it is elsewhere, or /proc hides other users' processes (hidepid) or is another container's */
};
enum process_fate process_fate(const struct process *p);

/* A number for the place whose process numbers this process understands: machine, boot and process space. */
uint32_t process_place(void);

#endif
