/* Pages from templates: what a user typed is text and never HTML, and sections show what there is. */
#include "check.h"

#include <string.h>

#include "render/template.h"

static char page[2000];

static const char *filled(const char *const *lines, const char *data)
{
    struct json *json = NULL;
    struct text out = {0};
    assert_ok(json_read(NULL, data, strlen(data), &json));
    template_fill(lines, json, &out);
    assert_ok(text_status(&out));
    assert_true(out.size < sizeof page);
    memcpy(page, out.data ? out.data : "", out.size);
    page[out.size] = '\0';
    text_free(&out);
    json_free(&json);
    return page;
}

#define FILLED(data, ...) filled((const char *const[]){__VA_ARGS__, NULL}, data)

static void values_are_escaped(void **state)
{
    (void)state;
    const char *data =
        "{\"v\": \"<b a='1'>\\\"&\\n{{v}}\", \"n\": -12.50, \"p\": \"a/b 1%.vdb\", \"h\": \"<b>\"}";
    assert_string_equal(FILLED(data, "<i>{{v}}</i>"), "<i>&lt;b a=&#39;1&#39;&gt;&quot;&amp; {{v}}</i>");
    assert_string_equal(FILLED(data, "{{n}} {{%p}} {{&h}}"), "-12.50 a/b%201%25.vdb <b>");
    assert_string_equal(FILLED("{\"v\": \"\xff\"}", "{{v}}"), "\xef\xbf\xbd");
}

static void sections_show_what_there_is(void **state)
{
    (void)state;
    static const char *const none[] = {"{}", "{\"a\": false}", "{\"a\": null}", "{\"a\": \"\"}",
                                       "{\"a\": []}"};
    static const char *const some[] = {"{\"a\": true}", "{\"a\": \"x\"}", "{\"a\": 0}", "{\"a\": {}}",
                                       "{\"a\": [0]}"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        assert_string_equal(FILLED(none[i], "-{{#a}}yes{{/a}}{{^a}}no{{/a}}-"), "-no-");
    for (size_t i = 0; i < sizeof some / sizeof *some; i++)
        assert_string_equal(FILLED(some[i], "-{{#a}}yes{{/a}}{{^a}}no{{/a}}-"), "-yes-");
    /* Nothing is asked of what is not shown. */
    assert_string_equal(FILLED("{}", "{{#a}}{{b}}{{#c}}{{d}}{{/c}}{{/a}}."), ".");
}

static void lists_repeat_and_look_outwards(void **state)
{
    (void)state;
    const char *data =
        "{\"name\": \"N\", \"row\": [{\"k\": 1, \"in\": [\"a\", \"b\"]}, {\"k\": 2, \"name\": \"own\"}, "
        "{\"k\": 3, \"in\": {\"k\": 4}}]}";
    assert_string_equal(FILLED(data, "{{#row}}{{k}}{{name}}{{#in}}({{k}}){{/in}};{{/row}}"),
                        "1N(1)(1);2own;3N(4);");
    assert_string_equal(FILLED("{\"t\": [\"<\", 7]}", "{{#t}}[{{.}}]{{/t}}"), "[&lt;][7]");
    assert_string_equal(FILLED("{\"t\": [[1, 2], [], [3]]}", "{{#t}}{{#.}}{{.}}{{/.}}{{^.}}-{{/.}};{{/t}}"),
                        "12;-;3;");
}

static void lines_of_sections_alone_vanish(void **state)
{
    (void)state;
    assert_string_equal(
        FILLED("{\"r\": [1, 2]}", "<ul>\n", "  {{#r}}\n", "    <li>{{.}}</li>\n", "  {{/r}}\n", "</ul>\n"),
        "<ul>\n<li>1</li>\n<li>2</li>\n</ul>\n");
    assert_string_equal(FILLED("{\"r\": [1, 2]}", "<pre>{{#r}}{{.}}\n", "{{/r}}</pre>\n"),
                        "<pre>1\n2\n</pre>\n");
    assert_string_equal(FILLED("{}", ""), "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_escaped),
        cmocka_unit_test(sections_show_what_there_is),
        cmocka_unit_test(lists_repeat_and_look_outwards),
        cmocka_unit_test(lines_of_sections_alone_vanish),
    };
    return cmocka_run_group_tests_name("template", tests, NULL, NULL);
}
