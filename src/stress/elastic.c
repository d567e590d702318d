#include "stress/elastic.h"

#include <math.h>

/* What is left of the energy after a cycle is at most the share SLOWEST, so that the estimate stays finite. SAFETY leads
 * from the energy norm to what is wanted, the 95th percentile of T's error by T's own: where T is about the same
 * everywhere the two are equal, and where much of the rock hardly carries anything, as in a canyon's broad floor, the
 * percentile was up to 2.7 times the norm (tests/long/test_stress_error.c). */
#define SAFETY 3.0
#define SLOWEST 0.95

struct elastic_options elastic_options(const struct job *job)
{
    return (struct elastic_options){
        .lambda = 1e9 * job->rock.lame_GPa,
        .mu = 1e9 * job->rock.shear_GPa,
        .density = job->rock.density_kg_m3,
        .gravity = job->rock.gravity_m_s2,
        .tolerance = job->stress.tolerance,
        .max_iterations = (int)job->stress.max_iterations,
        .multigrid = job->stress.solver == STRESS_MULTIGRID,
    };
}

size_t elastic_nodes(const struct elastic *e)
{
    return (size_t)(e->cells[0] + 1) * (size_t)(e->cells[1] + 1) * (size_t)(e->cells[2] + 1);
}

size_t elastic_cells(const struct elastic *e)
{
    return (size_t)e->cells[0] * (size_t)e->cells[1] * (size_t)e->cells[2];
}

static struct elastic geometry(const int voxels[3], double h)
{
    return (struct elastic){.cells = {voxels[0] / 2 + 2, voxels[1] / 2 + 2, voxels[2] / 2 + 2}, .dx = 2 * h};
}

uint64_t elastic_bytes(const int voxels[3])
{
    struct elastic e = geometry(voxels, 1);
    return elastic_nodes(&e) * (6 * 16 + 4 * 4) + elastic_cells(&e) * 4 + multigrid_bytes(e.cells);
}

status elastic_create(struct gpu *gpu, const int voxels[3], double h, const struct elastic_options *options,
                      struct elastic *e)
{
    status st = OK;
    *e = geometry(voxels, h);
    e->options = *options;
    size_t nodes = elastic_nodes(e), cells = elastic_cells(e);
    TRY(gpu_buffer_create(gpu, "cell fill", cells, 4, &e->fill));
    TRY(gpu_buffer_create(gpu, "displacement", nodes, 16, &e->u));
    TRY(gpu_buffer_create(gpu, "search direction", nodes, 16, &e->p));
    TRY(gpu_buffer_create(gpu, "search image", nodes, 16, &e->q));
    TRY(gpu_buffer_create(gpu, "residual", nodes, 16, &e->r));
    TRY(gpu_buffer_create(gpu, "nodal products", nodes, 4, &e->product));
    TRY(gpu_buffer_create(gpu, "active nodes", nodes, 4, &e->list));
    TRY(gpu_buffer_create(gpu, "node flags", nodes, 4, &e->flags));
    TRY(gpu_buffer_create(gpu, "node places", nodes, 4, &e->place));
    TRY(gpu_buffer_create(gpu, "solver scalars", CG_ENERGY + CG_CHECK, 4, &e->scalars));
    TRY(gpu_buffer_create(gpu, "normal stress", nodes, 16, &e->normal_stress));
    TRY(gpu_buffer_create(gpu, "shear stress", nodes, 16, &e->shear_stress));
    TRY(multigrid_create(gpu, e->cells, &e->levels));
done:
    if (st != OK)
        elastic_destroy(gpu, e);
    return st;
}

void elastic_destroy(struct gpu *gpu, struct elastic *e)
{
    struct gpu_buffer **all[] = {&e->fill,          &e->u,           &e->p,     &e->q,     &e->r,
                                 &e->product,       &e->list,        &e->flags, &e->place, &e->scalars,
                                 &e->normal_stress, &e->shear_stress};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    multigrid_destroy(gpu, &e->levels);
}

static struct stress_params params(const struct elastic *e, size_t n)
{
    return (struct stress_params){
        .n = (uint)n,
        .cx = (uint)e->cells[0],
        .cy = (uint)e->cells[1],
        .cz = (uint)e->cells[2],
        .lambda = (float)e->options.lambda,
        .mu = (float)e->options.mu,
        .dx = (float)e->dx,
        .weight = (float)(e->options.density * e->options.gravity * e->dx * e->dx * e->dx),
    };
}

/* The finest level is the solver's own; the cycle works where the stress will be. */
static void set_finest(struct elastic *e)
{
    struct stress_level *l = &e->levels.level[0];
    l->n_active = e->n_active;
    l->params = params(e, e->n_active);
    l->fill = e->fill;
    l->list = e->list;
    l->r = e->r;
    l->z = e->normal_stress;
    l->other = e->shear_stress;
}

status elastic_assemble(struct gpu *gpu, struct gpu_work *work, struct elastic *e, const struct particles *p)
{
    status st = OK;
    size_t inner = (size_t)(e->cells[0] - 2) * (size_t)(e->cells[1] - 2) * (size_t)(e->cells[2] - 2);
    struct stress_params k = params(e, inner);
    GPU_RUN(gpu, stress_fill, inner, k, p->held.words, p->start, p->field[ROCK_viability], e->fill);
    k.n = (uint)elastic_nodes(e);
    GPU_RUN(gpu, stress_active, k.n, k, e->fill, e->flags);
    TRY(gpu_compact(gpu, work, e->flags, e->place, e->list, elastic_nodes(e), &e->n_active));
done:
    return st;
}

/* Into the scalars: the residual's product with what the preconditioner makes of it. */
static void weigh(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    const struct cg_params scalar = {64, 0, e->iterations == 0};
    GPU_RUN(gpu, stress_beta, 64, scalar, gpu_partial_sums(gpu, work, e->product, e->n_active), e->scalars);
}

/* A step of conjugate gradients from the residual r, whose product with Jacobi's correction is weighed already. */
static void iterate(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    const struct stress_params k = params(e, e->n_active);
    const struct cg_params scalar = {64, (uint)e->iterations % CG_CHECK, 0};
    const struct count_params each = {k.n};
    if (e->options.multigrid) {
        multigrid_cycle(gpu, &e->levels);
        GPU_RUN(gpu, stress_product, k.n, each, e->list, e->r, e->levels.level[0].z, e->product);
        weigh(gpu, work, e);
        GPU_RUN(gpu, stress_follow, k.n, each, e->list, e->scalars, e->levels.level[0].z, e->p, e->p);
    } else {
        GPU_RUN(gpu, stress_direction, k.n, each, e->list, e->scalars, e->r, e->p, e->p);
    }
    GPU_RUN(gpu, stress_matvec, k.n, k, e->list, e->p, e->fill, e->q, e->product);
    GPU_RUN(gpu, stress_alpha, 64, scalar, gpu_partial_sums(gpu, work, e->product, k.n), e->scalars);
    GPU_RUN(gpu, stress_update, k.n, each, e->list, e->scalars, e->p, e->q, e->u, e->r, e->u, e->r,
            e->product);
    e->iterations++;
    if (!e->options.multigrid)
        weigh(gpu, work, e);
}

/* Which energy is still in the error, from what the steps so far took out of it. Jacobi's steps are many and take
 * unevenly: what the last CG_CHECK took is what was left before them. Those of the cycle take ever less by about
 * the same factor: what is left is the rest of the series, by the slower of the last two. (Meurant and Tichy 2019 call
 * such estimates delayed; with a cycle the delay is a step.) */
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

/* Reads what the steps so far took, and estimates what is left. */
static status judge(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    status st = OK;
    float scalars[CG_ENERGY + CG_CHECK];
    const struct stress_params k = params(e, e->n_active);
    GPU_RUN(gpu, stress_work, k.n, k, e->list, e->u, e->fill, e->product);
    gpu_sum(gpu, work, e->product, k.n, e->scalars, CG_WORK);
    TRY(gpu_download(gpu, e->scalars, 0, scalars, CG_ENERGY + CG_CHECK));
    const double whole = (double)scalars[CG_WORK],
                 last = (double)scalars[CG_ENERGY + (uint)(e->iterations - 1) % CG_CHECK];
    if (!isfinite(last) || !isfinite(whole)) {
        st = fail(E_NUMERIC, "stress: the solver's numbers are not finite after %d iterations on %zu nodes",
                  e->iterations, e->n_active);
        goto done;
    }
    e->error = whole > 0 ? sqrt(energy_left(e, scalars) / whole) : 0;
done:
    return st;
}

status elastic_solve(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    status st = OK;
    const struct stress_params k = params(e, e->n_active);
    e->iterations = 0;
    e->error = 0;
    if (e->n_active == 0)
        return OK;
    if (e->options.multigrid) {
        set_finest(e);
        TRY(multigrid_assemble(gpu, work, &e->levels, e->flags, e->place));
    }
    gpu_fill(gpu, e->p, 0);
    gpu_fill(gpu, e->scalars, 0);
    GPU_RUN(gpu, stress_residual, k.n, k, e->list, e->u, e->fill, e->r, e->product);
    if (!e->options.multigrid)
        weigh(gpu, work, e);
    do {
        /* A cycle is worth a look at what it did, a step of Jacobi's is not. */
        for (int i = 0; i < (e->options.multigrid ? 1 : (int)CG_CHECK); i++)
            iterate(gpu, work, e);
        TRY(judge(gpu, work, e));
    } while (e->error > e->options.tolerance && e->iterations < e->options.max_iterations);
done:
    return st;
}

void elastic_recover(struct gpu *gpu, struct elastic *e, struct particles *p)
{
    struct stress_params k = params(e, elastic_cells(e));
    GPU_RUN(gpu, stress_recover, k.n, k, e->u, e->fill, e->normal_stress, e->shear_stress);
    GPU_RUN(gpu, stress_slope, k.n, k, e->fill, e->normal_stress, e->shear_stress, e->q, e->r);
    k.n = (uint)p->n;
    GPU_RUN(gpu, stress_sample, k.n, k, p->field[ROCK_P], e->fill, e->normal_stress, e->shear_stress, e->q,
            e->r, p->field[ROCK_stress], p->field[ROCK_von_mises]);
}
