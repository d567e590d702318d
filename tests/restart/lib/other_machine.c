/* A library for LD_PRELOAD that gives a program another machine: CLOCK_AHEAD: the wall clock is so many seconds ahead and is set back 3 s after
 * the start, as a time server does. NO_LINKS: the disk has no hard links. */
#include <errno.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

int clock_gettime(clockid_t clock, struct timespec *out)
{
    static time_t began;
    struct timespec now;
    const char *ahead = getenv("CLOCK_AHEAD");
    const int code = (int)syscall(SYS_clock_gettime, clock, out);
    syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
    if (!began)
        began = now.tv_sec;
    if (clock == CLOCK_REALTIME && ahead && now.tv_sec - began < 3)
        out->tv_sec += atol(ahead);
    return code;
}

int link(const char *from, const char *to)
{
    if (getenv("NO_LINKS")) {
        errno = EPERM;
        return -1;
    }
    return (int)syscall(SYS_link, from, to);
}
