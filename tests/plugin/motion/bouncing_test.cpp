// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/fem/step/stepping.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kReach = 0.25;        // radius of balls, half an edge of cubes [m]
constexpr double kImpactSpeed = 4.43;  // as after a fall of a metre [m/s]
constexpr double kPlateMass = 100, kBoxMass = 50;

enum class BounceScene
{
    onFloor,    // a soft body that falls on a static box
    freePlate,  // a free rigid plate that runs into a soft body, without gravity
    twoSoft,    // a soft body that runs into another, without gravity
    onBed       // a rigid body that falls on a soft cube, which lies on the floor
};

const char* sceneName(BounceScene scene)
{
    return scene == BounceScene::onFloor     ? "onFloor"
           : scene == BounceScene::freePlate ? "freePlate"
           : scene == BounceScene::twoSoft   ? "twoSoft"
                                             : "onBed";
}

struct BounceBody
{
    bool m_isBall = true;
    double m_youngModulus = 1e6, m_stiffnessDamping = 0, m_restitution = 0;
};

struct BounceSteps
{
    Coupling m_coupling;
    int m_rate;                                   // [1/s]
    double m_numericalDamping, m_contactDamping;  // [-]
};

// Two bodies that meet at kImpactSpeed along z. The soft body's partner has restitution 1.
class Impactors
{
public:
    Impactors(BounceScene scene, const BounceBody& body, const BounceSteps& steps)
        : m_scene(scene),
          m_step(1.0 / steps.m_rate),
          m_world(WorldClass::softRigid, steps.m_coupling, btVector3(0, 0, btScalar(hasGravity() ? -kGravity : 0)),
                  infoOf(steps))
    {
        const double gap = 0.02;
        BounceBody placed = body;
        placed.m_isBall = body.m_isBall && scene != BounceScene::onBed;
        m_soft = &add(placed, scene == BounceScene::onBed ? kReach : kReach + gap);
        if (hasGravity()) m_floor = &m_world.addFloorBox();
        if (scene == BounceScene::onFloor) m_floor->setRestitution(1);
        if (scene == BounceScene::onFloor || scene == BounceScene::twoSoft)
            m_soft->setVelocity(btVector3(0, 0, btScalar(-kImpactSpeed)));
        if (scene == BounceScene::twoSoft)
        {
            placed.m_restitution = 1;
            m_other = &add(placed, -kReach);
        }
        if (scene == BounceScene::freePlate) addRigid(false, {1, 1, 0.5}, kPlateMass, -kReach, kImpactSpeed);
        if (scene == BounceScene::onBed)
            addRigid(body.m_isBall, {0.5, 0.5, 0.5}, kBoxMass, 3 * kReach + gap, -kImpactSpeed);
        m_world.fem().prepare(m_soft, btScalar(m_step));
        if (m_other) m_world.fem().prepare(m_other, btScalar(m_step));
        m_startEnergy = m_maxEnergy = energy();
    }

    // Steps until they have separated, for three seconds at most; returns the separation speed over the impact speed.
    double returns()
    {
        int parted = 0;
        bool touched = false;
        for (int k = 0; k < 3 / m_step && parted < 3; ++k)
        {
            m_world.step(1, btScalar(m_step));
            const bool touches = norm(impulse()) > 0;
            touched = touched || touches;
            parted = touches || !touched ? 0 : parted + 1;
            m_maxEnergy = std::max(m_maxEnergy, energy());
        }
        return (speed() + (hasGravity() ? kGravity * m_step * parted : 0)) / kImpactSpeed;
    }

    Motion motion() const
    {
        Motion sum = motionOf(*m_soft);
        if (m_other) sum += motionOf(*m_other);
        if (m_rigid) sum += motionOf(*m_rigid);
        return sum;
    }

    double energy() const
    {
        double sum = energyOf(*m_soft) + (m_other ? energyOf(*m_other) : 0);
        if (m_rigid)
            sum += motionOf(*m_rigid).m_energy +
                   (hasGravity() ? kGravity * m_rigid->getWorldTransform().getOrigin().z() / m_rigid->getInvMass() : 0);
        return sum;
    }

    double m_startEnergy = 0, m_maxEnergy = 0;  // [J]

private:
    bool hasGravity() const { return m_scene == BounceScene::onFloor || m_scene == BounceScene::onBed; }

    static btFemSolverInfo infoOf(const BounceSteps& steps)
    {
        btFemSolverInfo info;
        info.m_numericalDamping = btScalar(steps.m_numericalDamping);
        info.m_contactDamping = btScalar(steps.m_contactDamping);
        info.m_elasticRebound = false;
        return info;
    }

    btSoftBody& add(const BounceBody& body, double height)
    {
        btSoftBody* soft =
            body.m_isBall ? btFemHelpers::createFromTetMesh(m_world.info(), makeSphere(kReach, 6))
                          : btFemHelpers::createBox(m_world.info(), {0, 0, 0},
                                                    {btScalar(kReach), btScalar(kReach), btScalar(kReach)}, 0.125f);
        soft->translate(btVector3(0, 0, btScalar(height)));
        btFemMaterial material;
        material.m_youngModulus = btScalar(body.m_youngModulus);
        material.m_density = 1000;
        material.m_stiffnessDamping = btScalar(body.m_stiffnessDamping);
        m_world.fem().setMaterial(soft, material);
        soft->setRestitution(btScalar(body.m_restitution));
        soft->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        return m_world.addSoft(soft);
    }

    void addRigid(bool isBall, const Vec3& size, double mass, double height, double speed)
    {
        RigidSettings settings;
        settings.m_mass = btScalar(mass);
        settings.m_transform = at(0, 0, btScalar(height));
        settings.m_velocity = btVector3(0, 0, btScalar(speed));
        m_rigid = isBall ? &m_world.addRigid(new btSphereShape(btScalar(kReach)), settings)
                         : &addRigidBox(m_world, size, settings);
        m_rigid->setRestitution(1);
    }

    Vec3 impulse() const
    {
        return impulseOn(m_world.fem(), *m_soft, m_scene == BounceScene::onBed ? m_rigid : nullptr);
    }

    // Separation speed; for a body on the floor or on a body there, its own speed.
    double speed() const
    {
        const double other = m_other ? velocityOf(*m_other).z : m_rigid ? double(m_rigid->getLinearVelocity().z()) : 0;
        return m_scene == BounceScene::onBed ? other : velocityOf(*m_soft).z - other;
    }

    double energyOf(const btSoftBody& soft) const
    {
        const btFemBodyRecord* record = btFemCoupling::record(m_world.fem(), soft);
        if (!record || !record->isFem()) return motionOf(soft).m_energy;  // not stepped yet
        return mechanicalEnergy(record->fem().m_body) + (hasGravity() ? massOf(soft) * kGravity * centerOf(soft).z : 0);
    }

    const BounceScene m_scene;
    const double m_step;  // [s]
    FemWorld m_world;
    btSoftBody *m_soft = nullptr, *m_other = nullptr;
    btRigidBody *m_rigid = nullptr, *m_floor = nullptr;
};

using BounceCase = std::tuple<BounceScene, bool, BounceSteps>;

class Bouncing : public testing::TestWithParam<BounceCase>
{
protected:
    static Impactors impactors(double young, double restitution)
    {
        const auto& [scene, isBall, steps] = GetParam();
        return {scene, {isBall, young, 0, restitution}, steps};
    }
};

// The larger of the set restitution and the rebound that the step leaves counts, which is measured with none set.
// Bodies whose vibrations contain the remaining energy may return less.
TEST_P(Bouncing, ReturnsTheSetRestitution)
{
    constexpr double kOff = 0.1;      // of the returns [-]
    constexpr double kRinging = 0.9;  // of the energy at the start [-]
    // The energy may rise by this factor in between: by unresolved vibrations, and by the expansion of stiff bodies
    // that start to spin within a step.
    const BounceSteps& steps = std::get<2>(GetParam());
    const double kSwing = steps.m_numericalDamping == steps.m_contactDamping ? 1.05 : 1.1;
    for (const double young : {1e5, 1e6, 1e7, 1e8})
    {
        Impactors alone = impactors(young, 0);
        const double own = alone.returns();
        for (const double set : {0.5, 0.8, 1.0})
        {
            Impactors bodies = impactors(young, set);
            const double returns = bodies.returns(), wanted = std::max(set, own);
            EXPECT_LE(returns, wanted + kOff) << young << ", " << set;
            const bool rings = bodies.energy() > kRinging * bodies.m_startEnergy;
            EXPECT_TRUE(returns > wanted - kOff || rings) << returns << " of " << wanted << ", " << young;
            EXPECT_LE(bodies.m_maxEnergy, std::max(kSwing * bodies.m_startEnergy, 1.001 * alone.m_maxEnergy))
                << young << ", " << set;
            EXPECT_LE(bodies.motion().m_energy, 1.01 * bodies.m_startEnergy) << young << ", " << set;
        }
    }
}

std::string nameOfBounce(const testing::TestParamInfo<BounceCase>& suite)
{
    const auto& [scene, isBall, steps] = suite.param;
    return std::string(sceneName(scene)) + (isBall ? "_ball_" : "_cube_") + couplingName(steps.m_coupling) + "_" +
           std::to_string(steps.m_rate) +
           (steps.m_numericalDamping > 0 ? "_euler"
            : steps.m_contactDamping > 0 ? "_eulerTouching"
                                         : "_secondOrder");
}

constexpr BounceSteps kEverySteps[] = {{Coupling::swap, 60, 0, 0},     {Coupling::swap, 60, 1, 1},
                                       {Coupling::swap, 60, 0, 1},     {Coupling::swap, 240, 0, 0},
                                       {Coupling::swap, 240, 1, 1},    {Coupling::coupled, 60, 0, 0},
                                       {Coupling::coupled, 60, 1, 1},  {Coupling::coupled, 60, 0, 1},
                                       {Coupling::coupled, 240, 0, 0}, {Coupling::coupled, 240, 1, 1}};
INSTANTIATE_TEST_SUITE_P(Soft, Bouncing,
                         testing::Combine(testing::Values(BounceScene::onFloor, BounceScene::freePlate,
                                                          BounceScene::twoSoft),
                                          testing::Bool(), testing::ValuesIn(kEverySteps)),
                         nameOfBounce);

// In staggered coupling a flat box at 60 Hz is detected centimetres deep in the bed, and is pushed out.
constexpr BounceSteps kBedSteps[] = {{Coupling::swap, 240, 0, 0},   {Coupling::swap, 240, 1, 1},
                                     {Coupling::coupled, 60, 0, 0}, {Coupling::coupled, 60, 1, 1},
                                     {Coupling::coupled, 60, 0, 1}, {Coupling::coupled, 240, 0, 0},
                                     {Coupling::coupled, 240, 1, 1}};
INSTANTIATE_TEST_SUITE_P(Rigid, Bouncing,
                         testing::Combine(testing::Values(BounceScene::onBed), testing::Bool(),
                                          testing::ValuesIn(kBedSteps)),
                         nameOfBounce);

// The impulse acts at one common point: linear and angular momentum are conserved, also in eccentric impacts.
class BouncingMomentum : public testing::TestWithParam<std::tuple<Coupling, double>>
{
};

TEST_P(BouncingMomentum, IsKept)
{
    const auto& [coupling, damping] = GetParam();
    for (const bool isSoft : {false, true})
    {
        btFemSolverInfo info;
        info.m_numericalDamping = info.m_contactDamping = btScalar(damping);
        FemWorld world(WorldClass::softRigid, coupling, {0, 0, 0}, info);
        SoftBox box;
        box.m_size = {0.5, 0.5, 0.5};
        box.m_center = {0.15, 0.1, 0.27};
        box.m_youngModulus = btScalar(1e7);
        btSoftBody& body = addSoftBox(world, world.fem(), box);
        body.setVelocity({btScalar(0.2), btScalar(0.1), -4});
        body.setRestitution(btScalar(0.9));
        btSoftBody* other = nullptr;
        btRigidBody* rigid = nullptr;
        if (isSoft)
        {
            box.m_center = {0, 0, -0.25};
            other = &addSoftBox(world, world.fem(), box);
            other->setRestitution(1);
            for (btSoftBody* soft : {&body, other}) soft->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        }
        else
        {
            RigidSettings settings;
            settings.m_mass = 60;
            settings.m_transform = at(0, 0, btScalar(-0.25));
            rigid = &addRigidBox(world, {0.5, 0.5, 0.5}, settings);
            rigid->setRestitution(1);
        }
        const auto motion = [&]
        {
            Motion sum = motionOf(body);
            sum += other ? motionOf(*other) : motionOf(*rigid);
            return sum;
        };
        const Motion start = motion();
        const auto parting = [&]
        { return velocityOf(body).z - (other ? velocityOf(*other).z : rigid->getLinearVelocity().z()); };
        for (int k = 0; k < 20 && parting() < 1; ++k) world.step();
        const Motion end = motion();
        const double size = norm(start.m_linear);
        EXPECT_GT(parting(), 1) << isSoft;
        EXPECT_LT(norm(end.m_linear - start.m_linear), 1e-5 * size) << isSoft;
        EXPECT_LT(norm(end.m_angular - start.m_angular), 1e-4 * size * kReach) << isSoft;
    }
}

INSTANTIATE_TEST_SUITE_P(Bodies, BouncingMomentum,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(0.0, 1.0)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) +
                                    (std::get<1>(suite.param) > 0 ? "_euler" : "_secondOrder");
                         });

// Bullet's threshold: slower impacts have no restitution.
TEST(BouncingThreshold, EqualsThatOfBullet)
{
    for (const double speed : {0.15, 0.25})
    {
        FemWorld world(WorldClass::softRigid, Coupling::swap, {0, 0, 0});
        world.addFloorBox().setRestitution(1);
        SoftBox box;
        box.m_size = {0.5, 0.5, 0.5};
        box.m_center = {0, 0, 0.255};
        box.m_youngModulus = btScalar(1e8);
        btSoftBody& cube = addSoftBox(world, world.fem(), box);
        cube.setRestitution(btScalar(0.8));
        cube.setVelocity({0, 0, btScalar(-speed)});
        world.step(30);
        if (speed < btContactSolverInfo().m_restitutionVelocityThreshold)
            EXPECT_NEAR(velocityOf(cube).z, 0, 0.01);
        else
            EXPECT_NEAR(velocityOf(cube).z, 0.8 * speed, 0.01);
    }
}

// A box on the floor has support, however light it is.
TEST(BouncingOnABox, ReturnsTheSetRestitutionOnTheFloor)
{
    for (const Coupling coupling : {Coupling::swap, Coupling::coupled})
    {
        FemWorld world(WorldClass::softRigid, coupling);
        world.addFloorBox();
        RigidSettings settings;
        settings.m_mass = 50;
        settings.m_transform = at(0, 0, btScalar(0.25));
        btRigidBody& board = addRigidBox(world, {1, 1, 0.5}, settings);
        board.setRestitution(1);
        world.step(60);
        SoftBox box;
        box.m_size = {0.5, 0.5, 0.5};
        box.m_center = {0, 0, 0.8};
        box.m_youngModulus = btScalar(1e7);
        btSoftBody& cube = addSoftBox(world, world.fem(), box);
        cube.setRestitution(btScalar(0.8));
        cube.setVelocity({0, 0, -4});
        double fastest = 0;
        for (int k = 0; k < 20; ++k)
        {
            world.step();
            fastest = std::max(fastest, velocityOf(cube).z);
        }
        EXPECT_NEAR(fastest, 0.8 * 4, 0.1 * 4) << couplingName(coupling);
        EXPECT_LT(std::fabs(board.getWorldTransform().getOrigin().z() - 0.25), 0.01) << couplingName(coupling);
    }
}

}  // namespace
}  // namespace bullet_fem
