/* Brush strokes, images, noise masks, river beds, and edits of rock: measured volumes and painted shares. */
#include "scene_help.h"

#define STROKE(...)                                                                                          \
    ((struct job_node){.kind = NODE_SHAPE, .shape = SHAPE_STROKE, .u.stroke = {PLACED, __VA_ARGS__}})
#define PAINT(...)                                                                                           \
    ((struct job_paint){.erodibility = 1, .interlock = 1, .viability = 1, .vegetation = -1, __VA_ARGS__})

static double capsule(double radius, double length)
{
    return M_PI * radius * radius * (length + 4.0 / 3 * radius);
}

/* ---- strokes */

static void strokes_are_spheres_along_a_line(void **state)
{
    (void)state;
    double point[][3] = {{10.2, 9.7, 10.1}};
    struct job_node dot = STROKE(.path_m = point, .n_path_m = 1, .radius_m = 4);
    assert_close(volume_of(&dot, 40, 0.5), 4.0 / 3 * M_PI * 64, 0.005);
    double ends[][3] = {{4, 5, 6}, {14, 13, 15}};
    struct job_node line = STROKE(.path_m = ends, .n_path_m = 2, .radius_m = 3);
    assert_close(volume_of(&line, 40, 0.5), capsule(3, sqrt(100 + 64 + 81)), 0.005);
    /* A ring of many points: a torus. */
    enum { N = 300 };
    double ring[N + 1][3];
    for (int i = 0; i <= N; i++) {
        ring[i][0] = 10 + 6 * cos(2 * M_PI * i / N);
        ring[i][1] = 10 + 6 * sin(2 * M_PI * i / N);
        ring[i][2] = 10;
    }
    struct job_node torus = STROKE(.path_m = ring, .n_path_m = N + 1, .radius_m = 2);
    assert_close(volume_of(&torus, 40, 0.5), 2 * M_PI * M_PI * 6 * 4, 0.005);
    struct job_node egg =
        STROKE(.path_m = point, .n_path_m = 1, .radius_m = 1, .scale = {4, 3, 2}, .rotate_deg = {0, 0, 90},
               .translate_m = {9.7 * 3 + 10, 10 - 10.2 * 4, 10 - 20.2});
    assert_close(volume_of(&egg, 40, 0.5), 4.0 / 3 * M_PI * 24, 0.01);
}

/* However many points: the distance is the smallest of all pieces'. */
static void long_strokes_know_their_nearest_piece(void **state)
{
    (void)state;
    enum { N = 200 };
    static double path[N][3];
    uint32_t x = 5;
    for (int i = 0; i < N; i++)
        for (int a = 0; a < 3; a++)
            path[i][a] = next_random(&x) % 2000 * 0.01;
    struct job_node all = STROKE(.path_m = path, .n_path_m = N, .radius_m = 0.5);
    struct solid *whole, *piece[N - 1];
    assert_int_equal(solid_create(&all, 1, 1, &whole), OK);
    for (int i = 0; i + 1 < N; i++) {
        struct job_node two = STROKE(.path_m = path + i, .n_path_m = 2, .radius_m = 0.5);
        assert_int_equal(solid_create(&two, 1, 1, &piece[i]), OK);
    }
    for (int i = 0; i < 500; i++) {
        double at[3], least = INFINITY;
        for (int a = 0; a < 3; a++)
            at[a] = next_random(&x) % 3000 * 0.01 - 5;
        for (int k = 0; k + 1 < N; k++)
            least = fmin(least, solid_at(piece[k], at).distance);
        assert_true(fabs(least - solid_at(whole, at).distance) < 1e-9);
    }
    for (int i = 0; i + 1 < N; i++)
        solid_destroy(&piece[i]);
    solid_destroy(&whole);
}

/* ---- where paint goes */

/* A block of 20 x 20 x 20 m in voxels of half a metre. */
static struct job_node block = {
    .kind = NODE_SHAPE, .shape = SHAPE_BOX, .u.box = {PLACED, .max_m = {20, 20, 20}}};

/* Sums over all particles of a job with one entry of paint that has erodibility 3. */
struct painted {
    size_t n, touched;
    double weight; /* m3 */
};

static struct painted paint_block(const struct job_paint *paint, size_t n, struct rock *keep)
{
    struct job job = cube_job(&block, 40, 0.5);
    struct rock rock;
    struct painted out = {0};
    job.paint = (struct job_paint *)(uintptr_t)paint;
    job.n_paint = n;
    assert_int_equal(scene_sample(&job, &rock), OK);
    out.n = rock.n;
    for (size_t i = 0; i < rock.n; i++) {
        out.touched += rock.rate_factor[i] != 1;
        out.weight += ((double)rock.rate_factor[i] - 1) / 2 * 0.125;
    }
    if (keep)
        *keep = rock;
    else
        rock_free(&rock);
    return out;
}

static void a_stroke_paints_its_volume(void **state)
{
    (void)state;
    double path[][3] = {{5, 5, 5}, {15, 5, 5}, {15, 15, 12}};
    struct job_node stroke = STROKE(.path_m = path, .n_path_m = 2, .radius_m = 3);
    struct job_paint paint = PAINT(.shape = &stroke, .erodibility = 3);
    struct painted p = paint_block(&paint, 1, NULL);
    print_message("# a stroke of %.1f m3 paints %.1f m3\n", capsule(3, 10), p.weight);
    assert_close(p.weight, capsule(3, 10), 0.02);
    /* A falloff of d adds, of a smoothstep, the integral of the shells outside. */
    paint.falloff_m = 2;
    double shells = 0;
    for (double t = 0.005; t < 1; t += 0.01) {
        double r = 3 + 2 * t, w = (1 - t) * (1 - t) * (1 + 2 * t);
        shells += w * (2 * M_PI * r * 10 + 4 * M_PI * r * r) * 0.02;
    }
    assert_close(paint_block(&paint, 1, NULL).weight, capsule(3, 10) + shells, 0.02);
}

static void vegetation_is_planted(void **state)
{
    (void)state;
    struct job_node low = BOX(.max_m = {20, 20, 10}), left = BOX(.max_m = {5, 20, 20});
    struct job_paint paint[] = {PAINT(.shape = &low, .vegetation = 0.75),
                                PAINT(.shape = &left, .vegetation = 0),
                                PAINT(.shape = &left, .interlock = 2)};
    struct rock rock;
    paint_block(paint, 3, &rock);
    for (size_t i = 0; i < rock.n; i++) {
        const float *P = rock.P + 4 * i;
        assert_true(rock.vegetation[i] == (P[2] <= 10 && P[0] > 5 ? 0.75f : 0));
        assert_true(rock.interlock_factor[i] == (P[0] <= 5 ? 2 : 1));
    }
    rock_free(&rock);
}

/* PGM, 8 bits, top row first: white right of the middle and above it, grey left above, black below. */
static char *quarters(void)
{
    unsigned char bytes[20 + 64 * 64];
    size_t n = (size_t)snprintf((char *)bytes, 20, "P5\n64 64\n255\n");
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++)
            bytes[n++] = y >= 32 ? 0 : x >= 32 ? 255 : 51;
    return write_file("quarters.pgm", bytes, n);
}

/* Seen from the south, its left bottom corner at x = 4, z = 4: 12 m wide, 8 m high. */
static void an_image_is_seen_upright_from_its_front(void **state)
{
    (void)state;
    struct job_image image = {
        .file = quarters(), .corner_m = {4, -1, 4}, .right_m = {12, 0, 0}, .up_m = {0, 0, 8}};
    struct job_paint paint = PAINT(.image = &image, .erodibility = 3);
    struct rock rock;
    struct painted p = paint_block(&paint, 1, &rock);
    /* A quarter white, a quarter one fifth, through 20 m. */
    print_message("# an image paints %.1f m3 of %.1f\n", p.weight, 12 * 8 * 20 * 0.3);
    assert_close(p.weight, 12 * 8 * 20 * (0.25 + 0.25 / 5), 0.02);
    for (size_t i = 0; i < rock.n; i++) {
        const float *P = rock.P + 4 * i;
        bool inside = P[0] >= 4 && P[0] <= 16 && P[2] >= 4 && P[2] <= 12;
        if (!inside || P[2] < 7.8f)
            assert_true(rock.rate_factor[i] == 1);
        else if (P[2] > 8.2f && P[0] > 10.2f)
            assert_true(rock.rate_factor[i] == 3);
        else if (P[2] > 8.2f && P[0] < 9.8f)
            assert_true(fabsf(rock.rate_factor[i] - 1.4f) < 1e-4f);
    }
    rock_free(&rock);
    /* From inside the block, only what is behind the picture. */
    image.corner_m[1] = 15;
    assert_close(paint_block(&paint, 1, NULL).weight, 12 * 8 * 5 * 0.3, 0.02);
    /* Turned around it looks south, and left and right change sides. */
    image = (struct job_image){
        .file = image.file, .corner_m = {16, 21, 4}, .right_m = {-12, 0, 0}, .up_m = {0, 0, 8}};
    paint_block(&paint, 1, &rock);
    for (size_t i = 0; i < rock.n; i++) {
        const float *P = rock.P + 4 * i;
        if (P[2] > 8.2f && P[2] < 11.9f && P[0] > 4.1f && P[0] < 9.8f)
            assert_true(rock.rate_factor[i] == 3);
    }
    rock_free(&rock);
}

/* Thrown obliquely too: only the first metres of what is hit, and what is hidden stays bare. */
static void depth_stops_behind_the_first_rock(void **state)
{
    (void)state;
    unsigned char white[] = "P5\n1 1\n255\n\xff";
    struct job_image image = {.file = write_file("white.pgm", white, sizeof white - 1),
                              .corner_m = {0, -5, 0},
                              .right_m = {20, 0, 0},
                              .up_m = {0, 0, 20},
                              .depth_m = 2};
    struct job_paint paint = PAINT(.image = &image, .erodibility = 3);
    struct job_node front = BOX(.min_m = {0, 4, 0}, .max_m = {20, 8, 10});
    struct job_node back = BOX(.min_m = {0, 12, 0}, .max_m = {20, 16, 20});
    struct job_node scene = GROUP(NODE_UNION, &front, &back);
    struct job job = cube_job(&scene, 40, 0.5);
    struct rock rock;
    double weight = 0;
    job.paint = &paint;
    job.n_paint = 1;
    assert_int_equal(scene_sample(&job, &rock), OK);
    for (size_t i = 0; i < rock.n; i++) {
        const float *P = rock.P + 4 * i;
        float first = P[2] < 9.4f ? 4 : P[2] > 11.1f ? 12 : NAN; /* not beside the edge that hides */
        weight += (double)(rock.rate_factor[i] - 1) / 2 * 0.125;
        if (P[1] < first + 1.4f)
            assert_true(rock.rate_factor[i] == 3);
        if (P[1] > first + 2.3f)
            assert_true(rock.rate_factor[i] == 1);
    }
    print_message("# two metres of two walls: %.0f m3 of 800\n", weight);
    assert_close(weight, 800, 0.1);
    rock_free(&rock);
    /* The same in a grid of voxels. */
    size_t n = 40 * 40 * 40;
    float *share = calloc(n, sizeof *share), *factor = calloc(n, sizeof *factor);
    assert_true(share && factor);
    assert_int_equal(scene_grid(&job, false, share, factor), OK);
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += factor[i] > 0 ? (double)(factor[i] - 1) / 2 * 0.125 : 0;
    print_message("# as voxels: %.0f m3\n", sum);
    assert_close(sum, 800, 0.1);
    free(share);
    free(factor);
}

static void hostile_images_are_refused(void **state)
{
    (void)state;
    struct job_image image = {.file = scratch_file("none.png"), .right_m = {1, 0, 0}, .up_m = {0, 0, 1}};
    struct job_paint paint = PAINT(.image = &image);
    struct job job = cube_job(&block, 8, 1);
    struct rock rock;
    job.paint = &paint;
    job.n_paint = 1;
    assert_failed(scene_sample(&job, &rock), E_INPUT, "none.png", "No such file");
    image.file = write_text("text.png", "this is no picture");
    assert_failed(scene_sample(&job, &rock), E_INPUT, "text.png", "");
}

static double share_above(double threshold, double soft, uint32_t seed, struct rock *keep)
{
    struct job_mask mask = {
        .scale_m = 2, .octaves = 2, .flatten = 1, .threshold = threshold, .soft = soft, .seed = seed};
    struct job_paint paint = PAINT(.noise = &mask, .erodibility = 3);
    struct painted p = paint_block(&paint, 1, keep);
    return p.weight / (0.125 * (double)p.n);
}

/* ---- values of a mesh's vertices */

/* A square over the block, whose vertices have the attribute 0 at x = 0 and full at x = 20 m, in every format that has attributes. */
static const char *write_square(const char *name, const char *full)
{
    static const char *const quad[2] = {"0 0 21", "20 0 21"}, *const other[2] = {"0 20 21", "20 20 21"};
    char text[1000];
    const char *none = strchr(full, '.') ? "0.0" : "0";
    if (strstr(name, ".ply"))
        snprintf(
            text, sizeof text,
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty uchar red\nproperty float x\nproperty float y\n"
            "property float z\nproperty double quality\nelement face 1\nproperty list uchar int vertex_index\n"
            "end_header\n0 %s 7\n255 %s %s\n255 %s %s\n0 %s 7\n4 0 1 2 3\n",
            quad[0], quad[1], full, other[1], full, other[0]);
    else if (strstr(name, ".obj"))
        snprintf(text, sizeof text, "v %s %s 0 0\nv %s %s 0 0\nv %s %s 0 0\nv %s %s 0 0\nf 1 2 3 4\n",
                 quad[0], none, quad[1], full, other[1], full, other[0], none);
    else
        snprintf(text, sizeof text,
                 "COFF\n4 1 0\n%s %s 0 0 255\n%s %s 0 0 255\n%s %s 0 0 255\n%s %s 0 0 255\n4 0 1 2 3\n",
                 quad[0], none, quad[1], full, other[1], full, other[0], none);
    return write_text(name, text);
}

/* The same with COLOR_0 and COLOR_1 in a glTF, which is y up. */
static const char *write_gltf(void)
{
    static const char json[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"COLOR_0\":1,\"COLOR_1\":2},\"indices\":3}]}],"
        "\"buffers\":[{\"uri\":\"colors.bin\",\"byteLength\":188}],\"bufferViews\":["
        "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":64},"
        "{\"buffer\":0,\"byteOffset\":112,\"byteLength\":64},{\"buffer\":0,\"byteOffset\":176,\"byteLength\":12}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
        "\"min\":[0,21,-20],\"max\":[20,21,0]},{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}]}";
    static const struct {
        float position[4][3], first[4][4], second[4][4];
        uint16_t index[6];
    } numbers = {{{0, 21, 0}, {20, 21, 0}, {20, 21, -20}, {0, 21, -20}},
                 {{0}, {0.5f, 0, 0, 1}, {0.5f, 0, 0, 1}, {0}},
                 {{0}, {0, 0, 1, 1}, {0, 0, 1, 1}, {0}},
                 {0, 1, 2, 0, 2, 3}};
    write_file("colors.bin", &numbers, sizeof numbers);
    return write_text("colors.gltf", json);
}

static void vertices_paint_what_is_nearest(void **state)
{
    (void)state;
    static const struct {
        const char *name, *full, *attribute;
        double from, to;
    } mesh[] = {
        {"red.ply", "27", "red", 0, 1},    {"more.ply", "27", "quality", 7, 27},
        {"red.obj", "0.8", "red", 0, 0.8}, {"red.off", "255", "red", 0, 1},
        {NULL, NULL, "red", 0, 0.5},       {NULL, NULL, "COLOR_1.blue", 0, 1},
    };
    for (size_t i = 0; i < sizeof mesh / sizeof *mesh; i++) {
        char *file = strdup(mesh[i].name ? write_square(mesh[i].name, mesh[i].full) : write_gltf());
        struct job_mesh_attribute m = {.file = file,
                                       .attribute = (char *)(uintptr_t)mesh[i].attribute,
                                       .from = mesh[i].from,
                                       .to = mesh[i].to,
                                       .scale = {1, 1, 1},
                                       .up = mesh[i].name ? MESH_ATTRIBUTE_UP_Z : MESH_ATTRIBUTE_UP_Y};
        struct job_paint paint =
            PAINT(.mesh_attribute = &m, .erodibility = 3, .interlock = 2, .viability = 0.5);
        for (int h = 1; h <= 2; h++) { /* two spacings */
            struct job job = cube_job(&block, 40 / h, 0.5 * h);
            struct rock rock;
            job.paint = &paint;
            job.n_paint = 1;
            if (scene_sample(&job, &rock) != OK)
                fail_msg("%s", status_message());
            for (size_t p = 0; p < rock.n; p++) {
                const double w = (double)rock.P[4 * p] / 20;
                assert_close((double)rock.interlock_factor[p], 1 + w, 1e-5);
                assert_close((double)rock.rate_factor[p], (1 + 2 * w) / (1 - 0.5 * w), 1e-5);
            }
            rock_free(&rock);
        }
        /* Only within 3 m of the square: the upper 2 m of the block. */
        m.depth_m = 3;
        paint.viability = 1;
        assert_close(paint_block(&paint, 1, NULL).weight, 20 * 20 * 2 / 2.0, 0.03);
        free(file);
    }
}

static void attributes_that_are_missing_are_named(void **state)
{
    (void)state;
    static const char *const wanted[][3] = {{"green", "'red', 'quality'", "'green'"},
                                            {"q", "'quality'", "'q'"}};
    struct job_mesh_attribute m = {
        .file = strdup(write_square("red.ply", "27")), .to = 1, .scale = {1, 1, 1}};
    struct job_paint paint = PAINT(.mesh_attribute = &m, .erodibility = 3);
    struct job job = cube_job(&block, 40, 0.5);
    struct rock rock;
    job.paint = &paint;
    job.n_paint = 1;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        m.attribute = (char *)(uintptr_t)wanted[i][0];
        assert_failed(scene_sample(&job, &rock), E_INPUT, wanted[i][1], wanted[i][2]);
    }
    free(m.file);
    m.attribute = (char *)(uintptr_t) "red";
    static const char *const files[][3] = {
        {"plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "have none"},
        {"some.obj", "v 0 0 0 1 1 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "only 1 of its 3 vertices"},
        {"a.stl",
         "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n",
         "have none"},
        {"nan.off", "COFF\n3 1 0\n0 0 0 1 1 nan\n", ":3:"}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        m.file = write_text(files[i][0], files[i][1]);
        assert_failed(scene_sample(&job, &rock), E_INPUT, files[i][2], files[i][0]);
    }
}

static void noise_paints_patches(void **state)
{
    (void)state;
    struct rock one, two, same;
    double half = share_above(0, 0, 0, &one), few = share_above(1, 0, 0, NULL),
           soft = share_above(0, 1, 0, NULL);
    print_message("# above 0 sd: %.3f, above 1 sd: %.3f, soft: %.3f\n", half, few, soft);
    assert_true(fabs(half - 0.5) < 0.06 && fabs(few - 0.16) < 0.04 && fabs(soft - half) < 0.03);
    share_above(0, 0, 1, &two);
    share_above(0, 0, 0, &same);
    size_t differ = 0;
    for (size_t i = 0; i < one.n; i++) {
        assert_true(one.rate_factor[i] == 1 || one.rate_factor[i] == 3);
        assert_true(one.rate_factor[i] == same.rate_factor[i]);
        differ += one.rate_factor[i] != two.rate_factor[i];
    }
    /* Another seed: as good as independent. */
    assert_true(fabs((double)differ / (double)one.n - 0.5) < 0.1);
    rock_free(&one);
    rock_free(&two);
    rock_free(&same);
}

/* Weights multiply: only patches inside the stroke; and inert is where they are at least a half. */
static void masks_and_shapes_multiply(void **state)
{
    (void)state;
    struct job_node low = BOX(.max_m = {20, 20, 10});
    struct job_mask mask = {.scale_m = 2, .octaves = 2, .flatten = 1, .soft = 1};
    struct job_paint alone = PAINT(.noise = &mask, .erodibility = 3),
                     both = PAINT(.noise = &mask, .shape = &low, .erodibility = 3),
                     inert = PAINT(.noise = &mask, .shape = &low, .inert = true);
    struct rock a, b, c;
    paint_block(&alone, 1, &a);
    paint_block(&both, 1, &b);
    paint_block(&inert, 1, &c);
    for (size_t i = 0; i < a.n; i++) {
        bool inside = a.P[4 * i + 2] <= 10;
        assert_true(b.rate_factor[i] == (inside ? a.rate_factor[i] : 1));
        assert_true(c.rate_factor[i] == (inside && a.rate_factor[i] >= 2 ? 0 : 1));
    }
    rock_free(&a);
    rock_free(&b);
    rock_free(&c);
}

/* ---- beds */

static double rock_volume(const struct job *job)
{
    struct rock rock;
    double sum = 0;
    assert_int_equal(scene_sample(job, &rock), OK);
    for (size_t i = 0; i < rock.n; i++)
        sum += (double)rock.viability[i] * pow(job->domain.spacing_m, 3);
    rock_free(&rock);
    return sum;
}

static void beds_are_taken_out(void **state)
{
    (void)state;
    struct job job = cube_job(&block, 40, 0.5);
    double inside[][3] = {{6, 10, 10}, {14, 10, 10}}, top[][3] = {{-5, 10, 20}, {25, 10, 20}};
    struct job_source source[] = {{.path_m = inside, .n_path_m = 2, .bed_m = 2},
                                  {.path_m = top, .n_path_m = 2},
                                  {.path_m = top, .n_path_m = 2, .bed_m = 1.5}};
    job.sources = source;
    job.n_sources = 2; /* the second has no bed */
    assert_close(8000 - rock_volume(&job), capsule(2, 8), 0.01);
    job.n_sources = 3; /* and half a cylinder along the top */
    assert_close(8000 - rock_volume(&job), capsule(2, 8) + M_PI / 2 * 2.25 * 20, 0.01);
    struct scene_size size;
    assert_int_equal(scene_estimate(&job, &size), OK);
    assert_true(size.n_particles < 64000 && size.n_particles > 60000);
    free(size.point);
}

/* ---- edits */

static double sum(const struct rock *rock, double h)
{
    double volume = 0;
    for (size_t i = 0; i < rock->n; i++)
        volume += (double)rock->viability[i] * h * h * h;
    return volume;
}

static void an_edit_carves_and_adds_what_it_says(void **state)
{
    (void)state;
    struct job_node slab = BOX(.max_m = {20, 20, 6.2});
    struct job job = cube_job(&slab, 40, 0.5);
    struct job_layer strata[] = {{.to_m = 8, .noise_amplitude = -1}, {.to_m = 1e6, .noise_amplitude = 0.3}};
    job.strata = strata;
    job.n_strata = 2;
    struct rock rock;
    assert_int_equal(scene_sample(&job, &rock), OK);
    size_t start = rock.n;
    double before = sum(&rock, 0.5);
    struct job_node hole = SPHERE(.center_m = {10, 10, 6.2}, .radius_m = 4);
    struct job_node tower = CYLINDER(.from_m = {5, 5, 2}, .to_m = {5, 5, 14}, .radius_m = 3);
    struct job_node ball = SPHERE(.center_m = {15, 15, 12}, .radius_m = 2, .inert = true);
    struct job_addition add[] = {{.shape = &tower, .layer = -1}, {.shape = &ball, .layer = 0}};
    struct job_edit edit = {.carve = &hole};
    struct scene_edited done;
    assert_int_equal(scene_edit(&job, &edit, start, &rock, &done), OK);
    assert_int_equal(done.carved, start - rock.n);
    assert_int_equal(done.added, 0);
    double carved = before - sum(&rock, 0.5), hemisphere = 2.0 / 3 * M_PI * 64;
    print_message("# carved %.2f m3 of %.2f, %zu particles\n", carved, hemisphere, done.carved);
    assert_close(carved, hemisphere, 0.01);
    /* Nothing that the hole does not touch has changed, and the order is kept. */
    for (size_t i = 1; i < rock.n; i++)
        assert_true(rock.id[i] > rock.id[i - 1]);
    before = sum(&rock, 0.5);
    size_t kept = rock.n;
    edit = (struct job_edit){.add = add, .n_add = 2};
    assert_int_equal(scene_edit(&job, &edit, start, &rock, &done), OK);
    /* The tower above the slab (it misses the hole by a little) and the ball. */
    double wanted = M_PI * 9 * (14 - 6.2) + 4.0 / 3 * M_PI * 8;
    print_message("# added %.2f m3 of %.2f, %zu particles\n", done.added_m3, wanted, done.added);
    assert_close(done.added_m3, wanted, 0.01);
    assert_close(sum(&rock, 0.5) - before, done.added_m3, 1e-6);
    assert_int_equal(rock.n, kept + done.added);
    for (size_t i = kept; i < rock.n; i++) {
        bool in_ball = rock.P[4 * i] > 10;
        assert_int_equal(rock.id[i], start + i - kept);
        assert_int_equal(rock.layer[i], in_ball ? 0 : rock.P[4 * i + 2] < 8 ? 0 : 1);
        assert_true(in_ball == (rock.rate_factor[i] == 0));
        assert_true(rock.interlock_factor[i] == 1 && rock.vegetation[i] == 0 && rock.phase[i] == 0);
    }
    /* Once more: all is there already. */
    assert_int_equal(scene_edit(&job, &edit, start + done.added, &rock, &done), OK);
    assert_int_equal(done.added, 0);
    assert_true(done.added_m3 < 1e-6);
    rock_free(&rock);
}

static void an_edit_paints_what_is_there(void **state)
{
    (void)state;
    struct job job = cube_job(&block, 40, 0.5);
    struct job_node low = BOX(.max_m = {20, 20, 10}), left = BOX(.max_m = {5, 20, 20});
    struct job_paint at_start = PAINT(.shape = &low, .erodibility = 2, .vegetation = 0.25);
    struct job_paint later[] = {PAINT(.shape = &left, .erodibility = 3, .interlock = 5, .viability = 0.5),
                                PAINT(.shape = &left, .vegetation = 1)};
    struct job_edit edit = {.paint = later, .n_paint = 2};
    struct scene_edited done;
    struct rock rock;
    job.paint = &at_start;
    job.n_paint = 1;
    assert_int_equal(scene_sample(&job, &rock), OK);
    assert_int_equal(scene_edit(&job, &edit, rock.n, &rock, &done), OK);
    assert_true(done.added == 0 && done.carved == 0);
    for (size_t i = 0; i < rock.n; i++) {
        bool is_low = rock.P[4 * i + 2] <= 10, is_left = rock.P[4 * i] <= 5;
        assert_true(rock.rate_factor[i] ==
                    (is_low ? 2.0f : 1.0f) * (is_left ? 6.0f : 1.0f)); /* of half the life */
        assert_true(rock.interlock_factor[i] == (is_left ? 5 : 1));
        assert_true(rock.viability[i] == 1);
        assert_true(rock.vegetation[i] == (is_left ? 1 : is_low ? 0.25f : 0));
    }
    rock_free(&rock);
}

/* Carve all, and build on nothing. */
static void an_edit_can_begin_anew(void **state)
{
    (void)state;
    struct job job = cube_job(&block, 16, 1);
    struct job_layer layer = {.to_m = 1e6, .noise_amplitude = -1};
    struct job_node all = PLANE(.normal = {0, 0, 1}, .point_m = {0, 0, 100}), foot = BOX(.max_m = {4, 4, 4});
    struct job_addition add = {.shape = &foot, .layer = -1};
    struct job_edit edit = {.carve = &all, .add = &add, .n_add = 1};
    struct scene_edited done;
    struct rock rock;
    job.strata = &layer;
    job.n_strata = 1;
    assert_int_equal(scene_sample(&job, &rock), OK);
    assert_int_equal(scene_edit(&job, &edit, rock.n, &rock, &done), OK);
    assert_int_equal(done.carved, 16 * 16 * 16);
    assert_int_equal(rock.n, 64);
    rock_free(&rock);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strokes_are_spheres_along_a_line),
        cmocka_unit_test(long_strokes_know_their_nearest_piece),
        cmocka_unit_test(a_stroke_paints_its_volume),
        cmocka_unit_test(vegetation_is_planted),
        cmocka_unit_test(an_image_is_seen_upright_from_its_front),
        cmocka_unit_test(depth_stops_behind_the_first_rock),
        cmocka_unit_test(hostile_images_are_refused),
        cmocka_unit_test(vertices_paint_what_is_nearest),
        cmocka_unit_test(attributes_that_are_missing_are_named),
        cmocka_unit_test(noise_paints_patches),
        cmocka_unit_test(masks_and_shapes_multiply),
        cmocka_unit_test(beds_are_taken_out),
        cmocka_unit_test(an_edit_carves_and_adds_what_it_says),
        cmocka_unit_test(an_edit_paints_what_is_there),
        cmocka_unit_test(an_edit_can_begin_anew),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
