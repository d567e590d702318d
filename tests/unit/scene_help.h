/* Scenes built by hand, for the tests of src/scene. */
#ifndef SCENE_HELP_H
#define SCENE_HELP_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/log.h"
#include "base/status.h"
#include "scene/coverage.h"
#include "scene/scene.h"

#include <cmocka.h> /* after ours: it has a macro fail() */

/* The shapes below give every key a default first. */
#pragma GCC diagnostic ignored "-Woverride-init"
#define PLACED .scale = {1, 1, 1}

#define BOX(...) ((struct job_node){.kind = NODE_SHAPE, .shape = SHAPE_BOX, .u.box = {PLACED, __VA_ARGS__}})
#define SPHERE(...)                                                                                          \
    ((struct job_node){.kind = NODE_SHAPE, .shape = SHAPE_SPHERE, .u.sphere = {PLACED, __VA_ARGS__}})
#define CYLINDER(...)                                                                                        \
    ((struct job_node){.kind = NODE_SHAPE,                                                                   \
                       .shape = SHAPE_CYLINDER,                                                              \
                       .u.cylinder = {PLACED, .top_radius_m = -1, __VA_ARGS__}})
#define PLANE(...)                                                                                           \
    ((struct job_node){.kind = NODE_SHAPE, .shape = SHAPE_PLANE, .u.plane = {PLACED, __VA_ARGS__}})
#define MESH(...)                                                                                            \
    ((struct job_node){.kind = NODE_SHAPE, .shape = SHAPE_MESH, .u.mesh = {PLACED, __VA_ARGS__}})
#define HEIGHTFIELD(...)                                                                                     \
    ((struct job_node){                                                                                      \
        .kind = NODE_SHAPE, .shape = SHAPE_HEIGHTFIELD, .u.heightfield = {PLACED, __VA_ARGS__}})
#define GROUP(operator, ...)                                                                                 \
    ((struct job_node){.kind = operator,                                                                     \
                       .child =(struct job_node *[]){__VA_ARGS__},                                           \
                       .n_child = sizeof((struct job_node *[]){__VA_ARGS__}) / sizeof(struct job_node *),    \
                       .u.group = {PLACED}})

/* A cubic domain of n voxels a side. */
static inline struct job cube_job(struct job_node *scene, int n, double h)
{
    return (struct job){
        .scene = scene,
        .seed = 7,
        .domain = {.size_m = {n * h, n * h, n * h}, .spacing_m = h},
        .noise = {.scale_m = 10, .octaves = 3, .flatten = 1},
    };
}

/* m3 of rock in a cubic domain of n voxels a side, by the share of each voxel. */
static inline double volume_of(const struct job_node *node, int n, double h)
{
    struct solid *solid;
    struct coverage *coverage;
    const int size[3] = {n, n, n};
    uint64_t sum = 0;
    assert_int_equal(solid_create(node, h / 2, COVERAGE_REACH * h, &solid), OK);
    assert_int_equal(coverage_create(solid, size, h, &coverage), OK);
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++)
                sum += coverage_at(coverage, i, j, k);
    coverage_destroy(&coverage);
    solid_destroy(&solid);
    return (double)sum / COVERAGE_FULL * h * h * h;
}

static inline void assert_close(double value, double expected, double share)
{
    if (!(fabs(value - expected) <= share * fabs(expected)))
        fail_msg("%.9g is not within %g of %.9g (off by %.3g)", value, share, expected, value / expected - 1);
}

/* The call failed so, and its sentence has both words. */
#define assert_failed(call, code, word, other)                                                               \
    do {                                                                                                     \
        assert_int_equal(call, code);                                                                        \
        if (!strstr(status_message(), word) || !strstr(status_message(), other))                             \
            fail_msg("the message lacks '%s' or '%s': %s", word, other, status_message());                   \
    } while (0)

/* A file of this test's own, in $TMPDIR or /tmp; removed by remove_files(). */
static char scratch_folder[64];

static inline char *scratch_file(const char *name)
{
    static char path[4][256];
    static unsigned turn;
    if (!*scratch_folder) {
        const char *tmp = getenv("TMPDIR");
        snprintf(scratch_folder, sizeof scratch_folder, "%.30s/hoodoo-scene.XXXXXX", tmp ? tmp : "/tmp");
        assert_non_null(mkdtemp(scratch_folder));
    }
    snprintf(path[++turn % 4], sizeof *path, "%s/%s", scratch_folder, name);
    return path[turn % 4];
}

static inline char *write_file(const char *name, const void *bytes, size_t n)
{
    char *path = scratch_file(name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    assert_int_equal(fclose(f), 0);
    return path;
}

static inline char *write_text(const char *name, const char *text)
{
    return write_file(name, text, strlen(text));
}

static inline int remove_files(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", scratch_folder);
    return *scratch_folder ? system(command) : 0;
}

static inline uint32_t next_random(uint32_t *x)
{
    *x ^= *x << 13;
    *x ^= *x >> 17;
    *x ^= *x << 5;
    return *x;
}

#endif
