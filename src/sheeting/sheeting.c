#include "sheeting/sheeting.h"

#include <math.h>

#include "base/random.h"

bool sheeting_wanted(const struct job *job)
{
    return job->sheeting.per_kyr > 0;
}

void sheeting_press(struct gpu *gpu, const struct job *job, double from, double kyr, struct particles *p,
                    struct gpu_buffer *intensity, struct gpu_buffer *parts)
{
    const struct job_sheeting *s = &job->sheeting;
    const double first = from * s->per_kyr,
                 whole = floor(first); /* subtracted below, to keep precision in floats */
    const struct sheeting_params k = {
        .n = (uint)p->n_surface,
        .seed = random_hash((uint32_t)job->seed, 0, 0, RANDOM_SHEETS),
        .thick = (float)s->thick_m,
        .wide = (float)s->wide_m,
        .strength = (float)(1e6 * s->strength_MPa),
        .from = (float)(first - whole),
        .to = (float)((from + kyr) * s->per_kyr - whole),
        .kyr = (float)kyr,
    };
    GPU_RUN(gpu, sheeting_press, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_phase],
            p->field[ROCK_stress], p->field[ROCK_erodibility], intensity, parts);
}
