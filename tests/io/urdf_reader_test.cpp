// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "bullet_fem/io/urdf_deformable.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

const std::string kInertial = "<inertial><mass value='3'/></inertial>";

MATCHER(IsAscii, "")
{
    return std::all_of(arg.begin(), arg.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

class UrdfReader : public ::testing::Test
{
protected:
    UrdfReader() { m_folder.write("ball.vtk", "not read here"); }

    std::string write(const std::string& content)
    {
        return m_folder.write("body.urdf", "<?xml version='1.0'?>\n<robot name='r'>\n" + content + "\n</robot>\n");
    }
    UrdfDeformable read(const std::string& inBlock)
    {
        return readUrdfDeformable(write("<deformable name='ball'>" + inBlock + "</deformable>"));
    }
    std::string complaint(const std::string& inBlock)
    {
        return messageOf<std::runtime_error>([&] { read(inBlock); });
    }

    TemporaryFolder m_folder;
};

TEST_F(UrdfReader, TakesEveryValueOfTheBlock)
{
    const UrdfDeformable body = read(kInertial +
                                     "<collision_margin value='0.006'/><repulsion_stiffness value='800'/>"
                                     "<friction value=' 0.5 '/><gravity_factor value='-0.25'/>"
                                     "<neohookean mu='180' lambda='600' damping='0.01'/><visual filename='ball.vtk'/>");
    EXPECT_EQ(body.m_name, "ball");
    EXPECT_EQ(body.m_mass, 3);
    EXPECT_EQ(body.m_collisionMargin, 0.006);
    EXPECT_EQ(body.m_friction, 0.5);
    EXPECT_EQ(body.m_gravityFactor, -0.25);
    EXPECT_TRUE(body.m_elastic);
    EXPECT_DOUBLE_EQ(body.m_moduli.m_mu, 180);
    EXPECT_DOUBLE_EQ(body.m_moduli.m_lambda, 600);
    EXPECT_DOUBLE_EQ(body.m_damping, 0.01);
    EXPECT_EQ(body.m_meshPath, m_folder.path("ball.vtk"));
    EXPECT_EQ(body.m_visualPath, "");
}

TEST_F(UrdfReader, UsesPybulletsDefaults)
{
    const UrdfDeformable body = read(kInertial +
                                     "<spring elastic_stiffness='9' damping_stiffness='1'/>"
                                     "<visual filename='ball.vtk'/>");
    EXPECT_EQ(body.m_collisionMargin, 0.02);
    EXPECT_EQ(body.m_friction, 1);
    EXPECT_EQ(body.m_gravityFactor, 1);
    EXPECT_FALSE(body.m_elastic);
}

TEST_F(UrdfReader, AddsTwoLaws)
{
    const UrdfDeformable body = read(kInertial +
                                     "<corotated mu='100' lambda='50'/>"
                                     "<neohookean mu='400' lambda='500' damping='0.04'/><visual filename='ball.vtk'/>");
    EXPECT_DOUBLE_EQ(body.m_moduli.m_mu, 500);
    EXPECT_DOUBLE_EQ(body.m_moduli.m_lambda, 550);
    EXPECT_DOUBLE_EQ(body.m_damping, 0.032);  // that of 400 Pa of the 500 Pa
}

TEST_F(UrdfReader, DistinguishesSimulationMeshFromVisualMesh)
{
    m_folder.write("ball.obj", "not read here");
    const UrdfDeformable body =
        read(kInertial + "<visual filename='ball.obj'/><collision filename='package://ball.vtk'/>");
    EXPECT_EQ(body.m_meshPath, m_folder.path("ball.vtk"));
    EXPECT_EQ(body.m_visualPath, m_folder.path("ball.obj"));
}

TEST_F(UrdfReader, FindsMeshesInTheFoldersAbove)
{
    std::filesystem::create_directories(m_folder.path("a/b"));
    const std::string path = m_folder.write("a/b/body.urdf", "<robot name='r'><deformable name='x'>" + kInertial +
                                                                 "<visual filename='ball.vtk'/></deformable></robot>");
    EXPECT_TRUE(std::filesystem::equivalent(readUrdfDeformable(path).m_meshPath, m_folder.path("ball.vtk")));
}

TEST_F(UrdfReader, NamesFileLineAndFault)
{
    const std::string mesh = "<visual filename='ball.vtk'/>";
    EXPECT_THAT(complaint("\n" + mesh), AllOf(HasSubstr("body.urdf"), HasSubstr("line 3"), HasSubstr("<inertial>")));
    EXPECT_THAT(complaint("<inertial/>" + mesh), HasSubstr("a <mass> is missing"));
    EXPECT_THAT(complaint("<inertial>\n<mass value='-3'/></inertial>" + mesh),
                AllOf(HasSubstr("line 4"), HasSubstr("'-3'"), HasSubstr("above 0")));
    for (const char* bad : {"nan", "inf", "", "1e999", "3 kg", "0x3"})
        EXPECT_THAT(complaint(kInertial + "<friction value='" + bad + "'/>" + mesh), HasSubstr("at least 0")) << bad;
    EXPECT_THAT(complaint(kInertial + "<neohookean mu='1'/>" + mesh), HasSubstr("'lambda' is missing"));
    EXPECT_THAT(complaint(kInertial + "<corotated mu='0' lambda='1'/>" + mesh), HasSubstr("above 0"));
    EXPECT_THAT(complaint(kInertial), HasSubstr("names the mesh"));
    EXPECT_THAT(complaint(kInertial + "<visual filename='cube.vtk'/>"),
                AllOf(HasSubstr("cube.vtk"), HasSubstr("four folders above")));
}

TEST_F(UrdfReader, RefusesFilesOfOtherKinds)
{
    const auto told = [&](const std::string& path)
    { return messageOf<std::runtime_error>([&] { readUrdfDeformable(path); }); };
    EXPECT_THAT(told(m_folder.path("none.urdf")), AllOf(HasSubstr("none.urdf"), HasSubstr("no such file")));
    EXPECT_THAT(told(m_folder.path("")), HasSubstr("no such file"));
    EXPECT_THAT(told(m_folder.write("a.urdf", "o ball\nv 0 0 0\n")), HasSubstr("not XML"));
    EXPECT_THAT(told(m_folder.write("b.urdf", "")), HasSubstr("not XML"));
    EXPECT_THAT(told(m_folder.write("d.urdf", "<robot><\x1b[2J\xff")),
                AllOf(HasSubstr("line 1: it is not XML"), IsAscii()));
    EXPECT_THAT(complaint(kInertial + "<friction value='\x1b[2J'/><visual filename='ball.vtk'/>"),
                AllOf(HasSubstr("(unprintable bytes)"), IsAscii()));
    EXPECT_THAT(told(m_folder.write("c.urdf", "<sdf/>")), HasSubstr("<robot>"));
    EXPECT_THAT(told(write("<link name='a'/>")), HasSubstr("no <deformable>"));
    EXPECT_THAT(told(write("<reduced_deformable name='a'/>")), HasSubstr("reduced"));
}

}  // namespace
}  // namespace bullet_fem
