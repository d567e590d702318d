/* hoodoo's files in other programs: the tools of OpenVDB and OpenEXR, OpenImageIO, and OpenVDB's Python module. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#undef fail /* conflicts with our fail() */

#include "exr/exr.h"
#include "system/atomic_file.h"
#include "unit/sample_frame.h"

static const float COLORS[2][3] = {{0.8F, 0.4F, 0.2F}, {0.5F, 0.3F, 0.1F}};
static const char *const NAMES[2] = {"y", "z"};

static int write_volumes_and_points(void **state)
{
    (void)state;
    for (int up = 0; up < 2; up++) {
        const struct vdb_options options = {
            .up = up, .frame = 1001, .spacing = 0.5, .identity = 7, .color = COLORS, .n_colors = 2};
        struct frame_grids grids;
        struct rock rock;
        struct draft file = {0};
        char path[64];
        assert_int_equal(sample_grids(0.25, &grids), OK);
        assert_int_equal(vdb_volumes(&grids, &options, &file), OK);
        snprintf(path, sizeof path, "volumes.%s.1001.vdb", NAMES[up]);
        assert_int_equal(atomic_file_write(path, file.bytes, file.size), OK);
        draft_drop(&file);
        assert_int_equal(sample_rock(0.5, &rock), OK);
        assert_int_equal(vdb_points(&rock, &options, &file), OK);
        snprintf(path, sizeof path, "points.%s.1001.vdb", NAMES[up]);
        assert_int_equal(atomic_file_write(path, file.bytes, file.size), OK);
        draft_drop(&file);
        rock_free(&rock);
        frame_grids_free(&grids);
    }
    return 0;
}

static void run(const char *command)
{
    char line[1024];
    /* its stdout goes to stderr, since ours is for TAP */
    snprintf(line, sizeof line, "(%s) >&2", command);
    if (system(line) != 0) {
        print_error("failed: %s\n", command);
        assert_true(0);
    }
}

static void openvdb_tools_read_the_volumes(void **state)
{
    (void)state;
    for (int up = 0; up < 2; up++) {
        char command[512];
        snprintf(command, sizeof command,
                 "vdb_print -l volumes.%s.1001.vdb >v && test $(grep -c '^Name: ' v) = 4 &&"
                 " grep -q 'class: level set' v && grep -q 'class: fog volume' v",
                 NAMES[up]);
        run(command);
    }
}

static void openvdb_tools_read_the_points(void **state)
{
    (void)state;
    for (int up = 0; up < 2; up++) {
        char command[512];
        snprintf(command, sizeof command,
                 "vdb_print -l points.%s.1001.vdb >p && grep -q 'Name: points' p && grep -q ptdataidx32 p",
                 NAMES[up]);
        run(command);
    }
}

static void pyopenvdb_finds_everything_in_its_place(void **state)
{
    (void)state;
    const char *top = getenv("HOODOO_TOP");
    for (int up = 0; up < 2; up++) {
        char command[4096];
        snprintf(command, sizeof command,
                 "/usr/bin/python3 '%s/tests/cli/peers/read_volumes.py' volumes.%s.1001.vdb %s",
                 top ? top : ".", NAMES[up], NAMES[up]);
        run(command);
    }
}

static void exr_tools_read_the_pictures(void **state)
{
    (void)state;
    enum { W = 40, H = 30 };
    static float plane[W * H], depth[W * H];
    static uint32_t id[W * H];
    struct aov_channel channels[] = {{"rgba", "R", plane, NULL, 1},  {"rgba", "G", plane, NULL, 1},
                                     {"rgba", "B", plane, NULL, 1},  {"rgba", "A", plane, NULL, 1},
                                     {"depth", "Z", depth, NULL, 0}, {"layer", "layer.id", NULL, id, 0}};
    struct aov_image image = {
        .camera = "main", .width = W, .height = H, .n_channels = 6, .channel = channels};
    for (int i = 0; i < W * H; i++) {
        plane[i] = (float)(i % W) / W;
        depth[i] = 10 + (float)i;
        id[i] = (uint32_t)(i / W);
    }
    for (int layout = 0; layout < 2; layout++) {
        const struct exr_options options = {
            .layout = layout, .fps = 24, .frame = 1001, .owner = "Desert Films"};
        void *bytes;
        size_t size;
        assert_int_equal(exr_encode(&image, &options, &bytes, &size), OK);
        assert_int_equal(atomic_file_write("aov.1001.exr", bytes, size), OK);
        free(bytes);
        run("exrheader aov.1001.exr >h && grep -q 'time 00:00:41:17' h && grep -q 'framesPerSecond.*24/1' h "
            "&&"
            " grep -q 'layer.id, 32-bit unsigned' h");
        /* Its exit code is uninitialised. */
        run("exrinfo aov.1001.exr >i 2>&1; grep -q aov.1001.exr i && ! grep -qiE 'error|invalid' i");
        /* top row first, values where they belong */
        run(layout == AOV_LAYOUT_MULTI ? "oiiotool aov.1001.exr --subimage 1 -o z.exr"
                                       : "oiiotool aov.1001.exr --ch Z -o z.exr");
        run("oiiotool --dumpdata z.exr >d && grep -q 'Pixel (0, 0): 10.0' d && grep -q 'Pixel (3, 2): 93.0' "
            "d");
        run("oiiotool --info -v --stats aov.1001.exr >i && grep -q 'Stats Max:' i && ! grep -qi error i");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(openvdb_tools_read_the_volumes),
        cmocka_unit_test(openvdb_tools_read_the_points),
        cmocka_unit_test(pyopenvdb_finds_everything_in_its_place),
        cmocka_unit_test(exr_tools_read_the_pictures),
    };
    return cmocka_run_group_tests(tests, write_volumes_and_points, NULL);
}
