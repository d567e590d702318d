/* Meshes that other programs got wrong in public (tests/inputs/README.md has the rows), volumes of OpenVDB, and formulas: what rock
 * each of them is. */
#include "effort.h"
#include "meshinput/ask.h"
#include "scene_help.h"

enum { SIDE = 16 }; /* voxels of the domain, of half a metre */

/* The cube from 2 to 6 m on every axis: its corners by bits, its faces wound outwards. */
static const int face_of[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};

static const int half[2][3] = {{0, 1, 2}, {0, 2, 3}};

static float at(int corner, int axis)
{
    return corner >> axis & 1 ? 6 : 2;
}

static char text[65536];

static void add(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void add(const char *format, ...)
{
    va_list args;
    const size_t n = strlen(text);
    va_start(args, format);
    vsnprintf(text + n, sizeof text - n, format, args);
    va_end(args);
}

static void add_corners(const char *before, const char *after)
{
    for (int c = 0; c < 8; c++)
        add("%s%g %g %g%s\n", before, (double)at(c, 0), (double)at(c, 1), (double)at(c, 2), after);
}

/* ---- OBJ */

static void interleaved(void)
{
    for (int f = 0; f < 6; f++) {
        for (int k = 0; k < 4; k++)
            add("v %g %g %g\n", (double)at(face_of[f][k], 0), (double)at(face_of[f][k], 1),
                (double)at(face_of[f][k], 2));
        add("f -4 -3 -2 -1\n");
    }
}

static void continued(void)
{
    add_corners("v ", "");
    for (int f = 0; f < 6; f++)
        add("f %d/1/1 %d/1/1 \\\r\n %d/1/1 \\\n%d/1/1\n", face_of[f][0] + 1, face_of[f][1] + 1,
            face_of[f][2] + 1, face_of[f][3] + 1);
}

static void add_faces(const char *word, int from, int way)
{
    for (int f = 0; f < 6; f++) {
        add("%s", word);
        for (int k = 0; k < 4; k++)
            add(" %d", face_of[f][way > 0 ? k : 3 - k] + from);
        add("\n");
    }
}

static void colored(void)
{
    add_corners("v ", " 0.9 0.1 0.2");
    add_faces("f", 1, 1);
}

static void inwards(void)
{
    add_corners("v ", "");
    add_faces("f", 1, -1);
}

static void two_sided(void)
{
    add_corners("v ", "");
    for (int f = 0; f < 12; f++) {
        const int *k = half[f % 2], *c = face_of[f / 2];
        add("f %d %d %d\nf %d %d %d\n", c[k[0]] + 1, c[k[1]] + 1, c[k[2]] + 1, c[k[2]] + 1, c[k[1]] + 1,
            c[k[0]] + 1);
    }
}

static void one_face_twice(void)
{
    colored();
    add("f 1 2 4 3\n");
}

static void hollow(void)
{
    colored();
    for (int c = 0; c < 8; c++)
        add("v %g %g %g\n", 3 + 2.0 * (c & 1), 3 + 2.0 * (c >> 1 & 1), 3 + 2.0 * (c >> 2));
    add_faces("f", 9, -1);
}

/* ---- PLY */

static size_t add_bytes(size_t n, const void *bytes, size_t more)
{
    memcpy(text + n, bytes, more);
    return n + more;
}

static size_t ply(const char *end, const char *indices)
{
    add("ply%sformat binary_little_endian 1.0%selement vertex 8%sproperty float x%sproperty float y%s"
        "property float z%selement face 6%sproperty list uchar int %s%send_header%s",
        end, end, end, end, end, end, end, indices, end, end);
    size_t n = strlen(text);
    for (int c = 0; c < 8; c++)
        for (int a = 0; a < 3; a++)
            n = add_bytes(n, &(float){at(c, a)}, 4);
    for (int f = 0; f < 6; f++) {
        n = add_bytes(n, &(unsigned char){4}, 1);
        n = add_bytes(n, face_of[f], 16);
    }
    return n;
}

/* ---- STL */

static size_t binary_stl(void)
{
    add("solid made by a program that should not begin so");
    size_t n = 80;
    n = add_bytes(n, &(uint32_t){12}, 4);
    for (int f = 0; f < 12; f++) {
        n = add_bytes(n, (float[3]){0}, 12);
        for (int k = 0; k < 3; k++)
            for (int a = 0; a < 3; a++)
                n = add_bytes(n, &(float){at(face_of[f / 2][half[f % 2][k]], a)}, 4);
        n = add_bytes(n, "\0", 2);
    }
    return n;
}

/* Faces first to last as one solid. */
static void add_solid(const char *const word[7], int first, int last)
{
    add("%s a\n", word[0]);
    for (int f = first; f < last; f++) {
        add(" %s 0.0 0.0 0.0\n  %s\n", word[1], word[2]);
        for (int k = 0; k < 3; k++) {
            const int c = face_of[f / 2][half[f % 2][k]];
            add("   %s %.6E %.6E %.6E\n", word[3], (double)at(c, 0), (double)at(c, 1), (double)at(c, 2));
        }
        add("  %s\n %s\n", word[4], word[5]);
    }
    add("%s a\n", word[6]);
}

static const char *const lower[7] = {"solid",   "facet normal", "outer loop", "vertex",
                                     "endloop", "endfacet",     "endsolid"};
static const char *const upper[7] = {"SOLID",   "FACET NORMAL", "OUTER LOOP", "VERTEX",
                                     "ENDLOOP", "ENDFACET",     "ENDSOLID"};

/* ---- OFF, glTF */

static void off(const char *head, const char *comment)
{
    add("%s", head);
    add_corners("", comment);
    for (int f = 0; f < 6; f++)
        add("4 %d %d %d %d%s\n", face_of[f][0], face_of[f][1], face_of[f][2], face_of[f][3], comment);
}

/* A cube of 1 m about its origin in a file of its own: first twice as large on two axes and four times on the third, then turned by a
 * quarter about x, then moved to where the cube above is. */
static size_t glb(void)
{
    static const char json[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
        "\"nodes\":[{\"mesh\":0,\"translation\":[4,4,4],\"rotation\":[0.70710678,0,0,0.70710678],"
        "\"scale\":[4,2,4]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"buffers\":[{\"byteLength\":168}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":"
        "96},"
        "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":72}],\"accessors\":[{\"bufferView\":0,"
        "\"componentType\":5126,\"count\":8,\"type\":\"VEC3\",\"min\":[-0.5,-0.5,-0.5],\"max\":[0.5,0.5,0.5]}"
        ","
        "{\"bufferView\":1,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"}]}";
    const uint32_t padded = (uint32_t)(sizeof json - 1 + 3) / 4 * 4;
    size_t n = add_bytes(0, "glTF", 4);
    n = add_bytes(n, (uint32_t[]){2, 12 + 8 + padded + 8 + 168, padded, 0x4e4f534a}, 16);
    memset(text + n, ' ', padded);
    add_bytes(n, json, sizeof json - 1);
    n = add_bytes(n + padded, (uint32_t[]){168, 0x004e4942}, 8);
    for (int c = 0; c < 8; c++)
        for (int a = 0; a < 3; a++)
            n = add_bytes(n, &(float){(at(c, a) - 4) / 4}, 4);
    for (int f = 0; f < 12; f++)
        for (int k = 0; k < 3; k++)
            n = add_bytes(n, &(uint16_t){(uint16_t)face_of[f / 2][half[f % 2][k]]}, 2);
    return n;
}

/* ---- what each is */

static double volume_of_file(const char *name, size_t n)
{
    struct job_node node = MESH(.file = write_file(name, text, n ? n : strlen(text)), .up = MESH_UP_Z);
    struct solid *solid = NULL;
    if (solid_create(&node, 0.25, 2, &solid) != OK)
        fail_msg("%s", status_message());
    solid_destroy(&solid);
    const double volume = volume_of(&node, SIDE, 0.5);
    memset(text, 0, sizeof text);
    return volume;
}

static void marked(void)
{
    add("\xef\xbb\xbf");
    add_corners("v\t", "  # a corner");
    add_faces("f", 1, 1);
}

static void obj_files(void **state)
{
    (void)state;
    marked();
    assert_close(volume_of_file("marked.obj", 0), 64, 1e-6);
    interleaved();
    assert_close(volume_of_file("interleaved.obj", 0), 64, 1e-6);
    continued();
    assert_close(volume_of_file("continued.obj", 0), 64, 1e-6);
    colored();
    assert_close(volume_of_file("colored.obj", 0), 64, 1e-6);
    inwards();
    assert_close(volume_of_file("inwards.obj", 0), 64, 1e-6);
    two_sided();
    assert_close(volume_of_file("two_sided.obj", 0), 64, 1e-6);
    inwards();
    add_faces("f", 1, 1); /* of its squares, other halves */
    struct job_node cancelled = MESH(.file = write_text("cancelled.obj", text), .up = MESH_UP_Z);
    assert_failed(solid_create(&cancelled, 0.25, 2, &(struct solid *){NULL}), E_INPUT, "cancel",
                  "either side");
    memset(text, 0, sizeof text);
    one_face_twice();
    assert_close(volume_of_file("one_face_twice.obj", 0), 64, 1e-6);
    hollow();
    assert_close(volume_of_file("hollow.obj", 0), 64 - 8, 1e-6);
}

static void ply_files(void **state)
{
    (void)state;
    assert_close(volume_of_file("crlf.ply", ply("\r\n", "vertex_indices")), 64, 1e-6);
    assert_close(volume_of_file("index.ply", ply("\n", "vertex_index")), 64, 1e-6);
}

static void stl_files(void **state)
{
    (void)state;
    assert_close(volume_of_file("binary.stl", binary_stl()), 64, 1e-6);
    assert_close(volume_of_file("no_ending", binary_stl()), 64, 1e-6);
    add_solid(lower, 0, 12);
    assert_close(volume_of_file("lower.stl", 0), 64, 1e-6);
    add_solid(upper, 0, 12);
    assert_close(volume_of_file("upper.stl", 0), 64, 1e-6);
    add_solid(lower, 0, 5);
    add_solid(lower, 5, 12);
    assert_close(volume_of_file("two.stl", 0), 64, 1e-6);
}

static void off_files(void **state)
{
    (void)state;
    off("OFF\n8 6 0\n", "");
    assert_close(volume_of_file("plain.off", 0), 64, 1e-6);
    off("OFF\n# a cube\n\n8 6 12\n", "");
    assert_close(volume_of_file("comment.off", 0), 64, 1e-6);
    off("OFF 8 6 0\n", "");
    assert_close(volume_of_file("one_line.off", 0), 64, 1e-6);
    off("OFF8 6 0\n", "");
    assert_close(volume_of_file("no_blank.off", 0), 64, 1e-6);
}

static void gltf_files(void **state)
{
    (void)state;
    struct solid *solid = NULL;
    double min[3], max[3];
    const size_t n = glb();
    struct job_node node = MESH(.file = write_file("turned.glb", text, n), .up = MESH_UP_Z);
    assert_int_equal(solid_create(&node, 0.25, 2, &solid), OK);
    solid_bounds(solid, min, max);
    for (int a = 0; a < 3; a++) { /* what was high along y is so along z */
        assert_close(min[a], a == 2 ? 3 : 2, 1e-6);
        assert_close(max[a], a == 2 ? 5 : 6, 1e-6);
    }
    solid_destroy(&solid);
    assert_close(volume_of_file("turned.glb", n), 32, 1e-6);
}

/* The asset of glb() as JSON, and its buffer in a file beside it whose name has a blank. */
static void gltf_with_its_buffer_beside_it(void **state)
{
    (void)state;
    static const char *const key = "\"buffers\":[{";
    char json[2000];
    const size_t n = glb();
    uint32_t n_json;
    memcpy(&n_json, text + 12, sizeof n_json);
    const char *at = memmem(text, n, key, strlen(key));
    assert_non_null(at);
    at += strlen(key);
    snprintf(json, sizeof json, "%.*s\"uri\":\"cube%%20data.bin\",%.*s", (int)(at - text - 20), text + 20,
             (int)(text + 20 + n_json - at), at);
    write_file("cube data.bin", text + n - 168, 168);
    memset(text, 0, sizeof text);
    add("%s", json);
    assert_close(volume_of_file("apart.gltf", 0), 32, 1e-6);
    struct job_node node = MESH(.file = write_text("apart.gltf", json), .up = MESH_UP_Z);
    write_file("cube data.bin", json, 20);
    assert_failed(solid_create(&node, 0.25, 2, &(struct solid *){NULL}), E_INPUT, "apart.gltf", "gltf");
}

/* A face like an L, in the order that makes a fan from its first corner reach out of it: an L of 3 m2 drawn 2 m high. */
static void concave(const char *form)
{
    static const double corner[6][2] = {{1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}, {1, 1}};
    const bool off = *form == 'o';
    if (off)
        add("OFF\n12 8 0\n");
    for (int z = 0; z < 2; z++)
        for (int c = 0; c < 6; c++)
            add("%s%g %g %d\n", off ? "" : "v ", 2 + corner[c][0], 2 + corner[c][1], 2 + 2 * z);
    for (int z = 0; z < 2; z++) {
        add(off ? "6" : "f");
        for (int k = 0; k < 6; k++)
            add(" %d", (z ? (k + 4) % 6 : (9 - k) % 6) + 6 * z + !off);
        add("\n");
    }
    for (int c = 0; c < 6; c++)
        add("%s %d %d %d %d\n", off ? "4" : "f", c + !off, (c + 1) % 6 + !off, (c + 1) % 6 + 6 + !off,
            c + 6 + !off);
}

static void concave_faces_keep_their_shape(void **state)
{
    (void)state;
    static const char *const names[] = {"concave.obj", "concave.off"};
    for (int i = 0; i < 2; i++) {
        concave(names[i] + 8);
        struct job_node node = MESH(.file = write_text(names[i], text), .up = MESH_UP_Z);
        struct solid *solid = NULL;
        assert_int_equal(solid_create(&node, 0.125, 1, &solid), OK);
        /* In the notch, just below the plane of the upper face: 0.6 m from the nearest wall. */
        assert_close(solid_at(solid, (const double[]){2.4, 2.4, 3.95}).distance, 0.6, 0.1);
        solid_destroy(&solid);
        assert_close(volume_of_file(names[i], 0), 6, 1e-3);
    }
}

/* Each says what it is and what to do. */
static void others_are_named(void **state)
{
    (void)state;
    static const struct {
        const char *bytes, *word, *other;
        size_t n;
    } file[] = {
        {"PXR-USDC\0\10", "USD", "convert it to", 10},
        {"#usda 1.0\n", "USD", "convert it to", 10},
        {"Ogawa\xff", "Alembic", "convert it to", 6},
        {"Kaydara FBX Binary  ", "FBX", "convert it to", 20},
        {"PK\3\4....", "zip", "convert it to", 8},
        {" BDV\0\0\0\0", "OpenVDB", "volume", 8},
        {"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"a.bin\",\"byteLength\":4}]}", "a.bin",
         "No such file", 70},
        {"{\"buffers\":[{\"uri\":\"..%2fa.bin\"}]}", "same folder", ".glb", 0},
        {"{\"buffers\":[{\"uri\":\"http://a/b\"}]}", "same folder", ".glb", 0},
        {"{\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]}", "KHR_draco", "without compression", 0},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0", ":4:", "number", 49},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "", "", 37},
        {"v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", "carriage returns", "convert", 0},
        {"glTF\2\0\0\0\xff\xff\xff\xff", "GLB", "truncated", 12},
    };
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
        struct job_node node =
            MESH(.file = write_file("other", file[i].bytes, file[i].n ? file[i].n : strlen(file[i].bytes)),
                 .up = MESH_UP_Z);
        struct solid *solid = NULL;
        assert_failed(solid_create(&node, 0.25, 2, &solid), E_INPUT, file[i].word, file[i].other);
    }
}

/* Cut short, and with bits turned: refused or read, and what is read is in range. */
static void damaged_files_never_crash(void **state)
{
    (void)state;
    static char whole[sizeof text];
    char *name = strdup(scratch_file("damaged"));
    uint32_t x = 71;
    for (int kind = 0; kind < 4; kind++) {
        memset(text, 0, sizeof text);
        size_t n = kind == 0 ? binary_stl() : kind == 1 ? glb() : 0;
        if (kind == 2)
            add_solid(lower, 0, 12);
        if (kind == 3)
            off("OFF\n8 6 0\n", "");
        n = n ? n : strlen(text);
        memcpy(whole, text, n);
        for (size_t i = 0; i < effort_of(40); i++) {
            memcpy(text, whole, n);
            for (uint32_t k = i % 4 ? next_random(&x) % 6 + 1 : 0; k > 0; k--)
                text[next_random(&x) % n] ^= (char)(1 << next_random(&x) % 8);
            write_file("damaged", text, i % 4 ? n : next_random(&x) % n);
            struct mesh mesh;
            const status st = mesh_read(name, NULL, &mesh);
            assert_true(st == OK || st == E_INPUT);
            for (size_t t = 0; st == OK && t < mesh.n_triangles * 3; t++)
                assert_true(mesh.triangle[t / 3][t % 3] < mesh.n_vertices);
            mesh_free(&mesh);
        }
    }
    free(name);
    memset(text, 0, sizeof text);
}

/* ---- formulas */

#define FUNCTION(...)                                                                                        \
    ((struct job_node){                                                                                      \
        .kind = NODE_SHAPE, .shape = SHAPE_FUNCTION, .u.function = {PLACED, .octaves = 3, __VA_ARGS__}})

static void formulas_are_shapes(void **state)
{
    (void)state;
    struct job_node ball =
        FUNCTION(.expression = (char *)"sqrt((x-4)^2 + (y-4)^2 + (z-4)^2) - 3", .max_m = {8, 8, 8});
    assert_close(volume_of(&ball, SIDE, 0.5), 4 / 3.0 * M_PI * 27, 0.003);
    /* Steep, flat and cut by its box. */
    struct job_node slab =
        FUNCTION(.expression = (char *)"z < 3.3 ? -1e-3 : 1e3", .min_m = {1, 1, 1}, .max_m = {5, 6, 7});
    assert_close(volume_of(&slab, SIDE, 0.5), 4 * 5 * 2.3, 0.003);
    struct job_node wavy = FUNCTION(.expression = (char *)"z - 4 - noise(x/3, y/3, z/3)", .max_m = {8, 8, 8});
    const double once = volume_of(&wavy, SIDE, 0.5);
    assert_close(once, 256, 0.2);
    assert_true(volume_of(&wavy, SIDE, 0.5) == once);
    wavy.u.function.seed = 1;
    assert_true(volume_of(&wavy, SIDE, 0.5) != once);
    /* Placed like any other. */
    struct job_node large = FUNCTION(.expression = (char *)"hypot3 - 1", .max_m = {1, 1, 1});
    large.u.function.expression = (char *)"max(abs(x), max(abs(y), abs(z))) - 1";
    for (int a = 0; a < 3; a++) {
        large.u.function.min_m[a] = -1;
        large.u.function.scale[a] = 2;
        large.u.function.translate_m[a] = 4;
    }
    assert_close(volume_of(&large, SIDE, 0.5), 64, 1e-6);
}

static void bad_formulas_are_refused_with_their_place(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        {"sqrt(x", "character 7"}, {"x + * y", "character 5"}, {"x + w", "character 5"},
        {"", "expression"},        {"0/0", "no finite value"}, {"system(\"x\")", "character"},
        {"x = 3 4", "character"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct job_node node = FUNCTION(.expression = (char *)bad[i][0], .max_m = {8, 8, 8});
        struct solid *solid = NULL;
        assert_failed(solid_create(&node, 0.25, 2, &solid), E_USAGE, bad[i][1], "expression");
    }
    struct job_node steep = FUNCTION(.expression = (char *)"5 * x - 4", .max_m = {8, 8, 8}, .steepest = 2);
    assert_failed(solid_create(&steep, 0.25, 2, &(struct solid *){NULL}), E_USAGE, "rises by 5", "steepest");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(obj_files),
        cmocka_unit_test(ply_files),
        cmocka_unit_test(stl_files),
        cmocka_unit_test(off_files),
        cmocka_unit_test(gltf_files),
        cmocka_unit_test(gltf_with_its_buffer_beside_it),
        cmocka_unit_test(concave_faces_keep_their_shape),
        cmocka_unit_test(others_are_named),
        cmocka_unit_test(damaged_files_never_crash),
        cmocka_unit_test(formulas_are_shapes),
        cmocka_unit_test(bad_formulas_are_refused_with_their_place),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
