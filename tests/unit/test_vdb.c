/* OpenVDB files: what goes in comes out, byte for byte the same each time, and damage is noticed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#undef fail /* ours is another */

#include "base/atomic_file.h"
#include "unit/sample_frame.h"

static const float COLORS[2][3] = {{0.8F, 0.4F, 0.2F}, {0.5F, 0.3F, 0.1F}};

static struct vdb_options options_of(int up)
{
    return (struct vdb_options){.up = up,
                                .frame = 1001,
                                .spacing = 0.5,
                                .identity = 0x0123456789abcdefU,
                                .color = COLORS,
                                .n_colors = 2};
}

static void write_volumes(const char *path, double voxel, const struct vdb_options *options)
{
    struct frame_grids grids;
    struct vdb_bytes file;
    assert_int_equal(sample_grids(voxel, &grids), OK);
    assert_int_equal(vdb_volumes(&grids, options, &file), OK);
    assert_int_equal(atomic_file_write(path, file.bytes, file.size), OK);
    free(file.bytes);
    sample_grids_free(&grids);
}

struct measure {
    double area, volume, centre[3], worst_normal, worst_value;
    size_t open_edges;
};

static int compare_edges(const void *a, const void *b)
{
    return memcmp(a, b, 2 * sizeof(uint32_t));
}

static struct measure measure_mesh(const struct vdb_mesh *m)
{
    struct measure r = {.worst_normal = 1};
    uint32_t(*edge)[2] = calloc(3 * m->n_triangles, sizeof *edge);
    for (size_t t = 0; t < m->n_triangles; t++) {
        const uint32_t *c = m->triangle + 3 * t;
        double p[3][3], u[3], v[3], n[3];
        for (int k = 0; k < 3; k++)
            for (int a = 0; a < 3; a++)
                p[k][a] = (double)m->vertex[3 * c[k] + (uint32_t)a];
        for (int a = 0; a < 3; a++) {
            u[a] = p[1][a] - p[0][a];
            v[a] = p[2][a] - p[0][a];
        }
        for (int a = 0; a < 3; a++)
            n[a] = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
        const double area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
        r.area += area;
        for (int a = 0; a < 3; a++) {
            r.volume += p[0][a] * n[a] / 6;
            r.centre[a] += area * (p[0][a] + p[1][a] + p[2][a]) / 3;
        }
        for (int k = 0; k < 3; k++) {
            edge[3 * t + (size_t)k][0] = c[k];
            edge[3 * t + (size_t)k][1] = c[(k + 1) % 3];
        }
    }
    for (int a = 0; a < 3; a++)
        r.centre[a] /= r.area;
    /* closed: every directed edge has its opposite, once */
    qsort(edge, 3 * m->n_triangles, sizeof *edge, compare_edges);
    for (size_t e = 0; e < 3 * m->n_triangles; e++) {
        const uint32_t back[2] = {edge[e][1], edge[e][0]};
        if (!bsearch(back, edge, 3 * m->n_triangles, sizeof *edge, compare_edges) ||
            (e > 0 && compare_edges(edge[e], edge[e - 1]) == 0))
            r.open_edges++;
    }
    free(edge);
    for (size_t v = 0; v < m->n_vertices; v++) {
        double x[3], dot = 0;
        for (int a = 0; a < 3; a++)
            x[a] = (double)m->vertex[3 * v + (size_t)a];
        const double d = ball_distance(x) + BALL_RADIUS;
        for (int a = 0; a < 3; a++)
            dot += (double)m->normal[3 * v + (size_t)a] * (x[a] - BALL_CENTRE[a]) / d;
        r.worst_normal = fmin(r.worst_normal, dot);
        if (m->value)
            r.worst_value = fmax(r.worst_value, fabs((double)m->value[v] / ball_stress(x) - 1));
    }
    return r;
}

static void mesh_of_a_ball_is_closed_and_true(void **state)
{
    (void)state;
    struct measure r[2];
    const char *const names[] = {"stress"};
    for (int up = 0; up < 2; up++) {
        const struct vdb_options options = options_of(up);
        struct vdb_mesh mesh;
        write_volumes("ball.vdb", 0.25, &options);
        assert_int_equal(vdb_mesh_read("ball.vdb", 0, names, 1, &mesh), OK);
        assert_true(mesh.n_vertices > 1000);
        r[up] = measure_mesh(&mesh);
        print_message("# area %g volume %g normal %g value %g centre %g %g %g\n", r[up].area, r[up].volume,
                      r[up].worst_normal, r[up].worst_value, r[up].centre[0], r[up].centre[1],
                      r[up].centre[2]);
        assert_int_equal(r[up].open_edges, 0);
        const double pi = acos(-1.0), R = BALL_RADIUS;
        assert_true(fabs(r[up].area / (4 * pi * R * R) - 1) < 0.01);
        assert_true(fabs(r[up].volume / (4 * pi * R * R * R / 3) - 1) < 0.01);
        assert_true(r[up].worst_normal > 0.99);
        assert_true(r[up].worst_value < 0.01);
        for (int a = 0; a < 3; a++)
            assert_true(fabs(r[up].centre[a] - BALL_CENTRE[a]) < 0.01);
        vdb_mesh_free(&mesh);
    }
    assert_true(fabs(r[0].area / r[1].area - 1) < 1e-5);
    assert_true(fabs(r[0].volume / r[1].volume - 1) < 1e-5);
}

static void equal_input_gives_equal_bytes(void **state)
{
    (void)state;
    struct frame_grids grids;
    struct vdb_bytes a, b;
    struct vdb_options options = options_of(OUTPUT_UP_Y);
    assert_int_equal(sample_grids(0.25, &grids), OK);
    assert_int_equal(vdb_volumes(&grids, &options, &a), OK);
    assert_int_equal(vdb_volumes(&grids, &options, &b), OK);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.bytes, b.bytes, a.size);
    free(b.bytes);
    options.identity++;
    assert_int_equal(vdb_volumes(&grids, &options, &b), OK);
    assert_int_equal(a.size, b.size);
    assert_memory_not_equal(a.bytes, b.bytes, a.size);
    free(a.bytes);
    free(b.bytes);
    sample_grids_free(&grids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mesh_of_a_ball_is_closed_and_true),
        cmocka_unit_test(equal_input_gives_equal_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
