/* Randomness: hashes look random, noise has the statistics and the independence it promises. */
#include "base/random.h"
#include "scene_help.h"
#include "shape/noise.h"

static void hashes_look_random(void **state)
{
    (void)state;
    enum { N = 1 << 20 };
    double sum = 0, square = 0, next = 0;
    int bits[32] = {0};
    for (uint32_t i = 0; i < N; i++) {
        /* As scenes use it: small neighbouring numbers. */
        uint32_t h = random_hash(7, i % 128, i / 128 % 128, i / 16384);
        double f = (double)random_float(h) - 0.5,
               g = (double)random_float(random_hash(7, i % 128 + 1, i / 128 % 128, i / 16384)) - 0.5;
        assert_true(f >= -0.5 && f < 0.5);
        sum += f;
        square += f * f;
        next += f * g;
        for (int b = 0; b < 32; b++)
            bits[b] += (int)(h >> b & 1);
    }
    assert_true(fabs(sum / N) < 2e-3);
    assert_close(square / N, 1.0 / 12, 0.01);
    assert_true(fabs(next / N) < 1e-3);
    for (int b = 0; b < 32; b++)
        assert_true(abs(bits[b] - N / 2) < 5 * 512);
}

/* Pinned: kernels have the same function, and old jobs must give the same frames. */
static void hashes_never_change(void **state)
{
    (void)state;
    assert_int_equal(random_hash(0, 0, 0, 0), 3542436074u);
    assert_int_equal(random_hash(1, 2, 3, 4), 45698095u);
    assert_int_equal(random_hash(0xffffffffu, 0x80000000u, 12345, 0), 2817321388u);
    assert_true(random_float(0xffffffffu) < 1 && random_float(0) == 0);
}

static void noise_has_no_mean_and_unit_variance(void **state)
{
    (void)state;
    for (int octaves = 1; octaves <= 8; octaves += 3)
        for (int flat = 0; flat < 2; flat++) {
            enum { N = 400000 };
            struct job_noise job = {
                .amplitude = 1, .scale_m = 3, .octaves = octaves, .flatten = flat ? 4 : 1};
            struct noise noise = noise_init(&job, 11);
            double sum = 0, square = 0, largest = 0;
            uint32_t x = 5;
            for (int i = 0; i < N; i++) {
                double p[3];
                for (int a = 0; a < 3; a++)
                    p[a] = next_random(&x) % 1000000 * 1e-3;
                double n = noise_at(&noise, p);
                sum += n;
                square += n * n;
                largest = fmax(largest, fabs(n));
            }
            assert_true(fabs(sum / N) < 0.01);
            assert_close(square / N, 1, 0.02);
            assert_true(largest < 6);
        }
}

static void noise_is_smooth_and_as_wide_as_it_says(void **state)
{
    (void)state;
    struct job_noise job = {.amplitude = 1, .scale_m = 8, .octaves = 1, .flatten = 4};
    struct noise noise = noise_init(&job, 3);
    double gradient[3] = {0};
    uint32_t x = 77;
    for (int i = 0; i < 100000; i++) {
        double p[3], q[3];
        for (int a = 0; a < 3; a++)
            p[a] = next_random(&x) % 1000000 * 1e-3 - 500; /* on both sides of 0 */
        for (int a = 0; a < 3; a++) {
            memcpy(q, p, sizeof q);
            q[a] += 1e-4;
            double slope = (noise_at(&noise, q) - noise_at(&noise, p)) / 1e-4;
            assert_true(fabs(slope) < 25 * (a == 2 ? 4 : 1) / 8.0);
            gradient[a] += slope * slope;
        }
    }
    assert_close(gradient[0], gradient[1], 0.05);
    assert_close(sqrt(gradient[2] / gradient[0]), 4, 0.05);
}

/* Two spacings of one rock see the same noise at the same place: each coarse particle's factor is the noise
 * at its place, and so is each fine one's, and the factors' statistics agree. */
static void noise_does_not_know_the_spacing(void **state)
{
    (void)state;
    struct job_node box = BOX(.min_m = {0, 0, 0}, .max_m = {16, 16, 16});
    double mean[2] = {0};
    for (int fine = 0; fine < 2; fine++) {
        struct job job = cube_job(&box, fine ? 64 : 32, fine ? 0.25 : 0.5);
        job.noise.amplitude = 0.4;
        job.noise.scale_m = 5;
        struct noise noise = noise_init(&job.noise, 7);
        struct rock rock;
        assert_int_equal(scene_sample(&job, &rock), OK);
        for (size_t p = 0; p < rock.n; p++) {
            const double x[3] = {(double)rock.P[4 * p], (double)rock.P[4 * p + 1], (double)rock.P[4 * p + 2]};
            assert_close((double)rock.rate_factor[p], exp(0.4 * noise_at(&noise, x)), 1e-6);
            mean[fine] += (double)rock.rate_factor[p] / (double)rock.n;
        }
        rock_free(&rock);
    }
    assert_close(mean[0], mean[1], 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hashes_look_random),
        cmocka_unit_test(hashes_never_change),
        cmocka_unit_test(noise_has_no_mean_and_unit_variance),
        cmocka_unit_test(noise_is_smooth_and_as_wide_as_it_says),
        cmocka_unit_test(noise_does_not_know_the_spacing),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
