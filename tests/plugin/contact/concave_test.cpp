// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bridge/concave_test_shapes.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kSize = 1;  // edge of the cube [m]

/// A world that owns the data of concave shapes.
class ConcaveWorld
{
public:
    explicit ConcaveWorld(const btFemSolverInfo& info = {}) : m_fem(info), m_world(m_fem) {}

    btRigidBody& addGround(ConcaveShape ground, const RigidSettings& settings = {})
    {
        m_shapes.push_back(std::move(ground));
        std::vector<std::unique_ptr<btCollisionShape>>& parts = m_shapes.back().m_parts;
        btCollisionShape* shape = parts.back().release();
        parts.pop_back();
        return m_world.addRigid(shape, settings);
    }
    btSoftBody& addCube(const btVector3& center)
    {
        btSoftBody* cube = btFemHelpers::createBox(m_world.info(), center, btVector3(0.5, 0.5, 0.5), btScalar(0.25));
        m_fem.setMaterial(cube, btFemMaterial());
        return m_world.addSoft(cube);
    }

    std::vector<ConcaveShape> m_shapes;  // must outlive the world
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
};

/// A cube of cells mapped to a ball of radius 0.5 m.
TetMesh makeBall(const Vec3& center)
{
    const TetMesh cube = makeBox({1, 1, 1}, {5, 5, 5}, {-0.5, -0.5, -0.5});
    std::vector<Vec3> positions;
    for (const Vec3& X : cube.restPositions())
    {
        const double length = norm(X), shell = std::max({std::abs(X.x), std::abs(X.y), std::abs(X.z)});
        positions.push_back(center + (length > 0 ? shell / length : 1) * X);
    }
    return TetMesh(std::move(positions), cube.tets());
}

class RestOnSheet : public testing::TestWithParam<NamedConcave>
{
protected:
    // Shifted by the height of its origin; upside down it has the opposite winding.
    static btRigidBody& addSheet(ConcaveWorld& scene, const GridSettings& grid = {}, bool upsideDown = false)
    {
        RigidSettings place;
        place.m_transform = btTransform(btQuaternion(btVector3(1, 0, 0), upsideDown ? SIMD_PI : 0),
                                        btVector3(0, 0, upsideDown ? GetParam().m_height : -GetParam().m_height));
        return scene.addGround(GetParam().m_make(grid), place);
    }
};

TEST_P(RestOnSheet, IsCarriedToItsWeightAndDoesNotSinkIn)
{
    ConcaveWorld scene;
    btRigidBody& ground = addSheet(scene);
    btSoftBody& cube = scene.addCube({btScalar(0.03), btScalar(0.02), btScalar(0.51)});
    const double weight = massOf(cube) * kGravity;
    scene.m_world.step(240);
    for (int frame = 0; frame < 60; ++frame)
    {
        scene.m_world.step();
        const Vec3 balance = (1 / double(kStep)) * impulseOn(scene.m_fem, cube) + Vec3{0, 0, -weight};
        EXPECT_LT(norm(balance), 1e-3 * weight) << "frame " << frame;
        EXPECT_LT(norm(vec3(scene.m_fem.contactForce(&cube, &ground)) - Vec3{0, 0, weight}), 1e-3 * weight);
        EXPECT_GT(lowestHeight(cube), -1e-4 * kSize);
        EXPECT_LT(lowestHeight(cube), 1e-4 * kSize);  // nor does it hover
        EXPECT_LT(scene.m_fem.stepReport(&cube).m_deepestPenetration, 1e-4 * kSize);
    }
    EXPECT_EQ(scene.m_fem.stepReport(&cube).m_contacts, 25);
    EXPECT_EQ(scene.m_fem.stepReport(&cube).m_flags, 0);
}

/// Ridges, corners and slopes are in contact with the cube.
TEST_P(RestOnSheet, IsCarriedByHillsAndValleys)
{
    ConcaveWorld scene;
    GridSettings hills;
    hills.m_cells = 16;
    hills.m_height = [](btScalar x, btScalar y)
    { return btScalar(0.15) * (btCos(4 * x) * btCos(4 * y) + btScalar(0.5) * (x * x + y * y)); };
    addSheet(scene, hills);
    btSoftBody& cube = scene.addCube({btScalar(0.03), btScalar(0.02), btScalar(0.7)});
    const double weight = massOf(cube) * kGravity;
    scene.m_world.step(480);
    for (int frame = 0; frame < 60; ++frame)
    {
        scene.m_world.step();
        const Vec3 balance = (1 / double(kStep)) * impulseOn(scene.m_fem, cube) + Vec3{0, 0, -weight};
        EXPECT_LT(norm(balance), 0.01 * weight) << "frame " << frame << ": it may still rock a little";
        EXPECT_LT(scene.m_fem.stepReport(&cube).m_deepestPenetration, 1e-3 * kSize);
    }
    EXPECT_EQ(scene.m_fem.stepReport(&cube).m_flags, 0);
}

/// Heights of a ball that starts 10 cm above a ground at 10 m/s downwards.
std::vector<double> heightsOfABall(ConcaveWorld& scene)
{
    btSoftBody* ball = btFemHelpers::createFromTetMesh(scene.m_world.info(), makeBall({0, 0, 0.6}));
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e5);
    scene.m_fem.setMaterial(ball, material);
    ball->addVelocity({btScalar(0.7), btScalar(0.3), -10});
    scene.m_world.addSoft(ball);
    std::vector<double> heights;
    for (int frame = 0; frame < 90; ++frame)
    {
        scene.m_world.step();
        heights.push_back(lowestHeight(*ball));
    }
    return heights;
}

// With a margin of the facets' size the ridges are round: no node is bounded by a face that it is not over.
TEST(ThickSheet, BodiesOnHillsComeToRest)
{
    for (double margin : {0.04, 0.2, 0.4})
        for (int place = 0; place < 4; ++place)
        {
            GridSettings hills;
            hills.m_cells = 24;
            hills.m_height = [place](btScalar x, btScalar y)
            { return btScalar(0.04) * btSin(7 * x + btScalar(place)) * btCos(6 * y + btScalar(2 * place)); };
            ConcaveShape sheet = makeTriangleMesh(hills);
            sheet.shape().setMargin(btScalar(margin));
            ConcaveWorld scene(implicitEuler());
            scene.addGround(std::move(sheet));
            btSoftBody& cube = scene.addCube({0, 0, btScalar(margin + 0.56)});
            cube.rotate(btQuaternion(btVector3(1, btScalar(place), 2), btScalar(0.2)));
            scene.m_world.step(600);
            const Vec3 before = centerOf(cube);
            double fastest = 0;
            for (int k = 0; k < 300; ++k)
            {
                scene.m_world.step();
                fastest = std::max(fastest, fastestNode(cube));
            }
            EXPECT_LT(fastest, 1e-3) << "margin " << margin << ", place " << place;
            EXPECT_LT(norm(centerOf(cube) - before), 1e-4) << "margin " << margin << ", place " << place;
        }
}

TEST_P(RestOnSheet, ABallAtTenMetresASecondBouncesAsOnAPlane)
{
    ConcaveWorld plane;
    plane.m_world.addPlane();
    const std::vector<double> expected = heightsOfABall(plane);
    for (const bool upsideDown : {false, true})
    {
        ConcaveWorld scene;
        GridSettings alike;
        alike.m_randomWinding = false;
        addSheet(scene, alike, upsideDown);
        const std::vector<double> heights = heightsOfABall(scene);
        for (std::size_t frame = 0; frame < heights.size(); ++frame)
            EXPECT_NEAR(heights[frame], expected[frame], 1e-4) << "frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, RestOnSheet, testing::ValuesIn(concaveShapes()),
                         [](const auto& scene) { return scene.param.m_name; });

/// A cube on a slope of 20,000 triangles with random winding.
class SheetIncline : public testing::TestWithParam<bool>
{
};

TEST_P(SheetIncline, SlidesOverTheEdgesAsOnAPlane)
{
    constexpr double kFriction = 0.4;
    const double slope = std::atan(1.3 * kFriction);
    const btQuaternion tilt(btVector3(0, 1, 0), btScalar(slope));
    const Vec3 normal = vec3(quatRotate(tilt, btVector3(0, 0, 1)));
    const Vec3 downhill = vec3(quatRotate(tilt, btVector3(1, 0, 0)));
    GridSettings fine;
    fine.m_cells = 100;
    fine.m_halfSize = 10;
    ConcaveWorld scene;
    RigidSettings settings;
    settings.m_friction = btScalar(0.8);
    if (GetParam())
        settings.m_transform = btTransform(tilt, btVector3(0, 0, 0));
    else
        fine.m_height = [slope](btScalar x, btScalar) { return -x * btScalar(std::tan(slope)); };
    scene.addGround(makeTriangleMesh(fine), settings);
    btSoftBody* cube = btFemHelpers::createBox(scene.m_world.info(), btVector3(0, 0, btScalar(0.5)),
                                               btVector3(0.5, 0.5, 0.5), btScalar(0.25));
    cube->rotate(tilt);
    cube->m_cfg.kDF = btScalar(0.5);
    scene.m_fem.setMaterial(cube, btFemMaterial());
    scene.m_world.addSoft(cube);
    scene.m_world.step(120);
    const double before = dot(velocityOf(*cube), downhill);
    const double start = dot(centerOf(*cube), downhill);
    for (int frame = 0; frame < 60; ++frame)
    {
        scene.m_world.step();
        const Vec3 J = impulseOn(scene.m_fem, *cube);
        EXPECT_NEAR(norm(J - dot(J, normal) * normal) / dot(J, normal), kFriction, 5e-4 * kFriction)
            << "frame " << frame;
        EXPECT_LT(scene.m_fem.stepReport(cube).m_deepestPenetration, 1e-4 * kSize);
    }
    EXPECT_GT(dot(centerOf(*cube), downhill) - start, 2) << "over ten edges";
    EXPECT_NEAR((dot(velocityOf(*cube), downhill) - before) / (60 * kStep),
                kGravity * (std::sin(slope) - kFriction * std::cos(slope)), 0.01 * kGravity * std::sin(slope));
}

INSTANTIATE_TEST_SUITE_P(Grounds, SheetIncline, testing::Values(true, false),
                         [](const auto& scene) { return scene.param ? "turnedMesh" : "slopingMesh"; });

/// A closed cube of triangles.
ConcaveShape makeGImpactCube(btScalar halfSize)
{
    ConcaveShape shape;
    for (int axis = 0; axis < 3; ++axis)
        for (const btScalar side : {-1, 1})
        {
            btVector3 corner[4];
            for (int k = 0; k < 4; ++k)
            {
                corner[k][axis] = side * halfSize;
                corner[k][(axis + 1) % 3] = (k == 1 || k == 2 ? 1 : -1) * halfSize;
                corner[k][(axis + 2) % 3] = (k >= 2 ? 1 : -1) * halfSize;
            }
            shape.m_mesh->addTriangle(corner[0], corner[1], corner[2]);
            shape.m_mesh->addTriangle(corner[0], corner[2], corner[3]);
        }
    auto& mesh = shape.make<btGImpactMeshShape>(shape.m_mesh.get());
    mesh.setMargin(0);
    mesh.updateBound();
    return shape;
}

TEST(MovingSheets, GImpactCubeHittingASoftOneConservesMomentum)
{
    ConcaveWorld scene;
    scene.m_world.world().setGravity({0, 0, 0});
    scene.m_world.info().m_gravity.setZero();
    RigidSettings stone;
    stone.m_mass = 500;
    stone.m_transform = btTransform(btQuaternion(btVector3(1, 2, 3), btScalar(0.5)), btVector3(-2, 0, 0));
    stone.m_velocity = {3, 0, 0};
    btRigidBody& gimpact = scene.addGround(makeGImpactCube(btScalar(0.4)), stone);
    btSoftBody& cube = scene.addCube({0, btScalar(0.1), btScalar(0.05)});
    Motion before = motionOf(gimpact);
    before += motionOf(cube);
    for (int k = 0; k < 90; ++k)
    {
        scene.m_world.step();
        EXPECT_LT(scene.m_fem.stepReport(&cube).m_deepestPenetration, 0.05 * kSize) << "frame " << k;
    }
    Motion after = motionOf(gimpact);
    after += motionOf(cube);
    EXPECT_GT(velocityOf(cube).x, 1) << "it was hit";
    EXPECT_LT(norm(after.m_linear - before.m_linear), 2e-6 * norm(before.m_linear));
}

TEST(MovingSheets, KinematicSheetLiftsABodyOnIt)
{
    ConcaveWorld scene;
    btRigidBody& lift = scene.addGround(makeGImpact());
    lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    btSoftBody& cube = scene.addCube({0, 0, btScalar(0.5)});
    for (int k = 0; k < 120; ++k)
    {
        lift.getMotionState()->setWorldTransform(at(0, 0, btScalar(k) * btScalar(0.01)));
        scene.m_world.step();
        EXPECT_GT(lowestHeight(cube), 0.01 * k - 0.003) << "frame " << k;
    }
    EXPECT_NEAR(lowestHeight(cube), 1.19, 1e-3);
}

class CountingSolver : public btFemSoftBodySolver
{
public:
    using btFemSoftBodySolver::processCollision;
    void processCollision(btSoftBody* body, const btCollisionObjectWrapper* other) override
    {
        ++m_calls;
        btFemSoftBodySolver::processCollision(body, other);
    }
    int m_calls = 0;
};

TEST(SheetDispatch, AMeshIsHandedOverOnceAndNotATriangleAtATimeButToSprings)
{
    for (const bool springs : {false, true})
    {
        const ConcaveShape mesh = makeTriangleMesh();
        CountingSolver fem;
        SoftWorld world(fem);
        btRigidBody& ground = world.addRigid(new btCompoundShape);
        static_cast<btCompoundShape*>(ground.getCollisionShape())->addChildShape(at(0, 0, 0), &mesh.shape());
        world.world().updateSingleAabb(&ground);
        btSoftBody* body = springs ? btSoftBodyHelpers::CreateEllipsoid(world.info(), {0, 0, 1}, {1, 1, 1}, 64)
                                   : btFemHelpers::createBox(world.info(), {0, 0, 1}, {1, 1, 1}, 1);
        world.addSoft(body);
        world.step(3);
        EXPECT_EQ(fem.m_calls == 3, !springs) << fem.m_calls;
        EXPECT_GE(fem.m_calls, 3);
    }
}

}  // namespace
}  // namespace bullet_fem
