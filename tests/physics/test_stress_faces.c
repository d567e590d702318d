/* T where erosion feels it: at faces that do not follow the grid, against what is known. Particles within a spacing
 * of a face and three of them from any edge and the base are compared; those whose middle lies outside of the rock
 * with the face's T. */
#include "model_help.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/physics/stress_help.h"

/* The rock of a scene in a domain, solved. */
struct cut {
    struct sim sim;
    struct arenite *a;
    size_t n;
    double h;
    float *P, *t;
};

static struct cut cut(const char *scene, const char *size, double h)
{
    struct cut c = {.h = h};
    char text[2048];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: cut\nframes: 1-1\nclock: {years_per_frame: 1}\n"
             "domain: {size_m: %s, spacing_m: %g}\nstress: {tolerance: 0.001}\nscene:\n%s\n",
             size, h, scene);
    c.sim = sim_begin(text);
    c.a = arenite_of(c.sim.model);
    c.n = c.a->particles.n;
    c.P = malloc(c.n * 16);
    assert_non_null(c.P);
    assert_ok(gpu_download(c.sim.gpu, c.a->particles.field[ROCK_P], 0, c.P, c.n));
    c.t = stress_of(c.a);
    return c;
}

static void cut_end(struct cut *c)
{
    free(c->P);
    free(c->t);
    sim_end(&c->sim);
}

/* T that is expected at a place of the rock, where it is to be compared: inside by `depth` from the nearest face,
 * `edge` from the nearest edge. */
typedef double (*expected_at)(const void *with, const double x[3], double *depth, double *edge);

static void compare(const char *name, const struct cut *c, expected_at expected, const void *with,
                    double median, double p95)
{
    double *error = malloc((c->n + 1) * sizeof *error);
    size_t n = 0;
    assert_non_null(error);
    double scale = stress_p95(c->t, NULL, c->n);
    for (size_t i = 0; i < c->n; i++) {
        const double x[3] = {(double)c->P[4 * i], (double)c->P[4 * i + 1], (double)c->P[4 * i + 2]};
        double depth, edge, t = expected(with, x, &depth, &edge);
        if (depth <= c->h && edge > 3 * c->h)
            error[n++] = fabs((double)c->t[i] - t) / scale;
    }
    assert_true(n > 100);
    qsort(error, n, sizeof *error, stress_ascending);
    print_message(
        "# %s at %g m: T at %zu particles of its faces is off by %.1f %% (median), %.1f %% (95th) of T_p95 = "
        "%.0f Pa\n",
        name, c->h, n, 100 * error[n / 2], 100 * error[n * 95 / 100], scale);
    assert_true(error[n / 2] <= median);
    assert_true(error[n * 95 / 100] <= p95);
    free(error);
}

/* ---- a wedge under its own weight: each column carries itself (Levy's dam without water) */

enum { APEX = 44 };
#define SLOPE 0.4 /* metres across by metre down */

static double wedge_t(const void *with, const double x[3], double *depth, double *edge)
{
    double down = APEX - x[2], across = x[0] - 4, slant = (SLOPE * down - across) / sqrt(1 + SLOPE * SLOPE);
    (void)with;
    *depth = slant; /* the upright face follows the grid */
    *edge = fmin(fmin(x[1] - 4, 16 - x[1]),
                 fmin(across, x[2] - 16)); /* what holds the foot reaches up its width */
    return 2300 * 9.81 * fmax(down - across / SLOPE, 0);
}

static void wedge_carries_its_columns(void **state)
{
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        struct cut c = cut("  intersection:\n"
                           "    - box: {min_m: [4, 4, -1], max_m: [30, 16, 60]}\n"
                           "    - plane: {point_m: [4, 0, 44], normal: [1, 0, 0.4]}",
                           "[32, 20, 48]", fine ? 0.5 : 1);
        compare("wedge", &c, wedge_t, NULL, fine ? 0.03 : 0.05, fine ? 0.08 : 0.15);
        cut_end(&c);
    }
}

/* ---- a round hole in a thin, heavy plate ten times as wide: Kirsch's field, and what the weight's growth with depth
 * and the weight that the hole lacks add to it */

enum { HOLE_X = 52, HOLE_Z = 100, HOLE_RADIUS = 5, PLATE_TOP = 160 };

static double hole_t(const void *with, const double x[3], double *depth, double *edge)
{
    const double dx = x[0] - HOLE_X, dz = x[2] - HOLE_Z, r = fmax(hypot(dx, dz), HOLE_RADIUS),
                 turn = atan2(dz, dx), in = HOLE_RADIUS / r;
    const double kappa = (3 - 2.0 / 9) / (1 + 2.0 / 9), lacks = 1 - (kappa - 1) / (kappa + 1);
    (void)with;
    *depth = r - HOLE_RADIUS;
    *edge =
        r < 2 * HOLE_RADIUS ? INFINITY : 0; /* the plate is two cells thick: all of it is near its edges */
    return 2300 * 9.81 *
           ((PLATE_TOP - HOLE_Z) * (1 + 2 * in * in * cos(2 * turn)) - r * sin(turn) -
            HOLE_RADIUS * (in * in * in * sin(3 * turn) - lacks * in * sin(turn)));
}

static void hole_is_kirschs(void **state)
{
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        struct cut c = cut("  difference:\n"
                           "    - box: {min_m: [2, 2, -1], max_m: [102, 6, 160]}\n"
                           "    - cylinder: {from_m: [52, -1, 100], to_m: [52, 9, 100], radius_m: 5}",
                           "[104, 8, 164]", fine ? 0.5 : 1);
        compare("hole", &c, hole_t, NULL, fine ? 0.03 : 0.05, fine ? 0.08 : 0.15);
        cut_end(&c);
    }
}

/* ---- a block, turned about the vertical: as it stands unturned at half the spacing */

struct turned {
    double angle, h;
    int n[3]; /* lattice of the block that is not turned */
    float *t;
};

static double turned_t(const void *with, const double x[3], double *depth, double *edge)
{
    const struct turned *w = with;
    double c = cos(w->angle), s = sin(w->angle), dx = x[0] - 10, dy = x[1] - 10;
    double own[3] = {c * dx + s * dy, -s * dx + c * dy, x[2]}, side[2] = {5 - fabs(own[0]), 5 - fabs(own[1])};
    *depth = fmin(side[0], side[1]);
    *edge = fmin(fmax(side[0], side[1]), fmin(own[2], 30 - own[2]));
    int low[3];
    double f[3], t = 0;
    own[0] += 5;
    own[1] += 5;
    for (int a = 0; a < 3; a++) {
        double at = fmin(fmax(own[a] / w->h - 0.5, 0), w->n[a] - 1.001);
        low[a] = (int)at;
        f[a] = at - low[a];
    }
    for (int b = 0; b < 8; b++) {
        size_t at =
            (size_t)(((low[2] + (b >> 2)) * w->n[1] + low[1] + (b >> 1 & 1)) * w->n[0] + low[0] + (b & 1));
        t += (b & 1 ? f[0] : 1 - f[0]) * (b & 2 ? f[1] : 1 - f[1]) * (b & 4 ? f[2] : 1 - f[2]) *
             (double)w->t[at];
    }
    return t;
}

static struct turned unturned(double h)
{
    struct turned w = {.h = h, .n = {(int)(10 / h), (int)(10 / h), (int)(30 / h)}};
    struct cut c = cut("  box: {min_m: [5, 5, 0], max_m: [15, 15, 30]}", "[20, 20, 32]", h);
    w.t = calloc((size_t)w.n[0] * (size_t)w.n[1] * (size_t)w.n[2], sizeof *w.t);
    assert_non_null(w.t);
    for (size_t i = 0; i < c.n; i++) {
        int at[3] = {(int)(((double)c.P[4 * i] - 5) / h), (int)(((double)c.P[4 * i + 1] - 5) / h),
                     (int)((double)c.P[4 * i + 2] / h)};
        w.t[((size_t)at[2] * (size_t)w.n[1] + (size_t)at[1]) * (size_t)w.n[0] + (size_t)at[0]] = c.t[i];
    }
    cut_end(&c);
    return w;
}

static void turned_block_stands_as_unturned(void **state)
{
    (void)state;
    struct turned w = unturned(0.25);
    for (int fine = 0; fine < 2; fine++)
        for (int degrees = 0; degrees <= 45; degrees += 15) {
            char scene[256], name[64];
            snprintf(
                scene, sizeof scene,
                "  box: {min_m: [-5, -5, -1], max_m: [5, 5, 30], rotate_deg: [0, 0, %d], translate_m: [10, "
                "10, 0]}",
                degrees);
            snprintf(name, sizeof name, "block turned by %d", degrees);
            w.angle = degrees * acos(-1) / 180;
            struct cut c = cut(scene, "[20, 20, 32]", fine ? 0.5 : 1);
            compare(name, &c, turned_t, &w, fine ? 0.03 : 0.05, fine ? 0.08 : 0.15);
            cut_end(&c);
        }
    free(w.t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wedge_carries_its_columns),
        cmocka_unit_test(hole_is_kirschs),
        cmocka_unit_test(turned_block_stands_as_unturned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
