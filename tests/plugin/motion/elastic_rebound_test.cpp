// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies without a coefficient of restitution rebound at 60 Hz as they do in small steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kReboundSpeed = 4.43;  // of a fall from a metre [m/s]

enum class Impactor
{
    ball,         // of .4 m
    cube,         // of .2 m, flat
    tiltedBrick,  // of .4 x .2 x .2 m, by .5 rad
    twoBalls
};

struct ReboundCase
{
    Impactor m_impactor;
    double m_youngModulus, m_stiffnessDamping;  // [Pa], [s]
};

// Separation over approach speed [-], and spin about y afterwards [rad/s].
struct Returned
{
    double m_share = 0, m_spin = 0;
};

btSoftBody& addImpactor(FemWorld& world, const ReboundCase& how)
{
    btSoftBody* body = how.m_impactor == Impactor::cube
                           ? btFemHelpers::createBox(world.info(), {0, 0, 0}, {.1f, .1f, .1f}, .04f)
                       : how.m_impactor == Impactor::tiltedBrick
                           ? btFemHelpers::createBox(world.info(), {0, 0, 0}, {.2f, .1f, .1f}, .05f)
                           : btFemHelpers::createFromTetMesh(world.info(), makeSphere(.2, 6));
    if (how.m_impactor == Impactor::tiltedBrick) body->rotate(btQuaternion(btVector3(0, 1, 0), btScalar(.5)));
    body->translate(btVector3(0, 0, btScalar(.05 - lowestHeight(*body))));
    btFemMaterial material;
    material.m_youngModulus = btScalar(how.m_youngModulus);
    material.m_stiffnessDamping = btScalar(how.m_stiffnessDamping);
    material.m_density = 1000;
    material.m_poissonRatio = btScalar(.3);
    world.fem().setMaterial(body, material);
    body->m_cfg.kDF = btScalar(.5);
    body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    body->setVelocity(btVector3(0, 0, btScalar(-kReboundSpeed)));
    return world.addSoft(body);
}

// Moment of the contact impulses about the centre, along y [N m s].
double sideOfPush(btFemSoftBodySolver& fem, const btSoftBody& body)
{
    const btAlignedObjectArray<btFemContact>& contacts = fem.contacts(&body);
    double moment = 0;
    for (int k = 0; k < contacts.size(); ++k)
        moment += cross(vec3(contacts[k].m_point) - centerOf(body), vec3(contacts[k].m_impulse)).y;
    return moment;
}

Returned rebound(const ReboundCase& how, Coupling coupling, double h, const btFemSolverInfo& info)
{
    FemWorld world(WorldClass::softRigid, coupling, {0, 0, 0}, info);
    btSoftBody* other = nullptr;
    if (how.m_impactor == Impactor::twoBalls)
    {
        other = &addImpactor(world, how);
        other->translate({0, 0, btScalar(-.45)});
        other->setVelocity({0, 0, 0});
    }
    else
        world.addFloorBox();
    const btSoftBody& body = addImpactor(world, how);
    double parted = -1, side = 0;
    Returned returned;
    for (int k = 0; k < .5 / h && parted < 0.015; ++k)
    {
        world.step(1, btScalar(h));
        const double pushed = sideOfPush(world.fem(), body);
        if (how.m_impactor == Impactor::tiltedBrick && side * pushed < 0) break;  // its other end meets
        parted = norm(impulseOn(world.fem(), body)) > 0 ? 0 : parted < 0 ? -1 : parted + h;
        if (pushed != 0) side = pushed;
        const Motion motion = motionOf(body);
        const double inertia = massOf(body) * (.16 + .04) / 12;
        returned = {(velocityOf(body).z - (other ? velocityOf(*other).z : 0)) / kReboundSpeed,
                    (motion.m_angular - cross(centerOf(body), motion.m_linear)).y / inertia};
    }
    return returned;
}

class ElasticRebound : public testing::TestWithParam<std::tuple<Coupling, ReboundCase>>
{
};

// Steps of second order without elastic rebounds tell what is right.
TEST_P(ElasticRebound, IsThatOfSmallSteps)
{
    constexpr double kOff = 0.1, kSpinOff = 2;  // [-], [rad/s]
    const auto& [coupling, how] = GetParam();
    btFemSolverInfo small;
    small.m_contactDamping = 0;
    small.m_elasticRebound = false;
    const Returned expected = rebound(how, coupling, 1.0 / 1920, small);
    const Returned found = rebound(how, coupling, kStep, btFemSolverInfo());
    EXPECT_NEAR(found.m_share, expected.m_share, kOff);
    EXPECT_NEAR(found.m_spin, expected.m_spin, kSpinOff);
}

std::string nameOfRebound(const testing::TestParamInfo<std::tuple<Coupling, ReboundCase>>& suite)
{
    const auto& [coupling, how] = suite.param;
    const char* names[] = {"ball", "cube", "tiltedBrick", "twoBalls"};
    return std::string(couplingName(coupling)) + "_" + names[static_cast<int>(how.m_impactor)] + "_1e" +
           std::to_string(int(std::lround(std::log10(how.m_youngModulus)))) +
           (how.m_stiffnessDamping > 0 ? "_damped" : "");
}

INSTANTIATE_TEST_SUITE_P(
    Impactors, ElasticRebound,
    testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                     testing::Values(ReboundCase{Impactor::ball, 1e5, 0}, ReboundCase{Impactor::ball, 1e6, 0},
                                     ReboundCase{Impactor::ball, 1e7, 0}, ReboundCase{Impactor::ball, 1e5, 0.005},
                                     ReboundCase{Impactor::ball, 1e6, 0.005}, ReboundCase{Impactor::cube, 1e6, 0},
                                     ReboundCase{Impactor::cube, 1e6, 0.005}, ReboundCase{Impactor::cube, 1e7, 0.005},
                                     ReboundCase{Impactor::tiltedBrick, 1e7, 0},
                                     ReboundCase{Impactor::tiltedBrick, 1e7, 0.005},
                                     ReboundCase{Impactor::twoBalls, 1e6, 0},
                                     ReboundCase{Impactor::twoBalls, 1e6, 0.005})),
    nameOfRebound);

// Without the setting a body stops at 60 Hz.
TEST(ElasticReboundSetting, TurnsItOff)
{
    btFemSolverInfo info;
    info.m_elasticRebound = false;
    EXPECT_LT(rebound({Impactor::cube, 1e7, 0}, Coupling::swap, kStep, info).m_share, 0.1);
    EXPECT_GT(rebound({Impactor::cube, 1e7, 0}, Coupling::swap, kStep, btFemSolverInfo()).m_share, 0.5);
}

constexpr int kImpactSteps = 30;

class TumblingDrops : public testing::TestWithParam<Coupling>
{
};

// Two or six random bodies fall on each other and on the floor, in steps that vary by four: a rebound gives no more
// energy than its contact has taken. Impacts last for less than thirty steps.
TEST_P(TumblingDrops, GainNoEnergy)
{
    for (unsigned seed = 1; seed <= 6; ++seed)
    {
        unsigned long long state = seed;
        const auto number = [&state](double low, double high)
        {
            state = state * 6364136223846793005ULL + 1442695040888963407ULL;
            return low + (high - low) * double(state >> 33) / double(1ULL << 31);
        };
        FemWorld world(WorldClass::softRigid, GetParam());
        world.addFloorBox();
        for (int k = 0; k < (seed % 2 == 0 ? 2 : 6); ++k)
        {
            const Impactor kind = static_cast<Impactor>(int(number(0, 3)));
            btSoftBody& body = addImpactor(world, {kind, std::pow(10, number(5, 7)), number(0, 1) < 0.5 ? 0 : 0.005});
            body.translate({btScalar(number(-.1, .1)), btScalar(number(-.1, .1)), btScalar(0.1 + 0.6 * k)});
            body.setVelocity({btScalar(number(-2, 2)), btScalar(number(-2, 2)), btScalar(number(-4, 0))});
        }
        const auto energy = [&]
        {
            double sum = 0;
            for (int k = 0; k < world.softBodies().size(); ++k)
            {
                const btSoftBody& body = *world.softBodies()[k];
                sum += motionOf(body).m_energy + massOf(body) * kGravity * centerOf(body).z;
            }
            return sum;
        };
        std::vector<double> energies(kImpactSteps, energy());
        for (int k = 0; k < 120; ++k)
        {
            world.step(1, kStep / btScalar(1 + int(number(0, 4))));
            energies.push_back(energy());
            EXPECT_LT(energies.back(),
                      *std::max_element(energies.end() - kImpactSteps, energies.end() - 1) + 1e-4 * energies[0])
                << seed << ' ' << k;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Couplings, TumblingDrops, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

}  // namespace
}  // namespace bullet_fem
