/* A chunk: up to CHUNK_RAW bytes of a section, byte-shuffled by the item size, then compressed.
 *
 * The shuffle stores the first bytes of all items, then all second bytes, and so on. The exponents of neighbouring floats are similar,
 * so the compressed file becomes about a third smaller.
 */
#ifndef HOODOO_CHUNK_H
#define HOODOO_CHUNK_H

#include <stdbool.h>
#include <stddef.h>

enum { CHUNK_RAW = 4 << 20, CHUNK_ITEM_MAX = 1 << 16 };

/* Raw bytes of each chunk of a section but the last, which may be shorter; a whole number of items. */
size_t chunk_raw_size(size_t item);

/* The most bytes that chunk_pack() may write. */
size_t chunk_bound(size_t n_raw);

/* Packs n_raw bytes (whole items) into `out`, which holds chunk_bound() bytes. Returns the packed size, or 0 if out of memory.
 * `scratch` holds n_raw bytes. Equal input gives equal output in any thread. */
size_t chunk_pack(const void *raw, size_t n_raw, size_t item, void *scratch, void *out);

/* Returns false unless `packed` is exactly one chunk of n_raw raw bytes. */
bool chunk_unpack(const void *packed, size_t n_packed, size_t item, void *scratch, void *raw, size_t n_raw);

#endif
