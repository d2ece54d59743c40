// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The approximate compliance of a stiff, light body may be indefinite, so that sweeps diverge. The impulses on such a
// body are dropped for the step.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

constexpr double kLongStep = 0.05, kYoung = 1e8, kDensity = 10;  // [s], [Pa], [kg/m3]

constexpr int kCorner = 49, kOtherCorner = 55;  // on one edge of a plate's upper face
using Pins = std::vector<int>;

// A plate with a tetrahedron attached at its last node: if the tetrahedron's three other nodes are fixed, the plate can
// rotate about the last node, although more than one node is fixed.
TetMesh plateOnAJoint()
{
    const TetMesh box = makeBox({0.3, 0.3, 0.03}, {6, 6, 1});
    std::vector<Vec3> X = box.restPositions();
    std::vector<Tet> tets = box.tets();
    const int last = static_cast<int>(X.size()) - 1;
    for (const Vec3& edge : {Vec3{0.03, 0, 0}, Vec3{0, 0.03, 0}, Vec3{0, 0, 0.03}}) X.push_back(X[last] + edge);
    tets.push_back({last, last + 1, last + 2, last + 3});
    return {X, tets};
}
const Pins kJoint = {98, 99, 100};

// A plate of 27 g; its lower face is in contact at points with different normals.
class Plate : public ContactScene
{
public:
    explicit Plate(unsigned seed, const Pins& pins = {}, double gap = 0)
    {
        Material material = elasticMaterial(kYoung, 0.3);
        material.m_density = kDensity;
        const Body onFullPath = makeBody(plateOnAJoint(), material, {}, kLongStep);
        FactorInput input = onFullPath.m_model->factorInput();
        input.m_choice = FactorChoice::lowMemory;
        for (int node : pins) input.m_fixed[node] = 1;
        m_body = Body(BodyModel::create(onFullPath.m_model->sharedShape(), input));
        m_body.m_state.m_fixed = input.m_fixed;
        m_cache = makeComplianceCache(m_body.m_model);
        m_settings.m_step.m_step = kLongStep;
        m_settings.m_step.m_tolerance = 1e-3;
        m_settings.m_sweeps = 50;
        std::mt19937 generator(seed);
        const auto number = [&generator] { return generator() / 2147483648.0 - 1; };
        setVelocity({2 * number(), 2 * number(), -1});
        for (int node = 0; node < 49; ++node) touchNode(node, gap, 0.3);
        for (ContactPoint& contact : m_contacts)
        {
            const double x = 0.3 * number(), y = 0.3 * number();
            const Vec3 n = {x, y, 1};
            contact.m_normal = (1 / norm(n)) * n;
        }
    }

    double fastest() const
    {
        double speed = 0;
        for (const Vec3& v : velocity(m_body)) speed = std::max(speed, norm(v));
        return speed;
    }
};

constexpr double kFastEnough = 20;  // [m/s]; the initial speed is at most 3

// Rotations that fixed nodes allow are no strain, for any stiffness of the plate.
TEST(Runaway, DoesNotHappenWithRigidMotions)
{
    for (const Pins& pins : {Pins{}, {kCorner}, {kCorner, kOtherCorner}})
        for (unsigned seed = 0; seed < 10; ++seed)
        {
            Plate plate(seed, pins);
            EXPECT_LT(plate.solve().m_violation, 0.2) << pins.size() << " " << seed;
            EXPECT_LT(plate.fastest(), kFastEnough) << pins.size() << " " << seed;
        }
}

TEST(Runaway, IsStopped)
{
    int unsolved = 0;
    for (unsigned seed = 0; seed < 70; ++seed)
    {
        Plate plate(seed, kJoint);
        if (!plate.solve().m_converged) ++unsolved;
        EXPECT_LT(plate.fastest(), kFastEnough) << seed;
    }
    EXPECT_GT(unsolved, 35);
}

// Position correction of penetrations that do not close has sweeps of its own, which may diverge as well.
TEST(Runaway, IsStoppedInPositionCorrections)
{
    for (unsigned seed = 0; seed < 10; ++seed)
    {
        Plate plate(seed, kJoint, -0.02);
        plate.setVelocity({0, 0, 0.03});
        makeBall(plate.m_rigidProxies[0], 10, 0.5);
        plate.solve();
        EXPECT_LT(norm(plate.m_rigidProxies[0].m_pushLinear), 1) << seed;
        EXPECT_LT(norm(plate.m_rigidProxies[0].m_pushAngular), 1) << seed;
        finishStep(plate.m_body, plate.m_settings.m_step);
        for (const Vec3& x : plate.m_body.m_state.m_x) ASSERT_LT(norm(x), 1) << seed;
    }
}

// Points of a cube's lower face, in contact with the floor, are driven into it: no impulse suffices.
TEST(Runaway, IsRevertedForAMixOfSweeps)
{
    std::mt19937 generator(1);
    const auto number = [&generator] { return generator() / 2147483648.0 - 1; };
    for (int k = 0; k < 300; ++k)
    {
        ContactScene scene(1e6);
        scene.m_settings.m_rounds = 1;
        scene.setVelocity({number(), 0, -1});
        scene.touchLowerFace(0, 0.5);
        scene.m_rigidProxies.resize(2);
        scene.m_rigidProxies[1].m_linearVelocity = {0, 0, -0.5};
        scene.touchNode(k % 9, 0, 0.5);
        ContactPoint& driven = scene.m_contacts.back();
        const Vec3 n = {0.2 * number(), 0.2 * number(), -1};
        driven.m_normal = (1 / norm(n)) * n;
        driven.m_rigidProxy = 1;
        for (ContactPoint& contact : scene.m_contacts) contact.m_impulse = 20 * contact.m_normal;
        EXPECT_TRUE(scene.solve().m_converged) << k;
        EXPECT_GT(norm(driven.m_impulse), 1) << k;  // [N s]
    }
}

TEST(Runaway, NonFiniteJointTargetDoesNoHarm)
{
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        ContactScene scene;
        scene.setVelocity({0, 0, -1});
        scene.touchLowerFace(0, 0.5);
        Joint joint;
        joint.m_a.m_body = 0;
        joint.m_a.m_count = 1;
        joint.m_wanted = {0, bad, 0};
        scene.m_problem.m_joints.push_back(joint);
        scene.m_problem.m_handleNodes = {13};
        scene.m_problem.m_handleBlocks = {Mat3::identity()};
        scene.solve();
        for (const Vec3& v : velocity(scene.m_body)) ASSERT_LT(norm(v), 2) << bad;
    }
}

}  // namespace
}  // namespace bullet_fem
