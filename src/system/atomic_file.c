#include "system/atomic_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "base/memory.h"
#include "system/process.h"

static const char TEMPORARY[] = ".tmp-";

status atomic_file_temporary(const char *path, const char *ending, struct path *out)
{
    static atomic_uint count;
    struct timeval now;
    gettimeofday(&now, NULL);
    return path_format(out, "%s%s%08x-%ld-%lx%05lx-%u%s", path, TEMPORARY, process_place(), (long)getpid(),
                       (unsigned long)now.tv_sec, (unsigned long)now.tv_usec, atomic_fetch_add(&count, 1),
                       ending);
}

static struct {
    status (*check)(void *user);
    void *user;
} guard;

void atomic_file_guard(status (*check)(void *user), void *user)
{
    guard.check = check;
    guard.user = user;
}

static status move(const char *temporary, const char *path)
{
    const status st = guard.check ? guard.check(guard.user) : OK;
    if (st == OK && rename(temporary, path) != 0)
        return fail(E_OUTPUT, "%s: cannot rename into place: %s", path, strerror(errno));
    return st;
}

static status fsync_folder_of(const char *path)
{
    struct path folder;
    status st = path_folder(&folder, path);
    if (st != OK)
        return st;
    int fd = open(folder.text, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0)
        return fail(E_OUTPUT, "%s: cannot open the folder: %s", folder.text, strerror(errno));
    /* Some network file systems do not support fsync on folders (EINVAL), which has to be accepted. */
    int bad = fsync(fd) != 0 && errno != EINVAL ? errno : 0;
    close(fd);
    return bad ? fail(E_OUTPUT, "%s: cannot fsync the folder: %s", folder.text, strerror(bad)) : OK;
}

status atomic_file_begin(const char *path, struct draft *d)
{
    status st = OK;
    *d = (struct draft){0};
    TRY(path_format(&d->path, "%s", path));
    TRY(atomic_file_temporary(path, "", &d->temporary));
    d->fd = open(d->temporary.text, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (d->fd < 0)
        return fail(E_OUTPUT, "%s: cannot be written: %s", path, strerror(errno));
    d->on_disk = true;
done:
    return st;
}

status atomic_file_finish(struct draft *d)
{
    status st = OK;
    const struct path path = d->path;
    TRY(draft_flush(d));
    if (fsync(d->fd) != 0)
        st = fail(E_OUTPUT, "%s: cannot fsync: %s", path.text, strerror(errno));
    d->on_disk = false;
    if (close(d->fd) != 0 && st == OK)
        st = fail(E_OUTPUT, "%s: cannot close: %s", path.text, strerror(errno));
    if (st == OK)
        st = move(d->temporary.text, path.text);
    if (st != OK)
        unlink(d->temporary.text);
done:
    draft_drop(d);
    return st == OK ? fsync_folder_of(path.text) : st;
}

status atomic_file_write(const char *path, const void *bytes, size_t n)
{
    struct draft d;
    status st = atomic_file_begin(path, &d);
    if (st == OK)
        st = draft_append(&d, bytes, n);
    if (st == OK)
        return atomic_file_finish(&d);
    draft_drop(&d);
    return st;
}

status atomic_file_adopt(const char *temporary, const char *path)
{
    status st = OK;
    int fd = open(temporary, O_RDWR | O_CLOEXEC);
    if (fd < 0)
        return fail(E_OUTPUT, "%s: cannot open the temporary file: %s", path, strerror(errno));
    if (fsync(fd) != 0)
        st = fail(E_OUTPUT, "%s: cannot fsync: %s", path, strerror(errno));
    if (close(fd) != 0 && st == OK)
        st = fail(E_OUTPUT, "%s: cannot close: %s", path, strerror(errno));
    if (st == OK)
        st = move(temporary, path);
    if (st != OK) {
        unlink(temporary);
        return st;
    }
    return fsync_folder_of(path);
}

status folder_make(const char *path)
{
    struct path whole;
    status st = path_format(&whole, "%s", path);
    if (st != OK)
        return st;
    char *part = whole.text;
    const size_t n = strlen(part);
    if (n == 0)
        return fail(E_OUTPUT, "the name of a folder is empty");
    for (size_t i = 1; i <= n; i++) {
        if (part[i] != '/' && part[i] != '\0')
            continue;
        char keep = part[i];
        part[i] = '\0';
        struct stat info;
        if (mkdir(part, 0777) != 0 && (errno != EEXIST || stat(part, &info) != 0 || !S_ISDIR(info.st_mode)))
            return fail(E_OUTPUT, "%s: cannot create the folder: %s", part,
                        strerror(errno == EEXIST ? ENOTDIR : errno));
        part[i] = keep;
    }
    return OK;
}

/* The place and process that a temporary file belongs to. */
static bool temporary_of(const char *name, unsigned *whose, long *pid)
{
    const char *tail = strstr(name, TEMPORARY);
    return tail && sscanf(tail + strlen(TEMPORARY), "%8x-%ld-", whose, pid) == 2;
}

/* The time by the clock of the folder's disk, which dates files: that of this machine may be days ahead. 0: not known. */
static time_t disk_time(int folder)
{
    struct path name;
    struct stat info;
    time_t now = 0;
    if (atomic_file_temporary("now", "", &name) != OK)
        return 0;
    const int fd = openat(folder, name.text, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        return 0;
    if (fstat(fd, &info) == 0)
        now = info.st_mtime;
    close(fd);
    unlinkat(folder, name.text, 0);
    return now;
}

/* Whether a temporary file was left behind: its process on this machine has ended, or it is a day old. Process numbers of another
 * container or boot have no meaning here, so their files are only removed after a day. *now: disk_time(), once it is needed. */
static bool abandoned(const char *name, int folder, time_t *now)
{
    enum { DAY_S = 24 * 60 * 60 };
    unsigned whose;
    long pid;
    struct stat info;
    if (!temporary_of(name, &whose, &pid) || fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) != 0)
        return false;
    if (whose == process_place() && pid > 0)
        return kill((pid_t)pid, 0) != 0 && errno == ESRCH;
    if (!*now)
        *now = disk_time(folder);
    return *now && *now - info.st_mtime > DAY_S;
}

static bool own(const char *name, int folder, time_t *now)
{
    unsigned whose;
    long pid;
    (void)folder;
    (void)now;
    return temporary_of(name, &whose, &pid) && whose == process_place() && pid == (long)getpid();
}

static void sweep(const char *folder, bool (*goes)(const char *name, int folder, time_t *now))
{
    DIR *d = opendir(folder);
    time_t now = 0;
    if (!d)
        return;
    for (struct dirent *e; (e = readdir(d));)
        if (goes(e->d_name, dirfd(d), &now))
            unlinkat(dirfd(d), e->d_name, 0);
    closedir(d);
}

void atomic_file_sweep(const char *folder)
{
    sweep(folder, abandoned);
}

void atomic_file_sweep_own(const char *folder)
{
    sweep(folder, own);
}

status file_read(const char *path, size_t limit, void *bytes, size_t *n)
{
    status st = OK;
    char *data = NULL;
    struct stat info;
    size_t size = 0;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* does not block on a pipe */
    if (fd < 0 || fstat(fd, &info) != 0) {
        st = fail(E_INPUT, "%s: %s", path, strerror(errno));
        goto done;
    }
    if (!S_ISREG(info.st_mode)) {
        st = fail(E_INPUT, "%s: not a regular file", path);
        goto done;
    }
    if ((size_t)info.st_size > limit) {
        st = fail(E_INPUT, "%s: %lld bytes, more than the %zu allowed here", path, (long long)info.st_size,
                  limit);
        goto done;
    }
    size = (size_t)info.st_size;
    TRY(memory_alloc(size + 1, 1, path, &data));
    for (size_t got = 0; got < size;) {
        ssize_t k = read(fd, data + got, size - got);
        if (k < 0 && errno == EINTR)
            continue;
        if (k <= 0) {
            st = fail(E_INPUT, "%s: read %zu of %zu bytes: %s", path, got, size,
                      k < 0 ? strerror(errno) : "the file shrank");
            goto done;
        }
        got += (size_t)k;
    }
    memcpy(bytes, &data, sizeof data);
    *n = size;
    data = NULL;
done:
    if (fd >= 0)
        close(fd);
    free(data);
    return st;
}
