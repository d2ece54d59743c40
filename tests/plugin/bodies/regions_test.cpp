// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies of several materials in a Bullet world.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <stdexcept>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "io/temporary_folder.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

constexpr int kLower = 11, kUpper = 12;           // labels of the file
constexpr double kSide = .4, kLayer = .3;         // [m], of the block and the height of either layer
constexpr std::array<int, 3> kCells = {4, 4, 6};  // of both layers together

btFemMaterial regionMaterial(btScalar young, btScalar poisson, btScalar density)
{
    btFemMaterial material;
    material.m_youngModulus = young;
    material.m_poissonRatio = poisson;
    material.m_density = density;
    return material;
}

const std::map<int, btFemMaterial> kMaterials = {{kLower, regionMaterial(btScalar(1e5), 0, 1000)},
                                                 {kUpper, regionMaterial(btScalar(2e7), 0, 3000)}};

// A Gmsh file of the block on z = 0, its two layers as physical groups.
TetMeshFile layeredFile()
{
    const TetMesh mesh = makeBox({kSide, kSide, 2 * kLayer}, kCells);
    std::ostringstream text;
    text.precision(17);
    text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.nodeCount() << "\n";
    for (int i = 0; i < mesh.nodeCount(); ++i)
    {
        const Vec3& x = mesh.restPositions()[i];
        text << i + 1 << " " << x.x << " " << x.y << " " << x.z << "\n";
    }
    text << "$EndNodes\n$Elements\n" << mesh.tetCount() << "\n";
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        double z = 0;
        for (const int node : mesh.tets()[e]) z += mesh.restPositions()[node].z / 4;
        text << e + 1 << " 4 2 " << (z < kLayer ? kLower : kUpper) << " 1";
        for (const int node : mesh.tets()[e]) text << " " << node + 1;
        text << "\n";
    }
    text << "$EndElements\n";
    const std::string bytes = text.str();
    return readTetMesh(bytes.data(), bytes.size(), TetMeshFormat::gmsh);
}

// A world with a ground below the block, separated by a gap.
class RegionScene
{
public:
    explicit RegionScene(const btFemSolverInfo& info = btFemSolverInfo()) : m_fem(info), m_world(m_fem)
    {
        m_world.addPlane();
    }

    btSoftBody* make(double x = 0, double z = .01)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), m_file.mesh());
        body->translate(btVector3(btScalar(x), 0, btScalar(z)));
        return body;
    }
    btSoftBody& add(const std::map<int, btFemMaterial>& materials = kMaterials, double x = 0, double z = .01)
    {
        btSoftBody* body = make(x, z);
        m_fem.setMaterials(body, m_file.m_regions, materials);
        return m_world.addSoft(body);
    }
    // Bits of all soft bodies after each step.
    std::vector<btScalar> run(int steps)
    {
        std::vector<btScalar> bits;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (int b = 0; b < m_world.softBodies().size(); ++b)
            {
                const std::vector<btScalar> own = bitsOf(*m_world.softBodies()[b]);
                bits.insert(bits.end(), own.begin(), own.end());
            }
        }
        return bits;
    }

    const TetMeshFile m_file = layeredFile();
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
};

double meanHeight(const btSoftBody& body, double restHeight)
{
    const TetMesh mesh = layeredFile().mesh();
    double sum = 0;
    int count = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        if (std::fabs(mesh.restPositions()[i].z - restHeight) > 1e-6) continue;
        sum += double(body.m_nodes[i].m_x.z());
        ++count;
    }
    return sum / count;
}

TEST(RegionBodies, HaveTheMassesOfTheirRegions)
{
    RegionScene scene;
    const btSoftBody& body = scene.add();
    const double volume = kSide * kSide * kLayer;
    EXPECT_NEAR(massOf(body), 4000 * volume, 1e-5 * 4000 * volume);
    EXPECT_NEAR(centerOf(body).z, .01 + (kLayer / 2 + 3 * 3 * kLayer / 2) / 4, 1e-6);
    EXPECT_NEAR(centerOf(body).x, kSide / 2, 1e-6);
}

// Without lateral strains each layer is a bar under the weight above: h / E (rho' g h' + rho g h / 2).
TEST(RegionBodies, SettleOnTheGroundAsTwoBarsDo)
{
    RegionScene scene;
    btSoftBody& body = scene.add();
    scene.m_world.step(600);
    const double g = kGravity, above = 3000 * g * kLayer, lower = kLayer / 1e5 * (above + 1000 * g * kLayer / 2),
                 upper = kLayer / 2e7 * above / 2;
    const double foot = meanHeight(body, 0), middle = meanHeight(body, kLayer), top = meanHeight(body, 2 * kLayer);
    EXPECT_NEAR(foot, 0, 1e-4);
    EXPECT_NEAR(middle - foot, kLayer - lower, .01 * lower);
    EXPECT_NEAR(top - middle, kLayer - upper, .01 * lower);
    const btVector3 force = scene.m_fem.contactForce(&body, scene.m_world.bullet().getCollisionObjectArray()[0]);
    EXPECT_NEAR(double(force.z()), massOf(body) * g, 1e-3 * massOf(body) * g);
    btAlignedObjectArray<btFemStress> stress;
    ASSERT_TRUE(scene.m_fem.getStress(&body, stress));
    const double own = 1000 * g * kLayer;
    for (int e = 0; e < stress.size();
         ++e)  // of the lower layer by its own law: by the upper layer's it would have 200 times as much
    {
        const double beyond = std::fabs(double(stress[e].m_zz) + above + own / 2) - .6 * own;
        EXPECT_TRUE(scene.m_file.m_regions[e] == kUpper || beyond < 0) << e << ": " << beyond;
    }
}

TEST(RegionBodies, AreTheSameByAnyFormOfCall)
{
    RegionScene byLabel, byTet, byPlace;
    byLabel.add(kMaterials, 0, .5);
    btSoftBody* body = byTet.make(0, .5);
    std::vector<btFemMaterial> perTet;
    for (const int label : byTet.m_file.m_regions) perTet.push_back(kMaterials.at(label));
    byTet.m_fem.setMaterials(body, perTet);
    byTet.m_world.addSoft(body);
    body = byPlace.make(0, .5);
    int calls = 0;
    byPlace.m_fem.setMaterials(body,
                               [&](const btVector3& centroid)
                               {
                                   ++calls;
                                   EXPECT_GT(centroid.z(), btScalar(.5));  // in the body's present place
                                   EXPECT_LT(centroid.z(), btScalar(1.1));
                                   return kMaterials.at(centroid.z() < btScalar(.8) ? kLower : kUpper);
                               });
    byPlace.m_world.addSoft(body);
    EXPECT_EQ(calls, body->m_tetras.size());
    const std::vector<btScalar> bits = byLabel.run(60);
    EXPECT_TRUE(byTet.run(60) == bits);
    EXPECT_TRUE(byPlace.run(60) == bits);
}

TEST(RegionBodies, HaveTheBitsOfASingleMaterial)
{
    for (const btScalar nu : {btScalar(.3), btScalar(.47)})
    {
        RegionScene one, two;
        const btFemMaterial material = regionMaterial(btScalar(1e5), nu, 1000);
        btSoftBody* body = one.make();
        one.m_fem.setMaterial(body, material);
        one.m_world.addSoft(body);
        two.add({{kLower, material}, {kUpper, material}});
        EXPECT_TRUE(one.run(60) == two.run(60)) << nu;
    }
}

TEST(RegionBodies, AreRejectedWithTheReason)
{
    RegionScene scene;
    btSoftBody& body = scene.add();
    scene.m_world.step(5);
    const std::vector<int>& labels = scene.m_file.m_regions;
    const auto refusal = [&](const auto&... arguments)
    {
        std::string why;
        EXPECT_FALSE(scene.m_fem.setMaterials(&body, arguments..., &why));
        EXPECT_THROW(scene.m_fem.setMaterials(&body, arguments...), std::invalid_argument);
        return why;
    };
    using Table = std::map<int, btFemMaterial>;
    EXPECT_THAT(refusal(labels, Table{{kLower, kMaterials.at(kLower)}, {5, kMaterials.at(kUpper)}}),
                AllOf(HasSubstr("region 12"), HasSubstr("5, 11"), HasSubstr("give one for 12")));
    EXPECT_THAT(refusal(std::vector<int>{1, 2, 3}, kMaterials),
                AllOf(HasSubstr("3 region labels"), HasSubstr("480 tetrahedra"), HasSubstr("one for each")));
    Table bad = kMaterials;
    bad[kUpper].m_poissonRatio = btScalar(.5);
    EXPECT_THAT(refusal(labels, bad), AllOf(HasSubstr("region 12"), HasSubstr("Poisson"), HasSubstr("0.499")));
    bad = kMaterials;
    bad[kUpper].m_stiffnessDamping = btScalar(.1);
    EXPECT_THAT(refusal(labels, bad), AllOf(HasSubstr("stiffness damping"), HasSubstr("region 12"), HasSubstr("same")));
    bad = kMaterials;
    bad[kUpper].m_density = 0;
    EXPECT_THAT(refusal(labels, bad), AllOf(HasSubstr("density"), HasSubstr("or none")));
    std::vector<btFemMaterial> perTet(480);
    perTet[7].m_youngModulus = -3;
    EXPECT_THAT(refusal(perTet), AllOf(HasSubstr("tetrahedron 7"), HasSubstr("Young"), HasSubstr("-3")));
    perTet.resize(479);
    perTet[7].m_youngModulus = 3;
    EXPECT_THAT(refusal(perTet), AllOf(HasSubstr("479 materials"), HasSubstr("480 tetrahedra")));
    const std::function<btFemMaterial(const btVector3&)> none, dense = [](const btVector3&at)
    { return regionMaterial(btScalar(1e5), 0, at.z() > btScalar(.3) ? btScalar(1e7) : 1); };
    EXPECT_THAT(refusal(none), HasSubstr("function is empty"));
    EXPECT_THAT(refusal(dense), AllOf(HasSubstr("tetrahedron"), HasSubstr(") m: density"), HasSubstr("1000000]")));
    const std::function<btFemMaterial(const btVector3&)> throwing = [](const btVector3&) -> btFemMaterial
    { throw std::invalid_argument("no map here"); };
    EXPECT_THAT(refusal(throwing), HasSubstr("no map here"));
    std::string why;
    EXPECT_FALSE(scene.m_fem.setMaterials(nullptr, labels, kMaterials, &why));
    EXPECT_THAT(why, HasSubstr("null"));

    // The rejected calls changed nothing.
    RegionScene untouched;
    untouched.add();
    untouched.m_world.step(5);
    EXPECT_TRUE(scene.run(30) == untouched.run(30));
}

// Copies with two materials, four of them batched, and one with the layers exchanged.
class RegionCrowd : public RegionScene
{
public:
    RegionCrowd(bool batches, int threads, double nu) : RegionScene(infoOf(batches, threads))
    {
        std::map<int, btFemMaterial> materials = kMaterials;
        for (auto& [label, material] : materials) material.m_poissonRatio = btScalar(nu);
        for (int k = 0; k < 5; ++k) m_bodies.push_back(&add(materials, .5 * k, .01 + .02 * k));
        std::swap(materials[kLower], materials[kUpper]);
        m_bodies.push_back(&add(materials, 2.5));
    }

    const BodyModel* modelOf(int k) { return btFemCoupling::record(m_fem, *m_bodies[k])->fem().m_body.m_model.get(); }

    std::vector<btSoftBody*> m_bodies;

private:
    static btFemSolverInfo infoOf(bool batches, int threads)
    {
        btFemSolverInfo info;
        info.m_batchBodies = batches;
        info.m_threads = threads;
        return info;
    }
};

TEST(RegionBodies, HaveTheSameBitsAloneInBatchesAndOnThreads)
{
    for (const double nu : {.3, .47})
    {
        RegionCrowd alone(false, 1, nu);
        const std::vector<btScalar> bits = alone.run(40);
        EXPECT_GT(alone.m_fem.contacts(alone.m_bodies[0]).size(), 4);
        EXPECT_EQ(alone.modelOf(0), alone.modelOf(4));  // one model, one factor
        EXPECT_NE(alone.modelOf(0), alone.modelOf(5));
        for (const int threads : {1, 2, 3, 8})
            EXPECT_TRUE(RegionCrowd(true, threads, nu).run(40) == bits) << threads << " threads, nu " << nu;
    }
}

TEST(RegionBodies, GoOnToTheBitAfterASnapshot)
{
    RegionCrowd scene(true, 2, .47);
    scene.run(20);
    std::vector<unsigned char> state;
    scene.m_fem.saveState(state);
    const BulletState bullet(scene.m_world);
    bullet.restore(scene.m_world);
    const std::vector<btScalar> bits = scene.run(20);
    bullet.restore(scene.m_world);
    scene.m_fem.restoreState(state.data(), state.size());
    EXPECT_TRUE(scene.run(20) == bits);

    // A different material of one region is refused as one of the whole body is.
    std::map<int, btFemMaterial> other = kMaterials;
    for (auto& [label, material] : other) material.m_poissonRatio = btScalar(.47);
    const std::map<int, btFemMaterial> same = other;
    other[kUpper].m_youngModulus *= 2;
    scene.m_fem.setMaterials(scene.m_bodies[1], scene.m_file.m_regions, other);
    std::string why;
    EXPECT_FALSE(scene.m_fem.restoreState(state.data(), state.size(), &why));
    EXPECT_THAT(why, HasSubstr("its material is another"));
    // So are equal materials with other element labels.
    std::vector<int> labels = scene.m_file.m_regions;
    std::swap(labels.front(), labels.back());
    scene.m_fem.setMaterials(scene.m_bodies[1], labels, same);
    EXPECT_FALSE(scene.m_fem.restoreState(state.data(), state.size(), &why));
    EXPECT_THAT(why, HasSubstr("its material is another"));
    scene.m_fem.setMaterials(scene.m_bodies[1], scene.m_file.m_regions, same);
    EXPECT_TRUE(scene.m_fem.restoreState(state.data(), state.size(), &why)) << why;
}

TEST(RegionBodies, AreGivenToOthersByDefinitions)
{
    RegionScene scene, other;
    btSoftBody& body = scene.add();
    std::vector<unsigned char> definition, again;
    scene.m_fem.saveDefinition(&body, definition);
    btSoftBody* copy = other.make();
    other.m_fem.applyDefinition(copy, definition.data(), definition.size());
    other.m_world.addSoft(copy);
    EXPECT_TRUE(scene.run(60) == other.run(60));
    other.m_fem.saveDefinition(copy, again);
    EXPECT_TRUE(again == definition);
    const int size = static_cast<int>(definition.size());
    for (int k = 40; k < size; k += 97)  // any byte: refused by its checksum, or without one by its contents
    {
        std::vector<unsigned char> bad = definition;
        bad[static_cast<std::size_t>(k)] ^= 0x55;
        std::string why;
        EXPECT_FALSE(other.m_fem.applyDefinition(copy, bad.data(), bad.size(), &why));
    }
}

TEST(RegionBodies, MoveAlikeFromBakedFiles)
{
    RegionScene plain, fromFile;
    BakeSettings settings;
    settings.m_singlePrecision = sizeof(btScalar) == sizeof(float);
    settings.m_step = static_cast<double>(kStep);
    settings.m_labels = plain.m_file.m_regions;
    for (const auto& [label, m] : kMaterials)
        settings.m_regionMaterials[label] = {double(m.m_youngModulus), double(m.m_poissonRatio), double(m.m_density),
                                             double(m.m_massDamping), double(m.m_stiffnessDamping)};
    const TemporaryFolder folder;
    writeBakedBody(folder.path("body.bfem"), bakeBody(plain.m_file.mesh(), settings));
    const BakedBody baked = readBakedBody(folder.path("body.bfem"));
    btSoftBody* body = btFemHelpers::createFromBaked(fromFile.m_world.info(), baked);
    fromFile.m_fem.useBaked(body, baked);
    fromFile.m_world.addSoft(body);
    plain.m_fem.prepare(&plain.add(kMaterials, 0, 0), kStep);  // for the file's step, not the default one
    EXPECT_TRUE(plain.run(90) == fromFile.run(90));
    EXPECT_TRUE(fromFile.m_fem.stepReport(body).m_bakedFactor);
    EXPECT_FALSE(fromFile.m_fem.stepReport(body).m_flags & (BT_FEM_STALE_FACTOR | BT_FEM_BAKED_UNUSED));
}

// At rest the lower layer gets the stiffness of the upper one, and the block rises.
TEST(RegionBodies, MayGetOtherMaterialsAtAnyTime)
{
    RegionScene scene;
    btSoftBody& body = scene.add();
    scene.m_world.step(300);
    const double low = meanHeight(body, 2 * kLayer);
    const btFemMaterial stiff = regionMaterial(btScalar(2e7), 0, 1000);
    scene.m_fem.setMaterials(&body, scene.m_file.m_regions, {{kLower, stiff}, {kUpper, kMaterials.at(kUpper)}});
    scene.m_world.step(300);
    EXPECT_GT(meanHeight(body, 2 * kLayer), low + .025);
    scene.m_fem.setMaterial(&body, stiff);
    EXPECT_NEAR(massOf(body), 2000 * kSide * kSide * kLayer, .01);
    scene.m_world.step(60);
    EXPECT_TRUE(allFinite(body));
}

// A cut body has materials for more elements than it has: a flag reports it, and new materials make it FEM again.
TEST(RegionBodies, NeedNewMaterialsAfterACut)
{
    RegionScene scene;
    btSoftBody& body = scene.add();
    scene.m_world.step(3);
    body.m_tetras.pop_back();
    scene.m_world.step(1);
    EXPECT_FALSE(scene.m_fem.isFem(&body));
    EXPECT_THAT(scene.m_fem.stepReport(&body).m_message, HasSubstr("materials for 480 elements"));
    std::vector<int> labels = scene.m_file.m_regions;
    labels.pop_back();
    scene.m_fem.setMaterials(&body, labels, kMaterials);
    scene.m_world.step(1);
    EXPECT_TRUE(scene.m_fem.isFem(&body));
}

}  // namespace
}  // namespace bullet_fem
