/* How long a shared disk may hide from this machine what another one has written: NFS caches names and attributes for up to a minute. Tasks
 * that start right after those they wait for, on another node, look again until then before they report that files are missing. */
#ifndef HOODOO_VISIBLE_H
#define HOODOO_VISIBLE_H

#include <stdlib.h>

/* Seconds, from HOODOO_DISK_DELAY, which back ends of farms with several machines set; 0 without it. */
static inline double visible_delay(void)
{
    const char *set = getenv("HOODOO_DISK_DELAY");
    const double seconds = set ? strtod(set, NULL) : 0;
    return seconds > 0 ? seconds < 3600 ? seconds : 3600 : 0;
}

/* The delay that back ends set where the user has not. */
#define VISIBLE_DELAY_S 60

#endif
