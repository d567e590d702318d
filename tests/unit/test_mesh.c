/* Triangles that are apart or not, against plain segment tests; and what marching and simplifying promise. */
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vector.h"
#include "mesh/apart.h"
#include "mesh/trimesh.h"

static double det(const double a[3], const double b[3], const double c[3])
{
    double n[3];
    cross3(b, c, n);
    return dot3(a, n);
}

/* Six times the volume of a tetrahedron. */
static double volume6(const double a[3], const double b[3], const double c[3], const double d[3])
{
    double u[3], v[3], w[3];
    minus3(b, a, u);
    minus3(c, a, v);
    minus3(d, a, w);
    return det(u, v, w);
}

/* Does segment pq pass through the triangle? In general position. */
static bool pierces(const double p[3], const double q[3], const double t[3][3])
{
    if ((volume6(p, t[0], t[1], t[2]) > 0) == (volume6(q, t[0], t[1], t[2]) > 0))
        return false;
    bool a = volume6(p, q, t[0], t[1]) > 0, b = volume6(p, q, t[1], t[2]) > 0,
         c = volume6(p, q, t[2], t[0]) > 0;
    return a == b && b == c;
}

static uint32_t counter;
static double uniform(void)
{
    counter = counter * 1664525u + 1013904223u;
    return (double)(counter >> 8) / (1 << 24);
}

static void fill(double t[3][3], double size)
{
    for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++)
            t[k][d] = size * (uniform() - 0.5);
}

static void triangles_in_general_position(void **state)
{
    (void)state;
    int wrong = 0, crossing = 0, n = 200000;
    for (int i = 0; i < n; i++) {
        double a[3][3], b[3][3];
        bool meet = false;
        fill(a, 1);
        fill(b, 1);
        int shared = i % 2;
        if (shared)
            memcpy(b[0], a[0], sizeof a[0]);
        /* With a corner in common they meet elsewhere only where the edges opposite of it go through. */
        for (int k = shared; k < (shared ? 2 : 3); k++)
            meet |= pierces(a[k], a[(k + 1) % 3], (const double(*)[3])b) ||
                    pierces(b[k], b[(k + 1) % 3], (const double(*)[3])a);
        wrong += meet == triangles_apart((const double(*)[3])a, (const double(*)[3])b, shared);
        crossing += meet;
    }
    print_message("# %d of %d pairs cross, %d judged otherwise\n", crossing, n, wrong);
    assert_true(crossing > n / 20);
    assert_int_equal(wrong, 0);
}

/* Triangles of one plane: those of a fan around a corner in any two sectors, and neighbours. */
static void triangles_in_a_plane(void **state)
{
    (void)state;
    enum { SECTORS = 8 };
    const double pi = acos(-1.0);
    int apart = 0, overlapping = 0;
    for (int turn = 0; turn < 20; turn++) {
        double u[3], v[3], n[3], frame[3][3];
        fill(frame, 1);
        memcpy(u, frame[0], sizeof u);
        cross3(u, frame[1], n);
        cross3(n, u, v);
        double x[SECTORS][3];
        for (int s = 0; s < SECTORS; s++)
            for (int d = 0; d < 3; d++)
                x[s][d] = cos(2 * pi * s / SECTORS) * u[d] / sqrt(dot3(u, u)) +
                          sin(2 * pi * s / SECTORS) * v[d] / sqrt(dot3(v, v));
        for (int s = 0; s < SECTORS; s++)
            for (int t = 2; t < SECTORS - 1; t++) {
                double a[3][3] = {{0}}, b[3][3] = {{0}}, c[3][3] = {{0}};
                memcpy(a[1], x[s], sizeof a[1]);
                memcpy(a[2], x[(s + 1) % SECTORS], sizeof a[2]);
                memcpy(b[1], x[(s + t) % SECTORS], sizeof b[1]);
                memcpy(b[2], x[(s + t + 1) % SECTORS], sizeof b[2]);
                apart += triangles_apart((const double(*)[3])a, (const double(*)[3])b, 1);
                /* A wide one over the narrow one. */
                memcpy(c[1], x[(s + SECTORS - 1) % SECTORS], sizeof c[1]);
                memcpy(c[2], x[(s + 2) % SECTORS], sizeof c[2]);
                overlapping += !triangles_apart((const double(*)[3])a, (const double(*)[3])c, 1);
            }
    }
    assert_int_equal(apart, 20 * SECTORS * (SECTORS - 3));
    assert_int_equal(overlapping, 20 * SECTORS * (SECTORS - 3));
    const double flat[3][3] = {{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}},
                 next[3][3] = {{0, 0, 0}, {1, 0, 0}, {0.3, -1, 0}},
                 folded[3][3] = {{0, 0, 0}, {1, 0, 0}, {0.4, 0.7, 0}},
                 beside[3][3] = {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}};
    assert_true(triangles_apart(flat, next, 2));
    assert_false(triangles_apart(flat, folded, 2));
    assert_true(triangles_apart(flat, beside, 0));
    assert_false(triangles_apart(flat, flat, 3));
}

/* Every directed edge has its opposite, once. */
static int compare_edges(const void *a, const void *b)
{
    return memcmp(a, b, 2 * sizeof(uint32_t));
}

static bool is_closed(const struct trimesh *m)
{
    uint32_t(*edge)[2] = calloc(3 * m->n_triangles + 1, sizeof *edge);
    bool closed = true;
    for (size_t i = 0; i < 3 * m->n_triangles; i++) {
        edge[i][0] = m->triangle[i];
        edge[i][1] = m->triangle[i % 3 == 2 ? i - 2 : i + 1];
    }
    qsort(edge, 3 * m->n_triangles, sizeof *edge, compare_edges);
    for (size_t i = 0; i < 3 * m->n_triangles; i++) {
        uint32_t back[2] = {edge[i][1], edge[i][0]};
        closed &= (i == 0 || compare_edges(edge[i], edge[i - 1]) != 0) &&
                  bsearch(back, edge, 3 * m->n_triangles, sizeof *edge, compare_edges);
    }
    free(edge);
    return closed;
}

/* All 256 signs of a cell's corners, alone in space. */
static void every_case_is_closed(void **state)
{
    (void)state;
    for (unsigned inside = 1; inside < 256; inside++) {
        float field[64];
        struct trimesh m;
        const struct trimesh_lattice l = {.n = {4, 4, 4}, .voxel = 0.5, .origin = {3, -7, 11}};
        size_t crossings;
        for (int i = 0; i < 64; i++)
            field[i] = 0.1f + (float)uniform();
        for (unsigned c = 0; c < 8; c++)
            if (inside >> c & 1)
                field[21 + (c & 1) + 4 * (c >> 1 & 1) + 16 * (c >> 2)] *= -1;
        assert_int_equal(trimesh_march(field, &l, &m), OK);
        assert_true(m.n_triangles >= 8 && is_closed(&m));
        assert_true(trimesh_volume(&m) > 0);
        assert_int_equal(trimesh_crossings(&m, &crossings), OK);
        assert_int_equal(crossings, 0);
        trimesh_free(&m);
    }
}

static void nothing_gives_nothing(void **state)
{
    (void)state;
    static float field[1000];
    const struct trimesh_lattice l = {.n = {10, 10, 10}, .voxel = 1};
    struct trimesh m;
    uint32_t *kept;
    for (int i = 0; i < 1000; i++)
        field[i] = i % 3 ? 1 : NAN;
    assert_int_equal(trimesh_march(field, &l, &m), OK);
    assert_true(m.n_vertices == 0 && m.n_triangles == 0);
    assert_int_equal(trimesh_smooth(&m, NULL, 5, 1), OK);
    assert_int_equal(trimesh_simplify(&m, NULL, 1, 5, &kept), OK);
    free(kept);
    trimesh_free(&m);
}

static void too_far_away_is_refused(void **state)
{
    (void)state;
    float field[27] = {0};
    const struct trimesh_lattice l = {.n = {3, 3, 3}, .voxel = 0.01, .origin = {0, 1e6, 0}};
    struct trimesh m;
    assert_int_equal(trimesh_march(field, &l, &m), E_INPUT);
    assert_non_null(strstr(status_message(), "from the origin"));
}

/* Two tetrahedra, one pushed into the other. */
static void crossings_are_found(void **state)
{
    (void)state;
    float vertex[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    uint32_t triangle[8][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                               {4, 6, 5}, {4, 5, 7}, {4, 7, 6}, {5, 6, 7}};
    struct trimesh m = {8, 8, vertex[0], triangle[0]};
    size_t n;
    for (int step = 0; step < 2; step++) {
        for (int k = 0; k < 4; k++)
            for (int d = 0; d < 3; d++)
                vertex[4 + k][d] = vertex[k][d] + (step ? 0.2f : 2);
        assert_int_equal(trimesh_crossings(&m, &n), OK);
        assert_true(step ? n > 0 : n == 0);
    }
}

/* A rough ball in two colours, smoothed and simplified: closed, of its volume, no vertex gone farther than it may,
 * and the same from the same. */
static void a_rough_ball_keeps_its_shape(void **state)
{
    (void)state;
    enum { N = 26 };
    static float field[N * N * N], again[N * N * N];
    const struct trimesh_lattice l = {.n = {N, N, N}, .voxel = 0.5};
    const double tolerance = 0.1;
    for (int i = 0; i < N * N * N; i++) {
        double x = i % N - 12.3, y = i / N % N - 12.6, z = i / N / N - 12.1;
        field[i] = again[i] = (float)(0.5 * (sqrt(x * x + y * y + z * z) - 9 + 0.4 * (uniform() - 0.5)));
    }
    struct trimesh fine, ball, twin;
    uint32_t *kept, *kept_twin, *label;
    size_t crossings;
    assert_int_equal(trimesh_march(field, &l, &ball), OK);
    assert_int_equal(trimesh_march(again, &l, &twin), OK);
    label = calloc(ball.n_vertices, sizeof *label);
    for (size_t v = 0; v < ball.n_vertices; v++)
        label[v] = ball.vertex[3 * v + 2] > 7;
    const double volume = trimesh_volume(&ball);
    assert_int_equal(trimesh_smooth(&ball, label, 10, 0.2), OK);
    assert_int_equal(trimesh_smooth(&twin, label, 10, 0.2), OK);
    assert_true(fabs(trimesh_volume(&ball) / volume - 1) < 1e-3);
    fine = (struct trimesh){.n_vertices = ball.n_vertices, .n_triangles = ball.n_triangles};
    fine.vertex = malloc(3 * fine.n_vertices * sizeof *fine.vertex);
    memcpy(fine.vertex, ball.vertex, 3 * fine.n_vertices * sizeof *fine.vertex);
    assert_int_equal(trimesh_simplify(&ball, label, tolerance, 4, &kept), OK);
    assert_int_equal(trimesh_simplify(&twin, label, tolerance, 4, &kept_twin), OK);
    assert_int_equal(ball.n_triangles, twin.n_triangles);
    assert_memory_equal(ball.triangle, twin.triangle, 3 * ball.n_triangles * sizeof *ball.triangle);
    assert_memory_equal(ball.vertex, twin.vertex, 3 * ball.n_vertices * sizeof *ball.vertex);
    for (size_t v = 0; v < ball.n_vertices; v++)
        assert_memory_equal(ball.vertex + 3 * v, fine.vertex + 3 * kept[v], 3 * sizeof *ball.vertex);
    double farthest = 0;
    for (size_t v = 0; v < fine.n_vertices; v++) {
        double p[3], least = INFINITY;
        for (int d = 0; d < 3; d++)
            p[d] = (double)fine.vertex[3 * v + (size_t)d];
        for (size_t t = 0; t < ball.n_triangles; t++) {
            double x[3][3];
            for (int k = 0; k < 3; k++)
                for (int d = 0; d < 3; d++)
                    x[k][d] = (double)ball.vertex[3 * (size_t)ball.triangle[3 * t + (size_t)k] + (size_t)d];
            least = fmin(least, triangle_distance2(p, (const double(*)[3])x));
        }
        farthest = fmax(farthest, sqrt(least));
    }
    print_message("# %zu of %zu triangles, %.4f m off at most\n", ball.n_triangles, fine.n_triangles,
                  farthest);
    assert_true(ball.n_triangles < fine.n_triangles / 2 && farthest <= tolerance);
    assert_true(is_closed(&ball));
    assert_int_equal(trimesh_crossings(&ball, &crossings), OK);
    assert_int_equal(crossings, 0);
    trimesh_free(&ball);
    trimesh_free(&twin);
    free(fine.vertex);
    free(kept);
    free(kept_twin);
    free(label);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_in_general_position), cmocka_unit_test(triangles_in_a_plane),
        cmocka_unit_test(every_case_is_closed),          cmocka_unit_test(nothing_gives_nothing),
        cmocka_unit_test(too_far_away_is_refused),       cmocka_unit_test(crossings_are_found),
        cmocka_unit_test(a_rough_ball_keeps_its_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
