/* Rock at rest: static equilibrium by kinetic damping. */
#include <math.h>

#include "mpm/internal.h"

enum { CHECK = 32 }; /* steps between checks of the energies */

static void step(struct gpu *gpu, struct gpu_work *work, struct mpm *m, const struct mpm_params *params)
{
    struct mpm_params k = *params;
    struct count_params one = {64};
    k.n = (uint)m->n_parts;
    GPU_RUN(gpu, mpm_scatter, k.n, k, m->part_cell, m->part_first, m->vector[MPM_PLACE],
            m->vector[MPM_VELOCITY], m->vector[MPM_AFFINE_X], m->vector[MPM_AFFINE_Y], m->word[MPM_SHARE],
            m->partial);
    k.n = (uint)m->n_entries;
    GPU_RUN(gpu, mpm_hold, k.n, k, m->entry_node, m->slot, m->many, m->reach, m->partial, m->velocity,
            m->product);
    GPU_RUN(gpu, mpm_peak, 64, one, gpu_partial_sums(gpu, work, m->product, k.n), m->scalars);
    k.n = (uint)m->n;
    GPU_RUN(gpu, mpm_strain, k.n, k, m->part, m->velocity, m->vector[MPM_PLACE], m->vector[MPM_STRETCH_X],
            m->vector[MPM_STRETCH_Y], m->scalars, m->reach, m->vector[MPM_PLACE], m->vector[MPM_VELOCITY],
            m->vector[MPM_AFFINE_X], m->vector[MPM_AFFINE_Y], m->vector[MPM_STRETCH_X],
            m->vector[MPM_STRETCH_Y]);
}

static void recover(struct gpu *gpu, struct gpu_work *work, struct mpm *m, struct particles *p)
{
    struct mpm_params k = mpm_params_of(m, m->n, 0);
    GPU_RUN(gpu, mpm_rest, m->n, k, m->word[MPM_ORIGIN], m->vector[MPM_PLACE], m->vector[MPM_STRETCH_X],
            m->vector[MPM_STRETCH_Y], m->word[MPM_SHARE], p->field[ROCK_stress], p->field[ROCK_von_mises],
            m->product);
    gpu_sum(gpu, work, m->product, m->n, m->scalars, MPM_ENERGY);
}

status mpm_rest(struct gpu *gpu, struct gpu_work *work, struct mpm *m, struct particles *p, double tolerance,
                int max_steps, int *steps, double *error)
{
    status st = OK;
    struct count_params all = {(uint)p->n};
    *steps = 0;
    *error = 0;
    if (p->n == 0)
        return OK;
    GPU_RUN(gpu, gpu_iota, p->n, all, m->order);
    gpu_copy(gpu, m->speed, p->field[ROCK_viability], p->n);
    mpm_load(gpu, m, p, m->order, p->n);
    gpu_copy(gpu, p->field[ROCK_viability], m->speed, p->n);
    m->resting = NULL;
    TRY(mpm_sort(gpu, work, m));
    gpu_fill(gpu, m->scalars, 0);
    struct mpm_params k = mpm_params_of(m, m->n, m->options.cfl * m->dx / mpm_wave(&m->options));
    do {
        float scalars[SCALARS];
        for (int i = 0; i < CHECK; i++)
            step(gpu, work, m, &k);
        *steps += CHECK;
        recover(gpu, work, m, p);
        TRY(gpu_download(gpu, m->scalars, 0, scalars, SCALARS));
        double peak = (double)scalars[MPM_PEAK], energy = (double)scalars[MPM_ENERGY];
        if (!isfinite(energy) || !isfinite(scalars[MPM_LAST])) {
            st =
                fail(E_NUMERIC, "mpm: energies are not finite after %d steps of %zu particles", *steps, m->n);
            goto done;
        }
        *error = peak > 0 && energy > 0 ? sqrt(peak / energy) : 1;
    } while (*error > tolerance && *steps < max_steps);
done:
    return st;
}
