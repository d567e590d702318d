/* USD: the stage's text, and the crate's bytes, word by word. What Pixar's USD makes of them: tests/peers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#undef fail /* ours is another */

#include "sample_frame.h"
#include "usd/usd.h"

static const double HERE[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1.5, 2, -0.0, 1},
                    THERE[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 9, 2, 3, 1};

static bool holds(const struct text *t, const char *part)
{
    if (strstr(t->data, part))
        return true;
    print_error("no '%s' in:\n%s\n", part, t->data);
    return false;
}

static struct usd_key key_at(int frame, const double m[16], double focal)
{
    struct usd_key key = {.frame = frame, .focal_mm = focal};
    memcpy(key.to_world, m, sizeof key.to_world);
    return key;
}

static void a_stage_says_what_it_is(void **state)
{
    (void)state;
    const struct usd_field field[] = {{"surface", GRID_LEVEL_SET, false}, {"vel", GRID_PLAIN, true}};
    const int volumes[] = {-3, 1001}, points[] = {1001, 1003};
    const struct usd_key still[] = {key_at(1001, HERE, 35)};
    const struct usd_camera camera[] = {{"main", 36, 20.25, 1, still}};
    const struct usd_sequence s = {.name = "1-arch",
                                   .first = -3,
                                   .last = 1010,
                                   .fps = 23.976,
                                   .up = OUTPUT_UP_Z,
                                   .n_fields = 2,
                                   .n_volumes = 2,
                                   .n_points = 2,
                                   .n_cameras = 1,
                                   .field = field,
                                   .low = {0, -1.25, 0},
                                   .high = {10, 2, 3},
                                   .volumes_frame = volumes,
                                   .points_frame = points,
                                   .camera = camera};
    struct text t = {0}, again = {0};
    usd_stage(&s, &t);
    usd_stage(&s, &again);
    assert_int_equal(text_status(&t), OK);
    assert_string_equal(t.data, again.data);
    assert_memory_equal(t.data, "#usda 1.0\n", 10);
    assert_true(holds(&t, "defaultPrim = \"_1_arch\"") && holds(&t, "metersPerUnit = 1\n") &&
                holds(&t, "upAxis = \"Z\"") && holds(&t, "startTimeCode = -3\n") &&
                holds(&t, "endTimeCode = 1010\n") && holds(&t, "timeCodesPerSecond = 23.976\n"));
    assert_true(holds(&t, "float3[] extent = [(0, -1.25, 0), (10, 2, 3)]") &&
                holds(&t, "rel field:vel = </_1_arch/rock/vel>") &&
                holds(&t, "token fieldClass = \"levelSet\"\n            token fieldDataType = \"float\"") &&
                holds(&t, "token fieldClass = \"unknown\"\n            token fieldDataType = \"float3\""));
    /* Frames are written in paths as in the folder. */
    assert_true(holds(&t, "-3: @./volumes/1-arch.-0003.vdb@,\n") &&
                holds(&t, "1001: @./volumes/1-arch.1001.vdb@,\n"));
    assert_true(holds(&t, "double2[] active = [(1001, 0), (1003, 1)]") &&
                holds(&t, "double2[] times = [(1001, 1001), (1003, 1003)]") &&
                holds(&t, "asset manifestAssetPath = @./points/1-arch.clips.usda@"));
    /* Decimetres; no negative zero. */
    assert_true(holds(&t, "float focalLength = 0.35\n") && holds(&t, "float horizontalAperture = 0.36\n") &&
                holds(&t, "float verticalAperture = 0.2025\n") && holds(&t, "(1.5, 2, 0, 1) )"));
    text_free(&t);
    text_free(&again);
}

static void a_camera_that_moves_has_samples(void **state)
{
    (void)state;
    const struct usd_key keys[] = {key_at(1, HERE, 35), key_at(2, THERE, 35), key_at(3, THERE, 50)};
    const struct usd_camera camera[] = {
        {"a b", 36, 20, 2, keys}, {"a-b", 36, 20, 3, keys}, {"", 36, 20, 1, keys}, {"9", 36, 20, 1, keys}};
    const struct usd_sequence s = {
        .name = "x", .first = 1, .last = 3, .fps = 24, .n_cameras = 4, .camera = camera};
    struct text t = {0};
    usd_stage(&s, &t);
    assert_int_equal(text_status(&t), OK);
    assert_true(holds(&t, "xformOp:transform.timeSamples = {\n                1: ( (1, 0, 0, 0)"));
    assert_true(holds(&t, "focalLength.timeSamples = {\n                1: 0.35,\n                2: 0.35,\n"
                          "                3: 0.5,\n"));
    assert_true(holds(&t, "def Camera \"a_b\"") && holds(&t, "def Camera \"a_b__2\"") &&
                holds(&t, "def Camera \"_\"") && holds(&t, "def Camera \"_9\""));
    /* No frame is done: there is nothing but cameras. */
    assert_null(strstr(t.data, "Volume"));
    assert_null(strstr(t.data, "clips"));
    text_free(&t);
}

static void every_attribute_is_declared(void **state)
{
    (void)state;
    const struct usd_sequence s = {.name = "x", .first = 1, .last = 3, .fps = 24};
    struct text t = {0};
    const struct usd_prim *const prim = usd_points_prim(false);
    usd_clips(&s, prim, &t);
    for (size_t i = 0; i < prim->n; i++) {
        char line[80];
        snprintf(line, sizeof line, "    %s %s", prim->attribute[i].type, prim->attribute[i].name);
        assert_true(holds(&t, line));
    }
    assert_true(holds(&t, "float[] widths (interpolation = \"constant\")"));
    text_free(&t);
}

static uint64_t u64(const void *bytes, size_t at)
{
    uint64_t value;
    memcpy(&value, (const char *)bytes + at, sizeof value);
    return value;
}

static void a_crate_holds_the_surface(void **state)
{
    (void)state;
    static const float color[2][3] = {{1, 0, 0}, {0, 0, 1}};
    struct rock rock;
    struct draft file = {0}, again = {0};
    size_t n = 0;
    for (int up = 0; up < 2; up++) {
        const struct vdb_options options = {
            .up = up, .frame = 1001, .spacing = 0.5, .color = color, .n_colors = 2};
        assert_int_equal(sample_rock(0.5, &rock), OK);
        n = 0;
        size_t first = SIZE_MAX;
        for (size_t i = 0; i < rock.n; i++) {
            const float *normal = rock.N + 4 * i;
            const bool skin = normal[0] != 0 || normal[1] != 0 || normal[2] != 0;
            first = skin && n == 0 ? i : first;
            n += skin;
        }
        assert_int_equal(usd_points(&rock, &options, 24, &file), OK);
        assert_int_equal(usd_points(&rock, &options, 24, &again), OK);
        assert_int_equal(file.size, again.size);
        assert_memory_equal(file.bytes, again.bytes, file.size);
        assert_memory_equal(file.bytes, "PXR-USDC\0\10\0", 11);
        const size_t toc = u64(file.bytes, 16);
        assert_true(toc < file.size && u64(file.bytes, toc) == 6 && toc + 8 + 6 * 32 == file.size);
        for (size_t s = 0; s < 6; s++) {
            const size_t start = u64(file.bytes, toc + 8 + 32 * s + 16),
                         size = u64(file.bytes, toc + 8 + 32 * s + 24);
            assert_true(start >= 88 && start % 8 == 0 && start + size <= toc);
        }
        /* The first point, with the number of all before it, turned to the files' axes. */
        const float *p = rock.P + 4 * first;
        const float turned[3] = {p[0], up == OUTPUT_UP_Y ? p[2] : p[1], up == OUTPUT_UP_Y ? 0 - p[1] : p[2]};
        unsigned char wanted[8 + sizeof turned];
        const uint64_t count = n;
        memcpy(wanted, &count, 8);
        memcpy(wanted + 8, turned, sizeof turned);
        assert_true(n > 0 && memmem(file.bytes, file.size, wanted, sizeof wanted) != NULL);
        draft_drop(&file);
        draft_drop(&again);
        rock_free(&rock);
    }
    print_message("# %zu points\n", n);
}

static void a_rock_without_a_surface_is_no_error(void **state)
{
    (void)state;
    const struct vdb_options options = {.frame = 1, .spacing = 1};
    struct rock rock = {0};
    struct draft file = {0};
    assert_int_equal(usd_points(&rock, &options, 24, &file), OK);
    assert_true(file.size > 88);
    draft_drop(&file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stage_says_what_it_is),
        cmocka_unit_test(a_camera_that_moves_has_samples),
        cmocka_unit_test(every_attribute_is_declared),
        cmocka_unit_test(a_crate_holds_the_surface),
        cmocka_unit_test(a_rock_without_a_surface_is_no_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
