#include "reader/serve.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "reader/calls.h"
#include "reader/limits.h"

/* ---- limits */

static void limit(__rlimit_resource_t resource, rlim_t soft, rlim_t hard)
{
    struct rlimit now;
    if (getrlimit(resource, &now) != 0)
        return;
    if (now.rlim_max != RLIM_INFINITY && hard > now.rlim_max)
        hard = now.rlim_max;
    setrlimit(resource, &(struct rlimit){soft < hard ? soft : hard, hard});
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { SHADOWED = 1 }; /* sanitizers reserve terabytes of address space */
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
enum { SHADOWED = 1 };
#else
enum { SHADOWED = 0 };
#endif
#else
enum { SHADOWED = 0 };
#endif

/* The limit on address space is counted from what the libraries take already. */
static uint64_t address_space_used(void)
{
    unsigned long long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f && fscanf(f, "%llu", &pages) != 1)
        pages = 0;
    if (f)
        fclose(f);
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

void serve_limits(uint64_t base, uint64_t size)
{
    const uint64_t available = memory_available(), most = reader_memory(base, size);
    const rlim_t cpu = (rlim_t)reader_cpu_seconds(size);
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_CPU, cpu, cpu + 1);           /* the soft limit sends SIGXCPU, which tells the caller why */
    limit(RLIMIT_FSIZE, available, available); /* the answer */
    if (!SHADOWED) {
        const rlim_t space = address_space_used() + (most < available ? most : available);
        limit(RLIMIT_AS, space, space);
    }
    signal(SIGXCPU, SIG_DFL);
}

/* ---- the answer */

static status send(const void *bytes, size_t n, uint64_t at)
{
    for (size_t sent = 0; sent < n;) {
        ssize_t k = pwrite(READER_ANSWER_FD, (const char *)bytes + sent, n - sent, (off_t)(at + sent));
        if (k < 0 && errno != EINTR)
            return fail(E_MEMORY, "out of memory for an answer of %zu bytes: %s", n, strerror(errno));
        sent += k > 0 ? (size_t)k : 0;
    }
    return OK;
}

status serve_begin_part(struct serve_answer *a)
{
    if (a->head.n_parts == READER_PARTS)
        return fail(E_INPUT, "the answer has more than %d parts", READER_PARTS);
    a->head.size[a->head.n_parts++] = 0;
    return OK;
}

status serve_append(struct serve_answer *a, const void *bytes, size_t n)
{
    uint64_t at = sizeof a->head;
    for (size_t i = 0; i < a->head.n_parts; i++)
        at += a->head.size[i];
    status st = send(bytes, n, at);
    if (st == OK)
        a->head.size[a->head.n_parts - 1] += n;
    return st;
}

status serve_add_part(struct serve_answer *a, const void *bytes, size_t n)
{
    status st = serve_begin_part(a);
    return st == OK ? serve_append(a, bytes, n) : st;
}

status serve_input(const struct serve_question *q, void *to, size_t n, uint64_t at)
{
    if (at > q->n_input || n > q->n_input - at)
        return fail(E_INPUT, "%s: the input for its reader is too short", q->path);
    for (size_t got = 0; got < n;) {
        ssize_t k = pread(READER_INPUT_FD, (char *)to + got, n - got, (off_t)(at + got));
        if (k == 0 || (k < 0 && errno != EINTR))
            return fail(E_INPUT, "%s: its reader cannot read its input", q->path);
        got += k > 0 ? (size_t)k : 0;
    }
    return OK;
}

/* ---- the request */

static status answer(const struct serve_kind *kind, struct serve_question *q, struct serve_answer *a)
{
    status st = OK;
    struct stat info, input = {0};
    if (stat(q->path, &info) != 0)
        return fail(E_INPUT, "%s: %s", q->path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return fail(E_INPUT, "%s: not a regular file", q->path);
    if (fstat(READER_INPUT_FD, &input) == 0 && S_ISREG(input.st_mode))
        q->n_input = (uint64_t)input.st_size;
    serve_limits(kind->memory, (uint64_t)info.st_size + q->n_input);
    TRY(calls_limit(false));
    TRY(kind->read(q, a));
done:
    return st;
}

static int usage(const char *self)
{
    fprintf(stderr, "%s: hoodoo starts this program to read files; it cannot be used alone\n", self);
    return E_USAGE;
}

int serve(int argc, char **argv, const struct serve_kind *kind, size_t n_kinds)
{
    struct serve_answer a = {.head = {.magic = READER_MAGIC, .version = READER_VERSION}};
    struct stat info;
    size_t k = 0;
    if (argc < 3 || fstat(READER_ANSWER_FD, &info) != 0 || !S_ISREG(info.st_mode))
        return usage(argv[0]);
    while (k < n_kinds && strcmp(kind[k].name, argv[1]) != 0)
        k++;
    if (k == n_kinds)
        return usage(argv[0]);
    struct serve_question q = {
        .path = argv[2], .argument = (const char *const *)argv + 3, .n_arguments = (size_t)argc - 3};
    status st = answer(&kind[k], &q, &a);
    a.head.status = (int32_t)st;
    if (st != OK) {
        a.head.n_parts = 0;
        snprintf(a.head.message, sizeof a.head.message, "%s", status_message());
    }
    _exit(send(&a.head, sizeof a.head, 0) == OK ? 0 : 1); /* not exit(): no handlers of libraries may run */
}
