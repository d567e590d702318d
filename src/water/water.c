#include "water/water.h"

#include <math.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "water/internal.h"

/* The most cells, columns and words of a column there can be, whatever the shift. */
struct most {
    size_t cells, columns, words, row_words;
};

static struct most most_of(const int voxels[3])
{
    size_t n[3];
    for (int a = 0; a < 3; a++)
        n[a] = (size_t)voxels[a] / 2 + 1;
    return (struct most){n[0] * n[1] * n[2], n[0] * n[1], (n[2] + 31) / 32, (n[0] + 31) / 32 * n[1] * n[2]};
}

/* Room for as many spans as are usual: a surface that lies 8 times over itself. */
static size_t usual_nodes(const struct most *m)
{
    size_t many = 8 * m->columns;
    return many < m->cells ? many : m->cells;
}

uint64_t water_bytes(const int voxels[3], bool cells)
{
    struct most m = most_of(voxels);
    return (cells ? 12 * (uint64_t)m.cells : 0) + 4 * (uint64_t)m.row_words +
           12 * (uint64_t)(m.columns * m.words + 1) +
           4 * (WATER_NODE_ARRAYS + 4) * (uint64_t)(usual_nodes(&m) + 1);
}

status water_reserve_cells(struct gpu *gpu, struct water *w)
{
    status st = OK;
    const struct most m = most_of(w->voxels);
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
    struct most m = most_of(w->voxels);
    size_t room = n + n / 4;
    w->nodes_max = 0;
    for (int i = 0; i < WATER_NODE_ARRAYS; i++)
        gpu_buffer_destroy(gpu, &w->node[i]);
    gpu_buffer_destroy(gpu, &w->pass);
    if (room < usual_nodes(&m))
        room = usual_nodes(&m);
    for (int i = 0; i < WATER_NODE_ARRAYS; i++)
        TRY(gpu_buffer_create(gpu, "water", room + 1, 4, &w->node[i]));
    TRY(gpu_buffer_create(gpu, "water passes", 4 * room, 4, &w->pass));
    w->nodes_max = room;
done:
    return st;
}

static status source_voxel(const struct job *job, size_t i, const int voxels[3], double h, uint32_t out[4])
{
    const struct job_source *s = &job->sources[i];
    if (s->n_path_m == 0)
        return fail(E_USAGE, "sources[%zu].path_m: needs at least one point, where the water enters", i);
    const double *x = s->path_m[0];
    for (int a = 0; a < 3; a++) {
        double v = floor(x[a] / h);
        if (!(x[a] >= 0 && x[a] <= voxels[a] * h))
            return fail(
                E_USAGE,
                "sources[%zu].path_m: the water enters at %g, %g, %g m, outside the domain of %g x %g x "
                "%g m",
                i, x[0], x[1], x[2], voxels[0] * h, voxels[1] * h, voxels[2] * h);
        out[a] = (uint32_t)fmin(v, voxels[a] - 1);
    }
    return OK;
}

status water_create(struct gpu *gpu, const struct job *job, const int voxels[3], double h, struct water *w)
{
    status st = OK;
    uint32_t *source = NULL;
    struct most m = most_of(voxels);
    *w = (struct water){
        .n_sources = job->n_sources, .voxels = {voxels[0], voxels[1], voxels[2]}, .walls = job_walls(job)};
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
    struct gpu_buffer **all[] = {&w->tag,    &w->z,     &w->receiver, &w->rows,   &w->occupied,
                                 &w->floors, &w->first, &w->pass,     &w->source, &w->entry};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    for (int i = 0; i < WATER_NODE_ARRAYS; i++)
        gpu_buffer_destroy(gpu, &w->node[i]);
    *w = (struct water){0};
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

/* ---- discharge */

static status let_it_rain(struct gpu *gpu, struct gpu_work *work, struct water *w)
{
    status st = OK;
    struct gpu_buffer **node = w->node, *counts = gpu_work_words(work);
    struct gpu_buffer *sum[2] = {node[WATER_RAIN], node[WATER_SCRATCH]};
    struct gpu_buffer *pointer[2] = {node[WATER_SCRATCH + 1], node[WATER_SCRATCH + 2]};
    struct water_params k = water_params(w, w->columns);
    uint32_t changed = 1;
    GPU_RUN(gpu, water_rain, k.n, k, w->occupied, w->floors, w->first, sum[0]);
    k.n = (uint)w->n_nodes + 1;
    GPU_RUN(gpu, water_downstream, k.n, k, node[WATER_FINAL], pointer[0]);
    for (int round = 0; changed; round++) {
        if (round == 32) /* 2^64 hops */
            return fail(E_NUMERIC, "water: %zu receivers have a cycle: the device computes wrongly",
                        w->n_nodes);
        gpu_fill(gpu, counts, 0);
        for (int i = 0; i < 2; i++) {
            gpu_copy(gpu, sum[!i], sum[i], w->n_nodes + 1);
            GPU_RUN(gpu, water_push, k.n, k, pointer[i], sum[i], sum[!i], pointer[!i], counts);
        }
        TRY(gpu_download(gpu, counts, COUNT_CHANGED, &changed, 1));
    }
done:
    return st;
}

/* Tells once of sources whose water enters elsewhere. */
static status tell_entries(struct gpu *gpu, struct water *w)
{
    status st = OK;
    uint32_t *entry = NULL;
    if (w->entered)
        return OK;
    w->entered = true;
    TRY(memory_alloc(2 * w->n_sources, 4, "sources", &entry));
    TRY(gpu_download(gpu, w->entry, 0, entry, 2 * w->n_sources));
    for (size_t i = 0; i < w->n_sources; i++)
        if (entry[2 * i + 1] > 1)
            log_warn("sources[%zu].path_m: begins inside rock; its water enters at the nearest place that is "
                     "not, %.3g cells of two spacings away: begin it in the open, or give it a bed_m",
                     i, sqrt(entry[2 * i + 1]));
done:
    free(entry);
    return st;
}

static status let_it_spring(struct gpu *gpu, struct water *w, const struct job *job, int frame)
{
    status st = OK;
    double sum = 0;
    struct gpu_buffer **node = w->node;
    struct water_params k = water_params(w, w->n_sources);
    for (size_t i = 0; i < w->n_sources; i++)
        sum += curve_at(&job->sources[i].m3_per_yr, frame);
    w->spring_unit = sum / 2147483648.0;
    if (!(sum > 0))
        goto done;
    for (size_t i = 0; i < w->n_sources; i++) {
        double share = curve_at(&job->sources[i].m3_per_yr, frame) / w->spring_unit;
        uint32_t amount = share > 0 ? (uint32_t)fmax(1, share) : 0;
        TRY(gpu_upload(gpu, w->source, 4 * i + 3, &amount, 1));
    }
    GPU_RUN(gpu, water_enter, k.n, k, w->occupied, w->floors, w->first, node[WATER_BASIN],
            node[WATER_COMPONENT], w->source, w->entry);
    GPU_RUN(gpu, water_spring, k.n, k, w->entry, w->source, node[WATER_FINAL], node[WATER_SPRING]);
    TRY(tell_entries(gpu, w));
done:
    return st;
}

status water_discharge(struct gpu *gpu, struct gpu_work *work, struct water *w, const struct job *job,
                       int frame, const struct particles *p)
{
    status st = OK;
    double rain = curve_at(&job->rain.m_per_yr, frame);
    w->rain_unit = rain * p->h * p->h;
    gpu_fill(gpu, w->node[WATER_RAIN], 0);
    gpu_fill(gpu, w->node[WATER_SPRING], 0);
    if (rain > 0)
        TRY(let_it_rain(gpu, work, w));
    TRY(let_it_spring(gpu, w, job, frame));
done:
    return st;
}

/* ---- the surface */

static struct water_surface_params surface_params(const struct water *w, const struct particles *p)
{
    return (struct water_surface_params){.n = (uint)p->n_surface,
                                         .sx = (uint)w->shift[0],
                                         .sy = (uint)w->shift[1],
                                         .sz = (uint)w->shift[2],
                                         .cx = (uint)w->cells[0],
                                         .cy = (uint)w->cells[1],
                                         .cz = (uint)w->cells[2],
                                         .words = (uint)w->words,
                                         .cell = (float)(2 * p->h),
                                         .rain_unit = (float)w->rain_unit,
                                         .spring_unit = (float)w->spring_unit,
                                         .walls = w->walls};
}

void water_show(struct gpu *gpu, struct water *w, struct particles *p)
{
    struct water_surface_params k = surface_params(w, p);
    gpu_fill(gpu, p->field[ROCK_discharge], 0);
    GPU_RUN(gpu, water_show, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], w->occupied,
            w->floors, w->first, w->node[WATER_Z], w->node[WATER_RAIN], w->node[WATER_SPRING],
            p->field[ROCK_discharge]);
}

void water_sweep(struct gpu *gpu, struct water *w, const struct job *job, struct particles *p)
{
    struct water_surface_params k = surface_params(w, p);
    k.shear = (float)job->rain.shear_Pa;
    k.threshold = (float)job->deposition.carry_Pa;
    k.steepest = (float)job->rain.steepest;
    GPU_RUN(gpu, water_sweep, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], w->occupied,
            w->floors, w->first, w->node[WATER_Z], w->node[WATER_RAIN], w->node[WATER_SPRING], w->tag);
}

void water_erode(struct gpu *gpu, struct water *w, const struct job *job, int frame, double kyr,
                 struct particles *p, struct gpu_buffer *intensity, struct gpu_buffer *parts)
{
    struct water_surface_params k = surface_params(w, p);
    k.rate = (float)curve_at(&job->rain.erosion, frame);
    k.shear = (float)job->rain.shear_Pa;
    k.threshold = (float)curve_at(&job->rain.threshold_Pa, frame);
    k.steepest = (float)job->rain.steepest;
    k.most = (float)(WATER_DEPTH * p->h / kyr);
    GPU_RUN(gpu, water_erode, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], w->occupied,
            w->floors, w->first, w->node[WATER_Z], w->node[WATER_RAIN], w->node[WATER_SPRING],
            p->field[ROCK_erodibility], intensity, parts);
}
