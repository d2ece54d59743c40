// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The calls that pybullet's server makes, with the lines of tools/pybullet/insert.py: its deformable world, the order
// in which that is deleted, saved states, and the contact points that it reads from m_faceRigidContacts.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "bullet_fem/btFemDeformableConstraintSolver.h"
#include "bullet_fem/btFemWorldState.h"
#include "plugin/scenes/deformable_scene.h"

namespace bullet_fem
{
namespace
{

// The impulse of a contact with a rigid object, in Bullets that keep it.
template <class Info>
auto impulseOf(const Info& info, btVector3& impulse, int) -> decltype(info.m_impulse, bool())
{
    impulse = info.m_impulse;
    return true;
}

template <class Info>
bool impulseOf(const Info&, btVector3&, long)
{
    return false;
}

/// A world as PhysicsServerCommandProcessor::createEmptyDynamicsWorld makes it, with a plane that is a fixed multibody,
/// a cube on it as `loadURDF` and `loadSoftBody` add them, and a rigid box that falls on the cube.
class PybulletWorld : public testing::Test
{
protected:
    PybulletWorld()
    {
        m_dispatcher = new btCollisionDispatcher(&m_configuration);
        auto* broadphase = new btDbvtBroadphase(m_pairs = new btHashedOverlappingPairCache());
        broadphase->setVelocityPrediction(0);
        m_broadphase = broadphase;
        auto* fem = new btFemDeformableBodySolver();
        m_bodySolver = m_fem = fem;
        auto* solver = new btFemDeformableConstraintSolver(fem);
        m_solver = solver;
        m_world =
            new btDeformableMultiBodyDynamicsWorld(m_dispatcher, m_broadphase, solver, &m_configuration, m_bodySolver);
        m_world->setForceUpdateAllAabbs(false);
        m_world->setGravity(btVector3(0, 0, btScalar(-kGravity)));
        m_world->getSolverInfo().m_numIterations = 50;
        m_world->getSolverInfo().m_minimumSolverBatchSize = 0;
        m_world->getSolverInfo().m_leastSquaresResidualThreshold = btScalar(1e-7);
        addPlane();
        addCube();
    }

    ~PybulletWorld() override
    {
        m_world->removeMultiBody(m_base.get());
        m_world->removeCollisionObject(m_collider.get());
        m_world->removeSoftBody(m_cube.get());
        if (m_box) m_world->removeRigidBody(m_box.get());
        delete m_world;
        delete m_solver;  // before the body solver, to which it refers
        delete m_bodySolver;
        delete m_broadphase;
        delete m_pairs;
        delete m_dispatcher;
    }

    void addBox(const btVector3& position)
    {
        m_box = std::make_unique<btRigidBody>(2, nullptr, &m_boxShape, btVector3(1, 1, 1) * btScalar(0.01));
        m_box->setWorldTransform(btTransform(btQuaternion::getIdentity(), position));
        m_world->addRigidBody(m_box.get());
    }

    void step(int count)
    {
        for (int k = 0; k < count; ++k) m_world->stepSimulation(kStep, 0);
    }

    // Positions of the nodes and of the box.
    std::vector<btScalar> state() const
    {
        std::vector<btScalar> values;
        const auto add = [&](const btVector3& v) { values.insert(values.end(), {v.x(), v.y(), v.z()}); };
        for (int i = 0; i < m_cube->m_nodes.size(); ++i) add(m_cube->m_nodes[i].m_x), add(m_cube->m_nodes[i].m_v);
        if (m_box) add(m_box->getWorldTransform().getOrigin()), add(m_box->getAngularVelocity());
        return values;
    }

    static constexpr btScalar kStep = btScalar(1) / 240;
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btDeformableMultiBodyDynamicsWorld* m_world = nullptr;
    btFemDeformableBodySolver* m_fem = nullptr;
    std::unique_ptr<btSoftBody> m_cube;
    std::unique_ptr<btRigidBody> m_box;
    std::unique_ptr<btMultiBodyLinkCollider> m_collider;

private:
    void addPlane()
    {
        m_base = std::make_unique<btMultiBody>(0, 0, btVector3(0, 0, 0), true, false);
        m_collider = std::make_unique<btMultiBodyLinkCollider>(m_base.get(), -1);
        m_collider->setCollisionShape(&m_plane);
        m_collider->setFriction(1);
        m_base->setBaseCollider(m_collider.get());
        m_base->finalizeMultiDof();
        m_world->addMultiBody(m_base.get());
        m_world->addCollisionObject(m_collider.get(), btBroadphaseProxy::StaticFilter,
                                    btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
    }

    void addCube()
    {
        m_cube.reset(btFemHelpers::createFromTetMesh(m_world->getWorldInfo(), makeBox({0.4, 0.4, 0.4}, {3, 3, 3})));
        m_cube->translate(btVector3(btScalar(-0.2), btScalar(-0.2), btScalar(0.001)));
        m_cube->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDF;
        m_cube->m_cfg.kDF = btScalar(0.5);
        m_cube->setTotalMass(4);
        m_cube->setActivationState(DISABLE_DEACTIVATION);
        m_world->addSoftBody(m_cube.get());
        m_elastic = makeForce(Elastic::neoHookean, kMu, kLambda);
        m_gravity = std::make_unique<btDeformableGravityForce>(m_world->getGravity());
        m_world->addForce(m_cube.get(), m_elastic.get());
        m_world->addForce(m_cube.get(), m_gravity.get());
    }

    btStaticPlaneShape m_plane{btVector3(0, 0, 1), 0};
    btBoxShape m_boxShape{btVector3(1, 1, 1) * btScalar(0.1)};
    std::unique_ptr<btMultiBody> m_base;
    std::unique_ptr<btDeformableLagrangianForce> m_elastic, m_gravity;
    btCollisionDispatcher* m_dispatcher = nullptr;
    btOverlappingPairCache* m_pairs = nullptr;
    btBroadphaseInterface* m_broadphase = nullptr;
    btDeformableBodySolver* m_bodySolver = nullptr;
    btMultiBodyConstraintSolver* m_solver = nullptr;
};

TEST_F(PybulletWorld, FaceContactsLastWhileTheBodySleeps)
{
    m_cube->forceActivationState(ACTIVE_TAG);
    step(1500);
    ASSERT_EQ(m_cube->getActivationState(), ISLAND_SLEEPING);
    EXPECT_GT(m_cube->m_faceRigidContacts.size(), 3);
    m_world->removeCollisionObject(m_collider.get());
    EXPECT_EQ(m_cube->m_faceRigidContacts.size(), 0);
    step(100);
    EXPECT_LT(m_cube->m_nodes[0].m_x.z(), -0.1) << "it does not fall";
}

TEST_F(PybulletWorld, FaceContactsHaveTheImpulsesOfAllContactsWithTheGround)
{
    step(1000);
    const auto& contacts = m_fem->fem().contacts(m_cube.get());
    btScalar force = 0, ofFaces = 0;
    bool hasImpulses = true;
    for (int k = 0; k < contacts.size(); ++k) force += contacts[k].m_normalImpulse / kStep;
    ASSERT_GT(m_cube->m_faceRigidContacts.size(), 3);
    for (int k = 0; k < m_cube->m_faceRigidContacts.size(); ++k)
    {
        const btSoftBody::DeformableFaceRigidContact& contact = m_cube->m_faceRigidContacts[k];
        EXPECT_EQ(contact.m_cti.m_colObj, m_collider.get());
        EXPECT_NEAR(contact.m_bary.x() + contact.m_bary.y() + contact.m_bary.z(), 1, 0.01);
        btVector3 impulse;
        hasImpulses = hasImpulses && impulseOf(contact.m_cti, impulse, 0);
        if (!hasImpulses) continue;
        const btScalar normal = impulse.dot(contact.m_cti.m_normal);
        EXPECT_LE(normal, 0);  // on the ground
        ofFaces -= normal / kStep;
    }
    const btScalar weight = btScalar(4 * kGravity);
    EXPECT_NEAR(force, weight, btScalar(0.01) * weight);
    if (hasImpulses)
    {
        EXPECT_NEAR(ofFaces, weight, btScalar(0.01) * weight);
    }
}

TEST_F(PybulletWorld, StatesContinueToTheBit)
{
    addBox(btVector3(btScalar(0.05), 0, btScalar(0.6)));
    step(60);
    std::vector<unsigned char> bytes;
    btFemWorldState::save(*m_world, m_fem->fem(), bytes);
    step(80);
    const std::vector<btScalar> expected = state();
    btFemWorldState::restore(*m_world, m_fem->fem(), bytes.data(), bytes.size());
    step(80);
    EXPECT_TRUE(state() == expected);
    EXPECT_GT(m_box->getWorldTransform().getOrigin().z(), 0.4) << "the box is not on the cube";
}

TEST_F(PybulletWorld, StatesOfOtherObjectsAreRefused)
{
    step(3);
    std::vector<unsigned char> bytes;
    btFemWorldState::save(*m_world, m_fem->fem(), bytes);
    addBox(btVector3(0, 0, 1));
    const std::vector<btScalar> before = state();
    std::string why;
    EXPECT_FALSE(btFemWorldState::restore(*m_world, m_fem->fem(), bytes.data(), bytes.size(), &why));
    EXPECT_FALSE(why.empty());
    EXPECT_TRUE(state() == before);
}

}  // namespace
}  // namespace bullet_fem
