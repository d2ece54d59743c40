// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

/// A ground whose highest point is at z = 0, above the origin.
struct GroundCase
{
    const char* m_name;
    btRigidBody& (*m_add)(SoftWorld& world);
    double m_sag;  // by how much a cube on it is lower than on a plane, at most [m]
};

btRigidBody& addStatic(SoftWorld& world, btCollisionShape* shape, const btTransform& transform)
{
    RigidSettings settings;
    settings.m_transform = transform;
    settings.m_friction = btScalar(0.8);
    return world.addRigid(shape, settings);
}

btTransform turned(const btVector3& axis, double angle, const btVector3& origin)
{
    return btTransform(btQuaternion(axis, btScalar(angle)), origin);
}

btRigidBody& addBox(SoftWorld& world)
{
    return addStatic(world, new btBoxShape(btVector3(2, 2, btScalar(0.5))), at(0, 0, btScalar(-0.5)));
}
btRigidBody& addTiltedBoxEdge(SoftWorld& world)  // a ridge of 90 degrees under the middle
{
    auto* compound = new btCompoundShape;
    const double s = 1 / std::sqrt(2.0);
    compound->addChildShape(turned(btVector3(0, 1, 0), SIMD_PI / 4, btVector3(btScalar(-0.3), 0, btScalar(-2 * s))),
                            world.keep(new btBoxShape(btVector3(1, 2, 1))));
    compound->addChildShape(turned(btVector3(0, 1, 0), SIMD_PI / 4, btVector3(btScalar(0.3), 0, btScalar(-2 * s))),
                            world.keep(new btBoxShape(btVector3(1, 2, 1))));
    return addStatic(world, compound, btTransform::getIdentity());
}
btRigidBody& addSphere(SoftWorld& world)
{
    return addStatic(world, new btSphereShape(3), at(0, 0, -3));
}
btRigidBody& addCapsule(SoftWorld& world)
{
    return addStatic(world, new btCapsuleShapeX(3, 4), at(0, 0, -3));
}
btRigidBody& addUprightCylinder(SoftWorld& world)
{
    return addStatic(world, new btCylinderShapeZ(btVector3(2, 2, 1)), at(0, 0, -1));
}
btRigidBody& addLyingCylinder(SoftWorld& world)
{
    return addStatic(world, new btCylinderShape(btVector3(3, 3, 3)), at(0, 0, -3));
}
btRigidBody& addConeUpsideDown(SoftWorld& world)
{
    auto* cone = new btConeShapeZ(2, 2);
    cone->setMargin(0);  // which Bullet adds to a cone's size
    return addStatic(world, cone, turned(btVector3(1, 0, 0), SIMD_PI, btVector3(0, 0, -1)));
}
btRigidBody& addBluntCone(SoftWorld& world)  // its apex presses into the middle of the lower face
{
    auto* cone = new btConeShapeZ(20, 1);
    cone->setMargin(0);
    return addStatic(world, cone, at(0, 0, btScalar(-0.5)));
}
btRigidBody& addHull(SoftWorld& world)  // a frustum, larger face up
{
    auto* hull = new btConvexHullShape;
    hull->setMargin(0);
    for (const btScalar sx : {-1, 1})
        for (const btScalar sy : {-1, 1})
        {
            hull->addPoint(btVector3(2 * sx, 2 * sy, 0));
            hull->addPoint(btVector3(sx, sy, -1));
        }
    return addStatic(world, hull, btTransform::getIdentity());
}
btRigidBody& addPlane(SoftWorld& world)
{
    return addStatic(world, new btStaticPlaneShape(btVector3(0, 0, 1), btScalar(0.5)), at(0, 0, btScalar(-0.5)));
}
btCompoundShape* twoPillars(SoftWorld& world)
{
    auto* compound = new btCompoundShape;
    for (const btScalar side : {-1, 1})
        compound->addChildShape(at(side * btScalar(0.4), 0, -1),
                                world.keep(new btBoxShape(btVector3(btScalar(0.3), 1, 1))));
    return compound;
}
btRigidBody& addCompound(SoftWorld& world)
{
    return addStatic(world, twoPillars(world), btTransform::getIdentity());
}
btRigidBody& addNestedCompound(SoftWorld& world)
{
    auto* outer = new btCompoundShape;
    outer->addChildShape(turned(btVector3(0, 0, 1), SIMD_PI / 2, btVector3(0, 0, 2)), world.keep(twoPillars(world)));
    return addStatic(world, outer, at(0, 0, -2));
}

btRigidBody& addMultiSphere(SoftWorld& world)  // a bar with round ends, wider in the middle
{
    const btVector3 centers[] = {btVector3(-2, 0, -2), btVector3(0, 0, -3), btVector3(2, 0, -2)};
    const btScalar radii[] = {2, 3, 2};
    return addStatic(world, new btMultiSphereShape(centers, radii, 3), btTransform::getIdentity());
}
btRigidBody& addHullWithMargin(SoftWorld& world)  // which Bullet adds to its size
{
    auto* hull = new btConvexHullShape;
    for (const btScalar sx : {-1, 1})
        for (const btScalar sy : {-1, 1})
            for (const btScalar sz : {-1, 1}) hull->addPoint(btVector3(sx, sy, sz));
    return addStatic(world, hull, at(0, 0, -1 - hull->getMargin()));
}

class RestOnShape : public testing::TestWithParam<GroundCase>
{
};

TEST_P(RestOnShape, IsCarriedToTheWeightAndNothingPasses)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btRigidBody& ground = GetParam().m_add(world);
    btSoftBody* made = btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.51)), btVector3(0.5, 0.5, 0.5),
                                               btScalar(0.25));
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e6);
    material.m_massDamping = 2;  // settles a cube that rocks
    fem.setMaterial(made, material);
    made->m_cfg.kDF = 1;
    btSoftBody& cube = world.addSoft(made);
    const double weight = massOf(cube) * kGravity;
    world.step(300);
    double largestError = 0, deepest = 0;
    for (int frame = 0; frame < 60; ++frame)
    {
        world.step();
        const Vec3 force = vec3(fem.contactForce(&cube, &ground));
        largestError = std::max(largestError, norm(force - Vec3{0, 0, weight}) / weight);
        deepest = std::max(deepest, double(fem.stepReport(&cube).m_deepestPenetration));
    }
    EXPECT_LT(largestError, 1e-3);
    EXPECT_GT(fem.stepReport(&cube).m_contacts, 0);
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
    EXPECT_LT(deepest, 1e-4);  // of its size, 1 m
    const Vec3 center = centerOf(cube);
    EXPECT_LT(std::hypot(center.x, center.y), 0.02);
    EXPECT_LT(center.z, 0.5);
    EXPECT_GT(center.z, 0.49 - GetParam().m_sag);  // the cube's own weight shortens it by 5 mm, its centre sinks by 3
}

INSTANTIATE_TEST_SUITE_P(Shapes, RestOnShape,
                         testing::Values(GroundCase{"box", addBox, 0}, GroundCase{"ridges", addTiltedBoxEdge, 0.06},
                                         GroundCase{"sphere", addSphere, 0.08}, GroundCase{"capsule", addCapsule, 0.06},
                                         GroundCase{"uprightCylinder", addUprightCylinder, 0},
                                         GroundCase{"lyingCylinder", addLyingCylinder, 0.06},
                                         GroundCase{"coneUpsideDown", addConeUpsideDown, 0},
                                         GroundCase{"bluntCone", addBluntCone, 0.06}, GroundCase{"hull", addHull, 0},
                                         GroundCase{"hullWithMargin", addHullWithMargin, 0},
                                         GroundCase{"multiSphere", addMultiSphere, 0.08},
                                         GroundCase{"plane", addPlane, 0}, GroundCase{"compound", addCompound, 0.02},
                                         GroundCase{"nestedCompound", addNestedCompound, 0.02}),
                         [](const auto& scene) { return scene.param.m_name; });

/// A shape of the user's own, of a type that only he knows.
class OwnShape : public btConcaveShape
{
public:
    OwnShape() { m_shapeType = CUSTOM_CONCAVE_SHAPE_TYPE; }
    void getAabb(const btTransform& transform, btVector3& low, btVector3& high) const override
    {
        low = transform.getOrigin() - btVector3(5, 5, 1);
        high = transform.getOrigin() + btVector3(5, 5, 0);
    }
    void processAllTriangles(btTriangleCallback*, const btVector3&, const btVector3&) const override {}
    void setLocalScaling(const btVector3&) override {}
    const btVector3& getLocalScaling() const override { return m_scaling; }
    void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
    const char* getName() const override { return "own"; }

private:
    btVector3 m_scaling{1, 1, 1};
};

TEST(UnknownShape, IsFlaggedAndNotTouched)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addRigid(new OwnShape);
    btSoftBody& cube = world.addSoft(btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.55)),
                                                             btVector3(0.5, 0.5, 0.5), btScalar(0.5)));
    int flags = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        flags |= fem.stepReport(&cube).m_flags;
        EXPECT_EQ(fem.contacts(&cube).size(), 0);
    }
    EXPECT_TRUE(flags & BT_FEM_UNKNOWN_SHAPE);
    EXPECT_TRUE(allFinite(cube));
}

}  // namespace
}  // namespace bullet_fem
