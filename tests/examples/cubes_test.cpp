// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bullet's deformable examples of one soft cube: VolumetricDeformable, LargeDeformation, Collide, and picking in them.
#include <random>

#include "bullet_fem/btFemRay.h"
#include "examples/deformable_example.h"

namespace bullet_fem
{
namespace
{

constexpr double kShort = 1.0 / 240, kLong = 1.0 / 60;  // steps of the examples [s]
constexpr double kMass = 0.5, kEdge = 4;                // of the cube in all of them [kg], [m]

ExampleBlock cubeAt(btScalar height, btScalar friction)
{
    ExampleBlock block;
    block.m_scale = {2, 2, 2};
    block.m_center = {0, height, 0};
    block.m_mass = btScalar(kMass);
    block.m_friction = friction;
    return block;
}

double highest(const btSoftBody& body)
{
    double y = -1e30;
    for (int i = 0; i < body.m_nodes.size(); ++i) y = std::max(y, double(body.m_nodes[i].m_x.y()));
    return y;
}

class VolumetricDeformable : public DeformableExample
{
protected:
    VolumetricDeformable()
    {
        setGravity(100);
        useImplicitSolver();
        m_ground = &addRigidBox({150, 50, 150}, {0, -50, 0}, 0, 1);
    }

    // Runs the scene with walls around the cube and boxes that fall onto it.
    void runWithBoxes(double young, const TetMesh& mesh)
    {
        addCubeAndWalls(mesh);
        addElasticity(*m_cube, young);
        EnergyBook book(fem(), m_gravity);
        book.addSoft(*m_cube, young, 0.3);
        addBoxes();
        for (btRigidBody* box : m_boxes) book.addRigid(*box);
        book.open();
        const double start = book.potential();
        run(book, 600, kShort);
        EXPECT_LT(book.made(), 1e-3 * start);
    }

    void addBoxes()
    {
        for (int i = 0; i < 4; ++i)
            m_boxes.push_back(&addRigidBox({1, 1, 1}, {btScalar(i), btScalar(10 + 2 * i), btScalar(i - 1)}, 2));
    }

    void addCubeAndWalls(const TetMesh& mesh)
    {
        for (const btScalar side : {btScalar(-5), btScalar(5)})
        {
            addRigidBox({1, 5, 5}, {side, 0, 0}, 0);
            addRigidBox({5, 5, 1}, {0, 0, side}, 0);
        }
        m_cube = &addBlock(mesh, cubeAt(5, 2));
        addGravity(*m_cube);
    }

    // Once the last box has fallen off, the mean contact force on the cube over some steps equals its weight.
    void expectBalance()
    {
        m_world.step(300, btScalar(kShort));
        double sum = 0;
        for (int k = 0; k < 60; ++k)
        {
            m_world.step(1, btScalar(kShort));
            sum += impulseOn(fem(), *m_cube).y / kShort / 60;
        }
        EXPECT_NEAR(sum, 100 * kMass, 0.01 * 100 * kMass);
    }

    btRigidBody* m_ground;
    btSoftBody* m_cube = nullptr;
    std::vector<btRigidBody*> m_boxes;
};

TEST_F(VolumetricDeformable, BoxesFallOnTheStiffestCubeOfTheSlider)
{
    runWithBoxes(2000, makeBox({2, 2, 2}, {6, 6, 6}, {-1, -1, -1}));
    EXPECT_GT(smallestVolumeRatio(*m_cube), 0.5);
    expectBalance();
}

// A box weighs E times its face area: under the linear law elements are pressed flat and invert.
TEST_F(VolumetricDeformable, BoxesCrushTheCubeOfTheExample)
{
    runWithBoxes(50, makeBox({2, 2, 2}, {4, 4, 4}, {-1, -1, -1}));
    // At some initial positions one or two nodes stay about 10 um apart, pressed by two boxes; their bits differ.
    int deep = 0;
    for (int i = 0; i < m_cube->m_nodes.size(); ++i)
    {
        EXPECT_GT(m_cube->m_nodes[i].m_x.y(), -0.1);
        if (m_cube->m_nodes[i].m_x.y() < -0.01) ++deep;
    }
    EXPECT_LE(deep, 2);
    expectBalance();
}

// The cube with a Neo-Hookean force: this law carries the boxes, unlike the linear one.
TEST_F(VolumetricDeformable, BoxesCrushANeoHookeanCubeWithoutInvertedElementsAtRest)
{
    addCubeAndWalls(makeBox({2, 2, 2}, {4, 4, 4}, {-1, -1, -1}));
    auto force = std::make_unique<btDeformableNeoHookeanForce>(100, 100, btScalar(0.2));
    force->setPoissonRatio(btScalar(0.3));
    force->setYoungsModulus(50);
    addForce(m_world, *m_cube, std::move(force));
    addBoxes();
    for (int k = 0; k < 1500; ++k)
    {
        m_world.step(1, btScalar(kShort));
        ASSERT_TRUE(allFinite(*m_cube)) << "step " << k;
    }
    EXPECT_GT(smallestVolumeRatio(*m_cube), 0);
    for (int i = 0; i < m_cube->m_nodes.size(); ++i) EXPECT_GT(m_cube->m_nodes[i].m_x.y(), -0.1);
    expectBalance();
    for (btRigidBody* box : m_boxes) m_world.world().removeRigidBody(box);
    m_world.step(1200, btScalar(kShort));
    EXPECT_GT(smallestVolumeRatio(*m_cube), 0.5);
    const double own = kMass * 100 * kEdge / (2 * 50 * kEdge * kEdge);
    EXPECT_NEAR(kEdge - highest(*m_cube), own, 0.2 * own);  // friction on the floor holds its lower face
}

TEST_F(VolumetricDeformable, ACubeAloneAndUnderAPlateIsSqueezedAsItsModulusSays)
{
    m_cube = &addBlock(makeBox({2, 2, 2}, {5, 5, 5}, {-1, -1, -1}), cubeAt(2, 2));
    addGravity(*m_cube);
    addElasticity(*m_cube, 50);
    m_world.step(480, btScalar(kShort));
    const double alone = highest(*m_cube);
    const double own = kMass * 100 * kEdge / (2 * 50 * kEdge * kEdge);
    EXPECT_NEAR(kEdge - alone, own, 0.15 * own);  // the lower face sticks
    EXPECT_NEAR(supportOn(*m_cube, *m_ground), 100 * kMass, 1e-3 * 100 * kMass);
    btRigidBody& plate = addRigidBox({2, btScalar(0.25), 2}, {0, btScalar(alone + 0.26), 0}, btScalar(0.5), 0);
    m_world.step(600, btScalar(kShort));
    const double pressed = 0.5 * 100 * kEdge / (50 * kEdge * kEdge);
    EXPECT_NEAR(alone - (double(plate.getCenterOfMassPosition().y()) - 0.25), pressed, 0.15 * pressed);
    EXPECT_NEAR(supportOn(*m_cube, *m_ground), 100 * (kMass + 0.5), 0.01 * 100);
    EXPECT_GT(smallestVolumeRatio(*m_cube), 0.3);
}

// Picking as in the examples: the face hit by a ray is pulled to the mouse by the example's spring of 100 N/m a node.
TEST_F(VolumetricDeformable, APickedFaceFollowsTheMouse)
{
    m_cube = &addBlock(makeBox({2, 2, 2}, {5, 5, 5}, {-1, -1, -1}), cubeAt(2, 2));
    addGravity(*m_cube);
    addElasticity(*m_cube, 50);
    m_world.step(240, btScalar(kShort));
    btFemClosestRay ray(btVector3(1, 20, btScalar(0.5)), btVector3(1, -20, btScalar(0.5)));
    m_world.world().rayTest(ray.m_rayFromWorld, ray.m_rayToWorld, ray);
    ASSERT_EQ(ray.m_collisionObject, m_cube);
    const btSoftBody::Face& face = m_cube->m_faces[ray.m_hit.m_face];
    btVector3 mouse = ray.m_hitPointWorld;
    auto force = std::make_unique<btDeformableMousePickingForce>(100, 0, face, mouse, btScalar(1e10));
    btDeformableMousePickingForce& picking = *force;
    addForce(m_world, *m_cube, std::move(force));
    const auto held = [&] { return (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3; };
    const auto springEnergy = [&]
    {
        double sum = 0;
        for (const btSoftBody::Node* node : face.m_n) sum += 0.5 * 100 * double((node->m_x - mouse).length2());
        return sum;
    };
    EnergyBook book(fem(), m_gravity);
    book.addSoft(*m_cube, 50, 0.3);
    book.open();
    const double start = springEnergy();  // Bullet's springs pull all three nodes to one point
    double sag = 0, made = 0, least = 0;
    for (int k = 0; k < 900; ++k)
    {
        const double before = springEnergy();
        mouse.setY(std::min(btScalar(12), mouse.y() + btScalar(0.02)));
        picking.setMousePos(mouse);
        book.addWork(springEnergy() - before);
        run(book, 1, kShort);
        const double surplus = book.surplus() + springEnergy() - start;
        made = std::max(made, surplus - least);
        least = std::min(least, surplus);
        if (k >= 600) sag += double(mouse.y() - held().y()) / 300;
    }
    EXPECT_NEAR(sag, kMass * 100 / (3 * 100), 0.05 * kMass * 100 / (3 * 100));
    EXPECT_LT(made, 1e-2 * book.work());
    EXPECT_GT(m_flattest, 0.1);
}

// All nodes start at random in a box of half the size.
TEST_F(DeformableExample, LargeDeformationRegainsItsShapeFromRandomPositions)
{
    useImplicitSolver();
    btSoftBody& cube = addBlock(exampleCube(), cubeAt(5, btScalar(0.5)));
    addElasticity(cube, 50);
    const std::vector<Vec3> rest = edgesOf(cube);
    std::minstd_rand random(7);
    const auto anywhere = [&] { return btScalar(2 * (random() - 1.0) / (random.max() - 1.0) - 1); };
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        for (int c = 0; c < 3; ++c) cube.m_nodes[i].m_x[c] = anywhere() + btScalar(c == 1 ? 8 : 0);
    EnergyBook book(fem(), m_gravity);
    book.addSoft(cube, 50, 0.3);
    book.open();
    const double start = book.elastic();
    EXPECT_LT(smallestVolumeRatio(cube), -5);
    run(book, 600, kLong);
    EXPECT_LT(book.made(), 1e-6 * start);
    EXPECT_LT(book.elastic() + book.kinetic(), 1e-9 * start);
    EXPECT_GT(smallestVolumeRatio(cube), 0.999);
    double longest = 0;
    for (const Vec3& edge : edgesOf(cube)) longest = std::max(longest, norm(edge));
    EXPECT_NEAR(longest, std::sqrt(3.0) * kEdge, 1e-4 * kEdge);
    EXPECT_LT(norm(motionOf(cube).m_linear), 1e-5);
}

// A head-on impact at 30 m/s, without gravity and friction.
TEST_F(DeformableExample, CollideKeepsMomentumAndMakesNoEnergy)
{
    setGravity(0);
    useImplicitSolver();
    btSoftBody& cube = addBlock(exampleCube(), cubeAt(7, 0));
    cube.setVelocity(btVector3(0, -15, 0));
    addElasticity(cube, 50);
    btRigidBody& box = addRigidBox({2, 2, 2}, {0, -2, 0}, btScalar(kMass));
    box.setLinearVelocity(btVector3(0, 15, 0));
    EnergyBook book(fem(), m_gravity);
    book.addSoft(cube, 50, 0.3);
    book.addRigid(box);
    book.open();
    Vec3 momentum = {0, -15 * kMass, 0}, given;
    double worst = 0;
    for (int k = 0; k < 600; ++k)
    {
        run(book, 1, kLong);
        // Mass damping takes its share of the old momentum and of the impulses; nothing else changes momentum.
        const Vec3 impulse = impulseOn(fem(), cube);
        momentum = (1 / (1 + 0.1 * kLong)) * (momentum + impulse);
        given += impulse;
        worst = std::max(worst, norm(motionOf(cube).m_linear - momentum));
    }
    EXPECT_LT(worst, 1e-4 * 15 * kMass);
    EXPECT_LT(norm(motionOf(box).m_linear - Vec3{0, 15 * kMass, 0} + given), 1e-4 * 15 * kMass);
    EXPECT_LT(book.made(), 1e-6 * 0.5 * kMass * 2 * 15 * 15);
    EXPECT_GT(m_flattest, 0.3);
    EXPECT_LT(box.getLinearVelocity().y(), -1);  // thrown back
    EXPECT_GT(centerOf(cube).y, 5);
    EXPECT_LT(box.getAngularVelocity().length(), 0.1);
    EXPECT_GT(smallestVolumeRatio(cube), 0.999);
}

}  // namespace
}  // namespace bullet_fem
