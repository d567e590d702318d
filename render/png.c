#include "render/png.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"

enum { HEADER = 8 + 25, CHUNK = 12 };

static const char KEYWORD[] = "hoodoo";

bool png_whole(const void *bytes, size_t n)
{
    static const unsigned char begin[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n',
                                          0,    0,   0,   13,  'I',  'H',  'D',  'R'},
                               end[] = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
    return n >= HEADER + sizeof end && memcmp(bytes, begin, sizeof begin) == 0 &&
           memcmp((const char *)bytes + n - sizeof end, end, sizeof end) == 0;
}

static uint32_t crc(const unsigned char *bytes, size_t n)
{
    uint32_t c = 0xffffffff;
    for (size_t i = 0; i < n; i++) {
        c ^= bytes[i];
        for (int k = 0; k < 8; k++)
            c = c >> 1 ^ (c & 1 ? 0xedb88320 : 0);
    }
    return ~c;
}

static void put(unsigned char *at, uint32_t x)
{
    for (int k = 0; k < 4; k++)
        at[k] = (unsigned char)(x >> (24 - 8 * k));
}

static uint32_t get(const unsigned char *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* The chunks behind the header, without words and times; returns how many bytes. */
static size_t copy_chunks(unsigned char *to, const unsigned char *from, size_t n)
{
    static const char *const left_out[] = {"tEXt", "zTXt", "iTXt", "tIME"};
    size_t made = 0;
    for (size_t at = 0; n - at >= CHUNK;) {
        size_t size = (size_t)get(from + at) + CHUNK;
        bool keep = true;
        if (size > n - at) /* not ours to mend */
            size = n - at;
        for (size_t i = 0; i < sizeof left_out / sizeof *left_out; i++)
            keep = keep && memcmp(from + at + 4, left_out[i], 4) != 0;
        if (keep) {
            memcpy(to + made, from + at, size);
            made += size;
        }
        at += size;
    }
    return made;
}

status png_with_tag(const void *bytes, size_t n, const char *tag, void **out, size_t *n_out)
{
    unsigned char chunk[CHUNK + sizeof KEYWORD + PNG_TAG], *made = NULL;
    size_t length = strlen(tag), text = sizeof KEYWORD + (length < PNG_TAG ? length : PNG_TAG - 1);
    size_t k = text + CHUNK;
    put(chunk, (uint32_t)text);
    memcpy(chunk + 4, "tEXt", 4);
    memcpy(chunk + 8, KEYWORD, sizeof KEYWORD);
    memcpy(chunk + 8 + sizeof KEYWORD, tag, text - sizeof KEYWORD);
    put(chunk + 8 + text, crc(chunk + 4, 4 + text));
    status st = memory_alloc(n + k, 1, "a picture", &made);
    if (st != OK)
        return st;
    memcpy(made, bytes, HEADER);
    memcpy(made + HEADER, chunk, k);
    *n_out = HEADER + k + copy_chunks(made + HEADER + k, (const unsigned char *)bytes + HEADER, n - HEADER);
    *out = made;
    return OK;
}

void png_tag(const char *path, char out[PNG_TAG])
{
    unsigned char head[HEADER + 8 + sizeof KEYWORD];
    out[0] = '\0';
    FILE *file = fopen(path, "rb");
    if (!file)
        return;
    const unsigned char *at = head + HEADER;
    if (fread(head, sizeof head, 1, file) == 1 && memcmp(at + 4, "tEXt", 4) == 0 &&
        memcmp(at + 8, KEYWORD, sizeof KEYWORD) == 0) {
        size_t n = get(at);
        n = n > sizeof KEYWORD ? n - sizeof KEYWORD : 0;
        n = fread(out, 1, n < PNG_TAG ? n : PNG_TAG - 1, file);
        out[n] = '\0';
    }
    fclose(file);
}
