/* The stop of the stress solver tells the truth: over the shipped jobs at three spacings, warm and cold, the 95th
 * percentile of T's error is within the tolerance in 95 % of the solutions. */
#include "check.h"

#include <stdio.h>

#include "tests/physics/stress_help.h"

static void of_jobs(const char *const *jobs, size_t n_jobs, int frames)
{
    struct stress_errors errors = {0};
    for (size_t i = 0; i < n_jobs; i += 2) {
        char path[512], spacing[64];
        const char *top = getenv("HOODOO_TOP");
        snprintf(path, sizeof path, "%s/jobs/%s.yaml", top ? top : ".", jobs[i]);
        snprintf(spacing, sizeof spacing, "domain.spacing_m=%s", jobs[i + 1]);
        const char *const sets[] = {spacing, "wind.flow.solver=uniform"};
        print_message("# %s at %s m\n", jobs[i], jobs[i + 1]);
        stress_errors_of(path, sets, 2, frames, 4, &errors);
    }
    qsort(errors.error, (size_t)errors.n, sizeof *errors.error, stress_ascending);
    print_message(
        "# %d solutions, %d iterations: the median error is %.2g, the 95th %.2g, the largest %.2g\n",
        errors.n, errors.iterations, errors.error[errors.n / 2], errors.error[errors.n * 95 / 100],
        errors.error[errors.n - 1]);
    assert_true(errors.beyond * 20 <= errors.n);
}

static void of_coarse_jobs(void **state)
{
    static const char *const jobs[] = {"demo", "1", "butte", "4", "canyon", "4"};
    (void)state;
    of_jobs(jobs, sizeof jobs / sizeof *jobs, 9);
}

static void of_jobs_at_half(void **state)
{
    static const char *const jobs[] = {"demo", "0.5", "butte", "2", "canyon", "2"};
    (void)state;
    of_jobs(jobs, sizeof jobs / sizeof *jobs, 9);
}

static void of_jobs_at_a_quarter(void **state)
{
    static const char *const jobs[] = {"demo", "0.25", "butte", "1", "canyon", "1"};
    (void)state;
    of_jobs(jobs, sizeof jobs / sizeof *jobs, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_coarse_jobs),
        cmocka_unit_test(of_jobs_at_half),
        cmocka_unit_test(of_jobs_at_a_quarter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
