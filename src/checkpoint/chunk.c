#include "checkpoint/chunk.h"

#include <zstd.h>

/* Higher levels take more time from the next frame than their smaller files are worth. */
enum { LEVEL = 1 };

size_t chunk_raw_size(size_t item)
{
    return CHUNK_RAW / item * item;
}

size_t chunk_bound(size_t n_raw)
{
    return ZSTD_compressBound(n_raw);
}

static void shuffle(const unsigned char *raw, size_t n, size_t item, unsigned char *out)
{
    for (size_t b = 0; b < item; b++)
        for (size_t i = 0; i < n; i++)
            out[b * n + i] = raw[i * item + b];
}

static void unshuffle(const unsigned char *shuffled, size_t n, size_t item, unsigned char *raw)
{
    for (size_t b = 0; b < item; b++)
        for (size_t i = 0; i < n; i++)
            raw[i * item + b] = shuffled[b * n + i];
}

size_t chunk_pack(const void *raw, size_t n_raw, size_t item, void *scratch, void *out)
{
    shuffle(raw, n_raw / item, item, scratch);
    /* A new context for each chunk, so that the bytes do not depend on chunks packed before. */
    size_t size = ZSTD_compress(out, chunk_bound(n_raw), scratch, n_raw, LEVEL);
    return ZSTD_isError(size) ? 0 : size;
}

bool chunk_unpack(const void *packed, size_t n_packed, size_t item, void *scratch, void *raw, size_t n_raw)
{
    if (ZSTD_getFrameContentSize(packed, n_packed) != n_raw ||
        ZSTD_findFrameCompressedSize(packed, n_packed) != n_packed)
        return false;
    if (ZSTD_decompress(scratch, n_raw, packed, n_packed) != n_raw)
        return false;
    unshuffle(scratch, n_raw / item, item, raw);
    return true;
}
