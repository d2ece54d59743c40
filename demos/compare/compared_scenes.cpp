// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/compare/compared_scenes.h"

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/io/surface_file.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"

namespace bullet_fem
{
namespace
{

/// A large flat box: Bullet's clusters and distance fields do not support planes.
void addGround(ComparedSide& side)
{
    side.addRigid(new btBoxShape(at(10, 0.5, 10)), 0, btTransform(btQuaternion::getIdentity(), at(0, -0.5, 0)), 1);
}

btRigidBody& addBox(ComparedSide& side, const btVector3& halfExtents, double mass, const btVector3& place)
{
    return side.addRigid(new btBoxShape(halfExtents), mass, btTransform(btQuaternion::getIdentity(), place), 0.6);
}

ComparedBodies buildCrate(ComparedSide& side, const SurfaceMesh& surface, const CrateSettings& settings)
{
    addGround(side);
    CageSettings cage;
    cage.m_targetTets = settings.m_tets;
    cage.m_snap = 1;  // moves the nodes onto the surface, so that the visible surface is the one in contact
    btFemMaterial rubber;
    rubber.m_youngModulus = btScalar(settings.m_young);
    rubber.m_poissonRatio = btScalar(0.4);
    rubber.m_stiffnessDamping = btScalar(0.01);
    btSoftBody* body = btFemHelpers::createFromSurface(side.world().getWorldInfo(), surface, cage);
    body->translate(at(0, 0.02 - lowestOf(*body).y(), 0));
    btFemHelpers::updateEmbeddedSurface(body);
    const double top = highestOf(*body).y();

    ComparedBodies bodies;
    bodies.m_soft.push_back(&side.addSoft(body, rubber, 0.5));
    bodies.m_rigid.push_back(&addBox(side, at(0.2, 0.2, 0.2), settings.m_crateMass, at(0, top + 0.2 + 0.4, 0)));
    return bodies;
}

ComparedBodies buildStack(ComparedSide& side, double young, int cells)
{
    constexpr std::size_t kFloors = 3;
    constexpr double kEdge = 0.5, kCushion = 0.25, kBoard = 0.12, kBoardMass = 4;  // [m], [kg]
    addGround(side);
    btFemMaterial jelly;
    jelly.m_youngModulus = btScalar(young);
    jelly.m_poissonRatio = btScalar(0.45);
    jelly.m_density = 300;
    jelly.m_stiffnessDamping = btScalar(0.02);
    ComparedBodies bodies;
    for (double y = 0; bodies.m_soft.size() < kFloors; y += kCushion + kBoard)
    {
        btSoftBody* cushion = btFemHelpers::createBox(side.world().getWorldInfo(), at(0, y + kCushion / 2, 0),
                                                      at(kEdge / 2, kCushion / 2, kEdge / 2), btScalar(kEdge / cells));
        bodies.m_soft.push_back(&side.addSoft(cushion, jelly, 0.7));
        bodies.m_rigid.push_back(
            &addBox(side, at(kEdge / 2, kBoard / 2, kEdge / 2), kBoardMass, at(0, y + kCushion + kBoard / 2, 0)));
    }
    bodies.m_top = bodies.m_rigid.back();
    bodies.m_rigid.push_back(&addBox(side, at(0.13, 0.13, 0.13), 3, at(0.05, 1.53, 0.04)));
    return bodies;
}

}  // namespace

ComparedScene crateScene(const std::string& meshFile, const CrateSettings& settings)
{
    const SurfaceMesh surface = lyingDown(readSurfaceFile(meshFile), 1);
    return {"crate", 2.5, {1.1, 1.3, 2.7}, {0.1, 0.45, 0}, 0.6, 16, [=](ComparedSide& side) {
                return buildCrate(side, surface, settings);
            }};
}

ComparedScene stackScene(double young, int cells)
{
    return {"stack",
            3,
            {1.4, 1.3, 3.2},
            {0, 0.65, 0},
            0.6,
            0,
            [=](ComparedSide& side) { return buildStack(side, young, cells); }};
}

}  // namespace bullet_fem
