#include "frame/stage.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "base/vector.h"
#include "field/camera.h"
#include "field/light.h"
#include "frame/meshes.h"
#include "frame/rocks.h"
#include "job/palette.h"
#include "output/axes.h"
#include "output/product.h"
#include "text/json.h"
#include "usd/usd.h"

enum { MAX_FIELDS = VALUES };

struct stage {
    const struct job *job;
    const char *root;
    bool last; /* this is the final stage of a run */
    struct usd_sequence sequence;
    struct usd_field field[MAX_FIELDS];
    int *volumes, *meshes, *points, *rocks; /* frames */
    struct usd_camera *camera;              /* their keys are owned too */
    struct usd_light *light;
};

/* ---- frames */

/* Reports what is left out. While the run goes on, the stage is written again. */
static void left_out(const struct stage *s, const char *what, const char *why)
{
    if (s->last)
        log_warn("%s is not in %s.usda: %s", what, s->job->name, why);
    else
        log_info("%s is not in %s.usda yet: %s", what, s->job->name, why);
}

static void frame_left_out(const struct stage *s, int frame)
{
    char what[40], why[600];
    snprintf(what, sizeof what, "frame %d", frame);
    snprintf(why, sizeof why, "%s", status_message());
    if (range_holds(s->job->frames, frame))
        left_out(s, what, why);
}

/* Reads the manifest of a frame. *bad, unless "": the problem of its files. */
static status read_manifest(const struct stage *s, int number, struct manifest *m, const char **bad)
{
    status st = manifest_read(s->root, s->job->name, number, m);
    return st == OK ? manifest_check(s->root, m, false, bad) : st;
}

/* *sound: the frame is done and belongs to this job. */
static status read_frame(const struct stage *s, const struct job_states *states, int number,
                         struct stage_frame *out, bool *sound)
{
    status st = OK;
    const char *bad = "";
    struct manifest m = {0};
    *sound = false;
    st = read_manifest(s, number, &m, &bad);
    if (s->last && st != E_MEMORY &&
        (st != OK || *bad)) { /* a disk may fail once, and nothing looks again after this */
        manifest_free(&m);
        m = (struct manifest){0};
        bad = "";
        st = read_manifest(s, number, &m, &bad);
    }
    if (st != E_MEMORY && (st != OK || *bad))
        frame_left_out(s, number);
    if (st == E_INPUT && !(s->last && range_holds(s->job->frames, number))) {
        st = OK;
        goto done;
    }
    TRY(st); /* at the end, the frame would be missing from the sequence, and the run would say that all is done */
    *sound = !*bad && (!states || job_states_hold(states, number, m.job_hash)) &&
             range_holds(s->job->frames, number);
    *out = (struct stage_frame){.number = number,
                                .volumes = manifest_lists(&m, "volumes/", ".vdb"),
                                .points = manifest_lists(&m, "points/", ".usdc"),
                                .rocks = manifest_lists(&m, "rocks/", ".usdc")};
done:
    manifest_free(&m);
    return st;
}

/* Updates `known`, in ascending order; the manifests of frames that it has already are not read again. */
static status find_frames(const struct stage *s, const struct job_states *states, struct stage_frames *known)
{
    status st = OK;
    int *number = NULL;
    size_t n, n_found = 0, k = 0;
    struct stage_frame *found = NULL;
    TRY(folder_frames(s->root, s->job->name, &number, &n));
    TRY(memory_alloc(n, sizeof *found, "frames", &found));
    for (size_t i = 0; i < n; i++) {
        bool sound = true;
        while (k < known->n && known->frame[k].number < number[i])
            k++;
        if (k < known->n && known->frame[k].number == number[i])
            found[n_found] = known->frame[k];
        else
            TRY(read_frame(s, states, number[i], &found[n_found], &sound));
        n_found += sound;
    }
    stage_frames_free(known);
    *known = (struct stage_frames){.frame = found, .n = n_found};
    found = NULL;
done:
    free(number);
    free(found);
    return st;
}

static status list_frames(struct stage *s, const struct stage_frames *known)
{
    status st = OK;
    struct usd_sequence *q = &s->sequence;
    TRY(memory_alloc(known->n, sizeof *s->volumes, "frame numbers", &s->volumes));
    TRY(memory_alloc(known->n, sizeof *s->points, "frame numbers", &s->points));
    TRY(memory_alloc(known->n, sizeof *s->rocks, "frame numbers", &s->rocks));
    for (size_t i = 0; i < known->n; i++) {
        const struct stage_frame *f = &known->frame[i];
        if (f->volumes)
            s->volumes[q->n_volumes++] = f->number;
        if (f->points)
            s->points[q->n_points++] = f->number;
        if (f->rocks)
            s->rocks[q->n_rocks++] = f->number;
    }
done:
    return st;
}

/* *current: the mesh has a record and is made from the frame as it is now. One without a record is being made, and its task writes the
 * stage, too. */
static status find_mesh(const struct stage *s, const char *path, bool *current)
{
    status st = OK;
    struct product product = {0};
    struct path record, full;
    char why[600];
    *current = false;
    TRY(product_record(&record, path));
    TRY(path_join(&full, s->root, record.text));
    if (access(full.text, F_OK) != 0 && errno == ENOENT)
        goto done;
    st = product_read(s->root, path, &product);
    if (st == E_INPUT)
        st = product_read(s->root, path, &product);
    if (st == E_INPUT) {
        snprintf(why, sizeof why, "%s", status_message());
        left_out(s, path, why);
        st = OK;
        goto done;
    }
    TRY(st);
    st = product_check(s->root, s->job->name, &product, false);
    *current = st == OK;
    st = st == E_MEMORY ? st : OK;
done:
    product_free(&product);
    return st;
}

/* Meshes are products that are made after the frames; those made from the listed frames are listed. */
static status list_meshes(struct stage *s, const struct stage_frames *known)
{
    status st = OK;
    struct usd_sequence *q = &s->sequence;
    int *existing = NULL;
    size_t n, k = 0;
    st = folder_list(s->root, s->job->name, FILE_MESH_USD, &existing, &n);
    if (st == E_INPUT && s->last)
        st = folder_list(s->root, s->job->name, FILE_MESH_USD, &existing, &n);
    if (st == E_INPUT) { /* a run must not fail because its mesh folder cannot be read */
        char why[600];
        snprintf(why, sizeof why, "%s", status_message());
        left_out(s, "the sequence of meshes", why);
        st = OK;
        n = 0;
    }
    TRY(st);
    TRY(memory_alloc(n, sizeof *s->meshes, "frame numbers", &s->meshes));
    for (size_t i = 0; i < n; i++) {
        struct path path;
        bool current = true;
        while (k < known->n && known->frame[k].number < existing[i])
            k++;
        if (k == known->n || known->frame[k].number != existing[i])
            continue;
        /* Records are read only at the end: reading all of them at every checkpoint would be quadratic over a run. */
        if (s->last) {
            TRY(folder_name(&path, s->job->name, FILE_MESH_USD, existing[i], NULL));
            TRY(find_mesh(s, path.text, &current));
        }
        if (current)
            s->meshes[q->n_meshes++] = existing[i];
    }
    meshes_prim(s->job, &q->mesh);
    q->meshes_frame = s->meshes;
done:
    free(existing);
    return st;
}

void stage_frames_free(struct stage_frames *frames)
{
    free(frames->frame);
    *frames = (struct stage_frames){0};
}

/* ---- fields: those of the last volumes */

static bool to_vector(const struct json *array, double out[3])
{
    if (!array || array->kind != JSON_ARRAY || array->n != 3)
        return false;
    const struct json *item = array->first;
    for (int a = 0; a < 3; a++, item = item->next) {
        if (item->kind != JSON_NUMBER || !isfinite(item->number))
            return false;
        out[a] = item->number;
    }
    return true;
}

static void add_field(struct stage *s, const struct json *grid)
{
    struct usd_sequence *q = &s->sequence;
    const char *name = json_to_text(json_member(grid, "name")),
               *type = json_to_text(json_member(grid, "type")),
               *kind = json_to_text(json_member(grid, "class"));
    const struct json *bounds = json_member(grid, "bounds_m");
    double low[3], high[3];
    if (!name || !*name || !type || !kind || q->n_fields == MAX_FIELDS ||
        !to_vector(json_member(bounds, "min"), low) || !to_vector(json_member(bounds, "max"), high))
        return;
    struct usd_field *f = &s->field[q->n_fields];
    for (int a = 0; a < 3; a++) {
        q->low[a] = q->n_fields ? fmin(q->low[a], low[a]) : low[a];
        q->high[a] = q->n_fields ? fmax(q->high[a], high[a]) : high[a];
    }
    snprintf(f->name, sizeof f->name, "%s", name);
    f->vector = strncmp(type, "vec3", 4) == 0;
    f->kind = strcmp(kind, "level set") == 0    ? GRID_LEVEL_SET
              : strcmp(kind, "fog volume") == 0 ? GRID_FOG
                                                : GRID_PLAIN;
    q->n_fields++;
}

static status find_fields(struct stage *s)
{
    status st = OK;
    struct path path;
    struct text t = {0};
    struct json *json = NULL;
    if (s->sequence.n_volumes == 0)
        return OK;
    TRY(folder_path(&path, s->root, s->job->name, FILE_VOLUMES, s->volumes[s->sequence.n_volumes - 1], NULL));
    st = vdb_describe_lattices(path.text, &t);
    if (st == OK)
        st = json_read(path.text, t.data, t.size, &json);
    if (st == E_INPUT) {
        text_free(&t);
        st = vdb_describe_lattices(path.text, &t);
        if (st == OK)
            st = json_read(path.text, t.data, t.size, &json);
    }
    if (st != OK && st != E_MEMORY) {
        char why[600];
        snprintf(why, sizeof why, "%s", status_message());
        left_out(s, "the sequence of volumes", why);
        st = OK;
        goto done;
    }
    TRY(st);
    const struct json *grids = json_member(json, "grids");
    for (const struct json *g = grids ? grids->first : NULL; g; g = g->next)
        add_field(s, g);
done:
    if (json)
        json_free(&json);
    text_free(&t);
    return st;
}

/* ---- cameras */

/* Sets m to the camera's transform. A USD camera looks along its -z axis. */
static void to_world(const struct camera *c, int up, double m[16])
{
    double wide = 0, high = 0, row[3][3];
    for (int a = 0; a < 3; a++) {
        wide += c->right[a] * c->right[a];
        high += c->down[a] * c->down[a];
    }
    for (int a = 0; a < 3; a++) {
        row[0][a] = c->right[a] / sqrt(wide);
        row[1][a] = -c->down[a] / sqrt(high);
        row[2][a] = -c->ahead[a];
    }
    memset(m, 0, 16 * sizeof *m);
    for (int r = 0; r < 3; r++)
        axes_turn_exact(row[r], up, m + 4 * r);
    axes_turn_exact(c->eye, up, m + 12);
    m[15] = 1;
}

static struct usd_key key_at(const struct job_camera *from, int up, int frame)
{
    const struct camera camera = camera_of(from, frame);
    struct usd_key key = {.frame = frame, .focal_mm = curve_at(&from->focal_mm, frame)};
    to_world(&camera, up, key.to_world);
    return key;
}

/* A static camera has one key. A moving camera has one for every frame, so that between frames USD interpolates it as motion blur
 * expects. */
static status add_camera(struct stage *s, const struct job_camera *from)
{
    status st = OK;
    const struct frame_range frames = s->job->frames;
    const int up = s->job->output.up;
    const struct usd_key first = key_at(from, up, frames.first);
    struct usd_camera *to = &s->camera[s->sequence.n_cameras];
    struct usd_key *key = NULL;
    size_t n = 1;
    for (int f = frames.first + 1; f <= frames.last && n == 1; f++) {
        const struct usd_key other = key_at(from, up, f);
        if (other.focal_mm != first.focal_mm ||
            memcmp(other.to_world, first.to_world, sizeof first.to_world) != 0)
            n = (size_t)(frames.last - frames.first) + 1;
    }
    TRY(memory_alloc(n, sizeof *key, "a camera's keys", &key));
    for (size_t i = 0; i < n; i++)
        key[i] = key_at(from, up, frames.first + (int)i);
    *to = (struct usd_camera){.name = from->name,
                              .width_mm = from->aperture_mm,
                              .height_mm = from->aperture_mm * from->resolution[1] / from->resolution[0],
                              .n_keys = n,
                              .key = key};
    s->sequence.n_cameras++;
done:
    return st;
}

/* A USD distant light shines along its -z axis; its rotation about that axis is arbitrary. */
static struct usd_light light_at(const struct job *job, int frame)
{
    const struct light light = light_of(job, frame);
    const double axis[3] = {fabs(light.sun[2]) > 0.9, 0, !(fabs(light.sun[2]) > 0.9)};
    struct camera shines = {0};
    struct usd_light out = {.frame = frame};
    for (int a = 0; a < 3; a++) {
        shines.ahead[a] = -light.sun[a];
        out.sun[a] = light.sun_rgb[a];
        out.sky[a] = light.sky_rgb[a];
    }
    cross3(shines.ahead, axis, shines.right);
    cross3(shines.ahead, shines.right, shines.down);
    to_world(&shines, job->output.up, out.to_world);
    return out;
}

static status find_lights(struct stage *s)
{
    status st = OK;
    const struct frame_range frames = s->job->frames;
    size_t n = light_changes(s->job) ? (size_t)(frames.last - frames.first) + 1 : 1;
    TRY(memory_alloc(n, sizeof *s->light, "sun and sky", &s->light));
    for (size_t i = 0; i < n; i++)
        s->light[i] = light_at(s->job, frames.first + (int)i);
    s->sequence.light = s->light;
    s->sequence.n_lights = n;
done:
    return st;
}

static status find_cameras(struct stage *s)
{
    status st = OK;
    TRY(memory_alloc(s->job->n_cameras, sizeof *s->camera, "cameras", &s->camera));
    s->sequence.camera = s->camera;
    for (size_t i = 0; i < s->job->n_cameras; i++)
        TRY(add_camera(s, &s->job->cameras[i]));
done:
    return st;
}

/* ---- files */

static status put(const struct stage *s, const char *path, struct text *t)
{
    static const char *const command[] = {"run"};
    const struct recipe recipe = {.root = s->root, .word = command, .n_words = 1, .frame = ALL_FRAMES};
    status st = text_status(t);
    if (st == OK)
        st = product_write(&recipe, path, t->data, t->size);
    text_free(t);
    return st;
}

static status put_clips(const struct stage *s, const struct usd_prim *prim)
{
    status st = OK;
    struct path path;
    struct text t = {0};
    TRY(path_format(&path, "%s/%s.clips.usda", prim->folder, s->job->name));
    usd_clips(&s->sequence, prim, &t);
    TRY(put(s, path.text, &t));
done:
    return st;
}

/* The rocks' shapes, which are the same for all frames. */
static status put_shapes(struct stage *s)
{
    status st = OK;
    struct path path;
    struct text t = {0};
    struct pile_tile tile;
    struct usd_shape *shape = NULL;
    TRY(rocks_tile(s->job, &tile));
    TRY(memory_alloc(tile.n, sizeof *shape, "rocks", &shape));
    for (size_t i = 0; i < tile.n; i++)
        shape[i] = (struct usd_shape){tile.rock[i].n_vertices, tile.rock[i].vertex, tile.rock[i].normal};
    struct usd_shapes shapes = {.up = s->job->output.up,
                                .n = tile.n,
                                .n_triangles = tile.n_triangles,
                                .shape = shape,
                                .triangle = tile.triangle};
    palette_color(s->job, rocks_layer(s->job), shapes.color);
    s->sequence.n_shapes = tile.n;
    TRY(path_format(&path, "rocks/%s.shapes.usda", s->job->name));
    usd_shapes(&shapes, &t);
    TRY(put(s, path.text, &t));
done:
    free(shape);
    pile_tile_destroy(&tile);
    return st;
}

status stage_write(const struct job *job, const struct job_states *states, const char *root,
                   struct stage_frames *known)
{
    status st = OK;
    struct stage_frames all = {0};
    struct path path;
    struct text t = {0};
    struct stage s = {.job = job,
                      .root = root,
                      .last = !known,
                      .sequence = {.name = job->name,
                                   .first = job->frames.first,
                                   .last = job->frames.last,
                                   .fps = job->fps,
                                   .moves = job->clock.seconds_per_frame > 0,
                                   .up = job->output.up}};
    if (!known)
        known = &all;
    TRY(find_frames(&s, states, known));
    if (known->n == 0)
        goto done;
    TRY(list_frames(&s, known));
    TRY(list_meshes(&s, known));
    TRY(find_fields(&s));
    TRY(find_cameras(&s));
    TRY(find_lights(&s));
    s.sequence.field = s.field;
    s.sequence.volumes_frame = s.volumes;
    s.sequence.points_frame = s.points;
    s.sequence.rocks_frame = s.rocks;
    if (s.sequence.n_meshes)
        TRY(put_clips(&s, &s.sequence.mesh));
    if (s.sequence.n_points)
        TRY(put_clips(&s, usd_points_prim(s.sequence.moves)));
    if (s.sequence.n_rocks) {
        TRY(put_clips(&s, &usd_rocks_prim));
        TRY(put_shapes(&s));
    }
    TRY(folder_name(&path, job->name, FILE_STAGE, 0, NULL));
    usd_stage(&s.sequence, &t);
    TRY(put(&s, path.text, &t));
done:
    stage_frames_free(&all);
    free(s.volumes);
    free(s.meshes);
    free(s.points);
    free(s.rocks);
    for (size_t i = 0; i < s.sequence.n_cameras; i++)
        free((void *)s.camera[i].key);
    free(s.camera);
    free(s.light);
    return st;
}
