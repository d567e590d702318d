/* The folder root/checkpoint: saving, pruning, listing. */
#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/log.h"
#include "base/memory.h"
#include "checkpoint/checkpoint.h"

/* Frames have at least four digits, as everywhere in the output folder: NAME.0007.ckpt, NAME.-0012.ckpt. */
static const char *sign(int frame)
{
    return frame < 0 ? "-" : "";
}

static status checkpoint_path(char out[4096], const char *root, const char *name, int frame,
                              const char *suffix)
{
    int n = snprintf(out, 4096, "%s/checkpoint/%s.%s%04d.%s", root, name, sign(frame), abs(frame), suffix);
    return n < 0 || n >= 4096 ? fail(E_OUTPUT, "%.200s...: the path is too long", root) : OK;
}

static int newest_first(const void *a, const void *b)
{
    int x = *(const int *)a, y = *(const int *)b;
    return (x < y) - (x > y);
}

/* Is `file` NAME.FRAME.ckpt exactly as checkpoint_path() writes it? */
static bool is_checkpoint(const char *file, const char *name, int *frame)
{
    char again[512];
    size_t n = strlen(name);
    if (strncmp(file, name, n) != 0 || file[n] != '.')
        return false;
    errno = 0;
    long number = strtol(file + n + 1, NULL, 10);
    if (errno || number < -999999 || number > 9999999)
        return false;
    *frame = (int)number;
    int length = snprintf(again, sizeof again, "%s.%s%04d.ckpt", name, sign(*frame), abs(*frame));
    return length > 0 && (size_t)length < sizeof again && strcmp(file, again) == 0;
}

status checkpoint_list(const char *root, const char *name, int **frames, size_t *n)
{
    status st = OK;
    char folder[4096];
    size_t capacity = 0;
    int frame;
    DIR *d = NULL;
    *frames = NULL;
    *n = 0;
    if (snprintf(folder, sizeof folder, "%s/checkpoint", root) >= (int)sizeof folder)
        return fail(E_INPUT, "%.200s...: the path is too long", root);
    TRY(memory_grow(frames, &capacity, 1, sizeof **frames, "the checkpoints' frames"));
    if (!(d = opendir(folder))) {
        if (errno != ENOENT)
            st = fail(E_INPUT, "%s: %s", folder, strerror(errno));
        goto done;
    }
    for (struct dirent *e; (e = readdir(d));) {
        if (!is_checkpoint(e->d_name, name, &frame))
            continue;
        TRY(memory_grow(frames, &capacity, *n + 1, sizeof **frames, "the checkpoints' frames"));
        (*frames)[(*n)++] = frame;
    }
    qsort(*frames, *n, sizeof **frames, newest_first);
done:
    if (d)
        closedir(d);
    if (st != OK) {
        free(*frames);
        *frames = NULL;
        *n = 0;
    }
    return st;
}

/* Of the checkpoints up to `saved`, leaves the newest `keep`. Later ones are another run's, or the same job's
 * before it was told to start over: they do not count, lest the one just written be the oldest. */
static status prune(const char *root, const char *name, int saved, int keep)
{
    status st = OK;
    int *frames = NULL, newer = 0;
    size_t n = 0;
    char path[4096];
    TRY(checkpoint_list(root, name, &frames, &n));
    for (size_t i = 0; i < n; i++) {
        if (frames[i] > saved || newer++ < keep)
            continue;
        TRY(checkpoint_path(path, root, name, frames[i], "keep"));
        if (access(path, F_OK) == 0)
            continue;
        TRY(checkpoint_path(path, root, name, frames[i], "ckpt"));
        if (unlink(path) != 0 && errno != ENOENT)
            log_warn("%s: an old checkpoint cannot be removed: %s", path, strerror(errno));
    }
done:
    free(frames);
    return st;
}

status checkpoint_mark(const char *root, const char *name, int frame)
{
    status st = OK;
    char path[4096], folder[4096];
    TRY(checkpoint_path(path, root, name, frame, "keep"));
    if (access(path, F_OK) == 0)
        goto done;
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    TRY(folder_make(folder));
    TRY(atomic_file_write(path, "", 0));
done:
    return st;
}

status checkpoint_save(const char *root, const char *name, const struct checkpoint *c, int keep)
{
    status st = OK;
    void *bytes = NULL;
    size_t size = 0;
    char path[4096], folder[4096];
    TRY(checkpoint_path(path, root, name, c->frame, "ckpt"));
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    TRY(folder_make(folder));
    TRY(checkpoint_encode(c, &bytes, &size));
    TRY(atomic_file_write(path, bytes, size));
    /* The work is safe: what goes wrong from here on costs disk space, not the run. */
    if (prune(root, name, c->frame, keep > 0 ? keep : 1) != OK)
        log_warn("%s: old checkpoints stay: %s", root, status_message());
done:
    free(bytes);
    return st;
}
