/* A hash of an EXR file's bytes, stored inside the file as a string attribute of fixed length in the first header. It is needed because
 * only ZIP chunks have checksums; headers and chunks that do not compress have none. */
#ifndef HOODOO_EXR_HASH_H
#define HOODOO_EXR_HASH_H

#include <stdbool.h>
#include <stddef.h>

#define EXR_HASH_NAME "hoodoo:fileHash"
#define EXR_HASH_NONE "0000000000000000"

/* Computes the hash and stores it in the attribute, whose 16 digits must be zeros. */
void exr_hash_set(char *bytes, size_t size);

/* Returns false if hoodoo wrote the file and its bytes have changed since. May modify `bytes`. */
bool exr_hash_holds(char *bytes, size_t size);

#endif
