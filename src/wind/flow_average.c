/* The time average of the air, and its error estimate. */
#include <math.h>

#include "wind/flow_parts.h"

void flow_sample(struct gpu *gpu, struct flow *f)
{
    struct flow_params k = flow_params_of(f, NULL);
    k.n = (uint)box_count(f);
    GPU_RUN(gpu, wind_flow_average, k.n, k, f->start, f->position[0], f->velocity[0], f->block);
    f->samples++;
}

status flow_add_block(struct gpu *gpu, struct flow *f, int steps, double *error)
{
    status st = OK;
    struct flow_params k = flow_params_of(f, NULL);
    const double before = f->state.weight, all = before + steps;
    struct gpu_buffer *apart = f->density_pressure[1],
                      *size = f->divergence_pressure[1]; /* free between steps */
    float square[2];
    k.n = (uint)box_count(f);
    k.keep = (float)(before / all);
    k.gain = (float)(steps / (all * f->samples));
    k.warm = (float)(1.0 / f->samples);
    GPU_RUN(gpu, wind_flow_add_block, k.n, k, f->surface, f->block, f->sums, apart, size);
    gpu_fill(gpu, f->block, 0);
    gpu_sum(gpu, f->work, apart, k.n, f->squares, 0);
    gpu_sum(gpu, f->work, size, k.n, f->squares, 1);
    TRY(gpu_download(gpu, f->squares, 0, square, 2));
    f->state.weight = all;
    f->samples = 0;
    /* The block differs from the new average by before / all of its difference to the old one. */
    *error = before == 0     ? INFINITY
             : square[1] > 0 ? sqrt((double)square[0] / (double)square[1] * steps / before)
                             : 0;
done:
    return st;
}

void flow_average(struct gpu *gpu, struct flow *f)
{
    struct flow_params k = flow_params_of(f, NULL);
    k.n = (uint)box_count(f);
    GPU_RUN(gpu, wind_flow_mean, k.n, k, f->sums, f->mean);
}
