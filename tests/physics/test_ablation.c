/* What each process is for: the shapes that are missing when it is (Arenite figs. 14, 15). */
#include "field/field.h"
#include "model_help.h"
#include "shape.h"

#include <string.h>

static const char *job_path(const char *name)
{
    static char path[4096];
    const char *top = getenv("HOODOO_TOP");
    snprintf(path, sizeof path, "%s/jobs/%s.yaml", top ? top : ".", name);
    return path;
}

/* The shape after the job's frames, or the first in which no more than `until` of the rock is left. */
static struct shape erode(const char *name, const char *const *sets, size_t n_sets, double until,
                          double *left)
{
    struct sim s = sim_open(job_path(name), sets, n_sets);
    for (;;) {
        struct frame frame = sim_output(&s);
        int number = frame.number;
        *left = frame.volume_m3 / frame.start_volume_m3;
        if (number >= s.job->frames.last || *left <= until) {
            struct shape shape = shape_inside(&frame.grids, FIELD_MARGIN);
            frame_free(&frame);
            sim_end(&s);
            return shape;
        }
        frame_free(&frame);
        assert_ok(s.type->step(s.model));
    }
}

/* The share of the rock that has none across the middle of the domain along an axis. */
static double asymmetry(const struct shape *s, int axis)
{
    size_t rock = 0, lone = 0;
    for (int k = 0; k < s->n[2]; k++)
        for (int j = 0; j < s->n[1]; j++)
            for (int i = 0; i < s->n[0]; i++) {
                int c[3] = {i, j, k};
                c[axis] = s->n[axis] - 1 - c[axis];
                size_t own = ((size_t)k * (size_t)s->n[1] + (size_t)j) * (size_t)s->n[0] + (size_t)i;
                size_t other =
                    ((size_t)c[2] * (size_t)s->n[1] + (size_t)c[1]) * (size_t)s->n[0] + (size_t)c[0];
                rock += s->rock[own];
                lone += s->rock[own] && !s->rock[other];
            }
    return (double)lone / (double)rock;
}

/* ---- fig. 15: what abrasion and deflation do to an arch */

struct arch {
    double left, window, across, along; /* asymmetries in y and x */
};

static struct arch arch(const char *what, const char *abrasion, const char *deflation)
{
    const char *const sets[] = {"domain.spacing_m=1", "output.aov.cameras=[]", "noise.amplitude=0", abrasion,
                                deflation};
    struct arch out;
    struct shape shape = erode("demo", sets, sizeof sets / sizeof *sets, 0.65, &out.left);
    out.window = shape_window(&shape, 6); /* above the supports */
    out.along = asymmetry(&shape, 0);
    out.across = asymmetry(&shape, 1);
    shape_free(&shape);
    print_message(
        "# %s: %.0f %% left, a window of %.0f m2, %.1f %% of the rock without its mirror image along "
        "the arch, %.1f %% across\n",
        what, 100 * out.left, out.window, 100 * out.along, 100 * out.across);
    return out;
}

static void an_arch_needs_deflation_and_leans_with_abrasion(void **state)
{
    struct arch abrasion = arch("abrasion only", "wind.abrasion=5", "wind.deflation.intensity=0");
    struct arch deflation = arch("deflation only", "wind.abrasion=0", "wind.deflation.intensity=1");
    struct arch both = arch("both", "wind.abrasion=0.55", "wind.deflation.intensity=1");
    (void)state;
    assert_true(abrasion.window < 0.1 * deflation.window && abrasion.window < 0.1 * both.window);
    assert_true(deflation.along < 0.01 && deflation.across < 0.01);
    assert_true(both.along > 0.01 && both.along > 3 * deflation.along);
    assert_true(both.across > 0.03 && both.across > 3 * deflation.across);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_arch_needs_deflation_and_leans_with_abrasion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
