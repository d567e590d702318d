#include "output/sealed.h"

#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "system/atomic_file.h"

/* The last member is the hash of all bytes before it. */
static const char SELF[] = "\n  \"self_xxh3\": \"", END[] = "\"\n}\n";
enum { HASH_DIGITS = 16, LARGEST = 16 << 20 };

void sealed_add_hash(struct text *t, const char *key, uint64_t hash)
{
    char text[17];
    json_text(t, key, hash_text(hash, text));
}

bool sealed_to_hash(const struct json *json, uint64_t *out)
{
    const char *text = json_to_text(json);
    if (!text || strlen(text) != HASH_DIGITS || strspn(text, "0123456789abcdef") != HASH_DIGITS)
        return false;
    *out = strtoull(text, NULL, 16);
    return true;
}

bool sealed_is_inside(const char *path)
{
    if (*path == '/' || *path == '\0')
        return false;
    for (const char *part = path; part; part = strchr(part, '/') ? strchr(part, '/') + 1 : NULL) {
        const size_t n = strcspn(part, "/");
        if (n == 0 || (n == 1 && part[0] == '.') || (n == 2 && part[0] == '.' && part[1] == '.'))
            return false;
    }
    for (const char *c = path; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f || *c == '\\')
            return false;
    return true;
}

status sealed_write(const char *path, struct text *t)
{
    status st = OK;
    TRY(text_status(t));
    sealed_add_hash(t, "self_xxh3", hash_bytes(t->data, t->size));
    json_end_object(t);
    TRY(text_status(t));
    TRY(atomic_file_write(path, t->data, t->size));
done:
    text_free(t);
    return st;
}

static status check_self(const char *path, const char *what, const char *bytes, size_t size)
{
    char text[17];
    const char *self = memmem(bytes, size, SELF, sizeof SELF - 1);
    /* The comma before SELF is not hashed. The digits must be followed by END and nothing else. */
    if (!self || self == bytes ||
        size - (size_t)(self - bytes) != sizeof SELF - 1 + HASH_DIGITS + sizeof END - 1 ||
        memcmp(self + sizeof SELF - 1, hash_text(hash_bytes(bytes, (size_t)(self - bytes) - 1), text),
               HASH_DIGITS) != 0 ||
        memcmp(bytes + size - (sizeof END - 1), END, sizeof END - 1) != 0)
        return fail(E_INPUT, "%s: damaged, or not %s: its own hash does not match", path, what);
    return OK;
}

status sealed_read(const char *path, const char *what, struct json **out)
{
    status st = OK;
    char *bytes = NULL;
    size_t size = 0;
    struct json *json = NULL;
    TRY(file_read(path, LARGEST, &bytes, &size));
    TRY(json_read(path, bytes, size, &json));
    TRY(check_self(path, what, bytes, size));
    *out = json;
    json = NULL;
done:
    if (json)
        json_free(&json);
    free(bytes);
    return st;
}
