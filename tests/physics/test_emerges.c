/* The demo at half its resolution: an arch emerges and stands, because its rock interlocks; and nothing pops. */
#include "effort.h"
#include "field/field.h"
#include "model_help.h"
#include "shape.h"

#include <string.h>

enum { FRAMES_MAX = 512, LAYERS_MAX = 16, SETS_MAX = LAYERS_MAX + 4 };
static const double supports =
    6; /* m: the top of the demo's supports, between which it is open from the start */

struct history {
    int n_frames;
    double volume[FRAMES_MAX];   /* m3 */
    double start_window, window; /* m2: the sky seen through the rock */
    int parts, spans;
    size_t n_largest, n_all; /* voxels */
};

static const char *demo(void)
{
    static char path[4096];
    const char *top = getenv("HOODOO_TOP");
    snprintf(path, sizeof path, "%s/jobs/demo.yaml", top ? top : ".");
    return path;
}

static void look(struct sim *s, struct history *out)
{
    struct frame frame = sim_output(s);
    struct shape shape = shape_inside(&frame.grids, FIELD_MARGIN);
    assert_true(out->n_frames < FRAMES_MAX);
    out->volume[out->n_frames] = frame.volume_m3;
    out->window = shape_window(&shape, supports);
    if (out->n_frames == 0)
        out->start_window = out->window;
    out->parts = shape_parts(&shape, &out->n_largest, &out->n_all);
    out->spans = shape_spans(&shape);
    out->n_frames++;
    shape_free(&shape);
    frame_free(&frame);
}

/* interlock_MPa 0: the demo as it is, looked at in every frame. Else with this threshold in all layers and without the air,
 * which takes most of the time, looked at in its first frame and its last. */
static struct history erode(double interlock_MPa)
{
    struct history out = {0};
    char set[LAYERS_MAX][64];
    const char *sets[SETS_MAX] = {"domain.spacing_m=1", "output.aov.cameras=[]"};
    size_t n_sets = 2;
    if (interlock_MPa > 0) {
        sets[n_sets++] = "wind.flow.solver=uniform";
        sets[n_sets++] = "wind.abrasion=0.55";
    }
    struct job *job = NULL;
    struct sim s = {0};
    assert_ok(job_load(demo(), NULL, 0, &job));
    assert_true(job->n_strata <= LAYERS_MAX);
    for (size_t i = 0; interlock_MPa > 0 && i < job->n_strata; i++) {
        snprintf(set[i], sizeof set[i], "strata.%zu.interlock_MPa=%g", i, interlock_MPa);
        sets[n_sets++] = set[i];
    }
    job_destroy(&job);
    s = sim_open(demo(), sets, n_sets);
    const int first = s.job->frames.first, last = s.job->frames.last;
    for (int f = first; f <= last; f++) {
        if (f > first)
            assert_ok(model_step(s.model));
        if (interlock_MPa <= 0 || f == first || f == last)
            look(&s, &out);
    }
    sim_end(&s);
    print_message(
        "# I = %g MPa: %.1f %% of the rock left after %d frames, in %d parts%s, a window of %.0f m2\n",
        interlock_MPa > 0 ? interlock_MPa : NAN, 100 * out.volume[out.n_frames - 1] / out.volume[0],
        last - first, out.parts, out.spans ? ", which span from side to side" : "", out.window);
    return out;
}

static double left(const struct history *h)
{
    return h->volume[h->n_frames - 1] / h->volume[0];
}

static void an_arch_emerges_and_stands(void **state)
{
    struct history h = erode(0);
    (void)state;
    assert_true(h.start_window == 0);
    assert_true(h.window >= 50); /* m2 */
    assert_true(h.spans);
    assert_true((double)h.n_largest >= 0.995 * (double)h.n_all);
    assert_true(left(&h) >= 0.25 && left(&h) <= 0.75);

    /* Nothing pops: in the middle of the run the loss changes by less than a tenth from frame to frame. */
    double worst = 0;
    for (int f = h.n_frames / 4; f < h.n_frames * 3 / 4; f++) {
        double before = h.volume[f - 1] - h.volume[f], after = h.volume[f] - h.volume[f + 1];
        worst = fmax(worst, fabs(after - before) / before);
    }
    print_message("# the loss of volume changes by at most %.1f %% from frame to frame\n", 100 * worst);
    assert_true(worst < 0.1);
}

/* The demo's own frames, at other thresholds; the last stands for rock that never interlocks. With more effort, at some between. */
static void what_interlocks_stands(void **state)
{
    static const double I[] = {0.3, 0.7, 1.0, 1.5, 1e9};
    enum { N = sizeof I / sizeof *I };
    double before = 1;
    (void)state;
    for (size_t i = 0; i<N; i += effort()> 1 ? 1 : 2) {
        struct history h = erode(I[i]);
        assert_true(left(&h) < before);
        before = left(&h);
        if (I[i] < 1)
            assert_true(h.spans);
        if (i == N - 1) /* its legs are cut through, and what they held has fallen */
            assert_true(!h.spans && left(&h) < 0.25);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_arch_emerges_and_stands),
        cmocka_unit_test(what_interlocks_stands),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
