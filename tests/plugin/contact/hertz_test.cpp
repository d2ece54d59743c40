// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kRadius = 1;                     // of the sphere, R [m]
constexpr double kContactRadius = 0.1;            // at the largest depth, a = sqrt(R d) [m]
constexpr double kFineCell = kContactRadius / 5;  // [m]
constexpr int kFineCells = 6;                     // number of fine cells around the axis
constexpr double kGrowth = 1.5;                   // growth factor of the cells beyond
constexpr int kCoarseCells = 9;
constexpr double kYoung = 1e6, kPoisson = 0.3;  // [Pa], [-]

// Distance of the k-th grid plane from the contact [m]: fine near it, then a geometric series.
double gridPlane(int k)
{
    double distance = std::min(k, kFineCells) * kFineCell, cell = kFineCell;
    for (int i = kFineCells; i < k; ++i) distance += cell *= kGrowth;
    return distance;
}

// A quarter of a block, x and y > 0, below z = 0.
TetMesh gradedQuarterBlock()
{
    constexpr int n = kFineCells + kCoarseCells;
    const TetMesh grid = makeBox({n, n, n}, {n, n, n});
    std::vector<Vec3> positions = grid.restPositions();
    for (Vec3& p : positions)
    {
        for (int c = 0; c < 3; ++c) p[c] = gridPlane(static_cast<int>(std::lround(p[c])));
        p.z = -p.z;
    }
    return TetMesh(std::move(positions), grid.tets());
}

/// A kinematic sphere pressed into the block without friction or gravity, in steps long enough to be quasi-static.
class Hertz : public testing::Test
{
protected:
    explicit Hertz(bool bendsAccurately = false)
    {
        const TetMesh mesh = gradedQuarterBlock();
        m_depthOfBlock = gridPlane(kFineCells + kCoarseCells);
        btSoftBody* block = btFemHelpers::createFromTetMesh(m_world.info(), mesh);
        btFemMaterial material;
        material.m_youngModulus = btScalar(kYoung);
        material.m_poissonRatio = btScalar(kPoisson);
        material.m_bending = bendsAccurately ? btFemBending::accurate : btFemBending::plain;
        m_fem.setMaterial(block, material);
        clampBelow(*block, -0.999 * m_depthOfBlock);
        block->m_cfg.kDF = 0;
        addMirror(btVector3(-1, 0, 0));
        addMirror(btVector3(0, -1, 0));
        m_block = &m_world.addSoft(block);

        RigidSettings settings;
        settings.m_transform = at(0, 0, btScalar(kRadius));
        m_sphere = &m_world.addRigid(new btSphereShape(btScalar(kRadius)), settings);
        m_sphere->setCollisionFlags(m_sphere->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    }

    // A frictionless static wall that faces the block at x = 0 or y = 0.
    void addMirror(const btVector3& outward)
    {
        constexpr btScalar kLarge = 10;  // [m]
        RigidSettings settings;
        settings.m_transform.setOrigin(kLarge * outward);
        settings.m_friction = 0;
        m_world.addRigid(new btBoxShape({kLarge, kLarge, kLarge}), settings);
    }

    // Force at rest on the whole block with the sphere's lowest point at this depth [N].
    double forceAt(double depth)
    {
        constexpr int kSteps = 6, kMoving = 2;
        const double start = kRadius - m_sphere->getWorldTransform().getOrigin().z();
        for (int k = 1; k <= kSteps; ++k)
        {
            const double z = start + std::min(1.0, double(k) / kMoving) * (depth - start);
            m_sphere->getMotionState()->setWorldTransform(at(0, 0, btScalar(kRadius - z)));
            m_world.step(1, kLongStep);
        }
        return -4 * m_fem.contactForce(m_block, m_sphere).z();
    }

    // Expects that the force exceeds Hertz's by `least` to `most` at several depths, and follows a power of 3/2.
    void expectPowerOfThreeHalves(double least, double most);

    static constexpr btScalar kLongStep = btScalar(0.1);  // [s]
    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem, btVector3(0, 0, 0)};
    btSoftBody* m_block = nullptr;
    btRigidBody* m_sphere = nullptr;
    double m_depthOfBlock = 0;
};

void Hertz::expectPowerOfThreeHalves(double least, double most)
{
    ASSERT_GT(m_depthOfBlock, 10 * kContactRadius);
    constexpr double kReducedModulus = kYoung / (1 - kPoisson * kPoisson);
    const double largest = kContactRadius * kContactRadius / kRadius;
    double sumX = 0, sumY = 0, sumXX = 0, sumXY = 0;  // of the regression of log force on log depth
    int count = 0;
    for (const double share : {0.65, 0.73, 0.82, 0.91, 1.0})  // contact radii of four to five cells
    {
        const double depth = share * largest;
        const double force = forceAt(depth);
        const double ratio = force / (4.0 / 3 * kReducedModulus * std::sqrt(kRadius) * std::pow(depth, 1.5));
        EXPECT_GT(ratio, least) << "depth " << depth;
        EXPECT_LT(ratio, most) << "depth " << depth;
        EXPECT_LT(fastestNode(*m_block), 0.01 * depth / kLongStep);  // at rest
        const double x = std::log(depth), y = std::log(force);
        sumX += x, sumY += y, sumXX += x * x, sumXY += x * y, ++count;
    }
    const double exponent = (count * sumXY - sumX * sumY) / (count * sumXX - sumX * sumX);
    EXPECT_NEAR(exponent, 1.5, 0.05);
}

TEST_F(Hertz, ForceFollowsTheDepthToThePowerOfThreeHalves)
{
    expectPowerOfThreeHalves(1, 1.15);
}

class HertzOfAccurateBending : public Hertz
{
protected:
    HertzOfAccurateBending() : Hertz(true) {}
};

TEST_F(HertzOfAccurateBending, ForceFollowsTheDepthToThePowerOfThreeHalves)
{
    expectPowerOfThreeHalves(.95, 1.1);
}

}  // namespace
}  // namespace bullet_fem
