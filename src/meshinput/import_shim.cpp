/* Decodes glTF with assimp. Linked into hoodoo-read-mesh only; other code calls mesh_read(). */
#include "meshinput/decode.h"

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

extern "C" {
#include "gltf/gltf.h"
}

namespace
{
/* The only files that assimp sees: the asset, by a name of our own, and its buffers, by theirs. */
class files final : public Assimp::IOSystem
{
  public:
    files(const struct mesh_file &f, const char *n) : file(f), name(n)
    {
    }
    bool Exists(const char *path) const override
    {
        return find(path).bytes != nullptr;
    }
    char getOsSeparator() const override
    {
        return '/';
    }
    Assimp::IOStream *Open(const char *path, const char *) override
    {
        const struct mesh_buffer found = find(path);
        return found.bytes
                   ? new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t *>(found.bytes), found.n)
                   : nullptr;
    }
    void Close(Assimp::IOStream *stream) override
    {
        delete stream;
    }

  private:
    const struct mesh_file &file;
    std::string name;

    struct mesh_buffer find(const char *path) const
    {
        const char *slash = std::strrchr(path, '/'), *last = slash ? slash + 1 : path;
        if (last == name)
            return {path, file.bytes, file.n};
        for (size_t i = 0; i < file.n_buffers; i++) {
            std::string decoded = file.buffer[i].uri;
            gltf_decode_uri(decoded.data());
            if (std::strcmp(last, file.buffer[i].uri) == 0 || std::strcmp(last, decoded.c_str()) == 0)
                return file.buffer[i];
        }
        return {};
    }
};

void check(status st)
{
    if (st == E_MEMORY)
        throw std::bad_alloc();
    if (st != OK)
        throw std::runtime_error(status_message());
}

struct collected {
    struct mesh *mesh;
    struct attribute *attribute;
};

/* The set and component of colours that is asked for: "red" of COLOR_0, "COLOR_1.red" of others. */
struct channel {
    unsigned set, component;
    bool found;
};

channel find_channel(const aiMesh &mesh, struct attribute *attribute)
{
    static const char *const component[4] = {"red", "green", "blue", "alpha"};
    channel c = {};
    for (unsigned s = 0; s < mesh.GetNumColorChannels(); s++)
        for (unsigned i = 0; i < 4; i++) {
            const std::string name = (s ? "COLOR_" + std::to_string(s) + "." : "") + component[i];
            if (attribute_is(attribute, name.c_str()))
                c = {s, i, true};
        }
    return c;
}

/* Adds the mesh's vertices, and its faces as triangles. */
void add_mesh(const aiMesh &mesh, const aiMatrix4x4 &place, collected *out)
{
    const size_t first = out->mesh->n_vertices;
    const channel c = find_channel(mesh, out->attribute);
    for (unsigned i = 0; i < mesh.mNumVertices; i++) {
        const aiVector3D &v = mesh.mVertices[i];
        const float *const row[3] = {place[0], place[1], place[2]};
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = double(row[a][0]) * double(v.x) + double(row[a][1]) * double(v.y) +
                   double(row[a][2]) * double(v.z) + double(row[a][3]);
        check(mesh_add_vertex(out->mesh, x));
        if (c.found)
            check(mesh_add_value(out->mesh, double(mesh.mColors[c.set][i][c.component])));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; f++) {
        const aiFace &face = mesh.mFaces[f];
        for (unsigned k = 2; k < face.mNumIndices; k++)
            check(mesh_add_triangle(out->mesh, uint32_t(first + face.mIndices[0]),
                                    uint32_t(first + face.mIndices[k - 1]),
                                    uint32_t(first + face.mIndices[k])));
    }
}

/* Adds the meshes that a node and its children refer to, transformed. */
void add_node(const aiScene &scene, const aiNode &node, const aiMatrix4x4 &above, collected *out)
{
    const aiMatrix4x4 place = above * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; i++)
        add_mesh(*scene.mMeshes[node.mMeshes[i]], place, out);
    for (unsigned i = 0; i < node.mNumChildren; i++)
        add_node(scene, *node.mChildren[i], place, out);
}
} // namespace

extern "C" status gltf_import(const struct mesh_file *file, bool is_binary, struct attribute *attribute,
                              struct mesh *mesh)
{
    const char *const format = is_binary ? "glb" : "gltf", *const name =
                                                               is_binary ? "asset.glb" : "asset.gltf";
    try {
        Assimp::Importer importer;
        importer.SetIOHandler(new files(*file, name));
        importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        const aiScene *scene = importer.ReadFile(name, aiProcess_Triangulate | aiProcess_SortByPType);
        if (!scene || !scene->mRootNode)
            return fail(E_INPUT, "%s: not readable as %s: %.300s", file->path, format,
                        importer.GetErrorString());
        collected all = {mesh, attribute};
        add_node(*scene, *scene->mRootNode, aiMatrix4x4(), &all);
        return OK;
    } catch (const std::bad_alloc &) {
        return fail(E_MEMORY, "%s: out of memory", file->path);
    } catch (const std::exception &e) {
        return fail(E_INPUT, "%s: not readable as %s: %.300s", file->path, format, e.what());
    } catch (...) {
        return fail(E_INPUT, "%s: not readable as %s", file->path, format);
    }
}
