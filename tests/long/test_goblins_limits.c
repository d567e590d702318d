/* Goblins in the limit: from event to event, and with ever finer voxels, the cube becomes the same sphere. */
#include "../physics/model_help.h"
#include "../physics/surface.h"

#include <math.h>

static struct roundness weathered(double h, double quantum)
{
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: cube\nmodel: goblins\nframes: 1-1000\nclock: {years_per_frame: 150}\n"
             "domain: {size_m: [6, 6, 6], spacing_m: %g}\n"
             "scene: {box: {min_m: [1, 1, 1], max_m: [5, 5, 5]}}\n"
             "strata: [{weak_m_per_kyr: 1, bubble: {radius_m: 1}}]\n"
             "goblins: {floats: true, quantum: %g}\n",
             h, quantum);
    struct sim s = sim_begin(text);
    /* The same years, whatever the loss. */
    for (int f = 0; f < 20; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    struct surface surface = surface_of(&frame);
    struct roundness r = surface_roundness(&surface);
    print_message("# voxels of %g m, quantum %g: %.4f of the cube left, mean radius %.4f m, spread %.2f %%\n",
                  h, quantum, frame.volume_m3 / frame.start_volume_m3, r.mean,
                  100 * (r.most - r.least) / r.mean);
    frame_free(&frame);
    sim_end(&s);
    return r;
}

static void cycles_converge_to_events(void **state)
{
    (void)state;
    double events = weathered(0.2, 0).mean;
    static const double quantum[] = {1, 0.5, 0.25, 0.05};
    int right = 1;
    for (size_t i = 0; i < sizeof quantum / sizeof *quantum; i++)
        right &= fabs(weathered(0.2, quantum[i]).mean / events - 1) <= 0.03;
    assert_true(right);
}

static void finer_voxels_converge(void **state)
{
    (void)state;
    double middle = weathered(0.1, 0.5).mean, fine = weathered(0.0667, 0.5).mean;
    assert_true(fabs(middle / fine - 1) <= 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cycles_converge_to_events),
        cmocka_unit_test(finer_voxels_converge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
