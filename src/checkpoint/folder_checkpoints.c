/* The folder root/checkpoint: saving, pruning, listing. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "checkpoint/checkpoint.h"
#include "output/folder.h"
#include "system/atomic_file.h"

static int newest_first(const void *a, const void *b)
{
    int x = *(const int *)a, y = *(const int *)b;
    return (x < y) - (x > y);
}

status checkpoint_list(const char *root, const char *name, int **frames, size_t *n)
{
    *frames = NULL;
    *n = 0;
    const status st = folder_list(root, name, FILE_CHECKPOINT, frames, n);
    if (st == OK)
        qsort(*frames, *n, sizeof **frames, newest_first);
    return st;
}

/* Of the checkpoints up to frame `saved`, keeps the newest `keep`. Later ones are left from a run that got farther and was started
 * over; they are not counted, since the checkpoint just written would otherwise be the oldest and be removed. */
static status prune(const char *root, const char *name, int saved, int keep)
{
    status st = OK;
    int *frames = NULL, newer = 0;
    size_t n = 0;
    struct path path;
    TRY(checkpoint_list(root, name, &frames, &n));
    for (size_t i = 0; i < n; i++) {
        if (frames[i] > saved || newer++ < keep)
            continue;
        TRY(folder_path(&path, root, name, FILE_KEEP, frames[i], NULL));
        if (access(path.text, F_OK) == 0)
            continue;
        TRY(folder_path(&path, root, name, FILE_CHECKPOINT, frames[i], NULL));
        if (unlink(path.text) != 0 && errno != ENOENT)
            log_warn("%s: cannot remove this old checkpoint: %s", path.text, strerror(errno));
    }
done:
    free(frames);
    return st;
}

status checkpoint_mark(const char *root, const char *name, int frame)
{
    status st = OK;
    struct path path, folder;
    TRY(folder_path(&path, root, name, FILE_KEEP, frame, NULL));
    if (access(path.text, F_OK) == 0)
        goto done;
    TRY(path_folder(&folder, path.text));
    TRY(folder_make(folder.text));
    TRY(atomic_file_write(path.text, "", 0));
done:
    return st;
}

status checkpoint_save(const char *root, const char *name, const struct checkpoint *c, int keep)
{
    status st = OK;
    void *bytes = NULL;
    size_t size = 0;
    struct path path, folder;
    TRY(folder_path(&path, root, name, FILE_CHECKPOINT, c->frame, NULL));
    TRY(path_folder(&folder, path.text));
    TRY(folder_make(folder.text));
    TRY(checkpoint_encode(c, &bytes, &size));
    TRY(atomic_file_write(path.text, bytes, size));
    /* The checkpoint is written, so failing to remove old ones only costs disk space. */
    if (prune(root, name, c->frame, keep > 0 ? keep : 1) != OK)
        log_warn("%s: old checkpoints are not removed: %s", root, status_message());
done:
    free(bytes);
    return st;
}
