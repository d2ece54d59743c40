// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bullet's deformable examples in which soft blocks are gripped: Pinch, PinchFriction, GraspDeformable.
#include <array>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "examples/deformable_example.h"

namespace bullet_fem
{
namespace
{

constexpr double kStepOfExamples = 1.0 / 240;  // [s]

// Motion of two plates of 1000 t, prescribed by the world's solver callback: inwards, upwards and sideways.
struct Leading
{
    btScalar m_pressed, m_lifted, m_shifted;  // end times of the phases [s]
    btScalar m_upward, m_aside;               // [m/s], after pressing by 2 m/s
    btScalar m_friction;
};
Leading leading;  // a global, because Bullet's callback has no user pointer

void lead(btScalar time, btDeformableMultiBodyDynamicsWorld* world)
{
    const btScalar in = std::min(time, leading.m_pressed);
    const btScalar up = std::max(std::min(time, leading.m_lifted) - leading.m_pressed, btScalar(0));
    const btScalar aside = std::max(std::min(time, leading.m_shifted) - leading.m_lifted, btScalar(0));
    for (int k = 0; k < 2; ++k)
    {
        const btScalar side = k == 0 ? btScalar(1) : btScalar(-1);
        btVector3 velocity(0, 0, 0);
        if (time < leading.m_pressed)
            velocity.setZ(-2 * side);
        else if (time < leading.m_lifted)
            velocity.setY(leading.m_upward);
        else if (time < leading.m_shifted)
            velocity.setZ(leading.m_aside);
        btRigidBody& plate = *world->getNonStaticRigidBodies()[k];
        plate.setCenterOfMassTransform(
            at(btScalar(0.5), 3 + leading.m_upward * up, side * (4 - 2 * in) + leading.m_aside * aside));
        plate.setLinearVelocity(velocity);
        plate.setAngularVelocity(btVector3(0, 0, 0));
        plate.setFriction(leading.m_friction);
    }
}

class Plates : public DeformableExample
{
protected:
    void start(const Leading& how)
    {
        leading = how;
        setGravity(10);
        m_world.world().setImplicit(false);
        m_world.world().setSolverCallback(lead);
        m_ground = &addRigidBox({150, 25, 150}, {0, -25, 0}, 0);
    }
    void addPlates(EnergyBook& book)
    {
        for (btRigidBody*& plate : m_plates)
        {
            plate = &addRigidBox({3, 3, btScalar(0.5)}, {10, 0, 0}, btScalar(1e6));
            book.addLed(*plate);
        }
    }
    btSoftBody& addHeld(const TetMesh& mesh, ExampleBlock block)
    {
        block.m_collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDF;
        btSoftBody& body = addBlock(mesh, block);
        addGravity(body);
        return body;
    }
    double heightInGrip(const btSoftBody& body) const
    {
        return centerOf(body).y - double(m_plates[0]->getCenterOfMassPosition().y());
    }

    btRigidBody* m_ground = nullptr;
    std::array<btRigidBody*, 2> m_plates = {};
};

// The plates press, then jump to 5 m/s upwards and to 5 m/s sideways, and hold.
TEST_F(Plates, PinchHoldsACubeThroughLiftAndShift)
{
    start({btScalar(0.9), btScalar(2.5), btScalar(3.5), 5, 5, 20});
    btSoftBody& cube = addHeld(makeBox({2, 2, 2}, {4, 4, 4}, {-1, -1, -1}), {{2, 2, 2}, {0, 4, 0}, 1, btScalar(0.5)});
    auto elastic = std::make_unique<btDeformableNeoHookeanForce>(8, 3, btScalar(0.02));
    elastic->setPoissonRatio(btScalar(0.3));
    elastic->setYoungsModulus(25);
    elastic->setDamping(btScalar(0.01));
    addForce(m_world, cube, std::move(elastic));
    cube.m_cfg.drag = btScalar(0.001);
    EnergyBook book(fem(), m_gravity);
    book.addSoft(cube, 25, 0.3, btFemElasticLaw::neoHooke);
    addPlates(book);
    book.open();

    run(book, 600, kStepOfExamples);
    const double grip = heightInGrip(cube);
    EXPECT_GT(centerOf(cube).y, 8);         // lifted
    EXPECT_NEAR(velocityOf(cube).y, 5, 2);  // it swings
    expectWithinTheCone(cube, 10);
    run(book, 480, kStepOfExamples);
    EXPECT_NEAR(centerOf(cube).z, 5, 0.05);  // moved sideways
    EXPECT_NEAR(heightInGrip(cube), grip, 0.25);
    EXPECT_LT(fastestNode(cube), 0.2);
    EXPECT_GT(smallestVolumeRatio(cube), 0.5);
    EXPECT_GT(m_flattest, 0.2);
    EXPECT_LT(book.made(), 1e-2 * book.work());
    const Vec3 near = vec3(fem().contactForce(&cube, m_plates[0])), far = vec3(fem().contactForce(&cube, m_plates[1]));
    EXPECT_NEAR(near.y + far.y, 10, 1);  // its weight
    // Pressed by 0.3 m a side: the force is above that with free sides and below that with fully confined sides.
    const double strain = 0.6 / 4, wide = 16, confined = 0.7 / (1.3 * 0.4);
    EXPECT_GT(far.z, 25 * strain * wide * 0.9);
    EXPECT_LT(far.z, 25 * strain * wide * confined);
    EXPECT_NEAR(near.z, -far.z, 0.02 * far.z);
}

// Three blocks side by side, the middle one held by friction between soft bodies. Friction of the plates is 400, which
// behaves as 10 does.
TEST_F(Plates, PinchFrictionLiftsThreeBlocks)
{
    start({btScalar(0.45), 5, 5, 2, 0, 200});
    EnergyBook book(fem(), m_gravity);
    const TetMesh mesh = makeBox({2, 2, 2}, {4, 4, 2}, {-1, -1, -1});
    std::array<btSoftBody*, 3> blocks;
    for (int k = 0; k < 3; ++k)
    {
        const btScalar z = k == 0 ? btScalar(2.2) : k == 1 ? btScalar(-2.2) : 0;
        blocks[k] = &addHeld(mesh, {{2, 2, 1}, {0, btScalar(2.1), z}, btScalar(0.6), 2});
        blocks[k]->m_cfg.collisions |= btSoftBody::fCollision::VF_DD;
        addForce(m_world, *blocks[k], std::make_unique<btDeformableNeoHookeanForce>(6, 6, btScalar(0.003)));
        book.addSoft(*blocks[k], 15, 0.25, btFemElasticLaw::neoHooke);
    }
    addPlates(book);
    book.open();
    run(book, 600, kStepOfExamples);

    for (const btSoftBody* block : blocks)
    {
        EXPECT_GT(centerOf(*block).y, 5.4);  // of 2.1 + 2 * 2.05 = 6.2; they sag
        EXPECT_NEAR(centerOf(*block).x, 0, 0.05);
        EXPECT_GT(smallestVolumeRatio(*block), 0.4);
        expectWithinTheCone(*block, 10);
    }
    expectWithinTheCone(*blocks[2], 2);
    EXPECT_NEAR(centerOf(*blocks[0]).z, -centerOf(*blocks[1]).z, 0.02);
    EXPECT_LT(book.made(), 1e-3 * book.work());
    EXPECT_GT(m_flattest, 0.2);
    // External work minus friction and damping losses: the blocks have gained height by it.
    EXPECT_GT(book.work(), 3 * 0.6 * 10 * (5.4 - 2.1));
    double lift = 0, momentum = 0;
    for (const btSoftBody* block : blocks) momentum -= motionOf(*block).m_linear.y;
    for (int k = 0; k < 60; ++k)
    {
        run(book, 1, kStepOfExamples);
        for (const btSoftBody* block : blocks) lift += impulseOn(fem(), *block).y;
    }
    for (const btSoftBody* block : blocks) momentum += motionOf(*block).m_linear.y;
    EXPECT_NEAR(lift, momentum + 3 * 0.6 * 10 * 60 * kStepOfExamples, 1e-3 * lift);
}

// A gripper of two motorised fingers on a base with prescribed velocity, 40 times as large, to hold the example's cube.
class GraspDeformable : public DeformableExample
{
protected:
    static constexpr btScalar kScale = 40;

    GraspDeformable()
    {
        setGravity(9.81);
        m_world.world().setImplicit(false);
        m_world.world().getSolverInfo().m_numIterations = 150;
        const btVector3 bar = kScale * btVector3(btScalar(0.02), btScalar(0.002), btScalar(0.002));
        const btVector3 finger = kScale * btVector3(btScalar(0.02), btScalar(0.018), btScalar(0.003));
        m_body = new btMultiBody(2, btScalar(0.1), inertia(finger), true, false);
        m_body->setBasePos(btVector3(0, kScale * btScalar(0.05), 0));
        for (int k = 0; k < 2; ++k)
            m_body->setupRevolute(k, btScalar(0.1), inertia(bar), -1, btQuaternion::getIdentity(), btVector3(1, 0, 0),
                                  btVector3(0, 0, (k == 0 ? -1 : 1) * kScale * btScalar(0.006)),
                                  btVector3(0, -kScale * btScalar(0.016), 0), true);
        m_world.addMultiBody(m_body);
        m_body->setLinearDamping(btScalar(0.04));
        m_body->setAngularDamping(btScalar(0.04));
        m_body->setUseGyroTerm(false);
        m_body->setJointPos(0, btScalar(0.2));
        m_body->setJointPos(1, btScalar(-0.2));
        m_world.addCollider(*m_body, -1, new btBoxShape(bar));
        for (int k = 0; k < 2; ++k)
        {
            m_fingers[k] = &m_world.addCollider(*m_body, k, new btBoxShape(finger));
            m_motors[k] = &m_world.addConstraint<btMultiBodyJointMotor>(m_body, k, 0, btScalar(0), btScalar(1));
            m_motors[k]->setPositionTarget(0, 0);
        }
    }
    static btVector3 inertia(const btVector3& half)
    {
        btVector3 sum;
        btBoxShape(half).calculateLocalInertia(btScalar(0.1), sum);
        return sum;
    }
    // Sets the two sliders of the example.
    void lead(btScalar upward, btScalar closing)
    {
        m_body->setBaseVel(btVector3(0, upward, 0));
        m_motors[0]->setVelocityTarget(-closing, 1);
        m_motors[1]->setVelocityTarget(closing, 1);
    }

    btMultiBody* m_body;
    std::array<btMultiBodyLinkCollider*, 2> m_fingers = {};
    std::array<btMultiBodyJointMotor*, 2> m_motors = {};
};

TEST_F(GraspDeformable, GraspHoldsAndLiftsTheCubeAndLetsItGo)
{
    const btRigidBody& table = addRigidBox({btScalar(0.2), btScalar(0.35), btScalar(0.08)}, {0, btScalar(0.35), 0}, 0);
    ExampleBlock block;
    block.m_scale = {btScalar(0.2), btScalar(0.2), btScalar(0.2)};
    block.m_center = {0, btScalar(0.905), 0};
    block.m_mass = btScalar(0.1);
    block.m_friction = 2;
    block.m_collisions =
        btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDF | btSoftBody::fCollision::SDF_MDF;
    btSoftBody& cube = addBlock(makeBox({2, 2, 2}, {5, 5, 5}, {-1, -1, -1}), block);
    addGravity(cube);
    addForce(m_world, cube, std::make_unique<btDeformableNeoHookeanForce>(20, 80, btScalar(0.01)));
    EnergyBook book(fem(), m_gravity);
    book.addSoft(cube, 56, 0.4, btFemElasticLaw::neoHooke);
    for (const btMultiBodyLinkCollider* finger : m_fingers) book.addLed(*finger);
    book.open();
    const double weight = 0.1 * 9.81;

    run(book, 150, kStepOfExamples, [&](int) { lead(0, btScalar(0.3)); });
    run(book, 60, kStepOfExamples, [&](int) { lead(0, 0); });
    const double grip = centerOf(cube).y - double(m_body->getBasePos().y());
    run(book, 240, kStepOfExamples, [&](int) { lead(btScalar(0.4), 0); });
    run(book, 240, kStepOfExamples, [&](int) { lead(0, 0); });
    EXPECT_NEAR(m_body->getBasePos().y(), 2.4, 1e-3);
    EXPECT_NEAR(centerOf(cube).y - double(m_body->getBasePos().y()), grip, 0.08);
    EXPECT_LT(fastestNode(cube), 0.05);
    EXPECT_GT(smallestVolumeRatio(cube), 0.3);
    EXPECT_NEAR(supportOn(cube, *m_fingers[0]) + supportOn(cube, *m_fingers[1]), weight, 0.02 * weight);
    EXPECT_EQ(supportOn(cube, table), 0);
    // The cube is held because the fingers' normal force exceeds the weight over the friction coefficient.
    for (const btMultiBodyLinkCollider* finger : m_fingers)
        EXPECT_GT(2 * std::fabs(double(fem().contactForce(&cube, finger).z())), 0.5 * weight);
    expectWithinTheCone(cube, 2);
    EXPECT_LT(book.made(), 0.02 * book.work());

    // With a coefficient below that needed for the weight it slides, slower than in free fall.
    const double needed = weight / (2 * std::fabs(double(fem().contactForce(&cube, m_fingers[0]).z())));
    const double held = centerOf(cube).y;
    for (btMultiBodyLinkCollider* finger : m_fingers) finger->setFriction(btScalar(0.5 * needed / 2));
    run(book, 60, kStepOfExamples, [&](int) { lead(0, 0); });
    EXPECT_LT(centerOf(cube).y, held - 0.05);
    EXPECT_GT(centerOf(cube).y, held - 0.5 * 9.81 * 0.25 * 0.25);
    expectWithinTheCone(cube, 0.5 * needed);
    // The open fingers drop it on the table.
    run(book, 360, kStepOfExamples, [&](int k) { lead(0, k < 120 ? btScalar(-0.5) : 0); });
    EXPECT_NEAR(supportOn(cube, table), weight, 0.3 * weight);  // it still vibrates
    EXPECT_NEAR(centerOf(cube).y, 0.885, 0.03);
}

}  // namespace
}  // namespace bullet_fem
