/* JSON files that hold their own hash, so that damage to them shows: manifests, and the records of products.
 *
 * Writing   json_object(&t, NULL); ...; TRY(sealed_write(path, &t)): the outermost object is left open.
 * Reading   The file is whole and as it was written, or E_INPUT says what it is not.
 */
#ifndef HOODOO_SEALED_H
#define HOODOO_SEALED_H

#include "base/json.h"
#include "base/text.h"

/* Adds the hash, ends the object and writes the file. Frees `t`. */
MUST_USE status sealed_write(const char *path, struct text *t);

/* `what` it should be, for the sentence: "a frame's manifest". *out is freed with json_free(). */
MUST_USE status sealed_read(const char *path, const char *what, struct json **out);

/* Hashes are texts of 16 digits there. False unless `json` is one. */
void sealed_put_hash(struct text *t, const char *key, uint64_t hash);
bool sealed_to_hash(const struct json *json, uint64_t *out);

/* Is it a path within a folder: relative, without "." and "..", printable? */
bool sealed_is_inside(const char *path);

#endif
