/* What a picture's strip says of its time: years as one says them, and none where nobody knows them. */
#include "check.h"

#include <stdio.h>

#include "job_files.h"
#include "render/slate.h"

static void says(const char *keys, int frame, const char *want)
{
    char text[600], said[96];
    snprintf(text, sizeof text,
             "{hoodoo: 1, name: a, frames: 1001-1100, domain: {size_m: [4, 4, 4], spacing_m: 1}, "
             "scene: {box: {min_m: [1, 1, 0], max_m: [3, 3, 3]}}, %s}",
             keys);
    struct job *job = load_good(text);
    slate_when(job, frame, job_years(job, 1001, frame), said);
    assert_string_equal(said, want);
    job_destroy(&job);
}

static void time_is_told_as_one_says_it(void **state)
{
    (void)state;
    says("clock: {years_per_frame: 920}", 1061, "frame 1061   55.2 kyr");
    says("clock: {years_per_frame: 10}", 1051, "frame 1051   500 yr");
    says("clock: {years_per_frame: 0.5}", 1004, "frame 1004   1.5 yr");
    says("clock: {years_per_frame: 0.0025}", 1100, "frame 1100   90 days");
    says("clock: {years_per_frame: 0.0025}", 1001, "frame 1001   0 yr");
    says("clock: {seconds_per_frame: 0.125}", 1003, "frame 1003   0.25 s");
    says("model: arches, clock: {years_per_frame: 1000}", 1051, "frame 1051");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(time_is_told_as_one_says_it)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
