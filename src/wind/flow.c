#include "wind/flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "wind/flow_parts.h"

enum {
    SAMPLE_EVERY = 4, /* steps between samples of the average */
    BLOCK = 32,       /* steps in a block, in which the wind advances by six spacings */
    FIRST_ITERATIONS =
        40 /* of the divergence solve in the first step, for air that has not met the rock yet */
};

/* Drift towards lower density, in wind speeds per unit of the density's gradient (which is about 0.7 where one side is
 * empty). Without it the particles of a wake cluster in strings with voids between them: behind a cube 2/5 of the space was
 * air, with it 3/4. At 3 it overshoots and the lattice becomes noisy. */
#define DRIFT 2.0f

/* Warm start: share of the last step's pressures with which the solves begin. FULL: density from which pressure may be
 * negative in the divergence solve; at lower density it would pull particles into strings. */
#define WARM_DENSITY 0.5f
#define WARM_DIVERGENCE 1.0f
#define FULL 0.8f

/* ---- steps */

struct flow_params flow_params_of(const struct flow *f, const struct particles *p)
{
    struct flow_params k = {
        .n = (uint)f->slots,
        .slots = (uint)f->slots,
        .bx = (uint)f->box[0],
        .by = (uint)f->box[1],
        .bz = (uint)f->box[2],
        .gx = (uint)f->cells[0],
        .gy = (uint)f->cells[1],
        .gz = (uint)f->cells[2],
        .wind_x = (float)f->state.direction[0],
        .wind_y = (float)f->state.direction[1],
        .dt = (float)FLOW_DT,
        .viscosity = (float)f->viscosity,
        .origin_x = (float)f->origin[0],
        .origin_y = (float)f->origin[1],
        .spacing = (float)f->spacing,
    };
    if (p) {
        k.walls = p->walls;
        k.nx = (uint)p->voxels[0];
        k.ny = (uint)p->voxels[1];
        k.nz = (uint)p->voxels[2];
        k.h = (float)p->h;
    }
    return k;
}

static void swap(struct gpu_buffer *pair[2])
{
    struct gpu_buffer *first = pair[0];
    pair[0] = pair[1];
    pair[1] = first;
}

/* Sorts the particles by cell. */
static void arrange(struct gpu *gpu, struct flow *f, struct flow_params k)
{
    struct gpu_sort sort = {.keys = f->key,
                            .ids = f->id[0],
                            .start = f->start,
                            .order = f->order,
                            .taken = f->taken,
                            .unordered = f->unordered,
                            .n = f->slots,
                            .n_keys = cell_count(f) + 1,
                            .n_ordered = cell_count(f)};
    gpu_sort(gpu, f->work, &sort);
    GPU_RUN(gpu, wind_flow_arrange, f->slots, k, f->start, f->order, f->position[0], f->velocity[0],
            f->density_pressure[0], f->divergence_pressure[0], f->id[0], f->position[1], f->velocity[1],
            f->density_pressure[1], f->divergence_pressure[1], f->id[1]);
    swap(f->position);
    swap(f->velocity);
    swap(f->density_pressure);
    swap(f->divergence_pressure);
    swap(f->id);
}

/* One pressure solve: fixed Jacobi iterations, then the velocities are updated. */
static void solve(struct gpu *gpu, struct flow *f, struct flow_params k, struct gpu_buffer *pressure,
                  int iterations)
{
    for (int i = 0; i < iterations; i++) {
        GPU_RUN(gpu, wind_flow_push, f->slots, k, f->of_step, f->list, f->position[0], pressure, f->push);
        GPU_RUN(gpu, wind_flow_relax, f->slots, k, f->of_step, f->list, f->position[0], f->push, pressure);
    }
    GPU_RUN(gpu, wind_flow_push, f->slots, k, f->of_step, f->list, f->position[0], pressure, f->push);
    GPU_RUN(gpu, wind_flow_apply, f->slots, k, f->push, f->viscous, f->velocity[0]);
}

/* Index of the lattice plane that entered the box with the last move along an axis; the box's size if none did. */
static uint entered(double first, double moved, int box)
{
    if (moved > 0)
        return first < moved ? 0 : (uint)box;
    return first - 1 >= moved && moved < 0 ? (uint)box - 1 : (uint)box;
}

static void emit(struct gpu *gpu, struct flow *f, struct flow_params k)
{
    double first[2];
    uint enter[2];
    for (int a = 0; a < 2; a++) {
        double moved = f->state.direction[a] * FLOW_DT, to = f->state.offset[a] + moved;
        f->state.offset[a] = to - floor(to);
        first[a] = f->state.offset[a] < 0.5 ? f->state.offset[a] + 0.5 : f->state.offset[a] - 0.5;
        enter[a] = entered(first[a], moved, f->box[a]);
    }
    k.column_x = (float)first[0];
    k.column_y = (float)first[1];
    k.enter_x = enter[0];
    k.enter_y = enter[1];
    k.first = f->state.next_id;
    k.n = (enter[0] < k.bx ? k.by * k.bz : 0) + (enter[1] < k.by ? k.bx * k.bz : 0);
    f->state.next_id = (f->state.next_id + k.n) % FLOW_GROUND_ID;
    f->report.n_in += k.n - (enter[0] < k.bx && enter[1] < k.by ? k.bz : 0);
    if (k.n)
        GPU_RUN(gpu, wind_flow_emit, k.n, k, f->start, f->position[0], f->velocity[0], f->density_pressure[0],
                f->divergence_pressure[0], f->id[0], f->key, f->counts);
}

static void neighbours(struct gpu *gpu, struct flow *f, struct flow_params k)
{
    GPU_RUN(gpu, wind_flow_neighbours, f->slots, k, f->start, f->position[0], f->velocity[0], f->list,
            f->of_step, f->viscous, f->crowd, f->divergence_pressure[0]);
}

static void step(struct gpu *gpu, struct flow *f, struct flow_params k, struct particles *p)
{
    k.warm = WARM_DIVERGENCE;
    k.full = FULL;
    k.gain = 1;
    neighbours(gpu, f, k);
    solve(gpu, f, k, f->divergence_pressure[0], f->state.steps ? f->divergence_iterations : FIRST_ITERATIONS);
    k.warm = WARM_DENSITY;
    k.full = INFINITY;
    k.gain = 0;
    GPU_RUN(gpu, wind_flow_target, f->slots, k, f->list, f->position[0], f->velocity[0], f->of_step,
            f->density_pressure[0]);
    solve(gpu, f, k, f->density_pressure[0], f->density_iterations);
    k.gain = DRIFT;
    GPU_RUN(gpu, wind_flow_move, f->slots, k, f->start, f->crowd, p->held.words, f->position[0],
            f->velocity[0], f->key);
    emit(gpu, f, k);
    arrange(gpu, f, k);
    f->state.steps++;
}

/* ---- a run */

status flow_change(struct gpu *gpu, struct flow *f, struct particles *p, double *share)
{
    status st = OK;
    struct flow_params k = flow_params_of(f, p);
    uint32_t count[2];
    k.n = (uint)p->n_surface;
    gpu_fill(gpu, f->surface_sums, 0);
    GPU_RUN(gpu, wind_flow_surface, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N],
            f->surface_sums);
    k.n = (uint)box_count(f);
    GPU_RUN(gpu, wind_flow_flags, k.n, k, f->surface_sums, f->flags);
    gpu_fill(gpu, f->counts, 0);
    GPU_RUN(gpu, wind_flow_change, k.n, k, f->surface, f->flags, f->counts);
    TRY(gpu_download(gpu, f->counts, 0, count, 2));
    *share = f->state.steps == 0 ? 1 : count[1] == 0 ? 0 : count[0] == 0 ? 1 : (double)count[1] / count[0];
done:
    return st;
}

int flow_flush(const struct flow *f, const double direction[2])
{
    return (int)ceil((fabs(direction[0]) * f->box[0] + fabs(direction[1]) * f->box[1]) / FLOW_DT);
}

/* Prepares a run: removes air that is now in rock, and samples boundary particles from the current surface. */
static status begin(struct gpu *gpu, struct flow *f, struct flow_params k, struct particles *p)
{
    status st = OK;
    size_t n_rock;
    if (f->state.steps == 0)
        flow_fill(gpu, f, p);
    k.first = f->state.n;
    GPU_RUN(gpu, wind_flow_begin, k.n, k, f->position[0], f->velocity[0], p->held.words, f->key);
    gpu_copy(gpu, f->surface, f->flags, box_count(f));
    TRY(gpu_compact(gpu, f->work, f->flags, f->place, f->surface_list, box_count(f), &n_rock));
    k.n = (uint)(ground_count(f) + n_rock);
    if (k.first + k.n > f->slots)
        return fail(E_NUMERIC, "wind.flow: %u particles of air and %u of rock do not fit into %zu slots",
                    k.first, k.n, f->slots);
    GPU_RUN(gpu, wind_flow_boundary, k.n, k, f->surface_list, f->surface_sums, f->position[0], f->velocity[0],
            f->id[0], f->key, f->density_pressure[0], f->divergence_pressure[0]);
    k.n = (uint)f->slots;
    arrange(gpu, f, k);
    GPU_RUN(gpu, wind_flow_volume, k.n, k, f->start, f->position[0], f->velocity[0], f->position[1]);
    swap(f->position);
    f->report.n_rock = (uint32_t)n_rock;
    TRY(gpu_download(gpu, f->start, cell_count(f), &f->state.n, 1));
    f->report.n_air = f->state.n - (uint32_t)(ground_count(f) + n_rock);
done:
    return st;
}

/* Fills the report: residuals of the solves, largest speed, particles that entered and left. */
static status measure(struct gpu *gpu, struct flow *f)
{
    status st = OK;
    float *of_step = NULL, *velocity = NULL;
    uint32_t lost, before = f->report.n_air;
    TRY(gpu_download(gpu, f->start, cell_count(f), &f->state.n, 1));
    TRY(gpu_download(gpu, f->counts, 0, &lost, 1));
    if (lost)
        return fail(E_NUMERIC,
                    "wind.flow: %u particles of air found no free slot among %zu: the flow has jammed", lost,
                    f->slots);
    TRY(memory_alloc(4 * (size_t)f->state.n, 4, "the air's densities", &of_step));
    TRY(memory_alloc(4 * (size_t)f->state.n, 4, "the air's velocities", &velocity));
    TRY(gpu_download(gpu, f->of_step, 0, of_step, f->state.n));
    TRY(gpu_download(gpu, f->velocity[0], 0, velocity, f->state.n));
    struct flow_report *r = &f->report;
    size_t n = 0;
    for (size_t i = 0; i < f->state.n; i++) {
        const float *v = velocity + 4 * i;
        double density = (double)of_step[4 * i],
               speed = sqrt((double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
        if (!isfinite(speed) || !isfinite(density)) {
            st = fail(E_NUMERIC, "wind.flow: a particle of air has speed %g and density %g", speed, density);
            goto done;
        }
        r->fastest = fmax(r->fastest, speed);
        if (v[3] != FLOW_AIR)
            continue;
        n++;
        r->compression += fmax(density - 1, 0);
        r->error += fabs(density - 1);
        r->divergence += fabs((double)of_step[4 * i + 2]) * FLOW_DT;
    }
    double per = n ? 1 / (double)n : 0;
    r->compression *= per;
    r->error *= per;
    r->divergence *= per;
    r->n_air = f->state.n - r->n_rock - (uint32_t)ground_count(f);
    r->n_out = before + r->n_in - r->n_air;
done:
    free(of_step);
    free(velocity);
    return st;
}

/* Whether the air of the last run can be continued: not if the wind has turned by more than acos 0.95, 18 degrees. */
static bool can_continue(const struct flow_state *s, const double to[2])
{
    return s->steps > 0 && s->direction[0] * to[0] + s->direction[1] * to[1] > 0.95;
}

/* Steps, in blocks, until the average is known to within `settled`. */
static status run_blocks(struct gpu *gpu, struct flow *f, struct particles *p, int most, double settled)
{
    status st = OK;
    const struct flow_params k = flow_params_of(f, p);
    struct flow_report *r = &f->report;
    bool forms = f->state.steps == 0; /* the wake is still forming: the first block's average is dropped */
    gpu_fill(gpu, f->block, 0);
    f->samples = 0;
    r->unsettled = INFINITY;
    while (r->steps < most && !(settled > 0 && r->unsettled <= settled)) {
        const int n = most - r->steps < BLOCK ? most - r->steps : BLOCK;
        for (int i = 1; i <= n; i++) {
            step(gpu, f, k, p);
            if (i % SAMPLE_EVERY == 0 || i == n)
                flow_sample(gpu, f);
        }
        TRY(flow_add_block(gpu, f, n, &r->unsettled));
        r->steps += n;
        /* Weighs at most half of the run, and at least a block, so that older air fades from the average. */
        f->state.weight = forms ? 0 : fmin(f->state.weight, fmax(BLOCK, 0.5 * r->steps));
        forms = false;
    }
done:
    return st;
}

status flow_run(struct gpu *gpu, struct flow *f, struct particles *p, const double direction[2], int most,
                double settled)
{
    status st = OK;
    if (!can_continue(&f->state, direction))
        f->state = (struct flow_state){0};
    memcpy(f->state.direction, direction, sizeof f->state.direction);
    f->state.weight =
        fmin(f->state.weight, BLOCK); /* so that the first block counts as much as the old average */
    struct flow_params k = flow_params_of(f, p);
    f->report = (struct flow_report){0};
    gpu_fill(gpu, f->counts, 0);
    TRY(begin(gpu, f, k, p));
    TRY(run_blocks(gpu, f, p, most, settled));
    k.warm = 1;
    neighbours(gpu, f, k);
    flow_average(gpu, f);
    TRY(measure(gpu, f));
done:
    return st;
}

void flow_restore(struct gpu *gpu, struct flow *f)
{
    flow_average(gpu, f);
}
