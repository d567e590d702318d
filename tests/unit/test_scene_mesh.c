/* Mesh files: every encoding of one mesh gives the same rock, as the shape it stands for; broken and hostile
 * files are refused with their place, and never crash. */
#include "effort.h"
#include "meshinput/ask.h"
#include "meshinput/decode.h"
#include "meshinput/edges.h"
#include "meshinput/winding.h"
#include "scene_help.h"

/* ---- a ball of quads and triangles, and a cube */

enum { RINGS = 24, SIDES = 48, BALL_VERTICES = 2 + (RINGS - 1) * SIDES };

struct polygons {
    size_t n_vertices, n_faces;
    float vertex[BALL_VERTICES][3];
    uint32_t face[RINGS * SIDES][4];
    int corners[RINGS * SIDES];
};

static void add_face(struct polygons *m, int corners, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    const uint32_t face[4] = {a, b, c, d};
    memcpy(m->face[m->n_faces], face, sizeof face);
    m->corners[m->n_faces++] = corners;
}

static struct polygons *ball(void)
{
    static struct polygons m;
    m.n_vertices = BALL_VERTICES;
    m.n_faces = 0;
    const float poles[2][3] = {{10, 10, 3}, {10, 10, 17}};
    memcpy(m.vertex, poles, sizeof poles);
    for (uint32_t r = 0; r < RINGS - 1; r++)
        for (uint32_t s = 0; s < SIDES; s++) {
            double up = M_PI * (r + 1) / RINGS - M_PI / 2, round = 2 * M_PI * s / SIDES;
            float *v = m.vertex[2 + r * SIDES + s];
            v[0] = (float)(10 + 7 * cos(up) * cos(round));
            v[1] = (float)(10 + 7 * cos(up) * sin(round));
            v[2] = (float)(10 + 7 * sin(up));
        }
    for (uint32_t s = 0; s < SIDES; s++) {
        uint32_t t = (s + 1) % SIDES, last = 2 + (RINGS - 2) * SIDES;
        add_face(&m, 3, 0, 2 + t, 2 + s, 0);
        for (uint32_t r = 0; r < RINGS - 2; r++)
            add_face(&m, 4, 2 + r * SIDES + s, 2 + r * SIDES + t, 2 + (r + 1) * SIDES + t,
                     2 + (r + 1) * SIDES + s);
        add_face(&m, 3, last + s, last + t, 1, 0);
    }
    return &m;
}

static char *write_obj(const char *name, const struct polygons *m, int negative)
{
    char *path = scratch_file(name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "# a ball\nmtllib none.mtl\no ball\n");
    for (size_t i = 0; i < m->n_vertices; i++)
        fprintf(f, "v %.17g %.17g %.17g\n", (double)m->vertex[i][0], (double)m->vertex[i][1],
                (double)m->vertex[i][2]);
    fprintf(f, "vt 0 0\nvn 0 0 1\ns off\n");
    for (size_t i = 0; i < m->n_faces; i++) {
        fprintf(f, "f");
        for (int k = 0; k < m->corners[i]; k++) {
            long corner = (long)m->face[i][k] + (negative ? -(long)m->n_vertices : 1);
            fprintf(f,
                    i % 4 == 0   ? " %ld"
                    : i % 4 == 1 ? " %ld/1"
                    : i % 4 == 2 ? " %ld//1"
                                 : " %ld/1/1",
                    corner);
        }
        fprintf(f, i % 5 ? "\n" : " \\\r\n\r\n");
    }
    fclose(f);
    return path;
}

static void put(FILE *f, const void *value, size_t n, int big)
{
    const unsigned char *bytes = value;
    for (size_t i = 0; i < n; i++)
        fputc(bytes[big ? n - 1 - i : i], f);
}

enum encoding { ASCII, LITTLE, BIG };

static char *write_ply(const char *name, const struct polygons *m, enum encoding e)
{
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    char *path = scratch_file(name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fprintf(f,
            "ply\nformat %s 1.0\ncomment a ball\nelement vertex %zu\nproperty uchar red\nproperty float x\n"
            "property float y\nproperty double z\nelement face %zu\nproperty list uchar int vertex_indices\n"
            "property short flag\nend_header\n",
            names[e], m->n_vertices, m->n_faces);
    for (size_t i = 0; i < m->n_vertices; i++) {
        const float *v = m->vertex[i];
        double z = (double)v[2];
        if (e == ASCII) {
            fprintf(f, "200 %.17g %.17g %.17g\n", (double)v[0], (double)v[1], z);
        } else {
            fputc(200, f);
            put(f, &v[0], 4, e == BIG);
            put(f, &v[1], 4, e == BIG);
            put(f, &z, 8, e == BIG);
        }
    }
    for (size_t i = 0; i < m->n_faces; i++) {
        const int16_t flag = -2;
        if (e == ASCII) {
            fprintf(f, "%d", m->corners[i]);
            for (int k = 0; k < m->corners[i]; k++)
                fprintf(f, " %u", m->face[i][k]);
            fprintf(f, " -2\n");
        } else {
            fputc(m->corners[i], f);
            for (int k = 0; k < m->corners[i]; k++)
                put(f, &m->face[i][k], 4, e == BIG);
            put(f, &flag, 2, e == BIG);
        }
    }
    fclose(f);
    return path;
}

static const char cube[] = "v 2.1 3.2 1.3\nv 12.6 3.2 1.3\nv 12.6 15.4 1.3\nv 2.1 15.4 1.3\n"
                           "v 2.1 3.2 9.9\nv 12.6 3.2 9.9\nv 12.6 15.4 9.9\nv 2.1 15.4 9.9\n"
                           "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/* ---- whole files */

static void every_encoding_gives_the_same_mesh(void **state)
{
    (void)state;
    const struct polygons *m = ball();
    char *paths[5];
    paths[0] = strdup(write_obj("a.obj", m, 0));
    paths[1] = strdup(write_obj("b.obj", m, 1));
    paths[2] = strdup(write_ply("a.ply", m, ASCII));
    paths[3] = strdup(write_ply("b.ply", m, LITTLE));
    paths[4] = strdup(write_ply("c.ply", m, BIG));
    struct mesh first = {0};
    for (int i = 0; i < 5; i++) {
        struct mesh mesh;
        struct mesh_open open;
        assert_int_equal(mesh_read(paths[i], NULL, &mesh), OK);
        assert_int_equal(mesh.n_vertices, BALL_VERTICES);
        assert_int_equal(mesh.n_triangles, 2 * SIDES * (RINGS - 1));
        assert_int_equal(mesh_weld(&mesh), OK);
        assert_int_equal(mesh.n_vertices, BALL_VERTICES);
        assert_int_equal(mesh_find_open(&mesh, &open), OK);
        assert_int_equal(open.n, 0);
        free(open.edge);
        if (i == 0) {
            first = mesh;
        } else {
            assert_memory_equal(mesh.triangle, first.triangle, mesh.n_triangles * sizeof *mesh.triangle);
            assert_memory_equal(mesh.vertex, first.vertex, mesh.n_vertices * sizeof *mesh.vertex);
            mesh_free(&mesh);
        }
        free(paths[i]);
    }
    mesh_free(&first);
}

static void meshes_have_the_volume_of_their_shapes(void **state)
{
    (void)state;
    struct job_node box = MESH(.file = write_text("cube.obj", cube), .up = 1);
    assert_close(volume_of(&box, 40, 0.5), 10.5 * 12.2 * 8.6, 0.005);
    struct job_node small = MESH(.file = write_text("cube.obj", cube), .up = 1, .scale = {0.5, 1.2, 1.5},
                                 .rotate_deg = {0, 0, 30}, .translate_m = {11, 1, 1});
    assert_close(volume_of(&small, 60, 0.5), 10.5 * 12.2 * 8.6 * 0.9, 0.005);
    struct job_node round = MESH(.file = write_ply("ball.ply", ball(), BIG), .up = 1);
    double facets = SIDES / (2 * M_PI) * sin(2 * M_PI / SIDES); /* of a circle */
    double rings = 0;
    for (int r = 0; r < RINGS; r++) { /* stacked frusta */
        double a = M_PI * r / RINGS, b = M_PI * (r + 1) / RINGS, p = sin(a), q = sin(b);
        rings += M_PI / 3 * (cos(a) - cos(b)) * (p * p + p * q + q * q);
    }
    assert_close(volume_of(&round, 40, 0.5), 343 * rings * facets, 0.005);
}

static void up_y_is_turned(void **state)
{
    (void)state;
    struct job_node box = MESH(.file = write_text("cube.obj", cube), .up = 0, .translate_m = {0, 20, 0});
    struct solid *solid;
    double min[3], max[3];
    assert_int_equal(solid_create(&box, 0.25, 2, &solid), OK);
    solid_bounds(solid, min, max); /* (x, y, z) -> (x, -z, y) */
    assert_close(min[1], 20 - 9.9, 1e-12);
    assert_close(max[1], 20 - 1.3, 1e-12);
    assert_close(min[2], 3.2, 1e-12);
    assert_close(max[2], 15.4, 1e-12);
    assert_true(solid_at(solid, (const double[]){7, 12, 14}).distance < 0);
    assert_true(solid_at(solid, (const double[]){7, 3, 14}).distance > 0);
    /* Good up to the reach, on both sides. */
    assert_close(solid_at(solid, (const double[]){7, 15, 16.9}).distance, 1.5, 0.01);
    assert_close(solid_at(solid, (const double[]){7, 15, 13.9}).distance, -1.5, 0.01);
    solid_destroy(&solid);
}

/* Faces with corners of their own, turned either way, overlapping parts: all common in practice. */
static void untidy_meshes_are_solids_too(void **state)
{
    (void)state;
    char text[8192] = "";
    for (int part = 0; part < 2; part++) {
        static const int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                        {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}};
        for (int f = 0; f < 6; f++) {
            for (int k = 0; k < 4; k++) {
                int c = faces[f][f == 3 ? 3 - k : k];
                sprintf(text + strlen(text), "v %g %g %g\n", (c + 1) / 2 % 2 * 8 + 3 + part * 4.0,
                        c / 2 % 2 * 8 + 3.0, c / 4 * 8 + 3 + part * 2.0);
            }
            strcat(text, "f -4 -3 -2 -1\n");
        }
    }
    struct job_node two = MESH(.file = write_text("untidy.obj", text), .up = 1);
    assert_close(volume_of(&two, 40, 0.5), 2 * 512 - 4 * 8 * 6, 0.005);
}

/* ---- inside and outside */

struct quads {
    char text[16384];
    int n;
};

/* A box of six faces with corners of their own, wound outwards, or inwards; faces of `without` (a bit each: bottom, top, front, right,
 * back, left) are left out. */
static void add_box(struct quads *q, const double lo[3], const double hi[3], bool inwards, unsigned without)
{
    static const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
    for (int f = 0; f < 6; f++) {
        if (without >> f & 1)
            continue;
        for (int k = 0; k < 4; k++) {
            const int c = faces[f][inwards ? 3 - k : k];
            sprintf(q->text + strlen(q->text), "v %.17g %.17g %.17g\n", c & 1 ? hi[0] : lo[0],
                    c & 2 ? hi[1] : lo[1], c & 4 ? hi[2] : lo[2]);
        }
        strcat(q->text, "f -4 -3 -2 -1\n");
    }
}

#define CORNER(...) ((const double[3]){__VA_ARGS__})

static double volume_of_text(const char *text)
{
    struct job_node node = MESH(.file = write_text("whole.obj", text), .up = MESH_UP_Z);
    return volume_of(&node, 40, 0.5);
}

/* Every way in which boxes may be in one another; the same with everything turned inside out. */
static void shells_within_shells(void **state)
{
    (void)state;
    for (int out = 0; out < 2; out++) {
        struct quads hollow = {0}, filled = {0}, thrice = {0}, apart = {0}, one = {0};
        add_box(&hollow, CORNER(2, 2, 2), CORNER(18, 18, 18), out, 0);
        add_box(&hollow, CORNER(5, 5, 5), CORNER(15, 15, 15), !out, 0);
        thrice = hollow;
        add_box(&thrice, CORNER(8, 8, 8), CORNER(12, 12, 12), out, 0);
        assert_close(volume_of_text(hollow.text), 4096 - 1000, 1e-3);
        assert_close(volume_of_text(thrice.text), 4096 - 1000 + 64, 1e-3);
        add_box(&filled, CORNER(2, 2, 2), CORNER(18, 18, 18), out, 0);
        add_box(&filled, CORNER(5, 5, 5), CORNER(15, 15, 15), out, 0);
        assert_close(volume_of_text(filled.text), 4096, 1e-3);
        /* One of two is inside out, whether they meet or not. */
        add_box(&apart, CORNER(2, 2, 2), CORNER(8, 8, 8), out, 0);
        add_box(&apart, CORNER(10, 10, 10), CORNER(14, 14, 14), !out, 0);
        assert_close(volume_of_text(apart.text), 216 + 64, 1e-3);
        add_box(&one, CORNER(2, 2, 2), CORNER(10, 10, 10), out, 0);
        add_box(&one, CORNER(6, 6, 6), CORNER(14, 14, 14), !out, 0);
        assert_close(volume_of_text(one.text), 2 * 512 - 64, 1e-3);
    }
}

/* Walls within, and sheets outside, are passed over. */
static void stray_faces_are_passed_over(void **state)
{
    (void)state;
    struct quads wall = {0}, sheet = {0};
    add_box(&wall, CORNER(2, 2, 2), CORNER(18, 18, 18), false, 0);
    strcat(wall.text, "v 10 5 5\nv 10 15 5\nv 10 15 15\nv 10 5 15\nf -4 -3 -2 -1\n");
    assert_close(volume_of_text(wall.text), 4096, 1e-3);
    add_box(&sheet, CORNER(2, 2, 2), CORNER(18, 18, 18), false, 0);
    strcat(sheet.text, "v 8 8 19\nv 11 8 19\nv 11 11 19\nv 8 11 19\nf -4 -3 -2 -1\n");
    assert_close(volume_of_text(sheet.text), 4096, 1e-3);
    /* Nothing but a sheet is no solid. */
    assert_failed(
        solid_create(&MESH(.file = write_text("sheet.obj", strstr(sheet.text, "v 8 8 19")), .up = MESH_UP_Z),
                     0.25, 2, &(struct solid *){NULL}),
        E_INPUT, "the surface is open", "sheets");
}

/* Sheets with a fold inside of a solid, and two in parallel. Whether the concave side of a fold is rock or air depends on which way it
 * faces: where it faces like the solid's own faces the solid stays whole, and where it could be a cavity with an open side, the
 * file is refused with its place. */
static void bent_sheets_are_whole_or_refused(void **state)
{
    (void)state;
    static const unsigned without[] = {63 - (1 | 8), 63 - (1 | 8 | 32), 63 - (8 | 32), 2};
    for (size_t i = 0; i < sizeof without / sizeof *without; i++) {
        struct quads out = {0}, in;
        add_box(&out, CORNER(2, 2, 2), CORNER(18, 18, 18), false, 0);
        in = out;
        add_box(&out, CORNER(7, 7, 7), CORNER(13, 13, 13), false, without[i]);
        assert_close(volume_of_text(out.text), 4096, 1e-3);
        add_box(&in, CORNER(7, 7, 7), CORNER(13, 13, 13), true, without[i]);
        struct job_node node = MESH(.file = write_text("bent.obj", in.text), .up = MESH_UP_Z);
        assert_failed(solid_create(&node, 0.25, 2, &(struct solid *){NULL}), E_INPUT, "the surface is open",
                      "widest gap");
    }
}

/* A lid that lies a little off, as rounding or a gap that voxels do not see. */
static void seams_are_closed(void **state)
{
    (void)state;
    static const double off[] = {1e-12, 1e-7, 1e-5, 1e-3, 0.1, 0.3};
    for (size_t i = 0; i < sizeof off / sizeof *off; i++) {
        struct quads q = {0};
        add_box(&q, CORNER(2, 2, 2), CORNER(18, 18, 18), false, 2);
        add_box(&q, CORNER(2, 2, 2), CORNER(18, 18, 18 + off[i]), false, 63 - 2);
        assert_close(volume_of_text(q.text), 4096, off[i] / 10 + 1e-3);
    }
    /* A slit of a metre is a metre wide, not as long as it goes. */
    struct quads q = {0};
    add_box(&q, CORNER(2, 2, 2), CORNER(18, 18, 15), false, 2);
    add_box(&q, CORNER(2, 2, 2), CORNER(18, 18, 17), false, 63 - 2);
    struct job_node node = MESH(.file = write_text("slit.obj", q.text), .up = MESH_UP_Z);
    struct solid *solid = NULL;
    assert_failed(solid_create(&node, 0.25, 2, &solid), E_INPUT, "widest gap is about 2", "fill_holes_m");
    node.u.mesh.fill_holes_m = 3;
    assert_close(volume_of(&node, 40, 0.5), 16 * 16 * 14, 0.075);
}

/* The coordinates of a map, in which floats step by half a metre. */
static void maps_are_put_at_the_origin(void **state)
{
    (void)state;
    struct quads q = {0};
    add_box(&q, CORNER(412345.25, 5712345.125, 812.5), CORNER(412349.5, 5712350.375, 818.75), false, 0);
    struct job_node node = MESH(.file = write_text("map.obj", q.text), .up = MESH_UP_Z);
    assert_failed(solid_create(&node, 0.25, 2, &(struct solid *){NULL}), E_INPUT, "map.obj", "origin: auto");
    node.u.mesh.origin = MESH_ORIGIN_AUTO;
    for (int a = 0; a < 3; a++)
        node.u.mesh.translate_m[a] = 1;
    assert_close(volume_of(&node, 20, 0.5), 4.25 * 5.25 * 6.25, 1e-3);
    struct solid *solid;
    double min[3], max[3];
    assert_int_equal(solid_create(&node, 0.25, 2, &solid), OK);
    solid_bounds(solid, min, max);
    assert_close(max[1], 6.25, 1e-12);
    assert_close(solid_at(solid, CORNER(3, 3, 7.75)).distance, 0.5, 1e-6);
    solid_destroy(&solid);
}

/* Against the sum over all triangles, at places near and far. */
static void winding_numbers_are_sums(void **state)
{
    (void)state;
    struct mesh mesh;
    struct winding *fast, *exact;
    assert_int_equal(mesh_read(write_obj("w.obj", ball(), 0), NULL, &mesh), OK);
    mesh.n_triangles -= 300; /* a hole */
    const double(*vertex)[3] = (const double(*)[3])mesh.vertex;
    const uint32_t(*triangle)[3] = (const uint32_t(*)[3])mesh.triangle;
    assert_int_equal(winding_create(vertex, mesh.n_vertices, triangle, mesh.n_triangles, 2, &fast), OK);
    assert_int_equal(winding_create(vertex, mesh.n_vertices, triangle, mesh.n_triangles, 1e9, &exact), OK);
    uint32_t x = 5;
    for (int i = 0; i < 2000; i++) {
        double at[3], sum = 0;
        for (int a = 0; a < 3; a++)
            at[a] = 24.0 * next_random(&x) / UINT32_MAX - 2;
        for (size_t t = 0; i < 20 && t < mesh.n_triangles; t++) {
            double v[3][3], r[3], volume = 0, below;
            for (int k = 0; k < 3; k++) {
                for (int a = 0; a < 3; a++)
                    v[k][a] = vertex[triangle[t][k]][a] - at[a];
                r[k] = sqrt(v[k][0] * v[k][0] + v[k][1] * v[k][1] + v[k][2] * v[k][2]);
            }
            below = r[0] * r[1] * r[2];
            for (int k = 0; k < 3; k++) {
                const double *p = v[(k + 1) % 3], *q = v[(k + 2) % 3];
                volume +=
                    v[0][k] * (v[1][(k + 1) % 3] * v[2][(k + 2) % 3] - v[1][(k + 2) % 3] * v[2][(k + 1) % 3]);
                below += r[k] * (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]);
            }
            sum += atan2(volume, below) / (2 * M_PI);
        }
        if (i < 20)
            assert_true(fabs(sum - (double)winding_number(exact, at)) < 1e-4);
        assert_true(fabsf(winding_number(exact, at) - winding_number(fast, at)) < 0.05F);
    }
    winding_destroy(&fast);
    winding_destroy(&exact);
    mesh_free(&mesh);
}

/* ---- broken files */

static status make(const char *path)
{
    struct job_node node = MESH(.file = (char *)path, .up = 1);
    struct solid *solid = NULL;
    status st = solid_create(&node, 0.25, 1, &solid);
    solid_destroy(&solid);
    return st;
}

static void open_meshes_are_refused(void **state)
{
    (void)state;
    char text[512];
    snprintf(text, sizeof text, "%.*s", (int)(strstr(cube, "f 4 1") - cube), cube);
    assert_failed(make(write_text("open.obj", text)), E_INPUT,
                  "open.obj: the surface is open: it has 4 boundary edges", "fill the holes");
    assert_failed(make(write_text("open.obj", text)), E_INPUT, "the widest gap is about 7.8 m",
                  "fill_holes_m");
    /* Closed straight across where the job says so, to about a voxel. */
    struct job_node filled = MESH(.file = write_text("open.obj", text), .up = MESH_UP_Z, .fill_holes_m = 10);
    assert_close(volume_of(&filled, 40, 0.5), 10.5 * 12.2 * 8.6, 0.1);
    /* A hole no wider than the sampling closes itself. */
    char *tiny = scratch_file("tiny.obj");
    FILE *f = fopen(tiny, "w");
    fprintf(f, "%.*sv 2.1 9 5\nv 2.1 9.1 5\nv 2.1 9.1 5.1\nv 2.1 9 5.1\n",
            (int)(strstr(cube, "f 4 1") - cube), cube);
    fprintf(f, "f 1 5 12 9\nf 5 8 11 12\nf 8 4 10 11\nf 4 1 9 10\n");
    fclose(f);
    struct job_node node = MESH(.file = tiny, .up = 1);
    assert_close(volume_of(&node, 40, 0.5), 10.5 * 12.2 * 8.6, 0.005);
}

static void bad_obj_is_refused_with_its_line(void **state)
{
    (void)state;
    static const char head[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    static const char *const bad[][3] = {
        {"f 1 2 4\n", ":4:", "vertex 4"},      {"f 1 2 0\n", ":4:", "vertex 0"},
        {"f -4 1 2\n", ":4:", "vertex -4"},    {"f 1 2\n", ":4:", "2 corners"},
        {"f 1 2 x\n", ":4:", "'x'"},           {"f 1/2/3/4 2 3\n", ":4:", "corner"},
        {"v 1 2\n", ":4:", "end of the line"}, {"\nv nan 0 0\n", ":5:", "'nan'"},
        {"v 1 inf 0\n", ":4:", "'inf'"},       {"v 1 1e999 0\n", ":4:", "1e999"},
        {"v 1 a 0\n", ":4:", "'a'"},           {"f 1 2 99999999999999999999\n", ":4:", "9"},
        {"", "bad.obj", "no faces"},           {"f 1 1 2\n", "bad.obj", "point"},
        {"f 1 2 3\n", "bad.obj", "open"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[256];
        snprintf(text, sizeof text, "%s%s", head, bad[i][0]);
        assert_failed(make(write_text("bad.obj", text)), E_INPUT, bad[i][1], bad[i][2]);
    }
    assert_failed(make(write_text("far.obj", "v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3")), E_INPUT, "far.obj",
                  "vertex 2");
    assert_failed(make("/nonexistent/a.obj"), E_INPUT, "/nonexistent/a.obj", "");
}

#define VERTEX "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
#define FACE "element face 1\nproperty list uchar int vertex_indices\n"

static void bad_ply_is_refused(void **state)
{
    (void)state;
    static const char *const bad[][3] = {
        {"format ascii 1.0\nend_header\n", "bad.ply", "no faces"},
        {"format ascii 2.0\nend_header\n", ":2:", "format ascii 2.0"},
        {VERTEX "end_header\n", "bad.ply", "no format"},
        {"format ascii 1.0\n" VERTEX, "bad.ply", "inside the header"},
        {"format ascii 1.0\nelement vertex 99999999999999\nproperty float x\nend_header\n0\n", "bad.ply",
         "declares 99999999999999"},
        {"format ascii 1.0\nelement vertex -1\nproperty float x\nend_header\n0\n", ":3:", "element"},
        {"format ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n0\n", ":4:", "'half'"},
        {"format ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n", "bad.ply",
         "lacks x, y or z"},
        {"format ascii 1.0\nelement face 1\nproperty list float int vertex_index\nend_header\n0\n",
         ":4:", "'float'"},
        {"format ascii 1.0\nproperty float x\nend_header\n", ":3:", "before any element"},
        {"format ascii 1.0\n" VERTEX FACE "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
         ":13:", "does not exist"},
        {"format ascii 1.0\n" VERTEX FACE "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
         ":13:", "does not exist"},
        {"format ascii 1.0\n" VERTEX FACE "end_header\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", ":13:", "3 corners"},
        {"format ascii 1.0\n" VERTEX FACE "end_header\n0 0 0\n1 0 0\n0 1 0\n250 0 1 2\n", ":13:", "longer"},
        {"format ascii 1.0\n" VERTEX FACE "end_header\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", ":10:", "'nan'"},
        {"format binary_little_endian 1.0\n" VERTEX FACE "end_header\n0123456789abcdef", "bad.ply",
         "declares 3"},
        {"format binary_little_endian 1.0\n" VERTEX FACE
         "end_header\n0123456789abcdef0123456789abcdef0123\x7fxxxx",
         "byte 2", "longer"},
        {"format binary_big_endian 1.0\n" VERTEX FACE
         "end_header\n0123\x7f\xc0..89abcdef0123456789abcdef0123\3xxxxxxxxxxxx",
         "byte 1", "not finite"},
        {"format ascii 1.0\nelement dust 18446744073709551615\nend_header\n", "bad.ply", ""},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[512];
        snprintf(text, sizeof text, "ply\n%s", bad[i][0]);
        assert_failed(make(write_text("bad.ply", text)), E_INPUT, bad[i][1], bad[i][2]);
    }
}

/* Every truncation, and thousands of mutations: refused or read, and what is read is in range. */
static void damaged_meshes_never_crash(void **state)
{
    (void)state;
    char *name = scratch_file("fuzz");
    for (int kind = 0; kind < 4; kind++) {
        static char whole[200000], bytes[200001];
        static struct polygons small;
        small.n_vertices = 5;
        small.n_faces = 0;
        memcpy(small.vertex, (const float[5][3]){{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 2}},
               5 * sizeof *small.vertex);
        add_face(&small, 4, 3, 2, 1, 0);
        for (uint32_t k = 0; k < 4; k++)
            add_face(&small, 3, k, (k + 1) % 4, 4, 0);
        FILE *f =
            fopen(kind == 3 ? write_obj("s.obj", &small, 0) : write_ply("s.ply", &small, (enum encoding)kind),
                  "rb");
        size_t n = fread(whole, 1, sizeof whole, f);
        fclose(f);
        uint32_t x = 17 + (uint32_t)kind;
        for (size_t i = 0; i < n + effort_of(2000); i++) {
            size_t size = i < n ? i : n;
            memcpy(bytes, whole, n);
            for (uint32_t k = i < n ? 0 : next_random(&x) % 6 + 1; k > 0; k--) {
                static const char digits[] = "0123456789-. \n/ef\0\xff";
                size_t at = next_random(&x) % n;
                bytes[at] =
                    next_random(&x) % 2 ? (char)next_random(&x) : digits[next_random(&x) % sizeof digits];
            }
            bytes[size] = '\0';
            const struct mesh_file file = {.path = name, .bytes = bytes, .n = size};
            struct mesh mesh;
            status st = mesh_decode(&file, i % 2 ? "red" : "", NULL, &mesh);
            assert_true(st == OK || st == E_INPUT);
            for (size_t t = 0; st == OK && t < mesh.n_triangles * 3; t++)
                assert_true(mesh.triangle[t / 3][t % 3] < mesh.n_vertices);
            mesh_free(&mesh);
            if (st == OK && i % 16 == 0) {
                f = fopen(name, "wb");
                fwrite(bytes, 1, size, f);
                fclose(f);
                st = make(name);
                assert_true(st == OK || st == E_INPUT);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_encoding_gives_the_same_mesh),
        cmocka_unit_test(meshes_have_the_volume_of_their_shapes),
        cmocka_unit_test(up_y_is_turned),
        cmocka_unit_test(untidy_meshes_are_solids_too),
        cmocka_unit_test(shells_within_shells),
        cmocka_unit_test(stray_faces_are_passed_over),
        cmocka_unit_test(bent_sheets_are_whole_or_refused),
        cmocka_unit_test(seams_are_closed),
        cmocka_unit_test(maps_are_put_at_the_origin),
        cmocka_unit_test(winding_numbers_are_sums),
        cmocka_unit_test(open_meshes_are_refused),
        cmocka_unit_test(bad_obj_is_refused_with_its_line),
        cmocka_unit_test(bad_ply_is_refused),
        cmocka_unit_test(damaged_meshes_never_crash),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
