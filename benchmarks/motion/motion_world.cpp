// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/motion/motion_world.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "benchmarks/figures.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

constexpr double kGravity = 9.81;        // [m/s2]
constexpr double kRadius = 0.25;         // of the balls [m]
constexpr double kBallDensity = 1000;    // [kg/m3]
constexpr double kRollSeconds = 6;       // [s]
constexpr double kRollDamping = 0.005;   // stiffness damping of the rolling material [s]
constexpr double kContactSeconds = 0.4;  // from first contact, long enough for the rebound [s]

/// A ball above the ground z = 0.
class MotionWorld
{
public:
    MotionWorld(MotionMethod method, int rate, const btVector3& gravity)
        : m_step(1.0 / rate),
          m_fem(solverInfo(method)),
          m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration, &m_fem)
    {
        m_world.setGravity(gravity);
        m_world.getWorldInfo().m_gravity = gravity;
    }

    ~MotionWorld()
    {
        if (m_soft) m_world.removeSoftBody(m_soft.get());
        for (const auto& body : m_rigid) m_world.removeRigidBody(body.get());
    }

    MotionWorld(const MotionWorld&) = delete;
    MotionWorld& operator=(const MotionWorld&) = delete;

    btRigidBody& addRigid(std::unique_ptr<btCollisionShape> shape, const btVector3& center, double mass)
    {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape.get(), inertia);
        info.m_startWorldTransform.setIdentity();
        info.m_startWorldTransform.setOrigin(center);
        info.m_friction = 1;
        m_rigid.push_back(std::make_unique<btRigidBody>(info));
        m_rigid.back()->setActivationState(DISABLE_DEACTIVATION);
        m_shapes.push_back(std::move(shape));
        m_world.addRigidBody(m_rigid.back().get());
        return *m_rigid.back();
    }

    btSoftBody& addBall(int cells, double stiffnessDamping, double height, double young = kBallYoung)
    {
        m_soft.reset(btFemHelpers::createFromTetMesh(m_world.getWorldInfo(), makeSphere(kRadius, cells)));
        m_soft->translate({0, 0, btScalar(height)});
        btFemMaterial material;
        material.m_youngModulus = btScalar(young);
        material.m_density = btScalar(kBallDensity);
        material.m_stiffnessDamping = btScalar(stiffnessDamping);
        m_fem.setMaterial(m_soft.get(), material);
        m_fem.prepare(m_soft.get(), btScalar(m_step));
        m_soft->m_cfg.kDF = btScalar(0.8);
        m_soft->setActivationState(DISABLE_DEACTIVATION);
        m_world.addSoftBody(m_soft.get());
        return *m_soft;
    }

    void step()
    {
        const Stopwatch watch;
        m_world.stepSimulation(btScalar(m_step), 0);
        m_milliseconds.push_back(1e3 * watch.cpuSeconds());
    }

    double milliseconds() const { return median(m_milliseconds); }
    const btFemSoftBodySolver& fem() const { return m_fem; }

private:
    static btFemSolverInfo solverInfo(MotionMethod method)
    {
        btFemSolverInfo info;
        if (method == MotionMethod::standard) return info;
        info.m_numericalDamping = info.m_contactDamping = method == MotionMethod::secondOrder ? 0 : 1;
        info.m_elasticRebound = false;
        return info;
    }

    const double m_step;  // [s]
    btFemSoftBodySolver m_fem;
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigid;
    std::unique_ptr<btSoftBody> m_soft;
    std::vector<double> m_milliseconds;
};

/// Velocity of the centre of mass [m/s].
double velocityOf(const btSoftBody& body, int axis)
{
    double momentum = 0, mass = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        momentum += double(body.m_nodes[i].m_v[axis]) / double(body.m_nodes[i].m_im);
        mass += 1 / double(body.m_nodes[i].m_im);
    }
    return momentum / mass;
}

double radians(double degrees)
{
    return degrees * std::acos(-1) / 180;
}

Measured fallFrom(double height, MotionMethod method, int rate, int cells, double young)
{
    MotionWorld world(method, rate, {0, 0, btScalar(-kGravity)});
    btRigidBody& floor = world.addRigid(std::make_unique<btBoxShape>(btVector3(5, 5, 1)), {0, 0, -1}, 0);
    btSoftBody& ball = world.addBall(cells, 0, kRadius + height, young);
    const double impact = std::sqrt(2 * kGravity * height);
    const int steps = static_cast<int>(std::lround((impact / kGravity + kContactSeconds) * rate));
    bool touched = false;
    double returns = 0;
    for (int k = 0; k < steps; ++k)
    {
        world.step();
        touched = touched || world.fem().contactForce(&ball, &floor).z() > 0;
        if (touched) returns = std::max(returns, velocityOf(ball, 2));
    }
    return {returns / impact, world.milliseconds()};
}

}  // namespace

Measured dropBall(MotionMethod method, int rate, int cells, double young)
{
    Measured mean;
    const double heights[] = {1.01, 1.03, 1.05, 1.07};  // 2 cm are a quarter of the path in 1/60 s [m]
    for (const double height : heights)
    {
        const Measured one = fallFrom(height, method, rate, cells, young);
        mean.m_value += one.m_value / std::size(heights);
        mean.m_milliseconds += one.m_milliseconds / std::size(heights);
    }
    return mean;
}

Measured rollBall(MotionMethod method, int rate, int cells, double degrees)
{
    const double g = kGravity, angle = radians(degrees);
    MotionWorld world(method, rate, {btScalar(g * std::sin(angle)), 0, btScalar(-g * std::cos(angle))});
    world.addRigid(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), {0, 0, 0}, 0);
    const double volume = 4.0 / 3 * std::acos(-1) * kRadius * kRadius * kRadius;
    const bool isRigid = method == MotionMethod::rigid;
    btRigidBody* sphere = isRigid ? &world.addRigid(std::make_unique<btSphereShape>(btScalar(kRadius)),
                                                    {0, 0, btScalar(kRadius)}, kBallDensity * volume)
                                  : nullptr;
    if (sphere) sphere->setFriction(btScalar(0.8));
    btSoftBody* ball = isRigid ? nullptr : &world.addBall(cells, kRollDamping, kRadius + 1e-4);
    for (int k = 0; k < kRollSeconds * rate; ++k) world.step();
    return {sphere ? double(sphere->getLinearVelocity().x()) : velocityOf(*ball, 0), world.milliseconds()};
}

double speedOfRigidSphere(double degrees)
{
    return 5.0 / 7 * kGravity * kRollSeconds * std::sin(radians(degrees));
}

}  // namespace bullet_fem
