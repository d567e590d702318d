/* Initial air: potential flow. It slows in front of the rock, parts around it and speeds up beside it as the real flow does;
 * only the wake is left to form. */
#include <math.h>

#include "wind/flow_parts.h"

/* Sweeps per cell along the box's longest side: successive over-relaxation then reduces the error below a thousandth. */
enum { SWEEPS = 4 };

static void relax(struct gpu *gpu, const struct flow *f, struct flow_params k, struct gpu_buffer *source,
                  struct gpu_buffer *faces, struct gpu_buffer *potential)
{
    const int across = f->box[0] > f->box[1] ? f->box[0] : f->box[1];
    const int longest = across > f->box[2] ? across : f->box[2];
    k.n = (k.bx + 1) / 2 * k.by * k.bz;
    k.gain = (float)(2 / (1 + sin(3.14159265358979323846 / longest)));
    gpu_fill(gpu, potential, 0);
    for (int half = 0; half < 2 * SWEEPS * longest; half++) {
        k.first = (uint)half & 1;
        GPU_RUN(gpu, wind_flow_potential, k.n, k, source, faces, potential);
    }
}

void flow_fill(struct gpu *gpu, struct flow *f, struct particles *p)
{
    /* Borrowed: buffers that only the steps use. */
    struct gpu_buffer *kinds = f->key, *faces = f->place, *source = f->density_pressure[1],
                      *potential = f->divergence_pressure[1];
    struct flow_params k = flow_params_of(f, p);
    k.n = (uint)box_count(f);
    GPU_RUN(gpu, wind_flow_kinds, k.n, k, p->held.words, kinds);
    GPU_RUN(gpu, wind_flow_sources, k.n, k, kinds, source, faces);
    relax(gpu, f, k, source, faces, potential);
    GPU_RUN(gpu, wind_flow_fill, k.n, k, kinds, potential, f->position[0], f->velocity[0], f->id[0]);
    gpu_fill(gpu, f->density_pressure[0], 0);
    gpu_fill(gpu, f->divergence_pressure[0], 0);
    f->state.n = f->state.next_id = k.n;
}
