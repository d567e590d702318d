#include "wind/wind.h"

#include <math.h>

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

static double abrasion(const struct job *job, int frame)
{
    double ratio = wind_at(job, frame).speed / job->wind.reference_m_s;
    return curve_at(&job->wind.abrasion, frame) * ratio * ratio;
}

double wind_intensity(const struct job *job, int frame)
{
    return curve_at(&job->wind.deflation.intensity, frame) + abrasion(job, frame);
}

void wind_erode(struct gpu *gpu, const struct job *job, int frame, struct particles *p,
                struct gpu_buffer *intensity)
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
        .wind_x = (float)wind.direction[0],
        .wind_y = (float)wind.direction[1],
        .wind_z = (float)wind.direction[2],
        .shelter = (float)job->wind.shelter_m,
    };
    GPU_RUN(gpu, wind_erode, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N],
            p->field[ROCK_stress], p->start, intensity);
}
