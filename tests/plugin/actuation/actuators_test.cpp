// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Chambers, cables, fibres and expansions of bodies in Bullet's worlds: adding, changing, reading and saving them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plugin/scenes/hollow_cube.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/sleeping_world.h"

namespace bullet_fem
{
namespace
{

class ActuatorsOfABody : public SleepingScene, public testing::Test
{
protected:
    ActuatorsOfABody() { addGround(); }

    btFemActuatorReport report(const btSoftBody& body, int actuator)
    {
        btAlignedObjectArray<btFemActuatorReport> all;
        EXPECT_TRUE(m_fem.getActuators(&body, all));
        for (int k = 0; k < all.size(); ++k)
            if (all[k].m_actuator == actuator) return all[k];
        ADD_FAILURE() << "no actuator " << actuator;
        return {};
    }

    // The sleeping body is woken by `change` in the next step.
    template <class Change>
    void expectWakes(btSoftBody& body, const Change& change)
    {
        sleepAll(body);
        change();
        m_world.step(1);
        EXPECT_NE(body.getActivationState(), ISLAND_SLEEPING);
    }

    template <class Call>
    void expectRefused(const Call& call, const std::string& part)
    {
        std::string why;
        EXPECT_FALSE(call(&why));
        EXPECT_NE(why.find(part), std::string::npos) << why;
        EXPECT_THROW(call(nullptr), std::invalid_argument);
    }
};

TEST_F(ActuatorsOfABody, AreToldAsTheyAre)
{
    btSoftBody& body = addHollowCube(m_world, m_fem, {0, 0, btScalar(0.001)});
    m_fem.prepare(&body, kStep);
    btFemChamber chamber = cavityOf(body);
    chamber.m_pressure = 2000;
    btFemCable given = cableThrough({corner(0, 0), corner(1, 0)}),
               elastic = cableThrough({corner(0, 0), corner(1, 0), corner(1, 1)});
    given.m_tension = 3;
    elastic.m_stiffness = 500;
    elastic.m_restLength = btScalar(0.59);
    btFemFibres fibres;
    fibres.m_directions = {{0, 0, 1}};
    fibres.m_activation = 100;
    btFemExpansion expansion;
    expansion.m_strain = btScalar(0.01);
    const int handles[] = {m_fem.addChamber(&body, chamber), m_fem.addCable(&body, given),
                           m_fem.addCable(&body, elastic), m_fem.addFibres(&body, fibres),
                           m_fem.addExpansion(&body, expansion)};
    EXPECT_NEAR(report(body, handles[0]).m_volume, 1e-3, 1e-8);
    EXPECT_EQ(report(body, handles[0]).m_pressure, 2000);
    EXPECT_NEAR(report(body, handles[1]).m_length, 0.3, 1e-6);
    EXPECT_EQ(report(body, handles[1]).m_tension, 3);
    EXPECT_NEAR(report(body, handles[2]).m_length, 0.6, 1e-6);
    EXPECT_NEAR(report(body, handles[2]).m_tension, 5, 1e-3);
    EXPECT_EQ(report(body, handles[3]).m_activation, 100);
    EXPECT_NEAR(report(body, handles[4]).m_strain, 0.01, 1e-8);
    btAlignedObjectArray<btFemActuatorReport> all;
    m_fem.getActuators(&body, all);
    ASSERT_EQ(all.size(), 5);
    EXPECT_EQ(all[0].m_kind, btFemActuatorKind::chamber);
    EXPECT_EQ(all[4].m_kind, btFemActuatorKind::expansion);

    m_fem.setChamberPressure(&body, handles[0], 5000);
    m_fem.setCableTension(&body, handles[1], 1);
    m_fem.setCableRestLength(&body, handles[2], btScalar(0.61));
    m_fem.setActivation(&body, handles[3], 50);
    m_fem.setExpansion(&body, handles[4], 0);
    EXPECT_EQ(report(body, handles[0]).m_pressure, 5000);
    EXPECT_EQ(report(body, handles[1]).m_tension, 1);
    EXPECT_EQ(report(body, handles[2]).m_tension, 0);
    EXPECT_EQ(report(body, handles[3]).m_activation, 50);
    EXPECT_EQ(report(body, handles[4]).m_strain, 0);

    for (const int handle : handles) EXPECT_TRUE(m_fem.removeActuator(&body, handle));
    EXPECT_TRUE(m_fem.removeActuator(&body, handles[0]));
    EXPECT_TRUE(m_fem.getActuators(&body, all));
    EXPECT_EQ(all.size(), 0);
    m_world.step(100);
    EXPECT_NEAR(lowestHeight(body), 0, 1e-3);
}

// A sealed chamber keeps its amount of gas while the body is deformed.
TEST_F(ActuatorsOfABody, KeepTheirGasWhenTheyAreSealed)
{
    btSoftBody& body = addHollowCube(m_world, m_fem, {0, 0, btScalar(0.001)});
    m_fem.prepare(&body, kStep);
    btFemChamber chamber = cavityOf(body);
    chamber.m_pressure = 20000;
    const int handle = m_fem.addChamber(&body, chamber);
    m_world.step(120);
    const btFemActuatorReport open = report(body, handle);
    EXPECT_GT(open.m_volume, 1.02e-3);
    m_fem.sealChamber(&body, handle);
    EXPECT_NEAR(report(body, handle).m_pressure, 20000, 5);
    m_world.step(120);
    EXPECT_NEAR(report(body, handle).m_volume / open.m_volume, 1, 2e-3);
    // Half of the gas: the pressure is below that outside.
    const double gas = (20000 + 101325.0) * double(open.m_volume);
    m_fem.setChamberGas(&body, handle, btScalar(0.5 * gas));
    m_world.step(120);
    const btFemActuatorReport half = report(body, handle);
    EXPECT_LT(half.m_pressure, 0);
    EXPECT_LT(half.m_volume, 1e-3);
    EXPECT_NEAR((double(half.m_pressure) + 101325) * half.m_volume, 0.5 * gas, 1e-5 * gas);
    m_fem.setChamberPressure(&body, handle, 20000);
    m_world.step(120);
    EXPECT_NEAR(report(body, handle).m_volume / open.m_volume, 1, 2e-3);
}

TEST_F(ActuatorsOfABody, WakeItWhenTheyChange)
{
    btSoftBody& body = addHollowCube(m_world, m_fem, {0, 0, btScalar(0.001)});
    m_fem.prepare(&body, kStep);
    body.forceActivationState(ACTIVE_TAG);
    int chamber = 0, cable = 0, elastic = 0, fibres = 0;
    expectWakes(body, [&] { chamber = m_fem.addChamber(&body, cavityOf(body)); });
    expectWakes(body, [&] { m_fem.setChamberPressure(&body, chamber, 3000); });
    expectWakes(body, [&] { m_fem.sealChamber(&body, chamber); });
    expectWakes(body, [&] { cable = m_fem.addCable(&body, cableThrough({corner(0, 0), corner(1, 0)})); });
    expectWakes(body, [&] { m_fem.setCableTension(&body, cable, 2); });
    btFemCable stretching = cableThrough({corner(0, 0), corner(1, 0)});
    stretching.m_stiffness = 100;
    stretching.m_restLength = btScalar(0.25);
    expectWakes(body, [&] { elastic = m_fem.addCable(&body, stretching); });
    expectWakes(body, [&] { m_fem.setCableRestLength(&body, elastic, btScalar(0.2)); });
    btFemFibres muscle;
    muscle.m_directions = {{1, 0, 0}};
    muscle.m_activation = 1000;
    expectWakes(body, [&] { fibres = m_fem.addFibres(&body, muscle); });
    expectWakes(body, [&] { m_fem.setActivation(&body, fibres, 2000); });
    for (const int handle : {chamber, cable, elastic, fibres})
        expectWakes(body, [&] { m_fem.removeActuator(&body, handle); });
    // An equal value is no change.
    sleepAll(body);
    m_world.step(1);
    EXPECT_EQ(body.getActivationState(), ISLAND_SLEEPING);
}

// A body in free fall keeps its shape when it is moved by hand.
TEST_F(ActuatorsOfABody, GoWithItWhenItIsMoved)
{
    btSoftBody& body = addHollowCube(m_world, m_fem, {0, 0, 20});
    m_fem.prepare(&body, kStep);
    btFemChamber chamber = cavityOf(body);
    chamber.m_sealed = true;
    chamber.m_gas = btScalar(101.325 * 1.2);
    const int handle = m_fem.addChamber(&body, chamber);
    m_world.step(40);
    const double volume = report(body, handle).m_volume;
    body.rotate(btQuaternion(btVector3(1, 2, 3).normalized(), 1));
    body.translate({300, -200, 50});
    m_world.step(40);
    EXPECT_NEAR(report(body, handle).m_volume, volume, 1e-3 * volume);
    EXPECT_LT(fastestNode(body), 9.81 * 80 / 60 * 1.05);
}

// 3 % larger, for any material.
TEST_F(ActuatorsOfABody, KeepTheirStrainWithAnotherMaterial)
{
    btSoftBody& body = addCube();
    m_world.step(1);
    btFemExpansion expansion;
    expansion.m_strain = btScalar(0.03);
    m_fem.addExpansion(&body, expansion);
    m_world.step(200);
    const auto edge = [&]
    { return (body.m_nodes[body.m_nodes.size() - 1].m_x - body.m_nodes[0].m_x).length() / std::sqrt(3.0); };
    EXPECT_NEAR(edge(), 0.4 * 1.03, 3e-4);
    btFemMaterial hard;
    hard.m_youngModulus = btScalar(1e7);
    hard.m_poissonRatio = btScalar(0.45);
    m_fem.setMaterial(&body, hard);
    m_world.step(200);
    EXPECT_NEAR(edge(), 0.4 * 1.03, 1e-4);
}

// Adds to the initial stress set by the user.
TEST_F(ActuatorsOfABody, AddToTheInitialStress)
{
    btSoftBody& body = addCube();
    m_world.step(1);
    const btFemStress own = {1000, 0, 0, 0, 0, 0};
    btAlignedObjectArray<btFemStress> stress, read;
    for (int e = 0; e < body.m_tetras.size(); ++e) stress.push_back(own);
    for (int i = 0; i < body.m_nodes.size(); ++i) body.setMass(i, 0);
    m_fem.setInitialStress(&body, stress);
    btFemFibres fibres;
    fibres.m_directions = {{0, 0, 1}};
    fibres.m_activation = 500;
    const int handle = m_fem.addFibres(&body, fibres);
    const auto expect = [&](double xx, double zz)
    {
        m_world.step(1);
        m_fem.getStress(&body, read);
        EXPECT_NEAR(read[7].m_xx, xx, 1);
        EXPECT_NEAR(read[7].m_zz, zz, 1);
    };
    expect(1000, 500);
    for (int e = 0; e < stress.size(); ++e) stress[e].m_xx = 3000;
    m_fem.setInitialStress(&body, stress);
    expect(3000, 500);
    m_fem.removeActuator(&body, handle);
    expect(3000, 0);
}

TEST_F(ActuatorsOfABody, SumTheirActivationInEveryTetrahedron)
{
    btSoftBody& body = addCube();
    btAlignedObjectArray<btScalar> activation;
    activation.push_back(3);
    EXPECT_FALSE(m_fem.getActivation(nullptr, activation));
    EXPECT_EQ(activation.size(), 0);
    m_world.step(1);
    EXPECT_FALSE(m_fem.getActivation(&body, activation)) << "without fibres";
    btFemFibres all, some;
    all.m_directions = {{0, 0, 1}};
    all.m_activation = 500;
    some.m_directions = {{1, 0, 0}};
    some.m_activation = -200;
    some.m_tets = {2, 7};
    const int everywhere = m_fem.addFibres(&body, all);
    m_fem.addFibres(&body, some);
    ASSERT_TRUE(m_fem.getActivation(&body, activation));
    ASSERT_EQ(activation.size(), body.m_tetras.size());
    for (int e = 0; e < activation.size(); ++e) EXPECT_EQ(activation[e], e == 2 || e == 7 ? 300 : 500) << e;
    m_fem.removeActuator(&body, everywhere);
    ASSERT_TRUE(m_fem.getActivation(&body, activation));
    EXPECT_EQ(activation[1], 0);
    EXPECT_EQ(activation[7], -200);
}

TEST_F(ActuatorsOfABody, OutOfRangeAreRefused)
{
    btSoftBody& body = addHollowCube(m_world, m_fem, {0, 0, btScalar(0.001)});
    const btFemChamber good = cavityOf(body);
    const auto add = [&](const btFemChamber& chamber)
    { return [&body, chamber, this](std::string* why) { return m_fem.addChamber(&body, chamber, why); }; };
    expectRefused(add(good), "addChamber: the body is not moved by finite elements");
    m_fem.prepare(&body, kStep);
    btFemChamber bad = good;
    bad.m_triangles.pop_back();
    expectRefused(add(bad), "give three a triangle");
    bad.m_triangles.resize(bad.m_triangles.size() - 2);
    expectRefused(add(bad), "addChamber: the chamber is not closed");
    bad = good;
    bad.m_pressure = std::numeric_limits<btScalar>::quiet_NaN();
    expectRefused(add(bad), "the chamber's pressure is");
    const int chamber = m_fem.addChamber(&body, good);
    EXPECT_GT(chamber, 0);
    expectRefused([&](std::string* why) { return m_fem.setChamberGas(&body, chamber, -1, why); },
                  "setChamberGas: the chamber's gas is -1, not in [0, 1");
    expectRefused([&](std::string* why) { return m_fem.setChamberPressure(&body, 77, 0, why); },
                  "setChamberPressure: the body has no chamber 77; give what the function that added it returned");
    expectRefused(
        [&](std::string* why) {
            return m_fem.addCable(&body, cableThrough({0, 100000}), why);
        },
        "addCable: node 100000 of the cable");
    const int cable = m_fem.addCable(&body, cableThrough({corner(0, 0), corner(1, 0)}));
    expectRefused([&](std::string* why) { return m_fem.setCableTension(&body, cable, -1, why); }, "tension is -1");
    expectRefused([&](std::string* why) { return m_fem.setCableRestLength(&body, cable, 1, why); },
                  "call setCableTension");
    btFemCable stretching = cableThrough({corner(0, 0), corner(1, 0)});
    stretching.m_stiffness = 100;
    const int elastic = m_fem.addCable(&body, stretching);
    expectRefused([&](std::string* why) { return m_fem.setCableTension(&body, elastic, 1, why); },
                  "call setCableRestLength");
    expectRefused([&](std::string* why) { return m_fem.addFibres(&body, {}, why); }, "have 0 directions");
    btFemFibres fibres;
    fibres.m_directions = {{1, 0, 0}};
    const int muscle = m_fem.addFibres(&body, fibres);
    expectRefused([&](std::string* why) { return m_fem.setActivation(&body, muscle, btScalar(2e13), why); },
                  "the fibres' activation is");
    btFemExpansion expansion;
    expansion.m_strain = -1;
    expectRefused([&](std::string* why) { return m_fem.addExpansion(&body, expansion, why); },
                  "the expansion's strain is -1, not in [-0.9, 9]");
    std::vector<btFemChamber> cavities;
    expectRefused([&](std::string* why) { return btFemChamber::find(nullptr, cavities, why); }, "null");
    m_world.step(60);
    EXPECT_TRUE(allFinite(body));
}

// One iteration would not converge for such a body.
TEST_F(ActuatorsOfABody, AreIteratedToTheToleranceInAnyDetail)
{
    btSoftBody& body = addHollowCube(m_world, m_fem, {0, 0, 20});
    m_fem.prepare(&body, kStep);
    m_fem.setDetail(&body, btFemDetail::direct);
    m_world.step(1);
    EXPECT_EQ(m_fem.stepReport(&body).m_detail, btFemDetail::direct);
    const int handle = m_fem.addChamber(&body, cavityOf(body));
    m_world.step(1);
    EXPECT_EQ(m_fem.stepReport(&body).m_detail, btFemDetail::globalWarp);
    m_fem.removeActuator(&body, handle);
    m_world.step(1);
    EXPECT_EQ(m_fem.stepReport(&body).m_detail, btFemDetail::direct);
}

// Removing a tetrahedron recreates the body without actuators.
TEST_F(ActuatorsOfABody, AreLostWhenTheMeshChanges)
{
    btSoftBody& body = addHollowCube(m_world, m_fem, {0, 0, btScalar(0.001)});
    m_fem.prepare(&body, kStep);
    m_fem.addChamber(&body, cavityOf(body));
    m_world.step(2);
    body.m_tetras.pop_back();
    m_world.step(2);
    btAlignedObjectArray<btFemActuatorReport> all;
    EXPECT_TRUE(m_fem.getActuators(&body, all));
    EXPECT_EQ(all.size(), 0);
}

}  // namespace
}  // namespace bullet_fem
