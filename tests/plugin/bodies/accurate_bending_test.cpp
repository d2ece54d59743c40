// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies with accurate bending in a Bullet world: contact, copies, saved states, baked files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;

btFemMaterial bendingMaterial(btScalar young, btScalar nu, bool isAccurate = true)
{
    btFemMaterial material;
    material.m_youngModulus = young;
    material.m_poissonRatio = nu;
    material.m_bending = isAccurate ? btFemBending::accurate : btFemBending::plain;
    return material;
}

class BendingScene
{
public:
    explicit BendingScene(Coupling coupling = Coupling::coupled, const btFemSolverInfo& info = {})
        : m_fem(info), m_world(m_fem, coupling)
    {
    }

    btSoftBody& add(const SoftBox& box, const btFemMaterial& material)
    {
        btSoftBody* body = makeSoftBox(m_world, m_fem, box);
        m_fem.setMaterial(body, material);
        return m_world.addSoft(body);
    }

    // A plank that falls on a ledge, and a cube on the plank.
    void addPile()
    {
        m_world.addFloorBox();
        RigidSettings step;
        step.m_transform.setOrigin({btScalar(.2), 0, btScalar(.1)});
        addRigidBox(m_world, {.2, .6, .2}, step);
        SoftBox plank;
        plank.m_size = {1.2, .3, .1};
        plank.m_cells = {12, 3, 2};
        plank.m_center = {0, 0, .27};
        add(plank, bendingMaterial(btScalar(3e6), btScalar(.45)));
        SoftBox cube;
        cube.m_size = {.2, .2, .2};
        cube.m_cells = {3, 3, 3};
        cube.m_center = {-.3, 0, .45};
        add(cube, bendingMaterial(btScalar(1e6), btScalar(.3)));
    }

    std::vector<btScalar> run(int steps)
    {
        std::vector<btScalar> bits;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (int b = 0; b < m_world.softBodies().size(); ++b)
                for (const btScalar bit : bitsOf(*m_world.softBodies()[b])) bits.push_back(bit);
        }
        return bits;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
};

// A bar of kLength x kHeight x kHeight with n cells across, clamped at one end: sag of the tip under its own weight
// over that of a beam, w = 12 rho g L^4 / (8 E h^2) + rho g L^2 / (2 kappa G), after the swing is damped out.
double sagOverBeam(btFemBending bending, int n)
{
    constexpr double kLength = 2, kHeight = .2, kYoung = 1e8, kNu = .3;  // [m], [Pa]
    BendingScene scene;
    SoftBox box;
    box.m_size = {kLength, kHeight, kHeight};
    box.m_cells = {10 * n, n, n};
    btSoftBody* body = makeSoftBox(scene.m_world, scene.m_fem, box);
    const btScalar end = btScalar(kLength / 2 - 1e-4);
    std::vector<int> tip;
    for (int i = 0; i < body->m_nodes.size(); ++i)
    {
        if (body->m_nodes[i].m_x.x() < -end) body->setMass(i, 0);
        if (body->m_nodes[i].m_x.x() > end) tip.push_back(i);
    }
    btFemMaterial material = bendingMaterial(btScalar(kYoung), btScalar(kNu));
    material.m_bending = bending;
    material.m_massDamping = 8;
    scene.m_fem.setMaterial(body, material);
    scene.m_world.addSoft(body);
    scene.m_world.step(180);
    double sag = 0;
    for (const int i : tip) sag -= double(body->m_nodes[i].m_x.z()) / double(tip.size());
    const double shear = kYoung / (2 * (1 + kNu)), kappa = 10 * (1 + kNu) / (12 + 11 * kNu);
    return sag /
           (1000 * kGravity *
            (12 * std::pow(kLength, 4) / (8 * kYoung * kHeight * kHeight) + kLength * kLength / (2 * kappa * shear)));
}

TEST(AccurateBendingBodies, SagAsBeamsDo)
{
    EXPECT_NEAR(sagOverBeam(btFemBending::accurate, 4), 1, .03);
}

// The contact force is the weight to 1e-5, without creep and without penetration.
TEST(AccurateBendingBodies, RestOnTheFloor)
{
    for (const Coupling coupling : {Coupling::swap, Coupling::coupled})
        for (const double nu : {.3, .49})
        {
            SCOPED_TRACE(std::string(couplingName(coupling)) + ", nu " + std::to_string(nu));
            BendingScene scene(coupling);
            btRigidBody& floor = scene.m_world.addFloorBox();
            SoftBox box;
            box.m_center = {0, 0, .505};
            btSoftBody& body = scene.add(box, bendingMaterial(btScalar(1e6), btScalar(nu)));
            scene.m_world.step(300);
            const double weight = massOf(body) * kGravity;
            EXPECT_NEAR(double(scene.m_fem.contactForce(&body, &floor).z()), weight, 1e-5 * weight);
            EXPECT_LT(fastestNode(body), 3e-4);
            EXPECT_GT(lowestHeight(body), -1e-4);
            const Vec3 before = centerOf(body);
            scene.m_world.step(120);
            EXPECT_LT(norm(centerOf(body) - before), 1e-5);
        }
}

// Coulomb's law: the body sticks below tan^-1 mu, and above it slides with g (sin - mu cos).
TEST(AccurateBendingBodies, SlideAsCoulombSays)
{
    for (const double angle : {25., 28.})
    {
        BendingScene scene;
        const double a = angle * M_PI / 180, mu = .5;
        const btVector3 down(btScalar(std::cos(a)), 0, btScalar(-std::sin(a)));
        RigidSettings ramp;
        ramp.m_transform.setRotation(btQuaternion({0, 1, 0}, btScalar(a)));
        ramp.m_transform.setOrigin(ramp.m_transform.getBasis() * btVector3(0, 0, -1));
        addRigidBox(scene.m_world, {100, 100, 2}, ramp);
        SoftBox box;
        box.m_friction = btScalar(mu);
        btSoftBody* body = makeSoftBox(scene.m_world, scene.m_fem, box);
        scene.m_fem.setMaterial(body, bendingMaterial(btScalar(1e6), btScalar(.3)));
        body->transform(
            btTransform(ramp.m_transform.getRotation(), ramp.m_transform.getBasis() * btVector3(0, 0, btScalar(.501))));
        scene.m_world.addSoft(body);
        scene.m_world.step(60);
        const double before = velocityOf(*body).x * double(down.x()) + velocityOf(*body).z * double(down.z());
        scene.m_world.step(60);
        const double after = velocityOf(*body).x * double(down.x()) + velocityOf(*body).z * double(down.z());
        const double exact = std::max(0., kGravity * (std::sin(a) - mu * std::cos(a)));
        EXPECT_NEAR(after - before, exact, .01) << angle;
    }
}

TEST(AccurateBendingBodies, HaveTheSameBitsOnAnyThreads)
{
    std::vector<btScalar> bits;
    for (const int threads : {1, 2, 3, 8})
    {
        btFemSolverInfo info;
        info.m_threads = threads;
        BendingScene scene(Coupling::coupled, info);
        scene.addPile();
        const std::vector<btScalar> own = scene.run(40);
        if (bits.empty()) bits = own;
        EXPECT_TRUE(own == bits) << threads;
        EXPECT_GT(scene.m_fem.contacts(scene.m_world.softBodies()[0]).size(), 4);
    }
}

// Such bodies are solved one by one, unlike other copies of one model.
TEST(AccurateBendingBodies, HaveTheSameBitsBesideCopies)
{
    std::vector<btScalar> bits;
    for (const bool batches : {false, true})
    {
        btFemSolverInfo info;
        info.m_batchBodies = batches;
        BendingScene scene(Coupling::coupled, info);
        scene.m_world.addFloorBox();
        for (int k = 0; k < 6; ++k)
        {
            SoftBox box;
            box.m_size = {.2, .2, .2};
            box.m_cells = {3, 3, 3};
            box.m_center = {.4 * k, 0, .15 + .02 * k};
            box.m_turn = .3 * k;
            scene.add(box, bendingMaterial(btScalar(1e5), btScalar(.3)));
        }
        const std::vector<btScalar> own = scene.run(30);
        if (bits.empty()) bits = own;
        EXPECT_TRUE(own == bits) << batches;
    }
}

TEST(AccurateBendingBodies, GoOnToTheBitAfterASnapshot)
{
    BendingScene scene;
    scene.addPile();
    scene.run(20);
    std::vector<unsigned char> state, definition;
    ASSERT_TRUE(scene.m_fem.saveState(state));
    const BulletState bullet(scene.m_world);
    bullet.restore(scene.m_world);
    const std::vector<btScalar> bits = scene.run(20);
    bullet.restore(scene.m_world);
    ASSERT_TRUE(scene.m_fem.restoreState(state.data(), state.size()));
    EXPECT_TRUE(scene.run(20) == bits);

    // A definition gives another body the material; without it the state is refused.
    btSoftBody* plank = scene.m_world.softBodies()[0];
    ASSERT_TRUE(scene.m_fem.saveDefinition(plank, definition));
    scene.m_fem.setMaterial(plank, bendingMaterial(btScalar(3e6), btScalar(.45), false));
    std::string why;
    EXPECT_FALSE(scene.m_fem.restoreState(state.data(), state.size(), &why));
    EXPECT_THAT(why, HasSubstr("its material is another"));
    ASSERT_TRUE(scene.m_fem.applyDefinition(plank, definition.data(), definition.size(), &why)) << why;
    scene.run(1);
    bullet.restore(scene.m_world);
    ASSERT_TRUE(scene.m_fem.restoreState(state.data(), state.size(), &why)) << why;
    EXPECT_TRUE(scene.run(20) == bits);
}

// Two cells across are thin, four are not: these sag by .9 of a beam's with the plain element, and by 1 with the other.
TEST(AccurateBendingBodies, AreChosenWhereBodiesAreThin)
{
    const double thin = sagOverBeam(btFemBending::automatic, 2), thick = sagOverBeam(btFemBending::automatic, 4);
    EXPECT_EQ(thin, sagOverBeam(btFemBending::accurate, 2));
    EXPECT_EQ(thick, sagOverBeam(btFemBending::plain, 4));
    EXPECT_NEAR(thin, 1, .06);
    EXPECT_LT(sagOverBeam(btFemBending::plain, 2), .8);
    EXPECT_LT(thick, .93);
}

// Programs, scenes, baked bodies and Python start from one material.
TEST(AccurateBendingBodies, AreChosenByDefault)
{
    EXPECT_EQ(btFemMaterial().m_bending, btFemBending::automatic);
    Material material = withProgramDefaults({});
    EXPECT_EQ(material.m_bending, Bending::automatic);
    EXPECT_FLOAT_EQ(float(btFemMaterial().m_stiffnessDamping), float(material.m_stiffnessDamping));
    material.m_stiffnessDamping = 0.1;
    EXPECT_EQ(withProgramDefaults(material).m_stiffnessDamping, 0.1);
    EXPECT_EQ(sagOverBeam(btFemMaterial().m_bending, 2), sagOverBeam(btFemBending::accurate, 2));
}

TEST(AccurateBendingBodies, RejectIncompatibleOptions)
{
    BendingScene scene;
    SoftBox box;
    btSoftBody* body = makeSoftBox(scene.m_world, scene.m_fem, box);
    const auto expectRefused = [&](btFemMaterial material, const char* what)
    {
        std::string why;
        EXPECT_FALSE(material.valid(&why));
        EXPECT_THAT(why, HasSubstr(what));
        EXPECT_THROW(scene.m_fem.setMaterial(body, material), std::invalid_argument);
    };
    btFemMaterial material = btFemMaterial::jelly();
    material.m_bending = btFemBending::accurate;
    EXPECT_TRUE(material.valid());
    material = btFemMaterial::clay();
    material.m_bending = btFemBending::accurate;
    EXPECT_TRUE(material.valid());
    material = bendingMaterial(btScalar(1e6), btScalar(.3));
    material.m_meanDilatation = btFemMeanDilatation::off;
    expectRefused(material, "accurate bending does not go with mean dilatation off");
    scene.m_world.addSoft(body);
}

}  // namespace
}  // namespace bullet_fem
