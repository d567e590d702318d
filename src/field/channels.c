#include "field/channels.h"

#include <string.h>

#include "base/memory.h"

/* From which of the sources, and which component, each channel comes; vectors are turned to the files' up
 * axis. */
enum { FROM_IDS = AOV_SOURCES };
static const struct {
    enum aov_layer layer;
    const char *name;
    int from, component, vector, half;
} table[] = {
    {AOV_rgba, "R", FROM_COLOR, 0, 0, 1},
    {AOV_rgba, "G", FROM_COLOR, 1, 0, 1},
    {AOV_rgba, "B", FROM_COLOR, 2, 0, 1},
    {AOV_rgba, "A", FROM_COLOR, 3, 0, 1},
    {AOV_depth, "Z", FROM_HIT, 3, 0, 0},
    {AOV_N, "N.X", FROM_FACING, 0, 1, 0},
    {AOV_N, "N.Y", FROM_FACING, 1, 1, 0},
    {AOV_N, "N.Z", FROM_FACING, 2, 1, 0},
    {AOV_P, "P.X", FROM_HIT, 0, 1, 0},
    {AOV_P, "P.Y", FROM_HIT, 1, 1, 0},
    {AOV_P, "P.Z", FROM_HIT, 2, 1, 0},
    {AOV_stress, "stress.trace", FROM_FIELDS, 0, 0, 0},
    {AOV_stress, "stress.von_mises", FROM_FIELDS, 1, 0, 0},
    {AOV_viability, "viability.Y", FROM_FIELDS, 2, 0, 0},
    {AOV_erodibility, "erodibility.Y", FROM_FIELDS, 3, 0, 0},
    {AOV_discharge, "discharge.Y", FROM_WEATHER, 0, 0, 0},
    {AOV_wind, "wind.speed", FROM_WEATHER, 1, 0, 0},
    {AOV_vegetation, "vegetation.Y", FROM_WEATHER, 2, 0, 0},
    {AOV_layer, "layer.id", FROM_IDS, 0, 0, 0},
    {AOV_phase, "phase.id", FROM_IDS, 1, 0, 0},
    {AOV_motion, "motion.X", FROM_MOTION, 0, 0, 0},
    {AOV_motion, "motion.Y", FROM_MOTION, 1, 0, 0},
};
enum { TABLE = sizeof table / sizeof *table };

/* Depth of pixels without rock: farther than anything. */
static const float NOTHING = 1e10f;

static void fill_ids(uint32_t *plane, size_t n, const uint32_t *ids, size_t component)
{
    for (size_t i = 0; i < n; i++)
        plane[i] = ids[3 * i + component];
}

static void fill_values(float *plane, size_t n, float *const source[AOV_SOURCES], size_t row, int up)
{
    const float *from = source[table[row].from], *hit = source[FROM_HIT];
    size_t component = (size_t)table[row].component;
    float sign = 1, nothing = table[row].layer == AOV_depth ? NOTHING : 0;
    if (table[row].vector && up == OUTPUT_UP_Y && component > 0) { /* (x, z, -y) */
        sign = component == 2 ? -1.0f : 1.0f;
        component = 3 - component;
    }
    for (size_t i = 0; i < n; i++) /* the colour is of all samples, the rest of the middle's */
        plane[i] =
            hit[4 * i + 3] >= 0 || table[row].from == FROM_COLOR ? sign * from[4 * i + component] : nothing;
}

size_t aov_channel_count(const struct job *job)
{
    size_t n = job->output.aov.cryptomatte ? MATTE_CHANNELS : 0;
    for (size_t row = 0; row < TABLE; row++)
        n += job_wants_layer(job, table[row].layer);
    return n;
}

status aov_channels(const struct job *job, float *const source[AOV_SOURCES], const uint32_t *ids,
                    const struct mattes *mattes, struct aov_image *out)
{
    status st = OK;
    size_t n = (size_t)out->width * (size_t)out->height, n_mattes = mattes ? MATTE_CHANNELS : 0;
    TRY(memory_alloc(TABLE + n_mattes, sizeof *out->channel, "channels", &out->channel));
    TRY(memory_alloc(n * (TABLE + n_mattes), sizeof(float), "a picture", &out->memory));
    float *plane = out->memory;
    for (size_t row = 0; row < TABLE; row++) {
        if (!job_wants_layer(job, table[row].layer) ||
            (table[row].from < FROM_IDS && !source[table[row].from]))
            continue;
        struct aov_channel *c = &out->channel[out->n_channels++];
        *c = (struct aov_channel){
            .part = aov_layer_names[table[row].layer], .name = table[row].name, .half = table[row].half};
        if (table[row].from == FROM_IDS) {
            fill_ids((uint32_t *)plane, n, ids, (size_t)table[row].component);
            c->id = (uint32_t *)plane;
        } else {
            fill_values(plane, n, source, row, job->output.up);
            c->value = plane;
        }
        plane += n;
    }
    if (mattes) {
        mattes_channels(mattes, (int)job->output.aov.samples, plane, out->channel + out->n_channels);
        out->n_channels += MATTE_CHANNELS;
        TRY(mattes_notes(mattes, out));
    }
done:
    return st;
}
