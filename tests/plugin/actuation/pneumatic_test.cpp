// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Inflated bodies in contact with rigid ones, in Bullet's worlds.
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "fem/scenes/hollow_meshes.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

class Pneumatics : public testing::TestWithParam<Coupling>
{
};

double volumeOf(const btSoftBody& body, const btFemChamber& chamber)
{
    double sum = 0;
    const auto x = [&](std::size_t k) { return body.m_nodes[chamber.m_triangles[k]].m_x; };
    for (std::size_t k = 0; k < chamber.m_triangles.size(); k += 3) sum += x(k).dot(x(k + 1).cross(x(k + 2))) / 6;
    return sum;
}

// sigma : epsilon / 2 by Hooke's law, summed over the elements.
double elasticEnergy(const btSoftBody& body, const btFemSoftBodySolver& fem, const TetMesh& mesh, double young)
{
    btAlignedObjectArray<btFemStress> stress;
    fem.getStress(&body, stress);
    double energy = 0;
    for (int e = 0; e < stress.size(); ++e)
    {
        const btFemStress& s = stress[e];
        const double squares = double(s.m_xx) * s.m_xx + double(s.m_yy) * s.m_yy + double(s.m_zz) * s.m_zz +
                               2 * (double(s.m_xy) * s.m_xy + double(s.m_yz) * s.m_yz + double(s.m_xz) * s.m_xz);
        const double trace = double(s.m_xx) + s.m_yy + s.m_zz;
        energy += mesh.tetVolume(e) * (1.3 * squares - 0.3 * trace * trace) / (2 * young);
    }
    return energy;
}

// A ball with a sealed gas, compressed by frictionless plates at a quarter of its height per second: the plates' work
// equals the energy of the walls and of the gas, whose isothermal energy is p0 V - gas ln V.
TEST_P(Pneumatics, ASqueezedBallKeepsItsGasAndItsEnergy)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, GetParam(), {0, 0, 0});
    const TetMesh mesh = hollowSphere(0.07, 0.1, 6, 2);
    const double young = 2e4;
    btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), mesh);
    btFemMaterial material;
    material.m_youngModulus = btScalar(young);
    material.m_poissonRatio = btScalar(0.3);
    material.m_density = 1000;
    material.m_stiffnessDamping = 0;
    fem.setMaterial(ball, material);
    ball->m_cfg.kDF = 0;
    world.addSoft(ball);
    RigidSettings settings;
    btRigidBody* plates[2];
    for (const int side : {0, 1})
    {
        settings.m_transform = at(0, 0, btScalar(side == 0 ? -0.111 : 0.111));
        plates[side] = &addRigidBox(world, {0.4, 0.4, 0.02}, settings);
        plates[side]->setCollisionFlags(plates[side]->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    }
    fem.prepare(ball, kStep);
    std::vector<btFemChamber> cavities;
    btFemChamber::find(ball, cavities);
    btFemChamber& chamber = cavities.at(0);
    const double p0 = 2e4, gas = p0 * volumeOf(*ball, chamber);
    chamber.m_sealed = true;
    chamber.m_gas = btScalar(gas);
    chamber.m_outsidePressure = btScalar(p0);
    fem.addChamber(ball, chamber);
    const double V0 = volumeOf(*ball, chamber);
    const auto gasEnergy = [&](double V) { return p0 * V - gas * std::log(V / V0); };
    const double before = elasticEnergy(*ball, fem, mesh, young) + gasEnergy(V0);

    btAlignedObjectArray<btFemActuatorReport> report;
    double work = 0, force = 0;
    const double speed = 0.025;
    for (int k = 1; k <= 120; ++k)
    {
        for (const int side : {0, 1})
        {
            const double z = 0.111 - speed * kStep * k;
            plates[side]->getMotionState()->setWorldTransform(at(0, 0, static_cast<btScalar>(side == 0 ? -z : z)));
        }
        world.step();
        force = 0.5 * (double(fem.contactForce(ball, plates[0]).z()) - double(fem.contactForce(ball, plates[1]).z()));
        work += 2 * force * speed * kStep;
        fem.getActuators(ball, report);
        const double V = volumeOf(*ball, chamber);
        EXPECT_NEAR((double(report[0].m_pressure) + p0) * V, gas, 1e-3 * gas) << k;
    }
    EXPECT_LE(norm(impulseOn(fem, *ball)), 0.02 * force * kStep);  // the plates press equally
    const double V = volumeOf(*ball, chamber);
    EXPECT_LT(V, 0.9 * V0);
    const double gasWork = gasEnergy(V) - gasEnergy(V0);
    const double stored = elasticEnergy(*ball, fem, mesh, young) + gasEnergy(V) - before;
    EXPECT_GT(gasWork, 0.08 * stored);
    EXPECT_NEAR(work, stored, 0.025 * stored);
}

// Soft walls around a gas 500 times stiffer, which the contact solver's compliance does not include.
TEST_P(Pneumatics, ABallOfAStiffGasFallsAndRests)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, GetParam());
    btRigidBody& ground = world.addPlane();
    btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), hollowSphere(0.08, 0.1, 6, 2));
    ball->translate({0, 0, btScalar(0.3)});
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e5);
    material.m_density = 1000;
    material.m_bending = btFemBending::plain;
    fem.setMaterial(ball, material);
    world.addSoft(ball);
    fem.prepare(ball, kStep);
    std::vector<btFemChamber> cavities;
    btFemChamber::find(ball, cavities);
    btFemChamber& chamber = cavities.at(0);
    const double V0 = volumeOf(*ball, chamber);
    chamber.m_sealed = true;
    chamber.m_outsidePressure = btScalar(5e7);
    chamber.m_gas = btScalar(5e7 * V0);
    fem.addChamber(ball, chamber);
    for (int k = 0; k < 360; ++k)
    {
        world.step();
        EXPECT_NEAR(volumeOf(*ball, chamber), V0, 1e-2 * V0) << k;
        EXPECT_LT(fem.stepReport(ball).m_iterations, 30) << k;
    }
    const double weight = massOf(*ball) * kGravity;
    EXPECT_NEAR(fem.contactForce(ball, &ground).z(), weight, 0.02 * weight);
    EXPECT_LT(fastestNode(*ball), 0.02);
    EXPECT_GT(lowestHeight(*ball), -1e-3);
}

// A finger of .025 x .02 x .12 m that hangs from its upper end. Its chambers are on the side away from x = 0: they
// lengthen that side, so that the finger bends to x = 0. `side` is -1 or 1.
TetMesh fingerMesh(int side, double gap)
{
    const auto isHole = [side, gap](const Vec3& X)
    {
        const double depth = 0.025 - (side * X.x - gap);  // below the outer side
        const int z = static_cast<int>(X.z / 0.005), d = static_cast<int>(depth / 0.005);
        return (d == 1 || d == 2) && std::fabs(X.y) < 0.005 && z % 4 != 0 && z != 23;
    };
    return withHoles(makeBox({0.025, 0.02, 0.12}, {5, 4, 24}, {side < 0 ? -gap - 0.025 : gap, -0.01, 0}), isHole);
}

class Fingers
{
public:
    explicit Fingers(Coupling coupling) : m_world(m_fem, coupling)
    {
        RigidSettings slab;  // not a plane: Bullet's small boxes wobble on planes
        slab.m_transform = at(0, 0, btScalar(-0.05));
        addRigidBox(m_world, {1, 1, 0.1}, slab);
        for (const int side : {-1, 1})
        {
            btSoftBody* finger = btFemHelpers::createFromTetMesh(m_world.info(), fingerMesh(side, 0.0145));
            finger->translate({0, 0, btScalar(0.03)});
            btFemMaterial material;
            material.m_youngModulus = btScalar(1e5);
            material.m_poissonRatio = btScalar(0.4);
            material.m_density = 1100;
            material.m_bending = btFemBending::plain;  // softer walls of one cell burst at 35 kPa, a third of E
            m_fem.setMaterial(finger, material);
            finger->m_cfg.kDF = 1;
            m_world.addSoft(finger);
            m_fem.prepare(finger, kStep);
            std::vector<btFemChamber> cavities;
            btFemChamber::find(finger, cavities);
            EXPECT_EQ(cavities.size(), 6u);
            Finger added;
            added.m_body = finger;
            for (const btFemChamber& chamber : cavities) added.m_chambers.push_back(m_fem.addChamber(finger, chamber));
            for (int i = 0; i < finger->m_nodes.size(); ++i)
                if (finger->m_nodes[i].m_x.z() > btScalar(0.1499)) added.m_clamp.push_back(i);
            for (const int node : added.m_clamp) added.m_at.push_back(finger->m_nodes[node].m_x);
            m_fingers.push_back(added);
        }
        hold(0);
    }

    // Moves the upper ends to this height above their start [m].
    void hold(double height)
    {
        for (Finger& finger : m_fingers)
        {
            std::vector<btVector3> places = finger.m_at;
            for (btVector3& place : places) place.setZ(place.z() + static_cast<btScalar>(height));
            m_fem.setNodeTargets(finger.m_body, finger.m_clamp.data(), static_cast<int>(finger.m_clamp.size()),
                                 places.data());
        }
    }

    void setPressure(double pressure)
    {
        for (Finger& finger : m_fingers)
            for (const int chamber : finger.m_chambers)
                m_fem.setChamberPressure(finger.m_body, chamber, static_cast<btScalar>(pressure));
    }

    // Distance of the tips' inner faces [m].
    double opening() const
    {
        btScalar sides[2] = {-1, 1};
        for (int f = 0; f < 2; ++f)
        {
            const btSoftBody& body = *m_fingers[f].m_body;
            for (int i = 0; i < body.m_nodes.size(); ++i)
                sides[f] =
                    f == 0 ? std::max(sides[f], body.m_nodes[i].m_x.x()) : std::min(sides[f], body.m_nodes[i].m_x.x());
        }
        return sides[1] - sides[0];
    }

    struct Finger
    {
        btSoftBody* m_body = nullptr;
        std::vector<int> m_chambers, m_clamp;
        std::vector<btVector3> m_at;
    };
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    std::vector<Finger> m_fingers;
};

TEST_P(Pneumatics, FingersBendWithPressureAndStraightenWithout)
{
    Fingers fingers(GetParam());
    fingers.m_world.step(60);
    const double open = fingers.opening();
    EXPECT_NEAR(open, 0.029, 0.001);
    for (int k = 1; k <= 60; ++k)
    {
        fingers.setPressure(10000.0 * k / 60);
        fingers.m_world.step();
    }
    fingers.m_world.step(60);
    const double half = open - fingers.opening();
    EXPECT_GT(half, 0.004);
    fingers.setPressure(0);
    fingers.m_world.step(120);
    EXPECT_NEAR(fingers.opening(), open, 3e-4);
}

// Two fingers grip a box of 10 g and lift it.
TEST_P(Pneumatics, FingersGripAndLiftABox)
{
    Fingers fingers(GetParam());
    RigidSettings settings;
    settings.m_mass = btScalar(0.01);
    settings.m_transform = at(0, 0, btScalar(0.025));
    btRigidBody& box = addRigidBox(fingers.m_world, {0.025, 0.025, 0.05}, settings);
    for (int k = 1; k <= 90; ++k)
    {
        fingers.setPressure(35000.0 * std::min(1.0, k / 60.0));
        fingers.m_world.step();
    }
    for (int k = 1; k <= 120; ++k)
    {
        fingers.hold(0.05 * std::min(1.0, k / 90.0));
        fingers.m_world.step();
    }
    EXPECT_NEAR(box.getWorldTransform().getOrigin().z(), 0.025 + 0.05, 0.003);
    EXPECT_LT(box.getLinearVelocity().length(), 0.02);
    const Vec3 left = impulseOn(fingers.m_fem, *fingers.m_fingers[0].m_body, &box),
               right = impulseOn(fingers.m_fem, *fingers.m_fingers[1].m_body, &box);
    const double weight = 0.01 * kGravity * kStep;
    EXPECT_NEAR(-left.z - right.z, weight, 0.1 * weight);
    EXPECT_LT(left.x, -weight / 2);
    EXPECT_GT(right.x, weight / 2);
}
INSTANTIATE_TEST_SUITE_P(Couplings, Pneumatics, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

}  // namespace
}  // namespace bullet_fem
