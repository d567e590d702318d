/* Values of parsed JSON: walking them, and taking them as C values. What the parser let through is well
 * formed. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "checkpoint/json_read.h"

const struct json_value *json_first(const struct json_value *group)
{
    return group + 1;
}

const struct json_value *json_next(const struct json_doc *j, const struct json_value *v)
{
    return j->value + v->after;
}

const struct json_value *json_find(const struct json_doc *j, const struct json_value *object, const char *key)
{
    size_t length = strlen(key);
    if (!object || object->kind != JSON_IS_OBJECT)
        return NULL;
    const struct json_value *v = json_first(object);
    for (uint32_t i = 0; i < object->n; i++, v = json_next(j, v))
        if (v->key_size == length && memcmp(j->text + v->key, key, length) == 0)
            return v;
    return NULL;
}

static uint32_t hex4(const char *s)
{
    uint32_t code = 0;
    for (int i = 0; i < 4; i++) {
        char c = s[i];
        code = code << 4 | (uint32_t)(c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10);
    }
    return code;
}

/* The UTF-8 of one \uXXXX (or a surrogate pair) in out, its length in *n; *s moves past it. False for half a
 * pair. */
static bool unescape_u(const char **s, const char *end, char out[4], size_t *n)
{
    const char *p = *s + 6;
    uint32_t code = hex4(*s + 2);
    if (code >= 0xd800 && code < 0xe000) {
        if (code >= 0xdc00 || end - p < 6 || p[0] != '\\' || p[1] != 'u')
            return false;
        uint32_t low = hex4(p + 2);
        p += 6;
        if (low < 0xdc00 || low >= 0xe000)
            return false;
        code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
    }
    *s = p;
    *n = 0;
    if (code >= 0x10000)
        out[(*n)++] = (char)(0xf0 | code >> 18);
    if (code >= 0x800)
        out[(*n)++] = (char)(code >= 0x10000 ? 0x80 | (code >> 12 & 0x3f) : 0xe0 | code >> 12);
    if (code >= 0x80)
        out[(*n)++] = (char)(code >= 0x800 ? 0x80 | (code >> 6 & 0x3f) : 0xc0 | code >> 6);
    out[(*n)++] = (char)(code >= 0x80 ? 0x80 | (code & 0x3f) : code);
    return code != 0;
}

static bool unescape(const char *s, size_t size, char *out, size_t room)
{
    static const char names[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
    const char *end = s + size;
    size_t used = 0;
    while (s < end) {
        char utf8[4] = {*s};
        size_t n = 1;
        if (*s != '\\') {
            s++;
        } else if (s[1] == 'u') {
            if (!unescape_u(&s, end, utf8, &n))
                return false;
        } else {
            utf8[0] = meant[strchr(names, s[1]) - names];
            s += 2;
        }
        if (n >= room - used)
            return false;
        memcpy(out + used, utf8, n);
        used += n;
    }
    out[used] = '\0';
    return true;
}

bool json_get_text(const struct json_doc *j, const struct json_value *v, char *out, size_t size)
{
    return v && v->kind == JSON_IS_TEXT && unescape(j->text + v->at, v->size, out, size);
}

bool json_get_key(const struct json_doc *j, const struct json_value *v, char *out, size_t size)
{
    return unescape(j->text + v->key, v->key_size, out, size);
}

bool json_get_integer(const struct json_doc *j, const struct json_value *v, int64_t min, int64_t max,
                      int64_t *out)
{
    char copy[24], *end;
    if (!v || v->kind != JSON_IS_NUMBER || v->size >= sizeof copy)
        return false;
    memcpy(copy, j->text + v->at, v->size);
    copy[v->size] = '\0';
    errno = 0;
    long long n = strtoll(copy, &end, 10);
    if (*end || errno || n < min || n > max)
        return false;
    *out = n;
    return true;
}

bool json_get_number(const struct json_doc *j, const struct json_value *v, double *out)
{
    char copy[64];
    if (!v || v->kind != JSON_IS_NUMBER || v->size >= sizeof copy)
        return false;
    memcpy(copy, j->text + v->at, v->size);
    copy[v->size] = '\0';
    *out = strtod(copy, NULL);
    return isfinite(*out);
}
