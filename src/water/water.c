#include "water/water.h"

#include <math.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "water/internal.h"

/* Maximum numbers of cells, columns, words of a column and words of rows, for any shift. */
struct most {
    size_t cells, columns, words, row_words;
};

static struct most most_of(const int voxels[3], int size)
{
    size_t n[3];
    for (int a = 0; a < 3; a++)
        n[a] = (size_t)(voxels[a] / size + (size > 1));
    return (struct most){n[0] * n[1] * n[2], n[0] * n[1], (n[2] + 31) / 32, (n[0] + 31) / 32 * n[1] * n[2]};
}

/* A usual number of spans: a surface that overhangs everywhere, or a fine one in coarse cells. */
static size_t usual_nodes(const struct most *m, int size)
{
    size_t many = (size > 1 ? 8 : 2) * m->columns;
    return many < m->cells ? many : m->cells;
}

/* Words per span: arrays and passes; and for streams. */
enum { NODE_WORDS = WATER_NODE_ARRAYS + 4, STREAM_WORDS = 2 + 2 + 4 + 4 };

uint64_t water_bytes(const int voxels[3], int size)
{
    struct most m = most_of(voxels, size);
    return (size > 1 ? 12 * (uint64_t)m.cells + 4 * (uint64_t)m.row_words : 0) +
           12 * (uint64_t)(m.columns * m.words + 1) +
           4 * (uint64_t)(size > 1 ? NODE_WORDS : NODE_WORDS + STREAM_WORDS) * (usual_nodes(&m, size) + 1);
}

status water_reserve_cells(struct gpu *gpu, struct water *w)
{
    status st = OK;
    const struct most m = most_of(w->voxels, w->size);
    if (w->tag)
        return OK;
    TRY(gpu_buffer_create(gpu, "water cells' kinds", m.cells, 4, &w->tag));
    TRY(gpu_buffer_create(gpu, "water cells' altitudes", m.cells, 4, &w->z));
    TRY(gpu_buffer_create(gpu, "water cells' receivers", m.cells, 4, &w->receiver));
done:
    return st;
}

status water_reserve(struct gpu *gpu, struct water *w, size_t n)
{
    status st = OK;
    if (n <= w->nodes_max)
        return OK;
    struct most m = most_of(w->voxels, w->size);
    size_t room = n + n / 4;
    w->nodes_max = 0;
    for (int i = 0; i < WATER_NODE_ARRAYS; i++)
        gpu_buffer_destroy(gpu, &w->node[i]);
    gpu_buffer_destroy(gpu, &w->pass);
    gpu_buffer_destroy(gpu, &w->shares);
    gpu_buffer_destroy(gpu, &w->heading);
    gpu_buffer_destroy(gpu, &w->stream);
    gpu_buffer_destroy(gpu, &w->pull);
    if (room < usual_nodes(&m, w->size))
        room = usual_nodes(&m, w->size);
    for (int i = 0; i < WATER_NODE_ARRAYS; i++)
        TRY(gpu_buffer_create(gpu, "water", room + 1, 4, &w->node[i]));
    TRY(gpu_buffer_create(gpu, "water passes", 4 * room, 4, &w->pass));
    if (w->size == 1) {
        TRY(gpu_buffer_create(gpu, "water's shares", 2 * room, 4, &w->shares));
        TRY(gpu_buffer_create(gpu, "water's heading", 2 * room, 4, &w->heading));
        TRY(gpu_buffer_create(gpu, "streams", room, 16, &w->stream));
        TRY(gpu_buffer_create(gpu, "water's pull", room, 16, &w->pull));
    }
    w->nodes_max = room;
done:
    return st;
}

/* In spacings: least radius at which the voxels of a bed are connected whatever its direction. */
static const double BED = 1.5;

static status source_voxel(const struct job *job, size_t i, const int voxels[3], double h, uint32_t out[4])
{
    const struct job_source *s = &job->sources[i];
    if (s->n_path_m == 0)
        return fail(E_USAGE, "sources[%zu].path_m: needs at least one point, where the water enters", i);
    if (s->bed_m > 0 && s->bed_m < BED * h)
        log_warn(
            "sources[%zu].bed_m: a bed of %g m radius may be cut into pieces at a spacing of %g m: make it %g m, or the spacing finer",
            i, s->bed_m, h, BED * h);
    const double *x = s->path_m[0];
    for (int a = 0; a < 3; a++) {
        double v = floor(x[a] / h);
        if (!(x[a] >= 0 && x[a] <= voxels[a] * h))
            return fail(
                E_USAGE,
                "sources[%zu].path_m: the water enters at %g, %g, %g m, outside the domain of %g x %g x %g m",
                i, x[0], x[1], x[2], voxels[0] * h, voxels[1] * h, voxels[2] * h);
        out[a] = (uint32_t)fmin(v, voxels[a] - 1);
    }
    return OK;
}

status water_create(struct gpu *gpu, const struct job *job, const int voxels[3], double h, int size,
                    struct water *w)
{
    status st = OK;
    uint32_t *source = NULL;
    struct most m = most_of(voxels, size);
    *w = (struct water){.size = size,
                        .n_sources = job->n_sources,
                        .voxels = {voxels[0], voxels[1], voxels[2]},
                        .walls = job_walls(job)};
    if (size > 1)
        TRY(gpu_buffer_create(gpu, "rows of cells", m.row_words, 4, &w->rows));
    TRY(gpu_buffer_create(gpu, "occupied cells", m.columns * m.words + 1, 4, &w->occupied));
    TRY(gpu_buffer_create(gpu, "floors", m.columns * m.words + 1, 4, &w->floors));
    TRY(gpu_buffer_create(gpu, "first spans", m.columns * m.words + 1, 4, &w->first));
    TRY(gpu_buffer_create(gpu, "sources", 4 * w->n_sources + 1, 4, &w->source));
    TRY(gpu_buffer_create(gpu, "sources' spans", 2 * w->n_sources + 1, 4, &w->entry));
    TRY(memory_alloc(4 * w->n_sources + 1, 4, "sources", &source));
    for (size_t i = 0; i < w->n_sources; i++)
        TRY(source_voxel(job, i, voxels, h, source + 4 * i));
    TRY(gpu_upload(gpu, w->source, 0, source, 4 * w->n_sources + 1));
    TRY(water_reserve(gpu, w, 1));
done:
    free(source);
    if (st != OK)
        water_destroy(gpu, w);
    return st;
}

void water_destroy(struct gpu *gpu, struct water *w)
{
    struct gpu_buffer **all[] = {&w->tag,    &w->z,       &w->receiver, &w->rows,   &w->occupied,
                                 &w->floors, &w->first,   &w->pass,     &w->source, &w->entry,
                                 &w->shares, &w->heading, &w->stream,   &w->pull};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    for (int i = 0; i < WATER_NODE_ARRAYS; i++)
        gpu_buffer_destroy(gpu, &w->node[i]);
    *w = (struct water){0};
}

status fragments_create(struct gpu *gpu, const struct job *job, const int voxels[3], double h,
                        struct fragments *c)
{
    return water_create(gpu, job, voxels, h, 2, &c->routing);
}

void fragments_destroy(struct gpu *gpu, struct fragments *c)
{
    water_destroy(gpu, &c->routing);
}

bool water_flows(const struct job *job, int frame)
{
    if (curve_at(&job->rain.m_per_yr, frame) > 0)
        return true;
    for (size_t i = 0; i < job->n_sources; i++)
        if (curve_at(&job->sources[i].m3_per_yr, frame) > 0)
            return true;
    return false;
}

bool water_ever_flows(const struct job *job)
{
    if (curve_max(&job->rain.m_per_yr) > 0)
        return true;
    for (size_t i = 0; i < job->n_sources; i++)
        if (curve_max(&job->sources[i].m3_per_yr) > 0)
            return true;
    return false;
}
