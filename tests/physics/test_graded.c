/* A strip of rock in the rain, between walls, above a sill that nothing cuts: its profile against the law in one dimension, by
 * plain C, and the slope-area exponent of what it has become against the law's own. The strip is narrower than a stream, for rain
 * on a wider one gathers into rills; the water runs where it is lowest. */
#include "model_help.h"

#include <math.h>
#include <string.h>

enum { LENGTH = 120, WIDTH = 2, YEARS = 14000, LAST = 4000 };
static const double TOP = 26, FALL = 0.15, SILL = 116, WEAK = 0.2, RATE = 5, PULL = 0.12, RAIN = 1;

/* m: height of the lowest column by metre along the strip. */
static void heights(struct sim *s, double z[LENGTH])
{
    struct frame frame = sim_output(s);
    double column[LENGTH][WIDTH] = {{0}};
    for (size_t i = 0; i < frame.rock.n; i++)
        column[(int)frame.rock.P[4 * i]][(int)frame.rock.P[4 * i + 1]] += (double)frame.rock.viability[i];
    frame_free(&frame);
    for (int x = 0; x < LENGTH; x++) {
        z[x] = column[x][0];
        for (int y = 1; y < WIDTH; y++)
            z[x] = fmin(z[x], column[x][y]);
    }
}

/* m/kyr: what the law takes at x m from the divide. */
static double law(double x, double slope)
{
    return WEAK * RATE * PULL * pow(RAIN * x, 0.6) * pow(fmax(slope, 0), 0.7);
}

/* The law alone: cells of half a metre, which give to the next lower one. */
static void plain(double kyr, double z[LENGTH])
{
    enum { CELLS = 2 * LENGTH, STEPS = 4000 };
    double fine[CELLS], next[CELLS];
    for (int i = 0; i < CELLS; i++)
        next[i] = fine[i] = TOP - FALL * (i + 0.5) / 2;
    for (int step = 0; step < STEPS; step++) {
        for (int i = 0; i + 1 < CELLS && (i + 0.5) / 2 < SILL; i++)
            next[i] = fine[i] - kyr / STEPS * law((i + 1) / 2.0, (fine[i] - fine[i + 1]) / 0.5);
        memcpy(fine, next, sizeof fine);
    }
    for (int x = 0; x < LENGTH; x++)
        z[x] = (fine[2 * x] + fine[2 * x + 1]) / 2;
}

/* The exponent of area in slope, where it falls by `fallen` in some time: n log S = log E - m log A. From 30 cells to a third of
 * the strip. */
static double exponent(const double z[LENGTH], const double fallen[LENGTH])
{
    double n = 0, a = 0, s = 0, aa = 0, as = 0;
    for (int x = 30 / WIDTH; x <= LENGTH / 3; x++) {
        const double slope = (z[x - 3] - z[x + 3]) / 6, area = log(x + 0.5);
        const double given = log(slope) - log(fallen[x]) / 0.7;
        n++;
        a += area;
        s += given;
        aa += area * area;
        as += area * given;
    }
    return -(as - a * s / n) / (aa - a * a / n);
}

static void grade(int years)
{
    double start[LENGTH], before[LENGTH], end[LENGTH], fallen[LENGTH], want[LENGTH], off = 0, most = 0;
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: strip\nframes: 1-%d\nseed: 5\nclock: {years_per_frame: %d}\n"
             "domain: {size_m: [%d, %d, 28], spacing_m: 1, sides: {x_min: wall, y_min: wall, y_max: wall}}\n"
             "rock: {gravity_m_s2: 0}\nstrata: [{weak_m_per_kyr: %g}]\n"
             "wind: {abrasion: 0, deflation: {intensity: 0}}\n"
             "scene: {plane: {point_m: [0, 0, %g], normal: [%g, 0, 1]}}\n"
             "paint: [{shape: {box: {min_m: [%g, 0, 0], max_m: [%d, %d, 28]}}, inert: true}]\n"
             "rain: {m_per_yr: %g, erosion: %g, threshold_Pa: 0, pull_Pa: %g}\n",
             YEARS / years + 1, years, LENGTH, WIDTH, WEAK, TOP, FALL, SILL, LENGTH, WIDTH, RAIN, RATE, PULL);
    struct sim s = sim_begin(text);
    heights(&s, start);
    for (int year = 0; year < YEARS; year += years) {
        if (year == YEARS - LAST)
            heights(&s, before);
        assert_ok(model_step(s.model));
    }
    heights(&s, end);
    sim_end(&s);
    plain(1e-3 * YEARS, want);
    for (int x = 0; x < LENGTH; x++) {
        fallen[x] = fmax(before[x] - end[x], 1e-3);
        before[x] = (before[x] + end[x]) / 2;
        most = fmax(most, start[x] - end[x]);
        off = x >= 5 && x < LENGTH / 2 ? fmax(off, fabs(end[x] - want[x])) : off;
        if (x % 20 == 5)
            print_message("# at %d m: from %.2f to %.2f m, the law alone to %.2f\n", x, start[x], end[x],
                          want[x]);
    }
    const double found = exponent(before, fallen);
    print_message("# %d years a frame: slope goes as area to the -%.3f (%.3f); differs by %.2f m where %.2f "
                  "m are taken\n",
                  years, found, 0.6 / 0.7, off, most);
    assert_true(fabs(found / (0.6 / 0.7) - 1) < 0.05);
    assert_true(most > 4 && off < 0.1 * most);
}

static void a_profile_is_graded_as_the_law_says(void **state)
{
    (void)state;
    grade(1000);
    grade(250);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_profile_is_graded_as_the_law_says)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
