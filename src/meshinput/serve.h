/* hoodoo-read-mesh: how glTF is read (import_shim.cpp); what it answers is in reader/mesh_part.h. */
#ifndef HOODOO_MESHINPUT_SERVE_H
#define HOODOO_MESHINPUT_SERVE_H

#include <stddef.h>
#include <stdint.h>

#include "reader/mesh_part.h"
#include "reader/serve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads `bytes` as one of "gltf" or "glb" and answers. E_INPUT: damaged. */
MUST_USE status mesh_import(const char *path, const char *format, const void *bytes, size_t n,
                            struct serve_answer *answer);

/* The main() of hoodoo-read-mesh. */
int mesh_serve_main(int argc, char **argv);

#ifdef __cplusplus
}
#endif
#endif
