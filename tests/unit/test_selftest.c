/* The self-test is able to say no: one bit, one count, one part in a hundred. */
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "selftest/compare.h"
#include "selftest/findings.h"

static float P[8] = {1, 2, 3, 0, 4, 5, 6, 0};
static uint32_t id[2] = {7, 9};

static struct checkpoint state(void)
{
    return (struct checkpoint){.frame = 1004,
                               .years = 2700,
                               .n_sections = 2,
                               .section = {{.name = "P", .item = 16, .n = 2, .data = P},
                                           {.name = "id", .item = 4, .n = 2, .data = id}}};
}

static void a_bit_of_a_state_is_missed_nowhere(void **unused)
{
    (void)unused;
    char why[WHY_BYTES] = "";
    float moved[8];
    const struct checkpoint a = state();
    struct checkpoint b = state();
    assert_true(same_state(&a, &b, why));
    b.section[0].data = moved;
    for (size_t bit = 0; bit < 8 * sizeof P; bit++) {
        memcpy(moved, P, sizeof P);
        ((unsigned char *)moved)[bit / 8] ^= (unsigned char)(1u << bit % 8);
        assert_false(same_state(&a, &b, why));
        assert_non_null(strstr(why, bit < 128 ? "item 0 of 2 in 'P'" : "item 1 of 2 in 'P'"));
    }
    memcpy(moved, P, sizeof P);
    assert_true(same_state(&a, &b, why));
    b.section[1].n = 1;
    assert_false(same_state(&a, &b, why));
    b = state();
    strcpy(b.section[1].name, "ids");
    assert_false(same_state(&a, &b, why));
    b = state();
    b.n_sections = 1;
    assert_false(same_state(&a, &b, why));
    b = state();
    b.frame++;
    assert_false(same_state(&a, &b, why));
    b = state();
    b.years = nextafter(b.years, 0);
    assert_false(same_state(&a, &b, why));
}

static void a_wrong_word_is_named(void **unused)
{
    (void)unused;
    char why[WHY_BYTES] = "";
    const uint32_t sums[4] = {0, 3, 7, 12}, wrong[4] = {0, 3, 7, 13};
    assert_true(same_words(sums, sums, 4, why));
    assert_true(same_words(sums, wrong, 3, why));
    assert_false(same_words(sums, wrong, 4, why));
    assert_non_null(strstr(why, "item 3 of 4 is 0x0000000d and should be 0x0000000c"));
}

static void numbers_have_their_tolerance_and_no_more(void **unused)
{
    (void)unused;
    char why[WHY_BYTES] = "";
    assert_true(near_number("x", 100, 101, 0.01, why));
    assert_true(near_number("x", -100, -99, 0.01, why));
    assert_false(near_number("x", 100, 101.1, 0.01, why));
    assert_false(near_number("x", 100, -100, 0.01, why));
    assert_true(near_number("x", 0, 0, 0.01, why));
    assert_false(near_number("x", 0, 1e-9, 0.01, why));
    assert_false(near_number("x", 100, (double)NAN, 0.01, why));
    assert_false(near_number("x", 100, (double)INFINITY, 0.01, why));
}

static void every_measure_counts(void **unused)
{
    (void)unused;
    char why[WHY_BYTES] = "";
    const struct measure good = {.ledger = {100, 70, 10, 5, 15},
                                 .volume_m3 = 545,
                                 .lost_m3 = 145,
                                 .height_m = 4.7,
                                 .stress_p95_Pa = 289000};
    struct measure m = good;
    assert_true(same_measure(&good, &m, why));
    m.ledger.left++; /* rock that comes from nowhere */
    assert_false(same_measure(&good, &m, why));
    assert_non_null(strstr(why, "the ledger began with 100"));
    m = good;
    m.ledger.start = m.ledger.rock = 101;
    m.ledger.deposit = m.ledger.fallen = m.ledger.left = 0; /* balances, of another scene */
    assert_false(same_measure(&good, &m, why));
    assert_non_null(strstr(why, "should have 100"));
    double *const number[] = {&m.volume_m3, &m.lost_m3, &m.height_m, &m.stress_p95_Pa};
    for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
        m = good;
        *number[i] *= 1.001;
        assert_true(same_measure(&good, &m, why));
        *number[i] *= 1.04;
        assert_false(same_measure(&good, &m, why));
        *number[i] = (double)NAN;
        assert_false(same_measure(&good, &m, why));
    }
}

static void percentiles(void **unused)
{
    (void)unused;
    float value[101];
    for (int i = 0; i <= 100; i++)
        value[i] = (float)(i % 2 ? i : -i);
    assert_float_equal(percentile_95(value, 101), 95, 0);
    assert_float_equal(percentile_95(value, 0), 0, 0);
}

static void the_first_wrong_row_is_found_and_shown(void **unused)
{
    (void)unused;
    struct row row[3] = {{.group = "kernels", .name = "scan", .ok = true},
                         {.group = "kernels", .name = "sort", .ok = true},
                         {.group = "memory", .name = "largest", .ok = true}};
    struct findings f = {.device = {.name = "A device", .type = "discrete"},
                         .limits = {.variant = "storage"},
                         .row = row,
                         .n_rows = 3,
                         .pace = {{.spacing_m = 1, .n_stages = 1, .stage = {{"stress", 2000000, 7}}}},
                         .n_paces = 1};
    struct text words = {0}, json = {0};
    assert_null(findings_first_wrong(&f));
    row_wrong(&row[1], "item %d is wrong", 4);
    row_wrong(&row[1], "a later one");
    row_wrong(&row[2], "so is this");
    assert_ptr_equal(findings_first_wrong(&f), &row[1]);
    assert_ok(findings_markdown(&f, &words));
    assert_non_null(strstr(words.data, "| sort               | NO |"));
    assert_non_null(strstr(words.data, "- NOT OK: kernels, sort: item 4 is wrong\n"));
    assert_null(strstr(words.data, "a later one"));
    assert_non_null(strstr(words.data, "3 checks, 2 not ok"));
    assert_non_null(strstr(words.data, "| stress               |      2.00 |"));
    for (const char *line = words.data; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        assert_true(strcspn(line, "\n") <= 80);
    }
    assert_ok(findings_json(&f, &json));
    assert_non_null(strstr(json.data, "\"ok\": false"));
    assert_non_null(strstr(json.data, "\"why\": \"item 4 is wrong\""));
    text_free(&words);
    text_free(&json);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bit_of_a_state_is_missed_nowhere),
        cmocka_unit_test(a_wrong_word_is_named),
        cmocka_unit_test(numbers_have_their_tolerance_and_no_more),
        cmocka_unit_test(every_measure_counts),
        cmocka_unit_test(percentiles),
        cmocka_unit_test(the_first_wrong_row_is_found_and_shown),
    };
    return cmocka_run_group_tests_name("selftest", tests, NULL, NULL);
}
