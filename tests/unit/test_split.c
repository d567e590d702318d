/* The rock of a voxel among the voxels in it: volumes below planes against counted points, planes that stay where they are, surfaces without
 * steps between voxels, volume kept. */
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

/* The shares of the voxels around one, of rock below a plane. */
static void fill_below(const double n[3], double d, double fill[27])
{
    for (int v = 0; v < 27; v++) {
        const double low[3] = {v % 3 - 1.5, v / 3 % 3 - 1.5, v / 9 - 1.5};
        fill[v] = split_below(n, d, low, 1);
    }
}

static void a_plane_stays_where_it_is(void **state)
{
    double sum = 0, worst = 0, mean = 0;
    int n_shares = 0;
    (void)state;
    for (uint32_t i = 0; i < 600; i++) {
        double n[3], fill[27], length = 0;
        const int k = 2 + (int)(i % 3);
        for (uint32_t a = 0; a < 3; a++) {
            n[a] = number(i, a, -1, 1);
            length += n[a] * n[a];
        }
        for (int a = 0; a < 3; a++)
            n[a] /= sqrt(length);
        const double d = number(i, 6, -0.8, 0.8);
        fill_below(n, d, fill);
        for (int e = 0; e < k * k * k; e++) {
            const double s = 1.0 / k, low[3] = {e % k * s - 0.5, e / k % k * s - 0.5, e / (k * k) * s - 0.5};
            const double error = split_smooth(fill, 0.5, k, e) - split_below(n, d, low, s);
            worst = fmax(worst, fabs(error) / k);
            sum += fabs(error) / k;
            mean += error / k;
            n_shares++;
        }
    }
    sum /= n_shares;
    mean /= n_shares;
    print_message("# off by %.3f of a large voxel, at most %.3f, on the mean %+.4f\n", sum, worst, mean);
    assert_true(sum < 0.01 && worst < 0.1 && fabs(mean) < 1e-3);
}

/* The level surface of neighbouring voxels is one: on both sides of the face between them, thin voxels have nearly the same share. */
static void no_steps_between_voxels(void **state)
{
    double worst = 0;
    (void)state;
    for (uint32_t i = 0; i < 300; i++) {
        double row[4][9], left[27], right[27];
        const double slope = number(i, 99, -0.3, 0.3);
        for (int x = 0; x < 4; x++)
            for (int e = 0; e < 9; e++) {
                const double height = 1.5 + slope * (x - 1.5) + number(i, (uint32_t)(9 * x + e), -0.2, 0.2);
                row[x][e] = fmin(fmax(height - e / 3, 0), 1);
            }
        for (int e = 0; e < 27; e++) {
            left[e] = row[e % 3][e / 3];
            right[e] = row[e % 3 + 1][e / 3];
        }
        double step = 0;
        for (int z = 0; z < 8; z++)
            step += split_smooth(left, 0.5, 8, 7 + 8 * 4 + 64 * z) / 8 -
                    split_smooth(right, 0.5, 8, 8 * 4 + 64 * z) / 8;
        worst = fmax(worst, fabs(step));
    }
    print_message("# steps of at most %.3f of a voxel where fills differ by up to 0.4\n", worst);
    assert_true(worst < 0.12);
}

static void volume_is_kept(void **state)
{
    double worst = 0;
    (void)state;
    for (uint32_t i = 0; i < 3000; i++) {
        const size_t n = i % 2 ? 8 : 64;
        float most[64], share[64];
        double sum = 0, had = 0;
        for (size_t c = 0; c < n; c++) {
            most[c] = i % 3 ? 1 : (float)fmax(0, number(i, 20 + (uint32_t)c, -0.5, 1));
            had += (double)most[c] / (double)n;
        }
        const double fill = number(i, 5, 0.05, 1), first = i % 5 ? 2 : i % 2 ? fill : 0;
        split_evenly(n, fill, first, most, share);
        for (size_t c = 0; c < n; c++) {
            sum += (double)share[c] / (double)n;
            assert_true(share[c] >= 0 && share[c] <= 1);
            assert_true(first != fill || share[c] == most[c]); /* untouched rock stays as the scene has it */
        }
        if (first != fill)
            worst = fmax(worst, fabs(sum - fill));
    }
    print_message("# volume kept within %.2g\n", worst);
    assert_true(worst < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volumes_below_planes),
        cmocka_unit_test(a_plane_stays_where_it_is),
        cmocka_unit_test(no_steps_between_voxels),
        cmocka_unit_test(volume_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
