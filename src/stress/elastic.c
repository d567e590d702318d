#include "stress/elastic.h"

#include <math.h>

/* The convergence rate (energy left after a cycle, as a share of that before) is taken as SLOWEST at most, so that the
 * estimate stays finite. SAFETY converts from the energy norm to the quantity that is bounded, the 95th percentile of the
 * error of T by that of T. Where T is nearly uniform the two are equal; where much of the rock carries little, as in a
 * canyon's broad floor, the percentile was up to 2.7 times the norm (tests/long/test_stress_error.c). */
#define SAFETY 3.0
#define SLOWEST 0.95

struct elastic_options elastic_options(const struct job *job, struct gpu_buffer *stiff)
{
    const double lambda = job->rock.lame_GPa, mu = job->rock.shear_GPa,
                 young = mu * (3 * lambda + 2 * mu) / (lambda + mu); /* GPa */
    return (struct elastic_options){
        .lambda = 1e9 * job->rock.lame_GPa,
        .mu = 1e9 * job->rock.shear_GPa,
        .density = job->rock.density_kg_m3,
        .gravity = job->rock.gravity_m_s2,
        .loose = fmin(job->deposition.stiffness_MPa / (1e3 * young), 1),
        .tolerance = job->stress.tolerance,
        .max_iterations = (int)job->stress.max_iterations,
        .stiff = stiff,
        .walls = job_walls(job),
        .multigrid = job->stress.solver == STRESS_MULTIGRID,
    };
}

static struct stress_params params(const struct elastic *e, size_t n)
{
    struct stress_params k = lattice_params(&e->lattice, n);
    k.lambda = (float)e->options.lambda;
    k.mu = (float)e->options.mu;
    k.loose = (float)e->options.loose;
    k.jointed = e->options.stiff != NULL;
    k.dx = (float)e->dx;
    k.weight = (float)(e->options.density * e->options.gravity * e->dx * e->dx * e->dx);
    return k;
}

/* The finest level uses the solver's buffers; the cycle works in those that will hold the stress. */
static void set_finest(struct elastic *e)
{
    struct stress_level *l = &e->levels.level[0];
    l->lattice = e->lattice;
    l->params = params(e, e->lattice.n_active);
    l->r = e->r;
    l->z = e->normal_stress;
    l->other = e->shear_stress;
}

/* Scratch for the nodes' terms of a scalar product: the lattice's flags, unused once the nodes are listed. */
static struct gpu_buffer *product_of(const struct elastic *e)
{
    return e->lattice.flags;
}

/* Sums r.z into the scalars and computes beta. */
static void update_beta(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    const struct cg_params scalar = {64, 0, e->iterations == 0};
    GPU_RUN(gpu, stress_beta, 64, scalar, gpu_partial_sums(gpu, work, product_of(e), e->lattice.n_active),
            e->scalars);
}

/* One step of conjugate gradients from the residual r. With Jacobi, beta is already known. */
static void iterate(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    const struct stress_lattice *l = &e->lattice;
    const struct stress_params k = params(e, l->n_active);
    const struct cg_params scalar = {64, (uint)e->iterations % CG_CHECK, 0};
    const struct count_params each = {k.n};
    if (e->options.multigrid) {
        multigrid_cycle(gpu, &e->levels);
        GPU_RUN(gpu, stress_product, k.n, each, l->list, e->r, e->levels.level[0].z, product_of(e));
        update_beta(gpu, work, e);
        GPU_RUN(gpu, stress_follow, k.n, each, l->list, e->scalars, e->levels.level[0].z, e->p, e->p);
    } else {
        GPU_RUN(gpu, stress_direction, k.n, each, l->list, e->scalars, e->r, e->p, e->p);
    }
    GPU_RUN(gpu, stress_matvec, k.n, k, l->list, l->run, l->table, e->p, l->fill, e->q, product_of(e));
    GPU_RUN(gpu, stress_alpha, 64, scalar, gpu_partial_sums(gpu, work, product_of(e), k.n), e->scalars);
    GPU_RUN(gpu, stress_update, k.n, each, l->list, e->scalars, e->p, e->q, e->u, e->r, e->u, e->r,
            product_of(e));
    e->iterations++;
    if (!e->options.multigrid)
        update_beta(gpu, work, e);
}

/* Estimates the energy left in the error from what each step removed. Jacobi's steps are many and uneven: the estimate is
 * what the last CG_CHECK steps removed together, which bounds from below what was left before them. The cycle's steps remove
 * less and less by about the same factor: what is left is the rest of the geometric series, by the larger of the last two
 * ratios. (Such estimates are called delayed in Meurant and Tichy 2019; with the cycle the delay is one step.) */
static double energy_left(const struct elastic *e, const float *scalars)
{
    double taken[CG_CHECK], slower = e->iterations < 2 ? SLOWEST : 0;
    for (int i = 0; i < (int)CG_CHECK; i++) /* the last is taken[0] */
        taken[i] =
            fmax((double)scalars[CG_ENERGY + (uint)(e->iterations - 1 - i + (int)CG_CHECK) % CG_CHECK], 0);
    if (!e->options.multigrid) {
        double sum = 0;
        for (int i = 0; i < (int)CG_CHECK; i++)
            sum += taken[i];
        return sum;
    }
    for (int i = 0; i < 2 && i < e->iterations - 1; i++)
        slower = fmax(slower, taken[i + 1] > 0 ? taken[i] / taken[i + 1] : 0);
    slower = fmin(slower, SLOWEST);
    return SAFETY * SAFETY * taken[0] * slower / (1 - slower);
}

/* Downloads what the steps removed and sets e->error. Waits. */
static status estimate_error(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    status st = OK;
    float scalars[CG_ENERGY + CG_CHECK];
    const struct stress_lattice *l = &e->lattice;
    const struct stress_params k = params(e, l->n_active);
    GPU_RUN(gpu, stress_work, k.n, k, l->list, l->run, l->table, e->u, e->weight, product_of(e));
    gpu_sum(gpu, work, product_of(e), k.n, e->scalars, CG_WORK);
    TRY(gpu_download(gpu, e->scalars, 0, scalars, CG_ENERGY + CG_CHECK));
    const double whole = (double)scalars[CG_WORK],
                 last = (double)scalars[CG_ENERGY + (uint)(e->iterations - 1) % CG_CHECK];
    if (!isfinite(last) || !isfinite(whole)) {
        st = fail(E_NUMERIC, "stress: the solver's numbers are not finite after %d iterations on %zu nodes",
                  e->iterations, l->n_active);
        goto done;
    }
    e->error = whole > 0 ? sqrt(energy_left(e, scalars) / whole) : 0;
done:
    return st;
}

status elastic_solve(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    status st = OK;
    const struct stress_lattice *l = &e->lattice;
    const struct stress_params k = params(e, l->n_active);
    e->iterations = 0;
    e->error = 0;
    if (l->n_active == 0)
        return OK;
    if (e->options.multigrid) {
        set_finest(e);
        TRY(multigrid_assemble(gpu, work, &e->levels, e->marks));
    }
    gpu_fill(gpu, e->p, 0);
    gpu_fill(gpu, e->scalars, 0);
    GPU_RUN(gpu, stress_residual, k.n, k, l->list, l->run, l->table, e->u, l->fill, e->weight, e->r,
            product_of(e));
    if (!e->options.multigrid)
        update_beta(gpu, work, e);
    do {
        /* Checking waits for the device: after each cycle, but only after CG_CHECK of Jacobi's cheap steps. */
        for (int i = 0; i < (e->options.multigrid ? 1 : (int)CG_CHECK); i++)
            iterate(gpu, work, e);
        TRY(estimate_error(gpu, work, e));
    } while (e->error > e->options.tolerance && e->iterations < e->options.max_iterations);
done:
    return st;
}

void elastic_recover(struct gpu *gpu, struct elastic *e, struct particles *p)
{
    const struct stress_lattice *l = &e->lattice;
    const struct stress_params k = params(e, lattice_items(l));
    struct gpu_buffer *stiff = e->options.stiff ? e->options.stiff : e->weight; /* any: it is not looked at */
    GPU_RUN(gpu, stress_recover, k.n, k, l->run, l->table, e->u, l->fill, e->normal_stress, e->shear_stress,
            stiff);
    GPU_RUN(gpu, stress_slope, k.n, k, l->run, l->table, l->fill, e->normal_stress, e->shear_stress, e->q,
            e->r);
    elastic_sample(gpu, e, p);
}

void elastic_sample(struct gpu *gpu, struct elastic *e, struct particles *p)
{
    const struct stress_lattice *l = &e->lattice;
    const struct stress_params k = params(e, p->n);
    GPU_RUN(gpu, stress_sample, k.n, k, l->table, p->field[ROCK_P], l->fill, e->normal_stress,
            e->shear_stress, e->q, e->r, p->field[ROCK_stress], p->field[ROCK_von_mises]);
}
