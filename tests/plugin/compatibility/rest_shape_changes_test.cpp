// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_bridge/body/soft_body_mesh.h"
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

btSoftBody* makeElasticCube(SoftWorld& world, btScalar cell = btScalar(0.25))
{
    return btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(0.5, 0.5, 0.5), cell);
}

void stretch(btSoftBody& body, const btVector3& by)
{
    for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_x *= by;
}

// Lengths of all elements' edges, which do not change when a body is rotated.
std::vector<double> lengthsOf(const btSoftBody& body)
{
    std::vector<double> lengths;
    for (int e = 0; e < body.m_tetras.size(); ++e)
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b)
                lengths.push_back((body.m_tetras[e].m_n[a]->m_x - body.m_tetras[e].m_n[b]->m_x).length());
    return lengths;
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b)
{
    double largest = 0;
    for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::fabs(a[k] - b[k]));
    return largest;
}

// --- Sharing between copies ---

// A body that has left the world is known until the next step. A body that becomes FEM before that shares the removed
// one's factor and rest shape if it is a copy of that body's original shape; it does not if its shape differs, or if it
// is a copy of the changed shape.
TEST(RestShape, BodyFollowingARemovedCopyHasItsOwn)
{
    for (const bool isPrepared : {true, false})
        for (const double growth : {0.0, 2e-4, 1e-2})
        {
            btFemSoftBodySolver fem;
            SoftWorld world(fem, btVector3(0, 0, 0));
            btSoftBody& first = world.addSoft(makeElasticCube(world));
            world.step();
            world.world().removeSoftBody(&first);
            first.scale(btVector3(2, 1, 1));  // changes its rest shape, too
            btSoftBody* made = makeElasticCube(world);
            const btScalar scale = btScalar(1 + growth);
            made->scale(btVector3(scale, scale, scale));
            const std::vector<double> rest = lengthsOf(*made);
            btSoftBody& second = world.addSoft(made);
            if (isPrepared) fem.prepare(&second, kStep);
            world.step(20);
            EXPECT_LT(largestDifference(lengthsOf(second), rest), 2e-6) << isPrepared << ' ' << growth;
            stretch(second, btVector3(btScalar(1.05), 1, 1));
            second.m_cfg.kDP = btScalar(0.1);
            world.step(300);
            EXPECT_LT(largestDifference(lengthsOf(second), rest), 2e-5) << isPrepared << ' ' << growth;
        }
}

// --- The rest shape is that of initializeDmInverse ---

class RestShape : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, RestShape, eachWorld(), nameOfWorld);

TEST_P(RestShape, EarlyDeformedBodySpringsBackToItsElementMatrices)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody* made = makeElasticCube(world);
    made->rotate(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(2.5)));
    made->translate(btVector3(3, 0, 1));
    const std::vector<double> rest = lengthsOf(*made);
    stretch(*made, btVector3(btScalar(1.1), 1, btScalar(0.95)));
    const Vec3 center = centerOf(*made);
    btSoftBody& cube = world.addSoft(made);
    world.step(1);
    EXPECT_GT(fastestNode(cube), 1);
    world.step(400);
    EXPECT_LT(largestDifference(rest, lengthsOf(cube)), 1e-4);
    EXPECT_LT(norm(centerOf(cube) - center), 1e-4);
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
}

// Rounding of its matrices does not disturb a body that was only moved.
TEST_P(RestShape, ABodyMovedBeforeItsFirstStepStandsStill)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody* made = makeElasticCube(world);
    for (int k = 0; k < 5; ++k)
    {
        made->rotate(btQuaternion(btVector3(1, k, 3).normalized(), btScalar(0.7)));
        made->translate(btVector3(3, -1, 2));
    }
    btSoftBody& cube = world.addSoft(made);
    world.step();
    EXPECT_LT(fastestNode(cube), 1e-12);
}

// Bodies assembled with appendTetra have zero matrices: their shape in the first step becomes the rest shape.
TEST_P(RestShape, IsThePresentShapeWithoutElementMatrices)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody* made = makeElasticCube(world);
    for (int e = 0; e < made->m_tetras.size(); ++e) made->m_tetras[e].m_Dm_inverse.setValue(0, 0, 0, 0, 0, 0, 0, 0, 0);
    stretch(*made, btVector3(btScalar(1.2), 1, 1));
    btSoftBody& cube = world.addSoft(made);
    world.step(10);
    EXPECT_LT(fastestNode(cube), 1e-12);
}

// Matrices that were never set, or that are inconsistent, are ignored.
TEST_P(RestShape, InconsistentElementMatricesAreIgnored)
{
    for (const int kind : {0, 1, 2})
    {
        SCOPED_TRACE(kind);
        FemWorld world(GetParam(), btVector3(0, 0, 0));
        btFemSoftBodySolver& fem = world.fem();
        btSoftBody* made = makeElasticCube(world);
        btSoftBody::Tetra& tetra = made->m_tetras[7];
        if (kind == 0) tetra.m_Dm_inverse[1][2] = std::numeric_limits<btScalar>::quiet_NaN();
        if (kind == 1) tetra.m_Dm_inverse = tetra.m_Dm_inverse.scaled(btVector3(-1, 1, 1));  // mirrored
        if (kind == 2)  // a turned and larger neighbour would have to overlap
        {
            tetra.m_Dm_inverse = tetra.m_Dm_inverse.scaled(btVector3(btScalar(0.5), 1, 1));
            tetra.m_element_measure *= 2;
        }
        btSoftBody& cube = world.addSoft(made);
        world.step(10);
        EXPECT_TRUE(fem.isFem(&cube));
        EXPECT_LT(fastestNode(cube), 1e-12);
    }
}

// fromRest of a body that was deformed when it became FEM leads from its rest shape, fitted to the body.
TEST_P(RestShape, TransformsFromRestStartFromTheElementMatrices)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody* made = makeElasticCube(world, btScalar(0.5));
    made->rotate(btQuaternion(btVector3(0, 0, 1), btScalar(1)));
    made->translate(btVector3(5, 0, 0));
    std::vector<int> all;
    std::vector<btVector3> rest;
    for (int i = 0; i < made->m_nodes.size(); ++i)
    {
        all.push_back(i);
        rest.push_back(made->m_nodes[i].m_x);
    }
    for (int i = 0; i < made->m_nodes.size(); ++i)
        made->m_nodes[i].m_x = rest[i] + btScalar(0.1) * (rest[i] - btVector3(5, 0, 0));
    btSoftBody& cube = world.addSoft(made);
    world.step();
    fem.setNodeTargets(&cube, all.data(), static_cast<int>(all.size()), btTransform::getIdentity());
    world.step(2);
    for (int i = 0; i < cube.m_nodes.size(); ++i) EXPECT_LT((cube.m_nodes[i].m_x - rest[i]).length(), 1e-5) << i;
}

// --- scale() and initializeDmInverse() at any time ---

/// A bar pinned at z = 0, 2 m long, 0.4 m thick, with nu = 0, so that formulas hold to a percent.
class HangingBar
{
public:
    explicit HangingBar(WorldClass worldClass, double filled = 1) : m_world(worldClass)
    {
        m_body = btFemHelpers::createBox(m_world.info(), btVector3(0, 0, -1), btVector3(.2, .2, 1), btScalar(0.2));
        for (int e = 0; e < m_body->m_tetras.size() && filled < 1; ++e) storeFill(*m_body, e, filled, 1);
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
            if (m_body->m_nodes[i].m_x.z() > btScalar(-0.001)) m_body->setMass(i, 0);
        m_material.m_youngModulus = btScalar(1e7);
        m_material.m_poissonRatio = 0;
        m_material.m_density = 1000;
        m_material.m_massDamping = 5;
        m_world.fem().setMaterial(m_body, m_material);
        m_world.addSoft(m_body);
    }

    btSoftBody& body() { return *m_body; }
    btFemSoftBodySolver& fem() { return m_world.fem(); }
    SoftWorld& world() { return m_world; }
    const btFemMaterial& material() const { return m_material; }
    double length() const { return -lowestHeight(*m_body); }
    void settle() { m_world.step(400); }

    /// Elongation of a bar of this length [m] and cross-section [m2] under its own weight: m g L / (2 E A), with the
    /// mass of the clamped ends.
    double sag(double length, double area, double mass) const
    {
        return mass * kGravity * length / (2 * m_material.m_youngModulus * area);
    }

private:
    FemWorld m_world;
    btSoftBody* m_body;
    btFemMaterial m_material;
};

constexpr double kBarMass = 320;  // [kg]; 8 x its volume after scaling to twice the size, if that sets masses

class ScaledBar : public EachWorldWith<double>
{
};

// Twice as long and four times the section, of equal mass: half the sag, with the sagged shape as rest shape.
TEST_P(ScaledBar, HasTheStiffnessOfTheLargerBodyAndItsOldMass)
{
    const double filled = value();
    HangingBar bar(worldClass(), filled);
    bar.settle();
    const double first = bar.sag(2, 0.16 * filled, kBarMass * filled);
    EXPECT_NEAR(bar.length() - 2, first, 0.02 * first);

    const double mass = massOf(bar.body());
    bar.body().scale(btVector3(2, 2, 2));
    const double scaled = bar.length();
    bar.settle();
    const double second = bar.sag(4, 0.64 * filled, kBarMass * filled);
    EXPECT_NEAR(bar.length() - scaled, second, 0.02 * second);
    EXPECT_EQ(massOf(bar.body()), mass);
    EXPECT_EQ(bar.fem().stepReport(&bar.body()).m_flags, 0);

    bar.fem().setMaterial(&bar.body(), bar.material());  // the density sets masses again, now of the larger body
    EXPECT_NEAR(massOf(bar.body()), 8 * mass, 0.01 * 8 * mass);
    bar.settle();
    EXPECT_NEAR(bar.length() - scaled, 8 * second, 0.02 * 8 * second);
}

INSTANTIATE_TEST_SUITE_P(RestShape, ScaledBar, testing::Combine(eachWorld(), testing::Values(1, 0.25)),
                         nameOfWorldWith([](double filled) { return filled == 1 ? "full" : "cageFilledByAQuarter"; }));

TEST_P(RestShape, ADensityGivesTheMassesOfTheShapeAtRestAndNotOfTheDeformedOne)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& cube = world.addSoft(makeElasticCube(world));
    world.step();
    stretch(cube, btVector3(btScalar(1.3), 1, 1));
    btFemMaterial material;
    material.m_density = 500;
    fem.setMaterial(&cube, material);
    EXPECT_NEAR(massOf(cube), 500, 1e-3);
}

TEST_P(RestShape, InitializeDmInverseInMidRunMakesThePresentShapeTheRestShape)
{
    for (const bool called : {false, true})
    {
        HangingBar bar(GetParam());
        bar.settle();
        const double hanging = bar.length();
        if (called) bar.body().initializeDmInverse();
        bar.world().setSoftGravity(btVector3(0, 0, 0));
        bar.settle();
        EXPECT_NEAR(bar.length(), called ? hanging : 2, 1e-5);
    }
}

TEST_P(RestShape, TranslateRotateAndTransformKeepIt)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& cube = world.addSoft(makeElasticCube(world));
    const std::vector<double> rest = lengthsOf(cube);
    for (int i = 0; i < cube.m_nodes.size(); ++i) cube.m_nodes[i].m_v.setX(20 * cube.m_nodes[i].m_x.x());
    world.step(3);
    ASSERT_GT(largestDifference(rest, lengthsOf(cube)), 0.005);
    cube.translate(btVector3(1, 2, 3));
    cube.rotate(btQuaternion(btVector3(1, 1, 0).normalized(), btScalar(2)));
    cube.transform(btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(-1)), btVector3(-4, 0, 0)));
    world.step(300);
    EXPECT_LT(largestDifference(rest, lengthsOf(cube)), 1e-4);
}

TEST_P(RestShape, AMirroredBodyIsTheMirroredOne)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& cube = world.addSoft(makeElasticCube(world));
    world.step(5);
    cube.scale(btVector3(-1, 1, 1));
    const std::vector<Vec3> shape = edgesOf(cube);
    world.step(60);
    EXPECT_LT(bullet_fem::largestDifference(shape, edgesOf(cube)), 1e-6);
    EXPECT_EQ(fem.stepReport(&cube).m_flags, BT_FEM_TURNED_TETS);
}

// Invalid matrices are ignored: the old rest shape stays.
TEST_P(RestShape, SpoiltElementMatricesInMidRunChangeNothing)
{
    HangingBar bar(GetParam());
    bar.settle();
    const double length = bar.length();
    for (int e = 0; e < bar.body().m_tetras.size(); ++e)
        bar.body().m_tetras[e].m_Dm_inverse.setValue(0, 0, 0, 0, 0, 0, 0, 0, 0);
    bar.settle();
    EXPECT_NEAR(bar.length(), length, 1e-6);
}

TEST_P(RestShape, CopiesScaledAlikeShareTheirFactor)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody &a = world.addSoft(makeElasticCube(world)), &b = world.addSoft(makeElasticCube(world));
    b.translate(btVector3(4, 0, 0));
    world.step();
    const btScalar first = fem.stepReport(&a).m_factorSeconds;
    a.scale(btVector3(2, 2, 2));
    b.scale(btVector3(2, 2, 2));
    world.step();
    EXPECT_NE(fem.stepReport(&a).m_factorSeconds, first);
    EXPECT_EQ(fem.stepReport(&a).m_factorSeconds, fem.stepReport(&b).m_factorSeconds);
}

// The sleeping body's rest shape becomes its present shape, shortened by its weight, so that it sags again.
TEST_P(RestShape, ItsChangeWakesASleepingBody)
{
    FemWorld world(GetParam());
    world.addPlane();
    btSoftBody& cube = world.addSoft(btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.501)),
                                                             btVector3(0.5, 0.5, 0.5), btScalar(0.25)));
    cube.forceActivationState(ACTIVE_TAG);
    world.step(400);
    ASSERT_FALSE(cube.isActive());
    const double asleep = centerOf(cube).z, sag = 0.5 - asleep;
    cube.initializeDmInverse();
    world.step();
    EXPECT_TRUE(cube.isActive());
    world.step(400);
    EXPECT_NEAR(asleep - centerOf(cube).z, sag, 0.15 * sag);
}

}  // namespace
}  // namespace bullet_fem
