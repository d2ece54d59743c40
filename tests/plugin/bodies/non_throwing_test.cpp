// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The interface for engines without exceptions: this file is compiled with -fno-exceptions.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemDebugDraw.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemInterest.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "plugin/scenes/soft_world.h"

#ifdef __cpp_exceptions
#error "this file is to be compiled without exceptions"
#endif

namespace bullet_fem
{
namespace
{

const btScalar kNaN = std::numeric_limits<btScalar>::quiet_NaN();

class NonThrowing : public testing::Test
{
protected:
    /// Expects that the call fails, with this text in its reason.
    template <class Call>
    void expectRefused(const Call& call, const char* reason)
    {
        std::string why;
        EXPECT_FALSE(call(&why));
        EXPECT_NE(why.find(reason), std::string::npos) << why;
    }

    template <class Call>
    void expectDone(const Call& call)
    {
        std::string why;
        EXPECT_TRUE(call(&why)) << why;
        EXPECT_EQ(why, "");
    }

    btSoftBody* makeCube()
    {
        return btFemHelpers::createBox(m_world.info(), btVector3(0, 0, 2), btVector3(1, 1, 1) * btScalar(0.5),
                                       btScalar(0.5), nullptr);
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem};
    btSoftBody& m_cube = m_world.addSoft(makeCube());
    const btVector3 m_place = btVector3(0, 0, 1);
    const int m_node = 3;
};

TEST_F(NonThrowing, CallsOnInvalidBodiesTellWhy)
{
    expectRefused([&](std::string* why) { return m_fem.setMaterial(nullptr, btFemMaterial(), why); }, "null");
    btFemMaterial hard;
    hard.m_poissonRatio = btScalar(0.6);
    expectRefused([&](std::string* why) { return m_fem.setMaterial(&m_cube, hard, why); }, "0.6");
    expectRefused([&](std::string* why) { return m_fem.setDetail(nullptr, btFemDetail::direct, why); }, "null");
    expectRefused([&](std::string* why) { return m_fem.prepare(&m_cube, -1, why); }, "step");
    expectRefused([&](std::string* why) { return m_fem.refactor(&m_cube, why); }, "prepare");
    expectRefused([&](std::string* why) { return m_fem.setContactOffset(&m_cube, kNaN, why); }, "[0, 1000]");
    btFemDetailPolicy policy;
    policy.m_dwell = -1;
    expectRefused([&](std::string* why) { return m_fem.setInterest(nullptr, policy, why); }, "-1");
}

TEST_F(NonThrowing, ActuatorCallsTellWhy)
{
    expectRefused([&](std::string* why) { return m_fem.addChamber(&m_cube, {}, why); }, "prepare");
    m_fem.prepare(&m_cube, btScalar(0.01));
    expectRefused([&](std::string* why) { return m_fem.addChamber(&m_cube, {}, why); }, "0 triangles");
    expectRefused([&](std::string* why) { return m_fem.addCable(&m_cube, {}, why); }, "0 points");
    expectRefused([&](std::string* why) { return m_fem.addFibres(&m_cube, {}, why); }, "0 directions");
    btFemExpansion expansion;
    expansion.m_strain = kNaN;
    expectRefused([&](std::string* why) { return m_fem.addExpansion(&m_cube, expansion, why); }, "[-0.9, 9]");
    expectRefused([&](std::string* why) { return m_fem.sealChamber(&m_cube, 7, why); }, "no chamber 7");
    expectDone([&](std::string* why) { return m_fem.removeActuator(&m_cube, 7, why); });
    std::vector<btFemChamber> cavities;
    expectDone([&](std::string* why) { return btFemChamber::find(&m_cube, cavities, why); });
    EXPECT_TRUE(cavities.empty());
    expectRefused([&](std::string* why) { return btFemChamber::find(nullptr, cavities, why); }, "null");
}

TEST_F(NonThrowing, TargetAndSpringCallsTellWhy)
{
    btFemSpring spring;
    expectRefused([&](std::string* why) { return m_fem.setNodeTarget(&m_cube, m_node, m_place, why); }, "prepare");
    ASSERT_TRUE(m_fem.prepare(&m_cube, kStep, nullptr));
    const int far = 1000;
    expectRefused([&](std::string* why) { return m_fem.setNodeTarget(&m_cube, far, m_place, why); }, "1000");
    expectRefused([&](std::string* why) { return m_fem.clearNodeTarget(&m_cube, far, why); }, "1000");
    expectRefused([&](std::string* why) { return m_fem.setNodeTargets(&m_cube, &far, 1, &m_place, why); }, "1000");
    expectRefused([&](std::string* why)
                  { return m_fem.setNodeTargets(&m_cube, &far, 1, btTransform::getIdentity(), why); },
                  "1000");
    expectRefused([&](std::string* why) { return m_fem.clearNodeTargets(&m_cube, &far, 1, why); }, "1000");
    expectRefused([&](std::string* why) { return m_fem.attachNodes(&m_cube, far, &m_cube, 0, why); }, "1000");
    expectRefused([&](std::string* why) { return m_fem.attachNodeToTet(&m_cube, 0, &m_cube, -1, nullptr, why); }, "-1");
    expectRefused([&](std::string* why) { return m_fem.detach(nullptr, 1, why); }, "detach");
    spring.m_stiffness = -1;
    expectRefused([&](std::string* why) { return m_fem.addSpring(&m_cube, spring, why); }, "-1");
    expectRefused([&](std::string* why) { return m_fem.setSpringTarget(&m_cube, 77, m_place, why); }, "77");
    expectRefused([&](std::string* why) { return m_fem.removeSpring(nullptr, 1, why); }, "removeSpring");
}

TEST_F(NonThrowing, HelpersReturnNull)
{
    const auto isMade = [](btSoftBody* body) { return std::unique_ptr<btSoftBody>(body) != nullptr; };
    btSoftBodyWorldInfo& info = m_world.info();
    const btVector3 half(1, 1, 1);
    expectRefused([&](std::string* why) { return isMade(btFemHelpers::createBox(info, half, half, -1, why)); },
                  "createBox");
    expectRefused([&](std::string* why)
                  { return isMade(btFemHelpers::createFromTetMesh(info, nullptr, 0, nullptr, 0, why)); },
                  "nodes");
    expectRefused([&](std::string* why) { return isMade(btFemHelpers::createFromTetMesh(info, TetMesh(), why)); },
                  "empty");
    expectRefused([&](std::string* why)
                  { return isMade(btFemHelpers::createFromSurface(info, SurfaceMesh(), CageSettings(), why)); },
                  "");
    CageReport report;
    expectRefused([&](std::string* why)
                  { return isMade(btFemHelpers::createFromSurface(info, SurfaceMesh(), CageSettings(), report, why)); },
                  "0 triangles");
#ifdef BULLETFEM_TESTS_HAVE_FILES
    expectRefused([&](std::string* why)
                  { return isMade(btFemHelpers::createFromSurfaceFile(info, "missing.off", 1, 1, why)); },
                  "missing.off");
#endif
}

TEST_F(NonThrowing, ConstructorArgumentsAreValidatedBeforehand)
{
    expectRefused([&](std::string* why) { return btFemConstraintSolver::valid(nullptr, why); }, "null");
    expectDone([&](std::string* why) { return btFemConstraintSolver::valid(&m_fem, why); });
    expectRefused([&](std::string* why) { return btFemViewerInterest::valid(10, 5, why); }, "near < far");
    expectRefused([&](std::string* why) { return btFemViewerInterest::valid(kNaN, 5, why); }, "nan");
    expectRefused([&](std::string* why) { return btFemViewerInterest::valid(0, 1 / btScalar(0), why); }, "inf");
    expectDone([&](std::string* why) { return btFemViewerInterest::valid(10, 100, why); });
    btFemSolverInfo info;
    info.m_threads = -1;
    expectRefused([&](std::string* why) { return info.valid(why); }, "-1");
}

TEST_F(NonThrowing, DrawingCallsTellWhy)
{
    btFemDrawSettings settings;
    const auto draw = [&](std::string* why)
    { return btFemDebugDraw::draw(m_fem, &m_cube, nullptr, BT_FEM_DRAW_ELEMENTS, settings, why); };
    expectDone(draw);
    settings.m_shrink = 0;
    expectRefused(draw, "m_shrink");
}

TEST_F(NonThrowing, CallsHaveTheirUsualEffect)
{
    expectDone([&](std::string* why) { return m_fem.setMaterial(&m_cube, btFemMaterial(), why); });
    expectDone([&](std::string* why) { return m_fem.setDetail(&m_cube, btFemDetail::automatic, why); });
    expectDone([&](std::string* why) { return m_fem.setInterest(nullptr, btFemDetailPolicy(), why); });
    expectDone([&](std::string* why) { return m_fem.prepare(&m_cube, kStep, why); });
    EXPECT_TRUE(m_fem.isFem(&m_cube));
    expectDone([&](std::string* why) { return m_fem.refactor(&m_cube, why); });
    expectDone([&](std::string* why) { return m_fem.setContactOffset(&m_cube, 0, why); });
    expectDone([&](std::string* why) { return m_fem.setNodeTarget(&m_cube, m_node, m_place, why); });
    m_world.step();
    EXPECT_LT(m_cube.m_nodes[m_node].m_x.distance(m_place), btScalar(1e-6));
    expectDone([&](std::string* why) { return m_fem.clearNodeTarget(&m_cube, m_node, why); });
    const int first = m_fem.attachNodes(&m_cube, 0, &m_cube, 1, nullptr);
    EXPECT_GT(first, 0);
    expectDone([&](std::string* why) { return m_fem.detach(&m_cube, first, why); });
    const int spring = m_fem.addSpring(&m_cube, btFemSpring(), nullptr);
    EXPECT_GT(spring, 0);
    expectDone([&](std::string* why) { return m_fem.setSpringTarget(&m_cube, spring, m_place, why); });
    expectDone([&](std::string* why) { return m_fem.removeSpring(&m_cube, spring, why); });
}

}  // namespace
}  // namespace bullet_fem
