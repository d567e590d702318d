#include "render/template.h"

#include <assert.h>
#include <string.h>

#include "render/chart.h"

enum { NAME = 40 };

/* A stack of objects and list items; the top is the innermost one. */
struct scope {
    const struct json *value;
    const struct scope *outer;
};

struct tag {
    char kind; /* '#', '^', '/', '&', '%'; 0: a value */
    char name[NAME];
    const char *end;
};

static struct tag read_tag(const char *at)
{
    struct tag tag = {0};
    const char *name = at + 2, *end = strstr(at, "}}");
    assert(end);
    if (strchr("#^/&%", *name))
        tag.kind = *name++;
    assert(end > name && end - name < NAME);
    memcpy(tag.name, name, (size_t)(end - name));
    tag.end = end + 2;
    return tag;
}

static const struct json *find(const struct scope *scope, const char *name)
{
    if (strcmp(name, ".") == 0)
        return scope->value;
    for (; scope; scope = scope->outer) {
        const struct json *value = json_member(scope->value, name);
        if (value)
            return value;
    }
    return NULL;
}

static bool is_there(const struct json *v)
{
    if (!v)
        return false;
    switch (v->kind) {
    case JSON_NULL:
        return false;
    case JSON_BOOL:
        return v->number != 0;
    case JSON_TEXT:
        return *v->text != '\0';
    case JSON_ARRAY:
        return v->n > 0;
    default:
        return true;
    }
}

static void add_address(struct text *t, const char *path)
{
    for (const unsigned char *p = (const unsigned char *)path; *p; p++)
        if ((*p >= 'a' && *p <= 'z') || (*p >= 'A' && *p <= 'Z') || (*p >= '0' && *p <= '9') ||
            strchr("_-./", *p))
            text_add_bytes(t, p, 1);
        else
            text_add(t, "%%%02X", *p);
}

static void add_value(const struct scope *scope, const struct tag *tag, struct text *out)
{
    const struct json *value = find(scope, tag->name);
    assert(value && (value->kind == JSON_TEXT || value->kind == JSON_NUMBER));
    if (tag->kind == '&')
        text_add_bytes(out, value->text, strlen(value->text));
    else if (tag->kind == '%')
        add_address(out, value->text);
    else
        html_text(out, value->text);
}

/* Processes the template from `at` to the end of the section or of the template, and returns the rest. `out` NULL: without output. */
static const char *fill(const char *at, const struct scope *scope, struct text *out)
{
    for (const char *open; (open = strstr(at, "{{"));) {
        const struct tag tag = read_tag(open);
        if (out)
            text_add_bytes(out, at, (size_t)(open - at));
        at = tag.end;
        if (tag.kind == '/')
            return at;
        if (tag.kind != '#' && tag.kind != '^') {
            if (out)
                add_value(scope, &tag, out);
            continue;
        }
        const struct json *value = out ? find(scope, tag.name) : NULL;
        const bool list = tag.kind == '#' && value && value->kind == JSON_ARRAY && value->first;
        const char *next = NULL;
        for (const struct json *item = list ? value->first : NULL; item; item = item->next)
            next = fill(at, &(struct scope){item, scope}, out);
        if (!list)
            next = fill(at, tag.kind == '#' ? &(struct scope){value, scope} : scope,
                        is_there(value) == (tag.kind == '#') ? out : NULL);
        at = next;
    }
    if (out)
        text_add_bytes(out, at, strlen(at));
    return at + strlen(at);
}

void template_fill(const char *const *lines, const struct json *data, struct text *out)
{
    struct text whole = {0};
    for (; *lines; lines++) {
        const char *line = *lines + strspn(*lines, " ");
        const char *end = strchr(line, '\n');
        const bool lone =
            strncmp(line, "{{", 2) == 0 && strchr("#^/", line[2]) && end && strstr(line, "}}") + 2 == end;
        text_add_bytes(&whole, line, strlen(line) - lone);
    }
    if (whole.data && !whole.failed)
        fill(whole.data, &(struct scope){data, NULL}, out);
    out->failed |= whole.failed;
    text_free(&whole);
}
