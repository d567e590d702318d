/* The light of a job: where the sun stands, that it stays in the world, and what of it is part of a job's identity. */
#include "check.h"

#include <math.h>
#include <stdio.h>

#include "field/light.h"
#include "job_files.h"

static struct job *job_with(const char *keys)
{
    char text[900];
    snprintf(text, sizeof text,
             "{hoodoo: 1, name: a, frames: 1001-1100, domain: {size_m: [4, 4, 4], spacing_m: 1}, "
             "scene: {box: {min_m: [1, 1, 0], max_m: [3, 3, 3]}}, wind: {direction: [1, 0, 0]}, %s}",
             keys);
    return load_good(text);
}

static double degrees(double radians)
{
    return radians * 180 / 3.14159265358979323846;
}

static void the_sun_stands_where_almanacs_have_it(void **state)
{
    (void)state;
    double d[3];
    /* Noon: 90 degrees less the latitude, plus 23.45 at midsummer (day 172), in the south. */
    light_solar(38.6, 172, 12, d);
    assert_true(fabs(degrees(asin(d[2])) - (90 - 38.6 + 23.45)) <= 0.1);
    assert_true(d[1] < 0 && fabs(d[0]) < 1e-9);
    /* At the equinox (day 81) it sets in the west, half a day after it rose in the east. */
    light_solar(38.6, 81, 18, d);
    assert_true(fabs(degrees(asin(d[2])) - (0)) <= 0.2);
    assert_true(fabs(d[0] - (-1)) <= 1e-3);
    light_solar(38.6, 81, 6, d);
    assert_true(fabs(d[0] - (1)) <= 1e-3);
}

static void a_sun_of_its_own_rakes_from_the_winds_side_and_stays(void **state)
{
    (void)state;
    struct job *job = job_with("cameras: {main: {orbit: {target_m: [2, 2, 2], distance_m: 20, "
                               "azimuth_deg: {1001: -90, 1100: 270}}}}");
    const struct light first = light_of(job, 1001), last = light_of(job, 1100);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(first.sun[i] - (last.sun[i])) <= 0);
    assert_false(light_changes(job));
    /* Wind towards +x comes from -x; the camera stands at -y. */
    assert_true(first.sun[0] < -0.5 && first.sun[1] < -0.2 && first.sun[2] > 0.4);
    assert_true(first.sun_rgb[0] > first.sun_rgb[2] && first.sky_rgb[2] > first.sky_rgb[0]);
    job_destroy(&job);
}

static void keys_may_follow_the_frames(void **state)
{
    (void)state;
    struct job *job =
        job_with("light: {sun: {azimuth_deg: 40, elevation_deg: {1001: 60, 1051: -12}}, strength: 0.5}");
    const struct light day = light_of(job, 1001), night = light_of(job, 1051);
    assert_true(light_changes(job));
    assert_true(fabs(degrees(atan2(day.sun[1], day.sun[0])) - (40)) <= 1e-9);
    assert_true(fabs(degrees(asin(day.sun[2])) - (60)) <= 1e-9);
    assert_true(fabs(night.sun_rgb[0] - (0)) <= 0);
    assert_true(night.sky_rgb[1] > 0 && night.sky_rgb[1] < 0.05 * day.sky_rgb[1]);
    job_destroy(&job);
}

static void a_light_is_no_part_of_the_rock_but_of_its_pictures(void **state)
{
    (void)state;
    const char *const lights[] = {"seed: 1", "seed: 1, light: {strength: 1}",
                                  "seed: 1, light: {strength: 2}"};
    uint64_t rock[2][3], files[2][3];
    for (int pictures = 0; pictures < 2; pictures++)
        for (int i = 0; i < 3; i++) {
            char keys[300];
            snprintf(keys, sizeof keys, "%s, cameras: {main: {position_m: [0, -9, 2]}}%s", lights[i],
                     pictures ? ", output: {aov: {cameras: [main]}}" : "");
            struct job *job = job_with(keys);
            assert_ok(job_hash(job, &rock[pictures][i]));
            assert_ok(job_files_hash(job, &files[pictures][i]));
            job_destroy(&job);
        }
    for (int pictures = 0; pictures < 2; pictures++) {
        assert_true(rock[pictures][0] == rock[pictures][1] && rock[pictures][1] == rock[pictures][2]);
        assert_true(files[pictures][0] == files[pictures][1]); /* as written in older releases */
        assert_true((files[pictures][1] == files[pictures][2]) == !pictures);
    }
}

static void two_suns_are_refused(void **state)
{
    (void)state;
    char text[400];
    snprintf(text, sizeof text,
             "{hoodoo: 1, name: a, frames: 1001-1002, domain: {size_m: [4, 4, 4], spacing_m: 1}, "
             "scene: {box: {min_m: [1, 1, 0], max_m: [3, 3, 3]}}, light: {sun: {}, solar: {}}}");
    struct job *job = NULL;
    assert_int_equal(load_text(text, &job), E_USAGE);
    assert_non_null(strstr(status_message(), "light.solar"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sun_stands_where_almanacs_have_it),
        cmocka_unit_test(a_sun_of_its_own_rakes_from_the_winds_side_and_stays),
        cmocka_unit_test(keys_may_follow_the_frames),
        cmocka_unit_test(a_light_is_no_part_of_the_rock_but_of_its_pictures),
        cmocka_unit_test(two_suns_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
