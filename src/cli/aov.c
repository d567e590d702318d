/* hoodoo aov OUT: renders pictures of completed frames from their VDBs, for any camera. */
#include "field/aov.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "cli/await.h"
#include "cli/cli.h"
#include "exr/exr.h"
#include "field/field.h"
#include "model/air.h"
#include "output/product.h"
#include "run/owner.h"
#include "scene/scene.h"
#include "system/progress.h"
#include "system/signals.h"
#include "vdb/vdb.h"

/* The command recorded with a picture. It points into itself and must not be copied. */
struct picture_recipe {
    struct recipe recipe;
    struct path camera;
    const char *word[PRODUCT_WORDS];
};

struct pictures {
    struct path root;
    char name[256];
    bool missing; /* --missing */
    struct job *job;
    struct job_states states;
    const struct job_camera **camera;
    size_t n_cameras;
    bool no_wind; /* the wind was a flow and is not in any file */
    const struct arguments *sets;
    int voxels[3];
    struct gpu *gpu;
    struct gpu_work *work;
    struct field field;
    struct aov aov;
};

/* ---- loading a frame onto the device */

struct loaded {
    struct frame_grids grids, wind;
    struct rock rock;
    struct particles particles;
    struct aov_air air;
};

static void unload(struct pictures *s, struct loaded *l)
{
    frame_grids_free(&l->grids);
    frame_grids_free(&l->wind);
    rock_free(&l->rock);
    particles_destroy(s->gpu, &l->particles);
    gpu_buffer_destroy(s->gpu, &l->air.velocity);
}

static status load(struct pictures *s, int frame, struct loaded *l)
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
        st = fail(E_INPUT, "%s is missing: pictures need the particles; write them with output.vdb.points",
                  points.text);
        goto done;
    }
    TRY(vdb_points_read(points.text, &l->rock));
    if (l->rock.n == 0) {
        st = fail(E_INPUT, "frame %d has no rock left to render", frame);
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

/* Refuses to overwrite a picture that a manifest of the run lists. */
static status check_unlisted(const struct pictures *s, int frame, const char *path)
{
    struct manifest manifest = {0};
    status st = manifest_read(s->root.text, s->name, frame, &manifest);
    for (size_t i = 0; st == OK && i < manifest.n_files; i++)
        if (strcmp(manifest.file[i].path, path) == 0)
            st = fail(
                E_OUTPUT,
                "%s belongs to the run and is listed in its manifest; give the camera another name: --set 'cameras.NAME={...}' --camera NAME",
                path);
    manifest_free(&manifest);
    return st == E_INPUT ? OK : st; /* the frame has no manifest */
}

/* The command that renders the picture of this camera. */
static status recipe_of(const struct pictures *s, int frame, const char *camera, struct picture_recipe *out)
{
    *out = (struct picture_recipe){
        .recipe = {.root = s->root.text, .word = out->word, .n_words = 3 + 2 * s->sets->n}};
    status st = path_format(&out->camera, "--camera=%s", camera);
    out->word[0] = "aov";
    out->word[1] = "--missing";
    out->word[2] = out->camera.text;
    for (size_t i = 0; i < s->sets->n; i++) {
        out->word[3 + 2 * i] = "--set";
        out->word[4 + 2 * i] = s->sets->item[i];
    }
    return st == OK ? recipe_of_frame(&out->recipe, s->name, frame) : st;
}

static status write_picture(const struct pictures *s, int frame, const struct aov_image *image)
{
    status st = OK;
    struct path path;
    struct picture_recipe made;
    void *bytes = NULL;
    size_t size;
    const struct exr_options options = {
        .layout = s->job->output.aov.layout,
        .fps = s->job->fps,
        .frame = frame,
        .years = (frame - s->job->frames.first) * s->job->clock.years_per_frame,
        .job_hash = job_state(&s->states, frame),
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

/* Whether the camera's picture exists, is undamaged, and was made by this command from the current frame. */
static status picture_done(const struct pictures *s, int frame, const char *camera, bool *out)
{
    status st = OK;
    struct path path;
    struct picture_recipe made;
    TRY(folder_name(&path, s->name, FILE_AOV, frame, camera));
    TRY(recipe_of(s, frame, camera, &made));
    TRY(product_done(&made.recipe, path.text, true, out));
done:
    return st;
}

static status render_frame(struct pictures *s, int frame)
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

/* The cameras given by --camera, else farm.cameras, else all. */
static status choose_cameras(struct pictures *s, const struct arguments *given)
{
    status st = OK;
    struct arguments asked_here = {(const char **)s->job->farm.cameras, s->job->farm.n_cameras, 0};
    const struct arguments *asked = given->n ? given : &asked_here;
    TRY(memory_alloc(s->job->n_cameras, sizeof *s->camera, "cameras", &s->camera));
    for (size_t i = 0; i < s->job->n_cameras; i++) {
        bool wanted = asked->n == 0;
        for (size_t k = 0; k < asked->n; k++)
            wanted |= strcmp(asked->item[k], s->job->cameras[i].name) == 0;
        if (wanted)
            s->camera[s->n_cameras++] = &s->job->cameras[i];
    }
    for (size_t k = 0; k < asked->n; k++) {
        bool found = false;
        for (size_t i = 0; i < s->n_cameras; i++)
            found |= strcmp(asked->item[k], s->camera[i]->name) == 0;
        if (!found) {
            st = fail(E_USAGE, "--camera %.64s: the job has no camera of that name", asked->item[k]);
            goto done;
        }
    }
    if (s->n_cameras == 0)
        st = fail(E_USAGE, "the job has no cameras; add one with --set 'cameras.NAME={orbit: {...}}'");
done:
    return st;
}

/* If the wind was a flow but was not written, it is unknown: the pictures then have no wind layer, because the job's uniform
 * wind ignores the rock. */
static status look_for_wind(struct pictures *s)
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
        log_info(
            "the layer wind.speed is left out: the run has no wind/; write it with output.vdb.wind: true");
done:
    free(frames);
    return st;
}

/* Creates the device objects, with buffers for the largest of the chosen cameras. */
static status prepare(struct pictures *s, const char *device)
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

static void finish(struct pictures *s)
{
    if (s->gpu) {
        aov_destroy(s->gpu, &s->aov);
        field_destroy(s->gpu, &s->field);
        gpu_work_destroy(s->gpu, &s->work);
        gpu_destroy(&s->gpu);
    }
    free(s->camera);
    job_states_free(&s->states);
    job_destroy(&s->job);
}

/* A range with the right number of frames, for the progress line. */
static struct frame_range frames_shown(const int *frames, size_t n)
{
    int step = n > 1 ? frames[1] - frames[0] : 1;
    return (struct frame_range){frames[0], frames[0] + (int)(n - 1) * step, step};
}

status cli_aov(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0}, cameras = {0};
    struct pictures s = {0};
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
        {"camera", "NAME", OPTION_LIST, &cameras,
         "a camera of the job or of --set 'cameras.NAME={...}'; repeatable (default: farm.cameras, or all)"},
        {"missing", NULL, OPTION_FLAG, &s.missing,
         "only pictures that are missing, damaged or out of date, or were made with other options"},
        {"allow-none", NULL, OPTION_FLAG, &allow_none, "do not fail if no frame has volumes"},
        OPTION_WEDGE(&wedge),
    };
    TRY(options_parse(&usage_aov, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    TRY(wedge_folder(operands.item[0], wedge, &s.root));
    TRY(frames_folder(s.root.text, c.frames, s.name));
    folder_sweep(s.root.text);
    TRY(path_join(&path, s.root.text, "job.yaml"));
    TRY(owner_check_frames(s.root.text, s.name, c.frames, &s.states));
    TRY(job_load(path.text, c.sets.item, c.sets.n, &s.job));
    TRY(choose_cameras(&s, &cameras));
    if (2 * c.sets.n + 3 > PRODUCT_WORDS) {
        st = fail(E_USAGE, "--set is given %zu times; at most %d can be recorded with a picture", c.sets.n,
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
                      "stopped before frame %d; to continue, run the same command with --frames %d-%d",
                      frames[i], frames[i], frames[n - 1]);
            goto done;
        }
        TRY(render_frame(&s, frames[i]));
        progress_frame(&progress, frames[i], -1, "");
    }
    if (progress.style == PROGRESS_BAR)
        log_info("pictures of %zu frames are in %s/aov", n, s.root.text);
done:
    progress_end(&progress);
    finish(&s);
    free(frames);
    arguments_free(&operands);
    arguments_free(&cameras);
    common_free(&c);
    return st;
}
