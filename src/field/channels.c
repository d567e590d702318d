#include "field/channels.h"

#include "base/memory.h"

/* Depth of pixels without rock. */
static const float NOTHING = 1e10f;

static size_t pixels_of(const struct aov_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

size_t aov_channel_count(const struct job *job)
{
    size_t n = job->output.aov.cryptomatte ? MATTE_CHANNELS : 0;
    for (int v = 1; v < VALUES; v++)
        for (int c = 0; c < VALUE_CHANNELS && value_table[v].channel[c]; c++)
            n += job_wants_layer(job, value_table[v].layer);
    return n;
}

status channels_begin(const struct job *job, struct aov_image *out)
{
    status st = OK;
    const size_t count = aov_channel_count(job);
    TRY(memory_alloc(count, sizeof *out->channel, "channels", &out->channel));
    TRY(memory_alloc(pixels_of(out) * count, sizeof(float), "a picture", &out->memory));
done:
    return st;
}

/* The plane of the value's next channel, for the caller to fill: float, or uint32_t for KIND_ID. */
static void *plane_of(struct aov_image *out, enum value_id value, int channel)
{
    const struct value *v = &value_table[value];
    float *plane = (float *)out->memory + out->n_channels * pixels_of(out);
    struct aov_channel *c = &out->channel[out->n_channels++];
    *c = (struct aov_channel){.part = v->layer, .name = v->channel[channel], .half = v->from == FROM_COLOR};
    if (v->kind == KIND_ID)
        c->id = (uint32_t *)(void *)plane;
    else
        c->value = plane;
    return plane;
}

/* Fills all channels of a value from vectors, starting with their component `first`. */
static void fill(const struct job *job, struct aov_image *out, enum value_id value, const float *from,
                 int first, const float *hit)
{
    const struct value *v = &value_table[value];
    const size_t n = pixels_of(out);
    const float nothing = v->from == FROM_DEPTH ? NOTHING : 0;
    for (int channel = 0; channel < VALUE_CHANNELS && v->channel[channel]; channel++) {
        float *plane = plane_of(out, value, channel), sign = 1;
        int component = first + channel;
        if (v->kind == KIND_VECTOR && job->output.up == OUTPUT_UP_Y && component > 0) { /* (x, z, -y) */
            sign = component == 2 ? -1.0f : 1.0f;
            component = 3 - component;
        }
        for (size_t i = 0; i < n;
             i++) /* colour is averaged over all samples, the rest is of the pixel's centre */
            plane[i] = hit[4 * i + 3] >= 0 || v->from == FROM_COLOR ? sign * from[4 * i + (size_t)component]
                                                                    : nothing;
    }
}

/* How fast the wind is where sample 0 met the rock. */
static void record_air(struct gpu *gpu, struct aov *a, size_t n, const struct aov_air *air)
{
    const struct grid_lattice still = {{1, 1, 1}, 1, {0}}, *l = air ? &air->lattice : &still;
    struct pixel_air_params k = {
        .n = (uint)n,
        .ax = (uint)l->n[0],
        .ay = (uint)l->n[1],
        .az = (uint)l->n[2],
        .cell = (float)l->voxel,
        .origin_x = (float)l->origin[0],
        .origin_y = (float)l->origin[1],
        .origin_z = (float)l->origin[2],
    };

    GPU_RUN(gpu, field_air, k.n, k, a->hit, a->facing, air ? air->velocity : a->still, a->pixel);
}

status channels_add(struct gpu *gpu, struct aov *a, const struct job *job, const struct particles *p,
                    const struct aov_air *air, const struct hits *hits, enum value_id value,
                    struct aov_image *out)
{
    const size_t n = (size_t)out->width * (size_t)out->height;
    const struct count_params count = {.n = (uint)n};
    switch (value_table[value].from) {
    case FROM_COLOR:
        fill(job, out, value, hits->color, 0, hits->hit);
        return OK;
    case FROM_DEPTH:
        fill(job, out, value, hits->hit, 3, hits->hit);
        return OK;
    case FROM_PLACE:
        fill(job, out, value, hits->hit, 0, hits->hit);
        return OK;
    case FROM_FACING:
        fill(job, out, value, hits->facing, 0, hits->hit);
        return OK;
    case FROM_MEANS:
        fill(job, out, value, hits->means, field_mean(value), hits->hit);
        return OK;
    case FROM_MOTION:
        if (hits->motion)
            fill(job, out, value, hits->motion, 0, hits->hit);
        return OK;
    case FROM_AIR:
        if (air && air->unknown)
            return OK;
        record_air(gpu, a, n, air);
        break;
    default:
        if (!p->field[value_field[value]]) { /* the rock does not have this field */
            plane_of(out, value, 0);
            return OK;
        }
        GPU_RUN(gpu, field_pixel, n, count, a->hit, a->ids, p->field[value_field[value]], a->pixel);
    }
    return gpu_download(gpu, a->pixel, 0, plane_of(out, value, 0), n);
}

status channels_mattes(const struct job *job, const struct mattes *mattes, struct aov_image *out)
{
    float *plane = (float *)out->memory + out->n_channels * pixels_of(out);
    mattes_channels(mattes, (int)job->output.aov.samples, plane, out->channel + out->n_channels);
    out->n_channels += MATTE_CHANNELS;
    return mattes_notes(mattes, out);
}
