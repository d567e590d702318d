/* JSON as it is read, and words that are near. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json.h"
#include "base/nearest.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_as_the_standard_has_it),
        cmocka_unit_test(a_million_members),
        cmocka_unit_test(numbers_that_fit),
        cmocka_unit_test(suggests_only_what_is_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
