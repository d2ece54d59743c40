// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors

// Files written by Gmsh itself, if it is installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/fem/step/stepping.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

class GmshFiles : public testing::Test
{
protected:
    void SetUp() override
    {
        if (std::system("command -v gmsh >/dev/null") != 0) GTEST_SKIP() << "Gmsh is not installed";
        m_folder.write("two.geo",
                       "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 2, 3};\n"
                       "Cylinder(2) = {3, 0, 0, 0, 0, 1, 0.5};\nMesh.CharacteristicLengthMax = 0.4;\n");
        ASSERT_TRUE(run("-3 -format msh41 -o first.msh two.geo"));
        m_first = read("first.msh");
    }

    /// Runs Gmsh in the folder, with its output redirected to a file there.
    bool run(const std::string& arguments) const
    {
        return std::system(("cd '" + m_folder.path("") + "' && gmsh " + arguments + " >log 2>&1").c_str()) == 0;
    }
    /// Converts the first file with Gmsh, and reads the result.
    TetMeshFile convert(const std::string& options, const std::string& name) const
    {
        EXPECT_TRUE(run("first.msh -save " + options + " -o " + name)) << m_folder.read("log");
        return read(name);
    }
    TetMeshFile read(const std::string& name) const { return readTetMeshFile(m_folder.path(name)); }

    void expectFirst(const TetMeshFile& mesh, double tolerance) const
    {
        EXPECT_EQ(mesh.m_tets, m_first.m_tets);
        ASSERT_EQ(mesh.m_positions.size(), m_first.m_positions.size());
        for (std::size_t i = 0; i < mesh.m_positions.size(); ++i)
            ASSERT_LE(norm(mesh.m_positions[i] - m_first.m_positions[i]), tolerance) << i;
    }

    TemporaryFolder m_folder;
    TetMeshFile m_first;
};

TEST_F(GmshFiles, AreTheSameMeshInEveryFormat)
{
    const TetMesh mesh = m_first.mesh();
    EXPECT_GT(mesh.tetCount(), 200);
    EXPECT_EQ(mesh.componentCount(), 2);
    EXPECT_GT(mesh.volume(), 6.6);  // 6 of the box, and an inscribed polyhedron of the cylinder
    EXPECT_LT(mesh.volume(), 6 + 3.1416 / 4);
    EXPECT_GT(m_first.m_skippedFaces, 100u);

    expectFirst(convert("-format msh41 -bin", "b41.msh"), 0);
    expectFirst(convert("-format msh41 -save_parametric", "p41.msh"), 0);
    expectFirst(convert("-format msh41 -save_parametric -bin", "pb41.msh"), 0);
    expectFirst(convert("-format msh1", "a1.msh"), 0);
    expectFirst(convert("-format msh22", "a22.msh"), 0);
    expectFirst(convert("-format msh22 -bin", "b22.msh"), 0);
    expectFirst(convert("-format vtk", "a.vtk"), 0);
    expectFirst(convert("-format vtk -bin", "b.vtk"), 0);
    expectFirst(convert("-format mesh", "a.mesh"), 1e-12);  // written with 14 digits
}

TEST_F(GmshFiles, Version40ConvertsAsTheErrorSays)
{
    // Gmsh calls version 4.0 just 4.
    ASSERT_TRUE(run("first.msh -save -format msh40 -o OLD.msh"));
    const std::string error = messageOf<std::runtime_error>([&] { read("OLD.msh"); });
    const std::string remedy = "gmsh OLD.msh -save -format msh41 -o NEW.msh";
    EXPECT_THAT(error, AllOf(HasSubstr("line 2: MSH version 4 cannot be read"), HasSubstr(remedy)));
    ASSERT_TRUE(run(remedy.substr(5)));
    expectFirst(read("NEW.msh"), 0);
}

TEST_F(GmshFiles, SecondOrderMeshesAreRejected)
{
    for (const char* format : {"msh41", "msh22"})
    {
        ASSERT_TRUE(run(std::string("-3 -order 2 -format ") + format + " -bin -o second.msh two.geo"));
        EXPECT_THAT(messageOf<std::runtime_error>([&] { read("second.msh"); }),
                    AllOf(HasSubstr("byte "), HasSubstr("a tetrahedron of second order (10 nodes)")));
    }
    ASSERT_TRUE(run("-3 -order 2 -format vtk -o second.vtk two.geo"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { read("second.vtk"); }), HasSubstr("a quadratic tetrahedron"));
}

/// A bar of 10 x 1 x 1 m, meshed by Gmsh with the given cell size [m].
class GmshBar : public GmshFiles
{
protected:
    TetMesh bar(const std::string& cell) const
    {
        m_folder.write("bar.geo",
                       "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 10, 1, 1};\n"
                       "Mesh.CharacteristicLengthMin = " +
                           cell + ";\nMesh.CharacteristicLengthMax = " + cell + ";\n");
        EXPECT_TRUE(run("-3 -format msh2 -o bar.msh bar.geo")) << m_folder.read("log");
        return read("bar.msh").mesh();
    }

    // Tip deflection over Timoshenko's under a small load, distributed over the end's nodes. A step of 1 s from rest
    // reaches the equilibrium, because the body's periods are far shorter.
    static double tip(const TetMesh& mesh, double nu, bool isAccurate)
    {
        Material material;
        material.m_poissonRatio = nu;
        material.m_density = 1;
        material.m_bending = isAccurate ? Bending::accurate : Bending::plain;
        FactorInput input;
        input.m_step = 1;
        const auto shape = std::make_shared<const RestShape>(mesh, material);
        input.m_mass = shape->m_lumpedMass;
        for (const Vec3& X : mesh.restPositions()) input.m_fixed.push_back(std::fabs(X.x) < 1e-9);
        Body body(BodyModel::create(shape, input));
        std::vector<int> end;
        for (int i = 0; i < mesh.nodeCount(); ++i)
            if (std::fabs(mesh.restPositions()[i].x - 10) < 1e-9) end.push_back(i);
        const double load = 1e-2;  // [N]
        for (const int i : end) body.m_loads.m_force[i].z = -load / static_cast<double>(end.size());
        StepSettings settings;
        settings.m_step = 1;
        settings.m_tolerance = 1e-9;
        for (int k = 0; k < 3; ++k)
        {
            for (Vec3& v : body.m_state.m_v) v = {};
            step(body, settings);
        }
        double sum = 0;
        for (const int i : end) sum += mesh.restPositions()[i].z - body.m_state.m_x[i].z;
        const double kappa = 10 * (1 + nu) / (12 + 11 * nu), E = material.m_youngModulus;
        const double exact = load * (4e3 / E + 10 / (kappa * material.lameMu()));
        return sum / static_cast<double>(end.size()) / exact;
    }
};

// Four, three and two cells across.
TEST_F(GmshBar, BendsAsTimoshenkoSays)
{
    const TetMesh fine = bar("0.25"), middle = bar("0.33"), coarse = bar("0.5");
    for (const double nu : {.3, .45, .49})
    {
        SCOPED_TRACE(nu);
        EXPECT_NEAR(tip(fine, nu, true), 1, .06);
        EXPECT_NEAR(tip(middle, nu, true), 1, .075);
        EXPECT_NEAR(tip(coarse, nu, true), 1, .2);
        EXPECT_LT(tip(fine, nu, false), .9);
    }
}

}  // namespace
}  // namespace bullet_fem
