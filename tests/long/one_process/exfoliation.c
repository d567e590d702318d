#include "exfoliation/exfoliation.h"

bool exfoliation_wanted(const struct job *job)
{
    return curve_max(&job->exfoliation.share_per_kyr) > 0;
}

uint64_t exfoliation_bytes(size_t n)
{
    return 4 * (uint64_t)n;
}

status exfoliation_create(struct gpu *gpu, size_t n_max, struct exfoliation *e)
{
    return gpu_buffer_create(gpu, "shed skin", n_max, 4, &e->shed);
}

void exfoliation_destroy(struct gpu *gpu, struct exfoliation *e)
{
    gpu_buffer_destroy(gpu, &e->shed);
}

void exfoliation_step(struct gpu *gpu, struct exfoliation *e, const struct job *job, int frame, double kyr,
                      struct particles *p)
{
    struct erosion_params k = {
        .n = (uint)p->n_surface,
        .dt = (float)(kyr * curve_at(&job->exfoliation.share_per_kyr, frame)),
    };
    GPU_RUN(gpu, exfoliation_shed, k.n, k, p->surface, p->field[ROCK_phase], p->field[ROCK_erodibility],
            p->field[ROCK_viability], e->shed);
}
