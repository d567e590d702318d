#include "output/folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "output/product.h"
#include "system/atomic_file.h"
#include "text/json.h"

#define ORBITS "turntable"
static const char FIRST_VIEW[] = "000.png";

static const struct {
    const char *folder, *extension;
} layout[] = {
    [FILE_POINTS] = {"points", "vdb"},
    [FILE_VOLUMES] = {"volumes", "vdb"},
    [FILE_AOV] = {"aov", "exr"},
    [FILE_MANIFEST] = {"frames", "json"},
    [FILE_CHECKPOINT] = {"checkpoint", "ckpt"},
    [FILE_KEEP] = {"checkpoint", "keep"},
    [FILE_MESH] = {"mesh", "ply"},
    [FILE_OBJ] = {"mesh", "obj"},
    [FILE_USD] = {"points", "usdc"},
    [FILE_ROCKS] = {"rocks", "vdb"},
    [FILE_ROCKS_USD] = {"rocks", "usdc"},
    [FILE_STACKS] = {"stacks", "stacks"},
    [FILE_STILL] = {"preview", "png"},
    [FILE_STILL_SCENE] = {"preview", "pov"},
    [FILE_ORBIT_SCENE] = {ORBITS, "pov"},
    [FILE_SHEET] = {NULL, "contact.png"},
    [FILE_VIDEO] = {NULL, "turntable.mp4"},
    [FILE_WEDGES] = {NULL, "wedges.png"},
    [FILE_STAGE] = {NULL, "usda"},
    [FILE_WIND] = {"wind", "vdb"},
    [FILE_MESH_USD] = {"mesh", "usdc"},
    [FILE_VOXELS] = {"voxels", "voxels"},
};
/* The folders that folder_prepare() creates. The others are created when they are first needed: rocks, stacks, voxels and wind by the writer,
 * mesh, preview, turntable and report by their verbs. */
static const enum folder_file always[] = {FILE_POINTS, FILE_VOLUMES, FILE_AOV, FILE_MANIFEST,
                                          FILE_CHECKPOINT};

status folder_name(struct path *out, const char *name, enum folder_file kind, int frame, const char *part)
{
    char number[FRAME_TEXT];
    const char *dot = part ? "." : "", *extension = layout[kind].extension;
    part = part ? part : "";
    if (!layout[kind].folder)
        return path_format(out, "%s%s%s.%s", name, dot, part, extension);
    return path_format(out, "%s/%s%s%s.%s.%s", layout[kind].folder, name, dot, part,
                       frame_text(frame, number), extension);
}

/* `view` is the number of the view as text, or a pattern for it. */
static status view_name(struct path *out, const char *name, const char *part, int frame, const char *view)
{
    char number[FRAME_TEXT];
    return path_format(out, "%s/%s%s%s.%s.%s.png", ORBITS, name, part ? "." : "", part ? part : "",
                       frame_text(frame, number), view);
}

status folder_view(struct path *out, const char *name, const char *part, int frame, int view)
{
    char number[FRAME_TEXT];
    snprintf(number, sizeof number, "%03d", view);
    return view_name(out, name, part, frame, number);
}

status folder_views(struct path *out, const char *name, const char *part, int frame)
{
    /* Names have only letters, digits, _ and -, so this is the only '%'. */
    return view_name(out, name, part, frame, "%03d");
}

status folder_path(struct path *out, const char *root, const char *name, enum folder_file kind, int frame,
                   const char *part)
{
    struct path below;
    const status st = folder_name(&below, name, kind, frame, part);
    return st == OK ? path_join(out, root, below.text) : st;
}

status folder_check_length(const char *root)
{
    /* Bytes for a wedge's folder, a folder in it, a job's name of up to 200 letters, a part, a number, and the suffix of temporary
     * names. */
    enum { BELOW = 512, LONGEST = PATH_BYTES - 1 - BELOW };
    const size_t n = strlen(root);
    return n <= LONGEST
               ? OK
               : fail(
                     E_OUTPUT,
                     "%.100s...: the output folder's path is %zu bytes long; the limit is %d, so that its files' paths fit",
                     root, n, LONGEST);
}

/* Also sweeps folders up to `depth` levels below. */
static void sweep(const char *folder, int depth)
{
    struct path path;
    struct stat info;
    atomic_file_sweep(folder);
    DIR *d = depth ? opendir(folder) : NULL;
    for (struct dirent *e; d && (e = readdir(d));)
        if (e->d_name[0] != '.' && path_join(&path, folder, e->d_name) == OK &&
            lstat(path.text, &info) == 0 && S_ISDIR(info.st_mode))
            sweep(path.text, depth - 1);
    if (d)
        closedir(d);
}

void folder_sweep(const char *root)
{
    enum { RECORDS_OF_MESHES = 2 }; /* OUT/records/mesh is as deep as files are written */
    sweep(root, RECORDS_OF_MESHES);
}

status folder_prepare(const char *root)
{
    status st = OK;
    struct path path;
    TRY(folder_check_length(root));
    TRY(folder_make(root));
    folder_sweep(root);
    for (size_t i = 0; i < sizeof always / sizeof *always; i++) {
        TRY(path_join(&path, root, layout[always[i]].folder));
        TRY(folder_make(path.text));
    }
    TRY(path_join(&path, root, "log"));
    TRY(folder_make(path.text));
done:
    return st;
}

/* Parses the frame from a file name NAME.FRAME.ENDING. */
static bool frame_of(const char *file, const char *name, const char *ending, int *frame)
{
    const size_t n = strlen(name);
    if (strncmp(file, name, n) != 0 || file[n] != '.')
        return false;
    const char *number = file + n + 1, *dot = strchr(number, '.');
    return dot && strcmp(dot + 1, ending) == 0 && frame_parse(number, (size_t)(dot - number), frame);
}

static int compare_frames(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

static status list(const char *root, const char *folder, const char *name, const char *ending, int **frames,
                   size_t *n)
{
    status st = OK;
    struct path path;
    int *found = NULL;
    size_t count = 0, capacity = 0;
    DIR *d = NULL;
    TRY(path_join(&path, root, folder));
    TRY(memory_grow(&found, &capacity, 1, sizeof *found, "frame numbers"));
    d = opendir(path.text);
    if (!d && errno != ENOENT) {
        st = fail(E_INPUT, "%s: %s", path.text, strerror(errno));
        goto done;
    }
    for (struct dirent *e; d && (e = readdir(d));) {
        TRY(memory_grow(&found, &capacity, count + 1, sizeof *found, "frame numbers"));
        count += frame_of(e->d_name, name, ending, &found[count]);
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

status folder_list(const char *root, const char *name, enum folder_file kind, int **frames, size_t *n)
{
    return list(root, layout[kind].folder, name, layout[kind].extension, frames, n);
}

status folder_orbits(const char *root, const char *name, int **frames, size_t *n)
{
    return list(root, ORBITS, name, FIRST_VIEW, frames, n);
}

status folder_frames(const char *root, const char *name, int **frames, size_t *n)
{
    return folder_list(root, name, FILE_MANIFEST, frames, n);
}

/* Whether a text is a valid job name (keys.def), since it becomes part of paths. */
static bool is_name(const char *name)
{
    const size_t n = strlen(name);
    return n > 0 && n < 200 &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == n;
}

/* root/run.json, parsed. */
static status read_run(const char *root, struct json **out)
{
    status st = OK;
    struct path path;
    char *bytes = NULL;
    size_t size = 0;
    struct stat info;
    TRY(path_join(&path, root, "run.json"));
    if (stat(path.text, &info) != 0) {
        st = fail(E_INPUT, "%s: not an output folder of hoodoo: %s: %s", root, path.text, strerror(errno));
        goto done;
    }
    TRY(file_read(path.text, 16 << 20, &bytes, &size));
    TRY(json_read(path.text, bytes, size, out));
done:
    free(bytes);
    return st;
}

status folder_open(const char *root, char name[256])
{
    status st = OK;
    struct path path;
    struct json *run = NULL;
    struct stat info;
    const char *text;
    TRY(read_run(root, &run));
    text = json_to_text(json_member(run, "name"));
    if (!text || !is_name(text)) {
        st = fail(E_INPUT, "%s/run.json: it has no job name (letters, digits, _ and -)", root);
        goto done;
    }
    snprintf(name, 256, "%s", text);
    TRY(path_join(&path, root, "job.yaml"));
    if (stat(path.text, &info) != 0)
        st = fail(E_INPUT, "%s: %s: the folder has lost its job.yaml", path.text, strerror(errno));
done:
    if (run)
        json_free(&run);
    return st;
}

status folder_job_hash(const char *root, uint64_t *hash)
{
    status st = OK;
    struct json *run = NULL;
    const char *text;
    int end = 0;
    unsigned long long number;
    TRY(read_run(root, &run));
    text = json_to_text(json_member(run, "job_hash"));
    if (!text || sscanf(text, "%16llx%n", &number, &end) != 1 || end != 16 || text[end])
        st = fail(E_INPUT, "%s/run.json: it has no hash of the job", root);
    else
        *hash = number;
done:
    if (run)
        json_free(&run);
    return st;
}
