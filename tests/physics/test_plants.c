/* Plants: covered ground erodes more slowly by the stated factor; cover goes down with the surface and grows through what buries
 * it; it grows and spreads on deposits, at the same speed whatever the spacing, and by seeds from afar, not on rock and not up
 * cliffs; and it dies where it cannot stand. */
#include "model_help.h"

#include <math.h>
#include <string.h>

#include "base/random.h"
#include "plants/plants.h"

/* Cover on the particles below x, whatever the job's paint says. */
static void plant(struct sim *s, float below_x, float cover)
{
    struct checkpoint c;
    assert_ok(model_save(s->model, &c));
    const struct checkpoint_section *P = checkpoint_find(&c, "P", 4),
                                    *to = checkpoint_find(&c, "vegetation", 4);
    for (size_t i = 0; i < to->n; i++)
        ((float *)to->data)[i] = ((float *)P->data)[4 * i] < below_x ? cover : 0;
    model_destroy(&s->model);
    assert_ok(model_create(s->gpu, s->job, &c, &s->model));
    checkpoint_free(&c);
}

/* What a slab lost in two frames where it is covered and where it is bare, with 0.1 m/kyr on bare ground. */
static void lost(const char *vegetation, double *covered, double *bare)
{
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\n"
             "name: slab\n"
             "frames: 1-10\n"
             "clock: {years_per_frame: 1000}\n"
             "domain: {size_m: [32, 16, 8], spacing_m: 0.5}\n"
             "rock: {gravity_m_s2: 0}\n"
             "scene: {box: {min_m: [0, 0, 0], max_m: [32, 16, 4]}}\n"
             "strata: [{weak_m_per_kyr: 0.1}]\n"
             "wind: {abrasion: 0}\n"
             "paint: [{shape: {box: {min_m: [-1, -1, -1], max_m: [16, 17, 9]}}, vegetation: 0.5}]\n"
             "vegetation: {%s}\n",
             vegetation);
    struct sim s = sim_begin(text);
    double sum[2] = {0}, n[2] = {0};
    plant(&s, 16, 0.5f);
    assert_ok(model_step(s.model));
    assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *P = &frame.rock.P[4 * i];
        int right = P[0] > 16;
        if (P[2] < 3.5f || P[1] < 4 || P[1] > 12 || fabsf(P[0] - 16) > 12 || fabsf(P[0] - 16) < 2)
            continue;
        sum[right] += 1 - (double)frame.rock.viability[i];
        n[right]++;
    }
    *covered = sum[0] / n[0] * 0.5;
    *bare = sum[1] / n[1] * 0.5;
    frame_free(&frame);
    sim_end(&s);
}

static void half_covered_ground_erodes_by_the_stated_factor(void **state)
{
    static const struct {
        const char *keys;
        double factor;
    } of[] = {{"binding: 0.8, shelter: 0", 0.6},
              {"binding: 0, shelter: 0.6", 0.7},
              {"binding: 0.8, shelter: 0.6", 0.42},
              {"binding: 0, shelter: 0", 1}};
    (void)state;
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        double covered, bare;
        lost(of[i].keys, &covered, &bare);
        print_message("# %s, cover 0.5: bare %.4f m, covered %.4f m, factor %.3f (stated %.2f)\n", of[i].keys,
                      bare, covered, covered / bare, of[i].factor);
        assert_true(fabs(bare - 0.2) < 0.01);
        assert_true(fabs(covered / bare - of[i].factor) < 0.01);
    }
}

/* ---- ground made by hand */

struct ground {
    struct gpu *gpu;
    struct gpu_work *work;
    struct particles particles;
    struct job job;
    struct job_paint paint;
};

struct ground_voxel {
    uint32_t phase;
    float cover;
};

/* Particles where what() says so (phase 9: none). */
static struct ground ground_begin(const int n[3], double h, struct ground_voxel (*what)(const double x[3]))
{
    struct ground g = {0};
    struct rock rock;
    size_t all = (size_t)n[0] * (size_t)n[1] * (size_t)n[2], i = 0;
    assert_ok(rock_alloc(&rock, all, STATE));
    for (size_t v = 0; v < all; v++) {
        const double x[3] = {((double)(v % (size_t)n[0]) + 0.5) * h,
                             ((double)(v / (size_t)n[0] % (size_t)n[1]) + 0.5) * h,
                             ((double)(v / ((size_t)n[0] * (size_t)n[1])) + 0.5) * h};
        struct ground_voxel w = what(x);
        if (w.phase == 9)
            continue;
        for (int a = 0; a < 3; a++) {
            float jitter = random_float(random_hash((uint32_t)v, (uint32_t)a, 1, 1)) - 0.5f;
            rock.P[4 * i + (size_t)a] = (float)(x[a] + 0.4 * h * (double)jitter);
        }
        rock.id[i] = (uint32_t)i;
        rock.viability[i] = rock.rate_factor[i] = rock.interlock_factor[i] = 1;
        rock.phase[i] = w.phase;
        rock.vegetation[i++] = w.cover;
    }
    rock.n = i;
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &g.gpu));
    assert_ok(gpu_work_create(g.gpu, all + 2, &g.work));
    assert_ok(particles_create(g.gpu, g.work, &rock, STATE, n, h, &g.particles));
    assert_ok(particles_surface(g.gpu, g.work, &g.particles));
    rock_free(&rock);
    static double frame = 0, growth = 3;
    g.job.seed = 5;
    g.job.clock.years_per_frame = 100;
    g.job.vegetation = (struct job_vegetation){.binding = 0.8,
                                               .shelter = 0.8,
                                               .spread_m_per_kyr = 8,
                                               .death_per_kyr = 2,
                                               .steepest_deg = 45,
                                               .growth_per_kyr = {.n = 1, .frame = &frame, .value = &growth}};
    return g;
}

static struct rock ground_after(struct ground *g, int frames)
{
    struct rock rock;
    for (int f = 1; f <= frames; f++)
        plants_grow(g->gpu, &g->job, f, &g->particles);
    assert_ok(particles_download(g->gpu, &g->particles, STATE, &rock));
    return rock;
}

static void ground_end(struct ground *g)
{
    particles_destroy(g->gpu, &g->particles);
    gpu_work_destroy(g->gpu, &g->work);
    gpu_destroy(&g->gpu);
}

/* A plain of deposits, with a tuft in its middle. */
static struct ground_voxel plain(const double x[3])
{
    double r = hypot(x[0] - 12, x[1] - 12);
    return (struct ground_voxel){x[2] < 1 ? 1 : 9, r < 1 && x[2] < 1 ? 0.3f : 0};
}

static void cover_spreads_at_its_speed_whatever_the_spacing(void **state)
{
    static const double spacing[] = {0.5, 0.25};
    (void)state;
    for (int i = 0; i < 2; i++) {
        double h = spacing[i], far[2] = {0}, covered = 0;
        const int n[3] = {(int)(24 / h), (int)(24 / h), (int)(4 / h)};
        struct ground g = ground_begin(n, h, plain);
        struct rock rock = ground_after(&g, 10); /* 1 kyr: 8 m */
        for (size_t j = 0; j < rock.n; j++) {
            double x = (double)rock.P[4 * j] - 12, y = (double)rock.P[4 * j + 1] - 12, r = hypot(x, y);
            if (rock.vegetation[j] <= 0 || rock.P[4 * j + 2] < 1 - h)
                continue;
            covered += h * h;
            if (fmin(fabs(x), fabs(y)) < 1)
                far[0] = fmax(far[0], r);
            else if (fabs(fabs(x) - fabs(y)) < 1.4)
                far[1] = fmax(far[1], r);
        }
        double round = sqrt(covered / M_PI);
        print_message(
            "# spacing %g: after 8 m of spread from 1 m, cover is %.2f m off along the axes, %.2f along "
            "the diagonals, %.2f by its area\n",
            h, far[0], far[1], round);
        assert_true(fabs(far[0] - 9) < 1 && fabs(far[1] - 9) < 1.2 && fabs(round - 9) < 0.5);
        rock_free(&rock);
        ground_end(&g);
    }
}

static struct ground_voxel tuft(const double x[3])
{
    return (struct ground_voxel){x[2] < 1 ? 1 : 9, x[2] > 0.5 && x[2] < 1 ? 0.1f : 0};
}

static void cover_thickens_as_the_logistic_does(void **state)
{
    const int n[3] = {24, 24, 8};
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        struct ground g = ground_begin(n, 0.5, tuft);
        if (fine)
            g.job.clock.years_per_frame = 25;
        struct rock rock = ground_after(&g, fine ? 20 : 5);
        double expected = 0.1 * exp(1.5) / (1 + 0.1 * (exp(1.5) - 1)), mean = 0, count = 0;
        for (size_t j = 0; j < rock.n; j++)
            if (rock.P[4 * j + 2] > 0.5f) {
                mean += (double)rock.vegetation[j];
                count++;
            }
        print_message("# %d frames to 0.5 kyr: cover %.5f, logistic %.5f\n", fine ? 20 : 5, mean / count,
                      expected);
        assert_true(fabs(mean / count - expected) < 1e-4);
        rock_free(&rock);
        ground_end(&g);
    }
}

/* Deposits, covered, at the foot of a cliff with a ledge of deposits in it; rock beside them on the plain, half of
 * it covered; a roof over some. */
static struct ground_voxel valley(const double x[3])
{
    struct ground_voxel w = {9, 0};
    if (x[2] < 1 || x[0] > 16)
        w.phase = x[0] > 6 && x[0] < 16 && x[2] > 0.5 ? 1 : 0;
    if (x[0] > 16 && x[2] > 0.5)
        w.phase = 1;
    if (x[1] < 8 && x[2] > 5 && x[2] < 6 && x[0] > 6 && x[0] < 12)
        w.phase = 0;
    if (w.phase != 9 && x[2] < 1 && (x[0] < 3 || (x[0] > 6 && x[0] < 8)))
        w.cover = 0.5f;
    if (x[0] > 16 && x[2] > 1 && x[0] < 16.5)
        w.cover = 0.5f; /* on the cliff's face */
    return w;
}

static void cover_stays_off_rock_and_cliffs_and_dies_there(void **state)
{
    const int n[3] = {40, 40, 24}; /* 20 x 20 x 12 m, the cliff at x = 16 m up to 12 m */
    struct ground g = ground_begin(n, 0.5, valley);
    double sum[6] = {0}, count[6] = {0};
    (void)state;
    struct rock rock = ground_after(&g, 20); /* 2 kyr: 16 m of spread; death e^-4 */
    for (size_t j = 0; j < rock.n; j++) {
        const float *P = &rock.P[4 * j];
        int where = -1;
        if (P[2] > 0.5f && P[2] < 1 && P[1] > 10 && P[1] < 18)
            where = P[0] > 0.5f && P[0] < 2.5f ? 0
                    : P[0] > 4 && P[0] < 5.5f  ? 1
                    : P[0] > 8.5f && P[0] < 14 ? 2
                                               : -1;
        if (P[2] > 0.5f && P[2] < 1 && P[1] > 1 && P[1] < 6 && P[0] > 6.5f && P[0] < 11.5f)
            where = 3;
        if (P[2] > 3 && P[2] < 10 && P[0] > 16 && P[0] < 16.5f && P[1] > 2 && P[1] < 18)
            where = 4;
        if (P[2] < 0.5f)
            where = 5;
        if (where >= 0) {
            sum[where] += (double)rock.vegetation[j];
            count[where]++;
        }
    }
    static const char *const name[] = {"painted rock", "bare rock", "deposits",
                                       "under a roof", "the cliff", "below the surface"};
    static const double expected[] = {0.5, 0, 0.6, 0, 0.5 * 0.0183, 0.04};
    for (int i = 0; i < 6; i++)
        print_message("# cover on %s: %.4f\n", name[i], sum[i] / count[i]);
    assert_true(sum[0] / count[0] == expected[0]); /* as it was */
    assert_true(sum[1] == 0);
    assert_true(sum[2] / count[2] > expected[2]);
    assert_true(sum[3] / count[3] < 0.01);
    assert_true(fabs(sum[4] / count[4] - expected[4]) < 0.001);
    rock_free(&rock);
    ground_end(&g);
}

/* A meadow on rock, framed by inert rock: by its rate and what plants leave of it. */
static void a_meadow_goes_down_with_the_ground(void **state)
{
    static const double spacing[] = {2, 1, 1}, years[] = {1000, 1000, 500};
    (void)state;
    for (int i = 0; i < 3; i++) {
        char text[1024];
        double volume[2];
        snprintf(
            text, sizeof text,
            "hoodoo: 1\n"
            "name: meadow\n"
            "frames: 1-100\n"
            "clock: {years_per_frame: %g}\n"
            "domain: {size_m: [16, 12, 8], spacing_m: %g}\n"
            "scene: {box: {min_m: [0, 0, 0], max_m: [16, 12, 6]}}\n"
            "paint:\n"
            "  - {shape: {difference: [box: {min_m: [-1, -1, -1], max_m: [17, 13, 9]}, box: {min_m: [2, 2, "
            "-1], max_m: [14, 10, 9]}]}, inert: true}\n"
            "  - {shape: {box: {min_m: [-1, -1, -1], max_m: [17, 13, 9]}}, vegetation: 1}\n"
            "strata: [{weak_m_per_kyr: 1.5, strong_m_per_kyr: 1.5, interlock_MPa: 1000}]\n"
            "wind: {abrasion: 0, deflation: {strength_MPa: 1000}}\n",
            years[i], spacing[i]);
        struct sim s = sim_begin(text);
        for (int k = 0; k < 2; k++) {
            for (int f = 0; k == 1 && f < 20000 / years[i]; f++)
                assert_ok(model_step(s.model));
            struct frame frame = sim_output(&s);
            volume[k] = frame.volume_m3;
            frame_free(&frame);
        }
        sim_end(&s);
        double lowered = (volume[0] - volume[1]) / (12 * 8);
        print_message(
            "# spacing %g m, %g years a frame: lowered by %.3f m in 20 kyr (30 if bare; 1.2 covered)\n",
            spacing[i], years[i], lowered);
        assert_true(fabs(lowered - 1.2) < 0.12);
    }
}

/* A hill with plants on top alone; whatever else is default. What they cover of the deposits at its foot, m2. */
static double foot_covered(double spacing, double years, int kyr)
{
    char text[1024];
    double covered = 0;
    snprintf(text, sizeof text,
             "hoodoo: 1\n"
             "name: hill\n"
             "frames: 1-100\n"
             "clock: {years_per_frame: %g}\n"
             "domain: {size_m: [48, 48, 16], spacing_m: %g}\n"
             "scene:\n"
             "  union:\n"
             "    - box: {min_m: [0, 0, 0], max_m: [48, 48, 2], inert: true}\n"
             "    - box: {min_m: [16, 16, 2], max_m: [32, 32, 12]}\n"
             "paint: [{shape: {box: {min_m: [15, 15, 9], max_m: [33, 33, 17]}}, vegetation: 1}]\n"
             "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.2, interlock_MPa: 1000}]\n"
             "wind: {abrasion: 0}\n"
             "deposition: {viability: 1}\n",
             years, spacing);
    struct sim s = sim_begin(text);
    for (int f = 0; f < kyr * 1000 / years; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    for (size_t i = 0; i < frame.rock.n; i++)
        if (frame.rock.phase[i] == 1 && frame.rock.P[4 * i + 2] < 7)
            covered += (double)frame.rock.vegetation[i] * spacing * spacing;
    frame_free(&frame);
    sim_end(&s);
    return covered;
}

static void new_plants_grow_at_the_foot_of_the_hill(void **state)
{
    const double coarse = foot_covered(2, 1000, 24), fine = foot_covered(1, 1000, 24),
                 often = foot_covered(1, 500, 24);
    (void)state;
    print_message(
        "# of the deposits at the foot plants cover %.1f m2 after 24 kyr at 2 m, %.1f at 1 m, %.1f in "
        "frames of 500 years\n",
        coarse, fine, often);
    assert_true(coarse > 20);
    assert_true(fine < 1.5 * coarse && coarse < 1.5 * fine && often < 1.3 * fine && fine < 1.3 * often);
}

static void frames_with_plants_resume_with_the_same_bits(void **state)
{
    struct sim s =
        sim_begin("hoodoo: 1\n"
                  "name: garden\n"
                  "frames: 1-10\n"
                  "clock: {years_per_frame: 800}\n"
                  "domain: {size_m: [20, 20, 12], spacing_m: 0.5}\n"
                  "scene:\n"
                  "  union:\n"
                  "    - box: {min_m: [0, 0, 0], max_m: [20, 20, 2]}\n"
                  "    - box: {min_m: [7, 7, 2], max_m: [13, 13, 10]}\n"
                  "wind: {abrasion: 0}\n"
                  "paint: [{shape: {box: {min_m: [0, 0, 1], max_m: [10, 20, 4]}}, vegetation: 0.6}]\n"
                  "deposition: {viability: 0.5}\n"
                  "vegetation: {growth_per_kyr: 1, spread_m_per_kyr: 2}\n");
    struct checkpoint half, whole, again;
    struct model *resumed;
    (void)state;
    plant(&s, 10, 0.6f);
    for (int f = 0; f < 6; f++) {
        assert_ok(model_step(s.model));
        if (f == 2)
            assert_ok(model_save(s.model, &half));
    }
    assert_ok(model_save(s.model, &whole));
    assert_ok(model_create(s.gpu, s.job, &half, &resumed));
    for (int f = 0; f < 3; f++)
        assert_ok(model_step(resumed));
    assert_ok(model_save(resumed, &again));
    double cover = 0, deposits = 0;
    const struct checkpoint_section *vegetation = checkpoint_find(&again, "vegetation", 4),
                                    *phase = checkpoint_find(&again, "phase", 4);
    for (size_t i = 0; i < vegetation->n; i++)
        if (((uint32_t *)phase->data)[i] == 1) {
            cover += (double)((float *)vegetation->data)[i];
            deposits++;
        }
    print_message("# after 6 frames %.0f deposits, cover on them %.1f particles\n", deposits, cover);
    assert_true(deposits > 100 && cover > 1);
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
        cmocka_unit_test(half_covered_ground_erodes_by_the_stated_factor),
        cmocka_unit_test(cover_spreads_at_its_speed_whatever_the_spacing),
        cmocka_unit_test(cover_thickens_as_the_logistic_does),
        cmocka_unit_test(cover_stays_off_rock_and_cliffs_and_dies_there),
        cmocka_unit_test(a_meadow_goes_down_with_the_ground),
        cmocka_unit_test(new_plants_grow_at_the_foot_of_the_hill),
        cmocka_unit_test(frames_with_plants_resume_with_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
