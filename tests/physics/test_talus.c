/* A talus is the same whatever the length of a frame: as much lies there, however short its life, and as far off, however much
 * comes down at once; and a run resumed in it has the same bits. */
#include "model_help.h"

#include <string.h>

/* A wall that crumbles. */
static const char wall[] = "hoodoo: 1\n"
                           "name: wall\n"
                           "frames: 1-100\n"
                           "clock: {years_per_frame: %g}\n"
                           "domain: {size_m: [40, 32, 18], spacing_m: 1}\n"
                           "scene:\n"
                           "  union:\n"
                           "    - box: {min_m: [0, 0, 0], max_m: [40, 32, 3], inert: true}\n"
                           "    - box: {min_m: [0, 0, 3], max_m: [16, 32, 16]}\n"
                           "paint:\n"
                           "  - {shape: {box: {min_m: [-1, -1, -1], max_m: [13, 33, 20]}}, inert: true}\n"
                           "  - {shape: {box: {min_m: [-1, -1, 15], max_m: [17, 33, 20]}}, inert: true}\n"
                           "strata: [{weak_m_per_kyr: 0.25, strong_m_per_kyr: 0.25, interlock_MPa: 1000}]\n"
                           "wind: {abrasion: 0, deflation: {strength_MPa: 100}}\n"
                           "deposition: {viability: %g, repose_deg: 34}\n";

static void deposits_last_as_long_in_long_frames(void **state)
{
    double there[2] = {0}; /* m3, on average over the last 4 kyr: it comes in handfuls */
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        char text[2048];
        snprintf(text, sizeof text, wall, fine ? 250.0 : 1000.0, 0.1);
        struct sim s = sim_begin(text);
        for (int f = 0; f < (fine ? 40 : 10); f++) {
            assert_ok(model_step(s.model));
            if (f < (fine ? 24 : 6))
                continue;
            struct frame frame = sim_output(&s);
            for (size_t i = 0; i < frame.rock.n; i++)
                if (frame.rock.phase[i] == 1)
                    there[fine] += (double)frame.rock.viability[i] / (fine ? 16 : 4);
            frame_free(&frame);
        }
        sim_end(&s);
    }
    print_message("# of viability 0.1: %.1f m3 lie there with frames of 1,000 years, %.1f with 250\n",
                  there[0], there[1]);
    assert_true(there[0] < 1.2 * there[1] && there[1] < 1.2 * there[0]);
}

/* A cliff that comes down in three sheets of 860 m3, each at once. */
static const char sheets[] = "hoodoo: 1\n"
                             "name: sheets\n"
                             "frames: 1-100\n"
                             "seed: 3\n"
                             "clock: {years_per_frame: %g}\n"
                             "domain: {size_m: [80, 32, 36], spacing_m: 1}\n"
                             "scene:\n"
                             "  union:\n"
                             "    - box: {min_m: [0, 0, 0], max_m: [80, 32, 4], inert: true}\n"
                             "    - box: {min_m: [0, 0, 4], max_m: [30, 32, 32]}\n"
                             "paint:\n"
                             "  - {shape: {box: {min_m: [-1, -1, -1], max_m: [27, 33, 40]}}, inert: true}\n"
                             "  - {shape: {box: {min_m: [-1, -1, 31], max_m: [31, 33, 40]}}, inert: true}\n"
                             "strata: [{weak_m_per_kyr: 0.25, strong_m_per_kyr: 0.25, interlock_MPa: 1000}]\n"
                             "wind: {abrasion: 0, deflation: {strength_MPa: 100}}\n"
                             "deposition: {viability: 1, repose_deg: 34}\n";

static void what_comes_down_at_once_lies_as_if_it_had_come_bit_by_bit(void **state)
{
    double lies[2];
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        char text[2048];
        snprintf(text, sizeof text, sheets, fine ? 250.0 : 1000.0);
        struct sim s = sim_begin(text);
        for (int f = 0; f < (fine ? 52 : 13); f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        lies[fine] = (double)frame.ledger.deposit;
        frame_free(&frame);
        sim_end(&s);
    }
    print_message("# after 13 kyr %g m3 lie there with frames of 1,000 years, %g with 250\n", lies[0],
                  lies[1]);
    assert_true(lies[0] < 1.15 * lies[1] && lies[1] < 1.15 * lies[0]);
}

static void runs_with_all_of_it_resume_with_the_same_bits(void **state)
{
    char text[2048];
    struct checkpoint half, whole, again;
    struct model *resumed;
    (void)state;
    snprintf(text, sizeof text, wall, 1000.0, 0.1);
    struct sim s = sim_begin(text);
    for (int f = 0; f < 6; f++) {
        assert_ok(model_step(s.model));
        if (f == 3)
            assert_ok(model_save(s.model, &half));
    }
    assert_ok(model_save(s.model, &whole));
    assert_ok(model_create(s.gpu, s.job, &half, &resumed));
    for (int f = 0; f < 2; f++)
        assert_ok(model_step(resumed));
    assert_ok(model_save(resumed, &again));
    assert_same_state(&whole, &again);
    model_destroy(&resumed);
    checkpoint_free(&half);
    checkpoint_free(&whole);
    checkpoint_free(&again);
    sim_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(deposits_last_as_long_in_long_frames),
        cmocka_unit_test(what_comes_down_at_once_lies_as_if_it_had_come_bit_by_bit),
        cmocka_unit_test(runs_with_all_of_it_resume_with_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
