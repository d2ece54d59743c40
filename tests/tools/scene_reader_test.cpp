// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "bullet_fem/fem/laws/law_table.h"
#include "bullet_fem/fem/mesh/elastomer.h"
#include "tools/scene/scene_world.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{

bool operator==(const Vec3& a, const Vec3& b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

namespace
{

using testing::HasSubstr;
using testing::StartsWith;

const double kPi = std::acos(-1.);

class SceneReader : public testing::Test
{
protected:
    SceneReader() { writeSampleMeshes(m_folder); }
    SceneDescription parse(const std::string& text) const { return parseScene(text, m_folder.path("")); }

    TemporaryFolder m_folder;
};

TEST_F(SceneReader, ReadsTheWholeScene)
{
    const SceneDescription scene = parse(fullScene());
    EXPECT_EQ(scene.m_title, "everything");
    EXPECT_TRUE(scene.m_gravity == Vec3({0, 0, -5}));
    EXPECT_EQ(scene.m_step, 0.004);
    EXPECT_EQ(scene.m_seconds, 2.5);
    EXPECT_EQ(scene.m_framesPerSecond, 24);
    EXPECT_FALSE(scene.m_coupled);
    EXPECT_EQ(scene.m_tolerance, 1e-4);
    EXPECT_EQ(scene.m_contactTolerance, 1e-3);
    EXPECT_EQ(scene.m_threads, 2);
    EXPECT_TRUE(scene.m_camera.m_placed);
    EXPECT_TRUE(scene.m_camera.m_eye == Vec3({5, 4, 3}));
    EXPECT_TRUE(scene.m_camera.m_target == Vec3({0, 1, 0}));
    EXPECT_NEAR(scene.m_camera.m_fieldOfView, kPi / 3, 1e-12);
    EXPECT_EQ(scene.m_pictures.m_width, 640);
    EXPECT_EQ(scene.m_pictures.m_height, 360);
    EXPECT_TRUE(scene.m_pictures.m_stress);
    EXPECT_EQ(scene.m_pictures.m_hottest, 2e5);
    EXPECT_TRUE(scene.m_pictures.m_forces);
    EXPECT_TRUE(scene.m_pictures.m_wireframe);
}

TEST_F(SceneReader, ReadsSoftBodies)
{
    const SceneDescription scene = parse(fullScene());
    ASSERT_EQ(scene.m_softBodies.size(), 2u);
    const SceneSoftBody& body = scene.m_softBodies[0];
    EXPECT_EQ(body.m_name, "block");
    EXPECT_EQ(body.m_mesh.m_kind, SceneMesh::Kind::box);
    EXPECT_TRUE(body.m_mesh.m_size == Vec3({1, 2, 3}));
    EXPECT_EQ(body.m_mesh.m_cellSize, 0.5);
    EXPECT_EQ(body.m_mesh.m_scale, 0.25);
    EXPECT_TRUE(body.m_pose.m_position == Vec3({0.5, 1.5, -2}));
    EXPECT_TRUE(body.m_pose.m_axis == Vec3({0, 0, 2}));
    EXPECT_NEAR(body.m_pose.m_angle, kPi / 2, 1e-12);
    EXPECT_TRUE(body.m_velocity == Vec3({1, 2, 3}));
    EXPECT_TRUE(body.m_material ==
                (Material{4e5, 0.2, 800, 0.1, 0.01, MeanDilatation::on, 5e4, 1e4, 3, 0.3, {{{0.2, 0.5}}}}));
    EXPECT_EQ(body.m_friction, 0.9);
    EXPECT_EQ(body.m_restitution, 0.3);
    EXPECT_TRUE(body.m_selfContact);
    EXPECT_TRUE(body.m_colour == Vec3({0.1, 0.2, 0.3}));
    ASSERT_EQ(body.m_pins.size(), 2u);
    EXPECT_TRUE(body.m_pins[0].m_high == Vec3({9, 9, 0}));
    EXPECT_TRUE(body.m_pins[1].m_low == Vec3({1, 1, 1}));
    const SceneMesh& scan = scene.m_softBodies[1].m_mesh;
    EXPECT_EQ(scan.m_kind, SceneMesh::Kind::surface);
    EXPECT_EQ(scan.m_tets, 500);
    EXPECT_TRUE(scan.m_surfaceCollides);
    EXPECT_FALSE(body.m_mesh.m_surfaceCollides);
    EXPECT_EQ(scan.m_cellSize, 0);
    EXPECT_EQ(scan.m_cellsAcross, 1.5);
    EXPECT_EQ(scan.m_mostLevels, 2);
    EXPECT_EQ(body.m_mesh.m_cellsAcross, 0);
    EXPECT_TRUE(std::filesystem::equivalent(scan.m_path, m_folder.path("cube.off")));
}

TEST_F(SceneReader, ReadsRigidBodiesConstraintsForcesAndSprings)
{
    const SceneDescription scene = parse(fullScene());
    ASSERT_EQ(scene.m_rigidBodies.size(), 2u);
    const SceneRigidBody& hammer = scene.m_rigidBodies[0];
    EXPECT_EQ(hammer.m_name, "hammer");
    EXPECT_EQ(hammer.m_shape.m_kind, SceneShape::Kind::capsule);
    EXPECT_EQ(hammer.m_shape.m_radius, 0.2);
    EXPECT_EQ(hammer.m_shape.m_height, 0.7);
    EXPECT_EQ(hammer.m_mass, 3);
    EXPECT_TRUE(hammer.m_pose.m_position == Vec3({4, 5, 6}));
    EXPECT_TRUE(hammer.m_pose.m_axis == Vec3({1, 0, 0}));
    EXPECT_NEAR(hammer.m_pose.m_angle, -kPi / 4, 1e-12);
    for (const double time : {0, 9})
    {
        EXPECT_TRUE(hammer.m_velocity.at(time) == Vec3({0, 1, 0}));
        EXPECT_TRUE(hammer.m_spin.at(time) == Vec3({0, 0, 2}));
    }
    EXPECT_EQ(hammer.m_friction, 0.4);
    EXPECT_EQ(hammer.m_restitution, 0.6);
    EXPECT_TRUE(hammer.m_colour == Vec3({1, 0, 0.5}));
    EXPECT_EQ(scene.m_rigidBodies[1].m_shape.m_kind, SceneShape::Kind::box);
    EXPECT_TRUE(scene.m_rigidBodies[1].m_shape.m_size == Vec3({0.1, 0.2, 0.3}));
    EXPECT_TRUE(scene.m_rigidBodies[1].m_velocity.at(0) == Vec3({0.25, 0, 0}));
    EXPECT_TRUE(scene.m_rigidBodies[1].m_velocity.at(1.5) == Vec3({0.125, 0.25, 0}));
    EXPECT_TRUE(scene.m_rigidBodies[1].m_velocity.at(9) == Vec3({0, 0.5, 0}));
    EXPECT_TRUE(scene.m_rigidBodies[1].m_spin.at(0) == Vec3({1, 2, 3}));

    ASSERT_EQ(scene.m_constraints.size(), 2u);
    const SceneConstraint &anchor = scene.m_constraints[0], &hinge = scene.m_constraints[1];
    EXPECT_EQ(anchor.m_kind, SceneConstraint::Kind::anchor);
    EXPECT_EQ(anchor.m_a + anchor.m_b, "blockhammer");
    EXPECT_TRUE(anchor.m_box.m_low == Vec3({-9, -9, -9}));
    EXPECT_EQ(hinge.m_kind, SceneConstraint::Kind::hinge);
    EXPECT_EQ(hinge.m_a + hinge.m_b, "hammeranvil");
    EXPECT_TRUE(hinge.m_pivot == Vec3({1, 1, 1}));
    EXPECT_TRUE(hinge.m_axis == Vec3({0, 0, 1}));
    EXPECT_EQ(hinge.m_speed.at(0), 2);
    EXPECT_EQ(hinge.m_speed.at(9), 2);
    EXPECT_EQ(hinge.m_max, 7);

    ASSERT_EQ(scene.m_forces.size(), 1u);
    EXPECT_EQ(scene.m_forces[0].m_body, "block");
    EXPECT_FALSE(scene.m_forces[0].m_everywhere);
    EXPECT_TRUE(scene.m_forces[0].m_box.m_high == Vec3({9, 9, 9}));
    EXPECT_TRUE(scene.m_forces[0].m_force == Vec3({1, 0, -1}));
    EXPECT_EQ(scene.m_forces[0].m_from, 0.5);
    EXPECT_EQ(scene.m_forces[0].m_to, 1.5);

    ASSERT_EQ(scene.m_springs.size(), 1u);
    const SceneSpring& spring = scene.m_springs[0];
    EXPECT_EQ(spring.m_body, "scan");
    EXPECT_TRUE(spring.m_at == Vec3({1, 1, 1}));
    EXPECT_TRUE(spring.m_target.at(1) == Vec3({2, 2, 2}));
    EXPECT_EQ(spring.m_stiffness, 400);
    EXPECT_EQ(spring.m_damping, 5);
    EXPECT_EQ(spring.m_max, 60);
    EXPECT_EQ(spring.m_from, 0.25);
    EXPECT_EQ(spring.m_to, 2);

    ASSERT_EQ(scene.m_sensors.size(), 2u);
    EXPECT_EQ(scene.m_sensors[0].m_name, "clamp");
    EXPECT_EQ(scene.m_sensors[0].m_body, "block");
    EXPECT_TRUE(scene.m_sensors[0].m_to.empty());
    EXPECT_FALSE(scene.m_sensors[0].m_everywhere);
    EXPECT_TRUE(scene.m_sensors[0].m_box.m_high == Vec3({9, 9, 0}));
    EXPECT_TRUE(scene.m_sensors[0].m_placed && scene.m_sensors[0].m_about == Vec3({0.5, 1, 2}));
    EXPECT_EQ(scene.m_sensors[1].m_to, "hammer");
    EXPECT_TRUE(scene.m_sensors[1].m_everywhere && !scene.m_sensors[1].m_placed);
}

TEST_F(SceneReader, ReadsWhetherElementsShareTheirVolumeChange)
{
    const auto choice = [this](const std::string& member)
    {
        return parse(R"({ "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1] }, "material": {)" + member +
                     "} }] }")
            .m_softBodies[0]
            .m_material.m_meanDilatation;
    };
    EXPECT_EQ(choice(""), MeanDilatation::automatic);
    EXPECT_EQ(choice(R"("meanDilatation": "auto")"), MeanDilatation::automatic);
    EXPECT_EQ(choice(R"("meanDilatation": "on")"), MeanDilatation::on);
    EXPECT_EQ(choice(R"("meanDilatation": "off")"), MeanDilatation::off);
}

TEST_F(SceneReader, ReadsWhetherAMaterialBendsAccurately)
{
    const auto bends = [this](const std::string& member)
    {
        return parse(R"({ "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1] }, "material": {)" + member +
                     "} }] }")
            .m_softBodies[0]
            .m_material.m_bending;
    };
    EXPECT_EQ(bends(""), Bending::automatic);
    EXPECT_EQ(bends(R"("bending": "auto")"), Bending::automatic);
    EXPECT_EQ(bends(R"("bending": "plain")"), Bending::plain);
    EXPECT_EQ(bends(R"("bending": "accurate")"), Bending::accurate);
}

TEST_F(SceneReader, ReadsHowAMaterialYields)
{
    const auto material = [this](const std::string& members)
    {
        return parse(R"({ "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1] }, "material": {)" + members +
                     "} }] }")
            .m_softBodies[0]
            .m_material;
    };
    EXPECT_FALSE(material("").yields());
    const Material read = material(
        R"("like": "lead", "yieldStress": 2e6, "hardening": 3e6, "plasticCreep": 5, "mostPlasticStrain": 0.25)");
    EXPECT_EQ(read.m_youngModulus, Material::lead().m_youngModulus);
    EXPECT_EQ(read.m_yieldStress, 2e6);
    EXPECT_EQ(read.m_hardeningModulus, 3e6);
    EXPECT_EQ(read.m_plasticCreep, 5);
    EXPECT_EQ(read.m_mostPlasticStrain, 0.25);
    const btFemMaterial given = materialOf(read);
    EXPECT_EQ(given.m_yieldStress, btScalar(2e6));
    EXPECT_EQ(given.m_hardeningModulus, btScalar(3e6));
    EXPECT_EQ(given.m_plasticCreep, btScalar(5));
    EXPECT_EQ(given.m_mostPlasticStrain, btScalar(0.25));
    const Material relaxing = material(R"("relaxation": [{ "share": 0.2, "time": 0.5 }, { "share": 0.1, "time": 7 }])");
    EXPECT_EQ(relaxing.relaxationTerms(), 2);
    EXPECT_EQ(relaxing.m_relaxation[0].m_share, 0.2);
    EXPECT_EQ(relaxing.m_relaxation[1].m_time, 7);
    EXPECT_EQ(materialOf(relaxing).m_relaxation[1].m_share, btScalar(0.1));
    EXPECT_EQ(materialOf(relaxing).m_relaxation[0].m_time, btScalar(0.5));
    EXPECT_TRUE(material(R"("like": "clay")").yields());
    EXPECT_TRUE(material(R"("like": "mildFoam")").yields());
}

TEST_F(SceneReader, ReadsHardnessAndLossFactor)
{
    const auto material = [this](const std::string& members)
    {
        return parse(R"({ "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1] }, "material": {)" + members +
                     "} }] }")
            .m_softBodies[0]
            .m_material;
    };
    EXPECT_EQ(material(R"("shoreA": 40)"), withProgramDefaults(shoreA(40)));
    EXPECT_EQ(material(R"("shoreD": 50)"), withProgramDefaults(shoreD(50)));
    const Material given =
        material(R"("shoreA": 40, "poisson": 0.45, "massDamping": 1, "loss": { "factor": 0.3, "frequency": 5 })");
    EXPECT_EQ(given.m_youngModulus, shoreA(40).m_youngModulus);
    EXPECT_EQ(given.m_poissonRatio, 0.45);
    EXPECT_NEAR(lossFactor(given, 5), 0.3, 1e-12);
    EXPECT_EQ(given.m_massDamping, 1);
    EXPECT_EQ(materialOf(given).m_stiffnessDamping, btScalar(given.m_stiffnessDamping));
}

TEST_F(SceneReader, ReadsLawsAndTheirConstants)
{
    const auto scene = [](const std::string& members)
    { return R"({ "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1] }, "material": {)" + members + "} }] }"; };
    const auto material = [&](const std::string& members) { return parse(scene(members)).m_softBodies[0].m_material; };
    const Material rubber =
        material(R"("law": "ogden", "poisson": 0.45, "lawConstants": { "mu1": 5e5, "alpha3": -3 })");
    EXPECT_EQ(rubber.m_law, ElasticLaw::ogden);
    const std::vector<LawConstant>& known = constantsOf(ElasticLaw::ogden);
    EXPECT_EQ(rubber.m_lawConstants[0], 5e5);
    EXPECT_EQ(rubber.m_lawConstants[1], known[1].m_default);
    EXPECT_EQ(rubber.m_lawConstants[5], -3);
    EXPECT_EQ(materialOf(rubber).m_lawConstants[0], btScalar(5e5));
    EXPECT_EQ(material(R"("law": "damage")").m_lawConstants[0], constantsOf(ElasticLaw::damage)[0].m_default);
    const auto refusal = [&](const std::string& members)
    {
        try
        {
            parse(scene(members));
        }
        catch (const std::runtime_error& error)
        {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(refusal(R"("law": "treacle")"),
                testing::HasSubstr("material.law is \"treacle\"; it must be a law that"));
    EXPECT_THAT(refusal(R"("law": "ogden", "lawConstants": { "mu4": 1 })"),
                testing::HasSubstr("'mu4', which is no constant of the law ogden"));
    EXPECT_THAT(refusal(R"("law": "damage", "lawConstants": { "strength": 0 })"),
                testing::HasSubstr("lawConstants.strength is 0; it must be a number in [1, "));
    EXPECT_THAT(refusal(R"("law": "ogden", "lawConstants": { "mu1": -1 })"), testing::HasSubstr("give both one sign"));
}

TEST_F(SceneReader, ReadsOrthotropicConstants)
{
    const auto material = [this](const std::string& members)
    {
        return parse(R"({ "materials": { "oak": { "orthotropic":
                     { "young": [9e9, 2e9, 1e9], "poisson": [0.3, 0.4, 0.5], "shear": [7e8, 6e8, 5e8] } } },
                     "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1] }, "material": {)" +
                     members + "} }] }")
            .m_softBodies[0]
            .m_material;
    };
    EXPECT_FALSE(material("").isOrthotropic());
    const Material oak = material(R"("like": "oak", "density": 700)");
    ASSERT_TRUE(oak.isOrthotropic());
    EXPECT_EQ(oak.m_orthotropic.m_young, (std::array<double, 3>{9e9, 2e9, 1e9}));
    EXPECT_EQ(oak.m_orthotropic.m_poisson, (std::array<double, 3>{0.3, 0.4, 0.5}));
    EXPECT_EQ(oak.m_orthotropic.m_shear, (std::array<double, 3>{7e8, 6e8, 5e8}));
    EXPECT_EQ(oak.m_orthotropic.m_along.x, 1);
    EXPECT_EQ(oak.m_orthotropic.m_across.y, 1);
    EXPECT_FALSE(material(R"("like": "oak", "law": "hooke")").isOrthotropic());
    const Material turned = material(R"("orthotropic": { "young": [9e9, 2e9, 1e9], "poisson": [0.3, 0.4, 0.5],
                                        "shear": [7e8, 6e8, 5e8], "axes": [[0, 0, 3], [1, 0, 1]] })");
    const btFemMaterial given = materialOf(turned);
    EXPECT_EQ(given.m_law, btFemElasticLaw::orthotropic);
    EXPECT_EQ(given.m_orthotropic.m_young[2], btScalar(1e9));
    EXPECT_EQ(given.m_orthotropic.m_poisson[1], btScalar(0.4));
    EXPECT_EQ(given.m_orthotropic.m_shear[0], btScalar(7e8));
    EXPECT_EQ(given.m_orthotropic.m_along, btVector3(0, 0, 3));
    EXPECT_EQ(given.m_orthotropic.m_across, btVector3(1, 0, 1));
}

TEST_F(SceneReader, ReadsTheOtherKindsAndTakesDefaults)
{
    const SceneDescription scene = parse(otherScene());
    EXPECT_EQ(scene.m_softBodies[0].m_mesh.m_kind, SceneMesh::Kind::tetrahedra);
    EXPECT_EQ(scene.m_softBodies[0].m_material.m_youngModulus, Material::jelly().m_youngModulus);
    EXPECT_EQ(scene.m_softBodies[0].m_material.m_stiffnessDamping, 0.005) << "the plug-in's";
    EXPECT_EQ(scene.m_softBodies[1].m_mesh.m_kind, SceneMesh::Kind::baked);
    EXPECT_EQ(scene.m_softBodies[3].m_mesh.m_kind, SceneMesh::Kind::sphere);
    EXPECT_EQ(scene.m_softBodies[3].m_mesh.m_radius, 0.3);
    EXPECT_EQ(scene.m_softBodies[4].m_mesh.m_kind, SceneMesh::Kind::cylinder);
    EXPECT_EQ(scene.m_softBodies[4].m_mesh.m_radius, 0.3);
    EXPECT_EQ(scene.m_softBodies[4].m_mesh.m_height, 0.2);
    const std::map<int, Material>& regions = scene.m_softBodies[2].m_regionMaterials;
    ASSERT_EQ(regions.size(), 2u);
    EXPECT_EQ(regions.at(1).m_youngModulus, Material::rubber().m_youngModulus);
    EXPECT_EQ(regions.at(1).m_stiffnessDamping, 0.005);
    EXPECT_EQ(regions.at(-2).m_youngModulus, 3e7);
    EXPECT_EQ(regions.at(-2).m_poissonRatio, Material::rubber().m_poissonRatio);
    EXPECT_EQ(regions.at(-2).m_density, 2000);
    EXPECT_EQ(scene.m_rigidBodies[0].m_shape.m_kind, SceneShape::Kind::plane);
    EXPECT_EQ(scene.m_rigidBodies[1].m_shape.m_kind, SceneShape::Kind::sphere);
    EXPECT_EQ(scene.m_rigidBodies[1].m_shape.m_radius, 0.3);
    EXPECT_EQ(scene.m_rigidBodies[2].m_shape.m_kind, SceneShape::Kind::cylinder);
    EXPECT_EQ(scene.m_constraints[0].m_kind, SceneConstraint::Kind::point);
    EXPECT_EQ(scene.m_constraints[1].m_kind, SceneConstraint::Kind::slider);
    EXPECT_TRUE(scene.m_constraints[1].m_b.empty());
    EXPECT_TRUE(scene.m_constraints[1].m_axis == Vec3({0, 0, 2}));
    EXPECT_NEAR(scene.m_constraints[1].m_speed.at(1.25), 0.2, 1e-12);
    EXPECT_EQ(scene.m_constraints[1].m_max, 9);
    EXPECT_TRUE(scene.m_forces[0].m_everywhere);
    EXPECT_FALSE(scene.m_camera.m_placed);
    EXPECT_TRUE(scene.m_camera.m_direction == Vec3({1, 2, 3}));
    EXPECT_TRUE(scene.m_gravity == Vec3({0, -9.81, 0}));
    EXPECT_TRUE(scene.m_coupled);
}

TEST_F(SceneReader, MakesIdenticallyRotatedGridCopiesInEveryRun)
{
    const SceneDescription scene = parse(otherScene()), again = parse(otherScene());
    ASSERT_EQ(scene.m_softBodies.size(), 11u);
    ASSERT_EQ(scene.m_rigidBodies.size(), 5u);
    Vec3 ways;  // sum of the copies' y axes
    for (int k = 0; k < 6; ++k)
    {
        const SceneSoftBody &copy = scene.m_softBodies[5 + k], &same = again.m_softBodies[5 + k];
        EXPECT_EQ(copy.m_name, "toy." + std::to_string(k));
        EXPECT_LT(norm(copy.m_pose.m_position - Vec3{0.5 * (k % 2), 1, -0.4 * (k / 2)}), 1e-12);
        EXPECT_TRUE(copy.m_pose.m_axis == same.m_pose.m_axis && copy.m_pose.m_angle == same.m_pose.m_angle);
        const Vec3 axis = (1 / norm(copy.m_pose.m_axis)) * copy.m_pose.m_axis;
        const double c = std::cos(copy.m_pose.m_angle), s = std::sin(copy.m_pose.m_angle);
        ways += c * Vec3{0, 1, 0} + s * cross(axis, Vec3{0, 1, 0}) + ((1 - c) * axis.y) * axis;  // [Rodrigues]
    }
    EXPECT_LT(norm(ways), 0.7 * 6) << "they lie as at random";
    EXPECT_EQ(scene.m_rigidBodies[4].m_name, "crate.1");
    EXPECT_LT(norm(scene.m_rigidBodies[4].m_pose.m_position - Vec3{0.5, 0, 0}), 1e-12);
    EXPECT_EQ(scene.m_rigidBodies[4].m_pose.m_angle, 0);
}

TEST_F(SceneReader, AcceptsCommentsAndAnyOrder)
{
    const SceneDescription scene = parse(R"(// a scene
        { "forces": [{ "body": "a", "force": [0, 1, 0] }], /* names are known
          from below */ "softBodies": [{ "mesh": { "box": [1, 1, 1] }, "name": "a", "material": "own" }],
          "materials": { "own": { "young": 5 } } })");
    EXPECT_EQ(scene.m_forces.size(), 1u);
    EXPECT_EQ(scene.m_softBodies[0].m_material.m_youngModulus, 5);
}

TEST_F(SceneReader, FilesAreFoundBesideTheScene)
{
    std::filesystem::create_directory(m_folder.path("scenes"));
    const std::string body = R"({ "softBodies": [{ "name": "a", "mesh": { "surface": ")";
    const std::string path = m_folder.write("scenes/a.json", body + "../cube.off\" } }] }");
    const SceneDescription scene = readScene(path);
    EXPECT_TRUE(std::filesystem::equivalent(scene.m_softBodies[0].m_mesh.m_path, m_folder.path("cube.off")));
    const std::string absolute = m_folder.write("scenes/b.json", body + m_folder.path("cube.off") + "\" } }] }");
    EXPECT_TRUE(std::filesystem::equivalent(readScene(absolute).m_softBodies[0].m_mesh.m_path,
                                            scene.m_softBodies[0].m_mesh.m_path));
}

TEST_F(SceneReader, UnreadableSceneFilesAreNamed)
{
    const auto messageOfFile = [&](const std::string& path)
    { return messageOf<std::runtime_error>([&] { readScene(path); }); };
    const std::string missing = m_folder.path("missing.json");
    EXPECT_THAT(messageOfFile(missing), StartsWith("cannot read the scene '" + missing + "': there is no such file"));
    EXPECT_THAT(messageOfFile(m_folder.path("")), HasSubstr("no such file")) << "a folder";
    const std::string text = m_folder.write("text.json", "{\n  \"step\": 0,01\n}");
    EXPECT_THAT(messageOfFile(text), StartsWith(text + ":2:13: expected a member's name"));
    const std::string bad = m_folder.write("bad.json", "{ \"step\": 2 }");
    EXPECT_THAT(messageOfFile(bad), HasSubstr("bad.json': step is 2; it must be a number in [1e-06, 1]"));
}

}  // namespace
}  // namespace bullet_fem
