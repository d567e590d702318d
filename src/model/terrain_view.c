#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "field/field.h"
#include "model/terrain.h"
#include "stacks/surface.h"

static size_t sample_count(const struct terrain_view *v)
{
    return (size_t)v->n[0] * (size_t)v->n[1] * (size_t)v->n[2];
}

/* What the surface is of: all but air and water; and rock, where rocks stand for it. */
static struct surface ground(const struct terrain_view *v)
{
    uint32_t set = 0;
    bool piles = job_piles(v->job);
    for (int m = MATERIAL_BEDROCK; m < v->n_materials; m++)
        if (m != MATERIAL_WATER && !(m == MATERIAL_ROCK && piles))
            set |= 1u << m;
    /* No narrower than the lattice can show. */
    double sigma = fmax(v->job->arches.sigma * v->stacks->cell, 0.75 * v->voxel);
    return (struct surface){v->stacks, set, fmin(sigma, SURFACE_WIDEST * v->stacks->cell)};
}

/* Outside the domain is air. */
static void cut_sides(const struct terrain_view *v)
{
    for (int k = 0, at = 0; k < v->n[2]; k++)
        for (int j = 0; j < v->n[1]; j++)
            for (int i = 0; i < v->n[0]; i++, at++) {
                const int x[3] = {i, j, k};
                for (int a = 0; a < 3; a++)
                    if (x[a] < FIELD_MARGIN || x[a] >= v->n[a] - FIELD_MARGIN)
                        v->share[at] = 0;
            }
}

/* Shares of what shows around p; deep inside, or in the air, of what p is in. Returns the largest. */
static uint32_t materials_at(const struct surface *s, const double p[3], bool band,
                             float ratio[TERRAIN_RATIOS])
{
    double area[MATERIALS_MAX] = {0}, sum = 0;
    uint32_t most = MATERIAL_BEDROCK;
    if (band)
        surface_visible(s, p, area);
    for (int m = 0; m < MATERIALS_MAX; m++)
        sum += area[m];
    if (!(sum > 0)) {
        size_t n;
        const struct stacks *g = s->stacks;
        int i = (int)fmin(fmax(p[0] / g->cell, 0), g->n[0] - 1);
        int j = (int)fmin(fmax(p[1] / g->cell, 0), g->n[1] - 1);
        const uint32_t *layer = stacks_column(g, i, j, &n);
        uint32_t m = column_at(layer, n, stacks_quanta(g, p[2]));
        area[m == MATERIAL_AIR && n ? layer_material(layer[n - 1]) : m] = sum = 1;
    }
    for (int m = MATERIAL_BEDROCK; m < MATERIALS_MAX; m++)
        most = area[m] > area[most] ? (uint32_t)m : most;
    for (int r = 0; r < TERRAIN_RATIOS; r++)
        ratio[r] = (float)(area[MATERIAL_BEDROCK + r] / sum);
    return most;
}

/* The particle of sample `at`; *is_one: it is at the surface. */
struct found {
    uint32_t material;
    uint8_t is_one;
};

uint64_t terrain_samples(const int voxels[3])
{
    uint64_t n = 1;
    for (int a = 0; a < 3; a++)
        n *= (uint64_t)voxels[a] + 2 * FIELD_MARGIN;
    return n;
}

uint64_t terrain_view_bytes(const int voxels[3])
{
    return terrain_samples(voxels) * ((1 + TERRAIN_RATIOS) * sizeof(float) + sizeof(struct found));
}

static void look_at(const struct terrain_view *v, const struct surface *s, const int x[3], struct found *out)
{
    size_t at = ((size_t)x[2] * (size_t)v->n[1] + (size_t)x[1]) * (size_t)v->n[0] + (size_t)x[0];
    float ratio[TERRAIN_RATIOS];
    double p[3];
    bool side = false;
    for (int a = 0; a < 3; a++) {
        p[a] = v->origin[a] + x[a] * v->voxel;
        side |= x[a] == FIELD_MARGIN || x[a] == v->n[a] - FIELD_MARGIN - 1;
    }
    *out = (struct found){0};
    if (v->share[at] <= 0)
        return;
    bool band = v->share[at] < 1;
    out->material = materials_at(s, p, band, ratio);
    for (int r = 0; r < TERRAIN_RATIOS; r++)
        v->ratio[r][at] = ratio[r];
    out->is_one = band || side;
}

static void fill_particle(struct terrain_view *v, const struct surface *s, const int x[3], uint32_t material,
                          size_t i)
{
    const struct job *job = v->job;
    struct rock *rock = &v->rock;
    double p[3], normal[3];
    size_t at = ((size_t)x[2] * (size_t)v->n[1] + (size_t)x[1]) * (size_t)v->n[0] + (size_t)x[0], id = 0;
    for (int a = 2; a >= 0; a--)
        id = id * (size_t)(v->n[a] - 2 * FIELD_MARGIN) + (size_t)(x[a] - FIELD_MARGIN);
    for (int a = 0; a < 3; a++) {
        p[a] = v->origin[a] + x[a] * v->voxel;
        rock->P[4 * i + (size_t)a] = (float)p[a];
    }
    surface_normal(s, p, normal);
    for (int a = 0; a < 3; a++)
        rock->N[4 * i + (size_t)a] = (float)normal[a];
    bool solid = material == MATERIAL_BEDROCK;
    size_t layer = job_layer_at(job, p[2]);
    rock->id[i] = (uint32_t)id;
    rock->viability[i] = fminf(fmaxf(v->share[at], 1.0f / 64), 1);
    rock->layer[i] = (uint32_t)(solid ? layer : job->n_strata + material - MATERIAL_SAND);
    rock->phase[i] = solid ? 0 : 1;
    rock->rate_factor[i] = 1;
    rock->interlock_factor[i] = 1;
    rock->erodibility[i] = (float)curve_at(&job->strata[layer].weak_m_per_kyr, job->frames.first);
}

status terrain_look(struct terrain_view *v)
{
    status st = OK;
    struct surface s = ground(v);
    struct found *found = NULL;
    size_t n = sample_count(v), count = 0, *first = NULL;
    TRY(memory_alloc(n, sizeof *v->share, "the surface", &v->share));
    for (int r = 0; r < TERRAIN_RATIOS; r++)
        TRY(memory_alloc(n, sizeof *v->ratio[r], "material ratios", &v->ratio[r]));
    TRY(memory_alloc(n, sizeof *found, "the surface", &found));
    TRY(memory_alloc((size_t)v->n[2] + 1, sizeof *first, "the surface", &first));
    TRY(surface_sample(&s, v->origin, v->voxel, v->n, v->share));
    cut_sides(v);
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < v->n[2]; k++) {
        size_t at = (size_t)k * (size_t)v->n[0] * (size_t)v->n[1];
        for (int j = 0; j < v->n[1]; j++)
            for (int i = 0; i < v->n[0]; i++, at++) {
                look_at(v, &s, (const int[]){i, j, k}, &found[at]);
                first[k + 1] += found[at].is_one;
            }
    }
    for (int k = 0; k < v->n[2]; k++)
        first[k + 1] += first[k];
    count = first[v->n[2]];
    TRY(rock_alloc(&v->rock, count, DERIVED));
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < v->n[2]; k++) {
        size_t at = (size_t)k * (size_t)v->n[0] * (size_t)v->n[1], p = first[k];
        for (int j = 0; j < v->n[1]; j++)
            for (int i = 0; i < v->n[0]; i++, at++)
                if (found[at].is_one)
                    fill_particle(v, &s, (const int[]){i, j, k}, found[at].material, p++);
    }
done:
    free(found);
    free(first);
    if (st != OK)
        terrain_view_free(v);
    return st;
}

void terrain_view_free(struct terrain_view *v)
{
    free(v->share);
    v->share = NULL;
    for (int r = 0; r < TERRAIN_RATIOS; r++) {
        free(v->ratio[r]);
        v->ratio[r] = NULL;
    }
    rock_free(&v->rock);
}

/* ---- the map */

static const char *const map_names[MATERIALS_MAX] = {
    "height.Z",        "bedrock.thickness", "sand.thickness", "rock.thickness",
    "water.thickness", "m5.thickness",      "m6.thickness",   "m7.thickness",
    "m8.thickness",    "m9.thickness",      "m10.thickness",  "m11.thickness",
    "m12.thickness",   "m13.thickness",     "m14.thickness",  "m15.thickness"};

status terrain_map(const struct stacks *s, int n_materials, struct aov_image *out)
{
    status st = OK;
    size_t n = (size_t)s->n[0] * (size_t)s->n[1];
    *out = (struct aov_image){
        .camera = "stacks", .width = s->n[0], .height = s->n[1], .n_channels = (size_t)n_materials};
    for (int d = 0; d < 4; d++)
        out->world_to_camera[5 * d] = out->world_to_ndc[5 * d] = 1;
    float *plane;
    TRY(memory_alloc(out->n_channels, sizeof *out->channel, "channels", &out->channel));
    TRY(memory_alloc(n * out->n_channels, sizeof *plane, "a map", &plane));
    out->memory = plane;
    for (size_t c = 0; c < out->n_channels; c++)
        out->channel[c] =
            (struct aov_channel){.part = "stacks", .name = map_names[c], .value = plane + c * n};
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++) {
            size_t layers, at = (size_t)(s->n[1] - 1 - j) * (size_t)s->n[0] + (size_t)i;
            uint64_t amount[MATERIALS_MAX] = {0};
            const uint32_t *layer = stacks_column(s, i, j, &layers);
            column_amounts(layer, layers, amount);
            plane[at] = layers ? (float)(layer_top(layer[layers - 1]) * s->quantum) : 0;
            for (size_t c = 1; c < out->n_channels; c++)
                plane[c * n + at] = (float)((double)amount[c] * s->quantum);
        }
done:
    if (st != OK) {
        free(out->channel);
        out->channel = NULL;
    }
    return st;
}
