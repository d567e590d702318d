#include "wind/flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Half a Courant number of 0.4 against 2.5 times the wind's speed, the most that is expected around a rock. */
static const double dt = 0.2;

enum {
    SAMPLE_EVERY = 4, /* steps between samples of the average */
    FIRST_ITERATIONS =
        40, /* of the divergence solve when air that has not felt the rock yet begins to move */
    SLOTS_MAX = 1 << 24,
    MARGIN = 4 /* spacings of air around the rock's domain, at least */
};
/* How fast air drifts to where there is more room, in wind speeds where half the neighbours are missing, times
 * 0.7. In a wake the particles would else cling together in strings with voids between them; beyond 2.5 the
 * drift overshoots. */
#define DRIFT 2.0f
/* Share of the last step's pressures that the solves begin with, and the density from which air may pull on
 * its neighbours: less than full, it would tear strings out of them. */
#define WARM_DENSITY 0.5f
#define WARM_DIVERGENCE 1.0f
#define FULL 0.8f
static const double spare = 1.25; /* slots, of those that a full box takes */

static size_t box_count(const struct flow *f)
{
    return (size_t)f->box[0] * (size_t)f->box[1] * (size_t)f->box[2];
}

static size_t cell_count(const struct flow *f)
{
    return (size_t)f->cells[0] * (size_t)f->cells[1] * (size_t)f->cells[2];
}

static size_t ground_count(const struct flow *f)
{
    return (size_t)f->box[0] * (size_t)f->box[1];
}

/* ---- sizes */

status flow_layout(const struct job *job, const int voxels[3], struct flow *f)
{
    const struct job_flow *o = &job->wind.flow;
    double h = job->domain.spacing_m, count = 1;
    *f = (struct flow){.spacing = o->spacing_m > 0 ? o->spacing_m : 10 * h,
                       .density_iterations = (int)o->density_iterations,
                       .divergence_iterations = (int)o->divergence_iterations,
                       .viscosity = o->viscosity};
    double box[3];
    for (int a = 0; a < 3; a++) {
        double rock = voxels[a] * h / f->spacing, around = a < 2 ? 2 * MARGIN : MARGIN;
        box[a] = ceil(fmax(o->domain * rock, rock + around));
        count *= box[a];
    }
    double slots = spare * count + box[0] * box[1] + 1024;
    if (!(slots <= SLOTS_MAX))
        return fail(E_USAGE,
                    "wind.flow: %.0f particles of air in a box of %.0f x %.0f x %.0f spacings of %g m, of %d "
                    "at most: raise wind.flow.spacing_m or lower wind.flow.domain",
                    slots, box[0], box[1], box[2], f->spacing, SLOTS_MAX);
    for (int a = 0; a < 3; a++) {
        f->box[a] = (int)box[a];
        f->cells[a] = (f->box[a] + (a == 2) + 1) / 2;
        if (a < 2)
            f->origin[a] = 0.5 * (voxels[a] * h - f->box[a] * f->spacing);
    }
    f->slots = (size_t)slots;
    return OK;
}

static size_t work_size(const struct flow *f)
{
    size_t n = f->slots > box_count(f) ? f->slots : box_count(f);
    return n > cell_count(f) ? n : cell_count(f);
}

uint64_t flow_bytes(const struct flow *f)
{
    uint64_t particle = 2 * (16 + 16 + 4 + 4 + 4) + 3 * 4 + 4 * FLOW_NEIGHBOURS + 4 * 16;
    return f->slots * particle + cell_count(f) * 8 + box_count(f) * (5 * 4 + 8 * 4 + 2 * 16) +
           gpu_work_bytes(work_size(f) + 2);
}

uint64_t flow_state_bytes(const struct flow *f)
{
    return f->slots * (16 + 16 + 4 + 4 + 4) + box_count(f) * (4 + 16);
}

status flow_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct flow *f)
{
    status st = OK;
    TRY(flow_layout(job, voxels, f));
    size_t n = f->slots, cells = cell_count(f), box = box_count(f);
    for (int i = 0; i < 2; i++) {
        TRY(gpu_buffer_create(gpu, "air positions", n, 16, &f->position[i]));
        TRY(gpu_buffer_create(gpu, "air velocities", n, 16, &f->velocity[i]));
        TRY(gpu_buffer_create(gpu, "air density pressures", n, 4, &f->density_pressure[i]));
        TRY(gpu_buffer_create(gpu, "air divergence pressures", n, 4, &f->divergence_pressure[i]));
        TRY(gpu_buffer_create(gpu, "air identities", n, 4, &f->id[i]));
    }
    TRY(gpu_buffer_create(gpu, "air keys", n, 4, &f->key));
    TRY(gpu_buffer_create(gpu, "air order", n, 4, &f->order));
    TRY(gpu_buffer_create(gpu, "air order, unstable", n, 4, &f->unordered));
    TRY(gpu_buffer_create(gpu, "air cells", cells + 2, 4, &f->start));
    TRY(gpu_buffer_create(gpu, "air cell scratch", cells + 1, 4, &f->taken));
    TRY(gpu_buffer_create(gpu, "air neighbours", n * FLOW_NEIGHBOURS, 4, &f->list));
    TRY(gpu_buffer_create(gpu, "air densities", n, 16, &f->of_step));
    TRY(gpu_buffer_create(gpu, "air viscosity", n, 16, &f->viscous));
    TRY(gpu_buffer_create(gpu, "air crowding", n, 16, &f->crowd));
    TRY(gpu_buffer_create(gpu, "air pressure forces", n, 16, &f->push));
    TRY(gpu_buffer_create(gpu, "air surface", box, 4, &f->surface));
    TRY(gpu_buffer_create(gpu, "air surface sums", 8 * box, 4, &f->surface_sums));
    TRY(gpu_buffer_create(gpu, "air surface flags", box, 4, &f->flags));
    TRY(gpu_buffer_create(gpu, "air surface places", box + 1, 4, &f->place));
    TRY(gpu_buffer_create(gpu, "air surface list", box, 4, &f->surface_list));
    TRY(gpu_buffer_create(gpu, "air velocity sums", box, 16, &f->sums));
    TRY(gpu_buffer_create(gpu, "air velocity mean", box, 16, &f->mean));
    TRY(gpu_buffer_create(gpu, "air counts", 4, 4, &f->counts));
    TRY(gpu_work_create(gpu, work_size(f) + 2, &f->work));
done:
    if (st != OK)
        flow_destroy(gpu, f);
    return st;
}

void flow_destroy(struct gpu *gpu, struct flow *f)
{
    for (int i = 0; i < 2; i++) {
        gpu_buffer_destroy(gpu, &f->position[i]);
        gpu_buffer_destroy(gpu, &f->velocity[i]);
        gpu_buffer_destroy(gpu, &f->density_pressure[i]);
        gpu_buffer_destroy(gpu, &f->divergence_pressure[i]);
        gpu_buffer_destroy(gpu, &f->id[i]);
    }
    struct gpu_buffer **rest[] = {&f->key,     &f->order,        &f->unordered, &f->start, &f->taken,
                                  &f->list,    &f->of_step,      &f->viscous,   &f->crowd, &f->push,
                                  &f->surface, &f->surface_sums, &f->flags,     &f->place, &f->surface_list,
                                  &f->sums,    &f->mean,         &f->counts};
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++)
        gpu_buffer_destroy(gpu, rest[i]);
    gpu_work_destroy(gpu, &f->work);
}

/* ---- steps */

static struct flow_params params_of(const struct flow *f, const struct particles *p)
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
        .dt = (float)dt,
        .viscosity = (float)f->viscosity,
        .origin_x = (float)f->origin[0],
        .origin_y = (float)f->origin[1],
        .spacing = (float)f->spacing,
    };
    if (p) {
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

/* Particles into the order of their keys. */
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

/* Iterations of a solve; the velocities take what they find. */
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

/* A column of the lattice, of those inside, that came in with the last move along an axis; the box's size if
 * none did. */
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
        double moved = f->state.direction[a] * dt, to = f->state.offset[a] + moved;
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

static void sample(struct gpu *gpu, struct flow *f, struct flow_params k, double keep)
{
    k.n = (uint)box_count(f);
    k.keep = (float)keep;
    k.gain = (float)(1 - keep);
    GPU_RUN(gpu, wind_flow_average, k.n, k, f->start, f->position[0], f->velocity[0], f->sums);
    f->state.weight = keep * f->state.weight + 1 - keep;
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
    GPU_RUN(gpu, wind_flow_move, f->slots, k, f->start, f->crowd, p->start, f->position[0], f->velocity[0],
            f->key);
    emit(gpu, f, k);
    arrange(gpu, f, k);
    f->state.steps++;
}

/* ---- a run */

status flow_change(struct gpu *gpu, struct flow *f, struct particles *p, double *share)
{
    status st = OK;
    struct flow_params k = params_of(f, p);
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
    return (int)ceil((fabs(direction[0]) * f->box[0] + fabs(direction[1]) * f->box[1]) / dt);
}

/* Air that stays, and the rock as it is now. */
static status begin(struct gpu *gpu, struct flow *f, struct flow_params k, struct particles *p)
{
    status st = OK;
    size_t n_rock;
    if (f->state.steps == 0) {
        k.n = (uint)box_count(f);
        GPU_RUN(gpu, wind_flow_fill, k.n, k, p->start, f->position[0], f->velocity[0], f->id[0]);
        f->state.n = f->state.next_id = k.n;
        k.n = (uint)f->slots;
    }
    k.first = f->state.n;
    GPU_RUN(gpu, wind_flow_begin, k.n, k, f->position[0], f->velocity[0], p->start, f->key);
    gpu_copy(gpu, f->surface, f->flags, box_count(f));
    TRY(gpu_compact(gpu, f->work, f->flags, f->place, f->surface_list, box_count(f), &n_rock));
    k.n = (uint)(ground_count(f) + n_rock);
    if (k.first + k.n > f->slots)
        return fail(E_NUMERIC, "wind.flow: %u particles of air and %u of rock do not fit into %zu places",
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

/* How well the solves did, and how many particles came and went. */
static status measure(struct gpu *gpu, struct flow *f)
{
    status st = OK;
    float *of_step = NULL, *velocity = NULL;
    uint32_t lost, before = f->report.n_air;
    TRY(gpu_download(gpu, f->start, cell_count(f), &f->state.n, 1));
    TRY(gpu_download(gpu, f->counts, 0, &lost, 1));
    if (lost)
        return fail(E_NUMERIC, "wind.flow: %u particles of air found no place in %zu: the flow has jammed",
                    lost, f->slots);
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
        r->divergence += fabs((double)of_step[4 * i + 2]) * dt;
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

static void mean(struct gpu *gpu, struct flow *f)
{
    struct flow_params k = params_of(f, NULL);
    k.n = (uint)box_count(f);
    k.gain = (float)(f->state.weight > 0 ? 1 / f->state.weight : 0);
    GPU_RUN(gpu, wind_flow_mean, k.n, k, f->sums, f->mean);
}

status flow_run(struct gpu *gpu, struct flow *f, struct particles *p, const double direction[2], int steps)
{
    status st = OK;
    double keep = exp(-SAMPLE_EVERY / (0.5 * flow_flush(f, direction)));
    memcpy(f->state.direction, direction, sizeof f->state.direction);
    struct flow_params k = params_of(f, p);
    f->report = (struct flow_report){.steps = steps};
    gpu_fill(gpu, f->counts, 0);
    TRY(begin(gpu, f, k, p));
    for (int i = 0; i < steps; i++) {
        step(gpu, f, k, p);
        if ((i + 1) % SAMPLE_EVERY == 0 || i + 1 == steps)
            sample(gpu, f, k, keep);
    }
    k.warm = 1;
    neighbours(gpu, f, k);
    mean(gpu, f);
    TRY(measure(gpu, f));
done:
    return st;
}

/* ---- state */

void flow_arrays(const struct flow *f, struct flow_array out[FLOW_ARRAYS])
{
    const struct flow_array arrays[FLOW_ARRAYS] = {
        {"air position", f->position[0], f->state.n},
        {"air velocity", f->velocity[0], f->state.n},
        {"air density pressure", f->density_pressure[0], f->state.n},
        {"air divergence pressure", f->divergence_pressure[0], f->state.n},
        {"air id", f->id[0], f->state.n},
        {"air surface", f->surface, box_count(f)},
        {"air sums", f->sums, box_count(f)},
    };
    memcpy(out, arrays, sizeof arrays);
}

status flow_check(const struct flow *f)
{
    const struct flow_state *s = &f->state;
    double length = hypot(s->direction[0], s->direction[1]);
    bool fits = s->n <= f->slots && s->next_id < FLOW_GROUND_ID && s->weight >= 0 && s->weight <= 1;
    for (int a = 0; a < 2; a++)
        fits = fits && s->offset[a] >= 0 && s->offset[a] <= 1;
    if (!fits || !(s->steps == 0 || fabs(length - 1) < 1e-6))
        return fail(E_CHECKPOINT, "the checkpoint's air (%u particles) does not fit this job's (%zu at most)",
                    (unsigned)s->n, f->slots);
    return OK;
}

void flow_restore(struct gpu *gpu, struct flow *f)
{
    mean(gpu, f);
}
