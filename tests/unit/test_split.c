/* The rock of a voxel among the voxels in it: volumes below planes against counted points, volume kept, planes kept. */
#include "check.h"

#include <math.h>
#include <stddef.h>

#include "base/random.h"
#include "resample/split.h"

static double number(uint32_t i, uint32_t what, double low, double high)
{
    return low + (high - low) * (double)random_float(random_hash(i, what, 7, 3));
}

static void volumes_below_planes(void **state)
{
    enum { FINE = 60 };
    double worst = 0;
    (void)state;
    for (uint32_t i = 0; i < 200; i++) {
        double n[3], low[3];
        for (uint32_t a = 0; a < 3; a++) {
            n[a] = i % 7 == a ? 0 : number(i, a, -1, 1); /* also along the axes' planes */
            low[a] = number(i, 4 + a, -0.5, 0.3);
        }
        const double s = number(i, 8, 0.1, 0.5), d = number(i, 9, -0.5, 0.5);
        int in = 0;
        for (int p = 0; p < FINE * FINE * FINE; p++) {
            const int at[3] = {p % FINE, p / FINE % FINE, p / FINE / FINE};
            double sum = 0;
            for (int a = 0; a < 3; a++)
                sum += n[a] * (low[a] + (at[a] + 0.5) * s / FINE);
            in += sum <= d;
        }
        worst = fmax(worst, fabs(split_below(n, d, low, s) - (double)in / (FINE * FINE * FINE)));
    }
    print_message("# at most %.2g from counting %d^3 points\n", worst, FINE);
    assert_true(worst < 4e-3); /* a thousandth by the tilt, and the points' own error */
}

static void the_normal_of_a_plane(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 100; i++) {
        double n[3], fill[27], got[3], length = 0, dot = 0, its = 0;
        for (uint32_t a = 0; a < 3; a++)
            n[a] = number(i, a, -1, 1);
        for (int v = 0; v < 27; v++) {
            const double low[3] = {v % 3 - 1.5, v / 3 % 3 - 1.5, v / 9 - 1.5};
            fill[v] = split_below(n, 0, low, 1);
        }
        split_normal(fill, got);
        for (int a = 0; a < 3; a++) {
            dot += n[a] * got[a];
            length += n[a] * n[a];
            its += got[a] * got[a];
        }
        assert_true(dot / sqrt(length * its) > cos(12 * 3.14159 / 180));
    }
    double same[27], none[3];
    for (int v = 0; v < 27; v++)
        same[v] = 0.5;
    split_normal(same, none);
    for (int a = 0; a < 3; a++)
        assert_true(none[a] == 0);
}

static void volume_is_kept(void **state)
{
    double worst = 0;
    (void)state;
    for (uint32_t i = 0; i < 3000; i++) {
        const int k = 2 + (int)(i % 3);
        const size_t n = (size_t)(k * k * k);
        float most[64], share[64];
        double normal[3], sum = 0, room = 0;
        for (uint32_t a = 0; a < 3; a++)
            normal[a] = i % 11 == 0 ? 0 : number(i, a, -1, 1);
        for (size_t c = 0; c < n; c++) {
            most[c] = i % 2 ? 1 : (float)fmax(0, number(i, 20 + (uint32_t)c, -0.5, 1));
            room += (double)most[c] / (double)n;
        }
        const double fill = i % 5 == 0 ? room : number(i, 5, 0.05, 1);
        split_voxel(k, fill, i % 5 == 0 ? fill : 2, normal, most, 1.0 / 64, share);
        for (size_t c = 0; c < n; c++) {
            sum += (double)share[c] / (double)n;
            assert_true(share[c] >= 0 && share[c] <= 1);
            assert_true(fill > room || share[c] <= most[c] + 1e-6f);
            assert_true(i % 5 == 0 || fill > room || share[c] == 0 || share[c] >= 1.0f / 64);
            assert_true(i % 5 ||
                        fabsf(share[c] - most[c]) < 1e-6f); /* untouched rock stays as the scene has it */
        }
        worst = fmax(worst, fabs(sum - fill));
    }
    print_message("# volume kept within %.2g\n", worst);
    assert_true(worst < 1e-5);
}

static void a_plane_stays_where_it_is(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 300; i++) {
        float most[8], share[8];
        double n[3], length = 0;
        for (uint32_t a = 0; a < 3; a++) {
            n[a] = number(i, a, -1, 1);
            length += n[a] * n[a];
        }
        for (int a = 0; a < 3; a++)
            n[a] /= sqrt(length);
        for (int c = 0; c < 8; c++)
            most[c] = 1;
        const double d = number(i, 6, -0.4, 0.4), corner[3] = {-0.5, -0.5, -0.5};
        split_voxel(2, split_below(n, d, corner, 1), 1, n, most, 0, share);
        for (int c = 0; c < 8; c++) {
            const double low[3] = {c % 2 / 2.0 - 0.5, c / 2 % 2 / 2.0 - 0.5, c / 4 / 2.0 - 0.5};
            assert_true(fabs((double)share[c] - split_below(n, d, low, 0.5)) < 5e-3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volumes_below_planes),
        cmocka_unit_test(the_normal_of_a_plane),
        cmocka_unit_test(volume_is_kept),
        cmocka_unit_test(a_plane_stays_where_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
