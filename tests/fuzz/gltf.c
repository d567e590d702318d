/* The JSON of a glTF file, from which the main program takes the names of buffers: none leads out of the folder. */
#include "fuzz/fuzz.h"

#include "gltf/gltf.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    struct gltf_buffers buffers;
    const char *path = fuzz_file("asset.gltf", bytes, n);
    const size_t folder = strlen(fuzz_folder());
    const status st = gltf_buffers(path, &buffers);
    fuzz_refused(st);
    for (size_t i = 0; st == OK && i < buffers.n; i++)
        if (strncmp(buffers.path[i], fuzz_folder(), folder) != 0 ||
            strchr(buffers.path[i] + folder + 1, '/') || strcmp(buffers.path[i] + folder + 1, "..") == 0)
            abort();
    gltf_buffers_free(&buffers);
    return 0;
}
