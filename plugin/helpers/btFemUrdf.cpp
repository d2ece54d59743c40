// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <memory>
#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "bullet_fem/io/urdf_deformable.h"
#include "fem/common/attempt.h"

using namespace bullet_fem;

namespace
{

// As in Bullet's importer, every vertex is embedded in the element that contains it or is nearest to it.
void drawAs(btSoftBody& body, const SurfaceMesh& surface)
{
    body.m_renderNodes.resize(static_cast<int>(surface.m_vertices.size()));
    for (int v = 0; v < body.m_renderNodes.size(); ++v)
        body.m_renderNodes[v] = {bulletVector(surface.m_vertices[v]), btVector3(0, 0, 0), btVector3(0, 0, 0)};
    for (const Triangle& t : surface.m_triangles)
    {
        btSoftBody::RenderFace face;
        for (int a = 0; a < 3; ++a) face.m_n[a] = &body.m_renderNodes[t[a]];
        body.m_renderFaces.push_back(face);
    }
    btSoftBodyHelpers::interpolateBarycentricWeights(&body);
}

void takeMaterial(const UrdfDeformable& urdf, btFemMaterial& material)
{
    btFemMaterial taken = material;
    taken.m_density = 0;
    if (urdf.m_elastic)
    {
        taken.m_youngModulus = static_cast<btScalar>(urdf.m_moduli.youngModulus());
        taken.m_poissonRatio = static_cast<btScalar>(urdf.m_moduli.poissonRatio());
        taken.m_stiffnessDamping = static_cast<btScalar>(urdf.m_damping);
    }
    std::string why;
    if (!taken.valid(&why)) throw std::invalid_argument("createFromUrdf: " + why);
    material = taken;
}

}  // namespace

btSoftBody* btFemHelpers::createFromUrdf(btSoftBodyWorldInfo& worldInfo, const char* path, btFemMaterial& material,
                                         btScalar scale, std::string* why)
{
    const auto create = [&]
    {
        if (!path) throw std::invalid_argument("createFromUrdf: the path is null");
        const UrdfDeformable urdf = readUrdfDeformable(path);
        std::unique_ptr<btSoftBody> body(createFromTetMesh(worldInfo, readTetMeshFile(urdf.m_meshPath, scale).mesh()));
        if (!urdf.m_visualPath.empty()) drawAs(*body, readSurfaceFile(urdf.m_visualPath, scale));
        body->setTotalMass(static_cast<btScalar>(urdf.m_mass));
        body->getCollisionShape()->setMargin(static_cast<btScalar>(urdf.m_collisionMargin));
        body->m_cfg.kDF = static_cast<btScalar>(urdf.m_friction);
        body->setGravityFactor(static_cast<btScalar>(urdf.m_gravityFactor));
        takeMaterial(urdf, material);
        return body.release();
    };
    return attemptValue(why, create);
}
