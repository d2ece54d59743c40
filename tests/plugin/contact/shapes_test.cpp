// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "BulletCollision/CollisionShapes/btBox2dShape.h"
#include "BulletCollision/CollisionShapes/btConvex2dShape.h"
#include "BulletCollision/CollisionShapes/btUniformScalingShape.h"
#include "bridge/concave_test_shapes.h"
#include "bridge/sdf_test_shapes.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

/// A ground whose highest point is the origin.
struct GroundCase
{
    const char* m_name;
    btRigidBody& (*m_add)(SoftWorld& world);
    double m_sag;  // maximum additional sag of a cube compared with a plane [m]
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
btRigidBody& addTiltedBoxEdge(SoftWorld& world)  // a ridge of 90 degrees under the middle of the cube
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
    cone->setMargin(0);  // Bullet adds the margin to a cone's size
    return addStatic(world, cone, turned(btVector3(1, 0, 0), SIMD_PI, btVector3(0, 0, -1)));
}
btRigidBody& addBluntCone(SoftWorld& world)  // its apex presses into the middle of the lower face
{
    auto* cone = new btConeShapeZ(20, 1);
    cone->setMargin(0);
    return addStatic(world, cone, at(0, 0, btScalar(-0.5)));
}
btRigidBody& addHull(SoftWorld& world)  // a frustum, with the larger face upwards
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
btRigidBody& addHullWithMargin(SoftWorld& world)  // Bullet adds the margin to its size
{
    auto* hull = new btConvexHullShape;
    for (const btScalar sx : {-1, 1})
        for (const btScalar sy : {-1, 1})
            for (const btScalar sz : {-1, 1}) hull->addPoint(btVector3(sx, sy, sz));
    return addStatic(world, hull, at(0, 0, -1 - hull->getMargin()));
}

// Signed distance fields of a slab, and of a ball of 3 m, whose upper part lies in the domain.
btRigidBody& addSlabField(SoftWorld& world)
{
    return addStatic(world,
                     makeSdf({[](const Vec3& x) {
                                  return boxField(x, {1.5, 1.5, 0.5});
                              },
                              {2, 2, 1},
                              8}),
                     at(0, 0, btScalar(-0.5)));
}
btRigidBody& addBallField(SoftWorld& world)
{
    return addStatic(world,
                     makeSdf({[](const Vec3& x) {
                                  return norm(x - Vec3{0, 0, -2.5}) - 3;
                              },
                              {2, 2, 1},
                              8}),
                     at(0, 0, btScalar(-0.5)));
}
btRigidBody& addFieldInCompound(SoftWorld& world)
{
    auto* compound = new btCompoundShape;
    compound->addChildShape(turned(btVector3(1, 0, 0), SIMD_PI, btVector3(0, 0, -2)),
                            world.keep(makeSdf({[](const Vec3& x) {
                                                    return boxField(x, {1.5, 1.5, 0.5});
                                                },
                                                {2, 2, 1},
                                                8})));
    return addStatic(world, compound, at(0, 0, btScalar(1.5)));
}
btRigidBody& addFlatHull(SoftWorld& world)  // in the plane, with Bullet's margin about it
{
    auto* hull = static_cast<btConvexHullShape*>(world.keep(new btConvexHullShape));
    for (const btScalar sx : {-1, 1})
        for (const btScalar sy : {-1, 1}) hull->addPoint(btVector3(2 * sx, 2 * sy, 0));
    auto* flat = new btConvex2dShape(hull);
    return addStatic(world, flat, at(0, 0, -flat->getMargin()));
}
btRigidBody& addFlatBox(SoftWorld& world)
{
    auto* flat = new btBox2dShape(btVector3(2, 2, btScalar(0.04)));
    return addStatic(world, flat, at(0, 0, -btScalar(0.04)));
}
btRigidBody& addScaledBox(SoftWorld& world)
{
    auto* box = static_cast<btBoxShape*>(world.keep(new btBoxShape(btVector3(4, 4, 1))));
    return addStatic(world, new btUniformScalingShape(box, btScalar(0.5)), at(0, 0, btScalar(-0.5)));
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
    material.m_massDamping = 2;  // settles a rocking cube
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

INSTANTIATE_TEST_SUITE_P(
    Shapes, RestOnShape,
    testing::Values(GroundCase{"box", addBox, 0}, GroundCase{"ridges", addTiltedBoxEdge, 0.06},
                    GroundCase{"sphere", addSphere, 0.08}, GroundCase{"capsule", addCapsule, 0.06},
                    GroundCase{"uprightCylinder", addUprightCylinder, 0},
                    GroundCase{"lyingCylinder", addLyingCylinder, 0.06},
                    GroundCase{"coneUpsideDown", addConeUpsideDown, 0}, GroundCase{"bluntCone", addBluntCone, 0.06},
                    GroundCase{"hull", addHull, 0}, GroundCase{"hullWithMargin", addHullWithMargin, 0},
                    GroundCase{"multiSphere", addMultiSphere, 0.08}, GroundCase{"slabField", addSlabField, 0},
                    GroundCase{"ballField", addBallField, 0.08}, GroundCase{"fieldInCompound", addFieldInCompound, 0},
                    GroundCase{"flatHull", addFlatHull, 0}, GroundCase{"flatBox", addFlatBox, 0},
                    GroundCase{"scaledBox", addScaledBox, 0}, GroundCase{"plane", addPlane, 0},
                    GroundCase{"compound", addCompound, 0.02}, GroundCase{"nestedCompound", addNestedCompound, 0.02}),
    [](const auto& scene) { return scene.param.m_name; });

/// A rigid body of 8 kg that falls by a centimetre on a soft slab of 0.2 m with a fixed lower face.
struct MovingShape
{
    const char* m_name;
    btCollisionShape* (*m_make)(SoftWorld& world, btTriangleMesh& mesh);
    double m_height;  // of its origin above z = 0 at rest [m]
};

btCollisionShape* makeMovingField(SoftWorld&, btTriangleMesh&)
{
    return makeSdf({[](const Vec3& x) { return boxField(x, {0.2, 0.2, 0.15}); }, {0.25, 0.25, 0.25}, 10});
}

btCollisionShape* makeMovingSheet(SoftWorld&, btTriangleMesh& mesh)
{
    GridSettings grid;
    grid.m_cells = 2;
    grid.m_halfSize = btScalar(0.2);
    addGrid(mesh, grid);
    auto* sheet = new OwnSheet(mesh);
    sheet->setMargin(0);
    return sheet;
}

class MovingOnSoft : public testing::TestWithParam<MovingShape>
{
};

TEST_P(MovingOnSoft, IsCarriedAtItsHeight)
{
    btTriangleMesh mesh;
    btFemSoftBodySolver fem;
    SoftWorld world(fem, Coupling::coupled);
    SoftBox box;
    box.m_size = {0.8, 0.8, 0.2};
    box.m_cells = {8, 8, 2};
    box.m_center = {0, 0, -0.1};
    btSoftBody& slab = addSoftBox(world, fem, box);
    clampBelow(slab, -0.199);
    RigidSettings settings;
    settings.m_mass = 8;
    settings.m_transform = at(btScalar(0.01), btScalar(0.02), btScalar(GetParam().m_height + 0.01));
    btRigidBody& rigid = world.addRigid(GetParam().m_make(world, mesh), settings);
    rigid.setMassProps(
        8, btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)));  // Bullet takes no inertia of such shapes
    rigid.updateInertiaTensor();
    world.step(240);
    EXPECT_NEAR(fem.contactForce(&slab, &rigid).z(), -8 * kGravity, 1e-2 * 8 * kGravity);
    const double height = rigid.getWorldTransform().getOrigin().z() - GetParam().m_height;
    EXPECT_LT(height, 1e-4);
    EXPECT_GT(height, -2e-3);
    EXPECT_LT(rigid.getLinearVelocity().length(), 1e-3);
    EXPECT_EQ(fem.stepReport(&slab).m_flags & BT_FEM_UNKNOWN_SHAPE, 0);
}

INSTANTIATE_TEST_SUITE_P(Shapes, MovingOnSoft,
                         testing::Values(MovingShape{"field", makeMovingField, 0.15},
                                         MovingShape{"ownSheet", makeMovingSheet, 0}),
                         [](const auto& scene) { return scene.param.m_name; });

// Half a metre above a field, at 20 m/s.
TEST(FieldAtSpeed, StopsAFastBody)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addRigid(makeSdf({[](const Vec3& x) { return boxField(x, {1, 1, 0.1}); }, {1.5, 1.5, 0.3}, 10}));
    btSoftBody& cube = addSmallCube(world, btScalar(0.6));
    cube.setVelocity(btVector3(0, 0, -20));
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        EXPECT_GT(centerOf(cube).z, 0.1) << k;
    }
}

/// A user-defined shape without a recognised type.
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

TEST(UnknownShape, IsFlaggedAndMakesNoContact)
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
