#include "stress/elastic.h"

#include <math.h>

struct elastic_options elastic_options(const struct job *job)
{
    return (struct elastic_options){
        .lambda = 1e9 * job->rock.lame_GPa,
        .mu = 1e9 * job->rock.shear_GPa,
        .density = job->rock.density_kg_m3,
        .gravity = job->rock.gravity_m_s2,
        .tolerance = job->stress.tolerance,
        .max_iterations = (int)job->stress.max_iterations,
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
    return elastic_nodes(&e) * (4 * 16 + 4 * 4) + elastic_cells(&e) * (2 * 16 + 4);
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
    TRY(gpu_buffer_create(gpu, "normal stress", cells, 16, &e->normal_stress));
    TRY(gpu_buffer_create(gpu, "shear stress", cells, 16, &e->shear_stress));
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

status elastic_assemble(struct gpu *gpu, struct gpu_work *work, struct elastic *e, const struct particles *p)
{
    size_t inner = (size_t)(e->cells[0] - 2) * (size_t)(e->cells[1] - 2) * (size_t)(e->cells[2] - 2);
    struct stress_params k = params(e, inner);
    GPU_RUN(gpu, stress_fill, inner, k, p->start, p->field[ROCK_viability], e->fill);
    k.n = (uint)elastic_nodes(e);
    GPU_RUN(gpu, stress_active, k.n, k, e->fill, e->flags);
    return gpu_compact(gpu, work, e->flags, e->place, e->list, elastic_nodes(e), &e->n_active);
}

/* From a fresh residual to a fresh direction p = z. */
static void begin(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    struct stress_params k = params(e, e->n_active);
    struct cg_params scalar = {64, 0, 1};
    struct count_params each = {k.n};
    gpu_fill(gpu, e->p, 0);
    GPU_RUN(gpu, stress_residual, k.n, k, e->list, e->u, e->fill, e->r, e->product);
    GPU_RUN(gpu, stress_beta, 64, scalar, gpu_partial_sums(gpu, work, e->product, k.n), e->scalars);
    GPU_RUN(gpu, stress_direction, k.n, each, e->list, e->scalars, e->r, e->p, e->p);
}

static void iterate(struct gpu *gpu, struct gpu_work *work, struct elastic *e, uint iteration)
{
    struct stress_params k = params(e, e->n_active);
    struct cg_params scalar = {64, iteration % CG_CHECK, 0};
    struct count_params each = {k.n};
    GPU_RUN(gpu, stress_matvec, k.n, k, e->list, e->p, e->fill, e->q, e->product);
    GPU_RUN(gpu, stress_alpha, 64, scalar, gpu_partial_sums(gpu, work, e->product, k.n), e->scalars);
    GPU_RUN(gpu, stress_update, k.n, each, e->list, e->scalars, e->p, e->q, e->u, e->r, e->u, e->r,
            e->product);
    GPU_RUN(gpu, stress_beta, 64, scalar, gpu_partial_sums(gpu, work, e->product, k.n), e->scalars);
    GPU_RUN(gpu, stress_direction, k.n, each, e->list, e->scalars, e->r, e->p, e->p);
}

status elastic_solve(struct gpu *gpu, struct gpu_work *work, struct elastic *e)
{
    status st = OK;
    e->iterations = 0;
    e->error = 0;
    if (e->n_active == 0)
        return OK;
    begin(gpu, work, e);
    while (e->iterations < e->options.max_iterations) {
        float scalars[CG_ENERGY + CG_CHECK];
        struct stress_params k = params(e, e->n_active);
        for (uint i = 0; i < CG_CHECK; i++)
            iterate(gpu, work, e, i);
        e->iterations += (int)CG_CHECK;
        GPU_RUN(gpu, stress_work, k.n, k, e->list, e->u, e->fill, e->product);
        gpu_sum(gpu, work, e->product, k.n, e->scalars, CG_WORK);
        TRY(gpu_download(gpu, e->scalars, 0, scalars, CG_ENERGY + CG_CHECK));
        double taken = 0, whole = (double)scalars[CG_WORK];
        for (uint i = 0; i < CG_CHECK; i++)
            taken += (double)scalars[CG_ENERGY + i];
        if (!isfinite(taken) || !isfinite(whole)) {
            st = fail(E_NUMERIC,
                      "stress: the solver's numbers are not finite after %d iterations on %zu nodes",
                      e->iterations, e->n_active);
            goto done;
        }
        e->error = whole > 0 ? sqrt(fmax(taken, 0) / whole) : 0;
        if (e->error <= e->options.tolerance)
            break;
    }
done:
    return st;
}

void elastic_recover(struct gpu *gpu, struct elastic *e, struct particles *p)
{
    struct stress_params k = params(e, elastic_cells(e));
    GPU_RUN(gpu, stress_recover, k.n, k, e->u, e->fill, e->normal_stress, e->shear_stress);
    k.n = (uint)p->n;
    GPU_RUN(gpu, stress_sample, k.n, k, p->field[ROCK_P], e->fill, e->normal_stress, e->shear_stress,
            p->field[ROCK_stress], p->field[ROCK_von_mises]);
}
