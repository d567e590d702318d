/* Decodes glTF with assimp. Linked into hoodoo-read-mesh only; other code calls mesh_read(). */
#include "meshinput/serve.h"

#include <cmath>
#include <exception>
#include <new>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

namespace
{
struct collected {
    std::vector<double> vertex;
    std::vector<uint32_t> triangle;
};

/* Adds the mesh's faces as triangles. */
void add_mesh(const aiMesh &mesh, const aiMatrix4x4 &place, collected *out)
{
    const size_t first = out->vertex.size() / 3;
    if (first + mesh.mNumVertices > UINT32_MAX)
        throw std::bad_alloc();
    for (unsigned i = 0; i < mesh.mNumVertices; i++) {
        const aiVector3D &v = mesh.mVertices[i];
        const float *const row[3] = {place[0], place[1], place[2]};
        for (const float *r : row)
            out->vertex.push_back(double(r[0]) * double(v.x) + double(r[1]) * double(v.y) +
                                  double(r[2]) * double(v.z) + double(r[3]));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; f++) {
        const aiFace &face = mesh.mFaces[f];
        for (unsigned k = 2; k < face.mNumIndices; k++)
            for (const unsigned c : {0u, k - 1, k})
                out->triangle.push_back(uint32_t(first + face.mIndices[c]));
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

extern "C" status mesh_import(const char *path, const char *format, const void *bytes, size_t n,
                              struct serve_answer *answer)
{
    try {
        Assimp::Importer importer;
        importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        /* Read from memory, so that assimp opens no other file. */
        const aiScene *scene =
            importer.ReadFileFromMemory(bytes, n, aiProcess_Triangulate | aiProcess_SortByPType, format);
        if (!scene || !scene->mRootNode)
            return fail(E_INPUT, "%s: not readable as %s: %.300s%s", path, format, importer.GetErrorString(),
                        *format == 'g' ? " (buffers in other files are not supported: export it as .glb)"
                                       : "");
        collected all;
        add_node(*scene, *scene->mRootNode, aiMatrix4x4(), &all);
        struct mesh_part part = {};
        part.n_vertices = all.vertex.size() / 3;
        part.n_triangles = all.triangle.size() / 3;
        status st = serve_add_part(answer, &part, sizeof part);
        if (st == OK)
            st = serve_add_part(answer, all.vertex.data(), all.vertex.size() * sizeof(double));
        if (st == OK)
            st = serve_add_part(answer, all.triangle.data(), all.triangle.size() * sizeof(uint32_t));
        return st;
    } catch (const std::bad_alloc &) {
        return fail(E_MEMORY, "%s: out of memory", path);
    } catch (const std::exception &e) {
        return fail(E_INPUT, "%s: not readable as %s: %.300s", path, format, e.what());
    } catch (...) {
        return fail(E_INPUT, "%s: not readable as %s", path, format);
    }
}
