#include "text/json_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* Reads 'u' and four hex digits at *at. */
static bool read_hex(const char **at, const char *end, unsigned *out)
{
    char digits[5] = {0};
    if (end - *at < 5 || **at != 'u')
        return false;
    memcpy(digits, *at + 1, 4);
    if (strspn(digits, "0123456789abcdefABCDEF") != 4)
        return false;
    *out = (unsigned)strtoul(digits, NULL, 16);
    *at += 5;
    return true;
}

static char *put_utf8(char *to, unsigned c)
{
    if (c < 0x80) {
        *to++ = (char)c;
        return to;
    }
    const int tail = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    *to++ = (char)((0xf0U << (3 - tail) & 0xff) | c >> 6 * tail);
    for (int i = tail - 1; i >= 0; i--)
        *to++ = (char)(0x80 | (c >> 6 * i & 0x3f));
    return to;
}

/* Decodes one escape; *at points behind the backslash. */
static const char *read_escape(const char **at, const char *end, char **to)
{
    static const char from[] = "\"\\/bfnrt", as[] = "\"\\/\b\f\n\r\t";
    unsigned c, low;
    const char *known = *at < end && **at ? strchr(from, **at) : NULL;
    if (known) {
        *(*to)++ = as[known - from];
        ++*at;
        return NULL;
    }
    if (!read_hex(at, end, &c))
        return "unknown escape";
    if (c >= 0xd800 && c < 0xdc00) {
        if (*at == end || *(*at)++ != '\\' || !read_hex(at, end, &low) || low < 0xdc00 || low > 0xdfff)
            return "unpaired surrogate in a text";
        c = 0x10000 + ((c & 0x3ff) << 10 | (low & 0x3ff));
    } else if (c == 0 || (c >= 0xdc00 && c < 0xe000)) {
        return "unpaired surrogate or NUL in a text";
    }
    *to = put_utf8(*to, c);
    return NULL;
}

const char *json_unescape(const char **at, const char *end, char *to)
{
    const char *bad = NULL;
    while (*at < end && !bad) {
        if ((unsigned char)**at < 0x20)
            return "control character in a text";
        if (**at == '\\') {
            ++*at;
            bad = read_escape(at, end, &to);
        } else {
            *to++ = *(*at)++;
        }
    }
    *to = '\0';
    return bad;
}
