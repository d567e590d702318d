/* Joint maps: straight columns where the image is not black, as high as it is grey if the job says so. */
#include "scene_help.h"
#include "shape/jointmap.h"

enum { SIZE = 64 };

/* A disc of grey 128, and beside it a bar of white. */
static char *write_map(const char *name)
{
    static unsigned char bytes[64 + SIZE * SIZE];
    size_t n = (size_t)snprintf((char *)bytes, 64, "P5\n%d %d\n255\n", SIZE, SIZE);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            int disc = (x - 24) * (x - 24) + (y - 32) * (y - 32) < 16 * 16;
            bytes[n++] = disc ? 128 : x >= 48 && x < 56 ? 255 : 0;
        }
    return write_file(name, bytes, n);
}

static struct job_jointmap job_of(char *file)
{
    return (struct job_jointmap){.file = file, .max_m = {16, 16, 10}, .black = 0.02, .scale = {1, 1, 1}};
}

static void columns_have_the_outline_of_the_map(void **state)
{
    (void)state;
    struct job_jointmap job = job_of(write_map("map.pgm"));
    struct job_node node = {.kind = NODE_SHAPE, .shape = SHAPE_JOINTMAP, .u.jointmap = job};
    double disc = M_PI * 4 * 4, bar = 2 * 16;
    assert_close(volume_of(&node, 32, 0.5), 10 * (disc + bar), 0.01);
    node.u.jointmap.reach = true;
    assert_close(volume_of(&node, 32, 0.5), 10 * (128 / 255.0 * disc + bar), 0.01);
    node.u.jointmap.black = 0.6;
    assert_close(volume_of(&node, 32, 0.5), 10 * bar, 0.01);
}

/* No point nearer than the distance says is on the other side. */
static void distances_are_lower_bounds(void **state)
{
    (void)state;
    struct job_jointmap job = job_of(write_map("map.pgm"));
    job.reach = true;
    struct jointmap *map;
    assert_int_equal(jointmap_create(&job, &map), OK);
    uint32_t seed = 1;
    for (int i = 0; i < 20000; i++) {
        double x[2][3], length = 0, d[2], step[3];
        for (int a = 0; a < 3; a++) {
            seed = seed * 1664525u + 1013904223u;
            x[0][a] = 18.0 * (seed >> 8) / 16777216.0 - 1;
            seed = seed * 1664525u + 1013904223u;
            step[a] = 2.0 * (seed >> 8) / 16777216.0 - 1;
            length += step[a] * step[a];
        }
        d[0] = jointmap_distance(map, x[0]);
        for (int a = 0; a < 3; a++)
            x[1][a] = x[0][a] + 0.999 * fabs(d[0]) * step[a] / sqrt(length);
        d[1] = jointmap_distance(map, x[1]);
        assert_true((d[0] > 0) == (d[1] > 0) || fabs(d[0]) < 1e-8);
    }
    jointmap_destroy(&map);
    assert_null(map);
}

static void maps_without_rock_are_refused(void **state)
{
    (void)state;
    struct job_jointmap job = job_of(write_map("map.pgm"));
    struct jointmap *map = NULL;
    job.black = 1;
    assert_failed(jointmap_create(&job, &map), E_USAGE, "map.pgm", "no rock");
    job.file = write_file("broken.pgm", "P5\n64 64\n255\n", 13);
    assert_failed(jointmap_create(&job, &map), E_INPUT, "broken.pgm", "");
    assert_null(map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_have_the_outline_of_the_map),
        cmocka_unit_test(distances_are_lower_bounds),
        cmocka_unit_test(maps_without_rock_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
