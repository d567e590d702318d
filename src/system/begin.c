#include "system/begin.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/status.h"

/* Where the address space is limited (ulimit -v), a driver or library whose allocation fails may crash or abort instead of returning an
 * error; that is the exit code of missing memory. Without a limit a crash stays a crash. */
static void on_crash(int signal)
{
    static const char said[] =
        "hoodoo: a library or driver crashed; probably it had no memory, as the address space is limited (ulimit -v)\n";
    (void)signal;
    if (write(STDERR_FILENO, said, sizeof said - 1) < 0)
        _exit(E_MEMORY); /* nobody is told, but the code is the same */
    _exit(E_MEMORY);
}

static void catch_crashes(void)
{
    static const int crashes[] = {SIGSEGV, SIGBUS, SIGABRT};
    struct rlimit space;
    if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY)
        return;
    for (size_t i = 0; i < sizeof crashes / sizeof *crashes; i++)
        signal(crashes[i], on_crash);
}

void process_begin(void)
{
    for (int fd = 0; fd < 3; fd++) {
        if (fcntl(fd, F_GETFD) >= 0 || errno != EBADF)
            continue;
        /* open() returns the lowest free descriptor, which is fd. */
        if (open("/dev/null", fd == STDOUT_FILENO ? O_RDONLY : O_RDWR) != fd)
            _exit(E_OUTPUT);
    }
    signal(SIGXFSZ, SIG_IGN);
    catch_crashes();
}
