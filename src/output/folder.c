#include "output/folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/atomic_file.h"
#include "base/json.h"
#include "base/memory.h"

static const struct {
    const char *folder, *extension;
} layout[] = {
    [FILE_POINTS] = {"points", "vdb"},
    [FILE_VOLUMES] = {"volumes", "vdb"},
    [FILE_AOV] = {"aov", "exr"},
    [FILE_MANIFEST] = {"frames", "json"},
    [FILE_CHECKPOINT] = {"checkpoint", "ckpt"},
    [FILE_MESH] = {"mesh", "ply"},
    [FILE_ROCKS] = {"rocks", "vdb"},
    [FILE_ROCKS_USD] = {"rocks", "usdc"},
    [FILE_STACKS] = {"stacks", "stacks"},
    [FILE_USD] = {"points", "usdc"},
};

/* Made by who fills them: rocks and stacks by the writer, the others by their verbs: mesh, preview, turntable, report, log. */
static const enum folder_file always[] = {FILE_POINTS, FILE_VOLUMES, FILE_AOV, FILE_MANIFEST,
                                          FILE_CHECKPOINT};

/* "1001", "0007", "-0012" */
static void frame_text(int frame, char out[16])
{
    snprintf(out, 16, "%s%04d", frame < 0 ? "-" : "", abs(frame));
}

status folder_path(char out[4096], const char *root, const char *name, enum folder_file kind, int frame,
                   const char *camera)
{
    char number[16];
    frame_text(frame, number);
    const bool with_camera = kind == FILE_AOV && camera;
    const int n = snprintf(out, 4096, "%s/%s/%s%s%s.%s.%s", root, layout[kind].folder, name,
                           with_camera ? "." : "", with_camera ? camera : "", number, layout[kind].extension);
    if (n < 0 || n >= 4096)
        return fail(E_OUTPUT, "%.200s...: the path of frame %d is too long", root, frame);
    return OK;
}

status folder_prepare(const char *root)
{
    status st = OK;
    char path[4096];
    TRY(folder_make(root));
    atomic_file_sweep(root);
    for (size_t i = 0; i < sizeof always / sizeof *always; i++) {
        if (snprintf(path, sizeof path, "%s/%s", root, layout[always[i]].folder) >= (int)sizeof path) {
            st = fail(E_OUTPUT, "%.200s...: the path is too long", root);
            goto done;
        }
        TRY(folder_make(path));
        atomic_file_sweep(path);
    }
    if (snprintf(path, sizeof path, "%s/log", root) < (int)sizeof path)
        TRY(folder_make(path));
done:
    return st;
}

/* The frame that `file` is the manifest of, if it is one of `name`, written as folder_path() writes it. */
static bool manifest_frame(const char *file, const char *name, int *frame)
{
    char number[16], expected[512], *end;
    const size_t n = strlen(name);
    if (strncmp(file, name, n) != 0 || file[n] != '.')
        return false;
    errno = 0;
    const long value = strtol(file + n + 1, &end, 10);
    if (errno != 0 || end == file + n + 1 || value < -9999999 || value > 9999999)
        return false;
    frame_text((int)value, number);
    if (snprintf(expected, sizeof expected, "%s.%s.json", name, number) >= (int)sizeof expected ||
        strcmp(file, expected) != 0)
        return false;
    *frame = (int)value;
    return true;
}

static int compare_frames(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

status folder_frames(const char *root, const char *name, int **frames, size_t *n)
{
    status st = OK;
    char path[4096];
    int *found = NULL;
    size_t count = 0, capacity = 0;
    DIR *d = NULL;
    if (snprintf(path, sizeof path, "%s/%s", root, layout[FILE_MANIFEST].folder) >= (int)sizeof path) {
        st = fail(E_INPUT, "%.200s...: the path is too long", root);
        goto done;
    }
    TRY(memory_grow(&found, &capacity, 1, sizeof *found, "frame numbers"));
    d = opendir(path);
    if (!d && errno != ENOENT) {
        st = fail(E_INPUT, "%s: %s", path, strerror(errno));
        goto done;
    }
    for (struct dirent *e; d && (e = readdir(d));) {
        TRY(memory_grow(&found, &capacity, count + 1, sizeof *found, "frame numbers"));
        count += manifest_frame(e->d_name, name, &found[count]);
    }
    qsort(found, count, sizeof *found, compare_frames);
    *frames = found;
    *n = count;
    found = NULL;
done:
    if (d)
        closedir(d);
    free(found);
    return st;
}

/* What a job may be called (keys.def): it becomes part of paths. */
static bool is_name(const char *name)
{
    const size_t n = strlen(name);
    return n > 0 && n < 200 &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == n;
}

status folder_open(const char *root, char name[256])
{
    status st = OK;
    char path[4096], *bytes = NULL;
    size_t size = 0;
    struct json *run = NULL;
    struct stat info;
    const char *text;
    if (snprintf(path, sizeof path, "%s/run.json", root) >= (int)sizeof path) {
        st = fail(E_INPUT, "%.200s...: the path is too long", root);
        goto done;
    }
    if (stat(path, &info) != 0) {
        st = fail(E_INPUT, "%s: not an output folder of hoodoo: %s: %s", root, path, strerror(errno));
        goto done;
    }
    TRY(file_read(path, 16 << 20, &bytes, &size));
    TRY(json_read(path, bytes, size, &run));
    text = json_to_text(json_member(run, "name"));
    if (!text || !is_name(text)) {
        st = fail(E_INPUT, "%s: no job name in it (letters, digits, _ and -)", path);
        goto done;
    }
    snprintf(name, 256, "%s", text);
    snprintf(path, sizeof path, "%s/job.yaml", root);
    if (stat(path, &info) != 0)
        st = fail(E_INPUT, "%s: %s: the folder has lost its job", path, strerror(errno));
done:
    if (run)
        json_free(&run);
    free(bytes);
    return st;
}
