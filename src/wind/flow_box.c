/* The air's box, memory and state; flow.c steps it. */
#include "wind/flow_parts.h"

#include <math.h>
#include <string.h>

enum {
    SLOTS_MAX = 1 << 24,
    MARGIN = 4 /* least spacings of air around the rock's domain */
};
static const double spare = 1.25; /* slots over the particles of a full box */

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
        return fail(
            E_USAGE,
            "wind.flow: %.0f particles of air in a box of %.0f x %.0f x %.0f spacings of %g m, but at most %d are possible: raise wind.flow.spacing_m or lower wind.flow.domain",
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
    return f->slots * particle + cell_count(f) * 8 + box_count(f) * (5 * 4 + 8 * 4 + 3 * 16) +
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
    TRY(gpu_buffer_create(gpu, "air neighbours", (n + 31) / 32 * 32 * FLOW_NEIGHBOURS, 4, &f->list));
    TRY(gpu_buffer_create(gpu, "air densities", n, 16, &f->of_step));
    TRY(gpu_buffer_create(gpu, "air viscosity", n, 16, &f->viscous));
    TRY(gpu_buffer_create(gpu, "air crowding", n, 16, &f->crowd));
    TRY(gpu_buffer_create(gpu, "air pressure forces", n, 16, &f->push));
    TRY(gpu_buffer_create(gpu, "air surface", box, 4, &f->surface));
    TRY(gpu_buffer_create(gpu, "air surface sums", 8 * box, 4, &f->surface_sums));
    TRY(gpu_buffer_create(gpu, "air surface flags", box, 4, &f->flags));
    TRY(gpu_buffer_create(gpu, "air surface places", box + 1, 4, &f->place));
    TRY(gpu_buffer_create(gpu, "air surface list", box, 4, &f->surface_list));
    TRY(gpu_buffer_create(gpu, "air velocity average", box, 16, &f->sums));
    TRY(gpu_buffer_create(gpu, "air velocity sums", box, 16, &f->block));
    TRY(gpu_buffer_create(gpu, "air squares", 2, 4, &f->squares));
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
                                  &f->sums,    &f->block,        &f->squares,   &f->mean,  &f->counts};
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++)
        gpu_buffer_destroy(gpu, rest[i]);
    gpu_work_destroy(gpu, &f->work);
}

/* ---- state */

void flow_arrays(const struct flow *f, struct flow_array out[FLOW_ARRAYS])
{
    const double speed = 1e3, pressure = 1e9, most = UINT32_MAX;
    const size_t n = f->state.n, box = box_count(f);
#define BESIDE(a)                                                                                            \
    {                                                                                                        \
        -MARGIN, f->box[a] + MARGIN                                                                          \
    }
#define ALIKE(x)                                                                                             \
    {                                                                                                        \
        -(x), (x)                                                                                            \
    }
    const struct flow_array arrays[FLOW_ARRAYS] = {
        {"air position", f->position[0], n, false, {BESIDE(0), BESIDE(1), BESIDE(2), ALIKE(speed)}},
        {"air velocity",
         f->velocity[0],
         n,
         false,
         {ALIKE(speed), ALIKE(speed), ALIKE(speed), {(double)FLOW_AIR, (double)FLOW_GROUND}}},
        {"air density pressure", f->density_pressure[0], n, false, {ALIKE(pressure)}},
        {"air divergence pressure", f->divergence_pressure[0], n, false, {ALIKE(pressure)}},
        {"air id", f->id[0], n, true, {{0, most}}},
        {"air surface", f->surface, box, true, {{0, 1}}},
        {"air sums", f->sums, box, false, {ALIKE(speed), ALIKE(speed), ALIKE(speed), ALIKE(speed)}},
    };
    memcpy(out, arrays, sizeof arrays);
}

status flow_check(const struct flow *f)
{
    const struct flow_state *s = &f->state;
    double length = hypot(s->direction[0], s->direction[1]);
    bool fits = s->n <= f->slots && s->next_id < FLOW_GROUND_ID && s->weight >= 0 && s->weight <= 1e6;
    for (int a = 0; a < 2; a++)
        fits = fits && s->offset[a] >= 0 && s->offset[a] <= 1;
    if (!fits || !(s->steps == 0 ? length < 2 : fabs(length - 1) < 1e-6))
        return fail(E_CHECKPOINT,
                    "the checkpoint's air (%u particles) does not fit this job's box (%zu at most)",
                    (unsigned)s->n, f->slots);
    return OK;
}
