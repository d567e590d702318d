#include "shape/function.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "shape/function_make.h"
#include "shape/noise.h"
#include "system/library.h"

enum { POSITIONS = 1 << 15 };

struct function {
    const struct job_function *job;
    struct noise noise;
    struct formula *formula;
    formula_at_function *at;
    formula_destroy_function *destroy;
    double steepest;
};

static double call_noise(const void *noise, const double x[3])
{
    return noise_at(noise, x);
}

/* The length of the gradient at x, by differences over `step`. */
static double slope_at(const struct function *f, const double x[3], double step)
{
    const double here = f->at(f->formula, x);
    double square = 0;
    for (int a = 0; a < 3; a++) {
        double there[3] = {x[0], x[1], x[2]};
        there[a] += step;
        const double slope = (f->at(f->formula, there) - here) / step;
        square += slope * slope;
    }
    return isfinite(square) ? sqrt(square) : 0;
}

/* Estimates the steepest slope from many positions, and checks that the expression has a value at any of them. */
static status estimate_steepest(struct function *f, double step)
{
    const double *lo = f->job->min_m, *hi = f->job->max_m;
    double steepest = 0;
    size_t numbers = 0;
#pragma omp parallel for reduction(max : steepest) reduction(+ : numbers)
    for (uint32_t i = 0; i < POSITIONS; i++) {
        double x[3];
        for (uint32_t a = 0; a < 3; a++)
            x[a] = lo[a] + (hi[a] - lo[a]) * (double)random_float(random_hash(i, a, 0, RANDOM_ESTIMATE));
        numbers += isfinite(f->at(f->formula, x)) ? 1 : 0;
        steepest = fmax(steepest, fmax(slope_at(f, x, step), slope_at(f, x, step / 8)));
    }
    if (numbers == 0)
        return fail(
            E_USAGE,
            "scene: function: expression \"%.300s\" has no finite value anywhere in its box: check min_m, max_m and the expression",
            f->job->expression);
    if (f->job->steepest > 0 && steepest > f->job->steepest * (1 + 1e-6))
        return fail(
            E_USAGE,
            "scene: function: the value of \"%.300s\" rises by %.4g per metre in its box, more than function.steepest, %.4g: raise or omit steepest",
            f->job->expression, steepest, f->job->steepest);
    f->steepest = f->job->steepest > 0 ? f->job->steepest : fmax(2 * steepest, 1e-6);
    return OK;
}

status function_create(const struct job_function *job, double step, struct function **out)
{
    status st = OK;
    struct function *f = NULL;
    formula_make_function *make = NULL;
    const struct job_noise noise = {.scale_m = 1, .octaves = job->octaves, .flatten = 1};
    TRY(memory_alloc(1, sizeof *f, "a function", &f));
    f->job = job;
    f->noise = noise_init(&noise, random_hash((uint32_t)job->seed, 0, 0, RANDOM_FUNCTION));
    TRY(library_find("formula_make", &make));
    TRY(library_find("formula_at", &f->at));
    TRY(library_find("formula_destroy", &f->destroy));
    TRY(library_status(make(job->expression, call_noise, &f->noise, &f->formula)));
    TRY(estimate_steepest(f, step));
    *out = f;
    f = NULL;
done:
    function_destroy(&f);
    return st;
}

void function_destroy(struct function **function)
{
    struct function *f = *function;
    if (!f)
        return;
    if (f->formula)
        f->destroy(&f->formula);
    free(f);
    *function = NULL;
}

double function_distance(const struct function *f, const double x[3])
{
    double outside = 0, inside = -INFINITY;
    for (int a = 0; a < 3; a++) {
        const double d = fmax(f->job->min_m[a] - x[a], x[a] - f->job->max_m[a]);
        inside = fmax(inside, d);
        outside += d > 0 ? d * d : 0;
    }
    if (inside > 0) /* the expression only counts within the box */
        return sqrt(outside);
    const double value = f->at(f->formula, x);
    return isnan(value) ? DBL_MIN : fmax(inside, value / f->steepest);
}
