#include "image/spread.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { COLUMNS = 16 }; /* a cache line of floats */

/* Floats that spread_max() needs beside a line. */
static size_t spread_room(size_t n, size_t radius)
{
    return 2 * (n + 4 * radius + 1);
}

static float larger(float a, float b)
{
    return a > b ? a : b;
}

/* line[i] = the largest of line[i - radius .. i + radius], over n items: of blocks as long as that the maxima from their begins and
 * from their ends, of which every stretch needs two (van Herk, Gil and Werman). */
static void spread_max(float *line, size_t n, size_t radius, float *room)
{
    const size_t length = 2 * radius + 1, padded = (n + 2 * radius + length - 1) / length * length;
    float *from_begin = room, *from_end = room + padded;
    for (size_t i = 0; i < padded; i++)
        from_begin[i] = from_end[i] = i >= radius && i - radius < n ? line[i - radius] : -INFINITY;
    for (size_t block = 0; block < padded; block += length)
        for (size_t k = 1; k < length; k++) {
            const size_t back = block + length - 1 - k;
            from_begin[block + k] = larger(from_begin[block + k], from_begin[block + k - 1]);
            from_end[back] = larger(from_end[back], from_end[back + 1]);
        }
    for (size_t i = 0; i < n; i++)
        line[i] = larger(from_end[i], from_begin[i + 2 * radius]);
}

/* The same of columns, a cache line's at a time: `side` has COLUMNS * (height + COLUMNS) items, for columns that are a power of 2 apart
 * would meet in the cache. */
static void spread_columns(float *field, size_t width, size_t height, size_t radius, float *side, float *room)
{
    const size_t apart = height + COLUMNS;
    for (size_t x = 0; x < width; x += COLUMNS) {
        const size_t n = width - x < COLUMNS ? width - x : COLUMNS;
        for (size_t y = 0; y < height; y++)
            for (size_t k = 0; k < n; k++)
                side[k * apart + y] = field[y * width + x + k];
        for (size_t k = 0; k < n; k++)
            spread_max(side + k * apart, height, radius, room);
        for (size_t y = 0; y < height; y++)
            for (size_t k = 0; k < n; k++)
                field[y * width + x + k] = side[k * apart + y];
    }
}

status spread_largest(size_t width, size_t height, size_t rx, size_t ry, float *field)
{
    status st = OK;
    const size_t across = spread_room(width, rx), up = spread_room(height, ry);
    float *room = NULL, *side = NULL;
    TRY(memory_alloc(across > up ? across : up, sizeof *room, "a heightfield", &room));
    TRY(memory_alloc(COLUMNS * (height + COLUMNS), sizeof *side, "a heightfield", &side));
    for (size_t y = 0; y < height; y++)
        spread_max(field + y * width, width, rx, room);
    spread_columns(field, width, height, ry, side, room);
done:
    free(room);
    free(side);
    return st;
}
