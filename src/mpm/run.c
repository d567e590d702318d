/* Time stepping of rock in motion. */
#include <math.h>

#include "mpm/internal.h"

/* In cells: the distance particles are expected to move, and may move at most, between sorts. At the maximum the kernel's weights
 * are still positive (0.5 + 0.36 = 0.86). */
static const double EXPECTED = 0.14, MOST = 0.36;

/* Number of steps, at most `left`, before the next sort. */
static long steps_until_sort(const struct mpm *m, double dt, long left)
{
    /* The speed after all `left` steps bounds that during fewer. The margin covers what is not gravity's: rebounds, waves. */
    double speed = 1.5 * m->fastest + m->options.gravity * dt * (double)left + 0.1 * m->dx;
    double steps = floor(EXPECTED * m->dx / (dt * speed));
    return steps < 1 ? 1 : steps < (double)left ? (long)steps : left;
}

/* Updates speeds and bodies after a batch of steps. */
static status measure(struct gpu *gpu, struct gpu_work *work, struct mpm *m)
{
    status st = OK;
    float speed[2]; /* the largest, the sum */
    struct count_params all = {(uint)m->n};
    GPU_RUN(gpu, mpm_speed, m->n, all, m->vector[MPM_VELOCITY], m->speed);
    gpu_max(gpu, work, m->speed, m->n, m->scalars, 0);
    gpu_sum(gpu, work, m->speed, m->n, m->scalars, 1);
    TRY(gpu_download(gpu, m->scalars, 0, speed, 2));
    if (!isfinite(speed[0]) || !isfinite(speed[1])) {
        st = fail(E_NUMERIC, "mpm: speeds are not finite after %ld steps of %zu particles", m->steps, m->n);
        goto done;
    }
    m->fastest = (double)speed[0];
    m->mean_speed = m->n > 0 ? (double)speed[1] / (double)m->n : 0;
    TRY(mpm_pieces_update(gpu, m));
done:
    return st;
}

static void prime(struct gpu *gpu, struct mpm *m, double dt)
{
    struct mpm_params k = mpm_params_of(m, m->n, dt);
    GPU_RUN(gpu, mpm_prime, m->n, k, m->vector[MPM_PLACE], m->vector[MPM_VELOCITY], m->vector[MPM_AFFINE_X],
            m->vector[MPM_AFFINE_Y], m->vector[MPM_STRETCH_X], m->vector[MPM_STRETCH_Y],
            m->vector[MPM_VELOCITY], m->vector[MPM_AFFINE_X], m->vector[MPM_AFFINE_Y]);
}

void mpm_step(struct gpu *gpu, struct mpm *m, const struct mpm_params *params, bool last)
{
    struct mpm_params k = *params;
    k.n = (uint)m->n_parts;
    GPU_RUN(gpu, mpm_scatter, k.n, k, m->part_cell, m->part_first, m->vector[MPM_PLACE],
            m->vector[MPM_VELOCITY], m->vector[MPM_AFFINE_X], m->vector[MPM_AFFINE_Y], m->word[MPM_SHARE],
            m->partial);
    k.n = (uint)m->n_entries;
    GPU_RUN(gpu, mpm_node, k.n, k, m->entry_node, m->slot, m->many, m->reach, m->partial, m->wall,
            m->velocity, m->mass);
    k.n = (uint)m->n_mixed;
    if (m->n_mixed)
        GPU_RUN(gpu, mpm_touch, k.n, k, m->mixed, m->node_list, m->first, m->meeting, m->entry_body,
                m->entry_group, m->mass, m->wall, m->velocity);
    k.n = (uint)m->n;
    if (last) /* mpm_prime adds the impulse again, for the next frame's step length */
        k.push = 0;
    GPU_RUN(gpu, mpm_gather, k.n, k, m->part, m->velocity, m->vector[MPM_PLACE], m->vector[MPM_STRETCH_X],
            m->vector[MPM_STRETCH_Y], m->word[MPM_APART], m->word[MPM_STRENGTH], m->full, m->reach,
            m->vector[MPM_PLACE], m->vector[MPM_VELOCITY], m->vector[MPM_AFFINE_X], m->vector[MPM_AFFINE_Y],
            m->vector[MPM_STRETCH_X], m->vector[MPM_STRETCH_Y], m->word[MPM_APART]);
    m->steps++;
}

status mpm_run(struct gpu *gpu, struct gpu_work *work, struct mpm *m, double seconds)
{
    status st = OK;
    const struct mpm_options *o = &m->options;
    double fastest = m->fastest + o->gravity * seconds;
    /* CFL limit of waves, viscosity and motion: dt = cfl dx / (c (1 + 2 viscosity) + v). */
    double most = o->cfl * m->dx / (mpm_wave(o) * (1 + 2 * o->viscosity) + fastest);
    long n = (long)ceil(seconds / most);
    double dt = seconds / (double)n;
    m->steps = 0;
    prime(gpu, m, dt);
    TRY(mpm_pieces_update(gpu, m));
    while (m->steps < n && m->n > 0) {
        TRY(mpm_sort(gpu, work, m));
        long batch = steps_until_sort(m, dt, n - m->steps);
        struct mpm_params k = mpm_params_of(m, m->n, dt);
        k.fastest = (float)(MOST * m->dx / (dt * (double)batch));
        for (long i = 0; i < batch; i++)
            mpm_step(gpu, m, &k, m->steps + 1 == n);
        TRY(measure(gpu, work, m));
    }
    /* Drop points that left in the last steps. */
    TRY(mpm_sort(gpu, work, m));
done:
    return st;
}
