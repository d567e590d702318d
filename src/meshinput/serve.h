/* hoodoo-read-mesh, which reads glTF with assimp (import_shim.cpp). reader/mesh_part.h has its answer. */
#ifndef HOODOO_MESHINPUT_SERVE_H
#define HOODOO_MESHINPUT_SERVE_H

#include <stddef.h>
#include <stdint.h>

#include "reader/mesh_part.h"
#include "reader/serve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decodes bytes[n] as `format`, "gltf" or "glb", and writes the answer. E_INPUT: damaged. E_MEMORY. */
MUST_USE status mesh_import(const char *path, const char *format, const void *bytes, size_t n,
                            struct serve_answer *answer);

/* The main() of hoodoo-read-mesh. */
int mesh_serve_main(int argc, char **argv);

#ifdef __cplusplus
}
#endif
#endif
