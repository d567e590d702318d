#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "field/field.h"
#include "geology/attitude.h"
#include "model/terrain.h"
#include "stacks/surface.h"

struct surface terrain_surface(const struct terrain_view *v)
{
    return (struct surface){v->stacks, terrain_ground(v->job, v->n_materials),
                            terrain_sigma(v->job, v->stacks->cell, v->voxel)};
}

/* ---- samples */

/* A sample: its index in the view's arrays and its position in the lattice. */
struct sample {
    size_t at;
    int x[3];
};

static struct sample sample_of(const struct terrain_view *v, size_t brick, int s)
{
    const uint32_t number = v->bricks.number[brick], nx = (uint32_t)v->bricks.n[0],
                   ny = (uint32_t)v->bricks.n[1];
    return (struct sample){brick * BRICK_SAMPLES + (size_t)s,
                           {(int)(number % nx) * BRICK_SIDE + s % BRICK_SIDE,
                            (int)(number / nx % ny) * BRICK_SIDE + s / BRICK_SIDE % BRICK_SIDE,
                            (int)(number / nx / ny) * BRICK_SIDE + s / BRICK_SIDE / BRICK_SIDE}};
}

/* Sets samples outside of the domain to air, except behind walls, where the ground continues, and samples beyond the lattice to 0. */
static void cut_sides(const struct terrain_view *v, size_t brick)
{
    const unsigned walls = job_walls(v->job);
    for (int s = 0; s < BRICK_SAMPLES; s++) {
        const struct sample p = sample_of(v, brick, s);
        for (int a = 0; a < 3; a++)
            if ((p.x[a] < FIELD_MARGIN && !(walls >> (2 * a) & 1)) ||
                (p.x[a] >= v->n[a] - FIELD_MARGIN && !(walls >> (2 * a + 1) & 1)))
                v->share[p.at] = 0;
    }
}

static status sample_brick(const struct terrain_view *v, const struct surface *s, size_t brick,
                           struct surface_scratch *scratch)
{
    const struct sample first = sample_of(v, brick, 0);
    struct surface_box box = {.h = v->voxel, .n = {BRICK_SIDE, BRICK_SIDE, BRICK_SIDE}};
    memcpy(box.origin, v->origin, sizeof box.origin);
    memcpy(box.first, first.x, sizeof box.first);
    const status st = surface_sample(s, &box, scratch, v->share + first.at);
    if (st == OK)
        cut_sides(v, brick);
    return st;
}

/* The shares of the materials that show around p; deep inside or in the air, those at p. Returns the material with the largest share. */
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

static void place_of(const struct terrain_view *v, const int x[3], double p[3])
{
    for (int a = 0; a < 3; a++)
        p[a] = v->origin[a] + x[a] * v->voxel;
}

/* Per sample of `found`: the material with the largest share, whether it is ground, and whether there is a particle. */
enum { IS_PARTICLE = 0x80, IS_GROUND = 0x40, MATERIAL_OF = 0x3f };

/* What is known of a sample from its share alone. */
static uint8_t find_ground(const struct terrain_view *v, const struct sample *at)
{
    const float share = v->share[at->at];
    bool side = false;
    if (share <= 0)
        return 0;
    for (int a = 0; a < 3; a++)
        side |= at->x[a] == FIELD_MARGIN || at->x[a] == v->n[a] - FIELD_MARGIN - 1 ||
                field_cut_near(&v->cut, a, v->origin[a], v->voxel, at->x[a], at->x[a]);
    return (uint8_t)(IS_GROUND | (share < 1 || side ? IS_PARTICLE : 0));
}

/* ---- particles */

static void fill_particle(struct terrain_view *v, const struct surface *s, const struct sample *at,
                          uint32_t material, size_t i)
{
    const struct job *job = v->job;
    struct rock *rock = &v->rock;
    double p[3], normal[3];
    size_t id = 0;
    for (int a = 2; a >= 0; a--)
        id = id * (size_t)(v->n[a] - 2 * FIELD_MARGIN) + (size_t)(at->x[a] - FIELD_MARGIN);
    place_of(v, at->x, p);
    surface_normal(s, p, normal);
    for (size_t a = 0; a < 3; a++) {
        rock->P[4 * i + a] = (float)p[a];
        rock->N[4 * i + a] = (float)normal[a];
    }
    bool solid = material == MATERIAL_BEDROCK;
    size_t layer = attitude_layer(job, p);
    rock->id[i] = (uint32_t)id;
    rock->viability[i] = fminf(fmaxf(v->share[at->at], 1.0f / 64), 1);
    rock->layer[i] = (uint32_t)(solid ? layer : job->n_strata + material - MATERIAL_SAND);
    rock->phase[i] = solid ? 0 : 1;
    rock->rate_factor[i] = 1;
    rock->interlock_factor[i] = 1;
    rock->erodibility[i] = (float)job_weak(job, layer, job->frames.first);
}

/* Allocates the fields of n particles; fields that are 0 everywhere are not allocated. */
static status alloc_particles(struct rock *rock, size_t n)
{
    static const enum rock_field filled[] = {
        ROCK_P,          ROCK_N,     ROCK_id,          ROCK_viability,
        ROCK_layer,      ROCK_phase, ROCK_rate_factor, ROCK_interlock_factor,
        ROCK_erodibility};
    status st = OK;
    *rock = (struct rock){.n = n};
    for (size_t f = 0; f < sizeof filled / sizeof *filled; f++)
        TRY(memory_alloc(n, rock_field_size(filled[f]), "particles", &rock->field[filled[f]]));
done:
    return st;
}

/* ---- the whole view */

static status sample_all(const struct terrain_view *v, const struct surface *s)
{
    status st = OK;
    char why[2048] = "";
#pragma omp parallel
    {
        struct surface_scratch scratch = {0};
#pragma omp for schedule(dynamic, 64)
        for (size_t b = 0; b < v->bricks.count; b++) {
            const status own = sample_brick(v, s, b, &scratch);
            if (own != OK)
#pragma omp critical
            {
                st = own;
                snprintf(why, sizeof why, "%s", status_message());
            }
        }
        free(scratch.line);
    }
    return st == OK ? OK : fail(st, "%s", why);
}

/* Finds the ground and counts the particles of each brick. */
static void find_all(const struct terrain_view *v)
{
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t b = 0; b < v->bricks.count; b++)
        for (int i = 0; i < BRICK_SAMPLES; i++) {
            const struct sample at = sample_of(v, b, i);
            v->found[at.at] = find_ground(v, &at);
            v->first[b + 1] += (v->found[at.at] & IS_PARTICLE) != 0;
        }
    for (size_t b = 0; b < v->bricks.count; b++)
        v->first[b + 1] += v->first[b];
}

/* Finds the material of a sample in the ground and, if there is a particle, makes it as number i. */
static void fill_sample(struct terrain_view *v, const struct surface *s, const struct sample *at, size_t i)
{
    float ratio[TERRAIN_RATIOS];
    double p[3];
    place_of(v, at->x, p);
    const uint32_t material = materials_at(s, p, v->share[at->at] < 1, ratio);
    if (v->found[at->at] & IS_PARTICLE) {
        memcpy(v->ratio[i], ratio, sizeof ratio);
        fill_particle(v, s, at, material, i);
    }
    v->found[at->at] = (uint8_t)(v->found[at->at] | material);
}

static void fill_all(struct terrain_view *v, const struct surface *s)
{
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t b = 0; b < v->bricks.count; b++) {
        size_t particle = v->first[b];
        for (int i = 0; i < BRICK_SAMPLES; i++) {
            const struct sample at = sample_of(v, b, i);
            const bool is_particle = v->found[at.at] & IS_PARTICLE;
            if (v->found[at.at])
                fill_sample(v, s, &at, particle);
            particle += is_particle;
        }
    }
}

status terrain_sample(struct terrain_view *v)
{
    status st = OK;
    const struct surface s = terrain_surface(v);
    TRY(terrain_bricks(v, &s));
    const size_t n_bricks = v->bricks.count, n = n_bricks * BRICK_SAMPLES;
    TRY(memory_alloc(n, sizeof *v->share, "the surface", &v->share));
    TRY(memory_alloc(n, sizeof *v->found, "the surface", &v->found));
    TRY(memory_alloc(n_bricks + 1, sizeof *v->first, "the surface", &v->first));
    TRY(sample_all(v, &s));
    find_all(v);
    TRY(memory_alloc(v->first[n_bricks], sizeof *v->ratio, "material ratios", &v->ratio));
    TRY(alloc_particles(&v->rock, v->first[n_bricks]));
    fill_all(v, &s);
done:
    if (st != OK)
        terrain_view_free(v);
    return st;
}

void terrain_ratio(const struct terrain_view *v, int material, float *out)
{
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t b = 0; b < v->bricks.count; b++) {
        size_t from = v->first[b];
        for (size_t i = b * BRICK_SAMPLES; i < (b + 1) * BRICK_SAMPLES; i++)
            out[i] = v->found[i] & IS_PARTICLE
                         ? v->ratio[from++][material - MATERIAL_BEDROCK]
                         : (v->found[i] & IS_GROUND) && (v->found[i] & MATERIAL_OF) == material;
    }
}

void terrain_view_free(struct terrain_view *v)
{
    free(v->bricks.number);
    free(v->bricks.slot);
    v->bricks = (struct grid_bricks){0};
    free(v->share);
    v->share = NULL;
    free(v->found);
    v->found = NULL;
    free(v->first);
    v->first = NULL;
    free(v->ratio);
    v->ratio = NULL;
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
