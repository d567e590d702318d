/* The shape `voxels`: its file, the shares that come back from it, and its distances. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "scene/coverage.h"
#include "scene/scene.h"
#include "shape/voxel_file.h"
#include "shape/voxel_shape.h"

enum { NX = 13, NY = 9, NZ = 11, ALL = NX * NY * NZ };
static const int N[3] = {NX, NY, NZ};
static const double H = 0.37;

static uint32_t draw(uint32_t a, uint32_t b)
{
    return random_hash(a, b, 17, RANDOM_ESTIMATE);
}

/* A ball of rock with a bite, and around it voxels with any share. */
static void fill(float share[ALL])
{
    for (uint32_t v = 0; v < ALL; v++) {
        const double x = v % NX - 6.0, y = v / NX % NY - 4.2, z = v / (NX * NY) - 5.3;
        const double r = sqrt(x * x + y * y + z * z);
        share[v] = r < 3 ? 1 : r > 5 ? 0 : (float)(draw(v, 0) % 65) / 64;
        if (x > 2 && y > 1)
            share[v] = draw(v, 1) % 3 ? 0 : 1;
    }
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static void *make_file(const char *path, float share[ALL], size_t *size)
{
    void *bytes;
    fill(share);
    assert_ok(voxel_file_encode(N, H, share, &bytes, size));
    write_file(path, bytes, *size);
    return bytes;
}

static void a_file_comes_back(void **state)
{
    (void)state;
    static float share[ALL];
    size_t size;
    struct voxel_grid g;
    free(make_file("whole.voxels", share, &size));
    assert_ok(voxel_file_read("whole.voxels", &g));
    assert_memory_equal(g.n, N, sizeof N);
    assert_true(g.h == H);
    for (size_t v = 0; v < ALL; v++)
        assert_int_equal(g.parts[v], lrint((double)share[v] * 64));
    free(g.parts);
    /* Longer than one run. */
    static float solid[300 * 300 * 200];
    const int large[3] = {300, 300, 200};
    void *bytes;
    for (size_t v = 0; v < sizeof solid / sizeof *solid; v++)
        solid[v] = 1;
    assert_ok(voxel_file_encode(large, 1, solid, &bytes, &size));
    write_file("large.voxels", bytes, size);
    free(bytes);
    assert_true(size < 100);
    assert_ok(voxel_file_read("large.voxels", &g));
    assert_int_equal(g.parts[300 * 300 * 200 - 1], 64);
    free(g.parts);
}

static void damage_is_refused(void **state)
{
    (void)state;
    static float share[ALL];
    size_t size;
    struct voxel_grid g;
    uint8_t *bytes = make_file("whole.voxels", share, &size);
    for (size_t at = 0; at < size; at += at < 64 ? 1 : 97) {
        bytes[at] ^= 4;
        write_file("bad.voxels", bytes, size);
        bytes[at] ^= 4;
        assert_int_equal(voxel_file_read("bad.voxels", &g), E_INPUT);
        assert_null(g.parts);
    }
    for (size_t n = 0; n < size; n += n < 64 ? 1 : 131) {
        write_file("bad.voxels", bytes, n);
        assert_int_equal(voxel_file_read("bad.voxels", &g), E_INPUT);
    }
    assert_int_equal(voxel_file_read("none.voxels", &g), E_INPUT);
    free(bytes);
}

static struct solid *solid_of_file(const double scale, const double turn)
{
    static char path[] = "whole.voxels";
    struct solid *solid;
    struct job_node node = {
        .kind = NODE_SHAPE,
        .shape = SHAPE_VOXELS,
        .u.voxels = {.file = path, .scale = {scale, scale, scale}, .rotate_deg = {0, 0, turn}}};
    assert_ok(solid_create(&node, H / 2, 4 * H, &solid));
    return solid;
}

static void shares_come_back(void **state)
{
    (void)state;
    static float share[ALL];
    size_t size;
    struct coverage *c;
    free(make_file("whole.voxels", share, &size));
    struct solid *solid = solid_of_file(1, 0);
    assert_ok(coverage_create(solid, N, H, &c));
    for (int v = 0; v < ALL; v++)
        assert_int_equal(coverage_at(c, v % NX, v / NX % NY, v / (NX * NY)), lrint((double)share[v] * 64));
    coverage_destroy(&c);
    solid_destroy(&solid);
}

/* Twice as large and half the spacing is the same; at other spacings the volume stays. */
static void other_spacings_keep_the_volume(void **state)
{
    (void)state;
    static float share[ALL];
    static const double h[] = {H / 2, H / 3, 0.81 * H, 1.5 * H};
    size_t size;
    double exact = 0;
    free(make_file("whole.voxels", share, &size));
    for (size_t v = 0; v < ALL; v++)
        exact += (double)share[v] * pow(H, 3);
    struct solid *solid = solid_of_file(1, 0);
    for (size_t k = 0; k < sizeof h / sizeof *h; k++) {
        int n[3];
        double sum = 0;
        struct coverage *c;
        for (int a = 0; a < 3; a++)
            n[a] = (int)ceil(N[a] * H / h[k]);
        assert_ok(coverage_create(solid, n, h[k], &c));
        for (int v = 0; v < n[0] * n[1] * n[2]; v++)
            sum += coverage_at(c, v % n[0], v / n[0] % n[1], v / n[0] / n[1]) / 64.0 * pow(h[k], 3);
        print_message("# voxels of %.3f m from %.3f m: %.3f m3 of %.3f\n", h[k], H, sum, exact);
        assert_true(fabs(sum / exact - 1) < 0.01);
        coverage_destroy(&c);
    }
    solid_destroy(&solid);
}

/* Between a point inside and one outside is the surface, so their distances from it add up to no more than that between them. */
static void distances_never_overstate(void **state)
{
    (void)state;
    static float share[ALL];
    size_t size, sides = 0;
    free(make_file("whole.voxels", share, &size));
    for (int turned = 0; turned < 2; turned++) {
        struct solid *solid = solid_of_file(turned ? 1.7 : 1, turned ? 31 : 0);
        for (uint32_t i = 0; i < 40000; i++) {
            double x[2][3], d[2], apart = 0;
            for (uint32_t a = 0; a < 3; a++) {
                x[0][a] = (draw(i, a) % 10000 / 10000.0 * 1.2 - 0.1) * N[a] * H;
                x[1][a] = x[0][a] + (draw(i, a + 3) % 10000 / 5000.0 - 1) * H * (i % 4 + 0.01);
                apart += pow(x[1][a] - x[0][a], 2);
            }
            for (int e = 0; e < 2; e++)
                d[e] = solid_at(solid, x[e]).distance;
            if ((d[0] <= 0) == (d[1] <= 0))
                continue;
            sides++;
            assert_true(fabs(d[0]) + fabs(d[1]) <= sqrt(apart) * (1 + 1e-9) + 1e-8);
        }
        solid_destroy(&solid);
    }
    assert_true(sides > 3000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_comes_back),         cmocka_unit_test(damage_is_refused),
        cmocka_unit_test(shares_come_back),          cmocka_unit_test(other_spacings_keep_the_volume),
        cmocka_unit_test(distances_never_overstate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
