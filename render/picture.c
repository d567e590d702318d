#include "render/picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/memory.h"
#include "model/rocks.h"
#include "output/folder.h"

/* More shows as flat facets in raking light. */
static const double ADAPTIVITY = 0.03;

/* One picture under way. */
struct picture {
    const struct preview *preview;
    char what[64];
    char path[512], temporary[600], scene[600]; /* relative to root */
    bool own_scene;                             /* remove it when done */
};

void picture_still_path(const struct preview *p, int frame, char out[512])
{
    snprintf(out, 512, "preview/%.200s.%04d.png", p->job->name, frame);
}

void picture_view_path(const struct preview *p, int frame, int view, char out[512])
{
    snprintf(out, 512, "turntable/%.200s.%04d.%03d.png", p->job->name, frame, view);
}

static void volumes_path(const struct preview *p, int frame, char out[512])
{
    snprintf(out, 512, "volumes/%.200s.%04d.vdb", p->job->name, frame);
}

bool picture_current(const struct preview *p, const char *path, const char *source)
{
    char full[4700];
    struct stat made, from;
    snprintf(full, sizeof full, "%s/%s", p->root, path);
    if (stat(full, &made) != 0 || made.st_size == 0)
        return false;
    snprintf(full, sizeof full, "%s/%s", p->root, source);
    return stat(full, &from) != 0 || made.st_mtim.tv_sec >= from.st_mtim.tv_sec;
}

/* Is it also of the size that is wanted now? A draft is no preview. The size is in a PNG's first chunk. */
static bool current_of_size(const struct preview *p, const char *path, const char *source, int width,
                            int height)
{
    char full[4700];
    unsigned char head[24];
    if (!picture_current(p, path, source))
        return false;
    snprintf(full, sizeof full, "%s/%s", p->root, path);
    FILE *file = fopen(full, "rb");
    if (!file)
        return false;
    bool whole = fread(head, sizeof head, 1, file) == 1;
    fclose(file);
    const unsigned char *w = head + 16, *h = head + 20;
    return whole && (w[0] << 24 | w[1] << 16 | w[2] << 8 | w[3]) == width &&
           (h[0] << 24 | h[1] << 16 | h[2] << 8 | h[3]) == height;
}

/* ---- the scene */

static void size_of(const struct preview *p, const struct job_camera *camera, bool turntable, int *width,
                    int *height)
{
    static const int stills[][2] = {{320, 180}, {640, 360}, {0, 0}},
                     orbits[][2] = {{240, 136}, {480, 270}, {960, 540}};
    const int *preset = turntable ? orbits[p->preset] : stills[p->preset];
    *width = p->width ? p->width : preset[0] ? preset[0] : camera ? (int)camera->resolution[0] : 1280;
    *height = p->width ? p->height : preset[0] ? preset[1] : camera ? (int)camera->resolution[1] : 720;
}

static const struct job_camera *chosen_camera(const struct preview *p)
{
    for (size_t i = 0; p->camera && i < p->job->n_cameras; i++)
        if (strcmp(p->job->cameras[i].name, p->camera) == 0)
            return &p->job->cameras[i];
    return p->job->n_cameras ? &p->job->cameras[0] : NULL;
}

/* The job's camera, with the picture's own shape: its film keeps its width. */
static struct camera shaped(const struct job_camera *camera, int frame, int width, int height)
{
    struct job_camera own = *camera;
    own.resolution[0] = width;
    own.resolution[1] = height;
    return camera_of(&own, frame);
}

/* Writes the frame's scene, with one camera (views = 0) or an orbit of them, to `path` under root. */
static status write_scene(const struct preview *p, int frame, int views, const char *path, int *width,
                          int *height)
{
    status st = OK;
    char full[4700], volumes[512];
    struct vdb_mesh mesh = {0};
    struct camera *camera = NULL;
    struct text text = {0};
    bool terrain = p->job->model == MODEL_ARCHES;
    struct pile_tile tile = {0};
    struct rock rocks = {0};
    struct scene scene = {.job = p->job, .frame = frame, .mesh = &mesh, .preset = p->preset};
    const struct job_camera *own = chosen_camera(p);
    volumes_path(p, frame, volumes);
    snprintf(full, sizeof full, "%s/%s", p->root, volumes);
    TRY(vdb_mesh_read(full, terrain ? 0 : ADAPTIVITY, scene_values, SCENE_VALUES, SCENE_VALUES, &mesh));
    if (job_piles(p->job)) {
        TRY(rocks_tile(p->job, &tile));
        TRY(folder_path(full, p->root, p->job->name, FILE_ROCKS, frame, NULL));
        TRY(vdb_points_read(full, &rocks));
        scene.rocks = (struct scene_rocks){&tile, &rocks};
    }
    TRY(scene_bounds(&scene));
    TRY(memory_alloc((size_t)(views ? views : 1), sizeof *camera, "cameras", &camera));
    size_of(p, own, views > 0, width, height);
    if (!views)
        camera[0] = own ? shaped(own, frame, *width, *height) : scene_orbit(&scene, -55, *width, *height);
    double start = own ? curve_at(&own->orbit.azimuth_deg, frame) : -55;
    for (int view = 0; view < views; view++)
        camera[view] = scene_orbit(&scene, start + 360.0 * view / views, *width, *height);
    scene.camera = camera;
    scene.n_cameras = (size_t)(views ? views : 1);
    TRY(scene_write(&scene, &text));
    snprintf(full, sizeof full, "%s/%s", p->root, path);
    TRY(atomic_file_write(full, text.data, text.size));
done:
    text_free(&text);
    pile_tile_destroy(&tile);
    rock_free(&rocks);
    free(camera);
    vdb_mesh_free(&mesh);
    return st;
}

/* ---- POV-Ray */

/* Moves a finished picture to its name, if it is whole: a PNG ends with its IEND chunk. */
static status picture_done(void *user)
{
    static const unsigned char end[] = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
    struct picture *picture = user;
    status st = OK;
    char from[4700], to[4700];
    void *bytes = NULL;
    size_t n = 0;
    snprintf(from, sizeof from, "%s/%s", picture->preview->root, picture->temporary);
    snprintf(to, sizeof to, "%s/%s", picture->preview->root, picture->path);
    TRY(file_read(from, (size_t)1 << 30, &bytes, &n));
    if (n < sizeof end || memcmp((char *)bytes + n - sizeof end, end, sizeof end) != 0) {
        st = fail(E_OUTPUT, "%s: the picture is cut short; is the disk full?", from);
        goto done;
    }
    TRY(atomic_file_write(to, bytes, n));
done:
    unlink(from);
    if (picture->own_scene && !picture->preview->keep_scenes) {
        snprintf(from, sizeof from, "%s/%s", picture->preview->root, picture->scene);
        unlink(from);
    }
    free(bytes);
    free(picture);
    return st;
}

static status start(struct preview *p, struct picture *picture, int view, int width, int height)
{
    char in[700], out[700], w[32], h[32], declare[40];
    snprintf(in, sizeof in, "+I%s", picture->scene);
    snprintf(out, sizeof out, "+O%s", picture->temporary);
    snprintf(w, sizeof w, "+W%d", width);
    snprintf(h, sizeof h, "+H%d", height);
    snprintf(declare, sizeof declare, "Declare=View=%d", view);
    /* One thread each: reading the mesh takes one anyway, so several pictures side by side use the cores
     * better. */
    const char *const argv[] = {
        "povray", in,    out,  w,    h,    declare, p->preset == PRESET_DRAFT ? "-A" : "+A0.3",
        "+AM2",   "+R2", "-D", "-P", "-V", "+FN8",  "+WT1",
        "-GA",    NULL};
    return children_run(&p->children, argv, picture->what, picture_done, picture);
}

static status new_picture(const struct preview *p, const char *what, const char *path, struct picture **out)
{
    status st = memory_alloc(1, sizeof **out, "a picture", out);
    if (st != OK)
        return st;
    (*out)->preview = p;
    snprintf((*out)->what, sizeof(*out)->what, "%s", what);
    snprintf((*out)->path, sizeof(*out)->path, "%s", path);
    st = atomic_file_temporary(path, (*out)->temporary, sizeof(*out)->temporary - 4);
    strcat((*out)->temporary, ".png"); /* POV-Ray would add one of its own */
    return st;
}

status picture_still(struct preview *p, int frame)
{
    status st = OK;
    char path[512], source[512], what[64];
    struct picture *picture = NULL;
    int width, height;
    picture_still_path(p, frame, path);
    volumes_path(p, frame, source);
    size_of(p, chosen_camera(p), false, &width, &height);
    if (current_of_size(p, path, source, width, height))
        return OK;
    snprintf(what, sizeof what, "the still of frame %d", frame);
    TRY(new_picture(p, what, path, &picture));
    snprintf(picture->scene, sizeof picture->scene, "%.*s.pov", (int)(strlen(path) - 4), path);
    picture->own_scene = true;
    TRY(write_scene(p, frame, 0, picture->scene, &width, &height));
    TRY(start(p, picture, 0, width, height));
    picture = NULL;
done:
    free(picture);
    return st;
}

status picture_orbit(struct preview *p, int frame, int views)
{
    status st = OK;
    char path[512], source[512], what[64], scene[512], full[4700];
    struct picture *picture = NULL;
    int width, height;
    bool any = false;
    volumes_path(p, frame, source);
    size_of(p, chosen_camera(p), true, &width, &height);
    snprintf(scene, sizeof scene, "turntable/%.200s.%04d.pov", p->job->name, frame);
    for (int view = 0; view < views; view++) {
        picture_view_path(p, frame, view, path);
        if (current_of_size(p, path, source, width, height))
            continue;
        if (!any)
            TRY(write_scene(p, frame, views, scene, &width, &height));
        any = true;
        snprintf(what, sizeof what, "view %d of frame %d", view, frame);
        TRY(new_picture(p, what, path, &picture));
        snprintf(picture->scene, sizeof picture->scene, "%s", scene);
        TRY(start(p, picture, view, width, height));
        picture = NULL;
    }
    TRY(children_wait(&p->children));
    if (any && !p->keep_scenes) {
        snprintf(full, sizeof full, "%s/%s", p->root, scene);
        unlink(full);
    }
done:
    free(picture);
    return st;
}
