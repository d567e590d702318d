/* Rock of thin beds, and how far it retreats: down through them, and along them from a cliff. */
#ifndef HOODOO_TESTS_BEDS_H
#define HOODOO_TESTS_BEDS_H

#include "physics/model_help.h"

#include <math.h>

enum { FACE = 24, MARGIN = 2 }; /* m: where the cliff stands; and what of it at its foot and top never goes */

/* m: retreat of a cliff, or of level ground, of beds so thick, in a domain so high. */
static inline double retreat_of_beds(bool cliff, double thickness, double high, double h, int frames)
{
    char text[2048], inert[300] = "";
    const double middle = high - 2 * MARGIN;
    if (cliff)
        snprintf(
            inert, sizeof inert,
            "paint: [{shape: {box: {min_m: [-1, -1, -1], max_m: [99, 9, %d]}}, inert: true}, {shape: {box: "
            "{min_m: [-1, -1, %g], max_m: [99, 9, 999]}}, inert: true}]\n",
            MARGIN, high - MARGIN);
    snprintf(
        text, sizeof text,
        "hoodoo: 1\nname: beds\nframes: 1-%d\nclock: {years_per_frame: 2000}\n"
        "domain: {size_m: [%d, 4, %g], spacing_m: %g, sides: {x_min: wall, %sy_min: wall, y_max: wall}}\n"
        "rock: {gravity_m_s2: 0}\nwind: {abrasion: 0}\n"
        "scene: {box: {min_m: [-1, -1, 0], max_m: [%d, 5, %g]}}\n"
        "strata: [{weak_m_per_kyr: 0.1}]\n"
        "strata_from: [{thickness_m: %g, thickness_spread: 0.5, hardness_spread: 0.4}]\n%s",
        frames + 1, cliff ? FACE + 4 : 4, high, h, cliff ? "" : "x_max: wall, ", cliff ? FACE : 5, high,
        thickness, inert);
    struct sim s = sim_begin(text);
    double volume[2];
    for (int end = 0; end < 2; end++) {
        for (int f = 0; end && f < frames; f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        volume[end] = frame.volume_m3;
        frame_free(&frame);
    }
    sim_end(&s);
    return (volume[0] - volume[1]) / (cliff ? 4 * middle : 16);
}

/* All are within 5 % of the first, and of what time says that adds up across the beds; along them it is less. */
static inline void compare_retreats(double thickness, double high, const double *spacing, size_t n)
{
    static const int frames[] = {50, 40};
    for (int cliff = 0; cliff < 2; cliff++) {
        double first = 0;
        for (size_t i = 0; i < n; i++) {
            const double own = retreat_of_beds(cliff, thickness, high, spacing[i], frames[cliff]);
            const double alone = 0.1 * 2 * frames[cliff];
            first = i == 0 ? own : first;
            print_message(
                "# %s of %.0f beds, at %g m: %.3f m, %+.1f %% against %g m, %.2f of the stratum's\n",
                cliff ? "a cliff" : "ground", high / thickness, spacing[i], own, 100 * (own / first - 1),
                spacing[0], own / alone);
            assert_true(fabs(own / first - 1) < 0.05);
            assert_true(cliff ? own > 1.2 * alone : fabs(own / alone - 1) < 0.05);
        }
    }
}

#endif
