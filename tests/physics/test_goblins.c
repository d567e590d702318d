/* Goblins: what bubbles make of a cube, that hard layers stand out and thin walls break, and that neither the
 * voxel's size nor a stop shows (Beardall et al. 2007, figures 7 and 8). */
#include "field/field.h"
#include "model_help.h"
#include "shape.h"
#include "surface.h"

#include <math.h>
#include <string.h>

/* A cube of 4 m in the air, with a bubble; more of `goblins`. */
static struct sim cube_of(const char *bubble, const char *goblins, double h, double weak)
{
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: cube\nmodel: goblins\nframes: 1-1000\nclock: {years_per_frame: 100}\n"
             "domain: {size_m: [6, 6, 6], spacing_m: %g}\n"
             "scene: {box: {min_m: [1, 1, 1], max_m: [5, 5, 5]}}\n"
             "strata: [{weak_m_per_kyr: %g, bubble: {%s}}]\n"
             "goblins: {floats: true, %s}\n",
             h, weak, bubble, goblins);
    return sim_begin(text);
}

/* The first frame with no more than this share of the start. */
static struct frame weather_to(struct sim *s, double share)
{
    for (;;) {
        struct frame frame = sim_output(s);
        if (frame.volume_m3 <= share * frame.start_volume_m3)
            return frame;
        frame_free(&frame);
        assert_ok(model_step(s->model));
    }
}

/* How far the surface is from the middle, m, on average towards the faces, edges and corners of the cube. */
static void reaches(const struct surface *s, double out[3])
{
    int n[3] = {0};
    memset(out, 0, 3 * sizeof *out);
    for (int c = 0; c < 27; c++) {
        const double d[3] = {c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1};
        const double axes = fabs(d[0]) + fabs(d[1]) + fabs(d[2]);
        if (axes < 1)
            continue;
        const int kind = (int)axes - 1;
        out[kind] += surface_reach(s, s->center,
                                   (const double[]){d[0] / sqrt(axes), d[1] / sqrt(axes), d[2] / sqrt(axes)});
        n[kind]++;
    }
    for (int kind = 0; kind < 3; kind++)
        out[kind] /= n[kind];
}

/* Years until a fifth of the cube is left, between frames. */
static double years_to_a_fifth(double h, double out[3])
{
    struct sim s = cube_of("radius_m: 1", "", h, 2);
    double before = 1, years = 0, left = 1, start;
    for (;; before = left) {
        struct frame frame = sim_output(&s);
        start = frame.start_volume_m3;
        left = frame.volume_m3 / start;
        years = frame.years;
        if (left <= 0.2) {
            struct surface surface = surface_of(&frame);
            reaches(&surface, out);
        }
        frame_free(&frame);
        if (left <= 0.2)
            break;
        assert_ok(model_step(s.model));
    }
    sim_end(&s);
    return years - 100 * (0.2 - left) / (before - left);
}

/* Figure 7b with the defaults: at two sizes of voxels, the same sphere in the same year. */
static void a_cube_becomes_a_sphere_by_itself(void **state)
{
    (void)state;
    double years[2], at[2][3], worst = 0;
    for (int fine = 0; fine < 2; fine++) {
        years[fine] = years_to_a_fifth(fine ? 0.1 : 0.2, at[fine]);
        print_message(
            "# voxels of %g m: a fifth is left after %.0f years; edges %.3f and corners %.3f times as "
            "far as faces\n",
            fine ? 0.1 : 0.2, years[fine], at[fine][1] / at[fine][0], at[fine][2] / at[fine][0]);
        for (int kind = 1; kind < 3; kind++)
            worst = fmax(worst, fabs(at[fine][kind] / at[fine][0] - 1));
    }
    assert_true(worst <= 0.05);
    assert_true(fabs(years[0] / years[1] - 1) <= 0.06);
}

static void a_cube_becomes_a_sphere(void **state)
{
    (void)state;
    struct sim s = cube_of("radius_m: 1", "threshold: 1", 0.1, 2);
    struct frame frame = weather_to(&s, 0.3);
    struct surface surface = surface_of(&frame);
    struct roundness r = surface_roundness(&surface);
    print_message("# %.3f of the cube left: sphericity %.4f, radii %.3f to %.3f m (spread %.2f %%)\n",
                  frame.volume_m3 / frame.start_volume_m3, r.sphericity, r.least, r.most,
                  100 * (r.most - r.least) / r.mean);
    frame_free(&frame);
    sim_end(&s);
    assert_true(r.sphericity >= 0.95 && r.sphericity <= 1.005);
    assert_true((r.most - r.least) / r.mean <= 0.04);
}

/* Height of the surface over (or under, side -1) a place, from the middle. */
static double height(const struct surface *s, double x, double y, double side)
{
    const double from[3] = {s->center[0] + x, s->center[1] + y, s->center[2]};
    return surface_reach(s, from, (const double[]){0, 0, side});
}

static void a_gumdrop_has_a_flat_base_and_a_round_top(void **state)
{
    (void)state;
    struct sim s = cube_of(
        "shape: gumdrop, radius_m: 1, stretch: [1, 1, 1.4], base: 0.2, offset: [0, 0, -0.1]", "", 0.1, 2);
    struct frame frame = weather_to(&s, 0.25);
    struct surface surface = surface_of(&frame);
    double wide = surface_reach(&surface, surface.center, (const double[]){1, 0, 0});
    double drop[2] = {0};
    for (int side = 0; side < 2; side++)
        for (int turn = 0; turn < 8; turn++) {
            double r = 0.7 * wide, a = turn * M_PI / 4, up = side ? 1 : -1;
            drop[side] += (height(&surface, 0, 0, up) - height(&surface, r * cos(a), r * sin(a), up)) / 8;
        }
    print_message("# half as wide as %.2f m; at 0.7 of that the base is %.3f m higher than in the middle and "
                  "the top %.3f m lower\n",
                  wide, drop[0], drop[1]);
    frame_free(&frame);
    sim_end(&s);
    assert_true(fabs(drop[0]) <= 0.01 * wide);
    assert_true(drop[1] >= 0.18 * wide);
    assert_true(drop[1] >= 10 * fabs(drop[0]));
}

static void a_rock_takes_its_bubbles_shape(void **state)
{
    (void)state;
    static const struct {
        const char *bubble;
        double low, high; /* height to width */
    } expected[] = {
        {"radius_m: 1", 0.97, 1.03},
        {"shape: ellipsoid, radius_m: 1, stretch: [0.7, 0.7, 1.4]", 1.1, 2},
        {"shape: ellipsoid, radius_m: 1, stretch: [1.4, 1.4, 0.7]", 0.5, 0.9},
    };
    int right = 1;
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        struct sim s = cube_of(expected[i].bubble, "skin_m: 0.125", 0.125, 2);
        struct frame frame = weather_to(&s, 0.2);
        struct surface surface = surface_of(&frame);
        double wide = surface_reach(&surface, surface.center, (const double[]){1, 0, 0}) +
                      surface_reach(&surface, surface.center, (const double[]){-1, 0, 0});
        double high = surface_reach(&surface, surface.center, (const double[]){0, 0, 1}) +
                      surface_reach(&surface, surface.center, (const double[]){0, 0, -1});
        print_message("# %s: %.2f m wide, %.2f m high, ratio %.3f\n", expected[i].bubble, wide, high,
                      high / wide);
        right &= high / wide >= expected[i].low && high / wide <= expected[i].high;
        frame_free(&frame);
        sim_end(&s);
    }
    /* Rain from above: the top goes first. */
    struct sim s = cube_of("radius_m: 0.8, offset: [0, 0, 0.5]", "threshold: 0", 0.125, 0.1);
    struct frame frame = weather_to(&s, 0.5);
    struct surface surface = surface_of(&frame);
    double lost_above = 5 - (surface.center[2] + height(&surface, 0, 0, 1));
    double lost_below = surface.center[2] - height(&surface, 0, 0, -1) - 1;
    print_message("# a bubble moved up by half its radius: %.2f m lost above, %.2f below\n", lost_above,
                  lost_below);
    right &= lost_above >= 3 * lost_below && lost_below >= 0;
    frame_free(&frame);
    sim_end(&s);
    assert_true(right);
}

/* 0.1 m/kyr for 5 kyr: half a metre, whatever the voxel's size, the bubble's, and the quantum. */
static void flat_faces_retreat_at_their_rate(void **state)
{
    (void)state;
    static const struct {
        double h;
        const char *bubble, *goblins;
    } walls[] = {
        {0.1, "radius_m: 0.4", "threshold: 0"},
        {0.05, "radius_m: 0.4", "threshold: 0"},
        {0.1, "radius_m: 0.4", "threshold: 0, quantum: 0.05"},
        {0.1, "radius_m: 0.7", "threshold: 0"},
        {0.1, "radius_m: 0.5", "threshold: 0, skin_m: 0.4, quantum: 1"},
        {0.1, "radius_m: 0.5", "threshold: 0.5"},
    };
    int right = 1;
    for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
        struct sim s = cube_of(walls[i].bubble, walls[i].goblins, walls[i].h, 0.1);
        for (int f = 0; f < 50; f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        struct surface surface = surface_of(&frame);
        const double goal = 0.5 * (1 - s.job->goblins.threshold);
        double lost = 2 - surface_reach(&surface, surface.center, (const double[]){1, 0, 0});
        print_message("# voxels of %g m, %s %s: %.3f m of %.3f\n", walls[i].h, walls[i].bubble,
                      walls[i].goblins, lost, goal);
        right &= fabs(lost - goal) <= 0.06;
        frame_free(&frame);
        sim_end(&s);
    }
    assert_true(right);
}

static struct sim cap_of(double h, const char *more)
{
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: cap\nmodel: goblins\nframes: 1-1000\nclock: {years_per_frame: 200}\n"
             "domain: {size_m: [5, 5, 6], spacing_m: %g}\n"
             "scene: {cylinder: {from_m: [2.5, 2.5, 0], to_m: [2.5, 2.5, 5.5], radius_m: 1.9}}\n"
             "strata:\n"
             "  - {to_m: 3.2, weak_m_per_kyr: 0.75, bubble: {radius_m: 0.4}}\n"
             "  - {weak_m_per_kyr: 0.105, bubble: {radius_m: 0.5}}\n"
             "goblins: {threshold: 0.8, skin_m: 0.2}\n%s",
             h, more);
    return sim_begin(text);
}

static double width_at(const struct surface *s, double z)
{
    const double from[3] = {2.5, 2.5, z};
    return surface_reach(s, from, (const double[]){1, 0, 0}) +
           surface_reach(s, from, (const double[]){-1, 0, 0});
}

static void a_cap_stands_on_a_neck(void **state)
{
    (void)state;
    struct sim s = cap_of(0.1, "");
    double neck = 9, cap = 0;
    for (int f = 0; f < 30; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    struct surface surface = surface_of(&frame);
    for (double z = 0.5; z < 5; z += 0.1) {
        if (z < 3)
            neck = fmin(neck, width_at(&surface, z));
        else if (z > 3.5)
            cap = fmax(cap, width_at(&surface, z));
    }
    print_message("# the neck is %.2f m wide, the cap %.2f: ratio %.2f; %llu voxels fell\n", neck, cap,
                  neck / cap, (unsigned long long)frame.ledger.fallen);
    assert_int_equal(frame.ledger.start, frame.ledger.rock + frame.ledger.fallen + frame.ledger.left);
    assert_int_equal(frame.ledger.rock, frame.rock.n);
    assert_true(neck > 0 && neck / cap <= 0.6);
    frame_free(&frame);
    /* Until the neck breaks: then the cap is in the ledger. */
    for (int f = 0; f < 60 && frame.ledger.fallen < 1000; f++) {
        frame_free(&frame);
        assert_ok(model_step(s.model));
        frame = sim_output(&s);
    }
    print_message("# the neck breaks by frame %d: %llu voxels fell\n", frame.number,
                  (unsigned long long)frame.ledger.fallen);
    assert_true(frame.ledger.fallen >= 1000);
    assert_int_equal(frame.ledger.start, frame.ledger.rock + frame.ledger.fallen + frame.ledger.left);
    frame_free(&frame);
    sim_end(&s);
}

/* The rock above 1.6 m: in how many parts, and how much sky is seen through it, m2. */
static int parts_above(const struct frame *frame, double *window)
{
    size_t largest, all;
    struct shape s = shape_inside(&frame->grids, FIELD_MARGIN);
    *window = shape_window(&s, 1.6);
    memset(s.rock, 0, (size_t)(1.6 / s.h) * (size_t)s.n[0] * (size_t)s.n[1]);
    int parts = shape_parts(&s, &largest, &all);
    shape_free(&s);
    return parts;
}

static void a_thin_wall_becomes_a_band_and_breaks(void **state)
{
    (void)state;
    char path[4096];
    const char *const sets[] = {"domain.spacing_m=0.2", "output.aov.cameras=[]"};
    snprintf(path, sizeof path, "%s/jobs/goblin_pair.yaml",
             getenv("HOODOO_TOP") ? getenv("HOODOO_TOP") : ".");
    struct sim s = sim_open(path, sets, 2);
    int band = 0, broken = 0;
    for (int f = 0; f < 56; f++) {
        struct frame frame = sim_output(&s);
        double window;
        int parts = parts_above(&frame, &window);
        if (parts == 1 && window > 1 && !band)
            band = frame.number;
        if (parts == 2 && !broken)
            broken = frame.number;
        frame_free(&frame);
        assert_ok(model_step(s.model));
    }
    print_message("# a band by frame %d, two goblins by frame %d\n", band, broken);
    sim_end(&s);
    assert_true(band > 1001 && broken > band);
}

/* What is left in each voxel of the domain. */
static float *shares(struct sim *s, size_t n)
{
    struct frame frame = sim_output(s);
    float *by_id = viability_by_id(&frame.rock, n);
    frame_free(&frame);
    return by_id;
}

static void finer_voxels_make_the_same_goblin(void **state)
{
    (void)state;
    struct sim coarse = cap_of(0.125, "noise: {amplitude: 0.2, scale_m: 1.5}\n");
    struct sim fine = cap_of(0.0625, "noise: {amplitude: 0.2, scale_m: 1.5}\n");
    const int n[3] = {40, 40, 48};
    size_t both = 0, any = 0, rock = 0;
    double volume[2] = {0};
    for (int f = 0; f < 22; f++) {
        assert_ok(model_step(coarse.model));
        assert_ok(model_step(fine.model));
    }
    float *a = shares(&coarse, 40 * 40 * 48), *b = shares(&fine, 80 * 80 * 96);
    for (int z = 0; z < 2 * n[2]; z++)
        for (int y = 0; y < 2 * n[1]; y++)
            for (int x = 0; x < 2 * n[0]; x++) {
                float in_coarse = a[((size_t)(z / 2) * 40 + (size_t)(y / 2)) * 40 + (size_t)(x / 2)];
                float in_fine = b[((size_t)z * 80 + (size_t)y) * 80 + (size_t)x];
                both += in_coarse >= 0.5f && in_fine >= 0.5f;
                any += in_coarse >= 0.5f || in_fine >= 0.5f;
                volume[0] += (double)in_coarse;
                volume[1] += (double)in_fine;
            }
    rock = (size_t)(M_PI * 30.4 * 30.4 * 88);
    print_message("# voxels of 0.125 and 0.0625 m: %.3f and %.3f of the rock left, IoU %.3f\n",
                  volume[0] / (double)rock, volume[1] / (double)rock, (double)both / (double)any);
    free(a);
    free(b);
    sim_end(&coarse);
    sim_end(&fine);
    assert_true((double)both / (double)any >= 0.9);
}

static void a_continued_run_has_the_same_bits(void **state)
{
    (void)state;
    struct sim s = cap_of(0.1, "");
    struct checkpoint middle, ends[2];
    for (int f = 0; f < 5; f++)
        assert_ok(model_step(s.model));
    assert_ok(model_save(s.model, &middle));
    for (int again = 0; again < 2; again++) {
        for (int f = 0; f < 5; f++)
            assert_ok(model_step(s.model));
        assert_ok(model_save(s.model, &ends[again]));
        model_destroy(&s.model);
        assert_ok(model_create(s.gpu, s.job, &middle, &s.model));
    }
    assert_int_equal(ends[0].n_sections, ends[1].n_sections);
    for (size_t i = 0; i < ends[0].n_sections; i++) {
        const struct checkpoint_section *a = &ends[0].section[i], *b = &ends[1].section[i];
        assert_int_equal(a->n * a->item, b->n * b->item);
        assert_memory_equal(a->data, b->data, a->n * a->item);
    }
    checkpoint_free(&middle);
    checkpoint_free(&ends[0]);
    checkpoint_free(&ends[1]);
    sim_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_becomes_a_sphere_by_itself),
        cmocka_unit_test(a_cube_becomes_a_sphere),
        cmocka_unit_test(a_gumdrop_has_a_flat_base_and_a_round_top),
        cmocka_unit_test(a_rock_takes_its_bubbles_shape),
        cmocka_unit_test(flat_faces_retreat_at_their_rate),
        cmocka_unit_test(a_cap_stands_on_a_neck),
        cmocka_unit_test(a_thin_wall_becomes_a_band_and_breaks),
        cmocka_unit_test(finer_voxels_make_the_same_goblin),
        cmocka_unit_test(a_continued_run_has_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
