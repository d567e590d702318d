/* A mesh in any of the formats that are read without a library, recognised by its content or its name: the first byte chooses the name, and
 * whether an attribute is read. */
#include "fuzz/fuzz.h"

#include "meshinput/decode.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    static const char *const names[] = {"m.obj", "m.ply", "m.stl", "m.off"};
    struct mesh mesh = {0};
    if (n == 0)
        return 0;
    char *text = malloc(n); /* all but the first byte, and a NUL */
    if (!text)
        abort();
    memcpy(text, bytes + 1, n - 1);
    text[n - 1] = '\0';
    const struct mesh_file file = {.path = names[bytes[0] & 3], .bytes = text, .n = n - 1};
    status st = mesh_decode(&file, bytes[0] & 4 ? "red" : "", NULL, &mesh);
    for (size_t t = 0; st == OK && t < 3 * mesh.n_triangles; t++)
        if (mesh.triangle[t / 3][t % 3] >= mesh.n_vertices)
            abort();
    if (st == OK)
        st = mesh_weld(&mesh);
    fuzz_refused(st);
    mesh_free(&mesh);
    free(text);
    return 0;
}
