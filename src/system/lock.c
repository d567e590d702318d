#include "system/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/path.h"
#include "system/atomic_file.h"
#include "system/process.h"
#include "text/json.h"
#include "text/text.h"

enum { LOCK_BYTES = 4096, COUNT_DIGITS = 12, WATCH_US = 100000 };
static const double HEARTBEAT_S = 5, WATCH_S = 30;

struct lock {
    struct path path;
    char token[96];
    double heartbeat_s;
    pthread_t thread;
    pthread_mutex_t guard;
    pthread_cond_t wake;
    bool ending;
    atomic_bool lost;
    pthread_mutex_t beating; /* one thread writes a heartbeat */
    unsigned long long count;
    _Atomic double beat_s; /* when the last heartbeat was written, by now_s() */
};

/* ---- the file */

/* The counter comes first and has a fixed width, so that it can be overwritten in place. */
static status compose(const struct lock *lock, const char *what, struct text *t)
{
    struct process_id me;
    char since[32] = "";
    time_t now = time(NULL);
    struct tm tm;
    process_self(&me);
    if (localtime_r(&now, &tm))
        strftime(since, sizeof since, "%Y-%m-%dT%H:%M:%S%z", &tm);
    text_add(t, "%0*d\n", COUNT_DIGITS, 0);
    json_object(t, NULL);
    json_text(t, "token", lock->token);
    json_text(t, "host", me.host);
    json_text(t, "boot", me.boot);
    json_text(t, "pid_space", me.space);
    json_integer(t, "pid", me.pid);
    json_integer(t, "began", (int64_t)me.began);
    json_text(t, "since", since);
    json_text(t, "what", what);
    json_end_object(t);
    return text_status(t);
}

struct seen {
    bool there, unread; /* unread: it exists but cannot be read at the moment */
    char count[COUNT_DIGITS + 1], token[96], since[40], what[256];
    struct process_id holder;
};

static void copy_text(const struct json *json, const char *key, char *out, size_t size)
{
    const char *text = json_to_text(json_member(json, key));
    snprintf(out, size, "%s", text ? text : "");
}

/* Reads the lock file. A file with unknown content counts as a lock of an unknown holder. */
static status read_lock(const char *path, struct seen *s)
{
    char *bytes = NULL;
    size_t n = 0;
    struct json *json = NULL;
    struct stat info;
    int64_t pid = 0;
    uint64_t began = 0;
    *s = (struct seen){0};
    if (lstat(path, &info) != 0)
        return OK;
    s->there = true;
    status st = file_read(path, LOCK_BYTES, &bytes, &n);
    if (st == E_MEMORY)
        return st;
    s->unread = st != OK;
    if (st == OK && n > COUNT_DIGITS) {
        memcpy(s->count, bytes, COUNT_DIGITS);
        st = json_read(path, bytes + COUNT_DIGITS, n - COUNT_DIGITS, &json);
        if (st == OK) {
            copy_text(json, "token", s->token, sizeof s->token);
            copy_text(json, "host", s->holder.host, sizeof s->holder.host);
            copy_text(json, "boot", s->holder.boot, sizeof s->holder.boot);
            copy_text(json, "pid_space", s->holder.space, sizeof s->holder.space);
            copy_text(json, "since", s->since, sizeof s->since);
            copy_text(json, "what", s->what, sizeof s->what);
            if (json_to_integer(json_member(json, "pid"), 0, INT32_MAX, &pid))
                s->holder.pid = (long)pid;
            if (json_to_uint64(json_member(json, "began"), &began))
                s->holder.began = began;
        }
    }
    json_free(&json);
    free(bytes);
    return st == E_MEMORY ? st : OK;
}

enum owner { MINE, ANOTHERS, UNREAD };

/* Determines whose lock it is. Allocates no memory, because heartbeat and release must also work without any. */
static enum owner owner_of(const struct lock *lock)
{
    char bytes[LOCK_BYTES];
    int fd = open(lock->path.text, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0)
        return errno == ENOENT || errno == ELOOP ? ANOTHERS : UNREAD;
    ssize_t n = pread(fd, bytes, sizeof bytes, 0);
    close(fd);
    if (n < 0)
        return UNREAD;
    return memmem(bytes, (size_t)n, lock->token, strlen(lock->token)) ? MINE : ANOTHERS;
}

/* ---- the heartbeat */

/* Seconds on a clock that nobody sets, and that runs on while the machine sleeps. */
static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_BOOTTIME, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Writes a heartbeat if the lock is ours, and returns whose it is. Without the disk (UNREAD) the next heartbeat tries again. */
static enum owner write_heartbeat(struct lock *lock)
{
    char count[32];
    pthread_mutex_lock(&lock->beating);
    const double began = now_s();
    const enum owner now = owner_of(lock);
    int fd = now == MINE ? open(lock->path.text, O_WRONLY | O_CLOEXEC | O_NOFOLLOW) : -1;
    if (now == ANOTHERS)
        atomic_store(&lock->lost, true);
    if (fd >= 0) {
        snprintf(count, sizeof count, "%0*llu", COUNT_DIGITS, ++lock->count);
        if (pwrite(fd, count, COUNT_DIGITS, 0) == COUNT_DIGITS && fsync(fd) == 0)
            atomic_store(&lock->beat_s, began);
        close(fd);
    }
    pthread_mutex_unlock(&lock->beating);
    return now;
}

/* Waits use the monotonic clock: if the wall clock were set back, the next heartbeat would be delayed by as much. */
static void init_wake(pthread_cond_t *wake)
{
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(wake, &monotonic);
    pthread_condattr_destroy(&monotonic);
}

static void *heartbeat_thread(void *argument)
{
    struct lock *lock = argument;
    pthread_mutex_lock(&lock->guard);
    while (!lock->ending) {
        struct timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_sec += (time_t)lock->heartbeat_s;
        until.tv_nsec += (long)((lock->heartbeat_s - (double)(time_t)lock->heartbeat_s) * 1e9);
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
        if (pthread_cond_timedwait(&lock->wake, &lock->guard, &until) == ETIMEDOUT && !lock->ending) {
            pthread_mutex_unlock(&lock->guard);
            write_heartbeat(lock);
            pthread_mutex_lock(&lock->guard);
        }
    }
    pthread_mutex_unlock(&lock->guard);
    return NULL;
}

/* ---- taking */

static status fail_held(const char *path, const struct seen *s)
{
    return fail(
        E_OUTPUT,
        "%s: process %ld on %s %s, since %s; wait for it or stop it. If it no longer exists, remove this file",
        path, s->holder.pid, *s->holder.host ? s->holder.host : "an unknown machine",
        *s->what ? s->what : "writes here", *s->since ? s->since : "an unknown time");
}

/* Returns OK if the holder is gone, E_OUTPUT if it is alive. */
static status check_holder(const char *path, const struct seen *first, double watch_s, bool (*stop)(void))
{
    struct seen now;
    const struct process_id *h = &first->holder;
    const enum process_fate fate = process_fate(h);
    if (fate != PROCESS_UNKNOWN)
        return fate == PROCESS_LIVES ? fail_held(path, first) : OK;
    log_info("%s is held by process %ld on %s; watching its heartbeat for %.0f s", path, h->pid,
             *h->host ? h->host : "an unknown machine", watch_s);
    for (double waited = 0; waited < watch_s; waited += WATCH_US * 1e-6) {
        if (stop && stop())
            return fail(STOPPED, "stopped before anything was written; run the same command again");
        usleep(WATCH_US);
        status st = read_lock(path, &now);
        if (st != OK)
            return st;
        if (!now.there)
            return OK;
        if (strcmp(now.token, first->token) != 0 || strcmp(now.count, first->count) != 0)
            return fail_held(path, &now);
    }
    return OK;
}

/* Whether link() failed since the file system has no hard links. */
static bool no_links(int why)
{
    return why == EPERM || why == EOPNOTSUPP || why == ENOSYS || why == EMLINK || why == EINVAL;
}

/* Creates `path` with these bytes if it does not exist. False with errno if it does, or if that fails. */
static bool create_new(const char *path, const void *bytes, size_t n)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (fd < 0)
        return false;
    const bool good = write(fd, bytes, n) == (ssize_t)n && fsync(fd) == 0;
    const int why = good ? 0 : errno ? errno : ENOSPC;
    close(fd);
    if (!good) {
        unlink(path);
        errno = why;
    }
    return good;
}

/* Gives a file that was renamed its name again, unless the name was taken meanwhile. */
static bool put_back(const char *aside, const char *path)
{
    char *bytes = NULL;
    size_t n = 0;
    if (link(aside, path) == 0 || errno == EEXIST)
        return true;
    const bool good = no_links(errno) && file_read(aside, LOCK_BYTES, &bytes, &n) == OK &&
                      (create_new(path, bytes, n) || errno == EEXIST);
    free(bytes);
    return good;
}

/* Renames a stale lock away and removes it. Of several processes that try, one succeeds. If the renamed file turns out not to be the stale
 * lock, because another process has already replaced it, it is put back. */
static status remove_stale(const char *path, const struct seen *stale)
{
    struct path aside;
    struct seen moved;
    status st = OK;
    TRY(atomic_file_temporary(path, "", &aside));
    if (rename(path, aside.text) != 0)
        return errno == ENOENT
                   ? OK
                   : fail(E_OUTPUT, "%s: cannot rename the stale lock: %s", path, strerror(errno));
    st = read_lock(aside.text, &moved);
    const bool is_stale = st == OK && strcmp(moved.token, stale->token) == 0;
    if (!is_stale && !put_back(aside.text, path))
        st = fail(E_OUTPUT, "%s: cannot restore the lock of another process: %s", path, strerror(errno));
    else if (is_stale)
        log_warn("%s was left behind by process %ld on %s (%s, since %s); taking over", path,
                 stale->holder.pid, *stale->holder.host ? stale->holder.host : "an unknown machine",
                 *stale->what ? stale->what : "unknown", *stale->since ? stale->since : "an unknown time");
    unlink(aside.text);
done:
    return st;
}

/* link() fails if the name exists, on NFS too. The reply may be lost there, so the number of links decides. */
static status put_in_place(struct lock *lock, const char *what, bool *mine)
{
    status st = OK;
    struct path own;
    struct text t = {0};
    struct stat info = {0};
    TRY(atomic_file_temporary(lock->path.text, "", &own));
    snprintf(lock->token, sizeof lock->token, "%.95s", own.text + strlen(lock->path.text) + 1);
    TRY(compose(lock, what, &t));
    TRY(atomic_file_write(own.text, t.data, t.size));
    int linked = link(own.text, lock->path.text), why = errno;
    *mine = linked == 0 || (stat(own.text, &info) == 0 && info.st_nlink == 2);
    unlink(own.text);
    if (!*mine && no_links(why)) {
        errno = 0;
        *mine = create_new(lock->path.text, t.data, t.size);
        why = errno;
    }
    if (!*mine && why != EEXIST)
        st =
            fail(E_OUTPUT, "%s: cannot create the lock, which this disk must support by link() or O_EXCL: %s",
                 lock->path.text, strerror(why));
done:
    text_free(&t);
    return st;
}

status lock_take(const char *path, const char *what, struct lock_patience patience, bool (*stop)(void),
                 struct lock **out)
{
    enum { TRIES = 100 };
    status st = OK;
    struct lock *lock = NULL;
    struct seen seen;
    bool mine = false;
    *out = NULL;
    TRY(memory_alloc(1, sizeof *lock, "a lock", &lock));
    TRY(path_format(&lock->path, "%s", path));
    lock->heartbeat_s = patience.heartbeat_s > 0 ? patience.heartbeat_s : HEARTBEAT_S;
    for (int i = 0; i < TRIES && !mine; i++) {
        TRY(put_in_place(lock, what, &mine));
        if (mine)
            break;
        TRY(read_lock(path, &seen));
        if (!seen.there) {
            usleep(i < 10 ? 0 : WATCH_US); /* removed meanwhile, or a shared disk does not show it yet */
            continue;
        }
        TRY(check_holder(path, &seen, patience.watch_s > 0 ? patience.watch_s : WATCH_S, stop));
        TRY(remove_stale(path, &seen));
    }
    if (!mine) {
        st = fail(E_OUTPUT, "%s: other processes keep taking this lock; try again later", path);
        goto done;
    }
    pthread_mutex_init(&lock->guard, NULL);
    pthread_mutex_init(&lock->beating, NULL);
    atomic_store(&lock->beat_s, now_s());
    init_wake(&lock->wake);
    if (pthread_create(&lock->thread, NULL, heartbeat_thread, lock) != 0) {
        unlink(path);
        st = fail(E_MEMORY, "cannot start a thread for the lock");
        goto done;
    }
    *out = lock;
    lock = NULL;
done:
    free(lock);
    return st;
}

status lock_check(struct lock *lock)
{
    if (!lock)
        return OK;
    /* The heartbeat's thread may not have run yet after a suspension. */
    const bool late = now_s() - atomic_load(&lock->beat_s) > 2 * lock->heartbeat_s;
    if (late && !atomic_load(&lock->lost) && write_heartbeat(lock) == UNREAD)
        return fail(E_OUTPUT,
                    "%s cannot be read, so it is not known whether another process took over this folder",
                    lock->path.text);
    if (atomic_load(&lock->lost))
        return fail(E_OUTPUT, "%s: another process took over this folder while this one was suspended",
                    lock->path.text);
    return OK;
}

void lock_sweep(const char *path)
{
    struct seen s;
    status st = read_lock(path, &s);
    if (st == OK && s.there && process_fate(&s.holder) == PROCESS_GONE)
        st = remove_stale(path, &s);
    if (st != OK)
        log_warn("%s", status_message());
}

void lock_release(struct lock **handle)
{
    struct lock *lock = *handle;
    if (!lock)
        return;
    pthread_mutex_lock(&lock->guard);
    lock->ending = true;
    pthread_cond_signal(&lock->wake);
    pthread_mutex_unlock(&lock->guard);
    pthread_join(lock->thread, NULL);
    pthread_cond_destroy(&lock->wake);
    pthread_mutex_destroy(&lock->guard);
    pthread_mutex_destroy(&lock->beating);
    if (owner_of(lock) == MINE)
        unlink(lock->path.text);
    free(lock);
    *handle = NULL;
}
