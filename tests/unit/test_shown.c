/* Colours of values and what their legend says; and pictures' files, whole, cut short and hostile. */
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "effort.h"
#include "render/png.h"
#include "render/slate.h"
#include "system/atomic_file.h"

static const struct show_range ranges[] = {{-0.34, 1.7},  {0, 1},      {1, 6e5},       {1e-4, 1},
                                           {-3, -1},      {0, 1e12},   {0.1, 0.10001}, {-1e-6, 1e12},
                                           {999, 1000.5}, {1e-9, 1e-6}};
enum { RANGES = sizeof ranges / sizeof *ranges };

static bool fits(enum value_id show, struct show_range r)
{
    return value_table[show].legend.unit && (r.low > 0 || value_table[show].legend.axis != AXIS_LOG);
}

static void ticks_stand_where_their_values_are(void **state)
{
    (void)state;
    size_t n_ticks = 0;
    for (int show = 1; show < VALUES; show++)
        for (int i = 0; i < RANGES; i++) {
            struct show_tick tick[SHOW_TICKS];
            if (!fits((enum value_id)show, ranges[i]))
                continue;
            size_t n = show_ticks((enum value_id)show, ranges[i], tick);
            assert_in_range(n, 1, SHOW_TICKS);
            n_ticks += n;
            for (size_t k = 0; k < n; k++) {
                char *unit;
                double value = strtod(tick[k].text, &unit);
                value *= *unit == 'k' ? 1e3 : *unit == 'M' ? 1e6 : *unit == 'G' ? 1e9 : 1;
                double at = show_position((enum value_id)show, ranges[i], value);
                assert_true(fabs(at - tick[k].position) < 0.01);
                assert_true(k == 0 || tick[k].position > tick[k - 1].position);
            }
        }
    print_message("# %zu ticks\n", n_ticks);
}

static double lightness(const unsigned char rgb[3])
{
    return 0.2126 * pow(rgb[0] / 255.0, 2.2) + 0.7152 * pow(rgb[1] / 255.0, 2.2) +
           0.0722 * pow(rgb[2] / 255.0, 2.2);
}

/* More is lighter; from zero stress both ways it grows darker. Beyond the ends nothing changes. */
static void colors_are_in_order(void **state)
{
    (void)state;
    enum { STEPS = 400 };
    const struct show_range stress = {-0.5, 2};
    for (int show = 1; show < VALUES; show++) {
        const struct show_range r = show == VALUE_stress ? stress : ranges[3];
        double before = -1;
        for (int i = 0; i <= STEPS; i++) {
            unsigned char rgb[3];
            double t = (double)i / STEPS, rising = show != VALUE_stress || t <= 0.2;
            show_color((enum value_id)show, r, t, rgb);
            if (i > 0 && show == VALUE_stress && fabs(t - 0.2) < 0.01)
                before = lightness(rgb);
            assert_true(before < 0 ||
                        (rising != 0 ? lightness(rgb) >= before - 0.004 : lightness(rgb) <= before + 0.004));
            before = lightness(rgb);
        }
        assert_true(show_position((enum value_id)show, r, r.low - 5) == 0);
        assert_true(show_position((enum value_id)show, r, r.high + 5) == 1);
        assert_true(show_position((enum value_id)show, r, NAN) == 0);
    }
    unsigned char zero[3];
    show_color(VALUE_stress, stress, 0.2, zero);
    assert_true(zero[0] == 221 && zero[1] == 221 && zero[2] == 221);
}

static void a_range_of_data_leaves_the_outermost_out(void **state)
{
    (void)state;
    static float value[10000];
    for (uint32_t i = 0; i < 10000; i++)
        value[i] = i % 200 == 0   ? -1e12F
                   : i % 200 == 1 ? 1e12F
                                  : (float)(random_hash(i, 1, 2, 3) % 2000) * 1e3F;
    struct show_range r = show_data_range(VALUE_von_mises, value, 10000);
    assert_true(r.low >= 0 && r.low < 0.1 && r.high > 1.9 && r.high < 2.1);
    memset(value, 0, sizeof value);
    for (int show = 1; show < VALUES; show++) {
        r = show_data_range((enum value_id)show, value, 10000);
        assert_true(r.low < r.high);
        r = show_data_range((enum value_id)show, value, 0);
        assert_true(r.low < r.high);
    }
}

static void a_slate_has_few_words_in_any_size(void **state)
{
    (void)state;
    static struct slate_command c;
    const int size[][2] = {{8, 120}, {8, 16384}, {16384, 120}, {640, 360}, {200, 200}};
    for (int show = 0; show < VALUES; show++)
        for (size_t k = 0; k < 5; k++)
            for (int i = 0; i < RANGES; i++) {
                struct slate s = {.width = size[k][0],
                                  .height = size[k][1],
                                  .show = (enum value_id)show,
                                  .range = ranges[i]};
                if (!fits(s.show, s.range))
                    continue;
                memset(s.left, 'x', sizeof s.left - 1);
                memset(s.right, 'y', sizeof s.right - 1);
                s.n_marks = 2;
                s.mark[0] = ranges[i].low * 0.5 + ranges[i].high * 0.5;
                s.mark[1] = INFINITY;
                s.mark_name = "interlock";
                assert_true(slate_draws(&s));
                slate_command(&s, "from.png", "bar.ppm", "to.png", &c);
                assert_in_range(c.n, 5, SLATE_WORDS - 2);
                assert_null(c.argv[c.n]);
                assert_string_equal(c.argv[c.n - 1], "to.png");
                if (k == 3 && show != VALUE_NONE)
                    assert_ok(slate_write_bar(&s, "bar.ppm"));
            }
}

/* 1 x 1, of a program that says so and when: zlib's bytes for one black pixel, right sums. */
static const unsigned char small[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x90, 0x77, 0x53,
    0xde, 0x00, 0x00, 0x00, 0x04, 0x67, 0x41, 0x4d, 0x41, 0x00, 0x00, 0xb1, 0x8f, 0x0b, 0xfc, 0x61,
    0x05, 0x00, 0x00, 0x00, 0x0c, 0x74, 0x45, 0x58, 0x74, 0x53, 0x6f, 0x66, 0x74, 0x77, 0x61, 0x72,
    0x65, 0x00, 0x50, 0x4f, 0x56, 0x8c, 0xc9, 0xbc, 0xfc, 0x00, 0x00, 0x00, 0x07, 0x74, 0x49, 0x4d,
    0x45, 0x07, 0xe9, 0x01, 0x02, 0x03, 0x04, 0x05, 0x7c, 0xb6, 0x8e, 0x03, 0x00, 0x00, 0x00, 0x0c,
    0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x60, 0x60, 0x00, 0x00, 0x00, 0x04, 0x00, 0x01,
    0xf6, 0x17, 0x38, 0x55, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

static void a_tag_is_read_back(void **state)
{
    (void)state;
    char tag[PNG_TAG], longest[2 * PNG_TAG];
    void *made, *again;
    size_t n, k;
    for (size_t cut = 0; cut < sizeof small - 12; cut++)
        assert_int_equal(png_with_tag(small, cut, "x", &made, &n), E_INPUT);
    assert_ok(png_with_tag(small, sizeof small, "size=1x1; slate=yes", &made, &n));
    assert_ok(atomic_file_write("tag.png", made, n));
    png_tag("tag.png", tag);
    assert_string_equal(tag, "size=1x1; slate=yes");
    /* The text and the time that were there are gone, the gamma is not; a tag takes the other's place. */
    assert_null(memmem(made, n, "Software", 8));
    assert_null(memmem(made, n, "tIME", 4));
    assert_non_null(memmem(made, n, "gAMA", 4));
    assert_ok(png_with_tag(made, n, "other", &again, &k));
    assert_ok(atomic_file_write("tag.png", again, k));
    png_tag("tag.png", tag);
    assert_string_equal(tag, "other");
    assert_int_equal(k, n - strlen("size=1x1; slate=yes") + strlen("other"));
    free(again);
    assert_ok(png_with_tag(made, n, "size=1x1; slate=yes", &again, &k));
    assert_int_equal(k, n);
    assert_memory_equal(made, again, n);
    free(again);
    memset(longest, 'z', sizeof longest);
    longest[sizeof longest - 1] = '\0';
    assert_ok(png_with_tag(small, sizeof small, longest, &again, &k));
    assert_ok(atomic_file_write("tag.png", again, k));
    png_tag("tag.png", tag);
    assert_int_equal(strlen(tag), PNG_TAG - 1);
    free(again);
    free(made);
    png_tag("there/is/none.png", tag);
    assert_string_equal(tag, "");
    assert_ok(atomic_file_write("tag.png", small, sizeof small));
    png_tag("tag.png", tag);
    assert_string_equal(tag, "");
}

/* Any bytes between a right beginning and end: sizes that lie, chunks that are cut. */
static void hostile_chunks_do_no_harm(void **state)
{
    (void)state;
    char tag[PNG_TAG];
    for (uint32_t round = 0; round < effort_of(600); round++) {
        unsigned char bytes[sizeof small];
        void *made;
        size_t n;
        memcpy(bytes, small, sizeof small);
        for (uint32_t k = 0; k < 6; k++)
            bytes[8 + random_hash(round, k, 1, 1) % (sizeof small - 8 - 12)] =
                (unsigned char)random_hash(round, k, 2, 1);
        const status st = png_with_tag(bytes, sizeof bytes, "x", &made, &n);
        assert_true(st == OK || st == E_INPUT);
        free(made);
        if (round < 200) {
            assert_ok(atomic_file_write("hostile.png", bytes, sizeof bytes));
            png_tag("hostile.png", tag);
            assert_true(strlen(tag) < PNG_TAG);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ticks_stand_where_their_values_are),
        cmocka_unit_test(colors_are_in_order),
        cmocka_unit_test(a_range_of_data_leaves_the_outermost_out),
        cmocka_unit_test(a_slate_has_few_words_in_any_size),
        cmocka_unit_test(a_tag_is_read_back),
        cmocka_unit_test(hostile_chunks_do_no_harm),
    };
    return cmocka_run_group_tests_name("shown", tests, NULL, NULL);
}
