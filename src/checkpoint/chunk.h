/* A chunk: up to CHUNK_RAW bytes of a section, byte-shuffled by the item size, then compressed.
 *
 * The shuffle puts all first bytes of the items together, then all second bytes: the exponents of
 * neighbouring floats are alike, and zstd makes the file about a third smaller for it.
 */
#ifndef HOODOO_CHUNK_H
#define HOODOO_CHUNK_H

#include <stdbool.h>
#include <stddef.h>

enum { CHUNK_RAW = 4 << 20, CHUNK_ITEM_MAX = 1 << 16 };

/* Raw bytes of a section's chunks but the last, which may be smaller: whole items. */
size_t chunk_raw_size(size_t item);

/* The most chunk_pack() may write. */
size_t chunk_bound(size_t n_raw);

/* Packs n_raw bytes (whole items) into `out` (chunk_bound() bytes); returns the size, or 0 when memory is
 * out. `scratch` holds n_raw bytes. Equal input gives equal output, whichever thread does it. */
size_t chunk_pack(const void *raw, size_t n_raw, size_t item, void *scratch, void *out);

/* False unless `packed` is exactly one chunk of n_raw bytes. */
bool chunk_unpack(const void *packed, size_t n_packed, size_t item, void *scratch, void *raw, size_t n_raw);

#endif
