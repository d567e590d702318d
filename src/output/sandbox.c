#include "output/sandbox.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/memory.h"
#include "output/vdb.h"

/* What the child sends before its text. */
struct answer {
    status st;
    char message[1020];
};

static bool send_all(int fd, const void *bytes, size_t n)
{
    for (size_t sent = 0; sent < n;) {
        ssize_t k = write(fd, (const char *)bytes + sent, n - sent);
        if (k < 0 && errno != EINTR)
            return false;
        sent += k > 0 ? (size_t)k : 0;
    }
    return true;
}

/* Address space in use now: the limit has to lie above what the device drivers and the frames already hold.
 */
static rlim_t address_space_used(void)
{
    unsigned long long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f && fscanf(f, "%llu", &pages) != 1)
        pages = 0;
    if (f)
        fclose(f);
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void limit(__rlimit_resource_t resource, rlim_t most)
{
    struct rlimit now;
    if (getrlimit(resource, &now) == 0 && (now.rlim_max == RLIM_INFINITY || most < now.rlim_max))
        setrlimit(resource, &(struct rlimit){most, most});
}

/* Limits grow with the file: compressed voxels take many times their size in memory. */
static void limit_child(uint64_t file_size)
{
    enum { MIB = 1 << 20 };
    rlim_t memory = 1024 * (rlim_t)MIB + 64 * (rlim_t)file_size;
    rlim_t available = memory_available();
    unsigned seconds = 60 + (unsigned)(file_size / (4 * MIB) < 36000 ? file_size / (4 * MIB) : 36000);
    limit(RLIMIT_AS, address_space_used() + (memory < available ? memory : available));
    limit(RLIMIT_CPU, seconds);
    limit(RLIMIT_CORE, 0);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    signal(SIGALRM, SIG_DFL);
    alarm(4 * seconds); /* a slow disk costs no CPU time */
    int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (null >= 0) {
        dup2(null, STDOUT_FILENO);
        dup2(null, STDERR_FILENO);
    }
}

static void run_child(int fd, const char *path, sandbox_reader *reader, struct text *text)
{
    struct stat info;
    struct answer answer = {.st = OK};
    if (stat(path, &info) != 0)
        answer.st = fail(E_INPUT, "%s: %s", path, strerror(errno));
    else if (!S_ISREG(info.st_mode))
        answer.st = fail(E_INPUT, "%s: not a regular file", path);
    else {
        limit_child((uint64_t)info.st_size);
        answer.st = reader(path, text);
        if (answer.st == OK)
            answer.st = text_status(text);
    }
    snprintf(answer.message, sizeof answer.message, "%s", status_message());
    if (send_all(fd, &answer, sizeof answer) && answer.st == OK)
        send_all(fd, text->data, text->size);
    _exit(0);
}

static status collect(int fd, struct answer *answer, struct text *text)
{
    char chunk[65536];
    size_t got = 0;
    for (;;) {
        ssize_t k = read(fd, chunk, sizeof chunk);
        if (k < 0 && errno == EINTR)
            continue;
        if (k <= 0)
            break;
        size_t head = got < sizeof *answer ? sizeof *answer - got : 0;
        if (head > (size_t)k)
            head = (size_t)k;
        memcpy((char *)answer + got, chunk, head);
        if ((size_t)k > head)
            text_add_bytes(text, chunk + head, (size_t)k - head);
        got += head;
    }
    answer->message[sizeof answer->message - 1] = '\0';
    return got == sizeof *answer ? OK : E_INPUT;
}

/* What stands in a stranger's file may be no UTF-8, and then JSON with it is no JSON: such bytes become '?'.
 */
static void make_utf8(struct text *text)
{
    for (size_t i = 0; i < text->size;) {
        const unsigned char *c = (const unsigned char *)text->data + i;
        const size_t n = *c < 0x80                 ? 1
                         : *c >= 0xc2 && *c < 0xe0 ? 2
                         : *c >= 0xe0 && *c < 0xf0 ? 3
                         : *c >= 0xf0 && *c < 0xf5 ? 4
                                                   : 0;
        bool good = n > 0 && n <= text->size - i;
        for (size_t k = 1; good && k < n; k++)
            good = (c[k] & 0xc0) == 0x80;
        if (good && n > 2) /* overlong forms, halves of surrogate pairs, and beyond the last character */
            good = !((*c == 0xe0 && c[1] < 0xa0) || (*c == 0xed && c[1] > 0x9f) ||
                     (*c == 0xf0 && c[1] < 0x90) || (*c == 0xf4 && c[1] > 0x8f));
        if (!good)
            text->data[i] = '?';
        i += good ? n : 1;
    }
}

status sandbox_read(const char *path, sandbox_reader *reader, struct text *out)
{
    /* The child goes on writing JSON where `out` stands. */
    struct text text = {.depth = out ? out->depth : 0, .comma = out ? out->comma : false};
    struct answer answer = {.st = OK};
    int end[2], how = 0;
    if (pipe2(end, O_CLOEXEC) != 0)
        return fail(E_MEMORY, "%s: no pipe to a reader: %s", path, strerror(errno));
    vdb_end_threads();
    pid_t child = fork();
    if (child == 0) {
        close(end[0]);
        run_child(end[1], path, reader, &text);
    }
    close(end[1]);
    if (child < 0) {
        close(end[0]);
        return fail(E_MEMORY, "%s: no child process to read it in: %s", path, strerror(errno));
    }
    status st = collect(end[0], &answer, &text);
    close(end[0]);
    while (waitpid(child, &how, 0) < 0 && errno == EINTR)
        ;
    if (st != OK && WIFSIGNALED(how) && (WTERMSIG(how) == SIGXCPU || WTERMSIG(how) == SIGALRM))
        st = fail(E_INPUT, "%s: reading it takes too long; it is damaged or hostile", path);
    else if (st != OK)
        st = fail(E_INPUT, "%s: it is damaged or hostile (its reader crashed)", path);
    else if (answer.st == E_MEMORY)
        st = fail(E_INPUT,
                  "%s: reading it takes more memory than a file of its size should; it is damaged or hostile",
                  path);
    else if (answer.st != OK)
        st = fail(answer.st, "%s", answer.message);
    else
        st = text_status(&text);
    if (st == OK && out && text.size) {
        make_utf8(&text);
        text_add_bytes(out, text.data, text.size);
        out->comma = true;
    }
    text_free(&text);
    return st;
}
