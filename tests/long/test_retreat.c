/* A face retreats at its rock's rate, whatever the spacing, the step, and the angle to the grid; and by the
 * wind as it stands. */
#include "physics/model_help.h"

#include <math.h>
#include <string.h>

struct wall {
    double h, normal[3]; /* normal: any length */
    double years_per_frame;
    int frames;
    double abrasion; /* 0: no wind */
    double wind[3];
    int screen; /* a screen of inert rock stands upwind */
};

enum { SIZE = 18 };              /* m, the domain's edges */
static const double patch = 3.5; /* m: half the patch that counts */
static const double middle = 9;

/* The mean retreat of the patch in the middle of a wall through the domain's middle, m. */
static double retreat(const struct wall *w)
{
    char text[2048];
    double n[3], length = sqrt(w->normal[0] * w->normal[0] + w->normal[1] * w->normal[1] +
                               w->normal[2] * w->normal[2]);
    for (int a = 0; a < 3; a++)
        n[a] = w->normal[a] / length;
    snprintf(text, sizeof text,
             "hoodoo: 1\n"
             "name: wall\n"
             "frames: 1-%d\n"
             "clock: {years_per_frame: %.17g}\n"
             "domain: {size_m: [%d, %d, %d], spacing_m: %.17g}\n"
             "rock: {gravity_m_s2: 0}\n"
             "scene:\n"
             "  union:\n"
             "    - plane: {point_m: [%g, %g, %g], normal: [%.17g, %.17g, %.17g]}\n"
             "%s"
             "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.002}]\n"
             "paint:\n" /* The domain's own sides do not erode. */
             "  - {shape: {difference: [box: {min_m: [-1, -1, -1], max_m: [19, 19, 19]}, box: {min_m: [1.5, "
             "1.5, 1.5], "
             "max_m: [16.5, 16.5, 16.5]}]}, inert: true}\n"
             "wind: {direction: [%g, %g, %g], abrasion: %g}\n",
             w->frames + 1, w->years_per_frame, SIZE, SIZE, SIZE, w->h, middle, middle, middle, n[0], n[1],
             n[2], w->screen ? "    - box: {min_m: [16, 0, 0], max_m: [17, 18, 18], inert: true}\n" : "",
             w->wind[0], w->wind[1], w->wind[2], w->abrasion);
    struct sim s = sim_begin(text);
    struct frame first = sim_output(&s);
    for (int f = 0; f < w->frames; f++)
        assert_ok(model_step(s.model));
    struct frame last = sim_output(&s);
    size_t n_ids = 0;
    for (size_t i = 0; i < first.rock.n; i++)
        n_ids = first.rock.id[i] >= n_ids ? first.rock.id[i] + 1u : n_ids;
    float *left = viability_by_id(&last.rock, n_ids);

    /* Two directions in the face. */
    double t[3], u[3], least = fabs(n[2]) < 0.9 ? 2 : 0;
    double up[3] = {least == 0, 0, least == 2};
    double d = n[0] * up[0] + n[1] * up[1] + n[2] * up[2], size = 0;
    for (int a = 0; a < 3; a++) {
        t[a] = up[a] - d * n[a];
        size += t[a] * t[a];
    }
    for (int a = 0; a < 3; a++)
        t[a] /= sqrt(size);
    u[0] = n[1] * t[2] - n[2] * t[1];
    u[1] = n[2] * t[0] - n[0] * t[2];
    u[2] = n[0] * t[1] - n[1] * t[0];
    double lost = 0;
    for (size_t i = 0; i < first.rock.n; i++) {
        const float *P = &first.rock.P[4 * i];
        double x[3] = {(double)P[0] - middle, (double)P[1] - middle, (double)P[2] - middle};
        double along_t = x[0] * t[0] + x[1] * t[1] + x[2] * t[2],
               along_u = x[0] * u[0] + x[1] * u[1] + x[2] * u[2];
        if (fabs(along_t) < patch && fabs(along_u) < patch && first.rock.rate_factor[i] > 0)
            lost += (double)(first.rock.viability[i] - left[first.rock.id[i]]);
    }
    free(left);
    frame_free(&first);
    frame_free(&last);
    sim_end(&s);
    return lost * pow(w->h, 3) / (4 * patch * patch);
}

static int expect(const char *what, double measured, double expected)
{
    double error = measured / expected - 1;
    print_message("# %s: %.3f m, expected %.3f (%+.1f %%)\n", what, measured, expected, 100 * error);
    return fabs(error) <= 0.05;
}

/* 0.2 m/kyr for 10 kyr: 2 m. */
static void walls_lose_two_metres_in_ten_thousand_years(void **state)
{
    static const struct {
        const char *name;
        double normal[3];
    } faces[] = {{"0 degrees", {1, 0, 0}},
                 {"30 degrees", {0.8660254, 0.5, 0}},
                 {"45 degrees", {0.70710678, 0.70710678, 0}},
                 {"the grid's diagonal", {1, 1, 1}},
                 {"an overhang", {0.6, 0.3, -0.7}}};
    static const double spacing[] = {0.5, 1.0 / 3, 0.25};
    int right = 1;
    (void)state;
    for (size_t f = 0; f < sizeof faces / sizeof *faces; f++)
        for (size_t h = 0; h < sizeof spacing / sizeof *spacing; h++) {
            /* One step of erosion a frame on the coarse lattice, more on the fine ones; and frames of many.
             * */
            static const struct {
                double years;
                int frames;
            } clock[] = {{500, 20}, {2500, 4}};
            for (size_t c = 0; c < 2; c++) {
                struct wall w = {.h = spacing[h],
                                 .years_per_frame = clock[c].years,
                                 .frames = clock[c].frames,
                                 .wind = {1, 0, 0}};
                memcpy(w.normal, faces[f].normal, sizeof w.normal);
                char what[128];
                if ((c == 1 && h != 1) || (h == 2 && f > 1))
                    continue;
                snprintf(what, sizeof what, "%s, spacing %.3f m, %g years a frame", faces[f].name, w.h,
                         w.years_per_frame);
                right &= expect(what, retreat(&w), 2.0);
            }
        }
    assert_true(right);
}

static void wind_takes_more_from_the_faces_it_meets(void **state)
{
    const double k = 0.75;
    struct wall w = {.h = 0.5,
                     .normal = {1, 0, 0},
                     .years_per_frame = 500,
                     .frames = 10,
                     .abrasion = k,
                     .wind = {-1, 0, 0}};
    int right = 1;
    (void)state;
    right &= expect("across the wind", retreat(&w), 1.0 * (1 + k));
    w.screen = 1;
    right &= expect("across the wind, behind a screen", retreat(&w), 1.0);
    w.screen = 0;
    w.wind[0] = 1;
    right &= expect("in the lee", retreat(&w), 1.0);
    w.wind[0] = -0.5;
    w.wind[1] = 0.8660254;
    right &= expect("at 60 degrees to the wind", retreat(&w), 1.0 * (1 + k / 2));
    w.wind[0] = 0;
    w.wind[1] = 1;
    right &= expect("along the wind", retreat(&w), 1.0);
    assert_true(right);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walls_lose_two_metres_in_ten_thousand_years),
        cmocka_unit_test(wind_takes_more_from_the_faces_it_meets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
