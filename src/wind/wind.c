#include "wind/wind.h"

#include <math.h>

#include "base/log.h"

struct wind_at wind_at(const struct job *job, int frame)
{
    const double *d = job->wind.direction, pi = 3.14159265358979323846;
    double turn = curve_at(&job->wind.turn_deg, frame) * pi / 180, c = cos(turn), s = sin(turn);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    struct wind_at w = {{d[0] / length, d[1] / length, d[2] / length}, curve_at(&job->wind.speed_m_s, frame)};
    if (turn != 0) {
        double x = w.direction[0], y = w.direction[1];
        w.direction[0] = c * x - s * y;
        w.direction[1] = s * x + c * y;
    }
    for (size_t i = 0; i < job->wind.n_gusts; i++)
        if (range_holds(job->wind.gusts[i].frames, frame))
            w.speed *= job->wind.gusts[i].factor;
    return w;
}

/* |v| / v_ref. */
static double gale(const struct job *job, int frame)
{
    return wind_at(job, frame).speed / job->wind.reference_m_s;
}

static double abrasion(const struct job *job, int frame)
{
    double ratio = gale(job, frame);
    return curve_at(&job->wind.abrasion, frame) * ratio * ratio;
}

double wind_fastest(const struct job *job, int frame)
{
    double fastest = 0;
    for (size_t i = 0; i < job->n_strata; i++) {
        const struct job_layer *l = &job->strata[i];
        const double plucked = curve_at(&l->deflation, frame), rubbed = curve_at(&l->abrasion, frame);
        const double all = (plucked < 0 ? curve_at(&job->wind.deflation.intensity, frame) : plucked) +
                           (rubbed < 0 ? abrasion(job, frame) : rubbed * pow(gale(job, frame), 2));
        fastest = fmax(fastest, job_weak(job, i, frame) * all);
    }
    return fastest;
}

/* ---- the flow */

bool wind_flows(const struct job *job)
{
    return job->wind.flow.solver == FLOW_SPH;
}

status wind_check(const struct job *job, const int voxels[3])
{
    struct flow layout;
    return wind_flows(job) ? flow_layout(job, voxels, &layout) : OK;
}

uint64_t wind_bytes(const struct job *job, const int voxels[3])
{
    struct flow layout;
    return wind_flows(job) && flow_layout(job, voxels, &layout) == OK ? flow_bytes(&layout) : 0;
}

uint64_t wind_checkpoint_bytes(const struct job *job, const int voxels[3])
{
    struct flow layout;
    return wind_flows(job) && flow_layout(job, voxels, &layout) == OK ? flow_state_bytes(&layout) : 0;
}

status wind_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct wind *w)
{
    *w = (struct wind){.flows = wind_flows(job)};
    return w->flows ? flow_create(gpu, job, voxels, &w->flow) : OK;
}

void wind_destroy(struct gpu *gpu, struct wind *w)
{
    if (w->flows)
        flow_destroy(gpu, &w->flow);
    *w = (struct wind){0};
}

/* Whether rock or direction have changed enough for another run. */
static bool is_due(const struct flow *f, const struct job_flow *o, const double direction[2], double change)
{
    const double *last = f->state.direction;
    double turned = fabs(atan2(last[0] * direction[1] - last[1] * direction[0],
                               last[0] * direction[0] + last[1] * direction[1]));
    return f->state.steps == 0 || change > o->rock_change || turned > o->wind_change;
}

status wind_update(struct gpu *gpu, struct wind *w, const struct job *job, int frame, struct particles *p)
{
    status st = OK;
    struct wind_at at = wind_at(job, frame);
    double flat = hypot(at.direction[0], at.direction[1]), change;
    const double direction[2] = {at.direction[0] / flat, at.direction[1] / flat};
    const struct job_flow *o = &job->wind.flow;
    if (!w->flows || at.speed == 0 || p->n == 0)
        return OK;
    TRY(flow_change(gpu, &w->flow, p, &change));
    if (!is_due(&w->flow, o, direction, change))
        return OK;
    int most = (int)ceil(o->flushes * flow_flush(&w->flow, direction));
    TRY(flow_run(gpu, &w->flow, p, direction, most, o->settled));
    const struct flow_report *r = &w->flow.report;
    log_note(
        "frame %d: wind: %d steps with %u particles of air around %u of rock (%.1f %% of them new), average settled to %.2g, mean density error %.2g (compression %.2g), divergence %.2g, fastest %.2f wind speeds",
        frame, r->steps, (unsigned)r->n_air, (unsigned)r->n_rock, 100 * change, r->unsettled, r->error,
        r->compression, r->divergence, r->fastest);
done:
    return st;
}

bool wind_lattice(const struct wind *w, const struct job *job, int frame, struct wind_lattice *out)
{
    const struct flow *f = &w->flow;
    if (!w->flows || f->state.steps == 0)
        return false;
    *out = (struct wind_lattice){.velocity = f->mean,
                                 .n = {f->box[0], f->box[1], f->box[2]},
                                 .origin = {f->origin[0], f->origin[1], 0},
                                 .cell = f->spacing,
                                 .speed = wind_at(job, frame).speed};
    return true;
}

/* ---- erosion */

void wind_erode(struct gpu *gpu, const struct wind *w, const struct job *job, int frame, struct particles *p,
                struct gpu_buffer *layers, struct gpu_buffer *intensity, struct gpu_buffer *parts)
{
    const struct job_deflation *d = &job->wind.deflation;
    struct wind_at wind = wind_at(job, frame);
    struct wind_params k = {
        .n = (uint)p->n_surface,
        .nx = (uint)p->voxels[0],
        .ny = (uint)p->voxels[1],
        .nz = (uint)p->voxels[2],
        .h = (float)p->h,
        .deflation = (float)curve_at(&d->intensity, frame),
        .cohesion = (float)(1e6 * d->cohesion_MPa),
        .friction = (float)d->friction,
        .strength = (float)(1e6 * d->strength_MPa),
        .abrasion = (float)abrasion(job, frame),
        .gale = (float)pow(gale(job, frame), 2),
        .wind_x = (float)wind.direction[0],
        .wind_y = (float)wind.direction[1],
        .wind_z = (float)wind.direction[2],
        .shelter = (float)job->wind.shelter_m,
        .walls = p->walls,
    };
    struct wind_lattice air;
    if (!wind_lattice(w, job, frame, &air)) {
        GPU_RUN(gpu, wind_erode, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N],
                p->field[ROCK_stress], p->held.words, p->field[ROCK_layer], layers, intensity, parts);
        return;
    }
    k.shelter = (float)job->wind.flow.reach_m;
    k.cell = (float)air.cell;
    k.bx = (uint)air.n[0];
    k.by = (uint)air.n[1];
    k.bz = (uint)air.n[2];
    k.origin_x = (float)air.origin[0];
    k.origin_y = (float)air.origin[1];
    GPU_RUN(gpu, wind_strike, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N],
            p->field[ROCK_stress], p->held.words, air.velocity, p->field[ROCK_layer], layers, intensity,
            parts);
}
