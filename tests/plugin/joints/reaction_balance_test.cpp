// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Momentum balance of fixed bodies in each step: reactions + loads + contacts + anchors = change of momentum / h.
#include <algorithm>
#include <cmath>

#include "fem/common/rotation.h"
#include "plugin/scenes/hollow_cube.h"
#include "plugin/scenes/reaction_scene.h"

namespace bullet_fem
{
namespace
{

/// Step settings and a material.
struct BalanceCase
{
    const char* m_name;
    double m_damping;  // of the step [-]
    btFemMaterial m_material;
    bool m_hasContact = false;
    double m_tolerance = 0;  // besides rounding: mass damping acts on the velocities before smoothing
};

btFemMaterial softMaterial()
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e5);
    return material;
}

template <class Change>
btFemMaterial softMaterial(const Change& change)
{
    btFemMaterial material = softMaterial();
    change(material);
    return material;
}

const BalanceCase kBalanceCases[] = {
    {"secondOrder", 0, softMaterial()},
    {"halfDamped", 0.5, softMaterial()},
    {"implicitEuler", 1, softMaterial()},
    {"massDamping", 0, softMaterial([](btFemMaterial& m) { m.m_massDamping = 2; }), false, 1e-3},
    {"massDampingEuler", 1, softMaterial([](btFemMaterial& m) { m.m_massDamping = 2; })},
    {"stiffnessDamping", 0, softMaterial([](btFemMaterial& m) { m.m_stiffnessDamping = btScalar(0.05); })},
    {"nearlyIncompressible", 0, softMaterial([](btFemMaterial& m) { m.m_poissonRatio = btScalar(0.47); })},
    {"accurateBending", 0, softMaterial([](btFemMaterial& m) { m.m_bending = btFemBending::accurate; })},
    {"neoHooke", 0, softMaterial([](btFemMaterial& m) { m.m_law = btFemElasticLaw::neoHooke; })},
    {"neoHookeEuler", 1,
     softMaterial(
         [](btFemMaterial& m)
         {
             m.m_law = btFemElasticLaw::neoHooke;
             m.m_youngModulus = btScalar(2e4);  // soft, so that quasi-Newton iterations follow
         })},
    {"orthotropic", 0, softMaterial([](btFemMaterial& m) { m.m_law = btFemElasticLaw::orthotropic; })},
    {"yields", 0, softMaterial([](btFemMaterial& m) { m.m_yieldStress = btScalar(5e3); })},
    {"relaxes", 0,
     softMaterial(
         [](btFemMaterial& m) {
             m.m_relaxation[0] = {btScalar(0.5), btScalar(0.1)};
         })},
    {"contact", 0, softMaterial(), true},
    {"contactEuler", 1, softMaterial(), true}};

void PrintTo(const BalanceCase& balance, std::ostream* out)
{
    *out << balance.m_name;
}

// Rounding of positions and velocities in Bullet's precision, over a step.
constexpr double kRounding = sizeof(btScalar) == sizeof(float) ? 1e-4 : 1e-7;

constexpr double kPinsX = -1;  // of the pins on a line [m]

class HeldBalance : public testing::TestWithParam<BalanceCase>
{
protected:
    static btFemSolverInfo info()
    {
        btFemSolverInfo info;
        info.m_numericalDamping = btScalar(GetParam().m_damping);
        return info;
    }

    static double tolerance() { return kRounding + GetParam().m_tolerance; }

    // Velocities of a pendulum on the line of the pins when the forces of the step have acted: before it turns by R to
    // the step's end, along with its elastic displacements, and its elastic velocities by R^T (docs/theory.md, Drift).
    static std::vector<Vec3> velocitiesAtKick(const btSoftBody& body, const std::vector<double>& mass)
    {
        const double time = 0.5 * (1 + GetParam().m_damping) * double(kStep);
        const auto arm = [&](int i) { return vec3(body.m_nodes[i].m_x) - Vec3{kPinsX, 0, 0}; };
        double momentum = 0, inertia = 0;
        for (int i = 0; i < body.m_nodes.size(); ++i)
        {
            momentum += mass[i] * cross(arm(i), vec3(body.m_nodes[i].m_v)).y;
            inertia += mass[i] * (arm(i).x * arm(i).x + arm(i).z * arm(i).z);
        }
        const Vec3 endSpin = {0, momentum / inertia, 0};
        Vec3 spin = endSpin, excess;  // excess: spin of the elastic velocities, which have none before the drift
        std::vector<Vec3> velocity(mass.size());
        for (int k = 0; k < 4; ++k)
        {
            const Mat3 R = exponential(time * spin);
            double ofElastic = 0;
            inertia = 0;
            for (int i = 0; i < body.m_nodes.size(); ++i)
            {
                const Vec3 turned = R * (vec3(body.m_nodes[i].m_v) - cross(endSpin, arm(i)));
                const Vec3 elastic = turned - cross(excess, R * arm(i));
                const Vec3 r = transposeTimes(R, arm(i)) - time * elastic;
                inertia += mass[i] * (r.x * r.x + r.z * r.z);
                ofElastic += mass[i] * cross(r, elastic).y;
                velocity[i] = cross(spin, r) + elastic;
            }
            spin.y = momentum / inertia;
            excess.y += ofElastic / inertia;
        }
        return velocity;
    }

    // Maximum error of the balance over some steps, relative to the weight; moments with an arm of 1 m.
    struct Worst
    {
        double m_force = 0, m_moment = 0, m_momentAboutY = 0;
    };
    Worst worstOf(const btSoftBody& body, ReactionBalance& balance, int steps, bool turns = false)
    {
        Worst worst;
        for (int k = 0; k < steps; ++k)
        {
            balance.note();
            m_world.step();
            EXPECT_NE(0, m_fem.reaction(&body, {0, 0, 0}).m_count);
            const std::vector<Vec3> damped = turns ? velocitiesAtKick(body, balance.mass()) : std::vector<Vec3>();
            const ReactionBalance::Error e = balance.error(double(GetParam().m_material.m_massDamping), damped);
            worst.m_force = std::max(worst.m_force, norm(e.m_force) / balance.weight());
            worst.m_moment = std::max({worst.m_moment, std::fabs(e.m_moment.x) / balance.weight(),
                                       std::fabs(e.m_moment.z) / balance.weight()});
            worst.m_momentAboutY = std::max(worst.m_momentAboutY, std::fabs(e.m_moment.y) / balance.weight());
        }
        return worst;
    }

    // Adds a rigid box that falls onto the beam's end, if the case has contact.
    void addBox()
    {
        if (!GetParam().m_hasContact) return;
        RigidSettings box;
        box.m_mass = 50;
        box.m_transform = at(btScalar(0.8), 0, btScalar(0.6));
        addRigidBox(m_world, {0.3, 0.3, 0.3}, box);
    }

    btFemSoftBodySolver m_fem{info()};
    SoftWorld m_world{m_fem};
};

TEST_P(HeldBalance, IsExactInEveryStepForAClampedBeam)
{
    btSoftBody& beam = *makeSoftBox(m_world, m_fem, shortBeam());
    m_fem.setMaterial(&beam, GetParam().m_material);
    ReactionBalance balance(m_fem, beam, nodeMasses(beam));
    pin(beam, nodesWithin(beam, {-1, -1, -1}, {-1, 1, 1}));
    m_world.addSoft(&beam);
    addBox();
    const Worst worst = worstOf(beam, balance, 90);
    RecordProperty("force", std::to_string(worst.m_force));
    EXPECT_LT(worst.m_force, tolerance());
    EXPECT_LT(worst.m_moment, tolerance());
    EXPECT_LT(worst.m_momentAboutY, tolerance());
}

// Pins on a line along y: their forces have no moment about it.
TEST_P(HeldBalance, IsExactForAPendulumButAboutItsAxis)
{
    btSoftBody& beam = *makeSoftBox(m_world, m_fem, shortBeam());
    m_fem.setMaterial(&beam, GetParam().m_material);
    ReactionBalance balance(m_fem, beam, nodeMasses(beam));
    pin(beam, nodesWithin(beam, {kPinsX, -1, 0}, {kPinsX, 1, 0}));
    m_world.addSoft(&beam);
    addBox();
    const Worst worst = worstOf(beam, balance, 90, true);
    RecordProperty("force", std::to_string(worst.m_force));
    EXPECT_LT(worst.m_force, tolerance());
    EXPECT_LT(worst.m_moment, tolerance());
    RecordProperty("aboutAxis", std::to_string(worst.m_momentAboutY));
    EXPECT_LT(worst.m_momentAboutY, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Cases, HeldBalance, testing::ValuesIn(kBalanceCases),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

// A beam pinned at one end; at the other end a rigid box is anchored and a spring pulls; a second box falls onto the
// pinned nodes themselves.
class HeldByAll : public testing::TestWithParam<Coupling>
{
};

TEST_P(HeldByAll, HasOneBalanceOfPinsAnchorsSpringsAndContact)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, GetParam());
    btSoftBody& beam = *makeSoftBox(world, fem, shortBeam(btScalar(4e5)));
    ReactionBalance balance(fem, beam, nodeMasses(beam));
    const std::vector<int> pinned = nodesWithin(beam, {-1, -1, 0.25}, {-0.25, 1, 0.25});
    pin(beam, pinned);
    world.addSoft(&beam);
    RigidSettings hung;
    hung.m_mass = 60;
    hung.m_transform = at(btScalar(0.9), 0, btScalar(-0.4));
    btRigidBody& load = addRigidBox(world, {0.2, 0.4, 0.3}, hung);
    for (int i : nodesWithin(beam, {0.7, -1, -0.25}, {1, 1, -0.25})) beam.appendAnchor(i, &load, true);
    RigidSettings falls;
    falls.m_mass = 30;
    falls.m_transform = at(btScalar(-0.65), 0, btScalar(0.6));
    addRigidBox(world, {0.3, 0.3, 0.3}, falls);
    fem.prepare(&beam, kStep);
    btFemSpring spring;
    spring.m_nodes[0] = spring.m_nodes[1] = spring.m_nodes[2] = nodesWithin(beam, {1, 0.25, 0}, {1, 0.25, 0}).at(0);
    spring.m_stiffness = 2000;
    spring.m_target = {btScalar(1.5), 1, 0};
    fem.addSpring(&beam, spring);
    bool touched = false;
    for (int k = 0; k < 60; ++k)
    {
        balance.note();
        world.step();
        touched = touched || fem.contacts(&beam).size() > 0;
        EXPECT_EQ(int(pinned.size()), fem.reaction(&beam, {0, 0, 0}).m_count);
        const ReactionBalance::Error error = balance.error();
        EXPECT_LT(norm(error.m_force) / balance.weight(), 2 * kRounding) << k;
        EXPECT_LT(norm(error.m_moment) / balance.weight(), 2 * kRounding) << k;
    }
    EXPECT_TRUE(touched);
}

INSTANTIATE_TEST_SUITE_P(Couplings, HeldByAll, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return couplingName(suite.param); });

// Prescribed nodes that rotate and translate, on bodies with a common model.
TEST(HeldBodies, EachHasItsOwnBalance)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    std::vector<btSoftBody*> beams;
    std::vector<ReactionBalance> balances;
    for (int b = 0; b < 4; ++b)
    {
        SoftBox box = shortBeam(btScalar(3e5));
        box.m_center = {0, 2.0 * b, 0};
        beams.push_back(&addSoftBox(world, fem, box));
        balances.emplace_back(fem, *beams.back(), nodeMasses(*beams.back()));
        fem.prepare(beams.back(), kStep);
    }
    std::vector<int> led = nodesWithin(*beams[0], {-1, -1, -1}, {-1, 1, 1});
    for (int k = 1; k <= 60; ++k)
    {
        for (int b = 1; b < 4; ++b)  // the first body falls freely
        {
            btTransform pose(btQuaternion(btVector3(0, 0, 1), btScalar(0.01 * b * k)),
                             btVector3(0, 0, btScalar(0.002 * b * k)));
            fem.setNodeTargets(beams[b], led.data(), int(led.size()), pose);
        }
        for (ReactionBalance& balance : balances) balance.note();
        world.step();
        for (int b = 0; b < 4; ++b)
        {
            EXPECT_EQ(b == 0 ? 0 : 9, fem.reaction(beams[b], {0, 0, 0}).m_count);
            const ReactionBalance::Error error = balances[b].error();
            EXPECT_LT(norm(error.m_force) / balances[b].weight(), 10 * kRounding);
            EXPECT_LT(norm(error.m_moment) / balances[b].weight(), 60 * kRounding);  // some metres from the origin
        }
    }
}

// Chambers act on fixed nodes, too; their forces are internal to the body.
TEST(HeldBodies, PressureIsNoLoad)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& body = addHollowCube(world, fem, {0, 0, 0});
    ReactionBalance balance(fem, body, nodeMasses(body));
    double top = -1e9;
    for (int i = 0; i < body.m_nodes.size(); ++i) top = std::max(top, double(body.m_nodes[i].m_x.z()));
    pin(body, nodesWithin(body, {-9, -9, top}, {9, 9, top}));
    fem.prepare(&body, kStep);
    btFemChamber chamber = cavityOf(body);
    chamber.m_pressure = 2000;
    const int handle = fem.addChamber(&body, chamber);
    for (int k = 0; k < 60; ++k)
    {
        balance.note();
        world.step();
        if (k == 59) fem.removeActuator(&body, handle);  // before the reactions are read
        const ReactionBalance::Error error = balance.error();
        EXPECT_LT(norm(error.m_force) / balance.weight(), 10 * kRounding);
        EXPECT_LT(norm(error.m_moment) / balance.weight(), 10 * kRounding);
    }
}

}  // namespace
}  // namespace bullet_fem
