// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <utility>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

/// A cube at rest, pinned at its upper face, with its own material.
class HangingCube
{
public:
    explicit HangingCube(WorldClass worldClass, Coupling coupling = Coupling::swap) : m_world(worldClass, coupling)
    {
        m_body = btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(-0.5)), btVector3(0.5, 0.5, 0.5),
                                         btScalar(0.25));
        btFemMaterial material;
        material.m_youngModulus = btScalar(2e5);
        material.m_poissonRatio = 0;
        material.m_density = 500;
        material.m_massDamping = 5;
        m_world.fem().setMaterial(m_body, material);
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
            if (m_body->m_nodes[i].m_x.z() > btScalar(-1e-3)) m_body->setMass(i, 0);
        m_world.addSoft(m_body);
        m_world.step(200);
        m_sag = -1 - lowestHeight(*m_body);
    }

    btFemSoftBodySolver& fem() { return m_world.fem(); }
    SoftWorld& world() { return m_world; }
    btSoftBody& body() { return *m_body; }
    double sag() const { return m_sag; }  ///< [m]
    int flags() const { return m_world.fem().stepReport(m_body).m_flags; }

    /// Appends nodes that no element uses, enough to make Bullet reallocate the array.
    void appendNodes()
    {
        const btSoftBody::Node* first = &m_body->m_nodes[0];
        for (int k = 0; k < 300; ++k) m_body->appendNode(btVector3(2, 0, 0), 1);
        ASSERT_NE(first, &m_body->m_nodes[0]);
    }

    /// Appends a tetrahedron below the middle of the lower face.
    void appendTetra()
    {
        const auto at = [this](double x, double y)
        {
            int nearest = 0;
            const auto distance = [&](int i)
            {
                const btVector3& node = m_body->m_nodes[i].m_x;
                return std::hypot(node.x() - x, node.y() - y) + (node.z() > btScalar(-0.9) ? 1e3 : 0);
            };
            for (int i = 0; i < m_body->m_nodes.size(); ++i)
                if (distance(i) < distance(nearest)) nearest = i;
            return nearest;
        };
        const int a = at(0, 0), b = at(.25, 0), c = at(0, .25);
        m_body->appendNode(m_body->m_nodes[a].m_x + btVector3(btScalar(0.1), btScalar(0.1), btScalar(-0.25)), 50);
        m_body->appendTetra(a, c, b, m_body->m_nodes.size() - 1);
    }

private:
    FemWorld m_world;
    btSoftBody* m_body;
    double m_sag = 0;
};

class ChangedArrays : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, ChangedArrays, eachWorld(), nameOfWorld);

TEST_P(ChangedArrays, NodesAppendedInMidRunLeaveTheBodyAsItWas)
{
    HangingCube cube(GetParam());
    cube.appendNodes();
    cube.world().step();
    EXPECT_EQ(cube.flags(), BT_FEM_UNUSED_NODES | BT_FEM_CHANGED_MESH);
    cube.world().step(200);
    EXPECT_EQ(cube.flags(), BT_FEM_UNUSED_NODES);
    EXPECT_NEAR(-1 - lowestHeight(cube.body()), cube.sag(), 1e-3 * cube.sag());  // rest shape, material, masses, pins
    for (int e = 0; e < cube.body().m_tetras.size(); ++e)
        EXPECT_LT(cube.body().m_tetras[e].m_n[0] - &cube.body().m_nodes[0], 125);
}

// The weight at the new node stretches the cube; its present shape becomes the rest shape, because appendTetra gives
// the new element no matrix.
TEST_P(ChangedArrays, TetrahedraAppendedInMidRunAreElementsFromTheNextStepOn)
{
    HangingCube cube(GetParam());
    const double before = lowestHeight(cube.body()), mass = massOf(cube.body());
    ASSERT_NO_FATAL_FAILURE(cube.appendTetra());
    const double appended = lowestHeight(cube.body());
    EXPECT_NEAR(appended, before - 0.25, 1e-5);
    cube.world().step();
    EXPECT_EQ(cube.flags() & ~BT_FEM_TURNED_TETS, BT_FEM_CHANGED_MESH);
    EXPECT_TRUE(cube.fem().isFem(&cube.body()));
    EXPECT_NEAR(massOf(cube.body()), mass + 50, 1e-3);
    cube.world().step(300);
    EXPECT_TRUE(allFinite(cube.body()));
    EXPECT_LT(fastestNode(cube.body()), 1e-3);
    EXPECT_LT(lowestHeight(cube.body()), appended - cube.sag());  // it sags again, and further
    EXPECT_GT(lowestHeight(cube.body()), appended - 0.2);
}

TEST_P(ChangedArrays, RemovedTetrahedraAreGoneFromTheNextStepOn)
{
    HangingCube cube(GetParam());
    const int count = cube.body().m_tetras.size();
    for (int k = 0; k < 5; ++k) cube.body().m_tetras.pop_back();
    cube.world().step(60);
    EXPECT_TRUE(cube.fem().isFem(&cube.body()));
    EXPECT_EQ(cube.fem().stepReport(&cube.body()).m_tets, count - 5);
    EXPECT_TRUE(allFinite(cube.body()));
}

// Joined to other nodes in place, which Bullet does not report: parts of the body are checked in turn. As that
// tetrahedron's matrix does not fit its new nodes, the present shape becomes the rest shape.
TEST_P(ChangedArrays, TetrahedraJoinedOtherwiseInPlaceAreSeenWithinEightSteps)
{
    HangingCube cube(GetParam());
    btSoftBody::Tetra& tetra = cube.body().m_tetras[cube.body().m_tetras.size() / 2];
    std::swap(tetra.m_n[0], tetra.m_n[1]);
    std::swap(tetra.m_n[2], tetra.m_n[3]);  // an equal body with another node order
    int seen = 0;
    for (int k = 0; k < 8; ++k)
    {
        cube.world().step();
        seen += (cube.flags() & BT_FEM_CHANGED_MESH) != 0;
    }
    EXPECT_EQ(seen, 1);
    cube.world().step(200);
    EXPECT_TRUE(cube.fem().isFem(&cube.body()));
    EXPECT_NEAR(-1 - lowestHeight(cube.body()), 2 * cube.sag(), 0.03 * 2 * cube.sag());
}

// A body whose earlier node positions are unknown is left to Bullet, with a message.
TEST_P(ChangedArrays, NodesAppendedAfterTheTetrahedraBeforeTheFirstStepAreFlagged)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    for (int k = 0; k < 300; ++k) cube.appendNode(btVector3(2, 0, 0), 1);
    std::string why;
    EXPECT_FALSE(btFemSoftBodySolver::valid(&cube, &why));
    EXPECT_NE(why.find("append all nodes before"), std::string::npos) << why;
    world.step(10);
    EXPECT_FALSE(fem.isFem(&cube));
    EXPECT_EQ(fem.stepReport(&cube).m_flags, BT_FEM_REJECTED);
    EXPECT_EQ(why, fem.stepReport(&cube).m_message);
}

TEST_P(ChangedArrays, OurOwnCallsReportThatAStepIsNeeded)
{
    HangingCube cube(GetParam());
    cube.appendNodes();
    const int last = cube.body().m_nodes.size() - 1;
    EXPECT_THROW(cube.fem().setNodeTarget(&cube.body(), last, btVector3(0, 0, 0)), std::invalid_argument);
    EXPECT_THROW(cube.fem().refactor(&cube.body()), std::invalid_argument);
    EXPECT_THROW(cube.fem().attachNodes(&cube.body(), last, &cube.body(), 0), std::invalid_argument);
    EXPECT_NO_THROW(cube.fem().prepare(&cube.body(), kStep));
    EXPECT_NO_THROW(cube.fem().refactor(&cube.body()));
    EXPECT_NO_THROW(cube.fem().setNodeTarget(&cube.body(), last, btVector3(1, 0, 0)));
    cube.world().step(2);
    EXPECT_NEAR(cube.body().m_nodes[last].m_x.x(), 1, 1e-6);
}

TEST_P(ChangedArrays, ANewMaterialRightAfterwardsIsTaken)
{
    HangingCube cube(GetParam());
    cube.appendNodes();
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e5);
    material.m_poissonRatio = 0;
    material.m_density = 500;
    material.m_massDamping = 5;
    cube.fem().setMaterial(&cube.body(), material);
    cube.world().step(300);
    EXPECT_NEAR(-1 - lowestHeight(cube.body()), 2 * cube.sag(), 0.03 * 2 * cube.sag());  // half as stiff
}

void appendInTick(btDynamicsWorld* world, btScalar)
{
    auto*& cube = *static_cast<HangingCube**>(world->getWorldUserInfo());
    if (cube) cube->appendNodes();
    cube = nullptr;
}

using Tick = std::tuple<bool, std::pair<WorldClass, Coupling>>;

class ChangedInTick : public testing::TestWithParam<Tick>
{
};

TEST_P(ChangedInTick, StandsStillForTheStepAndGoesOn)
{
    const auto [before, solved] = GetParam();
    HangingCube cube(solved.first, solved.second);
    HangingCube* pointer = &cube;
    cube.world().bullet().setInternalTickCallback(appendInTick, &pointer, before);
    cube.world().step();
    EXPECT_EQ(pointer, nullptr);
    cube.world().step(100);
    EXPECT_TRUE(cube.fem().isFem(&cube.body()));
    EXPECT_EQ(cube.flags(), BT_FEM_UNUSED_NODES);
    EXPECT_NEAR(-1 - lowestHeight(cube.body()), cube.sag(), 1e-3 * cube.sag());
}

std::string tickName(const testing::TestParamInfo<Tick>& suite)
{
    const auto& [before, solved] = suite.param;
    return std::string(before ? "before_" : "after_") + worldName(solved.first) + "_" + couplingName(solved.second);
}

INSTANTIATE_TEST_SUITE_P(ChangedArrays, ChangedInTick,
                         testing::Combine(testing::Bool(),
                                          testing::Values(std::make_pair(WorldClass::softRigid, Coupling::swap),
                                                          std::make_pair(WorldClass::softRigid, Coupling::coupled),
                                                          std::make_pair(WorldClass::softMultiBody, Coupling::swap),
                                                          std::make_pair(WorldClass::deformable, Coupling::swap))),
                         tickName);

// Render nodes refer to nodes by pointers, which Bullet leaves dangling, too.
TEST_P(ChangedArrays, AnEmbeddedSurfaceFollows)
{
    HangingCube cube(GetParam());
    btSoftBody& body = cube.body();
    body.m_renderNodes.resize(1);
    body.m_renderNodesParents.resize(1);
    body.m_renderNodesInterpolationWeights.resize(1);
    for (int a = 0; a < 4; ++a)
    {
        body.m_renderNodesParents[0].push_back(body.m_tetras[5].m_n[a]);
        body.m_renderNodesInterpolationWeights[0][a] = btScalar(0.25);
    }
    cube.appendNodes();
    cube.world().step(2);
    btVector3 middle(0, 0, 0);
    for (const btSoftBody::Node* node : body.m_tetras[5].m_n) middle += node->m_x / 4;
    EXPECT_LT((body.m_renderNodes[0].m_x - middle).length(), 1e-5);
}

}  // namespace
}  // namespace bullet_fem
