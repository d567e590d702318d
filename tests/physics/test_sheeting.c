/* Sheets that come off where rock is in tension: a flat soffit becomes an arched one and stays; the same at two spacings, and nothing comes
 * off where sheeting is off, or rock withstands the tension. */
#include "effort.h"
#include "physics/model_help.h"

#include <string.h>

enum {
    WIDE = 30,
    DEEP = 3,
    HIGH = 18,
    LEG = 8,
    GAP = 6
}; /* m: a wall on two legs; the gap between them is GAP high */

struct soffit {
    double rise, span,
        late; /* m: of the middle above what was flat, how wide that has risen, and how far in the last 4 kyr */
    double lost, named; /* m3; and counted with blocks */
    bool arched;        /* it is higher towards its middle everywhere */
};

/* Height of the rock's underside over the gap, by metre of x, in the mean. */
static void undersides(const struct frame *f, double h, double under[WIDE])
{
    double lowest[4 * WIDE][4 * DEEP];
    for (int i = 0; i < 4 * WIDE; i++)
        for (int j = 0; j < 4 * DEEP; j++)
            lowest[i][j] = HIGH;
    for (size_t i = 0; i < f->rock.n; i++) {
        const float *P = &f->rock.P[4 * i];
        const int x = (int)((double)P[0] / h), y = (int)((double)P[1] / h);
        const double foot = (floor((double)P[2] / h) + 1 - (double)f->rock.viability[i]) * h;
        if (foot > 1)
            lowest[x][y] = fmin(lowest[x][y], foot);
    }
    const int in = (int)lround(1 / h);
    for (int x = 0; x < WIDE; x++) {
        under[x] = 0;
        for (int i = x * in; i < (x + 1) * in; i++)
            for (int j = 0; j < DEEP * in; j++)
                under[x] += lowest[i][j] / (DEEP * in * in);
    }
}

static struct soffit weather_wall(double h, int seed, int frames, const char *sheeting)
{
    char text[2048];
    double under[WIDE], before[WIDE] = {0};
    struct soffit out = {0};
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: wall\nframes: 1-%d\nseed: %d\nclock: {years_per_frame: 1000}\n"
             "domain: {size_m: [%d, %d, %d], spacing_m: %g, sides: {y_min: wall, y_max: wall}}\n"
             "strata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.1}]\nwind: {abrasion: 0, deflation: "
             "{intensity: 0}}\n"
             "scene: {difference: [{box: {min_m: [1, -1, 0], max_m: [%d, 99, %d]}}, {box: {min_m: [%d, -1, "
             "-1], max_m: "
             "[%d, 99, %d]}}]}\n%s\n",
             frames + 1, seed, WIDE, DEEP, HIGH + 2, h, WIDE - 1, HIGH, LEG, WIDE - LEG, GAP, sheeting);
    struct sim s = sim_begin(text);
    for (int f = 0; f <= frames; f++) {
        if (f > 0)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        if (f == 0)
            out.lost = frame.volume_m3;
        if (f == frames)
            out.lost -= frame.volume_m3;
        for (size_t i = 0; i < frame.n_changes; i++)
            out.named -= strcmp(frame.change[i].process, "blocks") == 0 ? frame.change[i].m3 : 0;
        undersides(&frame, h, under);
        if (f == frames - 4)
            memcpy(before, under, sizeof before);
        frame_free(&frame);
    }
    sim_end(&s);
    out.arched = true;
    for (int x = LEG; x < WIDE - LEG; x++) {
        const int inner = x < WIDE / 2 ? x + 1 : x - 1;
        out.arched &= under[inner] > under[x] - 0.25;
        out.rise = fmax(out.rise, under[x] - GAP);
        out.span += under[x] - GAP > 0.3;
        out.late = fmax(out.late, under[x] - before[x]);
    }
    print_message("# %g m, seed %d, {%s}: risen by %.2f m over %.0f of %d m (%.2f m in the last 4 kyr); %.1f "
                  "m3 lost, %.1f with blocks:",
                  h, seed, sheeting, out.rise, out.span, WIDE - 2 * LEG, out.late, out.lost, out.named);
    for (int x = LEG; x < WIDE - LEG; x++)
        print_message(" %.1f", under[x]);
    print_message("\n");
    return out;
}

static void a_flat_soffit_becomes_an_arch(void **state)
{
    (void)state;
    static const char on[] = "sheeting: {per_kyr: 1, thick_m: 0.8, wide_m: 2, strength_MPa: 0.02}",
                      strong[] = "sheeting: {per_kyr: 1, thick_m: 0.4, wide_m: 2, strength_MPa: 1}";
    const struct soffit fine = weather_wall(1.0 / 3, 1, 14, on), coarse = weather_wall(0.5, 1, 14, on),
                        other = weather_wall(0.5, 2, 14, on), off = weather_wall(1, 1, 6, ""),
                        held = weather_wall(1, 1, 6, strong);
    assert_true(fine.rise > 4 && fine.span > 10 && fine.arched);
    assert_true(fabs(coarse.rise / fine.rise - 1) < 0.08 && fabs(coarse.span - fine.span) <= 1 &&
                coarse.arched);
    assert_true(fabs(other.rise / coarse.rise - 1) < 0.08 && other.arched);
    assert_true(fine.late < 0.1 && coarse.late < 0.1);
    assert_true(fabs(fine.named / fine.lost - 1) < 1e-5);
    assert_true(off.rise == 0 && fabs(off.lost) < 1e-6 && held.rise == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_flat_soffit_becomes_an_arch)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
