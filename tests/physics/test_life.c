/* Life apart from fill, and honest steps: what lasts less long weighs as much; what is fast is not cut short by the length of a
 * frame, nor by the spacing; what slides comes to rest within a step; and loose ground does not hang on rock. The talus itself: test_talus.c. */
#include "model_help.h"

#include <math.h>

/* The frame that a job shows after so many more. */
static struct frame after(const char *text, int frames)
{
    struct sim s = sim_begin(text);
    for (int f = 0; f < frames; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    sim_end(&s);
    return frame;
}

static double volume_after(const char *text, int frames)
{
    struct frame frame = after(text, frames);
    double volume = frame.volume_m3;
    frame_free(&frame);
    return volume;
}

/* ---- life and fill */

/* A block, the upper half of which is painted. */
static const char block[] = "hoodoo: 1\n"
                            "name: block\n"
                            "frames: 1-100\n"
                            "clock: {years_per_frame: 500}\n"
                            "domain: {size_m: [16, 16, 16], spacing_m: 1}\n"
                            "scene: {box: {min_m: [0, 0, 0], max_m: [16, 16, 12]}}\n"
                            "paint:\n"
                            "  - {shape: {box: {min_m: [-1, -1, 6], max_m: [17, 17, 17]}}, viability: %g}\n"
                            "  - {shape: {difference: [box: {min_m: [-1, -1, -1], max_m: [17, 17, 17]}, box: "
                            "{min_m: [3, 3, 3], max_m: [13, 13, 13]}]}, inert: true}\n"
                            "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.2, interlock_MPa: 1000}]\n"
                            "wind: {abrasion: 0, deflation: {strength_MPa: 1000}}\n";

static void a_short_life_is_no_hole(void **state)
{
    static const double life[] = {1, 0.5, 0.1};
    double lost[3], stress[3], start[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        char text[2048];
        snprintf(text, sizeof text, block, life[i]);
        struct frame frame = after(text, 0);
        start[i] = frame.volume_m3;
        stress[i] = frame.max_stress_Pa;
        for (size_t p = 0; p < frame.rock.n; p++)
            assert_true(frame.rock.viability[p] == 1);
        frame_free(&frame);
        lost[i] = start[i] - volume_after(text, 1);
        print_message("# life %g: %g m3 at first, T up to %.4g MPa, %.3f m3 lost in 500 years\n", life[i],
                      start[i], stress[i] / 1e6, lost[i]);
    }
    for (int i = 1; i < 3; i++) {
        assert_true(start[i] == start[0] && stress[i] == stress[0]); /* the same weight and stiffness */
        assert_true(fabs(lost[i] * life[i] / lost[0] - 1) < 0.02);
    }
}

/* ---- steps */

/* A bar between an inert half and the air, painted fast. */
static const char bar[] = "hoodoo: 1\n"
                          "name: bar\n"
                          "frames: 1-100\n"
                          "clock: {years_per_frame: %g}\n"
                          "domain: {size_m: [24, 8, 8], spacing_m: %g}\n"
                          "scene: {box: {min_m: [2, 0, 0], max_m: [22, 8, 8]}}\n"
                          "paint:\n"
                          "  - {shape: {box: {min_m: [-1, -1, -1], max_m: [10, 9, 9]}}, inert: true}\n"
                          "  - {shape: {box: {min_m: [10, -1, -1], max_m: [25, 9, 9]}}, erodibility: %g}\n"
                          "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.2, interlock_MPa: 1000}]\n"
                          "wind: {abrasion: 0, deflation: {strength_MPa: 1000}}\n";

static void what_is_painted_fast_is_as_fast_in_long_frames(void **state)
{
    static const struct {
        double factor, spacing;
    } of[] = {{8, 1}, {8, 0.5}, {20, 1}};
    double left[3][2];
    (void)state;
    for (int i = 0; i < 3; i++) {
        for (int fine = 0; fine < 2; fine++) {
            char text[2048];
            snprintf(text, sizeof text, bar, fine ? 100.0 : 1000.0, of[i].spacing, of[i].factor);
            left[i][fine] = volume_after(text, fine ? 10 : 1) / (20.0 * 8 * 8);
        }
        print_message(
            "# %g times as fast, at %g m: %.4f left after one frame of 1,000 years, %.4f after ten\n",
            of[i].factor, of[i].spacing, left[i][0], left[i][1]);
        assert_true(fabs(left[i][0] / left[i][1] - 1) < 0.03);
    }
    assert_true(fabs(left[0][0] / left[1][0] - 1) < 0.05);
}

/* ---- slides */

/* A block on a plain; and a wall with nothing, or a talus, at its foot. Nothing erodes. */
static const char still[] = "hoodoo: 1\n"
                            "name: still\n"
                            "frames: 1-100\n"
                            "clock: {years_per_frame: %g}\n"
                            "domain: {size_m: [48, 16, 32], spacing_m: 1, particles: all}\n"
                            "scene:\n"
                            "  union:\n"
                            "    - box: {min_m: [0, 0, 0], max_m: [48, 16, 2]}\n"
                            "%s"
                            "strata: [{weak_m_per_kyr: 0, strong_m_per_kyr: 0}]\n"
                            "wind: {abrasion: 0}\n"
                            "deposition: {viability: 0.5, repose_deg: 34}\n";
static const char mound[] = "    - box: {min_m: [20, 0, 2], max_m: [28, 16, 14]}\n";
static const char cliff[] = "    - box: {min_m: [0, 0, 0], max_m: [20, 16, 30]}\n";
static const char with_talus[] = "    - box: {min_m: [0, 0, 0], max_m: [20, 16, 30]}\n"
                                 "    - intersection:\n"
                                 "        - box: {min_m: [20, 0, 2], max_m: [48, 16, 30]}\n"
                                 "        - plane: {point_m: [20, 8, 18], normal: [0.6, 0, 1]}\n";

/* That job, with all rock beyond x = 20 m and over z = 2 m turned into deposits if it is to be loose. */
static struct sim stand(const char *what, double years, bool loose)
{
    char text[2048];
    struct checkpoint c;
    snprintf(text, sizeof text, still, years, what);
    struct sim s = sim_begin(text);
    if (!loose)
        return s;
    assert_ok(model_save(s.model, &c));
    const float *P = checkpoint_find(&c, "P", 4)->data;
    const struct checkpoint_section *phase = checkpoint_find(&c, "phase", 4);
    uint64_t *ledger = checkpoint_find(&c, "ledger", 8)->data; /* start, rock, deposit */
    for (size_t p = 0; p < phase->n; p++)
        if (P[4 * p] > 20 && P[4 * p + 2] > 2) {
            ((uint32_t *)phase->data)[p] = 1;
            ledger[1]--;
            ledger[2]++;
        }
    model_destroy(&s.model);
    assert_ok(model_create(s.gpu, s.job, &c, &s.model));
    checkpoint_free(&c);
    return s;
}

static void slides_come_to_rest_within_a_step(void **state)
{
    double lies[2][2] = {{0}}; /* mean height over the plain, and distance from the middle, m */
    (void)state;
    for (int often = 0; often < 2; often++) {
        double n = 0;
        struct sim s = stand(mound, often ? 200 : 1000, true);
        for (int f = 0; f < (often ? 5 : 1); f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        for (size_t i = 0; i < frame.rock.n; i++) {
            const float *P = &frame.rock.P[4 * i];
            if (frame.rock.phase[i] != 1)
                continue;
            lies[often][0] += (double)P[2] - 2;
            lies[often][1] += fabs((double)P[0] - 24);
            n++;
        }
        lies[often][0] /= n;
        lies[often][1] /= n;
        print_message(
            "# a block of deposits, 8 m wide and 12 high, after %d of 1,000 years: middle %.2f m over the "
            "plain, %.2f m off\n",
            often ? 5 : 1, lies[often][0], lies[often][1]);
        frame_free(&frame);
        sim_end(&s);
    }
    assert_true(lies[0][0] < 4.5 && lies[0][1] > 3); /* 6 and 2 at first */
    assert_true(fabs(lies[1][0] / lies[0][0] - 1) < 0.03 && fabs(lies[1][1] / lies[0][1] - 1) < 0.03);
}

/* ---- loose ground in the stress */

/* T in the cliff's face, MPa, on average. */
static double face(const char *what, bool loose)
{
    double sum = 0, n = 0;
    struct sim s = stand(what, 100, loose);
    assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    for (size_t p = 0; p < frame.rock.n; p++) {
        const float *P = &frame.rock.P[4 * p];
        if (P[0] < 16 || P[0] > 20 || P[2] < 4 || P[2] > 20)
            continue;
        sum += (double)frame.rock.stress[p] / 1e6;
        n++;
    }
    frame_free(&frame);
    sim_end(&s);
    return sum / n;
}

static void loose_ground_does_not_hang_on_rock(void **state)
{
    const double bare = face(cliff, false), rock = face(with_talus, false), loose = face(with_talus, true);
    (void)state;
    print_message("# the cliff's face over nothing: T %.4f MPa on average; over a talus of rock %.4f, of "
                  "deposits %.4f\n",
                  bare, rock, loose);
    assert_true(fabs(rock / bare - 1) > 0.1); /* or this would say nothing */
    assert_true(fabs(loose / bare - 1) < 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_short_life_is_no_hole),
        cmocka_unit_test(what_is_painted_fast_is_as_fast_in_long_frames),
        cmocka_unit_test(slides_come_to_rest_within_a_step),
        cmocka_unit_test(loose_ground_does_not_hang_on_rock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
