/* How far T of a run's frames is from that of the same shapes solved tightly. */
#ifndef HOODOO_TESTS_STRESS_HELP_H
#define HOODOO_TESTS_STRESS_HELP_H

#include "model_help.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/arenite.h"

enum { STRESS_TIMES_MAX = 256 };

struct stress_errors {
    double error[STRESS_TIMES_MAX]; /* the 95th percentile of T's error by that of T, for each solution */
    int n, beyond;                  /* solutions; those whose error is beyond the tolerance */
    int iterations, tight;          /* in all, and to the tight solutions */
};

static inline int stress_ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline float *stress_of(struct arenite *a)
{
    float *t = malloc((a->particles.n + 1) * sizeof *t);
    assert_non_null(t);
    assert_ok(gpu_download(a->m.gpu, a->particles.field[ROCK_stress], 0, t, a->particles.n));
    return t;
}

static inline double stress_p95(const float *t, const float *other, size_t n)
{
    double *x = malloc((n + 1) * sizeof *x);
    assert_non_null(x);
    for (size_t i = 0; i < n; i++)
        x[i] = fabs((double)t[i] - (other ? (double)other[i] : 0));
    qsort(x, n, sizeof *x, stress_ascending);
    double p95 = x[n * 95 / 100];
    free(x);
    return p95;
}

static inline void stress_solve(struct arenite *a)
{
    assert_ok(elastic_solve(a->m.gpu, a->m.work, &a->elastic));
    elastic_recover(a->m.gpu, &a->elastic, &a->particles);
}

/* The error of the displacement that e has now. It stays as it is. */
static inline void stress_compare(struct arenite *a, const char *what, struct stress_errors *errors)
{
    struct elastic *e = &a->elastic;
    const double tolerance = e->options.tolerance, estimate = e->error;
    const int iterations = e->iterations;
    float *u = malloc((e->lattice.n_active + 1) * 16), *t = stress_of(a);
    assert_non_null(u);
    assert_ok(elastic_download(a->m.gpu, e, u));
    e->options.tolerance = 2e-5;
    e->options.max_iterations = 100;
    stress_solve(a);
    float *tight = stress_of(a);
    double error = stress_p95(t, tight, a->particles.n) / stress_p95(tight, NULL, a->particles.n);
    print_message("# %s: %d iterations, estimated error %.2g, true %.2g; %d to %.1g\n", what, iterations,
                  estimate, error, e->iterations, e->error);
    assert_true(errors->n < STRESS_TIMES_MAX);
    errors->error[errors->n++] = error;
    errors->beyond += error > tolerance;
    errors->iterations += iterations;
    errors->tight += e->iterations;
    assert_ok(elastic_upload(a->m.gpu, e, u));
    e->options = elastic_options(a->m.job, a->maps.stiff);
    elastic_recover(a->m.gpu, e, &a->particles);
    free(u);
    free(t);
    free(tight);
}

/* Some frames of a job, each as the run solves it and, every `cold` frames, from nothing. */
static inline void stress_errors_of(const char *path, const char *const *sets, size_t n_sets, int frames,
                                    int cold, struct stress_errors *errors)
{
    struct sim s = sim_open(path, sets, n_sets);
    struct arenite *a = arenite_of(s.model);
    for (int f = 0; f < frames; f++) {
        if (f)
            assert_ok(model_step(s.model));
        stress_compare(a, f ? "warm" : "cold", errors);
        if (f && cold && f % cold == 0) {
            float *u = malloc((a->elastic.lattice.n_active + 1) * 16);
            assert_non_null(u);
            assert_ok(elastic_download(s.gpu, &a->elastic, u));
            gpu_fill(s.gpu, a->elastic.u, 0);
            stress_solve(a);
            stress_compare(a, "cold", errors);
            assert_ok(elastic_upload(s.gpu, &a->elastic, u));
            elastic_recover(s.gpu, &a->elastic, &a->particles);
            free(u);
        }
    }
    sim_end(&s);
}

#endif
