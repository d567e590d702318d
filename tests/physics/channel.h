/* A river that falls over a step in its bed, at some spacing: how wide its channel is, and how far the step has gone upstream. */
#ifndef HOODOO_TESTS_CHANNEL_H
#define HOODOO_TESTS_CHANNEL_H

#include "model_help.h"

#include <math.h>

struct channel {
    double depth; /* m: of its deepest cut, above the step */
    double width; /* m: of a cut of that depth with the same section */
    double knick; /* m: that the step's deeper cut has gone upstream, in its own height */
};

enum {
    CHANNEL_X = 56,
    CHANNEL_Y = 24,
    CHANNEL_Z = 18,
    CHANNEL_STEP = 44,
    CHANNEL_LOW = 8,
    CHANNEL_HIGH = 24
};

/* m: height of the rock, by metre: the mean of its columns. */
static inline void channel_heights(struct sim *s, double h, double z[CHANNEL_X][CHANNEL_Y])
{
    struct frame frame = sim_output(s);
    for (int x = 0; x < CHANNEL_X; x++)
        for (int y = 0; y < CHANNEL_Y; y++)
            z[x][y] = 0;
    for (size_t i = 0; i < frame.rock.n; i++) {
        const double part = (double)frame.rock.viability[i] * h * fmin(h, 1) * fmin(h, 1);
        const int n = h > 1 ? (int)h : 1; /* metres that a voxel is wide */
        const int x = (int)(frame.rock.P[4 * i] / (float)n) * n,
                  y = (int)(frame.rock.P[4 * i + 1] / (float)n) * n;
        for (int a = 0; a < n * n; a++)
            z[x + a % n][y + a / n] += part;
    }
    frame_free(&frame);
}

static inline struct channel channel_of(double h)
{
    enum { FRAMES = 6 };
    static double before[CHANNEL_X][CHANNEL_Y], z[CHANNEL_X][CHANNEL_Y];
    struct channel c = {0};
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: channel\nframes: 1-%d\nseed: 5\nclock: {years_per_frame: 1000}\n"
             "domain: {size_m: [%d, %d, %d], spacing_m: %g, sides: {x_min: wall, y_min: wall, y_max: wall}}\n"
             "rock: {gravity_m_s2: 0}\nstrata: [{weak_m_per_kyr: 0.2}]\n"
             "wind: {abrasion: 0, deflation: {intensity: 0}}\n"
             "scene: {union: [{intersection: [{plane: {point_m: [0, 0, 15], normal: [0.06, 0, 1]}},\n"
             "  {box: {min_m: [0, 0, 0], max_m: [%d, %d, 18]}}]},\n"
             "  {plane: {point_m: [%d, 0, 8], normal: [0.06, 0, 1]}}]}\n"
             "sources: [{path_m: [[3, 12, 15]], m3_per_yr: 1e6}]\n"
             "rain: {erosion: 0.05, threshold_Pa: 0}\n",
             FRAMES + 1, CHANNEL_X, CHANNEL_Y, CHANNEL_Z, h, CHANNEL_STEP, CHANNEL_Y, CHANNEL_STEP);
    struct sim s = sim_begin(text);
    channel_heights(&s, h, before);
    for (int i = 0; i < FRAMES; i++)
        assert_ok(model_step(s.model));
    channel_heights(&s, h, z);
    sim_end(&s);
    for (int x = CHANNEL_LOW; x < CHANNEL_STEP; x++) {
        double deepest = 0, section = 0;
        for (int y = 0; y < CHANNEL_Y; y++) {
            deepest = fmax(deepest, before[x][y] - z[x][y]);
            section += before[x][y] - z[x][y];
        }
        if (x < CHANNEL_HIGH) {
            c.depth += deepest / (CHANNEL_HIGH - CHANNEL_LOW);
            c.width += section / deepest / (CHANNEL_HIGH - CHANNEL_LOW);
        } else {
            c.knick += (deepest - c.depth) / (15 - 8);
        }
    }
    print_message(
        "# at %g m: the channel is %.2f m deep and %.2f m wide, the step has gone %.2f m upstream\n", h,
        c.depth, c.width, c.knick);
    return c;
}

/* As wide as water spreads: a stream of 1e6 m3/yr is 4 m wide (rain.width_m), over a disc whose weights fall to 0 at its rim, and
 * it cuts as the 0.6th power of what runs there. */
static inline void channels_are_the_same(double coarse, double fine)
{
    const struct channel a = channel_of(coarse), b = channel_of(fine);
    assert_true(a.depth > 1 && a.knick > 4);
    assert_true(fabs(a.depth / b.depth - 1) < 0.08);
    assert_true(fabs(a.width / b.width - 1) < 0.1 && fabs(b.width / 4.72 - 1) < 0.1);
    assert_true(fabs(a.knick / b.knick - 1) < 0.1);
}

#endif
