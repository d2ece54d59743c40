// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <memory>
#include <string>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "fem/scenes/expect_rejected.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

const btScalar kNotANumber = std::numeric_limits<btScalar>::quiet_NaN();

TEST(RejectedMaterial, NamesValueAndRange)
{
    const struct
    {
        btScalar btFemMaterial::*m_member;
        btScalar m_value;
        const char* m_says;
    } cases[] = {{&btFemMaterial::m_youngModulus, 0, "oung"},
                 {&btFemMaterial::m_youngModulus, btScalar(2e13), "oung"},
                 {&btFemMaterial::m_youngModulus, kNotANumber, "oung"},
                 {&btFemMaterial::m_poissonRatio, btScalar(-0.1), "oisson"},
                 {&btFemMaterial::m_poissonRatio, btScalar(0.5), "oisson"},
                 {&btFemMaterial::m_density, -1, "ensity"},
                 {&btFemMaterial::m_density, btScalar(2e6), "ensity"},
                 {&btFemMaterial::m_massDamping, btScalar(-0.5), "amping"},
                 {&btFemMaterial::m_massDamping, btScalar(2e4), "amping"},
                 {&btFemMaterial::m_stiffnessDamping, -1, "amping"},
                 {&btFemMaterial::m_stiffnessDamping, 11, "amping"}};
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& cube =
        world.addSoft(btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(1, 1, 1), btScalar(1)));
    const btScalar inverseMass = cube.m_nodes[0].m_im;
    for (const auto& bad : cases)
    {
        btFemMaterial material;
        material.m_density = 500;
        material.*bad.m_member = bad.m_value;
        std::string why;
        EXPECT_FALSE(material.valid(&why));
        EXPECT_NE(why.find(bad.m_says), std::string::npos) << why;
        EXPECT_FALSE(material.valid());
        expectRejected([&] { fem.setMaterial(&cube, material); }, {bad.m_says, "["});
        EXPECT_EQ(cube.m_nodes[0].m_im, inverseMass);  // unchanged
    }
}

TEST(RejectedMaterial, LimitsAndPresetsAreAccepted)
{
    btFemMaterial material;
    material.m_poissonRatio = btScalar(0.499);
    material.m_density = 0;
    material.m_stiffnessDamping = 0;
    std::string why;
    EXPECT_TRUE(material.valid(&why)) << why;
    for (const btFemMaterial& preset :
         {btFemMaterial::rubber(), btFemMaterial::foam(), btFemMaterial::jelly(), btFemMaterial::flesh(),
          btFemMaterial::wood(), btFemMaterial::clay(), btFemMaterial::lead(), btFemMaterial::mildFoam()})
        EXPECT_TRUE(preset.valid(&why)) << why;
}

TEST(RejectedMaterial, HardnessAndLossFactorNameValueAndRange)
{
    expectRejected([] { btFemMaterial::shoreA(5); }, {"hardness [Shore A] is 5, outside [10, 95]"});
    expectRejected([] { btFemMaterial::shoreD(80); }, {"hardness [Shore D] is 80, outside [30, 70]"});
    std::string why;
    EXPECT_EQ(btFemMaterial::shoreA(kNotANumber, &why).m_youngModulus, btFemMaterial().m_youngModulus);
    EXPECT_NE(why.find("nan"), std::string::npos);
    btFemMaterial material;
    expectRejected([&] { material.setLossFactor(3, 10); }, {"loss factor [-] is 3, outside [0, 2]"});
    EXPECT_FALSE(material.setLossFactor(btScalar(.1), 0, &why));
    EXPECT_NE(why.find("frequency of the loss factor [Hz] is 0"), std::string::npos) << why;
    EXPECT_EQ(material.m_stiffnessDamping, btFemMaterial().m_stiffnessDamping);
}

TEST(ElastomerMaterial, HasHardnessAndLossFactor)
{
    const btFemMaterial rubber = btFemMaterial::shoreA(40);
    EXPECT_NEAR(rubber.m_youngModulus / 1.689639e6, 1, 1e-5);
    EXPECT_EQ(rubber.m_poissonRatio, btScalar(.499));
    EXPECT_NEAR(rubber.lossFactor(10), .1, 1e-6);
    EXPECT_TRUE(rubber.valid());
    btFemMaterial foam = btFemMaterial::foam();
    EXPECT_TRUE(foam.setLossFactor(btScalar(.2), 50));
    EXPECT_NEAR(foam.lossFactor(50), .2, 1e-6);
    EXPECT_NEAR(foam.lossFactor(100), .4, 1e-6);
    EXPECT_GT(btFemMaterial::shoreD(50).m_youngModulus, rubber.m_youngModulus);
}

TEST(RejectedMaterial, AccurateBendingNeedsMeanDilatationUnderEveryLaw)
{
    for (btFemMaterial material : {btFemMaterial::jelly(), btFemMaterial::rubber()})
    {
        material.m_bending = btFemBending::accurate;
        std::string why;
        EXPECT_TRUE(material.valid(&why)) << why;
        material.m_meanDilatation = btFemMeanDilatation::off;
        EXPECT_FALSE(material.valid(&why));
        EXPECT_EQ(why, "accurate bending does not go with mean dilatation off; take automatic or on");
    }
}

template <typename Member, typename Value>
void expectBadInfo(Member member, Value value, const char* name)
{
    btFemSolverInfo info;
    info.*member = value;
    std::string why;
    EXPECT_FALSE(info.valid(&why));
    EXPECT_NE(why.find(name), std::string::npos) << why;
    expectRejected([&] { btFemSoftBodySolver fem(info); }, {name, "[", "usual"});
}

TEST(RejectedSolverInfo, NamesValueAndRange)
{
    expectBadInfo(&btFemSolverInfo::m_tolerance, btScalar(0), "m_tolerance");
    expectBadInfo(&btFemSolverInfo::m_tolerance, btScalar(1), "m_tolerance");
    expectBadInfo(&btFemSolverInfo::m_tolerance, kNotANumber, "m_tolerance");
    expectBadInfo(&btFemSolverInfo::m_maxIterations, 0, "m_maxIterations");
    expectBadInfo(&btFemSolverInfo::m_maxIterations, 20000, "m_maxIterations");
    expectBadInfo(&btFemSolverInfo::m_contactRounds, 0, "m_contactRounds");
    expectBadInfo(&btFemSolverInfo::m_contactRounds, 11, "m_contactRounds");
    expectBadInfo(&btFemSolverInfo::m_contactTolerance, 0, "m_contactTolerance");
    expectBadInfo(&btFemSolverInfo::m_contactTolerance, btScalar(0.2), "m_contactTolerance");
    expectBadInfo(&btFemSolverInfo::m_contactSweeps, 0, "m_contactSweeps");
    expectBadInfo(&btFemSolverInfo::m_contactSweeps, 1001, "m_contactSweeps");
    expectBadInfo(&btFemSolverInfo::m_maxContacts, 7, "m_maxContacts");
    expectBadInfo(&btFemSolverInfo::m_maxFactorMegabytes, btScalar(-1), "m_maxFactorMegabytes");
    expectBadInfo(&btFemSolverInfo::m_maxFactorMegabytes, btScalar(2e6), "m_maxFactorMegabytes");
    expectBadInfo(&btFemSolverInfo::m_maxContacts, 20001, "m_maxContacts");
    expectBadInfo(&btFemSolverInfo::m_erp, btScalar(-0.1), "m_erp");
    expectBadInfo(&btFemSolverInfo::m_erp, btScalar(1.1), "m_erp");
    expectBadInfo(&btFemSolverInfo::m_erp, kNotANumber, "m_erp");
    expectBadInfo(&btFemSolverInfo::m_maxPushVelocity, btScalar(-1), "m_maxPushVelocity");
    expectBadInfo(&btFemSolverInfo::m_maxPushVelocity, btScalar(1001), "m_maxPushVelocity");
    EXPECT_TRUE(btFemSolverInfo().valid());
}

class RejectedCall : public testing::Test
{
protected:
    btSoftBody* makeCube()
    {
        return btFemHelpers::createBox(m_world.info(), btVector3(0, 0, 0), btVector3(1, 1, 1), btScalar(1));
    }
    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem};
};

// The body is left to Bullet, and the message has the size; a smaller body is stepped.
TEST(RejectedSize, NamesTheFactorSizeAndTheLimit)
{
    btFemSolverInfo info;
    info.m_maxFactorMegabytes = btScalar(0.5);
    btFemSoftBodySolver fem(info);
    SoftWorld world(fem);
    btSoftBody& large = world.addSoft(btFemHelpers::createBox(world.info(), {0, 0, 0}, {1, 1, 1}, btScalar(0.25)));
    btSoftBody& small = world.addSoft(btFemHelpers::createBox(world.info(), {3, 0, 0}, {1, 1, 1}, btScalar(0.5)));
    world.step();
    EXPECT_FALSE(fem.isFem(&large));
    EXPECT_TRUE(fem.isFem(&small));
    const std::string message = fem.stepReport(&large).m_message;
    for (const char* part : {"factor", "more than the limit of 500000", "coarser"})
        EXPECT_NE(message.find(part), std::string::npos) << message;
}

// With the low-memory path allowed the body is stepped, and reports the path.
TEST(RejectedSize, IsAvoidedByTheLowMemoryPath)
{
    btFemSolverInfo info;
    info.m_maxFactorMegabytes = btScalar(0.2);
    info.m_factorChoice = btFemFactorChoice::lowMemoryBeyond;
    btFemSoftBodySolver fem(info);
    SoftWorld world(fem);
    btSoftBody& large = world.addSoft(btFemHelpers::createBox(world.info(), {0, 0, 0}, {1, 1, 1}, btScalar(0.25)));
    btSoftBody& small = world.addSoft(btFemHelpers::createBox(world.info(), {3, 0, 0}, {1, 1, 1}, btScalar(0.5)));
    world.step();
    EXPECT_TRUE(fem.isFem(&large));
    const btFemStepReport low = fem.stepReport(&large), full = fem.stepReport(&small);
    EXPECT_TRUE(low.m_lowMemory);
    EXPECT_GT(low.m_factorMegabytes, 0);
    EXPECT_LE(low.m_factorMegabytes, info.m_maxFactorMegabytes);
    EXPECT_GT(low.m_fullFactorMegabytes, info.m_maxFactorMegabytes);
    EXPECT_FALSE(full.m_lowMemory);
    EXPECT_EQ(full.m_factorMegabytes, full.m_fullFactorMegabytes);
    EXPECT_LE(low.m_residual, info.m_tolerance);
}

TEST(RejectedSize, ReportsAnUnknownChoice)
{
    expectBadInfo(&btFemSolverInfo::m_factorChoice, static_cast<btFemFactorChoice>(7), "m_factorChoice");
}

TEST_F(RejectedCall, ReportsNullBodies)
{
    expectRejected([&] { m_fem.setMaterial(nullptr, btFemMaterial()); }, {"null", "btFemHelpers"});
    expectRejected([&] { m_fem.setDetail(nullptr, btFemDetail::direct); }, {"null"});
    expectRejected([&] { m_fem.prepare(nullptr, kStep); }, {"null"});
    expectRejected([&] { m_fem.refactor(nullptr); }, {"refactor", "prepare"});
    expectRejected([&] { m_fem.setNodeTarget(nullptr, 0, btVector3(0, 0, 0)); }, {"setNodeTarget"});
    expectRejected([&] { m_fem.clearNodeTarget(nullptr, 0); }, {"clearNodeTarget"});
    expectRejected([&] { m_fem.setContactOffset(nullptr, 0); }, {"null"});
    m_fem.forget(nullptr);
    EXPECT_FALSE(m_fem.isFem(nullptr));
    EXPECT_EQ(m_fem.stepReport(nullptr).m_nodes, 0);
    EXPECT_STREQ(m_fem.stepReport(nullptr).m_message, "");
    EXPECT_EQ(m_fem.contacts(nullptr).size(), 0);
    EXPECT_EQ(m_fem.contactForce(nullptr, nullptr), btVector3(0, 0, 0));
}

TEST_F(RejectedCall, ReportsCloths)
{
    const std::unique_ptr<btSoftBody> cloth(btSoftBodyHelpers::CreatePatch(m_world.info(), btVector3(-1, -1, 0),
                                                                           btVector3(1, -1, 0), btVector3(-1, 1, 0),
                                                                           btVector3(1, 1, 0), 3, 3, 0, true));
    expectRejected([&] { m_fem.setMaterial(cloth.get(), btFemMaterial()); }, {"tetrahedra", "btFemHelpers"});
    expectRejected([&] { m_fem.prepare(cloth.get(), kStep); }, {"tetrahedra"});
    expectRejected([&] { m_fem.refactor(cloth.get()); }, {"refactor"});
    expectRejected([&] { m_fem.setNodeTarget(cloth.get(), 0, btVector3(0, 0, 0)); }, {"setNodeTarget"});
    m_fem.setDetail(cloth.get(), btFemDetail::globalWarp);  // has no effect
    EXPECT_FALSE(m_fem.isFem(cloth.get()));
}

TEST_F(RejectedCall, SetMaterialOnABadMeshNamesTheElement)
{
    const btVector3 flat[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    btSoftBody body(&m_world.info(), 4, flat, nullptr);
    body.appendTetra(0, 1, 2, 3);
    expectRejected([&] { m_fem.setMaterial(&body, btFemMaterial()); }, {"element 0"});
    expectRejected([&] { m_fem.prepare(&body, kStep); }, {"element 0"});
}

TEST_F(RejectedCall, ReportsBadStepsOfPrepare)
{
    const std::unique_ptr<btSoftBody> cube(makeCube());
    for (const btScalar step : {btScalar(0), btScalar(-1), btScalar(1.5), btScalar(1e-7), kNotANumber})
        expectRejected([&] { m_fem.prepare(cube.get(), step); }, {"step", "1e-6", "1"});
    m_fem.prepare(cube.get(), kStep);
    EXPECT_TRUE(m_fem.isFem(cube.get()));
}

TEST_F(RejectedCall, ReportsNodeTargetsOutOfRange)
{
    const std::unique_ptr<btSoftBody> cube(makeCube());
    m_fem.prepare(cube.get(), kStep);
    const int count = cube->m_nodes.size();
    for (const int node : {-1, count, 1000})
    {
        expectRejected([&] { m_fem.setNodeTarget(cube.get(), node, btVector3(0, 0, 0)); },
                       {std::to_string(node).c_str(), std::to_string(count).c_str()});
        expectRejected([&] { m_fem.clearNodeTarget(cube.get(), node); }, {std::to_string(node).c_str()});
    }
    expectRejected([&] { m_fem.setNodeTarget(cube.get(), 2, btVector3(0, kNotANumber, 0)); }, {"node 2", "finite"});
}

TEST_F(RejectedCall, ReportsContactOffsetsOutOfRange)
{
    const std::unique_ptr<btSoftBody> cube(makeCube());
    expectRejected([&] { m_fem.setContactOffset(cube.get(), btScalar(-0.5)); }, {"-0.5", "[0, 1000]"});
    expectRejected([&] { m_fem.setContactOffset(cube.get(), 2000); }, {"2000", "[0, 1000]"});
    expectRejected([&] { m_fem.setContactOffset(cube.get(), kNotANumber); }, {"nan", "[0, 1000]"});
}

TEST_F(RejectedCall, ReportsBadBoxesAndMeshesOfHelpers)
{
    btSoftBodyWorldInfo& info = m_world.info();
    const btVector3 center(0, 0, 0);
    expectRejected([&] { btFemHelpers::createBox(info, center, btVector3(1, 0, 1), 1); },
                   {"createBox", "half extent 0"});
    expectRejected([&] { btFemHelpers::createBox(info, center, btVector3(1, -1, 1), 1); }, {"createBox", "-1"});
    expectRejected([&] { btFemHelpers::createBox(info, center, btVector3(1, 1, 1), 0); }, {"createBox", "> 0"});
    expectRejected([&] { btFemHelpers::createBox(info, center, btVector3(1, 1, 1), kNotANumber); },
                   {"createBox", "nan"});
    expectRejected([&] { btFemHelpers::createBox(info, center, btVector3(1, 1, 1), btScalar(1e-4)); }, {"1000 cells"});
    expectRejected([&] { btFemHelpers::createBox(info, btVector3(kNotANumber, 0, 0), btVector3(1, 1, 1), 1); },
                   {"finite"});

    const btVector3 x[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int good[] = {0, 1, 2, 3}, outside[] = {0, 1, 2, 4};
    expectRejected([&] { btFemHelpers::createFromTetMesh(info, nullptr, 4, good, 1); }, {"createFromTetMesh", "null"});
    expectRejected([&] { btFemHelpers::createFromTetMesh(info, x, 4, nullptr, 1); }, {"createFromTetMesh", "null"});
    expectRejected([&] { btFemHelpers::createFromTetMesh(info, x, 3, good, 1); }, {"3 nodes", "4"});
    expectRejected([&] { btFemHelpers::createFromTetMesh(info, x, 4, good, 0); }, {"0 tets"});
    expectRejected([&] { btFemHelpers::createFromTetMesh(info, x, 4, outside, 1); }, {"element 0", "4"});
    expectRejected([&] { btFemHelpers::createFromTetMesh(info, TetMesh()); }, {"empty"});
}

TEST_F(RejectedCall, ReportsBadSurfacesOfHelpers)
{
    btSoftBodyWorldInfo& info = m_world.info();
    SurfaceMesh triangle;
    triangle.m_vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.m_triangles = {{0, 1, 2}};
    CageSettings settings;
    settings.m_cellSize = 0.25;
    expectRejected([&] { btFemHelpers::createFromSurface(info, triangle, settings); }, {"inside"});
    expectRejected([&] { btFemHelpers::createFromSurfaceFile(info, nullptr, btScalar(0.1)); }, {"path", "null"});
    std::string text = "nothing was thrown";
    try
    {
        btFemHelpers::createFromSurfaceFile(info, "/nonexistent/bunny.obj", btScalar(0.1));
    }
    catch (const std::runtime_error& error)
    {
        text = error.what();
    }
    EXPECT_NE(text.find("/nonexistent/bunny.obj"), std::string::npos) << text;
}

TEST_F(RejectedCall, ReportsABadCellSizeOrScaleOfASurfaceFile)
{
    const std::string path = testing::TempDir() + "bulletfem_rejected_tetrahedron.off";
    std::FILE* file = std::fopen(path.c_str(), "w");
    ASSERT_NE(file, nullptr);
    std::fputs("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n", file);
    std::fclose(file);
    btSoftBodyWorldInfo& info = m_world.info();
    for (const btScalar cell : {btScalar(0), btScalar(-1), kNotANumber})
        expectRejected([&] { btFemHelpers::createFromSurfaceFile(info, path.c_str(), cell); }, {"cell"});
    expectRejected([&] { btFemHelpers::createFromSurfaceFile(info, path.c_str(), btScalar(1e-4)); }, {"cell"});
    for (const btScalar scale : {btScalar(0), btScalar(-2), kNotANumber})
        expectRejected([&] { btFemHelpers::createFromSurfaceFile(info, path.c_str(), btScalar(0.25), scale); },
                       {"scale"});
    const std::unique_ptr<btSoftBody> body(btFemHelpers::createFromSurfaceFile(info, path.c_str(), btScalar(0.25)));
    EXPECT_EQ(body->m_renderNodes.size(), 4);
    std::remove(path.c_str());
}

}  // namespace
}  // namespace bullet_fem
