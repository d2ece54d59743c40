// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <assimp/DefaultIOSystem.h>
#include <assimp/scene.h>

#include <assimp/BaseImporter.h>
#include <assimp/Importer.hpp>
#include <memory>
#include <stdexcept>

#include "io/surface/polygon_mesh.h"

namespace bullet_fem
{
namespace
{

/// Lets Assimp open one file only: a surface needs no materials, and an untrusted file must not choose further files.
class OneFileSystem : public Assimp::DefaultIOSystem
{
public:
    explicit OneFileSystem(std::string path) : m_path(std::move(path)) {}
    bool Exists(const char* path) const override { return m_path == path && DefaultIOSystem::Exists(path); }
    Assimp::IOStream* Open(const char* path, const char* mode) override
    {
        return m_path == path ? DefaultIOSystem::Open(path, mode) : nullptr;
    }

private:
    std::string m_path;
};

/// Removes all importers but OBJ and STL: Assimp tries others by content when the extension's own importer fails.
void keepObjAndStl(Assimp::Importer& importer)
{
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;)
    {
        const std::string endings = importer.GetImporterInfo(i)->mFileExtensions;
        if (endings == "obj" || endings == "stl") continue;
        const std::unique_ptr<Assimp::BaseImporter> unwanted(importer.GetImporter(i));
        importer.UnregisterLoader(unwanted.get());
    }
}

}  // namespace

PolygonMesh readWithAssimp(const std::string& path)
{
    Assimp::Importer importer;
    keepObjAndStl(importer);
    importer.SetIOHandler(new OneFileSystem(path));  // the importer owns it

    // No post-processing: these formats have no transforms, and the steps assert on invalid files.
    const aiScene* scene = importer.ReadFile(path, 0);
    if (!scene) throw std::runtime_error(importer.GetErrorString());

    PolygonMesh mesh;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m)
    {
        const aiMesh& part = *scene->mMeshes[m];
        const auto offset = static_cast<unsigned>(mesh.m_positions.size());
        for (unsigned v = 0; v < part.mNumVertices; ++v)
        {
            mesh.m_positions.push_back({part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z});
            mesh.m_labels.push_back(static_cast<int>(m) + 1);
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f)
        {
            const aiFace& face = part.mFaces[f];
            for (unsigned c = 0; c < face.mNumIndices; ++c)
            {
                if (face.mIndices[c] >= part.mNumVertices)
                    throw std::runtime_error("face " + std::to_string(f) + " uses vertex " +
                                             std::to_string(face.mIndices[c]) + " of " +
                                             std::to_string(part.mNumVertices));
                mesh.m_corners.push_back(static_cast<int>(offset + face.mIndices[c]));
            }
            mesh.closeFace();
        }
    }
    return mesh;
}

}  // namespace bullet_fem
