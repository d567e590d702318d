/* hoodoo mesh OUT: each frame's surface as triangles, in PLY (with its fields) and OBJ. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/cli.h"
#include "cli/progress.h"
#include "job/job.h"
#include "output/folder.h"
#include "output/vdb.h"

/* A job without water, plants or deposits has no such grids: 0. */
static const char *const values[] = {"stress",    "von_mises",  "viability",
                                     "discharge", "vegetation", "deposit"};
enum { VALUES = sizeof values / sizeof *values, OPTIONAL = 3 };

/* To the files' up axis. */
static void turn(const float from[3], int up, float to[3])
{
    to[0] = from[0];
    to[1] = up == OUTPUT_UP_Y ? from[2] : from[1];
    to[2] = up == OUTPUT_UP_Y ? -from[1] : from[2];
}

/* Binary, little endian, as this machine's floats are. */
static void add_ply(struct text *out, const struct vdb_mesh *m, const struct job *job, int frame)
{
    text_add(out,
             "ply\nformat binary_little_endian 1.0\ncomment hoodoo %s: %s, frame %d; metres, %s up\n"
             "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n"
             "property float nx\nproperty float ny\nproperty float nz\n",
             hoodoo_version, job->name, frame, job->output.up == OUTPUT_UP_Y ? "y" : "z", m->n_vertices);
    for (int v = 0; v < VALUES; v++)
        text_add(out, "property float %s\n", values[v]);
    text_add(out, "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n", m->n_triangles);
    for (size_t i = 0; i < m->n_vertices; i++) {
        float row[6 + VALUES];
        turn(m->vertex + 3 * i, job->output.up, row);
        turn(m->normal + 3 * i, job->output.up, row + 3);
        for (size_t v = 0; v < VALUES; v++)
            row[6 + v] = m->value[v * m->n_vertices + i];
        text_add_bytes(out, row, sizeof row);
    }
    for (size_t i = 0; i < m->n_triangles; i++) {
        text_add_bytes(out, "\3", 1);
        text_add_bytes(out, m->triangle + 3 * i, 3 * sizeof *m->triangle);
    }
}

static void add_obj(struct text *out, const struct vdb_mesh *m, const struct job *job, int frame)
{
    text_add(out, "# hoodoo %s: %s, frame %d; metres, %s up\no %s\n", hoodoo_version, job->name, frame,
             job->output.up == OUTPUT_UP_Y ? "y" : "z", job->name);
    for (int kind = 0; kind < 2; kind++)
        for (size_t i = 0; i < m->n_vertices; i++) {
            float at[3];
            turn((kind ? m->normal : m->vertex) + 3 * i, job->output.up, at);
            text_add(out, "%s %.6g %.6g %.6g\n", kind ? "vn" : "v", (double)at[0], (double)at[1],
                     (double)at[2]);
        }
    for (size_t i = 0; i < m->n_triangles; i++) {
        const uint32_t *t = m->triangle + 3 * i;
        text_add(out, "f %u//%u %u//%u %u//%u\n", t[0] + 1, t[0] + 1, t[1] + 1, t[1] + 1, t[2] + 1, t[2] + 1);
    }
}

static status write_frame(const char *root, const struct job *job, int frame, double adaptivity)
{
    status st = OK;
    char path[4096];
    struct vdb_mesh mesh = {0};
    struct text text = {0};
    TRY(folder_path(path, root, job->name, FILE_VOLUMES, frame, NULL));
    TRY(vdb_mesh_read(path, adaptivity, values, VALUES, OPTIONAL, &mesh));
    TRY(folder_path(path, root, job->name, FILE_MESH, frame, NULL));
    add_ply(&text, &mesh, job, frame);
    TRY(text_status(&text));
    TRY(atomic_file_write(path, text.data, text.size));
    text_free(&text);
    add_obj(&text, &mesh, job, frame);
    TRY(text_status(&text));
    strcpy(path + strlen(path) - 3, "obj");
    TRY(atomic_file_write(path, text.data, text.size));
done:
    text_free(&text);
    vdb_mesh_free(&mesh);
    return st;
}

/* Are the frame's meshes there, no older than its volumes? */
static bool current(const char *root, const char *name, int frame)
{
    char path[4096];
    struct stat from, ply, obj;
    if (folder_path(path, root, name, FILE_VOLUMES, frame, NULL) != OK || stat(path, &from) != 0 ||
        folder_path(path, root, name, FILE_MESH, frame, NULL) != OK || stat(path, &ply) != 0)
        return false;
    strcpy(path + strlen(path) - 3, "obj");
    return stat(path, &obj) == 0 && ply.st_mtim.tv_sec >= from.st_mtim.tv_sec &&
           obj.st_mtim.tv_sec >= from.st_mtim.tv_sec;
}

status cli_mesh(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct words operands = {0};
    struct job *job = NULL;
    int *frames = NULL;
    size_t n, n_found = 0;
    double adaptivity = 0;
    char name[256], path[4300];
    struct progress progress = {0};
    char root[4096];
    int wedge = 0;
    bool help = false, missing = false, allow_none = false;
    const struct option options[] = {
        OPTION_FRAMES(&c),
        {"adaptivity", "SHARE", OPTION_NUMBER, &adaptivity,
         "0 to 1: larger merges flat parts into fewer triangles (default 0)"},
        {"missing", NULL, OPTION_FLAG, &missing,
         "only meshes that are not there, or older than their volumes"},
        {"allow-none", NULL, OPTION_FLAG, &allow_none, "frames without volumes are no error"},
        OPTION_WEDGE(&wedge),
        OPTION_PROGRESS(&c),
    };
    TRY(options_parse(&usage_mesh, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    TRY(wedge_folder(operands.word[0], wedge, root));
    if (!(adaptivity >= 0 && adaptivity <= 1)) {
        st = fail(E_USAGE, "--adaptivity %g: 0 to 1", adaptivity);
        goto done;
    }
    TRY(folder_open(root, name));
    snprintf(path, sizeof path, "%.4096s/job.yaml", root);
    TRY(job_load(path, NULL, 0, &job));
    snprintf(path, sizeof path, "%.4096s/mesh", root);
    TRY(folder_make(path));
    TRY(folder_frames(root, job->name, &frames, &n));
    progress_begin_notes(&progress, (enum progress_style)c.progress);
    for (size_t i = 0; i < n; i++) {
        char line[64];
        if (c.frames.step && !range_holds(c.frames, frames[i]))
            continue;
        TRY(folder_path(path, root, job->name, FILE_VOLUMES, frames[i], NULL));
        if (access(path, R_OK) != 0)
            continue;
        n_found++;
        if (missing && current(root, job->name, frames[i]))
            continue;
        TRY(write_frame(root, job, frames[i], adaptivity));
        snprintf(line, sizeof line, "mesh of frame %d", frames[i]);
        progress_note(&progress, i + 1, n, line);
    }
    if (n_found == 0 && !allow_none)
        st = fail(E_INPUT, "%s holds no volumes of the frames asked for; run the job first", root);
done:
    progress_end(&progress);
    free(frames);
    job_destroy(&job);
    words_free(&operands);
    common_free(&c);
    return st;
}
