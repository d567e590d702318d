/* OpenVDB files: what goes in comes out, byte for byte the same each time, and damage is noticed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#undef fail /* ours is another */

#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/hash.h"
#include "system/atomic_file.h"
#include "text/json.h"
#include "unit/damage.h"
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
    struct draft file = {0};
    assert_int_equal(sample_grids(voxel, &grids), OK);
    assert_int_equal(vdb_volumes(&grids, options, &file), OK);
    assert_int_equal(atomic_file_write(path, file.bytes, file.size), OK);
    draft_drop(&file);
    frame_grids_free(&grids);
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
        assert_int_equal(vdb_mesh_read("ball.vdb", 0, names, 1, 0, &mesh), OK);
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

static void write_points(const char *path, double h, const struct vdb_options *options)
{
    struct rock rock;
    struct draft file = {0};
    assert_int_equal(sample_rock(h, &rock), OK);
    assert_int_equal(vdb_points(&rock, options, &file), OK);
    assert_int_equal(atomic_file_write(path, file.bytes, file.size), OK);
    draft_drop(&file);
    rock_free(&rock);
}

/* Member by member: there is room between them that holds anything. */
static void assert_same_lattice(const struct grid_lattice *a, const struct grid_lattice *b)
{
    assert_memory_equal(a->n, b->n, sizeof a->n);
    assert_true(a->voxel == b->voxel);
    assert_memory_equal(a->origin, b->origin, sizeof a->origin);
}

/* With the ball's, as a file has it: cut at the background, and nothing where no rock is. */
static void compare_sample(const struct frame_grids *out, const int c[3])
{
    const struct ball_sample want = ball_sample(&out->lattice, c);
    const float background = grid_background(out, &out->grid[0]), none[3] = {0};
    const ptrdiff_t at = grid_row(out, c[0], c[1], c[2]);
    const float *vel = at < 0 ? none : out->grid[3].value + 3 * at;
    assert_true(grid_at(out, &out->grid[0], c[0], c[1], c[2]) ==
                fmaxf(fminf(want.surface, background), -background));
    assert_true(grid_at(out, &out->grid[1], c[0], c[1], c[2]) == want.density);
    assert_true(grid_at(out, &out->grid[2], c[0], c[1], c[2]) == (want.density > 0 ? want.stress : 0));
    assert_memory_equal(vel, want.vel, sizeof want.vel);
}

static void volumes_come_back(void **state)
{
    (void)state;
    for (int up = 0; up < 2; up++)
        for (int codec = 0; codec < 3; codec++) {
            struct vdb_options options = options_of(up);
            struct frame_grids in, out;
            int bricks[3];
            options.codec = codec;
            write_volumes("round.vdb", 0.25, &options);
            assert_int_equal(sample_grids(0.25, &in), OK);
            assert_int_equal(vdb_volumes_read("round.vdb", &out), OK);
            assert_same_lattice(&in.lattice, &out.lattice);
            assert_int_equal(out.n_grids, in.n_grids);
            assert_true(out.bricks.count > 10 && out.bricks.count <= in.bricks.count);
            assert_true(codec > 0 || in.bricks.count < grid_bricks_of(in.lattice.n, bricks));
            for (size_t g = 0; g < in.n_grids; g++) {
                assert_string_equal(in.grid[g].name, out.grid[g].name);
                assert_int_equal(in.grid[g].kind, out.grid[g].kind);
            }
            for (int k = 0; k < in.lattice.n[2]; k++)
                for (int j = 0; j < in.lattice.n[1]; j++)
                    for (int i = 0; i < in.lattice.n[0]; i++)
                        compare_sample(&out, (const int[]){i, j, k});
            frame_grids_free(&in);
            frame_grids_free(&out);
        }
}

/* The wind has a file of its own, on a coarser and wider lattice than the rock. */
static void the_wind_comes_back(void **state)
{
    (void)state;
    enum { BRICKS = 2, N = BRICKS * BRICK_SAMPLES };
    for (int up = 0; up < 2; up++) {
        const struct vdb_options options = options_of(up);
        const struct grid_lattice lattice = {{9, 4, 3}, 6.5, {-8, -7, 3.25}};
        struct frame_grids in, out;
        struct frame_grid *wind;
        struct draft file = {0};
        uint32_t *number;
        assert_int_equal(frame_grids_begin(&lattice, &in), OK);
        assert_int_equal(memory_alloc(BRICKS, sizeof *number, "bricks", &number), OK);
        number[1] = 1;
        frame_grids_choose(&in, &number, BRICKS);
        assert_int_equal(frame_grids_add(&in, VALUE_wind, &wind), OK);
        assert_int_equal(memory_alloc(N, 3 * sizeof(float), "wind", &wind->value), OK);
        for (int z = 0; z < 3; z++)
            for (int y = 0; y < 4; y++)
                for (int x = 0; x < 9; x++)
                    for (int a = 0; a < 3; a++)
                        wind->value[3 * grid_row(&in, x, y, z) + a] =
                            (float)(1 + x + 10 * y + 100 * z) * (a == 1 ? -1.0F : 0.5F);
        assert_int_equal(vdb_volumes(&in, &options, &file), OK);
        assert_int_equal(atomic_file_write("wind.vdb", file.bytes, file.size), OK);
        assert_int_equal(vdb_volumes_read("wind.vdb", &out), OK);
        assert_same_lattice(&in.lattice, &out.lattice);
        assert_int_equal(out.n_grids, 1);
        assert_string_equal(out.grid[0].name, "wind");
        assert_int_equal(out.bricks.count, BRICKS);
        assert_memory_equal(out.grid[0].value, wind->value, 3 * N * sizeof(float));
        frame_grids_free(&in);
        frame_grids_free(&out);
        draft_drop(&file);
    }
}

struct errors {
    double place, share, angle, length;
    size_t n, bytes;
};

/* The sample's particles, read back, against what they were. */
static struct errors errors_of(const struct vdb_options *options)
{
    struct errors e = {0};
    struct rock in, out;
    struct draft file = {0};
    size_t *of_id;
    assert_int_equal(sample_rock(0.5, &in), OK);
    in.viability[0] = 0;
    in.viability[1] = 1;
    in.viability[2] = 1e-6F;
    assert_int_equal(vdb_points(&in, options, &file), OK);
    assert_int_equal(atomic_file_write("small.vdb", file.bytes, file.size), OK);
    e.bytes = file.size;
    draft_drop(&file);
    assert_int_equal(vdb_points_read("small.vdb", &out), OK);
    of_id = calloc(1 << 20, sizeof *of_id);
    assert_non_null(of_id);
    for (size_t i = 0; i < in.n; i++)
        of_id[in.id[i]] = i;
    e.n = out.n;
    for (size_t k = 0; k < out.n; k++) {
        const size_t i = of_id[out.id[k]];
        double dot = 0, length[2] = {0, 0};
        assert_int_equal(out.id[k], in.id[i]);
        assert_int_equal(out.layer[k], in.layer[i]);
        assert_int_equal(out.phase[k], in.phase[i]);
        assert_true(out.stress[k] == in.stress[i] && out.erodibility[k] == in.erodibility[i]);
        assert_true((out.viability[k] == 0) == (in.viability[i] == 0) &&
                    (out.viability[k] == 1) == (in.viability[i] == 1));
        if (in.viability[i] > 1e-5F)
            e.share = fmax(e.share, fabs((double)out.viability[k] - (double)in.viability[i]));
        for (size_t a = 0; a < 3; a++) {
            e.place = fmax(e.place, fabs((double)out.P[4 * k + a] - (double)in.P[4 * i + a]));
            dot += (double)out.N[4 * k + a] * (double)in.N[4 * i + a];
            length[0] += pow((double)in.N[4 * i + a], 2);
            length[1] += pow((double)out.N[4 * k + a], 2);
        }
        assert_true((length[0] > 0) == (length[1] > 0));
        if (length[0] > 0) {
            e.angle = fmax(e.angle, acos(fmin(1, dot / sqrt(length[0] * length[1]))));
            e.length = fmax(e.length, fabs(sqrt(length[1]) - 1));
        }
    }
    free(of_id);
    rock_free(&in);
    rock_free(&out);
    return e;
}

static void points_in_16_bits_come_back_to_half_a_step(void **state)
{
    (void)state;
    /* A voxel of points/ is two spacings. */
    const double step = 2 * 0.5 / 65535, degree = acos(-1.0) / 180;
    for (int up = 0; up < 2; up++)
        for (int surface = 0; surface < 2; surface++) {
            struct vdb_options options = options_of(up);
            options.points = surface ? VDB_POINTS_SURFACE : VDB_POINTS_ALL;
            const struct errors whole = errors_of(&options);
            options.precision = VDB_PRECISION_16_BIT;
            const struct errors e = errors_of(&options);
            print_message(
                "# %zu points, %zu bytes for %zu: P within %.3f of a step of %.3g m, shares within %.3f "
                "of one, normals %.2g degrees and %.2g long\n",
                e.n, e.bytes, whole.bytes, e.place / step, step, e.share * 65535, e.angle / degree, e.length);
            assert_int_equal(e.n, whole.n);
            assert_true(e.bytes < whole.bytes);
            assert_true(whole.share == 0 && whole.place < 1e-6);
            /* and the rounding of floats at 16 m */
            assert_true(e.place <= 0.5 * step + 1e-6 && e.place > 0);
            assert_true(e.share * 65535 <= 0.501);
            assert_true(e.angle < (surface ? 2.5 : 0.05) * degree && e.length < 1e-3);
        }
}

static void half_volumes_come_back_to_three_digits(void **state)
{
    (void)state;
    struct vdb_options options = options_of(OUTPUT_UP_Y);
    struct frame_grids in, out;
    options.half = true;
    write_volumes("half.vdb", 0.25, &options);
    assert_int_equal(sample_grids(0.25, &in), OK);
    assert_int_equal(vdb_volumes_read("half.vdb", &out), OK);
    for (size_t b = 0; b < in.bricks.count; b++) {
        const uint32_t slot = out.bricks.slot[in.bricks.number[b]];
        for (size_t v = b * BRICK_SAMPLES; slot && v < (b + 1) * BRICK_SAMPLES; v++) {
            const size_t w = v - b * BRICK_SAMPLES + (slot - 1) * BRICK_SAMPLES;
            assert_true(fabsf(out.grid[1].value[w] - in.grid[1].value[v]) < 1e-3F);
            /* beyond 65,504 Pa */
            assert_true(in.grid[1].value[v] == 0 || out.grid[2].value[w] == in.grid[2].value[v]);
        }
    }
    assert_true(out.bricks.count > 0);
    frame_grids_free(&in);
    frame_grids_free(&out);
}

static void points_come_back(void **state)
{
    (void)state;
    for (int up = 0; up < 2; up++) {
        const struct vdb_options options = options_of(up);
        struct rock in, out;
        write_points("points.vdb", 0.5, &options);
        assert_int_equal(sample_rock(0.5, &in), OK);
        assert_int_equal(vdb_points_read("points.vdb", &out), OK);
        assert_int_equal(in.n, out.n);
        assert_null(out.rate_factor);
        size_t *of_id = calloc(1 << 20, sizeof *of_id);
        for (size_t i = 0; i < out.n; i++)
            of_id[out.id[i]] = i;
        for (size_t i = 0; i < in.n; i++) {
            const size_t o = of_id[in.id[i]];
            assert_int_equal(out.id[o], in.id[i]);
            assert_memory_equal(out.P + 4 * o, in.P + 4 * i, 3 * sizeof(float));
            assert_memory_equal(out.N + 4 * o, in.N + 4 * i, 3 * sizeof(float));
            assert_int_equal(out.layer[o], in.layer[i]);
            assert_int_equal(out.phase[o], in.phase[i]);
            assert_true(out.viability[o] == in.viability[i]);
            assert_true(out.stress[o] == in.stress[i]);
            assert_true(out.erodibility[o] == in.erodibility[i]);
        }
        free(of_id);
        rock_free(&in);
        rock_free(&out);
    }
}

static void surface_points_are_those_with_a_normal(void **state)
{
    (void)state;
    struct vdb_options options = options_of(OUTPUT_UP_Y);
    struct rock in, out;
    size_t want = 0;
    options.points = VDB_POINTS_SURFACE;
    write_points("skin.vdb", 0.5, &options);
    assert_int_equal(sample_rock(0.5, &in), OK);
    for (size_t i = 0; i < in.n; i++)
        want += in.N[4 * i] != 0 || in.N[4 * i + 1] != 0 || in.N[4 * i + 2] != 0;
    assert_int_equal(vdb_points_read("skin.vdb", &out), OK);
    assert_int_equal(out.n, want);
    assert_true(want > 0 && want < in.n);
    rock_free(&in);
    rock_free(&out);
}

static void no_points_make_a_file(void **state)
{
    (void)state;
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    struct rock none, out;
    struct draft file = {0};
    assert_int_equal(rock_alloc(&none, 0, DERIVED), OK);
    assert_int_equal(vdb_points(&none, &options, &file), OK);
    assert_int_equal(atomic_file_write("none.vdb", file.bytes, file.size), OK);
    assert_int_equal(vdb_check("none.vdb"), OK);
    assert_int_equal(vdb_points_read("none.vdb", &out), OK);
    assert_int_equal(out.n, 0);
    draft_drop(&file);
    rock_free(&none);
    rock_free(&out);
}

static void a_particle_nowhere_is_a_blow_up(void **state)
{
    (void)state;
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    const float bad[] = {NAN, INFINITY, 1e30F};
    for (int k = 0; k < 3; k++) {
        struct rock rock;
        struct draft file = {0};
        assert_int_equal(sample_rock(1, &rock), OK);
        rock.P[4 * 7 + 1] = bad[k];
        assert_int_equal(vdb_points(&rock, &options, &file), E_NUMERIC);
        assert_non_null(strstr(status_message(), "particle 7"));
        draft_drop(&file);
        rock_free(&rock);
    }
}

/* On one core, in a process of its own: the number of worker threads is settled at the first encoding. */
static void hash_on_one_core(uint64_t *volumes, uint64_t *points)
{
    int end[2];
    uint64_t hash[2];
    assert_int_equal(pipe(end), 0);
    const pid_t child = fork();
    if (child == 0) {
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(0, &one);
        sched_setaffinity(0, sizeof one, &one);
        const struct vdb_options options = options_of(OUTPUT_UP_Y);
        struct frame_grids grids;
        struct rock rock;
        struct draft file = {0};
        if (sample_grids(0.25, &grids) != OK || vdb_volumes(&grids, &options, &file) != OK)
            _exit(1);
        hash[0] = hash_bytes(file.bytes, file.size);
        draft_drop(&file);
        if (sample_rock(0.25, &rock) != OK || vdb_points(&rock, &options, &file) != OK)
            _exit(1);
        hash[1] = hash_bytes(file.bytes, file.size);
        _exit(write(end[1], hash, sizeof hash) == sizeof hash ? 0 : 1);
    }
    int how;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    assert_int_equal(read(end[0], hash, sizeof hash), sizeof hash);
    close(end[0]);
    close(end[1]);
    *volumes = hash[0];
    *points = hash[1];
}

static void equal_input_gives_equal_bytes_on_any_number_of_cores(void **state)
{
    (void)state;
    struct frame_grids grids;
    struct rock rock;
    struct draft file = {0};
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    uint64_t volumes, points;
    hash_on_one_core(&volumes, &points);
    assert_int_equal(sample_grids(0.25, &grids), OK);
    assert_int_equal(sample_rock(0.25, &rock), OK);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(vdb_volumes(&grids, &options, &file), OK);
        assert_true(hash_bytes(file.bytes, file.size) == volumes);
        draft_drop(&file);
        assert_int_equal(vdb_points(&rock, &options, &file), OK);
        assert_true(hash_bytes(file.bytes, file.size) == points);
        draft_drop(&file);
    }
    frame_grids_free(&grids);
    rock_free(&rock);
}

static void another_identity_is_another_archive(void **state)
{
    (void)state;
    struct frame_grids grids;
    struct draft a = {0}, b = {0};
    struct vdb_options options = options_of(OUTPUT_UP_Y);
    assert_int_equal(sample_grids(0.5, &grids), OK);
    assert_int_equal(vdb_volumes(&grids, &options, &a), OK);
    options.identity ^= (uint64_t)1 << 60;
    assert_int_equal(vdb_volumes(&grids, &options, &b), OK);
    assert_int_equal(a.size, b.size);
    assert_memory_not_equal((char *)a.bytes + 21, (char *)b.bytes + 21, 36);
    assert_memory_equal((char *)a.bytes + 57, (char *)b.bytes + 57, a.size - 57);
    draft_drop(&a);
    draft_drop(&b);
    frame_grids_free(&grids);
}

static void describe(const char *path, struct json **json, struct text *text)
{
    *text = (struct text){0};
    json_object(text, NULL);
    assert_int_equal(vdb_describe(path, text), OK);
    json_text(text, "after", "still JSON");
    json_end_object(text);
    assert_int_equal(text_status(text), OK);
    assert_int_equal(json_read(path, text->data, text->size, json), OK);
}

static const struct json *item(const struct json *array, size_t i)
{
    const struct json *at = array->first;
    while (i-- && at)
        at = at->next;
    return at;
}

static void description_says_what_is_in_it(void **state)
{
    (void)state;
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    struct json *json;
    struct text text;
    struct rock rock;
    write_points("said.vdb", 0.5, &options);
    describe("said.vdb", &json, &text);
    assert_int_equal(sample_rock(0.5, &rock), OK);
    assert_string_equal(json_to_text(json_member(json, "up_axis")), "y");
    assert_true(json_member(json_member(json, "metadata"), "frame")->number == 1001);
    const char *by = json_to_text(json_member(json_member(json, "metadata"), "creator"));
    assert_true(strncmp(by, "Houdini", 7) == 0);
    const struct json *points = item(json_member(json, "grids"), 0);
    assert_string_equal(json_to_text(json_member(points, "name")), "points");
    assert_true(json_member(points, "points")->number == (double)rock.n);
    const char *const names[] = {"P",         "pscale", "v",     "Cd",         "id",
                                 "viability", "layer",  "phase", "vegetation", "stress"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        assert_string_equal(json_to_text(json_member(item(json_member(points, "attributes"), i), "name")),
                            names[i]);
    rock_free(&rock);
    json_free(&json);
    text_free(&text);

    write_volumes("said.vdb", 0.25, &options);
    describe("said.vdb", &json, &text);
    assert_int_equal(json_member(json, "grids")->n, 4);
    for (const struct json *g = json_member(json, "grids")->first; g; g = g->next)
        if (strcmp(json_to_text(json_member(g, "name")), "surface") == 0) {
            assert_string_equal(json_to_text(json_member(g, "class")), "level set");
            /* the ball's band, in the file's axes: y up */
            const struct json *bounds = json_member(g, "bounds_m");
            const double reach = BALL_RADIUS + 0.75;
            const double centre[3] = {BALL_CENTRE[0], BALL_CENTRE[2], -BALL_CENTRE[1]};
            for (size_t a = 0; a < 3; a++) {
                assert_true(fabs(item(json_member(bounds, "min"), a)->number - (centre[a] - reach)) < 0.26);
                assert_true(fabs(item(json_member(bounds, "max"), a)->number - (centre[a] + reach)) < 0.26);
            }
        }
    json_free(&json);
    text_free(&text);
}

static status describe_check(const char *path)
{
    struct text text = {0};
    const status st = vdb_describe(path, &text);
    text_free(&text);
    return st;
}

static void damage_is_noticed(void **state)
{
    (void)state;
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    write_volumes("volumes.vdb", 0.5, &options);
    write_points("points.vdb", 1, &options);
    assert_int_equal(vdb_check("volumes.vdb"), OK);
    assert_int_equal(vdb_check("points.vdb"), OK);
    assert_int_equal(vdb_check("missing.vdb"), E_INPUT);
    assert_int_equal(vdb_check("."), E_INPUT);
    damage_truncate("volumes.vdb", vdb_check, 20);
    damage_truncate("points.vdb", vdb_check, 20);
    damage_flip("volumes.vdb", vdb_check, 40);
    damage_flip("points.vdb", vdb_check, 40);
}

static void hostile_bytes_do_not_take_us_down(void **state)
{
    (void)state;
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    write_volumes("volumes.vdb", 0.5, &options);
    write_points("points.vdb", 1, &options);
    damage_fuzz("volumes.vdb", describe_check, 60);
    damage_fuzz("points.vdb", describe_check, 60);
}

/* The library's own readers have to notice a missing end, in files without hoodoo's hash. */
static void a_strangers_truncated_file_is_noticed(void **state)
{
    (void)state;
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    size_t n;
    write_volumes("volumes.vdb", 0.5, &options);
    char *bytes = damage_read("volumes.vdb", &n);
    for (char *c = bytes; (c = memmem(c, n - (size_t)(c - bytes), "hoodoo", 6)); c += 6)
        memcpy(c, "xxdoxx", 6);
    damage_put("stranger.vdb", bytes, n);
    free(bytes);
    assert_int_equal(vdb_check("stranger.vdb"), OK);
    damage_truncate("stranger.vdb", vdb_check, 20);
}

static void mesh_of_something_else_is_refused(void **state)
{
    (void)state;
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    const char *const names[] = {"no such grid"};
    struct vdb_mesh mesh;
    struct rock rock;
    struct frame_grids grids;
    write_points("points.vdb", 1, &options);
    write_volumes("volumes.vdb", 0.5, &options);
    assert_int_equal(vdb_mesh_read("points.vdb", 0, NULL, 0, 0, &mesh), E_INPUT);
    assert_int_equal(vdb_mesh_read("volumes.vdb", 0, names, 1, 0, &mesh), E_INPUT);
    assert_non_null(strstr(status_message(), "no such grid"));
    assert_int_equal(vdb_mesh_read("volumes.vdb", 0, names, 1, 1, &mesh), OK);
    for (size_t i = 0; i < mesh.n_vertices; i++)
        assert_true(mesh.value[i] == 0);
    vdb_mesh_free(&mesh);
    assert_int_equal(vdb_points_read("volumes.vdb", &rock), E_INPUT);
    assert_int_equal(vdb_volumes_read("points.vdb", &grids), E_INPUT);
    vdb_mesh_free(&mesh);
}

/* The samples of a lattice in the grids' bricks; `outside` beyond it. */
static void put_lattice(const struct frame_grids *grids, const float *samples, float outside,
                        struct frame_grid *grid)
{
    const int *n = grids->lattice.n, *m = grids->bricks.n;
    assert_int_equal(
        memory_alloc(grids->bricks.count * BRICK_SAMPLES, sizeof *grid->value, grid->name, &grid->value), OK);
    for (size_t at = 0; at < grids->bricks.count * BRICK_SAMPLES; at++) {
        const int number = (int)grids->bricks.number[at / BRICK_SAMPLES], s = (int)(at % BRICK_SAMPLES);
        const int i = number % m[0] * 8 + s % 8, j = number / m[0] % m[1] * 8 + s / 8 % 8,
                  k = number / m[0] / m[1] * 8 + s / 64;
        grid->value[at] = i < n[0] && j < n[1] && k < n[2]
                              ? samples[((size_t)k * (size_t)n[1] + (size_t)j) * (size_t)n[0] + (size_t)i]
                              : outside;
    }
}

/* Bricks that are all inside make the same file whether they are kept or only said to be inside: of rock within its grid, and of
 * rock that reaches the border. */
static void inside_is_not_kept(void **state)
{
    (void)state;
    enum { N = 48 };
    static const enum value_id of[] = {VALUE_surface, VALUE_density, VALUE_bedrock, VALUE_sand, VALUE_stress};
    enum { GRIDS = sizeof of / sizeof *of };
    static float value[GRIDS][N * N * N];
    const double h = 0.5;
    for (int border = 0; border < 2; border++) {
        for (int i = 0; i < N * N * N; i++) {
            const double c[3] = {i % N - 23.7, i / N % N - 24.2, i / N / N - (border ? 4.4 : 23.9)};
            const double d = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) - 19;
            value[0][i] = (float)(fmin(fmax(d, -3), 3) * h);
            value[1][i] = (float)fmin(fmax(0.5 - d / 2, 0), 1);
            value[2][i] = value[1][i] > 0 && value[1][i] < 1 ? 0.25f : ceilf(value[1][i]);
            value[3][i] = ceilf(value[1][i]) - value[2][i];
        }
        struct draft file[2][2] = {0};
        for (int sparse = 0; sparse < 2; sparse++) {
            struct frame_grids grids;
            uint32_t *number = NULL;
            size_t n = 0, inside = 0;
            int bricks[3];
            assert_int_equal(
                frame_grids_begin(&(struct grid_lattice){{N, N, N}, h, {0.25, 0.25, 0.25}}, &grids), OK);
            const size_t all = grid_bricks_of(grids.lattice.n, bricks);
            assert_int_equal(memory_alloc(all, sizeof *number, "bricks", &number), OK);
            for (uint32_t b = 0; b < all; b++) {
                double sum = 0;
                for (int s = 0; s < BRICK_SAMPLES; s++)
                    sum += (double)
                        value[0][(((int)b / 36 * 8 + s / 64) * N + (int)b / 6 % 6 * 8 + s / 8 % 8) * N +
                                 (int)b % 6 * 8 + s % 8];
                if (sparse && fabs(sum) >= BRICK_SAMPLES * 3 * h) {
                    grids.bricks.slot[b] = sum < 0 ? BRICK_INSIDE : 0;
                    inside += sum < 0;
                } else
                    number[n++] = b;
            }
            assert_true(!sparse || (inside > 3 && n + inside < all));
            frame_grids_choose(&grids, &number, n);
            for (int g = 0; g < GRIDS; g++) {
                struct frame_grid *grid;
                assert_int_equal(frame_grids_add(&grids, of[g], &grid), OK);
                put_lattice(&grids, value[g], 0, grid);
            }
            for (int up = 0; up < 2; up++) {
                const struct vdb_options options = options_of(up);
                assert_int_equal(vdb_volumes(&grids, &options, &file[sparse][up]), OK);
            }
            frame_grids_free(&grids);
        }
        for (int up = 0; up < 2; up++) {
            assert_int_equal(file[0][up].size, file[1][up].size);
            assert_memory_equal(file[0][up].bytes, file[1][up].bytes, file[0][up].size);
            draft_drop(&file[0][up]);
            draft_drop(&file[1][up]);
        }
    }
}

/* Rock that stands on the floor of the grid, in the middle of it and in a corner: 8.5 x 12 x 9 m, 3 x 3 x 9
 * m. */
static void rock_on_the_floor_is_closed(void **state)
{
    (void)state;
    enum { NX = 40, NY = 44, NZ = 30 };
    static float value[NX * NY * NZ];
    const double low[2][3] = {{3.5, 4, -50}, {17, 19, -50}}, high[2][3] = {{12, 16, 9}, {50, 50, 9}};
    struct frame_grids grids;
    struct frame_grid *surface;
    uint32_t *number = NULL;
    int bricks[3];
    for (int i = 0; i < NX * NY * NZ; i++) {
        const int c[3] = {i % NX, i / NX % NY, i / NX / NY};
        double nearest = 1e9;
        for (int b = 0; b < 2; b++) {
            double inside = -1e9, outside = 0;
            for (int a = 0; a < 3; a++) {
                const double x = 0.25 + 0.5 * c[a], d = fmax(low[b][a] - x, x - high[b][a]);
                inside = fmax(inside, d);
                outside += d > 0 ? d * d : 0;
            }
            nearest = fmin(nearest, outside > 0 ? sqrt(outside) : inside);
        }
        value[i] = (float)nearest;
    }
    assert_int_equal(frame_grids_begin(&(struct grid_lattice){{NX, NY, NZ}, 0.5, {0.25, 0.25, 0.25}}, &grids),
                     OK);
    const size_t n = grid_bricks_of(grids.lattice.n, bricks);
    assert_int_equal(memory_alloc(n, sizeof *number, "bricks", &number), OK);
    for (uint32_t b = 0; b < n; b++)
        number[b] = b;
    frame_grids_choose(&grids, &number, n);
    assert_int_equal(frame_grids_add(&grids, VALUE_surface, &surface), OK);
    put_lattice(&grids, value, 1.5f, surface);
    for (int up = 0; up < 2; up++) {
        const struct vdb_options options = options_of(up);
        struct draft file = {0};
        struct vdb_mesh mesh;
        double low_z = 1e9, high_x = -1e9, high_y = -1e9;
        assert_int_equal(vdb_volumes(&grids, &options, &file), OK);
        damage_put("floor.vdb", file.bytes, file.size);
        draft_drop(&file);
        assert_int_equal(vdb_mesh_read("floor.vdb", 0, NULL, 0, 0, &mesh), OK);
        const struct measure r = measure_mesh(&mesh);
        assert_int_equal(r.open_edges, 0);
        assert_true(fabs(r.volume / (8.5 * 12 * 9 + 3 * 3 * 9) - 1) < 0.03);
        for (size_t v = 0; v < mesh.n_vertices; v++) {
            low_z = fmin(low_z, (double)mesh.vertex[3 * v + 2]);
            high_x = fmax(high_x, (double)mesh.vertex[3 * v]);
            high_y = fmax(high_y, (double)mesh.vertex[3 * v + 1]);
        }
        assert_true(fabs(low_z) < 1e-3 && fabs(high_x - 20) < 1e-3 && fabs(high_y - 22) < 1e-3);
        vdb_mesh_free(&mesh);
    }
    frame_grids_free(&grids);
}

/* `adaptivity` merges flat parts; the surface stays closed and in place. */
static void adaptive_mesh_is_smaller(void **state)
{
    (void)state;
    const struct vdb_options options = options_of(OUTPUT_UP_Y);
    struct vdb_mesh fine, coarse;
    write_volumes("ball.vdb", 0.125, &options);
    assert_int_equal(vdb_mesh_read("ball.vdb", 0, NULL, 0, 0, &fine), OK);
    assert_int_equal(vdb_mesh_read("ball.vdb", 0.02, NULL, 0, 0, &coarse), OK);
    assert_null(coarse.value);
    assert_true(coarse.n_triangles < fine.n_triangles * 3 / 4);
    const struct measure r = measure_mesh(&coarse);
    assert_int_equal(r.open_edges, 0);
    print_message("# %zu of %zu triangles, volume %g\n", coarse.n_triangles, fine.n_triangles, r.volume);
    assert_true(fabs(r.volume / (4 * acos(-1.0) * 64 / 3) - 1) < 0.01);
    vdb_mesh_free(&fine);
    vdb_mesh_free(&coarse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        /* first: it must be the first to encode */
        cmocka_unit_test(equal_input_gives_equal_bytes_on_any_number_of_cores),
        cmocka_unit_test(another_identity_is_another_archive),
        cmocka_unit_test(volumes_come_back),
        cmocka_unit_test(the_wind_comes_back),
        cmocka_unit_test(points_in_16_bits_come_back_to_half_a_step),
        cmocka_unit_test(half_volumes_come_back_to_three_digits),
        cmocka_unit_test(points_come_back),
        cmocka_unit_test(surface_points_are_those_with_a_normal),
        cmocka_unit_test(no_points_make_a_file),
        cmocka_unit_test(a_particle_nowhere_is_a_blow_up),
        cmocka_unit_test(mesh_of_a_ball_is_closed_and_true),
        cmocka_unit_test(inside_is_not_kept),
        cmocka_unit_test(rock_on_the_floor_is_closed),
        cmocka_unit_test(adaptive_mesh_is_smaller),
        cmocka_unit_test(mesh_of_something_else_is_refused),
        cmocka_unit_test(description_says_what_is_in_it),
        cmocka_unit_test(damage_is_noticed),
        cmocka_unit_test(a_strangers_truncated_file_is_noticed),
        cmocka_unit_test(hostile_bytes_do_not_take_us_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
