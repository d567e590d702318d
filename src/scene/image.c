#include "scene/image.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/memory.h"
#include "scene/image_shim.h"

#define CPU_SECONDS 60
#define WALL_SECONDS 180
#define EXTRA_MEMORY ((rlim_t)4 << 30) /* bytes a decoder may add to what the process has mapped */

/* What the child sends first; the pixels follow if st is OK. */
struct reply {
    int32_t st;
    uint64_t width, height;
    char message[512];
};

/* ---- in the child */

static void set_limit(int resource, rlim_t value)
{
    struct rlimit limit;
    if (getrlimit((__rlimit_resource_t)resource, &limit) == 0) {
        if (limit.rlim_max == RLIM_INFINITY || value < limit.rlim_max)
            limit.rlim_max = value + 1; /* the soft one strikes first, with a signal that says why */
        limit.rlim_cur = value < limit.rlim_max ? value : limit.rlim_max;
        setrlimit((__rlimit_resource_t)resource, &limit);
    }
}

/* Address space is counted from what is mapped already: with a GPU open that is much, and none of it is used
 * here. */
static void limit_memory(void)
{
#if defined(__SANITIZE_ADDRESS__)
    return; /* its shadow is terabytes of address space */
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
    return;
#endif
#endif
    char text[64] = {0};
    int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (fd < 0)
        return;
    if (read(fd, text, sizeof text - 1) > 0)
        set_limit(RLIMIT_AS, (rlim_t)strtoull(text, NULL, 10) * (rlim_t)sysconf(_SC_PAGESIZE) + EXTRA_MEMORY);
    close(fd);
}

static void send_all(int fd, const void *bytes, size_t n)
{
    const char *at = bytes;
    while (n > 0) {
        ssize_t k = write(fd, at, n);
        if (k < 0 && errno == EINTR)
            continue;
        if (k <= 0)
            _exit(1);
        at += k;
        n -= (size_t)k;
    }
}

static _Noreturn void child(int fd, const char *path)
{
    struct reply reply = {0};
    size_t width = 0, height = 0;
    float *value = NULL;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    signal(SIGPIPE, SIG_DFL);
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, CPU_SECONDS);
    limit_memory();
    int null = open("/dev/null", O_RDWR); /* decoders chatter */
    if (null >= 0) {
        dup2(null, STDOUT_FILENO);
        dup2(null, STDERR_FILENO);
    }
    status st = image_decode(path, IMAGE_MAX_PIXELS, &width, &height, &value);
    reply.st = (int32_t)st;
    reply.width = width;
    reply.height = height;
    if (st != OK)
        strncpy(reply.message, status_message(), sizeof reply.message - 1);
    send_all(fd, &reply, sizeof reply);
    if (st == OK)
        send_all(fd, value, width * height * sizeof *value);
    _exit(0);
}

/* ---- in the parent */

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Reads n bytes before `deadline`. The number read is less only at the child's end or at the deadline. */
static size_t receive(int fd, void *bytes, size_t n, double deadline)
{
    size_t got = 0;
    while (got < n) {
        double left = deadline - seconds();
        struct pollfd p = {.fd = fd, .events = POLLIN};
        int ready = left > 0 ? poll(&p, 1, (int)(left * 1000) + 1) : 0;
        if (ready < 0 && errno == EINTR)
            continue;
        ssize_t k = ready > 0 ? read(fd, (char *)bytes + got, n - got) : 0;
        if (k < 0 && errno == EINTR)
            continue;
        if (k <= 0)
            break;
        got += (size_t)k;
    }
    return got;
}

/* What became of a child that did not deliver. */
static status describe(const char *path, int ended, double deadline)
{
    if (seconds() >= deadline || (WIFSIGNALED(ended) && WTERMSIG(ended) == SIGXCPU))
        return fail(E_INPUT, "%s: decoding took too long (over %d s): the file is damaged or hostile", path,
                    CPU_SECONDS);
    if (WIFSIGNALED(ended))
        return fail(E_INPUT, "%s: the image decoder crashed (%s): the file is damaged or hostile", path,
                    strsignal(WTERMSIG(ended)));
    return fail(E_INPUT, "%s: the image decoder gave up without a word: the file is damaged or hostile",
                path);
}

static status collect(int fd, const char *path, double deadline, bool *whole, size_t *width, size_t *height,
                      float **value)
{
    status st = OK;
    struct reply reply;
    *whole = false;
    if (receive(fd, &reply, sizeof reply, deadline) < sizeof reply)
        return OK;
    *whole = true;
    reply.message[sizeof reply.message - 1] = '\0';
    if (reply.st != OK)
        return fail(reply.st == E_MEMORY ? E_MEMORY : E_INPUT, "%s", reply.message);
    /* The child has read hostile bytes: what it says is checked again. */
    if (reply.width < 1 || reply.height < 1 || reply.width > IMAGE_MAX_PIXELS / reply.height)
        return fail(E_INPUT, "%s: the image decoder's answer makes no sense", path);
    size_t bytes = reply.width * reply.height * sizeof **value;
    TRY(memory_alloc(reply.width * reply.height, sizeof **value, path, value));
    *width = reply.width;
    *height = reply.height;
    *whole = receive(fd, *value, bytes, deadline) == bytes;
done:
    return st;
}

status image_read(const char *path, size_t *width, size_t *height, float **value)
{
    status st = OK;
    struct stat info;
    int ends[2], ended = 0;
    bool whole = false;
    *value = NULL;
    if (stat(path, &info) != 0)
        return fail(E_INPUT, "%s: %s", path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return fail(E_INPUT, "%s: not a regular file", path);
    if (pipe2(ends, O_CLOEXEC) != 0)
        return fail(E_MEMORY, "%s: no pipe to the image decoder: %s", path, strerror(errno));
    double deadline = seconds() + WALL_SECONDS;
    pid_t pid = fork();
    if (pid == 0) {
        close(ends[0]);
        child(ends[1], path);
    }
    close(ends[1]);
    if (pid < 0) {
        close(ends[0]);
        return fail(E_MEMORY, "%s: no process for the image decoder: %s", path, strerror(errno));
    }
    st = collect(ends[0], path, deadline, &whole, width, height, value);
    close(ends[0]);
    kill(pid, SIGKILL); /* it is done, or it never will be */
    while (waitpid(pid, &ended, 0) < 0 && errno == EINTR)
        ;
    if (st == OK && !whole)
        st = describe(path, ended, deadline);
    if (st != OK) {
        free(*value);
        *value = NULL;
    }
    return st;
}
