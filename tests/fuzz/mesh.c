/* A mesh in any of the formats that are read without a library, told by its content or its name: the first byte chooses the name. */
#include "fuzz/fuzz.h"

#include "meshinput/mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    static const char *const names[] = {"m.obj", "m.ply", "m.stl", "m.off"};
    struct mesh mesh = {0};
    if (n == 0)
        return 0;
    const char *path = fuzz_file(names[bytes[0] & 3], bytes + 1, n - 1);
    status st = mesh_read(path, &mesh);
    if (st == OK)
        st = mesh_weld(&mesh);
    fuzz_refused(st);
    mesh_free(&mesh);
    return 0;
}
