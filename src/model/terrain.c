#include "model/terrain.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/bilinear.h"
#include "image/image.h"
#include "scene/scene.h"
#include "shape/noise.h"
#include "stacks/intervals.h"

status terrain_materials(const struct job *job, struct material table[MATERIALS_MAX], int *n)
{
    static const struct material own[MATERIALS_OWN] = {[MATERIAL_AIR] = {"air", 90, 0, {0}},
                                                       [MATERIAL_BEDROCK] = {"bedrock", 90, 1, {0}},
                                                       [MATERIAL_SAND] = {"sand", 32, 1, {0}},
                                                       [MATERIAL_ROCK] = {"rock", 42, 1, {0}},
                                                       [MATERIAL_WATER] = {"water", 0, 0, {0}}};
    memcpy(table, own, sizeof own);
    *n = MATERIALS_OWN;
    for (size_t i = 0; i < job->arches.n_materials; i++) {
        const struct job_material *from = &job->arches.materials[i];
        int m = MATERIAL_BEDROCK;
        while (m < *n && strcmp(table[m].name, from->name) != 0)
            m++;
        if (m == MATERIALS_MAX)
            return fail(E_USAGE, "arches.materials: more than %d materials", MATERIALS_MAX - 1);
        if (m == *n) {
            table[(*n)++] = (struct material){.repose_deg = 35};
            snprintf(table[m].name, sizeof table[m].name, "%s", from->name);
        }
        /* Bedrock does not slide, and water is levelled in another way. */
        if (from->repose_deg >= 0 && m != MATERIAL_WATER && m != MATERIAL_BEDROCK)
            table[m].repose_deg = from->repose_deg;
        table[m].erodibility = from->erodibility;
    }
    return OK;
}

double terrain_cell(const struct job *job)
{
    return job->arches.cell_m > 0 ? job->arches.cell_m : job->domain.spacing_m;
}

double terrain_sigma(const struct job *job, double cell, double voxel)
{
    return fmin(fmax(job->arches.sigma * cell, 0.75 * voxel), SURFACE_WIDEST * cell);
}

/* Noise for tools. Setting it up for every call is cheap compared to evaluating it. */
static double tool_noise(const void *user, double scale, double flatten, const double x[3])
{
    const struct job *job = user;
    struct job_noise what = {.scale_m = scale, .octaves = 3, .flatten = flatten};
    struct noise noise = noise_init(&what, (uint32_t)job->seed);
    return noise_at(&noise, x);
}

struct tools terrain_tools(const struct job *job, const struct stacks *s, const struct material *table,
                           int n_materials)
{
    return (struct tools){.table = table,
                          .n_materials = n_materials,
                          .sigma = job->arches.sigma * s->cell,
                          .noise = tool_noise,
                          .user = job};
}

uint32_t terrain_ground(const struct job *job, int n_materials)
{
    uint32_t set = 0;
    for (int m = MATERIAL_BEDROCK; m < n_materials; m++)
        if (m != MATERIAL_WATER && !(m == MATERIAL_ROCK && job_piles(job)))
            set |= 1u << m;
    return set;
}

status terrain_create(const struct job *job, struct stacks *out)
{
    int n[2];
    double cell = terrain_cell(job);
    for (int a = 0; a < 2; a++)
        n[a] = (int)fmin(fmax(round(job->domain.size_m[a] / cell), 1), STACKS_MAX);
    return stacks_create(n, cell, job->domain.size_m[2], out);
}

/* ---- the start */

struct start {
    const struct stacks *s;
    const struct solid *solid;
    double height;
    const float *image; /* of a cover, top row first */
    size_t width, rows;
    double thickness;
    uint32_t material;
};

struct line {
    const struct solid *solid;
    double at[2];
};

static double depth_in_solid(void *user, double z, double *skip)
{
    const struct line *l = user;
    const double x[3] = {l->at[0], l->at[1], z};
    double d = solid_at(l->solid, x).distance;
    *skip = fabs(d);
    return -d;
}

static status fill_column(void *user, int i, int j, struct column *c)
{
    status st = OK;
    const struct start *start = user;
    struct intervals in = {0};
    double cell = start->s->cell;
    struct line line = {start->solid, {(i + 0.5) * cell, (j + 0.5) * cell}};
    TRY(intervals_find(0, start->height, cell / 4, NULL, false, depth_in_solid, &line, &in));
    for (size_t k = 0; k < in.n; k++)
        TRY(column_set(c, stacks_quanta(start->s, in.at[k].lo), stacks_quanta(start->s, in.at[k].hi),
                       MATERIAL_BEDROCK));
done:
    free(in.at);
    return st;
}

static status cover_column(void *user, int i, int j, struct column *c)
{
    const struct start *start = user;
    double px = (i + 0.5) / start->s->n[0] * (double)start->width;
    double py = (1 - (j + 0.5) / start->s->n[1]) * (double)start->rows;
    double thick = start->thickness * image_bilinear(start->image, start->width, start->rows, px, py);
    uint32_t top = c->n ? layer_top(c->layer[c->n - 1]) : 0, amount = stacks_quanta(start->s, thick);
    return column_set(c, top, amount < STACK_TOP - top ? top + amount : (uint32_t)STACK_TOP, start->material);
}

static status cover(const struct job_cover *job, const struct material *table, int n_materials,
                    struct stacks *s)
{
    status st = OK;
    struct image image = {0};
    const struct image_request request = IMAGE_REQUEST(job);
    struct start start = {.s = s, .thickness = job->thickness_m};
    while (start.material < (uint32_t)n_materials && strcmp(table[start.material].name, job->material) != 0)
        start.material++;
    if (start.material == MATERIAL_AIR || start.material == (uint32_t)n_materials)
        return fail(E_USAGE, "arches.covers: there is no material '%.64s'", job->material);
    TRY(image_read(&request, &image));
    start.image = image.value;
    start.width = image.width;
    start.rows = image.height;
    TRY(stacks_edit(s, (const int[]){0, 0}, s->n, cover_column, &start));
done:
    image_free(&image);
    return st;
}

status terrain_begin(const struct job *job, const struct material *table, int n_materials, bool log,
                     struct stacks *s)
{
    status st = OK;
    struct solid *solid = NULL;
    struct start start = {.s = s, .height = job->domain.size_m[2]};
    TRY(solid_create(job->scene, s->cell / 2, 4 * s->cell, &solid));
    start.solid = solid;
    if (log)
        TRY(scene_log_inputs(job, solid));
    TRY(stacks_edit(s, (const int[]){0, 0}, s->n, fill_column, &start));
    for (size_t i = 0; i < job->arches.n_covers; i++)
        TRY(cover(&job->arches.covers[i], table, n_materials, s));
    if (stacks_layers(s) == 0)
        st = fail(E_USAGE, "scene: no part of it is in the domain; move the shapes or enlarge domain.size_m");
done:
    solid_destroy(&solid);
    return st;
}

void terrain_ledger(const struct stacks *s, const struct material *table, int n_materials, uint64_t *solid,
                    uint64_t *loose)
{
    uint64_t amount[MATERIALS_MAX];
    stacks_amounts(s, amount);
    *solid = *loose = 0;
    for (int m = MATERIAL_BEDROCK; m < n_materials; m++)
        if (m != MATERIAL_WATER)
            *(table[m].repose_deg >= 90 ? solid : loose) += amount[m];
}
