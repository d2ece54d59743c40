// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies with edges and tips that no face around them shows to the ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "plugin/scenes/ground_kinds.h"
#include "plugin/scenes/kinematic_bodies.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/sharp_solids.h"

namespace bullet_fem
{
namespace
{

/// A world with a ground of one kind, for bodies of size L.
struct SharpScene
{
    SharpScene(GroundKind kind, Coupling coupling, double L)
        : m_world(WorldClass::softRigid, coupling), m_ground(m_grounds.addFlat(m_world, kind, 5 * L))
    {
    }

    btSoftBody& add(const TetMesh& mesh, double L, const btQuaternion& turn, double lowest)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), mesh);
        body->rotate(turn);
        body->translate(btVector3(0, 0, btScalar(lowest - lowestHeight(*body))));
        btFemMaterial material;
        material.m_youngModulus = btScalar(1e7 * L);  // its weight strains it by .1 %
        material.m_density = 1000;
        material.m_stiffnessDamping = btScalar(0.005);
        m_world.fem().setMaterial(body, material);
        return m_world.addSoft(body);
    }

    Grounds m_grounds;
    FemWorld m_world;
    btRigidBody& m_ground;
};

// Kind, coupling, size [m], step [s].
class SharpFeatures : public testing::TestWithParam<std::tuple<GroundKind, Coupling, double, double>>
{
protected:
    static double size() { return std::get<2>(GetParam()); }
    static double step() { return std::get<3>(GetParam()); }
};

TEST_P(SharpFeatures, OfDroppedWedgesAndSpikesStayAboveTheGround)
{
    const double L = size(), h = step();
    for (const bool spike : {false, true})
        for (const double lean : {0.0, 0.2, 0.5})
        {
            SharpScene scene(std::get<0>(GetParam()), std::get<1>(GetParam()), L);
            const btQuaternion turn =
                btQuaternion(btVector3(0, 0, 1), btScalar(1 + lean)) * btQuaternion(btVector3(0, 1, 0), btScalar(lean));
            btSoftBody& body = scene.add(spike ? makeSpike(L) : makeWedge(L), L, turn, 0.1 * L);
            double lowest = 0, fastest = 0;
            const int count = static_cast<int>(25 * std::sqrt(L / kGravity) / h) + 30;
            for (int k = 0; k < count; ++k)
            {
                scene.m_world.step(1, btScalar(h));
                lowest = std::min(lowest, lowestHeight(body));
                if (k > count - 10) fastest = std::max(fastest, fastestNode(body));
            }
            const double force = scene.m_world.fem().contactForce(&body, &scene.m_ground).z();
            const std::string trace = std::string(spike ? "spike" : "wedge") + ", lean " + std::to_string(lean);
            // A tip on the common corner of four boxes sinks in until the face within the seam is known.
            const double depth = (std::get<0>(GetParam()) == GroundKind::compound ? 3e-3 : 2e-3) * L;
            EXPECT_GT(lowest, -depth) << trace;
            if (lean == 0) continue;  // it may still stand on its edge, or fall
            EXPECT_LT(fastest, 1e-2 * std::sqrt(kGravity * L)) << trace;
            EXPECT_NEAR(force / (massOf(body) * kGravity), 1, 0.01) << trace;
        }
}

// A tetrahedron whose upper edge is led down by .03 L towards the ground .02 L below its lower one.
TEST_P(SharpFeatures, OfALedBladeStopAtTheGround)
{
    const double L = size(), h = step();
    for (const double half : {0.1, 0.5})
    {
        SharpScene scene(std::get<0>(GetParam()), std::get<1>(GetParam()), L);
        const TetMesh blade({{-L, 0, 0}, {L, 0, 0}, {0, -half * L, L}, {0, half * L, L}}, {{0, 1, 2, 3}});
        btSoftBody& body = scene.add(blade, L, btQuaternion(btVector3(0, 0, 1), btScalar(0.4)), 0.02 * L);
        scene.m_world.fem().prepare(&body, btScalar(h));
        std::vector<std::pair<int, btVector3>> upper;
        for (int i = 0; i < 4; ++i)
            if (body.m_nodes[i].m_x.z() > 0.5 * L) upper.emplace_back(i, body.m_nodes[i].m_x);
        double lowest = 0;
        for (double t = h; t < 2.5; t += h)
        {
            for (const auto& [node, start] : upper)
                scene.m_world.fem().setNodeTarget(&body, node,
                                                  start - btVector3(0, 0, btScalar(L * std::min(0.03, 0.02 * t))));
            scene.m_world.step(1, btScalar(h));
            lowest = std::min(lowest, lowestHeight(body));
        }
        EXPECT_GT(lowest, -2e-2 * L) << half;  // until the factor has the targets
        EXPECT_NEAR(lowestHeight(body), 0, 1e-3 * L) << half;
        EXPECT_GT(scene.m_world.fem().contactForce(&body, &scene.m_ground).z(), 0) << half;
    }
}

INSTANTIATE_TEST_SUITE_P(Grounds, SharpFeatures,
                         testing::Combine(testing::Values(GroundKind::plane, GroundKind::box, GroundKind::hull,
                                                          GroundKind::compound, GroundKind::mesh,
                                                          GroundKind::coarseMesh, GroundKind::gimpact,
                                                          GroundKind::heightfield),
                                          testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(0.01, 0.1, 1.0, 4.0), testing::Values(1.0 / 60, 1.0 / 240)),
                         [](const auto& suite)
                         {
                             return std::string(nameOf(std::get<0>(suite.param))) + "_" +
                                    couplingName(std::get<1>(suite.param)) + "_" +
                                    std::to_string(std::lround(100 * std::get<2>(suite.param))) + "cm_" +
                                    nameOfStep(std::get<3>(suite.param));
                         });

}  // namespace
}  // namespace bullet_fem
