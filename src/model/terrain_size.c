/* How much surface the terrain of a job has, found by running the job on coarse stacks. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "model/terrain.h"

/* At most so many coarse stacks, since few are quick and many see small tools; and so many frames in which something changes, of jobs whose
 * tools work for thousands of frames. */
enum { COARSE_STACKS = 2500, MOST_FRAMES = 256 };

/* The ground's intervals of a stack, in quanta; returns their number. */
static size_t ground_of(const struct stacks *s, uint32_t set, int i, int j, uint32_t (*out)[2])
{
    size_t n, count = 0;
    const uint32_t *layer = stacks_column(s, i, j, &n);
    for (size_t k = 0; k < n; k++) {
        const uint32_t bottom = k ? layer_top(layer[k - 1]) : 0, top = layer_top(layer[k]);
        if (!(set >> layer_material(layer[k]) & 1))
            continue;
        if (count && out[count - 1][1] == bottom)
            out[count - 1][1] = top;
        else
            out[count++][0] = bottom, out[count - 1][1] = top;
    }
    return count;
}

static double length_of(uint32_t (*in)[2], size_t n)
{
    double sum = 0;
    for (size_t k = 0; k < n; k++)
        sum += in[k][1] - in[k][0];
    return sum;
}

/* The length that both have in common. */
static double common_of(uint32_t (*a)[2], size_t n_a, uint32_t (*b)[2], size_t n_b)
{
    double sum = 0;
    for (size_t i = 0, k = 0; i < n_a && k < n_b;) {
        const double low = fmax(a[i][0], b[k][0]), high = fmin(a[i][1], b[k][1]);
        sum += fmax(high - low, 0);
        if (a[i][1] < b[k][1])
            i++;
        else
            k++;
    }
    return sum;
}

/* The scratch of one row of stacks. */
struct row {
    uint32_t (*own)[2], (*next)[2];
};

/* Adds the faces of stack (i, j): horizontal ones, and those towards the next stack on both axes and beyond the grid. */
static void add_stack(const struct stacks *s, uint32_t set, int i, int j, const struct row *row,
                      struct terrain_size *out)
{
    const size_t n = ground_of(s, set, i, j, row->own);
    const double length = length_of(row->own, n), face = s->quantum * s->cell;
    for (size_t k = 0; k < n; k++) {
        out->surface_m2 += (1 + (row->own[k][0] > 0)) * s->cell * s->cell;
        out->side_m2 += (row->own[k][0] == 0) * s->cell * s->cell;
    }
    out->side_m2 += ((i == 0) + (j == 0)) * length * face;
    for (int a = 0; a < 2; a++) {
        const int x = i + (a == 0), y = j + (a == 1);
        if (x == s->n[0] || y == s->n[1]) {
            out->side_m2 += length * face;
            continue;
        }
        const size_t m = ground_of(s, set, x, y, row->next);
        out->surface_m2 +=
            (length + length_of(row->next, m) - 2 * common_of(row->own, n, row->next, m)) * face;
    }
}

static status measure(const struct stacks *s, uint32_t set, struct terrain_size *out)
{
    status st = OK;
    struct row row = {0};
    size_t most = 1;
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++) {
            size_t n;
            stacks_column(s, i, j, &n);
            most = n > most ? n : most;
        }
    *out = (struct terrain_size){.layers = (double)stacks_layers(s) / ((double)s->n[0] * s->n[1])};
    TRY(memory_alloc(most, sizeof *row.own, "the size of terrain", &row.own));
    TRY(memory_alloc(most, sizeof *row.next, "the size of terrain", &row.next));
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++)
            add_stack(s, set, i, j, &row, out);
done:
    free(row.own);
    free(row.next);
    return st;
}

static void keep_larger(struct terrain_size *most, const struct terrain_size *now)
{
    most->surface_m2 = fmax(most->surface_m2, now->surface_m2);
    most->side_m2 = fmax(most->side_m2, now->side_m2);
    most->layers = fmax(most->layers, now->layers);
}

status terrain_size(const struct job *job, struct terrain_size *out)
{
    status st = OK;
    struct material table[MATERIALS_MAX];
    struct stacks stacks = {0};
    struct job coarse = *job;
    int n_materials;
    const double area = job->domain.size_m[0] * job->domain.size_m[1];
    *out = (struct terrain_size){0};
    coarse.arches.cell_m = fmax(terrain_cell(job), sqrt(area / COARSE_STACKS));
    TRY(terrain_materials(&coarse, table, &n_materials));
    TRY(terrain_create(&coarse, &stacks));
    TRY(terrain_begin(&coarse, table, n_materials, false, &stacks));
    const struct terrain_work work = {
        .job = &coarse, .stacks = &stacks, .table = table, .n_materials = n_materials};
    const uint32_t set = terrain_ground(job, n_materials);
    int shaped = 0;
    for (int frame = job->frames.first; frame <= job->frames.last && shaped < MOST_FRAMES; frame++) {
        struct terrain_area changed;
        struct terrain_size now;
        TRY(terrain_shape(&work, frame, frame == job->frames.first, &changed));
        TRY(terrain_slide(&work, frame, &changed));
        if (changed.lo[0] > changed.hi[0])
            continue;
        shaped++;
        TRY(measure(&stacks, set, &now));
        keep_larger(out, &now);
    }
done:
    stacks_destroy(&stacks);
    return st;
}
