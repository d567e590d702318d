/* hoodoo aov OUT: pictures of frames that are done, from any camera, out of their VDBs. */
#include "field/aov.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/signals.h"
#include "cli/cli.h"
#include "exr/exr.h"
#include "field/field.h"
#include "model/air.h"
#include "output/product.h"
#include "run/branch.h"
#include "scene/scene.h"
#include "vdb/vdb.h"

/* The command that makes a picture; it points into itself. */
struct shot_recipe {
    struct recipe recipe;
    struct path camera;
    const char *word[PRODUCT_WORDS];
};

struct shot {
    struct path root;
    char name[256];
    bool missing; /* only what is not there */
    struct job *job;
    uint64_t job_hash;
    const struct job_camera **camera;
    size_t n_cameras;
    bool no_wind; /* it was a flow, and is in no file */
    const struct words *sets;
    int voxels[3];
    struct gpu *gpu;
    struct gpu_work *work;
    struct field field;
    struct aov aov;
};

/* ---- a frame, back on the device */

struct loaded {
    struct frame_grids grids, wind;
    struct rock rock;
    struct particles particles;
    struct aov_air air;
};

static void unload(struct shot *s, struct loaded *l)
{
    frame_grids_free(&l->grids);
    frame_grids_free(&l->wind);
    rock_free(&l->rock);
    particles_destroy(s->gpu, &l->particles);
    gpu_buffer_destroy(s->gpu, &l->air.velocity);
}

static status load(struct shot *s, int frame, struct loaded *l)
{
    status st = OK;
    struct path volumes, points, wind;
    TRY(folder_path(&volumes, s->root.text, s->name, FILE_VOLUMES, frame, NULL));
    TRY(folder_path(&points, s->root.text, s->name, FILE_POINTS, frame, NULL));
    TRY(folder_path(&wind, s->root.text, s->name, FILE_WIND, frame, NULL));
    TRY(vdb_volumes_read(volumes.text, &l->grids));
    if (access(wind.text, F_OK) == 0)
        TRY(vdb_volumes_read(wind.text, &l->wind));
    if (access(points.text, F_OK) != 0) {
        st = fail(E_INPUT, "%s is not there: pictures need the particles (output.vdb.points)", points.text);
        goto done;
    }
    TRY(vdb_points_read(points.text, &l->rock));
    if (l->rock.n == 0) {
        st = fail(E_INPUT, "frame %d: no rock is left, there is nothing to show", frame);
        goto done;
    }
    st = field_upload(s->gpu, &s->field, &l->grids);
    if (st == E_INPUT) {
        char why[400];
        snprintf(why, sizeof why, "%.390s", status_message());
        st = fail(E_INPUT, "%s: %s", volumes.text, why);
    }
    TRY(st);
    TRY(particles_create(s->gpu, s->work, &l->rock, DERIVED, s->voxels, s->job->domain.spacing_m,
                         &l->particles));
    if (job_model(s->job)->wind)
        TRY(air_upload(s->gpu, &l->wind, job_at(s->job, frame), frame, &l->air));
    l->air.unknown = s->no_wind;
done:
    return st;
}

/* ---- its pictures */

/* The run's own pictures stay as its manifests know them. */
static status check_unlisted(const struct shot *s, int frame, const char *path)
{
    struct manifest manifest = {0};
    status st = manifest_read(s->root.text, s->name, frame, &manifest);
    for (size_t i = 0; st == OK && i < manifest.n_files; i++)
        if (strcmp(manifest.file[i].path, path) == 0)
            st = fail(
                E_OUTPUT,
                "%s is the run's own picture, which its manifest vouches for; give the camera another name (--set 'cameras.NAME={...}' --camera NAME)",
                path);
    manifest_free(&manifest);
    return st == E_INPUT ? OK : st; /* a frame without a manifest vouches for nothing */
}

/* What makes the picture of this camera. */
static status recipe_of(const struct shot *s, int frame, const char *camera, struct shot_recipe *out)
{
    *out = (struct shot_recipe){
        .recipe = {.root = s->root.text, .word = out->word, .n_words = 3 + 2 * s->sets->n}};
    status st = path_format(&out->camera, "--camera=%s", camera);
    out->word[0] = "aov";
    out->word[1] = "--missing";
    out->word[2] = out->camera.text;
    for (size_t i = 0; i < s->sets->n; i++) {
        out->word[3 + 2 * i] = "--set";
        out->word[4 + 2 * i] = s->sets->word[i];
    }
    return st == OK ? recipe_of_frame(&out->recipe, s->name, frame) : st;
}

static status write_picture(const struct shot *s, int frame, const struct aov_image *image)
{
    status st = OK;
    struct path path;
    struct shot_recipe made;
    void *bytes = NULL;
    size_t size;
    const struct exr_options options = {
        .layout = s->job->output.aov.layout,
        .fps = s->job->fps,
        .frame = frame,
        .years = (frame - s->job->frames.first) * s->job->clock.years_per_frame,
        .job_hash = s->job_hash,
        .owner = s->job->output.owner,
        .comments = s->job->output.comments,
    };
    TRY(folder_name(&path, s->name, FILE_AOV, frame, image->camera));
    TRY(check_unlisted(s, frame, path.text));
    TRY(recipe_of(s, frame, image->camera, &made));
    TRY(exr_encode(image, &options, &bytes, &size));
    TRY(product_write(&made.recipe, path.text, bytes, size));
done:
    free(bytes);
    return st;
}

/* Is the camera's picture there, whole, made by this command of the frame that is there? */
static status picture_done(const struct shot *s, int frame, const char *camera, bool *out)
{
    status st = OK;
    struct path path;
    struct shot_recipe made;
    TRY(folder_name(&path, s->name, FILE_AOV, frame, camera));
    TRY(recipe_of(s, frame, camera, &made));
    TRY(product_done(&made.recipe, path.text, true, out));
done:
    return st;
}

static status shoot(struct shot *s, int frame)
{
    status st = OK;
    struct loaded l = {0};
    struct aov_image image = {0};
    bool loaded = false, there = false;
    for (size_t c = 0; c < s->n_cameras; c++) {
        if (s->missing)
            TRY(picture_done(s, frame, s->camera[c]->name, &there));
        if (there)
            continue;
        if (!loaded)
            TRY(load(s, frame, &l));
        loaded = true;
        TRY(aov_render(s->gpu, &s->aov, s->job, s->camera[c], frame, &s->field, &l.particles,
                       l.air.velocity || l.air.unknown ? &l.air : NULL, &image));
        TRY(write_picture(s, frame, &image));
        aov_image_free(&image);
    }
done:
    aov_image_free(&image);
    unload(s, &l);
    return st;
}

/* ---- the verb */

/* Those asked for, else the farm's, else all. */
static status choose_cameras(struct shot *s, const struct words *given)
{
    status st = OK;
    struct words asked_here = {(const char **)s->job->farm.cameras, s->job->farm.n_cameras, 0};
    const struct words *asked = given->n ? given : &asked_here;
    TRY(memory_alloc(s->job->n_cameras, sizeof *s->camera, "cameras", &s->camera));
    for (size_t i = 0; i < s->job->n_cameras; i++) {
        bool wanted = asked->n == 0;
        for (size_t k = 0; k < asked->n; k++)
            wanted |= strcmp(asked->word[k], s->job->cameras[i].name) == 0;
        if (wanted)
            s->camera[s->n_cameras++] = &s->job->cameras[i];
    }
    for (size_t k = 0; k < asked->n; k++) {
        bool found = false;
        for (size_t i = 0; i < s->n_cameras; i++)
            found |= strcmp(asked->word[k], s->camera[i]->name) == 0;
        if (!found) {
            st = fail(E_USAGE, "--camera %.64s: the job has no camera of that name", asked->word[k]);
            goto done;
        }
    }
    if (s->n_cameras == 0)
        st = fail(E_USAGE, "the job has no cameras; make one: --set 'cameras.NAME={orbit: {...}}'");
done:
    return st;
}

/* Of a wind that flowed and was not written nothing is known: its place is left out of the pictures rather than taken by the wind
 * of the job, which knows no rock. */
static status look_for_wind(struct shot *s)
{
    status st = OK;
    int *frames = NULL;
    size_t n = 0;
    if (job_model(s->job)->wind && wind_flows(s->job))
        TRY(folder_list(s->root.text, s->name, FILE_WIND, &frames, &n));
    else
        return OK;
    s->no_wind = n == 0;
    if (s->no_wind && job_wants_layer(s->job, value_table[VALUE_wind].layer))
        log_info("no layer wind.speed: the run wrote no wind/; output.vdb.wind: true has it written");
done:
    free(frames);
    return st;
}

/* aov_create() sizes its buffers by the cameras the job renders: those that are wanted now. */
static status prepare(struct shot *s, const char *device)
{
    status st = OK;
    size_t most = 0;
    for (size_t i = 0; i < s->n_cameras; i++) {
        size_t n = aov_camera_pixels(s->camera[i]);
        most = n > most ? n : most;
    }
    TRY(look_for_wind(s));
    TRY(scene_voxels(s->job, s->voxels));
    TRY(gpu_create(&(struct gpu_options){.device = device}, &s->gpu));
    TRY(gpu_work_create(s->gpu, (size_t)s->voxels[0] * (size_t)s->voxels[1] * (size_t)s->voxels[2] + 2,
                        &s->work));
    TRY(field_create(s->gpu, s->voxels, s->job->domain.spacing_m, &s->field));
    TRY(aov_create(s->gpu, s->job, most, &s->aov));
done:
    return st;
}

static void finish(struct shot *s)
{
    if (s->gpu) {
        aov_destroy(s->gpu, &s->aov);
        field_destroy(s->gpu, &s->field);
        gpu_work_destroy(s->gpu, &s->work);
        gpu_destroy(&s->gpu);
    }
    free(s->camera);
    job_destroy(&s->job);
}

/* For the progress line: as many frames as there are to do. */
static struct frame_range frames_shown(const int *frames, size_t n)
{
    int step = n > 1 ? frames[1] - frames[0] : 1;
    return (struct frame_range){frames[0], frames[0] + (int)(n - 1) * step, step};
}

status cli_aov(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct words operands = {0}, cameras = {0};
    struct shot s = {0};
    struct progress progress = {0};
    struct path path;
    int *frames = NULL;
    size_t n = 0;
    int wedge = 0;
    bool help = false, allow_none = false;
    const struct option options[] = {
        OPTION_FRAMES(&c),
        OPTION_DEVICE(&c),
        OPTION_SET(&c),
        OPTION_PROGRESS(&c),
        {"camera", "NAME", OPTION_WORDS, &cameras,
         "of the job, or of --set 'cameras.NAME={...}'; repeatable (default: farm.cameras, or all)"},
        {"missing", NULL, OPTION_FLAG, &s.missing,
         "only pictures that are not there, are damaged, or were made otherwise or of another frame"},
        {"allow-none", NULL, OPTION_FLAG, &allow_none, "frames without volumes are no error"},
        OPTION_WEDGE(&wedge),
    };
    TRY(options_parse(&usage_aov, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    TRY(wedge_folder(operands.word[0], wedge, &s.root));
    TRY(folder_open(s.root.text, s.name));
    folder_sweep(s.root.text);
    TRY(path_join(&path, s.root.text, "job.yaml"));
    TRY(job_load(path.text, NULL, 0, &s.job));
    TRY(branch_prepare_own(s.job, s.root.text));
    TRY(job_hash(s.job, &s.job_hash));
    job_destroy(&s.job);
    TRY(job_load(path.text, c.sets.word, c.sets.n, &s.job));
    TRY(choose_cameras(&s, &cameras));
    if (2 * c.sets.n + 3 > PRODUCT_WORDS) {
        st = fail(E_USAGE, "--set is given %zu times; at most %d are recorded with a picture", c.sets.n,
                  (PRODUCT_WORDS - 3) / 2);
        goto done;
    }
    s.sets = &c.sets;
    st = volume_frames(s.root.text, s.name, c.frames, &frames, &n);
    if (st == E_INPUT && allow_none)
        st = OK;
    TRY(st);
    if (n == 0)
        goto done;
    TRY(prepare(&s, c.device));
    signals_install();
    progress_begin(&progress, (enum progress_style)c.progress, frames_shown(frames, n), 0);
    for (size_t i = 0; i < n; i++) {
        if (stop_requested()) {
            st = fail(STOPPED,
                      "stopped before frame %d; run the same command with --frames %d-%d for the rest",
                      frames[i], frames[i], frames[n - 1]);
            goto done;
        }
        TRY(shoot(&s, frames[i]));
        progress_frame(&progress, frames[i], -1, "");
    }
done:
    progress_end(&progress);
    finish(&s);
    free(frames);
    words_free(&operands);
    words_free(&cameras);
    common_free(&c);
    return st;
}
