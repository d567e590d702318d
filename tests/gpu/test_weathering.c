/* Kernels that change a particle's rate by what is there already, against plain C: sheets, age and crust, aspect, cover of plants. */
#include "check.h"

#include <math.h>
#include <stdlib.h>

#include "base/random.h"
#include "gpu/gpu.h"
#include "particles/rock.h"
#include "shared/params.h"

enum { ALL = 5000, LISTED = 3000 };

/* Particles at random, of which every other or so is in the list, in reverse order. */
struct bed {
    struct gpu *gpu;
    uint32_t list[LISTED], phase[ALL];
    struct gpu_buffer *on_list, *on_phase;
};

static float chance(uint32_t i, uint32_t what)
{
    return random_float(random_hash(i, what, 4, 2));
}

static struct gpu_buffer *buffer_of(struct gpu *gpu, const void *data, size_t n, size_t item)
{
    struct gpu_buffer *b = NULL;
    assert_ok(gpu_buffer_create(gpu, "test", n, item, &b));
    assert_ok(gpu_upload(gpu, b, 0, data, n));
    return b;
}

static struct bed *bed_of(void **state)
{
    struct bed *b = calloc(1, sizeof *b);
    assert_non_null(b);
    assert_ok(gpu_create(*state, &b->gpu));
    for (uint32_t i = 0; i < LISTED; i++)
        b->list[i] = ALL - 1 - (i * ALL + ALL / 2) / LISTED;
    for (uint32_t i = 0; i < ALL; i++)
        b->phase[i] = chance(i, 1) < 0.2f ? PHASE_DEPOSIT : PHASE_ROCK;
    b->on_list = buffer_of(b->gpu, b->list, LISTED, 4);
    b->on_phase = buffer_of(b->gpu, b->phase, ALL, 4);
    return b;
}

static void bed_end(struct bed *b)
{
    gpu_buffer_destroy(b->gpu, &b->on_list);
    gpu_buffer_destroy(b->gpu, &b->on_phase);
    gpu_destroy(&b->gpu);
    free(b);
}

/* n floats from `low` to `high`, by number and `what`. */
static float *floats(size_t n, uint32_t what, float low, float high)
{
    float *v = malloc(n * sizeof *v);
    assert_non_null(v);
    for (uint32_t i = 0; i < n; i++)
        v[i] = low + (high - low) * chance(i, what);
    return v;
}

static void assert_near(double got, double expected, double share)
{
    assert_true(fabs(got - expected) <= share * fmax(fabs(expected), 1e-3));
}

/* ---- sheets */

/* The share of the time between two sheets at which the patch of a place loses its own: that of the nearest point of the 27 cubes around. */
static float patch(const float *P, uint32_t seed, float wide)
{
    float best = HUGE_VALF, share = 0;
    for (int b = 0; b < 27; b++) {
        const int cube[3] = {(int)floorf(P[0] / wide) + b % 3 - 1, (int)floorf(P[1] / wide) + b / 3 % 3 - 1,
                             (int)floorf(P[2] / wide) + b / 9 - 1};
        float drawn[4], far = 0;
        for (uint32_t what = 0; what < 4; what++)
            drawn[what] = random_float(random_hash(seed, (uint32_t)cube[0], (uint32_t)cube[1],
                                                   random_hash((uint32_t)cube[2], what, 0, 0)));
        for (int a = 0; a < 3; a++)
            far += powf(P[a] / wide - ((float)cube[a] + drawn[a + 1]), 2);
        if (far < best) {
            best = far;
            share = drawn[0];
        }
    }
    return share;
}

static void sheets_come_off_where_rock_is_in_tension(void **state)
{
    struct bed *b = bed_of(state);
    const struct sheeting_params k = {.n = LISTED,
                                      .seed = 9,
                                      .thick = 0.4f,
                                      .wide = 2,
                                      .strength = 5e4f,
                                      .from = 3.1f,
                                      .to = 4.3f,
                                      .kyr = 0.7f};
    float *P = floats(4 * ALL, 2, -9, 9), *stress = floats(ALL, 3, -1.5e5f, 5e4f),
          *rate = floats(ALL, 4, -0.1f, 1);
    float *intensity = floats(LISTED, 5, 0, 2), *got = malloc(LISTED * sizeof *got);
    uint32_t *parts = calloc(LISTED, 4);
    size_t n = 0, twice = 0;
    struct gpu_buffer *on_P = buffer_of(b->gpu, P, ALL, 16), *on_stress = buffer_of(b->gpu, stress, ALL, 4),
                      *on_rate = buffer_of(b->gpu, rate, ALL, 4),
                      *on_parts = buffer_of(b->gpu, parts, LISTED, 4),
                      *on_intensity = buffer_of(b->gpu, intensity, LISTED, 4);
    GPU_RUN(b->gpu, sheeting_press, k.n, k, b->on_list, on_P, b->on_phase, on_stress, on_rate, on_intensity,
            on_parts);
    assert_ok(gpu_download(b->gpu, on_intensity, 0, got, LISTED));
    assert_ok(gpu_download(b->gpu, on_parts, 0, parts, LISTED));
    for (size_t i = 0; i < LISTED; i++) {
        const uint32_t self = b->list[i];
        const double tension = fmin(fmax(-(double)stress[self] / (double)k.strength - 1, 0), 1);
        const float own = patch(P + 4 * self, k.seed, k.wide);
        const double sheets = (double)(floorf(k.to + own) - floorf(k.from + own));
        double more = 0;
        if (b->phase[self] == PHASE_ROCK && rate[self] > 0 && tension > 0)
            more = sheets * (double)k.thick * tension / ((double)k.kyr * (double)rate[self]);
        assert_near((double)got[i], (double)intensity[i] + more, 1e-4);
        assert_int_equal(parts[i] >> 30, more > 0);
        n += more > 0;
        twice += more > 0 && sheets > 1;
    }
    assert_true(n > 200 && twice > 20 && n < LISTED / 2);
    struct gpu_buffer **all[] = {&on_P, &on_stress, &on_rate, &on_parts, &on_intensity};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(b->gpu, all[i]);
    free(P);
    free(stress);
    free(rate);
    free(intensity);
    free(parts);
    free(got);
    bed_end(b);
}

/* ---- age and crust: a step uses the crust of its middle, which is 2 % off at most here */

static double crust_of(const struct skin_params *k, double age, double damp)
{
    const double grown = (1 - exp(-age / (double)k->crust_kyr)) * (1 - damp);
    return (1 + ((double)k->damp - 1) * 4 * damp * (1 - damp)) / (1 + ((double)k->crust - 1) * grown);
}

/* A' = 1 - fresh crust(A) A / depth over the step, in small steps of Heun's method; *retreat: over the step, per kyr. */
static double aged(const struct skin_params *k, double age, double damp, double fresh, double *retreat)
{
    enum { STEPS = 2000 };
    const double dt = (double)k->kyr / STEPS, depth = (double)k->depth;
    *retreat = 0;
    for (int i = 0; i < STEPS; i++) {
        const double r = fresh * crust_of(k, age, damp), slope = 1 - r * age / depth,
                     guess = age + dt * slope;
        const double then = fresh * crust_of(k, guess, damp);
        age += dt / 2 * (slope + 1 - then * guess / depth);
        *retreat += (r + then) / (2 * STEPS);
    }
    return age;
}

static void ages_follow_their_law(void **state)
{
    struct bed *b = bed_of(state);
    for (int crusts = 0; crusts < 2; crusts++) {
        const struct skin_params k = {.n = LISTED,
                                      .depth = 0.3f,
                                      .kyr = 0.25f,
                                      .crust_kyr = 2,
                                      .crust = crusts ? 5 : 1,
                                      .damp = crusts ? 3 : 1};
        float *rate = floats(ALL, 6, 0, 0.5f), *damp = floats(ALL, 7, 0, 1), *age = floats(ALL, 8, 0, 6);
        float *intensity = floats(LISTED, 9, 0, 1), got[2][ALL];
        struct gpu_buffer *on_rate = buffer_of(b->gpu, rate, ALL, 4),
                          *on_damp = buffer_of(b->gpu, damp, ALL, 4),
                          *on_age = buffer_of(b->gpu, age, ALL, 4),
                          *on_intensity = buffer_of(b->gpu, intensity, LISTED, 4);
        GPU_RUN(b->gpu, skin_age, k.n, k, b->on_list, b->on_phase, on_rate, on_damp, on_intensity, on_age);
        assert_ok(gpu_download(b->gpu, on_intensity, 0, got[0], LISTED));
        assert_ok(gpu_download(b->gpu, on_age, 0, got[1], ALL));
        for (size_t i = 0; i < LISTED; i++) {
            const uint32_t self = b->list[i];
            const double before = (double)age[self], wet = (double)damp[self];
            const double now = (double)rate[self] * (double)intensity[i];
            double retreat = now, expected = before + (double)k.kyr;
            if (b->phase[self] == PHASE_ROCK)
                expected = aged(&k, before, wet, now / crust_of(&k, before, wet), &retreat);
            assert_near((double)got[1][self], expected, crusts ? 5e-3 : 1e-4);
            assert_near((double)got[0][i] * (double)rate[self], retreat, crusts ? 2e-2 : 1e-5);
        }
        struct gpu_buffer **all[] = {&on_rate, &on_damp, &on_age, &on_intensity};
        for (size_t i = 0; i < sizeof all / sizeof *all; i++)
            gpu_buffer_destroy(b->gpu, all[i]);
        free(rate);
        free(damp);
        free(age);
        free(intensity);
    }
    bed_end(b);
}

/* ---- aspect and plants */

static void slopes_weather_by_where_they_face(void **state)
{
    struct bed *b = bed_of(state);
    const double azimuth = 0.7, factor = 3, per_100m = 1.5;
    const struct aspect_params k = {.n = LISTED,
                                    .x = (float)(log(factor) / 2 * cos(azimuth)),
                                    .y = (float)(log(factor) / 2 * sin(azimuth)),
                                    .per_m = (float)(log(per_100m) / 100)};
    float *P = floats(4 * ALL, 10, 0, 200), *N = floats(4 * ALL, 11, -0.57f, 0.57f);
    float *intensity = floats(LISTED, 12, 0, 2), got[LISTED];
    struct gpu_buffer *on_P = buffer_of(b->gpu, P, ALL, 16), *on_N = buffer_of(b->gpu, N, ALL, 16),
                      *on_intensity = buffer_of(b->gpu, intensity, LISTED, 4);
    GPU_RUN(b->gpu, erosion_aspect, k.n, k, b->on_list, on_P, on_N, b->on_phase, on_intensity);
    assert_ok(gpu_download(b->gpu, on_intensity, 0, got, LISTED));
    for (size_t i = 0; i < LISTED; i++) {
        const uint32_t self = b->list[i];
        const double faces = (double)N[4 * self] * cos(azimuth) + (double)N[4 * self + 1] * sin(azimuth);
        const double by = pow(factor, faces / 2) * pow(per_100m, (double)P[4 * self + 2] / 100);
        assert_near((double)got[i], (double)intensity[i] * (b->phase[self] == PHASE_ROCK ? by : 1), 1e-4);
    }
    gpu_buffer_destroy(b->gpu, &on_P);
    gpu_buffer_destroy(b->gpu, &on_N);
    gpu_buffer_destroy(b->gpu, &on_intensity);
    free(P);
    free(N);
    free(intensity);
    bed_end(b);
}

static void plants_bind_and_shelter(void **state)
{
    struct bed *b = bed_of(state);
    const struct plants_params k = {.n = LISTED, .binding = 0.7f, .shelter = 0.9f};
    float *cover = floats(ALL, 13, -0.3f, 1), *rate = floats(ALL, 14, 0, 1),
          *intensity = floats(LISTED, 15, 0, 2);
    float got[2][ALL];
    for (size_t i = 0; i < ALL; i++)
        cover[i] = fmaxf(cover[i], 0);
    struct gpu_buffer *on_cover = buffer_of(b->gpu, cover, ALL, 4),
                      *on_rate = buffer_of(b->gpu, rate, ALL, 4),
                      *on_intensity = buffer_of(b->gpu, intensity, LISTED, 4);
    GPU_RUN(b->gpu, plants_bind, k.n, k, b->on_list, on_cover, on_rate);
    GPU_RUN(b->gpu, plants_shield, k.n, k, b->on_list, on_cover, on_intensity);
    assert_ok(gpu_download(b->gpu, on_rate, 0, got[0], ALL));
    assert_ok(gpu_download(b->gpu, on_intensity, 0, got[1], LISTED));
    for (size_t i = 0; i < LISTED; i++) {
        const uint32_t self = b->list[i];
        assert_near((double)got[0][self], (double)rate[self] * (1 - 0.7 * (double)cover[self]), 1e-5);
        assert_near((double)got[1][i], (double)intensity[i] * (1 - 0.9 * (double)cover[self]), 1e-5);
    }
    gpu_buffer_destroy(b->gpu, &on_cover);
    gpu_buffer_destroy(b->gpu, &on_rate);
    gpu_buffer_destroy(b->gpu, &on_intensity);
    free(cover);
    free(rate);
    free(intensity);
    bed_end(b);
}

int main(void)
{
    static struct gpu_options own = {.device = "auto"};
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(sheets_come_off_where_rock_is_in_tension, &own),
        cmocka_unit_test_prestate(ages_follow_their_law, &own),
        cmocka_unit_test_prestate(slopes_weather_by_where_they_face, &own),
        cmocka_unit_test_prestate(plants_bind_and_shelter, &own),
    };
    return cmocka_run_group_tests_name("weathering", tests, NULL, NULL);
}
