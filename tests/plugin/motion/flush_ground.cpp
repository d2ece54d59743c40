// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/motion/flush_ground.h"

#include <array>
#include <cmath>

#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"

namespace bullet_fem
{
namespace
{

constexpr double kPiece = 0.5, kStart = -2, kEnd = 28;  // [m]
constexpr int kPieces = static_cast<int>((kEnd - kStart) / kPiece);
const btVector3 kHalf(btScalar(kPiece / 2), 2, btScalar(0.5));  // of a segment [m]

btVector3 corner(const btVector3& half, int k)
{
    return {k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(), k & 4 ? half.z() : -half.z()};
}

void addSquare(btTriangleMesh& mesh, const std::array<btVector3, 4>& c)
{
    mesh.addTriangle(c[0], c[1], c[2]);
    mesh.addTriangle(c[0], c[2], c[3]);
}

}  // namespace

std::string groundName(Ground ground)
{
    static const char* const names[] = {"oneBox",    "boxes",     "compound",    "hulls", "kinematicBoxes",
                                        "meshTiles", "meshBoxes", "heightfield", "mesh"};
    return names[static_cast<int>(ground)];
}

FlushGround::FlushGround(FemWorld& world, Ground ground, double edge, double down)
{
    if (ground == Ground::oneBox)
    {
        world.addRigid(new btBoxShape({btScalar((kEnd - kStart) / 2), 2, btScalar(0.5)}),
                       {0, at(btScalar((kStart + kEnd) / 2), 0, btScalar(-0.5))});
    }
    else if (ground == Ground::heightfield)
    {
        const int columns = kPieces + 1, rows = 9;
        m_heights.assign(columns * rows, 0);
        auto* field = new btHeightfieldTerrainShape(columns, rows, m_heights.data(), 1, -1, 1, 2, PHY_FLOAT, false);
        field->setLocalScaling({btScalar(kPiece), btScalar(kPiece), 1});
        world.addRigid(field, {0, at(btScalar((kStart + kEnd) / 2), 0, 0)});
    }
    else if (ground == Ground::mesh)
    {
        btTriangleMesh& mesh = newMesh();
        for (int i = 0; i < kPieces; ++i)
            for (int j = 0; j < 8; ++j)
            {
                const auto at = [&](int a, int b)
                { return btVector3(btScalar(kStart + kPiece * (i + a)), btScalar(-2 + kPiece * (j + b)), 0); };
                if ((i + j) % 2)
                    addSquare(mesh, {at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
                else
                    addSquare(mesh, {at(1, 0), at(1, 1), at(0, 1), at(0, 0)});
            }
        world.addRigid(new btBvhTriangleMeshShape(&mesh, true));
    }
    else
    {
        btCompoundShape* compound = ground == Ground::compound ? new btCompoundShape : nullptr;
        for (int i = 0; i < kPieces; ++i)
        {
            const double x = kStart + kPiece * (i + 0.5);
            const btVector3 center(btScalar(x), 0, btScalar(x > edge ? -0.5 - down : -0.5));
            if (compound)
                compound->addChildShape(btTransform(btQuaternion::getIdentity(), center),
                                        world.keep(new btBoxShape(kHalf)));
            else
                addPiece(world, ground, center);
        }
        if (compound) world.addRigid(compound);
    }
}

FlushGround::~FlushGround() = default;

void FlushGround::addPiece(FemWorld& world, Ground ground, const btVector3& center)
{
    const RigidSettings settings = {0, at(center.x(), center.y(), center.z())};
    if (ground == Ground::meshBoxes || ground == Ground::meshTiles)
    {
        btTriangleMesh& mesh = newMesh();
        const auto face = [&](int a, int b, int c, int d) {
            addSquare(mesh, {corner(kHalf, a), corner(kHalf, b), corner(kHalf, c), corner(kHalf, d)});
        };
        face(4, 5, 7, 6);
        if (ground == Ground::meshBoxes)
        {
            face(0, 1, 3, 2);
            face(0, 4, 5, 1);
            face(2, 3, 7, 6);
            face(0, 2, 6, 4);
            face(1, 5, 7, 3);
        }
        world.addRigid(new btBvhTriangleMeshShape(&mesh, true), settings);
        return;
    }
    if (ground == Ground::hulls)
    {
        auto* hull = new btConvexHullShape;
        for (int k = 0; k < 8; ++k) hull->addPoint(corner(kHalf, k));
        hull->setMargin(0);
        world.addRigid(hull, settings);
        return;
    }
    btRigidBody& box = world.addRigid(new btBoxShape(kHalf), settings);
    if (ground != Ground::kinematicBoxes) return;
    box.setCollisionFlags(box.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    box.setActivationState(DISABLE_DEACTIVATION);
}

btTriangleMesh& FlushGround::newMesh()
{
    m_meshes.push_back(std::make_unique<btTriangleMesh>());
    return *m_meshes.back();
}

}  // namespace bullet_fem
