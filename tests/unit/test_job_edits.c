/* Edits in job files: what they set holds from their frame on, and what they cannot do is refused where it stands. */
#include "job_files.h"

#include <math.h>

static const char head[] = "name: a\nframes: 1001-1100\ndomain: {size_m: [8, 8, 8], spacing_m: 1}\n"
                           "scene: {box: {min_m: [0, 0, 0], max_m: [8, 8, 8]}}\n"
                           "clock: {years_per_frame: 100}\n"
                           "strata: [{to_m: 4, interlock_MPa: 1}, {interlock_MPa: 2}]\n"
                           "edits:\n";

static char *with(const char *edits)
{
    static char text[4000];
    snprintf(text, sizeof text, "%s%s", head, edits);
    return text;
}

static void what_is_set_holds_from_its_frame_on(void **state)
{
    (void)state;
    struct job *job =
        load_good(with("  - {frame: 1010, set: {wind.speed_m_s: 14, strata.0.interlock_MPa: 5}}\n"
                       "  - {frame: 1020, set: {'strata[1].interlock_MPa': {1001: 2, 1101: 4},\n"
                       "                        wind: {abrasion: 0.1}}}\n"));
    assert_ptr_equal(job_at(job, 1009), job);
    assert_true(curve_at(&job->wind.speed_m_s, 1050) == 10);
    const struct job *one = job_at(job, 1010), *two = job_at(job, 1020);
    assert_ptr_equal(job_at(job, 1019), one);
    assert_ptr_equal(job_at(job, 5000), two);
    assert_true(curve_at(&one->wind.speed_m_s, 1010) == 14);
    assert_true(curve_at(&one->strata[0].interlock_MPa, 1010) == 5);
    assert_true(curve_at(&one->strata[1].interlock_MPa, 1010) == 2);
    /* The first's settings stay, but for a mapping set as a whole. */
    assert_true(curve_at(&two->strata[0].interlock_MPa, 1051) == 5);
    assert_true(fabs(curve_at(&two->strata[1].interlock_MPa, 1051) - 3) < 1e-12);
    assert_true(curve_at(&two->wind.abrasion, 1051) == 0.1);
    assert_true(curve_at(&two->wind.speed_m_s, 1051) == 10);
    job_destroy(&job);
}

static void years_go_by_the_clock_of_each_frame(void **state)
{
    (void)state;
    struct job *job = load_good(with("  - {frame: 1001, set: {clock.years_per_frame: 200}}\n"
                                     "  - {frame: 1011, set: {wind.speed_m_s: 3}}\n"
                                     "  - {frame: 1011, set: {clock.years_per_frame: 10}}\n"
                                     "  - {frame: 1013, set: {clock.years_per_frame: 1}}\n"));
    assert_true(job_years(job, 1001, 1001) == 0);
    assert_true(job_years(job, 1001, 1010) == 9 * 200);
    assert_true(job_years(job, 1001, 1013) == 9 * 200 + 2 * 10 + 1);
    assert_true(job_years(job, 1011, 1100) == 10 + 88);
    for (int from = 1001; from < 1020; from++)
        for (int to = from; to < 1020; to++) {
            double sum = 0;
            for (int f = from + 1; f <= to; f++)
                sum += job_at(job, f)->clock.years_per_frame;
            assert_true(job_years(job, from, to) == sum);
        }
    job_destroy(&job);
}

static void the_hash_sees_edits_and_not_how_they_are_written(void **state)
{
    (void)state;
    static const char *const same[] = {
        "  - {frame: 1010, set: {strata.0.interlock_MPa: 5}}\n",
        "  - {set: {'strata[0].interlock_MPa': 5.0}, frame: 1010}\n",
        "  - frame: 1010\n    set:\n      strata.0.interlock_MPa: {1001: 5}\n",
    };
    static const char *const other[] = {
        "  - {frame: 1011, set: {strata.0.interlock_MPa: 5}}\n",
        "  - {frame: 1010, set: {strata.0.interlock_MPa: 6}}\n",
        "  - {frame: 1010, set: {strata.1.interlock_MPa: 5}}\n",
        "  - {frame: 1010, set: {wind.speed_m_s: 10}}\n",
        "  - {frame: 1010, carve: {sphere: {center_m: [1, 1, 1], radius_m: 1}}}\n",
        "  - {frame: 1010, add: [{shape: {sphere: {center_m: [1, 1, 1], radius_m: 1}}}]}\n",
        "  - {frame: 1010, add: [{layer: 0, shape: {sphere: {center_m: [1, 1, 1], radius_m: 1}}}]}\n",
        "  - {frame: 1010, paint: [{shape: {sphere: {center_m: [1, 1, 1], radius_m: 1}}}]}\n",
        "  - {frame: 1010, paint: [{noise: {}}]}\n",
        "  - {frame: 1010, paint: [{noise: {seed: 1}}]}\n",
        "  []\n",
    };
    uint64_t hash = hash_of_text(with(same[0])), seen[sizeof other / sizeof *other];
    for (size_t i = 1; i < sizeof same / sizeof *same; i++)
        assert_true(hash_of_text(with(same[i])) == hash);
    for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
        seen[i] = hash_of_text(with(other[i]));
        assert_true(seen[i] != hash);
        for (size_t k = 0; k < i; k++)
            assert_true(seen[k] != seen[i]);
    }
}

/* The first frame whose hash differs between two lists of edits. */
static int first_difference(const char *edits, const char *others)
{
    struct job *one = load_good(with(edits)), *other = NULL;
    struct job_states a, b;
    assert_int_equal(job_states(one, &a), OK);
    other = load_good(with(others));
    assert_int_equal(job_states(other, &b), OK);
    const int frame = job_states_differ(&a, &b);
    assert_true(frame == 1001 || job_states_hold(&a, frame - 1, b.frame[frame - 1 - b.first]));
    assert_true(job_states_hold(&a, 1001, a.job) && !job_states_hold(&a, 1001, a.job + 1));
    job_states_free(&a);
    job_states_free(&b);
    job_destroy(&one);
    job_destroy(&other);
    return frame;
}

static void the_hash_of_a_frame_sees_what_came_before(void **state)
{
    (void)state;
    static const char box[] = "box: {min_m: [0, 0, 6], max_m: [8, 8, 8]}";
    static const struct {
        const char *one, *other;
        int frame;
    } pairs[] = {
        {"  - {frame: 1010, carve: {%s}}\n", "  - {frame: 1012, carve: {%s}}\n", 1010},
        {"  - {frame: 1010, carve: {%s}}\n",
         "  - {frame: 1010, carve: {%s}}\n  - {frame: 1050, carve: {%s}}\n", 1050},
        {"  - {frame: 1010, set: {wind.speed_m_s: 4}}\n",
         "  - {frame: 1010, set: {wind.speed_m_s: 4}}\n  - {frame: 1020, set: {wind.speed_m_s: 5}}\n", 1020},
        {"  - {frame: 1010, set: {wind.speed_m_s: {1001: 4, 1040: 4, 1050: 5}}}\n",
         "  - {frame: 1010, set: {wind.speed_m_s: {1001: 4, 1040: 4, 1050: 6}}}\n", 1041},
        /* Constants count from the edit on that sets them; other constants than before count from the start. */
        {"  - {frame: 1010, set: {rock.density_kg_m3: 2000}}\n  - {frame: 1020, set: {rock.density_kg_m3: 2300}}\n",
         "  - {frame: 1010, set: {rock.density_kg_m3: 2300}}\n  - {frame: 1020, set: {rock.density_kg_m3: 2000}}\n",
         1010},
        {"  - {frame: 1010, set: {rock.density_kg_m3: 2000}}\n",
         "  - {frame: 1010, set: {rock.density_kg_m3: 2100}}\n", 1001},
        {"  - {frame: 1010, carve: {%s}}\n",
         "  - {frame: 1010, carve: {%s}}\n  - {frame: 1200, carve: {%s}}\n", 1101},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        char one[1000], other[1000];
        snprintf(one, sizeof one, pairs[i].one, box, box);
        snprintf(other, sizeof other, pairs[i].other, box, box);
        const int frame = first_difference(one, other);
        if (frame != pairs[i].frame)
            fail_msg("pair %zu: frame %d, not %d", i, frame, pairs[i].frame);
    }
}

static void the_resolved_job_has_the_same_edits(void **state)
{
    (void)state;
    struct text t = {0}, again = {0};
    struct job *job = load_good(
        with("  - {frame: 1010, set: {wind: {speed_m_s: {1001: 2, 1050: 3, ease: step}, gusts: [{frames: "
             "1003-1009x2, "
             "factor: 3}]}, \"strata.0.interlock_MPa\": 2.5e0}}\n"
             "  - {frame: 1012, carve: {union: [{stroke: {path_m: [[1, 2, 3]], radius_m: 1}}]}}\n"));
    assert_int_equal(job_resolved(job, &t), OK);
    struct job *copy = load_good(t.data);
    assert_true(hash_of(copy) == hash_of(job));
    assert_true(curve_at(&job_at(copy, 1060)->wind.speed_m_s, 1049) == 2);
    assert_true(job_at(copy, 1060)->wind.n_gusts == 1);
    assert_int_equal(job_resolved(copy, &again), OK);
    assert_string_equal(t.data, again.data);
    text_free(&t);
    text_free(&again);
    job_destroy(&copy);
    job_destroy(&job);
}

static void set_on_the_command_line_reaches_edits(void **state)
{
    (void)state;
    const char *const sets[] = {"edits.0.set={wind.speed_m_s: 3}", "edits.1.frame=1030",
                                "edits.1.carve={sphere: {center_m: [1, 1, 1], radius_m: 1}}"};
    struct job *job = NULL;
    const char *text = with("  - {frame: 1010, set: {wind.speed_m_s: 14}}\n");
    write_bytes("job.yaml", text, strlen(text));
    assert_int_equal(job_load("job.yaml", sets, 3, &job), OK);
    assert_true(curve_at(&job_at(job, 1010)->wind.speed_m_s, 0) == 3);
    assert_true(job->n_edits == 2 && job->edits[1].carve);
    job_destroy(&job);
}

static void marks_are_frames_and_ranges(void **state)
{
    (void)state;
    struct job *job = load_good(good_job);
    for (int f = 1001; f <= 1110; f++)
        assert_int_equal(job_marks(job, f), f == 1040 || (f >= 1051 && f <= 1061 && f % 2));
    job_destroy(&job);
}

/* Line 8 is the first edit's; its text begins at column 3. */
static const struct {
    const char *edits, *says[2];
} wrong[] = {
    {"  - {frame: 1000, set: {fps: 3}}\n",
     {"job.yaml:8:13: edits.0.frame: frame 1000 is before the job's first, 1001"}},
    {"  - {set: {wind.speed_m_s: 3}}\n", {"job.yaml:8:5: edits.0.frame: missing"}},
    {"  - {frame: 1010}\n", {"job.yaml:8:5: edits.0: changes nothing"}},
    {"  - {frame: 1010, set: {}}\n", {"edits.0: changes nothing"}},
    {"  - {frame: 1010, set: {wind.speed_m_s: 3}}\n  - {frame: 1009, set: {wind.speed_m_s: 3}}\n",
     {"job.yaml:9:13: edits.1.frame: frame 1009 is before the edit above it, of frame 1010"}},
    {"  - {frame: 1010, set: {wind.sped_m_s: 3}}\n",
     {"job.yaml:8:25: wind.sped_m_s: unknown key", "did you mean speed_m_s?"}},
    {"  - {frame: 1010, set: {wnd.speed_m_s: 3}}\n", {"job.yaml:8:25: wnd: unknown key; did you mean wind?"}},
    {"  - {frame: 1010, set: {wind.speed_m_s: fast}}\n", {"job.yaml:8:41: wind.speed_m_s: 'fast' is not"}},
    {"  - {frame: 1010, set: {wind.speed_m_s: 1e9}}\n",
     {"job.yaml:8:41: wind.speed_m_s: 1e9 is out of range"}},
    {"  - {frame: 1010, set: {wind..speed_m_s: 3}}\n",
     {"job.yaml:8:25: edits.0.set.wind..speed_m_s: not a key path"}},
    {"  - {frame: 1010, set: {seed: 3}}\n", {"job.yaml:8:25: edits.0.set.seed: an edit cannot change seed"}},
    {"  - {frame: 1010, set: {domain.spacing_m: 3}}\n", {"an edit cannot change domain"}},
    {"  - {frame: 1010, set: {frames: 1001-1002}}\n", {"an edit cannot change frames"}},
    {"  - {frame: 1010, set: {name: b}}\n", {"this only what is written"}},
    {"  - {frame: 1010, set: {model: goblins}}\n", {"an edit cannot change model"}},
    {"  - {frame: 1010, set: {scene: {}}}\n", {"an edit cannot change scene"}},
    {"  - {frame: 1010, set: {edits.0.frame: 3}}\n", {"an edit cannot change edits"}},
    {"  - {frame: 1010, set: {paint: []}}\n", {"an edit cannot change paint"}},
    {"  - {frame: 1010, set: {from: x}}\n", {"an edit cannot change from"}},
    {"  - {frame: 1010, set: {fps: 30}}\n", {"this only what is written"}},
    {"  - {frame: 1010, set: {strata.0.color: [1, 1, 1]}}\n", {"this only what is written"}},
    {"  - {frame: 1010, set: {output.up: z}}\n", {"this only what is written"}},
    {"  - {frame: 1010, set: {strata.2.to_m: 9}}\n",
     {"job.yaml:8:24: edits.0.set: an edit cannot add to strata"}},
    {"  - {frame: 1010, set: {strata.3.to_m: 9}}\n", {"3 is not one of the list's 2 items"}},
    {"  - {frame: 1010, set: {strata.0.to_m: 2e6}}\n", {"out of range"}},
    {"  - {frame: 1010, set: {strata.1.to_m: 3}}\n", {"strata.1.to_m: 3 m is not above the layer below"}},
    {"  - {frame: 1010, set: {sources.0.m3_per_yr: 3}}\n", {"an edit cannot add to sources"}},
    {"  - {frame: 1010, set: {sources.0.bed_m: 3}}\n", {"beds are taken out at the start"}},
    {"  - {frame: 1010, set: {wind.flow.solver: sph}}\n", {"an edit can change only reach_m, settled"}},
    {"  - {frame: 1010, set: [1]}\n", {"edits.0.set: a list where a mapping of key paths is expected"}},
    {"  - {frame: 1010, set: {wind.speed_m_s.x.y: 3}}\n", {"wind.speed_m_s"}},
    {"  - {frame: 1010, add: [{layer: 1}]}\n", {"job.yaml:8:25: edits.0.add.0.shape: missing"}},
    {"  - {frame: 1010, add: [{shape: {sphere: {center_m: [1, 1, 1], radius_m: 1}}, layer: 2}]}\n",
     {"edits.0.add.0.layer: 2 is not one of the 2 strata"}},
    {"  - {frame: 1010, carve: []}\n", {"edits.0.carve: a list where a mapping is expected, with one shape"}},
    {"  - {frame: 1010, carve: {stroke: {path_m: [], radius_m: 1}}}\n",
     {"edits.0.carve.stroke.path_m: no point"}},
    {"  - {frame: 1010, carve: {stroke: {radius_m: 1}}}\n", {"edits.0.carve.stroke: no point"}},
    {"  - {frame: 1010, carve: {stroke: {path_m: [[1, 2]], radius_m: 1}}}\n",
     {"path_m.0: a list of another length"}},
    {"  - {frame: 1010, paint: [{}]}\n", {"edits.0.paint.0: paints nothing"}},
    {"  - {frame: 1010, paint: [{noise: {}, falloff_m: 1}]}\n",
     {"paint.0.falloff_m: applies to a shape, and none is given"}},
    {"  - {frame: 1010, paint: [{noise: {}, vegetation: -0.5}]}\n", {"paint.0.vegetation: negative"}},
    {"  - {frame: 1010, paint: [{noise: 3}]}\n", {"paint.0.noise: a number where a mapping is expected"}},
    {"  - {frame: 1010, paint: [{image: {file: x, corner_m: [0, 0, 0], right_m: [1, 0, 0], up_m: [1, 0, "
     "1]}}]}\n",
     {"paint.0.image.up_m: not perpendicular to right_m"}},
    {"  - {frame: 1010, paint: [{image: {file: x, corner_m: [0, 0, 0], right_m: [0, 0, 0], up_m: [1, 0, "
     "1]}}]}\n",
     {"paint.0.image.right_m: is zero"}},
    {"  - {frame: 1010, paint: [{image: {file: '', corner_m: [0, 0, 0], right_m: [1, 0, 0], up_m: [0, 0, "
     "1]}}]}\n",
     {"paint.0.image.file: a file name is expected"}},
    {"  - {frame: 1010, set: {wind.speed_m_s: 3}}\nmodel: arches\n",
     {"job.yaml:8:3: edits: model: arches does not support edits"}},
    {"  - {frame: 1010, set: {wind.speed_m_s: 3}}\nsources: [{bed_m: 1}]\n",
     {"sources.0.bed_m: a bed needs points in path_m"}},
    {"  []\ncheckpoint: {mark: 1040}\n", {"checkpoint.mark: a number where a list of frames is expected"}},
    {"  []\ncheckpoint: {mark: [soon]}\n", {"checkpoint.mark.0: 'soon' is not a frame range"}},
};

static void what_cannot_be_is_refused_where_it_stands(void **state)
{
    (void)state;
    int bad = 0;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct job *job = NULL;
        status st = load_text(with(wrong[i].edits), &job);
        for (int k = 0; k < 2; k++)
            if (st != E_USAGE || (wrong[i].says[k] && !strstr(status_message(), wrong[i].says[k]))) {
                print_message("# %s# gives %d: %s\n", wrong[i].edits, st, st ? status_message() : "");
                bad++;
            }
        job_destroy(&job);
    }
    assert_int_equal(bad, 0);
}

static void too_many_edits_are_refused(void **state)
{
    (void)state;
    struct text t = {0};
    struct job *job = NULL;
    text_add(&t, "%s", head);
    for (int i = 0; i < 300; i++)
        text_add(&t, "  - {frame: 1010, set: {wind.speed_m_s: 3}}\n");
    assert_int_equal(load_text(t.data, &job), E_USAGE);
    assert_non_null(strstr(status_message(), "edits: 300 edits (at most 256)"));
    text_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_set_holds_from_its_frame_on),
        cmocka_unit_test(years_go_by_the_clock_of_each_frame),
        cmocka_unit_test(the_hash_sees_edits_and_not_how_they_are_written),
        cmocka_unit_test(the_hash_of_a_frame_sees_what_came_before),
        cmocka_unit_test(the_resolved_job_has_the_same_edits),
        cmocka_unit_test(set_on_the_command_line_reaches_edits),
        cmocka_unit_test(marks_are_frames_and_ranges),
        cmocka_unit_test(what_cannot_be_is_refused_where_it_stands),
        cmocka_unit_test(too_many_edits_are_refused),
    };
    return cmocka_run_group_tests_name("edits", tests, NULL, NULL);
}
