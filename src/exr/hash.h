/* The hash of an EXR file's bytes, inside the file: a string attribute of fixed length in the first header.
 * Only ZIP chunks carry checksums of their own; headers and chunks that do not compress have none. */
#ifndef HOODOO_EXR_HASH_H
#define HOODOO_EXR_HASH_H

#include <stdbool.h>
#include <stddef.h>

#define EXR_HASH_NAME "hoodoo:fileHash"
#define EXR_HASH_NONE "0000000000000000"

/* Fills in the attribute's 16 digits, which are zeros so far. */
void exr_hash_set(char *bytes, size_t size);

/* False if hoodoo wrote this and the bytes are no longer what it wrote. May change `bytes`. */
bool exr_hash_holds(char *bytes, size_t size);

#endif
