/* hoodoo mesh OUT: writes each frame's surface as a triangle mesh, in PLY (with vertex values), OBJ and USD. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "cli/await.h"
#include "cli/cli.h"
#include "frame/meshes.h"
#include "frame/stage.h"
#include "job/job.h"
#include "output/folder.h"
#include "run/owner.h"
#include "system/atomic_file.h"
#include "system/progress.h"
#include "system/signals.h"
#include "text/text.h"

/* Lists the meshes in the USD stage, and repeats this as long as other tasks add meshes, so that the last task lists them all. Where the
 * frames of another job cannot be told from its own, all are listed. */
static status list_in_stage(const struct job *job, const struct job_states *states, const char *root)
{
    status st = OK;
    size_t before, n = 0;
    do {
        int *frames = NULL;
        before = n;
        TRY(stage_write(job, states->n ? states : NULL, root, NULL));
        TRY(folder_list(root, job->name, FILE_MESH_USD, &frames, &n));
        free(frames);
    } while (n != before);
done:
    return st;
}

status cli_mesh(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct job *job = NULL;
    int *frames = NULL;
    size_t n, n_found = 0;
    struct meshes meshes = {0};
    struct job_states states = {0};
    bool no_rocks = false;
    struct path path;
    char name[256];
    struct progress progress = {0};
    struct path root;
    int wedge = 0;
    bool help = false, missing = false, allow_none = false, done = false;
    const char *word[5] = {"mesh", "--missing"};
    char adaptivity[64], smooth[32], number[32];
    const struct option options[] = {
        OPTION_FRAMES(&c),
        {"adaptivity", "VOXELS", OPTION_NUMBER, &meshes.adaptivity,
         "0 to 1: how far the surface may deviate to save triangles (default: 0)"},
        {"smooth", "N", OPTION_INT, &meshes.smooth,
         "smoothing passes, 0 to 100, that neither shrink the surface nor round the edges of layers and ledges (default: 0)"},
        {"no-rocks", NULL, OPTION_FLAG, &no_rocks, "omit NAME.rocks.FRAME, the rocks of piles"},
        {"missing", NULL, OPTION_FLAG, &missing,
         "only meshes that are missing, damaged or out of date, or were made with other options"},
        {"allow-none", NULL, OPTION_FLAG, &allow_none, "do not fail if no frame has volumes"},
        OPTION_WEDGE(&wedge),
        OPTION_PROGRESS(&c),
    };
    TRY(options_parse(&usage_mesh, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    TRY(wedge_folder(operands.item[0], wedge, &root));
    if (!(meshes.adaptivity >= 0 && meshes.adaptivity <= 1)) {
        st = fail(E_USAGE, "--adaptivity %g: must be 0 to 1", meshes.adaptivity);
        goto done;
    }
    if (meshes.smooth < 0 || meshes.smooth > 100) {
        st = fail(E_USAGE, "--smooth %d: must be 0 to 100", meshes.smooth);
        goto done;
    }
    TRY(frames_folder(root.text, c.frames, name));
    folder_sweep(root.text);
    TRY(path_join(&path, root.text, "job.yaml"));
    TRY(job_load(path.text, NULL, 0, &job));
    TRY(owner_check_frames(root.text, job->name, c.frames, &states));
    signals_install();
    TRY(path_join(&path, root.text, "mesh"));
    TRY(folder_make(path.text));
    TRY(folder_frames(root.text, job->name, &frames, &n));
    meshes.recipe = (struct recipe){.root = root.text, .word = word, .n_words = 2};
    if (meshes.adaptivity > 0) {
        snprintf(adaptivity, sizeof adaptivity, "--adaptivity=%s", number_text(meshes.adaptivity, number));
        word[meshes.recipe.n_words++] = adaptivity;
    }
    if (meshes.smooth > 0) {
        snprintf(smooth, sizeof smooth, "--smooth=%d", meshes.smooth);
        word[meshes.recipe.n_words++] = smooth;
    }
    if (no_rocks)
        word[meshes.recipe.n_words++] = "--no-rocks";
    meshes.job = job;
    meshes.rocks = !no_rocks;
    progress_begin_notes(&progress, (enum progress_style)c.progress);
    for (size_t i = 0; i < n; i++) {
        char line[64];
        if (c.frames.step && !range_holds(c.frames, frames[i]))
            continue;
        TRY(folder_path(&path, root.text, job->name, FILE_VOLUMES, frames[i], NULL));
        if (access(path.text, R_OK) != 0) {
            if (errno == ENOENT)
                continue;
            st = fail(E_INPUT, "%s: %s", path.text, strerror(errno));
            goto done;
        }
        n_found++;
        if (stop_requested()) {
            st = fail(STOPPED, "stopped before frame %d; to continue, run the same command with --missing",
                      frames[i]);
            goto done;
        }
        if (missing)
            TRY(meshes_done(&meshes, frames[i], &done));
        if (done)
            continue;
        TRY(meshes_write(&meshes, frames[i]));
        snprintf(line, sizeof line, "mesh of frame %d", frames[i]);
        progress_note(&progress, i + 1, n, line);
    }
    if (n_found == 0 && !allow_none)
        st = fail(E_INPUT, "%s: no volumes of the requested frames; run the job first", root.text);
    else if (n_found)
        st = list_in_stage(job, &states, root.text);
    if (st == OK && n_found && progress.style == PROGRESS_BAR)
        log_info("meshes of %zu frames are in %s/mesh", n_found, root.text);
done:
    progress_end(&progress);
    free(frames);
    job_states_free(&states);
    job_destroy(&job);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
