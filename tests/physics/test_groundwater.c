/* Groundwater in rock: where it comes out, how much, and what it wears away. */
#include "physics/model_help.h"

#include <math.h>

#include "model/arenite.h"

/* A cliff 30 m deep and 4 m wide on shale, 4 m high; nothing wears but what seepage takes. `more`: further keys. */
static struct sim cliff(double h, double years, const char *more)
{
    char text[2048];
    snprintf(
        text, sizeof text,
        "hoodoo: 1\nname: cliff\nframes: 1-99\nclock: {years_per_frame: %g}\n"
        "domain: {size_m: [34, 4, 10], spacing_m: %g, sides: {x_min: wall, y_min: wall, y_max: wall}}\n"
        "rock: {gravity_m_s2: 0}\nwind: {abrasion: 0, deflation: {intensity: 0}}\n"
        "scene: {union: [{box: {min_m: [-1, -1, 0], max_m: [99, 9, 4]}}, {box: {min_m: [-1, -1, 4], max_m: "
        "[30, 9, 8]}}]}\n"
        "strata: [{to_m: 4, weak_m_per_kyr: 0.5, conductivity_m_per_yr: 0}, {weak_m_per_kyr: 0.5}]\n%s",
        years, h, more);
    return sim_begin(text);
}

static const char seeping[] = "groundwater: {recharge_m_per_yr: 0.02, sapping: 5}\n";

static void step_for(struct sim *s, double kyr)
{
    for (double t = 0; t < kyr - 1e-9; t += s->job->clock.years_per_frame / 1000)
        assert_ok(model_step(s->model));
}

static const struct groundwater_sums *sums_of(const struct sim *s)
{
    return &arenite_of(s->model)->groundwater.columns.sums;
}

static double out_of(const struct groundwater_sums *g)
{
    return g->faces + g->sides + g->tops + g->ceilings + g->deep;
}

/* Rain on 30 m of rock comes out of its face: through 2 m of it, right on the shale. */
static void it_comes_out_right_above_the_bed(void **state)
{
    (void)state;
    for (double h = 1; h >= 0.5; h /= 2) {
        struct sim s = cliff(h, 100, seeping);
        struct frame frame = sim_output(&s);
        double least = HUGE_VAL, most = 0, flux = 0, lowest = HUGE_VAL, highest = 0;
        for (size_t i = 0; i < frame.rock.n; i++) {
            const double q = (double)frame.rock.seepage[i], z = (double)frame.rock.P[4 * i + 2];
            if (q <= 0)
                continue;
            assert_true(frame.rock.P[4 * i] > 30 - h);
            least = fmin(least, q);
            most = fmax(most, q);
            lowest = fmin(lowest, z);
            highest = fmax(highest, z);
            flux += q * h * h;
        }
        print_message("# %g m: %.4f to %.4f m/yr between %.2f and %.2f m, %.4f m3/yr; sums %.6f of %.6f\n", h,
                      least, most, lowest, highest, flux, out_of(sums_of(&s)), sums_of(&s)->recharge);
        assert_true(fabs(least / 0.3 - 1) < 1e-3 && fabs(most / 0.3 - 1) < 1e-3);
        assert_true(lowest > 4 && lowest < 4 + h && highest < 6 && highest > 6 - h);
        assert_true(fabs(flux / (0.02 * 30 * 4) - 1) < 1e-3);
        assert_true(fabs(out_of(sums_of(&s)) / sums_of(&s)->recharge - 1) < 1e-4);
        frame_free(&frame);
        sim_end(&s);
    }
}

static double worn(double h, double years, double kyr, const char *more)
{
    struct sim s = cliff(h, years, more);
    struct frame before = sim_output(&s);
    step_for(&s, kyr);
    struct frame after = sim_output(&s);
    const double gone = before.volume_m3 - after.volume_m3;
    frame_free(&before);
    frame_free(&after);
    sim_end(&s);
    return gone;
}

/* The wet zone, 2 m high, retreats by weak * sapping * q, and q by what is left of the rock behind it: x = 30 (1 - exp(-weak sapping recharge t / zone)). What is above does not fall,
 * but no rain on it comes to the bed any more. At any spacing and step. */
static void sapping_is_the_same_at_any_spacing_and_step(void **state)
{
    static const double spacing[] = {1, 0.5, 0.5}, years[] = {1000, 1000, 250};
    const double expected = 2 * 4 * 30 * (1 - exp(-0.5 * 5 * 0.02 / 2 * 8));
    double volume[3];
    (void)state;
    for (size_t r = 0; r < 3; r++) {
        volume[r] = worn(spacing[r], years[r], 8, seeping);
        print_message("# %g m, %g years: %.2f m3; the law says %.2f\n", spacing[r], years[r], volume[r],
                      expected);
    }
    for (size_t r = 0; r < 3; r++) {
        assert_true(fabs(volume[r] / expected - 1) < 0.1);
        assert_true(fabs(volume[r] / volume[0] - 1) < 0.1);
    }
}

/* Without rain that sinks in, without a bed that holds it, and below the threshold nothing is worn. */
static void without_seepage_nothing_is_worn(void **state)
{
    static const char *const off[] = {
        "", "groundwater: {sapping: 5}\n",
        "groundwater: {recharge_m_per_yr: 0.02, sapping: 5, threshold_m_per_yr: 0.31}\n",
        "groundwater: {recharge_m_per_yr: 0.02, conductivity_m_per_yr: 0.01, sapping: 5}\n",
        "groundwater: {recharge_m_per_yr: 0.02, sapping: 5}\n"
        "edits: [{frame: 2, set: {groundwater.recharge_m_per_yr: 0}}]\n"};
    (void)state;
    for (size_t i = 0; i < sizeof off / sizeof *off; i++) {
        const double gone = worn(1, 500, 1, off[i]);
        print_message("# %zu: %g m3\n", i, gone);
        assert_true(gone == 0);
    }
    struct sim s = cliff(1, 500, "");
    struct frame frame = sim_output(&s);
    assert_null(frame.rock.seepage);
    frame_free(&frame);
    sim_end(&s);
}

/* Beds that dip, one that ends, a cave and open sides: as much comes out as sinks in, frame after frame. */
static void recharge_is_conserved(void **state)
{
    (void)state;
    struct sim s = sim_begin("hoodoo: 1\nname: land\nframes: 1-99\nclock: {years_per_frame: 1000}\n"
                             "domain: {size_m: [40, 36, 30], spacing_m: 1, sides: {x_min: wall}}\n"
                             "scene: {difference: [{union: [{box: {min_m: [-1, 3, 0], max_m: [36, 99, 12]}}, "
                             "{box: {min_m: [-1, 3, 12], "
                             "max_m: [28, 30, 28]}}]}, {sphere: {center_m: [28, 20, 12], radius_m: 5}}]}\n"
                             "strata: [{to_m: 5}, {to_m: 6, conductivity_m_per_yr: 0}, {to_m: 14}, {to_m: "
                             "15, conductivity_m_per_yr: "
                             "0.001}, {to_m: 40, conductivity_m_per_yr: 4}]\n"
                             "attitude: {dip_deg: 8, dip_azimuth_deg: 30, faults: [{point_m: [12, 15, 10], "
                             "strike_deg: 80, throw_m: 4}], "
                             "folds: [{wavelength_m: 25, amplitude_m: 1}]}\n"
                             "groundwater: {recharge_m_per_yr: 0.05, sapping: 1}\nrock: {gravity_m_s2: 0}\n");
    for (int f = 0; f < 4; f++) {
        const struct groundwater_sums *g = sums_of(&s);
        print_message(
            "# %.4f m3/yr sink in; %.4f faces, %.4f sides, %.4f tops, %.4f ceilings, %.4f deep; %d rounds, "
            "%.1e left\n",
            g->recharge, g->faces, g->sides, g->tops, g->ceilings, g->deep, g->rounds, g->left);
        assert_true(g->recharge > 10 && g->faces > 0 && g->sides > 0 && g->deep > 0);
        assert_true(fabs(out_of(g) / g->recharge - 1) < 1e-4);
        assert_ok(model_step(s.model));
    }
    sim_end(&s);
}

/* Rock that stress holds goes where water has weakened it. */
static void wet_rock_is_weaker(void **state)
{
    static const char *const strength[] = {"0", "0.8"};
    double rate[2];
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        char text[1500];
        snprintf(
            text, sizeof text,
            "hoodoo: 1\nname: wall\nframes: 1-9\nclock: {years_per_frame: 100}\n"
            "domain: {size_m: [14, 6, 32], spacing_m: 1, sides: {x_min: wall, y_min: wall, y_max: wall}}\n"
            "scene: {box: {min_m: [-1, -1, 0], max_m: [10, 9, 30]}}\n"
            "strata: [{to_m: 1, conductivity_m_per_yr: 0}, {weak_m_per_kyr: 1, strong_m_per_kyr: 0.01, "
            "interlock_MPa: 0.3}]\nwind: {abrasion: 0}\n"
            "groundwater: {recharge_m_per_yr: 0.02, weakening: %s}\n",
            strength[i]);
        struct sim s = sim_begin(text);
        struct frame frame = sim_output(&s);
        rate[i] = 0;
        for (size_t p = 0; p < frame.rock.n; p++)
            if (frame.rock.seepage[p] > 0)
                rate[i] = fmax(rate[i], (double)frame.rock.erodibility[p]);
        frame_free(&frame);
        sim_end(&s);
    }
    print_message("# wet rock erodes at %.3f m/kyr at most, weakened at %.3f\n", rate[0], rate[1]);
    assert_true(rate[0] < 0.1 && rate[1] > 0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_comes_out_right_above_the_bed),
        cmocka_unit_test(sapping_is_the_same_at_any_spacing_and_step),
        cmocka_unit_test(without_seepage_nothing_is_worn),
        cmocka_unit_test(recharge_is_conserved),
        cmocka_unit_test(wet_rock_is_weaker),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
