/* Access to parsed JSON: members by key, and conversion to C types. */
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "text/json.h"

const struct json *json_member(const struct json *object, const char *key)
{
    if (!object || object->kind != JSON_OBJECT)
        return NULL;
    for (const struct json *item = object->first; item; item = item->next)
        if (strcmp(item->key, key) == 0)
            return item;
    return NULL;
}

bool json_to_uint64(const struct json *json, uint64_t *out)
{
    if (!json || json->kind != JSON_NUMBER || strspn(json->text, "0123456789") != strlen(json->text))
        return false;
    errno = 0;
    const unsigned long long value = strtoull(json->text, NULL, 10);
    if (errno != 0)
        return false;
    *out = value;
    return true;
}

bool json_to_integer(const struct json *json, int64_t min, int64_t max, int64_t *out)
{
    char *end;
    if (!json || json->kind != JSON_NUMBER)
        return false;
    errno = 0;
    const long long value = strtoll(json->text, &end, 10);
    if (*end || errno != 0 || value < min || value > max)
        return false;
    *out = value;
    return true;
}

bool json_to_int(const struct json *json, int *out)
{
    int64_t value;
    if (!json_to_integer(json, INT_MIN, INT_MAX, &value))
        return false;
    *out = (int)value;
    return true;
}

const char *json_to_text(const struct json *json)
{
    return json && json->kind == JSON_TEXT ? json->text : NULL;
}
