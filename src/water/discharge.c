/* Discharge: rain split between lower neighbours, springs along receivers; and the streams these make. */
#include <math.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "water/internal.h"

/* ---- rain */

/* Rounds of accumulation between two reads of the length of the list: at first, and at most. */
enum { ROUNDS = 16, ROUNDS_MOST = 256, THREADS_LEAST = 1024 };

/* *spill: the level to which each basin fills, the highest pass on its path out. */
static void find_spills(struct gpu *gpu, struct water *w, struct gpu_buffer **spill)
{
    struct gpu_buffer **node = w->node;
    struct gpu_buffer *level[2] = {node[WATER_LOWEST], node[WATER_PICK]};
    struct gpu_buffer *next[2] = {node[WATER_NEXT], node[WATER_SCRATCH]};
    const struct water_params k = water_params(w, w->n_basins + 1);
    int now = 0;
    GPU_RUN(gpu, water_spill, k.n, k, node[WATER_COMPONENT], node[WATER_FROM], node[WATER_TO],
            node[WATER_BASIN], node[WATER_Z], level[0], next[0]);
    for (size_t far = 1; far <= w->n_basins; far *= 2, now = !now)
        GPU_RUN(gpu, water_spill_double, k.n, k, level[now], next[now], level[!now], next[!now]);
    *spill = level[now];
}

/* Water levels, directions and shares of all spans, and the number of donors of each. */
static void split(struct gpu *gpu, struct water *w)
{
    struct gpu_buffer **node = w->node, *spill, *donors = node[WATER_SCRATCH + 1];
    const struct water_params k = water_params(w, w->n_nodes);
    find_spills(gpu, w, &spill);
    gpu_fill(gpu, donors, 0);
    GPU_RUN(gpu, water_split, k.n, k, w->occupied, w->floors, w->first, node[WATER_CELL], node[WATER_Z],
            node[WATER_BASIN], spill, node[WATER_FINAL], node[WATER_LEVEL], w->pass, w->shares, w->heading,
            donors);
}

/* A round visits only the spans that pass their rain on in it: paths over flat or porous rock are hundreds of spans long, and most
 * rounds have few spans. */
static status let_it_rain(struct gpu *gpu, struct gpu_work *work, struct water *w)
{
    status st = OK;
    struct gpu_buffer **node = w->node, *length = gpu_work_words(work), *waits = node[WATER_SCRATCH + 1];
    struct gpu_buffer *list[2] = {node[WATER_SCRATCH], node[WATER_NEXT]};
    struct water_params k = water_params(w, w->columns);
    uint32_t passing = (uint32_t)w->n_nodes, passed;
    GPU_RUN(gpu, water_rain, k.n, k, w->occupied, w->floors, w->first, node[WATER_RAIN]);
    gpu_fill(gpu, length, 0);
    k.n = (uint)w->n_nodes;
    GPU_RUN(gpu, water_begin, k.n, k, waits, list[0], length);
    for (uint rounds = ROUNDS; passing > 0; rounds = rounds < ROUNDS_MOST ? 2 * rounds : rounds) {
        k.n = passing > THREADS_LEAST ? passing : THREADS_LEAST;
        for (uint i = 0; i < rounds; i++, k.round++)
            GPU_RUN(gpu, water_flow, k.n, k, w->pass, w->shares, list[k.round % 2], list[(k.round + 1) % 2],
                    waits, node[WATER_RAIN], length);
        TRY(gpu_download(gpu, length, k.round % 3, &passing, 1));
    }
    TRY(gpu_download(gpu, length, 3, &passed, 1));
    if (passed != w->n_nodes)
        st = fail(
            E_NUMERIC,
            "water: only %u of %zu spans pass their rain on, so the flow paths of the others form cycles: the device computes wrongly",
            (unsigned)passed, w->n_nodes);
done:
    return st;
}

/* ---- springs */

/* Warns once of sources whose water enters elsewhere. */
static status warn_of_entries(struct gpu *gpu, struct water *w)
{
    status st = OK;
    uint32_t *entry = NULL;
    if (w->entered)
        return OK;
    w->entered = true;
    TRY(memory_alloc(2 * w->n_sources, 4, "sources", &entry));
    TRY(gpu_download(gpu, w->entry, 0, entry, 2 * w->n_sources));
    for (size_t i = 0; i < w->n_sources; i++)
        if (entry[2 * i + 1] > 4)
            log_warn(
                "sources[%zu].path_m: begins inside rock; its water enters at the nearest place outside, %.3g spacings away: begin it in the open, or give it a bed_m",
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
    TRY(warn_of_entries(gpu, w));
done:
    return st;
}

/* ---- streams */

/* The reach of streams is bounded by the width of one that carries all water. */
static struct water_stream_params stream_params(const struct water *w, const struct job *job, int frame,
                                                double h)
{
    enum { REACH = 16 };            /* cells: bounds the cost of a wide river on a fine grid */
    const double disc = 0.84882636; /* RADIUS of shaders/water/wide.comp.glsl */
    const struct job_rain *rain = &job->rain;
    double q = curve_at(&rain->m_per_yr, frame) * w->voxels[0] * w->voxels[1] * h * h;
    for (size_t i = 0; i < job->n_sources; i++)
        q += curve_at(&job->sources[i].m3_per_yr, frame);
    const double narrowest = 1.5 * h, widest = REACH * h / disc, window = fmax(rain->slope_m / 2, 1.5 * h);
    const double width =
        fmax(fmax(rain->width_m * pow(q, rain->width_power), rain->least_width_m), narrowest);
    const double reach = fmax(disc * fmin(width, widest) + h, fmin(window, REACH * h) + h / 2) / h;
    return (struct water_stream_params){.n = (uint)w->n_nodes,
                                        .cx = (uint)w->cells[0],
                                        .cy = (uint)w->cells[1],
                                        .cz = (uint)w->cells[2],
                                        .words = (uint)w->words,
                                        .h = (float)h,
                                        .rain_unit = (float)w->rain_unit,
                                        .spring_unit = (float)w->spring_unit,
                                        .width = (float)rain->width_m,
                                        .power = (float)rain->width_power,
                                        .least = (float)rain->least_width_m,
                                        .narrowest = (float)narrowest,
                                        .widest = (float)widest,
                                        .window = (float)fmin(window, REACH * h),
                                        .reach = (uint)ceil(reach),
                                        .deep = (float)fmax(h, rain->least_width_m / 2),
                                        .pull = (float)rain->pull_Pa,
                                        .steepest = (float)rain->steepest,
                                        .per_row = 1.0f / (float)w->cells[0],
                                        .per_slab = 1.0f / (float)w->columns,
                                        .walls = w->walls};
}

static void gather_streams(struct gpu *gpu, struct water *w, const struct job *job, int frame, double h)
{
    struct gpu_buffer **node = w->node, *width = node[WATER_NEXT], *middle = node[WATER_PICK];
    const struct water_stream_params k = stream_params(w, job, frame, h);
    GPU_RUN(gpu, water_wide, k.n, k, w->occupied, w->floors, w->first, node[WATER_CELL], node[WATER_LEVEL],
            node[WATER_RAIN], node[WATER_SPRING], w->stream, width, node[WATER_FINAL], middle);
    GPU_RUN(gpu, water_pull, k.n, k, w->occupied, w->floors, w->first, node[WATER_CELL], node[WATER_Z],
            node[WATER_LEVEL], w->heading, w->stream, width, w->pull, node[WATER_DROP], middle);
}

status water_discharge(struct gpu *gpu, struct gpu_work *work, struct water *w, const struct job *job,
                       int frame, const struct particles *p)
{
    status st = OK;
    const double rain = curve_at(&job->rain.m_per_yr, frame);
    w->rain_unit = rain * p->h * p->h / w->rain_units;
    gpu_fill(gpu, w->node[WATER_RAIN], 0);
    gpu_fill(gpu, w->node[WATER_SPRING], 0);
    split(gpu, w);
    if (rain > 0)
        TRY(let_it_rain(gpu, work, w));
    TRY(let_it_spring(gpu, w, job, frame));
    gather_streams(gpu, w, job, frame, p->h);
done:
    return st;
}
