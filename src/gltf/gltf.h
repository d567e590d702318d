/* The buffers of a glTF file (.gltf), which is JSON and may keep its numbers in other files beside it (glTF 2.0, 3.6.1.1). */
#ifndef HOODOO_GLTF_H
#define HOODOO_GLTF_H

#include <stddef.h>

#include "base/status.h"

enum { GLTF_BUFFERS = 12 };

struct gltf_buffers {
    size_t n;
    char *uri[GLTF_BUFFERS];  /* as written in the file */
    char *path[GLTF_BUFFERS]; /* in the folder of the file */
};

/* Finds the buffers that are in other files; none unless the content of `path` begins like JSON. Only names of files in the same folder
 * are accepted. E_INPUT: malformed JSON, an address, an absolute path or another folder, or more than GLTF_BUFFERS files; whether they
 * exist is not checked. E_MEMORY. Free *out with gltf_buffers_free(), also on error. */
MUST_USE status gltf_buffers(const char *path, struct gltf_buffers *out);
void gltf_buffers_free(struct gltf_buffers *buffers);

/* Decodes the percent-escapes of a URI in place; an escape that is malformed, or that stands for NUL, stays as it is. */
void gltf_decode_uri(char *uri);

#endif
