#include "field/aov.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "field/channels.h"
#include "field/light.h"
#include "job/palette.h"

const struct job_camera *camera_named(const struct job *job, const char *name)
{
    for (size_t i = 0; i < job->n_cameras; i++)
        if (strcmp(job->cameras[i].name, name) == 0)
            return &job->cameras[i];
    return NULL;
}

static void overscan_of(const struct job_camera *c, int margin[2])
{
    for (int a = 0; a < 2; a++)
        margin[a] = (int)ceil(c->overscan * c->resolution[a]);
}

size_t aov_camera_pixels(const struct job_camera *c)
{
    int margin[2];
    overscan_of(c, margin);
    return ((size_t)c->resolution[0] + 2 * (size_t)margin[0]) *
           ((size_t)c->resolution[1] + 2 * (size_t)margin[1]);
}

size_t aov_pixels(const struct job *job)
{
    size_t most = 0;
    for (size_t i = 0; i < job->output.aov.n_cameras; i++) {
        const struct job_camera *c = camera_named(job, job->output.aov.cameras[i]);
        size_t n = c ? aov_camera_pixels(c) : 0;
        most = n > most ? n : most;
    }
    return most;
}

uint64_t aov_bytes(size_t n_pixels)
{
    return (uint64_t)n_pixels * (4 * 16 + 12 + 4);
}

uint64_t aov_picture_bytes(const struct job *job)
{
    return (uint64_t)aov_pixels(job) * sizeof(float) * aov_channel_count(job);
}

status aov_create(struct gpu *gpu, const struct job *job, size_t n_pixels, struct aov *a)
{
    status st = OK;
    float(*palette)[4] = NULL;
    *a = (struct aov){.n_pixels = n_pixels};
    TRY(gpu_buffer_create(gpu, "ray hits", n_pixels, 16, &a->hit));
    TRY(gpu_buffer_create(gpu, "ray normals", n_pixels, 16, &a->facing));
    TRY(gpu_buffer_create(gpu, "picture", n_pixels, 16, &a->color));
    TRY(gpu_buffer_create(gpu, "picture means", n_pixels, 16, &a->means));
    TRY(gpu_buffer_create(gpu, "picture ids", 3 * n_pixels, 4, &a->ids));
    TRY(gpu_buffer_create(gpu, "picture values", n_pixels, 4, &a->pixel));
    TRY(gpu_buffer_create(gpu, "still air", 1, 16, &a->still));
    TRY(gpu_buffer_create(gpu, "palette", palette_size(job), 16, &a->palette));
    TRY(memory_alloc(palette_size(job), sizeof *palette, "the palette", &palette));
    for (size_t i = 0; i < palette_size(job); i++)
        palette_color(job, i, palette[i]);
    TRY(gpu_upload(gpu, a->palette, 0, palette, palette_size(job)));
done:
    free(palette);
    if (st != OK)
        aov_destroy(gpu, a);
    return st;
}

void aov_destroy(struct gpu *gpu, struct aov *a)
{
    gpu_buffer_destroy(gpu, &a->hit);
    gpu_buffer_destroy(gpu, &a->facing);
    gpu_buffer_destroy(gpu, &a->color);
    gpu_buffer_destroy(gpu, &a->means);
    gpu_buffer_destroy(gpu, &a->ids);
    gpu_buffer_destroy(gpu, &a->pixel);
    gpu_buffer_destroy(gpu, &a->still);
    gpu_buffer_destroy(gpu, &a->palette);
}

static void put3(float *x, float *y, float *z, const double v[3])
{
    *x = (float)v[0];
    *y = (float)v[1];
    *z = (float)v[2];
}

/* Renders one sample of each pixel. Sample 0 is the pixel's centre; the others are evenly distributed. */
static void record_sample(struct gpu *gpu, struct aov *a, const struct camera *c, const struct light *light,
                          const struct field *f, const struct particles *p, int sample, int samples)
{
    struct march_params march = {
        .n = (uint)(c->width * c->height),
        .width = (uint)c->width,
        .height = (uint)c->height,
        .fx = (uint)f->n[0],
        .fy = (uint)f->n[1],
        .fz = (uint)f->n[2],
        .voxel = (float)f->voxel,
        .ray = (uint)sample,
        .rays = (uint)samples,
        .ground = a->ground,
        .cut = f->cut.keeps == CUT_NONE
                   ? 0
                   : (f->cut.keeps == CUT_LOW ? CUT_KEEPS_LOW : CUT_KEEPS_HIGH) | (uint)f->cut.axis,
        .cut_at = (float)f->cut.at,
        .film_x = (float)fmod(0.5 + sample * 0.7548776662, 1),
        .film_y = (float)fmod(0.5 + sample * 0.5698402910, 1),
    };
    put3(&march.origin_x, &march.origin_y, &march.origin_z, f->origin);
    put3(&march.eye_x, &march.eye_y, &march.eye_z, c->eye);
    put3(&march.right_x, &march.right_y, &march.right_z, c->right);
    put3(&march.down_x, &march.down_y, &march.down_z, c->down);
    put3(&march.ahead_x, &march.ahead_y, &march.ahead_z, c->ahead);
    put3(&march.sun_x, &march.sun_y, &march.sun_z, light->sun);
    struct shade_params shade = {
        .n = march.n,
        .nx = (uint)p->voxels[0],
        .ny = (uint)p->voxels[1],
        .nz = (uint)p->voxels[2],
        .h = (float)p->h,
        .fx = march.fx,
        .fy = march.fy,
        .fz = march.fz,
        .voxel = march.voxel,
        .origin_x = march.origin_x,
        .origin_y = march.origin_y,
        .origin_z = march.origin_z,
        .sun_x = march.sun_x,
        .sun_y = march.sun_y,
        .sun_z = march.sun_z,
        .ray = march.ray,
        .rays = march.rays,
    };
    put3(&shade.sun_r, &shade.sun_g, &shade.sun_b, light->sun_rgb);
    put3(&shade.sky_r, &shade.sky_g, &shade.sky_b, light->sky_rgb);
    put3(&shade.bounce_r, &shade.bounce_g, &shade.bounce_b, light->bounce_rgb);
    GPU_RUN(gpu, field_march, march.n, march, f->slot, f->distance, a->hit, a->facing);
    GPU_RUN(gpu, field_shade, shade.n, shade, a->hit, a->facing, f->means, p->field[ROCK_P], p->start,
            p->field[ROCK_layer], p->field[ROCK_phase], p->field[ROCK_vegetation], a->palette, a->color,
            a->means, a->ids, f->slot, p->held.words);
}

/* Renders all samples, the pixel's centre last, and adds each to the mattes. */
static status sample(struct gpu *gpu, struct aov *a, const struct job *job, const struct camera *c,
                     const struct light *light, const struct field *f, const struct particles *p,
                     struct mattes *mattes, uint32_t *ids)
{
    status st = OK;
    size_t n = (size_t)c->width * (size_t)c->height;
    int samples = (int)job->output.aov.samples;
    float *hit = NULL;
    if (mattes)
        TRY(memory_alloc(n, 4 * sizeof *hit, "a picture", &hit));
    for (int s = samples - 1; s >= 0; s--) {
        record_sample(gpu, a, c, light, f, p, s, samples);
        if (!mattes)
            continue;
        TRY(gpu_download(gpu, a->ids, 0, ids, 3 * n));
        TRY(gpu_download(gpu, a->hit, 0, hit, n));
        mattes_add(mattes, ids, hit);
    }
done:
    free(hit);
    return st;
}

/* Motion vectors: the position of each pixel's surface point in the next frame's image relative to this pixel, px, x to the right and y up;
 * motion of the rock and of the camera. */
static status find_motion(struct gpu *gpu, const struct job *job, const struct job_camera *camera, int frame,
                          const struct particles *p, const float *hit, const uint32_t *ids, float *motion)
{
    status st = OK;
    const struct camera now = camera_of(camera, frame), next = camera_of(camera, frame + 1);
    int margin[2];
    float *v = NULL;
    overscan_of(camera, margin);
    size_t n = ((size_t)now.width + 2 * (size_t)margin[0]) * ((size_t)now.height + 2 * (size_t)margin[1]);
    TRY(memory_alloc(4 * p->n, sizeof *v, "velocities", &v));
    if (p->field[ROCK_v])
        TRY(gpu_download(gpu, p->field[ROCK_v], 0, v, p->n));
    for (size_t i = 0; i < n; i++) {
        double from[2], to[2], x[3], then[3];
        if (hit[4 * i + 3] < 0)
            continue;
        for (size_t a = 0; a < 3; a++) {
            x[a] = (double)hit[4 * i + a];
            then[a] = x[a] + (double)v[4 * (size_t)ids[3 * i + 2] + a] / job->fps;
        }
        if (!camera_project(&now, x, from) || !camera_project(&next, then, to))
            continue;
        motion[4 * i] = (float)(to[0] - from[0]);
        motion[4 * i + 1] = (float)(from[1] - to[1]);
    }
done:
    free(v);
    return st;
}

static void seen_free(struct hits *s)
{
    free(s->hit);
    free(s->facing);
    free(s->color);
    free(s->means);
    free(s->motion);
    free(s->ids);
}

static status download_seen(struct gpu *gpu, const struct aov *a, size_t n, struct hits *s)
{
    status st = OK;
    TRY(gpu_download(gpu, a->ids, 0, s->ids, 3 * n));
    const struct {
        struct gpu_buffer *from;
        float **to;
    } each[] = {{a->hit, &s->hit}, {a->facing, &s->facing}, {a->color, &s->color}, {a->means, &s->means}};
    for (size_t i = 0; i < sizeof each / sizeof *each; i++) {
        TRY(memory_alloc(n, 4 * sizeof(float), "a picture", each[i].to));
        TRY(gpu_download(gpu, each[i].from, 0, *each[i].to, n));
    }
done:
    return st;
}

status aov_render(struct gpu *gpu, struct aov *a, const struct job *job, const struct job_camera *camera,
                  int frame, const struct field *f, const struct particles *p, const struct aov_air *air,
                  struct aov_image *out)
{
    status st = OK;
    const struct camera view = camera_of(camera, frame);
    int margin[2];
    overscan_of(camera, margin);
    const struct camera c = camera_overscan(view, margin);
    const struct light light = light_of(job, frame);
    size_t n = (size_t)c.width * (size_t)c.height;
    struct hits hits = {0};
    struct mattes *mattes = NULL;
    *out = (struct aov_image){
        .camera = camera->name, .width = c.width, .height = c.height, .margin = {margin[0], margin[1]}};
    TRY(memory_alloc(n, 3 * sizeof(uint32_t), "a picture", &hits.ids));
    if (job->output.aov.cryptomatte)
        TRY(mattes_create(job, n, &mattes));
    TRY(sample(gpu, a, job, &c, &light, f, p, mattes, hits.ids));
    TRY(download_seen(gpu, a, n, &hits));
    if (job->clock.seconds_per_frame > 0 && job_wants_layer(job, value_table[VALUE_motion].layer)) {
        TRY(memory_alloc(n, 4 * sizeof(float), "a picture", &hits.motion));
        TRY(find_motion(gpu, job, camera, frame, p, hits.hit, hits.ids, hits.motion));
    }
    TRY(channels_begin(job, out));
    for (int v = 1; v < VALUES; v++)
        if (value_table[v].channel[0] && job_wants_layer(job, value_table[v].layer))
            TRY(channels_add(gpu, a, job, p, air, &hits, (enum value_id)v, out));
    if (mattes)
        TRY(channels_mattes(job, mattes, out));
    camera_matrices(&view, job->output.up, out->world_to_camera, out->world_to_ndc);
done:
    seen_free(&hits);
    mattes_destroy(&mattes);
    if (st != OK)
        aov_image_free(out);
    return st;
}

status aov_render_all(struct gpu *gpu, struct aov *a, const struct job *job, const struct field *f,
                      const struct particles *p, const struct aov_air *air, struct frame *out)
{
    status st = OK;
    TRY(memory_alloc(job->output.aov.n_cameras, sizeof *out->image, "pictures", &out->image));
    for (size_t i = 0; i < job->output.aov.n_cameras; i++)
        TRY(aov_render(gpu, a, job, camera_named(job, job->output.aov.cameras[i]), out->number, f, p, air,
                       &out->image[out->n_images++]));
done:
    return st;
}
