/* Water on whole rocks: discharge does not depend on the spacing; rain on a slope gathers into gullies, the
 * more the less the rock withstands; a spring cuts its bed. */
#include "model_help.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "shared/params.h"
#include "water_help.h"

/* ---- catchments */

static double spacing;

/* Two valleys along y = 10 and 24 m that fall to x = 0, with ridges around them at y = 3, 17, 31 and x = 29 m;
 * a dam of 3 m across both. */
static double ground(double x, double y)
{
    double from_axis = fabs(fmod(y - 3 + 14, 14) - 7), dam = 3 * exp(-pow((x - 13) / 1.5, 2));
    return 3 + 0.3 * fmin(x, 58 - x) + 0.6 * from_axis + dam + 0.1 * sin(1.1 * x + 0.3 * y) * sin(0.9 * y);
}

static float valleys(const struct scene *s, int i, int j, int k)
{
    double sum = 0;
    (void)s;
    for (int a = 0; a < 4; a++)
        sum += fmin(
            1, fmax(0, ground((i + 0.25 + 0.5 * (a & 1)) * spacing, (j + 0.25 + 0.5 * (a >> 1)) * spacing) /
                               spacing -
                           k));
    return (float)(sum / 4);
}

struct gauge {
    double first, second; /* m3/yr that leave through x = 0, by valley */
    double dam;           /* over the dams' crests, in the mean */
};

static uint32_t *words(struct gpu *gpu, const struct gpu_buffer *b, size_t n)
{
    uint32_t *data = calloc(n, 4);
    assert_non_null(data);
    assert_ok(gpu_download(gpu, b, 0, data, n));
    return data;
}

static struct gauge measure(struct gpu *gpu, double h, int step)
{
    struct gauge g = {0};
    struct job job;
    struct water w;
    double year = 0.3;
    spacing = h;
    struct scene scene = {.n = {(int)(32 / h), (int)(32 / h), (int)(20 / h)}};
    struct bed bed = bed_of(gpu, &scene, h, valleys);
    struct water_routing how = {.seed = 11, .frame = 4, .step = step};
    job_of_rain(&job, &year);
    assert_ok(water_create(gpu, &job, bed.n, h, 1, &w));
    assert_ok(water_route(gpu, bed.work, &w, &how, &bed.p));
    assert_ok(water_discharge(gpu, bed.work, &w, &job, 1, &bed.p));
    const size_t n = w.n_nodes;
    const uint32_t nx = (uint32_t)w.cells[0], ny = (uint32_t)w.cells[1];
    uint32_t *cell = words(gpu, w.node[WATER_CELL], n), *rain = words(gpu, w.node[WATER_RAIN], n);
    uint32_t *to = words(gpu, w.pass, 4 * n), *shares = words(gpu, w.shares, 2 * n);
    for (size_t i = 0; i < n; i++) {
        const double along = (cell[i] / nx % ny + 0.5) * h, across = (cell[i] % nx + 0.5) * h;
        if (along < 3 || along > 31)
            continue;
        if (cell[i] % nx == 0)
            *(along < 17 ? &g.first : &g.second) += rain[i] * w.rain_unit;
        for (size_t d = 0; d < 4; d++) {
            const double share = (double)(shares[2 * i + d / 2] >> 16 * (d % 2) & 0xffff) / WATER_WHOLE;
            if (share > 0 && across > 13 && (cell[to[4 * i + d]] % nx + 0.5) * h <= 13)
                g.dam += share * rain[i] * w.rain_unit / 2;
        }
    }
    free(cell);
    free(rain);
    free(to);
    free(shares);
    water_destroy(gpu, &w);
    bed_free(&bed);
    return g;
}

/* Means over a few grids and choices. */
static void discharge_does_not_depend_on_the_spacing(void **state)
{
    static const double h[] = {1, 0.5, 0.25};
    struct gauge g[3] = {{0}};
    struct gpu *gpu = open_gpu();
    (void)state;
    for (int i = 0; i < 3; i++) {
        for (int step = 0; step < 4; step++) {
            struct gauge one = measure(gpu, h[i], step);
            g[i].first += one.first / 4;
            g[i].second += one.second / 4;
            g[i].dam += one.dam / 4;
        }
        print_message("# spacing %.2f m: %.1f and %.1f m3/yr out of the valleys, %.1f over the dam\n", h[i],
                      g[i].first, g[i].second, g[i].dam);
    }
    gpu_destroy(&gpu);
    print_message("# expected from the ridges: %.1f, %.1f, %.1f\n", 0.3 * 14 * 29, 0.3 * 14 * 29,
                  0.3 * 14 * 16);
    for (int i = 1; i < 3; i++) {
        assert_true(fabs(g[i].first / (0.3 * 14 * 29) - 1) < 0.03);
        assert_true(fabs(g[i].second / (0.3 * 14 * 29) - 1) < 0.03);
        assert_true(fabs(g[i].dam / (0.3 * 14 * 16) - 1) < 0.03);
    }
}

/* ---- gullies */

struct slope {
    double h, threshold, source;
    int frames, years;
};

struct cut {
    double mean, across; /* m: mean retreat of the slope's lower half, and its spread across the slope */
    double deepest;
    int deepest_at; /* m across */
};

enum { SIZE = 24 };

/* What a slope of 0.3 falling to x = 0 loses; after half of its frames and after all. */
static void erode_slope(const struct slope *s, struct cut cut[2])
{
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: slope\nframes: 1-%d\nseed: 3\n"
             "clock: {years_per_frame: %d}\n"
             "domain: {size_m: [%d, %d, 14], spacing_m: %g}\n"
             "rock: {gravity_m_s2: 0}\n"
             "scene: {plane: {point_m: [12, 12, 7], normal: [-0.3, 0, 1]}}\n"
             "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.002}]\n"
             "wind: {abrasion: 0, deflation: {intensity: 0}}\n"
             "rain: {m_per_yr: %g, erosion: 20, threshold_Pa: %g}\n%s",
             s->frames + 1, s->years, SIZE, SIZE, s->h, s->source > 0 ? 0 : 0.5, s->threshold,
             s->source > 0 ? "sources: [{path_m: [[21, 9, 11]], m3_per_yr: 300}]\n" : "");
    struct sim sim = sim_begin(text);
    struct frame first = sim_output(&sim);
    size_t n_ids = first.rock.n;
    for (int half = 0; half < 2; half++) {
        for (int f = 0; f < s->frames / 2; f++)
            assert_ok(model_step(sim.model));
        struct frame last = sim_output(&sim);
        float *left = viability_by_id(&last.rock, n_ids);
        double lost[SIZE] = {0}, square = 0;
        for (size_t i = 0; i < n_ids; i++) {
            double x = (double)first.rock.P[4 * i], y = (double)first.rock.P[4 * i + 1];
            if (x > 3 && x < 12)
                lost[(int)y] += (double)(first.rock.viability[i] - left[first.rock.id[i]]) * pow(s->h, 3) / 9;
        }
        cut[half] = (struct cut){0};
        for (int y = 3; y < SIZE - 3; y++) {
            cut[half].mean += lost[y] / (SIZE - 6);
            if (lost[y] > cut[half].deepest) {
                cut[half].deepest = lost[y];
                cut[half].deepest_at = y;
            }
        }
        for (int y = 3; y < SIZE - 3; y++)
            square += pow(lost[y] - cut[half].mean, 2) / (SIZE - 6);
        cut[half].across = sqrt(square);
        free(left);
        frame_free(&last);
    }
    frame_free(&first);
    sim_end(&sim);
}

static void rain_gathers_into_gullies(void **state)
{
    struct cut low[2], high[2];
    (void)state;
    erode_slope(&(struct slope){.h = 0.5, .threshold = 0.05, .frames = 12, .years = 100}, low);
    erode_slope(&(struct slope){.h = 0.5, .threshold = 0.15, .frames = 12, .years = 100}, high);
    for (int half = 0; half < 2; half++)
        print_message(
            "# after %d years: threshold 0.05 Pa lost %.3f m, spread across %.3f m; 0.15 Pa %.3f m, "
            "%.3f m\n",
            600 * (half + 1), low[half].mean, low[half].across, high[half].mean, high[half].across);
    /* Unevenness grows faster than the retreat itself: streams deepen where they run. */
    assert_true(low[1].across > 2.5 * low[0].across && low[1].across > 1.5 * high[1].across);
    assert_true(low[1].across / low[1].mean > 1.2 * low[0].across / low[0].mean);
    assert_true(low[1].mean > high[1].mean);
}

static void a_spring_cuts_its_bed(void **state)
{
    struct cut cut[2];
    (void)state;
    erode_slope(&(struct slope){.h = 0.5, .threshold = 0.5, .source = 1, .frames = 12, .years = 100}, cut);
    print_message("# %.3f m lost in the mean, %.3f m where it is most, %d m across (the spring is at 9)\n",
                  cut[1].mean, cut[1].deepest, cut[1].deepest_at);
    assert_true(cut[1].deepest > 3 * cut[1].mean && abs(cut[1].deepest_at - 9) <= 3);
}

/* ---- strata */

/* What three layers of a slope lose, m3: the middle one withstands water, the highest wind. */
static void lost_by_layer(const char *weather, double lost[3])
{
    enum { YEARS = 500 };
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: layers\nframes: 1-7\nseed: 3\nclock: {years_per_frame: %d}\n"
             "domain: {size_m: [16, 12, 14], spacing_m: 1}\nrock: {gravity_m_s2: 0}\n"
             "scene: {plane: {point_m: [8, 6, 6], normal: [-0.7, 0, 1]}}\n"
             "strata:\n"
             "  - {to_m: 4, weak_m_per_kyr: 0.2}\n"
             "  - {to_m: 8, weak_m_per_kyr: 0.2, threshold_Pa: 1e5}\n"
             "  - {weak_m_per_kyr: 0.2, deflation: 0, abrasion: 0}\n%s",
             YEARS, weather);
    struct sim sim = sim_begin(text);
    struct frame first = sim_output(&sim);
    for (int f = 0; f < 6; f++)
        assert_ok(model_step(sim.model));
    struct frame last = sim_output(&sim);
    float *left = viability_by_id(&last.rock, first.rock.n);
    lost[0] = lost[1] = lost[2] = 0;
    for (size_t i = 0; i < first.rock.n; i++)
        lost[first.rock.layer[i]] += (double)(first.rock.viability[i] - left[first.rock.id[i]]);
    print_message("# the layers lose %.1f, %.1f and %.1f m3\n", lost[0], lost[1], lost[2]);
    free(left);
    frame_free(&first);
    frame_free(&last);
    sim_end(&sim);
}

static void each_layer_withstands_what_it_says(void **state)
{
    double wind[3], rain[3];
    (void)state;
    lost_by_layer("wind: {direction: [1, 0, 0], abrasion: 0.5, deflation: {intensity: 1}}\n", wind);
    lost_by_layer("wind: {abrasion: 0, deflation: {intensity: 0}}\n"
                  "rain: {m_per_yr: 1, erosion: 2, threshold_Pa: 0.05}\n",
                  rain);
    assert_true(wind[0] > 10 && wind[1] > 10 && wind[2] == 0);
    assert_true(rain[0] > 3 && rain[1] == 0 && rain[2] > 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(discharge_does_not_depend_on_the_spacing),
        cmocka_unit_test(rain_gathers_into_gullies),
        cmocka_unit_test(a_spring_cuts_its_bed),
        cmocka_unit_test(each_layer_withstands_what_it_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
