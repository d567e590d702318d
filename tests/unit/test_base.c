/* JSON as it is read, numbers as they are written, and words that are near. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/json.h"
#include "text/nearest.h"
#include "text/text.h"

#include <cmocka.h> /* after ours: it has a macro fail() */

static void json_as_the_standard_has_it(void **state)
{
    (void)state;
    static const char *const good[] = {
        "{}", " [ ] ", "0", "-0.5e+10", "\"\\u00e9\\ud83d\\ude00\\n\"", "[1,[2,{\"a\":null}],true]"};
    static const char *const bad[] = {"",
                                      "{",
                                      "[1,]",
                                      "{\"a\":}",
                                      "{a:1}",
                                      "01",
                                      "1.",
                                      ".5",
                                      "+1",
                                      "1e",
                                      "nul",
                                      "[1 2]",
                                      "\"\x01\"",
                                      "\"\\x\"",
                                      "\"a",
                                      "\"a\\\"",
                                      "\"\\",
                                      "\"\\u12g4\"",
                                      "\"\\u12\"",
                                      "\"\\ud83d\"",
                                      "\"\\ud83dx\"",
                                      "\"\\ude00\"",
                                      "\"\\u0000\"",
                                      "NaN",
                                      "[1]x",
                                      "{\"a\" 1}",
                                      "-",
                                      "{\"a\":1,\"b\":2,\"a\":3}"};
    struct json *json;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        assert_int_equal(json_read(NULL, good[i], strlen(good[i]), &json), OK);
        if (json->kind == JSON_TEXT)
            assert_string_equal(json_to_text(json), "\xc3\xa9\xf0\x9f\x98\x80\n");
        json_free(&json);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        if (json_read(NULL, bad[i], strlen(bad[i]), &json) != E_INPUT)
            fail_msg("accepted: %s", bad[i]);
}

/* Were keys compared each with each, this would take minutes. */
static void a_million_members(void **state)
{
    (void)state;
    enum { N = 1000000, WIDTH = 12 };
    char *bytes = malloc((size_t)N * WIDTH + 2);
    assert_non_null(bytes);
    for (size_t i = 0; i < N; i++)
        snprintf(bytes + i * WIDTH, WIDTH + 1, "%c\"%07zu\":1", i ? ',' : '{', i);
    bytes[(size_t)N * WIDTH] = '}';
    struct json *json;
    assert_int_equal(json_read(NULL, bytes, (size_t)N * WIDTH + 1, &json), OK);
    assert_int_equal(json->n, N);
    assert_non_null(json_member(json, "0999999"));
    json_free(&json);
    memcpy(bytes + 2, "0999999", 7);
    assert_int_equal(json_read(NULL, bytes, (size_t)N * WIDTH + 1, &json), E_INPUT);
    free(bytes);
}

static void numbers_that_fit(void **state)
{
    (void)state;
    static const char text[] = "[-3, 3.0, 18446744073709551615, 2147483648, 1e2]";
    struct json *json;
    int64_t whole;
    uint64_t large;
    int small = 7;
    assert_int_equal(json_read(NULL, text, sizeof text - 1, &json), OK);
    const struct json *v = json->first;
    assert_true(json_to_int(v, &small) && small == -3);
    assert_false(json_to_uint64(v, &large));
    assert_false(json_to_integer(v, -2, 2, &whole));
    assert_false(json_to_integer(v = v->next, -9, 9, &whole));
    assert_true(json_to_uint64(v = v->next, &large) && large == UINT64_MAX);
    assert_false(json_to_integer(v, INT64_MIN, INT64_MAX, &whole));
    assert_false(json_to_int(v = v->next, &small));
    assert_true(json_to_integer(v, 0, INT64_MAX, &whole) && whole == 2147483648);
    assert_false(json_to_integer(v->next, 0, INT64_MAX, &whole));
    assert_false(json_to_integer(NULL, 0, INT64_MAX, &whole));
    assert_int_equal(small, -3);
    json_free(&json);
}

static void suggests_only_what_is_near(void **state)
{
    (void)state;
    static const char *const known[] = {"run", "plan", "status", "verify", "inspect"};
    assert_string_equal(nearest_word("rnu", known, 5), "run");
    assert_string_equal(nearest_word("verfy", known, 5), "verify");
    assert_string_equal(nearest_word("insp", known, 5), "inspect");
    assert_string_equal(nearest_word("stauts", known, 5), "status");
    assert_null(nearest_word("erode", known, 5));
    assert_null(nearest_word("", known, 5));
    assert_null(nearest_word("aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa", known, 5));
}

/* Digit by digit, as the promise is worded. */
static void expect_shortest(double value)
{
    char got[32], wanted[32];
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(wanted, sizeof wanted, "%.*g", digits, value);
        if (strtod(wanted, NULL) == value)
            break;
    }
    assert_string_equal(number_text(value, got), wanted);
}

static void numbers_are_as_short_as_they_can_be(void **state)
{
    (void)state;
    enum { RANDOM = 200000 };
    const double chosen[] = {
        0,        -0.0,      0.1,          0.3,    1.0 / 3,          100000, 1e15,    1e16,
        DBL_MAX,  DBL_MIN,   DBL_TRUE_MIN, 5e-324, 9007199254740992, 1e23,   8.41e21, 2.2250738585072011e-308,
        INFINITY, -INFINITY, NAN};
    for (size_t i = 0; i < sizeof chosen / sizeof *chosen; i++)
        expect_shortest(chosen[i]);
    for (int e = -1074; e < 1024; e++) {
        expect_shortest(ldexp(1, e));
        expect_shortest(nextafter(ldexp(1, e), 0));
        expect_shortest(nextafter(ldexp(1, e), HUGE_VAL));
    }
    uint64_t bits = 1;
    for (int i = 0; i < RANDOM; i++) {
        double any;
        bits = bits * 6364136223846793005u + 1442695040888963407u;
        memcpy(&any, &bits, sizeof any);
        expect_shortest(any);
        expect_shortest((double)(float)(bits >> 40) * 1e-3);
        expect_shortest((double)(bits >> 44) / 1000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_as_the_standard_has_it),
        cmocka_unit_test(a_million_members),
        cmocka_unit_test(numbers_that_fit),
        cmocka_unit_test(numbers_are_as_short_as_they_can_be),
        cmocka_unit_test(suggests_only_what_is_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
