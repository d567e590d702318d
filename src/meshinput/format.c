/* Recognises the format of a mesh file, and reads meshes through the programs that decode them. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "meshinput/read.h"
#include "reader/mesh_part.h"
#include "reader/reader.h"

/* A format by its first bytes (magic number). */
struct magic {
    const char *bytes, *what;
    size_t n;
};

#define CONVERT "convert it to OBJ, PLY, STL, GLB or OFF"

/* Formats that are not supported, and the remedy. */
static const struct magic refused[] = {
    {"PXR-USDC", "a USD file: usdcat and usdview read it, and Blender's File > Import > USD: " CONVERT, 8},
    {"#usda", "a USD file: usdcat and usdview read it, and Blender's File > Import > USD: " CONVERT, 5},
    {"PK\3\4", "a zip archive (perhaps USDZ or 3MF): " CONVERT, 4},
    {"Ogawa", "an Alembic file: Blender's File > Import > Alembic reads it: " CONVERT, 5},
    {"\x89HDF", "an HDF5 file (perhaps an old Alembic file): " CONVERT, 4},
    {"Kaydara FBX", "an FBX file: Blender's File > Import > FBX reads it: " CONVERT, 11},
    {"; FBX", "an FBX file: Blender's File > Import > FBX reads it: " CONVERT, 5},
    {"BLENDER", "a Blender file: Blender's File > Export writes OBJ, PLY, STL and GLB", 7},
    {"<?xml", "an XML file (perhaps COLLADA or X3D): " CONVERT, 5},
    {" BDV\0\0\0\0", "an OpenVDB file: use the shape 'volume' for it", 8},
    {"\x76\x2f\x31\x01", "an image: use the shape 'heightfield' for it", 4},
    {"\x89PNG", "an image: use the shape 'heightfield' for it", 4},
};

static bool ends_in(const char *path, const char *ending)
{
    const size_t n = strlen(path), k = strlen(ending);
    return n >= k && strcasecmp(path + n - k, ending) == 0;
}

/* A binary STL's header is arbitrary and may start with "solid", but the file's size follows from its count of triangles. */
static bool is_stl(const char *path, const char *head, size_t n, uint64_t size)
{
    uint32_t count = 0;
    for (int i = 0; i < 4 && n >= 84; i++)
        count |= (uint32_t)(unsigned char)head[80 + i] << (8 * i);
    if (n >= 84 && size == 84 + 50 * (uint64_t)count && count > 0)
        return true;
    return ends_in(path, ".stl") ||
           (n > 6 && strncasecmp(head, "solid", 5) == 0 && strcasestr(head, "facet"));
}

static enum mesh_format format_of(const char *path, const char *head, size_t n, uint64_t size)
{
    const char *at = head;
    while (isspace((unsigned char)*at))
        at++;
    if (n >= 4 && memcmp(head, "glTF", 4) == 0)
        return MESH_GLB;
    if (n >= 4 && memcmp(head, "ply", 3) == 0 && (head[3] == '\n' || head[3] == '\r'))
        return MESH_PLY;
    if (*at == '{')
        return MESH_GLTF;
    if (is_stl(path, head, n, size))
        return MESH_STL;
    return strncmp(at, "OFF", 3) == 0 || ends_in(path, ".off") ? MESH_OFF : MESH_OBJ;
}

status mesh_format_of(const char *path, enum mesh_format *format)
{
    char head[1025] = "";
    *format = MESH_OBJ;
    FILE *f = fopen(path, "rb");
    if (!f)
        return OK; /* file_read() will report why */
    const size_t n = fread(head, 1, sizeof head - 1, f);
    const bool sized = fseeko(f, 0, SEEK_END) == 0;
    const uint64_t size = sized ? (uint64_t)ftello(f) : 0;
    fclose(f);
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        if (n >= refused[i].n && memcmp(head, refused[i].bytes, refused[i].n) == 0)
            return fail(E_INPUT, "%s: this is %s", path, refused[i].what);
    *format = format_of(path, head, n, size);
    return OK;
}

/* Are all coordinates finite and all indices in range? */
static bool is_valid(const struct mesh *mesh)
{
    for (size_t i = 0; i < mesh->n_vertices; i++)
        for (int a = 0; a < 3; a++)
            if (!(fabs(mesh->vertex[i][a]) <= 1e30))
                return false;
    for (size_t t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            if (mesh->triangle[t][k] >= mesh->n_vertices)
                return false;
    return true;
}

status mesh_read_by(const char *program, const char *kind, const char *path, const char *const *word,
                    struct mesh_part *part, struct mesh *mesh)
{
    status st = OK;
    struct reader_answer answer = {0};
    TRY(reader_ask(
        &(struct reader_question){.program = program, .kind = kind, .path = path, .argument = word},
        &answer));
    TRY(reader_take(&answer, part, sizeof *part));
    if (part->n_vertices > UINT32_MAX || part->n_triangles > UINT32_MAX / 2) {
        st = fail(E_INPUT, "%s: the mesh has more than 2^31 triangles or 2^32 vertices: reduce it", path);
        goto done;
    }
    TRY(reader_take_array(&answer, (size_t)part->n_vertices, sizeof *mesh->vertex, &mesh->vertex));
    TRY(reader_take_array(&answer, (size_t)part->n_triangles, sizeof *mesh->triangle, &mesh->triangle));
    mesh->n_vertices = (size_t)part->n_vertices;
    mesh->n_triangles = (size_t)part->n_triangles;
    part->grid[sizeof part->grid - 1] = '\0';
    if (!is_valid(mesh))
        st = fail(
            E_INPUT,
            "%s: damaged mesh: a coordinate is not finite, or a face refers to a vertex that does not exist",
            path);
done:
    reader_end(&answer);
    return st;
}
