/* Validation of UTF-8. */
#ifndef HOODOO_UTF8_H
#define HOODOO_UTF8_H

#include <stddef.h>
#include <stdint.h>

/* The length in bytes of the character at `text`, of which n >= 1 bytes are readable; 0 if it is invalid: a stray or missing
 * continuation byte, an overlong form, a surrogate, or beyond U+10FFFF. Reading stops at a NUL. */
static inline size_t utf8_length(const void *text, size_t n)
{
    const unsigned char *s = (const unsigned char *)text;
    uint32_t c = s[0];
    const size_t length = c < 0x80 ? 1 : c < 0xc2 ? 0 : c < 0xe0 ? 2 : c < 0xf0 ? 3 : c < 0xf5 ? 4 : 0;
    if (length <= 1 || length > n)
        return length <= 1 ? length : 0;
    c &= 0x7fU >> length;
    for (size_t i = 1; i < length; i++) {
        if ((s[i] & 0xc0) != 0x80)
            return 0;
        c = c << 6 | (s[i] & 0x3fU);
    }
    const int overlong = (length == 3 && c < 0x800) || (length == 4 && c < 0x10000);
    return overlong || (c >= 0xd800 && c < 0xe000) || c > 0x10ffff ? 0 : length;
}

#endif
