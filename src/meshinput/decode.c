/* Recognises the format of a mesh file. */
#include "meshinput/decode.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "text/json.h"

enum mesh_format { MESH_OBJ, MESH_PLY, MESH_STL, MESH_OFF, MESH_GLTF, MESH_GLB };

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
static bool is_stl(const struct mesh_file *f)
{
    char head[1025] = "";
    uint32_t count = 0;
    memcpy(head, f->bytes, f->n < 1024 ? f->n : 1024);
    for (int i = 0; i < 4 && f->n >= 84; i++)
        count |= (uint32_t)(unsigned char)head[80 + i] << (8 * i);
    if (f->n >= 84 && f->n == 84 + 50 * (size_t)count && count > 0)
        return true;
    return ends_in(f->path, ".stl") ||
           (f->n > 6 && strncasecmp(head, "solid", 5) == 0 && strcasestr(head, "facet"));
}

static enum mesh_format format_of(const struct mesh_file *f)
{
    const char *at = f->bytes;
    if (f->n >= 3 && memcmp(at, "\xef\xbb\xbf", 3) == 0)
        at += 3;
    while (isspace((unsigned char)*at))
        at++;
    if (f->n >= 4 && memcmp(f->bytes, "glTF", 4) == 0)
        return MESH_GLB;
    if (f->n >= 4 && memcmp(f->bytes, "ply", 3) == 0 && (f->bytes[3] == '\n' || f->bytes[3] == '\r'))
        return MESH_PLY;
    if (*at == '{')
        return MESH_GLTF;
    if (is_stl(f))
        return MESH_STL;
    return strncmp(at, "OFF", 3) == 0 || ends_in(f->path, ".off") ? MESH_OFF : MESH_OBJ;
}

static status check_refused(const struct mesh_file *f)
{
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        if (f->n >= refused[i].n && memcmp(f->bytes, refused[i].bytes, refused[i].n) == 0)
            return fail(E_INPUT, "%s: this is %s", f->path, refused[i].what);
    return OK;
}

/* The JSON of a glTF file. False: there is none. */
static bool find_json(const struct mesh_file *f, bool is_binary, const char **json, size_t *n)
{
    const size_t before = is_binary ? 20 : strncmp(f->bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    if (f->n < before)
        return false;
    *json = f->bytes + before;
    *n = f->n - before;
    for (int i = 3; is_binary && i >= 0; i--)
        *n = (i == 3 ? 0 : *n << 8) | (unsigned char)f->bytes[12 + i];
    return *n <= f->n - before;
}

/* Files whose geometry is compressed must not be read without the extension that does it: their vertices would be missing or wrong. */
static status check_extensions(const struct mesh_file *f, bool is_binary)
{
    static const char *const unsupported[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                              "KHR_meshopt_compression", "KHR_mesh_quantization",
                                              "EXT_mesh_gpu_instancing"};
    status st = OK;
    const char *text;
    size_t n;
    struct json *root = NULL;
    if (!find_json(f, is_binary, &text, &n))
        return fail(E_INPUT, "%s: the GLB file is truncated", f->path);
    TRY(json_read(f->path, text, n, &root));
    const struct json *list = json_member(root, "extensionsRequired");
    for (const struct json *e = list && list->kind == JSON_ARRAY ? list->first : NULL; e; e = e->next)
        for (size_t i = 0; i < sizeof unsupported / sizeof *unsupported; i++)
            if (json_to_text(e) && strcmp(json_to_text(e), unsupported[i]) == 0) {
                st = fail(E_INPUT, "%s: it needs %s, which is not supported: export it without compression",
                          f->path, unsupported[i]);
                goto done;
            }
done:
    json_free(&root);
    return st;
}

static status check_attribute(const struct mesh_file *f, const struct attribute *a, const struct mesh *mesh)
{
    if (a->found && mesh->n_values != mesh->n_vertices)
        return fail(E_INPUT, "%s: only %zu of its %zu vertices have the attribute '%.70s'", f->path,
                    mesh->n_values, mesh->n_vertices, a->name);
    if (!*a->name || a->found)
        return OK;
    return fail(E_INPUT, "%s: its vertices have no attribute '%.70s': %s%s", f->path, a->name,
                *a->there ? "they have " : "they have none", a->there);
}

static status check_line_ends(const struct mesh_file *f, enum mesh_format format)
{
    if (format == MESH_STL || memchr(f->bytes, '\n', f->n) || !memchr(f->bytes, '\r', f->n))
        return OK;
    return fail(E_INPUT, "%s: its lines end in carriage returns without line feeds: convert them (mac2unix)",
                f->path);
}

status mesh_decode(const struct mesh_file *f, const char *attribute, gltf_function *gltf, struct mesh *mesh)
{
    static status (*const read[])(struct cursor *, struct mesh *) = {
        [MESH_OBJ] = obj_read, [MESH_PLY] = ply_read, [MESH_STL] = stl_read, [MESH_OFF] = off_read};
    status st = OK;
    struct attribute a = {.name = attribute};
    struct cursor r = {f->path, f->bytes, f->bytes, f->bytes + f->n, 1, &a};
    *mesh = (struct mesh){0};
    TRY(check_refused(f));
    if (f->n >= 3 && memcmp(f->bytes, "\xef\xbb\xbf", 3) == 0)
        r.at += 3; /* a byte order mark */
    const enum mesh_format format = format_of(f);
    if (format == MESH_GLTF || format == MESH_GLB) {
        TRY(check_extensions(f, format == MESH_GLB));
        TRY(gltf ? gltf(f, format == MESH_GLB, &a, mesh)
                 : fail(E_INPUT, "%s: this reader has no decoder of glTF", f->path));
        mesh->y_up = true;
    } else {
        TRY(check_line_ends(f, format));
        TRY(read[format](&r, mesh));
    }
    if (mesh->n_triangles == 0)
        st = fail(E_INPUT,
                  "%s: it has no faces: it is not an OBJ, PLY, STL, glTF, GLB or OFF mesh, or an empty one",
                  f->path);
    else
        st = check_attribute(f, &a, mesh);
done:
    if (st != OK)
        mesh_free(mesh);
    return st;
}
