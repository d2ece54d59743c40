// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Valid collision surfaces, and their collision after baking, over steps, and on threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "bullet_fem/btFemCollision.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/scenes/test_surfaces.h"
#include "io/temporary_folder.h"
#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/skin_bodies.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;

constexpr double kSinkage = 1e-4;  // accepted penetration at rest [m]

/// Balls and boxes that fall on each other, on a box and on a mesh.
class SkinHeap
{
public:
    explicit SkinHeap(const btFemSolverInfo& info = {}) : m_fem(info), m_world(m_fem)
    {
        m_world.addFloorBox();
        for (int k = 0; k < 2; ++k)
        {
            m_soft.push_back(&addSkinBody(m_world, m_fem, skinBox({0.6, 0.5, 0.3}, {0.05 * k, 0.1, 0.16 + 0.32 * k})));
            SkinBody ball;
            ball.m_surface = sphereSurface(0.25, {0.7 + 0.05 * k, 0.1 * k, 0.26 + 0.53 * k}, 3);
            ball.m_cell = 0.11;
            m_soft.push_back(&addSkinBody(m_world, m_fem, ball));
        }
        m_soft[0]->m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
        m_rigid = &addRigidBox(m_world, {0.3, 0.3, 0.2}, {20, at(0, btScalar(0.1), btScalar(0.85))});
    }

    std::vector<btScalar> run(int steps)
    {
        std::vector<btScalar> bits;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (const btSoftBody* soft : m_soft) append(bitsOf(*soft), bits);
            append(bitsOf(*m_rigid), bits);
        }
        return bits;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    std::vector<btSoftBody*> m_soft;
    btRigidBody* m_rigid;

private:
    static void append(const std::vector<btScalar>& values, std::vector<btScalar>& bits)
    {
        bits.insert(bits.end(), values.begin(), values.end());
    }
};

TEST(SkinHeap, HasTheSameBitsForEveryNumberOfThreads)
{
    std::vector<btScalar> bits;
    for (const int threads : {1, 2, 3})
    {
        btFemSolverInfo info;
        info.m_threads = threads;
        SkinHeap heap(info);
        const std::vector<btScalar> now = heap.run(40);
        EXPECT_TRUE(bits.empty() || now == bits) << threads << " threads";
        bits = now;
        int contacts = 0;
        for (const btSoftBody* soft : heap.m_soft) contacts += heap.m_fem.contacts(soft).size();
        EXPECT_GT(contacts, 30);
    }
}

TEST(SkinHeap, ContinuesFromASnapshotToTheBit)
{
    SkinHeap heap;
    heap.run(30);
    std::vector<unsigned char> state, again;
    heap.m_fem.saveState(state);
    const BulletState bullet(heap.m_world);
    bullet.restore(heap.m_world);
    const std::vector<btScalar> bits = heap.run(30);
    heap.m_fem.restoreState(state.data(), state.size());
    bullet.restore(heap.m_world);
    heap.m_fem.saveState(again);
    EXPECT_TRUE(state == again);
    EXPECT_TRUE(heap.run(30) == bits);
}

// Its two faces are closer than the distance within which self contact ignores neighbours.
TEST(SkinSelfContact, ThinSlabHasNoSelfContact)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addFloorBox();
    btSoftBody& slab = addSkinBody(world, fem, skinBox({0.6, 0.5, 0.05}, {0, 0, 0.03}));
    slab.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        EXPECT_EQ(norm(impulseOn(fem, slab, &slab)), 0) << "step " << k;
    }
    EXPECT_NEAR(lowestVertex(slab), 0, kSinkage);
}

// A block with a slot from one end: the upper jaw moves down onto the lower one.
TEST(SkinSelfContact, KeepsTheJawsOfABodyApart)
{
    const TetMesh block = makeBox({1, 0.3, 0.5}, {10, 3, 10}, {-0.5, -0.15, 0.001});
    std::vector<Tet> tets;
    for (const Tet& t : block.tets())
    {
        Vec3 middle;
        for (int i : t) middle += 0.25 * block.restPositions()[i];
        if (!(middle.x > -0.3 && middle.z > 0.2 && middle.z < 0.35)) tets.push_back(t);
    }
    const TetMesh jaws(block.restPositions(), tets, LooseNodes::kept);
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    SkinBody body;
    body.m_surface = {jaws.restPositions(), jaws.surface()};
    body.m_cell = 0.07;
    body.m_youngModulus = btScalar(1e5);
    btSoftBody& soft = addSkinBody(world, fem, body);
    soft.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
    world.addPlane();
    world.step(90);
    EXPECT_GT(norm(impulseOn(fem, soft, &soft)), 0);
    double lowest = HUGE_VAL;  // of the upper jaw
    for (int v = 0; v < soft.m_renderNodes.size(); ++v)
        if (body.m_surface.m_vertices[v].z > 0.34 && body.m_surface.m_vertices[v].x > 0)
            lowest = std::min(lowest, double(soft.m_renderNodes[v].m_x.z()));
    EXPECT_GT(lowest, 0.17);
    EXPECT_LT(lowest, 0.2);
    EXPECT_TRUE(allFinite(soft));
}

class SkinSurface : public testing::Test
{
protected:
    SkinSurface() : m_world(m_fem) { m_world.addPlane(); }

    btSoftBody* ball(bool surfaceCollides = true)
    {
        SkinBody settings = skinBall({0, 0, 0.51});
        settings.m_surfaceCollides = surfaceCollides;
        return makeSkinBody(m_world, m_fem, settings);
    }

    void expectToRest(const SurfaceMesh& surface, double cell = 0.14)
    {
        SkinBody settings;
        settings.m_surface = surface;
        settings.m_cell = cell;
        btSoftBody& body = addSkinBody(m_world, m_fem, settings);
        m_world.step(120);
        EXPECT_NEAR(lowestVertex(body), 0, kSinkage);
        EXPECT_EQ(m_fem.stepReport(&body).m_flags & BT_FEM_BAD_SURFACE, 0);
        EXPECT_TRUE(allFinite(body));
        m_world.deleteSoft(body);
    }

    // Expects that prepare refuses the surface; in a step the cage collides instead.
    void expectRefused(const std::string& why, const std::function<void(btSoftBody&)>& spoil)
    {
        SCOPED_TRACE(why);
        btSoftBody* bad = ball();
        spoil(*bad);
        const auto prepare = [&] { m_fem.prepare(bad, kStep); };
        EXPECT_THAT(prepare, testing::ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
        EXPECT_THAT(messageOf(bad), HasSubstr(why));
        m_world.addSoft(bad);
        m_world.step(2);
        EXPECT_NE(m_fem.stepReport(bad).m_flags & BT_FEM_BAD_SURFACE, 0);
        m_world.step(118);
        EXPECT_LT(lowestHeight(*bad), 0.01);
        EXPECT_GT(lowestHeight(*bad), -kSinkage);
        bad->m_cfg.collisions &= ~BT_FEM_RENDER_SURFACE;
        m_world.step();
        EXPECT_EQ(m_fem.stepReport(bad).m_flags & BT_FEM_BAD_SURFACE, 0);
        m_world.deleteSoft(*bad);
    }

    std::string messageOf(btSoftBody* body)
    {
        std::string why;
        body->m_cfg.collisions &= ~BT_FEM_RENDER_SURFACE;
        m_fem.prepare(body, kStep);
        body->m_cfg.collisions |= BT_FEM_RENDER_SURFACE;
        EXPECT_FALSE(m_fem.prepare(body, kStep, &why));
        return why;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
};

TEST_F(SkinSurface, UnusableSurfaceIsRejectedWithTheReason)
{
    expectRefused("0 nodes and 0 faces",
                  [](btSoftBody& body)
                  {
                      body.m_renderFaces.clear();
                      body.m_renderNodes.clear();
                  });
    expectRefused("only 0 follow", [](btSoftBody& body) { body.m_renderNodesParents.clear(); });
    expectRefused("render node 7 follows 3 nodes", [](btSoftBody& body) { body.m_renderNodesParents[7].pop_back(); });
    expectRefused("render node 3 follows a node that is none",
                  [](btSoftBody& body)
                  {
                      static btSoftBody::Node foreign;
                      body.m_renderNodesParents[3][1] = &foreign;
                  });
    expectRefused("render node 5 has the weight",
                  [](btSoftBody& body) { body.m_renderNodesInterpolationWeights[5][2] = btScalar(1.5); });
    expectRefused("render node 5 has the weight", [](btSoftBody& body)
                  { body.m_renderNodesInterpolationWeights[5][0] = std::numeric_limits<btScalar>::quiet_NaN(); });
    expectRefused("weights of render node 6 add up to 0",
                  [](btSoftBody& body) { body.m_renderNodesInterpolationWeights[6] = btVector4(0, 0, 0, 0); });
    expectRefused("corner 2 of render face 4",
                  [](btSoftBody& body)
                  {
                      static btSoftBody::RenderNode foreign;
                      body.m_renderFaces[4].m_n[2] = &foreign;
                  });
    expectRefused("none of the 1280 faces",
                  [](btSoftBody& body)
                  {
                      for (int f = 0; f < body.m_renderFaces.size(); ++f)
                          body.m_renderFaces[f].m_n[1] = body.m_renderFaces[f].m_n[0];
                  });
}

TEST_F(SkinSurface, InvertedRepeatedAndOpenSurfacesAreRepaired)
{
    const SurfaceMesh sphere = sphereSurface(0.5, {0, 0, 0.51}, 3);
    expectToRest(flipped(sphere));
    expectToRest(joined(sphere, sphere));
    expectToRest(without(sphere, 100, 130));
    SurfaceMesh soup;  // no two triangles share a vertex, every fifth is reversed, and one has no area
    for (const Triangle& t : sphere.m_triangles)
    {
        const int n = static_cast<int>(soup.m_vertices.size());
        for (int corner : t) soup.m_vertices.push_back(sphere.m_vertices[corner]);
        soup.m_triangles.push_back(n % 5 == 0 ? Triangle{n, n + 2, n + 1} : Triangle{n, n + 1, n + 2});
    }
    soup.m_triangles.push_back({0, 1, 0});
    expectToRest(soup);
    SurfaceMesh fin = sphere;  // an edge of three triangles
    fin.m_vertices.push_back({0, 0, 0.6});
    fin.m_triangles.push_back({fin.m_triangles[0][0], fin.m_triangles[0][1], 642});
    expectToRest(fin);
}

TEST_F(SkinSurface, BakedBodyCollidesToTheSameBits)
{
    const SurfaceMesh sphere = sphereSurface(0.5, {0, 0, 0.51}, 2);
    CageSettings settings;
    settings.m_cellSize = 0.2;
    settings.m_surfaceCollides = true;
    BakeSettings bake;
    bake.m_material.m_youngModulus = 5e5;
    bake.m_material.m_density = 1000;
    const btFemMaterial same;
    bake.m_material.m_poissonRatio = same.m_poissonRatio;
    bake.m_material.m_massDamping = same.m_massDamping;
    bake.m_material.m_stiffnessDamping = same.m_stiffnessDamping;
    bake.m_singlePrecision = sizeof(btScalar) == sizeof(float);
    const TemporaryFolder folder;
    writeBakedBody(folder.path("ball.bfem"), bakeBody(makeCage(sphere, settings), sphere, bake));
    EXPECT_TRUE(inspectBakedBody(folder.path("ball.bfem")).m_surfaceCollides);
    const BakedBody baked = readBakedBody(folder.path("ball.bfem"));

    std::vector<btScalar> bits[2];
    for (const bool fromFile : {false, true})
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        world.addPlane();
        SkinBody body;
        body.m_surface = sphere;
        body.m_cell = settings.m_cellSize;
        btSoftBody* soft =
            fromFile ? btFemHelpers::createFromBaked(world.info(), baked) : makeSkinBody(world, fem, body);
        if (fromFile) fem.useBaked(soft, baked);
        soft->m_cfg.kDF = btScalar(0.4);
        fem.prepare(soft, kStep);
        world.addSoft(soft);
        world.step(120);
        EXPECT_NEAR(lowestVertex(*soft), 0, kSinkage);
        EXPECT_LT(lowestHeight(*soft), -0.01);
        bits[fromFile] = bitsOf(*soft);
    }
    EXPECT_TRUE(bits[0] == bits[1]);
}

TEST_F(SkinSurface, SharesItsForcesOutToTheNodes)
{
    btSoftBody& body = m_world.addSoft(ball());
    m_world.step(120);
    btAlignedObjectArray<btVector3> forces;
    ASSERT_TRUE(m_fem.getContactForces(&body, forces));
    Vec3 sum, moment, whole, wholeMoment;
    for (int i = 0; i < forces.size(); ++i)
    {
        sum += vec3(forces[i]);
        moment += cross(vec3(body.m_nodes[i].m_q), vec3(forces[i]));
    }
    const auto& contacts = m_fem.contacts(&body);
    int most = 0;
    for (int k = 0; k < contacts.size(); ++k)
    {
        const Vec3 force = (1 / double(kStep)) * vec3(contacts[k].m_impulse);
        whole += force;
        wholeMoment += cross(vec3(contacts[k].m_point), force);
        most = std::max(most, contacts[k].m_nodeCount);
    }
    const double weight = massOf(body) * kGravity;
    EXPECT_LT(norm(sum - whole), 1e-5 * weight);
    EXPECT_LT(norm(moment - wholeMoment), 1e-5 * weight);  // arm of a metre
    EXPECT_GE(most, 4);
    EXPECT_GT(body.m_rcontacts.size(), 0);          // at the heaviest node
    EXPECT_EQ(body.m_faceRigidContacts.size(), 0);  // no face of the cage contains the points
}

TEST_F(SkinSurface, PersistsWhenTheRestShapeChanges)
{
    btSoftBody* body = ball();
    body->translate(btVector3(0, 0, btScalar(-0.51)));
    body->scale(btVector3(btScalar(0.8), btScalar(0.8), btScalar(0.8)));
    body->translate(btVector3(0, 0, btScalar(0.6)));
    m_world.addSoft(body);
    m_world.step(60);
    body->scale(btVector3(1, 1, btScalar(1.1)));
    m_world.step(120);
    EXPECT_NEAR(lowestVertex(*body), 0, kSinkage);
    EXPECT_LT(lowestHeight(*body), -0.005);
}

}  // namespace
}  // namespace bullet_fem
