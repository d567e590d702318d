#include "image/plain.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"

bool image_is_pgm(const char *path)
{
    char magic[2] = {0};
    FILE *f = fopen(path, "rb");
    if (!f)
        return false;
    const bool is = fread(magic, 1, 2, f) == 2 && magic[0] == 'P' && magic[1] == '5';
    fclose(f);
    return is;
}

/* The file has one part of one channel. */
static status check_choice(const struct image_decoding *m)
{
    const char *channel = m->argument[ASK_CHANNEL], *part = m->argument[ASK_PART];
    if (*channel && strcmp(channel, "0") != 0)
        return fail(E_USAGE, "%s: no channel '%.80s'; the file has one channel, 0", m->path, channel);
    if (*part && strcmp(part, "0") != 0)
        return fail(E_USAGE, "%s: no part '%.80s'; the file has one part, 0", m->path, part);
    return OK;
}

/* Decodes rows of numbers of 1 or 2 bytes (unsigned integers) or 4 (floats). */
static status read_rows(struct image_decoding *m, FILE *f, size_t bytes, bool big_endian)
{
    status st = OK;
    unsigned char *row = NULL;
    double *value = NULL;
    TRY(check_choice(m));
    TRY(image_begin(m));
    TRY(memory_alloc(m->width * bytes, 1, "a row of an image", &row));
    TRY(memory_alloc(m->width, sizeof *value, "a row of an image", &value));
    for (size_t y = 0; y < m->height; y++) {
        if (fread(row, bytes, m->width, f) != m->width) {
            st = fail(E_INPUT, "%s: damaged image: its pixel data is truncated in row %zu of %llu", m->path,
                      y, (unsigned long long)m->height);
            goto done;
        }
        for (size_t x = 0; x < m->width; x++) {
            uint32_t bits = 0;
            float real;
            for (size_t b = 0; b < bytes; b++)
                bits |= (uint32_t)row[x * bytes + b] << 8 * (big_endian ? bytes - 1 - b : b);
            memcpy(&real, &bits, sizeof real);
            value[x] = bytes == 4 ? (double)real : bits;
        }
        image_row(m, 0, (int64_t)y, m->width, value, NULL, NULL);
    }
done:
    free(row);
    free(value);
    return st;
}

/* A number of a PGM's header: skips spaces and comments before it, and reads the byte after it. */
static bool header_number(FILE *f, uint64_t *out)
{
    int c = fgetc(f);
    for (bool comment = false; comment || c == ' ' || (c >= '\t' && c <= '\r') || c == '#'; c = fgetc(f)) {
        comment = c == '#' || (comment && c != '\n');
        if (c == EOF)
            return false;
    }
    *out = 0;
    if (c < '0' || c > '9')
        return false;
    for (; c >= '0' && c <= '9' && *out < 1000000000; c = fgetc(f))
        *out = *out * 10 + (uint64_t)(c - '0');
    return c != EOF;
}

status image_decode_pgm(struct image_decoding *m)
{
    status st = OK;
    uint64_t white;
    FILE *f = fopen(m->open_path, "rb");
    if (!f)
        return fail(E_INPUT, "%s: %s", m->path, strerror(errno));
    if (fseek(f, 2, SEEK_SET) != 0 || !header_number(f, &m->width) || !header_number(f, &m->height) ||
        !header_number(f, &white) || white < 1 || white > 65535) {
        st = fail(E_INPUT, "%s: not a readable image: a PGM with a damaged header", m->path);
        goto done;
    }
    m->is_integer = true;
    m->white = (double)white;
    m->hints.mask = -1;
    TRY(read_rows(m, f, white > 255 ? 2 : 1, true));
done:
    fclose(f);
    return st;
}

status image_decode_raw(struct image_decoding *m)
{
    status st = OK;
    struct stat info;
    const bool floats = strcmp(m->argument[ASK_FORM], "r32") == 0;
    const uint64_t bytes = floats ? 4 : 2;
    FILE *f = fopen(m->open_path, "rb");
    if (!f || fstat(fileno(f), &info) != 0) {
        st = fail(E_INPUT, "%s: %s", m->path, strerror(errno));
        goto done;
    }
    const uint64_t size = (uint64_t)info.st_size, n = size / bytes, side = (uint64_t)llround(sqrt((double)n));
    m->width = strtoull(m->argument[ASK_WIDTH], NULL, 10);
    m->height = strtoull(m->argument[ASK_HEIGHT], NULL, 10);
    m->hints.mask = -1;
    m->is_integer = !floats;
    m->white = floats ? 0 : 65535;
    if (m->width == 0 && m->height == 0 && side > 0 && side * side * bytes == size)
        m->width = m->height = side;
    else if (m->width == 0 || m->height == 0)
        st = fail(
            E_USAGE,
            "%s: %llu bytes do not make a square of raw values of %llu bytes: set size_px: [width, height]",
            m->path, (unsigned long long)size, (unsigned long long)bytes);
    else if (m->width * m->height * bytes != size)
        st = fail(
            E_USAGE,
            "%s: size_px %llu x %llu with raw values of %llu bytes makes %llu bytes, but the file has %llu",
            m->path, (unsigned long long)m->width, (unsigned long long)m->height, (unsigned long long)bytes,
            (unsigned long long)(m->width * m->height * bytes), (unsigned long long)size);
    TRY(st);
    TRY(read_rows(m, f, bytes, false));
done:
    if (f)
        fclose(f);
    return st;
}
