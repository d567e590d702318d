/* What water takes does not depend on the spacing, on the years of a frame or on the direction of the slope to the grid. At
 * more effort over more spacings, steps and directions. */
#include "model_help.h"

#include <math.h>

#include "effort.h"

/* What a job's frames take, m3. */
static double taken(const char *what, int years, double h, const char *scene, const char *weather)
{
    enum { YEARS = 8000 };
    char text[2000];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: same\nframes: 1-%d\nseed: 5\nclock: {years_per_frame: %d}\n"
             "domain: {size_m: [28, 28, 16], spacing_m: %g}\nrock: {gravity_m_s2: 0}\n"
             "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.2}]\n"
             "wind: {abrasion: 0, deflation: {intensity: 0}}\nscene: %s\n%s",
             1 + YEARS / years, years, h, scene, weather);
    struct sim s = sim_begin(text);
    for (int f = 0; f < YEARS / years; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    const double m3 = frame.start_volume_m3 - frame.volume_m3;
    frame_free(&frame);
    sim_end(&s);
    print_message("# %s, spacing %g m, %d years a frame: %.1f m3\n", what, h, years, m3);
    return m3;
}

struct bounds {
    double least, most;
};

static void put(struct bounds *b, double m3)
{
    assert_true(m3 > 5); /* it did take something */
    b->least = b->most > 0 ? fmin(b->least, m3) : m3;
    b->most = fmax(b->most, m3);
}

static const char slope[] = "{intersection: [{box: {min_m: [4, 4, 0], max_m: [24, 24, 16]}}, "
                            "{plane: {point_m: [14, 14, 9], normal: [0.3, 0.05, 1]}}]}";
static const char sheet[] = "rain: {m_per_yr: 1, erosion: 0.5, threshold_Pa: 0}\n";
static const char lip[] = "rain: {m_per_yr: 1, erosion: 0.5, threshold_Pa: 0.4}\n";
static const char river[] =
    "rain: {erosion: 0.05}\n"
    "sources: [{path_m: [[6, 14, 11.5], [23, 15, 6]], m3_per_yr: 40000, bed_m: 1.5}]\n";

static void spacing_does_not_show(void **state)
{
    const char *weather[] = {sheet, lip, river}, *name[] = {"sheet", "threshold", "river"};
    const double h[] = {1, 0.5, 2};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct bounds b = {0};
        for (int k = 0; k < (effort() > 1 ? 3 : 2); k++)
            put(&b, taken(name[i], 2000, h[k], slope, weather[i]));
        assert_true(b.most / b.least < 1.2);
    }
}

static void years_a_frame_do_not_show(void **state)
{
    const char *weather[] = {lip, river}, *name[] = {"threshold", "river"};
    const int years[] = {2000, 500, 250};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct bounds b = {0};
        for (int k = 0; k < (effort() > 1 ? 3 : 2); k++)
            put(&b, taken(name[i], years[k], 1, slope, weather[i]));
        assert_true(b.most / b.least < 1.15);
    }
}

static void axes_do_not_show(void **state)
{
    const char *weather[] = {sheet, lip}, *name[] = {"sheet", "threshold"};
    const double degrees[] = {0, 45, 20, 70, 90};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct bounds b = {0};
        for (int k = 0; k < (effort() > 1 ? 5 : 2); k++) {
            const double a = degrees[k] * acos(-1) / 180;
            char scene[400], what[80];
            snprintf(scene, sizeof scene,
                     "{intersection: [{cylinder: {from_m: [14, 14, 0], to_m: [14, 14, 20], radius_m: 11}}, "
                     "{plane: {point_m: [14, 14, 9], normal: [%.4f, %.4f, 1]}}]}",
                     0.3 * cos(a), 0.3 * sin(a));
            snprintf(what, sizeof what, "%s, to %g degrees", name[i], degrees[k]);
            put(&b, taken(what, 2000, 1, scene, weather[i]));
        }
        assert_true(b.most / b.least < 1.08);
    }
}

/* A river under the rock, in beds down to such as are hardly wider than voxels. */
static void thin_beds_run(void **state)
{
    struct bounds b = {0};
    const double bed[] = {1.5, 3, 2};
    (void)state;
    for (int k = 0; k < (effort() > 1 ? 3 : 2); k++) {
        char weather[400], what[80];
        snprintf(weather, sizeof weather,
                 "rain: {erosion: 0.05}\n"
                 "paint: [{shape: {box: {min_m: [24, 0, 0], max_m: [28, 28, 16]}}, inert: true}]\n"
                 "sources: [{path_m: [[4, 14, 9], [28, 15, 6]], m3_per_yr: 40000, bed_m: %g}]\n",
                 bed[k]);
        snprintf(what, sizeof what, "bed of %g m", bed[k]);
        put(&b, taken(what, 2000, 1, "{box: {min_m: [0, 0, 0], max_m: [28, 28, 15]}}", weather));
    }
    assert_true(b.most / b.least < 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spacing_does_not_show),
        cmocka_unit_test(years_a_frame_do_not_show),
        cmocka_unit_test(axes_do_not_show),
        cmocka_unit_test(thin_beds_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
