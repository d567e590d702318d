/* Heightfields and the images they come from: a ramp is a wedge, and hostile images cost an error message. */
#include "effort.h"
#include "image/image.h"
#include "image/rows.h"
#include "scene_help.h"
#include "shape/heightfield.h"

/* Binary PGM of 8 or 16 bits, top row first. */
static char *write_pgm(const char *name, int width, int height, int maximum, int (*value)(int x, int y))
{
    unsigned char bytes[70000];
    size_t n = (size_t)snprintf((char *)bytes, 64, "P5\n%d %d\n%d\n", width, height, maximum);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            int v = value(x, y);
            if (maximum > 255)
                bytes[n++] = (unsigned char)(v >> 8);
            bytes[n++] = (unsigned char)v;
        }
    return write_file(name, bytes, n);
}

/* An uncompressed TIFF of 32-bit floats, little endian. */
static char *write_tiff(const char *name, uint32_t width, uint32_t height, const float *value)
{
    const uint32_t tags[][4] = {{256, 4, 1, width}, {257, 4, 1, height}, {258, 3, 1, 32},
                                {259, 3, 1, 1},     {262, 3, 1, 1},      {273, 4, 1, 8 + 2 + 10 * 12 + 4},
                                {277, 3, 1, 1},     {278, 4, 1, height}, {279, 4, 1, width * height * 4},
                                {339, 3, 1, 3}};
    unsigned char bytes[4096] = {'I', 'I', 42, 0, 8, 0, 0, 0, 10, 0};
    size_t n = 10;
    for (int t = 0; t < 10; t++, n += 12) {
        const uint16_t head[2] = {(uint16_t)tags[t][0], (uint16_t)tags[t][1]};
        memcpy(bytes + n, head, 4);
        memcpy(bytes + n + 4, &tags[t][2], 8);
    }
    memcpy(bytes + n + 4, value, width * height * 4);
    return write_file(name, bytes, n + 4 + width * height * 4);
}

static int ramp_x(int x, int y)
{
    (void)y;
    return x * 2;
}

static int ramp_up(int x, int y)
{
    (void)x;
    return (99 - y) * 600;
}

static struct image read_all(const char *path, struct image_request wish)
{
    struct image image;
    wish.file = path;
    wish.scale = wish.scale != 0 ? wish.scale : 1;
    assert_int_equal(image_read(&wish, &image), OK);
    return image;
}

static void integers_become_0_to_1(void **state)
{
    (void)state;
    struct image image = read_all(write_pgm("a.pgm", 100, 3, 255, ramp_x), (struct image_request){0});
    assert_true(image.width == 100 && image.height == 3);
    for (int i = 0; i < 300; i++)
        assert_true(fabsf(image.value[i] - (float)(i % 100 * 2) / 255) < 1e-6f);
    image_free(&image);
    char *deep = write_pgm("b.pgm", 2, 100, 65535, ramp_up);
    image = read_all(deep, (struct image_request){0});
    assert_true(fabsf(image.value[0] - 59400.0f / 65535) < 1e-7f && image.value[199] == 0);
    image_free(&image);
    /* and stay as they are stored where that is wanted */
    image = read_all(
        deep, (struct image_request){.height = true, .values = IMAGE_STORED, .scale = 0.5, .offset = -7});
    for (int i = 0; i < 200; i++)
        assert_true(image.value[i] == (float)ramp_up(0, i / 2) * 0.5f - 7);
    image_free(&image);
}

static void floats_stay_as_they_are(void **state)
{
    (void)state;
    const float pixels[6] = {0, 1, 2.5f, -3, 1e-3f, 100};
    struct image image = read_all(write_tiff("a.tif", 3, 2, pixels), (struct image_request){0});
    assert_true(image.width == 3 && image.height == 2);
    assert_memory_equal(image.value, pixels, sizeof pixels);
    image_free(&image);
    const float bad[4] = {0, 1, NAN, 0};
    struct heightfield *field;
    struct job_heightfield job = {.file = write_tiff("nan.tif", 2, 2, bad), .max_m = {1, 1, 1}};
    assert_failed(heightfield_create(&job, 1, &field), E_INPUT, "nan.tif", "pixel (0, 1)");
}

/* What EXIF's orientations mean: where the first stored row and column are seen. */
static void pictures_are_turned_as_they_say(void **state)
{
    (void)state;
    enum { W = 5, H = 3 };
    const char *const word[ASK_COUNT] = {"file",   "",       "",  "",  "coverage", "black",
                                         "height", "stored", "1", "0", "0",        "0"};
    for (int turn = 1; turn <= 8; turn++) {
        struct image_decoding m = {
            .path = "", .argument = word, .max_pixels = 100, .orientation = turn, .width = W, .height = H};
        const int wide = turn > 4 ? H : W, high = turn > 4 ? W : H;
        assert_int_equal(image_begin(&m), OK);
        assert_true(m.answer.width == (uint64_t)wide && m.answer.height == (uint64_t)high);
        for (int y = 0; y < H; y++)
            image_row(&m, 0, y, W, (const double[]){10 * y, 10 * y + 1, 10 * y + 2, 10 * y + 3, 10 * y + 4},
                      NULL, NULL);
        for (int v = 0; v < high; v++)
            for (int u = 0; u < wide; u++) {
                /* row: top, top, bottom, bottom, left, right, right, left; column: left, right, right, left, top, top, bottom, bottom */
                const int row[] = {v, v, high - 1 - v, high - 1 - v, u, wide - 1 - u, wide - 1 - u, u};
                const int column[] = {u, wide - 1 - u, wide - 1 - u, u, v, v, high - 1 - v, high - 1 - v};
                assert_true(m.value[v * wide + u] == (float)(10 * row[turn - 1] + column[turn - 1]));
            }
        free(m.value);
    }
}

/* A plane with a hole is the same plane, and with the hole left open there is no rock in its pixels, and all of it beside them. */
static void gaps_are_filled_or_left_empty(void **state)
{
    (void)state;
    float pixels[24 * 20];
    for (int i = 0; i < 24 * 20; i++)
        pixels[i] =
            i % 24 >= 8 && i % 24 < 14 && i / 24 >= 5 && i / 24 < 11 ? NAN : (float)(i % 24 + 2 * (i / 24));
    struct image image = read_all(write_tiff("gap.tif", 24, 20, pixels),
                                  (struct image_request){.nodata = IMAGE_FILL, .height = true});
    for (int i = 0; i < 24 * 20; i++)
        assert_true(fabsf(image.value[i] - (float)(i % 24 + 2 * (i / 24))) <
                    (isnan(pixels[i]) ? 0.5f : 1e-6f));
    assert_null(image.has);
    image_free(&image);

    struct heightfield *field;
    struct job_heightfield job = {
        .file = write_file("gap2.tif", "", 0), .max_m = {24, 20, 1}, .nodata = IMAGE_EMPTY};
    for (int i = 0; i < 24 * 20; i++)
        pixels[i] = isnan(pixels[i]) ? NAN : 10;
    job.file = write_tiff("gap2.tif", 24, 20, pixels);
    assert_int_equal(heightfield_create(&job, 2, &field), OK);
    uint32_t x = 5;
    for (int i = 0; i < 4000; i++) {
        const double p[3] = {next_random(&x) % 24000 * 1e-3, next_random(&x) % 20000 * 1e-3,
                             next_random(&x) % 9900 * 1e-3 + 0.05};
        const bool gap = p[0] >= 8 && p[0] <= 14 && p[1] >= 9 && p[1] <= 15;
        const double away = gap ? fmin(fmin(p[0] - 8, 14 - p[0]), fmin(p[1] - 9, 15 - p[1])) : 1e9;
        const double d = heightfield_distance(field, p);
        assert_true((d > 0) == (gap && away > 0));
        assert_true(!gap || d <= away + 1e-9);
        assert_true(gap ||
                    -d <=
                        hypot(fmax(fmax(8 - p[0], p[0] - 14), 0), fmax(fmax(9 - p[1], p[1] - 15), 0)) + 1e-9);
    }
    heightfield_destroy(&field);
}

static void a_ramp_is_a_wedge(void **state)
{
    (void)state;
    /* Middles of pixels hold 0.5, 1.5, ... of 100: the outermost half pixels are flat. */
    struct job_node along_x = HEIGHTFIELD(.file = write_pgm("x.pgm", 100, 3, 255, ramp_x), .min_m = {2, 2, 1},
                                          .max_m = {18, 18, 16});
    double expected = 16 * 16 * 15 * (99.0 / 255);
    assert_close(volume_of(&along_x, 40, 0.5), expected, 0.005);
    struct job_node along_y = HEIGHTFIELD(.file = write_pgm("y.pgm", 2, 100, 65535, ramp_up),
                                          .min_m = {2, 2, 1}, .max_m = {18, 18, 16});
    assert_close(volume_of(&along_y, 40, 0.5), 16 * 16 * 15 * (99 * 300 / 65535.0), 0.005);
    struct solid *solid;
    assert_int_equal(solid_create(&along_y, 0.25, 2, &solid), OK);
    assert_true(solid_at(solid, (const double[]){10, 17.9, 14}).distance <
                0); /* the top row lies along max_m.y */
    assert_true(solid_at(solid, (const double[]){10, 3, 14}).distance > 0);
    assert_true(solid_at(solid, (const double[]){10, 10, 0.9}).distance > 0); /* nothing below min_m.z */
    assert_true(solid_at(solid, (const double[]){1.9, 17, 2}).distance > 0);
    solid_destroy(&solid);
}

static int cliffs(int x, int y)
{
    return x / 10 % 2 ? 200 - y : 10 + (x * 7 + y * 13) % 20;
}

/* No point of the ground is nearer than the distance says, cliffs or not. */
static void distances_never_overstate(void **state)
{
    (void)state;
    struct job_heightfield job = {
        .file = write_pgm("c.pgm", 100, 100, 255, cliffs), .min_m = {0, 0, 0}, .max_m = {50, 50, 40}};
    struct heightfield *field;
    assert_int_equal(heightfield_create(&job, 3, &field), OK);
    uint32_t x = 3;
    double largest = 0;
    for (int i = 0; i < 3000; i++) {
        double p[3], q[3];
        for (int a = 0; a < 3; a++)
            p[a] = next_random(&x) % 1000000 * 5e-5;
        double d = heightfield_distance(field, p);
        largest = fmax(largest, fabs(d));
        for (int k = 0; k < 200; k++) {
            double square = 0;
            for (int a = 0; a < 3; a++) {
                q[a] = next_random(&x) % 1000000 * 2e-6 - 1;
                square += q[a] * q[a];
            }
            for (int a = 0; a < 3; a++)
                q[a] = p[a] + q[a] * fabs(d) * 0.9999 / sqrt(square);
            assert_true((heightfield_distance(field, q) <= 0) == (d <= 0));
        }
    }
    assert_true(largest > 2);
    heightfield_destroy(&field);
}

static status read_only(const char *path)
{
    struct image image;
    status st = image_read(&(struct image_request){.file = path, .scale = 1}, &image);
    image_free(&image);
    return st;
}

static void hostile_images_are_refused(void **state)
{
    (void)state;
    assert_failed(read_only("/nonexistent/a.png"), E_INPUT, "/nonexistent/a.png", "No such file");
    assert_failed(read_only("/tmp"), E_INPUT, "/tmp", "regular");
    assert_failed(read_only(write_text("empty.png", "")), E_INPUT, "empty.png", "");
    assert_failed(read_only(write_text("text.png", "not a picture at all")), E_INPUT, "text.png", "");
    assert_failed(read_only(write_text("huge.pgm", "P5\n100000 100000\n255\nabc")), E_INPUT, "huge.pgm",
                  "100000 x 100000 pixels");
    assert_failed(read_only(write_text("short.pgm", "P5\n2000 2000\n255\nabc")), E_INPUT, "short.pgm", "");
    /* A PNG whose header claims 100000 x 100000, its checksums right. */
    static const unsigned char png[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
        0x44, 0x52, 0x00, 0x01, 0x86, 0xa0, 0x00, 0x01, 0x86, 0xa0, 0x08, 0x00, 0x00, 0x00,
        0x00, 0x8d, 0x39, 0x54, 0x14, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x78,
        0xda, 0x63, 0x60, 0xa0, 0x0c, 0x00, 0x00, 0x00, 0x40, 0x00, 0x01, 0x89, 0xc9, 0xaf,
        0x43, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    assert_failed(read_only(write_file("huge.png", png, sizeof png)), E_INPUT, "huge.png",
                  "100000 x 100000 pixels");
}

static void damaged_images_never_crash(void **state)
{
    (void)state;
    const float pixels[6] = {0, 1, 2.5f, -3, 1e-3f, 100};
    unsigned char whole[4096], bytes[4096];
    FILE *f = fopen(write_tiff("a.tif", 3, 2, pixels), "rb");
    size_t n = fread(whole, 1, sizeof whole, f);
    uint32_t x = 4;
    fclose(f);
    for (size_t i = effort_of(30); i > 0; i--) {
        memcpy(bytes, whole, n);
        for (uint32_t k = next_random(&x) % 4 + 1; k > 0; k--)
            bytes[next_random(&x) % n] = (unsigned char)next_random(&x);
        status st = read_only(write_file("fuzz.tif", bytes, next_random(&x) % 4 ? n : next_random(&x) % n));
        assert_true(st == OK || st == E_INPUT);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integers_become_0_to_1),
        cmocka_unit_test(floats_stay_as_they_are),
        cmocka_unit_test(a_ramp_is_a_wedge),
        cmocka_unit_test(distances_never_overstate),
        cmocka_unit_test(pictures_are_turned_as_they_say),
        cmocka_unit_test(gaps_are_filled_or_left_empty),
        cmocka_unit_test(hostile_images_are_refused),
        cmocka_unit_test(damaged_images_never_crash),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
