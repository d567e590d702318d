#include "field/aov.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/palette.h"

/* Towards the sun: late morning, from the left behind the usual camera. */
static const double SUN[3] = {-0.48, -0.62, 0.62};

static const struct job_camera *camera_named(const struct job *job, const char *name)
{
    for (size_t i = 0; i < job->n_cameras; i++)
        if (strcmp(job->cameras[i].name, name) == 0)
            return &job->cameras[i];
    return NULL;
}

size_t aov_pixels(const struct job *job)
{
    size_t most = 0;
    for (size_t i = 0; i < job->output.aov.n_cameras; i++) {
        const struct job_camera *c = camera_named(job, job->output.aov.cameras[i]);
        size_t n = c ? (size_t)c->resolution[0] * (size_t)c->resolution[1] : 0;
        most = n > most ? n : most;
    }
    return most;
}

uint64_t aov_bytes(size_t n_pixels)
{
    return (uint64_t)n_pixels * (4 * 16 + 8);
}

status aov_create(struct gpu *gpu, const struct job *job, size_t n_pixels, struct aov *a)
{
    status st = OK;
    float(*palette)[4] = NULL;
    *a = (struct aov){.n_pixels = n_pixels};
    TRY(gpu_buffer_create(gpu, "ray hits", n_pixels, 16, &a->hit));
    TRY(gpu_buffer_create(gpu, "ray normals", n_pixels, 16, &a->facing));
    TRY(gpu_buffer_create(gpu, "picture", n_pixels, 16, &a->color));
    TRY(gpu_buffer_create(gpu, "picture fields", n_pixels, 16, &a->fields));
    TRY(gpu_buffer_create(gpu, "picture ids", 2 * n_pixels, 4, &a->ids));
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
    gpu_buffer_destroy(gpu, &a->fields);
    gpu_buffer_destroy(gpu, &a->ids);
    gpu_buffer_destroy(gpu, &a->palette);
}

static void record(struct gpu *gpu, struct aov *a, const struct camera *c, const struct field *f,
                   const struct particles *p)
{
    double length = sqrt(SUN[0] * SUN[0] + SUN[1] * SUN[1] + SUN[2] * SUN[2]);
    struct march_params march = {
        .n = (uint)(c->width * c->height),
        .width = (uint)c->width,
        .height = (uint)c->height,
        .fx = (uint)f->n[0],
        .fy = (uint)f->n[1],
        .fz = (uint)f->n[2],
        .voxel = (float)f->voxel,
        .origin_x = (float)f->origin[0],
        .origin_y = (float)f->origin[1],
        .origin_z = (float)f->origin[2],
        .eye_x = (float)c->eye[0],
        .eye_y = (float)c->eye[1],
        .eye_z = (float)c->eye[2],
        .right_x = (float)c->right[0],
        .right_y = (float)c->right[1],
        .right_z = (float)c->right[2],
        .down_x = (float)c->down[0],
        .down_y = (float)c->down[1],
        .down_z = (float)c->down[2],
        .ahead_x = (float)c->ahead[0],
        .ahead_y = (float)c->ahead[1],
        .ahead_z = (float)c->ahead[2],
        .sun_x = (float)(SUN[0] / length),
        .sun_y = (float)(SUN[1] / length),
        .sun_z = (float)(SUN[2] / length),
    };
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
    };
    GPU_RUN(gpu, field_march, march.n, march, f->distance, a->hit, a->facing);
    GPU_RUN(gpu, field_shade, shade.n, shade, a->hit, a->facing, f->means, p->field[ROCK_P], p->start,
            p->field[ROCK_layer], p->field[ROCK_phase], p->field[ROCK_erodibility], a->palette, a->color,
            a->fields, a->ids);
}

/* From which of the downloaded vectors, and which component, each channel comes; `vector` rows are turned to
 * the files' up axis. */
enum { FROM_HIT, FROM_FACING, FROM_COLOR, FROM_FIELDS, FROM_IDS };
static const struct {
    const char *part, *name;
    int from, component, vector, half;
} channels[] = {
    {"rgba", "R", FROM_COLOR, 0, 0, 1},
    {"rgba", "G", FROM_COLOR, 1, 0, 1},
    {"rgba", "B", FROM_COLOR, 2, 0, 1},
    {"rgba", "A", FROM_COLOR, 3, 0, 1},
    {"depth", "Z", FROM_HIT, 3, 0, 0},
    {"N", "N.X", FROM_FACING, 0, 1, 0},
    {"N", "N.Y", FROM_FACING, 1, 1, 0},
    {"N", "N.Z", FROM_FACING, 2, 1, 0},
    {"P", "P.X", FROM_HIT, 0, 1, 0},
    {"P", "P.Y", FROM_HIT, 1, 1, 0},
    {"P", "P.Z", FROM_HIT, 2, 1, 0},
    {"stress", "stress.trace", FROM_FIELDS, 0, 0, 0},
    {"stress", "stress.von_mises", FROM_FIELDS, 1, 0, 0},
    {"viability", "viability.Y", FROM_FIELDS, 2, 0, 0},
    {"erodibility", "erodibility.Y", FROM_FIELDS, 3, 0, 0},
    {"layer", "layer.id", FROM_IDS, 0, 0, 0},
    {"phase", "phase.id", FROM_IDS, 1, 0, 0},
};
enum { CHANNELS = sizeof channels / sizeof *channels };

/* Depth of pixels without rock: farther than anything. */
static const float NOTHING = 1e10f;

static void split(struct aov_image *image, size_t n, float *const source[4], const uint32_t *ids, int up)
{
    float *plane = image->memory;
    for (size_t c = 0; c < CHANNELS; c++, plane += n) {
        struct aov_channel *out = &image->channel[c];
        *out = (struct aov_channel){
            .part = channels[c].part, .name = channels[c].name, .half = channels[c].half};
        if (channels[c].from == FROM_IDS) {
            uint32_t *id = (uint32_t *)plane;
            for (size_t i = 0; i < n; i++)
                id[i] = ids[2 * i + (size_t)channels[c].component];
            out->id = id;
            continue;
        }
        const float *from = source[channels[c].from];
        size_t component = (size_t)channels[c].component;
        float sign = 1;
        if (channels[c].vector && up == OUTPUT_UP_Y && component > 0) { /* (x, z, -y) */
            sign = component == 2 ? -1.0f : 1.0f;
            component = 3 - component;
        }
        for (size_t i = 0; i < n; i++) {
            bool nothing = source[FROM_HIT][4 * i + 3] < 0;
            plane[i] = !nothing ? sign * from[4 * i + component] : channels[c].name[0] == 'Z' ? NOTHING : 0;
        }
        out->value = plane;
    }
}

status aov_render(struct gpu *gpu, struct aov *a, const struct job *job, const struct job_camera *camera,
                  const struct field *f, const struct particles *p, struct aov_image *out)
{
    status st = OK;
    struct camera c = camera_of(camera);
    size_t n = (size_t)c.width * (size_t)c.height;
    float *source[4] = {NULL};
    uint32_t *ids = NULL;
    struct gpu_buffer *from[4] = {a->hit, a->facing, a->color, a->fields};
    *out = (struct aov_image){
        .camera = camera->name, .width = c.width, .height = c.height, .n_channels = CHANNELS};
    TRY(memory_alloc(CHANNELS, sizeof *out->channel, "channels", &out->channel));
    TRY(memory_alloc(n * CHANNELS, sizeof(float), "a picture", &out->memory));
    record(gpu, a, &c, f, p);
    for (int s = 0; s < 4; s++) {
        TRY(memory_alloc(n, 4 * sizeof(float), "a picture", &source[s]));
        TRY(gpu_download(gpu, from[s], 0, source[s], n));
    }
    TRY(memory_alloc(n, 2 * sizeof(uint32_t), "a picture", &ids));
    TRY(gpu_download(gpu, a->ids, 0, ids, 2 * n));
    split(out, n, source, ids, job->output.up);
    camera_matrices(&c, job->output.up, out->world_to_camera, out->world_to_ndc);
done:
    for (int s = 0; s < 4; s++)
        free(source[s]);
    free(ids);
    if (st != OK)
        aov_image_free(out);
    return st;
}

void aov_image_free(struct aov_image *image)
{
    free(image->channel);
    free(image->memory);
    memset(image, 0, sizeof *image);
}
