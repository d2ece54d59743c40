// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>

#include "benchmarks/figures.h"
#include "benchmarks/games/game_scene.h"
#include "benchmarks/games/tetgen_source.h"
#include "bullet_fem/btFemDeformableBodySolver.h"
#include "bullet_fem/btFemDeformableConstraintSolver.h"

namespace bullet_fem
{
namespace
{

constexpr btScalar kGravityOfExample = 10;                  // [m/s2]
constexpr int kStepsOfExample = 4;                          // per frame of 1/60 s
constexpr btScalar kPressed = btScalar(0.45), kLifted = 5;  // end times of pressing and lifting [s]
constexpr btScalar kSpeedOfPlates = 2;                      // [m/s]

// Bullet's step callback: two plates of 1000 t close, then rise.
void leadPlates(btScalar time, btDeformableMultiBodyDynamicsWorld* world)
{
    const btScalar in = std::min(time, kPressed);
    const btScalar up = std::max(std::min(time, kLifted) - kPressed, btScalar(0));
    for (int k = 0; k < 2; ++k)
    {
        const btScalar side = k == 0 ? btScalar(1) : btScalar(-1);
        const bool isPressing = time < kPressed;
        btRigidBody& plate = *world->getNonStaticRigidBodies()[k];
        const btVector3 position(btScalar(0.5), 3 + kSpeedOfPlates * up, side * (4 - kSpeedOfPlates * in));
        plate.setCenterOfMassTransform(btTransform(btQuaternion::getIdentity(), position));
        plate.setLinearVelocity(isPressing ? btVector3(0, 0, -kSpeedOfPlates * side) : btVector3(0, kSpeedOfPlates, 0));
        plate.setAngularVelocity(btVector3(0, 0, 0));
        plate.setFriction(200);
    }
}

class PinchFriction : public Game
{
public:
    PinchFriction(const GameSettings& settings, const TetGenSource& cube) : m_line(settings.m_line)
    {
        btFemSolverInfo info;
        info.m_contactTolerance = btScalar(settings.m_contactTolerance);
        if (m_line == BenchmarkLine::bullet)
            m_solver = std::make_unique<btDeformableBodySolver>();
        else
        {
            auto fem = std::make_unique<btFemDeformableBodySolver>(info);
            m_fem = fem.get();
            m_solver = std::move(fem);
        }
        if (m_line == BenchmarkLine::coupled)
            m_rigidSolver = std::make_unique<btFemDeformableConstraintSolver>(m_fem);
        else
            m_rigidSolver = std::make_unique<btDeformableMultiBodyConstraintSolver>();
        m_rigidSolver->setDeformableSolver(m_solver.get());
        m_world = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
            &m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration, m_solver.get());
        const btVector3 gravity(0, -kGravityOfExample, 0);
        m_world->setGravity(gravity);
        m_world->getWorldInfo().m_gravity = gravity;
        m_world->getWorldInfo().m_sparsesdf.setDefaultVoxelsz(btScalar(0.25));
        m_world->getWorldInfo().m_sparsesdf.Reset();
        m_world->setImplicit(false);
        m_world->setSolverCallback(leadPlates);
        addBox({150, 25, 150}, {0, -25, 0}, 0);
        for (const double z : {2.2, -2.2, 0.0}) addBlock(cube, btScalar(z));
        for (int k = 0; k < 2; ++k) addBox({3, 3, btScalar(0.5)}, {10, 0, 0}, btScalar(1e6));
    }
    ~PinchFriction() override
    {
        for (const auto& body : m_soft) m_world->removeSoftBody(body.get());
        for (const auto& body : m_rigid) m_world->removeRigidBody(body.get());
    }

    GameFrame step() override
    {
        GameFrame frame;
        const btScalar h = btScalar(1) / (60 * kStepsOfExample);
        for (int k = 0; k < kStepsOfExample; ++k)
        {
            const Stopwatch watch;
            m_world->stepSimulation(h, 0);
            frame.m_milliseconds += 1e3 * watch.cpuSeconds();
            if (m_fem == nullptr) continue;
            add(sumReports(m_fem->fem(), m_soft), frame);
            frame.m_held += heldIn(m_fem->fem(), m_soft, double(h)) / kStepsOfExample;
        }
        return frame;
    }
    int tetCount() const override
    {
        int count = 0;
        for (const auto& body : m_soft) count += body->m_tetras.size();
        return count;
    }
    double softWeight() const override { return massOf(m_soft) * double(kGravityOfExample); }
    std::string outcome() const override
    {
        std::ostringstream text;
        text.precision(3);
        text << "blocks at heights of " << heightOf(*m_soft[0]) << " and " << heightOf(*m_soft[1])
             << " m, the middle one at " << heightOf(*m_soft[2]) << " m, plates at "
             << double(m_rigid[1]->getCenterOfMassPosition().y()) << " m";
        return text.str();
    }

private:
    static double heightOf(const btSoftBody& body)
    {
        double sum = 0, mass = 0;
        for (int i = 0; i < body.m_nodes.size(); ++i)
        {
            const double m = 1 / double(body.m_nodes[i].m_im);
            sum += m * double(body.m_nodes[i].m_x.y());
            mass += m;
        }
        return sum / mass;
    }
    void addBox(const btVector3& half, const btVector3& position, btScalar mass)
    {
        m_shapes.push_back(std::make_unique<btBoxShape>(half));
        btVector3 inertia(0, 0, 0);
        if (mass > 0) m_shapes.back()->calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, m_shapes.back().get(), inertia);
        info.m_startWorldTransform = btTransform(btQuaternion::getIdentity(), position);
        info.m_friction = btScalar(0.5);
        m_rigid.push_back(std::make_unique<btRigidBody>(info));
        m_world->addRigidBody(m_rigid.back().get());
    }
    // Sets the block up as the example does, in its order.
    void addBlock(const TetGenSource& cube, btScalar z)
    {
        m_soft.emplace_back(btSoftBodyHelpers::CreateFromTetGenData(m_world->getWorldInfo(), cube.m_elements.c_str(),
                                                                    nullptr, cube.m_nodes.c_str(), false, true, true));
        btSoftBody& body = *m_soft.back();
        body.scale(btVector3(2, 2, 1));
        body.translate(btVector3(0, btScalar(2.1), z));
        body.getCollisionShape()->setMargin(btScalar(0.025));
        body.setSpringStiffness(10);
        body.setTotalMass(btScalar(0.6));
        body.m_cfg.kKHR = 1;
        body.m_cfg.kCHR = 1;
        body.m_cfg.kDF = 2;
        btSoftBodyHelpers::generateBoundaryFaces(&body);
        body.m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDF |
                                static_cast<int>(btSoftBody::fCollision::VF_DD);
        m_world->addSoftBody(&body);
        m_forces.push_back(std::make_unique<btDeformableGravityForce>(btVector3(0, -kGravityOfExample, 0)));
        m_world->addForce(&body, m_forces.back().get());
        m_forces.push_back(std::make_unique<btDeformableNeoHookeanForce>(btScalar(6), btScalar(6), btScalar(0.003)));
        m_world->addForce(&body, m_forces.back().get());
    }

    const BenchmarkLine m_line;
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    std::vector<std::unique_ptr<btDeformableLagrangianForce>> m_forces;
    std::unique_ptr<btDeformableBodySolver> m_solver;
    btFemDeformableBodySolver* m_fem = nullptr;
    std::unique_ptr<btDeformableMultiBodyConstraintSolver> m_rigidSolver;
    std::unique_ptr<btDeformableMultiBodyDynamicsWorld> m_world;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigid;
    std::vector<std::unique_ptr<btSoftBody>> m_soft;
};

}  // namespace

GameScene pinchFriction(const std::string& bulletSource)
{
    GameScene scene;
    scene.m_name = "PinchFriction";
    scene.m_frames = 150;
    scene.m_subSteps = kStepsOfExample;
    scene.m_carriesItsWeight = true;
    scene.m_isOfBullet = true;
    if (bulletSource.empty()) scene.m_missing = "its mesh is in Bullet's source tree; give that by --bullet-source";
    scene.m_start = [bulletSource](const GameSettings& settings)
    {
        const TetGenSource cube = readTetGenSource(bulletSource + "/examples/SoftDemo/cube.inl");
        return std::make_unique<PinchFriction>(settings, cube);
    };
    return scene;
}

}  // namespace bullet_fem
