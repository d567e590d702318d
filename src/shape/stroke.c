#include "shape/stroke.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Segments per bounding box: boxes are tested before segments, so that long strokes cost little more than short ones. */
enum { RUN = 16 };

struct box {
    double min[3], max[3];
};

struct stroke {
    size_t n, n_runs;
    double radius;
    double (*point)[3];
    struct box *run;
};

status stroke_create(const struct job_stroke *job, struct stroke **out)
{
    status st = OK;
    struct stroke *s = NULL;
    if (job->n_path_m == 0)
        return fail(E_USAGE, "scene: a stroke has no points: set its path_m to at least one");
    TRY(memory_alloc(1, sizeof *s, "a stroke", &s));
    s->n = job->n_path_m;
    s->radius = job->radius_m;
    s->n_runs = (s->n + RUN - 1) / RUN;
    TRY(memory_alloc(s->n, sizeof *s->point, "a stroke", &s->point));
    TRY(memory_alloc(s->n_runs, sizeof *s->run, "a stroke", &s->run));
    memcpy(s->point, job->path_m, s->n * sizeof *s->point);
    for (size_t r = 0; r < s->n_runs; r++) {
        struct box *b = &s->run[r];
        for (int a = 0; a < 3; a++) {
            b->min[a] = INFINITY;
            b->max[a] = -INFINITY;
            /* The last segment of a run ends at the first point of the next. */
            for (size_t i = r * RUN; i <= (r + 1) * RUN && i < s->n; i++) {
                b->min[a] = fmin(b->min[a], s->point[i][a]);
                b->max[a] = fmax(b->max[a], s->point[i][a]);
            }
        }
    }
    *out = s;
    s = NULL;
done:
    stroke_destroy(&s);
    return st;
}

void stroke_destroy(struct stroke **stroke)
{
    if (!*stroke)
        return;
    free((*stroke)->point);
    free((*stroke)->run);
    free(*stroke);
    *stroke = NULL;
}

void stroke_bounds(const struct stroke *s, double min[3], double max[3])
{
    for (int a = 0; a < 3; a++) {
        min[a] = INFINITY;
        max[a] = -INFINITY;
        for (size_t r = 0; r < s->n_runs; r++) {
            min[a] = fmin(min[a], s->run[r].min[a] - s->radius);
            max[a] = fmax(max[a], s->run[r].max[a] + s->radius);
        }
    }
}

static double square_to_box(const struct box *b, const double x[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        double d = fmax(b->min[a] - x[a], x[a] - b->max[a]);
        square += d > 0 ? d * d : 0;
    }
    return square;
}

static double square_to_segment(const double p[3], const double q[3], const double x[3])
{
    double length = 0, along = 0, square = 0;
    for (int a = 0; a < 3; a++) {
        length += (q[a] - p[a]) * (q[a] - p[a]);
        along += (x[a] - p[a]) * (q[a] - p[a]);
    }
    double t = length > 0 ? fmin(fmax(along / length, 0), 1) : 0;
    for (int a = 0; a < 3; a++) {
        double d = x[a] - p[a] - t * (q[a] - p[a]);
        square += d * d;
    }
    return square;
}

double stroke_distance(const struct stroke *s, const double x[3])
{
    double best = INFINITY;
    for (size_t r = 0; r < s->n_runs; r++) {
        if (square_to_box(&s->run[r], x) >= best)
            continue;
        for (size_t i = r * RUN; i < (r + 1) * RUN && i < s->n; i++)
            best = fmin(best, square_to_segment(s->point[i], s->point[i + 1 < s->n ? i + 1 : i], x));
    }
    return sqrt(best) - s->radius;
}
