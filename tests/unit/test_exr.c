/* EXR files: what goes in comes out, attributes as the standard has them, and damage is noticed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#undef fail /* ours is another */

#include <math.h>
#include <omp.h>
#include <openexr.h>

#include "base/memory.h"
#include "exr/exr.h"
#include "system/atomic_file.h"
#include "text/json.h"
#include "unit/damage.h"

enum { WIDTH = 61, HEIGHT = 37, PIXELS = WIDTH * HEIGHT };

static struct exr_options options_of(int layout)
{
    return (struct exr_options){.layout = layout,
                                .fps = 24,
                                .frame = 1001,
                                .years = 12500.5,
                                .job_hash = 0x0123456789abcdefU,
                                .owner = "Desert Films",
                                .comments = "take 3"};
}

/* Channels out of order, of all three types; values that compress and values that do not. */
static status sample_image(struct aov_image *image)
{
    static const struct {
        const char *part, *name;
        int half;
    } channels[] = {{"rgba", "R", 1},
                    {"rgba", "G", 1},
                    {"rgba", "B", 1},
                    {"rgba", "A", 1},
                    {"depth", "Z", 0},
                    {"N", "N.Z", 0},
                    {"N", "N.X", 0},
                    {"N", "N.Y", 0},
                    {"stress", "stress.von_mises", 0},
                    {"layer", "layer.id", 0},
                    {"stress", "stress.trace", 0}};
    const size_t n = sizeof channels / sizeof *channels;
    status st = OK;
    *image = (struct aov_image){.camera = "main", .width = WIDTH, .height = HEIGHT, .n_channels = n};
    for (int i = 0; i < 16; i++) {
        image->world_to_camera[i] = i % 5 == 0 ? 1 : 0.25 * i;
        image->world_to_ndc[i] = 0.5 - i;
    }
    TRY(memory_alloc(n, sizeof *image->channel, "channels", &image->channel));
    TRY(memory_alloc(n * PIXELS, 4, "planes", &image->memory));
    uint32_t random = 1;
    for (size_t c = 0; c < n; c++) {
        float *value = (float *)image->memory + c * PIXELS;
        uint32_t *id = (uint32_t *)image->memory + c * PIXELS;
        const bool is_id = strcmp(channels[c].name, "layer.id") == 0;
        for (size_t i = 0; i < PIXELS; i++)
            if (is_id)
                id[i] = (uint32_t)(i / 100) * 0x01010101U;
            else if (channels[c].half)
                value[i] = (float)(i % 512) / 256;
            else
                value[i] = c % 2 ? (float)i * 0.1F : (float)damage_random(&random) * 1e-6F;
        image->channel[c] = (struct aov_channel){channels[c].part, channels[c].name, is_id ? NULL : value,
                                                 is_id ? id : NULL, channels[c].half};
    }
done:
    return st;
}

static void image_free(struct aov_image *image)
{
    free(image->channel);
    free(image->memory);
}

static void write_image(const char *path, int layout)
{
    struct aov_image image;
    const struct exr_options options = options_of(layout);
    void *bytes;
    size_t size;
    assert_int_equal(sample_image(&image), OK);
    assert_int_equal(exr_encode(&image, &options, &bytes, &size), OK);
    assert_int_equal(atomic_file_write(path, bytes, size), OK);
    free(bytes);
    image_free(&image);
}

/* One channel of a part, as floats or ids, through the library's own reader. */
static void read_channel(exr_context_t exr, int part, const char *name, void *plane, uint16_t *type)
{
    static float other[16][PIXELS];
    int32_t lines;
    bool found = false;
    assert_int_equal(exr_get_scanlines_per_chunk(exr, part, &lines), 0);
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t info;
        exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(exr, part, y, &info), 0);
        assert_int_equal(exr_decoding_initialize(exr, part, &info, &pipe), 0);
        /* All of them: OpenEXR 3.1 crashes when it is to skip some halves. */
        for (int c = 0; c < pipe.channel_count; c++) {
            exr_coding_channel_info_t *channel = &pipe.channels[c];
            channel->user_data_type = channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
            channel->user_bytes_per_element = 4;
            channel->user_pixel_stride = 4;
            channel->user_line_stride = 4 * WIDTH;
            channel->decode_to_ptr = (uint8_t *)other[c];
            if (strcmp(channel->channel_name, name) == 0) {
                found = true;
                *type = channel->data_type;
                channel->decode_to_ptr = (uint8_t *)plane + 4 * y * WIDTH;
            }
        }
        assert_int_equal(exr_decoding_choose_default_routines(exr, part, &pipe), 0);
        assert_int_equal(exr_decoding_run(exr, part, &pipe), 0);
        exr_decoding_destroy(exr, &pipe);
    }
    assert_true(found);
}

static int find_part(exr_context_t exr, const char *name)
{
    int n;
    assert_int_equal(exr_get_count(exr, &n), 0);
    for (int part = 0; part < n; part++) {
        const char *found;
        assert_int_equal(exr_get_name(exr, part, &found), 0);
        if (strcmp(found, name) == 0)
            return part;
    }
    return -1;
}

static void pixels_come_back(void **state)
{
    (void)state;
    for (int layout = 0; layout < 2; layout++) {
        struct aov_image image;
        exr_context_t exr;
        int n;
        write_image("round.exr", layout);
        assert_int_equal(sample_image(&image), OK);
        assert_int_equal(exr_start_read(&exr, "round.exr", NULL), 0);
        assert_int_equal(exr_get_count(exr, &n), 0);
        assert_int_equal(n, layout == AOV_LAYOUT_MULTI ? 5 : 1);
        for (size_t c = 0; c < image.n_channels; c++) {
            const struct aov_channel *channel = &image.channel[c];
            float plane[PIXELS];
            uint16_t type = 99;
            const int part = layout == AOV_LAYOUT_MULTI ? find_part(exr, channel->part) : 0;
            assert_true(part >= 0);
            read_channel(exr, part, channel->name, plane, &type);
            assert_int_equal(type, !channel->value ? EXR_PIXEL_UINT
                                   : channel->half ? EXR_PIXEL_HALF
                                                   : EXR_PIXEL_FLOAT);
            /* the sample's halves are exact */
            assert_memory_equal(plane,
                                channel->value ? (const void *)channel->value : (const void *)channel->id,
                                sizeof plane);
        }
        exr_finish(&exr);
        image_free(&image);
    }
}

static void attributes_are_the_standard_ones(void **state)
{
    (void)state;
    struct aov_image image;
    exr_context_t exr;
    assert_int_equal(sample_image(&image), OK);
    write_image("attributes.exr", AOV_LAYOUT_MULTI);
    assert_int_equal(exr_start_read(&exr, "attributes.exr", NULL), 0);
    for (int part = 0; part < 5; part++) {
        exr_attr_m44f_t m;
        exr_attr_rational_t fps;
        exr_attr_timecode_t time;
        exr_attr_chromaticities_t primaries;
        exr_compression_t how;
        int32_t frame, length;
        double years;
        const char *text;
        assert_int_equal(exr_attr_get_m44f(exr, part, "worldToCamera", &m), 0);
        for (int i = 0; i < 16; i++)
            assert_true(m.m[i] == (float)image.world_to_camera[i]);
        assert_int_equal(exr_attr_get_m44f(exr, part, "worldToNDC", &m), 0);
        for (int i = 0; i < 16; i++)
            assert_true(m.m[i] == (float)image.world_to_ndc[i]);
        assert_int_equal(exr_attr_get_rational(exr, part, "framesPerSecond", &fps), 0);
        assert_int_equal(fps.num, 24);
        assert_int_equal(fps.denom, 1);
        assert_int_equal(exr_attr_get_timecode(exr, part, "timeCode", &time), 0);
        assert_int_equal(time.time_and_flags, 0x00004117); /* 1001 = 41 s and 17 frames */
        assert_int_equal(exr_attr_get_chromaticities(exr, part, "chromaticities", &primaries), 0);
        assert_true(primaries.red_x == 0.64F && primaries.white_y == 0.3290F);
        assert_int_equal(exr_attr_get_string(exr, part, "owner", &length, &text), 0);
        assert_string_equal(text, "Desert Films");
        assert_int_equal(exr_attr_get_string(exr, part, "comments", &length, &text), 0);
        assert_string_equal(text, "take 3");
        assert_int_equal(exr_attr_get_string(exr, part, "hoodoo:jobHash", &length, &text), 0);
        assert_string_equal(text, "0123456789abcdef");
        assert_int_equal(exr_attr_get_int(exr, part, "hoodoo:frame", &frame), 0);
        assert_int_equal(frame, 1001);
        assert_int_equal(exr_attr_get_double(exr, part, "hoodoo:years", &years), 0);
        assert_true(years == 12500.5);
        assert_int_equal(exr_get_compression(exr, part, &how), 0);
        assert_int_equal(how, EXR_COMPRESSION_ZIP);
    }
    exr_finish(&exr);
    image_free(&image);
}

static void rates_are_rational(void **state)
{
    (void)state;
    static const struct {
        double fps;
        int num;
        unsigned denom;
    } rates[] = {{24, 24, 1},          {23.976, 24000, 1001}, {24000.0 / 1001, 24000, 1001},
                 {29.97, 30000, 1001}, {59.94, 60000, 1001},  {12.5, 12500, 1000}};
    for (size_t i = 0; i < sizeof rates / sizeof *rates; i++) {
        struct aov_image image;
        struct exr_options options = options_of(AOV_LAYOUT_SINGLE);
        exr_context_t exr;
        exr_attr_rational_t fps;
        void *bytes;
        size_t size;
        options.fps = rates[i].fps;
        assert_int_equal(sample_image(&image), OK);
        assert_int_equal(exr_encode(&image, &options, &bytes, &size), OK);
        damage_put("rate.exr", bytes, size);
        assert_int_equal(exr_start_read(&exr, "rate.exr", NULL), 0);
        assert_int_equal(exr_attr_get_rational(exr, 0, "framesPerSecond", &fps), 0);
        assert_int_equal(fps.num, rates[i].num);
        assert_int_equal(fps.denom, rates[i].denom);
        exr_finish(&exr);
        free(bytes);
        image_free(&image);
    }
}

static void equal_input_gives_equal_bytes(void **state)
{
    (void)state;
    struct aov_image image;
    const struct exr_options options = options_of(AOV_LAYOUT_MULTI);
    void *first = NULL, *bytes;
    size_t first_size = 0, size;
    const int threads[] = {1, 2, 5};
    assert_int_equal(sample_image(&image), OK);
    for (int k = 0; k < 3; k++) {
        omp_set_num_threads(threads[k]);
        assert_int_equal(exr_encode(&image, &options, &bytes, &size), OK);
        if (!first) {
            first = bytes;
            first_size = size;
            continue;
        }
        assert_int_equal(size, first_size);
        assert_memory_equal(bytes, first, size);
        free(bytes);
    }
    free(first);
    image_free(&image);
}

/* Pixels beyond the picture: the data window is larger than the display window. */
static void overscan_is_outside_the_display_window(void **state)
{
    (void)state;
    for (int layout = 0; layout < 2; layout++) {
        struct aov_image image;
        const struct exr_options options = options_of(layout);
        void *bytes;
        size_t size;
        exr_context_t exr = NULL;
        exr_attr_box2i_t data, display;
        assert_int_equal(sample_image(&image), OK);
        image.margin[0] = 5;
        image.margin[1] = 3;
        assert_int_equal(exr_encode(&image, &options, &bytes, &size), OK);
        assert_int_equal(atomic_file_write("over.exr", bytes, size), OK);
        assert_int_equal(exr_check("over.exr"), OK);
        assert_int_equal(exr_start_read(&exr, "over.exr", NULL), 0);
        assert_int_equal(exr_get_data_window(exr, 0, &data), 0);
        assert_int_equal(exr_get_display_window(exr, 0, &display), 0);
        assert_int_equal(data.min.x, -5);
        assert_int_equal(data.min.y, -3);
        assert_int_equal(data.max.x, WIDTH - 6);
        assert_int_equal(data.max.y, HEIGHT - 4);
        assert_int_equal(display.min.x, 0);
        assert_int_equal(display.min.y, 0);
        assert_int_equal(display.max.x, WIDTH - 11);
        assert_int_equal(display.max.y, HEIGHT - 7);
        exr_finish(&exr);
        free(bytes);
        image_free(&image);
    }
}

static void what_is_no_picture_is_refused(void **state)
{
    (void)state;
    struct aov_image image;
    const struct exr_options options = options_of(AOV_LAYOUT_MULTI);
    void *bytes = NULL;
    size_t size;
    assert_int_equal(sample_image(&image), OK);
    image.channel[3].name = "R";
    assert_int_equal(exr_encode(&image, &options, &bytes, &size), E_OUTPUT);
    assert_non_null(strstr(status_message(), "named R"));
    image.channel[3] = (struct aov_channel){.part = "rgba", .name = "A"};
    assert_int_equal(exr_encode(&image, &options, &bytes, &size), E_OUTPUT);
    image.n_channels = 0;
    assert_int_equal(exr_encode(&image, &options, &bytes, &size), E_OUTPUT);
    image.n_channels = 3;
    image.width = 0;
    assert_int_equal(exr_encode(&image, &options, &bytes, &size), E_OUTPUT);
    image_free(&image);
}

static status describe_check(const char *path)
{
    struct text text = {0};
    struct json *json = NULL;
    json_object(&text, NULL);
    status st = exr_describe(path, &text);
    json_end_object(&text);
    if (st == OK) {
        assert_int_equal(json_read(path, text.data, text.size, &json), OK);
        json_free(&json);
    }
    text_free(&text);
    return st;
}

static void description_says_what_is_in_it(void **state)
{
    (void)state;
    struct text text = {0};
    struct json *json;
    write_image("said.exr", AOV_LAYOUT_MULTI);
    json_object(&text, NULL);
    assert_int_equal(exr_describe("said.exr", &text), OK);
    json_end_object(&text);
    assert_int_equal(json_read("said", text.data, text.size, &json), OK);
    assert_int_equal(json_member(json, "parts")->n, 5);
    const struct json *part = json_member(json, "parts")->first;
    assert_string_equal(json_to_text(json_member(part, "name")), "rgba");
    assert_true(json_member(part, "width")->number == WIDTH);
    assert_true(json_member(part, "height")->number == HEIGHT);
    assert_string_equal(json_to_text(json_member(part, "compression")), "zip");
    assert_int_equal(json_member(part, "channels")->n, 4);
    const struct json *attributes = json_member(part, "attributes");
    assert_string_equal(json_to_text(json_member(attributes, "timeCode")), "00:00:41:17");
    assert_string_equal(json_to_text(json_member(attributes, "framesPerSecond")), "24/1");
    assert_true(json_member(attributes, "hoodoo:years")->number == 12500.5);
    json_free(&json);
    text_free(&text);
}

static void damage_is_noticed(void **state)
{
    (void)state;
    write_image("multi.exr", AOV_LAYOUT_MULTI);
    write_image("single.exr", AOV_LAYOUT_SINGLE);
    assert_int_equal(exr_check("multi.exr"), OK);
    assert_int_equal(exr_check("single.exr"), OK);
    assert_int_equal(exr_check("missing.exr"), E_INPUT);
    damage_truncate("multi.exr", exr_check, 30);
    damage_truncate("single.exr", exr_check, 30);
    damage_flip("multi.exr", exr_check, 80);
    damage_flip("single.exr", exr_check, 40);
}

static void hostile_bytes_do_not_take_us_down(void **state)
{
    (void)state;
    write_image("multi.exr", AOV_LAYOUT_MULTI);
    write_image("single.exr", AOV_LAYOUT_SINGLE);
    damage_fuzz("multi.exr", describe_check, 60);
    damage_fuzz("single.exr", describe_check, 60);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_come_back),
        cmocka_unit_test(attributes_are_the_standard_ones),
        cmocka_unit_test(rates_are_rational),
        cmocka_unit_test(equal_input_gives_equal_bytes),
        cmocka_unit_test(overscan_is_outside_the_display_window),
        cmocka_unit_test(what_is_no_picture_is_refused),
        cmocka_unit_test(description_says_what_is_in_it),
        cmocka_unit_test(damage_is_noticed),
        cmocka_unit_test(hostile_bytes_do_not_take_us_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
