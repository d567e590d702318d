#include "render/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/vector.h"
#include "base/version.h"
#include "frame/rocks.h"
#include "output/folder.h"
#include "render/closest.h"
#include "render/daylight.h"
#include "render/develop.h"
#include "render/png.h"
#include "render/refine.h"
#include "render/slate.h"
#include "system/atomic_file.h"

/* Larger values show as flat facets in raking light. */
static const double ADAPTIVITY = 0.03;

/* Meshes with more triangles are not refined further. */
enum { MOST_TRIANGLES = 1500000 };

/* A picture in progress, with its temporary files. Paths are relative to root. */
struct picture {
    struct preview *preview;
    struct picture *next;
    int frame;
    char what[64], tag[PNG_TAG];
    struct preview_recipe made;
    struct path path;
    struct path rendered, drawn, bar, scene; /* temporary files; "": none */
    struct slate slate;
    struct slate_command command;
};

const char *picture_part(const struct preview *p)
{
    return p->show == VALUE_NONE ? NULL : value_table[p->show].name;
}

status picture_still_path(const struct preview *p, int frame, struct path *out)
{
    return folder_name(out, p->job->name, FILE_STILL, frame, picture_part(p));
}

status picture_view_path(const struct preview *p, int frame, int view, struct path *out)
{
    return folder_view(out, p->job->name, picture_part(p), frame, view);
}

status preview_recipe(const struct preview *p, const char *only, const char *more, int frame,
                      struct preview_recipe *out)
{
    size_t n = 0;
    *out = (struct preview_recipe){.recipe = {.root = p->root, .word = out->word, .frame = ALL_FRAMES}};
    out->word[n++] = "preview";
    out->word[n++] = only;
    for (size_t i = 0; i < p->n_options; i++)
        out->word[n++] = p->option[i];
    if (more)
        out->word[n++] = more;
    out->recipe.n_words = n;
    return frame == ALL_FRAMES ? OK : recipe_of_frame(&out->recipe, p->job->name, frame);
}

/* *done: root/`path` exists, is undamaged, was made from the present frame, and has the same options in its tag. The arguments in its
 * record may differ, since different arguments can mean the same options. */
static status done_as_asked(const struct preview_recipe *made, const char *path, const char *tag, bool *done)
{
    status st = OK;
    struct path full;
    char has[PNG_TAG];
    struct recipe any = made->recipe;
    any.n_words = 0;
    TRY(product_done(&any, path, true, done));
    if (!*done)
        goto done;
    TRY(path_join(&full, any.root, path));
    png_tag(full.text, has);
    *done = strcmp(has, tag) == 0;
done:
    return st;
}

bool picture_has_slate(const struct preview *p, const char *path)
{
    struct path full;
    char has[PNG_TAG];
    if (path_join(&full, p->root, path) != OK)
        return false;
    png_tag(full.text, has);
    return strstr(has, "slate=yes") != NULL;
}

/* ---- the scene */

/* A still has the shape of its camera, at most as large as the preset; views of an orbit have the size of the preset. */
static void size_of(const struct preview *p, const struct job_camera *camera, bool turntable, int *width,
                    int *height)
{
    static const int stills[][2] = {{960, 540}, {960, 540}, {16384, 16384}},
                     orbits[][2] = {{640, 360}, {1280, 720}, {1920, 1080}};
    const int *most = turntable ? orbits[p->preset] : stills[p->preset];
    double own[2] = {most[0], most[1]};
    if (p->preset == PRESET_FINAL && !turntable && !camera) {
        own[0] = 1920;
        own[1] = 1080;
    }
    if (camera && !turntable) {
        double fits = fmin(fmin(most[0] / camera->resolution[0], most[1] / camera->resolution[1]), 1);
        for (int k = 0; k < 2; k++)
            own[k] = fmax(round(fits * camera->resolution[k]), 8);
    }
    *width = p->width ? p->width : (int)own[0];
    *height = p->width ? p->height : (int)own[1];
}

static const struct job_camera *chosen_camera(const struct preview *p)
{
    for (size_t i = 0; p->camera && i < p->job->n_cameras; i++)
        if (strcmp(p->job->cameras[i].name, p->camera) == 0)
            return &p->job->cameras[i];
    return p->job->n_cameras ? &p->job->cameras[0] : NULL;
}

/* All options that determine the picture, apart from the frame, as text. view < 0: a still. */
static void tag_of(const struct preview *p, int width, int height, int view, int views, char out[PNG_TAG])
{
    static const char *const presets[] = {CHOICE_LIST(PRESET_CHOICE)};
    const struct job_camera *camera = chosen_camera(p);
    bool slate = !p->no_slate && height >= SLATE_LEAST_HEIGHT;
    int n = snprintf(out, PNG_TAG, "show=%s", p->show == VALUE_NONE ? "rock" : value_table[p->show].name);
    if (p->show != VALUE_NONE)
        n += snprintf(out + n, PNG_TAG - (size_t)n, " %g:%g", p->range.low, p->range.high);
    n += snprintf(out + n, PNG_TAG - (size_t)n, "; size=%dx%d; preset=%s; camera=%.64s; slate=%s%s", width,
                  height, presets[p->preset], camera ? camera->name : "", slate ? "yes" : "no",
                  p->figure && p->show == VALUE_NONE ? "; figure" : "");
    if (view >= 0)
        snprintf(out + n, PNG_TAG - (size_t)n, "; view=%d/%d", view, views);
}

/* The job's camera with the resolution of the picture; the width of its film stays the same. */
static struct camera camera_with_shape(const struct job_camera *camera, int frame, int width, int height)
{
    struct job_camera own = *camera;
    own.resolution[0] = width;
    own.resolution[1] = height;
    return camera_of(&own, frame);
}

/* The azimuth at which the orbit begins: that of the job's camera. */
static double orbit_start(const struct preview *p, int frame)
{
    const struct job_camera *own = chosen_camera(p);
    return own ? curve_at(&own->orbit.azimuth_deg, frame) : -55;
}

/* Values that only points have: each vertex takes that of the closest particle. */
static status read_from_points(const struct preview *p, int frame, struct vdb_mesh *mesh)
{
    status st = OK;
    struct path path;
    struct rock rock = {0};
    float *value = NULL;
    TRY(folder_path(&path, p->root, p->job->name, FILE_POINTS, frame, NULL));
    TRY(vdb_points_read(path.text, &rock));
    float *const field = rock.field[value_field[p->show]];
    if (!field) {
        st = fail(E_INPUT, "%s: the points have no field %s", path.text, value_table[p->show].name);
        goto done;
    }
    if (value_table[p->show].kind == KIND_ID) /* whole numbers, which are converted in place */
        for (size_t i = 0; i < rock.n; i++) {
            uint32_t id;
            memcpy(&id, &field[i], sizeof id);
            field[i] = (float)id;
        }
    TRY(memory_alloc(mesh->n_vertices + 1, sizeof *value, "values", &value));
    TRY(closest_values(mesh->vertex, mesh->n_vertices, rock.P, field, rock.n, 2.5 * p->job->domain.spacing_m,
                       value));
    mesh->value = value;
    value = NULL;
done:
    free(value);
    rock_free(&rock);
    return st;
}

static status read_mesh(const struct preview *p, int frame, struct vdb_mesh *mesh)
{
    status st = OK;
    struct path full;
    const char *value[SCENE_VALUES] = {value_table[p->show].name};
    TRY(folder_path(&full, p->root, p->job->name, FILE_VOLUMES, frame, NULL));
    if (p->show != VALUE_NONE && !(value_table[p->show].where & IN_VOLUMES)) {
        TRY(vdb_mesh_read(full.text, 0, NULL, 0, 0, mesh));
        TRY(read_from_points(p, frame, mesh));
        goto done;
    }
    if (p->show != VALUE_NONE)
        return vdb_mesh_read(full.text, 0, value, 1, 0, mesh);
    double adaptivity = job_model(p->job)->terrain ? 0 : ADAPTIVITY;
    for (int i = 0; i < SCENE_VALUES; i++)
        value[i] = value_table[scene_values[i]].name;
    TRY(vdb_mesh_read(full.text, adaptivity, value, SCENE_VALUES, SCENE_VALUES, mesh));
done:
    return st;
}

/* The camera of a frame's still, or of a view of an orbit. */
static struct camera camera_for(const struct preview *p, int frame, int view, int views, int width,
                                int height)
{
    const struct job_camera *own = chosen_camera(p);
    if (views) {
        /* The orbit eases in and out. */
        double t = (double)view / views, eased = t - 0.6 * sin(2 * M_PI * t) / (2 * M_PI);
        return view_orbit(p->job, orbit_start(p, frame) + 360 * eased, width, height);
    }
    return own ? camera_with_shape(own, frame, width, height) : view_orbit(p->job, -55, width, height);
}

/* The pixel size is the smallest in any frame, so that detail is the same in all frames. */
static struct view view_for(const struct preview *p, const struct camera *camera, size_t n)
{
    const struct job_camera *own = chosen_camera(p);
    struct view view = view_of(p->job, camera, n);
    for (int f = p->job->frames.first; own && n == 1 && f <= p->job->frames.last; f++) {
        const struct camera then = camera_with_shape(own, f, camera->width, camera->height);
        view.pixel = fmin(view.pixel, view_pixel(&view, &then));
    }
    return view;
}

/* Writes the frame's scene, with one camera (views = 0) or an orbit of them, to `path` under root. */
static status write_scene(const struct preview *p, int frame, int views, const char *path, int width,
                          int height)
{
    status st = OK;
    struct path full;
    struct vdb_mesh mesh = {0};
    struct camera *camera = NULL;
    struct text text = {0};
    struct pile_tile tile = {0};
    struct rock rocks = {0};
    struct scene scene = {.job = p->job,
                          .frame = frame,
                          .mesh = &mesh,
                          .preset = p->preset,
                          .show = p->show,
                          .range = p->range,
                          .figure = p->figure,
                          .file = path_last(path)};
    TRY(read_mesh(p, frame, &mesh));
    if (job_piles(p->job)) {
        TRY(rocks_tile(p->job, &tile));
        TRY(folder_path(&full, p->root, p->job->name, FILE_ROCKS, frame, NULL));
        TRY(vdb_points_read(full.text, &rocks));
        scene.rocks = (struct scene_rocks){&tile, &rocks};
    }
    TRY(memory_alloc((size_t)(views ? views : 1), sizeof *camera, "cameras", &camera));
    for (int view = 0; view < (views ? views : 1); view++)
        camera[view] = camera_for(p, frame, view, views, width, height);
    scene.camera = camera;
    scene.n_cameras = (size_t)(views ? views : 1);
    scene.view = view_for(p, camera, scene.n_cameras);
    const struct refine detail = {.job = p->job,
                                  .spacing = p->job->domain.spacing_m,
                                  .times = scene_cuts(&scene),
                                  .n_values = SCENE_VALUES,
                                  .loose = SCENE_DEPOSIT,
                                  .most = MOST_TRIANGLES};
    if (detail.times > 0)
        TRY(refine_mesh(&detail, &mesh));
    TRY(scene_write(&scene, &text));
    TRY(path_join(&full, p->root, path));
    TRY(atomic_file_write(full.text, text.data, text.size));
done:
    text_free(&text);
    pile_tile_destroy(&tile);
    rock_free(&rocks);
    free(camera);
    vdb_mesh_free(&mesh);
    return st;
}

status picture_data_range(const struct preview *p, const int *frames, size_t n, struct show_range *out)
{
    enum { EACH = 200000 }; /* values per frame, enough for the range */
    status st = OK;
    struct vdb_mesh mesh = {0};
    float *values = NULL;
    size_t n_values = 0, capacity = 0;
    for (size_t i = 0; i < n; i++) {
        TRY(read_mesh(p, frames[i], &mesh));
        size_t step = 1 + mesh.n_vertices / EACH;
        TRY(memory_grow(&values, &capacity, n_values + mesh.n_vertices / step + 1, sizeof *values,
                        "the values"));
        for (size_t k = 0; k < mesh.n_vertices; k += step)
            values[n_values++] = mesh.value[k];
        vdb_mesh_free(&mesh);
    }
    *out = show_data_range(p->show, values, n_values);
done:
    vdb_mesh_free(&mesh);
    free(values);
    return st;
}

/* ---- POV-Ray, then strip and legend */

static void remove_temporary(const struct preview *p, struct path *path)
{
    struct path full;
    if (*path->text && path_join(&full, p->root, path->text) == OK)
        unlink(full.text);
    path->text[0] = '\0';
}

/* Removes the picture from the list, deletes its temporary files and frees it. */
static void picture_end(struct picture *picture)
{
    struct preview *p = picture->preview;
    struct picture **at = &p->under_way;
    while (*at && *at != picture)
        at = &(*at)->next;
    if (*at)
        *at = picture->next;
    remove_temporary(p, &picture->rendered);
    remove_temporary(p, &picture->drawn);
    remove_temporary(p, &picture->bar);
    remove_temporary(p, &picture->scene);
    free(picture);
}

void pictures_end(struct preview *p)
{
    while (p->under_way)
        picture_end(p->under_way);
}

/* Moves a finished picture to its name if it is complete. */
static status picture_drawn(void *user)
{
    struct picture *picture = user;
    status st = OK;
    struct path from;
    void *bytes = NULL, *tagged = NULL;
    size_t n = 0;
    TRY(path_join(&from, picture->preview->root, picture->drawn.text));
    TRY(file_read(from.text, (size_t)1 << 30, &bytes, &n));
    st = png_with_tag(bytes, n, picture->tag, &tagged, &n);
    if (st == E_INPUT) /* what we have had made */
        st = fail(E_OUTPUT, "%s: the picture is cut short; is the disk full?", from.text);
    TRY(st);
    TRY(product_write(&picture->made.recipe, picture->path.text, tagged, n));
done:
    free(bytes);
    free(tagged);
    picture_end(picture);
    return st;
}

/* Tone-maps the linear picture that POV-Ray has written. */
static status tone_map(const struct picture *picture)
{
    enum { LARGEST = 1 << 30 };
    const struct preview *p = picture->preview;
    status st = OK;
    struct path full;
    void *bytes = NULL;
    size_t n = 0;
    TRY(path_join(&full, p->root, picture->rendered.text));
    TRY(file_read(full.text, LARGEST, &bytes, &n));
    st = develop_ppm(bytes, &n, 1 / DAYLIGHT_SCALE, light_of(p->job, picture->frame).exposure);
    if (st == E_INPUT) /* what we have had made */
        st = fail(E_OUTPUT, "%s: the picture is cut short; is the disk full?", full.text);
    TRY(st);
    TRY(atomic_file_write(full.text, bytes, n));
done:
    free(bytes);
    return st;
}

/* POV-Ray is done: tone mapping, the strip and the legend follow. */
static status picture_rendered(void *user)
{
    struct picture *picture = user;
    struct preview *p = picture->preview;
    status st = OK;
    struct path full;
    if (p->show == VALUE_NONE)
        TRY(tone_map(picture));
    TRY(atomic_file_temporary(picture->path.text, "", &picture->drawn));
    if (p->show != VALUE_NONE && slate_draws(&picture->slate)) {
        TRY(atomic_file_temporary(picture->path.text, ".ppm", &picture->bar));
        TRY(path_join(&full, p->root, picture->bar.text));
        TRY(slate_write_bar(&picture->slate, full.text));
    }
    slate_command(&picture->slate, picture->rendered.text, picture->bar.text, picture->drawn.text,
                  &picture->command);
    TRY(children_run(&p->children, picture->command.argv, picture->what, picture_drawn, picture));
done:
    return st;
}

static status start_povray(struct preview *p, struct picture *picture, const char *scene, int view)
{
    status st = OK;
    struct path in, out;
    char w[32], h[32], declare[40];
    TRY(path_format(&in, "+I%s", scene));
    TRY(path_format(&out, "+O%s", picture->rendered.text));
    snprintf(w, sizeof w, "+W%d", picture->slate.width);
    snprintf(h, sizeof h, "+H%d", picture->slate.height);
    snprintf(declare, sizeof declare, "Declare=View=%d", view);
    const bool fine = p->preset == PRESET_FINAL, light = p->show == VALUE_NONE;
    /* POV-Ray parses the mesh in one thread, so several single-threaded pictures at a time use the cores better. */
    const char *const argv[] = {"povray",
                                in.text,
                                out.text,
                                w,
                                h,
                                declare,
                                p->preset == PRESET_DRAFT ? "-A"
                                : fine                    ? "+A0.05"
                                                          : "+A0.3",
                                "+AM2",
                                fine ? "+R3" : "+R2",
                                "-D",
                                "-P",
                                "-V",
                                light ? "+FP16" : "+FP8",
                                "+WT1",
                                "-GA",
                                light ? "File_Gamma=1" : NULL,
                                NULL};
    TRY(children_run(&p->children, argv, picture->what, picture_rendered, picture));
done:
    return st;
}

double picture_years(const struct preview *p, int frame)
{
    struct manifest m = {0};
    const double years = manifest_read(p->root, p->job->name, frame, &m) == OK
                             ? m.years
                             : job_years(p->job, p->job->frames.first, frame);
    manifest_free(&m);
    return years;
}

static void describe(const struct preview *p, int frame, const char *seen_from, const struct camera *camera,
                     struct slate *s)
{
    char right[160];
    snprintf(right, sizeof right, "%s%shoodoo %.40s", seen_from, *seen_from ? "   " : "", hoodoo_version);
    slate_describe(p->job, frame, picture_years(p, frame), camera, p->show, p->range,
                   p->no_slate ? NULL : right, s);
}

/* Adds a picture to the list of pictures in progress; picture_end() removes it. */
static status new_picture(struct preview *p, int frame, const char *what, const struct path *path, int width,
                          int height, const struct preview_recipe *made, struct picture **out)
{
    status st = memory_alloc(1, sizeof **out, "a picture", out);
    if (st != OK)
        return st;
    (*out)->preview = p;
    (*out)->frame = frame;
    (*out)->next = p->under_way;
    p->under_way = *out;
    (*out)->slate.width = width;
    (*out)->slate.height = height;
    snprintf((*out)->what, sizeof(*out)->what, "%s", what);
    (*out)->path = *path;
    (*out)->made = *made;
    (*out)->made.recipe.word = (*out)->made.word;
    /* The name ends in .ppm, since POV-Ray appends the suffix of its format to other names. */
    return atomic_file_temporary(path->text, ".ppm", &(*out)->rendered);
}

/* A scene that is kept is named after its picture; others are temporary files. */
static status scene_path(const struct preview *p, enum folder_file kind, int frame, struct path *out)
{
    const status st = folder_name(out, p->job->name, kind, frame, picture_part(p));
    return st == OK && !p->keep_scenes ? atomic_file_temporary(out->text, ".pov", out) : st;
}

status picture_still(struct preview *p, int frame)
{
    status st = OK;
    struct path path, scene;
    struct preview_recipe made;
    bool done;
    char what[64], tag[PNG_TAG];
    struct picture *picture = NULL;
    const struct job_camera *own = chosen_camera(p);
    int width, height;
    TRY(preview_recipe(p, "--only=stills", NULL, frame, &made));
    TRY(picture_still_path(p, frame, &path));
    size_of(p, own, false, &width, &height);
    tag_of(p, width, height, -1, 0, tag);
    TRY(done_as_asked(&made, path.text, tag, &done));
    if (done)
        return OK;
    snprintf(what, sizeof what, "the still of frame %d", frame);
    TRY(scene_path(p, FILE_STILL_SCENE, frame, &scene));
    TRY(write_scene(p, frame, 0, scene.text, width, height));
    TRY(new_picture(p, frame, what, &path, width, height, &made, &picture));
    snprintf(picture->tag, sizeof picture->tag, "%s", tag);
    if (!p->keep_scenes)
        picture->scene = scene;
    const struct camera camera = camera_for(p, frame, 0, 0, width, height);
    describe(p, frame, own ? own->name : "", &camera, &picture->slate);
    TRY(start_povray(p, picture, scene.text, 0));
done:
    return st;
}

status picture_orbit(struct preview *p, int frame, int views, struct frame_range which)
{
    status st = OK;
    struct path path, scene = {""};
    struct preview_recipe made;
    bool done;
    char what[64], tag[PNG_TAG], number[32];
    struct picture *picture = NULL;
    int width, height;
    TRY(preview_recipe(p, "--only=views", NULL, frame, &made));
    size_of(p, chosen_camera(p), true, &width, &height);
    for (int view = which.first, k = 0; view <= which.last; view += which.step, k++) {
        TRY(picture_view_path(p, frame, view, &path));
        tag_of(p, width, height, view, views, tag);
        TRY(done_as_asked(&made, path.text, tag, &done));
        if (done)
            continue;
        if (!*scene.text) {
            TRY(scene_path(p, FILE_ORBIT_SCENE, frame, &scene));
            TRY(write_scene(p, frame, views, scene.text, width, height));
        }
        snprintf(what, sizeof what, "view %d of frame %d", view, frame);
        TRY(new_picture(p, frame, what, &path, width, height, &made, &picture));
        snprintf(picture->tag, sizeof picture->tag, "%s", tag);
        snprintf(number, sizeof number, "view %03d", view); /* as in the file name */
        const struct camera camera = camera_for(p, frame, view, views, width, height);
        describe(p, frame, number, &camera, &picture->slate);
        TRY(start_povray(p, picture, scene.text, view));
        progress_note(p->progress, (size_t)k, range_count(which), what);
    }
    TRY(children_wait(&p->children));
done:
    if (!p->keep_scenes)
        remove_temporary(p, &scene);
    return st;
}
