// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The two tetrahedral scenes of Bullet's soft demo, on its wavy ground, and its picking.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "examples/energy_book.h"
#include "examples/example_bodies.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr int kWaves = 30;     // vertices along an edge
constexpr int kMeasured = 60;  // steps for the mean of forces

/// A world with the demo's gravity, its own world info, and waves of triangles of 8 m with a margin of 0.5 m.
class SoftDemo : public ::testing::Test
{
protected:
    SoftDemo()
    {
        m_info.m_dispatcher = m_world.world().getDispatcher();
        m_info.m_broadphase = m_world.world().getBroadphase();
        m_info.m_gravity.setValue(0, -10, 0);
        m_info.air_density = btScalar(1.2);
        m_info.m_sparsesdf.Initialize();
        makeWaves();
    }

    void makeWaves()
    {
        for (int j = 0; j < kWaves; ++j)
            for (int i = 0; i < kWaves; ++i)
                m_vertices.emplace_back(8 * btScalar(i - kWaves / 2), btScalar(5 * std::sin(i) * std::cos(j - 50)),
                                        8 * btScalar(j - kWaves / 2));
        for (int j = 0; j + 1 < kWaves; ++j)
            for (int i = 0; i + 1 < kWaves; ++i)
            {
                const int a = j * kWaves + i, b = a + kWaves;
                m_indices.insert(m_indices.end(), {a, b + 1, a + 1, a, b, b + 1});
            }
        m_triangles = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(m_indices.size() / 3), m_indices.data(), static_cast<int>(3 * sizeof(int)),
            static_cast<int>(m_vertices.size()), &m_vertices[0][0], static_cast<int>(sizeof(btVector3)));
        auto* shape = new btBvhTriangleMeshShape(m_triangles.get(), true);
        shape->setMargin(btScalar(0.5));
        RigidSettings settings;
        settings.m_transform = at(0, -12, 0);
        settings.m_friction = btScalar(0.5);
        m_waves = &m_world.addRigid(shape, settings);
    }

    btSoftBody& addCube()
    {
        btSoftBody& cube = m_world.addSoft(createFromTetGenText(m_info, exampleCube()));
        cube.scale(btVector3(4, 4, 4));
        cube.translate(btVector3(0, 5, 0));
        cube.setVolumeMass(300);
        cube.m_cfg.piterations = 1;
        cube.generateClusters(16);
        cube.getCollisionShape()->setMargin(btScalar(0.01));
        cube.m_cfg.collisions = btSoftBody::fCollision::CL_SS | btSoftBody::fCollision::CL_RS;
        cube.m_materials[0]->m_kLST = btScalar(0.8);
        return cube;
    }

    // 600 steps: checks energy and finiteness after each, and the total momentum balance at the end.
    void run(const btSoftBody& body, EnergyBook& book)
    {
        book.open();
        Vec3 momentum;
        const double mass = massOf(body), start = book.potential() + 12 * mass * 10;
        for (int k = 0; k < 600; ++k)
        {
            m_world.step();
            ASSERT_TRUE(allFinite(body)) << k;
            momentum += impulseOn(m_fem, body) + Vec3{0, -10 * mass * kStep, 0};
            book.audit();
            ASSERT_LT(book.surplus(), 1e-4 * start) << k;
            m_flattest = std::min(m_flattest, smallestVolumeRatio(body));
        }
        EXPECT_LT(norm(motionOf(body).m_linear - momentum), 1e-4 * mass * 10);
    }

    double averageSupport(const btSoftBody& body)
    {
        double sum = 0;
        for (int k = 0; k < kMeasured; ++k)
        {
            m_world.step();
            sum += m_fem.contactForce(&body, m_waves).y() / kMeasured;
        }
        return sum;
    }

    btFemSoftBodySolver m_fem{withoutRebounds()};
    SoftWorld m_world{m_fem, btVector3(0, -10, 0)};
    btSoftBodyWorldInfo m_info;
    std::vector<btVector3> m_vertices;
    std::vector<int> m_indices;
    std::unique_ptr<btTriangleIndexVertexArray> m_triangles;
    btRigidBody* m_waves = nullptr;
    double m_flattest = 1;
};

TEST_F(SoftDemo, TetraCubeFallsOnTheWavesAndComesToRest)
{
    btSoftBody& cube = addCube();
    EnergyBook book(m_fem, {0, -10, 0});
    book.addSoft(cube, 0.8e6, 0.3);
    run(cube, book);
    EXPECT_LT(book.made(), 1e-4 * 3000 * 17);  // the fall of 17 m to the lowest possible place
    ASSERT_TRUE(m_fem.isFem(&cube));
    EXPECT_EQ(m_fem.stepReport(&cube).m_flags, 0);
    m_world.step(60);  // on the crest of a wave it rotates by some millimetres a second until it settles
    const Vec3 settled = centerOf(cube);
    m_world.step(1200);
    EXPECT_LT(fastestNode(cube), 1e-3);
    EXPECT_LT(norm(centerOf(cube) - settled), 1e-4) << "it does not creep";
    EXPECT_NEAR(averageSupport(cube), 3000, 1e-3 * 3000);
    EXPECT_GT(smallestVolumeRatio(cube), 0.98);
    EXPECT_GT(m_flattest, 0.8);
}

TEST_F(SoftDemo, TetraBunnyFallsOnTheWavesAndRocks)
{
    CageSettings settings;
    settings.m_cellSize = 1.15;
    btSoftBody& bunny = m_world.addSoft(btFemHelpers::createFromSurface(m_info, lumpySurface(), settings));
    bunny.rotate(btQuaternion(SIMD_PI / 2, 0, 0));
    bunny.setVolumeMass(150);
    bunny.m_cfg.piterations = 2;
    bunny.m_cfg.collisions = btSoftBody::fCollision::CL_SS | btSoftBody::fCollision::CL_RS;
    bunny.generateClusters(0);
    bunny.m_cfg.kDF = 10;
    EnergyBook book(m_fem, {0, -10, 0});
    book.addSoft(bunny, 0, 0);  // elements on the boundary are softer than E, so elastic energy is left out
    run(bunny, book);
    ASSERT_TRUE(m_fem.isFem(&bunny));
    EXPECT_EQ(m_fem.stepReport(&bunny).m_flags, 0);
    EXPECT_LT(norm(velocityOf(bunny)), 1.5);  // it landed at 12 m/s, and sticks in contact
    EXPECT_NEAR(averageSupport(bunny), 1500, 0.1 * 1500);
    EXPECT_GT(smallestVolumeRatio(bunny), 0.9);
    EXPECT_GT(m_flattest, 0.3);
    EXPECT_GT(centerOf(bunny).y, -12);
}

struct Drag
{
    btSoftBody::Node* m_node;
    btVector3 m_goal, m_impulse{0, 0, 0};  // m_impulse: that of the last step [N s]
};

// Before each step the demo gives the picked node the velocity that would take it to the mouse.
void drag(btDynamicsWorld* world, btScalar step)
{
    auto& pulled = *static_cast<Drag*>(world->getWorldUserInfo());
    btVector3 delta = pulled.m_goal - pulled.m_node->m_x;
    if (delta.length2() > 100) delta = delta.normalized() * 10;
    pulled.m_node->m_v += delta / step;
    pulled.m_impulse = delta / (step * pulled.m_node->m_im);
}

TEST_F(SoftDemo, APickedNodeOfTheTetraCubeFollowsTheMouse)
{
    btSoftBody& cube = addCube();
    const btVector3 from(1, 30, btScalar(1.3)), to(1, -30, btScalar(1.3));
    m_world.step();
    btSoftBody::sRayCast results;
    ASSERT_TRUE(cube.rayTest(from, to, results));
    ASSERT_EQ(results.feature, btSoftBody::eFeature::Face);
    const btVector3 impact = from + (to - from) * results.fraction;
    const btSoftBody::Face& face = cube.m_faces[results.index];
    Drag picked = {face.m_n[0], impact};
    for (btSoftBody::Node* node : face.m_n)
        if ((node->m_x - impact).length2() < (picked.m_node->m_x - impact).length2()) picked.m_node = node;
    m_world.world().setInternalTickCallback(drag, &picked, true);
    // The drag acts as an undamped spring of stiffness m_node / step^2.
    const double sag = 10 * 300 * double(picked.m_node->m_im) * double(kStep * kStep);
    EnergyBook book(m_fem, {0, -10, 0});
    book.addSoft(cube, 0.8e6, 0.3);
    book.open();
    double offset = 0, farthest = 0;
    for (int k = 0; k < 600; ++k)
    {
        const btVector3 before = picked.m_node->m_x;
        picked.m_goal = impact + btVector3(btScalar(std::min(0.02 * k, 6.0)), 0, 0);
        m_world.step();
        ASSERT_TRUE(allFinite(cube)) << k;
        book.addWork(double(picked.m_impulse.dot(picked.m_node->m_x - before)) / double(kStep));
        book.audit();
        ASSERT_LT(book.made(), 5e-3 * 3000 * sag) << k;
        const btVector3 away = picked.m_goal - picked.m_node->m_x;
        farthest = std::max(farthest, double(away.length()));
        if (k >= 300) offset += double(away.y()) / 300;
    }
    EXPECT_NEAR(offset, sag, 0.2 * sag);
    EXPECT_LT(farthest, 4 * sag);
    EXPECT_NEAR(centerOf(cube).x, 7, 2);
    EXPECT_GT(smallestVolumeRatio(cube), 0.2);
}

}  // namespace
}  // namespace bullet_fem
