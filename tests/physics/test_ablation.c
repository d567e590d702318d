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
        assert_ok(model_step(s.model));
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
    const char *const sets[] = {"domain.spacing_m=1",
                                "output.aov.cameras=[]",
                                "noise.amplitude=0",
                                "wind.flow.solver=uniform",
                                abrasion,
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

/* ---- fig. 14: what water and wind do to hoodoos */

/* A layered block whose top has two furrows. */
static const char hoodoos[] = "hoodoo: 1\n"
                              "name: hoodoos\n"
                              "frames: 1001-1033\n"
                              "clock: {years_per_frame: 500}\n"
                              "seed: 3\n"
                              "domain: {size_m: [40, 24, 32], spacing_m: 1}\n"
                              "scene:\n"
                              "  difference:\n"
                              "    - box: {min_m: [4, 4, 0], max_m: [36, 20, 28]}\n"
                              "    - box: {min_m: [14, 0, 25], max_m: [16, 24, 30]}\n"
                              "    - box: {min_m: [24, 0, 25], max_m: [26, 24, 30]}\n"
                              "strata:\n"
                              "  - {to_m: 6, weak_m_per_kyr: 0.05, interlock_MPa: 1e9}\n"
                              "  - {to_m: 11, weak_m_per_kyr: 0.20, interlock_MPa: 1e9}\n"
                              "  - {to_m: 16, weak_m_per_kyr: 0.05, interlock_MPa: 1e9}\n"
                              "  - {to_m: 21, weak_m_per_kyr: 0.20, interlock_MPa: 1e9}\n"
                              "  - {to_m: 40, weak_m_per_kyr: 0.05, interlock_MPa: 1e9}\n"
                              "noise: {amplitude: 0.2, scale_m: 8}\n";

struct pillars {
    double left;
    int n;          /* in the hard layer on top, of at least 9 m2 */
    double notches; /* how much less rock there is in weak layers than in hard ones, as a share */
};

static double slab_area(const struct shape *s, int low, int high)
{
    size_t n = 0, slab = (size_t)s->n[0] * (size_t)s->n[1];
    for (size_t v = (size_t)low * slab; v < (size_t)high * slab; v++)
        n += s->rock[v];
    return (double)n * s->h * s->h / (high - low);
}

static int count_pillars(const struct shape *s, int level)
{
    size_t slab = (size_t)s->n[0] * (size_t)s->n[1];
    struct shape cut = {.n = {s->n[0], s->n[1], 1}, .h = s->h, .rock = malloc(slab)};
    int n = 0;
    memcpy(cut.rock, s->rock + (size_t)level * slab, slab);
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++)
            if (cut.rock[(size_t)j * (size_t)s->n[0] + (size_t)i] == 1)
                n += shape_flood(&cut, cut.rock, 1, (int[]){i, j, 0}, (int[]){i + 1, j + 1, 1}) >= 9;
    free(cut.rock);
    return n;
}

static struct pillars pillars(const char *what, const char *weather)
{
    char *text = malloc(sizeof hoodoos + strlen(weather));
    struct pillars out;
    sprintf(text, "%s%s", hoodoos, weather);
    struct sim s = sim_begin(text);
    free(text);
    for (int f = 1001; f < 1033; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    struct shape shape = shape_inside(&frame.grids, FIELD_MARGIN);
    out.left = frame.volume_m3 / frame.start_volume_m3;
    out.n = count_pillars(&shape, 22);
    double weak = 0.5 * (slab_area(&shape, 7, 10) + slab_area(&shape, 17, 20));
    double hard = (slab_area(&shape, 2, 5) + slab_area(&shape, 12, 15) + slab_area(&shape, 22, 24)) / 3;
    out.notches = 1 - weak / hard;
    print_message(
        "# %s: %.0f %% left, %d pillars in the top layer, weak layers %.0f %% smaller than hard ones\n", what,
        100 * out.left, out.n, 100 * out.notches);
    shape_free(&shape);
    frame_free(&frame);
    sim_end(&s);
    return out;
}

#define WATER                                                                                                \
    "rain: {m_per_yr: 2, erosion: 6, pull_Pa: 0.3, threshold_Pa: 0.35, least_width_m: 1.5, slope_m: 3}\n"
#define WIND "wind: {direction: [0.7, 0.7, 0], abrasion: 0.15, deflation: {intensity: 0.5}}\n"
#define CALM "wind: {abrasion: 0, deflation: {intensity: 0}}\n"

static void hoodoos_need_water_and_wind(void **state)
{
    (void)state;
    struct pillars both = pillars("water and wind", WATER WIND);
    struct pillars wind = pillars("wind only", WIND);
    struct pillars water = pillars("water only", WATER CALM);
    assert_true(both.n >= 3 && water.n >= 3 && wind.n == 1);
    assert_true(both.notches > 0.1 && wind.notches > 0.1);
    assert_true(water.notches < 0.5 * both.notches);
}

/* ---- fig. 17: what the threshold of running water does to gullies */

/* A roof of rock whose ridge runs along x, in the rain. */
static const char roof[] = "hoodoo: 1\n"
                           "name: roof\n"
                           "frames: 1001-1025\n"
                           "clock: {years_per_frame: 500}\n"
                           "seed: 4\n"
                           "domain: {size_m: [48, 48, 24], spacing_m: 1}\n"
                           "scene:\n"
                           "  intersection:\n"
                           "    - box: {min_m: [0, 2, 0], max_m: [48, 46, 24]}\n"
                           "    - plane: {point_m: [0, 24, 20], normal: [0, 0.6, 1]}\n"
                           "    - plane: {point_m: [0, 24, 20], normal: [0, -0.6, 1]}\n"
                           "strata:\n"
                           "  - {weak_m_per_kyr: 0.1, interlock_MPa: 1e9}\n"
                           "noise: {amplitude: 0.3, scale_m: 5}\n"
                           "wind: {abrasion: 0, deflation: {intensity: 0}}\n";

static void tops(const struct shape *s, int *top)
{
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++) {
            int k = s->n[2];
            while (k > 0 &&
                   !s->rock[((size_t)(k - 1) * (size_t)s->n[1] + (size_t)j) * (size_t)s->n[0] + (size_t)i])
                k--;
            top[j * s->n[0] + i] = k;
        }
}

struct gullies {
    double untouched; /* share of the roof that lost less than a metre */
    double head;      /* m from the ridge: where the gullies begin, on average over both sides and all x */
};

static struct gullies gullies(const char *what, const char *weather)
{
    char *text = malloc(sizeof roof + strlen(weather));
    struct gullies out = {0};
    sprintf(text, "%s%s", roof, weather);
    struct sim s = sim_begin(text);
    free(text);
    struct frame frame = sim_output(&s);
    struct shape shape = shape_inside(&frame.grids, FIELD_MARGIN);
    int nx = shape.n[0], ny = shape.n[1], cells = nx * ny, *before = calloc((size_t)cells, sizeof *before),
        *after = calloc((size_t)cells, sizeof *after), on_roof = 0, touched = 0, lines = 0;
    tops(&shape, before);
    shape_free(&shape);
    frame_free(&frame);
    for (int f = 1001; f < 1025; f++)
        assert_ok(model_step(s.model));
    frame = sim_output(&s);
    shape = shape_inside(&frame.grids, FIELD_MARGIN);
    tops(&shape, after);
    for (int i = 4; i < nx - 4; i++)
        for (int side = 0; side < 2; side++) {
            double head = 20;
            for (int d = 0; d < 20; d++) {
                int c = (side ? ny / 2 + d : ny / 2 - 1 - d) * nx + i;
                bool cut = before[c] - after[c] >= 2;
                on_roof++;
                touched += before[c] - after[c] >= 1;
                if (cut && d < head)
                    head = d;
            }
            out.head += head;
            lines++;
        }
    out.head /= lines;
    out.untouched = 1 - (double)touched / on_roof;
    print_message("# %s: %.0f %% of the rock left, %.0f %% of the roof untouched, gullies begin %.1f m from "
                  "the ridge\n",
                  what, 100 * frame.volume_m3 / frame.start_volume_m3, 100 * out.untouched, out.head);
    free(before);
    free(after);
    shape_free(&shape);
    frame_free(&frame);
    sim_end(&s);
    return out;
}

static void a_threshold_moves_gullies_down_and_apart(void **state)
{
    (void)state;
    struct gullies none =
        gullies("no threshold", "rain: {m_per_yr: 1, erosion: 3, pull_Pa: 0.3, threshold_Pa: 0}\n");
    struct gullies some =
        gullies("threshold 0.6 Pa", "rain: {m_per_yr: 1, erosion: 3, pull_Pa: 0.3, threshold_Pa: 0.6}\n");
    struct gullies high =
        gullies("threshold 1.2 Pa", "rain: {m_per_yr: 1, erosion: 3, pull_Pa: 0.3, threshold_Pa: 1.2}\n");
    assert_true(none.untouched < 0.1);
    assert_true(some.untouched > none.untouched + 0.1 && high.untouched > some.untouched + 0.1);
    assert_true(some.head > none.head + 2 && high.head > some.head + 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hoodoos_need_water_and_wind),
        cmocka_unit_test(a_threshold_moves_gullies_down_and_apart),
        cmocka_unit_test(an_arch_needs_deflation_and_leans_with_abrasion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
