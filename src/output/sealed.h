/* JSON files that contain their own hash, so that damage is detected: manifests, and the records of products.
 *
 * Writing   json_object(&t, NULL); ...; TRY(sealed_write(path, &t)): the caller leaves the outermost object open.
 * Reading   E_INPUT unless the file is complete and unchanged.
 */
#ifndef HOODOO_SEALED_H
#define HOODOO_SEALED_H

#include "text/json.h"
#include "text/text.h"

/* Adds the hash, closes the object and writes the file. Frees `t`, also on error. */
MUST_USE status sealed_write(const char *path, struct text *t);

/* `what` the file should be, for messages, such as "a frame's manifest". *out is freed with json_free(). */
MUST_USE status sealed_read(const char *path, const char *what, struct json **out);

/* Hashes are texts of 16 hex digits in these files. sealed_to_hash() returns false if `json` is not one. */
void sealed_add_hash(struct text *t, const char *key, uint64_t hash);
bool sealed_to_hash(const struct json *json, uint64_t *out);

/* Whether a path stays within a folder: relative, printable, without "." and ".." parts. */
bool sealed_is_inside(const char *path);

#endif
