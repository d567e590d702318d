/* Content hashes: XXH3-64, as stored in manifests and checkpoints. */
#ifndef HOODOO_HASH_H
#define HOODOO_HASH_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

uint64_t hash_bytes(const void *bytes, size_t n);

/* The hash of a file's content, and the file's size in bytes. E_INPUT if it cannot be read. */
MUST_USE status hash_file(const char *path, uint64_t *hash, uint64_t *size);

/* 16 lower-case hex digits in `out`; returns out. */
const char *hash_text(uint64_t hash, char out[17]);

#endif
