#include "reader/reader.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/memory.h"
#include "reader/limits.h"
#include "system/beside.h"
#include "system/child.h"

enum { ARGUMENTS = 32 };

/* ---- the request */

static status make_input(const struct reader_question *q, int *fd)
{
    *fd = memfd_create("hoodoo-input", MFD_CLOEXEC);
    for (size_t sent = 0; *fd >= 0 && sent < q->n_input;) {
        ssize_t k = pwrite(*fd, (const char *)q->input + sent, q->n_input - sent, (off_t)sent);
        if (k < 0 && errno != EINTR)
            break;
        sent += k > 0 ? (size_t)k : 0;
        if (sent == q->n_input)
            return OK;
    }
    return fail(E_MEMORY, "%s: out of memory for its reader's input: %s", q->path, strerror(errno));
}

static status start(const struct reader_question *q, int answer, struct child *out)
{
    status st = OK;
    char program[BESIDE_PATH];
    const char *argv[ARGUMENTS + 4] = {program, q->kind, q->path};
    int pass[2] = {answer, -1};
    size_t n = 3;
    for (size_t i = 0; q->argument && q->argument[i]; i++) {
        if (n == ARGUMENTS + 3)
            return fail(E_USAGE, "%s: more than %d arguments for its reader", q->path, ARGUMENTS);
        argv[n++] = q->argument[i];
    }
    if (!beside_find(q->program, program))
        return fail(E_INPUT, "%s: the program that reads it is missing: " BESIDE_HINT, q->path, q->program);
    if (q->n_input)
        TRY(make_input(q, &pass[1]));
    TRY(child_start(&(struct child_options){.argv = argv, .pass = pass, .n_pass = q->n_input ? 2 : 1}, out));
done:
    if (pass[1] >= 0)
        close(pass[1]);
    return st;
}

/* ---- the answer */

/* The error for a reader that did not answer. */
static status describe(const struct reader_question *q, bool in_time, int how)
{
    if (!in_time || (WIFSIGNALED(how) && WTERMSIG(how) == SIGXCPU))
        return fail(E_INPUT, "%s: reading it takes too long; it is damaged or hostile", q->path);
    if (WIFSIGNALED(how))
        return fail(E_INPUT, "%s: it is damaged or hostile (its reader crashed: %s)", q->path,
                    strsignal(WTERMSIG(how)));
    if (WEXITSTATUS(how) == CHILD_NO_PROGRAM || WEXITSTATUS(how) == CHILD_NOT_SET_UP)
        return fail(E_INPUT, "%s: the program that reads it, %s, could not be started", q->path, q->program);
    return fail(E_INPUT, "%s: it is damaged or hostile (its reader exited without an answer)", q->path);
}

/* Replaces bytes that are not valid UTF-8 by '?': text from a foreign file would otherwise make JSON invalid. */
static void make_utf8(char *text, size_t size)
{
    for (size_t i = 0; i < size;) {
        const unsigned char *c = (const unsigned char *)text + i;
        const size_t n = *c < 0x80                 ? 1
                         : *c >= 0xc2 && *c < 0xe0 ? 2
                         : *c >= 0xe0 && *c < 0xf0 ? 3
                         : *c >= 0xf0 && *c < 0xf5 ? 4
                                                   : 0;
        bool good = n > 0 && n <= size - i;
        for (size_t k = 1; good && k < n; k++)
            good = (c[k] & 0xc0) == 0x80;
        if (good && n > 2) /* overlong forms, surrogate halves, and code points beyond the last */
            good = !((*c == 0xe0 && c[1] < 0xa0) || (*c == 0xed && c[1] > 0x9f) ||
                     (*c == 0xf0 && c[1] < 0x90) || (*c == 0xf4 && c[1] > 0x8f));
        if (!good)
            text[i] = '?';
        i += good ? n : 1;
    }
}

static bool read_all(int fd, void *to, size_t n, uint64_t at)
{
    for (size_t got = 0; got < n;) {
        ssize_t k = pread(fd, (char *)to + got, n - got, (off_t)(at + got));
        if (k == 0 || (k < 0 && errno != EINTR))
            return false;
        got += k > 0 ? (size_t)k : 0;
    }
    return true;
}

status reader_bad_answer(const struct reader_answer *a)
{
    return fail(E_INPUT, "%s: it is damaged or hostile (its reader's answer is malformed)", a->path);
}

static bool is_known(int32_t code)
{
#define KNOWN(name, value, text)                                                                             \
    if (code == (value))                                                                                     \
        return true;
    STATUS_MAP(KNOWN)
#undef KNOWN
    return false;
}

/* Checks the head, and that the answer has exactly the parts that the head lists. */
static status check(struct reader_answer *a)
{
    struct reader_head *h = &a->head;
    struct stat info;
    uint64_t end = sizeof *h;
    if (fstat(a->fd, &info) != 0 || h->version != READER_VERSION || !is_known(h->status) ||
        h->n_parts > READER_PARTS)
        return reader_bad_answer(a);
    h->message[sizeof h->message - 1] = '\0';
    make_utf8(h->message, strlen(h->message));
    if (h->status == E_MEMORY)
        return fail(
            E_INPUT,
            "%s: reading it takes more memory than a file of this size should; it is damaged or hostile",
            a->path);
    if (h->status != OK)
        return fail((status)h->status, "%s", h->message);
    for (size_t i = 0; i < h->n_parts; i++) {
        if (h->size[i] > (uint64_t)info.st_size - end)
            return reader_bad_answer(a);
        end += h->size[i];
    }
    return end == (uint64_t)info.st_size ? OK : reader_bad_answer(a);
}

status reader_adopt(const char *path, int fd, struct reader_answer *out)
{
    *out = (struct reader_answer){.path = path, .fd = fd, .at = sizeof out->head};
    if (!read_all(fd, &out->head, sizeof out->head, 0) || out->head.magic != READER_MAGIC)
        return reader_bad_answer(out);
    return check(out);
}

static status wait_for(const struct reader_question *q, struct child *child, double seconds,
                       struct reader_answer *out)
{
    const double until = clock_seconds() + seconds;
    int how = 0;
    while (child->pid && clock_seconds() < until)
        child_wait(child, 1, until - clock_seconds(), &how);
    bool in_time = child->pid == 0;
    child_kill(child);
    if (!in_time || !WIFEXITED(how) || WEXITSTATUS(how) != 0 ||
        !read_all(out->fd, &out->head, sizeof out->head, 0) || out->head.magic != READER_MAGIC)
        return describe(q, in_time, how);
    return check(out);
}

status reader_ask(const struct reader_question *q, struct reader_answer *out)
{
    status st = OK;
    struct stat info;
    struct child child = {0};
    *out = (struct reader_answer){.path = q->path, .fd = -1, .at = sizeof out->head};
    if (stat(q->path, &info) != 0)
        return fail(E_INPUT, "%s: %s", q->path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return fail(E_INPUT, "%s: not a regular file", q->path);
    out->fd = memfd_create("hoodoo-answer", MFD_CLOEXEC);
    if (out->fd < 0)
        return fail(E_MEMORY, "%s: out of memory for its reader's answer: %s", q->path, strerror(errno));
    TRY(start(q, out->fd, &child));
    /* The limit on elapsed time is four times that on CPU time, because the disk may be slow. */
    TRY(wait_for(q, &child,
                 q->seconds > 0 ? q->seconds : 4 * reader_cpu_seconds((uint64_t)info.st_size + q->n_input),
                 out));
done:
    if (st != OK)
        reader_end(out);
    return st;
}

/* ---- the parts of the answer */

size_t reader_size(const struct reader_answer *a)
{
    return a->next < a->head.n_parts ? (size_t)a->head.size[a->next] : 0;
}

status reader_take(struct reader_answer *a, void *to, size_t size)
{
    if (a->next >= a->head.n_parts || a->head.size[a->next] != size || !read_all(a->fd, to, size, a->at))
        return reader_bad_answer(a);
    /* Free the part's pages in the memory file, if the file system can punch holes; failing is harmless. */
    fallocate(a->fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, (off_t)a->at, (off_t)size);
    a->at += size;
    a->next++;
    return OK;
}

status reader_take_array(struct reader_answer *a, size_t n, size_t size, void *out)
{
    if (a->next >= a->head.n_parts || n > SIZE_MAX / size || a->head.size[a->next] != n * size)
        return reader_bad_answer(a);
    void *made = NULL;
    status st = memory_alloc(n, size, a->path, &made);
    if (st == OK)
        st = reader_take(a, made, n * size);
    if (st != OK) {
        free(made);
        made = NULL;
    }
    *(void **)out = made;
    return st;
}

status reader_take_text(struct reader_answer *a, struct text *out)
{
    const size_t n = reader_size(a);
    char *bytes = NULL;
    status st = reader_take_array(a, n, 1, &bytes);
    if (st == OK) {
        make_utf8(bytes, n);
        text_add_bytes(out, bytes, n);
        st = text_status(out);
    }
    free(bytes);
    return st;
}

void reader_end(struct reader_answer *a)
{
    if (a->path && a->fd >= 0)
        close(a->fd);
    *a = (struct reader_answer){.fd = -1};
}
