// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "io/temporary_folder.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

std::string vtkText(const TetMesh& mesh)
{
    std::ostringstream text;
    text << "# vtk DataFile Version 2.0\ncube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.nodeCount()
         << " double\n";
    for (const Vec3& x : mesh.restPositions()) text << x.x << ' ' << x.y << ' ' << x.z << '\n';
    text << "CELLS " << mesh.tetCount() << ' ' << 5 * mesh.tetCount() << '\n';
    for (const Tet& t : mesh.tets()) text << "4 " << t[0] << ' ' << t[1] << ' ' << t[2] << ' ' << t[3] << '\n';
    text << "CELL_TYPES " << mesh.tetCount() << '\n';
    for (int e = 0; e < mesh.tetCount(); ++e) text << "10\n";
    return text.str();
}

/// A cube of .5 m, loaded as a pybullet user would.
class UrdfBody : public ::testing::Test
{
protected:
    UrdfBody() : m_world(m_fem) { m_folder.write("cube.vtk", vtkText(makeBox({0.5, 0.5, 0.5}, {3, 3, 3}))); }

    std::string write(const std::string& values)
    {
        return m_folder.write(
            "cube.urdf", "<robot name='r'><deformable name='cube'><inertial><mass value='30'/></inertial>" + values +
                             "</deformable></robot>");
    }
    btSoftBody& load(const std::string& values, btScalar scale = 1)
    {
        return m_world.addSoft(btFemHelpers::createFromUrdf(m_world.info(), write(values).c_str(), m_material, scale));
    }

    TemporaryFolder m_folder;
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btFemMaterial m_material;
};

TEST_F(UrdfBody, HasThePropertiesOfTheFile)
{
    btSoftBody& cube = load(
        "<collision_margin value='0.006'/><friction value='0.75'/><gravity_factor value='0.5'/>"
        "<corotated mu='40000' lambda='60000'/><visual filename='cube.vtk'/>",
        2);
    EXPECT_EQ(cube.m_nodes.size(), 64);
    EXPECT_NEAR(cube.getTotalMass(), 30, 1e-5);
    EXPECT_NEAR(cube.getVolume(), 1, 1e-5);  // scaled by 2
    EXPECT_EQ(cube.getCollisionShape()->getMargin(), btScalar(0.006));
    EXPECT_EQ(cube.m_cfg.kDF, btScalar(0.75));
    EXPECT_EQ(cube.m_gravityFactor, btScalar(0.5));
    EXPECT_NEAR(m_material.m_youngModulus, 104000, 0.1);
    EXPECT_NEAR(m_material.m_poissonRatio, 0.3, 1e-6);
    EXPECT_EQ(m_material.m_stiffnessDamping, 0);
    EXPECT_EQ(m_material.m_density, 0);
}

// A file as Bullet's reduced_cube: with wrong sizes, and without types.
TEST_F(UrdfBody, HasTheMeshOfBulletsOwnData)
{
    std::string text = "#" + vtkText(makeBox({0.5, 0.5, 0.5}, {3, 3, 3})).substr(2);
    const std::size_t cells = text.find("CELLS 135 675"), types = text.find("CELL_TYPES");
    ASSERT_NE(cells, std::string::npos);
    text.replace(types, std::string::npos, "CELL_TYPES 10\n").replace(cells, 13, "CELLS 135 540");
    m_folder.write("cube_mesh.vtk", text);
    btSoftBody& cube = load(
        "<collision_margin value='0.006'/><repulsion_stiffness value='800.0'/><friction value= '0.5'/>"
        "<neohookean mu= '180' lambda= '600' damping= '0.01' /><visual filename='cube_mesh.vtk'/>");
    EXPECT_EQ(cube.m_tetras.size(), 135);
    EXPECT_NEAR(cube.getVolume(), 0.125, 1e-6);
}

TEST_F(UrdfBody, RestsWithItsWeightSqueezedAsItsModuliSay)
{
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& cube = load(
        "<friction value='0'/><neohookean mu='10000' lambda='10000' damping='0.02'/><visual filename='cube.vtk'/>");
    m_material.m_bending = btFemBending::plain;
    m_fem.setMaterial(&cube, m_material);
    std::vector<int> top;
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() > btScalar(0.499)) top.push_back(i);
    m_world.step(240);
    const double weight = 30 * kGravity;
    EXPECT_NEAR(m_fem.contactForce(&cube, &floor).z(), weight, 1e-3 * weight);
    double height = 0;
    for (const int i : top) height += double(cube.m_nodes[i].m_x.z()) / double(top.size());
    // E 25000 Pa; without friction the lower face widens freely.
    const double squeezed = weight / (0.5 * 0.5) * 0.5 / (2 * 25000);
    EXPECT_NEAR(0.5 - height, squeezed, 0.04 * squeezed);
}

TEST_F(UrdfBody, KeepsTheGivenMaterialIfTheFileHasNoModuli)
{
    m_material.m_youngModulus = 12345;
    load("<spring elastic_stiffness='1' damping_stiffness='1'/><visual filename='cube.vtk'/>");
    EXPECT_EQ(m_material.m_youngModulus, btScalar(12345));
    EXPECT_EQ(m_material.m_density, 0);
}

TEST_F(UrdfBody, CarriesTheVisualSurface)
{
    m_folder.write("skin.off", "OFF\n3 1 0\n.1 .1 .1\n.4 .1 .1\n.1 .4 .3\n3 0 1 2\n");
    btSoftBody& cube =
        load("<corotated mu='40000' lambda='60000'/><visual filename='skin.off'/><collision filename='cube.vtk'/>");
    m_fem.setMaterial(&cube, m_material);
    ASSERT_EQ(cube.m_renderNodes.size(), 3);
    ASSERT_EQ(cube.m_renderFaces.size(), 1);
    const btVector3 before = cube.m_renderNodes[2].m_x;
    m_world.step(30);
    const btVector3 fallen = cube.m_renderNodes[2].m_x - before;
    const double wanted = -kGravity * double(kStep) * double(kStep) * 30 * 30 / 2;
    EXPECT_NEAR(fallen.z(), wanted, 1e-4 * -wanted);
    EXPECT_NEAR(fallen.x(), 0, 1e-5);
}

TEST_F(UrdfBody, IsRefusedWithAReasonAndLeavesTheMaterialAlone)
{
    const auto told = [&](const std::string& values)
    {
        std::string why;
        EXPECT_EQ(btFemHelpers::createFromUrdf(m_world.info(), write(values).c_str(), m_material, 1, &why), nullptr);
        return why;
    };
    m_folder.write("skin.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(told("<visual filename='missing.vtk'/>"), HasSubstr("missing.vtk"));
    EXPECT_THAT(told("<visual filename='skin.obj'/>"), AllOf(HasSubstr("skin.obj"), HasSubstr(".vtk")));
    EXPECT_THAT(told("<corotated mu='1e14' lambda='0'/><visual filename='cube.vtk'/>"),
                AllOf(HasSubstr("Young"), HasSubstr("1e+13")));
    EXPECT_EQ(m_material.m_youngModulus, btScalar(1e6));
    EXPECT_THROW(btFemHelpers::createFromUrdf(m_world.info(), nullptr, m_material), std::invalid_argument);
    EXPECT_THROW(load("<visual filename='cube.vtk'/>", 0), std::invalid_argument);
}

}  // namespace
}  // namespace bullet_fem
